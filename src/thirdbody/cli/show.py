"""Numbers and tables as a terminal shows them."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["as_length", "as_number", "as_percent", "as_pressure", "finite", "table_of", "terminal"]


def terminal() -> Console:
    from rich.console import Console

    # a pipe has no width of its own
    width = None if sys.stdout.isatty() else 120
    return Console(file=sys.stdout, width=width, highlight=False, markup=False, emoji=False)


def table_of(headers: Iterable[str], *, right: bool = False) -> Any:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for header in headers:
        table.add_column(header, justify="right" if right else "left", overflow="fold")
    return table


def as_number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def as_percent(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{100 * value:.3g} %" if value < 0.9995 or value == 1 else f"{100 * value:.5g} %"


def as_pressure(value: float | None) -> str:
    return _prefixed(value, "Pa", {"G": 1e9, "M": 1e6, "k": 1e3})


def as_length(value: float | None) -> str:
    return _prefixed(value, "m", {"": 1.0, "m": 1e-3, "u": 1e-6, "n": 0.0})


def _prefixed(value: float | None, unit: str, thresholds: dict[str, float]) -> str:
    if value is None:
        return "-"
    sizes = {"G": 1e9, "M": 1e6, "k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9}
    prefix = next((name for name, least in thresholds.items() if abs(value) >= least), "")
    return f"{value / sizes[prefix]:.4g} {prefix}{unit}"


def finite(value: Any) -> Any:
    """Plain data with None for numbers that are not finite."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
