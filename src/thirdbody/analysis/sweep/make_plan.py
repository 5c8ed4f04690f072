"""A plan from what is asked of a sweep."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from ...contact.contact import Contact
from ...equilibrium.columns import columns_of, quantity_of
from ...equilibrium.solve import given_load
from ...equilibrium.states import unknown_inputs
from ...errors import InvalidValue, Mistake, Problem
from ...numerics.sampling import DESIGNS, Span, SweepDesign
from ...quantities.arguments import only_one
from ...quantities.units import Range
from ...quantities.value import Value, problem_with
from .plan import CHUNK, Arrays, Listed, Plan, Sampled
from .reduction import Reduction

CELL = 100_000_000
"""Numbers of one cell that may be held in memory for exact quantiles (0.8 GB)."""
ABSENT = ("particles.diameter.mean", "particles.areal_density")


# -------------------------------------------------------------------------- making a plan
def make_plan(
    contact: Contact,
    *,
    pressure: object = None,
    F_star: object = None,
    d: object = None,
    vary: Mapping[str, object] | None = None,
    design: SweepDesign = "grid",
    samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
    reduce: Mapping[str, object] | None = None,
    chunk: int = CHUNK,
) -> Plan:
    """The plan that these arguments describe; see `sweep`."""
    load, loads = only_one(pressure=pressure, F_star=F_star, d=d)
    entries: dict[str, object] = dict(vary or {})
    problems = _not_known("design", design, get_args(SweepDesign))
    if load in entries:
        raise InvalidValue(
            Problem(f"vary[{load!r}]", "is the load, which is given already", code=Mistake.CLASH)
        )
    problems += unknown_inputs(contact, entries)
    listed, spans, slips = _inputs(contact, load, entries | {load: loads}, design)
    problems += slips
    if design in DESIGNS and not spans and not problems:
        problems.append(
            Problem(
                "design",
                "samples ranges and none is given; a range is (low, high) or "
                "{'low': ..., 'high': ..., 'scale': 'log'}",
                repr(design),
                code=Mistake.MISSING,
            )
        )
    problems += _sampling_problems(design, samples, seed)
    if isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1:
        problems.append(
            Problem(
                "chunk",
                "must be a whole number of states, at least 1",
                repr(chunk),
                code=Mistake.KIND,
            )
        )
    problems += _unequal_lengths(listed) if design == "zip" else []
    available = columns_of(contact)
    problems += [p for name in columns or () for p in _not_known("column", name, available)]
    if problems:
        raise InvalidValue(*problems)

    dims = _zip_inputs(listed) if design == "zip" else _grid(listed)
    if spans:
        assert samples is not None
        dims.append(Sampled(spans, design, samples, seed, 0, samples))
    kept = tuple(name for name in available if name != load and name in (columns or available))
    if reduce is None:
        return Plan(contact, load, tuple(dims), kept, None, chunk)
    words = ("mode", "status", "iterations", *(() if columns else ("residual",)))
    kept = tuple(name for name in kept if name not in words)
    reduction = Reduction.read(reduce, {dim.name: dim.names for dim in dims}, kept)
    dims.sort(key=lambda dim: dim.name in reduction.over)
    plan = Plan(contact, load, tuple(dims), kept, reduction, chunk)
    return _with_whole_cells(plan) if reduction.quantiles else plan


def _inputs(
    contact: Contact, load: str, entries: Mapping[str, object], design: str
) -> tuple[Arrays, dict[str, Span], list[str]]:
    """Lists of values and ranges to be sampled, the load among them, and what is wrong."""
    listed: Arrays = {}
    spans: dict[str, Span] = {}
    problems: list[str] = []
    for name, entry in entries.items():
        label = load if name == load else f"vary[{name!r}]"
        if isinstance(entry, Mapping) or (design in DESIGNS and isinstance(entry, tuple)):
            if design not in DESIGNS:
                problems.append(
                    Problem(
                        label,
                        "is a range to be sampled, which needs design = 'latin' or 'sobol'",
                        repr(entry),
                        code=Mistake.IDLE,
                    )
                )
                continue
            span, why = _span(label, entry)
            problems += why
            spans |= {name: span} if span else {}
            values = np.array([span.low, span.high]) if span else np.empty(0)
        else:
            values = _as_array(entry)
            if not len(values):
                problems.append(
                    Problem(label, "is empty; give at least one value", code=Mistake.EMPTY)
                )
            listed[name] = values
        if name == load:
            problems += _refused_loads(contact, load, entry, values)
        else:
            problems += _refused_numbers(contact, label, name, values)
    return listed, spans, problems


def _grid(listed: Arrays) -> list[Listed | Sampled]:
    """A dimension for each input."""
    return [Listed(name, {name: values}) for name, values in listed.items()]


def _zip_inputs(listed: Arrays) -> list[Listed | Sampled]:
    """One dimension of all inputs; a single value goes with every state."""
    length = max(map(len, listed.values()))
    return [Listed("state", {name: np.broadcast_to(v, (length,)) for name, v in listed.items()})]


def _unequal_lengths(listed: Arrays) -> list[str]:
    """Why these inputs cannot be zipped."""
    sizes = {name: len(values) for name, values in listed.items()}
    if len({size for size in sizes.values() if size != 1}) <= 1:
        return []
    shown = ", ".join(f"{name} {size}" for name, size in sizes.items())
    return [
        Problem(
            "design", f"needs inputs of one length, and got {shown}", "'zip'", code=Mistake.SHAPE
        )
    ]


def _with_whole_cells(plan: Plan) -> Plan:
    """Blocks that hold every sample of a cell, as exact quantiles need."""
    cell = math.prod(plan.whole.sizes[plan.outer :])
    numbers = cell * (len(plan.columns) + 3)
    if numbers > CELL:
        raise InvalidValue(
            f"reduce['quantiles']: a cell has {cell:,} samples of {len(plan.columns)} columns, and "
            f"exact quantiles need them in memory, which holds {CELL:,} numbers; name fewer "
            f"columns, take at most {CELL // 4:,} samples, or leave the quantiles out (mean, "
            "extrema and exceed have no limit)",
            code=Mistake.TOO_LARGE,
        )
    return dataclasses.replace(plan, chunk=max(plan.chunk, cell))


def _span(label: str, entry: Any) -> tuple[Span | None, list[str]]:
    """A range, or what is wrong with it."""
    pair = not isinstance(entry, Mapping)
    keys = {"low": entry[0], "high": entry[-1]} if pair and len(entry) == 2 else {}
    keys = keys if pair else dict(entry)
    if not {"low", "high"} <= set(keys) <= {"low", "high", "scale"}:
        return None, [
            Problem(
                label,
                "must be (low, high) or have the keys low, high, scale",
                repr(entry),
                code=Mistake.KIND,
            )
        ]
    low, high, scale = keys["low"], keys["high"], keys.get("scale", "linear")
    problems = _not_known(f"{label} scale", scale, ("linear", "log"))
    for end in (low, high):
        about: Range = {"unit": "SI", "gt": None, "ge": None, "lt": None, "le": None, "hint": ""}
        if problem_with(about, end):
            problems.append(
                Problem(label, f": {end!r} must be a finite number in SI units", code=Mistake.RANGE)
            )
    if problems:
        return None, problems
    if not low < high:
        return None, [
            Problem(label, f": low = {low:g} must be below high = {high:g}", code=Mistake.ORDER)
        ]
    if scale == "log" and low <= 0:
        return None, [
            Problem(label, f": low = {low:g} must be > 0 with scale = 'log'", code=Mistake.RANGE)
        ]
    return Span(float(low), float(high), scale), []


def _sampling_problems(design: str, samples: object, seed: object) -> list[str]:
    out: list[str] = []
    if design in DESIGNS:
        if isinstance(samples, bool) or not isinstance(samples, int) or samples < 1:
            out.append(
                Problem(
                    "samples",
                    "must be a whole number, at least 1",
                    repr(samples),
                    code=Mistake.KIND,
                )
            )
        elif samples > 2**48:
            out.append(
                Problem("samples", f"must be at most {2**48:,}", f"{samples:,}", code=Mistake.RANGE)
            )
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            out.append(
                Problem("seed", "must be a whole number, at least 0", repr(seed), code=Mistake.KIND)
            )
    elif samples is not None:
        out.append(
            Problem(
                "samples", "goes with design = 'latin' or 'sobol'", repr(samples), code=Mistake.IDLE
            )
        )
    return out


def _not_known(what: str, word: object, options: Sequence[str]) -> list[str]:
    if word in options:
        return []
    return [
        Problem(
            what, f"must be one of {', '.join(map(repr, options))}", repr(word), code=Mistake.OPTION
        )
    ]


def _as_array(entry: object) -> NDArray[Any]:
    """Numbers as they are; anything else as objects."""
    if isinstance(entry, (str, Value)) or not np.iterable(entry):
        entry = [entry]
    values = list(entry) if not isinstance(entry, np.ndarray) else entry.ravel()
    if isinstance(values, np.ndarray) and values.dtype.kind in "fiub":
        return values
    numbers = (int, float, np.number, np.bool_)
    if len(values) and all(isinstance(value, numbers) for value in values):
        return np.asarray(values)
    out = np.empty(len(values), dtype=object)
    out[:] = values
    return out


def _refused_numbers(contact: Contact, label: str, name: str, values: NDArray[Any]) -> list[str]:
    """Numbers that the field never takes; the rest is for the contact to judge."""
    about = quantity_of(contact, name)
    if about is None or values.dtype.kind not in "fiu" or not len(values):
        return []
    some = values[values != 0] if name in ABSENT else values
    ends = [] if not len(some) else [some.min(), some.max()]
    bad = [value for value in ends if problem_with(about, value)]
    return [
        Problem(label, f": {value:g} {problem_with(about, value)}", code=Mistake.RANGE)
        for value in bad[:1]
    ]


def _refused_loads(contact: Contact, load: str, entry: object, values: NDArray[Any]) -> list[str]:
    """Why these cannot be loads; none is told of elsewhere."""
    if not len(values):
        return []
    if values.dtype == object:
        return [f"{load} = {entry!r} must be a number or an array of numbers"]
    try:
        given_load(contact, **{"pressure": None, "F_star": None, "d": None, load: values})
    except InvalidValue as error:
        return list(error.problems)
    return []
