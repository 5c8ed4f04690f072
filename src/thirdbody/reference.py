r"""Exact and asymptotic solutions to check a contact model against.

Every function is a formula, or an integral to full precision; none is used by the solver.

- `hertz_point`: a sphere on a flat, from the load; it gives a `HertzPoint`
- `elliptic_hertz`: the elastic contact of an elliptic asperity with a flat
- `gaussian_integral`: Greenwood and Williamson's integrals over Gaussian heights
- `exponential_gw`, `exponential_ceb`, `exponential_ke`, `exponential_plastic`: load and area of
  summits of these laws with exponential heights, as a `SummitSum`
- `persson_area`: Persson's area of an elastic rough surface
- `PERSSON_SLOPE`: how it begins, (A/A_n)/(p/E*g) at small load
- `bush_gibson_thomas_area`: the area of Bush, Gibson and Thomas at vanishing load
- `BUSH_GIBSON_THOMAS_SLOPE`: how it begins
"""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import special
from scipy.special import elliprd, elliprf

from .errors import InvalidValue, Mistake, Problem
from .quantities.arguments import need_positive
from .quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "BUSH_GIBSON_THOMAS_SLOPE",
    "PERSSON_SLOPE",
    "HertzPoint",
    "SummitSum",
    "bush_gibson_thomas_area",
    "elliptic_hertz",
    "exponential_ceb",
    "exponential_gw",
    "exponential_ke",
    "exponential_plastic",
    "gaussian_integral",
    "hertz_point",
    "persson_area",
]


def __dir__() -> list[str]:
    return sorted(__all__)


PERSSON_SLOPE = math.sqrt(8 / math.pi)
"""(A/A_n)/(p/E*g) at small load after Persson, √(8/π) = 1.596."""
BUSH_GIBSON_THOMAS_SLOPE = math.sqrt(2 * math.pi)
"""(A/A_n)/(p/E*g) at vanishing load after Bush, Gibson and Thomas, √(2π) = 2.507."""


class HertzPoint(NamedTuple):
    """A sphere on a flat: what `hertz_point` gives.

    Examples
    --------
    >>> import thirdbody as tb
    >>> point = tb.reference.hertz_point(1.0, R=5e-3, E_star=115e9)
    >>> f"{point.contact_radius * 1e6:.1f} µm, {point.peak_pressure / 1e6:.0f} MPa"
    '31.9 µm, 468 MPa'
    """

    contact_radius: Array
    """a [m]"""
    interference: Array
    """ω [m]"""
    area: Array
    """A = πa² [m²]"""
    mean_pressure: Array
    """p = F/A [Pa]"""
    peak_pressure: Array
    """p_0 = 3p/2 [Pa]"""
    stiffness: Array
    """dF/dω = 2E*a [N/m]"""


@takes_units
def hertz_point(force: ArrayLike, *, R: float, E_star: float) -> HertzPoint:
    r"""Hertz's elastic contact of a sphere with a flat, from the load.

    .. math:: a = \left(\frac{3FR}{4E^*}\right)^{1/3}, \quad \omega = \frac{a^2}{R}, \quad
              p_0 = \frac{2E^*a}{\pi R}

    Parameters
    ----------
    force : array_like
        Load F [N], positive.
    R, E_star : float
        Radius of the sphere R [m], contact modulus E* [Pa], 1/E* = Σ(1 − ν²)/E.

    Returns
    -------
    HertzPoint

    References
    ----------
    Hertz 1882, J. reine angew. Math. 92, 156, doi:10.1515/crll.1882.92.156. Seen (in Johnson
    1985, Contact Mechanics, ch. 4, doi:10.1017/CBO9781139171731).

    Examples
    --------
    >>> import thirdbody as tb
    >>> ball = tb.reference.hertz_point(10.0, R=5e-3, E_star=112e9)
    >>> round(float(ball.contact_radius) * 1e6, 3), round(float(ball.peak_pressure) / 1e9, 4)
    (69.439, 0.9902)
    """
    F = np.asarray(force, dtype=float)
    a = np.cbrt(0.75 * F * R / E_star)
    peak = 2 * E_star * a / (math.pi * R)
    return HertzPoint(a, a * a / R, math.pi * a * a, 2 / 3 * peak, peak, 2 * E_star * a)


