"""Sums over the heights of ground that particles press down, at one separation.

Panels end where cells over the gap do. Where the ground gives way much, a gap may rise with the
height; panels follow it, as those of `thirdbody.contact.field_seat` do.
"""

from __future__ import annotations

import math

import numpy as np

from ...contact.field_seat import DENSITY as REACH
from ...contact.field_seat import FALL, HIGHEST_SEAT, NODES
from ...contact.field_seat import WIDTH as WIDEST
from ...laws.field.programme import MOMENTS
from ...numerics.quadrature import gauss_legendre
from ..compiled.machine import exp, keep_apart
from .field import ROOT_2PI
from .ground_cells import (
    COLUMNS,
    FROM,
    MOST_CELLS,
    OF_CELL,
    OVER,
    POWERS,
    RATE,
    ROOT,
    ROOT_CELL,
    START,
    UNTIL,
)  # fmt: skip
from .sides import exact, scalar, summed

__all__ = ["weigh_ground"]

BETA, UNKNOWNS = MOMENTS + 1, MOMENTS + 2
"""β_n, and with them the shadow: what is found at a separation."""
LOWEST, STEP, ROWS, SIGMA, UNIT, FIXED, LEFT, OF_GROUND = range(8)
"""Of a state: lowest row and distance of rows [σ], how many; σ [m], E*g [Pa], how much particles
shade beside what those do that carry; what series leave out."""
MEAN, SPREAD, DENSE, SECTION, LAST_SECTION, OF_SEAT = range(6)
"""Of a seat: its mean and width [σ]; particles per area; the first of its sections of sizes, and
where they end."""
_ROOTS, _WEIGHTS = gauss_legendre(NODES)
ROOTS, WEIGHTS = np.array(_ROOTS), np.array(_WEIGHTS)
HERMITE = np.zeros((BETA, BETA))
"""Powers of each he_n."""
for _n in range(BETA):
    HERMITE[_n, : _n + 1] = np.polynomial.hermite_e.herme2poly([0.0] * _n + [1.0])
    HERMITE[_n] /= math.sqrt(math.factorial(_n))
AFTER = 1 / np.sqrt(np.arange(1.0, BETA + 1))
LATER = np.sqrt(np.arange(1.0, BETA + 1) / np.arange(2.0, BETA + 2))
ZETA, CUT, GAP, MASS, LOADS, SHADES, ENDS_AT, WANTED, POLYNOMIALS, SUMS, OF_NODES = range(11)
"""Rows of the nodes over heights: height, that of the ground, gap, weight, load, shade; of ends of
cells: their heights, and gaps; then powers of the height: of the ground, and sums."""
FIRST_PLACE, LAST_PLACE, BY_ROOT, BEGIN, WHICH, OF_PLACE = range(6)
"""Of a panel over heights: between what its variable lies, 0 if that is the height itself, and 1 or
−1 if it is the root of the distance above or below a height, that height, and its cell, or −1 below
the last."""
MOST_PLACES = MOST_CELLS + 60
PLACES = NODES * MOST_PLACES
HEIGHTS = np.linspace(-HIGHEST_SEAT, HIGHEST_SEAT, 64)
"""Between which ends of cells are sought."""
NEWTON, FLATTEST, MISSED, TURNS = 8, 1e-3, 1e-10, 40
"""Steps of the search, the slope of a gap over the height at least, what a gap may be off before
the last step [σ], and halvings near the height of a widest or narrowest gap."""


@scalar
def _ground_at(u, zeta):
    """u at one height."""
    x = min(max(zeta, -HIGHEST_SEAT), HIGHEST_SEAT)
    after = later = 0.0
    for n in range(MOMENTS, -1, -1):
        later, after = after, after * AFTER[n] * x - LATER[n] * later + u[n]
    return after


@scalar
def _gap_at(h, u, zeta):
    """Gap [σ] over ground of a height."""
    return h - zeta + _ground_at(u, zeta)


