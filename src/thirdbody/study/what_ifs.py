"""What an answer hangs on most: each uncertain input at its ends alone, the others as they are."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..analysis.inputs import declared_quantity, input_of, inputs, words_of
from ..analysis.uncertainty.inputs import stated_ranges
from ..analysis.uncertainty.samples import columns_at
from ..contact.contact import Contact
from ..errors import InvalidValue, RangeWarning
from ..quantities.record import Record
from ..quantities.say import value_of

if TYPE_CHECKING:
    from ..equilibrium.columns import Equilibrium
    from .whole import Study

__all__ = ["WhatIf", "what_ifs_of_states"]

ENDS = (0.05, 0.95)
"""Where a range that a study states ends, as in an assessment."""
TWICE = 2.0
"""By what factor a number of particles, or a radius that nobody measured, may be off."""
HARDNESS = 1.2
"""By what factor a hardness may be off of which no range is stated."""
SATED = 0.99
"""A share of the load so large has little left to answer with; the area does."""
SEATS = (-1.0, 1.0)
"""Mean seats of particles, in RMS heights about those of the law: deep in valleys, on peaks."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WhatIf(Record):
    """What an answer would be if something were otherwise."""

    what: str
    """What is uncertain, in words."""
    values: tuple[float, ...]
    """What the answer is at the ends."""
    between: str
    """From what to what it is changed."""
    action: str
    """What to do about it."""
    code: str = ""
    """What it is about, where others look for it."""
    of: str = ""
    """The number that the answers are, where it is one of several."""

    @property
    def low(self) -> float:
        """The least of the answers."""
        return min(self.values)

    @property
    def high(self) -> float:
        """The largest."""
        return max(self.values)

    @property
    def ratio(self) -> float:
        """The largest over the least."""
        return self.high / self.low if self.low > 0 else np.inf if self.high > 0 else 1.0


class _Ends(NamedTuple):
    """One input at its two ends."""

    names: tuple[str, ...]
    values: tuple[tuple[float, float], ...]
    what: str
    between: str
    action: str
    code: str


def what_ifs_of_states(study: Study, states: Equilibrium, at: int) -> tuple[WhatIf, ...]:
    """What the load share of particles at one load of a study hangs on, the most first.

    Of contacts without particles, or where nearly the whole load is on them, it is the real area.
    Varied alone are: how many particles there are, where they lie, their hardness and that of the
    surfaces, what a finishing process leaves open of the roughness, and what the table
    [uncertainty] says.

    Parameters
    ----------
    study : Study
    states : Equilibrium
        Its states.
    at : int
        The one that counts.

    Returns
    -------
    tuple of WhatIf
        Empty where a state takes so long that nobody would wait: with particles that break, of
        studies of a connector or a plate, which have commands of their own.
    """
    contact = study.contact.replace(outputs=())
    other_command = study.connector is not None or study.plate is not None
    if other_command or any(population.strength is not None for population in contact.populations):
        return ()
    pressure = float(np.ravel(states.pressure)[at])
    if not pressure > 0:
        return ()
    share = float(np.ravel(states.particle_load_share)[at])
    of = "A_t" if contact.two_body or share > SATED else "particle_load_share"
    every = _ends(contact, study.uncertainty.inputs if study.uncertainty else {})
    ends = [varied for varied in every if _is_possible(contact, varied)]
    values_at_ends = _at_ends(contact, pressure, ends, of)
    out = [
        WhatIf(
            what=varied.what,
            between=varied.between,
            action=varied.action,
            code=varied.code,
            values=values,
            of=of,
        )
        for varied, values in zip(ends, values_at_ends, strict=True)
        if np.isfinite(values).all()
    ]
    return tuple(sorted(out, key=lambda what_if: -what_if.ratio))


def _is_possible(contact: Contact, varied: _Ends) -> bool:
    """Whether there is a contact at both ends: twice as many particles may be jammed."""
    try:
        for end in zip(*varied.values, strict=True):
            contact.replace(**dict(zip(varied.names, end, strict=True)))
    except InvalidValue:
        return False
    return True


