"""The search of a design: points, what each costs and breaks, and better points."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...contact.contact import Contact
from ...contact.pressed import buried_share, most_buried
from ...equilibrium.load import as_load
from ...equilibrium.states import state_columns
from ...errors import InvalidValue
from ...numerics.sampling import Span, sobol
from ...quantities.progress import Cost, solving
from ...quantities.say import percent
from ..attempts import Columns, columns_tried
from ..inputs import Input, inputs
from ..uncertainty.inputs import Drawn

if TYPE_CHECKING:
    from ...populations.materials import Material
    from .problem import Limit, Objective, Suspension

__all__ = ["AMOUNT", "Point", "Task", "Variable"]

Array = NDArray[np.float64]
Numbers = Mapping[str, float]
Materials = dict[str, "Material"]

DENSITY, AMOUNT = "particles.areal_density", "particles.concentration"
GRID, SAMPLES, LINE = 64, 384, 16
"""Points along one variable, points of several, and amounts of particles of one size."""
STARTS, STEPS = 3, 80
"""Places that the search of several variables starts from, and points tried from each."""
FEWEST = 1.0
"""Particles per nominal area that never jam [1/m²]."""
AT_ONCE = 200_000
"""States solved together."""
MOST_AREA, MOST_COVERED, MOST_BURIED = 0.2, 0.3, 0.05
"""Real area, projected particle area, and share of the whole load on particles that sit deeper
than their radius, above which the model is not meant."""
NOTHING = 1e-9
"""Share of the whole load that counts as none."""
CLEARLY_FEW = 0.5 * MOST_BURIED
"""The same where only the limit counts: what is no more than this at most does not break it."""
CLOSE = 0.01
"""A limit is active when so little of it is left."""


class Variable(NamedTuple):
    """What may be chosen between two ends: numbers of the contact, or a concentration."""

    name: str
    low: float
    high: float
    moved: Input | None
    """None for a concentration."""

    @property
    def span(self) -> Span:
        """Positive ranges by ratio."""
        return Span(self.low, self.high, "log" if self.low > 0 else "linear")

    def place(self, value: float) -> float:
        """Place of a value in the range, 0 to 1."""
        if self.low > 0:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def changes(self, value: Any) -> dict[str, Any]:
        """Every number that moves with it."""
        if self.moved is None:
            return {self.name: value}
        return self.moved.numbers_at((value - self.moved.values[0]) / self.moved.scales[0])


@dataclass(frozen=True)
class Point:
    """A point tried."""

    numbers: Numbers
    materials: Materials
    costs: dict[str, float]
    """By label, less is better."""
    broken: dict[str, float]
    """By how much of itself each limit is broken; ≤ 0 where it holds."""
    reason: str
    """Why it is not feasible."""

    @property
    def rank(self) -> float:
        """The first cost; behind every feasible point the others, by how much they break."""
        if self.reason:
            return 1e30 * (1 + min(max(self.broken.values()), 1e6))
        return next(iter(self.costs.values()))

    @property
    def active(self) -> tuple[str, ...]:
        return tuple(what for what, excess in self.broken.items() if -CLOSE < excess <= 0)


@dataclass(kw_only=True)
class Task:
    """Everything that is asked, and every point tried so far."""

    contact: Contact
    variables: dict[str, Variable]
    materials: dict[str, list[Material]]
    objectives: list[Objective]
    limits: list[Limit]
    load: str
    loads: Array
    weights: Array
    scatter: tuple[Drawn, Array] | None
    suspension: Suspension | None
    seed: int
    report: Callable[[int], None] = lambda _: None
    reported: int = 0
    tried: list[Point] = field(default_factory=list)

    def __post_init__(self) -> None:
        names = (*(o.of for o in self.objectives), *(g.of for g in self.limits))
        self.columns = list(dict.fromkeys(names))
        outputs = {name for output in self.contact.outputs for name in output.columns}
        if not outputs & set(self.columns):
            self.contact = self.contact.replace(outputs=())

    # ------------------------------------------------------------------ coordinates
    def choices(self) -> list[Materials]:
        """Every combination of materials."""
        names, lists = list(self.materials), list(self.materials.values())
        return [dict(zip(names, pick, strict=True)) for pick in itertools.product(*lists)]

    def values_at(self, u: Array) -> list[dict[str, float]]:
        """Values of the variables at points of the unit cube (P, k)."""
        return [
            {
                variable.name: float(
                    np.clip(variable.span.values_at(place), variable.low, variable.high)
                )
                for place, variable in zip(row, self.variables.values(), strict=True)
            }
            for row in np.clip(u, 0.0, 1.0)
        ]

    def where(self, numbers: Numbers) -> Array:
        """Coordinates of a point in the unit cube (k,)."""
        return np.array(
            [variable.place(numbers[name]) for name, variable in self.variables.items()]
        )

    # ------------------------------------------------------------------ contacts
    def contact_at(self, numbers: Numbers, materials: Materials) -> Contact:
        """The contact of a point."""
        changes: dict[str, object] = {}
        for name, value in numbers.items():
            changes |= self.variables[name].changes(value)
        return self._filled_contact(self.contact.replace(**materials), changes)

    def _filled_contact(self, contact: Contact, changes: Mapping[str, Any]) -> Contact:
        """The contact with these numbers, and as many particles as the fluid then brings."""
        plain = {name: float(value) for name, value in changes.items() if name != AMOUNT}
        if self.suspension is None:
            return contact.replace(**plain)
        few = contact.replace(**plain, **{DENSITY: FEWEST})
        (dust,) = few.populations
        density = self.suspension.areal_density(dust, concentration=changes.get(AMOUNT))
        return few.replace(**{DENSITY: density})

    def _moving(
        self, numbers: Sequence[Numbers], contact: Contact, samples: bool
    ) -> dict[str, Array]:
        """Every number that moves (P, 1 + samples), sample 0 nominal."""
        S = 1 + (len(self.scatter[1]) if samples and self.scatter else 0)
        out: dict[str, Array] = {}
        for name, variable in self.variables.items():
            for moved, column in variable.changes(np.array([p[name] for p in numbers])).items():
                out[moved] = np.repeat(column[:, None], S, axis=1)
        if S > 1 and self.scatter is not None:
            drawn, u = self.scatter
            nominal = inputs(contact)
            for name, sample in drawn.points(u).items():
                values = np.append(nominal[name], sample)
                if name not in out:
                    out[name] = np.broadcast_to(values, (len(numbers), S))
                elif nominal[name]:  # about each value of a variable by the same factors
                    out[name] = out[name] * values / nominal[name]
                else:
                    out[name] = out[name] + values
        return out

    # ------------------------------------------------------------------ metrics
    def metrics(
        self,
        numbers: Sequence[Numbers],
        materials: Materials,
        *,
        samples: bool = True,
        few_buried: float = NOTHING,
    ) -> Columns:
        """Every metric (P, 1 + samples, loads), and coverage (P, 1 + samples).

        NaN where there is no such contact, with an infinite coverage, or no state; ``refused`` (P,)
        says why no model takes the contact of a point. Buried particles that cannot bear more than
        ``few_buried`` of the whole load count as none.
        """
        contact = self.contact.replace(**materials) if materials else self.contact
        vary = self._moving(numbers, contact, samples)
        P, J = len(numbers), len(self.loads)
        S = 1 + (len(self.scatter[1]) if samples and self.scatter else 0)
        bare = contact.replace(outputs=())
        covered, density = np.full((P, S), math.inf), np.full((P, S), math.nan)
        for i, j in np.ndindex(P, S):
            try:
                one = self._filled_contact(bare, {name: v[i, j] for name, v in vary.items()})
            except InvalidValue:
                continue
            covered[i, j] = sum(population.coverage for population in one.populations)
            if self.suspension is not None:
                density[i, j] = one.populations[0].areal_density
        vary.pop(AMOUNT, None)
        if self.suspension is not None:
            vary[DENSITY] = density
        possible = np.isfinite(covered)
        names = dict.fromkeys((*self.columns, "A_t", "h", "d", "particle_load_share"))
        out = {name: np.full((P, S, J), math.nan) for name in names}
        refused = np.full(P, "", dtype=object)
        if possible.any():
            count = np.count_nonzero(possible)
            flat = {name: np.repeat(values[possible], J) for name, values in vary.items()}
            states, why = self._states(contact, flat, names)
            owner = np.repeat(np.argwhere(possible)[:, 0], J)
            for k in sorted(why, reverse=True):
                refused[owner[k]] = why[k]
            with np.errstate(divide="ignore", invalid="ignore"):
                states["plastic_share"] = states["A_p"] / states["A_t"]
            for name, values in out.items():
                values[possible] = np.asarray(states[name], float).reshape(count, J)
        nominal = {name: values[:, 0] for name, values in vary.items()}
        buried = self._buried_share(bare, nominal, out, few_buried)
        return {**out, "coverage": covered, "buried_share": buried, "refused": refused}

    def _states(
        self, contact: Contact, vary: dict[str, Array], names: Iterable[str]
    ) -> tuple[Columns, dict[int, str]]:
        """Columns of contacts at every load, and why those that have none are refused."""
        count = len(next(iter(vary.values()))) if vary else len(self.loads)
        loads = np.tile(self.loads, count // len(self.loads))

        def solve(which: NDArray[np.intp]) -> Columns:
            some = {name: values[which] for name, values in vary.items()}
            load = as_load(self.load, loads[which])
            return state_columns(contact, vary=some or None, fewest=1, **load)

        try:
            return columns_tried(solve, count)
        except InvalidValue as error:  # all of these points
            why = "; ".join(error.problems)
            none = {name: np.full(count, math.nan) for name in (*names, "A_p")}
            return none, dict.fromkeys(range(count), why)

    def _buried_share(
        self, contact: Contact, vary: dict[str, Array], columns: dict[str, Array], few: float
    ) -> Array:
        """Share of the load on particles deeper than their radius, nominal: (P, loads)."""
        d, share = columns["d"][:, 0], columns["particle_load_share"][:, 0]
        out = np.where(np.isnan(d), math.nan, 0.0)
        # where particles carry less than that, no more can be on buried ones
        many = np.flatnonzero(np.nanmax(share, axis=1, initial=0) > MOST_BURIED)
        alike: dict[tuple[float, ...], list[int]] = {}
        for i in many:
            key = tuple(float(v[i]) for name, v in vary.items() if name != DENSITY)
            alike.setdefault(key, []).append(int(i))
        for which in alike.values():
            changed = contact.replace(**{name: float(v[which[0]]) for name, v in vary.items()})
            needed = np.isfinite(d[which])
            most = np.zeros(needed.shape)
            most[needed] = most_buried(changed, d[which][needed])
            if DENSITY in vary:
                most *= (vary[DENSITY][which] / vary[DENSITY][which[0]])[:, None]
            pressure = self.loads * (changed.E_ss if self.load == "F_star" else 1.0)
            needed &= most > few * pressure
            buried = np.zeros(needed.shape)
            if needed.any():
                buried[needed] = buried_share(changed, d[which][needed])
            out[which] += np.nan_to_num(buried * share[which])
        return out

    # ------------------------------------------------------------------ points
    def evaluate(self, numbers: Sequence[Numbers], materials: Materials) -> list[Point]:
        """Points, which are kept."""
        samples = len(self.scatter[1]) if self.scatter else 0
        per_point = (1 + samples) * len(self.loads)
        fit = max(1, AT_ONCE // per_point)
        rows: list[Point] = []
        for start in range(0, len(numbers), fit):
            some, before = numbers[start : start + fit], len(self.tried) + len(rows)

            def count(states: int, before: int = before) -> None:
                self._report_more(before + states // per_point)

            with solving(Cost(per_point * len(some), count)):
                rows += self.judge_points(some, materials)
            self._report_more(len(self.tried) + len(rows))
        self.tried += rows
        return rows

    def _report_more(self, points: int) -> None:
        """Report a number of points that is higher than every one before."""
        if points > self.reported:
            self.reported = points
            self.report(points)

    def judge_points(
        self, numbers: Sequence[Numbers], materials: Materials, *, few_buried: float = NOTHING
    ) -> list[Point]:
        """Costs of points, and the limits that they break."""
        metric = self.metrics(numbers, materials, few_buried=few_buried)
        costs = {
            objective.label: objective.cost(metric[objective.of], self.weights)
            for objective in self.objectives
        }
        broken = {str(limit): limit.excess(metric[limit.of]) for limit in self.limits}
        broken |= {
            f"A_t < {MOST_AREA}": np.max(metric["A_t"][:, 0], axis=1) / MOST_AREA - 1,
            f"coverage < {MOST_COVERED}": metric["coverage"][:, 0] / MOST_COVERED - 1,
            f"load on particles deeper than their radius < {percent(MOST_BURIED)}": (
                np.max(metric["buried_share"], axis=1) / MOST_BURIED - 1
            ),
        }
        unsolved = np.atleast_1d(np.any(np.isnan(metric["A_t"]), axis=(1, 2)))
        jammed = np.atleast_1d(np.any(np.isinf(metric["coverage"]), axis=1))
        rows = []
        for i, point in enumerate(numbers):
            excesses = {what: _number(excess[i]) for what, excess in broken.items()}
            cost = {label: float(values[i]) for label, values in costs.items()}
            reasons = [
                f"{what} is broken by {excess:.3g} of it"
                for what, excess in excesses.items()
                if excess > 0
            ]
            if unsolved[i]:
                excesses["solved"] = math.inf
                reasons = ["a load has no equilibrium"]
                if jammed[i]:
                    reasons = [f"coverage < {MOST_COVERED} is broken: the particles jam"]
                elif metric["refused"][i]:
                    reasons = [f"the contact is refused: {metric['refused'][i]}"]
            elif any(math.isnan(value) for value in cost.values()):
                excesses["value"] = math.inf
                reasons = ["an objective has no value there"]
            rows.append(Point(point, materials, cost, excesses, "; ".join(reasons)))
        return rows

    # ------------------------------------------------------------------ search
    def explore(self, materials: Materials, points: int | None) -> None:
        """Points all over the ranges."""
        width = len(self.variables)
        if not width:
            self.evaluate([{}], materials)
            return
        if width == 1:
            u = np.linspace(0, 1, points or GRID)[:, None]
        else:
            u = self._spread(points or SAMPLES)
        self.evaluate(self.values_at(u), materials)

    def _spread(self, count: int) -> Array:
        """Points of the unit cube; sizes with several amounts each, which cost little more."""
        names = list(self.variables)
        amounts = [i for i, name in enumerate(names) if name in (DENSITY, AMOUNT)]
        others = [i for i in range(len(names)) if i not in amounts]
        if not (amounts and others):
            return _cube(count, len(names), self.seed)
        line = np.linspace(0, 1, min(LINE, max(3, math.isqrt(count))))
        few = _cube(max(2, count // len(line)), len(others), self.seed)
        u = np.empty((len(few), len(line), len(names)))
        u[..., others] = few[:, None, :]
        u[..., amounts] = line[:, None]
        return u.reshape(-1, len(names))

    def refine(self, materials: Materials) -> None:
        """A local search about the best points found with these materials."""
        rows = [point for point in self.tried if point.materials == materials]
        rows.sort(key=lambda point: point.rank)
        if len(self.variables) == 1:
            self._refine_variable(rows, materials)
            return
        starts: list[Array] = []
        apart = 1.5 * len(rows) ** (-1 / len(self.variables))
        for point in rows:
            u = self.where(point.numbers)
            if all(np.max(np.abs(u - other)) > apart for other in starts):
                starts.append(u)
            if len(starts) == STARTS:
                break
        for u in starts:
            self._from(u, apart, rows[0], materials)

    def _refine_variable(self, rows: list[Point], materials: Materials) -> None:
        """Points that vary one variable between the neighbours of the best point."""
        from scipy.optimize import minimize_scalar

        u = np.array([self.where(point.numbers)[0] for point in rows])
        every = np.sort(u)
        place = int(np.searchsorted(every, u[0]))
        low, high = every[max(place - 1, 0)], every[min(place + 1, len(every) - 1)]
        minimize_scalar(
            lambda t: self.evaluate(self.values_at(np.array([[t]])), materials)[0].rank,
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-4 * (high - low)},
        )

    def _from(self, start: Array, apart: float, best: Point, materials: Materials) -> None:
        """Several variables: one start."""
        from scipy.optimize import Bounds, NonlinearConstraint, minimize

        unit = abs(next(iter(best.costs.values()))) or 1.0
        names = [what for what in best.broken if what not in ("solved", "value")]
        cache: dict[bytes, Array] = {}

        def values(u: Array) -> Array:
            """Cost and what is broken, finite."""
            if u.tobytes() not in cache:
                (point,) = self.evaluate(self.values_at(u[None]), materials)
                cost = next(iter(point.costs.values())) / unit
                # a little inside, so that what is found there is feasible
                broken = [min(point.broken.get(what, 1.0), 1.0) + 1e-6 for what in names]
                if not math.isfinite(cost):
                    cost, broken = 1e3, [1.0] * len(names)
                cache[u.tobytes()] = np.array([cost, *np.maximum(broken, -1.0)])
            return cache[u.tobytes()]

        minimize(
            lambda u: values(u)[0],
            start,
            method="COBYQA",
            bounds=Bounds(0.0, 1.0),
            constraints=NonlinearConstraint(lambda u: values(u)[1:], -np.inf, 0.0),
            options={
                "maxfev": STEPS,
                "initial_tr_radius": min(0.5 * apart, 0.25),
                "final_tr_radius": 1e-4,
            },
        )

    def best(self) -> Point:
        """The point that ranks first; of several that are as good, one in their middle."""
        ranks = np.array([point.rank for point in self.tried])
        alike = np.flatnonzero(ranks <= ranks.min() + 1e-12 * abs(ranks.min()))
        materials = self.tried[alike[0]].materials
        ties = [self.tried[i] for i in alike if self.tried[i].materials == materials]
        u = np.array([self.where(point.numbers) for point in ties])
        return ties[int(np.argmin(np.sum((u - np.median(u, axis=0)) ** 2, axis=1)))]


def _cube(count: int, width: int, seed: int) -> Array:
    """Points of the unit cube: even along one axis, otherwise a design and the corners."""
    if width == 1:
        return np.linspace(0, 1, count)[:, None]
    # what falls or rises everywhere is best in a corner
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=min(width, 4))))
    corners = np.pad(corners, ((0, 0), (0, width - corners.shape[1])), constant_values=0.5)
    return np.concatenate([corners, sobol(count, width, seed, 0, count)])


def _number(excess: float) -> float:
    """An excess without value counts as broken."""
    return math.inf if math.isnan(excess) else float(excess)
