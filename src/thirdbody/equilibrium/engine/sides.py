"""One contact of a particle, and the law of one contact, as functions of numbers.

A side is a row of numbers; `prepare` finds its kinks once a state, `side_at` evaluates it.
"""

from __future__ import annotations

import math

from numba import njit

from ...laws.asperity import formulas
from ...laws.particle import deep
from ..compiled.machine import EXACT, keep_apart
from .fields import (
    CAP,
    CEB,
    CODE,
    COUNT,
    DEEP,
    DELTA_1,
    DMT,
    END,
    FACE_AREA,
    FACE_PRESSURE,
    FACE_RATE,
    FACE_START,
    FACE_TAN,
    FACED,
    FORM,
    FULL,
    GW,
    HARDER,
    HERMITE,
    HILL,
    JG,
    JOINT,
    KE,
    KINKS,
    LAW_1,
    LAW_2,
    LAW_3,
    LAW_4,
    LIMIT,
    MOST_KINKS,
    PLATEAU,
    SQUASHED,
    TABLE_AREA,
    TABLE_LOAD,
    TABLE_TERMS,
    TAKEN,
    TIP,
    UNIT,
    WIDE,
    ZMC,
)  # fmt: skip

__all__ = ["break_at", "breaks", "is_alike", "law_at", "prepare", "regime_of", "side_at"]

scalar = njit(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, _nrt=False)
"""Options of functions that only the kernel calls."""
exact = njit(
    error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, _nrt=False, fastmath=EXACT
)
"""Of loops that are to become vectors."""
summed = njit(
    error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True, _nrt=False, fastmath=True
)
"""Of plain sums of products, whose order may be any, the same in every state."""


elastic = scalar(formulas.elastic)
fully_plastic = scalar(formulas.fully_plastic)
zmc_spread = scalar(formulas._spread)
plastic_ceb = scalar(formulas.plastic_ceb)
kogut = scalar(formulas.kogut)
hertz_less_pull = scalar(formulas.hertz_less_pull)
green_middle = scalar(formulas.green_middle)
HALVINGS, STEEPEST = 60, 1e-15
ROUNDED = 2e-15
"""Of what is sought at a kink, no more than rounding."""
OF_CAP, OF_WIDTH, OF_PRESSURE, OF_DISC = 0.0, 1.0, 2.0, 3.0
"""Kinks of a row. No whole numbers, for each of which numba would compile what takes them."""
LAW_ENDS, TABLE_BEGINS, TABLE_ENDS, SPLITS = (
    deep.LAW_ENDS,
    deep.TABLE_BEGINS,
    deep.TABLE_ENDS,
    deep.SPLITS,
)
FIRST, LAST = math.log(LAW_ENDS / (1 - LAW_ENDS)), math.log(TABLE_ENDS / (1 - TABLE_ENDS))
THINNEST, EARLIEST, DEEPEST = math.exp(deep.THINNEST), deep.EARLIEST, deep.DEEPEST
GRADING = 4.0
"""Ratio of heights left at neighbouring kinks of a disc."""


@scalar
def is_alike(numbers, others):
    """Whether two rows of numbers are equal; one with NaN equals none."""
    for k in range(len(numbers)):  # noqa: SIM110
        if numbers[k] != others[k]:
            return False
    return True


@scalar
def zmc_by(y, log_y, log_rho, k, rho, r, full):
    """Mean pressure and area of `ZMC` between the yield and ρ."""
    return k + (1 - k) * log_y / log_rho, zmc_spread(y, rho, r, full)


@scalar
def hermite_by(y, log_y, log_rho, k, rho, r, full):
    """Mean pressure and area of `Hermite` between the yield and ρ."""
    u, slope = log_y / log_rho, 0.5 * k * log_rho
    p = k * (u * u * (2 * u - 3) + 1) + slope * u * (1 - u) ** 2 + u * u * (3 - 2 * u)
    return p, zmc_spread(y, rho, r, full)


@scalar
def zmc_middle(y, k, rho, r, full):
    keep_apart()
    p, area = zmc_by(y, math.log(y), math.log(rho), k, rho, r, full)
    return p * area, area


@scalar
def hermite_middle(y, k, rho, r, full):
    keep_apart()
    p, area = hermite_by(y, math.log(y), math.log(rho), k, rho, r, full)
    return p * area, area


@scalar
def breaks(rows, i):
    """How many breakpoints the law of a row has."""
    code = rows[i, CODE]
    if code == GW or code >= DMT:
        return 0
    if ZMC <= code <= HERMITE:
        return 2
    if code == KE:
        return 3
    return 1


