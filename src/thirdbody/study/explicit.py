"""The table [explicit]: the surfaces on which every particle has its place."""

from __future__ import annotations

from collections.abc import Mapping

from ..errors import Mistake
from ..quantities.value import quantity
from .fields import about_of
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    count,
    quantity_key,
    read_number,
    read_word,
    wrong,
)

__all__ = ["EXPLICIT"]

SPACING = quantity("Δ", "m", "distance of the points of a map", gt=0).metadata["quantity"]
TOL = quantity("ε", "1", "certificate at which to stop", ge=1e-13, le=1e-2).metadata["quantity"]
CAP = quantity("c", "Pa", "highest pressure of asperities", gt=0).metadata["quantity"]
CAPS = ("hardness", "none")


def _seats() -> Mapping[str, type]:
    from ..explicit.seats import SEATS  # takes numba along, which other studies do without

    return SEATS


def _seat(reader: Reader, path: str, value: object) -> object:
    """Rule of the seats of particles, by its word."""
    return _seats()[read_word(_seats(), reader, path, value)]()


def _seat_with_numbers(reader: Reader, path: str, data: object) -> object:
    return reader.variant(path, data, "rule", _seats())


def _cap(reader: Reader, path: str, value: object) -> str | float:
    """The highest pressure of asperities."""
    if isinstance(value, str) and value in CAPS:
        return value
    if isinstance(value, str) and not any(letter.isdigit() for letter in value):
        raise wrong(
            path,
            'must be "hardness", "none", or a pressure such as "5 GPa"',
            value,
            code=Mistake.RANGE,
        )
    return read_number(CAP, reader, path, value)


def _explicit(reader: Reader, path: str, data: object) -> object:
    """How many surfaces, how large and how fine, where particles lie, how well to solve."""
    keys = KEYS | {
        "seats": Key(_seat, False, "where they lie", {"enum": _seats()}, _seat_with_numbers)
    }
    return reader.table(path, data, keys)


KEYS = {
    "surfaces": count("how many maps", most=10_000),
    "size": count("points a side", least=16, most=4096),
    "spacing": quantity_key("spacing", SPACING),
    "seats": Key(),
    "seed": count(least=0, most=2**31),
    "cap": Key(_cap, False, about_of("cap", CAP)),
    "tol": quantity_key("tol", TOL),
    "max_iterations": count(most=100_000),
}
EXPLICIT = Table(
    name="explicit",
    key=Key(
        about='a table [explicit], e.g. surfaces = 8, seats = "settled"',
        schema=NOTHING,
        table=_explicit,
    ),
    role="study",
)
