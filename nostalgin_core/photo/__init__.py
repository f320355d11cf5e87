"""A photograph's bytes become gray pixels, upright, and the frame that was exposed.

In: a file's bytes. Out: a `Photo`, keyed by its content, or a `Rejection`.
Paper: section 3.1, one gray photo, nothing known of the camera. Open `photo` first.
"""

from nostalgin_core.photo.frame import exposed, framed
from nostalgin_core.photo.photo import decode, key, paged, size_px

__all__ = ["decode", "exposed", "framed", "key", "paged", "size_px"]
