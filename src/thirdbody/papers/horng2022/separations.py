"""Statements about deformation regimes and the separation."""

from __future__ import annotations

from functools import partial
from itertools import pairwise, product

import numpy as np

from ..ledger import Measurement, data_of
from .claims import PAPER
from .measures import (
    add_measures,
    curve_measure,
    extreme_over_materials,
    is_inside,
    material_measure,
    measure,
    two_body_measure,
)
from .readings import Curve, Curves

GAINED = {"e": 1, "ep": 1, "p": -1}
"""Sign of a change that breaks the order: from steel to silica, and from small to large particles,
elastic and elastoplastic shares fall and the plastic one rises."""


# ------------------------------------------------------------------ deformation regimes
@measure
def regime_share_step(curves: Curves, sigma: float, regime: str, extreme: str) -> Measurement:
    bare = curves.two_body(sigma)
    share = bare.share(regime)[is_inside(bare)]
    steps = share[1:] / share[:-1]
    return Measurement.from_values(steps.max() if extreme == "largest" else steps.min())


add_measures(curve_measure, plastic_share_at=lambda c, load: c.value_at(load, c.share("p")))
add_measures(
    partial(extreme_over_materials, max),
    largest_elastic_share=lambda c, bare: np.max(c.share("e")[is_inside(c)]),
    largest_elastic_share_over_two_body=lambda c, bare: max(
        (c.share("e") / bare.share("e"))[is_inside(bare)]
    ),
)
add_measures(
    partial(extreme_over_materials, min),
    smallest_elastoplastic_share=lambda c, bare: np.min(c.share("ep")[is_inside(c)]),
)
add_measures(
    partial(material_measure, max),
    regime_order_breach=lambda silica, steel: max(
        0.0,
        *(
            np.max(sign * (silica.share(regime) - steel.share(regime))[is_inside(silica)])
            for regime, sign in GAINED.items()
        ),
    ),
)


@measure
def regime_by_size_breach(
    curves: Curves, materials: list[str], sigma: float, x_a: list[float], load: float
) -> Measurement:
    breach = [0.0]
    for material, (small, large) in product(materials, pairwise(x_a)):
        one, two = curves(material, sigma, small), curves(material, sigma, large)
        for regime, sign in GAINED.items():
            gained = two.value_at(load, two.share(regime)) - one.value_at(load, one.share(regime))
            breach.append(sign * gained)
    return Measurement.from_values(max(breach))


# ------------------------------------------------------------------ separation
def _change(c: Curve, loads: list[float]) -> float:
    """Relative change of d* between two loads."""
    before, after = (c.value_at(load, c.d_star) for load in loads)
    return after / before - 1


def _area_lost(c: Curve, growth: float) -> float | Measurement:
    """Over all pairs of hybrid states with d* larger by the factor: the smallest loss of area."""
    share, definitions = c.particle_share, data_of(PAPER)["definitions"]
    above, below = definitions["first_share"], 1 - definitions["second_share"]
    hybrid = is_inside(c) & (share < above) & (share > below)
    d, A = c.d_star[hybrid], c.A_t[hybrid]
    wide = d[:, None] >= growth * d
    if not wide.any():
        return Measurement.absent(f"no two hybrid states differ by {growth:g} in d*")
    return np.min((1 - A[:, None] / A)[wide])


add_measures(
    curve_measure,
    separation_at=lambda c, load: c.value_at(load, c.d_star),
    separation_change=_change,
    largest_separation_change=lambda c, loads: abs(_change(c, loads)),
    area_lost_for_separation=_area_lost,
)
add_measures(
    two_body_measure,
    separation_over_two_body=lambda c, bare, loads: np.max((c.d / bare.d)[is_inside(c, loads)]),
)
add_measures(
    partial(material_measure, min),
    separation_material_ratio=lambda silica, steel, load: (
        silica.value_at(load, silica.d) / steel.value_at(load, steel.d)
    ),
)
add_measures(
    partial(material_measure, max),
    largest_separation_ratio=lambda silica, steel: np.max((silica.d / steel.d)[is_inside(silica)]),
)


@measure
def separation_steps(
    curves: Curves, material: str, sigma: list[float], x_a: list[float], load: float
) -> Measurement:
    rows = [[curves(material, s, x) for x in x_a] for s in sigma]
    d = np.array([[curve.value_at(load, curve.d) for curve in row] for row in rows])
    return Measurement.from_values(min(np.min(d[1:] / d[:-1]), np.min(d[:, 1:] / d[:, :-1])))


@measure
def separation_step(curves: Curves, sigma: float) -> Measurement:
    bare = curves.two_body(sigma)
    d = bare.d_star[is_inside(bare)]
    return Measurement.from_values(np.max(d[1:] / d[:-1]))
