"""States of one field of heights with particles on its ground: the balance of each, by itself."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from scipy.interpolate import make_interp_spline

from ...contact.field_ground import FLAT, LEAP
from ...contact.field_ground import TINY as TINIEST
from ...laws.field.table import COLUMNS as OF_SURFACE
from ..compiled.cached import Cached
from ..compiled.machine import keep_apart
from .curves import MOST_PANELS, PANEL, ROOM
from .field import TERMS, add_field, lay_field
from .fields import (
    F_SA,
    F_SS,
    FAR,
    HEIGHTS_OF_TABLE,
    NOT_MONOTONE,
    NOT_RESOLVED,
    OK,
    POLYNOMIAL,
    PROJECTED,
    SHADE,
    SHADOW,
    SIDE,
    SQUEEZED,
    TOO_LONG,
    TOO_MUCH,
    UNSOLVED,
)
from .gaps import SUMS
from .gaps import TERMS as OF_ONSET
from .ground import K_PP, TAUS, WAVES, U, lay_surface, round_of
from .ground_cells import (
    A_CELL,
    COLUMNS,
    MOST_CELLS,
    OF_CELL,
    SETTLED,
    STEEP,
    THIN,
    UNTIL,
    lay_gaps,
)
from .ground_seats import (
    BETA,
    DENSE,
    FIXED,
    LAST_SECTION,
    LEFT,
    LOWEST,
    MOST_PLACES,
    OF_NODES,
    OF_PLACE,
    PLACES,
    ROWS,
    SECTION,
    SIGMA,
    SPREAD,
    STEP,
    UNIT,
    UNKNOWNS,
    weigh_ground,
)
from .sides import is_alike, scalar
from .squeeze import lay_panels, spread_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["EXACT", "ROUGH", "SPLINES", "solve_grounded"]

BESIDE, NEAREST = 30, 22
"""Rows beside a cell that decide what the spline is there: others change it by 1e-11 of what they
are themselves. And so many at least, 1e-8, where asperities leave their table below."""
MOST_ROWS = 16_384
LONG, CLOSE, ABOVE = 128, 0.1, 48
"""Where the rows to be solved are more than so many, part of the load from which on, and rows above
these."""
LOOSE, CLEARLY = 1e-5, 0.999
"""Accuracy of u [σ] coming down, and part of a load below which a row carries less even so."""
OF_ROOT, OF_ROWS, WORST, MANY, LEAST, SHARES, OF_CELLS, NEGLIGIBLE, OF_TABLES = range(9)
"""Of the care with which a state is solved: accuracy of u [σ] of rows beside the root and of any
that the spline needs, the largest error, rows beside a cell and the least of them, whether states
of one contact side by side share their rows, what cells over the gap may leave out, the part of the
load from where on rows are solved, and the error of NumPy's tables, iterated to 1e-12 of σ (some
ten times that where particles press down each other's), or of far integrals that are not exact."""
EXACT = np.array([1e-13, 1e-9, 1e-9, BESIDE, NEAREST, 0, SETTLED, 1e-8, 4e-11])
ROUGH = np.array([1e-10, 1e-10, 1e-6, 18, 14, 1, 1e-7, 1e-4, 3e-7])
"""Care for a state, and for one of many samples."""
AFTERWARDS = 30.0
"""By how much the step after a round makes it better, at least: another round sees whether."""
KEPT, ROUNDS, OLDER = 6, 40, 5
"""Pairs of steps that are remembered, rounds at most, and rows from which others are guessed."""
SAME = 1e-4
"""Of a pair, what must be left beside the others."""
BALANCED, STEPS = 4e-13, 60
SAFE, FADES = 20.0, 0.43
"""Change of a column, at most, by what the ground of a row misses; what is left of it a row on."""
FEWER, UNKNOWN = 3, 0.1
"""So many rows less on either side say how much the others leave out: no more than the difference,
where each row fades to 0.43 (0.43³ is 0.08). What a row that is not found may hold besides."""
DONE, GUESSED, NONE = 2, 1, 0
"""Of a row: solved, guessed roughly, or neither."""