@takes_units
def gaussian_integral(h: ArrayLike, *, n: float) -> Array:
    r"""Greenwood and Williamson's integrals over Gaussian heights, to full precision.

    .. math:: F_n(h) = \frac{1}{\sqrt{2\pi}} \int_h^\infty (u-h)^n e^{-u^2/2}\,du

    Parameters
    ----------
    h : array_like
        Separation over the standard deviation of the heights [1].
    n : float
        Power n ≥ 0 [1]: 0 the number of contacts, 1 the area, 3/2 the load, 5/2 the load of
        two rough surfaces.

    Returns
    -------
    array
        F_n(h) [1].

    Notes
    -----
    Derived: trapezoidal sum after a double-exponential change of variable; relative error 1e-13
    up to what the rounding of h²/2 costs. The fit 4.4086e-5 (4 − h)^6.804 to F_{5/2}, common in
    lubrication codes, is 11 % low at 0, 74 % low at 3, and zero beyond 4.

    References
    ----------
    Greenwood, Williamson 1966, Proc. R. Soc. A 295, 300, doi:10.1098/rspa.1966.0242.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.reference.gaussian_integral([0.0, 3.0, 5.0], n=2.5)
    array([6.16634219e-01, 1.70872996e-04, 1.35259200e-08])
    """
    if not n >= 0:
        raise InvalidValue(f"gaussian_integral n = {n!r} must be >= 0", code=Mistake.RANGE)
    h = np.asarray(h, dtype=float)
    deepest = max(6.0, float(np.max(-h, initial=0.0)))
    x = np.arange(-4.2, 4.6, 0.4 / deepest)
    with np.errstate(under="ignore"):
        unit = np.exp(x - np.exp(-x))
        scale = np.where(h > 0, 1 / (1 + np.abs(h)), 1 + np.abs(h))[..., None]
        t = scale * unit
        phi = np.exp(-0.5 * (h[..., None] + t) ** 2)
        values = t ** (n + 1) * (1 + np.exp(-x)) * phi
    return values.sum(axis=-1) * (x[1] - x[0]) / math.sqrt(2 * math.pi)


# ---------------------------------------------------------------- exponential heights
class SummitSum(NamedTuple):
    """Load and area of all summits per nominal area, as the ``exponential_...`` forms give them.

    Examples
    --------
    >>> import thirdbody as tb
    >>> low, high = (
    ...     tb.reference.exponential_gw(h, eta=2e10, sigma_s=1e-7, R=3e-6, E_star=1e11)
    ...     for h in (2, 1)
    ... )
    >>> round(float(high.pressure / low.pressure), 6), round(float(high.area / low.area), 6)
    (2.718282, 2.718282)
    """

    pressure: Array
    """Load per nominal area [Pa]"""
    area: Array
    """Real area per nominal area [1]"""


def _touching(h: ArrayLike, eta: float, sigma_s: float, R: float) -> Array:
    """n_0 = ηRσ_s exp(−h − 1): π n_0 is the elastic area."""
    need_positive(eta=eta, sigma_s=sigma_s, R=R)
    h = np.asarray(h, dtype=float)
    if np.any(h < -1):
        raise InvalidValue(
            Problem(
                "h",
                "must be >= -1: exponential heights end one standard deviation below their mean, "
                "and the closed forms hold while summits remain out of contact",
                code=Mistake.RANGE,
            )
        )
    return eta * R * sigma_s * np.exp(-h - 1)


