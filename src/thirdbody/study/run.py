"""Running a study: everything it asks for, as plain data."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..contact.citations import cite
from ..contact.contact import Contact
from ..equilibrium.columns import Equilibrium
from ..equilibrium.modes import CriticalStatus
from ..equilibrium.transitions import Critical, Transitions, TurningPoint, transitions
from ..errors import InvalidValue, RangeWarning, ThirdBodyError, note_of
from ..quantities.plain_data import plain_data
from ..systems.bodies import Pressed
from ..systems.film_conditions import FilmConditions
from ..systems.film_formulas import full_range
from .body import force_sentences, pressed
from .whole import Study

SHARING = "Johnson, Greenwood, Poon 1972, Wear 19, 91, doi:10.1016/0043-1648(72)90445-0"
ROELANDS = "Roelands 1966, thesis, TU Delft"
EYRING = "Eyring 1936, J. Chem. Phys. 4, 283, doi:10.1063/1.1749836"

__all__ = ["film_conditions", "passing", "run_film", "run_study"]


def run_study(study: Study) -> dict[str, Any]:
    """Everything a study file asks for, as plain data ready for JSON.

    Parameters
    ----------
    study : Study

    Returns
    -------
    dict
        Title, version, inputs (SI), scales, states (a list each), what each of several populations
        carries in them, transitions, warnings, citations; ``body``, where a force presses one:
        pressures and integrals of each force, and sentences; and where none does, of a study with
        [film], ``particles_held``: how many lie in the contact of the film's bodies. A state that
        cannot be solved keeps its place with None and a status that says why.
    """
    from ..version import __version__

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = study.solve()
        critical = _transitions(study.contact)
        forced = [] if study.body is None else pressed(study.body, study.forces, study.contact)  # type: ignore[arg-type]
    sentences = [*study.notes, *state.warnings, *(note_of(item.message) for item in heard)]
    sentences += [sentence for each in forced for sentence in each.warnings]
    states = {name: plain_data(np.atleast_1d(column)) for name, column in state.columns().items()}
    states["mode"] = [mode or None for mode in states["mode"]]
    return {
        "title": study.title,
        "version": __version__,
        "inputs": study.contact.to_dict() | {"load": {study.load: study.values.tolist()}},
        "scales": state.scales,
        "states": {"status": states.pop("status"), **states},
        "populations": _populations(state),
        "engine": state.engine,
        "transitions": critical.to_dict(),
        "warnings": list(dict.fromkeys(sentences)),
        "citations": cite(study.contact).splitlines(),
    } | (_body(study, forced) if forced else _of_film(study))


def _of_film(study: Study) -> dict[str, Any]:
    """How many particles the contact of the table [film] holds, if there is one."""
    return (
        {} if study.film is None else {"particles_held": _particles_held(study.film, study.contact)}
    )


def _body(study: Study, forced: list[Pressed]) -> dict[str, Any]:
    """What presses, its forces, and sentences."""
    assert study.body is not None
    return {
        "body": study.body.to_dict()
        | {"forces": [each.to_dict() for each in forced], "sentences": force_sentences(forced)}
    }


def film_conditions(study: Study) -> FilmConditions:
    """What the table [film] says.

    Raises
    ------
    InvalidValue
        There is no such table.
    """
    if study.film is None:
        raise InvalidValue(
            "the study has no table [film]: it says what is lubricated, e.g. [film] "
            'load = "20 N", speed = "0.5 m/s", conjunction = { shape = "point", R = "9.5 mm" }, '
            'oil = { eta = "20 mPa s", alpha = "20 / GPa" }'
        )
    return study.film


def run_film(study: Study) -> dict[str, Any]:
    """The lubricated contact of a study file, as plain data ready for JSON.

    Parameters
    ----------
    study : Study
        With a table [film].

    Returns
    -------
    dict
        Title, version, inputs (SI), states (a list each, one entry a speed), the speeds at which
        the regime changes, what of each population passes the film, how many particles one
        Hertz contact holds, what the oil brings, warnings, citations.

    Raises
    ------
    InvalidValue
        There is no table [film].
    NoEquilibrium
        The solids carry more than the load at every gap that a film leaves.
    """
    from ..version import __version__

    given, contact = film_conditions(study), study.contact
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        curve = given.stribeck_columns(contact)
        changes = given.regime_speeds(contact)
    states = {name: plain_data(np.atleast_1d(column)) for name, column in curve.items()}
    sentences = [*study.notes, *(note_of(item.message) for item in heard)]
    return {
        "title": study.title,
        "version": __version__,
        "inputs": contact.to_dict() | {"film": given.to_dict()},
        "states": states,
        "regime_speeds": changes._asdict(),
        "passing": passing(study, curve["h"]),
        "particles_held": _particles_held(given, contact),
        "entrainment": _particles_brought(study, curve["h_T"]),
        "warnings": list(dict.fromkeys(sentences)),
        "citations": _sources(study),
    }


def _particles_held(given: FilmConditions, contact: Contact) -> float | None:
    """Particles that lie on the dry Hertz contact of the film's bodies, on average."""
    if contact.two_body:
        return None
    area = given.conjunction.hertz(given.load, E=2 * contact.E_ss).area
    return float(area * sum(dust.areal_density for dust in contact.populations))


def passing(study: Study, h: Any) -> list[dict[str, Any]]:
    """Of each population the share, by number, that is narrower than the separation h [m]."""
    return [
        {
            "name": each.name or each.material.name or f"particles {number + 1}",
            "share": plain_data(
                np.atleast_1d(each.diameter.partial_moment(0, 0.0, np.asarray(h, float)))
            ),
        }
        for number, each in enumerate(study.contact.populations)
    ]


def _particles_brought(study: Study, h_T: Any) -> dict[str, Any] | None:
    """Largest particle dragged in, and particles that enter per area, at every film thickness."""
    given = film_conditions(study)
    dirt, R = given.entrainment, given.conjunction.R
    if dirt is None:
        return None
    return {
        "largest": plain_data(np.atleast_1d(dirt.largest(h_T, R=R))),
        "areal_density": [
            [dirt.areal_density(each.diameter, h=float(h), R=R) for h in h_T]
            for each in study.contact.populations
        ],
    }


def _sources(study: Study) -> list[str]:
    given = film_conditions(study)
    law = given.formula or full_range(given.conjunction.shape)
    lines = [*cite(study.contact).splitlines(), law.citation + (f", doi:{law.doi}" * bool(law.doi))]
    lines.append(SHARING)
    if given.oil.viscosity == "roelands":
        lines.append(ROELANDS)
    if given.oil.eyring_stress is not None:
        lines.append(EYRING)
    return list(dict.fromkeys(lines))


def _populations(state: Equilibrium) -> list[dict[str, Any]]:
    """What each of several populations carries in every state; nothing for one."""
    numbers = ("F_sa_star", "A_sa", "load_share", "area_share")
    return [
        {"name": part.name}
        | {name: plain_data(np.atleast_1d(getattr(part, name))) for name in numbers}
        | {name: plain_data(np.atleast_1d(values)) for name, values in part.outputs.items()}
        for part in state.populations
    ]


def _transitions(contact: Contact) -> Transitions:
    try:
        return transitions(contact)
    except ThirdBodyError as error:
        none = Critical(value=None, status=f"{CriticalStatus.NONE}: {str(error).splitlines()[0]}")
        return Transitions(none, none, TurningPoint(none, none, none))
