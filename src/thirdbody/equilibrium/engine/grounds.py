"""The numbers of states with particles on the ground of one field of heights."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import j0

from ...contact.broken_averages import is_rough
from ...contact.field_ground import TERMS, rows_between
from ...contact.particle_averages import NORMAL_REACH, WIDEST
from ...errors import NotCompiled
from ...laws.field.programme import MOMENTS
from ...laws.field.spectrum import (
    FARTHEST,
    NEAR_NODES,
    integrals_of_powers,
    near_nodes,
    rolled_off,
)
from ...laws.field.table import ALPHAS, COLUMNS, rows_of, separations
from ...numerics.chebyshev import chebyshev_transform
from ...numerics.quadrature import gauss_legendre
from ...populations import distributions as sizes
from . import fields as f

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.distributions import Distribution
    from ...populations.roughness import Roughness
    from .sections import Section

    Array = NDArray[np.float64]
    Index = NDArray[np.intp]
    Number = float | Array

__all__ = ["Grounds", "check_grounded"]

WIDTH, NODES = 0.5, 16
"""Of cells over the distance from which others are felt, and nodes of their series."""
BANDWIDTHS, WAVES = (2.8, 3.3, 4.4, 6.2, 8.4), 16
"""Ends of cells over the bandwidth, and nodes over ln(α − 2); outside, integrals over distances end
where their panels do, and jump."""
OF_STATE = (MOMENTS + 1) * (1 + 2 * TERMS)
"""k_n of particles, and series of two more in τ."""
NOTHING_FELT = 2 * FARTHEST
"""Distance from which on neither particles nor asperities feel each other, but as a whole."""
FELT = 0.5
"""Of what series leave out in ground over σ: loads are some hundredths of E*g, at most tenths."""
ROUGH_BANDWIDTHS, ROUGH_WAVES = (2.5, 2.8, 3.3, 4.4, 8.4, 15.0, 30.0), 8
ROUGH_AT_ONCE = 64
"""Of samples that are solved roughly: cells over the bandwidth, nodes of series there, and states
at a time."""
SHORT = "the ground of particles on a field of heights is a table of its own"
"""What is said where the kernel does not know it."""


def check_grounded(contact: Any, found: Sequence[Section]) -> None:
    """Refuse populations whose ground the kernel does not know."""
    if any(each.one.strength is not None or each.law.seat != "rough" for each in found):
        raise NotCompiled(SHORT)
    if contact.asperity_law.spectrum is not None:
        raise NotCompiled(SHORT)


def mean_diameter(found: Sequence[Section], rows: Array) -> Number:
    """Mean diameter of all particles [m], a float or one of each state.

    Parameters
    ----------
    found : list of Section
    rows : array (N, P, ...)
        Their numbers.
    """
    diameters = [
        mean_of_sizes(each.one.diameter, each.changed.diameter, rows[:, s])
        for s, each in enumerate(found)
    ]
    first: Number = diameters[0]
    total: Number = 0.0
    for s, diameter in enumerate(diameters):
        total = total + rows[:, s, f.DENSITY] * (diameter - first)
    return first + total / rows[:, :, f.DENSITY].sum(axis=1)


def mean_of_sizes(one: Distribution, changed: Any, rows: Array) -> Number:
    """Mean diameter of each state [m], of sizes as they are and with arrays in them."""
    if changed is one:
        return one.mean_diameter
    if type(one) is sizes.Monodisperse:
        return changed.mean
    if type(one) is sizes.TruncatedGaussian:
        mean, std = changed.mean, changed.std
        low, high = rows[:, f.LOW], rows[:, f.HIGH]
        A, B = (low - mean) / std, (high - mean) / std
        # norm std √(2π) is one over the mass between the ends
        return mean + std**2 * rows[:, f.NORM] * (np.exp(-0.5 * A * A) - np.exp(-0.5 * B * B))
    if type(one) is sizes.LogNormal:
        return changed.median * np.exp(0.5 * np.log(changed.gsd) ** 2)
    if type(one) is sizes.Uniform:
        return 0.5 * (changed.low + changed.high)
    raise NotCompiled(SHORT)


# ------------------------------------------------------------------------------ displacements
class Displacements:
    """What k_n of particles, of asperities under them and of particles under those are made of.

    Attributes
    ----------
    series : array (C, K, 429)
        Of each cell over the distance from which others are felt, and over the bandwidth.
    which, basis : array (N,), (N, K)
        Cell of each state, and what its terms are there. Below zero, −1 − m for row m of ``alone``.
    alone : array (M, 429)
        Of states whose bandwidth has integrals of its own.
    tails : array (N,)
        What the series leave out, at most.
    """

    def __init__(self, count: int, terms: int):
        self.series, self.basis = np.zeros((1, terms, OF_STATE)), np.zeros((count, terms))
        self.which, self.alone = np.zeros(count, np.int64), np.zeros((1, OF_STATE))
        self.tails = np.zeros(count)

    def fill(
        self, states: Index, keys: list[tuple[float, int, int]], which: Index, basis: Array
    ) -> None:
        """Take the series of these keys, of which each of these states has one."""
        self.series = np.array([_series(*key) for key in keys])
        self.which[states], self.basis[states] = which.ravel(), basis
        tails = np.array([_tail(one, basis.shape[1] > NODES) for one in self.series])
        self.tails[states] = tails[self.which[states]]

    def fill_alone(self, states: Index, alpha: Array, apart: Array) -> None:
        """Take the numbers of each of these states by themselves."""
        pairs, back = np.unique(np.stack([alpha, apart]), axis=1, return_inverse=True)
        count = pairs.shape[1]
        self.alone = np.zeros((max(count, 1), OF_STATE))
        self.which[states] = -1 - back.ravel()
        if is_rough():
            for start in range(0, count, ROUGH_AT_ONCE):
                alpha, apart = pairs[:, start : start + ROUGH_AT_ONCE]
                self.alone[start : start + len(alpha)] = _rows_of(_nearby_waves(alpha), apart)
            return
        for m, pair in enumerate(pairs.T.tolist()):
            self.alone[m] = _numbers(*pair)


def displacements_of(alpha: Any, apart: Array, varies: bool) -> Displacements:
    """Of states with bandwidths α, or one, and distances over √(m0/m2) (N,)."""
    every = np.broadcast_to(np.asarray(alpha, float), len(apart))
    together = (apart < NOTHING_FELT) & (not (varies and is_rough()))
    if varies:
        together &= (every >= BANDWIDTHS[0]) & (every <= BANDWIDTHS[-1])
    out = Displacements(len(apart), WAVES * NODES if varies else NODES)
    few, many = np.flatnonzero(~together), np.flatnonzero(together)
    out.fill_alone(few, every[few], apart[few])
    if not len(many):
        return out
    place, terms = _places(apart[many])
    if not varies:
        cells, which = np.unique(place, return_inverse=True)
        out.fill(many, [(float(alpha), n, -1) for n in cells.tolist()], which, terms)
        return out
    every = every[many]
    cell = np.clip(np.searchsorted(BANDWIDTHS, every, side="right") - 1, 0, len(BANDWIDTHS) - 2)
    ends = np.log(np.array(BANDWIDTHS) - 2)
    x = 2 * (np.log(every - 2) - ends[cell]) / (ends[cell + 1] - ends[cell]) - 1
    across = _terms(x, WAVES)
    both, which = np.unique(np.stack([cell, place]), axis=1, return_inverse=True)
    basis = (across[:, :, None] * terms[:, None, :]).reshape(len(every), -1)
    out.fill(many, [(math.nan, n, m) for m, n in both.T.tolist()], which, basis)
    return out


def _places(apart: Array) -> tuple[Index, Array]:
    """Cells over the distance, and the terms of series there: (N,), (N, NODES)."""
    place = (apart / WIDTH).astype(int)
    return place, _terms(2 * (apart / WIDTH - place) - 1, NODES)


def _terms(x: Array, count: int) -> Array:
    """Chebyshev polynomials at x (N,): (N, count)."""
    return np.cos(np.arange(count) * np.arccos(np.clip(x, -1.0, 1.0))[:, None])


def _tail(series: Array, across: bool) -> float:
    """Last two terms of a series, in either direction."""
    last = np.abs(series[-2:]).sum(axis=0)
    if across:
        square = np.abs(series.reshape(WAVES, NODES, -1))
        last = square[-2:].sum(axis=(0, 1)) + square[:, -2:].sum(axis=(0, 1))
    return float(last.max())


@lru_cache(maxsize=64)
def _series(alpha: float, n: int, cell: int) -> Array:
    """Series over the distance in cell n at α, or over α in a cell of bandwidths too: (K, 429)."""
    if cell < 0:
        return _distance_series(alpha, n)
    low, high = np.log(np.array(BANDWIDTHS[cell : cell + 2]) - 2)
    x, transform = chebyshev_transform(WAVES)
    alphas = 2 + np.exp(low + 0.5 * (high - low) * (1 + x))
    known = np.array([_distance_series(one, n) for one in alphas.tolist()])
    return np.tensordot(transform, known, 1).reshape(WAVES * NODES, -1)


@lru_cache(maxsize=256)
def _distance_series(alpha: float, n: int) -> Array:
    """Series over the distance in cell n at α: (NODES, 429)."""
    x, transform = chebyshev_transform(NODES)
    places = WIDTH * (n + 0.5 * (1 + x))
    return transform @ np.array([_numbers(alpha, place) for place in places.tolist()])


class Waves(NamedTuple):
    """Spectra of states, and integrals over all distances.

    Attributes
    ----------
    q, weight : array (N, W)
        Of `Spectrum`.
    particles, others : array (N, n), (N, T, n)
        ∫ρⁿ, and ∫ρ_zsⁿ for each of the τ of `_filters`.
    """

    q: Array
    weight: Array
    particles: Array
    others: Array


@lru_cache(maxsize=2048)
def _waves(alpha: float) -> Waves:
    """Of one bandwidth."""
    spectrum = rolled_off(alpha)
    particles, others = spectrum.integrals_from(0.0, _filters(), MOMENTS)
    return Waves(spectrum.q[None], spectrum.weight[None], particles[None], others[None])


@lru_cache(maxsize=len(ROUGH_BANDWIDTHS))
def _wave_series(cell: int) -> Waves:
    """Of bandwidths in a cell, as series in ln(α − 2)."""
    x, transform = chebyshev_transform(ROUGH_WAVES)
    low, high = np.log(np.array(ROUGH_BANDWIDTHS[cell : cell + 2]) - 2)
    alphas = 2 + np.exp(low + 0.5 * (high - low) * (1 + x))
    every = zip(*map(_waves, alphas.tolist()), strict=True)
    return Waves(*(np.tensordot(transform, np.concatenate(values), 1) for values in every))


def _nearby_waves(alpha: Array) -> Waves:
    """Of bandwidths (N,), to 1e-6: integrals to the end of their panels have jumps of 1e-8."""
    ends = np.log(np.array(ROUGH_BANDWIDTHS) - 2)
    cell = np.clip(np.searchsorted(ROUGH_BANDWIDTHS, alpha, side="right") - 1, 0, len(ends) - 2)
    x = 2 * (np.log(alpha - 2) - ends[cell]) / (ends[cell + 1] - ends[cell]) - 1
    terms, parts = _terms(x, ROUGH_WAVES), []
    for n in np.unique(cell).tolist():
        states = np.flatnonzero(cell == n)
        parts.append((states, [np.tensordot(terms[states], v, 1) for v in _wave_series(n)]))
    order = np.argsort(np.concatenate([states for states, _ in parts]))
    return Waves(*(np.concatenate(v)[order] for v in zip(*(v for _, v in parts), strict=True)))


@lru_cache(maxsize=2048)
def _numbers(alpha: float, apart: float) -> Array:
    """k_n of particles, and series in τ of the others, in a row."""
    return _rows_of(_waves(alpha), np.array([apart]))[0]


def _rows_of(waves: Waves, apart: Array) -> Array:
    """k_n of particles, and series in τ of the others, of states: (N, 429).

    Each with as many nodes as its distance asks.
    """
    out = np.empty((len(apart), OF_STATE))
    nodes = near_nodes(np.minimum(apart, FARTHEST) * waves.q[:, -1])
    nodes[apart >= NOTHING_FELT] = 0
    for count in np.unique(nodes).tolist():
        some = np.flatnonzero(nodes == count)
        for few in np.array_split(some, 1 + len(some) * count // (ROUGH_AT_ONCE * NEAR_NODES)):
            out[few] = _rows_by_nodes(Waves(*(v[few] for v in waves)), apart[few], count)
    return out


def _rows_by_nodes(waves: Waves, apart: Array, nodes: int) -> Array:
    """The same, with so many nodes; without any, where nothing is left of what others press."""
    _, transform = chebyshev_transform(TERMS)
    tau = _filters()[:, None]
    rest = 1 - tau
    first, second = (np.sum(waves.weight * waves.q**j, axis=1)[:, None, None] for j in (1, 2))
    norm = np.sqrt(rest * rest + 2 * rest * tau * first + tau * tau * second)
    near, other = waves.particles.copy(), waves.others.copy()
    if nodes:
        plain, _, weight = _near_correlations(waves, apart, nodes)
        near = integrals_of_powers(plain, weight, MOMENTS)
        plain, once, weight = _near_correlations(waves, 0.5 * apart, nodes)
        mixed = (rest * plain[:, None] + tau * once[:, None]) / norm
        other = integrals_of_powers(mixed, weight[:, None], MOMENTS)
    near[:, 0], other[:, :, 0] = apart, 0.5 * apart[:, None]
    rows = transform @ (waves.others - other), transform @ waves.others
    count = len(apart)
    parts = waves.particles - near, *(row.reshape(count, -1) for row in rows)
    return np.concatenate(parts, axis=1)


def _filters() -> Array:
    """τ at which series in τ are known."""
    x, _ = chebyshev_transform(TERMS)
    return 0.5 * (1 + x)


def _near_correlations(waves: Waves, r: Array, nodes: int) -> tuple[Array, Array, Array]:
    """∫C J_0 and ∫C q J_0 at the nodes of an integral up to r (N,), and their weights: (N, R)."""
    at, weight = gauss_legendre(nodes)
    r = 0.5 * np.minimum(r, FARTHEST)[:, None]
    bessel = j0((r * (1 + at))[:, :, None] * waves.q[:, None])
    plain = np.einsum("nrq,nq->nr", bessel, waves.weight)
    once = np.einsum("nrq,nq->nr", bessel, waves.weight * waves.q)
    return plain, once, r * weight


# ------------------------------------------------------------------------------ of a state
class Grounds:
    """What states have beside the numbers of asperities, populations and sides.

    Parameters
    ----------
    skins, parts : array (N, 1, ...), (N, S, ...)
        Of asperities and of sections of sizes, filled.
    found : list of Section
        What these are.
    rough : Roughness
        With arrays in it.
    """

    def __init__(self, skins: Array, parts: Array, found: Sequence[Section], rough: Roughness):
        from . import ground_seats as g

        skin, count, alpha = skins[:, 0], len(skins), np.clip(rough.alpha, *ALPHAS)
        chi, sigma = skin[:, f.CHI], np.broadcast_to(rough.sigma, count)[:, None]
        fixed = np.where(parts[:, :, f.SHADOW] == f.COVERED, parts[:, :, f.COVERAGE], 0.0)
        self.parts = parts.copy()
        self.parts[:, :, f.DENSITY] = [each.part for each in found]
        for column, value in {f.SEAT: f.PLANE, f.OFFSET: 0, f.WIDTH: 0, f.COVERAGE: 0}.items():
            self.parts[:, :, column] = value
        self.seats = np.zeros((count, found[-1].component + 1, g.OF_SEAT))
        # none are seated where there are none
        top = np.where(parts[:, :, f.DENSITY] > 0, parts[:, :, f.HIGH], 0.0) / sigma
        tops = np.zeros(self.seats.shape[:2])
        for s, each in enumerate(found):
            seat = self.seats[:, each.component]
            if seat[0, g.LAST_SECTION] == 0:
                seat[:, g.MEAN], seat[:, g.SPREAD] = each.varied.zeta_mean, each.varied.zeta_std
                seat[:, g.SECTION] = s
            seat[:, g.LAST_SECTION] = s + 1
            tops[:, each.component] = np.maximum(tops[:, each.component], top[:, s])
            seat[:, g.DENSE] += parts[:, s, f.DENSITY]
        mean, width = self.seats[:, :, g.MEAN], self.seats[:, :, g.SPREAD]
        if np.any(tops > WIDEST * width):
            raise NotCompiled(SHORT)
        soft = skin[:, f.IS_SOFT] == 1
        lowest = np.where(soft, separations(True)[0], separations(False)[0])
        reach = (tops + NORMAL_REACH * width + mean - found[0].law.centre).max(axis=1)
        last = np.maximum(reach, lowest + 1.0)
        steps = rows_between(lowest, reach, np.minimum(1.0, width.min(axis=1)))
        self.numbers = np.zeros((count, g.OF_GROUND))
        for column, value in {
            **{g.LOWEST: lowest, g.STEP: (last - lowest) / steps, g.ROWS: steps + 1},
            **{g.SIGMA: rough.sigma, g.UNIT: skin[:, f.FORCE], g.FIXED: fixed.sum(axis=1)},
        }.items():
            self.numbers[:, column] = value
        every = np.broadcast_to(np.asarray(alpha, float), count)
        self.tables = np.zeros((count, f.HEIGHTS_OF_TABLE, COLUMNS))
        for some in (soft, ~soft):
            if some.any():
                rows = rows_of(chi[some], every[some], soft=bool(soft[some][0]))
                self.tables[some, : rows.shape[1]] = rows
        diameter = mean_diameter(found, parts)
        apart = np.broadcast_to(diameter * rough.slope / (math.sqrt(2) * rough.sigma), count)
        known = displacements_of(alpha, np.array(apart), np.ndim(alpha) > 0)
        self.displacements = known
        self.numbers[:, g.LEFT] = FELT * known.tails
