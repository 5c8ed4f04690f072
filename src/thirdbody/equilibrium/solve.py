r"""Equilibrium: the separation at which the contact carries the load.

.. math:: F_t(d) = F

`solve` scans the total load once, brackets every load in it, and polishes all of them together
by a safeguarded Halley iteration on :math:`\ln F_t(d) = \ln F` with analytic derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact.asperity_sums import ReducedSum
from ..contact.contact import Contact
from ..contact.evaluation import Solver, evaluate
from ..contact.interface import Interface, interface
from ..contact.particle_sums import PrintedIntegrals
from ..contact.pressed import about_pressed
from ..errors import InvalidValue, Mistake, NoEquilibrium, NotCompiled, Note, Problem, tell_of_range
from ..quantities.arguments import is_empty, need_one, only_one
from ..quantities.carried import takes_units
from ..quantities.nearest import ValuesByName
from ..quantities.say import percent, value_of
from ..quantities.units import to_si
from .columns import Equilibrium, PopulationShare, as_columns
from .compiled import batch as engine
from .crowding import about_area, is_crowded
from .doubts import BEYOND, SHADOW, about_elastic, about_hardness, about_particles
from .load_scan import RESIDUAL, is_carried, load_scan
from .status import DEEPEST, Status, Statuses

__all__ = ["pull_off", "roots", "solve"]

Array = NDArray[np.float64]

Index = NDArray[np.intp]

LoadBranch = Literal["loading", "unloading"]
"""Where several separations carry a load: that of loading, or of unloading."""


class _Loads(NamedTuple):
    """What the states of one call are asked for."""

    target: Array | None
    """Pressures (N,) [Pa]; None where separations are given."""
    F_star: Array | None
    """As they are given (N,) [1]; None where something else is."""
    scalar: bool
    """Whether it was one number; so are then the columns."""
    branch: str = ""
    """That of the states; without it they are on all of them."""
    with_notes: bool = True
    """Whether they come with the notes on the model's validity."""


class _Separations(NamedTuple):
    """Where the loads of one call are carried, (N,)."""

    d: Array
    """[m]; NaN where none carries the load."""
    iterations: Index
    status: Statuses
    raw: dict[str, Array] | None = None
    """Columns of those that are finite; None where they are not evaluated yet."""
    path: str = "numpy"
    """The engine, and why it was this one."""


UNITS_HINTS = {
    "pressure": "in Pa: 5 MPa are 5e6",
    "F_star": "F/(A_n E_ss), without a unit",
    "d": "in m: 200 nm are 200e-9",
    "h": "in m: 200 nm are 200e-9",
}
"""What to write for a load that is text."""
UNITS = {"pressure": "Pa", "F_star": "1", "d": "m", "h": "m"}


def given_load(
    contact: Contact,
    pressure: ArrayLike | None,
    F_star: ArrayLike | None,
    d: ArrayLike | None,
) -> tuple[str, Array, bool]:
    """Name of the given load, its values (F in Pa or d in m), and whether it was one number."""
    name, flat, one = given_numbers(pressure=pressure, F_star=F_star, d=d)
    return name, flat * contact.E_ss if name == "F_star" else flat, one


def _about_text(name: str, text: str) -> tuple[str, Mistake]:
    """What to write for a load that is text, and whether that is of another dimension."""
    hint = UNITS_HINTS.get(name, "")
    try:
        to_si(text, UNITS.get(name, "1"))
    except InvalidValue as error:
        if error.code is Mistake.UNIT:
            return f"{str(error).partition(', e.g. ')[0]}; {hint}", Mistake.UNIT
    return hint, Mistake.KIND


