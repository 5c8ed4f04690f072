r"""Sums over all asperities of a rough surface, as functions of the separation.

.. math:: F_{ss}(d) = \eta \int F_1(\omega)\,
          \phi\!\left(\frac{d+\omega-\mu_0}{\sigma_s}\right)\frac{d\omega}{\sigma_s}

and areas alike. Sums are tabulated once per surface and law as Chebyshev series in the separation.
Because S(ω) jumps are inside the integral, derivatives with respect to d hold jumps of the law.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property, lru_cache, partial, singledispatch
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..laws.base import REGIMES, AbstractAsperityLaw
from ..numerics.chebyshev import PiecewiseChebyshev, chebyshev_transform
from ..numerics.products import in_pieces
from ..numerics.quadrature import panel_rule, subdivide
from ..populations.heights import GaussianHeights, Heights
from ..populations.materials import MaterialPair
from ..populations.roughness import Roughness
from .spots import AsperitySpots

__all__ = [
    "SEARCHED",
    "AsperitySum",
    "DensitySum",
    "GaussianSum",
    "MixedSum",
    "asperity_sum",
    "asperity_sum_of",
    "reduced_sum",
]

Array = NDArray[np.float64]
SEARCHED = -3.0
"""Lowest separation searched, in σ_s from the mean asperity height: every asperity touches."""
KINDS = (0, 1, 1, 1)
"""Which columns are measured against each other: load, areas by regime."""


def by_regime(law: AbstractAsperityLaw, y: Array) -> Array:
    """Reduced load, and area sorted by regime, of asperities pressed by y = ω/ω_1: (..., 4)."""
    regime, area = regimes(law, y), law.reduced("area", y)
    areas = [np.where(regime == i, area, 0.0) for i in range(len(REGIMES))]
    return np.stack([law.reduced("force", y), *areas], axis=-1)


def regimes(law: AbstractAsperityLaw, y: Array) -> NDArray[np.intp]:
    """Index into `REGIMES` of asperities pressed by y = ω/ω_1."""
    order = np.array([REGIMES.index(branch.regime) for branch in law.branches])
    return order[np.searchsorted(law.breakpoints, y, side="right")]


class ReducedSum(ABC):
    """Base of sums of one law over heights, lengths in σ_s.

    With w = ω_1/σ_s it holds ∫f(t/w) φ(h+t) dt and ∫a(t/w) φ(h+t) dt at separations h; equal
    laws, heights and w share one table, whatever the surface.
    """

    DEEPEST = 5.0
    """Separations below −DEEPEST σ_s are outside every asperity model."""
    highest: float
    """Separation [σ_s] above which no asperity is in contact, or the density underflows."""

    def __init__(self, law: AbstractAsperityLaw, heights: Heights, w: float):
        """``law`` is bound to its contact."""
        self.law, self.heights, self.w = law, heights, w
        self.start = law.start * w

    def _kinks(self, end: float) -> list[float]:
        """Interferences [σ_s] where the law changes its formula."""
        return [y * self.w for y in self.law.breakpoints if self.start < y * self.w < end]

    def share_beyond(self, h: float) -> float:
        """Part of the load at separation h on asperities past the law's range, to a per mille."""
        limit, end = self.law.valid_to * self.w, min(self.heights.highest, max(h, 0.0) + 20.0) - h
        if not limit < end:
            return 0.0
        edges = np.array(sorted({self.start, limit, end, *self._kinks(end)}))
        t, weight = panel_rule(subdivide(edges, width=1.0, ratio=4.0), 10)
        load = weight * np.abs(self.law.reduced("force", t / self.w)) * self.heights.pdf(h + t)
        return float(load[t > limit].sum() / load.sum()) if load.any() else 0.0

    @abstractmethod
    def load(self, h: Array) -> Array:
        """Load, and its first and second derivative with respect to h: (N, 3)."""

    @abstractmethod
    def fields(self, h: Array) -> Array:
        """Load, elastic, elastoplastic and plastic area: (N, 4)."""

    @abstractmethod
    def nodes(self, h: Array) -> tuple[Array, Array | None, Array]:
        """Interferences y = ω/ω_1 (M, n), and of one asperity how many are there.

        Two arrays as in `Spots`: the share of each state, and the number.
        """


