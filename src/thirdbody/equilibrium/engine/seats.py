"""Particles on a rough seat: nodes of one state over the squeeze, and sums at one separation.

The seat weighs a squeeze ε by how many particles are squeezed so far: a smooth function K of ε,
however the load of a particle bends. Between two ends over which K changes little it is a
polynomial; what it is to be multiplied with is summed for each node of that polynomial, once a
state. Every separation then costs K at these nodes alone. Particles that break have no such K:
there the nodes of the load are those of the sum.
"""

from __future__ import annotations

import math

from ..compiled.machine import exp, keep_apart
from .breakage import is_held
from .curves import AREA_1, AREA_2, AT, EDGE, MASS, REGIME, ROOM, TO
from .curves import LOAD as CARRIED
from .densities import scale_of
from .fields import (
    A_SA,
    A_SA2,
    BREADTH,
    BREAKS,
    DENSITY,
    F_SA,
    FOOTPRINT,
    GAUSSIAN,
    HALF_NODES,
    HALF_RULE,
    HIGH,
    KIND,
    LOGNORMAL,
    LOW,
    NARROW_NODES,
    NARROW_RULE,
    NODES,
    PANEL_NODES,
    PANEL_RULE,
    PANEL_SPAN,
    POLYNOMIAL,
    PROJECTED,
    RULE,
    SEAT_NODES,
    SEAT_SPAN,
    SHADE,
    SHADOW,
    SIZE_1,
    SIZE_2,
    SPAN,
    TAKEN,
    WIDTH,
)
from .laid import COUNT, GAPS, GRID, GRID_END, PIECE_BEGIN, PIECE_END, SIZED, SIZED_END, WHOLE
from .nodes import LINEAR, ROOTED, is_plain, place_nodes, variable_of
from .shares import fill_particles
from .sides import exact, scalar, summed
from .skins import ROOT_2PI
from .sums import above, add_last, lay_sizes, parts_of_sizes

__all__ = [
    "GRID_ROWS",
    "MOST_NODES",
    "add_broken",
    "add_nodes",
    "add_rough",
    "gather_gaps",
    "lay_broken",
    "lay_pieces",
    "left_at_end",
    "pays",
    "weigh_gaps",
]

MOST_NODES = 16_384
EPS, LOAD, SECOND, LARGER, FIRST = range(5)
"""Rows of the nodes over ε: ε, weighted load, areas on the second surface and the larger one, on
the first surface by regime, and the sum over sizes."""
SUM = FIRST + 3
BY_ITSELF = SUM + 1
"""The weight of a node."""
FROM, UNTIL, NODE, NODE_END, SIZE, SIZE_END = range(SUM + 2, SUM + 8)
"""Of pieces of the squeeze, in more rows: its ends, and where its nodes and its sizes begin and
end."""
KEY, PLACE, PLACE_END, GRID_ROWS = range(SUM + 8, SUM + 12)
"""Of slots for cells over the gap, in more rows: which cell is in it, and where its nodes begin and
end."""
PARTS, CELLS = SIZE, SIZE_END
"""Of segments of the gap, beside their ends: their number of cells, and that of all before."""
SLOTS, COLUMNS = 256, 6
"""Cells of a part and a level whose nodes are kept at once, and columns of nodes from `LOAD` on."""
REACH = 9.5
"""Widths of a seat beyond which nothing is summed."""
WIDE_SPAN = 2.5
"""Widths of a panel from which on it may be as wide as the sizes spread."""
SMOOTH_END = 7.5
"""Standard deviations from the mean at which a normal density ends without a jump."""
VECTOR = 8
"""Numbers that a processor takes at once: loops over the rest are slow."""
ONSET, ALIKE = 0.4, 0.5
"""Part of the width of a panel that one from the onset may have; 1 − ε from which on sizes may lie
as close as before."""
NARROW_SEAT, NEAR_END, BARE = 0.6, 8.0, 1e300
"""Widths of the seat, and ratio of its ends, up to which half the nodes of a panel do; a shadow
that nothing casts."""


