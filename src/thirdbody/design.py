r"""Which particles, how many, on which surface: the best inputs of a contact over a range of loads.

A point y of the design is a contact; its states under the load cases :math:`F_j` with weights
:math:`w_j` give metrics m(y, F). An objective reduces a metric over the loads,

.. math:: \sum_j w_j m_j, \qquad \max_j m_j, \qquad \sum_j w_j\,1[\,low \le m_j \le high\,],

and over samples of what scatters; limits bound metrics at every load.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .contact import Contact
from .designs import Span, latin, sobol
from .equilibrium import about, columns_of, given_load
from .errors import InvalidValue
from .materials import Material
from .sensitivities import Input, inputs, sensitivity
from .sensitivities import _input as moved_input
from .states import solve_states
from .uncertainty import Drawn
from .uncertainty import _drawn as drawn
from .values import Value, choice, quantity

if TYPE_CHECKING:
    import xarray

__all__ = ["Best", "Limit", "Objective", "design", "equal_share_size", "front", "hypervolume"]

Array = NDArray[np.float64]
Points = list[dict[str, Any]]

METRICS = {
    "plastic_share": {"symbol": "A_p/A_t", "unit": "1", "meaning": "plastic part of the real area"}
}
"""What can be asked beside the columns of the states."""
GRID, CASES, SAMPLES = 64, 32, 256
"""Points along one variable, load cases of a range, and points of several variables."""
AT_ONCE = 200_000
"""States solved together."""
MOST_AREA, MOST_COVERED = 0.2, 0.3
"""Real area and projected particle area above which the model is not meant."""
LOSS = 0.05
"""Of the objective, inside the tolerance band."""


# -------------------------------------------------------------------------- what is asked
@dataclass(frozen=True, slots=True, kw_only=True)
class Objective(Value):
    """What should be small, large, or inside a window.

    Parameters
    ----------
    of : str
        A column of the states or of an output, or "plastic_share".
    aim : {"smallest", "largest", "window"}, optional
        "window": the weighted share of loads at which the metric lies in [low, high] is to be
        large.
    over_loads : {"mean", "worst"}, optional
        Weighted mean, or the worst of the load cases.
    over_scatter : {"mean", "nominal", "worst", "robust", "tail"}, optional
        What counts of the scattered samples: their mean; nothing, the nominal contact alone; the
        worst; mean and ``k`` standard deviations to the bad side; or the mean of the worst
        ``tail`` part of them (CVaR).
    low, high : float, optional
        The window.
    k, tail : float, optional

    Examples
    --------
    >>> Objective(of="particle_load_share", aim="window").high
    0.75
    """

    of: str
    aim: str = choice("what is good", "smallest", "largest", "window", default="smallest")
    over_loads: str = choice("what counts of the loads", "mean", "worst", default="mean")
    over_scatter: str = choice(
        "what counts of the samples", "mean", "nominal", "worst", "robust", "tail", default="mean"
    )
    low: float = quantity("m_lo", "1", "lower end of the window", default=0.25)
    high: float = quantity("m_hi", "1", "upper end of the window", default=0.75)
    k: float = quantity("k", "1", "standard deviations of a robust objective", default=2.0, ge=0)
    tail: float = quantity("q", "1", "part of a tail that counts", default=0.1, gt=0, le=1)

    def _problems(self) -> list[str]:
        if self.low < self.high:
            return []
        return [f"Objective.low = {self.low:g} must be below high = {self.high:g}"]

    @property
    def sign(self) -> float:
        """+1 where less is better."""
        return 1.0 if self.aim == "smallest" else -1.0

    @property
    def label(self) -> str:
        return f"{self.of}:window" if self.aim == "window" else self.of

    def cost(self, metric: Array, weights: Array) -> Array:
        """What is to be small: (P,) for metrics (P, S, J), sample 0 nominal."""
        if self.aim == "window":
            inside = ((metric >= self.low) & (metric <= self.high)).astype(float)
            values = -(np.where(np.isnan(metric), np.nan, inside) @ weights)
        elif self.over_loads == "mean":
            values = self.sign * (metric @ weights)
        else:
            values = np.max(self.sign * metric, axis=-1)
        samples = values[:, 1:]
        if self.over_scatter == "nominal" or not samples.shape[1]:
            return values[:, 0]
        if self.over_scatter == "mean":
            return samples.mean(axis=1)
        if self.over_scatter == "robust":
            return samples.mean(axis=1) + self.k * samples.std(axis=1)
        count = 1 if self.over_scatter == "worst" else math.ceil(self.tail * samples.shape[1])
        return np.sort(samples, axis=1)[:, -count:].mean(axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit(Value):
    """A bound on a metric at every load.

    Parameters
    ----------
    of : str
        As in `Objective`.
    most, least : float, optional
        In the unit of the metric; at least one.
    share : float, optional
        Part of the scattered samples in which it must hold; in the nominal contact always.

    Examples
    --------
    >>> Limit(of="plastic_share", most=0.1).share
    1.0
    """

    of: str
    most: float | None = quantity("m_max", "1", "largest value allowed", default=None)
    least: float | None = quantity("m_min", "1", "smallest value allowed", default=None)
    share: float = quantity("q", "1", "part of the samples that must obey", default=1.0, gt=0, le=1)

    def _problems(self) -> list[str]:
        if self.most is None and self.least is None:
            return [f"Limit of {self.of} gives neither most nor least"]
        return []

    def excess(self, metric: Array) -> Array:
        """By how much the limit is broken, over its size; ≤ 0 where it holds: (P,)."""
        over = np.full(metric.shape[:2], -np.inf)
        for bound, sign in ((self.most, 1.0), (self.least, -1.0)):
            if bound is not None:
                worst = np.max(sign * (metric - bound), axis=-1)
                over = np.maximum(over, worst / max(abs(bound), 1e-300))
        nominal, samples = over[:, 0], np.sort(over[:, 1:], axis=1)
        if not samples.shape[1]:
            return nominal
        return np.maximum(nominal, samples[:, math.ceil(self.share * samples.shape[1]) - 1])

    def __str__(self) -> str:
        most = "" if self.most is None else f" <= {self.most:g}"
        least = "" if self.least is None else f"{self.least:g} <= "
        return f"{least}{self.of}{most}"


@dataclass(frozen=True, kw_only=True)
class Best:
    """The answer of `design`.

    Attributes
    ----------
    values : dict
        The best value of every variable; of one of the best, for several objectives.
    contact : Contact
        The contact with these values.
    objectives : dict
        Value of every objective there.
    feasible : bool
        Whether every limit holds there; if not, nothing tried was feasible, and ``reason`` says
        why not at the point that came nearest.
    states : xarray.Dataset
        Every metric against the load at the best point, nominal.
    points : xarray.Dataset
        Every point tried: variables, objectives, ``feasible``, ``reason``, and ``front`` for
        those that no other point beats in every objective.
    active : tuple of str
        Limits within 1 % of being broken.
    tolerance : dict
        Per variable the range about the best point in which the first objective loses less
        than 5 %.
    at_bound : tuple of str
        Variables whose best value is an end of their range: the optimum may lie beyond.
    slopes : dict
        d m/d ln y of every column asked for, per variable, at the load in the middle.
    hypervolume : float or None
        Of the front against the worst feasible value of each objective; None for one objective.
    """

    values: dict[str, Any]
    contact: Contact
    objectives: dict[str, float]
    feasible: bool
    reason: str
    states: xarray.Dataset
    points: xarray.Dataset
    active: tuple[str, ...]
    tolerance: dict[str, tuple[float, float]]
    at_bound: tuple[str, ...]
    slopes: dict[str, dict[str, float]]
    hypervolume: float | None = None
    warnings: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Everything for JSON, the points as lists."""
        values = {
            name: value.name if isinstance(value, Material) else value
            for name, value in self.values.items()
        }
        return {
            "values": values,
            "objectives": self.objectives,
            "feasible": self.feasible,
            "reason": self.reason,
            "active": list(self.active),
            "tolerance": {name: list(band) for name, band in self.tolerance.items()},
            "at_bound": list(self.at_bound),
            "slopes": self.slopes,
            "hypervolume": self.hypervolume,
            "states": _lists(self.states),
            "points": _lists(self.points),
            "warnings": list(self.warnings),
        }


