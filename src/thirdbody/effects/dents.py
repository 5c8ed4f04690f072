"""What hard particles leave in the surfaces: how many dents, how deep, how wide."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..contact.output import AbstractOutput, Column
from ..laws.particle.series import Series
from ..quantities.say import number
from ..quantities.value import choice, quantity
from .single.dent import Dent, dent_of, flattened_diameter, fragments

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = ["Dents"]

LEVELS = 240
"""Depths and widths at which dents are counted, evenly over their logarithm."""
FEW = 10
"""Dents in an area below which its deepest one is a matter of chance."""
LOWEST = 1e-4
"""The smallest of them over the largest dent."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dents(AbstractOutput):
    r"""Number, depth and width of the dents that the loaded particles leave.

    .. math:: \delta_{res} = \delta\,(1-s^{-0.28})(1-s^{-0.69}), \qquad
              D = 2\sqrt{2r\delta-\delta^2}

    with s = δ/δ_1 over the depth of first yield. A particle dents a surface that is softer than
    itself; a softer particle is deformed instead. Nothing is deeper than the particle is thick.

    Parameters
    ----------
    debris : {"hard", "ductile", "brittle"}, optional
        Hard particles keep their shape. Ductile ones flatten to discs: the widths are their
        footprints, as `thirdbody.particle.Series` squashes them where they are softer than the
        surface, and otherwise those of discs as high as the gap; depths are 0. Brittle
        ones larger than ``fragment`` are replaced by fragments of the same volume in the same gap.
    fragment : float, optional
        Size of the fragments [m]; needed for brittle particles.
    shallowest : float, optional
        Depth from which a dent counts [m].
    A_n : float, optional
        Nominal area of which the largest dent is asked [m²]: the depth that the deepest dent of
        A_n exceeds in half of all cases with a dent at all,
        :math:`A_n N(>\delta)=\ln[2/(1+e^{-A_n N})]`, :math:`\ln 2` for many; where few lie in
        A_n, at least the mean, and a warning tells of fewer than ten.

    Notes
    -----
    These are the dents of one placement of the particles; every fresh set of particles adds its
    own (`thirdbody.effects.single.dent.dents_after`). Percentiles and the largest are read from
    counts
    at 240 levels; against explicit random particles, within 2 %. Depths are at full load with a
    gap that does not give way, the recovery fit is one for spheres (from memory, see
    `thirdbody.effects.single.ploughing.residual_depth`). Dents deeper than half the radius of the
    particle are counted besides as embedded: such particles may stay (assumption).

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
    ...                     diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9))
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=dust,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6), outputs=Dents())
    >>> found = tb.solve(contact, pressure=5e6).outputs
    >>> f"{found['n_dents_1']:.2g} dents, {found['dent_depth_1'] * 1e9:.0f} nm deep on average"
    '7.7e+09 dents, 50 nm deep on average'
    """

    debris: str = choice(
        "what particles do when pressed", "hard", "ductile", "brittle", default="hard"
    )
    fragment: float | None = quantity("x_f", "m", "size of fragments", default=None, gt=0)
    shallowest: float = quantity("δ_0", "m", "depth from which a dent counts", default=0.0, ge=0)
    A_n: float = quantity(
        "A_n", "m^2", "area of which the largest dent is", default=1e-6, gt=0, hint="1 mm² is 1e-6"
    )

    name = "dents"
    title = "Dents"
    year = 2026
    citation = "thirdbody: dents that the particles of a solved state leave"
    provenance = "derived"
    valid_range = "particles harder than the surface; depths up to their radius"
    columns = {
        f"{name}_{side}": Column(f"{symbol},{side}", unit, f"{meaning} in surface {side}")
        for side in (1, 2)
        for name, symbol, unit, meaning in (
            ("n_dents", "n_d", "1/m^2", "dents"),
            ("dent_depth", "⟨δ_res⟩", "m", "mean depth of the dents"),
            ("dent_depth_p95", "δ_95", "m", "depth that 5 % of the dents exceed"),
            ("dent_depth_max", "δ_max", "m", "depth of the deepest dent of A_n (median)"),
            ("dent_width", "⟨D⟩", "m", "mean diameter of the dents"),
            ("dent_width_p95", "D_95", "m", "diameter that 5 % of the dents exceed"),
            ("dent_width_max", "D_max", "m", "diameter of the widest dent of A_n (median)"),
            ("dent_volume", "V_d", "m", "volume of the dents per area"),
            ("embedded", "n_e", "1/m^2", "particles deeper than half their radius"),
        )
    }

    def _problems(self) -> list[str]:
        if (self.debris == "brittle") == (self.fragment is not None):
            return []
        return [
            f"Dents.fragment = {self.fragment!r} with debris = {self.debris!r}: brittle particles, "
            "and only those, need the size of their fragments [m]"
        ]

    def problems(self, contact: Contact) -> list[str]:
        if self.debris != "brittle":
            return []
        if any(each.strength is not None for each in contact.populations):
            return [
                "outputs.dents: debris = 'brittle' and the strength of the particles would break "
                "them twice; remove one"
            ]
        laws = [contact.law_of(each) for each in contact.populations]
        if all(isinstance(law, Series) and law.breakable for law in laws):
            return []
        return ["outputs.dents: fragments of brittle particles need particle.Series"]

    def _broken(self, spots: ParticleSpots, contact: Contact) -> ParticleSpots:
        """Particles larger than the fragments replaced by fragments in the same gaps."""
        population = spots.population
        assert population is not None
        law = contact.law_of(population)
        particle = law.one(surfaces=contact.surfaces, particle=population.material)
        gap = spots.x - spots.depths[0] - spots.depths[1]
        x = np.minimum(spots.x, float(self.fragment or 0.0))
        number = spots.number * fragments(spots.x, size=float(self.fragment or 0.0))
        found = particle.spots(x, np.maximum(x - gap, 0.0), share=spots.share, number=number)
        return replace(found, material=population.material, population=population)

    def _left(self, spots: ParticleSpots, side: int, contact: Contact) -> Dent:
        population = spots.population
        assert population is not None
        if self.debris != "ductile":
            return dent_of(spots, side=side, particle=population.material)
        law = contact.law_of(population)
        if isinstance(law, Series) and law.forms(contact.surfaces, population.material)[side]:
            wide = 2 * np.sqrt(spots.areas[side] / math.pi)
        else:
            gap = np.maximum(spots.x - spots.depths[0] - spots.depths[1], 1e-3 * spots.x)
            wide = (spots.load > 0) * flattened_diameter(spots.x, gap=gap)
        return Dent(np.zeros_like(wide), wide, np.zeros_like(wide))

    def of(self, state: Solved) -> dict[str, Array]:
        groups = list(state.particles)
        if self.debris == "brittle":
            groups = [self._broken(spots, state.contact) for spots in groups]
        out: dict[str, Array] = {}
        for side in (0, 1):
            out |= self._side(state, groups, side)
        return out

    def _side(self, state: Solved, groups: Sequence[ParticleSpots], side: int) -> dict[str, Array]:
        nothing = np.zeros_like(state.d)
        sums = dict.fromkeys(("n", "depth", "width", "volume", "embedded"), nothing)
        dents = []
        for spots in groups:
            dent = self._left(spots, side, state.contact)
            counts = (dent.diameter > 0) & (dent.depth >= self.shallowest)
            dents.append((spots, dent, counts))
            deep = counts & (2 * spots.depths[side] > spots.half) & (self.debris != "ductile")
            for name, q in (
                ("n", counts.astype(float)),
                ("depth", counts * dent.depth),
                ("width", counts * dent.diameter),
                ("volume", counts * dent.volume),
                ("embedded", deep.astype(float)),
            ):
                sums[name] = sums[name] + spots.total(q)
        n = sums["n"]
        quantiles = {}
        for kind in ("depth", "diameter"):
            values = [
                (spots, getattr(dent, kind), counts.astype(float)) for spots, dent, counts in dents
            ]
            largest = np.log(2 / (1 + np.exp(-n * self.A_n))) / self.A_n
            quantiles[kind] = _exceeded(values, [0.05 * n, largest])
        with np.errstate(invalid="ignore", divide="ignore"):
            for kind, name in (("depth", "depth"), ("diameter", "width")):
                at_least = np.where(n > 0, sums[name] / n, 0.0)
                quantiles[kind][1] = np.maximum(quantiles[kind][1], at_least)
            return {
                f"n_dents_{side + 1}": n,
                f"dent_depth_{side + 1}": sums["depth"] / n,
                f"dent_depth_p95_{side + 1}": quantiles["depth"][0],
                f"dent_depth_max_{side + 1}": quantiles["depth"][1],
                f"dent_width_{side + 1}": sums["width"] / n,
                f"dent_width_p95_{side + 1}": quantiles["diameter"][0],
                f"dent_width_max_{side + 1}": quantiles["diameter"][1],
                f"dent_volume_{side + 1}": sums["volume"],
                f"embedded_{side + 1}": sums["embedded"],
            }

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        found = np.concatenate([values[f"n_dents_{side}"] for side in (1, 2)]) * self.A_n
        if not np.any((found > 0) & (found < FEW)):
            return []
        return [
            f"outputs.dents: fewer than {FEW} dents lie in A_n = {number(self.A_n)} m² on average: "
            "the deepest and the widest of so few scatter from one place to the next; a larger "
            "A_n has more"
        ]

    def splits(self, probe: Probe) -> Sequence[float]:
        """Squeezes at which a side reaches half the radius."""
        from scipy.optimize import brentq

        def half(eps: float, side: int) -> float:
            spots = probe(np.array([eps]))
            return float((2 * spots.depths[side] - spots.half)[0, 0])

        return [
            float(brentq(half, 1e-9, 3.0, args=(side,), xtol=1e-15))
            for side in (0, 1)
            if half(3.0, side) > 0
        ]


def _exceeded(
    groups: Sequence[tuple[ParticleSpots, Array, Array]], counts: Sequence[Array]
) -> list[Array]:
    """The value that so many (N,) spots per area exceed; 0 where fewer have any value."""
    top = max((float(np.max(values, initial=0.0)) for _, values, _ in groups), default=0.0)
    if top == 0:
        return [np.zeros_like(count) for count in counts]
    levels = top * np.geomspace(LOWEST, 1.0, LEVELS)
    above = np.zeros((len(counts[0]), LEVELS))
    for spots, values, weight in groups:
        above = above + spots.above(values, levels, weight)
    out = []
    for count in counts:
        # the first level that no more exceed, and how far the one before is from it
        at = np.argmax(above <= count[:, None], axis=1)
        before = np.maximum(at - 1, 0)
        row = np.arange(len(count))
        more, less = above[row, before], above[row, at]
        step = np.divide(more - count, more - less, out=np.ones_like(count), where=more > less)
        value = levels[before] * (levels[at] / levels[before]) ** step
        out.append(np.where(at > 0, value, 0.0))
    return out
