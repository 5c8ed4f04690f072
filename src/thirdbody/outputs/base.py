r"""What an output is.

An output says what the solved contact does besides carrying load. It is a frozen value that holds
its own numbers (shear strengths, speeds, wear coefficients), names its columns, and computes them
from the spots of solved states, mostly as

.. math:: Q = \sum_{ss} n\,q_{ss} + \sum_{sa} n\,q_{sa}

per nominal area. A contact carries its outputs; `solve`, sweeps, sensitivities and error bars then
hold their columns beside the others. A new output is one file and one line.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from ..errors import InvalidValue
from ..laws.base import Law

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..contact import Contact, Interface
    from ..laws.base import AbstractParticleLaw
    from ..materials import Material, MaterialPair
    from ..spots import AsperitySpots, ParticleSpots

    Array = NDArray[np.float64]
    Probe = Callable[[Array], ParticleSpots]

__all__ = ["AbstractOutput", "Column", "Solved"]

AT_ONCE = 4096
"""States whose spots are laid out together."""


class Column(NamedTuple):
    """One number of every state.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.outputs.Friction.columns["mu"]
    Column(symbol='μ', unit='1', meaning='coefficient of friction')
    """

    symbol: str
    """As in figures."""
    unit: str
    """SI, "1" for none."""
    meaning: str
    """In words."""


@dataclass(frozen=True)
class Solved:
    """N solved states of one contact, and every spot in them: what `AbstractOutput.of` is given.

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

    def total(self, of_asperities: Callable[[AsperitySpots], Any]) -> Array:
        """Σ n q over the asperities: (N,)."""
        return _sum(self.d, self.asperities, of_asperities)

    def total_of_particles(self, of_particles: Callable[[ParticleSpots], Any]) -> Array:
        """Σ n q over the particles: (N,)."""
        return _sum(self.d, self.particles, of_particles)

    def output(self, name: str) -> Any:
        """The output of this name that the contact carries."""
        return next(each for each in self.contact.outputs if each.name == name)


def _sum(d: Array, groups: Sequence[Any], q: Callable[[Any], Any]) -> Array:
    return sum((spots.total(q(spots)) for spots in groups), np.zeros_like(d))


class AbstractOutput(Law):
    """A result of the solved contact besides load, area and mode.

    A subclass is a frozen, slotted, keyword-only dataclass with the class data of `Law` and
    `columns`. Numbers that nobody can predict are fields without a default. The book's page "Add an
    output" writes one out.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sorted(tb.outputs.REGISTRY)[:3]
    ['counts', 'dents', 'electrical_conductance']
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}
    columns: ClassVar[Mapping[str, Column]]
    """Name, symbol, unit and meaning of every number it gives."""
    needs: ClassVar[tuple[str, ...]] = ()
    """Names of the outputs that this one reads: the contact must carry them too."""

    @abstractmethod
    def of(self, state: Solved) -> dict[str, Array]:
        """Every column: arrays (N,)."""

    def splits(self, probe: Probe) -> Sequence[float]:
        """Squeezes over diameter ε at which q of a particle jumps or bends.

        ``probe(ε)`` gives particles of unit size, one a row.
        """
        return ()

    def problems(self, contact: Contact) -> list[str]:
        """Why this contact cannot have this output, one sentence each."""
        return []

    def warnings(self, state: Solved, values: Mapping[str, Array]) -> list[str]:
        """Where these states leave the range of the output, one sentence each."""
        return []


def missing(output: AbstractOutput, bodies: Mapping[str, Material], *names: str) -> list[str]:
    """One sentence for each property of a body that an output needs and that is not known."""
    return [
        f"outputs.{output.name} needs {name} of {label}"
        + (f" ({body.name})" if body.name else "")
        + f"; give it with the material, e.g. material.replace({name}=...)"
        for label, body in bodies.items()
        for name in names
        if getattr(body, name) is None
    ]


def bodies_of(contact: Contact) -> dict[str, Material]:
    """The two surfaces and every population's material by what a message calls them."""
    out = {"surface 1": contact.surfaces.first, "surface 2": contact.surfaces.second}
    for number, each in enumerate(contact.populations):
        out[f"the particles {each.name or number + 1}"] = each.material
    return out


