"""An oil over time in words: codes, time scales, flows of dirt, what was not known."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..populations.measured.cleanliness import counted_sizes
from ..quantities.say import join_words, number, percent, value_of
from ..systems.life.circuit import LEAKED, SETTLED
from ..systems.life.contact_history import ContactHistory, DryHistory, SteadyContact
from ..systems.life.history import LifeHistory
from ..systems.life.report_notes import below_counts, beyond_counts, zero_counts
from ..systems.life.sizing import least_flow
from .life_amounts import duration_of, flows_of, mass_of, masses_of
from .life_dents_words import dent_answer

if TYPE_CHECKING:
    from ..study.life_bands import LifeBands
    from ..study.run_dry import DryResult
    from ..study.run_life import LifeResult
    from ..systems.life.history import SteadyOil
    from ..systems.life.reports import OilReports

__all__ = [
    *("HEADS", "MEANS", "REPORT_HEADS", "REPORT_MEANS"),
    *("answer", "band_words", "events", "facts", "hidden_words", "in_vain", "last_words", "stop"),
    *("least_flow_words", "report_answer", "report_rows", "rows", "slow_words"),
    "words_of_bands",
]

HEADS = ("time", "ISO 4406", "from 4 µm", "from 6 µm", "from 14 µm", "dirt")
MEANS = {
    "from 4 µm": "particles per mL of oil",
    "dirt": "mass of particles per volume of oil",
}
REPORT_HEADS = ("from", "particles enter", "lowest", "highest")
REPORT_MEANS = {
    "from": "size from which is counted",
    "lowest": "end of the band in which it lies nine times of ten",
}
SIZES = ("4 µm", "6 µm", "14 µm")
LARGEST_FLOWS = 3
RISES = 1.5
"""Factor by which dirt grows while its code stays, from which on it is told."""
MOST_TIMES, MOST_EVENTS = 4, 6
"""Times of one kind of event that are listed, and kinds of events."""


def answer(result: LifeResult) -> list[str]:
    """How dirty the oil becomes, what it tends to, and where most of its dirt goes."""
    history = result.history
    end = duration_of(float(history.times[-1]))
    out = [f"The oil goes from {history.codes[0]} to {history.codes[-1]} in {end}."]
    if stopped := stop(result):
        out[0] = f"{stopped}: the oil has gone from {history.codes[0]} to {history.codes[-1]}."
    out += [sentence for sentence in (in_vain(result), _tends(history)) if sentence]
    said = history.reproduction
    out.append(f"{said[0].upper()}{said[1:]}.")
    out.append(_largest_flows(history))
    return [*out, *dent_answer(result.dents)]


def stop(result: LifeResult | DryResult) -> str:
    """What ended the history before its time, and when."""
    history = result.history
    if history.times[-1] >= result.asked.duration * (1 - 1e-12) or not history.events:
        return ""
    last = history.events[-1]
    return f"After {duration_of(last.time)} {last.sentence}"


def in_vain(result: LifeResult | DryResult) -> str:
    """What a history waited for to its end, and did not come."""
    if stop(result):
        return ""
    came = {event.sentence for event in result.history.events}
    lacks = [goal.sentence for goal in result.asked.until if goal.sentence not in came]
    end = duration_of(result.asked.duration)
    return f"Within {end} it does not happen that {join_words(lacks)}." if lacks else ""


def _tends(history: LifeHistory) -> str:
    """What the oil comes to, and how soon."""
    steady: Sequence[SteadyOil | SteadyContact] = history.steady()
    if isinstance(history, ContactHistory):
        steady = steady or LifeHistory.steady(history)  # what grows for ever stands there
    if not steady:
        return "It comes to no state in which it no longer changes."
    code = steady[0].code
    times = dict(zip(SIZES, history.code_times, strict=True))
    ends = {size: time for size, time in times.items() if math.isfinite(time)}
    if "-" not in code:
        out = f"With this ingress and these filters it ends at {code}"
        if not any(ends.values()):
            return f"{out}, and is there from the beginning."
        out += f", and is within half a number of it after {_each_time(ends)}."
        out += _bypass_sentence(history)
    else:
        grow = [size for digits, size in zip(code.split("/"), SIZES, strict=True) if digits == "-"]
        out = (
            f"The count from {join_words(grow)} on grows for ever: nothing takes the smallest of "
            "these particles out"
        )
        if len(grow) < len(SIZES):
            out += f", and the code ends at {code}"
            out += f", within half a number after {_each_time(ends)}" if any(ends.values()) else ""
        out += "."
    return out


def _bypass_sentence(history: LifeHistory) -> str:
    """That the end is not that of an oil that goes past a full filter, where it does."""
    names = history.bypassed
    if not names:
        return ""
    if isinstance(history, ContactHistory):
        return f" That is as long as no filter is full; {join_words(names)} is."
    code = history.circuit.steady_code(full=names)
    return f" That is as long as no filter is full; past {join_words(names)} it goes to {code}."


def _each_time(times: Mapping[str, float]) -> str:
    """How long each count takes; once where all take as long."""
    words = {size: duration_of(time, 2) for size, time in times.items()}
    if len(set(words.values())) == 1:
        return next(iter(words.values()))
    return join_words([f"{time} (from {size} on)" for size, time in words.items()])


def slow_words(history: LifeHistory) -> list[str]:
    """Which small sizes go on when the code has long ended, and why."""
    slow = history.slow_sizes
    if slow is None:
        return []
    who = f"Particles below {value_of(slow.below, 'm', 3)}"
    if slow.below <= counted_sizes()[0] * (1 + 1e-9):
        who += ", which no number of the code counts,"
    held = "no filter holds them" if history.circuit.filters else "there is no filter"
    ways = {
        "": f"{held} and nothing else takes them out",
        SETTLED: f"{held} and they settle slowly",
        LEAKED: f"{held} and only the leak takes them out",
    }
    why = ways.get(slow.taken_by, f"{slow.taken_by} holds few of them")
    if math.isfinite(slow.time):
        said = f"{who} take far longer, {duration_of(slow.time, 2)}: {why}"
    else:
        said = f"{who} grow in number for ever: {why}"
    return [f"{said}{', until the oil is changed' if history.circuit.oil_changes else ''}."]


def hidden_words(history: LifeHistory) -> list[str]:
    """That the code does not see how the dirt grows, where that is so."""
    since = 1 + max((i for i, c in enumerate(history.codes) if c != history.codes[-1]), default=-1)
    classes, terms = history.terms.classes, history.terms
    unseen = classes.above(counted_sizes()[:1])[0] == 0
    dirt = history.mass_per_volume.sum(axis=1)
    small = np.einsum("tkm,km->t", history.numbers[:, unseen], terms.masses[unseen])
    grown = dirt[-1] - dirt[since]
    if not (dirt[-1] > RISES * dirt[since] and small[-1] - small[since] > 0.5 * grown):
        return []
    now, then = (number(1e3 * float(mass), 3) for mass in (dirt[since], dirt[-1]))
    return [
        f"The code stays at {history.codes[-1]} from {duration_of(float(history.times[since]))} on "
        f"while the dirt rises from {now} to {then} mg/L: it is in particles below "
        f"{value_of(counted_sizes()[0], 'm', 3)}, which the code does not count."
    ]


def _largest_flows(history: LifeHistory) -> str:
    """The largest flows of dirt."""
    some = [row for row in history.flows() if row[2] > 0][:LARGEST_FLOWS]
    if not some:
        return "No dirt moves."
    masses = masses_of([mass for _, _, mass in some])
    shown = [f"{m} from {start} to {end}" for m, (start, end, _) in zip(masses, some, strict=True)]
    return f"Most of the dirt: {join_words(shown)}."


def events(history: LifeHistory | DryHistory) -> list[str]:
    """What happened and when, a sentence for each kind; of many kinds the first and the last."""
    times: dict[str, list[str]] = {}
    for event in history.events:
        times.setdefault(event.sentence, []).append(duration_of(event.time))
    out = [f"After {_list_times(when)}: {what}." for what, when in times.items()]
    if len(out) <= MOST_EVENTS:
        return out
    return [*out[:3], f"... {len(out) - 4} more events ...", out[-1]]


def _list_times(times: list[str]) -> str:
    """Times in words, of many the first and the last."""
    if len(times) <= MOST_TIMES:
        return join_words(times)
    return f"{times[0]}, and {len(times) - 1} times more until {times[-1]}"


def rows(result: LifeResult) -> list[list[str]]:
    """The table: a row a time."""
    history = result.history
    dirt = history.mass_per_volume.sum(axis=1)
    out = []
    for i, time in enumerate(history.times):
        counts = [number(float(count) / 1e6, 3) for count in history.counts[i]]
        out.append(
            [
                duration_of(float(time)),
                history.codes[i],
                *counts,
                f"{number(1e3 * dirt[i], 3)} mg/L",
            ]
        )
    return out


def band_words(result: LifeResult | DryResult) -> list[str]:
    """Bands of code, wear and times, and what moves the answer most."""
    bands = result.bands
    return [] if bands is None else words_of_bands(bands)


def words_of_bands(bands: LifeBands) -> list[str]:
    """Bands of code, wear and times, and what moves the answer most.

    Parameters
    ----------
    bands : LifeBands
    """
    share = percent(max(bands.probabilities) - min(bands.probabilities))
    end = duration_of(bands.duration)
    out, opening = [], "With what is known of its numbers"
    if bands.codes:
        low, high = bands.codes[0], bands.codes[-1]
        out.append(f"{opening} the oil is at {low} to {high} after {end} ({share}).")
    if np.all(np.isfinite(bands.wear)):
        least, most = (value_of(float(w), "m", 3) for w in (bands.wear[0], bands.wear[-1]))
        worn = f"the surface that wears more is worn by {least} to {most}"
        out.append(
            f"{'By then' if out else opening} {worn}" + ("." if out else f" after {end} ({share}).")
        )
    if np.all(np.isfinite(bands.R0)) and np.any(bands.R0 > 0):
        least, most = (number(float(R0), 2) for R0 in (bands.R0[0], bands.R0[-1]))
        bred = "about 1 other" if least == most == "1" else f"{least} to {most} others"
        out.append(f"One particle of debris breeds {bred}.")
    for name, times in bands.times.items():
        first, last = (_time_or_censored(float(t), bands) for t in (times[0], times[-1]))
        came = percent(bands.reached[name])
        said = f"{name[0].upper()}{name[1:]}: after {first} to {last}; it comes in {came}"
        if missed := bands.count_missed(name):
            said += f", and in {missed} of {bands.samples} histories not by {end}"
        out.append(f"{said}.")
    most_of = bands.swings[0]
    out.append(
        f"Most uncertain: {most_of.name}, which alone moves the {bands.swings_of} by a factor of "
        f"{number(most_of.factor, 3)}."
    )
    return out


def _time_or_censored(seconds: float, bands: LifeBands) -> str:
    """A time, or how long nobody saw it come."""
    return (
        duration_of(seconds)
        if math.isfinite(seconds)
        else f"more than {duration_of(bands.duration)}"
    )


def least_flow_words(result: LifeResult, code: str) -> list[str]:
    """How much flow each filter needs for a code, a sentence each."""
    circuit = result.asked.circuit
    out = []
    for i, name in enumerate(circuit.filter_names()):
        if circuit.filters[i].line:
            continue
        flow = least_flow(circuit, code=code, which=i)
        if math.isnan(flow):
            out.append(f"No flow through {name} is enough for {code}: it holds too few of them.")
        elif flow == 0:
            out.append(f"The oil comes to {code} without {name} too.")
        else:
            enough = f"{number(6e4 * flow, 3)} L/min"
            out.append(f"A flow of {enough} through {name} is enough for {code}.")
    return out or [f"No filter of its own line can be sized for {code}."]


def last_words(result: LifeResult) -> list[str]:
    """Events, time scales, and what was not known."""
    history = result.history
    scales = [f"{name} {duration_of(time)}" for name, time in history.time_scales.items()]
    out = [*band_words(result), *hidden_words(history), *slow_words(history),
           *events(history)]  # fmt: skip
    if scales:
        out.append(f"Time scales: {', '.join(scales)}.")
    unknown = ["the ingress"]
    if any(oil_filter.service == 1 for oil_filter in history.circuit.filters):
        unknown.append("whether the filters hold in service what their data sheets say")
    out.append(
        f"What nobody can predict: {join_words(unknown)}. Vary them, or give reports of the oil: "
        "thirdbody life STUDY.toml --reports oil.csv."
    )
    return out


def facts(history: LifeHistory) -> dict[str, str]:
    """Named numbers of a history."""
    steady = history.steady()
    return {
        "at the end": history.codes[-1],
        "without end": steady[0].code if steady else "-",
        "dirt in the oil": mass_of(float(history.ledger.in_oil[-1])),
        "volume": f"{number(1e3 * float(history.volume[-1]), 3)} L",
    }


# ------------------------------------------------------------------------------ reports
def report_answer(reports: OilReports) -> list[str]:
    """What the reports say, in sentences."""
    best, low, high = flows_of([reports.mass_rate, reports.mass_low, reports.mass_high])
    first = value_of(float(reports.sizes[0]), "m")
    spread = "lies somewhere in the range of its code"
    if not reports.coded:
        spread = f"is off by a factor of at most {number(reports.width**0.5, 2)}"
    out = [
        f"Between the reports {best} of dirt from {first} on entered the oil: {low} to {high}, if "
        f"every count {spread}."
    ]
    more = (zero_counts(reports), below_counts(reports), beyond_counts(reports))
    out += [sentence for sentence in more if sentence is not None]
    if reports.is_constant is None:
        out.append("Two reports fit any ingress: whether it is constant, a third one says.")
    elif reports.is_constant:
        out.append(f"A constant ingress fits them ({_misfit(reports)}).")
    else:
        out.append(
            f"A constant ingress does not fit them ({_misfit(reports)}): it changed, or the "
            "filters do not hold what their data sheets say."
        )
    return out


def _misfit(reports: OilReports) -> str:
    degrees = "degree" if reports.degrees == 1 else "degrees"
    chi2, more = number(reports.chi2, 3), f"{reports.degrees} {degrees} of freedom"
    return f"χ² = {chi2} with {more}, as large by chance {percent(reports.probability, digits=2)}"


def report_rows(reports: OilReports) -> list[list[str]]:
    """A row a size."""
    return [
        [
            value_of(float(size), "m"),
            *(f"{number(60 * float(per_second), 3)} /min" for per_second in (rate, low, high)),
        ]
        for size, rate, low, high in zip(
            reports.sizes, reports.rate, reports.low, reports.high, strict=True
        )
    ]
