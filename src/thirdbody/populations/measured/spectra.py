r"""Spectral moments of rough surfaces, and how heights on a grid give them.

.. math:: m_0 = \langle h^2\rangle, \qquad m_2 = \tfrac12\langle|\nabla h|^2\rangle, \qquad
          m_4 = \tfrac38\langle(\nabla^2 h)^2\rangle

These are means over all directions, so that α = m0 m4/m2² is at least 3/2 on every map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import InvalidValue, Mistake
from ...quantities.record import Column, TableRecord, Variable, column
from ...quantities.say import value_of
from ...quantities.value import Value, quantity
from ..heights import GaussianHeights, Heights, HistogramHeights
from ..roughness import Roughness

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    "Differences",
    "SpectralMoments",
    "Spectrum",
    "Summits",
    "count_summits",
    "differences",
    "gaussian_filtered",
    "laplacian",
    "skewness_and_kurtosis",
    "spectrum",
]

FEW_SUMMITS = 30
"""Summits that a distribution of heights takes."""
PRINCIPAL = Column("κ", "1/m", "principal curvature 1/R″, 1/R′")
DENSITIES = {
    2: Column("η", "1/m^2", "summits per area"),
    1: Column("η", "1/m", "peaks per length"),
}
"""Of summits on a map, and on a profile."""
SIGMA_OF_CUTOFF = math.sqrt(math.log(2) / 2) / math.pi
"""Standard deviation of the Gaussian filter over its cut-off, which it passes by one half."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpectralMoments(Value):
    r"""The profile moments of an isotropic surface, and the asperities that follow from them.

    .. math:: \alpha = \frac{m_0m_4}{m_2^2}, \quad
              \eta = \frac{m_4}{6\pi\sqrt3\,m_2}, \quad
              R = \frac38\sqrt{\frac{\pi}{m_4}}, \quad
              \sigma_s = \sqrt{m_0\left(1 - \frac{0.8968}{\alpha}\right)}, \quad
              y_s = 4\sqrt{\frac{m_0}{\pi\alpha}}

    m2 is the mean square slope of a profile, half of that of the gradient. The surface that is
    equivalent to two independent ones has the sum of their moments, at equal cut-offs: ``a + b``.

    Parameters
    ----------
    m0 : float
        Mean square height [m²].
    m2 : float
        Mean square slope of profiles [1].
    m4 : float
        Mean square second derivative of profiles [1/m²].

    References
    ----------
    Nayak 1971, J. Lubr. Technol. 93, 398, doi:10.1115/1.3451608; McCool 1986, Wear 107, 37,
    doi:10.1016/0043-1648(86)90045-1.

    Examples
    --------
    >>> import thirdbody as tb
    >>> m = tb.surfaces.SpectralMoments(m0=1e-14, m2=3.3e-3, m4=5.5e9)
    >>> round(m.alpha, 3), round(m.R * 1e6, 3), round(m.eta * 1e-10, 3)
    (5.051, 8.962, 5.105)
    >>> (m + m).sigma == 2**0.5 * m.sigma
    True
    """

    m0: float = quantity("m_0", "m^2", "mean square height", gt=0)
    m2: float = quantity("m_2", "1", "mean square slope of profiles", gt=0)
    m4: float = quantity("m_4", "1/m^2", "mean square second derivative of profiles", gt=0)

    def __add__(self, other: SpectralMoments) -> SpectralMoments:
        if not isinstance(other, SpectralMoments):
            return NotImplemented
        return SpectralMoments(m0=self.m0 + other.m0, m2=self.m2 + other.m2, m4=self.m4 + other.m4)

    @property
    def sigma(self) -> float:
        """RMS height σ [m]."""
        return math.sqrt(self.m0)

    @property
    def rms_gradient(self) -> float:
        """RMS of |∇h| [1], √2 times the slope of a profile."""
        return math.sqrt(2 * self.m2)

    @property
    def alpha(self) -> float:
        """Nayak's bandwidth α [1]."""
        return self.m0 * self.m4 / self.m2**2

    @property
    def eta(self) -> float:
        """Asperities per area η [1/m²]."""
        return self.m4 / (6 * math.pi * math.sqrt(3) * self.m2)

    @property
    def R(self) -> float:
        """Radius R of the mean curvature of asperity tips [m]."""
        return 0.375 * math.sqrt(math.pi / self.m4)

    @property
    def sigma_s(self) -> float:
        """Standard deviation of asperity heights σ_s [m], NaN where α is below 0.8968."""
        rest = 1 - 0.8968 / self.alpha
        return self.sigma * math.sqrt(rest) if rest >= 0 else math.nan

    @property
    def y_s(self) -> float:
        """Height of the mean asperity plane above the mean surface plane y_s [m]."""
        return 4 * self.sigma / math.sqrt(math.pi * self.alpha)

    def roughness(self, *, heights: Heights | None = None) -> Roughness:
        """The rough surface of a contact.

        Parameters
        ----------
        heights : Heights, optional
            Distribution of asperity heights over σ_s; Gaussian by default.

        Returns
        -------
        Roughness

        Raises
        ------
        InvalidValue
            α at or below 1.5, which no isotropic random surface has.

        Examples
        --------
        >>> import thirdbody as tb
        >>> tb.surfaces.SpectralMoments(m0=1e-14, m2=3.3e-3, m4=5.5e9).roughness().sigma
        1e-07
        """
        if self.alpha <= 1.5 * (1 + 1e-9):
            raise InvalidValue(
                f"the bandwidth m0 m4/m2² = {self.alpha:.4g} must be > 1.5, as it is of every "
                "isotropic random surface; the heights are a single wave, or hold a form that "
                'detrend = "curvature" would remove',
                code=Mistake.RANGE,
            )
        return Roughness(
            sigma=self.sigma,
            R=self.R,
            alpha=self.alpha,
            eta=self.eta,
            heights=heights or GaussianHeights(),
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Summits(TableRecord):
    """The summits counted on a map: points above their eight neighbours.

    On a profile they are peaks, points above their two neighbours, and `density` is per length.

    Parameters
    ----------
    heights : array (N,)
        Heights above the mean plane [m].
    curvatures : array (N,)
        Mean curvature −½∇²h at each [1/m].
    principal : array (N, 2)
        Larger and smaller principal curvature 1/R″ and 1/R′ at each [1/m], of a map; NaN on a
        profile.
    density : float
        Summits per area [1/m²], or peaks per length [1/m].
    dim : int
        2 for a map, 1 for a profile.
    cutoff : float
        Cut-off at which they were counted [m], 0 as sampled.

    Examples
    --------
    >>> from thirdbody.populations.measured.topography import from_topography
    >>> summits = from_topography("example").summits
    >>> len(summits.heights) == summits.count
    True
    """

    along = "summit"
    in_columns = ("principal_curvature",)
    heights: Array = column("z", "m", "height above the mean plane", repr=False)
    curvatures: Array = column("κ", "1/m", "mean curvature", repr=False)
    principal: Array = field(repr=False)
    density: float
    dim: int = column("", "", "2 for a map, 1 for a profile")
    cutoff: float = column("λ_c", "m", "cut-off at which they were counted, 0 as sampled")

    def variables(self) -> dict[str, Variable]:
        """Heights and curvatures along the summits, and the numbers of all."""
        dims = self.along, *self.in_columns
        return {
            **super().variables(),
            "principal": Variable(dims, self.principal, PRINCIPAL.labels),
            "density": Variable((), self.density, DENSITIES[self.dim].labels),
        }

    def coordinates(self) -> dict[str, Variable]:
        """Which of the two principal curvatures."""
        return {name: Variable((name,), ["larger", "smaller"]) for name in self.in_columns}

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.heights)

    @property
    def R(self) -> float:
        """One over the mean curvature [m]."""
        return float(1 / self.curvatures.mean()) if self.count else math.nan

    @property
    def sigma_s(self) -> float:
        """Standard deviation of the heights [m]."""
        return float(self.heights.std(ddof=1)) if self.count > 1 else math.nan

    @property
    def y_s(self) -> float:
        """Mean height above the mean plane [m]."""
        return float(self.heights.mean()) if self.count else math.nan

    def distribution(self) -> HistogramHeights:
        """Their heights, for a contact.

        Returns
        -------
        HistogramHeights
            Bins after Freedman and Diaconis.

        Raises
        ------
        InvalidValue
            A profile, whose peaks lie beside the summits, or fewer than 30 summits.

        Examples
        --------
        >>> from thirdbody.populations.measured.topography import from_topography
        >>> law = from_topography("example", cutoff=0.4e-6).summits.distribution()
        >>> sum(law.counts) == from_topography("example", cutoff=0.4e-6).summits.count
        True
        """
        if self.dim == 1:
            raise InvalidValue(
                "peaks of a profile are not summits of a surface: they lie lower and are more "
                "curved; use Gaussian heights, or measure a map",
                code=Mistake.BEYOND,
            )
        if self.count < FEW_SUMMITS:
            raise InvalidValue(
                f"{self.count} summits at a cut-off of {value_of(self.cutoff, 'm')} are too few "
                f"for a distribution of heights; it takes {FEW_SUMMITS}: use Gaussian heights, a "
                "shorter cut-off or a larger map",
                code=Mistake.BEYOND,
            )
        counts, edges = np.histogram(self.heights, bins="fd")
        return HistogramHeights(edges=tuple(edges), counts=tuple(counts))


