"""Sums over the asperities of one state, at one separation."""

from __future__ import annotations

import math

from ...laws.asperity import formulas
from ..compiled.machine import exp, keep_apart
from .field import add_field, lay_field
from .fields import (
    A_E,
    AREA,
    BENDS,
    COATED,
    COATING_TERMS,
    CODE,
    EXPONENTIAL,
    F_SS,
    FIELD,
    FINEST,
    FORCE,
    GAUSSIAN_HEIGHTS,
    HEIGHTS,
    JKR,
    KE,
    LAID_FROM,
    LAST,
    LAW_1,
    LOWEST_HEIGHT,
    MIDDLE,
    REST,
    SHAPE,
    SPREAD,
    START,
    STEP,
    STEPS,
    THIN,
    TOP,
    W,
)  # fmt: skip
from .sides import branch_of, break_at, breaks, exact, law_at, regime_of_branch, scalar, summed
from .vectors import ANY, fill_law, formula_of_law

__all__ = ["MOST_HEIGHTS", "ROOT_2PI", "add_skin", "lay_skin"]

MOST_HEIGHTS = 1536
T, OF_LOAD, OF_AREA, ITS_REGIME = range(4)
"""Rows of the nodes over heights: t = ω/σ_s, weighted load and area, regime."""
ROOT_2PI = math.sqrt(2 * math.pi)
NEAREST, CLOSEST = 0.3, 1e-5
"""First panel over heights [σ_s], and over the distance to the lower end of the heights."""


adhesive, y_of_stretch = scalar(formulas.adhesive), scalar(formulas.y_of_stretch)
stretched_from, coated_beyond = scalar(formulas.stretched_from), scalar(formulas.coated_beyond)


# ------------------------------------------------------------------------------ asperities
@scalar
def _coated_load_area(coating, y, unit):
    """Load and area of a coated asperity."""
    keep_apart()
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


@exact
def _place_heights(rooted, start, low, half, gauss, weights, at, mass):
    """Nodes of a panel of y and their weights; by the root of y − a where it begins."""
    for j in range(len(at)):
        t, weight = low + half * (1 + gauss[j]), half * weights[j]
        at[j] = start + t * t if rooted else t
        mass[j] = 2 * t * weight if rooted else weight


@scalar
def _fill_run(skin, row, coating, heights, begin, end):
    """Loads and areas of asperities at nodes over which the law keeps to a formula."""
    keep_apart()
    if begin == end:
        return
    y, load, area = heights[T, begin:end], heights[OF_LOAD, begin:end], heights[OF_AREA, begin:end]
    code, formula = skin[row, CODE], ANY
    if code <= KE:
        formula = formula_of_law(skin, row, y[0])
    if formula != ANY:
        fill_law(skin, row, formula, 1.0, 1.0, 1.0, y, load, area)
        return
    for j in range(len(y)):
        load[j], area[j] = (
            _coated_load_area(coating, y[j], skin[row, LAW_1])
            if code == COATED
            else law_at(skin, row, y[j])
        )


@exact
def _scale(heights, begin, end, w, load_unit, area_unit):
    """Weigh loads and areas at nodes, whose heights become those over σ_s."""
    y, mass = heights[T, begin:end], heights[4, begin:end]
    load, area = heights[OF_LOAD, begin:end], heights[OF_AREA, begin:end]
    for j in range(len(y)):
        weight = mass[j] * w / ROOT_2PI
        y[j] *= w
        load[j] *= weight * load_unit
        area[j] *= weight * area_unit


@scalar
def _fill_stretched(skin, row, heights, count, gauss, weights, nodes, a, b):
    """As `_fill_panel`, of `JKR`, with its e as the variable: there is no root to find."""
    keep_apart()
    low = stretched_from(a)
    half = 0.5 * (stretched_from(b) - low)
    for j in range(nodes):
        e = low + half * (1 + gauss[j])
        load, area = adhesive(e, skin[row, LAW_1])
        heights[T, count] = y_of_stretch(e)
        heights[4, count] = half * weights[j] * e * (3 + e * (3 + e))
        heights[OF_LOAD, count], heights[OF_AREA, count] = load, area
        count += 1


