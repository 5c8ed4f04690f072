"""A side of a round particle at any squeeze and any hardness ratio, from a computed table."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval

from ...numerics.chebyshev import chebyshev_transform
from .one_particle import Side
from .squashed import FULL, GRADING

if TYPE_CHECKING:
    from ..base import AbstractAsperityLaw
    from .one_particle import Array

__all__ = ["DeepSide", "DeepSqueeze", "SqueezeCurve", "squeeze_curve"]

LAW_ENDS, TABLE_BEGINS = 0.05, 0.15
"""Squeezes ε up to which the law of one contact holds, and from which the table does."""
TABLE_ENDS = 0.93
"""Largest squeeze ε of the table."""
SPLITS = (0.45, 0.75)
"""Squeezes at which panels end, so that series of the table resolve it."""
TERMS = 14
"""Of its series."""
COLUMNS = ("own", "all", "area", "share")
RIGID = 10.0
"""Hardness ratio from which a particle counts as rigid."""
SOFTEST_KAPPA = 8.0
"""E*/H below which the elastic part of the table is not extrapolated further."""


class SqueezeCurve(NamedTuple):
    """What one side of a particle does: Chebyshev series on the table's range of ln ε/(1 − ε)."""

    log_load: Array
    """ln F/(πR²H), with the hardness H of the softer body [1]: (TERMS,)."""
    log_area: Array
    """ln A/(πR²) [1]: (TERMS,)."""
    share: Array
    """Sink of the particle into the surface over its squeeze [1]: (TERMS,)."""


class _Run(NamedTuple):
    """One computed curve, at the nodes of the series."""

    kind: str
    """``two-sided``, ``one-sided``, or ``platens``, the limit of a soft particle."""
    ratio: float
    """Hardness of the particle over that of the surface; `RIGID` for a rigid one."""
    friction: float
    """Friction factor of its faces [1]."""
    softness: float
    """H/E* [1]; 0 for rigid-plastic bodies."""
    own: Array
    """ln F/(Y_s R²), of platens ln F/(Y_p R²), without what touching collars carry."""
    all: Array
    """The same with it."""
    area: Array
    """ln A/(πR²)."""
    share: Array
    """Sink into each surface over the squeeze."""


@lru_cache(maxsize=1)
def _runs() -> tuple[_Run, ...]:
    """The computed curves of the table."""
    text = resources.files("thirdbody").joinpath("data/deep_squeeze.json").read_text("utf-8")
    nodes, _ = chebyshev_transform(TERMS)
    eps = squeeze_at(nodes)

    def run(data: dict[str, Any]) -> _Run:
        low, high = data["eps"][0], data["eps"][-1]
        place = place_of(np.clip(eps, low, high), low, high)
        columns = {name: chebval(place, data["series"].get(name, [0.0])) for name in COLUMNS}
        return _Run(
            data["kind"],
            RIGID if data["rho"] is None else data["rho"],
            data["m"],
            0.0 if data["kappa"] is None else 1 / data["kappa"],
            *(columns[name] for name in COLUMNS),
        )

    return tuple(run(data) for data in json.loads(text)["curves"])


def place_of(eps: Any, low: float, high: float) -> Any:
    """Place on [−1, 1] of squeezes between two, in ln ε/(1 − ε)."""
    first, last = (math.log(end / (1 - end)) for end in (low, high))
    return (2 * np.log(eps / (1 - eps)) - first - last) / (last - first)


def squeeze_at(place: Any) -> Any:
    """Squeeze ε at a place on [−1, 1] of the table."""
    first, last = (math.log(end / (1 - end)) for end in (LAW_ENDS, TABLE_ENDS))
    return 1 / (1 + np.exp(-(first + last + place * (last - first)) / 2))


class _Family(NamedTuple):
    """Runs of one friction, rigid-plastic, against the hardness ratio: (N,) and (N, TERMS)."""

    ratio: Array
    log_load: Array
    log_area: Array
    share: Array


@lru_cache(maxsize=64)
def _family(friction: float, collar: str) -> _Family:
    """Loads are over the yield strength of the softer body; platens stand at the least ratio."""
    rigid = [run for run in _runs() if run.softness == 0 and run.friction == friction]
    platens = any(run.kind == "platens" for run in rigid)
    least = min(run.ratio for run in _runs() if run.kind == "two-sided")
    rows = []
    for run in rigid:
        # at the least ratio the faces of coupled runs read high where the disc is thin
        if run.kind == "one-sided" or (platens and run.kind == "two-sided" and run.ratio == least):
            continue
        ratio = least if run.kind == "platens" else run.ratio
        log_load = run.all if collar == "all" else run.own
        if run.kind == "two-sided":
            log_load = log_load - math.log(min(ratio, 1.0))
        rows.append((ratio, log_load, run.area, run.share))
    rows.sort(key=lambda row: row[0])
    return _Family(*(np.array(column) for column in zip(*rows, strict=True)))


