"""Rigid-plastic flow of meshed bodies: velocities that make the power least, forces at nodes.

Stress follows von Mises: s = 2 η D, η = Y/3 / sqrt(e² + e₀²), e² = 2/3 D : D. Velocities are
quadratic with a bubble, pressure is linear in each triangle (Crouzeix and Raviart 1973,
doi:10.1051/m2an/197307R300331), held by a penalty. Newton steps with a line search on the power.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

PENALTY = 1e5
"""Bulk stiffness that holds volume, and stiffness that holds faces together [Y·R/velocity]."""


def _rule() -> tuple[Array, Array]:
    """Barycentric points and weights of degree 5 on a triangle (Radon)."""
    a, b = (6 - math.sqrt(15)) / 21, (6 + math.sqrt(15)) / 21
    points, weights = [[1 / 3] * 3], [9 / 40]
    for c, w in ((a, (155 - math.sqrt(15)) / 1200), (b, (155 + math.sqrt(15)) / 1200)):
        for k in range(3):
            point = [c, c, c]
            point[k] = 1 - 2 * c
            points.append(point)
            weights.append(w)
    return np.array(points), np.array(weights)


NEWTON = 0.95
"""Part of Newton's tangent in a step: 1 is Newton's, 0 Picard's."""

POINTS, WEIGHTS = _rule()
Q = len(WEIGHTS)


@njit(cache=True)
def _shape(point: Array, g: Array, n: Array, d: Array) -> None:
    """Shape functions n (7) and their gradients d (7, 2) at a barycentric point; g = grad L."""
    p, q, s = point
    n[0], n[1], n[2] = p * (2 * p - 1), q * (2 * q - 1), s * (2 * s - 1)
    n[3], n[4], n[5], n[6] = 4 * p * q, 4 * q * s, 4 * s * p, 27 * p * q * s
    for k in range(2):
        d[0, k], d[1, k], d[2, k] = (4 * p - 1) * g[0, k], (4 * q - 1) * g[1, k], 0.0
        d[2, k] = (4 * s - 1) * g[2, k]
        d[3, k] = 4 * (p * g[1, k] + q * g[0, k])
        d[4, k] = 4 * (q * g[2, k] + s * g[1, k])
        d[5, k] = 4 * (s * g[0, k] + p * g[2, k])
        d[6, k] = 27 * (p * q * g[2, k] + q * s * g[0, k] + s * p * g[1, k])


@njit(cache=True)
def _gradients(x: Array, nodes: Ints, g: Array) -> float:
    """Gradients of the barycentric coordinates into g (3, 2); returns twice the area."""
    a, b, c = x[nodes[0]], x[nodes[1]], x[nodes[2]]
    twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    g[0, 0], g[0, 1] = (b[1] - c[1]) / twice, (c[0] - b[0]) / twice
    g[1, 0], g[1, 1] = (c[1] - a[1]) / twice, (a[0] - c[0]) / twice
    g[2, 0], g[2, 1] = (a[1] - b[1]) / twice, (b[0] - a[0]) / twice
    return twice


@njit(cache=True)
def _strains(n: Array, d: Array, r: float, b: Array) -> None:
    """Rates rr, zz, θθ, rz (engineering) of each component of velocity into b (4, 14)."""
    b[:] = 0.0
    for i in range(7):
        b[0, 2 * i], b[1, 2 * i + 1] = d[i, 0], d[i, 1]
        b[2, 2 * i] = n[i] / r
        b[3, 2 * i], b[3, 2 * i + 1] = d[i, 1], d[i, 0]


@njit(cache=True)
def _stress(rate: Array, old: Array, y: float, stiff: float, e0: float, out: Array) -> float:
    """Response at one point: deviator of stress, its direction, secant and tangent, potential.

    Into out (10): deviator rr, zz, θθ, rz; direction alike; 2 η, the secant stiffness; c, so that
    the tangent is 2 η I - c (direction ⊗ direction). stiff = 2 G Δt, 0 for rigid-plastic.
    """
    mean = (rate[0] + rate[1] + rate[2]) / 3.0
    dr, dz, dt, dg = rate[0] - mean, rate[1] - mean, rate[2] - mean, 0.5 * rate[3]
    if stiff == 0.0:
        e2 = 2.0 / 3.0 * (dr * dr + dz * dz + dt * dt + 2.0 * dg * dg) + e0 * e0
        out[4], out[5], out[6], out[7] = dr, dz, dt, dg
        out[8] = 2.0 / 3.0 * y / math.sqrt(e2)
        out[9] = out[8] * 2.0 / 3.0 / e2
        for i in range(4):
            out[i] = out[8] * out[4 + i]
        return y * math.sqrt(e2)
    out[4], out[5] = old[0] + stiff * dr, old[1] + stiff * dz
    out[6], out[7] = old[2] + stiff * dt, old[3] + stiff * dg
    q2 = 1.5 * (out[4] ** 2 + out[5] ** 2 + out[6] ** 2 + 2.0 * out[7] ** 2)
    q = math.sqrt(q2)
    part, out[9] = 1.0, 0.0
    potential = q2 / (3.0 * stiff)
    if q > y:
        part = y / q
        out[9] = part * stiff * 1.5 / q2
        potential = (2.0 * y * q - y * y) / (3.0 * stiff)
    out[8] = part * stiff
    for i in range(4):
        out[i] = part * out[4 + i]
    return potential


