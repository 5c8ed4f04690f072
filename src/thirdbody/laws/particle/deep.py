"""A side of a round particle at any squeeze and any hardness ratio, from a computed table."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
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

    Fan = Callable[[Array], Array]

__all__ = ["DeepSide", "DeepSqueeze", "SqueezeCurve", "curve_rows", "squeeze_curve"]

LAW_ENDS, TABLE_BEGINS = 0.05, 0.15
"""Squeezes ε up to which the law of one contact holds, and from which the table does."""
TABLE_ENDS = 0.95
"""Largest squeeze ε of the table."""
TOGETHER = 0.7
"""Squeeze ε from which collars of the surfaces may touch."""
SPLITS = (0.087, 0.45, 0.75, 0.88, 0.92)
"""Squeezes at which panels end, so that series of the table resolve it."""
TERMS = 10
"""Of series of the roots of its slopes."""
SOFT, RIGID = 0.4, 10.0
"""Hardness ratios up to which surfaces count as rigid, and from which the particle does."""
SINK_AT = np.linspace(LAW_ENDS, TABLE_ENDS, 19)
"""Squeezes ε of the table, at which sinks stand."""
EARLIEST = SPLITS[2]
"""Squeeze ε from which a surface may have its hardness on a squashed particle."""
LEAST_PART = 1e-3
"""Part of the squeeze below which a particle takes none of it."""
DEEPEST = 0.999
"""Squeeze ε beyond which nothing changes: the planes of equal surfaces all but meet."""
SOFTEST_KAPPA = 8.0
"""E*/H below which the elastic part of the table is not extrapolated further."""


class SqueezeCurve(NamedTuple):
    """Response of one side of a particle: Chebyshev series on the table's range of ln ε/(1 − ε)."""

    log_load: Array
    """ln F/(πR²H), with the hardness H of the softer body [1]."""
    log_area: Array
    """ln A/(πR²) [1]."""
    sinks: Array
    """Sink of the particle into the surface over R, at the squeezes `SINK_AT` [1]."""


class _Run(NamedTuple):
    """One computed curve, as series on its range."""

    ratio: float
    """Hardness ratio particle over surface: 0 if the surfaces are rigid, inf if the particle is."""
    friction: float
    """Friction factor of its faces [1]."""
    softness: float
    """H/E* [1]; 0 for rigid-plastic bodies."""
    low: float
    high: float
    """Squeezes ε from and to which it was computed."""
    series: dict[str, Any]

    def first(self, name: str) -> float:
        """ln of load over Y R² of the softer body, or of area over πR², at the smallest ε."""
        value: float = self.series[name]["first"]
        # loads are stored over Y_s R², of rigid surfaces over Y_p R²
        harder = name != "area" and self.ratio not in (0, math.inf)
        return value - math.log(min(self.ratio, 1.0)) if harder else value

    def root(self, name: str, places: Array) -> Array:
        """Square root of the slope of that logarithm along the table (N,); 0 beyond the run."""
        eps = squeeze_at(places)
        along_run = place_of(eps, self.low, self.high)
        step = place_of(np.array([LAW_ENDS, TABLE_ENDS]), self.low, self.high)
        root: Array = chebval(along_run, self.series[name]["root"]) * math.sqrt(
            (step[1] - step[0]) / 2
        )
        return np.where(eps <= self.high * (1 + 1e-9), root, 0.0)

    @property
    def share(self) -> Array:
        """Sink into each surface over the squeeze, at `SINK_AT`."""
        return np.array(self.series["sink"]) / SINK_AT

    @property
    def node(self) -> float:
        """ln ρ at which it stands."""
        return math.log(min(max(self.ratio, SOFT), RIGID))


COLUMNS = ("own", "area", "sink")
"""Load without what touching collars carry, contact area, and sink over the squeeze."""


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


def _welded_run(run: _Run) -> _Run:
    """The welded rigid-plastic run of the same hardness ratio."""
    return next(it for it in _chosen(1.0) if it.ratio == run.ratio)


def place_of(eps: Any, low: float, high: float) -> Any:
    """Place on [−1, 1] of squeezes between two, in ln ε/(1 − ε)."""
    first, last = (math.log(end / (1 - end)) for end in (low, high))
    return (2 * np.log(eps / (1 - eps)) - first - last) / (last - first)


