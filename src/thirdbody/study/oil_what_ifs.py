"""What dents and life in a dirty oil hang on: each input at its ends alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..contact.contact import Contact
from ..errors import InvalidValue
from ..populations.materials import materials
from ..quantities.record import Record
from ..quantities.say import percent, value_of
from ..systems.film_conditions import FilmConditions
from .dirty_oil import DirtyOil, dirty_oil
from .what_ifs import HARDNESS, TWICE
from .whole import Study

if TYPE_CHECKING:
    from ..populations.particles import Particles

__all__ = ["OilWhatIf", "what_ifs_of_oil"]

VISCOSITY = 1.25
"""By what factor the viscosity at the inlet may be off: some six kelvin of a mineral oil."""


@dataclass(frozen=True, eq=False, kw_only=True)
class OilWhatIf(Record):
    """What dents and life would be if something were otherwise.

    Attributes
    ----------
    what, between, action, code : str
        As of `WhatIf`.
    dents : tuple of float
        Per hour, of all populations, at both ends [1].
    depth : tuple of float
        Depth that one in twenty dents of the deepest population exceeds [m]; NaN where no depth
        is known.
    a_ISO : tuple of float
        Life factor [1]; NaN where there is none.
    """

    what: str
    between: str
    action: str
    code: str
    dents: tuple[float, float]
    depth: tuple[float, float]
    a_ISO: tuple[float, float]

    @property
    def ratio(self) -> float:
        """The largest of the three, high over low."""
        return max(_ratio(pair) for pair in (self.dents, self.depth, self.a_ISO))

    @property
    def life_ratio(self) -> float:
        """Life factor, high over low; 1 where there is none."""
        return _ratio(self.a_ISO)


def what_ifs_of_oil(study: Study, base_oil: DirtyOil) -> tuple[OilWhatIf, ...]:
    """What dents and life hang on, the most first: number and hardness of particles, viscosity.

    Parameters
    ----------
    study : Study
        With a table [film] and particles.
    base_oil : DirtyOil
        What `dirty_oil` says of it as it is.

    Returns
    -------
    tuple of OilWhatIf
        Empty with particles that break, where each takes seconds.
    """
    contact, film = study.contact, study.film
    if film is None or any(population.strength is not None for population in contact.populations):
        return ()
    ends: list[tuple[str, str, str, str, tuple[Study | None, ...]]] = [
        (
            "the number of particles",
            "half and twice as many, one class of ISO 4406 each way",
            "count your oil, and what it is that was counted",
            "number",
            (_with_number(study, 1 / TWICE), _with_number(study, TWICE)),
        ),
        (
            f"the viscosity at the inlet, {value_of(film.oil.eta, 'Pa s', 3)}",
            f"{percent(1 - 1 / VISCOSITY)} less and {percent(VISCOSITY - 1)} more",
            "measure the running temperature",
            "film.oil.eta",
            (_with_viscosity(study, film, 1 / VISCOSITY), _with_viscosity(study, film, VISCOSITY)),
        ),
    ]
    for i, population in enumerate(base_oil.populations):
        low, high = _hardness(contact, i)
        ends.append(
            (
                f"the hardness of {population.name}",
                f"{value_of(low, 'Pa', 3)} and {value_of(high, 'Pa', 3)}",
                "find out what the particles are",
                f"particles.{i}.material.H",
                tuple(_with_hardness(study, i, H) for H in (low, high)),
            )
        )
    out = []
    for what, between, action, code, pair in ends:
        both = [None if changed is None else dirty_oil(changed) for changed in pair]
        if all(oil is not None for oil in both):
            out.append(
                OilWhatIf(
                    what=what, between=between, action=action, code=code,
                    dents=_pair(both, lambda oil: sum(p.per_hour for p in oil.populations)),
                    depth=_pair(both, _deepest),
                    a_ISO=_pair(both, lambda oil: oil.life.a_ISO if oil.life else math.nan),
                )
            )  # fmt: skip
    return tuple(sorted(out, key=lambda what_if: -what_if.ratio))


def _deepest(oil: DirtyOil) -> float:
    return max((p.depth_p95 for p in oil.populations if math.isfinite(p.depth_p95)),
               default=math.nan)  # fmt: skip


def _pair(both: list[DirtyOil | None], number: Callable[[DirtyOil], float]) -> tuple[float, float]:
    return tuple(float(number(oil)) for oil in both)  # type: ignore[return-value, arg-type]


def _ratio(values: tuple[float, float]) -> float:
    low, high = min(values), max(values)
    if not (math.isfinite(low) and math.isfinite(high)):
        return 1.0
    return high / low if low > 0 else math.inf if high > 0 else 1.0


def _with_parts(study: Study, parts: tuple[Particles, ...]) -> Study:
    contact = study.contact
    several = isinstance(contact.particles, tuple)
    return replace(study, contact=contact.replace(particles=parts if several else parts[0]))


def _with_viscosity(study: Study, film: FilmConditions, factor: float) -> Study:
    """The study with another viscosity of the oil."""
    oil = film.oil.replace(eta=film.oil.eta * factor)
    return replace(study, film=film.replace(oil=oil))


def _with_number(study: Study, factor: float) -> Study | None:
    """The study with more particles, or none where these are jammed."""
    parts = study.contact.populations
    try:
        return _with_parts(
            study,
            tuple(
                population.replace(areal_density=population.areal_density * factor)
                for population in parts
            ),
        )
    except InvalidValue:
        return None


def _with_hardness(study: Study, i: int, H: float) -> Study:
    parts = list(study.contact.populations)
    parts[i] = parts[i].replace(material=parts[i].material.replace(H=H))
    return _with_parts(study, tuple(parts))


def _hardness(contact: Contact, i: int) -> tuple[float, float]:
    """Range of the library, or off by a factor."""
    material = contact.populations[i].material
    library_entry = materials.entries().get(material.name, {})
    if library_entry.get("H") == material.H and "H" in library_entry.get("range", {}):
        low, high = library_entry["range"]["H"]
        if low < high:
            return float(low), float(high)
    return material.H / HARDNESS, material.H * HARDNESS
