"""What a particle of unit size carries, on panels of its squeeze.

Load and areas are series of a panel: between two different sides on all panels that no jump holds,
between equal ones where they are smooth enough.
"""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .sides import exact, scalar, summed
from .vectors import exp, fill_side, ln

MOST_PANELS, TERMS = 160, 24
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
SETTLED = 2e-13
"""Of the last two terms of such a series over its largest value, at most."""
ROOM = 20
"""Rows behind those of the panels, for what many nodes have on the way."""
AT, LOAD, AREA_1, AREA_2, FIRST, SECOND, OTHER, OFF, NEAR, NEAR_1, NEAR_OTHER, NEAR_2 = range(12)
PASSING, PASSING_2, LEAST, MOST, OLD, OLD_OFF, SLOPE, MASS = range(12, ROOM)
"""Of those rows: ε, load and areas over x²; indentations of both sides, load of the second and how
far it is off; the same a step further; what else is on
the way, and weights of a caller."""
CLOSE, BALANCED, NEARBY, ROUNDED = 1e-12, 1e-13, 1e-8, 2e-15
"""Of limits; imbalances that leave nothing, or nothing after one more step of secants, the part of
an indentation from which on such a step leaves nothing, and what is rounding."""
STEEPEST, TRIES, FLAT = 1e4, 25, 1e-12
"""Power of an indentation like which a load may grow."""
NEGLIGIBLE = 5e-14
"""What a panel may leave out of its series, times its width over that of the sizes and the seat."""
JUMP, BESIDE = 1e-9, 1e-14
"""Of a load at a kink, at least, and where its sides are looked at; both relative."""


@scalar
def share_at(panels, p, n, eps):
    """Share of side 1 in a squeeze ε on panel n."""
    keep_apart()
    first, last = panels[p, n, FROM], panels[p, n, UNTIL]
    if first == 0:
        x = 2 * math.sqrt(eps / last) - 1
    else:
        x = 2 * math.log(eps / first) / math.log(last / first) - 1
    b, c = 0.0, 0.0
    for k in range(TERMS - 1, 0, -1):
        b, c = panels[p, n, SHARE + k] + 2 * x * b - c, b
    return panels[p, n, SHARE] + x * b - c


@exact
def read_shares(panel, eps, first):
    """Indentation over x of side 1 at squeezes of a panel with a series, into ``first``."""
    keep_apart()
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
def read_particles(panel, eps, load, one, two):
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
def read_particle(panel, eps):
    """As `read_particles`, at one squeeze."""
    keep_apart()
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
    """Coefficients of a series; its last two terms over its largest value."""
    keep_apart()
    most = 0.0
    for j in range(TERMS):
        most = max(most, abs(values[j]))
    transform(rule, values, series)
    return (abs(series[TERMS - 1]) + abs(series[TERMS - 2])) / most


@scalar
def settle_rows(panel, room, rule):
    """Take series of load and areas from the rows of the room, at the places of a series.

    What is left out of them, at most.
    """
    keep_apart()
    eps, load = room[AT, :TERMS], room[LOAD, :TERMS]
    one, two = room[AREA_1, :TERMS], room[AREA_2, :TERMS]
    for j in range(TERMS):
        load[j] /= eps[j] * math.sqrt(eps[j])
        one[j] /= eps[j]
        two[j] /= eps[j]
    tail = _settle_one(rule, load, panel[OF_LOAD:OF_AREA_1])
    tail = max(tail, _settle_one(rule, one, panel[OF_AREA_1:OF_AREA_2]))
    return max(tail, _settle_one(rule, two, panel[OF_AREA_2:PANEL]))


@scalar
def fill_both(sides, p, panel, first, second, room):
    """Loads and areas of both sides at their indentations: into two rows each."""
    wide = len(first)
    passing, passing_2 = room[PASSING, :wide], room[PASSING_2, :wide]
    fill_side(
        sides, 2 * p, panel[FORM_1], first, room[LOAD, :wide], room[AREA_1, :wide], passing,
        passing_2,
    )  # fmt: skip
    fill_side(
        sides, 2 * p + 1, panel[FORM_2], second, room[OTHER, :wide], room[AREA_2, :wide], passing,
        passing_2,
    )  # fmt: skip


@exact
def find_rest(eps, first, second):
    for j in range(len(eps)):
        second[j] = eps[j] - first[j]


@exact
def find_off(load, other, first, second, slope, off):
    """How far the loads of both sides are apart; by how much of an indentation, at most.

    The slope is that of ln of the first over the second, at a fixed squeeze.
    """
    worst = 0.0
    for j in range(len(load)):
        off[j] = other[j] / load[j] - 1
        part = abs(off[j]) / (slope[j] * min(first[j], second[j]))
        worst = max(worst, part if abs(off[j]) > ROUNDED else 0.0)
    return worst


@exact
def follow(off, near_load, near_other, part):
    """Part of the way to what is near at which both loads are equal."""
    for j in range(len(off)):
        far = off[j] - (near_other[j] / near_load[j] - 1)
        part[j] = off[j] / far if abs(off[j]) > BALANCED else 0.0


@exact
def mix(part, near, value):
    for j in range(len(part)):
        value[j] += part[j] * (near[j] - value[j])


@exact
def take_weaker(first, second, other, load):
    for j in range(len(load)):
        load[j] = load[j] if first[j] > second[j] else other[j]


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