@scalar
def _lay_shape(skin, row, coating, heights, count, until, gauss, weights, nodes, off):
    """As `lay_skin`, of the asperities of one shape."""
    keep_apart()
    w, start = skin[row, W], skin[row, START]
    first, number = NEAREST / w, breaks(skin, row)
    if off > -math.inf:
        first *= min(max(w * start - off, CLOSEST), 1.0)
        start = max(start, off / w)
    first = min(first, skin[row, FINEST])
    step, end = skin[row, STEP] / w, start + skin[row, LAST] / w
    load_unit, area_unit = skin[row, FORCE] / skin[0, FORCE], skin[row, AREA] / skin[0, AREA]
    a, run, last, first_node = start, count, -1, count
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
            rooted = a == start
            low, half = (0.0, 0.5 * math.sqrt(b - a)) if rooted else (a, 0.5 * (b - a))
            _place_heights(
                rooted, start, low, half, gauss[:nodes], weights[:nodes],
                heights[T, count : count + nodes], heights[4, count : count + nodes],
            )  # fmt: skip
            branch = branch_of(skin, row, 0.5 * (a + b)) if number > 0 else 0
            if branch != last:
                _fill_run(skin, row, coating, heights, run, count)
                run, last = count, branch
        for j in range(count, count + nodes):
            heights[ITS_REGIME, j] = regime
        count += nodes
        a = b
    if skin[row, CODE] != JKR:
        _fill_run(skin, row, coating, heights, run, count)
    _scale(heights, first_node, count, w, load_unit, area_unit)
    return count


@scalar
def lay_skin(skin, coating, heights, count, until, gauss, weights, nodes, off):
    """Nodes over the interference of asperities: t, weighted load and area; where they end.

    To the end of the heights; from their lower end on, which lies ``off`` above the separation
    [σ_s], −∞ where that does not show. −1 if they would take more than ``until`` nodes. Loads and
    areas of every shape are in units of the first.
    """
    keep_apart()
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
    keep_apart()
    # rows of their own, from zero: only then do loops over them become vectors
    t, found = heights[T, begin:end], heights[4, begin:end]
    for j in range(len(t)):
        found[j] = exp(max(-t[j] * (h + 0.5 * t[j]), -700.0))


@exact
def _weigh_other(skin, heights, begin, end, h):
    """Densities of other heights at the nodes without a factor, and that factor times √(2π)."""
    keep_apart()
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


@summed
def _sum_heights(heights, begin, end):
    """Load, and area by regime, of the nodes."""
    share, loads, areas = (
        heights[4, begin:end],
        heights[OF_LOAD, begin:end],
        heights[OF_AREA, begin:end],
    )
    regime = heights[ITS_REGIME, begin:end]
    load = elastic = middle = total = 0.0
    for j in range(len(share)):
        load += loads[j] * share[j]
        area = areas[j] * share[j]
        elastic += area if regime[j] == 0 else 0.0
        middle += area if regime[j] == 1 else 0.0
        total += area if regime[j] == 2 else 0.0
    return load, elastic, middle, total


@scalar
def add_skin(skin, coating, heights, begin, end, gauss, weights, nodes, h, out):
    """Load and areas of the asperities at h [σ_s], into the first four columns.

    Where the lower end of the heights lies among the nodes, or close to them, they are laid anew.
    """
    keep_apart()
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
    load, elastic, middle, plastic = _sum_heights(heights, begin, end)
    out[F_SS] = skin[0, FORCE] * factor * load
    factor *= skin[0, AREA]
    out[A_E], out[A_E + 1], out[A_E + 2] = factor * elastic, factor * middle, factor * plastic
    return True
