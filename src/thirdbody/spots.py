r"""Spots: every contact of an interface, as an output sees it.

A solved state says how many contacts of which kind there are. Whatever a contact does besides
carrying load (it rubs, heats, conducts, wears) is a function q of that one contact, and the
interface does

.. math:: Q = \sum n\,q(\text{spot})

per nominal area. Spots of many states share their nodes: with classes of spots that depend on the
state only by how many of them there are, q is evaluated once for all states.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .heights import Heights
    from .laws.base import AbstractAsperityLaw
    from .materials import Material
    from .particles import Particles

    Array = NDArray[np.float64]

__all__ = ["AsperitySpots", "ParticleSpots", "Spots"]


@dataclass(frozen=True, kw_only=True)
class Spots:
    r"""Contacts of one kind in N states: M classes of n spots each.

    State i holds :math:`n_{ijk} = s_{ij} m_{jk}` spots (j, k) per nominal area.

    Parameters
    ----------
    share : array (N, M) or None
        s_ij [1]; None where class i belongs to state i alone (M = N).
    number : array (M, n)
        m_jk [1/m²].
    load : array (M, n)
        Load of one spot [N].
    """

    share: Array | None
    number: Array
    load: Array
    kept: dict[Any, Any] = field(init=False, repr=False, compare=False, default_factory=dict)
    """What outputs found for these spots, for each other."""

    def total(self, q: Array | float) -> Array:
        """Σ n q per nominal area: (N,) for q that broadcasts with (M, n)."""
        each = np.sum(self.number * q, axis=-1)
        return each if self.share is None else self.share @ each

    def above(self, values: Array, levels: Array, weight: Array | float = 1.0) -> Array:
        """Σ n weight over the spots whose value exceeds a level: (N, L) for increasing levels."""
        below = np.searchsorted(levels, np.broadcast_to(values, self.number.shape), side="left")
        rows = np.arange(len(self.number))[:, None]
        counts = np.zeros((len(self.number), len(levels) + 1))
        np.add.at(counts, (rows, below), self.number * weight)
        over = np.cumsum(counts[:, ::-1], axis=1)[:, -2::-1]
        return over if self.share is None else self.share @ over

    def thinned(self, factor: Array) -> Self:
        """A part of the spots of each state: factor (N,)."""
        if self.share is None:
            return replace(self, number=self.number * factor[:, None])
        return replace(self, share=self.share * factor[:, None])


@dataclass(frozen=True, kw_only=True)
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

    def thinned(self, factor: Array) -> Self:
        return replace(super().thinned(factor), density=self.density * factor)

    def deeper(self, omega: Array) -> Array:
        """Asperities pressed deeper than ω [m] per nominal area; broadcasts with (N,)."""
        return self.density * self.heights.sf(self.lowest + omega / self.sigma_s)

    def deepest(self, count: float | Array) -> Array:
        """Interference [m] that so many asperities per nominal area exceed; ≤ 0 for none: (N,)."""
        part = np.minimum(count / np.maximum(self.density, np.finfo(float).tiny), 1.0)
        return self.sigma_s * (self.heights.isf(part) - self.lowest)

    def load_at(self, omega: Array) -> Array:
        """Load of one asperity [N] pressed by ω [m]."""
        return self.law.force(omega, R=self.R, E_star=self.E_star, H=self.H)

    def area_at(self, omega: Array) -> Array:
        """Contact area of one asperity [m²] pressed by ω [m]."""
        return self.law.area(omega, R=self.R, E_star=self.E_star, H=self.H)


@dataclass(frozen=True, kw_only=True)
class ParticleSpots(Spots):
    """Particles of one population; each has a contact with surface 1 and one with surface 2.

    Parameters
    ----------
    x, radius : array (M, n)
        Diameter (thickness of flakes), and radius of its tips [m].
    depths, areas : two arrays (M, n)
        Indentation δ_1, δ_2 [m], and contact area a_1, a_2 [m²].
    regimes : two arrays (M, n)
        Index into `thirdbody.laws.base.REGIMES`.
    yields : two floats
        Indentation of first yield over the diameter.
    hardness : two floats
        Of the softer body of each contact [Pa].
    material : Material
        Of the particles.
    population : Particles
    """

    x: Array
    radius: Array
    depths: tuple[Array, Array]
    areas: tuple[Array, Array]
    regimes: tuple[NDArray[np.intp], NDArray[np.intp]]
    yields: tuple[float, float]
    hardness: tuple[float, float]
    material: Material | None = None
    population: Particles | None = None

    def of_size(self, scale: float, density: float) -> ParticleSpots:
        """So many particles per nominal area, every length ``scale`` times as large."""
        one, two = self.depths
        first, second = self.areas
        return replace(
            self,
            number=density * self.number,
            load=scale**2 * self.load,
            x=scale * self.x,
            radius=scale * self.radius,
            depths=(scale * one, scale * two),
            areas=(scale**2 * first, scale**2 * second),
        )
