r"""Rough bodies of finite size: Greenwood and Tripp's sphere, and the cylinder.

A smooth elastic half-space and a body of radius B with a rough skin; whatever the skin is (bare
asperities of any law, particles between them), it is a pressure that depends on the local gap,

.. math:: p(r) = F_t(u(r)), \qquad u(r) = d + \frac{r^2}{2B} + w(r),

and the elastic displacement w follows from the pressure. The ring kernel of a sphere,

.. math:: w(r) = \frac{4}{\pi E^*}\int p(s)\,\frac{s}{r+s}\,K(m)\,ds, \quad m = \frac{4rs}{(r+s)^2},

is singular at s = r, but equals two smooth integrals, which is what is discretised here:

.. math:: w(r) = \frac{2}{\pi E^*}\int_0^{\pi/2} q(r\sin\theta)\,d\theta, \qquad
          q(x) = 2\int_0^\infty p\left(\sqrt{x^2+y^2}\right)dy .

The pressure is an even Chebyshev series; the balance is solved by Newton's method. The number of
nodes grows until the series has converged.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from .contact import Contact, interface
from .equilibrium import DEEPEST
from .errors import InvalidValue, NoEquilibrium
from .numerics import gauss_legendre

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["RoughBody", "curve", "rough_cylinder", "rough_sphere"]

NEGLIGIBLE = 1e-17
"""Pressure, over the largest, at which the contact is cut off."""
TAIL, COARSE = 1e-12, 1e-5
"""Size of the last coefficients of the pressure, over the largest, that counts as converged: in
the end, and while the separation is still being sought."""
TENSILE = "the pressure is tensile somewhere: strong adhesion is not covered here"
NODES = (40, 60, 90, 135, 200, 300, 450)


# ------------------------------------------------------------------------------ the skin
class Skin:
    """A pressure law p(u) [Pa] with its slope, and where it may be used.

    Made of a `Contact`, or of a callable ``pressure(gap) -> (p, dp/dgap)`` over arrays with E*.
    Below ``floor`` (−3 σ_s) the law of a contact is continued by its tangent, so that iterates
    may pass there; a solution may not.
    """

    def __init__(self, source: Contact | Callable[..., Any], E_star: float | None):
        self.bound = None
        self.floor = -math.inf
        self.origin, self.step = 0.0, None
        self.warnings: tuple[str, ...] = ()
        if isinstance(source, Contact):
            if E_star is not None:
                raise InvalidValue("E_star follows from the contact; give it only with a callable")
            self.bound = interface(source)
            self.E_star = source.E_ss
            skin = self.bound.asperities
            self.floor = self.origin = skin.centre + DEEPEST * skin.sigma_s
            self.step = skin.sigma_s
            bottom = self.bound.load(np.array([self.floor]))[0]
            self.lowest = (float(bottom[0]), float(bottom[1]))
            if not self.bound.monotone:
                self.warnings = (
                    "the load of this contact does not fall everywhere with the gap: the "
                    "solution found need not be the only one",
                )
        elif callable(source):
            if E_star is None or not E_star > 0:
                raise InvalidValue(f"E_star = {E_star!r} must be > 0 [Pa] with a pressure law")
            self.E_star, self.law = float(E_star), source
        else:
            raise InvalidValue(f"{source!r} must be a Contact or a pressure law")

    def __call__(self, gap: Array) -> tuple[Array, Array]:
        """Pressure [Pa] and its slope [Pa/m]."""
        if self.bound is None:
            p, slope = self.law(gap)
            return np.asarray(p, dtype=float), np.asarray(slope, dtype=float)
        p, slope, _ = self.bound.load(np.maximum(gap, self.floor)).T
        if np.any(deep := gap < self.floor):
            value, tangent = self.lowest
            p = np.where(deep, value + tangent * (gap - self.floor), p)
            slope = np.where(deep, tangent, slope)
        return p, slope

    def one(self, gap: float) -> tuple[float, float]:
        p, slope = self(np.array([gap]))
        return float(p[0]), float(slope[0])

    def cut(self, gap: float) -> float:
        """Gap at which the pressure is negligible beside that at ``gap``."""
        p, slope = self.one(gap)
        if p < 0:
            raise InvalidValue(TENSILE)
        if not (p > 0 and slope < 0):
            raise NoEquilibrium(f"no contact at a gap of {gap:.4g} m")
        step = low = 0.0
        high = p / -slope
        while self.one(gap + high)[0] > NEGLIGIBLE * p:
            low, high = high, 1.7 * high
        for _ in range(12):
            step = 0.5 * (low + high)
            low, high = (step, high) if self.one(gap + step)[0] > NEGLIGIBLE * p else (low, step)
        return gap + high


# ------------------------------------------------------------------------------ the shapes
class Grid(NamedTuple):
    """Nodes of one discretised shape; values on them are a Chebyshev series in cos θ_j."""

    x: Array
    """Positions [m]."""
    base: Array
    """Gap of the undeformed shape [m]."""
    compliance: Array
    """Displacement [m] by pressure [Pa]."""
    weights: Array
    """Sum to the load."""


class Shape(Protocol):
    def extent(self, skin: Skin, d: float) -> float:
        """Half-width [m] beyond which the skin cannot touch at the separation d [m]."""

    def grid(self, n: int, extent: float) -> Grid:
        """Grid of n nodes."""


@lru_cache(maxsize=16)
def to_series(n: int) -> tuple[Array, Array]:
    """cos θ at the n Chebyshev nodes, and the matrix from values there to coefficients."""
    theta = np.pi * (np.arange(n) + 0.5) / n
    transform = 2 / n * np.cos(np.arange(n)[:, None] * theta)
    transform[0] *= 0.5
    return np.cos(theta), transform


def _sums(s: Array, weights: Array, n: int) -> Array:
    """Σ_m w_m T_k(s_jm) for k < n: (J, n)."""
    out = np.empty((len(s), n))
    before, now = np.ones_like(s), s
    for k in range(n):
        out[:, k] = before @ weights
        before, now = now, 2 * s * now - before
    return out


@lru_cache(maxsize=16)
def _ring_compliance(n: int) -> tuple[Array, Array, Array]:
    """Nodes r < 1, compliance of a half-space with E* = 1, and weights of ∫2πr dr."""
    s, transform = to_series(n)
    r = np.sqrt(0.5 * (1 + s))
    nodes, weights = gauss_legendre(n + 1)
    chord = np.sqrt(0.5 * (1 - s))
    y = 0.5 * chord[:, None] * (1 + nodes)
    q = chord[:, None] * _sums(2 * (r[:, None] ** 2 + y**2) - 1, weights, n) @ transform
    sine = np.sin(0.5 * np.pi * (np.arange(n) + 0.5) / n)
    mean = _sums(2 * (r[:, None] * sine) ** 2 - 1, np.full(n, 1 / n), n)
    k = np.arange(0, n, 2)
    moments = 0.5 * math.pi * (2 / (1.0 - k**2)) @ transform[::2]
    return r, mean @ transform @ q, moments


def _line_potential(x: Array, n: int) -> Array:
    """−∫p(s) ln|x − s| ds over [−1, 1] from values of an even p at the positive nodes: (N, n)."""
    t = np.cos(0.5 * np.pi * (np.arange(n) + 0.5) / n)
    k = 2 * np.arange(n)
    series = 2 / n * np.cos(k[:, None] * np.arccos(t)) * np.sqrt(1 - t * t)
    series[0] *= 0.5
    x = np.abs(x)[:, None]
    inside = np.cos(k * np.arccos(np.minimum(x, 1.0)))
    z = np.maximum(x, 1.0) + np.sqrt(np.maximum(x, 1.0) ** 2 - 1)
    basis = np.where(x <= 1, inside, z ** (-1.0 * k))
    basis[:, 1:] *= math.pi / k[1:]
    basis[:, 0] = math.pi * (math.log(2) - np.log(z[:, 0]))
    return basis @ series


def _line_weights(n: int) -> Array:
    """Weights of ∫_0^1 f dt at the positive nodes, for an even f that vanishes at 1."""
    t = np.cos(0.5 * np.pi * (np.arange(n) + 0.5) / n)
    return 0.5 * np.pi / n * np.sqrt(1 - t * t)


def _values(series: Array, n: int) -> Array:
    """A Chebyshev series on n nodes."""
    theta = np.pi * (np.arange(n) + 0.5) / n
    return np.cos(theta[:, None] * np.arange(len(series))) @ series


@dataclass(frozen=True, slots=True)
class Sphere:
    """A paraboloid of radius B on a half-space."""

    radius: float
    E_star: float

    def extent(self, skin: Skin, d: float) -> float:
        return math.sqrt(2 * self.radius * (skin.cut(max(d, skin.floor)) - d))

    def grid(self, n: int, extent: float) -> Grid:
        r, compliance, weights = _ring_compliance(n)
        base = (extent * r) ** 2 / (2 * self.radius)
        return Grid(extent * r, base, compliance * (extent / self.E_star), extent**2 * weights)

    def hertz(self, load: float) -> tuple[float, float]:
        """Contact radius [m] and largest pressure [Pa] of the smooth body."""
        a = (0.75 * load * self.radius / self.E_star) ** (1 / 3)
        return a, 2 * self.E_star * a / (math.pi * self.radius)


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A parabolic cylinder of radius B on a half-space; w = 0 at the reference point."""

    radius: float
    E_star: float
    reference: float

    def extent(self, skin: Skin, d: float) -> float:
        return math.sqrt(2 * self.radius * (skin.cut(max(d, skin.floor)) - d))

    def grid(self, n: int, extent: float) -> Grid:
        x = extent * np.sqrt(0.5 * (1 + to_series(n)[0]))
        points = np.append(x, self.reference) / extent
        potential = _line_potential(points, n)
        compliance = 2 * extent / (math.pi * self.E_star) * (potential[:-1] - potential[-1])
        weights = 2 * extent * _line_weights(n)
        return Grid(x, x * x / (2 * self.radius), compliance, weights)

    def hertz(self, load: float) -> tuple[float, float]:
        """Contact half-width [m] and largest pressure [Pa] of the smooth body."""
        a = math.sqrt(4 * load * self.radius / (math.pi * self.E_star))
        return a, 0.5 * self.E_star * a / self.radius


