"""One number for the size of particles: sliders and the map scale the distribution as a whole."""

from __future__ import annotations

import copy
import dataclasses
import math

import thirdbody as tb

from ..study import DISTRIBUTIONS
from .fields import engineering, number_of

__all__ = ["size_of", "with_size"]


def size_of(contact: tb.Contact) -> float:
    """Mean diameter of the first population [m]."""
    return float(contact.populations[0].diameter.mean_diameter)


def with_size(study: dict[str, object], size: float) -> dict[str, object]:
    """The study with the sizes of its first population scaled to another mean diameter [m]."""
    new = copy.deepcopy(study)
    several = new["particles"]
    table = several[0] if isinstance(several, list) else several
    assert isinstance(table, dict)
    kind = DISTRIBUTIONS.get(table.get("distribution", ""))
    if kind is None or table["distribution"] == "mixture":
        return new
    lengths = {
        item.name: item.metadata["quantity"]
        for item in dataclasses.fields(kind)
        if item.metadata.get("quantity", {}).get("unit") == "m"
    }
    sizes = {
        name: number_of(table[name], about) for name, about in lengths.items() if name in table
    }
    if not sizes or not all(map(math.isfinite, sizes.values())):
        return new
    made = kind(
        **{
            item.name: number_of(table[item.name], item.metadata["quantity"])
            for item in dataclasses.fields(kind)
            if item.name in table and "quantity" in item.metadata
        }
    )
    factor = size / made.mean_diameter
    for name, value in sizes.items():
        table[name] = engineering(value * factor, "m")
    return new
