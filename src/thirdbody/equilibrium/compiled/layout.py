"""How interfaces and states lie in memory for the compiled engine: records with named fields.

NumPy fills them and numba reads them. `rows` says what of a contact becomes which field; lengths
of a part of the particles are in its size.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ...contact.asperity_sums import GaussianSum, GaussianSums, ReducedSum
from ...contact.particle_averages import SizeAverage
from ...laws.base import COLUMNS
from ...numerics.chebyshev import PiecewiseChebyshev

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Records = NDArray[np.void]

__all__ = [
    "INTERFACE",
    "PART",
    "RULE",
    "SUM",
    "WORK",
    "Panels",
    "Rules",
]

NONE = -1
"""In the place of an index: there is no such thing."""
FAMILY, GAUSSIAN, DENSITY = range(3)
"""Asperities: by a series in h and in ω_1/σ_s beside the Gaussian, by one in h, by one in h
without the Gaussian."""
ABSENT, PLANE, ROUGH, ROUGH_NODES = -1, 0, 1, 2
"""Particles: none, by series on a plane, by a series or over nodes on a rough seat."""
TERMS, ACROSS_TERMS, MOST_NODES = 18, 16, 64
"""Of a Chebyshev series; of a family across it, which has so many panels where a series has one;
and most nodes of a rule over gaps near a seat."""
SEPARATIONS = 250
"""Of an inverse."""
SEAT_REACH = 9.0
"""Standard deviations of the seat above a gap that count; twice as many count below it."""
AT = 7
"""Row of the abscissae in a rule (8, nodes) over gaps, below weight times the seven columns; a rule
of sizes has two rows, weights and sizes."""


def _record(*fields: tuple[object, ...]) -> np.dtype[np.void]:
    return np.dtype([*fields], align=True)


SPAN = _record(("begin", "i4"), ("end", "i4"))
"""Panels of a series, one after another."""
RULE = _record(("begin", "i4"), ("nodes", "i4"))
"""Where the rows of a rule begin, one after another, and how long each is."""

SUM = _record(("panels", SPAN), ("inverse", "i4"))
"""A family, with its inverse for first guesses."""

INTERFACE = _record(
    ("kind", "i4"),  # of sum over asperities
    ("shadow", "i4"),  # column of the particles that is the shadow, NONE: their coverage
    ("panels", SPAN),  # of the sum over asperities
    ("inverse", "i4"),  # of that sum, for a first guess, or NONE
    ("across", "f8"),  # place of ω_1/σ_s in its family, −1 to 1
    ("sigma_s", "f8"),  # [m]
    ("centre", "f8"),  # mean height of the asperities [m]
    ("force", "f8"),  # unit of load [Pa]
    ("area", "f8"),  # unit of area over nominal area
    ("highest", "f8"),  # separation [σ_s] above which asperities carry nothing
    ("lowest", "f8"),  # separation [σ_s] below which nothing is searched
    ("coverage", "f8"),  # of all particles, where that is the shadow
)
"""The asperities of an interface, and what its particles have in common."""

PART = _record(
    ("kind", "i4"),
    ("upper", SPAN),  # series on a plane in √(top − gap), or on a rough seat in the gap
    ("lower", SPAN),  # series on a plane in the gap, below the join
    ("gaps", RULE),  # over gaps on a rough seat
    ("sizes", RULE),
    ("few_gaps", RULE),  # as good near the gaps, or close to a root
    ("few_sizes", RULE),  # close to a root
    ("inverse", "i4"),  # of the load, for a first guess, or NONE
    ("size", "f8"),  # [m]
    ("factor", "f8"),  # density × size²: unit of area over nominal area, and of load per Pa
    ("offset", "f8"),  # gap − d [m]
    ("width", "f8"),  # of a rough seat
    ("reach", "f8"),  # gap above which nothing is carried
    ("least", "f8"),  # gap below which each carries its most, where there are series
    ("top", "f8"),  # gap at which the largest touches, of nodes for each size
    ("bottom", "f8"),  # gap below which each carries its most on a plane, where there are nodes
    ("join", "f8"),  # gap between the two series of a plane
    ("near", "f8"),  # widths of a seat beyond the gaps within which few gaps are as good; −1: never
    ("powers", "f8", len(COLUMNS)),  # leading powers of √(top − gap) of the columns on a plane
    ("floor", "f8", len(COLUMNS)),  # the columns below the least gap
)
"""Particles of one material and one size distribution."""

PANEL = _record(
    ("edge", "f8"),  # on the left
    ("half", "f8"),  # of the width
    ("load", "f8", (6, TERMS)),  # for the balance: load, and shadow, with two derivatives each
    ("every", "f8", (len(COLUMNS), TERMS)),  # for the columns
)
"""Coefficients of Chebyshev series on one panel."""

INVERSE = _record(
    ("most", "f8"),  # largest ln of the load
    ("step", "f8"),  # of √(most − ln F)
    ("separations", "f8", SEPARATIONS),  # after 0, 1, 2 … steps
)
"""Separations that fall with ln of a load, for first guesses."""

WORK = _record(
    ("total", "f8", 8),  # of all parts
    ("out", "f8", 8),  # of the asperities, or of one part
    ("each", "f8", 8),  # of one size
    ("member", PANEL),  # of a family, at the place of the interface across it
    ("held_load", "i8"),  # panel of the family that the member was read from, for the balance
    ("held_every", "i8"),  # and for the columns, or NONE
    ("sums", "f8", (3, MOST_NODES)),  # at the nodes of a rule
)
"""What a thread works with."""


class Panels:
    """Panels of piecewise Chebyshev functions one after another, each function kept once."""

    def __init__(self) -> None:
        self._places: dict[Hashable, tuple[int, int]] = {}
        self._panels: list[Records] = []
        self._inverses: list[Records] = []
        self._count = 0

    def add(
        self, key: Hashable, function: PiecewiseChebyshev, load: Array, columns: int
    ) -> tuple[int, int]:
        """Begin and end of a function: what the balance needs of it, and its first columns."""
        if key not in self._places:
            self._append(key, _lay_panels(function, load, function.coefficients[:, :, :columns]))
        return self._places[key]

    def _append(self, key: Hashable, panels: Records) -> None:
        self._places[key] = self._count, self._count + len(panels)
        self._count += len(panels)
        self._panels.append(panels)

    def add_inverse(self, of: GaussianSums | SizeAverage) -> int:
        """Where the separation stands as a function of the load, for first guesses."""
        key = of, "inverse"
        if key not in self._places:
            self._places[key] = len(self._inverses), len(self._inverses) + 1
            self._inverses.append(_inverse(of))
        return self._places[key][0]

    def add_family(self, family: GaussianSums) -> tuple[int, int]:
        """Begin and end of the sums over Gaussian heights for many w."""
        if family not in self._places:
            self._append(family, _family(family))
        return self._places[family]

    def add_average(self, function: PiecewiseChebyshev, shadow: int) -> tuple[int, int]:
        """Begin and end of particle columns: load and shadow with two derivatives, all seven."""
        load = function.with_derivatives[:, :, [0, max(shadow, 0)], :]
        load = load.reshape(*load.shape[:2], -1)
        return self.add((id(function), shadow), function, load, len(COLUMNS))

    def all_panels(self) -> tuple[Records, Records]:
        """All panels, and all inverses."""
        panels = np.concatenate([*self._panels, np.zeros(1, PANEL)])
        return panels, np.concatenate([*self._inverses, np.zeros(0, INVERSE)])


def _lay_panels(function: PiecewiseChebyshev, load: Array, every: Array) -> Records:
    """Panels (P, ..., terms, columns), the middle axes one after another."""
    panels = np.zeros(load.shape[:-2], PANEL)
    panels["load"][..., : load.shape[-1], :] = load.swapaxes(-1, -2)
    panels["every"][..., : every.shape[-1], :] = every.swapaxes(-1, -2)
    rows = panels.reshape(len(load), -1)
    rows["edge"], rows["half"] = function.edges[:-1, None], function.half[:, None]
    return rows.ravel()


@lru_cache(maxsize=64)
def _family(family: GaussianSums) -> Records:
    """The sums over Gaussian heights for half an octave of w."""
    every = family.coefficients
    return _lay_panels(family.table, every[..., [0, 4, 5]], every[..., :4])


@lru_cache(maxsize=128)
def _inverse(of: GaussianSums | SizeAverage) -> Records:
    """Separations that fall with ln of a load."""
    if isinstance(of, GaussianSums):
        separation = np.linspace(-ReducedSum.DEEPEST, GaussianSum.highest, 2_000)
        log_load = np.log(of.middle(separation)) - 0.5 * separation**2
    else:
        rise = np.geomspace(1, 1e-5, 2_000) * math.sqrt(of.top - of.bottom)
        separation = of.top - rise**2
        log_load = np.log(of(separation)[:, 0])
    depth = np.sqrt(np.maximum(log_load[0] - log_load, 0.0))
    at = np.linspace(0, depth[-1], SEPARATIONS)
    inverse = np.zeros(1, INVERSE)
    inverse["most"], inverse["step"] = log_load[0], at[1]
    inverse["separations"] = np.interp(at, depth, separation)
    return inverse


class Rules:
    """Quadrature rules one after another, each kept once."""

    def __init__(self) -> None:
        self._places: dict[Hashable, tuple[int, int]] = {}
        self._rules: list[Array] = []
        self._count = 0
        self.of_single_states = 0
        """Numbers in the rules of single states."""

    def add(self, key: Hashable, rows: Array) -> tuple[int, int]:
        """Begin and nodes of a rule (k, n): weighted columns, then increasing abscissae."""
        if key not in self._places:
            self._places[key] = self.add_each(rows[None])[0].item()
        return self._places[key]

    def add_each(self, rows: Array) -> Records:
        """`RULE` records (M,) of rules (M, k, n), one for each state."""
        count, k, n = rows.shape
        self.of_single_states += rows.size if count > 1 else 0
        out = np.empty(count, RULE)
        out["begin"], out["nodes"] = self._count + k * n * np.arange(count), n
        self._rules.append(rows.ravel())
        self._count += rows.size
        return out

    def all_rules(self) -> Array:
        """All rules."""
        return np.concatenate([*self._rules, np.zeros(0)])
