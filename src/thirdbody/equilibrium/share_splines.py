"""Critical loads of many contacts, read off splines over the separation where those tell them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit

from .modes import EPS_1, EPS_2, WINDOW, CriticalStatus

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Truths = NDArray[np.bool_]
    Rows = NDArray[np.intp]
    States = Callable[[Array, Rows], Array]
    Loads = dict[str, tuple[Array, NDArray[np.str_]]]

__all__ = ["LEVEL_1", "LEVEL_2", "PROBES", "Likeness", "SplineLoads", "expected_ends"]

FOUND = CriticalStatus.FOUND
LEVEL_1, LEVEL_2 = math.log((1 - EPS_1) / EPS_1), math.log(EPS_2 / (1 - EPS_2))
"""ln A_sa/A_ss at F_cr1 and F_cr2."""
AREA, EQUAL, LOAD = range(3)
"""What splines tell: ln A_sa/A_ss, ln F_sa/F_ss, and ln F*."""
PASSAGES = ("F_cr1", AREA, LEVEL_1), ("F_cr2", AREA, LEVEL_2), ("F_tpca.B", EQUAL, 0.0)
"""Critical loads, and which share passes which level there."""
LEAST_PEAK = 1e-6
"""Smallest share of the area that counts as a peak."""
PROBES = 128
"""Contacts whose separations at the ends of the window say what those of the others are like."""
ALIKE = 1e-6
"""What of an input is left, over itself, without those before, where it is one of them."""
BEYOND, LEAST_BEYOND = 1.5, 0.01
"""How far nodes go beyond the ends that are expected: worst misses of the probes, and part of the
range of separations."""
FINE = 97
"""Separations at which a spline is looked at for its levels and its peak."""
CLEAR, WILD = 0.05, 1.0
"""ln of a share that no spline errs by where it may err by nothing else, and error with which a
spline tells nothing."""
MISS, NEAR, SECANT = 5e-7, 5e-3, 1e-9
"""Error of ln F* at a critical load; the longest last step to it over the range of separations, and
the shortest that tells a slope."""
SLOPE_OF_ERROR = 4.0
"""Slope of what a spline errs by, over that error over the distance of its nodes."""
PEAK_STEP, PEAK_MISS = 2e-3, 1e-3
"""The same at a peak: between the states that tell its slope, and the longest step."""
PASSES, HALVINGS = 4, 40


class Likeness:
    """What is known of some contacts, for others with other inputs: polynomials of second degree.

    In the logarithms of the inputs, by least squares; without products where there are too many.

    Parameters
    ----------
    vary : mapping
        Inputs (N,).
    count : int
        N.
    probes : array of int (M,)
        Contacts of which something is known.
    """

    def __init__(self, vary: Mapping[str, Array], count: int, probes: Rows):
        self.probes, self.basis = probes, [np.full(count, 1 / math.sqrt(len(probes)))]
        columns = [np.log(v) if np.all(v > 0) else v for v in vary.values()]
        moving = [centred for v in columns if np.ptp(v) > 0 and self._add(centred := v - v.mean())]
        squares = [v * v for v in moving]
        products = [v * w for i, v in enumerate(moving) for w in moving[:i]]
        if 2 * (1 + len(moving) + len(squares) + len(products)) > len(probes):
            products = []
        for column in (*squares, *products):
            self._add(column)
        self.enough = 2 * len(self.basis) <= len(probes)

    def _add(self, column: Array) -> bool:
        """Whether a column (N,) is none of the others together; what is left then joins them.

        All are orthogonal over the probes. Sums by NumPy itself, as linear algebra may share its
        own among threads.
        """
        size = math.sqrt(np.sum(column[self.probes] ** 2))
        for _ in range(2):  # once more for what rounding leaves
            for other in self.basis:
                column = column - other * np.sum(other[self.probes] * column[self.probes])
        left = math.sqrt(np.sum(column[self.probes] ** 2))
        if left > ALIKE * size:
            self.basis.append(column / left)
        return left > ALIKE * size

    def extend_to_all(self, values: Array) -> Array:
        """Values (N, ...) of all contacts from those of the probes (M, ...)."""
        basis = np.stack(self.basis)
        powers = np.einsum("km,m...->k...", basis[:, self.probes], values)
        return np.asarray(np.einsum("kn,k...->n...", basis, powers))


def expected_ends(like: Likeness, ends: Array) -> Array:
    """Separations (2, N) a little beyond those at which contacts carry the ends of the window.

    From those of the probes ``ends`` (2, M), as far beyond as they are missed: they say where
    nodes are laid, and the loads at these whether they reach far enough.
    """
    out = like.extend_to_all(ends.T).T
    miss = np.max(np.abs(out[:, like.probes] - ends), axis=1)
    beyond = BEYOND * miss + LEAST_BEYOND * np.mean(ends[0] - ends[1])
    return np.asarray(out + beyond[:, None] * [[1.0], [-1.0]])


class SplineLoads:
    """Critical loads of contacts by splines through shares and loads over the separation.

    Parameters
    ----------
    x : array (n,)
        Separations from the highest, 0, to the lowest, 1, evenly spaced.
    values : array (3, M, n)
        ln A_sa/A_ss, ln F_sa* and ln F_ss*, from below the window of loads to above it.
    error : array (3, M)
        What these may err by, and splines through them.
    every : int
        Distance of nodes at which values are exact.
    states : callable
        The same three (3, m) at x (m,) of contacts (m,).

    Attributes
    ----------
    solved : array of bool (M,)
        Whether splines tell all critical loads of a contact: it passes each level once at most,
        far enough from the ends of the window, and states there agree with the splines.
    loads : dict
        As `critical_loads` returns them, where they are known.
    """

    def __init__(self, x: Array, values: Array, error: Array, every: int, states: States):
        from scipy.interpolate import CubicSpline

        self.t, self.step, self.states = x, float(x[1] - x[0]), states
        self.count, self.between = values.shape[1], every * self.step
        self.c = CubicSpline(x, values, axis=2).c  # (4, n - 1, 3, M)
        self.error = error[0], error[1] + error[2]
        rows, ends = np.arange(self.count), np.zeros(self.count)
        low, high = (self.root(LOAD, rows, math.log(F), ends, ends + 1) for F in WINDOW)
        self.x = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, FINE)
        self.solved = np.ones(self.count, bool)
        self.loads: Loads = {}
        self._read_splines()

    # ------------------------------------------------------------------ the splines
    def _terms(self, k: int, rows: Rows, x: Array, slope: int) -> Array:
        """Values, slopes or second slopes at x of the k-th spline of rows."""
        cell = np.clip((x / self.step).astype(int), 0, len(self.t) - 2)
        a, b, c, value = self.c[:, cell, k, rows]
        u = x - self.t[cell]
        if slope == 2:
            return np.asarray(6 * a * u + 2 * b)
        if slope == 1:
            return np.asarray((3 * a * u + 2 * b) * u + c)
        return np.asarray(((a * u + b) * u + c) * u + value)

    def values_at(self, what: int, rows: Rows, x: Array, slope: int = 0) -> Array:
        """Values or slopes of area, equality or load of rows at x; of the area second slopes."""
        if what == AREA:
            return self._terms(0, rows, x, slope)
        one, two = (self._terms(k, rows, x, slope) for k in (1, 2))
        if what == EQUAL:
            return one - two
        if not slope:
            return np.logaddexp(one, two)
        share = expit(self.values_at(EQUAL, rows, x))
        return share * one + (1 - share) * two

    def root(
        self, what: int, rows: Rows, level: float, low: Array, high: Array, slope: int = 0
    ) -> Array:
        """x between two at which rows pass a level."""
        begin = self.values_at(what, rows, low, slope) >= level
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            same = (self.values_at(what, rows, middle, slope) >= level) == begin
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.asarray(0.5 * (low + high))

    # ------------------------------------------------------------------ critical loads
    def _read_splines(self) -> None:
        """Fill in what is known: from splines alone, then from states at what they tell."""
        passages = []
        for name, what, level in PASSAGES:
            miss = self.values_at(what, np.arange(self.count)[:, None], self.x) - level
            above, doubt = miss >= 0, CLEAR + self.error[what]
            changes = above[:, 1:] != above[:, :-1]
            number = np.count_nonzero(changes, axis=1)
            self.solved &= np.min(np.abs(miss[:, [0, -1]]), axis=1) > doubt
            self.solved &= (number == 1) | ((number == 0) & (np.min(np.abs(miss), axis=1) > doubt))
            self.solved &= self.error[what] < WILD
            load, word = np.full(self.count, np.nan), np.full(self.count, FOUND, dtype="<U12")
            for without, status, value in _without(name, above[:, 0], above[:, -1]):
                load[without], word[without] = value, status
            self.loads[name] = load, word
            rows = np.flatnonzero(self.solved & (word == FOUND))
            cell = np.argmax(changes[rows], axis=1)
            x = self.root(what, rows, level, self.x[rows, cell], self.x[rows, cell + 1])
            passages.append((rows, x, load))
        self._correct(passages)
        self._read_peak()

    def _correct(self, passages: Sequence[tuple[Rows, Array, Array]]) -> None:
        """Loads where rows pass their levels, by states there and slopes: of the splines, then of
        two states.
        """
        rows, x = (np.concatenate([passage[k] for passage in passages]) for k in range(2))
        into = np.repeat(np.arange(len(passages)), [len(passage[0]) for passage in passages])
        shares = np.array([what for _, what, _ in PASSAGES])[into]
        level = np.array([level for *_, level in PASSAGES])[into]
        by_area = shares == AREA
        slope = np.where(
            by_area, self.values_at(AREA, rows, x, 1), self.values_at(EQUAL, rows, x, 1)
        )
        steep = self.values_at(LOAD, rows, x, 1)
        wavy = SLOPE_OF_ERROR / self.between * np.max(self.error, axis=0)[rows]
        old = np.full((3, len(x)), np.nan)
        left = np.arange(len(x))
        for _ in range(PASSES):
            if not len(left):
                return
            area, *loads = self.states(x[left], rows[left])
            whole = np.logaddexp(*loads)
            miss = np.where(by_area[left], area, loads[0] - loads[1]) - level[left]
            run = x[left] - old[0, left]
            again = np.abs(run) > SECANT
            slope[left[again]] = ((miss - old[1, left]) / run)[again]
            steep[left[again]] = ((whole - old[2, left]) / run)[again]
            old[:, left] = x[left], miss, whole
            step = -miss / slope[left]
            x[left] += step
            near = np.abs(step) < NEAR
            waves = np.maximum(wavy[left], SLOPE_OF_ERROR / self.between * np.abs(miss))
            off = np.abs(step) * waves * (1 + np.abs(steep / slope)[left])
            done = near & (off < MISS)
            answers = np.exp(whole + steep[left] * step)
            for k, (_, _, out) in enumerate(passages):
                here = done & (into[left] == k)
                out[rows[left[here]]] = answers[here]
            self.solved[rows[left[~near]]] = False
            left = left[near & ~done]
        self.solved[rows[left]] = False

    def _read_peak(self) -> None:
        """The load of the largest area share, where the share falls on both sides."""
        load, word = np.full(self.count, np.nan), np.full(self.count, FOUND, dtype="<U12")
        self.loads["F_tpca.A"] = load, word
        every = np.arange(self.count)
        size = expit(self.values_at(AREA, every[:, None], self.x))
        top = np.argmax(size, axis=1)
        most, ends = size[every, top], np.maximum(size[:, 0], size[:, -1])
        # ends of 0.9 of the peak, which decide, are not told from others by a spline
        self.solved &= (most < 0.5 * LEAST_PEAK) | (np.abs(ends - 0.9 * most) > CLEAR * most)
        peak = (ends < 0.9 * most) & (most >= LEAST_PEAK)
        word[~peak] = CriticalStatus.NONE
        rows = np.flatnonzero(self.solved & peak)
        if not len(rows):
            return
        x = self.root(AREA, rows, 0.0, self.x[rows, top[rows] - 1], self.x[rows, top[rows] + 1], 1)
        sides = np.concatenate([x - PEAK_STEP, x + PEAK_STEP])
        area, *loads = self.states(sides, np.tile(rows, 2))
        (low, high), log_F = np.split(area, 2), np.logaddexp(*loads)
        step = -(high - low) / (2 * PEAK_STEP) / self.values_at(AREA, rows, x, 2)
        load[rows] = np.exp(
            np.mean(np.split(log_F, 2), axis=0) + self.values_at(LOAD, rows, x, 1) * step
        )
        self.solved[rows[~(np.abs(step) < PEAK_MISS)]] = False


def _without(name: str, begin: Truths, end: Truths) -> list[tuple[Truths, CriticalStatus, float]]:
    """Contacts without a load, by whether the share is above its level at both ends: why, and F*.

    The last that holds counts.
    """
    if name == "F_cr1":
        always = end, CriticalStatus.ALWAYS_P_S, np.inf
        return [always, (~begin, CriticalStatus.NEVER_P_S, 0.0)]
    if name == "F_cr2":
        always = ~begin, CriticalStatus.ALWAYS_S_S, 0.0
        return [always, (end, CriticalStatus.NEVER_S_S, np.inf)]
    return [(begin == end, CriticalStatus.NONE, np.nan)]
