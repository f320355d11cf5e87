"""What a file of corrections says of the one photo that is explained.

The manifest names a photo relative to its folder, so a row is of the photo whose path
ends so. This alone looks at the file's name; what is drawn then goes through the stages
as it does in a build.
"""

from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Final

from nostalgin_core import photo, steps
from nostalgin_core.records import Drawn
from pipelines import corrections
from pipelines.corrections import shapes

SHAPES: Final = ("mask", "quad")


@dataclass(frozen=True, eq=False)
class Redrawn:
    """What is drawn on a photo, and what a file says of it beside."""

    drawn: Drawn = steps.UNDRAWN
    told: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()

    @property
    def empty(self) -> bool:
        """Tell whether the file says nothing of this photo."""
        return not (self.told or self.refused)


def redrawn(path: Path, data: bytes, listed: Path) -> Redrawn:
    """Take from a file of corrections what is of a photo's own stages.

    A shape that leaves the photo is refused, by its row; so is a row that makes no
    sense, whichever photo it is of. A key, a height, an order and a target are of
    blocks, which one photo does not make: they are told, and change nothing here.

    Raises:
        OSError: if the file can't be read.
    """
    given = corrections.of_file(listed)
    refused = [f"{one.key}: {one.reason}: {one.detail}" for one in given.rejections]
    size = photo.size_px(data)
    found: dict[str, shapes.Points] = {}
    told = []
    for one in given.given:
        if not (one.photo and named(path, one.photo)):
            continue
        if one.what not in SHAPES:
            told.append(f"{one.row}: {one.what} is of its block: nothing changes here")
            continue
        points = shapes.read(one.shape)
        misfit = shapes.misfit(one.what, points, size) if size is not None else ""
        if misfit:
            refused.append(f"{one.row}: {one.what} {misfit}")
        else:
            told.append(f"{one.row}: {one.what} is taken as it is drawn")
            found[one.what] = points
    drawn = Drawn(found.get("mask"), found.get("quad"))
    return Redrawn(drawn, tuple(told), tuple(refused))


def named(path: Path, name: str) -> bool:
    """Tell whether a path ends as a manifest names a photo."""
    words = PurePath(name).parts
    return bool(words) and path.absolute().parts[-len(words) :] == words
