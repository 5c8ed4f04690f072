r"""The programme of one field: which pressures a rough surface carries at a separation.

.. math:: \Phi(h) = \max_{b \ge 0,\ 0 \le f \le \chi}\ c\,\langle s f\rangle - h\,\langle f\rangle
          - \sqrt2\sum_{n \ge 1} k_n(b)\,a_n^2, \qquad
          a_n = \int f(s)\,\mathrm{he}_n(s)\,\varphi(s)\,ds

Heights that are not Gaussian, z/σ = Σ G_n he_n(t), have Σ G_n cⁿ a_n in the place of c⟨s f⟩, which
is c a_1, and √2 √(Σ n G_n²) in that of √2; all else is of t.

f is 0 below an edge s_0, rises from it like a root, and is χ above a second edge s_1. With
:math:`s = s_0 + (s_1 - s_0)(1 - \cos\theta)/2`,

.. math:: f = \chi\,\theta/\pi + \sum_j c_j \sin j\theta ,

whose c_j are linear in the rest. The edges are where no mode that is singular there could gain,
b where the energy turns. Terms beyond the last n act like a spring of their own,
:math:`k_n \to \kappa k_N`: κ = 0.6 gives Φ and a_n to 3e-5, κ = 0.3 the edges to 0.002.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import ndtr

from ...errors import NoEquilibrium
from ...numerics.quadrature import gauss_legendre

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .spectrum import FilteredSeries

    Array = NDArray[np.float64]

__all__ = ["MOMENTS", "Edges", "Pressed", "solve_programme"]

MOMENTS = 12
"""a_n that are kept: the ground of particles then is known to 0.7 %."""
TERMS, MODES, NODES = 400, 16, 40
"""Of the sum over n, of f in θ, of integrals over θ."""
ENERGY, EDGE = 0.6, 0.3
"""κ for energy and moments, and for the edges."""
HEAVY = 10.0
"""(s² − s_0²)/2 where a surface that does not yield is cut: 5e-5 of what is pressed lie beyond."""
SLIGHT = 4.5
"""(s² − s_0²)/2 from which what yields is 1e-2 of what is pressed, and changes Φ by 1e-5."""
ROUNDS, CLOSE, GOOD = 24, 1e-6, 1e-4
STEP = 1e-4
ROOT2 = math.sqrt(2.0)


class Edges(NamedTuple):
    """Where f begins and where it is χ, and the filter: arrays (N,)."""

    low: Array
    """s_0"""
    width: Array
    """ln(s_1 − s_0)"""
    tau: Array
    """b/(1 + b)"""
    elastic: NDArray[np.bool_]
    """f stays below χ wherever it weighs."""

    def plus(self, step: Array) -> Edges:
        """Moved by (N, 3), τ kept from 0 to 1."""
        tau = np.clip(self.tau + step[:, 2], 0.0, 1.0)
        return Edges(self.low + step[:, 0], self.width + step[:, 1], tau, self.elastic)

    def without_slight(self) -> Edges:
        """The same, elastic where hardly anything yields."""
        far = np.sqrt(np.maximum(self.low, 0.0) ** 2 + 2 * SLIGHT)
        beyond = ~(self.low + np.exp(np.minimum(self.width, 3.0)) < far)
        return self._replace(elastic=self.elastic | beyond)

    @property
    def high(self) -> Array:
        """s_1, or where a surface that does not yield is cut."""
        far = np.sqrt(np.maximum(self.low, 0.0) ** 2 + 2 * HEAVY)
        return np.where(self.elastic, far, self.low + np.exp(np.minimum(self.width, 3.0)))


@dataclass(frozen=True, eq=False, kw_only=True)
class Pressed:
    """States of the programme at separations h (N,) over σ.

    Attributes
    ----------
    energy : array (N,)
        Φ; the load is E*gσ⁰⟨f⟩ = −E*g dΦ/dh [1].
    moments : array (N, 13)
        a_0 = ⟨f⟩ to a_12 [1].
    edges : Edges
        Of the sums cut for Φ; ``low`` and ``high`` of area stand below.
    low, high : array (N,)
        s_0 and s_1 [1].
    miss : array (N,)
        The last step of the iteration [1].
    """

    h: Array
    energy: Array
    moments: Array
    edges: Edges
    low: Array
    high: Array
    miss: Array

    @property
    def area(self) -> Array:
        """Q(s_0), the part of the surface that is pressed [1]."""
        return ndtr(-self.low)

    @property
    def plastic(self) -> Array:
        """Part of that area in which f = χ [1]."""
        return np.where(self.edges.elastic, 0.0, ndtr(-self.high) / ndtr(-self.low))


class _State(NamedTuple):
    energy: Array
    moments: Array
    turns: Array
    """What is zero at the maximum: gain of the modes singular at s_0 and s_1, slope in τ."""
    form: Array
    """Coefficients of f: of θ/π, and c_j."""


class _Basis:
    """What does not depend on the state."""

    def __init__(self, series: FilteredSeries):
        x, weight = gauss_legendre(NODES)
        theta = 0.5 * math.pi * (1 + x)
        self.series, self.count = series, series.count
        self.weight = 0.5 * math.pi * weight
        self.cos, self.sin = np.cos(theta), np.sin(theta)
        modes = np.sin(np.arange(1, MODES + 1)[:, None] * theta)
        self.f = np.concatenate([[theta / math.pi], modes])
        self.pairs = np.einsum("jm,km->mjk", self.f, self.f)
        self.roots = np.sqrt(np.arange(self.count + 2))
        self.heights = np.array(series.spectrum.heights)
        self.most = slice(1, len(self.heights) + 1)
        self.root2 = ROOT2 * series.spectrum.steeper

    def hermite(self, s: Array) -> Array:
        """φ he_n at s (N, M): (N, M, count + 1)."""
        out = np.empty((self.count + 1, *s.shape))
        out[0] = np.exp(-0.5 * s * s) / math.sqrt(2 * math.pi)
        out[1] = s * out[0]
        root = self.roots
        for n in range(1, self.count):
            out[n + 1] = (s * out[n] - root[n] * out[n - 1]) / root[n + 1]
        return np.moveaxis(out, 0, -1)

    def state(self, h: Array, chi: Array, edges: Edges, kappa: float) -> _State:
        """Best f between given edges, and its residual."""
        c, dc, k, dk = self.series(edges.tau)
        order, most, root2 = np.arange(1, len(self.heights) + 1), self.most, self.root2
        weights = self.heights * c[:, None] ** order  # ⟨z f⟩ = Σ G_n cⁿ a_n
        bends = self.heights * order * c[:, None] ** (order - 1) * dc[:, None]
        last, dlast = kappa * k[:, -1], kappa * dk[:, -1]
        low, high = edges.low, edges.high
        span = (high - low)[:, None]
        s = low[:, None] + 0.5 * span * (1 - self.cos)
        he = self.hermite(s)
        at_end = self.hermite(high[:, None])[:, 0]
        stretch = 0.5 * span * self.sin * self.weight  # ds of each node
        a = (self.f * stretch[:, None, :]) @ he
        a[:, 0, 0] += ndtr(-high)
        a[:, 0, 1:] += at_end[:, :-1] / self.roots[1 : self.count + 1]
        square = np.tensordot(stretch * he[:, :, 0], self.pairs, 1)
        square[:, 0, 0] += ndtr(-high)
        more = k - last[:, None]
        more[:, 0] = -last
        stiff = 2 * root2 * ((a * more[:, None, :]) @ a.transpose(0, 2, 1))
        stiff += 2 * root2 * last[:, None, None] * square
        gain = np.einsum("in,ijn->ij", weights, a[:, :, most]) - h[:, None] * a[:, :, 0]
        f = _best(stiff, gain, chi, edges.elastic)
        energy = np.sum(gain * f, axis=1) - 0.5 * np.einsum("ij,ijk,ik->i", f, stiff, f)
        a = np.einsum("ij,ijn->in", f, a)
        pressure = f @ self.f

        def lacks(mode: Array) -> Array:
            weighted = 0.5 * span * mode * self.weight
            moments = np.einsum("im,imn->in", weighted, he)
            last_bent = 2 * root2 * last * np.sum(weighted * he[:, :, 0] * pressure, axis=1)
            bent = 2 * root2 * np.sum(more * a * moments, axis=1)
            lifted = np.sum(weights * moments[:, most], axis=1)
            return (lifted - h * moments[:, 0] - bent - last_bent) / moments[:, 0]

        rest = np.einsum("ij,ijk,ik->i", f, square, f) - np.sum(a * a, axis=1)
        turn = np.sum(bends * a[:, most], axis=1) - root2 * (
            np.sum(dk[:, 1:] * a[:, 1:] ** 2, axis=1) + dlast * rest
        )
        second = np.where(edges.elastic, 0.0, lacks(1 - self.cos))
        turns = np.stack([lacks(1 + self.cos), second, turn / energy], axis=1)
        return _State(energy, a, turns, f)


def _best(stiff: Array, gain: Array, chi: Array, elastic: NDArray[np.bool_]) -> Array:
    """Coefficients of the stationary f; the first is χ where the surface yields."""
    out = np.empty(gain.shape)
    if elastic.any():
        out[elastic] = np.linalg.solve(stiff[elastic], gain[elastic][..., None])[..., 0]
    if not elastic.all():
        some = ~elastic
        rest = gain[some][:, 1:] - stiff[some][:, 1:, 0] * chi[some][:, None]
        out[some, 0] = chi[some]
        out[some, 1:] = np.linalg.solve(stiff[some][:, 1:, 1:], rest[..., None])[..., 0]
    return out


def _newton_steps(
    basis: _Basis,
    h: Array,
    chi: Array,
    edges: Edges,
    kappa: float,
    rounds: int,
    fixed: NDArray[np.bool_] | None = None,
) -> tuple[Edges, Array]:
    """Newton's steps on edges and τ, no longer than is safe; and the last of them.

    The slopes are taken afresh where steps do not become much smaller. The width of f stays where
    it is ``fixed``.
    """
    size, before = np.full(len(h), np.inf), np.full(len(h), np.inf)
    slope = np.zeros((len(h), 3, 3))
    stale = True
    for _ in range(rounds):
        turns = basis.state(h, chi, edges, kappa).turns
        if stale:
            slope = _slope(basis, h, chi, edges, kappa, turns)
        if not np.all(np.isfinite(slope)):
            break
        held = np.zeros((len(h), 3), bool)
        held[:, 1] = edges.elastic if fixed is None else edges.elastic | fixed
        held[:, 2] = ((edges.tau <= 0) & (turns[:, 2] < 0)) | ((edges.tau >= 1) & (turns[:, 2] > 0))
        free = np.where(held[:, :, None] | held[:, None, :], 0.0, slope)
        free[:, range(3), range(3)] += held
        step = -(np.linalg.pinv(free) @ np.where(held, 0.0, turns)[..., None])[..., 0]
        size = np.max(np.abs(step), axis=1)
        with np.errstate(divide="ignore"):
            allowed = np.min(np.array([0.2, 0.3, 0.15]) / np.abs(step), axis=1)
        edges = edges.plus(step * np.minimum(allowed, 1.0)[:, None])
        if np.all(size < CLOSE):
            break
        stale = bool(np.any((size > 0.2 * before) & (size > CLOSE)))
        before = np.where(stale, np.inf, size)
    return edges, size


def _slope(basis: _Basis, h: Array, chi: Array, edges: Edges, kappa: float, turns: Array) -> Array:
    """Slopes of ``turns`` in the three variables: (N, 3, 3)."""
    out = np.empty((len(h), 3, 3))
    for j in range(3):
        move = np.zeros((len(h), 3))
        move[:, j] = np.where((edges.tau > 0.5) & (j == 2), -STEP, STEP)
        there = basis.state(h, chi, edges.plus(move), kappa).turns
        out[:, :, j] = (there - turns) / move[:, j, None]
    return out


def solve_programme(
    series: FilteredSeries, h: Array, chi: float, start: Edges, *, rounds: int = ROUNDS
) -> Pressed:
    """The programme at separations h (N,) and hardness χ, from a start that is near.

    Raises
    ------
    NoEquilibrium
        The iteration did not find the edges.
    """
    basis = _Basis(series)
    chis = np.full(len(h), chi)
    begun = start.without_slight()
    edges, miss = _newton_steps(basis, h, chis, begun, ENERGY, rounds)
    slight = edges.without_slight().elastic & ~edges.elastic
    if slight.any():  # the second edge has no hold there
        edges = Edges(*(np.where(slight, a, b) for a, b in zip(begun, edges, strict=True)))
        edges = edges._replace(elastic=edges.elastic | slight)
        edges, miss = _newton_steps(basis, h, chis, edges, ENERGY, rounds)
    fixed = ~(miss < GOOD) & ~edges.elastic
    if fixed.any():  # it yields so little that the second edge swings; Φ is stationary in it
        edges = Edges(*(np.where(fixed, a, b) for a, b in zip(begun, edges, strict=True)))
        edges, miss = _newton_steps(basis, h, chis, edges, ENERGY, rounds, fixed)
    state = basis.state(h, chis, edges, ENERGY)
    fine, fine_miss = _newton_steps(basis, h, chis, edges, EDGE, rounds)
    miss = np.maximum(miss, fine_miss)
    if not np.all(miss < GOOD):
        where = ", ".join(f"{x:.3g}" for x in h[~(miss < GOOD)][:5])
        raise NoEquilibrium(f"the programme of one field did not converge at h = {where} sigma")
    return Pressed(
        h=h, energy=state.energy, moments=state.moments[:, : MOMENTS + 1], edges=edges,
        low=fine.low, high=fine.high, miss=miss,
    )  # fmt: skip
