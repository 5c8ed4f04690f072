"""What hard particles leave in the surfaces: how many dents, how deep, how wide."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.evaluation import splits_of
from ..contact.output import AbstractOutput, Column, changes
from ..errors import InvalidValue, Mistake, Note, Problem
from ..laws.base import SERIES
from ..laws.particle.series import Series
from ..laws.particle.squashed import widest_disc
from ..populations.materials import BULK, Material, MaterialPair, softer_hardness
from ..quantities.say import number, percent
from ..quantities.value import choice, quantity
from .curves import Curve
from .quantiles import Values, exceeded_values, number_above
from .regroup import Passage, lay_out_again
from .single.dent import Debris, dent_of, fragments, sink, sunk

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact
    from ..contact.evaluation import Solved
    from ..contact.output import Probe
    from ..laws.base import AbstractParticleLaw
    from ..laws.spots import ParticleSpots
    from ..populations.particles import Particles
    from .single.dent import Dent

    Array = NDArray[np.float64]
    _Bodies = tuple[int, AbstractParticleLaw, MaterialPair, Material]

__all__ = ["Dents"]

ONE = 1.0
"""Dents in A_n on average below which most areas have none."""
P95 = 0.05
RARE = 1e-2
"""Part of the broken particles below which those that are embedded are counted by levels."""
FEW = 14
"""Dents in an area below which its deepest one is a matter of chance: of ln 2/0.05 dents and fewer
the deepest is shallower than what 5 % exceed, in half of all cases."""
KINDS, DEEPEST = (0.25, 0.5, 1.0), 64.0
"""Depths over the size from which on dents are of another kind: embedded, as wide as the particle,
as deep; the largest squeeze at which they are looked for."""
DISCS = (1 / 3, 1 - 1e-3)
"""Squeezes from which on a ductile particle is a disc, and as thin as one becomes."""
MOST_RUNS = 100
"""Times that a dent may turn from growing to shrinking as one particle is squeezed. Laws have few
such turns, a difference of nearly equal numbers has thousands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dents(AbstractOutput):
    r"""Number, depth and width of the dents that the loaded particles leave.

    .. math:: \delta_{res} = \delta\,(1-s^{-0.28})(1-s^{-0.69}), \qquad
              D = 2\sqrt{2r\delta-\delta^2}

    with s = δ/δ_1 over the depth of first yield. Nothing is deeper than the particle is thick.

    Parameters
    ----------
    debris : {"by_hardness", "hard", "ductile", "brittle"}, optional
        By hardness a particle dents a surface as deep as its law says it sinks. Where the law does
        not say, it dents one that is softer than itself, and is flattened by one that is not
        (`thirdbody.effects.single.dent.sink`). Of particles with a strength, what is whole does.
        Hard ones keep their shape whatever their hardness. Ductile ones flatten to
        discs: the widths are their footprints, as `thirdbody.particle.Series` squashes them where
        they are softer than the surface, and otherwise those of discs as high as the gap, up to
        the width at which the disc sinks in (`widest_disc` of the squashed particle); depth and
        volume of these marks are not known, and NaN. Brittle ones larger than ``fragment`` are
        replaced by fragments of the same volume in the same gap.
    fragment : float, optional
        Size of the fragments [m]; needed for brittle particles.
    shallowest : float, optional
        Depth from which a dent counts [m].
    A_n : float, optional
        Nominal area of which the largest dent is asked [m²]: the depth that the deepest dent of
        A_n exceeds in half of all cases with a dent at all,
        :math:`A_n N(>\delta)=\ln[2/(1+e^{-A_n N})]`, :math:`\ln 2` for many; at least the mean,
        and NaN where less than one dent lies in A_n on average. Of fewer than 14 the deepest is
        mostly shallower than the depth that 5 % exceed, and a warning says so.

    Notes
    -----
    These are the dents of one placement of the particles; every fresh set of particles adds its own
    (`thirdbody.effects.single.dent.dents_after`). Numbers are exact to 1e-9, means, volumes,
    percentiles and the largest to 1e-7, of whole particles and of fragments, with ``shallowest``
    too; of dents that fewer than one particle in 1e12 leaves less is known, as seats end at nine
    of their widths. Particles with a strength, and those on one field of heights
    (`thirdbody.asperity.Field`), are counted by classes of sizes and gaps: their percentiles, the
    largest, and all with ``shallowest`` or of fragments are known to some percent.
    Depths are at full load with a gap that does not give way, the recovery fit is one for spheres
    (from memory, see `thirdbody.effects.single.ploughing.residual_depth`). Dents deeper than half
    the radius of the particle are counted besides as embedded: such particles may stay
    (assumption).

    Numbers and widths are of all dents, mean depth, percentile and deepest of those whose depth is
    known; their volume is NaN where some is not. Of several populations the state has the dents of
    each (``populations``).

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
    ...                     diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9))
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     particles=dust,
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     outputs=tb.outputs.Dents(),
    ... )
    >>> found = tb.solve(contact, pressure=5e6).outputs
    >>> f"{found['n_dents_1']:.2g} dents, {found['dent_depth_1'] * 1e9:.0f} nm deep on average"
    '8.8e+09 dents, 17 nm deep on average'
    """

    debris: Debris = choice("what particles do when pressed", default="by_hardness")
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
    tells_few = True
    by_population = True
    follows_sinks = True
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
            Problem(
                "fragment",
                f"with debris = {self.debris!r}: brittle particles, "
                "and only those, need the size of their fragments [m]",
                repr(self.fragment),
                code=Mistake.MISSING,
            )
        ]

    def one_by_one(self, contact: Contact) -> bool:
        return False  # of particles alone

    def problems(self, contact: Contact) -> list[str]:
        if self.debris == "hard":
            return self._contradictions(contact)
        if self.debris != "brittle":
            return []
        if any(population.strength is not None for population in contact.populations):
            return [
                self.problem(
                    ": debris = 'brittle' and the strength of the particles would break them twice",
                    hint="remove one",
                    code=Mistake.CLASH,
                )
            ]
        laws = [contact.law_of(population) for population in contact.populations]
        if all(isinstance(law, Series) and law.breakable for law in laws):
            return []
        return [
            self.problem(": fragments of brittle particles need " + SERIES, code=Mistake.BEYOND)
        ]

    def _contradictions(self, contact: Contact) -> list[str]:
        """Particles that keep their shape here and are squashed by their law."""
        names = [
            population.name or population.material.name or "particles"
            for population in contact.populations
            if any(_is_squashed(contact.law_of(population), contact.surfaces, population.material))
        ]
        return [
            self.problem(
                f": debris = 'hard' says that {name} keep their shape, and their law squashes "
                "them, as they are softer than a surface",
                hint="give the material the hardness that they have, or leave debris out",
                code=Mistake.CLASH,
            )
            for name in names
        ]

    def _broken(self, spots: ParticleSpots, contact: Contact) -> ParticleSpots:
        """Particles larger than the fragments replaced by fragments in the same gaps."""
        population = spots.population
        assert population is not None
        law = contact.law_of(population)
        particle = law.one(surfaces=contact.surfaces, particle=population.material)
        gap = spots.x - spots.depths[0] - spots.depths[1]
        x = np.minimum(spots.x, float(self.fragment or 0.0))
        number = spots.number * fragments(spots.x, size=float(self.fragment or 0.0))
        broken_spots = particle.spots(x, np.maximum(x - gap, 0.0), share=spots.share, number=number)
        return replace(broken_spots, material=population.material, population=population)

    def _dent_left(self, spots: ParticleSpots, side: int, contact: Contact) -> Dent:
        population = spots.population
        assert population is not None
        law = contact.law_of(population)
        return self._dent(spots, side, law, contact.surfaces, population.material)

    def _dent(
        self,
        spots: ParticleSpots,
        side: int,
        law: AbstractParticleLaw,
        surfaces: MaterialPair,
        particle: Material,
    ) -> Dent:
        """What spots of particles of a law leave in a surface."""
        dent = dent_of(
            spots,
            side=side,
            particle=particle,
            debris=self.debris,
            squashed=_is_squashed(law, surfaces, particle)[side],
        )
        widest = _widest(law, surfaces, particle, side)
        if math.isinf(widest):
            return dent
        held = np.where(np.isnan(dent.depth), widest * spots.x, math.inf)
        return dent._replace(diameter=np.minimum(dent.diameter, held))

    def _value_of_one(
        self,
        name: str,
        side: int,
        law: AbstractParticleLaw,
        surfaces: MaterialPair,
        particle: Material,
    ) -> Callable[[Array], Array]:
        """Depth or width of the dents of particles of unit size at squeezes (N,)."""

        def value(eps: Array) -> Array:
            spots = law.probe(eps, surfaces=surfaces, particle=particle)
            with np.errstate(all="ignore"):  # as where all of them are asked
                dent = self._dent(spots, side, law, surfaces, particle)
            if name == "width":
                return dent.diameter[:, 0]
            return np.nan_to_num(dent.depth[:, 0])

        return value

    def _kinks_of_one(
        self, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
    ) -> list[float]:
        """Squeezes at which what one particle leaves jumps or bends."""
        one = law.one(surfaces=surfaces, particle=particle)
        return [*map(float, one.kinks), *splits_of(self, law, surfaces, particle)]

    def _of_one(
        self,
        name: str,
        side: int,
        law: AbstractParticleLaw,
        surfaces: MaterialPair,
        particle: Material,
    ) -> Curve:
        """Depth or width of the dents of one particle over its size, by its squeeze."""
        value = self._value_of_one(name, side, law, surfaces, particle)
        kinks = self._kinks_of_one(law, surfaces, particle)
        curve = Curve(value, kinks)
        if len(curve.runs) > MOST_RUNS:
            bodies = {"surface 1": surfaces.first, "surface 2": surfaces.second, "grain": particle}
            moduli = ", ".join(f"{number(body.E)} Pa ({who})" for who, body in bodies.items())
            raise InvalidValue(
                Problem(
                    "outputs.dents",
                    f": the {name} of dents in surface {side + 1} "
                    f"is lost in rounding, it rises and falls {len(curve.runs)} times as a grain "
                    f"is squeezed; E = {moduli}",
                    hint="one of E and H is too far from the others: check their units",
                    code=Mistake.BEYOND,
                )
            )
        return curve

    def _values(
        self, spots: ParticleSpots, values: Array, name: str, side: int, contact: Contact
    ) -> Values:
        """Values of one group of dents; of whole particles, with those of one particle."""
        population = spots.population
        assert population is not None
        if spots.layout is None:
            return Values(spots, values)
        who = (self._any_depth, name, *_bodies(side, contact, population))
        curve, least = _curve(*who), None
        if self.shallowest > 0 and name != "depth":
            depth = _curve(self._any_depth, "depth", *who[2:])
            if depth.top > 0:
                least = (depth, self.shallowest)
        return Values(spots, values, curve=curve, least=least)

    @property
    def _any_depth(self) -> Dents:
        return self if self.shallowest == 0 else self.replace(shallowest=0.0)

    def _groups(self, state: Solved) -> list[ParticleSpots]:
        """Groups that leave dents: whole particles or fragments, split at the shallowest dent."""
        key = ("groups of dents", self)
        if key not in state.kept:
            state.kept[key] = [
                group for spots in state.particles for group in self._regroup(spots, state.contact)
            ]
        kept: list[ParticleSpots] = state.kept[key]
        return kept

    def _regroup(self, spots: ParticleSpots, contact: Contact) -> list[ParticleSpots]:
        population, layout = spots.population, spots.layout
        assert population is not None
        if layout is None:
            return [self._broken(spots, contact)] if self.debris == "brittle" else [spots]
        breaks = self.fragment is not None and self.fragment < (
            layout.scale * layout.sizes.support[1]
        )
        if not breaks and self.shallowest == 0:
            return [spots]
        passages = []
        if self.shallowest > 0:
            sides = {_bodies(side, contact, population) for side in (0, 1)}
            passages = [_passage(self._any_depth, *who) for who in sorted(sides, key=_side_of)]
        law, particle = contact.law_of(population), population.material
        return lay_out_again(
            spots,
            law.one(surfaces=contact.surfaces, particle=particle),
            splits_of(self._any_depth, law, contact.surfaces, particle),
            fragment=self.fragment,
            passages=passages,
            depth=self.shallowest,
        )

    def _sunk(self, spots: ParticleSpots, side: int) -> Array:
        population = spots.population
        assert population is not None
        return sunk(spots, side=side, particle=population.material, debris=self.debris)

    def of(self, state: Solved) -> dict[str, Array]:
        groups, surfaces = self._groups(state), state.contact.surfaces
        one, two = ((body.E, body.nu, body.H) for body in (surfaces.first, surfaces.second))
        first = self._side(state, groups, 0)
        if one == two and all(spots.has_alike_sides for spots in groups):
            return first | {f"{name[:-1]}2": values for name, values in first.items()}
        return first | self._side(state, groups, 1)

    def _side(self, state: Solved, groups: Sequence[ParticleSpots], side: int) -> dict[str, Array]:
        names = ("n", "known", "unknown", "depth", "width", "volume", "embedded")
        sums: dict[str, Array] = dict.fromkeys(names, np.zeros_like(state.d))
        dents: list[tuple[Values, Values]] = []
        for spots in groups:
            dent = self._dent_left(spots, side, state.contact)
            deep = self._sunk(spots, side)
            finite = np.isfinite(dent.depth)
            depth, volume = np.where(finite, dent.depth, 0.0), np.where(finite, dent.volume, 0.0)
            there = dent.diameter > 0
            with_depth: Any = there & finite & (depth >= self.shallowest)
            counts: Any = with_depth | (there & ~finite)
            width = np.where(counts, dent.diameter, 0.0)
            for name, q in (
                ("n", counts.astype(float)),
                ("known", with_depth.astype(float)),
                ("unknown", (there & ~finite).astype(float)),
                ("depth", with_depth * depth),
                ("width", width),
                ("volume", with_depth * volume),
            ):
                sums[name] = sums[name] + spots.total(q)
            sums["embedded"] = sums["embedded"] + _count_embedded(spots, with_depth, deep)
            who = (side, state.contact)
            dents.append(
                (
                    self._values(spots, depth, "depth", *who),
                    self._values(spots, width, "width", *who),
                )
            )
        if self.shallowest > 0 and any(spots.layout is None for spots in groups):
            # no class ends where dents are so deep
            depths = [values for values, _ in dents]
            sums["deep"] = number_above(depths, self.shallowest, states=len(state.d))
        return self._columns(sums, dents, side)

    def _columns(
        self, sums: dict[str, Array], dents: Sequence[tuple[Values, Values]], side: int
    ) -> dict[str, Array]:
        """The columns of a surface, from sums over its dents, and depths and widths that count."""
        n, with_depth, unknown = (sums[name] for name in ("n", "known", "unknown"))
        depths, widths = ([pair[i] for pair in dents] for i in (0, 1))
        deep = sums.get("deep", with_depth)
        if self.shallowest > 0:  # whether marks of unknown depth are so deep is not known either
            n = np.where(unknown > 0, np.nan, deep)
        out = {f"n_dents_{side + 1}": n}
        of_all = (("depth", deep, sums["known"], depths), ("width", n, sums["n"], widths))
        for name, count, classes, values in of_all:
            few = np.nan_to_num(count)
            largest = np.log(2 / (1 + np.exp(-few * self.A_n))) / self.A_n
            p95, most = exceeded_values(values, [P95 * few, largest])
            with np.errstate(invalid="ignore", divide="ignore"):
                mean = sums[name] / np.where((count > 0) & (classes > 0), classes, np.nan)
                most = np.where(count * self.A_n >= ONE, np.fmax(most, mean), np.nan)
            p95 = np.where(count > 0, p95, np.nan)
            values_of = zip(("", "_p95", "_max"), (mean, p95, most), strict=True)
            out |= {f"dent_{name}{end}_{side + 1}": value for end, value in values_of}
        return out | {
            f"dent_volume_{side + 1}": np.where(unknown > 0, np.nan, sums["volume"]),
            f"embedded_{side + 1}": np.where(
                (unknown > 0) & (with_depth == 0), np.nan, sums["embedded"]
            ),
        }

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        return [
            *self._about_few(values),
            *self._about_unknown(state, values),
            *self._about_wide(state),
        ]

    def _about_wide(self, state: Solved) -> list[str]:
        """Flattened particles whose marks are held to the widest disc that a surface bears."""
        out: list[str] = []
        for population in state.contact.populations:
            mine = [spots for spots in self._groups(state) if spots.population is population]
            shares = [self._share_held(mine, side, state.contact) for side in (0, 1)]
            share, side = max((share, side) for side, share in enumerate(shares))
            if share > 0:
                law, pair = state.contact.law_of(population), state.contact.surfaces
                widest = _widest(law, pair, population.material, side)
                what = (
                    f"outputs.dents: {percent(share, digits=2)} of the marks of "
                    f"{population.name or population.material.name or 'particles'} are of discs "
                    "that would press harder than the surface is: such a disc sinks in, and its "
                    f"mark is held to {number(widest, 3)} times the particle's size"
                )
                out.append(Note(what, code=f"{self.name}.wide", effect=share))
        return out

    def _share_held(self, groups: Sequence[ParticleSpots], side: int, contact: Contact) -> float:
        """The largest share of flattened particles in any state whose width is the widest."""
        marks: float | Array = 0.0
        held: float | Array = 0.0
        for spots in groups:
            population = spots.population
            assert population is not None
            law, material = contact.law_of(population), population.material
            widest = _widest(law, contact.surfaces, material, side)
            dent = self._dent_left(spots, side, contact)
            flat = np.isnan(dent.depth) & (dent.diameter > 0)
            marks = marks + spots.total(flat.astype(float))
            wide = flat & (dent.diameter >= widest * spots.x)
            held = held + spots.total(wide.astype(float))
        return float(np.max(held / np.where(marks > 0, marks, 1.0), initial=0.0))

    def _about_few(self, values: Mapping[str, Array]) -> list[str]:
        """Where few dents, or less than one, lie in A_n."""
        counts = np.concatenate([values[f"n_dents_{side}"] for side in (1, 2)]) * self.A_n
        if not np.any(few := (counts > 0) & (counts < FEW)):
            return []
        least = counts[few].min()
        what = (
            f"outputs.dents: {number(least)} dents lie in A_n = {number(self.A_n)} m² on average: "
        )
        if least < ONE:
            what += (
                f"one such area in {number(-1 / math.expm1(-least))} has any, and the deepest and "
                "the widest are NaN"
            )
        else:
            what += (
                "the deepest and the widest of so few scatter from one place to the next, and are "
                "mostly less than what 5 % of the dents exceed"
            )
        effect = math.inf if least < ONE else 0.5  # of so few, of the deepest alone
        code = f"{self.name}.few"
        return [Note(what, code=code, effect=effect, action="a larger A_n has more")]

    def _about_unknown(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        """Notes on flattened particles, whose dents have no known depth."""
        out: list[str] = []
        pair = (state.contact.surfaces.first, state.contact.surfaces.second)
        for population in state.contact.populations:
            material = population.material
            of_population = (
                spots.knows_sink for spots in state.particles if spots.population == population
            )
            knows_sink = next(of_population, (False, False))
            flat = [
                math.isnan(
                    sink(
                        material,
                        hardness=softer_hardness(material, body),
                        debris=self.debris,
                        computed=computed,
                    )
                )
                for body, computed in zip(pair, knows_sink, strict=True)
            ]
            sides = [k for k in (1, 2) if flat[k - 1] and np.any(values[f"n_dents_{k}"] != 0)]
            if not sides:
                continue
            where = "either surface" if len(sides) == 2 else f"surface {sides[0]}"
            behaviour = f"are not harder than {where} and are flattened there"
            if self.debris == "ductile":
                behaviour = "flatten, as debris = 'ductile' says"
            name = population.name or population.material.name or "particles"
            what = (
                f"outputs.dents: {name} {behaviour}: "
                "their marks are counted, with the widths "
                "of their footprints; depth and volume are not known (NaN)"
            )
            out.append(Note(what, code=f"{self.name}.flat.{name}", effect=math.inf))
        return out

    def splits(self, probe: Probe) -> Sequence[float]:
        """Squeezes where a dent begins, its cap ends, it is half the radius or the size deep."""
        from scipy.optimize import brentq

        def depth_beyond(log_eps: float, side: int, share: float) -> float:
            spots = probe(np.exp([log_eps]))
            deep = (spots.depths if self.debris == "hard" else spots.sinks)[side][0, 0]
            return float(deep - share * spots.x[0, 0])

        low, high = math.log(1e-9), math.log(DEEPEST)
        squeezes = [
            math.exp(brentq(depth_beyond, low, high, args=(side, share), xtol=1e-15))
            for side in (0, 1)
            for share in KINDS
            if depth_beyond(high, side, share) > 0
        ]
        return [*squeezes, *changes(probe, self._kinds)]

    def splits_of_law(
        self, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
    ) -> Sequence[float]:
        """Squeezes where a flattened particle becomes a disc, one as wide, as thin as they come."""
        out = [*DISCS]
        for side in (0, 1):
            widest = _widest(law, surfaces, particle, side)
            if math.isfinite(widest):
                out.append(1 - 2 / (3 * widest**2))
        return out

    def _kinds(self, spots: ParticleSpots) -> NDArray[np.intp]:
        """Which surfaces have dents, and of what form: a number."""
        assert spots.material is not None
        kinds = np.zeros(spots.x.shape, dtype=np.intp)
        for side in (0, 1):
            dent = dent_of(spots, side=side, particle=spots.material, debris=self.debris)
            shaft = 2 * dent.depth > dent.diameter  # below its cap
            kinds = 4 * kinds + 2 * (dent.diameter > 0) + shaft
        return kinds


def _bodies(side: int, contact: Contact, population: Particles) -> _Bodies:
    """Side, law and materials by which dents differ; of alike surfaces the first side."""
    pair = MaterialPair(_solid(contact.surfaces.first), _solid(contact.surfaces.second))
    same = 0 if pair.first == pair.second else side
    return same, contact.law_of(population), pair, _solid(population.material)


def _side_of(bodies: _Bodies) -> int:
    return bodies[0]


def _count_embedded(spots: ParticleSpots, counts: NDArray[np.bool_], deep: Array) -> Array:
    """Number of dents that count and are deeper than half the radius of their particle (N,)."""
    number = spots.total((counts & (2 * deep > spots.half)).astype(float))
    rare = number < RARE * spots.total(counts.astype(float))
    if spots.layout is not None or not np.any(rare):
        return number
    share = np.divide(2 * deep, spots.half, out=np.zeros_like(deep), where=counts)
    return np.where(rare, number_above([Values(spots, share)], 1.0, states=len(number)), number)


def _solid(material: Material) -> Material:
    """A material by what its contact depends on: bodies that differ in heat alone dent alike."""
    return material.replace(**dict.fromkeys(sorted(BULK)))


@lru_cache(maxsize=256)
def _curve(
    dents: Dents,
    name: str,
    side: int,
    law: AbstractParticleLaw,
    surfaces: MaterialPair,
    particle: Material,
) -> Curve:
    return dents._of_one(name, side, law, surfaces, particle)


@lru_cache(maxsize=256)
def _passage(
    dents: Dents, side: int, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> Passage:
    depth = dents._value_of_one("depth", side, law, surfaces, particle)
    return Passage(depth, dents._kinks_of_one(law, surfaces, particle))


def _is_squashed(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[bool, ...]:
    """Whether the law of a particle squashes it against each surface."""
    if not isinstance(law, Series):
        return (False, False)
    forms = law.forms(surfaces, particle)
    return tuple(
        form is not None and (not law.follows_table or particle.H <= body.H)
        for form, body in zip(forms, (surfaces.first, surfaces.second), strict=True)
    )


def _widest(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material, side: int
) -> float:
    """Largest mark of a flattened particle over its size; infinite where the law bounds it."""
    if _is_squashed(law, surfaces, particle)[side]:
        return math.inf
    friction = (law if isinstance(law, Series) else Series()).friction_factor
    H = (surfaces.first, surfaces.second)[side].H
    # one that is flattened is not harder, whatever its material says
    return widest_disc(min(particle.H, H), H, friction_factor=friction)
