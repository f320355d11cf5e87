"""Print what blemishes painted on held-out photographs cost, and how many are found.

Run with `python tests/bench/bench_blemishes.py DATA/taxphotos`. Each photo of a block
that has a target front is answered as it is and with one blemish at a time: a black and
a white punched hole and a flare on the target's visible part, and letters across the
whole photo. Printed are the share of the blemish's pixels on labelled fronts that is
called an occluder, and the change of precision and recall before matting; what the
blemish covers is left out of both. Places and sizes are seeded from the photo's name.
"""

import argparse
import zlib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from nostalgin_core import matte, segment
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.matte.facade import covered_by
from nostalgin_core.measure.segmentation import Agreement, agreement
from nostalgin_core.photo import photo
from nostalgin_core.records import Photo, Rejection
from nostalgin_core.segment.segment import Network
from pipelines import models as shelf
from pipelines.evaluate import labels
from pipelines.evaluate.labels import Truth

FOUND = 0.9  # of a blemish's pixels
Painter = Callable[[Gray, Mask, np.random.Generator], tuple[Gray, Mask]]


def hole(level: int) -> Painter:
    """Punch a disc of 45 to 55 px radius, blurred by a pixel, into a front."""

    def paint(image: Gray, front: Mask, rng: np.random.Generator) -> tuple[Gray, Mask]:
        radius = int(rng.integers(45, 56))
        disc = spot(image.shape, place(front, radius, rng), radius)
        soft = cv2.GaussianBlur(disc, (0, 0), 1.0)
        return mixed(image, soft, float(level)), disc > 0

    return paint


def flare(image: Gray, front: Mask, rng: np.random.Generator) -> tuple[Gray, Mask]:
    """Burn a round spot of 28 to 45 px radius with a halo half as wide into a front."""
    radius = int(rng.integers(28, 46))
    disc = spot(image.shape, place(front, radius, rng), radius)
    away = cv2.distanceTransform(1 - (disc > 0).astype(np.uint8), cv2.DIST_L2, 5)
    soft = np.exp(-0.5 * (away / (radius / 2)) ** 2).astype(np.float32)
    return mixed(image, soft, 255.0), disc > 0


def letters(image: Gray, _: Mask, rng: np.random.Generator) -> tuple[Gray, Mask]:
    """Write bold rows of letters, 30 levels lighter or darker, over all of a photo."""
    ink = np.zeros(image.shape, np.uint8)
    start = int(rng.integers(40, 120))
    for row in range(start, image.shape[0], 120):
        cv2.putText(
            ink, "ARCHIVE COPY 1940", (10, row), cv2.FONT_HERSHEY_DUPLEX, 1.6, 1, 5
        )
    change = 30 * int(rng.choice([-1, 1]))
    written = np.clip(image.astype(np.int16) + change * ink.astype(np.int16), 0, 255)
    return written.astype(np.uint8), np.zeros(image.shape, bool)


KINDS: dict[str, Painter] = {
    "black hole": hole(4),
    "white hole": hole(252),
    "flare": flare,
    "letters": letters,
}


def spot(shape: tuple[int, ...], centre: tuple[int, int], radius: int) -> np.ndarray:
    """Draw a disc of ones."""
    return cv2.circle(np.zeros(shape, np.float32), centre, radius, 1.0, -1)


def mixed(image: Gray, soft: np.ndarray, level: float) -> Gray:
    """Lay one level over an image."""
    return np.clip(image * (1 - soft) + level * soft, 0, 255).astype(np.uint8)


def place(front: Mask, radius: int, rng: np.random.Generator) -> tuple[int, int]:
    """Choose where a disc lies mostly on a front: among the deepest tenth of it."""
    depth = cv2.distanceTransform(front.astype(np.uint8), cv2.DIST_L2, 5)
    least = min(radius, float(np.quantile(depth[front], 0.9)))
    ys, xs = np.nonzero(depth >= least)
    one = int(rng.integers(len(xs)))
    return int(xs[one]), int(ys[one])


def answered(image: Photo, network: Network) -> tuple[Mask, Mask]:
    """Tell what is claimed as visible front, and what as hiding."""
    shape = image.image.shape
    found = segment.segment(image, network)
    fronts = found if isinstance(found, Rejection) else matte.fronts(image, found)
    if isinstance(fronts, Rejection):
        return np.zeros(shape, bool), np.zeros(shape, bool)
    instances, facades = fronts
    hidden = covered_by(instances, shape)
    claimed = labels.union([one.mask for one in facades], shape)
    return claimed & ~hidden, hidden


def agreed(claimed: Mask, true: Truth, blemish: Mask) -> Agreement:
    """Compare what is claimed with the label, where the blemish is not."""
    soft = claimed.astype(np.float32)
    return agreement(soft, true.visible, ~true.far & ~blemish, threshold=0.5)


def measured(label: dict, file: Path, network: Network) -> dict[str, list[float]]:
    """Give, for each kind, covered share, and precision and recall after and before."""
    image = photo.decode(file.read_bytes(), name=file.name)
    if isinstance(image, Rejection):
        raise SystemExit(f"{file}: {image.reason}: {image.detail}")
    true = labels.truth(label, image.image.shape)
    targets = [one.visible for one in true.fronts if one.target and one.visible.any()]
    if not targets:
        return {}
    whole, _ = answered(image, network)
    rows: dict[str, list[float]] = {}
    for kind, paint in KINDS.items():
        rng = np.random.default_rng(zlib.crc32(f"{label['id']} {kind}".encode()))
        painted, blemish = paint(image.image, max(targets, key=np.count_nonzero), rng)
        spoilt = Photo(image.key, painted, image.frame)
        claimed, hidden = answered(spoilt, network)
        before, after = (agreed(one, true, blemish) for one in (whole, claimed))
        on_fronts = blemish & true.visible
        covered = np.count_nonzero(hidden & on_fronts) / max(
            1, np.count_nonzero(on_fronts)
        )
        rows[kind] = [covered, *after[:2], *before[:2]]
    return rows


def main() -> None:
    """Measure a folder's block, and print one line a kind."""
    parser = argparse.ArgumentParser(
        description="What blemishes painted on photos cost."
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--block", default="00993")
    parser.add_argument("--models", default=str(shelf.PACKAGED))
    parser.add_argument("--most", type=int, help="photos, spread evenly; all")
    asked = parser.parse_args()
    shelf.one_thread()
    network = shelf.Models(asked.models).load("segment")
    pairs = labels.pairs(asked.folder, block=asked.block)
    step = max(1, round(len(pairs) / (asked.most or len(pairs))))
    answers = [measured(*pair, network) for pair in pairs[::step]]
    for kind in KINDS:
        rows = np.array([answer[kind] for answer in answers if kind in answer])
        covered, change = rows[:, 0], rows[:, 1:3] - rows[:, 3:5]
        found = (
            ""
            if kind == "letters"
            else (
                f"{np.count_nonzero(covered >= FOUND)} covered by {FOUND} or more "
                f"(median {np.median(covered):.2f}); "
            )
        )
        print(
            f"{kind}: {len(rows)} photos; {found}precision {change[:, 0].mean():+.3f}, "
            f"recall {change[:, 1].mean():+.3f} (worst {change[:, 1].min():+.3f})"
        )


if __name__ == "__main__":
    main()
