"""The table [life.design]: the smallest filter for a code, the choice with the longest time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.say import value_of
from ..quantities.units import Quantity, say
from ..systems.life.circuit import OilCircuit
from ..systems.life.until import Until
from ..systems.oil_filter import Filter
from .life_dirt import CODE
from .life_uncertainty import one_name_of, with_numbers
from .reader import NOTHING, Key, Reader, get, read_number, wrong
from .toml import override, read

__all__ = ["AskedDesign", "asks_for_design", "design_key", "design_of"]

CHOICES = (
    'e.g. [[life.design.choices]] name = "larger filter", "filters.0.capacity" = "100 g", at '
    "least two"
)
About = Callable[[OilCircuit, str], Quantity | None]
"""What says what a number of a circuit is, by its dotted name."""


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedDesign:
    """What is to be chosen of an oil: a filter for a code, or one of several circuits.

    Parameters
    ----------
    code : str
        ISO 4406 that the oil is to come to; "" where the time to an event is asked.
    filters : tuple of Filter
        Data sheets that are tried in the place of the first filter, the smallest first.
    circuits : dict of str to OilCircuit
        By the names of the choices.
    """

    code: str = ""
    filters: tuple[Filter, ...] = ()
    circuits: Mapping[str, OilCircuit]


# ------------------------------------------------------------------------------ the table
def design_key(one_filter: Callable[[Reader, str, object], Filter]) -> Key:
    """The key of the table; ``one_filter`` reads a filter whose flow may be left out."""

    def filters(reader: Reader, path: str, data: object) -> tuple[Filter, ...]:
        if not isinstance(data, list):
            raise wrong(
                path, "must be a table, headed [[life.design.filters]]", data, code=Mistake.KIND
            )
        return reader.read_each({f"{path}[{i}]": entry for i, entry in enumerate(data)}, one_filter)

    def read_table(reader: Reader, path: str, data: object) -> dict[str, object]:
        keys = {
            "code": CODE._replace(about="the code that the oil is to come to"),
            "filters": Key(
                filters,
                about="data sheets to choose from, the smallest first, each headed "
                "[[life.design.filters]]; each stands in the place of the first filter",
                schema=NOTHING,
                table=one_filter,
                items=one_filter,
            ),
            "choices": Key(
                _choices,
                about="circuits of which that with the longest time to the event of [life.until] "
                f"is asked, {CHOICES}",
                schema=NOTHING,
                table=_choice,
                items=_choice,
            ),
        }
        return reader.table(path, data, keys)

    about = (
        "what thirdbody design chooses: the smallest filter for a code, or of several choices that "
        "with the longest time to an event"
    )
    return Key(None, False, about, NOTHING, read_table)


def _choice(reader: Reader, path: str, data: object) -> dict[str, object]:
    """One choice: its name, and numbers that are read once there is a circuit."""
    if reader.every_way:
        return {"type": "object"}
    if not isinstance(data, dict) or not isinstance(data.get("name"), str):
        raise wrong(path, f"must be a table with a name, {CHOICES}", data, code=Mistake.KIND)
    return data


def _choices(reader: Reader, path: str, data: object) -> tuple[dict[str, object], ...]:
    if not isinstance(data, list) or len(data) < 2:
        raise wrong(path, f"must be a list of tables, {CHOICES}", data, code=Mistake.SHAPE)
    choices = reader.read_each({f"{path}[{i}]": entry for i, entry in enumerate(data)}, _choice)
    names = [choice["name"] for choice in choices]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise InvalidValue(
            Problem(path, f"has two choices that are called {twice}", code=Mistake.CLASH)
        )
    return choices


def _circuit(
    reader: Reader, path: str, entry: Mapping[str, object], circuit: OilCircuit, about: About
) -> OilCircuit:
    """The circuit with the numbers of a choice."""

    def one(reader: Reader, where: str, pair: tuple[str, object]) -> tuple[str, float]:
        label, value = pair
        name = one_name_of(circuit, label.removeprefix("oil."))
        if (quantity := about(circuit, name)) is None:
            some = '"oil.volume", "filters.0.flow", "filters.0.capacity", "filters.0.service"'
            sizes = circuit.filters[0].sizes if circuit.filters else ()
            some += "".join(f', "filters.0.beta.{value_of(x, "m")}"' for x in sizes)
            raise InvalidValue(
                Problem(
                    where, f"is not a number of the circuit; it has {some}", code=Mistake.UNKNOWN
                )
            )
        return name, read_number(quantity, reader, where, value)

    pairs = {f"{path}.{say(k)}": (k, v) for k, v in entry.items() if k != "name"}
    numbers = dict(reader.read_each(pairs, one))
    try:
        changed = with_numbers(circuit, numbers)
        changed.terms()
    except InvalidValue as error:
        raise error.move_under(path) from None
    return changed


def design_of(
    reader: Reader,
    table: Mapping[str, Any],
    circuit: OilCircuit,
    until: tuple[Until, ...],
    about: About,
) -> AskedDesign:
    """What is to be chosen, checked against the circuit and what is waited for."""
    path = "life.design"
    if ("code" in table) == ("choices" in table):
        rule = (
            'needs either code, e.g. code = "16/14/11" and a list of [[life.design.filters]], or '
            f"choices with one event in [life.until], {CHOICES}"
        )
        raise InvalidValue(Problem(path, rule, code=Mistake.CLASH))
    if "choices" not in table:
        if not circuit.filters:
            raise InvalidValue(
                Problem(
                    path, "chooses the first of [[life.filters]]: add one", code=Mistake.MISSING
                )
            )
        return AskedDesign(code=table["code"], filters=table.get("filters", ()), circuits={})
    if "filters" in table:
        rule = "go with code; a choice changes numbers of the circuit"
        raise InvalidValue(Problem(f"{path}.filters", rule, code=Mistake.IDLE))
    if len(until) != 1:
        rule = f"needs one event in [life.until], e.g. filter_full = true; it has {len(until)}"
        raise InvalidValue(Problem(f"{path}.choices", rule, code=Mistake.SHAPE))
    circuits = {
        entry["name"]: _circuit(reader, f"{path}.choices[{i}]", entry, circuit, about)
        for i, entry in enumerate(table["choices"])
    }
    return AskedDesign(circuits=circuits)


def asks_for_design(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> bool:
    """Whether a study file has a table [life.design].

    Parameters
    ----------
    path : path-like
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.
    """
    return get(override(read(Path(path)), list(overrides)).get("life"), "design") is not None
