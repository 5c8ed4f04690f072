r"""Spots: every contact of an interface, as an output sees it.

A solved state says how many contacts of which kind there are. Whatever a contact does besides
carrying load (it rubs, heats, conducts, wears) is a function q of that one contact, and the
interface does

.. math:: Q = \sum n\,q(\text{spot})

per nominal area. Spots of many states share their nodes: with classes of spots that depend on the
state only by how many of them there are, q is evaluated once for all states.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from ..laws.spots import Spots

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.base import AbstractAsperityLaw
    from ..populations.heights import Heights

    Array = NDArray[np.float64]

__all__ = ["AsperitySpots"]


@dataclass(frozen=True, eq=False, kw_only=True)
class AsperitySpots(Spots):
    """Asperities of one shape.

    Parameters
    ----------
    R : float
        Tip radius [m].
    depth : array (M, n)
        Interference ω [m].
    area : array (M, n)
        Contact area of one spot [m²].
    regime : array (M, n)
        Index into `thirdbody.laws.base.REGIMES`.
    law, E_star, H
        The bound law, and the contact modulus and softer hardness it takes [Pa].
    heights, sigma_s : Heights, float
        Distribution of the asperity heights, and its width [m].
    lowest : array (N,)
        Height above which asperities touch, in σ_s.
    density : array (N,)
        Asperities per nominal area, those in the shadow of particles left out [1/m²].
    """

    R: float
    depth: Array
    area: Array
    regime: NDArray[np.intp]
    law: AbstractAsperityLaw
    E_star: float
    H: float
    heights: Heights
    sigma_s: float
    lowest: Array
    density: Array

    def thin_spots(self, factor: Array) -> Self:
        return replace(super().thin_spots(factor), density=self.density * factor)

    def deeper(self, omega: Array) -> Array:
        """Asperities pressed deeper than ω [m] per nominal area; broadcasts with (N,)."""
        return self.density * self.heights.sf(self.lowest + omega / self.sigma_s)

    def deepest(self, count: float | Array) -> Array:
        """Interference [m] that so many asperities per nominal area exceed; ≤ 0 for none: (N,)."""
        share = np.minimum(count / np.maximum(self.density, np.finfo(float).tiny), 1.0)
        return self.sigma_s * (self.heights.isf(share) - self.lowest)

    def load_at(self, omega: Array) -> Array:
        """Load of one asperity [N] pressed by ω [m]."""
        return self.law.force(omega, R=self.R, E_star=self.E_star, H=self.H)

    def area_at(self, omega: Array) -> Array:
        """Contact area of one asperity [m²] pressed by ω [m]."""
        return self.law.area(omega, R=self.R, E_star=self.E_star, H=self.H)
