"""Numbers in words: one home for rounding and readable units."""

from __future__ import annotations

import math
from collections.abc import Sequence

__all__ = ["as_length", "as_number", "as_percent", "as_pressure", "say_length"]


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


def say_length(value: float) -> str:
    """A length for reading."""
    for size, unit in ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"), (0.0, "nm")):
        if abs(value) >= size * (1 - 1e-9):
            return f"{value / (size or 1e-9):.4g} {unit}"
    return f"{value:.4g} m"


# -------------------------------------------------------------------------- numbers in words
def value_of(value: float, unit: str) -> str:
    """A number with a readable unit: 3e-7 m is "300 nm"."""
    if not math.isfinite(value):
        return "-"
    prefixes = {
        "m": ((1e-3, "mm"), (1e-6, "um"), (0.0, "nm")),
        "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (0.0, "Pa")),
    }
    scales = {"mm": 1e-3, "um": 1e-6, "nm": 1e-9, "GPa": 1e9, "MPa": 1e6, "kPa": 1e3, "Pa": 1.0}
    if unit in prefixes:
        name = next(name for least, name in prefixes[unit] if abs(value) >= least * (1 - 1e-9))
        return f"{value / scales[name]:.4g} {name}"
    return f"{value:.4g}" + ("" if unit in ("", "1") else f" {unit}")


def percent(value: float, error: float) -> str:
    if not math.isfinite(value):
        return "-"
    text = f"{100 * value:.3g} %" if value < 0.9995 or value == 1 else f"{100 * value:.5g} %"
    return f"{text} (± {100 * error:.1g} %)" if error > 0 else text


def listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
