"""Particles that break: the largest tension that each has met, and how many are whole.

What is sought of a state is made once: ln of the tension on every panel of the squeeze, then the
number of whole particles and pieces at every node of squeeze and size. The formulas stand with
`Tension` and `BrokenAverage`.
"""

from __future__ import annotations

import math

from ..compiled.machine import exp, keep_apart
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    CLOSE,
    EDGE,
    KINKED,
    LOAD,
    MOST_PANELS,
    PANEL,
    PULLED,
    RATE,
    ROOM,
    START,
    TENSION,
    TERMS,
    TO,
    fill_places,
    transform,
)
from .densities import density
from .fields import (
    EQUAL,
    EXPONENT,
    HIGH,
    KEPT,
    LEAST,
    LN_STRENGTH,
    LOW,
    MODULUS,
    RATIO,
    SIZE_1,
    UNBROKEN,
)
from .shares import fill_particles, particle_at
from .sides import chord, exact, narrow_ends, scalar

__all__ = ["is_held", "lay_tension", "lay_whole", "mark_sizes"]

SMALL, CONFINED, BENDS, PIECES = range(4)
"""First row of what is known of G: tension of small caps, whether surfaces confine the particle,
numbers of bends and of pieces of its series; the bends are the next row."""
FIRST_PIECE, BEGIN, END, COEFFICIENTS = 2, 0, 1, 2
K_FACTOR = 4
SAMPLES, CLOSER, SEARCHED, RESOLVED = 32, 14, 60, 1e-10
FALLS = 2e-10
"""Part of σ_t by which it must fall to be held: more than its series are off."""
STEEP = 6.0
GENERATIONS = 40
NEGLIGIBLE = 1e-15
NEVER, SAFE, SURELY = -600.0, -36.5, 6.5
"""ln of the hazard: the least that is evaluated; below which nothing breaks, to rounding; and from
which on nothing is whole."""


@scalar
def confined_tension(inside, s):
    """G: the largest tension over that of small caps under the same load, of a cap s."""
    keep_apart()
    q = s * s
    c = math.sqrt(max(1 - q, 0.0))
    centre = 4 / math.pi * (1.25 * inside[0, K_FACTOR] * c - 1 / (1 + c))
    n, last = FIRST_PIECE, FIRST_PIECE + int(inside[0, PIECES]) - 1
    while n < last and q > inside[n, END]:
        n += 1
    low, high = inside[n, BEGIN], inside[n, END]
    x = (2 * q - low - high) / (high - low)
    b, d = 0.0, 0.0
    for k in range(inside.shape[1] - 1, COEFFICIENTS, -1):
        b, d = inside[n, k] + 2 * x * b - d, b
    equator = inside[n, COEFFICIENTS] + x * b - d
    return max(centre, equator, 0.0) / inside[0, SMALL]


@scalar
def cap_of(area):
    return min(2 * math.sqrt(area / math.pi), 1.0)


@scalar
def fill_tensions(given, sides, panels, p, n, count, inside):
    """σ_t of a particle on panel n [Pa], as `fill_particles`, in place of its load."""
    keep_apart()
    fill_particles(given, sides, panels, p, n, count)
    if inside[0, CONFINED] == 0:
        return
    room = panels[p, len(panels[p]) - ROOM :]
    for j in range(count):
        first = second = confined_tension(inside, cap_of(room[AREA_1, j]))
        if given[p, EQUAL] != 1:
            second = confined_tension(inside, cap_of(room[AREA_2, j]))
        room[LOAD, j] *= 0.5 * (first + second)


@scalar
def _cut(panels, p, count, eps, kinked):
    """Cut the panel in which ε lies; how many panels there are then.

    Both parts keep the series of the tension on the whole, but for the first panel, whose variable
    is another. ``kinked`` says whether a formula changes there, of how many generations ago.
    """
    keep_apart()
    n = 0
    while n < count and panels[p, n, TO] < eps:
        n += 1
    if n == count or count >= MOST_PANELS - 2:
        return count
    a, b = panels[p, n, EDGE], panels[p, n, TO]
    if eps - a < 1e-12 * b or b - eps < 1e-12 * b:
        n -= eps - a < 1e-12 * b
        if n >= 0 and kinked > 0 and not 0 < panels[p, n, KINKED] <= kinked:
            panels[p, n, KINKED] = kinked
        return count
    for m in range(count + 1, n, -1):
        for k in range(PANEL):
            panels[p, m, k] = panels[p, m - 1, k]
    panels[p, n, TO] = panels[p, n + 1, EDGE] = eps
    panels[p, n, KINKED] = kinked
    if a == 0:
        panels[p, n, RATE] = panels[p, n + 1, RATE] = 0.0
    return count + 1


