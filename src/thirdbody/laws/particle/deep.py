"""A side of a round particle at any squeeze and any hardness ratio, from a computed table."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .one_particle import Side
from .squashed import FULL, GRADING

if TYPE_CHECKING:
    from ..base import AbstractAsperityLaw
    from .one_particle import Array

__all__ = ["DeepSide", "DeepSqueeze", "SqueezeCurve", "squeeze_curve"]

LAW_ENDS, TABLE_BEGINS = 0.05, 0.15
"""Squeezes ε up to which the law of one contact holds, and from which the table does."""
RIGID = 10.0
"""Hardness ratio from which a particle counts as rigid."""
NO_SINK = 0.25
"""Hardness ratio at which the table's smallest sink is taken to have gone to zero."""
SOFTEST_KAPPA = 8.0
"""E*/H below which the elastic part of the table is not extrapolated further."""


class SqueezeCurve(NamedTuple):
    """What one side of a particle does at the squeezes ε of the table: arrays (K,)."""

    eps: Array
    """Squeeze ε = δ/R of this side [1], increasing."""
    log_load: Array
    """ln F/(Y R²), with the yield strength Y of the softer body [1]."""
    log_area: Array
    """ln A/(πR²) [1]."""
    share: Array
    """Sink of the particle into the surface over its squeeze [1]."""


class _Run(NamedTuple):
    """One computed curve of the table."""

    kind: str
    """``two-sided``, ``one-sided``, or ``platens``, the limit of a soft particle."""
    ratio: float
    """Hardness of the particle over that of the surface; `RIGID` for a rigid one."""
    friction: float
    """Friction factor of its faces [1]."""
    softness: float
    """H/E* [1]; 0 for rigid-plastic bodies."""
    eps: Array
    load: Array
    """F/(Y_s R²), of platens F/(Y_p R²)."""
    own: Array
    """The same without what touching collars carry."""
    area: Array
    """A/(πR²)."""
    sink: Array
    """Sink into each surface over R."""


@lru_cache(maxsize=1)
def _runs() -> tuple[_Run, ...]:
    """The computed curves, as they are stored."""
    text = resources.files("thirdbody").joinpath("data/deep_squeeze.json").read_text("utf-8")

    def run(data: dict[str, Any]) -> _Run:
        load, eps = np.array(data["F"]), np.array(data["eps"])
        collar = np.array(data["collar"] or 0.0)
        return _Run(
            kind=data["kind"],
            ratio=RIGID if data["rho"] is None else data["rho"],
            friction=data["m"],
            softness=0.0 if data["kappa"] is None else 1 / data["kappa"],
            eps=eps,
            load=load,
            own=np.maximum.accumulate(load * (1 - collar)),
            area=np.array(data["A"]),
            sink=np.array(data["sink"] or 0.0 * eps),
        )

    return tuple(run(data) for data in json.loads(text)["curves"])


class _Family(NamedTuple):
    """Runs of one friction and stiffness against the hardness ratio: (N,) and (N, K)."""

    ratio: Array
    log_load: Array
    log_area: Array
    share: Array


@lru_cache(maxsize=64)
def _family(friction: float, softness: float, collar: str) -> _Family:
    """Loads are over the yield strength of the softer body; platens stand at the least ratio."""
    sided = [run for run in _runs() if run.kind == "two-sided"]
    least = min(run.ratio for run in sided)
    rows = []
    for run in _runs():
        soft = run.kind == "platens"
        if (run.friction, run.softness) != (friction, softness) or run.kind == "one-sided":
            continue
        if not soft and run.ratio == least and any(it.kind == "platens" for it in _runs()):
            continue  # its faces read high where the disc is thin; the limit holds there
        ratio = least if soft else run.ratio
        load = (run.load if collar == "all" else run.own) / (1.0 if soft else min(ratio, 1.0))
        rows.append((ratio, np.log(load), np.log(run.area), np.clip(run.sink / run.eps, 0.0, 1.0)))
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
    the ratio of two runs of one ρ, taken monotone in m and linear in 1/κ.

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
    welded = _family(1.0, 0.0, collar)
    eps = _runs()[0].eps
    log_load = _between(x, np.log(welded.ratio), welded.log_load)
    log_area = _between(x, np.log(welded.ratio), welded.log_area)
    share = _between(x, np.log(welded.ratio), welded.share)
    # of friction: ratios of load and area to those of welded faces
    frictions = sorted({run.friction for run in _runs() if run.softness == 0})
    change = np.array([_change(x, m, 0.0, collar) for m in frictions])
    log_load, log_area = (
        values + np.log(_between(friction, np.array(frictions), np.exp(change[:, i])))
        for i, values in enumerate((log_load, log_area))
    )
    # of elasticity
    stiff = sorted({run.softness for run in _runs() if run.softness > 0 and run.kind != "platens"})
    softness = 1 / max(kappa, SOFTEST_KAPPA)
    for i, values in enumerate((log_load, log_area)):
        values += softness * np.mean([_change(x, 1.0, s, collar)[i] / s for s in stiff], axis=0)
    return SqueezeCurve(eps, log_load, log_area, share)


