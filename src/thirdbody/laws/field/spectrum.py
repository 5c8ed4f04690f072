r"""A field of heights by its spectrum: what of its autocorrelation the theory of one field needs.

Lengths along the surface are in :math:`\sqrt{m_0/m_2}`, so that ⟨q²⟩ = 2. Filtered heights are
:math:`s = (1 - \tau + \tau|q|) * z`, scaled to variance 1, with τ from 0 (heights) to 1;
:math:`b = \tau/(1 - \tau)`.

.. math:: k_n(\tau) = \int_0^\infty \rho_s(r)^n\,dr, \qquad
          k_n^{zs} = \int_0^\infty \rho_{zs}(r)^n\,dr, \qquad c = \langle z s\rangle/\sigma
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import j0

from ...errors import InvalidValue, Mistake
from ...numerics.chebyshev import chebyshev_transform
from ...numerics.quadrature import gauss_legendre
from ...numerics.roots import bracketed_root

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["HURST", "FilteredSeries", "Spectrum", "rolled_off"]

HURST = 0.8
"""Of the spectra that ship, as `thirdbody.explicit.surface_of` draws them."""
WAVES = 200
"""Gauss nodes in q: 1e-12 of the moments for every α of the table."""
WIGNER = 3.900
"""Of 1/r on a square lattice in a neutralising background."""
STRAIGHT = 4.0
"""|t| beyond which heights that are not Gaussian are taken for straight."""
NEAR_NODES = 40
"""Nodes, and waves up to the end in units of 1/q, up to which so many do."""
FARTHEST = 80.0
"""Distance at which ρ is cut: what lies beyond is 1e-5 of k_2 and nothing of k_1."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Spectrum:
    """An isotropic field by the shares of its waves.

    Parameters
    ----------
    q : array (M,)
        Wavenumbers over √(m2/m0) [1].
    weight : array (M,)
        Share of each in the variance [1]; they sum to 1, and ⟨q²⟩ = 2.
    farthest : float
        Distance over √(m0/m2) to which its autocorrelation is known [1].
    box : float
        Side of a square after which the surface repeats itself [1], 0 if it does not. Then
        powers n ≥ 2 lose the mean pressure of all boxes, (3.900/L)∫ρⁿ r dr, and n = 1 is the sum
        over the waves.
    heights : tuple of float
        G_n from n = 1 of heights z/σ = Σ G_n he_n(t) on this Gaussian field t, ΣG_n² = 1 [1];
        heights that are Gaussian themselves are t.

    Examples
    --------
    >>> round(rolled_off(5.0).mean(-1), 3)  # k_1 of the heights
    1.816
    """

    q: Array
    weight: Array
    farthest: float = FARTHEST
    box: float = 0.0
    heights: tuple[float, ...] = (1.0,)

    @property
    def steeper(self) -> float:
        """√(Σ n G_n²), RMS gradient of z/σ over that of t [1]."""
        return math.sqrt(sum(n * G * G for n, G in enumerate(self.heights, 1)))

    def height(self, t: Array) -> Array:
        """z/σ where the Gaussian field is t, straight beyond ±4."""
        if len(self.heights) == 1:
            return t
        near = np.clip(t, -STRAIGHT, STRAIGHT)
        return np.polynomial.hermite_e.hermeval(near, self._series) + self.slope(t) * (t - near)

    def slope(self, t: Array) -> Array:
        """Derivative of `height` with respect to t."""
        if len(self.heights) == 1:
            return np.ones_like(t)
        series = np.polynomial.hermite_e.hermeder(self._series)
        near = np.clip(t, -STRAIGHT, STRAIGHT)
        return np.asarray(np.polynomial.hermite_e.hermeval(near, series), dtype=float)

    @property
    def _series(self) -> Array:
        """Coefficients of `height` in He_n, from n = 0 on."""
        norm = [math.sqrt(math.factorial(n)) for n in range(1, len(self.heights) + 1)]
        return np.array([0.0, *(G / scale for G, scale in zip(self.heights, norm, strict=True))])

    def mean(self, power: float) -> float:
        """⟨q^power⟩."""
        return float(self.weight @ self.q**power)

    @property
    def alpha(self) -> float:
        """Nayak's bandwidth α = 1.5⟨q⁴⟩/⟨q²⟩² [1]."""
        return 1.5 * self.mean(4) / self.mean(2) ** 2

    def correlations(self, r: Array) -> Array:
        """∫C qʲ J_0(qr) for j = 0, 1, 2 at distances r (N,): (3, N)."""
        waves = j0(np.multiply.outer(np.asarray(r, dtype=float), self.q))
        return np.stack([waves @ (self.weight * self.q**j) for j in range(3)])

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """Distances r and weights dr of integrals over all distances."""
        step = min(0.5, 3.0 / float(self.q.max()))
        edges = [0.0, *np.geomspace(0.02, 2.0, 24), *np.arange(2.0, self.farthest, step)[1:]]
        x, weight = gauss_legendre(10)
        low, half = np.array(edges[:-1]), 0.5 * np.diff(edges)
        r = low[:, None] + half[:, None] * (1 + x)
        return r.ravel(), (half[:, None] * weight).ravel()

    @cached_property
    def _weights(self) -> Array:
        """Weights of `nodes`, less those of waves that a box does not have."""
        r, weight = self.nodes
        return weight * (1 - WIGNER * r / self.box) if self.box else weight

    @cached_property
    def _at_nodes(self) -> Array:
        return self.correlations(self.nodes[0])

    def filtered_correlations(self, tau: float) -> tuple[float, Array, Array]:
        """c, and ρ_s and ρ_zs at `nodes`, of the filter τ."""
        a = 1 - tau
        norm = a * a + 2 * a * tau * self.mean(1) + tau * tau * self.mean(2)
        plain, once, twice = self._at_nodes
        of_s = (a * a * plain + 2 * a * tau * once + tau * tau * twice) / norm
        of_both = (a * plain + tau * once) / math.sqrt(norm)
        return (a + tau * self.mean(1)) / math.sqrt(norm), of_s, of_both

    def integrals(self, tau: float, count: int) -> Array:
        """k_n(τ) for n = 0 … count, with 0 in the place of k_0."""
        _, of_s, _ = self.filtered_correlations(tau)
        out = integrals_of_powers(of_s, self._weights, count)
        a = 1 - tau
        norm = a * a + 2 * a * tau * self.mean(1) + tau * tau * self.mean(2)
        # without what the cut leaves out
        out[1] = (a * a * self.mean(-1) + 2 * a * tau + tau * tau * self.mean(1)) / norm
        return out

    def series(self, count: int) -> FilteredSeries:
        """c and k_n over τ."""
        return FilteredSeries(self, count)

    def integrals_from(self, r: float, tau: Array, count: int) -> tuple[Array, Array]:
        """∫_r^∞ρⁿ and, for each τ (T,), ∫_r^∞ρ_zsⁿ: (count + 1,), (T, count + 1).

        n = 0 stands for −r, the part of the nominal area from which others are kept.
        """
        at, weight = gauss_legendre(int(near_nodes(r * self.q.max())))
        half = 0.5 * min(r, self.farthest)  # beyond, there is nothing to leave out
        near = half * (1 + at)
        weight = half * weight
        plain, once, _ = self.correlations(near)
        plain_integrals = integrals_of_powers(
            self._at_nodes[0], self._weights, count
        ) - integrals_of_powers(plain, weight, count)
        plain_integrals[1] = self.mean(-1) - float(weight @ plain)
        first, second, _ = self._at_nodes
        mixed = integrals_of_powers(
            self.cross_correlation(first, second, tau), self._weights, count
        )
        mixed[:, 1] = self.cross_correlation(self.mean(-1), 1.0, tau)[:, 0]
        mixed -= integrals_of_powers(self.cross_correlation(plain, once, tau), weight, count)
        plain_integrals[0], mixed[:, 0] = -r, -r
        return plain_integrals, mixed

    def cross_correlation(self, plain: Array | float, once: Array | float, tau: Array) -> Array:
        """ρ_zs of each filter τ (T,) from ∫C J_0 and ∫C q J_0 at distances (N,): (T, N)."""
        tau = tau[:, None]
        a = 1 - tau
        norm = a * a + 2 * a * tau * self.mean(1) + tau * tau * self.mean(2)
        return np.asarray((a * plain + tau * once) / np.sqrt(norm))


