r"""Asperity height distributions: zero mean, unit variance, in units of σ_s.

.. math:: F(d) = \eta\int F_1(\omega)\,\phi\!\left(\frac{d+\omega}{\sigma_s}\right)
          \frac{d\omega}{\sigma_s}

A height distribution here is that of the *asperities*. Using the skewness of a measured surface
for its asperities is common and an approximation.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from scipy import special

from ..errors import InvalidValue, Mistake, Problem
from ..numerics.quadrature import panel_rule
from ..quantities.named import Named
from ..quantities.value import quantity, sequences, several

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "ExponentialHeights",
    "GaussianHeights",
    "Heights",
    "HistogramHeights",
    "JohnsonHeights",
    "WeibullHeights",
]

NEGLIGIBLE = 85.0
"""Exponent beyond which a tail (1e-37) is left out."""
COMPLETE = 45.0
"""Exponent up to which what is left out does not show (1e-17)."""
SHARPEST = 0.08
"""Least δ of a Johnson curve that is tried: below it more than 1e-3 of the heights lie within
rounding of an end."""
ASKED = 1e-8
"""Relative error of the moments of Johnson heights that is accepted."""


class Heights(Named):
    """What every height distribution can do.

    Heights z are those of asperities over σ_s, with zero mean and unit variance. A distribution of
    your own gives the abstract methods below.

    Examples
    --------
    >>> import thirdbody as tb
    >>> heights = tb.heights.ExponentialHeights()
    >>> float(heights.pieces[0]), round(float(heights.pdf(0.0)), 6)
    (-1.0, 0.367879)
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Any]]] = {}

    @property
    @abstractmethod
    def pieces(self) -> tuple[float, ...]:
        """Increasing heights z between which the density is smooth, from end to end."""

    @property
    def kinks(self) -> tuple[float, ...]:
        """Heights z where the density is not smooth."""
        return ()

    @property
    def highest(self) -> float:
        """The upper end of the support, or the height up to which a cut tail is complete."""
        return self.pieces[-1]

    @abstractmethod
    def pdf(self, z: ArrayLike) -> Array:
        """Density φ(z) [1], zero outside the support.

        Parameters
        ----------
        z : float or array
            Heights over σ_s [1].
        """

    @abstractmethod
    def ppf(self, q: ArrayLike) -> Array:
        """Height below which a fraction q of the asperities lies."""

    def sf(self, z: ArrayLike) -> Array:
        """Fraction of the asperities above a height.

        Parameters
        ----------
        z : float or array
            Heights over σ_s [1].
        """
        z = np.asarray(z, dtype=float)
        edges = np.clip(np.array(self.pieces), z[..., None], None)
        nodes, weights = panel_rule(edges, 24)
        return np.sum(weights * self.pdf(nodes), axis=-1)

    def isf(self, q: ArrayLike) -> Array:
        """Height above which a fraction q of the asperities lies."""
        return self.ppf(1 - np.asarray(q, dtype=float))

    def sample(self, rng: np.random.Generator, size: int | tuple[int, ...]) -> Array:
        """Random heights in units of σ_s."""
        return self.ppf(rng.random(size))


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianHeights(Heights):
    """φ(z) = exp(−z²/2)/√(2π), the default.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.heights.GaussianHeights().pdf(0.0)), 6)
    0.398942
    """

    name = "gaussian"

    @property
    def pieces(self) -> tuple[float, ...]:
        return tuple(np.arange(-13.5, 14, 1.5))

    def pdf(self, z: ArrayLike) -> Array:
        z = np.asarray(z, dtype=float)
        return np.exp(-0.5 * z * z) / math.sqrt(2 * math.pi)

    def ppf(self, q: ArrayLike) -> Array:
        return special.ndtri(np.asarray(q, dtype=float))

    def sf(self, z: ArrayLike) -> Array:
        return special.ndtr(-np.asarray(z, dtype=float))

    def isf(self, q: ArrayLike) -> Array:
        return -special.ndtri(np.asarray(q, dtype=float))


