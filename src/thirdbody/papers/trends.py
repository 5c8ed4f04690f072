"""What particles do to a rough contact under load: curves of one reading, and what they say.

A reading of a paper solves its model at nominal pressures. Everything about it can be changed by
factors (twice the size, half the density), so the same measure serves every reading and paper.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .ledger import Claim, Measurement, Verdict, data_of
from .panels import Line, Panel

__all__ = [
    "MEASURES",
    "Reading",
    "Trend",
    "area_panel",
    "changes_panel",
    "exponent_panel",
    "ratio_panel",
    "readings_of",
    "score",
]

Array = NDArray[np.float64]
Measure = Callable[..., Measurement]
MEASURES: dict[str, Measure] = {}
"""What can be measured, by the name a claim calls it."""

PRESSURE = "nominal pressure $p$ [Pa]"


@dataclass(frozen=True)
class Trend:
    """A contact with particles over nominal pressure; areas per nominal area."""

    pressure: Array
    area: Array
    bare_area: Array
    """Real area of the same surfaces under the same pressure without particles"""
    load_share: Array
    """Share of the load on particles"""

    @property
    def ratio(self) -> Array:
        """Real area over that without particles [1]."""
        return self.area / self.bare_area

    @property
    def exponents(self) -> Array:
        """Local exponents n of A ∝ p^n between neighbours [1]."""
        return np.diff(np.log(self.area)) / np.diff(np.log(self.pressure))


@dataclass(frozen=True)
class Reading:
    """One way to read a paper.

    ``solve(pressures, factors)`` gives the `Trend`; factors multiply inputs of the reading, by
    the names in ``factors``.
    """

    name: str
    title: str
    pressures: Array
    solve: Callable[[Array, Mapping[str, float]], Trend]
    factors: tuple[str, ...]
    inputs: Mapping[str, str]
    """What the reading assumes, for the reader: numbers with units in words."""

    def trend(self, pressures: object = None, **factors: float) -> Trend:
        """The contact with some inputs multiplied, at its own pressures unless others are given."""
        p = self.pressures if pressures is None else np.atleast_1d(np.asarray(pressures, float))
        return self.solve(p, factors)


def measure(function: Measure) -> Measure:
    """Make a function known to claims by its name."""
    MEASURES[function.__name__] = function
    return function


def readings_of(
    paper: str,
    pressures: Array,
    solve: Callable[[str, Array, Mapping[str, float]], Trend],
) -> dict[str, Reading]:
    """The readings of a data file; ``solve`` takes the name of one first."""
    readings = data_of(paper)["readings"]
    first = next(iter(readings.values()))
    return {
        name: Reading(
            name,
            one["title"],
            pressures,
            partial(solve, name),
            tuple(one.get("factors", first["factors"])),
            first["inputs"] | one.get("inputs", {}),
        )
        for name, one in readings.items()
    }


def score(
    reading: Reading, claims: tuple[Claim, ...], measures: Mapping[str, Measure]
) -> dict[str, Verdict]:
    """The verdict on every claim in one reading, by claim id."""
    out = {}
    for claim in claims:
        of = claim.inputs.get("of")
        if of is not None and of not in reading.factors:
            measured = Measurement.absent(f"{of} is no input of this reading")
        else:
            measured = measures[claim.measure](reading, **claim.inputs)
        out[claim.id] = claim.judge(measured)
    return out


# ------------------------------------------------------------------ what a trend says
@measure
def area_exponents(reading: Reading) -> Measurement:
    """Smallest and largest local exponent of A ∝ p^n; the fit over the whole range as a note."""
    trend = reading.trend()
    fit = np.polyfit(np.log(trend.pressure), np.log(trend.area), 1)[0]
    n = trend.exponents
    return Measurement.from_values(n.min(), n.max(), note=f"fitted over the range: {fit:.3f}")


@measure
def bare_exponents(reading: Reading) -> Measurement:
    """The same without particles."""
    trend = reading.trend()
    n = np.diff(np.log(trend.bare_area)) / np.diff(np.log(trend.pressure))
    return Measurement.from_values(n.min(), n.max())


@measure
def exponents_on_particles(reading: Reading) -> Measurement:
    """Smallest and largest exponent while the particles carry at least 99 % of the load."""
    trend = reading.trend()
    n = trend.exponents[trend.load_share[1:] >= 0.99]
    if not len(n):
        return Measurement.absent("the particles never carry 99 % of the load")
    return Measurement.from_values(n.min(), n.max())


@measure
def area_change(
    reading: Reading, of: str, by: float, pressure: float, **also: float
) -> Measurement:
    """Real area after multiplying one input, over the area before."""
    after = reading.trend(pressure, **{of: by}, **also)
    return Measurement.from_values(after.area[0] / reading.trend(pressure, **also).area[0])


@measure
def area_change_either_way(
    reading: Reading, of: str, by: float, pressure: float, **also: float
) -> Measurement:
    """The factor, above 1, by which multiplying one input raises or lowers the area."""
    (ratio,) = area_change(reading, of, by, pressure, **also).values
    return Measurement.from_values(max(ratio, 1 / ratio), note="larger" if ratio > 1 else "smaller")


@measure
def load_share(reading: Reading, pressure: float, **factors: float) -> Measurement:
    """Share of the load on particles."""
    return Measurement.from_values(reading.trend(pressure, **factors).load_share[0])


@measure
def loss_over_loss(reading: Reading, of: str, by: float, pressure: float) -> Measurement:
    """Area lost to particles, 1 − A/A_bare, after multiplying one input, over that before."""
    before, after = (reading.trend(pressure, **{of: f}).ratio[0] for f in (1.0, by))
    return Measurement.from_values((1 - after) / (1 - before))


@measure
def exponent_at(reading: Reading, of: str, by: float, pressure: float) -> Measurement:
    """Exponent of A ∝ p^n at one pressure, with one input multiplied."""
    around = pressure * np.array([0.99, 1.01])
    return Measurement.from_values(reading.trend(around, **{of: by}).exponents[0])


@measure
def area_ratio_at(reading: Reading, of: str, by: float, pressure: float) -> Measurement:
    """Real area over that without particles, with one input multiplied."""
    return Measurement.from_values(reading.trend(pressure, **{of: by}).ratio[0])


@measure
def recovery(reading: Reading, ratio: float) -> Measurement:
    """Lowest pressure [Pa] above which the area stays within a stated part of the bare area."""
    trend = reading.trend()
    lost = np.flatnonzero(trend.ratio < ratio)
    if not len(lost) or lost[-1] == len(trend.ratio) - 1:
        return Measurement.absent(f"not up to {trend.pressure[-1]:.3g} Pa")
    i = lost[-1]
    fraction = (ratio - trend.ratio[i]) / (trend.ratio[i + 1] - trend.ratio[i])
    low, high = np.log(trend.pressure[i : i + 2])
    return Measurement.from_values(math.exp(low + fraction * (high - low)))


@measure
def factor_without_loss(
    reading: Reading, of: str, pressure: float, low: float, high: float
) -> Measurement:
    """Factor on one input at which the area with particles equals that without."""

    def is_lower(factor: float) -> bool:
        return bool(reading.trend(pressure, **{of: factor}).ratio[0] < 1 - 1e-9)

    at_low = is_lower(low)
    if at_low == is_lower(high):
        return Measurement.absent(f"none between {low:g} and {high:g}")
    while high / low > 1 + 1e-9:
        middle = math.sqrt(low * high)
        if is_lower(middle) == at_low:
            low = middle
        else:
            high = middle
    return Measurement.from_values(math.sqrt(low * high))


@measure
def area_ratios(reading: Reading) -> Measurement:
    """Smallest and largest real area over that without particles."""
    ratio = reading.trend().ratio
    return Measurement.from_values(ratio.min(), ratio.max())


@measure
def not_in_the_model(reading: Reading, why: str) -> Measurement:
    """A statement about something that the reading does not contain."""
    return Measurement.absent(why)


# ------------------------------------------------------------------ panels
def area_panel(readings: Mapping[str, Reading], name: str) -> Panel:
    """Real area over pressure, with and without particles."""
    lines = []
    trends = [(reading, reading.trend()) for reading in readings.values()]
    drawn: list[Array] = []
    for reading, trend in trends:
        if not any(np.allclose(trend.bare_area, curve, atol=0.0) for curve in drawn):
            drawn.append(trend.bare_area)
            label = f"bare: {reading.inputs['surface']}"
            lines.append(Line(label, trend.pressure, trend.bare_area, -1, len(drawn) - 1))
    for i, (reading, trend) in enumerate(trends):
        lines.append(Line(f"with particles:\n{reading.title}", trend.pressure, trend.area, i, i))
    return Panel(
        name,
        "real area with and without particles",
        PRESSURE,
        "real area $A/A_n$ [1]",
        ("pressure_Pa", "area"),
        tuple(lines),
        ylog=True,
    )


def ratio_panel(
    readings: Mapping[str, Reading], name: str, pressures: Array | None = None
) -> Panel:
    """Real area over that of bare surfaces."""
    lines = []
    for i, reading in enumerate(readings.values()):
        trend = reading.trend(pressures)
        lines.append(Line(reading.title, trend.pressure, trend.ratio, i, i))
    return Panel(
        name,
        "real area over that without particles, at equal load",
        PRESSURE,
        "$A/A_{bare}$ [1]",
        ("pressure_Pa", "area_ratio"),
        tuple(lines),
        ylog=True,
        levels=((1.0, "no effect"),),
    )


def exponent_panel(
    readings: Mapping[str, Reading],
    name: str,
    note: str = "",
    ylim: tuple[float | None, float | None] = (None, None),
) -> Panel:
    """Local exponent of area over load."""
    lines = []
    for i, reading in enumerate(readings.values()):
        trend = reading.trend()
        middle = np.sqrt(trend.pressure[1:] * trend.pressure[:-1])
        lines.append(Line(reading.title, middle, trend.exponents, i, i))
    return Panel(
        name,
        r"local exponent $n$ of $A \propto p^n$",
        PRESSURE,
        r"$n = \mathrm{d}\ln A/\mathrm{d}\ln p$ [1]",
        ("pressure_Pa", "exponent"),
        tuple(lines),
        levels=((1.0, "area proportional to load"),),
        note=note,
        ylim=ylim,
    )


def changes_panel(
    reading: Reading,
    name: str,
    of: str,
    factors: Mapping[float, str],
    about: str,
    *,
    ylog: bool = True,
    note: str = "",
) -> Panel:
    """The area ratio of one reading with one input multiplied."""
    lines = []
    for i, (factor, label) in enumerate(factors.items()):
        trend = reading.trend(**{of: factor})
        lines.append(Line(label, trend.pressure, trend.ratio, i, i))
    return Panel(
        name,
        about,
        PRESSURE,
        "$A/A_{bare}$ [1]",
        ("pressure_Pa", "area_ratio"),
        tuple(lines),
        ylog=ylog,
        ylim=(None, None) if ylog else (0.0, 1.08),
        levels=((1.0, "no effect"),),
        note=f"Reading: {reading.title}. {note}".replace("\n", " "),
    )
