"""The compiled engine: balances of many states, solved one after another in machine code.

Everything here is a sum over nodes or a Chebyshev series; what the nodes and coefficients mean is
said once, by the laws and populations from which `engine` takes them. The state is solved for
the separation h of the asperities in σ_s, counted from their mean height.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import extending, types
from numba import njit as _njit

from .cached import Cached

__all__ = ["FIELDS", "solve_states"]

njit: Any = _njit
intrinsic: Any = extending.intrinsic
"""Untyped: what they make is called with other arguments than it is written with."""

SUM = {"nnan", "ninf", "nsz", "arcp", "contract", "reassoc"}
"""Sums may be reordered into vectors; inputs are finite."""
EXACT = {"nnan", "ninf", "nsz", "contract"}
"""Where the order of operations carries the meaning."""

INNER = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Options of functions that only the kernels call."""
exact, sums = njit(fastmath=EXACT, **INNER), njit(fastmath=SUM, **INNER)
inlined = njit(fastmath=EXACT, inline="always", **INNER)
"""What one function alone calls, compiled as a part of it: apart, it would be optimised twice."""

FIELDS = ("F_ss", "e", "ep", "p", "F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow")
"""Columns of a solved state: asperities without shadow, then particles."""

# An interface is a row of integers and a row of floats: asperities first, then its parts.
SHADOW, KIND, BEGIN, END, GUESS, PARTS = range(6)
"""Column of the particles that is the shadow (−1: the coverage); kind of sum over asperities, its
panels from BEGIN to END; panel with its inverse, for a first guess, or −1; where the parts begin,
each PART_KINDS long: kind, begin and end of a series, then of that of a plane for small gaps; or
over a rough seat begin and length of rules over gaps, over sizes, over fewer gaps, and over few
sizes; its inverse, or −1; and the terms of both rules over gaps where they are series, or −1."""
PART_KINDS, PART_GUESS, PART_TERMS = 11, 9, 10
ACROSS, SIGMA_S, CENTRE, FORCE, AREA, HIGHEST, COVERAGE, VALUES = range(8)
"""place of ω_1/σ_s in its family (−1 to 1), σ_s and the mean height [m], units of load [Pa] and
area, highest separation [σ_s], coverage; where the parts begin, each PART_VALUES long, lengths in
the size of the part:"""
SIZE, FACTOR, OFFSET, WIDTH, REACH, LEAST, TOP, BOTTOM, JOIN, POWERS, FLOOR = *range(10), 16
PLACE, MODULUS = 23, 24
NEAR = JOIN
"""size [m]; density × size²: the unit of area, and of load per Pa; gap − d [m]; width of a rough
seat; gap above which nothing is carried; gap below which each carries its most, on the seat (not
asked where it has nodes) and on a plane; gap between the two series of a plane, or the widths of a
seat beyond the gaps within which the fewer are as good, −1 where they only come close; leading
powers of √(top − gap) of the seven columns; the seven columns below the least gap; where the part
lies on series of rules (−1 to 1), and its modulus, their unit of load."""
PART_VALUES = 25

FAMILY, GAUSSIAN, DENSITY = range(3)
"""Asperities: by a series in h and in ω_1/σ_s beside the Gaussian, by one in h, by one in h
without the Gaussian."""
ABSENT, PLANE, ROUGH, ROUGH_NODES = -1, 0, 1, 2
"""Particles: none, by series on a plane, by a series or over nodes on a rough seat."""

TERMS, LOAD, EVERY, PANEL, ROWS = 18, 0, 6, 13, 14
"""A panel of a Chebyshev series: rows of TERMS coefficients, six for the balance and seven for
the columns, and a last row with its left edge and half width. A family has ACROSS_TERMS panels, one
for each term across it, where a series has one."""
ACROSS_TERMS = 16
DROP = 1.25 * math.log(2) / 4
"""About how much ln of the asperities' load falls from the middle of a family to its end."""
AT = 7
"""Row of the abscissae in a rule (8, nodes) over gaps, below weight times the seven columns; a rule
of sizes has two rows, weights and sizes."""

