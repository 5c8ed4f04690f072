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

import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import Equilibrium, about, provenance, quantity_of
from ..equilibrium.load import as_loads
from ..equilibrium.modes import EPS_1, EPS_2, CriticalStatus
from ..equilibrium.solve import given_load, solve
from ..equilibrium.states import carries, why_outputs
from ..equilibrium.transitions import transitions
from ..equilibrium.words import critical_name, happens
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, place_note, tell_of_range
from ..quantities.arguments import is_empty, need_place
from ..quantities.carried import takes_units
from ..quantities.notebook import Card, Row, words_of
from ..quantities.progress import watch_contacts
from ..quantities.record import Column, TableRecord, Variable
from ..quantities.uncertain import is_uncertain, shift_value
from .differences import FULL, QUICK, Entry, Places, Rule
from .inputs import NUMBERS, TO, Input, _room, input_of, inputs

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Sensitivity", "sensitivity"]

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


MEANINGS = {
    "derivative": "derivative of the result with respect to the input",
    "elasticity": "relative change of the result over that of the input",
    "error": "estimated error of the derivative",
    "status": "ok, or why there is no derivative",
    "value": "the result",
    "input": "the input",
}
"""What the labelled data of derivatives hold."""


def unit_over(unit: str, other: str) -> str:
    """The unit of a derivative.

    >>> unit_over("m", "1"), unit_over("1", "Pa"), unit_over("m", "m"), unit_over("Pa", "m^2/s")
    ('m', '1/Pa', '1', 'Pa/(m^2/s)')
    """
    if other in ("1", "", unit):
        return "1" if other == unit else unit
    return f"{unit}/({other})" if set(" /") & set(other) else f"{unit}/{other}"


