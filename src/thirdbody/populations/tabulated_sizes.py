"""Size distributions as they are measured: by classes, by counts above sizes, and mixed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

from ..errors import Mistake, Problem
from ..quantities.value import Value, items_of, sequences, several
from .size_base import (
    ONE_SIZE,
    Distribution,
    _clip,
    _ratios,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Histogram", "Mixture", "PowerLaw"]


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
    >>> import thirdbody as tb
    >>> sizes = tb.distributions.Histogram(edges=(0.0, 1e-7, 3e-7), counts=(1, 1))
    >>> round(sizes.mean_diameter * 1e9, 6)
    125.0
    """

    name = "histogram"

    edges: tuple[float, ...] = several("m", "edges of the classes of size")
    counts: tuple[float, ...] = several("1", "particles in each class")

    def __post_init__(self) -> None:
        sequences(self, "edges", "counts")
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        e, c = self.edges, self.counts
        out: list[str] = []
        if not all(math.isfinite(v) for v in (*e, *c)):
            return [Problem("edges", "and counts must be finite numbers", code=Mistake.KIND)]
        if len(e) != len(c) + 1 or not c:
            out.append(
                Problem(
                    "",
                    f"has {len(e)} edges and {len(c)} counts; n bins have n + 1 edges",
                    owner=type(self).__name__,
                    code=Mistake.SHAPE,
                )
            )
        if any(b <= a for a, b in zip(e, e[1:], strict=False)) or (e and e[0] < 0):
            out.append(
                Problem("edges", "must increase and start at or above 0 [m]", code=Mistake.ORDER)
            )
        if any(v < 0 for v in c) or not any(v > 0 for v in c):
            out.append(
                Problem("counts", "must be >= 0 with at least one above 0", code=Mistake.RANGE)
            )
        return out

    @property
    def _bins(self) -> tuple[Array, Array, Array]:
        """Lower edges, upper edges and densities of the bins between the first and last filled."""
        e, c = np.array(self.edges), np.array(self.counts)
        filled = np.flatnonzero(c)
        rows = slice(filled[0], filled[-1] + 1)
        lo, hi = e[:-1][rows], e[1:][rows]
        return lo, hi, c[rows] / c.sum() / (hi - lo)

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
    >>> import thirdbody as tb
    >>> sizes = tb.distributions.PowerLaw(
    ...     edges=(4e-6, 6e-6, 14e-6), counts=(3, 1), slopes=(3.4, 2.5)
    ... )
    >>> round(sizes.mean_diameter * 1e6, 4)
    5.5787
    """

    name = "power-law"

    edges: tuple[float, ...] = several("m", "edges of the classes of size")
    counts: tuple[float, ...] = several("1", "particles in each class")
    slopes: tuple[float, ...] = several("1", "exponents of the number over size")

    def __post_init__(self) -> None:
        sequences(self, "edges", "counts", "slopes")
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        e, c, s = self.edges, self.counts, self.slopes
        if not all(math.isfinite(v) for v in (*e, *c, *s)):
            return [
                Problem("edges,", "counts and slopes must be finite numbers", code=Mistake.KIND)
            ]
        out: list[str] = []
        if not len(e) - 1 == len(c) == len(s) or not c:
            out.append(
                Problem(
                    "",
                    f"has {len(e)} edges, {len(c)} counts and {len(s)} slopes; "
                    "n sections have n + 1 edges",
                    owner=type(self).__name__,
                    code=Mistake.SHAPE,
                )
            )
        if any(b <= a for a, b in zip(e, e[1:], strict=False)) or (e and e[0] <= 0):
            out.append(Problem("edges", "must increase and start above 0 [m]", code=Mistake.ORDER))
        if any(v < 0 for v in c) or not any(v > 0 for v in c):
            out.append(
                Problem("counts", "must be >= 0 with at least one above 0", code=Mistake.RANGE)
            )
        if not out and any(
            abs(v) * math.log(b / a) > 500 for v, a, b in zip(s, e, e[1:], strict=False)
        ):
            out.append(
                Problem(
                    "slopes", "are too steep for the width of their sections", code=Mistake.BEYOND
                )
            )
        return out

    @property
    def _sections(self) -> tuple[Array, Array, Array, Array]:
        """Edges below and above, slopes and shares, from the first to the last filled section."""
        filled = np.flatnonzero(self.counts)
        rows = slice(filled[0], filled[-1] + 1)
        e, c = np.array(self.edges), np.array(self.counts)
        return e[:-1][rows], e[1:][rows], np.array(self.slopes)[rows], c[rows] / c.sum()

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
        long = np.log1p((hi - lo) / lo)
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
        fraction = np.clip((q - start) / share[i], 0.0, 1.0)
        long, slope = np.log1p((hi - lo) / lo)[i], s[i]
        safe = np.where(slope == 0, 1.0, slope)
        with np.errstate(divide="ignore"):
            step = -np.log1p(fraction * np.expm1(-safe * long)) / safe
        step = np.where(slope == 0, fraction * long, step)
        return lo[i] * np.exp(np.clip(step, 0.0, long))

    def partial_moment(self, n: int, a: ArrayLike, b: ArrayLike) -> Array:
        low, high = _clip(a, b, self.support)
        lo, hi, s, share = self._sections
        left = np.clip(low[..., None], lo, hi)
        right = np.clip(high[..., None], lo, hi)
        long, stretch = np.log1p((hi - lo) / lo), np.log1p((right - left) / left)
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
    >>> import thirdbody as tb
    >>> parts = (tb.distributions.Monodisperse(mean=1e-7), tb.distributions.Monodisperse(mean=3e-7))
    >>> both = tb.distributions.Mixture(parts=parts, weights=(3, 1))
    >>> round(both.mean_diameter * 1e9, 6)
    150.0
    """

    name = "mixture"

    parts: tuple[Distribution, ...]
    weights: tuple[float, ...] = several("1", "weights of the parts")

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", items_of(self.parts))
        sequences(self, "weights")
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        out: list[str] = []
        if not self.parts or len(self.parts) != len(self.weights):
            out.append(
                Problem(
                    "",
                    f"has {len(self.parts)} parts and {len(self.weights)} weights; "
                    "give one weight for each part",
                    owner=type(self).__name__,
                    code=Mistake.SHAPE,
                )
            )
        if any(not isinstance(component, Distribution) for component in self.parts):
            out.append(Problem("parts", "must all be size distributions", code=Mistake.KIND))
        if any(not (w > 0 and math.isfinite(w)) for w in self.weights):
            out.append(Problem("weights", "must all be > 0", code=Mistake.RANGE))
        return out

    @property
    def components(self) -> tuple[tuple[float, Distribution], ...]:
        total = sum(self.weights)
        return tuple(
            (w / total * inner, simple)
            for w, component in zip(self.weights, self.parts, strict=True)
            for inner, simple in component.components
        )

    @property
    def support(self) -> tuple[float, float]:
        ends = [component.support for _, component in self.components]
        return (min(lo for lo, _ in ends), max(hi for _, hi in ends))

    @property
    def pieces(self) -> tuple[float, ...]:
        return tuple(sorted({x for _, component in self.components for x in component.pieces}))

    @property
    def kinks(self) -> tuple[float, ...]:
        return tuple(sorted({x for _, component in self.components for x in component.kinks}))

    @property
    def retained_mass(self) -> float:
        return sum(w * component.retained_mass for w, component in self.components)

    def _sum(self, method: str, *args: object) -> Array:
        return sum(w * getattr(component, method)(*args) for w, component in self.components)

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
            parts=tuple(component.scaled(factor) for component in self.parts), weights=self.weights
        )

    def standardised(self) -> tuple[float, Distribution]:
        return 1.0, self
