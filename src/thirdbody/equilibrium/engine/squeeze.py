"""One particle of unit size between two sides, as panels of its squeeze ε, once a state."""

from __future__ import annotations

import math

from ..compiled.machine import apart
from .fields import (
    CEB,
    CODE,
    COUNT,
    EQUAL,
    FOOTPRINT,
    JG,
    JUMPS,
    KINKS,
    LIMIT,
    MOST_JUMPS,
    PROJECTED,
    SHADOW,
)
from .sides import prepare, regime_of, scalar, side_at

__all__ = [
    "EDGE",
    "KINKED",
    "LAST_1",
    "LAST_2",
    "MOST_PANELS",
    "PANEL",
    "PULLED",
    "RATE",
    "REGIME",
    "START",
    "TENSION",
    "TERMS",
    "lay_panels",
    "particle_at",
]

MOST_PANELS, TERMS = 160, 12
EDGE, TO, REGIME, HELD, FROM, UNTIL, SHARE = range(7)
"""Of a panel: its ends in ε, the regime of side 1, the indentation at which a jump of its load
holds side 1 (side 2 if negative, none if 0); ends and coefficients of the share of side 1."""
LAST_1, LAST_2 = FROM, UNTIL
"""Of the row behind the last panel: areas over x² on both surfaces of all that is squeezed more."""
PULLED, RATE, START, KINKED, TENSION = range(SHARE + TERMS, SHARE + TERMS + 5)
"""Tension [Pa] that holds on a panel on which less is met, or 0; place on the panel, as a rate of
ln ε and where it starts; whether a formula changes at the end, of how many generations ago; series
of the logarithm of the tension."""
PANEL = TENSION + TERMS
RATIO = 4.0
"""Of the ends of a panel, at most: from the onset, where formulas are not smooth, it is so far."""
CLOSE, BALANCED, NEARBY, RESOLVED = 1e-12, 1e-13, 1e-8, 1e-6
FLAT = 2e-15
"""Change of the ratio of two loads that is rounding: near a plateau no step brings them closer."""
SHARED, STEEPEST = 1e-7, 1e4
"""Imbalance from which one more step of secants leaves 1e-10 of a share, of which `particle_at`
leaves the square; power of an indentation like which a load may grow."""
JUMP, BESIDE = 1e-9, 1e-14
"""Of a load at a kink, at least, and where its sides are looked at; both relative."""
DEEPEST, SAME_AREA = 1e3, 1e-5


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
def around(sides, i, k):
    """Loads before and behind kink k of a side; equal ones where the load does not jump."""
    apart()
    delta = sides[i, KINKS + k]
    for n in range(int(sides[i, JUMPS])):
        at_jump, below, at = jump_of(sides, i, n)
        if at_jump == delta:
            return below, at
    load = side_at(sides, i, delta)[0]
    return load, load


@scalar
def inverse(sides, i, load):
    """Indentation over x at which a side first carries a load below its limit."""
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
    high = math.log(top)
    f_high = math.log(side_at(sides, i, top)[0] / load)
    if n == 0:
        low = high - f_high / 1.4 - 0.5
        f_low = math.log(side_at(sides, i, math.exp(low))[0] / load)
        while f_low > 0:
            low -= 2.0
            f_low = math.log(side_at(sides, i, math.exp(low))[0] / load)
    else:
        low = math.log(sides[i, KINKS + n - 1])
        f_low = math.log(around(sides, i, n - 1)[1] / load)
    if f_low >= 0:
        return math.exp(low)
    last = 0
    x = high
    for step in range(200):
        x = (low * f_high - high * f_low) / (f_high - f_low)
        if not low < x < high or step % 8 == 7:
            x = 0.5 * (low + high)
        f = math.log(side_at(sides, i, math.exp(x))[0] / load)
        if abs(f) < 2e-16 or high - low < 1e-15 * abs(x):
            break
        if f < 0:
            low, f_low = x, f
            if last == -1:
                f_high *= 0.5
            last = -1
        else:
            high, f_high = x, f
            if last == 1:
                f_low *= 0.5
            last = 1
    return math.exp(x)


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
def share_at(panels, p, n, eps):
    """Share of side 1 in a squeeze ε on panel n."""
    apart()
    first, last = panels[p, n, FROM], panels[p, n, UNTIL]
    if first == 0:
        x = 2 * math.sqrt(eps / last) - 1
    else:
        x = 2 * math.log(eps / first) / math.log(last / first) - 1
    b, c = 0.0, 0.0
    for k in range(TERMS - 1, 0, -1):
        b, c = panels[p, n, SHARE + k] + 2 * x * b - c, b
    return panels[p, n, SHARE] + x * b - c


