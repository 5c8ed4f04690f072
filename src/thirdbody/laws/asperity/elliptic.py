"""Elliptic asperities: exact Hertz contact, with CEB's and ZMC's ways to yield."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...quantities.value import choice, quantity
from ...reference import elliptic_hertz, elliptic_hertz_rows
from ..base import Branch, Jump
from .yielding import PeakPressureLaw
from .zmc import ZMC

__all__ = ["EllipticCEB", "EllipticZMC", "hertz_of"]


def hertz_of(ratio):
    """`elliptic_hertz` of one λ, or of many (N,)."""
    return elliptic_hertz_rows(ratio) if np.ndim(ratio) else elliptic_hertz(float(ratio))


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticCEB(PeakPressureLaw):
    r"""Elliptic asperities that keep their volume once they yield (after Horng 1998).

    Elastic: the exact Hertz contact, A = πR_Aω. Above ω_c = ω(p = ⅔KH) a frustum of the
    elliptic paraboloid, section 2πR_g per depth, conserves its volume:

    .. math:: A = \pi R_A\omega_c + 2\pi R_g(\omega-\omega_c), \qquad F = K H A

    Parameters
    ----------
    ratio : float
        λ = R′/R″ of the principal radii [1], at least 1. The R of the roughness is
        R_g = √(R′R″).
    area_rule : {"volume", "doubling"}, optional
        The area above yield: from volume conservation, or πR_Aω(2 − ω_c/ω). They differ by
        R_g/R_A at large ω (6 % at λ = 10).
    K, nu : float, optional
        As in `CEB`.

    Notes
    -----
    Reconstructed: the paper of 1998 could not be obtained; volume conservation as its idea is
    attested by a review. Exactly `CEB` at λ = 1. At ω_c the load jumps by 50 %, and
    the stiffness by 100 % (101 % at λ = 2, 113 % at λ = 10 with ``"volume"``).

    References
    ----------
    Horng 1998, J. Tribol. 120, 82; Buczkowski, Kleiber 2009, doi:10.1007/s11831-009-9037-2.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.asperity.EllipticCEB(ratio=1.0, K=0.6)
    >>> float(law.reduced("area", 2.0))
    3.0
    """

    name = "elliptic-ceb"
    title = "Horng, elliptic asperities"
    year = 1998
    citation = "after Horng 1998, J. Tribol. 120, 82 (reconstruction)"
    doi = ""
    provenance = "reconstructed"
    valid_range = "elliptic tips, ω ≪ R″"

    ratio: float = quantity("λ", "1", "ratio of the principal radii", default=1.0, ge=1)
    area_rule: Literal["volume", "doubling"] = choice("area above yield", default="volume")

    @property
    def jumps(self) -> dict[float, Jump]:
        # dA/dω from πR_A to 2πR_g (or 2πR_A), under a pressure that has grown by 3/2
        growth = 2 / elliptic_hertz(self.ratio).R_A if self.area_rule == "volume" else 2.0
        return {1.0: Jump(force=0.5, stiffness=growth - 1)}

    def yield_interference(self, *, R, E_star, H):
        """ω_c where the mean Hertz pressure is ⅔KH [m]."""
        p = 2 / 3 * self.yield_factor * H
        return hertz_of(self.ratio).yield_factor * (p / E_star) ** 2 * R

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (1.0,)

    @property
    def branches(self) -> tuple[Branch, ...]:
        K, r = self.yield_factor, elliptic_hertz(self.ratio).R_A
        slope = 2.0 if self.area_rule == "volume" else 2 * r

        def area(y):
            return r + slope * (y - 1)

        return (
            Branch(
                "elastic",
                lambda y: 2 / 3 * K * r * y**1.5,
                lambda y: r * y,
                lambda y: K * r * y**0.5,
            ),
            Branch("plastic", lambda y: K * area(y), area, lambda y: np.full_like(y, K * slope)),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class EllipticZMC(ZMC):
    r"""Elliptic asperities that yield in three stages (after Jeng and Wang 2003).

    Elastic: the exact Hertz contact. From ω_1 = ω(p = kH) to ω_2 = ρω_1 the pressure follows
    ZMC's logarithm and

    .. math:: A = \pi\omega\left[R_A + (2R_g-R_A)(3s^2-2s^3)\right];

    plastic: A = 2πR_gω, p = H. With ``area_rule="doubling"`` 2R_A stands in place of 2R_g.

    Parameters
    ----------
    ratio : float
        λ = R′/R″ of the principal radii [1], at least 1. The R of the roughness is
        R_g = √(R′R″).
    area_rule : {"volume", "doubling"}, optional
        Plastic area 2πR_gω, or twice the elastic one, 2πR_Aω.
    k, rho : float, optional
        As in `ZMC`. Keeping ρ = 54 of the sphere for ellipses is an assumption.

    Notes
    -----
    Reconstructed: the paper could not be obtained. Exactly `ZMC` at λ = 1.

    References
    ----------
    Jeng, Wang 2003, An elliptical microcontact model considering elastic, elastoplastic, and
    plastic deformation, J. Tribol. 125, 232.

    Examples
    --------
    >>> import thirdbody as tb
    >>> float(tb.asperity.EllipticZMC(ratio=1.0).reduced("area", 1.0))
    1.0
    """

    name = "elliptic-zmc"
    title = "Jeng–Wang, elliptic asperities"
    year = 2003
    citation = "after Jeng, Wang 2003, J. Tribol. 125, 232 (reconstruction)"
    doi = ""
    provenance = "reconstructed"
    valid_range = "elliptic tips, ω ≪ R″"

    ratio: float = quantity("λ", "1", "ratio of the principal radii", default=1.0, ge=1)
    area_rule: Literal["volume", "doubling"] = choice("plastic area", default="volume")

    def yield_interference(self, *, R, E_star, H):
        """ω_1 where the mean Hertz pressure is kH [m]."""
        return hertz_of(self.ratio).yield_factor * (self.k * H / E_star) ** 2 * R

    @property
    def _ends(self) -> tuple[float, float]:
        """Elastic and plastic area over πR_gω."""
        r = elliptic_hertz(self.ratio).R_A
        return r, 2.0 if self.area_rule == "volume" else 2 * r

    @property
    def branches(self) -> tuple[Branch, ...]:
        (r, full), k = self._ends, self.k
        middle = ZMC.branches.fget(self)[1]  # type: ignore[attr-defined]

        def plastic(y):
            return full * y

        return (
            Branch(
                "elastic",
                lambda y: k * r * y**1.5,
                lambda y: r * y,
                lambda y: 1.5 * k * r * y**0.5,
            ),
            middle,
            Branch("plastic", plastic, plastic, lambda y: np.full_like(y, full)),
        )

    def _area_factor(self, y):
        r, full = self._ends
        g, slope = ZMC._area_factor(self, y)
        return r + (full - r) * (g - 1), (full - r) * slope
