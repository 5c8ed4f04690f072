"""The outputs of a contact, evaluated on the spots of its states."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import Note, code_of
from ..quantities.say import number
from .output import AbstractOutput, changes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..laws.base import AbstractParticleLaw
    from ..laws.spots import ParticleSpots
    from ..populations.materials import Material, MaterialPair
    from .contact import Contact
    from .interface import Interface
    from .spots import AsperitySpots

    Array = NDArray[np.float64]

__all__ = ["Solved", "Solver", "splits_of"]

AT_ONCE = 4096
"""States whose spots are laid out together."""


class Solver(NamedTuple):
    """Type of the function with which an output solves another contact; the balance lies above."""

    separation: Callable[[Contact, Array], Array]
    """d [m] under pressures [Pa]: (N,), NaN where no separation carries them."""
    outputs: Callable[[Contact, Array], Mapping[str, Array]]
    """The outputs of a contact at separations d [m], NaN where those are."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Solved:
    """N solved states of one contact and every spot in them, as `AbstractOutput.of` gets them.

    Sums over spots agree with load and area of the state to 1e-9.

    Examples
    --------
    An output that counts the contacts of asperities would be

    >>> def of(state):
    ...     return {"n_ss": state.total(lambda spots: 1.0)}
    """

    contact: Contact
    d: Array
    """Separation as `solve` counts it [m]: (N,)"""
    h: Array
    """Separation from the mean surface plane [m]: (N,)"""
    pressure: Array
    """Nominal pressure [Pa]: (N,)"""
    A_t: Array
    """Real contact area per nominal area [1]: (N,)"""
    asperities: Sequence[AsperitySpots]
    particles: Sequence[ParticleSpots]
    crowd: Array | None = None
    """How many particles each state has for one of the contact: (N,), or as the contact has them.
    """
    solver: Solver | None = None
    """Of other contacts under a load; None where separations are given."""
    counted: Callable[[], Array] | None = None
    """Loaded particles per nominal area [1/m²], where that is known without every one of them."""
    kept: dict[Hashable, Any] = field(init=False, repr=False, default_factory=dict)
    """What an output found for these states, for its warnings."""

    def total(self, of_asperities: Callable[[AsperitySpots], ArrayLike]) -> Array:
        """Σ n q over the asperities: (N,)."""
        return _sum(self.d, self.asperities, of_asperities)

    def total_of_particles(self, of_particles: Callable[[ParticleSpots], ArrayLike]) -> Array:
        """Σ n q over the particles: (N,)."""
        return _sum(self.d, self.particles, of_particles)

    def loaded_particles(self) -> Array:
        """Loaded particles per nominal area [1/m²]: (N,)."""
        if self.counted is not None:
            return self.counted()
        return self.total_of_particles(lambda spots: spots.load > 0)

    def output(self, name: str) -> Any:
        """The output of this name that the contact carries."""
        return next(output for output in self.contact.outputs if output.name == name)


def _sum(d: Array, groups: Sequence[Any], q: Callable[[Any], ArrayLike]) -> Array:
    return sum((spots.total(q(spots)) for spots in groups), np.zeros_like(d))


def bodies_of(contact: Contact) -> dict[str, Material]:
    """The two surfaces and every population's material by what a message calls them."""
    out = {"surface 1": contact.surfaces.first, "surface 2": contact.surfaces.second}
    several = len(contact.populations) > 1
    for place, population in enumerate(contact.populations, 1):
        which = population.name or (place if several else "")
        out[f"the particles {which}".rstrip()] = population.material
    return out


UNHEARD = 0.01
"""Share of the load up to which few contacts of a kind do not matter to the sums."""


def _load(spots: AsperitySpots | ParticleSpots) -> Array:
    return spots.load