def squeeze_at(place: Array) -> Array:
    """Squeeze ε at a place on [−1, 1] of the table."""
    first, last = (math.log(end / (1 - end)) for end in (LAW_ENDS, TABLE_ENDS))
    return 1 / (1 + np.exp(-(first + last + place * (last - first)) / 2))


def _interpolant(nodes: Sequence[float], values: Sequence[Array]) -> Fan:
    """Function of x between the values (N, K) at nodes (N,): monotone, constant outside."""
    from scipy.interpolate import PchipInterpolator

    if len(nodes) == 1:
        return lambda x: values[0]
    order = np.argsort(nodes)
    places = np.asarray(nodes)[order]
    curve = PchipInterpolator(places, np.asarray(values)[order], axis=0)
    return lambda x: curve(np.clip(x, places[0], places[-1]))


@lru_cache(maxsize=1)
def _fans() -> tuple[Fan, list[Fan], list[tuple[float, Fan]]]:
    """Rows of both logarithms: welded ones over ln ρ, changes by friction and by H/E* with ρ.

    A row is the first value and the roots of the slope at places of the table, of the load and
    then of the area.
    """
    places = chebyshev_transform(TERMS)[0]
    welded = _chosen(1.0)
    rubbing = []
    for m in _frictions():
        runs = _chosen(m)
        changes = [_change(run, places) for run in runs]
        rubbing.append(_interpolant([run.node for run in runs], changes))
    elastic = []
    runs = [run for run in _runs() if run.softness > 0]
    for node in sorted({run.node for run in runs}):
        here = [run for run in runs if run.node == node]
        slopes = [_change(run, places) / run.softness for run in here]
        elastic.append((node, _interpolant([run.softness for run in here], slopes)))
    rows = [_row(run, places) for run in welded]
    return _interpolant([run.node for run in welded], rows), rubbing, elastic


@lru_cache(maxsize=1)
def _frictions() -> tuple[float, ...]:
    """Friction factors of the rigid-plastic runs."""
    return tuple(sorted({run.friction for run in _runs() if run.softness == 0}))


def _at_frictions(friction: Array, values: Array) -> Array:
    """What stands at the friction factors of the runs (nodes, N, terms), at m (N,): (N, terms)."""
    # at the factor of a run it is that run's, to the last digit
    interpolated, rest = np.empty(values.shape[1:]), np.ones(len(friction), bool)
    for i, node in enumerate(_frictions()):
        here = friction == node
        interpolated[here], rest = values[i, here], rest & ~here
    if rest.any():
        interpolated[rest] = _each_at(_frictions(), values[:, rest], friction[rest])
    return interpolated


@lru_cache(maxsize=512)
def squeeze_curve(ratio: float, friction: float, kappa: float) -> SqueezeCurve:
    r"""Response of one side of a round particle, interpolated between the computed runs.

    Load and area rise with the squeeze: the square roots of the slopes of their logarithms are
    interpolated, in ln ρ and in m by monotone cubics and in 1/κ in straight lines, so that no
    combination falls. Sinks are those of rigid-plastic bodies, in ln ρ in straight lines.

    Parameters
    ----------
    ratio : float
        Hardness of the particle over that of the surface, ρ [1].
    friction : float
        Shear stress on the faces of the particle over the shear strength, m [1], 0 to 1.
    kappa : float
        E*/H of the softer body, κ [1]; below 8 as at 8.
    """
    log_load, log_area = curve_rows(*(np.array([value]) for value in (ratio, friction, kappa)))
    sinks = sink_rows(np.array([ratio]), np.array([friction]))
    return SqueezeCurve(log_load[0], log_area[0], sinks[0])


def curve_rows(ratio: Array, friction: Array, kappa: Array) -> tuple[Array, Array]:
    """Series of ln load and ln area of many sides (N, terms), of which `squeeze_curve` has one."""
    out = _logarithms(np.log(ratio), friction, 1 / np.maximum(kappa, SOFTEST_KAPPA))
    out[0, :, 0] -= math.log(math.pi * FULL)
    return out[0], out[1]


