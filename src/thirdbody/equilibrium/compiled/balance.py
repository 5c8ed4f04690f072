"""The balance of many states, solved one after another in machine code."""

from __future__ import annotations

import math

from numba import njit

from ..status import Status
from .cached import Cached
from .kernels import (
    NO,
    START,
    YES,
    alone,
    contact,
    has_few,
    highest,
    row_of,
    state_of,
)
from .machine import exact, inlined, record

__all__ = ["OK", "TOO_LITTLE", "TOO_MUCH", "UNSOLVED", "solve_states"]

OK, TOO_MUCH = int(Status.OK), int(Status.TOO_MUCH)
TOO_LITTLE, UNSOLVED = int(Status.TOO_LITTLE), int(Status.UNSOLVED)
"""What became of a state: the other codes are for those to say who give and judge states."""
MOST, STEPS = 120, 30
"""The most evaluations of the load, of which those after STEPS only halve the bracket."""
ROUNDING = 1e-16
"""Error [σ_s] that a third-order step may leave behind."""
RESIDUAL, WORST = 2e-13, 1e-3
"""Imbalance of the load of a solved state, and where an ulp of separation changes it by more."""
ULP, EPSILON = 5e-16, 2.220446049250313e-16
"""Error of a separation in the load at it, and width of the smallest bracket: over the larger of
the separation and 1 [σ_s]."""
FLAT = 1e-100
"""Slope of ln F [1/σ_s] below which no step is taken along it."""
CLOSE = 0.02
"""Step [σ_s] after which few nodes are left for all."""


@exact
def _guess(scan, log_target):
    """h by inverse cubic interpolation in a scan of ln F and its slope, falling with h."""
    count = len(scan) - 1
    if not scan[count, 1] < log_target < scan[0, 1]:
        return START
    low = 0
    while count > 1:
        half = count >> 1
        low += half if scan[low + half, 1] >= log_target else 0
        count -= half
    high = low + 1
    rise = scan[high, 1] - scan[low, 1]
    s = (log_target - scan[low, 1]) / rise
    a, b = scan[low, 0], scan[high, 0]
    # slopes dh/ds at both ends
    p, q = rise / scan[low, 2], rise / scan[high, 2]
    h = a + s * (b - a) + s * (1 - s) * ((1 - s) * (p - (b - a)) - s * (q - (b - a)))
    return h if a <= h <= b else a + s * (b - a)


@exact
def _step(f, slope, bend):
    """Euler's third-order step to the root of f with its first two derivatives."""
    inside = 1 - 2 * f * bend / (slope * slope)
    step = -f / slope
    return step * 2 / (1 + math.sqrt(inside)) if inside > 0 else step


@inlined
def _balances(state, h, target, row, sure):
    """Columns at h, into ``row``, and whether they carry the load; less is asked of a sure h."""
    contact(state, h, YES, NO, row)
    error = abs((1 - row[9]) * row[0] + row[4] - target) / target
    return error < RESIDUAL or (sure and error < WORST)


@inlined
def _root(state, target, h, row):
    """Separation h from a first guess, evaluations by all nodes, fate and columns of one state.

    Steps on ln F_t(h) = ln F, exact where ln F_t is a parabola as it is in a Gaussian tail, inside
    a bracket that is halved where a step leaves it, where there is no slope to step along, and
    where steps do not halve. Where there are few nodes beside all, they come first. The columns
    are evaluated where the root seems to be, and tell whether it is: where the load hardly
    changes, a step says little. A root balances the load, or as well as an ulp of h can.
    """
    top, lowest = highest(state), record(state.interface, 0).lowest
    low, high, held = lowest, top, False  # held: the load at the lower end is known to be enough
    over, under = math.inf, target  # imbalance at both ends
    h = min(max(h, low), high)
    few = has_few(state)
    last, bend, count = high - low, 1.0, 0
    for n in range(1, MOST + 1):
        F, F1, F2 = contact(state, h, NO, few, row)
        if not few:
            count += 1
        if F >= target:
            low, over, held = h, F - target, True
        elif h == lowest and not few:
            return h, count, TOO_MUCH
        else:
            high, under = h, target - F
        unit = max(1.0, abs(h))
        pinched = high - low <= EPSILON * unit
        step = (0.5 * (low + high) if held or n % 4 == 0 else lowest) - h
        bisected, explained = True, False
        if F > 0 and F1 < -FLAT * F and n <= STEPS:
            f, slope = math.log(F / target), F1 / F
            curve = F2 / F - slope * slope
            trial = _step(f, slope, curve)
            explained = abs(f) <= -slope * ULP * unit
            if low < h + trial < high and (n % 4 != 0 or abs(trial) < 0.5 * last):
                step, bisected = trial, False
        size = abs(step)
        # errors follow e' = Ke³
        if last < 1:
            bend = size / (last * last * last)
        if few:
            h += step
            if h == lowest or size < CLOSE or n > 20:
                few = NO
                low, high, held = lowest, top, False
                over, under = math.inf, target
                last = 1.0
                continue
        else:
            if pinched:
                if not held:
                    h = lowest
                    continue
                h = low if over <= under else high
            elif not (explained and bisected):
                h += step
            # so this step leaves K size³
            small = not bisected and size < 1e-3 and bend * size * size * size <= ROUNDING
            if pinched or explained or small or size <= ULP * unit:
                if _balances(state, h, target, row, pinched or explained):
                    fate = TOO_LITTLE if top - h < 1e-12 * (top - lowest) else OK
                    return h, count, fate
                if pinched:
                    fate = TOO_LITTLE if high == top else UNSOLVED
                    return h, count, fate
        last = size
    return h, count, UNSOLVED


@Cached
@njit(nogil=True, cache=True, error_model="numpy", no_cfunc_wrapper=True)
def solve_states(
    interfaces, parts, panels, edges, inverses, rules, work, scan, which, target, h, h_is_fixed,
    count, fate, rows,
):  # fmt: skip
    """Solve states i of interfaces which[i] for the loads target[i] [Pa].

    Fills ``h``, the evaluations ``count``, the ``fate`` and the columns ``rows`` (N, 10). With
    ``h_is_fixed``, h is taken as it is; the states of one interface may share a scan.
    """
    for i in range(len(which)):
        state = state_of(which[i], interfaces, parts, panels, edges, inverses, rules, work)
        row = row_of(rows, i)
        if h_is_fixed:
            count[i], fate[i] = 1, OK
            contact(state, h[i], YES, NO, row)
        else:
            scanned = len(scan) > 0
            guess = _guess(scan, math.log(target[i])) if scanned else alone(state, target[i])
            h[i], count[i], fate[i] = _root(state, target[i], guess, row)