def _about_few(state: Solved) -> list[str]:
    """Notes on areas A_n with less than one contact: what the outputs mean there."""
    outputs = state.contact.outputs
    areas = [getattr(output, "A_n", None) or 0.0 for output in outputs]
    concerned = [f"outputs.{output.name}" for output in outputs if not output.tells_few]
    if not concerned or not max(areas) or not len(state.d):
        return []

    def has_load(spots: AsperitySpots | ParticleSpots) -> NDArray[np.bool_]:
        return spots.load > 0

    kinds = {
        "asperities": max(areas) * state.total(has_load),
        "particles": max(areas) * state.total_of_particles(has_load),
    }
    count = kinds["asperities"] + kinds["particles"]
    out: list[str] = []
    if not np.all(count):
        what = (
            f"nothing touches in {_how_many(count == 0)}: there the sums over contacts are 0 and "
            f"the means over them NaN ({', '.join(concerned)})"
        )
        out.append(Note(what, code="few.none"))
    least = float(np.min(count, where=count > 0, initial=np.inf))
    if least < 1:
        what = (
            f"A_n = {number(max(areas))} m² holds {number(least)} contacts on average: "
            f"{', '.join(concerned)} give the mean over many such areas, most of which hold none"
        )
        return [*out, Note(what, code="few.mean")]
    loads = [state.total(_load), state.total_of_particles(_load)]
    for (kind, of_kind), load in zip(kinds.items(), loads, strict=True):
        heard = (of_kind > 0) & (load > UNHEARD * sum(loads))
        few = float(np.min(of_kind, where=heard, initial=np.inf))
        if few < 1:
            what = (
                f"A_n = {number(max(areas))} m² holds {number(few)} {kind} in contact on average: "
                f"what {', '.join(concerned)} say of {kind} is the mean over many such areas, most "
                f"of which have none"
            )
            out.append(Note(what, code=f"few.{kind}"))
    return out


def _how_many(which: NDArray[np.bool_]) -> str:
    """Text for a count of states out of all."""
    if len(which) == 1:
        return "this state"
    return f"{np.count_nonzero(which)} of {len(which)} states"


class LaidOutParticles(Sequence["ParticleSpots"]):
    """Particles that are laid out once an output asks for them: many do not."""

    def __init__(self, lay_out: Callable[[], Sequence[ParticleSpots]]):
        self._lay_out = lay_out

    @cached_property
    def _items(self) -> Sequence[ParticleSpots]:
        return self._lay_out()

    def __len__(self) -> int:
        return len(self._items)

    def __getitem__(self, which: Any) -> Any:
        return self._items[which]


def particles_of(
    contact: Contact, contact_interface: Interface, d: Array, crowd: Array | None = None
) -> list[ParticleSpots]:
    """Spots of every loaded particle of the states at d, weighted by its number."""
    particles: list[ParticleSpots] = []
    for population, response in zip(
        contact.populations, contact_interface.populations, strict=True
    ):
        law = contact.law_of(population)
        splits = {
            eps
            for output in contact.outputs
            for eps in splits_of(output, law, contact.surfaces, population.material)
        }
        groups = response.spots(d, sorted(splits))
        particles += [
            replace(spots, material=population.material, population=population) for spots in groups
        ]
    return particles if crowd is None else [spots.thin_spots(crowd) for spots in particles]


def touching(contact_interface: Interface, d: Array, crowd: Array | None = None) -> Array:
    """Loaded particles per nominal area [1/m²] at d (N,), NaN where that is."""
    count = np.where(np.isnan(d), np.nan, 0.0)
    where = np.isfinite(d)
    for response in contact_interface.populations if where.any() else ():
        count[where] += response.touching(d[where])
    return count if crowd is None else count * crowd


def spots_of(
    contact: Contact, contact_interface: Interface, d: Array, shadow: Array
) -> tuple[list[AsperitySpots], list[ParticleSpots]]:
    """Every spot of the states at d: asperities out of the shadow, and loaded particles."""
    return asperities_of(contact_interface, d, shadow), particles_of(contact, contact_interface, d)


def asperities_of(contact_interface: Interface, d: Array, shadow: Array) -> list[AsperitySpots]:
    """Every asperity in contact of the states at d, out of the shadow of particles."""
    return [spots.thin_spots(1 - shadow) for spots in contact_interface.asperities.spots(d)]


