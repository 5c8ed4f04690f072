r"""Equilibrium: the separation at which the contact carries the load.

.. math:: F_t(d) = F

`solve` scans the total load once, brackets every load in it, and polishes all of them together
by a safeguarded Halley iteration on :math:`\ln F_t(d) = \ln F` with analytic derivatives.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import engine
from .asperities import ReducedSum
from .contact import Contact, Interface, interface
from .errors import InvalidValue, NoEquilibrium, NotCompiled, RangeWarning
from .numerics import halley_root
from .outputs.base import column, evaluate

__all__ = ["Equilibrium", "pull_off", "roots", "solve"]

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Number = float | Array

DEEPEST = -3.0
"""Lowest separation searched, in σ_s from the mean asperity height: every asperity touches."""
CHUNK = 16_384
"""States solved together: their arrays stay in the processor's cache."""
P_S, HYBRID, S_S = "p-s", "hybrid", "s-s"
RESIDUAL, ULPS = 1e-9, 4
"""Largest imbalance |F_t/F − 1| of a state that is "ok", unless so many ulp of d explain it."""
RISE = 1e-6
"""Rise of the load with d, over the load, that counts as one."""
HALVINGS = 64
MODES = np.array(["", S_S, HYBRID, P_S])
TOO_DEEP = (
    f"not solved: the separation is lower than {-ReducedSum.DEEPEST:g} sigma_s from the mean "
    "asperity height, where no asperity model holds; check its sign and its unit"
)
EPS_1, EPS_2 = 0.02, 0.05
"""Default shares that separate the contact modes: read-off resolution, and the paper's 95 %."""


def _column(symbol: str, unit: str, meaning: str) -> Any:
    return field(metadata={"symbol": symbol, "unit": unit, "meaning": meaning})


@dataclass(frozen=True, slots=True, kw_only=True)
class Equilibrium:
    """The solved contact: floats for one load, arrays for several.

    Areas are real areas per nominal area; F* = F/(A_n E_ss). A state that could not be solved
    holds NaN and a sentence in `status`.

    `d` counts from the datum of the particle law: the mean asperity height, except for
    `Horng2022`, which like the paper's eq. (8) puts that height at σ. `h`, from the mean surface
    plane, is the separation to compare between models.

    Made by `solve`, where accuracy and source stand. The columns are named as in the
    nomenclature.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> state = tb.solve(contact, pressure=[1e6, 5e6, 2e7])  # Pa
    >>> state.mode.tolist(), state.d_star.round(2).tolist()
    (['hybrid', 'hybrid', 'hybrid'], [3.27, 2.43, 1.64])
    >>> state.modes(eps_1=0.05).tolist()  # 95 % of the area count as all of it
    ['p-s', 'hybrid', 'hybrid']
    """

    contact: Contact = field(repr=False)
    d: Number = _column("d", "m", "separation from the mean asperity height")
    h: Number = _column("h", "m", "separation from the mean surface plane")
    d_star: Number = _column("d*", "1", "separation d/σ")
    F_star: Number = _column("F_t*", "1", "load F/(A_n E_ss)")
    pressure: Number = _column("p", "Pa", "nominal pressure")
    F_ss_star: Number = _column("F_ss*", "1", "load on asperities")
    F_sa_star: Number = _column("F_sa*", "1", "load on particles")
    A_t: Number = _column("A_t*", "1", "real contact area")
    A_ss: Number = _column("A_ss*", "1", "real area of asperities")
    A_sa: Number = _column("A_sa*", "1", "real area of particles on surface 1")
    A_sa2: Number = _column("A_sa2*", "1", "real area of particles on surface 2")
    A_e: Number = _column("A_e*", "1", "elastic area")
    A_ep: Number = _column("A_ep*", "1", "elastoplastic area")
    A_p: Number = _column("A_p*", "1", "plastic area")
    shadow: Number = _column("ς", "1", "share of area in which particles keep asperities apart")
    particle_load_share: Number = _column("F_sa/F_t", "1", "load share of particles")
    particle_area_share: Number = _column("A_sa,t*", "1", "area share of particles")
    mode: str | NDArray[np.str_] = _column("mode", "", "contact mode")
    """p-s, hybrid or s-s by area; empty where nothing touches, and in a state without a number."""
    status: str | NDArray[np.str_] = _column("status", "", "ok, or why there is no state")
    residual: Number = _column("r", "1", "relative imbalance |F_t/F − 1|")
    iterations: int | NDArray[np.int_] = _column("n", "", "evaluations of the load")
    warnings: tuple[str, ...] = ()
    populations: tuple[PopulationShare, ...] = ()
    """What each of several populations carries; empty for one."""
    outputs: Mapping[str, Number] = field(default_factory=dict)
    """Every column of the outputs that the contact carries, by name."""
    engine: str = "numpy"
    """What found the separations: "compiled", or "numpy: " and why the compiled engine did not."""

    @property
    def scales(self) -> dict[str, float]:
        """What makes the starred quantities: E_ss [Pa] and σ [m]."""
        return {"E_ss": self.contact.E_ss, "sigma": self.contact.roughness.sigma}

    def columns(self) -> dict[str, NDArray[Any]]:
        """Every column as a 1-D array, those of the outputs last."""
        own = {name: np.atleast_1d(getattr(self, name)) for name in COLUMNS}
        return own | {name: np.atleast_1d(values) for name, values in self.outputs.items()}

    def modes(
        self, *, eps_1: float = EPS_1, eps_2: float = EPS_2, basis: str = "area"
    ) -> str | NDArray[np.str_]:
        """Contact mode with other thresholds, by area (as in the paper) or by load."""
        share = self.particle_area_share if basis == "area" else self.particle_load_share
        return _mode(share, eps_1, eps_2)


