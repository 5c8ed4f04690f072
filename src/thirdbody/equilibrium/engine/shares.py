"""How two different sides share a squeeze, as series on panels of it."""

from __future__ import annotations

import math

from ..compiled.machine import apart
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    BESIDE,
    CLOSE,
    EDGE,
    FIRST,
    FLAT,
    FORM_1,
    FORM_2,
    FROM,
    HELD,
    JUMP,
    LEAST,
    LOAD,
    MOST,
    MOST_PANELS,
    NEAR,
    NEAR_1,
    NEAR_2,
    NEAR_OTHER,
    NEARBY,
    OFF,
    OLD,
    OLD_OFF,
    ONE,
    OTHER,
    RESOLVED,
    ROOM,
    SECOND,
    SHARE,
    SHARED,
    SOLVED,
    STEEPEST,
    SURE,
    TERMS,
    TO,
    TRIES,
    UNTIL,
    fill_both,
    fill_places,
    find_off,
    find_rest,
    follow,
    mix,
    settle_rows,
    take_weaker,
    transform,
)
from .fields import CEB, CODE, COUNT, JG, JUMPS, KINKS, LIMIT, LOADS, MOST_JUMPS
from .sides import exact, scalar, side_at
from .vectors import exp, formula_of, ln, padded

SEEN = 11
"""Term of a share that must be small: where it is, rules of as many nodes sum what it gives."""


@scalar
def note_jumps(sides, i):
    """Write down where the load of a side jumps."""
    apart()
    sides[i, JUMPS] = 0
    if not CEB <= sides[i, CODE] <= JG:
        return
    for k in range(int(sides[i, COUNT])):
        delta, n = sides[i, KINKS + k], int(sides[i, JUMPS])
        below = side_at(sides, i, delta * (1 - BESIDE))[0]
        at = side_at(sides, i, delta * (1 + BESIDE))[0]
        if abs(at - below) > JUMP * at and n < MOST_JUMPS:
            place = JUMPS + 1 + 3 * n
            sides[i, place], sides[i, place + 1], sides[i, place + 2] = delta, below, at
            sides[i, JUMPS] = n + 1


@scalar
def jump_of(sides, i, n):
    """Where the n-th jump of a side is, and the loads before and behind it."""
    place = JUMPS + 1 + 3 * n
    return sides[i, place], sides[i, place + 1], sides[i, place + 2]


@scalar
def note_loads(sides, i):
    """Write down the load of a side at each of its kinks."""
    apart()
    for k in range(int(sides[i, COUNT])):
        sides[i, LOADS + k] = side_at(sides, i, sides[i, KINKS + k])[0]


@scalar
def around(sides, i, k):
    """Loads before and behind kink k of a side; equal ones where the load does not jump."""
    for n in range(int(sides[i, JUMPS])):
        at_jump, below, at = jump_of(sides, i, n)
        if at_jump == sides[i, KINKS + k]:
            return below, at
    return sides[i, LOADS + k], sides[i, LOADS + k]


@scalar
def inverse(sides, i, load):
    """Indentation over x at which a side first carries a load below its limit.

    By secants of ln load over ln indentation, inside the bracket.
    """
    apart()
    count = int(sides[i, COUNT])
    n = count - count  # no constant, for which numba would compile twice
    below = at = 0.0
    while n < count:
        below, at = around(sides, i, n)
        if max(below, at) >= load:
            break
        n += 1
    if n == count:
        return sides[i, KINKS + count - 1]
    top = sides[i, KINKS + n]
    if below != at:
        if below < load:
            return top
        top *= 1 - BESIDE
    high, f_high = math.log(top), math.log((below if below != at else at) / load)
    low, f_low = -math.inf, -math.inf
    x, slope = high - f_high / 1.5, 1.5
    if n > 0:
        low = math.log(sides[i, KINKS + n - 1])
        f_low = math.log(around(sides, i, n - 1)[1] / load)
        if f_low >= 0:
            return math.exp(low)
        slope = (f_high - f_low) / (high - low)
        x = high - f_high / slope
    old, old_f = high, f_high
    for step in range(100):
        f = math.log(side_at(sides, i, math.exp(x))[0] / load)
        if f < 0:
            low = x
        else:
            high = x
        if x != old and f != old_f:
            slope = (f - old_f) / (x - old)
        if abs(f * old_f) < 1e-16 or high - low < 4e-16 * abs(x):
            break
        old, old_f = x, f
        x -= f / slope
        if not low < x < high or not slope > 0 or step % 12 == 11:
            x = 0.5 * (low + high) if low > -math.inf else high - 2.0
    return math.exp(min(max(x - f / slope, low), high) if slope > 0 else x)