def given_numbers(**quantities: ArrayLike | None) -> tuple[str, Array, bool]:
    """Name of the one given quantity, its values, and whether it was one number.

    Loads must be > 0; separations, d and h, may be any number.
    """
    name, value = only_one(**quantities)
    try:
        if (kind := np.asarray(value).dtype.kind) not in "fiu":
            if kind == "b":
                raise InvalidValue(
                    Problem(
                        name,
                        "must be a number, not a truth value",
                        repr(value),
                        code=Mistake.KIND,
                    )
                )
            raise TypeError
        values = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        shown = repr(value) if len(repr(value)) <= 80 else repr(value)[:76] + " ..."
        hint, code = _about_text(name, value) if isinstance(value, str) else ("", Mistake.KIND)
        rule = "must be a number or an array of numbers"
        raise InvalidValue(Problem(name, rule, shown, hint=hint, code=code)) from None
    if values.ndim > 1:
        raise InvalidValue(
            f"{name} has {values.ndim} dimensions; give a number or a 1-D array", code=Mistake.SHAPE
        )
    flat = np.atleast_1d(values)
    good = np.isfinite(flat) & ((name in ("d", "h")) | (flat > 0))
    allowed = "be finite" if name in ("d", "h") else "be finite and > 0"
    problems = [
        Problem(name, f"must {allowed}", f"{v:g}", code=Mistake.RANGE) for v in flat[~good][:5]
    ]
    if not problems and not values.size:
        problems.append(is_empty(name, "give at least one value"))
    if problems:
        raise InvalidValue(*problems)
    return name, flat, values.ndim == 0


@takes_units
def solve(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    branch: LoadBranch = "loading",
) -> Equilibrium:
    r"""Separation, areas, load shares and mode of a contact under a load.

    Solves :math:`(1-\varsigma(d))\,F_{ss}(d) + F_{sa}(d) = F`.

    Parameters
    ----------
    contact : Contact
    pressure : float or array (N,), optional
        Nominal pressure p = F/A_n [Pa].
    F_star : float or array (N,), optional
        Load F* = F/(A_n E_ss) [1].
    d : float or array (N,), optional
        Separation from the mean asperity height [m]: the load follows. Exactly one of the
        three is given.
    branch : {"loading", "unloading"}, optional
        Where the load does not fall monotonically with d (see `roots`): the largest d that
        carries the load, met on approach, or the smallest, left on retreat. A warning says so.
        Particles that break do not heal: with a ``strength`` there is the loading branch alone.

    Returns
    -------
    Equilibrium
        Floats for a number, arrays for an array.

    Raises
    ------
    InvalidValue
        No load, two loads, or a load that is not positive and finite; a single d below −5 σ_s
        from the mean asperity height, where no asperity model holds.
    NoEquilibrium
        A single load that no separation above −3 σ_s carries, or over which the load jumps
        (`Horng2022` with particles of one size). In an array such a state, and one below −5 σ_s,
        is NaN with a sentence in ``status``, which begins with "jump" for a jump.

    Warns
    -----
    RangeWarning
        Outside the model's validity; the sentences are kept in ``warnings``.

    Notes
    -----
    Relative error 1e-10 against 30-digit quadrature for d from −4 to +12 σ_s; residual of the
    balance 1e-12 or better over twelve decades of load. No state is "ok" with a residual above
    1e-9, unless 4 ulp of d change the load by as much.

    References
    ----------
    Horng et al. 2022, Lubricants 10(7), 164, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> state = tb.solve(contact, pressure=5e6)
    >>> state.mode, round(state.particle_load_share, 3)
    ('hybrid', 0.78)
    """
    name, values, scalar = given_load(contact, pressure, F_star, d)
    need_one("branch", branch, *get_args(LoadBranch))
    if branch == "unloading" and any(
        population.strength is not None for population in contact.populations
    ):
        raise InvalidValue(
            Problem(
                "branch",
                "has no meaning with particles that break (strength): what is broken does not heal",
                repr(branch),
                hint="use branch = 'loading'",
                code=Mistake.IDLE,
            )
        )
    # E·F*/E is not F* to the last digit: the given values are kept
    F_star_values = np.atleast_1d(np.asarray(F_star, dtype=float)) if name == "F_star" else None
    result = _result(contact, name, values, scalar, F_star_values, branch)
    if scalar and not (status := Status(int(result.status_code))).has_numbers:
        raise NoEquilibrium(str(result.status), status)
    for sentence in result.warnings:
        tell_of_range(sentence)
    return result


def solve_untold(contact: Contact, load: str, loads: Array) -> Equilibrium:
    """Solve at loads (N,) without the notes on the model's validity."""
    name, values, _ = given_load(
        contact, **{"pressure": None, "F_star": None, "d": None, load: loads}
    )
    F_star_values = np.asarray(loads, dtype=float) if name == "F_star" else None
    return _result(contact, name, values, False, F_star_values, "loading", with_notes=False)


