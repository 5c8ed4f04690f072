"""Many states at once, each with its own inputs and its own load."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact.contact import Contact
from ..contact.evaluation import Solver, evaluate
from ..contact.interface import Interface, interface
from ..errors import InvalidValue, Mistake, NotCompiled, Problem
from ..populations.materials import BULK
from ..quantities.carried import takes_units
from ..quantities.nearest import guess, near_path
from ..quantities.progress import report_solved, watch_states, weigh_states
from ..quantities.slips import warn_of_slip
from ..quantities.value import Value, meanings_of, paths_of
from .columns import CODE, COLUMNS, as_columns, dataset, quantity_of
from .compiled import batch as engine
from .crowding import is_crowded
from .engine.columns import Numbers
from .engine.run import DOUBTS, own_columns
from .solve import SOLVER, given_load, solve_untold
from .status import Status, Statuses

if TYPE_CHECKING:
    import xarray

__all__ = [
    "FEWEST",
    "OWN_SPOTS",
    "fewest_of",
    "solve_states",
    "state_columns",
    "unknown_inputs",
    "vary_contact",
]

OWN_SPOTS = "each has spots of its own"
"""Why states with outputs take long."""
FEWEST, FEWEST_GROUNDS = 20, 4
"""Different states for which the compiled engine is quicker than tables of each, and of particles
on one field of heights, whose tables take 0.1 to 3 s each."""


@takes_units
def solve_states(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    vary: Mapping[str, ArrayLike] | None = None,
    progress: bool | Callable[[int], None] = False,
) -> xarray.Dataset:
    """N states of a contact: state i has the i-th load and the i-th value of every varied input.

    Parameters
    ----------
    contact : Contact
        The inputs that are not varied.
    pressure, F_star, d : float or array (N,)
        Loads, as in `solve`; exactly one.
    vary : mapping, optional
        Dotted names of inputs and their values, each a number or an array (N,), e.g.
        ``{"roughness.sigma": sigma, "particles.diameter.mean": x_a}``. A mean diameter or an
        areal density of zero stands for two-body contact.
    progress : bool or callable, optional
        Shows rate and time left on standard error; a callable gets the number of states solved.

    Returns
    -------
    xarray.Dataset
        Every column of `Equilibrium` along ``state``, with ``units``, ``long_name`` and
        ``symbol``; load and varied inputs are coordinates. A state without equilibrium, or at a
        separation below −5 σ_s, is NaN with its reason in ``status``. ``engine`` says what found
        each state, as in `Equilibrium`. Inputs, version and citations are attributes.

    Raises
    ------
    InvalidValue
        An unknown name, lengths that do not fit, or a value that the field refuses.

    Warns
    -----
    SlowWarning
        States that cannot share what they are made of, so many that they take more than 10 s:
        how long, and why. Without ``progress``.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> sigma = np.array([50e-9, 100e-9, 200e-9])
    >>> states = tb.equilibria.solve_states(contact, pressure=1e6, vary={"roughness.sigma": sigma})
    >>> states.A_t.dims, states["roughness.sigma"].units
    (('state',), 'm')
    """
    load, loads, arrays = _loads_and_inputs(contact, pressure, F_star, d, vary)
    total = len(loads)
    with watch_states("states", total, progress) as cost:
        columns = _columns(contact, arrays, load, loads, fewest_of(contact))
        cost.report_finished(total)
    return dataset(contact, columns, {load: loads, **arrays}, {})


def state_columns(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    vary: Mapping[str, ArrayLike] | None = None,
    fewest: int | None = None,
) -> Columns:
    """The columns of `solve_states` as plain arrays (N,).

    By the compiled engine from ``fewest`` different states on, which those who have it at work
    already give as 1.
    """
    load, loads, arrays = _loads_and_inputs(contact, pressure, F_star, d, vary)
    return _columns(contact, arrays, load, loads, fewest_of(contact) if fewest is None else fewest)


def fewest_of(contact: Contact) -> int:
    """How many different states go to the compiled engine, at least."""
    grounded = contact.asperity_law.of_surface and not contact.two_body
    return min(FEWEST, FEWEST_GROUNDS) if grounded else FEWEST


def direct_columns(contact: Contact, d: NDArray[np.float64], vary: Arrays) -> Columns:
    """Columns at separations d (N,) with inputs (N,), by quadrature at each: no table is made.

    What a few states of contacts are found by that no other state shares, by the compiled engine
    where it knows them; outputs are left out.
    """
    if engine.available():
        numbers = {name: values.astype(float) for name, values in vary.items()}
        with suppress(NotCompiled):
            columns = own_columns(contact.replace(outputs=()), numbers, "d", d)
            if np.all(columns["doubt"] == ""):
                return columns
    out: Columns = {}
    for which in _split_by_inputs(vary, len(d)):
        varied = vary_contact(
            contact, {name: values[which[0]].item() for name, values in vary.items()}
        )
        contact_interface = Interface(varied)
        places, back = np.unique(d[which], return_inverse=True)
        raw = {
            name: column[back] for name, column in contact_interface.direct_fields(places).items()
        }
        rough = varied.roughness
        columns = as_columns(
            raw, d[which], contact_interface.mean_plane, rough.sigma, varied.E_ss, target=None
        )
        for name, column in columns.items():
            out.setdefault(name, np.empty(len(d), dtype=column.dtype))[which] = column
    return out


def _split_by_inputs(arrays: Arrays, count: int) -> list[NDArray[np.intp]]:
    """Which states have equal inputs."""
    groups = _groups(arrays, count)
    order = np.argsort(groups, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(groups[order])) + 1)


def _loads_and_inputs(
    contact: Contact,
    pressure: ArrayLike | None,
    F_star: ArrayLike | None,
    d: ArrayLike | None,
    vary: Mapping[str, ArrayLike] | None,
) -> tuple[str, NDArray[np.float64], Columns]:
    """Name and values of the load, and the values of every varied input, all (N,)."""
    load, _, _ = given_load(contact, pressure, F_star, d)
    if problems := list(unknown_inputs(contact, vary or ())):
        raise InvalidValue(*problems)
    load_values = {"pressure": pressure, "F_star": F_star, "d": d}[load]
    inputs = {
        load: np.asarray(load_values, float),
        **{k: np.asarray(v) for k, v in (vary or {}).items()},
    }
    try:
        arrays = dict(zip(inputs, np.broadcast_arrays(*inputs.values()), strict=True))
    except ValueError:
        sizes = ", ".join(f"{name} {values.shape}" for name, values in inputs.items())
        raise InvalidValue(
            f"inputs of different lengths: {sizes}; each must be one or N", code=Mistake.SHAPE
        ) from None
    loads = np.atleast_1d(arrays.pop(load))
    arrays = {name: np.atleast_1d(values) for name, values in arrays.items()}
    if loads.ndim > 1:
        raise InvalidValue(
            f"inputs have {loads.ndim} dimensions; give numbers or 1-D arrays", code=Mistake.SHAPE
        )
    for name, values in arrays.items():
        if values.dtype.kind in "iuf" and (quantity := quantity_of(contact, name)):
            for extreme in dict.fromkeys((float(values.min()), float(values.max()))):
                warn_of_slip(name, quantity, extreme)
    return load, loads, arrays


def problem_of_name(where: str, name: str, rule: str, code: Mistake, *, hint: str = "") -> Problem:
    """A mistake in a name that stands as a key, "vary[{!r}]", or as a value, "to = {!r}".

    >>> told = problem_of_name("to = {!r}", "sigm", "is not an input", Mistake.UNKNOWN)
    >>> str(told), told.path, told.value
    ("to = 'sigm' is not an input", 'to', "'sigm'")
    """
    path, is_value, _ = where.partition(" = ")
    value = repr(name) if is_value else None
    return Problem(path.format(name), rule, value, hint=hint, code=code)


def unknown_inputs(
    contact: Contact,
    names: Iterable[str],
    known: Sequence[str] = (),
    where: str = "vary[{!r}]",
) -> Iterator[Problem]:
    """A mistake for each name that is no input of a contact.

    Parameters
    ----------
    contact : Contact
    names : iterable of str
        Dotted names.
    known : sequence of str, optional
        Names of what may vary; every field of the contact by default.
    where : str, optional
        How the place of a name is written.
    """
    for name in names:
        if contact.two_body and name.startswith("particle"):
            rule = "says nothing of a contact without particles"
            yield problem_of_name(where, name, rule, Mistake.BEYOND)
            continue
        try:
            contact.value_at(name)
        except InvalidValue:
            paths = known or list(paths_of(contact))
            above = name.rpartition(".")[0]
            beside = [path for path in paths if path.rpartition(".")[0] == above]
            meant = near_path(name, paths, _meanings_beside(contact, above))
            hint = guess("", beside or paths, meant=meant, show=repr, otherwise="the inputs are ")
            yield problem_of_name(where, name, "is not an input", Mistake.UNKNOWN, hint=hint)


def _meanings_beside(contact: Contact, path: str) -> dict[str, str]:
    """What the fields of the value at a path are, where there is one."""
    try:
        owner = contact.value_at(path)
    except InvalidValue:
        return {}
    return meanings_of(owner, f"{path}.") if path and isinstance(owner, Value) else {}


def _columns(
    contact: Contact,
    arrays: Arrays,
    load: str,
    loads: NDArray[np.float64],
    fewest: int,
) -> Columns:
    """Every column of the states."""
    if contact.outputs:
        return _with_outputs(contact, arrays, load, loads, fewest)
    absent = np.zeros(len(loads), bool)
    for name in ABSENT:
        absent |= arrays.get(name, np.ones(1)) == 0
    bare = {name: v for name, v in arrays.items() if not name.startswith("particles.")}
    if not absent.any():
        return _solve(contact, arrays, load, loads, fewest)
    parts = []
    if not absent.all():
        parts.append((contact, arrays, np.flatnonzero(~absent)))
    parts.append((contact.replace(particles=None), bare, np.flatnonzero(absent)))
    return _join_columns(
        len(loads),
        [
            (which, _solve(base, _take_states(inputs, which), load, loads[which], fewest))
            for base, inputs, which in parts
        ],
    )


DENSITY = "particles.areal_density"
ABSENT = ("particles.diameter.mean", DENSITY)
"""Inputs that are zero where there are no particles."""
LOADS = ("pressure", "F_star", "d")
DEMANDING = (
    *("asperity_law.", "particle_law.law.", "particles.diameter.", engine.SHAPES),
    *engine.MATERIALS,
)
"""Inputs that change the contact of one asperity or particle, which nodes may share."""
FIRST, AT_ONCE = 256, 16_384
"""States laid out first, and at most at a time."""
ALIKE = 2.0
"""Spread of particle sizes over roughness within which states take about as many nodes."""
ROOM = 3_000_000
"""Numbers in the rules of states laid out together, where each has rules of its own."""

Arrays = Mapping[str, NDArray[Any]]
Columns = dict[str, NDArray[Any]]
Which = slice | NDArray[np.intp]
"""Some of the states."""


def _take_states(arrays: Arrays, which: Which) -> Columns:
    return {name: values[which] for name, values in arrays.items()}


def _join_columns(count: int, parts: Iterable[tuple[Which, Columns]]) -> Columns:
    """Columns of all states, put together from subsets in their order."""
    out: Columns = {}
    for which, columns in parts:
        for name in (*COLUMNS, "engine", CODE):
            if name not in out:
                # sentences are few and long
                kind = object if name in ("status", "engine") else columns[name].dtype
                out[name] = np.empty(count, dtype=kind)
            out[name][which] = columns[name]
    return out


def carries(name: str) -> bool:
    """Whether an input decides how the contact carries load, not only what outputs say."""
    return not name.startswith("outputs.") and name.rpartition(".")[2] not in BULK


def _with_outputs(
    contact: Contact, arrays: Arrays, load: str, loads: NDArray[np.float64], fewest: int
) -> Columns:
    """Columns of the states, with those of the outputs of each contact."""
    inputs = {name: v for name, v in arrays.items() if carries(name)}
    with weigh_states(0.5):
        out = _columns(contact.replace(outputs=()), inputs, load, loads, fewest)
    # states of one contact share their spots; those of one surface share its tables, and those
    # that differ in the number of particles alone share the spots of one particle
    count = arrays.get(DENSITY, np.ones(len(loads)))
    alike = {**arrays, DENSITY: count == 0}
    if contact.asperity_law.of_surface:  # where particles stand depends on how many there are
        alike = dict(arrays)
    many = engine.available() and _differ(inputs, len(loads), fewest)
    solver = Solver(_separation, _outputs_at) if many else SOLVER
    for which in _split_by_inputs(alike, len(loads)):
        varied = vary_contact(
            contact, {name: values[which[0]].item() for name, values in arrays.items()}
        )
        crowd = count[which] / (count[which[0]] or 1.0)
        values, _ = evaluate(
            varied,
            interface(varied),
            _take_states(out, which),
            crowd,
            solver=None if load == "d" else solver,
        )
        for name, column in values.items():
            out.setdefault(name, np.full(len(loads), np.nan))[which] = column
        report_solved(0.5 * len(which), OWN_SPOTS)
    return out


def _of_one(contact: Contact, load: str, loads: NDArray[np.float64]) -> Columns:
    """Columns of one contact of many, for which no table is worth while; NaN where unsolved."""
    bare = contact.replace(outputs=())
    try:
        out = own_columns(bare, {}, load, loads)
        rest = np.flatnonzero(out["doubt"] != "")
    except NotCompiled:
        out, rest = {}, np.arange(len(loads))
    if len(rest):
        state = solve_untold(bare, load, loads[rest])
        for name in ("d", "h", "pressure", "A_t", "shadow"):
            out.setdefault(name, np.empty(len(loads)))[rest] = getattr(state, name)
    return out


def _separation(contact: Contact, pressure: NDArray[np.float64]) -> NDArray[np.float64]:
    """d of one contact of many under pressures (N,) [m]; NaN where no separation carries them."""
    return np.asarray(_of_one(contact, "pressure", pressure)["d"])


def _outputs_at(contact: Contact, d: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Outputs of one contact of many at separations (N,) [m], NaN where those are."""
    solved = np.isfinite(d)
    out = {name: np.full(len(d), np.nan) for output in contact.outputs for name in output.columns}
    if solved.any():
        values, _ = evaluate(contact, interface(contact), _of_one(contact, "d", d[solved]))
        for name, column in values.items():
            out[name][solved] = column
    return out


