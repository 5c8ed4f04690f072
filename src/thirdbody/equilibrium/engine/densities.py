"""How many particles have a size, as a function of numbers."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .fields import GAUSSIAN, HIGH, KIND, LOGNORMAL, NORM, POWER, SIZE_1, SIZE_2
from .sides import scalar

__all__ = ["density", "scale_of"]


@scalar
def density(given, p, x):
    """How many particles have a size x, per size."""
    keep_apart()
    kind, middle, width = given[p, KIND], given[p, SIZE_1], given[p, SIZE_2]
    if kind == GAUSSIAN:
        u = (x - middle) / width
        return given[p, NORM] * math.exp(-0.5 * u * u)
    if kind == LOGNORMAL:
        u = math.log(x / middle) / width
        return given[p, NORM] / x * math.exp(-0.5 * u * u)
    if kind == POWER:
        return given[p, NORM] * math.exp(-width * math.log(x / middle))
    return given[p, NORM]


@scalar
def scale_of(given, p, x):
    """Size over which the density changes near x."""
    keep_apart()
    if given[p, KIND] == GAUSSIAN:
        return given[p, SIZE_2]
    if given[p, KIND] == LOGNORMAL:
        return x * min(given[p, SIZE_2], 0.7)
    if given[p, KIND] == POWER:
        return x / max(1.0, abs(given[p, SIZE_2]))
    return given[p, HIGH]
