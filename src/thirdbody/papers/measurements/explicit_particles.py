"""Particles at their places on rough surfaces, by boundary elements."""

from __future__ import annotations

from functools import cache

import numpy as np

import thirdbody as tb

from ..panels import Line, Panel
from ..seats import contact, explicit_particles
from .row import COMPUTED, Band, row_of, statement

__all__ = ["ROW"]

LEVEL = 1e-5


@cache
def _runs() -> dict[float, dict[float, tuple[float, float]]]:
    """Share and its error by diameter and F*, the luck of sampling removed where it can be."""
    out: dict[float, dict[float, tuple[float, float]]] = {}
    for point in explicit_particles()["points"]:
        stored = point["control_variate"] or point["raw"]
        out.setdefault(point["diameter"], {})[point["F_star"]] = (
            stored["load_share"],
            stored["load_share_error"],
        )
    return out


def _share(diameter: float) -> Band:
    share = float(tb.solve(contact(diameter), F_star=LEVEL).particle_load_share)
    return Band(share, share, share)


def _panel() -> Panel:
    loads = np.geomspace(5e-7, 6e-4, 60)
    lines = []
    for i, (diameter, runs) in enumerate(sorted(_runs().items(), reverse=True)):
        share = np.asarray(tb.solve(contact(diameter), F_star=loads).particle_load_share)
        words = f"$x/σ$ = {diameter / 300e-9:.2g}"
        lines.append(Line(f"{words}, model", loads, share, colour=i))
        run_loads = np.array(sorted(runs))
        lines.append(
            Line(
                f"{words}, explicit",
                run_loads,
                np.array([runs[load][0] for load in run_loads]),
                i,
                1,
            )
        )
    return Panel(
        "explicit",
        "share of the load on particles, against particles at their places",
        "load $F^*$",
        "share of the load on particles",
        ("F_star", "load_share"),
        tuple(lines),
        ylog=True,
        note="Explicit: boundary elements with the pressure capped at the hardness, four loads.",
    )


ROW = row_of(
    "explicit_particles",
    {},
    panels=(_panel,),
    statements=tuple(
        statement(
            f"share-{diameter * 1e9:g}",
            f"At x/σ = {diameter / 300e-9:.2g} and F* = 1e-5 particles carry "
            f"{100 * runs[LEVEL][0]:.3g} ± {100 * runs[LEVEL][1]:.2g} % of the load",
            COMPUTED,
            "particles' share of the load",
            {"kind": "absolute", "value": runs[LEVEL][0], "of": 2 * runs[LEVEL][1]},
            lambda diameter=diameter: _share(diameter),  # type: ignore[misc]
            remark="Within two errors",
        )
        for diameter, runs in sorted(_runs().items(), reverse=True)
    ),
)