def _solve(
    contact: Contact, arrays: Arrays, load: str, loads: NDArray[np.float64], fewest: int
) -> Columns:
    """Columns by the compiled engines where they can, of other states one by one."""
    numeric = all(values.dtype.kind in "iuf" for values in arrays.values())
    if not (numeric and engine.available() and _differ(arrays, len(loads), fewest)):
        return _by_groups(contact, arrays, load, loads)
    numbers = {name: values.astype(float) for name, values in arrays.items()}
    if fewest < FEWEST and not _differ(arrays, len(loads), FEWEST):  # nodes that few share
        try:
            return _by_own(contact, numbers, load, loads)
        except NotCompiled as error:
            return _by_groups(contact, arrays, load, loads, str(error))
    try:
        return _by_nodes(contact, numbers, load, loads)
    except NotCompiled:
        try:
            return _by_own(contact, numbers, load, loads)
        except NotCompiled as other:
            why = str(other)
            if contact.asperity_law.of_surface:  # such surfaces share no nodes
                return _by_groups(contact, arrays, load, loads, why)
        odd = np.zeros(len(loads), bool)
        for name, values in numbers.items():
            if _unnumbered_name(name).startswith(DEMANDING):
                odd |= values != _value_in(contact, name)
    parts = []
    if len(even := np.flatnonzero(~odd)):
        plain = {
            k: v[even] for k, v in numbers.items() if not _unnumbered_name(k).startswith(DEMANDING)
        }
        try:
            parts.append((even, _by_nodes(contact, plain, load, loads[even])))
        except NotCompiled:
            odd[:] = True
    if len(rest := np.flatnonzero(odd)):
        some = _take_states(arrays, rest)
        parts.append((rest, _by_groups(contact, some, load, loads[rest], why)))
    return _join_columns(len(loads), parts)