@takes_units
def exponential_gw(
    h: ArrayLike, *, eta: float, sigma_s: float, R: float, E_star: float
) -> SummitSum:
    r"""Elastic summits with exponential heights.

    Heights of zero mean and unit variance, :math:`\phi = e^{-(z+1)}` for z > −1. With
    :math:`n_0 = \eta R\sigma_s e^{-(h+1)}`,

    .. math:: A = \pi n_0, \qquad
              p = \tfrac43\,\Gamma(\tfrac52)\,E^*\sqrt{\sigma_s/R}\;n_0 .

    For such heights load and area of every law without adhesion fall like e^(−h), so the mean
    pressure does not depend on the load.

    Parameters
    ----------
    h : array_like
        Separation from the mean summit height over σ_s [1], at least −1.
    eta, sigma_s, R : float
        Summit density η [1/m²], standard deviation of heights σ_s [m], tip radius R [m].
    E_star : float
        Contact modulus E* [Pa].

    Returns
    -------
    SummitSum

    References
    ----------
    Greenwood, Williamson 1966, doi:10.1098/rspa.1966.0242. Derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> s = tb.reference.exponential_gw([0.0, 4.0], eta=5e12, sigma_s=1e-8, R=1e-6, E_star=1e11)
    >>> (s.pressure / s.area / 1e9).round(6)
    array([5.641896, 5.641896])
    """
    n = _touching(h, eta, sigma_s, R)
    return SummitSum(4 / 3 * special.gamma(2.5) * E_star * math.sqrt(sigma_s / R) * n, math.pi * n)


@takes_units
def exponential_ceb(
    h: ArrayLike, *, eta: float, sigma_s: float, R: float, E_star: float, H: float, K: float = 0.6
) -> SummitSum:
    r"""Chang, Etsion and Bogy's summits with exponential heights.

    With n_0 of `exponential_gw` and :math:`w=\omega_c/\sigma_s`, ω_c = (πKH/2E*)²R,

    .. math:: p = n_0\left[\tfrac43 E^*\sqrt{\sigma_s/R}\;\gamma(\tfrac52,w)
              + \pi K H (w+2)e^{-w}\right],
    .. math:: A = \pi n_0\left[\gamma(2,w) + (w+2)e^{-w}\right].

    Parameters
    ----------
    h : float or array
        As in `exponential_gw` [1].
    eta, sigma_s, R, E_star : float
        As there: [1/m²], [m], [m], [Pa].
    H, K : float
        Hardness H [Pa]; peak pressure at yield over H, K [1].

    Returns
    -------
    SummitSum

    References
    ----------
    Chang, Etsion, Bogy 1987, doi:10.1115/1.3261348. Derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> s = tb.reference.exponential_ceb(1.5, eta=5e12, sigma_s=1e-8, R=1e-6, E_star=1e11, H=2e9)
    >>> round(float(s.area), 6)
    0.025338
    """
    n = _touching(h, eta, sigma_s, R)
    w = (math.pi * K * H / (2 * E_star)) ** 2 * R / sigma_s
    elastic = special.gamma(2.5) * special.gammainc(2.5, w)
    plastic = math.pi * (w + 2) * math.exp(-w)
    return SummitSum(
        n * (4 / 3 * E_star * math.sqrt(sigma_s / R) * elastic + K * H * plastic),
        n * (math.pi * special.gammainc(2, w) + plastic),
    )


@takes_units
def exponential_plastic(
    h: ArrayLike, *, eta: float, sigma_s: float, R: float, H: float
) -> SummitSum:
    r"""Fully plastic summits with exponential heights: A = 2πn_0, p = HA.

    Parameters
    ----------
    h : float or array
        As in `exponential_gw` [1].
    eta, sigma_s, R : float
        As there: [1/m²], [m], [m].
    H : float
        Hardness H [Pa].

    Returns
    -------
    SummitSum

    References
    ----------
    Derived, from A = 2πRω of one summit (doi:10.1115/1.555332).

    Examples
    --------
    >>> import thirdbody as tb
    >>> s = tb.reference.exponential_plastic(2.0, eta=5e12, sigma_s=1e-8, R=1e-6, H=2e9)
    >>> round(float(s.pressure / s.area) / 1e9, 12)
    2.0
    """
    area = 2 * math.pi * _touching(h, eta, sigma_s, R)
    return SummitSum(H * area, area)


