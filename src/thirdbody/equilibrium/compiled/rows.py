"""From a contact to the records of the compiled engine: the one place where that happens."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact.asperity_sums import (
    SEARCHED,
    AsperitySum,
    GaussianSum,
    GaussianSums,
    gaussian_sums,
    scales,
)
from ...contact.contact import Contact
from ...contact.field_ground import LiftedSum
from ...contact.field_sums import FieldSum
from ...contact.interface import Interface
from ...contact.particle_averages import SeatAverage, SizeAverage, size_average
from ...contact.particle_sums import SeatedParticles
from ...errors import NotCompiled
from ...laws.asperity import Field
from ...laws.base import COLUMNS, AbstractAsperityLaw
from ...laws.particle.series import Series as ParticleSeries
from ...populations.distributions import Monodisperse
from ...populations.heights import GaussianHeights
from ...populations.particles import Particles
from ...populations.shape import Angular
from . import layout
from .field_series import asperity_numbers, asperity_series, beside_gaussian
from .inputs import MATERIALS, NOT_MONOTONE, SHAPES, bare, common_law, own_sizes, size_factor
from .layout import INTERFACE, NONE, PART, RULE
from .size_rules import (
    FEW_SIZES,
    MOST_WIDTHS,
    NEAR,
    densest,
    few_on_seats,
    near_rule,
    seat_rule,
    size_rules,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]
    Records = NDArray[np.void]
    Fields = dict[str, ArrayLike]

__all__ = ["InterfaceRows", "StateRows"]


def pulls(law: AbstractAsperityLaw) -> bool:
    """Whether the load may be tension, which the compiled balance does not know."""
    return law.start < 0 or law.onset < 0


class Rows:
    """Interfaces and the parts of their particles as records, and the series that they point to."""

    def __init__(self, count: int, parts: int):
        self.interfaces = np.zeros(count, INTERFACE)
        self.interfaces["inverse"] = self.interfaces["shadow"] = NONE
        self.parts = np.zeros((count, parts), PART)
        self.parts["kind"] = layout.ABSENT
        self._panels, self._rules = layout.Panels(), layout.Rules()

    def _finish(self) -> None:
        self.panels, self.inverses = self._panels.all_panels()
        self.edges = self.panels["edge"].copy()
        self.rules, self.of_single_states = self._rules.all_rules(), self._rules.of_single_states

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """What the kernels read."""
        return self.interfaces, self.parts, self.panels, self.edges, self.inverses, self.rules


class InterfaceRows(Rows):
    """Interfaces by their tables.

    Raises
    ------
    NotCompiled
        An interface that the kernel does not know.
    """

    def __init__(self, interfaces: Sequence[Interface]):
        particles = [one.particles for one in interfaces]
        if not all(p is None or isinstance(p, SeatedParticles) for p in particles):
            raise NotCompiled("particles that are not Series")
        most = max(len(p.parts) if isinstance(p, SeatedParticles) else 0 for p in particles)
        super().__init__(len(interfaces), most)
        for m, contact_interface in enumerate(interfaces):
            self._add_asperities(self.interfaces[m], contact_interface.asperities)
            if isinstance(contact_interface.particles, SeatedParticles):
                self._add_particles(self.interfaces[m], self.parts[m], contact_interface.particles)
        self._finish()

    def _add_asperities(self, row: np.void, asperities: object) -> None:
        if isinstance(asperities, LiftedSum):
            raise NotCompiled("the ground of particles is solved at separations that are asked")
        if isinstance(asperities, FieldSum):
            series = asperity_series(asperities)
            row["kind"] = layout.GAUSSIAN
            row["panels"] = self._panels.add(series, series, beside_gaussian(series), 4)
            for name, value in asperity_numbers(asperities).items():
                row[name] = value
            return
        if not isinstance(asperities, AsperitySum) or pulls(asperities.reduced.law):
            raise NotCompiled("asperities of several shapes, or that attract")
        reduced = asperities.reduced
        table = reduced.table  # type: ignore[attr-defined]
        if isinstance(reduced, GaussianSum):
            row["kind"], load = layout.GAUSSIAN, table.coefficients[:, :, [0, 4, 5]]
        else:
            row["kind"], load = layout.DENSITY, table.with_derivatives[:, :, 0, :]
        row["panels"] = self._panels.add(reduced, table, load, 4)
        row["sigma_s"], row["centre"] = asperities.sigma_s, asperities.centre
        row["force"], row["area"] = asperities.units[:2]
        row["highest"], row["lowest"] = asperities.highest, SEARCHED

    def _add_particles(self, row: np.void, parts: Records, particles: SeatedParticles) -> None:
        shadow = row["shadow"] = _column(particles.shadow)
        row["coverage"] = particles.coverage if particles.shadow == "covered" else 0.0
        for component, source in zip(parts, particles.parts, strict=False):
            component["inverse"] = NONE
            component["size"], component["factor"] = source.scale, source.factor
            component["offset"] = source.offset
            average = plane = source.average
            if isinstance(average, SeatAverage):
                plane = average.average
                component["kind"], component["width"] = layout.ROUGH, average.width
                component["upper"] = self._panels.add_average(average.table, shadow)
                component["least"], component["reach"] = average.table.edges[0], average.high
            elif source.breaks:
                raise NotCompiled("particles that break, on a plane seat")
            else:
                component["kind"], component["join"] = layout.PLANE, average.join
                component["upper"] = self._panels.add_average(average.upper, shadow)
                if average.lower is not None:
                    component["lower"] = self._panels.add_average(average.lower, shadow)
                component["least"], component["reach"] = average.bottom, average.top
                component["top"], component["powers"] = average.top, average.powers
            component["floor"] = plane.floor


def _column(shadow: str) -> int:
    """The column of the particles that is the shadow, if one is."""
    return COLUMNS.index(shadow) if shadow in COLUMNS else NONE


class StateRows(Rows):
    """States with inputs of their own, by series and nodes that many of them share.

    Raises
    ------
    NotCompiled
        Inputs or models for which nodes are not shared.
    """

    def __init__(self, contact: Contact, arrays: Mapping[str, Array], count: int):
        if any(name.startswith("asperity_law.") for name in arrays):
            raise NotCompiled("the asperity law varies")
        self.varied = contact.with_arrays(arrays)
        particles = None if bare(contact, arrays) else contact.particles
        if isinstance(particles, tuple) or (particles is not None and particles.law is not None):
            raise NotCompiled("several populations")
        if particles is not None and particles.strength is not None:
            raise NotCompiled("particles that break")
        super().__init__(count, 0 if particles is None else len(particles.diameter.components))
        datum = 0.0 if particles is None else contact.particle_law.centre
        self.covered: Array | None = None
        """Projected particle area per nominal area (N,)."""
        self.most = np.zeros(count)
        """Most of the nominal area that particles can shadow; more than all of it if squashed."""
        self.steepest = np.zeros(count)
        """Most that it changes with d on a plane seat [1/m]."""
        units = self._find_law(contact)
        if particles is not None:  # before anything is laid out
            self._need_shared(contact, arrays)
        asperities = self._add_asperities(units, datum)
        shared = {} if particles is None else self._add_particles(contact, arrays)
        _fill(self.interfaces, asperities | shared)
        self._finish()

    def _find_law(self, contact: Contact) -> Array:
        """Find the law that all asperities follow and its w; units of its loads and areas."""
        rough, surfaces = self.varied.roughness, self.varied.surfaces
        if isinstance(contact.asperity_law, Field):
            raise NotCompiled("surfaces of the law field share no nodes")
        law = common_law(contact.asperity_law, rough, surfaces)
        if not isinstance(rough.heights, GaussianHeights) or rough.ellipticity or pulls(law):
            raise NotCompiled(
                "asperities of several shapes or heights that are not Gaussian, or that attract"
            )
        w, units = scales(law, rough, surfaces)
        self.law, self.w = law, np.broadcast_to(w, len(self.interfaces))
        return units

    def _add_asperities(self, units: Array, datum: float) -> Fields:
        """Lay out the panels, and say what that is in the fields of an `INTERFACE`."""
        rough, law = self.varied.roughness, self.law
        step, across = GaussianSums.place(self.w)

        def family(step: int) -> tuple[tuple[int, int], int]:
            sums = gaussian_sums(law, step)
            return self._panels.add_family(sums), self._panels.add_inverse(sums)

        sums = _records_of(step, family, layout.SUM)
        return {
            **{"kind": layout.FAMILY, "shadow": NONE, "coverage": 0.0},
            **{"panels": sums["panels"], "inverse": sums["inverse"], "across": across},
            **{"sigma_s": rough.sigma_s, "centre": datum * rough.sigma},
            **{"force": units[..., 0], "area": units[..., 1], "highest": GaussianSum.highest},
            "lowest": SEARCHED,
        }

    def _need_shared(self, contact: Contact, arrays: Mapping[str, Array]) -> None:
        """Refuse particles that are not one body in all states."""
        law, particles = self.varied.particle_law, contact.particles
        if not (isinstance(law, ParticleSeries) and isinstance(particles, Particles)):
            raise NotCompiled("particles that are not Series")
        if any(name.startswith("particle_law.law") for name in arrays):
            raise NotCompiled("the law of the particles varies")
        if any(name.startswith(SHAPES) for name in arrays):
            raise NotCompiled("the shape of the particles varies")
        if "particle_law.friction_factor" in arrays:
            raise NotCompiled("the friction of squashed particles varies")
        if "particle_law.aspect" in arrays:
            raise NotCompiled("the aspect of flakes varies")
        if any(name.startswith(MATERIALS) for name in arrays):
            raise NotCompiled("the materials of the particles vary")

    def _add_particles(self, contact: Contact, arrays: Mapping[str, Array]) -> Fields:
        """Fill the parts, and say what they add to the fields of an `INTERFACE`."""
        law, particles = self.varied.particle_law, contact.particles
        assert isinstance(law, ParticleSeries)
        assert isinstance(particles, Particles)
        by_sizes = law.seat == "rough" and own_sizes(contact, arrays)
        parts = self._part_by_sizes if by_sizes else self._averaged_parts
        coverage = np.zeros(len(self.parts))
        for p, (covers, fields) in enumerate(parts(contact, arrays)):
            coverage += covers
            fields["offset"] = law.seat_offset(self.varied.roughness)
            _fill(self.parts[:, p], fields)
        if np.any(coverage >= 1):
            raise NotCompiled("some particles are jammed")  # said better, one contact at a time
        one = contact.law_of(particles).one(surfaces=contact.surfaces, particle=particles.material)
        self.covered = one.breadth * coverage
        self.most = np.maximum(self.most, self.covered)
        shared: Fields = {"shadow": _column(law.shadow)}
        return shared | ({"coverage": self.covered} if law.shadow == "covered" else {})

    def _averaged_parts(
        self, contact: Contact, arrays: Mapping[str, Array]
    ) -> Iterator[tuple[Array | float, Fields]]:
        """Parts of one material and shape, by size averages that all states share.

        What each covers of the nominal area, and fields of a `PART`.
        """
        law: Any = self.varied.particle_law
        particles, changed = contact.particles, self.varied.particles
        assert isinstance(particles, Particles)
        assert isinstance(changed, Particles)
        one = contact.law_of(particles).one(surfaces=contact.surfaces, particle=particles.material)
        rough, shadow = law.seat == "rough", _column(law.shadow)
        # squashed, their area may grow faster than their load
        spreads = bool(getattr(one, "spreads", False))
        grows = spreads or (law.shadow == "footprint" and isinstance(particles.shape, Angular))
        if grows and not rough and law.shadow not in ("none", "covered"):
            raise NotCompiled(NOT_MONOTONE)  # of no state it is sure that it does not
        ratio = size_factor(particles.diameter, arrays)
        if ratio is None:
            raise NotCompiled("the shape of the size distribution varies")
        for share, sizes in particles.diameter.components:
            scale, shape = sizes.standardised()
            average = size_average(one, shape)
            size = scale * ratio
            factor = changed.areal_density * share * size**2
            width = law.zeta_std * self.varied.roughness.sigma / size if rough else 0.0 * size
            if not rough:
                self.steepest += 0.25 * math.pi * one.breadth * factor / size * densest(shape)
            if spreads:
                self.most = self.most + factor * average.floor[-2:].max()
            fields: Fields = {
                **{"inverse": self._panels.add_inverse(average), "size": size},
                **{"factor": factor, "width": width},
                **{"reach": average.top + layout.SEAT_REACH * width},
                **{"top": average.top, "floor": average.floor},
            }
            if rough:
                octave = np.broadcast_to(np.frexp(width)[1] - 1, len(self.parts))
                one_size = self._rules.add("one", np.ones((2, 1)))
                fields |= {
                    **{"kind": layout.ROUGH_NODES, "bottom": average.bottom},
                    **self._over_gaps(octave, average),
                    **{"sizes": one_size, "few_sizes": one_size},
                }
            else:
                fields |= {
                    **{"kind": layout.PLANE, "least": average.bottom, "join": average.join},
                    **{"upper": self._panels.add_average(average.upper, shadow)},
                    **{"powers": average.powers},
                }
                if average.lower is not None:
                    fields["lower"] = self._panels.add_average(average.lower, shadow)
            yield math.pi / 4 * factor * shape.moment(2), fields

    def _over_gaps(self, octave: Index, average: SizeAverage) -> Fields:
        """Rules over gaps for seats whose widths lie in these octaves (N,), as fields of a `PART`.

        The fewer nodes are as good near a seat, or come close to a root.
        """

        def place(rule: Callable[[SizeAverage, int], Any], octave: int) -> tuple[int, int]:
            return self._rules.add((rule, average, octave), rule(average, octave))

        def place_few(octave: int) -> tuple[int, int]:
            near = near_rule(average, octave)
            return place(few_on_seats if near is None else near_rule, octave)

        def reach(octave: int) -> float:
            return -1.0 if near_rule(average, octave) is None else NEAR

        return {
            "gaps": _records_of(octave, partial(place, seat_rule), RULE),
            "few_gaps": _records_of(octave, place_few, RULE),
            "near": _records_of(octave, reach, np.dtype(float)),
        }

    def _part_by_sizes(
        self, contact: Contact, arrays: Mapping[str, Array]
    ) -> Iterator[tuple[Array | float, Fields]]:
        """One part whose shape of sizes varies, on a rough seat: nodes over sizes for each state.

        What it covers of the nominal area, and fields of a `PART`.
        """
        varied, count = self.varied, len(self.parts)
        law: Any = varied.particle_law
        particles, changed = contact.particles, varied.particles
        assert isinstance(particles, Particles)
        assert isinstance(changed, Particles)
        size, sizes = size_rules(changed.diameter, count)
        width = np.broadcast_to(law.zeta_std * varied.roughness.sigma, count)[:, None] / size
        least = float(width.min())
        (x, weight), (few_x, few_weight) = sizes(least), sizes(least, FEW_SIZES)
        if x[:, -1].max() > MOST_WIDTHS * least:
            raise NotCompiled("the seat is too smooth for nodes")
        one = contact.law_of(particles).one(surfaces=contact.surfaces, particle=particles.material)
        alone = size_average(one, Monodisperse(mean=1.0))
        octave = np.frexp(width[:, 0] / x[:, -1])[1] - 1
        factor = changed.areal_density * size[:, 0] ** 2
        if getattr(one, "spreads", False):
            most = alone.floor[-2:].max() * np.sum(weight * x**2, axis=-1)
            self.most = self.most + factor * most
        _, shape = particles.diameter.standardised()
        fields = {
            **{"kind": layout.ROUGH_NODES, "top": alone.top, "bottom": alone.bottom},
            **{"inverse": self._panels.add_inverse(size_average(one, shape))},
            **{"floor": alone.floor, **self._over_gaps(octave, alone)},
            "sizes": self._rules.add_each(np.stack([weight * x**3, x], axis=1)),
            "few_sizes": self._rules.add_each(np.stack([few_weight * few_x**3, few_x], axis=1)),
            **{"size": size[:, 0], "factor": factor, "width": width[:, 0]},
            "reach": x[:, -1] * alone.top + layout.SEAT_REACH * width[:, 0],
        }
        yield math.pi / 4 * factor * np.sum(weight * x**2, axis=-1), fields


def _fill(rows: Records, fields: Mapping[str, ArrayLike]) -> None:
    """Records from their named fields: those alike for all at once, as one record."""
    by_row = {}
    one = np.zeros((), rows.dtype)
    for name, values in fields.items():
        if np.ndim(values) > len(rows.dtype[name].shape) and not isinstance(values, tuple):
            by_row[name] = values
        else:
            one[name] = values
    rows[...] = one
    for name, values in by_row.items():
        rows[name] = values


def _records_of(
    number: Index, place: Callable[[int], object], dtype: np.dtype[np.generic]
) -> Records:
    """Records (N,) of what belongs to each number, asked for each number once."""
    lowest = int(number.min())
    table = np.zeros(int(number.max()) - lowest + 1, dtype)
    for there in np.flatnonzero(np.bincount(number - lowest)):
        table[there] = place(lowest + int(there))
    return table[number - lowest]
