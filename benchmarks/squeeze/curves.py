"""Boundaries of two bodies that touch: smooth curves through nodes, where they meet, new nodes."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator

Array = NDArray[np.float64]

FINE = 8
"""Points for each side of a curve when curves are compared."""


def arc(x: Array) -> Array:
    """Length along a curve from its first point: (N,)."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(x, axis=0).T))])


def along(x: Array, places: Array) -> Array:
    """Places on a curve by number of side and part of it, as 3.25: (N, 2)."""
    i = np.minimum(places.astype(int), len(x) - 2)
    return x[i] + (places - i)[:, None] * (x[i + 1] - x[i])


def trimmed(x: Array, least: float) -> Array:
    """A curve without points nearer than that to the one before or the first; ends stay."""
    keep = np.append(True, np.hypot(*np.diff(x, axis=0).T) > least)
    keep &= np.hypot(*(x - x[0]).T) > least
    keep[0] = keep[-1] = True
    return x[keep]


def refined(x: Array, corners: list[int]) -> Array:
    """Smooth curves through points, at FINE times as many: modified Akima between corners."""
    ends = sorted({*corners, len(x) - 1})
    parts = [_smooth(x[a : b + 1]) for a, b in zip(ends, ends[1:], strict=False)]
    return np.concatenate([parts[0], *[p[1:] for p in parts[1:]]])


def _smooth(x: Array) -> Array:
    if len(x) < 3:
        return np.linspace(x[0], x[-1], FINE * (len(x) - 1) + 1)
    s = arc(x)
    t = [np.linspace(a, b, FINE, endpoint=False) for a, b in zip(s, s[1:], strict=False)]
    t = np.append(np.concatenate(t), s[-1])
    return np.asarray(Akima1DInterpolator(s, x, method="makima")(t))


def respaced(x: Array, sizes: Array, least: int = 1) -> Array:
    """Nodes on a curve of many points, spaced by the sizes wanted at those points."""
    s = arc(x)
    c = np.concatenate([[0.0], np.cumsum(np.diff(s) * 2 / (sizes[1:] + sizes[:-1]))])
    count = max(least, round(float(c[-1])))
    at = np.interp(np.linspace(0, c[-1], count + 1), c, s)
    out = np.stack([np.interp(at, s, x[:, k]) for k in (0, 1)], 1)
    out[0], out[-1] = x[0], x[-1]
    return out


@njit(cache=True)
def nearest(x: Array, curve: Array) -> tuple[Array, Array, Array]:
    """Nearest place on a curve: signed distance (positive left of it), segment, and part of it."""
    n = len(x)
    gap, place, part = np.empty(n), np.empty(n), np.empty((n, 2))
    for i in range(n):
        best = np.inf
        for j in range(len(curve) - 1):
            ar, az = curve[j]
            dr, dz = curve[j + 1, 0] - ar, curve[j + 1, 1] - az
            length = dr * dr + dz * dz
            t = 0.0
            if length > 0.0:
                t = min(1.0, max(0.0, ((x[i, 0] - ar) * dr + (x[i, 1] - az) * dz) / length))
            er, ez = x[i, 0] - ar - t * dr, x[i, 1] - az - t * dz
            far = er * er + ez * ez
            if far < best:
                best = far
                place[i] = j + t
                part[i, 0], part[i, 1] = ar + t * dr, az + t * dz
                side = dr * ez - dz * er
                gap[i] = math.sqrt(far) * (1.0 if side >= 0 else -1.0)
    return gap, place, part


def volume(x: Array) -> float:
    """Volume under a curve from the axis to the plane z = 0, turned about the axis [R³]."""
    r, z = x[:, 0], x[:, 1]
    cones = (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) * np.diff(z)
    return float(abs(math.pi / 3 * cones.sum()))