def tables_each(contact: Contact, vary: Iterable[str]) -> bool:
    """Whether states that differ in these inputs each need new tables: 0.1 s a state.

    Or nearly so: of particles that break, each takes 1 to 60 ms by the compiled engine.
    """
    names = [name for name in vary if name not in LOADS]
    if contact.asperity_law.of_surface:  # any input that carries is one of the whole surface
        names = [name for name in names if carries(name)]
        return bool(names) and not solves_each(contact, names)
    if not any(_unnumbered_name(name).startswith(DEMANDING) for name in names):
        return False
    breaks = any(population.strength is not None for population in contact.populations)
    if not breaks and solves_each(contact, names):
        return False
    return bool(contact.populations)


def goes_one_by_one(contact: Contact, vary: Iterable[str]) -> bool:
    """Whether each of the states that differ in these inputs binds a contact of its own."""
    names = [name for name in vary if name not in LOADS and carries(name)]
    return bool(names) and not solves_each(contact, names)


def why_outputs(contact: Contact, names: Iterable[str]) -> str:
    """Why contacts of which these columns are asked go one by one; empty without outputs."""
    of_outputs = {name for output in contact.outputs for name in output.columns}
    asked_of = [name for name in names if name in of_outputs]
    return f"{OWN_SPOTS}, for {', '.join(asked_of[:3])}" if asked_of else ""


