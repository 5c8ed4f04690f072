"""Particles that break and their fragments under one gap, and under a seat narrow against them.

Under a gap t sizes x = t e^u are squeezed by 1 − e^(−u), and the parent of a fragment lies a step
of −ln κ further in u, for whatever t. Nodes between 0 and −ln κ therefore stand for all
generations: from the largest sizes down each gives its fragments to the next,

    n_k = φ(x_k) + χκ^(−4) [1 − P(x_(k+1))] n_(k+1),    P = exp(−exp(m [ln σ̂ − ln σ_0 + b ln x])).

On a plane the gap is that of the surfaces. A rough seat weighs gaps; where it is narrow against
the sizes, what a gap carries stands at nodes of cells over t, filled where a separation looks.
"""

from __future__ import annotations

import math

from ..compiled.machine import exp, keep_apart
from .breakage import NEVER, SURELY, mark_sizes
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    EDGE,
    KINKED,
    LAST_1,
    LAST_2,
    PULLED,
    RATE,
    REGIME,
    ROOM,
    START,
    TENSION,
    TERMS,
    TO,
)
from .curves import LOAD as CARRIED
from .densities import scale_of
from .fields import (
    A_SA,
    A_SA2,
    ALL_KINKS,
    BREADTH,
    BREAKS,
    COVERAGE,
    DENSITY,
    EQUAL,
    EXPONENT,
    F_SA,
    FOOTPRINT,
    GAUSSIAN,
    HALF_NODES,
    HALF_RULE,
    HIGH,
    KEPT,
    KIND,
    LEAST,
    LIMIT,
    LN_STRENGTH,
    LOGNORMAL,
    LOW,
    MODULUS,
    NARROW_NODES,
    NARROW_RULE,
    NORM,
    PANEL_NODES,
    PANEL_RULE,
    PANEL_SPAN,
    PLANE,
    PLANE_SPAN,
    POWER,
    PRINTED,
    PROJECTED,
    RATIO,
    SEAT,
    SHADE,
    SHADOW,
    SIZE_1,
    SIZE_2,
    UNBROKEN,
    WIDTH,
)
from .laid import PIECE_BEGIN
from .seats import (
    CELLS,
    COLUMNS,
    EPS,
    FIRST,
    FROM,
    LARGER,
    LOAD,
    MOST_NODES,
    NODE,
    PARTS,
    REACH,
    SECOND,
    SLOTS,
    UNTIL,
)
from .shares import fill_particles
from .sides import exact, scalar, summed
from .skins import ROOT_2PI
from .sums import above
from .vectors import ln

__all__ = [
    "FRAGMENT_ROWS",
    "MOST_ENDS",
    "add_fragments",
    "add_lowest",
    "fill_fragments",
    "goes_by_fragments",
    "lay_fragments",
    "most_above",
    "pace_of",
]

ENDS, PHASE, PART, NUMBER, WHOLE, TENSIONS, SIZES, FOUND, FRAGMENT_ROWS = range(9)
"""Rows of what is on the way: ends of panels over u, its nodes and their weights; of one generation
numbers, the part that is whole, ln of the largest tension, and sizes; the columns of a gap."""
MOST_ENDS, MOST_GENERATIONS = 1024, 80
BROAD = 200.0
"""Largest size over the width of the seat from which on sums go by gaps."""
STEEPEST = 5.0
"""By how much the logarithm of the hazard may change over a panel because of the sizes."""
NEAR = 0.04
"""Part of a gap over which what is carried hardly rises."""
ROOTED = NODE
"""Of segments, more: whether the upper end is where sizes begin to be squeezed."""
SAME = 1e-12
"""Difference, or part of a gap, up to which two ends are one."""
SHORT, NEAR_END = 0.6, 1.3
"""Widths of the seat, and ratio of its ends, up to which fewer nodes do for a cell."""


