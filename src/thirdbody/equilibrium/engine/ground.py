"""Particles on the ground of one field of heights: one separation of a state.

Particles press the ground under them down, and the ground of asperities: the equations are those of
`thirdbody.contact.field_ground`, and so are the rows of separations from which others begin.
"""

from __future__ import annotations

import math

from ...contact.field_ground import FAR, LEVEL, LEVELS, LIFTS
from ...laws.field.table import COLUMNS as OF_SURFACE
from ...laws.field.table import FIRST, LOW, TAU
from ..compiled.machine import keep_apart, normal_cdf
from .field import COUNTS, ENDS, PIECES, ROOT_2PI, TERMS, mean_pressure
from .fields import CHI, HEIGHTS_OF_TABLE, IS_SOFT
from .ground_seats import BETA, LOWEST, weigh_ground
from .sides import scalar

__all__ = ["lay_surface", "round_of"]

TAUS = 16
K_PP, K_AS, K_ZS, OF_KERNELS = 0, BETA, BETA + TAUS * BETA, BETA + 2 * TAUS * BETA
"""Of the displacements: k_n of particles, then series in τ of those of asperities under particles,
and of particles under asperities."""
WAVES = 2 * math.sqrt(2)
CLOSEST = 1e-13
VALUE, SLOPE, PRESSED, TURNED, BASIS, U = range(6)
"""Rows of what asperities do at a separation."""


@scalar
def lay_surface(skin, table, surface):
    """Every piece of the splines over the separation, of all columns of a surface."""
    keep_apart()
    soft = int(skin[0, IS_SOFT])
    for n in range(COUNTS[soft]):
        for k in range(TERMS):
            row = surface[n, k]
            for c in range(OF_SURFACE):
                row[c] = 0.0
            for i in range(HEIGHTS_OF_TABLE):
                part = PIECES[soft, n, k, i]
                if part != 0:
                    for c in range(OF_SURFACE):
                        row[c] += part * table[i, c]


@scalar
def _read_surface(skin, surface, h, value, slope):
    """Columns of a surface at h [σ] and their slopes; the bend of the first."""
    keep_apart()
    soft = int(skin[0, IS_SOFT])
    last, n, bend = COUNTS[soft] - 1, 0, 0.0
    while n < last and h >= ENDS[soft, n + 1]:
        n += 1
    top = ENDS[soft, last + 1]
    x = min(h, top) - ENDS[soft, n]
    for c in range(OF_SURFACE):
        value[c] = slope[c] = 0.0
    for k in range(TERMS):
        bend = bend * x + slope[LOW]
        for c in range(OF_SURFACE):
            slope[c] = slope[c] * x + value[c]
            value[c] = value[c] * x + surface[n, k, c]
    bend *= 2
    if h > top:
        u, du = 1 - top / h, top / (h * h)
        for c in range(OF_SURFACE):
            first = slope[c] * top
            second = 0.5 * (bend * top * top + 2 * first) if c == LOW else 0.0
            value[c] += first * u + second * u * u
            slope[c] = (first + 2 * second * u) * du
            if c == LOW:
                bend = -2 * (first + 2 * second * u) * du / h + 2 * second * du * du
    return bend


@scalar
def _press(own, kernels, skin, surface, h, small):
    """What asperities at h press down under particles, and what lifts them, into two rows."""
    keep_apart()
    value, slope = small[VALUE], small[SLOPE]
    h = min(max(h, own[LOWEST]), FAR)
    bend = _read_surface(skin, surface, h, value, slope)
    chi, raw = skin[0, CHI], math.exp(-0.5 * h * h)
    density, bearing = raw / ROOT_2PI, normal_cdf(-h, raw)
    P, P1, P2 = chi * (density - h * bearing), -chi * bearing, chi * density
    y, y1 = value[LOW], slope[LOW]
    load = mean_pressure(y, y1, P, -P1)
    steep = -math.exp(y) * (P2 + 2 * P1 * y1 + P * (bend + y1 * y1))
    over, x = load / steep, 2 * value[TAU] - 1
    basis = small[BASIS]
    basis[0], basis[1] = 1.0, x
    for j in range(2, TAUS):
        basis[j] = 2 * x * basis[j - 1] - basis[j - 2]
    pressed, turned = small[PRESSED], small[TURNED]
    for n in range(BETA):
        pressed[n] = turned[n] = 0.0
    for j in range(TAUS):
        part, begin_as, begin_zs = basis[j], K_AS + j * BETA, K_ZS + j * BETA
        for n in range(BETA):
            turned[n] += part * kernels[begin_as + n]
            pressed[n] += part * kernels[begin_zs + n]
    pressed[0] *= load
    for n in range(1, BETA):
        ratio = value[FIRST + n - 1]
        pressed[n] *= ratio * load
        turned[n] *= ratio + slope[FIRST + n - 1] * over


@scalar
def _level_out(h):
    """Separation [σ] at which the ground under asperities is read."""
    if h <= LEVEL:
        return h
    x = min((h - LEVEL) / LEVELS, 1.0)
    return LEVEL + LEVELS * x * (1 - x * x * (1 - 0.5 * x))


@scalar
def lift_of(own, kernels, skin, surface, h, state, start, small):
    """Lift of the asperities' ground [σ], by chords, and how far it is off.

    From one that is near, as there may be several. What asperities press at h + w is left in the
    rows.
    """
    keep_apart()
    w = before = found = start
    miss = math.nan
    for _ in range(LIFTS):
        _press(own, kernels, skin, surface, _level_out(h + w), small)
        total = 0.0
        for n in range(BETA):
            total += small[TURNED, n] * state[n]
        found = max(WAVES * total, own[LOWEST] - h)
        last, miss = miss, found - w
        if abs(miss) < CLOSEST:
            break
        chord = miss * (w - before) / (last - miss)
        step = chord if abs(chord) <= 2 * abs(miss) else miss
        before, w = w, w + step
    if h + w > LEVEL:
        _press(own, kernels, skin, surface, h + w, small)
    return found, abs(miss)


@scalar
def round_of(field, h, state, lift, small, nodes, places, found, columns, whole):
    """β_n and the shadow again, from those and the lift before, at h [σ].

    The lift and how far it is off.
    """
    keep_apart()
    own, _, _, kernels, skin, surface, _, _, _ = field
    w, off = lift_of(own, kernels, skin, surface, h, state, lift, small)
    # the rows hold what asperities do a last step before, some 1e-13 of σ away
    bare, u = 1 - min(max(state[BETA], 0.0), 1.0), small[U]
    for n in range(BETA):
        u[n] = WAVES * (bare * small[PRESSED, n] + kernels[K_PP + n] * state[n])
    weigh_ground(field, h, u, nodes, places, found, columns, whole)
    return w, off