SEAT_REACH = 9.0
"""Standard deviations of the seat above a gap that count; twice as many count below it."""
YES, NO = np.bool_(True), np.bool_(False)
"""Typed, so that one compiled function serves both."""
OK, TOO_MUCH, TOO_LITTLE, UNSOLVED, TOO_DEEP = range(5)
"""What became of a state; too deep is for those who give a separation to say."""
LOWEST, START, MOST, STEPS = -3.0, 1.0, 120, 30
"""Lowest separation searched [σ_s], the first guess, and the most evaluations of the load, of
which those after STEPS only halve the bracket."""
ROUNDING = 1e-16
"""Error [σ_s] that a third-order step may leave behind."""
RESIDUAL, WORST = 2e-13, 1e-3
"""Imbalance of the load of a solved state, and where an ulp of separation changes it by more."""
ULP, EPSILON = 5e-16, 2.220446049250313e-16
"""Error of a separation in the load at it, and width of the smallest bracket: over the larger of
the separation and 1 [σ_s]."""
FLAT = 1e-100
"""Slope of ln F [1/σ_s] below which no step is taken along it."""
CLOSE = 0.02
"""Step [σ_s] after which few nodes are left for all."""
MEMBER = 24
RULE, MOST_NODES = MEMBER + ROWS * TERMS, 256
FEWER_RULE = RULE + 1 + 8 * MOST_NODES
EACH = FEWER_RULE + 1 + 8 * MOST_NODES
SCRATCH = EACH + 3 * MOST_NODES
"""Floats that a state needs to work in; from MEMBER on its panel in a family; from RULE and
FEWER_RULE on where the series of a rule begins, and the rule on it; from EACH on sums at the nodes
of a rule."""


@intrinsic
def _bits(typingctx: Any, x: Any) -> Any:
    """The 64 bits of a float as an integer."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@intrinsic
def _float(typingctx: Any, n: Any) -> Any:
    """The float with these 64 bits."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), codegen


@intrinsic
def _pointer(typingctx: Any, array: Any) -> Any:
    """To the first number of a contiguous array, which the caller keeps alive."""

    def codegen(context, builder, signature, args):
        return context.make_array(signature.args[0])(context, builder, args[0]).data

    return types.CPointer(array.dtype)(array), codegen


@intrinsic
def _from(typingctx: Any, pointer: Any, n: Any) -> Any:
    """The pointer n numbers further."""

    def codegen(context, builder, signature, args):
        return builder.gep(args[0], [args[1]])

    return pointer(pointer, types.intp), codegen


LOG2E = 1.4426950408889634
LN2_HIGH = 6.93147180369123816490e-01
LN2_LOW = 1.90821492927058770002e-10
MAGIC = 6755399441055744.0


@njit(fastmath=EXACT, inline="never", error_model="numpy")
def exp(x):
    """exp(x) for −700 < x < 700 without a branch, so that loops over it become vectors.

    x = n ln 2 + r with |r| ≤ ln 2/2; exp(r) by its Taylor polynomial, 2^n by its bits. Relative
    error 3e-16.
    """
    z = x * LOG2E + MAGIC
    n = z - MAGIC
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    p = 1.6059043836821613e-10
    p = p * r + 2.08767569878681e-09
    p = p * r + 2.505210838544172e-08
    p = p * r + 2.755731922398589e-07
    p = p * r + 2.7557319223985893e-06
    p = p * r + 2.48015873015873e-05
    p = p * r + 0.0001984126984126984
    p = p * r + 0.001388888888888889
    p = p * r + 0.008333333333333333
    p = p * r + 0.041666666666666664
    p = p * r + 0.16666666666666666
    p = p * r + 0.5
    p = p * r + 1.0
    p = p * r + 1.0
    return p * _float((_bits(z) << 52) + 4607182418800017408)


