r"""What a history does to the surfaces: wear depth, running-in, dents.

Lower a surface by a(z) dw with :math:`\langle a\rangle = 1` over its area. Whatever a(z) is,

.. math:: \frac{d\sigma^2}{dw} = -2\,(\langle z\rangle_a - \bar z)

with the mean height of what is removed, :math:`\langle z\rangle_a=\langle a z\rangle`. Even wear
leaves σ as it is; wear where contacts are, at the separation, lowers σ by one to three times the
mean wear depth. Plastic flattening, which smooths without loss, is not in it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import special

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.value import Value, quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "ClippedGaussian",
    "RunningIn",
    "archard_depth",
    "ball_scar_radius",
    "clip_gaussian",
    "dent_roughness",
    "variance_slope",
]


def __dir__() -> list[str]:
    return sorted(__all__)


def _check_positive(**values: ArrayLike) -> None:
    wrong = [
        Problem(name, "must be finite and > 0", repr(value), code=Mistake.RANGE)
        for name, value in values.items()
        if not np.all(np.isfinite(np.asarray(value, float)) & (np.asarray(value, float) > 0))
    ]
    if wrong:
        raise InvalidValue(*wrong)


class ClippedGaussian(NamedTuple):
    """A Gaussian surface whose tops are cut off, all in units of its first σ; by `clip_gaussian`.

    Examples
    --------
    >>> from thirdbody.systems.life.surfaces import clip_gaussian
    >>> round(clip_gaussian(1.0).sigma, 6)
    0.866653
    """

    wear: float
    """Mean wear depth w/σ_0 [1]."""
    sigma: float
    """σ/σ_0 of what is left [1]."""
    slope: float
    """dσ/dw there [1]."""


@takes_units
def clip_gaussian(level: float) -> ClippedGaussian:
    r"""A Gaussian surface cut at a height over its mean plane: the fastest smoothing by removal.

    .. math:: w/\sigma_0 = \varphi(t) - t\,[1-\Phi(t)], \qquad
              \frac{d\sigma}{dw} = -\frac{t\sigma_0-\bar z}{\sigma}, \qquad \bar z = -w

    Parameters
    ----------
    level : float
        t, height of the cut over the first mean plane, in σ_0 [1].

    Returns
    -------
    ClippedGaussian

    Notes
    -----
    Moments of the censored normal distribution, exact; the slope is that of `variance_slope` with
    all removal at the cut.

    Examples
    --------
    >>> from thirdbody.systems.life.surfaces import clip_gaussian
    >>> [round(each, 5) for each in clip_gaussian(1.0)]
    [0.08332, 0.86665, -1.25]
    """
    if not math.isfinite(level):
        rule = "must be a finite number [1], a height over σ"
        raise InvalidValue(Problem("level", rule, repr(level), code=Mistake.RANGE))
    over = float(special.ndtr(-level))
    density = math.exp(-0.5 * level * level) / math.sqrt(2 * math.pi)
    wear = density - level * over
    # ⟨min(z, t)²⟩ = Φ(t) − tφ(t) + t²[1−Φ(t)]
    square = float(special.ndtr(level)) - level * density + level * level * over
    sigma = math.sqrt(square - wear * wear)
    return ClippedGaussian(wear, sigma, -(level + wear) / sigma)


@takes_units
def variance_slope(heights: ArrayLike, *, removal: ArrayLike) -> float:
    r"""Change of the variance of a surface with its mean wear depth, exact for any removal.

    .. math:: \frac{d\sigma^2}{dw} = -2\,(\langle z\rangle_a - \bar z)

    Parameters
    ----------
    heights : array
        z of a measured or computed surface [m].
    removal : array
        a, how much is taken at each point for one unit of mean depth, in any unit [1]; as many.

    Returns
    -------
    float
        dσ²/dw [m].

    Raises
    ------
    InvalidValue
        Arrays of different shapes, or a removal that is negative or nowhere positive.

    Examples
    --------
    >>> import numpy as np
    >>> from thirdbody.systems.life.surfaces import variance_slope
    >>> z = np.array([-1.0, 0.0, 1.0])
    >>> variance_slope(z, removal=np.ones(3)), variance_slope(z, removal=[0, 0, 3])
    (0.0, -2.0)
    """
    z, a = np.asarray(heights, float), np.asarray(removal, float)
    if z.shape != a.shape or not z.size:
        rule = f"{z.shape} and removal {a.shape} must have one shape"
        raise InvalidValue(Problem("heights", rule, code=Mistake.SHAPE))
    if not np.all(np.isfinite(a) & (a >= 0)) or not np.any(a > 0):
        rule = "must be >= 0 everywhere and > 0 somewhere"
        raise InvalidValue(Problem("removal", rule, code=Mistake.RANGE))
    return float(-2 * (np.average(z, weights=a) - z.mean())) + 0.0


@takes_units
def dent_roughness(depth: ArrayLike, *, coverage: ArrayLike) -> Array:
    r"""Roughness of a flat full of random dents, each of which replaces what was there.

    .. math:: \sigma_d^2 = \delta^2\left[\frac{1-e^{-c}}{3} - \frac{(1-e^{-c})^2}{4}\right]

    Parameters
    ----------
    depth : float or array
        δ, depth of every dent [m].
    coverage : float or array
        c, area of all dents ever thrown per area of the surface [1].

    Returns
    -------
    array
        σ_d [m]: at most δ/3, at c = ln 3, and δ/√12 in the end.

    Notes
    -----
    Heights inside a shallow cap are spread evenly from 0 to −δ. Reported beside σ, never fed into
    it: a pit carries nothing, its rim does, and Gaussian heights have no rims.

    Examples
    --------
    >>> import math
    >>> from thirdbody.systems.life.surfaces import dent_roughness
    >>> round(float(dent_roughness(1.0, coverage=math.log(3))), 12)
    0.333333333333
    """
    c = np.asarray(coverage, float)
    if not np.all(c >= 0):
        rule = "must be >= 0 [1]"
        raise InvalidValue(Problem("coverage", rule, repr(coverage), code=Mistake.RANGE))
    dented = -np.expm1(-c)
    return np.asarray(depth, float) * np.sqrt(dented / 3 - dented**2 / 4)


@takes_units
def archard_depth(K: ArrayLike, *, pressure: ArrayLike, distance: ArrayLike, H: ArrayLike) -> Array:
    r"""Wear depth of a plane surface by Archard's law.

    .. math:: w = \frac{K\,p\,s}{H}

    Parameters
    ----------
    K : float or array
        Wear coefficient [1].
    pressure, distance, H : float or array
        p [Pa], sliding distance s [m], and hardness H [Pa].

    Returns
    -------
    array
        w [m].

    References
    ----------
    Archard 1953, J. Appl. Phys. 24, 981, doi:10.1063/1.1721448 (from memory: not confirmed in a
    source).

    Examples
    --------
    >>> from thirdbody.systems.life.surfaces import archard_depth
    >>> round(float(archard_depth(1e-6, pressure=5e6, distance=0.1 * 3.6e6, H=2.5e9)) * 1e3, 6)
    0.72
    """
    _check_positive(H=H)
    return np.asarray(K, float) * np.asarray(pressure) * np.asarray(distance) / np.asarray(H)


@takes_units
def ball_scar_radius(
    K: ArrayLike, *, R: ArrayLike, load: ArrayLike, distance: ArrayLike, H: ArrayLike
) -> Array:
    r"""Radius of the scar that a ball under a constant load wears on itself, on a flat that stays.

    .. math:: a = \left(\frac{4 R K F s}{\pi H}\right)^{1/4}

    Parameters
    ----------
    K : float or array
        Wear coefficient [1].
    R, load, distance, H : float or array
        Ball radius R [m], load F [N], sliding distance s [m], hardness H [Pa].

    Returns
    -------
    array
        a [m]; the volume of the shallow cap, πa⁴/4R, is Archard's K F s/H.

    Raises
    ------
    InvalidValue
        A radius or hardness that is not positive.

    Examples
    --------
    >>> from thirdbody.systems.life.surfaces import ball_scar_radius
    >>> a = float(ball_scar_radius(1e-6, R=9.5e-3, load=20.0, distance=1000.0, H=7.37e9))
    >>> round(a * 1e3, 6)
    0.425646
    """
    _check_positive(R=R, H=H)
    volume = np.asarray(K, float) * np.asarray(load) * np.asarray(distance) / np.asarray(H)
    return (4 * np.asarray(R) * volume / np.pi) ** 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class RunningIn(Value):
    r"""Roughness that falls with wear, towards a value that no theory gives.

    .. math:: \frac{d\sigma}{dw} = -\frac{\sigma-\sigma_{end}}{\ell}, \qquad\text{or}\qquad
              \frac{d\sigma}{dw} = -\frac{h}{\sigma}\left(1-\frac{\sigma_{end}}{\sigma}\right)

    Parameters
    ----------
    sigma_end : float
        σ in the end [m]: the user's.
    length : float, optional
        ℓ, wear depth of both surfaces together over which σ runs in [m]. Without it the second
        form, which is the exact identity of `variance_slope` for what asperities wear at the
        solved separation h over the mean plane, held back by the factor in brackets: a choice.
    share_1 : float, optional
        σ_1²/σ², how much of the roughness is surface 1's [1]. Of two Gaussian surfaces each is
        worn at the mean height :math:`h\sigma_i^2/\sigma^2`.

    Notes
    -----
    Heights are scaled at fixed wavelengths: tip radii go as 1/σ, the density of asperities stays
    (a choice). Grooves of particles count as even wear in the second form. Plastic flattening
    smooths faster than any removal, so that h/σ is a lower bound of the rate where asperities
    yield.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.RunningIn(sigma_end=60e-9, length=1e-7).slope(100e-9, separation=2e-7)
    -0.4
    >>> round(tb.oil.RunningIn(sigma_end=0.0).slope(100e-9, separation=2e-7), 9)
    -2.0
    """

    sigma_end: float = quantity("σ_end", "m", "roughness in the end", ge=0)
    length: float | None = quantity(
        "ℓ", "m", "wear depth over which roughness runs in", default=None, gt=0
    )
    share_1: float = quantity(
        "σ_1²/σ²", "1", "share of surface 1 in the roughness", default=0.5, ge=0, le=1
    )

    def slope(self, sigma: float, *, separation: float) -> float:
        """dσ/dw at a roughness and a separation.

        Parameters
        ----------
        sigma : float
            σ [m].
        separation : float
            h over the mean plane [m].
        """
        if self.length is not None:
            return -(sigma - self.sigma_end) / self.length
        return -max(separation, 0.0) / sigma * (1 - self.sigma_end / sigma)

    def rate(
        self,
        sigma: float,
        *,
        separation: float,
        wear: tuple[float, float],
        by_asperities: tuple[float, float],
    ) -> float:
        """dσ/dt [m/s].

        Parameters
        ----------
        sigma, separation : float
            σ and h [m].
        wear, by_asperities : two floats
            Wear depth of each surface per time [m/s], and of it what asperities take.
        """
        slope = self.slope(sigma, separation=separation)
        if self.length is not None:
            return slope * sum(wear)
        shares = (self.share_1, 1 - self.share_1)
        return slope * sum(share * w for share, w in zip(shares, by_asperities, strict=True))
