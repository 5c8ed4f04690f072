"""The table [life.design]: the smallest filter for a code, the choice with the longest time."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValue, Problem
from ..quantities.plain_data import plain_data
from ..quantities.units import say
from ..systems.life.circuit import OilCircuit
from ..systems.life.sizing import filter_for_code, least_flow, longest_time
from ..systems.life.until import ContactUntil, Until
from ..systems.oil_filter import Filter
from .asked_result import QuestionResult
from .life_dirt import CODE
from .overrides import override
from .reader import NOTHING, Key, Reader, get, read_number, wrong
from .toml import read

if TYPE_CHECKING:
    from .life import AskedLife

__all__ = ["AskedDesign", "LifeDesign", "asks_for_design", "design_key", "design_life", "design_of"]

CHOICES = (
    'e.g. [[life.design.choices]] name = "larger filter", "filters.0.capacity" = "100 g", at '
    "least two"
)
About = Callable[[OilCircuit, str], dict[str, Any] | None]
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
def design_key(one_filter: Callable[[Reader, str, Any], Any]) -> Key:
    """The key of the table; ``one_filter`` reads a filter whose flow may be left out."""

    def filters(reader: Reader, path: str, data: Any) -> Any:
        if not isinstance(data, list):
            raise wrong(path, "must be a table, headed [[life.design.filters]]", data)
        return reader.read_each({f"{path}[{i}]": each for i, each in enumerate(data)}, one_filter)

    def read_table(reader: Reader, path: str, data: Any) -> Any:
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


def _choice(reader: Reader, path: str, data: Any) -> Any:
    """One choice: its name, and numbers that are read once there is a circuit."""
    if reader.every_way:
        return {"type": "object"}
    if not isinstance(data, dict) or not isinstance(data.get("name"), str):
        raise wrong(path, f"must be a table with a name, {CHOICES}", data)
    return data


def _choices(reader: Reader, path: str, data: Any) -> Any:
    if not isinstance(data, list) or len(data) < 2:
        raise wrong(path, f"must be a list of tables, {CHOICES}", data)
    found = reader.read_each({f"{path}[{i}]": each for i, each in enumerate(data)}, _choice)
    names = [each["name"] for each in found]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise InvalidValue(Problem(path, f"has two choices that are called {twice}"))
    return found


def _circuit(
    reader: Reader, path: str, entry: Mapping[str, Any], circuit: OilCircuit, about: About
) -> OilCircuit:
    """The circuit with the numbers of a choice."""

    def one(reader: Reader, where: str, pair: tuple[str, Any]) -> tuple[str, float]:
        label, value = pair
        name = label.removeprefix("oil.")
        if (quantity := about(circuit, name)) is None:
            some = '"oil.volume", "filters.0.flow", "filters.0.capacity"'
            raise InvalidValue(Problem(where, f"is not a number of the circuit; it has {some}"))
        return name, read_number(quantity, reader, where, value)

    pairs = {f"{path}.{say(k)}": (k, v) for k, v in entry.items() if k != "name"}
    numbers = dict(reader.read_each(pairs, one))
    try:
        changed = circuit.replace(**numbers)
        changed.terms()
    except InvalidValue as error:
        raise error.under(path) from None
    return changed


def design_of(
    reader: Reader,
    given: Mapping[str, Any],
    circuit: OilCircuit,
    until: tuple[Until, ...],
    about: About,
) -> AskedDesign:
    """What is to be chosen, checked against the circuit and what is waited for."""
    path = "life.design"
    if ("code" in given) == ("choices" in given):
        rule = "needs code, or choices and [life.until], one of them"
        raise InvalidValue(Problem(path, rule))
    if "choices" not in given:
        if not circuit.filters:
            raise InvalidValue(Problem(path, "chooses the first of [[life.filters]]: add one"))
        return AskedDesign(code=given["code"], filters=given.get("filters", ()), circuits={})
    if "filters" in given:
        rule = "go with code; a choice changes numbers of the circuit"
        raise InvalidValue(Problem(f"{path}.filters", rule))
    if len(until) != 1:
        rule = f"needs one event in [life.until], e.g. filter_full = true; it has {len(until)}"
        raise InvalidValue(Problem(f"{path}.choices", rule))
    circuits = {
        entry["name"]: _circuit(reader, f"{path}.choices[{i}]", entry, circuit, about)
        for i, entry in enumerate(given["choices"])
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


# ------------------------------------------------------------------------------ the answer
@dataclass(frozen=True, eq=False, kw_only=True)
class LifeDesign(QuestionResult):
    """Results of `design_life`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedLife
    names : tuple of str
        Of the filters or circuits that were tried.
    best : str
        The one to take; "" where none is enough.
    codes : tuple of str
        To which the oil comes with each; empty where a time is asked.
    flows : array (N,)
        Least flow with which each filter is enough [m³/s]: 0 where none is needed, NaN where no
        flow is; empty where a time is asked.
    times : array (N,)
        When the event comes with each [s]; infinite where it does not come. Empty where a code is
        asked.
    """

    asked: AskedLife
    names: tuple[str, ...]
    best: str
    codes: tuple[str, ...] = ()
    flows: np.ndarray
    times: np.ndarray

    title_without = "Choice for an oil"
    citations = ("ISO 16889: multi-pass test of filters (β ratio)", "ISO 4406: code of the oil")

    @property
    def run_notes(self) -> tuple[str, ...]:
        """Those of the circuit."""
        return tuple(self.asked.circuit.notes())

    def table(self) -> tuple[dict[str, list[Any]], dict[str, str]]:
        """Columns, a row a choice, and their units."""
        columns: dict[str, list[Any]] = {"name": list(self.names)}
        units = {"name": ""}
        if self.codes:
            columns["code"], units["code"] = list(self.codes), ""
            columns["least_flow"], units["least_flow"] = plain_data(self.flows), "m^3/s"
        else:
            columns["time"], units["time"] = plain_data(self.times), "s"
        return columns, units

    @property
    def meanings(self) -> Mapping[str, str]:
        """Meanings of the columns."""
        return {
            "name": "of the filter, or of the choice",
            "code": "ISO 4406 to which the oil comes",
            "least_flow": "least flow with which the filter is enough; none where no flow is",
            "time": "until the event; none where it does not come in the duration",
        }

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        design = self.asked.design
        assert design is not None
        until = [each.to_dict() for each in self.asked.until]
        return self.whole(
            inputs={"oil": self.asked.circuit.to_dict(), "code": design.code, "until": until},
            best=self.best or None,
            choices=self.table()[0],
        )


def design_life(asked: AskedLife) -> LifeDesign:
    """The filter or the circuit that [life.design] asks for.

    Parameters
    ----------
    asked : AskedLife
        As `thirdbody.study.run_life.load_life` reads it, with a design.
    """
    design = asked.design
    assert design is not None
    return _for_code(asked, design) if design.code else _longest(asked, design)


def _for_code(asked: AskedLife, design: AskedDesign) -> LifeDesign:
    """The first filter with which the oil comes to the code."""
    circuit = asked.circuit
    own = circuit.filters[0]
    tried = [
        f if f.flow is not None else f.replace(flow=own.flow) for f in design.filters or (own,)
    ]
    names = tuple(f.name or f"filter {i}" for i, f in enumerate(tried, 1))
    with_each = [circuit.replace(filters=(f, *circuit.filters[1:])) for f in tried]
    best = filter_for_code(circuit, code=design.code, filters=tried)
    flows = [math.nan if f.line else least_flow(c, code=design.code)
             for f, c in zip(tried, with_each, strict=True)]  # fmt: skip
    return LifeDesign(
        asked=asked,
        names=names,
        best="" if best is None else names[tried.index(best)],
        codes=tuple(each.steady_code() for each in with_each),
        flows=np.array(flows),
        times=np.empty(0),
    )


def _longest(asked: AskedLife, design: AskedDesign) -> LifeDesign:
    """The choice with which the event comes last."""
    (event,) = asked.until
    if asked.contact is None and not isinstance(event, ContactUntil):
        found = longest_time(design.circuits, until=event, duration=asked.duration)
        best, times = found.name, found.times
    else:
        times = {name: _time(asked, circuit) for name, circuit in design.circuits.items()}
        best = max(times, key=lambda name: times[name])
    return LifeDesign(
        asked=asked, names=tuple(times), best=best, flows=np.empty(0),
        times=np.array(list(times.values())),
    )  # fmt: skip


def _time(asked: AskedLife, circuit: OilCircuit) -> float:
    """When the event comes in the contacts of an oil [s]; infinite where it does not."""
    from .run_life import history_of

    (event,) = asked.until
    until = (event.replace(stops=True),)
    history = history_of(replace(asked, circuit=circuit, until=until))
    came = [each.time for each in history.events if each.name == event.name]
    return came[0] if came else math.inf