@scalar
def _cap_at(given, sides, panels, p, n, eps, side):
    """Cap on one side at ε on panel n."""
    keep_apart()
    found = particle_at(given, sides, panels, p, n, eps)
    return cap_of(found[1] if side == 0 else found[2])


@scalar
def _reaches(given, sides, panels, p, n, side, s, f_high):
    """ε on panel n at which the cap is s, which it exceeds by ``f_high`` at the end: by chords."""
    keep_apart()
    low, high = panels[p, n, EDGE], panels[p, n, TO]
    f_low = (_cap_at(given, sides, panels, p, n, low, side) if low > 0 else 0.0) - s
    last = 0
    for step in range(4 * SEARCHED):
        if high - low <= 1e-13 * high or f_high <= 0 or f_low >= 0:
            break
        eps = chord(low, f_low, high, f_high, step)
        f = _cap_at(given, sides, panels, p, n, eps, side) - s
        low, f_low, high, f_high, last = narrow_ends(low, f_low, high, f_high, last, eps, f)
        if 0 <= f < 1e-14:
            break
    return high


@scalar
def _cut_at_bends(given, sides, panels, p, count, inside):
    """Panels cut where a cap reaches a bend of G; their number."""
    keep_apart()
    for side in range(1 if given[p, EQUAL] == 1 else 2):
        n, k = int(panels[p, 0, EDGE]), 0  # 0, and no constant
        while n < count and k < int(inside[0, BENDS]):
            s = inside[1, k]
            beyond = _cap_at(given, sides, panels, p, n, panels[p, n, TO], side) - s
            if beyond < 0:
                n += 1
                continue
            eps = _reaches(given, sides, panels, p, n, side, s, beyond)
            count = _cut(panels, p, count, eps, 1.0)
            k += 1
    return count


@scalar
def _place_on(panels, p, n, eps):
    """Variable of the series on panel n."""
    if panels[p, n, EDGE] == 0:
        return 2 * math.sqrt(eps / panels[p, n, TO]) - 1
    return panels[p, n, RATE] * math.log(eps) + panels[p, n, START]


@scalar
def _sum_series(panels, p, n, x):
    """Sum of the series on panel n."""
    keep_apart()
    b, c = 0.0, 0.0
    for k in range(TERMS - 1, 0, -1):
        b, c = panels[p, n, TENSION + k] + 2 * x * b - c, b
    return panels[p, n, TENSION] + x * b - c


@scalar
def _pull_at(panels, p, n, eps):
    """σ_t at ε on panel n, by its series."""
    return eps * math.sqrt(eps) * _sum_series(panels, p, n, _place_on(panels, p, n, eps))


@scalar
def _fill_tension(given, sides, panels, p, n, rule, inside):
    """Series of σ_t/ε^1.5 on panel n; the size of its last two terms over its own."""
    keep_apart()
    first, last, most = panels[p, n, EDGE], panels[p, n, TO], 0.0
    panels[p, n, RATE] = 1.0
    if first > 0:
        low = math.log(first)
        panels[p, n, RATE] = 2 / (math.log(last) - low)
        panels[p, n, START] = -panels[p, n, RATE] * low - 1
    room, series = panels[p, len(panels[p]) - ROOM :], panels[p, n, TENSION : TENSION + TERMS]
    eps, found = room[AT, :TERMS], room[LOAD, :TERMS]
    fill_places(rule[0, :TERMS], first, last, eps)
    fill_tensions(given, sides, panels, p, n, TERMS, inside)
    for j in range(TERMS):
        found[j] /= eps[j] * math.sqrt(eps[j])
        most = max(most, found[j])
    transform(rule, found, series)
    tail = abs(panels[p, n, TENSION + TERMS - 1]) + abs(panels[p, n, TENSION + TERMS - 2])
    return tail / most if most > 0 else 0.0


@scalar
def _take_logarithm(panels, p, n, rule):
    """Series of ln(σ_t/ε^1.5) on panel n in place of that of σ_t/ε^1.5."""
    keep_apart()
    found = panels[p, len(panels[p]) - 1, :TERMS]  # room behind the panels
    for j in range(TERMS):
        found[j] = math.log(max(_sum_series(panels, p, n, rule[0, j]), 1e-300))
    transform(rule, found, panels[p, n, TENSION : TENSION + TERMS])


