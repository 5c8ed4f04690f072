"""Particles on the ground of one field of heights: one separation of a state.

Particles press the ground under them down, and the ground of asperities: the equations are those of
`thirdbody.contact.field_ground`, and so are the rows of separations and the splines between them.
What the particles of a seat carry under a gap stands in cells over the gap, once for states whose
particles are alike. Sums over heights have panels that end where cells do.
"""

from __future__ import annotations

import math

import numpy as np

from ...contact.field_ground import DENSITY as REACH
from ...contact.field_ground import FAR, HIGHEST_SEAT, LEVEL, LEVELS, LIFTS, NODES
from ...contact.field_ground import WIDTH as WIDEST
from ...laws.field.programme import MOMENTS
from ...laws.field.table import COLUMNS as OF_SURFACE
from ...laws.field.table import FIRST, LOW, TAU
from ...numerics.quadrature import gauss_legendre
from ..compiled.machine import exp, keep_apart, normal_cdf
from .curves import EDGE, ONE, TO, transform
from .field import COUNTS, ENDS, PIECES, ROOT_2PI, TERMS, mean_pressure
from .fields import (
    CHI,
    DENSITY,
    EQUAL,
    F_SA,
    HEIGHTS_OF_TABLE,
    HIGH,
    IS_SOFT,
    KIND,
    ONE_SIZE,
    PROJECTED,
    SHADOW,
)
from .fields import (
    LOW as SMALLEST,
)
from .gaps import add_between, has_powers, sum_onset, sum_panels
from .shares import particle_at
from .sides import exact, scalar, summed
from .sums import add_plane

__all__ = ["lay_gaps", "lay_surface", "round_of"]

BETA, UNKNOWNS = MOMENTS + 1, MOMENTS + 2
"""β_n, and with them the shadow: what is found at a separation."""
TAUS = 16
K_PP, K_AS, K_ZS, OF_KERNELS = 0, BETA, BETA + TAUS * BETA, BETA + 2 * TAUS * BETA
"""Of the displacements: k_n of particles, then series in τ of those of asperities under particles,
and of particles under asperities."""
LOWEST, STEP, ROWS, SIGMA, UNIT, FIXED, LEFT, OF_GROUND = range(8)
"""Of a state: lowest row and distance of rows [σ], how many; σ [m], E*g [Pa], how much particles
shade beside what those do that carry; what series leave out."""
MEAN, SPREAD, TOP, DENSE, SECTION, LAST_SECTION, OF_SEAT = range(7)
"""Of a seat: its mean and width, and the largest size on it [σ]; particles per area; the first of
its sections of sizes, and where they end."""
WAVES = 2 * math.sqrt(2)
_ROOTS, _WEIGHTS = gauss_legendre(NODES)
ROOTS, WEIGHTS = np.array(_ROOTS), np.array(_WEIGHTS)
HERMITE = np.zeros((BETA, BETA))
"""Powers of each he_n."""
for _n in range(BETA):
    HERMITE[_n, : _n + 1] = np.polynomial.hermite_e.herme2poly([0.0] * _n + [1.0])
    HERMITE[_n] /= math.sqrt(math.factorial(_n))
AFTER = 1 / np.sqrt(np.arange(1.0, BETA + 1))
LATER = np.sqrt(np.arange(1.0, BETA + 1) / np.arange(2.0, BETA + 2))
MOST_CELLS = 400
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
NEWTON, FLATTEST, MISSED, TURNS = 8, 1e-3, 1e-10, 60
"""Steps of the search, the slope of a gap over the height at least, what a gap may be off before
the last step [σ], and halvings near the height of a widest or narrowest gap."""
FROM, UNTIL, ROOT, ROOT_CELL, START, RATE, OVER, POWERS = range(8)
"""Of a cell: its gaps [m]; the gap to which the distance has the root that is its variable, or 0
where it is the gap itself, and the cell that begins there; where the variable starts and its rate;
the power of that root like which all sets in; from there on powers of each column in turn."""
OF_CELL, COLUMNS = 16, 6
A_CELL = POWERS + COLUMNS * OF_CELL
CONVERT = np.zeros((OF_CELL, OF_CELL))
"""From a series to powers, highest first."""
for _n in range(OF_CELL):
    CONVERT[:, _n] = np.append(
        np.polynomial.chebyshev.cheb2poly([0.0] * _n + [1.0]), [0.0] * (OF_CELL - 1 - _n)
    )[::-1]