@scalar
def goes_by_fragments(given, panels, p, count):
    """Whether part p breaks and is summed gap by gap."""
    keep_apart()
    if given[p, BREAKS] != 1 or panels[p, count - 1, TO] >= 1:
        return False
    if given[p, SEAT] == PLANE:
        return True
    return given[p, HIGH] > BROAD * given[p, WIDTH] and 2 * SLOTS * len(given) <= MOST_NODES


@scalar
def lowest_gap(given, panels, p, count):
    """Gap below which nothing changes: all is squeezed as far as it goes."""
    return given[p, LEAST] * (1 - panels[p, count - 1, TO])


@scalar
def rule_of(rule, short):
    """Row of a Gauss rule, and its nodes: where every kink ends a panel no more than elsewhere."""
    if short:
        return NARROW_RULE, int(rule[0, NARROW_NODES])
    if rule[0, ALL_KINKS] == 1:
        return HALF_RULE, int(rule[0, HALF_NODES])
    return PANEL_RULE, int(rule[0, PANEL_NODES])


# ------------------------------------------------------------------------------ under one gap
@scalar
def _note_end(ends, count, end, near):
    """Note an end between the first and the last, in increasing order, equal ones once.

    How many there are.
    """
    keep_apart()
    if not ends[0] + near < end < ends[count - 1] - near or count == len(ends):
        return count
    place = count
    while ends[place - 1] > end:
        place -= 1
    if end - ends[place - 1] < near or ends[place] - end < near:
        return count
    for j in range(count, place, -1):
        ends[j] = ends[j - 1]
    ends[place] = end
    return count + 1


@scalar
def _lay_ends(given, panels, p, count, gap, start, ends):
    """Ends of panels over u from ``start`` to one generation further; how many."""
    keep_apart()
    step = -math.log(given[p, RATIO])
    ends[0], ends[1] = 0.0, step
    number = 2
    for n in range(count):
        u = -math.log(1 - panels[p, n, TO]) - start
        if u > 0:
            number = _note_end(ends, number, u - step * math.floor(u / step), SAME)
    for which in range(3):
        x = given[p, LOW] if which == 0 else given[p, HIGH] if which == 1 else given[p, UNBROKEN]
        if x > 0:
            u = math.log(x / gap) - start
            number = _note_end(ends, number, u - step * math.floor(u / step), SAME)
    return number


@exact
def _place_phases(rooted, a, b, gauss, weights, phase, mass):
    """Nodes over u between two ends, in the root of u where the first is the onset."""
    half = 0.5 * (b - a)
    for j in range(len(gauss)):
        z = 0.5 * (1 + gauss[j])
        if rooted:
            phase[j], mass[j] = b * z * z, b * z * weights[j]
        else:
            phase[j], mass[j] = a + 2 * half * z, half * weights[j]


@exact
def _find_sizes(gap, u, phase, x, eps):
    """Sizes and squeezes of a generation."""
    for j in range(len(phase)):
        over = exp(u + phase[j])
        x[j], eps[j] = gap * over, 1 - 1 / over


@exact
def _follow(gain, number, whole):
    """Numbers of fragments of all that is not whole."""
    for j in range(len(number)):
        number[j] *= gain * (1 - whole[j])


@exact
def _add_normal(middle, width, norm, x, number):
    for j in range(len(x)):
        u = (x[j] - middle) / width
        number[j] += norm * exp(max(-0.5 * u * u, NEVER))


@exact
def _add_log_normal(middle, width, norm, x, number):
    for j in range(len(x)):
        u = ln(x[j] / middle) / width
        number[j] += norm / x[j] * exp(max(-0.5 * u * u, NEVER))


@exact
def _add_powers(middle, exponent, norm, x, number):
    for j in range(len(x)):
        number[j] += norm * exp(-exponent * ln(x[j] / middle))


@scalar
def _add_sizes(given, p, x, number):
    """Add the particles that had these sizes from the beginning."""
    keep_apart()
    kind, middle, width, norm = given[p, KIND], given[p, SIZE_1], given[p, SIZE_2], given[p, NORM]
    if kind == GAUSSIAN:
        _add_normal(middle, width, norm, x, number)
    elif kind == LOGNORMAL:
        _add_log_normal(middle, width, norm, x, number)
    elif kind == POWER:
        _add_powers(middle, width, norm, x, number)
    else:
        for j in range(len(x)):
            number[j] += norm


