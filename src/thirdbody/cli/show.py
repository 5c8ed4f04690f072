"""Numbers and tables as a terminal shows them."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..quantities.say import value_of
from ..quantities.units import say
from .streams import LEAST, fill

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["ALL", "MOST_ROWS", "some", "some_times", "terminal", "usual"]

MOST_ROWS = 20
"""Rows of a table that a terminal shows."""
ALL = "--json or --csv FILE has all of it"
WHOLE = 12
"""Digits of a default, which is a short number."""
PIPE = 120
"""Width of a pipe that is told none."""


def terminal() -> Console:
    from rich.console import Console

    columns = os.environ.get("COLUMNS", "")
    width = max(int(columns), LEAST) if columns.isdecimal() and int(columns) > 0 else None
    if width is None and not sys.stdout.isatty():
        width = PIPE

    class Terminal(Console):
        def print(self, *objects: object, **how: Any) -> None:
            """Print as rich does, but for sentences: their numbers stay beside their units."""
            lines = [
                _fill_lines(printed, self.width) if isinstance(printed, str) else printed
                for printed in objects
            ]
            super().print(*lines, **how)

    return Terminal(file=sys.stdout, width=width, highlight=False, markup=False, emoji=False)


def _fill_lines(text: str, width: int) -> str:
    """A text whose longer lines are broken into lines of so many characters."""
    return "\n".join(fill(line, width) if len(line) > width else line for line in text.split("\n"))


def some(total: int) -> list[int]:
    """The rows shown of so many: all, or some evenly spread."""
    rows = min(total, MOST_ROWS)
    return [round(row * (total - 1) / max(rows - 1, 1)) for row in range(rows)]


def some_times(times: Sequence[float]) -> list[int]:
    """The rows shown of a history: some close to its beginning, where much happens, some evenly."""
    total = len(times)
    if total <= MOST_ROWS:
        return list(range(total))
    end, first = times[-1], next(time for time in times if time > 0)
    half = MOST_ROWS // 2
    wanted = [first * (end / first) ** (i / half) for i in range(half)]
    wanted += [end * i / half for i in range(half + 1)]
    near = {min(range(total), key=lambda k: abs(times[k] - time)) for time in wanted}
    return sorted(near)[: MOST_ROWS + 1]


def usual(value: object, unit: str) -> str:
    """A default as a study file may hold it: numbers whole and with their unit."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return value_of(value, unit or "1", WHOLE)
    return say(value)
