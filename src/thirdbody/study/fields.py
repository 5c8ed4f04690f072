"""What a value class says of its fields: which are needed, which count, what each is."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any

from ..laws import asperity
from ..quantities.units import EXAMPLES
from ..quantities.value import problem_with

__all__ = ["UNITS_OF_LISTS", "about_of", "filled_in", "idle", "needed_fields"]

UNITS_OF_LISTS = {
    "edges": "m",
    "counts": "1",
    "slopes": "1",
    "weights": "1",
    "ratios": "1",
    "radii": "1",
}
"""Units of the fields that hold lists."""


def needed_fields(kind: type) -> list[str]:
    """Fields of a value class without a default."""
    missing = dataclasses.MISSING
    return [
        item.name
        for item in dataclasses.fields(kind)
        if item.default is missing and item.default_factory is missing
    ]


@cache
def filled_in(kind: Any) -> frozenset[str]:
    """Options of an asperity law that a contact sets, whatever is given, or that are no number."""
    if not issubclass(kind, asperity.AbstractAsperityLaw):
        return frozenset()
    found = set()
    for item in dataclasses.fields(kind):
        if "table" in item.metadata:
            continue
        if item.default is None and "quantity" not in item.metadata:
            found.add(item.name)
        elif item.default is None:
            given = kind(**{item.name: 0.1})
            used = given.bound(R=1e-6, E_star=1e11, H=1e9, nu=0.3)
            if getattr(used, item.name) != 0.1:
                found.add(item.name)
    return frozenset(found)


def idle(kind: type) -> dict[str, str]:
    """Fields that have no part in how the contact carries load, and what each is."""
    out = {}
    for item in dataclasses.fields(kind):
        label = item.type in ("str", str) and "choice" not in item.metadata
        if label or item.metadata.keys() & {"bulk", "grain"}:
            about = item.metadata.get("quantity", {"meaning": "a label"})
            out[item.name] = about["meaning"]
    return out


def about_of(name: str, about: dict[str, Any]) -> str:
    """What a quantity is, with an example of how to write it."""
    unit, symbol = about["unit"], about["symbol"]
    example = EXAMPLES.get(unit, f"1 [{unit}]")
    if unit == "1" and problem_with(about, 0.5):
        example = "2.0"
    shown = f"{about['meaning']}" + (f" {symbol}" if symbol != name else "")
    return shown + (f" [{unit}]" if unit != "1" else "") + f", e.g. {name} = {example}"
