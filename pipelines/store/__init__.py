"""A city folder: files that are there wholly or not at all, under keys of their making.

In: bytes, tables, records, rejections. Out: the same, on any machine.
Open `store` first. Beside the door stand `versions`, which names what is kept by the
code and parameters that made it, `runs` and `tables`.
"""

from pipelines.store.aside import Aside
from pipelines.store.disk import SECRETIVE, Unstored, absent, secretive, textual
from pipelines.store.lock import Busy, busy, held
from pipelines.store.packing import Piece, pack, pack_piece, pieces
from pipelines.store.seal import Damaged
from pipelines.store.shelf import Shelf
from pipelines.store.stable import key_of
from pipelines.store.store import Store

__all__ = [
    "SECRETIVE",
    "Aside",
    "Busy",
    "Damaged",
    "Piece",
    "Shelf",
    "Store",
    "Unstored",
    "absent",
    "busy",
    "held",
    "key_of",
    "pack",
    "pack_piece",
    "pieces",
    "secretive",
    "textual",
]