# ------------------------------------------------------------------------------ once a state
@scalar
def _lay_between(given, sides, panels, p, n, variable, a, b, grid, place, gauss, weights):
    """Gauss nodes between two ends on panel n, of what a particle carries; where they end."""
    keep_apart()
    seen = 0.0
    if given[p, BREAKS] == 1 and given[p, SHADOW] == PROJECTED:
        seen = 0.25 * math.pi * given[p, BREADTH]
    nodes, regime = len(gauss), FIRST + int(panels[p, n, REGIME])
    room = panels[p, len(panels[p]) - ROOM :]
    place_nodes(variable, sides[2 * p, TAKEN], a, b, gauss, weights, room[AT], room[MASS])
    fill_particles(given, sides, panels, p, n, nodes)
    floor = BARE  # of what counts as a shadow
    if given[p, SHADOW] == FOOTPRINT:
        floor = 0.0
    elif given[p, SHADOW] == PROJECTED:
        floor = 0.25 * math.pi * given[p, BREADTH]
    _take_nodes(room, floor, seen, grid, regime, place, place + nodes)
    return place + nodes


@exact
def _take_nodes(room, floor, seen, grid, regime, begin, end):
    """Nodes from the rows of the room, weighted, into those over ε."""
    eps, mass, load = room[AT], room[MASS], room[CARRIED]
    one, two = room[AREA_1], room[AREA_2]
    to_eps, to_mass, to_load = (
        grid[EPS, begin:end],
        grid[BY_ITSELF, begin:end],
        grid[LOAD, begin:end],
    )
    second, larger = grid[SECOND, begin:end], grid[LARGER, begin:end]
    for j in range(len(to_eps)):
        to_eps[j], to_mass[j] = eps[j], mass[j]
        to_load[j], second[j] = mass[j] * load[j], mass[j] * two[j]
        larger[j] = mass[j] * (max(max(one[j], two[j]) - floor, 0.0) + seen)
    for k in range(FIRST, SUM):
        area = grid[k, begin:end]
        own = 1.0 if k == regime else 0.0
        for j in range(len(area)):
            area[j] = own * mass[j] * one[j]


@summed
def _product(one, other):
    """Sum of the products of two rows."""
    keep_apart()
    total = 0.0
    for i in range(len(one)):
        total += one[i] * other[i]
    return total


@exact
def _gather(grid, first, begin, end, a, b, rule):
    """What stands at nodes from ``begin`` to ``end``, for a polynomial by its own from ``first``.

    Sums of the nodes times Chebyshev polynomials, and what each value of the polynomial has in
    them.
    """
    keep_apart()
    nodes = int(rule[0, SEAT_NODES])
    # rows of their own, from zero: only then do loops over them become vectors
    x, now, before = grid[EPS, begin:end], grid[SUM, begin:end], grid[SUM + 1, begin:end]
    for i in range(len(x)):
        x[i] = 2 * (x[i] - a) / (b - a) - 1
        now[i], before[i] = 1.0, x[i]
    for k in range(nodes):
        for row in range(LOAD, SUM):
            grid[row, first + k] = _product(grid[row, begin:end], now)
        for i in range(len(x)):
            following = 2 * x[i] * now[i] - before[i]
            before[i], now[i] = now[i], following
    total = grid[SUM, first : first + nodes]
    for row in range(LOAD, SUM):
        for m in range(len(total)):
            total[m] = 0.0
        for k in range(nodes):
            value, series = grid[row, first + k], rule[POLYNOMIAL + 1 + k, :nodes]
            for m in range(len(total)):
                total[m] += value * series[m]
        found = grid[row, first : first + nodes]
        for m in range(len(total)):
            found[m] = total[m]
    for m in range(nodes):
        grid[EPS, first + m] = a + 0.5 * (b - a) * (1 + rule[POLYNOMIAL, m])


