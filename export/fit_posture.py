"""The weights of `nostalgin_core/segment/posture.py` are fitted to photographs.

Every photograph that stands upright tells which of the five postures is the one it was
meant in. Weights maximise that posture's likelihood, less their squares, each as the
spread of its cue has it. Block 993 and one street in ten are kept out; what lies on its
side, is a negative or no street is left out by name. The weights that ship were fitted
while 711673f-c to 713416f-b, 719051f-a and 723553f-d were not yet left out.

    python -m export.fit_posture --data DATA
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize

from export.segmentation_data import kept_out
from nostalgin_core.photo import framed
from nostalgin_core.segment.posture import DOUBT, LOOKS, POSTURES, WEIGHTS, cues

Cues = Float[np.ndarray, "n 5 13"]
FOLDERS = ("taxphotos", "historic_streets")
TAX = "nynyma_rec0040_1_"  # what the labels' names leave out
ODD = (  # on their sides, negatives, indoors, several on a page, painted, from above
    *("702455f-a", "703840f-a", "703840f-b", "708719f", "708986f", "709562f-b"),
    *("711673f-c", "712738f-c", "713070f-b", "713264f-f", "713416f-b", "717371f-a"),
    *("717525f-b", "718270f-a", "719018f", "719051f-a", "719574f-c", "719578f-b"),
    *("719578f-c", "723259f-a", "723294f", "723553f-d", "724549f", "727591f-a"),
)


def fit(every: Cues) -> Float[np.ndarray, " 13"]:
    """Return the weights under which upright photographs are likeliest told."""
    spread = every.std((0, 1)) + 1e-9
    even = every / spread

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        p = likely(even, weights)
        lost = -np.log(p[:, 0]).sum() + (weights**2).sum()
        slope = (np.einsum("np,npc->nc", p, even) - even[:, 0]).sum(0) + 2 * weights
        return float(lost), slope

    begin = np.zeros(every.shape[2])
    return minimize(loss, begin, jac=True, method="L-BFGS-B").x / spread


def likely(every: Cues, weights: Float[np.ndarray, " 13"]) -> np.ndarray:
    """Return each posture's probability, a row a photograph."""
    told = every @ weights
    odds = np.exp(told - told.max(1, keepdims=True))
    return odds / odds.sum(1, keepdims=True)


def seen(data: Path, *, held_out: bool) -> Iterator[Float[np.ndarray, "5 13"]]:
    """Yield the cues of what stands upright and is trained on, or is kept out."""
    for folder in FOLDERS:
        for path in sorted((data / folder / "photos").glob("*.jpg")):
            stem = path.stem.removeprefix(TAX)
            if stem in ODD or kept_out(folder, stem) != held_out:
                continue
            image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
            if image is not None:
                shown = framed(stem, image)
                x0, y0, x1, y1 = shown.sheet or shown.frame
                yield cues(image[y0:y1, x0:x1])


def told(every: Cues, weights: Float[np.ndarray, " 13"]) -> str:
    """Say how many are looked at again, and how many turned ones would be told."""
    p = likely(every, weights)
    again = [f"{(p[:, 0] < DOUBT).mean():.3f} of upright ones are doubted"]
    for turned, posture in enumerate(POSTURES[1:], start=1):
        others = p.copy()
        others[:, turned] = -1  # what it is taken for as it lies
        first = np.argsort(-others, axis=1)[:, :LOOKS]
        met = (p[:, turned] < DOUBT) & (first == 0).any(1)
        again.append(f"{posture.reason}: {met.mean():.3f} are shown upright")
    return "; ".join(again)


def main() -> None:
    """Fit, and print the weights and what they are good for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    data = parser.parse_args().data
    learnt, held = (np.array(list(seen(data, held_out=k))) for k in (False, True))
    weights = fit(learnt)
    print("weights", np.round(weights, 2).tolist())
    print(f"{len(learnt)} fitted: {told(learnt, weights)}")
    print(f"{len(held)} held out: {told(held, weights)}")
    print(f"as shipped, held out: {told(held, WEIGHTS)}")


if __name__ == "__main__":
    main()