@lru_cache(maxsize=256)
def splits_of(
    output: AbstractOutput, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Where q of an output jumps or bends, for particles of one material."""
    every = [*output.splits(_probe_of(law, surfaces, particle))]
    every += output.splits_of_law(law, surfaces, particle)
    splits = tuple(float(eps) for eps in every)
    return splits + _sink_bends(law, surfaces, particle) if output.follows_sinks else splits


@lru_cache(maxsize=256)
def _sink_bends(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Where the depth of impressions jumps or bends, whichever output asks."""

    def impression_kinds(spots: ParticleSpots) -> NDArray[np.intp]:
        return 8 * spots.impression_kind(0) + spots.impression_kind(1)

    splits = changes(_probe_of(law, surfaces, particle), impression_kinds)
    return (*splits, *law.one(surfaces=surfaces, particle=particle).sink_bends)


def _probe_of(
    law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> Callable[[Array], ParticleSpots]:
    """Particles of one material and of unit size at squeezes, one a row."""

    def probe(eps: Array) -> ParticleSpots:
        spots = law.probe(eps, surfaces=surfaces, particle=particle)
        return replace(spots, material=particle)

    return probe


def _laid_out_together(d: Array, contact_interface: Interface) -> Iterator[NDArray[np.intp]]:
    """Indices of solved states in groups whose spots take little memory, smallest d first."""
    solved = np.flatnonzero(np.isfinite(d))
    groups = [solved]
    stretch = min((response.stretch for response in contact_interface.populations), default=np.inf)
    if len(solved) > AT_ONCE or (len(solved) and np.ptp(d[solved]) > stretch):
        solved = solved[np.argsort(d[solved], kind="stable")]
        cells = np.floor((d[solved] - d[solved[0]]) / stretch)
        groups = np.split(solved, np.flatnonzero(np.diff(cells)) + 1)
    for group in groups:
        for start in range(0, len(group), AT_ONCE):
            yield group[start : start + AT_ONCE]


def evaluate(
    contact: Contact,
    contact_interface: Interface,
    columns: Mapping[str, Array],
    crowd: Array | None = None,
    parts: Sequence[dict[str, Array]] = (),
    solver: Solver | None = None,
) -> tuple[dict[str, Array], list[str]]:
    """Every column of the outputs of a contact, NaN for unsolved states, and the warnings.

    Parameters
    ----------
    contact : Contact
    contact_interface : Interface
        Of an equal contact.
    columns : mapping
        d, h, pressure, A_t and shadow of the states: arrays (N,).
    crowd : array (N,), optional
        How many particles each state has for one of the contact.
    parts : sequence of dict, optional
        One for each population: filled with the outputs that are given `by_population`.
    solver : Solver, optional
        Where loads are given and not separations.
    """
    names = [name for output in contact.outputs for name in output.columns]
    values = {name: np.full(len(columns["d"]), np.nan) for name in names}
    notes: dict[str, str] = {}
    for rows in _laid_out_together(columns["d"], contact_interface):
        here = {name: columns[name][rows] for name in ("d", "h", "pressure", "A_t")}
        many = None if crowd is None else crowd[rows]
        asperities = asperities_of(contact_interface, here["d"], columns["shadow"][rows])
        particles = LaidOutParticles(
            partial(particles_of, contact, contact_interface, here["d"], many)
        )
        state = Solved(
            contact=contact,
            **here,
            asperities=asperities,
            particles=particles,
            crowd=many,
            solver=solver,
            counted=partial(touching, contact_interface, here["d"], many),
        )
        for output in contact.outputs:
            with np.errstate(all="ignore"):  # a spot without a load has no number of its own
                output_values = output.of(state)
                said = output.warnings(state, output_values)
            for name, value in output_values.items():
                values[name][rows] = value
            for note in said:
                notes.setdefault(code_of(note), note)
        for population, population_values in zip(contact.populations, parts, strict=False):
            mine = [spots for spots in particles if spots.population is population]
            alone = replace(state, asperities=[], particles=mine, counted=None)
            for output in contact.outputs:
                with np.errstate(all="ignore"):
                    output_values = output.of(alone) if output.by_population else {}
                for name, value in output_values.items():
                    population_values.setdefault(name, np.full(len(columns["d"]), np.nan))[rows] = (
                        value
                    )
        for note in _about_few(state):
            notes.setdefault(code_of(note), note)
    return values, list(notes.values())
