"""The answer in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...analysis.inputs import words_of
from ...analysis.sensitivity import Sensitivity
from ...equilibrium.columns import about
from ...equilibrium.words import (
    carried,
    happens,
    is_rare,
    mode_among,
    mode_of,
    mode_path,
    not_met,
    two_bodies,
)
from ...quantities.say import join_words, number, percent, signed, times, value_of
from .found import Found

MATTER = 3
"""Inputs named in a sentence."""

CARRIERS = ("the film", "asperities", "particles")
"""Who shares the load of a lubricated contact."""

SATED = 0.01
"""A share so near to 0 or 1 ranks no inputs."""


class Sentences(Found):
    """What carries, how close the surfaces are, how far it is from changing, what decides."""

    def sentences(self) -> tuple[str, ...]:
        """The answer: what carries, how close the surfaces are, how far it is from changing.

        Where the study has a film, first what it says with the oil.
        """
        whole = self.result.body_sentence()
        return (*self._with_oil(), *self._without_oil(), *([whole] if whole else []))

    def _without_oil(self) -> tuple[str, str, str]:
        states = self.result.states
        known = sorted(self.result.solved_states, key=lambda i: states.pressure[i])
        first, last = known[0], known[-1]
        if first == last:
            return (
                f"{self._at_load(first)} {self._carries(first)}.",
                f"{_capital(self._closeness(first))}.",
                self._distance(first),
            )
        low, high = (f"{self._at_load(i)} {self._carries(i)}" for i in (first, last))
        near, far = (self._apart(i) for i in (first, last))
        return f"{low}: {near}.", f"{high}: {far}.", self._path(known)

    def _with_oil(self) -> list[str]:
        """Which film, what carries at its ends, and where its regime changes."""
        if self.film is None:
            return []
        from ..film_words import bodies, point, summary

        speeds = self.film["states"]["speed"]
        eta = value_of(self.film.conditions.oil.eta, "Pa s")
        out = [f"This is a {bodies(self.film)}, in oil of {eta}."]
        for i in sorted({speeds.index(min(speeds)), speeds.index(max(speeds))}):
            told = point(self.film, i)
            film, *solids = (
                (who, told[f"load on {who}"]) for who in CARRIERS if f"load on {who}" in told
            )
            out.append(
                f"At {value_of(speeds[i], 'm/s')} lubrication is {told['regime']}: {film[0]} "
                f"carries {film[1]} of the load, {join_words([' '.join(each) for each in solids])}."
            )
        return out + (summary(self.film)[:1] if len(speeds) > 1 else [])

    def _carries(self, i: int) -> str:
        states = self.result.states
        if not states.A_t[i]:
            return mode_of(None)
        if self.contact.two_body:
            return two_bodies()
        parts = {part.name: part.load_share[i] for part in states.populations}
        share = carried(states.particle_load_share[i], parts)
        mode, held = states.mode[i], self.result.particles_in(i)
        where = " of a wide surface" * is_rare(mode, held)
        return f"{mode_among(mode, held)}, and {share}{where}"

    def _gap(self, i: int) -> str:
        """How far the mean planes are from each other."""
        h = self.result.states.h[i]
        if h < 0:
            return f"the mean planes of the surfaces overlap by {value_of(-h, 'm')}"
        return f"the mean planes of the surfaces are {value_of(h, 'm')} apart"

    def _area(self, i: int) -> str:
        return f"real contact area is {percent(self.result.states.A_t[i])} of the nominal area"

    def _apart(self, i: int) -> str:
        touching = self.result.states.A_t[i] > 0
        return f"{self._gap(i)} and the {self._area(i)}" if touching else self._gap(i)

    def _closeness(self, i: int) -> str:
        states = self.result.states
        if not states.A_t[i]:
            return self._gap(i)
        plastic = states.A_p[i]
        part = "" if math.isnan(plastic) else f", {percent(plastic / states.A_t[i])} of it plastic"
        ratio = times(abs(states.h[i]) / self.contact.roughness.sigma)
        return f"the {self._area(i)}{part}, and {self._gap(i)} ({ratio} the roughness)"

    def _distance(self, i: int) -> str:
        """How far the load is from what would change the mode."""
        F = self.result.states.F_star[i]
        found = self._existing_loads()
        if self.contact.two_body:
            return self._first_input()
        if not F > 0:
            what = "The surfaces pull at each other" if F < 0 else "There is no load"
            return f"{what}: nothing to compare with a critical load."
        if not found:
            return " ".join(
                not_met(name, entry.value, entry.status)
                for name, entry in self.mode_changes.items()
            )
        name = min(found, key=lambda key: abs(math.log(F / found[key])))
        ratio = number(max(F / found[name], found[name] / F), 3)
        side = f"a factor {ratio} {'above' if found[name] < F else 'below'}"
        if ratio == number(1):
            side = "close to"
        band = ""
        if self.assessment is not None:
            odds = self.assessment.propagation.mode_probability
            likely = max(odds, key=lambda mode: odds[mode])
            band = f"; with the inputs as uncertain as stated, the mode is {likely} in "
            band += f"{percent(odds[likely])} of cases"
        return (
            f"The load is {side} {name} = {number(found[name])} "
            f"({value_of(found[name] * self.contact.E_ss, 'Pa')}), where {happens(name)}{band}."
        )

    def _path(self, known: Sequence[int]) -> str:
        states = self.result.states
        if self.contact.two_body:
            return self._first_input()
        loads = [states.F_star[i] for i in known]
        found = [
            f"{name} = {number(F)} ({value_of(F * self.contact.E_ss, 'Pa')}{_beyond(F, loads)})"
            for name, F in self._existing_loads().items()
        ]
        if any(is_rare(states.mode[i], self.result.particles_in(i)) for i in known):
            path = "Modes are those of a wide surface whose particles all share the load"
        else:
            path = mode_path(states.mode[i] for i in known)
        critical = "the critical load is" if len(found) == 1 else "critical loads are"
        return f"{path}; {critical} {join_words(found)}." if found else f"{path}."

    def _first_input(self) -> str:
        order = [] if self.slopes is None else _order(self.slopes, "A_t")
        if not order:
            return "Which input matters most could not be found."
        assert self.slopes is not None
        slope = float(self.slopes.elasticity["A_t"][order[0]])
        return (
            f"{self._when()}{words_of(self.contact, order[0])} moves the real contact area most: "
            "1 % more of it makes "
            f"{signed(slope, 2, '%')} of area."
        )

    def _when(self) -> str:
        """Of the inputs, and at which of several loads."""
        at = f", at {self._load(self.at)}" if len(self.result.solved_states) > 1 else ""
        return f"Of the inputs{at}, "

    def ranked(self) -> tuple[str, list[str]]:
        """Which result inputs are ranked by, and the inputs, the strongest first.

        A share at its end hardly answers to anything, so that the area ranks then.
        """
        if self.slopes is None:
            return "A_t", []
        share = self.result.states.particle_load_share[self.at]
        within = not self.contact.two_body and SATED < share < 1 - SATED
        of = "particle_load_share" if within else "A_t"
        return of, _order(self.slopes, of)

    def _strongest(self, of: str, order: list[str]) -> str:
        first = [words_of(self.contact, label) for label in order[:MATTER]]
        most = f"{join_words(first)} matter{'s' if len(first) == 1 else ''} most"
        most += f" to the {about(of).meaning}"
        if self.contact.two_body or of != "A_t":
            return most
        share = self.result.states.particle_load_share[self.at]
        return f"{carried(share)}, which leaves that share little to answer with; {most}"


def _order(slopes: Sensitivity, of: str) -> list[str]:
    """Inputs to which a result answers, the strongest first; then those with no number."""
    row = slopes.elasticity[of]
    size = {label: abs(float(value)) for label, value in row.items()}
    if not any(0 < each < math.inf for each in size.values()):
        return []
    return sorted(size, key=lambda label: -(size[label] if math.isfinite(size[label]) else -1.0))


def _beyond(F: float, loads: Sequence[float]) -> str:
    """Whether a load lies outside those of the study."""
    low, high = min(loads), max(loads)
    if low <= F <= high:
        return ""
    return f", {'below' if F < low else 'above'} the loads of this study"


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
