"""An oil over time of which some numbers are uncertain: bands of codes and of times."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..analysis.uncertainty.inputs import Uncertain
from ..errors import InvalidValue, Problem
from ..numerics.sampling import sobol
from ..populations.measured.cleanliness import iso4406_of_counts
from ..quantities.carried import takes_units
from ..quantities.record import Record
from ..systems.life.circuit import OilCircuit
from ..systems.life.oil_history import run_oil_history
from ..systems.life.until import Until

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["LifeBands", "Swing", "propagate_life"]

INGRESS = "ingress"
"""The name of a factor on all that enters [1]."""
PROBABILITIES = (0.05, 0.5, 0.95)


class Swing(NamedTuple):
    """What one input alone moves; in ``swings`` of `LifeBands`."""

    name: str
    """Of the input."""
    low: float
    """Count from 6 µm(c) at the end with the input at its lowest probability [1/m³]."""
    high: float
    """The same at its highest [1/m³]."""

    @property
    def factor(self) -> float:
        """The larger over the smaller [1]."""
        ends = sorted((self.low, self.high))
        return ends[1] / ends[0] if ends[0] > 0 else math.inf


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeBands(Record):
    """Bands of an oil over time; made by `propagate_life`.

    Attributes
    ----------
    probabilities : tuple of float
        Of the quantiles [1].
    samples : int
        Sets of inputs.
    counts : array (Q, 3)
        Quantiles of the counts at the end from 4, 6 and 14 µm(c) [1/m³].
    codes : tuple of str
        Their codes: each number is a quantile of its own.
    times : dict of str to array (Q,)
        Quantiles of the time at which each event comes [s]; infinite, censored, where it had not
        come at the end in so many of the sets.
    reached : dict of str to float
        In which part of the sets it came [1].
    swings : tuple of Swing
        What each input moves alone, the most first.
    """

    probabilities: tuple[float, ...]
    samples: int
    counts: Array
    codes: tuple[str, ...]
    times: Mapping[str, Array]
    reached: Mapping[str, float]
    swings: tuple[Swing, ...]


def _changed(circuit: OilCircuit, values: Mapping[str, float]) -> OilCircuit:
    """The circuit with some of its numbers changed."""
    changes = dict(values)
    factor = changes.pop(INGRESS, None)
    if factor is not None:
        scaled = [
            each.replace(
                **{
                    name: factor * getattr(each, name)
                    for name in ("rate", "steady")
                    if getattr(each, name) is not None
                }
            )
            for each in circuit.ingress
        ]
        circuit = circuit.replace(ingress=tuple(scaled))
    return circuit.replace(**changes) if changes else circuit


def _check(circuit: OilCircuit, vary: Mapping[str, Uncertain]) -> None:
    """Refuse what is no number of the circuit."""
    problems = []
    for name, known in vary.items():
        if not isinstance(known, Uncertain):
            problems.append(Problem(name, "must be Uncertain", repr(known)))
            continue
        if name == INGRESS:
            if not known.quantile(1e-9) >= 0:
                problems.append(Problem(name, "is a factor on all that enters and must be >= 0"))
            continue
        try:
            number = circuit.value_at(name)
            if not isinstance(number, float):
                problems.append(Problem(name, "is not a number of the circuit"))
                continue
            for end in (0.0, 1.0):
                _changed(circuit, {name: known.quantile(end)})
        except InvalidValue as error:
            problems += list(error.problems)
    if problems:
        raise InvalidValue(*problems)


@takes_units
def propagate_life(
    circuit: OilCircuit,
    *,
    vary: Mapping[str, Uncertain],
    duration: float,
    until: Sequence[Until] = (),
    samples: int = 256,
    seed: int = 0,
    probabilities: Sequence[float] = PROBABILITIES,
) -> LifeBands:
    """Bands of an oil over time, from what is known of its numbers.

    Parameters
    ----------
    circuit : OilCircuit
    vary : mapping of str to Uncertain
        Numbers of the circuit, "volume", "filters.0.service", and "ingress", a factor on all that
        enters.
    duration : float
        How long [s].
    until : sequence of Until, optional
        Events whose times are asked; none of them ends a history.
    samples : int, optional
        Sets of inputs, the same for all times [1].
    seed : int, optional
        Of the drawing.
    probabilities : sequence of float, optional
        Of the quantiles [1].

    Returns
    -------
    LifeBands

    Raises
    ------
    InvalidValue
        What is no number of the circuit, or a range beyond what it may be.

    Notes
    -----
    An event that does not come is censored: its time is beyond the duration, nobody knows by how
    much. Quantiles bear that; a mean does not, and none is given.

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.OilCircuit(
    ...     volume=0.2, start=tb.OilDirt.from_iso4406("18/16/13", material=quartz),
    ...     ingress=tb.Ingress.from_counts(sizes=[4e-6, 6e-6], counts=[1e6, 3e5], material=quartz),
    ...     filters=tb.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> found = propagate_life(oil, vary={"ingress": tb.Uncertain.lognormal(median=1, gsd=2)},
    ...                        duration=36000.0, samples=64)
    >>> [code.split("/")[0] for code in found.codes]
    ['16', '17', '19']
    """
    _check(circuit, vary)
    if not vary:
        raise InvalidValue(Problem("vary", "must name a number that is uncertain"))
    names = list(vary)
    points = sobol(samples, len(names), seed, 0, samples)
    waits = tuple(each.replace(stops=False) for each in until)
    events = {each.name for each in waits}
    counts, times = [], {name: [] for name in sorted(events)}  # type: ignore[var-annotated]

    def end(values: Mapping[str, float]) -> Any:
        return run_oil_history(
            _changed(circuit, values), duration=duration, until=waits, times=[0.0, duration]
        )

    for point in points:
        found = end(
            {name: vary[name].quantile(float(u)) for name, u in zip(names, point, strict=True)}
        )
        counts.append(found.counts[-1])
        for name, some in times.items():
            came = [each.time for each in found.events if each.name == name]
            some.append(came[0] if came else math.inf)
    quantiles = np.quantile(np.array(counts), probabilities, axis=0, method="hazen")
    low, high = min(probabilities), max(probabilities)
    swings = [
        Swing(
            name, *(float(end({name: vary[name].quantile(p)}).counts[-1][1]) for p in (low, high))
        )
        for name in names
    ]
    return LifeBands(
        probabilities=tuple(probabilities),
        samples=samples,
        counts=quantiles,
        codes=tuple(iso4406_of_counts(each) for each in quantiles),
        times={
            name: np.quantile(np.array(some), probabilities, method="inverted_cdf")
            for name, some in times.items()
        },
        reached={name: float(np.mean(np.isfinite(some))) for name, some in times.items()},
        swings=tuple(sorted(swings, key=lambda each: -each.factor)),
    )
