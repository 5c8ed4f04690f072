"""The balance of a state: the separation at which it carries its load, and how well it is known."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ..compiled.cached import Cached
from ..compiled.machine import keep_apart
from .breakage import lay_tension, lay_whole
from .cells import add_cells, empty_slots
from .curves import (
    MOST_PANELS,
    PANEL,
    ROOM,
    SETTLED,
    SHARE,
)  # fmt: skip
from .fields import (
    A_E,
    A_SA,
    ASKED,
    BEYOND,
    BREAKS,
    CODE,
    COVERAGE,
    COVERED,
    DMT,
    ENOUGH,
    EQUAL,
    F_SA,
    F_SS,
    FAR,
    HIGH,
    JKR,
    LEAST,
    NODES,
    NOT_MONOTONE,
    NOT_RESOLVED,
    OFFSET,
    OK,
    PANEL_SPAN,
    PLANE,
    POLYNOMIAL,
    PRINTED,
    ROUGH,
    RULE,
    SEAT,
    SHADE,
    SHADOW,
    SIDE,
    SIGMA,
    SIGMA_S,
    TOO_LONG,
    TOO_MUCH,
    UNSOLVED,
    WIDTH,
)  # fmt: skip
from .fragments import (
    FRAGMENT_ROWS,
    MOST_ENDS,
    add_fragments,
    add_lowest,
    goes_by_fragments,
    lay_fragments,
    most_above,
    pace_of,
)
from .gaps import SUMS, add_below, goes_by_gaps, lay_cells, sum_panels
from .laid import (
    BASE,
    BY_FRAGMENTS,
    BY_GAPS,
    COUNT,
    FREE,
    GAPS,
    GRID,
    GRID_END,
    LAID,
    PIECE_BEGIN,
    PIECE_END,
    PIECES,
    QUICK,
    SIZED,
    SIZED_END,
    SLOT,
    TWIN,
    WAY,
    WHOLE,
    WHOLE_END,
)
from .monotone import only_falls_above
from .printed import add_printed, printed_bound
from .seats import (
    GRID_ROWS,
    MOST_NODES,
    SLOTS,
    add_broken,
    add_rough,
    gather_gaps,
    lay_broken,
    lay_pieces,
    left_at_end,
)
from .sides import is_alike, scalar
from .skins import MOST_HEIGHTS, add_skin, lay_skin
from .squeeze import are_twins, copy_panels, lay_panels, spread_of
from .sums import MOST_SIZES, add_plane

__all__ = ["LEVELS", "solve_own"]

LOWEST, HIGHEST = -3.0, 37.0
"""Separations searched [σ_s]; particles may reach higher."""
COARSE, FINE, LEVELS = 0, 1, 2
"""Few nodes, to search with; all; and how often both are made finer. They are handed on as `few`
and `every`, numbers and no constants, for which numba would compile what takes them twice."""
NOTHING = -1
"""In place of a level: nothing is laid."""
ROUNDED, SAFE = 2e-14, 10.0
"""What rounding leaves of a part; the error of a rule of twice the nodes is so many squares of its
difference to the other."""
MOST_WHOLE = 1_500_000
SEARCHED, POLISHED = 80, 14
"""Densities of what is whole that there is room for; evaluations at most, by few nodes and all."""
BALANCED, CLOSE_BY, ULPS = 9e-13, 4e-13, 4e-16
"""ln of load over target of a solved state, and where no better one is sought; unless so much of
the separation explains it."""
STEPS, RESOLVED = 2000, 1e-3
"""Coming down to a load, and the step [σ_s] from which on it need not be proven."""
BETWEEN, FALLEN = 0.4, 0.03
"""Steps over seats [widths] at which loads of particles that break are looked at, and how far they
must have fallen."""
FAR_GAP = 30.0
"""Widths of the seat from which on a gap by itself says whether a load is carried."""


@scalar
def _add_part(given, work, laid, p, own, d, rule, out):
    """What part p carries at a separation d [m]; False where its formulas do not reach.

    ``own`` is what is laid of it on this level, and ``laid`` of all.
    """
    keep_apart()
    _, sides, panels, grid, sizes, shares, _, _, sums, way = work
    gap = d + given[p, OFFSET]
    if given[p, SHADOW] == COVERED:
        out[SHADE] += given[p, COVERAGE]
    count, free = own[COUNT], laid[len(laid) - 1, 0]
    if own[WAY] == BY_FRAGMENTS:
        alone = free[QUICK] == 1 and gap > FAR_GAP * given[p, WIDTH]
        if given[p, SEAT] == PLANE or alone:
            return add_fragments(given, sides, panels, p, count, 1.0, gap, rule, way, out)
        good = add_lowest(given, sides, panels, p, count, gap, rule, way, out)
        return good and add_cells(
            given, sides, panels, p, own, free, grid, gap, rule, sums, way, out
        )
    if given[p, SEAT] == PLANE:
        return add_plane(given, sides, panels, p, count, gap, rule, out)
    if own[WAY] == BY_GAPS:
        add_cells(given, sides, panels, p, own, free, grid, gap, rule, sums, way, out)
        add_below(given, sides, panels, p, own, sizes, gap, out)
    elif given[p, BREAKS] == 1:
        add_broken(given, sides, panels, p, own, grid, sizes, gap, shares, out)
    else:
        add_rough(given, sides, panels, p, own, grid, sizes, gap, out)
    return True


@scalar
def total(given, skin, work, laid, rules, level, h, out):
    """Columns at h [σ_s] by the nodes of a level; the load, or NaN where formulas do not reach."""
    keep_apart()
    heights, coating = work[0], work[7]
    for k in range(10):
        out[k] = 0.0
    last = len(given)
    nodes = int(rules[level, 0, NODES])
    good = add_skin(
        skin, coating, heights, laid[last, level, GRID], laid[last, level, GRID_END],
        rules[level, RULE], rules[level, RULE + 1], nodes, h, out,
    )  # fmt: skip
    d = h * skin[0, SIGMA_S]
    for p in range(last):
        own = laid[p, level]
        if given[p, SEAT] == PRINTED:
            gap = d + given[p, OFFSET]
            add_printed(given, p, gap, rules[level, RULE], rules[level, RULE + 1], nodes, out)
            continue
        good &= _add_part(given, work, laid, p, own, d, rules[level], out)
    if not good:
        return math.nan
    return (1 - min(out[SHADE], 1.0)) * out[F_SS] + out[F_SA]


@scalar
def lay(given, skin, work, laid, rules, level):
    """Lay the nodes of one level behind those of the one before; False if there is no room."""
    keep_apart()
    heights, sides, panels, grid, sizes, shares, _, coating, _, way = work
    last, good = len(given), True
    place = size = begin = kept = piece = 0
    if level == FINE:
        begin = laid[last, COARSE, GRID_END]
        if last > 0:
            before = laid[last - 1, COARSE]
            place, size, kept = before[GRID_END], before[SIZED_END], before[WHOLE_END]
            piece = before[PIECE_END]
    laid[last, level, GRID] = begin
    begin = laid[last, level, GRID_END] = lay_skin(
        skin, coating, heights, begin, heights.shape[1] // 2, rules[level, RULE],
        rules[level, RULE + 1], int(rules[level, 0, NODES]), -math.inf,
    )  # fmt: skip
    good &= begin >= 0
    for p in range(last):
        own = laid[p, level]
        own[COUNT], own[WAY] = laid[p, COARSE, COUNT], laid[p, COARSE, WAY]
        own[GRID], own[SIZED], own[WHOLE], own[PIECE_BEGIN] = place, size, kept, piece
        if own[WAY] != PIECES:
            own[SLOT] = (2 * p + level) * SLOTS
            empty_slots(grid, own[SLOT], own[SLOT] + SLOTS)
        if own[WAY] == BY_GAPS:
            piece, size = lay_cells(
                given, panels, p, own[COUNT], grid, own, sizes, size, rules[level]
            )
            good &= piece >= 0 and size >= 0
        elif own[WAY] == BY_FRAGMENTS:
            if given[p, SEAT] == ROUGH:
                piece = lay_fragments(given, panels, p, own[COUNT], grid, own, rules[level], way[0])
            good &= piece >= 0
        elif given[p, SEAT] == ROUGH and good:
            if given[p, BREAKS] == 1:
                place, size = lay_broken(
                    given, sides, panels, p, own[COUNT], grid, place, sizes, size, rules[level]
                )
                good &= place >= 0 and size >= 0
                if good:
                    kept = lay_whole(
                        given, panels, p, own[COUNT], grid, own[GRID], place, sizes, own[SIZED],
                        size, shares, kept,
                    )  # fmt: skip
                    good &= kept >= 0
                own[GAPS] = place
                if good:
                    place = gather_gaps(
                        given, p, grid, own[GRID], own[GAPS], sizes, own[SIZED], size, shares,
                        own[WHOLE], rules[laid.shape[1] - 2],
                    )  # fmt: skip
                    good &= place >= 0
            else:
                piece, place, size = lay_pieces(
                    given, sides, panels, p, own[COUNT], grid, place, sizes, size, piece,
                    rules[level],
                )  # fmt: skip
                good &= piece >= 0
        own[GRID_END], own[SIZED_END], own[WHOLE_END], own[PIECE_END] = place, size, kept, piece
    laid[last, COARSE, BASE] = laid[last, COARSE, FREE] = place
    return good


@scalar
def top_of(given, skin):
    """Highest separation [σ_s] at which anything is carried."""
    keep_apart()
    top = HIGHEST
    for p in range(len(given)):
        reach = given[p, HIGH] + given[p, BEYOND] - given[p, OFFSET] + 9.5 * given[p, WIDTH]
        top = max(top, reach / skin[0, SIGMA_S])
    return top


@scalar
def _imbalance(skin, load, target):
    """ln of the load over the target; where asperities attract, what is like it at the root.

    Their load may be negative: (sinh⁻¹(load/target) − sinh⁻¹(1))√2.
    """
    if DMT <= skin[0, CODE] <= JKR:
        return math.sqrt(2.0) * (math.asinh(load / target) - math.asinh(1.0))
    return math.log(load / target) if load > 0 else -800.0


@scalar
def search(given, skin, work, laid, rules, target, out):
    """Separation near the root by few nodes, slope of ln F there, evaluations; NaN if none is.

    Where formulas do not reach, particles are squeezed further than they go: the root is above.
    """
    keep_apart()
    few = laid.shape[1] - 2
    high, low = top_of(given, skin), LOWEST
    f_high, f_low = -800.0, math.inf
    h, f, slope, n = 2.0, 0.0, 0.0, 0
    old_h, old_f, old_slope, bent = math.nan, math.nan, math.nan, 0.0
    older_h, ends = math.nan, False  # whether the formulas do, at ``low``
    while n < SEARCHED:
        load = total(given, skin, work, laid, rules, few, h, out)
        n += 1
        if load != load:
            low, ends = h, True
            old_h, old_slope, h = math.nan, math.nan, 0.5 * (low + high)
            if high - low < 1e-13:
                break
            continue
        f = _imbalance(skin, load, target)
        if f > 0:
            low, f_low = h, f
        else:
            if h == LOWEST:
                return -math.inf, 0.0, n
            high, f_high = h, f
        bent = 0.0
        if old_h == old_h and h != old_h:
            chord = (f - old_f) / (h - old_h)
            if old_slope == old_slope:  # what the last three loads say of the slope here
                bent = (chord - old_slope) / (h - older_h) * (h - old_h)
                if not abs(bent) < 0.3 * abs(chord):
                    bent = 0.0
            slope, old_slope, older_h = chord + bent, chord, old_h
        if bent != 0:
            bent /= h - old_h
        old_h, old_f = h, f
        step = -f / slope if slope < -1e-3 else (f / 3 if abs(f) < 9 else math.copysign(3.0, f))
        if abs(bent * step) < 0.3 * abs(slope):
            step -= bent * step * step / slope
        if abs(step) < 1e-4 and slope < -1e-3:
            return h + step, slope + 2 * bent * step, n
        x = h + step
        if f_low < math.inf and f_high > -800.0 and n % 3 == 0:
            x = low + (high - low) * f_low / (f_low - f_high)
        if f_low == math.inf and not ends:
            x = max(x, LOWEST)
        if not low < x < high and x != LOWEST:
            x = 0.5 * (low + high) if f_low < math.inf or ends else LOWEST
        if high - low < 1e-13:
            break
        h = x
    return math.nan, 0.0, n


@scalar
def polish(given, skin, work, laid, rules, target, h, slope, out):
    """Root by all nodes from a close one: separation, slope of ln F, evaluations; NaN if none."""
    keep_apart()
    few = laid.shape[1] - 2
    best, best_f = math.nan, math.inf
    old_h = old_f = math.nan
    n = 0
    while n < POLISHED:
        load = total(given, skin, work, laid, rules, few + 1, h, out)
        f = _imbalance(skin, load, target)
        n += 1
        if abs(f) < abs(best_f):
            best, best_f = h, f
        if abs(f) < CLOSE_BY or (n > 4 and abs(best_f) < BALANCED):
            break
        if old_h == old_h and abs(h - old_h) > 1e-10:
            slope = (f - old_f) / (h - old_h)
        if not slope < 0:
            return math.nan, slope, n
        old_h, old_f = h, f
        step = -f / slope
        if h + step == h:
            break
        h += step
    if abs(best_f) >= BALANCED and abs(best_f) > -slope * ULPS * max(abs(best), 1.0):
        return math.nan, slope, n
    if best != h:
        total(given, skin, work, laid, rules, few + 1, best, out)
    return best, slope, n


@scalar
def _breaks_up(given):
    """Whether particles break: the load may then rise with the separation."""
    for p in range(len(given)):  # noqa: SIM110
        if given[p, BREAKS] == 1:
            return True
    return False


@scalar
def _step_from(given, laid, p, few, gap):
    """Step over seats in which what part p carries hardly rises [m]."""
    if laid[p, few, WAY] == BY_FRAGMENTS:
        return pace_of(given, p, gap)
    return BETWEEN * given[p, WIDTH] if given[p, SEAT] == ROUGH else 0.0


@scalar
def _stays_below(given, skin, work, laid, rules, target, h, out):
    """Whether the load stays below the target at separations above h, looked at step by step.

    It must fall in every step until it is 3 % below, and stay there until no more can be carried.
    """
    keep_apart()
    few, sigma_s, last = laid.shape[1] - 2, skin[0, SIGMA_S], len(given)
    top = top_of(given, skin)
    for p in range(last):
        top = min(top, (given[p, HIGH] - given[p, OFFSET] + 9.5 * given[p, WIDTH]) / sigma_s)
    x, before, good = h, target * (1 + 1e-6), False
    laid[last, COARSE, QUICK] = 1
    for _ in range(STEPS):
        step = math.inf
        for p in range(last):
            gap = x * sigma_s + given[p, OFFSET]
            step = min(step, _step_from(given, laid, p, few, gap))
        x += step / sigma_s
        good = x >= top
        if good or not step > 0:
            break
        load = total(given, skin, work, laid, rules, few, x, out)
        if not load < max(target * (1 - FALLEN), before if before > target * (1 - FALLEN) else 0.0):
            break
        before = load
        most = out[F_SS] + out[F_SA]
        for p in range(last):
            gap = x * sigma_s + given[p, OFFSET]
            most += most_above(given, work[1], p, gap)
        good = most < target * (1 - FALLEN)
        if good:
            break
    laid[last, COARSE, QUICK] = 0
    return good


@scalar
def _come_down(given, skin, work, laid, rules, target, out):
    """First separation from above at which printed sums carry the target, and a slope of ln F.

    Steps over which the load provably stays below it; NaN where none is found, and −∞ where
    there is none.
    """
    keep_apart()
    every = laid.shape[1] - 1
    sigma_s, nodes = skin[0, SIGMA_S], int(rules[every, 0, NODES])
    high = top_of(given, skin)
    for p in range(len(given)):
        if given[p, SEAT] != PRINTED:
            return math.nan, 0.0
    step = 0.25 * (high - LOWEST)
    for _ in range(STEPS):
        if high <= LOWEST:
            return -math.inf, 0.0
        low = max(high - step, LOWEST)
        load = total(given, skin, work, laid, rules, every, low, out)
        dark = most = 0.0
        for p in range(len(given)):
            one, shadow = printed_bound(
                given, p, low * sigma_s, high * sigma_s, rules[every, RULE],
                rules[every, RULE + 1], nodes,
            )  # fmt: skip
            most += one
            dark += shadow
        most += (1 - min(dark, 1.0)) * out[F_SS]
        if most < target * (1 - 1e-9):
            high, step = low, min(2 * step, 1.0)
        elif step > RESOLVED:
            step *= 0.5
        elif load >= target:
            above = total(given, skin, work, laid, rules, every, high, out)
            f, f_above = _imbalance(skin, load, target), _imbalance(skin, above, target)
            if not f > f_above:
                return math.nan, 0.0
            slope = (f_above - f) / (high - low)
            return low - f / slope, slope
        elif load < target * (1 - 1e-3 * RESOLVED):
            high = low
        else:
            return math.nan, 0.0
    return math.nan, 0.0


@scalar
def estimate(given, skin, work, laid, rules, h, slope, row, out):
    """Error of the columns at h, from what few nodes give there, over what is asked of each."""
    keep_apart()
    few = laid.shape[1] - 2
    total(given, skin, work, laid, rules, few, h, out)
    load = (1 - min(row[SHADE], 1.0)) * row[F_SS] + row[F_SA]
    area = row[A_E] + row[A_E + 1] + row[A_E + 2]
    area += row[A_SA] + row[A_SA + 1] + row[A_SA + 2]
    worst = 0.0
    for k in range(10):
        unit = 1.0 if k == SHADE else area
        if k % F_SA == 0 and k < SHADE - 1:  # the two loads
            unit = load
        if unit != 0:
            worst = max(worst, abs((out[k] - row[k]) / unit))
    error, left = SAFE * worst * worst, 0.0
    for p in range(len(given)):  # what series leave out
        if given[p, SEAT] != PRINTED:
            own = SETTLED if given[p, SEAT] == PLANE and given[p, EQUAL] == 1 else ROUNDED
            left += own + work[2][p, laid[p, few, COUNT], SHARE]
        if given[p, SEAT] == ROUGH and laid[p, few, WAY] == PIECES and given[p, BREAKS] == 0:
            gap = h * skin[0, SIGMA_S] + given[p, OFFSET]
            left += left_at_end(given, p, rules[few, 0, PANEL_SPAN], gap)
    if load > 0 and area > 0:  # of the part that particles have
        pressed = row[A_SA] + row[A_SA + 1] + row[A_SA + 2]
        left *= min(max(row[F_SA] / load, pressed / area), 1.0)
    error += SAFE * left
    if slope < 0:
        unit = skin[0, SIGMA_S] / skin[0, SIGMA]
        error = max(error, error / -slope * unit / max(1.0, FAR * abs(h) * unit))
    return error


@scalar
def _root(given, skin, work, laid, rules, target, row, out):
    """The highest separation that carries the target, the slope there, evaluations and fate."""
    keep_apart()
    every = laid.shape[1] - 1
    h, slope, count = search(given, skin, work, laid, rules, target, out)
    if h == -math.inf:
        total(given, skin, work, laid, rules, every, LOWEST, row)
        if not _breaks_up(given) and only_falls_above(given, skin, work, laid, row[F_SS], LOWEST):
            return h, slope, count, TOO_MUCH
    else:
        h, slope, n = polish(given, skin, work, laid, rules, target, h, slope, row)
        count += n
        if math.isfinite(h) and _breaks_up(given):
            good = _stays_below(given, skin, work, laid, rules, target, h, out)
            return h, slope, count, OK if good else NOT_MONOTONE
        if math.isfinite(h) and only_falls_above(given, skin, work, laid, row[F_SS], h):
            return h, slope, count, OK
    first, slope = _come_down(given, skin, work, laid, rules, target, out)
    if not math.isfinite(first):
        unsolved = UNSOLVED if h != h else NOT_MONOTONE
        return h, slope, count, TOO_MUCH if first == -math.inf else unsolved
    h, slope, n = polish(given, skin, work, laid, rules, target, first, slope, row)
    good = abs(h - first) <= RESOLVED
    return h, slope, count + n, OK if good else NOT_MONOTONE


@scalar
def _find_twins(parts, sides, laid):
    """Note of each part the first whose particles carry the same at each squeeze."""
    for p in range(len(parts)):
        laid[p, COARSE, TWIN] = p
        for q in range(p):
            if are_twins(parts, sides, p, q):
                laid[p, COARSE, TWIN] = q
                break


@scalar
def _lay_part(parts, sides, panels, laid, p, series):
    """Panels of part p, or of the first that carries the same; how many, or −1."""
    keep_apart()
    first = laid[p, COARSE, TWIN]
    if first != p:
        count = laid[first, COARSE, COUNT]
        copy_panels(sides, panels, count, first, p)
        return count
    spread = math.inf
    for q in range(p, len(parts)):
        if laid[q, COARSE, TWIN] == p:
            spread = min(spread, spread_of(parts, q))
    return lay_panels(parts, sides, panels, p, series, spread)


@scalar
def _sum_gaps(parts, work, laid, rule):
    """Lay the sums over the squeeze of parts that are summed over gaps, those of twins together."""
    keep_apart()
    _, sides, panels, _, _, _, _, _, sums, _ = work
    some = laid[:-1, FINE, TWIN]
    for p in range(len(parts)):
        some[p] = NOTHING
        for q in range(p + 1):
            if laid[p, COARSE, WAY] == BY_GAPS and laid[q, COARSE, WAY] == BY_GAPS and (
                laid[p, COARSE, TWIN] == laid[q, COARSE, TWIN]
            ):  # fmt: skip
                some[p] = q
                break
    for p in range(len(parts)):
        if some[p] != p:
            continue
        count = laid[p, COARSE, COUNT]
        left = sum_panels(parts, sides, panels, p, some, count, rule, sums)
        for q in range(p, len(parts)):
            if some[q] == p:
                panels[q, count, SHARE] += left


@scalar
def _own_state(given, skin, work, laid, rules, ready, target, h, row, out):
    """Separation, evaluations, fate and error of one state; its columns into ``row``.

    ``ready`` (1,) is the level whose nodes are laid for this contact, or `NOTHING`.
    """
    keep_apart()
    last, few = len(given), laid.shape[1] - 2
    if ready[0] == NOTHING:
        for p in range(last):
            laid[p, COARSE, COUNT] = 0
            if given[p, SEAT] == PRINTED:
                continue
            series = rules[len(rules) - 1, POLYNOMIAL:]
            count = _lay_part(given, work[1], work[2], laid, p, series)
            laid[p, COARSE, WAY] = PIECES
            if count > 0 and goes_by_gaps(given, work[2], p, count):
                laid[p, COARSE, WAY] = BY_GAPS
            if count > 0 and given[p, BREAKS] == 1:
                count = lay_tension(given, work[1], work[2], p, count, series, work[6])
                if count > 0 and goes_by_fragments(given, work[2], p, count):
                    laid[p, COARSE, WAY] = BY_FRAGMENTS
            laid[p, COARSE, COUNT] = count
            if count < 0:
                return h, 0, TOO_LONG, math.inf
        _sum_gaps(given, work, laid, rules[len(rules) - 2, POLYNOMIAL:])
    count, slope, error = 0, 0.0, math.inf
    aim, enough = rules[len(rules) - 1, 0, ASKED], rules[len(rules) - 1, 0, ENOUGH]
    for level in range(LEVELS):
        own = rules[2 * level :]
        if ready[0] != level:
            ready[0] = NOTHING
            if not (
                lay(given, skin, work, laid, own, few)
                and lay(given, skin, work, laid, own, few + 1)
            ):
                return h, count, OK if error <= enough else TOO_LONG, error
            ready[0] = level
        if target > 0:
            h, slope, n, fate = _root(given, skin, work, laid, own, target, row, out)
            count += n
            if fate != OK:
                return h, count, fate, 0.0 if fate == TOO_MUCH else math.inf
        else:
            count += 1
            load = total(given, skin, work, laid, own, few + 1, h, row)
            if load != load:
                return h, count, UNSOLVED, math.inf
        error = estimate(given, skin, work, laid, own, h, slope, row, out)
        if error <= aim:
            break
    return h, count, OK if error <= enough else NOT_RESOLVED, error


@Cached
@njit(nogil=True, cache=True, error_model="numpy", no_cfunc_wrapper=True)
def solve_own(skins, parts, bodies, rules, inside, coating, target, h, count, fate, error, rows):
    """Solve states by their own numbers: skins (N, K, ...), parts (N, P, ...), bodies
    (N, 2P, ...).

    ``inside`` says what particles that break have inside, ``coating`` how asperities do that are
    coated. For the loads target [Pa], or where
    they are zero at the separations ``h`` [σ_s]. Fills ``h``, the evaluations ``count``, ``fate``,
    the estimated ``error`` and the columns ``rows`` (N, 10).
    """
    most = parts.shape[1]
    sides = np.zeros((2 * most, SIDE))
    work = (
        np.zeros((5, 2 * MOST_HEIGHTS * skins.shape[1])),
        sides,
        np.empty((most, MOST_PANELS + ROOM, PANEL)),
        np.empty((GRID_ROWS, MOST_NODES)),
        np.empty((4, MOST_SIZES)),
        np.empty(MOST_WHOLE if inside[0, 0] > 0 else 1),
        inside,
        coating,
        np.empty((most, MOST_PANELS, SUMS)),
        np.empty((FRAGMENT_ROWS, MOST_ENDS if inside[0, 0] > 0 else 1)),
    )
    laid = np.zeros((most + 1, 2, LAID), np.int64)
    ready = np.full(1, NOTHING)
    out = np.empty(10)
    for i in range(len(target)):
        if i > 0:
            for p in range(most):
                parts[i, p, LEAST] = parts[i - 1, p, LEAST]  # which is found, not given
        if i == 0 or not (
            is_alike(skins[i].ravel(), skins[i - 1].ravel())
            and is_alike(parts[i].ravel(), parts[i - 1].ravel())
            and is_alike(bodies[i].ravel(), bodies[i - 1].ravel())
        ):
            ready[0] = NOTHING
            for s in range(2 * most):
                for k in range(bodies.shape[2]):
                    sides[s, k] = bodies[i, s, k]
            _find_twins(parts[i], sides, laid)
        h[i], count[i], fate[i], error[i] = _own_state(
            parts[i], skins[i], work, laid, rules, ready, target[i], h[i], rows[i], out
        )