def _separation(contact: Contact, pressure: Array) -> Array:
    """d under pressures (N,) [m]; NaN where no separation carries them."""
    return np.atleast_1d(solve_untold(contact.replace(outputs=()), "pressure", pressure).d)


def _outputs_at(contact: Contact, d: Array) -> dict[str, Array]:
    """Outputs of a contact at separations (N,) [m], NaN where those are."""
    solved = np.isfinite(d)
    out = {name: np.full(len(d), np.nan) for output in contact.outputs for name in output.columns}
    if solved.any():
        for name, values in solve_untold(contact, "d", d[solved]).outputs.items():
            out[name][solved] = values
    return out


SOLVER = Solver(_separation, _outputs_at)


def _result(
    contact: Contact,
    name: str,
    values: Array,
    scalar: bool,
    F_star: Array | None,
    branch: str,
    *,
    with_notes: bool = True,
) -> Equilibrium:
    """States at the given pressures [Pa] or separations [m], as `given_load` gives them."""
    contact_interface = interface(contact)
    loads = _Loads(None if name == "d" else values, F_star, scalar, branch, with_notes)
    if loads.target is None:
        deep = values < contact_interface.asperities.deepest
        if scalar and deep.any():
            rule = f"is refused: {why_deep(contact)}"
            raise InvalidValue(Problem("d", rule, f"{values[0]:g} m", code=Mistake.RANGE))
        places = _Separations(
            np.where(deep, np.nan, values),
            np.where(deep, 0, 1),
            Statuses.from_codes(
                np.where(deep, Status.TOO_DEEP, Status.OK), one_field=contact_interface.one_field
            ),
            path="numpy: the separations are given",
        )
    else:
        try:
            places = _solve_compiled(contact_interface, values)
        except NotCompiled as why:
            places = _Separations(
                *load_scan(contact_interface).solve(values, branch), path=f"numpy: {why}"
            )
    return _state(contact, contact_interface, loads, places)


def deepest(contact: Contact) -> float:
    """Lowest separation d [m] at which states are evaluated."""
    return float(interface(contact).asperities.deepest)


def why_deep(contact: Contact) -> str:
    """What is allowed of separations, and why."""
    if interface(contact).one_field:
        why = interface(contact).why_lowest
    else:
        why = (
            f"{-ReducedSum.DEEPEST:g} sigma_s from the mean asperity height, below which no "
            "asperity model holds"
        )
    return (
        f"it must be at least {value_of(deepest(contact), 'm')}, {why}; check its sign and its unit"
    )


@takes_units
def roots(
    contact: Contact, *, pressure: float | None = None, F_star: float | None = None
) -> list[tuple[Equilibrium, bool]]:
    """Every separation that carries one load, from the largest down, and whether it is stable.

    A root is stable where the load falls with d. More than one exists where the load does not
    fall with d everywhere: the printed `Horng2022`, or particles that shade more asperities than
    they carry for, as particles softer than the nominal pressure do. Loading and unloading then
    differ (hysteresis). A jump of the load is no root. Of particles that break all roots lie on
    the curve of loading.

    Parameters
    ----------
    contact : Contact
    pressure, F_star : float
        The load, as in `solve`; exactly one.

    Returns
    -------
    list of (Equilibrium, bool)

    Raises
    ------
    NoEquilibrium
        No separation carries the load: it is too large, too small, or in a jump.

    References
    ----------
    Horng et al. 2022, Lubricants 10(7), 164, doi:10.3390/lubricants10070164: the printed equations
    whose load is not monotone.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> found = tb.equilibria.roots(contact, F_star=1e-5)
    >>> [(round(state.d_star, 3), stable) for state, stable in found]
    [(3.048, True)]
    """
    _, values, _ = given_load(contact, pressure, F_star, None)
    contact_interface = interface(contact)
    scan = load_scan(contact_interface)
    cells, falling = scan.all_cells(float(values[0]))
    if not len(cells):
        status, why = scan.why_not(float(values[0]))
        raise NoEquilibrium(why, status)
    target = np.full(len(cells), values[0])
    solutions: list[tuple[float, int, bool]] = []
    passed: list[tuple[Status, str]] = []
    for direction in (True, False):
        which = np.flatnonzero(falling == direction)
        if len(which):
            d, iterations, causes = scan.polish(target[which], cells[which], falling=direction)
            passed += causes.values()
            solutions += [
                (d[i], iterations[i], direction) for i in range(len(d)) if i not in causes
            ]
    if not solutions:
        status, why = passed[0]
        raise NoEquilibrium(why, status)
    solutions.sort(key=lambda item: -item[0])
    one, ok = _Loads(values[:1], None, True), Statuses.ok(1)
    return [
        (
            _state(contact, contact_interface, one, _Separations(np.array([x]), np.array([n]), ok)),
            stable,
        )
        for x, n, stable in solutions
    ]