@scalar
def first_at(panels, p, n, eps):
    """Indentation over x of side 1 at a squeeze ε on panel n."""
    held = panels[p, n, HELD]
    if held != 0:
        return held if held > 0 else eps + held
    return eps * share_at(panels, p, n, eps)


@scalar
def particle_at(given, sides, panels, p, n, eps):
    """Load over x² [Pa] and areas over x² on both surfaces, of ε on panel n of part p."""
    apart()
    if given[p, EQUAL] == 1:
        load, area = side_at(sides, 2 * p, 0.5 * eps)
        return load, area, area
    one, held = first_at(panels, p, n, eps), panels[p, n, HELD]
    load, first = side_at(sides, 2 * p, one)
    other, second = side_at(sides, 2 * p + 1, eps - one)
    if held != 0:
        return other if held > 0 else load, first, second
    off = other / load - 1
    if abs(off) > NEARBY:  # nearer first: what follows has an error of the square of this
        step = off / (1.3 / one + 1.3 / (eps - one))
        near = side_at(sides, 2 * p + 1, eps - one - step)[0] / side_at(sides, 2 * p, one + step)[0]
        if abs(off - (near - 1)) > FLAT:
            one += step * off / (off - (near - 1))
        load, first = side_at(sides, 2 * p, one)
        other, second = side_at(sides, 2 * p + 1, eps - one)
        off = other / load - 1
    if abs(off) > BALANCED:
        # along the line from here to a point that is closer, with an error of its square
        step = off / (1.3 / one + 1.3 / (eps - one))
        near, near_first = side_at(sides, 2 * p, one + step)
        near_other, near_second = side_at(sides, 2 * p + 1, eps - one - step)
        change = off - (near_other / near - 1)
        part = off / change if near_other > 0 and abs(change) > FLAT else 0.0
        one += part * step
        load += part * (near - load)
        other += part * (near_other - other)
        first += part * (near_first - first)
        second += part * (near_second - second)
    return load if one > eps - one else other, first, second


@scalar
def _lay(panels, p, count, eps):
    """Note an end of panels, in increasing order; equal ones once."""
    apart()
    place = count
    while place > 0 and panels[p, place - 1, EDGE] > eps:
        place -= 1
    if place > 0 and panels[p, place - 1, EDGE] >= eps * (1 - 1e-13):
        return count
    for j in range(count, place, -1):
        panels[p, j, EDGE] = panels[p, j - 1, EDGE]
    panels[p, place, EDGE] = eps
    return count + 1


@scalar
def _kinks(given, sides, panels, p):
    """Kinks in ε as ends of panels after 0; how many ends."""
    apart()
    panels[p, 0, EDGE] = 0.0
    count = 1 + int(panels[p, 0, EDGE])  # no constant, for which numba would compile twice
    equal = given[p, EQUAL] == 1
    for i in range(1 if equal else 2):
        own, other = 2 * p + i, 2 * p + 1 - i
        for k in range(int(sides[own, COUNT])):
            delta = sides[own, KINKS + k]
            if equal:
                count = _lay(panels, p, count, 2 * delta)
                continue
            below, at = around(sides, own, k)
            limit = sides[other, LIMIT]
            for n in range(1 if at <= below else 2):
                load = below if n == 0 else at
                if load < limit * (1 - CLOSE):
                    count = _lay(panels, p, count, delta + inverse(sides, other, load))
                elif load < limit * (1 + CLOSE):
                    last = sides[other, KINKS + int(sides[other, COUNT]) - 1]
                    count = _lay(panels, p, count, delta + last)
    return count


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


