"""Particles whose sum over sizes is one of closed formulas, at one separation."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .densities import density
from .fields import (
    A_SA,
    A_SA2,
    ABOVE,
    AS_FIRST,
    BEARS,
    BEYOND,
    BY_APPROACH,
    DARK,
    F_SA,
    FIXED,
    GAUSSIAN,
    HIGH,
    KIND,
    LOGNORMAL,
    LOW,
    NEVER,
    NORM,
    OFFSET,
    SHADE,
    SHADES,
    SIZE_1,
    SIZE_2,
    SPLIT,
    TAKES,
    WINDOW,
)  # fmt: skip
from .sides import scalar
from .skins import ROOT_2PI
from .sums import above

__all__ = ["add_printed", "only_falls", "printed_bound"]


@scalar
def _mass(A, B):
    """Φ(B) − Φ(A), from the side on which it does not cancel."""
    if A > 0:
        return above(-A) - above(-B)
    return above(B) - above(A)


@scalar
def _power(x, n):
    """xⁿ for n = 0, 1 and 2."""
    if n == 0:
        return 1.0
    return x if n == 1 else x * x


@scalar
def moment(given, p, n, a, b, gauss, weights, nodes):
    """∫ xⁿ φ dx from a to b, of the part inside the support; n is no whole number to numba.

    For each whole number that stands in a call numba would compile it again.
    """
    keep_apart()
    a, b = max(a, given[p, LOW]), min(b, given[p, HIGH])
    if not a < b:
        return 0.0
    kind, middle, s = given[p, KIND], given[p, SIZE_1], given[p, SIZE_2]
    if kind == GAUSSIAN:
        A, B = (a - middle) / s, (b - middle) / s
        if B - A >= 1:
            unit = given[p, NORM] * s
            m_0 = _mass(A, B) * ROOT_2PI
            if n == 0:
                return unit * m_0
            at_A, at_B = math.exp(-0.5 * A * A), math.exp(-0.5 * B * B)
            m_1 = middle * m_0 + s * (at_A - at_B)
            if n == 1:
                return unit * m_1
            m_2 = middle * (2 * m_1 - middle * m_0)
            return unit * (m_2 + s * s * (m_0 + A * at_A - B * at_B))
    elif kind == LOGNORMAL:
        shift = n * s
        A, B = math.log(a / middle) / s - shift, math.log(b / middle) / s - shift
        if (B - A) * max(1.0, abs(A)) >= 0.5:
            return _power(middle, n) * math.exp(0.5 * shift * shift) * _mass(A, B)
    half, total = 0.5 * (b - a), 0.0
    for j in range(nodes):
        x = a + half * (1 + gauss[j])
        total += weights[j] * _power(x, n) * density(given, p, x)
    return half * total


@scalar
def _weighted_integral(given, p, a, b, gauss, weights, nodes):
    """∫ w φ dx from a to b."""
    keep_apart()
    x_a = given[p, FIXED]
    if x_a > 0:
        return x_a * x_a * moment(given, p, 0.0, a, b, gauss, weights, nodes)
    return moment(given, p, 2.0, a, b, gauss, weights, nodes)


@scalar
def _above(given, p, d, gauss, weights, nodes):
    """∫ w_p φ dx from d on."""
    keep_apart()
    high = given[p, HIGH]
    if given[p, ABOVE] == NEVER:
        return 0.0
    if given[p, ABOVE] == BY_APPROACH:
        squared = moment(given, p, 2.0, d, high, gauss, weights, nodes)
        return squared - d * moment(given, p, 1.0, d, high, gauss, weights, nodes)
    return _weighted_integral(given, p, d, high, gauss, weights, nodes)


@scalar
def _shadow(given, p, d, plastic, gauss, weights, nodes):
    """ς of a part, of which the second integral is known."""
    if given[p, DARK] == 1:
        plastic = _above(given, p, 0.0, gauss, weights, nodes)
    return min(given[p, SHADES] * plastic, 1.0)


@scalar
def add_printed(given, p, d, gauss, weights, nodes, out):
    """What part p carries at a separation d [m] of its own datum, into the columns."""
    keep_apart()
    window = given[p, WINDOW] * _weighted_integral(
        given, p, d - given[p, BEYOND], d, gauss, weights, nodes
    )
    plastic = _above(given, p, d, gauss, weights, nodes)
    total = given[p, TAKES] * (window + plastic)
    elastic = given[p, TAKES] * window if given[p, SPLIT] == 1 else 0.0
    out[F_SA] += given[p, BEARS] * total
    out[A_SA] += elastic
    out[A_SA + 2] += total - elastic
    out[A_SA2] += total
    out[SHADE] += _shadow(given, p, d, plastic, gauss, weights, nodes)


@scalar
def printed_bound(given, p, low, high, gauss, weights, nodes):
    """A load [Pa] that no separation between two exceeds, and a shadow that none falls below."""
    keep_apart()
    first, last = low + given[p, OFFSET], high + given[p, OFFSET]
    begin = first - given[p, BEYOND]
    window = given[p, WINDOW] * _weighted_integral(given, p, begin, last, gauss, weights, nodes)
    load = given[p, TAKES] * (window + _above(given, p, first, gauss, weights, nodes))
    plastic = _above(given, p, last, gauss, weights, nodes)
    return given[p, BEARS] * load, _shadow(given, p, last, plastic, gauss, weights, nodes)


@scalar
def only_falls(given, p, d, bound):
    """Whether what part p adds to the load falls with every separation above d [m].

    ``bound`` [Pa] is what the asperities carry without shadow at d. Of the two integrals one
    loses at d what C times the other gains; without the second, the first falls beyond the one
    separation at which its window holds most, if w φ has one maximum.
    """
    keep_apart()
    d += given[p, OFFSET]
    low, high, h_e = given[p, LOW], given[p, HIGH], given[p, BEYOND]
    if d >= high + h_e:
        return True
    if given[p, ABOVE] == AS_FIRST:
        gain = given[p, SHADES] * bound if given[p, DARK] == 0 else 0.0
        return gain <= given[p, TAKES] * given[p, BEARS] * (1 - given[p, WINDOW])
    if given[p, ABOVE] == BY_APPROACH:
        return False
    if d >= high:
        return True
    if d <= low or d - h_e <= low:
        return False
    fixed = given[p, FIXED] > 0
    here, there = density(given, p, d), density(given, p, d - h_e)
    if not fixed:
        here, there = here * d * d, there * (d - h_e) ** 2
    return here < there
