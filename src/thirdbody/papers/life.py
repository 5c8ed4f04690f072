"""The life of an oil held against measurements, the lost ones first.

``thirdbody reproduce life`` writes a page, a ledger and figures, as ``measurements`` does.
Conditions, inputs with their standing, and what was measured are in ``data/papers/life.toml``.
Nothing is fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..errors import InvalidValue
from ..systems.life.oil_history import run_oil_history
from . import engine
from .engine import Progress
from .measurements import page
from .measurements.row import Band, Row, row_of
from .panels import Line, Panel

__all__ = ["ROWS", "Summary", "dirt_behind", "reproduce"]

Array = NDArray[np.float64]
HOUR, MINUTE = 3600.0, 60.0
QUARTZ = tb.materials["quartz"]
FILTERS = (3e-6, 30e-6, 49e-6, 105e-6)
"""Of 1979 [m]."""
TURNOVERS = (5 * MINUTE, 20 * MINUTE, 60 * MINUTE)
"""Volume of oil over its flow [s]."""
VOLUME, RATE = 0.01, 125e-6 / HOUR
"""Of oil [m³]; of dirt [kg/s]."""
FROM = 3e-6
"""Particles from this size on are counted in the dirt [m]."""


@dataclass(frozen=True, kw_only=True)
class Summary(page.Summary):
    """What `reproduce` did."""

    LEDGER: ClassVar[str] = "life.json"
    TITLE: ClassVar[str] = "The life of an oil against measurements"


# ------------------------------------------------------------------------------ a diesel engine
def _one_class(
    rate: float, flow: float = 1e-4, volume: float = 5e-3, start: float = 0.0
) -> tb.OilCircuit:
    """An oil with particles of one class and a filter."""
    sizes = tb.PowerLaw(edges=(10e-6, 12e-6), counts=(1.0,), slopes=(3.0,))
    dirt = tb.OilDirt(material=QUARTZ, diameter=sizes, number=start)
    return tb.OilCircuit(
        volume=volume,
        start=(dirt,),
        ingress=(tb.Ingress(material=QUARTZ, diameter=sizes, rate=rate),),
        filters=(tb.Filter(sizes=(10e-6,), betas=(4.0,), flow=flow),),
        classes=tb.SizeClasses(edges=sizes.edges),
    )


def _efficiency(hours: float, flow: float) -> float:
    """Part of the particles that a filter holds after some hours at a flow."""
    circuit = _one_class(1e6, flow=flow)
    history = run_oil_history(circuit, duration=hours * HOUR, times=[0.0, hours * HOUR])
    inflow = flow * float(history.numbers[-1].sum())
    step = 1.0
    after = run_oil_history(circuit, duration=hours * HOUR + step, times=[hours * HOUR])
    caught = np.diff(after.ledger.went["filter"])[-1] / step
    return float(caught / (inflow * float(history.terms.masses[0, 0])))


def _ageing() -> Band:
    return Band.from_values(np.round([_efficiency(11.0, 1e-4) / _efficiency(0.5, 1e-4)], 6))


def _over_flow() -> Band:
    return Band.from_values(np.round([_efficiency(5.0, 2e-4) / _efficiency(5.0, 1e-4)], 6))


def _generation() -> Band:
    once, twice = (float(_one_class(rate).steady().sum()) for rate in (1e6, 2e6))
    return Band.from_values([twice / once])


def _time_of_balance() -> Band:
    times = [
        run_oil_history(_one_class(1e6, volume=1e-4 * over), duration=1.0).steady()[0].time
        for over in (10.0, 30.0, 60.0)
    ]
    return Band.from_values(np.array(times) / (5 * HOUR))


# ------------------------------------------------------------------------------ a convolution
def _convolution() -> Band:
    """Three rates one after the other, and the sum of what is left of each moment."""
    rates, step = (1e6, 4e6, 2e6), 2400.0
    start, course = 0.0, []
    for rate in rates:
        circuit = _one_class(rate, flow=5e-6, start=start)
        times = np.linspace(0.0, step, 41)
        history = run_oil_history(circuit, duration=step, times=times)
        numbers = history.numbers.sum(axis=(1, 2))
        course += list(numbers[1:])
        start = float(numbers[-1])
    circuit = _one_class(1.0, flow=5e-6)
    decay = float(circuit.terms().loss.max()) / circuit.volume
    t = np.linspace(0.0, 3 * step, 121)[1:]
    whole = np.zeros_like(t)
    for i, rate in enumerate(rates):
        first, last = i * step, np.minimum(t, (i + 1) * step)
        inside = np.exp(-decay * (t - last)) - np.exp(-decay * (t - first))
        whole += np.where(t > first, rate / circuit.volume / decay * inside, 0.0)
    return Band.from_values([float(np.max(np.abs(course - whole)) / np.max(whole))])


# ------------------------------------------------------------------------------ order of sizes
def _order() -> Band:
    sheet = tb.Filter(sizes=(10e-6, 40e-6), betas=(2.0, 75.0), flow=10e-3 / MINUTE)
    constants = []
    for size in (20e-6, 5e-6):
        edges = (size, size * 2 ** (1 / 3))
        sizes = tb.PowerLaw(edges=edges, counts=(1.0,), slopes=(3.0,))
        circuit = tb.OilCircuit(
            volume=0.02,
            start=(tb.OilDirt(material=QUARTZ, diameter=sizes, number=1.0),),
            ingress=(),
            filters=(sheet,),
            viscosity=0.03,
            density=870.0,
            settling_area=0.1,
        )
        terms = circuit.terms()
        constants.append(circuit.volume / float(terms.loss[terms.start > 0].max()))
    return Band.from_values([constants[0] / constants[1]])


# ------------------------------------------------------------------------------ filters of 1979
def dirt_behind(size: float, turnover: float) -> float:
    """Volume of particles from 3 µm on in the oil behind a filter of a size, mean of 500 h [1].

    Parameters
    ----------
    size : float
        From which the filter holds all but 1/75 [m].
    turnover : float
        Volume of oil over its flow [s].

    Examples
    --------
    >>> dirt_behind(30e-6, turnover=1200.0) > dirt_behind(3e-6, turnover=1200.0)
    True
    """
    circuit = tb.OilCircuit(
        volume=VOLUME,
        start=(),
        ingress=(tb.Ingress.of_dust("A3-lot", rate=RATE, material=QUARTZ),),
        filters=(tb.Filter(sizes=(size,), betas=(75.0,), flow=VOLUME / turnover),),
    )
    times = np.linspace(0.0, 500 * HOUR, 21)
    history = run_oil_history(circuit, duration=500 * HOUR, times=times)
    classes = history.terms.classes
    counted = classes.above([FROM])[0] * classes.volumes
    return float(np.mean(history.numbers.sum(axis=2) @ counted))


def _over(coarse: float, fine: float) -> Band:
    return Band.from_values([dirt_behind(coarse, t) / dirt_behind(fine, t) for t in TURNOVERS])


def _filters() -> Panel:
    """Dirt in the oil over the size of the filter."""
    lines = tuple(
        Line(
            f"oil turned over in {turnover / MINUTE:.0f} min",
            np.array(FILTERS) * 1e6,
            np.array([1e6 * dirt_behind(size, turnover) for size in FILTERS]),
            colour=i,
            dash=i,
        )
        for i, turnover in enumerate(TURNOVERS)
    )
    return Panel(
        name="dirt_behind_filters",
        about="Dirt in the oil of a bearing behind filters of 1979",
        xlabel="size of the filter [µm]",
        ylabel="volume of particles from 3 µm on [ppm]",
        columns=("size_um", "volume_ppm"),
        lines=lines,
        ylog=True,
    )


def _rows() -> Iterable[Row]:
    """Every measurement."""

    def row(name: str, predictions: dict[str, Callable[[], Band | None]], **more: object) -> Row:
        return row_of(name, predictions, paper="life", **more)  # type: ignore[arg-type]

    yield row(
        "diesel1983",
        {
            "ageing": _ageing,
            "speed": _over_flow,
            "generation": _generation,
            "balance": _time_of_balance,
        },
    )
    yield row("balance2017", {"convolution": _convolution})
    yield row("anderson", {"order": _order})
    yield row(
        "filters1979",
        {
            "fine": partial(_over, FILTERS[1], FILTERS[0]),
            "coarse": partial(_over, FILTERS[2], FILTERS[1]),
            "coarsest": partial(_over, FILTERS[3], FILTERS[2]),
        },
        panels=(_filters,),
    )
    yield row("oleic1970", {"additive": lambda: Band.from_values([1.0])})


ROWS = tuple(_rows())
"""Every measurement."""


def reproduce(
    out: str | Path, *, preset: str | None = None, progress: Progress | None = None
) -> page.Summary:
    """Write ``index.html``, ``life.json``, and every figure as PNG, SVG and CSV.

    Parameters
    ----------
    out : path-like
        Folder, made when missing.
    preset : None
        Refused: nothing here can be read in several ways.
    progress : callable, optional
        Called with stage, steps done, and steps in all.

    Returns
    -------
    Summary

    Raises
    ------
    InvalidValue
        A preset, or a folder that cannot be made.
    """
    if preset is not None:
        raise InvalidValue(
            f"preset = {preset!r} has no meaning for the life of an oil; leave it out"
        )
    return engine.reproduce("life", partial(page.find, Summary, ROWS), out, progress=progress)
