"""What other installed packages bring to the library, by their entry points."""

from __future__ import annotations

from functools import cache
from importlib.metadata import EntryPoint, entry_points

__all__ = ["GROUPS", "offers"]

GROUPS = ("thirdbody.laws", "thirdbody.outputs", "thirdbody.populations", "thirdbody.films")
"""Entry points of installed packages whose modules are imported."""


@cache
def offers() -> tuple[EntryPoint, ...]:
    """Entry points of the library's groups, by name; every package is looked at once a process."""
    every = entry_points()  # asking for a group reads every package again
    return tuple(
        entry
        for group in GROUPS
        for entry in sorted(every.select(group=group), key=lambda point: (point.name, point.value))
    )