def _fill_splines() -> Array:
    """Of quintic splines through rows below and above a cell: coefficients in the cell."""
    out = np.zeros((BESIDE + 1, BESIDE + 1, TERMS, 2 * BESIDE + 2))
    for below in range(BESIDE + 1):
        for above in range(BESIDE + 1):
            count = below + above + 2
            if count < TERMS:
                continue
            whole = make_interp_spline(np.arange(float(count)), np.eye(count), k=TERMS - 1)
            for k in range(TERMS):
                power = TERMS - 1 - k
                out[below, above, k, :count] = whole(float(below), power) / math.factorial(power)
    return out


SPLINES = _fill_splines()


@scalar
def _remember(pairs, memory, state, miss, old_state, old_miss):
    """Note a pair of steps of the state and of what it misses."""
    keep_apart()
    k, size = int(memory[0]) % KEPT, 0.0
    for n in range(UNKNOWNS):
        pairs[0, k, n], pairs[1, k, n] = state[n] - old_state[n], miss[n] - old_miss[n]
        size += pairs[1, k, n] ** 2
    if size > 0:
        memory[0] += 1


@scalar
def _follow(pairs, memory, state, miss, turned):
    """Take the step of a round, and what the steps before say of the rest (after Anderson)."""
    keep_apart()
    count, used = int(memory[0]), 0
    for back in range(min(count, KEPT)):
        k = (count - 1 - back) % KEPT
        size = 0.0
        for n in range(UNKNOWNS):
            turned[0, used, n], turned[1, used, n] = pairs[0, k, n], pairs[1, k, n]
            size += pairs[1, k, n] ** 2
        for _ in range(2):
            for m in range(used):
                part = 0.0
                for n in range(UNKNOWNS):
                    part += turned[1, m, n] * turned[1, used, n]
                for n in range(UNKNOWNS):
                    turned[0, used, n] -= part * turned[0, m, n]
                    turned[1, used, n] -= part * turned[1, m, n]
        left = 0.0
        for n in range(UNKNOWNS):
            left += turned[1, used, n] ** 2
        if left <= SAME * SAME * size:
            continue
        over = 1 / math.sqrt(left)
        for n in range(UNKNOWNS):
            turned[0, used, n] *= over
            turned[1, used, n] *= over
        used += 1
    for m in range(used):
        turned[2, m, 0] = 0.0
        for n in range(UNKNOWNS):
            turned[2, m, 0] += turned[1, m, n] * miss[n]
    for n in range(UNKNOWNS):
        step = miss[n]
        for m in range(used):
            step -= turned[2, m, 0] * (turned[0, m, n] + turned[1, m, n])
        state[n] += step


@scalar
def _solve_row(field, k, accuracy, whole, rows, work):
    """Solve the ground of row k from what stands there; rounds, or −1 where there is none.

    Its state and lift go into the rows and, if the whole is asked, its columns and what it misses.
    """
    keep_apart()
    own, kernels = field[0], field[3]
    states, lifts, columns, misses, done = rows
    small, nodes, places, pairs, memory, turned, other = work
    found, miss, old_state, old_miss = other[0], other[1], other[2], other[3]
    h, state, close = own[LOWEST] + k * own[STEP], states[k], False
    for n in range(ROUNDS):
        full = whole and close
        lifts[k], off = round_of(
            field, h, state, lifts[k], small, nodes, places, found, columns[k], full
        )
        size = 0.0
        for m in range(UNKNOWNS):
            miss[m] = found[m] - state[m]
            if m < BETA:
                size = max(size, abs(WAVES * kernels[K_PP + m] * miss[m]))
        size = max(size, abs(miss[BETA]))
        if size != size:
            return -1
        if n > 0:
            _remember(pairs, memory, state, miss, old_state, old_miss)
        if size <= accuracy and small[U, 1] >= FLAT:
            return -1
        if full and size <= accuracy:
            misses[k], done[k] = max(size, off), DONE
            return n + 1
        for m in range(UNKNOWNS):
            old_state[m], old_miss[m] = state[m], miss[m]
        _follow(pairs, memory, state, miss, turned)
        if not whole and size <= accuracy:
            misses[k], done[k] = size, GUESSED
            return n + 1
        close = size <= AFTERWARDS * accuracy
    return -1