def near_nodes(phase: Array | float) -> NDArray[np.intp]:
    """How many nodes integrals of J_0(qr) up to r need, for the largest qr."""
    doublings = np.ceil(np.log2(np.maximum(np.asarray(phase) / NEAR_NODES, 1.0)))
    return NEAR_NODES * 2 ** doublings.astype(np.intp)


def integrals_of_powers(rho: Array, weight: Array, count: int) -> Array:
    """∫ρⁿ for n = 0 … count, with 0 for n = 0, of ρ (..., N): (..., count + 1)."""
    out = np.zeros((*rho.shape[:-1], count + 1))
    term = np.broadcast_to(weight, rho.shape).copy()
    for n in range(1, count + 1):
        term *= rho
        out[..., n] = term.sum(axis=-1)
    return out


class FilteredSeries:
    """c(τ), k_n(τ) and their derivatives as Chebyshev series in τ; made by `Spectrum.series`."""

    TERMS = 20

    def __init__(self, spectrum: Spectrum, count: int):
        x, transform = chebyshev_transform(self.TERMS)
        self.spectrum, self.count = spectrum, count
        values = [spectrum.integrals(0.5 * (1 + t), count) for t in x.tolist()]
        self._k = transform @ np.array(values)
        self._slope = 2 * np.polynomial.chebyshev.chebder(self._k)

    def __call__(self, tau: Array) -> tuple[Array, Array, Array, Array]:
        """c, dc/dτ (N,), k_n, dk_n/dτ (N, count + 1) at τ (N,)."""
        basis = np.polynomial.chebyshev.chebvander(2 * tau - 1, self.TERMS - 1)
        first, second = self.spectrum.mean(1), self.spectrum.mean(2)
        a = 1 - tau
        norm = a * a + 2 * a * tau * first + tau * tau * second
        slope = -2 * a + 2 * (1 - 2 * tau) * first + 2 * tau * second
        c = (a + tau * first) / np.sqrt(norm)
        dc = (first - 1) / np.sqrt(norm) - 0.5 * c * slope / norm
        return c, dc, basis @ self._k, basis[:, :-1] @ self._slope