@takes_units
def exponential_ke(
    h: ArrayLike, *, eta: float, sigma_s: float, R: float, E_star: float, H: float, K: float
) -> SummitSum:
    r"""Kogut and Etsion's summits with exponential heights.

    Each power :math:`c\,(\omega/\omega_c)^m` of the law between y_1 and y_2 gives, with
    :math:`w=\omega_c/\sigma_s`,

    .. math:: c\,w^{-m}\left[\Gamma(m+1, y_1w)-\Gamma(m+1, y_2w)\right]e^{-(h+1)},

    times ηF_c or ηA_c; the joins are y = 1, 6 and 110.

    Parameters
    ----------
    h : float or array
        As in `exponential_gw` [1].
    eta, sigma_s, R, E_star : float
        As there: [1/m²], [m], [m], [Pa].
    H, K : float
        Hardness H [Pa]; peak pressure at yield over H, K = 0.454 + 0.41ν [1].

    Returns
    -------
    SummitSum

    References
    ----------
    Kogut, Etsion 2002, doi:10.1115/1.1490373: loads seen, exponents of the area recalled; the
    sum derived.

    Examples
    --------
    >>> import thirdbody as tb
    >>> s = tb.reference.exponential_ke(
    ...     1.5, eta=5e12, sigma_s=1e-8, R=1e-6, E_star=1e11, H=2e9, K=0.454 + 0.41 * 0.29)
    >>> round(float(s.area), 6)
    0.021504
    """
    n = _touching(h, eta, sigma_s, R)
    omega_c = (math.pi * K * H / (2 * E_star)) ** 2 * R
    w = omega_c / sigma_s
    edges = (0.0, 1.0, 6.0, 110.0, math.inf)
    loads = ((1.0, 1.5), (1.03, 1.425), (1.40, 1.263), (3 / K, 1.0))
    areas = ((1.0, 1.0), (0.93, 1.136), (0.94, 1.146), (2.0, 1.0))

    def total(powers: tuple[tuple[float, float], ...]) -> float:
        out = 0.0
        for (c, m), low, high in zip(powers, edges[:-1], edges[1:], strict=True):
            # from the side on which the difference does not cancel
            if low * w > m + 1:
                integral = special.gammaincc(m + 1, low * w) - special.gammaincc(m + 1, high * w)
            else:
                integral = special.gammainc(m + 1, high * w) - special.gammainc(m + 1, low * w)
            out += c * w**-m * special.gamma(m + 1) * integral
        return out

    unit = math.pi * w * n  # ηA_c exp(−h − 1)
    return SummitSum(2 / 3 * K * H * unit * total(loads), unit * total(areas))


# ---------------------------------------------------------------- slope laws
def _slope_problem(E_star: float, g: float) -> None:
    if not (E_star > 0 and g > 0):
        raise InvalidValue(f"E_star = {E_star!r} and g = {g!r} must be > 0", code=Mistake.RANGE)


@takes_units
def persson_area(pressure: ArrayLike, *, E_star: float, g: float) -> Array:
    r"""Persson's real area of an elastic, randomly rough surface.

    .. math:: A/A_n = \operatorname{erf}\left(\frac{\sqrt2\,p}{E^* g}\right)

    Parameters
    ----------
    pressure : array_like
        Nominal pressure p [Pa].
    E_star : float
        Contact modulus E* [Pa].
    g : float
        RMS slope of the surface, g = ⟨|∇h|²⟩^½ [1]. A profile has g²/2 only: g² = 2m₂.

    Returns
    -------
    array
        A/A_n [1].

    Notes
    -----
    Slope √(8/π) at small load. Derived check; the formula is recalled.

    References
    ----------
    Persson 2001, J. Chem. Phys. 115, 3840, doi:10.1063/1.1388626.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.reference.persson_area(1e9, E_star=1e11, g=0.1)), 9)
    0.158519419
    """
    _slope_problem(E_star, g)
    return special.erf(math.sqrt(2) * np.asarray(pressure, dtype=float) / (E_star * g))