@scalar
def _lay_piece(given, sides, panels, p, count, panel, a, b, grid, place, rule):
    """Nodes between two squeezes, from ``panel`` on; where they end, −1 where there is no room.

    Those of a polynomial, for which those of the panels are gathered, where these are more.
    """
    keep_apart()
    nodes, most = int(rule[0, NODES]), int(rule[0, SEAT_NODES])
    parts, n = 1, panel
    while n < count - 1 and panels[p, n, TO] < b:
        parts += 1
        n += 1
    begin = place + most if parts * nodes > most else place
    if begin + parts * nodes + VECTOR > MOST_NODES:
        return -1
    end = begin
    for n in range(panel, panel + parts):
        low, high = max(a, panels[p, n, EDGE]), min(b, panels[p, n, TO])
        end = _lay_between(
            given, sides, panels, p, n, LINEAR if low > 0 else ROOTED, low, high, grid, end,
            rule[RULE, :nodes], rule[RULE + 1, :nodes],
        )  # fmt: skip
    if begin > place:
        _gather(grid, place, begin, end, a, b, rule)
        end = place + most
    return end


@scalar
def lay_broken(given, sides, panels, p, count, grid, place, sizes, size, rule):
    """Nodes over ε and sizes of particles that break; where both end, −1 where there is no room.

    As many particles are whole on all panels that are held alike: there K is smooth.
    """
    keep_apart()
    step, n = rule[0, SPAN] * given[p, WIDTH] / given[p, HIGH], int(panels[p, 0, EDGE])
    wide = rule[0, SEAT_SPAN] * given[p, WIDTH] / given[p, HIGH]
    while n < count:  # n begins at 0, but as no constant, for numba
        first, last, held = panels[p, n, EDGE], panels[p, n, TO], n
        while held < count and is_held(given, panels, p, count, n, held):
            last = panels[p, held, TO]
            held += 1
        parts = max(1, math.ceil((last - first) / (step if held == n else wide)))
        nodes, row = int(rule[0, NODES]), int(0 * rule[0, NODES]) + RULE
        if last - first <= NARROW * min(first, 1 - last):
            nodes, row = int(rule[0, NARROW_NODES]), row + NARROW_RULE - RULE
        if place + parts * nodes > MOST_NODES:
            return -1, size
        for m in range(parts):
            a = first + (last - first) * m / parts
            b = first + (last - first) * (m + 1) / parts
            if held == n:
                place = _lay_between(
                    given, sides, panels, p, n, LINEAR if a > 0 else ROOTED, a, b, grid, place,
                    rule[row, :nodes], rule[row + 1, :nodes],
                )  # fmt: skip
                continue
            while n < held - 1 and panels[p, n, TO] <= a:
                n += 1
            place = _lay_piece(given, sides, panels, p, held, n, a, b, grid, place, rule)
            if place < 0:
                return -1, size
        n = max(held, n + 1)
    return place, lay_sizes(given, p, sizes, size, rule, 1.0)


@scalar
def _own_width(given, p, span):
    """Width of K from the sizes over 1 − ε, where their density has no jump at its ends."""
    middle, reach = given[p, SIZE_1], SMOOTH_END * given[p, SIZE_2]
    smooth = given[p, KIND] == LOGNORMAL
    if given[p, KIND] == GAUSSIAN:
        smooth = given[p, LOW] <= middle - reach and middle + reach <= given[p, HIGH]
    if not smooth or span < WIDE_SPAN:
        return 0.0
    size = 0.5 * (given[p, LOW] + given[p, HIGH])
    return scale_of(given, p, size) / size


@scalar
def left_at_end(parts, p, span, gap):
    """Part of what particles carry that is left out where panels are as wide as sizes spread.

    Under a large gap sizes end too soon. Squares of deviations from the middle say how many sizes
    there are at the gap and at the end.
    """
    if _own_width(parts, p, span) == 0:
        return 0.0
    middle, spread, high = parts[p, SIZE_1], parts[p, SIZE_2], parts[p, HIGH]
    if parts[p, KIND] == LOGNORMAL:
        gap, high, middle = math.log(max(gap, 1e-300)), math.log(high), math.log(middle)
    deviation = max(gap - middle, 0.0)
    return math.exp(-max((high - middle) ** 2 - deviation**2, 0.0) / (2 * spread**2))


