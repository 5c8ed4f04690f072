"""One field of heights in the place of asperities: what it carries at a separation h [σ]."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import make_interp_spline

from ...laws.field import reduced
from ...laws.field.table import separations
from ..compiled.machine import keep_apart, normal_cdf
from .fields import (
    A_E,
    ABOVE_FIELD,
    CHI,
    COLUMNS_OF_TABLE,
    F_SS,
    FORCE,
    HEIGHTS_OF_TABLE,
    IS_SOFT,
    OF_TABLE,
    WIDER,
)
from .sides import scalar

__all__ = ["add_field", "lay_field"]

FAR_OUT = 30.0
"""Separation over σ from which the energy of a plastic surface is a series in 1/h."""
ROOT_2PI = math.sqrt(2 * math.pi)
TERMS = 6
PIECE, HELD = 0, 1
"""Rows of what is held of a state: coefficients of a piece, and which piece it is."""
ENERGY, RISE, YIELDED = range(COLUMNS_OF_TABLE)
ENDS = np.full((2, HEIGHTS_OF_TABLE - TERMS + 2), np.inf)
"""Ends of the pieces of the spline through separations of the table: of hard surfaces, of soft."""
COUNTS = np.zeros(2, np.int64)
PIECES = np.zeros((2, ENDS.shape[1] - 1, TERMS, HEIGHTS_OF_TABLE))
"""From values there to coefficients of each piece, the highest power first."""


def _fill_pieces() -> None:
    """The spline of `thirdbody.laws.field.table.FieldSurface`, piece by piece."""
    for soft in (0, 1):
        h = separations(bool(soft))
        whole = make_interp_spline(h, np.eye(len(h)), k=TERMS - 1)
        ends = np.unique(whole.t)
        COUNTS[soft], ENDS[soft, : len(ends)] = len(ends) - 1, ends
        for k in range(TERMS):
            power = TERMS - 1 - k
            found = whole(ends[:-1], power) / math.factorial(power)
            PIECES[soft, : len(ends) - 1, k, : len(h)] = found


_fill_pieces()
mean_pressure = scalar(reduced.mean_pressure)
remainder_at = scalar(reduced.remainder_at)
real_pressure = scalar(reduced.real_pressure)


@scalar
def lay_field(held):
    """Forget the piece of another state."""
    held[HELD, 0] = -1.0


@scalar
def _hold(skin, held, h):
    """The piece in which h lies, its polynomials into ``held``; how far h is from its beginning."""
    keep_apart()
    soft = int(skin[0, IS_SOFT])
    last, n = COUNTS[soft] - 1, 0
    while n < last and h >= ENDS[soft, n + 1]:
        n += 1
    if held[HELD, 0] != n:
        held[HELD, 0] = n
        for column in range(COLUMNS_OF_TABLE):
            begin = OF_TABLE + column * HEIGHTS_OF_TABLE
            for k in range(TERMS):
                total = 0.0
                for i in range(HEIGHTS_OF_TABLE):
                    total += PIECES[soft, n, k, i] * skin[0, begin + i]
                held[PIECE, column * TERMS + k] = total
    return min(h, ENDS[soft, last + 1]) - ENDS[soft, n]


@scalar
def _polynomial(held, column, x):
    """A column at x from the beginning of its piece, its slope and half its bend."""
    value = slope = bend = 0.0
    for k in range(TERMS):
        bend = bend * x + slope
        slope = slope * x + value
        value = value * x + held[PIECE, column * TERMS + k]
    return value, slope, bend


@scalar
def _value_beyond_end(value, slope, bend, last, h, bent):
    """Two terms in u = 1 − h_M/h beyond the last separation h_M, or one; and the slope."""
    u = 1 - last / h
    first = slope * last
    second = bent * (bend * last * last + first)
    return value + first * u + second * u * u, (first + 2 * second * u) * last / (h * h)


@scalar
def _column_at(held, column, x, h, bent):
    """A column of the table at h, and its slope."""
    keep_apart()
    value, slope, bend = _polynomial(held, column, x)
    last = ENDS[0, COUNTS[0]]
    if h > last:
        return _value_beyond_end(value, slope, bend, last, h, bent)
    return value, slope


@scalar
def _plastic_energy(h, density, bearing):
    """φ(h) − hQ(h), without the digits that this loses far out."""
    if h <= FAR_OUT:
        return density - h * bearing
    square = 1 / (h * h)
    return density * square * (1 - 3 * square + 15 * square * square)


@scalar
def add_field(skin, held, h, out):
    """Load and areas at h [σ], into the first four columns; False below the table."""
    keep_apart()
    if h < ENDS[int(skin[0, IS_SOFT]), 0]:
        return False
    x, chi = _hold(skin, held, h), skin[0, CHI]
    raw = math.exp(-0.5 * h * h)
    density, bearing = raw / ROOT_2PI, normal_cdf(-h, raw)
    y, slope = _column_at(held, ENERGY, x, h, 1.0)
    rise, _ = _column_at(held, RISE, x, h, 0.0)
    yielded, _ = _column_at(held, YIELDED, x, h, 0.0)
    energy = _plastic_energy(h, density, bearing)
    carried = mean_pressure(y, slope, chi * energy, chi * bearing)
    top = h + rise
    touched = normal_cdf(-top, math.exp(-0.5 * top * top))
    ratio = min(carried / (chi * touched), 1.0) if touched > 0 else 1.0
    remains = remainder_at(skin[0, ABOVE_FIELD], bearing)
    ratio = real_pressure(ratio, skin[0, WIDER] * remains)
    whole = carried * (1 + remains)
    area = whole / (chi * ratio)
    plastic = 1.0 if ratio >= 1 else min(max(yielded, 0.0), 1.0)
    out[F_SS] = skin[0, FORCE] * whole
    out[A_E] = area * (1 - plastic)
    out[A_E + 1] = 0.0
    out[A_E + 2] = area * plastic
    return True
