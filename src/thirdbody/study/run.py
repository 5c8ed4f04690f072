"""Running a study: everything it asks for."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Iterable

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.modes import CriticalStatus
from ..equilibrium.transitions import Critical, Transitions, TurningPoint, transitions
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, ThirdBodyError, note_of
from ..systems.bodies import YIELD, yield_note
from .load import press_forces
from .results import Entrained, FilmResult, Passing, StudyResult
from .whole import Study

__all__ = ["MOST_SPEEDS", "run_film", "run_film_curve", "run_study"]

MOST_SPEEDS, REACH = 80, 100.0
"""Speeds of a curve that is drawn, and how far it goes beyond one speed."""


def run_study(study: Study) -> StudyResult:
    """Everything a study file asks for.

    Parameters
    ----------
    study : Study

    Returns
    -------
    StudyResult
        States, critical loads, forces, warnings; ``to_dict()`` is ready for JSON.

    Examples
    --------
    >>> from thirdbody.study import run_study
    >>> from thirdbody.study import check
    >>> steel = {"first": "S45C", "second": "S45C"}
    >>> study = check({"surfaces": steel, "roughness": {"sigma": "100 nm", "R": "2.8 um"},
    ...                "load": {"pressure": "5 MPa"}})
    >>> found = run_study(study)
    >>> f"{found.states.A_t[0]:.2g}", found.to_dict()["states"]["mode"]
    ('0.0013', ['s-s'])
    """
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        states = study.solve()
        critical = _transitions(study.contact)
        forces = [] if study.body is None else press_forces(study.body, study.forces, study.contact)  # type: ignore[arg-type]
    sentences = [*states.warnings, *(note_of(item.message) for item in heard)]
    sentences += [sentence for force in forces for sentence in force.warnings]
    return StudyResult(
        study=study,
        states=states,
        transitions=critical,
        forces=tuple(forces),
        run_warnings=_new_sentences(study, sentences),
    )


def run_film(study: Study) -> FilmResult:
    """The lubricated contact of a study file.

    Parameters
    ----------
    study : Study
        With a table [film].

    Returns
    -------
    FilmResult
        States over speed, where the regime changes, what passes; ``to_dict()`` is ready for JSON.

    Raises
    ------
    InvalidValue
        There is no table [film].
    NoEquilibrium
        The solids carry more than the load at every gap that a film leaves.
    """
    film, contact = study.film, study.contact
    if film is None:
        questions = {"probability": study.connector, "plate": study.plate, "life": study.life}
        others = [name for name, table in questions.items() if table is not None]
        more = "".join(f"; thirdbody {name} answers this study" for name in others)
        raise InvalidValue(
            Problem(
                "film",
                'is missing: a table [film] says what is lubricated, e.g. load = "20 N", '
                'speed = "0.5 m/s", conjunction = { shape = "point", R = "9.5 mm" }, '
                f'oil = {{ eta = "20 mPa s", alpha = "20 / GPa" }}{more}',
                code=Mistake.MISSING,
            )
        )
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        states = film.stribeck_columns(contact)
        changes = film.regime_speeds(contact)
    dirt, R, brought = film.entrainment, film.conjunction.R, None
    if dirt is not None:
        entered = [
            [dirt.areal_density(population.diameter, h=float(h), R=R) for h in states["h_T"]]
            for population in contact.populations
        ]
        brought = Entrained(np.asarray(dirt.largest(states["h_T"], R=R)), entered)
    sentences = [note_of(item.message) for item in heard]
    pressed = film.conjunction.hertz(film.load, E=2 * contact.E_ss)
    if (maximum := float(pressed.maximum)) > (yields := YIELD * contact.surfaces.H):
        sentences.append(yield_note(film.load, maximum, yields))
    return FilmResult(
        study=study,
        states=states,
        regime_speeds=changes,
        passing=tuple(
            Passing(
                population.name or population.material.name or f"particles {number + 1}",
                np.asarray(population.diameter.partial_moment(0, 0.0, states["h"])),
            )
            for number, population in enumerate(contact.populations)
        ),
        entrainment=brought,
        run_warnings=_new_sentences(study, sentences),
    )


def run_film_curve(study: Study) -> tuple[FilmResult, int]:
    """What `run_film` finds over the speeds of a study, and which of them is its own or middle.

    One speed is shown with others around it, of many speeds some.

    Parameters
    ----------
    study : Study
        With a table [film].
    """
    film = study.film
    if film is None:
        return run_film(study), 0
    speeds = np.unique(film.speed)
    if len(speeds) == 1:
        at = MOST_SPEEDS // 2
        around = speeds[0] * REACH ** np.linspace(-1, 1, MOST_SPEEDS + 1)
        around[at] = speeds[0]
        speeds = around
    elif len(speeds) > MOST_SPEEDS:
        some = np.linspace(0, len(speeds) - 1, MOST_SPEEDS).round().astype(int)
        speeds = speeds[np.unique(some)]
    at_these = film.replace(speed=tuple(speeds.tolist()))
    return run_film(dataclasses.replace(study, film=at_these)), len(speeds) // 2


def _new_sentences(study: Study, sentences: Iterable[str]) -> tuple[str, ...]:
    """Sentences, each once, that the notes of the study do not hold."""
    return tuple(dict.fromkeys(sentence for sentence in sentences if sentence not in study.notes))


def _transitions(contact: Contact) -> Transitions:
    try:
        return transitions(contact)
    except ThirdBodyError as error:
        none = Critical(value=None, status=f"{CriticalStatus.NONE}: {str(error).splitlines()[0]}")
        return Transitions(none, none, TurningPoint(none, none, none))