@scalar
def split(sides, i, eps, low, high, delta, power):
    """Indentation over x of side i at a squeeze ε, between two; side i + 1 takes the rest.

    By secants from a first guess, inside the bracket; the first slope is that of a load which
    grows like a power of the indentation. That power at the end, too.
    """
    apart()
    if not low < delta < high:
        delta = 0.5 * (low + high)
    old = old_f = math.nan
    slope = power / delta + power / max(eps - delta, 1e-300)
    for step in range(100):
        f = math.log(side_at(sides, i, delta)[0] / side_at(sides, i + 1, eps - delta)[0])
        if f < 0:
            low = delta
        else:
            high = delta
        if old == old and delta != old:
            slope = (f - old_f) / (delta - old)
        if abs(f) < 4e-16 or high - low < 4e-16 * high:
            break
        old, old_f = delta, f
        delta -= f / slope
        if not low < delta < high or not slope > 0 or step % 12 == 11:
            delta = 0.5 * (low + high)
        elif abs(delta - old) < 2e-16 * delta or (step > 0 and abs(f) < SHARED):
            break
    power = slope * delta * (eps - delta) / eps
    return delta, power if 0.5 < power < STEEPEST else 1.3


@scalar
def _held(sides, p, eps):
    """As `HELD`: where a jump up of its load holds a side at a squeeze ε, or 0."""
    apart()
    for i in range(2):
        own, other = 2 * p + i, 2 * p + 1 - i
        for n in range(int(sides[own, JUMPS])):
            delta, below, at = jump_of(sides, own, n)
            if delta < eps and below < at and below < side_at(sides, other, eps - delta)[0] < at:
                return delta * (1 - BESIDE) * (1 - 2 * i)
    return 0.0


@scalar
def _lets_go(sides, p):
    """Whether the load of a side falls at a jump."""
    for own in range(2 * p, 2 * p + 2):
        for n in range(int(sides[own, JUMPS])):
            _, below, at = jump_of(sides, own, n)
            if at < below:
                return True
    return False


@scalar
def _allowed(sides, p, eps):
    """Between which indentations side 1 is at ε.

    A side whose load falls at a jump lets go where loading first reaches it.
    """
    apart()
    low, high = 0.0, eps
    for i in range(2):
        own, other = 2 * p + i, 2 * p + 1 - i
        for n in range(int(sides[own, JUMPS])):
            delta, below, at = jump_of(sides, own, n)
            if at >= below or below >= sides[other, LIMIT] * (1 - CLOSE):
                continue
            past = eps > delta + inverse(sides, other, below)
            delta *= 1 + BESIDE if past else 1 - BESIDE
            if i == 0 and past:
                low = max(low, delta)
            elif i == 0:
                high = min(high, delta)
            elif past:
                high = min(high, eps - delta)
            else:
                low = max(low, eps - delta)
    if low < high:
        return low, high
    return 0.0, eps


@exact
def _guess(eps, a, b, low, high, first, least, most):
    """Indentations of side 1 by a power between two known ones, and where they must lie."""
    if a > 0:
        power = math.log(high / low) / math.log(b / a)
        for j in range(len(eps)):
            first[j] = low * exp(power * ln(eps[j] / a))
    else:
        for j in range(len(eps)):
            first[j] = high * eps[j] / b
    for j in range(len(eps)):
        least[j] = max(low, eps[j] - (b - high))
        most[j] = min(min(high, eps[j] - (a - low)), eps[j])
        first[j] = first[j] if least[j] < first[j] < most[j] else 0.5 * (least[j] + most[j])


