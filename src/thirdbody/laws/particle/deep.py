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
TABLE_ENDS = 0.95
"""Largest squeeze ε of the table."""
SPLITS = (0.45, 0.75)
"""Squeezes at which panels end, so that series of the table resolve it."""
TERMS = 14
"""Of its series."""
SOFT, RIGID = 0.4, 10.0
"""Hardness ratios up to which surfaces count as rigid, and from which the particle does."""
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
    """One computed curve, as series on its range."""

    ratio: float
    """Hardness of the particle over that of the surface: 0 if rigid surfaces, inf if it is rigid."""
    friction: float
    """Friction factor of its faces [1]."""
    softness: float
    """H/E* [1]; 0 for rigid-plastic bodies."""
    low: float
    high: float
    """Squeezes ε from and to which it was computed."""
    series: dict[str, list[float]]

    def values(self, name: str, eps: Array) -> Array:
        """One of `COLUMNS` at squeezes (N,), beyond the ends as at the ends."""
        place = place_of(np.clip(eps, self.low, self.high), self.low, self.high)
        values: Array = chebval(place, self.series[name])
        # loads are stored over Y_s R², of rigid surfaces over Y_p R²
        harder = name in ("own", "all") and self.ratio not in (0, math.inf)
        return values - math.log(min(self.ratio, 1.0)) if harder else values

    @property
    def node(self) -> float:
        """ln ρ at which it stands."""
        return math.log(min(max(self.ratio, SOFT), RIGID))


COLUMNS = ("own", "all", "area", "share")
"""ln F/(Y R²) of the softer body without and with what touching collars carry, ln A/(πR²), and the
sink into each surface over the squeeze."""


@lru_cache(maxsize=1)
def _runs() -> tuple[_Run, ...]:
    """The computed curves between two equal surfaces."""
    text = resources.files("thirdbody").joinpath("data/deep_series.json").read_text("utf-8")

    def run(data: dict[str, Any]) -> _Run:
        ratio, modulus = float(data["rho"]), float(data["E_over_Y"])
        # what deforms has E/(1 - 0.3²); of two bodies that do, E* is half of it
        E_star = modulus / 0.91 / (1 if ratio in (0, math.inf) else 2)
        softness = FULL * min(max(ratio, 0.0), 1.0) / E_star if ratio else FULL / E_star
        series = {name: data[name] for name in COLUMNS}
        return _Run(ratio, data["m"], softness, data["from"], data["to"], series)

    return tuple(run(data) for data in json.loads(text)["curves"] if data["surfaces"] == 2)


def _chosen(friction: float) -> list[_Run]:
    """Rigid-plastic runs of one friction factor, by increasing hardness of the particle."""
    runs = [run for run in _runs() if run.softness == 0 and run.friction == friction]
    return sorted(runs, key=lambda run: run.node)


def _welded(run: _Run) -> _Run:
    """The welded rigid-plastic run of the same hardness ratio."""
    return next(it for it in _chosen(1.0) if it.ratio == run.ratio)


def place_of(eps: Any, low: float, high: float) -> Any:
    """Place on [−1, 1] of squeezes between two, in ln ε/(1 − ε)."""
    first, last = (math.log(end / (1 - end)) for end in (low, high))
    return (2 * np.log(eps / (1 - eps)) - first - last) / (last - first)


def squeeze_at(place: Any) -> Any:
    """Squeeze ε at a place on [−1, 1] of the table."""
    first, last = (math.log(end / (1 - end)) for end in (LAW_ENDS, TABLE_ENDS))
    return 1 / (1 + np.exp(-(first + last + place * (last - first)) / 2))


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
    x, load = math.log(ratio), "all" if collar == "all" else "own"
    nodes, transform = chebyshev_transform(TERMS)
    eps = squeeze_at(nodes)
    welded = _chosen(1.0)
    places = np.array([run.node for run in welded])
    frictions = sorted({run.friction for run in _runs() if run.softness == 0})
    softness = 1 / max(kappa, SOFTEST_KAPPA)

    def values(name: str) -> Array:
        return _between(x, places, np.array([run.values(name, eps) for run in welded]))

    def logarithm(name: str) -> Array:
        rubbing = np.array([np.exp(_friction_change(x, name, m, eps)) for m in frictions])
        rubbed = np.log(_between(friction, np.array(frictions), rubbing))
        return values(name) + rubbed + softness * _elastic_slope(x, name, softness, eps)

    columns = (logarithm(load) - math.log(math.pi * FULL), logarithm("area"), values("share"))
    return SqueezeCurve(*(transform @ column for column in columns))


def _change(run: _Run, name: str, eps: Array) -> Array:
    """ln of load or area of a run over those of the welded rigid-plastic one of its ρ."""
    within = np.minimum(eps, min(run.high, _welded(run).high))
    return run.values(name, within) - _welded(run).values(name, within)


def _friction_change(x: float, name: str, friction: float, eps: Array) -> Array:
    """ln of load or area over those of welded faces, at ln ρ = x."""
    runs = [run for run in _chosen(friction) if any(it.ratio == run.ratio for it in _chosen(1.0))]
    changes = np.array([_change(run, name, eps) for run in runs])
    return _between(x, np.array([run.node for run in runs]), changes)


def _elastic_slope(x: float, name: str, softness: float, eps: Array) -> Array:
    """ln of load or area over those of rigid-plastic bodies, over H/E*, at ln ρ = x."""
    runs = sorted((run for run in _runs() if run.softness > 0), key=lambda run: run.softness)
    places = sorted({run.node for run in runs})
    if not runs:
        return np.zeros_like(eps)
    slopes = []
    for place in places:
        here = [run for run in runs if run.node == place]
        known = np.array([run.softness for run in here])
        changes = np.array([_change(run, name, eps) / run.softness for run in here])
        slopes.append(_between(softness, known, changes))
    return _between(x, np.array(places), np.array(slopes))


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