@njit(fastmath=EXACT, inline="never", error_model="numpy")
def normal_cdf(z, density):
    """Φ(z) = ½ erfc(−z/√2), where ``density`` is exp(−z²/2), without a branch.

    (1 + 2x) exp(x²) erfc(x), x = |z|/√2, is a polynomial in (x − 3.75)/(x + 3.75): its Chebyshev
    series of degree 22, from sixty digits. Relative error 1e-15 for z < 0.
    """
    x = abs(z) / math.sqrt(2)
    s = (x - 3.75) / (x + 3.75)
    p = -2.623107347133476e-09
    p = p * s - 1.9551358868985616e-09
    p = p * s + 3.197926671666804e-08
    p = p * s + 1.879082322370048e-08
    p = p * s - 2.4857126248016745e-07
    p = p * s - 5.084465378687302e-08
    p = p * s + 1.7419821586224816e-06
    p = p * s - 9.792625707303523e-07
    p = p * s - 1.1438048033346894e-05
    p = p * s + 2.2387565714911816e-05
    p = p * s + 5.164652974177416e-05
    p = p * s - 0.00029015535246077655
    p = p * s + 0.000293714378044958
    p = p * s + 0.0017556261651970652
    p = p * s - 0.009746579683265262
    p = p * s + 0.02836227737211114
    p = p * s - 0.05869339857664934
    p = p * s + 0.09230432116428125
    p = p * s - 0.10880393014244462
    p = p * s + 0.08227673848999506
    p = p * s + 0.0035854154854790257
    p = p * s - 0.14024059858554525
    p = p * s + 1.2375126308378275
    tail = 0.5 * density * p / (1 + 2 * x)
    return 1 - tail if z > 0 else tail


class State(NamedTuple):
    """What describes one state to the kernels, by pointers: passing arrays costs more than sums."""

    kinds: Any
    """row of integers of its interface"""
    values: Any
    """row of floats of its interface"""
    parts: Any
    """number of parts of the particles"""
    series: Any
    edges: Any
    """left edge of every panel of the series"""
    rules: Any
    work: Any
    """SCRATCH floats to work in"""


# ---------------------------------------------------------------- series and rules
@exact
def _panel(edges, begin, end, x, stride):
    """The panel of begin:end:stride whose left edge is the last that x has passed."""
    low, count = 0, (end - begin) // stride
    while count > 1:  # as many steps for any x, without a branch to guess wrong
        half = count >> 1
        low += half if edges[begin + (low + half) * stride] <= x else 0
        count -= half
    return begin + low * stride


@exact
def _polynomials(s):
    """Chebyshev polynomials T_2 to T_17."""
    # T_2k = 2T_k² − 1 and T_2k+1 = 2T_k T_k+1 − s: a short chain of dependent steps
    z = 2 * s
    t2 = z * s - 1
    t3 = z * t2 - s
    t4, t5 = 2 * t2 * t2 - 1, 2 * t2 * t3 - s
    t6, t7 = 2 * t3 * t3 - 1, 2 * t3 * t4 - s
    t8, t9 = 2 * t4 * t4 - 1, 2 * t4 * t5 - s
    t10, t11 = 2 * t5 * t5 - 1, 2 * t5 * t6 - s
    t12, t13 = 2 * t6 * t6 - 1, 2 * t6 * t7 - s
    t14, t15 = 2 * t7 * t7 - 1, 2 * t7 * t8 - s
    t16, t17 = 2 * t8 * t8 - 1, 2 * t8 * t9 - s
    return t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, t16, t17


@sums
def _series(panel, x, row, count, out):
    """Rows of a Chebyshev series at x, from ``row`` on, into ``out``."""
    edge = _from(panel, PANEL * TERMS)
    s = min(max((x - edge[0]) / edge[1] - 1.0, -1.0), 1.0)
    t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, t16, t17 = _polynomials(s)
    for k in range(count):
        c = _from(panel, (row + k) * TERMS)
        low = c[0] + c[1] * s + c[2] * t2 + c[3] * t3 + c[4] * t4 + c[5] * t5
        middle = c[6] * t6 + c[7] * t7 + c[8] * t8 + c[9] * t9 + c[10] * t10 + c[11] * t11
        high = c[12] * t12 + c[13] * t13 + c[14] * t14 + c[15] * t15 + c[16] * t16 + c[17] * t17
        out[k] = low + middle + high


@sums
def _member(family, x, row, count, panel):
    """Rows of the panel of one member, x across the family (−1 to 1), into ``panel``."""
    edge, own = _from(family, PANEL * TERMS), _from(panel, PANEL * TERMS)
    own[0], own[1] = edge[0], edge[1]
    t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, _, _ = _polynomials(x)
    n = ROWS * TERMS
    for i in range(row * TERMS, (row + count) * TERMS):
        c = _from(family, i)
        low = c[0] + c[n] * x + c[2 * n] * t2 + c[3 * n] * t3 + c[4 * n] * t4 + c[5 * n] * t5
        middle = c[6 * n] * t6 + c[7 * n] * t7 + c[8 * n] * t8 + c[9 * n] * t9 + c[10 * n] * t10
        high = c[11 * n] * t11 + c[12 * n] * t12 + c[13 * n] * t13 + c[14 * n] * t14
        panel[i] = low + middle + (high + c[15 * n] * t15)


