"""The table [film]: bodies, oil, load and speeds of a lubricated contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InvalidValue, Problem
from ..quantities.value import quantity
from ..systems.bodies import Body
from ..systems.film_conditions import Entrainment, FilmConditions
from ..systems.film_formulas import AbstractFilm, Line, Oil, Point
from .amounts import amounts
from .fields import about_of
from .laws import named_law
from .reader import Key, Reader, Table, get

__all__ = ["SHAPES", "SPEED", "TABLE", "on_body"]

SHAPES: dict[str, type[Point] | type[Line]] = {"point": Point, "line": Line}
NO_PRESSURE = (
    'has no place here: film.hertz = "mean" or "maximum" says which Hertz pressure is nominal, and '
    "the pressure itself follows from film.load"
)
OF_BODY = ("conjunction", "load", "speed")
"""Keys that may follow from [body]."""
SPEED = quantity("u", "m/s", "mean entrainment speed", gt=0).metadata["quantity"]


def film(reader: Reader, path: str, data: Any) -> Any:
    """The bodies, the oil, the load, and the speeds."""
    reader.known.refused[path] = {"pressure": NO_PRESSURE}
    speed = f"{path}.speed"
    keys = {
        "conjunction": Key(
            reader.variant(
                f"{path}.conjunction",
                get(data, "conjunction"),
                "shape",
                SHAPES,
                lambda values: reader.make(
                    SHAPES[values.pop("shape")], f"{path}.conjunction", values
                ),
                {},
            ),
            True,
            'the bodies, e.g. conjunction = { shape = "point", R = "9.5 mm" }',
        ),
        "oil": Key(
            reader.value(f"{path}.oil", get(data, "oil"), Oil),
            True,
            'e.g. oil = { eta = "20 mPa s", alpha = "20 / GPa" }',
        ),
        **reader.keys_of(FilmConditions, path, data),
        "speed": Key(
            amounts(reader, speed, SPEED, get(data, "speed")), True, about_of("speed", SPEED)
        ),
        "formula": Key(
            named_law(reader, f"{path}.formula", get(data, "formula"), AbstractFilm.registry),
            False,
            "the film formula",
        ),
        "entrainment": Key(
            reader.value(f"{path}.entrainment", get(data, "entrainment"), Entrainment),
            False,
            "what the oil carries",
        ),
    }

    pressed = reader.every_way or get(reader.whole, "body") is not None
    if pressed:
        for name in OF_BODY:
            keys[name] = keys[name]._replace(required=False)

    def build(values: dict[str, Any]) -> FilmConditions | dict[str, Any] | None:
        if "speed" in values:
            speeds = tuple(np.sort(values.pop("speed")).tolist())
            if not speeds:
                return None  # an empty range, which was told
            values |= {"speed": speeds}
        if pressed and not values.keys() >= {*OF_BODY}:
            return values
        return reader.make(FilmConditions, path, values)

    return reader.table(path, keys, build)


def on_body(
    reader: Reader, film: Any, bodies: Body | None, forces: np.ndarray | None, E_star: float
) -> FilmConditions | None:
    """The film; conjunction, load and speed are those of one contact of [body] where not given."""
    if not isinstance(film, dict):
        return film
    own: dict[str, Any] = {}
    shape = None if bodies is None else bodies.conjunction
    if bodies is not None and forces is not None and len(forces) == 1 and shape is not None:
        own = {"conjunction": shape, "load": float(bodies.load_on_one(forces[0], E_star))}
    if bodies is not None and bodies.rolling_speed is not None:
        own["speed"] = (bodies.rolling_speed,)
    missing = [name for name in OF_BODY if name not in film | own]
    if not missing:
        return reader.make(FilmConditions, "film", own | film)
    problems = []
    if "speed" in missing:
        missing.remove("speed")
        turns = [name for name in ("shaft_speed", "speed") if hasattr(bodies, name)]
        rule = "is missing" + "".join(f", or body.{name}" for name in turns)
        problems.append(Problem("film.speed", f"{rule}: {about_of('speed', SPEED)}"))
    if missing:
        problems.append(
            Problem(
                "",
                f"film has no {' and '.join(missing)}, and takes them from [body] only where its "
                "faces are curved and load.force is one force",
            )
        )
    raise InvalidValue(*problems)


TABLE = Table(
    name="film",
    read=film,
    about="a table [film] with conjunction, oil, load and speed",
    role="study",
)
