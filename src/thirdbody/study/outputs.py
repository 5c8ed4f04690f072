"""The table [outputs]: what else the states of the contact tell, a table for each output."""

from __future__ import annotations

from typing import Any

from ..effects import REGISTRY
from ..systems.bodies import Flat
from .reader import Key, Reader, Table, get

__all__ = ["TABLE", "on_area"]


def outputs(reader: Reader, path: str, data: Any) -> Any:
    """Every output that the file names, in the order of the library."""
    keys = {
        name: Key(reader.value(f"{path}.{name}", get(data, name), kind), False, kind.title)
        for name, kind in REGISTRY.items()
    }
    return reader.table(path, keys, lambda values: tuple(values.values()))


def on_area(given: tuple[Any, ...], body: Any) -> tuple[Any, ...]:
    """Outputs that ask for a nominal area and have none, with that of a flat body."""
    if not isinstance(body, Flat):
        return given
    return tuple(
        each.replace(A_n=body.area) if getattr(each, "A_n", 0.0) is None else each for each in given
    )


TABLE = Table(name="outputs", read=outputs)
