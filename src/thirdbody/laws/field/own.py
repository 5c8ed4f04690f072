r"""The field of a surface by its own spectrum: a measured map, or a map that repeats itself.

The waves of a map are taken ring by ring, :math:`w(q) = \sum_{|q|}|\hat z|^2`, and what the table
holds for the library's spectrum is solved for them: some tenths of a second for each hardness.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.special import ndtr, ndtri

from ...errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ...populations.measured.spectra import fill_missing
from ...quantities.say import percent
from ...quantities.value import Value, choice, quantity
from .programme import TERMS, Edges, Pressed, solve_programme
from .spectrum import FARTHEST, HURST, STRAIGHT, Spectrum, rolled_off
from .table import (
    EDGE,
    HARD,
    PLASTIC,
    SOFT,
    TAU,
    FieldSurface,
    field_of,
    plastic_energy,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.measured.surface import Topography

    Array = NDArray[np.float64]

__all__ = ["OwnSpectrum", "RollOff", "own_field"]

RINGS, BINS = 40, 260
"""Rings of the longest waves that are kept apart, and bins of the others."""
LOW = np.array([-1.0, -0.7, -0.4, -0.1])
HIGH = np.array([0.2, 0.4, 0.65, 0.95, 1.3, 1.65, 2.0, 2.4, 2.8, 3.3, 3.8, 4.4, 5.0])
MISSING = 0.01
"""Part of the points of a map that may be missing."""
DENSE = np.arange(0.2, 5.01, 0.15)
"""Separations of tables: low ones, others, and those of heights that are not Gaussian."""
SKEWED, PEAKED = 0.1, 0.3
"""|skewness| and |excess kurtosis| from which heights are not taken for Gaussian."""
PARTS = (0.0, 0.25, 0.5, 0.75, 0.9, 1.0)
"""Steps from Gaussian heights to those of a map."""
MOST_SKEWED, MOST_PEAKED, MOST_HEIGHTS = 1.3, 4.0, 6
"""Those beyond which they are refused, and the most G_n."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnSpectrum(Value):
    """Waves of a rough surface, for `thirdbody.asperity.Field`.

    Parameters
    ----------
    q : tuple of float
        Wavenumbers |q| [1/m], increasing.
    weight : tuple of float
        Share of each in the variance of heights [1].
    box : float, optional
        Side after which the surface repeats itself [m], where it is pressed as such; 0 for a
        sample of a surface that goes on.
    heights : tuple of float, optional
        G_n from n = 1 of heights z/σ = Σ G_n He_n(t)/√n! on a Gaussian field t, whose waves the
        others then are [1]; ΣG_n² = 1.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=300e-9, R=3e-6))
    >>> from thirdbody.explicit import surface_of
    >>> own = tb.asperity.OwnSpectrum.of(surface_of(contact, size=128, spacing=200e-9), box=True)
    >>> 4 < own.spectrum.alpha < 6
    True
    """

    q: tuple[float, ...]
    weight: tuple[float, ...]
    box: float = 0.0
    heights: tuple[float, ...] = (1.0,)

    def _problems(self) -> list[str]:
        if len(self.q) != len(self.weight) or len(self.q) < 8:
            return [
                Problem("q", "and weight must be as many numbers, 8 at least", code=Mistake.SHAPE)
            ]
        if not (all(a < b for a, b in zip(self.q, self.q[1:], strict=False)) and self.q[0] > 0):
            return [Problem("q", "must be increasing numbers above 0 [1/m]", code=Mistake.ORDER)]
        if not (min(self.weight) >= 0 and sum(self.weight) > 0):
            return [Problem("weight", "must be numbers from 0, not all 0", code=Mistake.KIND)]
        if not self.heights or abs(sum(G * G for G in self.heights) - 1) > 1e-6:
            return [
                Problem("heights", "must be numbers G_n whose squares sum to 1", code=Mistake.RANGE)
            ]
        if not 0 <= self.box < math.inf:
            return [
                Problem("box", "must be a length from 0 [m]", repr(self.box), code=Mistake.RANGE)
            ]
        return []

    @classmethod
    def of(
        cls, surface: Topography, *, cutoff: float | None = None, box: bool = False
    ) -> OwnSpectrum:
        """The waves of a map.

        Parameters
        ----------
        surface : Topography
            A map, with heights that are nearly Gaussian.
        cutoff : float, optional
            As in `Topography.roughness`; the same must be given to both.
        box : bool, optional
            Of a map that repeats itself: press it as such, without its surroundings. Its heights
            are taken for a draw of Gaussian ones, however few waves it has.

        Raises
        ------
        InvalidValue
            A profile, more than 1 % of missing points (fewer are filled harmonically), or heights
            too far from Gaussian: skewness beyond ±1.3, excess kurtosis beyond 4.

        Notes
        -----
        Heights of a skewness beyond ±0.1 or an excess kurtosis beyond ±0.3 are ranked: t is the
        Gaussian field in the same order, and its waves are kept, with the polynomial z(t).
        """
        if surface.dim != 2:
            raise InvalidValue(
                "a profile does not tell the waves of a surface: measure a map", code=Mistake.BEYOND
            )
        z = np.array(surface.filtered(cutoff), dtype=float)
        missing = float(np.mean(~np.isfinite(z)))
        if missing > MISSING:
            raise InvalidValue(
                f"{percent(missing, digits=2)} of the points of the map are missing (up to "
                f"{percent(MISSING, digits=1)}), so that its waves are not known; crop it",
                code=Mistake.BEYOND,
            )
        z = fill_missing(z)
        t = (z - z.mean()) / z.std()
        skewness, excess = float(np.mean(t**3)), float(np.mean(t**4) - 3)
        G: tuple[float, ...] = (1.0,)
        if not box and (abs(skewness) > SKEWED or abs(excess) > PEAKED):
            t, G = _rank_heights(t, skewness, excess)
        if not surface.periodic:
            window = [np.hanning(n + 2)[1:-1] for n in t.shape]
            t = t * np.multiply.outer(*window)
        power = np.abs(np.fft.fft2(t)) ** 2
        sides = [
            2 * math.pi * np.fft.fftfreq(n, d)
            for n, d in zip(t.shape, surface.spacing, strict=True)
        ]
        q = np.hypot(sides[0][:, None], sides[1])
        q, weight = _rings(q.ravel()[1:], power.ravel()[1:])
        side = min(n * d for n, d in zip(t.shape, surface.spacing, strict=True))
        waves = {"q": tuple(q.tolist()), "weight": tuple(weight.tolist())}
        return cls(**waves, box=side if box else 0.0, heights=G)

    @classmethod
    def of_both(cls, first: Topography, second: Topography) -> OwnSpectrum:
        """Waves of two faces together, whose heights are independent."""
        faces = [
            (cls._gaussian(face), float(np.nanstd(np.array(face.filtered(None), dtype=float))))
            for face in (first, second)
        ]
        waves = sorted(
            (q, weight * sigma**2) for spectrum, sigma in faces for q, weight in zip(
                spectrum.q, spectrum.weight, strict=True)
        )  # fmt: skip
        merged: dict[float, float] = {}
        for q, weight in waves:
            merged[q] = merged.get(q, 0.0) + weight
        total = sum(merged.values())
        return cls(q=tuple(merged), weight=tuple(w / total for w in merged.values()))

    @classmethod
    def _gaussian(cls, surface: Topography) -> OwnSpectrum:
        spectrum = cls.of(surface)
        if len(spectrum.heights) > 1:
            raise InvalidValue(
                "the heights of one of two faces are not Gaussian, and those of both together are "
                "not known; give one face, or leave the spectrum out",
                code=Mistake.CLASH,
            )
        return spectrum

    @property
    def spectrum(self) -> Spectrum:
        """In the units of the theory: ⟨q²⟩ = 2."""
        return _spectrum(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class RollOff(Value):
    r"""A spectrum that is flat for long waves and falls from a corner, to the α of the roughness.

    .. math:: C(q) \propto \left[1 + (q/q_r)^2\right]^{-1-H}, \qquad q \le q_s

    Parameters
    ----------
    hurst : float, optional
        Hurst exponent H [1]; surfaces that the library draws have 0.8.
    corner : {"smooth", "sharp"}, optional
        As above; or flat up to q_r and a power law from there.

    Notes
    -----
    The book's page "Choose an asperity law" says how uncertain a result is where σ, R and α are
    known and the spectrum is not.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.asperity.RollOff(hurst=0.5).spectrum_of(5.0).alpha.__round__(6)
    5.0
    """

    hurst: float = quantity("H", "1", "Hurst exponent", default=HURST, gt=0, le=1)
    corner: Literal["smooth", "sharp"] = choice("corner of the spectrum", default="smooth")

    def spectrum_of(self, alpha: float) -> Spectrum:
        """The spectrum in the units of the theory, ⟨q²⟩ = 2.

        Parameters
        ----------
        alpha : float
            Nayak's bandwidth α [1].
        """
        return rolled_off(alpha, self.hurst, self.corner)


def _rank_heights(z: Array, skewness: float, excess: float) -> tuple[Array, tuple[float, ...]]:
    """Gaussian field that has the order of these heights, and the G_n that map it back to them.

    As many terms as leave z(t) rising wherever points lie.
    """
    if abs(skewness) > MOST_SKEWED or excess > MOST_PEAKED:
        raise InvalidValue(
            f"heights of skewness {skewness:.2g} and excess kurtosis {excess:.2g} are too far from "
            f"Gaussian (up to {MOST_SKEWED:g} and {MOST_PEAKED:g}) for the law field; use a sum "
            "over summits with the measured heights",
            code=Mistake.BEYOND,
        )
    order = np.argsort(z, axis=None, kind="stable")
    t = np.empty(z.size)
    t[order] = ndtri((np.arange(z.size) + 0.5) / z.size)
    he = [np.ones(z.size), t]
    for n in range(1, MOST_HEIGHTS):
        he.append((t * he[n] - math.sqrt(n) * he[n - 1]) / math.sqrt(n + 1))
    G = np.array([np.mean(z.ravel() * polynomial) for polynomial in he[1:]])
    grid = np.linspace(-STRAIGHT, STRAIGHT, 161)
    for count in range(MOST_HEIGHTS, 0, -1):
        some = tuple((G[:count] / math.sqrt(float(G[:count] @ G[:count]))).tolist())
        shape = Spectrum(q=np.ones(1), weight=np.ones(1), heights=some)
        if np.all(np.diff(shape.height(grid)) > 0):
            break
    return t.reshape(z.shape), some


def _rings(q: Array, power: Array) -> tuple[Array, Array]:
    """Wavenumbers and shares of rings of waves, the longest ones each by itself."""
    near = np.unique(np.round(q, 9 - math.floor(math.log10(q.min()))))
    edges = near[: RINGS + 1]
    edges = np.concatenate([0.5 * (edges[1:] + edges[:-1]), np.linspace(edges[-1], q.max(), BINS)])
    which = np.searchsorted(np.unique(edges), q)
    total = np.bincount(which, power)
    some = total > 1e-14 * total.sum()
    mean = np.bincount(which, power * q)[some] / total[some]
    return mean, total[some] / total.sum()


@lru_cache(maxsize=32)
def _spectrum(waves: OwnSpectrum) -> Spectrum:
    q, weight = np.array(waves.q), np.array(waves.weight)
    weight = weight / weight.sum()
    unit = math.sqrt(2 / float(weight @ q**2))
    farthest = min(FARTHEST, math.pi / (q[0] * unit))
    return Spectrum(
        q=q * unit, weight=weight, farthest=farthest, box=waves.box / unit, heights=waves.heights
    )


def _follow_programme(spectrum: Spectrum, h: Array, t: Array, chi: float, edges: Edges) -> Pressed:
    """The programme at h; where it is not found at once, from Gaussian heights step by step."""
    try:
        return solve_programme(spectrum.series(TERMS), h, chi, edges)
    except NoEquilibrium:
        if len(spectrum.heights) == 1:
            raise
    G = np.array(spectrum.heights)
    first = np.zeros_like(G)
    first[0] = 1.0
    for share in PARTS:
        mixed = share * G + (1 - share) * first
        mixed /= math.sqrt(float(mixed @ mixed))
        nearer = replace(spectrum, heights=tuple(mixed.tolist()))
        place = nearer.height(t) if share < 1 else h
        pressed = solve_programme(nearer.series(TERMS), place, chi, edges)
        edges = pressed.edges._replace(elastic=np.zeros(len(h), bool))
    return pressed


@lru_cache(maxsize=64)
def own_field(waves: OwnSpectrum | RollOff | None, chi: float, alpha: float) -> FieldSurface:
    """The surface of these waves at χ, solved; of a roll-off by α, that of None from the table.

    Raises
    ------
    InvalidValue
        α outside that of the table, from which the solution starts.
    """
    if waves is None or waves == RollOff():
        return field_of(chi, alpha)
    spectrum = waves.spectrum_of(alpha) if isinstance(waves, RollOff) else waves.spectrum
    alpha = spectrum.alpha
    start = field_of(chi, alpha)
    high = HIGH if len(spectrum.heights) == 1 else DENSE
    h = np.concatenate([LOW, high]) if chi <= SOFT else high
    h = h[h >= (start.lowest if chi <= SOFT else HARD)]
    grid = np.linspace(-8.0, 8.0, 1601)
    t = np.interp(h, spectrum.height(grid), grid)  # the Gaussian height of that height
    if len(spectrum.heights) > 1:  # no point of a map lies higher
        h, t = h[t < STRAIGHT], t[t < STRAIGHT]
        slope = (spectrum.height(t + 1e-4) - spectrum.height(t - 1e-4)) / 2e-4
        chis = np.clip(chi * spectrum.steeper / slope, 1e-3, 1e2)  # χ by the slopes up there
        near = [(x, field_of(y, alpha)) for x, y in zip(t.tolist(), chis.tolist(), strict=True)]
        start_columns = np.concatenate([f.columns(np.array([max(x, f.lowest)])) for x, f in near])
    else:
        start_columns = start.columns(h)
    low = t + start_columns[:, EDGE]
    share = np.clip(start_columns[:, PLASTIC], 1e-12, 1 - 1e-6)
    high = -ndtri(share * ndtr(-low))
    width = np.log(np.maximum(high - low, 1e-3))
    edges = Edges(low, width, np.clip(start_columns[:, TAU], 0.0, 1.0), np.zeros(len(h), bool))
    pressed = _follow_programme(spectrum, h, t, chi, edges)
    rows = np.column_stack(
        [
            np.log(pressed.energy / plastic_energy(h, chi)),
            pressed.low - h,
            pressed.plastic,
            pressed.edges.tau,
            pressed.moments[:, 1:] / pressed.moments[:, :1],
        ]
    )
    return FieldSurface(chi=chi, alpha=alpha, h=h, rows=rows, spectrum=spectrum)