@njit(cache=True)
def assemble(x, triangles, yields, elastic, u, bubble, e_given, e0, newton, out):
    """Stiffness (T, 12, 12) and force (T, 12) of each triangle, its bubble condensed.

    With e_given[0, 0] >= 0 rigid-plastic viscosities follow these rates, else those of u. `elastic`
    holds 2 G Δt and K Δt (T,) (0: rigid-plastic) and old deviators and pressures (T, Q, 5). Into
    out[2] (T, 2, 12) and out[3] (T, 2) go what gives the bubble's increment back: -(c + b δ).
    """
    out_k, out_g, out_b, out_c = out
    shear, bulk, old = elastic
    g, n, d = np.empty((3, 2)), np.empty(7), np.empty((7, 2))
    k, f, q = np.empty((14, 14)), np.empty(14), np.empty(14)
    div, mass, drive = np.empty((3, 14)), np.empty((3, 3)), np.empty(14)
    b, rate, law, sum_b = np.empty((4, 14)), np.empty(4), np.empty(10), np.empty(14)
    for t in range(len(triangles)):
        nodes = triangles[t]
        twice = _gradients(x, nodes, g)
        for i in range(6):
            drive[2 * i], drive[2 * i + 1] = u[nodes[i], 0], u[nodes[i], 1]
        drive[12], drive[13] = bubble[t, 0], bubble[t, 1]
        k[:], div[:], mass[:], f[:] = 0.0, 0.0, 0.0, 0.0
        for p in range(Q):
            _shape(POINTS[p], g, n, d)
            r = 0.0
            for i in range(3):
                r += POINTS[p, i] * x[nodes[i], 0]
            w = math.pi * twice * WEIGHTS[p] * r
            _strains(n, d, r, b)
            for i in range(4):
                rate[i] = np.dot(b[i], drive)
            _stress(rate, old[t, p], yields[t], shear[t], e0, law)
            if e_given[0, 0] >= 0.0 and shear[t] == 0.0:
                law[8] = 2.0 / 3.0 * yields[t] / math.sqrt(e_given[t, p] ** 2 + e0 * e0)
                for i in range(4):
                    law[i] = law[8] * law[4 + i]
            c = newton * law[9] * w
            for i in range(14):
                sum_b[i] = b[0, i] + b[1, i] + b[2, i]
                f[i] += w * (law[0] * b[0, i] + law[1] * b[1, i] + law[2] * b[2, i])
                f[i] += w * (law[3] * b[3, i] - old[t, p, 4] * sum_b[i])
                q[i] = law[4] * b[0, i] + law[5] * b[1, i] + law[6] * b[2, i] + law[7] * b[3, i]
            for i in range(14):
                for j in range(14):
                    same = b[0, i] * b[0, j] + b[1, i] * b[1, j] + b[2, i] * b[2, j]
                    same += 0.5 * b[3, i] * b[3, j] - sum_b[i] * sum_b[j] / 3.0
                    k[i, j] += law[8] * w * same - c * q[i] * q[j]
            for a in range(3):
                for i in range(14):
                    div[a, i] += w * POINTS[p, a] * sum_b[i]
                for j in range(3):
                    mass[a, j] += w * POINTS[p, a] * POINTS[p, j]
        _hold(div, mass, drive, bulk[t] if shear[t] > 0.0 else PENALTY, k, f)
        _condense(k, f, out_k[t], out_g[t], out_b[t], out_c[t])