@exact
def _find_gaps(h, sigma, p, zeta, cut, gap):
    """Gaps of nodes on ground that is a polynomial of the height."""
    p_0, p_1, p_2, p_3, p_4, p_5, p_6 = p[0], p[1], p[2], p[3], p[4], p[5], p[6]
    p_7, p_8, p_9, p_10, p_11, p_12 = p[7], p[8], p[9], p[10], p[11], p[12]
    for j in range(len(zeta)):
        x = cut[j]
        u = (((p_12 * x + p_11) * x + p_10) * x + p_9) * x + p_8
        u = ((((u * x + p_7) * x + p_6) * x + p_5) * x + p_4) * x + p_3
        gap[j] = sigma * (h - zeta[j] + ((u * x + p_2) * x + p_1) * x + p_0)


@exact
def _approach(h, p, low, high, sign, wanted, ends):
    """One step of Newton's towards the heights at which gaps are as wanted; how far they were off.

    Between two heights, where gaps rise or fall as ``sign`` says.
    """
    p_0, p_1, p_2, p_3, p_4, p_5, p_6 = p[0], p[1], p[2], p[3], p[4], p[5], p[6]
    p_7, p_8, p_9, p_10, p_11, p_12 = p[7], p[8], p[9], p[10], p[11], p[12]
    worst = 0.0
    for j in range(len(ends)):
        x = ends[j]
        u = (((p_12 * x + p_11) * x + p_10) * x + p_9) * x + p_8
        u = ((((u * x + p_7) * x + p_6) * x + p_5) * x + p_4) * x + p_3
        u = ((u * x + p_2) * x + p_1) * x + p_0
        t = (((12 * p_12 * x + 11 * p_11) * x + 10 * p_10) * x + 9 * p_9) * x + 8 * p_8
        t = ((((t * x + 7 * p_7) * x + 6 * p_6) * x + 5 * p_5) * x + 4 * p_4) * x + 3 * p_3
        t = (t * x + 2 * p_2) * x + p_1
        off = h - x + u - wanted[j]
        worst = max(worst, abs(off))
        ends[j] = min(max(x - sign * off / max(sign * (t - 1), FLATTEST), low), high)
    return worst


@scalar
def _turn_between(u, a, b, sign):
    """Height between two at which gaps are widest or narrowest, as ``sign`` says."""
    keep_apart()
    for _ in range(TURNS):
        one, two = (2 * a + b) / 3, (a + 2 * b) / 3
        if sign * (_ground_at(u, one) - one) > sign * (_ground_at(u, two) - two):
            b = two
        else:
            a = one
    return 0.5 * (a + b)


@scalar
def _lay_panels(seat, sign, rooted, begin, a, b, which, places, count):
    """Lay panels from one height to another, in the root of the distance from where it begins or in
    the height."""
    keep_apart()
    width = seat[SPREAD]
    while sign * (b - a) > 0 and count < MOST_PLACES:
        step = min(WIDEST, FALL / (abs(a - seat[MEAN]) / width + 0.5)) * width
        end = b if abs(b - a) <= 1.1 * step else a + sign * step
        one, two = a, end
        if rooted:
            one, two = (
                math.sqrt(max(sign * (a - begin), 0.0)), math.sqrt(max(sign * (end - begin), 0.0))
            )  # fmt: skip
        places[FIRST_PLACE, count], places[LAST_PLACE, count] = one, two
        places[BY_ROOT, count] = sign if rooted else 0.0
        places[BEGIN, count], places[WHICH, count] = begin, which
        count += 1
        a = end
    return count


@scalar
def _find_ends(h, u, p, a, b, sign, gaps, wanted, ends):
    """Heights between two, from the widest gap to the narrowest, at which gaps [σ] are as wanted.

    These fall; ``gaps`` are those at `HEIGHTS`.
    """
    keep_apart()
    last, low, high = len(HEIGHTS) - 1, min(a, b), max(a, b)
    step = HEIGHTS[1] - HEIGHTS[0]
    k = min(max(math.floor((a - HEIGHTS[0]) / step), 0), last - 1)
    way = 1 if sign < 0 else -1
    for j in range(len(wanted)):
        while 0 <= k + way < last and (
            gaps[k + 1 if way > 0 else k] > wanted[j]
            and low < HEIGHTS[k + 1 if way > 0 else k] < high
        ):
            k += way
        part = (gaps[k] - wanted[j]) / (gaps[k] - gaps[k + 1])
        ends[j] = min(max(HEIGHTS[k] + min(max(part, 0.0), 1.0) * step, low), high)
    for _ in range(NEWTON):
        if _approach(h, p, low, high, sign, wanted, ends) <= MISSED:
            return
    for j in range(len(wanted)):  # near a turn, where the gap is level
        zeta, one, two = ends[j], a, b
        if abs(_gap_at(h, u, zeta) - wanted[j]) > MISSED:
            for _ in range(TURNS):
                zeta = 0.5 * (one + two)
                if _gap_at(h, u, zeta) > wanted[j]:
                    one = zeta
                else:
                    two = zeta
        ends[j] = zeta


