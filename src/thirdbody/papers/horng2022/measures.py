"""What a curve says, and the measures by the names that the data file calls them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ledger import Measurement, data_of
from .claims import PAPER
from .readings import RANGE, SEARCH_TO, SILICA, STEEL, Curve, Curves

__all__ = [
    "ALWAYS_P_S",
    "MEASURES",
    "NEVER_P_S",
    "NEVER_S_S",
    "NO_PEAK",
    "add_measures",
    "critical_load_1",
    "critical_load_2",
    "curve_measure",
    "ends",
    "extreme",
    "extreme_over_materials",
    "interior_peak_of",
    "is_inside",
    "material_measure",
    "measure",
    "ratios",
    "slope",
    "turning_load",
    "two_body_measure",
]

Array = NDArray[np.float64]
Measure = Callable[..., Measurement]
Reduce = Callable[[list[Any]], Any]
Value = Callable[..., Any]
Numbers = float | list[float]
MEASURES: dict[str, Measure] = {}


def measure(function: Measure) -> Measure:
    """Make a function known to the data file by its name."""
    MEASURES[function.__name__] = function
    return function


def is_inside(curve: Curve, loads: Sequence[float] = RANGE) -> NDArray[np.bool_]:
    """Grid points between two loads, both included."""
    low, high = loads
    return (curve.F >= low * (1 - 1e-9)) & (curve.F <= high * (1 + 1e-9))


def slope(curve: Curve, values: Array, loads: Sequence[float]) -> float:
    """Least-squares slope of ln(values) over ln F*."""
    inside = is_inside(curve, loads) & (values > 0)
    if inside.sum() < 2:
        return math.nan
    return float(np.polyfit(np.log(curve.F[inside]), np.log(values[inside]), 1)[0])


def critical_load_1(curve: Curve) -> float:
    """F_cr1*: NaN when the particles do not hold the contact at first, inf when always."""
    threshold = data_of(PAPER)["definitions"]["first_share"]
    share = curve.particle_share
    if not share[0] >= threshold:
        return math.nan
    below = np.flatnonzero(share < threshold)
    return math.inf if not len(below) else _crossing(curve.F, share, below[0] - 1, threshold)


def critical_load_2(curve: Curve) -> float:
    """F_cr2*: inf when the asperities never take over, the lowest load when they always hold."""
    threshold = 1 - data_of(PAPER)["definitions"]["second_share"]
    share = curve.particle_share
    above = np.flatnonzero(~(share <= threshold))
    if not len(above):
        return float(curve.F[0])
    last = above[-1]
    return math.inf if last == len(share) - 1 else _crossing(curve.F, share, last, threshold)


def _crossing(F: Array, share: Array, i: int, threshold: float) -> float:
    """Load between grid points i and i + 1 at which the share passes the threshold."""
    fraction = (threshold - share[i]) / (share[i + 1] - share[i])
    return float(F[i] * (F[i + 1] / F[i]) ** fraction)


def interior_peak_of(curve: Curve, *, turns: bool) -> tuple[float, float] | None:
    """Load and height of the largest particle share, when it lies inside the load range.

    With ``turns`` the share must fall below a stated part of its maximum on both sides, as in
    `thirdbody.transitions`; without, any maximum counts that is not at an end.
    """
    inside = is_inside(curve)
    F, share = curve.F[inside], curve.particle_share[inside]
    top = int(np.argmax(share))
    limit = data_of(PAPER)["definitions"]["turn_share"] if turns else 1 - 1e-6
    if not max(share[: top + 1].min(), share[top:].min()) < limit * share[top]:
        return None
    if not 0 < top < len(F) - 1:
        return None
    # the top of the parabola through three points
    log_F = np.log(F[top - 1 : top + 2])
    a, b, _ = np.polyfit(log_F - log_F[1], share[top - 1 : top + 2], 2)
    step = float(np.clip(-b / (2 * a), log_F[0] - log_F[1], log_F[2] - log_F[1]))
    return float(F[top]) * math.exp(step), float(share[top])


def turning_load(curve: Curve) -> float:
    """F_tpca*, NaN when there is none."""
    peak = interior_peak_of(curve, turns=False)
    return peak[0] if peak else math.nan


def ratios(values: Iterable[float]) -> list[float]:
    """Each value over the one before; NaN where either is missing or both are out of range."""
    out = []
    for before, after in pairwise(values):
        both = not (math.isnan(before) or math.isnan(after))
        out.append(after / before if both and not math.isinf(before) else math.nan)
        if both and math.isinf(before) and math.isfinite(after):
            out[-1] = 0.0
    return out


NEVER_P_S = "never p-s: the asperities touch at the lowest load already"
ALWAYS_P_S = f"p-s up to {SEARCH_TO:g}"
NEVER_S_S = f"never s-s up to {SEARCH_TO:g}"
NO_PEAK = "the particle share has no maximum inside the load range"


def extreme(values: Sequence[float], largest: bool, what: str = "") -> Measurement:
    """The largest or smallest of several ratios, absent when one of them is."""
    if any(math.isnan(value) for value in values):
        return Measurement.absent(what or "one of the values does not exist")
    value = max(values) if largest else min(values)
    if math.isinf(value):
        return Measurement((1e9,), "one of the loads lies beyond the range")
    return Measurement.from_values(value)


# -------------------------------------------------------------------------- rows of measures
def ends(values: ArrayLike) -> tuple[float, float]:
    """The smallest and the largest value."""
    return float(np.min(values)), float(np.max(values))


def _measurement(numbers: Any) -> Measurement:
    """Measurement of these numbers; one that is known to be absent stays so."""
    return (
        numbers if isinstance(numbers, Measurement) else Measurement.from_values(*np.ravel(numbers))
    )


def add_measures(family: Callable[..., Measurement], **values: Value) -> None:
    """Make a family of measures known by their names: what it does with each of these functions."""
    MEASURES.update({name: partial(family, value) for name, value in values.items()})


def curve_measure(
    value: Value, curves: Curves, material: str, sigma: float, x_a: float, **more: object
) -> Measurement:
    """A function of one curve."""
    return _measurement(value(curves(material, sigma, x_a), **more))


def two_body_measure(
    value: Value, curves: Curves, material: str, sigma: float, x_a: float, **more: object
) -> Measurement:
    """A function of one curve, and of that of the surface without particles."""
    return _measurement(value(curves(material, sigma, x_a), curves.two_body(sigma), **more))


def extreme_over_materials(
    extreme: Reduce,
    value: Value,
    curves: Curves,
    materials: list[str],
    sigma: float,
    x_a: list[float],
) -> Measurement:
    """The ``extreme`` over materials and sizes of such a function."""
    every = (curves(material, sigma, x) for material, x in product(materials, x_a))
    return _measurement(extreme([value(curve, curves.two_body(sigma)) for curve in every]))


def material_measure(
    extreme: Reduce, value: Value, curves: Curves, sigma: Numbers, x_a: Numbers, **more: object
) -> Measurement:
    """The ``extreme`` over roughnesses and sizes of a function of the curves of both materials."""
    pairs = product(np.ravel(sigma).tolist(), np.ravel(x_a).tolist())
    every = [value(curves(SILICA, *pair), curves(STEEL, *pair), **more) for pair in pairs]
    return _measurement(extreme(every))