@scalar
def _end_piece(grid, piece, place, size):
    """Fill up a piece with nodes that carry nothing; where they end."""
    while place % VECTOR != 0:
        for row in range(LOAD, BY_ITSELF + 1):
            grid[row, place] = 0.0
        grid[EPS, place] = grid[EPS, place - 1]
        place += 1
    grid[NODE_END, piece], grid[SIZE_END, piece] = place, size
    return place


@scalar
def lay_pieces(given, sides, panels, p, count, grid, place, sizes, size, piece, rule):
    """Lay nodes over the squeeze in pieces with their sizes; where pieces, nodes and sizes end.

    −1 for pieces where there is no room.
    """
    keep_apart()
    span, seat = rule[0, PANEL_SPAN], given[p, WIDTH] / given[p, HIGH]
    nodes, half = int(rule[0, PANEL_NODES]), int(rule[0, HALF_NODES])
    closest, before, own = 0.0, 0, _own_width(given, p, span)
    n = int(panels[p, 0, EDGE])  # 0, and no constant
    while n < count:
        begin, end, variable = (
            panels[p, n, EDGE],
            panels[p, n, TO],
            variable_of(given, panels, p, n),
        )
        thin = own * abs(1 - 0.5 * (begin + end))
        width = math.sqrt(seat * seat + thin * thin)
        wide = (end - begin) / (width if begin > 0 else ONSET * width)
        parts = max(1, math.ceil(wide / span - 1e-9))
        few = wide <= NARROW_SEAT * parts and end <= NEAR_END * (end if begin == 0 else begin)
        few &= is_plain(given, panels, p, n)
        if place + (parts + 1) * nodes > MOST_NODES:
            return -1, place, size
        for m in range(parts):
            a, b = begin + (end - begin) * m / parts, begin + (end - begin) * (m + 1) / parts
            # sizes as close as a gap shows them at the least squeeze of the piece
            widest = max(abs(1 - a), abs(1 - b))
            parted = parts_of_sizes(given, p, rule, widest)
            if closest == 0 or (
                (parted == 0 or parted != before) and not ALIKE * closest <= widest <= closest
            ):
                before = parted
                if closest > 0:
                    place = _end_piece(grid, piece, place, size)
                    piece += 1
                if piece == MOST_NODES:
                    return -1, place, size
                closest, grid[NODE, piece], grid[SIZE, piece] = widest, place, size
                grid[FROM, piece] = a
                size = lay_sizes(given, p, sizes, size, rule, widest)
                if size < 0:
                    return -1, place, size
            row, number = (HALF_RULE, half) if few else (PANEL_RULE, nodes)
            place = _lay_between(
                given, sides, panels, p, n, variable, a, b, grid, place, rule[row, :number],
                rule[row + 1, :number],
            )  # fmt: skip
            grid[UNTIL, piece] = b
        n += 1
    return piece + 1, _end_piece(grid, piece, place, size), size


# ------------------------------------------------------------------------------ at a separation
NARROW = 0.15
"""Width of a panel, over what is on either side of it, up to which half the nodes do."""
CELL = 1.5
"""Widths of a seat over which sixteen nodes give its density to 1e-13 of the largest."""


@summed
def _find_moments(x, v, now, before, moments):
    """Σ v T_k(x) of an even number of Chebyshev polynomials."""
    keep_apart()
    for i in range(len(x)):
        now[i], before[i] = 1.0, x[i]
    for k in range(0, len(moments), 2):
        one = other = 0.0
        for i in range(len(x)):
            first, second = now[i], before[i]
            one += v[i] * first
            other += v[i] * second
            first = 2 * x[i] * second - first
            now[i] = first
            before[i] = 2 * x[i] * first - second
        moments[k], moments[k + 1] = one, other


@exact
def _fill_gaps(x, v, sizes, weights, left, shares, source, wide):
    """Gaps that a squeeze leaves of sizes, and how many particles are there."""
    keep_apart()
    for j in range(len(x)):
        x[j] = sizes[j] * left
        v[j] = weights[j] * shares[source + wide * j]


