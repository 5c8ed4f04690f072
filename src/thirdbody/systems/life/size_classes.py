r"""Classes of size, in which the particles of an oil are counted over time.

.. math:: e/e_0 = 2^n\,(1,\ \tfrac54,\ \tfrac32,\ \tfrac74), \quad e_0 = 0.25\ \text{µm}, \qquad
          \varphi(x) \propto x^{-4}\ \text{inside a class}

So 4, 6 and 14 µm, from which ISO 4406 counts, are edges, and 5, 7, 10, 12 and 20 µm of data sheets
of filters are too: no count is interpolated in a class. Half of an edge is an edge, so that a piece
of half the size of its parent falls four classes down. Numbers fall as x⁻⁴ between the sizes of a
test dust too, where its volume is spread evenly over ln x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...populations.distributions import Distribution, PowerLaw
from ...populations.measured.cleanliness import counted_sizes, iso4406_of_counts
from ...quantities.value import Value, sequences, several

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["SizeClasses"]


def __dir__() -> list[str]:
    return sorted(__all__)


ORIGIN = 0.25e-6
"""An edge of every grid of classes [m]; 0.5, 1, 2, 4, 8 ... µm are edges too."""
PER_OCTAVE = 4
"""Classes of one width for each factor of two in size; 6 and 14 µm are edges of multiples of 4."""
NEGLECTED = 1e-9
"""Part of the particles by number that may lie below the first class."""
FALL = 3.0
"""Exponent of the count above a size inside a class, N(>x) ∝ x⁻³."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeClasses(Value):
    r"""Classes of size, numbers ∝ x⁻⁴ inside each.

    .. math:: \langle x^p \rangle_k = \frac{3}{p-3}\,
              \frac{e_{k+1}^{p-3}-e_k^{p-3}}{e_k^{-3}-e_{k+1}^{-3}}, \qquad
              v_k = \frac{\pi}{6}\langle x^3\rangle_k
                  = \frac{\pi}{2}\,\frac{\ln(e_{k+1}/e_k)}{e_k^{-3}-e_{k+1}^{-3}}

    Parameters
    ----------
    edges : tuple of float
        Increasing sizes e_k [m], all above 0; K + 1 of them.

    Examples
    --------
    >>> import thirdbody as tb
    >>> classes = tb.oil.SizeClasses.covering(smallest=0.25e-6, largest=64e-6)
    >>> classes.count, classes.edges[18]
    (32, 6e-06)
    """

    edges: tuple[float, ...] = several("m", "edges of the classes of size")

    def __post_init__(self) -> None:
        sequences(self, "edges")
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        e = self.edges
        rises = all(b > a for a, b in zip(e, e[1:], strict=False))
        if len(e) > 1 and all(map(math.isfinite, e)) and e[0] > 0 and rises:
            return []
        return [
            Problem(
                "edges",
                "must be two sizes or more that increase and start above 0 [m]",
                code=Mistake.ORDER,
            )
        ]

    @classmethod
    def covering(cls, *, smallest: float, largest: float, per_octave: int = PER_OCTAVE) -> Self:
        """Classes on the grid of 0.25 µm that hold all sizes from one to another.

        Parameters
        ----------
        smallest, largest : float
            The sizes [m].
        per_octave : int, optional
            Classes of one width for each factor of two [1].
        """
        low, high = (_place_of(x / ORIGIN, per_octave) for x in (smallest, largest))
        first, last = math.floor(low + 1e-9), math.ceil(high - 1e-9)
        places = range(first, max(last, first + 1) + 1)
        within = [ORIGIN * (1 + i / per_octave) for i in range(per_octave)]
        # times a power of two is exact, so that halves are edges
        return cls(edges=tuple(math.ldexp(within[j % per_octave], j // per_octave) for j in places))

    @property
    def count(self) -> int:
        """Number of classes K."""
        return len(self.edges) - 1

    @property
    def ends(self) -> tuple[Array, Array]:
        """Lower and upper ends of the classes [m], (K,) each."""
        edges = np.array(self.edges)
        return edges[:-1], edges[1:]

    def mean_power(self, power: float) -> Array:
        """Mean of x^p over the particles of each class [m^p], (K,).

        Parameters
        ----------
        power : float
            p [1].
        """
        low, high = self.ends
        number = (low**-FALL - high**-FALL) / FALL
        if power == FALL:
            return np.log(high / low) / number
        return (high ** (power - FALL) - low ** (power - FALL)) / (power - FALL) / number

    @property
    def volumes(self) -> Array:
        """Mean volume of a particle of each class v_k [m³], (K,)."""
        return math.pi / 6 * self.mean_power(3)

    def above(self, sizes: ArrayLike) -> Array:
        """Part of each class that is at or above sizes [1], (S, K).

        Parameters
        ----------
        sizes : array (S,)
            Sizes [m].
        """
        low, high = self.ends
        x = np.clip(np.atleast_1d(np.asarray(sizes, float))[:, None], low, high)
        return (x**-FALL - high**-FALL) / (low**-FALL - high**-FALL)

    def counted(self, numbers: ArrayLike) -> Array:
        """Particles per volume at and above 4, 6 and 14 µm(c) [1/m³], (..., 3).

        Parameters
        ----------
        numbers : array (..., K)
            Particles of each class per volume [1/m³].
        """
        some, above = np.asarray(numbers, float), self.above(counted_sizes()).T
        unknown = np.isnan(some)
        return np.where(unknown @ (above > 0), math.nan, np.where(unknown, 0.0, some) @ above)

    def iso4406(self, numbers: ArrayLike) -> str:
        """The ISO 4406 code of particles of each class.

        Parameters
        ----------
        numbers : array (K,)
            Particles of each class per volume [1/m³].
        """
        return iso4406_of_counts(self.counted(numbers))

    def numbers_of(self, number: float, diameter: Distribution) -> Array:
        """Particles of each class, their number kept, (K,).

        Parameters
        ----------
        number : float
            All particles, per volume, per time or whatever is asked [1/m³].
        diameter : Distribution
            Their sizes by number [m].

        Raises
        ------
        InvalidValue
            Particles outside the classes.
        """
        return number * self._moments(0, diameter)

    def numbers_by_volume(self, number: float, diameter: Distribution) -> Array:
        """Particles of each class, the volume of all that are in it kept, (K,).

        Parameters
        ----------
        number : float
            All particles, per volume, per time or whatever is asked [1/m³].
        diameter : Distribution
            Their sizes by number [m].

        Raises
        ------
        InvalidValue
            Particles outside the classes.
        """
        return number * self._moments(3, diameter) / self.mean_power(3)

    def _moments(self, power: int, diameter: Distribution) -> Array:
        """∫ x^p φ dx over each class [m^p]; a size that is an edge belongs to the upper class."""
        low, high = sizes_of(diameter)
        if low < self.edges[0] * (1 - 1e-9) or high > self.edges[-1] * (1 + 1e-9):
            rule = (
                f"from {self.edges[0]:g} to {self.edges[-1]:g} [m] leave out particles of "
                f"{low:g} to {high:g} [m]"
            )
            raise InvalidValue(Problem("edges", rule, owner="SizeClasses", code=Mistake.RANGE))
        below = np.nextafter(np.array(self.edges), 0.0)
        below[-1] = max(below[-1], high)
        return np.asarray(diameter.partial_moment(power, below[:-1], below[1:]), float)

    def distribution(self, numbers: ArrayLike) -> PowerLaw:
        """The sizes of particles of each class as a distribution.

        Parameters
        ----------
        numbers : array (K,)
            Particles of each class, in any unit [1]; at least one above 0.
        """
        counts = tuple(float(n) for n in np.asarray(numbers, float))
        return PowerLaw(edges=self.edges, counts=counts, slopes=(FALL,) * self.count)


def _place_of(size: float, per_octave: int) -> float:
    """Where a size over the origin lies among the edges, which are whole numbers."""
    within, octave = math.frexp(size)
    return per_octave * (octave - 1 + 2 * within - 1)


def sizes_of(diameter: Distribution) -> tuple[float, float]:
    """The smallest and largest size [m] of all but one in 10⁹ of the particles."""
    low, high = diameter.support
    return max(low, float(diameter.ppf(NEGLECTED))), high
