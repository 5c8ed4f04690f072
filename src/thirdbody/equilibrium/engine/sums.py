"""Sums over asperities, sizes and seats of one state, at one separation."""

from __future__ import annotations

import math

from ...laws.asperity import formulas
from ..compiled.machine import apart, exp, normal_cdf
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
    fill_particles,
    particle_at,
)
from .curves import LOAD as CARRIED
from .densities import density, scale_of
from .field import add_field, lay_field
from .fields import (
    A_E,
    A_SA,
    A_SA2,
    AREA,
    BENDS,
    BREADTH,
    BREAKS,
    COATED,
    COATING_TERMS,
    CODE,
    DENSITY,
    EQUAL,
    EXPONENT,
    EXPONENTIAL,
    F_SA,
    F_SS,
    FIELD,
    FINEST,
    FOOTPRINT,
    FORCE,
    GAUSSIAN_HEIGHTS,
    HEIGHTS,
    HIGH,
    JKR,
    KEPT,
    KIND,
    LAID_FROM,
    LAST,
    LAW_1,
    LIMIT,
    LOGNORMAL,
    LOW,
    LOWEST_HEIGHT,
    MIDDLE,
    MODULUS,
    NARROW_NODES,
    NARROW_RULE,
    ONE_SIZE,
    POWER,
    PROJECTED,
    RATIO,
    REST,
    SHADE,
    SHADOW,
    SHAPE,
    SIZE_1,
    SIZE_NODES,
    SIZE_RULE,
    SIZE_SPAN,
    SPREAD,
    START,
    STEP,
    STEPS,
    THIN,
    TOP,
    WIDTH,
    W,
)  # fmt: skip
from .sides import branch_of, break_at, breaks, exact, law_at, regime_of_branch, scalar

__all__ = [
    "MOST_HEIGHTS",
    "MOST_SIZES",
    "ROOT_2PI",
    "above",
    "add_last",
    "add_plane",
    "add_skin",
    "lay_sizes",
    "lay_skin",
    "shade",
]

MOST_SIZES, MOST_HEIGHTS = 16_384, 1536
T, OF_LOAD, OF_AREA, ITS_REGIME = range(4)
"""Rows of the nodes over heights: t = ω/σ_s, weighted load and area, regime."""
ROOT_2PI = math.sqrt(2 * math.pi)
NARROW = 0.15
"""Width of a panel over sizes of pieces, in usual ones, up to which few nodes do."""
NEAREST, CLOSEST = 0.3, 1e-5
"""First panel over heights [σ_s], and over the distance to the lower end of the heights."""


adhesive, stretched = scalar(formulas.adhesive), scalar(formulas.stretched)
stretched_from, coated_beyond = scalar(formulas.stretched_from), scalar(formulas.coated_beyond)


# ------------------------------------------------------------------------------ asperities
@scalar
def _coated(coating, y, unit):
    """Load and area of a coated asperity."""
    apart()
    root = math.sqrt(y)
    if root > coating[0, TOP]:
        load, area = coated_beyond(
            coating[0, TOP] / root, coating[0, THIN], coating[0, REST], coating[0, REST + 1],
            coating[0, REST + 2], coating[0, REST + 3],
        )  # fmt: skip
        return unit * load * root * y, area * y
    place = math.log(1 + coating[0, BENDS] * root) * coating[0, STEPS]
    n = min(int(place), len(coating) - 2)
    x, load, area = 2 * (place - n) - 1, 0.0, 0.0
    for k in range(COATING_TERMS - 1, -1, -1):
        load = load * x + coating[n + 1, k]
        area = area * x + coating[n + 1, COATING_TERMS + k]
    return unit * load * root * y, area * y


@scalar
def _fill_panel(skin, row, coating, heights, count, gauss, weights, nodes, start, a, b):
    """Nodes of a panel of y: y, its weight, load and area; by the root of y − a where it begins."""
    apart()
    code, rooted = skin[row, CODE], a == start
    low, half = (0.0, 0.5 * math.sqrt(b - a)) if rooted else (a, 0.5 * (b - a))
    for j in range(nodes):
        y, weight = low + half * (1 + gauss[j]), half * weights[j]
        if rooted:
            y, weight = start + y * y, 2 * y * weight
        load, area = (
            _coated(coating, y, skin[row, LAW_1]) if code == COATED else law_at(skin, row, y)
        )
        heights[T, count], heights[4, count] = y, weight
        heights[OF_LOAD, count], heights[OF_AREA, count] = load, area
        count += 1


@scalar
def _fill_stretched(skin, row, heights, count, gauss, weights, nodes, a, b):
    """As `_fill_panel`, of `JKR`, with its e as the variable: there is no root to find."""
    apart()
    low = stretched_from(a)
    half = 0.5 * (stretched_from(b) - low)
    for j in range(nodes):
        e = low + half * (1 + gauss[j])
        load, area = adhesive(e, skin[row, LAW_1])
        heights[T, count] = stretched(e)
        heights[4, count] = half * weights[j] * e * (3 + e * (3 + e))
        heights[OF_LOAD, count], heights[OF_AREA, count] = load, area
        count += 1