# ------------------------------------------------------------------------------ the solver
class Balance(NamedTuple):
    """A solved grid."""

    d: float
    grid: Grid
    gap: Array
    pressure: Array
    load: float
    slope: float
    """d(load)/dd"""
    tail: float
    """Last coefficients of the pressure over the largest."""
    residual: float
    """Largest error of the gap equation [m]."""
    extent: float = 0.0
    """Half-width of the grid [m]."""
    series: Array = np.zeros(0)
    """Chebyshev series of the displacement [m]."""


def _newton(skin: Skin, grid: Grid, d: float, sunk: Array) -> tuple[Array, Array, Array, float]:
    """Gap, pressure, slope of pressure and residual [m] by Newton's method, damped.

    ``sunk`` is a first guess of the displacement [m].
    """
    base = d + grid.base
    gap = np.maximum(base + sunk, skin.floor)
    p, slope = skin(gap)
    error = gap - base - grid.compliance @ p
    close = 0
    eye = np.eye(len(gap))
    for _ in range(200):
        step = np.linalg.solve(eye - grid.compliance * slope, -error)
        scale = np.max(np.abs(p)) / max(np.max(np.abs(slope)), 1e-300)
        close += bool(np.max(np.abs(step)) < 1e-7 * scale)
        part, size = 1.0, np.max(np.abs(error))
        while True:
            trial = gap + part * step
            p, slope = skin(trial)
            error = trial - base - grid.compliance @ p
            if close or np.max(np.abs(error)) < size or part < 1e-4:
                break
            part *= 0.5
        gap = trial
        if close == 2 or size == 0:
            return gap, p, slope, float(np.max(np.abs(error)))
    raise NoEquilibrium(f"the gap equation did not converge at d = {d:.6g} m")


