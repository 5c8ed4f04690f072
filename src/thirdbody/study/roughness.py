"""The table [roughness]: σ, R and η, or a drawing or a measured surface in their place."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Note, Problem
from ..populations.finish import STATED, Finish, assumption_sentence, processes
from ..populations.measured.topography import FORMS, from_topography
from ..populations.roughness import Roughness
from ..quantities.say import value_of
from ..quantities.units import say, to_si
from ..quantities.value import quantity
from .asperities import ELLIPTICITY, HEIGHT, RADII
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    amounts,
    get,
    keys_of,
    quantity_key,
    refused_key,
    text,
    word,
    wrong,
)

__all__ = ["ROUGHNESS", "is_drawn"]


def _roughness(reader: Reader, path: str, data: Any) -> object:
    """The equivalent rough surface."""
    if isinstance(data, dict) and "topography" in data:
        return _topography(reader, path, data)
    if is_drawn(data):
        return _read_drawing(reader, path, data)
    keys = dict(keys_of(Roughness))
    about = keys["sigma"].about
    keys["sigma"] = keys["sigma"]._replace(about=f'{about}, or Ra = "0.2 um" of the drawing')
    spare = reader.only_one(path, data)
    shape = get(data, "ellipticity")
    two_faces = get(shape, "R_first") is not None and get(shape, "R_second") is not None
    if two_faces:
        keys["R"] = keys["R"]._replace(required=False)

    def build(values: dict[str, Any]) -> Roughness:
        kept = {key: value for key, value in values.items() if key not in spare}
        if two_faces:
            first, second = (to_si(shape[key], "m") for key in ("R_first", "R_second"))
            both = first * second / (first + second)
            if not math.isclose(kept.setdefault("R", both), both, rel_tol=0.01):
                rule = (
                    "must be R_first R_second/(R_first + R_second)"
                    f" = {value_of(both, 'm')} of the ellipticity; leave it out"
                )
                raise wrong(f"{path}.R", rule, data["R"], code=Mistake.CLASH)
        return reader.make(Roughness, path, kept)

    return reader.table(path, data, keys, build)


# -------------------------------------------------------------------------- a drawing
SIDES = ("first", "second")
KNOWN_BETTER = ("R", "alpha", "eta_R_sigma", "eta")


def is_drawn(data: object) -> bool:
    """Whether [roughness] is given as on a drawing."""
    return isinstance(data, dict) and not data.keys().isdisjoint({*STATED, *SIDES, "process"})


def _read_drawing(reader: Reader, path: str, data: dict[str, object]) -> object:
    """Heights of the pair or of each face, the process, and numbers that replace its ranges."""
    keys = {name: key._replace(required=False) for name, key in keys_of(Roughness).items()}
    keys |= _height_keys() | dict.fromkeys(SIDES, FACE)
    before = len(reader.mistakes)
    reader.only_one(path, data)
    reader.only_one(path, data, f"{path}.drawing")
    reader.mistakes += _problems_of_drawing(path, data)
    if len(reader.mistakes) > before:
        return reader.table(path, data, keys, _refuse)

    def build(values: dict[str, Any]) -> Roughness:
        common = values.pop("process", None)
        sizes = {name: values.pop(name) for name in STATED if name in values}
        by_face = {f"{path}.{face}": values.pop(face) for face in SIDES if face in values}
        faces = reader.read_each(
            {
                where: ({"process": common} if common else {}) | face_values
                for where, face_values in (by_face or {path: sizes}).items()
            },
            lambda reader, where, face_values: reader.make(Finish, where, face_values),
        )
        try:
            roughness = Roughness.from_drawing(*faces, **values)
        except InvalidValue as error:
            if "R" in values:
                raise
            raise InvalidValue(
                *(
                    Problem(f"{path}.R", f"is missing: {text}", code=Mistake.MISSING)
                    for text in error.problems
                )
            ) from None
        used = {name: getattr(roughness, name) for name in KNOWN_BETTER}
        what = f"{path}: {assumption_sentence(faces, used)}"
        reader.assumed.append(Note(what, code=f"{path}.process"))
        return roughness

    return reader.table(path, data, keys, build)


def _refuse(values: Mapping[str, object]) -> None:
    """Build nothing, because of what was told."""
    raise InvalidValue


def _problems_of_drawing(path: str, data: Mapping[str, object]) -> list[Problem]:
    """Problems of the heights of a drawing taken together."""
    pair = [key for key in ("sigma", *STATED) if key in data]
    sides = [key for key in SIDES if key in data]
    if pair and sides:
        rule = f"is that of the pair, and {path}.{sides[0]} that of a face; keep one of the two"
        return [Problem(f"{path}.{pair[0]}", rule, say(data[pair[0]]), code=Mistake.CLASH)]
    if not pair and not sides:
        rule = 'has no height; give Ra, Rq or Rz of the pair, e.g. Ra = "0.2 um", or of each '
        return [
            Problem(path, f"{rule}face, [{path}.first] and [{path}.second]", code=Mistake.MISSING)
        ]
    if pair == ["sigma"]:
        rule = "goes with the height of a drawing; write "
        rule += f"Rq = {say(data['sigma'])} instead of sigma"
        return [Problem(f"{path}.process", rule, say(data.get("process")), code=Mistake.IDLE)]
    if len(sides) == 1:
        other = next(face for face in SIDES if face not in sides)
        rule = f"is missing: give both faces, or for a smooth one against {sides[0]} "
        return [
            Problem(f"{path}.{other}", f"{rule}the height alone, {path}.Ra", code=Mistake.MISSING)
        ]
    return []


@cache
def _height_keys() -> dict[str, Key]:
    keys = {name: quantity_key(name, about) for name, about in STATED.items()}
    return keys | {"process": word(processes(), f"one of {', '.join(processes())}")}


def _face(reader: Reader, path: str, data: object) -> object:
    """The height of one face and its process."""
    return reader.table(path, data, _height_keys())


FACE = Key(None, False, "one face", NOTHING, _face)


# -------------------------------------------------------------------------- a measured surface
CUTOFF = quantity("λ_c", "m", "cut-off wavelength", ge=0).metadata["quantity"]
SPACING = quantity("Δ", "m", "distance of neighbouring points", gt=0).metadata["quantity"]
NO_SHAPE = (
    'must be "measured", for the summits counted, or a table: '
    "{ ratios = [1, 2, 5], weights = [5, 3, 2] }"
)


def _shape_measured(reader: Reader, path: str, value: object) -> str:
    """Shapes of the summits counted."""
    if value != "measured":
        raise wrong(path, NO_SHAPE, value, code=Mistake.OPTION)
    return "measured"


def _shape_beside(reader: Reader, path: str, data: Any) -> object:
    """Classes and faces as elsewhere, without the radii."""
    if radii := [key for key in RADII if get(data, key) is not None]:
        both = "both" if len(radii) == 2 else "it"
        rule = f"would give R, which the topography tells; remove {both}"
        reader.mistakes.append(Problem(f"{path}.{' and '.join(radii)}", rule, code=Mistake.CLASH))
        data = {key: value for key, value in data.items() if key not in radii}
    return ELLIPTICITY.table(reader, path, data)  # type: ignore[misc]


def _heights_measured(reader: Reader, path: str, value: object) -> object:
    """The heights of the summits counted, or a distribution as elsewhere."""
    return value if value == "measured" else HEIGHT.read(reader, path, value)  # type: ignore[misc]


def _files(reader: Reader, path: str, value: Any) -> list[Path]:
    """One file or two, beside the study file or in the working folder."""
    names = value if isinstance(value, list) else [value]
    if not (1 <= len(names) <= 2 and all(isinstance(name, str) for name in names)):
        rule = "must be the name of a file in quotes, or a list of two for the two faces"
        raise wrong(path, rule, value, code=Mistake.RANGE)
    beside = [reader.folder / name for name in names]
    return [
        near if near.exists() or (not Path(name).exists() and name != "example") else Path(name)
        for near, name in zip(beside, names, strict=True)
    ]


BESIDE = {
    "topography": Key(_files, True, "a file"),
    "cutoff": quantity_key("cutoff", CUTOFF),
    "detrend": word(FORMS, "form to remove"),
    "heights": HEIGHT._replace(
        read=_heights_measured,
        about="distribution of asperity heights, or measured",
        schema={"anyOf": [{"const": "measured"}, HEIGHT.schema]},
    ),
    "ellipticity": ELLIPTICITY._replace(
        read=_shape_measured,
        about="shapes of elliptic asperities, or measured",
        schema={"const": "measured"},
        table=_shape_beside,
    ),
    "unit": text._replace(about="unit of a file that tells none"),
    "spacing": amounts("spacing", SPACING),
    "channel": text._replace(about="name of a channel of the file"),
}
TWICE = refused_key("is told by the topography as well; remove one of the two", Mistake.CLASH)


def _topography(reader: Reader, path: str, data: dict[str, object]) -> object:
    """A measured surface instead of σ, R and η; two files are the two faces."""

    def build(values: dict[str, Any]) -> Roughness:
        files = values.pop("topography")
        shapes = {name: values.pop(name, None) for name in ("heights", "ellipticity")}
        if "spacing" in values:
            values["spacing"] = tuple(values["spacing"])
        counted = [name for name, shape in shapes.items() if isinstance(shape, str)]
        if len(files) == 2 and counted:
            rule = "goes with one file: summits of two faces do not add, only their moments do"
            raise InvalidValue(
                *(
                    Problem(f"{path}.{name}", rule, '"measured"', code=Mistake.BEYOND)
                    for name in counted
                )
            )
        try:
            faces = [from_topography(file, **values) for file in files]
            cutoff = max(face.cutoff for face in faces)
            if len(faces) == 2 and min(face.cutoff for face in faces) < cutoff:
                faces = [from_topography(f, **values | {"cutoff": cutoff}) for f in files]
            for face in faces:
                reader.notes += [f"{path}.topography: {sentence}" for sentence in face.warnings]
            reader.faces = faces
            if len(faces) == 1:
                return faces[0].roughness(**shapes)
            both = (faces[0].moments + faces[1].moments).roughness(heights=shapes["heights"])
            return both.replace(ellipticity=shapes["ellipticity"])
        except InvalidValue as error:
            raise InvalidValue(
                *(p.move_under(path if p.path else f"{path}.topography") for p in error.problems)
            ) from None

    return reader.table(path, data, dict.fromkeys(keys_of(Roughness), TWICE) | BESIDE, build)


ROUGHNESS = Table(
    name="roughness",
    key=Key(
        required=True,
        about='a table [roughness], e.g. sigma = "100 nm", R = "2.8 um"',
        schema=NOTHING,
        table=_roughness,
        also=({"Ra": ""}, {"topography": ""}),
    ),
)
