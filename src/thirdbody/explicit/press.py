r"""One convex programme: pressures on pixels and forces of particles that a rigid flat raises.

.. math:: \min_{0\le p\le c,\ 0\le\varphi\le\varphi_{max}}\
          \tfrac12(p + D\varphi)^TK(p + D\varphi) - \tfrac12\sum_k s_k\varphi_k^2
          + \sum_k\Psi^*_k(\varphi_k)/\Delta^2 - b^T(p, \varphi) + h\sum(p, \varphi)

by projected conjugate gradients with one convolution a step, until a bound of the error says stop.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from .bodies import NONE, Bodies, Placed
from .box import pressures_with_sum, rescale, room
from .half_space import HalfSpace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["HARDEST", "Pressed", "capacity", "contact_share", "press"]

HARDEST = 1e30
"""Stands for a pixel that never yields [Pa]."""
UNBOUNDED = 1e29
"""Caps from here on are those of pixels that never yield [Pa]."""
PERIMETER = (math.pi - 1 + math.log(2)) / 24
"""Area that a pixel edge at the rim of an elastic contact counts too much, over Δ²."""
NESTED_FROM = 512
"""Points of the shorter side from which coarser grids give the start."""
ROUGH = 1e-3
"""Certificate that is enough on a coarser grid."""
LONGEST = 10.0
"""Times a trial step; what hardly bends the half-space would go far on rounding alone."""
AMISS = 1e-9
"""Part of the load that may be missing in a state that counts as converged."""
AFRESH = 20
"""Iterations after which u is computed anew."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Pressed:
    """A state of equilibrium on a grid, and how well it is known.

    Attributes
    ----------
    p, u : array (n, m)
        Pressure on the pixels [Pa]; displacement, of zero mean [m].
    f, squeeze : array (N,)
        Force of each particle [N]; how far the flat has come below its top [m].
    h : float
        Separation of the mean planes [m].
    certificate : float
        ε; ε σ ΣpΔ² bounds the elastic energy of the error [1].
    iterations : int
        Convolutions on this grid.
    """

    p: Array
    f: Array
    squeeze: Array
    u: Array
    h: float
    certificate: float
    iterations: int
    converged: bool
    coarse: int = 0
    """Convolutions on coarser grids, which cost a sixteenth and a quarter."""


def capacity(c: Array, bodies: Bodies, spacing: float) -> float:
    """The load that all pixels and particles can carry [N]."""
    return float(np.sum(c)) * spacing**2 + float(np.sum(bodies.limit))


def contact_share(p: Array, c: Array, cap: float | None) -> Array:
    r"""Share of each pixel (n, m) that is in contact [1].

    .. math:: a_i = \max\left[\frac{p_i}{H},\
                    \frac{c_i}{H}\left(1 - \frac{\pi - 1 + \ln 2}{24} e_i\right)\right]
              \quad\text{where } p_i > 0

    with e the number of edges across which nothing touches though it might. Where the pressure
    falls to zero at the rim as that of Hertz does, counted pixels are too many by the bracket
    (Yastrebov et al.). Where it keeps its limit H up to the rim, as on a bearing area, they are
    not; and no pixel carries p on less than p/H of itself, so that :math:`A \ge F/H` always. An
    edge towards a pixel under a particle is where the contact does end.

    Parameters
    ----------
    p, c : array (n, m)
        Pressure on the pixels and its limit [Pa]; c is less than H by what particles cover.
    cap : float or None
        H [Pa]; None where asperities never yield.

    Returns
    -------
    array (n, m)

    Notes
    -----
    At 16, 32 and 64 pixels to the shortest wave the area of a rough surface is within 2, 1 and
    0.5 % of that at 128, for H/E* from 0.0045 to 1 and without a cap. The count is up to 9, 4 and
    2 % higher; with the bracket on every pixel it is 6, 3 and 1.5 % too low where all yields.

    References
    ----------
    Yastrebov, Anciaux and Molinari 2017, Tribol. Int. 114, 161,
    doi:10.1016/j.triboint.2017.04.023, arXiv:1701.02727.
    """
    touching, open_ = p > 0, c > 0
    edges = np.zeros(p.shape)
    for axis in (0, 1):
        for step in (1, -1):
            edges += np.roll(open_ & ~touching, step, axis)
    whole = 1 - PERIMETER * edges
    if cap is None:
        return np.where(touching, whole, 0.0)
    return np.where(touching, np.maximum(p, c * whole) / cap, 0.0)