class GaussianRule:
    """Nodes in the reduced interference y for Gaussian heights, good for an octave of w.

    Node j stands for asperities pressed by t = w y_j: a sum over heights is
    w Σ c_j exp(−hwy_j − w²y_j²/2), with weight and density's constant inside the columns. The law
    is evaluated here and nowhere else. Relative error 1e-13 for separations h from −5 to +12.

    Attributes
    ----------
    y : array (n,)
        Increasing.
    weight : array (n,)
        Of the nodes in y, with the constant 1/√(2π).
    columns : array (n, 4)
        The weighted load, elastic, elastoplastic and plastic area.
    """

    NODES, WIDTH = 16, 2.5
    DROP = 100.0
    """Where the exponent has fallen by DROP/2 the rest is left out."""

    def __init__(self, law: AbstractAsperityLaw, octave: int):
        low, high = 2.0**octave, 2.0 ** (octave + 1)
        deepest = ReducedSum.DEEPEST
        end = (deepest + math.sqrt(deepest**2 + self.DROP)) / low
        kinks = [y for y in law.breakpoints if law.start < y < end]
        edges = np.array(sorted({0.0, 0.3 / high, end, *kinks}))
        if law.start < 0:
            edges = np.concatenate([[law.start], edges])
        edges = subdivide(edges, width=self.WIDTH / high, ratio=4.0)
        # the root as variable in the first panel, where the load starts like a power of it
        root, root_weight = panel_rule(np.sqrt(edges[:2] - law.start), self.NODES)
        y, weight = panel_rule(edges[1:], self.NODES)
        self.y = np.concatenate([law.start + root**2, y])
        self.weight = np.concatenate([2 * root * root_weight, weight]) / math.sqrt(2 * math.pi)
        self.columns = self.weight[:, None] * by_regime(law, self.y)

    def sums(self, w: float, h: Array, *, whole: bool = False) -> Array:
        """Columns, then the moments wy and w²y² of the load, at (N,) separations [σ_s]: (N, 6).

        The common factor exp(−h²/2) is left out unless ``whole``.
        """
        t = w * self.y
        force = self.columns[:, :1]
        columns = w * np.hstack([self.columns, force * t[:, None], force * t[:, None] ** 2])
        out = np.empty((len(h), columns.shape[1]))
        for piece in in_pieces(len(h), columns.size):
            if whole:
                e = -0.5 * np.add.outer(h[piece], t) ** 2
            else:
                e = np.multiply.outer(-h[piece], t)
                e -= 0.5 * t**2
                np.maximum(e, -700.0, out=e)
            np.exp(e, out=e)
            out[piece] = e @ columns
        return out


@lru_cache(maxsize=256)
def gaussian_rule(law: AbstractAsperityLaw, octave: int) -> GaussianRule:
    """The cached rule of a bound law for 2^octave ≤ w < 2^(octave + 1)."""
    return GaussianRule(law, octave)