@scalar
def _lay_stretch(own, seat, h, u, a, b, level, cells, count, nodes, places, laid):
    """Lay panels where gaps only fall or only rise, from the widest gap at a to the narrowest at b.

    How many panels there are then. ``level`` says that the ground does not change.
    """
    keep_apart()
    sigma, sign = own[SIGMA], 1.0 if b > a else -1.0
    widest, narrowest = _gap_at(h, u, a), _gap_at(h, u, b)
    first, last = 0, count
    while first < last:  # the first cell that reaches below the widest gap
        middle = (first + last) // 2
        if cells[middle, FROM] >= sigma * widest:
            first = middle + 1
        else:
            last = middle
    while last < count and cells[last, UNTIL] > sigma * narrowest:
        last += 1
    if first == last and first < count:
        return laid
    many, wanted, ends = 0, nodes[WANTED], nodes[ENDS_AT]
    for n in range(first, last + 1):
        gap = (cells[n, UNTIL] if n < count else cells[count - 1, FROM]) / sigma
        wanted[many] = min(max(gap, narrowest), widest)
        many += 1
    if level:
        for j in range(many):
            ends[j] = a + widest - wanted[j]
    else:  # gaps fall with the height where panels follow it
        _find_ends(h, u, nodes[POLYNOMIALS], a, b, -sign, nodes[SUMS], wanted[:many], ends[:many])
        for j in range(many):  # near a turn a height is not as sure as a gap
            if wanted[j] == widest:
                ends[j] = a
            elif wanted[j] == narrowest:
                ends[j] = b
    slope = (_gap_at(h, u, a + 1e-6 * (b - a)) - widest) / (1e-6 * (b - a))
    for n in range(first, last):
        start, begin = int(cells[n, ROOT_CELL]), a
        rooted, above = cells[n, ROOT] > 0, cells[n, ROOT] / sigma - widest
        if rooted and above <= 0:
            begin = ends[start - first]
        elif rooted and slope * sign < 0:
            begin = a + above / slope  # where it would lie
        laid = _lay_panels(
            seat, sign, rooted, begin, ends[n - first], ends[n + 1 - first], n, places, laid
        )
    if last == count:
        below, rooted, begin = count - last - 1, last < count, 0.0
        laid = _lay_panels(seat, sign, rooted, begin, ends[many - 1], b, below, places, laid)
    return laid


@scalar
def _lay_seat(own, seat, h, u, cells, count, nodes, places):
    """Lay panels over the heights on which particles of a seat are squeezed; how many."""
    keep_apart()
    low, high = seat[MEAN] - REACH * seat[SPREAD], seat[MEAN] + REACH * seat[SPREAD]
    gaps, last = nodes[SUMS], len(HEIGHTS) - 1
    _find_gaps(h, 1.0, nodes[POLYNOMIALS], HEIGHTS, HEIGHTS, gaps)
    bottom, top = HEIGHTS[0], HEIGHTS[last]
    laid, level = 0, low < bottom
    if level:
        laid = _lay_stretch(
            own, seat, h, u, low, min(bottom, high), level, cells, count, nodes, places, laid
        )
    level, a, falls = False, max(low, bottom), True
    for j in range(1, last + 1):
        if j < last and (gaps[j + 1] < gaps[j]) == (gaps[j] < gaps[j - 1]):
            continue
        falls = gaps[j] < gaps[j - 1]
        b = top
        if j < last:
            b = _turn_between(u, HEIGHTS[j - 1], HEIGHTS[j + 1], -1.0 if falls else 1.0)
        b = min(b, high)
        if b > a:
            one, two = (a, b) if falls else (b, a)
            laid = _lay_stretch(own, seat, h, u, one, two, level, cells, count, nodes, places, laid)
            a = b
    level = high > top
    if level:
        laid = _lay_stretch(
            own, seat, h, u, max(low, top), high, level, cells, count, nodes, places, laid
        )
    return laid


