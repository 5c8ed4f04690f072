"""Gauss nodes on a panel of a squeeze, in the variable in which the formula there is smooth."""

from __future__ import annotations

import math

from ..compiled.machine import keep_apart
from .curves import EDGE, FORM_1, FORM_2, TO
from .fields import EQUAL
from .sides import exact, scalar
from .vectors import BLEND, DISC, DOUBLED, PLASTIC, TABLE, exp

__all__ = [
    "CUBIC",
    "FLATTENED",
    "LINEAR",
    "LOGARITHMIC",
    "ROOTED",
    "is_plain",
    "place_lengths",
    "place_nodes",
    "variable_of",
]

LINEAR, ROOTED, CUBIC, LOGARITHMIC, FLATTENED = range(5)
"""Variables: itself, its root, its cube root, the logarithm of it over what is left of one, and of
the height that a disc has left."""
THINNEST = 1.001
"""Ratio of the ends of a panel up to which every variable is as good as another."""


@scalar
def variable_of(given, panels, p, n):
    """Variable of panel n."""
    if panels[p, n, EDGE] == 0:
        return ROOTED
    if panels[p, n, TO] <= THINNEST * panels[p, n, EDGE]:
        return LINEAR  # so that no node is rounded to beyond an end
    if given[p, EQUAL] != 1:
        return CUBIC
    formula = panels[p, n, FORM_1]
    if formula == TABLE:
        return LOGARITHMIC
    if formula == DISC:
        return FLATTENED
    return LINEAR if formula in (DOUBLED, PLASTIC) else CUBIC


@scalar
def is_plain(given, panels, p, n):
    """Whether half the nodes do on a panel that is short against all that changes there."""
    first = panels[p, n, FORM_1]
    if given[p, EQUAL] == 1:
        return 0 < first < BLEND or first == DISC
    return 0 < first < BLEND and 0 < panels[p, n, FORM_2] < BLEND


@exact
def _place_linear(low, half, gauss, weights, at, mass):
    for j in range(len(gauss)):
        at[j], mass[j] = low + half * (1 + gauss[j]), half * weights[j]


@exact
def _place_powers(power, low, half, gauss, weights, at, mass):
    for j in range(len(gauss)):
        t = low + half * (1 + gauss[j])
        at[j] = t * t if power == 2 else t * t * t
        mass[j] = half * weights[j] * (2 * t if power == 2 else 3 * t * t)


@exact
def _place_logarithms(low, half, gauss, weights, at, mass):
    for j in range(len(gauss)):
        over = exp(-low - half * (1 + gauss[j]))
        at[j] = 1 / (1 + over)
        mass[j] = half * weights[j] * over * at[j] * at[j]


@exact
def _place_ratios(low, half, gauss, weights, at, mass):
    for j in range(len(gauss)):
        at[j] = exp(low + half * (1 + gauss[j]))
        mass[j] = half * weights[j] * at[j]


@exact
def _place_thin(taken, low, half, gauss, weights, at, mass):
    for j in range(len(gauss)):
        left = exp(-low - half * (1 + gauss[j]))
        at[j], mass[j] = (1 - left) / taken, half * weights[j] * left / taken


@scalar
def place_nodes(variable, taken, a, b, gauss, weights, at, mass):
    """Nodes between two squeezes and their weights, of as many as the rule has."""
    keep_apart()
    if variable in (ROOTED, CUBIC):
        power = 2.0 if variable == ROOTED else 3.0
        low = a ** (1 / power)
        half = 0.5 * (b ** (1 / power) - low)
        _place_powers(power, low, half, gauss, weights, at, mass)
    elif variable == LOGARITHMIC:
        low = math.log(a / (1 - a))
        half = 0.5 * (math.log(b / (1 - b)) - low)
        _place_logarithms(low, half, gauss, weights, at, mass)
    elif variable == FLATTENED and taken > 0:
        low = -math.log(1 - taken * a)
        half = 0.5 * (-math.log(1 - taken * b) - low)
        _place_thin(taken, low, half, gauss, weights, at, mass)
    else:
        _place_linear(a, 0.5 * (b - a), gauss, weights, at, mass)


@scalar
def place_lengths(variable, a, b, gap, gauss, weights, at, mass):
    """As `place_nodes`, of indentations x − h between two under a gap h."""
    keep_apart()
    if variable == LOGARITHMIC and a > 0:  # of numbers, as exp needs them
        low = math.log(a / gap)
        _place_ratios(low, 0.5 * (math.log(b / gap) - low), gauss, weights, at, mass)
        for j in range(len(at)):
            at[j] *= gap
            mass[j] *= gap
    else:
        place_nodes(variable, 0.0, a, b, gauss, weights, at, mass)