# -------------------------------------------------------------------------- heights to numbers
class Differences(NamedTuple):
    """Mean products of slopes (dim, dim) [1], and the mean square of the Laplacian [1/m²]."""

    slopes: Array
    second: float


def differences(h: Array, spacing: tuple[float, ...], periodic: bool) -> Differences:
    """First and second differences of neighbouring points, where all their points are known."""
    if periodic:
        h = np.pad(h, 1, mode="wrap")
    if min(h.shape, default=0) < 3:
        return Differences(np.full((h.ndim, h.ndim), np.nan), math.nan)
    second = laplacian(h, spacing)
    corner = h[1:, 1:] if periodic and h.ndim == 2 else h[1:] if periodic else h
    if h.ndim == 1:
        slopes = [np.diff(corner) / spacing[0]]
    else:
        slopes = [
            np.diff(corner, axis=0)[:, :-1] / spacing[0],
            np.diff(corner, axis=1)[:-1] / spacing[1],
        ]
    if np.isnan(second).all():
        return Differences(np.full((h.ndim, h.ndim), np.nan), math.nan)
    products = np.array([[np.nanmean(a * b) for b in slopes] for a in slopes])
    return Differences(products, float(np.nanmean(second**2)))


def laplacian(h: Array, spacing: tuple[float, ...]) -> Array:
    """Second differences at the inner points."""
    if h.ndim == 1:
        return np.diff(h, 2) / spacing[0] ** 2
    d2x = np.diff(h, 2, axis=0)[:, 1:-1] / spacing[0] ** 2
    return d2x + np.diff(h, 2, axis=1)[1:-1] / spacing[1] ** 2


