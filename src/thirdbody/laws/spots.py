"""Spots of particles: every contact of a particle, as an output sees it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from numpy.typing import NDArray

    from ..populations.distributions import Distribution
    from ..populations.materials import Material
    from ..populations.particles import Particles
    from ..populations.shape import Angular

    Array = NDArray[np.float64]

__all__ = ["Layout", "ParticleSpots", "Spots", "of_both_sides"]

EVEN = 1e-9
"""Contacts of a particle that differ by less, relatively, are alike."""


@dataclass(frozen=True, eq=False, kw_only=True)
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
    kept: dict[Hashable, Any] = field(init=False, repr=False, compare=False, default_factory=dict)
    """What outputs found for these spots, for each other."""

    def total(self, q: Array | float) -> Array:
        """Σ n q per nominal area: (N,) for q that broadcasts with (M, n)."""
        sums = np.sum(self.number * q, axis=-1)
        return sums if self.share is None else self.share @ sums

    def above(self, values: Array, levels: Array, weight: Array | float = 1.0) -> Array:
        """Σ n weight over the spots whose value exceeds a level: (N, L) for increasing levels."""
        below = np.searchsorted(levels, np.broadcast_to(values, self.number.shape), side="left")
        rows = np.arange(len(self.number))[:, None]
        counts = np.zeros((len(self.number), len(levels) + 1))
        np.add.at(counts, (rows, below), self.number * weight)
        over = np.cumsum(counts[:, ::-1], axis=1)[:, -2::-1]
        return over if self.share is None else self.share @ over

    def thin_spots(self, factor: Array) -> Self:
        """A part of the spots of each state: factor (N,)."""
        if self.share is None:
            return replace(self, number=self.number * factor[:, None])
        return replace(self, share=self.share * factor[:, None])


@dataclass(frozen=True, eq=False, kw_only=True)
class Layout:
    """Places of the classes of whole particles: their gaps and sizes.

    Parameters
    ----------
    sizes : Distribution
        Of the particles, in units of ``scale``.
    x : array (M, n)
        Diameters of the particles [m]; increasing along every row.
    gaps : array (M,)
        Gap of every class [m].
    means, width : array (N,) and float, or None
        Mean gap of every state and standard deviation of the seats [m]; None for plane seats,
        where the class of a state is in its own gap.
    density : array (N,) or float
        Particles of every size per nominal area [1/m²].
    scale : float
        [m].
    """

    sizes: Distribution
    x: Array
    gaps: Array
    means: Array | None = None
    width: float = 0.0
    density: Array | float = 1.0
    scale: float = 1.0

    def of_size(self, scale: float, density: float) -> Layout:
        """Spots for a number of particles per area, all lengths times ``scale``."""
        return replace(
            self,
            x=scale * self.x,
            gaps=scale * self.gaps,
            means=None if self.means is None else scale * self.means,
            width=scale * self.width,
            density=density * self.density,
            scale=scale * self.scale,
        )


def of_both_sides(
    values: tuple[Array, Array], change: Callable[[Array], Array]
) -> tuple[Array, Array]:
    """A change of the values of both sides, made once where they are one array."""
    one, two = values
    changed = change(one)
    return changed, changed if two is one else change(two)


@dataclass(frozen=True, eq=False, kw_only=True)
class ParticleSpots(Spots):
    """Spots of particles of one population; each has a contact with surface 1 and with surface 2.

    Parameters
    ----------
    x, radius : array (M, n)
        Diameter (thickness of flakes), and radius of its tips [m].
    depths, sinks, areas : two arrays (M, n)
        Indentation δ_1, δ_2 [m]; depth of the impression in each surface [m], the indentation less
        what the particle itself is squashed; contact area a_1, a_2 [m²].
    regimes : two arrays (M, n)
        Index into `thirdbody.laws.base.REGIMES`.
    yields : two floats
        Indentation of first yield over the diameter.
    hardness : two floats
        Of the softer body of each contact [Pa].
    shape : Angular or None
        Of particles that are not round.
    knows_sink : (bool, bool)
        Whether the law says how much of each indentation is the particle's own squash.
    material : Material
        Of the particles.
    population : Particles
    parents : array (M, n) or None
        Of particles that break: how many there were of the size before any broke [1/m²].
    survival : array (M, n) or None
        Their P_s, and that of pieces of the size [1].
    layout : Layout or None
        Of whole particles: the sizes and gaps of the classes.
    """

    x: Array
    radius: Array
    depths: tuple[Array, Array]
    sinks: tuple[Array, Array]
    areas: tuple[Array, Array]
    regimes: tuple[NDArray[np.intp], NDArray[np.intp]]
    yields: tuple[float, float]
    hardness: tuple[float, float]
    shape: Angular | None = None
    knows_sink: tuple[bool, bool] = (False, False)
    material: Material | None = None
    population: Particles | None = None
    parents: Array | None = None
    survival: Array | None = None
    layout: Layout | None = None

    @property
    def has_alike_sides(self) -> bool:
        """Whether the arrays of both sides are the same ones, and all else of them is equal."""
        same = all(one is two for one, two in (self.depths, self.sinks, self.areas))
        return same and all(
            one == two for one, two in (self.yields, self.hardness, self.knows_sink)
        )

    @property
    def half(self) -> Array:
        """Depth at which a side of a particle has sunk in (M, n) [m]: the radius of a round one."""
        return self.radius if self.shape is None else 0.5 * self.x

    @property
    def height(self) -> Array:
        """Height left of each particle (M, n) [m]: its size less what it is squashed itself.

        Where the law does not say that, the softer of particle and surface gives way.
        """
        left = self.x
        for depth, sink, knows, H in zip(
            self.depths, self.sinks, self.knows_sink, self.hardness, strict=True
        ):
            if knows:
                left = left - (depth - sink)
            elif self.material is not None and self.material.H <= H:
                left = left - depth
        return np.maximum(left, 0.0)

    @property
    def even(self) -> NDArray[np.bool_]:
        """Particles whose two contacts are alike (M, n): what slides, slides over either."""
        alike = np.full(self.x.shape, math.isclose(*self.hardness, rel_tol=EVEN))
        for one, two in (self.depths, self.sinks):
            alike &= np.abs(one - two) <= EVEN * (one + two)
        return alike

    def impression_radius(self, side: int) -> Array:
        r"""Radius of the cap that a particle presses into surface 1 (side 0) or 2 (M, n) [m].

        That of its tip; of one that is squashed itself, of a cap as wide as the contact and as
        deep as the sink d, :math:`(a^2+d^2)/2d` with :math:`\pi a^2` the contact area.
        """
        if not self.knows_sink[side]:
            return self.radius
        d, a = self.sinks[side], np.sqrt(self.areas[side] / np.pi)
        cap = np.divide(a**2 + d**2, 2 * d, out=np.zeros_like(d), where=d > 0)
        return np.maximum(self.radius, np.where(d < a, cap, a))

    def impression_kind(self, side: int) -> NDArray[np.intp]:
        """A number (M, n) that changes where an impression follows another formula.

        It yields, its cap is flatter than the tip of the particle, it is deeper than wide.
        """
        yielding = self.sinks[side] > self.yields[side] * self.x
        flatter = self.impression_radius(side) > self.radius
        deeper = self.sinks[side] > np.sqrt(self.areas[side] / np.pi)
        return 4 * yielding + 2 * flatter + deeper

    def thin_spots(self, factor: Array) -> Self:
        """A part of the spots of each state: factor (N,)."""
        thin = Spots.thin_spots(self, factor)
        if self.layout is not None:
            thin = replace(thin, layout=replace(self.layout, density=self.layout.density * factor))
        if self.share is None and self.parents is not None:
            return replace(thin, parents=self.parents * factor[:, None])
        return thin

    def of_size(self, scale: float, density: float) -> ParticleSpots:
        """Spots for a number of particles per area, all lengths times ``scale``."""
        return replace(
            self,
            number=density * self.number,
            parents=None if self.parents is None else density * self.parents,
            load=scale**2 * self.load,
            x=scale * self.x,
            radius=scale * self.radius,
            depths=of_both_sides(self.depths, lambda depth: scale * depth),
            sinks=of_both_sides(self.sinks, lambda sink: scale * sink),
            areas=of_both_sides(self.areas, lambda area: scale**2 * area),
            layout=None if self.layout is None else self.layout.of_size(scale, density),
        )