@exact
def _below(at, low, high, x):
    """The first of the abscissae low:high that is not below x."""
    if low == high or not at[low] < x:
        return low
    if at[high - 1] < x:
        return high
    count = high - low
    while count > 1:
        half = count >> 1
        low += half if at[low + half] < x else 0
        count -= half
    return low + 1


# ---------------------------------------------------------------- asperities
@exact
def _asperities(state, h, every, out):
    """Load [Pa] with two derivatives in h, or ``every`` column: load and areas by regime."""
    kinds, values, series = state.kinds, state.values, state.series
    kind, row, count = kinds[KIND], EVERY if every else LOAD, 4 if every else 3
    if h > values[HIGHEST]:
        for k in range(4):
            out[k] = 0.0
        return
    stride = ACROSS_TERMS if kind == FAMILY else 1
    place = _panel(state.edges, kinds[BEGIN], kinds[END], h, stride)
    panel = _from(series, place * ROWS * TERMS)
    if kind == FAMILY:
        member = _from(state.work, MEMBER)
        held = _from(member, PANEL * TERMS + 2 + every)
        if held[0] != place:
            _member(panel, values[ACROSS], row, count, member)
            held[0] = place
        panel = member
    _series(panel, h, row, count, out)
    factor = values[FORCE]
    if kind != DENSITY:
        factor *= exp(-0.5 * h * h)
        if not every:
            m0, m1, m2 = out[0], out[1], out[2]
            out[1], out[2] = -(h * m0 + m1), (h * h - 1) * m0 + 2 * h * m1 + m2
    out[0] *= factor
    if every:
        factor *= values[AREA] / values[FORCE]
    for k in range(1, 4):
        out[k] *= factor
        if every:
            out[k] = max(out[k], 0.0)  # rounding of the other regimes


# ---------------------------------------------------------------- particles
@sums
def _seat_nodes(rule, nodes, begin, end, gap, width, size, shadow, every, out):
    """Σ c exp(−z²/2) over local gaps: load and shadow with two derivatives, or every column."""
    inverse = 1 / width
    norm = inverse / math.sqrt(2 * math.pi)
    at, c0 = _from(rule, AT * nodes + begin), _from(rule, begin)
    if every:
        c1, c2, c3 = _from(c0, nodes), _from(c0, 2 * nodes), _from(c0, 3 * nodes)
        c4, c5, c6 = _from(c0, 4 * nodes), _from(c0, 5 * nodes), _from(c0, 6 * nodes)
        a = b = c = d = e = f = g = 0.0
        for i in range(end - begin):
            z = (gap - size * at[i]) * inverse
            density = exp(-0.5 * z * z)
            a += density * c0[i]
            b += density * c1[i]
            c += density * c2[i]
            d += density * c3[i]
            e += density * c4[i]
            f += density * c5[i]
            g += density * c6[i]
        out[0], out[1], out[2], out[3] = norm * a, norm * b, norm * c, norm * d
        out[4], out[5], out[6] = norm * e, norm * f, norm * g
        return
    c1 = _from(c0, shadow * nodes)
    s0 = s1 = s2 = t0 = t1 = t2 = 0.0
    for i in range(end - begin):
        z = (gap - size * at[i]) * inverse
        density = exp(-0.5 * z * z)
        load, area = density * c0[i], density * c1[i]
        s0 += load
        s1 += load * z
        s2 += load * z * z
        t0 += area
        t1 += area * z
        t2 += area * z * z
    out[0], out[1], out[2] = norm * s0, -norm * inverse * s1, norm * inverse * inverse * (s2 - s0)
    out[3], out[4], out[5] = norm * t0, -norm * inverse * t1, norm * inverse * inverse * (t2 - t0)