@scalar
def _fill_share(sides, panels, p, n, rule, low, high):
    """Series of the share of side 1 on panel n, which lies between two indentations of it.

    Where a side may let go, they say nothing.
    """
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
        guess = share * eps if j > 0 else high * eps / last
        least, most = max(low, eps - (last - high)), min(high, eps)
        if free:
            least, most = _allowed(sides, p, eps)
        delta, power = split(sides, 2 * p, eps, least, most, guess, power)
        share = delta / eps
        for k in range(TERMS):
            panels[p, n, SHARE + k] += rule[1 + k, j] * share


@scalar
def _share_out(sides, panels, p, count, rule):
    """Fill the series of the share on every panel, halved where it is not resolved.

    How many panels there are then, and the largest last term of a series.
    """
    apart()
    low, n, worst = 0.0, int(panels[p, 0, EDGE]), 0.0  # 0, and no constant
    free = _lets_go(sides, p)
    while n < count:
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        held = panels[p, n, HELD] = _held(sides, p, 0.5 * (a + b))
        high = 0.5 * b
        if held != 0:
            low = held if held > 0 else b + held
            n += 1
            continue
        if not free:
            high, _ = split(sides, 2 * p, b, low, min(b, low + b - a), low + 0.5 * (b - a), 1.3)
        _fill_share(sides, panels, p, n, rule, low, high)
        tail = abs(panels[p, n, SHARE + TERMS - 1]) + abs(panels[p, n, SHARE + TERMS - 2])
        if tail > RESOLVED and b > a * 1.001 and count < MOST_PANELS - 2:
            for m in range(count, n, -1):
                panels[p, m, EDGE], panels[p, m, TO] = panels[p, m - 1, EDGE], panels[p, m - 1, TO]
            panels[p, n, TO] = panels[p, n + 1, EDGE] = math.sqrt(a * b) if a > 0 else 0.25 * b
            count += 1
            continue
        worst = max(worst, tail)
        low = high
        n += 1
    return count, worst


@scalar
def _areas_at(sides, panels, p, n, eps):
    """Areas over x² on both surfaces, of ε on panel n, as the share of a squeeze has them."""
    apart()
    one = first_at(panels, p, n, eps)
    return side_at(sides, 2 * p, one)[1], side_at(sides, 2 * p + 1, eps - one)[1]


@scalar
def _crossing(sides, panels, p, n, low, high):
    """ε on panel n between two at which the areas on both surfaces are equal."""
    apart()
    one, two = _areas_at(sides, panels, p, n, low)
    above = one > two
    for _ in range(100):
        eps = 0.5 * (low + high)
        if high - low <= 1e-15 * high:
            break
        one, two = _areas_at(sides, panels, p, n, eps)
        if (one > two) == above:
            low = eps
        else:
            high = eps
    return 0.5 * (low + high)


@scalar
def _cut_at_crossings(given, sides, panels, p, count):
    """Panels cut where the larger of the two areas changes, if it counts; their number."""
    apart()
    if given[p, SHADOW] != FOOTPRINT and given[p, SHADOW] != PROJECTED:
        return count
    n = int(panels[p, 0, EDGE])  # 0, and no constant
    while n < count and count < MOST_PANELS - 2:
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        before, place = 0.0, a
        for j in range(9):
            eps = a + (b - a) * (1e-4 + 0.124975 * j)
            one, two = _areas_at(sides, panels, p, n, eps)
            sign = 0.0
            if abs(one - two) > 1e-11 * max(one, two):
                sign = 1.0 if one > two else -1.0
            if sign * before < 0:
                at = _crossing(sides, panels, p, n, place, eps)
                for m in range(count, n, -1):
                    for k in range(PANEL):
                        panels[p, m, k] = panels[p, m - 1, k]
                panels[p, n, TO] = panels[p, n + 1, EDGE] = at
                count += 1
                break
            if sign != 0:
                before, place = sign, eps
        n += 1
    return count


