r"""Heat and current through one contact: rise under a source, spheres as bridges, conductances.

A source of heat of mean flux q̄ on a circle of radius a, at rest or moving over a half-space, warms
it by

.. math:: \Delta T = \theta(\mathrm{Pe})\,\frac{\bar q a}{k}, \qquad
          \mathrm{Pe} = \frac{v a}{2D}, \qquad D = \frac{k}{\rho c} ,

so that a body takes up :math:`G = \pi a^2\bar q/\Delta T = \pi a k/\theta` per kelvin [W/K]. Every
two-body and bridge formula below is a network of such conductances.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from scipy import special

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.arguments import need_one
from ...quantities.carried import takes_units
from .joint import (
    absolute_slope,
    cooper_mikic_yovanovich,
    cooper_mikic_yovanovich_fit,
    mikic_elastic,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = [
    "LORENZ",
    "Flux",
    "Kind",
    "absolute_slope",
    "body_conductance",
    "bridge",
    "cooper_mikic_yovanovich",
    "cooper_mikic_yovanovich_fit",
    "mikic_elastic",
    "moving_rise",
    "particle_resistance",
    "partition",
    "peclet",
    "sphere_resistance",
    "spot_resistance",
    "spreading",
    "sudden_share",
]

LORENZ = (math.pi * 1.380649e-23 / 1.602176634e-19) ** 2 / 3
"""Lorenz number of a degenerate electron gas, L = π²k_B²/3e² = 2.4430e-8 [W Ω/K²]."""

WIDEST = 1.5
"""Radius of a contact over that of the sphere from which on a sphere's formula is not asked: where
its sense ends, cones resist less than it."""
Kind = Literal["mean", "max"]
"""Temperature averaged over the contact, or the largest in it."""
Flux = Literal["uniform", "hertz"]
"""Uniform, or q = (3/2) q̄ √(1−r²/a²), proportional to the pressure of Hertz."""

_MOVING = {
    ("uniform", "max"): (2.0, 4 / math.pi),
    ("uniform", "mean"): (1.22, 0.6575),
    ("hertz", "max"): (2.32, 1.234),
    ("hertz", "mean"): (1.2720, 0.6597),
}
"""C and c in θ = C/√(π(c + Pe))."""

_SPHERE_END = {
    ("uniform", "mean"): (8 / (3 * math.pi**2), -1 / 4),
    ("uniform", "max"): (1 / math.pi, -1 / 2),
    ("hertz", "mean"): (9 / 32, -3 / 10),
    ("hertz", "max"): (3 / 8, math.log(2) - 4 / 3),
    "isothermal": (1 / 4, 2 * math.log(2) - 3 / 2),
}
"""Constriction a k R of one end, and the mean of ln(distance/a) from source to target."""


# ------------------------------------------------------------------ one half-space
@takes_units
def peclet(a: Number, *, v: float, D: float) -> Number:
    r"""Péclet number of a source that moves over a body.

    .. math:: \mathrm{Pe} = \frac{v a}{2D}, \qquad D = \frac{k}{\rho c}

    Parameters
    ----------
    a : float or array
        Radius of the source [m].
    v : float
        Its speed over the body [m/s].
    D : float
        Diffusivity of the body [m²/s].

    Returns
    -------
    float or array
        Pe [1].

    Examples
    --------
    >>> from thirdbody.effects.single.heat import peclet
    >>> round(peclet(1e-6, v=10.0, D=5e-6), 12)
    1.0
    """
    return v * a / (2 * D)


def _need_source(kind: Kind, flux: Flux) -> None:
    """Refuse words for a source of heat that are not known."""
    need_one("kind", kind, *get_args(Kind))
    need_one("flux", flux, *get_args(Flux))


@takes_units
def moving_rise(Pe: Number, *, kind: Kind = "mean", flux: Flux = "uniform") -> Number:
    r"""Steady rise under a circular source that moves, over q̄a/k [1], after Tian and Kennedy.

    .. math:: \theta = \frac{C}{\sqrt{\pi\,(c+\mathrm{Pe})}}

    =========  ====  ======  ======  ==================  ========================
    flux       kind  C       c       exact Pe → 0, ∞     error, 0 ≤ Pe < ∞
    =========  ====  ======  ======  ==================  ========================
    uniform    max   2       4/π     1, 2/√(πPe)         −0.7 to +2.3 %
    uniform    mean  1.22    0.6575  8/3π, 0.6886/√Pe    −3.8 % to 0
    hertz      max   2.32    1.234   3π/8, 1.3094/√Pe    −1.2 to +0.3 %
    hertz      mean  1.2720  0.6597  9π/32, 0.7176/√Pe   −4.6 % to 0
    =========  ====  ======  ======  ==================  ========================

    Parameters
    ----------
    Pe : float or array
        Péclet number v a/(2D) [1]; 0 at rest.
    kind : {"mean", "max"}, optional
    flux : {"uniform", "hertz"}, optional
        Uniform, or q = (3/2) q̄ √(1−r²/a²), which Tian and Kennedy call parabolic.

    Returns
    -------
    float or array
        ΔT k/(q̄ a) [1], with the mean flux q̄ of either distribution.

    Notes
    -----
    Both limits are exact; the error between them was measured against quadrature of the moving
    source. The last row is derived here: the constants 1.464 and 0.874 that go with the mean of
    the parabolic flux (from memory: not confirmed in a source) have the right limit at rest and
    are 15 % too high at large Pe. The other constants are from memory too; the limits and
    the quadrature confirm them.

    References
    ----------
    Tian and Kennedy 1994, J. Tribol. 116, 167, doi:10.1115/1.2927035; Jaeger 1942.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import moving_rise
    >>> float(moving_rise(0.0, kind="max").round(12))
    1.0
    >>> float(moving_rise(1.0).round(4))  # quadrature: 0.5554
    0.5346
    """
    _need_source(kind, flux)
    C, c = _MOVING[flux, kind]
    return C / np.sqrt(math.pi * (c + Pe))


@takes_units
def body_conductance(
    a: Number, *, k: float, D: float, v: float = 0.0, kind: Kind = "mean", flux: Flux = "uniform"
) -> Number:
    r"""Heat that a half-space takes from a contact per kelvin of its rise, G = πak/θ [W/K].

    Parameters
    ----------
    a : float or array
        Radius of the contact [m].
    k, D : float
        Conductivity [W/(m K)] and diffusivity [m²/s] of the body.
    v : float, optional
        Speed of the contact over this body [m/s].
    kind, flux : str, optional
        As in `moving_rise`, where accuracy and source stand.

    Returns
    -------
    float or array
        G [W/K].

    Examples
    --------
    >>> from thirdbody.effects.single.heat import body_conductance
    >>> f"{body_conductance(1e-6, k=50, D=1.3e-5, v=1.0):.3g} W/K"
    '0.00019 W/K'
    """
    return math.pi * a * k / moving_rise(peclet(a, v=v, D=D), kind=kind, flux=flux)


@lru_cache
def _pairs(flux: Flux, kind: Kind) -> tuple[Array, Array]:
    """Distances R/a from source to target and their weights: rise = Σ w f(R)."""
    u, w_u = np.polynomial.legendre.leggauss(200)
    phi = (u + 1) ** 2 * math.pi / 8  # dense at short distances, where early heat is
    w = w_u * (u + 1) * math.pi / 4
    if kind == "max":  # the centre: ∫ q dr
        r = np.sin(phi)
        q = 1.0 if flux == "uniform" else 1.5 * np.cos(phi)
        return r, w * np.cos(phi) * q
    R, w = 2 * np.sin(phi), 2 * w * np.cos(phi)
    if flux == "uniform":  # lens of two circles
        lens = 2 * np.arccos(R / 2) - R / 2 * np.sqrt(4 - R**2)
        return R, w * lens / math.pi
    # flux inside the target's circle, in strips along R
    highest = np.sqrt(1 - R**2 / 4)[:, None]
    y = highest * np.sin(u * math.pi / 2)
    half = np.sqrt(1 - y**2)
    start = np.clip((R[:, None] - half) / half, -1, 1)
    strip = 0.75 * half**2 * (math.pi / 2 - np.arcsin(start) - start * np.sqrt(1 - start**2))
    width = w_u * math.pi / 2 * np.cos(u * math.pi / 2) * highest
    return R, w * np.sum(strip * width, axis=1) / math.pi


@lru_cache
def _sudden_table(flux: Flux, kind: Kind) -> tuple[Array, Array]:
    """ln Fo, and ln of the share of the steady rise."""
    R, w = _pairs(flux, kind)
    ln_Fo = np.linspace(math.log(1e-6), math.log(1e8), 2001)
    share = special.erfc(R / (2 * np.exp(ln_Fo / 2)[:, None])) @ w / w.sum()
    return ln_Fo, np.log(share)


@takes_units
def sudden_share(Fo: Number, *, kind: Kind = "mean", flux: Flux = "uniform") -> Number:
    r"""Part of the steady rise that a source at rest has reached after a time t [1].

    .. math:: \frac{\Delta T(t)}{\Delta T(\infty)} =
              \frac{\int w(R)\,\mathrm{erfc}(R/2a\sqrt{\mathrm{Fo}})\,dR}{\int w(R)\,dR},
              \qquad \mathrm{Fo} = \frac{Dt}{a^2},

    with the weight w of distances R between source and target; at the centre of a uniform disc
    :math:`2\sqrt{\mathrm{Fo}}\,[1/\sqrt\pi - \mathrm{ierfc}(1/2\sqrt{\mathrm{Fo}})]`.

    Parameters
    ----------
    Fo : float or array
        Fourier number [1].
    kind, flux : str, optional
        As in `moving_rise`.

    Returns
    -------
    float or array
        Share from 0 to 1 [1].

    Notes
    -----
    Exact but for the table it is read from: 2e-5.

    References
    ----------
    Carslaw and Jaeger 1959, Conduction of Heat in Solids, sections 10.4 and 10.5.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import sudden_share
    >>> float(sudden_share(1e6, kind="max").round(4))
    0.9997
    """
    _need_source(kind, flux)
    ln_Fo, ln_share = _sudden_table(flux, kind)
    x = np.log(np.maximum(Fo, 1e-300))
    early = np.minimum(x - ln_Fo[0], 0.0) / 2  # a half-space all over: √t
    return np.exp(np.interp(x, ln_Fo, ln_share) + early)


# ------------------------------------------------------------------ two bodies and a bridge
@takes_units
def partition(Q: Number, *, G_1: Number, G_2: Number, T_1: Number, T_2: Number) -> Number:
    r"""Temperature of a contact between two bodies in which heat Q is set free.

    .. math:: T_c = \frac{Q + G_1T_1 + G_2T_2}{G_1+G_2}

    Parameters
    ----------
    Q : float or array
        Heat [W].
    G_1, G_2 : float or array
        Conductances into either body [W/K]; body 1 takes G_1/(G_1+G_2) of Q.
    T_1, T_2 : float or array
        Their temperatures far from the contact [K or °C].

    Returns
    -------
    float or array
        T_c, in the unit of T_1 and T_2.

    References
    ----------
    Blok 1937; with equal temperatures 1/ΔT = 1/ΔT_1 + 1/ΔT_2.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import partition
    >>> partition(3.0, G_1=1.0, G_2=2.0, T_1=0.0, T_2=0.0)
    1.0
    """
    return (Q + G_1 * T_1 + G_2 * T_2) / (G_1 + G_2)


@takes_units
def bridge(
    heat: tuple[Number, Number],
    *,
    G: tuple[Number, Number],
    R: Number,
    T: tuple[Number, Number] = (0.0, 0.0),
) -> tuple[Number, Number]:
    r"""Temperatures of the two ends of a particle between two bodies.

    .. math:: G_i\,(T_{ci}-T_i) + \frac{T_{ci}-T_{cj}}{R} = Q_i

    Parameters
    ----------
    heat : two floats or arrays
        Heat set free at either end [W].
    G : two floats or arrays
        Conductance into the body there [W/K].
    R : float or array
        Resistance of the particle [K/W]; inf insulates.
    T : two floats or arrays, optional
        Temperatures of the bodies far away [K or °C].

    Returns
    -------
    two floats or arrays
        T_c1 and T_c2, in the unit of T; exact solution of the two balances.

    Examples
    --------
    Heat at end 2 alone leaves through body 2, and through the particle and body 1 in series.

    >>> from thirdbody.effects.single.heat import bridge
    >>> one, two = bridge((0.0, 6.0), G=(1.0, 1.0), R=1.0)
    >>> float(one), float(two)
    (2.0, 4.0)
    """
    k = np.reciprocal(R)
    G_1, G_2 = G
    Q_1, Q_2 = heat[0] + G_1 * T[0], heat[1] + G_2 * T[1]
    whole = G_1 * G_2 + k * (G_1 + G_2)
    return ((Q_1 * (G_2 + k) + k * Q_2) / whole, (Q_2 * (G_1 + k) + k * Q_1) / whole)


@takes_units
def sphere_resistance(
    a_1: Number, *, a_2: Number, r: Number, k: float, ends: str | tuple[str, str] = "isothermal"
) -> Number:
    r"""Resistance of a sphere between contacts at its two poles [K/W].

    .. math:: R = \frac1k\sum_{i=1}^2\left[\frac{\gamma}{a_i} +
              \frac{\ln(4r/a_i) - 1 - \varepsilon}{4\pi r}\right]

    Two constrictions and, for the body between them, a logarithm. γ and ε = ⟨ln(distance/a)⟩ from
    source to target follow the flux through the ends:

    ===================  =======  ===============  ========================
    ends                 γ        ε                error at a/r = 0.1, 0.3, 0.5
    ===================  =======  ===============  ========================
    isothermal           1/4      2 ln 2 − 3/2     0.2, 2.3, 7.3 %
    (uniform, mean)      8/3π²    −1/4             0.2, 2.1, 6.6 %
    (uniform, max)       1/π      −1/2             0.2, 1.8, 5.6 %
    (hertz, mean)        9/32     −3/10            0.2, 2.0, 6.3 %
    (hertz, max)         3/8      ln 2 − 4/3       0.2, 1.7, 5.0 %
    ===================  =======  ===============  ========================

    Parameters
    ----------
    a_1, a_2 : float or array
        Radii of the contacts [m].
    r : float or array
        Radius of the sphere [m].
    k : float
        Its conductivity [W/(m K)], or 1/ρ [1/(Ω m)]. That of the bulk is too large for crystals
        of less than about 0.1 µm, whose surface scatters phonons.
    ends : {"isothermal"} or pair of flux and kind, optional

    Returns
    -------
    float or array
        R [K/W], or [Ω].

    Notes
    -----
    Derived by matched asymptotics; the error is that against the Legendre series, always to the
    high side, and grows like (a/r)²; 16 % at 0.7.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import sphere_resistance
    >>> R = sphere_resistance(0.1, a_2=0.1, r=1.0, k=1.0, ends=("uniform", "mean"))
    >>> f"{R:.3f}; series: 5.858"
    '5.872; series: 5.858'
    """
    if isinstance(ends, (list, dict, set, np.ndarray)) or ends not in _SPHERE_END:
        allowed = ", ".join(map(repr, _SPHERE_END))
        shown = f"{ends!r:.60}"
        raise InvalidValue(Problem("ends", f"must be one of {allowed}", shown, code=Mistake.OPTION))
    gamma, epsilon = _SPHERE_END[ends]
    body = (np.log(4 * r / a_1) + np.log(4 * r / a_2) - 2 - 2 * epsilon) / (4 * math.pi * r)
    return (gamma * (1 / a_1 + 1 / a_2) + body) / k


@takes_units
def particle_resistance(
    a_1: Number,
    *,
    a_2: Number,
    r: Number,
    height: Number,
    k: float,
    ends: str | tuple[str, str] = "isothermal",
) -> Number:
    r"""Resistance of a particle between contacts at its two poles, squashed or not [K/W].

    .. math:: R = \min\left[R_{sphere},\;
              \frac{h}{2\pi k\,b}\left(\frac1{a_1}+\frac1{a_2}\right)\right], \qquad
              b^2 = \frac{4r^3}{3h}+\frac{h^2}{12}

    A sphere that is squashed to the height h keeps its volume and is as wide as b in the middle:
    two cones lead from its contacts to there. Where contacts are much wider than the sphere was,
    :math:`R_{sphere}` has no sense (it falls below zero), and the cones alone count.

    Parameters
    ----------
    a_1, a_2 : float or array
        Radii of the contacts [m].
    r : float or array
        Radius of the particle before it was squashed [m].
    height : float or array
        What is left of 2r [m].
    k : float
        Its conductivity [W/(m K)], or 1/ρ [1/(Ω m)].
    ends : {"isothermal"} or pair of flux and kind, optional
        As of `sphere_resistance`.

    Returns
    -------
    float or array
        R [K/W], or [Ω].

    Notes
    -----
    Derived. Against finite elements of barrels of the sphere's volume with isothermal ends it is up
    to 11 % high, most where a/r is 0.4, 3 % at 0.9, less than 1 % from 1.3 on. Of spheres that keep
    their shape and sink in it is `sphere_resistance`, up to a/r = 0.5 and beyond.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import particle_resistance
    >>> R = particle_resistance(1.249, a_2=1.249, r=1.0, height=0.8, k=1.0)
    >>> f"{R:.4f}; finite elements: 0.1536"
    '0.1555; finite elements: 0.1536'
    """
    sphere = sphere_resistance(a_1, a_2=a_2, r=r, k=k, ends=ends)
    over_width = np.sqrt(height**3 / (4 / 3 * r**3 + height**3 / 12))
    cones = over_width / (2 * math.pi * k) * (1 / a_1 + 1 / a_2)
    return np.where(np.maximum(a_1, a_2) < WIDEST * r, np.minimum(sphere, cones), cones)[()]


# ------------------------------------------------------------------ conductance
@takes_units
def spot_resistance(
    b: Number,
    *,
    rho_1: float,
    rho_2: float,
    mean_free_path: float = 0.0,
    film: float = 0.0,
) -> Number:
    r"""Resistance of one contact spot between two half-spaces.

    .. math:: R = \Gamma(K)\,\frac{\rho_1+\rho_2}{4b} +
              \frac{4K}{3\pi b}\,\frac{\rho_1+\rho_2}{2} + \frac{\sigma_f}{\pi b^2},
              \qquad K = \frac lb, \qquad \Gamma\approx\frac{1+0.83K}{1+1.33K}

    Parameters
    ----------
    b : float or array
        Radius of the spot [m].
    rho_1, rho_2 : float
        Resistivities [Ω m], or 1/k of heat [m K/W].
    mean_free_path : float, optional
        l of what carries the current [m]; 0 is diffusive (Holm, Maxwell).
    film : float, optional
        Resistance of a surface film times its area σ_f [Ω m², or m² K/W].

    Returns
    -------
    float or array
        Resistance [Ω, or K/W].

    References
    ----------
    Wexler 1966, Proc. Phys. Soc. 89, 927, doi:10.1088/0370-1328/89/4/316; the fit of Γ is
    from memory: not confirmed in a source. Its limit, Γ(∞) = 9π²/128 = 0.694, is missed by
    10 % of a term that is then negligible.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import spot_resistance
    >>> float(spot_resistance(1e-6, rho_1=2e-7, rho_2=2e-7))
    0.1
    """
    K = mean_free_path / b
    holm = (1 + 0.83 * K) / (1 + 1.33 * K) * (rho_1 + rho_2) / (4 * b)
    sharvin = 4 * K / (3 * math.pi * b) * (rho_1 + rho_2) / 2
    return holm + sharvin + film / (math.pi * b**2)


Spreading = Literal["power", "series", "none"]
"""Factor of a spot among others: a power, a series, or 1."""


@takes_units
def spreading(epsilon: Number, *, form: Spreading = "power") -> Number:
    r"""Factor ψ on the resistance of a spot that its neighbours leave only a tube [1].

    .. math:: \psi = (1-\varepsilon)^{1.5} \quad\text{or}\quad
              1 - 1.40925\varepsilon + 0.29591\varepsilon^3 + 0.05254\varepsilon^5

    Parameters
    ----------
    epsilon : float or array
        Radius of the spot over that of its tube, √A_t [1].
    form : {"power", "series", "none"}, optional
        Cooper, Mikic and Yovanovich; isothermal spot on a tube (constants from memory: not
        confirmed in a source; the first is Roess's 1.409); or 1.

    Returns
    -------
    float or array
        ψ [1].

    References
    ----------
    Cooper, Mikic, Yovanovich 1969, Int. J. Heat Mass Transfer 12, 279,
    doi:10.1016/0017-9310(69)90011-8.

    Examples
    --------
    >>> from thirdbody.effects.single.heat import spreading
    >>> round(spreading(0.1), 4), round(spreading(0.1, form="series"), 4)
    (0.8538, 0.8594)
    """
    need_one("form", form, *get_args(Spreading))
    if form == "none":
        return 1.0 + 0.0 * epsilon
    if form == "series":
        return 1 - 1.40925 * epsilon + 0.29591 * epsilon**3 + 0.05254 * epsilon**5
    return (1 - epsilon) ** 1.5