@sums
def _spread(at, nodes, weights, sizes, count, gap, inverse, out):
    """Σ w exp(−z²/2) z^k over sizes at each of the gaps of a rule, for k = 0, 1, 2 in turn."""
    first, second = _from(out, nodes), _from(out, 2 * nodes)
    for i in range(3 * nodes):
        out[i] = 0.0
    for n in range(count):
        weight, size = weights[n], sizes[n]
        for i in range(nodes):
            z = (gap - size * at[i]) * inverse
            density = weight * exp(-0.5 * z * z)
            out[i] += density
            first[i] += density * z
            second[i] += density * z * z


@sums
def _below_bottom(bottom, weights, sizes, count, gap, inverse):
    """Σ w/size of the share of a seat below the bottom of each size, and of its derivatives."""
    s0 = s1 = s2 = 0.0
    for n in range(count):
        weight, z = weights[n] / sizes[n], (sizes[n] * bottom - gap) * inverse
        density = exp(-0.5 * min(z * z, 1_000.0))
        s0 += weight * normal_cdf(z, density)
        s1 += weight * density
        s2 += weight * density * z
    norm = inverse / math.sqrt(2 * math.pi)
    return s0, norm * s1, norm * inverse * s2


@sums
def _weighted(rule, nodes, moments, inverse, shadow, every, out):
    """Add Σ c m over a rule: load and shadow with two derivatives, or every column."""
    norm = inverse / math.sqrt(2 * math.pi)
    m1, m2 = _from(moments, nodes), _from(moments, 2 * nodes)
    for j in range(7 if every else 2):
        c = _from(rule, (j if every else j * shadow) * nodes)
        s0 = s1 = s2 = 0.0
        for i in range(nodes):
            s0 += c[i] * moments[i]
            s1 += c[i] * m1[i]
            s2 += c[i] * m2[i]
        if every:
            out[j] += norm * s0
        else:
            out[3 * j] += norm * s0
            out[3 * j + 1] -= norm * inverse * s1
            out[3 * j + 2] += norm * inverse * inverse * (s2 - s0)


@sums
def _on_series(series, terms, x, count, out):
    """Sum of Chebyshev polynomials at x times ``count`` coefficients of each of an even number."""
    even, odd = 1.0, x
    for k in range(count):
        out[k] = 0.0
    for n in range(0, terms, 2):
        a = _from(series, n * count)
        b = _from(a, count)
        for k in range(count):
            out[k] += even * a[k] + odd * b[k]
        even = 2 * x * odd - even
        odd = 2 * x * even - odd


@exact
def _gaps(state, kinds, part, fewer):
    """The rule over gaps of a part, or the one with fewer."""
    i = 5 if fewer else 1
    begin, nodes = kinds[i], kinds[i + 1]
    rule = _from(state.rules, begin)
    if kinds[PART_TERMS] < 0:
        return rule
    held = _from(state.work, FEWER_RULE if fewer else RULE)
    own = _from(held, 1)
    if held[0] != begin:
        _on_series(rule, kinds[PART_TERMS], part[PLACE], 8 * nodes, own)
        for k in range(nodes):
            own[k] *= part[MODULUS]
        held[0] = begin
    return own


@inlined
def _rough_nodes(state, kinds, part, gap, shadow, every, few, out, each):
    """Particles on a rough seat by the sum over sizes and over local gaps in their size.

    A seat near all sizes weighs the same gaps for all of them, so they are summed first.
    """
    bottom, width, inverse = part[BOTTOM], part[WIDTH], 1 / part[WIDTH]
    begin, count = (kinds[7], kinds[8]) if few else (kinds[3], kinds[4])
    weights, sizes = _from(state.rules, begin), _from(state.rules, begin + count)
    for k in range(7):
        out[k] = 0.0
    near = part[NEAR] * width
    if near > 0 and max(gap - sizes[0] * part[TOP], sizes[count - 1] * bottom - gap) < near:
        rule, nodes, moments = _gaps(state, kinds, part, YES), kinds[6], _from(state.work, EACH)
        _spread(_from(rule, AT * nodes), nodes, weights, sizes, count, gap, inverse, moments)
        _weighted(rule, nodes, moments, inverse, shadow, every, out)
    else:
        for n in range(count):
            size = sizes[n]
            fewer = max(gap - size * part[TOP], size * bottom - gap) < near if near > 0 else few
            rule, nodes = _gaps(state, kinds, part, fewer), kinds[6 if fewer else 2]
            at = _from(rule, AT * nodes)
            # far above the largest particles the many below them carry the load
            low = _below(at, 0, nodes, (gap - 2 * SEAT_REACH * width) / size)
            high = _below(at, low, nodes, (gap + SEAT_REACH * width) / size)
            _seat_nodes(rule, nodes, low, high, gap, width, size, shadow, every, each)
            for k in range(7):
                out[k] += weights[n] * each[k]
    s0, s1, s2 = _below_bottom(bottom, weights, sizes, count, gap, inverse)
    for k in range(7 if every else 2):
        if every:
            out[k] += part[FLOOR + k] * s0
        else:
            floor = part[FLOOR + k * shadow]
            out[3 * k] += floor * s0
            out[3 * k + 1] -= floor * s1
            out[3 * k + 2] -= floor * s2