@scalar
def _guess_row(k, way, rows, last):
    """Put what the rows before, on one side, say of row k into it."""
    keep_apart()
    states, lifts, _, _, done = rows
    known, near = 0, k + way
    while known < OLDER:
        m = k + way * (known + 1)
        if not 0 <= m <= last or done[m] == NONE or not states[m, 0] > 0:
            break
        known += 1
    if known == 0:
        lifts[k] = 0.0
        for n in range(UNKNOWNS):
            states[k, n] = 0.0
        if 0 <= near <= last and done[near] != NONE:
            lifts[k] = lifts[near]
            for n in range(UNKNOWNS):
                states[k, n] = states[near, n]
        return
    lifts[k] = 0.0
    for n in range(UNKNOWNS):
        states[k, n] = 0.0
    part = 1.0
    for j in range(1, known + 1):
        part *= -(known - j + 1) / j
        m = k + way * j
        lifts[k] -= part * lifts[m]
        states[k, 0] -= part * math.log(states[m, 0])
        for n in range(1, UNKNOWNS):
            states[k, n] -= part * states[m, n] / states[m, 0]
    states[k, 0] = math.exp(min(max(states[k, 0], -600.0), 100.0))
    for n in range(1, UNKNOWNS):
        states[k, n] *= states[k, 0]


@scalar
def _load_of(own, skin, held, h, w, load, shadow, out):
    """Total load [Pa] at h with lift w, where particles carry a load and shade so much."""
    keep_apart()
    if not add_field(skin, held, h + w, out):
        return math.nan
    return (1 - min(max(shadow + own[FIXED], 0.0), 1.0)) * out[F_SS] + load


@scalar
def _plain_load(field, held, k, rows, work, out):
    """Load at row k on ground that does not give way: more than is carried there, or nearly."""
    keep_apart()
    own, skin = field[0], field[4]
    columns, found, spare = rows[2], work[6][0], len(rows[0])
    h, u = own[LOWEST] + k * own[STEP], work[0][U]
    for n in range(BETA):
        u[n] = 0.0
    weigh_ground(field, h, u, work[1], work[2], found, columns[spare], False)
    if not add_field(skin, held, h, out):
        return math.inf
    return out[F_SS] + found[0] * own[UNIT]


@scalar
def _first_row(field, held, load, high, rows, work, out):
    """The row, up to ``high``, above which less than a load is carried; how many were asked."""
    keep_apart()
    low, count = 0, 0
    while high - low > 1:
        middle = (low + high) // 2
        count += 1
        if _plain_load(field, held, middle, rows, work, out) > load:
            low = middle
        else:
            high = middle
    return high, count


@scalar
def _leaps(lifts, done, k, way, step):
    """Whether the lift of row k may be that of another ground than those before it, on one side."""
    far = k + 2 * way
    if not 0 <= far < len(done) or done[k + way] == NONE or done[far] == NONE:
        return False
    return not abs(lifts[k] - 2 * lifts[k + way] + lifts[far]) <= LEAP * step


