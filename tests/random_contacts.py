"""Contacts drawn at random over the ranges in which people work, and what must hold for each.

    .venv/bin/python tests/random_contacts.py --contacts 10000 --seed 1 --workers 2 --out found.jsonl
    .venv/bin/python tests/random_contacts.py --seed 1 --index 17      # one of them, in full

A contact is (seed, index) and nothing else, so that any range of indices can run anywhere. With
``--out`` every contact leaves a line in the file, and those that have one are not run again.
Prints how many contacts and loads there were, and how many failed each check.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import json
import math
import multiprocessing
import re
import signal
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.equilibrium import solve as solving
from thirdbody.equilibrium.columns import COLUMNS, about
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.states import state_columns
from thirdbody.equilibrium.status import DEEPEST, Status
from thirdbody.populations.distributions import Distribution
from thirdbody.populations.heights import COMPLETE
from thirdbody.quantities.value import Value

Array = np.ndarray
EPS = float(np.finfo(float).eps)

# ---------------------------------------------------------------------------- drawing
DIAMETERS = (0.1, 1000.0)
"""Mean diameter over σ."""
SIGMA = (1e-9, 10e-6)
"""σ [m]."""
TIPS = (10.0, 3000.0)
"""R/σ."""
PRODUCTS = (0.01, 0.12)
"""ηRσ."""
BANDWIDTHS = (1.6, 50.0)
"""α."""
MODULI = (1e9, 600e9)
"""E of bodies and particles [Pa]."""
YIELDS = (1e-3, 0.1)
"""H/E of bodies and particles."""
RATIOS = (1e-2, 1e2)
"""H of particles over that of the softer body."""
COVERAGES = (1e-8, 0.5)
LOADS = (1e-12, 1e-2)
"""F*."""
ADHESIVE = ("jkr", "dmt")
WORKS = (1e-3, 0.2)
"""Work of adhesion [J/m²]."""

SIZES = (
    "monodisperse",
    "gaussian",
    "narrow gaussian",
    "lognormal",
    "narrow lognormal",
    "wide lognormal",
    "weibull",
    "uniform",
    "histogram",
    "powerlaw",
    "mixture",
)
HEIGHTS = ("gaussian", "gaussian", "exponential", "weibull", "johnson", "histogram")
SEATS = ("rough", "rough", "plane", "offset")
SHADOWS = ("footprint", "projected", "covered", "none")
PRESETS = ("published", "window", "all_terms", "window_E2", "literal")


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One contact with the loads and separations to try."""

    seed: int
    index: int
    contact: tb.Contact
    loads: Array
    """F*, increasing."""
    d: Array
    """Separations [m], increasing."""

    @property
    def name(self) -> str:
        return f"--seed {self.seed} --index {self.index}"


