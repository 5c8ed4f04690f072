"""Jackson and Green 2005: a sphere whose hardness falls as the contact grows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from ...errors import InvalidValue, Mistake
from ...quantities.value import quantity
from ..base import AbstractAsperityLaw, Branch, Jump

__all__ = ["JG"]


@dataclass(frozen=True, slots=True, kw_only=True)
class JG(AbstractAsperityLaw):
    r"""Finite-element fits in the yield strength, with a hardness that depends on the shape.

    .. math:: \omega_c=\left(\frac{\pi C S_y}{2E^*}\right)^2 R, \quad C=1.295\,e^{0.736\nu},
              \quad B = 0.14\,e^{23 S_y/E^*}

    Hertz for :math:`y=\omega/\omega_c<1.9`; above, with F_c = (4/3)(R/E*)²(πC S_y/2)³,

    .. math:: A=\pi R\omega\left(\frac{y}{1.9}\right)^B, \quad
        \frac{F}{F_c}=e^{-y^{5/12}/4}y^{3/2}+\frac{4H_G}{CS_y}\left(1-e^{-y^{5/9}/25}\right)y,
    .. math:: \frac{H_G}{S_y}=2.84\left[1-\exp\left(-0.82\,(a/R)^{-0.7}\right)\right],
              \quad a=\sqrt{A/\pi} .

    Parameters
    ----------
    hardness_ratio : float, optional
        H/S_y [1], 2.8 by default: the law takes a yield strength, a material has a hardness, and
        the conversion is recorded here.
    nu : float, optional
        Poisson ratio ν of the softer body [1]; a contact fills it in.
    yield_strain : float, optional
        S_y/E* [1]; filled in from H, E* and the ratio.

    Notes
    -----
    The authors' E′ is E* (no factor 2). The load jumps by +0.68 % at y = 1.9 (for S_y/E*
    between 0.001 and 0.007), the stiffness by −5.1 %; the slope of the area jumps by 1 + B.
    For a/R above about 0.41 (recalled) the printed formulas still return numbers, with a mean
    pressure that keeps falling. There is no plastic regime.

    References
    ----------
    Jackson, Green 2005, J. Tribol. 127, 343, doi:10.1115/1.1866166, checked in two public codes.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.asperity.JG(nu=0.29, yield_strain=1 / 200)
    >>> F_c = law.reduced("force", 1.0)
    >>> round(float(law.reduced("force", 110.0) / F_c), 3)
    501.588
    """

    name = "jg"
    title = "Jackson–Green"
    year = 2005
    citation = "Jackson, Green 2005, J. Tribol. 127, 343"
    doi = "10.1115/1.1866166"
    provenance = "seen"
    valid_range = "a/R < 0.41 (recalled)"
    beyond = "at a/R above 0.41, out of its fits"

    hardness_ratio: float = quantity(
        "H/S_y", "1", "hardness over yield strength", default=2.8, gt=0
    )
    nu: float | None = quantity(
        "ν", "1", "Poisson ratio of the softer body", default=None, gt=-1, le=0.5
    )
    yield_strain: float | None = quantity("S_y/E*", "1", "yield strain", default=None, gt=0, le=30)

    def bound(self, *, R, E_star, H, nu: float | None = None) -> Self:
        """The law with ν of the softer body, and S_y/E* from its hardness."""
        return self.replace(
            nu=self.nu if self.nu is not None else nu,
            yield_strain=H / (self.hardness_ratio * E_star),
        )

    def _constants(self) -> tuple[float, float, float]:
        if self.nu is None or self.yield_strain is None:
            raise InvalidValue(
                "JG.nu is needed; a contact takes it from the softer body", code=Mistake.MISSING
            )
        C = 1.295 * math.exp(0.736 * self.nu)
        return C, 0.14 * math.exp(23 * self.yield_strain), self.yield_strain

    def yield_interference(self, *, R, E_star, H):
        """ω_c = (πC S_y/2E*)² R [m]."""
        C, _, _ = self._constants()
        return (math.pi * C * H / (2 * self.hardness_ratio * E_star)) ** 2 * R

    @property
    def jumps(self) -> dict[float, Jump]:
        C, B, _ = self._constants()
        y, a_R = 1.9, math.sqrt(1.9 * self._omega_R)
        p, q, z = y ** (5 / 12) / 4, y ** (5 / 9) / 25, 0.82 * a_R**-0.7
        # the two terms of F/F_c over Hertz's y^1.5, and d ln/d ln y of each
        first = math.exp(-p)
        second = 4 / C * 2.84 * -math.expm1(-z) * -math.expm1(-q) / math.sqrt(y)
        n_1 = 1.5 - 5 / 12 * p
        n_2 = 1 + 5 / 9 * q / math.expm1(q) + 0.35 * (1 + B) * z * math.exp(-z) / math.expm1(-z)
        slope = (first * n_1 + second * n_2) / 1.5
        return {y: Jump(force=first + second - 1, stiffness=slope - 1)}

    @property
    def valid_to(self) -> float:
        _, B, _ = self._constants()
        y = 0.41**2 / self._omega_R  # a² = Rω, and a² = Rω (y/1.9)^B above 1.9
        return min(y, 1.9 * (y / 1.9) ** (1 / (1 + B)))

    @property
    def _omega_R(self) -> float:
        """ω_c/R."""
        C, _, e_y = self._constants()
        return (math.pi * C * e_y / 2) ** 2

    @staticmethod
    def _hardness(a_R):
        """H_G/S_y and its derivative with respect to a/R."""
        decay = np.exp(-0.82 * a_R**-0.7)
        return 2.84 * (1 - decay), -2.84 * decay * 0.82 * 0.7 * a_R**-1.7

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (1.9,)

    @property
    def branches(self) -> tuple[Branch, ...]:
        C, B, _ = self._constants()
        omega_R = self._omega_R
        # F_c/(πRω_c H) = (2/3) C S_y/H
        unit = 2 / 3 * C / self.hardness_ratio

        def area(y):
            return y * (y / 1.9) ** B

        def force(y):
            first = np.exp(-(y ** (5 / 12)) / 4) * y**1.5
            hardness, _ = self._hardness(np.sqrt(omega_R * area(y)))
            return unit * (first + 4 / C * hardness * -np.expm1(-(y ** (5 / 9)) / 25) * y)

        def stiffness(y):
            p, q = 5 / 12, 5 / 9
            first = np.exp(-(y**p) / 4) * (1.5 * y**0.5 - p / 4 * y ** (p + 0.5))
            a_R = np.sqrt(omega_R * area(y))
            hardness, slope = self._hardness(a_R)
            grow = -np.expm1(-(y**q) / 25)
            grow_slope = np.exp(-(y**q) / 25) * q / 25 * y ** (q - 1)
            a_slope = a_R * (1 + B) / (2 * y)
            second = slope * a_slope * grow * y + hardness * (grow_slope * y + grow)
            return unit * (first + 4 / C * second)

        return (
            Branch("elastic", lambda y: unit * y**1.5, lambda y: y, lambda y: 1.5 * unit * y**0.5),
            Branch("elastoplastic", force, area, stiffness),
        )
