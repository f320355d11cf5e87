import cv2
import numpy as np
import pytest

from nostalgin_core.placard import spacing


def _board(words: list[tuple[str, int]], *, slant: float = 0.0) -> tuple:
    """Paint words at given x; return the image and the corners of the whole line."""
    image = np.full((80, 420), 25, np.uint8)
    for word, x in words:
        cv2.putText(image, word, (x, 50), cv2.FONT_HERSHEY_DUPLEX, 1.0, 235, 2, 16)
    corners = np.array([[16.0, 22.0], [404.0, 22.0], [404.0, 56.0], [16.0, 56.0]])
    turn = cv2.getRotationMatrix2D((210, 40), slant, 1.0)
    turned = cv2.warpAffine(image, turn, (420, 80), borderValue=25)
    return turned, corners @ turn[:, :2].T + turn[:, 2]


@pytest.mark.parametrize("slant", [0.0, 3.0, -3.0])
def test_a_gap_between_digits_becomes_a_space(slant: float) -> None:
    image, corners = _board([("997", 20), ("36", 150), ("M", 370)], slant=slant)
    assert spacing.parted(image, corners, "99736M") == "997 36M"


def test_a_dash_is_part_of_the_gap() -> None:
    image, corners = _board([("997", 20), ("-", 110), ("36", 150), ("M", 370)])
    assert spacing.parted(image, corners, "99736M") == "997 36M"


def test_letters_on_paper_are_parted_as_well() -> None:
    image, corners = _board([("997", 20), ("36", 150), ("M", 370)])
    assert spacing.parted(255 - image, corners, "99736M") == "997 36M"


@pytest.mark.parametrize("text", ["9973M", "997336M"])
def test_a_word_with_other_letters_than_seen_stays(text: str) -> None:
    image, corners = _board([("997", 20), ("36", 150), ("M", 370)])
    assert spacing.parted(image, corners, text) == text


def test_an_even_word_stays() -> None:
    image, corners = _board([("99736", 20), ("M", 370)])
    assert spacing.parted(image, corners, "99736M") == "99736M"


def test_nothing_painted_is_nothing_parted() -> None:
    image, corners = _board([])
    assert spacing.parted(image, corners, "99736M") == "99736M"
