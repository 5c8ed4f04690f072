"""The table of the law of one field, and what a contact takes from it.

Stored are solutions of `thirdbody.laws.field.programme` for surfaces of the library's spectrum,
made by ``benchmarks/field_table.py``; or those of one measured surface.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import erfcx, ndtr

from ...errors import InvalidValue, Mistake
from .conduction import TERMS, lone_stiffness, patch_stiffness
from .programme import MOMENTS
from .reduced import mean_pressure
from .spectrum import Spectrum, rolled_off

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.interpolate import BSpline

    Array = NDArray[np.float64]

__all__ = [
    "ALPHAS",
    "FieldSurface",
    "bearing",
    "field_of",
    "plastic_energy",
    "rows_of",
    "separations",
]

ALPHAS = (2.5, 30.0)
"""Bandwidths of the table."""
LEAST, MOST = 0.01, 3.0
"""χ of the table: below, differences from the plastic surface fall like χ; above, no surface of
the table yields where it weighs."""
SOFT = 0.4
"""χ up to which separations below `HARD` are known."""
HARD = 0.2
"""Lowest separation over σ at any χ: what is stiff then is nearly flat."""
LOW, EDGE, PLASTIC, TAU, FIRST = range(5)
"""Columns: ln Φ over that of the plastic surface, s_0 − h, plastic share, τ, a_n/a_0 from n = 1."""
COLUMNS = FIRST + MOMENTS


def bearing(h: Array) -> Array:
    """Q(h), the part of a Gaussian surface above h: (N,)."""
    return ndtr(-h)


def normal(h: Array) -> Array:
    """φ(h), the density of heights: (N,)."""
    return np.exp(-0.5 * h * h) / math.sqrt(2 * math.pi)


def plastic_energy(h: Array, chi: float) -> Array:
    """Φ where stiffness is no hindrance, χ[φ(h) − hQ(h)]: (N,)."""
    density = np.exp(-0.5 * h * h) / math.sqrt(2 * math.pi)
    with np.errstate(over="ignore", invalid="ignore"):
        mills = math.sqrt(0.5 * math.pi) * erfcx(h / math.sqrt(2))
        near = density * (1 - h * mills)
    # far away 1 − hM is a difference of nearly equal numbers
    far = density / np.maximum(h * h, 1.0)
    far = far * (1 - 3 / np.maximum(h * h, 1.0) + 15 / np.maximum(h, 1.0) ** 4)
    return chi * np.where(h > 30, far, np.where(h < -5, density - h * ndtr(-h), near))


def plastic_rows(h: Array) -> Array:
    """The columns of a plastic surface: (N, COLUMNS)."""
    density = np.exp(-0.5 * h * h) / math.sqrt(2 * math.pi)
    out = np.zeros((len(h), COLUMNS))
    out[:, PLASTIC] = 1.0
    # ∫_h^∞ he_n φ = he_{n−1}(h) φ(h)/√n
    before, now = np.zeros_like(h), np.ones_like(h)
    for n in range(1, MOMENTS + 1):
        out[:, FIRST + n - 1] = now * density / (math.sqrt(n) * ndtr(-h))
        before, now = now, (h * now - math.sqrt(n - 1) * before) / math.sqrt(n)
    return out


@lru_cache(maxsize=1)
def stored_table() -> dict[str, Array]:
    """The table that ships: h, chi, alpha and rows (α, χ, h, columns)."""
    file = resources.files("thirdbody").joinpath("data/field.npz")
    with resources.as_file(file) as path, np.load(path) as data:
        return {name: data[name] for name in ("h", "chi", "alpha", "rows")}


@dataclass(frozen=True, eq=False, kw_only=True)
class FieldSurface:
    """Table of a surface of one spectrum and hardness ratio, at every separation.

    Lengths across the surface are over σ, along it over √(m0/m2); pressures over E*g, with the RMS
    gradient g.

    Parameters
    ----------
    chi, alpha : float
        H/(E*g) and Nayak's bandwidth [1].
    h : array (M,)
        Separations of the table.
    rows : array (M, COLUMNS)
        As in `LOW` … `FIRST`.
    spectrum : Spectrum
        From which the ground of particles comes.
    """

    chi: float
    alpha: float
    h: Array
    rows: Array
    spectrum: Spectrum

    @property
    def lowest(self) -> float:
        """Separation over σ below which nothing is known."""
        return float(self.h[0])

    @cached_property
    def _logs(self) -> list[BSpline]:
        """The first column with its derivatives, by itself: what a load needs."""
        from scipy.interpolate import make_interp_spline

        spline = make_interp_spline(self.h, self.rows[:, LOW], k=5)
        return [spline, *(spline.derivative(n) for n in (1, 2, 3))]

    def _log(self, h: Array) -> list[Array]:
        """ln Φ over that of the plastic surface with three derivatives: four arrays (N,)."""
        if np.any((h > self.h[-1]) | (h < self.lowest)):
            return [self.columns(h, n)[:, LOW] for n in range(4)]
        return [spline(h) for spline in self._logs]

    @cached_property
    def _series(self) -> tuple[BSpline, Array]:
        """Splines of every column, and their first two terms in 1 − h_M/h beyond the last."""
        from scipy.interpolate import make_interp_spline

        spline = make_interp_spline(self.h, self.rows, k=5)
        end = self.h[-1:]
        value, slope, bend = (spline(end, nu)[0] for nu in range(3))
        # u = 1 − h_M/h has the slope 1/h_M and the bend −2/h_M² there
        last = float(end[0])
        first = slope * last
        second = 0.5 * (bend * last**2 + 2 * first)
        second[1:] = 0.0
        return spline, np.stack([value, first, second])

    def columns(self, h: Array, derivative: int = 0) -> Array:
        """Every column, or a derivative of it with respect to h: (N, COLUMNS)."""
        spline, (value, first, second) = self._series
        out = np.asarray(spline(h, derivative))
        if np.any(beyond := h > self.h[-1]):
            far, last = h[beyond, None], float(self.h[-1])
            u = 1 - last / far
            du = (last / far**2, -2 * last / far**3, 6 * last / far**4)
            if derivative == 0:
                out[beyond] = value + first * u + second * u * u
            elif derivative == 1:
                out[beyond] = (first + 2 * second * u) * du[0]
            elif derivative == 2:
                out[beyond] = (first + 2 * second * u) * du[1] + 2 * second * du[0] ** 2
            else:
                out[beyond] = (first + 2 * second * u) * du[2] + 6 * second * du[0] * du[1]
        out[h < self.lowest] = np.nan
        return out

    def load(self, h: Array) -> Array:
        """⟨f⟩ = −dΦ/dh with its first and second derivative: (N, 3)."""
        y = self._log(h)
        density = np.exp(-0.5 * h * h) / math.sqrt(2 * math.pi)
        # Φ = P e^y with P of the plastic surface
        P = plastic_energy(h, self.chi)
        P1, P2, P3 = -self.chi * ndtr(-h), self.chi * density, -self.chi * h * density
        e = np.exp(y[0])
        first = mean_pressure(y[0], y[1], P, -P1)
        second = P2 + 2 * P1 * y[1] + P * (y[2] + y[1] ** 2)
        third = P3 + 3 * P2 * y[1] + 3 * P1 * (y[2] + y[1] ** 2)
        third = third + P * (y[3] + 3 * y[1] * y[2] + y[1] ** 3)
        return np.stack([first, -e * second, -e * third], axis=-1)

    @cached_property
    def _stiffness(self) -> BSpline:
        """ln of κ over the bearing area at the separations of the table."""
        from scipy.interpolate import make_interp_spline

        stiff = self._patches(self.rows)
        return make_interp_spline(self.h, np.log(stiff / ndtr(-self.h)), k=5)

    def _patches(self, columns: Array) -> Array:
        return patch_stiffness(
            self.spectrum.series(TERMS),
            self.h + columns[:, EDGE],
            np.clip(columns[:, TAU], 0.0, 1.0),
        )

    def _stiffness_beyond(self, h: Array) -> Array:
        """κ beyond the table: what ln κ is above that of lone round patches falls like 1/h²."""
        last = self.h[-1:]
        above = np.exp(self._stiffness(last)) * ndtr(-last) / self._lone(last)
        return np.asarray(self._lone(h) * above ** (last / h) ** 2)

    def _lone(self, h: Array) -> Array:
        return lone_stiffness(h + self.columns(h)[:, EDGE])

    def stiffness(self, h: Array) -> Array:
        """κ = Kσ/(E*g), the stiffness of the patches that touch, not less: (N,).

        Beyond the table, where they cover less than 3e-7 of the area, to 2.5 %.
        """
        inside = np.clip(h, self.lowest, self.h[-1])
        out = np.exp(self._stiffness(inside)) * ndtr(-inside)
        if np.any(beyond := h > self.h[-1]):
            out[beyond] = self._stiffness_beyond(h[beyond])
        out[h < self.lowest] = np.nan
        return out

    def energy(self, h: Array) -> Array:
        """Φ: (N,)."""
        return plastic_energy(h, self.chi) * np.exp(self.columns(h)[:, LOW])


@lru_cache(maxsize=256)
def field_of(chi: float, alpha: float) -> FieldSurface:
    """The surface of the library's spectrum at χ and α, from the table that ships.

    Raises
    ------
    InvalidValue
        α outside the table.
    """
    low, high = ALPHAS
    if not low <= alpha <= high:
        raise InvalidValue(
            f"asperity_law field: the bandwidth alpha = {alpha:.4g} must be from {low:g} to "
            f"{high:g}, as far as its table goes; use another law",
            code=Mistake.BEYOND,
        )
    soft = chi <= SOFT
    rows = rows_of(np.array([chi]), np.array([alpha]), soft=soft)[0]
    spectrum = rolled_off(alpha)
    return FieldSurface(chi=chi, alpha=alpha, h=separations(soft), rows=rows, spectrum=spectrum)


def separations(soft: bool) -> Array:
    """Separations of the table for χ up to `SOFT`, or beyond: (M,)."""
    h = stored_table()["h"]
    return h if soft else h[h >= HARD]


@lru_cache(maxsize=2)
def _along_chi(soft: bool) -> tuple[Array, Array]:
    """Knots, and coefficients (α, χ, h, columns), of cubic splines over ln χ."""
    from scipy.interpolate import make_interp_spline

    data = stored_table()
    some = np.isin(data["h"], separations(soft))
    most = data["chi"] <= 1.3 * SOFT if soft else data["chi"] > 0
    spline = make_interp_spline(
        np.log(data["chi"][most]), data["rows"][:, most][:, :, some], k=3, axis=1
    )
    return spline.t, np.moveaxis(spline.c, 0, 1)


AT_ONCE = 512
"""Surfaces whose numbers stay in the cache of a processor."""


def rows_of(chi: Array, alpha: Array, *, soft: bool, columns: slice = slice(None)) -> Array:
    """The table at χ and α (N,), all of them on one side of `SOFT`: (N, M, columns)."""
    from scipy.interpolate import BSpline

    h = separations(soft)
    knots, coefficients = _along_chi(soft)
    every = np.ascontiguousarray(coefficients[..., columns])
    size = every.shape[2:]
    every = every.reshape(*every.shape[:2], -1)
    inside = np.log(np.clip(chi, LEAST, MOST))
    basis = BSpline.design_matrix(inside, knots, 3)
    place, weights = basis.indices.reshape(-1, 4), basis.data.reshape(-1, 4)
    across = _lagrange(np.log(stored_table()["alpha"]), np.log(alpha))
    # number by number and not by products of matrices, whose last digit hangs on their size
    rows = np.empty((len(chi), every.shape[2]))
    for begin in range(0, len(chi), AT_ONCE):
        here = slice(begin, begin + AT_ONCE)
        total = np.zeros((len(place[here]), every.shape[2]))
        for of_alpha, weight in zip(every, across[here].T, strict=True):
            for near, value in zip(place[here].T, weights[here].T, strict=True):
                total += (weight * value)[:, None] * of_alpha[near]
        rows[here] = total
    rows = rows.reshape(len(chi), *size)
    plain = plastic_rows(h)[:, columns]
    rows = plain + (rows - plain) * np.minimum(chi / LEAST, 1.0)[:, None, None]
    kept = np.arange(COLUMNS)[columns].tolist()
    if LOW in kept:  # Φ itself no longer changes
        rows[:, :, kept.index(LOW)] -= np.log(np.maximum(chi / MOST, 1.0))[:, None]
    for column in (PLASTIC, TAU):
        if column in kept:
            rows[:, :, kept.index(column)] = np.clip(rows[:, :, kept.index(column)], 0.0, 1.0)
    return rows


def _lagrange(nodes: Array, x: Array) -> Array:
    """Weights of the polynomials through Chebyshev's points with both ends at x (N,): (N, M)."""
    off = x[:, None] - nodes
    hit = np.abs(off) < 1e-14
    weight = (-1.0) ** np.arange(len(nodes))
    weight[[0, -1]] *= 0.5
    weight = weight / np.where(hit, 1.0, off)
    weight = np.where(np.any(hit, axis=1, keepdims=True), hit, weight)
    return weight / weight.sum(axis=1)[:, None]
