r"""One convex programme: pressures on pixels and forces of particles that a rigid flat raises.

.. math:: \min_{0\le p\le c,\ 0\le\varphi\le\varphi_{max}}\
          \tfrac12(p + D\varphi)^TK(p + D\varphi) - \tfrac12\sum_k s_k\varphi_k^2
          + \sum_k\Psi^*_k(\varphi_k)/\Delta^2 - b^T(p, \varphi) + h\sum(p, \varphi)

by projected conjugate gradients with one convolution a step, until a bound of the error says stop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from .bodies import NONE, Bodies, Placed
from .half_space import HalfSpace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["HARDEST", "Pressed", "capacity", "press"]

HARDEST = 1e30
"""Stands for a pixel that never yields [Pa]."""
NESTED_FROM = 512
"""Points of the shorter side from which coarser grids give the start."""
ROUGH = 1e-3
"""Certificate that is enough on a coarser grid."""
LONGEST = 10.0
"""Times a trial step; what hardly bends the half-space would go far on rounding alone."""
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
    coarse = 0
    n, m = z.shape
    if start is None and min(n, m) >= NESTED_FROM and n % 4 == 0 and m % 4 == 0:
        for step in (4, 2):
            found = _press(
                np.ascontiguousarray(z[::step, ::step]), spacing * step, E_star,
                c=np.ascontiguousarray(c[::step, ::step]), bodies=bodies, load=load, h=h,
                tol=max(tol, ROUGH), max_iterations=60, start=start, single=single,
                workers=workers,
            )  # fmt: skip
            coarse += found.iterations
            fine = z.shape if step == 2 else (n // 2, m // 2)
            start = found.p.repeat(2, axis=0).repeat(2, axis=1)[: fine[0], : fine[1]], found.f
    return _press(
        z, spacing, E_star, c=c, bodies=bodies, load=load, h=h, tol=tol,
        max_iterations=max_iterations, start=start, single=single, workers=workers, coarse=coarse,
    )  # fmt: skip


def _press(
    z: Array,
    spacing: float,
    E_star: float,
    *,
    c: Array,
    bodies: Bodies,
    load: float | None,
    h: float | None,
    tol: float,
    max_iterations: int,
    start: tuple[Array, Array] | None,
    single: bool,
    workers: int,
    coarse: int = 0,
) -> Pressed:
    space = HalfSpace(z.shape, spacing, E_star, single=single, workers=workers)
    area = spacing**2
    placed = Placed(bodies, z.shape, spacing)
    own = placed.own(space.green(), space.lattice) if len(bodies) else np.empty(0)
    sigma = float(np.std(z)) or float(np.ptp(z)) or spacing
    top = placed.at(z) + bodies.lift + bodies.diameter if len(bodies) else np.empty(0)
    most = bodies.limit / area
    z, c = np.ascontiguousarray(z), np.ascontiguousarray(c)

    total = None if load is None else load / area
    if start is None:
        p, phi = _guess(z, c, bodies, top, most, total, area, E_star, spacing)
    else:
        p, phi = np.clip(start[0], 0, c), np.clip(start[1] / area, 0, most)
    if total is not None:
        p, phi = _rescaled(p, phi, c, most, total)

    exact = HalfSpace(z.shape, spacing, E_star, workers=workers) if single else space

    def displaced(p: Array, phi: Array) -> Array:
        return exact.displacement(placed.spread(phi, p) if len(bodies) else p)

    u = displaced(p, phi)
    level = -h if h is not None else _first_level(p, c, u - z)
    step = 1.0
    s = np.zeros_like(p)  # the last clipped step and what it does
    Ks = np.zeros_like(p)
    s_k = np.zeros_like(phi)
    Hs_k = np.zeros_like(phi)
    sHs = 0.0
    certificate, iteration, fresh = math.inf, 0, 0

    while True:
        squeeze = bodies.squeeze(phi * area)
        v = placed.at(u) - own * phi if len(bodies) else phi
        for last in range(3) if total is not None else range(2, 3):
            # working set: pixels, then particles
            where, r, inner, outer, sum_p = _working_set(p, c, u, z, level)
            available = top + level - v
            reached = bodies.force(available) / area
            r_k = available - squeeze
            can = ((phi > 0) | (reached > 0)) & ~((phi >= most) & (r_k >= 0))
            M = _secant(bodies, reached - phi, r_k, squeeze, area)
            y, w = space.sharpen(r, where)
            y_k, w_k = np.where(can, M * r_k, 0.0), np.where(can, M, 0.0)
            bottom = float(np.sum(w) + np.sum(w_k))
            mu = (float(np.sum(y) + np.sum(y_k)) / bottom) if total is not None and bottom else 0.0
            if last < 2:
                level -= mu
        miss = float(np.sum(np.abs(reached - phi) * np.abs(r_k)))
        weight = sum_p + float(np.sum(phi))
        excess = inner + outer + miss
        certificate = excess / (sigma * weight) if weight > 0 else math.inf if excess else 0.0
        if certificate < tol or iteration >= max_iterations:
            if fresh or iteration == 0:
                break
            fresh, u = 1, displaced(p, phi)  # the answer is judged by displacements of its own
            continue
        fresh = 0

        # direction, conjugate to the last clipped step
        y, y_k = y - mu * w, y_k - mu * w_k
        Hs = Ks.ravel()[where]
        beta = 0.0
        if sHs > 0:
            beta = max(0.0, -(_dot(y, Hs) + float(np.sum(y_k * Hs_k))) / sHs)
        r_A = r.ravel()[where]
        d, d_k = y, y_k
        if beta > 0:
            d = y + beta * s.ravel()[where]
            d_k = np.where(can, y_k + beta * s_k, 0.0)
            if _dot(d, r_A - mu) + float(np.sum(d_k * np.where(can, r_k - mu, 0.0))) <= 0:
                d, d_k = y, y_k

        # step, clipped before it is convolved
        X = np.concatenate([p.ravel()[where], phi])
        cap = np.concatenate([c.ravel()[where], most])
        every, tilt = np.concatenate([d, d_k]), np.concatenate([w, w_k])
        moved = X + step * every
        if total is not None:
            moved = _balanced(moved, tilt, cap, float(np.sum(X)))
        new = np.clip(moved, 0.0, cap)
        clipped = bool(np.any(new != moved))
        s = np.zeros_like(p)
        s.reshape(-1)[where] = new[: len(where)] - X[: len(where)]
        s_k = new[len(where) :] - phi
        Ks = space.displacement(placed.spread(s_k, s) if len(bodies) else s)
        linear = placed.at(Ks) - own * s_k if len(bodies) else s_k
        Hs_k = linear + np.divide(s_k, M, out=np.zeros_like(M), where=M > 0)
        quadratic = _dot(s, Ks) + float(np.sum(s_k * linear))
        sHs = quadratic + float(np.sum(s_k * (Hs_k - linear)))
        rs = _dot(r, s) + float(np.sum(r_k * s_k))
        iteration += 1
        if not (rs > 0 and sHs > 0):
            if step < 1e-9:
                break
            step, sHs = step / 2, 0.0
            continue
        theta = min(rs / sHs, LONGEST, _room(X, new - X, cap))
        moving = s_k != 0
        if np.any(moving):  # the law of a particle is no line: Φ must not rise
            for _ in range(40):
                bent = bodies.squeeze((phi + theta * s_k) * area) - squeeze
                if rs - theta * quadratic - float(np.sum(bent * s_k)) >= -rs:
                    break
                theta /= 2
        p += theta * s
        np.clip(p, 0.0, c, out=p)
        phi = np.clip(phi + theta * s_k, 0.0, most)
        u += theta * Ks
        step *= float(np.clip(theta, 0.3, 3) if clipped else np.clip(theta, 0.1, 10))
        if iteration % AFRESH == 0:
            u = displaced(p, phi)

    return Pressed(
        p=p, f=phi * area, squeeze=available, u=u, h=-level, certificate=certificate,
        iterations=iteration, converged=certificate < tol, coarse=coarse,
    )  # fmt: skip


@njit(cache=True)
def _working_set(p, c, u, z, level):
    """Pixels that may move, λ − g on them, and what the others lack: the terms of the certificate.

    Without a cap the second term takes the whole load where the gap is most negative, as in a
    programme over pressures of one sum.
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
            elif high < 1e29:
                outer += (high - now) * lack
            else:
                under += now * lack
                deepest = max(deepest, lack)
            total += now
            r[i, j] = lack
            where[count] = i * m + j
            count += 1
    if deepest > 0:
        outer += deepest * total - under
    return where[:count].copy(), r, inner, outer, total


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


