r"""Steady states: of a stock that protects itself, of one unknown, and what R_0 means in words.

Numbers n of particles by class follow :math:`\dot n = r + g_0 + (\mathcal G - \mathcal L)\,n`;
`thirdbody.systems.life.linear_flow` has the next-generation matrix
:math:`\mathcal G\mathcal L^{-1}` and its spectral radius R_0. Below R_0 = 1 there is one steady
state, and it is stable.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.record import Record
from ...quantities.say import number

__all__ = [
    "ContactStock",
    "SteadyPoint",
    "contact_stock",
    "describe_reproduction",
    "find_steady_points",
]


def __dir__() -> list[str]:
    return sorted(__all__)


MATTERS = 0.3
"""R_0 above which hardness and sizes of debris decide the answer."""


@takes_units
def describe_reproduction(R0: float, *, why: str = "") -> str:
    """What a reproduction number means, in words.

    Parameters
    ----------
    R0 : float
        Particles bred by one particle before it is removed [1].
    why : str, optional
        Why it is 0, or not known.

    Examples
    --------
    >>> from thirdbody.systems.life.steady import describe_reproduction
    >>> describe_reproduction(7e-5)[:53]
    'one particle of debris breeds 7×10⁻⁵ others before it'
    >>> describe_reproduction(0.0, why="there is none")
    'debris makes no new debris (R₀ = 0): there is none'
    >>> describe_reproduction(0.998)[:93]
    'one particle of debris breeds about 1 other before it is removed (R₀), about as many as are r'
    """
    if math.isnan(R0):
        why = why or "some particles are never removed"
        return f"how many others one particle of debris breeds (R₀) has no number: {why}"
    if R0 == 0:
        why = why or "it does not wear the surfaces"
        return f"debris makes no new debris (R₀ = 0): {why}"
    near = float(f"{R0:.2g}") == 1.0
    others = "about 1 other" if near else f"{number(R0, 2)} others"
    breeds = f"one particle of debris breeds {others} before it is removed (R₀)"
    breeds += ", about as many as are removed" if near else ""
    if R0 >= 1:
        return f"{breeds}: at these rates wear feeds itself without end"
    if R0 > MATTERS:
        return f"{breeds}: debris matters; give its hardness and sizes, which decide it"
    return f"{breeds}: wear does not feed itself"


# ------------------------------------------------------------------ a stock in the contact
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class ContactStock(Record):
    """Debris in a dry contact that its own stock protects; made by `contact_stock`.

    Examples
    --------
    >>> from thirdbody.systems.life.steady import contact_stock
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


@takes_units
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
    >>> from thirdbody.systems.life.steady import contact_stock
    >>> found = contact_stock(1e-6, capacity=2e-4, residence=100.0)
    >>> found.flow < 1e-6
    True
    """
    values = {"source": source, "capacity": capacity, "residence": residence}
    if wrong := [
        Problem(name, "must be finite and > 0", repr(value), code=Mistake.RANGE)
        for name, value in values.items()
        if not (math.isfinite(value) and value > 0)
    ]:
        raise InvalidValue(*wrong)
    stock = source * residence / (1 + source * residence / capacity)
    rate = 1 / residence + source / capacity
    return ContactStock(stock=stock, time=1 / rate, flow=stock / residence)


# ------------------------------------------------------------------ all steady states
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class SteadyPoint(Record):
    """A steady state of one unknown; found by `find_steady_points`.

    Examples
    --------
    >>> from thirdbody.systems.life.steady import find_steady_points
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


@takes_units
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
    >>> from thirdbody.systems.life.steady import find_steady_points
    >>> found = find_steady_points(lambda x: 0.05 - x + 2 * x**2 / (1 + x**2), low=0.0, high=3.0)
    >>> len(found), [each.stable for each in found]
    (3, [True, False, True])
    """
    from scipy.optimize import brentq

    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        rule = f"must be below high = {high!r}, both finite"
        raise InvalidValue(Problem("low", rule, repr(low), code=Mistake.ORDER))
    x = np.linspace(low, high, nodes + 1)
    y = np.array([balance(float(value)) for value in x])
    places: list[float] = [float(x[i]) for i in np.flatnonzero(y == 0)]
    for i in np.flatnonzero(y[:-1] * y[1:] < 0):
        places.append(brentq(balance, x[i], x[i + 1], xtol=1e-15 * (high - low), rtol=1e-15))
    step = 1e-6 * (high - low)
    return [
        SteadyPoint(
            value=place, rate=float(balance(place + step) - balance(place - step)) / (2 * step)
        )
        for place in sorted(places)
    ]
