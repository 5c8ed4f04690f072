"""What a value class says of its fields: which are needed, which count, what each is.

The readers of study files, the entries of the page and the lists of the command line are made from
the same `declarations`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from ..laws import asperity
from ..quantities.arguments import words_of_quantity
from ..quantities.slips import slips_are_told
from ..quantities.units import Quantity, example_of
from ..quantities.value import allowed_range, problem_with

__all__ = ["Declaration", "about_of", "declarations", "filled_in", "idle", "needed_fields"]

UNITS_OF_LISTS = {
    "edges": "m",
    "counts": "1",
    "slopes": "1",
    "weights": "1",
    "ratios": "1",
    "radii": "1",
}
"""Units of the fields that hold lists."""


@dataclass(frozen=True, kw_only=True)
class Declaration:
    """Declaration of one field of a value class that a study file may hold.

    Parameters
    ----------
    name : str
        The key.
    kind : {"number", "word", "list", "switch", "text", "word or number", "other"}
        What is written there; "other" is a table, or what no file can express.
    declared : str
        Its type, as the class declares it.
    needed : bool
        Whether it has no default.
    default : object
        None where it is needed, or made anew for each value.
    quantity : mapping, optional
        What `thirdbody.quantities.value.quantity` says of a number.
    options : tuple of str
        The words of which it is one.
    meaning : str
        What it is.
    unit : str
        Of the numbers of a list.
    any_unit : bool
        Whether the numbers of a list may have other units, too.
    allowed : str
        The range of a number, or what the class says of a table.
    """

    name: str
    kind: Literal["number", "word", "list", "switch", "text", "word or number", "other"]
    declared: str
    needed: bool
    default: object = None
    quantity: Quantity | None = None
    options: tuple[str, ...] = ()
    meaning: str = ""
    unit: str = ""
    any_unit: bool = False
    allowed: str = ""


KINDS: Mapping[str, Literal["switch", "text", "word or number"]] = {
    "bool": "switch",
    "bool | None": "switch",
    "str": "text",
    "str | float": "word or number",
}
"""What is written for the fields of these types."""


@cache
def declarations(kind: type) -> tuple[Declaration, ...]:
    """Declared fields of a value class, without those that a contact fills in."""
    return tuple(
        _declaration(item) for item in dataclasses.fields(kind) if item.name not in filled_in(kind)
    )


def _declaration(item: dataclasses.Field[Any]) -> Declaration:
    declared = str(getattr(item.type, "__name__", item.type))
    missing = dataclasses.MISSING
    plain: dict[str, Any] = {
        "name": item.name,
        "declared": declared,
        "needed": item.default is missing and item.default_factory is missing,
        "default": None if item.default is missing else item.default,
    }
    if about := item.metadata.get("quantity"):
        plain |= {
            "meaning": about["meaning"],
            "allowed": allowed_range(about),
        }
        return Declaration(kind="number", quantity=about, **plain)
    if about := item.metadata.get("choice"):
        options, meaning = tuple(about["options"]), about["meaning"]
        return Declaration(kind="word", options=options, meaning=meaning, **plain)
    if item.name in UNITS_OF_LISTS:
        unit = UNITS_OF_LISTS[item.name]
        any_unit = item.metadata.get("several", {}).get("unit", unit) != unit
        return Declaration(kind="list", unit=unit, any_unit=any_unit, **plain)
    return Declaration(kind=KINDS.get(declared, "other"), **plain, **item.metadata.get("table", {}))


def needed_fields(kind: type) -> list[str]:
    """Fields of a value class without a default."""
    return [field.name for field in declarations(kind) if field.needed]


@cache
def filled_in(kind: Any) -> frozenset[str]:
    """Options of an asperity law that a contact always sets, or that are no numbers."""
    if not issubclass(kind, asperity.AbstractAsperityLaw):
        return frozenset()
    names = set()
    for item in dataclasses.fields(kind):
        if "table" in item.metadata:
            continue
        if item.default is None and "quantity" not in item.metadata:
            names.add(item.name)
        elif item.default is None:
            with slips_are_told():
                law = kind(**{item.name: 0.1})
            used = law.bound(R=1e-6, E_star=1e11, H=1e9, nu=0.3)
            if getattr(used, item.name) != 0.1:
                names.add(item.name)
    return frozenset(names)


def idle(kind: type) -> dict[str, str]:
    """Fields without influence on the load, each with its meaning."""
    out = {}
    for item in dataclasses.fields(kind):
        label = item.type in ("str", str) and "choice" not in item.metadata
        if label or item.metadata.keys() & {"bulk", "grain"}:
            about = item.metadata.get("quantity", {"meaning": "a label"})
            out[item.name] = about["meaning"]
    return out


def about_of(name: str, about: Quantity) -> str:
    """Meaning of a quantity, with an example of how to write it."""
    unit = about["unit"]
    example = example_of(unit, about["hint"])
    if unit == "1" and problem_with(about, 0.5):
        example = "2.0"
    return f"{words_of_quantity(name, about)}, e.g. {name} = {example}"