SETTLED, THINNEST = 2e-11, 1e-6
"""Last terms of a series over its largest value, at most; width of a cell over the largest size
below which it is not halved."""
BELOW = 1e-9
"""Part of a gap by which another lies surely below it."""
CLOSEST = 1e-13
VALUE, SLOPE, PRESSED, TURNED, BASIS, U = range(6)
"""Rows of what asperities do at a separation."""


# ------------------------------------------------------------------------------ cells over the gap
@scalar
def _add_under(given, sides, panels, count, gap, rule, sums, onsets, out):
    """Add what the particles of all sections carry under a gap; False below their range."""
    keep_apart()
    for s in range(len(given)):
        one = given[s : s + 1]
        if one[0, DENSITY] == 0:
            continue
        if has_powers(one, 0):
            add_between(one, sides, panels, 0, count, gap, sums[s : s + 1], onsets[s], out)
        elif not add_plane(one, sides, panels, 0, count, gap, rule, out):
            return False
    return True


@scalar
def _fill_cell(given, sides, panels, count, rule, places, sums, onsets, root, power, a, b, values,
               series, terms):  # fmt: skip
    """Fill series of all columns between two gaps; their last terms over the largest value.

    In the root of the distance to ``root``, if it is one, and over its ``power``.
    """
    keep_apart()
    low, high = (math.sqrt(root - b), math.sqrt(max(root - a, 0.0))) if root > 0 else (a, b)
    for j in range(OF_CELL):
        place = low + 0.5 * (high - low) * (1 + places[0, j])
        gap = root - place * place if root > 0 else place
        for k in range(10):
            terms[k] = 0.0
        if not _add_under(given, sides, panels, count, gap, rule, sums, onsets, terms):
            return math.nan
        # by the gap as it is rounded, as is what is carried
        over = (root - gap) ** (-0.5 * power) if power > 0 else 1.0
        for k in range(COLUMNS - 1):
            values[k, j] = terms[F_SA + k] * over
        if power > 0 and given[0, SHADOW] == PROJECTED:
            over *= (root - gap) / root  # all of a size is dark once it is touched
        values[COLUMNS - 1, j] = terms[F_SA + COLUMNS - 1] * over
    worst = wide = load = 0.0
    for j in range(OF_CELL):
        load = max(load, abs(values[0, j]))
        for k in range(1, COLUMNS):
            wide = max(wide, abs(values[k, j]))
    for k in range(COLUMNS):
        transform(places, values[k], series[k])
        most = wide if k > 0 else load
        if most > 0:
            left = abs(series[k, OF_CELL - 1]) + abs(series[k, OF_CELL - 2])
            worst = max(worst, left / most)
    return worst


@scalar
def _keep_cell(root, start, power, a, b, series, cell):
    """Keep a cell between two gaps."""
    keep_apart()
    low, high = (math.sqrt(root - b), math.sqrt(max(root - a, 0.0))) if root > 0 else (a, b)
    cell[FROM], cell[UNTIL], cell[ROOT], cell[ROOT_CELL], cell[OVER] = a, b, root, start, power
    cell[START], cell[RATE] = 0.5 * (low + high), 2 / (high - low)
    for k in range(COLUMNS):
        for j in range(OF_CELL):
            total = 0.0
            for i in range(OF_CELL - 1 - j, OF_CELL):
                total += CONVERT[j, i] * series[k, i]
            cell[POWERS + OF_CELL * k + j] = total


@scalar
def _note(edges, count, gap, onset, low, high):
    """Note a gap at which a cell ends, in falling order, and whether sizes set in there."""
    keep_apart()
    if not low < gap <= high or count == edges.shape[1]:
        return count
    place = count
    while place > 0 and edges[0, place - 1] < gap:
        place -= 1
    for near in range(max(place - 1, 0), min(place + 1, count)):
        if abs(edges[0, near] - gap) < 1e-12 * high:
            edges[1, near] = max(edges[1, near], onset)
            return count
    for j in range(count, place, -1):
        edges[0, j], edges[1, j] = edges[0, j - 1], edges[1, j - 1]
    edges[0, place], edges[1, place] = gap, onset
    return count + 1