def _balanced(moved: Array, tilt: Array, cap: Array, total: float) -> Array:
    """``moved`` + ν ``tilt`` so that the sum within the box is the total: Newton, safeguarded."""
    scale = float(np.sum(tilt))
    if scale <= 0:
        return moved
    nu, low, high = 0.0, -math.inf, math.inf
    now = moved
    for _ in range(60):
        lack = total - float(np.sum(np.clip(now, 0.0, cap)))
        if abs(lack) <= 1e-14 * abs(total):
            break
        if lack > 0:
            low = nu
        else:
            high = nu
        free = (now > 0) & (now < cap) if lack < 0 else (now >= 0) & (now < cap)
        slope = float(np.sum(tilt[free]))
        ahead = nu + lack / (slope if slope > 0 else scale)
        if not low < ahead < high and math.isfinite(low + high):
            ahead = 0.5 * (low + high)
        if ahead == nu:
            break
        nu = ahead
        now = moved + nu * tilt
    return now


def _room(X: Array, s: Array, cap: Array) -> float:
    """The longest step along s inside the box, at least 1."""
    down, up = s < 0, s > 0
    ends = [math.inf]
    if np.any(down):
        ends.append(float(np.min(-X[down] / s[down])))
    if np.any(up):
        ends.append(float(np.min((cap[up] - X[up]) / s[up])))
    return max(1.0, min(ends))


