"""Particles of broad sizes on a rough seat: what they carry under a gap, weighed with the seat.

Under a gap t the sizes t/(1 − ε) are squeezed by ε. Numbers that grow like a power of the size,
norm (x/x_1)^(−n) between x_1 and x_2, then carry a difference of one sum over the squeeze,

    L(t) = norm x_1³ (t/x_1)^(3 − n) [Q(1 − t/x_2) − Q(1 − t/x_1)],
    Q(ε) = ∫_0^ε q(e) (1 − e)^(n − 4) de,

where q is what a particle of unit size carries: no node is spent on sizes, however broad they are
against the seat. Q is a series on each panel, once a state. L(t) stands at nodes of cells over t,
which end where a panel of either end of the sizes does; they are filled where a separation looks,
and every separation costs the density of the seat there.
"""

from __future__ import annotations

import math

import numpy as np

from ...numerics.chebyshev import chebyshev_transform
from ...numerics.quadrature import gauss_legendre
from ..compiled.machine import exp, keep_apart
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    EDGE,
    MASS,
    OFF,
    OTHER,
    REGIME,
    ROOM,
    SLOPE,
    TO,
    transform,
)
from .curves import LOAD as CARRIED
from .fields import (
    A_SA,
    A_SA2,
    BREAKS,
    COVERED,
    DENSITY,
    EQUAL,
    F_SA,
    FOOTPRINT,
    HALF_NODES,
    HALF_RULE,
    HIGH,
    KIND,
    LOW,
    NORM,
    NOTHING,
    PANEL_NODES,
    PANEL_RULE,
    PANEL_SPAN,
    POWER,
    ROUGH,
    SEAT,
    SHADE,
    SHADOW,
    SIZE_1,
    SIZE_2,
    UNIFORM,
    WIDTH,
)
from .laid import COUNT, PIECE_BEGIN, SIZED, SIZED_END
from .nodes import CUBIC, FLATTENED, LINEAR, LOGARITHMIC, ROOTED, is_plain, place_nodes, variable_of
from .seats import (
    CELLS,
    COLUMNS,
    EPS,
    FIRST,
    FROM,
    LARGER,
    LOAD,
    MOST_NODES,
    NARROW_SEAT,
    NEAR_END,
    NODE,
    NODE_END,
    ONSET,
    PARTS,
    REACH,
    SECOND,
    SLOTS,
    SUM,
    UNTIL,
)
from .shares import fill_particles
from .sides import exact, scalar
from .skins import ROOT_2PI
from .sums import above, add_last, lay_sizes
from .vectors import ln

__all__ = [
    "SUMS",
    "TERMS",
    "add_below",
    "add_between",
    "fill_gaps",
    "goes_by_gaps",
    "has_powers",
    "lay_cells",
    "sum_onset",
    "sum_panels",
]

TERMS = 32
"""Of a series of sums: as many as the finest polynomial over a seat has nodes."""
BEFORE, SECOND_LARGER, VARIABLE, START, RATE, OF_LOAD = 0, 6, 7, 8, 9, 10
"""Of the sums on a panel: what its columns have before it, in the order of the nodes; whether the
area on the second surface is the larger; variable of its series, where that starts and its rate."""
OF_AREA_1, OF_AREA_2, SUMS = (
    OF_LOAD + TERMS + 1,
    OF_LOAD + 2 * (TERMS + 1),
    OF_LOAD + 3 * (TERMS + 1),
)
"""Series of load and areas, from the start of the panel."""
BROAD, STEEP = 3.0, 2.0
"""Difference of the largest and the smallest size over the width of the seat, at least; ratio of
1 − ε at the ends of a panel up to which every variable does for a power of it."""
ONE, TWO = NODE, NODE_END
"""Of segments, more: the panels of the smallest and of the largest size there."""


