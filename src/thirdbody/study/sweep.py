"""The table [sweep]: which states there are, and what is kept of them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from ..analysis.sweep.make_plan import make_plan
from ..analysis.sweep.plan import Plan
from ..analysis.sweep.reduction import KEYS
from ..contact.contact import Contact
from ..contact.output import every_column
from ..equilibrium.columns import COLUMNS
from ..errors import InvalidValue, Mistake, Problem
from ..numerics.sampling import DESIGNS
from .inputs import Input, field_of, inputs_of
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    amounts,
    count,
    get,
    in_toml,
    is_span,
    range_meant,
    switch,
    word,
    words,
    wrong,
)
from .vocabulary import LOADS

__all__ = ["SWEEP", "ends", "plan", "with_nested_names"]


def _sweep(reader: Reader, path: str, data: object) -> object:
    """Entries of [sweep]: what varies, how, and what is stored."""
    sampled = get(data, "design") not in (None, "grid", "zip")
    keys = {
        "design": word(("grid", "zip", *DESIGNS)),
        "samples": count("a number", most=2**48)._replace(required=sampled),
        "seed": count(least=0, most=2**63),
        "chunk": count(most=10**9),
        "columns": words([*COLUMNS, *every_column()], "columns to keep"),
        "vary": Key(schema=NOTHING, table=partial(_vary, sampled)),
        "reduce": Key(schema=NOTHING, table=_reductions),
    }
    keys |= {name: amounts(name, about, sampled=sampled) for name, about in LOADS.items()}
    reader.only_one(path, data)
    return reader.table(path, data, keys)


def _vary(sampled: bool, reader: Reader, path: str, data: object) -> object:
    """The inputs that may vary, in tables like those of the file."""
    if reader.every_way:
        return {"type": "object"}  # the inputs of whatever study it is
    bare = data if isinstance(data, dict) and {"from", "to"} <= data.keys() else {}
    if meant := range_meant(data) or bare:
        rule = "is a range, but does not say of which input"
        hint = f"write vary.roughness.sigma = {in_toml(meant)}, by the name of an input"
        reader.mistakes.append(Problem(path, rule, hint=hint, code=Mistake.MISSING))
        data = {}
    tables: dict[str, list[Input]] = {}
    for one_input in inputs_of(reader.whole):
        tables.setdefault(one_input.table, []).append(one_input)
    return _inputs_that_vary(sampled, tables, "", reader, path, data)


def _inputs_that_vary(
    sampled: bool,
    tables: dict[str, list[Input]],
    prefix: str,
    reader: Reader,
    path: str,
    data: object,
) -> object:
    """Inputs of the table of this name and of the tables in it."""
    keys: dict[str, Key] = {}
    refused: dict[str, str] = {}
    for one_input in tables.get(prefix, []):
        if one_input.idle:
            refused[one_input.key] = one_input.idle
        elif one_input.quantity:
            keys[one_input.key] = amounts(one_input.key, one_input.quantity, sampled=sampled)
        elif one_input.choice:
            keys[one_input.key] = words(one_input.choice["options"], one_input.choice["meaning"])
    reader.known_keys.refused[path] = refused
    start = f"{prefix}." if prefix else ""
    below = [other.removeprefix(start) for other in tables if other.startswith(start)]
    for name in dict.fromkeys(other.partition(".")[0] for other in below if other):
        table = partial(_inputs_that_vary, sampled, tables, f"{start}{name}")
        keys[name] = Key(schema=NOTHING, table=table)
    return reader.table(path, data, keys)


def _quantiles(reader: Reader, path: str, value: Any) -> list[float]:
    values = value if isinstance(value, list) else [value]
    if any(isinstance(item, bool) or not isinstance(item, (int, float)) for item in values):
        raise wrong(path, "must be a list of numbers", value, code=Mistake.KIND)
    return [float(item) for item in values]


def _thresholds(reader: Reader, path: str, value: object) -> dict[str, object]:
    if isinstance(value, dict):
        return value
    raise wrong(path, "must be a table, e.g. { A_t = 0.2 }", value, code=Mistake.KIND)


REDUCTIONS = {
    "over": words(None, "inputs to reduce over"),
    "quantiles": Key(_quantiles, about="e.g. [0.05, 0.5, 0.95]"),
    "exceed": Key(_thresholds, about="e.g. { particle_load_share = 0.5 }"),
    "extrema": switch,
    "mean": switch,
}


def _reductions(reader: Reader, path: str, data: object) -> object:
    """Reductions of many states."""
    return reader.table(path, data, REDUCTIONS)


def plan(
    reader: Reader, contact: Contact, load: str, loads: np.ndarray, table: dict[str, Any]
) -> Plan:
    """The states of the table [sweep]."""
    options = dict(table)
    swept_loads = [name for name in LOADS if name in options]
    name = swept_loads[0] if swept_loads else load
    options["d" if name == "separation" else name] = options.pop(name, loads)
    names = _dotted_names(options.pop("vary", {}))
    options["vary"] = {inner: value for inner, value in names.values()}
    translated = {outer: inner for outer, (inner, _) in names.items()} | {"separation": "d"}
    if "over" in options.get("reduce", {}):
        over = [translated.get(word, word) for word in options["reduce"]["over"]]
        options["reduce"] = options["reduce"] | {"over": over}
    samples = options.get("samples", 0)
    if options.get("design") == "sobol" and samples & (samples - 1):
        above = 1 << samples.bit_length()
        reader.notes.append(
            f"sweep.samples = {samples} is not a power of two, in which Sobol points are "
            f"balanced best; {above // 2} and {above} are"
        )
    try:
        return make_plan(contact, **options)
    except InvalidValue as error:
        places = {f"vary[{inner!r}]": f"sweep.vary.{name}" for name, inner in translated.items()}
        places |= {f"reduce[{key!r}]": f"sweep.reduce.{key}" for key in KEYS}
        places |= {key: f"sweep.{key}" for key in ("design", "samples", "seed", "chunk", "reduce")}
        raise InvalidValue(
            *(
                problem.changed(path=places.get(problem.path, problem.path))
                for problem in error.problems
            )
        ) from None


def ends(table: dict[str, Any]) -> tuple[str, np.ndarray] | None:
    """The loads of the table [sweep], for commands that do not sweep."""
    name = next((name for name in LOADS if name in table), None)
    if name is None:
        return None
    values = table[name]
    return name, np.array([values["low"], values["high"]]) if is_span(values) else values


def with_nested_names(data: dict[str, Any]) -> dict[str, object]:
    """Names in quotes under [sweep.vary], "particles.mean", as the tables they stand for."""
    vary = get(data.get("sweep"), "vary")
    if not isinstance(vary, dict):
        return data
    tree: dict[str, Any] = {}
    for name, value in vary.items():
        *path, last = name.removeprefix("sweep.vary.").split(".")
        table = tree
        for step in path:
            table = table.setdefault(step, {})
            if not isinstance(table, dict):
                return data
        if isinstance(value, dict) and isinstance(table.get(last), dict):
            table[last] = table[last] | value
        else:
            table[last] = value
    return data | {"sweep": data["sweep"] | {"vary": tree}}


def _dotted_names(tree: Mapping[str, object], path: str = "") -> dict[str, tuple[str, object]]:
    """Names as in the file, each with the dotted name of the field and the values."""
    out: dict[str, tuple[str, object]] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        if isinstance(value, dict) and not is_span(value):
            out |= _dotted_names(value, where)
        else:
            out[where] = field_of(path, name), value
    return out


SWEEP = Table(name="sweep", key=Key(schema=NOTHING, table=_sweep), role="study")