@exact
def _add_columns(grid, i, start, moments):
    """Add what node i over ε gives to a cell: its columns times moments."""
    keep_apart()
    for row in range(LOAD, SUM):
        column = grid[row, i]
        if column != 0:
            out = grid[row, start : start + len(moments)]
            for k in range(len(moments)):
                out[k] += column * moments[k]


@scalar
def gather_gaps(given, p, grid, begin, end, sizes, first, last, shares, whole, rule):
    """Gather pairs of a squeeze and a size by the gap they leave; where what is gathered ends.

    A seat weighs a pair by its gap x(1 − ε) alone, smoothly: what stands at the pairs is handed to
    the nodes of polynomials over the gap, behind the nodes over ε, weights of the sizes and all.
    −1 where there is no room.
    """
    keep_apart()
    nodes, width, wide = int(rule[0, SEAT_NODES]), given[p, WIDTH], end - begin
    least, most = 1.0, 0.0  # nodes of a polynomial stand in another order
    for i in range(begin, end):
        least, most = min(least, grid[EPS, i]), max(most, grid[EPS, i])
    low, high = sizes[0, first] * (1 - most), sizes[0, last - 1] * (1 - least)
    cells = max(1, math.ceil((high - low) / (CELL * width)))
    step, place = (high - low) / cells, end + cells * nodes
    scratch = place + VECTOR
    if scratch + max(last - first, nodes) > MOST_NODES:
        return -1
    for row in range(LOAD, SUM):
        for k in range(end, place):
            grid[row, k] = 0.0
    for j in range(first, last):
        x = sizes[0, j]
        sizes[2, j] = sizes[1, j] * x * x * x / (ROOT_2PI * width)
    count = last - first
    x, v = grid[EPS, scratch : scratch + count], grid[LOAD, scratch : scratch + count]
    now, before = grid[SECOND, scratch : scratch + count], grid[LARGER, scratch : scratch + count]
    moments = grid[FIRST, scratch : scratch + nodes]
    for i in range(begin, end):
        left = 1 - grid[EPS, i]
        _fill_gaps(
            x, v, sizes[0, first:last], sizes[2, first:last], left, shares, whole + i - begin, wide
        )
        j = 0
        while j < count:
            cell = max(0, min(int((x[j] - low) / step), cells - 1))
            until = low + (cell + 1) * step if cell < cells - 1 else math.inf
            middle, n = low + (cell + 0.5) * step, j
            while n < count and (n == j or x[n] < until):
                x[n] = (x[n] - middle) * 2 / step
                n += 1
            _find_moments(x[j:n], v[j:n], now[j:n], before[j:n], moments)
            _add_columns(grid, i, end + cell * nodes, moments)
            j = n
    values = grid[SUM, scratch : scratch + nodes]
    for cell in range(cells):
        start = end + cell * nodes
        for row in range(LOAD, SUM):
            for m in range(nodes):
                values[m] = 0.0
            for k in range(nodes):
                for m in range(nodes):
                    values[m] += grid[row, start + k] * rule[POLYNOMIAL + 1 + k, m]
            for m in range(nodes):
                grid[row, start + m] = values[m]
        for m in range(nodes):
            grid[EPS, start + m] = low + (cell + 0.5 * (1 + rule[POLYNOMIAL, m])) * step
    return place


@exact
def weigh_gaps(grid, begin, end, gap, width):
    """Densities of the seat at nodes over the gap, without what stands in the nodes."""
    keep_apart()
    # rows of their own, from zero: only then do loops over them become vectors
    own, total = grid[EPS, begin:end], grid[SUM, begin:end]
    for i in range(len(total)):
        z = (gap - own[i]) / width
        total[i] = exp(max(-0.5 * z * z, -700.0))


@exact
def _sum_sizes(grid, sizes, s, gap, width):
    """K on a piece: over sizes, x³ times the density of the seat, into the last row."""
    keep_apart()
    begin, end = int(grid[NODE, s]), int(grid[NODE_END, s])
    thick, thin = 1 - grid[FROM, s], 1 - grid[UNTIL, s]
    low, high = gap - REACH * width, gap + REACH * width
    eps, total = grid[EPS, begin:end], grid[SUM, begin:end]
    for i in range(len(total)):
        total[i] = 0.0
    for j in range(int(grid[SIZE, s]), int(grid[SIZE_END, s])):
        x = sizes[0, j]
        if not (x * thick > low and x * thin < high):
            continue
        c = sizes[1, j] * x * x * x / (ROOT_2PI * width)
        start, rate = (gap - x) / width, x / width
        for i in range(len(eps)):
            z = start + rate * eps[i]
            total[i] += c * exp(max(-0.5 * z * z, -700.0))