@takes_units
def pull_off(contact: Contact) -> tuple[float, float]:
    r"""The largest tension that adhesion holds, and the separation where it does.

    .. math:: p_{off} = -\min_d F_t(d)/A_n

    Parameters
    ----------
    contact : Contact
        With an adhesive asperity law, `JKR` with ``unloading=True`` or `DMT`.

    Returns
    -------
    pressure, d : float
        Tension p_off [Pa], zero without adhesion, and separation [m].

    References
    ----------
    Fuller, Tabor 1975, Proc. R. Soc. A 345, 327, doi:10.1098/rspa.1975.0138.

    Examples
    --------
    >>> import thirdbody as tb
    >>> rubber = tb.Material(E=2e6, nu=0.49, H=1e6)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(rubber, rubber),
    ...                      roughness=tb.Roughness(sigma=1e-6, R=100e-6),
    ...                      asperity_law=tb.asperity.JKR(w=0.05, unloading=True))
    >>> tb.equilibria.pull_off(contact)[0] > 0
    True
    """
    from scipy.optimize import minimize_scalar

    contact_interface = interface(contact)
    asperities = contact_interface.asperities
    steps = np.linspace(asperities.searched, min(asperities.highest, 10.0), 400)
    d = asperities.centre + asperities.sigma_s * steps
    F = contact_interface.load(d)[:, 0]
    i = int(np.argmin(F))
    if F[i] >= 0:
        return 0.0, float(d[-1])
    minimum = minimize_scalar(
        lambda x: float(contact_interface.load(np.array([x]))[0, 0]),
        bounds=(d[max(i - 1, 0)], d[min(i + 1, len(d) - 1)]),
        method="bounded",
        options={"xatol": 1e-10 * asperities.sigma_s},
    )
    return -float(minimum.fun), float(minimum.x)


def _solve_compiled(contact_interface: Interface, target: Array) -> _Separations:
    """Separations, evaluations, status and columns by the compiled engine, where it pays."""
    if len(target) < engine.FEWEST:
        raise NotCompiled(f"fewer than {engine.FEWEST} loads of one contact")
    batch = engine.batch(contact_interface)
    which = np.zeros(len(target), np.int64)
    h, iterations, fate, columns = batch.solve(which, target)
    of_kernel = batch.rows.interfaces[0]
    d = of_kernel["centre"] + of_kernel["sigma_s"] * h
    status = Statuses.ok(len(d))
    residual = np.abs((columns["F_ss"] + columns["F_sa"]) / target - 1)
    rest = np.flatnonzero((fate != 0) | ~(residual <= RESIDUAL))
    if not len(rest):
        return _Separations(d, iterations, status, columns, "compiled")
    # the other engine says why, or what the load does there
    d[rest], iterations[rest], other = load_scan(contact_interface).solve(target[rest], "loading")
    status.take(other, rest)
    solved = np.isfinite(d)
    for name, values in contact_interface.fields(d[more := rest[solved[rest]]]).items():
        columns[name][more] = values
    raw = {name: values[solved] for name, values in columns.items()}
    return _Separations(d, iterations, status, raw, "compiled")