def _onset_matrix() -> tuple[np.ndarray, np.ndarray]:
    """Places of w(u), u from 0 to 1, and from w there to terms of the series ∫_0^1 v³ w(u v) dv."""
    x, series = chebyshev_transform(TERMS)
    nodes, weights = gauss_legendre(TERMS)
    v = 0.5 * (1 + nodes)
    angle = np.arccos(np.clip((1 + x[:, None]) * v - 1, -1.0, 1.0))
    terms = np.cos(np.arange(TERMS) * angle[:, :, None])
    return x, series @ np.einsum("v,jvm->jm", 0.5 * weights * v**3, terms) @ series


PLACES_OF_ONSET, FROM_ONSET = _onset_matrix()


@scalar
def has_powers(parts, p):
    """Whether the sizes of part p are a power, and its shadow is part of what is summed."""
    kind, shadow = parts[p, KIND], parts[p, SHADOW]
    shades = shadow in (FOOTPRINT, COVERED, NOTHING)
    return shades and kind in (POWER, UNIFORM)


@scalar
def goes_by_gaps(given, panels, p, count):
    """Whether part p is summed over gaps."""
    keep_apart()
    if given[p, SEAT] != ROUGH or given[p, BREAKS] == 1 or not has_powers(given, p):
        return False
    broad = given[p, HIGH] - given[p, LOW] > BROAD * given[p, WIDTH]
    return broad and panels[p, count - 1, TO] < 1 and 2 * SLOTS * len(given) <= MOST_NODES


@scalar
def _exponent(given, p):
    """n of numbers per size that go like x^(−n)."""
    return given[p, SIZE_2] if given[p, KIND] == POWER else 0.0


@scalar
def _variable_of(given, panels, p, n):
    """Variable of panel n in which a power of 1 − ε is smooth too."""
    a, b = panels[p, n, EDGE], panels[p, n, TO]
    variable = variable_of(given, panels, p, n)
    bends = a > 0 and 1 - a > STEEP * (1 - b)
    return LOGARITHMIC if bends and variable in (LINEAR, CUBIC) else variable


@exact
def _weigh_squeezes(power, at, mass, weighed):
    """Weights of nodes over ε times a power of 1 − ε."""
    for j in range(len(at)):
        weighed[j] = mass[j] * exp(power * ln(1 - at[j]))


@scalar
def _sum_row(rule, values, mass, weighed, terms, series):
    """Series of the integral from the start of a panel of what has these values at its places.

    The integral over the panel, and what the series leaves out of it, at most.
    """
    start = whole = 0.0
    for j in range(TERMS):
        weighed[j] = values[j] * mass[j]
    transform(rule, weighed, terms)
    for k in range(1, TERMS + 1):
        below = terms[k - 1] * (2 if k == 1 else 1)
        series[k] = (below - (terms[k + 1] if k + 1 < TERMS else 0.0)) / (2 * k)
        start += series[k] * (1 if k % 2 == 1 else -1)
        whole += series[k]
    series[0] = start
    return whole + start, (abs(terms[TERMS - 1]) + abs(terms[TERMS - 2])) / TERMS


@scalar
def _place_of(variable, eps):
    """A squeeze in the variable of a panel."""
    if variable == ROOTED:
        return math.sqrt(eps)
    if variable == CUBIC:
        return eps ** (1 / 3)
    if variable == LOGARITHMIC:
        return math.log(eps / (1 - eps))
    if variable == FLATTENED:
        return -math.log(1 - eps)
    return eps


