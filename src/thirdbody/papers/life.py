"""The life of an oil held against measurements, the lost ones first.

``thirdbody reproduce life`` writes a page, a ledger and figures, as ``measurements`` does.
Conditions, inputs with their standing, and what was measured are in ``data/papers/life.toml``.
Nothing is fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..errors import InvalidValue, Mistake, Problem
from ..systems.life.debris import Debris
from ..systems.life.oil_history import run_oil_history
from ..systems.life.surfaces import RunningIn
from ..systems.life.until import roughness_below
from . import engine
from .engine import Progress
from .measurements import page
from .measurements.row import Band, Row, row_of
from .measurements.trezona1999 import COEFFICIENTS, PRESSURES, wear_columns
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
) -> tb.oil.OilCircuit:
    """An oil with particles of one class and a filter."""
    sizes = tb.distributions.PowerLaw(edges=(10e-6, 12e-6), counts=(1.0,), slopes=(3.0,))
    dirt = tb.oil.OilDirt(material=QUARTZ, diameter=sizes, number=start)
    return tb.oil.OilCircuit(
        volume=volume,
        start=(dirt,),
        ingress=(tb.oil.Ingress(material=QUARTZ, diameter=sizes, rate=rate),),
        filters=(tb.oil.Filter(sizes=(10e-6,), betas=(4.0,), flow=flow),),
        classes=tb.oil.SizeClasses(edges=sizes.edges),
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
    sheet = tb.oil.Filter(sizes=(10e-6, 40e-6), betas=(2.0, 75.0), flow=10e-3 / MINUTE)
    constants = []
    for size in (20e-6, 5e-6):
        edges = (size, size * 2 ** (1 / 3))
        sizes = tb.distributions.PowerLaw(edges=edges, counts=(1.0,), slopes=(3.0,))
        circuit = tb.oil.OilCircuit(
            volume=0.02,
            start=(tb.oil.OilDirt(material=QUARTZ, diameter=sizes, number=1.0),),
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
def dirt_behind(size: float, turnover: float, *, beta: float = 75.0) -> float:
    """Volume of particles from 3 µm on in the oil behind a filter of a size, mean of 500 h [1].

    Parameters
    ----------
    size : float
        From which the filter holds all but 1/β [m].
    turnover : float
        Volume of oil over its flow [s].
    beta : float, optional
        Of the filter at its size [1].

    Examples
    --------
    >>> dirt_behind(30e-6, turnover=1200.0) > dirt_behind(3e-6, turnover=1200.0)
    True
    """
    circuit = tb.oil.OilCircuit(
        volume=VOLUME,
        start=(),
        ingress=(tb.oil.Ingress.of_dust("A3-lot", rate=RATE, material=QUARTZ),),
        filters=(tb.oil.Filter(sizes=(size,), betas=(beta,), flow=VOLUME / turnover),),
    )
    times = np.linspace(0.0, 500 * HOUR, 21)
    history = run_oil_history(circuit, duration=500 * HOUR, times=times)
    classes = history.terms.classes
    counted = classes.above([FROM])[0] * classes.volumes
    return float(np.mean(history.numbers.sum(axis=2) @ counted))


def _dirt_ratio(coarse: float, fine: float) -> Band:
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


# ------------------------------------------------------------------------------ contacts
def _sliding(
    second_hardness: float = 2.5e9,
    *,
    K: float = 1e-6,
    sigma: float = 100e-9,
    tau_sa: float = 200e6,
    f_ab: float = 0.1,
) -> tb.Contact:
    """Steel on steel with friction and wear, no particles; tips in proportion to the roughness."""
    steel = tb.materials["S45C"]
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel.replace(H=second_hardness)),
        roughness=tb.Roughness(sigma=sigma, R=2.8e-6 * sigma / 100e-9),
        outputs=(
            tb.outputs.Friction(tau_ss=580e6, tau_sa=tau_sa),
            tb.outputs.Wear(K_ss=K, K_ss_ep=K, K_ss_e=K, K_sa=0.0, f_ab=f_ab, f_roll=0.001,
                            renewal=1.0),
        ),
    )  # fmt: skip


def _with_grains(contact: tb.Contact, size: float, density: float) -> tb.Contact:
    grains = tb.Particles(
        material=QUARTZ, diameter=tb.distributions.Monodisperse(mean=size), areal_density=density
    )
    return contact.replace(particles=grains)


def _maximum() -> Band:
    every = [wear_columns(PRESSURES[0], coefficients)["wear"] for coefficients in COEFFICIENTS]
    return Band.from_values([max(wear) / max(wear[0], wear[-1]) for wear in every])


def _rolling() -> Band:
    """How far rolling shares of grains of one size are from nine tenths."""
    shares = []
    for size in (1e-6, 3e-6, 10e-6):
        for tau_sa in (50e6, 100e6, 200e6, 400e6):
            contact = _with_grains(_sliding(tau_sa=tau_sa), size, 1e8)
            shares.append(float(tb.solve(contact, pressure=5e6).outputs["rolling_share"]))
    far = np.abs(np.array(shares) - 0.9)
    return Band.from_values(far, f"rolling shares of {min(shares):.3g} to {max(shares):.3g}")


@cache
def _dust_in_film() -> tuple[tuple[dict[float, float], dict[float, float]], ...]:
    """Wear rate [m/s] and friction of the solids in a thin film, by entry ratio; 0 is clean."""
    dirt = tb.oil.OilDirt.from_iso4406("18/16/13", material=QUARTZ, largest=30e-6)
    out = []
    for K in (1e-8, 1e-6):
        wear: dict[float, float] = {}
        friction: dict[float, float] = {}
        for entry in (0.0, 0.01, 0.1, 1.0):
            circuit = tb.oil.OilCircuit(
                volume=0.01,
                start=(dirt,) if entry else (),
                ingress=(),
                classes=tb.oil.SizeClasses.covering(smallest=4e-6, largest=32e-6),
            )
            history = tb.life(
                _sliding(K=K),
                oil=circuit,
                conjunction=tb.films.Point(R=9.5e-3),
                lubricant=tb.films.Oil(eta=0.02, alpha=2e-8),
                load=20.0,
                speed=0.1,
                slide_roll=0.2,
                entry_ratio=entry or 1.0,
                worn_area=(1e-3, 1e-3),
                debris=Debris.boundary_lubricated(),
                duration=1.0,
                times=[0.0, 1.0],
            )
            columns = {name: float(values[0]) for name, (_, values) in history.more.items()}
            wear[entry] = columns["wear_rate_1"] + columns["wear_rate_2"]
            friction[entry] = columns["mu_solids"]
        out.append((wear, friction))
    return tuple(out)


def _dusty() -> Band:
    """Wear with dust over that without."""
    return Band.from_values(
        [wear[entry] / wear[0.0] for wear, _ in _dust_in_film() for entry in (0.01, 0.1, 1.0)]
    )


def _rise(which: int) -> Band:
    """Wear (0) or friction (1) with ten times as many grains over that with as many."""
    columns = [pair[which] for pair in _dust_in_film()]
    return Band.from_values([column[1.0] / column[0.1] for column in columns])


# ------------------------------------------------------------------------------ running-in
DRY: dict[str, Any] = {
    "sliding_speed": 0.1, "length": 10e-3, "area": 1e-4, "loss": 1.0, "moving": 1,
    "worn_area": (1e-4, 1e-4), "arrivals": (),
}  # fmt: skip


def _run_in(sigma: float, end: float, until: float, pressure: float) -> float:
    """Wear depth of both surfaces when the roughness has come down to a value [m]."""
    history = tb.life(
        _sliding(K=1e-4, sigma=sigma, f_ab=0.0),
        pressure=pressure,
        duration=1e7,
        until=roughness_below(until),
        debris=Debris(diameter=tb.distributions.Monodisperse(mean=0.4e-6)),
        running_in=RunningIn(sigma_end=end),
        **DRY,
    )  # fmt: skip
    return sum(float(history.more[f"wear_{side}"][1][-1]) for side in (1, 2))


def _exponents() -> Band:
    first, second = 80e-9, 160e-9
    out = []
    for pressure in (1e6, 1e7):
        halved = [_run_in(s, 0.45 * s, 0.5 * s, pressure) for s in (first, second)]
        down = [_run_in(s, 40e-9, 44e-9, pressure) for s in (first, second)]
        out += [np.log(b / a) / np.log(2) for a, b in (halved, down)]
    return Band.from_values(out)


def _equilibrium() -> Band:
    ends = []
    for sigma in (80e-9, 160e-9):
        history = tb.life(
            _sliding(K=1e-4, sigma=sigma), pressure=5e6, duration=1e8, times=[0.0, 1e8],
            debris=Debris(diameter=tb.distributions.Monodisperse(mean=0.4e-6)),
            running_in=RunningIn(sigma_end=60e-9), **DRY,
        )  # fmt: skip
        ends.append(float(history.more["sigma"][1][-1]))
    return Band.from_values([ends[1] / ends[0]])


# ------------------------------------------------------------------------------ a steady third body
@cache
def _steady_courses() -> tuple[tuple[float, float], ...]:
    """Wear flow over source in the steady state, and the last change of the wear rate."""
    out = []
    for loss in (0.1, 0.3, 1.0):
        arrivals = tb.oil.Ingress(
            material=QUARTZ,
            diameter=tb.distributions.PowerLaw(edges=(1e-6, 4e-6), counts=(1.0,), slopes=(3.0,)),
            rate=1e4,
        )
        history = tb.life(
            _sliding(5e9), pressure=5e6, duration=3600.0,
            debris=Debris(diameter=tb.LogNormal(median=2e-6, gsd=1.3), hardness=9e9),
            **(DRY | {"loss": loss, "arrivals": arrivals}),
        )  # fmt: skip
        ledger, half = history.ledger, np.searchsorted(history.times, 1800.0)
        came = sum(values[-1] - values[half] for values in ledger.came.values())
        went = sum(values[-1] - values[half] for values in ledger.went.values())
        rate = history.more["wear_rate_2"][1][half:]
        out.append((float(went / came), float(np.ptp(rate) / np.max(rate))))
    return tuple(out)


def _not_computed() -> None:
    return None


def _ultraclean() -> Band:
    return Band.from_values(
        [
            min(
                dirt_behind(FILTERS[0], t) / dirt_behind(1e-6, t),
                dirt_behind(FILTERS[2], t) / dirt_behind(FILTERS[0], t),
            )
            for t in TURNOVERS
        ]
    )


def _monotone() -> Band:
    out = []
    for t in TURNOVERS:
        dirt = [dirt_behind(x, t, beta=200.0) for x in (3e-6, 6e-6, 12e-6, 25e-6, 50e-6)]
        out.append(min(b / a for a, b in pairwise(dirt)))
    return Band.from_values(out)


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
            "fine": partial(_dirt_ratio, FILTERS[1], FILTERS[0]),
            "coarse": partial(_dirt_ratio, FILTERS[2], FILTERS[1]),
            "coarsest": partial(_dirt_ratio, FILTERS[3], FILTERS[2]),
        },
        panels=(_filters,),
    )
    yield row("ultraclean1982", {"order": _ultraclean, "factor": partial(_dirt_ratio, 49e-6, 3e-6)})
    yield row("needelman", {"order": _monotone})
    yield row("microabrasion1999", {"maximum": _maximum})
    yield row("rabinowicz1961", {"share": _rolling, "tenth": _not_computed})
    yield row("ronen1980", {"sign": _dusty, "factor": _dusty})
    yield row("ringliner", {"wear": partial(_rise, 0), "friction": partial(_rise, 1)})
    yield row("koulocheris2013", {"size": _not_computed})
    yield row("oleic1970", {"additive": lambda: Band.from_values([1.0])})
    yield row("akchurin2016", {"sizes": _not_computed, "numbers": _not_computed})
    yield row("equilibrium1991", {"end": _equilibrium})
    yield row("runningin2016", {"exponent": _exponents})
    yield row("siniawski2007", {"power": lambda: Band.from_values([1.0])})
    yield row(
        "fillot2007",
        {
            "equal": lambda: Band.from_values([course[0] for course in _steady_courses()]),
            "constant": lambda: Band.from_values([course[1] for course in _steady_courses()]),
        },
    )


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
            Problem(
                "preset",
                "has no meaning for the life of an oil; leave it out",
                repr(preset),
                code=Mistake.IDLE,
            )
        )
    return engine.reproduce("life", partial(page.find, Summary, ROWS), out, progress=progress)
