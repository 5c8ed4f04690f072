"""What a state carries at a separation, in machine code.

Everything here is a sum over nodes or a Chebyshev series; what the nodes and coefficients mean is
said once, by the laws and populations from which `rows` takes them. The separation h is that of
the asperities in σ_s, counted from their mean height.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .layout import (
    ABSENT,
    ACROSS_TERMS,
    AT,
    DENSITY,
    FAMILY,
    NONE,
    PANEL,
    PLANE,
    ROUGH_NODES,
    SEAT_REACH,
    SEPARATIONS,
    TERMS,
)
from .machine import ahead, exact, exp, inlined, normal_cdf, numbers, pointer, record, sums

__all__ = ["FIELDS", "alone", "contact", "has_few", "highest", "row_of", "state_of"]

FIELDS = ("F_ss", "e", "ep", "p", "F_sa", "A_e", "A_ep", "A_p", "A_sa2", "shadow")
"""Columns of a solved state: asperities without shadow, then particles."""

START = 1.0
"""The first guess of a separation [σ_s], where nothing is known."""
DROP = 1.25 * math.log(2) / 4
"""About how much ln of the asperities' load falls from the middle of a family to its end."""
NEXT = PANEL.itemsize // 8
"""Numbers from one panel to the next."""
YES, NO = np.bool_(True), np.bool_(False)
"""Typed, so that one compiled function serves both."""


class State(NamedTuple):
    """What describes one state to the kernels, by pointers: passing arrays costs more than sums."""

    interface: Any
    """to its `layout.INTERFACE`"""
    parts: Any
    """to the first `layout.PART` of its particles"""
    count: Any
    """number of parts"""
    panels: Any
    edges: Any
    """left edge of every panel"""
    inverses: Any
    rules: Any
    work: Any
    """to a `layout.WORK`"""


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


@exact
def _coefficients(panel, every):
    """Rows of coefficients for every column, or for the balance."""
    return numbers(panel, "every") if every else numbers(panel, "load")


@sums
def _series(panel, x, coefficients, count, out):
    """Chebyshev series on a panel at x by ``count`` rows of coefficients, into ``out``."""
    s = min(max((x - panel.edge) / panel.half - 1.0, -1.0), 1.0)
    t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, t16, t17 = _polynomials(s)
    for k in range(count):
        c = ahead(coefficients, k * TERMS)
        low = c[0] + c[1] * s + c[2] * t2 + c[3] * t3 + c[4] * t4 + c[5] * t5
        middle = c[6] * t6 + c[7] * t7 + c[8] * t8 + c[9] * t9 + c[10] * t10 + c[11] * t11
        high = c[12] * t12 + c[13] * t13 + c[14] * t14 + c[15] * t15 + c[16] * t16 + c[17] * t17
        out[k] = low + middle + high


@sums
def _member(family, x, count, out):
    """Rows of coefficients of one member, x across the family (−1 to 1)."""
    t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14, t15, _, _ = _polynomials(x)
    n = NEXT
    for i in range(count * TERMS):
        c = ahead(family, i)
        low = c[0] + c[n] * x + c[2 * n] * t2 + c[3 * n] * t3 + c[4 * n] * t4 + c[5 * n] * t5
        middle = c[6 * n] * t6 + c[7 * n] * t7 + c[8 * n] * t8 + c[9 * n] * t9 + c[10 * n] * t10
        high = c[11 * n] * t11 + c[12 * n] * t12 + c[13 * n] * t13 + c[14 * n] * t14
        out[i] = low + middle + (high + c[15 * n] * t15)


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
    interface, work = record(state.interface, 0), record(state.work, 0)
    count = 4 if every else 3
    if h > interface.highest:
        for k in range(4):
            out[k] = 0.0
        return
    stride = ACROSS_TERMS if interface.kind == FAMILY else 1
    place = _panel(state.edges, interface.panels.begin, interface.panels.end, h, stride)
    panel = record(state.panels, place)
    if interface.kind == FAMILY:
        member = work.member
        if place != (work.held_every if every else work.held_load):
            member.edge, member.half = panel.edge, panel.half
            family = _coefficients(panel, every)
            _member(family, interface.across, count, _coefficients(member, every))
            if every:
                work.held_every = place
            else:
                work.held_load = place
        panel = member
    _series(panel, h, _coefficients(panel, every), count, out)
    factor = interface.force
    if interface.kind != DENSITY:
        factor *= exp(-0.5 * h * h)
        if not every:
            m0, m1, m2 = out[0], out[1], out[2]
            out[1], out[2] = -(h * m0 + m1), (h * h - 1) * m0 + 2 * h * m1 + m2
    out[0] *= factor
    if every:
        factor *= interface.area / interface.force
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
    at, c0 = ahead(rule, AT * nodes + begin), ahead(rule, begin)
    if every:
        c1, c2, c3 = ahead(c0, nodes), ahead(c0, 2 * nodes), ahead(c0, 3 * nodes)
        c4, c5, c6 = ahead(c0, 4 * nodes), ahead(c0, 5 * nodes), ahead(c0, 6 * nodes)
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
    c1 = ahead(c0, shadow * nodes)
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
    first, second = ahead(out, nodes), ahead(out, 2 * nodes)
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
def _add_weighted(rule, nodes, moments, inverse, shadow, every, out):
    """Add Σ c m over a rule: load and shadow with two derivatives, or every column."""
    norm = inverse / math.sqrt(2 * math.pi)
    m1, m2 = ahead(moments, nodes), ahead(moments, 2 * nodes)
    for j in range(7 if every else 2):
        c = ahead(rule, (j if every else j * shadow) * nodes)
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


