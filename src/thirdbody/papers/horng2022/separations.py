"""Statements about deformation regimes and the separation."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, product

import numpy as np

from ..ledger import Measurement
from .claims import study_data
from .measures import (
    inside,
    largest_over_two_body,
    measure,
)
from .readings import SILICA, STEEL, Curves


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
    return largest_over_two_body(curves, materials, sigma, x_a, lambda curve: curve.share("e"))


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
