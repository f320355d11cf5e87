"""The head that tells rooms from streets is fitted to modern rooms and to streets.

Rooms are the indoor half of York Urban, told by eye; streets are its other half, so
that nothing is learnt of who took these photographs, those of either archive, facades
and streets of other collections, and painted streets. York's are shown as they are and
aged (`wear`). The weights minimise the logistic loss, rooms weighing as much as all
streets and York's streets as much as the others, plus their squares, each as the spread
of its feature has it. Block 993, one street in ten and the four rooms of
`historic_streets` are kept out.

What is refused follows from the labelled streets, each judged by what the others
taught: beyond their highest twentieth, log odds are taken to fall off exponentially.

    python -m export.fit_indoors --data DATA --painted FOLDER --features FOLDER --into F
"""

import argparse
import zlib
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Final, NamedTuple

import cv2
import numpy as np
import torch
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from export.indoors import features
from export.mask_rcnn import Backbone
from export.mask_rcnn_onnx import SHIPPED, locked
from export.painted_segmentation_data import read_painted
from export.remembered import remembered
from export.segmentation_data import kept_out
from export.wear import wear
from export.weights import INDOORS, read_weights
from nostalgin_core.arrays import Gray
from nostalgin_core.photo import framed
from nostalgin_core.segment import Network
from nostalgin_core.segment.indoors import shares
from nostalgin_core.segment.segment import shown

ROOMS: Final = (  # of York Urban; P1020872, a roofed passage, is neither
    *("P1020831", "P1020833", "P1020839", "P1020841", "P1020887", "P1020928"),
    *("P1040788", "P1040795", "P1040801", "P1040811", "P1040812", "P1040813"),
    *("P1040814", "P1040826", "P1040845", "P1040850", "P1040853", "P1080032"),
    *("P1080033", "P1080078", "P1080092"),
)
NEITHER: Final = ("P1020872",)
OLD_ROOMS: Final = ("703840f-a", "703840f-b", "716168f-a", "717371f-a")
OTHERS: Final = ("street_facades_cc0", "rectified_facades", "facades_coco")
EACH: Final = 15  # of the others, and every third painted street
YORK: Final = "York Urban"
AGED: Final = 1  # copies of York's
BACKBONE: Final = "backbone."
LABELLED: Final = ("historic_streets", "historic_streets, kept out")
SEED: Final = 51
FOLDS: Final = 10
RIDGE: Final = 0.3  # on weights of features of spread 1, against a loss of weight 1
HIGHEST: Final = 0.05  # share of streets whose log odds tell how they fall off
RARELY: Final = 2000  # one street in so many may be refused
SURELY: Final = 6  # streets that are named, the surest first
TAX: Final = "nynyma_rec0040_1_"  # what the labels' names leave out


class Shown(NamedTuple):
    """A photograph to learn from, or to judge."""

    kind: str  # where it is from
    name: str
    image: Gray
    learnt: bool
    room: bool = False


class Told(NamedTuple):
    """What is known of photographs, a row each."""

    kinds: np.ndarray
    names: np.ndarray
    learnt: Bool[np.ndarray, " n"]
    rooms: Bool[np.ndarray, " n"]
    features: Float[np.ndarray, "n 416"]

    def only(self, rows: Bool[np.ndarray, " n"]) -> "Told":
        """Keep some."""
        return Told(*(column[rows] for column in self))


def york(data: Path) -> Iterator[Shown]:
    """Yield York Urban's photographs, as they are and aged."""
    for path in sorted((data / "york_urban").glob("*/*.jpg")):
        if path.stem in NEITHER:
            continue
        image, room = _read(path), path.stem in ROOMS
        yield Shown(YORK, path.stem, image, learnt=True, room=room)
        for turn in range(AGED):
            rng = np.random.default_rng([SEED, turn, zlib.crc32(path.stem.encode())])
            yield Shown(YORK, path.stem, wear(image, rng), learnt=True, room=room)


def archives(data: Path) -> Iterator[Shown]:
    """Yield tax photographs and New York's streets, labelled and not."""
    for folder in ("taxphotos", "historic_streets"):
        labels = {path.stem for path in (data / folder / "labels").glob("*.json")}
        for path in sorted((data / folder / "photos").glob("*.jpg")):
            stem = path.stem.removeprefix(TAX)
            known = stem in labels
            out, room = kept_out(folder, stem), stem in OLD_ROOMS
            kind = f"{folder}, kept out" if out else folder
            kind = kind if known else f"{folder}, no label"
            learnt = not (room or (known and out))
            yield Shown(kind, stem, _read(path), learnt, room=room)


def others(data: Path, painted: Path) -> Iterator[Shown]:
    """Yield some of the modern facades and streets, and of the painted ones."""
    for folder in OTHERS:
        for path in sorted((data / folder).rglob("*.jpg"))[::EACH]:
            yield Shown(folder, path.stem, _read(path), learnt=True)
    for sample in read_painted(painted)[::3]:
        yield Shown("painted", sample.name, sample.image, learnt=True)


def table(photographs: Iterator[Shown], seen: Network) -> Told:
    """Ask what the backbone makes of photographs: means over each one's frame."""
    rows, kept = [], []
    for one in photographs:
        photo = framed(one.name, one.image)
        (grid,) = seen(shown(photo)[None, None])
        down, across = shares(grid.shape[1:], photo.sheet or photo.frame, photo.frame)
        rows.append(np.einsum("r,nrc,c->n", down, grid, across))
        kept.append((one.kind, one.name, one.learnt, one.room))
    kinds, names, learnt, rooms = map(np.array, zip(*kept, strict=True))
    return Told(kinds, names, learnt, rooms, np.array(rows))