@scalar
def break_at(rows, i, n):
    """The n-th breakpoint y of the law of a row."""
    code = rows[i, CODE]
    if code == JG:
        return 1.9
    if n == 0:
        return 1.0
    if code == KE:
        return 6.0 if n == 1 else 110.0
    return rows[i, LAW_2]


@scalar
def branch_of(rows, i, y):
    """Which branch of its law a row is on at y."""
    keep_apart()
    n = 0
    while n < breaks(rows, i) and y >= break_at(rows, i, n):
        n += 1
    return n


@scalar
def regime_of_branch(rows, i, branch):
    code = rows[i, CODE]
    if code == CEB:
        return 2 * branch
    if code == KE:
        return branch if branch < 2 else branch - 1
    return branch


@scalar
def law_at(rows, i, y):
    """Reduced load and area of the law of a row at y > 0."""
    keep_apart()
    code = rows[i, CODE]
    if ZMC <= code <= HERMITE:
        k, rho = rows[i, LAW_1], rows[i, LAW_2]
        r, full = rows[i, LAW_3], rows[i, LAW_4]
        if y < 1:
            return elastic(y, k, r)
        if y >= rho:
            return fully_plastic(y, full)
        if code == HERMITE:
            return hermite_middle(y, k, rho, r, full)
        return zmc_middle(y, k, rho, r, full)
    if code == GW:
        return elastic(y, 1.0, 1.0)
    first = rows[i, LAW_1]
    if code == CEB:
        if y < 1:
            return elastic(y, 2 / 3 * first, rows[i, LAW_2])
        return plastic_ceb(y, first, rows[i, LAW_2], rows[i, LAW_3])
    if code == KE:
        if y < 1:
            return elastic(y, 2 / 3 * first, 1.0)
        if y < 6:
            return kogut(y, 2 / 3 * first, 1.03, 1.425, 0.93, 1.136)
        if y < 110:
            return kogut(y, 2 / 3 * first, 1.40, 1.263, 0.94, 1.146)
        return fully_plastic(y, 2.0)
    if code == DMT:
        return hertz_less_pull(y, first)
    if y < 1.9:
        return elastic(y, 2 / 3 * first / rows[i, LAW_4], 1.0)
    return green_middle(y, first, rows[i, LAW_2], rows[i, LAW_3], rows[i, LAW_4])


@scalar
def chord(low, f_low, high, f_high, step):
    """Where a chord crosses zero between two ends; the middle at every eighth step."""
    x = (low * f_high - high * f_low) / (f_high - f_low)
    return x if low < x < high and step % 8 != 7 else 0.5 * (low + high)


@scalar
def narrow_ends(low, f_low, high, f_high, last, x, f):
    """Ends and values around a root after a look at x, and which end moved (rule of Illinois).

    The value of an end that stays twice is halved. Dowell and Jarratt, BIT 11 (1971) 168.
    """
    if f < 0:
        return x, f, high, 0.5 * f_high if last == -1 else f_high, -1
    return low, 0.5 * f_low if last == 1 else f_low, x, f, 1


@scalar
def _excess(rows, i, y, what):
    """What is zero at a kink of a row, rising with y: of the cap, the width, or the pressure."""
    keep_apart()
    if what == OF_CAP:
        return law_at(rows, i, y)[1] - rows[i, FULL]
    load, area = _squashed_at(rows, i, y)
    if what == OF_WIDTH:
        return 4 * rows[i, TIP] * rows[i, DELTA_1] * area - 1
    return load - rows[i, HARDER] * area


@scalar
def _crossing(rows, i, low, high, what):
    """y between two at which `_excess` changes its sign, by halving and by chords."""
    keep_apart()
    f_low, f_high = _excess(rows, i, low, what), _excess(rows, i, high, what)
    if f_low >= 0:
        return low
    last = 0
    for n in range(4 * HALVINGS):
        if high - low <= STEEPEST * high:
            break
        y = chord(low, f_low, high, f_high, n)
        f = _excess(rows, i, y, what)
        if f == 0:
            return y
        low, f_low, high, f_high, last = narrow_ends(low, f_low, high, f_high, last, y, f)
    return 0.5 * (low + high)


