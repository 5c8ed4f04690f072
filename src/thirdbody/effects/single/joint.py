"""Heat through a joint of rough surfaces as a whole, as the literature has it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from ...quantities.arguments import need_positive
from ...quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = [
    "absolute_slope",
    "cooper_mikic_yovanovich",
    "cooper_mikic_yovanovich_fit",
    "mikic_elastic",
]


@takes_units
def absolute_slope(*, sigma: Number, R: Number, alpha: float) -> Number:
    r"""Mean absolute slope of a profile m [1] of a Gaussian isotropic surface.

    .. math:: m = \sqrt{\frac{2}{\pi}\,m_2}, \qquad m_2 = \sqrt{\sigma^2 m_4/\alpha}, \qquad
              m_4 = \frac{9\pi}{64R^2}

    Parameters
    ----------
    sigma, R : float
        RMS height, and mean radius of the asperities [m].
    alpha : float
        Nayak's bandwidth [1].

    Returns
    -------
    float
        m [1].

    References
    ----------
    McCool 1986, doi:10.1016/0043-1648(86)90045-1 (m_4 from R); Nayak 1971, doi:10.1115/1.3451608
    (α).

    Notes
    -----
    √m_2 is the RMS slope of a profile; formulas for conductance take m, which is 0.798 of it.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import absolute_slope
    >>> f"{absolute_slope(sigma=100e-9, R=2.8e-6, alpha=5.0):.4f}"
    '0.0822'
    """
    need_positive(sigma=sigma, R=R, alpha=alpha)
    m_2 = sigma / R * math.sqrt(9 * math.pi / 64 / alpha)
    return np.sqrt(2 / math.pi * m_2)


@takes_units
def cooper_mikic_yovanovich(pressure: Number, *, H: float, k: float, m: float, sigma: float) -> Any:
    r"""Conductance of clean, plastic, conforming rough surfaces [W/(m² K)].

    .. math:: h = \frac{k m}{\sigma}\,\frac{e^{-\lambda^2/2}}
              {2\sqrt{2\pi}\,(1-\sqrt{p/H})^{1.5}}, \qquad
              \frac pH = \tfrac12\,\mathrm{erfc}\frac{\lambda}{\sqrt2}

    Parameters
    ----------
    pressure : float or array
        Nominal pressure p [Pa].
    H : float
        Hardness of the softer body [Pa].
    k : float
        Harmonic mean 2k_1k_2/(k_1+k_2) [W/(m K)].
    m : float
        Mean absolute slope [1], `absolute_slope`.
    sigma : float
        RMS height [m].

    Returns
    -------
    float or array
        h [W/(m² K)].

    Notes
    -----
    For 1e-5 < p/H < 0.05, isotropic Gaussian surfaces, no gas in the gap. The product of number
    and radius of the spots of a plastic Gaussian surface gives it exactly.

    References
    ----------
    Cooper, Mikic, Yovanovich 1969, Int. J. Heat Mass Transfer 12, 279,
    doi:10.1016/0017-9310(69)90011-8.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import cooper_mikic_yovanovich
    >>> round(float(cooper_mikic_yovanovich(0.01, H=1, k=1, m=1, sigma=1)), 5)
    0.01561
    """
    share = pressure / H
    lam = -special.ndtri(share)
    height = np.exp(-(lam**2) / 2) / (2 * math.sqrt(2 * math.pi))
    return k * m / sigma * height / (1 - np.sqrt(share)) ** 1.5


@takes_units
def cooper_mikic_yovanovich_fit(
    pressure: Number, *, H: float, k: float, m: float, sigma: float
) -> Number:
    r"""Conductance of clean, plastic, conforming rough surfaces, as a power law.

    .. math:: h = 1.25\,\frac{k m}{\sigma}\left(\frac pH\right)^{0.95}

    Parameters
    ----------
    pressure, H, k, m, sigma
        As in `cooper_mikic_yovanovich`: [Pa], [Pa], [W/(m K)], [1], [m].

    Returns
    -------
    float or array
        h [W/(m² K)].

    Notes
    -----
    Within 1.5 % of `cooper_mikic_yovanovich`, which it approximates, for p/H from 1e-4 to 1e-2. Its
    source is not confirmed here.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import cooper_mikic_yovanovich_fit
    >>> round(cooper_mikic_yovanovich_fit(0.01, H=1, k=1, m=1, sigma=1), 5)
    0.01574
    """
    return 1.25 * k * m / sigma * (pressure / H) ** 0.95


@takes_units
def mikic_elastic(pressure: Number, *, E_star: float, k: float, m: float, sigma: float) -> Number:
    r"""Conductance of clean, elastic, conforming rough surfaces [W/(m² K)].

    .. math:: h = 1.55\,\frac{k m}{\sigma}\left(\frac{\sqrt2\,p}{E^* m}\right)^{0.94}

    Parameters
    ----------
    pressure, k, m, sigma
        As in `cooper_mikic_yovanovich`.
    E_star : float
        Contact modulus [Pa], 1/E* = Σ(1−ν²)/E.

    Returns
    -------
    float or array
        h [W/(m² K)].

    References
    ----------
    Mikic 1974, Int. J. Heat Mass Transfer 17, 205, doi:10.1016/0017-9310(74)90082-9.
    Constants from memory: not confirmed in a source.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import mikic_elastic
    >>> h = [mikic_elastic(p, E_star=1.1e11, k=50, m=0.08, sigma=1e-7) for p in (1e6, 2e6)]
    >>> round(h[1] / h[0], 3)
    1.919
    """
    return 1.55 * k * m / sigma * (math.sqrt(2) * pressure / (E_star * m)) ** 0.94
