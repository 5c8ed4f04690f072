"""Statements about critical loads and the turning point."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..ledger import Measurement
from .measures import (
    ALWAYS_P_S,
    MEASURES,
    NEVER_P_S,
    NEVER_S_S,
    NO_PEAK,
    add_measures,
    critical_load_1,
    critical_load_2,
    curve_measure,
    extreme,
    interior_peak_of,
    measure,
    ratios,
    turning_load,
)
from .readings import SILICA, STEEL, Curve, Curves

if TYPE_CHECKING:
    from collections.abc import Sequence

Load = Callable[[Curve], float]


# ------------------------------------------------------------------ one contact
def _measured_load(value: float, why: str) -> Measurement:
    return Measurement.from_values(value) if math.isfinite(value) else Measurement.absent(why)


def _first(c: Curve) -> Measurement:
    value = critical_load_1(c)
    return _measured_load(value, NEVER_P_S if math.isnan(value) else ALWAYS_P_S)


def _peak(c: Curve) -> Measurement:
    """Height of the largest particle share, and where."""
    peak = interior_peak_of(c, turns=True)
    if peak is None:
        return Measurement.absent(NO_PEAK)
    return Measurement.from_values(peak[1], note=f"at F* = {peak[0]:.2e}")


def _share_past_turning_point(c: Curve, factor: float) -> float | Measurement:
    load = turning_load(c)
    if math.isnan(load):
        return Measurement.absent(NO_PEAK)
    return c.value_at(factor * load, c.load_share)


add_measures(
    curve_measure,
    first_critical_load=_first,
    second_critical_load=lambda c: _measured_load(critical_load_2(c), NEVER_S_S),
    turning_point=lambda c: _measured_load(turning_load(c), NO_PEAK),
    interior_peak=_peak,
    load_share_past_turning_point=_share_past_turning_point,
)


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
        load_and_height = interior_peak_of(curves(material, sigma, x_a), turns=True)
        return load_and_height is not None and load_and_height[1] > peak

    wrong = [x for x in without if turns(x)] + [x for x in with_peak if not turns(x)]
    note = f"not so: {', '.join(f'{x:g} nm' for x in wrong)}" if wrong else ""
    return Measurement.from_values(len(without) + len(with_peak) - len(wrong), note=note)


# ------------------------------------------------------------------ orders
def _in_order(name: str, load: Load, *, largest: bool, why: str) -> None:
    """Make the order of a load known: over sizes, over roughnesses, or over two materials.

    What the order is over, the inputs of a claim say: a list of sizes with ``materials``, a list
    of roughnesses, or a list of sizes alone, for each of which silica stands before steel where
    the ``largest`` ratio counts, and after it where the smallest does.
    """
    pair = (SILICA, STEEL) if largest else (STEEL, SILICA)

    def extreme_ratio(
        curves: Curves,
        sigma: Any,
        x_a: Any,
        materials: Sequence[str] | None = None,
        material: str | None = None,
    ) -> Measurement:
        if material is not None:
            rows = [[curves(material, s, x_a) for s in sigma]]
        elif materials is not None:
            rows = [[curves(m, sigma, x) for x in x_a] for m in materials]
        else:
            rows = [[curves(m, sigma, x) for m in pair] for x in x_a]
        return extreme([r for row in rows for r in ratios(map(load, row))], largest, why)

    MEASURES[name] = extreme_ratio


for _name, _load, _largest, _why in (
    ("first_by_size", critical_load_1, False, "a size is never p-s, or two of them always are"),
    ("second_by_size", critical_load_2, False, "two sizes are never s-s"),
    ("first_by_roughness", critical_load_1, True,
     "on one σ the contact is never p-s, or on two it always is"),
    ("second_by_roughness", critical_load_2, True, "on two σ the contact is never s-s"),
    ("smallest_second_material_ratio", critical_load_2, False, NEVER_S_S),
    ("first_steel_over_silica", critical_load_1, True,
     "a size is never p-s, or always p-s with both materials"),
):  # fmt: skip
    _in_order(_name, _load, largest=_largest, why=_why)


def _silica_over_steel(
    load: Load, why: str, curves: Curves, *pairs: tuple[float, float]
) -> Measurement:
    """Loads of silica over those of steel, for each pair of σ and x_a."""
    load_pairs = [[load(curves(m, *pair)) for m in (SILICA, STEEL)] for pair in pairs]
    if not all(math.isfinite(value) for pair in load_pairs for value in pair):
        return Measurement.absent(why)
    return Measurement.from_values(*(silica / steel for silica, steel in load_pairs))


MEASURES |= {
    "first_material_ratio": lambda curves, sigma, x_a: _silica_over_steel(
        critical_load_1, "F_cr1* is missing for a material", curves, (sigma, x_a)
    ),
    "second_material_ratio": lambda curves, sigma, x_a: _silica_over_steel(
        critical_load_2, NEVER_S_S, curves, (sigma, x_a)
    ),
    "second_material_ratios": lambda curves, pairs: _silica_over_steel(
        critical_load_2, NEVER_S_S, curves, *pairs
    ),
    "turning_point_ratio": lambda curves, sigma, x_a: _silica_over_steel(
        turning_load, NO_PEAK, curves, (sigma, x_a)
    ),
}