@exact
def _find_tensions(panel, eps, met):
    """ln σ̂ at squeezes of a panel."""
    series, begin, end = panel[TENSION : TENSION + TERMS], panel[EDGE], panel[TO]
    rate, start, held = panel[RATE], panel[START], panel[PULLED] > 0
    for j in range(len(eps)):
        place = 2 * math.sqrt(eps[j] / end) - 1 if begin == 0 else rate * ln(eps[j]) + start
        b, c, twice = 0.0, 0.0, 2 * place
        for k in range(1, TERMS):
            b, c = series[TERMS - k] + twice * b - c, b
        met[j] = series[0] if held else series[0] + place * b - c + 1.5 * ln(eps[j])


@exact
def _survive(modulus, exponent, strength, x, met, whole):
    """Parts that are whole."""
    for j in range(len(x)):
        level = modulus * (met[j] - strength + exponent * ln(x[j]))
        whole[j] = exp(-exp(min(max(level, NEVER), SURELY)))


@exact
def _weigh(mass, x, number, whole, weight):
    """Numbers of what bears times x³, for dx = x du and a load like x²."""
    for j in range(len(x)):
        weight[j] = mass[j] * number[j] * whole[j] * x[j] * x[j] * x[j]


@summed
def _sums_of(weight, load, one, two, floor, seen):
    """What weighed particles carry: load, both areas, and what casts a shadow."""
    carried = first = second = shaded = 0.0
    for j in range(len(weight)):
        carried += weight[j] * load[j]
        first += weight[j] * one[j]
        second += weight[j] * two[j]
        shaded += weight[j] * (max(max(one[j], two[j]) - floor, 0.0) + seen)
    return carried, first, second, shaded


@summed
def _total(row):
    total = 0.0
    for j in range(len(row)):
        total += row[j]
    return total


@scalar
def _panel_of(panels, p, count, eps):
    """The panel on which ε lies, or how many there are where it lies behind all."""
    n = count - count  # no constant, for which numba would compile twice
    while n < count and panels[p, n, TO] < eps:
        n += 1
    return n


@scalar
def _add_generation(given, sides, panels, p, count, n, weight, floor, seen, found):
    """Add what a generation carries on panel n, or behind all."""
    keep_apart()
    room, nodes = panels[p, len(panels[p]) - ROOM :], len(weight)
    regime = FIRST - LOAD + int(panels[p, n, REGIME])
    if n < count:
        load, one, two, shaded = _sums_of(
            weight, room[CARRIED, :nodes], room[AREA_1, :nodes], room[AREA_2, :nodes], floor, seen
        )
    else:
        total, first, second = _total(weight), panels[p, count, LAST_1], panels[p, count, LAST_2]
        most = sides[2 * p, LIMIT]
        if given[p, EQUAL] != 1:
            most = min(most, sides[2 * p + 1, LIMIT])
        load, one, two = total * most, total * first, total * second
        shaded = total * (max(max(first, second) - floor, 0.0) + seen)
    found[0] += load
    found[SECOND - LOAD] += two
    found[LARGER - LOAD] += shaded
    found[regime] += one


