"""Particles on the ground of one field of heights: one separation of a state.

Particles press the ground under them down, and the ground of asperities: the equations are those of
`thirdbody.contact.field_ground`, and so are the nodes over heights, the rows of separations and the
splines between them. What particles carry under a gap stands in cells over the gap, once for states
whose particles are alike: of each section of the sizes on a seat its own.
"""

from __future__ import annotations

import math

import numpy as np

from ...contact.field_ground import DENSITY as REACH
from ...contact.field_ground import FAR, HIGHEST_SEAT, LEVEL, LEVELS, LIFTS, NODES, PANELS, SET_IN
from ...laws.field.programme import MOMENTS
from ...laws.field.table import COLUMNS as OF_SURFACE
from ...laws.field.table import FIRST, LOW, TAU
from ...numerics.quadrature import panel_rule
from ..compiled.machine import exp, keep_apart, normal_cdf
from .curves import EDGE, ONE, TO, transform
from .field import COUNTS, ENDS, PIECES, ROOT_2PI, TERMS, mean_pressure
from .fields import (
    CHI,
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
POWER, DARKER, CELLS, OF_SECTION = range(4)
"""Of a section: power of the root of the distance from its largest size like which all sets in, and
whether the shadow sets in like one power less; how many cells there are."""
WAVES = 2 * math.sqrt(2)
PLACES = NODES * (len(PANELS) - 1)
_ROOTS, _WEIGHTS = panel_rule(np.sqrt(PANELS), NODES)
ROOTS, WEIGHTS = np.array(_ROOTS), np.array(_WEIGHTS)
HERMITE = np.zeros((BETA, BETA))
"""Powers of each he_n."""
for _n in range(BETA):
    HERMITE[_n, : _n + 1] = np.polynomial.hermite_e.herme2poly([0.0] * _n + [1.0])
    HERMITE[_n] /= math.sqrt(math.factorial(_n))
_HEIGHTS = np.linspace(-HIGHEST_SEAT, HIGHEST_SEAT, 2001)
TALLEST = np.abs(np.polynomial.hermite_e.hermevander(_HEIGHTS, MOMENTS)).max(0) * HERMITE.diagonal()
"""The largest |he_n| at heights of the ground."""
AFTER = 1 / np.sqrt(np.arange(1.0, BETA + 1))
LATER = np.sqrt(np.arange(1.0, BETA + 1) / np.arange(2.0, BETA + 2))
ZETA, CUT, GAP, MASS, LOADS, POLYNOMIALS, SUMS, OF_NODES = range(8)
"""Rows of the nodes over heights, then of powers of the height: of the ground, and sums."""
GRID = 69
FROM, UNTIL, ROOTED, START, RATE, POWERS = range(6)
"""Of a part of a cell: its gaps [m], whether its variable is the root of what the gap lacks to the
largest size, the middle of that and its rate; powers of load and shadow side by side, then of the
others."""
OF_CELL, CUTS, POWER_TERMS = 16, 4, 10
COLUMNS = 6
AREAS = POWERS + 2 * POWER_TERMS
A_CELL = POWERS + COLUMNS * POWER_TERMS
MOST_CELLS = 960


def _conversion() -> tuple[np.ndarray, np.ndarray]:
    """Powers on each part of a cell from its series, highest first; what they leave of a term."""
    out, left = np.zeros((CUTS, POWER_TERMS, OF_CELL)), np.zeros(OF_CELL)
    x, fine = np.cos((np.arange(POWER_TERMS) + 0.5) * math.pi / POWER_TERMS), np.linspace(-1, 1, 99)
    powers = np.linalg.inv(np.vander(x))
    for part in range(CUTS):
        places = np.clip((2 * part + 1 + np.stack([x])) / CUTS - 1, -1, 1)[0]
        terms = np.cos(np.arange(OF_CELL) * np.arccos(places)[:, None])
        out[part] = powers @ terms
        exact_ = np.cos(np.arange(OF_CELL) * np.arccos((2 * part + 1 + fine) / CUTS - 1)[:, None])
        left = np.maximum(left, np.abs(np.vander(fine, POWER_TERMS) @ out[part] - exact_).max(0))
    return out, left


CONVERT, LEAVES = _conversion()
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
def _fill_cell(given, sides, panels, count, rule, places, sums, onset, top, power, a, b, values,
               series, terms):  # fmt: skip
    """Fill series of all columns between two gaps; their last terms over the largest value."""
    keep_apart()
    by_sums = has_powers(given, 0)
    rooted = a + b > top
    low, high = (math.sqrt(top - b), math.sqrt(max(top - a, 0.0))) if rooted else (a, b)
    for j in range(OF_CELL):
        place = low + 0.5 * (high - low) * (1 + places[0, j])
        gap = top - place * place if rooted else place
        for k in range(10):
            terms[k] = 0.0
        if by_sums:
            add_between(given, sides, panels, 0, count, gap, sums, onset, terms)
        elif not add_plane(given, sides, panels, 0, count, gap, rule, terms):
            return math.nan
        over = (top - gap) ** (-0.5 * power) if rooted else 1.0
        for k in range(COLUMNS - 1):
            values[k, j] = terms[F_SA + k] * over
        if rooted and given[0, SHADOW] == PROJECTED:
            over *= (top - gap) / top  # all of a size is dark once it is touched
        values[COLUMNS - 1, j] = terms[F_SA + COLUMNS - 1] * over
    worst = wide = load = 0.0
    for j in range(OF_CELL):
        load = max(load, abs(values[0, j]))
        for k in range(1, COLUMNS):
            wide = max(wide, abs(values[k, j]))
    for k in range(COLUMNS):
        transform(places, values[k], series[k])
        most, left = wide if k > 0 else load, abs(series[k, OF_CELL - 1])
        left += abs(series[k, OF_CELL - 2])
        for j in range(POWER_TERMS, OF_CELL):
            left += LEAVES[j] * abs(series[k, j])
        if most > 0:
            worst = max(worst, left / most)
    return worst


@scalar
def _keep_cell(top, a, b, series, cells, found):
    """Keep the parts of a cell, from its largest gap down."""
    keep_apart()
    rooted = a + b > top
    low, high = (math.sqrt(top - b), math.sqrt(max(top - a, 0.0))) if rooted else (a, b)
    ends = b
    for m in range(CUTS):
        part = m if rooted else CUTS - 1 - m
        cell, step = cells[found + m], (high - low) / CUTS
        cell[ROOTED] = 1.0 if rooted else 0.0
        cell[START], cell[RATE] = low + (part + 0.5) * step, 2 / step
        edge = low + (part + (1 if rooted else 0)) * step
        cell[UNTIL] = ends
        ends = top - edge * edge if rooted else edge
        if m == CUTS - 1:
            ends = a
        cell[FROM] = ends
        for j in range(POWER_TERMS):
            for k in range(COLUMNS):
                total = 0.0
                for i in range(OF_CELL):
                    total += CONVERT[part, j, i] * series[k, i]
                place = 2 * j + (1 if k > 0 else 0)
                if 0 < k < COLUMNS - 1:
                    place = 2 * POWER_TERMS + 4 * j + k - 1
                cell[POWERS + place] = total


@scalar
def _note(edges, count, gap, low, high):
    """Note a gap at which a cell ends, in falling order."""
    keep_apart()
    if not low < gap < high or count == len(edges):
        return count
    place = count
    while place > 0 and edges[place - 1] < gap:
        place -= 1
    if place > 0 and edges[place - 1] - gap < 1e-12 * high:
        return count
    if place < count and gap - edges[place] < 1e-12 * high:
        return count
    for j in range(count, place, -1):
        edges[j] = edges[j - 1]
    edges[place] = gap
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
def _middle(a, b, high):
    """The middle of a cell in its variable."""
    if a + b <= high:
        return 0.5 * (a + b)
    return high - 0.25 * (math.sqrt(high - a) + math.sqrt(high - b)) ** 2


@scalar
def lay_gaps(given, sides, panels, count, rule, places, finest, settled, cells, floor, edges,
             values, series, terms, some, sums, onset):  # fmt: skip
    """Lay cells over the gap, from the largest size down; how many, and what they leave out.

    −1 where there is no room, and 0 where particles are squeezed by more than their size.
    """
    keep_apart()
    low, high, last = given[0, SMALLEST], given[0, HIGH], panels[0, count - 1, TO]
    power = 2.0 if given[0, KIND] == ONE_SIZE else 4.0
    if last >= 1:
        return 0, 0.0
    bottom = low * (1 - last)
    edges[0], marked = high, 1
    for n in range(count + 1):
        eps = panels[0, n, EDGE] if n < count else last
        # an end of panels alone: the formula is the same behind it
        alone = 0 < n < count and panels[0, n, ONE] < 0
        if alone and (given[0, EQUAL] == 1 or not _differs(given, sides, panels, n)):
            continue
        marked = _note(edges, marked, low * (1 - eps), bottom, high)
        marked = _note(edges, marked, high * (1 - eps), bottom, high)
    marked = _note(edges, marked, 0.5 * high, bottom, high)
    if marked >= len(edges) - 1:
        return -1, 0.0
    edges[marked] = bottom
    for k in range(10):
        terms[k] = 0.0
    # of one size, what all are squeezed beyond begins below the last panel
    add_plane(given, sides, panels, 0, count, bottom * (1 - BELOW), rule, terms)
    for k in range(COLUMNS):
        floor[k] = terms[F_SA + k]
    found, n, many, worst = 0, 0, 1, 0.0
    if has_powers(given, 0):
        worst = sum_panels(given, sides, panels, 0, some, count, finest, sums)
        sum_onset(given, sides, panels, 0, onset)
    while n < marked:
        # where formulas change little at their ends, one series does over several of them
        b, last_n, alone = edges[n], min(n + many, marked), False
        a = edges[last_n]
        while True:
            if found + CUTS > MOST_CELLS:
                return -1, 0.0
            left = _fill_cell(
                given, sides, panels, count, rule, places, sums, onset, high, power, a, b, values,
                series, terms,
            )  # fmt: skip
            if left != left:
                return -1, 0.0
            if left > settled and b - a > THINNEST * high:
                if last_n > n + 1:
                    last_n = many = n + (last_n - n) // 2
                    many -= n
                    a = edges[last_n]
                else:
                    alone = True
                    a = _middle(a, b, high)
                continue
            worst = max(worst, left)
            _keep_cell(high, a, b, series, cells, found)
            found += CUTS
            if a <= edges[last_n]:
                break
            a, b = max(edges[last_n], a - 2 * (b - a)), a
        many = 1 if alone else min(2 * many, 2)
        n = last_n
    return found, worst


@scalar
def _add_gaps(section, cells, floor, whole, nodes, columns):
    """Add sums of the columns over the nodes, or of load and shadow, and the load at each."""
    keep_apart()
    count, gap, mass, loads = int(section[CELLS]), nodes[GAP], nodes[MASS], nodes[LOADS]
    top, bottom, squared = cells[0, UNTIL], cells[count - 1, FROM], section[POWER] == 4
    darker = section[DARKER] == 1
    s_0 = s_1 = s_2 = s_3 = s_4 = s_5 = 0.0
    n = 0
    for j in range(PLACES):
        g, m, load = gap[j], mass[j], 0.0
        if g < bottom:
            load = floor[0]
            s_1 += m * floor[1]
            s_2 += m * floor[2]
            s_3 += m * floor[3]
            s_4 += m * floor[4]
            s_5 += m * floor[5]
        elif g < top:
            while g < cells[n, FROM]:
                n += 1
            while g >= cells[n, UNTIL]:
                n -= 1
            cell, v, over, dark = cells[n], g, 1.0, 1.0
            if cell[ROOTED] == 1:
                over = top - g
                v = math.sqrt(over)
                dark = top if darker else over
                if squared:
                    dark *= over
                    over *= over
            x = cell[RATE] * (v - cell[START])
            a_0, a_5 = cell[POWERS], cell[POWERS + 1]
            for k in range(1, POWER_TERMS):
                i = POWERS + 2 * k
                a_0, a_5 = a_0 * x + cell[i], a_5 * x + cell[i + 1]
            load = max(over * a_0, 0.0)
            over *= m
            s_5 += max(m * dark * a_5, 0.0)
            if whole:
                a_1, a_2, a_3, a_4 = cell[AREAS], cell[AREAS + 1], cell[AREAS + 2], cell[AREAS + 3]
                for k in range(1, POWER_TERMS):
                    i = AREAS + 4 * k
                    a_1, a_2 = a_1 * x + cell[i], a_2 * x + cell[i + 1]
                    a_3, a_4 = a_3 * x + cell[i + 2], a_4 * x + cell[i + 3]
                s_1 += max(over * a_1, 0.0)
                s_2 += max(over * a_2, 0.0)
                s_3 += max(over * a_3, 0.0)
                s_4 += max(over * a_4, 0.0)
        loads[j] += load
        s_0 += m * load
    columns[0] += s_0
    columns[1] += s_1
    columns[2] += s_2
    columns[3] += s_3
    columns[4] += s_4
    columns[5] += s_5


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
def _first_squeezed(seat, h, u, rise, guess):
    """The lowest ground on which the largest particle is squeezed [σ].

    No ground is pressed down by more than ``rise``.
    """
    keep_apart()
    low, high = seat[MEAN] - REACH * seat[SPREAD], seat[MEAN] + REACH * seat[SPREAD]
    lack = h - seat[TOP]
    if lack - high > rise:
        return high
    if guess == guess:  # from one that is near; the ground is far less steep than ζ
        a, f_a = guess, lack - guess + _ground_at(u, guess)
        b = a + f_a
        for _ in range(12):
            f_b = lack - b + _ground_at(u, b)
            if abs(f_b) <= SET_IN:
                return b if low < b < high else math.nan
            slope = (f_b - f_a) / (b - a)
            if not -3 < slope < -0.3:
                break
            a, f_a, b = b, f_b, b - f_b / slope
            if a == b:
                return b if low < b < high else math.nan
    step, left, f_left = (high - low) / (GRID - 1), low, lack - low + _ground_at(u, low)
    if f_left < 0:
        return low
    for k in range(1, GRID):
        right = low + k * step
        f_right = lack - right + _ground_at(u, right)
        if f_right < 0:
            side = 0
            for _ in range(60):
                zeta = (left * f_right - right * f_left) / (f_right - f_left)
                f = lack - zeta + _ground_at(u, zeta)
                if abs(f) <= SET_IN:
                    return zeta
                if f < 0:
                    f_left *= 0.5 if side == 1 else 1.0
                    right, f_right, side = zeta, f, 1
                else:
                    f_right *= 0.5 if side == -1 else 1.0
                    left, f_left, side = zeta, f, -1
            return zeta
        left, f_left = right, f_right
    return high


@exact
def _place_heights(right, span, mean, width, zeta, cut, mass):
    """Heights of the nodes, those within the heights of the ground, and weights dN."""
    norm = 2 * span / (width * ROOT_2PI)
    for j in range(PLACES):
        zeta[j] = right + span * ROOTS[j] * ROOTS[j]
        cut[j] = min(max(zeta[j], -HIGHEST_SEAT), HIGHEST_SEAT)
        z = (zeta[j] - mean) / width
        mass[j] = norm * ROOTS[j] * WEIGHTS[j] * exp(-0.5 * z * z)


@exact
def _find_gaps(h, sigma, p, zeta, cut, gap):
    """Gaps of nodes on ground that is a polynomial of the height."""
    p_0, p_1, p_2, p_3, p_4, p_5, p_6 = p[0], p[1], p[2], p[3], p[4], p[5], p[6]
    p_7, p_8, p_9, p_10, p_11, p_12 = p[7], p[8], p[9], p[10], p[11], p[12]
    for j in range(PLACES):
        x = cut[j]
        u = (((p_12 * x + p_11) * x + p_10) * x + p_9) * x + p_8
        u = ((((u * x + p_7) * x + p_6) * x + p_5) * x + p_4) * x + p_3
        gap[j] = sigma * (h - zeta[j] + ((u * x + p_2) * x + p_1) * x + p_0)


@summed
def _take_powers(mass, load, cut, p):
    """Sums of the loads times powers of the height."""
    s_0 = s_1 = s_2 = s_3 = s_4 = s_5 = s_6 = s_7 = s_8 = s_9 = s_10 = s_11 = s_12 = 0.0
    for j in range(PLACES):
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
def _weigh_seat(field, seat, h, right, nodes, found, columns, whole):
    """Add what the particles of a seat carry to the loads' moments and the shadow.

    From the lowest ground on which one is squeezed; their columns by themselves.
    """
    keep_apart()
    own, sections, cells, floor = field[0], field[2], field[6], field[7]
    for c in range(COLUMNS):
        columns[c] = 0.0
    span = max(seat[MEAN] + REACH * seat[SPREAD] - right, 0.0)
    if span == 0:
        return
    zeta, cut, gap, mass = nodes[ZETA], nodes[CUT], nodes[GAP], nodes[MASS]
    p, loads = nodes[SUMS], nodes[LOADS]
    _place_heights(right, span, seat[MEAN], seat[SPREAD], zeta, cut, mass)
    _find_gaps(h, own[SIGMA], nodes[POLYNOMIALS], zeta, cut, gap)
    for j in range(PLACES):
        loads[j] = 0.0
    for s in range(int(seat[SECTION]), int(seat[LAST_SECTION])):
        _add_gaps(sections[s], cells[s], floor[s], whole, nodes, columns)
    _take_powers(mass, loads, cut, p)
    over = seat[DENSE] / own[UNIT]
    for n in range(BETA):
        for k in range(n + 1):
            found[n] += over * HERMITE[n, k] * p[k]
    found[BETA] += seat[DENSE] * columns[COLUMNS - 1]


@scalar
def weigh_ground(field, h, u, lowest, nodes, found, columns, whole):
    """Loads' moments and the shadow at h [σ] on ground u, and all columns if the whole is asked.

    ``lowest`` holds guesses of the lowest ground on which a particle of each seat is squeezed, and
    gets that.
    """
    keep_apart()
    seats, p, rise = field[1], nodes[POLYNOMIALS], 0.0
    for n in range(BETA):
        found[n] = p[n] = 0.0
        rise += TALLEST[n] * abs(u[n])
        for k in range(n, BETA):
            p[n] += HERMITE[k, n] * u[k]
    found[BETA] = 0.0
    for s in range(len(seats)):
        right = _first_squeezed(seats[s], h, u, rise, math.nan if whole else lowest[s])
        if right != right:
            right = _first_squeezed(seats[s], h, u, rise, math.nan)
        lowest[s] = right
        _weigh_seat(field, seats[s], h, right, nodes, found, columns[s], whole)


@scalar
def round_of(field, h, state, lift, lowest, small, nodes, found, columns, whole):
    """β_n and the shadow again, from those and the lift before, at h [σ].

    The lift and how far it is off; ``lowest`` as in `weigh_ground`.
    """
    keep_apart()
    own, _, _, kernels, skin, surface, _, _ = field
    w, off = lift_of(own, kernels, skin, surface, h, state, lift, small)
    # the rows hold what asperities do a last step before, some 1e-13 of σ away
    bare, u = 1 - min(max(state[BETA], 0.0), 1.0), small[U]
    for n in range(BETA):
        u[n] = WAVES * (bare * small[PRESSED, n] + kernels[K_PP + n] * state[n])
    weigh_ground(field, h, u, lowest, nodes, found, columns, whole)
    return w, off
