"""Take a known watermark out of a photo that bears it; leave any other as it is.

A copy that is much finer than those that the tile was measured on is a scan of its own:
its tiles may be a little larger or smaller, and lie a little beside. Half a stroke is
enough for a ghost, so there the tiles' steps and place are sought (`seated`), and the
mark is left in where that does not take it out.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Photo
from nostalgin_core.rectify import watermark
from nostalgin_core.rectify.watermark import LEAST_SURE, Standing, Watermark

FINER: Final = 9 / 7  # than the known copies: there the tiles' place is sought
COARSE: Final = (2e-3, 1e-3, 5e-4)  # of steps: how far at once their place is sought
FINE: Final = (5e-4, 2.5e-4, 1.25e-4)  # at full size
TILE: Final = 4.0  # times that, of tiles
MOST_MOVES: Final = 30  # at each of these
MOST_LEFT: Final = 0.3  # of the mark's strength: with more a ghost would stay


class Seat(NamedTuple):
    """Where a copy's tiles lie: steps over the known ones, less 1, and shifts."""

    across: float = 0.0
    down: float = 0.0
    right: float = 0.0
    below: float = 0.0


def unmarked(photo: Photo, mark: Watermark | None) -> tuple[Photo, str]:
    """Take a mark out of a photo that bears it, and give its words; else give neither.

    A tone that the solution takes beyond white or black ends there.
    """
    if mark is None:
        return photo, ""
    told = watermark.fit(photo.image, mark)
    if photo.image.shape[1] <= FINER * mark.wide_px:
        clear = solved(photo.image, mark) if told.borne else None
    else:
        clear = sought(photo.image, mark) if told.surely > LEAST_SURE else None
    return (photo, "") if clear is None else (replace(photo, image=clear), mark.words)


def solved(image: Gray, mark: Watermark) -> Gray:
    """Solve a copy for its photograph."""
    covers, adds = watermark.laid(mark, image.shape)
    bare = (image - adds) / (1 - covers)
    return np.clip(np.rint(bare), 0, 255).astype(np.uint8)


def sought(image: Gray, mark: Watermark) -> Gray | None:
    """Solve a finer copy, its tiles' place sought; None where the mark would stay."""
    seat = seated(watermark.shrunk(image, mark), mark, Seat(), COARSE)
    own = laid_on(mark, seated(image, mark, seat, FINE))
    clear = solved(image, own)
    before, after = (at_full_size(one, own) for one in (image, clear))
    low, high = watermark.STRENGTHS
    taken = low < before < high and abs(after) < MOST_LEFT * before
    return clear if taken else None


def at_full_size(image: Gray, mark: Watermark) -> float:
    """Tell how strongly an image bears a mark, without shrinking it."""
    bare = watermark.background(mark, image.shape)
    return watermark.strength(watermark.summed(image, bare, mark), mark, (0, 0))


def laid_on(mark: Watermark, seat: Seat) -> Watermark:
    """Lay a mark's tiles where a copy has them."""
    across, down = mark.step
    step = across * (1 + seat.across), down * (1 + seat.down)
    return replace(mark, step=step, shift=(seat.right, seat.below))


def seated(image: Gray, mark: Watermark, start: Seat, by: Sequence[float]) -> Seat:
    """Seek where an image's tiles lie, from a start, by ever smaller steps.

    What stands beside letters is told anew for each of them.
    """
    best = start
    for step in by:
        shown = watermark.background(laid_on(mark, best), image.shape)
        seen = watermark.standing(image, shown, near_px=mark.near_px)
        explained = explains(seen, laid_on(mark, best))
        for _ in range(MOST_MOVES):
            tried = ((explains(seen, laid_on(mark, s)), s) for s in beside(best, step))
            most, there = max(tried)
            if most <= explained:
                break
            best, explained = there, most
    return best


def beside(seat: Seat, step: float) -> Iterator[Seat]:
    """List the seats beside one, either way."""
    for name, by in zip(
        Seat._fields, (step, step, TILE * step, TILE * step), strict=True
    ):
        for turn in (-by, by):
            yield seat._replace(**{name: getattr(seat, name) + turn})


def explains(seen: Standing, mark: Watermark) -> float:
    """Tell how much of what stands out of an image a mark explains."""
    covers, adds = watermark.laid(mark, seen.over.shape)
    change = adds - covers * seen.tone
    over = float((seen.weight * seen.over * change).sum())
    under = float((seen.weight * change**2).sum())
    return over * abs(over) / under if under > 0 else 0.0
