import pytest

from nostalgin_core.catalogue import lengths


@pytest.mark.parametrize(
    ("written", "feet", "inches"),
    [
        ("0.60", 60, 0),
        ("0.20", 20, 0),
        ("0.92", 92, 0),
        ("1.25", 125, 0),
        ("1.00", 100, 0),
        ("2.43", 243, 0),
        ("98.09", 98, 9),
        ("203.10", 203, 10),
        ("20.1", 20, 10),
        ("50.05", 50, 5),
        ("25.00", 25, 0),
        ("25", 25, 0),
        ("42.5", 42, 5),
        (" 79.06 ", 79, 6),
    ],
)
def test_mangled_feet_and_inches_are_read(written: str, feet: int, inches: int) -> None:
    assert lengths.feet(written) == pytest.approx(feet + inches / 12)


def test_a_fraction_that_can_be_no_inches_is_decimal() -> None:
    assert lengths.feet("37.50") == pytest.approx(37.5)


@pytest.mark.parametrize(
    "written", ["", ".", "0", "0.05", "7.99", "-20", "wide", "9999", "9" * 5000]
)
def test_what_makes_no_front_is_not_read(written: str) -> None:
    assert lengths.feet(written) is None


def test_an_assumed_width_grows_with_the_house_numbers_it_takes() -> None:
    one, three = lengths.assumed_width("111"), lengths.assumed_width("108-112")
    assert one == pytest.approx(7.62)
    assert one < three < 3 * one + 0.1


@pytest.mark.parametrize("written", ["7.6", "18.25", "-73.98765", "120", "0.5"])
def test_a_decimal_comma_is_a_point(written: str) -> None:
    assert lengths.decimal(written.replace(".", ",")) == written
    assert lengths.decimal(written) == written


@pytest.mark.parametrize("written", ["1,234", "1,2,3", "7,", ",5", "12,14 rear", ""])
def test_a_comma_that_may_be_another_is_left(written: str) -> None:
    assert lengths.decimal(written) == written
