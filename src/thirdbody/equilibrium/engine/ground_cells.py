"""What the particles of a seat on one field of heights carry under a gap, in cells over the gap.

The sections of their sizes together, once for states whose particles are alike. Cells end where a
size begins to be squeezed or a formula changes.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled.machine import keep_apart
from .curves import EDGE, ONE, TO, transform
from .fields import DENSITY, EQUAL, F_SA, HIGH, KIND, ONE_SIZE, PROJECTED, SHADOW
from .fields import LOW as SMALLEST
from .gaps import add_between, has_powers, sum_onset, sum_panels
from .shares import particle_at
from .sides import scalar
from .sums import add_plane

__all__ = ["lay_gaps"]

MOST_CELLS = 800
FROM, UNTIL, ROOT, ROOT_CELL, START, RATE, OVER, POWERS = range(8)
"""Of a cell: its gaps [m]; the gap to which the distance has the root that is its variable, or 0
where it is the gap itself, and the cell that begins there; where the variable starts and its rate;
the power of the root of the distance to the largest size over which columns stand; from there on
powers of each column in turn."""
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
LAST, KINKED, THIN = 4, 0.01, 1e-4
"""So many terms say what a series leaves out; the part of that which one over several intervals may
leave out, as terms fall slowly behind a kink; width of a cell over the largest size below which it
counts in proportion, on seats that are wider than `STEEP` times that."""
STEEP = 8.5
BELOW = 1e-9
"""Part of a gap by which another lies surely below it."""


@scalar
def _add_under(sections, sides, panels, count, gap, rule, sums, onsets, out):
    """Add what the particles of all sections carry under a gap; False below their range."""
    keep_apart()
    for s in range(len(sections)):
        one = sections[s : s + 1]
        if one[0, DENSITY] == 0:
            continue
        if has_powers(one, 0):
            add_between(one, sides, panels, 0, count, gap, sums[s : s + 1], onsets[s], out)
        elif not add_plane(one, sides, panels, 0, count, gap, rule, out):
            return False
    return True


@scalar
def _fill_cell(sections, sides, panels, count, rule, places, sums, onsets, root, top, power, a, b,
               values, series, terms):  # fmt: skip
    """Fill series of all columns between two gaps; their last terms over the largest value.

    In the root of the distance to ``root``, if it is one, and over a ``power`` of that to the
    largest size.
    """
    keep_apart()
    low, high = (math.sqrt(root - b), math.sqrt(max(root - a, 0.0))) if root > 0 else (a, b)
    for j in range(OF_CELL):
        place = low + 0.5 * (high - low) * (1 + places[0, j])
        gap = root - place * place if root > 0 else place
        for k in range(10):
            terms[k] = 0.0
        if not _add_under(sections, sides, panels, count, gap, rule, sums, onsets, terms):
            return math.nan
        # by the gap as it is rounded, as is what is carried
        over = (top - gap) ** (-0.5 * power) if power > 0 else 1.0
        for k in range(COLUMNS - 1):
            values[k, j] = terms[F_SA + k] * over
        if power > 0 and sections[0, SHADOW] == PROJECTED:
            over *= (top - gap) / top  # all of a size is dark once it is touched
        values[COLUMNS - 1, j] = terms[F_SA + COLUMNS - 1] * over
    worst, wide, load, least = 0.0, 0.0, 0.0, math.inf
    for j in range(OF_CELL):
        load, least = max(load, abs(values[0, j])), min(least, abs(values[0, j]))
        for k in range(1, COLUMNS):
            wide = max(wide, abs(values[k, j]))
    for k in range(COLUMNS):
        transform(places, values[k], series[k])
        # high ground may see the end of a cell alone at which little is carried
        most = wide if k > 0 else math.sqrt(load * least)
        if most > 0:
            left = 0.0
            for j in range(OF_CELL - LAST, OF_CELL):
                left += abs(series[k, j])
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
def _differs(sections, sides, panels, n):
    """Whether another of the two areas is the larger on panel n than on the one before."""
    keep_apart()
    signs = 1.0
    for m in range(n - 1, n + 1):
        eps = 0.5 * (panels[0, m, EDGE] + panels[0, m, TO])
        _, one, two = particle_at(sections, sides, panels, 0, m, eps)
        signs *= 1.0 if one > two else -1.0
    return signs < 0


@scalar
def _note_sizes(sections, sides, panels, count, low, high, edges):
    """Note the gaps at which a size begins to be squeezed or comes to another panel."""
    keep_apart()
    last, marked = panels[0, count - 1, TO], 0
    for n in range(count + 1):
        eps = panels[0, n, EDGE] if n < count else last
        # an end of panels alone: the formula is the same behind it
        alone = 0 < n < count and panels[0, n, ONE] < 0
        if alone and (sections[0, EQUAL] == 1 or not _differs(sections, sides, panels, n)):
            continue
        onset = 1.0 if n == 0 else 0.0
        for s in range(len(sections)):
            if sections[s, DENSITY] > 0:
                for k in (SMALLEST, HIGH):
                    marked = _note(edges, marked, sections[s, k] * (1 - eps), onset, low, high)
    return marked


@scalar
def _begin_sections(sections, sides, panels, count, finest, some, sums, onsets):
    """Sum over the squeeze what sizes that are powers carry.

    The smallest and the largest size, the power of the root of the distance from that like which
    all sets in, and what the sums leave out.
    """
    keep_apart()
    low, high, power, worst, powers = math.inf, 0.0, 4.0, 0.0, False
    for s in range(len(sections)):
        one = sections[s : s + 1]
        some[s] = len(sections)  # not summed
        if one[0, DENSITY] == 0:
            continue
        if one[0, HIGH] >= high:
            high, power = one[0, HIGH], 2.0 if one[0, KIND] == ONE_SIZE else 4.0
        low = min(low, one[0, SMALLEST])
        if has_powers(one, 0):
            some[s], powers = 0, True
            sum_onset(one, sides, panels, 0, onsets[s])
    if powers:
        worst = sum_panels(sections, sides, panels, 0, some, count, finest, sums)
    return low, high, power, worst


@scalar
def lay_gaps(sections, sides, panels, count, rule, places, finest, settled, cells, floor, edges,
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
        sections, sides, panels, count, finest, some, sums, onsets
    )
    bottom = low * (1 - last)
    marked = _note_sizes(sections, sides, panels, count, bottom, high, edges)
    if marked >= edges.shape[1] - 1:
        return -1, 0.0
    edges[0, marked], edges[1, marked] = bottom, 0.0
    for k in range(10):
        terms[k] = 0.0
    # of one size, what all are squeezed beyond begins below the last panel
    _add_under(
        sections, sides, panels, count, bottom * (1 - BELOW), rule, sums, onsets, terms
    )  # fmt: skip
    for k in range(COLUMNS):
        floor[k] = terms[F_SA + k]
    laid, n, many, start, begins = 0, 0, 1, 0, high
    while n < marked:
        # where formulas change little at their ends, one series does over several of them
        b, last_n, alone = edges[0, n], min(n + many, marked), False
        if edges[1, n] == 1:
            start, begins = laid, b
        a = edges[0, last_n]
        while True:
            if laid == MOST_CELLS:
                return -1, 0.0
            root = begins if begins - b < b - a else 0.0
            over = power if a + b > high else 0.0
            left = _fill_cell(
                sections, sides, panels, count, rule, places, sums, onsets, root, high, over, a, b,
                values, series, terms,
            )  # fmt: skip
            if left != left:
                return -1, 0.0
            left *= min(1.0, (b - a) / (THIN * high))
            most = settled if last_n == n + 1 else KINKED * settled
            if left > most and b - a > THINNEST * high:
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
            _keep_cell(root, start, over, a, b, series, cells[laid])
            laid += 1
            if a <= edges[0, last_n]:
                break
            a, b = max(edges[0, last_n], a - 2 * (b - a)), a
        many = 1 if alone else min(2 * many, 2)
        n = last_n
    return laid, worst