def _first_level(p: Array, c: Array, g: Array) -> float:
    """Mean of u − z where the pressure is between its limits."""
    free = (p > 0) & (p < c)
    if np.any(free):
        return float(np.mean(g[free]))
    held = p > 0
    return float(np.mean(g[held])) if np.any(held) else float(np.min(g))


def _rescaled(p: Array, phi: Array, c: Array, most: Array, total: float) -> tuple[Array, Array]:
    """The same pattern with the sum wanted: a common factor, within the box."""
    X, cap = np.concatenate([p.ravel(), phi]), np.concatenate([c.ravel(), most])
    factor = 1.0
    for _ in range(60):
        now = np.minimum(factor * X, cap)
        sum_now = float(np.sum(now))
        if abs(sum_now - total) <= 1e-12 * total:
            break
        free = now < cap
        rest = float(np.sum(now[free]))
        if rest <= 0:
            break
        above = sum_now > total  # where much is at its limit, the rest alone cannot give way
        factor *= total / sum_now if above else (total - sum_now + rest) / rest
    lack = total - float(np.sum(now))
    if abs(lack) > 1e-12 * total:  # what is left goes where there is room
        room = np.minimum(cap - now, total)
        now = now + lack * room / float(np.sum(room)) if lack > 0 else now * (1 + lack / sum_now)
    return now[: p.size].reshape(p.shape), now[p.size :]


def _guess(
    z: Array,
    c: Array,
    bodies: Bodies,
    top: Array,
    most: Array,
    total: float | None,
    area: float,
    E_star: float,
    spacing: float,
) -> tuple[Array, Array]:
    """Where the load may be: in proportion to what stands out above a level."""
    if total is None:
        return np.zeros_like(z), np.zeros(len(bodies))
    slope = math.sqrt(np.mean(np.diff(z, axis=0) ** 2) + np.mean(np.diff(z, axis=1) ** 2)) / spacing
    firm = min(float(np.max(c)), 0.3 * E_star * max(slope, 1e-12))
    count = int(min(max(3 * total / firm if firm > 0 else 1, 1), 0.5 * z.size))
    free = np.where(c > 0, z, -math.inf)
    level = float(np.partition(free.ravel(), z.size - count)[z.size - count])
    level = max(level, float(np.min(z)))
    p = np.maximum(free - level, 0.0)
    p[~np.isfinite(p)] = 0.0
    if not np.any(p):
        p[free >= level] = 1.0
    p *= firm / max(float(np.max(p)), 1e-300)
    phi = np.minimum(bodies.force(np.maximum(top - level, 0.0)) / area, most)
    return np.minimum(p, c), phi