@dataclass(frozen=True, slots=True, kw_only=True)
class PopulationShare:
    """What one of several populations of particles carries: floats for one load, else arrays.

    Part of `Equilibrium.populations`; the shares of all populations add up to
    ``particle_load_share`` and ``particle_area_share``.
    """

    name: str
    F_sa_star: Number
    """Load over A_n E_ss [1]"""
    A_sa: Number
    """Real area on surface 1 over A_n [1]"""
    load_share: Number
    """of the total load [1]"""
    area_share: Number
    """of the total real area [1]"""


COLUMNS = {item.name: dict(item.metadata) for item in fields(Equilibrium) if item.metadata}
"""Symbol, unit and meaning of every column of a result."""


def about(name: str) -> dict[str, str]:
    """Symbol, unit and meaning of a column, of the state itself or of an output."""
    return COLUMNS[name] if name in COLUMNS else column(name)._asdict()


def columns_of(contact: Contact) -> tuple[str, ...]:
    """Names of the columns that states of a contact have."""
    return (*COLUMNS, *(name for output in contact.outputs for name in output.columns))


def _mode(particle_share: ArrayLike, eps_1: float, eps_2: float) -> Any:
    share = np.asarray(particle_share)
    # codes first: choosing among strings is slow
    sliding = np.where(1 - share >= 1 - eps_2, 1, 2)
    code = np.where(share >= 1 - eps_1, 3, sliding)
    out = MODES[np.where(np.isnan(share), 0, code)]
    return out if out.ndim else str(out)


def given_load(
    contact: Contact,
    pressure: ArrayLike | None,
    F_star: ArrayLike | None,
    d: ArrayLike | None,
) -> tuple[str, Array, bool]:
    """Which quantity is given, its values (F in Pa or d in m), and whether it was one number."""
    given = {
        name: value
        for name, value in (("pressure", pressure), ("F_star", F_star), ("d", d))
        if value is not None
    }
    if len(given) != 1:
        names = ", ".join(given) or "none"
        raise InvalidValue(f"give exactly one of pressure, F_star, d; got {names}")
    ((name, value),) = given.items()
    try:
        if np.asarray(value).dtype.kind in "USO":
            raise TypeError
        values = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InvalidValue(f"{name} = {value!r} must be a number or an array of numbers") from None
    if values.ndim > 1:
        raise InvalidValue(f"{name} has {values.ndim} dimensions; give a number or a 1-D array")
    flat = np.atleast_1d(values)
    good = np.isfinite(flat) & ((name == "d") | (flat > 0))
    allowed = "be finite" if name == "d" else "be finite and > 0"
    problems = [f"{name} = {v:g} must {allowed}" for v in flat[~good][:5]]
    if not problems and not values.size:
        problems.append(f"{name} is empty; give at least one value")
    if problems:
        raise InvalidValue(*problems)
    return name, flat * contact.E_ss if name == "F_star" else flat, values.ndim == 0


