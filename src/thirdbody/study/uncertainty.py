"""The table [uncertainty]: what is known of the inputs, by names like those of the file."""

from __future__ import annotations

from typing import Any

from ..analysis.uncertainty.inputs import KINDS, Uncertain, Uncertainty
from ..errors import InvalidValue, Problem
from ..quantities.nearest import guess, near_path
from ..quantities.units import say
from .inputs import Input, inputs_of
from .one_value import count, number, word
from .reader import Key, Reader, Table, get, plain
from .vocabulary import LOADS

__all__ = ["TABLE"]


def uncertainty(reader: Reader, path: str, data: Any) -> Any:
    """What is known of the inputs, by names like those of the file."""
    inputs = inputs_of(reader.whole)

    def read(given: Any) -> dict[str, Uncertain]:
        if not isinstance(given, dict) or not given:
            raise InvalidValue(
                f"{path}.inputs = {say(given)} must be a table of inputs, e.g. "
                '{ "roughness.sigma" = { low = "80 nm", high = "120 nm" } }'
            )
        out: dict[str, Uncertain] = {}
        problems: list[str] = []
        for label, entry in _ranges(given).items():
            where = f"{path}.inputs.{say(label)}"
            try:
                names, about = zip(
                    *(
                        field_of_input(where, name, inputs, reader.whole)
                        for name in label.split("+")
                    ),
                    strict=True,
                )
                out["+".join(names)] = _uncertain(reader, where, about[0], entry)
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        return out

    keys = {
        "samples": Key(plain(count(f"{path}.samples", least=64, most=2**24)), False, ""),
        "seed": Key(plain(count(f"{path}.seed", least=0, most=2**63)), False, ""),
        "inputs": Key(
            plain(read),
            True,
            "what is known of each input, e.g. "
            '"roughness.sigma" = { low = "80 nm", high = "120 nm" }',
        ),
    }
    return reader.table(path, keys, lambda values: Uncertainty(**values))


def field_of_input(
    where: str, name: str, inputs: list[Input], whole: dict[str, Any]
) -> tuple[str, dict[str, Any]]:
    """Dotted name of the field and what it is, for an input as the file calls it."""
    name = name.strip()
    table, _, last = name.rpartition(".")
    if table == "load" and last in LOADS:
        if get(whole.get("load"), last) is None:
            raise InvalidValue(f"{where}: {name} is not the load that [load] gives")
        return {"separation": "d"}.get(last, last), LOADS[last]
    known = {
        each.name: (each.field, each.quantity) for each in inputs if each.quantity and not each.idle
    }
    listed = list(known)  # as files call them, which Python may call otherwise
    known |= {field: (field, about) for field, about in known.values()}
    if name in known:
        return known[name]
    if why := next((each.idle for each in inputs if each.name == name), ""):
        raise InvalidValue(f"{where}: {name} {why}")
    if table == "particles" and "particles" not in whole:
        raise InvalidValue(f"{where}: there is no [particles] table, so {name} is no input")
    meant = near_path(name, known)
    hint = guess("", listed, meant=meant, otherwise="it has ")
    raise InvalidValue(Problem(where, f": {name} is not a number of this study", hint=hint))


def _uncertain(reader: Reader, where: str, about: dict[str, Any], entry: Any) -> Uncertain:
    """One distribution: which it is follows from its keys."""
    ways = (
        '{ low, high }, with spacing = "log" for a range of decades, '
        "{ mean, std } or { median, gsd }"
    )
    if not isinstance(entry, dict):
        raise InvalidValue(f"{where} = {say(entry)} must be one of {ways}")
    spacing = entry.get("spacing", "linear")
    given = {key: value for key, value in entry.items() if key != "spacing"}
    fits = [kind for kind, names in KINDS.items() if set(names) == set(given)]
    if not fits or ("spacing" in entry and "low" not in given):
        raise InvalidValue(f"{where} = {say(entry)} must be one of {ways}")
    kind = fits[0]
    if "spacing" in entry:
        word(f"{where}.spacing", ("linear", "log"))(spacing)
        kind = "log-uniform" if spacing == "log" else kind
    # of a spread only the sign is known: the range is that of the input
    spread = about | {"gt": 0, "ge": None, "lt": None, "le": None, "hint": ""}
    numbers: list[float] = []
    problems: list[str] = []
    for name in KINDS[kind]:
        meant = {"std": spread, "gsd": spread | {"unit": "1"}}.get(name, about)
        try:
            numbers.append(number(reader, f"{where}.{name}", meant)(given[name]))
        except InvalidValue as error:
            problems += error.problems
    if problems:
        raise InvalidValue(*problems)
    try:
        return Uncertain(kind=kind, first=numbers[0], second=numbers[1])
    except InvalidValue as error:
        raise InvalidValue(*(f"{where}: {text}" for text in error.problems)) from None


def _ranges(tree: dict[str, Any], path: str = "") -> dict[str, Any]:
    """Names of uncertain inputs, in quotes or as tables, and what is said of each."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        inner = isinstance(value, dict) and any(isinstance(part, dict) for part in value.values())
        out |= _ranges(value, where) if inner else {where: value}
    return out


TABLE = Table(name="uncertainty", read=uncertainty, role="study")
