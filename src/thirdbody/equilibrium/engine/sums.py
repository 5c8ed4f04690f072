"""Sums over sizes and seats of one state, at one separation."""

from __future__ import annotations

import math

from ..compiled.machine import exp, keep_apart, normal_cdf
from .breakage import mark_sizes
from .curves import (
    AREA_1,
    AREA_2,
    AT,
    CLOSE,
    LAST_1,
    LAST_2,
    MASS,
    REGIME,
    ROOM,
    TO,
)
from .curves import LOAD as CARRIED
from .densities import density, scale_of
from .fields import (
    A_SA,
    A_SA2,
    BREADTH,
    BREAKS,
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
    LIMIT,
    LOGNORMAL,
    LOW,
    MODULUS,
    NARROW_NODES,
    NARROW_RULE,
    NORM,
    ONE_SIZE,
    PANEL_NODES,
    PANEL_RULE,
    PLANE_SPAN,
    POWER,
    PROJECTED,
    RATIO,
    SHADE,
    SHADOW,
    SIZE_1,
    SIZE_2,
    SIZE_NODES,
    SIZE_RULE,
    SIZE_SPAN,
    WIDTH,
)  # fmt: skip
from .nodes import FLATTENED, LINEAR, ROOTED, is_plain, place_lengths, variable_of
from .shares import fill_particles, particle_at
from .sides import exact, scalar, summed

__all__ = [
    "MOST_SIZES",
    "above",
    "add_last",
    "add_plane",
    "lay_sizes",
    "parts_of_sizes",
    "shade",
]

MOST_SIZES = 16_384
NARROW = 0.15
"""Width of a panel over sizes of pieces, in usual ones, up to which few nodes do."""
NARROW_SIZES, NEAR_END = 0.8, 8.0
"""Widths of sizes on a plane, and ratio of the ends of a panel, up to which half the nodes do."""


# ------------------------------------------------------------------------------ sizes
@scalar
def _lay_pieces(given, p, sizes, count, rule, low, high):
    """Nodes over sizes between two jumps of the number of pieces; where they end, or −1."""
    keep_apart()
    gauss, weights = rule[SIZE_RULE], rule[SIZE_RULE + 1]
    nodes, span = int(rule[0, SIZE_NODES]), rule[0, SIZE_SPAN]
    middle = math.sqrt(low * high)
    own, empty = middle / max(2.0, 2 * given[p, MODULUS] * given[p, EXPONENT]), True
    y, ratio, shrunk = middle, given[p, RATIO], 1.0
    while y <= given[p, HIGH]:
        if y >= given[p, LOW]:
            own, empty = min(own, shrunk * scale_of(given, p, y)), False
        if given[p, KEPT] == 0:
            break
        y /= ratio
        shrunk *= ratio
    if empty:  # neither particles nor pieces are of such sizes
        return count
    step = span / math.sqrt(1 / (own * own) + 1 / given[p, WIDTH] ** 2)
    parts = max(1, math.ceil((high - low) / step - 1e-9))
    if high - low <= NARROW * step:
        nodes, gauss, weights = int(rule[0, NARROW_NODES]), rule[NARROW_RULE], rule[NARROW_RULE + 1]
    if count + parts * nodes > MOST_SIZES:
        return -1
    half = 0.5 * (high - low) / parts
    for m in range(parts):
        for j in range(nodes):
            sizes[0, count] = low + half * (2 * m + 1 + gauss[j])
            sizes[1, count] = half * weights[j]
            count += 1
    return count