@njit(cache=True)
def _hold(div: Array, mass: Array, drive: Array, bulk: float, k: Array, f: Array) -> None:
    """Stiffness and force that hold the volume added to k (14, 14) and f (14)."""
    held = np.linalg.solve(mass, div)
    for i in range(14):
        for j in range(14):
            value = 0.0
            for a in range(3):
                value += div[a, i] * held[a, j]
            k[i, j] += bulk * value
            f[i] += bulk * value * drive[j]


@njit(cache=True)
def _condense(k: Array, f: Array, out_k: Array, out_g: Array, out_b: Array, out_c: Array) -> None:
    """The last two components taken out of a stiffness (14, 14) and a force (14)."""
    det = k[12, 12] * k[13, 13] - k[12, 13] * k[13, 12]
    for j in range(12):
        out_b[0, j] = (k[13, 13] * k[12, j] - k[12, 13] * k[13, j]) / det
        out_b[1, j] = (k[12, 12] * k[13, j] - k[13, 12] * k[12, j]) / det
    out_c[0] = (k[13, 13] * f[12] - k[12, 13] * f[13]) / det
    out_c[1] = (k[12, 12] * f[13] - k[13, 12] * f[12]) / det
    for i in range(12):
        out_g[i] = f[i] - k[i, 12] * out_c[0] - k[i, 13] * out_c[1]
        for j in range(12):
            out_k[i, j] = k[i, j] - k[i, 12] * out_b[0, j] - k[i, 13] * out_b[1, j]


@njit(cache=True)
def measure(x, triangles, yields, elastic, u, bubble, e0, e_out, new, turn):
    """Potential that the flow makes least, and the plastic power without e₀.

    Into e_out (T, Q) equivalent strain rates, into new (T, Q, 5) deviators and pressures, into
    turn (T, Q, 3) velocity and spin ∂u_r/∂z - ∂u_z/∂r.
    """
    shear, bulk, old = elastic
    g, n, d = np.empty((3, 2)), np.empty(7), np.empty((7, 2))
    div, mass, drive = np.empty(3), np.empty((3, 3)), np.empty(14)
    b, rate, law = np.empty((4, 14)), np.empty(4), np.empty(10)
    total, plain = 0.0, 0.0
    for t in range(len(triangles)):
        nodes = triangles[t]
        twice = _gradients(x, nodes, g)
        for i in range(6):
            drive[2 * i], drive[2 * i + 1] = u[nodes[i], 0], u[nodes[i], 1]
        drive[12], drive[13] = bubble[t, 0], bubble[t, 1]
        div[:], mass[:] = 0.0, 0.0
        for p in range(Q):
            _shape(POINTS[p], g, n, d)
            r = 0.0
            for i in range(3):
                r += POINTS[p, i] * x[nodes[i], 0]
            w = math.pi * twice * WEIGHTS[p] * r
            _strains(n, d, r, b)
            for i in range(4):
                rate[i] = np.dot(b[i], drive)
            trace = rate[0] + rate[1] + rate[2]
            total += w * (
                _stress(rate, old[t, p], yields[t], shear[t], e0, law) - old[t, p, 4] * trace
            )
            e2 = rate[0] ** 2 + rate[1] ** 2 + rate[2] ** 2 + 0.5 * rate[3] ** 2
            e_out[t, p] = math.sqrt(2.0 / 3.0 * e2)
            plain += w * yields[t] * e_out[t, p]
            for i in range(4):
                new[t, p, i] = law[i]
            for a in range(3):
                div[a] += w * POINTS[p, a] * trace
                for j in range(3):
                    mass[a, j] += w * POINTS[p, a] * POINTS[p, j]
            turn[t, p, 0], turn[t, p, 1], turn[t, p, 2] = 0.0, 0.0, 0.0
            for i in range(7):
                turn[t, p, 0] += n[i] * drive[2 * i]
                turn[t, p, 1] += n[i] * drive[2 * i + 1]
                turn[t, p, 2] += d[i, 1] * drive[2 * i] - d[i, 0] * drive[2 * i + 1]
        held = np.linalg.solve(mass, div)
        hold = bulk[t] if shear[t] > 0.0 else PENALTY
        total += 0.5 * hold * np.dot(div, held)
        for p in range(Q):
            new[t, p, 4] = old[t, p, 4] - hold * np.dot(POINTS[p], held)
    return total, plain


