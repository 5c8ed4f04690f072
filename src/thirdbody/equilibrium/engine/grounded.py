"""States of one field of heights with particles on its ground: the balance of each, by itself."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

from ...contact.field_ground import FLAT, LEAP
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
    TOO_DEEP,
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

__all__ = ["EXACT", "ROUGH", "solve_grounded"]

MOST_ROWS = 16_384
LONG, CLOSE, ABOVE = 128, 0.1, 48
"""Where the rows to be solved are more than so many, part of the load from which on, and rows above
these."""
LOOSE, CLEARLY = 1e-5, 0.999
"""Accuracy of u [σ] coming down, and part of a load below which a row carries less even so."""
OF_ROOT, BALANCE, WORST, SHARES, OF_CELLS, NEGLIGIBLE, OF_TABLES = range(7)
"""Of the care with which a state is solved: accuracy of u [σ] and of the load, the largest error,
whether states of one contact side by side share their rows, what cells over the gap may leave out,
the part of the load from where on rows are solved, and the error of NumPy's tables or of far
integrals that are not exact."""
EXACT = np.array([1e-13, 4e-12, 1e-9, 0, SETTLED, 1e-8, 6e-11])
ROUGH = np.array([1e-10, 1e-9, 1e-6, 1, 1e-7, 1e-4, 3e-7])
"""Care for a state, and for one of many samples."""
AFTERWARDS = 30.0
"""By how much the step after a round makes it better, at least: another round sees whether."""
KEPT, ROUNDS, OLDER = 6, 40, 5
"""Pairs of steps that are remembered, rounds at most, and rows from which others are guessed."""
SAME = 1e-4
"""Of a pair, what must be left beside the others."""
NEARLY, STEPS, OUTSIDE = 1e-9, 12, 0.25
"""Accuracy of u [σ] of the first separation that is tried for a load, so many at most, and how far
it may lie outside the step of the table in which it was expected, over that step."""
SAFE, BENT = 20.0, 1e4
"""Change of a column, at most, by what the ground misses; change of ln F over its accuracy from
which on it says a slope."""


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
def _solve_at(field, h, state, lift, accuracy, whole, work):
    """Solve the ground at h [σ] from a state and a lift that are near; and columns if asked.

    The lift, what the state misses, and rounds, or −1 where there is none.
    """
    keep_apart()
    kernels = field[3]
    small, nodes, places, pairs, memory, turned, other, columns = work
    found, miss, old_state, old_miss = other[0], other[1], other[2], other[3]
    close = False
    for n in range(ROUNDS):
        full = whole and close
        lift, off = round_of(field, h, state, lift, small, nodes, places, found, columns, full)
        size = 0.0
        for m in range(UNKNOWNS):
            miss[m] = found[m] - state[m]
            if m < BETA:
                size = max(size, abs(WAVES * kernels[K_PP + m] * miss[m]))
        size = max(size, abs(miss[BETA]))
        if size != size:
            break
        if n > 0:
            _remember(pairs, memory, state, miss, old_state, old_miss)
        if size <= accuracy and small[U, 1] >= FLAT:
            break
        if full and size <= accuracy:
            return lift, max(size, off), n + 1
        for m in range(UNKNOWNS):
            old_state[m], old_miss[m] = state[m], miss[m]
        _follow(pairs, memory, state, miss, turned)
        if not whole and size <= accuracy:
            return lift, size, n + 1
        close = size <= AFTERWARDS * accuracy
    return lift, math.inf, -1


@scalar
def _share(x, j, count):
    """Part of value j of so many, one step from each other, in the polynomial through all at x."""
    part = 1.0
    for i in range(count):
        if i != j:
            part *= (x - i) / (j - i)
    return part


@scalar
def _guess_at(x, first, rows, state):
    """The lift, and into ``state`` the state, that rows from the first up say of x steps above."""
    keep_apart()
    states, lifts, _, done = rows
    last, count, lift = len(done) - 1, 0, 0.0
    while count < OLDER and first + count <= last:
        if not done[first + count] or not states[first + count, 0] > 0:
            break
        count += 1
    for n in range(UNKNOWNS):
        state[n] = 0.0
    if count == 0 and first <= last and done[first]:
        for n in range(UNKNOWNS):
            state[n] = states[first, n]
        return lifts[first]
    for j in range(count):
        part, m = _share(x, j, count), first + j
        lift += part * lifts[m]
        state[0] += part * math.log(states[m, 0])
        for n in range(1, UNKNOWNS):
            state[n] += part * states[m, n] / states[m, 0]
    if count > 0:
        state[0] = math.exp(min(max(state[0], -600.0), 100.0))
        for n in range(1, UNKNOWNS):
            state[n] *= state[0]
    return lift


@scalar
def _log_load_at(x, first, rows):
    """ln of the load that rows from the first up say of x steps above."""
    _, _, loads, done = rows
    count, value = 0, 0.0
    while count < OLDER and first + count < len(done) and done[first + count]:
        count += 1
    for j in range(count):
        value += _share(x, j, count) * math.log(loads[first + j])
    return value


@scalar
def _load_of(own, skin, held, h, w, load, shadow, out):
    """Total load [Pa] at h with lift w, where particles carry a load and shade so much."""
    keep_apart()
    if not add_field(skin, held, h + w, out):
        return math.nan
    return (1 - min(max(shadow + own[FIXED], 0.0), 1.0)) * out[F_SS] + load


@scalar
def _plain_load(field, held, k, work, out):
    """Load at row k on ground that does not give way: more than is carried there, or nearly."""
    keep_apart()
    own, skin, found = field[0], field[4], work[6][0]
    h, u = own[LOWEST] + k * own[STEP], work[0][U]
    for n in range(BETA):
        u[n] = 0.0
    weigh_ground(field, h, u, work[1], work[2], found, work[7], False)
    if not add_field(skin, held, h, out):
        return math.inf
    return out[F_SS] + found[0] * own[UNIT]


@scalar
def _first_row(field, held, load, high, work, out):
    """The row, up to ``high``, above which less than a load is carried; how many were asked."""
    keep_apart()
    low, count = 0, 0
    while high - low > 1:
        middle = (low + high) // 2
        count += 1
        if _plain_load(field, held, middle, work, out) > load:
            low = middle
        else:
            high = middle
    return high, count


@scalar
def _leaps(lifts, done, k, step):
    """Whether the lift of row k may be that of another ground than those above it."""
    if k + 2 >= len(done) or not done[k + 1] or not done[k + 2]:
        return False
    return not abs(lifts[k] - 2 * lifts[k + 1] + lifts[k + 2]) <= LEAP * step


@scalar
def _come_down(field, held, k, target, h, rows, work, out):
    """Solve rows roughly from row k down to the one that carries the target or lies below h.

    That row, −1 without one; rounds; and the fate, that the load is too much where the lowest row
    carries clearly less.
    """
    keep_apart()
    own, skin, states, lifts, loads, done = field[0], field[4], rows[0], rows[1], rows[2], rows[3]
    rounds, before, left = 0, 0.0, False
    while k >= 0:
        at = own[LOWEST] + k * own[STEP]
        if not done[k]:
            lift = _guess_at(-1.0, k + 1, rows, states[k])
            lifts[k], _, n = _solve_at(field, at, states[k], lift, LOOSE, False, work)
            if n < 0 or _leaps(lifts, done, k, own[STEP]):
                return -1, rounds, UNSOLVED
            done[k], rounds = True, rounds + n
            beta, shade = states[k, 0] * own[UNIT], states[k, BETA]
            loads[k] = _load_of(own, skin, held, at, lifts[k], beta, shade, out)
        left = left or _leaves_table(own, at, lifts[k])
        if target > 0:
            if not loads[k] >= before * (1 - 1e-9):
                return -1, rounds, NOT_MONOTONE if loads[k] == loads[k] else UNSOLVED
            before = loads[k]
            if before >= target:
                return k, rounds, OK
        elif at <= h:
            return k, rounds, OK
        k -= 1
    return -1, rounds, TOO_MUCH if before < CLEARLY * target and not left else UNSOLVED


@scalar
def _leaves_table(own, h, lift):
    """Whether asperities on lifted ground at h [σ] are beyond their table."""
    return lift < 0 and h + lift <= own[LOWEST] + 1e-9


@scalar
def _begin(field, held, care, target, h, work, out):
    """The row from which to come down, evaluations, and whether there is one.

    That at which particles on rigid ground carry little of the target, or of what is carried at h.
    """
    keep_apart()
    own, load, least = field[0], target, 0
    count = int(own[ROWS])
    if not target > 0:
        least = math.floor((h - own[LOWEST]) / own[STEP]) + 1
        if not 1 <= least <= count - 1:
            return least, 0, False
        load = min(_plain_load(field, held, least - 1, work, out), own[UNIT])
    k, asked = _first_row(field, held, care[NEGLIGIBLE] * load, count - 1, work, out)
    if k > LONG:
        near, n = _first_row(field, held, CLOSE * load, k, work, out)
        k, asked = min(k, near + ABOVE), asked + n
    return max(k, least), asked, True


@scalar
def _expect_root(k, target, rows):
    """Steps above row k at which the target is expected, and the slope of ln F over one."""
    keep_apart()
    x, slope, goal = 0.0, 0.0, math.log(target)
    for _ in range(3):
        f = _log_load_at(x, k, rows) - goal
        slope = (_log_load_at(x + 1e-4, k, rows) - goal - f) / 1e-4
        if not slope < 0:
            break
        x = min(max(x - f / slope, 0.0), 1.0)
    return x, slope


@scalar
def _add_columns(own, seats, skin, held, h, columns, row):
    """Columns at h [σ] that asperities see, of them and of all seats; the load."""
    keep_apart()
    for c in range(COLUMNS):
        row[F_SA + c] = 0.0
        for s in range(len(seats)):
            row[F_SA + c] += seats[s, DENSE] * columns[s, c]
    row[SHADE] += own[FIXED]
    if not add_field(skin, held, h, row):
        return math.nan
    return (1 - min(row[SHADE], 1.0)) * row[F_SS] + row[F_SA]


@scalar
def _settle(field, held, care, k, target, h, rows, work, row):
    """Find the separation from row k up at which the target is carried, or solve the one at h.

    Fate, separation [σ], rounds, the slope of ln F over a step of the table, and the error; the
    columns into ``row``.
    """
    keep_apart()
    own, seats, skin, columns = field[0], field[1], field[4], work[7]
    state, guess, again = work[6][4], work[6][5], work[6][6]
    x, slope, rounds, begin = (h - own[LOWEST]) / own[STEP] - k, 0.0, 0, own[LOWEST]
    if target > 0:
        if k + 1 >= len(rows[3]) or not rows[3][k + 1]:
            return UNSOLVED, h, 0, slope, math.inf
        x, slope = _expect_root(k, target, rows)
        if not slope < 0:
            return NOT_MONOTONE, h, 0, slope, math.inf
    expected = _guess_at(x, k, rows, guess)
    lift = expected
    for n in range(UNKNOWNS):
        state[n] = guess[n]
    last_f = last_x = 0.0
    for tried in range(STEPS):
        first, at = target > 0 and tried == 0, begin + (k + x) * own[STEP]
        accuracy = max(NEARLY, care[OF_ROOT]) if first else care[OF_ROOT]
        lift, miss, n = _solve_at(field, at, state, lift, accuracy, not first, work)
        if n < 0 or abs(lift - expected) > LEAP * own[STEP]:
            return UNSOLVED, at, rounds, slope, math.inf
        if _leaves_table(own, at, lift):
            return UNSOLVED if target > 0 else TOO_DEEP, at, rounds, slope, math.inf
        rounds += n
        if first:
            beta, shade = state[0] * own[UNIT], state[BETA]
            load = _load_of(own, skin, held, at, lift, beta, shade, row)
        else:
            load = _add_columns(own, seats, skin, held, at + lift, columns, row)
        if not load > 0:
            return UNSOLVED, at, rounds, slope, math.inf
        if not target > 0:
            return OK, at, rounds, slope, SAFE * miss
        f = math.log(load / target)
        if not first and abs(f) <= care[BALANCE]:
            return OK, at, rounds, slope, SAFE * miss + abs(f)
        if tried > 0 and abs(f - last_f) > BENT * care[BALANCE]:
            slope = (f - last_f) / (x - last_x)
        if not slope < 0:
            return NOT_MONOTONE, at, rounds, slope, math.inf
        last_f, last_x = f, x
        x -= f / slope
        if not -OUTSIDE <= x <= 1 + OUTSIDE:
            break
        # what rows say of the step from one separation to the next
        shifted = _guess_at(x, k, rows, again)
        lift, expected = lift + shifted - expected, shifted
        for n in range(UNKNOWNS):
            state[n] += again[n] - guess[n]
            guess[n] = again[n]
    return UNSOLVED, h, rounds, slope, math.inf


@scalar
def _ground_state(field, held, care, target, h, rows, work, row):
    """Separation [σ], rounds, fate and error of one state; its columns into ``row``."""
    keep_apart()
    own = field[0]
    if own[ROWS] > len(rows[0]):
        return h, 0, TOO_LONG, math.inf
    work[4][0] = 0.0
    k, rounds, good = _begin(field, held, care, target, h, work, row)
    if not good:
        return h, rounds, UNSOLVED, math.inf
    k, n, fate = _come_down(field, held, k, target, h, rows, work, row)
    rounds += n
    if fate != OK:
        return h, rounds, fate, 0.0 if fate == TOO_MUCH else math.inf
    fate, at, n, slope, error = _settle(field, held, care, k, target, h, rows, work, row)
    rounds += n
    if fate != OK:
        return h, rounds, fate, math.inf
    error += own[LEFT] + care[OF_TABLES]
    if slope < 0:
        error = max(error, error * own[STEP] / -slope / max(1.0, FAR * abs(at)))
    return at if target > 0 else h, rounds, OK if error <= care[WORST] else NOT_RESOLVED, error


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
                   basis, rules, care, target, h, count, fate, error, rows):  # fmt: skip
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
    kernels = np.empty(series.shape[2])
    lines = (
        np.zeros((length, UNKNOWNS)), np.zeros(length), np.zeros(length),
        np.zeros(length, np.bool_),
    )  # fmt: skip
    work = (
        np.zeros((6, max(OF_SURFACE, TAUS))), np.zeros((OF_NODES, PLACES)),
        np.zeros((OF_PLACE, MOST_PLACES)), np.zeros((2, KEPT, UNKNOWNS)), np.zeros(1),
        np.zeros((3, KEPT + 1, UNKNOWNS)), np.zeros((7, UNKNOWNS)), np.zeros((most, COLUMNS)),
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
            lines[3][:] = False
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
            field, held, care, target[i], h[i], lines, work, rows[i]
        )
        own[LEFT] = left_before
