"""What a drawing states of the faces, in [roughness]: Ra, Rq or Rz, and the finishing process."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue, Problem
from ..populations.finish import STATED, Finish, assumption_sentence, processes
from ..populations.roughness import Roughness
from ..quantities.units import say
from .fields import about_of
from .mistakes import in_file
from .one_value import number, word
from .reader import Key, Reader, get, plain

__all__ = ["drawn", "is_drawn"]

FACES = ("first", "second")
KNOWN_BETTER = ("R", "alpha", "eta_R_sigma", "eta")


def is_drawn(data: Any) -> bool:
    """Whether [roughness] is given as on a drawing."""
    return isinstance(data, dict) and not data.keys().isdisjoint({*STATED, *FACES, "process"})


def drawn(reader: Reader, path: str, data: dict[str, Any]) -> Any:
    """A height for the pair or one for each face, the process, and what is known better."""
    keys = reader.keys_of(Roughness, path, data)
    keys = {name: key._replace(required=False) for name, key in keys.items()}
    keys |= _height_keys(reader, path)
    for face in FACES:
        keys[face] = Key(_face(reader, f"{path}.{face}", get(data, face)), False, "one face")
    wrong = len(reader.problems)
    reader.only_one(path, data)
    reader.only_one(path, data, f"{path}.drawing")
    pair = [key for key in ("sigma", *STATED) if key in data]
    sides = [key for key in FACES if key in data]
    if pair and sides:
        reader.problems.append(
            f"{path}.{pair[0]} = {say(data[pair[0]])} is that of the pair, and {path}.{sides[0]} "
            "that of a face; keep one of the two"
        )
    elif not pair and not sides:
        reader.problems.append(
            Problem(
                path,
                'has no height; give Ra, Rq or Rz of the pair, e.g. Ra = "0.2 um", or of each '
                f"face, [{path}.first] and [{path}.second]",
            )
        )
    elif pair == ["sigma"]:
        reader.problems.append(
            Problem(
                f"{path}.process",
                "goes with the height of a drawing; write "
                f"Rq = {say(data['sigma'])} instead of sigma",
                say(data.get("process")),
            )
        )
    elif len(sides) == 1:
        other = next(face for face in FACES if face not in sides)
        reader.problems.append(
            Problem(
                f"{path}.{other}",
                f"is missing: give both faces, or for a smooth one against {sides[0]} "
                f"the height alone, {path}.Ra",
            )
        )
    refused = len(reader.problems) > wrong

    def build(values: dict[str, Any]) -> Any:
        if refused:
            return None
        common = values.pop("process", None)
        sizes = {name: values.pop(name) for name in STATED if name in values}
        given = [values.pop(face) for face in FACES if face in values] or [sizes]
        where = [f"{path}.{face}" for face in sides] or [path]
        faces: list[Finish] = []
        problems: list[str] = []
        for place, each in zip(where, given, strict=True):
            try:
                told = {"process": common} if common and "process" not in each else {}
                faces.append(Finish(**each, **told))
            except InvalidValue as error:
                problems += in_file(error, Finish, place, each).problems
        if problems:
            raise InvalidValue(*problems)
        try:
            found = Roughness.from_drawing(*faces, **values)
        except InvalidValue as error:
            missing = f"{path}.R is missing: " if "R" not in values else ""
            raise InvalidValue(*(f"{missing}{text}" for text in error.problems)) from None
        used = {name: getattr(found, name) for name in KNOWN_BETTER}
        reader.assumed.append(f"{path}: {assumption_sentence(faces, used)}")
        return found

    return reader.table(path, keys, build)


def _height_keys(reader: Reader, path: str) -> dict[str, Key]:
    keys = {
        name: Key(plain(number(reader, f"{path}.{name}", about)), False, about_of(name, about))
        for name, about in STATED.items()
    }
    finished = plain(word(f"{path}.process", processes()))
    return keys | {"process": Key(finished, False, f"one of {', '.join(processes())}")}


def _face(reader: Reader, path: str, data: Any) -> Any:
    """The height of one face and its process."""
    return reader.table(path, _height_keys(reader, path), lambda values: values)
