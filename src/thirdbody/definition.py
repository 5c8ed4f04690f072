r"""The model as it is meant, slow and plain: two integrals and a balance.

.. math:: F_t(d) = (1-\varsigma)\,\eta\int F_1(\omega)\,\phi(z)\,dz
          + \eta_a\int\varphi_a(x)\int f(x, x-g)\,p_\zeta(g)\,dg\,dx = F

Every formula is a law's own, every integral is `scipy.integrate.cubature`'s, every balance a root
of SciPy: no tables, no engine. All that is faster in this library is held to this module by a test.
The particle law is `Series` or `Flakes`; `Horng2022` prints its integrals in closed form.
Particles that break are followed from one generation of pieces to the next.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Iterable, Sequence
from importlib import resources
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.integrate import cubature
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, minimize_scalar
from scipy.optimize.elementwise import find_root
from scipy.special import ndtr

from .errors import NoEquilibrium
from .laws.asperity.jg import JG
from .laws.base import REGIMES, AbstractAsperityLaw
from .laws.particle.tension import confined_tension
from .populations.distributions import Distribution, Monodisperse
from .populations.materials import Material, reduced_modulus
from .populations.particles import Particles
from .populations.shape import Angular, Shape

__all__ = ["Side", "Tip", "asperities", "particles", "separation", "solve_squeeze", "state"]

Array = NDArray[np.float64]
Formula = Callable[[Array], Array]
Numbers = float | Array
MOST_STEPS = 100
"""Steps of a search for a separation: of σ each on the way down, growing on the way up."""


def separation(contact: Any, pressure: float) -> float:
    """The separation d [m] that carries a pressure [Pa], where the load falls with d."""

    def excess(d: float) -> float:
        loads = state(contact, d)
        return float(np.log((loads["F_ss"] + loads["F_sa"]) / pressure))

    low = high = 0.0
    for _ in range(MOST_STEPS):
        if not excess(low) < 0:
            break
        low -= contact.roughness.sigma
    for _ in range(MOST_STEPS):
        if not excess(high) > 0:
            break
        high = 1.2 * high + contact.roughness.sigma
    if excess(low) < 0 or excess(high) > 0:
        raise NoEquilibrium(f"no separation from {low:.3g} to {high:.3g} m carries {pressure:g} Pa")
    return brentq(excess, low, high, xtol=1e-14 * contact.roughness.sigma)


def state(contact: Any, d: float) -> dict[str, float]:
    """Loads [Pa] and areas per nominal area at a separation d [m] of the mean asperity plane."""
    F, *bare_areas = asperities(contact, d)
    parts = [particles(contact, some, d) for some in contact.populations]
    F_sa, A_e, A_ep, A_p, A_sa2, shadow = np.sum([np.zeros(6), *parts], axis=0)
    areas = (1 - shadow) * np.array(bare_areas) + (A_e, A_ep, A_p)
    A_t, A_sa = areas.sum(), A_e + A_ep + A_p
    split = dict(zip(("A_e", "A_ep", "A_p"), areas, strict=True))
    totals = {"A_t": A_t, "A_ss": A_t - A_sa, "A_sa": A_sa, "A_sa2": A_sa2, "shadow": shadow}
    return {"F_ss": (1 - shadow) * F, "F_sa": F_sa, **totals, **split}


# ---------------------------------------------------------------- asperities
def asperities(contact: Any, d: float) -> Array:
    """η∫F_1(ω) φ(z) dz with ω = σ_s z − d, and the area of each regime alike: (4,)."""
    rough, pair, heights = contact.roughness, contact.surfaces, contact.roughness.heights
    datum = contact.law_of(contact.populations[0]).centre if contact.populations else 0.0
    h = (d - datum * rough.sigma) / rough.sigma_s
    shapes = [(None, 1.0, 1.0)] if rough.ellipticity is None else rough.ellipticity.classes
    total = np.zeros(4)
    for ratio, radius, share in shapes:
        law = contact.asperity_law if ratio is None else contact.asperity_law.replace(ratio=ratio)
        tip = Tip(law, radius * rough.R, pair.E_star, pair.H, pair.softer.nu)

        def weighted_tip(z: Array, tip: Tip = tip) -> Array:
            return heights.pdf(z) * tip(rough.sigma_s * (z - h))

        starts, end = h + tip.kinks / rough.sigma_s, heights.pieces[-1]
        z = points_between(starts[0], end, [*starts, *heights.pieces])
        if len(z):  # else the surfaces are too far apart
            total += share * rough.density * integral(weighted_tip, z)
    return total


class Tip:
    """One tip pressed into a flat by ω [m]: load [N], and area [m²] under its regime, (4, ...)."""

    def __init__(self, law: AbstractAsperityLaw, R: float, E_star: float, H: float, nu: float):
        self.law = law.bound(R=R, E_star=E_star, H=H, nu=nu)
        self.omega_1 = self.law.yield_interference(R=R, E_star=E_star, H=H)
        self.unit, self.H = np.pi * R * self.omega_1, H
        self.kinks = self.omega_1 * np.array([self.law.start, *self.law.breakpoints])

    def __call__(self, omega: Numbers) -> Array:
        y = np.asarray(omega) / self.omega_1
        branch = np.searchsorted(self.law.breakpoints, y, side="right")
        regime = np.array([piece.regime for piece in self.law.branches])[branch]
        area = self.unit * self.law.reduced("area", y)
        areas = [np.where(regime == name, area, 0.0) for name in REGIMES]
        return np.stack([self.unit * self.H * self.law.reduced("force", y), *areas])


# ---------------------------------------------------------------- particles
def particles(contact: Any, some: Particles, d: float) -> Array:
    """F_sa, areas on surface 1 by regime, area on surface 2, shadow ς, of one population: (6,)."""
    law, rough = contact.law_of(some), contact.roughness
    one, two = [
        half_of(law, reduced_modulus(body, some.material), body, some.material, some.shape)
        for body in (contact.surfaces.first, contact.surfaces.second)
    ]
    eps, sides_at = squeezes(one, two), at_distinct(lambda e: solve_squeeze(one, two, e))
    width = law.zeta_std * rough.sigma if law.seat == "rough" else 0.0
    gap = d - law.h_0 if law.seat != "rough" else d + rough.y_s - law.zeta_mean * rough.sigma

    def on_plane(x: Array) -> Array:
        return x**2 * solve_squeeze(one, two, 1 - gap / x)

    def on_seats(x: Array, e: Array) -> Array:
        z = (gap - x * (1 - e)) / width
        return x**3 * np.exp(-0.5 * z**2) / (np.sqrt(2 * np.pi) * width) * sides_at(e)

    # what a particle carries no longer changes beyond eps[-1]
    def embedded_rows(x: Array) -> Array:
        z = (x * (1 - eps[-1]) - gap) / width
        return x**2 * ndtr(z) * solve_squeeze(one, two, 2 * eps[-1:] * np.ones_like(x))

    total = np.zeros(7)
    cascade = None if some.strength is None else Cascade(some, one, two)
    for share, sizes in some.diameter.components:
        if cascade:
            sums = cascade.sum_over_sizes(sizes, gap, width)
        elif width:
            sums = over_sizes(sizes, on_seats, eps.tolist()) + over_sizes(sizes, embedded_rows)
        else:
            sums = over_sizes(sizes, on_plane, splits=gap / (1 - eps[eps != 1]))
        total += share * some.areal_density * sums
    footprint, projected = total[5:]
    covered = one.full / (np.pi / 4) * some.coverage
    shadows = dict(footprint=footprint, projected=projected, covered=covered, none=0.0)
    return np.array([*total[:5], shadows[law.shadow]])


class Side(Tip):
    """Contact of a particle of size 1 with one surface; the end is the great circle or ``full``."""

    def __init__(
        self,
        law: AbstractAsperityLaw,
        R: float,
        E_star: float,
        H: float,
        nu: float,
        full: float = 0.0,
    ):
        super().__init__(law, R, E_star, H, nu)
        self.full = full or 0.5 * np.pi * R
        self.plastic = self.law.branches[-1].regime == "plastic"
        most = max(10, 4 * self.full / R)
        self.cap = brentq(lambda u: super(Side, self).__call__(u)[1:].sum() - self.full, 0, most)
        self.kinks = np.sort([*self.kinks[1:], self.cap])

    def __call__(self, delta: Numbers) -> Array:
        """As `Tip`; from the great circle on, the mean pressure alone may still rise."""
        delta = np.asarray(delta)
        out = super().__call__(delta if self.plastic else np.minimum(delta, self.cap))
        over, area = delta >= self.cap, out[1:].sum(axis=0)
        out[0] *= np.divide(self.full, area, out=np.ones_like(area), where=over)
        if self.plastic:
            out[1:, over] = [[0.0], [0.0], [self.full]]
        return out


class Faced(Side):
    r"""A rounded tip of radius r up to the contact radius b = r tan β, then faces at one pressure.

    .. math:: a = b + (\delta-\delta_j)\cot\beta/r_c, \qquad
        r_c = 1 + (\pi/2-1)(\delta_j/\delta_t-1), \qquad \delta_t = \tfrac12 r\tan^2\beta
    """

    def __init__(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, shape: Angular
    ):
        r, slope = 0.5 * shape.roundness, np.tan(shape.angle)
        super().__init__(law, r, E_star, H, nu, np.pi / 4 * shape.flatness**2)
        b = r * slope
        self.tip = super().__call__
        at = brentq(lambda u: self.tip(u)[1:].sum() - np.pi * b**2, 0, self.cap, xtol=1e-18)
        self.joint = at
        r_c = 1 + (np.pi / 2 - 1) * (self.joint / (0.5 * r * slope**2) - 1)
        self.radius = lambda u: b + (u - self.joint) / (slope * r_c)
        self.p = self.tip(self.joint)[0] / (np.pi * b**2)
        self.cap = self.joint + (shape.flatness / 2 - b) * slope * r_c
        points = [*(u for u in self.kinks if u < self.joint), self.joint, self.cap]
        self.kinks = np.sort(points)

    def __call__(self, delta: Numbers) -> Array:
        delta = np.asarray(delta, dtype=float)
        tip = self.tip(np.minimum(delta, self.joint))
        area = np.pi * self.radius(np.minimum(delta, self.cap)) ** 2
        faces = np.where(tip[1:] > 0, area, 0.0)
        if self.plastic:
            ended = np.stack([0 * area, 0 * area, area])
            faces = np.where(delta >= self.cap, ended, faces)
        return np.where(delta < self.joint, tip, np.stack([self.p * area, *faces]))


def half_of(law: Any, E_star: float, surface: Material, particle: Material, shape: Shape) -> Side:
    """Contact on one surface: squashed if the particle is round and the softer body."""
    softer = min(surface, particle, key=lambda material: material.H)
    body = E_star, softer.H, softer.nu
    if isinstance(shape, Angular):
        if shape.has_touching_faces:
            return Faced(law.law, *body, shape)
        return Side(law.law, shape.tip_radius, *body, np.pi / 4 * shape.flatness**2)
    sphere = Side(law.law, law.tip_radius, *body)
    if getattr(law, "follows_table", False) and sphere.plastic:
        return Deep(law.law, *body, particle.H / surface.H, law.friction_factor)
    if law.soft == "sphere" or not particle.H < surface.H:
        return sphere
    if law.onset == "jg":
        return SquashedOfJG(*body, surface.H, law.friction_factor)
    return Squashed(law.law, *body, surface.H, law.friction_factor) if sphere.plastic else sphere


class Squashed(Side):
    r"""Half of a soft particle of size 1 that keeps its volume on a harder surface.

    .. math:: A = \frac{\min(A_L, \pi/6)}{1-2\delta}, \qquad p = p_L\left\{1 -
        \tfrac{0.92}{2.84}[1-\cos\pi q] + \tfrac{2m}{3\sqrt3\cdot2.84}\tfrac{a}{1-2\delta}\right\}

    with q = min(1, 2a), up to where p is the hardness of the surface.
    """

    def __init__(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, most: float, m: float
    ):
        super().__init__(law, 0.5, E_star, H, nu)
        self.m, self.end = m, 0.5
        self.cap = self.first(self.over_volume)
        wide = self.first(lambda u: self.pressure_and_area(u)[1] - np.pi / 4)
        sinks = self.pressure_and_area(max(self.cap, wide))[0] < most
        u = max(self.cap, wide)
        self.end = (
            brentq(lambda u: self.pressure_and_area(u)[0] - most, u, 0.5 - 1e-9) if sinks else u
        )
        points = [*(self.omega_1 * np.array(self.law.breakpoints)), self.cap, wide, *self.more()]
        # what is left of the height falls fourfold from one to the next
        points += [0.5 - (0.5 - u) / 4**i for i in range(1, 30)]
        self.kinks = np.unique([*(u for u in points if u < self.end), self.end])

    def first(self, excess: Formula) -> float:
        """The first indentation at which this is positive."""
        u = np.linspace(0, 0.49999, 2001)[1:]
        i = int(np.argmax(excess(u) > 0))
        return brentq(excess, u[i] - u[0], u[i])

    def free(self, delta: Numbers) -> Array:
        """As a tip that knows nothing of a volume."""
        return Tip.__call__(self, delta)

    def over_volume(self, delta: Array) -> Array:
        return self.free(delta)[1:].sum(axis=0) - np.pi / 6

    def more(self) -> list[float]:
        return []

    def pressure_and_area(self, delta: Numbers) -> tuple[Array, Array]:
        """Mean pressure and area."""
        load, *areas = self.free(delta)
        area, t = np.sum(areas, axis=0), 1 - 2 * delta
        wide = np.minimum(area, np.pi / 6) / t
        a = np.sqrt(wide / np.pi)
        fall = 0.92 * (1 - np.cos(np.pi * np.minimum(1, 2 * a)))
        hill = 2 * self.m / (3 * np.sqrt(3)) * a / t
        p = np.divide(load, area, out=np.zeros_like(wide), where=area > 0)
        return p * (1 + (hill - fall) / 2.84), wide

    def __call__(self, delta: Numbers) -> Array:
        u = np.minimum(delta, self.end)
        p, area = self.pressure_and_area(u)
        areas = np.where(self.free(u)[1:] > 0, area, 0.0)
        areas = np.where(u >= self.cap, np.stack([0 * area, 0 * area, area]), areas)
        return np.stack([p * area, *areas])


class SquashedOfJG(Squashed):
    """The same from the area and load of Jackson and Green, whose hardness here ends at S_y."""

    def __init__(self, E_star: float, H: float, nu: float, most: float, m: float):
        self.S_y, self.C = H / 2.8, 1.295 * np.exp(0.736 * nu)
        super().__init__(JG(), E_star, H, nu, most, m)

    def over_volume(self, delta: Array) -> Array:
        return self.free(delta)[1:].sum(axis=0) * (1 - 2 * delta) - np.pi / 6

    def more(self) -> list[float]:
        u = np.linspace(1.9 * self.omega_1, self.end, 2001)
        off = self.bare(u) - self.S_y
        return [
            brentq(lambda u: self.bare(u) - self.S_y, u[i], u[i + 1])
            for i in np.flatnonzero(off[1:] * off[:-1] < 0)
        ]

    def area(self, delta: Numbers) -> Array:
        return np.where(
            delta < self.cap, self.free(delta)[1:].sum(axis=0), np.pi / 6 / (1 - 2 * delta)
        )

    def bare(self, delta: Numbers) -> Array:
        """Mean pressure without friction."""
        y, area = delta / self.omega_1, np.maximum(self.area(delta), 1e-300)
        H_G = 2.84 - 0.92 * (1 - np.cos(np.pi * np.minimum(1, 2 * np.sqrt(area / np.pi))))
        F_c = 2 / 3 * np.pi * 0.5 * self.omega_1 * self.C * self.S_y
        first = np.exp(-0.25 * y ** (5 / 12)) * y**1.5
        return F_c * (first + 4 / self.C * H_G * (1 - np.exp(-(y ** (5 / 9)) / 25)) * y) / area

    def pressure_and_area(self, delta: Numbers) -> tuple[Array, Array]:
        area, load = self.area(delta), self.free(delta)[0]
        elastic = np.divide(load, area, out=np.zeros_like(area), where=area > 0)
        p = np.where(delta < 1.9 * self.omega_1, elastic, np.maximum(self.bare(delta), self.S_y))
        hill = 2 * self.m / (3 * np.sqrt(3)) * np.sqrt(area / np.pi) / (1 - 2 * delta)
        return p + hill * self.S_y, area


class Deep(Side):
    r"""Half of a particle of size 1 that follows the computed curves.

    .. math:: F = F_L^{1-w} F_T^{\,w}, \qquad A = A_L^{1-w} A_T^{\,w}, \qquad w = u^2(3-2u)

    from ε = 0.05 (u = 0) to 0.15 (u = 1) of its radius; beyond 0.95 a disc of constant volume, up
    to where its mean pressure is the hardness of the surface.
    """

    def __init__(
        self, law: AbstractAsperityLaw, E_star: float, H: float, nu: float, ratio: float, m: float
    ):
        super().__init__(law, 0.5, E_star, H, nu)
        self.tables = [series_of(name, ratio, m, E_star / H) for name in ("own", "area")]
        self.hill, self.end, self.particle_share = m / (3 * np.sqrt(3)), 0.475, own_part(ratio, m)
        most, v_0 = H * max(1.0, 1 / ratio), np.log(1 - 0.95 * self.particle_share)
        if self.disc(v_0)[0] < most:
            lean = -30.0
            if self.particle_share and self.disc(lean)[0] > most:
                lean = brentq(lambda v: self.disc(v)[0] - most, -30, v_0, xtol=1e-15)
            self.end = (
                0.5 * min(-np.expm1(lean) / self.particle_share, 0.999)
                if self.particle_share
                else 0.4995
            )
        elif ratio < 1:  # the softest were squeezed between rigid surfaces
            over = lambda u: np.divide(*self.table(np.array(u))) - most  # noqa: E731
            self.end = brentq(over, 0.375, 0.475, xtol=1e-16) if over(0.375) < 0 else 0.375
        self.cap = 0.075
        wide = np.linspace(self.cap, self.end, 400)
        i = int(np.argmax(self.area(wide) > np.pi / 4))
        points = [0.025, 0.075, 0.225, 0.375, 0.44, 0.475, self.end]
        if i:
            off = lambda u: self.area(u) - np.pi / 4  # noqa: E731
            points.append(brentq(off, wide[i - 1], wide[i], xtol=1e-16))
        points += [u for u in self.omega_1 * np.array(self.law.breakpoints) if u < self.cap]
        if self.particle_share:
            points += [(0.5 - np.exp(v_0) / 2 / 4**i) / self.particle_share for i in range(1, 25)]
        self.kinks = np.unique([u for u in points if u <= self.end])

    def table(self, delta: Array) -> tuple[Array, Array]:
        """Load and area of the curves."""
        at = place(np.clip(2 * delta, 0.05, 0.95))
        load, area = (np.exp(series(at)) for series in self.tables)
        return load * self.H / 2.84 / 4, area * np.pi / 4

    def disc(self, log_t: Numbers) -> tuple[Array, Array]:
        """Mean pressure and area beyond the curves, of a half as high as t radii."""
        load, area = self.table(np.array(0.475))
        t, thick = np.exp(log_t), 1 - 0.95 * self.particle_share
        rise = lambda area, t: 1 + self.hill * np.sqrt(area / (np.pi / 4)) / t  # noqa: E731
        return load / area * rise(area * thick / t, t) / rise(area, thick), area * thick / t

    def area(self, delta: Numbers) -> Array:
        return self(delta)[1:].sum(axis=0)

    def __call__(self, delta: Numbers) -> Array:
        u = np.minimum(np.asarray(delta, dtype=float), self.end)
        tip, (load, area) = Tip.__call__(self, u), self.table(u)
        v = np.clip(np.log(np.maximum(u, 1e-300) / 0.025) / np.log(3.0), 0.0, 1.0)
        w = v**2 * (3 - 2 * v)
        bare = np.maximum(tip[1:].sum(axis=0), 1e-300)
        blended = np.maximum(tip[0], 1e-300) ** (1 - w) * load**w, bare ** (1 - w) * area**w
        p, wide = self.disc(np.log1p(-2 * self.particle_share * u))
        load = np.where(w == 0, tip[0], np.where(u > 0.475, p * wide, blended[0]))
        area = np.where(w == 0, tip[1:].sum(axis=0), np.where(u > 0.475, wide, blended[1]))
        areas = np.where(tip[1:] > 0, area, 0.0)
        plastic = np.stack([0 * area, 0 * area, area])
        return np.stack([load, *np.where(u >= self.cap, plastic, areas)])


def own_part(ratio: float, m: float) -> float:
    """Part of a squeeze of 0.95 that the particle takes: 1 less the sink over the squeeze.

    Sinks, in straight lines over ln ρ, never fall with the squeeze, nor rise faster than it.
    """
    rigid = [run for run in runs_of_the_table() if run["soft"] == 0]
    factors, rows = sorted({run["m"] for run in rigid}), []
    for f in factors:
        x, sink_rows = zip(*sorted((r["x"], r["sink"]) for r in rigid if r["m"] == f), strict=True)
        rows.append(
            np.array([np.interp(np.log(ratio), x, at) for at in zip(*sink_rows, strict=True)])
        )
    sinks = interpolate_rows(m, factors, rows)
    for i in range(1, 19):
        sinks[i] = min(max(sinks[i], sinks[i - 1]), sinks[i - 1] + 0.05)
    share = 1 - sinks[-1] / 0.95
    return share if share > 1e-3 else 0.0


def place(eps: Numbers, low: float = 0.05, high: float = 0.95) -> Array:
    """Where ln ε/(1 − ε) lies between that of two squeezes, as −1 and 1."""
    at, first, last = (np.log(e / (1 - e)) for e in (eps, low, high))
    return (2 * at - first - last) / (last - first)


def runs_of_the_table() -> list[dict[str, Any]]:
    """The computed curves between two surfaces."""
    text = resources.files("thirdbody").joinpath("data/deep_series.json").read_text("utf-8")
    runs = [run for run in json.loads(text)["curves"] if run["surfaces"] == 2]
    for run in runs:
        rho, E_over_Y = float(run["rho"]), float(run["E_over_Y"])
        body = 1 if rho in (0, np.inf) else 2
        run |= {"rho": rho, "x": np.log(np.clip(rho, 0.4, 10.0))}
        run["soft"] = 2.84 * (min(rho, 1.0) or 1.0) * 0.91 * body / E_over_Y
    return runs


def interpolate_rows(at: float, nodes: Iterable[float], rows: Iterable[Array]) -> Array:
    """Rows between nodes, by a monotone cubic."""
    x, y = np.array(list(nodes)), np.array(list(rows))
    x, y = x[order := np.argsort(x)], y[order]
    return y[0] if len(x) == 1 else PchipInterpolator(x, y, axis=0)(np.clip(at, x[0], x[-1]))


def series_of(name: str, ratio: float, m: float, kappa: float) -> Chebyshev:
    """ln F/(Y R²), Y of the softer body, or ln A/(πR²), between the computed runs.

    First value and roots of the slope go by monotone cubics over ln ρ and m and in straight lines
    over H/E*; ten terms of the root, squared and summed up, give a polynomial that never falls.
    """
    runs = runs_of_the_table()
    x, soft = np.log(np.clip(ratio, 0.4, 10.0)), 1 / max(kappa, 8.0)
    rigid = [run for run in runs if run["soft"] == 0]

    def row(run: dict[str, Any], eps: Array) -> Array:
        step = place(0.95, run["from"], run["to"]) - place(0.05, run["from"], run["to"])
        root = Chebyshev(run[name]["root"])(place(eps, run["from"], run["to"]))
        shifted = name == "own" and run["rho"] not in (0, np.inf)
        first = run[name]["first"] - (np.log(min(run["rho"], 1.0)) if shifted else 0.0)
        inside = eps <= run["to"] * (1 + 1e-9)
        return np.append(first, np.where(inside, root * np.sqrt(step / 2), 0.0))

    def change(run: dict[str, Any], eps: Array) -> Array:
        twin = next(it for it in rigid if (it["m"], it["rho"]) == (1, run["rho"]))
        shorter = min(run["to"], twin["to"]) * (1 + 1e-9)
        return (row(run, eps) - row(twin, eps)) * np.append(1.0, eps <= shorter)

    def over_hardness(some: list[dict[str, Any]], of: Callable[[dict[str, Any]], Array]) -> Array:
        return interpolate_rows(x, [run["x"] for run in some], [of(run) for run in some])

    def values(s: Array) -> Array:
        eps = 1 / (1 + np.exp(-np.log(19.0) * s))
        out = over_hardness([run for run in rigid if run["m"] == 1], lambda run: row(run, eps))
        factors = sorted({run["m"] for run in rigid})
        out = out + interpolate_rows(m, factors, [
            over_hardness([run for run in rigid if run["m"] == f], lambda run: change(run, eps))
            for f in factors
        ])  # fmt: skip
        elastic = [run for run in runs if run["soft"] > 0]
        nodes = sorted({run["x"] for run in elastic})
        some = [[run for run in elastic if run["x"] == node] for node in nodes]
        slopes = [
            interpolate_rows(
                soft, [it["soft"] for it in here], [change(it, eps) / it["soft"] for it in here]
            )
            for here in some
        ]
        return out + soft * interpolate_rows(x, nodes, slopes)

    root = Chebyshev.interpolate(lambda s: values(s)[1:], 9)
    return (root * root).integ(lbnd=-1) + values(np.zeros(1))[0]


def solve_squeeze(one: Side, two: Side, eps: Array) -> Array:
    """A particle of size 1 squeezed by ε: both sides carry one load, F_1(δ_1) = F_2(ε − δ_1).

    Load, area on side 1 by regime, area on side 2, the larger of both, projected area: (7, ...).
    """
    e = np.maximum(eps, 1e-300)
    share = find_root(
        lambda share, e: one(share * e)[0] - two((1 - share) * e)[0], (0 * e, 0 * e + 1), args=(e,)
    ).x
    first, second = one(share * e), two((1 - share) * e)
    a, b = first[1:].sum(axis=0), second[1:].sum(axis=0)
    load, footprint = np.minimum(first[0], second[0]), np.maximum(a, b)
    rows = np.stack([load, *first[1:], b, footprint, np.maximum(footprint, one.full)])
    return np.where(np.asarray(eps) > 0, rows, 0.0)


def squeezes(one: Side, two: Side) -> Array:
    """Increasing ε at which a side changes its formula, from 0 to where nothing changes more."""
    out = [0.0]
    for side, other in ((one, two), (two, one)):
        end = other.kinks[-1]
        most = other(end)[0]
        for delta, load in zip(side.kinks, side(side.kinks)[0], strict=True):
            if abs(load / most - 1) < 1e-12:
                out.append(delta + end)
            elif load < most:
                out.append(delta + brentq(_excess, 0, end, args=(other, load), xtol=1e-18))
    return np.unique(out)


def _excess(delta: float, side: Side, load: float) -> float:
    return side(delta)[0] - load


# ---------------------------------------------------------------- particles that break
class Cascade:
    r"""Particles that break as a gap g closes, and their pieces of κ times the size.

    .. math:: \bar f(x, g) = \sum_k N_k S_k P_k f(\kappa^k x, g), \qquad
        P = \exp[-(\hat\sigma/\sigma_x)^m], \quad S_k = \prod_{j<k}(1-P_j), \quad
        N_k = (\chi\kappa^{-3})^k

    with the largest tension :math:`\hat\sigma` on the way down.
    """

    def __init__(self, some: Particles, one: Side, two: Side):
        assert some.strength is not None
        self.strength, self.nu, self.one, self.two = some.strength, some.material.nu, one, two
        self.x_c = some.strength.least(some.material)
        self.eps = squeezes(one, two)[1:]
        # where the tension is larger than before and after
        grid = np.unique([*np.geomspace(1e-3 * self.eps[0], self.eps[-1], 4000), *self.eps])
        now = self.tension(grid)
        tops = np.flatnonzero((now[1:-1] > now[:-2]) & (now[1:-1] >= now[2:])) + 1
        maxima = [minimize_scalar(
            lambda e: -self.tension(e), bounds=(grid[i - 1], grid[i + 1]), method="bounded",
            options={"xatol": 1e-14},
        ).x for i in tops]  # fmt: skip
        self.tops = np.unique([*maxima, *self.eps])

    def tension(self, eps: Array) -> Array:
        """σ_t of a particle of size 1 [Pa]."""
        load, *areas, second = solve_squeeze(self.one, self.two, eps)[:5]
        if self.strength.confinement == "none":
            return load
        s = [np.minimum(2 * np.sqrt(a / np.pi), 1.0) for a in (np.sum(areas, axis=0), second)]
        return load * 0.5 * (confined_tension(s[0], self.nu) + confined_tension(s[1], self.nu))

    def survival(self, x: Array, eps: Array) -> Array:
        """P_s of particles of sizes x [m] that are squeezed by ε."""
        eps = np.minimum(eps, self.eps[-1])
        before = np.where(self.tops <= eps[..., None], self.tension(self.tops), 0.0).max(axis=-1)
        met = np.maximum(self.tension(eps), before)
        broken = (met / self.strength.of_size(x)) ** self.strength.m
        return np.where(x <= self.x_c, 1.0, np.exp(-broken))

    def __call__(self, x: Array, gap: Numbers) -> Array:
        """Seven sums over what has become of a particle of size x in a gap [m]: (7, ...)."""
        x, gap = np.broadcast_arrays(np.asarray(x, float), np.asarray(gap, float))
        total, number = np.zeros((7, *x.shape)), np.ones(x.shape)
        while np.any(number * x**2 * (x > gap) > 1e-16 * np.max(x) ** 2 * 1e-3):
            eps = np.maximum(1 - gap / x, 0.0)
            survival = self.survival(x, eps)
            total += number * survival * x**2 * solve_squeeze(self.one, self.two, eps)
            number = number * (1 - survival) * self.strength.bearing_share * self.strength.ratio**-3
            number, x = np.where(x > gap, number, 0.0), x * self.strength.ratio
        return total

    def sum_over_sizes(self, sizes: Distribution, gap: float, width: float) -> Array:
        """Over the sizes, and over seats of a width where there is one."""
        k = self.strength.ratio ** np.arange(12)
        ends = np.array([1.0, *(1 - self.tops)])
        if not width:
            splits = [*(gap / np.outer(ends[ends > 0], k)).ravel(), *(self.x_c / k)]
            return over_sizes(sizes, lambda x: self(x, gap), splits=splits)
        x = np.array([sizes.support[1], *sizes.support])[:, None, None]
        z = ((x * np.outer(ends, k) - gap) / width).ravel()
        weigh = lambda z: np.exp(-0.5 * z**2) / np.sqrt(2 * np.pi)  # noqa: E731
        seats = points_between(-9.0, 9.0, z)
        return over_sizes(sizes, lambda x, z: weigh(z) * self(x, gap + width * z), seats)


# ---------------------------------------------------------------- integrals
def over_sizes(
    sizes: Distribution,
    f: Callable[..., Array],
    *edges: Sequence[float],
    splits: Iterable[float] = (),
) -> Array:
    """∫φ_a(x) f(x, ...) dx and over the other variables."""
    if isinstance(sizes, Monodisperse):
        return integral(lambda *others: f(np.array([sizes.mean]), *others), *edges)
    low, high = sizes.support
    x = points_between(low, high, [*sizes.pieces, *splits])
    return integral(lambda x, *others: sizes.pdf(x) * f(x, *others), x, *edges)


def integral(f: Callable[..., Array], *edges: Sequence[float]) -> Array:
    """∫f over the boxes between increasing edges, one sequence a variable; f gives (m, points)."""
    if not edges:
        return f()[:, 0]
    boxes = [
        tuple(zip(*box, strict=True)) for box in itertools.product(*map(itertools.pairwise, edges))
    ]

    values: dict[bytes, Array] = {}

    def values_at(v: Array) -> Array:
        """f, which both passes ask for at the points of every box."""
        if (key := v.tobytes()) not in values:
            values[key] = f(*v.T).T
        return values[key]

    def total(f: Formula, rtol: float, atol: float) -> Array:
        return sum(cubature(f, *box, rtol=rtol, atol=atol).estimate for box in boxes)

    size = np.abs(total(values_at, 0.1, 0.0))
    size[size == 0] = 1.0
    return size * total(lambda v: values_at(v) / size, 1e-11, 1e-12)


def at_distinct(f: Formula) -> Formula:
    """Values of f at the distinct coordinates only, for rows of points that share them."""
    values: dict[bytes, Array] = {}

    def values_at(v: Array) -> Array:
        distinct, back = np.unique(v, return_inverse=True)
        if (key := distinct.tobytes()) not in values:
            values[key] = f(distinct)
        return values[key][:, back]

    return values_at


def points_between(low: float, high: float, points: Iterable[float]) -> Sequence[float]:
    """The distinct points from low to high, both ends among them; none where low is above high."""
    return sorted({low, *(p for p in points if low < p < high), high}) if low < high else []