@scalar
def _last_area(sides, i, load, area):
    """Area over x² of a side at the last load of a particle, near which it is ``area``.

    A share between the sides holds to some 1e-6 beside a kink, and all that is squeezed further
    has this area: it is read from the law.
    """
    apart()
    if sides[i, LIMIT] <= load * (1 + CLOSE):
        return side_at(sides, i, 2 * sides[i, KINKS + int(sides[i, COUNT]) - 1])[1]
    last = side_at(sides, i, inverse(sides, i, load))[1]
    if sides[i, JUMPS] > 0 and abs(last - area) > SAME_AREA * area:
        return area  # the last load lies on a jump: this is its other side
    return last


@scalar
def _note_last(given, sides, panels, p, count):
    """Write down what all that is squeezed beyond the last panel has in common."""
    apart()
    equal, eps, first = given[p, EQUAL] == 1, panels[p, count - 1, TO], sides[2 * p, LIMIT]
    other = first if equal else sides[2 * p + 1, LIMIT]
    load = min(first, other)
    _, one, two = particle_at(given, sides, panels, p, count - 1, eps)
    one = panels[p, count, LAST_1] = _last_area(sides, 2 * p, load, one)
    panels[p, count, LAST_2] = one if equal else _last_area(sides, 2 * p + 1, load, two)
    # the weaker side takes the rest
    indented = 0.5 * eps if equal else first_at(panels, p, count - 1, eps)
    deeper = equal or first <= other * (1 + CLOSE)
    if sides[2 * p, JUMPS] + sides[2 * p + 1, JUMPS] > 0:  # a last kink of either
        deeper |= panels[p, count - 1, HELD] <= 0
    indented *= 1 + 1e-9 * (1 if deeper else -1)
    panels[p, count, REGIME] = regime_of(sides, 2 * p, indented)


@scalar
def lay_panels(given, sides, panels, p, rule):
    """Lay the panels of part p; how many, or −1 where the formulas do not cover it."""
    apart()
    if not prepare(sides, 2 * p):
        return -1
    equal, worst = given[p, EQUAL] == 1, 0.0
    if not equal and not prepare(sides, 2 * p + 1):
        return -1
    note_jumps(sides, 2 * p)
    if not equal:
        note_jumps(sides, 2 * p + 1)
    count = _kinks(given, sides, panels, p)
    if count < 2 or panels[p, count - 1, EDGE] > DEEPEST:
        return -1
    known = count
    for k in range(1, known - 1):  # cut those whose ends lie far apart
        a, b = panels[p, known - 1 - k, EDGE], panels[p, known - k, EDGE]
        parts = math.ceil(math.log(b / a) / math.log(RATIO) - 1e-9)
        if count + parts >= MOST_PANELS - 2:
            return -1
        step = (b / a) ** (1.0 / parts) if parts > 1 else 1.0
        for _ in range(parts - 1):
            a *= step
            count = _lay(panels, p, count, a)
    for n in range(count - 1):
        panels[p, n, TO] = panels[p, n + 1, EDGE]
    count -= 1
    if not equal:
        count, worst = _share_out(sides, panels, p, count, rule)
        count = _cut_at_crossings(given, sides, panels, p, count)
    for n in range(count):
        eps = 0.5 * (panels[p, n, EDGE] + panels[p, n, TO])
        one = 0.5 * eps if equal else first_at(panels, p, n, eps)
        panels[p, n, REGIME] = regime_of(sides, 2 * p, one)
    _note_last(given, sides, panels, p, count)
    panels[p, count, SHARE] = 0.0 if equal else worst
    return count