def solve(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    d: ArrayLike | None = None,
    branch: str = "loading",
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
    ('hybrid', 0.884)
    """
    name, values, scalar = given_load(contact, pressure, F_star, d)
    if branch not in ("loading", "unloading"):
        raise InvalidValue(f"branch = {branch!r} must be 'loading' or 'unloading'")
    bound = interface(contact)
    raw, path = None, "compiled"
    target = None if name == "d" else values
    if target is None:
        deep = values < deepest(contact)
        if scalar and deep.any():
            raise InvalidValue(f"d = {values[0]:g} m is refused: {why_deep(contact)}")
        separation = np.where(deep, np.nan, values)
        status = np.where(deep, TOO_DEEP, "ok").astype(object)
        iterations, path = np.where(deep, 0, 1), "numpy: the separations are given"
    else:
        try:
            separation, iterations, status, raw = _compiled(bound, target)
        except NotCompiled as why:
            path = f"numpy: {why}"
            separation, iterations, status = load_scan(bound).solve(target, branch)
    # E·F*/E is not F* to the last digit: the given values are kept
    given = np.atleast_1d(np.asarray(F_star, dtype=float)) if name == "F_star" else None
    result = _state(
        contact,
        bound,
        separation,
        status,
        iterations,
        target,
        scalar,
        given,
        raw=raw,
        path=path,
        branch=branch,
    )
    if scalar and result.status != "ok":
        raise NoEquilibrium(result.status)
    for sentence in result.warnings:
        warnings.warn(sentence, RangeWarning, stacklevel=2)
    return result


def deepest(contact: Contact) -> float:
    """Lowest separation d [m] at which states are evaluated."""
    rough = contact.roughness
    datum = next((contact.law_of(each).centre for each in contact.populations), 0.0)
    return datum * rough.sigma - ReducedSum.DEEPEST * rough.sigma_s


def why_deep(contact: Contact) -> str:
    """What is allowed of separations, and why."""
    return (
        f"it must be at least {deepest(contact):.4g} m, {-ReducedSum.DEEPEST:g} sigma_s from the "
        "mean asperity height, below which no asperity model holds; check its sign and its unit"
    )


def roots(
    contact: Contact, *, pressure: float | None = None, F_star: float | None = None
) -> list[tuple[Equilibrium, bool]]:
    """Every separation that carries one load, from the largest down, and whether it is stable.

    A root is stable where the load falls with d. More than one exists where the load does not
    fall with d everywhere: the printed `Horng2022`, or particles that shade more asperities than
    they carry for, as particles softer than the nominal pressure do. Loading and unloading then
    differ (hysteresis). A jump of the load is no root.

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
    >>> [(round(state.d_star, 3), stable) for state, stable in tb.roots(contact, F_star=1e-5)]
    [(3.214, True)]
    """
    _, values, _ = given_load(contact, pressure, F_star, None)
    bound = interface(contact)
    scan = load_scan(bound)
    cells, falling = scan.all_cells(float(values[0]))
    if not len(cells):
        raise NoEquilibrium(scan.why_not(float(values[0])))
    target = np.full(len(cells), values[0])
    found, passed = [], []  # type: list[tuple[float, int, bool]], list[str]
    for direction in (True, False):
        which = np.flatnonzero(falling == direction)
        if len(which):
            d, iterations, jumps = scan.polish(target[which], cells[which], falling=direction)
            passed += jumps.values()
            found += [(d[i], iterations[i], direction) for i in range(len(d)) if i not in jumps]
    if not found:
        raise NoEquilibrium(passed[0])
    found.sort(key=lambda item: -item[0])
    ok = np.array(["ok"], dtype=object)
    return [
        (_state(contact, bound, np.array([x]), ok, np.array([n]), values[:1], True), stable)
        for x, n, stable in found
    ]


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
    >>> pull_off(contact)[0] > 0
    True
    """
    from scipy.optimize import minimize_scalar

    bound = interface(contact)
    asperities = bound.asperities
    steps = np.linspace(DEEPEST, min(asperities.highest, 10.0), 400)
    d = asperities.centre + asperities.sigma_s * steps
    F = bound.load(d)[:, 0]
    i = int(np.argmin(F))
    if F[i] >= 0:
        return 0.0, float(d[-1])
    found = minimize_scalar(
        lambda x: float(bound.load(np.array([x]))[0, 0]),
        bounds=(d[max(i - 1, 0)], d[min(i + 1, len(d) - 1)]),
        method="bounded",
        options={"xatol": 1e-10 * asperities.sigma_s},
    )
    return -float(found.fun), float(found.x)


def explained(F: Array, slope: Array, target: Array, ulp: float) -> NDArray[np.bool_]:
    """Whether a load is carried: to `RESIDUAL` of it, or to what `ULPS` ulp of d change."""
    steep = np.where(np.isfinite(slope), ULPS * ulp * np.abs(slope), 0.0)  # infinite at a jump
    return np.abs(F - target) <= RESIDUAL * target + steep


class LoadScan:
    """The total load on a grid of separations, from the highest down, ready to bracket loads.

    Attributes
    ----------
    d, log_F : array (M,)
        Falling separations and ln of the load there, from the highest that carries a load.
    monotone : bool
        The load grows by no more than `RISE` of itself while d grows.
    """

    def __init__(self, bound: Interface):
        self.bound = bound
        asperities = bound.asperities
        sigma_s, centre = asperities.sigma_s, asperities.centre
        low = centre + DEEPEST * sigma_s
        near = np.arange(DEEPEST, min(10.0, asperities.highest), 0.2)
        far = np.arange(10.0, asperities.highest, 1.0)
        # the last asperity of a bounded distribution sets in like a power of its distance
        edge = asperities.highest - np.geomspace(1e-6, 0.2, 12)
        grid = [centre + sigma_s * np.concatenate([near, far, edge])]
        particles = bound.particles
        if particles is not None:
            top = particles.reach
            grid.append(np.linspace(low, max(top, low), 65)[1:])
            if len(marks := np.unique(particles.marks)):
                marks = np.unique(np.clip(marks, low, max(top, low)))
                grid.append(np.interp(np.arange(0, len(marks), 0.25), np.arange(len(marks)), marks))
            if particles.monotone:
                # the last particle sets in like a power of its distance
                grid.append(top - (top - low) * np.geomspace(1e-8, 1e-2, 13))
            else:
                count = int(np.ceil((top - low) / particles.resolution))
                grid.append(np.linspace(low, top, min(max(count, 2), 20_000)))
        d = np.unique(np.concatenate(grid))
        F, slope, _ = bound.load(d).T
        if np.any(F < 0):
            # adhesion: the load sets in at a separation where it changes its sign
            d = np.append(d, self._onset(d, F) - sigma_s * np.geomspace(1e-9, 0.2, 30))
            d = np.unique(d)
            F, slope, _ = bound.load(d).T
        self.ulp = float(np.spacing(np.abs(d[[0, -1]]).max()))
        if len(turns := self._turns(d, F, slope)):
            d = np.unique(np.append(d, turns))
            F = bound.load(d)[:, 0]
        highest = np.flatnonzero(F > 0)[-1] + 1
        with np.errstate(divide="ignore"):
            self.d, self.log_F = d[:highest][::-1], np.log(np.maximum(F[:highest][::-1], 0.0))
        most = np.maximum.accumulate(self.log_F)
        self.monotone = bool(np.all(most - self.log_F <= RISE))

    def _turns(self, d: Array, F: Array, slope: Array) -> Array:
        """Separations where the load turns between falling and rising with d, or jumps up."""
        low, high, size = d[:-1], d[1:], np.maximum(np.abs(F[:-1]), np.abs(F[1:]))
        rises = slope * (d[-1] - d[0]) > RESIDUAL * np.abs(F)  # else rounding of what is flat
        jumps = ~rises[:-1] & ~rises[1:] & (F[1:] - F[:-1] > RESIDUAL * size)
        cells = np.flatnonzero((rises[:-1] != rises[1:]) | jumps)
        low, high, by_load, first = low[cells], high[cells], jumps[cells], rises[:-1][cells]
        F_low = F[:-1][cells]
        for _ in range(HALVINGS if len(cells) else 0):
            middle = 0.5 * (low + high)
            F_m, slope_m, _ = self.bound.load(middle).T
            right = np.where(by_load, F_m <= F_low, (slope_m > 0) == first)
            low, high = np.where(right, middle, low), np.where(right, high, middle)
            F_low = np.where(right, F_m, F_low)
        return np.concatenate([low, high])

    def _onset(self, d: Array, F: Array) -> float:
        """The highest separation at which the load changes its sign."""
        from scipy.optimize import brentq

        above = np.flatnonzero(F > 0)
        if not len(above) or above[-1] == len(d) - 1:
            return float(d[-1])
        low, high = d[above[-1]], d[above[-1] + 1]
        return float(brentq(lambda x: self.bound.load(np.array([x]))[0, 0], low, high, xtol=1e-24))

    # ------------------------------------------------------------------ brackets
    def cells(self, target: Array, branch: str) -> Index:
        """Index i of the cell d[i] > root >= d[i+1] for each load, −1 where there is none."""
        log_target = np.log(target)
        if branch == "loading" or self.bound.monotone:
            # first separation, coming down, at which the load is reached
            reached = np.maximum.accumulate(self.log_F)
            cell = np.searchsorted(reached, log_target, side="left") - 1
            cell = np.where(cell >= len(self.d) - 1, -1, cell)
        else:
            # going up from the deepest, the last separation at which the load is still carried
            carried = np.minimum.accumulate(self.log_F[::-1])[::-1]
            cell = np.searchsorted(carried, log_target, side="left") - 1
            cell = np.where(cell >= len(self.d) - 1, -1, cell)
        return np.where(log_target <= self.log_F[0], -1, cell)

    def all_cells(self, target: float) -> tuple[Index, Index]:
        """Every cell in which the load is crossed, and whether the load falls with d there."""
        above = self.log_F >= np.log(target)
        cells = np.flatnonzero(above[1:] != above[:-1])
        return cells, above[1:][cells]

    def separations(self, target: Array) -> Index:
        """How many separations carry each load, those beside a jump of the load among them."""
        with np.errstate(invalid="ignore"):
            ends = np.sort(np.stack([self.log_F[:-1], self.log_F[1:]]), axis=0)
        begun, ended = (np.searchsorted(np.sort(row), np.log(target)) for row in ends)
        return begun - ended

    def why_not(self, target: float) -> str:
        """Why no separation carries this load."""
        E = self.bound.contact.E_ss
        top = float(np.exp(self.log_F.max()))
        if target > top:
            return (
                f"no equilibrium: the load {target:.4g} Pa (F* = {target / E:.3g}) is beyond "
                f"{top:.4g} Pa (F* = {top / E:.3g}), the most this model carries down to a "
                f"separation of {DEEPEST:g} sigma_s; check the unit of the load"
            )
        return (
            f"no equilibrium: the load {target:.4g} Pa (F* = {target / E:.3g}) is below the "
            "smallest load this model resolves; check the unit of the load"
        )

    # ------------------------------------------------------------------ roots
    def polish(
        self, target: Array, cells: Index, *, falling: bool = True
    ) -> tuple[Array, Array, dict[int, str]]:
        """Roots inside their cells, to rounding; evaluations; and where the load jumps, how.

        At a jump the separation is the next one that carries the load and more.
        """
        high, low = self.d[cells], self.d[cells + 1]
        log_target = np.log(target)
        top, bottom = self.log_F[cells], self.log_F[cells + 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            part = (log_target - top) / (bottom - top)
        part = np.where(np.isfinite(part), np.clip(part, 0.0, 1.0), 0.5)
        start = high + part * (low - high)

        def imbalance(d: Array, which: Index) -> tuple[Array, Array, Array]:
            F, F1, F2 = self.bound.load(d).T
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = F1 / F
                return np.log(F) - log_target[which], slope, F2 / F - slope**2

        d, residual, iterations = halley_root(imbalance, low, high, start, falling=falling)
        # beside what is steep for floats, or jumps
        rest = np.flatnonzero(~(np.abs(residual) <= 0.5 * RESIDUAL))
        jumps = {}
        if len(rest):
            d[rest], found = self._beside(target[rest], low[rest], high[rest], falling)
            jumps = {int(rest[i]): text for i, text in found.items()}
        return d, iterations, jumps

    def _beside(
        self, target: Array, low: Array, high: Array, falling: bool
    ) -> tuple[Array, dict[int, str]]:
        """The float whose load is next to each load in its bracket, and where that is a jump."""
        low, high = low.copy(), high.copy()
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            right = (self.bound.load(middle)[:, 0] >= target) == falling
            low, high = np.where(right, middle, low), np.where(right, high, middle)
        carries, less = (low, high) if falling else (high, low)
        (F, slope, _), (F_less, slope_less, _) = (self.bound.load(x).T for x in (carries, less))
        good = explained(F, slope, target, self.ulp)
        other = explained(F_less, slope_less, target, self.ulp)
        closer = other & (~good | (np.abs(F_less - target) < np.abs(F - target)))
        E = self.bound.contact.E_ss
        jumps = {
            int(i): f"jump: the load {target[i]:.4g} Pa (F* = {target[i] / E:.3g}) lies in a jump "
            f"of the load from F* = {F_less[i] / E:.3g} to {F[i] / E:.3g} at d = {carries[i]:.6g} "
            "m, and no separation there carries it"
            for i in np.flatnonzero(~good & ~other)
        }
        return np.where(closer, less, carries), jumps

    def solve(self, target: Array, branch: str) -> tuple[Array, Array, NDArray[Any]]:
        """Separation, number of evaluations and status of every load."""
        d, iterations, status = self.met(target, branch)
        d[status != "ok"] = np.nan
        return d, iterations, status

    def met(self, target: Array, branch: str) -> tuple[Array, Array, NDArray[Any]]:
        """As `solve`; where the load jumps over a load, the separation at which it does."""
        d = np.full(len(target), np.nan)
        iterations = np.zeros(len(target), dtype=int)
        status = np.full(len(target), "ok", dtype=object)
        cells = self.cells(target, branch)
        found = np.flatnonzero(cells >= 0)
        for start in range(0, len(found), CHUNK):
            part = found[start : start + CHUNK]
            d[part], iterations[part], jumps = self.polish(target[part], cells[part])
            status[part[list(jumps)]] = list(jumps.values())
        for i in np.flatnonzero(cells < 0):
            status[i] = self.why_not(float(target[i]))
        return d, iterations, status


@lru_cache(maxsize=512)
def load_scan(bound: Interface) -> LoadScan:
    """The cached scan of an interface."""
    return LoadScan(bound)


def _compiled(
    bound: Interface, target: Array
) -> tuple[Array, Index, NDArray[Any], dict[str, Array]]:
    """Separations, evaluations, status and columns by the compiled engine, where it pays."""
    if len(target) < engine.FEWEST:
        raise NotCompiled(f"fewer than {engine.FEWEST} loads of one contact")
    batch = engine.batch(bound)
    which = np.zeros(len(target), np.int64)
    h, iterations, fate, columns = batch.solve(which, target)
    d = bound.asperities.centre + bound.asperities.sigma_s * h
    status = np.full(len(d), "ok", dtype=object)
    residual = np.abs((columns["F_ss"] + columns["F_sa"]) / target - 1)
    rest = np.flatnonzero((fate != 0) | ~(residual <= RESIDUAL))
    if not len(rest):
        return d, iterations, status, columns
    # the other engine says why, or what the load does there
    d[rest], iterations[rest], status[rest] = load_scan(bound).solve(target[rest], "loading")
    solved = np.isfinite(d)
    for name, values in bound.fields(d[more := rest[solved[rest]]]).items():
        columns[name][more] = values
    return d, iterations, status, {name: values[solved] for name, values in columns.items()}


def _state(
    contact: Contact,
    bound: Interface,
    d: Array,
    status: NDArray[Any],
    iterations: Array,
    target: Array | None,
    scalar: bool,
    F_star: Array | None = None,
    raw: dict[str, Array] | None = None,
    path: str = "numpy",
    branch: str = "",
) -> Equilibrium:
    """Every column at given separations, where ``raw`` does not bring them."""
    if raw is None:
        raw = bound.fields(d[np.isfinite(d)])
    d, status, raw = _only_carried(bound, d, status, target, raw)
    solved = np.isfinite(d)
    full = dict(raw)
    if not solved.all():
        full = {name: np.full(len(d), np.nan) for name in raw}
        for name, values in raw.items():
            full[name][solved] = values
    rough = contact.roughness
    columns = as_columns(
        full, d, bound.mean_plane, rough.sigma, contact.E_ss, target=target, F_star=F_star
    )
    columns |= {"status": status.astype(str, copy=False), "iterations": iterations}
    shares = _population_shares(contact, bound, d, columns, scalar)
    outputs, more = evaluate(contact, bound, columns) if contact.outputs else ({}, [])
    if scalar:
        columns = {name: values[0].item() for name, values in columns.items()}
        outputs = {name: values[0].item() for name, values in outputs.items()}
    notes = (*_warnings(contact, bound, full, d), *_branches(bound, target, d, branch), *more)
    return Equilibrium(
        contact=contact,
        warnings=notes,
        populations=shares,
        outputs=outputs,
        engine=path,
        **columns,
    )


def _only_carried(
    bound: Interface, d: Array, status: NDArray[Any], target: Array | None, raw: dict[str, Array]
) -> tuple[Array, NDArray[Any], dict[str, Array]]:
    """The states without those whose load is not carried: no state is "ok" whose balance is not."""
    where = np.flatnonzero(np.isfinite(d))
    F, at = raw["F_ss"] + raw["F_sa"], d[where]
    known = np.isfinite(F + raw["A_t"])
    good = known.copy()
    if target is not None:
        load = target[where]
        good &= np.abs(F - load) <= RESIDUAL * load
        if len(loose := np.flatnonzero(known & ~good)):
            slope, ulp = bound.load(at[loose])[:, 1], load_scan(bound).ulp
            good[loose] = explained(F[loose], slope, load[loose], ulp)
    if good.all():
        return d, status, raw
    d, status = d.copy(), status.astype(object)
    for i in np.flatnonzero(~good):
        law = bound.contact.asperity_law
        why = "the laws give no number" + f" ({law.name}: {law.beyond})" * bool(law.beyond)
        if known[i]:
            why = f"{F[i]:.6g} Pa do not balance the load {load[i]:.6g} Pa"
        status[where[i]] = f"no equilibrium: {why} at d = {at[i]:.6g} m"
    d[where[~good]] = np.nan
    return d, status, {name: values[good] for name, values in raw.items()}


def _population_shares(
    contact: Contact, bound: Interface, d: Array, columns: Mapping[str, Any], scalar: bool
) -> tuple[PopulationShare, ...]:
    """What each of several populations carries at separations d."""
    if len(bound.populations) < 2:
        return ()
    out = []
    pairs = zip(contact.populations, bound.populations, strict=True)
    for number, (particles, response) in enumerate(pairs):
        part = {name: np.full(len(d), np.nan) for name in ("F_sa", "A_sa")}
        known = np.isfinite(d)
        fields = response.fields(d[known])
        part["F_sa"][known] = fields["F_sa"]
        part["A_sa"][known] = fields["A_e"] + fields["A_ep"] + fields["A_p"]
        with np.errstate(invalid="ignore", divide="ignore"):
            values = {
                "F_sa_star": part["F_sa"] / contact.E_ss,
                "A_sa": part["A_sa"],
                "load_share": part["F_sa"] / columns["pressure"],
                "area_share": part["A_sa"] / columns["A_t"],
            }
        if scalar:
            values = {name: value[0].item() for name, value in values.items()}
        out.append(PopulationShare(name=particles.name or f"particles {number + 1}", **values))
    return tuple(out)


def as_columns(
    raw: Mapping[str, Array],
    d: Array,
    mean_plane: Number,
    sigma: Number,
    E: Number,
    *,
    target: Array | None,
    F_star: Array | None = None,
) -> dict[str, Any]:
    """Every numeric column of a result, and the mode, from pressures and areas at d."""
    F = raw["F_ss"] + raw["F_sa"]
    with np.errstate(invalid="ignore", divide="ignore"):
        area_share = raw["A_sa"] / raw["A_t"]
        load_share = raw["F_sa"] / F
        residual = np.abs(F / target - 1) if target is not None else np.where(np.isnan(d), d, 0.0)
    load = F if target is None else target
    return {
        "d": d,
        "h": d + mean_plane,
        "d_star": d / sigma,
        "F_star": load / E if F_star is None else F_star,
        "pressure": load,
        "F_ss_star": raw["F_ss"] / E,
        "F_sa_star": raw["F_sa"] / E,
        **{name: raw[name] for name in COLUMNS if name in raw},
        "particle_load_share": load_share,
        "particle_area_share": area_share,
        "mode": _mode(area_share, EPS_1, EPS_2),
        "residual": residual,
    }


def _branches(bound: Interface, target: Array | None, d: Array, branch: str) -> list[str]:
    """A sentence where other separations carry these loads as well."""
    if target is None or not branch or (scan := load_scan(bound)).monotone:
        return []
    count = scan.separations(target[np.isfinite(d)])
    if not np.any(several := count > 1):
        return []
    loads = "the load" if len(d) == 1 else f"{np.count_nonzero(several)} of the {len(d)} loads"
    most = f"{count.max()}" if len(d) == 1 else f"up to {count.max()}"
    side = "largest" if branch == "loading" else "smallest"
    return [
        f"{most} separations carry {loads}, as the load does not fall everywhere with d: this is "
        f"the {branch} branch, the {side} of them; roots gives all"
    ]


def _warnings(
    contact: Contact, bound: Interface, full: dict[str, Array], d: Array
) -> tuple[str, ...]:
    """One sentence for each way in which these states leave the model's validity."""
    out = []
    area = full["A_t"]
    if np.any(area > 0.2):
        out.append(
            f"A_t reaches {np.nanmax(area):.3g}: above 0.2 neighbouring contacts interact, "
            "which this model neglects"
        )
    height = (d - bound.asperities.centre) / bound.asperities.sigma_s
    if np.any(height < DEEPEST):
        out.append(
            f"the separation goes down to {np.nanmin(height):.3g} sigma_s: below {DEEPEST:g} "
            "every asperity is in contact and the model is invalid"
        )
    if np.any(np.isfinite(d)):
        tips = contact.asperity_law
        share = bound.asperities.share_beyond(float(np.nanmin(d)))
        if share > 0.1:
            out.append(
                f"{tips.name}: at the highest load {100 * share:.0f} % of the asperities' load is "
                f"on those {tips.beyond}"
            )
    if bound.particles is not None:
        out += about_particles(contact)
        if np.any(full["shadow"] >= 1):
            out.append("particles shadow the whole area: the area correction was cut at zero")
        if not bound.particles.monotone and np.any(d < 0):
            out.append("d < 0: the paper's particle integrals have no meaning there")
    return tuple(out)


def about_particles(contact: Contact) -> list[str]:
    """One sentence for each way in which the particles leave the model's validity."""
    out = []
    for each in contact.populations:
        out += contact.law_of(each).warnings(contact.surfaces, contact.roughness, each)
    covered = sum(each.coverage for each in contact.populations)
    if covered >= 0.3:
        out.append(
            f"particles would cover {covered:.2g} of the nominal area: above 0.3 they touch each "
            "other"
        )
    return out