def balance_at(
    skin: Skin, shape: Shape, d: float, near: Balance | None = None, tolerance: float = TAIL
) -> Balance:
    """The balance at one approach d [m], on the grid of a state ``near`` it or a finer one."""
    extent = shape.extent(skin, d) if near is None else near.extent
    first = 0 if near is None else NODES.index(len(near.gap))
    series = np.zeros(1) if near is None else near.series
    shrunk = near is not None
    while True:
        n = NODES[first]
        grid = shape.grid(n, extent)
        gap, p, slope, residual = _newton(skin, grid, d, _values(series, n))
        if np.min(p) < 0:
            raise InvalidValue(TENSILE)
        if not np.max(p) > 0:
            raise NoEquilibrium(f"no contact at a separation of {d:.4g} m")
        beyond = grid.x[p < NEGLIGIBLE * np.max(p)]
        if not shrunk and len(beyond) and np.min(beyond) < 0.95 * extent:
            shrunk, extent, series = True, float(np.min(beyond)), np.zeros(1)
            continue
        size = np.abs(to_series(n)[1] @ p)
        tail = float(np.max(size[-3:]) / np.max(size))
        series = to_series(n)[1] @ (gap - d - grid.base)
        if tail < tolerance or first == len(NODES) - 1:
            break
        first += 1
    if tolerance == TAIL and np.min(gap) < skin.floor:
        raise NoEquilibrium(
            f"the local gap falls to {np.min(gap):.4g} m, below the {skin.floor:.4g} m "
            f"({DEEPEST:g} sigma_s) at which every asperity is in contact"
        )
    sinking = np.linalg.solve(np.eye(n) - grid.compliance * slope, np.ones(n))
    load, rate = float(grid.weights @ p), float(grid.weights @ (slope * sinking))
    return Balance(d, grid, gap, p, load, rate, tail, residual, extent, series)