@scalar
def _come_down(field, held, k, target, h, rows, work, out):
    """Solve rows roughly from row k down to the one that carries the target or lies below h.

    That row, −1 without one; rounds; and the fate, that the load is too much where the lowest row
    carries clearly less.
    """
    keep_apart()
    own, skin, states, lifts = field[0], field[4], rows[0], rows[1]
    last, rounds, before, left = int(own[ROWS]) - 1, 0, 0.0, False
    while k >= 0:
        if rows[4][k] == NONE:
            _guess_row(k, 1, rows, last)
            n = _solve_row(field, k, LOOSE, False, rows, work)
            if n < 0 or _leaps(lifts, rows[4], k, 1, own[STEP]):
                rows[4][k] = NONE
                return -1, rounds, UNSOLVED
            rounds += n
        at = own[LOWEST] + k * own[STEP]
        left = left or _leaves_table(own, lifts, k)
        if target > 0:
            load = _load_of(
                own, skin, held, at, lifts[k], states[k, 0] * own[UNIT], states[k, BETA], out
            )
            if not load >= before * (1 - 1e-9):
                return -1, rounds, NOT_MONOTONE if load == load else UNSOLVED
            before = load
            if load >= target:
                return k, rounds, OK
        elif at <= h:
            return k, rounds, OK
        k -= 1
    return -1, rounds, TOO_MUCH if before < CLEARLY * target and not left else UNSOLVED


@scalar
def _finish_rows(field, care, k, low, high, rows, work):
    """Solve every row of a window as well as it counts in cell k.

    Rounds, or −1, and where the window begins: above a row whose ground is not found.
    """
    keep_apart()
    done, rounds, last = rows[4], 0, int(field[0][ROWS]) - 1
    step, first = field[0][STEP], high
    while first > low and done[first] == NONE:
        first -= 1
    for way in range(2):  # up from the rows that are known, then down
        i = first + 1 if way == 0 else first
        while low <= i <= high:
            if done[i] == NONE:
                _guess_row(i, -1 if way == 0 else 1, rows, last)
            if done[i] != DONE:
                accuracy = min(care[OF_ROOT] * 2.0 ** max(k - i, i - k - 1), care[OF_ROWS])
                n = _solve_row(field, i, accuracy, True, rows, work)
                if n < 0 or _leaps(rows[1], done, i, -1 if way == 0 else 1, step):
                    done[i] = NONE
                    return (rounds, i + 1) if i < k else (-1, low)
                rounds += n
            i += 1 if way == 0 else -1
    return rounds, low


@scalar
def _lay_cell(splines, k, low, high, lasts, rows, poly):
    """Polynomials of the splines in cell k through rows from low to high: of seats, and the lift.

    Of each seat up to the row in ``lasts``. False where too few rows carry anything.
    """
    keep_apart()
    lifts, columns, count = rows[1], rows[2], len(lasts)
    if high - low + 1 < TERMS:
        return False
    for j in range(TERMS):
        for s in range(count + 1):
            for c in range(COLUMNS):
                poly[s, j, c] = 0.0
    for i in range(low, high + 1):
        for j in range(TERMS):
            poly[count, j, 0] += splines[k - low, high - k - 1, j, i - low] * lifts[i]
    carried = False
    for s in range(count):
        last = min(lasts[s], high)
        if last < k + 1:
            poly[s, TERMS - 1, 0] = -math.inf
            continue
        if last - low + 1 < TERMS:
            return False
        carried = True
        for i in range(low, last + 1):
            load = columns[i, s, 0]
            for j in range(TERMS):
                part = splines[k - low, last - k - 1, j, i - low]
                poly[s, j, 0] += part * math.log(load)
                for c in range(1, COLUMNS):
                    poly[s, j, c] += part * columns[i, s, c] / load
    return carried