@scalar
def _fill(given, sides, panels, p, count, rule, inside):
    """Fill in the series on every panel without one, halved until they are resolved.

    How many panels there are then, or −1 where there is no room.
    """
    keep_apart()
    step = 2 ** min(1.0, STEEP / given[p, MODULUS])
    n = int(panels[p, 0, EDGE])  # 0, and no constant
    while n < count:
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        if panels[p, n, RATE] != 0:
            n += 1
            continue
        wide = a > 0 and b > step * a * (1 + 1e-9)
        tail = 0.0
        if not wide:
            tail = _fill_tension(given, sides, panels, p, n, rule, inside)
        if (wide or tail > RESOLVED) and b > a * (1 + 1e-6):
            if count >= MOST_PANELS - 3:
                return -1
            count = _cut(panels, p, count, math.sqrt(a * b) if a > 0 else 0.25 * b, 0.0)
            panels[p, n, RATE] = panels[p, n + 1, RATE] = 0.0
            continue
        n += 1
    return count


@scalar
def _peak(panels, p, n, low, high):
    """ε between two at which the tension is largest, by golden sections."""
    keep_apart()
    part = 0.5 * (math.sqrt(5.0) - 1)
    a, b = high - part * (high - low), low + part * (high - low)
    f_a, f_b = _pull_at(panels, p, n, a), _pull_at(panels, p, n, b)
    for _ in range(SEARCHED):
        if high - low <= 1e-10 * high:
            break
        if f_a >= f_b:
            high, b, f_b = b, a, f_a
            a = high - part * (high - low)
            f_a = _pull_at(panels, p, n, a)
        else:
            low, a, f_a = a, b, f_b
            b = low + part * (high - low)
            f_b = _pull_at(panels, p, n, b)
    return 0.5 * (low + high)


@scalar
def _find_held(given, sides, panels, p, count, rule, inside):
    """Panels cut where the tension begins to fall and where it is met again; their number.

    By its series; −1 where there is no room.
    """
    keep_apart()
    n, most = int(panels[p, 0, EDGE]), 0.0  # 0, and no constant
    while n < count:
        if panels[p, n, RATE] == 0:
            count = _fill(given, sides, panels, p, count, rule, inside)
            if count < 0:
                return -1
        a, b = panels[p, n, EDGE], panels[p, n, TO]
        begin = _pull_at(panels, p, n, a + 1e-9 * (b - a))
        held, cut = begin < most * (1 - FALLS), False
        panels[p, n, PULLED] = most if held else 0.0
        before, last, best = a, a, begin
        for j in range(SAMPLES + CLOSER + 1):
            u = (j + 0.5) / SAMPLES
            if j >= SAMPLES:  # before a kink it may fall a little
                u = 1.0 if j == SAMPLES + CLOSER else 1 - 0.25 / SAMPLES * 0.5 ** (j - SAMPLES)
            eps = a + (b - a) * (u * u if a == 0 else u)
            value = _pull_at(panels, p, n, eps)
            if held and value > most:
                low, high = last, eps
                for _ in range(SEARCHED):
                    eps = 0.5 * (low + high)
                    if _pull_at(panels, p, n, eps) > most:
                        high = eps
                    else:
                        low = eps
                cut = high - a > 1e-12 * b and b - high > 1e-12 * b
                count = _cut(panels, p, count, high, 1.0)
                break
            if not held and value < best * (1 - FALLS):
                top = _peak(panels, p, n, before, eps)
                best = max(best, _pull_at(panels, p, n, top))
                if top - a > 1e-6 * (b - a):
                    cut = b - top > 1e-12 * b
                    count = _cut(panels, p, count, top, 1.0)
                    break
                held, most = True, max(most, best)  # it falls from the beginning
                panels[p, n, PULLED] = most
            before, last, best = last, eps, max(best, value)
        if cut and panels[p, n, RATE] == 0:  # the first panel, whose series is to be made anew
            count = _fill(given, sides, panels, p, count, rule, inside)
            if count < 0:
                return -1
        if not held:
            most = max(most, best)
        n += 1
    return count


@scalar
def met_on(panels, p, n, eps):
    """ln σ̂ at ε on panel n."""
    keep_apart()
    if panels[p, n, PULLED] > 0:
        return panels[p, n, TENSION]
    return _sum_series(panels, p, n, _place_on(panels, p, n, eps)) + 1.5 * math.log(eps)


@scalar
def met(panels, p, count, eps):
    """ln σ̂ of a particle squeezed by ε > 0; constant behind the last panel."""
    keep_apart()
    low, high = 0, count - 1
    if eps >= panels[p, high, TO]:
        eps, low = panels[p, high, TO], high
    while low < high:
        middle = (low + high) // 2
        if panels[p, middle, TO] < eps:
            low = middle + 1
        else:
            high = middle
    return met_on(panels, p, low, eps)