def _each_at(nodes: Sequence[float], values: Array, at: Array) -> Array:
    """Values (N, terms) of monotone cubics through (nodes, N, terms), each at its place (N,)."""
    from scipy.interpolate import PchipInterpolator

    cubic, ends = PchipInterpolator(nodes, values, axis=0), np.asarray(nodes, dtype=float)
    at = np.clip(at, ends[0], ends[-1])
    piece = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(ends) - 2)
    c, u = cubic.c[:, piece, np.arange(len(at))], (at - ends[piece])[:, None]
    interpolated: Array = ((c[0] * u + c[1]) * u + c[2]) * u + c[3]
    return interpolated


def _logarithms(x: Array, friction: Array, softness: Array) -> Array:
    """The series of `squeeze_curve` at ln ρ, m and H/E* (N,): (2, N, terms)."""
    from numpy.polynomial.chebyshev import chebint

    welded, rubbing, elastic = _fans()
    row = welded(x) + _at_frictions(friction, np.array([fan(x) for fan in rubbing]))
    of_softness = np.array([fan(softness) for _, fan in elastic])
    row = row + softness[:, None] * _each_at([node for node, _ in elastic], of_softness, x)
    both = np.stack([row[:, : TERMS + 1], row[:, TERMS + 1 :]])
    # term by term: a product of matrices rounds a row alone and among others differently
    root = np.zeros((2, len(x), TERMS))
    for i, column in enumerate(chebyshev_transform(TERMS)[1].T):
        root += both[:, :, 1 + i, None] * column
    # T_i T_j = (T_{i+j} + T_{|i-j|})/2
    square = np.zeros((*root.shape[:2], 2 * TERMS - 1))
    for i in range(TERMS):
        term = 0.5 * root[:, :, i, None] * root
        square[:, :, i : i + TERMS] += term
        square[:, :, : TERMS - i] += term[:, :, i:]
        square[:, :, 1 : i + 1] += term[:, :, :i][:, :, ::-1]
    series: Array = chebint(square, lbnd=-1, axis=2).astype(float)
    series[:, :, 0] += both[:, :, 0]
    return series


@lru_cache(maxsize=1)
def _share_lines() -> tuple[Fan, ...]:
    """Sinks over the squeeze at `SINK_AT`, of ln ρ: one function a friction factor of the runs."""
    from scipy.interpolate import make_interp_spline

    def line(m: float) -> Fan:
        runs = _chosen(m)
        nodes = np.array([run.node for run in runs])
        # in straight lines: a cubic is half as steep again where a particle begins to embed
        between = make_interp_spline(nodes, np.array([run.share for run in runs]), k=1)
        return lambda x: between(np.clip(x, nodes[0], nodes[-1]))

    return tuple(line(m) for m in _frictions())


def sink_rows(ratio: Array, friction: Array) -> Array:
    """Sinks over R of many sides at `SINK_AT` (N, 19), of which `squeeze_curve` has one.

    Between the rigid-plastic runs, never falling with the squeeze, nor rising faster than it, so
    that the squash of the particle never falls either.
    """
    shares = np.array([line(np.log(ratio)) for line in _share_lines()])
    out = _at_frictions(friction, shares) * SINK_AT
    for i in range(1, len(SINK_AT)):
        before = out[:, i - 1]
        out[:, i] = np.clip(out[:, i], before, before + (SINK_AT[i] - SINK_AT[i - 1]))
    return out


def squashed_part(sinks: Array) -> Array:
    """Part of the squeeze that the particle itself takes at the table's end, from sinks (N, 19).

    1 where the surface is rigid, 0 where the particle is.
    """
    share: Array = 1 - np.minimum(sinks[..., -1] / TABLE_ENDS, 1.0)
    return np.where(share > LEAST_PART, share, 0.0)


def _row(run: _Run, places: Array) -> Array:
    """First value, then roots of the slope at places (N,) of the table, of load and of area."""
    parts = [([run.first(name)], run.root(name, places)) for name in ("own", "area")]
    return np.concatenate([values for both in parts for values in both])


def _change(run: _Run, places: Array) -> Array:
    """A row less that of the welded rigid-plastic run of the same ρ; 0 beyond either."""
    welded = _welded_run(run)
    change = (_row(run, places) - _row(welded, places)).reshape(2, 1 + len(places))
    change[:, 1:][:, squeeze_at(places) > min(run.high, welded.high) * (1 + 1e-9)] = 0.0
    return change.ravel()


