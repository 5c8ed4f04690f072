"""Numbers and tables as a terminal shows them."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from ..quantities.say import value_of
from ..quantities.units import say
from .streams import LEAST

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["ALL", "MOST_ROWS", "some", "terminal", "usual"]

MOST_ROWS = 20
"""Rows of a table that a terminal shows."""
ALL = "--json or --csv FILE has all of it"
WHOLE = 12
"""Digits of a default, which is a short number."""
PIPE = 120
"""Width of a pipe that is told none."""


def terminal() -> Console:
    from rich.console import Console

    asked = os.environ.get("COLUMNS", "")
    width = max(int(asked), LEAST) if asked.isdecimal() and int(asked) > 0 else None
    if width is None and not sys.stdout.isatty():
        width = PIPE
    return Console(file=sys.stdout, width=width, highlight=False, markup=False, emoji=False)


def some(total: int) -> list[int]:
    """The rows shown of so many: all, or some evenly spread."""
    rows = min(total, MOST_ROWS)
    return [round(row * (total - 1) / max(rows - 1, 1)) for row in range(rows)]


def usual(value: object, unit: str) -> str:
    """A default as a study file may hold it: numbers whole and with their unit."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return value_of(value, unit or "1", WHOLE)
    return say(value)
