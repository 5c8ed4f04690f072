"""Shapes of elliptic asperities in [roughness]."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import InvalidValue, Problem
from ..populations.ellipticity import FACES, Ellipticity
from ..quantities.units import say
from .fields import about_of
from .one_value import One, number, refused
from .reader import Key, Reader, plain, reads_also

__all__ = ["ellipticity", "ellipticity_beside_topography"]

NO_SHAPE = (
    "must be a table: { ratios = [1, 2, 5], weights = [5, 3, 2] }, or "
    '{ first = 4, second = 2, angle = "30 deg" } for two faces; "measured" goes with a topography'
)
NO_SHAPE_MEASURED = (
    'must be "measured", for the summits counted, or a table: '
    "{ ratios = [1, 2, 5], weights = [5, 3, 2] }"
)
SECOND_SHAPE = (
    "is for two faces at an angle, ratios for the asperities of both together; keep one of the two"
)


@reads_also({}, {"first": 1})
def ellipticity(reader: Reader, path: str, data: Any) -> Any:
    """Classes of ratios, or two faces at an angle."""
    if not isinstance(data, dict):
        return plain(refused(path, NO_SHAPE))
    if "ratios" in data or not {"first", "second", "angle"} & data.keys():
        keys = reader.keys_of(Ellipticity, path, data)
        keys["ratios"] = keys["ratios"]._replace(about="e.g. ratios = [1, 2, 5]")
        second_shape = ("first", "second", "angle", "R_first", "R_second")
        for key in (key for key in second_shape if key in data):
            keys[key] = Key(plain(refused(f"{path}.{key}", SECOND_SHAPE)), False, "")
        return reader.table(path, keys, lambda values: reader.make(Ellipticity, path, values))
    names = {"first": "first_ratio", "second": "second_ratio"}
    keys = {}
    for key in ("first", "second", "R_first", "R_second"):
        about = FACES[names.get(key, key)]
        read = plain(number(reader, f"{path}.{key}", about))
        keys[key] = Key(read, key in names, about_of(key, about))
    example = 'angle = "30 deg", or angle = "random"'
    keys["angle"] = Key(plain(_angle(reader, f"{path}.angle")), True, example)
    if len({"R_first", "R_second"} & data.keys()) == 1:
        reader.problems.append(
            Problem(
                path,
                "has the radius of one face only; give both R_first and R_second, or "
                "neither where they are equal",
            )
        )

    def build(values: dict[str, Any]) -> Ellipticity:
        try:
            return Ellipticity.combined(**{names.get(k, k): v for k, v in values.items()})
        except InvalidValue as error:
            keys = {name: f"{path}.{key}" for key, name in names.items()}
            raise InvalidValue(
                *(p.changed(path=keys.get(p.path, p.path)) for p in error.problems)
            ) from None

    return reader.table(path, keys, build)


@reads_also("measured", {}, {"first": 1})
def ellipticity_beside_topography(reader: Reader, path: str, data: Any) -> Any:
    """Shapes of the summits counted on a measured surface, or classes and faces as elsewhere."""
    if data == "measured":
        return plain(One(str, {"const": "measured"}))
    if not isinstance(data, dict):
        return plain(refused(path, NO_SHAPE_MEASURED))
    if radii := [key for key in ("R_first", "R_second") if key in data]:
        reader.problems.append(
            f"{path}.{' and '.join(radii)} would give R, which the topography tells; remove "
            f"{'both' if len(radii) == 2 else 'it'}"
        )
        data = {key: value for key, value in data.items() if key not in radii}
    return ellipticity(reader, path, data)


def _angle(reader: Reader, path: str) -> Callable[[Any], Any]:
    """An angle between two faces, or the word "random"."""

    def read(value: Any) -> Any:
        if value == "random":
            return value
        try:
            return number(reader, path, FACES["angle"])(value)
        except InvalidValue:
            raise InvalidValue(
                f"{path} = {say(value)} must be an angle from 0 to 90 degrees, "
                'e.g. "30 deg" (a number is in rad), or "random"'
            ) from None

    return One(read, {"type": ["number", "string"]})