def _lists(data: xarray.Dataset) -> dict[str, list[Any]]:
    every = {str(name): data[name].values for name in data.variables}
    return {
        name: [None if isinstance(v, float) and math.isnan(v) else v for v in values.tolist()]
        for name, values in every.items()
    }


# -------------------------------------------------------------------------- the search
def design(
    contact: Contact,
    *,
    over: Mapping[str, Any],
    objective: Objective | Sequence[Objective],
    limits: Sequence[Limit] = (),
    F_star: ArrayLike | Span | None = None,
    pressure: ArrayLike | Span | None = None,
    weights: ArrayLike | None = None,
    scatter: Mapping[str, Any] | None = None,
    samples: int = 16,
    points: int | None = None,
    seed: int = 0,
) -> Best:
    r"""The best inputs of a contact over a range of loads, under limits and scatter.

    .. math:: \min_y\; R_s\,R_F\; m(y, F), \qquad g_k(y) \le 0

    Parameters
    ----------
    contact : Contact
        What is not searched, and the outputs that metrics come from.
    over : mapping
        What may be chosen: dotted names of numbers with their range (low, high) in SI, several
        names joined by "+" that move by one factor ("particles.diameter.mean+"
        "particles.diameter.std" keeps the relative width); or a name of a material with a list
        of `Material`.
    objective : Objective or several
        Several give the front of points that no other beats in all of them.
    limits : sequence of Limit, optional
        Besides, always: every load has a state, A_t < 0.2, and particles cover less than 0.3.
    F_star, pressure : array, or Span
        Load cases; a `Span` stands for 32 of them, evenly in the logarithm. One of the two.
    weights : array, optional
        Of the load cases, equal by default; they are made to sum to one.
    scatter : mapping, optional
        Inputs that scatter, as in `propagate`. An input that is also searched scatters about each
        of its values by the same factors.
    samples : int, optional
        Of the scatter: one Latin hypercube for all points, so that they can be compared.
    points : int, optional
        Tried before the search goes local: 64 for one number, 256 for several.
    seed : int, optional

    Returns
    -------
    Best

    Raises
    ------
    InvalidValue
        A name that is no number or column, a range without extent, no load or two.

    Notes
    -----
    One number and one objective: a grid, then Brent's bounded search between the neighbours of
    the best point (`scipy.optimize.minimize_scalar`), to 1e-4 of the range. Several numbers: the
    corners of the ranges and a Sobol design, then `scipy.optimize.differential_evolution` with a
    part of it as the first generation. Several objectives: the design alone. Islands of feasible
    points that hold less than one part in ``points`` of the ranges can be missed. A point that
    breaks a limit ranks behind all that do not, by how much it breaks it.

    References
    ----------
    Storn, Price 1997, J. Global Optim. 11, 341, doi:10.1023/A:1008202821328; Brent 1973,
    Algorithms for Minimization without Derivatives, ch. 5.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9)))
    >>> best = design(contact, F_star=[1e-5, 1e-4], points=16,
    ...     over={"particles.diameter.mean+particles.diameter.std": (50e-9, 1e-6)},
    ...     objective=Objective(of="particle_load_share", aim="window"))
    >>> best.feasible
    True
    """
    objectives = [objective] if isinstance(objective, Objective) else list(objective)
    task = _task(
        contact, over, objectives, list(limits), F_star, pressure, weights, scatter, samples, seed
    )
    for materials in task.choices():
        task.explore(materials, points)
        if len(objectives) == 1 and task.spans:
            task.refine(materials)
    return task.answer()


