"""Statements about the real area, its shares and the modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise, product

import numpy as np

from ..ledger import Measurement
from .measures import (
    ALWAYS_P_S,
    NEVER_P_S,
    critical_load_1,
    critical_load_2,
    extreme,
    inside,
    largest_over_two_body,
    measure,
    ratios,
    slope,
)
from .readings import RANGE, SILICA, STEEL, Curves


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
    return largest_over_two_body(curves, materials, sigma, x_a, lambda curve: curve.A_t)


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
