"""What is doubtful about a list's rows: in words for people, in fields for programs."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Doubt:
    """One thing that was noticed, and what of the list it is about; "" is nothing."""

    text: str
    block: str = ""
    lot: str = ""
    rows: tuple[int, ...] = ()  # of the list, as a spreadsheet counts
    address: str = ""  # number and street that the row gives the lot
    likely: tuple[str, ...] = ()  # addresses that would fit, the likeliest first
    photo: str = ""  # that a row names against its own name
    named: tuple[str, str] = ("", "")  # block and lot of that name
