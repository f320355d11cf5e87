"""The arrays that pass between functions, named by dtype and shape.

Conventions, for the whole project:

- Points are rows of `(x, y)`; x grows to the right, y grows down. Pixel centres lie at
  whole numbers, so the top-left pixel of an image covers -0.5 to 0.5 on both axes.
- Image shapes are `(h, w)`. Photographs are gray, 8 bits, 0 is black.
- Boxes are half-open and read x0, y0, x1, y1. Quads read top left, top right, bottom
  right, bottom left.
- Maps are named `b_from_a`, so that neighbours cancel:
  `c_from_a = c_from_b @ b_from_a`.
- On the ground, east is x and north is y, in metres; up is z. A ring of fronts runs
  anticlockwise seen from above, so that each front, seen from its street, has its start
  on the left and its end on the right.
- glTF's axes are (x, y, z) = (east, up, -north).
"""

import numpy as np
from jaxtyping import Bool, Float, UInt8, UInt32

Gray = UInt8[np.ndarray, "h w"]
Probability = Float[np.ndarray, "h w"]  # 0 to 1
Alpha = Float[np.ndarray, "h w"]  # 0 to 1
Mask = Bool[np.ndarray, "h w"]
EvidenceMap = UInt8[np.ndarray, "h w"]  # codes of `evidence`
Points = Float[np.ndarray, "n 2"]
Lines = Float[np.ndarray, "n 4"]  # x0, y0, x1, y1
Corners = Float[np.ndarray, "4 2"]
Homogeneous = Float[np.ndarray, "n 3"]
Matrix3 = Float[np.ndarray, "3 3"]
Triangles = UInt32[np.ndarray, "t 3"]

__all__ = [
    "Alpha",
    "Corners",
    "EvidenceMap",
    "Gray",
    "Homogeneous",
    "Lines",
    "Mask",
    "Matrix3",
    "Points",
    "Probability",
    "Triangles",
]
