r"""The course of an oil alone: exact between events, however long that is.

.. math:: V n(t) = N_0 e^{-L\tau} + s\,V\tau\,\frac{1-e^{-(L+\dot V)\tau}}{(L+\dot V)\tau},
          \qquad d\tau = dt/V

Between two events sources and flows are constant and every class runs alone, so that nothing is
integrated step by step. A filter that is full, a change of oil and the end are found on the exact
course.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.arguments import need_positive
from ...quantities.carried import takes_units
from ...quantities.say import percent, value_of
from .circuit import OilCircuit, OilTerms
from .history import LifeEvent, LifeHistory
from .ledger import Ledger
from .linear_flow import Flowing, flowing
from .until import CodeReached, FilterFull, Until

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["run_oil_history", "usual_times"]


def __dir__() -> list[str]:
    return sorted(__all__)


POINTS = 120
"""Times of a history, evenly and in the logarithm each."""
AFTER = 8
"""Of the times after an event every so-manyth is kept."""
LONGEST = 1e12
"""The longest duration [s], some 30 000 years: beyond, events fall between two numbers."""
MOST_EVENTS = 1000
"""Events after which a history is given up."""


@takes_units
def usual_times(duration: float, *, shortest: float) -> Array:
    """Times at which a history is kept: half of them evenly, half in the logarithm [s].

    Parameters
    ----------
    duration : float
        [s].
    shortest : float
        The first step of the logarithm [s].
    """
    first = min(max(shortest, 1e-6 * duration), 0.1 * duration)
    even, log = np.linspace(0.0, duration, POINTS + 1), np.geomspace(first, duration, POINTS)
    log[-1] = duration
    return np.unique(np.concatenate([even, log]))


def kept_times(times: ArrayLike, *, duration: float) -> Array:
    """Times at which a history is asked for, increasing [s].

    Parameters
    ----------
    times : array
        As given [s].
    duration : float
        [s].

    Raises
    ------
    InvalidValue
        No times, or some that are not from 0 to the duration.
    """
    some = np.unique(np.asarray(times, float))
    if not len(some) or some[0] < 0 or some[-1] > duration or not np.all(np.isfinite(some)):
        raise InvalidValue(
            Problem("times", f"must lie from 0 to {duration:g} [s]", code=Mistake.RANGE)
        )
    return some


def need_duration(duration: float) -> None:
    """Refuse a duration that is none, or too long.

    Raises
    ------
    InvalidValue
    """
    need_positive(duration=duration)
    if duration > LONGEST:
        rule = f"must be at most {value_of(LONGEST, 's')}, some 30 000 years"
        raise InvalidValue(Problem("duration", rule, value_of(duration, "s"), code=Mistake.RANGE))


def need_oil_left(circuit: OilCircuit, duration: float) -> None:
    """Refuse a duration in which a leak empties a circuit.

    Raises
    ------
    InvalidValue
    """
    lost = circuit.leak - circuit.make_up
    if lost > 0 and circuit.volume / lost <= duration:
        rule = (
            f"must be below {value_of(circuit.volume / lost, 's', 3)}: then the leak has emptied "
            "the circuit"
        )
        raise InvalidValue(Problem("duration", rule, value_of(duration, "s"), code=Mistake.RANGE))


@dataclass
class _Stretch:
    """The oil from one event to the next, with constant sources and flows."""

    terms: OilTerms
    begin: float
    volume: float
    numbers: Array
    """In the oil at the beginning [1], (K, M)."""

    def state_after(self, time: ArrayLike) -> Flowing:
        """What is in the oil, and what has passed, a time [s] after the beginning."""
        return flowing(
            self.volume, numbers=self.numbers, growth=self.terms.growth, source=self.terms.source,
            loss=self.terms.loss, time=np.asarray(time, float)[..., None, None],
        )  # fmt: skip

    def volume_after(self, time: ArrayLike) -> Array:
        """Volume of the oil [m³]."""
        return self.volume + self.terms.growth * np.asarray(time, float)

    def counts_after(self, time: ArrayLike) -> Array:
        """Particles per volume from 4, 6 and 14 µm(c) [1/m³]."""
        per_volume = (
            self.state_after(time).numbers.sum(axis=-1) / self.volume_after(time)[..., None]
        )
        return self.terms.classes.counted(per_volume)

    def mass_removed(self, name: str, time: float) -> float:
        """Mass that one of its ways out has taken [kg]."""
        return float(
            np.sum(self.terms.removal[name] * self.state_after(time).passed * self.terms.masses)
        )


@dataclass
class _Accounts:
    """What came and went before the stretch that runs [kg], and the columns of the ledger."""

    came: dict[str, float]
    went: dict[str, float]
    columns: dict[str, list[Array]] = field(default_factory=dict)

    def add(self, stretch: _Stretch, times: Array) -> None:
        """Add the rows of some times of a stretch [s since its beginning]."""
        for name, values in self._since(stretch, times).items():
            before = self.came.get(name, self.went.get(name, 0.0))
            self.columns.setdefault(name, []).append(before + values)

    def close(self, stretch: _Stretch, time: float) -> None:
        """Book what a stretch has brought and taken until its end."""
        for name, values in self._since(stretch, np.array([time])).items():
            account = self.came if name in self.came else self.went
            if name in account:
                account[name] += float(values[0])

    def _since(self, stretch: _Stretch, times: Array) -> dict[str, Array]:
        terms, state = stretch.terms, stretch.state_after(times)
        out = {"in the oil": np.einsum("tkm,km->t", state.numbers, terms.masses)}
        brought = {"ingress": terms.ingress, "fresh oil": terms.make_up * terms.fresh}
        for name in self.came:
            out[name] = times * float(np.sum(brought[name] * terms.masses))
        for name in self.went:
            taken = terms.removal.get(name)
            out[name] = (
                np.zeros_like(times)
                if taken is None
                else np.einsum("tkm,km->t", state.passed, taken * terms.masses)
            )
        return out


DRAINED = "oil changes"
"""Name of what a change of oil takes out."""


class _Course:
    """The run of a history."""

    def __init__(self, circuit: OilCircuit, duration: float, until: Sequence[Until]) -> None:
        self.circuit, self.duration, self.until = circuit, duration, until
        self.full: set[str] = set()
        self.held = dict.fromkeys(circuit.filter_names(), 0.0)
        terms = circuit.terms()
        self.first = terms
        went = [*terms.removal, *([DRAINED] if circuit.oil_changes else [])]
        fresh = ["fresh oil"] if circuit.make_up > 0 or circuit.oil_changes else []
        self.accounts = _Accounts(dict.fromkeys(["ingress", *fresh], 0.0), dict.fromkeys(went, 0.0))
        self.events: list[LifeEvent] = []
        self.now = _Stretch(terms, 0.0, circuit.volume, circuit.volume * terms.start)
        self.changes = [t for t in circuit.oil_changes if t < duration]
        self.waiting = [goal for goal in until if isinstance(goal, CodeReached)]
        self.stopped = False

    # ---------------------------------------------------------------------- what comes next
    def next_event(self) -> tuple[float, Callable[[], None]]:
        """The time of the next event [s since the beginning of the stretch], and what it does."""
        end = (self.changes[0] if self.changes else self.duration) - self.now.begin
        does: Callable[[], None] = self._change if self.changes else self._end
        for name, oil_filter in zip(self.circuit.filter_names(), self.circuit.filters, strict=True):
            if oil_filter.capacity is None or name in self.full:
                continue
            left = oil_filter.capacity - self.held[name]

            def excess(t: float, name: str = name, left: float = left) -> float:
                return self.now.mass_removed(name, t) - left

            if excess(end) > 0:
                end = float(brentq(excess, 0.0, end, xtol=1e-9 * max(end, 1e-300), rtol=1e-12))
                does = partial(self._fill, name)
        for code in self.waiting:
            when = self._time_of(code, end)
            if when is not None and when < end:
                end, does = when, partial(self._reach, code)
        return end, does

    def _time_of(self, code: CodeReached, end: float) -> float | None:
        """When a code is reached [s since the beginning of the stretch]; None if it is not."""
        cleans = code.is_dirtier(self.now.terms.classes.counted(self.first.start.sum(axis=-1)))
        times = usual_times(end, shortest=1e-3 * end)

        def far(t: ArrayLike) -> Array:
            return code.distance(self.now.counts_after(t), cleans=cleans)

        reached = np.flatnonzero(far(times) >= 0)
        if not len(reached):
            return None
        place = int(reached[0])
        if place == 0:
            return 0.0
        low, high = times[place - 1 : place + 1]
        return float(brentq(lambda t: float(far(t)), low, high, xtol=1e-12 * high, rtol=1e-14))

    # ---------------------------------------------------------------------- what happens
    def _add_event(self, name: str, sentence: str) -> None:
        self.events.append(LifeEvent(self.now.begin, name, sentence))

    def _end(self) -> None:
        self.stopped = True

    def _reach(self, code: CodeReached) -> None:
        self.waiting.remove(code)
        self._add_event(code.name, code.sentence)
        self.stopped = self.stopped or code.stops

    def _fill(self, name: str) -> None:
        place = self.circuit.filter_names().index(name)
        oil_filter = self.circuit.filters[place]
        said = f"{name} is full with {value_of(oil_filter.capacity, 'kg', 3)}"
        self.held[name] = 0.0
        if oil_filter.when_full == "bypass":
            self.full.add(name)
            self.now.terms = self.circuit.terms(full=self.full, classes=self.first.classes)
            share = oil_filter.still_filtered
            past = "all of the oil" if share == 0 else f"{percent(1 - share)} of the oil"
            self._add_event("filter full", f"{said}, and {past} goes past it")
        else:
            self._add_event("filter full", f"{said}, and is changed")
        self.stopped = any(isinstance(e, FilterFull) and e.stops for e in self.until)

    def _change(self) -> None:
        self.changes.pop(0)
        terms, now = self.now.terms, self.now
        self.accounts.went[DRAINED] += float(np.sum(now.numbers * terms.masses))
        filled = now.volume * terms.fresh
        self.accounts.came["fresh oil"] += float(np.sum(filled * terms.masses))
        now.numbers = filled
        self._add_event("oil change", "the oil is changed")

    # ---------------------------------------------------------------------- the whole
    def run(self, times: Array, *, shortest: float, after_events: bool) -> LifeHistory:
        """The history at these times, at its events, and, if asked, closely after them."""
        kept: list[float] = []
        volumes: list[Array] = []
        numbers: list[Array] = []

        def keep(some: Array) -> None:
            """Keep the oil at times [s since the beginning of the stretch]."""
            volume = self.now.volume_after(some)
            kept.extend(self.now.begin + some)
            volumes.append(volume)
            numbers.append(self.now.state_after(some).numbers / volume[:, None, None])
            self.accounts.add(self.now, some)

        for _ in range(MOST_EVENTS):
            end, does = self.next_event()
            begin = self.now.begin
            inside = times[(times >= begin) & (times < begin + end)] - begin
            if after_events and begin > 0:
                more = usual_times(end, shortest=shortest)[1:-1:AFTER]
                inside = np.unique(np.concatenate([inside, more[more < end]]))
            keep(inside)
            if does == self._change:
                # the oil just before it is drained
                keep(np.array([np.nextafter(begin + end, 0.0) - begin]))
            self._go_on(end)
            does()
            if self.stopped:
                break
        else:
            rule = f"holds {MOST_EVENTS} events and more: {self.events[-1].sentence}"
            hint = "is the capacity of the filter far too small, or the ingress too large (mg/h)?"
            raise InvalidValue(Problem("duration", rule, hint=hint, code=Mistake.TOO_LARGE))
        keep(np.array([0.0]))
        order = np.array(kept)
        last = np.append(np.diff(order) > 0, True)
        columns = {name: np.concatenate(c)[last] for name, c in self.accounts.columns.items()}
        return LifeHistory(
            circuit=self.circuit,
            terms=self.first,
            times=order[last],
            volume=np.concatenate(volumes)[last],
            numbers=np.concatenate(numbers)[last],
            ledger=Ledger(
                in_oil=columns["in the oil"],
                came={name: columns[name] for name in self.accounts.came},
                went={name: columns[name] for name in self.accounts.went},
                begin=float(np.sum(self.circuit.volume * self.first.start * self.first.masses)),
            ),
            events=tuple(self.events),
            warnings=tuple(self.circuit.notes()),
        )

    def _go_on(self, time: float) -> None:
        """Let the stretch run, and begin the next one."""
        now = self.now
        self.accounts.close(now, time)
        for name in self.held:
            self.held[name] += now.mass_removed(name, time)
        numbers, volume = now.state_after(time).numbers, float(now.volume_after(time))
        self.now = _Stretch(now.terms, now.begin + time, volume, numbers)


@takes_units
def run_oil_history(
    circuit: OilCircuit,
    *,
    duration: float,
    until: Sequence[Until] = (),
    times: ArrayLike | None = None,
) -> LifeHistory:
    """The particles of an oil over time.

    Parameters
    ----------
    circuit : OilCircuit
    duration : float
        [s].
    until : sequence of Until, optional
        What it waits for.
    times : array, optional
        At which the oil is kept [s], from 0 to the duration; some besides those of events.

    Returns
    -------
    LifeHistory

    Raises
    ------
    InvalidValue
        A duration or times that are none, or a circuit that runs dry before its end.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.oil_history import run_oil_history
    >>> from thirdbody.systems.life.oil_dirt import OilDirt
    >>> from thirdbody.systems.oil_filter import Filter
    >>> clean = Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3)
    >>> dirt = OilDirt.from_iso4406("18/16/13", material=tb.materials["quartz"])
    >>> oil = tb.oil.OilCircuit(volume=0.2, start=dirt, ingress=(), filters=clean)
    >>> found = run_oil_history(oil, duration=1800.0)
    >>> found.codes[0], found.codes[-1], found.ledger.residual < 1e-9
    ('18/16/13', '5/3/0', True)
    """
    need_duration(duration)
    need_oil_left(circuit, duration)
    shortest = 1e-2 * circuit.volume / max(float(np.max(circuit.terms().loss)), 1e-300)
    if times is None:
        some = usual_times(duration, shortest=shortest)
    else:
        some = kept_times(times, duration=duration)
    course = _Course(circuit, duration, tuple(until))
    return course.run(some, shortest=shortest, after_events=times is None)