@scalar
def _differs(given, sides, panels, n):
    """Whether another of the two areas is the larger on panel n than on the one before."""
    keep_apart()
    signs = 1.0
    for m in range(n - 1, n + 1):
        eps = 0.5 * (panels[0, m, EDGE] + panels[0, m, TO])
        _, one, two = particle_at(given, sides, panels, 0, m, eps)
        signs *= 1.0 if one > two else -1.0
    return signs < 0


@scalar
def _note_sizes(given, sides, panels, count, low, high, edges):
    """Note the gaps at which a size begins to be squeezed or comes to another panel."""
    keep_apart()
    last, marked = panels[0, count - 1, TO], 0
    for n in range(count + 1):
        eps = panels[0, n, EDGE] if n < count else last
        # an end of panels alone: the formula is the same behind it
        alone = 0 < n < count and panels[0, n, ONE] < 0
        if alone and (given[0, EQUAL] == 1 or not _differs(given, sides, panels, n)):
            continue
        onset = 1.0 if n == 0 else 0.0
        for s in range(len(given)):
            if given[s, DENSITY] > 0:
                for k in (SMALLEST, HIGH):
                    marked = _note(edges, marked, given[s, k] * (1 - eps), onset, low, high)
    return marked


@scalar
def _begin_sections(given, sides, panels, count, finest, some, sums, onsets):
    """Sum over the squeeze what sizes that are powers carry.

    The smallest and the largest size, the power of the root of the distance from that like which
    all sets in, and what the sums leave out.
    """
    keep_apart()
    low, high, power, worst, powers = math.inf, 0.0, 4.0, 0.0, False
    for s in range(len(given)):
        one = given[s : s + 1]
        some[s] = len(given)  # not summed
        if one[0, DENSITY] == 0:
            continue
        if one[0, HIGH] >= high:
            high, power = one[0, HIGH], 2.0 if one[0, KIND] == ONE_SIZE else 4.0
        low = min(low, one[0, SMALLEST])
        if has_powers(one, 0):
            some[s], powers = 0, True
            sum_onset(one, sides, panels, 0, onsets[s])
    if powers:
        worst = sum_panels(given, sides, panels, 0, some, count, finest, sums)
    return low, high, power, worst


@scalar
def lay_gaps(given, sides, panels, count, rule, places, finest, settled, cells, floor, edges,
             values, series, terms, some, sums, onsets):  # fmt: skip
    """Lay cells over the gap, from the largest size down; how many, and what they leave out.

    Of all sections of a seat, whose sides are those of the first. −1 where there is no room, and 0
    where particles are squeezed by more than their size.
    """
    keep_apart()
    last = panels[0, count - 1, TO]
    if last >= 1:
        return 0, 0.0
    low, high, power, worst = _begin_sections(
        given, sides, panels, count, finest, some, sums, onsets
    )
    bottom = low * (1 - last)
    marked = _note_sizes(given, sides, panels, count, bottom, high, edges)
    if marked >= edges.shape[1] - 1:
        return -1, 0.0
    edges[0, marked], edges[1, marked] = bottom, 0.0
    for k in range(10):
        terms[k] = 0.0
    # of one size, what all are squeezed beyond begins below the last panel
    _add_under(
        given, sides, panels, count, bottom * (1 - BELOW), rule, sums, onsets, terms
    )  # fmt: skip
    for k in range(COLUMNS):
        floor[k] = terms[F_SA + k]
    found, n, many, start, begins = 0, 0, 1, 0, high
    while n < marked:
        # where formulas change little at their ends, one series does over several of them
        b, last_n, alone = edges[0, n], min(n + many, marked), False
        if edges[1, n] == 1:
            start, begins = found, b
        a = edges[0, last_n]
        while True:
            if found == MOST_CELLS:
                return -1, 0.0
            root = begins if begins - b < b - a else 0.0
            over = power if root == high else 0.0
            left = _fill_cell(
                given, sides, panels, count, rule, places, sums, onsets, root, over, a, b, values,
                series, terms,
            )  # fmt: skip
            if left != left:
                return -1, 0.0
            if left > settled and b - a > THINNEST * high:
                if last_n > n + 1:
                    last_n = many = n + (last_n - n) // 2
                    many -= n
                    a = edges[0, last_n]
                else:
                    alone = True
                    a = 0.5 * (a + b)
                    if root > 0:
                        middle = 0.5 * (math.sqrt(root - b) + math.sqrt(root - 2 * a + b))
                        a = root - middle * middle
                continue
            worst = max(worst, left)
            _keep_cell(root, start, over, a, b, series, cells[found])
            found += 1
            if a <= edges[0, last_n]:
                break
            a, b = max(edges[0, last_n], a - 2 * (b - a)), a
        many = 1 if alone else min(2 * many, 2)
        n = last_n
    return found, worst


