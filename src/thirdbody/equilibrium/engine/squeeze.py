"""One particle of unit size between two sides, as panels of its squeeze ε, once a state."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    CLOSE,
    EDGE,
    FORM_1,
    HELD,
    LAST_1,
    LAST_2,
    MOST_PANELS,
    ONE,
    REGIME,
    ROOM,
    SHARE,
    SURE,
    TO,
    UNTIL,
)
from .densities import scale_of
from .fields import (
    BREAKS,
    COUNT,
    EQUAL,
    FOOTPRINT,
    HIGH,
    JUMPS,
    KIND,
    KINKS,
    LIMIT,
    ONE_SIZE,
    PLANE,
    PRINTED,
    PROJECTED,
    SEAT,
    SHADOW,
    TIP,
    WIDTH,
)
from .shares import (
    fill_particles,
    first_at,
    inverse,
    loads_at_kink,
    note_jumps,
    note_loads,
    particle_at,
    settle,
    share_out,
)
from .sides import (
    EARLIEST,
    chord,
    is_alike,
    is_split,
    narrow_ends,
    prepare,
    regime_of,
    scalar,
    side_at,
)
from .vectors import ANY, VECTOR, formula_of

__all__ = ["are_twins", "copy_panels", "lay_panels", "spread_of"]

RATIO, FARTHEST = 4.0, 128.0
"""Of the ends of a panel, at most: from the onset, where formulas are not smooth, it is so far; of
one of the law alone, whose cube root is the variable there."""
DEEPEST, SAME_AREA = 1e3, 1e-5
PART = 0.2
"""Of the width of the sizes or the seat over which most of a load is carried, at least."""


@scalar
def _lay(panels, p, count, eps, one):
    """Note an end of panels, in increasing order, equal ones once, and where side 1 is there."""
    keep_apart()
    place = count
    while place > 0 and panels[p, place - 1, EDGE] > eps:
        place -= 1
    if place > 0 and panels[p, place - 1, EDGE] >= eps * (1 - 1e-13):
        return count
    for j in range(count, place, -1):
        panels[p, j, EDGE], panels[p, j, ONE] = panels[p, j - 1, EDGE], panels[p, j - 1, ONE]
    panels[p, place, EDGE], panels[p, place, ONE] = eps, one
    return count + 1


@scalar
def _kinks(given, sides, panels, p):
    """Kinks in ε as ends of panels after 0; how many ends."""
    keep_apart()
    panels[p, 0, EDGE] = panels[p, 0, ONE] = 0.0
    count = 1 + int(panels[p, 0, EDGE])  # no constant, for which numba would compile twice
    equal = given[p, EQUAL] == 1
    all_splits = given[p, BREAKS] == 1 or not equal
    for i in range(1 if equal else 2):
        own, other = 2 * p + i, 2 * p + 1 - i
        stronger = sides[own, LIMIT] - sides[other, LIMIT] > (2 * i - 1) * CLOSE * sides[own, LIMIT]
        for k in range(int(sides[own, COUNT])):
            delta = sides[own, KINKS + k]
            # two panels whose variable is that of the table do with few nodes
            one = abs(delta - EARLIEST * sides[own, TIP]) < 1e-13
            # the weaker side has its own, where it is squeezed as far
            if is_split(sides, own, delta) and (
                (stronger and not equal) or not (one or all_splits)
            ):
                continue
            if equal:
                count = _lay(panels, p, count, 2 * delta, delta)
                continue
            below, at = loads_at_kink(sides, own, k)
            limit = sides[other, LIMIT]
            for n in range(1 if at <= below else 2):
                load = below if n == 0 else at
                if load < limit * (1 + CLOSE):
                    rest = sides[other, KINKS + int(sides[other, COUNT]) - 1]
                    if load < limit * (1 - CLOSE):
                        rest = inverse(sides, other, load)
                    count = _lay(panels, p, count, delta + rest, delta if i == 0 else rest)
    return count


@scalar
def _which(given, sides, panels, p, n, eps):
    """Difference of the areas on both surfaces over the larger."""
    _, one, two = particle_at(given, sides, panels, p, n, eps)
    return (one - two) / max(one, two)


@scalar
def _crossing(given, sides, panels, p, n, low, high):
    """ε on panel n between two at which the areas on both surfaces are equal, by chords."""
    keep_apart()
    f_low = _which(given, sides, panels, p, n, low)
    f_high, last = _which(given, sides, panels, p, n, high), 0
    sign = 1.0 if f_high > 0 else -1.0
    f_low, f_high = sign * f_low, sign * f_high
    for step in range(100):
        if high - low <= 1e-15 * high or f_low >= 0 or f_high <= 0:
            break
        eps = chord(low, f_low, high, f_high, step)
        f = sign * _which(given, sides, panels, p, n, eps)
        if abs(f) <= 1e-13:
            return eps
        low, f_low, high, f_high, last = narrow_ends(low, f_low, high, f_high, last, eps, f)
    return 0.5 * (low + high)


@scalar
def _cut_at_crossings(given, sides, panels, p, count):
    """Panels cut where the larger of the two areas changes, if it counts; their number."""
    keep_apart()
    if given[p, SHADOW] != FOOTPRINT and given[p, SHADOW] != PROJECTED:
        return count
    n, room = int(panels[p, 0, EDGE]), panels[p, len(panels[p]) - ROOM :]  # 0, and no constant
    while n < count and count < MOST_PANELS - 2:
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        before, place = 0.0, a
        for j in range(VECTOR):
            room[AT, j] = a + (b - a) * (1e-4 + (1 - 2e-4) / (VECTOR - 1) * j)
        fill_particles(given, sides, panels, p, n, VECTOR)
        for j in range(VECTOR):
            eps, one, two = room[AT, j], room[AREA_1, j], room[AREA_2, j]
            sign = 0.0
            if abs(one - two) > 1e-11 * max(one, two):
                sign = 1.0 if one > two else -1.0
            if sign * before < 0:
                at = _crossing(given, sides, panels, p, n, place, eps)
                for m in range(count, n, -1):
                    for k in range(panels.shape[2]):
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
    keep_apart()
    if sides[i, LIMIT] <= load * (1 + CLOSE):
        return side_at(sides, i, 2 * sides[i, KINKS + int(sides[i, COUNT]) - 1])[1]
    last = side_at(sides, i, inverse(sides, i, load))[1]
    if sides[i, JUMPS] > 0 and abs(last - area) > SAME_AREA * area:
        return area  # the last load lies on a jump: this is its other side
    return last


@scalar
def _note_last(given, sides, panels, p, count):
    """Write down what all that is squeezed beyond the last panel has in common."""
    keep_apart()
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
def _farthest(given, sides, p, a):
    """Ratio of the ends of a panel that begins at a, at most."""
    keep_apart()
    if given[p, EQUAL] != 1 or given[p, BREAKS] == 1:
        return RATIO
    formula = formula_of(sides, 2 * p, 0.5 * a * (1 + 1e-6))
    return RATIO if formula == ANY else FARTHEST


@scalar
def _cut_far(given, sides, panels, p, count):
    """Ends of panels with more between those that lie far apart; how many, or −1."""
    keep_apart()
    known = count
    for k in range(1, known - 1):  # cut those whose ends lie far apart
        a, b = panels[p, known - 1 - k, EDGE], panels[p, known - k, EDGE]
        parts = math.ceil(math.log(b / a) / math.log(_farthest(given, sides, p, a)) - 1e-9)
        if count + parts >= MOST_PANELS - 2:
            return -1
        step = (b / a) ** (1.0 / parts) if parts > 1 else 1.0
        for _ in range(parts - 1):
            a *= step
            count = _lay(panels, p, count, a, -1.0)
    return count


@scalar
def spread_of(parts, p):
    """Part of a squeeze over which most of a load of part p is carried, at least."""
    if parts[p, SEAT] == PLANE and parts[p, KIND] == ONE_SIZE:
        return 0.0  # what is squeezed is squeezed alike
    return PART * max(parts[p, WIDTH], scale_of(parts, p, parts[p, HIGH])) / parts[p, HIGH]


@scalar
def are_twins(parts, sides, p, q):
    """Whether particles of two parts with these sides carry the same at each squeeze."""
    if parts[p, SEAT] == PRINTED or parts[p, BREAKS] == 1 or parts[q, BREAKS] == 1:
        return False
    if parts[p, SEAT] != parts[q, SEAT] or parts[p, SHADOW] != parts[q, SHADOW]:
        return False
    if parts[p, EQUAL] != parts[q, EQUAL]:
        return False
    return is_alike(sides[2 * p], sides[2 * q]) and is_alike(sides[2 * p + 1], sides[2 * q + 1])


@scalar
def copy_panels(sides, panels, count, q, p):
    """Take the sides and panels of part q for part p."""
    for i in range(2):
        for k in range(sides.shape[1]):
            sides[2 * p + i, k] = sides[2 * q + i, k]
    for n in range(count + 1):
        for k in range(panels.shape[2]):
            panels[p, n, k] = panels[q, n, k]


@scalar
def lay_panels(given, sides, panels, p, rule, spread):
    """Lay the panels of part p; how many, or −1 where the formulas do not cover it.

    ``spread`` is that of the part, or the least of several that share their panels.
    """
    keep_apart()
    if not prepare(sides, 2 * p):
        return -1
    equal, worst = given[p, EQUAL] == 1, 0.0
    if not equal and not prepare(sides, 2 * p + 1):
        return -1
    note_jumps(sides, 2 * p)
    if not equal:
        note_jumps(sides, 2 * p + 1)
        note_loads(sides, 2 * p)
        note_loads(sides, 2 * p + 1)
    count = _kinks(given, sides, panels, p)
    if count < 2 or panels[p, count - 1, EDGE] > DEEPEST:
        return -1
    count = _cut_far(given, sides, panels, p, count)
    if count < 0:
        return -1
    for n in range(count - 1):
        panels[p, n, TO], panels[p, n, UNTIL] = panels[p, n + 1, EDGE], 0.0
    count -= 1
    if not equal:
        count, worst = share_out(sides, panels, p, count, rule, spread)
        count = _cut_at_crossings(given, sides, panels, p, count)
    for n in range(count):
        eps = 0.5 * (panels[p, n, EDGE] + panels[p, n, TO])
        one = 0.5 * eps if equal else first_at(panels, p, n, eps)
        panels[p, n, REGIME] = regime_of(sides, 2 * p, one)
        if equal:
            panels[p, n, FORM_1] = formula_of(sides, 2 * p, one)
            panels[p, n, SURE] = 0.0
            if panels[p, n, FORM_1] == ANY and given[p, SEAT] == PLANE:
                settle(given, sides, panels, p, n, rule)
    _note_last(given, sides, panels, p, count)
    panels[p, count, SHARE] = 0.0 if equal else worst
    return count
