import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.placard import placard
from nostalgin_core.placard.placard import Number, Piece
from nostalgin_core.records import Box, Instance, Photo, Placard, Rejection


@pytest.mark.parametrize(
    "texts",
    [
        ["996-31M"],
        ["996", "-31M"],
        ["996 -31 M"],
        ["996", "31M"],
        ["996", "Y-31", "M"],  # the board's arrow, read as a letter
        ["996", "\u2014", "31", "m"],
        ["0996 - 0031 M"],
        ["996-", "3I", "M"],
    ],
)
def test_a_board_is_read_however_it_falls_apart(texts: list[str]) -> None:
    assert placard.parse(texts) == Number("996", "31", "M")


@pytest.mark.parametrize(
    "texts",
    [
        [],
        ["996"],
        ["-31M"],
        ["M"],
        ["99631M"],
        ["996", "1", "31"],
        ["HOTEL LANGWELL"],
        ["NYC.gov/records"],
        ["BAR 15-20"],
        ["996-31M", "CAFE"],
        ["9-31"],
        ["996-0"],
        ["123456-7"],
    ],
)
def test_what_is_not_wholly_a_number_is_no_number(texts: list[str]) -> None:
    assert placard.parse(texts) is None


@given(
    block=st.integers(10, 99_999),
    lot=st.integers(1, 9_999),
    letter=st.sampled_from(placard.BOROUGHS),
    cut=st.integers(0, 12),
)
def test_any_board_survives_spaces_and_one_cut(
    block: int, lot: int, letter: str, cut: int
) -> None:
    text = f"{block} - {lot} {letter}"
    place = text.index("-") if cut % 2 else len(str(block))
    read = placard.parse([text[:place], text[place:]])
    assert read == Number(str(block), str(lot), letter)


def _piece(
    x: float, y: float, text: str, *, h: float = 10, score: float = 0.9
) -> Piece:
    w = 0.7 * h * len(text)
    return Piece(
        np.array([[x, y], [x + w, y], [x + w, y + h], [x, y + h]]), text, score
    )


def test_pieces_are_joined_along_their_line_from_left_to_right() -> None:
    pieces = [_piece(60, 3, "-31M"), _piece(10, 0, "996"), _piece(12, 40, "CAFE")]
    texts = [[p.text for p in line] for line in placard.lines(pieces)]
    assert texts[0] == ["996", "-31M"]
    assert ["CAFE"] in texts


def _photo(size: tuple[int, int] = (400, 300)) -> Photo:
    return Photo("0" * 16, np.full(size, 90, np.uint8), Box(4, 4, 296, 396))


def _board(box: Box) -> Instance:
    shape = (box.y1 - box.y0, box.x1 - box.x0)
    return Instance("placard", 0.9, box, np.ones(shape, np.float32))


def _saying(*pieces: Piece) -> placard.Ocr:
    return lambda _: [(p.corners.tolist(), p.text, p.score) for p in pieces]


def test_signs_beside_the_board_do_not_matter() -> None:
    said = _saying(_piece(0, 0, "996"), _piece(40, 0, "-31M"), _piece(90, 0, "BAR"))
    read = placard.read(_photo(), _board(Box(50, 300, 150, 340)), said)
    assert isinstance(read, Placard)
    assert (read.block, read.lot, read.borough) == ("996", "31", "M")


def test_an_unsure_number_is_no_number() -> None:
    said = _saying(_piece(0, 0, "996-31M", score=0.3))
    read = placard.read(_photo(), _board(Box(50, 300, 150, 340)), said)
    assert isinstance(read, Rejection)
    assert read.reason == "no number read"
    assert "996-31M" in read.detail


def test_a_photo_without_print_says_so() -> None:
    read = placard.read(_photo(), None, _saying())
    assert isinstance(read, Rejection)
    assert (read.stage, read.reason) == ("placard", "no placard")


def test_corners_come_back_in_photo_pixels() -> None:
    """The reader here finds the one bright patch in whatever it is shown."""
    photo = _photo()
    photo.image[310:330, 70:130] = 250

    def find(image: np.ndarray) -> list[tuple[list[list[float]], str, float]]:
        ys, xs = np.nonzero(image > 170)
        x0, y0, x1, y1 = xs.min(), ys.min(), xs.max(), ys.max()
        corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
        return [([[float(x), float(y)] for x, y in corners], "996-31M", 0.9)]

    read = placard.read(photo, _board(Box(50, 300, 150, 340)), find)
    assert isinstance(read, Placard)
    expected = [(70, 310), (129, 310), (129, 329), (70, 329)]
    np.testing.assert_allclose(read.box, expected, atol=0.6)


def test_without_a_board_the_lower_half_is_searched() -> None:
    asked = []

    def look(image: np.ndarray) -> list[tuple[list[list[float]], str, float]]:
        asked.append(image.shape)
        return []

    assert not placard.read(_photo(), None, look)
    assert asked == [(392, 584)]


@pytest.mark.parametrize("text", ["996 -31 M", "1254 - 7 M"])
def test_a_painted_board_is_read_by_the_real_reader(text: str) -> None:
    rapidocr = pytest.importorskip("rapidocr_onnxruntime")
    engine = rapidocr.RapidOCR(
        intra_op_num_threads=1, det_limit_side_len=640, det_limit_type="max"
    )

    def ocr(image: np.ndarray) -> list[tuple[list[list[float]], str, float]]:
        found, _ = engine(image, use_cls=False)
        return [(corners, words, float(score)) for corners, words, score in found or []]

    image = np.full((400, 300), 150, np.uint8)
    image[300:330, 80:220] = 20
    cv2.putText(image, text, (88, 322), cv2.FONT_HERSHEY_DUPLEX, 0.68, 245, 1, 16)
    photo = Photo("0" * 16, image, Box(0, 0, 300, 400))
    read = placard.read(photo, _board(Box(78, 298, 222, 332)), ocr)
    assert isinstance(read, Placard), read
    assert f"{read.block} {read.lot} {read.borough}" == text.replace("- ", "").replace(
        "-", ""
    )


def test_a_range_of_house_numbers_on_a_sign_is_no_board() -> None:
    assert not placard.read(_photo(), None, _saying(_piece(0, 0, "150-152")))
    assert placard.read(_photo(), None, _saying(_piece(0, 0, "996-31M")))
