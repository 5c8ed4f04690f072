"""How two sides share a squeeze, as series on panels of it, and what a particle then carries."""

from __future__ import annotations

import math

from ..compiled.machine import apart
from .fields import CEB, CODE, COUNT, EQUAL, JG, JUMPS, KINKS, LIMIT, LOADS, MOST_JUMPS
from .sides import exact, scalar, side_at, summed
from .vectors import exp, fill_side, formula_of, ln, padded

MOST_PANELS, TERMS = 160, 16
EDGE, TO, REGIME, HELD, FROM, UNTIL, SHARE = range(7)
"""Of a panel: its ends in ε, the regime of side 1, the indentation at which a jump of its load
holds side 1 (side 2 if negative, none if 0); ends and coefficients of the share of side 1."""
LAST_1, LAST_2 = FROM, UNTIL
"""Of the row behind the last panel: areas over x² on both surfaces of all that is squeezed more."""
PULLED, RATE, START, KINKED, TENSION = range(SHARE + TERMS, SHARE + TERMS + 5)
"""Tension [Pa] that holds on a panel on which less is met, or 0; place on the panel, as a rate of
ln ε and where it starts; whether a formula changes at the end, of how many generations ago; series
of the logarithm of the tension."""
FORM_1, FORM_2, ONE, SURE, OF_LOAD = range(TENSION + TERMS, TENSION + TERMS + 5)
"""Formulas of both sides; indentation over x of side 1 where the panel begins, negative where
that is not known; whether load and areas are read from series, and the first of them."""
OF_AREA_1, OF_AREA_2, PANEL = OF_LOAD + TERMS, OF_LOAD + 2 * TERMS, OF_LOAD + 3 * TERMS
"""Series of the load over ε^1.5 and of both areas over ε."""
SETTLED = 1e-11
"""Of the last two terms of such a series over its largest value, at most."""
ROOM = 19
"""Rows behind those of the panels, for what many nodes have on the way."""
AT, LOAD, AREA_1, AREA_2, FIRST, SECOND, OTHER, OFF, NEAR, NEAR_1, NEAR_OTHER, NEAR_2 = range(12)
PASSING, PASSING_2, LEAST, MOST, OLD, OLD_OFF, MASS = range(12, ROOM)
"""Of those rows: ε, load and areas over x²; indentations of both sides, load of the second and how
far it is off; the same a step further; what else is on
the way, and weights of a caller."""
CLOSE, BALANCED, NEARBY, RESOLVED = 1e-12, 1e-13, 1e-8, 1e-6
SHARED, SOLVED, STEEPEST, TRIES, FLAT = 1e-7, 1e-5, 1e4, 25, 1e-12
"""Imbalances from which one more step of secants leaves 1e-10 and 1e-8 of a share, of which
`particle_at` leaves the square; power of an indentation like which a load may grow."""
JUMP, BESIDE = 1e-9, 1e-14
"""Of a load at a kink, at least, and where its sides are looked at; both relative."""


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
    if panels[p, n, SURE] == 1:
        return _read_particle(panels[p, n], eps)
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
        one += step * off / (off - (near - 1))
        load, first = side_at(sides, 2 * p, one)
        other, second = side_at(sides, 2 * p + 1, eps - one)
        off = other / load - 1
    if abs(off) > BALANCED:
        # along the line from here to a point that is closer, with an error of its square
        step = off / (1.3 / one + 1.3 / (eps - one))
        near, near_first = side_at(sides, 2 * p, one + step)
        near_other, near_second = side_at(sides, 2 * p + 1, eps - one - step)
        part = off / (off - (near_other / near - 1)) if near_other > 0 else 0.0
        one += part * step
        load += part * (near - load)
        other += part * (near_other - other)
        first += part * (near_first - first)
        second += part * (near_second - second)
    return load if one > eps - one else other, first, second


@exact
def _read_shares(panel, eps, first):
    """Indentation over x of side 1 at squeezes of a panel with a series, into ``first``."""
    apart()
    begin, end, series = panel[FROM], panel[UNTIL], panel[SHARE : SHARE + TERMS]
    rooted = begin == 0
    rate = 2 / math.log(end / begin) if not rooted else 0.0
    for j in range(len(eps)):
        first[j] = 2 * math.sqrt(eps[j] / end) - 1 if rooted else rate * ln(eps[j] / begin) - 1
    for j in range(len(eps)):
        x = first[j]
        b, c, twice = 0.0, 0.0, 2 * x
        for k in range(1, TERMS):
            b, c = series[TERMS - k] + twice * b - c, b
        first[j] = eps[j] * (series[0] + x * b - c)