def press(
    z: Array,
    spacing: float,
    E_star: float,
    *,
    c: Array,
    bodies: Bodies = NONE,
    load: float | None = None,
    h: float | None = None,
    tol: float = 1e-6,
    max_iterations: int = 300,
    start: tuple[Array, Array] | None = None,
    single: bool = False,
    workers: int = 1,
) -> Pressed:
    """Press a flat onto heights z (n, m) [m], by a load [N] or to a separation [m].

    Parameters
    ----------
    c : array (n, m)
        The highest pressure of each pixel [Pa]; `HARDEST` where it never yields, 0 where covered.
    start : (array, array), optional
        p and f to begin with.
    """

    def coarse_programme(stride: int) -> _Programme:
        return _Programme(
            np.ascontiguousarray(z[::stride, ::stride]) if stride > 1 else z,
            spacing * stride, E_star, c=c[::stride, ::stride], bodies=bodies, load=load, h=h,
            single=single, workers=workers,
        )  # fmt: skip

    coarse = 0
    n, m = z.shape
    if start is None and min(n, m) >= NESTED_FROM and n % 4 == 0 and m % 4 == 0:
        for stride in (4, 2):
            pressed = _press(coarse_programme(stride), start, max(tol, ROUGH), max_iterations=60)
            coarse += pressed.iterations
            start = pressed.p.repeat(2, axis=0).repeat(2, axis=1), pressed.f
    return dataclasses.replace(
        _press(coarse_programme(1), start, tol, max_iterations), coarse=coarse
    )


def _press(
    programme: _Programme, start: tuple[Array, Array] | None, tol: float, max_iterations: int
) -> Pressed:
    """The iteration; a is the trial step along d, θ the exact one along s, the clipped a d."""
    x = programme.first(start)
    a, last, iterations, judged = 1.0, None, 0, False
    while True:
        squeeze = programme.squeeze(x)
        for levelling in (True, True, False) if programme.total is not None else (False,):
            A = programme.working_set(x, squeeze)  # no convolution
            if levelling:
                x.level -= A.mu
        certificate = A.certificate(programme.sigma)
        if certificate < tol or iterations >= max_iterations:
            if judged or iterations == 0:
                break
            judged, x.u = True, programme.displacement(x.p, x.phi)  # the answer has a u of its own
            continue
        judged = False

        s = programme.clipped_step(x, A, _direction(A, last), a)  # the one convolution
        iterations += 1
        if not (s.rs > 0 and s.sHs > 0):
            if a < 1e-9:
                break
            a, last = a / 2, None
            continue
        theta, free = programme.exact_step(x, s, squeeze)
        programme.move(x, s, theta)
        a *= float(np.clip(free, 0.3, 3) if s.clipped else np.clip(free, 0.1, 10))
        last = s
        if iterations % AFRESH == 0:
            x.u = programme.displacement(x.p, x.phi)

    return Pressed(
        p=x.p, f=x.phi * programme.area, squeeze=A.available, u=x.u, h=-x.level,
        certificate=certificate, iterations=iterations,
        converged=certificate < tol and programme.carries(x),
    )  # fmt: skip


@dataclass(slots=True)
class _Iterate:
    """Where the iteration stands: p [Pa] and φ = f/Δ² [Pa], u [m], and λ [m]."""

    p: Array
    phi: Array
    u: Array
    level: float


@dataclass(slots=True)
class _WorkingSet:
    """Pixels and particles (…_k) that may move, their residuals, and the error measure."""

    where: Index
    """Pixels of the set, flat."""
    can: NDArray[np.bool_]
    """Particles of the set."""
    r: Array
    """λ − g (n, m) on the set, 0 elsewhere [m]."""
    r_k: Array
    available: Array
    """How far the flat has come below the top of each particle [m]."""
    M: Array
    """Secant stiffness of each particle over Δ² [Pa/m]."""
    y: Array
    """r, sharpened, on ``where`` [Pa]."""
    y_k: Array
    w: Array
    """1, sharpened [Pa/m]."""
    w_k: Array
    mu: float
    """Σy/Σw where the load is given, else 0 [m]."""
    excess: float
    """What is carried times what is lacking, summed [Pa m]."""
    weight: float
    """Sum of all pressures [Pa]."""

    def certificate(self, sigma: float) -> float:
        """ε of `Pressed` [1]."""
        if self.weight > 0:
            return self.excess / (sigma * self.weight)
        return math.inf if self.excess else 0.0


