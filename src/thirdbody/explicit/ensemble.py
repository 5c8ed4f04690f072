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
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import Equilibrium
from ..equilibrium.solve import solve as statistical
from ..errors import InvalidValue
from ..laws.base import SeatedLaw
from ..populations.measured.spectra import SpectralMoments
from ..populations.measured.synthetic import from_moments
from ..populations.measured.topography import Topography
from ..quantities.files import write_text
from ..quantities.progress import reporting
from ..quantities.say import number, percent, plural
from ..quantities.value import Value
from ..version import __version__
from .interface import Interface, Map, interface_of, law_tables, map_of
from .press import Pressed
from .seats import (
    AbstractSeats,
    GivenSeats,
    RandomSeats,
    SeatHeights,
    height_at,
    placed_apart,
    seat_heights,
    seats_named,
)
from .solve import TOL, curve, numbers_of

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["COMPARED", "Ensemble", "counterpart", "ensemble", "spacing_for", "surface_of"]

STEP = 0.15
"""Distance of separations [σ]."""
BELOW, ABOVE = 0.35, 0.6
"""How far separations go beyond those of the statistical model [σ]."""
PLACES = 20_000
"""Places drawn on each map to know the heights of a seat."""
QUANTILES = 64
HURST = 0.8

COMPARED = {
    "h": ("m", "separation of the mean planes"),
    "A_t": ("1", "real contact area"),
    "particle_load_share": ("1", "load share of particles"),
    "particle_area_share": ("1", "area share of particles"),
}
"""What is compared at each load: unit and meaning."""
RATIOS = {
    "bare_over_bearing": "load without particles over hardness times bearing area",
    "particles_over_sum": "load of the particles over the sum of their law at their seats",
    "asperities_with_over_without": "load of the asperities with over that without particles",
    "bearing_over_gaussian": "bearing area over that of Gaussian heights",
}
"""Why explicit and statistical answers differ, at equal separation."""
SUMS = ("asperities", "particles", "area", "particle_area", "bearing", "law", "law_area", "bare")
"""What each surface gives at each separation: loads [N] and areas [m²]."""


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Ensemble:
    """Explicit surfaces against the statistical model; made by `ensemble`.

    Attributes
    ----------
    table : xarray.Dataset
        Along ``F_star``: for ``h``, ``A_t``, ``particle_load_share`` and ``particle_area_share``
        the raw number, ``…_raw``, the one without the luck of the draw, ``…_cv``, their jackknife
        errors, ``…_raw_error`` and ``…_cv_error``, the statistical number, ``…_statistical``, and
        the difference in standard errors, ``…_difference``.
    at_h : xarray.Dataset
        Along ``h``: pooled loads and areas, and the ratios that say why the two differ.
    seats : SeatHeights
        Heights of the seats over σ: ``zeta_mean`` and ``zeta_std`` of the statistical model.
    states : dict
        Columns of every state: surface, h, loads, areas, certificate.
    left_out : int
        States that did not converge, which count nowhere.
    """

    contact: Contact = field(repr=False)
    model: Contact = field(repr=False)
    """The statistical counterpart: the contact with the measured seat."""
    statistical: Equilibrium = field(repr=False)
    table: xarray.Dataset = field(repr=False)
    at_h: xarray.Dataset = field(repr=False)
    seats: SeatHeights
    states: dict[str, list[Any]] = field(repr=False)
    surfaces: int
    left_out: int
    warnings: tuple[str, ...] = ()

    @property
    def sentence(self) -> str:
        """What the numbers say, in words."""
        return _in_words(self)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data in SI."""
        return {
            "version": __version__,
            "inputs": self.contact.to_dict(),
            "surfaces": self.surfaces,
            "left_out": self.left_out,
            "seats": self.seats._asdict(),
            "table": _plain(self.table),
            "at_h": _plain(self.at_h),
            "summary": self.sentence,
            "warnings": list(self.warnings),
        }


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
    >>> rough = surface_of(contact, size=256, spacing=2e-7)
    >>> round(rough.rms_height * 1e9, 6)
    100.0
    """
    rough = contact.roughness
    m0, m4 = rough.sigma**2, math.pi * (0.375 / rough.R) ** 2
    moments = SpectralMoments(m0=m0, m2=math.sqrt(m0 * m4 / rough.alpha), m4=m4)
    return from_moments(moments, spacing=spacing, points=size, hurst=HURST, seed=seed)


