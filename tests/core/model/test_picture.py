import io

import numpy as np
from PIL import Image

from nostalgin_core import evidence, rests
from nostalgin_core.model import atlas, picture
from tests.core import sample_block as sample

SHEET = atlas.build(dict(list(sample.tiles("1").items())[3:8]), longest_px=200)


def opened(one: picture.Picture, mode: str | None = None) -> np.ndarray:
    image = Image.open(io.BytesIO(one.data))
    return np.asarray(image.convert(mode) if mode else image)


def test_png_is_lossless() -> None:
    got = opened(picture.colours(SHEET, image_format="png"))
    np.testing.assert_array_equal(got, np.dstack([SHEET.image, SHEET.opacity]))


def test_webp_keeps_opacity_exactly_and_colours_nearly_under_it_too() -> None:
    got = opened(picture.colours(SHEET), "RGBA").astype(int)
    assert (SHEET.opacity == 0).any()
    np.testing.assert_array_equal(got[..., 3], SHEET.opacity)
    assert np.abs(got[..., 0] - SHEET.image.astype(int)).mean() < 3
    gone = SHEET.opacity == 0
    assert np.abs(got[..., 0] - SHEET.image.astype(int))[gone].mean() < 6


def test_the_palette_index_of_the_evidence_is_its_code() -> None:
    np.testing.assert_array_equal(opened(picture.evidence_key(SHEET)), SHEET.evidence)


def test_multiplying_by_the_evidence_leaves_photographed_texels_as_they_are() -> None:
    tint = opened(picture.evidence_key(SHEET), "RGB")
    assert (tint[SHEET.evidence == evidence.PHOTOGRAPHED] == 255).all()
    assert (tint[SHEET.evidence == evidence.ASSUMED] != 255).all()


def test_every_code_has_a_tint_of_its_own_and_a_name() -> None:
    assert set(rests.TINTS) == set(rests.NAMES)
    assert len(set(rests.TINTS.values())) == len(rests.TINTS)
    assert set(picture.legend()) == {str(code) for code in rests.NAMES}


def test_the_same_atlas_gives_the_same_bytes() -> None:
    assert picture.colours(SHEET) == picture.colours(SHEET)
    assert picture.evidence_key(SHEET) == picture.evidence_key(SHEET)
