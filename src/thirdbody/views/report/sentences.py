"""The answer in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...analysis.inputs import words_of
from ...analysis.sensitivity import Sensitivity
from ...equilibrium.columns import about
from ...equilibrium.words import (
    happens,
    is_rare,
    mode_among,
    mode_of,
    mode_path,
    not_met,
    particle_share_text,
    two_bodies,
)
from ...quantities.say import join_words, number, percent, signed_number, times, value_of
from .found import Found

MATTER = 3
"""Inputs named in a sentence."""

CARRIERS = ("the film", "asperities", "particles")
"""Who shares the load of a lubricated contact."""

SATED = 0.01
"""A share so near to 0 or 1 ranks no inputs."""


def answer_sentences(report: Found) -> tuple[str, ...]:
    """The answer: what carries, how close the surfaces are, how far it is from changing.

    Where the study has a film, first what it says with the oil.
    """
    whole = report.result.body_sentence()
    return (*_with_oil(report), *_without_oil(report), *([whole] if whole else []))


def _without_oil(report: Found) -> tuple[str, str, str]:
    states = report.result.states
    solved_states = sorted(report.result.solved_states, key=lambda i: states.pressure[i])
    first, last = solved_states[0], solved_states[-1]
    if first == last:
        return (
            f"{report.at_load(first)} {_carries(report, first)}.",
            f"{_capital(_closeness(report, first))}.",
            _distance(report, first),
        )
    low, high = (f"{report.at_load(i)} {_carries(report, i)}" for i in (first, last))
    near, far = (_gap_and_area(report, i) for i in (first, last))
    return f"{low}: {near}.", f"{high}: {far}.", _path(report, solved_states)


def _with_oil(report: Found) -> list[str]:
    """Sentences on the film, on what carries at its ends, and on its regimes."""
    if report.film is None:
        return []
    from ..film_words import bodies, point, summary

    speeds = report.film["states"]["speed"]
    eta = value_of(report.film.conditions.oil.eta, "Pa s")
    out = [f"This is a {bodies(report.film)}, in oil of {eta}."]
    for i in sorted({speeds.index(min(speeds)), speeds.index(max(speeds))}):
        values = point(report.film, i)
        film, *solids = (
            (who, values[f"load on {who}"]) for who in CARRIERS if f"load on {who}" in values
        )
        out.append(
            f"At {value_of(speeds[i], 'm/s')} lubrication is {values['regime']}: {film[0]} "
            f"carries {film[1]} of the load, "
            f"{join_words([' '.join(carrier) for carrier in solids])}."
        )
    return out + (summary(report.film)[:1] if len(speeds) > 1 else [])


def _carries(report: Found, i: int) -> str:
    states = report.result.states
    if not states.A_t[i]:
        return mode_of(None)
    if report.contact.two_body:
        return two_bodies()
    parts = {population.name: population.load_share[i] for population in states.populations}
    share = particle_share_text(states.particle_load_share[i], parts)
    mode, held = states.mode[i], report.result.particles_in(i)
    where = " of a wide surface" * is_rare(mode, held)
    return f"{mode_among(mode, held)}, and {share}{where}"


def _gap(report: Found, i: int) -> str:
    """Sentence on the distance of the mean planes."""
    h = report.result.states.h[i]
    if h < 0:
        return f"the mean planes of the surfaces overlap by {value_of(-h, 'm')}"
    return f"the mean planes of the surfaces are {value_of(h, 'm')} apart"


def _area(report: Found, i: int) -> str:
    return f"real contact area is {percent(report.result.states.A_t[i])} of the nominal area"


def _gap_and_area(report: Found, i: int) -> str:
    touching = report.result.states.A_t[i] > 0
    return f"{_gap(report, i)} and the {_area(report, i)}" if touching else _gap(report, i)


def _closeness(report: Found, i: int) -> str:
    states = report.result.states
    if not states.A_t[i]:
        return _gap(report, i)
    plastic = states.A_p[i]
    plastic_words = (
        "" if math.isnan(plastic) else f", {percent(plastic / states.A_t[i])} of it plastic"
    )
    ratio = times(abs(states.h[i]) / report.contact.roughness.sigma)
    return f"the {_area(report, i)}{plastic_words}, and {_gap(report, i)} ({ratio} the roughness)"


def _distance(report: Found, i: int) -> str:
    """How far the load is from what would change the mode."""
    F = report.result.states.F_star[i]
    critical_loads = report.existing_loads()
    if report.contact.two_body:
        return _first_input(report)
    if not F > 0:
        what = "The surfaces pull at each other" if F < 0 else "There is no load"
        return f"{what}: nothing to compare with a critical load."
    if not critical_loads:
        return " ".join(
            not_met(name, entry.value, entry.status) for name, entry in report.mode_changes.items()
        )
    name = min(critical_loads, key=lambda key: abs(math.log(F / critical_loads[key])))
    ratio = number(max(F / critical_loads[name], critical_loads[name] / F), 3)
    side = f"a factor {ratio} {'above' if critical_loads[name] < F else 'below'}"
    if ratio == number(1):
        side = "close to"
    band = ""
    if report.assessment is not None:
        odds = report.assessment.propagation.mode_probability
        likely = max(odds, key=lambda mode: odds[mode])
        band = f"; with the inputs as uncertain as stated, the mode is {likely} in "
        band += f"{percent(odds[likely])} of cases"
    return (
        f"The load is {side} {name} = {number(critical_loads[name])} "
        f"({value_of(critical_loads[name] * report.contact.E_ss, 'Pa')}), where "
        f"{happens(name)}{band}."
    )


def _path(report: Found, solved_states: Sequence[int]) -> str:
    states = report.result.states
    if report.contact.two_body:
        return _first_input(report)
    loads = [states.F_star[i] for i in solved_states]
    critical_loads = [
        f"{name} = {number(F)} ({value_of(F * report.contact.E_ss, 'Pa')}{_outside_note(F, loads)})"
        for name, F in report.existing_loads().items()
    ]
    if any(is_rare(states.mode[i], report.result.particles_in(i)) for i in solved_states):
        path = "Modes are those of a wide surface whose particles all share the load"
    else:
        path = mode_path(states.mode[i] for i in solved_states)
    critical = "the critical load is" if len(critical_loads) == 1 else "critical loads are"
    return f"{path}; {critical} {join_words(critical_loads)}." if critical_loads else f"{path}."


def _first_input(report: Found) -> str:
    order = [] if report.slopes is None else _order(report.slopes, "A_t")
    if not order:
        return "Which input matters most could not be found."
    assert report.slopes is not None
    slope = float(report.slopes.elasticity["A_t"][order[0]])
    return (
        f"{_inputs_clause(report)}{words_of(report.contact, order[0])} moves the real contact area "
        "most: 1 % more of it makes "
        f"{signed_number(slope, 2, '%')} of area."
    )


def _inputs_clause(report: Found) -> str:
    """Clause on the inputs, and on which of several loads they matter."""
    at = f", at {report.load(report.at)}" if len(report.result.solved_states) > 1 else ""
    return f"Of the inputs{at}, "


def ranked_inputs(report: Found) -> tuple[str, list[str]]:
    """Result by which inputs are ranked, and the inputs, the strongest first.

    A share at its end hardly answers to anything, so that the area ranks then.
    """
    if report.slopes is None:
        return "A_t", []
    share = report.result.states.particle_load_share[report.at]
    within = not report.contact.two_body and SATED < share < 1 - SATED
    of = "particle_load_share" if within else "A_t"
    return of, _order(report.slopes, of)


def strongest_inputs(report: Found, of: str, order: list[str]) -> str:
    first = [words_of(report.contact, label) for label in order[:MATTER]]
    most = f"{join_words(first)} matter{'s' if len(first) == 1 else ''} most"
    most += f" to the {about(of).meaning}"
    if report.contact.two_body or of != "A_t":
        return most
    share = report.result.states.particle_load_share[report.at]
    return f"{particle_share_text(share)}, which leaves that share little to answer with; {most}"


def _order(slopes: Sensitivity, of: str) -> list[str]:
    """Inputs to which a result answers, the strongest first; then those with no number."""
    row = slopes.elasticity[of]
    size = {label: abs(float(value)) for label, value in row.items()}
    if not any(0 < value < math.inf for value in size.values()):
        return []
    return sorted(size, key=lambda label: -(size[label] if math.isfinite(size[label]) else -1.0))


def _outside_note(F: float, loads: Sequence[float]) -> str:
    """Whether a load lies outside those of the study."""
    low, high = min(loads), max(loads)
    if low <= F <= high:
        return ""
    return f", {'below' if F < low else 'above'} the loads of this study"


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
