"""The ledger: every statement of the paper, measured in every reading.

One function measures one kind of statement; the data file names it for each claim and gives its
inputs (σ and x_a in nm). Orders are measured as ratios of neighbours: an order "falls" when the
largest ratio of a value to the one before it is below 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ledger import Measurement, Verdict
from .claims import claims, study_data
from .readings import RANGE, SEARCH_TO, SILICA, STEEL, Curve, Curves

__all__ = ["critical_load_1", "critical_load_2", "interior_peak_of", "score"]

Array = NDArray[np.float64]
Measure = Callable[..., Measurement]
MEASURES: dict[str, Measure] = {}


def measure(function: Measure) -> Measure:
    """Make a function known to the data file by its name."""
    MEASURES[function.__name__] = function
    return function


def score(curves: Curves, progress: Callable[[], None] = lambda: None) -> dict[str, Verdict]:
    """The verdict on every claim in one reading, by claim id.

    Parameters
    ----------
    curves : Curves
        Of the reading.
    progress : callable, optional
        Called after each claim.

    Returns
    -------
    dict of str to Verdict

    Examples
    --------
    It takes seconds: every curve of the paper is computed::

        verdicts = score(Curves(READINGS["published"]))
        sum(verdict.passed for verdict in verdicts.values())  # 66 of 84
    """
    verdicts: dict[str, Verdict] = {}
    for claim in claims():
        if claim.measure == "all_of":
            measured = all_of(curves, verdicts, **claim.inputs)
        else:
            measured = MEASURES[claim.measure](curves, **claim.inputs)
        verdicts[claim.id] = claim.judge(measured)
        progress()
    return verdicts


# ------------------------------------------------------------------ what a curve says
def inside(curve: Curve, loads: Sequence[float] = RANGE) -> NDArray[np.bool_]:
    """Grid points between two loads, both included."""
    low, high = loads
    return (curve.F >= low * (1 - 1e-9)) & (curve.F <= high * (1 + 1e-9))


def slope(curve: Curve, values: Array, loads: Sequence[float]) -> float:
    """Least-squares slope of ln(values) over ln F*."""
    part = inside(curve, loads) & (values > 0)
    if part.sum() < 2:
        return math.nan
    return float(np.polyfit(np.log(curve.F[part]), np.log(values[part]), 1)[0])


def critical_load_1(curve: Curve) -> float:
    """F_cr1*: NaN when the particles do not hold the contact at first, inf when always."""
    threshold = study_data()["definitions"]["first_share"]
    share = curve.particle_share
    if not share[0] >= threshold:
        return math.nan
    below = np.flatnonzero(share < threshold)
    return math.inf if not len(below) else _crossing(curve.F, share, below[0] - 1, threshold)


def critical_load_2(curve: Curve) -> float:
    """F_cr2*: inf when the asperities never take over, the lowest load when they always hold."""
    threshold = 1 - study_data()["definitions"]["second_share"]
    share = curve.particle_share
    above = np.flatnonzero(~(share <= threshold))
    if not len(above):
        return float(curve.F[0])
    last = above[-1]
    return math.inf if last == len(share) - 1 else _crossing(curve.F, share, last, threshold)


def _crossing(F: Array, share: Array, i: int, threshold: float) -> float:
    """Load between grid points i and i + 1 at which the share passes the threshold."""
    part = (threshold - share[i]) / (share[i + 1] - share[i])
    return float(F[i] * (F[i + 1] / F[i]) ** part)


def interior_peak_of(curve: Curve, *, turns: bool) -> tuple[float, float] | None:
    """Load and height of the largest particle share, when it lies inside the load range.

    With ``turns`` the share must fall below a stated part of its maximum on both sides, as in
    `thirdbody.transitions`; without, any maximum counts that is not at an end.
    """
    part = inside(curve)
    F, share = curve.F[part], curve.particle_share[part]
    top = int(np.argmax(share))
    limit = study_data()["definitions"]["turn_share"] if turns else 1 - 1e-6
    if not max(share[: top + 1].min(), share[top:].min()) < limit * share[top]:
        return None
    if not 0 < top < len(F) - 1:
        return None
    # the top of the parabola through three points
    log_F = np.log(F[top - 1 : top + 2])
    a, b, _ = np.polyfit(log_F - log_F[1], share[top - 1 : top + 2], 2)
    step = float(np.clip(-b / (2 * a), log_F[0] - log_F[1], log_F[2] - log_F[1]))
    return float(F[top]) * math.exp(step), float(share[top])


def tpca(curves: Curves, material: str, sigma: float, x_a: float) -> float:
    """F_tpca*, NaN when there is none."""
    peak = interior_peak_of(curves(material, sigma, x_a), turns=False)
    return peak[0] if peak else math.nan


def ratios(values: Iterable[float]) -> list[float]:
    """Each value over the one before; NaN where either is missing or both are out of range."""
    out = []
    for before, after in pairwise(values):
        known = not (math.isnan(before) or math.isnan(after))
        out.append(after / before if known and not math.isinf(before) else math.nan)
        if known and math.isinf(before) and math.isfinite(after):
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
    return Measurement.of(value)


def first_load(curves: Curves, material: str, sigma: float, x_a: float) -> float:
    return critical_load_1(curves(material, sigma, x_a))


def second_load(curves: Curves, material: str, sigma: float, x_a: float) -> float:
    return critical_load_2(curves(material, sigma, x_a))


# ------------------------------------------------------------------ real area
@measure
def two_body_departure(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve, bare = curves(material, sigma, x_a), curves.two_body(sigma)
    part = inside(curve)
    return Measurement.of(np.max(np.abs(curve.A_t / bare.A_t - 1)[part]))


@measure
def smallest_asperity_share(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(np.min(curve.asperity_share[inside(curve)]))


@measure
def largest_area_over_two_body(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    bare = curves.two_body(sigma)
    part = inside(bare)
    return Measurement.of(
        max(
            np.max((curves(material, sigma, x).A_t / bare.A_t)[part])
            for material, x in product(materials, x_a)
        )
    )


@measure
def material_area_ratio(
    curves: Curves,
    sigma: float | list[float],
    x_a: list[float],
    loads: Sequence[float] = RANGE,
) -> Measurement:
    sigmas = sigma if isinstance(sigma, list) else [sigma]
    found = []
    for s, x in product(sigmas, x_a):
        silica, steel = curves(SILICA, s, x), curves(STEEL, s, x)
        found += list((steel.A_t / silica.A_t)[inside(silica, loads)])
    return Measurement.of(max(found, key=lambda ratio: abs(ratio - 1)))


@measure
def slope_difference(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve, bare = curves(material, sigma, x_a), curves.two_body(sigma)
    return Measurement.of(abs(slope(curve, curve.A_t, loads) - slope(bare, bare.A_t, loads)))


@measure
def area_over_two_body(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve, bare = curves(material, sigma, x_a), curves.two_body(sigma)
    ratio = (curve.A_t / bare.A_t)[inside(curve, loads)]
    return Measurement.of(ratio.min(), ratio.max())


@measure
def smallest_pressure_gain(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    low_high = area_over_two_body(curves, material, sigma, x_a, loads)
    return Measurement.of(1 / low_high.values[1])


@measure
def area_slope(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(slope(curve, curve.A_t, loads))


@measure
def particle_area_slope(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(slope(curve, curve.A_sa, loads))


@measure
def area_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    found = []
    for material, (small, large) in product(materials, pairwise(x_a)):
        curve = curves(material, sigma, large)
        found.append(np.max((curve.A_t / curves(material, sigma, small).A_t)[inside(curve)]))
    return Measurement.of(max(found))


@measure
def silica_over_steel_area(curves: Curves, sigma: float, x_a: list[float]) -> Measurement:
    found = []
    for x in x_a:
        silica, steel = curves(SILICA, sigma, x), curves(STEEL, sigma, x)
        found.append(np.max((silica.A_t / steel.A_t)[inside(silica)]))
    return Measurement.of(max(found))


@measure
def area_by_roughness(curves: Curves, material: str, sigma: list[float], x_a: float) -> Measurement:
    found = []
    for smoother, rougher in pairwise(sigma):
        curve = curves(material, rougher, x_a)
        found.append(np.max((curve.A_t / curves(material, smoother, x_a).A_t)[inside(curve)]))
    return Measurement.of(max(found))


@measure
def area_between_roughnesses(
    curves: Curves, material: str, sigma: list[float], x_a: float, load: float
) -> Measurement:
    one, other = (area_at(curves, material, s, x_a, load) for s in sigma)
    return Measurement.of(one / other)


@measure
def area_between_sizes(
    curves: Curves, material: str, sigma: float, x_a: list[float], load: float
) -> Measurement:
    one, other = (area_at(curves, material, sigma, x, load) for x in x_a)
    return Measurement.of(one / other)


@measure
def steel_area_surplus(curves: Curves, sigma: list[float], x_a: float, load: float) -> Measurement:
    found = [
        area_at(curves, STEEL, s, x_a, load) / area_at(curves, SILICA, s, x_a, load) - 1
        for s in sigma
    ]
    return Measurement.of(min(found), max(found))


def area_at(curves: Curves, material: str, sigma: float, x_a: float, load: float) -> float:
    curve = curves(material, sigma, x_a)
    return curve.at(load, curve.A_t)


def gaps(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> list[float]:
    """Area lost from the small to the large size, for each roughness."""
    small, large = x_a
    return [
        area_at(curves, material, s, small, load) - area_at(curves, material, s, large, load)
        for s in sigma
    ]


@measure
def gap_ratio(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    smooth, rough = gaps(curves, material, sigma, x_a, load)
    if rough <= 0:
        return Measurement.absent("on the rougher surface the large particles cost no area")
    return Measurement.of(smooth / rough)


@measure
def gap_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    lost = gaps(curves, material, sigma, x_a, load)
    if min(lost) <= 0:
        return Measurement.absent("on one of the surfaces the large particles cost no area")
    return extreme(ratios(lost), largest=True)


@measure
def wedge_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float, load: float
) -> Measurement:
    widths = [
        area_at(curves, material, s, 0, load) / area_at(curves, material, s, x_a, load)
        for s in sigma
    ]
    return extreme(ratios(widths), largest=True)


@measure
def largest_area_ratio(
    curves: Curves, material: str, sigma: list[float], x_a: list[float]
) -> Measurement:
    found = []
    for s in sigma:
        one, other = (curves(material, s, x) for x in x_a)
        found.append(np.max((one.A_t / other.A_t)[inside(one)]))
    return Measurement.of(max(found))


@measure
def return_to_two_body(
    curves: Curves, material: str, sigma: float, x_a: float, load: float
) -> Measurement:
    curve = curves(material, sigma, x_a)
    if np.any(np.diff(curve.A_t[inside(curve)]) <= 0):
        return Measurement.absent("the area does not grow throughout")
    bare = curves.two_body(sigma)
    return Measurement.of(abs(curve.at(load, curve.A_t) / bare.at(load, bare.A_t) - 1))


# ------------------------------------------------------------------ shares and modes
@measure
def mean_particle_share(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(np.mean(curve.particle_share[inside(curve, loads)]))


@measure
def largest_particle_share(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(np.max(curve.particle_share[inside(curve)]))


@measure
def particle_share_at(
    curves: Curves, material: str, sigma: float, x_a: float, at: list[float]
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(*(curve.at(load, curve.particle_share) for load in at))


@measure
def particle_share_step(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve = curves(material, sigma, x_a)
    start = critical_load_1(curve)
    if not math.isfinite(start):
        return Measurement.absent(NEVER_P_S if math.isnan(start) else ALWAYS_P_S)
    share = curve.particle_share[inside(curve, (start, RANGE[1]))]
    return Measurement.of(np.max(np.diff(share)))


@measure
def particle_onset(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve = curves(material, sigma, x_a)
    touching = np.flatnonzero(curve.particle_share > 1e-7)
    if not len(touching):
        return Measurement.absent("the particles never touch")
    first = touching[0]
    note = "already at the lowest load" if first == 0 else ""
    return Measurement.of(curve.F[first], note=note)


@measure
def mode_sequence(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    curve = curves(material, sigma, x_a)
    first, second = critical_load_1(curve), critical_load_2(curve)
    p_s = not math.isnan(first)
    hybrid = (first if p_s else RANGE[0]) < RANGE[1] and second > RANGE[0]
    s_s = second <= RANGE[1]
    missing = [name for name, met in (("p-s", p_s), ("hybrid", hybrid), ("s-s", s_s)) if not met]
    return Measurement.of(
        p_s + hybrid + s_s, note=f"no {' and no '.join(missing)}" if missing else ""
    )


@measure
def silica_minus_steel_asperity_share(
    curves: Curves, sigma: float, x_a: list[float], load: float
) -> Measurement:
    found = []
    for x in x_a:
        silica, steel = curves(SILICA, sigma, x), curves(STEEL, sigma, x)
        found.append(silica.at(load, silica.asperity_share) - steel.at(load, steel.asperity_share))
    return Measurement.of(max(found))


# ------------------------------------------------------------------ critical loads
@measure
def first_critical_load(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    value = first_load(curves, material, sigma, x_a)
    if not math.isfinite(value):
        return Measurement.absent(NEVER_P_S if math.isnan(value) else ALWAYS_P_S)
    return Measurement.of(value)


@measure
def second_critical_load(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    value = second_load(curves, material, sigma, x_a)
    return Measurement.of(value) if math.isfinite(value) else Measurement.absent(NEVER_S_S)


def _ordered(rows: list[list[float]], largest: bool, why: str) -> Measurement:
    return extreme([ratio for row in rows for ratio in ratios(row)], largest, why)


@measure
def first_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    rows = [[first_load(curves, material, sigma, x) for x in x_a] for material in materials]
    return _ordered(rows, False, "a size is never p-s, or two of them always are")


@measure
def second_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    rows = [[second_load(curves, material, sigma, x) for x in x_a] for material in materials]
    return _ordered(rows, False, "two sizes are never s-s")


@measure
def first_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float
) -> Measurement:
    row = [first_load(curves, material, s, x_a) for s in sigma]
    return _ordered([row], True, "on one σ the contact is never p-s, or on two it always is")


@measure
def second_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float
) -> Measurement:
    row = [second_load(curves, material, s, x_a) for s in sigma]
    return _ordered([row], True, "on two σ the contact is never s-s")


@measure
def first_material_ratio(curves: Curves, sigma: float, x_a: float) -> Measurement:
    pair = [first_load(curves, material, sigma, x_a) for material in (STEEL, SILICA)]
    return _quotient(pair, "F_cr1* is missing for a material")


@measure
def second_material_ratio(curves: Curves, sigma: float, x_a: float) -> Measurement:
    pair = [second_load(curves, material, sigma, x_a) for material in (STEEL, SILICA)]
    return _quotient(pair, NEVER_S_S)


@measure
def second_material_ratios(curves: Curves, pairs: list[list[float]]) -> Measurement:
    found = [second_material_ratio(curves, sigma, x_a) for sigma, x_a in pairs]
    if not all(one.exists for one in found):
        return Measurement.absent(NEVER_S_S)
    return Measurement.of(*(one.values[0] for one in found))


@measure
def smallest_second_material_ratio(curves: Curves, sigma: float, x_a: list[float]) -> Measurement:
    rows = [[second_load(curves, material, sigma, x) for material in (STEEL, SILICA)] for x in x_a]
    return _ordered(rows, False, NEVER_S_S)


@measure
def first_steel_over_silica(curves: Curves, sigma: float, x_a: list[float]) -> Measurement:
    rows = [[first_load(curves, material, sigma, x) for material in (SILICA, STEEL)] for x in x_a]
    return _ordered(rows, True, "a size is never p-s, or always p-s with both materials")


def _quotient(pair: list[float], why: str) -> Measurement:
    low, high = pair
    if not (math.isfinite(low) and math.isfinite(high)):
        return Measurement.absent(why)
    return Measurement.of(high / low)


# ------------------------------------------------------------------ turning point
@measure
def turning_point(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    value = tpca(curves, material, sigma, x_a)
    return Measurement.absent(NO_PEAK) if math.isnan(value) else Measurement.of(value)


@measure
def turning_point_ratio(curves: Curves, sigma: float, x_a: float) -> Measurement:
    pair = [tpca(curves, material, sigma, x_a) for material in (STEEL, SILICA)]
    return _quotient(pair, NO_PEAK)


@measure
def interior_peak(curves: Curves, material: str, sigma: float, x_a: float) -> Measurement:
    peak = interior_peak_of(curves(material, sigma, x_a), turns=True)
    if peak is None:
        return Measurement.absent(NO_PEAK)
    return Measurement.of(peak[1], note=f"at F* = {peak[0]:.2e}")


@measure
def turning_point_confined(
    curves: Curves,
    material: str,
    sigma: float,
    without: list[float],
    with_peak: list[float],
    peak: float,
) -> Measurement:
    def turns(x_a: float) -> bool:
        found = interior_peak_of(curves(material, sigma, x_a), turns=True)
        return found is not None and found[1] > peak

    wrong = [x for x in without if turns(x)] + [x for x in with_peak if not turns(x)]
    note = f"not so: {', '.join(f'{x:g} nm' for x in wrong)}" if wrong else ""
    return Measurement.of(len(without) + len(with_peak) - len(wrong), note=note)


@measure
def load_share_past_turning_point(
    curves: Curves, material: str, sigma: float, x_a: float, factor: float
) -> Measurement:
    load = tpca(curves, material, sigma, x_a)
    if math.isnan(load):
        return Measurement.absent(NO_PEAK)
    curve = curves(material, sigma, x_a)
    return Measurement.of(curve.at(factor * load, curve.load_share))


# ------------------------------------------------------------------ deformation regimes
@measure
def regime_share_step(curves: Curves, sigma: float, regime: str, extreme: str) -> Measurement:
    bare = curves.two_body(sigma)
    share = bare.share(regime)[inside(bare)]
    steps = share[1:] / share[:-1]
    return Measurement.of(steps.max() if extreme == "largest" else steps.min())


@measure
def largest_elastic_share(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    found = [curves(material, sigma, x) for material, x in product(materials, x_a)]
    return Measurement.of(max(np.max(curve.share("e")[inside(curve)]) for curve in found))


@measure
def largest_elastic_share_over_two_body(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    bare = curves.two_body(sigma)
    part = inside(bare)
    return Measurement.of(
        max(
            np.max((curves(material, sigma, x).share("e") / bare.share("e"))[part])
            for material, x in product(materials, x_a)
        )
    )


@measure
def smallest_elastoplastic_share(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    found = [curves(material, sigma, x) for material, x in product(materials, x_a)]
    return Measurement.of(min(np.min(curve.share("ep")[inside(curve)]) for curve in found))


@measure
def regime_order_breach(curves: Curves, sigma: float, x_a: float) -> Measurement:
    silica, steel = curves(SILICA, sigma, x_a), curves(STEEL, sigma, x_a)
    part = inside(silica)
    breach = [
        sign * (silica.share(regime) - steel.share(regime))[part]
        for regime, sign in (("e", 1), ("ep", 1), ("p", -1))
    ]
    return Measurement.of(max(0.0, np.max(breach)))


@measure
def regime_by_size_breach(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float], load: float
) -> Measurement:
    breach = [0.0]
    for material, (small, large) in product(materials, pairwise(x_a)):
        one, two = curves(material, sigma, small), curves(material, sigma, large)
        for regime, sign in (("e", 1), ("ep", 1), ("p", -1)):
            gained = two.at(load, two.share(regime)) - one.at(load, one.share(regime))
            breach.append(sign * gained)
    return Measurement.of(max(breach))


@measure
def plastic_share_at(
    curves: Curves, material: str, sigma: float, x_a: float, load: float
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(curve.at(load, curve.share("p")))


# ------------------------------------------------------------------ separation
@measure
def separation_steps(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    table = []
    for s in sigma:
        row = [curves(material, s, x) for x in x_a]
        table.append([curve.at(load, curve.d) for curve in row])
    d = np.array(table)
    return Measurement.of(min(np.min(d[1:] / d[:-1]), np.min(d[:, 1:] / d[:, :-1])))


@measure
def separation_material_ratio(
    curves: Curves, sigma: float, x_a: list[float], load: float
) -> Measurement:
    found = []
    for x in x_a:
        silica, steel = curves(SILICA, sigma, x), curves(STEEL, sigma, x)
        found.append(silica.at(load, silica.d) / steel.at(load, steel.d))
    return Measurement.of(min(found))


@measure
def largest_separation_ratio(curves: Curves, sigma: float, x_a: float) -> Measurement:
    silica, steel = curves(SILICA, sigma, x_a), curves(STEEL, sigma, x_a)
    return Measurement.of(np.max((silica.d / steel.d)[inside(silica)]))


@measure
def separation_step(curves: Curves, sigma: float) -> Measurement:
    bare = curves.two_body(sigma)
    d = bare.d_star[inside(bare)]
    return Measurement.of(np.max(d[1:] / d[:-1]))


@measure
def separation_over_two_body(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve, bare = curves(material, sigma, x_a), curves.two_body(sigma)
    return Measurement.of(np.max((curve.d / bare.d)[inside(curve, loads)]))


@measure
def separation_change(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    curve = curves(material, sigma, x_a)
    before, after = (curve.at(load, curve.d_star) for load in loads)
    return Measurement.of(after / before - 1)


@measure
def largest_separation_change(
    curves: Curves, material: str, sigma: float, x_a: float, loads: Sequence[float]
) -> Measurement:
    change = separation_change(curves, material, sigma, x_a, loads)
    return Measurement.of(abs(change.values[0]))


@measure
def separation_at(
    curves: Curves, material: str, sigma: float, x_a: float, load: float
) -> Measurement:
    curve = curves(material, sigma, x_a)
    return Measurement.of(curve.at(load, curve.d_star))


@measure
def area_lost_for_separation(
    curves: Curves, material: str, sigma: float, x_a: float, growth: float
) -> Measurement:
    """Over all pairs of hybrid states with d* larger by the factor: the smallest loss of area."""
    curve = curves(material, sigma, x_a)
    share = curve.particle_share
    definitions = study_data()["definitions"]
    hybrid = (
        inside(curve)
        & (share < definitions["first_share"])
        & (share > 1 - definitions["second_share"])
    )
    d, A = curve.d_star[hybrid], curve.A_t[hybrid]
    wide = d[:, None] >= growth * d
    if not wide.any():
        return Measurement.absent(f"no two hybrid states differ by {growth:g} in d*")
    return Measurement.of(np.min((1 - A[:, None] / A)[wide]))


# ------------------------------------------------------------------ several statements at once
def all_of(
    curves: Curves,
    verdicts: dict[str, Verdict],
    claims: list[str],
    measure: str | None = None,
    inputs: dict[str, Any] | None = None,
    limit: float = math.inf,
) -> Measurement:
    """How many of several claims hold, and of one more measurement at or below a limit."""
    failed = [name for name in claims if not verdicts[name].passed]
    held = len(claims) - len(failed)
    if measure is not None:
        extra = MEASURES[measure](curves, **(inputs or {}))
        good = extra.exists and extra.values[0] <= limit
        held += good
        if not good:
            failed.append(f"{measure.replace('_', ' ')} = {extra.text}")
    return Measurement.of(held, note=f"not: {', '.join(failed)}" if failed else "")