@dataclass(frozen=True)
class Face:
    """Two faces that touch and slide: pairs of nodes, or a node and a rigid body (-1)."""

    upper: Ints
    """Nodes of the surface: (P,); -1 where it is rigid."""
    lower: Ints
    """Nodes of the particle: (P,); -1 where it is rigid."""
    normal: Array
    """Unit normals: (P, 2)."""
    weight: Array
    """Area of each pair [R²]: (P,)."""
    grip: Array
    """Weight of the constraint along the normal: (P,), > 0 on the axis too."""
    strength: float
    """Shear stress of the faces m k [Y]."""


@dataclass
class Problem:
    """What moves: nodes, triangles, what is held, and faces that touch."""

    x: Array
    triangles: Ints
    yields: Array
    elastic: tuple[Array, Array, Array]
    """2 G Δt and K Δt (T,), 0 where rigid-plastic; old deviators and pressures (T, Q, 5)."""
    held: NDArray[np.bool_]
    """Held components of velocity: (N, 2)."""
    velocity: Array
    """Velocity of what is held [1]: (N, 2)."""
    face: Face
    upper_velocity: tuple[float, float]
    """Velocity of a rigid surface."""
    rest: float
    """Strain rate e₀ below which the bodies are all but rigid."""
    slow: float
    """Sliding below which faces all but stick."""


@dataclass
class Flow:
    """Velocities that make the power least."""

    u: Array
    bubble: Array
    rate: Array
    """Equivalent strain rates (T, Q)."""
    stress: Array
    """Deviators rr, zz, θθ, rz and pressures (T, Q, 5)."""
    turn: Array
    """Velocities and spins at the same points (T, Q, 3)."""
    force: Array
    """Force that holds each node (N, 2)."""
    lower_force: float
    """Force along z on a rigid particle."""
    upper_force: float
    """Force along z on a rigid surface."""
    power: float
    """Plastic power and friction, without e₀: an upper bound of the load where volume is kept."""
    steps: int
    change: float
    """Newton's last relative change of the velocities."""


def _jumps(problem: Problem, u: Array) -> Array:
    """Velocity of the surface's face less the particle's: (P, 2)."""
    face = problem.face
    above = np.where(face.upper[:, None] >= 0, u[face.upper], np.array(problem.upper_velocity))
    return above - np.where(face.lower[:, None] >= 0, u[face.lower], 0.0)


class _Measured:
    """Potential, power and fields of one trial velocity."""

    def __init__(self, problem: Problem, u: Array, bubble: Array):
        shape = (len(problem.triangles), Q)
        self.u, self.bubble = u, bubble
        self.rate = np.empty(shape)
        self.stress, self.turn = np.empty((*shape, 5)), np.empty((*shape, 3))
        total, plain = measure(
            problem.x, problem.triangles, problem.yields, problem.elastic, u, bubble,
            problem.rest, self.rate, self.stress, self.turn,
        )  # fmt: skip
        face, jump = problem.face, _jumps(problem, u)
        n = (jump * face.normal).sum(1)
        t = jump[:, 1] * face.normal[:, 0] - jump[:, 0] * face.normal[:, 1]
        drag = face.strength * face.weight
        self.total = total + float((drag * np.sqrt(t * t + problem.slow**2)).sum())
        self.total += 0.5 * PENALTY * float((face.grip * n * n).sum())
        self.power = plain + float((drag * np.abs(t)).sum())


def _face_terms(problem: Problem, u: Array, newton: float) -> tuple[Array, Array]:
    """Stiffness (P, 2, 2) and force (P, 2) of a jump of velocity across each pair."""
    face, jump = problem.face, _jumps(problem, u)
    n = face.normal
    tangent = np.stack([-n[:, 1], n[:, 0]], 1)
    slide = (jump * tangent).sum(1)
    speed = np.sqrt(slide**2 + problem.slow**2)
    drag = face.strength * face.weight / speed
    stiff = drag * (1 - newton * (slide / speed) ** 2)
    hold = PENALTY * face.grip
    k = (
        hold[:, None, None] * n[:, :, None] * n[:, None, :]
        + stiff[:, None, None] * tangent[:, :, None] * tangent[:, None, :]
    )
    force = (hold * (jump * n).sum(1))[:, None] * n + (drag * slide)[:, None] * tangent
    return k, force


