"""What a study gives: records that command line, page and report read, and their plain data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..contact.citations import cite
from ..equilibrium.columns import CODE, provenance
from ..equilibrium.transitions import Transitions
from ..errors import NoEquilibrium
from ..quantities.carried import takes_units
from ..quantities.plain_data import plain_data
from ..quantities.record import (
    NOTES,
    VERSION,
    Entry,
    MappedRecord,
    Record,
    TableRecord,
    Variable,
    with_names,
)
from ..quantities.say import percent, value_of
from ..systems.bodies import Pressed
from ..systems.film_conditions import FilmConditions
from ..systems.film_formulas import full_range
from ..systems.natures import Nature, natures
from ..systems.stribeck import OF_CURVE, RegimeSpeeds
from .dirty_oil import DirtyOil, dirty_oil
from .film import note_without_oil
from .load import force_sentences
from .oil_what_ifs import OilWhatIf, what_ifs_of_oil
from .what_ifs import WhatIf, what_ifs_of_states
from .whole import Study

SHARING = "Johnson, Greenwood, Poon 1972, Wear 19, 91, doi:10.1016/0043-1648(72)90445-0"
ROELANDS = "Roelands 1966, thesis, TU Delft"
EYRING = "Eyring 1936, J. Chem. Phys. 4, 283, doi:10.1063/1.1749836"

__all__ = ["Entrained", "FilmResult", "Passing", "StudyResult"]

Columns = dict[str, list[object]]


def _entries(input_entry: Entry, *numbers: Entry) -> tuple[Entry, ...]:
    """Entries of a result: what every study says, an input beside the contact, and numbers."""
    inputs: Entry = ("inputs", (("", "study.contact"), input_entry))
    more = ("natures", "warnings", NOTES, "citations")
    return ("title", "study.title"), VERSION, inputs, *numbers, *more


@dataclass(frozen=True, eq=False, kw_only=True)
class _Result(MappedRecord, TableRecord):
    """A study and its results; indexed, it is the plain data of `to_dict`."""

    study: Study
    run_warnings: tuple[str, ...]
    """What the computation warns of, one sentence each."""

    @property
    def title(self) -> str:
        """Title of the study, "Study" if it has none."""
        return self.study.title or "Study"

    @property
    def heading(self) -> str:
        """The title, and what was set over the file."""
        return self.study.heading

    @property
    def warnings(self) -> tuple[str, ...]:
        """Notes of reading and of solving the study, one sentence each."""
        return tuple(dict.fromkeys((*self.study.notes, *self.run_warnings)))

    @property
    def notes(self) -> tuple[str, ...]:
        """The same as ``warnings``: sentences, most with ``code``, ``effect`` and ``action``."""
        return self.warnings

    @property
    def citations(self) -> list[str]:
        """The works behind the numbers."""
        return cite(self.study.contact).splitlines()

    @property
    def particles_held(self) -> float | None:
        """Particles that lie on the dry Hertz contact of the film's bodies, on average."""
        film, contact = self.study.film, self.study.contact
        if film is None or contact.two_body:
            return None
        area = film.conjunction.hertz(film.load, E=2 * contact.E_ss).area
        return float(area * sum(dust.areal_density for dust in contact.populations))

    @cached_property
    def natures(self) -> tuple[Nature, ...]:
        """What the particles of each population are: do they conduct, dent, break?"""
        return natures(self.study.contact)