def backbone(weights: Mapping[str, np.ndarray]) -> Network:
    """Return what shows what a backbone makes of a picture, (416 h/32 w/32)."""
    network = Backbone()
    own = {k: v for k, v in weights.items() if k.startswith(BACKBONE)}
    state = {k.removeprefix(BACKBONE): torch.tensor(v) for k, v in own.items()}
    network.load_state_dict(state)
    network.eval().to(memory_format=torch.channels_last)

    @torch.inference_mode()
    def call(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        image = torch.from_numpy(gray).to(memory_format=torch.channels_last)
        return (features(network.body(image / 127.5 - 1))[0].numpy(),)

    return call


def fit(told: Told, *, ridge: float = RIDGE) -> Float[np.ndarray, " 417"]:
    """Return a weight for each feature and, last, what is added."""
    rows = told.features
    middle, spread = rows.mean(0), rows.std(0) + 1e-6
    even = (rows - middle) / spread
    share, york = np.zeros(len(rows)), told.kinds == YORK
    for part in (told.rooms, ~told.rooms & york, ~told.rooms & ~york):
        share[part] = 1 / max(1, part.sum())
    sign = np.where(told.rooms, -1.0, 1.0)
    share[told.rooms] *= 2  # as much as both kinds of streets

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        score = sign * (even @ weights[:-1] + weights[-1])
        slope = share * sign / (1 + np.exp(-score))
        lost = (share * np.logaddexp(0, score)).sum()
        lost += ridge / 2 * (weights[:-1] ** 2).sum()
        return lost, np.append(slope @ even + ridge * weights[:-1], slope.sum())

    begin = np.zeros(rows.shape[1] + 1)
    weights = minimize(loss, begin, jac=True, method="L-BFGS-B").x
    weights[:-1] /= spread
    weights[-1] -= weights[:-1] @ middle
    return weights


def scores(told: Told) -> Float[np.ndarray, " n"]:
    """Return each photograph's log odds, what is learnt from by the other folds'."""
    fold = np.array([zlib.crc32(name.encode()) % FOLDS for name in told.names])
    log_odds = at(told, fit(told.only(told.learnt)))
    for one in range(FOLDS):
        others = fit(told.only(told.learnt & (fold != one)))
        left = told.learnt & (fold == one)
        log_odds[left] = at(told, others)[left]
    return log_odds


def enough(streets: Float[np.ndarray, " n"]) -> float:
    """Return the log odds that one street in `RARELY` is expected to exceed."""
    high = float(np.quantile(streets, 1 - HIGHEST))
    beyond = streets[streets > high] - high
    return high + float(beyond.mean()) * float(np.log(HIGHEST * RARELY))


def at(told: Told, weights: Float[np.ndarray, " 417"]) -> Float[np.ndarray, " n"]:
    """Return the log odds that weights give each photograph."""
    return told.features @ weights[:-1] + weights[-1]


def report(told: Told, log_odds: Float[np.ndarray, " n"]) -> Iterator[str]:
    """Say how rooms and streets of each kind are told apart."""
    rooms = log_odds[told.rooms & (told.kinds == YORK)]
    yield f"York's rooms: {_spread(rooms)}"
    for kind in sorted(set(told.kinds.tolist())):
        these = ~told.rooms & (told.kinds == kind)
        streets = log_odds[these]
        under = (rooms[:, None] > streets[None]).mean()
        line = (
            f"{kind}, {len(streets)}: {_spread(streets)}; under the curve {under:.4f}"
        )
        first = np.argsort(-streets)[:SURELY]
        named = [f"{told.names[these][i]} {streets[i]:.2f}" for i in first]
        yield f"{line}; {', '.join(named)}"
    streets = [kind in LABELLED for kind in told.kinds]
    yield f"enough: {enough(log_odds[np.array(streets)]):.2f}"
    old = told.rooms & (told.kinds != YORK)
    for name, score in zip(told.names[old], log_odds[old], strict=True):
        yield f"{name}: {score:.2f}"


def _spread(log_odds: Float[np.ndarray, " n"]) -> str:
    least, low, middle, high, most = np.percentile(log_odds, (0, 10, 50, 90, 100))
    return f"{least:.2f} [{low:.2f} {middle:.2f} {high:.2f}] {most:.2f}"


def _read(path: Path) -> Gray:
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise ValueError(f"not a picture: {path}")
    return image


def main() -> None:
    """Fit, print how rooms are told, and write the network's weights with the head."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--painted", type=Path, required=True)
    parser.add_argument("--features", type=Path, required=True, help="remembered")
    parser.add_argument("--into", type=Path, required=True, help=".npz of all weights")
    args = parser.parse_args()
    torch.set_num_threads(1)
    weights = read_weights(SHIPPED)
    seen = remembered(backbone(weights), args.features, "deepest taps " + locked())
    photographs = chain(
        york(args.data), archives(args.data), others(args.data, args.painted)
    )
    told = table(photographs, seen)
    for line in report(told, scores(told)):
        print(line)
    head = fit(told.only(told.learnt)).astype(np.float32)
    weights[INDOORS + "say.weight"] = head[None, :-1, None, None]
    weights[INDOORS + "say.bias"] = head[-1:]
    np.savez(args.into, allow_pickle=False, **weights)


if __name__ == "__main__":
    main()
