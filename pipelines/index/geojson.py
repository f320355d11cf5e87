"""Outlines in GeoJSON (RFC 7946) and CityJSON (1 and 2), read feature by feature."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

DEGREES: Final = "EPSG:4326"
BROKEN: Final = (ValueError, TypeError, KeyError, IndexError, AttributeError)
REPROJECT: Final = (
    "name their reference system (`--outline-crs EPSG:2263`), or reproject them to "
    "longitude and latitude"
)


class NoOutlines(ValueError):  # noqa: N818 - it reads as what it is about
    """A file that holds no outlines that can be used, with the remedy."""


@dataclass(frozen=True)
class Feature:
    """One outline, in degrees, valid; None where it makes none."""

    number: int  # from 1, as it stands in the file
    properties: dict[str, Any]
    shape: BaseGeometry | None
    fault: str = ""  # what is wrong with it, or was and is mended


def features(data: bytes, crs: str = "") -> list[Feature]:
    """Read all features of a GeoJSON or CityJSON file, as degrees of WGS 84.

    `crs` goes before what the file says of its reference system.

    Raises:
        NoOutlines: if it is empty, no such file, or in no degrees and says not what.
    """
    if not data.strip():
        raise NoOutlines("is empty: export it again")
    try:
        told = json.loads(data)
    except (ValueError, RecursionError) as problem:
        raise NoOutlines(f"is no JSON ({problem}): export it as GeoJSON") from problem
    kind = told.get("type") if isinstance(told, dict) else None
    try:
        if kind == "CityJSON":
            found, said = list(_of_city(told)), _reference(told)
        elif kind in ("FeatureCollection", "Feature"):
            found, said = list(_of_features(told)), _named(told)
        else:
            words = "neither a GeoJSON FeatureCollection nor CityJSON"
            raise NoOutlines(f"is {words}: export it as one of them")
    except BROKEN as problem:
        if isinstance(problem, NoOutlines):
            raise
        raise NoOutlines(f"breaks the rules of {kind} ({problem!r})") from problem
    if not found:
        raise NoOutlines("holds no feature: export it again")
    return _in_degrees([_mended(one) for one in found], crs or said)


def _of_features(told: dict[str, Any]) -> Iterator[Feature]:
    every = told["features"] if told["type"] == "FeatureCollection" else [told]
    for number, one in enumerate(every, 1):
        try:
            properties = dict(one.get("properties") or {})
            shape = shapely.geometry.shape(one["geometry"])
            yield Feature(number, properties, shape)
        except (*BROKEN, shapely.errors.ShapelyError):
            yield Feature(number, {}, None, "has a geometry that makes no sense")


def _of_city(told: dict[str, Any]) -> Iterator[Feature]:
    """Give each object's surfaces, seen from above; parts carry their parents' key."""
    points = np.array(told["vertices"], float).reshape(-1, 3)
    if "transform" in told:
        points = points * told["transform"]["scale"] + told["transform"]["translate"]
    objects = told["CityObjects"]
    for number, (name, one) in enumerate(objects.items(), 1):
        properties = {"id": name}
        for parent in one.get("parents", ()):
            properties |= objects.get(parent, {}).get("attributes") or {}
        properties |= one.get("attributes") or {}
        rings = [
            ring
            for each in one.get("geometry", ())
            for ring in _exteriors(each.get("boundaries", ()))
        ]
        flat = [shapely.Polygon(points[ring, :2]) for ring in rings if len(ring) > 2]
        flat = [one for one in flat if one.is_valid and one.area > 0]  # no walls
        if flat:
            yield Feature(number, properties, shapely.union_all(flat))


def _exteriors(nested: Any) -> Iterator[list[int]]:
    """Find all rings of vertices, however deep."""
    if nested and all(isinstance(one, int) for one in nested):
        yield list(nested)
    else:
        for one in nested:
            yield from _exteriors(one)


def _reference(told: dict[str, Any]) -> str:
    """Read CityJSON's reference system, a URL that ends in authority, version, code."""
    parts = str((told.get("metadata") or {}).get("referenceSystem", "")).split("/")
    return f"{parts[-3]}:{parts[-1]}" if len(parts) > 3 else parts[-1]


def _named(told: dict[str, Any]) -> str:
    """Read the reference system that GeoJSON had before it was a standard."""
    crs = told.get("crs")
    return str(crs["properties"]["name"]) if isinstance(crs, dict) else ""


def _mended(one: Feature) -> Feature:
    shape = one.shape
    if shape is None:
        return one
    if not np.isfinite(shapely.get_coordinates(shape)).all():
        return Feature(one.number, one.properties, None, "has no finite coordinates")
    fault = ""
    if not shape.is_valid:
        shape, fault = shapely.make_valid(shape), "crosses itself; it was mended"
    parts = [
        part
        for each in shapely.get_parts(shape)
        for part in shapely.get_parts(each)
        if part.geom_type == "Polygon" and part.area > 0
    ]
    if not parts:
        return Feature(one.number, one.properties, None, "is no polygon")
    return Feature(one.number, one.properties, shapely.union_all(parts), fault)


def _in_degrees(found: list[Feature], crs: str) -> list[Feature]:
    usable = [one.shape for one in found if one.shape is not None]
    if not usable:
        first = found[0]
        raise NoOutlines(f"holds no polygon: feature {first.number} {first.fault}")
    if crs:
        import pyproj  # which is slow to load
        from pyproj.exceptions import CRSError

        try:
            own = pyproj.CRS.from_user_input(crs).to_2d()
            carry = pyproj.Transformer.from_crs(own, DEGREES, always_xy=True)
        except CRSError as problem:
            words = f"is in {crs[:60]!r}, which is no reference system"
            raise NoOutlines(f"{words}: {REPROJECT}") from problem

        def turned(xy: np.ndarray) -> np.ndarray:
            return np.column_stack(carry.transform(xy[:, 0], xy[:, 1]))

        usable = [shapely.transform(one, turned) for one in usable]
    inside = [_on_globe(one) for one in usable]
    if not any(inside):
        x, y = shapely.get_coordinates(usable[0])[0]
        words = f"has coordinates such as ({x:,.6g}, {y:,.6g}), which are no degrees"
        raise NoOutlines(f"{words} (feet or metres?): {REPROJECT}")
    shapes = iter(zip(usable, inside, strict=True))
    return [_placed(one, *next(shapes)) if one.shape else one for one in found]


def _placed(one: Feature, shape: BaseGeometry, inside: bool) -> Feature:  # noqa: FBT001
    if inside:
        return Feature(one.number, one.properties, shape, one.fault)
    return Feature(one.number, one.properties, None, "lies outside the globe")


def _on_globe(shape: BaseGeometry) -> bool:
    west, south, east, north = shape.bounds
    return west >= -180 and east <= 180 and south >= -90 and north <= 90
