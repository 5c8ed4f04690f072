"""The table [explicit]: the surfaces on which every particle has its place."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue
from ..quantities.units import say
from ..quantities.value import quantity
from .fields import about_of
from .one_value import One, count, number, word
from .reader import Key, Reader, Table, get, plain, reads_also

__all__ = ["TABLE"]

SPACING = quantity("Δ", "m", "distance of the points of a map", gt=0).metadata["quantity"]
TOL = quantity("ε", "1", "certificate at which to stop", ge=1e-13, le=1e-2).metadata["quantity"]
CAP = quantity("c", "Pa", "highest pressure of asperities", gt=0).metadata["quantity"]
CAPS = ("hardness", "none")


def explicit(reader: Reader, path: str, data: Any) -> Any:
    """How many surfaces, how large and how fine, where particles lie, how well to solve."""
    keys = {
        "surfaces": Key(plain(count(f"{path}.surfaces", most=10_000)), False, "how many maps"),
        "size": Key(plain(count(f"{path}.size", least=16, most=4096)), False, "points a side"),
        "spacing": Key(
            plain(number(reader, f"{path}.spacing", SPACING)), False, about_of("spacing", SPACING)
        ),
        "seats": Key(_seats(reader, f"{path}.seats", get(data, "seats")), False, "where they lie"),
        "seed": Key(plain(count(f"{path}.seed", least=0, most=2**31)), False, ""),
        "cap": Key(plain(_cap(reader, f"{path}.cap")), False, about_of("cap", CAP)),
        "tol": Key(plain(number(reader, f"{path}.tol", TOL)), False, about_of("tol", TOL)),
        "max_iterations": Key(plain(count(f"{path}.max_iterations", most=100_000)), False, ""),
    }
    return reader.table(path, keys, dict)


@reads_also({})
def _seats(reader: Reader, path: str, data: Any) -> Any:
    """A rule, by its word or as a table with its numbers."""
    from ..explicit.seats import SEATS  # takes numba along, which other studies do without

    if not isinstance(data, dict):
        named = word(path, SEATS)
        return plain(One(lambda value: SEATS[named(value)](), named.schema))
    return reader.variant(
        path, data, "rule", SEATS,
        lambda values: reader.make(SEATS[values.pop("rule")], path, values), {},
    )  # fmt: skip


def _cap(reader: Reader, path: str) -> Any:
    read = number(reader, path, CAP)

    def cap(value: Any) -> str | float:
        if isinstance(value, str) and value in CAPS:
            return value
        if isinstance(value, str) and not any(letter.isdigit() for letter in value):
            raise InvalidValue(
                f'{path} = {say(value)} must be "hardness", "none", or a pressure such as "5 GPa"'
            )
        return read(value)

    return cap


TABLE = Table(
    name="explicit",
    read=explicit,
    about='a table [explicit], e.g. surfaces = 8, seats = "settled"',
    role="study",
)
