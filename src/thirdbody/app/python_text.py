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
        names = sorted((name for module, name in homes if module == home), key=_class_first)
        head.append(f"from {home} import {', '.join(names)}")
    return "\n".join([*head, "", *lines]) + "\n"


def _forces(body: Body, forces: np.ndarray) -> list[str]:
    """The lines that integrate over the contact under the forces that are told of."""
    few_forces = [float(force) for force in told_forces(forces)]
    return [
        f"body = {_code(body)}",
        f"pressed = [press(contact, body, force) for force in {few_forces!r}]",
        r'print(*(each.sentence() for each in pressed), sep="\n")',
    ]


def _homes(value: object) -> set[tuple[str, str]]:
    """Modules and names of what a script imports beside `thirdbody`."""
    if isinstance(value, tuple):
        return set().union(*(_homes(item) for item in value))
    if not isinstance(value, Value):
        return set()
    if isinstance(value, tb.Material) and value.name in tb.materials:
        return set()
    names = (
        {(type(value).__module__, type(value).__name__)} if "." not in _name(type(value)) else set()
    )
    return names.union(*(_homes(inner) for _, inner in _changed_fields(value)))


def _class_first(name: str) -> tuple[bool, str]:
    return name[0].islower(), name


def _changed_fields(value: Any) -> list[tuple[str, object]]:
    """The fields of a value that differ from their defaults."""
    out = []
    for item in dataclasses.fields(value):
        field_value = getattr(value, item.name)
        default = item.default
        if item.default_factory is not dataclasses.MISSING:
            default = item.default_factory()
        if type(field_value) is not type(default) or field_value != default:
            out.append((item.name, field_value))
    return out


WIDTH = 88
LONG = 8
"""Numbers of a tuple beyond which it is looked whether they are a range."""


def _code(value: object, indent: int = 0, used: int = 20) -> str:
    """A value as it is written; what does not fit on a line is broken, field by field."""
    if isinstance(value, tb.Material) and value.name in tb.materials:
        library_material = tb.materials[value.name]
        if library_material == value:
            return f"tb.materials[{value.name!r}]"
    if isinstance(value, Value):
        fields = [(f"{name}=", field_value) for name, field_value in _changed_fields(value)]
        return _call(f"{_name(type(value))}(", fields, ")", indent, used)
    if isinstance(value, tuple):
        if len(value) > LONG and all(isinstance(item, float) for item in value):
            made = _numbers(np.array(value))
            if made.startswith(("np.geomspace", "np.linspace")):
                return f"tuple({made}.tolist())"
        return _call("(", [("", item) for item in value], ",)", indent, used)
    return repr(value)


def _call(start: str, parts: list[tuple[str, object]], end: str, indent: int, used: int) -> str:
    flat = (
        start
        + ", ".join(label + _code(field_value, 0, -9999) for label, field_value in parts)
        + end
    )
    if used < 0 or indent + used + len(flat) <= WIDTH or not parts:
        return flat
    space = " " * (indent + 4)
    rows = [
        f"{space}{label}{_code(field_value, indent + 4, len(label) + 1)},"
        for label, field_value in parts
    ]
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