def balance(
    skin: Skin,
    shape: Shape,
    *,
    d: float | None,
    load: float | None,
    guess: float | None = None,
) -> Balance:
    """The balance at an approach or under a load; ``guess`` is an approach to start from."""
    if (d is None) == (load is None):
        raise InvalidValue("give exactly one of the separation d and the load")
    given = d if load is None else load
    if given is None or not math.isfinite(given) or (load is not None and load <= 0):
        raise InvalidValue(f"{given!r} must be finite, a load > 0")
    if load is None:
        return balance_at(skin, shape, given)
    d = _rigid(skin, shape, given) if guess is None else guess
    coarse = _seek(skin, shape, given, d, None, COARSE, 1e-5)
    return _seek(skin, shape, given, coarse.d, coarse, TAIL, 1e-14)


def _seek(
    skin: Skin,
    shape: Shape,
    load: float,
    d: float,
    near: Balance | None,
    tolerance: float,
    enough: float,
) -> Balance:
    """Newton's method on ln(load) from d, inside the bracket found on the way.

    On the grid of ``near``, if that is given, so that the load is a smooth function of d.
    """
    low, high = -math.inf, math.inf
    best, least = None, math.inf
    for _ in range(100):
        state = balance_at(skin, shape, d, near, tolerance)
        if near is not None:
            near = state
        miss = math.log(state.load / load)
        if abs(miss) < least:
            best, least = state, abs(miss)
        elif best is not None and abs(miss) < 1e-10:
            return best
        if abs(miss) < enough:
            return state
        low, high = (d, high) if miss > 0 else (low, d)
        trial = d - miss * state.load / state.slope
        if not low < trial < high:
            if math.isinf(low) or math.isinf(high):
                raise NoEquilibrium("the load does not fall with the separation")
            trial = 0.5 * (low + high)
            if best is not None and trial in (low, high):
                return best
        d = trial
    raise NoEquilibrium(f"no separation found for the load {load:.6g}")


def _rigid(skin: Skin, shape: Shape, load: float) -> float:
    """Separation at which the undeformed shape would carry the load, roughly."""

    def carried(d: float) -> float:
        try:
            extent = shape.extent(skin, d)
        except NoEquilibrium:
            return 0.0
        grid = shape.grid(NODES[0], extent)
        return float(grid.weights @ skin(d + grid.base)[0])

    low = high = skin.origin
    step = skin.step
    if step is None:
        p, slope = skin.one(low)
        step = p / -slope
    width = step
    while carried(high) > load:
        high, width = high + width, 1.5 * width
    width = step
    while carried(low) < load:
        low, width = low - width, 1.5 * width
    while high - low > 0.05 * step:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if carried(middle) > load else (low, middle)
    return high