def _between(x: float, nodes: Array, values: Array) -> Array:
    """Values (N, K) at an x between the nodes (N,): monotone between them, constant outside."""
    from scipy.interpolate import PchipInterpolator

    if len(nodes) == 1:
        return values[0]
    out: Array = PchipInterpolator(nodes, values, axis=0)(min(max(x, nodes[0]), nodes[-1]))
    return out


@lru_cache(maxsize=512)
def squeeze_curve(ratio: float, friction: float, kappa: float, collar: str) -> SqueezeCurve:
    r"""What one side of a round particle does, between the computed runs.

    Logarithms of load and area are interpolated in ln ρ; what friction and elasticity change is
    the ratio of two runs of one ρ, monotone in m and, to first order, linear in 1/κ.

    Parameters
    ----------
    ratio : float
        Hardness of the particle over that of the surface, ρ [1].
    friction : float
        Shear stress on the faces of the particle over the shear strength, m [1], 0 to 1.
    kappa : float
        E*/H of the softer body, κ [1]; below 8 as at 8.
    collar : {"own", "all"}
        Without or with what the touching collars of the two surfaces carry.
    """
    x = math.log(ratio)
    welded = _family(1.0, collar)
    log_load, log_area, share = (_between(x, np.log(welded.ratio), v) for v in welded[1:])
    frictions = sorted({run.friction for run in _runs() if run.softness == 0})
    softness = 1 / max(kappa, SOFTEST_KAPPA)
    changes = np.array([_friction_change(x, m, collar) for m in frictions])
    elastic = softness * _elastic_slope(x, softness, collar)
    for i, values in enumerate((log_load, log_area)):
        rubbing = _between(friction, np.array(frictions), np.exp(changes[:, i]))
        values += np.log(rubbing) + elastic[i]
    log_load -= math.log(math.pi * FULL)
    _, transform = chebyshev_transform(TERMS)
    return SqueezeCurve(*(transform @ values for values in (log_load, log_area, share)))


def _friction_change(x: float, friction: float, collar: str) -> Array:
    """ln of load and of area over those of welded runs, at ln ρ = x: (2, TERMS)."""
    family, welded = _family(friction, collar), _family(1.0, collar)
    here, there = np.isin(family.ratio, welded.ratio), np.isin(welded.ratio, family.ratio)
    nodes = np.log(family.ratio[here])
    load = family.log_load[here] - welded.log_load[there]
    area = family.log_area[here] - welded.log_area[there]
    return np.array([_between(x, nodes, load), _between(x, nodes, area)])


def _elastic_slope(x: float, softness: float, collar: str) -> Array:
    """ln of load and of area over those of rigid-plastic runs, over H/E*: (2, TERMS)."""
    welded = _family(1.0, collar)
    runs = [run for run in _runs() if run.softness > 0 and run.kind == "two-sided"]
    slopes = []
    ratios = sorted({run.ratio for run in runs})
    for ratio in ratios:
        rigid = int(np.flatnonzero(welded.ratio == ratio)[0])
        here = sorted((run for run in runs if run.ratio == ratio), key=lambda run: run.softness)
        change = np.array(
            [
                [
                    (run.all if collar == "all" else run.own)
                    - math.log(min(ratio, 1.0))
                    - welded.log_load[rigid],
                    run.area - welded.log_area[rigid],
                ]
                for run in here
            ]
        )
        known = np.array([run.softness for run in here])
        slopes.append(_between(softness, known, change / known[:, None, None]))
    return _between(x, np.log(ratios), np.array(slopes))


@dataclass(frozen=True)
class DeepSqueeze:
    """That a side of a round particle follows the computed table.

    Attributes
    ----------
    ratio : float
        Hardness of the particle over that of the surface, ρ [1].
    friction : float
        Friction factor of the particle's faces, m [1].
    collar : {"own", "all"}
        Without or with the load on touching collars.
    """

    ratio: float
    friction: float
    collar: str

    def side(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, R: float
    ) -> DeepSide | None:
        """The contact of this side; None where the law knows no yielding."""
        if law.bound(R=R, E_star=E_star, H=H, nu=nu).branches[-1].regime != "plastic":
            return None
        return DeepSide(self, law, E_star, H, nu, R)


