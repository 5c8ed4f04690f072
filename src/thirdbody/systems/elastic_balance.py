"""Elastic bodies under a rough skin: grids, and their balance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..equilibrium.crowding import crowded_places
from ..equilibrium.load_scan import load_scan
from ..equilibrium.status import Status
from ..errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ..numerics.quadrature import gauss_legendre
from ..quantities.say import value_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

WIDENED = 60
"""Times that a search is widened: to 1e10 steps and more."""
OUT_OF_REACH = (
    "no equilibrium: the load {load:.4g} is not met between separations of {low:.3g} and "
    "{high:.3g} m; check its unit"
)
NEGLIGIBLE = 1e-17
"""Pressure, over the largest, at which the contact is cut off."""
CLIFF, HALVINGS = 1e-4, 8
"""Pressure, over that at the gap below, at which an outline asks for one between; how often."""
SMALL = 1e-14
"""Pressure at the edge of a grid, over the largest, from which on it is asked where it ends."""
TAIL, COARSE = 1e-12, 1e-5
"""Size of the last coefficients of the pressure, over the largest, that counts as converged: in
the end, and while the separation is still being sought."""
TENSILE = "the pressure is tensile somewhere: strong adhesion is not covered here"
NODES = (40, 60, 90, 135, 200, 300, 450)


# ------------------------------------------------------------------------------ the skin
def crowded_warning(status: str) -> tuple[str, ...]:
    """Warning for a status that is not "ok"."""
    return () if status == "ok" else (status,)


class Course(Protocol):
    """A pressure law p(u) [Pa] with its slope."""

    floor: float
    """Lowest gap that the law has [m]; −∞ where it has all."""
    origin: float
    """A gap to begin a search from [m]."""
    step: float | None
    """Width of a step of a search [m]."""

    def __call__(self, gap: Array) -> tuple[Array, Array]:
        """Pressure [Pa] and its slope [Pa/m]."""

    def one(self, gap: float) -> tuple[float, float]:
        p, slope = self(np.array([gap]))
        return float(p[0]), float(slope[0])

    def cut(self, gap: float) -> float:
        """Gap at which the pressure is negligible beside that at ``gap``."""
        p, slope = self.one(gap)
        if p < 0:
            raise InvalidValue(TENSILE, code=Mistake.BEYOND)
        if not (p > 0 and slope < 0):
            why = f"no contact at a gap of {value_of(gap, 'm')}"
            raise NoEquilibrium(why, Status.TOO_LITTLE)
        step = low = 0.0
        high = p / -slope
        for _ in range(WIDENED):
            if not self.one(gap + high)[0] > NEGLIGIBLE * p:
                break
            low, high = high, 1.7 * high
        else:
            raise NoEquilibrium("the pressure does not end: at a gap of "
                                f"{value_of(gap + high, 'm', 3)} it is "
                                f"still that of {value_of(gap, 'm', 3)}")  # fmt: skip
        for _ in range(12):
            step = 0.5 * (low + high)
            low, high = (step, high) if self.one(gap + step)[0] > NEGLIGIBLE * p else (low, step)
        return gap + high


class Skin(Course):
    """A pressure law, and where it may be used.

    Made of a `Contact`, or of a callable ``pressure(gap) -> (p, dp/dgap)`` over arrays with E*.
    Below ``floor`` (−3 σ_s, or where the table of one field ends) the law of a contact is continued
    by its tangent, so that iterates may pass there; a solution may not.
    """

    def __init__(self, source: Contact | Callable[..., Array], E_star: float | None):
        self.solids = None
        self.floor = -math.inf
        self.origin, self.step = 0.0, None
        self.warnings: tuple[str, ...] = ()
        if isinstance(source, Contact):
            if E_star is not None:
                raise InvalidValue(
                    "E_star follows from the contact; give it only with a callable",
                    code=Mistake.BEYOND,
                )
            self.solids = interface(source)
            self.E_star = source.E_ss
            skin = self.solids.asperities
            self.floor = self.origin = self.solids.lowest
            self.step = skin.sigma_s
            bottom = self.solids.load(np.array([self.floor]))[0]
            self.lowest = (float(bottom[0]), float(bottom[1]))
            if not load_scan(self.solids).monotone:
                self.warnings = (
                    "the load of this contact does not fall everywhere with the gap: the "
                    "solution found need not be the only one",
                )
        elif callable(source):
            if E_star is None or not E_star > 0:
                raise InvalidValue(
                    Problem(
                        "E_star",
                        "must be > 0 [Pa] with a pressure law",
                        repr(E_star),
                        code=Mistake.RANGE,
                    )
                )
            self.E_star, self.law = float(E_star), source
        else:
            raise InvalidValue(f"{source!r} must be a Contact or a pressure law", code=Mistake.KIND)

    def __call__(self, gap: Array) -> tuple[Array, Array]:
        """Pressure [Pa] and its slope [Pa/m]."""
        if self.solids is None:
            p, slope = self.law(gap)
            return np.asarray(p, dtype=float), np.asarray(slope, dtype=float)
        p, slope, _ = self.solids.load(np.maximum(gap, self.floor)).T
        if np.any(deep := gap < self.floor):
            value, tangent = self.lowest
            p = np.where(deep, value + tangent * (gap - self.floor), p)
            slope = np.where(deep, tangent, slope)
        return p, slope

    def crowded_places(self, A_t: Array, load: Array) -> tuple[float, str]:
        """The share of the load [1] at places that are crowded, and the status of the whole."""
        assert self.solids is not None
        return crowded_places(self.solids.contact, A_t, load)

    @cached_property
    def outline(self) -> Course:
        """What is quick to ask, to seek with: itself where the pressure is tensile somewhere."""
        if self.solids is None or self.step is None:
            return self
        gap = self.solids.rows
        p = self(gap)[0]
        start = self.origin if not len(gap) else gap[-1] + 0.1 * self.step
        for batch in np.arange(8 * WIDENED).reshape(-1, 8):
            above = start + 5 * self.step * np.expm1(0.1 * batch)
            gap, p = np.append(gap, above), np.append(p, self(above)[0])
            if not p[-1] > NEGLIGIBLE**3 * p[0]:
                break
        for _ in range(HALVINGS):
            steep = (p[1:] < CLIFF * p[:-1]) & (p[:-1] > NEGLIGIBLE**2 * p[0])
            if not np.any(steep):
                break
            between = 0.5 * (gap[1:] + gap[:-1])[steep]
            gap, p = np.append(gap, between), np.append(p, self(between)[0])
            gap, p = gap[order := np.argsort(gap)], p[order]
        counts = p > 0
        if np.any(p < 0) or np.count_nonzero(counts) < 2:
            return self
        return Outline(self, self.step, gap[counts], p[counts])


class Outline(Course):
    """The pressure of a contact to some percent, by its logarithm at few gaps.

    On one field of heights every separation that is no row of the ground's table is dear. Above
    the last gap, where there is less than any pressure that counts, it is 0.

    Parameters
    ----------
    skin : Skin
        What is asked below the first gap.
    step : float
        Width of a step of a search [m].
    gap, p : array (N,)
        Gaps [m] and the pressures there [Pa].
    """

    def __init__(self, skin: Skin, step: float, gap: Array, p: Array):
        from scipy.interpolate import PchipInterpolator

        self.skin, self.floor, self.origin, self.step = skin, skin.floor, skin.origin, step
        self.first, self.last = gap[0], gap[-1]
        self.logarithm = PchipInterpolator(gap, np.log(p))

    def __call__(self, gap: Array) -> tuple[Array, Array]:
        within = np.clip(gap, self.first, self.last)
        p = np.where(gap > self.last, 0.0, np.exp(self.logarithm(within)))
        slope = p * self.logarithm(within, 1)
        if np.any(deep := gap <= self.first):
            p[deep], slope[deep] = self.skin(gap[deep])
        return p, slope


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
    def extent(self, skin: Course, d: float) -> float:
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

    def extent(self, skin: Course, d: float) -> float:
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

    def extent(self, skin: Course, d: float) -> float:
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


def _newton(skin: Course, grid: Grid, d: float, sunk: Array) -> tuple[Array, Array, Array, float]:
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
        damping, size = 1.0, np.max(np.abs(error))
        while True:
            trial = gap + damping * step
            p, slope = skin(trial)
            error = trial - base - grid.compliance @ p
            if close or np.max(np.abs(error)) < size or damping < 1e-4:
                break
            damping *= 0.5
        gap = trial
        if close == 2 or size == 0:
            return gap, p, slope, float(np.max(np.abs(error)))
    raise NoEquilibrium(f"the gap equation did not converge at d = {value_of(d, 'm', 6)}")


def balance_at(
    skin: Course, shape: Shape, d: float, near: Balance | None = None, tolerance: float = TAIL
) -> Balance:
    """Balance at one approach d [m], on the grid of a state ``near`` it or a finer one."""
    extent = shape.extent(skin, d) if near is None else near.extent
    first = 0 if near is None else NODES.index(len(near.gap))
    series = np.zeros(1) if near is None else near.series
    shrunk = near is not None
    while True:
        n = NODES[first]
        grid = shape.grid(n, extent)
        gap, p, slope, residual = _newton(skin, grid, d, _values(series, n))
        if np.min(p) < 0:
            raise InvalidValue(TENSILE, code=Mistake.BEYOND)
        if not np.max(p) > 0:
            why = f"no contact at a separation of {value_of(d, 'm')}"
            raise NoEquilibrium(why, Status.TOO_LITTLE)
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
    sinking = np.linalg.solve(np.eye(n) - grid.compliance * slope, np.ones(n))
    load, rate = float(grid.weights @ p), float(grid.weights @ (slope * sinking))
    return Balance(d, grid, gap, p, load, rate, tail, residual, extent, series)


def _deep_enough(skin: Skin, state: Balance) -> Balance:
    """The balance, unless it lies where the law of the skin ends."""
    refuse_deep(skin, state.gap)
    return state


def refuse_deep(skin: Skin, gap: Array) -> None:
    """Refuse gaps (N,) [m] below where the law of the skin ends.

    Raises
    ------
    NoEquilibrium
        The lowest gap, and the lowest that the law has.
    """
    if skin.solids is not None and np.min(gap) < skin.floor:
        raise NoEquilibrium(
            f"the local gap falls to {value_of(np.min(gap), 'm')}, below the "
            f"{value_of(skin.floor, 'm')} of {skin.solids.why_lowest}",
            Status.TOO_DEEP,
        )


def balance(
    skin: Skin,
    shape: Shape,
    *,
    d: float | None,
    load: float | None,
    guess: float | None = None,
    quick: bool = False,
) -> Balance:
    """The balance at an approach or under a load; ``guess`` is an approach to start from.

    ``quick`` stops at five digits.
    """
    if (d is None) == (load is None):
        raise InvalidValue(
            "give exactly one of the separation d and the load", code=Mistake.MISSING
        )
    target = d if load is None else load
    if target is None or not math.isfinite(target) or (load is not None and load <= 0):
        raise InvalidValue(f"{target!r} must be finite, a load > 0", code=Mistake.RANGE)
    if load is None:
        return _deep_enough(skin, balance_at(skin, shape, target))
    outline = skin.outline
    d = _rigid(outline, shape, target) if guess is None else guess
    near = _seek(outline, shape, target, d, None, COARSE, 1e-5)
    tolerance, enough = (COARSE, 1e-5) if quick else (TAIL, 1e-14)
    state = _seek(skin, shape, target, near.d, near, tolerance, enough)
    if _ends_early(outline, shape, state):  # the outline was too rough to say where it ends
        near = balance_at(skin, shape, state.d, None, tolerance)
        state = _seek(skin, shape, target, near.d, near, tolerance, enough)
    return _deep_enough(skin, state)


def _ends_early(law: Course, shape: Shape, state: Balance) -> bool:
    """Whether the grid leaves out pressure that counts."""
    edge = state.pressure[np.argmax(state.grid.x)]
    counts = edge > SMALL * np.max(state.pressure)
    return bool(counts and state.extent < 0.95 * shape.extent(law, state.d))


def _seek(
    skin: Course,
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


def _rigid(skin: Course, shape: Shape, load: float) -> float:
    """Separation at which the undeformed shape would carry the load, roughly."""

    def share_at(d: float) -> float:
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
    for _ in range(WIDENED):
        if not share_at(high) > load:
            break
        high, width = high + width, 1.5 * width
    width = step
    for _ in range(WIDENED):
        if not share_at(low) < load:
            break
        low, width = low - width, 1.5 * width
    if share_at(high) > load or share_at(low) < load:
        raise NoEquilibrium(OUT_OF_REACH.format(load=load, low=low, high=high))
    while high - low > 0.05 * step:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if share_at(middle) > load else (low, middle)
    return high