@scalar
def _read_cell(own, seats, skin, held, poly, k, t, row):
    """Columns at part t of cell k; the load."""
    keep_apart()
    for c in range(COLUMNS):
        row[F_SA + c] = 0.0
    lift = 0.0
    for s in range(len(seats) + 1):
        load = 0.0
        for c in range(COLUMNS if s < len(seats) else 1):
            value = 0.0
            for j in range(TERMS):
                value = value * t + poly[s, j, c]
            if s == len(seats):
                lift = value
            elif c == 0:
                load = seats[s, DENSE] * math.exp(value)
                row[F_SA] += load
            else:
                row[F_SA + c] += max(load * value, 0.0)
    row[SHADE] += own[FIXED]
    if not add_field(skin, held, own[LOWEST] + (k + t) * own[STEP] + lift, row):
        return math.nan
    return (1 - min(row[SHADE], 1.0)) * row[F_SS] + row[F_SA]


@scalar
def _root_in(own, seats, skin, held, poly, k, target, row):
    """Part of cell k at which the target is carried, and the slope of ln F; −1 or 2 beside it."""
    keep_apart()
    low, high = 0.0, 1.0
    f_low = math.log(_read_cell(own, seats, skin, held, poly, k, low, row) / target)
    f_high = math.log(_read_cell(own, seats, skin, held, poly, k, high, row) / target)
    if not f_low >= 0:
        return -1.0, 0.0
    if not f_high <= 0:
        return 2.0, 0.0
    t = f = side = 0.0
    for _ in range(STEPS):
        t = (low * f_high - high * f_low) / (f_high - f_low) if f_high != f_low else low
        f = math.log(_read_cell(own, seats, skin, held, poly, k, t, row) / target)
        if abs(f) <= BALANCED or high - low < 1e-15:
            break
        if f > 0:
            low, f_low = t, f
            f_high *= 0.5 if side == 1 else 1.0
            side = 1.0
        else:
            high, f_high = t, f
            f_low *= 0.5 if side == -1 else 1.0
            side = -1.0
    near = t - 1e-4 if t > 0.5 else t + 1e-4
    beside = math.log(_read_cell(own, seats, skin, held, poly, k, near, row) / target)
    _read_cell(own, seats, skin, held, poly, k, t, row)
    return t, (beside - f) / (near - t)


@scalar
def _left_out(field, held, splines, k, t, low, high, lasts, rows, poly, row, out):
    """What rows beyond the window change at most, from what fewer rows do."""
    keep_apart()
    count = int(field[0][ROWS])
    fewer = low + FEWER if low > 0 else low
    most = high - FEWER if high < count - 1 else high
    if fewer == low and most == high:
        return 0.0
    if not _lay_cell(splines, k, fewer, most, lasts, rows, poly):
        return math.inf
    _read_cell(field[0], field[1], field[4], held, poly, k, t, out)
    load, area, worst = (1 - min(row[SHADE], 1.0)) * row[F_SS] + row[F_SA], 0.0, 0.0
    for c in range(1, F_SA):
        area += row[c] + row[F_SA + c]
    for c in range(10):
        unit = 1.0 if c == SHADE else area
        if c in (F_SS, F_SA):
            unit = load
        worst = max(worst, abs(out[c] - row[c]) / unit)
    return worst


@scalar
def _leaves_table(own, lifts, i):
    """Whether asperities on the lifted ground of row i are beyond their table."""
    return lifts[i] < 0 and i * own[STEP] + lifts[i] <= 1e-9


@scalar
def _error_of(field, k, low, high, rows):
    """What the rows of a window miss in cell k; infinite where asperities leave their table."""
    keep_apart()
    own, lifts, misses, error = field[0], rows[1], rows[3], 0.0
    for i in range(low, high + 1):
        if _leaves_table(own, lifts, i):
            return math.inf
        error += SAFE * misses[i] * FADES ** max(k - i, i - k - 1)
    return error


