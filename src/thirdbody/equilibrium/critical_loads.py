"""Critical loads of many contacts at once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..errors import InvalidValue
from ..quantities.carried import takes_units
from .load_scan import load_scan
from .modes import EPS_1, EPS_2, WINDOW, CriticalStatus
from .states import FEWEST, carries, state_columns, varied
from .status import DEEPEST

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]

__all__ = ["CRITICAL", "carrying", "critical_loads", "load_falls"]

CRITICAL = ("F_cr1", "F_cr2", "F_tpca.A", "F_tpca.B")
NODES, AT_ONCE = 25, 8_192
"""Separations at which shares are known before crossings are refined, and samples at a time."""
EXACT = 1e-7
"""Tolerance of a crossing, over the range of separations; 3e-6 of the load."""
EXACT_PEAK = 1e-4


@takes_units
def critical_loads(
    contact: Contact, *, vary: Mapping[str, ArrayLike], count: int
) -> dict[str, tuple[Array, NDArray[np.str_]]]:
    r"""Critical loads of many contacts at once, as `transitions` defines them.

    .. math:: \ln\frac{A_{sa}}{A_{ss}}(d) = \ln\frac{1-\epsilon_1}{\epsilon_1}
              \ \text{at}\ F_{cr1}, \qquad \ln\frac{\epsilon_2}{1-\epsilon_2}\ \text{at}\ F_{cr2}

    Parameters
    ----------
    contact : Contact
        The inputs that do not vary.
    vary : mapping
        Dotted names of inputs and their values (N,), as in `solve_states`.
    count : int
        N.

    Returns
    -------
    dict
        For "F_cr1", "F_cr2", "F_tpca.A" and "F_tpca.B" the loads F* (N,) and their statuses
        (N,), the words of `transitions`. A load below the window of 1e-8 to 1e-2 is 0, one above
        it ∞, one that does not exist NaN.

    Raises
    ------
    InvalidValue
        No particles, or a law whose load does not fall with the separation.

    Notes
    -----
    Shares at 25 separations from F* = 1e-8 to 1e-2; crossings of a cubic spline through them,
    corrected by Newton's method and, where that does not do, by Chandrupatla's, on all contacts
    together. Relative error 1e-5 (F_tpca.A: 1e-3) against `transitions`. F_tpca.C, which
    `transitions` takes from a grid of loads, has no distribution worth the name and is left out.

    References
    ----------
    Chandrupatla 1997, Adv. Eng. Softw. 28, 145, doi:10.1016/S0965-9978(96)00051-8.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> vary = {"roughness.sigma": np.linspace(90e-9, 110e-9, 21)}
    >>> loads, status = critical_loads(contact, vary=vary, count=21)["F_cr1"]
    >>> bool(np.all(np.diff(loads) < 0)), str(status[0])
    (True, 'found')
    """
    if not (isinstance(count, (int, np.integer)) and count > 0):
        raise InvalidValue(f"count = {count!r} must be a whole number above 0")
    contact, vary = carrying(contact, vary)
    if contact.two_body:
        raise InvalidValue("a contact without particles has no critical loads")
    if not load_falls(contact):
        raise InvalidValue(
            "critical loads of many contacts need a load that falls with the separation, which "
            f"{type(contact.particle_law).__name__} does not promise; name other outputs, or call "
            "transitions for each"
        )
    arrays = {name: np.broadcast_to(np.asarray(v, float), count) for name, v in vary.items()}
    parts = [
        _critical_loads(contact, {n: v[start : start + AT_ONCE] for n, v in arrays.items()}, size)
        for start in range(0, count, AT_ONCE)
        for size in [min(AT_ONCE, count - start)]
    ]
    return {
        name: (
            np.concatenate([part[name][0] for part in parts]),
            np.concatenate([part[name][1] for part in parts]),
        )
        for name in CRITICAL
    }


def load_falls(contact: Contact) -> bool:
    """Whether the load falls with the separation, here and as far as the law of particles tells."""
    bound = interface(contact)
    return load_scan(bound).monotone and (bound.particles is None or bound.particles.monotone)


class Shares:
    """Shares of many contacts, each between a highest (t = 0) and a lowest separation (t = 1)."""

    def __init__(self, contact: Contact, vary: Arrays, count: int):
        self.contact, self.vary, self.count = contact, vary, count
        first, last = (self._solve(F_star=np.full(count, F)) for F in WINDOW)
        own = {name: values for name, values in vary.items() if name.startswith("roughness.")}
        rough = contact.with_arrays(own).roughness if own else contact.roughness
        # a load that no contact carries is replaced by the deepest one that the model knows
        deepest = rough.y_s - (first["h"] - first["d"]) + DEEPEST * rough.sigma_s
        self.top = np.asarray(first["d"], float)
        self.bottom = np.where(np.isnan(last["d"]), deepest, last["d"])
        if contact.asperity_law.of_surface:
            self.bottom = np.maximum(self.bottom, self._ends(np.flatnonzero(np.isnan(last["d"]))))

    def _ends(self, which: NDArray[np.intp]) -> Array:
        """Lowest separation of a law of the whole surface, whose end depends on the contact."""
        out = np.full(self.count, -np.inf)
        for i in which.tolist():
            own = {name: values[i].item() for name, values in self.vary.items()}
            out[i] = (
                interface(varied(self.contact, own)).lowest + 1e-9 * self.contact.roughness.sigma
            )
        return out

    def _solve(self, **given: Any) -> Arrays:
        return state_columns(self.contact, **given, vary=self.vary or None)

    def at(self, t: Array, which: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """ln A_sa/A_ss, ln F_sa/F_ss and F* of contacts ``which`` (M,) at t (M,)."""
        count = len(t)
        if count < FEWEST:  # the compiled engine takes no fewer
            others = np.setdiff1d(np.arange(self.count), which)[: FEWEST - count]
            t, which = np.append(t, np.full(len(others), 0.5)), np.append(which, others)
        d = self.top[which] + t * (self.bottom[which] - self.top[which])
        vary = {name: values[which] for name, values in self.vary.items()}
        states = state_columns(self.contact, d=d, vary=vary or None)
        return (
            _log_ratio(states["A_sa"], states["A_ss"])[:count],
            _log_ratio(states["F_sa_star"], states["F_ss_star"])[:count],
            states["F_star"][:count],
        )

    def load(self, t: Array, which: NDArray[np.intp]) -> Array:
        return self.at(t, which)[2]


def _log_ratio(one: Array, other: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.clip(np.log(one) - np.log(other), -1500.0, 1500.0)


def _critical_loads(
    contact: Contact, vary: Arrays, count: int
) -> dict[str, tuple[Array, NDArray[np.str_]]]:
    shares = Shares(contact, vary, count)
    every = np.arange(count)
    t = np.linspace(0.0, 1.0, NODES)
    grid = shares.at(np.tile(t, count), np.repeat(every, NODES))
    area, load = (values.reshape(count, NODES) for values in grid[:2])
    lost = np.isnan(shares.top)

    def load_at(
        rows: NDArray[np.bool_], cell: NDArray[np.intp], column: int, level: float
    ) -> tuple[Array, NDArray[np.intp]]:
        """F* at which a share has its level between nodes ``cell`` and the next."""
        which = np.flatnonzero(rows & ~lost)
        if not len(which):
            return np.empty(0), which
        return _crossing(shares, t, (area, load)[column], which, cell[which], column, level), which

    def entry(
        cases: Sequence[tuple[NDArray[np.bool_], CriticalStatus, float]], loads: tuple[Array, Any]
    ) -> tuple[Array, NDArray[np.str_]]:
        value, status = np.full(count, np.nan), np.full(count, CriticalStatus.FOUND, dtype="<U12")
        value[loads[1]] = loads[0]
        for rows, word, number in (*cases, (lost, CriticalStatus.NONE, np.nan)):
            value[rows], status[rows] = number, word
        return value, status

    out = {}
    level = math.log((1 - EPS_1) / EPS_1)
    below = area < level
    never, always = below[:, 0], np.all(~below, axis=1)
    cell = np.maximum(np.argmax(below, 1) - 1, 0)
    out["F_cr1"] = entry(
        [(never, CriticalStatus.NEVER_P_S, 0.0), (always, CriticalStatus.ALWAYS_P_S, np.inf)],
        load_at(~never & ~always, cell, 0, level),
    )
    level = math.log(EPS_2 / (1 - EPS_2))
    above = area >= level
    last = NODES - 1 - np.argmax(above[:, ::-1], 1)
    none, end = np.all(~above, axis=1), above[:, -1]
    out["F_cr2"] = entry(
        [(none, CriticalStatus.ALWAYS_S_S, 0.0), (end, CriticalStatus.NEVER_S_S, np.inf)],
        load_at(~none & ~end, last, 0, level),
    )
    out["F_tpca.A"] = _peak(shares, area, t, lost, entry)
    above = load >= 0
    changes = above[:, 1:] != above[:, :-1]
    last = NODES - 2 - np.argmax(changes[:, ::-1], 1)
    none = np.all(~changes, axis=1)
    out["F_tpca.B"] = entry([(none, CriticalStatus.NONE, np.nan)], load_at(~none, last, 1, 0.0))
    return out


def _crossing(
    shares: Shares,
    t: Array,
    grid: Array,
    which: NDArray[np.intp],
    cell: NDArray[np.intp],
    column: int,
    level: float,
) -> Array:
    """F* of contacts ``which`` at which a share, known on a grid, has its level in a cell."""
    from scipy.interpolate import CubicSpline
    from scipy.optimize import elementwise

    low, high = t[cell], t[np.minimum(cell + 1, NODES - 1)]
    spline = CubicSpline(t, grid[which], axis=1).c[:, cell, np.arange(len(which))]
    coefficients = spline - np.array([0.0, 0.0, 0.0, level])[:, None]
    start = elementwise.find_root(
        lambda x, a, b, c, d: ((a * x + b) * x + c) * x + d,
        (np.zeros(len(which)), high - low),
        args=tuple(coefficients),
    ).x
    start = np.where(np.isfinite(start), start, 0.5 * (high - low))
    a, b, c, _ = coefficients
    slope = (3 * a * start + 2 * b) * start + c
    miss = shares.at(low + start, which)[column] - level
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.clip(low + start - miss / slope, low, high)
    x = np.where(np.isfinite(x), x, low + start)
    at = shares.at(x, which)
    F = at[2]
    rest = np.flatnonzero(~(np.abs(at[column] - level) <= EXACT * np.abs(slope)))
    if len(rest):
        answer = elementwise.find_root(
            lambda x, i: shares.at(x, i.astype(np.intp))[column] - level,
            (low[rest], high[rest]),
            args=(which[rest].astype(float),),
            tolerances={"xatol": EXACT},
        )
        root = np.where(answer.success, answer.x, x[rest])
        F[rest] = shares.load(root, which[rest])
    return F


def _peak(
    shares: Shares, area: Array, t: Array, lost: NDArray[np.bool_], entry: Any
) -> tuple[Array, NDArray[np.str_]]:
    """The load of the largest area share, where the share falls on both sides."""
    from scipy.optimize import elementwise
    from scipy.special import expit

    top = np.argmax(area, axis=1)
    size, rows = expit(area), np.arange(len(area))
    ends = np.maximum(size[:, 0], size[:, -1])
    good = (top > 0) & (top < NODES - 1) & (ends <= 0.9 * size[rows, top])
    good &= (size[rows, top] >= 1e-6) & ~lost
    which = np.flatnonzero(good)
    answer = elementwise.find_minimum(
        lambda x, i: -shares.at(x, i.astype(np.intp))[0],
        tuple(t[top[which] + side] for side in (-1, 0, 1)),
        args=(which.astype(float),),
        tolerances={"xatol": EXACT_PEAK},
    )
    return entry([(~good, CriticalStatus.NONE, np.nan)], (shares.load(answer.x, which), which))


def carrying(contact: Contact, vary: Mapping[str, Any]) -> tuple[Contact, dict[str, Any]]:
    """The contact without outputs, and of what varies that which decides how it carries load."""
    return contact.replace(outputs=()), {name: v for name, v in vary.items() if carries(name)}