@scalar
def is_held(given, panels, p, count, first, n):
    """Whether panel n is held by the tension that holds panel ``first``, and its parents too."""
    keep_apart()
    held = panels[p, first, PULLED]
    if held == 0 or panels[p, n, PULLED] != held:
        return False
    left = given[p, RATIO] * (1 - panels[p, first, EDGE])
    return given[p, KEPT] == 0 or met(panels, p, count, 1 - left) == met(panels, p, count, 1.0)


@scalar
def surviving_part(power):
    """exp(−exp(power))."""
    if power < -40:
        return 1.0
    return math.exp(-math.exp(power)) if power < 6.7 else 0.0


@scalar
def survival(given, p, x, log_met):
    """P_s of particles of size x that have met a tension."""
    keep_apart()
    if x <= given[p, UNBROKEN]:
        return 1.0
    return surviving_part(
        given[p, MODULUS] * (log_met - given[p, LN_STRENGTH] + given[p, EXPONENT] * math.log(x))
    )


@exact
def _follow(number, alive, gain, own):
    """Densities of what has arrived at a size, from those of its parents and what is whole."""
    keep_apart()
    for i in range(len(number)):
        number[i] = gain * (1 - alive[i]) * number[i] + own


@exact
def _survive(tension, level, alive):
    """Parts that are whole, of the logarithms of the hazard without the size."""
    keep_apart()
    for i in range(len(alive)):
        alive[i] = exp(-exp(min(max(tension[i] + level, NEVER), SURELY)))


@scalar
def _arrived_density(given, p, x, parents, until, log_met):
    """Density of what has arrived, and the part that is whole, of the parents of a size.

    From the oldest down to generation ``until`` above it, all of which have met one tension.
    """
    keep_apart()
    gain, number, alive = given[p, KEPT] * given[p, RATIO] ** -4, 0.0, 1.0
    for k in range(parents, until - 1, -1):
        y = x * given[p, RATIO] ** -k
        number *= gain * (1 - alive)
        if given[p, LOW] <= y <= given[p, HIGH]:
            number += density(given, p, y)
        alive = survival(given, p, y, log_met)
    return number, alive


@scalar
def parents_of(given, p, x):
    """How many generations of parents a size may have."""
    if given[p, KEPT] == 0:
        return 0
    return max(0, math.floor(math.log(x / given[p, HIGH]) / math.log(given[p, RATIO]) + 1e-12))


@scalar
def lay_whole(given, panels, p, count, squeezes, begin, end, sizes, first, last, shares, place):
    """Densities of whole particles at the nodes of ε and sizes; where they end, or −1.

    Those of every size at the nodes, then those squeezed beyond the last panel. In a gap, how far
    a parent was squeezed depends on the squeeze of its pieces alone: the tensions of all
    generations are found once, at the end of ``shares``, but for those that have met the largest.
    """
    keep_apart()
    ratio, m, edge = given[p, RATIO], given[p, MODULUS], panels[p, count - 1, TO]
    gain, wide, varied = given[p, KEPT] * ratio**-4, end - begin + 1, 0
    greatest, oldest = met(panels, p, count, 1.0), parents_of(given, p, given[p, LEAST]) + 1
    left = 1 - squeezes[0, begin]
    while varied < oldest and met(panels, p, count, 1 - left * ratio**varied) < greatest:
        varied += 1
    rows = len(shares) - (varied + 2) * wide  # of tensions; then numbers, and parts that are whole
    if place + (last - first) * wide > rows:
        return -1
    for k in range(varied):
        for i in range(begin, end + 1):
            left = 1 - squeezes[0, i] if i < end else 1 - edge
            found = met(panels, p, count, 1 - left * ratio**k)
            shares[rows + k * wide + i - begin] = m * found
    start, tail = len(shares) - 2 * wide, place + (last - first) * (wide - 1)
    # rows of their own, from zero: only then do loops over them become vectors
    number, alive = shares[start : start + wide], shares[start + wide : start + 2 * wide]
    for j in range(first, last):
        x = sizes[0, j]
        parents = parents_of(given, p, x)
        arrived, whole = _arrived_density(given, p, x, parents, varied, greatest)
        for i in range(wide):
            number[i], alive[i] = arrived, whole
        for k in range(min(parents, varied - 1), -1, -1):
            y = x * ratio**-k
            own = density(given, p, y) if given[p, LOW] <= y <= given[p, HIGH] else 0.0
            _follow(number, alive, gain, own)
            level = m * (given[p, EXPONENT] * math.log(y) - given[p, LN_STRENGTH])
            if y <= given[p, UNBROKEN] or m * greatest + level < SAFE:
                for i in range(wide):
                    alive[i] = 1.0
            else:
                _survive(shares[rows + k * wide : rows + (k + 1) * wide], level, alive)
        for i in range(wide - 1):
            shares[place + i] = number[i] * alive[i]
        shares[tail] = number[wide - 1] * alive[wide - 1]
        place += wide - 1
        tail += 1
    return tail


