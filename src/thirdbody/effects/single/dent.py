"""The dent that one particle leaves, and what breaks or flattens it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

import numpy as np

from ...populations.materials import Material
from ...quantities.arguments import need_one
from ...quantities.carried import takes_units
from .ploughing import residual_depth

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = [
    "Debris",
    "Dent",
    "dent_diameter",
    "dent_of",
    "dent_volume",
    "dents_after",
    "flattened_diameter",
    "footprint",
    "fragments",
    "sink",
    "sunk",
]

Debris = Literal["by_hardness", "hard", "ductile", "brittle"]
"""What particles do when pressed; by default what their hardness says."""


# ------------------------------------------------------------------------------ one particle
@takes_units
def dent_diameter(depth: ArrayLike, *, radius: ArrayLike) -> Array:
    r"""Diameter of the dent of a hard sphere pressed δ deep.

    .. math:: D = 2\sqrt{2 r \delta - \delta^2}, \qquad D = 2 r \text{ for } \delta \ge r

    Parameters
    ----------
    depth, radius : array_like
        δ under load and r [m].

    Returns
    -------
    array
        D [m]; unloading recovers depth, hardly width (assumption).

    Examples
    --------
    >>> from thirdbody.effects.single.dent import dent_diameter
    >>> float(dent_diameter(1.0, radius=5.0))
    6.0
    """
    depth = np.clip(depth, 0.0, radius)
    return 2 * np.sqrt(depth * (2 * np.asarray(radius) - depth))


@takes_units
def dent_volume(residual: ArrayLike, *, depth: ArrayLike, radius: ArrayLike) -> Array:
    r"""Volume of a dent: a spherical cap as wide as under load and as deep as what stays.

    .. math:: V = \frac{\pi}{6}\,\delta_{res}\left(\tfrac34 D^2+\delta_{res}^2\right)

    Below δ_res = r the cap ends, and a cylinder of radius r goes on.

    Parameters
    ----------
    residual, depth, radius : array_like
        Depth left δ_res, depth under load δ, and r [m].

    Returns
    -------
    array
        V [m³].

    Examples
    --------
    >>> import numpy as np
    >>> from thirdbody.effects.single.dent import dent_volume
    >>> round(float(dent_volume(1.0, depth=1.0, radius=1.0)) / np.pi, 12)  # half a sphere
    0.666666666667
    """
    radius = np.asarray(radius, dtype=float)
    width = dent_diameter(depth, radius=radius)
    cap = np.minimum(residual, radius)
    shaft = np.maximum(np.asarray(residual) - radius, 0.0)
    return np.pi / 6 * cap * (0.75 * width**2 + cap**2) + np.pi * radius**2 * shaft


@takes_units
def flattened_diameter(x: ArrayLike, *, gap: ArrayLike) -> Array:
    r"""Diameter of the disc that a ductile sphere becomes in a gap, its volume kept.

    .. math:: D = x\sqrt{\frac{2x}{3g}}, \qquad g < \tfrac23 x

    Parameters
    ----------
    x, gap : array_like
        Diameter of the sphere and gap g [m].

    Returns
    -------
    array
        D [m]; never below x: in a wider gap the sphere is barrelled, not yet a disc.

    Examples
    --------
    >>> from thirdbody.effects.single.dent import flattened_diameter
    >>> float(flattened_diameter(6.0, gap=1.0))
    12.0
    """
    x, gap = np.asarray(x, dtype=float), np.asarray(gap, dtype=float)
    # of no size nothing is flattened, in no gap either
    ratio = np.divide(2 * x, 3 * gap, out=np.zeros(np.broadcast(x, gap).shape), where=x > 0)
    return x * np.sqrt(np.maximum(ratio, 1.0))


@takes_units
def fragments(x: ArrayLike, *, size: float) -> Array:
    r"""Number of equal fragments of a brittle particle of size x, its volume kept.

    .. math:: N = \max\left[(x/x_f)^3,\,1\right]

    Parameters
    ----------
    x : array_like
        Size of the particle [m]; up to ``size`` it stays whole.
    size : float
        Size of a fragment x_f [m].

    Returns
    -------
    array
        N [1], not rounded: a mean over many particles.

    Examples
    --------
    >>> from thirdbody.effects.single.dent import fragments
    >>> fragments([0.5, 2.0], size=1.0).tolist()
    [1.0, 8.0]
    """
    return np.maximum(np.asarray(x, dtype=float) / size, 1.0) ** 3


@takes_units
def dents_after(rate: ArrayLike, *, overrollings: ArrayLike, area: ArrayLike) -> Array:
    r"""Dents that one can tell apart after many overrollings.

    .. math:: N_d = \frac{1-e^{-N\eta a}}{a} \to N\eta\ \text{(few)},\quad 1/a\ \text{(many)}

    Parameters
    ----------
    rate : array_like
        Dents per area and overrolling η [1/m²].
    overrollings : array_like
        N [1]; fresh oil each time.
    area : array_like
        Mean area of a dent a [m²].

    Returns
    -------
    array
        N_d [1/m²]; N_d a is the share of the surface that is dented, exact for dents thrown at
        random places.

    Examples
    --------
    >>> from thirdbody.effects.single.dent import dents_after
    >>> print(dents_after(10.0, overrollings=[1.0, 1e6], area=1e-3).round(2))
    [   9.95 1000.  ]
    """
    thrown = np.multiply(rate, overrollings)
    covered = np.multiply(thrown, area)
    # (1 − e^(−c))/c
    share = np.where(covered > 0, -np.expm1(-covered) / np.where(covered > 0, covered, 1.0), 1.0)
    return thrown * share


class Dent(NamedTuple):
    """Dents of particles in one surface: arrays (M, n), made by `dent_of`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.effects.single.dent import dent_of
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=silica, film=0.5e-6, entry=1.0)
    >>> dent = dent_of(oil.single([2e-6, 5e-6]), side=0, particle=silica)
    >>> (dent.diameter.ravel() * 1e6).round(2).tolist()  # µm
    [2.38, 7.91]
    """

    depth: Array
    """Depth left δ_res [m]; 0 where nothing stays, NaN where it is not known."""
    diameter: Array
    """Its diameter, that under load [m]; of a flattened particle that of its footprint."""
    volume: Array
    """Its volume [m³], NaN where the depth is not known."""


@takes_units
def sink(
    particle: Material, *, hardness: float, debris: Debris = "by_hardness", computed: bool = False
) -> float:
    """Share of a particle's sink into a surface that stays as a dent.

    Where its law says how deep it sinks (``computed``), all of that does, at any hardness. Where
    none does, a particle harder than the surface sinks in whole; one that is not is flattened, and
    how far it sinks is not known: NaN, never 0.

    Parameters
    ----------
    particle : Material
    hardness : float
        H of the softer one of particle and surface [Pa], as `ParticleSpots.hardness` has it.
    debris : {"by_hardness", "hard", "ductile", "brittle"}, optional
        What the user says: "hard" sinks in whole whatever its hardness, "ductile" is flattened.
    computed : bool, optional
        Whether the law says how deep the particle sinks, as `ParticleSpots.knows_sink` has it.

    Returns
    -------
    float
        1 for all of it, NaN where it is not known [1].

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.effects.single.dent import sink
    >>> steel = tb.materials["S45C"]
    >>> sink(tb.materials["SiO2"], hardness=steel.H), sink(steel, hardness=steel.H)
    (1.0, nan)
    """
    need_one("debris", debris, *get_args(Debris))
    if debris == "hard" or (debris != "ductile" and (computed or particle.H > hardness)):
        return 1.0
    return math.nan


@takes_units
def sunk(
    spots: ParticleSpots, *, side: int, particle: Material, debris: Debris = "by_hardness"
) -> Array:
    """How deep particles sit in surface 1 (side 0) or 2 (side 1) under load (M, n) [m].

    Parameters
    ----------
    spots : ParticleSpots
    side : {0, 1}
        Surface 1 or 2.
    particle : Material
        Of the particles.
    debris : str, optional
        What the user says of it, as in `sink`; a "hard" one takes no part of the squeeze itself.

    Returns
    -------
    array
        NaN where it is not known; never more than the particle is thick.
    """
    need_one("side", side, 0, 1)
    share = sink(
        particle, hardness=spots.hardness[side], debris=debris, computed=spots.knows_sink[side]
    )
    depths = spots.depths if debris == "hard" else spots.sinks
    return np.minimum(share * depths[side], spots.x)


@takes_units
def footprint(spots: ParticleSpots, *, side: int, squashed: bool = False) -> Array:
    """Diameter of the disc to which a particle is flattened (M, n) [m]; 0 where nothing presses.

    Parameters
    ----------
    spots : ParticleSpots
    side : {0, 1}
        Surface 1 or 2.
    squashed : bool, optional
        Whether the areas are those of squashed particles, of which it is the contact; otherwise
        it is a disc of the particle's volume as high as its gap.

    Returns
    -------
    array
    """
    need_one("side", side, 0, 1)
    if squashed:
        return 2 * np.sqrt(spots.areas[side] / np.pi)
    gap = np.maximum(spots.x - spots.depths[0] - spots.depths[1], 1e-3 * spots.x)
    return (spots.load > 0) * flattened_diameter(spots.x, gap=gap)


@takes_units
def dent_of(
    spots: ParticleSpots,
    *,
    side: int,
    particle: Material,
    debris: Debris = "by_hardness",
    squashed: bool = False,
) -> Dent:
    """The dents of particles in surface 1 (side 0) or 2 (side 1).

    Depth and width follow the law where it says how deep a particle sinks. Where it does not, a
    particle that is harder than the surface dents it, and one that is not is flattened: the width
    is that of its footprint, depth and volume are not known (`sink`). No dent is deeper than the
    particle is thick.

    Parameters
    ----------
    spots : ParticleSpots
        Particles and how deep each sits, as `FilmParticles.single` or a solved state has them.
    side : {0, 1}
        Surface 1 or 2.
    particle : Material
        Of the particles.
    debris : str, optional
        What the user says of it, as in `sink`.
    squashed : bool, optional
        As in `footprint`.

    Returns
    -------
    Dent
        Depth left and diameter [m] and volume [m³] of each spot: arrays (M, n).

    Notes
    -----
    Depth left by `thirdbody.effects.single.ploughing.residual_depth`, where the source stands; the
    width is that under load, of a cap as deep as the sink and as wide as the contact
    (`ParticleSpots.impression_radius`). Angular particles leave dents as wide as their contact: up
    to the end of their rounded tip a cap, from there on a cone, V = πa²δ_res/3.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.effects.single.dent import dent_of
    >>> from thirdbody.systems.oil_particles import FilmParticles
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> oil = FilmParticles.from_iso4406("18/16/13", surfaces=tb.MaterialPair(steel, steel),
    ...                                  material=silica, film=0.5e-6, entry=1.0)
    >>> depth = dent_of(oil.single(2e-6), side=0, particle=silica).depth[0, 0]
    >>> f"{depth * 1e6:.2f} µm"
    '0.10 µm'
    """
    depth = sunk(spots, side=side, particle=particle, debris=debris)
    if np.any(np.isnan(depth)):
        wide = footprint(spots, side=side, squashed=squashed)
        unknown = np.where(wide > 0, np.nan, 0.0)
        return Dent(unknown, wide, unknown)
    radius = spots.radius if debris == "hard" else spots.impression_radius(side)
    first = spots.yields[side] * spots.x
    ratio = np.divide(depth, first, out=np.zeros_like(depth), where=first > 0)
    left = residual_depth(depth, depth_over_yield=ratio)
    there = left > 0
    volume = dent_volume(left, depth=depth, radius=radius)
    shape = spots.shape
    if shape is None or shape.round:
        return Dent(left, there * dent_diameter(depth, radius=radius), there * volume)
    area = spots.areas[side]
    a = np.sqrt(area / np.pi)
    volume = np.where(a < shape.edge * spots.x, volume, area * left / 3)
    return Dent(left, there * (2.0 * a), there * volume)
