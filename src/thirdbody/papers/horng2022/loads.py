"""Statements about critical loads and the turning point."""

from __future__ import annotations

import math

from ..ledger import Measurement
from .measures import (
    ALWAYS_P_S,
    NEVER_P_S,
    NEVER_S_S,
    NO_PEAK,
    extreme,
    first_load,
    interior_peak_of,
    measure,
    ratios,
    second_load,
    tpca,
)
from .readings import SILICA, STEEL, Curves


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


def _in_order(rows: list[list[float]], largest: bool, why: str) -> Measurement:
    return extreme([ratio for row in rows for ratio in ratios(row)], largest, why)


@measure
def first_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    rows = [[first_load(curves, material, sigma, x) for x in x_a] for material in materials]
    return _in_order(rows, False, "a size is never p-s, or two of them always are")


@measure
def second_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    rows = [[second_load(curves, material, sigma, x) for x in x_a] for material in materials]
    return _in_order(rows, False, "two sizes are never s-s")


@measure
def first_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float
) -> Measurement:
    row = [first_load(curves, material, s, x_a) for s in sigma]
    return _in_order([row], True, "on one σ the contact is never p-s, or on two it always is")


@measure
def second_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float
) -> Measurement:
    row = [second_load(curves, material, s, x_a) for s in sigma]
    return _in_order([row], True, "on two σ the contact is never s-s")


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
    return _in_order(rows, False, NEVER_S_S)


@measure
def first_steel_over_silica(curves: Curves, sigma: float, x_a: list[float]) -> Measurement:
    rows = [[first_load(curves, material, sigma, x) for material in (SILICA, STEEL)] for x in x_a]
    return _in_order(rows, True, "a size is never p-s, or always p-s with both materials")


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
