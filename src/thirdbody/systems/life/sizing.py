"""Which filter is enough for an oil, and with which of several circuits an event comes last."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ...errors import InvalidValue, Mistake, Problem
from ...populations.measured.cleanliness import iso4406_range, read_iso4406
from ...quantities.arguments import names_arguments
from ...quantities.carried import takes_units
from ..oil_filter import Filter
from .circuit import OilCircuit
from .oil_history import run_oil_history
from .until import Until

__all__ = ["Longest", "filter_for_code", "least_flow", "longest_time", "time_of_event"]


def __dir__() -> list[str]:
    return sorted(__all__)


FASTEST = 1e3
"""Volumes of the oil per second beyond which no flow is sought."""


def _worst(circuit: OilCircuit, code: str) -> float:
    """The largest count of the oil that no longer changes, over what a code allows, in logarithms.

    Infinite where a count grows for ever.
    """
    counts = circuit.size_classes().counted(circuit.steady().sum(axis=1))
    out = -math.inf
    for count, number in zip(counts, read_iso4406(code), strict=True):
        if number is None or count == 0:
            continue
        most = iso4406_range(number)[1]
        out = max(out, math.inf if math.isnan(count) else math.log(float(count) / most))
    return out


@takes_units
def least_flow(circuit: OilCircuit, *, code: str, which: int = 0) -> float:
    r"""The least flow through a filter with which an oil comes to a code [m³/s].

    .. math:: n^*(Q) = \frac{r}{Q\bar P + L_0} \le n_{code}\quad\text{at 4, 6 and 14 µm(c)}

    Parameters
    ----------
    circuit : OilCircuit
        With the filter.
    code : str
        ISO 4406, "16/14/11"; all its numbers are to be met.
    which : int, optional
        The filter whose flow is sought [1].

    Returns
    -------
    float
        0 where the oil comes to the code without it; NaN where no flow is enough, because the
        filter does not hold the particles that are too many.

    Raises
    ------
    InvalidValue
        No such filter, one in a line with others, or a code that is none.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.sizing import least_flow
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=(), filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3),
    ...     ingress=tb.oil.Ingress.from_counts(sizes=[4e-6, 6e-6], counts=[1e6, 3e5],
    ...                                        material=quartz))
    >>> f"{least_flow(oil, code='16/15/14') * 6e4:.3g} L/min"
    '95 L/min'
    """
    if not 0 <= which < len(circuit.filters):
        rule = f"must be one of the {len(circuit.filters)} filters of the circuit"
        raise InvalidValue(Problem("which", rule, repr(which), code=Mistake.RANGE))
    if circuit.filters[which].line:
        rule = "stands in a line, whose filters have one flow"
        raise InvalidValue(Problem(f"filters[{which}]", rule, code=Mistake.CLASH))

    def worst(logarithm: float) -> float:
        return _worst(circuit.replace(**{f"filters.{which}.flow": math.exp(logarithm)}), code)

    others = tuple(oil_filter for i, oil_filter in enumerate(circuit.filters) if i != which)
    if _worst(circuit.replace(filters=others), code) <= 0:
        return 0.0
    high = math.log(FASTEST * circuit.volume)
    if worst(high) > 0:
        return math.nan
    low = high
    while worst(low) <= 0:
        low -= 5.0

    def capped_worst(logarithm: float) -> float:
        return min(worst(logarithm), 50.0)

    return math.exp(brentq(capped_worst, low, low + 5.0, xtol=1e-12))


@names_arguments
@takes_units
def filter_for_code(
    circuit: OilCircuit, *, code: str, filters: Sequence[Filter], which: int = 0
) -> Filter | None:
    """The first of several filters with which an oil comes to a code; None if none is enough.

    Parameters
    ----------
    circuit : OilCircuit
        With the filter that is exchanged.
    code : str
        ISO 4406, "16/14/11"; all its numbers are to be met.
    filters : sequence of Filter
        To be tried, the smallest or cheapest first; without a flow they have that of the old one.
    which : int, optional
        The filter that is exchanged [1].

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.sizing import filter_for_code
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=(), filters=tb.oil.Filter(sizes=(4e-6,), betas=(2.0,), flow=1e-3),
    ...     ingress=tb.oil.Ingress.from_counts(sizes=[4e-6, 6e-6], counts=[3e5, 1e5],
    ...                                        material=quartz))
    >>> sheets = [tb.oil.Filter(sizes=(4e-6,), betas=(beta,), name=f"β = {beta:g}")
    ...           for beta in (1.5, 5.0, 75.0)]
    >>> filter_for_code(oil, code="16/15/14", filters=sheets).name
    'β = 5'
    """
    present_filter = circuit.filters[which]
    for oil_filter in filters:
        tried = (
            oil_filter
            if oil_filter.flow is not None
            else oil_filter.replace(flow=present_filter.flow)
        )
        exchanged = tuple(tried if i == which else f for i, f in enumerate(circuit.filters))
        if _worst(circuit.replace(filters=exchanged), code) <= 0:
            return tried
    return None


@takes_units
def time_of_event(circuit: OilCircuit, *, until: Until, duration: float) -> float:
    """When an event comes [s]; infinite where it does not come in the duration.

    Parameters
    ----------
    circuit : OilCircuit
    until : Until
        The event.
    duration : float
        How long it is waited for [s].

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.sizing import time_of_event
    >>> dirt = tb.oil.OilDirt.from_iso4406("18/16/13", material=tb.materials["quartz"])
    >>> oil = tb.oil.OilCircuit(volume=0.2, start=dirt, ingress=(),
    ...                     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> round(time_of_event(oil, until=tb.oil.until.iso4406("15/13/10"), duration=3600.0))
    351
    """
    stops = until.replace(stops=True)
    history = run_oil_history(circuit, duration=duration, until=(stops,), times=[0.0, duration])
    reached = [event.time for event in history.events if event.name == stops.name]
    return reached[0] if reached else math.inf


class Longest(NamedTuple):
    """The circuit with which an event comes last; made by `longest_time`."""

    name: str
    """Of the circuit."""
    time: float
    """When it comes [s]; infinite where it does not come while it is waited for."""
    times: dict[str, float]
    """When it comes with each [s]."""


@takes_units
def longest_time(circuits: Mapping[str, OilCircuit], *, until: Until, duration: float) -> Longest:
    """The circuit of several with which an event comes last.

    Parameters
    ----------
    circuits : mapping of str to OilCircuit
        By name; of those that are equal the first counts.
    until : Until
        The event.
    duration : float
        How long it is waited for [s].

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.life.sizing import longest_time
    >>> dust = tb.oil.Ingress.of_dust("A3", rate="100 mg/h", material=tb.materials["quartz"])
    >>> def oil(grams):
    ...     sheet = tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3, capacity=1e-3 * grams)
    ...     return tb.oil.OilCircuit(volume=0.2, start=(), ingress=dust, filters=sheet)
    >>> found = longest_time({"20 g": oil(20), "50 g": oil(50)}, until=tb.oil.until.filter_full(),
    ...                      duration=1e7)
    >>> found.name, round(found.time / found.times["20 g"], 2)
    ('50 g', 2.5)
    """
    if not circuits:
        raise InvalidValue(Problem("circuits", "must hold one at least", code=Mistake.EMPTY))
    times = {
        name: time_of_event(circuit, until=until, duration=duration)
        for name, circuit in circuits.items()
    }
    best = list(times)[int(np.argmax(list(times.values())))]
    return Longest(best, times[best], times)