@exact
def _read_particles(panel, eps, load, one, two):
    """Load and areas at squeezes of a panel, by their series."""
    begin, end = panel[FROM], panel[UNTIL]
    rooted = begin == 0
    rate = 2 / math.log(end / begin) if not rooted else 0.0
    for j in range(len(eps)):
        load[j] = 2 * math.sqrt(eps[j] / end) - 1 if rooted else rate * ln(eps[j] / begin) - 1
    first, second = panel[OF_LOAD:OF_AREA_1], panel[OF_AREA_1:OF_AREA_2]
    third = panel[OF_AREA_2:PANEL]
    for j in range(len(eps)):
        x = load[j]
        b_1, c_1, b_2, c_2, b_3, c_3, twice = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2 * x
        for k in range(1, TERMS):
            b_1, c_1 = first[TERMS - k] + twice * b_1 - c_1, b_1
            b_2, c_2 = second[TERMS - k] + twice * b_2 - c_2, b_2
            b_3, c_3 = third[TERMS - k] + twice * b_3 - c_3, b_3
        load[j] = eps[j] * math.sqrt(eps[j]) * (first[0] + x * b_1 - c_1)
        one[j] = eps[j] * (second[0] + x * b_2 - c_2)
        two[j] = eps[j] * (third[0] + x * b_3 - c_3)


@scalar
def _read_particle(panel, eps):
    """As `_read_particles`, at one squeeze."""
    apart()
    begin, end = panel[FROM], panel[UNTIL]
    if begin == 0:
        x = 2 * math.sqrt(eps / end) - 1
    else:
        x = 2 * math.log(eps / begin) / math.log(end / begin) - 1
    b_1, c_1, b_2, c_2, b_3, c_3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(TERMS - 1, 0, -1):
        b_1, c_1 = panel[OF_LOAD + k] + 2 * x * b_1 - c_1, b_1
        b_2, c_2 = panel[OF_AREA_1 + k] + 2 * x * b_2 - c_2, b_2
        b_3, c_3 = panel[OF_AREA_2 + k] + 2 * x * b_3 - c_3, b_3
    load = eps * math.sqrt(eps) * (panel[OF_LOAD] + x * b_1 - c_1)
    one, two = panel[OF_AREA_1] + x * b_2 - c_2, panel[OF_AREA_2] + x * b_3 - c_3
    return load, eps * one, eps * two


@scalar
def _settle_one(rule, values, series):
    """Coefficients of a series, and whether they end: its last two terms over its largest value."""
    apart()
    most = 0.0
    for j in range(TERMS):
        most = max(most, abs(values[j]))
    transform(rule, values, series)
    return abs(series[TERMS - 1]) + abs(series[TERMS - 2]) <= SETTLED * most


@scalar
def _settle(panel, room, rule):
    """Take series of load and areas from the rows of the room, at the places of a series."""
    apart()
    eps, load = room[AT, :TERMS], room[LOAD, :TERMS]
    one, two = room[AREA_1, :TERMS], room[AREA_2, :TERMS]
    for j in range(TERMS):
        load[j] /= eps[j] * math.sqrt(eps[j])
        one[j] /= eps[j]
        two[j] /= eps[j]
    good = _settle_one(rule, load, panel[OF_LOAD:OF_AREA_1])
    good &= _settle_one(rule, one, panel[OF_AREA_1:OF_AREA_2])
    good &= _settle_one(rule, two, panel[OF_AREA_2:PANEL])
    panel[SURE] = 1.0 if good else 0.0


@scalar
def settle(given, sides, panels, p, n, rule):
    """Series of load and areas on panel n, where they are smooth enough for one."""
    apart()
    panel, room = panels[p, n], panels[p, len(panels[p]) - ROOM :]
    panel[SURE] = 0.0
    if panel[HELD] != 0 and given[p, EQUAL] != 1:
        return
    panel[FROM], panel[UNTIL] = panel[EDGE], panel[TO]
    fill_places(rule[0, :TERMS], panel[EDGE], panel[TO], room[AT, :TERMS])
    fill_particles(given, sides, panels, p, n, TERMS)
    _settle(panel, room, rule)


@scalar
def _fill_both(sides, p, panel, first, second, room):
    """Loads and areas of both sides at their indentations: into two rows each."""
    wide = len(first)
    passing = room[PASSING : PASSING + 2, :wide]
    fill_side(sides, 2 * p, panel[FORM_1], first, room[LOAD, :wide], room[AREA_1, :wide], passing)
    fill_side(
        sides, 2 * p + 1, panel[FORM_2], second, room[OTHER, :wide], room[AREA_2, :wide], passing
    )


@exact
def _find_rest(eps, first, second):
    for j in range(len(eps)):
        second[j] = eps[j] - first[j]


@exact
def _find_off(load, other, off):
    """How far the loads of both sides are apart; the largest of them."""
    worst = 0.0
    for j in range(len(load)):
        off[j] = other[j] / load[j] - 1
        worst = max(worst, abs(off[j]))
    return worst


@exact
def _step_aside(off, first, second, near, rest):
    """Indentations a step further, by the law of a sphere."""
    for j in range(len(off)):
        step = off[j] / (1.3 / first[j] + 1.3 / second[j])
        near[j], rest[j] = first[j] + step, second[j] - step


@exact
def _follow(off, near_load, near_other, part):
    """Part of the way to what is near at which both loads are equal."""
    for j in range(len(off)):
        far = off[j] - (near_other[j] / near_load[j] - 1)
        part[j] = off[j] / far if abs(off[j]) > BALANCED else 0.0


