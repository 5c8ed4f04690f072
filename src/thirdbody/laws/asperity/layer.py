r"""An elastic layer bonded to an elastic half-space, pressed by a paraboloid: exact solution.

The surface answers a pressure with wavenumber ξ by

.. math:: \hat w = \frac{2}{E_1^*\,\xi}\,M(\xi t)\,\hat p, \qquad
   M(x)=\frac{1+4x\kappa e^{-2x}-\Lambda\kappa e^{-4x}}
             {1-(\Lambda+\kappa+4\kappa x^2)e^{-2x}+\Lambda\kappa e^{-4x}},

with :math:`\mu=\mu_1/\mu_2` (shear moduli), :math:`\kappa=(\mu-1)/(\mu+3-4\nu_1)` and
:math:`\Lambda=1-4(1-\nu_1)/(1+\mu(3-4\nu_2))`. An elastic indenter adds E_1*/E_3* to M.
With :math:`\hat p=\int_0^a\psi(s)\cos\xi s\,ds` the frictionless contact of radius a obeys

.. math:: \frac{\pi}{2}\psi(x)+\int_0^a\psi(s)\,k(x,s)\,ds=\frac{E_1^*}{2}
          \left(\delta-\frac{x^2}{R}\right),\qquad
          k=\int_0^\infty (M(\xi t)-1)\cos\xi x\,\cos\xi s\,d\xi,

where ψ(a) = 0 fixes δ, and F = 2π∫ψ. Lengths scale with t, so one function of ωR/t² describes a
set of materials; nothing is fitted.

M has the form of O'Sullivan and King 1988 (recalled, checked against an independent
six-equation solution); the rest is derived.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly
from scipy.special import spherical_jn

from ...errors import InvalidValue, Mistake
from ...numerics.chebyshev import PiecewiseChebyshev, chebyshev_transform
from ...numerics.quadrature import gauss_legendre, panel_rule
from ...quantities.value import Value, quantity
from . import formulas

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["ElasticLayer", "table_of"]

THINNEST = 2.0**10
"""Contact radius over thickness up to which the equation is solved; beyond, see `reduced`."""
CUT = 24.0
"""M − 1 is left out above: it has fallen to e^(−2·24) = 1e-21."""
NODES = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class ElasticLayer(Value):
    """Materials of a layer 1 on a half-space 2, and of an indenter 3.

    Parameters
    ----------
    modulus_ratio : float
        Young's moduli E_1/E_2 [1].
    nu_1, nu_2 : float
        Poisson ratios of layer and half-space [1].
    indenter : float, optional
        E_1*/E_3* of the indenter [1], with E* = E/(1 − ν²); zero (the default) is rigid.

    References
    ----------
    O'Sullivan, King 1988, J. Tribol. 110, 235, doi:10.1115/1.3261591 (form of M, recalled).

    Examples
    --------
    >>> from thirdbody.laws.asperity.layer import ElasticLayer
    >>> layer = ElasticLayer(modulus_ratio=10, nu_1=0.25, nu_2=0.3)
    >>> [round(float(x), 8) for x in layer.contact(1.0)]
    [0.79698952, 2.2768495, 0.4256602]
    """

    modulus_ratio: float = quantity("E_1/E_2", "1", "layer over half-space", gt=0)
    nu_1: float = quantity("ν_1", "1", "Poisson ratio of the layer", gt=-1, le=0.5)
    nu_2: float = quantity("ν_2", "1", "Poisson ratio of the half-space", gt=-1, le=0.5)
    indenter: float = quantity("E_1*/E_3*", "1", "layer over indenter", default=0.0, ge=0)

    @property
    def thin_modulus(self) -> float:
        """Contact modulus of half-space and indenter without layer, over E_1* [1]."""
        bare = self.modulus_ratio * (1 - self.nu_2**2) / (1 - self.nu_1**2)
        return 1 / (bare + self.indenter)

    def compliance(self, x: ArrayLike) -> Array:
        """M(x) [1] at the wavenumber x = ξt: 1 for short waves, E_1*/E_2* for long ones."""
        return 1 + self.excess(np.asarray(x, dtype=float))

    def excess(self, x: Array) -> Array:
        """M(x) − 1, without cancellation for short waves."""
        mu = self.modulus_ratio * (1 + self.nu_2) / (1 + self.nu_1)
        kappa = (mu - 1) / (mu + 3 - 4 * self.nu_1)
        # Λ and both 1 − Λ, 1 − κ, which vanish together for a stiff layer
        not_Lambda = 4 * (1 - self.nu_1) / (1 + mu * (3 - 4 * self.nu_2))
        not_kappa = 4 * (1 - self.nu_1) / (mu + 3 - 4 * self.nu_1)
        Lambda = 1 - not_Lambda
        e = np.exp(-2 * x)
        gone = -np.expm1(-2 * x)
        # 1 − (Λ + κ)e + Λκe² = (1 − Λe)(1 − κe)
        bottom = (not_Lambda + Lambda * gone) * (not_kappa + kappa * gone)
        bottom = bottom - 4 * kappa * x**2 * e
        return e * (Lambda + kappa + 4 * kappa * x * (1 + x) - 2 * Lambda * kappa * e) / bottom

    def contact(self, a_t: ArrayLike) -> tuple[Array, Array, Array]:
        r"""Load, approach and stiffness at the contact radius a, solved directly.

        Parameters
        ----------
        a_t : array_like
            a/t [1], at most 1024.

        Returns
        -------
        Phi, Delta, s : array
            FR/(E_1*a³), δR/a² and (dF/dδ)/(E_1*a) [1]; 4/3, 1 and 2 for a rigid indenter on
            one material.
        """
        radius = np.asarray(a_t, dtype=float)
        if np.any((radius < 0) | (radius > THINNEST)):
            raise InvalidValue(f"a/t must lie between 0 and {THINNEST:g}", code=Mistake.RANGE)
        out = np.array([_solve(self, float(alpha)) for alpha in radius.ravel()])
        Phi, Delta, s = out.reshape(-1, 3).T.reshape(3, *radius.shape)
        return Phi, Delta, s

    @property
    def thick_slope(self) -> float:
        """k_0 = ∫(M − 1)dx [1]: Δ = 1 + (4k_0/3π)(a/t) for a ≪ t and a rigid indenter."""
        return float(_transform(self, np.zeros(1))[0])

    def reduced(self, y: ArrayLike) -> tuple[Array, Array, Array]:
        r"""Load, area and stiffness against y = ωR/t², from a table built on first use.

        Returns
        -------
        force, area, stiffness : array
            FR/(E_1*t³), (a/t)² and (dF/dω)/(E_1*t) [1].

        Notes
        -----
        Relative error 2e-11 for a/t up to 1024 and E_1/E_2 between 1e-3 and 1e3. Beyond, load and
        area are continued to those without layer by the leading terms in t/a, with 1e-5 or
        better for E_1/E_2 between 1e-2 and 1e2.
        """
        root = np.sqrt(np.maximum(np.asarray(y, dtype=float), 0.0))
        load, area, stiffness = table_of(self)(root.ravel()).T.reshape(3, *root.shape)
        return load * root**3, area * root**2, stiffness * root


# ------------------------------------------------------------------ kernel
def _transform(layer: ElasticLayer, v: Array) -> Array:
    """g(v) = ∫₀^∞ (M(x) − 1) cos(xv) dx: Legendre series on panels, integrated exactly."""
    edges = np.concatenate([[0.0], CUT * 0.5 ** np.arange(13.0, -1, -1)])
    x, _ = panel_rule(edges, 20)
    nodes, weights = gauss_legendre(20)
    n = np.arange(20)
    to_series = (2 * n[:, None] + 1) / 2 * np.polynomial.legendre.legvander(nodes, 19).T * weights
    series = layer.excess(x).reshape(-1, 20) @ to_series.T
    half, middle = 0.5 * np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
    out = np.zeros(len(v))
    for c, h, m in zip(series, half, middle, strict=True):
        # ∫P_n(s)e^{ivhs}ds = 2iⁿj_n(vh): its real part in even, imaginary part in odd n
        waves = spherical_jn(n[:, None], v * h)
        sign = np.where(n % 4 < 2, 1.0, -1.0) * c
        even, odd = (sign[k::2] @ waves[k::2] for k in (0, 1))
        out += 2 * h * (np.cos(v * m) * even - np.sin(v * m) * odd)
    return out


@lru_cache(maxsize=64)
def _kernel(layer: ElasticLayer) -> PiecewiseChebyshev:
    """g as a function of ln(1 + v) up to the largest distance."""
    span = np.linspace(0.0, math.log1p(2 * THINNEST), 19)
    return PiecewiseChebyshev(
        lambda u: _transform(layer, np.expm1(u))[:, None], span, tolerance=1e-12, max_depth=2
    )


# ------------------------------------------------------------------ integral equation
class _Mesh(NamedTuple):
    """A composite Gauss rule on [0, 1], refined towards 1, and integrals of a peaked kernel.

    For each collocation point the kernel is integrated over panels refined towards that point,
    with the unknown interpolated from its own nodes: neither edge layer nor kernel, both of the
    width of the layer, must be wide against the node spacing.
    """

    nodes: Array
    weights: Array
    points: Array
    """Collocation points: the nodes and 1."""
    s: Array
    """(points, subpanels, nodes a subpanel)"""
    ds: Array
    values: Array
    """Lagrange polynomials of the panel at s: (points, subpanels, nodes, NODES)."""
    columns: NDArray[np.intp]
    """Column of the first node of the panel in which a subpanel lies: (points, subpanels)."""


@lru_cache(maxsize=16)
def _mesh(depth: int) -> _Mesh:
    edges = np.append(1 - 0.5 ** np.arange(depth + 1.0), 1.0)
    nodes, weights = panel_rule(edges, NODES)
    points = np.append(nodes, 1.0)
    steps = 0.5 ** np.arange(1.0, depth + 2)
    steps = np.concatenate([-steps, [0.0], steps])
    marks = np.clip(points[:, None] + steps, 0.0, 1.0)
    marks = np.concatenate([marks, np.broadcast_to(edges, (len(points), len(edges)))], axis=1)
    marks.sort(axis=1)
    s, ds = (array.reshape(len(points), -1, NODES) for array in panel_rule(marks, NODES))
    panel = np.searchsorted(edges, 0.5 * (marks[:, 1:] + marks[:, :-1]), side="right") - 1
    panel = np.clip(panel, 0, len(edges) - 2)
    low, high = edges[panel][..., None], edges[panel + 1][..., None]
    local = (2 * s - low - high) / (high - low)
    local_nodes, local_weights = gauss_legendre(NODES)
    n = np.arange(NODES)
    to_series = (2 * n[:, None] + 1) / 2
    to_series = (
        to_series * np.polynomial.legendre.legvander(local_nodes, NODES - 1).T * local_weights
    )
    values = np.polynomial.legendre.legvander(local, NODES - 1) @ to_series
    return _Mesh(nodes, weights, points, s, ds, values, panel * NODES)


def _solve(layer: ElasticLayer, alpha: float) -> tuple[float, float, float]:
    """Φ, Δ and s at a/t = α, with ψ = (E_1*a²/πR)(Δχ_0 − χ_2)."""
    mesh = _mesh(math.ceil(math.log2(max(alpha, 1.0))) + 2)
    kernel = _kernel(layer)
    x = mesh.points[:, None, None]
    distances = np.log1p(alpha * np.stack([np.abs(x - mesh.s), x + mesh.s]))
    g = kernel(distances.ravel())[:, 0].reshape(distances.shape).sum(axis=0)
    parts = np.einsum("psq,psqj->psj", alpha / math.pi * g * mesh.ds, mesh.values)
    count = len(mesh.nodes)
    matrix = np.zeros((len(mesh.points), count))
    columns = mesh.columns[..., None] + np.arange(NODES)
    np.add.at(matrix, (np.arange(len(mesh.points))[:, None, None], columns), parts)
    right_sides = np.stack([np.ones_like(mesh.points), mesh.points**2], axis=1)
    diagonal = 1 + layer.indenter
    chi = np.linalg.solve(diagonal * np.eye(count) + matrix[:-1], right_sides[:-1])
    at_edge = (right_sides[-1] - matrix[-1] @ chi) / diagonal
    punch, curved = mesh.weights @ chi
    Delta = at_edge[1] / at_edge[0]
    return 2 * (Delta * punch - curved), Delta, 2 * punch


# ------------------------------------------------------------------ table
class _Table:
    """FR/(E_1*t³)/y^1.5, (a/t)²/y and (dF/dω)/(E_1*t)/y^0.5 against r = √y.

    Variables are ln(1 + βα) and ln(1 + βr): a stiff layer is felt from α = 1/k_0 on.
    """

    def __init__(self, layer: ElasticLayer):
        self.beta = beta = max(1.0, layer.thick_slope)
        top = math.log1p(beta * THINNEST)
        panels = math.ceil(top / 0.85) + 1

        def columns(u: Array) -> Array:
            return np.stack(layer.contact(np.minimum(np.expm1(u) / beta, THINNEST)), axis=1)

        by_radius = PiecewiseChebyshev(
            columns, np.linspace(0.0, top, panels), tolerance=3e-12, max_depth=2
        )
        grid = np.linspace(0.0, top, 2000)
        rising = np.log1p(np.expm1(grid) * np.sqrt(by_radius(grid)[:, 1]))

        def against_root(v: Array) -> Array:
            u = np.interp(v, rising, grid)
            for _ in range(5):
                Delta, slope, _ = by_radius.derivatives(u, (1,))[:, 0].T
                grown = np.expm1(u)
                gain = (grown + 1) * np.sqrt(Delta) + 0.5 * grown * slope / np.sqrt(Delta)
                u = np.clip(u + (np.expm1(v) - grown * np.sqrt(Delta)) / gain, 0.0, top)
            Phi, Delta, s = by_radius(u).T
            return np.stack([Phi / Delta**1.5, 1 / Delta, s / np.sqrt(Delta)], axis=1)

        self.table = PiecewiseChebyshev(
            against_root, np.linspace(0.0, rising[-1], panels), tolerance=3e-12, max_depth=3
        )
        self.top = float(np.expm1(rising[-1])) / beta
        self.thin = layer.thin_modulus
        end = self.table.derivatives(rising[-1:], (0, 1, 2))[0]
        load, area, stiffness = end[:, 0]
        above = load - 4 / 3 * self.thin
        rise = 2 * stiffness - 3 * load  # r d(load)/dr
        self.load_rest = 2 * above + rise, -above - rise
        slope = end[1, 1] * beta * self.top / (1 + beta * self.top)  # r d(area)/dr
        self.area_rest = area - 1, area - 1 + slope

    def __call__(self, root: Array) -> Array:
        out = self.table(np.log1p(self.beta * np.minimum(root, self.top)))
        thin = root > self.top
        if np.any(thin):
            # F/y^1.5 = limit + c/r + e/r², (a/t)²/y = 1 + (c + e ln r)/r, joined with slope
            q = self.top / root[thin]
            rest = self.load_rest + self.area_rest
            out[thin, 0], out[thin, 1] = formulas.coated_beyond(q, self.thin, *rest)
            c, e = self.load_rest
            out[thin, 2] = 2 * self.thin + c * q + 0.5 * e * q**2
        return out

    def pieces(self, count: int, terms: int) -> Array:
        """Powers of load and area on so many even pieces of ln(1 + βr): (count, 2 terms).

        The variable of a piece runs from −1 to 1.
        """
        x, transform = chebyshev_transform(terms)
        edges = np.linspace(0.0, self.table.edges[-1], count + 1)
        places = edges[:-1, None] + 0.5 * (1 + x) * np.diff(edges)[:, None]
        values = self.table(places.ravel())[:, :2].reshape(count, terms, 2)
        powers = np.stack([np.pad(p, (0, terms - len(p))) for p in map(cheb2poly, np.eye(terms))])
        series = np.einsum("ij,pjk->pki", powers.T @ transform, values)
        return series.reshape(count, 2 * terms)


@lru_cache(maxsize=64)
def table_of(layer: ElasticLayer) -> _Table:
    """The cached table of a set of materials."""
    return _Table(layer)