@lru_cache(maxsize=64)
def rolled_off(alpha: float, hurst: float = HURST, corner: str = "smooth") -> Spectrum:
    r"""The spectrum that the library draws surfaces with, of the bandwidth α.

    .. math:: C(q) \propto \left[1 + (q/q_r)^2\right]^{-1-H}, \qquad q \le q_s

    Parameters
    ----------
    alpha : float
        Nayak's bandwidth α [1], above 2.
    hurst : float, optional
        Hurst exponent H [1].
    corner : {"smooth", "sharp"}, optional
        As above, or C = 1 up to q_r and (q/q_r)^(−2 − 2H) from there.

    Returns
    -------
    Spectrum

    Raises
    ------
    InvalidValue
        α that no such spectrum has.

    Examples
    --------
    >>> round(rolled_off(15.0).alpha, 9)
    15.0
    """
    x, weight = gauss_legendre(WAVES)
    q, weight = 0.5 * (1 + x), 0.5 * weight

    def shares(log_ratio: float) -> Array:
        over = (q / math.exp(log_ratio)) ** 2
        decay = 1 + over if corner == "smooth" else np.maximum(over, 1.0)
        density = weight * q * decay ** (-1 - hurst)
        return density / density.sum()

    def miss(log_ratio: Array) -> Array:
        rows = [shares(float(one)) for one in np.atleast_1d(log_ratio)]
        return np.array([1.5 * (row @ q**4) / (row @ q**2) ** 2 for row in rows]) - alpha

    ends = np.array([math.log(1e-3)]), np.array([math.log(1e3)])
    root = float(bracketed_root(miss, *ends)[0])
    if math.isnan(root):
        raise InvalidValue(
            f"no spectrum that rolls off and ends has the bandwidth α = {alpha:.4g}; it is above 2",
            code=Mistake.BEYOND,
        )
    share = shares(root)
    longest = math.sqrt(2 / float(share @ q**2))
    return Spectrum(q=q * longest, weight=share)