@scalar
def _sum_panel(parts, panels, p, q, n, rule, sums):
    """Fill in Q of part q on panel n, from what stands at its nodes in the room of part p.

    What its series leave out, at most.
    """
    keep_apart()
    room, row, following = panels[p, len(panels[p]) - ROOM :], sums[q, n], sums[q, n + 1]
    mass, weighed, series = room[OFF, :TERMS], room[OTHER, :TERMS], room[SLOPE, :TERMS]
    _weigh_squeezes(_exponent(parts, q) - 4, room[AT, :TERMS], room[MASS, :TERMS], mass)
    variable = _variable_of(parts, panels, p, n)
    row[VARIABLE], row[START] = variable, _place_of(variable, panels[p, n, EDGE])
    row[RATE] = 2 / (_place_of(variable, panels[p, n, TO]) - row[START])
    middle = TERMS // 2
    row[SECOND_LARGER] = 1.0 if room[AREA_2, middle] > room[AREA_1, middle] else 0.0
    load, left = _sum_row(
        rule, room[CARRIED, :TERMS], mass, weighed, series, row[OF_LOAD:OF_AREA_1]
    )
    worst = left / (row[BEFORE] + load)
    one, left = _sum_row(
        rule, room[AREA_1, :TERMS], mass, weighed, series, row[OF_AREA_1:OF_AREA_2]
    )
    worst = max(worst, left / (row[BEFORE + SECOND - LOAD] + one))
    two = one
    if parts[p, EQUAL] == 1:
        for k in range(TERMS + 1):
            row[OF_AREA_2 + k] = row[OF_AREA_1 + k]
    else:
        two, left = _sum_row(rule, room[AREA_2, :TERMS], mass, weighed, series, row[OF_AREA_2:SUMS])
        worst = max(worst, left / (row[BEFORE + SECOND - LOAD] + two))
    for k in range(COLUMNS):
        following[BEFORE + k] = row[BEFORE + k]
    following[BEFORE] += load
    following[BEFORE + SECOND - LOAD] += two
    if parts[p, SHADOW] == FOOTPRINT:
        following[BEFORE + LARGER - LOAD] += two if row[SECOND_LARGER] == 1 else one
    following[BEFORE + FIRST - LOAD + int(panels[p, n, REGIME])] += one
    return worst


@scalar
def sum_panels(given, sides, panels, p, some, count, rule, sums):
    """Fill in Q on every panel of those parts of which ``some`` (P,) says p: p and its twins.

    What their series leave out, at most, over all so far.
    """
    keep_apart()
    worst, room = 0.0, panels[p, len(panels[p]) - ROOM :]
    at, mass, ones = room[AT, :TERMS], room[MASS, :TERMS], room[SLOPE, :TERMS]
    for q in range(p, len(some)):
        for k in range(COLUMNS if some[q] == p else 0):
            sums[q, 0, BEFORE + k] = 0.0
    for n in range(count):
        a, b, variable = panels[p, n, EDGE], panels[p, n, TO], _variable_of(given, panels, p, n)
        for j in range(TERMS):
            ones[j] = 1.0
        place_nodes(variable, 1.0, a, b, rule[0, :TERMS], ones, at, mass)
        fill_particles(given, sides, panels, p, n, TERMS)
        for q in range(p, len(some)):
            if some[q] == p:
                worst = max(worst, _sum_panel(given, panels, p, q, n, rule, sums))
    return worst


@scalar
def sum_onset(parts, sides, panels, p, onset):
    """Series of Q(ε)/ε² of part p on the first panel, for load and both areas.

    Q sets in like ε^2.5 for a load and like ε² for an area: with a series of Q itself, digits of
    what is hardly squeezed are lost.
    """
    keep_apart()
    room, power = panels[p, len(panels[p]) - ROOM :], _exponent(parts, p) - 4
    at, mass, last = room[AT, :TERMS], room[MASS, :TERMS], panels[p, 0, TO]
    for j in range(TERMS):
        at[j] = 0.25 * last * (1 + PLACES_OF_ONSET[j]) ** 2
    fill_particles(parts, sides, panels, p, 0, TERMS)
    for j in range(TERMS):
        mass[j] = 2 * math.exp(power * math.log(1 - at[j])) / at[j]
    for k in range(3):
        values = room[CARRIED + k, :TERMS]  # load, then the areas
        for i in range(TERMS):
            total = 0.0
            for j in range(TERMS):
                total += FROM_ONSET[i, j] * mass[j] * values[j]
            onset[k * TERMS + i] = total