class Pen:
    """Draws from one generator."""

    def __init__(self, rng: np.random.Generator):
        self.rng = rng

    def log(self, low: float, high: float) -> float:
        return float(np.exp(self.rng.uniform(math.log(low), math.log(high))))

    def flat(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    def one(self, options: Any) -> Any:
        return options[int(self.rng.integers(len(options)))]

    def chance(self, p: float) -> bool:
        return bool(self.rng.random() < p)


def material(pen: Pen, hardness: float | None = None) -> tb.Material:
    """A body, or one of a given hardness with a modulus that such bodies have."""
    if hardness is None:
        E = pen.log(*MODULI)
        return tb.Material(E=E, nu=pen.flat(0.05, 0.48), H=E * pen.log(*YIELDS))
    low, high = (np.clip(hardness / y, *MODULI) for y in (YIELDS[1], YIELDS[0]))
    return tb.Material(E=pen.log(low, high), nu=pen.flat(0.05, 0.48), H=hardness)


def heights(pen: Pen) -> tb.heights.Heights:
    match pen.one(HEIGHTS):
        case "gaussian":
            return tb.heights.GaussianHeights()
        case "exponential":
            return tb.heights.ExponentialHeights()
        case "weibull":
            return tb.heights.WeibullHeights(shape=pen.log(1.0, 10.0))
        case "johnson":
            skewness = pen.flat(-2.5, 1.5)
            return tb.heights.JohnsonHeights(
                skewness=skewness, kurtosis=skewness**2 + pen.log(1.4, 8.0)
            )
    edges = np.cumsum(pen.rng.uniform(0.2, 1.0, int(pen.rng.integers(2, 9)) + 1))
    return tb.heights.HistogramHeights(
        edges=tuple(edges.tolist()), counts=tuple(pen.rng.uniform(0.05, 1, len(edges) - 1).tolist())
    )


def roughness(pen: Pen, law: Any) -> tb.Roughness:
    sigma = pen.log(*SIGMA)
    ellipticity = None
    if law.name.startswith("elliptic") and law.ratio == 1:
        count = int(pen.rng.integers(1, 4))
        ellipticity = tb.surfaces.Ellipticity(
            ratios=tuple(pen.log(1, 15) for _ in range(count)),
            weights=tuple(pen.flat(0.1, 1) for _ in range(count)),
            radii=tuple(pen.log(0.5, 2) for _ in range(count)),
        )
    return tb.Roughness(
        sigma=sigma,
        R=sigma * pen.log(*TIPS),
        alpha=pen.log(*BANDWIDTHS),
        eta_R_sigma=pen.log(*PRODUCTS),
        heights=tb.heights.GaussianHeights() if ellipticity else heights(pen),
        ellipticity=ellipticity,
    )


def asperity_law(pen: Pen, names: tuple[str, ...]) -> Any:
    """A law with options; a length of its own is given once the roughness is known."""
    name = pen.one(names)
    options: dict[str, Any] = {}
    if name in ("zmc", "hermite", "elliptic-zmc") and pen.chance(0.5):
        options = {"k": pen.flat(0.3, 0.5), "rho": pen.flat(40.0, 110.0)}
    if name in ("ceb", "ke", "elliptic-ceb") and pen.chance(0.3):
        options = {"K": pen.flat(0.4, 0.65)}
    if name.startswith("elliptic"):
        options |= {"ratio": 1.0 if pen.chance(0.3) else pen.log(1.0, 15.0)}
        options |= {"area_rule": pen.one(("volume", "doubling"))}
    if name == "jg" and pen.chance(0.3):
        options = {"hardness_ratio": pen.flat(2.5, 3.2)}
    if name in ("jkr", "dmt"):
        options = {"w": pen.log(*WORKS)}
    if name == "jkr":
        options["unloading"] = pen.chance(0.3)
    if name == "coated":
        options = {f"E_{i}": pen.log(*MODULI) for i in (1, 2)}
        options |= {f"nu_{i}": pen.flat(0.05, 0.48) for i in (1, 2)}
    return tb.asperity.REGISTRY[name](**options)


def sizes(pen: Pen, mean: float) -> Distribution:
    """Sizes with a typical diameter [m]."""
    kind = pen.one(SIZES)
    if kind == "mixture":
        parts = tuple(
            sizes(pen, mean * pen.log(0.3, 3)) for _ in range(int(pen.rng.integers(2, 4)))
        )
        return tb.distributions.Mixture(parts=parts, weights=tuple(pen.log(0.05, 1) for _ in parts))
    match kind:
        case "gaussian":
            return tb.TruncatedGaussian(
                mean=mean, std=mean * pen.log(0.03, 0.5), n=pen.flat(1.0, 6.0)
            )
        case "narrow gaussian":
            return tb.TruncatedGaussian(mean=mean, std=mean * pen.log(1e-5, 0.03))
        case "lognormal":
            return tb.LogNormal(median=mean, gsd=1 + pen.log(0.05, 1.0))
        case "narrow lognormal":
            return tb.LogNormal(median=mean, gsd=1 + pen.log(1e-4, 0.05))
        case "wide lognormal":
            return tb.LogNormal(median=mean, gsd=pen.flat(2.0, 4.0))
        case "weibull":
            return tb.distributions.Weibull(scale=mean, shape=pen.log(0.7, 30.0))
        case "uniform":
            low = pen.one((0.0, pen.flat(0.0, 0.99)))
            return tb.distributions.Uniform(low=low * mean, high=mean)
    if kind in ("histogram", "powerlaw"):
        edges = mean * np.cumprod(1 + pen.rng.uniform(0.05, 1, int(pen.rng.integers(2, 8)) + 1))
        counts = tuple(pen.rng.uniform(0, 1, len(edges) - 1).tolist())
        made = {"edges": tuple(edges.tolist()), "counts": counts}
        if kind == "histogram":
            return tb.distributions.Histogram(**made)
        return tb.distributions.PowerLaw(
            **made, slopes=tuple(pen.rng.uniform(-1, 4, len(counts)).tolist())
        )
    return tb.distributions.Monodisperse(mean=mean)


ROUND = tuple(
    name
    for name, kind in tb.asperity.REGISTRY.items()
    if kind.scale_free and not kind.of_surface and name not in ("elliptic-ceb", "elliptic-zmc")
)
"""Laws that a particle may follow."""


def particle_law(pen: Pen, sigma: float) -> Any:
    kind = pen.one(("series", "series", "series", "series", "flakes", "horng2022"))
    if kind == "horng2022":
        return tb.particle.Horng2022(preset=pen.one(PRESETS))
    options: dict[str, Any] = {"seat": pen.one(SEATS), "shadow": pen.one(SHADOWS)}
    if options["seat"] == "offset":
        options["h_0"] = sigma * pen.flat(-1.0, 4.0)
    if options["seat"] == "rough" and pen.chance(0.5):
        options |= {"zeta_mean": pen.flat(-1.0, 1.5), "zeta_std": pen.log(0.05, 2.0)}
    if kind == "flakes":
        options["aspect"] = pen.log(1.0, 10.0)
    law = asperity_law(pen, ROUND) if pen.chance(0.6) else tb.asperity.Hermite()
    return tb.particle.REGISTRY[kind](law=law, **options)


def population(
    pen: Pen, pair: tb.MaterialPair, sigma: float, law: Any, part: float
) -> tb.Particles:
    diameter = sizes(pen, sigma * pen.log(*DIAMETERS))
    each = math.pi / 4 * diameter.moment(2) * getattr(law, "aspect", 1.0) ** 2
    return tb.Particles(
        material=material(pen, pair.H * pen.log(*RATIOS)),
        diameter=diameter,
        areal_density=part * pen.log(*COVERAGES) / each,
    )


def thermal(pen: Pen, given: tb.Material) -> tb.Material:
    """A material with what outputs need to know of it."""
    return given.replace(
        density=pen.log(1e3, 2e4),
        thermal_conductivity=pen.log(0.1, 400.0),
        specific_heat=pen.log(100.0, 4000.0),
        resistivity=pen.log(1e-8, 1e-3),
        K_c=pen.log(0.3e6, 100e6),
    )


def dressed_particles(pen: Pen, given: tb.Particles, law: Any) -> tb.Particles:
    """Particles that may break, or have faces, by a law that knows such."""
    given = given.replace(material=thermal(pen, given.material))
    size, own = given.diameter.mean_diameter, {}
    if law.name == "series" and law.law.name in ("gw", "hermite", "zmc") and pen.chance(0.4):
        own["shape"] = tb.grains.Angular(
            roundness=pen.log(0.05, 1.0),
            angle=pen.flat(0.2, 1.2),
            flatness=1.0 if pen.chance(0.5) else pen.flat(1.0, 2.0),
        )
    if getattr(law, "breakable", False) and "shape" not in own and pen.chance(0.4):
        # sizes below a tenth do not break: pieces of pieces end there
        own["strength"] = tb.grains.WeibullStrength(
            sigma_0=given.material.H * pen.log(1e-4, 0.1),
            x_0=size * pen.log(0.1, 1e3),
            m=pen.flat(1.5, 15.0),
            x_c=size * pen.log(0.1, 2.0),
            fragments=pen.one(("footprint", "gone", "all")),
            ratio=pen.flat(0.3, 0.7),
            confinement=pen.one(("sphere", "none")),
        )
    for name, value in own.items():
        with contextlib.suppress(
            tb.errors.InvalidValue
        ):  # a law or a size that it does not go with
            given = given.replace(**{name: value})
    return given


def outputs(pen: Pen, contact: tb.Contact) -> tuple[Any, ...]:
    """Outputs with numbers of their own, most often all."""
    L, H = contact.roughness.sigma, contact.surfaces.H
    every = {
        "counts": tb.outputs.Counts(),
        "dents": tb.outputs.Dents(debris=pen.one(("hard", "ductile")), A_n=1e8 * L**2),
        "crushing": tb.outputs.Crushing(A_n=1e8 * L**2),
        "friction": tb.outputs.Friction(
            tau_ss=H * pen.log(0.01, 0.3), tau_sa=H * pen.log(0.01, 0.3)
        ),
        "wear": tb.outputs.Wear(K_ss=pen.log(1e-9, 1e-3), renewal=1 / (1e6 * L)),
        "static_friction": tb.outputs.StaticFriction(),
        "thermal_conductance": tb.outputs.ThermalConductance(),
        "electrical_conductance": tb.outputs.ElectricalConductance(),
        "flash_temperature": tb.outputs.FlashTemperature(v=pen.log(1e-3, 10.0), A_n=1e8 * L**2),
    }
    names = [name for name in every if pen.chance(0.8)]
    while names:
        try:
            return contact.replace(outputs=tuple(every[name] for name in names)).outputs
        except tb.errors.InvalidValue as error:  # what this contact does not have
            names = [n for n in names if n not in str(error)] if len(names) > 1 else []
            names = names[:-1]
    return ()


def dressed(pen: Pen, contact: tb.Contact) -> tb.Contact:
    """The contact with strengths, shapes, another onset of squashed particles, and outputs."""
    law = contact.particle_law
    if law.name == "series" and pen.chance(0.4):
        law = law.replace(
            **pen.one(({"onset": "jg"}, {"friction_factor": 0.6}, {"soft": "sphere"}))
        )
        with contextlib.suppress(tb.errors.InvalidValue):
            interface(other := contact.replace(particle_law=law))
            contact = other
    pair = tb.MaterialPair(
        *(thermal(pen, b) for b in (contact.surfaces.first, contact.surfaces.second))
    )
    contact = contact.replace(surfaces=pair)
    grains = tuple(dressed_particles(pen, p, contact.law_of(p)) for p in contact.populations)
    if grains:
        with contextlib.suppress(tb.errors.InvalidValue):
            contact = contact.replace(particles=grains if len(grains) > 1 else grains[0])
    return contact.replace(outputs=outputs(pen, contact))


def draw_whole(seed: int, index: int) -> Drawn:
    """As `draw`, with what else a contact may have, which its own numbers say."""
    plain = draw(seed, index)
    contact = dressed(Pen(np.random.default_rng([seed, index, 2])), plain.contact)
    return dataclasses.replace(plain, contact=contact)


def draw(seed: int, index: int) -> Drawn:
    """The contact of a seed and an index."""
    pen = Pen(np.random.default_rng([seed, index]))
    first = material(pen)
    second = first if pen.chance(0.4) else material(pen, first.H * pen.log(0.1, 10.0))
    pair = tb.MaterialPair(first, second)
    law = asperity_law(pen, tuple(n for n, k in tb.asperity.REGISTRY.items() if not k.of_surface))
    rough = roughness(pen, law)
    if law.name == "coated":
        law = law.replace(t=rough.sigma * pen.log(0.1, 10.0))
    count = pen.one((0, 1, 1, 1, 1, 1, 2, 3))
    grains = particle_law(pen, rough.sigma)
    particles: list[tb.Particles] = []
    for number in range(count):
        own = grains
        if number and not isinstance(grains, tb.particle.Horng2022) and pen.chance(0.4):
            own = tb.particle.Series(seat=pen.one(("rough", "plane")), shadow=pen.one(SHADOWS))
        each = population(pen, pair, rough.sigma, own, 1 / count)
        particles.append(each if own is grains else each.replace(law=own))
    contact = tb.Contact(
        surfaces=pair,
        roughness=rough,
        asperity_law=law,
        particles=tuple(particles) if count > 1 else particles[0] if particles else None,
        particle_law=grains,
    )
    loads = np.sort([*LOADS, *(pen.log(*LOADS) for _ in range(14))])
    low, high = span(contact)
    d = np.sort(
        [*(pen.flat(low, high) for _ in range(6)), low + 6 * rough.sigma_s * pen.flat(0, 1)]
    )
    return Drawn(seed, index, contact, loads, d)


def span(contact: tb.Contact) -> tuple[float, float]:
    """Separations from the deepest that is searched to the first touch, as far as d counts."""
    rough = contact.roughness
    centre = max((contact.law_of(each).centre for each in contact.populations), default=0.0)
    low = centre * rough.sigma + DEEPEST * rough.sigma_s
    tops = [each.diameter.mean_diameter * 1.5 for each in contact.populations]
    return low, max([centre * rough.sigma + 5 * rough.sigma_s, *tops])


# ---------------------------------------------------------------------------- checks
class Findings:
    """What was checked how often, and what failed."""

    def __init__(self) -> None:
        self.asked: Counter[str] = Counter()
        self.failed: list[tuple[str, str]] = []

    def ask(self, check: str, good: Any, say: Callable[[Any], str] | str = "") -> None:
        """One answer, or an array of them of which the first bad one is told."""
        good = np.atleast_1d(good)
        self.asked[check] += good.size
        if not good.all():
            i = int(np.argmin(good))
            why = say(i) if callable(say) else say
            count = f" ({np.sum(~good)} of {good.size})" if good.size > 1 else ""
            self.failed.append((check, re.sub(r"np\.\w+\((.*?)\)", r"\1", why) + count))


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        yield


# with seconds, kelvins and amperes as they are: kg = Pa m s², W = Pa m³/s, ohm = W/A²
LENGTHS = {"1": 0, "m": 1, "Pa": 0, "1/m^2": -2, "J/m^2": 1, "rad": 0, "K": 0, "m^2": 2, "1/m": -1}
LENGTHS |= {"m/s": 1, "kg/m^3": -2, "W/m/K": 2, "J/kg/K": 2, "ohm*m": 4, "ohm*m^2": 5}
LENGTHS |= {"m^2*K/W": -1, "S/m^2": -5, "Pa m^0.5": 0.5, "W/m^2/K": 1, "m^3/m^2": 1}
PRESSURES = {"1": 0, "m": 0, "Pa": 1, "1/m^2": 0, "J/m^2": 1, "rad": 0, "K": 0, "m^2": 0, "1/m": 0}
PRESSURES |= {"m/s": 0, "kg/m^3": 1, "W/m/K": 1, "J/kg/K": 0, "ohm*m": 1, "ohm*m^2": 1}
PRESSURES |= {"m^2*K/W": -1, "S/m^2": -1, "Pa m^0.5": 1, "W/m^2/K": 1, "m^3/m^2": 0}


def in_other_units(value: Any, length: float, pressure: float) -> Any:
    """The same thing where lengths and pressures are other numbers."""
    if isinstance(value, tuple):
        return tuple(in_other_units(each, length, pressure) for each in value)
    if isinstance(value, Distribution):
        return value.scaled(length)
    if not isinstance(value, Value):
        return value
    changes: dict[str, Any] = {}
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        old = getattr(value, item.name)
        if (about := item.metadata.get("quantity")) and old is not None and item.compare:
            unit = about["unit"]
            changes[item.name] = old * length ** LENGTHS[unit] * pressure ** PRESSURES[unit]
        elif isinstance(old, (Value, tuple)):
            changes[item.name] = in_other_units(old, length, pressure)
    return dataclasses.replace(value, **changes)  # type: ignore[type-var]


AREAS = ("A_t", "A_ss", "A_sa", "A_sa2", "A_e", "A_ep", "A_p")
PARTS = ("F_ss_star", "F_sa_star", *AREAS, "shadow")
SHARES = ("particle_load_share", "particle_area_share")
BALANCE = 1e-12
"""Relative residual of a balance, rounding of d aside."""
ALIKE = 1e-9
"""Of the total, two ways to the same state."""
LEAST_DIGITS = 1e-290
"""Loads F* below which floats lose digits."""


def arrays(result: Any) -> dict[str, Array]:
    return result if isinstance(result, dict) else result.columns()


def slack(contact: tb.Contact, d: Array, load: float = 1e-11) -> tuple[Array, dict[str, Array]]:
    """What an ulp of d is of the load, and what it and an error of the load make of columns."""
    bound = interface(contact)
    size = np.abs(d) + abs(bound.mean_plane) + contact.roughness.sigma
    size = size + sum(abs(getattr(contact.particle_law, "h_0", 0.0)) for _ in contact.populations)
    step = 8 * EPS * size
    F, F1, _ = bound.load(d).T
    with np.errstate(all="ignore"):
        per_ulp = np.abs(F1 / F) * step
        flat = np.minimum(load * np.abs(F / F1), 1e-3 * contact.roughness.sigma)
    step = step + np.where(np.isfinite(flat), flat, 0.0)
    with quiet():
        up, down = (tb.solve(contact, d=at).columns() for at in (d + step, d - step))
    middle = {name: np.abs(up[name] - down[name]) for name in (*PARTS, *SHARES, "d_star", "F_star")}
    with np.errstate(all="ignore"):
        jump = middle["F_star"] * contact.E_ss / np.abs(F)
    return np.where(np.isfinite(per_ulp), np.maximum(per_ulp, jump), np.inf), middle


def alike(found: Findings, check: str, contact: tb.Contact, one: Any, two: Any) -> None:
    """Two results for one load are one state."""
    one, two = arrays(one), arrays(two)
    first, second = (np.asarray(each["status"], str) == "ok" for each in (one, two))
    ok = first & second
    found.ask(
        check + ": status",
        first == second,
        lambda i: f"F* = {one['F_star'][i]!r}: {one['status'][i]!r} or {two['status'][i]!r}",
    )
    ok &= np.isfinite(one["d"]) & np.isfinite(two["d"])
    if not ok.any():
        return
    _, spread = slack(contact, one["d"][ok])
    loads = one["F_star"][ok]
    for name in PARTS + SHARES + ("d_star",):
        x, y = one[name][ok], two[name][ok]
        total = {"F": loads, "A": np.abs(one["A_t"][ok])}.get(name[0], np.ones_like(x))
        total = 1 + np.abs(x) if name == "d_star" else total
        same = np.abs(x - y) <= ALIKE * total + spread[name]
        same |= np.isnan(x) & np.isnan(y)
        found.ask(
            check,
            same,
            lambda i, name=name, x=x, y=y: f"{name} at F* = {loads[i]!r}: {x[i]!r} or {y[i]!r}",
        )


SAID = "separations carry"
"""In the warning where more than one separation carries a load."""


def hold(drawn: Drawn, *, shares: int = 1) -> tuple[Findings, int]:
    """Every check of one contact, and how many states were solved.

    With ``shares`` = 3 contacts take turns in the checks that cost most.
    """
    found, contact = Findings(), drawn.contact
    with quiet():
        bound = interface(contact)
        state = tb.solve(contact, F_star=drawn.loads)
        columns = state.columns()
        at = tb.solve(contact, d=drawn.d)
    # what follows compares numbers: looking for pressed particles would take most of its time
    with quiet(), mock.patch.object(solving, "about_pressed", return_value=[]):
        _outputs(found, drawn, at)
        # and so would outputs, which change no state
        bare = dataclasses.replace(drawn, contact=contact.replace(outputs=()))
        contact = bare.contact
        _states(found, contact, bound, state, columns)
        _states(found, contact, bound, at, at.columns(), "given d: ")
        _separations(found, contact, bound, state, columns)
        _round_trip(found, contact, columns)
        _engines(found, bare, columns)
        dear = (
            lambda: _units(found, bare, state, at),
            lambda: _each(found, bare),
            lambda: _critical(found, contact),
        )
        for check in dear[drawn.index % shares :: shares]:
            check()
    return found, 2 * (len(drawn.loads) + len(drawn.d))


def _states(
    found: Findings, contact: Any, bound: Any, state: Any, columns: Any, say: str = ""
) -> None:
    """Each state by itself."""
    status = np.asarray(columns["status"], str)
    ok = status == "ok"
    F = columns["F_star"]
    numbers = [name for name in COLUMNS if columns[name].dtype.kind == "f"]
    nothing = (columns["A_t"] == 0) & (columns["F_ss_star"] == 0) & (columns["F_sa_star"] == 0)
    for name in numbers:
        # a share of nothing is no number
        free = nothing if name in SHARES else np.zeros_like(ok)
        good = np.isfinite(columns[name]) | ~ok | free
        found.ask(
            say + "no NaN told as ok",
            good,
            lambda i, n=name: f"{n} at F* = {F[i]!r}, d = {columns['d'][i]!r}",
        )
    found.ask(say + "a reason where there is no state", ok | (np.char.str_len(status) > 10))
    found.ask(
        say + "no half of the area told as ok",
        ~(ok & (columns["A_t"] > 0.5)),
        lambda i: f"A_t = {columns['A_t'][i]!r} at F* = {F[i]!r}",
    )
    good = ~ok | nothing | (np.char.str_len(np.asarray(columns["mode"], str)) > 0)
    found.ask(say + "mode", good, lambda i: f"empty at F* = {F[i]!r}")
    ok &= np.isfinite(columns["d"]) & np.isfinite(F) & ~nothing
    if not ok.any():
        return
    got = {name: columns[name][ok] for name in (*numbers,)}
    F = got["F_star"]

    def tell(*names: str) -> Callable[[int], str]:
        return lambda i: (
            f"F* = {F[i]!r}, d* = {got['d_star'][i]!r}: "
            + ", ".join(f"{name} = {got[name][i]!r}" for name in names)
        )

    per_ulp, _ = slack(contact, got["d"])
    if not say:
        good = got["residual"] <= BALANCE + per_ulp
        found.ask("residual", good, tell("residual"))
    sum_F = got["F_ss_star"] + got["F_sa_star"]
    size_F = np.abs(got["F_ss_star"]) + np.abs(got["F_sa_star"])
    good = np.abs(sum_F - F) <= (BALANCE + per_ulp) * np.abs(F) + 1e-14 * size_F
    found.ask(say + "sum of loads", good, tell("F_ss_star", "F_sa_star"))
    A = got["A_t"]
    for parts in (("A_ss", "A_sa"), ("A_e", "A_ep", "A_p")):
        total = sum(got[name] for name in parts)
        found.ask(say + "sum of areas", np.abs(total - A) <= 1e-12 * A, tell("A_t", *parts))
    for name in AREAS:
        found.ask(say + "areas from 0 up", got[name] >= 0, tell(name))
    pulls = contact.asperity_law.name in ADHESIVE
    if not pulls:
        found.ask(
            say + "loads from 0 up",
            np.minimum(got["F_ss_star"], got["F_sa_star"]) >= 0,
            tell("F_ss_star", "F_sa_star"),
        )
    for name in SHARES if not pulls else SHARES[1:]:
        good = (got[name] >= 0) & (got[name] <= 1 + 1e-15)
        found.ask(say + "shares in [0, 1]", good, tell(name))
    cut = any("shadow the whole area" in each for each in state.warnings)
    found.ask(say + "shadow", (got["shadow"] >= 0) & ((got["shadow"] <= 1) | cut), tell("shadow"))
    if state.populations:
        for name, share in (
            ("particle_load_share", "load_share"),
            ("particle_area_share", "area_share"),
        ):
            total = sum(getattr(each, share) for each in state.populations)[ok]
            good = np.abs(total - got[name]) <= 1e-10 * (1 + np.abs(got[name])) + per_ulp
            found.ask(
                say + "sum of populations",
                good,
                lambda i, n=name, t=total: f"{t[i]!r} is not " + tell(n)(i),
            )


def _separations(found: Findings, contact: Any, bound: Any, state: Any, columns: Any) -> None:
    """Loads over a dense grid: monotone or said, the first root met, and reasons that are true."""
    rough = contact.roughness
    low = bound.asperities.centre + DEEPEST * rough.sigma_s
    top = bound.asperities.centre + 12 * rough.sigma_s
    grid = [np.linspace(low, top, 1500)]
    if bound.particles is not None:
        reach = max(bound.particles.reach, low)
        grid += [np.linspace(low, reach, 1500), reach - (reach - low) * np.geomspace(1e-9, 1, 300)]
    d = np.unique(np.concatenate(grid))
    F = bound.load(d)[:, 0] / contact.E_ss
    found.ask("load at any d is a number", np.isfinite(F), lambda i: f"d = {d[i]!r}")
    words = " ".join([*state.warnings, *map(str, np.atleast_1d(state.status))])
    if not np.isfinite(F).all():
        return
    said = SAID in words
    status = np.asarray(columns["status"], str)
    for i, load in enumerate(columns["F_star"]):
        above = load * (1 + 1e-9) <= F
        below = load * (1 - 1e-9) >= F
        if status[i] != "ok":
            if state.status_code[i] == Status.TOO_MUCH:
                found.ask(
                    "beyond the most is true",
                    not above.any(),
                    f"F* = {load!r} has a root: F*({d[above][-1] if above.any() else 0!r}) is more",
                )
            continue
        here = columns["d"][i]
        # of all separations that carry the load, the largest
        step = 1e-9 * (abs(here) + rough.sigma)
        higher = above & (d > here + step)
        found.ask(
            "first root on approach",
            not higher.any(),
            f"F* = {load!r}: d = {here!r}, but F*({d[higher][-1] if higher.any() else 0!r}) is more",
        )
        deeper = below & (d < here - step)
        found.ask(
            "one root, or said",
            said or not deeper.any(),
            f"F* = {load!r}: d = {here!r}, but F*({d[deeper][-1] if deeper.any() else 0!r}) is less",
        )


def _round_trip(found: Findings, contact: Any, columns: Any) -> None:
    ok = np.isfinite(columns["d"])
    if not ok.any():
        return
    d = columns["d"][ok]
    back = tb.solve(contact, d=d).columns()
    per_ulp, spread = slack(contact, d)
    F = columns["F_star"][ok]
    good = np.abs(back["F_star"] - F) <= F * (BALANCE + per_ulp)
    found.ask("round trip", good, lambda i: f"F* = {F[i]!r} gives {back['F_star'][i]!r}")
    for name in PARTS:
        total = F if name[0] == "F" else columns["A_t"][ok] if name[0] == "A" else 1.0
        x, y = columns[name][ok], back[name]
        found.ask(
            "round trip",
            np.abs(x - y) <= 1e-11 * total + spread[name],
            lambda i, n=name, x=x, y=y: f"{n} at F* = {F[i]!r}: {x[i]!r}, at its d {y[i]!r}",
        )


def _engines(found: Findings, drawn: Drawn, columns: Any) -> None:
    """The compiled engine on what it knows."""
    contact = drawn.contact
    with mock.patch.object(engine, "FEWEST", 1):
        compiled = tb.solve(contact, F_star=drawn.loads)
    if compiled.engine != "compiled":
        return
    _states_of_engine(found, contact, compiled.columns())
    alike(found, "engines", contact, columns, compiled)


def _states_of_engine(found: Findings, contact: Any, columns: Any) -> None:
    ok = np.asarray(columns["status"], str) == "ok"
    F = columns["F_star"]
    found.ask(
        "compiled: no NaN told as ok",
        np.isfinite(columns["d"]) | ~ok,
        lambda i: f"d at F* = {F[i]!r}",
    )
    for name in AREAS:
        found.ask(
            "compiled: areas from 0 up",
            ~(columns[name] < 0),
            lambda i, n=name: f"{n} = {columns[n][i]!r} at F* = {F[i]!r}",
        )
    ok &= np.isfinite(columns["d"])
    if not ok.any():
        return
    per_ulp, _ = slack(contact, columns["d"][ok])
    residual = columns["residual"][ok]
    found.ask(
        "compiled: residual",
        residual <= BALANCE + per_ulp,
        lambda i: f"{residual[i]!r} at F* = {F[ok][i]!r}",
    )


def _outputs(found: Findings, drawn: Drawn, at: Any) -> None:
    """What a contact does: the same in other units, and no part of how it carries its load."""
    contact = drawn.contact
    if not contact.outputs:
        return
    bare = tb.solve(contact.replace(outputs=()), d=drawn.d).columns()
    want = at.columns()
    for name in PARTS:
        same = (want[name] == bare[name]) | (np.isnan(want[name]) & np.isnan(bare[name]))
        found.ask("outputs change no state", same, name)
    length, pressure = 2.0**9, 2.0**-7  # exact: no number is rounded another way
    got = tb.solve(in_other_units(contact, length, pressure), d=drawn.d * length).columns()
    ok = (np.asarray(want["status"], str) == "ok") & (np.asarray(got["status"], str) == "ok")
    small = {"F_star", "F_ss_star", "F_sa_star", "n_ss", "n_sa"} & want.keys()
    for name in sorted(small):  # below, floats have few digits
        ok &= ~((want[name] != 0) & (np.abs(want[name]) < LEAST_DIGITS))
    for name in (each for each in want if each not in COLUMNS):
        unit = about(name).unit
        if unit not in LENGTHS or want[name].dtype.kind != "f":
            continue
        x, y = want[name][ok] * length ** LENGTHS[unit] * pressure ** PRESSURES[unit], got[name][ok]
        same = (x == y) | (np.isnan(x) & np.isnan(y))
        numbers = np.isfinite(x) & np.isfinite(y)
        none = 1e-12 if unit == "K" else 0.0  # a picokelvin is no rise of temperature
        same[numbers] |= np.abs(x[numbers] - y[numbers]) <= 1e-6 * np.abs(x[numbers]) + none
        found.ask(
            "units of outputs",
            same,
            lambda i, n=name, x=x, y=y: f"{n} at d = {drawn.d[ok][i]!r}: {x[i]!r} or {y[i]!r}",
        )


def _units(found: Findings, drawn: Drawn, state: Any, at: Any) -> None:
    """Numbers without a unit do not know the units."""
    length, pressure = 3.7, 2.3e-3
    other = in_other_units(drawn.contact, length, pressure)
    alike(found, "units", drawn.contact, state, tb.solve(other, F_star=drawn.loads))
    got, want = tb.solve(other, d=drawn.d * length).columns(), at.columns()
    _, spread = slack(drawn.contact, want["d"])
    F = np.abs(want["F_ss_star"]) + np.abs(want["F_sa_star"])
    for name in PARTS:
        total = F if name[0] == "F" else want["A_t"] if name[0] == "A" else 1.0
        good = np.abs(got[name] - want[name]) <= ALIKE * total + spread[name]
        good |= np.isnan(got[name]) & np.isnan(want[name])
        found.ask(
            "units, given d",
            good,
            lambda i, n=name: f"{n} at d = {want['d'][i]!r}: {want[n][i]!r} or {got[n][i]!r}",
        )


def _each(found: Findings, drawn: Drawn) -> None:
    """States solved together are those solved one by one."""
    contact = drawn.contact
    rng = np.random.default_rng([drawn.seed, drawn.index, 1])
    count = 24
    loads = np.exp(rng.uniform(*np.log(LOADS), count))
    if isinstance(contact.particles, tb.Particles):
        density = contact.particles.areal_density * np.geomspace(0.01, 1, count)
        vary = {"particles.areal_density": density}
    else:
        if contact.roughness.ellipticity is not None and contact.particles is not None:
            return
        vary = {"roughness.eta_R_sigma": np.geomspace(0.02, 0.1, count)}
    together = state_columns(contact, F_star=loads, vary=vary)
    ((name, values),) = vary.items()
    for i in range(0, count, 3):
        one = contact.replace(**{name: float(values[i])})
        state = tb.solve(one, F_star=loads[i : i + 1])
        alike(found, "solve_states", one, state, {k: v[i : i + 1] for k, v in together.items()})
    F = together["F_star"]
    ok = np.asarray(together["status"], str) == "ok"
    found.ask(
        "solve_states: no NaN told as ok",
        np.isfinite(together["d"]) | ~ok,
        lambda i: f"F* = {F[i]!r}, {name} = {values[i]!r}",
    )
    for column in AREAS:
        found.ask(
            "solve_states: areas from 0 up",
            ~(together[column] < 0),
            lambda i, n=column: (
                f"{n} = {together[n][i]!r} at F* = {F[i]!r}, {name} = {values[i]!r}"
            ),
        )
    d = np.full(count, drawn.d[len(drawn.d) // 2])
    given = state_columns(contact, d=d, vary=vary)
    # the one by one leave tails out that states by their own laws have
    left_out = math.exp(-COMPLETE) * (
        not isinstance(contact.roughness.heights, tb.heights.GaussianHeights)
    )
    for i in range(0, count, 8):
        one = tb.solve(contact.replace(**{name: float(values[i])}), d=d[i : i + 1]).columns()
        total = np.abs(one["F_ss_star"]) + np.abs(one["F_sa_star"])
        for column in PARTS:
            size = total if column[0] == "F" else one["A_t"] if column[0] == "A" else 1.0
            x, y = one[column], given[column][i : i + 1]
            found.ask(
                "solve_states, given d",
                (np.abs(x - y) <= ALIKE * size + left_out) | (np.isnan(x) & np.isnan(y)),
                f"{column} at d = {d[i]!r}, {name} = {values[i]!r}: {x[0]!r} or {y[0]!r}",
            )


WORDS = ("found", "jump", "never p-s", "always p-s", "always s-s", "never s-s", "none")


def _critical(found: Findings, contact: Any) -> None:
    got = tb.transitions(contact)
    points = {"F_cr1": got.F_cr1, "F_cr2": got.F_cr2, **{k: getattr(got.F_tpca, k) for k in "ABC"}}
    for name, each in points.items():
        found.ask("critical loads: status", each.status.split(":")[0] in WORDS, f"{name}: {each}")
        has = each.value is not None
        number = has and math.isfinite(each.value)
        found.ask(
            "critical loads: a number where found",
            number == (each.status in ("found", "jump", "always s-s")),
            f"{name}: {each}",
        )
    one, two = got.F_cr1, got.F_cr2
    if one.status in ("found", "jump") and two.status in ("found", "jump"):
        found.ask("critical loads: order", one.value <= two.value * (1 + 1e-8), f"{one} {two}")
    if one.status == "always p-s":
        found.ask("critical loads: order", two.status == "never s-s", f"{one} {two}")
    for each, threshold in ((one, 0.98), (two, 0.05)):
        if each.status == "found":
            near = tb.solve(contact, F_star=each.value * np.array([1 - 1e-7, 1, 1 + 1e-7]))
            share = near.particle_area_share
            spread = 1e-4 + np.ptp(share)
            found.ask(
                "critical loads: share there",
                np.abs(share[1] - threshold) <= spread,
                f"{share.tolist()} at {each}",
            )


# ---------------------------------------------------------------------------- running
class TooLong(Exception):
    """A contact took longer than the limit."""


def run(
    seed: int, index: int, limit: int = 0, *, shares: int = 1, whole: bool = False
) -> dict[str, Any]:
    """One contact: what was asked, and what failed."""

    def stop(*_: Any) -> None:
        raise TooLong(f"more than {limit} s")

    begun, states = time.perf_counter(), 0
    if limit:
        signal.signal(signal.SIGALRM, stop)
        signal.alarm(limit)
    refused = ""
    found = Findings()
    noted: list[warnings.WarningMessage] = []
    try:
        with quiet(), warnings.catch_warnings(record=True) as noted:
            warnings.simplefilter("always", RuntimeWarning)
            drawn = draw_whole(seed, index) if whole else draw(seed, index)
            found, states = hold(drawn, shares=shares)
    except (tb.errors.InvalidValue, tb.errors.NoEquilibrium) as error:
        refused = str(error)
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        found.failed.append(
            (
                "no exception",
                f"{type(error).__name__}: {error} ({Path(where.filename).name}:{where.lineno})",
            )
        )
    finally:
        if limit:
            signal.alarm(0)
    _of_numpy(found, noted)
    return {
        "seed": seed,
        "index": index,
        "seconds": round(time.perf_counter() - begun, 2),
        "loads": states,
        "refused": refused,
        "asked": dict(found.asked),
        "failed": found.failed,
    }


def _of_numpy(found: Findings, noted: list[warnings.WarningMessage]) -> None:
    """No warning of NumPy reaches a user; those of this file's own sums are not the library's."""
    places = {
        f"{each.message} ({Path(each.filename).name}:{each.lineno})"
        for each in noted
        if issubclass(each.category, RuntimeWarning) and each.filename != __file__
    }
    found.ask("no warning of NumPy", not places, "; ".join(sorted(places)))


def _run(job: tuple[int, int, int, int, bool]) -> dict[str, Any]:
    *one, shares, whole = job
    return run(*one, shares=shares, whole=whole)


def told(result: dict[str, Any]) -> str:
    """The failures of one contact, each with what repeats it."""
    name = f"--seed {result['seed']} --index {result['index']}"
    return "\n".join(f"{name}  {check}: {why}" for check, why in result["failed"])


def summary(results: list[dict[str, Any]]) -> str:
    """Counts of contacts, loads, and failures of each check."""
    asked: Counter[str] = Counter()
    contacts: Counter[str] = Counter()
    for result in results:
        asked.update(result["asked"])
        contacts.update({check for check, _ in result["failed"]})
    refused = Counter(
        re.sub(r"[\d.e+-]*\d[\d.e+-]*", "#", r["refused"])[:80] for r in results if r["refused"]
    )
    bad = sum(bool(r["failed"]) for r in results)
    lines = [
        f"{len(results)} contacts, {sum(r['loads'] for r in results)} loads and separations, "
        f"{bad} contacts with failures, {sum(refused.values())} refused",
        f"{'contacts failing':>16}  {'questions':>10}  check",
    ]
    for check in sorted(asked.keys() | contacts.keys()):
        lines.append(f"{contacts[check]:16d}  {asked[check]:10d}  {check}")
    lines += [f"refused {n}: {why}" for why, n in refused.most_common()]
    slow = sorted(results, key=lambda r: -r["seconds"])[:3]
    lines += [f"{r['seconds']:.1f} s: --seed {r['seed']} --index {r['index']}" for r in slow]
    return "\n".join(lines)


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--contacts", type=int, default=300, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="index of the first")
    parser.add_argument("--index", type=int, help="this contact alone, written out")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--limit", type=int, default=300, help="seconds for one contact")
    parser.add_argument(
        "--shares", type=int, default=1, help="contacts take turns in the checks that cost most"
    )
    parser.add_argument(
        "--plain", action="store_true", help="without strengths, faces, another onset and outputs"
    )
    parser.add_argument("--out", type=Path, help="a line of JSON for each contact; resumes")
    given = parser.parse_args(words)
    if given.index is not None:
        with quiet():
            drawn = (draw if given.plain else draw_whole)(given.seed, given.index)
        print(drawn.contact)
        result = run(given.seed, given.index, whole=not given.plain)
        print(told(result) or result["refused"] or "every check holds")
        return bool(result["failed"])
    results = []
    if given.out and given.out.exists():
        lines = (json.loads(line) for line in given.out.read_text("utf-8").splitlines())
        results = [r for r in lines if r["seed"] == given.seed]
    wanted = range(given.first, given.first + given.contacts)
    results = [r for r in results if r["index"] in wanted]
    done = {r["index"] for r in results}
    whole = not given.plain
    jobs = [(given.seed, i, given.limit, given.shares, whole) for i in wanted if i not in done]
    sink = given.out.open("a", encoding="utf-8") if given.out else contextlib.nullcontext()
    begun = time.perf_counter()
    # fresh processes now and then: tables of contacts that never come again are kept
    several = multiprocessing.get_context("spawn").Pool(given.workers, maxtasksperchild=100)
    with sink as file, several as pool:
        for number, result in enumerate(pool.imap(_run, jobs), 1):
            results.append(result)
            if result["failed"]:
                print(told(result), flush=True)
            if file:
                print(json.dumps(result, ensure_ascii=False), file=file, flush=True)
            if number % 50 == 0:
                rate = (time.perf_counter() - begun) / number
                left = rate * (len(jobs) - number)
                print(
                    f"{number} of {len(jobs)}, {left / 60:.0f} min left",
                    file=sys.stderr,
                    flush=True,
                )
    print(summary(results))
    return any(r["failed"] for r in results)


if __name__ == "__main__":
    sys.exit(main())