@exact
def _gaps(state, component, fewer):
    """The rule over gaps of a part, or the one with fewer."""
    begin = component.few_gaps.begin if fewer else component.gaps.begin
    nodes = component.few_gaps.nodes if fewer else component.gaps.nodes
    return ahead(state.rules, begin), nodes


@inlined
def _rough_nodes(state, component, gap, shadow, every, few, out, of_size):
    """Particles on a rough seat by the sum over sizes and over local gaps in their size.

    A seat near all sizes weighs the same gaps for all of them, so they are summed first.
    """
    top, bottom, width, inverse = (
        component.top,
        component.bottom,
        component.width,
        1 / component.width,
    )
    begin = component.few_sizes.begin if few else component.sizes.begin
    count = component.few_sizes.nodes if few else component.sizes.nodes
    weights, sizes = ahead(state.rules, begin), ahead(state.rules, begin + count)
    for k in range(7):
        out[k] = 0.0
    near = component.near * width
    if near > 0 and max(gap - sizes[0] * top, sizes[count - 1] * bottom - gap) < near:
        rule, nodes = _gaps(state, component, YES)
        moments = numbers(record(state.work, 0), "sums")
        _spread(ahead(rule, AT * nodes), nodes, weights, sizes, count, gap, inverse, moments)
        _add_weighted(rule, nodes, moments, inverse, shadow, every, out)
    else:
        for n in range(count):
            size = sizes[n]
            fewer = max(gap - size * top, size * bottom - gap) < near if near > 0 else few
            rule, nodes = _gaps(state, component, fewer)
            at = ahead(rule, AT * nodes)
            # far above the largest particles the many below them carry the load
            low = _below(at, 0, nodes, (gap - 2 * SEAT_REACH * width) / size)
            high = _below(at, low, nodes, (gap + SEAT_REACH * width) / size)
            _seat_nodes(rule, nodes, low, high, gap, width, size, shadow, every, of_size)
            for k in range(7):
                out[k] += weights[n] * of_size[k]
    floor = numbers(component, "floor")
    s0, s1, s2 = _below_bottom(bottom, weights, sizes, count, gap, inverse)
    for k in range(7 if every else 2):
        if every:
            out[k] += floor[k] * s0
        else:
            most = floor[k * shadow]
            out[3 * k] += most * s0
            out[3 * k + 1] -= most * s1
            out[3 * k + 2] -= most * s2


@exact
def _power(u, n):
    """u to a small whole number."""
    out = 1.0
    for _ in range(int(n)):
        out *= u
    return out


@exact
def _rise(component, u, shadow, every, out):
    """From series in u = √(top − gap) without their leading power to columns and derivatives."""
    powers = numbers(component, "powers")
    if every:
        for k in range(7):
            out[k] *= _power(u, powers[k])
        return
    inverse = 1 / u
    square = inverse * inverse
    for j in range(0, 6, 3):
        value, first, second = out[j], out[j + 1] * u, out[j + 2] * u * u
        n = powers[shadow if j else 0]
        lead = _power(u, n)
        du = first + n * value
        out[j] = lead * value
        out[j + 1] = -0.5 * lead * square * du
        ddu = second + 2 * n * first + n * (n - 1) * value
        out[j + 2] = 0.25 * lead * square * square * (ddu - du)