@exact
def _power(u, n):
    """u to a small whole number."""
    out = 1.0
    for _ in range(int(n)):
        out *= u
    return out


@exact
def _rise(part, u, shadow, every, out):
    """From series in u = √(top − gap) without their leading power to columns and derivatives."""
    if every:
        for k in range(7):
            out[k] *= _power(u, part[POWERS + k])
        return
    inverse = 1 / u
    square = inverse * inverse
    for j in range(0, 6, 3):
        value, first, second = out[j], out[j + 1] * u, out[j + 2] * u * u
        n = part[POWERS + (shadow if j else 0)]
        lead = _power(u, n)
        du = first + n * value
        out[j] = lead * value
        out[j + 1] = -0.5 * lead * square * du
        ddu = second + 2 * n * first + n * (n - 1) * value
        out[j + 2] = 0.25 * lead * square * square * (ddu - du)


@exact
def _particles(state, d, every, few, total, out, each):
    """Load [Pa] and shadow with two derivatives in d, or ``every`` one of the seven columns."""
    shadow = max(state.kinds[SHADOW], 0)
    for k in range(7):
        total[k] = 0.0
    for p in range(state.parts):
        kinds = _from(state.kinds, PARTS + PART_KINDS * p)
        part = _from(state.values, VALUES + PART_VALUES * p)
        kind, begin, end = kinds[0], kinds[1], kinds[2]
        if kind == ABSENT:
            continue
        size = part[SIZE]
        gap = (d + part[OFFSET]) / size
        if gap >= part[REACH]:
            continue
        if gap < part[LEAST] and kind != ROUGH_NODES:
            for k in range(7):
                out[k] = part[FLOOR + k] if every else 0.0
            if not every:
                out[0], out[3] = part[FLOOR], part[FLOOR + shadow]
        elif kind == ROUGH_NODES:
            _rough_nodes(state, kinds, part, gap, shadow, every, few, out, each)
        else:
            x, rise = gap, False
            if kind == PLANE:
                rise = gap >= part[JOIN]
                if rise:
                    x = math.sqrt(part[TOP] - gap)
                else:
                    begin, end = kinds[3], kinds[4]
            row, count = (EVERY, 7) if every else (LOAD, 6)
            place = _panel(state.edges, begin, end, x, 1)
            _series(_from(state.series, place * ROWS * TERMS), x, row, count, out)
            if rise:
                _rise(part, x, shadow, every, out)
        factor = part[FACTOR]
        if every:
            for k in range(7):
                total[k] += factor * out[k]
        else:
            inverse = 1 / size
            for k in range(3):
                total[k] += factor * out[k]
                total[3 + k] += factor * out[3 + k]
                factor *= inverse
    if state.kinds[SHADOW] < 0 and not every:
        total[3], total[4], total[5] = state.values[COVERAGE], 0.0, 0.0


# ---------------------------------------------------------------- the balance
@exact
def _contact(state, h, every, few, row):
    """Total load [Pa] with its first and second derivative in h, by all nodes or by few.

    With ``every``, the columns `FIELDS` into ``row`` instead.
    """
    total, out, each = state.work, _from(state.work, 8), _from(state.work, 16)
    _asperities(state, h, every, out)
    f, f1, f2 = out[0], out[1], out[2]
    if every:
        for k in range(10):
            row[k] = out[k] if k < 4 else 0.0
    if state.parts == 0:
        return f, f1, f2
    sigma_s, shadow = state.values[SIGMA_S], state.kinds[SHADOW]
    d = state.values[CENTRE] + sigma_s * h
    _particles(state, d, every, few, total, out, each)
    if every:
        for k in range(5):
            row[4 + k] = max(total[k], 0.0)  # rounding of the other regimes
        row[9] = state.values[COVERAGE] if shadow < 0 else min(max(total[shadow], 0.0), 1.0)
        return f, f1, f2
    if total[3] >= 1:  # squashed particles that leave nothing to asperities
        total[3], total[4], total[5] = 1.0, 0.0, 0.0
    bare, s1, s2 = 1 - total[3], sigma_s * total[4], sigma_s * sigma_s * total[5]
    return (
        bare * f + total[0],
        bare * f1 - s1 * f + sigma_s * total[1],
        bare * f2 - 2 * s1 * f1 - s2 * f + sigma_s * sigma_s * total[2],
    )