@exact
def _place_nodes(first, last, sign, begin, zeta, mass):
    """Heights of the nodes of a panel, and their weights."""
    half, middle = 0.5 * (last - first), 0.5 * (last + first)
    if sign == 0:
        for j in range(NODES):
            zeta[j], mass[j] = middle + half * ROOTS[j], abs(half) * WEIGHTS[j]
    else:
        for j in range(NODES):
            root = middle + half * ROOTS[j]
            zeta[j], mass[j] = begin + sign * root * root, 2 * root * half * WEIGHTS[j]


@exact
def _weigh_heights(mean, width, zeta, cut, mass):
    """Weights of nodes times the density of the seat, and heights within those of the ground."""
    norm = 1 / (width * ROOT_2PI)
    for j in range(len(zeta)):
        cut[j] = min(max(zeta[j], -HIGHEST_SEAT), HIGHEST_SEAT)
        z = (zeta[j] - mean) / width
        mass[j] *= norm * exp(-0.5 * z * z)


@exact
def _take_places(cell, gap, places):
    """Gaps of the nodes of a panel in the variable of its cell, from −1 to 1."""
    start, rate, root = cell[START], cell[RATE], cell[ROOT]
    if root > 0:
        for j in range(NODES):
            x = rate * (math.sqrt(max(root - gap[j], 0.0)) - start)
            places[j] = min(max(x, -1.0), 1.0)
    else:
        for j in range(NODES):
            places[j] = min(max(rate * (gap[j] - start), -1.0), 1.0)


@exact
def _read_powers(c, places, out):
    """A series of a cell at the nodes of a panel."""
    c_0, c_1, c_2, c_3, c_4, c_5, c_6, c_7 = c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]
    c_8, c_9, c_10, c_11, c_12, c_13 = c[8], c[9], c[10], c[11], c[12], c[13]
    c_14, c_15 = c[14], c[15]
    for j in range(NODES):
        x = places[j]
        v = (((c_0 * x + c_1) * x + c_2) * x + c_3) * x + c_4
        v = ((((v * x + c_5) * x + c_6) * x + c_7) * x + c_8) * x + c_9
        v = ((((v * x + c_10) * x + c_11) * x + c_12) * x + c_13) * x + c_14
        out[j] = v * x + c_15


@exact
def _take_power(top, power, gap, out):
    """Take what stands over a power of the root of the distance to the top times that, and nothing
    below zero."""
    if power == 4:
        for j in range(NODES):
            rise = max(top - gap[j], 0.0)
            out[j] *= rise * rise
    elif power == 2:
        for j in range(NODES):
            out[j] *= max(top - gap[j], 0.0)
    for j in range(NODES):
        out[j] = max(out[j], 0.0)


@summed
def _sum_products(mass, values):
    total = 0.0
    for j in range(len(mass)):
        total += mass[j] * values[j]
    return total


@scalar
def _read_panel(cell, top, darker, whole, gap, mass, loads, shades, places, columns):
    """Loads and shades at the nodes of a panel, and sums of other columns if the whole is asked."""
    keep_apart()
    power = cell[OVER]
    _take_places(cell, gap, places)
    dark = power
    if darker and power > 0:
        dark -= 2
    for k in range(COLUMNS):
        if 0 < k < COLUMNS - 1 and not whole:
            continue
        out = loads if k == 0 else shades  # others on their way
        _read_powers(cell[POWERS + OF_CELL * k : POWERS + OF_CELL * (k + 1)], places, out)
        if k == COLUMNS - 1:
            _take_power(top, dark, gap, out)
            if dark != power:
                for j in range(NODES):
                    out[j] *= top
        else:
            _take_power(top, power, gap, out)
        if 0 < k < COLUMNS - 1:
            columns[k] += _sum_products(mass, out)