@dataclass(frozen=True)
class DeepSqueeze:
    """Form of a round side of a particle that follows the computed table.

    Attributes
    ----------
    ratio : float
        Hardness of the particle over that of the surface, ρ [1].
    friction : float
        Friction factor of the particle's faces, m [1].
    """

    ratio: float
    friction: float

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
        \qquad t = 1-(1-k)\,\varepsilon ,

    with the half height tR that is left to it, as the surface takes the part k of the squeeze that
    it takes at the end of the table. A surface harder than the particle bears no more than its
    hardness within the table either: the softest particles were squeezed between rigid surfaces.

    Attributes
    ----------
    end : float
        Squeeze ε beyond which load and area are constant.
    """

    spreads = True
    knows_sink = True

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
        self.form, self.kappa = form, E_star / H
        curve = squeeze_curve(form.ratio, form.friction, self.kappa)
        self._table = np.stack([curve.log_load, curve.log_area], axis=-1)
        self._sunk = curve.sinks
        self._at_top = np.exp(chebval(1.0, self._table))
        self.taken = float(squashed_part(curve.sinks))
        self.thick = 1 - TABLE_ENDS * self.taken
        self.end = self._sinks(max(1 / form.ratio, 1.0))
        self.sink_bends = [*(R * SINK_AT[SINK_AT < self.end]).tolist(), R * self.end]
        turns = [y for y in self.law.breakpoints if y < self._reduced_indentation(LAW_ENDS)]
        turns += self._reduced_indentation(
            np.array([LAW_ENDS, TABLE_BEGINS, *SPLITS, TABLE_ENDS])
        ).tolist()
        turns += self._wide()
        turns += [y for y in self.law.breakpoints if LAW_ENDS < self._squeeze(y) < TABLE_BEGINS]
        t, last = self.thick, 1 - self.end * self.taken
        while t > GRADING * last:
            t /= GRADING
            turns.append(float(self._reduced_indentation((1 - t) / self.taken)))
        last = float(self._reduced_indentation(self.end))
        self.kinks = np.unique([*(y for y in turns if y < last), last])
        self.cap = np.array(self._reduced_indentation(TABLE_BEGINS))
        self.limit = self.unit * self.reduced_force(self.kinks[-1:])

    @property
    def friction_band(self) -> tuple[float, float]:
        """Least and most that its load differs, over itself, with faces from smooth to welded.

        At squeezes from where the table begins to 0.7, from where collars may touch.
        """
        faces = np.unique([*_frictions(), self.form.friction])
        same = np.ones(len(faces))
        load, _ = curve_rows(self.form.ratio * same, faces, self.kappa * same)
        eps = np.linspace(TABLE_BEGINS, TOGETHER, 12)
        log_load = chebval(place_of(eps, LAW_ENDS, TABLE_ENDS), load.T)
        change = np.expm1(log_load - log_load[faces == self.form.friction])
        return float(change.min()), float(change.max())

    def _squeeze(self, y: Any) -> Any:
        """Squeeze ε at y = δ/δ_1."""
        return y * self.delta_1 / self.R

    def _reduced_indentation(self, eps: Any) -> Any:
        """y = δ/δ_1 at a squeeze ε."""
        return eps * self.R / self.delta_1

    def _wide(self) -> list[float]:
        """y at which the contact becomes as wide as the particle was."""
        eps = np.linspace(TABLE_BEGINS, self.end, 400)
        area = self._columns(self._reduced_indentation(eps))[1]
        after = int(np.argmax(area > 1.0))
        if after == 0:
            return []

        from scipy.optimize import brentq

        def excess(y: float) -> float:
            return float(self._columns(np.array([y]))[1][0]) - 1.0

        low, high = self._reduced_indentation(eps[[after - 1, after]])
        return [float(brentq(excess, low, high, xtol=1e-15 * high, rtol=1e-15))]

    def _disc(self, t: float | Array) -> tuple[Any, Any]:
        """Load over πR²H and area over πR² of a disc of the height t left, beyond the table."""
        load, area = self._at_top
        thick = self.thick
        wide = area * thick / t

        def rise(area: float | Array, t: float | Array) -> float | Array:
            return 1 + self.hill * np.sqrt(area) / t

        return load * thick / t * rise(wide, t) / rise(area, thick), wide

    def _sinks(self, surface: float) -> float:
        """Squeeze from which the mean pressure is the surface's hardness, so many times H."""
        from scipy.optimize import brentq

        def excess(log_t: float) -> float:
            load, area = self._disc(math.exp(log_t))
            return float(load / area) - surface

        low = high = math.log(self.thick)
        if excess(low) >= 0:
            return self._sinks_early(surface) if surface > 1 else TABLE_ENDS
        if self.taken == 0:
            return DEEPEST
        while excess(low) < 0 and low > THINNEST:
            high, low = low, low - math.log(2)
        if low > THINNEST:
            low = brentq(excess, low, high, xtol=1e-15, rtol=1e-15)
        # 1 − e^x by expm1: few digits of the height are left otherwise
        return min(-math.expm1(low) / self.taken, DEEPEST)

    def _sinks_early(self, surface: float) -> float:
        """The same within the table, for surfaces that were taken for rigid there."""
        from scipy.optimize import brentq

        def excess(eps: float) -> float:
            at = place_of(eps, LAW_ENDS, TABLE_ENDS)
            load, area = np.exp(chebval(at, self._table))
            return float(load / area) - surface

        if excess(EARLIEST) >= 0:
            return EARLIEST
        return float(brentq(excess, EARLIEST, TABLE_ENDS, xtol=1e-15, rtol=1e-15))

    def _columns(self, y: Array) -> tuple[Array, Array]:
        """Load over πR²H and area over πR² at y."""
        y = np.asarray(y, dtype=float)
        eps = np.minimum(self._squeeze(y), self.end)
        thin = self._squeeze(1.0)
        load, area = np.zeros_like(y), np.zeros_like(y)
        inside, low = eps > LAW_ENDS, eps < TABLE_BEGINS
        if np.any(inside):
            at = place_of(np.minimum(eps[inside], TABLE_ENDS), LAW_ENDS, TABLE_ENDS)
            load[inside], area[inside] = np.exp(chebval(at, self._table))
        if np.any(low):
            span = math.log(TABLE_BEGINS / LAW_ENDS)
            u = np.log(np.maximum(eps[low], LAW_ENDS) / LAW_ENDS) / span
            w = u * u * (3 - 2 * u)
            force, dent = self.law.reduced("force", y[low]), self.law.reduced("area", y[low])
            for values, first in ((load, thin * force), (area, thin * dent)):
                table = values[low] / np.where(w > 0, first, 1.0)
                values[low] = first * np.where(w > 0, table, 1.0) ** w
        over = eps > TABLE_ENDS
        if np.any(over):
            load[over], area[over] = self._disc(1 - self.taken * eps[over])
        return load, area

    def both(self, delta: Array) -> tuple[Array, Array]:
        load, area = self._columns(delta / self.delta_1)
        thin = self._squeeze(1.0)
        return self.unit * (load / thin), self.R * math.pi * self.delta_1 * (area / thin)

    def reduced_force(self, y: Array) -> Array:
        return self._columns(y)[0] / self._squeeze(1.0)

    def reduced_area(self, y: Array) -> Array:
        return self._columns(y)[1] / self._squeeze(1.0)

    def sink(self, delta: Array) -> Array:
        """How deep the particle sinks into the surface, of an approach δ; both over x.

        Of rigid-plastic bodies, in straight lines between what was computed, so that neither it
        nor the squash of the particle ever falls. Beyond the table in the same proportion, and
        from `end` on, where the particle gives way no further, whole.
        """
        eps = np.asarray(delta, dtype=float) / self.R
        nodes, sinks = np.append(0.0, SINK_AT), np.append(0.0, self._sunk)
        within = np.interp(np.minimum(eps, self.end), nodes, sinks)
        disc = np.maximum(np.minimum(eps, self.end) - TABLE_ENDS, 0.0)
        whole = np.maximum(eps - self.end, 0.0)
        return self.R * (within + disc * (sinks[-1] / TABLE_ENDS) + whole)


THINNEST = -30.0
"""ln of the height left over the radius beyond which a disc does not go."""