@dataclass(frozen=True, slots=True, kw_only=True)
class ExponentialHeights(Heights):
    """φ(z) = exp(−(z + 1)) for z > −1.

    While d ≥ −σ_s every sum without adhesion is proportional to exp(−d/σ_s), and the mean
    pressure does not depend on the load. Other texts shift the origin by one σ_s, a factor e.

    Examples
    --------
    >>> import thirdbody as tb
    >>> float(tb.heights.ExponentialHeights().pdf(-1.5))
    0.0
    """

    name = "exponential"

    @property
    def pieces(self) -> tuple[float, ...]:
        return tuple(np.linspace(-1.0, NEGLIGIBLE - 1, 18))

    @property
    def kinks(self) -> tuple[float, ...]:
        return (-1.0,)

    @property
    def highest(self) -> float:
        return COMPLETE - 1

    def pdf(self, z: ArrayLike) -> Array:
        z = np.asarray(z, dtype=float)
        return np.where(z >= -1, np.exp(-(np.maximum(z, -1.0) + 1)), 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        return -np.log1p(-np.asarray(q, dtype=float)) - 1

    def sf(self, z: ArrayLike) -> Array:
        return np.exp(-(np.maximum(z, -1.0) + 1))

    def isf(self, q: ArrayLike) -> Array:
        return -np.log(np.asarray(q, dtype=float)) - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class WeibullHeights(Heights):
    """Weibull heights, standardised; shape 1 is exponential, 3.6 has no skewness.

    Parameters
    ----------
    shape : float
        Shape β [1], at least 1.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.heights.WeibullHeights(shape=1.8).lowest, 6)
    -1.739515
    """

    name = "weibull"

    shape: float = quantity("β", "1", "shape", ge=1, le=50)

    @property
    def _scale(self) -> tuple[float, float]:
        """Mean of the plain Weibull variable and its standard deviation."""
        first, second = (math.gamma(1 + j / self.shape) for j in (1, 2))
        return first, math.sqrt(second - first**2)

    @property
    def lowest(self) -> float:
        """Lower end of the support."""
        mean, std = self._scale
        return -mean / std

    @property
    def pieces(self) -> tuple[float, ...]:
        mean, std = self._scale
        top = NEGLIGIBLE ** (1 / self.shape)
        count = math.ceil(max(top / std, top * self.shape) / 1.2)
        low = top / count * 0.25 ** np.arange(10, 0, -1.0)
        x = np.concatenate([[0.0], low, np.linspace(0, top, count + 1)[1:]])
        return tuple((x - mean) / std)

    @property
    def kinks(self) -> tuple[float, ...]:
        return (self.lowest,)

    @property
    def highest(self) -> float:
        mean, std = self._scale
        return (COMPLETE ** (1 / self.shape) - mean) / std

    def pdf(self, z: ArrayLike) -> Array:
        mean, std = self._scale
        x = mean + std * np.asarray(z, dtype=float)
        t = np.maximum(x, 0.0)
        density = std * self.shape * t ** (self.shape - 1) * np.exp(-(t**self.shape))
        return np.where(x >= 0, density, 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        mean, std = self._scale
        x = (-np.log1p(-np.asarray(q, dtype=float))) ** (1 / self.shape)
        return (x - mean) / std


@dataclass(frozen=True, slots=True, kw_only=True)
class JohnsonHeights(Heights):
    r"""Johnson's family: heights with a given skewness and kurtosis.

    .. math:: z = \xi + \lambda\,g\!\left(\frac{n-\gamma}{\delta}\right), \qquad n\sim N(0,1)

    g is sinh (S_U), exp (S_L) or the logistic function (S_B), as skewness and kurtosis ask;
    (0, 3) is Gaussian.

    Parameters
    ----------
    skewness, kurtosis : float
        Sk and κ [1] of the asperity heights; κ is 3 for a Gaussian (not the excess) and at
        least Sk² + 1.

    References
    ----------
    Johnson 1949, Biometrika 36, 149, doi:10.1093/biomet/36.1-2.149.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2)
    >>> law.family, [round(p, 4) for p in law.parameters]
    ('SU', [2.2537, 2.9955, 1.8837, 2.1586])
    """

    name = "johnson"

    skewness: float = quantity("Sk", "1", "skewness of asperity heights", default=0.0)
    kurtosis: float = quantity("κ", "1", "kurtosis of asperity heights", default=3.0)

    def _problems(self) -> list[str]:
        if not self.kurtosis > self.skewness * self.skewness + 1:
            return [
                Problem(
                    "kurtosis",
                    f"with skewness = {self.skewness:g} is "
                    "impossible: kurtosis must exceed skewness² + 1 (a Gaussian has 3, not 0)",
                    f"{self.kurtosis:g}",
                    code=Mistake.ORDER,
                )
            ]
        if self._complete():
            return []
        return [
            Problem(
                "",
                f": no member of the family was found with skewness {self.skewness:g} and "
                f"kurtosis {self.kurtosis:g}; they are too extreme (a Gaussian has 0 and 3; near "
                "skewness² + 1 the heights take hardly more than two values)",
                owner=type(self).__name__,
                code=Mistake.BEYOND,
            )
        ]

    def _complete(self) -> bool:
        """Whether a member is found, and its density sums to the moments asked for.

        It does not where heights pile up within rounding of an end, or where a tail counts that
        sums leave out.
        """
        try:
            with np.errstate(all="ignore"):
                z, weight = panel_rule(np.array(self.pieces), 24)
                moments = (weight * self.pdf(z)) @ z[:, None] ** np.arange(5)
        except InvalidValue:
            return False
        wanted = np.array([1.0, 0.0, 1.0, self.skewness, self.kurtosis])
        return bool(np.all(np.abs(moments - wanted) <= ASKED * np.maximum(1, np.abs(wanted))))

    @property
    def family(self) -> str:
        """ "SN", "SL", "SU" or "SB"."""
        return _johnson(self.skewness, self.kurtosis)[0]

    @property
    def parameters(self) -> tuple[float, float, float, float]:
        """γ, δ, ξ, λ."""
        return _johnson(self.skewness, self.kurtosis)[1]

    @property
    def kinks(self) -> tuple[float, ...]:
        _, _, xi, lam = self.parameters
        if self.family == "SL":
            return (xi,)
        return (xi, xi + lam) if self.family == "SB" else ()

    @property
    def pieces(self) -> tuple[float, ...]:
        # towards an end of S_B the density changes over steps of δ in n
        step = min(1.0, 1.5 * self.parameters[1]) if self.family == "SB" else 1.0
        z = self._height(np.linspace(-13, 13, math.ceil(26 / step) + 1))
        return tuple(np.unique(z))

    @property
    def highest(self) -> float:
        ends = self._height(np.array([-9.0, 9.0]))
        return max(self.kinks) if self.family == "SB" else float(np.max(ends))

    def _height(self, n: Array) -> Array:
        gamma, delta, xi, lam = self.parameters
        return xi + lam * _SHAPES[self.family](lam, (n - gamma) / delta)

    def pdf(self, z: ArrayLike) -> Array:
        gamma, delta, xi, lam = self.parameters
        y = (np.asarray(z, dtype=float) - xi) / lam
        with np.errstate(all="ignore"):
            if self.family == "SN":
                w, slope = y, np.ones_like(y)
            elif self.family == "SU":
                w, slope = np.arcsinh(y), 1 / np.sqrt(1 + y * y)
            elif self.family == "SL":
                w, slope = np.log(y), 1 / y
            else:
                w, slope = np.log(y / (1 - y)), 1 / (y * (1 - y))
            n = gamma + delta * w
            density = delta / abs(lam) * slope * np.exp(-0.5 * n * n) / math.sqrt(2 * math.pi)
        return np.where(np.isfinite(density), density, 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        q = np.asarray(q, dtype=float)
        return self._height(special.ndtri(1 - q if self.parameters[3] < 0 else q))


_SHAPES = {
    "SN": lambda lam, v: v,
    "SU": lambda lam, v: np.sinh(v),
    "SL": lambda lam, v: np.exp(v),
    "SB": lambda lam, v: special.expit(v),
}


@cache
def _johnson(skewness: float, kurtosis: float) -> tuple[str, tuple[float, float, float, float]]:
    """Family and γ, δ, ξ, λ with zero mean, unit variance and the given shape."""
    from scipy.optimize import brentq, least_squares

    if skewness < 0:
        # the mirror image, −z
        family, (gamma, delta, xi, lam) = _johnson(-skewness, kurtosis)
        if family == "SL":
            return family, (gamma, delta, -xi, -lam)
        return family, (-gamma, delta, -xi - (lam if family == "SB" else 0.0), lam)
    sk2 = skewness**2
    if sk2 < 1e-20 and abs(kurtosis - 3) < 1e-10:
        return "SN", (0.0, 1.0, 0.0, 1.0)
    # the log-normal line: sk² = (W − 1)(W + 2)²
    most = 1 + 2 * sk2 ** (1 / 3)
    W = brentq(lambda w: (w - 1) * (w + 2) ** 2 - sk2, 1.0, most) if sk2 > 0 else 1.0
    line = W * W * (W * W + 2 * W + 3) - 3
    if sk2 > 0 and abs(kurtosis - line) < 1e-9 * line:
        delta = 1 / math.sqrt(math.log(W))
        lam = 1 / math.sqrt(W * (W - 1))
        return "SL", (0.0, delta, -lam * math.sqrt(W), lam)
    # steps that a curve of the least δ needs: the error is exp(−2π²δ/step), 1e-28
    n = np.linspace(-12, 12, 1001)
    weight = np.exp(-0.5 * n * n) / math.sqrt(2 * math.pi) * (n[1] - n[0])

    def shape(v: Array) -> tuple[float, float, float, float]:
        mean = float(weight @ v)
        c = v - mean
        var = float(weight @ c**2)
        c /= math.sqrt(var) if 0 < var < math.inf else math.nan
        return mean, var, float(weight @ c**3), float(weight @ c**4)

    family = "SU" if kurtosis > line else "SB"
    g = _SHAPES[family]

    def misfit(p: Array) -> Array:
        with np.errstate(all="ignore"):
            _, _, s, k = shape(g(1.0, (n - p[0]) * np.exp(-p[1])))
        # no way to go: one value only, more than a number holds, or piled up at the ends
        lost = not math.isfinite(k) or p[1] < math.log(SHARPEST)
        return np.full(2, 1e9) if lost else np.array([s - skewness, k / kurtosis - 1])

    best: Any = None
    for gamma in (0.0, -2.0 * np.sign(skewness), -5.0 * np.sign(skewness), 0.5):
        for log_delta in (0.0, 1.0, -0.5, 2.0):
            fit = least_squares(misfit, [gamma, log_delta], xtol=1e-15, ftol=1e-15, gtol=1e-15)
            if best is None or fit.cost < best.cost:
                best = fit
            if best.cost < 1e-24:
                break
        if best.cost < 1e-24:
            break
    if best is None or best.cost > 1e-16:
        raise InvalidValue(
            f"no S_U or S_B has skewness {skewness:g} and kurtosis {kurtosis:g}",
            code=Mistake.BEYOND,
        )
    gamma, delta = float(best.x[0]), math.exp(best.x[1])
    mean, var, _, _ = shape(g(1.0, (n - gamma) / delta))
    lam = 1 / math.sqrt(var)
    return family, (gamma, delta, -lam * mean, lam)


@dataclass(frozen=True, slots=True, kw_only=True)
class HistogramHeights(Heights):
    """Measured asperity heights: frequencies in bins, uniform inside each bin, standardised.

    Parameters
    ----------
    edges : tuple of float
        Increasing bin edges, in any unit.
    counts : tuple of float
        Asperities per bin.

    Examples
    --------
    >>> import thirdbody as tb
    >>> law = tb.heights.HistogramHeights(edges=(0, 1, 2), counts=(1, 1))
    >>> [round(z, 6) for z in law.pieces]
    [-1.732051, 0.0, 1.732051]
    """

    name = "histogram"

    edges: tuple[float, ...] = several("1", "edges of the classes of height, in any unit")
    counts: tuple[float, ...] = several("1", "asperities in each class")

    def __post_init__(self) -> None:
        sequences(self, "edges", "counts")
        Heights.__post_init__(self)

    def _problems(self) -> list[str]:
        e, c = np.array(self.edges), np.array(self.counts)
        out: list[str] = []
        if len(e) != len(c) + 1 or not len(c):
            out.append(
                Problem(
                    "",
                    f"has {len(e)} edges and {len(c)} counts; n + 1 and n",
                    owner=type(self).__name__,
                    code=Mistake.SHAPE,
                )
            )
        elif not (np.all(np.isfinite(e)) and np.all(e[1:] > e[:-1])):
            out.append(Problem("edges", "must be finite and increase", code=Mistake.ORDER))
        elif not (np.all(np.isfinite(c)) and np.all(c >= 0) and c[0] > 0 and c[-1] > 0):
            out.append(
                Problem("counts", "must be >= 0, the first and last above 0", code=Mistake.RANGE)
            )
        else:
            with np.errstate(all="ignore"):
                ends, density = self._bins
            if not (np.all(ends[1:] > ends[:-1]) and np.all(np.isfinite(density))):
                out.append(
                    Problem(
                        "",
                        "spans more than numbers hold; check edges and counts",
                        owner=type(self).__name__,
                        code=Mistake.BEYOND,
                    )
                )
        return out

    @property
    def _bins(self) -> tuple[Array, Array]:
        """Standardised edges and densities."""
        e, c = np.array(self.edges), np.array(self.counts)
        mass = c / c.sum()
        # about the mean, so that a far origin of the heights costs no digits
        e = (e - e[0]) / (e[-1] - e[0])
        e -= mass @ (0.5 * (e[1:] + e[:-1]))
        z = e / np.sqrt(mass @ ((e[1:] ** 2 + e[1:] * e[:-1] + e[:-1] ** 2) / 3))
        return z, mass / np.diff(z)

    @property
    def pieces(self) -> tuple[float, ...]:
        return tuple(float(z) for z in self._bins[0])

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.pieces

    def pdf(self, z: ArrayLike) -> Array:
        edges, density = self._bins
        z = np.asarray(z, dtype=float)
        i = np.clip(np.searchsorted(edges, z, side="right") - 1, 0, len(density) - 1)
        return np.where((z >= edges[0]) & (z <= edges[-1]), density[i], 0.0)

    def ppf(self, q: ArrayLike) -> Array:
        edges, density = self._bins
        mass = np.concatenate([[0.0], np.cumsum(density * np.diff(edges))])
        return np.interp(np.asarray(q, dtype=float), mass / mass[-1], edges)
