"""The table [outputs]: what else the states of the contact tell, a table for each output."""

from __future__ import annotations

from typing import Any

from ..effects import REGISTRY
from .reader import Key, Reader, Table, get

__all__ = ["TABLE"]


def outputs(reader: Reader, path: str, data: Any) -> Any:
    """Every output that the file names, in the order of the library."""
    keys = {
        name: Key(reader.value(f"{path}.{name}", get(data, name), kind), False, kind.title)
        for name, kind in REGISTRY.items()
    }
    return reader.table(path, keys, lambda values: tuple(values.values()))


TABLE = Table(name="outputs", read=outputs)