class Solver:
    """Newton's steps for one problem."""

    def __init__(self, problem: Problem):
        self.problem = p = problem
        count = len(p.x)
        free = ~p.held.reshape(-1)
        self.index = np.where(free, np.cumsum(free) - 1, -1)
        self.free = free
        dofs = np.stack([2 * p.triangles, 2 * p.triangles + 1], -1).reshape(len(p.triangles), 12)
        self.dofs = dofs
        pairs = np.stack([p.face.upper, p.face.lower], 1)
        ends = np.stack([2 * pairs, 2 * pairs + 1], -1).reshape(-1, 4)
        self.ends = np.where(np.repeat(pairs >= 0, 2, axis=1), ends, -1)
        rows = [np.repeat(dofs, 12, axis=1).ravel(), np.repeat(self.ends, 4, axis=1).ravel()]
        columns = [np.tile(dofs, 12).ravel(), np.tile(self.ends, 4).ravel()]
        row, column = np.concatenate(rows), np.concatenate(columns)
        i = np.where(row >= 0, self.index[row], -1)
        j = np.where(column >= 0, self.index[column], -1)
        self.keep = (i >= 0) & (j >= 0)
        self.i, self.j = i[self.keep], j[self.keep]
        self.size = int(free.sum())
        t = len(p.triangles)
        self.out = (
            np.empty((t, 12, 12)), np.empty((t, 12)), np.empty((t, 2, 12)), np.empty((t, 2))
        )  # fmt: skip
        self.count = count

    def forces(
        self, u: Array, bubble: Array, given: Array | None = None, newton: float = 0.0
    ) -> tuple[Array, Array]:
        """Forces at the nodes (2N,) and the entries of the matrix, not yet added up."""
        p = self.problem
        none = np.full((1, 1), -1.0)
        assemble(
            p.x, p.triangles, p.yields, p.elastic, u, bubble, none if given is None else given,
            p.rest, newton, self.out,
        )  # fmt: skip
        fk, ff = _face_terms(p, u, newton)
        block = np.concatenate([np.concatenate([fk, -fk], 2), np.concatenate([-fk, fk], 2)], 1)
        values = np.concatenate([self.out[0].ravel(), block.ravel()])[self.keep]
        force = np.zeros(2 * self.count)
        np.add.at(force, self.dofs, self.out[1])
        both = np.concatenate([ff, -ff], 1)
        on = self.ends >= 0
        np.add.at(force, self.ends[on], both[on])
        return force, values

    def step(
        self, u: Array, bubble: Array, given: Array | None, newton: float
    ) -> tuple[Array, Array]:
        """Increments of u and of the bubbles."""
        force, values = self.forces(u, bubble, given, newton)
        matrix = coo_matrix((values, (self.i, self.j)), shape=(self.size, self.size)).tocsc()
        factors = splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )  # fmt: skip
        delta = np.zeros(2 * self.count)
        delta[self.free] = -factors.solve(force[self.free])
        inner = -(self.out[3] + np.einsum("tij,tj->ti", self.out[2], delta[self.dofs]))
        return delta.reshape(-1, 2), inner


def solve(
    problem: Problem, guess: Array | None = None, tolerance: float = 2e-3, most: int = 40
) -> Flow:
    """Flow of least power; guess: strain rates (T, Q) that start the viscosities.

    Steps end when velocities change by less than the tolerance, over the largest, or the
    potential by less than a fiftieth of it.
    """
    solver = Solver(problem)
    u = np.where(problem.held, problem.velocity, 0.0)
    bubble = np.zeros((len(problem.triangles), 2))
    start = np.ones((len(problem.triangles), Q)) if guess is None else guess
    du, db = solver.step(u, bubble, start, 0.0)
    now = _Measured(problem, u + du, bubble + db)
    change, steps = math.inf, 1
    while change > tolerance and steps < most:
        du, db = solver.step(now.u, now.bubble, None, 0.0 if steps < 3 else NEWTON)
        best, part, size = None, 1.0, 1.0
        for _ in range(6):
            trial = _Measured(problem, now.u + size * du, now.bubble + size * db)
            if best is None or trial.total < best.total:
                best, part = trial, size
            elif best.total <= now.total:
                break
            size /= 2
        assert best is not None
        change = part * float(np.abs(du).max() / np.abs(best.u).max())
        small = abs(best.total - now.total) < 0.02 * tolerance * best.power
        now = best
        steps += 1
        if small:
            break
    force, _ = solver.forces(now.u, now.bubble)
    _, on_face = _face_terms(problem, now.u, 0.0)
    lower = float(-on_face[problem.face.lower < 0, 1].sum())
    upper = float(-on_face[problem.face.upper < 0, 1].sum())
    return Flow(
        now.u, now.bubble, now.rate, now.stress, now.turn, force.reshape(-1, 2), lower, upper,
        now.power, steps, change,
    )  # fmt: skip
