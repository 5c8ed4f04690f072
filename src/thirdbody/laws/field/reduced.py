r"""The formulas of one field of heights as plain functions of numbers or arrays.

By NumPy or compiled: each is written here once. Lengths are over σ, pressures over E*g.
"""

from __future__ import annotations

import numpy as np

__all__ = ["area_factor", "mean_pressure", "real_pressure", "remainder_at", "remainder_height"]


def mean_pressure(y, slope, energy, bearing):
    """⟨f⟩ = −Φ′ of Φ = P e^y; bearing is −P′, and slope is y′."""
    return np.exp(y) * (bearing - energy * slope)


def remainder_height(chi, alpha):
    """The remainder ε of high separations."""
    return (0.10 + 0.04 * np.log(alpha)) * chi / (chi + 0.28 + 5 / alpha**2)


def remainder_at(height, bearing):
    """The remainder ε where the part Q of the surface is higher."""
    return height * np.maximum(1 - 2 * bearing, 0.0)


def area_factor(alpha):
    """Ratio of what ε adds to the real pressure to what it adds to the load."""
    return 2.9 - 0.7 * np.log(alpha)


def real_pressure(ratio, more):
    """The real pressure over H, where the field without the remainder has this ratio."""
    return np.minimum(ratio * (1 + more * (1 - ratio**4)), 1.0)
