"""The lines of Python that give the numbers of the page."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import thirdbody as tb

from ..quantities.value import Value
from ..study import Study
from ..study.load import told_forces
from ..systems.bodies import Body

__all__ = ["to_python"]


def to_python(study: Study, at: float | None = None) -> str:
    """A script that solves the study, with the same numbers, on this machine to the last digit.

    Parameters
    ----------
    study : Study
    at : float, optional
        The operating load, in the unit of the study's load: solved as ``point``.
    """
    contact = study.contact
    load = "d" if study.load == "separation" else study.load
    lines = [f"contact = {_code(contact)}"]
    lines += [f"curves = tb.solve(contact, {load}={_numbers(study.values)})"]
    if at is not None:
        lines += [f"point = tb.solve(contact, {load}={at!r})"]
        lines += ["print(point.mode, point.d, point.A_t, point.particle_load_share)"]
    homes = _homes((contact, study.body, study.film))
    if study.body is not None and study.forces is not None:
        lines += _forces(study.body, study.forces)
        homes.add(("thirdbody.systems.bodies", "press"))
    if study.film is not None:
        lines += [f"film = {_code(study.film)}", "lubricated = film.stribeck_columns(contact)"]
    head = ["import numpy as np", "", "import thirdbody as tb"]
    for home in sorted({home for home, _ in homes}):
        names = sorted((name for each, name in homes if each == home), key=_class_first)
        head.append(f"from {home} import {', '.join(names)}")
    return "\n".join([*head, "", *lines]) + "\n"


def _forces(body: Body, forces: np.ndarray) -> list[str]:
    """The lines that integrate over the contact under the forces that are told of."""
    told = [float(force) for force in told_forces(forces)]
    return [
        f"body = {_code(body)}",
        f"pressed = [press(contact, body, force) for force in {told!r}]",
        r'print(*(each.sentence() for each in pressed), sep="\n")',
    ]


def _homes(part: object) -> set[tuple[str, str]]:
    """Modules and names of what a script imports beside `thirdbody`."""
    if isinstance(part, tuple):
        return set().union(*(_homes(item) for item in part))
    if not isinstance(part, Value):
        return set()
    if isinstance(part, tb.Material) and part.name in tb.materials:
        return set()
    own = {(type(part).__module__, type(part).__name__)} if "." not in _name(type(part)) else set()
    return own.union(*(_homes(value) for _, value in _changed_fields(part)))


def _class_first(name: str) -> tuple[bool, str]:
    return name[0].islower(), name


def _changed_fields(value: Any) -> list[tuple[str, object]]:
    """The fields of a value that differ from their defaults."""
    out = []
    for item in dataclasses.fields(value):
        own = getattr(value, item.name)
        default = item.default
        if item.default_factory is not dataclasses.MISSING:
            default = item.default_factory()
        if type(own) is not type(default) or own != default:
            out.append((item.name, own))
    return out


WIDTH = 88
LONG = 8
"""Numbers of a tuple beyond which it is looked whether they are a range."""


def _code(part: object, indent: int = 0, used: int = 20) -> str:
    """A value as it is written; what does not fit on a line is broken, field by field."""
    if isinstance(part, tb.Material) and part.name in tb.materials:
        known = tb.materials[part.name]
        if known == part:
            return f"tb.materials[{part.name!r}]"
    if isinstance(part, Value):
        given = [(f"{name}=", own) for name, own in _changed_fields(part)]
        return _call(f"{_name(type(part))}(", given, ")", indent, used)
    if isinstance(part, tuple):
        if len(part) > LONG and all(isinstance(item, float) for item in part):
            made = _numbers(np.array(part))
            if made.startswith(("np.geomspace", "np.linspace")):
                return f"tuple({made}.tolist())"
        return _call("(", [("", item) for item in part], ",)", indent, used)
    return repr(part)


def _call(start: str, parts: list[tuple[str, object]], end: str, indent: int, used: int) -> str:
    flat = start + ", ".join(label + _code(own, 0, -9999) for label, own in parts) + end
    if used < 0 or indent + used + len(flat) <= WIDTH or not parts:
        return flat
    space = " " * (indent + 4)
    rows = [f"{space}{label}{_code(own, indent + 4, len(label) + 1)}," for label, own in parts]
    return "\n".join([start, *rows, " " * indent + end.lstrip(",")])


def _name(kind: type) -> str:
    """Where users find a class."""
    for prefix, home in (
        ("tb", tb),
        ("tb.asperity", tb.asperity),
        ("tb.distributions", tb.distributions),
        ("tb.films", tb.films),
        ("tb.grains", tb.grains),
        ("tb.heights", tb.heights),
        ("tb.outputs", tb.outputs),
        ("tb.particle", tb.particle),
        ("tb.surfaces", tb.surfaces),
    ):
        if kind.__name__ in home.__all__ and getattr(home, kind.__name__) is kind:
            return f"{prefix}.{kind.__name__}"
    return kind.__name__


def _numbers(values: np.ndarray) -> str:
    """Loads as short as they can be written without a change of a digit."""
    first, last, count = float(values[0]), float(values[-1]), len(values)
    if count > 2:
        for make in ("geomspace", "linspace"):
            if make == "geomspace" and first * last <= 0:
                continue
            if np.array_equal(getattr(np, make)(first, last, count), values):
                return f"np.{make}({first!r}, {last!r}, {count})"
    return f"np.array({values.tolist()!r})"