@exact
def _highest(state):
    """Separation [σ_s] above which nothing is carried."""
    high = state.values[HIGHEST]
    for p in range(state.parts):
        if state.kinds[PARTS + PART_KINDS * p] != ABSENT:
            part = _from(state.values, VALUES + PART_VALUES * p)
            reach = part[REACH] * part[SIZE] - part[OFFSET]
            high = max(high, (reach - state.values[CENTRE]) / state.values[SIGMA_S])
    return high


@exact
def _has_few(state):
    """Whether there are few sizes or gaps, quick and close, beside all of them."""
    few = NO
    for p in range(state.parts):
        kinds = _from(state.kinds, PARTS + PART_KINDS * p)
        part = _from(state.values, VALUES + PART_VALUES * p)
        few |= kinds[0] == ROUGH_NODES and (kinds[8] < kinds[4] or part[NEAR] < 0)
    return few


@exact
def _inverse(panel, log_load):
    """Separation by straight lines over √(most − ln F): a panel of most, step, separations."""
    x = math.sqrt(max(panel[0] - log_load, 0.0)) / panel[1]
    i = min(int(x), ROWS * TERMS - 4)
    return panel[2 + i] + min(x - i, 1.0) * (panel[3 + i] - panel[2 + i])


@exact
def _start(state, target):
    """The highest of the separations at which asperities, or a part of the particles, do alone."""
    kinds, values = state.kinds, state.values
    if kinds[GUESS] < 0:
        return START
    log_load = math.log(target / values[FORCE]) + DROP * values[ACROSS]
    h = _inverse(_from(state.series, kinds[GUESS] * ROWS * TERMS), log_load)
    for p in range(state.parts):
        place = kinds[PARTS + PART_KINDS * p + PART_GUESS]
        if place >= 0:
            part = _from(values, VALUES + PART_VALUES * p)
            log_load = math.log(target / part[FACTOR])
            gap = part[SIZE] * _inverse(_from(state.series, place * ROWS * TERMS), log_load)
            h = max(h, (gap - part[OFFSET] - values[CENTRE]) / values[SIGMA_S])
    return h


@exact
def _guess(scan, log_target):
    """h by inverse cubic interpolation in a scan of ln F and its slope, falling with h."""
    count = len(scan) - 1
    if not scan[count, 1] < log_target < scan[0, 1]:
        return START
    low = 0
    while count > 1:
        half = count >> 1
        low += half if scan[low + half, 1] >= log_target else 0
        count -= half
    high = low + 1
    rise = scan[high, 1] - scan[low, 1]
    s = (log_target - scan[low, 1]) / rise
    a, b = scan[low, 0], scan[high, 0]
    # slopes dh/ds at both ends
    p, q = rise / scan[low, 2], rise / scan[high, 2]
    h = a + s * (b - a) + s * (1 - s) * ((1 - s) * (p - (b - a)) - s * (q - (b - a)))
    return h if a <= h <= b else a + s * (b - a)


@exact
def _step(f, slope, bend):
    """Euler's third-order step to the root of f with its first two derivatives."""
    inside = 1 - 2 * f * bend / (slope * slope)
    step = -f / slope
    return step * 2 / (1 + math.sqrt(inside)) if inside > 0 else step


@inlined
def _balances(state, h, target, row, sure):
    """Columns at h, into ``row``, and whether they carry the load; less is asked of a sure h."""
    _contact(state, h, YES, NO, row)
    error = abs((1 - row[9]) * row[0] + row[4] - target) / target
    return error < RESIDUAL or (sure and error < WORST)