@exact
def _find_rates(first, second, load, other, slope):
    """Slope of ln of the load of side 1 over that of side 2 at a fixed squeeze, by neighbours."""
    last = TERMS - 1
    for j in range(TERMS):
        k, n = min(j + 1, last), max(j - 1, 0)
        rise = (load[n] - load[k]) * (first[n] + first[k])
        run = (load[n] + load[k]) * (first[n] - first[k])
        rise_2 = (other[n] - other[k]) * (second[n] + second[k])
        run_2 = (other[n] + other[k]) * (second[n] - second[k])
        one = rise / run if rise > 0 and run > 0 else 1.3
        two = rise_2 / run_2 if rise_2 > 0 and run_2 > 0 else 1.3
        slope[j] = one / first[j] + two / second[j]
    for j in range(TERMS, len(slope)):
        slope[j] = slope[last]


@exact
def _improve(load, other, slope, first, least, most, old, old_off, weight):
    """One step inside the bracket, of ln of the loads; the largest of those before.

    With slopes (``weight`` 0), or where they can be had, by secants (1).
    """
    worst = 0.0
    for j in range(len(first)):
        f, now = ln(load[j] / other[j]), first[j]
        worst = max(worst, abs(f))
        low = now if f < 0 else least[j]
        high = most[j] if f < 0 else now
        run = now - old[j]
        secant = (f - old_off[j]) / (run if run != 0 else 1.0)
        slope[j] = secant if weight * secant > 0 else slope[j]
        following = now - f / slope[j]
        beside = now if abs(f) < FLAT else 0.5 * (low + high)
        following = following if low < following else beside
        first[j] = following if following < high else beside
        old[j], old_off[j], least[j], most[j] = now, f, low, high
    return worst


@scalar
def _end_share(sides, p, panel, room, rule, wide):
    """Series of the share, and of load and areas, from indentations that are all but found.

    What the room has of the step before is a point on the line to the root.
    """
    apart()
    eps, first, second = room[AT, :wide], room[FIRST, :wide], room[SECOND, :wide]
    load, other, off = room[LOAD, :wide], room[OTHER, :wide], room[OFF, :wide]
    for j in range(wide):
        room[NEAR, j], room[NEAR_1, j] = room[LOAD, j], room[AREA_1, j]
        room[NEAR_OTHER, j], room[NEAR_2, j] = room[OTHER, j], room[AREA_2, j]
    find_rest(eps, first, second)
    fill_both(sides, p, panel, first, second, room)
    worst = find_off(load, other, off)
    follow(off, room[NEAR, :wide], room[NEAR_OTHER, :wide], off)
    mix(off, room[OLD, :wide], first)
    for j in range(TERMS):
        room[LEAST, j] = first[j] / eps[j]
    transform(rule, room[LEAST, :TERMS], panel[SHARE : SHARE + TERMS])
    if worst <= NEARBY:
        mix(off, room[NEAR, :wide], load)
        mix(off, room[NEAR_OTHER, :wide], other)
        mix(off, room[NEAR_1, :wide], room[AREA_1, :wide])
        mix(off, room[NEAR_2, :wide], room[AREA_2, :wide])
        find_rest(eps, first, second)
        take_weaker(first, second, other, load)
        settle_rows(panel, room, rule)


