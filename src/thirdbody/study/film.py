"""The table [film]: bodies, oil, load and speeds of a lubricated contact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake, Note, Problem
from ..quantities.say import value_of
from ..quantities.value import quantity
from ..systems.bodies import Body
from ..systems.film_conditions import Entrainment, FilmConditions
from ..systems.film_formulas import AbstractFilm, Line, Oil, Point
from ..systems.oil_filter import Filter
from .reader import NOTHING, Key, Reader, Table, amounts, get, keys_of, table_of, variants, wrong
from .surfaces import law_key

__all__ = ["FILM", "SHAPES", "SPEED", "filter_of", "note_without_oil", "on_body"]

SHAPES: dict[str, type[Point] | type[Line]] = {"point": Point, "line": Line}
TAKEN = ("conjunction", "load", "speed")
"""Keys that may follow from [body]."""
NO_PRESSURE = (
    'has no place here: film.hertz = "mean" or "maximum" says which Hertz pressure is nominal, and '
    "the pressure itself follows from film.load"
)
SPEED = quantity("u", "m/s", "mean entrainment speed", gt=0).metadata["quantity"]


def _read_filter(reader: Reader, path: str, value: object) -> Filter:
    """A filter as its data sheet states it."""
    if not isinstance(value, str):
        rule = 'must be sizes and β ratios in quotes, e.g. "5=75, 10=1000"'
        raise wrong(path, rule, value, code=Mistake.KIND)
    try:
        return Filter.from_text(value)
    except InvalidValue as error:
        first = error.problems[0]
        bare = first.changed(owner="") if first.owner == "Filter" else first
        raise wrong(path, f": {bare}", value, code=first.code) from None


def note_without_oil(subject: str) -> Note:
    """The note of an answer that leaves the oil of a table [film] out; such as "This page is"."""
    what = f"{subject} for the solids alone: the oil of [film] carries nothing here"
    action = "thirdbody film says what the film carries"
    return Note(what, code="film.left_out", effect=math.inf, action=action)


def filter_of(whole: Mapping[str, object]) -> Filter | None:
    """The filter of a parsed file that was read; None where it names none."""
    filter_text = get(whole.get("film"), "filter")
    return Filter.from_text(filter_text) if isinstance(filter_text, str) else None


@cache
def _keys() -> dict[str, Key]:
    return {
        "conjunction": variants(
            "shape",
            SHAPES,
            'the bodies, e.g. conjunction = { shape = "point", R = "9.5 mm" }',
            required=True,
        ),
        "oil": table_of(Oil, 'e.g. oil = { eta = "20 mPa s", alpha = "20 / GPa" }', required=True),
        **keys_of(FilmConditions),
        "speed": amounts("speed", SPEED)._replace(required=True),
        "formula": law_key(AbstractFilm.registry, "the film formula"),
        "entrainment": table_of(Entrainment, "what the oil carries"),
        "filter": Key(
            _read_filter,
            about='a filter by its β ratios at sizes in um(c), "5=75, 10=1000": the oil before and '
            "behind it",
            schema={"type": "string"},
        ),
    }


def _film(reader: Reader, path: str, data: object) -> FilmConditions | dict[str, object]:
    """The bodies, the oil, the load, and the speeds."""
    reader.known_keys.refused[path] = {"pressure": NO_PRESSURE}
    keys = _keys()
    pressed = reader.every_way or get(reader.whole, "body") is not None
    if pressed:
        keys = keys | {name: keys[name]._replace(required=False) for name in TAKEN}

    def build(values: dict[str, Any]) -> FilmConditions | dict[str, object]:
        if values.pop("filter", None) is not None and get(reader.whole, "particles") is None:
            raise InvalidValue(
                Problem(
                    "film.filter",
                    "has nothing to hold: the study has no table [particles]",
                    code=Mistake.MISSING,
                )
            )
        if "speed" in values:
            values["speed"] = tuple(np.sort(values.pop("speed")).tolist())
        if pressed and not values.keys() >= set(TAKEN):
            return values
        return reader.make(FilmConditions, path, values)

    return reader.table(path, data, keys, build)


def on_body(
    reader: Reader,
    film: FilmConditions | dict[str, object],
    bodies: Body | None,
    forces: np.ndarray | None,
    E_star: float,
) -> FilmConditions:
    """The film, with conjunction, load and speed of one contact of [body] where not given."""
    if isinstance(film, FilmConditions):
        return film
    from_body: dict[str, object] = {}
    shape = None if bodies is None else bodies.conjunction
    if bodies is not None and forces is not None and len(forces) == 1 and shape is not None:
        from_body = {"conjunction": shape, "load": float(bodies.load_on_one(forces[0], E_star))}
    if bodies is not None and bodies.rolling_speed is not None:
        from_body["speed"] = (bodies.rolling_speed,)
    missing = [name for name in TAKEN if name not in film | from_body]
    if not missing:
        return reader.make(FilmConditions, "film", from_body | film)
    problems = []
    if "speed" in missing:
        missing.remove("speed")
        turns = [name for name in ("shaft_speed", "speed") if hasattr(bodies, name)]
        rule = "is missing" + "".join(f", or body.{name}" for name in turns)
        problems.append(
            Problem("film.speed", f"{rule}: {_keys()['speed'].about}", code=Mistake.MISSING)
        )
    if missing and shape is not None and forces is not None and len(forces) > 1:
        shown = value_of(float(forces[0]), "N")
        hint = f'give one, e.g. --set load.force="{shown}", or film.{" and film.".join(missing)}'
        problems.append(
            Problem(
                "load.force",
                f"holds {len(forces)} forces, and a film between the bodies of [body] takes one",
                hint=hint,
                code=Mistake.SHAPE,
            )
        )
    elif missing:
        problems.append(
            Problem(
                "film",
                f"has no {' and '.join(missing)}, and takes them from [body] only where its "
                "faces are curved and load.force is one force",
                code=Mistake.MISSING,
            )
        )
    raise InvalidValue(*problems)


FILM = Table(
    name="film",
    key=Key(
        about="a table [film] with conjunction, oil, load and speed", schema=NOTHING, table=_film
    ),
    role="study",
)
