r"""Whether debris feeds itself: next-generation matrix, steady numbers, and every steady state.

Numbers n of particles by class follow :math:`\dot n = r + g_0 + (\mathcal G - \mathcal L)\,n`:
ingress, debris without particles, births per particle, losses per particle. One particle of class
j breeds column j of :math:`\mathcal G\mathcal L^{-1}` before it is removed, and

.. math:: R_0 = \rho(\mathcal G\mathcal L^{-1}), \qquad
          n^* = (\mathcal L-\mathcal G)^{-1}(r + g_0)

below R_0 = 1 there is one steady state, and it is stable.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValue
from ...quantities.record import Record
from ...quantities.say import number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "ContactStock",
    "Generations",
    "SteadyPoint",
    "contact_stock",
    "find_steady_points",
    "next_generation",
]

MATTERS = 0.3
"""R_0 above which hardness and sizes of debris decide the answer."""
NONE = 1e-300


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Generations(Record):
    """Who breeds whom before it is removed; made by `next_generation`.

    Examples
    --------
    >>> import numpy as np
    >>> found = next_generation(np.array([[0, 0], [3e-5, 1e-4]]), losses=np.diag([1e-3, 5e-4]),
    ...                         sources=np.array([1e5, 0.0]))
    >>> round(found.R0, 12), found.numbers.round(3).tolist()
    (0.2, [100000000.0, 7500000.0])
    """

    matrix: Array
    """𝒢𝓛⁻¹, daughters by parents [1]: (n, n)."""
    R0: float
    """Its spectral radius [1]."""
    numbers: Array
    """n* of the sources [their unit times s]: (n,); NaN from R_0 = 1 on."""
    without: Array
    """n* of the sources without births: (n,)."""

    @property
    def dirt_gain(self) -> float:
        """|n*| over |n*| without births, by number [1]; infinite from R_0 = 1 on."""
        if self.R0 >= 1:
            return math.inf
        alone = float(np.sum(self.without))
        return float(np.sum(self.numbers)) / alone if alone > 0 else math.nan

    @property
    def sentence(self) -> str:
        """What R_0 means, in words."""
        if self.R0 == 0:
            return "no particle breeds another: the debris does not wear the surfaces"
        breeds = f"one particle of debris breeds {number(self.R0, 2)} others before it is removed"
        if self.R0 >= 1:
            return f"{breeds}: at these rates wear feeds itself without end"
        if self.R0 > MATTERS:
            return f"{breeds}: debris matters; give its hardness and sizes, which decide it"
        return f"{breeds}: wear does not feed itself"


def next_generation(
    births: ArrayLike, *, losses: ArrayLike, sources: ArrayLike | None = None
) -> Generations:
    r"""Next-generation matrix, its spectral radius, and the steady numbers of given sources.

    .. math:: R_0 = \rho(\mathcal G\mathcal L^{-1})

    Parameters
    ----------
    births : array (n, n)
        𝒢, particles of class i born per time and particle of class j [1/s].
    losses : array (n, n) or (n,)
        𝓛, or its diagonal [1/s]: removal, and passage to other classes, which breaking is.
    sources : array (n,), optional
        r + g_0, what enters per time in any unit.

    Returns
    -------
    Generations

    Raises
    ------
    InvalidValue
        Shapes that do not fit, births below 0, or losses that leave a class for ever.

    References
    ----------
    Diekmann, Heesterbeek, Metz 1990, J. Math. Biol. 28, 365, doi:10.1007/BF00178324 (from memory:
    not confirmed in a source); the closed cases of the tests do not need it.

    Examples
    --------
    >>> round(next_generation([[0.3]], losses=[0.5], sources=[1.0]).dirt_gain, 12)
    2.5
    """
    G = np.asarray(births, float)
    L = np.asarray(losses, float)
    L = np.diag(L) if L.ndim == 1 else L
    if G.ndim != 2 or G.shape[0] != G.shape[1] or L.shape != G.shape:
        raise InvalidValue(f"births {G.shape} and losses {L.shape} must be square and alike")
    if np.any(G < 0) or not np.all(np.isfinite(G)):
        raise InvalidValue("births must be finite and >= 0 [1/s]")
    r = np.zeros(len(G)) if sources is None else np.asarray(sources, float)
    try:
        matrix = np.linalg.solve(L.T, G.T).T
        without = np.linalg.solve(L, r)
    except np.linalg.LinAlgError:
        raise InvalidValue(
            "losses leave some particles in the oil for ever: without a filter, settling or a "
            "drain there is no steady state"
        ) from None
    R0 = float(np.max(np.abs(np.linalg.eigvals(matrix)))) if len(G) else 0.0
    R0 = 0.0 if R0 < NONE else R0
    numbers = np.linalg.solve(L - G, r) if R0 < 1 else np.full(len(G), np.nan)
    return Generations(matrix=matrix, R0=R0, numbers=numbers, without=without)


# ------------------------------------------------------------------ a stock in the contact
@dataclass(frozen=True, slots=True, kw_only=True)
class ContactStock(Record):
    """Debris in a dry contact that its own stock protects; made by `contact_stock`.

    Examples
    --------
    >>> found = contact_stock(source=1e-6, capacity=2e-4, residence=100.0)
    >>> round(found.stock * 1e5, 5), round(found.time, 4)
    (6.66667, 66.6667)
    """

    stock: float
    """M* in the end, in the unit of the capacity."""
    time: float
    """Time constant of the approach [s]."""
    flow: float
    """Steady wear flow M*/τ, which is the steady source too."""


def contact_stock(source: float, *, capacity: float, residence: float) -> ContactStock:
    r"""Steady stock of debris where the stock itself reduces its source.

    .. math:: \dot M = s\,(1-M/M_0) - M/\tau, \qquad M^* = \frac{s\tau}{1+s\tau/M_0}

    Parameters
    ----------
    source : float
        s, debris made per time without a stock, e.g. [kg/s].
    capacity : float
        M_0, the stock at which no more is made, in that unit times s.
    residence : float
        τ [s].

    Returns
    -------
    ContactStock

    Raises
    ------
    InvalidValue
        Numbers that are not positive.

    References
    ----------
    Fillot, Iordanoff, Berthier 2007, Wear 262, 1196, doi:10.1016/j.wear.2006.10.011 (abstract):
    source and wear flow become equal and constant.

    Examples
    --------
    >>> found = contact_stock(1e-6, capacity=2e-4, residence=100.0)
    >>> found.flow < 1e-6
    True
    """
    values = {"source": source, "capacity": capacity, "residence": residence}
    if wrong := [
        f"{name} = {value!r} must be finite and > 0"
        for name, value in values.items()
        if not (math.isfinite(value) and value > 0)
    ]:
        raise InvalidValue(*wrong)
    stock = source * residence / (1 + source * residence / capacity)
    rate = 1 / residence + source / capacity
    return ContactStock(stock=stock, time=1 / rate, flow=stock / residence)


# ------------------------------------------------------------------ all steady states
@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyPoint(Record):
    """A steady state of one unknown; found by `find_steady_points`.

    Examples
    --------
    >>> [point.stable for point in find_steady_points(lambda x: x * (1 - x), low=-0.5, high=1.5)]
    [False, True]
    """

    value: float
    """The unknown there."""
    rate: float
    """Slope of the balance there, 1/s where the balance is per second: below 0 it is stable."""

    @property
    def stable(self) -> bool:
        """Whether a small change dies out."""
        return self.rate < 0

    @property
    def time(self) -> float:
        """Time constant of the approach; infinite where it is not stable."""
        return -1 / self.rate if self.stable else math.inf


def find_steady_points(
    balance: Callable[[float], float], *, low: float, high: float, nodes: int = 400
) -> list[SteadyPoint]:
    """Every zero of a balance between two ends, by scan and bracket, with its stability.

    Parameters
    ----------
    balance : callable
        dx/dt of one unknown x with every other one eliminated.
    low, high : float
        Ends of the scan, in the unit of x.
    nodes : int, optional
        Of the scan; two zeros between neighbours are not seen.

    Returns
    -------
    list of SteadyPoint
        In the order of x.

    Raises
    ------
    InvalidValue
        Ends that do not increase.

    Examples
    --------
    >>> found = find_steady_points(lambda x: 0.05 - x + 2 * x**2 / (1 + x**2), low=0.0, high=3.0)
    >>> len(found), [each.stable for each in found]
    (3, [True, False, True])
    """
    from scipy.optimize import brentq

    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise InvalidValue(f"low = {low!r} must be below high = {high!r}, both finite")
    x = np.linspace(low, high, nodes + 1)
    y = np.array([balance(float(each)) for each in x])
    places: list[Any] = [float(x[i]) for i in np.flatnonzero(y == 0)]
    for i in np.flatnonzero(y[:-1] * y[1:] < 0):
        places.append(brentq(balance, x[i], x[i + 1], xtol=1e-15 * (high - low), rtol=1e-15))
    step = 1e-6 * (high - low)
    return [
        SteadyPoint(
            value=place, rate=float(balance(place + step) - balance(place - step)) / (2 * step)
        )
        for place in sorted(places)
    ]
