"""Times, masses and flows of dirt as people say them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..quantities.say import number, value_of

__all__ = ["duration_of", "flow_of", "flows_of", "mass_of", "masses_of"]

MINUTE, HOUR, DAY, YEAR = 60.0, 3600.0, 86400.0, 365.25 * 86400
ENDS = ((2 * MINUTE, 1.0, "s"), (2 * HOUR, MINUTE, "min"), (20_000 * HOUR, HOUR, "h"))
UNITS = (("kg", 1.0), ("g", 1e-3), ("mg", 1e-6), ("µg", 1e-9))
NEVER = "for ever"
MOST_WHOLE = 1e5
"""Number from which a time is said by a power of ten."""


def duration_of(seconds: float, digits: int = 3) -> str:
    """A time as people say it.

    >>> duration_of(30.0), duration_of(202.7), duration_of(3.6e6), duration_of(1e12)
    ('30 s', '3.38 min', '1000 h', '31700 years')
    >>> duration_of(float("nan"))
    'for ever'
    """
    if not math.isfinite(seconds):
        return NEVER
    unit, name = next(((u, n) for end, u, n in ENDS if seconds < end), (YEAR, "years"))
    size = seconds / unit
    if digits < 3 or unit == YEAR:  # whole hours stay as they are
        size = float(np.format_float_scientific(size, digits - 1))
    if size >= MOST_WHOLE:
        return f"{number(size, digits)} {name}"
    return f"{number(size, max(digits, len(str(round(size)))))} {name}"


def mass_of(kilograms: float) -> str:
    """A mass as people say it.

    >>> mass_of(0.05), mass_of(1.3e-6), mass_of(2.0), mass_of(0.0)
    ('50 g', '1.3 mg', '2 kg', '0 g')
    """
    return value_of(kilograms, "kg", 3) if kilograms else "0 g"


def masses_of(kilograms: Sequence[float]) -> list[str]:
    """Masses in one unit, that of the largest.

    >>> masses_of([1.21e-3, 5.57e-4])
    ['1.21 g', '0.557 g']
    """
    largest = max(kilograms, default=0.0)
    unit, size = next(((unit, size) for unit, size in UNITS if largest >= size), UNITS[-1])
    return [f"{number(mass / size, 3)} {unit}" if mass else "0 g" for mass in kilograms]


def flows_of(kilograms_per_second: Sequence[float]) -> list[str]:
    """Masses per hour in one unit.

    >>> flows_of([2e-7, 3e-7])
    ['0.72 g/h', '1.08 g/h']
    """
    return [f"{mass}/h" for mass in masses_of([HOUR * flow for flow in kilograms_per_second])]


def flow_of(kilograms_per_second: float) -> str:
    """A mass per hour.

    >>> flow_of(125e-6 / 3600)
    '125 mg/h'
    """
    return f"{mass_of(kilograms_per_second * HOUR)}/h"