@scalar
def _read_three(series, first, second, third, count, x):
    """Three series of so many terms at a place."""
    b_1, c_1, b_2, c_2, b_3, c_3, twice = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2 * x
    for k in range(count - 1, 0, -1):
        b_1, c_1 = series[first + k] + twice * b_1 - c_1, b_1
        b_2, c_2 = series[second + k] + twice * b_2 - c_2, b_2
        b_3, c_3 = series[third + k] + twice * b_3 - c_3, b_3
    one = series[first] + x * b_1 - c_1
    return one, series[second] + x * b_2 - c_2, series[third] + x * b_3 - c_3


@scalar
def _add_to_end(parts, panels, p, count, eps, factor, sums, onset, out):
    """Add Q(ε) of part p times a factor, up to the last panel."""
    keep_apart()
    n = count - count  # no constant, for which numba would compile twice
    while n < count and eps > panels[p, n, TO]:
        n += 1
    row, shadow = sums[p, n], parts[p, SHADOW]
    out[F_SA] += factor * row[BEFORE]
    out[A_SA2] += factor * row[BEFORE + SECOND - LOAD]
    out[SHADE] += factor * row[BEFORE + LARGER - LOAD]
    for k in range(3):
        out[A_SA + k] += factor * row[BEFORE + FIRST - LOAD + k]
    if n == count:
        return
    if n == 0:
        x = 2 * math.sqrt(eps / panels[p, 0, TO]) - 1
        load, one, two = _read_three(onset, 0, TERMS, 2 * TERMS, TERMS, x)
        squared = eps * eps
        load, one, two = squared * load, squared * one, squared * two
    else:
        x = row[RATE] * (_place_of(row[VARIABLE], eps) - row[START]) - 1
        load, one, two = _read_three(row, OF_LOAD, OF_AREA_1, OF_AREA_2, TERMS + 1, x)
    out[F_SA] += factor * load
    out[A_SA2] += factor * two
    out[A_SA + int(panels[p, n, REGIME])] += factor * one
    if shadow == FOOTPRINT:
        out[SHADE] += factor * (two if row[SECOND_LARGER] == 1 else one)


@scalar
def add_between(parts, sides, panels, p, count, gap, sums, onset, out):
    """What part p carries on a plane, as `add_plane` does, by the sums over the squeeze."""
    keep_apart()
    low, high, middle = parts[p, LOW], parts[p, HIGH], parts[p, SIZE_1]
    if gap >= high:
        return
    n, norm = _exponent(parts, p), parts[p, DENSITY] * parts[p, NORM]
    factor = norm * middle**3 * math.exp((3 - n) * math.log(gap / middle))
    _add_to_end(parts, panels, p, count, (high - gap) / high, factor, sums, onset, out)
    if gap < low:
        _add_to_end(parts, panels, p, count, (low - gap) / low, -factor, sums, onset, out)
    begin = max(low, gap / (1 - panels[p, count - 1, TO]))
    if begin < high:  # squeezed beyond the last panel: ∫ x^(2 − n) dx
        over = math.log(high / begin)
        rise = (3 - n) * over
        squares = over * (math.expm1(rise) / rise if rise != 0 else 1.0)
        squared = norm * middle**3 * math.exp((3 - n) * math.log(begin / middle)) * squares
        add_last(parts, sides, panels, p, count, squared, out)