# -------------------------------------------------------------------------- result
@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Sensitivity(TableRecord):
    """Derivatives of results with respect to inputs: floats, or arrays over several loads.

    Made by `sensitivity`, where accuracy stands. As labelled data derivatives lie along ``of``, the
    results, along ``to``, the inputs, and along the loads where there are several; a table has a
    row for each of these pairs. Units, symbols and meanings are coordinates: ``of_units``,
    ``to_units``, ``derivative_units``.

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
    (-0.054, 'ok')
    """

    contact: Contact = field(repr=False)
    load: dict[str, Any]
    inputs: dict[str, Any]
    value: dict[str, Any]
    derivative: dict[str, dict[str, Any]]
    elasticity: dict[str, dict[str, Any]]
    error: dict[str, dict[str, Any]]
    status: dict[str, dict[str, Any]]

    @takes_units
    def table(self, at: int = 0) -> str:
        """The elasticities at one load as lines of text, the strongest input first.

        Parameters
        ----------
        at : int, optional
            Number of the load, where several were given.

        Raises
        ------
        InvalidValue
            There is no such load.
        """
        counts = [np.size(values) for row in self.elasticity.values() for values in row.values()]
        need_place("at", at, max(counts, default=1))

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

    @takes_units
    def ufloats(self, vary: Mapping[str, Any]) -> dict[str, object]:
        r"""Every result as a number with the uncertainty that its inputs give it, to first order.

        .. math:: c = c_0 + \sum_i \frac{\mathrm dc}{\mathrm dp_i}\,(p_i - p_{i,0})

        Parameters
        ----------
        vary : mapping
            Of inputs, by the names that they have in ``inputs``, numbers of the package
            `uncertainties`, which may be correlated; quantities with a unit too.

        Returns
        -------
        dict
            Results by name, each correlated with its inputs and the other results: what is made of
            them has the right uncertainty. Over several loads lists.

        Raises
        ------
        InvalidValue
            An input whose slope is not known, whose nominal value is not that of the contact, or
            that has no uncertainty.

        Examples
        --------
        >>> import thirdbody as tb
        >>> from uncertainties import ufloat
        >>> steel = tb.materials["S45C"]
        >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
        ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
        >>> slopes = tb.sensitivity(contact, of="h", to="roughness.sigma", pressure=5e6)
        >>> sigma = ufloat(100e-9, 5e-9)
        >>> h = slopes.ufloats({"roughness.sigma": sigma})["h"]
        >>> print(f"{h:.2uP}, {h / sigma:.2uP}")
        (2.81±0.15)×10⁻⁷, 2.8066±0.0073
        """
        problems = []
        for label, uncertain in vary.items():
            if label not in self.inputs:
                options = ", ".join(self.inputs)
                problems.append(
                    Problem("", f"vary[{label!r}] must be one of {options}", code=Mistake.OPTION)
                )
            elif not is_uncertain(uncertain):
                problems.append(
                    Problem(
                        f"vary[{label!r}]",
                        "must be a ufloat",
                        f"{uncertain!r:.60}",
                        code=Mistake.KIND,
                    )
                )
            elif not np.allclose(uncertain.nominal_value, self.inputs[label], rtol=1e-9, atol=0):
                problems.append(
                    Problem(
                        f"vary[{label!r}]",
                        f"must be about {self.inputs[label]!r}, which the slopes are taken at",
                        f"{uncertain}",
                        code=Mistake.RANGE,
                    )
                )
        if problems:
            raise InvalidValue(*problems)

        def one(of: str, i: int | None) -> object:
            def as_float(value: Any) -> float:
                return float(value if i is None or np.ndim(value) == 0 else value[i])

            slopes = [
                (as_float(self.derivative[of][label]), uncertain)
                for label, uncertain in vary.items()
            ]
            if unknown := [label for label, (slope, _) in zip(vary, slopes, strict=True)
                           if not math.isfinite(slope)]:  # fmt: skip
                reason = self.status[of][unknown[0]]
                raise InvalidValue(
                    f"{of} has no slope to {unknown[0]}: {reason}", code=Mistake.BEYOND
                )
            return shift_value(as_float(self.value[of]), slopes)

        return {
            of: one(of, None) if np.ndim(value) == 0 else [one(of, i) for i in range(len(value))]
            for of, value in self.value.items()
        }

    def _abouts(self) -> tuple[list[Column], list[Column]]:
        """What the results are, and what the inputs are."""
        of = [
            Column("F*", "1", happens(name)) if name in CRITICAL else about(name)
            for name in self.value
        ]
        to = [
            Column(*(quantity[key] for key in ("symbol", "unit", "meaning")))
            if (quantity := quantity_of(self.contact, name.partition("+")[0]))
            else about(name)
            for name in self.inputs
        ]
        return of, to

    def _load_dimension(self) -> tuple[str, ...]:
        """The dimension of several loads; none for one."""
        return tuple(name for name, values in self.load.items() if np.ndim(values))

    def variables(self) -> dict[str, Variable]:
        """Derivatives, elasticities, errors and statuses, and what they are taken at."""
        along = self._load_dimension()
        count = [np.size(self.load[name]) for name in along]

        def stack(values: Iterable[ArrayLike]) -> NDArray[np.generic]:
            return np.array([np.broadcast_to(np.asarray(value), count) for value in values])

        def pairs(table: Mapping[str, Mapping[str, ArrayLike]]) -> NDArray[np.generic]:
            return np.array([stack(row[to] for to in self.inputs) for row in table.values()])

        of, to = self._abouts()
        slopes = {unit_over(one.unit, other.unit) for one in of for other in to}
        units = {
            "derivative": _unit_of_all(slopes, "derivative_units"),
            "error": _unit_of_all(slopes, "derivative_units"),
            "value": _unit_of_all({one.unit for one in of}, "of_units"),
            "input": _unit_of_all({one.unit for one in to}, "to_units"),
            "elasticity": {"units": "1"},
        }
        both = ("of", "to", *along)
        labels = {
            name: {"long_name": meaning} | units.get(name, {}) for name, meaning in MEANINGS.items()
        }
        return {
            "derivative": Variable(both, pairs(self.derivative), labels["derivative"]),
            "elasticity": Variable(both, pairs(self.elasticity), labels["elasticity"]),
            "error": Variable(both, pairs(self.error), labels["error"]),
            "status": Variable(both, pairs(self.status).astype(str), labels["status"]),
            "value": Variable(("of", *along), stack(self.value.values()), labels["value"]),
            "input": Variable(("to", *along), stack(self.inputs.values()), labels["input"]),
        }

    def coordinates(self) -> dict[str, Variable]:
        """Results, inputs, several loads, and units, symbols and meanings of each."""
        out: dict[str, Variable] = {}
        of, to = self._abouts()
        for dim, names, columns in (("of", self.value, of), ("to", self.inputs, to)):
            out[dim] = Variable((dim,), list(names))
            for key in ("units", "symbol", "long_name"):
                out[f"{dim}_{key}"] = Variable((dim,), [column.labels[key] for column in columns])
        units = [[unit_over(one.unit, other.unit) for other in to] for one in of]
        out["derivative_units"] = Variable(("of", "to"), np.array(units))
        for name in self._load_dimension():
            out[name] = Variable((name,), np.asarray(self.load[name]), about(name).labels)
        return out

    def attributes(self) -> Mapping[str, object]:
        """Inputs, version and citations."""
        return provenance(self.contact)

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: the elasticities, an input a row; of several loads the first."""
        rows = [Row("input", list(self.elasticity))]
        rows += [
            Row(
                to,
                [words_of(np.ravel(row[to])[0]) for row in self.elasticity.values()],
                "" if (quantity := quantity_of(self.contact, to)) is None else quantity["meaning"],
            )
            for to in self.inputs
        ]
        yield Card("Elasticities d ln c/d ln p", rows)


def _unit_of_all(units: set[str], coordinate: str) -> dict[str, str]:
    """Attributes that say the unit of a column, or the coordinate that says each."""
    return {"units": next(iter(units))} if len(units) == 1 else {"units_in": coordinate}


def _default_inputs(contact: Contact) -> list[str]:
    """Every input that may move; joined where several decide (who is softer, which side wider)."""
    numbers = inputs(contact)
    pair = contact.surfaces
    alike = pair.alike
    groups: dict[object, list[str]] = {}
    for name, value in numbers.items():
        side, _, last = name.rpartition(".")
        body = side in ("surfaces.first", "surfaces.second") or side.endswith(".material")
        if body and last == "H":
            key: object = ("H", value)
        elif body and alike and value and not side.endswith(".material"):
            key = (last, "surfaces")
        else:
            key = name
        groups.setdefault(key, []).append(name)
    return [label for names in groups.values() if moves(contact, label := "+".join(names))]


def moves(contact: Contact, label: str, rule: Rule = FULL) -> bool:
    """Whether an input may change: not so the height of a seat that has none."""
    try:
        _room(contact, input_of(contact, label, TO), rule.steps[0], rule.reach)
    except InvalidValue:
        return False
    return True


# -------------------------------------------------------------------------- sensitivities
@takes_units
def sensitivity(
    contact: Contact,
    *,
    of: str | Sequence[str],
    to: str | Sequence[str] | None = None,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    quick: bool = False,
    progress: bool | Callable[[int], None] = False,
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
    pressure, F_star, d : float or array (N,)
        The load as in `solve`, held while an input moves; at most one, none for critical loads
        alone. F* is held in units of E_ss, which moves with the moduli.
    quick : bool, optional
        Elasticities to three digits at least, by fourth-order differences from a third of the
        states, each by quadrature: no table is made for a changed input. ``error`` is then that
        of second order, and ``status`` doubts from 1e-2.
    progress : bool or callable, optional
        Shows on standard error how many contacts are done; a callable gets their number.

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

    Warns
    -----
    SlowWarning
        Contacts that take more than 10 s, one by one: how long. Without ``progress``.

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
    loads_by_name = {name: value for name, value in loads.items() if value is not None}
    load = ""
    if loads_by_name or plain:
        load, _, _ = given_load(contact, pressure, F_star, d)
    labels = _labels(contact, to, load)
    moved = [input_of(contact, name, TO) for name in dict.fromkeys(labels) if name != load]

    rule = QUICK if quick else FULL
    carrying = [one for one in moved if any(carries(name) for name in one.names)]
    why = why_outputs(contact, plain)
    with watch_contacts("sensitivity", 2 * rule.reach * len(carrying), progress, why):
        value, entries = _values_and_slopes(contact, results, loads_by_name, moved, load, rule)

    start: dict[str, Any] = {moved_input.label: moved_input.values[0] for moved_input in moved}
    if load in labels:
        start[load] = np.atleast_1d(np.asarray(loads_by_name[load], dtype=float))
    one = {name: name in CRITICAL or np.ndim(loads_by_name[load]) == 0 for name in results}

    def number(values: NDArray[np.generic], name: str) -> Any:
        return values.tolist()[0] if one[name] else values

    def elasticity(name: str, label: str) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return entries[name][label].derivative * (start[label] / value[name])

    def table(of: Callable[[str, str], NDArray[np.generic]]) -> dict[str, dict[str, Any]]:
        return {
            name: {label: number(np.asarray(of(name, label)), name) for label in labels}
            for name in results
        }

    return Sensitivity(
        contact=contact,
        load={load: loads_by_name[load]} if load else {},
        inputs={label: loads_by_name[load] if label == load else start[label] for label in labels},
        value={name: number(value[name], name) for name in results},
        derivative=table(lambda name, label: entries[name][label].derivative),
        elasticity=table(elasticity),
        error=table(lambda name, label: entries[name][label].error),
        status=table(lambda name, label: entries[name][label].status),
    )


def _labels(contact: Contact, to: str | Sequence[str] | None, load: str) -> list[str]:
    """Names of the inputs that are varied: those of ``to``, or every input and the load."""
    if to is None:
        return _default_inputs(contact) + [load] * bool(load)
    labels = [to] if isinstance(to, str) else list(to)
    for name in labels:
        if name in ("F_star", "pressure", "d") and name != load:
            raise InvalidValue(
                Problem("to", f"needs {name} as the given load", repr(name), code=Mistake.MISSING)
            )
    return labels


def _results(of: str | Sequence[str], contact: Contact) -> list[str]:
    """The names of ``of``, each once."""
    options = (
        *NUMBERS,
        *(name for output in contact.outputs for name in output.columns),
        *CRITICAL,
    )
    names = list(dict.fromkeys([of] if isinstance(of, str) else of))
    if not names:
        raise InvalidValue(is_empty("of", "name a column of Equilibrium or a critical load"))
    if problems := [
        Problem(
            "of",
            "has no derivative",
            repr(name),
            hint=f"it must be one of {', '.join(options)}",
            code=Mistake.OPTION,
        )
        for name in names
        if name not in options
    ]:
        raise InvalidValue(*problems)
    return names


def _values_and_slopes(
    contact: Contact,
    results: Sequence[str],
    loads_by_name: Mapping[str, ArrayLike],
    moved: Sequence[Input],
    load: str,
    rule: Rule,
) -> tuple[dict[str, Array], dict[str, dict[str, Entry]]]:
    """Values of the results, and their derivatives with every input."""
    value: dict[str, Array] = {}
    entries: dict[str, dict[str, Entry]] = {}
    if plain := [name for name in results if name not in CRITICAL]:
        state = solve(contact, **as_loads(loads_by_name))
        columns = state.columns()
        value = {name: columns[name] for name in plain}
        entries = _of_columns(contact, state, moved, load, plain, rule)
    for name in results:
        if name in CRITICAL:
            value[name], entries[name] = _of_critical(contact, name, moved, load, rule)
    return value, entries


def _of_columns(
    contact: Contact,
    state: Equilibrium,
    moved: Sequence[Input],
    load: str,
    columns: Sequence[str],
    rule: Rule,
) -> dict[str, dict[str, Entry]]:
    """Derivatives of columns at solved states; NaN with the reason where there is none."""
    d, words = np.atleast_1d(state.d), np.atleast_1d(state.status)
    nothing = np.full(len(d), np.nan)
    out = {
        name: {
            label: Entry(nothing.copy(), nothing.copy(), words.astype(object))
            for label in (*(moved_input.label for moved_input in moved), load)
        }
        for name in columns
    }
    solved = np.flatnonzero(np.isfinite(d))
    for start in range(0, len(solved), AT_ONCE):
        here = solved[start : start + AT_ONCE]
        places = Places(contact, d[here], None if load == "d" else load, columns, rule=rule)
        for label, entries in places.entries(moved, load).items():
            for name, entry in zip(columns, entries, strict=True):
                for whole, values in zip(out[name][label], entry, strict=True):
                    whole[here] = values
    return out


def _of_critical(
    contact: Contact, name: str, moved: Sequence[Input], load: str, rule: Rule
) -> tuple[Array, dict[str, Entry]]:
    """A critical load to rounding, and its derivatives: there the share keeps its value."""
    share, level = CRITICAL[name]
    critical = transitions(contact).entries()[name]
    why = "" if critical.status == CriticalStatus.FOUND else critical.status
    if not why and not share:
        why = "the strongest bend is taken from a grid of loads and has no derivative"
    if why:
        none = Entry(np.array([np.nan]), np.array([np.nan]), np.array([why], dtype=object))
        value = np.nan if critical.value is None else critical.value
        return np.array([value]), dict.fromkeys(
            (*(moved_input.label for moved_input in moved), load), none
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        state = solve(contact, F_star=critical.value)
    for note in state.warnings:  # of a load that the user did not give
        tell_of_range(place_note(note, critical_name(name)))
    d = np.atleast_1d(state.d)
    for _ in range(8):
        places = Places(contact, d, share, ["F_star"], peak=level is None, rule=rule)
        centre, slope = places.along_d()
        step = ((level or 0.0) - centre[:, -1]) / slope.value[:, -1]
        if abs(step[0]) < 1e-13:
            break
        d = d + step * places.length
    entries = places.entries(moved, load)
    return centre[:, 0], {label: column for label, (column,) in entries.items()}