class _Task:
    """Everything that is asked, and every point tried so far."""

    def __init__(
        self,
        contact: Contact,
        spans: dict[str, tuple[Input, float, float]],
        materials: dict[str, list[Material]],
        objectives: list[Objective],
        limits: list[Limit],
        load: str,
        loads: Array,
        weights: Array,
        scatter: tuple[Drawn, Array] | None,
        seed: int,
    ):
        self.contact, self.spans, self.materials = contact, spans, materials
        self.objectives, self.limits = objectives, limits
        self.load, self.loads, self.weights = load, loads, weights
        self.scatter, self.seed = scatter, seed
        self.columns = list(dict.fromkeys([*(o.of for o in objectives), *(g.of for g in limits)]))
        self.tried: Points = []
        outputs = {name for each in contact.outputs for name in each.columns}
        if not outputs & set(self.columns):
            self.contact = contact.replace(outputs=())

    # ------------------------------------------------------------------ coordinates
    def choices(self) -> list[dict[str, Material]]:
        """Every combination of materials."""
        names, lists = list(self.materials), list(self.materials.values())
        return [dict(zip(names, pick, strict=True)) for pick in itertools.product(*lists)]

    def at(self, u: Array) -> list[dict[str, float]]:
        """Values of the variables at points of the unit cube (P, k): positive ranges by ratio."""
        rows = []
        for row in np.clip(u, 0.0, 1.0):
            values = {}
            for part, (name, (_, low, high)) in zip(row, self.spans.items(), strict=True):
                span = Span(low, high, "log" if low > 0 else "linear")
                values[name] = float(np.clip(span.at(part), low, high))
            rows.append(values)
        return rows

    # ------------------------------------------------------------------ one batch of points
    def evaluate(
        self, numbers: Sequence[dict[str, float]], materials: dict[str, Material]
    ) -> Array:
        """Costs (P,) of points for ranking by the first objective; everything is kept."""
        rows = []
        fit = max(1, AT_ONCE // ((1 + self._samples) * len(self.loads)))
        for start in range(0, len(numbers), fit):
            rows += self._batch(numbers[start : start + fit], materials)
        self.tried += rows
        return np.array([_rank(row) for row in rows])

    @property
    def _samples(self) -> int:
        return 0 if self.scatter is None else len(self.scatter[1])

    def _batch(self, numbers: Sequence[dict[str, float]], materials: dict[str, Material]) -> Points:
        metric = self.metrics(numbers, materials)
        P = len(numbers)
        costs = {each.label: each.cost(metric[each.of], self.weights) for each in self.objectives}
        broken = [(str(limit), limit.excess(metric[limit.of])) for limit in self.limits]
        broken += [
            ("A_t < 0.2", Limit(of="A_t", most=MOST_AREA).excess(metric["A_t"])),
            ("coverage < 0.3", self._coverage(numbers, materials) / MOST_COVERED - 1),
        ]
        unsolved = np.asarray(np.isnan(metric["A_t"]).any(axis=(1, 2)))
        rows = []
        for i in range(P):
            values = {label: float(cost[i]) for label, cost in costs.items()}
            reasons = [
                f"{what} is broken by {100 * excess[i]:.3g} %"
                for what, excess in broken
                if excess[i] > 0
            ]
            if unsolved[i]:
                reasons = ["a load has no equilibrium"]
            elif any(math.isnan(cost) for cost in values.values()):
                reasons = ["an objective has no value there"]
            worst = max((float(excess[i]) for _, excess in broken), default=-1.0)
            close = [what for what, excess in broken if -0.01 < excess[i] <= 0]
            rows.append(
                {
                    "numbers": numbers[i],
                    "materials": materials,
                    "costs": values,
                    "excess": math.inf if reasons and worst <= 0 else worst,
                    "reason": "; ".join(reasons),
                    "active": tuple(close),
                }
            )
        return rows

    def metrics(
        self, numbers: Sequence[dict[str, float]], materials: dict[str, Material]
    ) -> dict[str, Array]:
        """Every metric (P, 1 + samples, loads), sample 0 nominal."""
        P, S, J = len(numbers), 1 + self._samples, len(self.loads)
        contact = self.contact.replace(**materials) if materials else self.contact
        vary: dict[str, Array] = {}
        for name, (moved, _, _) in self.spans.items():
            values = np.array([point[name] for point in numbers])
            for each, column in moved.at((values - moved.values[0]) / moved.scales[0]).items():
                vary[each] = np.broadcast_to(column[:, None], (P, S))
        if self.scatter is not None:
            drawn_inputs, u = self.scatter
            nominal = inputs(contact)
            for name, sample in drawn_inputs.points(u).items():
                own = np.broadcast_to(np.append(nominal[name], sample), (P, S))
                searched = vary.get(name)
                # about each value of a variable by the factors about its nominal one
                vary[name] = own if searched is None else searched * own / nominal[name]
        flat = {name: np.repeat(values.ravel(), J) for name, values in vary.items()}
        given: dict[str, Any] = {self.load: np.tile(self.loads, P * S)}
        states = solve_states(contact, vary=flat or None, **given)
        with np.errstate(divide="ignore", invalid="ignore"):
            states["plastic_share"] = states["A_p"] / states["A_t"]
        asked = dict.fromkeys((*self.columns, "A_t", "h"))
        return {name: np.asarray(states[name], float).reshape(P, S, J) for name in asked}

    def _coverage(
        self, numbers: Sequence[dict[str, float]], materials: dict[str, Material]
    ) -> Array:
        found = []
        for point in numbers:
            try:
                made = self.made(point, materials)
            except InvalidValue:
                found.append(math.inf)
            else:
                found.append(sum(each.coverage for each in made.populations))
        return np.array(found)

    def made(self, numbers: Mapping[str, float], materials: dict[str, Material]) -> Contact:
        """The contact of a point."""
        changes: dict[str, Any] = dict(materials)
        for name, value in numbers.items():
            moved = self.spans[name][0]
            changes |= {
                each: float(v)
                for each, v in moved.at((value - moved.values[0]) / moved.scales[0]).items()
            }
        return self.contact.replace(**changes)

    # ------------------------------------------------------------------ search
    def explore(self, materials: dict[str, Material], points: int | None) -> None:
        """Points all over the ranges."""
        width = len(self.spans)
        if not width:
            self.evaluate([{}], materials)
        elif width == 1:
            self.evaluate(self.at(np.linspace(0, 1, points or GRID)[:, None]), materials)
        else:
            count = points or SAMPLES
            # what falls or rises everywhere is best in a corner
            corners = np.array(list(itertools.product((0.0, 1.0), repeat=min(width, 6))))
            corners = np.pad(corners, ((0, 0), (0, width - corners.shape[1])), constant_values=0.5)
            inside = sobol(count, width, self.seed, 0, count)
            self.evaluate(self.at(np.concatenate([corners, inside])), materials)

    def refine(self, materials: dict[str, Material]) -> None:
        """A local search about the best point found with these materials."""
        from scipy.optimize import differential_evolution, minimize_scalar

        rows = [row for row in self.tried if row["materials"] == materials]
        order = np.argsort([_rank(row) for row in rows], kind="stable")
        u = np.array([self._where(rows[i]["numbers"]) for i in order])
        if len(self.spans) == 1:
            every = np.sort(u[:, 0])
            place = int(np.searchsorted(every, u[0, 0]))
            low, high = every[max(place - 1, 0)], every[min(place + 1, len(every) - 1)]
            minimize_scalar(
                lambda t: float(self.evaluate(self.at(np.array([[t]])), materials)[0]),
                bounds=(low, high),
                method="bounded",
                options={"xatol": 1e-4 * (high - low)},
            )
            return
        differential_evolution(
            lambda x: self.evaluate(self.at(np.atleast_2d(x.T)), materials),
            [(0.0, 1.0)] * len(self.spans),
            init=u[:: max(1, len(u) // (16 * len(self.spans)))],
            maxiter=40,
            tol=1e-4,
            rng=np.random.default_rng(self.seed),
            vectorized=True,
            updating="deferred",
            polish=False,
        )

    def _where(self, numbers: Mapping[str, float]) -> list[float]:
        """Coordinates of a point in the unit cube."""
        out = []
        for name, (_, low, high) in self.spans.items():
            value = numbers[name]
            if low > 0:
                out.append(math.log(value / low) / math.log(high / low))
            else:
                out.append((value - low) / (high - low))
        return out

    # ------------------------------------------------------------------ the answer
    def answer(self) -> Best:
        import xarray

        rows = self.tried
        best = self._best()
        numbers, materials = best["numbers"], best["materials"]
        made = self.made(numbers, materials)
        ok = np.array([not row["reason"] for row in rows])
        costs = np.array([list(row["costs"].values()) for row in rows])
        on_front = np.zeros(len(rows), bool)
        on_front[np.flatnonzero(ok)] = front(costs[ok])
        volume = None
        if len(self.objectives) > 1 and ok.any():
            volume = hypervolume(costs[ok], costs[ok].max(axis=0))
        signs = {each.label: each.sign for each in self.objectives}
        labels = list(signs)
        columns: dict[str, Any] = {
            name: ("point", [row["numbers"][name] for row in rows]) for name in self.spans
        }
        columns |= {
            name: ("point", [row["materials"][name].name for row in rows])
            for name in self.materials
        }
        columns |= {
            label: ("point", signs[label] * costs[:, i], {"long_name": self.objectives[i].aim})
            for i, label in enumerate(labels)
        }
        columns |= {
            "feasible": ("point", ok),
            "front": ("point", on_front),
            "reason": ("point", [row["reason"] for row in rows]),
        }
        at_bound = tuple(
            name
            for name, (_, low, high) in self.spans.items()
            if min(abs(numbers[name] - low), abs(numbers[name] - high)) < 1e-3 * (high - low)
        )
        notes = [f"the best {name} is an end of its range" for name in at_bound]
        if self.scatter is None and self.objectives[0].over_scatter != "mean":
            notes.append("nothing scatters: over_scatter has no meaning")
        return Best(
            values={**numbers, **materials},
            contact=made,
            objectives={label: signs[label] * cost for label, cost in best["costs"].items()},
            feasible=not best["reason"],
            reason=best["reason"],
            states=self._states(numbers, materials),
            points=xarray.Dataset(columns),
            active=best["active"],
            tolerance=self._tolerance(best),
            at_bound=at_bound,
            slopes=self._slopes(made),
            hypervolume=volume,
            warnings=tuple(notes),
        )

    def _best(self) -> dict[str, Any]:
        """The point that ranks first; of several that are as good, one in their middle."""
        ranks = np.array([_rank(row) for row in self.tried])
        alike = np.flatnonzero(ranks <= ranks.min() + 1e-12 * abs(ranks.min()))
        materials = self.tried[alike[0]]["materials"]
        ties = [i for i in alike if self.tried[i]["materials"] == materials]
        u = np.array([self._where(self.tried[i]["numbers"]) for i in ties])
        middle = np.median(u, axis=0)
        return self.tried[ties[int(np.argmin(np.sum((u - middle) ** 2, axis=1)))]]

    def _states(self, numbers: dict[str, float], materials: dict[str, Material]) -> xarray.Dataset:
        """Metrics against the load, nominal."""
        import xarray

        nominal, self.scatter = self.scatter, None
        try:
            found = self.metrics([numbers], materials)
        finally:
            self.scatter = nominal
        columns: dict[str, Any] = {}
        for name, values in found.items():
            told = METRICS.get(name) or about(name)
            attrs = {"units": told["unit"], "long_name": told["meaning"], "symbol": told["symbol"]}
            columns[name] = (self.load, values[0, 0], attrs)
        return xarray.Dataset(columns, coords={self.load: self.loads})

    def _tolerance(self, best: dict[str, Any]) -> dict[str, tuple[float, float]]:
        """Where the first objective loses less than `LOSS`, variable by variable."""
        label = self.objectives[0].label
        value = best["costs"][label]
        out = {}
        for name, (_, low, high) in self.spans.items():
            span = Span(low, high, "log" if low > 0 else "linear")
            grid = np.unique(np.append(span.at(np.linspace(0, 1, GRID + 1)), best["numbers"][name]))
            line = [{**best["numbers"], name: float(x)} for x in grid]
            rows = self._batch(line, best["materials"])
            lost = np.array([row["costs"][label] for row in rows]) - value
            good = (lost <= LOSS * abs(value)) & np.array([not row["reason"] for row in rows])
            place = int(np.searchsorted(grid, best["numbers"][name]))
            bad = np.flatnonzero(~good)
            first = bad[bad < place].max(initial=-1) + 1
            last = bad[bad > place].min(initial=len(grid)) - 1
            out[name] = (float(grid[first]), float(grid[max(last, first)]))
        return out

    def _slopes(self, made: Contact) -> dict[str, dict[str, float]]:
        """d m/d ln y at the load in the middle, by the exact sensitivities."""
        known = set(columns_of(self.contact))
        asked = [name for name in self.columns if name in known and name not in NOT_SMOOTH]
        if not (asked and self.spans):
            return {}
        middle = {self.load: float(np.sort(self.loads)[len(self.loads) // 2])}
        found = sensitivity(made, of=asked, to=list(self.spans), **middle)
        return {
            column: {
                name: found.derivative[column][name] * found.inputs[name] for name in self.spans
            }
            for column in asked
        }


NOT_SMOOTH = {"mode", "status", "residual", "iterations"}


def _rank(row: dict[str, Any]) -> float:
    """What the search makes small: the first cost, and behind every feasible point the others."""
    if row["reason"]:
        return 1e30 * (1 + min(row["excess"], 1e6))
    return next(iter(row["costs"].values()))


def _task(
    contact: Contact,
    over: Mapping[str, Any],
    objectives: list[Objective],
    limits: list[Limit],
    F_star: Any,
    pressure: Any,
    weights: ArrayLike | None,
    scatter: Mapping[str, Any] | None,
    samples: int,
    seed: int,
) -> _Task:
    """What is asked, every mistake in it told."""
    problems: list[str] = []
    given = {"F_star": F_star, "pressure": pressure}
    cases = {
        name: np.geomspace(v.low, v.high, CASES) if isinstance(v, Span) else v
        for name, v in given.items()
    }
    load, loads = "F_star", np.ones(1)
    try:
        load, _, _ = given_load(contact, cases["pressure"], cases["F_star"], None)
        loads = np.atleast_1d(np.asarray(cases[load], float))
    except InvalidValue as error:
        problems += error.problems
    share = np.ones(len(loads)) if weights is None else np.asarray(weights, float)
    if share.shape != loads.shape or not (np.all(share >= 0) and share.sum() > 0):
        problems.append(f"weights must be {len(loads)} numbers >= 0, one a load")
        share = np.ones(len(loads))
    spans: dict[str, tuple[Input, float, float]] = {}
    materials: dict[str, list[Material]] = {}
    for name, allowed in over.items():
        try:
            if _is_materials(allowed):
                if not isinstance(contact.part(name), Material):
                    problems.append(f"over[{name!r}] lists materials, but {name} is not one")
                materials[name] = list(allowed)
            else:
                spans[name] = _span(contact, name, allowed)
        except InvalidValue as error:
            problems += [text.replace("to = ", "over: ") for text in error.problems]
    if not over:
        problems.append(
            'over is empty; say what may be chosen, e.g. {"roughness.sigma": (5e-8, 3e-7)}'
        )
    if not objectives:
        problems.append("objective is empty; say what should be small or large")
    asked: list[Objective | Limit] = [*objectives, *limits]
    known = {*columns_of(contact), *METRICS} - {"mode", "status"}
    problems += [
        f"{type(each).__name__} of {each.of!r}: no such number; the states of this contact have "
        f"{', '.join(sorted(known - set(NOT_SMOOTH)))}"
        for each in asked
        if each.of not in known
    ]
    if len({each.label for each in objectives}) < len(objectives):
        problems.append("two objectives are the same")
    u = None
    if scatter and not problems:
        try:
            moved = drawn(contact, scatter, load, loads)
            u = moved, latin(samples, len(moved.known), seed, 0, samples)
        except InvalidValue as error:
            problems += [text.replace("inputs[", "scatter[") for text in error.problems]
    if problems:
        raise InvalidValue(*problems)
    return _Task(
        contact, spans, materials, objectives, limits, load, loads, share / share.sum(), u, seed
    )


def _is_materials(allowed: Any) -> bool:
    return isinstance(allowed, (list, tuple)) and any(isinstance(v, Material) for v in allowed)


def _span(contact: Contact, name: str, allowed: Any) -> tuple[Input, float, float]:
    try:
        low, high = (float(end) for end in allowed)
    except (TypeError, ValueError):
        raise InvalidValue(f"over[{name!r}] = {allowed!r} must be (low, high)") from None
    if not low < high:
        raise InvalidValue(f"over[{name!r}]: low = {low:g} must be below high = {high:g}")
    moved = moved_input(contact, name)
    for end in (low, high):
        contact.replace(
            **{k: float(v) for k, v in moved.at((end - moved.values[0]) / moved.scales[0]).items()}
        )
    return moved, low, high


# -------------------------------------------------------------------------- fronts
def front(costs: Array) -> NDArray[np.bool_]:
    """Which points no other beats: nowhere worse, somewhere better (N,) for costs (N, K).

    Examples
    --------
    >>> front(np.array([[1.0, 3.0], [2.0, 2.0], [3.0, 3.0]])).tolist()
    [True, True, False]
    """
    out = np.ones(len(costs), bool)
    for i, own in enumerate(costs):
        no_worse = np.all(costs <= own, axis=1)
        better = np.any(costs < own, axis=1)
        out[i] = not np.any(no_worse & better)
    return out


def hypervolume(costs: Array, reference: Array) -> float:
    """Volume of the costs that some point beats, up to a reference: larger is better.

    By slices along the last objective, exact.

    Examples
    --------
    >>> hypervolume(np.array([[1.0, 2.0], [2.0, 1.0]]), np.array([3.0, 3.0]))
    3.0
    """
    inside = costs[np.all(costs < reference, axis=1)]
    if not len(inside):
        return 0.0
    if costs.shape[1] == 1:
        return float(reference[0] - inside.min())
    inside = inside[np.argsort(inside[:, -1])]
    tops = np.append(inside[1:, -1], reference[-1])
    return sum(
        float(top - own) * hypervolume(inside[: i + 1, :-1], reference[:-1])
        for i, (own, top) in enumerate(zip(inside[:, -1], tops, strict=True))
        if top > own
    )


# -------------------------------------------------------------------------- turning point
def equal_share_size(
    contact: Contact,
    *,
    F_star: float | None = None,
    pressure: float | None = None,
    low: float = 0.05,
    high: float = 20.0,
    share: float = 0.5,
) -> float:
    r"""Mean particle size over σ at which particles carry a given share of the load.

    .. math:: s(x_a; F) = \tfrac12

    The size of equal shares at one load: definition B of the turning point, seen from the size.
    It moves with load, density and tip radius; no single x_a/σ stands for it.

    Parameters
    ----------
    contact : Contact
        With one population; its size distribution is scaled as a whole.
    F_star, pressure : float
        The load, as in `solve`.
    low, high : float, optional
        Range of x_a/σ searched.
    share : float, optional
        Load share of the particles.

    Returns
    -------
    float
        x_a/σ of the smallest such size; NaN where there is none in the range.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=3.5e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9)))
    >>> round(equal_share_size(contact, pressure=5e6), 3)
    2.346
    """
    from scipy.optimize import brentq

    from .equilibrium import solve

    if len(contact.populations) != 1:
        raise InvalidValue("equal_share_size needs exactly one population of particles")
    (dust,) = contact.populations
    unit = contact.roughness.sigma / dust.diameter.mean_diameter
    bare = contact.replace(outputs=())

    def excess(log_ratio: float) -> float:
        sizes = dust.diameter.scaled(math.exp(log_ratio) * unit)
        try:
            made = bare.replace(particles=dust.replace(diameter=sizes))
        except InvalidValue:  # jammed: particles that cover the area carry everything
            return 1 - share
        state = solve(made, F_star=F_star, pressure=pressure)
        return float(state.particle_load_share) - share

    grid = np.linspace(math.log(low), math.log(high), 49)
    before = excess(float(grid[0]))
    for start, end in itertools.pairwise(grid):
        after = excess(float(end))
        if before < 0 <= after:
            return math.exp(brentq(excess, start, end, xtol=1e-12))
        before = after
    return math.nan