@scalar
def _fill_share(sides, panels, p, n, rule, a, b, low, high):
    """Series of the share of side 1 on panel n; whether it could be found.

    The indentations of side 1 at two squeezes a and b around the panel are ``low`` and ``high``.
    """
    apart()
    panel, room = panels[p, n], panels[p, len(panels[p]) - ROOM :]
    begin, end, wide = panel[EDGE], panel[TO], padded(TERMS)
    panel[FROM], panel[UNTIL] = begin, end
    eps, first, second = room[AT, :wide], room[FIRST, :wide], room[SECOND, :wide]
    load, other, slope = room[LOAD, :wide], room[OTHER, :wide], room[NEAR, :wide]
    least, most = room[LEAST, :wide], room[MOST, :wide]
    for j in range(wide):
        slope[j] = rule[0, min(j, TERMS - 1)]
    fill_places(slope, begin, end, eps)
    _guess(eps, a, b, low, high, first, least, most)
    middle = TERMS // 2
    panel[FORM_1] = formula_of(sides, 2 * p, first[middle])
    panel[FORM_2] = formula_of(sides, 2 * p + 1, eps[middle] - first[middle])
    worst = math.inf
    for step in range(TRIES):
        find_rest(eps, first, second)
        fill_both(sides, p, panel, first, second, room)
        if step == 0:
            _find_rates(first, second, load, other, slope)
        worst = _improve(
            load, other, slope, first, least, most, room[OLD, :wide], room[OLD_OFF, :wide],
            min(step, 1),
        )  # fmt: skip
        if worst < SOLVED:
            break
    panel[SURE] = 0.0
    if worst < SOLVED:
        _end_share(sides, p, panel, room, rule, wide)
    return worst < SOLVED


@scalar
def _fill_share_by_one(sides, panels, p, n, rule, before, behind, low, high):
    """As `_fill_share`, one node after another."""
    apart()
    first, last = panels[p, n, EDGE], panels[p, n, TO]
    panels[p, n, FROM], panels[p, n, UNTIL] = first, last
    free = _lets_go(sides, p)
    for k in range(TERMS):
        panels[p, n, SHARE + k] = 0.0
    share, power = 0.0, 1.3
    for j in range(TERMS):  # from the last place down to the first
        x = rule[0, j]
        eps = 0.25 * last * (x + 1) ** 2
        if first > 0:
            eps = first * math.exp(0.5 * (x + 1) * math.log(last / first))
        guess = share * eps if j > 0 else high * eps / behind
        least, most = max(low, eps - (behind - high)), min(high, eps - (before - low))
        if free:
            least, most = _allowed(sides, p, eps)
        delta, power = split(sides, 2 * p, eps, least, most, guess, power)
        share = delta / eps
        for k in range(TERMS):
            panels[p, n, SHARE + k] += rule[1 + k, j] * share


@scalar
def share_out(sides, panels, p, count, rule):
    """Fill the series of the share on every panel, halved where it is not resolved.

    How many panels there are then, and the largest last term of a series.
    """
    apart()
    n, worst, free = int(panels[p, 0, EDGE]), 0.0, _lets_go(sides, p)  # 0, and no constant
    begin, low = 0.0, 0.0
    while n < count:
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        if n > 0 and panels[p, n, ONE] >= 0:
            begin, low = a, panels[p, n, ONE]
        last = n + 1
        while panels[p, last, ONE] < 0:
            last += 1
        end, high = panels[p, last, EDGE], panels[p, last, ONE]
        panels[p, n, FORM_1] = panels[p, n, FORM_2] = panels[p, n, SURE] = 0.0
        panels[p, n, HELD] = _held(sides, p, 0.5 * (a + b))
        if panels[p, n, HELD] != 0:
            n += 1
            continue
        if free or not _fill_share(sides, panels, p, n, rule, begin, end, low, high):
            _fill_share_by_one(sides, panels, p, n, rule, begin, end, low, high)
            panels[p, n, SURE] = 0.0
        tail = abs(panels[p, n, SHARE + SEEN]) + abs(panels[p, n, SHARE + SEEN - 1])
        if tail > RESOLVED and b > a * 1.001 and count < MOST_PANELS - 2:
            for m in range(count + 1, n, -1):
                for k in (EDGE, TO, ONE):
                    panels[p, m, k] = panels[p, m - 1, k]
            panels[p, n, TO] = panels[p, n + 1, EDGE] = math.sqrt(a * b) if a > 0 else 0.25 * b
            panels[p, n + 1, ONE] = -1.0
            count += 1
            continue
        worst = max(worst, tail)
        n += 1
    return count, worst