class GaussianSum(ReducedSum):
    """Gaussian heights: sums over fixed interferences, one exponential a node.

    The density is exp(−h²/2)·exp(−ht − t²/2): the first factor is taken out, so nothing
    underflows, and the derivatives with respect to h come from the moments of the same nodes.
    Relative error 1e-12 for h from −4 to +12.
    """

    highest = 37.0
    SPAN = np.array(
        [
            *np.linspace(-ReducedSum.DEEPEST, 0.0, 9),
            *(0.75, 1.5, 3.0, 4.25, 5.5, 8.0, 12.0, 16.0, 21.5, 27.0, highest + 1),
        ]
    )
    """Panels in h that every law needs at least."""
    KINDS = (*KINDS, 2, 3)

    def __init__(self, law: AbstractAsperityLaw, heights: Heights, w: float):
        super().__init__(law, heights, w)
        self.rule = gaussian_rule(law, math.frexp(w)[1] - 1)
        self.t = w * self.rule.y

    @cached_property
    def table(self) -> PiecewiseChebyshev:
        """The sums without exp(−h²/2), as functions of h."""
        return PiecewiseChebyshev(partial(self.rule.sums, self.w), self.SPAN, kinds=self.KINDS)

    def _sums(self, h: Array) -> tuple[Array, Array]:
        """The sums (N, 6), and their common factor (N, 1)."""
        out, factor = self.table(h), np.exp(-0.5 * h * h)
        low, high = self.table.edges[[0, -1]]
        if np.any(beyond := (h < low) | (h > high)):
            # what attracts reaches above its height: sum and factor by themselves would overflow
            out[beyond], factor[beyond] = self.rule.sums(self.w, h[beyond], whole=True), 1.0
        return out, factor[:, None]

    def load(self, h: Array) -> Array:
        sums, factor = self._sums(h)
        m0, m1, m2 = sums[:, 0], sums[:, 4], sums[:, 5]
        out = np.stack([m0, -(h * m0 + m1), (h * h - 1) * m0 + 2 * h * m1 + m2], axis=-1)
        return out * factor

    def fields(self, h: Array) -> Array:
        sums, factor = self._sums(h)
        out = sums[:, :4] * factor
        out[:, 1:] = np.maximum(out[:, 1:], 0.0)  # rounding of the other regimes
        return out

    def nodes(self, h: Array) -> tuple[Array, Array | None, Array]:
        share = np.exp(-0.5 * (h[:, None] + self.t) ** 2)
        return self.rule.y[:, None], share, self.w * self.rule.weight[:, None]


