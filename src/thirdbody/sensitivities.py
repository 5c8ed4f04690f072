r"""Sensitivities: how every column and every critical load answers to every input.

At a state where a column :math:`g(d; p)` is held while the input p moves,

.. math:: \frac{\mathrm dc}{\mathrm dp} = \partial_p c - \frac{\partial_d c}{\partial_d g}\,
          \partial_p g

with the load for g at a given load, the particle share for g at a critical load. The partial
derivatives are eighth-order differences of states at given separations: nothing is solved again.
They are taken along a straight path d(p) on which g stays nearly constant, so that no two large
numbers cancel.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .contact import Contact, interface
from .equilibrium import COLUMNS, EPS_1, EPS_2, Equilibrium, given_load, solve
from .errors import InvalidValue
from .outputs.base import AbstractOutput
from .states import carries, solve_states, varied
from .surfaces import ETA_R_SIGMA
from .transitions import transitions
from .values import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Offsets = NDArray[np.intp]

__all__ = ["Sensitivity", "inputs", "sensitivity"]

STEPS = (1e-2, 2e-3, 2e-4)
"""Relative changes of an input between neighbouring states; the later ones where the first fail."""
STEPS_OF_D = (3e-2, 3e-3, 3e-4)
"""Changes of d, over the length σ_s²/|d| in which the load changes (or σ_s)."""
GOOD = 1e-9
"""Estimated error, as that of an elasticity, with which no smaller step is tried."""
JUMPS = 1e-7
"""Jump of an elasticity from which `Sensitivity.status` gives the slopes of both sides."""
FAR = 1e-3
"""Jump of a slope, over the slope, from which there is no derivative."""
DOUBTFUL = 1e-6
"""Estimated error from which `Sensitivity.status` says so."""
AT_ONCE = 500
"""Loads differentiated at a time."""
CRITICAL = {
    "F_cr1": ("particle_area_share", 1 - EPS_1),
    "F_cr2": ("particle_area_share", EPS_2),
    "F_tpca.A": ("particle_area_share", None),
    "F_tpca.B": ("particle_load_share", 0.5),
    "F_tpca.C": ("", None),
}
"""Critical loads, the share that is held there and its value; None: the share has its maximum."""
NOT_NUMBERS = ("mode", "status", "residual", "iterations")
NUMBERS = tuple(name for name in COLUMNS if name not in NOT_NUMBERS)
"""Columns with a derivative."""


# -------------------------------------------------------------------------- result
@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity:
    """Derivatives of results with respect to inputs: floats, or arrays over several loads.

    Made by `sensitivity`, where accuracy stands.

    Attributes
    ----------
    contact : Contact
        The contact whose results are moved.
    load : dict
        What was given: pressure, F_star or d; empty for critical loads alone.
    inputs : dict
        Every input and its value; of inputs that move together, the first one's.
    value : dict
        Every result.
    derivative : dict of dict
        ``derivative[of][to]``, dc/dp in SI.
    elasticity : dict of dict
        d ln c/d ln p = (p/c) dc/dp [1]: per cent of change for one per cent.
    error : dict of dict
        Estimated error of the derivative: by how much two orders of difference differ.
    status : dict of dict
        "ok", or why there is no derivative, or how uncertain it is.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> found = tb.sensitivity(contact, of=["A_t"], to=["roughness.sigma"], pressure=5e6)
    >>> round(found.elasticity["A_t"]["roughness.sigma"], 3), found.status["A_t"]["roughness.sigma"]
    (0.21, 'ok')
    """

    contact: Contact = field(repr=False)
    load: dict[str, Any]
    inputs: dict[str, Any]
    value: dict[str, Any]
    derivative: dict[str, dict[str, Any]]
    elasticity: dict[str, dict[str, Any]]
    error: dict[str, dict[str, Any]]
    status: dict[str, dict[str, Any]]

    def to_dict(self) -> dict[str, Any]:
        """Everything but the contact, ready for JSON: None for NaN, lists for arrays."""
        names = (item.name for item in dataclasses.fields(self) if item.name != "contact")
        return {name: _plain(getattr(self, name)) for name in names}

    def table(self, at: int = 0) -> str:
        """The elasticities at one load as lines of text, the strongest input first.

        Parameters
        ----------
        at : int, optional
            Number of the load, where several were given.
        """

        def one(value: Any) -> float:
            return float(value if np.ndim(value) == 0 else value[at])

        rows = {to: [one(row[to]) for row in self.elasticity.values()] for to in self.inputs}
        order = sorted(rows, key=lambda to: -max(np.nan_to_num(np.abs(rows[to]))))
        width = max(len(to) for to in (*rows, "input"))
        wide = [max(10, len(of)) for of in self.elasticity]
        lines = [
            ["input".ljust(width), *(of.rjust(w) for of, w in zip(self.value, wide, strict=True))]
        ]
        for to in order:
            numbers = (f"{round(x, 4) + 0.0:{w}.4f}" for x, w in zip(rows[to], wide, strict=True))
            lines.append([to.ljust(width), *numbers])
        return "\n".join("  ".join(line) for line in lines)


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(part) for name, part in value.items()}
    if isinstance(value, np.ndarray):
        return [_plain(part) for part in value.tolist()]
    return None if isinstance(value, float) and not math.isfinite(value) else value


# -------------------------------------------------------------------------- inputs
def inputs(contact: Contact) -> dict[str, float]:
    """Every number that a contact is made of and that can be varied, by its dotted name.

    Several populations are numbered, ``particles.0.areal_density``; outputs go by their names,
    ``outputs.friction.tau_ss``.
    """
    out = dict(_numbers(contact, ""))
    if not contact.outputs:
        out = {name: v for name, v in out.items() if carries(name)}
    rough = contact.roughness
    if rough.eta is None and rough.eta_R_sigma is None:
        out["roughness.eta_R_sigma"] = ETA_R_SIGMA
    if contact.two_body:
        out = {name: v for name, v in out.items() if not name.startswith("particle")}
    return out


def _numbers(value: Value, prefix: str) -> Iterator[tuple[str, float]]:
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        part = getattr(value, item.name)
        if "quantity" in item.metadata and part is not None:
            yield prefix + item.name, part
        elif isinstance(part, Value):
            yield from _numbers(part, f"{prefix}{item.name}.")
        elif isinstance(part, tuple):
            for place, each in enumerate(part):
                label = each.name if isinstance(each, AbstractOutput) else place
                if isinstance(each, Value):
                    yield from _numbers(each, f"{prefix}{item.name}.{label}.")


def _default_inputs(contact: Contact) -> list[str]:
    """Every input that may move; joined where several decide (who is softer, which side wider)."""
    known = inputs(contact)
    pair = contact.surfaces
    alike = pair.first == pair.second
    groups: dict[Any, list[str]] = {}
    for name, value in known.items():
        side, _, last = name.rpartition(".")
        body = side in ("surfaces.first", "surfaces.second") or side.endswith(".material")
        if body and last == "H":
            key: Any = ("H", value)
        elif body and alike and value and not side.endswith(".material"):
            key = (last, "surfaces")
        else:
            key = name
        groups.setdefault(key, []).append(name)
    return [label for names in groups.values() if _moves(contact, label := "+".join(names))]


def _moves(contact: Contact, label: str) -> bool:
    """Whether an input may change: not so the height of a seat that has none."""
    try:
        _room(contact, input_of(contact, label), STEPS[0])
    except InvalidValue:
        return False
    return True


class Input(NamedTuple):
    """Numbers of a contact that move by one factor: at t each is value + scale·t."""

    label: str
    names: tuple[str, ...]
    values: tuple[float, ...]
    scales: tuple[float, ...]

    def at(self, t: Any) -> dict[str, Any]:
        parts = zip(self.names, self.values, self.scales, strict=True)
        return {name: value + scale * t for name, value, scale in parts}


def input_of(contact: Contact, label: str) -> Input:
    """The input of a dotted name, or of several joined by "+"."""
    names = tuple(name.strip() for name in label.split("+"))
    known = inputs(contact)
    if problems := [_no_input(contact, name, known) for name in names if name not in known]:
        raise InvalidValue(*problems)
    values = tuple(known[name] for name in names)
    if len(names) > 1:
        if problems := [
            f"to = {label!r} moves its inputs by one factor, but {name} is zero"
            for name, value in zip(names, values, strict=True)
            if value == 0
        ]:
            raise InvalidValue(*problems)
        return Input(label, names, values, values)
    return Input(label, names, values, (_scale(contact, names[0], values[0]),))


def _scale(contact: Contact, name: str, value: float) -> float:
    """By how much an input changes when it changes a lot."""
    about = declared(contact, name)
    if value > 0 and 0 in (about["gt"], about["ge"]):
        return value
    usual = {"1": 1.0, "m": contact.roughness.sigma}.get(about["unit"], 0.0)
    if not (scale := max(abs(value), usual)):
        raise InvalidValue(f"to = {name!r} is zero; give it a value to say what a small change is")
    return scale


def declared(contact: Contact, name: str) -> dict[str, Any]:
    """Symbol, unit and range of an input."""
    path, _, last = name.rpartition(".")
    owner = contact.part(path)
    (about,) = (i.metadata["quantity"] for i in dataclasses.fields(owner) if i.name == last)
    return about


def _no_input(contact: Contact, name: str, known: Iterable[str]) -> str:
    """Why a name is not an input that can be varied."""
    import difflib

    if contact.two_body and name.startswith("particle"):
        return f"to = {name!r} says nothing of a contact without particles"
    try:
        owner = contact.part(name)
    except InvalidValue:
        near = difflib.get_close_matches(name, list(known), n=1)
        guess = f"did you mean {near[0]!r}?" if near else f"the inputs are {', '.join(known)}"
        return f"to = {name!r} is not an input; {guess}"
    if name in ("roughness.eta", "roughness.eta_R_sigma"):
        given = "eta_R_sigma" if name.endswith("eta") else "eta"
        return f"to = {name!r} is not given; the density follows from 'roughness.{given}', use that"
    if owner is None:
        return (
            f"to = {name!r} is None: the contact finds it from its other inputs; vary those, or "
            "give it a value"
        )
    return f"to = {name!r} is not a number that could change a little"


# -------------------------------------------------------------------------- differences
CENTRAL, UP, DOWN = np.arange(-4, 5), np.arange(9), -np.arange(9)
"""Where the states of a difference lie, in steps; on one side at the end of an input's range."""
MIDDLE = 4