def solves_each(contact: Contact, vary: Iterable[str]) -> bool:
    """Whether the compiled engine solves states of this contact by laws of their own.

    Asked of the engine itself: it lays out one state, and refuses models that it does not know.

    Parameters
    ----------
    contact : Contact
    vary : iterable of str
        Dotted names of the inputs in which the states differ.
    """
    if not engine.available():
        return False
    try:
        values = {name: np.full(1, float(_value_in(contact, name))) for name in vary}
        Numbers(contact.replace(outputs=()), values, 1)
    except (NotCompiled, InvalidValue, TypeError, ValueError):  # no number, or no such input
        return False
    return True


def _value_in(contact: Contact, name: str) -> Any:
    """The value of an input in the contact itself."""
    value: object = contact
    for segment in name.split("."):
        if isinstance(value, tuple) and segment.isdigit() and int(segment) < len(value):
            value = value[int(segment)]
        else:
            value = getattr(value, segment, None)
    return np.nan if value is None else value


def _unnumbered_name(name: str) -> str:
    """The name of an input without the number of its population."""
    return ".".join(segment for segment in name.split(".") if not segment.isdigit())


def _by_nodes(contact: Contact, arrays: Arrays, load: str, loads: NDArray[np.float64]) -> Columns:
    """Columns by the compiled engine; `NotCompiled` for inputs that it does not know."""
    by_sizes = not engine.bare(contact, arrays) and engine.own_sizes(contact, arrays)
    order = None
    if by_sizes and np.ptp(fine := engine.fineness(arrays)) > ALIKE * fine.min():
        order = np.argsort(fine, kind="stable")  # those that need as many nodes side by side

    def solve_part(here: Which) -> tuple[Which, Columns, int]:
        if order is not None:
            here = order[here]
        some_loads = loads[here]
        batch = engine.States(contact, _take_states(arrays, here), len(some_loads))
        return (
            here,
            _with_words(contact, batch.columns(load, some_loads)),
            batch.rows.of_single_states,
        )

    here, columns, size = solve_part(slice(0, FIRST))  # refused, or compiled, once
    at_once = max(min(AT_ONCE, ROOM * FIRST // max(size, 1)), 1)
    starts = range(FIRST, len(loads), at_once)
    with ThreadPoolExecutor(engine.threads() if by_sizes else 1) as pool:
        rest = pool.map(solve_part, (slice(start, start + at_once) for start in starts))
        parts = chain([(here, columns)], (result[:2] for result in rest))
        out = _join_columns(len(loads), _with_progress(parts))

    def solve_again(which: NDArray[np.intp], why: str) -> Columns:
        try:
            return _by_own(contact, _take_states(arrays, which), load, loads[which])
        except NotCompiled:
            return _by_groups(contact, _take_states(arrays, which), load, loads[which], why)

    return _without_doubts(out, (engine.NOT_BALANCED, engine.NOT_MONOTONE), solve_again)


def _by_own(contact: Contact, arrays: Arrays, load: str, loads: NDArray[np.float64]) -> Columns:
    """Columns by quadrature of each state; doubtful states are solved one by one."""
    at_once = (
        AT_ONCE // 16 if any(population.strength for population in contact.populations) else AT_ONCE
    )

    def solve_from(start: int) -> tuple[Which, Columns]:
        here = np.arange(start, min(start + at_once, len(loads)))
        columns = own_columns(
            contact, _take_states(arrays, here), load, loads[here], engine.threads()
        )
        return here, _with_words(contact, columns)

    def solve_again(which: NDArray[np.intp], why: str) -> Columns:
        return _by_groups(contact, _take_states(arrays, which), load, loads[which], why)

    out = _join_columns(len(loads), _with_progress(map(solve_from, range(0, len(loads), at_once))))
    return _without_doubts(out, DOUBTS, solve_again)


def _with_words(contact: Contact, columns: Columns) -> Columns:
    """Columns of a compiled engine with status and path in words; its doubts stand as the path."""
    doubt = columns.pop("doubt")
    code = columns["status"].astype(np.int8)
    code[(code == Status.OK) & is_crowded(contact, columns["A_t"])] = Status.CROWDED
    code[doubt != ""] = Status.UNSOLVED
    path = np.where(doubt, doubt, "compiled")
    words = Statuses.from_codes(code, one_field=contact.asperity_law.of_surface).words
    return columns | {"status": words, CODE: code, "engine": path}


def _without_doubts(
    out: Columns, doubts: Iterable[str], solve_again: Callable[[NDArray[np.intp], str], Columns]
) -> Columns:
    """Columns in which doubtful states are replaced by those of another engine."""
    for why in doubts:
        if len(which := np.flatnonzero(out["engine"] == why)):
            for name, column in solve_again(which, why).items():
                out[name][which] = column
    return out


def _with_progress(parts: Iterable[tuple[Which, Columns]]) -> Iterator[tuple[Which, Columns]]:
    for here, columns in parts:
        report_solved(len(columns["status"]))
        yield here, columns


def _all(count: int, word: str) -> NDArray[np.object_]:
    return np.full(count, word, dtype=object)


def _by_groups(
    contact: Contact, arrays: Arrays, load: str, loads: NDArray[np.float64], why: str = ""
) -> Columns:
    """Columns of one contact after another; ``why`` says what kept the compiled engine away."""
    parts = []
    for which in _split_by_inputs(arrays, len(loads)):
        state = vary_contact(
            contact, {name: values[which[0]].item() for name, values in arrays.items()}
        )
        result = solve_untold(state, load, loads[which])
        path = f"numpy: {why}" if why and result.engine != "compiled" else result.engine
        parts.append((which, result.columns() | {"engine": _all(len(which), path)}))
        report_solved(len(which), why)
    return _join_columns(len(loads), parts)


def _differ(arrays: Arrays, count: int, fewest: int) -> bool:
    """Whether there are so many different states; mostly the first of them tell."""
    first = _take_states(arrays, np.arange(min(count, 50 * fewest)))
    return any(
        _groups(some, n).max() + 1 >= fewest
        for some, n in ((first, min(count, 50 * fewest)), (arrays, count))
    )


def _groups(arrays: Arrays, count: int) -> NDArray[np.intp]:
    """A number for each state, the same for equal inputs, from zero without a gap."""
    group = np.zeros(count, np.intp)
    for values in arrays.values():
        codes = np.unique(values, return_inverse=True)[1].ravel()
        both = group * (codes.max() + 1) + codes
        group = np.unique(both, return_inverse=True)[1].ravel()
    return group


def vary_contact(contact: Contact, changes: Mapping[str, object]) -> Contact:
    """The contact with some inputs changed; a size or density of zero removes the particles."""
    if any(changes.get(name, 1) == 0 for name in ABSENT):
        kept = {name: v for name, v in changes.items() if not name.startswith("particles.")}
        return contact.replace(particles=None).replace(**kept)
    return contact.replace(**changes)
