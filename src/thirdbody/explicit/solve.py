"""`solve`: one surface, every particle at its place, one load or a curve of them."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import _mode
from ..equilibrium.modes import EPS_1, EPS_2
from ..equilibrium.solve import given_numbers
from ..errors import InvalidValue, Mistake, Note, Problem, tell_of_range
from ..laws.base import REGIMES
from ..quantities.carried import takes_units
from ..quantities.progress import Stages, report_solved, watch_states
from ..quantities.say import number, percent, plural, value_of
from .blocks import ERRORS, STEP, block_sums, errors_of, long_waves
from .interface import Interface, interface_of, map_of
from .press import HARDEST, Pressed, capacity, contact_share, press
from .seats import seats_named
from .state import CONTACTS, ExplicitState

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    from ..populations.measured.topography import Topography

    Array = NDArray[np.float64]

__all__ = ["solve"]

TOL, ITERATIONS = 1e-6, 300


class Effort(NamedTuple):
    """How exactly a flat is pressed, and on how many threads."""

    tol: float = TOL
    """Certificate at which to stop."""
    max_iterations: int = ITERATIONS
    single: bool = False
    """Whether FFTs are in single precision."""
    workers: int = 1
    """Threads of the FFTs."""


FEW = 20
"""Points below which an answer is theirs."""
DENSE = 0.5
"""Real contact area above which the half-space is no longer one of separate contacts."""
LEAST_SINGLE = 1e-7
Cap = Literal["hardness", "none"]
"""Highest pressure of asperities: the hardness of the softer surface, or none."""
Precision = Literal["double", "single"]
Maps = Literal["last", "all"]
"""Whose maps are kept: of the last load, or of all."""


@takes_units
def solve(
    contact: Contact,
    surface: Topography | ArrayLike,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    h: ArrayLike | None = None,
    spacing: float | None = None,
    seats: Any = "random",
    particles: Mapping[str, object] | None = None,
    seed: int = 0,
    cap: Cap | float | None = "hardness",
    tol: float = TOL,
    max_iterations: int = ITERATIONS,
    precision: Precision = "double",
    maps: Maps = "last",
    workers: int = 1,
    blocks: int | None = None,
    progress: bool | Callable[[int], None] | Stages = False,
) -> ExplicitState:
    r"""Press a height map, with every particle at its place, against a flat.

    Pressures :math:`0 \le p \le c` on pixels and forces of particles that follow their law raise
    the flat of a periodic elastic half-space:

    .. math:: u = K(p + D\varphi), \qquad \hat K(q) = \frac{2}{E^*|q|}, \qquad
              \text{gap} = h + u - z

    No asperity is a paraboloid here, no height Gaussian, no contact alone. What is left of the
    statistical model is the law of one particle.

    Parameters
    ----------
    contact : Contact
        Materials, particles and their laws, as of the statistical model; its asperity law and
        the seat of its particle law are not used.
    surface : Topography or array (n, m)
        Composite heights [m], x along the first axis: a `Topography` without the waves below
        its cut-off (the recommended one unless another was given, 0 for the heights as they are;
        synthetic ones have 0), or an array with ``spacing``, less its mean.
    pressure, F_star, h : float or array
        Nominal pressure [Pa], load F/(A_n E*) [1], or separation of the mean planes [m]: one of
        the three. Several are solved as one continuation.
    spacing : float, optional
        Distance of the points of an array [m].
    seats : str, seats or array (N, 2), optional
        Where particles lie: ``random``, ``settled``, ``downhill``, ``valleys``, ``highest``,
        ``summits``, ``sphere``, a rule of `thirdbody.explicit` with its numbers, or positions [m].
    particles : mapping, optional
        ``x``, ``y``, ``diameter`` [m] and ``population`` of every particle, instead of drawing
        them; the ``particles`` of a state will do.
    seed : int, optional
        Of the draw: numbers are Poisson, sizes as distributed.
    cap : {"hardness", "none"} or float, optional
        Highest pressure of asperities: the softer body's hardness, none, or one [Pa]. A perfectly
        plastic cap has no pile-up, no hardening and no history: it is meant for loading.
    tol : float, optional
        Certificate at which to stop: 1e-6 gives shares to 2e-5 and pressures to 1e-4.
    max_iterations : int, optional
    precision : {"double", "single"}, optional
        Of the FFTs.
    maps : {"last", "all"}, optional
        Which maps to keep of several loads.
    workers : int, optional
        Threads of the FFTs.
    blocks : int, optional
        Blocks along each side of the map, 4 for 16 of them, over which the ``errors`` of the state
        are taken: how much another place of the surface would differ. Each load is then pressed
        twice. None by default.
    progress : bool or callable, optional
        As in `thirdbody.sweep`; counts loads, each twice with ``blocks``.

    Returns
    -------
    ExplicitState

    Raises
    ------
    InvalidValue
        A surface, load or option that has no meaning, or a load above what all can carry.

    Warns
    -----
    RangeWarning
        Where the answer is doubtful: `ExplicitState.warnings` has the sentences too.
    SlowWarning
        Loads that take more than 10 s together: how long. Without ``progress``.

    Notes
    -----
    Where no particle carries less as it is squeezed more, the answer is unique. It comes with a
    certificate ε: the elastic energy of its error is below ε σF. That is the only rule by which
    iterations stop.

    References
    ----------
    Polonsky and Keer 1999, Wear 231, 206, doi:10.1016/S0043-1648(99)00113-1, for conjugate
    gradients on a contact; Jaggi 2013 for the certificate.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> rough = tb.surfaces.self_affine(
    ...     sigma=100e-9, hurst=0.8, shortest=8e-7, longest=6e-6, spacing=1e-7, points=128)
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel), roughness=rough.roughness(),
    ...     particles=tb.Particles(material=tb.materials["SiO2"], areal_density=1e12,
    ...                            diameter=tb.distributions.Monodisperse(mean=2e-7)))
    >>> state = tb.explicit.solve(contact, rough, F_star=1e-3)
    >>> state.converged, 0 < state.particle_load_share < 1
    (True, True)
    >>> state.maps.pressure.dims, state.particles.sizes["particle"] > 100
    (('y', 'x'), True)
    """
    if not isinstance(contact, Contact):
        raise InvalidValue(
            Problem("contact", "must be a Contact", f"{contact!r:.80}", code=Mistake.KIND)
        )
    name, values, one = given_numbers(pressure=pressure, F_star=F_star, h=h)
    rule = seats_named(seats)
    _options(tol, max_iterations, precision, maps, seed, workers, blocks)
    surface_map = map_of(surface, spacing)
    rng = np.random.default_rng(seed)
    inside = interface_of(
        contact, surface_map, seats=rule, cap=cap, rng=rng, particles=particles
    )  # fmt: skip
    if name != "h":
        values = values * surface_map.area * (contact.E_ss if name == "F_star" else 1.0)
    effort = Effort(tol, max_iterations, precision == "single", workers)
    each_load = 1 if blocks is None else 2
    with watch_states("explicit", each_load * len(values), progress, "loads on one surface"):
        states, seconds = curve(inside, "h" if name == "h" else "load", values, effort)
        errors, rough = (
            ({}, []) if blocks is None else _block_errors(inside, states, blocks, effort)
        )
    columns = [numbers_of(inside, state) for state in states]
    notes = (*inside.warnings, *_doubts(columns, states, tol), *rough)
    for sentence in notes:
        tell_of_range(sentence)

    def column(name: str) -> Any:
        every = [row[name] for row in columns]
        return every[0] if one else np.array(every)

    several = maps == "all" and not one
    keep = range(len(states)) if several else [len(states) - 1]
    shown = [_maps(inside, states[i]) for i in keep]
    bodies = [_particles(inside, states[i]) for i in keep]
    import xarray

    return ExplicitState(
        contact=contact,
        **{name: column(name) for name in columns[0]},
        seconds=seconds[0] if one else np.array(seconds),
        sigma=surface_map.sigma,
        seats=inside.seats,
        maps=xarray.concat(shown, "state") if several else shown[0],
        particles=xarray.concat(bodies, "state") if several else bodies[0],
        warnings=notes,
        errors={name: float(error[0]) if one else error for name, error in errors.items()},
    )


def _block_errors(
    inside: Interface, states: list[Pressed], blocks: int, effort: Effort
) -> tuple[dict[str, Array], list[str]]:
    """Standard errors of every state, and why they are rough."""
    out = np.full((len(states), len(ERRORS)), math.nan)
    area, spacing = inside.map.area, inside.map.spacing
    most = capacity(inside.c, inside.bodies, spacing)
    for i, state in enumerate(states):
        load = float(np.sum(state.p)) * spacing**2 + float(np.sum(state.f))
        if not load > 0:
            continue
        other = load * STEP if load * STEP < most else load / STEP
        (beside,), _ = curve(inside, "load", np.array([other]), effort, start=state)
        sums, there = (
            block_sums(inside, pressed, _squeeze_columns(inside, pressed)["areas"][0], blocks)
            for pressed in (state, beside)
        )
        out[i] = errors_of(sums, there.sum(axis=1), area)
    note = long_waves(inside.map.z, inside.map.sigma, blocks)
    return dict(zip(ERRORS, out.T, strict=True)), [] if note is None else [note]


def curve(
    inside: Interface,
    quantity: str,
    values: Array,
    effort: Effort,
    *,
    start: Pressed | None = None,
) -> tuple[list[Pressed], list[float]]:
    """States under loads [N] or at separations h [m], each from its neighbour, far to near.

    The first begins at ``start``, where one is given.
    """
    z, spacing = inside.map.z, inside.map.spacing
    E_star = inside.contact.E_ss
    if quantity == "load":
        most = capacity(inside.c, inside.bodies, spacing)
        problems = [
            Problem(
                "",
                f"a load of F* = {number(load / (E_star * inside.map.area))} is above "
                f"{number(most / (E_star * inside.map.area))}, which is all that the pixels and "
                "particles can carry",
                code=Mistake.BEYOND,
            )
            for load in values[values >= most][:5]
        ]
    elif np.all(inside.c >= HARDEST):
        problems = [
            Problem(
                "h",
                "must be > 0 where asperities have no cap: the flat cannot come below the mean "
                "plane of a surface that never yields (give a load, or a cap)",
                value_of(separation, "m"),
                code=Mistake.RANGE,
            )
            for separation in values[values <= 0][:5].tolist()
        ]
    else:
        problems = []
    if problems:
        raise InvalidValue(*problems)
    order = np.argsort(values, kind="stable")
    if quantity == "h":
        order = order[::-1]
    states: dict[int, Pressed] = {}
    seconds: dict[int, float] = {}
    near = start
    for i in order.tolist():
        at = float(values[i])
        begin = time.perf_counter()
        begun = None if near is None or not (np.any(near.p) or np.any(near.f)) else (near.p, near.f)
        near = press(
            z, spacing, E_star, c=inside.c, bodies=inside.bodies, start=begun,
            load=at if quantity == "load" else None, h=at if quantity == "h" else None,
            **effort._asdict(),
        )  # fmt: skip
        states[i], seconds[i] = near, time.perf_counter() - begin
        report_solved(1)
    every = range(len(values))
    return [states[i] for i in every], [seconds[i] for i in every]


def numbers_of(inside: Interface, state: Pressed) -> dict[str, Any]:
    """The columns of a state."""
    contact, spacing, area = inside.contact, inside.map.spacing, inside.map.area
    touching = state.p > 0
    counted = float(np.mean(touching))
    A_ss = float(np.mean(contact_share(state.p, inside.c, inside.cap)))
    first, second = (
        float(np.sum(areas)) / area for areas in _squeeze_columns(inside, state)["areas"]
    )
    on_pixels = float(np.sum(state.p)) * spacing**2 / area
    on_particles = float(np.sum(state.f)) / area
    load, A_t = on_pixels + on_particles, A_ss + first
    area_share = first / A_t if A_t > 0 else math.nan
    return {
        "h": state.h,
        "F_star": load / contact.E_ss,
        "pressure": load,
        "F_ss_star": on_pixels / contact.E_ss,
        "F_sa_star": on_particles / contact.E_ss,
        "A_t": A_t,
        "A_ss": A_ss,
        "A_ss_counted": counted,
        "A_sa": first,
        "A_sa2": second,
        "particle_load_share": on_particles / load if load > 0 else math.nan,
        "particle_area_share": area_share,
        "mode": _mode(area_share, EPS_1, EPS_2),
        "carrying_pixels": int(np.sum(touching)),
        "carrying_particles": int(np.sum(state.f > 0)),
        "converged": state.converged,
        "certificate": state.certificate,
        "iterations": state.iterations,
    }


def _squeeze_columns(inside: Interface, state: Pressed) -> dict[str, Any]:
    """Dents [m], areas [m²] and regime of every particle."""
    bodies = inside.bodies
    dents, areas = np.zeros((2, len(bodies))), np.zeros((2, len(bodies)))
    regime = np.full(len(bodies), -1)
    embedded = state.f >= bodies.limit * (1 - 1e-9)
    squeeze = np.where(embedded, state.squeeze, bodies.squeeze(state.f))
    for i, law in enumerate(bodies.laws):
        here = (bodies.kind == i) & (state.f > 0)
        if np.any(here):
            x = bodies.diameter[here]
            unit = law.one.at(squeeze[here] / x)
            sinks = law.one.sinks(unit.depths)
            for side in (0, 1):
                dents[side, here] = x * sinks[side]
                areas[side, here] = x**2 * unit.areas[side]
            regime[here] = law.one.regime(0, unit.depths[0])
    return {"dents": dents, "areas": areas, "regime": np.array([*REGIMES, "none"])[regime]}


# -------------------------------------------------------------------------- what is asked
def _options(
    tol: float,
    max_iterations: int,
    precision: Precision,
    maps: Maps,
    seed: int,
    workers: int,
    blocks: int | None,
) -> None:
    """Refuse options that have no meaning."""
    out: list[str] = []
    if not (isinstance(tol, (int, float)) and 1e-13 <= tol <= 1e-2):
        out.append(Problem("tol", "must be from 1e-13 to 1e-2", repr(tol), code=Mistake.RANGE))
    elif precision == "single" and tol < LEAST_SINGLE:
        rule, hint = "needs precision = 'double'", "single goes down to 1e-7"
        out.append(Problem("tol", rule, f"{tol:g}", hint=hint, code=Mistake.CLASH))
    for name, value, words in (
        ("precision", precision, get_args(Precision)),
        ("maps", maps, get_args(Maps)),
    ):
        if value not in words:
            rule = f"must be one of {', '.join(map(repr, words))}"
            out.append(Problem(name, rule, repr(value), code=Mistake.OPTION))
    whole = {"max_iterations": (max_iterations, 1), "seed": (seed, 0), "workers": (workers, 1)}
    whole |= {} if blocks is None else {"blocks": (blocks, 2)}
    for name, (count, least) in whole.items():
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < least:
            rule = f"must be a whole number, at least {least}"
            out.append(Problem(name, rule, repr(count), code=Mistake.KIND))
    if out:
        raise InvalidValue(*out)


# -------------------------------------------------------------------------- what is told
def _doubts(columns: list[dict[str, Any]], states: list[Pressed], tol: float) -> list[str]:
    out: list[str] = []
    unsure = [state for state in states if not state.converged]
    if unsure:
        worst = max(state.certificate for state in unsure)
        accuracy = "to a few per cent" if worst < 1e-3 else "in outline only"
        out.append(
            Note(
                f"{plural(len(unsure), 'state')} of {len(states)} did not converge: certificate "
                f"{worst:.1e}, asked for {tol:g}; pressures are known {accuracy} (raise "
                "max_iterations)",
                code="explicit.converged",
            )
        )
    carriers = [row["carrying_pixels"] + row["carrying_particles"] for row in columns]
    if nothing := carriers.count(0):
        which = "" if len(columns) == 1 else f" in {nothing} of {len(columns)} states"
        out.append(
            Note(
                f"nothing touches{which}: there load and real contact area are 0",
                code="explicit.nothing",
            )
        )
    few = min((count for count in carriers if count), default=FEW)
    if few < FEW:
        out.append(
            Note(
                f"{plural(few, 'pixel')} and particles carry the smallest load: the answer is "
                "that of "
                "a few points; more surfaces",
                code="explicit.few",
            )
        )
    most = max(row["A_t"] for row in columns)
    if most > DENSE:
        out.append(
            Note(
                f"real contact area {percent(most)}: a half-space is meant for small contacts, "
                "and the "
                "law of particles leaves out their neighbours",
                code="explicit.dense",
            )
        )
    return out


def _maps(inside: Interface, state: Pressed) -> xarray.Dataset:
    import xarray

    z, spacing = inside.map.z, inside.map.spacing
    touching = state.p > 0
    contact = np.where(touching, np.where(state.p >= inside.c, 2, 1), 0)
    contact[inside.c <= 0] = 3
    fields: dict[str, tuple[NDArray[np.generic], str, str]] = {
        "pressure": (state.p, "Pa", "contact pressure"),
        "gap": (state.h + state.u - z, "m", "gap; negative where the cap let the flat sink in"),
        "height": (z, "m", "height of the composite surface"),
        "displacement": (state.u, "m", "displacement of the half-space, of zero mean"),
        "contact": (contact.astype(np.int8), "", ", ".join(
            f"{i} {word}" for i, word in enumerate(CONTACTS))),
    }  # fmt: skip
    data = {
        name: (("y", "x"), np.ascontiguousarray(values.T), {"units": unit, "long_name": meaning})
        for name, (values, unit, meaning) in fields.items()
    }
    axes = {
        name: (name, np.arange(count) * spacing, {"units": "m"})
        for name, count in zip("xy", z.shape, strict=True)
    }
    about = {"h": state.h, "sigma": inside.map.sigma, "spacing": spacing, "Conventions": "CF-1.8"}
    return xarray.Dataset(data, coords=axes, attrs=about)


def _particles(inside: Interface, state: Pressed) -> xarray.Dataset:
    import xarray

    bodies, columns = inside.bodies, _squeeze_columns(inside, state)
    names = [
        population.name or population.material.name for population in inside.contact.populations
    ]
    fields = {
        "x": (bodies.x, "m", "position"),
        "y": (bodies.y, "m", "position"),
        "diameter": (bodies.diameter, "m", "diameter"),
        "population": (bodies.kind, "", ", ".join(f"{i} {name}" for i, name in enumerate(names))),
        "zeta": (inside.zeta / (inside.map.sigma or 1.0), "1", "height of the seat over sigma"),
        "squeeze": (np.maximum(state.squeeze, 0.0), "m", "how much the gap is less than x"),
        "force": (state.f, "N", "force"),
        "dent_1": (columns["dents"][0], "m", "indentation of surface 1"),
        "dent_2": (columns["dents"][1], "m", "indentation of surface 2"),
        "regime": (columns["regime"].astype("U13"), "", "regime on surface 1"),
    }
    return xarray.Dataset(
        {
            name: ("particle", values, {"units": unit, "long_name": meaning})
            for name, (values, unit, meaning) in fields.items()
        }
    )
