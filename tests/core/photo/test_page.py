import cv2
import numpy as np
import pytest

from nostalgin_core.photo import decode, page
from nostalgin_core.records import Photo, Rejection
from tests.data import DATA, needs_data

PAGES = ("723259f-a", "723294f", "724549f")
LIKE_PAGES = (  # bars before a window, posts of an elevated railway, panels, a margin
    ("708557f-a", "707856f-a", "719578f-b", "706797f-c")
)


def _print(seed: int, h: int = 180, w: int = 260) -> np.ndarray:
    """Blocks of gray, whatever they may show, darker and lighter than any page."""
    small = np.random.default_rng(seed).choice([20, 60, 100, 235], (h // 15, w // 20))
    return cv2.resize(small.astype(np.uint8), (w, h), interpolation=cv2.INTER_NEAREST)


def _page(count: int, *, tone: int = 165, gutter: int = 14) -> np.ndarray:
    """Prints one above another on a page, that leaves room for a caption."""
    rest = [np.full((gutter, 260), tone, np.uint8)]
    parts = [part for k in range(count) for part in (_print(k), *rest)][:-1]
    return np.pad(np.vstack(parts), ((20, 20), (20, 90)), constant_values=tone)


@pytest.mark.parametrize("turns", [0, 1])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_gutter_parts_two_prints_however_the_page_lies(
    count: int, turns: int
) -> None:
    lying = np.ascontiguousarray(np.rot90(_page(count), turns))
    assert page.gutters(lying) == count - 1


def test_a_page_of_several_prints_is_refused_with_its_remedy() -> None:
    coded = cv2.imencode(".png", _page(3))[1].tobytes()
    refused = decode(coded, name="page.png")
    assert isinstance(refused, Rejection)
    assert refused.reason == "several prints"
    assert "page.png: a stripe of page parts them; cut each out" in refused.detail


def test_neither_sky_nor_road_nor_a_dark_bar_is_a_gutter() -> None:
    street = _print(7, 420, 300)
    street[:90], street[330:] = 230, 140
    assert page.gutters(street) == 0
    street[200:214] = 15
    assert page.gutters(street) == 0


def test_the_sky_between_two_houses_is_no_gutter() -> None:
    street = np.full((420, 300), 230, np.uint8)
    street[60:380, 20:145], street[60:380, 160:280], street[370:] = 90, 120, 140
    assert page.gutters(street) == 0


@needs_data
@pytest.mark.parametrize("name", PAGES)
def test_real_pages_are_told(name: str) -> None:
    path = DATA / "historic_streets" / "photos" / f"{name}.jpg"
    refused = decode(path.read_bytes(), name=name)
    assert isinstance(refused, Rejection)
    assert refused.reason == "several prints"


@needs_data
@pytest.mark.parametrize("name", LIKE_PAGES)
def test_what_only_looks_like_a_page_is_read(name: str) -> None:
    path = DATA / "historic_streets" / "photos" / f"{name}.jpg"
    assert isinstance(decode(path.read_bytes(), name=name), Photo)
