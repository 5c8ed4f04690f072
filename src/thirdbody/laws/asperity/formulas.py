r"""The reduced formulas of the laws of one contact, as plain functions of numbers.

Each gives :math:`f = F/(\pi R\omega_1H)` and :math:`a = A/(\pi R\omega_1)` at
:math:`y = \omega/\omega_1` on one smooth branch. Numbers or arrays, by NumPy or compiled: a law is
written here once. What the letters mean and where the formulas come from stands with each law.
"""

from __future__ import annotations

import numpy as np

__all__ = [
    "adhesive",
    "coated_beyond",
    "elastic",
    "fully_plastic",
    "green_middle",
    "hermite_middle",
    "hertz_less_pull",
    "hertz_zmc",
    "kogut",
    "plastic_ceb",
    "stretched_from",
    "y_of_stretch",
    "zmc_middle",
]


def elastic(y, factor, r):
    """Hertz: load factor·r·y^(3/2), area r·y, with r = 1 for a round tip."""
    return factor * r * y * np.sqrt(y), r * y


def hertz_less_pull(y, pull):
    """`DMT`: Hertz in units of his load at y = 1, less what pulls outside the contact."""
    return y * np.sqrt(y) - pull, y


def y_of_stretch(e):
    """y of `JKR` at e = s − 1: s⁴/4 − s + ¾ is e²(3/2 + e + e²/4), so nothing cancels."""
    return e * e * (1.5 + e * (1 + e / 4)) - 0.75


def stretched_from(y):
    """e = s − 1 ≥ 0 of `JKR` at y ≥ −¾: Newton from above, to 4e-16 however near the parting."""
    q = np.maximum(y + 0.75, 0.0)
    e = np.minimum(np.sqrt(q / 1.5), np.sqrt(np.sqrt(4 * q)))
    for _ in range(7):
        rest = e * e * (1.5 + e * (1 + e / 4)) - q
        e = e - rest / np.maximum(e * (3 + e * (3 + e)), 1e-300)
    return e


def adhesive(e, unit):
    """`JKR` at e = s − 1."""
    s = 1 + e
    cube = s * s * s
    return unit * cube * (cube / 6 - 1), 0.25 * cube * s


def coated_beyond(q, thin, load_1, load_2, area_1, area_2):
    """Load over y^(3/2) and area over y of `Coated` beyond its table, which ends at 1 = q.

    Joined to it with their slopes: limit + c q + e q², 1 + (c − e ln q) q.
    """
    return 4 / 3 * thin + (load_1 + load_2 * q) * q, 1 + (area_1 - area_2 * np.log(q)) * q


def hertz_zmc(y, k, r):
    """The elastic branch of `ZMC`."""
    return elastic(y, k, r)


def fully_plastic(y, full):
    """Fully plastic at the hardness: load and area full·y."""
    return full * y, full * y


def _spread(y, rho, r, full):
    s = (y - 1) / (rho - 1)
    return y * (r + (full - r) * (s * s * (3 - 2 * s)))


def zmc_middle(y, k, rho, r, full):
    """The elastoplastic branch of `ZMC`, from r·y to full·y."""
    area = _spread(y, rho, r, full)
    return (k + (1 - k) * np.log(y) / np.log(rho)) * area, area


def hermite_middle(y, k, rho, r, full):
    """The elastoplastic branch of `Hermite`."""
    u, slope = np.log(y) / np.log(rho), 0.5 * k * np.log(rho)
    p = k * (u * u * (2 * u - 3) + 1) + slope * u * (1 - u) ** 2 + u * u * (3 - 2 * u)
    area = _spread(y, rho, r, full)
    return p * area, area


def plastic_ceb(y, K, r, slope):
    """The plastic branch of `CEB`, round or elliptic."""
    area = r + slope * (y - 1)
    return K * area, area


def kogut(y, unit, f, m, a, n):
    """One of the power laws of `KE`, with unit = (2/3)K."""
    return unit * f * y**m, a * y**n


def green_middle(y, C, B, omega_R, hardness_ratio):
    """The branch of `JG` beyond y = 1.9, with ω_c/R."""
    area = y * (y / 1.9) ** B
    radius = np.sqrt(omega_R * area)
    hardness = 2.84 * (1 - np.exp(-0.82 * radius**-0.7))
    first = np.exp(-(y ** (5 / 12)) / 4) * y**1.5
    second = 4 / C * hardness * -np.expm1(-(y ** (5 / 9)) / 25) * y
    return 2 / 3 * C / hardness_ratio * (first + second), area
