r"""Load and area of one field of heights, and the remainder that its trial pressures leave.

.. math:: F_{ss}/E^* = g\,\langle f\rangle\,(1 + \varepsilon), \qquad
          A_{ss} = F_{ss}/\bar p

Lengths are over σ, pressures over E*g, with the RMS gradient g.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import ndtr

from .conduction import patch_remainder
from .reduced import area_factor, real_pressure, remainder_at, remainder_height

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.roughness import Roughness
    from .table import FieldSurface

    Array = NDArray[np.float64]

__all__ = ["area", "hardness_ratio", "load", "remainder", "stiffness"]


def hardness_ratio(rough: Roughness, *, E_star: float, H: float) -> float:
    """χ = H/(E*g) [1], the hardness over the pressure that flattens a slope."""
    return H / (E_star * rough.slope)


def remainder(h: Array, *, chi: float, alpha: float) -> Array:
    r"""What the load of the true pressures has more, with two derivatives: (N, 3).

    .. math:: \varepsilon = (0.10 + 0.04\ln\alpha)\,\frac{\chi}{\chi + 0.28 + 5/\alpha^2}\,
              \max(0, 1 - 2Q(h))

    Trial pressures that depend on one filtered field are fewer than all, so they carry less. This
    is fitted to 54 clean surfaces pressed point by point (α = 3, 5, 15; χ = 0.02 to ∞); nothing
    else is.
    """
    height = remainder_height(chi, alpha)
    density = np.exp(-0.5 * h * h) / math.sqrt(2 * math.pi)
    more = height * np.stack([2 * density, -2 * h * density], axis=-1)
    value = remainder_at(height, ndtr(-h))[:, None]
    return np.concatenate([value, np.where(h[:, None] > 0, more, 0.0)], axis=1)


def load(surface: FieldSurface, h: Array, *, remains: bool) -> Array:
    """F_ss/(E*g) with two derivatives with respect to h/σ: (N, 3)."""
    f = surface.load(h)
    if not remains:
        return f
    e = remainder(h, chi=surface.chi, alpha=surface.alpha)
    whole = 1 + e[:, 0]
    first = f[:, 1] * whole + f[:, 0] * e[:, 1]
    second = f[:, 2] * whole + 2 * f[:, 1] * e[:, 1] + f[:, 0] * e[:, 2]
    return np.stack([f[:, 0] * whole, first, second], axis=-1)


def area(surface: FieldSurface, h: Array, *, remains: bool) -> tuple[Array, Array]:
    r"""A_ss, and the part of it that is pressed with H: two arrays (N,).

    .. math:: \bar p = \min\left(H, \bar p_{field}\left[1 + (2.9 - 0.7\ln\alpha)\,\varepsilon
              \left(1 - (\bar p_{field}/H)^4\right)\right]\right), \qquad
              \bar p_{field} = E^*g\langle f\rangle/Q(s_0)
    """
    from .table import EDGE, PLASTIC

    columns = surface.columns(h)
    carried = surface.load(h)[:, 0]
    touched = ndtr(-(h + columns[:, EDGE]))
    some = touched > 0  # far away both are 0
    ratio = np.where(some, carried / (surface.chi * np.where(some, touched, 1.0)), 1.0)
    ratio = np.minimum(ratio, 1.0)
    whole = carried
    if remains:
        e = remainder(h, chi=surface.chi, alpha=surface.alpha)[:, 0]
        ratio = real_pressure(ratio, area_factor(surface.alpha) * e)
        whole = carried * (1 + e)
    plastic = np.clip(columns[:, PLASTIC], 0.0, 1.0)
    return whole / (surface.chi * ratio), np.where(ratio >= 1, 1.0, plastic)


def stiffness(surface: FieldSurface, h: Array, *, remains: bool) -> Array:
    r"""Kσ/(E*g) of the patches that touch, whose conductance is 2K/(E*(ρ_1 + ρ_2)): (N,).

    Without the remainder a lower bound. An elastic surface has K = −dF/dh but for 2 % (h from
    0.7 σ on, with the remainder); where a surface yields, −dF/dh is less.
    """
    more = patch_remainder(surface.alpha) if remains else 0.0
    return (1 + more) * surface.stiffness(h)