@scalar
def _add_panel(
    given, sides, panels, p, count, gap, start, a, b, floor, seen, rule, way, found
):  # fmt: skip
    """Add all generations of the sizes between two ends over u, from the largest down."""
    keep_apart()
    row, nodes = rule_of(rule, False)
    gauss, weights, step = rule[row, :nodes], rule[row + 1, :nodes], -math.log(given[p, RATIO])
    phase, mass, number = way[PHASE, :nodes], way[PART, :nodes], way[NUMBER, :nodes]
    whole, met, x = way[WHOLE, :nodes], way[TENSIONS, :nodes], way[SIZES, :nodes]
    room, gain = panels[p, len(panels[p]) - ROOM :], given[p, KEPT] * given[p, RATIO] ** -4
    _place_phases(a == 0 and start == 0, a, b, gauss, weights, phase, mass)
    for j in range(nodes):
        number[j], whole[j] = 0.0, 1.0
    middle, any_yet = start + 0.5 * (a + b), False
    oldest = math.floor((math.log(given[p, HIGH] / gap) - middle) / step)
    for k in range(oldest, -1, -1):
        u = middle + k * step
        size, eps = gap * math.exp(u), 1 - math.exp(-u)
        has = given[p, LOW] <= size <= given[p, HIGH]
        if not (has or any_yet):
            continue
        _find_sizes(gap, start + k * step, phase, x, room[AT, :nodes])
        _follow(gain if any_yet else 0.0, number, whole)
        if has:
            _add_sizes(given, p, x, number)
        any_yet = True
        n = _panel_of(panels, p, count, eps)
        if n < count:
            fill_particles(given, sides, panels, p, n, nodes)
            _find_tensions(panels[p, n], room[AT, :nodes], met)
        else:
            last = panels[p, count - 1]
            room[AT, 0] = last[TO]
            _find_tensions(last, room[AT, :1], met[:1])
            for j in range(1, nodes):
                met[j] = met[0]
        if size <= given[p, UNBROKEN]:
            for j in range(nodes):
                whole[j] = 1.0
        else:
            _survive(given[p, MODULUS], given[p, EXPONENT], given[p, LN_STRENGTH], x, met, whole)
        _weigh(mass, x, number, whole, met)
        _add_generation(given, sides, panels, p, count, n, met, floor, seen, found)


@scalar
def sum_gap(given, sides, panels, p, count, gap, rule, way, found):
    """Columns of what part p carries under a gap, per particle; False where there is no room."""
    keep_apart()
    for k in range(COLUMNS):
        found[k] = 0.0
    high, step = given[p, HIGH], -math.log(given[p, RATIO])
    gap = max(gap, lowest_gap(given, panels, p, count))
    if gap >= high:
        return True
    start = max(0.0, math.log(given[p, LEAST] / gap))
    if math.log(high / gap) - start > MOST_GENERATIONS * step:
        return False
    ends = way[ENDS]
    many = _lay_ends(given, panels, p, count, gap, start, ends)
    if many == len(ends):
        return False
    longest = min(
        rule[0, PLANE_SPAN] * scale_of(given, p, high) / high,
        STEEPEST / max(given[p, MODULUS] * given[p, EXPONENT], 1e-3),
    )
    seen = floor = 0.25 * math.pi * given[p, BREADTH]
    if given[p, SHADOW] != PROJECTED:
        seen, floor = 0.0, 0.0 if given[p, SHADOW] == FOOTPRINT else 1e300
    for e in range(many - 1):
        parts = max(1, math.ceil((ends[e + 1] - ends[e]) / longest - 1e-9))
        width = (ends[e + 1] - ends[e]) / parts
        for m in range(parts):
            a = ends[e] + m * width
            b = ends[e + 1] if m == parts - 1 else a + width
            _add_panel(
                given, sides, panels, p, count, gap, start, a, b, floor, seen, rule, way, found
            )
    return True


@scalar
def pace_of(given, p, gap):
    """Step over the gap in which what part p carries hardly rises."""
    own = NEAR * max(abs(gap), given[p, LEAST])
    return max(min(own, NEAR * 5 * scale_of(given, p, given[p, HIGH])), 0.4 * given[p, WIDTH])


@scalar
def most_above(given, sides, p, gap):
    """What part p may carry at this gap and above, at most, if it breaks [Pa].

    What bears is larger than the gap, fragments have no more volume than the particles had, and
    none carries more over x² than the softer side allows.
    """
    keep_apart()
    if given[p, SEAT] == PRINTED:
        return math.inf
    if given[p, BREAKS] != 1:
        return 0.0  # it only falls
    least = max(gap - REACH * given[p, WIDTH], given[p, LEAST])
    most = sides[2 * p, LIMIT]
    if given[p, EQUAL] != 1:
        most = min(most, sides[2 * p + 1, LIMIT])
    squared = given[p, COVERAGE] / (0.25 * math.pi * given[p, BREADTH])
    return squared * given[p, HIGH] / least * most