@scalar
def _cap(rows, i):
    """Reduced indentation at which the area of the law reaches the great circle."""
    keep_apart()
    full, count = rows[i, FULL], breaks(rows, i)
    code = rows[i, CODE]
    if code == GW or (rows[i, LAW_3] * 0 + full <= break_at(rows, i, 0) and code != KE):
        return full
    if code == KE and full < 0.93:
        return full
    last = break_at(rows, i, count - 1)
    if code == CEB:
        return 1 + (full - rows[i, LAW_2]) / rows[i, LAW_3]
    if code != JG and 0.5 * full >= last:
        return 0.5 * full
    low, high = 0.4 * full, max(full, 1.0)
    if law_at(rows, i, low)[1] >= full:  # the area of a power above one
        low = break_at(rows, i, 0)
    while law_at(rows, i, high)[1] < full:
        high *= 2
    for n in range(count):  # a jump of the area over the great circle
        y = break_at(rows, i, n)
        below = y * (1 - 1e-15)
        if low < y < high:
            under, at = law_at(rows, i, below)[1], law_at(rows, i, y)[1]
            if under < full <= at:
                return y
            if at < full:
                low = y
            elif under >= full:
                high = below
    return _crossing(rows, i, low, high, OF_CAP)


@scalar
def _squashed_at(rows, i, y):
    """Reduced load and area of a squashed half."""
    keep_apart()
    delta_1, full = rows[i, DELTA_1], rows[i, FULL]
    load, area = law_at(rows, i, y)
    left = 1 - 2 * delta_1 * y
    spread = min(area, full) / left
    radius = math.sqrt(rows[i, TIP] * delta_1 * spread)
    fall = 0.92 * (1 - math.cos(math.pi * min(2 * radius, 1.0)))
    rise = (rows[i, HILL] * radius / left - fall) / 2.84
    return spread * (load / area) * (1 + rise), spread


@scalar
def _table_at(rows, i, x):
    """Load and area by both Chebyshev series of a row at x, from −1 to 1, side by side."""
    keep_apart()
    b_1, c_1, b_2, c_2, twice = 0.0, 0.0, 0.0, 0.0, 2 * x
    for k in range(TABLE_TERMS - 1, 0, -1):
        b_1, c_1 = rows[i, TABLE_LOAD + k] + twice * b_1 - c_1, b_1
        b_2, c_2 = rows[i, TABLE_AREA + k] + twice * b_2 - c_2, b_2
    load, area = rows[i, TABLE_LOAD] + x * b_1 - c_1, rows[i, TABLE_AREA] + x * b_2 - c_2
    return math.exp(load), math.exp(area)


@scalar
def _disc_at(rows, i, left):
    """Load over πR²H and area over πR² of a disc beyond the table, of a height left."""
    load, area = _table_at(rows, i, 1.0)
    thick = 1 - TABLE_ENDS * rows[i, TAKEN]
    wide, hill = area * thick / left, rows[i, HILL]
    rise = (1 + hill * math.sqrt(wide) / left) / (1 + hill * math.sqrt(area) / thick)
    return load * thick / left * rise, wide


@scalar
def _deep_at(rows, i, eps):
    """Load over πR²H and area over πR² of a side by the table, at a squeeze ε = δ/R."""
    keep_apart()
    if eps > TABLE_ENDS:
        return _disc_at(rows, i, 1 - rows[i, TAKEN] * eps)
    thin = rows[i, DELTA_1] / rows[i, TIP]
    if eps <= LAW_ENDS:
        load, area = law_at(rows, i, eps / thin)
        return thin * load, thin * area
    place = (2 * math.log(eps / (1 - eps)) - FIRST - LAST) / (LAST - FIRST)
    table_load, table_area = _table_at(rows, i, place)
    if eps >= TABLE_BEGINS:
        return table_load, table_area
    load, area = law_at(rows, i, eps / thin)
    u = math.log(eps / LAW_ENDS) / math.log(TABLE_BEGINS / LAW_ENDS)
    w = u * u * (3 - 2 * u)
    load, area = thin * load, thin * area
    return load * (table_load / load) ** w, area * (table_area / area) ** w


@scalar
def _table_excess(rows, i, place, what):
    """What is zero at a kink of a side by the table: of its width, or of its pressure.

    The place is the squeeze, of a disc −ln of the height left.
    """
    if what == OF_DISC:
        load, area = _disc_at(rows, i, math.exp(-place))
    else:
        load, area = _deep_at(rows, i, place)
    if what == OF_WIDTH:
        return area - 1
    return load / (rows[i, HARDER] * area) - 1


@scalar
def _table_crossing(rows, i, low, high, what):
    """Place between two at which `_table_excess` changes its sign, by chords."""
    keep_apart()
    f_low, f_high = _table_excess(rows, i, low, what), _table_excess(rows, i, high, what)
    last = 0
    if f_low >= 0:
        return low
    for n in range(4 * HALVINGS):
        if f_high < ROUNDED or high - low <= STEEPEST * high:
            break
        place = chord(low, f_low, high, f_high, n)
        f = _table_excess(rows, i, place, what)
        if abs(f) < ROUNDED:
            return place
        low, f_low, high, f_high, last = narrow_ends(low, f_low, high, f_high, last, place, f)
    return high