@summed
def _take_powers(mass, load, cut, p):
    """Sums of the loads times powers of the height."""
    s_0 = s_1 = s_2 = s_3 = s_4 = s_5 = s_6 = s_7 = s_8 = s_9 = s_10 = s_11 = s_12 = 0.0
    for j in range(len(mass)):
        x, v = cut[j], mass[j] * load[j]
        s_0 += v
        v *= x
        s_1 += v
        v *= x
        s_2 += v
        v *= x
        s_3 += v
        v *= x
        s_4 += v
        v *= x
        s_5 += v
        v *= x
        s_6 += v
        v *= x
        s_7 += v
        v *= x
        s_8 += v
        v *= x
        s_9 += v
        v *= x
        s_10 += v
        v *= x
        s_11 += v
        s_12 += v * x
    p[0], p[1], p[2], p[3], p[4], p[5], p[6] = s_0, s_1, s_2, s_3, s_4, s_5, s_6
    p[7], p[8], p[9], p[10], p[11], p[12] = s_7, s_8, s_9, s_10, s_11, s_12


@scalar
def _weigh_seat(own, seat, h, u, cells, count, darker, floor, nodes, places, found, columns, whole):
    """Add what the particles of a seat carry to the loads' moments and the shadow.

    Their columns by themselves. A moment is NaN where there is no room for all panels.
    """
    keep_apart()
    for c in range(COLUMNS):
        columns[c] = 0.0
    if seat[DENSE] == 0:
        return
    laid = _lay_seat(own, seat, h, u, cells, count, nodes, places)
    size = NODES * laid
    zeta, cut, gap, mass = (
        nodes[ZETA, :size], nodes[CUT, :size], nodes[GAP, :size], nodes[MASS, :size]
    )  # fmt: skip
    loads, shades, p = nodes[LOADS, :size], nodes[SHADES, :size], nodes[SUMS]
    for n in range(laid):
        here = slice(NODES * n, NODES * (n + 1))
        _place_nodes(
            places[FIRST_PLACE, n], places[LAST_PLACE, n], places[BY_ROOT, n], places[BEGIN, n],
            zeta[here], mass[here],
        )  # fmt: skip
    _weigh_heights(seat[MEAN], seat[SPREAD], zeta, cut, mass)
    _find_gaps(h, own[SIGMA], nodes[POLYNOMIALS], zeta, cut, gap)
    for n in range(laid):
        here, which = slice(NODES * n, NODES * (n + 1)), int(places[WHICH, n])
        if which < 0:
            for j in range(NODES):
                loads[NODES * n + j], shades[NODES * n + j] = floor[0], floor[COLUMNS - 1]
            for k in range(1, COLUMNS - 1):
                for j in range(NODES):
                    columns[k] += floor[k] * mass[NODES * n + j]
        else:
            _read_panel(
                cells[which], cells[0, UNTIL], darker, whole, gap[here], mass[here], loads[here],
                shades[here], zeta[here], columns,
            )  # fmt: skip
    _take_powers(mass, loads, cut, p)
    columns[0], columns[COLUMNS - 1] = p[0], _sum_products(mass, shades)
    over = seat[DENSE] / own[UNIT]
    for n in range(BETA):
        for k in range(n + 1):
            found[n] += over * HERMITE[n, k] * p[k]
    if laid == MOST_PLACES:
        found[0] = math.nan
    found[BETA] += seat[DENSE] * columns[COLUMNS - 1]


@scalar
def weigh_ground(field, h, u, nodes, places, found, columns, whole):
    """Loads' moments and the shadow at h [σ] on ground u, and all columns if the whole is asked."""
    keep_apart()
    own, seats, darker, _, _, _, cells, counts, floor = field
    p = nodes[POLYNOMIALS]
    for n in range(BETA):
        found[n] = p[n] = 0.0
        for k in range(n, BETA):
            p[n] += HERMITE[k, n] * u[k]
    found[BETA] = 0.0
    for s in range(len(seats)):
        _weigh_seat(
            own, seats[s], h, u, cells[s], counts[s], darker[s], floor[s], nodes, places, found,
            columns[s], whole,
        )  # fmt: skip
