r"""What the particles of one class of size do in a gap, whatever the size of the class.

Classes of one ratio of edges are alike but for their scale, and laws of particles have no length
of their own. Every sum over the sizes of a class is then one curve,

.. math:: Q_k(g) = e_k^{\,p}\,\hat Q(g/e_k), \qquad
          \hat Q(\hat g) = \int \hat\varphi(\hat x)\,\hat q(\hat x, \hat g)\,d\hat x

with the upper edge e of the class and the power p of the quantity: 0 of counts, 1 of widths, 2 of
loads, areas and volumes per sliding length, 3 of volumes.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.contact import Contact
from ...contact.evaluation import splits_of
from ...contact.particle_averages import size_average
from ...effects.dents import Dents
from ...effects.friction import changes
from ...effects.single.dent import sunk
from ...effects.single.ploughing import groove_of
from ...errors import InvalidValue, Mistake
from ...laws.base import COLUMNS as OF_LAW
from ...laws.base import SeatedLaw
from ...laws.particle.breakage import Breakage
from ...numerics.chebyshev import PiecewiseChebyshev
from ...numerics.quadrature import gauss_legendre
from ...populations.particles import Particles
from ...populations.tabulated_sizes import PowerLaw

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...laws.spots import ParticleSpots
    from ...populations.materials import Material
    from ...populations.strength import WeibullStrength

    Array = NDArray[np.float64]

__all__ = ["POWERS", "ParticleCurve", "SurvivalCurve", "particle_curve"]

POWERS: dict[str, int] = {
    "load": 2,
    "shadow": 2,
    **dict.fromkeys(("wear_1", "wear_2"), 2),
    **dict.fromkeys(("loaded", "rolling", "in_1", "in_2", "sunk_1", "sunk_2"), 0),
    **dict.fromkeys(("dents_1", "dents_2"), 0),
    **dict.fromkeys(("dent_area_1", "dent_area_2"), 2),
    **dict.fromkeys(("dent_volume_1", "dent_volume_2"), 3),
    **dict.fromkeys(("groove_1", "groove_2", "roll_1", "roll_2"), 2),
    **dict.fromkeys(("shear", "plough", "roll", "rolling_load"), 2),
    **dict.fromkeys(("area_1", "area_2", "elastic", "elastoplastic", "plastic"), 2),
    **dict.fromkeys(("cut_1", "cut_2"), 1),
    **dict.fromkeys(("fixed_1", "fixed_2"), 2),
}
"""Every quantity that is tabulated, with its power of size.