@scalar
def _lay_shape(skin, row, coating, heights, count, until, gauss, weights, nodes, off):
    """As `lay_skin`, of the asperities of one shape."""
    apart()
    w, start = skin[row, W], skin[row, START]
    first, number = NEAREST / w, breaks(skin, row)
    if off > -math.inf:
        first *= min(max(w * start - off, CLOSEST), 1.0)
        start = max(start, off / w)
    first = min(first, skin[row, FINEST])
    step, end = skin[row, STEP] / w, start + skin[row, LAST] / w
    load_unit, area_unit = skin[row, FORCE] / skin[0, FORCE], skin[row, AREA] / skin[0, AREA]
    a = start
    while a < end:
        b = a + first if a == start else min(start + (a - start) * 4.0, a + step)
        if a > 0:
            b = min(b, 4.0 * a)
        for n in range(number):
            y = break_at(skin, row, n)
            if a < y * (1 - 1e-12) and y < b:
                b = y
        if b - start > 0.9 * (end - start):
            b = end
        if count + nodes > until:
            return -1
        regime = 0
        if number > 0:
            regime = regime_of_branch(skin, row, branch_of(skin, row, 0.5 * (a + b)))
        if skin[row, CODE] == JKR:
            _fill_stretched(skin, row, heights, count, gauss, weights, nodes, a, b)
        else:
            _fill_panel(
                skin, row, coating, heights, count, gauss, weights, nodes, start, a, b
            )  # fmt: skip
        for j in range(count, count + nodes):
            weight = heights[4, j] * w / ROOT_2PI
            heights[T, j] *= w
            heights[OF_LOAD, j] *= weight * load_unit
            heights[OF_AREA, j] *= weight * area_unit
            heights[ITS_REGIME, j] = regime
        count += nodes
        a = b
    return count


@scalar
def lay_skin(skin, coating, heights, count, until, gauss, weights, nodes, off):
    """Nodes over the interference of asperities: t, weighted load and area; where they end.

    To the end of the heights; from their lower end on, which lies ``off`` above the separation
    [σ_s], −∞ where that does not show. −1 if they would take more than ``until`` nodes. Loads and
    areas of every shape are in units of the first.
    """
    apart()
    if skin[0, CODE] == FIELD:
        lay_field(heights)
        return count
    for row in range(len(skin)):
        if count >= 0:
            count = _lay_shape(
                skin, row, coating, heights, count, until, gauss, weights, nodes, off
            )
    return count


@exact
def _weigh(heights, begin, end, h):
    """Densities of Gaussian heights at the nodes, without exp(−h²/2)."""
    apart()
    # rows of their own, from zero: only then do loops over them become vectors
    t, found = heights[T, begin:end], heights[4, begin:end]
    for j in range(len(t)):
        found[j] = exp(max(-t[j] * (h + 0.5 * t[j]), -700.0))


@exact
def _weigh_other(skin, heights, begin, end, h):
    """Densities of other heights at the nodes without a factor, and that factor times √(2π)."""
    apart()
    if skin[0, HEIGHTS] == EXPONENTIAL:
        for j in range(begin, end):
            heights[4, j] = exp(max(-heights[T, j], -700.0))
        return ROOT_2PI * math.exp(-(h + 1))
    shape, middle, spread = skin[0, SHAPE], skin[0, MIDDLE], skin[0, SPREAD]
    here = max(middle + spread * h, 0.0) ** shape
    for j in range(begin, end):
        x = max(middle + spread * (h + heights[T, j]), 1e-300)
        power = math.exp(shape * math.log(x))
        heights[4, j] = power / x * math.exp(max(here - power, -700.0))
    return ROOT_2PI * spread * shape * math.exp(-here)


@scalar
def add_skin(skin, coating, heights, begin, end, gauss, weights, nodes, h, out):
    """Load and areas of the asperities at h [σ_s], into the first four columns.

    Where the lower end of the heights lies among the nodes, or close to them, they are laid anew.
    """
    apart()
    if skin[0, CODE] == FIELD:
        return add_field(skin, heights, h, out)
    if h < skin[0, LAID_FROM]:
        begin = heights.shape[1] // 2
        off, until = skin[0, LOWEST_HEIGHT] - h, heights.shape[1]
        end = lay_skin(skin, coating, heights, begin, until, gauss, weights, nodes, off)
        if end < 0:
            return False
    if skin[0, HEIGHTS] == GAUSSIAN_HEIGHTS:
        _weigh(heights, begin, end, h)
        factor = math.exp(-0.5 * h * h)
    else:
        factor = _weigh_other(skin, heights, begin, end, h)
    load, elastic, middle, plastic = 0.0, 0.0, 0.0, 0.0
    for j in range(begin, end):
        share = heights[4, j]
        load += heights[OF_LOAD, j] * share
        area = heights[OF_AREA, j] * share
        regime = heights[ITS_REGIME, j]
        if regime == 0:
            elastic += area
        elif regime == 1:
            middle += area
        else:
            plastic += area
    out[F_SS] = skin[0, FORCE] * factor * load
    factor *= skin[0, AREA]
    out[A_E], out[A_E + 1], out[A_E + 2] = factor * elastic, factor * middle, factor * plastic
    return True


