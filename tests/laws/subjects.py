"""Which laws, heights and contacts the battery looks at. New laws come in by the registry."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb
from thirdbody.contact import asperity_sums as asperities
from thirdbody.laws.asperity import REGISTRY, AbstractAsperityLaw

Array = NDArray[np.float64]
R, E_STAR, NU = 2.8e-6, 1.1e11, 0.29
H = 0.02 * E_STAR
SIGMA_S = 0.01 * R
ETA = 0.05 / (R * SIGMA_S)
W = 5e-5 * E_STAR * R
"""Work of adhesion: a length of adhesion of 0.0029 R, a third of σ_s."""
CASE: dict[str, float] = {"R": R, "E_star": E_STAR, "H": H}

CIRCLES = {"gw", "ceb", "zmc", "hermite", "ke", "jg"}
ELLIPSES = {"elliptic-ceb": "ceb", "elliptic-zmc": "zmc"}
ADHESIVE = {"dmt", "jkr"}

OPTIONS: dict[str, list[dict[str, Any]]] = {
    "ceb": [{"K": 0.6}, {}],
    "ke": [{}, {"nu": 0.35}],
    "jg": [{"hardness_ratio": 0.02 / 0.007}],
    "elliptic-ceb": [
        {"K": 0.6, "ratio": 4.0},
        {"ratio": 10.0, "area_rule": "doubling"},
    ],
    "elliptic-zmc": [{"ratio": 4.0}, {"ratio": 10.0, "area_rule": "doubling"}],
    "dmt": [{"w": W}],
    "jkr": [{"w": W}, {"w": W, "unloading": True}],
    # E_1* = E*, E_1/E_2 = 5
    "coated": [
        {"E_1": 0.91 * E_STAR, "nu_1": 0.3, "t": SIGMA_S, "E_2": 0.182 * E_STAR, "nu_2": 0.25}
    ],
}


class Subject(NamedTuple):
    label: str
    law: AbstractAsperityLaw
    options: dict[str, Any]
    """As in `plain`: fields of the law, ν aside."""


def build(name: str, **options: Any) -> AbstractAsperityLaw:
    """A law of the registry; ν is filled in where the law has one."""
    kind: Any = REGISTRY[name]
    if "nu" in {item.name for item in dataclasses.fields(kind)}:
        options = {"nu": NU, **options}
    return kind(**options)


def subjects() -> list[Subject]:
    """Every law of the registry that can be built from the table or from its defaults."""
    out = []
    for name in REGISTRY:
        for options in OPTIONS.get(name, [{}]):
            try:
                law = build(name, **options)
            except (tb.errors.InvalidValue, TypeError):
                continue
            words = ",".join(
                f"{k}={v:.3g}" if isinstance(v, float) else str(v) for k, v in options.items()
            )
            show = (words and name not in ADHESIVE | {"coated"}) or options.get("unloading")
            label = f"{name}[{words if name not in ADHESIVE else 'unloading'}]" if show else name
            out.append(Subject(label, law, options))
    return out


SUBJECTS = subjects()
FIRST = {subject.law.name: subject for subject in reversed(SUBJECTS)}
"""One subject for each name: the first of the table."""

SLOW = {"weibull", "johnson-SB", "histogram"}
"""Heights whose tables take long: only some laws are asked for theirs, the others for the sum."""
TABULATED = {"gw", "ceb", "dmt"}

HEIGHTS: dict[str, tb.heights.Heights] = {
    "gaussian": tb.heights.GaussianHeights(),
    "exponential": tb.heights.ExponentialHeights(),
    "weibull": tb.heights.WeibullHeights(shape=1.8),
    "johnson-SU": tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
    "johnson-SB": tb.heights.JohnsonHeights(skewness=0.6, kurtosis=2.8),
    "histogram": tb.heights.HistogramHeights(edges=(0, 1, 2.5, 3, 5), counts=(1, 3, 4, 2)),
}


class _Untabulated:
    """Stands for a table: asks the quadrature every time."""

    def __init__(self, function: Any, breakpoints: Array, **_: Any):
        self.edges, self.function = breakpoints, function

    def __call__(self, x: Array) -> Array:
        return self.function(x)


def quadrature(
    law: AbstractAsperityLaw, heights: tb.heights.Heights, separation: float
) -> tuple[float, float]:
    """F* and A_t at d = separation·σ_s without the table, which takes seconds for some heights."""
    bare = contact(law, heights)
    with (
        mock.patch.object(asperities, "PiecewiseChebyshev", _Untabulated),
        mock.patch.object(asperities, "reduced_sum", asperities.reduced_sum.__wrapped__),
    ):
        total = asperities.asperity_sum.__wrapped__(law, bare.roughness, bare.surfaces, 0.0)
        F, *areas = total.fields(np.array([separation * bare.roughness.sigma_s]))[0]
    return float(F) / bare.E_ss, float(sum(areas))


def nu_of(law: AbstractAsperityLaw) -> float:
    return getattr(law, "nu", None) or NU


def contact(
    law: AbstractAsperityLaw,
    heights: tb.heights.Heights = HEIGHTS["gaussian"],
    *,
    hardness: float = H,
    particles: tb.Particles | None = None,
    particle_law: Any = None,
) -> tb.Contact:
    """ηRσ_s = 0.05, σ_s/R = 0.01, E* as above."""
    body = tb.Material(E=2 * E_STAR * (1 - NU**2), nu=NU, H=hardness)
    rough = tb.Roughness(
        sigma=SIGMA_S / math.sqrt(1 - 0.8968 / 5), R=R, alpha=5.0, eta=ETA, heights=heights
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=rough,
        asperity_law=law,
        particles=particles,
        particle_law=particle_law,
    )