@exact
def _mix(part, near, value):
    for j in range(len(part)):
        value[j] += part[j] * (near[j] - value[j])


@exact
def _take_weaker(first, second, other, load):
    for j in range(len(load)):
        load[j] = load[j] if first[j] > second[j] else other[j]


@scalar
def _fill_unlike(sides, panel, p, room, wide):
    """As `fill_particles`, between two different sides."""
    apart()
    passing = room[PASSING : PASSING + 2, :wide]
    eps, first, second = room[AT, :wide], room[FIRST, :wide], room[SECOND, :wide]
    load, other, off = room[LOAD, :wide], room[OTHER, :wide], room[OFF, :wide]
    one, two = room[AREA_1, :wide], room[AREA_2, :wide]
    near, near_1 = room[NEAR, :wide], room[NEAR_1, :wide]
    near_other, near_2 = room[NEAR_OTHER, :wide], room[NEAR_2, :wide]
    aside, rest = room[LEAST, :wide], room[MOST, :wide]
    _read_shares(panel, eps, first)
    for n in range(3):
        _find_rest(eps, first, second)
        _fill_both(sides, p, panel, first, second, room)
        worst = _find_off(load, other, off)
        if worst <= BALANCED:
            break
        _step_aside(off, first, second, aside, rest)
        fill_side(sides, 2 * p, panel[FORM_1], aside, near, near_1, passing)
        fill_side(sides, 2 * p + 1, panel[FORM_2], rest, near_other, near_2, passing)
        _follow(off, near, near_other, off)
        _mix(off, aside, first)
        if worst <= NEARBY or n == 2:
            # along the line to a point that is closer, with an error of its square
            _mix(off, near, load)
            _mix(off, near_other, other)
            _mix(off, near_1, one)
            _mix(off, near_2, two)
            break
    _find_rest(eps, first, second)
    _take_weaker(first, second, other, load)


@scalar
def fill_particles(given, sides, panels, p, n, count):
    """As `particle_at`, at so many ε in the row `AT` of the room behind the panels of part p.

    Into the rows `LOAD`, `AREA_1` and `AREA_2` there.
    """
    apart()
    wide, panel, room = padded(count), panels[p, n], panels[p, len(panels[p]) - ROOM :]
    eps, first = room[AT, :wide], room[FIRST, :wide]
    for j in range(count, wide):
        eps[j] = eps[count - 1]
    if panel[SURE] == 1:
        _read_particles(
            panel, eps, room[LOAD, :wide], room[AREA_1, :wide], room[AREA_2, :wide]
        )  # fmt: skip
    elif given[p, EQUAL] == 1:
        for j in range(wide):
            first[j] = 0.5 * eps[j]
        fill_side(
            sides, 2 * p, panel[FORM_1], first, room[LOAD, :wide], room[AREA_1, :wide],
            room[PASSING : PASSING + 2, :wide],
        )  # fmt: skip
        for j in range(wide):
            room[AREA_2, j] = room[AREA_1, j]
    elif panel[HELD] != 0:
        for j in range(count):
            room[LOAD, j], room[AREA_1, j], room[AREA_2, j] = particle_at(
                given, sides, panels, p, n, eps[j]
            )
    else:
        _fill_unlike(sides, panel, p, room, wide)


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


@exact
def fill_places(places, begin, end, eps):
    """Squeezes at the places of a series on a panel."""
    if begin > 0:
        half = 0.5 * math.log(end / begin)
        for j in range(len(eps)):
            eps[j] = begin * exp(half * (places[j] + 1))
    else:
        for j in range(len(eps)):
            eps[j] = 0.25 * end * (places[j] + 1) ** 2


@summed
def transform(rule, values, series):
    """Coefficients of the series that has these values at its places."""
    for k in range(len(series)):
        total = 0.0
        for j in range(len(series)):
            total += rule[1 + k, j] * values[j]
        series[k] = total


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
    _find_rest(eps, first, second)
    _fill_both(sides, p, panel, first, second, room)
    worst = _find_off(load, other, off)
    _follow(off, room[NEAR, :wide], room[NEAR_OTHER, :wide], off)
    _mix(off, room[OLD, :wide], first)
    for j in range(TERMS):
        room[LEAST, j] = first[j] / eps[j]
    transform(rule, room[LEAST, :TERMS], panel[SHARE : SHARE + TERMS])
    if worst <= NEARBY:
        _mix(off, room[NEAR, :wide], load)
        _mix(off, room[NEAR_OTHER, :wide], other)
        _mix(off, room[NEAR_1, :wide], room[AREA_1, :wide])
        _mix(off, room[NEAR_2, :wide], room[AREA_2, :wide])
        _find_rest(eps, first, second)
        _take_weaker(first, second, other, load)
        _settle(panel, room, rule)


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
        _find_rest(eps, first, second)
        _fill_both(sides, p, panel, first, second, room)
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
        tail = abs(panels[p, n, SHARE + TERMS - 1]) + abs(panels[p, n, SHARE + TERMS - 2])
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
