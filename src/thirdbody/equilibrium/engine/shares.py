"""How two different sides share a squeeze, as series on panels of it."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
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
    NEGLIGIBLE,
    OFF,
    OLD,
    OLD_OFF,
    ONE,
    OTHER,
    PASSING,
    PASSING_2,
    ROOM,
    SECOND,
    SETTLED,
    SHARE,
    SLOPE,
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
    read_particle,
    read_particles,
    read_shares,
    settle_rows,
    share_at,
    take_weaker,
    transform,
)
from .fields import (
    CEB,
    CODE,
    COUNT,
    EQUAL,
    JG,
    JUMPS,
    KINKS,
    LIMIT,
    LOADS,
    MOST_JUMPS,
)
from .sides import exact, scalar, side_at
from .vectors import exp, fill_side, formula_of, ln, padded_length


@scalar
def note_jumps(sides, i):
    """Write down where the load of a side jumps."""
    keep_apart()
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
    keep_apart()
    for k in range(int(sides[i, COUNT])):
        sides[i, LOADS + k] = side_at(sides, i, sides[i, KINKS + k])[0]


@scalar
def loads_at_kink(sides, i, k):
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
    keep_apart()
    count = int(sides[i, COUNT])
    n = count - count  # no constant, for which numba would compile twice
    below = at = 0.0
    while n < count:
        below, at = loads_at_kink(sides, i, n)
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
        f_low = math.log(loads_at_kink(sides, i, n - 1)[1] / load)
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
def split(sides, i, eps, low, high):
    """Indentation over x of side i at a squeeze ε, between two; side i + 1 takes the rest.

    By secants inside the bracket; the first slope is that of a load which grows like a power of
    the indentation.
    """
    keep_apart()
    delta = 0.5 * (low + high)
    old = old_f = math.nan
    slope = 1.3 / delta + 1.3 / max(eps - delta, 1e-300)
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
        elif abs(delta - old) < 2e-16 * delta:
            break
    return delta


@scalar
def _holding_place(sides, p, eps):
    """As `HELD`: where a jump up of its load holds a side at a squeeze ε, or 0."""
    keep_apart()
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
def _indentation_range(sides, p, eps):
    """Between which indentations side 1 is at ε.

    A side whose load falls at a jump lets go where loading first reaches it.
    """
    keep_apart()
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
def _guess(eps, a, b, low, high, first):
    """Indentations of side 1 by a power between two known ones."""
    if a > 0:
        power = math.log(high / low) / math.log(b / a)
        for j in range(len(eps)):
            first[j] = low * exp(power * ln(eps[j] / a))
    else:
        for j in range(len(eps)):
            first[j] = high * eps[j] / b


@exact
def _set_bounds(eps, a, b, low, high, first, least, most):
    """Between which indentations side 1 must be, and what is guessed of it there."""
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
    """One step inside the bracket, of ln of the loads.

    With slopes (``weight`` 0), or where they can be had, by secants (1).
    """
    for j in range(len(first)):
        f, now = ln(load[j] / other[j]), first[j]
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


@exact
def _keep(room, wide):
    """Loads and areas of the step before."""
    for j in range(wide):
        room[NEAR, j], room[NEAR_1, j] = room[LOAD, j], room[AREA_1, j]
        room[NEAR_OTHER, j], room[NEAR_2, j] = room[OTHER, j], room[AREA_2, j]


@scalar
def _find_shares(sides, p, panel, room, wide):
    """Indentations, loads and areas at the places of a series; whether they could be found.

    The last step is along the line through the two before, with an error of the square of the
    distance that is left.
    """
    keep_apart()
    eps, first, second = room[AT, :wide], room[FIRST, :wide], room[SECOND, :wide]
    load, other, off = room[LOAD, :wide], room[OTHER, :wide], room[OFF, :wide]
    slope, least, most, old = (
        room[SLOPE, :wide],
        room[LEAST, :wide],
        room[MOST, :wide],
        room[OLD, :wide],
    )
    for step in range(TRIES):
        _keep(room, wide)
        find_rest(eps, first, second)
        fill_both(sides, p, panel, first, second, room)
        if step == 0:
            _find_rates(first, second, load, other, slope)
        worst = find_off(load, other, first, second, slope, off)
        if worst == 0:
            return True
        if step > 0 and worst <= NEARBY:
            follow(off, room[NEAR, :wide], room[NEAR_OTHER, :wide], off)
            for value, near in ((FIRST, OLD), (LOAD, NEAR), (OTHER, NEAR_OTHER)):
                mix(off, room[near, :wide], room[value, :wide])
            mix(off, room[NEAR_1, :wide], room[AREA_1, :wide])
            mix(off, room[NEAR_2, :wide], room[AREA_2, :wide])
            find_rest(eps, first, second)
            return True
        _improve(load, other, slope, first, least, most, old, room[OLD_OFF, :wide], min(step, 1))
    return False


@scalar
def _fill_share(sides, panels, p, n, rule, a, b, low, high, free):
    """Series of the share of side 1, of load and areas on panel n; what they leave out, at most.

    The indentations of side 1 at two squeezes a and b around the panel are ``low`` and ``high``.
    Where ``free``, a side lets go.
    """
    keep_apart()
    panel, room = panels[p, n], panels[p, len(panels[p]) - ROOM :]
    begin, end, wide = panel[EDGE], panel[TO], padded_length(TERMS)
    eps, first, second = room[AT, :wide], room[FIRST, :wide], room[SECOND, :wide]
    places, least, most = room[SLOPE, :wide], room[LEAST, :wide], room[MOST, :wide]
    for j in range(wide):
        places[j] = rule[0, min(j, TERMS - 1)]
    fill_places(places, begin, end, eps)
    if panel[UNTIL] > 0:  # a part of a panel that has one
        read_shares(panel, eps, first)
    else:
        _guess(eps, a, b, low, high, first)
    _set_bounds(eps, a, b, low, high, first, least, most)
    for j in range(wide):  # of no step before: nothing of another state
        room[OLD, j], room[OLD_OFF, j] = first[j], 0.0
    middle = TERMS // 2
    panel[FORM_1] = formula_of(sides, 2 * p, first[middle])
    panel[FORM_2] = formula_of(sides, 2 * p + 1, eps[middle] - first[middle])
    panel[FROM], panel[UNTIL], panel[SURE] = begin, end, 1.0
    if free or not _find_shares(sides, p, panel, room, wide):
        _set_bounds(eps, a, b, low, high, first, least, most)
        for j in range(TERMS):
            if free:
                least[j], most[j] = _indentation_range(sides, p, eps[j])
            first[j] = split(sides, 2 * p, eps[j], least[j], most[j])
        for j in range(TERMS, wide):
            first[j] = first[TERMS - 1]
        panel[FORM_1] = formula_of(sides, 2 * p, first[middle])
        panel[FORM_2] = formula_of(sides, 2 * p + 1, eps[middle] - first[middle])
        find_rest(eps, first, second)
        fill_both(sides, p, panel, first, second, room)
    take_weaker(first, second, room[OTHER, :wide], room[LOAD, :wide])
    for j in range(TERMS):
        room[LEAST, j] = first[j] / eps[j]
    transform(rule, room[LEAST, :TERMS], panel[SHARE : SHARE + TERMS])
    return settle_rows(panel, room, rule)


@scalar
def share_out(sides, panels, p, count, rule, spread):
    """Fill the series on every panel, halved where they do not end.

    How many panels there are then, and what all series leave out, each over the part that its
    panel is of what is squeezed at a separation, which ``spread`` is the least of.
    """
    keep_apart()
    n, left, free = int(panels[p, 0, EDGE]), 0.0, _lets_go(sides, p)  # 0, and no constant
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
        panels[p, n, HELD] = _holding_place(sides, p, 0.5 * (a + b))
        if panels[p, n, HELD] != 0:
            n += 1
            continue
        tail = _fill_share(sides, panels, p, n, rule, begin, end, low, high, free)
        part = min((b - a) / spread, 1.0)
        if tail > SETTLED and tail * part > NEGLIGIBLE and count < MOST_PANELS - 2:
            for m in range(count + 1, n, -1):
                for k in range(SHARE + TERMS):
                    panels[p, m, k] = panels[p, m - 1, k]
                panels[p, m, ONE] = panels[p, m - 1, ONE]
            panels[p, n, TO] = panels[p, n + 1, EDGE] = math.sqrt(a * b) if a > 0 else 0.25 * b
            panels[p, n + 1, ONE] = -1.0
            count += 1
            continue
        left += tail * part
        n += 1
    return count, left


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
    keep_apart()
    if panels[p, n, SURE] == 1:
        return read_particle(panels[p, n], eps)
    if given[p, EQUAL] == 1:
        load, area = side_at(sides, 2 * p, 0.5 * eps)
        return load, area, area
    held = panels[p, n, HELD]
    one = held if held > 0 else eps + held
    load, first = side_at(sides, 2 * p, one)
    other, second = side_at(sides, 2 * p + 1, eps - one)
    return other if held > 0 else load, first, second


@scalar
def fill_particles(given, sides, panels, p, n, count):
    """As `particle_at`, at so many ε in the row `AT` of the room behind the panels of part p.

    Into the rows `LOAD`, `AREA_1` and `AREA_2` there.
    """
    keep_apart()
    wide, panel, room = padded_length(count), panels[p, n], panels[p, len(panels[p]) - ROOM :]
    eps, first = room[AT, :wide], room[FIRST, :wide]
    for j in range(count, wide):
        eps[j] = eps[count - 1]
    if panel[SURE] == 1:
        read_particles(
            panel, eps, room[LOAD, :wide], room[AREA_1, :wide], room[AREA_2, :wide]
        )  # fmt: skip
    elif given[p, EQUAL] == 1:
        for j in range(wide):
            first[j] = 0.5 * eps[j]
        fill_side(
            sides, 2 * p, panel[FORM_1], first, room[LOAD, :wide], room[AREA_1, :wide],
            room[PASSING, :wide], room[PASSING_2, :wide],
        )  # fmt: skip
        for j in range(wide):
            room[AREA_2, j] = room[AREA_1, j]
    else:
        for j in range(count):
            room[LOAD, j], room[AREA_1, j], room[AREA_2, j] = particle_at(
                given, sides, panels, p, n, eps[j]
            )


@scalar
def settle(given, sides, panels, p, n, rule):
    """Series of load and areas on panel n between equal sides, where they are smooth enough."""
    keep_apart()
    panel, room = panels[p, n], panels[p, len(panels[p]) - ROOM :]
    panel[SURE] = 0.0
    panel[FROM], panel[UNTIL] = panel[EDGE], panel[TO]
    fill_places(rule[0, :TERMS], panel[EDGE], panel[TO], room[AT, :TERMS])
    fill_particles(given, sides, panels, p, n, TERMS)
    panel[SURE] = 1.0 if settle_rows(panel, room, rule) <= SETTLED else 0.0