def _change(x: float, friction: float, softness: float, collar: str) -> Array:
    """ln of load and of area over those of welded, rigid-plastic runs, at ln ρ = x: (2, K)."""
    family, welded = _family(friction, softness, collar), _family(1.0, 0.0, collar)
    here = np.isin(welded.ratio, family.ratio)
    nodes = np.log(family.ratio)
    return np.array(
        [
            _between(x, nodes, family.log_load - welded.log_load[here]),
            _between(x, nodes, family.log_area - welded.log_area[here]),
        ]
    )


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
        from scipy.interpolate import PchipInterpolator

        self.law, self.H, self.R = law.bound(R=R, E_star=E_star, H=H, nu=nu), H, R
        self.delta_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.unit = R * math.pi * self.delta_1 * H
        self.plateau = True
        self.hill = form.friction / (3 * math.sqrt(3))
        curve = squeeze_curve(form.ratio, form.friction, E_star / H, form.collar)
        # loads over πR²H and areas over πR² of ln ε; the yield strength is H/2.84
        columns = np.stack([curve.log_load - math.log(math.pi * FULL), curve.log_area], axis=-1)
        self._table = PchipInterpolator(np.log(curve.eps), columns)
        self._share = PchipInterpolator(curve.eps, curve.share)
        self.top = float(curve.eps[-1])
        self._at_top = np.exp(columns[-1])
        self.end = self._sinks(max(1 / form.ratio, 1.0))
        turns = [y for y in self.law.breakpoints if y < self._reduced(LAW_ENDS)]
        turns += self._reduced(np.array([LAW_ENDS, TABLE_BEGINS, *curve.eps])).tolist()
        turns += [y for y in self.law.breakpoints if LAW_ENDS < self._squeeze(y) < TABLE_BEGINS]
        t, last = 1 - self.top, 1 - self.end
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

    def _disc(self, t: Any) -> tuple[Any, Any]:
        """Load over πR²H and area over πR² of a disc of the height t left, beyond the table."""
        load, area = self._at_top
        thick = 1 - self.top
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

        low = high = math.log(1 - self.top)
        while excess(low) < 0 and low > THINNEST:
            high, low = low, low - math.log(2)
        if low == high:
            return self.top
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
            table = self._table(np.minimum(place[inside], math.log(self.top)))
            for i, values in enumerate((load, area)):
                start = np.log(values[inside])
                values[inside] = np.exp(start + w[inside] * (table[..., i] - start))
        over = eps > self.top
        if np.any(over):
            load[over], area[over] = self._disc(1 - eps[over])
        return load, area

    def reduced_force(self, y: Array) -> Array:
        return self._columns(y)[0] / self._squeeze(1.0)

    def reduced_area(self, y: Array) -> Array:
        return self._columns(y)[1] / self._squeeze(1.0)

    def sink(self, delta: Array) -> Array:
        """How deep the particle sinks into the surface, of an approach δ; both over x."""
        first, last = self._share.x[[0, -1]]
        return delta * self._share(np.clip(delta / self.R, first, last))


THINNEST = -30.0
"""ln of the height left over the radius beyond which a disc does not go."""
