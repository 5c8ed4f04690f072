"""Statements about the real area, its shares and the modes."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise, product

import numpy as np

from ..ledger import Measurement
from .measures import (
    ALWAYS_P_S,
    NEVER_P_S,
    add_measures,
    critical_load_1,
    critical_load_2,
    curve_measure,
    ends,
    extreme,
    extreme_over_materials,
    is_inside,
    material_measure,
    measure,
    ratios,
    slope,
    two_body_measure,
)
from .readings import RANGE, Curve, Curves


# ------------------------------------------------------------------ real area
def _distance_from_bare(c: Curve, bare: Curve, load: float) -> float | Measurement:
    """Difference of the area to that without particles, where it grows throughout."""
    if np.any(np.diff(c.A_t[is_inside(c)]) <= 0):
        return Measurement.absent("the area does not grow throughout")
    return abs(c.value_at(load, c.A_t) / bare.value_at(load, bare.A_t) - 1)


add_measures(
    curve_measure,
    area_slope=lambda c, loads: slope(c, c.A_t, loads),
    particle_area_slope=lambda c, loads: slope(c, c.A_sa, loads),
)
add_measures(
    two_body_measure,
    two_body_departure=lambda c, bare: np.max(np.abs(c.A_t / bare.A_t - 1)[is_inside(c)]),
    slope_difference=lambda c, bare, loads: abs(
        slope(c, c.A_t, loads) - slope(bare, bare.A_t, loads)
    ),
    area_over_two_body=lambda c, bare, loads: ends((c.A_t / bare.A_t)[is_inside(c, loads)]),
    smallest_pressure_gain=lambda c, bare, loads: (
        1 / np.max((c.A_t / bare.A_t)[is_inside(c, loads)])
    ),
    return_to_two_body=_distance_from_bare,
)
add_measures(
    partial(extreme_over_materials, max),
    largest_area_over_two_body=lambda c, bare: np.max((c.A_t / bare.A_t)[is_inside(bare)]),
)
add_measures(
    partial(
        material_measure,
        lambda ratios: max(np.concatenate(ratios), key=lambda ratio: abs(ratio - 1)),
    ),
    material_area_ratio=lambda silica, steel, loads=RANGE: (steel.A_t / silica.A_t)[
        is_inside(silica, loads)
    ],
)
add_measures(
    partial(material_measure, max),
    silica_over_steel_area=lambda silica, steel: np.max(
        (silica.A_t / steel.A_t)[is_inside(silica)]
    ),
    silica_minus_steel_asperity_share=lambda silica, steel, load: (
        silica.value_at(load, silica.asperity_share) - steel.value_at(load, steel.asperity_share)
    ),
)
add_measures(
    partial(material_measure, ends),
    steel_area_surplus=lambda silica, steel, load: (
        steel.value_at(load, steel.A_t) / silica.value_at(load, silica.A_t) - 1
    ),
)


def _growth(one: Curve, other: Curve) -> float:
    """The largest area of a curve over that of another at the same load."""
    return np.max((one.A_t / other.A_t)[is_inside(one)])


@measure
def area_by_size(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float]
) -> Measurement:
    pairs = product(materials, pairwise(x_a))
    every = [[curves(m, sigma, x) for x in pair] for m, pair in pairs]
    return Measurement.from_values(max(_growth(large, small) for small, large in every))


@measure
def area_by_roughness(curves: Curves, material: str, sigma: list[float], x_a: float) -> Measurement:
    row = [curves(material, s, x_a) for s in sigma]
    return Measurement.from_values(
        max(_growth(rougher, smoother) for smoother, rougher in pairwise(row))
    )


@measure
def largest_area_ratio(
    curves: Curves, material: str, sigma: list[float], x_a: list[float]
) -> Measurement:
    rows = [[curves(material, s, x) for x in x_a] for s in sigma]
    return Measurement.from_values(max(_growth(one, other) for one, other in rows))


def _areas(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> list[float]:
    """Areas at a load of every roughness and, one after the other, every size."""
    pair_curves = [curves(material, s, x) for s, x in product(sigma, x_a)]
    return [curve.value_at(load, curve.A_t) for curve in pair_curves]


@measure
def area_between_roughnesses(
    curves: Curves, material: str, sigma: list[float], x_a: float, load: float
) -> Measurement:
    one, other = _areas(curves, material, sigma, [x_a], load)
    return Measurement.from_values(one / other)


@measure
def area_between_sizes(
    curves: Curves, material: str, sigma: float, x_a: list[float], load: float
) -> Measurement:
    one, other = _areas(curves, material, [sigma], x_a, load)
    return Measurement.from_values(one / other)


def _gaps(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> list[float]:
    """Area lost from the small to the large size, for each roughness."""
    areas = _areas(curves, material, sigma, x_a, load)
    return [small - large for small, large in zip(areas[::2], areas[1::2], strict=True)]


@measure
def gap_ratio(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    smooth, rough = _gaps(curves, material, sigma, x_a, load)
    if rough <= 0:
        return Measurement.absent("on the rougher surface the large particles cost no area")
    return Measurement.from_values(smooth / rough)


@measure
def gap_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    lost = _gaps(curves, material, sigma, x_a, load)
    if min(lost) <= 0:
        return Measurement.absent("on one of the surfaces the large particles cost no area")
    return extreme(ratios(lost), largest=True)


@measure
def wedge_by_roughness(
    curves: Curves, material: str, sigma: list[float], x_a: float, load: float
) -> Measurement:
    areas = _areas(curves, material, sigma, [0, x_a], load)
    widths = [bare / dusty for bare, dusty in zip(areas[::2], areas[1::2], strict=True)]
    return extreme(ratios(widths), largest=True)


# ------------------------------------------------------------------ shares and modes
def _largest_step(c: Curve) -> float | Measurement:
    """The largest step of the particle share beyond the first critical load."""
    start = critical_load_1(c)
    if not math.isfinite(start):
        return Measurement.absent(NEVER_P_S if math.isnan(start) else ALWAYS_P_S)
    return np.max(np.diff(c.particle_share[is_inside(c, (start, RANGE[1]))]))


def _onset(c: Curve) -> Measurement:
    """The load at which particles begin to touch."""
    touching = np.flatnonzero(c.particle_share > 1e-7)
    if not len(touching):
        return Measurement.absent("the particles never touch")
    note = "already at the lowest load" if touching[0] == 0 else ""
    return Measurement.from_values(c.F[touching[0]], note=note)


def _modes(c: Curve) -> Measurement:
    """How many of the three modes there are."""
    first, second = critical_load_1(c), critical_load_2(c)
    p_s = not math.isnan(first)
    hybrid = (first if p_s else RANGE[0]) < RANGE[1] and second > RANGE[0]
    s_s = second <= RANGE[1]
    missing = [name for name, met in (("p-s", p_s), ("hybrid", hybrid), ("s-s", s_s)) if not met]
    note = f"no {' and no '.join(missing)}" if missing else ""
    return Measurement.from_values(p_s + hybrid + s_s, note=note)


add_measures(
    curve_measure,
    smallest_asperity_share=lambda c: np.min(c.asperity_share[is_inside(c)]),
    largest_particle_share=lambda c: np.max(c.particle_share[is_inside(c)]),
    mean_particle_share=lambda c, loads: np.mean(c.particle_share[is_inside(c, loads)]),
    particle_share_at=lambda c, at: tuple(c.value_at(load, c.particle_share) for load in at),
    particle_share_step=_largest_step,
    particle_onset=_onset,
    mode_sequence=_modes,
)