@exact
def _particles(state, d, every, few, total, out, of_size):
    """Load [Pa] and shadow with two derivatives in d, or ``every`` one of the seven columns."""
    interface = record(state.interface, 0)
    shadow = max(interface.shadow, 0)
    for k in range(7):
        total[k] = 0.0
    for p in range(state.count):
        component = record(state.parts, p)
        if component.kind == ABSENT:
            continue
        gap = (d + component.offset) / component.size
        if gap >= component.reach:
            continue
        if component.kind == ROUGH_NODES:
            _rough_nodes(state, component, gap, shadow, every, few, out, of_size)
        elif gap < component.least:
            floor = numbers(component, "floor")
            for k in range(7):
                out[k] = floor[k] if every else 0.0
            if not every:
                out[0], out[3] = floor[0], floor[shadow]
        else:
            begin, end = component.upper.begin, component.upper.end
            x, rise = gap, False
            if component.kind == PLANE:
                rise = gap >= component.join
                if rise:
                    x = math.sqrt(component.top - gap)
                else:
                    begin, end = component.lower.begin, component.lower.end
            panel = record(state.panels, _panel(state.edges, begin, end, x, 1))
            _series(panel, x, _coefficients(panel, every), 7 if every else 6, out)
            if rise:
                _rise(component, x, shadow, every, out)
        factor = component.factor
        if every:
            for k in range(7):
                total[k] += factor * out[k]
        else:
            inverse = 1 / component.size
            for k in range(3):
                total[k] += factor * out[k]
                total[3 + k] += factor * out[3 + k]
                factor *= inverse
    if interface.shadow < 0 and not every:
        total[3], total[4], total[5] = interface.coverage, 0.0, 0.0


# ---------------------------------------------------------------- both
@exact
def contact(state, h, every, few, row):
    """Total load [Pa] with its first and second derivative in h, by all nodes or by few.

    With ``every``, the columns `FIELDS` into ``row`` instead.
    """
    interface, work = record(state.interface, 0), record(state.work, 0)
    total, out, of_size = numbers(work, "total"), numbers(work, "out"), numbers(work, "each")
    _asperities(state, h, every, out)
    f, f1, f2 = out[0], out[1], out[2]
    if every:
        for k in range(10):
            row[k] = out[k] if k < 4 else 0.0
    if state.count == 0:
        return f, f1, f2
    sigma_s, shadow = interface.sigma_s, interface.shadow
    d = interface.centre + sigma_s * h
    _particles(state, d, every, few, total, out, of_size)
    if every:
        for k in range(5):
            row[4 + k] = max(total[k], 0.0)  # rounding of the other regimes
        row[9] = interface.coverage if shadow < 0 else min(max(total[shadow], 0.0), 1.0)
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
def highest(state):
    """Separation [σ_s] above which nothing is carried."""
    interface = record(state.interface, 0)
    high = interface.highest
    for p in range(state.count):
        component = record(state.parts, p)
        if component.kind != ABSENT:
            reach = component.reach * component.size - component.offset
            high = max(high, (reach - interface.centre) / interface.sigma_s)
    return high


@exact
def has_few(state):
    """Whether there are few sizes or gaps, quick and close, beside all of them."""
    few = NO
    for p in range(state.count):
        component = record(state.parts, p)
        fewer = component.few_sizes.nodes < component.sizes.nodes or component.near < 0
        few |= component.kind == ROUGH_NODES and fewer
    return few


@exact
def _inverse(inverse, log_load):
    """Separation by straight lines over √(most − ln F)."""
    separations = numbers(inverse, "separations")
    x = math.sqrt(max(inverse.most - log_load, 0.0)) / inverse.step
    i = min(int(x), SEPARATIONS - 2)
    return separations[i] + min(x - i, 1.0) * (separations[i + 1] - separations[i])


@exact
def alone(state, target):
    """The highest of the separations at which asperities, or a part of the particles, do alone."""
    interface = record(state.interface, 0)
    if interface.inverse < 0:
        return START
    log_load = math.log(target / interface.force) + DROP * interface.across
    h = _inverse(record(state.inverses, interface.inverse), log_load)
    for p in range(state.count):
        component = record(state.parts, p)
        if component.inverse >= 0:
            log_load = math.log(target / component.factor)
            gap = component.size * _inverse(record(state.inverses, component.inverse), log_load)
            h = max(h, (gap - component.offset - interface.centre) / interface.sigma_s)
    return h


@exact
def state_of(m, interfaces, parts, panels, edges, inverses, rules, work):
    """State of interface m."""
    # no member of a family yet, for the load and for every column
    clean = record(pointer(work), 0)
    clean.held_load = clean.held_every = NONE
    return State(
        ahead(pointer(interfaces), m),
        ahead(pointer(parts), m * parts.shape[1]),
        parts.shape[1],
        pointer(panels),
        pointer(edges),
        pointer(inverses),
        pointer(rules),
        pointer(work),
    )


@exact
def row_of(rows, i):
    """To the columns of state i."""
    return ahead(pointer(rows), i * len(FIELDS))
