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
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..errors import Advice, InvalidValue, Mistake, Problem
from ..laws.base import FLAKES, SERIES, Law
from ..quantities.record import Column

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.base import AbstractParticleLaw
    from ..laws.spots import ParticleSpots
    from ..populations.materials import Material, MaterialPair

    Array = NDArray[np.float64]
    Probe = Callable[[Array], ParticleSpots]

__all__ = ["AbstractOutput", "Column", "changes"]

SQUEEZES = np.concatenate([np.geomspace(1e-6, 2.0, 300), np.geomspace(2.0, 64.0, 73)[1:]])
"""Where changes of a particle's kind are looked for: δ/x."""
ROUNDS, FINER = 5, 100
"""A change is narrowed down so many times, each time so many times finer."""
APART = 4
"""So many changes lie between two squeezes that are looked at, at most."""


def changes(probe: Probe, kind: Callable[[ParticleSpots], NDArray[np.intp]]) -> list[float]:
    """Squeezes over diameter ε at which particles become of another kind.

    Parameters
    ----------
    probe : callable
        ``probe(ε)`` gives particles of unit size, one a row; see `AbstractOutput.splits`.
    kind : callable
        A whole number for each particle of such a group: (M, n).

    Returns
    -------
    list of float
        Every ε between 1e-6 and 64 [1] at which that number changes, to 1e-10 of the spacing of the
        371 first looked at; changes between neighbours of these are seen where they lie further
        apart than a hundredth of their distance, and what is changed is not changed back.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> found = changes(lambda eps: SimpleNamespace(x=eps[:, None]), lambda it: (it.x > 0.1) * 1)
    >>> [round(eps, 9) for eps in found]
    [0.1]
    """

    def kinds_at(eps: Array) -> NDArray[np.intp]:
        return kind(probe(eps.ravel())).reshape(eps.shape)

    jumps = np.flatnonzero(np.diff(kinds_at(SQUEEZES)))
    low, high = SQUEEZES[jumps], SQUEEZES[jumps + 1]
    steps = np.linspace(0.0, 1.0, FINER + 1)
    for _ in range(ROUNDS if len(jumps) else 0):
        eps = low[:, None] + (high - low)[:, None] * steps
        row, step = np.nonzero(np.diff(kinds_at(eps), axis=1))
        few = np.bincount(row, minlength=len(eps))[row] <= APART  # more are noise: the first of it
        first = np.diff(row, prepend=-1) > 0
        row, step = row[few | first], step[few | first]
        low, high = eps[row, step], eps[row, step + 1]
    return [float(eps) for eps in high]


