"""How the bodies of a bearing share its load, in words and as a table."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..quantities.say import number, value_of
from ..study.whole import Study
from ..systems.machine_elements import RadialBearing

__all__ = ["DROP", "HEADS", "MEANS", "rows", "shares_load", "sharing"]

HEADS = ("place", "load", "p_0 inner", "p_0 outer", "contact inner", "contact outer")
MEANS = {
    "place": "angle from the direction of the load",
    "p_0 inner": "largest Hertz pressure on the inner ring",
    "contact inner": "whole axes, along and across the motion",
}
"""What the heads mean."""
DROP = ("contact outer", "contact inner")
"""Columns in the order in which they go where the width is small."""


def shares_load(study: Study) -> bool:
    """Whether the body of a study is a bearing whose bodies share one radial load."""
    is_radial = isinstance(study.body, RadialBearing)
    return is_radial and study.forces is not None and len(study.forces) == 1


EVEN = 1e-9
"""Difference of the sum over the bodies from the load, where they balance it at their places."""


def sharing(study: Study) -> str:
    """How many carry, and how much the most loaded one, in a sentence."""
    body: Any = study.body
    force = float(study.forces[0])  # type: ignore[index]
    radial_share = body.share_load(force, study.contact.E_ss)
    even = body.replace(clearance=0.0).share_load(force, study.contact.E_ss)
    name = body.rolling_bodies
    parts = [number(share.largest * body.bodies / force, 3) for share in (radial_share, even)]
    by = "Sjövall's integral"
    last = (
        f"the sum over the {name} is {number(radial_share.balance, 4)} of the load, and not 1, "
        "because the integral spreads them evenly around."
    )
    if abs(radial_share.balance - 1) < EVEN:
        by, last = "balance", f"too few {name} carry for Sjövall's integral."
    return (
        f"Of {number(body.bodies)} {name} {radial_share.carrying} "
        f"{'carries' if radial_share.carrying == 1 else 'carry'}, the most loaded "
        f"{value_of(radial_share.largest, 'N')}, {parts[0]} F_r/Z "
        f"({by} with {value_of(body.clearance, 'm')} clearance, epsilon = "
        f"{number(radial_share.eps, 3)}; without clearance {parts[1]} "
        f"F_r/Z, Stribeck); {last}"
    )


def rows(study: Study) -> list[list[str]]:
    """A row for each place at which a body carries, both sides of the load together."""
    body: Any = study.body
    E_star = study.contact.E_ss
    radial_share = body.share_load(float(study.forces[0]), E_star)  # type: ignore[index]
    out = []
    for angle, load in zip(radial_share.angles, radial_share.loads, strict=True):
        if angle < -1e-9 or load <= 0:
            continue
        both = "± " if 1e-9 < angle < math.pi - 1e-9 else ""
        sides = [body.on_ring(ring) for ring in ("inner", "outer")]
        pressures = [
            value_of(float(conjunction.hertz(load, E=2 * E_star).maximum), "Pa", 3)
            for conjunction in sides
        ]
        axes = [
            " × ".join(_lengths(conjunction.semi_axes(load, E=2 * E_star))) for conjunction in sides
        ]
        out.append(
            [f"{both}{round(np.degrees(angle))} deg", value_of(load, "N"), *pressures, *axes]
        )
    return out


def _lengths(axes: tuple[float, float]) -> list[str]:
    return [value_of(2 * float(semi_axis), "m", 3) for semi_axis in axes]
