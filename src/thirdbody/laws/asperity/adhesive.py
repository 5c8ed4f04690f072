"""Adhesive asperities: JKR and DMT, with Hertz's elasticity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from ...errors import InvalidValue, Mistake
from ...quantities.value import quantity
from ..base import AbstractAsperityLaw, Branch
from . import formulas
from .gw import GW

__all__ = ["DMT", "JKR"]

WORK_HINT = "mJ/m² are 50e-3; w is γ_1 + γ_2 − γ_12, not γ"


def _load_unit(law: JKR | DMT) -> float:
    """The unit of its load, of a law that is bound to a contact."""
    if law.scale is None:
        raise InvalidValue(
            f"{type(law).__name__}.scale is needed; a contact fills it in", code=Mistake.MISSING
        )
    return law.scale


@dataclass(frozen=True, slots=True, kw_only=True)
class JKR(AbstractAsperityLaw):
    r"""Johnson, Kendall and Roberts: adhesion in the contact. Summed over heights: Fuller–Tabor.

    With :math:`X=(\pi^2w^2R/E^{*2})^{1/3}` and :math:`s^4/4-s=\omega/X,\ s\ge1`,

    .. math:: F = \pi w R\,(s^6/6 - s^3), \qquad A = \pi R X\, s^4/4

    Parameters
    ----------
    w : float
        Work of adhesion w = Δγ [J/m²].
    unloading : bool, optional
        On unloading a contact holds down to ω = −¾X, where it parts with F = −(5/6)πwR; on
        loading it forms at ω = 0 with F = −(4/3)πwR.
    scale : float, optional
        w/(XH) [1]; a contact fills it in.

    Notes
    -----
    Valid for a Tabor number (Rw²/E*²z_0³)^{1/3} above about 5. Under load control a single
    contact parts at −(3/2)πwR.

    References
    ----------
    Johnson, Kendall, Roberts 1971, Proc. R. Soc. A 324, 301, doi:10.1098/rspa.1971.0141; Fuller,
    Tabor 1975, Proc. R. Soc. A 345, 327, doi:10.1098/rspa.1975.0138.

    Examples
    --------
    >>> import math
    >>> import thirdbody as tb
    >>> law = tb.asperity.JKR(w=0.05)
    >>> F = law.force(1e-30, R=1e-6, E_star=1e11, H=5e9)
    >>> round(float(F) / (math.pi * 0.05 * 1e-6), 6)
    -1.333333
    """

    name = "jkr"
    title = "JKR (Fuller–Tabor)"
    year = 1971
    citation = "Johnson, Kendall, Roberts 1971, Proc. R. Soc. A 324, 301"
    doi = "10.1098/rspa.1971.0141"
    provenance = "seen"
    valid_range = "elastic; Tabor number above 5"
    beyond = GW.beyond
    scale_free = False

    w: float = quantity("w", "J/m^2", "work of adhesion", default=0.05, gt=0, hint=WORK_HINT)
    unloading: bool = False
    scale: float | None = quantity("w/XH", "1", "adhesion over hardness", default=None, gt=0)

    def bound(self, *, R, E_star, H, nu: float | None = None) -> Self:
        """The law with w/(XH) of the contact."""
        X = self.yield_interference(R=R, E_star=E_star, H=H)
        return self.replace(scale=self.w / (X * H))

    def yield_interference(self, *, R, E_star, H):
        """X = (π²w²R/E*²)^{1/3} [m]: the length of adhesion, not a yield."""
        return (math.pi**2 * self.w**2 * R / E_star**2) ** (1 / 3)

    @property
    def start(self) -> float:
        return -0.75 if self.unloading else 0.0

    @property
    def onset(self) -> float:
        """−(5/6)πwR where an unloading contact parts, −(4/3)πwR where a loading one forms."""
        return _load_unit(self) * (-5 / 6 if self.unloading else -4 / 3)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """y = 2, up to where adhesion bends it; the formula is one."""
        return (2.0,)

    @property
    def valid_to(self) -> float:
        """Hertz's ω where the mean pressure is 0.4 H, ZMC's first yield: (0.3πH/E*)²R over X."""
        return (0.3 / _load_unit(self)) ** 2

    _root = staticmethod(formulas.stretched_from)

    @property
    def branches(self) -> tuple[Branch, ...]:
        unit = _load_unit(self)

        def stiffness(y):
            e = self._root(y)
            s = 1 + e
            return unit * s * s * (s**3 - 3) / np.maximum(e * (3 + e * (3 + e)), 1e-300)

        def force(y):
            return formulas.adhesive(self._root(y), unit)[0]

        def area(y):
            return formulas.adhesive(self._root(y), unit)[1]

        one = Branch("elastic", force, area, stiffness)
        return (one, one)


@dataclass(frozen=True, slots=True, kw_only=True)
class DMT(GW):
    r"""Derjaguin, Muller and Toporov (Maugis): adhesion outside the contact.

    .. math:: F = \tfrac43E^*\sqrt R\,\omega^{3/2} - 2\pi wR, \qquad A = \pi R\omega, \qquad
              \omega \ge 0

    Parameters
    ----------
    w : float
        Work of adhesion w = Δγ [J/m²].
    scale : float, optional
        2w/(ω_1 H) [1]; a contact fills it in.

    Notes
    -----
    The load jumps from 0 to −2πwR at ω = 0. Valid for a Tabor number below about 0.1.

    References
    ----------
    Derjaguin, Muller, Toporov 1975, J. Colloid Interface Sci. 53, 314,
    doi:10.1016/0021-9797(75)90018-1; Maugis 1996, J. Adhes. Sci. Technol. 10, 161.

    Examples
    --------
    >>> import math
    >>> import thirdbody as tb
    >>> law = tb.asperity.DMT(w=0.05)
    >>> F = law.force(1e-30, R=1e-6, E_star=1e11, H=5e9)
    >>> round(float(F) / (math.pi * 0.05 * 1e-6), 6)
    -2.0
    """

    name = "dmt"
    title = "DMT (Maugis)"
    year = 1975
    citation = "Derjaguin, Muller, Toporov 1975, J. Colloid Interface Sci. 53, 314"
    doi = "10.1016/0021-9797(75)90018-1"
    provenance = "seen"
    valid_range = "elastic; Tabor number below 0.1"
    scale_free = False

    w: float = quantity("w", "J/m^2", "work of adhesion", default=0.05, gt=0, hint=WORK_HINT)
    scale: float | None = quantity("2w/ω_1H", "1", "adhesion over hardness", default=None, gt=0)

    def bound(self, *, R, E_star, H, nu: float | None = None) -> Self:
        """The law with 2w/(ω_1 H) of the contact."""
        omega_1 = self.yield_interference(R=R, E_star=E_star, H=H)
        return self.replace(scale=2 * self.w / (omega_1 * H))

    @property
    def onset(self) -> float:
        """−2πwR."""
        return -_load_unit(self)

    @property
    def branches(self) -> tuple[Branch, ...]:
        pull = _load_unit(self)

        def force(y):
            return formulas.hertz_less_pull(y, pull)[0]

        return (Branch("elastic", force, lambda y: y, lambda y: 1.5 * y**0.5),)