# ------------------------------------------------------------------------------ cells
@scalar
def lay_cells(given, panels, p, count, grid, own, sizes, size, rule):
    """Lay the segments of part p over the gap, in which it stays on one panel of either end.

    Where they and the sizes behind the last panel end; −1 for segments where there is no room.
    """
    keep_apart()
    low, high, step = given[p, LOW], given[p, HIGH], rule[0, PANEL_SPAN] * given[p, WIDTH]
    thin, piece, cells = 1 - panels[p, count - 1, TO], own[PIECE_BEGIN], 0.0
    one, two, a = count - 1, count, low * thin
    while two >= 0:
        # sizes of either end come to the next panel, the largest first from behind the last
        end_1 = low * (1 - panels[p, one, EDGE]) if one >= 0 else math.inf
        end_2 = high * (1 - panels[p, two, EDGE] if two < count else thin)
        b = min(end_1, end_2)
        if b > a:
            if piece == MOST_NODES:
                return -1, size
            near = one == 0 or (one < 0 and two == 0)
            parts = max(1, math.ceil((b - a) / (ONSET * step if near else step) - 1e-9))
            grid[FROM, piece], grid[UNTIL, piece], grid[PARTS, piece] = a, b, parts
            grid[ONE, piece], grid[TWO, piece], grid[CELLS, piece] = one, two, cells
            cells += parts
            piece += 1
            a = b
        one -= 1 if end_1 <= b else 0
        two -= 1 if end_2 <= b else 0
    return piece, lay_sizes(given, p, sizes, size, rule, thin)


@exact
def _find_places(variable, start, rate, eps, x):
    """Places, from −1 to 1, of squeezes in the variable of a panel."""
    if variable == ROOTED:
        for j in range(len(eps)):
            x[j] = math.sqrt(max(eps[j], 0.0))
    elif variable == CUBIC:
        for j in range(len(eps)):
            x[j] = exp(ln(eps[j]) / 3)
    elif variable == LOGARITHMIC:
        for j in range(len(eps)):
            x[j] = ln(eps[j] / (1 - eps[j]))
    elif variable == FLATTENED:
        for j in range(len(eps)):
            x[j] = -ln(1 - eps[j])
    else:
        for j in range(len(eps)):
            x[j] = eps[j]
    for j in range(len(eps)):
        x[j] = rate * (x[j] - start) - 1


@exact
def _read_sums(own, x, load, one, two):
    """Series of a panel at places."""
    first, second = own[OF_LOAD:OF_AREA_1], own[OF_AREA_1:OF_AREA_2]
    third = own[OF_AREA_2:SUMS]
    for j in range(len(x)):
        place = x[j]
        b_1, c_1, b_2, c_2, b_3, c_3, twice = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2 * place
        for k in range(TERMS):
            b_1, c_1 = first[TERMS - k] + twice * b_1 - c_1, b_1
            b_2, c_2 = second[TERMS - k] + twice * b_2 - c_2, b_2
            b_3, c_3 = third[TERMS - k] + twice * b_3 - c_3, b_3
        load[j] = first[0] + place * b_1 - c_1
        one[j] = second[0] + place * b_2 - c_2
        two[j] = third[0] + place * b_3 - c_3


@exact
def _add_sums(own, sign, regime, dark, load, one, two, grid, begin, end):
    """Add Q to the columns of nodes."""
    for k in range(COLUMNS):
        column, before = grid[LOAD + k, begin:end], sign * own[BEFORE + k]
        for j in range(len(column)):
            column[j] += before
    larger = two if own[SECOND_LARGER] == 1 else one
    to_load, to_second = grid[LOAD, begin:end], grid[SECOND, begin:end]
    to_larger, to_first = grid[LARGER, begin:end], grid[FIRST + regime, begin:end]
    for j in range(len(to_load)):
        to_load[j] += sign * load[j]
        to_second[j] += sign * two[j]
        to_larger[j] += sign * dark * larger[j]
        to_first[j] += sign * one[j]


@exact
def _take_gaps(norm, middle, power, unit, at, mass, grid, begin, end):
    """Columns of nodes times the numbers of sizes there, and the gaps in the place of squeezes."""
    own, factor = grid[EPS, begin:end], grid[SUM, begin:end]
    for j in range(len(own)):
        own[j] = unit * (1 - at[j])
        factor[j] = norm * middle**3 * unit * mass[j] * exp(power * ln(own[j] / middle))
    for k in range(COLUMNS):
        column = grid[LOAD + k, begin:end]
        for j in range(len(column)):
            column[j] *= factor[j]