@scalar
def _table_end(rows, i):
    """Squeeze from which the mean pressure is the hardness of the surface."""
    taken = rows[i, TAKEN]
    left = 1 - TABLE_ENDS * taken
    low = high = -math.log(left)
    if _table_excess(rows, i, low, OF_DISC) >= 0:
        if rows[i, HARDER] <= 1:
            return TABLE_ENDS
        return _table_crossing(rows, i, EARLIEST, TABLE_ENDS, OF_PRESSURE)
    if taken == 0:
        return DEEPEST
    while _table_excess(rows, i, high, OF_DISC) < 0 and high < -math.log(THINNEST):
        low, high = high, high + math.log(2.0)
    if high < -math.log(THINNEST):
        high = _table_crossing(rows, i, low, high, OF_DISC)
    return min((1 - math.exp(-high)) / taken, DEEPEST)


@scalar
def _prepare_table(rows, i):
    """Where a side by the table is wide, sinks in, and changes its formula."""
    thin, taken = rows[i, DELTA_1] / rows[i, TIP], rows[i, TAKEN]
    end = _table_end(rows, i)
    rows[i, END] = end / thin
    for eps in (LAW_ENDS, TABLE_BEGINS, *SPLITS, TABLE_ENDS, end):
        if eps <= end:
            _add_kink(rows, i, eps / thin)
    for n in range(breaks(rows, i)):
        if break_at(rows, i, n) * thin < TABLE_BEGINS:
            _add_kink(rows, i, break_at(rows, i, n))
    if _deep_at(rows, i, end)[1] > 1 >= _deep_at(rows, i, TABLE_BEGINS)[1]:
        _add_kink(rows, i, _table_crossing(rows, i, TABLE_BEGINS, end, OF_WIDTH) / thin)
    left = 1 - TABLE_ENDS * taken
    while left > GRADING * (1 - end * taken):
        left /= GRADING
        _add_kink(rows, i, (1 - left) / taken / thin)
    rows[i, CAP] = TABLE_BEGINS / thin


@scalar
def is_split(rows, i, delta):
    """Whether a kink is none, but an end of panels so that series resolve the table."""
    if rows[i, FORM] == DEEP:
        for eps in SPLITS:
            if abs(delta - eps * rows[i, TIP]) < 1e-13:
                return True
    return False


@scalar
def side_at(rows, i, delta):
    """Load over x² [Pa] and area over x² of a side indented by δ over x."""
    keep_apart()
    delta_1 = rows[i, DELTA_1]
    y = delta / delta_1
    if rows[i, FORM] == SQUASHED:
        load, area = _squashed_at(rows, i, min(y, rows[i, END]))
    elif rows[i, FORM] == DEEP:
        thin = delta_1 / rows[i, TIP]
        load, area = _deep_at(rows, i, min(y, rows[i, END]) * thin)
        load, area = load / thin, area / thin
    elif rows[i, FORM] == FACED and y >= rows[i, JOINT]:
        root = rows[i, FACE_START] + rows[i, FACE_RATE] * (min(y, rows[i, CAP]) - rows[i, JOINT])
        area = min(root * root, rows[i, FULL])
        load = rows[i, FACE_PRESSURE] * area
    else:
        cap, full = rows[i, CAP], rows[i, FULL]
        if rows[i, PLATEAU] == 0 and y > cap:
            y = cap
        load, area = law_at(rows, i, y)
        if y > cap:
            load *= full / area
        area = min(area, full)
    return rows[i, UNIT] * load, math.pi * rows[i, TIP] * delta_1 * area


@scalar
def regime_of(rows, i, delta):
    """0 elastic, 1 elastoplastic, 2 plastic, of a side indented by δ over x."""
    keep_apart()
    y = delta / rows[i, DELTA_1]
    if y >= rows[i, CAP] and rows[i, PLATEAU] == 1:
        return 2
    if rows[i, FORM] == FACED:
        y = min(y, rows[i, JOINT])
    return regime_of_branch(rows, i, branch_of(rows, i, y))


@scalar
def _add_kink(rows, i, y):
    """Note a reduced indentation as a kink, in increasing order; equal ones once."""
    keep_apart()
    delta = y * rows[i, DELTA_1]
    n = int(rows[i, COUNT])
    if n >= MOST_KINKS:
        return
    place = n
    while place > 0 and rows[i, KINKS + place - 1] > delta:
        place -= 1
    if place > 0 and rows[i, KINKS + place - 1] >= delta * (1 - 1e-14):
        return
    for j in range(n, place, -1):
        rows[i, KINKS + j] = rows[i, KINKS + j - 1]
    rows[i, KINKS + place] = delta
    rows[i, COUNT] = n + 1


