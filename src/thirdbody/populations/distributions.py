r"""Particle size distributions with closed partial moments.

Every distribution is frozen and comparable, and answers the same few questions: density,
support, quantiles, and the partial moments

.. math:: m_n(a, b) = \int_a^b x^n \varphi_a(x)\,dx .

`pieces` are the diameters between which the density is smooth and well resolved by one
Gauss panel: quadratures over sizes split there.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from ..errors import InvalidValue
from ..numerics.quadrature import gauss_legendre
from ..quantities.value import Value, quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "Distribution",
    "Histogram",
    "LogNormal",
    "Mixture",
    "Monodisperse",
    "PowerLaw",
    "TruncatedGaussian",
    "Uniform",
    "Weibull",
]

LENGTH_HINT = "nm are written 300e-9 or '300 nm'"
NORMAL_CUT = 8.5
"""Standard deviations after which a Gaussian tail holds less than 1e-17."""


class Distribution(Value):
    """What every size distribution can do.

    Sizes are diameters x [m], by number, φ_a(x). A distribution of your own gives the abstract
    methods below; the integrals over sizes split at `pieces` and `kinks`.

    Examples
    --------
    >>> sizes = TruncatedGaussian(mean=300e-9, std=24e-9)
    >>> half = sizes.ppf(0.5)
    >>> round(float(sizes.partial_moment(0, 0.0, half)), 12)  # share of the particles below it
    0.5
    """

    __slots__ = ()

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
        """
        return self.pdf(self.support[1] - depth)

    @abstractmethod
    def ppf(self, q: ArrayLike) -> Array:
        """Diameter [m] below which a fraction q of the particles lies."""

    @abstractmethod
    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        """m_n(a, b) [m^n] over the part of (a, b] inside the support; zero when b <= a."""

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
        """Weights and simple distributions of which this one is made."""
        return ((1.0, self),)

    def moment(self, n: int) -> float:
        """Full moment ⟨x^n⟩ [m^n]."""
        lo, hi = self.support
        return float(self.partial_moment(n, lo - 1.0, hi))

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


def _ratio(value: float, scale: float) -> float:
    return float(f"{value / scale:.14g}")