@dataclass(slots=True)
class _Step:
    """s, clipped before it is convolved, with H s and the slopes of Φ along it."""

    s: Array
    s_k: Array
    Ks: Array
    Hs_k: Array
    rs: float
    """r·s, with that of the particles [Pa m]."""
    sHs: float
    quadratic: float
    """s·Hs without the particles' own laws."""
    room: float
    """Times s that stays inside the box."""
    clipped: bool


class _Programme:
    """Quadratic programme of a pressed map and its iteration steps; arguments as of `press`."""

    def __init__(
        self,
        z: Array,
        spacing: float,
        E_star: float,
        *,
        c: Array,
        bodies: Bodies,
        load: float | None,
        h: float | None,
        single: bool,
        workers: int,
    ):
        self.bodies, self.h = bodies, h
        self.area = spacing**2
        self.total = None if load is None else load / self.area
        self.sigma = float(np.std(z)) or float(np.ptp(z)) or spacing
        self.z, self.c = np.ascontiguousarray(z), np.ascontiguousarray(c)
        self.space = HalfSpace(z.shape, spacing, E_star, single=single, workers=workers)
        self.exact = HalfSpace(z.shape, spacing, E_star, workers=workers) if single else self.space
        self.placed = Placed(bodies, z.shape, spacing)
        self.most = bodies.limit / self.area
        self.full: tuple[float, float] | None = None
        """zᵀK⁻¹z [Pa m] and the separation [m] where pixels without a cap are held apart."""
        if h is not None and np.any(self.c >= UNBOUNDED) and h > np.mean(self.z):
            self.full = self.space.energy_of_full_contact(self.z), h - float(np.mean(self.z))
        self.self_displacement = self.top = np.empty(0)
        if len(bodies):
            self.self_displacement = self.placed.own_displacement(
                self.space.green(), self.space.lattice
            )
            self.top = self.placed.at_particles(self.z) + bodies.lift + bodies.diameter

    def first(self, start: tuple[Array, Array] | None) -> _Iterate:
        """A guess, or the start that is given, with the load wanted."""
        if start is None:
            p, phi = self._guess()
        else:
            p, phi = np.clip(start[0], 0, self.c), np.clip(start[1] / self.area, 0, self.most)
        if self.total is not None:
            p, phi = rescale(p, phi, self.c, self.most, self.total)
        u = self.displacement(p, phi)
        level = -self.h if self.h is not None else _first_level(p, self.c, u - self.z)
        return _Iterate(p, phi, u, level)

    def carries(self, x: _Iterate) -> bool:
        """Whether the load is the wanted one, if there is one: the certificate does not see it."""
        if self.total is None:
            return True
        return abs(float(np.sum(x.p) + np.sum(x.phi)) - self.total) <= AMISS * self.total

    def _guess(self) -> tuple[Array, Array]:
        """Where the load may be: in proportion to what stands out above a level."""
        z, c, E_star, spacing = self.z, self.c, self.space.E_star, self.space.spacing
        if self.total is None:
            return np.zeros_like(z), np.zeros(len(self.bodies))
        along, across = np.mean(np.diff(z, axis=0) ** 2), np.mean(np.diff(z, axis=1) ** 2)
        slope = math.sqrt(along + across) / spacing
        firm = min(float(np.max(c)), 0.3 * E_star * max(slope, 1e-12))
        count = int(min(max(3 * self.total / firm if firm > 0 else 1, 1), 0.5 * z.size))
        free = np.where(c > 0, z, -math.inf)
        level = float(np.partition(free.ravel(), z.size - count)[z.size - count])
        level = max(level, float(np.min(z)))
        p = np.maximum(free - level, 0.0)
        p[~np.isfinite(p)] = 0.0
        if not np.any(p):
            p[free >= level] = 1.0
        p *= firm / max(float(np.max(p)), 1e-300)
        above = np.maximum(self.top - level, 0.0)
        phi = np.minimum(self.bodies.force(above) / self.area, self.most)
        return np.minimum(p, c), phi

    def _with_particles(self, p: Array, phi: Array) -> Array:
        """p + Dφ [Pa]."""
        return self.placed.spread(phi, p) if len(self.bodies) else p

    def displacement(self, p: Array, phi: Array) -> Array:
        """u = K(p + Dφ) [m], in float64."""
        return self.exact.displacement(self._with_particles(p, phi))

    def _displacement_beneath(self, u: Array, phi: Array) -> Array:
        """Displacement under each particle, without the dent that its law counts already [m]."""
        return (
            self.placed.at_particles(u) - self.self_displacement * phi if len(self.bodies) else phi
        )

    def squeeze(self, x: _Iterate) -> Array:
        """Squeeze δ of each particle under its force [m]."""
        return self.bodies.squeeze(x.phi * self.area)

    def working_set(self, x: _Iterate, squeeze: Array) -> _WorkingSet:
        """What may move at the level λ, pixels and then particles."""
        phi = x.phi
        where, r, inner, outer, sum_p, under, deepest = _working_set(
            x.p, self.c, x.u, self.z, x.level
        )
        if deepest > 0:
            outer += self._lack_without_cap(x, sum_p, under, deepest)
        available = self.top + x.level - self._displacement_beneath(x.u, phi)
        reached = self.bodies.force(available) / self.area
        r_k = available - squeeze
        can = ((phi > 0) | (reached > 0)) & ~((phi >= self.most) & (r_k >= 0))
        M = _secant(self.bodies, reached - phi, r_k, squeeze, self.area)
        y, w = self.space.sharpen(r, where)
        y_k, w_k = np.where(can, M * r_k, 0.0), np.where(can, M, 0.0)
        mu, bottom = 0.0, float(np.sum(w) + np.sum(w_k))
        if self.total is not None and bottom:
            mu = float(np.sum(y) + np.sum(y_k)) / bottom
        miss = float(np.sum(np.abs(reached - phi) * np.abs(r_k)))
        return _WorkingSet(
            where=where, can=can, r=r, r_k=r_k, available=available, M=M, y=y, y_k=y_k, w=w,
            w_k=w_k, mu=mu, excess=inner + outer + miss, weight=sum_p + float(np.sum(phi)),
        )  # fmt: skip

    def _lack_without_cap(self, x: _Iterate, sum_p: float, under: float, deepest: float) -> float:
        r"""Residual of pixels without a cap, at most :math:`t = \max(\lambda - g)` each [Pa m].

        Under a load no pressures of one sum can have more than tΣp − Σp(λ − g)₊ to gain. At a
        separation the sum is not known. There (1 − θ)(p + Dφ) + θK⁻¹z with θ = t/(t + h) leaves no
        gap negative, so that the energy of its displacement bounds that of the answer from below
        (the dual programme), and the gain is at most

        .. math:: t\Sigma p + \tfrac12\theta^2(z - u)^TK^{-1}(z - u) .

        The last is of second order in t, but all there is where nothing carries yet.
        """
        if self.total is not None:
            return deepest * sum_p - under
        if self.full is None:  # the flat is below the mean plane: only caps can carry that
            return deepest * sum_p or math.inf
        energy, room = self.full
        y = self._with_particles(x.p, x.phi)
        rest = energy - 2 * _dot(y, self.z - np.mean(self.z)) + _dot(y, x.u)
        theta = deepest / (deepest + room)
        return deepest * sum_p + 0.5 * theta**2 * max(rest, 0.0)

    def clipped_step(self, x: _Iterate, A: _WorkingSet, d: tuple[Array, Array], a: float) -> _Step:
        """s = clip(X + a d + ν w, 0, c) − X, ν such that Σs = 0 under a load; and what it does."""
        count = len(A.where)
        X = np.concatenate([x.p.ravel()[A.where], x.phi])
        cap = np.concatenate([self.c.ravel()[A.where], self.most])
        moved = X + a * np.concatenate(d)
        if self.total is not None:
            moved = pressures_with_sum(moved, np.concatenate([A.w, A.w_k]), cap, float(np.sum(X)))
        new = np.clip(moved, 0.0, cap)
        along = new - X
        s, s_k = np.zeros_like(x.p), along[count:]
        s.reshape(-1)[A.where] = along[:count]
        Ks = self.space.displacement(self._with_particles(s, s_k))
        linear = self._displacement_beneath(Ks, s_k)
        Hs_k = linear + np.divide(s_k, A.M, out=np.zeros_like(A.M), where=A.M > 0)
        quadratic = _dot(s, Ks) + _dot(s_k, linear)
        return _Step(
            s=s, s_k=s_k, Ks=Ks, Hs_k=Hs_k, rs=_dot(A.r, s) + _dot(A.r_k, s_k),
            sHs=quadratic + _dot(s_k, Hs_k - linear), quadratic=quadratic,
            room=room(X, along, cap), clipped=bool(np.any(new != moved)),
        )  # fmt: skip

    def exact_step(self, x: _Iterate, s: _Step, squeeze: Array) -> tuple[float, float]:
        """θ = r·s / s·Hs, no further than the box, halved until Φ does not rise; and without box.

        The next trial is as long as the step wanted to be: one that the box ended would else never
        grow again, since a clipped step always ends there.
        """
        free = min(s.rs / s.sHs, LONGEST)
        theta = min(free, s.room)
        if np.any(s.s_k != 0):  # the law of a particle is no line
            for _ in range(40):
                bent = self.bodies.squeeze((x.phi + theta * s.s_k) * self.area) - squeeze
                if s.rs - theta * s.quadratic - _dot(bent, s.s_k) >= -s.rs:
                    break
                theta /= 2
                free = theta
        return theta, free

    def move(self, x: _Iterate, s: _Step, theta: float) -> None:
        """X += θ s and u += θ K s."""
        x.p += theta * s.s
        np.clip(x.p, 0.0, self.c, out=x.p)
        x.phi = np.clip(x.phi + theta * s.s_k, 0.0, self.most)
        x.u += theta * s.Ks


