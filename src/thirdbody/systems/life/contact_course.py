"""The run of a loop over time: stiff steps between events, and what each event does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ...quantities.say import number, value_of
from .circuit import OilCircuit
from .film_loop import FilmLoop
from .history import LifeEvent
from .kept_rates import KeptRates
from .loop import Loop
from .until import CodeReached, ContactUntil, FilterFull, Until

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["DRAINED", "ContactCourse", "Visited", "coverage"]

RTOL = 1e-6
"""Relative tolerance of the steps."""
MOST_EVENTS = 1000
DRAINED = "oil changes"
JAMMED = 1.0
"""Part of the area that particles may cover at most: beyond, sums of single particles end."""


@dataclass
class Visited:
    """States of a history, and the volume that left at changes of oil."""

    times: list[float] = field(default_factory=list)
    states: list[Array] = field(default_factory=list)
    drained: list[Array] = field(default_factory=list)
    """Of each kind so far [m³]."""
    filled: list[Array] = field(default_factory=list)


class ContactCourse:
    """A loop over time.

    Parameters
    ----------
    loop : Loop
    start : array (n,)
    duration : float
        [s].
    times : array
        At which states are kept [s].
    until : sequence of Until
    circuit : OilCircuit, optional
        Of a loop with oil.
    kept : KeptRates, optional
        Rates that were computed before.
    """

    def __init__(
        self,
        loop: Loop,
        start: Array,
        *,
        duration: float,
        times: Array,
        until: Sequence[Until] = (),
        circuit: OilCircuit | None = None,
        kept: KeptRates | None = None,
    ):
        self.kept = KeptRates() if kept is None else kept
        self.loop, self.y, self.duration, self.times = loop, start, duration, times
        self.circuit, self.until = circuit, list(until)
        self.time, self.stopped = 0.0, False
        self.events: list[LifeEvent] = []
        self.visited = Visited()
        self.drained, self.filled = np.zeros(loop.kinds), np.zeros(loop.kinds)
        self.full: set[str] = set()
        self.held: dict[str, float] = {}
        self.changes: list[float] = []
        if circuit is not None:
            self.held = dict.fromkeys(circuit.filter_names(), 0.0)
            self.changes = [t for t in circuit.oil_changes if t < duration]
        self.densities = np.array([k.material.density or np.nan for k in loop.tables.kinds])
        self.evaluations = 0
        self._first = start.copy()

    # ------------------------------------------------------------------ tolerances
    def _tolerances(self) -> Array:
        """One particle in the oil, and what it is to everything else."""
        loop, layout = self.loop, self.loop.layout
        atol = np.empty(layout.count)
        sigma = loop.sigma_of(self.y)
        least = self._least_number()
        for name, place in layout.places.items():
            if name == loop.pool or name.startswith("bound"):
                atol[place] = least
            elif name.startswith("flow"):
                atol[place] = 1e-3 * least * float(np.mean(loop.volumes))
            elif name.startswith("wear") or name == "sigma":
                atol[place] = 1e-6 * sigma
            else:
                atol[place] = 1e-9 if name.startswith("thrown") else 1.0
        return atol

    def _least_number(self) -> float:
        if self.loop.pool == "oil":
            return 1.0
        return 1e-9 * self.loop.setting.area / float(np.mean(self.loop.sizes)) ** 2

    # ------------------------------------------------------------------ what may happen
    def _counts(self, y: Array) -> Array:
        assert isinstance(self.loop, FilmLoop)
        numbers = self.loop.shape_numbers(y[self.loop.layout["oil"]]).sum(axis=0)
        return self.loop.tables.classes.counted(numbers / self.loop.volume_at(self.loop.now))

    def _caught(self, y: Array, name: str) -> float:
        """Mass that a filter holds [kg]."""
        return float(np.nansum(self.loop.flow(y, name) * self.densities))

    def _watched_events(self) -> list[tuple[Callable[[float, Array], float], Callable[[], None]]]:
        """What rises through 0 at an event, and what the event does."""
        out: list[tuple[Callable[[float, Array], float], Callable[[], None]]] = []
        for goal in self.until:
            if isinstance(goal, CodeReached):
                cleans = goal.is_dirtier(self._counts(self._first))
                out.append((self._far_from(goal, cleans), self._reach(goal)))
            elif isinstance(goal, ContactUntil):
                out.append((self._short_of(goal), self._reach(goal)))
        if self.circuit is not None:
            for name, filters in zip(
                self.circuit.filter_names(), self.circuit.filters, strict=True
            ):
                if filters.capacity is not None and name not in self.full:
                    limit = self.held[name] + filters.capacity
                    out.append((self._filling(name, limit), self._fill(name)))
        else:
            out.append((self._jamming, self._jam))
        return out

    def _far_from(self, code: CodeReached, cleans: bool) -> Callable[[float, Array], float]:
        def far(time: float, y: Array) -> float:
            assert isinstance(self.loop, FilmLoop)
            self.loop.now = time
            value = float(code.distance(np.maximum(self._counts(y), 0.0), cleans=cleans))
            return value if np.isfinite(value) else -1e3

        return far

    def _short_of(self, goal: ContactUntil) -> Callable[[float, Array], float]:
        return lambda time, y: goal.excess(self.loop, state=y)

    def _filling(self, name: str, limit: float) -> Callable[[float, Array], float]:
        return lambda time, y: self._caught(y, name) - limit

    def _jamming(self, time: float, y: Array) -> float:
        return coverage(self.loop, self.loop.present(y, self.loop.last)) - JAMMED

    # ------------------------------------------------------------------ what happens
    def _add_event(self, name: str, sentence: str) -> None:
        self.events.append(LifeEvent(self.time, name, sentence))

    def _reach(self, goal: Until) -> Callable[[], None]:
        def does() -> None:
            self.until.remove(goal)
            self._add_event(goal.name, goal.sentence)
            self.stopped = self.stopped or goal.stops

        return does

    def _fill(self, name: str) -> Callable[[], None]:
        def does() -> None:
            assert self.circuit is not None
            place = self.circuit.filter_names().index(name)
            oil_filter = self.circuit.filters[place]
            said = f"{name} is full with {value_of(oil_filter.capacity, 'kg', 3)}"
            self.held[name] = self._caught(self.y, name)
            if oil_filter.when_full == "bypass":
                self.full.add(name)
                loop = self.loop
                assert isinstance(loop, FilmLoop)
                loop.terms = self.circuit.terms(
                    full=self.full, classes=loop.tables.classes, materials=loop.terms.materials
                )
                past = "all of the oil" if oil_filter.still_filtered == 0 else "part of the oil"
                self._add_event("filter full", f"{said}, and {past} goes past it")
            else:
                self._add_event("filter full", f"{said}, and is changed")
            self.stopped |= any(isinstance(e, FilterFull) and e.stops for e in self.until)

        return does

    def _jam(self) -> None:
        self._add_event(
            "jam", "particles would cover the whole area: sums of single particles end here"
        )
        self.stopped = True

    def _change(self) -> None:
        loop = self.loop
        assert isinstance(loop, FilmLoop)
        self.changes.pop(0)
        place = loop.layout["oil"]
        volume = loop.shape_numbers(self.y[place] * loop.volumes).sum(axis=1)
        self.drained = self.drained + volume
        fresh = loop.volume_at(self.time) * loop.terms.fresh.T.ravel()
        self.filled = self.filled + loop.shape_numbers(fresh * loop.volumes).sum(axis=1)
        self.y = self.y.copy()
        self.y[place] = fresh
        self._add_event("oil change", "the oil is changed")

    # ------------------------------------------------------------------ the whole
    def _keep(self, time: float, y: Array) -> None:
        seen = self.visited
        if seen.times and time <= seen.times[-1]:
            time = float(np.nextafter(seen.times[-1], np.inf))
        seen.times.append(time)
        seen.states.append(y)
        seen.drained.append(self.drained)
        seen.filled.append(self.filled)

    def run(self) -> Visited:
        """The states at all times asked for, and at every event.

        Raises
        ------
        NoEquilibrium
            The contact loses its balance on the way.
        """
        self._keep(0.0, self.y)
        for _ in range(MOST_EVENTS):
            if self._stretch():
                return self.visited
        rule = f"holds {MOST_EVENTS} events and more: {self.events[-1].sentence}"
        hint = "is the capacity of the filter far too small, or the ingress too large (mg/h)?"
        raise InvalidValue(Problem("duration", rule, hint=hint, code=Mistake.TOO_LARGE))

    def _stretch(self) -> bool:
        """Go to the next event; whether the history ends there."""
        end = self.changes[0] if self.changes else self.duration
        watched = self._watched_events()
        for excess, does in watched:
            if excess(self.time, self.y) >= 0:  # reached where the history begins
                does()
                return self.stopped
        solution = self._integrate(end, [excess for excess, _ in watched])
        inside = self.times[(self.times > self.time) & (self.times < solution.t[-1])]
        begin = self.time
        for time in inside:
            self._keep(float(time), solution.sol(time))
        self.time, self.y = float(solution.t[-1]), solution.y[:, -1]
        if self.time > begin:
            self._keep(self.time, self.y)
        if isinstance(self.loop, FilmLoop):
            self.loop.now = self.time
        hit = [i for i, places in enumerate(solution.t_events or ()) if len(places)]
        if hit:
            for i in hit:
                watched[i][1]()
        elif self.changes and self.time >= self.changes[0]:
            self._change()
            self._keep(self.time, self.y)
        else:
            self.stopped = True
        return self.stopped

    def _derivative(self, time: float, y: Array) -> Array:
        return self.kept.rate(self.loop, time, y, lambda: self.loop.derivative(time, y))

    def _jacobian(self, time: float, y: Array) -> Array:
        return self.kept.rate(self.loop, time, y, lambda: self.loop.jacobian(time, y))

    def _integrate(self, end: float, events: list[Any]) -> Any:
        """Stiff steps to a time, or to the first event."""
        from scipy.integrate import solve_ivp

        def rising(excess: Callable[[float, Array], float]) -> Any:
            def event(time: float, y: Array) -> float:
                return excess(time, y)

            event.terminal = True  # type: ignore[attr-defined]
            event.direction = 1.0  # type: ignore[attr-defined]
            return event

        solution = solve_ivp(
            self._derivative,
            (self.time, end),
            self.y,
            method="BDF",
            jac=self._jacobian,
            rtol=RTOL,
            atol=self._tolerances(),
            dense_output=True,
            events=[rising(excess) for excess in events] or None,
        )
        self.evaluations += solution.nfev
        if solution.status < 0:
            raise NoEquilibrium(
                f"the history cannot go on after {number(float(solution.t[-1]), 3)} s: "
                f"{solution.message}"
            )
        return solution


def coverage(loop: Loop, eta: Array) -> float:
    """Projected area of particles η per area of the contact [1]."""
    squares = np.tile(loop.tables.classes.mean_power(2), loop.kinds)
    return float(np.pi / 4 * (eta @ squares))