@scalar
def _begin(field, held, care, target, h, rows, work, out):
    """The row from which to come down, evaluations, and whether there is one.

    All the way down from particles that carry little of the target or, of samples, of what is
    carried at h; at h itself else from the highest row that decides what a spline is there.
    """
    keep_apart()
    own, load, least = field[0], target, 0
    count = int(own[ROWS])
    work[4][0] = 0.0
    if not target > 0:
        k = math.floor((h - own[LOWEST]) / own[STEP])
        least = min(k + 1 + int(care[MANY]), count - 1)
        if not 0 <= k < count - 1 or care[SHARES] != 1:
            return least, 0, 0 <= k < count - 1
        load = _plain_load(field, held, k, rows, work, out)
        if not load < math.inf:
            return least, 1, True
    k, rounds = _first_row(field, held, care[NEGLIGIBLE] * load, count - 1, rows, work, out)
    if k > LONG:
        near, n = _first_row(field, held, CLOSE * load, k, rows, work, out)
        k, rounds = min(k, near + ABOVE), rounds + n
    return max(k, least), rounds, True


@scalar
def _settle_cell(field, held, splines, care, k, target, h, rows, work, poly, row, lasts):
    """Find the part of a cell, from cell k on, at which the target is carried, or h is.

    Fate, rounds, the cell, the part, the slope of ln F over the cell, and the window of rows; the
    last rows in which particles of each seat carry anything into ``lasts``.
    """
    keep_apart()
    own, seats, skin, columns = field[0], field[1], field[4], rows[2]
    count, rounds, t, slope, low, high = int(own[ROWS]), 0, -1.0, 0.0, 0, 0
    many, least = int(care[MANY]), int(care[LEAST])
    for _ in range(3):
        if not 0 <= k < count - 1:
            break
        low, high = max(k - many, 0), min(k + 1 + many, count - 1)
        n, low = _finish_rows(field, care, k, low, high, rows, work)
        if n < 0:
            break
        rounds += n
        for i in range(low, k - least):
            if _leaves_table(own, rows[1], i):
                low = i + 1
        for s in range(len(seats)):
            lasts[s] = low - 1
            while lasts[s] < high and columns[lasts[s] + 1, s, 0] > TINIEST * own[SIGMA] ** 2:
                lasts[s] += 1
        if not _lay_cell(splines, k, low, high, lasts, rows, poly):
            break
        if target > 0:
            t, slope = _root_in(own, seats, skin, held, poly, k, target, row)
        else:
            t = (h - own[LOWEST]) / own[STEP] - k
            if not _read_cell(own, seats, skin, held, poly, k, t, row) >= 0:
                break
        if 0 <= t <= 1:
            fate = OK if target <= 0 or slope < 0 else NOT_MONOTONE
            return fate, rounds, k, t, slope, low, high
        k += -1 if t < 0 else 1
    return UNSOLVED, rounds, k, t, slope, low, high


@scalar
def _ground_state(field, held, splines, care, target, h, rows, work, poly, lasts, row, out):
    """Separation [σ], rounds, fate and error of one state; its columns into ``row``."""
    keep_apart()
    own = field[0]
    if own[ROWS] > len(rows[0]):
        return h, 0, TOO_LONG, math.inf
    k, rounds, good = _begin(field, held, care, target, h, rows, work, out)
    if not good:
        return h, rounds, UNSOLVED, math.inf
    k, n, fate = _come_down(field, held, k, target, h, rows, work, out)
    rounds += n
    if fate != OK:
        return h, rounds, fate, 0.0 if fate == TOO_MUCH else math.inf
    fate, n, k, t, slope, low, high = _settle_cell(
        field, held, splines, care, k, target, h, rows, work, poly, row, lasts
    )
    rounds += n
    if fate != OK:
        return h, rounds, fate, math.inf
    if target > 0:
        h = own[LOWEST] + (k + t) * own[STEP]
    error = own[LEFT] + care[OF_TABLES] + _error_of(field, k, low, high, rows)
    error += _left_out(field, held, splines, k, t, low, high, lasts, rows, poly, row, out)
    if low > max(k - int(care[MANY]), 0):
        error += UNKNOWN * FADES ** (k - low + 1)
    if slope < 0:
        error = max(error, error * own[STEP] / -slope / max(1.0, FAR * abs(h)))
    return h, rounds, OK if error <= care[WORST] else NOT_RESOLVED, error


