"""Known answers that the flow has to give: flat punch, disc between platens."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from . import curves, flow, mesh

Array = NDArray[np.float64]


def block(corners: list[tuple[float, float]], sources: Array) -> mesh.Mesh:
    """Triangles in a polygon of given corners, counter-clockwise."""
    line = []
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        fine = np.linspace(a, b, 1000)
        line.append(curves.respaced(fine, mesh.sizes(fine, sources))[:-1])
    return mesh.build(np.concatenate(line), sources, len(np.concatenate(line)))


def _rigid_plastic(count: int) -> tuple[Array, Array, Array]:
    return np.zeros(count), np.zeros(count), np.zeros((count, flow.Q, 5))


def flat_punch(rough: bool, size: float = 0.025, domain: float = 6.0) -> tuple[float, float]:
    """Mean pressure under a flat circular punch on a half-space, from below and from above [Y]."""
    sources = np.array([[1.0, 0.0, size]])
    deep = -domain
    made = block([(0, 0), (0, deep), (domain, deep), (domain, 0), (1, 0)], sources)
    x = made.x
    held, velocity = np.zeros((len(x), 2), dtype=bool), np.zeros((len(x), 2))
    held[x[:, 0] < 1e-9, 0] = True
    far = (x[:, 1] < deep + 1e-9) | (x[:, 0] > domain - 1e-9)
    under = (x[:, 1] > -1e-9) & (x[:, 0] < 1 + 1e-9)
    held[far] = True
    held[under, 1], velocity[under, 1] = True, -1.0
    held[under, 0] |= rough
    none, no = np.zeros(0, dtype=np.int64), np.zeros(0)
    face = flow.Face(none, none, np.zeros((0, 2)), no, no, 0.0)
    count = len(made.triangles)
    problem = flow.Problem(
        x, made.triangles, np.ones(count), _rigid_plastic(count), held, velocity, face,
        (0.0, 0.0), 1e-3, 1e-3,
    )  # fmt: skip
    found = flow.solve(problem)
    return (
        float(found.force[far, 1].sum()) / math.pi,
        -float(found.force[under, 1].sum()) / math.pi,
    )


def disc(m: float, half: float, size: float = 0.03) -> float:
    """Mean pressure on a disc of radius 1 and half thickness `half` between platens [Y]."""
    corner = np.array([[1.0, half, size]])
    inner = np.array([[r, half, min(0.5 * half, 0.1)] for r in np.linspace(0, 0.95, 40)])
    made = block([(0, 0), (1, 0), (1, half), (0, half)], np.concatenate([corner, inner]))
    x = made.x
    held = np.zeros((len(x), 2), dtype=bool)
    held[x[:, 0] < 1e-9, 0] = True
    held[x[:, 1] < 1e-9, 1] = True
    top = np.flatnonzero(x[:, 1] > half - 1e-9)
    top = top[np.argsort(x[top, 0])]  # corner, middle, corner …
    r = x[top, 0]
    weight = np.zeros(len(top))
    length = np.diff(r[::2])
    weight[1::2] = 4 * length / 6
    weight[:-1:2] += length / 6
    weight[2::2] += length / 6
    face = flow.Face(
        np.full(len(top), -1), top, np.tile([0.0, 1.0], (len(top), 1)), 2 * math.pi * r * weight,
        2 * math.pi * np.maximum(r, 0.3 * length[0]) * weight, m / math.sqrt(3),
    )  # fmt: skip
    count = len(made.triangles)
    problem = flow.Problem(
        x, made.triangles, np.ones(count), _rigid_plastic(count), held, np.zeros((len(x), 2)),
        face, (0.0, -1.0), 1e-3 / half, 1e-4,
    )  # fmt: skip
    return flow.solve(problem, tolerance=1e-3).upper_force / math.pi


def hill(m: float, half: float) -> float:
    """Pressure of a thin disc [Y]: 1 + 2 m r/(3 √3 t), t = 2 half (Siebel's friction hill)."""
    return 1 + m / (3 * math.sqrt(3) * half)