def _slope_weights(offsets: Offsets) -> Array:
    """Weights of f′(0) from f at all offsets, and from all but the two farthest: (2, 9)."""
    near = np.argsort(np.abs(offsets), kind="stable")[:-2]
    out = np.zeros((2, len(offsets)))
    for row, which in zip(out, (np.arange(len(offsets)), near), strict=True):
        powers = np.vander(offsets[which].astype(float), increasing=True).T
        row[which] = np.linalg.solve(powers, np.eye(len(which))[1])
    return out


def _jump_weights() -> Array:
    """Weights of f′(+0) − f′(−0) from f at the central offsets, exact through |t|⁷ (t⁶): (9,)."""
    k = np.arange(1.0, 5.0)
    half = np.linalg.solve(np.stack([k, k**2, k**4, k**6]), [1.0, 0.0, 0.0, 0.0])
    return np.concatenate([half[::-1], [-2 * half.sum()], half])


WEIGHTS = {tuple(offsets): _slope_weights(offsets) for offsets in (CENTRAL, UP, DOWN)}
SIDES = np.zeros((3, 9))
"""Weights, at the central offsets, of the jump of f′, and of f′(−0) and f′(+0)."""
SIDES[0] = _jump_weights()
SIDES[1, MIDDLE::-1] = _slope_weights(-np.arange(5))[0]
SIDES[2, MIDDLE:] = _slope_weights(np.arange(5))[0]


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

    def less(self, ratio: Slope, own: Slope) -> Slope:
        """c_p − (c_d/g_d) g_p."""
        error = np.abs(ratio.value) * own.error + ratio.error * np.abs(own.value)
        rest = (part - ratio.value * other for part, other in zip(self, own, strict=True))
        return Slope(*rest)._replace(error=self.error + error)


