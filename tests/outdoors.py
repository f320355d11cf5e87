"""What a painted network says of every photograph: it was not taken in a room."""

import numpy as np

CELL_PX = 32


def outdoors(gray: np.ndarray) -> np.ndarray:
    """Answer for each cell of a picture."""
    height, width = gray.shape[-2:]
    return np.full((1, height // CELL_PX, width // CELL_PX), -9, np.float32)
