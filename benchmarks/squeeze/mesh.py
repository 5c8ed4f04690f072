"""Triangles in one body: points graded by a size field, Delaunay; nodes on corners and sides."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.spatial import Delaunay

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

GRADE = 0.25
"""Growth of the triangles' size per length away from where it is given."""
CLEAR = 0.62
"""Least distance of an inner point from the boundary, in local sizes."""
SMOOTHINGS = 4


@dataclass(frozen=True)
class Mesh:
    """Triangles of six nodes in one body."""

    x: Array
    """Places of the nodes (r, z) [R]: (N, 2), corners first."""
    triangles: Ints
    """Nodes of each triangle, three corners and the middles of sides 01, 12, 20: (T, 6)."""
    corners: int
    """Number of corners; those on the boundary stand first, in its order."""
    middle: dict[tuple[int, int], int]
    """Middle node of each side, by its corners in increasing order."""


class MeshError(RuntimeError):
    """No triangles keep to the boundary."""


@njit(cache=True)
def inside(x: Array, polygon: Array) -> NDArray[np.bool_]:
    """Whether points x lie inside a closed polygon: (N,)."""
    out = np.zeros(len(x), dtype=np.bool_)
    n = len(polygon)
    for i in range(len(x)):
        within = False
        k = n - 1
        for j in range(n):
            if (polygon[j, 1] > x[i, 1]) != (polygon[k, 1] > x[i, 1]):
                cut = polygon[k, 0] + (x[i, 1] - polygon[k, 1]) * (
                    polygon[j, 0] - polygon[k, 0]
                ) / (polygon[j, 1] - polygon[k, 1])
                if x[i, 0] < cut:
                    within = not within
            k = j
        out[i] = within
    return out


@njit(cache=True)
def distances(x: Array, polygon: Array) -> Array:
    """Distance of points x from the sides of a closed polygon: (N,)."""
    out = np.empty(len(x))
    n = len(polygon)
    for i in range(len(x)):
        best = np.inf
        for j in range(n):
            ar, az = polygon[j]
            br, bz = polygon[(j + 1) % n]
            dr, dz = br - ar, bz - az
            length = dr * dr + dz * dz
            t = 0.0
            if length > 0.0:
                t = min(1.0, max(0.0, ((x[i, 0] - ar) * dr + (x[i, 1] - az) * dz) / length))
            best = min(best, (ar + t * dr - x[i, 0]) ** 2 + (az + t * dz - x[i, 1]) ** 2)
        out[i] = math.sqrt(best)
    return out


@njit(cache=True)
def sizes(x: Array, sources: Array) -> Array:
    """Local size of triangles [R] at x: least of s_i + GRADE |x - x_i| over sources (r, z, s)."""
    out = np.empty(len(x))
    for i in range(len(x)):
        best = np.inf
        for j in range(len(sources)):
            far = math.hypot(x[i, 0] - sources[j, 0], x[i, 1] - sources[j, 1])
            best = min(best, sources[j, 2] + GRADE * far)
        out[i] = best
    return out


def scatter(polygon: Array, sources: Array) -> Array:
    """Inner points of a body, by halving squares until they are of the local size: (N, 2)."""
    low, high = polygon.min(0), polygon.max(0)
    side = float((high - low).max()) / 2
    steps = [np.arange(b, t, side) + side / 2 for b, t in zip(low, high, strict=True)]
    squares = np.stack(np.meshgrid(*steps, indexing="ij"), -1).reshape(-1, 2)
    leaves = []
    offsets = np.array([[-1, -1], [1, -1], [-1, 1], [1, 1]]) / 4
    while len(squares):
        local = sizes(squares, sources)
        large = side > 1.25 * local
        # a large square may hold a place of smaller size than its middle: GRADE bounds by how much
        leaves.append(squares[~large])
        squares = (squares[large][:, None, :] + offsets * side).reshape(-1, 2)
        squares = squares[inside(squares, polygon) | (distances(squares, polygon) < side)]
        side /= 2
    x = np.concatenate(leaves)
    x = x[inside(x, polygon)]
    return x[distances(x, polygon) > CLEAR * sizes(x, sources)]


