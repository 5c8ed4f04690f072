r"""What every particle size distribution can do.

Every distribution is frozen and comparable, and answers the same few questions: density,
support, quantiles, and the partial moments

.. math:: m_n(a, b) = \int_a^b x^n \varphi_a(x)\,dx .

`pieces` are the diameters between which the density is smooth and well resolved by one
Gauss panel: quadratures over sizes split there.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..numerics.quadrature import gauss_legendre
from ..quantities.named import Named
from ..quantities.value import quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["LENGTH_HINT", "ONE_SIZE", "Distribution", "Monodisperse"]

LENGTH_HINT = "nm are written 300e-9 or '300 nm'"


class Distribution(Named):
    """What every size distribution can do.

    Sizes are diameters x [m], by number, φ_a(x). A distribution of your own gives the abstract
    methods below; the integrals over sizes split at `pieces` and `kinks`.

    Examples
    --------
    >>> from thirdbody.populations.distributions import TruncatedGaussian
    >>> sizes = TruncatedGaussian(mean=300e-9, std=24e-9)
    >>> half = sizes.ppf(0.5)
    >>> round(float(sizes.partial_moment(0, 0.0, half)), 12)  # share of the particles below it
    0.5
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Any]]] = {}
    _tells_of_slips = False

    @property
    @abstractmethod
    def support(self) -> tuple[float, float]:
        """Smallest and largest diameter [m]; an infinite tail ends where it holds < 1e-17."""

    @abstractmethod
    def pdf(self, x: ArrayLike) -> Array:
        """Density φ_a(x) [1/m], zero outside the support."""

    def pdf_below(self, depth: Array) -> Array:
        """Density [1/m] at ``depth`` [m] below the largest diameter.

        Where sizes lie close together a diameter says too few digits of its place among them.

        Parameters
        ----------
        depth : array
            Below the upper end of the support [m].
        """
        return self.pdf(self.support[1] - depth)

    @abstractmethod
    def ppf(self, q: ArrayLike) -> Array:
        """Diameter [m] below which a fraction q of the particles lies."""

    @abstractmethod
    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        """m_n(a, b) [m^n] over the part of (a, b] inside the support; zero when b <= a.

        Parameters
        ----------
        n : int
            Order.
        a, b : float or array
            Ends of the sizes x_a [m].
        """

    @abstractmethod
    def scaled(self, factor: float) -> Distribution:
        """The distribution of ``factor`` times the diameter."""

    @abstractmethod
    def standardised(self) -> tuple[float, Distribution]:
        """A length [m] and the distribution of x over that length.

        Equal shapes give equal distributions (to 14 digits), whatever their size.
        """

    @property
    def pieces(self) -> tuple[float, ...]:
        """Increasing diameters [m] from one end of the support to the other."""
        return self.support

    @property
    def kinks(self) -> tuple[float, ...]:
        """Diameters [m] where the density is not smooth."""
        return self.support

    @property
    def components(self) -> tuple[tuple[float, Distribution], ...]:
        """Weights and simple distributions that make up this one."""
        return ((1.0, self),)

    def moment(self, n: int) -> float:
        """Full moment ⟨x^n⟩ [m^n]."""
        kept = type(self).__hash__ is not None  # what holds arrays has none
        return _moment(self, n) if kept else _moment.__wrapped__(self, n)

    @property
    def mean_diameter(self) -> float:
        """⟨x⟩ [m]; for a truncated distribution the mean of what is left."""
        return self.moment(1)

    @property
    def retained_mass(self) -> float:
        """Mass inside the truncation before normalisation; 1 for untruncated distributions."""
        return 1.0

    def sample(self, rng: np.random.Generator, size: int | tuple[int, ...]) -> Array:
        """Random diameters [m]."""
        return self.ppf(rng.random(size))


@lru_cache(maxsize=512)
def _moment(sizes: Distribution, n: int) -> float:
    """The cached full moment of a distribution: what is near it is asked for it again and again."""
    lo, hi = sizes.support
    return float(sizes.partial_moment(n, lo - 1.0, hi))


def _ratio(value: float, scale: float) -> float:
    return float(f"{value / scale:.14g}")


def _ratios(edges: tuple[float, ...]) -> tuple[float, ...]:
    """Edges over the last, to 14 digits where these differ; (1,) if all are one size."""
    exact = tuple(edge / edges[-1] for edge in edges)
    short = tuple(_ratio(edge, edges[-1]) for edge in edges)
    if short[0] == short[-1]:
        return short[-1:]
    return short if all(a < b for a, b in pairwise(short)) else exact


def _clip(a: ArrayLike, b: ArrayLike, support: tuple[float, float]) -> tuple[Array, Array]:
    a, b = np.broadcast_arrays(np.asarray(a, dtype=float), np.asarray(b, dtype=float))
    lo, hi = np.clip(a, *support), np.clip(b, *support)
    return lo, np.maximum(hi, lo)


def _narrow(
    sizes: Distribution, n: int, lo: Array, hi: Array, width: Array, closed: Array
) -> Array:
    """∫ xⁿ φ dx where its closed form, a difference of two near values, has lost digits."""
    narrow = width < 0.5  # of the stretch over which φ changes by its own size
    if not np.any(narrow):
        return closed
    nodes, weights = gauss_legendre(12)
    half = 0.5 * (hi - lo)[narrow][..., None]
    x = 0.5 * (lo + hi)[narrow][..., None] + half * nodes
    closed = np.array(closed, dtype=float)
    closed[narrow] = np.sum(half * weights * x**n * sizes.pdf(x), axis=-1)
    return closed


@dataclass(frozen=True, slots=True, kw_only=True)
class Monodisperse(Distribution):
    """All particles have one diameter.

    Parameters
    ----------
    mean : float
        Diameter x_a [m].

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.distributions.Monodisperse(mean=2e-7).moment(2) * 1e14, 12)
    4.0
    """

    name = "monodisperse"

    mean: float = quantity("x_a", "m", "diameter", gt=0, hint=LENGTH_HINT)

    @property
    def support(self) -> tuple[float, float]:
        return (self.mean, self.mean)

    def pdf(self, x: ArrayLike) -> Array:
        """Infinite at the diameter, zero elsewhere."""
        return np.where(np.asarray(x) == self.mean, np.inf, 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        return np.full_like(np.asarray(q, dtype=float), self.mean)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        inside = (np.asarray(a) < self.mean) & (self.mean <= np.asarray(b))
        return np.where(inside, self.mean**n, 0.0)

    def scaled(self, factor: float) -> Monodisperse:
        return Monodisperse(mean=factor * self.mean)

    def standardised(self) -> tuple[float, Distribution]:
        return self.mean, Monodisperse(mean=1.0)


ONE_SIZE = Monodisperse(mean=1.0)
"""The shape of sizes that 14 digits do not tell apart."""