Load [N], share of the area out of reach of asperities [m²]; worn from each surface per sliding
length, of which grooves and tracks of rolling ones [m²]; counts of loaded particles, of those that
roll, that are held in a surface, that sit deeper than half their radius; dents by count, area [m²]
and volume [m³]; forces by cause, load of rolling ones [N]; contact areas on each surface, and by
regime on the first [m²]; widths of grooves [m]; worn from each surface per sliding length by a
particle that is held fast in the other.
"""
RATIOS = 14
"""Digits in which two ratios of edges are one."""
BELOW = 1e-6
"""Tolerance of the curves, of the largest value of a quantity on a panel."""


class ParticleCurve:
    """Every quantity of `POWERS` for one particle of a class with upper edge 1, over the gap.

    Parameters
    ----------
    contact : Contact
        With `Friction` and `Wear`; its own particles do not matter.
    material : Material
        Of the particles.
    ratio : float
        Lower over upper edge of the class [1].
    lowest : float
        Gap below which the curve is held, over the upper edge [1].
    """

    names = tuple(POWERS)

    def __init__(self, contact: Contact, material: Material, ratio: float, lowest: float):
        self.material = material
        sizes = PowerLaw(edges=(ratio, 1.0), counts=(1.0,), slopes=(3.0,))
        self.population = Particles(material=material, diameter=sizes, areal_density=1e-9)
        dents = [output for output in contact.outputs if isinstance(output, Dents)] or [Dents()]
        outputs = (*(output for output in contact.outputs if output is not dents[0]), dents[0])
        self.contact = contact.replace(particles=self.population, outputs=outputs)
        law = self.contact.law_of(self.population)
        if not isinstance(law, SeatedLaw):
            raise InvalidValue(
                f"the particle law {law.name} does not say what one particle does in its seat; a "
                "history needs particle.Series or particle.Flakes",
                code=Mistake.BEYOND,
            )
        self.law = law
        self.one = law.one(surfaces=contact.surfaces, particle=material)
        self.average = size_average(self.one, sizes)
        self.splits = sorted(
            {
                eps
                for output in outputs
                for eps in splits_of(output, law, contact.surfaces, material)
            }
        )
        self.lowest = min(lowest, self.average.bottom, 0.0)
        self.splits += changes(self._probe, self._dent_kinds)
        kinks = [*self.one.kinks, *self.splits]
        gaps = [x * (1 - eps) for x in (ratio, 1.0) for eps in (0.0, 1.0, *kinks)]
        inner = {float(g) for g in gaps if self.lowest < g < 1.0}
        self.gaps = np.array(sorted({self.lowest, 1.0, *inner}))
        """Gaps between which the curve is smooth, over the upper edge."""
        self.depths_known = True
        edges = np.sqrt(1.0 - self.gaps[::-1])
        edges = np.concatenate([edges[:1], edges[1:][np.diff(edges) > 1e-9]])
        self.series = PiecewiseChebyshev(
            self._by_root, edges, degree=13, tolerance=BELOW, max_depth=7, kinds=KINDS
        )
        self.panels = 1.0 - self.series.edges[::-1] ** 2
        """Ends of its panels: between them it is a polynomial in the root of the gap."""
        self.powers = np.array([POWERS[name] for name in self.names])

    def _probe(self, eps: Array) -> ParticleSpots:
        spots = self.law.probe(eps, surfaces=self.contact.surfaces, particle=self.material)
        return replace(spots, material=self.material, population=self.population)

    def _dent_kinds(self, spots: ParticleSpots) -> NDArray[np.intp]:
        """Where dents that stay set in, get a shaft, and end, as a number."""
        out = np.zeros(spots.x.shape, np.intp)
        for side, ends in zip((0, 1), self._deepest, strict=True):
            depth = self._depth_left(spots, side)
            out = 4 * out + (depth > 0) + (depth > spots.impression_radius(side))
            out += depth >= ends * (1 - 1e-9)
        return out

    def _depth_left(self, spots: ParticleSpots, side: int) -> Array:
        dents = self.contact.outputs[-1]
        assert isinstance(dents, Dents)
        with np.errstate(all="ignore"):
            return dents._dent_left(spots, side, self.contact).depth

    @cached_property
    def _deepest(self) -> list[float]:
        """Depth of the deepest dents in either surface, over the size."""
        spots = self._probe(np.array([4.0]))
        return [float(self._depth_left(spots, side)[0, 0]) for side in (0, 1)]

    def _by_root(self, u: Array) -> Array:
        out = np.empty((len(u), len(self.names)))
        for rows in np.array_split(np.arange(len(u)), max(1, len(u) // 100)):
            out[rows] = self.by_quadrature(1.0 - u[rows] ** 2)
        return out

    def by_quadrature(self, gap: Array) -> Array:
        """Every quantity at gaps over the upper edge (N,), by sums over spots: (N, Q)."""
        gap = np.maximum(gap, self.lowest)
        spots = self.average.spots_in(gap[:, None], 1.0 - gap[:, None], self.splits, None, 1.0)
        spots = replace(spots, material=self.material, population=self.population)
        with np.errstate(all="ignore"):  # a spot without a load has no number of its own
            quantities = self._quantities(spots)
        quantities["shadow"] = self._shadow(gap)
        return np.stack([quantities[name] for name in self.names], axis=1)

    def _shadow(self, gap: Array) -> Array:
        if self.law.shadow not in ("footprint", "projected"):
            return np.zeros_like(gap)
        column = OF_LAW.index(self.law.shadow)
        return self.average.average(gap, 1.0 - gap)[:, column]

    def _quantities(self, spots: ParticleSpots) -> dict[str, Array]:
        outputs: dict[str, Any] = {output.name: output for output in self.contact.outputs}
        friction, wear, dents = (outputs[name] for name in ("friction", "wear", "dents"))
        motion, loaded = friction.motion(spots), spots.load > 0
        out: dict[str, Array] = {"load": spots.total(spots.load)}
        rolls, slides = loaded & motion.rolls, loaded & ~motion.rolls
        out["loaded"] = spots.total(loaded.astype(float))
        out["rolling"] = spots.total(rolls.astype(float))
        for side in (0, 1):
            # what slides over the other surface is held in this one
            held = slides * np.where(spots.even, 0.5, motion.side == 1 - side)
            out[f"in_{side + 1}"] = spots.total(held)
        worn = wear.of_particles(spots, friction)
        for side in (0, 1):
            parts = {name: spots.total(worn[name][side]) for name in ("sa", "groove", "roll")}
            out[f"wear_{side + 1}"] = sum(parts.values(), np.zeros(()))
            out[f"groove_{side + 1}"], out[f"roll_{side + 1}"] = parts["groove"], parts["roll"]
            out[f"cut_{side + 1}"] = spots.total(worn["cut"][side])
            out |= self._dents(spots, dents, side)
            groove = friction.indents(spots)[side] * groove_of(spots, side=side)
            touch = wear._archard("sa", spots.regimes[side], spots.areas[side])
            out[f"fixed_{side + 1}"] = spots.total(touch + (wear.f_ab or 0.0) * groove)
        for name, force in friction.of_particles(spots).items():
            out[name.removeprefix("sa_")] = spots.total(force)
        out["rolling_load"] = spots.total(rolls * spots.load)
        for side in (0, 1):
            out[f"area_{side + 1}"] = spots.total(spots.areas[side])
        for index, name in enumerate(("elastic", "elastoplastic", "plastic")):
            out[name] = spots.total(spots.areas[0] * (spots.regimes[0] == index))
        return out

    def _dents(self, spots: ParticleSpots, dents: Any, side: int) -> dict[str, Array]:
        dent = dents._dent_left(spots, side, self.contact)
        deep = sunk(spots, side=side, particle=self.material, debris=dents.debris)
        there, has_depth = dent.diameter > 0, np.isfinite(dent.depth)
        counts = there & (~has_depth | (dent.depth > 0))
        self.depths_known &= bool(np.all(has_depth | ~there))
        stays = there & has_depth & (2 * deep > spots.half)
        return {
            f"dents_{side + 1}": spots.total(counts.astype(float)),
            f"dent_area_{side + 1}": spots.total(np.pi / 4 * counts * dent.diameter**2),
            f"dent_volume_{side + 1}": spots.total(np.where(has_depth, dent.volume, 0.0)),
            f"sunk_{side + 1}": spots.total(stays.astype(float)),
        }

    @cached_property
    def largest(self) -> Array:
        """No less than the largest value of every quantity: (Q,)."""
        upper_limit: Array = np.max(np.abs(self.series.coefficients).sum(axis=1), axis=0)
        return upper_limit

    def __call__(self, gap: Array) -> Array:
        """Every quantity at gaps over the upper edge (N,): (N, Q)."""
        gap = np.asarray(gap, float)
        out = self.series(np.sqrt(1.0 - np.clip(gap, self.lowest, 1.0)))
        out[gap >= 1.0] = 0.0
        return out


KINDS = tuple(range(len(POWERS)))
"""Each quantity is measured against itself."""


@lru_cache(maxsize=64)
def particle_curve(
    contact: Contact, material: Material, ratio: float, lowest: float
) -> ParticleCurve:
    """The cached curve of one kind of particles; the contact is one without particles."""
    return ParticleCurve(contact, material, ratio, lowest)


class SurvivalCurve:
    r"""Part of the particles of each class that break as the gap closes on them, over the gap.

    .. math:: b(g) = \int \varphi_a\,[1 - P_s(x, g)]\,dx

    Parameters
    ----------
    curve : ParticleCurve
        Of their kind.
    strength : WeibullStrength
    tops : array (K,)
        Upper edges of the classes [m].

    Notes
    -----
    By number, of the particles of a class as they come; the same for pieces of that size. Strength
    has a length of its own, so there is a column for each class, over the gap in its upper edge.
    """

    def __init__(self, curve: ParticleCurve, strength: WeibullStrength, tops: Array):
        self.average, self.lowest = curve.average, curve.lowest
        self.breakages = [
            Breakage.of_material(strength, curve.material, float(top)) for top in tops
        ]
        self.tension = self.breakages[0].tension(curve.one)
        low = self.average.sizes.support[0]
        kinks = [float(eps) for eps in self.tension.kinks]
        gaps = {x * (1 - eps) for x in (low, 1.0) for eps in (0.0, *kinks)}
        inside = np.array(sorted({self.lowest, 1.0, *(g for g in gaps if self.lowest < g < 1)}))
        edges = np.sqrt(1.0 - inside[::-1])
        edges = np.concatenate([edges[:1], edges[1:][np.diff(edges) > 1e-9]])
        self.series = PiecewiseChebyshev(
            self._by_root, edges, degree=9, tolerance=1e-5, max_depth=4, kinds=[0] * len(tops)
        )

    @property
    def panels(self) -> Array:
        """Ends of its panels: between them it is a polynomial in the root of the gap."""
        return 1.0 - self.series.edges[::-1] ** 2

    def _by_root(self, u: Array) -> Array:
        out = np.empty((len(u), len(self.breakages)))
        for rows in np.array_split(np.arange(len(u)), max(1, len(u) // 100)):
            out[rows] = self.by_quadrature(1.0 - u[rows] ** 2)
        return out

    def by_quadrature(self, gap: Array) -> Array:
        """b of every class at gaps over its upper edge (N,): (N, K)."""
        gap = np.maximum(gap, self.lowest)[:, None]
        x, delta, number = self.average.of_sizes(gap, 1.0 - gap, self.tension.kinks.tolist(), 10)
        eps = np.maximum(delta, 0.0) / x
        stress = np.zeros_like(eps)
        pressed = eps > 0
        stress[pressed] = self.tension.greatest_so_far(eps[pressed])
        broken = [np.sum(number * (1 - b.survival(x, stress)), axis=1) for b in self.breakages]
        return np.stack(broken, axis=1)

    def of_class(self, k: int, gap: Array) -> Array:
        """b of one class at gaps over its upper edge (N,)."""
        gap = np.asarray(gap, float)
        out = self.series(np.sqrt(1.0 - np.clip(gap, self.lowest, 1.0)))[:, k]
        out[gap >= 1.0] = 0.0
        return out


def local_gaps(mean_gap: Array, *, widths: Array, kinks: Array, top: float) -> tuple[Array, Array]:
    """Gauss nodes in the local gap for seats of some widths about mean gaps, and their weights.

    Panels end at the kinks and are at most 1.5 of the smallest width; all lengths in one unit.
    """
    width, reach = widths.min(), REACH * widths.max()
    low, high = mean_gap.min() - reach, min(mean_gap.max() + reach, top)
    if high <= low:
        return np.empty(0), np.empty(0)
    inner = kinks[(kinks > low) & (kinks < high)]
    edges = np.concatenate([[low], inner, [high]])
    pieces = np.maximum(np.ceil(np.diff(edges) / (WIDEST * width)), 1).astype(int)
    starts = np.repeat(edges[:-1], pieces)
    steps = np.repeat(np.diff(edges) / pieces, pieces)
    order = np.concatenate([np.arange(n) for n in pieces])
    x, w = gauss_legendre(NODES)
    middle = starts + steps * (order + 0.5)
    return (
        (middle[:, None] + 0.5 * steps[:, None] * x).ravel(),
        (0.5 * steps[:, None] * w).ravel(),
    )


REACH, WIDEST, NODES = 8.5, 1.5, 7
"""Widths of the seat beyond which nothing is counted, of a panel at most, and its nodes."""