@scalar
def _lay_section(given, sides, rules, care, scratch, cells, floor):
    """Lay the cells of the sections of a seat.

    What they leave out, whether they are laid, or why not, and how many there are.
    """
    keep_apart()
    panels, edges, values, out, some, sums, onsets = scratch
    spread = math.inf
    for s in range(len(given)):
        spread = min(spread, spread_of(given, s))
    count = lay_panels(given, sides, panels, 0, rules[len(rules) - 1, POLYNOMIAL:], spread)
    if count <= 0:
        return 0.0, TOO_LONG, 0
    laid, left = lay_gaps(
        given, sides, panels, count, rules[1], rules[0, POLYNOMIAL:],
        rules[len(rules) - 2, POLYNOMIAL:], care[OF_CELLS], cells, floor, edges,
        values[0], values[1], out, some[: len(given)], sums, onsets,
    )  # fmt: skip
    if laid > 0:
        return left, OK, laid
    return left, TOO_LONG if laid < 0 else SQUEEZED, 0


@scalar
def _is_seat_alike(i, parts, bodies, first, last):
    """Whether particles of sections of state i are those of the state before."""
    for s in range(first, last):
        if not (
            is_alike(parts[i, s], parts[i - 1, s])
            and is_alike(bodies[i, 2 * s], bodies[i - 1, 2 * s])
            and is_alike(bodies[i, 2 * s + 1], bodies[i - 1, 2 * s + 1])
        ):
            return False
    return True


@scalar
def _lay_seats(i, parts, bodies, seats, sigma, rules, care, scratch, cells, counts, darker, floor,
               left, fates, sides):  # fmt: skip
    """Lay the cells of every seat of state i anew that differs from that of the state before.

    What they leave out, at most, what became of them, and whether none differs.
    """
    keep_apart()
    worst, fate, same = 0.0, OK, i > 0
    for m in range(seats.shape[1]):
        first, last = int(seats[i, m, SECTION]), int(seats[i, m, LAST_SECTION])
        if i == 0 or not _is_seat_alike(i, parts, bodies, first, last):
            same = False
            for one in range(2):
                for k in range(bodies.shape[2]):
                    sides[one, k] = bodies[i, 2 * first + one, k]
            left[m], fates[m], counts[m] = 0.0, OK, 0
            darker[m] = parts[i, first, SHADOW] == PROJECTED
            if seats[i, m, DENSE] > 0:
                left[m], fates[m], counts[m] = _lay_section(
                    parts[i, first:last], sides, rules, care, scratch, cells[m], floor[m]
                )
        steep = STEEP * THIN * cells[m, 0, UNTIL] / (seats[i, m, SPREAD] * sigma)
        worst = max(worst, left[m] * max(1.0, steep))
        fate = max(fate, fates[m])
    return worst, fate, same


@scalar
def _is_ground_alike(i, skins, tables, grounds, seats, which, basis):
    """Whether all but the particles of state i is that of the state before."""
    keep_apart()
    if not is_alike(grounds[i], grounds[i - 1]) or not is_alike(skins[i, 0], skins[i - 1, 0]):
        return False
    for m in range(tables.shape[1]):
        if not is_alike(tables[i, m], tables[i - 1, m]):
            return False
    for s in range(seats.shape[1]):
        if not is_alike(seats[i, s], seats[i - 1, s]):
            return False
    return which[i] == which[i - 1] and is_alike(basis[i], basis[i - 1])


