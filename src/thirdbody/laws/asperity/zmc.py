"""Zhao, Maietta and Chang 2000: elastic, elastoplastic and plastic asperities."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...quantities.value import quantity
from ..base import AbstractAsperityLaw, Branch, Jump

__all__ = ["ZMC"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ZMC(AbstractAsperityLaw):
    r"""Asperities that yield in three stages, joined by a logarithm of pressure.

    .. math:: \omega_1 = \left(\frac{3\pi k H}{4E^*}\right)^2 R, \quad \omega_2 = \rho\,\omega_1

    With :math:`y=\omega/\omega_1`, :math:`s=(y-1)/(\rho-1)` and :math:`u=\ln y/\ln\rho`:

    =============  =================================  ==========================
    regime         area / πRω                         mean pressure / H
    =============  =================================  ==========================
    elastic        1                                  k √y  (Hertz)
    elastoplastic  1 + 3s² − 2s³                      k + (1 − k) u
    plastic        2                                  1
    =============  =================================  ==========================

    Parameters
    ----------
    k : float, optional
        Mean pressure at first yield over hardness k [1]; 0.4 after Tabor.
    rho : float, optional
        ω_2/ω_1 [1]; 54 follows from Johnson's load ratio of about 400 for a sphere and is a
        lower bound in the paper, used as an equality by everybody.

    Notes
    -----
    Load and area are continuous; the stiffness drops by 8.26 % at ω_1 and 13.07 % at ω_2
    (k = 0.4, ρ = 54). The printed exponent ω^(2/3) of the seed paper's elastic load is a slip
    for Hertz's ω^(3/2).

    References
    ----------
    Zhao, Maietta, Chang 2000, J. Tribol. 122, 86, doi:10.1115/1.555332.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.asperity.ZMC()
    >>> omega_1 = law.yield_interference(R=1e-6, E_star=112e9, H=5e9)
    >>> p = law.mean_pressure(omega_1 * 54, R=1e-6, E_star=112e9, H=5e9)
    >>> round(float(p) / 5e9, 12)
    1.0
    """

    name = "zmc"
    title = "Zhao–Maietta–Chang"
    year = 2000
    citation = "Zhao, Maietta, Chang 2000, J. Tribol. 122, 86"
    doi = "10.1115/1.555332"
    provenance = "seen"
    valid_range = "spherical tips, ω ≪ R"

    k: float = quantity("k", "1", "mean pressure at first yield over H", default=0.4, gt=0, lt=1)
    rho: float = quantity("ρ", "1", "ω_2/ω_1", default=54.0, gt=1)

    def yield_interference(self, *, R, E_star, H):
        """ω_1 = (3πkH/4E*)² R [m]."""
        return (3 * math.pi * self.k * H / (4 * E_star)) ** 2 * R

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (1.0, self.rho)

    @property
    def jumps(self) -> dict[float, Jump]:
        rise = (1 - self.k) / math.log(self.rho)  # of p/H with ln ω, to set beside Hertz's k/2
        return {
            1.0: Jump(stiffness=(rise + self.k) / (1.5 * self.k) - 1),
            self.rho: Jump(stiffness=1 / (rise + 1) - 1),
        }

    def pressure(self, u):
        """p/H and its derivative d(p/H)/du for u = ln y/ln ρ between 0 and 1."""
        return self.k + (1 - self.k) * u, (1 - self.k) * np.ones_like(u)

    def _area_factor(self, y):
        s = (y - 1) / (self.rho - 1)
        return 1 + s * s * (3 - 2 * s), 6 * s * (1 - s) / (self.rho - 1)

    @property
    def branches(self) -> tuple[Branch, ...]:
        k, log_rho = self.k, math.log(self.rho)

        def area(y):
            return y * self._area_factor(y)[0]

        def force(y):
            return self.pressure(np.log(y) / log_rho)[0] * area(y)

        def stiffness(y):
            p, dp_du = self.pressure(np.log(y) / log_rho)
            g, dg = self._area_factor(y)
            return dp_du / log_rho * g + p * (g + y * dg)

        return (
            Branch("elastic", lambda y: k * y**1.5, lambda y: y, lambda y: 1.5 * k * y**0.5),
            Branch("elastoplastic", force, area, stiffness),
            Branch("plastic", lambda y: 2 * y, lambda y: 2 * y, lambda y: np.full_like(y, 2.0)),
        )
