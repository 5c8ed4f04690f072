"""Sides and particles at many nodes of one panel, by loops that processors do with vectors.

On a panel each side keeps to one formula. What is evaluated stands in rows whose length is a
multiple of `VECTOR`: loops over a rest are slow.
"""

from __future__ import annotations

import math

from ..compiled.machine import _bits, _float, exp, keep_apart, njit
from .fields import (
    CAP,
    CEB,
    CODE,
    DEEP,
    DELTA_1,
    END,
    FACED,
    FORM,
    GW,
    HERMITE,
    HILL,
    JOINT,
    KE,
    LAW_1,
    LAW_2,
    LAW_3,
    LAW_4,
    SPHERE,
    TABLE_AREA,
    TABLE_LOAD,
    TABLE_TERMS,
    TAKEN,
    TIP,
    UNIT,
    ZMC,
)
from .sides import (
    FIRST,
    LAST,
    LAW_ENDS,
    TABLE_BEGINS,
    TABLE_ENDS,
    branch_of,
    exact,
    hermite_by,
    scalar,
    side_at,
    zmc_by,
)

__all__ = [
    "VECTOR",
    "exp",
    "fill_law",
    "fill_side",
    "formula_of",
    "formula_of_law",
    "ln",
    "padded_length",
]

VECTOR = 8
"""Numbers that a processor takes at once."""
ANY, ELASTIC, ZMC_MIDDLE, HERMITE_MIDDLE, DOUBLED, PLASTIC, KOGUT_1, KOGUT_2 = range(8)
BLEND, TABLE, DISC = 8, 16, 17
"""Formulas of a side on a panel: of the law; between law and table, with that of the law added; of
the table; of the disc beyond. `ANY` has no loop of its own."""
SPLIT_AT, ONE_BITS = 4604544271217802189, 4503599627370496
"""Bits of √½, and of a step of one in the exponent."""
MAGIC, MAGIC_BITS = 6755399441055744.0, 4843621399236968448
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10


@njit(fastmath={"nnan", "ninf", "nsz", "contract"}, inline="never", error_model="numpy")
def ln(x):
    """ln x of a normal x > 0 without a branch, so that loops over it become vectors.

    x = 2^n m with √½ ≤ m < √2; ln m = 2 artanh((m − 1)/(m + 1)) by its Taylor polynomial.
    Relative error 4e-16.
    """
    bits = _bits(x)
    n = (bits - SPLIT_AT) >> 52
    m = _float(bits - n * ONE_BITS)
    power = _float(MAGIC_BITS + n) - MAGIC
    s = (m - 1) / (m + 1)
    z = s * s
    p = 2 / 21
    p = p * z + 2 / 19
    p = p * z + 2 / 17
    p = p * z + 2 / 15
    p = p * z + 2 / 13
    p = p * z + 2 / 11
    p = p * z + 2 / 9
    p = p * z + 2 / 7
    p = p * z + 2 / 5
    p = p * z + 2 / 3
    return power * LN2_HIGH + (s * (p * z) + power * LN2_LOW + 2 * s)


@scalar
def padded_length(count):
    """Length of a row for so many numbers."""
    return (count + VECTOR - 1) // VECTOR * VECTOR


# ------------------------------------------------------------------------------ which formula
@scalar
def formula_of_law(rows, i, y):
    """Formula of the law of a row at y."""
    code, branch = rows[i, CODE], branch_of(rows, i, y)
    found = ANY
    if code == GW:
        found = ELASTIC
    elif ZMC <= code <= HERMITE:
        found = HERMITE_MIDDLE if code == HERMITE else ZMC_MIDDLE
        if branch != 1:
            found = ELASTIC if branch == 0 else DOUBLED
    elif code == CEB:
        found = ELASTIC if branch == 0 else PLASTIC
    elif code == KE:
        found = ELASTIC
        if branch > 0:
            found = DOUBLED if branch == 3 else KOGUT_1 + branch - 1
    return found


