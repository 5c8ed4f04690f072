"""Heights and elliptic shapes of asperities in [roughness], waves in [asperity_law]."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..laws.asperity import OwnSpectrum, RollOff
from ..populations.ellipticity import FACES, Ellipticity
from ..populations.heights import Heights
from ..quantities.units import say
from .fields import needed_fields
from .mistakes import in_file
from .reader import (
    FIELDS,
    Key,
    Reader,
    get,
    keys_of,
    quantity_key,
    read_number,
    read_word,
    refused_key,
    table_of,
    wrong,
)
from .vocabulary import HEIGHTS

__all__ = ["ELLIPTICITY", "HEIGHT", "RADII"]


# -------------------------------------------------------------------------- heights
def _made_heights(reader: Reader, path: str, values: dict[str, Any]) -> Heights:
    made = reader.make(HEIGHTS[values.pop("name")], path, values)
    try:
        with np.errstate(all="ignore"):
            _ = made.pieces  # some shapes exist in no member of the family
    except InvalidValue as error:
        raise in_file(error, type(made), path, values) from None
    return made


def _heights_of_word(reader: Reader, path: str, value: object) -> Heights:
    name = read_word(HEIGHTS, reader, path, value)
    if needed := needed_fields(HEIGHTS[name]):
        shown = ", ".join(f"{field} = ..." for field in needed)
        rule = f"is missing {', '.join(needed)}: write it as a table, "
        raise wrong(path, f"{rule}{{ name = {say(name)}, {shown} }}", name, code=Mistake.MISSING)
    return _made_heights(reader, path, {"name": name})


def _heights(reader: Reader, path: str, data: object) -> object:
    def build(values: dict[str, object]) -> Heights:
        return _made_heights(reader, path, values)

    return reader.variant(path, data, "name", HEIGHTS, build)


HEIGHT = Key(
    _heights_of_word, False, "distribution of asperity heights", {"enum": HEIGHTS}, _heights
)
FIELDS["Heights"] = HEIGHT


# -------------------------------------------------------------------------- elliptic asperities
NO_SHAPE = (
    "must be a table: { ratios = [1, 2, 5], weights = [5, 3, 2] }, or "
    '{ first = 4, second = 2, angle = "30 deg" } for two faces; "measured" goes with a topography'
)
SECOND_SHAPE = (
    "is for two faces at an angle, ratios for the asperities of both together; keep one of the two"
)
RATIOS = {"first": "first_ratio", "second": "second_ratio"}
RADII = ("R_first", "R_second")


def _ellipticity(reader: Reader, path: str, data: object) -> object:
    """Classes of ratios, or two faces at an angle."""
    table = data if isinstance(data, dict) else {}
    if "ratios" in table or not {"first", "second", "angle"} & table.keys():
        keys = dict(keys_of(Ellipticity))
        keys["ratios"] = keys["ratios"]._replace(about="e.g. ratios = [1, 2, 5]")
        keys |= {
            key: refused_key(SECOND_SHAPE, Mistake.CLASH)
            for key in (*FACE_KEYS, "angle")
            if key in table
        }
        return reader.table(path, data, keys, lambda values: reader.make(Ellipticity, path, values))
    if len(set(RADII) & table.keys()) == 1:
        rule = "has the radius of one face only; give both R_first and R_second, or "
        reader.mistakes.append(
            Problem(path, f"{rule}neither where they are equal", code=Mistake.MISSING)
        )

    def build(values: dict[str, Any]) -> Ellipticity:
        try:
            return Ellipticity.combined(**{RATIOS.get(k, k): v for k, v in values.items()})
        except InvalidValue as error:
            keys = {name: f"{path}.{key}" for key, name in RATIOS.items()}
            raise InvalidValue(
                *(p.changed(path=keys.get(p.path, p.path)) for p in error.problems)
            ) from None

    return reader.table(path, data, FACE_KEYS | {"angle": ANGLE}, build)


def _angle(reader: Reader, path: str, value: object) -> object:
    """An angle between two faces, or the word "random"."""
    if value == "random":
        return value
    try:
        return read_number(FACES["angle"], reader, path, value)
    except InvalidValue:
        rule = 'must be an angle from 0 to 90 degrees, e.g. "30 deg" (a number is in rad)'
        raise wrong(path, f'{rule}, or "random"', value, code=Mistake.KIND) from None


FACE_KEYS = {
    key: quantity_key(key, FACES[RATIOS.get(key, key)], required=key in RATIOS)
    for key in (*RATIOS, *RADII)
}
ANGLE = Key(_angle, True, 'angle = "30 deg", or angle = "random"', {"type": ["number", "string"]})
ELLIPTICITY = refused_key(NO_SHAPE, Mistake.KIND)._replace(
    about="shapes of elliptic asperities", table=_ellipticity, also=({"first": 1},)
)
FIELDS["Ellipticity | None"] = ELLIPTICITY


# -------------------------------------------------------------------------- waves of the roughness
def _measured_spectrum(reader: Reader, path: str, value: object) -> OwnSpectrum | None:
    """The waves of the topography, for the law of one field."""
    if value != "measured":
        rule = 'must be "measured", for the waves of the topography in [roughness], or a table'
        raise wrong(
            path, f'{rule}, e.g. {{ hurst = 0.7, corner = "sharp" }}', value, code=Mistake.KIND
        )
    if get(reader.whole.get("roughness"), "topography") is None:
        rule = "goes with a topography in [roughness]; for σ, R and alpha leave it out, or give "
        raise wrong(path, f"{rule}{{ hurst = 0.7 }}", value, code=Mistake.IDLE)
    if not reader.faces:
        return None  # what is wrong with the topography is told there
    try:
        one, *others = reader.faces
        return OwnSpectrum.of_both(one, others[0]) if others else OwnSpectrum.of(one)
    except InvalidValue as error:
        raise InvalidValue(
            *(Problem(path, f": {problem}", code=problem.code) for problem in error.problems)
        ) from None


FIELDS["OwnSpectrum | RollOff | None"] = table_of(RollOff, "waves of the roughness")._replace(
    read=_measured_spectrum, schema={"const": "measured"}
)
