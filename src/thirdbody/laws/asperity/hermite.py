"""The smooth variant of ZMC: load and stiffness are continuous."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...errors import Mistake, Problem
from ..base import Jump
from .zmc import ZMC

__all__ = ["SMOOTH", "Hermite"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Hermite(ZMC):
    r"""ZMC's areas with a mean pressure that joins Hertz and full plasticity smoothly.

    .. math:: p/H = k(2u^3-3u^2+1) + m_0(u^3-2u^2+u) + 3u^2-2u^3, \quad m_0=\tfrac12 k\ln\rho

    m_0 is Hertz's slope dp/du at first yield and the slope at full plasticity is zero, so load
    and stiffness are continuous; use it inside other solvers. The pressure is monotone while
    m_0 < 3(1 − k).

    Parameters
    ----------
    k, rho : float, optional
        As in `ZMC`.

    References
    ----------
    Derived here from the conditions named above.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.asperity.Hermite()
    >>> [round(float(p), 6) for p in (law.pressure(0.0)[0], law.pressure(1.0)[0])]
    [0.4, 1.0]
    """

    name = "hermite"
    title = "Smooth elastoplastic (C¹)"
    year = 2026
    citation = "Cubic Hermite join of Hertz and full plasticity on the areas of Zhao et al. 2000"
    doi = ""
    provenance = "derived"
    valid_range = "spherical tips, ω ≪ R; m_0 < 3(1 − k)"

    @property
    def jumps(self) -> dict[float, Jump]:
        return {}

    def _problems(self) -> list[str]:
        if self._slope < 3 * (1 - self.k):
            return []
        return [
            Problem(
                "k",
                f"with rho = {self.rho:g} makes the pressure overshoot H: "
                "(k/2) ln rho must stay below 3 (1 - k)",
                f"{self.k:g}",
                code=Mistake.RANGE,
            )
        ]

    @property
    def _slope(self) -> float:
        return 0.5 * self.k * math.log(self.rho)

    def pressure(self, u):
        k, m0 = self.k, self._slope
        p = k * (u * u * (2 * u - 3) + 1) + m0 * u * (1 - u) ** 2 + u * u * (3 - 2 * u)
        dp = (1 - k) * 6 * u * (1 - u) + m0 * (1 - u) * (1 - 3 * u)
        return p, dp


SMOOTH = Hermite()
"""The law of one contact that particles follow where no other is chosen."""
