"""An oil or a dry contact over time whose numbers are uncertain: bands of many histories."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..analysis.uncertainty.inputs import Uncertain
from ..contact.contact import Contact
from ..errors import InvalidValue, Mistake, Problem, RangeWarning
from ..numerics.sampling import sobol
from ..populations.measured.cleanliness import iso4406_of_counts
from ..quantities.carried import takes_units
from ..quantities.progress import Report, reporting
from ..quantities.record import Record
from ..quantities.say import number, value_of
from ..systems.life.circuit import OilCircuit
from ..systems.life.contact_history import DryHistory
from ..systems.life.debris import Debris
from ..systems.life.history import LifeHistory
from ..systems.life.ingress import Ingress
from ..systems.life.kept_rates import plain_inputs
from ..systems.life.oil_history import need_oil_left, run_oil_history
from ..systems.life.run import life
from ..systems.life.until import Until
from .life_kept import KeptEnds
from .life_uncertainty import about_circuit, place_of_beta, with_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    *("End", "LifeBands", "Swing", "check_dry", "check_oil", "is_of_contact"),
    *("propagate_dry", "propagate_life"),
]

INGRESS = "ingress"
"""The name of a factor on all that enters an oil [1]."""
ARRIVALS = "arrivals"
"""The name of a factor on all that arrives in a dry contact [1]."""
HARDNESS = "debris.hardness"
"""The name of the hardness of the debris [Pa]; each needs tables of its own, some seconds."""
OF_CONTACT = (
    "entry_ratio",
    "load",
    "speed",
    "slide_roll",
    "contacts",
    "particle_friction",
    "stays",
)
"""Conditions of a contact in an oil that may be uncertain."""
OF_DRY = ("pressure", "sliding_speed", "length", "area", "loss", "stays")
"""Conditions of a dry contact that may be uncertain."""
PARTS = ("surfaces", "roughness", "asperity_law", "outputs")
"""Fields of a contact whose numbers may be uncertain; each set needs tables of its own."""
PROBABILITIES = (0.05, 0.5, 0.95)
SAMPLES, SAMPLES_OF_CONTACT = 256, 64
"""Histories, of an oil alone and with a contact, where nobody says how many."""
EMPTYING = ("leak", "volume", "make_up")
"""Numbers of a circuit with which a leak may empty it."""
HOUR = 3600.0
JAM = "jam"
COUNT, WEAR = "count from 6 µm", "wear depth"
"""What the swings are of."""


class End(NamedTuple):
    """What one history ends with."""

    counts: tuple[float, ...]
    """From 4, 6 and 14 µm(c) [1/m³]; empty of a dry contact."""
    wear: float
    """Depth of the surface that is worn deeper [m]; NaN of an oil alone."""
    R0: float
    """Particles bred by one [1]; NaN where it is not known."""
    times: dict[str, float]
    """When each event came [s]; only of those that came."""


class Swing(NamedTuple):
    """What one input alone moves; in ``swings`` of `LifeBands`."""

    name: str
    """Of the input."""
    low: float
    """Count from 6 µm(c) [1/m³], or wear depth [m], with the input at its lowest probability."""
    high: float
    """The same at its highest."""

    @property
    def factor(self) -> float:
        """The larger over the smaller [1]."""
        ends = sorted((self.low, self.high))
        return ends[1] / ends[0] if ends[0] > 0 else math.inf


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeBands(Record):
    """Bands over many histories; made by `propagate_life` and `propagate_dry`.

    Attributes
    ----------
    probabilities : tuple of float
        Of the quantiles [1].
    samples : int
        Sets of inputs.
    duration : float
        [s].
    counts : array (Q, 3)
        Quantiles of the counts at the end from 4, 6 and 14 µm(c) [1/m³]; (Q, 0) of a dry contact.
    codes : tuple of str
        Their codes: each number is a quantile of its own.
    times : dict of str to array (Q,)
        Quantiles of the time at which each event comes [s]; infinite, censored, where it had not
        come at the end in so many of the sets.
    reached : dict of str to float
        In which part of the sets it came [1].
    swings : tuple of Swing
        What each input moves alone, the most first.
    swings_of : str
        What they are of: "count from 6 µm" or "wear depth".
    wear : array (Q,)
        Quantiles of the depth of the surface that is worn deeper [m]; NaN of an oil alone.
    R0 : array (Q,)
        Quantiles of the particles bred by one [1]; NaN of an oil alone, and where too few are
        known.
    """

    probabilities: tuple[float, ...]
    samples: int
    duration: float
    counts: Array
    codes: tuple[str, ...]
    times: Mapping[str, Array]
    reached: Mapping[str, float]
    swings: tuple[Swing, ...]
    swings_of: str
    wear: Array
    R0: Array

    def count_missed(self, name: str) -> int:
        """Sets in which an event did not come.

        Parameters
        ----------
        name : str
            Of the event.
        """
        return round(self.samples * (1 - self.reached[name]))


def _number_of(circuit: OilCircuit, name: str) -> object:
    """What a name stands for in a circuit."""
    if (place := place_of_beta(circuit, name)) is not None:
        return circuit.filters[place[0]].betas[place[1]]
    return circuit.value_at(name)


def _check(
    circuit: OilCircuit, vary: Mapping[str, Uncertain], contact: Mapping[str, Any] | None
) -> None:
    """Refuse what is no number of the circuit or of its contacts."""
    problems = (
        []
        if vary
        else [Problem("vary", "must name a number that is uncertain", code=Mistake.EMPTY)]
    )
    for name, uncertain in vary.items():
        if name in (*OF_CONTACT, HARDNESS) and contact is not None:
            problems += _problems_of_condition(name, uncertain, contact)
            continue
        if not isinstance(uncertain, Uncertain):
            problems.append(Problem(name, "must be Uncertain", repr(uncertain), code=Mistake.KIND))
            continue
        if name == INGRESS:
            if not uncertain.quantile(1e-9) >= 0:
                problems.append(
                    Problem(
                        name, "is a factor on all that enters and must be >= 0", code=Mistake.RANGE
                    )
                )
            continue
        if contact is not None and is_of_contact(name):
            problems += _problems_of_part(name, uncertain, contact["contact"])
            continue
        try:
            if not isinstance(_number_of(circuit, name), float):
                problems.append(
                    Problem(name, "is not a number of the circuit", code=Mistake.UNKNOWN)
                )
                continue
            if place_of_beta(circuit, name) is not None:
                continue
        except InvalidValue as error:
            problems += list(error.problems)
    problems += _problems_of_betas(circuit, vary)
    if problems:
        raise InvalidValue(*problems)


class _Drawing(NamedTuple):
    """Sets of inputs: those drawn, and each input alone at its ends."""

    vary: Mapping[str, Uncertain]
    samples: int
    seed: int
    probabilities: tuple[float, ...]
    """Of the quantiles [1]; the outer two are the ends."""

    def sets(self) -> list[dict[str, float]]:
        """The numbers of each set: first those drawn."""
        names, ends = list(self.vary), (min(self.probabilities), max(self.probabilities))
        points = sobol(self.samples, len(names), self.seed, 0, self.samples)
        sets = [
            {n: float(self.vary[n].quantile(float(u))) for n, u in zip(names, point, strict=True)}
            for point in points
        ]
        return sets + [{name: float(self.vary[name].quantile(p))} for name in names for p in ends]


def check_oil(
    circuit: OilCircuit,
    *,
    vary: Mapping[str, Uncertain],
    duration: float,
    contact: Mapping[str, Any] | None = None,
    samples: int | None = None,
    seed: int = 0,
    probabilities: Sequence[float] = PROBABILITIES,
) -> None:
    """Refuse what is no number of an oil, and sets drawn of them that no oil can have.

    Parameters
    ----------
    circuit, vary, duration, contact, samples, seed, probabilities
        As in `propagate_life`.

    Raises
    ------
    InvalidValue
    """
    _check(circuit, vary, contact)
    count = samples or (SAMPLES if contact is None else SAMPLES_OF_CONTACT)
    of_circuit = {name: uncertain for name, uncertain in vary.items() if _is_of_circuit(name)}
    if not of_circuit:
        return
    sets = [
        {name: value for name, value in drawn.items() if name in of_circuit}
        for drawn in _Drawing(vary, count, seed, tuple(probabilities)).sets()
    ]
    wrong: dict[str, tuple[int, Problem]] = {}
    for values in filter(None, sets):
        for name, problem in _problem_of_set(circuit, values, duration):
            before = wrong.get(name, (0, problem))
            wrong[name] = (before[0] + 1, before[1])
    if wrong:
        raise InvalidValue(
            *(
                Problem(
                    name,
                    problem.rule,
                    problem.value,
                    hint=f"so it is in {times} of {len(sets)} sets that are drawn",
                    code=problem.code,
                )
                for name, (times, problem) in wrong.items()
            )
        )


def _is_of_circuit(name: str) -> bool:
    return name not in (*OF_CONTACT, HARDNESS) and not is_of_contact(name)


def _problem_of_set(
    circuit: OilCircuit, values: Mapping[str, float], duration: float
) -> list[tuple[str, Problem]]:
    """What is wrong with a set: the name of an input, and why; one at most."""
    whole = _problem_of(circuit, values, duration)
    if whole is None:
        return []
    for name, value in values.items():
        if (problem := _problem_of(circuit, {name: value}, duration)) is not None:
            return [(name, problem)]
    name = next((key for key in values if key in EMPTYING), next(iter(values)))
    return [(name, whole)]


def _problem_of(
    circuit: OilCircuit, values: Mapping[str, float], duration: float
) -> Problem | None:
    """Why a circuit cannot be with some values."""
    name = next((key for key in values if key in EMPTYING), next(iter(values)))
    about = about_circuit(circuit, name)
    value = value_of(values[name], "1" if about is None else about["unit"], 3)
    try:
        changed = with_numbers(circuit, values)
    except InvalidValue as error:
        return error.problems[0].changed(value=value)
    try:
        need_oil_left(changed, duration)
    except InvalidValue:
        rule = f"lets the leak empty the circuit within {number(duration / HOUR, 5)} h"
        return Problem(name, rule, value, code=Mistake.RANGE)
    return None


def _problems_of_betas(circuit: OilCircuit, vary: Mapping[str, Any]) -> Iterator[Problem]:
    """Why β ratios cannot be varied so: below 1, or with one that may fall towards larger sizes."""
    names = {place_of_beta(circuit, name): name for name in vary}
    for f, oil_filter in enumerate(circuit.filters):
        before, whose = 1.0, "the least there is"
        for i, (size, beta) in enumerate(zip(oil_filter.sizes, oil_filter.betas, strict=True)):
            name, low, high = names.get((f, i)), beta, beta
            if name is not None and isinstance(vary[name], Uncertain):
                low, high = (float(vary[name].quantile(end)) for end in (0.0, 1.0))
            if low < before * (1 - 1e-6):
                if name is not None:
                    rule = f"may be as low as {number(low, 4)}, below {number(before, 4)}, {whose}"
                else:
                    name = names.get((f, i - 1), "")
                    at = value_of(size, "m")
                    rule = (
                        f"may be as high as {number(before, 4)}, above {number(low, 4)}, β at {at}"
                    )
                yield Problem(
                    name, f"{rule}; β must not fall towards larger sizes", code=Mistake.ORDER
                )
            before, whose = high, f"β at {value_of(size, 'm')}"


def is_of_contact(name: str) -> bool:
    """Whether a name is that of a number inside a contact, "roughness.sigma"."""
    return "." in name and name.partition(".")[0] in PARTS


def _problems_of_part(name: str, uncertain: object, contact: Contact) -> list[Problem]:
    """Why a number inside a contact cannot be varied so."""
    if not isinstance(uncertain, Uncertain):
        return [Problem(name, "must be Uncertain", repr(uncertain), code=Mistake.KIND)]
    try:
        if not isinstance(contact.value_at(name), float | int):
            return [Problem(name, "is not a number of the contact", code=Mistake.UNKNOWN)]
        for end in (1e-9, 1 - 1e-9):
            contact.replace(**{name: uncertain.quantile(end)})
    except InvalidValue as error:
        return list(error.problems)
    return []


def _contact_with(contact: Contact, values: dict[str, float]) -> Contact:
    """A contact with some of its numbers changed, which are taken out of the values."""
    changes = {name: values.pop(name) for name in list(values) if is_of_contact(name)}
    return contact.replace(**changes) if changes else contact


def _problems_of_condition(
    name: str, uncertain: object, conditions: Mapping[str, object]
) -> list[Problem]:
    """Why a condition of a contact cannot be varied so."""
    if not isinstance(uncertain, Uncertain):
        return [Problem(name, "must be Uncertain", repr(uncertain), code=Mistake.KIND)]
    if name == HARDNESS and conditions.get("debris") is None:
        return [Problem(name, "needs debris", code=Mistake.MISSING)]
    ends = uncertain.quantile(1e-9), uncertain.quantile(1 - 1e-9)
    low, high = float(ends[0]), float(ends[1])
    if low < 0 or (low == 0 and name not in ("loss", "stays", "slide_roll")):
        return [Problem(name, "must be above 0 throughout", code=Mistake.RANGE)]
    if name in ("loss", "stays") and high > 1:
        return [Problem(name, "must be at most 1 throughout [1]", code=Mistake.RANGE)]
    return []


def _with_hardness(arguments: Mapping[str, object], values: dict[str, float]) -> dict[str, Any]:
    """Arguments of a contact with some of its numbers changed."""
    out = dict(arguments)
    if HARDNESS in values:
        debris = arguments["debris"]
        assert isinstance(debris, Debris)
        out["debris"] = debris.replace(hardness=values.pop(HARDNESS))
    return out | values


def _end_of(history: LifeHistory | DryHistory) -> End:
    counts = history.counts[-1].tolist() if isinstance(history, LifeHistory) else ()
    depths = [history.more[n][1][-1] for n in ("wear_1", "wear_2") if n in history.more]
    times: dict[str, float] = {}
    for event in history.events:
        times.setdefault(event.name, event.time)
    wear = float(max(depths)) if depths else math.nan
    return End(tuple(counts), wear, float(history.R0) if depths else math.nan, times)


@takes_units
def propagate_life(
    circuit: OilCircuit,
    *,
    vary: Mapping[str, Uncertain],
    duration: float,
    until: Sequence[Until] = (),
    contact: Mapping[str, Any] | None = None,
    samples: int | None = None,
    seed: int = 0,
    probabilities: Sequence[float] = PROBABILITIES,
    progress: bool | Report = False,
    keep: Path | str | None = None,
) -> LifeBands:
    """Bands of an oil over time, from what is known of its numbers.

    Parameters
    ----------
    circuit : OilCircuit
    vary : mapping of str to Uncertain
        Numbers of the circuit, "volume", "filters.0.service", "filters.0.beta.7 um", a β ratio, and
        "ingress", a factor on all that enters. With a contact "entry_ratio", "load", "speed",
        "slide_roll", "contacts", "particle_friction", "stays" and "debris.hardness", and numbers
        inside it, "roughness.sigma", "outputs.wear.f_ab", too.
    duration : float
        How long [s].
    until : sequence of Until, optional
        Events whose times are asked; none of them ends a history.
    contact : mapping, optional
        Arguments of `thirdbody.life` for contacts in the oil: "contact", "conjunction", "load" ...
    samples : int, optional
        Sets of inputs, the same for all times [1]: 256, with a contact 64, where it is not given.
    seed : int, optional
        Of the drawing.
    probabilities : sequence of float, optional
        Of the quantiles [1].
    progress : bool or callable, optional
        True shows on standard error how many histories are done; a callable gets the number.
    keep : path-like, optional
        A file that keeps the end of every history; the same call goes on with it.

    Returns
    -------
    LifeBands

    Raises
    ------
    InvalidValue
        What is no number of the circuit, or a range beyond what it may be.

    Notes
    -----
    An event that does not come is censored: its time is beyond the duration, nobody knows by how
    much. Quantiles bear that; a mean does not, and none is given. A history that ends in a jam
    keeps its wear from there on, too small.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.study.life_bands import propagate_life
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.oil.Ingress.from_counts(sizes=[4e-6, 6e-6], counts=[1e6, 3e5],
    ...                                        material=quartz),
    ...     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> found = propagate_life(oil, vary={"ingress": tb.Uncertain.lognormal(median=1, gsd=2)},
    ...                        duration=36000.0, samples=64)
    >>> [code.split("/")[0] for code in found.codes]
    ['16', '17', '19']
    """
    count = samples or (SAMPLES if contact is None else SAMPLES_OF_CONTACT)
    check_oil(
        circuit, vary=vary, duration=duration, contact=contact, samples=count, seed=seed,
        probabilities=probabilities,
    )  # fmt: skip
    waits = tuple(event.replace(stops=False) for event in until)
    shared: dict[str, Any] = {"duration": duration, "until": waits, "times": [0.0, duration]}

    def end(values: Mapping[str, float]) -> End:
        if contact is None:
            return _end_of(run_oil_history(with_numbers(circuit, values), **shared))
        rest = dict(values)
        changed = _contact_with(contact["contact"], rest)
        conditions = {name: rest.pop(name) for name in (*OF_CONTACT, HARDNESS) if name in rest}
        arguments = _with_hardness(contact, conditions) | {"contact": changed}
        return _end_of(life(**arguments, oil=with_numbers(circuit, rest), **shared))

    return _bands(
        end, _Drawing(vary, count, seed, tuple(probabilities)), waits, duration=duration,
        swings_of=COUNT, progress=progress, keep=keep,
        inputs={"oil": circuit.to_dict(), "contact": plain_inputs(contact or {})},
    )  # fmt: skip


def check_dry(
    contact: Contact, *, vary: Mapping[str, Uncertain], conditions: Mapping[str, Any]
) -> None:
    """Refuse what is no number of a dry contact, or a range beyond what it may be.

    Parameters
    ----------
    contact, vary, conditions
        As in `propagate_dry`.

    Raises
    ------
    InvalidValue
    """
    names = (ARRIVALS, *OF_DRY, HARDNESS)
    problems = (
        []
        if vary
        else [Problem("vary", "must name a number that is uncertain", code=Mistake.EMPTY)]
    )
    for name, uncertain in vary.items():
        if is_of_contact(name):
            problems += _problems_of_part(name, uncertain, contact)
        elif name not in names:
            problems.append(
                Problem(name, f"must be one of {', '.join(names)}", code=Mistake.UNKNOWN)
            )
        else:
            problems += _problems_of_condition(name, uncertain, conditions)
    if problems:
        raise InvalidValue(*problems)


@takes_units
def propagate_dry(
    contact: Contact,
    *,
    vary: Mapping[str, Uncertain],
    duration: float,
    conditions: Mapping[str, Any],
    until: Sequence[Until] = (),
    samples: int | None = None,
    seed: int = 0,
    probabilities: Sequence[float] = PROBABILITIES,
    progress: bool | Report = False,
    keep: Path | str | None = None,
) -> LifeBands:
    """Bands of a dry contact over time, from what is known of its numbers.

    Parameters
    ----------
    contact : Contact
    vary : mapping of str to Uncertain
        "arrivals", a factor on all that arrives, "loss", "stays", "pressure", "sliding_speed",
        "length", "area", "debris.hardness", and numbers inside the contact, "outputs.wear.f_ab".
    duration : float
        How long [s].
    conditions : mapping
        Arguments of `thirdbody.life` for a dry contact, debris and running-in with them.
    until, samples, seed, probabilities, progress, keep
        As in `propagate_life`.

    Returns
    -------
    LifeBands

    Raises
    ------
    InvalidValue
        What is no number of the contact, or a range beyond what it may be.
    """
    check_dry(contact, vary=vary, conditions=conditions)
    waits = tuple(event.replace(stops=False) for event in until)

    def end(values: Mapping[str, float]) -> End:
        changes = dict(values)
        factor = changes.pop(ARRIVALS, 1.0)
        changed = _contact_with(contact, changes)
        arguments = _with_hardness(conditions, changes)
        some = arguments.get(ARRIVALS, ())
        some = (some,) if isinstance(some, Ingress) else tuple(some)
        arguments[ARRIVALS] = tuple(ingress.replace(rate=factor * ingress.rate) for ingress in some)
        shared: dict[str, Any] = {"duration": duration, "until": waits, "times": [0.0, duration]}
        return _end_of(life(changed, **arguments, **shared))

    count = samples or SAMPLES_OF_CONTACT
    return _bands(
        end, _Drawing(vary, count, seed, tuple(probabilities)), waits, duration=duration,
        swings_of=WEAR, progress=progress, keep=keep,
        inputs={"contact": contact.to_dict(), "conditions": plain_inputs(conditions)},
    )  # fmt: skip


def _bands(
    end: Callable[[Mapping[str, float]], End],
    drawing: _Drawing,
    waits: Sequence[Until],
    *,
    duration: float,
    swings_of: str,
    progress: bool | Report,
    keep: Path | str | None,
    inputs: Mapping[str, object],
) -> LifeBands:
    """Ends of all sets of inputs, and of each input alone at its ends."""
    vary, samples, seed, probabilities = drawing
    sets = drawing.sets()
    all_inputs = dict(inputs) | {
        "vary": {name: repr(uncertain) for name, uncertain in vary.items()},
        "until": [event.to_dict() for event in waits],
        "numbers": [duration, samples, seed, *probabilities],
    }
    kept = KeptEnds(None if keep is None else Path(keep), all_inputs)
    ends = []
    with (
        warnings.catch_warnings(),
        reporting("life", len(sets), kept.count, progress, "histories") as report,
    ):
        warnings.simplefilter("ignore", RangeWarning)  # they stand in the history of the study
        for i, values in enumerate(sets):
            if (outcome := kept.get(i)) is None:
                outcome = kept.add(i, end(values)._asdict())
            ends.append(End(**outcome))
            report(i + 1)
    drawn = ends[:samples]
    swung = [_value_of_end(outcome, swings_of) for outcome in ends[samples:]]
    swings = [Swing(name, *swung[2 * i : 2 * i + 2]) for i, name in enumerate(vary)]
    counts = np.quantile(
        np.array([outcome.counts for outcome in drawn]).reshape(samples, -1), probabilities, axis=0,
        method="hazen",
    )  # fmt: skip
    events = sorted({event.name for event in waits})
    events += [JAM] if any(JAM in outcome.times for outcome in drawn) else []
    times = {name: [outcome.times.get(name, math.inf) for outcome in drawn] for name in events}
    return LifeBands(
        probabilities=probabilities,
        samples=samples,
        duration=duration,
        counts=counts,
        codes=tuple(iso4406_of_counts(row) for row in counts if len(row)),
        times={
            name: np.quantile(np.array(some), probabilities, method="inverted_cdf")
            for name, some in times.items()
        },
        reached={name: float(np.mean(np.isfinite(some))) for name, some in times.items()},
        swings=tuple(sorted(swings, key=lambda swing: -swing.factor)),
        swings_of=swings_of,
        wear=_quantiles([outcome.wear for outcome in drawn], probabilities),
        R0=_quantiles([outcome.R0 for outcome in drawn], probabilities),
    )


def _value_of_end(end: End, of: str) -> float:
    return end.wear if of == WEAR else end.counts[1]


def _quantiles(values: Sequence[float], probabilities: Sequence[float]) -> Array:
    """Quantiles; NaN where one of the values is not known."""
    if any(math.isnan(value) for value in values):
        return np.full(len(probabilities), math.nan)
    return np.quantile(np.array(values), probabilities, method="hazen")