def _state(
    contact: Contact, contact_interface: Interface, loads: _Loads, places: _Separations
) -> Equilibrium:
    """Every column at these separations."""
    target, scalar = loads.target, loads.scalar
    d, status, raw = _only_carried(contact_interface, target, places)
    solved = np.isfinite(d)
    full = dict(raw)
    if not solved.all():
        full = {name: np.full(len(d), np.nan) for name in raw}
        for name, values in raw.items():
            full[name][solved] = values
    rough = contact.roughness
    columns = as_columns(
        full,
        d,
        contact_interface.mean_plane,
        rough.sigma,
        contact.E_ss,
        target=target,
        F_star=loads.F_star,
    )
    codes: int | NDArray[np.int8] = status.codes
    columns |= {"status": status.words.astype(str), "iterations": places.iterations}
    parts: list[dict[str, Array]] = [{} for _ in contact.populations]
    outputs, more = ({}, [])  # type: tuple[dict[str, Any], list[str]]
    if contact.outputs:
        outputs, more = evaluate(
            contact,
            contact_interface,
            columns,
            parts=parts if len(parts) > 1 else (),
            solver=None if target is None else SOLVER,
        )
    shares = _population_shares(contact, contact_interface, d, columns, scalar, parts)
    if scalar:
        columns = {name: values[0].item() for name, values in columns.items()}
        codes = int(status.codes[0])
        outputs = {name: values[0].item() for name, values in outputs.items()}
    notes: tuple[str, ...] = ()
    if loads.with_notes:
        branches = _branches(contact_interface, target, d, loads.branch)
        notes = (*_warnings(contact, contact_interface, full, d), *branches, *more)
    return Equilibrium(
        contact=contact,
        warnings=notes,
        populations=shares,
        outputs=ValuesByName(outputs),
        engine=places.path,
        status_code=codes,
        **columns,
    )


def _only_carried(
    contact_interface: Interface, target: Array | None, places: _Separations
) -> tuple[Array, Statuses, dict[str, Array]]:
    """Columns with NaN where the load is not carried: no state is "ok" without a balance.

    One whose contacts would have grown together keeps its numbers, and is not "ok".
    """
    d, status = places.d, places.status
    where = np.flatnonzero(np.isfinite(d))
    raw = contact_interface.fields(d[where]) if places.raw is None else places.raw
    F, at = raw["F_ss"] + raw["F_sa"], d[where]
    is_finite = np.isfinite(F + raw["A_t"])
    good, close = is_finite.copy(), is_crowded(contact_interface.contact, raw["A_t"])
    if target is not None:
        load = target[where]
        good &= np.abs(F - load) <= RESIDUAL * load
        if len(loose := np.flatnonzero(is_finite & ~good)):
            slope, ulp = contact_interface.load(at[loose])[:, 1], load_scan(contact_interface).ulp
            good[loose] = is_carried(F[loose], slope, load[loose], ulp)
    if good.all() and not close.any():
        return d, status, raw
    d, status = d.copy(), status.copy()
    status.set(where[close], Status.CROWDED)
    for i in np.flatnonzero(~good):
        law = contact_interface.contact.asperity_law
        code = Status.BEYOND_LAWS
        why = code.sentence + f" ({law.name}: {law.beyond})" * bool(law.beyond)
        if is_finite[i]:
            code = Status.UNSOLVED
            why = (
                f"no equilibrium: {value_of(F[i], 'Pa', 6)} do not balance the load "
                f"{value_of(load[i], 'Pa', 6)}"
            )
        status.set(where[i], code, f"{why} at d = {value_of(at[i], 'm', 6)}")
    d[where[~good]] = np.nan
    return d, status, {name: values[good] for name, values in raw.items()}