def _ratios(edges: tuple[float, ...]) -> tuple[float, ...]:
    """Edges over the last, to 14 digits where these tell them apart; (1,) if they are one size."""
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
    >>> round(Monodisperse(mean=2e-7).moment(2) * 1e14, 12)
    4.0
    """

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


@dataclass(frozen=True, slots=True, kw_only=True)
class TruncatedGaussian(Distribution):
    r"""Gaussian sizes cut at n standard deviations, and at zero.

    .. math:: \varphi_a(x) = \frac{1}{\sqrt{2\pi}\,\sigma_a\,m}
              \exp\left[-\tfrac12\left(\frac{x-x_a}{\sigma_a}\right)^2\right],
              \quad \max(0, x_a-n\sigma_a) \le x \le x_a+n\sigma_a

    m is the mass inside the cut (`retained_mass`). The paper prints the density without m;
    `Horng2022` has a switch for that.

    Parameters
    ----------
    mean, std : float
        x_a and σ_a of the Gaussian before truncation [m].
    n : float, optional
        Cut in standard deviations [1].

    References
    ----------
    Horng et al. 2022, eq. (7), doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> sizes = TruncatedGaussian(mean=300e-9, std=24e-9, n=3)
    >>> [round(x * 1e9, 6) for x in sizes.support]
    [228.0, 372.0]
    """

    mean: float = quantity("x_a", "m", "mean diameter", gt=0, hint=LENGTH_HINT)
    std: float = quantity(
        "σ_a",
        "m",
        "standard deviation of the diameter",
        gt=0,
        hint="for one single size use Monodisperse",
    )
    n: float = quantity("n", "1", "cut in standard deviations", default=3.0, gt=0)

    @property
    def support(self) -> tuple[float, float]:
        cut = min(self.n, NORMAL_CUT)
        return (max(0.0, self.mean - cut * self.std), self.mean + cut * self.std)

    @property
    def pieces(self) -> tuple[float, ...]:
        lo, hi = self.support
        count = max(1, math.ceil((hi - lo) / (1.5 * self.std)))
        return tuple(np.linspace(lo, hi, count + 1))

    @property
    def retained_mass(self) -> float:
        lo, hi = self.support
        return float(self._mass((lo - self.mean) / self.std, (hi - self.mean) / self.std))

    @staticmethod
    def _mass(A: ArrayLike, B: ArrayLike) -> Array:
        """Φ(B) − Φ(A), from the side on which it does not cancel."""
        A, B = np.asarray(A, dtype=float), np.asarray(B, dtype=float)
        upper = A > 0
        return special.ndtr(np.where(upper, -A, B)) - special.ndtr(np.where(upper, -B, A))

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        u = (x - self.mean) / self.std
        lo, hi = self.support
        norm = math.sqrt(2 * math.pi) * self.std * self.retained_mass
        return np.where((x >= lo) & (x <= hi), np.exp(-0.5 * u * u) / norm, 0.0)

    def pdf_below(self, depth: Array) -> Array:
        u = ((self.support[1] - self.mean) - depth) / self.std
        norm = math.sqrt(2 * math.pi) * self.std * self.retained_mass
        return np.exp(-0.5 * u * u) / norm

    def ppf(self, q: ArrayLike) -> Array:
        lo, hi = self.support
        p0 = special.ndtr((lo - self.mean) / self.std)
        p1 = special.ndtr((hi - self.mean) / self.std)
        u = special.ndtri(p0 + np.asarray(q, dtype=float) * (p1 - p0))
        return np.clip(self.mean + self.std * u, lo, hi)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        lo, hi = _clip(a, b, self.support)
        A, B = (lo - self.mean) / self.std, (hi - self.mean) / self.std
        m0 = self._mass(A, B)
        if n == 0:
            closed = m0
        else:
            root = math.sqrt(2 * math.pi)
            phiA, phiB = np.exp(-0.5 * A * A) / root, np.exp(-0.5 * B * B) / root
            m1 = self.mean * m0 + self.std * (phiA - phiB)
            if n == 1:
                closed = m1
            elif n == 2:
                v = m0 + A * phiA - B * phiB
                closed = self.mean * (2 * m1 - self.mean * m0) + self.std**2 * v
            else:
                closed = np.full_like(m0, np.nan)
        # over a short stretch the differences above cancel: integrate instead
        narrow = (B - A < 1) | (n > 2)
        if np.any(narrow):
            nodes, weights = gauss_legendre(16)
            edges = np.linspace(lo, hi, 13) if n > 2 else np.stack([lo, hi])
            half = 0.5 * np.diff(edges, axis=0)[..., None]
            x = 0.5 * (edges[1:] + edges[:-1])[..., None] + half * nodes
            u = (x - self.mean) / self.std
            dens = np.exp(-0.5 * u * u) / (math.sqrt(2 * math.pi) * self.std)
            summed = np.sum(half * weights * x**n * dens, axis=(0, -1))
            closed = np.where(narrow, summed, closed)
        return closed / self.retained_mass

    def scaled(self, factor: float) -> TruncatedGaussian:
        return TruncatedGaussian(mean=factor * self.mean, std=factor * self.std, n=self.n)

    def standardised(self) -> tuple[float, Distribution]:
        shape = TruncatedGaussian(mean=1.0, std=_ratio(self.std, self.mean), n=self.n)
        return self.mean, shape


@dataclass(frozen=True, slots=True, kw_only=True)
class LogNormal(Distribution):
    r"""Log-normal sizes: ln x is Gaussian with median and geometric standard deviation given.

    .. math:: \varphi_a(x)=\frac{1}{\sqrt{2\pi}\,s\,x}
              \exp\left[-\frac{\ln^2(x/x_m)}{2 s^2}\right],\quad s=\ln\sigma_g

    Parameters
    ----------
    median : float
        Median diameter x_m [m].
    gsd : float
        Geometric standard deviation σ_g [1], above 1.

    Examples
    --------
    >>> round(LogNormal(median=1e-6, gsd=1.5).mean_diameter * 1e6, 6)
    1.085674
    """

    median: float = quantity("x_m", "m", "median diameter", gt=0, hint=LENGTH_HINT)
    gsd: float = quantity("σ_g", "1", "geometric standard deviation", gt=1, le=20)

    @property
    def s(self) -> float:
        """Standard deviation of ln x [1]."""
        return math.log(self.gsd)

    @property
    def support(self) -> tuple[float, float]:
        s = self.s
        return (
            self.median * math.exp(-NORMAL_CUT * s),
            self.median * math.exp((NORMAL_CUT + 2 * s) * s),
        )

    @property
    def pieces(self) -> tuple[float, ...]:
        lo, hi = self.support
        count = math.ceil(math.log(hi / lo) / min(1.5 * self.s, 1.0))
        return tuple(np.geomspace(lo, hi, count + 1))

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        lo, hi = self.support
        safe = np.where(x > 0, x, self.median)
        u = np.log(safe / self.median) / self.s
        dens = np.exp(-0.5 * u * u) / (math.sqrt(2 * math.pi) * self.s * safe)
        return np.where((x >= lo) & (x <= hi), dens, 0.0)

    def pdf_below(self, depth: Array) -> Array:
        hi = self.support[1]
        u = (math.log1p((hi - self.median) / self.median) + np.log1p(-depth / hi)) / self.s
        norm = math.sqrt(2 * math.pi) * self.s * (hi - depth)
        return np.exp(-0.5 * u * u) / norm

    def ppf(self, q: ArrayLike) -> Array:
        u = special.ndtri(np.asarray(q, dtype=float))
        return np.clip(self.median * np.exp(self.s * u), *self.support)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        lo, hi = _clip(a, b, self.support)
        shift = n * self.s
        A, B = (np.log(edge / self.median) / self.s - shift for edge in (lo, hi))
        full = self.median**n * math.exp(0.5 * shift**2)
        closed = full * TruncatedGaussian._mass(A, B)
        return _narrow(self, n, lo, hi, (B - A) * np.maximum(1, np.abs(A)), closed)

    def scaled(self, factor: float) -> LogNormal:
        return LogNormal(median=factor * self.median, gsd=self.gsd)

    def standardised(self) -> tuple[float, Distribution]:
        return self.median, LogNormal(median=1.0, gsd=self.gsd)


@dataclass(frozen=True, slots=True, kw_only=True)
class Weibull(Distribution):
    r"""Weibull (Rosin–Rammler by number) sizes.

    .. math:: \Phi_a(x) = 1-\exp[-(x/x_0)^k]

    Parameters
    ----------
    scale : float
        x_0 [m], the diameter below which 63.2 % of the particles lie.
    shape : float
        k [1].

    Examples
    --------
    >>> round(Weibull(scale=1e-6, shape=2).mean_diameter * 1e6, 6)
    0.886227
    """

    scale: float = quantity("x_0", "m", "scale diameter", gt=0, hint=LENGTH_HINT)
    shape: float = quantity("k", "1", "shape", ge=0.5, le=100)

    @property
    def support(self) -> tuple[float, float]:
        return (0.0, self.scale * 45.0 ** (1 / self.shape))

    @property
    def pieces(self) -> tuple[float, ...]:
        # equal steps of x in the bulk, geometric ones towards zero where x^(k-1) is not smooth
        hi = self.support[1]
        levels = np.array([0.3, 1, 2, 4, 7, 11, 16, 22, 29, 36]) ** (1 / self.shape)
        low = levels[0] * 0.25 ** np.arange(12, 0, -1.0)
        steep = 0.1 ** np.array([16.0, 12, 8, 6, 4, 3, 2, 1])
        inner = np.unique(np.concatenate([low, steep ** (1 / self.shape), levels]))
        return (0.0, *(self.scale * inner), hi)

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        lo, hi = self.support
        t = np.where(x > 0, x, self.scale) / self.scale
        dens = self.shape / self.scale * t ** (self.shape - 1) * np.exp(-(t**self.shape))
        return np.where((x > lo) & (x <= hi), dens, 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        with np.errstate(divide="ignore"):
            x = self.scale * (-np.log1p(-np.asarray(q, dtype=float))) ** (1 / self.shape)
        return np.clip(x, *self.support)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        lo, hi = _clip(a, b, self.support)
        p = 1 + n / self.shape
        A, B = ((edge / self.scale) ** self.shape for edge in (lo, hi))
        upper = A > p
        part = np.where(
            upper,
            special.gammaincc(p, A) - special.gammaincc(p, B),
            special.gammainc(p, B) - special.gammainc(p, A),
        )
        closed = self.scale**n * special.gamma(p) * part
        return _narrow(self, n, lo, hi, (B - A) / np.clip(A, 1e-300, 1), closed)

    def scaled(self, factor: float) -> Weibull:
        return Weibull(scale=factor * self.scale, shape=self.shape)

    def standardised(self) -> tuple[float, Distribution]:
        return self.scale, Weibull(scale=1.0, shape=self.shape)


@dataclass(frozen=True, slots=True, kw_only=True)
class Histogram(Distribution):
    """Measured sizes: number fractions in bins, uniform inside each bin.

    Parameters
    ----------
    edges : tuple of float
        Increasing bin edges [m], the first >= 0.
    counts : tuple of float
        Particles per bin, in any unit; at least one positive.

    Examples
    --------
    >>> sizes = Histogram(edges=(0.0, 1e-7, 3e-7), counts=(1, 1))
    >>> round(sizes.mean_diameter * 1e9, 6)
    125.0
    """

    edges: tuple[float, ...]
    counts: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("edges", "counts"):
            try:
                values = tuple(float(item) for item in getattr(self, name))
            except (TypeError, ValueError):
                raise InvalidValue(f"Histogram.{name} must be a sequence of numbers") from None
            object.__setattr__(self, name, values)
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        e, c = self.edges, self.counts
        out = []
        if not all(math.isfinite(v) for v in (*e, *c)):
            return ["Histogram.edges and Histogram.counts must be finite numbers"]
        if len(e) != len(c) + 1 or not c:
            out.append(f"Histogram has {len(e)} edges and {len(c)} counts; n bins have n + 1 edges")
        if any(b <= a for a, b in zip(e, e[1:], strict=False)) or (e and e[0] < 0):
            out.append("Histogram.edges must increase and start at or above 0 [m]")
        if any(v < 0 for v in c) or not any(v > 0 for v in c):
            out.append("Histogram.counts must be >= 0 with at least one above 0")
        return out

    @property
    def _bins(self) -> tuple[Array, Array, Array]:
        """Lower edges, upper edges and densities of the bins between the first and last filled."""
        e, c = np.array(self.edges), np.array(self.counts)
        filled = np.flatnonzero(c)
        part = slice(filled[0], filled[-1] + 1)
        lo, hi = e[:-1][part], e[1:][part]
        return lo, hi, c[part] / c.sum() / (hi - lo)

    @property
    def support(self) -> tuple[float, float]:
        lo, hi, _ = self._bins
        return (float(lo[0]), float(hi[-1]))

    @property
    def pieces(self) -> tuple[float, ...]:
        lo, hi, _ = self._bins
        return (*lo, float(hi[-1]))

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.pieces

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        lo, hi, density = self._bins
        i = np.clip(np.searchsorted(lo, x, side="right") - 1, 0, len(lo) - 1)
        return np.where((x >= lo[0]) & (x <= hi[-1]), density[i], 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        lo, hi, density = self._bins
        mass = np.concatenate([[0.0], np.cumsum(density * (hi - lo))])
        return np.interp(np.asarray(q, dtype=float), mass, np.append(lo, hi[-1]))

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        low, high = _clip(a, b, self.support)
        lo, hi, density = self._bins
        left = np.clip(low[..., None], lo, hi)
        right = np.clip(high[..., None], lo, hi)
        # x^(n+1) differences without cancellation over a short stretch
        total = sum(right ** (n - k) * left**k for k in range(n + 1))
        return np.sum(density * (right - left) * total, axis=-1) / (n + 1)

    def scaled(self, factor: float) -> Histogram:
        return Histogram(edges=tuple(factor * e for e in self.edges), counts=self.counts)

    def standardised(self) -> tuple[float, Distribution]:
        edges = _ratios(self.edges)
        if len(edges) == 1:
            return self.edges[-1], ONE_SIZE
        return self.edges[-1], Histogram(edges=edges, counts=self.counts)


@dataclass(frozen=True, slots=True, kw_only=True)
class PowerLaw(Distribution):
    r"""Counts per section of sizes, with a power law inside each section.

    .. math:: \varphi_a(x) \propto x^{-s_i-1}, \qquad e_i \le x \le e_{i+1}

    A cumulative count that falls as :math:`N(>x)\propto x^{-s}` has slope s. Volume spread evenly
    over ln x has s = 3, evenly over x has s = 2: tables by volume become numbers without loss.

    Parameters
    ----------
    edges : tuple of float
        Increasing sizes e_i [m], all above 0; n + 1 of them.
    counts : tuple of float
        Particles per section, in any unit; at least one positive.
    slopes : tuple of float
        s_i [1], one per section; 0 spreads numbers evenly over ln x, -1 evenly over x.

    Examples
    --------
    >>> sizes = PowerLaw(edges=(4e-6, 6e-6, 14e-6), counts=(3, 1), slopes=(3.4, 2.5))
    >>> round(sizes.mean_diameter * 1e6, 4)
    5.5787
    """

    edges: tuple[float, ...]
    counts: tuple[float, ...]
    slopes: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("edges", "counts", "slopes"):
            try:
                values = tuple(float(item) for item in getattr(self, name))
            except (TypeError, ValueError):
                raise InvalidValue(f"PowerLaw.{name} must be a sequence of numbers") from None
            object.__setattr__(self, name, values)
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        e, c, s = self.edges, self.counts, self.slopes
        if not all(math.isfinite(v) for v in (*e, *c, *s)):
            return ["PowerLaw.edges, counts and slopes must be finite numbers"]
        out = []
        if not len(e) - 1 == len(c) == len(s) or not c:
            out.append(
                f"PowerLaw has {len(e)} edges, {len(c)} counts and {len(s)} slopes; "
                "n sections have n + 1 edges"
            )
        if any(b <= a for a, b in zip(e, e[1:], strict=False)) or (e and e[0] <= 0):
            out.append("PowerLaw.edges must increase and start above 0 [m]")
        if any(v < 0 for v in c) or not any(v > 0 for v in c):
            out.append("PowerLaw.counts must be >= 0 with at least one above 0")
        if not out and any(
            abs(v) * math.log(b / a) > 500 for v, a, b in zip(s, e, e[1:], strict=False)
        ):
            out.append("PowerLaw.slopes are too steep for the width of their sections")
        return out

    @property
    def _sections(self) -> tuple[Array, Array, Array, Array]:
        """Edges below and above, slopes and shares, from the first to the last filled section."""
        filled = np.flatnonzero(self.counts)
        part = slice(filled[0], filled[-1] + 1)
        e, c = np.array(self.edges), np.array(self.counts)
        return e[:-1][part], e[1:][part], np.array(self.slopes)[part], c[part] / c.sum()

    @property
    def support(self) -> tuple[float, float]:
        lo, hi, _, _ = self._sections
        return (float(lo[0]), float(hi[-1]))

    @property
    def kinks(self) -> tuple[float, ...]:
        lo, hi, _, _ = self._sections
        return (*lo, float(hi[-1]))

    @property
    def pieces(self) -> tuple[float, ...]:
        lo, hi, slope, _ = self._sections
        out = [np.array([lo[0]])]
        for a, b, s in zip(lo, hi, slope, strict=True):
            count = math.ceil(math.log(b / a) * max(1.0, abs(s + 1) / 5))
            out.append(np.geomspace(a, b, count + 1)[1:])
        return tuple(np.concatenate(out))

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        lo, hi, s, share = self._sections
        long = np.log(hi / lo)
        i = np.clip(np.searchsorted(lo, x, side="right") - 1, 0, len(lo) - 1)
        inside = (x >= lo[0]) & (x <= hi[-1])
        u = np.where(inside, x, lo[0]) / lo[i]
        height = share / (lo * long * special.exprel(-s * long))
        return np.where(inside, height[i] * u ** (-s[i] - 1), 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        lo, hi, s, share = self._sections
        q = np.asarray(q, dtype=float)
        filled = np.flatnonzero(share)
        above = np.cumsum(share[filled])
        i = filled[np.clip(np.searchsorted(above, q), 0, len(filled) - 1)]
        start = (np.cumsum(share) - share)[i]
        part = np.clip((q - start) / share[i], 0.0, 1.0)
        long, slope = np.log(hi / lo)[i], s[i]
        safe = np.where(slope == 0, 1.0, slope)
        with np.errstate(divide="ignore"):
            step = -np.log1p(part * np.expm1(-safe * long)) / safe
        step = np.where(slope == 0, part * long, step)
        return lo[i] * np.exp(np.clip(step, 0.0, long))

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        low, high = _clip(a, b, self.support)
        lo, hi, s, share = self._sections
        left = np.clip(low[..., None], lo, hi)
        right = np.clip(high[..., None], lo, hi)
        long, stretch = np.log(hi / lo), np.log1p((right - left) / left)
        power = n - s
        start = (left / lo) ** power * stretch * special.exprel(power * stretch)
        return np.sum(share * lo**n * start / (long * special.exprel(-s * long)), axis=-1)

    def scaled(self, factor: float) -> PowerLaw:
        edges = tuple(factor * e for e in self.edges)
        return PowerLaw(edges=edges, counts=self.counts, slopes=self.slopes)

    def standardised(self) -> tuple[float, Distribution]:
        edges = _ratios(self.edges)
        if len(edges) == 1:
            return self.edges[-1], ONE_SIZE
        return self.edges[-1], PowerLaw(edges=edges, counts=self.counts, slopes=self.slopes)


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform(Distribution):
    """All diameters between two limits are equally frequent.

    Parameters
    ----------
    low, high : float
        Smallest and largest diameter [m].

    Examples
    --------
    >>> round(Uniform(low=1e-7, high=3e-7).mean_diameter * 1e9, 6)
    200.0
    """

    low: float = quantity("x_min", "m", "smallest diameter", ge=0, hint=LENGTH_HINT)
    high: float = quantity("x_max", "m", "largest diameter", gt=0, hint=LENGTH_HINT)

    def _problems(self) -> list[str]:
        if self.high > self.low:
            return []
        return [
            f"Uniform.high = {self.high:g} must be above Uniform.low = {self.low:g} [m]; "
            "for one single size use Monodisperse"
        ]

    @property
    def support(self) -> tuple[float, float]:
        return (self.low, self.high)

    def pdf(self, x: ArrayLike) -> Array:
        x = np.asarray(x, dtype=float)
        return np.where((x >= self.low) & (x <= self.high), 1 / (self.high - self.low), 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        return self.low + (self.high - self.low) * np.asarray(q, dtype=float)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        lo, hi = _clip(a, b, self.support)
        total = sum(hi ** (n - k) * lo**k for k in range(n + 1))
        return (hi - lo) * total / ((n + 1) * (self.high - self.low))

    def scaled(self, factor: float) -> Uniform:
        return Uniform(low=factor * self.low, high=factor * self.high)

    def standardised(self) -> tuple[float, Distribution]:
        edges = _ratios((self.low, self.high))
        return self.high, ONE_SIZE if len(edges) == 1 else Uniform(low=edges[0], high=1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Mixture(Distribution):
    """Several kinds of sizes of the same material, by number.

    Parameters
    ----------
    parts : tuple of Distribution
        The components.
    weights : tuple of float
        Their number fractions, in any unit.

    Examples
    --------
    >>> both = Mixture(parts=(Monodisperse(mean=1e-7), Monodisperse(mean=3e-7)), weights=(3, 1))
    >>> round(both.mean_diameter * 1e9, 6)
    150.0
    """

    parts: tuple[Distribution, ...]
    weights: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", tuple(self.parts))
        object.__setattr__(self, "weights", tuple(float(w) for w in self.weights))
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        out = []
        if not self.parts or len(self.parts) != len(self.weights):
            out.append(
                f"Mixture has {len(self.parts)} parts and {len(self.weights)} weights; "
                "give one weight for each part"
            )
        if any(not isinstance(part, Distribution) for part in self.parts):
            out.append("Mixture.parts must all be size distributions")
        if any(not (w > 0 and math.isfinite(w)) for w in self.weights):
            out.append("Mixture.weights must all be > 0")
        return out

    @property
    def components(self) -> tuple[tuple[float, Distribution], ...]:
        total = sum(self.weights)
        return tuple(
            (w / total * inner, simple)
            for w, part in zip(self.weights, self.parts, strict=True)
            for inner, simple in part.components
        )

    @property
    def support(self) -> tuple[float, float]:
        ends = [part.support for _, part in self.components]
        return (min(lo for lo, _ in ends), max(hi for _, hi in ends))

    @property
    def pieces(self) -> tuple[float, ...]:
        return tuple(sorted({x for _, part in self.components for x in part.pieces}))

    @property
    def kinks(self) -> tuple[float, ...]:
        return tuple(sorted({x for _, part in self.components for x in part.kinks}))

    @property
    def retained_mass(self) -> float:
        return sum(w * part.retained_mass for w, part in self.components)

    def _sum(self, method: str, *args: Any) -> Array:
        return sum(w * getattr(part, method)(*args) for w, part in self.components)

    def pdf(self, x: ArrayLike) -> Array:
        return self._sum("pdf", x)

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        return self._sum("partial_moment", n, a, b)

    def ppf(self, q: ArrayLike) -> Array:
        q = np.asarray(q, dtype=float)
        lo, hi = (np.full_like(q, end) for end in self.support)
        below = self.support[0] - 1.0
        for _ in range(80):
            mid = 0.5 * (lo + hi)
            left = self.partial_moment(0, below, mid) < q
            lo, hi = np.where(left, mid, lo), np.where(left, hi, mid)
        return hi

    def scaled(self, factor: float) -> Mixture:
        return Mixture(
            parts=tuple(part.scaled(factor) for part in self.parts), weights=self.weights
        )

    def standardised(self) -> tuple[float, Distribution]:
        return 1.0, self