# ------------------------------------------------------------------------------ results
@dataclass(frozen=True, slots=True, kw_only=True)
class RoughBody:
    """A solved rough sphere, or a rough cylinder per metre of length.

    Made by `rough_sphere` and `rough_cylinder`, where accuracy and source stand.

    Attributes
    ----------
    shape : str
        "sphere" or "cylinder".
    radius, d : float
        B [m]; separation d [m] of the undeformed body at its axis from the mean asperity height,
        negative when it has approached beyond first contact.
    load : float
        F [N], or [N/m] for the cylinder.
    stiffness : float
        −dF/dd [N/m], or [N/m²] for the cylinder (there it depends on the reference point).
    r, gap, pressure : array
        Distance from the axis [m], increasing; local separation u [m] and pressure p [Pa].
    peak_pressure, axis_gap : float
        p and u at the axis [Pa], [m].
    a_eff : float
        Effective contact radius 3π∫pr dr / 4∫p dr [m]; without roughness the Hertz radius.
    a_hertz, p_hertz : float
        Nominal contact radius (half-width) [m] and largest pressure [Pa] of smooth bodies under
        the same load.
    real_area : float or None
        Real contact area [m²], or [m²/m]; None for a plain pressure law.
    particle_load_share : float or None
        Load of the particles over the total load [1].
    resolution, residual : float
        Last coefficients of the pressure over the largest [1], largest error of the gap [m].
    warnings : tuple of str
        Where the body leaves the range of the model.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ball = rough_sphere(contact, radius=5e-3, load=10.0)
    >>> ball.shape, ball.peak_pressure < ball.p_hertz, ball.a_eff > ball.a_hertz
    ('sphere', True, True)
    """

    shape: str
    radius: float
    d: float
    load: float
    stiffness: float
    r: Array
    gap: Array
    pressure: Array
    peak_pressure: float
    axis_gap: float
    a_eff: float
    a_hertz: float
    p_hertz: float
    real_area: float | None
    particle_load_share: float | None
    resolution: float
    residual: float
    warnings: tuple[str, ...] = ()


def _result(skin: Skin, shape: Sphere | Cylinder, state: Balance) -> RoughBody:
    grid, p = state.grid, state.pressure
    n = len(p)
    line = state.extent * _line_weights(n)
    ring = state.extent**2 * _ring_compliance(n)[2] / (2 * math.pi)
    axis = (-1.0) ** np.arange(n) @ to_series(n)[1]
    axis_gap = state.d + float(axis @ (grid.compliance @ p))
    area = share = None
    if skin.bound is not None:
        fields_ = skin.bound.fields(state.gap)
        area = float(grid.weights @ fields_["A_t"])
        share = float(grid.weights @ fields_["F_sa"]) / state.load
    a_hertz, p_hertz = shape.hertz(state.load)
    notes = skin.warnings
    if state.tail > 1e-6:
        notes += (f"the pressure is resolved to {state.tail:.1g} only: its edge is very sharp",)
    return RoughBody(
        shape=type(shape).__name__.lower(),
        radius=shape.radius,
        d=state.d,
        load=state.load,
        stiffness=-state.slope,
        r=grid.x[::-1],
        gap=state.gap[::-1],
        pressure=p[::-1],
        peak_pressure=skin.one(axis_gap)[0],
        axis_gap=axis_gap,
        a_eff=0.75 * math.pi * float(ring @ p) / float(line @ p),
        a_hertz=a_hertz,
        p_hertz=p_hertz,
        real_area=area,
        particle_load_share=share,
        resolution=state.tail,
        residual=state.residual,
        warnings=notes,
    )


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0):
        raise InvalidValue(f"{name} = {value!r} must be > 0 [m]")
    return float(value)


def rough_sphere(
    contact: Contact | Callable[..., Any],
    *,
    radius: float,
    d: float | None = None,
    load: float | None = None,
    E_star: float | None = None,
    guess: float | None = None,
) -> RoughBody:
    r"""A rough sphere on a flat after Greenwood and Tripp, for any contact.

    Parameters
    ----------
    contact : Contact or callable
        The rough skin, particles included; or ``pressure(gap) -> (p, dp/dgap)`` over arrays
        [m] -> [Pa], [Pa/m], falling with the gap.
    radius : float
        B [m], 1/B = 1/B_1 + 1/B_2; large against the contact and every asperity radius.
    d : float, optional
        Separation at the axis without deformation [m]; negative when pressed together.
    load : float, optional
        F [N]. Exactly one of ``d`` and ``load``.
    E_star : float, optional
        Contact modulus of the bodies [Pa], with a callable only.
    guess : float, optional
        A separation [m] to start from when the load is given.

    Returns
    -------
    RoughBody

    Raises
    ------
    NoEquilibrium
        The local gap would fall below −3 σ_s.

    Notes
    -----
    Lengths along the flat scale with √(2Bσ), the pressure with E*√(σ/8B); a contact of GW
    asperities depends only on d/σ and μ = (8/3)ησ√(2BR). Where the load is large the pressure
    tends to that of Hertz, where it is small it is proportional to μ.

    Provenance: kernel seen in Johnson 1985; smooth form of it derived; eq. (4) of the 1967 paper
    is not used. Twelve digits against an independent solution with the singular kernel.

    References
    ----------
    Greenwood, Tripp 1967, J. Appl. Mech. 34, 153, doi:10.1115/1.3607616; Johnson 1985, Contact
    Mechanics, ch. 13, doi:10.1017/CBO9781139171731.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.rough_body import rough_sphere
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ball = rough_sphere(contact, radius=5e-3, load=10.0)
    >>> round(ball.a_eff / ball.a_hertz, 3), round(ball.peak_pressure / ball.p_hertz, 3)
    (1.072, 0.895)
    """
    skin = Skin(contact, E_star)
    shape = Sphere(_positive("radius", radius), skin.E_star)
    return _result(skin, shape, balance(skin, shape, d=d, load=load, guess=guess))