class AbstractOutput(Law):
    """A result of the solved contact besides load, area and mode.

    A subclass is a frozen, slotted, keyword-only dataclass with the class data of `Law` and
    `columns`. Numbers that nobody can predict are fields without a default. The book's page "Add an
    output" writes one out.

    Examples
    --------
    >>> import thirdbody as tb
    >>> sorted(tb.outputs.REGISTRY)[:3]
    ['counts', 'crushing', 'dents']
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}
    columns: ClassVar[Mapping[str, Column]]
    """Name, symbol, unit and meaning of every number it gives."""
    needs: ClassVar[tuple[str, ...]] = ()
    """Names of the outputs that this one reads: the contact must carry them too."""
    tells_few: ClassVar[bool] = False
    """Whether it says itself where an area A_n holds less than one contact on average."""
    by_population: ClassVar[bool] = False
    """Whether it is given for each of several populations of particles too."""
    follows_sinks: ClassVar[bool] = False
    """Whether it depends on how deep particles sink into the surfaces, which bends where their law
    says (`OneParticle.sink_bends`)."""

    @abstractmethod
    def of(self, state: Any) -> dict[str, Array]:
        """Every column: arrays (N,)."""

    def splits(self, probe: Probe) -> Sequence[float]:
        """Squeezes over diameter ε at which q of a particle jumps or bends.

        ``probe(ε)`` gives particles of unit size, one a row.
        """
        return ()

    def splits_of_law(
        self, law: AbstractParticleLaw, surfaces: MaterialPair, particle: Material
    ) -> Sequence[float]:
        """More of them, which no probe shows, of a law of particles between two bodies."""
        return ()

    def problems(self, contact: Any) -> list[str]:
        """Reasons why this contact cannot have this output, each made by `problem`."""
        return []

    def problem(self, rule: str, *, code: Mistake, key: str = "", hint: str = "") -> Problem:
        """Mistake in this output, or in one of its keys, at its table of a study file."""
        path = f"{self.name}.{key}" if key else self.name
        return Problem(path, rule, hint=hint, owner="outputs", code=code)

    def one_by_one(self, contact: Any) -> bool:
        """Whether the output needs single asperities, which a law of the whole surface has not.

        Such a law answers with summits scaled to its load and area, and says so.
        """
        return True

    def warnings(self, state: Any, values: Mapping[str, Array]) -> list[str]:
        """Notes on states outside the range of the output, one sentence each."""
        return []


def missing(output: AbstractOutput, bodies: Mapping[str, Material], *names: str) -> list[str]:
    """Problems of an output: one for each body property that it needs and lacks."""
    return [
        output.problem(
            f"needs {name} of {label}"
            + (f" ({body.name})" if body.name else "")
            + Advice(
                f"; give it with the material, e.g. material.replace({name}=...)",
                f": {KEYS_OF_BODIES.get(label, 'in its table [[particles]] material')} = "
                f"{{ E = ..., nu = ..., H = ..., {name} = ... }}",
            ),
            code=Mistake.MISSING,
        )
        for label, body in bodies.items()
        for name in names
        if getattr(body, name) is None
    ]


KEYS_OF_BODIES = {
    "surface 1": "surfaces.first",
    "surface 2": "surfaces.second",
    "the particles": "particles.material",
}
"""Keys of study files that hold the material of a body."""
GIVE_OUTPUTS = Advice("give outputs, e.g. outputs.Counts()", "give tables, e.g. [outputs.counts]")


def problems_of(outputs: Sequence[Any], contact: Any) -> list[str]:
    """Mistakes in the outputs of a contact that has some."""
    wrong = [output for output in outputs if not isinstance(output, AbstractOutput)]
    if wrong:
        return [
            Problem("outputs", f"holds {output!r}", hint=GIVE_OUTPUTS, code=Mistake.KIND)
            for output in wrong
        ]
    laws = {law.name: law for law in map(contact.law_of, contact.populations)}
    if unknown := [name for name, law in laws.items() if not law.knows_each]:
        return [
            Problem(
                "outputs",
                f": the particle law {name} knows loads and areas of all particles together, "
                "not how deep one of them sits",
                hint="take " + SERIES + " or " + FLAKES + ", or remove the outputs",
                code=Mistake.BEYOND,
            )
            for name in unknown
        ]
    names = [output.name for output in outputs]
    if len(set(names)) < len(names):
        return [
            Problem("outputs", f"names {', '.join(names)}: each output once", code=Mistake.CLASH)
        ]
    out = []
    for output in outputs:
        out += [
            output.problem(f"needs outputs.{other} beside it", code=Mistake.MISSING)
            for other in output.needs
            if other not in names
        ]
        out += output.problems(contact)
    return out


def every_column() -> dict[str, Column]:
    """Every column of every output by name."""
    kinds: list[Any] = list(AbstractOutput.registry.values())
    return {name: column for kind in kinds for name, column in kind.columns.items()}


def column(name: str) -> Column:
    """Symbol, unit and meaning of an output's column.

    Raises
    ------
    InvalidValue
        No output has this column.
    """
    if (description := every_column().get(name)) is None:
        raise InvalidValue(f"no output has a column {name!r}", code=Mistake.UNKNOWN)
    return description