def ensemble(
    contact: Contact,
    *,
    surfaces: int | Sequence[Topography] = 8,
    F_star: ArrayLike,
    size: int = 512,
    spacing: float | None = None,
    seats: Any = "random",
    seed: int = 0,
    cap: str | float | None = "hardness",
    tol: float = TOL,
    max_iterations: int = 300,
    workers: int = 1,
    folder: str | Path | None = None,
    progress: bool | Callable[[int], None] = False,
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
    seats, cap, tol, max_iterations, workers
        As in `solve`; positions can only be given for one surface.
    seed : int, optional
        Surface i has seed + i.
    folder : path-like, optional
        Where finished surfaces are kept: a run that is interrupted goes on from there.
    progress : bool or callable, optional
        As in `thirdbody.sweep`; counts surfaces.

    Returns
    -------
    Ensemble

    Raises
    ------
    InvalidValue
        As `solve`; surfaces that do not carry such a load.

    Notes
    -----
    Errors are jackknife errors over surfaces. At F* ≤ 1e-5 the raw mean of eight surfaces is the
    luck of a few points and no test of anything. Nothing is fitted to the statistical model.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=300e-9, R=3e-6),
    ...     particles=tb.Particles(material=tb.materials["SiO2"], areal_density=4e11,
    ...                            diameter=tb.Monodisperse(mean=6e-7)))
    >>> found = ensemble(contact, surfaces=2, F_star=[1e-3], size=128, spacing=2e-7)
    >>> found.table.particle_load_share_cv.dims, found.surfaces
    (('F_star',), 2)
    """
    loads = _loads(F_star)
    rule = seats_named(seats)
    given = None if isinstance(surfaces, int) and not isinstance(surfaces, bool) else surfaces
    if given is None and not (isinstance(surfaces, int) and surfaces >= 1):
        raise InvalidValue(f"surfaces = {surfaces!r} must be a whole number, at least 1")
    if given is not None and (not isinstance(given, Sequence) or not given):
        raise InvalidValue("surfaces must be a number of them or a list of Topography")
    total = surfaces if given is None else len(given)
    assert isinstance(total, int)
    if isinstance(rule, GivenSeats) and total > 1:
        raise InvalidValue("seats: positions belong to one surface; give surfaces = 1")
    if spacing is None and given is None:
        spacing = spacing_for(contact)

    def map_number(i: int) -> Map:
        if given is None:
            assert spacing is not None
            return map_of(surface_of(contact, size=size, spacing=spacing, seed=seed + i), None)
        return map_of(given[i], spacing)

    first = map_number(0)
    measured = _heights_of_seats(contact, rule, [first], seed)
    sigma = first.sigma
    grid = _separations(counterpart(contact, measured), loads, sigma)
    key = _key(contact, given, rule, (total, size, spacing, seed, cap, tol, max_iterations), grid)
    records: list[dict[str, Any]] = []
    kept = None if folder is None else Path(folder)
    done = [i for i in range(total) if kept is not None and _read(kept, i, key) is not None]
    with reporting("explicit", total, len(done), progress, "surfaces") as report:
        for i in range(total):
            record = None if kept is None else _read(kept, i, key)
            if record is None:
                surface = first if i == 0 else map_number(i)
                record = _one_surface(
                    contact, surface, rule, grid, seed + i, cap=cap, tol=tol,
                    max_iterations=max_iterations, workers=workers, gaussian=given is None,
                )  # fmt: skip
                if kept is not None:
                    kept.mkdir(parents=True, exist_ok=True)
                    write_text(_file(kept, i), json.dumps(record | {"key": key}))
            records.append(record)
            report(i + 1)
    return _ensemble(contact, records, loads, grid, sigma, gaussian=given is None)


# -------------------------------------------------------------------------- one surface
def _one_surface(
    contact: Contact,
    surface: Map,
    rule: AbstractSeats,
    grid: Array,
    seed: int,
    *,
    cap: str | float | None,
    tol: float,
    max_iterations: int,
    workers: int,
    gaussian: bool,
) -> dict[str, Any]:
    """The sums of one surface at every separation, as plain data."""
    rng = np.random.default_rng(seed)
    inside = interface_of(contact, surface, seats=rule, cap=cap, rng=rng)
    how: dict[str, Any] = {"tol": tol, "max_iterations": max_iterations, "workers": workers}
    states, _ = curve(inside, "h", grid, **how)
    bare = curve(inside.bare(), "h", grid, **how)[0] if len(inside.bodies) else states
    out: dict[str, Any] = {name: [] for name in SUMS}
    columns = [numbers_of(inside, state) for state in states]
    pixel = surface.spacing**2
    for h, state, alone in zip(grid.tolist(), states, bare, strict=True):
        told = _sums(inside, h, state, alone, pixel)
        for name in SUMS:
            out[name].append(told[name])
    zeta = _places(surface, rule, contact, np.random.default_rng([seed, 1]))
    return {
        **out,
        "nominal": surface.area,
        "sigma": surface.sigma,
        "converged": [a.converged and b.converged for a, b in zip(states, bare, strict=True)],
        "columns": {name: [each[name] for each in columns] for name in columns[0]},
        "zeta": [float(np.sum(zeta)), float(np.sum(zeta**2)), int(np.sum(zeta > 2.5)), len(zeta)],
        "warnings": list(inside.warnings),
        "expected": _expected(contact, surface, rule, zeta, grid, gaussian),
    }


def _sums(inside: Interface, h: float, state: Pressed, alone: Pressed, pixel: float) -> dict[str, float]:  # fmt: skip  # noqa: E501
    bodies, area = inside.bodies, inside.map.area
    told = numbers_of(inside, state)
    squeeze = bodies.diameter + inside.zeta - h
    law_area = 0.0
    for i, law in enumerate(bodies.laws):
        here = (bodies.kind == i) & (squeeze > 0)
        x = bodies.diameter[here]
        law_area += float(np.sum(x**2 * law.area(squeeze[here] / x)))
    return {
        "asperities": float(np.sum(state.p)) * pixel,
        "particles": float(np.sum(state.f)),
        "area": told["A_ss"] * area,
        "particle_area": told["A_sa"] * area,
        "bearing": float(np.sum(inside.map.z > h)) * pixel,
        "law": float(np.sum(bodies.force(squeeze))),
        "law_area": law_area,
        "bare": float(np.sum(alone.p)) * pixel,
    }


def _places(surface: Map, rule: AbstractSeats, contact: Contact, rng: np.random.Generator) -> Array:
    """ζ/σ of many places of the rule."""
    if not contact.populations or isinstance(rule, GivenSeats):
        return np.empty(0)
    size = contact.populations[0].diameter.sample(rng, PLACES)
    try:
        seated = rule.draw(surface.z, surface.spacing, size, rng)
    except InvalidValue:  # fewer summits than that
        few = size[: max(1, round(0.01 * surface.z.size))]
        seated = placed_apart(RandomSeats(), surface.z, surface.spacing, few, rng)[0]
    heights = height_at(surface.z, surface.spacing, seated.x, seated.y) + seated.lift
    return heights / (surface.sigma or 1.0)


def _expected(
    contact: Contact,
    surface: Map,
    rule: AbstractSeats,
    zeta: Array,
    grid: Array,
    gaussian: bool,
) -> dict[str, list[float]]:
    """What the draw gives on average: bearing area, sums of the law [m², N, m²]."""
    sigma = surface.sigma
    if not gaussian:
        bearing = np.array([np.mean(surface.z > h) for h in grid])
    else:
        bearing = np.array([0.5 * math.erfc(h / (sigma * math.sqrt(2))) for h in grid])
    if gaussian and isinstance(rule, RandomSeats):
        mean, std = 0.0, 1.0
    elif len(zeta):
        mean, std = float(np.mean(zeta)), float(np.std(zeta))
    else:
        mean, std = math.nan, math.nan
    # dense heights for the sum over seats: a Gaussian of their mean and width, or the seats drawn
    if gaussian or isinstance(rule, GivenSeats):
        t = np.linspace(-7, 7, 1401)
        weight = np.exp(-(t**2) / 2)
        seats, weight = (mean + std * t) * sigma, weight / weight.sum()
    else:
        seats, weight = np.sort(zeta) * sigma, np.full(len(zeta), 1 / max(len(zeta), 1))
    force, area = np.zeros(len(grid)), np.zeros(len(grid))
    q = (np.arange(QUANTILES) + 0.5) / QUANTILES
    for each, law in zip(contact.populations, law_tables(contact), strict=True):
        sizes = np.unique(each.diameter.ppf(q), return_counts=True)
        for x, count in zip(*sizes, strict=True):
            share = each.areal_density * surface.area * count / QUANTILES
            for i, h in enumerate(grid):
                eps = (x + seats - h) / x
                force[i] += share * x**2 * float(np.sum(weight * law.force(eps)))
                area[i] += share * x**2 * float(np.sum(weight * law.area(eps)))
    return {
        "bearing": (bearing * surface.area).tolist(),
        "law": force.tolist(),
        "law_area": area.tolist(),
    }


def _heights_of_seats(
    contact: Contact, rule: AbstractSeats, maps: list[Map], seed: int
) -> SeatHeights:
    drawn = [_places(each, rule, contact, np.random.default_rng([seed, 1])) for each in maps]
    return seat_heights(np.concatenate(drawn))


def counterpart(contact: Contact, seats: SeatHeights) -> Contact:
    """The statistical counterpart: laws that rest somewhere get the seat that was measured."""

    def seated(law: Value) -> Any:
        if not isinstance(law, SeatedLaw) or not math.isfinite(seats.mean):
            return law
        return law.replace(
            seat="rough", h_0=0.0, zeta_mean=seats.mean, zeta_std=max(seats.std, 1e-3)
        )

    own = contact.particles
    several = own if isinstance(own, tuple) else (own,) if own is not None else ()
    mine = tuple(
        each if each.law is None else each.replace(law=seated(each.law)) for each in several
    )
    kept: Any = mine if isinstance(own, tuple) else (mine[0] if mine else None)
    return contact.replace(particle_law=seated(contact.particle_law), particles=kept, outputs=())


# -------------------------------------------------------------------------- all of them
def _ensemble(
    contact: Contact,
    records: list[dict[str, Any]],
    loads: Array,
    grid: Array,
    sigma: float,
    *,
    gaussian: bool,
) -> Ensemble:
    import xarray

    area = np.array([each["nominal"] for each in records])
    good = np.array([each["converged"] for each in records])
    sums = {name: np.array([each[name] for each in records]) for name in SUMS}
    hopes = {
        name: np.array([each["expected"][name] for each in records])
        for name in ("bearing", "law", "law_area")
    }
    seats = _pooled_seats([each["zeta"] for each in records])
    model = counterpart(contact, seats)
    state = statistical(model, F_star=loads)
    target = loads * contact.E_ss
    table: dict[str, Any] = {}
    for kind in ("raw", "cv"):
        everything = np.ones(len(records), bool)
        found = _at_loads(sums, hopes, area, good, grid, target, everything, kind)
        without = np.array([
            _at_loads(sums, hopes, area, good, grid, target, np.arange(len(records)) != i, kind)
            for i in range(len(records))
        ])  # fmt: skip
        n = len(records)
        spread = without - without.mean(axis=0)
        error = np.sqrt((n - 1) / n * np.sum(spread**2, axis=0)) if n > 1 else np.full_like(
            found, math.nan
        )  # fmt: skip
        for row, name in enumerate(COMPARED):
            table[f"{name}_{kind}"] = found[row]
            table[f"{name}_{kind}_error"] = error[row]
    for name in COMPARED:
        table[f"{name}_statistical"] = np.asarray(getattr(state, name))
        kind = "cv" if gaussian else "raw"
        with np.errstate(invalid="ignore", divide="ignore"):
            table[f"{name}_difference"] = (
                table[f"{name}_{kind}"] - table[f"{name}_statistical"]
            ) / table[f"{name}_{kind}_error"]
    units = {name: unit for name, (unit, _) in COMPARED.items()}
    data = {
        name: ("F_star", values, {"units": "1" if name.endswith("difference") else next(
            units[each] for each in COMPARED if name.startswith(f"{each}_"))})
        for name, values in table.items()
    }  # fmt: skip
    pooled = {name: np.sum(values * good, axis=0) for name, values in sums.items()}
    hoped = {name: np.sum(values * good, axis=0) for name, values in hopes.items()}
    hardness = contact.surfaces.H
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = {
            "bare_over_bearing": pooled["bare"] / (hardness * pooled["bearing"]),
            "particles_over_sum": pooled["particles"] / pooled["law"],
            "asperities_with_over_without": pooled["asperities"] / pooled["bare"],
            "bearing_over_gaussian": pooled["bearing"] / hoped["bearing"],
        }
    at_h = {
        **{name: ("h", values, {}) for name, values in pooled.items()},
        **{
            name: ("h", np.where(np.isfinite(values), values, np.nan), {"long_name": RATIOS[name]})
            for name, values in ratios.items()
        },
    }
    left_out = int(np.sum(~good))
    told = list(dict.fromkeys(sentence for each in records for sentence in each["warnings"]))
    if left_out:
        told.append(
            f"{plural(left_out, 'state')} of {good.size} did not converge and count nowhere"
        )
    columns: dict[str, list[Any]] = {
        "surface": [i for i in range(len(records)) for _ in grid],
    }
    for name in records[0]["columns"]:
        columns[name] = [value for each in records for value in each["columns"][name]]
    return Ensemble(
        contact=contact,
        model=model,
        statistical=state,
        table=xarray.Dataset(data, coords={"F_star": ("F_star", loads, {"units": "1"})}),
        at_h=xarray.Dataset(at_h, coords={"h": ("h", grid, {"units": "m"})}),
        seats=seats,
        states=columns,
        surfaces=len(records),
        left_out=left_out,
        warnings=tuple(told),
    )


def _at_loads(
    sums: dict[str, Array],
    hopes: dict[str, Array],
    area: Array,
    good: NDArray[np.bool_],
    grid: Array,
    target: Array,
    which: NDArray[np.bool_],
    kind: str,
) -> Array:
    """h, A_t and the two shares at each nominal pressure (4, loads), of some of the surfaces."""
    counts = good[which]
    nominal = np.sum(counts * area[which][:, None], axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        now = {name: np.sum(v[which] * counts, axis=0) / nominal for name, v in sums.items()}
        hoped = {name: np.sum(v[which] * counts, axis=0) / nominal for name, v in hopes.items()}
    if kind == "cv":
        factor = {
            name: _held(hoped[name], now[name], grid) for name in ("bearing", "law", "law_area")
        }
        now["asperities"] = now["asperities"] * factor["bearing"]
        now["area"] = now["area"] * factor["bearing"]
        now["particles"] = now["particles"] * factor["law"]
        now["particle_area"] = now["particle_area"] * factor["law_area"]
    load = now["asperities"] + now["particles"]
    out = np.full((len(COMPARED), len(target)), np.nan)
    usable = np.isfinite(load) & (load > 0)
    h, log = grid[usable], np.log(load[usable])
    order = np.argsort(log)
    if len(h) < 2:
        return out
    log, h = log[order], h[order]
    inside = (np.log(target) >= log[0]) & (np.log(target) <= log[-1])
    at = np.log(target)
    from scipy.interpolate import PchipInterpolator

    out[0] = np.where(inside, PchipInterpolator(log, h)(at), np.nan)

    def interpolated(name: str) -> Array:
        values = now[name][usable][order]
        with np.errstate(divide="ignore"):
            logs = np.log(values)
        some = np.isfinite(logs)
        if not np.any(some):
            return np.zeros(len(target))
        if np.sum(some) < 2:
            return np.where(at < log[some][0], 0.0, values[some][0])
        found = np.exp(PchipInterpolator(log[some], logs[some])(np.minimum(at, log[-1])))
        return np.where(at < log[some][0], 0.0, found)

    particles, asperities = interpolated("particles"), interpolated("asperities")
    touched, dented = interpolated("area"), interpolated("particle_area")
    with np.errstate(invalid="ignore", divide="ignore"):
        out[1] = touched + dented
        out[2] = particles / (particles + asperities)
        out[3] = dented / (touched + dented)
    out[:, ~inside] = np.nan
    return out


def _held(hoped: Array, drawn: Array, grid: Array) -> Array:
    """hoped/drawn; where nothing is drawn the ratio of the next lower h that has."""
    order = np.argsort(grid)
    out, last = np.ones(len(grid)), 1.0
    for i in order:
        if drawn[i] > 0 and hoped[i] > 0:
            last = hoped[i] / drawn[i]
        out[i] = last
    return out


def _pooled_seats(parts: list[list[float]]) -> SeatHeights:
    first, second, high, count = np.sum(np.array(parts, dtype=float), axis=0).tolist()
    if not count:
        return seat_heights(np.empty(0))
    mean = first / count
    std = math.sqrt(max(second / count - mean**2, 0.0))
    gauss = 0.5 * math.erfc((2.5 - mean) / (std * math.sqrt(2))) if std > 0 else 0.0
    return SeatHeights(mean, std, high / count, gauss)


# -------------------------------------------------------------------------- what is asked
def _loads(F_star: ArrayLike) -> Array:
    try:
        loads = np.atleast_1d(np.asarray(F_star, dtype=float))
    except (TypeError, ValueError):
        raise InvalidValue(f"F_star = {F_star!r} must be a number or a list of numbers") from None
    if loads.ndim != 1 or not loads.size or not np.all(np.isfinite(loads) & (loads > 0)):
        raise InvalidValue(f"F_star = {F_star!r} must be finite and > 0")
    return loads


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
    contact: Contact, given: Any, rule: AbstractSeats, numbers: tuple[Any, ...], grid: Array
) -> str:
    """What a finished surface was made for."""
    text = json.dumps([contact.replace(outputs=()).to_dict(), rule.to_dict(), numbers[1:],
                       grid.tolist(), __version__], default=str)  # fmt: skip
    found = hashlib.sha256(text.encode())
    for each in given or ():
        found.update(np.ascontiguousarray(each.heights).tobytes())
    return found.hexdigest()


def _file(folder: Path, i: int) -> Path:
    return folder / f"surface_{i:03d}.json"


def _read(folder: Path, i: int, key: str) -> dict[str, Any] | None:
    """A finished surface of the same run; None where there is none."""
    try:
        found = json.loads(_file(folder, i).read_text("utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and found.get("key") == key else None


# -------------------------------------------------------------------------- what is told
def _plain(data: xarray.Dataset) -> dict[str, list[float | None]]:
    names = [*data.coords, *data.data_vars]
    return {
        str(name): [
            value if math.isfinite(value) else None for value in np.asarray(data[name]).tolist()
        ]
        for name in names
    }


WHY = {
    "bare_over_bearing": "the bare surface carries {} of hardness times its bearing area",
    "particles_over_sum": "particles carry {} of the sum of their law, as the ground gives way",
    "asperities_with_over_without": "asperities carry {} of what they do without particles",
    "bearing_over_gaussian": "the bearing area drawn is {} of the Gaussian one",
}


def _in_words(found: Ensemble) -> str:
    table = found.table
    if found.contact.two_body:
        name, what = "A_t", "the real contact area"
    else:
        name, what = "particle_load_share", "the particles' load share"
    ours, theirs = table[f"{name}_cv"].values, table[f"{name}_statistical"].values
    with np.errstate(invalid="ignore", divide="ignore"):
        apart, errors = ours / theirs - 1, table[f"{name}_cv_error"].values / np.abs(theirs)
    known = np.isfinite(apart) & np.isfinite(errors)
    if not np.any(known):
        return "No load is known with an error: more surfaces, or larger ones."
    worst = float(np.max(np.abs(apart[known])))
    clear = known & (np.abs(apart) > 2 * errors)
    if not np.any(clear):
        return f"Statistical and explicit: {what} agrees within {percent(worst, digits=2)}, which "\
            "is within two standard errors."  # fmt: skip
    k = int(np.flatnonzero(clear)[np.argmax(np.abs(apart[clear]))])
    h = float(table["h_cv"].values[k])
    at = found.at_h
    parts = []
    for ratio, words in WHY.items():
        values = np.interp(h, at.h.values[::-1], at[ratio].values[::-1])
        if math.isfinite(values) and (not found.contact.two_body or "particle" not in ratio):
            parts.append(words.format(percent(float(values), digits=2)))
    side = "high" if apart[k] < 0 else "low"
    return (
        f"Statistical against explicit: {what} is {percent(abs(float(apart[k])), digits=2)} {side} "
        f"at F* = {number(float(table.F_star.values[k]), 3)}, where " + "; ".join(parts) + "."
    )