def count_summits(h: Array, spacing: tuple[float, ...], periodic: bool, cutoff: float) -> Summits:
    """Points above all their neighbours: eight on a map, two on a profile."""
    if periodic:
        h = np.pad(h, 1, mode="wrap")
    if min(h.shape) < 3:
        nothing = np.empty(0)
        return Summits(
            heights=nothing,
            curvatures=nothing,
            principal=np.empty((0, 2)),
            density=math.nan,
            dim=h.ndim,
            cutoff=cutoff,
        )
    inner = (slice(1, -1),) * h.ndim
    middle = h[inner]
    curvature = -laplacian(h, spacing) / h.ndim
    highest = np.ones(middle.shape, dtype=bool)
    has_datum = np.ones(middle.shape, dtype=bool)
    for shift in np.ndindex(*(3,) * h.ndim):
        if shift != (1,) * h.ndim:
            neighbour = h[tuple(slice(s, n - 2 + s) for s, n in zip(shift, h.shape, strict=True))]
            highest &= middle > neighbour
            has_datum &= np.isfinite(neighbour)
    has_datum &= np.isfinite(middle)
    area = has_datum.sum() * math.prod(spacing)
    return Summits(
        heights=middle[highest],
        curvatures=curvature[highest],
        principal=_principal(h, spacing, highest),
        density=float(highest.sum() / area) if area else math.nan,
        dim=h.ndim,
        cutoff=cutoff,
    )


