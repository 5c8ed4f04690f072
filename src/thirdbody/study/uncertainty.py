"""The table [uncertainty]: what is known of the inputs, by names like those of the file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..analysis.uncertainty.inputs import KINDS, Uncertain, Uncertainty
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.nearest import guess, near_path, nearest_paths
from ..quantities.say import join_words
from ..quantities.units import Quantity, say
from .inputs import Input, inputs_of
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    count,
    get,
    problems_of_order,
    read_number,
    read_word,
    wrong,
)
from .vocabulary import LOADS

__all__ = ["LIFE", "UNCERTAINTY", "field_of_input", "ranges_of", "read_uncertain"]

LIFE = "life."
"""How names of numbers of a life begin: `thirdbody.study.life_uncertainty` reads these."""


def _inputs(reader: Reader, path: str, data: object) -> dict[str, Uncertain]:
    """Distributions of the inputs, by names as in the file."""
    if not isinstance(data, dict) or not data:
        rule = "must be a table of inputs, e.g. "
        raise wrong(
            path,
            f'{rule}{{ "roughness.sigma" = {{ low = "80 nm", high = "120 nm" }} }}',
            data,
            code=Mistake.KIND,
        )
    inputs = inputs_of(reader.whole)
    entries = ranges_of(data)
    if any(label.startswith(LIFE) for label in entries) and "life" not in reader.whole:
        raise InvalidValue(
            Problem(
                path, "names numbers of [life], and there is no such table", code=Mistake.MISSING
            )
        )

    def one(reader: Reader, where: str, pair: tuple[str, object]) -> tuple[str, Uncertain]:
        label, entry = pair
        fields = [field_of_input(where, name, inputs, reader.whole) for name in label.split("+")]
        return "+".join(name for name, _ in fields), read_uncertain(
            reader, where, fields[0][1], entry
        )

    pairs = {
        f"{path}.{say(label)}": (label, entry)
        for label, entry in entries.items()
        if not label.startswith(LIFE)
    }
    return dict(reader.read_each(pairs, one))


KEYS = {
    "samples": count(least=64, most=2**24),
    "seed": count(least=0, most=2**63),
    "inputs": Key(
        _inputs,
        True,
        'what is known of each input, e.g. "roughness.sigma" = { low = "80 nm", high = "120 nm" }',
    ),
}


def _uncertainty(reader: Reader, path: str, data: object) -> Any:
    def build(values: dict[str, Any]) -> Uncertainty | None:
        return Uncertainty(**values) if values["inputs"] else None  # all of them are of [life]

    return reader.table(path, data, KEYS, build)


def field_of_input(
    where: str, name: str, inputs: list[Input], whole: Mapping[str, object]
) -> tuple[str, Quantity]:
    """Dotted name of the field and its meaning, for an input as the file calls it."""
    name = name.strip()
    table, _, last = name.rpartition(".")
    if table == "load" and last in LOADS:
        if get(whole.get("load"), last) is None:
            raise InvalidValue(
                Problem(where, f": {name} is not the load that [load] gives", code=Mistake.UNKNOWN)
            )
        return {"separation": "d"}.get(last, last), LOADS[last]
    numbers = {
        one_input.name: (one_input.field, one_input.quantity)
        for one_input in inputs
        if one_input.quantity and not one_input.idle
    }
    listed = list(numbers)  # as files call them, which Python may call otherwise
    numbers |= {field: (field, about) for field, about in numbers.values()}
    if name in numbers:
        return numbers[name]
    if why := next((one_input.idle for one_input in inputs if one_input.name == name), ""):
        raise InvalidValue(Problem(where, f": {name} {why}", code=Mistake.IDLE))
    if table == "particles" and "particles" not in whole:
        rule = f": there is no [particles] table, so {name} is no input"
        raise InvalidValue(Problem(where, rule, code=Mistake.BEYOND))
    meanings = {path: about["meaning"] for path, (_, about) in numbers.items()}
    meant = near_path(name, numbers, meanings)
    few = nearest_paths(name, listed)
    hint = guess("", few, meant=meant, otherwise="it has ")
    if meant is None and len(few) < len(listed):
        tables = dict.fromkeys(path.partition(".")[0] for path in listed)
        others = join_words([f"[{table}]" for table in tables])
        hint += f", and other numbers of {others}, each by table and key"
    raise InvalidValue(
        Problem(where, f": {name} is not a number of this study", hint=hint, code=Mistake.UNKNOWN)
    )


def read_uncertain(reader: Reader, where: str, about: Quantity, entry: object) -> Uncertain:
    """One distribution; its keys decide which."""
    table = dict(entry) if isinstance(entry, dict) else {}
    spacing = table.pop("spacing", None)
    kind = next((kind for kind, names in KINDS.items() if set(names) == set(table)), None)
    if kind is None or (spacing is not None and "low" not in table):
        ways = '{ low, high }, with spacing = "log" for a range of decades, '
        raise wrong(
            where,
            f"must be one of {ways}{{ mean, std }} or {{ median, gsd }}",
            entry,
            code=Mistake.OPTION,
        )
    if spacing is not None:
        spacing = read_word(("linear", "log"), reader, f"{where}.spacing", spacing)
        kind = "log-uniform" if spacing == "log" else kind
    # of a spread only the sign is known: the range is that of the input
    spread: Quantity = {**about, "gt": 0, "ge": None, "lt": None, "le": None, "hint": ""}
    meant: dict[str, Quantity] = {"std": spread, "gsd": {**spread, "unit": "1"}}

    def number(reader: Reader, path: str, name: str) -> float:
        return read_number(meant.get(name, about), reader, path, table[name])

    first, second = reader.read_each({f"{where}.{name}": name for name in KINDS[kind]}, number)
    exact = "what is exact needs no range"
    if "low" in table and (
        wrong_way := problems_of_order(where, table, first, second, alone=exact)
    ):
        raise InvalidValue(*wrong_way)
    try:
        return Uncertain(kind=kind, first=first, second=second)
    except InvalidValue as error:
        raise InvalidValue(
            *(Problem(where, f": {text}", code=text.code) for text in error.problems)
        ) from None


def ranges_of(tree: Mapping[str, Any], path: str = "") -> dict[str, object]:
    """Entries of uncertain inputs, from names in quotes or nested tables."""
    out: dict[str, object] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        inner = isinstance(value, dict) and any(isinstance(entry, dict) for entry in value.values())
        out |= ranges_of(value, where) if inner else {where: value}
    return out


UNCERTAINTY = Table(name="uncertainty", key=Key(schema=NOTHING, table=_uncertainty), role="study")