class GaussianSums:
    """Gaussian heights for every w of half an octave: Chebyshev series in h and in ln w.

    Interfaces that differ in roughness or material then need no quadrature of their own. Relative
    error 1e-13 of the load and of the whole area.

    Parameters
    ----------
    law : AbstractAsperityLaw
        Bound, the same for all.
    step : int
        Stands for 2^(step/2) ≤ w < 2^((step + 1)/2).

    Attributes
    ----------
    table : PiecewiseChebyshev
        In h, of the sums at TERMS values of w, one after another.
    coefficients : array (panels, TERMS, terms in h, 6)
        In ln w and h, of the columns of `GaussianRule.sums`.
    """

    TERMS = 16
    """Terms in ln w: 1e-14 for every law of the library."""

    def __init__(self, law: AbstractAsperityLaw, step: int):
        x, transform = chebyshev_transform(self.TERMS)
        rule = gaussian_rule(law, step // 2)
        interferences = 2.0 ** ((step + 0.5 * (x + 1)) / 2)

        def sums(h: Array) -> Array:
            return np.concatenate([rule.sums(w, h) for w in interferences], axis=1)

        kinds = GaussianSum.KINDS * self.TERMS
        self.table = PiecewiseChebyshev(sums, GaussianSum.SPAN, kinds=kinds)
        panels, terms, _ = self.table.coefficients.shape
        apart = self.table.coefficients.reshape(panels, terms, self.TERMS, -1)
        self.coefficients = np.einsum("ij,pkjc->pikc", transform, apart)

    def middle(self, h: Array) -> Array:
        """The load in the middle of the half octave: (N,)."""
        loads = self.table(h).reshape(len(h), self.TERMS, -1)[:, :, 0]
        _, transform = chebyshev_transform(self.TERMS)
        return loads @ np.polynomial.chebyshev.chebval(0.0, transform)

    @staticmethod
    def place(w: Array) -> tuple[NDArray[np.intp], Array]:
        """Step of every w, and where it lies in the step, from −1 to 1."""
        at = 2 * np.log2(w)
        step = np.floor(at)
        return step.astype(np.intp), 2 * (at - step) - 1


@lru_cache(maxsize=128)
def gaussian_sums(law: AbstractAsperityLaw, step: int) -> GaussianSums:
    """The cached sums of a bound law for 2^(step/2) ≤ w < 2^((step + 1)/2)."""
    return GaussianSums(law, step)


class DensitySum(ReducedSum):
    """Any other heights: panels split where the law or the density changes its formula."""

    NEAREST = 1e-9
    """Distance [σ_s] to the last asperity of bounded heights below which a load is not resolved."""

    def __init__(self, law: AbstractAsperityLaw, heights: Heights, w: float):
        super().__init__(law, heights, w)
        pieces = np.array(self.heights.pieces)
        self.highest = float(self.heights.highest - self.start)
        end = pieces[-1] + self.DEEPEST
        marks = [self.start, *self._kinks(end)]
        edges = np.array(sorted({*marks, 0.0, 0.1, 0.4, end}))
        self.marks = subdivide(edges, width=np.inf, ratio=4.0)
        knots = {z - t for z in self.heights.kinks for t in marks}
        inside = sorted(k for k in knots if -self.DEEPEST < k < self.highest)
        span = np.array([-self.DEEPEST, *inside, self.highest])
        if self.heights.highest in self.heights.kinks:
            # the last asperity sets in like a power of its distance: light loads by themselves
            rise = np.array(sorted({*(self.highest - span), self.NEAREST}))
            rise = subdivide(rise, width=np.inf, ratio=2.0)[::-1]
            span = np.append(span[0], self.highest - rise[1:])
        span = subdivide(span, width=4.0)
        self.table = PiecewiseChebyshev(self._sum, span, tolerance=1e-13, max_depth=30, kinds=KINDS)

    def _nodes(self, h: Array) -> tuple[Array, Array]:
        """Interferences t and weights φ(h + t) dt for (N,) separations in σ_s: (N, n)."""
        pieces = np.array(self.heights.pieces)
        shape = (len(h), len(self.marks))
        edges = np.concatenate([pieces - h[:, None], np.broadcast_to(self.marks, shape)], axis=1)
        low = np.maximum(self.start, pieces[0] - h)[:, None]
        edges = np.clip(edges, low, np.maximum(low, pieces[-1] - h[:, None]))
        root, weight = panel_rule(np.sort(np.sqrt(edges - self.start), axis=1), 16)
        t = self.start + root**2
        return t, self.heights.pdf(h[:, None] + t) * 2 * root * weight

    def _sum(self, h: Array) -> Array:
        """∫ columns(t) φ(h + t) dt for (N,) separations in σ_s: (N, 4)."""
        t, density = self._nodes(h)
        used = density > 0
        columns = np.zeros((*t.shape, 4))
        columns[used] = by_regime(self.law, t[used] / self.w)
        return np.einsum("hn,hnk->hk", density, columns)

    def load(self, h: Array) -> Array:
        low, high = self.table.edges[[0, -1]]
        out = self.table.derivatives(np.clip(h, low, high), (0,))[:, 0]
        out[h > high] = 0.0
        if np.any(below := h < low):
            out[below] = np.nan
            out[below, 0] = self._sum(h[below])[:, 0]
        return out

    def fields(self, h: Array) -> Array:
        low, high = self.table.edges[[0, -1]]
        out = self.table(np.clip(h, low, high))
        out[h > high] = 0.0
        if np.any(below := h < low):
            out[below] = self._sum(h[below])
        out[:, 1:] = np.maximum(out[:, 1:], 0.0)  # rounding of the other regimes
        return out

    def nodes(self, h: Array) -> tuple[Array, Array | None, Array]:
        t, density = self._nodes(h)
        return t / self.w, None, density


@lru_cache(maxsize=512)
def reduced_sum(law: AbstractAsperityLaw, heights: Heights, w: float) -> ReducedSum:
    """The cached sum of a bound law over heights."""
    kind = GaussianSum if isinstance(heights, GaussianHeights) else DensitySum
    return kind(law, heights, w)


def scales(
    law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair
) -> tuple[Array, Array]:
    """w = ω_1/σ_s, and the units of load [Pa] and of area by regime: (...,), (..., 4)."""
    H = surfaces.H
    omega_1 = law.yield_interference(R=rough.R, E_star=surfaces.E_star, H=H)
    area = np.asarray(rough.density * math.pi * rough.R * omega_1)
    return np.asarray(omega_1 / rough.sigma_s), np.stack([area * H, area, area, area], axis=-1)


class AsperitySum:
    """One law on one rough surface, as functions of the separation d [m]."""

    def __init__(
        self, law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair, datum: float
    ):
        law_in_contact = law.bound(
            R=rough.R, E_star=surfaces.E_star, H=surfaces.H, nu=surfaces.softer.nu
        )
        w, self.units = scales(law_in_contact, rough, surfaces)
        self.rough, self.surfaces = rough, surfaces
        self.sigma_s = rough.sigma_s
        self.centre = datum * rough.sigma
        self.reduced = reduced_sum(law_in_contact, rough.heights, float(w))
        self.highest = self.reduced.highest
        self.searched = SEARCHED
        self.deepest = self.centre - ReducedSum.DEEPEST * self.sigma_s

    def load(self, d: Array) -> Array:
        """F_ss without shadow [Pa], and its first and second derivative: (N, 3)."""
        out = self.reduced.load((d - self.centre) / self.sigma_s)
        return out * (self.units[0] / self.sigma_s ** np.arange(3))

    def share_beyond(self, d: float) -> float:
        """Part of F_ss at separation d on asperities past the range of the law."""
        return self.reduced.share_beyond((d - self.centre) / self.sigma_s)

    def fields(self, d: Array) -> Array:
        """F_ss [Pa], A_e, A_ep, A_p without shadow: (N, 4)."""
        return self.reduced.fields((d - self.centre) / self.sigma_s) * self.units

    def spots(self, d: Array) -> list[AsperitySpots]:
        """Every asperity in contact at d, without shadow."""
        rough, law, H = self.rough, self.reduced.law, self.surfaces.H
        h = (d - self.centre) / self.sigma_s
        y, share, number = self.reduced.nodes(h)
        omega_1 = self.reduced.w * self.sigma_s
        unit = math.pi * rough.R * omega_1
        return [
            AsperitySpots(
                share=share,
                number=rough.density * number,
                load=unit * H * law.reduced("force", y),
                area=unit * law.reduced("area", y),
                regime=regimes(law, y),
                depth=omega_1 * y,
                R=rough.R,
                law=law,
                E_star=self.surfaces.E_star,
                H=H,
                heights=rough.heights,
                sigma_s=self.sigma_s,
                lowest=h,
                density=np.full(len(h), rough.density),
            )
        ]


class MixedSum:
    """Sum over elliptic asperities of several shapes: an `AsperitySum` each, with its R_g and η."""

    def __init__(
        self, law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair, datum: float
    ):
        assert rough.ellipticity is not None
        self.sigma_s = rough.sigma_s
        self.centre = datum * rough.sigma
        self.parts = []
        for ratio, radius, share in rough.ellipticity.classes:
            alike = rough.replace(
                R=radius * rough.R, eta=share * rough.density, eta_R_sigma=None, ellipticity=None
            )
            self.parts.append(AsperitySum(law.replace(ratio=ratio), alike, surfaces, datum))
        self.highest = max(shape.highest for shape in self.parts)
        self.searched = SEARCHED
        self.deepest = self.centre - ReducedSum.DEEPEST * self.sigma_s

    def load(self, d: Array) -> Array:
        """As `AsperitySum.load`."""
        return np.sum([shape.load(d) for shape in self.parts], axis=0)

    def share_beyond(self, d: float) -> float:
        """The largest `AsperitySum.share_beyond` of the shapes."""
        return max(shape.share_beyond(d) for shape in self.parts)

    def fields(self, d: Array) -> Array:
        """As `AsperitySum.fields`."""
        return np.sum([shape.fields(d) for shape in self.parts], axis=0)

    def spots(self, d: Array) -> list[AsperitySpots]:
        """As `AsperitySum.spots`, one item a shape."""
        return [spots for shape in self.parts for spots in shape.spots(d)]


@lru_cache(maxsize=512)
def asperity_sum(
    law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair, datum: float
) -> Any:
    """The cached sum over the asperities of a rough surface."""
    return asperity_sum_of(law, rough, surfaces, datum)


@singledispatch
def asperity_sum_of(
    law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair, datum: float
) -> Any:
    """The sum over the asperities of a rough surface, by the kind of its law."""
    kind = AsperitySum if rough.ellipticity is None else MixedSum
    return kind(law, rough, surfaces, datum)