# ------------------------------------------------------------------------------ sizes
@scalar
def _lay_pieces(given, p, sizes, count, rule, low, high):
    """Nodes over sizes between two jumps of the number of pieces; where they end, or −1."""
    apart()
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
    apart()
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
    a, count = low, begin
    while a < high:
        own = scale_of(given, p, a)
        step = span / math.sqrt(1 / (own * own) + 1 / (width * width))
        parts = math.ceil((high - a) / step - 1e-9)
        b = high if parts <= 1 else a + (high - a) / parts
        if (given[p, KIND] == LOGNORMAL or given[p, KIND] == POWER) and parts > 1:
            b = min(high, a + step)
        if count + nodes > MOST_SIZES:
            return -1
        for j in range(nodes):
            x = a + 0.5 * (b - a) * (1 + gauss[j])
            sizes[0, count] = x
            sizes[1, count] = 0.5 * (b - a) * weights[j] * density(given, p, x)
            count += 1
        a = b
    return count


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
    apart()
    return normal_cdf(z, math.exp(-0.5 * z * z)) if abs(z) < 37 else (1.0 if z > 0 else 0.0)


@scalar
def add_last(given, sides, panels, p, count, squared, out):
    """What particles beyond the last panel carry, by the sum of their sizes squared."""
    apart()
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
    apart()
    load, one, two = particle_at(given, sides, panels, p, n, eps)
    squared = weight * x * x
    out[F_SA] += squared * load
    out[A_SA + int(panels[p, n, REGIME])] += squared * one
    out[A_SA2] += squared * two
    out[SHADE] += squared * shade(given, p, one, two)
    if given[p, SHADOW] == PROJECTED:
        out[SHADE] += squared * 0.25 * math.pi * given[p, BREADTH]


@scalar
def _add_sizes(given, p, regime, room, nodes, out):
    """What particles carry that are weighed at nodes of a panel."""
    load = area = second = shaded = 0.0
    for j in range(nodes):
        squared, one, two = room[MASS, j], room[AREA_1, j], room[AREA_2, j]
        load += squared * room[CARRIED, j]
        area += squared * one
        second += squared * two
        shaded += squared * shade(given, p, one, two)
        if given[p, SHADOW] == PROJECTED:
            shaded += squared * 0.25 * math.pi * given[p, BREADTH]
    out[F_SA] += load
    out[A_SA + regime] += area
    out[A_SA2] += second
    out[SHADE] += shaded


@scalar
def _add_one_size(given, sides, panels, p, count, gap, out):
    """What particles of one size carry on a plane."""
    apart()
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
def add_plane(given, sides, panels, p, count, gap, gauss, weights, nodes, span, out):
    """What a part carries on a plane, by panels in the size x; False below its range."""
    apart()
    low, high = given[p, LOW], given[p, HIGH]
    factor = given[p, DENSITY]
    if gap >= high:
        return True
    edge = panels[p, count - 1, TO]
    if gap <= 0 and edge > 1 + CLOSE:
        return False
    if given[p, KIND] == ONE_SIZE:
        _add_one_size(given, sides, panels, p, count, gap, out)
        return True
    squared, room = 0.0, panels[p, len(panels[p]) - ROOM :]
    for n in range(count + 1):
        # sizes squeezed by the ε of panel n, and last those squeezed beyond
        a, b = max(low, gap), high
        if gap <= 0 and n < count:
            continue
        if gap > 0 and n > 0:
            eps = panels[p, n - 1, TO]
            a = max(a, gap / (1 - eps) if eps < 1 else high)
        if n < count:
            eps = panels[p, n, TO]
            b = min(b, gap / (1 - eps) if eps < 1 else high)
        while a < b:
            step = span * scale_of(given, p, a)
            parts = math.ceil((b - a) / step - 1e-9)
            c = b if parts <= 1 else a + (b - a) / parts
            rooted = n == 0
            start = math.sqrt(max(a - gap, 0.0)) if rooted else a
            half = 0.5 * ((math.sqrt(c - gap) if rooted else c) - start)
            for j in range(nodes):
                x, weight = start + half * (1 + gauss[j]), half * weights[j]
                delta = x - gap
                if rooted:
                    delta, weight = x * x, 2 * x * weight
                    x = gap + delta
                weight *= factor * density(given, p, x) * x * x
                room[AT, j], room[MASS, j] = delta / x, weight
                if n == count:
                    squared += weight
            if n < count:
                fill_particles(given, sides, panels, p, n, nodes)
                _add_sizes(given, p, int(panels[p, n, REGIME]), room, nodes, out)
            a = c
    add_last(given, sides, panels, p, count, squared, out)
    if given[p, SHADOW] == PROJECTED:
        out[SHADE] += squared * 0.25 * math.pi * given[p, BREADTH]
    return True
