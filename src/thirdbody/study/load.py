"""The table [load]: one of F*, pressure, separation, and a force on the bodies of [body]."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InvalidValue
from .amounts import amounts
from .body import FORCE
from .fields import about_of
from .reader import Key, Reader, Table, get
from .vocabulary import LOADS

__all__ = ["TABLE"]


def load(reader: Reader, path: str, data: Any) -> Any:
    """Which load is given, and its values."""
    keys = {
        name: Key(
            amounts(reader, f"{path}.{name}", about, get(data, name)), False, about_of(name, about)
        )
        for name, about in (LOADS | {"force": FORCE}).items()
    }
    reader.only_one(path, data)

    def build(values: dict[str, Any]) -> tuple[str, np.ndarray]:
        for name in (*LOADS, "force"):
            if name in values:
                return name, values[name]
        raise InvalidValue(
            f'[{path}] is empty; give exactly one of {", ".join(LOADS)}, e.g. pressure = "5 MPa", '
            "or force on a [body]"
        )

    return reader.table(path, keys, build)


TABLE = Table(
    name="load",
    read=load,
    about='a table [load] with one of F_star, pressure, separation, e.g. pressure = "5 MPa"',
    required=lambda whole: (
        not {"film", "connector", "plate"} & whole.keys()
        and all(get(whole.get("sweep"), name) is None for name in LOADS)
    ),
    role="study",
)
