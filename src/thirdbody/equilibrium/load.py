"""One load, as `solve` and what stands on it take it: by its name."""

from __future__ import annotations

from typing import TypedDict, cast

from numpy.typing import ArrayLike

__all__ = ["Load", "as_load"]


class Load(TypedDict, total=False):
    """A load by its name: ``solve(contact, **load)``."""

    pressure: ArrayLike | None
    F_star: ArrayLike | None
    d: ArrayLike | None


def as_load(name: str, values: ArrayLike) -> Load:
    """The load of this name.

    >>> as_load("pressure", 5e6)
    {'pressure': 5000000.0}
    """
    return cast(Load, {name: values})
