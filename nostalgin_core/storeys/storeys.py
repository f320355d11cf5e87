"""Storeys repeat: shifted down by one of them, a front looks like itself.

The front is correlated with itself under every vertical shift, over the pixels that a
camera saw. A period is scored by how much better whole multiples of it agree than
shifts by parts of it, which agree as well where several storeys are taken for one. A
ground floor is higher than the others and a cornice stands on top, so that n storeys
take the height of n + `EXTRA` of the repeated ones.
"""

from typing import Final

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from nostalgin_core.arrays import Gray, Mask

FEWEST, MOST = 1.5, 40.0
COUNTS: Final = np.geomspace(FEWEST, MOST, 83)  # 4 % apart
EXTRA: Final = 0.7
MOST_ROWS, MOST_COLUMNS = 400, 300  # of the picture that is looked at
LEAST_ROWS: Final = 5.0  # of one storey
LOCAL: Final = 0.08  # of the longer side: the light's slow changes are taken out
STRONGEST: Final = 2.0  # local deviations: no lamp and no sign outshouts the windows
LEAST_OVERLAP: Final = 0.05  # of all pixels, for a shift to count
DEEPEST: Final = 0.75  # of the height: the largest shift
MULTIPLES: Final = 6
PARTS: Final = (1 / 3, 2 / 5, 1 / 2, 3 / 5, 2 / 3)  # of a period: it must not repeat

Scores = Float[np.ndarray, " counts"]
Small = UInt8[np.ndarray, "rows columns"]
SmallMask = Bool[np.ndarray, "rows columns"]


def scores(image: Gray, seen: Mask) -> Scores:
    """Score each of `COUNTS`: about 0 where nothing repeats, at most 1 where all does.

    `image` is a front seen straight on, from foot to roof; `seen` is where a camera
    saw it. Too little of it gives zeros.
    """
    flat, weight = flattened(*small(image, seen))
    alike = autocorrelation(flat, weight)
    return np.array([comb(alike, len(flat) / (n + EXTRA)) for n in COUNTS])


def small(image: Gray, seen: Mask) -> tuple[Small, SmallMask]:
    """Shrink a picture to what is enough to tell its rows of windows."""
    height, width = image.shape
    rows, columns = min(height, MOST_ROWS), min(width, MOST_COLUMNS)
    if (rows, columns) == (height, width):
        return image, seen
    size = (columns, rows)
    part = cv2.resize(seen.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA), part > 0.5


def flattened(
    image: Gray, seen: Mask
) -> tuple[Float[np.ndarray, "h w"], Float[np.ndarray, "h w"]]:
    """Take the slow changes of light and contrast out; what is not seen is 0."""
    weight = seen.astype(np.float32)
    sigma = LOCAL * max(image.shape)
    near = cv2.GaussianBlur(weight, (0, 0), sigma) + 1e-3
    mean = cv2.GaussianBlur(image * weight, (0, 0), sigma) / near
    apart = (image - mean) * weight
    spread = np.sqrt(cv2.GaussianBlur(apart**2, (0, 0), sigma) / near) + 8.0
    flat = np.clip(apart / spread, -STRONGEST, STRONGEST) * weight
    return flat.astype(np.float64), weight.astype(np.float64)


def autocorrelation(
    flat: Float[np.ndarray, "h w"], weight: Float[np.ndarray, "h w"]
) -> Float[np.ndarray, " lags"]:
    """Correlate a picture with itself under each vertical shift, over what both saw.

    Shifts under which too little is seen twice are left out from there on.
    """
    height = len(flat)
    spectra = [np.fft.rfft(one, 2 * height, axis=0) for one in (flat, flat**2, weight)]

    def shifted(first: np.ndarray, second: np.ndarray) -> Float[np.ndarray, " lags"]:
        both = (np.conj(first) * second).sum(axis=1)
        return np.fft.irfft(both, 2 * height)[: int(DEEPEST * height)]

    power = shifted(spectra[1], spectra[2]) * shifted(spectra[2], spectra[1])
    alike = shifted(spectra[0], spectra[0]) / np.sqrt(np.maximum(power, 1e-6))
    thin = shifted(spectra[2], spectra[2]) < LEAST_OVERLAP * flat.size
    return alike[: int(np.argmax(thin))] if thin.any() else alike


def comb(alike: Float[np.ndarray, " lags"], period: float) -> float:
    """Score a period, in rows; 0 where no multiple of it was compared."""
    count = min(int((len(alike) - 1) / period), MULTIPLES)
    if period < LEAST_ROWS or count < 1:
        return 0.0
    whole = np.arange(1, count + 1)
    shifts = whole - np.array([[0.0], *[[part] for part in PARTS]])
    at = np.interp(shifts * period, np.arange(len(alike)), alike)
    weights = whole**-0.5
    return float((at[0] - at[1:].max(axis=0)) @ weights / weights.sum())
