"""What an assessment says, in sections and sentences."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..contact.citations import cite
from ..contact.contact import Contact
from ..equilibrium.critical_loads import CRITICAL
from ..equilibrium.modes import WINDOW, CriticalStatus
from ..equilibrium.status import Status
from ..equilibrium.words import (
    critical_load,
    critical_name,
    happens,
    load_of,
    mode_of,
    not_met,
    two_bodies,
)
from ..quantities.notebook import Card, Row
from ..quantities.record import VERSION, Column, Entry, Record, TableRecord, Variable
from ..quantities.say import join_words, number, percent, span, times, value_of
from ..quantities.tables import WIDER, Table
from .inputs import declared_quantity, words_of
from .inputs import inputs as all_inputs
from .uncertainty.propagation import OUTPUTS, Propagation, about_result
from .uncertainty.samples import crowded_samples

__all__ = ["WORDS", "Assessment", "Change", "Section", "Stop", "terminal_page"]

SHOWN = ("particle_load_share", "particle_area_share", "plastic_share", "A_t", "d", "h")
"""What the page tells of the state."""
BAND = (0.05, 0.5, 0.95)
FAR, COARSE, FINER = 10.0, 41, (18, 18)
"""Factor within which a change of mode is sought in an input, values on the way to it of which
every EACH-th is tried, and values tried within the step in which it lies, and within that."""
EACH = 4
HALVES = (3,) * 8
"""As FINER, where each contact takes tables of its own."""
UNMOVED = 1e-5
"""Part of a result below which its differences are not known."""
RARE = 1e-4
"""Probability below which a value counts as outside the range of an input."""


@dataclass(frozen=True, eq=False, slots=True)
class Change(Record):
    """How far one input, the others as they are, must go to change the mode."""

    in_dict = (
        *("input", "value", "mode", ("probability", "beyond")),
        ("within_range", lambda change: change.beyond >= RARE),
    )
    input: str
    value: float
    mode: str
    beyond: float
    """Probability that the input is there or farther."""


@dataclass(frozen=True, eq=False, slots=True)
class Stop(Record):
    """End of the search along one input: beyond it the contact is refused."""

    input: str
    value: float
    """The last value that was tried and is not refused."""
    why: str


class Section(NamedTuple):
    """A part of the page: a table, and sentences below it."""

    title: str
    head: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    sentences: tuple[str, ...] = ()
    drop: tuple[str, ...] = ()
    """Heads of columns in the order in which they go where the width is small."""


SENTENCES: Entry = (
    "sentences",
    lambda page: {section.title: section.sentences for section in page.sections()},
)


class PageRecord(TableRecord):
    """A result that is a page of sections, in a notebook too."""

    @abstractmethod
    def sections(self) -> list[Section]:
        """The page from top to bottom."""

    def _cards(self) -> Iterator[Card]:
        """The page for notebooks: a table for each part."""
        for title, head, lines, sentences, _ in self.sections():
            rows = [Row(cells[0], cells[1:]) for cells in (head, *lines) if cells]
            yield Card(title, rows, sentences)


# -------------------------------------------------------------------------- the page
@dataclass(frozen=True, eq=False, kw_only=True)
class Assessment(PageRecord):
    """What an engineer wants to know of a contact under its operating load.

    As labelled data and as a table it is what each input does, a row for each: ``matter``,
    ``elasticity``, and the outputs of ``tornado``. Its bands are those of ``propagation``.

    Attributes
    ----------
    title : str
    propagation : Propagation
        Bands of everything, at the load.
    mode : str
        Contact mode with the contact's own inputs.
    decisive : str
        The output by which inputs are ranked: the critical load nearest to the load, or a share.
    matter : dict
        Inputs, the one that moves `decisive` most first, and their part of its spread when each
        goes from the 5th to the 95th percentile alone; NaN where `decisive` ceases to exist.
    tornado : dict of dict
        ``tornado[of][input]``, outputs at both ends of each input.
    elasticity : dict
        d ln F_cr/d ln p of the nearest critical load; NaN where there is none.
    changes : tuple of Change
        Inputs that can change the mode alone, the likeliest first.
    exact : tuple of str
        Inputs without a range, taken as exactly known.
    notes : tuple of str
        What else is to be said.
    stops : tuple of Stop
        Where the search for another mode ends before a factor of 10, and why.
    """

    in_dict = (
        *("title", VERSION, ("contact", "propagation.contact"), "mode", "propagation", "decisive"),
        *("matter", "tornado", "elasticity", "changes", "stops", "exact", SENTENCES, "notes"),
        ("citations", lambda page: cite(page.propagation.contact).splitlines()),
    )
    along = "input"
    in_columns = ("end",)
    title: str
    propagation: Propagation
    mode: str
    decisive: str
    matter: dict[str, float]
    tornado: dict[str, dict[str, tuple[float, float]]] = field(repr=False)
    elasticity: dict[str, float]
    changes: tuple[Change, ...]
    exact: tuple[str, ...]
    notes: tuple[str, ...]
    stops: tuple[Stop, ...] = ()

    def variables(self) -> dict[str, Variable]:
        """What each input does: alone to the spread, by its slope, and at both of its ends."""
        share = Column("", "1", f"part of the spread of {self.decisive} that it makes alone")
        slope = Column("", "1", f"relative change of {self.decisive} over that of the input")
        slopes = [self.elasticity.get(label, math.nan) for label in self.matter]
        dims = self.along, *self.in_columns
        ends = {
            of: Variable(
                dims,
                np.array([by_input[label] for label in self.matter]).reshape(-1, 2),
                about_result(of).labels,
            )
            for of, by_input in self.tornado.items()
        }
        return {
            "matter": Variable(dims[:1], list(self.matter.values()), share.labels),
            "elasticity": Variable(dims[:1], slopes, slope.labels),
            **ends,
        }

    def coordinates(self) -> dict[str, Variable]:
        """Names of the inputs, what they are, and the probabilities of their ends."""
        dims = (self.along,)
        return {
            self.along: Variable(dims, list(self.matter)),
            "meaning": Variable(dims, [self._words(label) for label in self.matter]),
            "end": Variable(("end",), [BAND[0], BAND[-1]]),
        }

    def attributes(self) -> Mapping[str, object]:
        """Those of the bands, and the output by which inputs are ranked."""
        return {**self.propagation.attributes(), "decisive": self.decisive, "mode": self.mode}

    # ------------------------------------------------------------------ words and tables
    def headline(self) -> str:
        """Mode, its probability and the load in one sentence."""
        propagation = self.propagation
        likely = max(
            propagation.mode_probability, key=lambda mode: propagation.mode_probability[mode]
        )
        parts = [
            f"{mode} {percent(share, propagation.mode_error[mode])}"
            + f" ({mode_of(mode)})" * (mode == "none")
            for mode, share in propagation.mode_probability.items()
            if share > 0
        ]
        load = load_of(propagation.nominal["pressure"], propagation.nominal["F_star"])
        if propagation.contact.two_body:
            return f"At {load} {two_bodies()}."
        if not propagation.inputs:
            return f"At {load} {mode_of(self.mode)}."
        agree = "" if likely == self.mode else f" The likeliest mode is {likely}."
        return (
            f"At {load} {mode_of(self.mode)}. Probability of each mode: {', '.join(parts)}.{agree}"
        )

    def sections(self) -> list[Section]:
        """The page from top to bottom."""
        propagation = self.propagation
        said = (self.headline(),) if propagation.inputs else (self.headline(), NO_RANGES)
        parts = [Section("Mode at the operating load", sentences=said)]
        if not propagation.contact.two_body:
            parts.append(self.margins())
        parts += [self._state(), self._inputs()] if propagation.inputs else [self._state()]
        if not propagation.contact.two_body:
            parts.append(Section("What would change the mode", sentences=self._ways()))
        parts.append(Section("What this rests on", sentences=self.basis()))
        return parts

    @property
    def moved(self) -> bool:
        """Whether what inputs are ranked by answers to any of them, or ceases to exist."""
        return any(
            not (low == high or abs(high - low) <= UNMOVED * abs(high + low))
            for low, high in self.tornado[self.decisive].values()
        )

    def _band(self, name: str) -> tuple[float, ...]:
        where = [self.propagation.probabilities.index(q) for q in BAND]
        return tuple(float(self.propagation.bands[name][i]) for i in where)

    def margins(self) -> Section:
        """Critical loads, and how far the load is from them."""
        propagation = self.propagation
        if "F_cr1" not in propagation.bands:
            return Section("Margins", sentences=(NO_CRITICAL.format(_law_of(propagation)),))
        rows, sentences = [], []
        E, uncertain = propagation.contact.E_ss, bool(propagation.inputs)
        for name in (name for name in CRITICAL if name in propagation.bands):
            nominal, (low, _, high) = propagation.nominal[name], self._band(name)
            status = propagation.critical_status[name]
            exists = status.get(CriticalStatus.FOUND, 0.0)
            rows.append(
                (
                    critical_name(name),
                    critical_load(nominal),
                    critical_load(nominal, E_ss=E),
                    *((critical_load(low), critical_load(high), percent(exists)) * uncertain),
                    happens(name),
                )
            )
        for name in ("F_cr1", "F_cr2"):
            nominal, (low, _, high) = propagation.nominal[f"F/{name}"], self._band(f"F/{name}")
            if not 0 < nominal < math.inf:
                sentences.append(not_met(name, propagation.nominal[name]))
                continue
            band = f"{number(low, 3)} to {times(high)}"
            if times(low) == times(high):
                band = times(high)
            if low == 0 or math.isinf(high):
                band = f"at most {times(high)}" if low == 0 else f"at least {times(low)}"
            cases = f"; in nine of ten cases it is {band} that load" * uncertain
            sentences.append(f"The load is {times(nominal)} {name}, where {happens(name)}{cases}.")
        bands = ("5 %", "95 %", "exists") * uncertain
        head = ("critical load", "F*", "pressure", *bands, "where")
        return Section("Margins", head, tuple(rows), tuple(sentences), ("where", "exists", "F*"))

    def _state(self) -> Section:
        propagation = self.propagation
        rows: list[tuple[str, ...]] = []
        outputs = [name for output in propagation.contact.outputs for name in output.columns]
        for name in (name for name in (*SHOWN, *outputs) if name in propagation.bands):
            if propagation.contact.two_body and name.startswith("particle"):
                continue
            low, middle, high = self._band(name)
            if not propagation.inputs:
                rows.append((about_result(name).meaning, _amount(propagation.nominal[name], name)))
                continue
            amounts = (propagation.nominal[name], low, middle, high)
            where = [propagation.probabilities.index(q) for q in BAND]
            error = _error(float(np.max(propagation.error[name][where])), name)
            rows.append((about_result(name).meaning, *(_amount(x, name) for x in amounts), error))
        head = ("result", "nominal", "5 %", "50 %", "95 %", "error of the bands")
        lost = 1 - propagation.solved
        sentences = [f"{percent(lost)} of the samples have no equilibrium."] if lost else []
        close = crowded_samples([propagation.crowded]) if propagation.inputs else []
        if propagation.crowded and not propagation.inputs:
            close = [Status.CROWDED.sentence]
        sentences += [f"{sentence[0].upper()}{sentence[1:]}." for sentence in close]
        if not propagation.inputs:
            return Section("State", ("result", "value"), tuple(rows), tuple(sentences))
        return Section("State", head, tuple(rows), tuple(sentences), ("error of the bands", "50 %"))

    def _inputs(self) -> Section:
        propagation = self.propagation
        rows = []
        for label, share in self.matter.items():
            distribution = propagation.inputs[label]
            unit, value = unit_of(propagation.contact, label), _nominal(propagation, label)
            low, high = self.tornado[self.decisive][label]
            slope = self.elasticity.get(label, math.nan)
            rows.append(
                (
                    self._words(label),
                    value_of(value, unit),
                    *(value_of(distribution.quantile(end), unit) for end in (0.05, 0.95)),
                    *(_amount(end, self.decisive) for end in (low, high)),
                    percent(share, least=1e-3),
                    number(0.0 if abs(slope) < 1e-4 else slope, 3),
                )
            )
        strongest = [self._words(label) for label in list(self.matter)[:3]]
        first = next(iter(self.matter.values()), math.nan)
        sentences = [
            f"Of the inputs, {join_words(strongest)} matter{'s' if len(strongest) == 1 else ''} "
            f"most to {self._decisive()}."
            if self.moved
            else f"No input moves {self._decisive()}, within its range."
        ]
        if math.isfinite(first):
            sentences.append(
                f"A better value of the {strongest[0]} pays most: it alone makes about "
                f"{percent(first)} of the spread of {self.called}"
                + (" (of its logarithm)." if self.decisive in CRITICAL else ".")
            )
        sentences += filter(None, (self._distance_words(), self.fixed_numbers_words()))
        head = (
            *("input", "value", "5 %", "95 %"),
            *(f"{self.called} at {end}" for end in ("5 %", "95 %")),
            *("part of spread", "elasticity"),
        )
        drop = ("elasticity", "value", *head[4:6])
        return Section("Inputs that matter", head, tuple(rows), tuple(sentences), drop)

    def _words(self, label: str) -> str:
        return words_of(self.propagation.contact, label)

    def _decisive(self) -> str:
        if self.decisive in CRITICAL:
            other = "F_cr1" if self.decisive == "F_cr2" else "F_cr2"
            if self._may_be_nearer(other):
                low, high = (number(end) for end in WINDOW)
                return (
                    f"{self.decisive}, the nearest critical load between F* = {low} and {high} "
                    f"({other}, beyond these, may be nearer)"
                )
            return f"{self.decisive}, the critical load nearest to this load"
        return f"the {self.called}"

    def _distance_words(self) -> str:
        """That the critical load which ranks the inputs is far from the operating load."""
        margin = self.propagation.nominal.get(f"F/{self.decisive}", math.nan)
        ranks = self.moved and self.decisive in CRITICAL
        if not ranks or not 0 < margin < math.inf:
            return ""
        if 1 / FAR <= margin <= FAR:
            return ""
        critical = self.propagation.nominal[self.decisive]
        load = value_of(critical * self.propagation.contact.E_ss, "Pa")
        return (
            f"{self.decisive} is far from this load, which is {times(margin)} {self.decisive} "
            f"({load}): the ranking is of the inputs at {load}, and does not say what decides here."
        )

    @property
    def fixed_numbers(self) -> tuple[str, ...]:
        """Inputs that say how many particles there are and have no range."""
        return tuple(name for name in self.exact if name.endswith(".areal_density"))

    def fixed_numbers_words(self) -> str:
        """That bands and ranking leave out what the number of particles moves."""
        if not (names := self.fixed_numbers):
            return ""
        return (
            "The number of particles was held fixed, so that probabilities, bands and "
            f"rankings leave out what it moves: give {join_words(names)} a range to take it in."
        )

    def _may_be_nearer(self, other: str) -> bool:
        """Whether a critical load outside the loads that are searched may be the nearest."""
        nominal = self.propagation.nominal
        load, decisive = nominal["F_star"], nominal.get(self.decisive, math.nan)
        edge = {0.0: WINDOW[0], math.inf: WINDOW[1]}.get(nominal.get(other, math.nan))
        if edge is None or not (0 < decisive < math.inf and load > 0):
            return False
        return abs(math.log(edge / load)) < abs(math.log(decisive / load))

    @property
    def called(self) -> str:
        """What inputs are ranked by: the symbol of a critical load, others in words."""
        return self.decisive if self.decisive in CRITICAL else OUTPUTS[self.decisive].meaning

    def load_changes(self) -> list[tuple[float, str]]:
        """Loads [Pa] at which the mode changes, and the mode beyond."""
        propagation = self.propagation
        out = []
        for name, modes in (("F_cr1", ("p-s", "hybrid")), ("F_cr2", ("hybrid", "s-s"))):
            critical = propagation.nominal.get(name, math.nan)
            if 0 < critical < math.inf and self.mode in modes:
                other = modes[0] if critical < propagation.nominal["F_star"] else modes[1]
                out.append((critical * propagation.contact.E_ss, other))
        return out

    def _ways(self) -> tuple[str, ...]:
        propagation = self.propagation
        out = []
        for load, other in self.load_changes():
            ratio = load / propagation.contact.E_ss / propagation.nominal["F_star"]
            out.append(
                f"The load would have to {'fall' if ratio < 1 else 'rise'} to "
                f"{value_of(load, 'Pa')} ({times(ratio)} the operating load) for {other}."
            )
        for change in self.changes:
            unit, value = (
                unit_of(propagation.contact, change.input),
                _nominal(propagation, change.input),
            )
            word = "falling" if change.value < value else "rising"
            where = ": outside its range"
            if change.beyond >= RARE:
                where = f": it is there or beyond in {percent(change.beyond)} of cases"
            out.append(
                f"{_upper(self._words(change.input))} {word} from "
                f"{span(value, change.value, unit)} makes it {change.mode}"
                f"{where if propagation.inputs else ''}."
            )
        out += self.stops_words()
        changed = {change.input for change in self.changes} | {stop.input for stop in self.stops}
        still = [
            label
            for label in propagation.inputs
            if label not in changed and label != propagation.load
        ]
        if still:
            named = _upper("; ".join(map(self._words, still)))
            out.append(
                f"{named}: no change of mode within a factor of {number(FAR)}, the other "
                "inputs as they are."
            )
        return tuple(out)

    def stops_words(self) -> list[str]:
        """Sentences on inputs whose search for another mode ends before a factor of 10."""
        out = []
        for stop in self.stops:
            unit, value = (
                unit_of(self.propagation.contact, stop.input),
                _nominal(self.propagation, stop.input),
            )
            word = "falling" if stop.value < value else "rising"
            at = f" from {span(value, stop.value, unit)}" if stop.value != value else ""
            out.append(
                f"{_upper(self._words(stop.input))} {word}{at}: no change of mode; what lies "
                f"beyond is not known, as that contact is refused ({stop.why})."
            )
        return out

    def basis(self) -> tuple[str, ...]:
        """Sentences on the laws, ranges and sources of the assessment."""
        from ..version import __version__

        propagation = self.propagation
        sought = f" and {propagation.critical_samples} of the critical loads"
        out = [
            f"{propagation.samples} samples of the state"
            f"{sought if propagation.critical_samples else ''} "
            f"(scrambled Sobol points, seed {propagation.seed}); inputs independent of each "
            f"other; thirdbody {__version__}."
        ]
        if not propagation.inputs:
            out = [f"The values of the study, taken as exactly known; thirdbody {__version__}."]
        elif self.exact:
            out.append(f"Taken as exactly known: {'; '.join(map(self._words, self.exact))}.")
        return (*out, *self.notes)

    # ------------------------------------------------------------------ terminal
    def page(self, more: str = WIDER) -> Any:
        """The page for a terminal, to print by rich; ``more`` is how to see what has no room."""
        legend = {"elasticity": ELASTICITY.format(self.called)}
        return terminal_page(self.title or "Assessment", self.sections(), more, legend)


WORDS = ("where", "result", "input", "what alone changes")
"""Columns of words, which may break."""


def terminal_page(title: str, sections: list[Section], more: str, legend: dict[str, str]) -> object:
    """A page for a terminal."""
    from rich.console import Group

    parts: list[Any] = [title]
    for section in sections:
        parts += ["", section.title.upper()]
        if section.rows:
            words = [section.head[0], *(head for head in section.head if head in WORDS)]
            table = Table(
                section.head, right=True, words=words, drop=section.drop, more=more, legend=legend
            )
            for row in section.rows:
                table.add_row(*row)
            parts.append(table)
        parts += section.sentences
    return Group(*parts)


ELASTICITY = "relative change of {} for that of the input, no unit"
NO_RANGES = (
    "No ranges of the inputs were given and the materials library states none for these bodies, so "
    "no probability can be told; a table [uncertainty] in the study says what is uncertain."
)
"""What stands for probabilities where nothing is uncertain."""
NO_CRITICAL = (
    "No critical loads: with {} as the law of the particles, the load need not fall as the "
    "separation grows, so that several separations may carry one load and the mode may change "
    "more than once; the bands of the state below hold, and `transitions` seeks the critical "
    "loads of single contacts."
)
"""What stands for the margins of a law whose load does not tell its separation."""


def _upper(text: str) -> str:
    return text[:1].upper() + text[1:]


def _law_of(propagation: Propagation) -> str:
    return type(propagation.contact.particle_law).__name__


def _amount(value: float, name: str) -> str:
    if name in CRITICAL:
        return critical_load(value)
    unit = about_result(name).unit
    return percent(value) if unit == "1" and name in OUTPUTS else value_of(value, unit)


def _error(error: float, name: str) -> str:
    unit = about_result(name).unit
    share = unit == "1" and name in OUTPUTS and name not in CRITICAL
    return percent(error, digits=1) if share else value_of(error, unit, 1)


def unit_of(contact: Contact, label: str) -> str:
    """The unit of an uncertain input."""
    units = {"pressure": "Pa", "F_star": "1", "d": "m"}
    return units.get(label) or declared_quantity(contact, label.split("+")[0])["unit"]


def _nominal(propagation: Propagation, label: str) -> float:
    if label == propagation.load:
        return float(propagation.loads)
    return all_inputs(propagation.contact)[label.split("+")[0].strip()]