def _direction(A: _WorkingSet, last: _Step | None) -> tuple[Array, Array]:
    """d = y − μw + β s, conjugate to the last clipped step; without β where it does not descend."""
    y, y_k = A.y - A.mu * A.w, A.y_k - A.mu * A.w_k
    if last is None:
        return y, y_k
    Hs = last.Ks.ravel()[A.where]
    beta = max(0.0, -(_dot(y, Hs) + _dot(y_k, last.Hs_k)) / last.sHs)
    if beta > 0:
        d = y + beta * last.s.ravel()[A.where]
        d_k = np.where(A.can, y_k + beta * last.s_k, 0.0)
        r, r_k = A.r.ravel()[A.where] - A.mu, np.where(A.can, A.r_k - A.mu, 0.0)
        if _dot(d, r) + _dot(d_k, r_k) > 0:
            return d, d_k
    return y, y_k


@njit(cache=True)
def _working_set(p, c, u, z, level):
    """Pixels that may move, λ − g on them, and what the others lack: the terms of the certificate.

    Of pixels without a cap: their p (λ − g)₊, summed, and the largest λ − g of them.
    """
    n, m = p.shape
    r = np.zeros((n, m))
    where = np.empty(n * m, np.int64)
    count, inner, outer, under, total, deepest = 0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        for j in range(m):
            high = c[i, j]
            if high <= 0:
                continue
            now = p[i, j]
            lack = level - u[i, j] + z[i, j]
            if lack < 0:
                if now > 0:
                    inner -= now * lack
                else:
                    continue
            elif now >= high:
                total += now
                continue
            elif high < UNBOUNDED:
                outer += (high - now) * lack
            else:
                under += now * lack
                deepest = max(deepest, lack)
            total += now
            r[i, j] = lack
            where[count] = i * m + j
            count += 1
    return where[:count].copy(), r, inner, outer, total, under, deepest


def _dot(a: Array, b: Array) -> float:
    """Σab, the same for any number of threads."""
    return float(np.sum(a * b))


def _secant(bodies: Bodies, missing: Array, r: Array, squeeze: Array, area: float) -> Array:
    """What a particle gains in φ over what it lacks in squeeze [Pa/m]; the tangent at the end."""
    if not len(bodies):
        return r
    near = np.abs(r) < 1e-9 * bodies.diameter
    tangent = bodies.stiffness(np.maximum(squeeze, 1e-9 * bodies.diameter)) / area
    safe = np.where(near, 1.0, r)
    return np.where(near, tangent, np.maximum(missing / safe, 0.0))


def _first_level(p: Array, c: Array, g: Array) -> float:
    """Mean of u − z where the pressure is between its limits."""
    free = (p > 0) & (p < c)
    if np.any(free):
        return float(np.mean(g[free]))
    held = p > 0
    return float(np.mean(g[held])) if np.any(held) else float(np.min(g))