@takes_units
def bush_gibson_thomas_area(pressure: ArrayLike, *, E_star: float, g: float) -> Array:
    r"""Bush, Gibson and Thomas' real area in the limit of vanishing load.

    .. math:: A/A_n \to \sqrt{2\pi}\,\frac{p}{E^* g}

    Parameters
    ----------
    pressure, E_star, g
        As in `persson_area`.

    Returns
    -------
    array
        A/A_n [1].

    Notes
    -----
    An asymptote, reached at very small load, later the larger the bandwidth α; the full integral
    is not here. Boundary-element solutions lie between it and Persson.

    References
    ----------
    Bush, Gibson, Thomas 1975, Wear 35, 87, doi:10.1016/0043-1648(75)90145-3. Seen in public text,
    the paper not.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.reference.bush_gibson_thomas_area(1e6, E_star=1e11, g=0.1)), 9)
    0.000250663
    """
    _slope_problem(E_star, g)
    p = np.asarray(pressure, dtype=float)
    return BUSH_GIBSON_THOMAS_SLOPE * p / (E_star * g)


class EllipticHertz(NamedTuple):
    """An elastic contact of principal radii R′ ≥ R″, in units of R_g = √(R′R″)."""

    k: float
    """Axis ratio a_y/a_x ≤ 1 of the contact."""
    K: float
    """Complete elliptic integral of the first kind, parameter 1 − k²."""
    R_A: float
    """A = π R_A ω, over R_g."""
    root_R_F: float
    """F = (4/3) E* √R_F ω^(3/2), √(R_F/R_g)."""
    yield_factor: float
    """ω at mean pressure p over (p/E*)² R_g."""


@cache
def elliptic_hertz(ratio: float) -> EllipticHertz:
    r"""The elastic contact of an elliptic asperity with a flat, exactly.

    .. math:: \lambda = R'/R'' = \frac{R_D(0,1,k^2)}{R_D(0,k^2,1)}

    with Carlson's integrals, which do not cancel near the circle or the line.

    Parameters
    ----------
    ratio : float
        λ = R′/R″ ≥ 1 [1].

    Returns
    -------
    EllipticHertz

    References
    ----------
    Johnson 1985, Contact Mechanics, ch. 4; Carlson 1995, Numer. Algorithms 10, 13,
    doi:10.1007/BF02198293.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(tb.asperity.elliptic_hertz(4.0).R_A, 5)
    0.97555
    """
    k = 1.0
    if ratio > 1:
        from scipy.optimize import brentq

        def excess(log_k: float) -> float:
            kk = math.exp(2 * log_k)
            return math.log(elliprd(0, 1, kk) / elliprd(0, kk, 1) / ratio)

        k = math.exp(brentq(excess, -math.log(ratio) - 1e-9, 0.0, xtol=1e-16, rtol=1e-15))
    return EllipticHertz(*(float(value) for value in _of_axes(ratio, k)))


def _of_axes(ratio, k):
    """The fields of `EllipticHertz` from λ and the axes' ratio k, numbers or arrays."""
    K = elliprf(0, k * k, 1)
    D = elliprd(0, k * k, 1) / 3
    larger = ratio**0.5  # R′/R_g
    R_A = 2 * larger * k * D / K
    root_R_F = math.pi / 2 * (2 * larger * D) ** 0.5 * K**-1.5
    return k, K, R_A, root_R_F, 9 / 4 * k * k * 2 * larger * D * K


def elliptic_hertz_rows(ratio: Array) -> EllipticHertz:
    """`elliptic_hertz` of many λ at once: fields (N,)."""
    target = np.log(ratio)

    def excess(log_k: Array) -> Array:
        kk = np.exp(2 * log_k)
        return np.log(elliprd(0, 1, kk) / elliprd(0, kk, 1)) - target

    # between 3/2 and 2 of ln λ for each unit of −ln k: secants, each λ until it is met
    old, log_k = -target / 2, -target / 1.6
    before, now = excess(old), excess(log_k)
    for _ in range(20):
        rest = np.abs(now) > 2e-15
        if not rest.any():
            break
        with np.errstate(invalid="ignore", divide="ignore"):
            step = now * (log_k - old) / (now - before)
        step = np.where(rest & np.isfinite(step), step, 0.0)
        old, before = log_k, now
        log_k = np.clip(log_k - step, -target, 0.0)
        now = excess(log_k)
    return EllipticHertz(*_of_axes(ratio, np.exp(log_k)))
