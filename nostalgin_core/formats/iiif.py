"""The photographs of a city as a IIIF Presentation 3.0 manifest, a canvas each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

Json = dict[str, Any]

CONTEXT: Final = "http://iiif.io/api/presentation/3/context.json"


@dataclass(frozen=True, slots=True)
class Canvas:
    """One photograph: its picture, and what is known of it."""

    name: str  # harmless in an address
    label: str
    file: str  # of the picture, relative to the base
    mime: str
    width_px: int
    height_px: int
    credit: str
    rights: str  # an address of Creative Commons or rightsstatements.org, or empty
    source: str  # the archive's record, or empty
    known: Mapping[str, str]  # lot, address ...


def presentation(base: str, *, title: str) -> Json:
    """Begin the manifest of pictures that lie below `base`, an address that ends in /.

    Its `items`, which come last, are the canvases (`canvas`), one at least. Every
    language is "none": nobody told which one a caption is in.
    """
    return {
        "@context": CONTEXT,
        "id": f"{base}iiif/manifest.json",
        "type": "Manifest",
        "label": _text(title or "Photographs"),
        "items": [],
    }


def canvas(base: str, one: Canvas) -> Json:
    """Write the canvas of one picture below `base`."""
    home = f"{base}iiif/canvas/{one.name}"
    size = {"width": one.width_px, "height": one.height_px}
    image = {"id": f"{base}{one.file}", "type": "Image", "format": one.mime, **size}
    painting = {
        "id": f"{home}/annotation",
        "type": "Annotation",
        "motivation": "painting",
        "body": image,
        "target": home,
    }
    made: Json = {
        "id": home,
        "type": "Canvas",
        "label": _text(one.label),
        **size,
        "metadata": [
            {"label": _text(label), "value": _text(value)}
            for label, value in one.known.items()
            if value
        ],
        "items": [
            {"id": f"{home}/page", "type": "AnnotationPage", "items": [painting]}
        ],
    }
    if one.credit:
        credit = {"label": _text("Credit"), "value": _text(one.credit)}
        made["requiredStatement"] = credit
    if one.rights:
        made["rights"] = one.rights
    if one.source:
        page = {"id": one.source, "type": "Text", "label": _text("Archive's record")}
        made["homepage"] = [page | {"format": "text/html"}]
    return made


def _text(words: str) -> dict[str, list[str]]:
    return {"none": [words]}