def _principal(h: Array, spacing: tuple[float, ...], where: NDArray[np.bool_]) -> Array:
    """Larger and smaller curvature (N, 2) at chosen inner points, by second differences."""
    if h.ndim == 1:
        return np.full((int(where.sum()), 2), np.nan)
    dx, dy = spacing
    x, y = (i + 1 for i in np.nonzero(where))
    xx = -(h[x + 1, y] - 2 * h[x, y] + h[x - 1, y]) / dx**2
    yy = -(h[x, y + 1] - 2 * h[x, y] + h[x, y - 1]) / dy**2
    corners = h[x + 1, y + 1] - h[x + 1, y - 1] - h[x - 1, y + 1] + h[x - 1, y - 1]
    mean, half = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), corners / (4 * dx * dy))
    return np.stack([mean + half, mean - half], axis=1)


def skewness_and_kurtosis(h: Array) -> Array:
    """Skewness and kurtosis."""
    z = h - np.nanmean(h)
    var = np.nanmean(z**2)
    if not var > 0:
        return np.array([math.nan, math.nan])
    return np.array([np.nanmean(z**3) / var**1.5, np.nanmean(z**4) / var**2])


def gaussian_filtered(h: Array, spacing: tuple[float, ...], cutoff: float, periodic: bool) -> Array:
    """The Gaussian filter, its weight renewed at edges and around missing data (ISO 16610)."""
    widths = [SIGMA_OF_CUTOFF * cutoff / d for d in spacing]
    missing = np.isnan(h)
    if missing.any():
        weight = _blur(np.where(missing, 0.0, 1.0), widths, periodic)
        total = _blur(np.where(missing, 0.0, h), widths, periodic)
        return np.where(missing, np.nan, total / np.where(missing, 1.0, weight))
    total = _blur(h, widths, periodic)
    for axis, width in enumerate(widths):
        shape = [-1 if a == axis else 1 for a in range(h.ndim)]
        total /= _blur(np.ones(h.shape[axis]), [width], periodic).reshape(shape)
    return total


def _blur(z: Array, widths: list[float], periodic: bool) -> Array:
    """Convolution with a Gaussian along every axis; nothing lies beyond the edges."""
    from scipy.ndimage import gaussian_filter1d
    from scipy.signal import oaconvolve

    for axis, width in enumerate(widths):
        if width < 8 or periodic:
            mode = "wrap" if periodic else "constant"
            z = gaussian_filter1d(z, width, axis=axis, mode=mode, truncate=5.0)
        else:
            reach = min(int(5 * width + 0.5), z.shape[axis] - 1)
            kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
            kernel = (kernel / kernel.sum()).reshape(
                [-1 if a == axis else 1 for a in range(z.ndim)]
            )
            whole = oaconvolve(z, kernel, mode="full", axes=axis)
            inner = slice(reach, reach + z.shape[axis])
            z = whole[tuple(inner if a == axis else slice(None) for a in range(z.ndim))]
    return z