@inlined
def _root(state, target, h, row):
    """Separation h from a first guess, evaluations by all nodes, fate and columns of one state.

    Steps on ln F_t(h) = ln F, exact where ln F_t is a parabola as it is in a Gaussian tail, inside
    a bracket that is halved where a step leaves it, where there is no slope to step along, and
    where steps do not halve. Where there are few nodes beside all, they come first. The columns
    are evaluated where the root seems to be, and tell whether it is: where the load hardly
    changes, a step says little. A root balances the load, or as well as an ulp of h can.
    """
    top = _highest(state)
    low, high, held = LOWEST, top, False  # held: the load at the lower end is known to be enough
    over, under = math.inf, target  # imbalance at both ends
    h = min(max(h, low), high)
    few = _has_few(state)
    last, bend, count = high - low, 1.0, 0
    for n in range(1, MOST + 1):
        F, F1, F2 = _contact(state, h, NO, few, state.work)
        if not few:
            count += 1
        if F >= target:
            low, over, held = h, F - target, True
        elif h == LOWEST and not few:
            return h, count, TOO_MUCH
        else:
            high, under = h, target - F
        unit = max(1.0, abs(h))
        pinched = high - low <= EPSILON * unit
        step = (0.5 * (low + high) if held or n % 4 == 0 else LOWEST) - h
        bisected, explained = True, False
        if F > 0 and F1 < -FLAT * F and n <= STEPS:
            f, slope = math.log(F / target), F1 / F
            curve = F2 / F - slope * slope
            trial = _step(f, slope, curve)
            explained = abs(f) <= -slope * ULP * unit
            if low < h + trial < high and (n % 4 != 0 or abs(trial) < 0.5 * last):
                step, bisected = trial, False
        size = abs(step)
        # errors follow e' = Ke³
        if last < 1:
            bend = size / (last * last * last)
        if few:
            h += step
            if h == LOWEST or size < CLOSE or n > 20:
                few = NO
                low, high, held = LOWEST, top, False
                over, under = math.inf, target
                last = 1.0
                continue
        else:
            if pinched:
                if not held:
                    h = LOWEST
                    continue
                h = low if over <= under else high
            elif not (explained and bisected):
                h += step
            # so this step leaves K size³
            small = not bisected and size < 1e-3 and bend * size * size * size <= ROUNDING
            if pinched or explained or small or size <= ULP * unit:
                if _balances(state, h, target, row, pinched or explained):
                    fate = TOO_LITTLE if top - h < 1e-12 * (top - LOWEST) else OK
                    return h, count, fate
                if pinched:
                    fate = TOO_LITTLE if high == top else UNSOLVED
                    return h, count, fate
        last = size
    return h, count, UNSOLVED


@exact
def _state(m, kinds, values, series, edges, rules, work):
    """State of interface m."""
    # no member of a family yet, for the load and for every column, and no rule on a series
    work[MEMBER + PANEL * TERMS + 2] = work[MEMBER + PANEL * TERMS + 3] = -1.0
    work[RULE] = work[FEWER_RULE] = -1.0
    return State(
        _from(_pointer(kinds), m * kinds.shape[1]),
        _from(_pointer(values), m * values.shape[1]),
        (kinds.shape[1] - PARTS) // PART_KINDS,
        _pointer(series),
        _pointer(edges),
        _pointer(rules),
        _pointer(work),
    )


@Cached
@njit(nogil=True, cache=True, error_model="numpy", no_cfunc_wrapper=True)
def solve_states(
    kinds, values, series, edges, rules, work, scan, which, target, h, given, count, fate, rows
):
    """Solve states i of interfaces which[i] for the loads target[i] [Pa].

    Fills ``h``, the evaluations ``count``, the ``fate`` and the columns ``rows`` (N, 10). With
    ``given``, h is taken as it is; the states of one interface may share a scan.
    """
    for i in range(len(which)):
        state = _state(which[i], kinds, values, series, edges, rules, work)
        row = _from(_pointer(rows), i * len(FIELDS))
        if given:
            count[i], fate[i] = 1, OK
            _contact(state, h[i], YES, NO, row)
        else:
            scanned = len(scan) > 0
            guess = _guess(scan, math.log(target[i])) if scanned else _start(state, target[i])
            h[i], count[i], fate[i] = _root(state, target[i], guess, row)
