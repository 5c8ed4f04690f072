"""Study files drawn at random: every kind of load, one load and several, films, error bars."""

from __future__ import annotations

from typing import Any

import numpy as np
from random_contacts import LOADS, Pen

LAWS = ("zmc", "zmc", "gw", "ke", "jkr")
KINDS = ("pressure", "F_star", "separation")


def body(pen: Pen) -> Any:
    if pen.chance(0.6):
        return "S45C"
    E = pen.log(50e9, 300e9)
    return {"E": E, "nu": pen.flat(0.2, 0.4), "H": E * pen.log(0.01, 0.05)}


def population(pen: Pen, sigma: float) -> dict[str, Any]:
    E = pen.log(0.1e9, 300e9)
    own = {"E": E, "nu": pen.flat(0.2, 0.4), "H": E * pen.log(0.02, 0.1)}
    mean = sigma * pen.log(0.3, 20.0)
    return {
        "material": own if pen.chance(0.3) else "SiO2",
        "distribution": "truncated-gaussian",
        "mean": mean,
        "std": mean * pen.log(0.02, 0.3),
        "areal_density": pen.log(1e-4, 0.2) / mean**2,
    }


def load(pen: Pen, sigma: float) -> dict[str, Any]:
    kind, count = pen.one(KINDS), pen.one((1, 1, 1, 2, 3, 14))
    if kind == "separation":
        values = np.sort([sigma * pen.flat(0.5, 8.0) for _ in range(count)])
    else:
        unit = 1e11 if kind == "pressure" else 1.0
        values = np.sort([unit * pen.log(1e3 * LOADS[0], LOADS[1] / 10) for _ in range(count)])
    given = values.tolist()
    return {kind: given[0] if count == 1 and pen.chance(0.5) else given}


def film(pen: Pen) -> dict[str, Any]:
    low = pen.log(1e-3, 1.0)
    several = {"from": low, "to": low * pen.log(10, 1e4), "points": 9, "spacing": "log"}
    return {
        "load": pen.log(1, 100),
        "speed": low if pen.chance(0.4) else several,
        "conjunction": {"shape": "point", "R": pen.log(1e-3, 0.1)},
        "oil": {"eta": pen.log(5e-3, 0.2), "alpha": 20e-9},
    }


def draw(seed: int, index: int) -> dict[str, Any]:
    """The study of a seed and an index, as its file would be read."""
    pen = Pen(np.random.default_rng([seed, index]))
    sigma = pen.log(20e-9, 1e-6)
    law = pen.one(LAWS)
    study: dict[str, Any] = {
        "title": f"study {index}",
        "surfaces": {"first": body(pen), "second": body(pen)},
        "roughness": {"sigma": sigma, "R": sigma * pen.log(10, 300)},
        "asperity_law": {"name": law} | ({"w": pen.log(1e-3, 0.1)} if law == "jkr" else {}),
        "load": load(pen, sigma),
    }
    count = pen.one((0, 1, 1, 1, 2))
    if count:
        parts = [population(pen, sigma) for _ in range(count)]
        study["particles"] = parts if count > 1 else parts[0]
        if count == 1 and pen.chance(0.15):
            study["particle_law"] = {"name": "horng2022"}
    if pen.chance(0.25):
        study["film"] = film(pen)
    # the library knows ranges of 100Cr6; error bars of several populations take long
    if count < 2 and "particle_law" not in study and pen.chance(0.3):
        study["surfaces"]["first"] = pen.one((study["surfaces"]["first"], "100Cr6"))
        ends = {"low": 0.9 * sigma, "high": 1.1 * sigma}
        study["uncertainty"] = {"samples": 64, "inputs": {"roughness.sigma": ends}}
    return study