@scalar
def _add_end(given, sides, panels, p, n, sign, size, own_size, sums, grid, begin, end):
    """Add Q where sizes of one end are on panel n, at the nodes over ε of one end of the sizes."""
    keep_apart()
    room, count = panels[p, len(panels[p]) - ROOM :], end - begin
    at, eps, x = room[AT, :count], room[OTHER, :count], room[OFF, :count]
    for j in range(count):
        eps[j] = at[j] if size == own_size else 1 - own_size * (1 - at[j]) / size
    own = sums[p, n]
    _find_places(own[VARIABLE], own[START], own[RATE], eps, x)
    load, one, two = room[CARRIED, :count], room[AREA_1, :count], room[AREA_2, :count]
    _read_sums(own, x, load, one, two)
    dark = 1.0 if given[p, SHADOW] == FOOTPRINT else 0.0
    _add_sums(own, sign, int(panels[p, n, REGIME]), dark, load, one, two, grid, begin, end)


@scalar
def fill_gaps(given, sides, panels, p, count, grid, s, a, b, place, rule, sums):
    """Fill the nodes of a cell of segment s between two gaps; where they end."""
    keep_apart()
    one, two, low, high = int(grid[ONE, s]), int(grid[TWO, s]), given[p, LOW], given[p, HIGH]
    # nodes lie as the end that is squeezed last wants them
    n, size = (one, low) if one >= 0 else (two, high)
    first, last, variable = 1 - b / size, 1 - a / size, LINEAR
    few = b - a <= NARROW_SEAT * given[p, WIDTH]
    if n < count:
        first, last = max(first, panels[p, n, EDGE]), min(last, panels[p, n, TO])
        variable = _variable_of(given, panels, p, n)
        few &= is_plain(given, panels, p, n) and (first == 0 or last <= NEAR_END * first)
    few &= two == count or is_plain(given, panels, p, two)
    row, nodes = (HALF_RULE, HALF_NODES) if few else (PANEL_RULE, PANEL_NODES)
    nodes, room = int(rule[0, nodes]), panels[p, len(panels[p]) - ROOM :]
    at, mass, end = room[AT, :nodes], room[MASS, :nodes], place + nodes
    place_nodes(
        variable, 1.0, first, last, rule[row, :nodes], rule[row + 1, :nodes], at,
        mass,
    )  # fmt: skip
    for k in range(COLUMNS):
        column = grid[LOAD + k, place:end]
        for j in range(nodes):
            column[j] = sums[p, count, BEFORE + k] if two == count else 0.0
    if two < count:
        _add_end(given, sides, panels, p, two, 1.0, high, size, sums, grid, place, end)
    if one >= 0:
        _add_end(given, sides, panels, p, one, -1.0, low, size, sums, grid, place, end)
    _take_gaps(
        given[p, NORM] / (ROOT_2PI * given[p, WIDTH]), given[p, SIZE_1], 3 - _exponent(given, p),
        size, at, mass, grid, place, end,
    )  # fmt: skip
    return end


@scalar
def add_below(given, sides, panels, p, own, sizes, gap, out):
    """What particles carry at a gap that are squeezed further than the last panel goes."""
    keep_apart()
    count, width = own[COUNT], given[p, WIDTH]
    thin, squared = 1 - panels[p, count - 1, TO], 0.0
    if given[p, HIGH] * thin > gap - REACH * width:
        for j in range(own[SIZED], own[SIZED_END]):
            x = sizes[0, j]
            squared += sizes[1, j] * x * x * above((x * thin - gap) / width)
        add_last(given, sides, panels, p, count, given[p, DENSITY] * squared, out)