def spots_of(
    contact: Contact, bound: Interface, d: Array, shadow: Array
) -> tuple[list[AsperitySpots], list[ParticleSpots]]:
    """Every spot of the states at d: asperities out of the shadow, and loaded particles."""
    asperities = [spots.thinned(1 - shadow) for spots in bound.asperities.spots(d)]
    particles = []
    for each, response in zip(contact.populations, bound.populations, strict=True):
        law = contact.law_of(each)
        splits = {
            eps
            for output in contact.outputs
            for eps in _splits(output, law, contact.surfaces, each.material)
        }
        found = response.spots(d, sorted(splits))
        particles += [replace(spots, material=each.material, population=each) for spots in found]
    return asperities, particles


@lru_cache(maxsize=256)
def _splits(
    output: AbstractOutput, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
) -> tuple[float, ...]:
    """Where q of an output jumps or bends, for particles of one material."""

    def probe(eps: Array) -> ParticleSpots:
        found = law.probe(eps, surfaces=surfaces, particle=particle)
        return replace(found, material=particle)

    return tuple(float(eps) for eps in output.splits(probe))


def evaluate(
    contact: Contact, bound: Interface, columns: Mapping[str, Array], crowd: Array | None = None
) -> tuple[dict[str, Array], list[str]]:
    """Every column of the outputs of a contact, NaN for unsolved states, and the warnings.

    Parameters
    ----------
    contact : Contact
    bound : Interface
        Of an equal contact.
    columns : mapping
        d, h, pressure, A_t and shadow of the states: arrays (N,).
    crowd : array (N,), optional
        How many particles each state has for one of the contact.
    """
    names = [name for output in contact.outputs for name in output.columns]
    values = {name: np.full(len(columns["d"]), np.nan) for name in names}
    notes: dict[str, None] = {}
    known = np.flatnonzero(np.isfinite(columns["d"]))
    for start in range(0, len(known), AT_ONCE):
        part = known[start : start + AT_ONCE]
        here = {name: columns[name][part] for name in ("d", "h", "pressure", "A_t")}
        asperities, particles = spots_of(contact, bound, here["d"], columns["shadow"][part])
        if crowd is not None:
            particles = [spots.thinned(crowd[part]) for spots in particles]
        state = Solved(contact, **here, asperities=asperities, particles=particles)
        for output in contact.outputs:
            found = output.of(state)
            for name, value in found.items():
                values[name][part] = value
            notes |= dict.fromkeys(output.warnings(state, found))
    return values, list(notes)


def problems_of(outputs: Sequence[Any], contact: Contact) -> list[str]:
    """Mistakes in the outputs of a contact."""
    wrong = [each for each in outputs if not isinstance(each, AbstractOutput)]
    if wrong:
        return [
            f"Contact.outputs holds {each!r}; give outputs, e.g. outputs.Counts()" for each in wrong
        ]
    names = [each.name for each in outputs]
    if len(set(names)) < len(names):
        return [f"Contact.outputs names {', '.join(names)}: each output once"]
    out = []
    for each in outputs:
        out += [
            f"outputs.{each.name} needs outputs.{other} beside it"
            for other in each.needs
            if other not in names
        ]
        out += each.problems(contact)
    return out


def every_column() -> dict[str, Column]:
    """Every column of every output by name."""
    kinds: list[Any] = list(AbstractOutput.registry.values())
    return {name: told for kind in kinds for name, told in kind.columns.items()}


def column(name: str) -> Column:
    """Symbol, unit and meaning of an output's column.

    Raises
    ------
    InvalidValue
        No output has this column.
    """
    if (told := every_column().get(name)) is None:
        raise InvalidValue(f"no output has a column {name!r}")
    return told