@scalar
def add_nodes(given, p, grid, begin, end, out):
    """What nodes carry whose K is known."""
    keep_apart()
    factor, share = given[p, DENSITY], grid[SUM, begin:end]
    out[F_SA] += factor * _product(share, grid[LOAD, begin:end])
    out[A_SA2] += factor * _product(share, grid[SECOND, begin:end])
    out[SHADE] += factor * _product(share, grid[LARGER, begin:end])
    for k in range(3):
        out[A_SA + k] += factor * _product(share, grid[FIRST + k, begin:end])


@scalar
def pays(grid, begin, end, bound, most_loss):
    """Whether loads at nodes over ε grow at least as fast as the bound times what they shade.

    But for a loss per coverage.
    """
    keep_apart()
    most = worst = 0.0
    for i in range(begin, end):
        if grid[BY_ITSELF, i] > 0:
            left = (grid[LOAD, i] - bound * grid[LARGER, i]) / grid[BY_ITSELF, i]
            most = max(most, left)
            worst = max(worst, most - left)
    return worst <= most_loss


@scalar
def _sum_of_squares(given, p, grid, sizes, s, thick, gap):
    """Sum of the squares of sizes of a piece whose part of this thickness reaches the gap."""
    keep_apart()
    total = 0.0
    for j in range(int(grid[SIZE, s]), int(grid[SIZE_END, s])):
        x = sizes[0, j]
        total += sizes[1, j] * x * x * above((x * thick - gap) / given[p, WIDTH])
    return given[p, DENSITY] * total


@scalar
def add_rough(given, sides, panels, p, own, grid, sizes, gap, out):
    """What a part carries on a rough seat, into the columns of the particles."""
    keep_apart()
    count, piece, until = own[COUNT], own[PIECE_BEGIN], own[PIECE_END]
    for s in range(piece, until):
        _sum_sizes(grid, sizes, s, gap, given[p, WIDTH])
        add_nodes(given, p, grid, int(grid[NODE, s]), int(grid[NODE_END, s]), out)
    thin = 1 - panels[p, count - 1, TO]
    squeezed = _sum_of_squares(given, p, grid, sizes, until - 1, thin, gap)
    add_last(given, sides, panels, p, count, squeezed, out)
    if given[p, SHADOW] == PROJECTED:
        touched = _sum_of_squares(given, p, grid, sizes, piece, 1 - grid[FROM, piece], gap)
        out[SHADE] += 0.25 * math.pi * given[p, BREADTH] * touched


@scalar
def add_broken(given, sides, panels, p, own, grid, sizes, gap, shares, out):
    """What a part that breaks carries on a rough seat; ``own`` is what is laid of it."""
    keep_apart()
    width, first, last = given[p, WIDTH], own[SIZED], own[SIZED_END]
    place = own[WHOLE] + (last - first) * (own[GAPS] - own[GRID])
    weigh_gaps(grid, own[GAPS], own[GRID_END], gap, width)
    add_nodes(given, p, grid, own[GAPS], own[GRID_END], out)
    count = own[COUNT]
    edge, squeezed = panels[p, count - 1, TO], 0.0
    for j in range(first, last):
        x = sizes[0, j]
        weight = sizes[1, j] * x * x * shares[place + j - first]
        squeezed += weight * above((x * (1 - edge) - gap) / width)
    squeezed *= given[p, DENSITY]
    add_last(given, sides, panels, p, count, squeezed, out)
    if given[p, SHADOW] == PROJECTED:  # what is squeezed less stands in the nodes
        out[SHADE] += 0.25 * math.pi * given[p, BREADTH] * squeezed