class DeepSide(Side):
    r"""One side of a round particle, from first contact to a thin disc or a buried sphere.

    .. math:: F = F_L^{1-w} F_T^{\,w}, \qquad A = A_L^{1-w} A_T^{\,w}, \qquad
        w = u^2(3-2u), \quad u = \frac{\ln(\varepsilon/0.05)}{\ln 3}

    with the load F_L and the area A_L of one contact by a law, and those of the table at the
    squeeze ε = δ/R of this side. Beyond the table a contact goes on as a disc of constant volume
    with its friction hill, while its mean pressure is below the hardness of the surface,

    .. math:: A \propto \frac1t, \qquad p \propto 1 + \frac{m\,a}{3\sqrt3\,tR},
        \qquad t = 1-\varepsilon .

    Attributes
    ----------
    end : float
        Squeeze ε beyond which load and area are constant.
    """

    spreads = True

    def __init__(
        self,
        form: DeepSqueeze,
        law: AbstractAsperityLaw,
        E_star: float,
        H: float,
        nu: float,
        R: float,
    ):
        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.unit = R * math.pi * self.delta_1 * H
        self.plateau = True
        self.hill = form.friction / (3 * math.sqrt(3))
        curve = squeeze_curve(form.ratio, form.friction, E_star / H, form.collar)
        self._table = np.stack([curve.log_load, curve.log_area], axis=-1)
        self._share = curve.share
        self._at_top = np.exp(chebval(1.0, self._table))
        self.end = self._sinks(max(1 / form.ratio, 1.0))
        turns = [y for y in self.law.breakpoints if y < self._reduced(LAW_ENDS)]
        turns += self._reduced(np.array([LAW_ENDS, TABLE_BEGINS, *SPLITS, TABLE_ENDS])).tolist()
        turns += self._wide()
        turns += [y for y in self.law.breakpoints if LAW_ENDS < self._squeeze(y) < TABLE_BEGINS]
        t, last = 1 - TABLE_ENDS, 1 - self.end
        while t > GRADING * last:
            t /= GRADING
            turns.append(float(self._reduced(1 - t)))
        self.kinks = np.unique([*turns, float(self._reduced(self.end))])
        self.cap = np.array(self._reduced(TABLE_BEGINS))
        self.limit = self.unit * self.reduced_force(self.kinks[-1:])

    def _squeeze(self, y: Any) -> Any:
        """Squeeze ε at y = δ/δ_1."""
        return y * self.delta_1 / self.R

    def _reduced(self, eps: Any) -> Any:
        """y = δ/δ_1 at a squeeze ε."""
        return eps * self.R / self.delta_1

    def _wide(self) -> list[float]:
        """y at which the contact becomes as wide as the particle was."""
        eps = np.linspace(TABLE_BEGINS, self.end, 400)
        area = self._columns(self._reduced(eps))[1]
        after = int(np.argmax(area > 1.0))
        if after == 0:
            return []

        from scipy.optimize import brentq

        def excess(y: float) -> float:
            return float(self._columns(np.array([y]))[1][0]) - 1.0

        low, high = self._reduced(eps[[after - 1, after]])
        return [float(brentq(excess, low, high, xtol=1e-15 * high, rtol=1e-15))]

    def _disc(self, t: Any) -> tuple[Any, Any]:
        """Load over πR²H and area over πR² of a disc of the height t left, beyond the table."""
        load, area = self._at_top
        thick = 1 - TABLE_ENDS
        wide = area * thick / t

        def rise(area: Any, t: Any) -> Any:
            return 1 + self.hill * np.sqrt(area) / t

        return load * thick / t * rise(wide, t) / rise(area, thick), wide

    def _sinks(self, surface: float) -> float:
        """Squeeze from which the mean pressure is the surface's hardness, so many times H."""
        from scipy.optimize import brentq

        def excess(log_t: float) -> float:
            load, area = self._disc(math.exp(log_t))
            return float(load / area) - surface

        low = high = math.log(1 - TABLE_ENDS)
        while excess(low) < 0 and low > THINNEST:
            high, low = low, low - math.log(2)
        if low == high:
            return TABLE_ENDS
        if low <= THINNEST:
            return -math.expm1(low)
        return -math.expm1(brentq(excess, low, high, xtol=1e-15, rtol=1e-15))

    def _columns(self, y: Array) -> tuple[Array, Array]:
        """Load over πR²H and area over πR² at y."""
        y = np.asarray(y, dtype=float)
        eps = np.minimum(self._squeeze(y), self.end)
        thin = self._squeeze(1.0)
        with np.errstate(divide="ignore"):
            place = np.log(eps)
        load, area = (thin * self.law.reduced(name, y) for name in ("force", "area"))
        u = np.clip((place - math.log(LAW_ENDS)) / math.log(TABLE_BEGINS / LAW_ENDS), 0.0, 1.0)
        w = u * u * (3 - 2 * u)
        inside = w > 0
        if np.any(inside):
            at = place_of(np.minimum(eps[inside], TABLE_ENDS), LAW_ENDS, TABLE_ENDS)
            for values, table in zip((load, area), chebval(at, self._table), strict=True):
                start = np.log(values[inside])
                values[inside] = np.exp(start + w[inside] * (table - start))
        over = eps > TABLE_ENDS
        if np.any(over):
            load[over], area[over] = self._disc(1 - eps[over])
        return load, area

    def reduced_force(self, y: Array) -> Array:
        return self._columns(y)[0] / self._squeeze(1.0)

    def reduced_area(self, y: Array) -> Array:
        return self._columns(y)[1] / self._squeeze(1.0)

    def sink(self, delta: Array) -> Array:
        """How deep the particle sinks into the surface, of an approach δ; both over x."""
        eps = np.clip(delta / self.R, LAW_ENDS, TABLE_ENDS)
        share = chebval(place_of(eps, LAW_ENDS, TABLE_ENDS), self._share)
        return delta * np.clip(share, 0.0, 1.0)


THINNEST = -30.0
"""ln of the height left over the radius beyond which a disc does not go."""
