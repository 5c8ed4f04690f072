"""The table [design]: what may be chosen, what is good, and what must hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter, ValidationError

from ..analysis.design.problem import Limit, Objective, Suspension
from ..analysis.design.search import AMOUNT
from ..equilibrium.columns import about
from ..errors import InvalidValue, Problem
from ..populations.measured import cleanliness
from ..quantities.nearest import guess
from ..quantities.units import say, to_si
from .amounts import amounts
from .concentration import AMOUNT as OF_FLUID
from .fields import about_of
from .inputs import inputs_of
from .one_value import count, number, numbers, switch, word
from .reader import Key, Reader, Table, get, plain
from .surfaces import material
from .uncertainty import field_of_input
from .vocabulary import LOADS

__all__ = ["TABLE"]

WORDS = {
    "aim": ("smallest", "largest", "window"),
    "over_loads": ("mean", "worst"),
    "over_scatter": ("mean", "nominal", "worst", "robust", "tail"),
}
EXAMPLE = '{ of = "mu", aim = "smallest" }'


def design(reader: Reader, path: str, data: Any) -> Any:
    """What may be chosen, what is good, and what must hold."""
    keys = {
        "vary": Key(plain(_vary(reader, f"{path}.vary")), True, "what may be chosen"),
        "objective": Key(
            plain(_several(f"{path}.objective", Objective)), True, f"e.g. objective = {EXAMPLE}"
        ),
        "limits": Key(plain(_several(f"{path}.limits", Limit)), False, ""),
        "scatter": Key(plain(switch(f"{path}.scatter")), False, ""),
        "weights": Key(plain(numbers(f"{path}.weights", "1")), False, "of the loads"),
        "samples": Key(plain(count(f"{path}.samples", least=2, most=4096)), False, ""),
        "points": Key(plain(count(f"{path}.points", least=3)), False, ""),
        "seed": Key(plain(count(f"{path}.seed", least=0, most=2**63)), False, ""),
    }
    for name in ("F_star", "pressure"):
        declared = LOADS[name]
        read = amounts(reader, f"{path}.{name}", declared, get(data, name), sampled=True)
        keys[name] = Key(read, False, about_of(name, declared))
    if all(get(data, name) is not None for name in ("F_star", "pressure")):
        reader.problems.append(
            Problem(f"{path}.F_star", f"and {path}.pressure: only one of these can be given")
        )
    if get(data, "scatter") is True and "uncertainty" not in reader.whole:
        reader.problems.append(
            Problem(f"{path}.scatter", "= true needs a table [uncertainty]: what scatters")
        )
    fluid = _fluid(reader)

    def build(values: dict[str, Any]) -> dict[str, Any]:
        out = dict(values)
        if fluid is not None:
            out["suspension"] = fluid
        return out

    return reader.table(path, keys, build)


# -------------------------------------------------------------------------- what may be chosen
def _vary(reader: Reader, where: str) -> Any:
    """Ranges and lists of materials by the names of the library."""

    def read(given: Any) -> dict[str, Any]:
        if not isinstance(given, dict) or not given:
            raise InvalidValue(
                f"{where} = {say(given)} must be a table, e.g. "
                '{ "particles.mean+particles.std" = { low = "50 nm", high = "1 um" } }'
            )
        out: dict[str, Any] = {}
        problems: list[str] = []
        for label, entry in _flat(given).items():
            try:
                name, allowed = _variable(reader, f"{where}.{say(label)}", label, entry)
                out[name] = allowed
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        return out

    return read


def _variable(reader: Reader, where: str, label: str, entry: Any) -> tuple[str, Any]:
    """One variable: its name in the library, and its range or its materials."""
    if isinstance(entry, list):
        kinds = [
            TypeAdapter(material(reader, f"{where}[{i}]", each)) for i, each in enumerate(entry)
        ]
        return label, [_check(kind, each) for kind, each in zip(kinds, entry, strict=True)]
    if not (isinstance(entry, dict) and set(entry) == {"low", "high"}):
        raise InvalidValue(
            f"{where} = {say(entry)} must be {{ low = ..., high = ... }}, or a list of materials"
        )
    if label == AMOUNT:
        if get(reader.whole.get("particles"), "concentration") is None:
            raise InvalidValue(
                f"{where}: [particles] gives no concentration; write there concentration and gap"
            )
        ends = [_amount(f"{where}.{end}", entry[end]) for end in ("low", "high")]
        own = _amount("particles.concentration", reader.whole["particles"]["concentration"])
        if {each.by for each in ends} != {own.by}:
            raise InvalidValue(f"{where} must be by {own.by}, like particles.concentration")
        return label, tuple(each.amount for each in ends)
    inputs = inputs_of(reader.whole)
    found = [field_of_input(where, name, inputs, reader.whole) for name in label.split("+")]
    ends_of = {end: number(reader, f"{where}.{end}", found[0][1]) for end in ("low", "high")}
    return "+".join(name for name, _ in found), tuple(read(entry[e]) for e, read in ends_of.items())


def _check(kind: Any, value: Any) -> Any:
    try:
        return kind.validate_python(value)
    except ValidationError as error:
        raise InvalidValue(
            *(str(each.get("ctx", {}).get("error", each["msg"])) for each in error.errors())
        ) from None


def _amount(where: str, value: Any) -> cleanliness.Concentration:
    try:
        return cleanliness.concentration(value)
    except InvalidValue as error:
        raise InvalidValue(f"{where} = {error}") from None


def _flat(tree: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Names in quotes or as tables, and what is said of each."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        inner = isinstance(value, dict) and not {"low", "high"} & set(value)
        out |= _flat(value, where) if inner else {where: value}
    return out


def _fluid(reader: Reader) -> Suspension | None:
    """The fluid that brings the particles, where [particles] gives a concentration."""
    given = reader.whole.get("particles")
    if get(given, "concentration") is None:
        return None
    values: dict[str, Any] = {}
    try:
        amount = cleanliness.concentration(given["concentration"])  # type: ignore[index]
        for key, name in (
            ("gap", "gap"),
            ("film", "gap"),
            ("particle_density", "particle_density"),
            ("oil_density", "oil_density"),
        ):
            if get(given, key) is not None:
                values[name] = number(reader, f"particles.{key}", OF_FLUID[key])(given[key])  # type: ignore[index]
        return Suspension(concentration=amount.amount, by=amount.by, **values)
    except (InvalidValue, TypeError):
        return None  # told where [particles] is read


# -------------------------------------------------------------------------- what is good
def _several(where: str, kind: type[Objective] | type[Limit]) -> Any:
    """One objective or limit, or a list of them."""

    def read(given: Any) -> list[Any]:
        listed = isinstance(given, list)
        out: list[Any] = []
        problems: list[str] = []
        for i, entry in enumerate(given if listed else [given]):
            try:
                out.append(_one(f"{where}[{i}]" if listed else where, entry, kind))
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        return out

    return read


def _one(where: str, entry: Any, kind: type[Objective] | type[Limit]) -> Any:
    example = EXAMPLE if kind is Objective else '{ of = "plastic_share", most = 0.3 }'
    if not isinstance(entry, dict) or not isinstance(entry.get("of"), str):
        raise InvalidValue(f"{where} = {say(entry)} must be a table such as {example}")
    own = ("low", "high", "k", "tail", *WORDS) if kind is Objective else ("most", "least", "share")
    problems: list[str] = []
    values: dict[str, Any] = {"of": entry["of"]}
    for key, value in entry.items():
        try:
            if key == "of":
                continue
            if key not in own:
                hint = guess(key, ("of", *own))
                raise InvalidValue(Problem(f"{where}.{key}", "is not a known key", hint=hint))
            if key in WORDS:
                values[key] = word(f"{where}.{key}", WORDS[key])(value)
            else:
                unit = "1" if key in ("k", "tail", "share") else _unit(entry["of"])
                values[key] = _in_si(f"{where}.{key}", value, unit)
        except InvalidValue as error:
            problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    try:
        return kind(**values)
    except InvalidValue as error:
        raise error.under(where) from None


def _unit(of: str) -> str:
    """Unit of a metric; what it is, the contact says later."""
    try:
        return about(of).unit
    except InvalidValue:
        return "1"


def _in_si(where: str, value: Any, unit: str) -> float:
    try:
        return float(to_si(value, unit))
    except InvalidValue as error:
        raise InvalidValue(f"{where} = {error}") from None


TABLE = Table(name="design", read=design, role="study")