@scalar
def formula_of(rows, i, delta):
    """Formula of a side around an indentation δ over x."""
    keep_apart()
    form, y = rows[i, FORM], delta / rows[i, DELTA_1]
    if form == SPHERE and y < rows[i, CAP]:
        return formula_of_law(rows, i, y)
    if form == FACED and y < rows[i, JOINT]:
        return formula_of_law(rows, i, y)
    if form == DEEP and y < rows[i, END]:
        eps = delta / rows[i, TIP]
        if eps > TABLE_ENDS:
            return DISC
        if eps >= TABLE_BEGINS:
            return TABLE
        found = formula_of_law(rows, i, y)
        if eps > LAW_ENDS and found != ANY:
            found += BLEND
        return found
    return ANY


# ------------------------------------------------------------------------------ loops
@exact
def _fill_elastic(rate, unit, breadth, factor, r, delta, load, area):
    for j in range(len(delta)):
        y = delta[j] * rate
        load[j] = unit * factor * r * y * math.sqrt(y)
        area[j] = breadth * r * y


@exact
def _fill_zmc(rate, unit, breadth, k, rho, r, full, delta, load, area):
    log_rho = math.log(rho)
    for j in range(len(delta)):
        y = delta[j] * rate
        pressure, spread = zmc_by(y, ln(y), log_rho, k, rho, r, full)
        load[j] = unit * pressure * spread
        area[j] = breadth * spread


@exact
def _fill_hermite(rate, unit, breadth, k, rho, r, full, delta, load, area):
    log_rho = math.log(rho)
    for j in range(len(delta)):
        y = delta[j] * rate
        pressure, spread = hermite_by(y, ln(y), log_rho, k, rho, r, full)
        load[j] = unit * pressure * spread
        area[j] = breadth * spread


@exact
def _fill_doubled(rate, unit, breadth, full, delta, load, area):
    for j in range(len(delta)):
        y = full * delta[j] * rate
        load[j] = unit * y
        area[j] = breadth * y


@exact
def _fill_plastic(rate, unit, breadth, K, r, slope, delta, load, area):
    for j in range(len(delta)):
        spread = r + slope * (delta[j] * rate - 1)
        load[j] = unit * K * spread
        area[j] = breadth * spread


@exact
def _fill_powers(rate, unit, breadth, f, m, a, n, delta, load, area):
    for j in range(len(delta)):
        log_y = ln(delta[j] * rate)
        load[j] = unit * f * exp(m * log_y)
        area[j] = breadth * a * exp(n * log_y)


@scalar
def fill_law(rows, i, formula, rate, unit, breadth, delta, load, area):
    """Load and area of the law of a row by a formula, in these units, y being rate times δ."""
    keep_apart()
    code, first, rho = rows[i, CODE], rows[i, LAW_1], rows[i, LAW_2]
    r, full = rows[i, LAW_3], rows[i, LAW_4]
    if formula == ELASTIC:
        factor, wide = 1.0, 1.0
        if ZMC <= code <= HERMITE:
            factor, wide = first, r
        elif code == CEB:
            factor, wide = 2 / 3 * first, rho
        elif code == KE:
            factor = 2 / 3 * first
        _fill_elastic(rate, unit, breadth, factor, wide, delta, load, area)
    elif formula == HERMITE_MIDDLE:
        _fill_hermite(rate, unit, breadth, first, rho, r, full, delta, load, area)
    elif formula == ZMC_MIDDLE:
        _fill_zmc(rate, unit, breadth, first, rho, r, full, delta, load, area)
    elif formula == DOUBLED:
        wide = 2.0 if code == KE else full
        _fill_doubled(rate, unit, breadth, wide, delta, load, area)
    elif formula == PLASTIC:
        _fill_plastic(rate, unit, breadth, first, rho, r, delta, load, area)
    elif formula == KOGUT_1:
        unit *= 2 / 3 * first
        _fill_powers(rate, unit, breadth, 1.03, 1.425, 0.93, 1.136, delta, load, area)
    else:
        unit *= 2 / 3 * first
        _fill_powers(rate, unit, breadth, 1.40, 1.263, 0.94, 1.146, delta, load, area)