@scalar
def lay_sizes(given, p, sizes, begin, rule, thick):
    """Nodes over sizes on a rough seat: x and weight; where they end, or −1.

    The gap shows ``thick`` times a size, which is 1 − ε.
    """
    keep_apart()
    gauss, weights = rule[SIZE_RULE], rule[SIZE_RULE + 1]
    nodes, span = int(rule[0, SIZE_NODES]), rule[0, SIZE_SPAN]
    if given[p, KIND] == ONE_SIZE:
        x = given[p, SIZE_1]
        sizes[0, begin], sizes[1, begin] = x, 1.0
        return begin + 1
    low, high, width = given[p, LOW], given[p, HIGH], given[p, WIDTH] / max(thick, 1e-3)
    if given[p, BREAKS] == 1:
        marked = mark_sizes(given, p, sizes[2])
        count = begin
        for k in range(marked - 1):
            count = _lay_pieces(given, p, sizes, count, rule, sizes[2, k], sizes[2, k + 1])
            if count < 0:
                return -1
        return count
    even, a, count = parts_of_sizes(given, p, rule, thick), low, begin
    while a < high:
        own = scale_of(given, p, a)
        b = high
        if even > 0:
            b = low + (high - low) * ((count - begin) // nodes + 1) / even
        else:
            step = span / math.sqrt(1 / (own * own) + 1 / (width * width))
            parts = math.ceil((high - a) / step - 1e-9)
            b = high if parts <= 1 else min(high, a + step)
        if count + nodes > MOST_SIZES:
            return -1
        _place_sizes(
            given, p, a, 0.5 * (b - a), gauss[:nodes], weights[:nodes],
            sizes[0, count : count + nodes], sizes[1, count : count + nodes],
        )  # fmt: skip
        count += nodes
        a = b if count - begin != even * nodes else high
    return count


@scalar
def parts_of_sizes(given, p, rule, thick):
    """In how many parts of one length sizes are laid, or 0 where they are not alike."""
    if given[p, KIND] == ONE_SIZE:
        return 1
    if given[p, BREAKS] == 1 or (given[p, KIND] == LOGNORMAL or given[p, KIND] == POWER):
        return 0
    low, high, width = given[p, LOW], given[p, HIGH], given[p, WIDTH] / max(thick, 1e-3)
    own = scale_of(given, p, low)
    step = rule[0, SIZE_SPAN] / math.sqrt(1 / (own * own) + 1 / (width * width))
    return max(1, math.ceil((high - low) / step - 1e-9))


@exact
def _weigh_normal(middle, width, norm, x, mass):
    for j in range(len(x)):
        u = (x[j] - middle) / width
        mass[j] *= norm * exp(max(-0.5 * u * u, -700.0))


@scalar
def _place_sizes(given, p, a, half, gauss, weights, x, mass):
    """Nodes over sizes from a on, and their numbers."""
    keep_apart()
    for j in range(len(x)):
        x[j], mass[j] = a + half * (1 + gauss[j]), half * weights[j]
    if given[p, KIND] == GAUSSIAN:
        _weigh_normal(given[p, SIZE_1], given[p, SIZE_2], given[p, NORM], x, mass)
        return
    for j in range(len(x)):
        mass[j] *= density(given, p, x[j])


@scalar
def shade(given, p, one, two):
    """Area over x² that a particle shades beside its projected area, if that counts at all."""
    larger = max(one, two)
    if given[p, SHADOW] == FOOTPRINT:
        return larger
    if given[p, SHADOW] == PROJECTED:
        return max(larger - 0.25 * math.pi * given[p, BREADTH], 0.0)
    return 0.0


@scalar
def above(z):
    """The normal distribution Φ(z)."""
    keep_apart()
    return normal_cdf(z, math.exp(-0.5 * z * z)) if abs(z) < 37 else (1.0 if z > 0 else 0.0)


@scalar
def add_last(given, sides, panels, p, count, squared, out):
    """What particles beyond the last panel carry, by the sum of their sizes squared."""
    keep_apart()
    one, two = panels[p, count, LAST_1], panels[p, count, LAST_2]
    load = sides[2 * p, LIMIT]  # the load may jump at the end
    if given[p, EQUAL] != 1:
        load = min(load, sides[2 * p + 1, LIMIT])
    out[F_SA] += squared * load
    out[A_SA + int(panels[p, count, REGIME])] += squared * one
    out[A_SA2] += squared * two
    out[SHADE] += squared * shade(given, p, one, two)


# ------------------------------------------------------------------------------ planes
@scalar
def _add_size(given, sides, panels, p, n, x, eps, weight, out):
    """What so many particles of a size x squeezed by ε on panel n carry."""
    keep_apart()
    load, one, two = particle_at(given, sides, panels, p, n, eps)
    squared = weight * x * x
    out[F_SA] += squared * load
    out[A_SA + int(panels[p, n, REGIME])] += squared * one
    out[A_SA2] += squared * two
    out[SHADE] += squared * shade(given, p, one, two)
    if given[p, SHADOW] == PROJECTED:
        out[SHADE] += squared * 0.25 * math.pi * given[p, BREADTH]


@summed
def _sums_of(mass, load, one, two, floor):
    """What weighed particles carry: load, areas, and the larger area above what is bare."""
    carried = area = second = shaded = 0.0
    for j in range(len(mass)):
        carried += mass[j] * load[j]
        area += mass[j] * one[j]
        second += mass[j] * two[j]
        shaded += mass[j] * max(max(one[j], two[j]), floor)
    return carried, area, second, shaded


@scalar
def _add_sizes(given, p, regime, room, nodes, out):
    """What particles carry that are weighed at nodes of a panel."""
    keep_apart()
    floor = 0.25 * math.pi * given[p, BREADTH] if given[p, SHADOW] == PROJECTED else 0.0
    load, area, second, shaded = _sums_of(
        room[MASS, :nodes], room[CARRIED, :nodes], room[AREA_1, :nodes], room[AREA_2, :nodes], floor
    )
    out[F_SA] += load
    out[A_SA + regime] += area
    out[A_SA2] += second
    if given[p, SHADOW] == FOOTPRINT or given[p, SHADOW] == PROJECTED:
        out[SHADE] += shaded


@exact
def _weigh_gaussian(middle, width, norm, gap, at, mass):
    """Squeezes of Gaussian sizes, and their number times x² into their weights."""
    total = 0.0
    for j in range(len(at)):
        x = gap + at[j]
        u = (x - middle) / width
        mass[j] *= norm * x * x * exp(max(-0.5 * u * u, -700.0))
        at[j] /= x
        total += mass[j]
    return total


@scalar
def _weigh_sizes(given, p, gap, at, mass):
    """Squeezes of sizes from their indentations, their number times x² into their weights, and
    the sum of these."""
    keep_apart()
    factor, total = given[p, DENSITY], 0.0
    if given[p, KIND] == GAUSSIAN:
        return _weigh_gaussian(
            given[p, SIZE_1], given[p, SIZE_2], factor * given[p, NORM], gap, at, mass
        )
    for j in range(len(at)):
        x = gap + at[j]
        mass[j] *= factor * density(given, p, x) * x * x
        at[j] /= x
        total += mass[j]
    return total


@scalar
def _add_one_size(given, sides, panels, p, count, gap, out):
    """What particles of one size carry on a plane."""
    keep_apart()
    x = given[p, SIZE_1]
    eps = (x - gap) / x
    if eps <= 0:
        return
    n = count - count  # no constant, for which numba would compile twice
    while n < count and eps > panels[p, n, TO]:
        n += 1
    if n < count:
        _add_size(given, sides, panels, p, n, x, eps, given[p, DENSITY], out)
        return
    squared = given[p, DENSITY] * x * x
    add_last(given, sides, panels, p, count, squared, out)
    if given[p, SHADOW] == PROJECTED:
        out[SHADE] += squared * 0.25 * math.pi * given[p, BREADTH]


@scalar
def add_plane(given, sides, panels, p, count, gap, rule, out):
    """What a part carries on a plane, by panels in the indentation; False below its range."""
    keep_apart()
    low, high = given[p, LOW], given[p, HIGH]
    if gap >= high:
        return True
    edge = panels[p, count - 1, TO]
    if gap <= 0 and edge > 1 + CLOSE:
        return False
    if given[p, KIND] == ONE_SIZE:
        _add_one_size(given, sides, panels, p, count, gap, out)
        return True
    squared, b = 0.0, max(low, gap)
    n = count if gap <= 0 else count - count  # no constant, for which numba would compile twice
    while n <= count and b < high:
        # sizes squeezed by the ε of panel n, and last those squeezed beyond
        a, b = b, high
        if n < count and panels[p, n, TO] < 1:
            b = min(high, gap / (1 - panels[p, n, TO]))
        if a < b:
            squared += _add_panel(given, sides, panels, p, count, n, gap, a, b, rule, out)
        else:
            b = a
        n += 1
    add_last(given, sides, panels, p, count, squared, out)
    if given[p, SHADOW] == PROJECTED:
        out[SHADE] += squared * 0.25 * math.pi * given[p, BREADTH]
    return True


@scalar
def _add_panel(given, sides, panels, p, count, n, gap, low, high, rule, out):
    """What sizes between two carry that are on panel n, or the squares of those beyond all."""
    keep_apart()
    room, own, squared = panels[p, len(panels[p]) - ROOM :], scale_of(given, p, low), 0.0
    parts = max(1, math.ceil((high - low) / (rule[0, PLANE_SPAN] * own) - 1e-9))
    # the logarithm of what a squeeze leaves of one is that of the indentation over the gap
    variable = LINEAR if n == count else variable_of(given, panels, p, n)
    variable = LINEAR if variable == FLATTENED else variable
    for m in range(parts):
        a, b = low + (high - low) * m / parts - gap, low + (high - low) * (m + 1) / parts - gap
        near = b <= NEAR_END * a or variable in (ROOTED, LINEAR)
        few = near and b - a <= NARROW_SIZES * own and (n == count or is_plain(given, panels, p, n))
        row, nodes = (HALF_RULE, HALF_NODES) if few else (PANEL_RULE, PANEL_NODES)
        nodes = int(rule[0, nodes])
        at, mass = room[AT, :nodes], room[MASS, :nodes]
        place_lengths(variable, a, b, gap, rule[row, :nodes], rule[row + 1, :nodes], at, mass)
        total = _weigh_sizes(given, p, gap, at, mass)
        if n < count:
            fill_particles(given, sides, panels, p, n, nodes)
            _add_sizes(given, p, int(panels[p, n, REGIME]), room, nodes, out)
        else:
            squared += total
    return squared
