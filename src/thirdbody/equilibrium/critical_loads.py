"""Critical loads of many contacts at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..errors import InvalidValue, Mistake, NotCompiled, Problem
from ..quantities.carried import takes_units
from .engine.run import lowest_separations
from .load_scan import load_scan
from .modes import WINDOW, CriticalStatus
from .share_splines import LEVEL_1, LEVEL_2, PROBES, Likeness, SplineLoads, expected_ends
from .states import FEWEST, carries, state_columns, vary_contact
from .status import DEEPEST

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Arrays = dict[str, NDArray[Any]]
    Case = tuple[NDArray[np.bool_], CriticalStatus, float]
    Loads = dict[str, tuple[Array, NDArray[np.str_]]]

Input = TypeVar("Input")

__all__ = ["CRITICAL", "carrying", "critical_loads", "load_falls"]

CRITICAL = ("F_cr1", "F_cr2", "F_tpca.A", "F_tpca.B")
SPLINE_NODES, EXACT_EVERY, CLOSER = 33, 4, 0.3
"""Nodes of splines, of which every fourth is exact; nodes at the lowest separations lie so much
closer than on average."""
NODES, AT_ONCE = 13, 8_192
"""Separations at which shares are known before crossings are refined, and samples at a time."""
EXACT, PASSES, HALVINGS = 1e-6, 60, 30
"""Last step to a crossing, over the range of separations, which leaves less than 1e-5 of the load;
passes at most, and halvings of a cell to the root of its spline."""
EXACT_PEAK, NEAR = 1e-4, 0.3
"""Tolerance of a peak, and ln of the loads' ratio below which there may be a crossing between."""


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
    Of many contacts shares and loads are splines over the separation: what each differs by from
    others with inputs like its own is smooth, so nine separations of its own are enough, and what
    splines say of a crossing is corrected by states there. Contacts that they do not tell (a
    level that is passed twice, or close to an end of the window) and few contacts: shares at 13
    separations from F* = 1e-8 to 1e-2, and crossings by Chandrupatla's method, all together.
    Relative error 1e-5 (F_tpca.A: 1e-3) against `transitions`, 4e-6 in all that were compared.
    F_tpca.C, which `transitions` takes from a grid of loads, has no distribution worth the name
    and is left out.

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
    >>> loads, status = tb.equilibria.critical_loads(contact, vary=vary, count=21)["F_cr1"]
    >>> bool(np.all(np.diff(loads) < 0)), str(status[0])
    (True, 'found')
    """
    if not (isinstance(count, (int, np.integer)) and count > 0):
        raise InvalidValue(
            Problem("count", "must be a whole number above 0", repr(count), code=Mistake.KIND)
        )
    contact, vary = carrying(contact, vary)
    uneven = [
        Problem(
            f"vary[{name!r}]",
            Mistake.SHAPE.clause(f"must be one number or count = {count} numbers"),
            f"{np.size(v)} numbers",
        )
        for name, v in vary.items()
        if np.shape(v) not in {(), (1,), (count,)}
    ]
    if uneven:
        raise InvalidValue(*uneven)
    if contact.two_body:
        raise InvalidValue("a contact without particles has no critical loads", code=Mistake.BEYOND)
    if not load_falls(contact):
        raise InvalidValue(
            "critical loads of many contacts need a load that falls with the separation, which "
            f"{type(contact.particle_law).__name__} does not promise; name other outputs, or call "
            "transitions for each",
            code=Mistake.BEYOND,
        )
    arrays = {name: np.broadcast_to(np.asarray(v, float), count) for name, v in vary.items()}
    parts = [
        _by_splines(contact, {n: v[start : start + AT_ONCE] for n, v in arrays.items()}, size)
        for start in range(0, count, AT_ONCE)
        for size in [min(AT_ONCE, count - start)]
    ]
    return {
        name: (
            np.concatenate([loads[name][0] for loads in parts]),
            np.concatenate([loads[name][1] for loads in parts]),
        )
        for name in CRITICAL
    }


def load_falls(contact: Contact) -> bool:
    """Whether the load falls with the separation, here and as far as the law of particles tells."""
    contact_interface = interface(contact)
    return load_scan(contact_interface).monotone and (
        contact_interface.particles is None or contact_interface.particles.monotone
    )


class Shares:
    """Shares of many contacts, each between a highest (t = 0) and a lowest separation (t = 1)."""

    def __init__(self, contact: Contact, vary: Arrays, count: int, ends: Array | None = None):
        self.contact, self.vary, self.count = contact, vary, count
        if ends is not None:
            self.top, self.bottom = ends
            return
        twice = {name: np.repeat(values, 2) for name, values in vary.items()}
        states = state_columns(contact, F_star=np.tile(WINDOW, count), vary=twice or None)
        first, last = ({n: states[n][i::2] for n in ("d", "h")} for i in range(2))
        roughness_inputs = {
            name: values for name, values in vary.items() if name.startswith("roughness.")
        }
        rough = (
            contact.with_arrays(roughness_inputs).roughness
            if roughness_inputs
            else contact.roughness
        )
        # a load that no contact carries is replaced by the deepest one that the model knows
        self.deepest = rough.y_s - (first["h"] - first["d"]) + DEEPEST * rough.sigma_s
        self.top = np.asarray(first["d"], float)
        self.bottom = np.where(np.isnan(last["d"]), self.deepest, last["d"])
        if contact.asperity_law.of_surface:
            self.deepest = lowest_of_surfaces(contact, vary, count)
            self.bottom = np.where(np.isnan(last["d"]), self.deepest, last["d"])
            if len(too_much := np.flatnonzero(np.isnan(last["d"]))):
                loads = self.columns_at(np.ones(len(too_much)), too_much)[-1]
                self.bottom = np.maximum(self.bottom, self._ends(too_much[np.isnan(loads)]))

    def _ends(self, which: NDArray[np.intp]) -> Array:
        """Lowest separation of a law of the whole surface, where it depends on the particles."""
        out = np.full(self.count, -np.inf)
        for i in which.tolist():
            inputs = {name: values[i].item() for name, values in self.vary.items()}
            out[i] = (
                interface(vary_contact(self.contact, inputs)).lowest
                + 1e-9 * self.contact.roughness.sigma
            )
        return out

    def logarithms_at(self, t: Array, which: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """ln A_sa/A_ss, ln F_sa/F_ss and ln F* of contacts ``which`` (M,) at t (M,)."""
        A_sa, A_ss, F_sa, F_ss, F = self.columns_at(t, which)
        with np.errstate(divide="ignore", invalid="ignore"):
            return _log_ratio(A_sa, A_ss), _log_ratio(F_sa, F_ss), np.log(F)

    def logarithms(self, t: Array, which: NDArray[np.intp]) -> Array:
        """ln A_sa/A_ss, ln F_sa* and ln F_ss* of contacts ``which`` (M,) at t (M,): (3, M)."""
        A_sa, A_ss, F_sa, F_ss, _ = self.columns_at(t, which)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.stack([_log_ratio(A_sa, A_ss), np.log(F_sa), np.log(F_ss)])

    def columns_at(self, t: Array, which: NDArray[np.intp]) -> list[Array]:
        """Areas, loads and F* of contacts ``which`` (M,) at t (M,)."""
        order = np.argsort(which, kind="stable")  # states of one contact are solved side by side
        t, which, back = t[order], which[order], np.argsort(order)
        d = self.top[which] + t * (self.bottom[which] - self.top[which])
        vary = {name: values[which] for name, values in self.vary.items()}
        fewest = 1 if self.count >= FEWEST else None  # the engine is at work by then
        states = state_columns(self.contact, d=d, vary=vary or None, fewest=fewest)
        return [states[name][back] for name in ("A_sa", "A_ss", "F_sa_star", "F_ss_star", "F_star")]

    def load(self, t: Array, which: NDArray[np.intp]) -> Array:
        """F* of contacts ``which`` at t."""
        return np.exp(self.logarithms_at(t, which)[2])


def lowest_of_surfaces(contact: Contact, vary: Arrays, count: int) -> Array:
    """Separations d [m] at which a law of the whole surface ends; −∞ where only tables say."""
    try:
        lowest = lowest_separations(contact, vary, count)
    except NotCompiled:
        return np.full(count, -np.inf)
    return lowest + 1e-9 * contact.roughness.sigma


def _log_ratio(one: Array, other: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.clip(np.log(one) - np.log(other), -1500.0, 1500.0)


def _by_splines(contact: Contact, vary: Arrays, count: int) -> Loads:
    """Critical loads by splines; of contacts of which those do not tell them, one by one."""
    left = np.arange(count)
    out = {n: (np.full(count, np.nan), np.full(count, "", dtype="<U12")) for n in CRITICAL}
    if (solved := _spline_loads(contact, vary, count)) is not None:
        splines, rows = solved
        solved_rows = rows[splines.solved]
        for name, into in out.items():
            for whole, values in zip(into, splines.loads[name], strict=True):
                whole[solved_rows] = values[splines.solved]
        left = np.setdiff1d(left, solved_rows)
    if len(left):
        rest = _critical_loads(contact, {n: v[left] for n, v in vary.items()}, len(left))
        for name, into in out.items():
            for whole, values in zip(into, rest[name], strict=True):
                whole[left] = values
    return out


def _spline_loads(
    contact: Contact, vary: Arrays, count: int
) -> tuple[SplineLoads, NDArray[np.intp]] | None:
    """Splines of contacts, and which those are; None where they are few, or unlike each other."""
    from scipy.interpolate import CubicSpline

    if count < 4 * PROBES:
        return None
    probes = np.linspace(0, count - 1, PROBES).astype(np.intp)
    probed = Shares(contact, {name: values[probes] for name, values in vary.items()}, PROBES)
    ends = np.stack([probed.top, probed.bottom])
    like = Likeness(vary, count, probes)
    if not (like.enough and np.all(np.isfinite(ends))):
        return None
    top, bottom = expected_ends(like, ends)
    deepest = like.extend_to_all(probed.deepest)
    if contact.asperity_law.of_surface:
        deepest = lowest_of_surfaces(contact, vary, count)
    shares = Shares(contact, vary, count, np.stack([top, np.maximum(bottom, deepest)]))

    def states(x: Array, which: NDArray[np.intp]) -> Array:
        return shares.logarithms(1 - (1 - x) * (CLOSER + (1 - CLOSER) * (1 - x)), which)

    def at_nodes(x: Array, which: NDArray[np.intp]) -> Array:
        logarithms = states(np.tile(x, len(which)), np.repeat(which, len(x)))
        return logarithms.reshape(3, len(which), len(x))

    x = np.linspace(0.0, 1.0, SPLINE_NODES)
    exact = at_nodes(x[::EXACT_EVERY], np.arange(count))
    alike = np.moveaxis(like.extend_to_all(np.moveaxis(at_nodes(x, probes), 0, 1)), 0, 1)
    first, last = (np.logaddexp(*exact[1:, :, end]) for end in (0, -1))
    reach = (first < math.log(WINDOW[0])) & ((last > math.log(WINDOW[1])) | (bottom <= deepest))
    rows = np.flatnonzero(reach & np.all(np.isfinite(exact), axis=(0, 2)))
    if not len(rows) or not np.all(np.isfinite(alike)):
        return None
    exact, values = exact[:, rows], alike[:, rows]
    # what a contact differs from the others by is smooth
    other, places = exact - values[:, :, ::EXACT_EVERY], x[::EXACT_EVERY]
    values += CubicSpline(places, other, axis=2)(x)
    coarse = CubicSpline(places[::2], other[:, :, ::2], axis=2)(places[1::2])
    error = np.max(np.abs(coarse - other[:, :, 1::2]), axis=2) / 8
    splines = SplineLoads(x, values, error, EXACT_EVERY, lambda x, which: states(x, rows[which]))
    return splines, rows


def _critical_loads(
    contact: Contact, vary: Arrays, count: int, nodes: int = NODES
) -> dict[str, tuple[Array, NDArray[np.str_]]]:
    shares = Shares(contact, vary, count)
    t = np.linspace(0.0, 1.0, nodes)
    logarithms = shares.logarithms_at(np.tile(t, count), np.repeat(np.arange(count), nodes))
    area, load, F = (values.reshape(count, nodes) for values in logarithms)
    lost = np.isnan(shares.top)

    def entry(
        cases: Sequence[Case], loads: tuple[Array, NDArray[np.intp]]
    ) -> tuple[Array, NDArray[np.str_]]:
        value, status = np.full(count, np.nan), np.full(count, CriticalStatus.FOUND, dtype="<U12")
        value[loads[1]] = loads[0]
        for rows, word, number in (*cases, (lost, CriticalStatus.NONE, np.nan)):
            value[rows], status[rows] = number, word
        return value, status

    below, above = area < LEVEL_1, area >= LEVEL_2
    never, always = below[:, 0], np.all(~below, axis=1)
    none, end = np.all(~above, axis=1), above[:, -1]
    changes = (load[:, 1:] >= 0) != (load[:, :-1] >= 0)
    unequal = np.all(~changes, axis=1)
    rows = [~(never | always | lost), ~(none | end | lost), ~(unequal | lost)]
    where = [np.flatnonzero(mask) for mask in rows]
    cells = [
        np.argmax(below, 1) - 1,
        nodes - 1 - np.argmax(above[:, ::-1], 1),
        nodes - 2 - np.argmax(changes[:, ::-1], 1),
    ]
    misses = [area - LEVEL_1, area - LEVEL_2, load]
    loads = _crossings(
        shares,
        t,
        np.concatenate([miss[some] for miss, some in zip(misses, where, strict=True)]),
        np.concatenate([F[some] for some in where]),
        np.concatenate(where),
        np.concatenate([cell[some] for cell, some in zip(cells, where, strict=True)]),
        np.repeat([0, 0, 1], [len(some) for some in where]),
        np.repeat([LEVEL_1, LEVEL_2, 0.0], [len(some) for some in where]),
    )
    cases: list[list[Case]] = [
        [(never, CriticalStatus.NEVER_P_S, 0.0), (always, CriticalStatus.ALWAYS_P_S, np.inf)],
        [(none, CriticalStatus.ALWAYS_S_S, 0.0), (end, CriticalStatus.NEVER_S_S, np.inf)],
        [(unequal, CriticalStatus.NONE, np.nan)],
    ]
    parts = np.split(loads, np.cumsum([len(some) for some in where])[:-1])
    names = ("F_cr1", "F_cr2", "F_tpca.B")
    entries = zip(names, cases, zip(parts, where, strict=True), strict=True)
    out = {name: entry(case, crossings) for name, case, crossings in entries}
    out["F_tpca.A"] = _peak(shares, area, t, lost, entry)
    close = np.flatnonzero(_all_but_equal(t, load) & unequal & ~lost)
    if nodes == NODES and len(close):
        some = {name: values[close] for name, values in vary.items()}
        again = _critical_loads(contact, some, len(close), 2 * NODES - 1)
        for name, (values, status) in out.items():
            values[close], status[close] = again[name]
    return out


def _all_but_equal(t: Array, load: Array) -> NDArray[np.bool_]:
    """Which contacts may have equal loads twice between two nodes, by splines through the nodes."""
    from scipy.interpolate import CubicSpline

    candidates = np.all(np.isfinite(load), axis=1)
    between = CubicSpline(t, load[candidates], axis=1)(np.linspace(0.0, 1.0, 4 * len(t)))
    candidates[candidates] = np.min(np.abs(between), axis=1) < NEAR
    return candidates


def _crossings(
    shares: Shares,
    t: Array,
    miss: Array,
    log_F: Array,
    which: NDArray[np.intp],
    cell: NDArray[np.intp],
    column: NDArray[np.intp],
    level: Array,
) -> Array:
    """Loads F* of contacts ``which`` at which a share passes its level in the interval ``cell``.

    From the root of a cubic spline through what the share misses its level by at all nodes, by
    Chandrupatla's method, all side by side; the load by a parabola through the last three points.
    """
    from scipy.interpolate import CubicSpline

    every = np.arange(len(which))
    # rows: the last point, the other end of the bracket, the one before; t, miss and ln F
    one, two = (np.stack([t[k], miss[every, k], log_F[every, k]]) for k in (cell, cell + 1))
    three, x = two.copy(), np.array(one[0])
    out, left = np.full(len(which), np.nan), every
    if len(which):
        cubic = CubicSpline(t, miss, axis=1).c[:, cell, every]
        low, high = np.zeros(len(which)), np.full(len(which), t[1])
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            same = (np.polyval(cubic, middle) >= 0) == (one[1] >= 0)
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        x = one[0] + low
    for _ in range(PASSES):
        if not len(left):
            break
        logarithms = shares.logarithms_at(x, which[left])
        new = np.stack(
            [x, np.where(column[left] == 0, *logarithms[:2]) - level[left], logarithms[2]]
        )
        same = (new[1] >= 0) == (one[1] >= 0)
        three, two = np.where(same, one, two), np.where(same, two, one)
        one = new
        x = _next(one, two, three)
        done = np.abs(x - one[0]) <= EXACT
        out[left[done]] = np.exp(_parabola(x, one, two, three)[done])
        left, x = left[~done], x[~done]
        one, two, three = one[:, ~done], two[:, ~done], three[:, ~done]
    return out


def _next(one: Array, two: Array, three: Array) -> Array:
    """Where a root is sought next: by inverse quadratic interpolation, or between both ends."""
    (a, f_a, _), (b, f_b, _), (c, f_c, _) = one, two, three
    with np.errstate(divide="ignore", invalid="ignore"):
        xi, phi = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        fraction = f_a / (f_b - f_a) * f_c / (f_b - f_c)
        fraction += (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        good = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi) & (fraction > 0) & (fraction < 1)
    return np.where(f_a == 0, a, a + np.where(good, fraction, 0.5) * (b - a))


def _parabola(x: Array, one: Array, two: Array, three: Array) -> Array:
    """ln F at x by the parabola through three points; by the nearest where two are one."""
    (a, _, F_a), (b, _, F_b), (c, _, F_c) = one, two, three
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (F_b - F_a) / (b - a)
        bend = ((F_c - F_a) / (c - a) - slope) / (c - b)
    bent = slope + np.where(np.isfinite(bend), bend, 0.0) * (x - b)
    return F_a + np.where(np.isfinite(bent), bent, 0.0) * (x - a)


def _peak(
    shares: Shares,
    area: Array,
    t: Array,
    lost: NDArray[np.bool_],
    entry: Callable[..., tuple[Array, NDArray[np.str_]]],
) -> tuple[Array, NDArray[np.str_]]:
    """The load of the largest area share, where the share falls on both sides."""
    from scipy.optimize import elementwise
    from scipy.special import expit

    top = np.argmax(area, axis=1)
    size, rows = expit(area), np.arange(len(area))
    ends = np.maximum(size[:, 0], size[:, -1])
    good = (top > 0) & (top < len(t) - 1) & (ends <= 0.9 * size[rows, top])
    good &= (size[rows, top] >= 1e-6) & ~lost
    which = np.flatnonzero(good)
    if not len(which):
        return entry([(~good, CriticalStatus.NONE, np.nan)], (np.empty(0), which))
    answer = elementwise.find_minimum(
        lambda x, i: -shares.logarithms_at(x, i.astype(np.intp))[0],
        tuple(t[top[which] + side] for side in (-1, 0, 1)),
        args=(which.astype(float),),
        tolerances={"xatol": EXACT_PEAK},
    )
    return entry([(~good, CriticalStatus.NONE, np.nan)], (shares.load(answer.x, which), which))


def carrying(contact: Contact, vary: Mapping[str, Input]) -> tuple[Contact, dict[str, Input]]:
    """The contact without outputs, and the varied inputs that affect how it carries load."""
    return contact.replace(outputs=()), {name: v for name, v in vary.items() if carries(name)}