# ------------------------------------------------------------------------------ cells over gaps
@scalar
def lay_fragments(given, panels, p, count, grid, own, rule, ends):
    """Lay segments over the gap between which what it carries is smooth; where they end, or −1."""
    keep_apart()
    piece, cells, step = own[PIECE_BEGIN], 0.0, rule[0, PANEL_SPAN] * given[p, WIDTH]
    low, high = lowest_gap(given, panels, p, count), given[p, HIGH]
    marks = ends[len(ends) // 2 :]
    marked, number = mark_sizes(given, p, marks), 2
    ends[0], ends[1] = low, high
    for k in range(marked):
        number = _note_end(ends[: len(ends) // 2], number, marks[k], SAME * marks[k])
        for n in range(count):
            if rule[0, ALL_KINKS] == 1 and panels[p, n, KINKED] == 1:
                gap = marks[k] * (1 - panels[p, n, TO])
                number = _note_end(ends[: len(ends) // 2], number, gap, SAME * gap)
    if number == len(ends) // 2:
        return -1
    for e in range(number - 1):
        a, b = ends[e], ends[e + 1]
        if piece == MOST_NODES:
            return -1
        at_mark = 0.0
        for k in range(marked):
            if abs(marks[k] - b) <= 1e-12 * b:
                at_mark = 1.0
        parts = max(1, math.ceil((b - a) / step - 1e-9))
        grid[FROM, piece], grid[UNTIL, piece], grid[PARTS, piece] = a, b, parts
        grid[ROOTED, piece], grid[CELLS, piece] = at_mark, cells
        cells += parts
        piece += 1
    return piece


@scalar
def fill_fragments(given, sides, panels, p, count, grid, s, last, a, b, place, rule, way):
    """Fill the nodes of a cell of segment s between two gaps; where they end, or −1."""
    keep_apart()
    rooted = grid[ROOTED, s] if last else 0.0
    short = rooted == 0 and b - a <= SHORT * given[p, WIDTH] and b <= NEAR_END * a
    row, nodes = rule_of(rule, short)
    gauss, weights, found = rule[row], rule[row + 1], way[FOUND, :COLUMNS]
    norm = 1 / (ROOT_2PI * given[p, WIDTH])
    for j in range(nodes):
        z = 0.5 * (1 + gauss[j])
        gap, mass = a + (b - a) * z, 0.5 * (b - a) * weights[j]
        if rooted == 1:
            gap, mass = b - (b - a) * z * z, (b - a) * z * weights[j]
        if not sum_gap(given, sides, panels, p, count, gap, rule, way, found):
            return -1
        grid[EPS, place] = gap
        for k in range(COLUMNS):
            grid[LOAD + k, place] = norm * mass * found[k]
        place += 1
    return place


# ------------------------------------------------------------------------------ at a separation
@scalar
def add_fragments(given, sides, panels, p, count, part, gap, rule, way, out):
    """What part p carries under a gap over this part of the area; False where there is no room."""
    keep_apart()
    found = way[FOUND, :COLUMNS]
    good = sum_gap(given, sides, panels, p, count, gap, rule, way, found)
    factor = given[p, DENSITY] * part
    out[F_SA] += factor * found[0]
    out[A_SA2] += factor * found[SECOND - LOAD]
    out[SHADE] += factor * found[LARGER - LOAD]
    for k in range(3):
        out[A_SA + k] += factor * found[FIRST - LOAD + k]
    return good


@scalar
def add_lowest(given, sides, panels, p, count, gap, rule, way, out):
    """What part p carries where the seat leaves less than the lowest gap; False without room."""
    keep_apart()
    low, width = lowest_gap(given, panels, p, count), given[p, WIDTH]
    if low <= gap - REACH * width:
        return True
    part = above((low - gap) / width)
    return add_fragments(given, sides, panels, p, count, part, low, rule, way, out)