@dataclass(frozen=True, eq=False, kw_only=True)
class StudyResult(_Result):
    """What `run_study` finds.

    Attributes
    ----------
    study : Study
    states : Equilibrium
        Every state, as arrays. One that cannot be solved keeps its place with NaN and a status
        that says why.
    transitions : Transitions
        Critical loads, or why there are none.
    forces : tuple of Pressed
        What each force does to its body; empty where none presses one.
    run_warnings : tuple of str
        What the computation warns of; ``warnings`` holds what the study file warns of too.

    Notes
    -----
    `to_dict` has title, version, inputs (SI), scales, states (a list each), what each of several
    populations carries in them, transitions, what the answer hangs on, what the particles of each
    population are, warnings, the same taken apart as ``notes`` (code, effect, action, sentence),
    citations; ``body``, where a force presses one: pressures and integrals of each force, and
    sentences; and where none does, of a study with [film], ``particles_held``: how many lie in the
    contact of its bodies.
    """

    in_dict = (
        *_entries(
            ("load", lambda result: {result.study.load: result.study.values}),
            *(("scales", "states.scales"), ("states", "_coded_states")),
            *(("populations", "states.populations"), ("engine", "states.engine")),
            *("transitions", "what_ifs"),
        ),
        ("", "_bodies"),
    )
    in_columns = ("population",)
    states: Any
    transitions: Transitions
    forces: tuple[Pressed, ...] = ()

    def variables(self) -> Mapping[str, Variable]:
        """Columns of the states."""
        variables: Mapping[str, Variable] = self.states.variables()
        return variables

    def coordinates(self) -> Mapping[str, Variable]:
        """Names of several populations."""
        coordinates: Mapping[str, Variable] = self.states.coordinates()
        return coordinates

    def attributes(self) -> Mapping[str, object]:
        """Warnings, inputs, version and citations."""
        return {**self.states.attributes(), "warnings": "\n".join(self.warnings)}

    @property
    def oil_notes(self) -> tuple[str, ...]:
        """A note that the oil is left out, where the study has one."""
        return (
            ()
            if self.study.film is None
            else (
                note_without_oil("states are"),
                *self.study.gap_notes,
            )
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Notes of reading and of solving the study, one sentence each."""
        return tuple(dict.fromkeys((*self.study.notes, *self.oil_notes, *self.run_warnings)))

    @cached_property
    def solved_states(self) -> list[int]:
        """Numbers of the states that have an equilibrium."""
        return np.flatnonzero(self.states.status == "ok").tolist()

    @property
    def central(self) -> int:
        """Number of the state that stands for all: of forces the first, else the middle load."""
        if self.forces:
            return self.solved_states[0]
        by_pressure = sorted(self.solved_states, key=lambda i: float(self.states.pressure[i]))
        return by_pressure[(len(by_pressure) - 1) // 2]

    @cached_property
    def what_ifs(self) -> tuple[WhatIf, ...]:
        """What the answer hangs on at the central state, the most first."""
        if not self.solved_states:
            return ()
        return what_ifs_of_states(self.study, self.states, self.central)

    def need_state(self) -> None:
        """Refuse a result without a single state.

        Raises
        ------
        NoEquilibrium
            No state was solved; it says why the first was not.
        """
        if not self.solved_states:
            first, *others = self.states.status
            more = f" (and so for all {len(others) + 1} states)" if others else ""
            raise NoEquilibrium(first + more)

    @property
    def force_sentences(self) -> list[str]:
        """Sentences on the forces that press the bodies."""
        return force_sentences(list(self.forces))

    @takes_units
    def particles_in(self, i: int) -> float:
        """Particles that the contact of a state holds on average; infinite where nobody knows."""
        held = self.particles_held  # of a film that has bodies of its own
        if self.forces:
            states_per_force = len(self.states.status) // len(self.forces)
            held = self.forces[i // states_per_force].particles_held
        return math.inf if held is None else float(held)

    def body_sentence(self) -> str:
        """Sentence on the bodies where it differs from that of the states, else "".

        States are of a surface under one pressure, which shares its load among all its particles.
        """
        forces = [force for force in self.forces if force.particle_load_share is not None]
        if not forces:
            return ""
        rare = any(0 < (force.particles_held or 0.0) < 1 for force in forces)
        if not (rare or any(force.method == "rough body" for force in forces)):
            return ""
        loads = ", ".join(
            f"{percent(force.particle_load_share)} under {value_of(force.force, 'N')}"
            for force in forces
        )
        pressures = "" if forces[0].kind == "flat" else "under the pressures of smooth bodies, "
        means = ", on average over contacts with and without one," if rare else ""
        return (
            f"The states are of a wide surface {pressures}whose particles all share the load; of "
            f"the load of the bodies themselves particles carry{means} {loads}."
        )

    def table(self) -> tuple[Columns, dict[str, str]]:
        """Columns of the states, of each of several populations, and the code of the status.

        Then their units.
        """
        columns = self._coded_states()
        codes = columns.pop(CODE)
        units = {name: self.states.about(name).unit for name in self.states.columns()}
        for population in self.states.populations:
            for name, values in population.columns().items():
                columns[f"{population.name}: {name}"] = plain_data(values)
                units[f"{population.name}: {name}"] = population.about(name).unit
        columns[CODE], units[CODE] = codes, ""
        return columns, units

    def _coded_states(self) -> Columns:
        columns = plain_data(self.states.columns())
        columns["mode"] = [mode or None for mode in columns["mode"]]
        return {name: columns.pop(name) for name in ("status", CODE)} | columns

    def _bodies(self) -> dict[str, object]:
        """What forces do to their bodies; without forces the particles that a film's hold."""
        if self.forces:
            body: dict[str, object] = {} if self.study.body is None else self.study.body.to_dict()
            return {"body": body | {"forces": self.forces, "sentences": self.force_sentences}}
        return {} if self.study.film is None else {"particles_held": self.particles_held}


@dataclass(frozen=True, eq=False)
class Passing(Record):
    """Share by number of one population that is narrower than the separation."""

    name: str
    share: np.ndarray


@dataclass(frozen=True, eq=False)
class Entrained(Record):
    """What the oil brings: the largest particle dragged in [m], and particles per area [1/m²]."""

    largest: np.ndarray
    areal_density: list[list[float]]
    """Of each population, at every film thickness."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmResult(_Result):
    """What `run_film` finds.

    Attributes
    ----------
    study : Study
    states : dict of array
        Every column of `MixedFilm`, one entry a speed, the Hersey number, the code of the status.
    regime_speeds : RegimeSpeeds
        Speeds at which the regime changes.
    passing : tuple of Passing
        What of each population passes the film.
    entrainment : Entrained or None
        What the oil brings.
    run_warnings : tuple of str
        What the computation warns of; ``warnings`` holds what the study file warns of too.

    Notes
    -----
    `to_dict` has title, version, inputs (SI), states (a list each, one entry a speed), the speeds
    at which the regime changes, what of each population passes the film, how many particles one
    Hertz contact holds, what the oil brings, what the particles of each population are, warnings,
    the same taken apart as ``notes``, citations; of an oil with particles ``oil``, what they do,
    ``oil_filtered``, the same behind the filter of the study, and ``what_ifs``, what this hangs on.
    """

    in_dict = (
        *_entries(
            ("film", "conditions"),
            *("states", ("regime_speeds", with_names("regime_speeds")), "passing"),
            *("particles_held", "entrainment"),
        ),
        ("", "_of_oil"),
    )
    states: dict[str, np.ndarray]
    regime_speeds: RegimeSpeeds
    passing: tuple[Passing, ...]
    entrainment: Entrained | None = None

    def variables(self) -> dict[str, Variable]:
        """Columns of the film, over the speed."""
        columns = {
            name: Variable(("speed",), values, OF_CURVE[name].attributes)
            for name, values in self.states.items()
        }
        del columns["speed"]
        return columns

    def coordinates(self) -> dict[str, Variable]:
        """The speeds."""
        return {"speed": Variable(("speed",), self.states["speed"], OF_CURVE["speed"].labels)}

    def attributes(self) -> Mapping[str, object]:
        """Warnings, inputs, version and citations."""
        said = {"warnings": "\n".join(self.warnings)}
        return provenance(self.study.contact) | said | {"citations": "\n".join(self.citations)}

    @cached_property
    def oil(self) -> DirtyOil | None:
        """What the particles of the oil do; None where there are none, or no state with them."""
        return dirty_oil(self.study)

    @cached_property
    def oil_filtered(self) -> DirtyOil | None:
        """The same behind the filter of the study; None where it names none."""
        fine = self.study.filter
        return None if fine is None else dirty_oil(self.study, filter=fine)

    @cached_property
    def what_ifs(self) -> tuple[OilWhatIf, ...]:
        """What the dents and the life hang on, the most first."""
        return () if self.oil is None else what_ifs_of_oil(self.study, self.oil)

    def _of_oil(self) -> dict[str, object]:
        """What there is of the oil and its particles."""
        every = {name: getattr(self, name) for name in ("oil", "oil_filtered", "what_ifs")}
        return {name: value for name, value in every.items() if value}

    @property
    def conditions(self) -> FilmConditions:
        """What the table [film] says."""
        assert self.study.film is not None
        return self.study.film

    @property
    def citations(self) -> list[str]:
        """The works behind the numbers."""
        film = self.conditions
        law = film.formula or full_range(film.conjunction.shape)
        lines = [*super().citations, law.citation + f", doi:{law.doi}" * bool(law.doi), SHARING]
        lines += [ROELANDS] * (film.oil.viscosity == "roelands")
        lines += [EYRING] * (film.oil.eyring_stress is not None)
        return list(dict.fromkeys(lines))

    def table(self) -> tuple[Columns, dict[str, str]]:
        """Columns of the states, then what passes and what the oil brings, and their units."""
        columns: Columns = plain_data(self.states)
        units = {name: OF_CURVE[name].unit for name in columns}
        for passing in self.passing:
            columns[f"{passing.name}: passing"] = plain_data(passing.share)
            units[f"{passing.name}: passing"] = "1"
        if brought := self.entrainment:
            columns["largest"], units["largest"] = plain_data(brought.largest), "m"
            for passing, density in zip(self.passing, brought.areal_density, strict=True):
                columns[f"{passing.name}: areal_density"] = plain_data(density)
                units[f"{passing.name}: areal_density"] = "1/m^2"
        return columns, units