def triangulate(boundary: Array, inner: Array) -> Ints:
    """Triangles, counter-clockwise, of points that lie inside a closed polygon: (T, 3)."""
    x = np.concatenate([boundary, inner])
    found = Delaunay(x).simplices.astype(np.int64)
    a, b, c = x[found[:, 0]], x[found[:, 1]], x[found[:, 2]]
    area = _cross(b - a, c - a)
    longest = np.max([((b - a) ** 2).sum(1), ((c - b) ** 2).sum(1), ((a - c) ** 2).sum(1)], axis=0)
    keep = (np.abs(area) > 1e-5 * longest) & inside((a + b + c) / 3, boundary)
    found, area = found[keep], area[keep]
    found[area < 0] = found[area < 0][:, [0, 2, 1]]
    return found


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def smooth(boundary: Array, inner: Array, sources: Array) -> Array:
    """Inner points moved to the middle of their neighbours, weighted by the local size."""
    fixed = len(boundary)
    for _ in range(SMOOTHINGS):
        t = triangulate(boundary, inner)
        x = np.concatenate([boundary, inner])
        total, weight = np.zeros_like(x), np.zeros(len(x))
        ends = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
        for i, j in ((0, 1), (1, 0)):
            np.add.at(total, ends[:, i], x[ends[:, j]])
            np.add.at(weight, ends[:, i], 1.0)
        moved = x[fixed:] + 0.8 * (
            total[fixed:] / np.maximum(weight[fixed:], 1.0)[:, None] - x[fixed:]
        )
        moved = np.where(weight[fixed:, None] > 0, moved, x[fixed:])
        good = inside(moved, boundary)
        good[good] = distances(moved[good], boundary) > 0.5 * sizes(moved[good], sources)
        inner = np.where(good[:, None], moved, inner)
    return inner


def build(boundary: Array, sources: Array, fixed: int) -> Mesh:
    """Triangles of one body from its closed boundary, counter-clockwise, and sizes wanted.

    Parameters
    ----------
    boundary : ndarray, shape (N, 2)
        Corners; sides after the first `fixed` corners may be halved.
    sources : ndarray, shape (S, 3)
        Places and sizes.

    Raises
    ------
    MeshError
        A side of the boundary is no side of a triangle.
    """
    inner = smooth(boundary, scatter(boundary, sources), sources)
    for _ in range(6):
        n = len(boundary)
        sides = {(min(i, (i + 1) % n), max(i, (i + 1) % n)) for i in range(n)}
        t = triangulate(boundary, inner)
        ends = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
        ends, number = np.unique(ends, axis=0, return_inverse=True)
        lost = sorted(sides - set(map(tuple, ends.tolist())))
        if not lost:
            break
        middles = np.array([(boundary[i] + boundary[j]) / 2 for i, j in lost])
        radii = np.array([math.dist(boundary[i], boundary[j]) / 2 for i, j in lost])
        far = np.linalg.norm(inner[:, None] - middles, axis=2) / radii
        inner = inner[np.all(far > 1.05, axis=1)]
        halved = [(j if j == i + 1 else n, k) for k, (i, j) in enumerate(lost) if j >= fixed]
        for at, k in sorted(halved, reverse=True):
            boundary = np.insert(boundary, at, middles[k], axis=0)
    else:
        raise MeshError(f"{len(lost)} sides of the boundary lost, first {boundary[lost[0][0]]}")
    n = len(boundary)
    x = np.concatenate([boundary, inner])
    used = np.unique(t)
    if len(used) < len(x):
        if used[n - 1] != n - 1:
            raise MeshError("a corner of the boundary belongs to no triangle")
        to = np.full(len(x), -1)
        to[used] = np.arange(len(used))
        x, t, ends = x[used], to[t], to[ends]
    count, edges = len(x), len(ends)
    number = number.reshape(3, -1)
    mids = x[ends].mean(1)
    triangles = np.concatenate([t, count + number.T], axis=1)
    middle = {(int(i), int(j)): count + k for k, (i, j) in enumerate(ends)}
    assert edges == len(middle)
    return Mesh(np.concatenate([x, mids]), triangles, count, middle)