# ------------------------------------------------------------------------------ asperities
@scalar
def lay_surface(skin, table, surface):
    """Every piece of the splines over the separation, of all columns of a surface."""
    keep_apart()
    soft = int(skin[0, IS_SOFT])
    for n in range(COUNTS[soft]):
        for k in range(TERMS):
            row = surface[n, k]
            for c in range(OF_SURFACE):
                row[c] = 0.0
            for i in range(HEIGHTS_OF_TABLE):
                part = PIECES[soft, n, k, i]
                if part != 0:
                    for c in range(OF_SURFACE):
                        row[c] += part * table[i, c]


@scalar
def _read_surface(skin, surface, h, value, slope):
    """Columns of a surface at h [σ] and their slopes; the bend of the first."""
    keep_apart()
    soft = int(skin[0, IS_SOFT])
    last, n, bend = COUNTS[soft] - 1, 0, 0.0
    while n < last and h >= ENDS[soft, n + 1]:
        n += 1
    top = ENDS[soft, last + 1]
    x = min(h, top) - ENDS[soft, n]
    for c in range(OF_SURFACE):
        value[c] = slope[c] = 0.0
    for k in range(TERMS):
        bend = bend * x + slope[LOW]
        for c in range(OF_SURFACE):
            slope[c] = slope[c] * x + value[c]
            value[c] = value[c] * x + surface[n, k, c]
    bend *= 2
    if h > top:
        u, du = 1 - top / h, top / (h * h)
        for c in range(OF_SURFACE):
            first = slope[c] * top
            second = 0.5 * (bend * top * top + 2 * first) if c == LOW else 0.0
            value[c] += first * u + second * u * u
            slope[c] = (first + 2 * second * u) * du
            if c == LOW:
                bend = -2 * (first + 2 * second * u) * du / h + 2 * second * du * du
    return bend


@scalar
def _press(own, kernels, skin, surface, h, small):
    """What asperities at h press down under particles, and what lifts them, into two rows."""
    keep_apart()
    value, slope = small[VALUE], small[SLOPE]
    h = min(max(h, own[LOWEST]), FAR)
    bend = _read_surface(skin, surface, h, value, slope)
    chi, raw = skin[0, CHI], math.exp(-0.5 * h * h)
    density, bearing = raw / ROOT_2PI, normal_cdf(-h, raw)
    P, P1, P2 = chi * (density - h * bearing), -chi * bearing, chi * density
    y, y1 = value[LOW], slope[LOW]
    load = mean_pressure(y, y1, P, -P1)
    steep = -math.exp(y) * (P2 + 2 * P1 * y1 + P * (bend + y1 * y1))
    over, x = load / steep, 2 * value[TAU] - 1
    basis = small[BASIS]
    basis[0], basis[1] = 1.0, x
    for j in range(2, TAUS):
        basis[j] = 2 * x * basis[j - 1] - basis[j - 2]
    pressed, turned = small[PRESSED], small[TURNED]
    for n in range(BETA):
        pressed[n] = turned[n] = 0.0
    for j in range(TAUS):
        part, begin_as, begin_zs = basis[j], K_AS + j * BETA, K_ZS + j * BETA
        for n in range(BETA):
            turned[n] += part * kernels[begin_as + n]
            pressed[n] += part * kernels[begin_zs + n]
    pressed[0] *= load
    for n in range(1, BETA):
        ratio = value[FIRST + n - 1]
        pressed[n] *= ratio * load
        turned[n] *= ratio + slope[FIRST + n - 1] * over