@scalar
def lay_tension(given, sides, panels, p, count, rule, inside):
    """Panels of part p with the tension on each; how many, or −1 where that does not reach."""
    keep_apart()
    last = panels[p, count - 1, TO]
    if last > 1 + CLOSE:
        return -1
    for n in range(count):
        panels[p, n, RATE] = panels[p, n, PULLED] = 0.0
        panels[p, n, KINKED] = 1.0
    count = _cut_at_bends(given, sides, panels, p, count, inside)
    count = _fill(given, sides, panels, p, count, rule, inside)
    if count > 0:
        count = _find_held(given, sides, panels, p, count, rule, inside)
    if count < 0:
        return -1
    # where parents of what is squeezed so reach a kink of theirs, and their parents
    ratio, n, most = given[p, RATIO], count - 1, _generations(given, p)
    while given[p, KEPT] > 0 and n >= 0:
        left, before, born = (1 - panels[p, n, TO]) / ratio, count, panels[p, n, KINKED]
        held = panels[p, n, PULLED]
        if held > 0 and (n == count - 1 or panels[p, n + 1, PULLED] == held):
            born = 0.0  # the largest tension does not change there
        if left < 1 - 1e-12 and 0 < born <= most:
            count = _cut(panels, p, count, 1 - left, born + 1)
        if count >= MOST_PANELS - 3:
            return -1
        n += count - before - 1
    count = _fill(given, sides, panels, p, count, rule, inside)
    if count < 0:
        return -1
    for n in range(count):
        if panels[p, n, PULLED] > 0:
            panels[p, n, TENSION] = math.log(panels[p, n, PULLED])
        else:
            _take_logarithm(panels, p, n, rule)
    _find_least(given, panels, p, count)
    return count


@scalar
def _generations(given, p):
    """How many generations of pieces there may be, at most, from the largest size down."""
    least = min(max(given[p, LOW], 1e-5 * given[p, SIZE_1]), given[p, UNBROKEN]) * given[p, RATIO]
    if not least > 0:
        return GENERATIONS
    return min(math.ceil(math.log(least / given[p, HIGH]) / math.log(given[p, RATIO])), GENERATIONS)


@scalar
def _find_least(given, panels, p, count):
    """Size below which nothing bears."""
    keep_apart()
    low, ratio = max(given[p, LOW], 1e-5 * given[p, SIZE_1]), given[p, RATIO]
    given[p, LEAST] = low
    if given[p, KEPT] == 0:
        return
    greatest = met(panels, p, count, 1.0)
    gain, x = given[p, KEPT] / ratio, low
    share = max(gain, 1.0) ** math.ceil(math.log(low / given[p, HIGH]) / math.log(ratio))
    for _ in range(GENERATIONS):
        if share <= NEGLIGIBLE or x <= given[p, UNBROKEN]:
            break
        share *= gain * (1 - survival(given, p, x, greatest))
        x *= ratio
    given[p, LEAST] = min(low, max(ratio * x, ratio * given[p, UNBROKEN]))


@scalar
def mark_sizes(given, p, marks):
    """Sizes at which a number of particles or pieces jumps, in increasing order; how many."""
    keep_apart()
    least, high, ratio = given[p, LEAST], given[p, HIGH], given[p, RATIO]
    marks[0], marks[1] = least, high
    count = 2
    for which in range(3):
        x = given[p, LOW]
        if which == 1:
            x = high
        elif which == 2:
            x = given[p, UNBROKEN]
        while x > least * (1 - 1e-12) and x > 0 and count < len(marks):
            if x <= high:
                place = count
                while place > 0 and marks[place - 1] > x:
                    place -= 1
                if marks[place - 1] < x * (1 - 1e-12) and x < marks[place] * (1 - 1e-12):
                    for j in range(count, place, -1):
                        marks[j] = marks[j - 1]
                    marks[place] = x
                    count += 1
            if given[p, KEPT] == 0:
                break
            x *= ratio
    return count
