"""Derivatives of solved states by differences, with their doubts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..equilibrium.states import direct_columns, state_columns
from .inputs import FULL_REACH, Input, _room, places_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Offsets = NDArray[np.intp]


class Rule(NamedTuple):
    """How derivatives are taken: from which states, and when they are good."""

    reach: int
    """States on either side of an input."""
    steps: tuple[float, ...]
    """Relative changes of an input between neighbours; the later ones where the first fail."""
    steps_of_d: tuple[float, ...]
    """Changes of d, over the length σ_s²/|d| in which the load changes (or σ_s)."""
    good: float
    """Estimated error, as that of an elasticity, with which no smaller step is tried."""
    doubtful: float
    """Estimated error from which `Sensitivity.status` says so."""
    follows: bool
    """An input moves on a path on which what is held stays nearly, found from two more states."""
    direct: bool
    """States come from quadrature at their own d, without tables."""


FULL = Rule(FULL_REACH, (1e-2, 2e-3, 2e-4), (3e-2, 3e-3, 3e-4), 1e-9, 1e-6, True, False)
"""All digits."""
QUICK = Rule(2, (5e-4, 2e-5), (1e-3, 1e-4), 1e-4, 1e-2, False, True)
"""Three digits at least; the estimated error is that of second order, far above their own."""
JUMPS = 1e-7
"""Jump of an elasticity from which `Sensitivity.status` gives the slopes of both sides."""
FAR = 1e-3
"""Jump of a slope, over the slope, from which there is no derivative."""


def _exact(offsets: Offsets) -> Array:
    """Weights of f′(0) from f at these offsets, exact for polynomials through them all."""
    powers = np.vander(offsets.astype(float), increasing=True).T
    return np.linalg.solve(powers, np.eye(len(offsets))[1])


@lru_cache
def _weights(offsets: tuple[int, ...]) -> Array:
    """Weights of f′(0) from f at all offsets, and from all but the two farthest: (2, n)."""
    places = np.array(offsets)
    near = np.argsort(np.abs(places), kind="stable")[:-2]
    out = np.zeros((2, len(places)))
    out[0], out[1, near] = _exact(places), _exact(places[near])
    return out


@lru_cache
def _sides(reach: int) -> Array:
    """Weights, at the central offsets, of the jump of f′, and of f′(−0) and f′(+0): (3, n).

    That of the jump is exact for all even powers below 2 reach, and for |t|.
    """
    k = np.arange(1.0, reach + 1)
    powers = np.stack([k, *(k ** (2 * i) for i in range(1, reach))])
    half = np.linalg.solve(powers, np.eye(reach)[0])
    out = np.zeros((3, 2 * reach + 1))
    out[0] = np.concatenate([half[::-1], [-2 * half.sum()], half])
    out[1, reach::-1] = _exact(-np.arange(reach + 1))
    out[2, reach:] = _exact(np.arange(reach + 1))
    return out


class Slope(NamedTuple):
    """Derivatives, their estimated errors, their jumps, and those of each side: each (M, C)."""

    value: Array
    error: Array
    jump: Array
    below: Array
    above: Array

    def better(self, other: Slope) -> Slope:
        """From each of two the derivatives with the smaller error."""
        best = self.error <= other.error
        return Slope(*(np.where(best, a, b) for a, b in zip(self, other, strict=True)))

    def less(self, ratio: Slope, of_held: Slope) -> Slope:
        """c_p − (c_d/g_d) g_p."""
        error = np.abs(ratio.value) * of_held.error + ratio.error * np.abs(of_held.value)
        rest = (field - ratio.value * other for field, other in zip(self, of_held, strict=True))
        return Slope(*rest)._replace(error=self.error + error)


def _slope(values: Array, offsets: Offsets, step: float) -> Slope:
    """Derivatives of values (M, 9, C) at the offsets."""
    fine, coarse = np.einsum("wk,mkc->wmc", _weights(tuple(offsets.tolist())), values) / step
    # no difference knows more than the digits of its values
    rounding = 2 * np.finfo(float).eps * np.max(np.abs(values), axis=1) / step
    sides = np.zeros_like(fine), fine, fine
    if offsets[0] < 0 < offsets[-1]:
        sides = tuple(np.einsum("wk,mkc->wmc", _sides(int(offsets[-1])), values) / step)
    return Slope(fine, np.abs(fine - coarse) + rounding, *sides)


class Entry(NamedTuple):
    """Derivatives of one result with one input, their errors and what to say of them: each (M,)."""

    derivative: Array
    error: Array
    status: NDArray[np.object_]


def _entries(total: Slope, size: Array, scale: float | Array, doubtful: float) -> list[Entry]:
    """Notes on derivatives (M, C) over ``scale``, for columns of this size."""
    value, error, _, below, above = (field / scale for field in total)
    error = np.abs(error)
    status = np.full(value.shape, "ok", dtype=object)
    worst = np.divide(total.error, size, out=np.zeros_like(size), where=size > 0)
    broken = (np.abs(total.jump) > JUMPS * size) & (np.abs(total.jump) > 1e3 * total.error)
    for at in zip(*np.nonzero((worst > doubtful) & ~broken), strict=True):
        status[at] = (
            f"uncertain: the elasticity is known to {worst[at]:.1g} only, because the result is "
            "not smooth around this input"
        )
    for at in zip(*np.nonzero(broken), strict=True):
        status[at] = (
            f"the slope jumps: {below[at]:.6g} towards smaller values of the input "
            f"and {above[at]:.6g} towards larger ones (of equal bodies the softer "
            "decides: move both, joined by '+')"
        )
    between = np.abs(above - below)
    error = np.where(broken, np.maximum(error, between / 2), error)
    far = broken & (between > FAR * np.maximum(np.abs(above), np.abs(below)))
    value, error = np.where(far, np.nan, value), np.where(far, np.nan, error)
    return [Entry(value[:, c], error[:, c], status[:, c]) for c in range(value.shape[1])]


# -------------------------------------------------------------------------- states
class Places:
    """States at which derivatives are taken: separations d (M,), and what is held at them.

    The values of a state are its ``columns`` and, last, what is held while an input moves: a
    column; nothing but d, for None; or at a ``peak`` the slope of the column with d.
    """

    def __init__(
        self,
        contact: Contact,
        d: Array,
        held: str | None,
        columns: Sequence[str],
        *,
        peak: bool = False,
        rule: Rule = FULL,
    ):
        self.contact, self.d, self.held, self.columns = contact, d, held, tuple(columns)
        self.peak, self.rule = peak, rule
        self.around = places_of(rule.reach)[0]
        asperities = interface(contact).asperities
        h = (d - asperities.centre) / asperities.sigma_s
        self.length = asperities.sigma_s / np.maximum(1.0, np.abs(h))
        """Length in which the load changes [m]."""

    def values(self, d: Array, changes: Mapping[str, Array]) -> Array:
        """Values (M, ..., C) at separations (M, ...) and with inputs of that shape."""
        step = 0.0 * d
        if self.peak:
            step = np.broadcast_to(self.length.reshape(-1, *(1,) * (d.ndim - 1)), d.shape)
            step = self.rule.steps_of_d[0] * step
            d = d[..., None] + step[..., None] * self.around
            changes = {name: np.broadcast_to(v[..., None], d.shape) for name, v in changes.items()}
        vary = {name: values.ravel() for name, values in changes.items()}
        states = self._states(d.ravel(), vary)
        columns = [states[name].astype(float).reshape(d.shape) for name in self.columns]
        held = np.zeros(d.shape)
        if self.held:
            held = states[self.held].astype(float).reshape(d.shape)
        if self.peak:
            columns = [values[..., self.rule.reach] for values in columns]
            held = held @ _weights(tuple(self.around.tolist()))[0] / step
        return np.stack([*columns, held], axis=-1)

    def _states(self, d: Array, vary: dict[str, Array]) -> Mapping[str, NDArray[Any]]:
        """Every column at separations (N,) with inputs (N,)."""
        if self.rule.direct and not self.contact.outputs:
            return direct_columns(self.contact, d, vary)
        return state_columns(self.contact, d=d, vary=vary or None)

    def along_d(self) -> tuple[Array, Slope]:
        """Values (M, C), and their derivatives with d over `length`."""
        best = None
        for step in self.rule.steps_of_d:
            values = self.values(self.d[:, None] + step * self.around * self.length[:, None], {})
            slope = _slope(values, self.around, step)
            best = slope if best is None else best.better(slope)
            if _good(best, values[:, self.rule.reach], self.rule):
                break
        assert best is not None
        return values[:, self.rule.reach], best

    def slopes_on_paths(self, moved: Sequence[Input], slope_of_held: Array) -> list[Slope]:
        """Derivatives with every input moved on a path on which what is held stays nearly."""
        slopes: dict[int, Slope] = {}
        pending = list(range(len(moved)))
        paths = self._paths(moved, slope_of_held) if pending else np.empty((len(self.d), 0))
        for step in self.rule.steps:
            inputs = [moved[j] for j in pending]
            offsets = [
                _room(self.contact, moved_input, step, self.rule.reach) for moved_input in inputs
            ]
            if inputs:
                values = self._on_paths(inputs, paths[:, pending], offsets, step)
            left = []
            for i, j in enumerate(pending):
                slope = _slope(values[:, i], offsets[i], step)
                slopes[j] = slopes[j].better(slope) if j in slopes else slope
                centre = values[:, i, np.flatnonzero(offsets[i] == 0)[0]]
                if not _good(slopes[j], centre, self.rule):
                    left.append(j)
            pending = left
        return [slopes[j] for j in range(len(moved))]

    def _paths(self, moved: Sequence[Input], slope_of_held: Array) -> Array:
        """dd/dt of every input (M, J) on its path, from two states each."""
        if self.held is None or not self.rule.follows:
            return np.zeros((len(self.d), len(moved)))
        step, reach = self.rule.steps[0], self.rule.reach
        rooms = [_room(self.contact, moved_input, step, reach) for moved_input in moved]
        pairs = [
            room[reach - 1 : reach + 2 : 2] if room[reach] == 0 else room[:2] for room in rooms
        ]
        still = np.zeros((len(self.d), len(moved)))
        low, high = np.moveaxis(self._on_paths(moved, still, pairs, step)[..., -1], -1, 0)
        run = step * np.array([pair[1] - pair[0] for pair in pairs])
        rise = high - low
        if self.held in ("F_star", "pressure"):
            # a load changes like an exponential
            rise = np.sqrt(low * high) * np.log(high / low)
        return -rise / run * (self.length / slope_of_held)[:, None]

    def _on_paths(
        self, moved: Sequence[Input], paths: Array, offsets: Sequence[Offsets], step: float
    ) -> Array:
        """Values (M, J, K, C) with each input moved by its offsets on its path, all at once."""
        t = step * np.stack(offsets)
        d = self.d[:, None, None] + paths[..., None] * t
        changes: dict[str, Array] = {}
        for j, moved_input in enumerate(moved):
            for name, values in moved_input.numbers_at(t[j]).items():
                start = moved_input.values[moved_input.names.index(name)]
                changes.setdefault(name, np.full(d.shape, start))[:, j] = values
        return self.values(d, changes)

    def entries(self, moved: Sequence[Input], load: str) -> dict[str, list[Entry]]:
        """Derivatives of every column with every input, and with the load where it has a name."""
        centre, slope = self.along_d()
        size = np.abs(centre[:, :-1])
        columns, held_slope = _last_apart(slope)
        steep = np.where(held_slope.value == 0, 1.0, held_slope.value)
        ratio = Slope(*(field / steep for field in columns))
        ratio = ratio._replace(
            error=(columns.error + np.abs(ratio.value) * held_slope.error) / np.abs(steep)
        )
        out = {}
        partial = self.slopes_on_paths(moved, slope.value[:, -1])
        for moved_input, (of_columns, of_held) in zip(
            moved, map(_last_apart, partial), strict=True
        ):
            total = of_columns.less(ratio, of_held)
            out[moved_input.label] = self._entries_of(total, size, moved_input.scales[0])
        if load == self.held:
            level = centre[:, -1:]
            out[load] = self._entries_of(Slope(*(level * field for field in ratio)), size, level)
        elif load == "d" and self.held is None:
            out[load] = self._entries_of(columns, size, self.length[:, None])
        elif load:
            out[load] = self._entries_of(Slope(*(0 * field for field in columns)), size, 1.0)
        return out

    def _entries_of(self, total: Slope, size: Array, scale: float | Array) -> list[Entry]:
        return _entries(total, size, scale, self.rule.doubtful)


def _last_apart(slope: Slope) -> tuple[Slope, Slope]:
    """Slopes of the columns and of what is held."""
    return Slope(*(field[:, :-1] for field in slope)), Slope(*(field[:, -1:] for field in slope))


def _good(slope: Slope, centre: Array, rule: Rule) -> bool:
    """Whether every error is small, as that of an elasticity."""
    return bool(np.all(slope.error <= rule.good * (np.abs(centre) + np.abs(slope.value))))
