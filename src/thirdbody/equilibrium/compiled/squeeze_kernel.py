"""Nodes over the squeeze of particles, compiled.

The law is known by tables of its load and area; what is written here is how two contacts in
series share a load, and what they contribute. `rules` lays the tables out.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from .cached import Cached
from .layout import SHARED

FAST = {"contract"}
"""A product and a sum may become one instruction, which rounds once."""


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _on_panel(table, x):
    """Panel of x, and x on −1…1."""
    p, last = 0, len(table) - 1
    while p < last and x > table[p].middle + table[p].half:
        p += 1
    return p, min(max((x - table[p].middle) / table[p].half, -1.0), 1.0)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _series(table, x):
    """A curve at x."""
    p, s = _on_panel(table, x)
    c, t = table[p].y, 2 * s
    b1 = b2 = 0.0
    for k in range(len(c) - 1, 0, -1):
        b1, b2 = t * b1 + (c[k] - b2), b1
    return s * b1 + (c[0] - b2)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _two_series(table, x):
    """Load and area at x."""
    p, s = _on_panel(table, x)
    c, d, t = table[p].load, table[p].area, 2 * s
    b1 = b2 = d1 = d2 = 0.0
    for k in range(len(c) - 1, 0, -1):
        b1, b2 = t * b1 + (c[k] - b2), b1
        d1, d2 = t * d1 + (d[k] - d2), d1
    return s * b1 + (c[0] - b2), s * d1 + (d[0] - d2)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _load_and_area(law, table, v):
    """Reduced load and area at y = v²."""
    y = v * v
    if y <= law.first or law.elastic:
        u = y / law.first
        return law.first_load * u * math.sqrt(u), law.first_area * u
    if y >= law.last:
        u = y / law.last
        return law.last_load * u, law.last_area * u
    return _two_series(table, v)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _of_force(law, inverse, f):
    """y at which the law carries f."""
    if f <= law.first_load or law.elastic:
        return law.first * (f / law.first_load) ** (2 / 3)
    if f >= law.last_load:
        return law.last * (f / law.last_load)
    return math.exp(_series(inverse, math.log(f)))


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _of_pressure(law, rise, p):
    """y ≤ the last breakpoint at which the mean pressure is p."""
    first, last = law.first_load / law.first_area, law.last_load / law.last_area
    if p >= last:
        return law.last
    if p <= first:
        return law.first * (p / first) ** 2
    return _series(rise, math.sqrt(last - p))


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _carrying(law, tables, side, f):
    """y at which a side carries f times its unit, or all it can."""
    f = min(f, side.limit / side.unit)
    y = _of_force(law, tables[1], f)
    if y > side.cap and law.plateau:
        return max(_of_pressure(law, tables[2], f / side.full), side.cap)
    return min(y, side.cap)


@Cached
@njit(nogil=True, cache=True, error_model="numpy", fastmath=FAST)
def carrying(law, tables, side, f, out):
    """`_carrying` at every f (M, k), into ``out``."""
    for m in range(f.shape[0]):
        for i in range(f.shape[1]):
            out[m, i] = _carrying(law, tables, side[m], f[m, i])


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _share(law, tables, weaker, stronger, equal, v, out):
    """Both contacts when the weaker side is indented by v² of its unit."""
    f, a = _load_and_area(law, tables[0], v)
    full, cap, plateau = weaker.full, weaker.cap, law.plateau
    if v * v > cap:
        # beyond the great circle: its area at the mean pressure of the law, or nothing more
        f = f * full / a if plateau else _load_and_area(law, tables[0], math.sqrt(cap))[0]
    out.load, out.area_weaker = f, min(a, full)
    if equal:
        out.y_stronger, out.area_stronger = v * v, out.area_weaker
        return
    y = _carrying(law, tables, stronger, weaker.unit / stronger.unit * f)
    out.y_stronger = y
    out.area_stronger = min(_load_and_area(law, tables[0], math.sqrt(y))[1], stronger.full)


@Cached
@njit(nogil=True, cache=True, error_model="numpy", fastmath=FAST)
def share(law, tables, weaker, stronger, equal, y, out):
    """`_share` at every y (M, k), into ``out`` (M, k)."""
    for m in range(y.shape[0]):
        for i in range(y.shape[1]):
            v = math.sqrt(y[m, i])
            _share(law, tables, weaker[m], stronger[m], equal[m], v, out[m, i])


@Cached
@njit(nogil=True, cache=True, error_model="numpy", fastmath=FAST)
def fill(law, tables, weaker, stronger, equal, turned, breaks, order, edges, nodes, slope, R,
         rows, bottom, floor):  # fmt: skip
    """Weighted columns and gaps (M, 8, n), and both where nothing changes any more.

    ``edges`` (M, k) are roots of the weaker side's indentation; ``turned`` tells where that is
    the second surface, ``breaks`` and ``order`` the regimes of the law.
    """
    per = len(nodes)
    n = rows.shape[2]
    both, weight, values = np.empty(1, SHARED)[0], np.empty(per), np.empty((8, per))
    for m in range(len(edges)):
        A, B = weaker[m], stronger[m]
        for p in range(edges.shape[1]):
            end = p == edges.shape[1] - 1
            low, high = edges[m, p], edges[m, p if end else p + 1]
            for j in range(1 if end else per):
                v = high if end else 0.5 * (low + high) + 0.5 * (high - low) * nodes[j]
                _share(law, tables, A, B, equal[m], v, both)
                y = both.y_stronger if turned[m] else v * v
                a1 = R * math.pi * A.delta * both.area_weaker
                a2 = R * math.pi * B.delta * both.area_stronger
                cap = B.cap if turned[m] else A.cap
                if turned[m]:
                    a1, a2 = a2, a1
                branch = 0
                while branch < len(breaks) and y >= breaks[branch]:
                    branch += 1
                regime = 2 if law.plateau and y >= cap else order[branch]
                values[0, j] = A.unit * both.load
                for c in range(3):
                    values[1 + c, j] = a1 if c == regime else 0.0
                values[4, j], values[5, j] = a2, max(a1, a2)
                values[6, j] = R * math.pi / 2
                values[7, j] = A.delta * v * v + B.delta * both.y_stronger
            if end:
                bottom[m] = 1 - values[7, 0]
                floor[m] = values[:7, 0]
                continue
            weight[:] = 0.0
            for i in range(per):
                eps = values[7, i]
                for j in range(per):
                    weight[j] += slope[i, j] * eps
            at = n - (p + 1) * per
            for j in range(per):
                for c in range(7):
                    rows[m, c, at + j] = weight[per - 1 - j] * values[c, per - 1 - j]
                rows[m, 7, at + j] = 1 - values[7, per - 1 - j]


@Cached
@njit(nogil=True, cache=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
def gather(rows, bottom, transform, out):
    """Columns of rules (M, 8, n) moved to Chebyshev nodes between their bottoms and 1.

    ``transform`` (m, m) takes values at these nodes to coefficients.
    """
    terms = len(transform)
    before, now, after, at = np.empty((4, rows.shape[2]))
    for m in range(len(rows)):
        half = 0.5 * (1 - bottom[m])
        for j in range(len(at)):
            at[j] = (rows[m, 7, j] - bottom[m]) / half - 1
        out[m] = 0.0
        before[:], now[:] = 0.0, 1.0
        for i in range(terms):
            for c in range(7):
                moment = 0.0
                for j in range(len(at)):
                    moment += rows[m, c, j] * now[j]
                for k in range(terms):
                    out[m, c, k] += moment * transform[i, k]
            factor = 2.0 if i else 1.0
            for j in range(len(at)):
                after[j] = factor * at[j] * now[j] - before[j]
            before, now, after = now, after, before
