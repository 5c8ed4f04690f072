r"""Explicit surfaces against the statistical model, at equal load.

Loads are pooled over surfaces at equal separation, then interpolated to the load. At small loads
a surface carries on a handful of points, and its drawn tail moves the share by half; so beside
the raw numbers stand those in which that luck is taken out (a control variate, ratio form):

.. math:: F_a(h) \to F_a(h)\,\frac{Q(h/\sigma)}{A_{bearing}(h)}, \qquad
          F_p(h) \to F_p(h)\,\frac{\langle\sum f(x, x + \zeta - h)\rangle}
                                  {\sum_k f(x_k, x_k + \zeta_k - h)} .
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Sequence
from contextlib import closing, nullcontext
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import COLUMNS, Equilibrium
from ..equilibrium.solve import given_numbers
from ..equilibrium.solve import solve as statistical
from ..errors import InvalidValue, Mistake, Note, Problem, tell_of_range
from ..laws.base import SeatedLaw
from ..populations.measured.spectra import SpectralMoments
from ..populations.measured.synthetic import from_moments
from ..populations.measured.topography import Topography
from ..quantities.carried import takes_units
from ..quantities.files import make_folder, write_text
from ..quantities.progress import Stages, count_states, watch_states
from ..quantities.record import VERSION, TableRecord, Variable, with_names
from ..quantities.run_files import read_record, sealed_text
from ..quantities.say import number, percent, plural
from ..quantities.sharing import connect_client, need_version, share_parts
from ..quantities.value import Value
from ..version import __version__
from .interface import Map, cap_of, map_of
from .pooling import COMPARED, RATIOS, SHARES, AtLoads, Pool, pooled_seats
from .seats import AbstractSeats, GivenSeats, SeatHeights, seat_heights, seats_named
from .solve import FEW, TOL, Cap, Effort
from .sums import one_surface, places

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "COMPARED",
    "Ensemble",
    "counterpart",
    "ensemble",
    "heights_of_seats",
    "seats_on",
    "spacing_for",
    "surface_of",
]

STEP = 0.15
"""Distance of separations [σ]."""
BELOW, ABOVE = 0.35, 0.6
"""How far separations go beyond those of the statistical model [σ]."""
HURST = 0.8
RECORD = {
    "asperities", "particles", "area", "particle_area", "bearing", "law", "law_area", "bare",
    "nominal", "sigma", "converged", "columns", "zeta", "warnings", "expected", "key",
}  # fmt: skip
"""What files of surfaces say that earlier versions kept, without a digest."""


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Ensemble(TableRecord):
    """Explicit surfaces against the statistical model; made by `ensemble`.

    As labelled data and as a table it is ``table``, a row for each load.

    Attributes
    ----------
    contact : Contact
        What was pressed.
    statistical : Equilibrium
        The statistical answer at the same loads, with the seats that were drawn.
    surfaces : int
        How many maps of heights were pressed.
    table : xarray.Dataset
        Along ``F_star``: for ``h``, ``A_t``, ``particle_load_share`` and ``particle_area_share``
        the raw number, ``…_raw``, the one corrected for the surfaces drawn, ``…_cv``, their
        jackknife errors, ``…_raw_error`` and ``…_cv_error``, the statistical number,
        ``…_statistical``, and the difference in standard errors, ``…_difference``. Where no
        asperity or no particle carries on any surface, shares have no error: NaN, and bounds,
        ``…_least`` and ``…_most`` (NaN elsewhere).
    at_h : xarray.Dataset
        Along ``h``: pooled loads and areas, and the ratios that say why the two differ.
    seats : SeatHeights
        Heights of the seats over σ: ``zeta_mean`` and ``zeta_std`` of the statistical model.
    states : dict
        Columns of every state: surface, h, loads, areas, certificate.
    left_out : int
        States that did not converge, which count nowhere.
    warnings : tuple of str
        Where the numbers are bounds, or the maps too coarse or too small, a sentence each.
    """

    in_dict = (
        *(VERSION, ("inputs", "contact"), "surfaces", "left_out", ("seats", with_names("seats"))),
        *(("table", lambda one: _arrays(one.table)), ("at_h", lambda one: _arrays(one.at_h))),
        *(("summary", "sentence"), "warnings"),
    )
    contact: Contact = field(repr=False)
    model: Contact = field(repr=False)
    """The statistical counterpart: the contact with the measured seat."""
    statistical: Equilibrium = field(repr=False)
    table: xarray.Dataset = field(repr=False)
    at_h: xarray.Dataset = field(repr=False)
    seats: SeatHeights
    states: dict[str, list[object]] = field(repr=False)
    surfaces: int
    left_out: int
    warnings: tuple[str, ...] = ()

    def variables(self) -> dict[str, Variable]:
        """What stands beside the statistical model."""
        return {str(name): as_variable(values) for name, values in self.table.data_vars.items()}

    def coordinates(self) -> dict[str, Variable]:
        """The loads."""
        return {str(name): as_variable(values) for name, values in self.table.coords.items()}

    @property
    def sentence(self) -> str:
        """What the numbers say, in words."""
        return _in_words(self)


def as_variable(values: xarray.DataArray) -> Variable:
    """A variable of a data set, for another."""
    return Variable(tuple(map(str, values.dims)), values.values, values.attrs)


@takes_units
def surface_of(contact: Contact, *, size: int, spacing: float, seed: int = 0) -> Topography:
    """A synthetic surface with the σ, R and α of a contact's roughness.

    Parameters
    ----------
    contact : Contact
    size : int
        Points along each side.
    spacing : float
        Distance of the points [m].
    seed : int, optional
        Of the random phases.

    Returns
    -------
    Topography

    Raises
    ------
    InvalidValue
        A roughness that no spectrum on this grid has.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> rough = tb.explicit.surface_of(contact, size=256, spacing=2e-7)
    >>> round(rough.rms_height * 1e9, 6)
    100.0
    """
    rough = contact.roughness
    m0, m4 = rough.sigma**2, math.pi * (0.375 / rough.R) ** 2
    moments = SpectralMoments(m0=m0, m2=math.sqrt(m0 * m4 / rough.alpha), m4=m4)
    return from_moments(moments, spacing=spacing, points=size, hurst=HURST, seed=seed)


@takes_units
def ensemble(
    contact: Contact,
    *,
    surfaces: int | Sequence[Topography] = 8,
    F_star: ArrayLike,
    size: int = 512,
    spacing: float | None = None,
    seats: object = "random",
    seed: int = 0,
    cap: Cap | float | None = "hardness",
    tol: float = TOL,
    max_iterations: int = 300,
    workers: int = 1,
    scheduler: str | None = None,
    folder: str | Path | None = None,
    progress: bool | Callable[[int], None] | Stages = False,
) -> Ensemble:
    """Many explicit surfaces against the statistical model at equal loads.

    Parameters
    ----------
    contact : Contact
        As in `solve`; its roughness is that of the surfaces.
    surfaces : int or sequence of Topography, optional
        How many synthetic surfaces, or the surfaces themselves.
    F_star : float or array
        Loads F/(A_n E*) [1].
    size : int, optional
        Points along each side of synthetic surfaces.
    spacing : float, optional
        Distance of their points [m]; one that gives the shortest wave some 16 points by default.
    seats, cap, tol, max_iterations
        As in `solve`; positions can only be given for one surface.
    seed : int, optional
        Surface i has seed + i.
    workers : int, optional
        Threads that press a surface each.
    scheduler : str, optional
        Address of a Dask cluster whose workers press the surfaces instead; this process keeps
        them. The answer is the same, whoever presses them.
    folder : path-like, optional
        Where finished surfaces are kept: a run that is interrupted goes on from there. One that is
        damaged is pressed again; those of another study are refused.
    progress : bool or callable, optional
        True shows on standard error how many separations are pressed, and the time left; a
        callable gets the number of surfaces.

    Returns
    -------
    Ensemble

    Raises
    ------
    InvalidValue
        As `solve`; surfaces that do not carry such a load; a scheduler that does not answer; a
        folder with surfaces of another study.

    Warns
    -----
    SlowWarning
        Surfaces that take more than 10 s together: how long. Without ``progress``.

    Notes
    -----
    Errors are jackknife errors over surfaces. At F* ≤ 1e-5 the raw mean of eight surfaces is the
    luck of a few points and no test of anything. Nothing is fitted to the statistical model.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.explicit.ensemble import ensemble
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=300e-9, R=3e-6),
    ...     particles=tb.Particles(material=tb.materials["SiO2"], areal_density=4e11,
    ...                            diameter=tb.distributions.Monodisperse(mean=6e-7)))
    >>> found = ensemble(contact, surfaces=2, F_star=[1e-3], size=128, spacing=2e-7)
    >>> found.table.particle_load_share_cv.dims, found.surfaces
    (('F_star',), 2)
    """
    _, loads, _ = given_numbers(F_star=F_star)
    rule = seats_named(seats)
    topographies, total = _surfaces_and_count(surfaces)
    if isinstance(rule, GivenSeats) and total > 1:
        raise InvalidValue(
            "seats: positions belong to one surface; give surfaces = 1", code=Mistake.BEYOND
        )
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InvalidValue(
            Problem(
                "workers", "must be a whole number, at least 1", repr(workers), code=Mistake.KIND
            )
        )
    if spacing is None and topographies is None:
        spacing = spacing_for(contact)

    def task(i: int, grid: Array) -> _Task:
        return _Task(
            contact=contact, surface=None if topographies is None else topographies[i], size=size,
            spacing=spacing, seed=seed + i, rule=rule, grid=grid, cap=cap, tol=tol,
            max_iterations=max_iterations, version=__version__,
        )  # fmt: skip

    with nullcontext() if scheduler is None else connect_client(scheduler) as client:
        first = task(0, np.empty(0)).map()
        measured = heights_of_seats(contact, rule, first, seed)
        grid = _separations(counterpart(contact, measured), loads, first.sigma)
        numbers = (total, size, spacing, seed, cap, tol, max_iterations)
        key = _key(contact, topographies, rule, numbers, grid)
        kept = None if folder is None else Path(folder)
        records = {} if kept is None else _read_surfaces(kept, total, key)
        # each separation is pressed with particles, and without
        one = len(grid) * (1 if contact.two_body else 2)
        report = progress if callable(progress) and not isinstance(progress, Stages) else None
        with watch_states(
            "explicit",
            one * total,
            progress if report is None else _say_nothing,
            "separations of surfaces",
            one * len(records),
        ) as cost:
            tasks = {i: task(i, grid) for i in range(total) if i not in records}
            left: list[tuple[int, Callable[[], dict[str, object]]]] = [
                (i, press_one if client is not None else partial(count_states, press_one, cost))
                for i, press_one in tasks.items()
            ]
            results = share_parts(
                left, workers=workers, client=client, noun="surface", smaller="a smaller size"
            )
            with closing(results):
                for i, record in results:
                    if kept is not None:
                        write_text(_file(make_folder(kept), i), sealed_text(record | {"key": key}))
                    records[i] = record
                    if client is not None:
                        cost(one)
                    if report is not None:
                        report(len(records))
    return _ensemble(
        contact,
        [records[i] for i in range(total)],
        loads,
        grid,
        cap=cap,
        gaussian=topographies is None,
    )


def _say_nothing(done: int) -> None:
    """Progress that nobody sees."""


def _read_surfaces(kept: Path, total: int, key: str) -> dict[int, dict[str, object]]:
    """What an earlier run with the same key kept, by the number of the surface.

    Raises
    ------
    InvalidValue
        It was made for other numbers.
    """
    out: dict[int, dict[str, object]] = {}
    damaged, others, unchecked = [], [], 0
    for i in range(total):
        file = _file(kept, i)
        if not file.exists():
            continue
        record = read_record(file, RECORD)
        if record is None or not (record.checked or set(record.data) == RECORD):
            damaged.append(file.name)
        elif record.data.get("key") != key:
            others.append(file.name)
        else:
            out[i] = record.data
            unchecked += not record.checked
    if others:
        raise InvalidValue(
            f"{kept} holds surfaces of another study, or of another version of thirdbody "
            f"({', '.join(others[:3])}); give another folder",
            code=Mistake.OTHER_STUDY,
        )
    if damaged:
        what = f"{kept} is damaged ({', '.join(damaged[:3])}): these surfaces are pressed again"
        _warn_caller(Note(what, code="kept.damaged", effect=math.inf))
    if unchecked:
        what = (
            f"{kept}: {plural(unchecked, 'surface')} of an earlier version of thirdbody kept no "
            "digest, so that damage in them is not seen; take another folder where that matters"
        )
        _warn_caller(Note(what, code="kept.unchecked", effect=math.inf))
    return out


def _warn_caller(note: Note) -> None:
    """Warn whoever called `ensemble` of what happened to a folder."""
    tell_of_range(note, UserWarning)


def _surfaces_and_count(
    surfaces: int | Sequence[Topography],
) -> tuple[Sequence[Topography] | None, int]:
    """Surfaces as given (None for synthetic ones) and their number."""
    if isinstance(surfaces, int):
        if isinstance(surfaces, bool) or not 1 <= surfaces <= 10**6:
            raise InvalidValue(
                Problem(
                    "surfaces",
                    "must be a whole number from 1 to 1,000,000",
                    repr(surfaces),
                    code=Mistake.KIND,
                )
            )
        return None, surfaces
    if not isinstance(surfaces, Sequence) or not surfaces:
        raise InvalidValue(
            "surfaces must be a number of them or a list of Topography", code=Mistake.KIND
        )
    return surfaces, len(surfaces)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class _Task:
    """Task for one surface: make it and press it; it can run anywhere, any number of times."""

    contact: Contact
    surface: Topography | None
    """None for a synthetic one."""
    size: int
    spacing: float | None
    seed: int
    rule: AbstractSeats
    grid: Array
    cap: str | float | None
    tol: float
    max_iterations: int
    version: str

    def map(self) -> Map:
        """Its heights."""
        if self.surface is not None:
            return map_of(self.surface, self.spacing)
        assert self.spacing is not None
        surface = surface_of(self.contact, size=self.size, spacing=self.spacing, seed=self.seed)
        return map_of(surface, None)

    def __call__(self) -> dict[str, object]:
        """Record of one surface, as `one_surface` makes it."""
        need_version(self.version, "ensemble")
        return one_surface(
            self.contact, self.map(), self.rule, self.grid, self.seed, cap=self.cap,
            effort=Effort(self.tol, self.max_iterations), gaussian=self.surface is None,
        )  # fmt: skip


# -------------------------------------------------------------------------- its seats
def heights_of_seats(contact: Contact, rule: AbstractSeats, surface: Map, seed: int) -> SeatHeights:
    """Heights of very many places of a rule, not of the few particles that one draw has."""
    return seat_heights(places(surface, rule, contact, np.random.default_rng([seed, 1])))


def seats_on(
    contact: Contact,
    surface: object,
    *,
    spacing: float | None = None,
    seats: object = "random",
    seed: int = 0,
) -> SeatHeights:
    """Heights over σ at which a rule seats particles on a surface; arguments as of `solve`."""
    return heights_of_seats(contact, seats_named(seats), map_of(surface, spacing), seed)


def counterpart(contact: Contact, seats: SeatHeights) -> Contact:
    """The statistical counterpart: laws that rest somewhere get the seat that was measured."""

    def seated_law(law: Value) -> Any:
        if not isinstance(law, SeatedLaw) or not math.isfinite(seats.mean):
            return law
        return law.replace(
            seat="rough", h_0=0.0, zeta_mean=seats.mean, zeta_std=max(seats.std, 1e-3)
        )

    particles = contact.particles
    several = (
        particles if isinstance(particles, tuple) else (particles,) if particles is not None else ()
    )
    mine = tuple(
        population if population.law is None else population.replace(law=seated_law(population.law))
        for population in several
    )
    kept: Any = mine if isinstance(particles, tuple) else (mine[0] if mine else None)
    return contact.replace(
        particle_law=seated_law(contact.particle_law), particles=kept, outputs=()
    )


# -------------------------------------------------------------------------- all of them
def _ensemble(
    contact: Contact,
    records: list[dict[str, Any]],
    loads: Array,
    grid: Array,
    *,
    cap: str | float | None,
    gaussian: bool,
) -> Ensemble:
    import xarray

    pool = Pool.from_records(records, grid)
    seats = pooled_seats([record["zeta"] for record in records])
    model = counterpart(contact, seats)
    state = statistical(model, F_star=loads)
    at_h: dict[str, object] = {name: ("h", values, {}) for name, values in pool.totals().items()}
    for name, values in pool.ratios(contact.surfaces.H).items():
        at_h[name] = ("h", values, {"long_name": RATIOS[name]})
    left_out = int(np.sum(~pool.good))
    notes = list(dict.fromkeys(sentence for record in records for sentence in record["warnings"]))
    if left_out:
        notes.append(
            Note(
                f"{plural(left_out, 'state')} of {pool.good.size} did not converge and count "
                "nowhere",
                code="explicit.converged",
            )
        )
    hardest = cap_of(cap, contact)
    at = {
        kind: pool.at_loads(loads * contact.E_ss, fair=kind == "cv", cap=hardest)
        for kind in ("raw", "cv")
    }
    table = xarray.Dataset(
        _columns(at, state, gaussian),
        coords={"F_star": ("F_star", loads, COLUMNS["F_star"].labels)},
    )
    if hardest != contact.surfaces.H:
        notes.append(
            Note(
                "asperities are pressed with another cap than the hardness, at which those of the "
                "statistical model yield: the two differ by that as well",
                code="explicit.cap",
            )
        )
    for kind, words in (("raw", "these surfaces"), ("cv", "these surfaces without their luck")):
        outside = ", ".join(number(load, 3) for load in loads[at[kind].is_outside].tolist())
        if outside:
            notes.append(
                Note(
                    f"F* = {outside}: {words} carry that at none of the separations pressed, so "
                    "that "
                    "nothing is known there; more or larger surfaces",
                    code=f"explicit.outside.{kind}",
                )
            )
    notes += at["cv" if gaussian else "raw"].doubts(loads, columns="_cv" if gaussian else "")
    notes += _few_points_notes(
        records, pool, grid, float(table.h_raw.values[int(np.argmin(loads))])
    )
    columns: dict[str, list[object]] = {"surface": [i for i in range(len(records)) for _ in grid]}
    for name in records[0]["columns"]:
        columns[name] = [value for record in records for value in record["columns"][name]]
    return Ensemble(
        contact=contact,
        model=model,
        statistical=state,
        table=table,
        at_h=xarray.Dataset(at_h, coords={"h": ("h", grid, {"units": "m"})}),
        seats=seats,
        states=columns,
        surfaces=len(records),
        left_out=left_out,
        warnings=tuple(notes),
    )


def _few_points_notes(
    records: list[dict[str, Any]], pool: Pool, grid: Array, h: float
) -> list[str]:
    """Where the smallest load, at separation h, is carried by a few points of all surfaces."""
    carriers = [
        np.add(one["columns"]["carrying_pixels"], one["columns"]["carrying_particles"])
        for one in records
    ]
    carry = np.interp(h, grid[::-1], np.sum(np.array(carriers) * pool.good, axis=0)[::-1])
    if not carry < FEW:
        return []
    if carry < 0.5:
        what = "at the smallest load hardly any surface touches; more surfaces, or a larger load"
        return [Note(what, code="explicit.nothing")]
    what = (
        f"{plural(round(float(carry)), 'pixel')} and particles of all surfaces carry the smallest "
        "load: the answer is that of a few points; more surfaces"
    )
    return [Note(what, code="explicit.few")]


def _columns(at_loads: dict[str, AtLoads], state: Equilibrium, gaussian: bool) -> dict[str, object]:
    """Along F*: raw, fair and statistical numbers, their errors and how they differ."""
    table: dict[str, Any] = {}
    for kind, at in at_loads.items():
        for name in COMPARED:
            table[f"{name}_{kind}"] = ("F_star", at.values[name], labels_of(name, kind))
            bounds = {"error": at.errors}
            bounds |= {"least": at.least, "most": at.most} if name in SHARES else {}
            for what, values in bounds.items():
                labels = labels_of(name, kind, what)
                table[f"{name}_{kind}_{what}"] = ("F_star", values[name], labels)
    best = "cv" if gaussian else "raw"
    for name in COMPARED:
        model = np.asarray(getattr(state, name))
        estimate, error = (table[f"{name}_{best}{what}"][1] for what in ("", "_error"))
        with np.errstate(invalid="ignore", divide="ignore"):
            difference = (estimate - model) / error
        table[f"{name}_statistical"] = ("F_star", model, labels_of(name, "statistical"))
        labels = labels_of(name, "difference") | {"units": "1"}
        table[f"{name}_difference"] = ("F_star", difference, labels)
    return table


def labels_of(name: str, *words: str) -> dict[str, str]:
    """Attributes of a column of the table, by what is compared and how."""
    about = COLUMNS[name]
    return about._replace(
        meaning=", ".join([about.meaning, *(WORDS[word] for word in words)])
    ).labels


WORDS = {
    "raw": "of these surfaces",
    "cv": "of these surfaces without their luck",
    "error": "standard error",
    "least": "the least it may be",
    "most": "the most it may be",
    "statistical": "of the statistical model",
    "difference": "difference to the statistical model in standard errors",
}
"""What the endings of the columns of the table mean."""


# -------------------------------------------------------------------------- what is asked
def spacing_for(contact: Contact) -> float:
    """Distance of points at which the wave of the mean curvature has some 16 [m]."""
    rough = contact.roughness
    m4 = math.pi * (0.375 / rough.R) ** 2
    m2 = math.sqrt(rough.sigma**2 * m4 / rough.alpha)
    length = 2 * math.pi * math.sqrt(m2 / m4) / 16
    return float(f"{length:.2g}")


def _separations(model: Contact, loads: Array, sigma: float) -> Array:
    """h far enough about those of the model, high to low [m]."""
    state = statistical(model, F_star=np.array([loads.max(), loads.min()]))
    near, far = np.atleast_1d(state.h)
    if not (math.isfinite(near) and math.isfinite(far)):
        near, far = 0.5 * sigma, 4 * sigma
    low, high = near - BELOW * sigma, far + ABOVE * sigma
    count = max(2, math.ceil((high - low) / (STEP * sigma)) + 1)
    return np.linspace(high, low, count)


def _key(
    contact: Contact,
    topographies: Any,
    rule: AbstractSeats,
    numbers: tuple[object, ...],
    grid: Array,
) -> str:
    """What a finished surface was made for."""
    text = json.dumps([contact.replace(outputs=()).to_dict(), rule.to_dict(), numbers[1:],
                       grid.tolist(), __version__], default=str)  # fmt: skip
    digest = hashlib.sha256(text.encode())
    for topography in topographies or ():
        digest.update(np.ascontiguousarray(topography.heights).tobytes())
    return digest.hexdigest()


def _file(folder: Path, i: int) -> Path:
    return folder / f"surface_{i:03d}.json"


# -------------------------------------------------------------------------- what is told
def _arrays(data: xarray.Dataset) -> dict[str, np.ndarray]:
    return {str(name): data[name].values for name in (*data.coords, *data.data_vars)}


WHY = {
    "bare_over_bearing": "the bare surface carries {} of hardness times its bearing area",
    "particles_over_sum": "particles carry {} of the sum of their law, as the ground gives way",
    "asperities_with_over_without": "asperities carry {} of what they do without particles",
    "bearing_over_gaussian": "the bearing area drawn is {} of the Gaussian one",
}


def _in_words(result: Ensemble) -> str:
    table = result.table
    if result.contact.two_body:
        name, what = "A_t", "the real contact area"
    else:
        name, what = "particle_load_share", "the particles' load share"
    ours, theirs = table[f"{name}_cv"].values, table[f"{name}_statistical"].values
    with np.errstate(invalid="ignore", divide="ignore"):
        apart, errors = ours / theirs - 1, table[f"{name}_cv_error"].values / np.abs(theirs)
    has_error = np.isfinite(apart) & np.isfinite(errors)
    if not np.any(has_error):
        return "No load is known well enough to say by how much it errs: take more surfaces, or "\
            "larger ones."  # fmt: skip
    worst = float(np.max(np.abs(apart[has_error])))
    clear = has_error & (np.abs(apart) > 2 * errors)
    if not np.any(clear):
        return f"Statistical and explicit: {what} agrees within {percent(worst, digits=2)}, which "\
            "is within two standard errors."  # fmt: skip
    k = int(np.flatnonzero(clear)[np.argmax(np.abs(apart[clear]))])
    h = float(table["h_cv"].values[k])
    at = result.at_h
    parts = []
    for ratio, words in WHY.items():
        values = np.interp(h, at.h.values[::-1], at[ratio].values[::-1])
        if math.isfinite(values) and (not result.contact.two_body or "particle" not in ratio):
            parts.append(words.format(percent(float(values), digits=2)))
    side = "high" if apart[k] < 0 else "low"
    return (
        f"Statistical against explicit: {what} is {percent(abs(float(apart[k])), digits=2)} {side} "
        f"at F* = {number(float(table.F_star.values[k]), 3)}, where " + "; ".join(parts) + "."
    )