@exact
def _fill_table(series, rate, unit, breadth, delta, load, area):
    """By both Chebyshev series of the table."""
    keep_apart()
    of_load, of_area = series[:TABLE_TERMS], series[TABLE_TERMS:]
    for j in range(len(delta)):
        eps = delta[j] * rate
        x = (2 * ln(eps / (1 - eps)) - FIRST - LAST) / (LAST - FIRST)
        b_1, c_1, b_2, c_2, twice = 0.0, 0.0, 0.0, 0.0, 2 * x
        for k in range(1, TABLE_TERMS):
            b_1, c_1 = of_load[TABLE_TERMS - k] + twice * b_1 - c_1, b_1
            b_2, c_2 = of_area[TABLE_TERMS - k] + twice * b_2 - c_2, b_2
        load[j] = unit * exp(of_load[0] + x * b_1 - c_1)
        area[j] = breadth * exp(of_area[0] + x * b_2 - c_2)


@exact
def _fill_disc(first, last, thick, taken, hill, rate, unit, breadth, delta, load, area):
    """As `sides._disc_at`, from the load and the area where the table ends."""
    begin = 1 + hill * math.sqrt(last) / thick
    for j in range(len(delta)):
        left = 1 - taken * (delta[j] * rate)
        wide = last * thick / left
        rise = (1 + hill * math.sqrt(wide) / left) / begin
        load[j] = unit * first * thick / left * rise
        area[j] = breadth * wide


@exact
def _join(rate, delta, load, area, table_load, table_area):
    """Between law and table, into the place of the first."""
    for j in range(len(delta)):
        eps = delta[j] * rate
        u = ln(eps / LAW_ENDS) / math.log(TABLE_BEGINS / LAW_ENDS)
        w = u * u * (3 - 2 * u)
        load[j] *= exp(w * ln(table_load[j] / load[j]))
        area[j] *= exp(w * ln(table_area[j] / area[j]))


@scalar
def fill_side(rows, i, formula, delta, load, area, passing, passing_2):
    """Load over x² [Pa] and area over x² of a side by a formula, at indentations δ over x.

    The last two rows are for what is on the way.
    """
    keep_apart()
    if formula == ANY:
        for j in range(len(delta)):
            load[j], area[j] = side_at(rows, i, delta[j])
        return
    once, own = 1 / rows[i, DELTA_1], math.pi * rows[i, TIP] * rows[i, DELTA_1]
    if formula < BLEND:
        fill_law(rows, i, formula, once, rows[i, UNIT], own, delta, load, area)
        return
    rate, thin = 1 / rows[i, TIP], rows[i, DELTA_1] / rows[i, TIP]
    unit, breadth = rows[i, UNIT] / thin, math.pi * rows[i, TIP] * rows[i, TIP]
    series = rows[i, TABLE_LOAD : TABLE_AREA + TABLE_TERMS]
    if formula == TABLE:
        _fill_table(series, rate, unit, breadth, delta, load, area)
    elif formula == DISC:
        # load and area where the table ends: every polynomial is one there
        first = last = 0.0
        for k in range(TABLE_TERMS):
            first += series[k]
            last += series[TABLE_TERMS + k]
        _fill_disc(
            math.exp(first), math.exp(last), 1 - TABLE_ENDS * rows[i, TAKEN], rows[i, TAKEN],
            rows[i, HILL], rate, unit, breadth, delta, load, area,
        )  # fmt: skip
    else:
        fill_law(rows, i, formula - BLEND, once, rows[i, UNIT], own, delta, load, area)
        _fill_table(series, rate, unit, breadth, delta, passing, passing_2)
        _join(rate, delta, load, area, passing, passing_2)
