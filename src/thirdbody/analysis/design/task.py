"""What a design is asked, with every mistake in it told."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...contact.contact import Contact
from ...contact.output import AbstractOutput
from ...effects import REGISTRY as OUTPUTS
from ...equilibrium.columns import COLUMNS, PLASTIC_SHARE
from ...equilibrium.solve import given_load
from ...errors import Advice, InvalidValue, Mistake, Problem
from ...numerics.sampling import Span, latin
from ...populations.materials import Material
from ...quantities.arguments import is_empty
from ...quantities.nearest import guess
from ..inputs import input_of as moved_input
from ..uncertainty.inputs import drawn_inputs
from .problem import Limit, Objective, Suspension
from .search import AMOUNT, DENSITY, Task, Variable

__all__ = ["NOT_SMOOTH", "design_task", "problems_of_metric"]

Array = NDArray[np.float64]

NOT_SMOOTH = {"mode", "status", "residual", "iterations"}
CASES = 32
"""Load cases of a range."""


def _load_cases(
    contact: Contact, load_inputs: Mapping[str, Any], weights: ArrayLike | None
) -> tuple[str, Array, Array]:
    """Name of the load, its values, and their weights."""
    cases = {
        name: np.geomspace(v.low, v.high, CASES) if isinstance(v, Span) else v
        for name, v in load_inputs.items()
    }
    load, _, _ = given_load(contact, cases["pressure"], cases["F_star"], None)
    loads = np.atleast_1d(np.asarray(cases[load], float))
    share = np.ones(len(loads)) if weights is None else np.asarray(weights, float)
    if share.shape != loads.shape or not (np.all(share >= 0) and share.sum() > 0):
        raise InvalidValue(
            f"weights must be {len(loads)} numbers >= 0, one a load", code=Mistake.SHAPE
        )
    return load, loads, share / share.sum()


def design_task(
    contact: Contact,
    *,
    vary: Mapping[str, object],
    objectives: list[Objective],
    limits: list[Limit],
    loads: Mapping[str, object],
    weights: ArrayLike | None,
    scatter: Mapping[str, object] | None,
    samples: int,
    seed: int,
    suspension: Suspension | None,
) -> Task:
    """Task of `design`; all mistakes in it are raised together."""
    problems: list[str] = []
    load, cases, share = "F_star", np.ones(1), np.ones(1)
    try:
        load, cases, share = _load_cases(contact, loads, weights)
    except InvalidValue as error:
        problems += error.problems
    variables, materials, wrong = _choices(contact, vary)
    problems += wrong + _unknown(contact, objectives, limits)
    moving = {name for label in (*vary, *(scatter or {})) for name in label.split("+")}
    problems += _suspension_problems(contact, suspension, moving, variables, materials)
    drawn = None
    if scatter and not problems:
        try:
            moved = drawn_inputs(contact, scatter, load, cases, "scatter[{!r}]")
            drawn = moved, latin(samples, len(moved.distributions), seed, 0, samples)
        except InvalidValue as error:
            problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    return Task(
        contact=contact,
        variables=variables,
        materials=materials,
        objectives=objectives,
        limits=limits,
        load=load,
        loads=cases,
        weights=share,
        scatter=drawn,
        suspension=suspension,
        seed=seed,
    )


def _choices(
    contact: Contact, vary: Mapping[str, Any]
) -> tuple[dict[str, Variable], dict[str, list[Material]], list[str]]:
    """Numbers and materials that may be chosen, and what is wrong with them."""
    variables: dict[str, Variable] = {}
    materials: dict[str, list[Material]] = {}
    problems: list[str] = []
    for name, allowed in vary.items():
        try:
            if _is_materials(allowed):
                if not isinstance(contact.value_at(name), Material):
                    rule = f"lists materials, but {name} is not one"
                    raise InvalidValue(Problem(f"vary[{name!r}]", rule, code=Mistake.KIND))
                materials[name] = list(allowed)
            else:
                variables[name] = _variable(contact, name, allowed)
        except InvalidValue as error:
            problems += error.problems
    if not vary:
        problems.append(
            is_empty("vary", 'say what may be chosen, e.g. {"roughness.sigma": (5e-8, 3e-7)}')
        )
    return variables, materials, problems


def _unknown(
    contact: Contact, objectives: Sequence[Objective], limits: Sequence[Limit]
) -> list[str]:
    """Problems of objectives and limits: names of no column, or names given twice."""
    problems: list[str] = []
    if not objectives:
        problems.append(is_empty("objective", "say what should be small or large"))
    metrics = {
        "objective": [objective.of for objective in objectives],
        "limits": [limit.of for limit in limits],
    }
    for argument, names in metrics.items():
        for i, of in enumerate(names):
            place = f"{argument}[{i}].of" if len(names) > 1 else f"{argument}.of"
            problems += problems_of_metric(place, of, repr(of), contact.outputs)
    if len({objective.label for objective in objectives}) < len(objectives):
        problems.append(Problem("", "two objectives are the same", code=Mistake.CLASH))
    return problems


def problems_of_metric(
    place: str, of: str, value: str, outputs: Iterable[AbstractOutput | type[AbstractOutput]]
) -> list[Problem]:
    """Problem of an objective or a limit that is no number of states with these outputs."""
    columns = {**COLUMNS, "plastic_share": PLASTIC_SHARE}
    columns |= {name: column for output in outputs for name, column in output.columns.items()}
    meanings = {name: column.meaning for name, column in columns.items() if name not in NOT_SMOOTH}
    if of in meanings:
        return []
    rule = "is not a number of the states of this contact"
    homes = {
        column: kind
        for kind in OUTPUTS.values()
        if issubclass(kind, AbstractOutput)
        for column in kind.columns
    }
    hint: str
    if home := homes.get(of):
        hint = Advice(f"outputs.{home.__name__} has it", f"a table [outputs.{home.name}] has it")
    else:
        hint = guess(of, sorted(meanings), meanings=meanings, otherwise="they have ")
    return [Problem(place, rule, value, hint=hint, code=Mistake.UNKNOWN)]


def _suspension_problems(
    contact: Contact,
    suspension: Suspension | None,
    moving: set[str],
    variables: Mapping[str, Variable],
    materials: Mapping[str, list[Material]],
) -> list[str]:
    """Problems of the fluid that brings the particles."""
    if suspension is None:
        if AMOUNT in moving:
            rule = "needs suspension=Suspension(gap=...), which says of what"
            return [Problem(f"vary[{AMOUNT!r}]", rule, code=Mistake.MISSING)]
        return []
    if len(contact.populations) != 1:
        rule = "needs exactly one population of particles"
        return [Problem("suspension", rule, code=Mistake.BEYOND)]
    out: list[str] = []
    if DENSITY in moving:
        rule = f"follows from the suspension: vary {AMOUNT} instead"
        out.append(Problem(DENSITY, rule, code=Mistake.CLASH))
    if AMOUNT not in variables and suspension.concentration is None:
        rule = f"is missing, and vary has no {AMOUNT!r}"
        out.append(Problem("Suspension.concentration", rule, code=Mistake.MISSING))
    if suspension.by not in ("mass", "mass per volume"):
        return out
    listed = materials.get("particles.material", [])
    if listed and suspension.particle_density is not None:
        out.append(
            Problem(
                "Suspension.particle_density",
                "cannot hold for several materials",
                hint="give each its own, " + Advice("material.replace(density=...)", "key density"),
                code=Mistake.CLASH,
            )
        )
    every = listed or [contact.populations[0].material]
    out += [
        Problem(
            "",
            "a concentration by mass needs the density of "
            f"{material.name or 'the particles'} [kg/m^3]",
            hint="give it with the material, or for one material as Suspension.particle_density",
            code=Mistake.MISSING,
        )
        for material in every
        if material.density is None and suspension.particle_density is None
    ]
    return out


def _is_materials(allowed: object) -> bool:
    return isinstance(allowed, (list, tuple)) and any(isinstance(v, Material) for v in allowed)


def _variable(contact: Contact, name: str, allowed: Any) -> Variable:
    try:
        low, high = (float(end) for end in allowed)
    except (TypeError, ValueError):
        raise InvalidValue(
            Problem(f"vary[{name!r}]", "must be (low, high)", repr(allowed), code=Mistake.KIND)
        ) from None
    if not low < high:
        rule = f": low = {low:g} must be below high = {high:g}"
        hint = "exchange them" if low > high else "what is not to be chosen needs no range"
        raise InvalidValue(Problem(f"vary[{name!r}]", rule, hint=hint, code=Mistake.ORDER))
    if name == AMOUNT:
        if low <= 0:
            rule = f": low = {low:g} must be > 0"
            raise InvalidValue(Problem(f"vary[{name!r}]", rule, code=Mistake.RANGE))
        return Variable(name, low, high, None)
    variable = Variable(name, low, high, moved_input(contact, name))
    for end in (low, high):
        # of itself each end must be allowed; that particles jam depends on the others
        changes = {k: float(v) for k, v in variable.changes(end).items()}
        sparse = {DENSITY: 0.0} if name.startswith("particles.diameter.") else {}
        contact.replace(**(sparse | changes))
    return variable
