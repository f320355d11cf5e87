"""Painted streets, as much of them as rectification is measured on.

Every photo is of a lot of a street that was laid out for this alone: neither seed nor
street is used by a test, the demo or training. A photo costs more than a CPU second to
paint, so that a folder may keep what was painted.

Fronts are uneven and the lens bends (`scenes.flaws`) as much as in the tax photographs
of blocks 996 and 997: so that lines of a length scatter about a front's own points, the
halves of a front disagree, and neighbours lean as they do there; and the barrel is what
those photographs' lines fit best with. docs/rectification.md gives the figures.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from nostalgin_core import photo, scenes
from nostalgin_core.arrays import Matrix3
from nostalgin_core.records import Facade, Matted, Photo

SEED = 19_400_718  # of streets that nothing was tuned on
REAL = scenes.Flaws(stray_m=0.0055, barrel=0.008)
LEAST_SHARE = 0.005  # of the photo: a front that shows less is left out


@dataclass(frozen=True, slots=True, eq=False)
class Painted:
    """A photo, perfect masks, and what a rectifier ought to find on every front."""

    photo: Photo
    matted: Matted
    quads: Float[np.ndarray, "n 4 2"]
    vanishing_points: Float[np.ndarray, "n 2 3"]  # horizontal, then vertical
    aspects: Float[np.ndarray, " n"]
    complete: Bool[np.ndarray, " n"]  # wholly inside the frame
    camera: Matrix3


def paintings(
    fronts: int,
    *,
    seed: int = SEED,
    shape: tuple[int, int] = (840, 560),
    flawed: scenes.Flaws = REAL,
    keep: Path | None = None,
) -> Iterator[Painted]:
    """Paint photographs until they show so many fronts.

    With `keep`, a photo that lies there is read, and one that doesn't is put there.
    """
    shown, town = 0, 0
    while True:
        streets = scenes.neighbourhood(np.random.default_rng([seed, town]), blocks=1)
        lots = [lot for lot in streets.blocks[0].lots if not lot.ruined]
        for lot in lots:
            if shown >= fronts:
                return
            name = f"{seed}-{town:03d}-{lot.lot}-{shape[0]}"
            file = keep and keep / f"{name}-{flawed.stray_m}-{flawed.barrel}.npz"
            if not file or not file.exists():
                rng = np.random.default_rng([seed, town, int(lot.lot)])
                made = packed(
                    scenes.photograph(streets, lot, rng, shape=shape, flawed=flawed)
                )
                if file:
                    _write(file, made)
            else:
                with np.load(file) as stored:
                    made = dict(stored)
            one = unpacked(made)
            shown += len(one.quads)
            if len(one.quads):
                yield one
        town += 1


def packed(painted: scenes.PaintedPhoto) -> dict[str, np.ndarray]:
    """Take of a painted photo what is measured, as arrays; alpha in 255 steps."""
    least = LEAST_SHARE * painted.image.size
    fronts = [one for one in painted.truth.facades if one.visible.sum() >= least]
    size = (len(fronts), *painted.image.shape)
    return {
        "image": painted.image,
        "camera": painted.truth.camera.matrix,
        "visible": np.array([one.visible for one in fronts], bool).reshape(size),
        "amodal": np.array([one.amodal for one in fronts], bool).reshape(size),
        "alpha": np.rint(255 * np.array([one.alpha for one in fronts]))
        .astype(np.uint8)
        .reshape(size),
        "target": np.array([one.target for one in fronts], bool),
        "complete": np.array([one.complete for one in fronts], bool),
        "quad": np.array([one.quad for one in fronts]).reshape(-1, 4, 2),
        "points": np.array([one.vanishing_points for one in fronts]).reshape(-1, 2, 3),
        "aspect": np.array([one.aspect for one in fronts], np.float64),
    }


def unpacked(arrays: dict[str, np.ndarray]) -> Painted:
    """Put a photo and perfect masks together; the exposed frame is found, not told."""
    image = arrays["image"]
    facades = tuple(
        Facade(
            index,
            1.0,
            bool(target),
            float(target),
            arrays["visible"][index],
            arrays["amodal"][index],
            arrays["alpha"][index].astype(np.float32) / 255,
        )
        for index, target in enumerate(arrays["target"])
    )
    return Painted(
        Photo(photo.key(image.tobytes()), image, photo.exposed(image)),
        Matted(facades, ()),
        arrays["quad"],
        arrays["points"],
        arrays["aspect"],
        arrays["complete"],
        arrays["camera"],
    )


def _write(file: Path, arrays: dict[str, np.ndarray]) -> None:
    """Put a file in its place only once it is whole."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_suffix(".part")
    with part.open("wb") as stream:
        np.savez_compressed(stream, **arrays)  # pyright: ignore[reportArgumentType]
    part.rename(file)
