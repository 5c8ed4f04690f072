"""One load, as `solve` and what stands on it take it: by its name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, TypedDict, TypeVar, cast

__all__ = ["ForceLoad", "Load", "as_force_load", "as_load", "as_loads"]

Values = TypeVar("Values")


class ForceLoad(TypedDict, Generic[Values], total=False):
    """A pressure or a load F*, for what takes no separation."""

    pressure: Values
    F_star: Values


class Load(ForceLoad[Values], Generic[Values], total=False):
    """A load by its name: ``solve(contact, **load)``."""

    d: Values


def as_load(name: str, values: Values) -> Load[Values]:
    """The load of this name.

    >>> as_load("d", 2e-7)
    {'d': 2e-07}
    """
    return cast(Load[Values], {name: values})


def as_loads(loads: Mapping[str, Values]) -> Load[Values]:
    """Loads by their names, of which there may be none."""
    return cast(Load[Values], loads)


def as_force_load(name: str, values: Values) -> ForceLoad[Values]:
    """The load of this name, which is no separation.

    >>> as_force_load("pressure", 5e6)
    {'pressure': 5000000.0}
    """
    return cast(ForceLoad[Values], {name: values})
