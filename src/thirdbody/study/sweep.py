"""The table [sweep]: which states there are, and what is kept of them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..analysis.sweep.make_plan import make_plan
from ..analysis.sweep.plan import Plan
from ..analysis.sweep.reduction import KEYS
from ..contact.contact import Contact
from ..contact.output import every_column
from ..equilibrium.columns import COLUMNS
from ..errors import InvalidValue
from ..numerics.sampling import DESIGNS
from ..quantities.units import say
from .amounts import amounts, is_span
from .fields import about_of
from .inputs import Input, field_of, inputs_of
from .one_value import One, count, switch, word, words
from .reader import Key, Reader, Table, get, plain
from .vocabulary import LOADS

__all__ = ["TABLE", "ends", "plan", "with_nested_names"]


def sweep(reader: Reader, path: str, data: Any) -> Any:
    """What is varied, how, and what is kept of it."""
    designs = ("grid", "zip", *DESIGNS)
    sampled = get(data, "design") not in (None, "grid", "zip")
    known = [*COLUMNS, *every_column()]
    keys = {
        "design": Key(plain(word(f"{path}.design", designs)), False, ""),
        "samples": Key(plain(count(f"{path}.samples", most=2**48)), sampled, "a number"),
        "seed": Key(plain(count(f"{path}.seed", least=0, most=2**63)), False, ""),
        "chunk": Key(plain(count(f"{path}.chunk", most=10**9)), False, ""),
        "columns": Key(plain(words(f"{path}.columns", known)), False, "columns to keep"),
        "vary": Key(_variables(reader, f"{path}.vary", get(data, "vary"), sampled), False, ""),
        "reduce": Key(_reductions(reader, f"{path}.reduce", get(data, "reduce")), False, ""),
    }
    for name, about in LOADS.items():
        read = amounts(reader, f"{path}.{name}", about, get(data, name), sampled=sampled)
        keys[name] = Key(read, False, about_of(name, about))
    if isinstance(data, dict):
        reader.only_one(path, data)
    return reader.table(path, keys, lambda values: values)


def _variables(reader: Reader, path: str, data: Any, sampled: bool) -> Any:
    """The inputs that may vary, in tables like those of the file."""
    tables: dict[str, list[Input]] = {}
    for each in inputs_of(reader.whole):
        tables.setdefault(each.table, []).append(each)

    if reader.every_way:
        return plain(One(dict, {"type": "object"}))  # the inputs of whatever study it is

    def table(prefix: str, tree: Any) -> Any:
        where = f"{path}.{prefix}" if prefix else path
        keys: dict[str, Key] = {}
        for each in tables.get(prefix, []):
            name, value = f"{where}.{each.key}", get(tree, each.key)
            if each.idle:
                continue
            if about := each.quantity:
                read = amounts(reader, name, about, value, sampled=sampled)
                keys[each.key] = Key(read, False, about_of(each.key, about))
            elif about := each.choice:
                read = plain(words(name, about["options"]))
                keys[each.key] = Key(read, False, about["meaning"])
        refused = {each.key: each.idle for each in tables.get(prefix, []) if each.idle}
        reader.known.refused[where] = refused
        start = f"{prefix}." if prefix else ""
        below = [other.removeprefix(start) for other in tables if other.startswith(start)]
        for name in dict.fromkeys(other.partition(".")[0] for other in below):
            keys[name] = Key(table(f"{start}{name}", get(tree, name)), False, "")
        return reader.table(where, keys, lambda values: values)

    return table("", data)


def _reductions(reader: Reader, path: str, data: Any) -> Any:
    """What is kept of many states."""

    def share(value: Any) -> list[float]:
        values = value if isinstance(value, list) else [value]
        for item in values:
            if isinstance(item, bool) or not isinstance(item, (int, float)):
                raise InvalidValue(f"{path}.quantiles = {say(value)} must be a list of numbers")
        return [float(item) for item in values]

    def thresholds(value: Any) -> dict[str, Any]:
        if isinstance(value, dict):
            return value
        raise InvalidValue(f"{path}.exceed = {say(value)} must be a table, e.g. {{ A_t = 0.2 }}")

    keys = {
        "over": Key(plain(words(f"{path}.over", None)), False, "inputs to reduce over"),
        "quantiles": Key(plain(share), False, "e.g. [0.05, 0.5, 0.95]"),
        "exceed": Key(plain(thresholds), False, "e.g. { particle_load_share = 0.5 }"),
        "extrema": Key(plain(switch(f"{path}.extrema")), False, ""),
        "mean": Key(plain(switch(f"{path}.mean")), False, ""),
    }
    return reader.table(path, keys, lambda values: values)


def plan(
    reader: Reader, contact: Contact, load: str, loads: np.ndarray, asked: dict[str, Any]
) -> Plan:
    """The states of the table [sweep]."""
    given = dict(asked)
    found = [name for name in LOADS if name in given]
    name = found[0] if found else load
    given["d" if name == "separation" else name] = given.pop(name, loads)
    names = _dotted_names(given.pop("vary", {}))
    given["vary"] = {inner: value for inner, value in names.values()}
    translated = {outer: inner for outer, (inner, _) in names.items()} | {"separation": "d"}
    if "over" in given.get("reduce", {}):
        over = [translated.get(word, word) for word in given["reduce"]["over"]]
        given["reduce"] = given["reduce"] | {"over": over}
    samples = given.get("samples", 0)
    if given.get("design") == "sobol" and samples & (samples - 1):
        above = 1 << samples.bit_length()
        reader.notes.append(
            f"sweep.samples = {samples} is not a power of two, in which Sobol points are "
            f"balanced best; {above // 2} and {above} are"
        )
    try:
        return make_plan(contact, **given)
    except InvalidValue as error:
        places = {f"vary[{inner!r}]": f"sweep.vary.{name}" for name, inner in translated.items()}
        places |= {f"reduce[{key!r}]": f"sweep.reduce.{key}" for key in KEYS}
        places |= {key: f"sweep.{key}" for key in ("design", "samples", "seed", "chunk", "reduce")}
        raise InvalidValue(
            *(each.changed(path=places.get(each.path, each.path)) for each in error.problems)
        ) from None


def ends(asked: dict[str, Any]) -> tuple[str, np.ndarray] | None:
    """The loads of the table [sweep], for commands that do not sweep."""
    name = next((name for name in LOADS if name in asked), None)
    if name is None:
        return None
    values = asked[name]
    return name, np.array([values["low"], values["high"]]) if is_span(values) else values


def with_nested_names(data: dict[str, Any]) -> dict[str, Any]:
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


def _dotted_names(tree: dict[str, Any], path: str = "") -> dict[str, tuple[str, Any]]:
    """Names as in the file, each with the dotted name of the field and the values."""
    out: dict[str, tuple[str, Any]] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        if isinstance(value, dict) and not is_span(value):
            out |= _dotted_names(value, where)
        else:
            out[where] = field_of(path, name), value
    return out


TABLE = Table(name="sweep", read=sweep, role="study")