@Cached
@njit(nogil=True, cache=True, error_model="numpy", no_cfunc_wrapper=True)
def solve_grounded(skins, parts, bodies, tables, grounds, seats, series, alone, which,
                   basis, splines, rules, care, target, h, count, fate, error, rows):  # fmt: skip
    """Solve states by their own numbers: skins (N, 1, ...), sections of sizes ``parts`` (N, S, ...)
    and their sides (N, 2S, ...), tables of surfaces (N, M, ...), grounds (N, ...) and seats (N, P,
    ...).

    Displacements are ``basis`` (N, K) times ``series`` (C, K, ...), of which each state has the one
    that ``which`` says, or rows of ``alone``. For the loads target [Pa] or, where they are zero, at
    the separations ``h`` of the mean planes [σ]. States whose ``fate`` is not `OK` are left out.
    ``care`` is `EXACT` or `ROUGH`. Fills ``h``, the rounds ``count``, ``fate``, the estimated
    ``error`` and the columns ``rows`` (N, 10).
    """
    most, every, length = seats.shape[1], parts.shape[1], 0
    for i in range(len(target)):
        length = max(length, int(min(grounds[i, ROWS], MOST_ROWS)))
    sides, left, fates = np.zeros((2, SIDE)), np.zeros(most), np.zeros(most, np.int64)
    scratch = (
        np.empty((1, MOST_PANELS + ROOM, PANEL)), np.empty((2, MOST_CELLS)),
        np.empty((2, COLUMNS, OF_CELL)), np.zeros(10), np.zeros(every, np.int64),
        np.empty((every, MOST_PANELS, SUMS)), np.empty((every, 3 * OF_ONSET)),
    )  # fmt: skip
    cells, floor = np.zeros((most, MOST_CELLS, A_CELL)), np.zeros((most, COLUMNS))
    counts, darker = np.zeros(most, np.int64), np.zeros(most, np.bool_)
    surface, held = np.zeros((HEIGHTS_OF_TABLE, TERMS, OF_SURFACE)), np.zeros((2, 2 * OF_SURFACE))
    kernels, out = np.empty(series.shape[2]), np.zeros(10)
    poly, lasts = np.zeros((most + 1, TERMS, COLUMNS)), np.zeros(most, np.int64)
    lines = (
        np.zeros((length, UNKNOWNS)), np.zeros(length), np.zeros((length + 1, most, COLUMNS)),
        np.zeros(length), np.zeros(length, np.int64),
    )  # fmt: skip
    work = (
        np.zeros((6, max(OF_SURFACE, TAUS))), np.zeros((OF_NODES, PLACES)),
        np.zeros((OF_PLACE, MOST_PLACES)), np.zeros((2, KEPT, UNKNOWNS)), np.zeros(1),
        np.zeros((3, KEPT + 1, UNKNOWNS)), np.zeros((4, UNKNOWNS)),
    )  # fmt: skip
    for i in range(len(target)):
        worst, laid, same = _lay_seats(
            i, parts, bodies, seats, grounds[i, SIGMA], rules, care, scratch, cells, counts, darker,
            floor, left, fates, sides,
        )  # fmt: skip
        fate[i] = max(fate[i], laid)
        if fate[i] != OK:
            error[i] = math.inf
            continue
        own = grounds[i]
        left_before = own[LEFT]
        if not (same and care[SHARES] == 1 and fate[i - 1] == OK and _is_ground_alike(
            i, skins, tables, grounds, seats, which, basis
        )):  # fmt: skip
            lines[4][:] = NONE
            lay_surface(skins[i], tables[i], surface)
            for m in range(series.shape[2]):
                kernels[m] = alone[-1 - which[i], m] if which[i] < 0 else 0.0
            for j in range(series.shape[1] if which[i] >= 0 else 0):
                for m in range(series.shape[2]):
                    kernels[m] += basis[i, j] * series[which[i], j, m]
        lay_field(held)
        own[LEFT] += worst
        field = own, seats[i], darker, kernels, skins[i], surface, cells, counts, floor
        h[i], count[i], fate[i], error[i] = _ground_state(
            field, held, splines, care, target[i], h[i], lines, work, poly, lasts, rows[i], out
        )
        own[LEFT] = left_before
