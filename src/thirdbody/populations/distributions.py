"""Particle size distributions with closed partial moments; those of measured sizes stand beside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

from ..errors import Advice, Mistake, Problem
from ..numerics.quadrature import gauss_legendre
from ..quantities.say import value_of
from ..quantities.value import quantity
from .size_base import (
    LENGTH_HINT,
    ONE_SIZE,
    Distribution,
    Monodisperse,
    _clip,
    _narrow,
    _ratio,
    _ratios,
)
from .tabulated_sizes import Histogram, Mixture, PowerLaw

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

SINGLE = Advice("Monodisperse", 'distribution = "monodisperse"')
"""The distribution of one single size."""

NORMAL_CUT = 8.5
"""Standard deviations after which a Gaussian tail holds less than 1e-17."""


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
    >>> import thirdbody as tb
    >>> sizes = tb.TruncatedGaussian(mean=300e-9, std=24e-9, n=3)
    >>> [round(x * 1e9, 6) for x in sizes.support]
    [228.0, 372.0]
    """

    name = "truncated-gaussian"

    mean: float = quantity("x_a", "m", "mean diameter", gt=0, hint=LENGTH_HINT)
    std: float = quantity(
        "σ_a",
        "m",
        "standard deviation of the diameter",
        gt=0,
        hint="for one single size use " + SINGLE,
    )
    n: float = quantity("n", "1", "cut in standard deviations", default=3.0, gt=0)

    def _problems(self) -> list[str]:
        low, high = self.support
        if high > low or not math.isfinite(high):
            return []
        return [
            Problem(
                "std",
                f"m must spread the diameters by more than "
                f"rounding around {value_of(high, 'm')}; for one single size use " + SINGLE,
                f"{self.std:g}",
                code=Mistake.RANGE,
            )
        ]

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
        q = np.asarray(q, dtype=float)
        u = special.ndtri(p0 + q * (p1 - p0))
        # seven widths out one less a probability has no digits left: the end itself is known
        return np.where(q < 1, np.clip(self.mean + self.std * u, lo, hi), hi)[()]

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
    >>> import thirdbody as tb
    >>> round(tb.LogNormal(median=1e-6, gsd=1.5).mean_diameter * 1e6, 6)
    1.085674
    """

    name = "log-normal"

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
    >>> import thirdbody as tb
    >>> round(tb.distributions.Weibull(scale=1e-6, shape=2).mean_diameter * 1e6, 6)
    0.886227
    """

    name = "weibull"

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
        integral = np.where(
            upper,
            special.gammaincc(p, A) - special.gammaincc(p, B),
            special.gammainc(p, B) - special.gammainc(p, A),
        )
        closed = self.scale**n * special.gamma(p) * integral
        return _narrow(self, n, lo, hi, (B - A) / np.clip(A, 1e-300, 1), closed)

    def scaled(self, factor: float) -> Weibull:
        return Weibull(scale=factor * self.scale, shape=self.shape)

    def standardised(self) -> tuple[float, Distribution]:
        return self.scale, Weibull(scale=1.0, shape=self.shape)


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform(Distribution):
    """All diameters between two limits are equally frequent.

    Parameters
    ----------
    low, high : float
        Smallest and largest diameter [m].

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.distributions.Uniform(low=1e-7, high=3e-7).mean_diameter * 1e9, 6)
    200.0
    """

    name = "uniform"

    low: float = quantity("x_min", "m", "smallest diameter", ge=0, hint=LENGTH_HINT)
    high: float = quantity("x_max", "m", "largest diameter", gt=0, hint=LENGTH_HINT)

    def _problems(self) -> list[str]:
        if self.high > self.low:
            return []
        return [
            Problem(
                "high",
                f"must be above low = {self.low:g} [m]; for one single size use " + SINGLE,
                f"{self.high:g}",
                code=Mistake.ORDER,
            )
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