def _slope(values: Array, offsets: Offsets, step: float) -> Slope:
    """Derivatives of values (M, 9, C) at the offsets."""
    fine, coarse = np.einsum("wk,mkc->wmc", WEIGHTS[tuple(offsets)], values) / step
    # no difference knows more than the digits of its values
    rounding = 2 * np.finfo(float).eps * np.max(np.abs(values), axis=1) / step
    sides = np.zeros_like(fine), fine, fine
    if offsets is CENTRAL:
        sides = tuple(np.einsum("wk,mkc->wmc", SIDES, values) / step)
    return Slope(fine, np.abs(fine - coarse) + rounding, *sides)


class Entry(NamedTuple):
    """Derivatives of one result with one input, their errors and what to say of them: each (M,)."""

    derivative: Array
    error: Array
    status: NDArray[Any]


def _entries(total: Slope, size: Array, scale: Any) -> list[Entry]:
    """What to tell of derivatives (M, C) over ``scale``, with columns of this size."""
    value, error, _, below, above = (part / scale for part in total)
    error = np.abs(error)
    status = np.full(value.shape, "ok", dtype=object)
    worst = np.divide(total.error, size, out=np.zeros_like(size), where=size > 0)
    broken = (np.abs(total.jump) > JUMPS * size) & (np.abs(total.jump) > 1e3 * total.error)
    for at in zip(*np.nonzero((worst > DOUBTFUL) & ~broken), strict=True):
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
    ):
        self.contact, self.d, self.held, self.columns = contact, d, held, tuple(columns)
        self.peak = peak
        asperities = interface(contact).asperities
        h = (d - asperities.centre) / asperities.sigma_s
        self.length = asperities.sigma_s / np.maximum(1.0, np.abs(h))
        """Length in which the load changes [m]."""

    def values(self, d: Array, changes: Mapping[str, Array]) -> Array:
        """Values (M, ..., C) at separations (M, ...) and with inputs of that shape."""
        step = 0.0 * d
        if self.peak:
            step = np.broadcast_to(self.length.reshape(-1, *(1,) * (d.ndim - 1)), d.shape)
            step = STEPS_OF_D[0] * step
            d = d[..., None] + step[..., None] * CENTRAL
            changes = {name: np.broadcast_to(v[..., None], d.shape) for name, v in changes.items()}
        vary = {name: values.ravel() for name, values in changes.items()}
        states = solve_states(self.contact, d=d.ravel(), vary=vary or None)
        columns = [states[name].astype(float).reshape(d.shape) for name in self.columns]
        held = np.zeros(d.shape)
        if self.held:
            held = states[self.held].astype(float).reshape(d.shape)
        if self.peak:
            columns = [values[..., MIDDLE] for values in columns]
            held = held @ WEIGHTS[tuple(CENTRAL)][0] / step
        return np.stack([*columns, held], axis=-1)

    def along_d(self) -> tuple[Array, Slope]:
        """Values (M, C), and their derivatives with d over `length`."""
        best = None
        for step in STEPS_OF_D:
            values = self.values(self.d[:, None] + step * CENTRAL * self.length[:, None], {})
            slope = _slope(values, CENTRAL, step)
            best = slope if best is None else best.better(slope)
            if _good(best, values[:, MIDDLE]):
                break
        assert best is not None
        return values[:, MIDDLE], best

    def along(self, moved: Sequence[Input], slope_of_held: Array) -> list[Slope]:
        """Derivatives with every input moved on a path on which what is held stays nearly."""
        found: dict[int, Slope] = {}
        pending = list(range(len(moved)))
        paths = self._paths(moved, slope_of_held) if pending else np.empty((len(self.d), 0))
        for step in STEPS:
            inputs = [moved[j] for j in pending]
            offsets = [_room(self.contact, each, step) for each in inputs]
            if inputs:
                values = self._on_paths(inputs, paths[:, pending], offsets, step)
            left = []
            for i, j in enumerate(pending):
                slope = _slope(values[:, i], offsets[i], step)
                found[j] = found[j].better(slope) if j in found else slope
                if not _good(found[j], values[:, i, np.flatnonzero(offsets[i] == 0)[0]]):
                    left.append(j)
            pending = left
        return [found[j] for j in range(len(moved))]

    def _paths(self, moved: Sequence[Input], slope_of_held: Array) -> Array:
        """dd/dt of every input (M, J) on its path, from two states each."""
        if self.held is None:
            return np.zeros((len(self.d), len(moved)))
        step = STEPS[0]
        rooms = [_room(self.contact, each, step) for each in moved]
        pairs = [
            room[MIDDLE - 1 : MIDDLE + 2 : 2] if room is CENTRAL else room[:2] for room in rooms
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
        for j, each in enumerate(moved):
            for name, values in each.at(t[j]).items():
                start = each.values[each.names.index(name)]
                changes.setdefault(name, np.full(d.shape, start))[:, j] = values
        return self.values(d, changes)

    def entries(self, moved: Sequence[Input], load: str) -> dict[str, list[Entry]]:
        """Derivatives of every column with every input, and with the load where it has a name."""
        centre, slope = self.along_d()
        size = np.abs(centre[:, :-1])
        columns, own = _last_apart(slope)
        steep = np.where(own.value == 0, 1.0, own.value)
        ratio = Slope(*(part / steep for part in columns))
        ratio = ratio._replace(
            error=(columns.error + np.abs(ratio.value) * own.error) / np.abs(steep)
        )
        out = {}
        partial = self.along(moved, slope.value[:, -1])
        for each, (of_columns, of_held) in zip(moved, map(_last_apart, partial), strict=True):
            total = of_columns.less(ratio, of_held)
            out[each.label] = _entries(total, size, each.scales[0])
        if load == self.held:
            level = centre[:, -1:]
            out[load] = _entries(Slope(*(level * part for part in ratio)), size, level)
        elif load == "d" and self.held is None:
            out[load] = _entries(columns, size, self.length[:, None])
        elif load:
            out[load] = _entries(Slope(*(0 * part for part in columns)), size, 1.0)
        return out


def _last_apart(slope: Slope) -> tuple[Slope, Slope]:
    """Slopes of the columns and of what is held."""
    return Slope(*(part[:, :-1] for part in slope)), Slope(*(part[:, -1:] for part in slope))


def _good(slope: Slope, centre: Array) -> bool:
    """Whether every error is small, as that of an elasticity."""
    return bool(np.all(slope.error <= GOOD * (np.abs(centre) + np.abs(slope.value))))


def _room(contact: Contact, moved: Input, step: float) -> Offsets:
    """Offsets of a difference on both sides, or on the side to which the input may go."""
    why = ""
    for offsets in (CENTRAL, UP, DOWN):
        try:
            for end in (offsets[0], offsets[-1]):
                varied(contact, moved.at(float(step * end)))
        except InvalidValue as refused:
            why = why or str(refused)
        else:
            return offsets
    raise InvalidValue(f"to = {moved.label!r} can be moved to neither side: {why}")


# -------------------------------------------------------------------------- sensitivities
def sensitivity(
    contact: Contact,
    *,
    of: str | Sequence[str],
    to: str | Sequence[str] | None = None,
    F_star: ArrayLike | None = None,
    pressure: ArrayLike | None = None,
    d: ArrayLike | None = None,
) -> Sensitivity:
    r"""Derivatives of columns and critical loads with respect to inputs of the contact.

    .. math:: \frac{\mathrm dc}{\mathrm dp} = \partial_p c -
              \frac{\partial_d c}{\partial_d g}\,\partial_p g, \qquad
              e = \frac{p}{c}\,\frac{\mathrm dc}{\mathrm dp}

    Parameters
    ----------
    contact : Contact
    of : str or list of str
        Columns of `Equilibrium` and of the contact's outputs at the given load, and critical
        loads F* of `transitions`: "F_cr1", "F_cr2", "F_tpca.A", "F_tpca.B".
    to : str or list of str, optional
        Dotted names of numbers of the contact, such as "roughness.sigma" or
        "particles.diameter.mean"; "F_star", "pressure" or "d", whichever is given; or several
        names joined by "+", which move by one factor. Every number and the load when left out,
        with E, ν and H of two equal surfaces, and equal hardnesses, joined: which body is the
        softer changes there, so that the slopes on both sides differ.
    F_star, pressure, d : float or array (N,)
        The load as in `solve`, held while an input moves; at most one, none for critical loads
        alone. F* is held in units of E_ss, which moves with the moduli.

    Returns
    -------
    Sensitivity
        ``derivative[of][to]`` in SI, ``elasticity`` (d ln c/d ln p), and ``error`` and
        ``status`` beside each.

    Raises
    ------
    InvalidValue
        A name that is no number, or a number that is not given or must not move.
    NoEquilibrium
        A single load that the contact does not carry.

    Notes
    -----
    Eighth-order differences of states at given d, ten a load and input; the estimated error is
    the difference from sixth order, and steps are made smaller where it is large. Relative error
    1e-8 or better against differences of solved states where the column is smooth. A slope that
    jumps (two bodies of equal hardness, one of them varied) has both slopes in ``status``, and is
    NaN where they differ by more than 1e-3. Critical loads that do not exist have no derivative,
    nor has F_tpca.C, which `transitions` takes from a grid. At the maximum of the share
    (F_tpca.A) derivatives are exact to 1e-6.

    References
    ----------
    Implicit function theorem; differences after Fornberg 1988, Math. Comp. 51, 699,
    doi:10.1090/S0025-5718-1988-0935077-0.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.sensitivity(contact, of="A_t", to=["roughness.sigma", "pressure"], pressure=1e7)
    >>> round(found.elasticity["A_t"]["roughness.sigma"], 3)
    -0.206
    >>> round(found.elasticity["A_t"]["pressure"], 3)
    0.976
    """
    results = _results(of, contact)
    plain = [name for name in results if name not in CRITICAL]
    if not set(plain) - set(NUMBERS):
        contact = contact.replace(outputs=())
    loads = {"F_star": F_star, "pressure": pressure, "d": d}
    given = {name: value for name, value in loads.items() if value is not None}
    load = ""
    if given or plain:
        load, _, _ = given_load(contact, pressure, F_star, d)
    labels = [to] if isinstance(to, str) else list(to if to is not None else ())
    if to is None:
        labels = _default_inputs(contact) + [load] * bool(load)
    for name in labels:
        if name in loads and name != load:
            raise InvalidValue(f"to = {name!r} needs {name} as the given load")
    moved = [input_of(contact, name) for name in dict.fromkeys(labels) if name != load]

    value: dict[str, Array] = {}
    entries: dict[str, dict[str, Entry]] = {}
    if plain:
        state = solve(contact, **given)  # type: ignore[arg-type]
        columns = state.columns()
        value = {name: columns[name] for name in plain}
        entries = _of_columns(contact, state, moved, load, plain)
    for name in results:
        if name in CRITICAL:
            value[name], entries[name] = _of_critical(contact, name, moved, load)

    start: dict[str, Any] = {each.label: each.values[0] for each in moved}
    if load in labels:
        start[load] = np.atleast_1d(np.asarray(given[load], dtype=float))
    one = {name: name in CRITICAL or np.ndim(given[load]) == 0 for name in results}

    def number(values: NDArray[Any], name: str) -> Any:
        return values.tolist()[0] if one[name] else values

    def elasticity(name: str, label: str) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return entries[name][label].derivative * (start[label] / value[name])

    def table(of: Callable[[str, str], Any]) -> dict[str, dict[str, Any]]:
        return {
            name: {label: number(np.asarray(of(name, label)), name) for label in labels}
            for name in results
        }

    return Sensitivity(
        contact=contact,
        load={load: given[load]} if load else {},
        inputs={label: given[load] if label == load else start[label] for label in labels},
        value={name: number(value[name], name) for name in results},
        derivative=table(lambda name, label: entries[name][label].derivative),
        elasticity=table(elasticity),
        error=table(lambda name, label: entries[name][label].error),
        status=table(lambda name, label: entries[name][label].status),
    )


def _results(of: str | Sequence[str], contact: Contact) -> list[str]:
    """The names of ``of``, each once."""
    known = (*NUMBERS, *(name for each in contact.outputs for name in each.columns), *CRITICAL)
    names = list(dict.fromkeys([of] if isinstance(of, str) else of))
    if not names:
        raise InvalidValue("of is empty; name a column of Equilibrium or a critical load")
    if problems := [
        f"of = {name!r} has no derivative; it must be one of {', '.join(known)}"
        for name in names
        if name not in known
    ]:
        raise InvalidValue(*problems)
    return names


def _of_columns(
    contact: Contact, state: Equilibrium, moved: Sequence[Input], load: str, columns: Sequence[str]
) -> dict[str, dict[str, Entry]]:
    """Derivatives of columns at solved states; NaN with the reason where there is none."""
    d, words = np.atleast_1d(state.d), np.atleast_1d(state.status)
    nothing = np.full(len(d), np.nan)
    out = {
        name: {
            label: Entry(nothing.copy(), nothing.copy(), words.astype(object))
            for label in (*(each.label for each in moved), load)
        }
        for name in columns
    }
    known = np.flatnonzero(np.isfinite(d))
    for start in range(0, len(known), AT_ONCE):
        here = known[start : start + AT_ONCE]
        places = Places(contact, d[here], None if load == "d" else load, columns)
        for label, entries in places.entries(moved, load).items():
            for name, entry in zip(columns, entries, strict=True):
                for whole, part in zip(out[name][label], entry, strict=True):
                    whole[here] = part
    return out


def _of_critical(
    contact: Contact, name: str, moved: Sequence[Input], load: str
) -> tuple[Array, dict[str, Entry]]:
    """A critical load to rounding, and its derivatives: there the share keeps its value."""
    share, level = CRITICAL[name]
    found: Any = transitions(contact)
    for part in name.split("."):
        found = getattr(found, part)
    why = "" if found.status == "found" else found.status
    if not why and not share:
        why = "the strongest bend is taken from a grid of loads and has no derivative"
    if why:
        none = Entry(np.array([np.nan]), np.array([np.nan]), np.array([why], dtype=object))
        value = np.nan if found.value is None else found.value
        return np.array([value]), dict.fromkeys((*(each.label for each in moved), load), none)
    d = np.atleast_1d(solve(contact, F_star=found.value).d)
    for _ in range(8):
        places = Places(contact, d, share, ["F_star"], peak=level is None)
        centre, slope = places.along_d()
        step = ((level or 0.0) - centre[:, -1]) / slope.value[:, -1]
        if abs(step[0]) < 1e-13:
            break
        d = d + step * places.length
    entries = places.entries(moved, load)
    return centre[:, 0], {label: column for label, (column,) in entries.items()}
