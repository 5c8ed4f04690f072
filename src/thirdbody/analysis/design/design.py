r"""Which particles, how many, on which surface: the best inputs of a contact over a range of loads.

A point y of the design is a contact; its states under the load cases :math:`F_j` with weights
:math:`w_j` give metrics m(y, F). An objective reduces a metric over the loads,

.. math:: \sum_j w_j m_j, \qquad \max_j m_j, \qquad \sum_j w_j\,1[\,low \le m_j \le high\,],

and over samples of what scatters; limits bound metrics at every load.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...contact.contact import Contact
from ...equilibrium.columns import PLASTIC_SHARE, about, columns_of
from ...equilibrium.load import as_load
from ...errors import Note, ThirdBodyError
from ...numerics.sampling import Span
from ...quantities.arguments import need_positive
from ...quantities.carried import takes_units
from ...quantities.notebook import Card, Row
from ...quantities.notebook import words_of as value_in_words
from ...quantities.progress import reporting
from ...quantities.record import Column, TableRecord, Variable
from ..inputs import declared_quantity, words_of
from ..sensitivity import sensitivity
from .front import front, hypervolume
from .problem import Limit, Objective, Suspension
from .search import AMOUNT, CLEARLY_FEW, DENSITY, GRID, NOTHING, SAMPLES, STARTS, STEPS, Point, Task
from .task import NOT_SMOOTH, design_task

if TYPE_CHECKING:
    import xarray

__all__ = ["Best", "design"]

Array = NDArray[np.float64]


METRICS = {
    "plastic_share": PLASTIC_SHARE,
    "buried_share": Column("w_b", "1", "share of the load on particles deeper than their radius"),
}
"""What is known beside the columns of the states; the first may be asked for."""
LOSS, FLAT = 0.05, 1e-3
"""Of the objective, inside the tolerance band and on a plateau."""
WIDE = 0.01
"""Part of a value that a plateau is wider than."""
AHEAD = 20
"""Points of a band that are tried together: as many as go by shared nodes."""
AT_END = 1e-3
"""Part of a range that counts as its end."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Best(TableRecord):
    """The answer of `design`; as labelled data and as a table it is ``points``.

    Attributes
    ----------
    values : dict
        The best value of every variable; of one of the best, for several objectives.
    contact : Contact
        The contact with these values.
    objectives : dict
        Value of every objective there.
    feasible : bool
        Whether every limit holds there; if not, nothing tried was feasible.
    reason : str
        Why the point that came nearest is not feasible; empty where one is.
    load, loads : str, array (L,)
        Which load is given, and its values.
    of_states, of_points : dict of Variable
        The columns of ``states`` and ``points``, which are made of them when asked for.
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
    plateau : dict
        The same for 0.1 %, where that range is wider than 1 %: any value of it is as good.
    at_bound : tuple of str
        Variables whose best value is an end of their range: the optimum may lie beyond.
    slopes : dict
        d m/d ln y of every metric asked for, per variable, at ``middle_load``; at a
        constant concentration where there is a `Suspension`.
    hypervolume : float or None
        Of the front against the worst feasible value of each objective; None for one objective.
    warnings : tuple of str
        What to know before the answer is used, one sentence each.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> best = tb.design(
    ...     contact,
    ...     vary={"particles.diameter.mean+particles.diameter.std": (50e-9, 1e-6)},
    ...     objective=tb.objectives.Objective(of="A_t", aim="smallest"),
    ...     limits=[tb.objectives.Limit(of="plastic_share", most=0.1)],
    ...     pressure=[1e6, 5e6],
    ... )
    >>> [round(float(x) * 1e9) for x in best.values.values()], best.active, best.at_bound
    ([84], (), ())
    """

    in_dict = (
        ("values", lambda best: {n: getattr(v, "name", v) for n, v in best.values.items()}),
        *("objectives", "feasible", "reason", "active", "tolerance", "plateau", "at_bound"),
        *("slopes", "hypervolume"),
        ("states", (("", lambda best: _values(best.of_states)), ("", lambda b: {b.load: b.loads}))),
        *(("points", lambda best: _values(best.of_points)), "warnings"),
    )
    along = "point"
    values: dict[str, Any]
    contact: Contact
    objectives: dict[str, float]
    feasible: bool
    reason: str
    load: str
    loads: Array = field(repr=False)
    of_states: dict[str, Variable] = field(repr=False)
    of_points: dict[str, Variable] = field(repr=False)
    active: tuple[str, ...]
    tolerance: dict[str, tuple[float, float]]
    plateau: dict[str, tuple[float, float]]
    at_bound: tuple[str, ...]
    slopes: dict[str, dict[str, float]]
    hypervolume: float | None = None
    warnings: tuple[str, ...] = ()

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: the best values, and the objectives there."""
        rows = []
        for name, value in {**self.values, **self.objectives}.items():
            column = self.of_points[name]
            rows.append(Row(name, [_in_words(value, column)], column.meaning))
        notes = (self.reason,) if self.reason else ()
        yield Card("Best values, and objectives there", rows, (*notes, *self.warnings))

    @property
    def middle_load(self) -> float:
        """The load at which slopes are taken, in SI: of an even number the upper middle one."""
        return _middle(self.loads)

    def variables(self) -> dict[str, Variable]:
        """Every point tried."""
        return self.of_points

    @cached_property
    def states(self) -> xarray.Dataset:
        """Every metric against the load."""
        import xarray  # takes longer to load than most designs to find

        return xarray.Dataset(self.of_states, coords={self.load: self.loads})

    @cached_property
    def points(self) -> xarray.Dataset:
        """Every point tried."""
        return self.to_dataset()


def _in_words(value: object, column: Variable) -> str:
    """A value of a variable or objective: a number with its unit, or the name of a material."""
    return value_in_words(getattr(value, "name", value), column.unit)


def _values(table: dict[str, Variable]) -> dict[str, ArrayLike]:
    return {name: column.values for name, column in table.items()}


# -------------------------------------------------------------------------- the search
@takes_units
def design(
    contact: Contact,
    *,
    vary: Mapping[str, object],
    objective: Objective | Sequence[Objective],
    limits: Sequence[Limit] = (),
    pressure: ArrayLike | Span | None = None,
    F_star: ArrayLike | Span | None = None,
    weights: ArrayLike | None = None,
    scatter: Mapping[str, object] | None = None,
    samples: int = 16,
    points: int | None = None,
    seed: int = 0,
    suspension: Suspension | None = None,
    progress: bool | Callable[[int], None] = False,
) -> Best:
    r"""The best inputs of a contact over a range of loads, under limits and scatter.

    .. math:: \min_y\; R_s\,R_F\; m(y, F), \qquad g_k(y) \le 0

    Parameters
    ----------
    contact : Contact
        What is not searched, and the outputs that metrics come from.
    vary : mapping
        What may be chosen: dotted names of numbers with their range (low, high) in SI, several
        names joined by "+" that move by one factor ("particles.diameter.mean+"
        "particles.diameter.std" keeps the relative width); "particles.concentration" with a
        ``suspension``; or a name of a material with a list of `Material`.
    objective : Objective or several
        Several give the front of points that no other beats in all of them.
    limits : sequence of Limit, optional
        Besides, always: every load has a state, A_t < 0.2, particles cover less than 0.3 of the
        area, and those that sit deeper than their radius, where the laws of a contact end, carry
        less than 0.05 of the load.
    pressure, F_star : array, or Span
        Load cases; a `Span` stands for 32 of them, evenly in the logarithm. One of the two.
    weights : array, optional
        Of the load cases, equal by default; they are made to sum to one.
    scatter : mapping, optional
        Inputs that scatter, as in `propagate`. An input that is also searched scatters about each
        of its values by the same factors.
    samples : int, optional
        Of the scatter: one Latin hypercube for all points, so that they can be compared.
    points : int, optional
        Tried before the search goes local: 64 for one number, 384 for several.
    seed : int, optional
    suspension : Suspension, optional
        What brings the particles. Their number then follows from size and concentration; without
        it the number per area stays as it is when the size changes.
    progress : bool or callable, optional
        True shows a bar; a callable gets the number of points tried.

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
    the best point (`scipy.optimize.minimize_scalar`). Several numbers: the corners of the ranges
    and a Sobol design, or sizes with sixteen amounts each, then COBYQA (`scipy.optimize.minimize`)
    from the three best places that lie apart, with the limits as constraints. Several objectives:
    the design alone. Islands of feasible points that hold less than one part in ``points`` of the
    ranges can be missed. A point that breaks a limit ranks behind all that do not, by how much it
    breaks it.

    References
    ----------
    Brent 1973, Algorithms for Minimization without Derivatives, ch. 5; Ragonneau and Zhang 2025,
    COBYQA, in `scipy.optimize.minimize`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9)))
    >>> best = tb.design(contact, F_star=[1e-5, 1e-4], points=16,
    ...     vary={"particles.diameter.mean+particles.diameter.std": (50e-9, 1e-6)},
    ...     objective=tb.objectives.Objective(of="particle_load_share", aim="window"))
    >>> best.feasible
    True
    """
    objectives = [objective] if isinstance(objective, Objective) else list(objective)
    task = design_task(
        contact,
        vary=vary,
        objectives=objectives,
        limits=list(limits),
        loads={"F_star": F_star, "pressure": pressure},
        weights=weights,
        scatter=scatter,
        samples=samples,
        seed=seed,
        suspension=suspension,
    )
    local = len(objectives) == 1 and bool(task.variables)
    if points is not None:
        need_positive(points=points)
    expected = _expected_points(task, points, local)
    with reporting("design", expected, 0, progress, "points") as task.report:
        for materials in task.choices():
            task.explore(materials, points)
            if local:
                task.refine(materials)
        return _answer(task)


def _expected_points(task: Task, points: int | None, local: bool) -> int:
    """Points that will be tried, or a few less."""
    width = len(task.variables)
    if not width:
        return len(task.choices())
    one = points or (GRID if width == 1 else SAMPLES)
    more = (25 if width == 1 else STARTS * STEPS) if local else 0
    return len(task.choices()) * (one + more)


# -------------------------------------------------------------------------- the answer
def _answer(task: Task) -> Best:
    rows, best = task.tried, task.best()
    made = task.contact_at(best.numbers, best.materials)
    ok = np.array([not point.reason for point in rows])
    costs = np.array([list(point.costs.values()) for point in rows])
    on_front = np.zeros(len(rows), bool)
    on_front[np.flatnonzero(ok)] = front(costs[ok])
    volume = None
    if len(task.objectives) > 1 and ok.any():
        volume = hypervolume(costs[ok], costs[ok].max(axis=0))
    signs = {objective.label: objective.sign for objective in task.objectives}
    columns = {
        name: _of_points([point.numbers[name] for point in rows], **_about_variable(task, name))
        for name in task.variables
    }
    columns |= {
        name: _of_points([point.materials[name].name for point in rows], long_name="material")
        for name in task.materials
    }
    columns |= {
        objective.label: _of_points(objective.sign * costs[:, i], **_about_objective(objective))
        for i, objective in enumerate(task.objectives)
    }
    columns |= {
        "feasible": _of_points(ok, long_name="whether every limit holds"),
        "front": _of_points(on_front, long_name="whether no other beats it in every objective"),
        "reason": _of_points([point.reason for point in rows], long_name="why it is not feasible"),
    }
    ends = {name: variable.place(best.numbers[name]) for name, variable in task.variables.items()}
    at_bound = tuple(name for name, u in ends.items() if min(u, 1 - u) < AT_END)
    notes: list[str] = [
        Note(
            f"the best {words_of(task.contact, name)} is an end of its range",
            code=f"design.end.{name}",
        )
        for name in at_bound
    ]
    tolerance, plateau = _bands(task, best)
    if task.scatter is None and any(
        objective.over_scatter not in ("mean", "nominal") for objective in task.objectives
    ):
        notes.append("nothing scatters: over_scatter has no meaning")
    return Best(
        values={**best.numbers, **best.materials},
        contact=made,
        objectives={label: signs[label] * cost for label, cost in best.costs.items()},
        feasible=not best.reason,
        reason=best.reason,
        load=task.load,
        loads=task.loads,
        of_states=_states(task, best),
        of_points=columns,
        active=best.active,
        tolerance=tolerance,
        plateau=plateau,
        at_bound=at_bound,
        slopes=_slopes(task, best, made),
        hypervolume=volume,
        warnings=tuple(notes),
    )


def _of_points(values: ArrayLike, **labels: str) -> Variable:
    return Variable(("point",), np.asarray(values), labels)


def _about_variable(task: Task, name: str) -> dict[str, str]:
    """Unit and words of what is searched."""
    words = words_of(task.contact, name)
    if name == AMOUNT and task.suspension is not None:
        by = task.suspension.by
        return {"units": CONCENTRATIONS[by], "long_name": f"{words} by {by}"}
    return {
        "units": declared_quantity(task.contact, name.split("+")[0])["unit"],
        "long_name": words,
    }


def _about_objective(objective: Objective) -> dict[str, str]:
    """Unit and words of what is to be good."""
    column = METRICS.get(objective.of) or about(objective.of)
    how = ", ".join(objective.label.split(":")[1:])
    words = column.meaning + (f" ({how})" if how else "")
    unit = "1" if objective.aim == "window" else column.unit
    return {"units": unit, "long_name": words, "aim": objective.aim}


APART = ("coverage", "buried_share", "refused")
"""What `Task.metrics` holds beside the metrics that were asked for."""


def _states(task: Task, best: Point) -> dict[str, Variable]:
    """Metrics against the load, nominal."""
    metrics = task.metrics([best.numbers], best.materials, samples=False)
    columns: dict[str, Variable] = {}
    first = (name for name in metrics if name not in APART)
    for name in (*first, "buried_share"):
        column = METRICS.get(name) or about(name)
        columns[name] = Variable((task.load,), metrics[name].reshape(-1), column.labels)
    return columns


CONCENTRATIONS = {"mass": "1", "volume": "1", "number": "1/m^3", "mass per volume": "kg/m^3"}
"""Units of how much of a fluid is particles."""
Bands = dict[str, tuple[float, float]]


def _bands(task: Task, best: Point) -> tuple[Bands, Bands]:
    """Where the first objective loses less than `LOSS`, and `FLAT`, variable by variable."""
    tolerance = {name: _band(task, best, name, LOSS, (0.0, 1.0)) for name in task.variables}
    plateau = {}
    for name, ends in tolerance.items():
        variable = task.variables[name]
        low, high = _band(
            task, best, name, FLAT, (variable.place(ends[0]), variable.place(ends[1]))
        )
        if high - low > WIDE * max(abs(low), abs(high)):
            plateau[name] = low, high
    return tolerance, plateau


def _band(
    task: Task, best: Point, name: str, fraction: float, places: tuple[float, float]
) -> tuple[float, float]:
    """Range between two places in which the first objective loses less than this fraction of it."""
    label = task.objectives[0].label
    value, best_value = best.costs[label], best.numbers[name]
    among = task.variables[name].span.values_at(np.linspace(*places, GRID + 1))
    grid = np.unique(np.append(among, best_value))
    place = int(np.searchsorted(grid, best_value))
    weighed = {one.of for one in task.objectives} | {limit.of for limit in task.limits}
    few = NOTHING if "buried_share" in weighed else CLEARLY_FEW

    def good(some: NDArray[np.intp]) -> NDArray[np.bool_]:
        rows = task.judge_points(
            [{**best.numbers, name: float(grid[i])} for i in some],
            best.materials,
            few_buried=few,
        )
        lost = np.array([point.costs[label] for point in rows]) - value
        return (lost <= fraction * abs(value)) & np.array([not point.reason for point in rows])

    first, last = (_last_good(good, place, way, len(grid)) for way in (-1, 1))
    return float(grid[first]), float(grid[last])


def _last_good(
    good: Callable[[NDArray[np.intp]], NDArray[np.bool_]], place: int, way: int, count: int
) -> int:
    """The last of a row of points, from a place to one side, before the first that is not good."""
    side = np.arange(place + way, count if way > 0 else -1, way)
    for start in range(0, len(side), AHEAD):
        some = side[start : start + AHEAD]
        if len(bad := np.flatnonzero(~good(some))):
            return int(some[bad[0]]) - way
    return int(side[-1]) if len(side) else place


def _middle(loads: Array) -> float:
    """The load in the middle of some, of an even number the upper one."""
    return float(np.sort(loads)[len(loads) // 2])


def _slopes(task: Task, best: Point, made: Contact) -> dict[str, dict[str, float]]:
    """d m/d ln y at the load in the middle, by the exact sensitivities."""
    smooth = set(columns_of(made)) - NOT_SMOOTH
    wanted = [name for name in task.columns if name in smooth]
    if "plastic_share" in task.columns:
        wanted = list(dict.fromkeys([*wanted, "A_p", "A_t"]))
    labels = [name for name, variable in task.variables.items() if variable.moved is not None]
    if task.suspension is not None:
        labels.append(DENSITY)
    if not (wanted and labels):
        return {}
    middle = as_load(task.load, _middle(task.loads))
    try:
        sensitivities = sensitivity(made, of=wanted, to=labels, **middle)
    except ThirdBodyError:
        return {}
    slopes = {
        column: {
            name: sensitivities.derivative[column][name] * sensitivities.inputs[name]
            for name in labels
        }
        for column in wanted
    }
    if "plastic_share" in task.columns:
        A_p, A_t = sensitivities.value["A_p"], sensitivities.value["A_t"]
        slopes["plastic_share"] = {
            name: (slopes["A_p"][name] - A_p / A_t * slopes["A_t"][name]) / A_t for name in labels
        }
    if task.suspension is not None:
        per_density = {column: by_input.pop(DENSITY) for column, by_input in slopes.items()}
        for name in task.variables:
            crowding = _crowding(task, best, name)
            for column, by_input in slopes.items():
                by_input[name] = by_input.get(name, 0.0) + crowding * per_density[column]
    return {column: slopes[column] for column in task.columns if column in slopes}


def _crowding(task: Task, best: Point, name: str) -> float:
    """d ln η_a/d ln y of the particles that a fluid brings."""
    step = 1e-5
    high, low = (
        task.contact_at({**best.numbers, name: best.numbers[name] * math.exp(t)}, best.materials)
        for t in (step, -step)
    )
    ratio = high.populations[0].areal_density / low.populations[0].areal_density
    return math.log(ratio) / (2 * step)
