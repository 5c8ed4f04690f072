"""The filter or the circuit that a study with [life.design] asks for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..quantities.plain_data import plain_data
from ..systems.life.circuit import OilCircuit
from ..systems.life.sizing import filter_for_code, least_flow, longest_time
from ..systems.life.until import ContactUntil
from .asked_result import QuestionResult, question_entries
from .life import AskedLife
from .life_design import AskedDesign
from .run_dry import UNTIL
from .run_life import OIL, history_of

__all__ = ["LifeDesign", "design_life"]


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

    in_dict = question_entries(
        ("inputs", (OIL, ("code", "asked.design.code"), UNTIL)),
        ("best", lambda result: result.best or None),
        ("choices", lambda result: result.table()[0]),
    )
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

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row a choice, and their units."""
        columns: dict[str, list[object]] = {"name": list(self.names)}
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


def design_life(request: AskedLife) -> LifeDesign:
    """The filter or the circuit that [life.design] asks for.

    Parameters
    ----------
    request : AskedLife
        As `thirdbody.study.run_life.load_life` reads it, with a design.
    """
    design = request.design
    assert design is not None
    return _for_code(request, design) if design.code else _longest(request, design)


def _for_code(request: AskedLife, design: AskedDesign) -> LifeDesign:
    """The first filter with which the oil comes to the code."""
    circuit = request.circuit
    first = circuit.filters[0]
    tried = [
        f if f.flow is not None else f.replace(flow=first.flow) for f in design.filters or (first,)
    ]
    names = tuple(f.name or f"filter {i}" for i, f in enumerate(tried, 1))
    with_each = [circuit.replace(filters=(f, *circuit.filters[1:])) for f in tried]
    best = filter_for_code(circuit, code=design.code, filters=tried)
    flows = [math.nan if f.line else least_flow(c, code=design.code)
             for f, c in zip(tried, with_each, strict=True)]  # fmt: skip
    return LifeDesign(
        asked=request,
        names=names,
        best="" if best is None else names[tried.index(best)],
        codes=tuple(circuit.steady_code() for circuit in with_each),
        flows=np.array(flows),
        times=np.empty(0),
    )


def _longest(request: AskedLife, design: AskedDesign) -> LifeDesign:
    """The choice with which the event comes last."""
    (event,) = request.until
    if request.contact is None and not isinstance(event, ContactUntil):
        longest = longest_time(design.circuits, until=event, duration=request.duration)
        best, times = longest.name, longest.times
    else:
        times = {name: _time(request, circuit) for name, circuit in design.circuits.items()}
        best = max(times, key=lambda name: times[name])
    return LifeDesign(
        asked=request, names=tuple(times), best=best, flows=np.empty(0),
        times=np.array(list(times.values())),
    )  # fmt: skip


def _time(request: AskedLife, circuit: OilCircuit) -> float:
    """When the event comes in the contacts of an oil [s]; infinite where it does not."""
    (event,) = request.until
    until = (event.replace(stops=True),)
    history = history_of(replace(request, circuit=circuit, until=until))
    came = [past_event.time for past_event in history.events if past_event.name == event.name]
    return came[0] if came else math.inf