@scalar
def _level_out(h):
    """Separation [σ] at which the ground under asperities is read."""
    if h <= LEVEL:
        return h
    x = min((h - LEVEL) / LEVELS, 1.0)
    return LEVEL + LEVELS * x * (1 - x * x * (1 - 0.5 * x))


@scalar
def lift_of(own, kernels, skin, surface, h, state, start, small):
    """Lift of the asperities' ground [σ], by chords, and how far it is off.

    From one that is near, as there may be several. What asperities press at h + w is left in the
    rows.
    """
    keep_apart()
    w = before = found = start
    miss = math.nan
    for _ in range(LIFTS):
        _press(own, kernels, skin, surface, _level_out(h + w), small)
        total = 0.0
        for n in range(BETA):
            total += small[TURNED, n] * state[n]
        found = max(WAVES * total, own[LOWEST] - h)
        last, miss = miss, found - w
        if abs(miss) < CLOSEST:
            break
        chord = miss * (w - before) / (last - miss)
        step = chord if abs(chord) <= 2 * abs(miss) else miss
        before, w = w, w + step
    if h + w > LEVEL:
        _press(own, kernels, skin, surface, h + w, small)
    return found, abs(miss)


# ------------------------------------------------------------------------------ seats
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
    if not sign * (b - a) > 0:
        return count
    parts = max(1, math.ceil(abs(b - a) / (WIDEST * seat[SPREAD])))
    for m in range(min(parts, MOST_PLACES - count)):
        one, two = a + (b - a) * m / parts, a + (b - a) * (m + 1) / parts
        if rooted:
            one, two = (
                math.sqrt(max(sign * (one - begin), 0.0)), math.sqrt(max(sign * (two - begin), 0.0))
            )  # fmt: skip
        places[FIRST_PLACE, count], places[LAST_PLACE, count] = one, two
        places[BY_ROOT, count] = sign if rooted else 0.0
        places[BEGIN, count], places[WHICH, count] = begin, which
        count += 1
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
        _find_ends(
            h, u, nodes[POLYNOMIALS], a, b, -sign, nodes[SUMS], wanted[:many], ends[:many]
        )
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
            laid = _lay_stretch(
                own, seat, h, u, one, two, level, cells, count, nodes, places, laid
            )
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
def _lower_powers(root, power, gap, out):
    """Take what stands over a power of the root times that, and nothing below zero."""
    if power == 4:
        for j in range(NODES):
            rise = max(root - gap[j], 0.0)
            out[j] *= rise * rise
    elif power == 2:
        for j in range(NODES):
            out[j] *= max(root - gap[j], 0.0)
    for j in range(NODES):
        out[j] = max(out[j], 0.0)


@summed
def _sum_products(mass, values):
    total = 0.0
    for j in range(len(mass)):
        total += mass[j] * values[j]
    return total


@scalar
def _read_panel(cell, darker, whole, gap, mass, loads, shades, places, columns):
    """Loads and shades at the nodes of a panel, and sums of other columns if the whole is asked."""
    keep_apart()
    root, power = cell[ROOT], cell[OVER]
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
            _lower_powers(root, dark, gap, out)
            if dark != power:
                for j in range(NODES):
                    out[j] *= root
        else:
            _lower_powers(root, power, gap, out)
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
                cells[which], darker, whole, gap[here], mass[here], loads[here], shades[here],
                zeta[here], columns,
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


@scalar
def round_of(field, h, state, lift, small, nodes, places, found, columns, whole):
    """β_n and the shadow again, from those and the lift before, at h [σ].

    The lift and how far it is off.
    """
    keep_apart()
    own, _, _, kernels, skin, surface, _, _, _ = field
    w, off = lift_of(own, kernels, skin, surface, h, state, lift, small)
    # the rows hold what asperities do a last step before, some 1e-13 of σ away
    bare, u = 1 - min(max(state[BETA], 0.0), 1.0), small[U]
    for n in range(BETA):
        u[n] = WAVES * (bare * small[PRESSED, n] + kernels[K_PP + n] * state[n])
    weigh_ground(field, h, u, nodes, places, found, columns, whole)
    return w, off