@scalar
def _prepare_disc(rows, i):
    """Where a squashed half is bounded by its volume, is as wide as the sphere, and sinks in."""
    keep_apart()
    delta_1, cap = rows[i, DELTA_1], rows[i, CAP]
    top = 0.5 * (1 - 1e-6) / delta_1
    rows[i, WIDE] = cap
    if cap < top and abs(_excess(rows, i, cap, OF_WIDTH)) > 1e-9:
        low, high = (1e-9 * cap, cap) if _excess(rows, i, cap, OF_WIDTH) > 0 else (cap, top)
        rows[i, WIDE] = _crossing(rows, i, low, high, OF_WIDTH)
    begin = max(rows[i, WIDE], cap)
    high, left = begin, 1 - 2 * delta_1 * begin
    if not left > 0:
        return False
    while _excess(rows, i, high, OF_PRESSURE) < 0:
        left *= 0.5
        if left < 1e-9:
            return False
        high = 0.5 * (1 - left) / delta_1
    rows[i, END] = begin
    if high > begin:
        low = max(begin, 0.5 * (1 - 2 * left) / delta_1)
        rows[i, END] = _crossing(rows, i, low, high, OF_PRESSURE)
    end = rows[i, END]
    for n in range(breaks(rows, i)):
        if break_at(rows, i, n) < end:
            _add_kink(rows, i, break_at(rows, i, n))
    if cap < end:
        _add_kink(rows, i, cap)
    if rows[i, WIDE] < end:
        _add_kink(rows, i, rows[i, WIDE])
    left, last = 1 - 2 * delta_1 * begin, 1 - 2 * delta_1 * end
    while left > GRADING * last:
        left /= GRADING
        _add_kink(rows, i, 0.5 * (1 - left) / delta_1)
    _add_kink(rows, i, end)
    return True


@scalar
def _prepare_faces(rows, i):
    """Where the faces of an angular side begin and end, and what they carry."""
    keep_apart()
    full, edge = rows[i, FULL], rows[i, FACE_AREA]
    rows[i, FULL] = edge
    joint = rows[i, JOINT] = _cap(rows, i)
    rows[i, FULL] = full
    load, area = law_at(rows, i, joint)
    rows[i, FACE_PRESSURE], rows[i, FACE_START] = load / area, math.sqrt(edge)
    deeper = 1 + (math.pi / 2 - 1) * (2 * joint / edge - 1)
    rate = math.sqrt(rows[i, DELTA_1] / rows[i, TIP]) / (rows[i, FACE_TAN] * deeper)
    rows[i, FACE_RATE], rows[i, CAP] = rate, joint + (math.sqrt(full) - math.sqrt(edge)) / rate
    for n in range(breaks(rows, i)):
        if break_at(rows, i, n) < joint:
            _add_kink(rows, i, break_at(rows, i, n))
    _add_kink(rows, i, joint)
    _add_kink(rows, i, rows[i, CAP])


@scalar
def prepare(rows, i):
    """Find the kinks of a side; False where its formulas do not cover it."""
    keep_apart()
    code = rows[i, CODE]
    rows[i, COUNT] = 0
    rows[i, PLATEAU] = 1.0 if GW < code < JG else 0.0
    rows[i, END] = math.inf
    if rows[i, FORM] == DEEP:
        _prepare_table(rows, i)
        last = rows[i, KINKS + int(rows[i, COUNT]) - 1]
        rows[i, LIMIT] = side_at(rows, i, last)[0]
        return rows[i, COUNT] < MOST_KINKS
    if rows[i, FORM] == FACED:
        _prepare_faces(rows, i)
    else:
        rows[i, CAP] = _cap(rows, i)
    cap = rows[i, CAP]
    if rows[i, FORM] == SQUASHED:
        if not _prepare_disc(rows, i):
            return False
    elif rows[i, FORM] != FACED:
        for n in range(breaks(rows, i)):
            y = break_at(rows, i, n)
            if rows[i, PLATEAU] == 1 or y < cap:
                _add_kink(rows, i, y)
        _add_kink(rows, i, cap)
    last = rows[i, KINKS + int(rows[i, COUNT]) - 1]
    rows[i, LIMIT] = side_at(rows, i, last if rows[i, FORM] == SQUASHED else 2 * last)[0]
    return rows[i, COUNT] < MOST_KINKS