def _ends(contact: Contact, stated: dict[str, Any]) -> Iterator[_Ends]:
    """Every input that is varied."""
    ranges = {
        name: (uncertain.quantile(0.0), uncertain.quantile(1.0))
        for name, uncertain in stated_ranges(contact).items()
    }
    ranges |= {
        name: (uncertain.quantile(ENDS[0]), uncertain.quantile(ENDS[1]))
        for name, uncertain in stated.items()
    }
    bodies = ("surfaces.first", "surfaces.second")
    alike = contact.surfaces.alike
    hardness = ["+".join(f"{name}.H" for name in bodies)] if alike else [f"{n}.H" for n in bodies]
    for label in [*hardness, *(name for name in ranges if name.endswith(".material.H"))]:
        yield _range(contact, label, ranges.get(label, HARDNESS), "measure the hardness")
    for name in ("R", "alpha", "eta_R_sigma"):
        if (label := f"roughness.{name}") in ranges:
            action = f"measure the surface and give roughness.topography, or roughness.{name}"
            yield _range(contact, label, ranges[label], action, " of the process")
    if not contact.roughness.finish and "roughness.R" not in ranges:
        action = "measure the surface and give roughness.topography"
        yield _range(contact, "roughness.R", TWICE, action)
    taken = set(hardness) | {f"roughness.{name}" for name in ("R", "alpha", "eta_R_sigma")}
    every = inputs(contact)
    for label in stated:
        if label not in taken and all(name.strip() in every for name in label.split("+")):
            yield _range(contact, label, ranges[label], "measure it")
    yield from _of_particles(contact)


def _of_particles(contact: Contact) -> Iterator[_Ends]:
    """How many there are, and where they lie."""
    if contact.two_body:
        return
    several = isinstance(contact.particles, tuple)
    places = [f"particles.{i}" if several else "particles" for i in range(len(contact.populations))]
    numbers = [population.areal_density for population in contact.populations]
    yield _Ends(
        tuple(f"{place}.areal_density" for place in places),
        tuple((number / TWICE, number * TWICE) for number in numbers),
        "the number of particles",
        "half and twice as many",
        "count them on your parts or in your oil",
        "number",
    )
    seats = tuple(name for name in inputs(contact) if name.endswith("particle_law.zeta_mean"))
    if getattr(contact.particle_law, "seat", "") == "rough" and seats:
        usual = float(contact.value_at(seats[0].rpartition(".")[0]).zeta_mean)
        yield _Ends(
            seats,
            ((usual + SEATS[0], usual + SEATS[1]),) * len(seats),
            "where the particles lie",
            "seats one sigma lower, in valleys, and one higher, on peaks",
            "press a map point by point (thirdbody explicit): it finds particle_law.zeta_mean",
            "seat",
        )


def _range(
    contact: Contact, label: str, ends: tuple[float, float] | float, action: str, of: str = ""
) -> _Ends:
    """An input between two ends, or off by a factor."""
    moved = input_of(contact, label)
    value = moved.values[0]
    low, high = ends if isinstance(ends, tuple) else (value / ends, value * ends)
    unit = declared_quantity(contact, moved.names[0])["unit"]
    at = [moved.numbers_at((end - value) / moved.scales[0]) for end in (low, high)]
    return _Ends(
        moved.names,
        tuple((float(at[0][name]), float(at[1][name])) for name in moved.names),
        f"the {words_of(contact, label)}{of}, {value_of(value, unit, 3)}",
        f"{value_of(low, unit, 3)} to {value_of(high, unit, 3)}",
        action,
        label,
    )


def _at_ends(
    contact: Contact, pressure: float, ends: Iterable[_Ends], of: str
) -> list[tuple[float, float]]:
    """A column at both ends of every input, solved side by side; NaN where there is no state."""
    ends = list(ends)
    current = inputs(contact)
    names = list(dict.fromkeys(name for varied in ends for name in varied.names))
    vary = {name: np.full(2 * len(ends), current[name]) for name in names}
    for i, varied in enumerate(ends):
        for name, values in zip(varied.names, varied.values, strict=True):
            vary[name][2 * i : 2 * i + 2] = values
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        column = columns_at(contact, "pressure", pressure, vary, 2 * len(ends), outputs=False)[of]
    return [(float(column[2 * i]), float(column[2 * i + 1])) for i in range(len(ends))]
