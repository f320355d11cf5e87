"""One page that holds all it shows: no other file, no script, nothing from afar."""

import base64
from collections.abc import Sequence
from typing import Final

from jinja2 import Environment, PackageLoader, StrictUndefined

from pipelines import bounded
from pipelines.report.figures import Bar, Figures, Picture
from pipelines.store import Store

KINDS: Final = {".webp": "image/webp", ".jpg": "image/jpeg", ".png": "image/png"}


def page(found: Figures, store: Store, *, title: str) -> str:
    """Write the page as HTML; names are escaped, whatever is in them."""
    environment = Environment(
        loader=PackageLoader("pipelines.report", ""),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["widths"] = widths
    template = environment.get_template("page.html")
    seen = thumbnails(store, [*found.rejected, *found.least_seen, *found.least_sure])
    return template.render(title=title, found=found, pictures=seen)


def widths(bars: Sequence[Bar]) -> list[tuple[Bar, float]]:
    """Give each bar its length, in hundredths of the longest."""
    longest = max((bar.value for bar in bars), default=0) or 1
    return [(bar, round(100 * bar.value / longest, 1)) for bar in bars]


def thumbnails(store: Store, wanted: Sequence[Picture]) -> dict[str, str]:
    """Read small pictures of the site as data URIs, by key, where there are any."""
    keys = {one.key for one in wanted}
    found: dict[str, str] = {}
    for name in store.names("site/photos"):
        stem, dot, suffix = name.rpartition(".")
        kind = KINDS.get(dot + suffix)
        if stem not in keys or kind is None:
            continue
        data = store.read_bytes(f"site/photos/{name}", bounded.PHOTO_BYTES)
        found[stem] = f"data:{kind};base64,{base64.b64encode(data).decode()}"
    return found