def rough_cylinder(
    contact: Contact | Callable[..., Any],
    *,
    radius: float,
    d: float | None = None,
    load: float | None = None,
    E_star: float | None = None,
    reference: float | None = None,
    guess: float | None = None,
) -> RoughBody:
    r"""A rough cylinder on a flat (line contact), per metre of length.

    .. math:: u = d + \frac{x^2}{2B} - \frac{2}{\pi E^*}\int p(s)\,
              \ln\left|\frac{x-s}{x_0-s}\right| ds

    Parameters
    ----------
    contact, radius, E_star, guess
        As in `rough_sphere`.
    d : float, optional
        Separation at the axis [m], without the displacement relative to the point x_0.
    load : float, optional
        F per length [N/m]. Exactly one of ``d`` and ``load``.
    reference : float, optional
        x_0 [m], the point whose displacement counts as zero; B by default. In two dimensions the
        approach of two bodies is not a property of the contact: only d depends on x_0, every
        quantity at a given load does not.

    Returns
    -------
    RoughBody

    Notes
    -----
    Provenance: derived, from the displacement of a half-space under a line load.

    References
    ----------
    Greenwood, Tripp 1967, J. Appl. Mech. 34, 153, doi:10.1115/1.3607616; Johnson 1985, Contact
    Mechanics, ch. 2, doi:10.1017/CBO9781139171731.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.rough_body import rough_cylinder
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> roller = rough_cylinder(contact, radius=5e-3, load=5e4)
    >>> round(roller.a_eff / roller.a_hertz, 3)
    1.161
    """
    skin = Skin(contact, E_star)
    radius = _positive("radius", radius)
    point = radius if reference is None else float(reference)
    shape = Cylinder(radius, skin.E_star, point)
    return _result(skin, shape, balance(skin, shape, d=d, load=load, guess=guess))


def curve(
    contact: Contact | Callable[..., Any],
    *,
    radius: float,
    loads: ArrayLike,
    shape: str = "sphere",
    E_star: float | None = None,
) -> dict[str, Array]:
    """Every number of `RoughBody` against the load, as columns.

    Parameters
    ----------
    contact, radius, E_star
        As in `rough_sphere`.
    loads : array_like
        Loads F [N], or [N/m] for ``shape="cylinder"``.
    shape : {"sphere", "cylinder"}, optional

    Returns
    -------
    dict of str to array
        One array per number of `RoughBody` (``load``, ``d``, ``a_eff``, ``real_area``, …).

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.rough_body import curve
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = curve(contact, radius=5e-3, loads=[1.0, 10.0])
    >>> [round(float(a) * 1e6, 1) for a in table["a_eff"]]
    [40.8, 74.5]
    """
    solvers = {"sphere": rough_sphere, "cylinder": rough_cylinder}
    if shape not in solvers:
        raise InvalidValue(f"shape = {shape!r} must be 'sphere' or 'cylinder'")
    values = np.atleast_1d(np.asarray(loads, dtype=float))
    if values.ndim != 1:
        raise InvalidValue("loads must be a number or a 1-D array")
    solved: list[RoughBody | None] = [None] * len(values)
    guess = None
    for i in np.argsort(values):
        state = solvers[shape](
            contact, radius=radius, load=float(values[i]), E_star=E_star, guess=guess
        )
        solved[i], guess = state, state.d
    names = [item.name for item in fields(RoughBody) if item.type in ("float", "float | None")]
    return {
        name: np.array([getattr(state, name) for state in solved], dtype=float) for name in names
    }
