r"""Numbers that flow with constant rates: their exact course, steady state, and reproduction.

.. math:: V\frac{dn}{dt} = s - L n + \mathcal{G} n

Without births every class runs alone, and with the time :math:`d\tau = dt/V` everything is a sum of
exponentials, also while the volume changes.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Flowing", "dirt_gain", "flowing", "generations", "reproduction", "steady_numbers"]


def __dir__() -> list[str]:
    return sorted(__all__)


TERMS = 16
"""Least number of terms of the series of the divided difference."""
NEAR = 0.5
"""Exponents below which the series is summed."""


class Flowing(NamedTuple):
    """Particles after a time; made by `flowing`.

    Examples
    --------
    >>> from thirdbody.systems.life.linear_flow import flowing
    >>> found = flowing(0.2, numbers=1e6, growth=0.0, source=0.0, loss=1e-3, time=200.0)
    >>> round(float(found.numbers))
    367879
    """

    numbers: Array
    """In the oil [1]."""
    passed: Array
    r"""∫ n dt, what went out per flow [1 s/m³]."""


def _phi(z: Array) -> Array:
    """(e^z − 1)/z, 1 at 0."""
    safe = np.where(z == 0, 1.0, z)
    return np.where(z == 0, 1.0, np.expm1(safe) / safe)


def _divided_difference(a: Array, b: Array) -> Array:
    r"""Divided difference of exp at 0, a, b: ∫₀¹ u φ₁(a u) e^{b (1−u)} du, for a <= 0."""
    a, b = np.broadcast_arrays(a, b)
    # Σ h_j(a, b)/(j + 2)!, h_j the complete homogeneous polynomials
    near = np.where(np.abs(a) < NEAR, a, 0.0)
    power, h, series, factorial = np.ones_like(near), np.ones_like(near), np.zeros_like(near), 2.0
    for j in range(TERMS + math.ceil(6 * float(np.max(np.abs(b), initial=0.0)))):
        series = series + h / factorial
        power = power * b
        h = near * h + power
        factorial *= j + 3
    far = np.where(np.abs(a) < NEAR, -1.0, a)
    # exp[0, a, b] = (exp[0, b] − exp[a, b])/(0 − a), exp[a, b] = e^b φ(a − b)
    closed = (np.exp(b) * _phi(far - b) - _phi(b)) / far
    return np.where(np.abs(a) < NEAR, series, closed)


@takes_units
def flowing(
    volume: float,
    *,
    numbers: ArrayLike,
    growth: float,
    source: ArrayLike,
    loss: ArrayLike,
    time: ArrayLike,
) -> Flowing:
    r"""Particles in an oil after a time, with constant source and flows.

    .. math:: \frac{dN}{dt} = s - L\frac{N}{V}, \qquad V = V_0 + \dot V t

    Parameters
    ----------
    volume : float
        V_0 [m³].
    numbers : array
        Particles in the oil at the beginning N [1].
    growth : float
        dV/dt [m³/s].
    source : array
        Particles that come per time s [1/s].
    loss : array
        Oil from which they are taken per time L [m³/s], not below −dV/dt.
    time : array
        Since the beginning [s], above the first axis of the numbers.

    Returns
    -------
    Flowing

    Notes
    -----
    With τ = ln(V/V_0)/(dV/dt), N = N_0 e^{−Lτ} + s V τ φ(−(L + dV/dt)τ), φ(z) = (e^z − 1)/z. Exact
    but for rounding.
    """
    N, s, L = (np.asarray(values, float) for values in (numbers, source, loss))
    t = np.asarray(time, float)
    grown = growth * t / volume
    tau = t / volume * np.where(grown == 0, 1.0, np.log1p(grown) / np.where(grown == 0, 1, grown))
    now = volume * (1 + grown)
    out = N * np.exp(-L * tau) + s * now * tau * _phi(-(L + growth) * tau)
    passed = N * tau * _phi(-L * tau) + s * volume * tau**2 * _divided_difference(
        -L * tau, growth * tau
    )
    return Flowing(out, passed)


# ------------------------------------------------------------------------------ births
@takes_units
def steady_numbers(losses: ArrayLike, *, births: ArrayLike, source: ArrayLike) -> Array:
    r"""Numbers that no longer change, n* = (𝓛 − 𝒢)⁻¹ s.

    Parameters
    ----------
    losses, births : array (J, J)
        𝓛 and 𝒢, of class j in column j [1/s].
    source : array (J,)
        s [1/(m³ s)].

    Returns
    -------
    array (J,)
        [1/m³]; NaN where each particle breeds one or more, R₀ ≥ 1, or some are never taken out.

    Examples
    --------
    >>> from thirdbody.systems.life.linear_flow import steady_numbers
    >>> losses = [[1e-3, 0], [0, 5e-4]]
    >>> steady_numbers(losses, births=[[0, 0], [3e-5, 1e-4]], source=[1e5, 0]).round().tolist()
    [100000000.0, 7500000.0]
    """
    L, G = _matrices(losses, births)
    some = np.asarray(source, float)
    if some.shape != L.shape[:1]:
        raise InvalidValue(
            Problem(
                "source", f"must have a number for each of {len(L)} classes", code=Mistake.SHAPE
            )
        )
    if reproduction(losses, births=births) >= 1:
        return np.full_like(some, math.nan)
    try:
        return np.asarray(np.linalg.solve(L - G, some), dtype=float)
    except np.linalg.LinAlgError:
        return np.full_like(some, math.nan)


def _matrices(losses: ArrayLike, births: ArrayLike) -> tuple[Array, Array]:
    """Both matrices, if they are square and of one size."""
    L, G = np.asarray(losses, float), np.asarray(births, float)
    if L.ndim != 2 or L.shape[0] != L.shape[1]:
        raise InvalidValue(Problem("losses", "must be a square matrix", code=Mistake.SHAPE))
    if G.shape != L.shape:
        raise InvalidValue(
            Problem("births", "must be a matrix of the size of losses", code=Mistake.SHAPE)
        )
    return L, G


@takes_units
def generations(losses: ArrayLike, *, births: ArrayLike) -> Array:
    r"""Next-generation matrix 𝒢𝓛⁻¹ [1]: daughters of class i of a particle of class j.

    Parameters
    ----------
    losses, births : array (J, J)
        𝓛 and 𝒢, of class j in column j [1/s].

    Raises
    ------
    InvalidValue
        Particles that breed and never leave.

    References
    ----------
    Diekmann, Heesterbeek, Metz 1990, J. Math. Biol. 28, 365, doi:10.1007/BF00178324.
    """
    L, G = _matrices(losses, births)
    if not np.any(G):
        return np.zeros_like(L)
    try:
        return np.asarray(np.linalg.solve(L.T, G.T).T, dtype=float)
    except np.linalg.LinAlgError:
        rule = "let particles stay for ever that breed others; give a filter, settling or a leak"
        raise InvalidValue(Problem("losses", rule, code=Mistake.BEYOND)) from None


@takes_units
def reproduction(losses: ArrayLike, *, births: ArrayLike) -> float:
    r"""Particles bred by one before it is removed, R₀ = ρ(𝒢𝓛⁻¹) [1].

    Parameters
    ----------
    losses, births : array (J, J)
        𝓛 and 𝒢, of class j in column j [1/s].

    References
    ----------
    Diekmann, Heesterbeek, Metz 1990, J. Math. Biol. 28, 365, doi:10.1007/BF00178324.

    Examples
    --------
    >>> from thirdbody.systems.life.linear_flow import reproduction
    >>> round(reproduction([[1e-3, 0], [0, 5e-4]], births=[[0, 0], [3e-5, 1e-4]]), 12)
    0.2
    """
    return float(np.max(np.abs(np.linalg.eigvals(generations(losses, births=births))), initial=0.0))


@takes_units
def dirt_gain(losses: ArrayLike, *, births: ArrayLike, source: ArrayLike) -> float:
    """Particles in the steady state over those without births [1], 1/(1 − R₀) of one class.

    Parameters
    ----------
    losses, births : array (J, J)
        𝓛 and 𝒢, of class j in column j [1/s].
    source : array (J,)
        s [1/(m³ s)].

    Returns
    -------
    float
        1 without births; NaN where there is no steady state: see `steady_numbers`.
    """
    if not np.any(births):
        return 1.0
    none = np.zeros_like(_matrices(losses, births)[1])
    alone = steady_numbers(losses, births=none, source=source)
    return float(np.sum(steady_numbers(losses, births=births, source=source)) / np.sum(alone))
