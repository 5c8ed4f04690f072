"""Critical loads between contact modes, and the turning point of the contact area."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from ..contact.contact import Contact
from ..contact.interface import interface
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.arguments import need_one
from ..quantities.carried import takes_units
from ..quantities.notebook import Card, Row, words_of
from ..quantities.record import Record, TableRecord, Variable, column, declared_columns
from ..version import __version__
from .columns import COLUMNS
from .load_scan import load_scan
from .modes import EPS_1, EPS_2, WINDOW, Basis, CriticalStatus, need_shares
from .words import happens

__all__ = ["Critical", "Transitions", "TurningPoint", "transitions"]

Array = NDArray[np.float64]
Share = Callable[[Array], Array]


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Critical(Record):
    """A load F* [1] where something changes, or why there is none.

    Attributes
    ----------
    value : float or None
        F* = F/(A_n E_ss) [1]; None where there is none.
    status : str
        "found", "jump", or why there is none, as `transitions` lists them.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.results.Critical(value=7.15e-06, status="found").to_dict()
    {'value': 7.15e-06, 'status': 'found'}
    """

    value: float | None = column("F*", "1", "load where something changes")
    status: str = column("", "", "found, or why there is no load")


@dataclass(frozen=True, eq=False, slots=True)
class TurningPoint(Record):
    """The turning point of the contact area by three definitions; they differ by factors of 1–3.

    The paper (Horng et al. 2022, doi:10.3390/lubricants10070164) gives it no formula.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> point = tb.transitions(contact).F_tpca
    >>> point.A.status, f"{point.B.value:.2e}"
    ('none', '1.62e-04')
    """

    A: Critical
    """Largest particle share, where the share falls on both sides (the paper's recurrence)."""
    B: Critical
    """Asperities and particles carry equal loads."""
    C: Critical
    """Strongest bend of ln A_t against ln F* in the hybrid mode."""


@dataclass(frozen=True, eq=False, slots=True)
class Transitions(TableRecord):
    """Critical loads F* [1] and turning point of one contact; made by `transitions`.

    As labelled data and as a table they lie along ``transition``: load and status of each.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> found = tb.transitions(contact)
    >>> f"{found.F_cr1.value:.2e}", found.F_cr2.status
    ('4.72e-06', 'never s-s')
    """

    F_cr1: Critical
    """From it on asperities come into contact (p-s to hybrid)."""
    F_cr2: Critical
    """From it on particles have little of the contact left (hybrid to s-s)."""
    F_tpca: TurningPoint
    """Turning point of the contact area, by three definitions."""

    def entries(self) -> dict[str, Critical]:
        """Critical loads by name, those of the turning point as ``F_tpca.A``."""
        turning = {f"F_tpca.{name}": getattr(self.F_tpca, name) for name in ("A", "B", "C")}
        return {"F_cr1": self.F_cr1, "F_cr2": self.F_cr2} | turning

    def variables(self) -> dict[str, Variable]:
        """Load and status of each; NaN where there is no load."""
        loads = self.entries().values()
        values = [np.nan if load.value is None else load.value for load in loads]
        about = declared_columns(Critical)["status"].labels
        return {
            "F_star": Variable(("transition",), values, COLUMNS["F_star"].labels),
            "status": Variable(("transition",), [load.status for load in loads], about),
        }

    def coordinates(self) -> dict[str, Variable]:
        """The name of each, and what happens there."""
        names = list(self.entries())
        return {
            "transition": Variable(("transition",), names),
            "meaning": Variable(("transition",), [happens(name) for name in names]),
        }

    def attributes(self) -> dict[str, str]:
        """The version of the library."""
        return {"version": __version__}

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: each load, its status, and what it is."""
        rows = [
            Row(name, [words_of(load.value), load.status], happens(name))
            for name, load in self.entries().items()
        ]
        yield Card("Transitions, F* = F/(A_n E_ss)", rows)


@takes_units
def transitions(
    contact: Contact,
    *,
    window: tuple[float, float] = WINDOW,
    eps_1: float = EPS_1,
    eps_2: float = EPS_2,
    basis: Basis = "area",
) -> Transitions:
    r"""Loads at which the contact changes its mode, and its turning point.

    With S(F) the particle share (A_sa/A_t, or F_sa/F_t with ``basis="load"``):

    - F_cr1, p-s to hybrid: the smallest load at which S falls below 1 − ε_1;
    - F_cr2, hybrid to s-s: the load above which S stays below ε_2;
    - F_tpca: A, the interior maximum of S with S below 0.9 of it on both sides; B, equal loads
      on asperities and particles; C, the strongest bend of ln A_t over ln F* in hybrid mode.

    Parameters
    ----------
    contact : Contact
    window : (float, float), optional
        Loads F* searched [1]; loads that the model cannot carry are left out.
    eps_1, eps_2 : float, optional
        Thresholds ε_1 (read-off resolution of "100 %") and ε_2 (the paper's 95 %).
    basis : {"area", "load"}, optional
        Which share; the paper uses the area.

    Returns
    -------
    Transitions
        Each load with a status: ``found``; ``jump`` (the share jumps over the threshold, which
        happens where the load is not monotone in d); ``never p-s``, ``always p-s``,
        ``always s-s``, ``never s-s``; ``none``.

    Notes
    -----
    A scan of 200 loads, refined around each crossing to 1e-9 of the load.

    C is read off a curve that is nearly straight, with two bends of opposite sign: where asperities
    begin to carry (dust in a ball screw, F* = 5e-5: +0.030 by `ZMC`, +0.014 by `Field`) and where
    particles cease to (5e-4: −0.035, −0.011). Which of the two is larger changes with the law, and
    C with it by a factor of ten, while B changes by 9 %.

    References
    ----------
    Horng et al. 2022, section 3, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> tb.transitions(contact).F_cr1.status
    'found'
    """
    low, high = (float(load) for load in window)
    if not 0 < low < high:
        raise InvalidValue(
            Problem(
                "window",
                "must be two loads F* with 0 < first < second",
                repr(window),
                code=Mistake.ORDER,
            )
        )
    need_one("basis", basis, *get_args(Basis))
    need_shares(eps_1=eps_1, eps_2=eps_2)
    if contact.two_body:
        none = Critical(value=None, status=CriticalStatus.NONE)
        two_body = TurningPoint(none, none, none)
        return Transitions(
            Critical(value=None, status=CriticalStatus.NEVER_P_S),
            Critical(value=0.0, status=CriticalStatus.ALWAYS_S_S),
            two_body,
        )

    contact_interface = interface(contact.replace(outputs=()))
    scan = load_scan(contact_interface)
    carried = np.exp([scan.log_F[0], scan.log_F.max()]) / contact.E_ss
    low, high = max(low, 1.0001 * carried[0]), min(high, 0.9999 * carried[1])
    if low >= high:
        none = Critical(value=None, status=CriticalStatus.NOT_CARRIED)
        return Transitions(none, none, TurningPoint(none, none, none))

    def states(loads: Array) -> tuple[Array, Array, Array]:
        """Shares of area and load of the particles, and A_t: where the load jumps, below it."""
        d, _, _ = scan.solve_across_jumps(loads * contact.E_ss, "loading")
        raw = contact_interface.fields(d)
        F = raw["F_ss"] + raw["F_sa"]
        return raw["A_sa"] / raw["A_t"], raw["F_sa"] / F, raw["A_t"]

    def share(loads: Array) -> Array:
        return states(loads)[0 if basis == "area" else 1]

    def load_share(loads: Array) -> Array:
        return states(loads)[1]

    loads = np.geomspace(low, high, 200)
    area, load, A_t = states(loads)
    S = area if basis == "area" else load
    return Transitions(
        _first_critical(loads, S, share, 1 - eps_1),
        _second_critical(loads, S, share, eps_2),
        TurningPoint(
            _recurrence(loads, S, share, eps_2),
            _equal_loads(loads, load, load_share),
            _bend(loads, A_t, S, eps_1, eps_2),
        ),
    )


def _crossing(low: float, high: float, share: Share, threshold: float, *, last: bool) -> Critical:
    """The first or last load between two at which the share falls below a threshold."""
    a, b = low, high
    for _ in range(6):
        loads = np.geomspace(a, b, 33)
        below = share(loads) < threshold
        i = np.flatnonzero(~below)[-1] if last else np.flatnonzero(below)[0] - 1
        a, b = loads[i], loads[i + 1]
        if b / a - 1 < 1e-9:
            break
    step = np.ptp(share(np.array([a, b])))
    status = CriticalStatus.JUMP if step > 1e-4 else CriticalStatus.FOUND
    return Critical(value=float(np.sqrt(a * b)), status=status)


def _first_critical(loads: Array, S: Array, share: Share, threshold: float) -> Critical:
    if S[0] < threshold:
        return Critical(value=None, status=CriticalStatus.NEVER_P_S)
    below = np.flatnonzero(S < threshold)
    if not len(below):
        return Critical(value=None, status=CriticalStatus.ALWAYS_P_S)
    i = below[0]
    return _crossing(loads[i - 1], loads[i], share, threshold, last=False)


def _second_critical(loads: Array, S: Array, share: Share, threshold: float) -> Critical:
    above = np.flatnonzero(S >= threshold)
    if not len(above):
        return Critical(value=0.0, status=CriticalStatus.ALWAYS_S_S)
    i = above[-1]
    if i == len(loads) - 1:
        return Critical(value=None, status=CriticalStatus.NEVER_S_S)
    return _crossing(loads[i], loads[i + 1], share, threshold, last=True)


def _recurrence(loads: Array, S: Array, share: Share, threshold: float) -> Critical:
    peak = int(np.argmax(S))
    interior = 0 < peak < len(S) - 1
    if not interior or max(S[0], S[-1]) > 0.9 * S[peak] or S[peak] < 1e-6:
        return Critical(value=None, status=CriticalStatus.NONE)
    a, b = loads[peak - 1], loads[peak + 1]
    for _ in range(6):
        fine = np.geomspace(a, b, 33)
        top = int(np.clip(np.argmax(share(fine)), 1, 31))
        a, b = fine[top - 1], fine[top + 1]
    return Critical(value=float(np.sqrt(a * b)), status=CriticalStatus.FOUND)


def _equal_loads(loads: Array, shares: Array, load_share: Share) -> Critical:
    above = shares >= 0.5
    changes = np.flatnonzero(above[1:] != above[:-1])
    if not len(changes):
        return Critical(value=None, status=CriticalStatus.NONE)
    i = changes[-1]
    sign = 1.0 if above[i] else -1.0

    def share(loads: Array) -> Array:
        return sign * load_share(loads)

    return _crossing(loads[i], loads[i + 1], share, sign * 0.5, last=False)


def _bend(loads: Array, area: Array, S: Array, eps_1: float, eps_2: float) -> Critical:
    """Where |d²ln A_t/d(ln F)²| is largest inside the hybrid interval."""
    hybrid = np.flatnonzero((S < 1 - eps_1) & (S > eps_2))
    inside = hybrid[(hybrid > 0) & (hybrid < len(loads) - 1)]
    if not len(inside):
        return Critical(value=None, status=CriticalStatus.NONE)
    x, y = np.log(loads), np.log(area)
    bend = np.abs(y[inside + 1] - 2 * y[inside] + y[inside - 1]) / (x[1] - x[0]) ** 2
    best = inside[int(np.argmax(bend))]
    return Critical(value=float(loads[best]), status=CriticalStatus.FOUND)