# -------------------------------------------------------------------------- the power spectrum
@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power P(q) [m²] of every wave with both signs of q counted, and q² [1/m²], flat."""

    q2: Array
    power: Array
    count: Array
    dim: int
    area: float
    longest: float
    """Largest |q| that all directions reach [1/m]."""

    def moments(self, cutoff: float) -> tuple[float, float, float]:
        passed = 2.0 ** (-2 * (cutoff / (2 * math.pi)) ** 2 * self.q2) if cutoff else 1.0
        power = self.power * passed
        share = (0.5, 0.375) if self.dim == 2 else (1.0, 1.0)
        second = power * self.q2
        return (
            float(power.sum()),
            share[0] * float(second.sum()),
            share[1] * float(second @ self.q2),
        )

    def rings(self) -> tuple[Array, Array, Array]:
        """Wavenumber, mean density and curvature power m4 in rings of a quarter of an octave."""
        lowest = math.sqrt(self.q2[self.q2 > 0].min())
        rings = max(int(4 * math.log2(self.longest / lowest)), 1)
        edges = self.longest * 2.0 ** (-np.arange(rings, -1, -1) / 4.0) * (1 + 1e-12)
        where = np.digitize(np.sqrt(self.q2), edges) - 1
        inside = (where >= 0) & (where < rings)

        def sum_over(values: Array) -> Array:
            return np.bincount(where[inside], values[inside], minlength=rings).astype(float)

        number = sum_over(self.count)
        full = number > 0
        q = np.sqrt(edges[1:] * edges[:-1])[full]
        density = sum_over(self.power)[full] / number[full] * self.area
        return q, density, sum_over(self.power * self.q2**2)[full]

    def radial(self) -> tuple[Array, Array]:
        q, density, _ = self.rings()
        return 2 * math.pi / q[::-1], density[::-1]

    def noise_below(self) -> float | None:
        """Wavelength below which the spectrum falls more slowly than q^(−dim), or None.

        Judged over octaves from the short end, up to the middle of the last flat one: where noise
        and a steep spectrum are equal. Waves that add less than 1 % to m4 are left out.
        """
        q, density, m4 = self.rings()
        if len(q) < 9 or not m4.sum() > 0:
            return None
        tail = np.cumsum(m4[::-1])[::-1] / m4.sum()
        last = int(np.flatnonzero(tail > 0.01)[-1])
        slow = last
        while slow >= 4 and density[slow - 4] < density[slow] * (q[slow] / q[slow - 4]) ** self.dim:
            slow -= 1
        if slow == last:
            return None
        return float(2 * math.pi / q[slow - 2 if slow >= 2 else 0])


def spectrum(h: Array, spacing: tuple[float, ...], periodic: bool) -> Spectrum:
    """The periodogram; heights that do not repeat are put under a Hann window."""
    h = fill_missing(h)
    if periodic:
        h = h - h.mean()
    else:
        window = np.ones_like(h)
        for axis, n in enumerate(h.shape):
            hann = 0.5 - 0.5 * np.cos(2 * math.pi * (np.arange(n) + 0.5) / n)
            window = window * hann.reshape([-1 if a == axis else 1 for a in range(h.ndim)])
        h = (h - (window * h).sum() / window.sum()) * window / math.sqrt(np.mean(window**2))
    power = np.abs(np.fft.rfftn(h)) ** 2 / h.size**2
    n = h.shape[-1]
    both = np.full(power.shape[-1], 2.0)
    both[0] = 1.0
    if n % 2 == 0:
        both[-1] = 1.0
    waves = [
        2 * math.pi * (np.fft.rfftfreq if axis == h.ndim - 1 else np.fft.fftfreq)(m, d)
        for axis, (m, d) in enumerate(zip(h.shape, spacing, strict=True))
    ]
    grids = np.meshgrid(*waves, indexing="ij", sparse=True)
    q2 = np.broadcast_to(np.asarray(sum(g**2 for g in grids)), power.shape)
    return Spectrum(
        q2=q2.ravel(),
        power=(power * both).ravel(),
        count=np.broadcast_to(both, power.shape).ravel(),
        dim=h.ndim,
        area=math.prod(m * d for m, d in zip(h.shape, spacing, strict=True)),
        longest=math.pi / max(spacing),
    )


def fill_missing(h: Array) -> Array:
    """Missing data replaced by the harmonic function that fits their edge."""
    missing = np.isnan(h)
    if not missing.any():
        return h
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import cg

    number = np.full(h.shape, -1)
    number[missing] = np.arange(missing.sum())
    size = int(missing.sum())
    diagonal, right = np.zeros(size), np.zeros(size)
    rows, columns = [], []
    for axis in range(h.ndim):
        for here, there in ((slice(1, None), slice(None, -1)), (slice(None, -1), slice(1, None))):
            a = tuple(here if k == axis else slice(None) for k in range(h.ndim))
            b = tuple(there if k == axis else slice(None) for k in range(h.ndim))
            mine, other, value = number[a], number[b], h[b]
            inside = mine >= 0
            np.add.at(diagonal, mine[inside], 1.0)
            edge = inside & (other < 0)
            np.add.at(right, mine[edge], value[edge])
            pair = inside & (other >= 0)
            rows.append(mine[pair])
            columns.append(other[pair])
    row, column = np.concatenate(rows), np.concatenate(columns)
    scale = 1 / np.sqrt(diagonal)
    entries = np.concatenate([np.ones(size), -(scale[row] * scale[column])])
    index = np.arange(size)
    where = (np.concatenate([index, row]), np.concatenate([index, column]))
    solved, _ = cg(
        coo_array((entries, where), shape=(size, size)).tocsr(), scale * right, rtol=1e-6
    )
    out = h.copy()
    out[missing] = scale * solved
    return out