def _population_shares(
    contact: Contact,
    contact_interface: Interface,
    d: Array,
    columns: Mapping[str, Array],
    scalar: bool,
    outputs: Sequence[dict[str, Array]],
) -> tuple[PopulationShare, ...]:
    """Load and area of each of several populations at separations d."""
    if len(contact_interface.populations) < 2:
        return ()
    out = []
    pairs = zip(contact.populations, contact_interface.populations, strict=True)
    for number, (particles, response) in enumerate(pairs):
        particle_fields = {name: np.full(len(d), np.nan) for name in ("F_sa", "A_sa")}
        solved = np.isfinite(d)
        fields = response.fields(d[solved])
        particle_fields["F_sa"][solved] = fields["F_sa"]
        particle_fields["A_sa"][solved] = fields["A_e"] + fields["A_ep"] + fields["A_p"]
        with np.errstate(invalid="ignore", divide="ignore"):
            values = {
                "F_sa_star": particle_fields["F_sa"] / contact.E_ss,
                "A_sa": particle_fields["A_sa"],
                "load_share": particle_fields["F_sa"] / columns["pressure"],
                "area_share": particle_fields["A_sa"] / columns["A_t"],
            }
        mine: dict[str, Any] = outputs[number]
        if scalar:
            values = {name: value[0].item() for name, value in values.items()}
            mine = {name: value[0].item() for name, value in mine.items()}
        name = particles.name or f"particles {number + 1}"
        out.append(PopulationShare(name=name, outputs=ValuesByName(mine), **values))
    return tuple(out)


def _branches(
    contact_interface: Interface, target: Array | None, d: Array, branch: str
) -> list[str]:
    """A sentence where other separations carry these loads as well."""
    if target is None or not branch or (scan := load_scan(contact_interface)).monotone:
        return []
    count = scan.separations(target[np.isfinite(d)])
    if not np.any(several := count > 1):
        return []
    loads = "the load" if len(d) == 1 else f"{np.count_nonzero(several)} of the {len(d)} loads"
    most = f"{count.max()}" if len(d) == 1 else f"up to {count.max()}"
    side = "largest" if branch == "loading" else "smallest"
    what = (
        f"{most} separations carry {loads}, as the load does not fall everywhere with d: this is "
        f"the {branch} branch, the {side} of them"
    )
    return [Note(what, code="branches", effect=1.0, action="roots gives all")]


def _warnings(
    contact: Contact, contact_interface: Interface, full: dict[str, Array], d: Array
) -> tuple[str, ...]:
    """Notes on states outside the model's validity, one sentence each."""
    out: list[str] = [*about_area(contact, float(np.nanmax(full["A_t"], initial=0.0)))]
    height = (d - contact_interface.asperities.centre) / contact_interface.asperities.sigma_s
    if not contact_interface.one_field and np.any(height < DEEPEST):
        what = (
            f"the separation d goes down to {np.nanmin(height):.3g} sigma_s: below {DEEPEST:g} "
            "every asperity is in contact and the model is invalid"
        )
        out.append(Note(what, code="deep", effect=1.0, action="check the load and its unit"))
    if np.any(np.isfinite(d)):
        tips = contact.asperity_law
        share = contact_interface.asperities.share_beyond(float(np.nanmin(d)))
        if share > 0.1:
            what = (
                f"{tips.name}: at the highest load {percent(share, digits=2)} of the asperities' "
                f"load is on those {tips.beyond}"
            )
            out.append(Note(what, code=BEYOND))
    out += about_elastic(contact, contact_interface, full, d)
    out += about_hardness(contact)
    scaled = [output.name for output in contact.outputs if output.one_by_one(contact)]
    if contact_interface.one_field and scaled:
        names = ", ".join(f"outputs.{name}" for name in scaled)
        out.append(
            f"the law field has no single spots: for asperities {names} takes the summits of zmc, "
            "in number and area scaled to its load and area"
        )
    if contact_interface.particles is not None:
        out += about_particles(contact)
        if contact_interface.particles.in_one_layer >= 0.3:
            what = (
                "fragments in one layer would cover "
                f"{contact_interface.particles.in_one_layer:.2g} of the nominal area where the gap "
                "closes"
            )
            out.append(Note(what, code="fragments"))
        if contact_interface.one_field and 0.3 < np.nanmax(full["shadow"], initial=0.0) < 1:
            what = (
                f"particles lie over {np.nanmax(full['shadow']):.2g} of the nominal area: the "
                "ground that they press down is meant for 0.3 at most"
            )
            out.append(Note(what, code="ground"))
        if np.any(full["shadow"] >= 1):
            out.append(SHADOW)
        printed = any(
            isinstance(response, PrintedIntegrals) for response in contact_interface.populations
        )
        if printed and np.any(d < 0):
            out.append("d < 0: the paper's particle integrals have no meaning there")
        if np.any(np.isfinite(d)):
            out += about_pressed(contact, d)
    return tuple(out)
