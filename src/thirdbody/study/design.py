"""The table [design]: what may be chosen, what is good, and what must hold."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import partial
from typing import Any

from ..analysis.design.problem import Limit, Objective, Suspension
from ..analysis.design.search import AMOUNT
from ..analysis.design.task import problems_of_metric
from ..contact.output import AbstractOutput
from ..effects import REGISTRY as OUTPUTS
from ..equilibrium.columns import about
from ..errors import InvalidValue, Mistake, Problem, in_study
from ..populations.measured import cleanliness
from ..quantities.nearest import guess
from ..quantities.units import say, to_si
from .inputs import inputs_of
from .particles import AMOUNT as OF_FLUID
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    amounts,
    count,
    get,
    numbers,
    problems_of_order,
    read_number,
    read_word,
    switch,
    wrong,
)
from .surfaces import MATERIAL
from .uncertainty import field_of_input
from .vocabulary import LOADS

__all__ = ["DESIGN"]

WORDS = {
    "aim": ("smallest", "largest", "window"),
    "over_loads": ("mean", "worst"),
    "over_scatter": ("mean", "nominal", "worst", "robust", "tail"),
}
FIXED = "what is not to be chosen needs no range: write it in its own table"
NUMBER = re.compile(r"[-+]?\.?\d[\d.]*(e[-+]?\d+)?( .*)?", re.IGNORECASE)
"""A value with its unit or without; the name of no material ("100Cr6")."""
EXAMPLE = '{ of = "mu", aim = "smallest" }'


def _design(reader: Reader, path: str, data: object) -> object:
    """The task of [design]: variables, objectives, limits."""
    if all(get(data, name) is not None for name in ("F_star", "pressure")):
        rule = f"and {path}.pressure: only one of these can be given"
        reader.mistakes.append(Problem(f"{path}.F_star", rule, code=Mistake.CLASH))
    if get(data, "scatter") is True and "uncertainty" not in reader.whole:
        rule = "= true needs a table [uncertainty]: what scatters"
        reader.mistakes.append(Problem(f"{path}.scatter", rule, code=Mistake.MISSING))
    fluid = _fluid(reader)
    more = {} if fluid is None else {"suspension": fluid}
    return reader.table(path, data, KEYS, lambda values: values | more)


# -------------------------------------------------------------------------- what may be chosen
def _vary(reader: Reader, path: str, data: object) -> dict[str, object]:
    """Ranges and lists of materials by the names of the library."""
    if not isinstance(data, dict) or not data:
        rule = "must be a table, e.g. "
        rule += '{ "particles.mean+particles.std" = { low = "50 nm", high = "1 um" } }'
        raise wrong(path, rule, data, code=Mistake.KIND)
    flat = _flat(data).items()
    return dict(
        reader.read_each(
            {f"{path}.{say(label)}": (label, entry) for label, entry in flat}, _variable
        )
    )


def _variable(reader: Reader, where: str, variable: tuple[str, object]) -> tuple[str, object]:
    """One variable: its name in the library, and its range or its materials."""
    label, entry = variable
    if isinstance(entry, list):
        if entry and all(NUMBER.fullmatch(str(value)) for value in entry):
            hint = f"write {{ low = {say(entry[0])}, high = {say(entry[-1])} }}"
            rule = "must be a range of numbers, or a list of materials"
            raise wrong(where, rule, entry, hint=hint, code=Mistake.KIND)
        items = {f"{where}.{i}": material for i, material in enumerate(entry)}
        return label, list(reader.read_each(items, MATERIAL.read_any))
    if not (isinstance(entry, dict) and set(entry) == {"low", "high"}):
        raise wrong(
            where,
            "must be { low = ..., high = ... }, or a list of materials",
            entry,
            code=Mistake.KIND,
        )
    if label == AMOUNT:
        if get(reader.whole.get("particles"), "concentration") is None:
            rule = ": [particles] gives no concentration; write there concentration and gap"
            raise InvalidValue(Problem(where, rule, code=Mistake.MISSING))
        ends = [_amount(f"{where}.{end}", entry[end]) for end in ("low", "high")]
        study_amount = _amount(
            "particles.concentration", get(reader.whole["particles"], "concentration")
        )
        if {amount.by for amount in ends} != {study_amount.by}:
            rule = f"must be by {study_amount.by}, like particles.concentration"
            raise InvalidValue(Problem(where, rule, code=Mistake.KIND))
        return label, _in_order(where, entry, ends[0].amount, ends[1].amount)
    inputs = inputs_of(reader.whole)
    fields = [field_of_input(where, name, inputs, reader.whole) for name in label.split("+")]
    lowest, highest = (
        read_number(fields[0][1], reader, f"{where}.{end}", entry[end]) for end in ("low", "high")
    )
    return "+".join(name for name, _ in fields), _in_order(where, entry, lowest, highest)


def _in_order(
    where: str, entry: Mapping[str, object], low: float, high: float
) -> tuple[float, float]:
    if problems := problems_of_order(where, entry, low, high, alone=FIXED):
        raise InvalidValue(*problems)
    return low, high


def _amount(where: str, value: Any) -> cleanliness.Concentration:
    try:
        return cleanliness.concentration(value)
    except InvalidValue as error:
        raise InvalidValue(error.problems[0].put_at(where, say(value))) from None


def _flat(tree: Mapping[str, Any], path: str = "") -> dict[str, object]:
    """Entries by dotted name, from names in quotes or nested tables."""
    out: dict[str, object] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        inner = isinstance(value, dict) and not {"low", "high"} & set(value)
        out |= _flat(value, where) if inner else {where: value}
    return out


def _fluid(reader: Reader) -> Suspension | None:
    """The fluid that brings the particles, where [particles] gives a concentration."""
    particles = reader.whole.get("particles")
    if get(particles, "concentration") is None:
        return None
    values: dict[str, float] = {}
    try:
        amount = cleanliness.concentration(particles["concentration"])  # type: ignore[index]
        for key, name in (
            ("gap", "gap"),
            ("film", "gap"),
            ("particle_density", "particle_density"),
            ("oil_density", "oil_density"),
        ):
            if get(particles, key) is not None:
                where, about = f"particles.{key}", OF_FLUID[key]
                values[name] = read_number(about, reader, where, particles[key])  # type: ignore[index]
        return Suspension(concentration=amount.amount, by=amount.by, **values)
    except (InvalidValue, TypeError):
        return None  # told where [particles] is read


# -------------------------------------------------------------------------- what is good
def _several(
    kind: type[Objective] | type[Limit], reader: Reader, path: str, data: object
) -> list[object]:
    """One objective or limit, or a list of them."""
    entries = {path: data}
    if isinstance(data, list):
        entries = {f"{path}.{i}": entry for i, entry in enumerate(data)}
    return list(reader.read_each(entries, partial(_one, kind)))


def _one(kind: type[Objective] | type[Limit], reader: Reader, where: str, entry: object) -> object:
    example = EXAMPLE if kind is Objective else '{ of = "plastic_share", most = 0.3 }'
    if not isinstance(entry, dict) or not isinstance(entry.get("of"), str):
        raise wrong(where, f"must be a table such as {example}", entry, code=Mistake.KIND)
    keys = ("low", "high", "k", "tail", *WORDS) if kind is Objective else ("most", "least", "share")

    def one(reader: Reader, path: str, key: str) -> tuple[str, Any]:
        if key == "of":
            stated = reader.whole.get("outputs")
            names = stated if isinstance(stated, dict) else ()
            kinds = (OUTPUTS[name] for name in names if name in OUTPUTS)
            outputs = [kind for kind in kinds if issubclass(kind, AbstractOutput)]
            if problems := problems_of_metric(path, entry[key], say(entry[key]), outputs):
                raise InvalidValue(*(problem.put_in_words(in_study) for problem in problems))
            return key, entry["of"]
        if key not in keys:
            hint = guess(key, ("of", *keys))
            raise InvalidValue(Problem(path, "is not a known key", hint=hint, code=Mistake.UNKNOWN))
        if key in WORDS:
            return key, read_word(WORDS[key], reader, path, entry[key])
        unit = "1" if key in ("k", "tail", "share") else _unit(entry["of"])
        return key, _in_si(path, entry[key], unit)

    values = dict(reader.read_each({f"{where}.{key}": key for key in entry}, one))
    try:
        return kind(**values)
    except InvalidValue as error:
        raise error.move_under(where) from None


def _unit(of: str) -> str:
    """Unit of a metric; what it is, the contact says later."""
    try:
        return about(of).unit
    except InvalidValue:
        return "1"


def _in_si(where: str, value: object, unit: str) -> float:
    try:
        return float(to_si(value, unit))
    except InvalidValue as error:
        raise InvalidValue(error.problems[0].put_at(where, say(value))) from None


KEYS = {
    "vary": Key(_vary, True, "what may be chosen"),
    "objective": Key(partial(_several, Objective), True, f"e.g. objective = {EXAMPLE}"),
    "limits": Key(partial(_several, Limit)),
    "scatter": switch,
    "weights": numbers("1", "of the loads"),
    "samples": count(least=2, most=4096),
    "points": count(least=3),
    "seed": count(least=0, most=2**63),
    **{name: amounts(name, LOADS[name], sampled=True) for name in ("F_star", "pressure")},
}
DESIGN = Table(name="design", key=Key(schema=NOTHING, table=_design), role="study")
