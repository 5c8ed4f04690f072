"""Front. Mech. Eng. 2024, 1390335: what its abstract says of oil, particles and real area.

``thirdbody reproduce frontiers2024`` writes ledger and figures. Only the abstract was read: film
formula, load sharing, surfaces and particles are this library's (`mixed_film`), so a statement
that holds supports the physics, and no number of the paper is reproduced.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..systems.film_formulas import Oil, Point
from ..systems.mixed_film import MixedFilm, mixed_film
from .ledger import OWN, SEEN, Measurement
from .panels import Line, Panel
from .report import Study
from .trends import Reading, Trend, claim

__all__ = ["READINGS", "STUDY", "contact", "lubricated", "reproduce"]

Array = NDArray[np.float64]

SIGMA, SIZE, SPREAD, DENSITY = 100e-9, 300e-9, 0.2, 1e10
"""σ, mean diameter [m], its relative standard deviation, particles per nominal area [1/m²]."""
BALL, LOAD = Point(R=9.5e-3), 20.0
"""A ball of 19 mm [m] under 20 N."""
VISCOSITY, ALPHA = 0.02, 2e-8
"""η [Pa s] and its pressure coefficient [1/Pa]."""
MIXED_SPEED, BOUNDARY_SPEED = 0.5, 0.02
"""Entrainment speeds [m/s] at which the film carries half of the load, and a hundredth."""
PRESSURES = np.geomspace(1e6, 1e9, 25)
"""Nominal pressures of the dry contact [Pa]."""
SEATS = {
    "rough": tb.particle.Series(deep="off"),
    "offset": tb.particle.Series(deep="off", seat="offset", h_0=2.5 * SIGMA),
}
"""Where particles rest: anywhere on the rough surface, or on a plane 2.5 σ up, like the paper."""


def contact(
    seat: str = "rough", *, size: float = 1.0, density: float = 1.0, roughness: float = 1.0
) -> tb.Contact:
    """S45C on S45C with SiO₂ particles; factors on x_a, η_a and σ (with R); no density is bare.

    Examples
    --------
    >>> contact(density=0.0).two_body
    True
    """
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    law = SEATS[seat]
    if seat == "offset":
        law = law.replace(h_0=2.5 * SIGMA * roughness)
    mean = SIZE * size
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=SIGMA * roughness, R=2.8e-6 * roughness),
        particles=tb.Particles(
            material=silica,
            areal_density=DENSITY * density,
            diameter=tb.TruncatedGaussian(mean=mean, std=SPREAD * mean),
        ),
        particle_law=law,
    )


def lubricated(
    case: tb.Contact,
    speed: float | Array,
    *,
    viscosity: float = 1.0,
    load: float | Array = LOAD,
) -> MixedFilm:
    """The ball in oil on the contact; ``viscosity`` multiplies that of the oil."""
    oil = Oil(eta=VISCOSITY * viscosity, alpha=ALPHA)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.RangeWarning)
        return mixed_film(case, conjunction=BALL, oil=oil, load=load, speed=speed)


def reading(name: str, title: str, seat: str) -> Reading:
    """The dry contact under pressure, with particles on one seat."""

    def solve(pressures: Array, factors: Mapping[str, float]) -> Trend:
        with_them, without = contact(name, **factors), contact(name, **{**factors, "density": 0.0})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", tb.RangeWarning)
            state = tb.solve(with_them, pressure=pressures)
            bare = tb.solve(without, pressure=pressures)
        return Trend(
            pressures,
            np.asarray(state.A_t),
            np.asarray(bare.A_t),
            np.asarray(state.particle_load_share),
        )

    return Reading(
        name,
        title,
        PRESSURES,
        solve,
        ("size", "density", "roughness", "viscosity"),
        {
            "surfaces": "S45C on S45C, σ = 100 nm, R = 2.8 µm, ηRσ = 0.0455",
            "particles": "SiO₂, mean 300 nm, standard deviation 60 nm, 10¹⁰ per m²",
            "seat": seat,
            "bodies": "ball of 19 mm on a flat, 20 N (mean Hertz pressure 542 MPa)",
            "oil": "20 mPa s, 20 GPa⁻¹; Nijenbanning–Venner–Moes film; load sharing after "
            "Johnson, Greenwood and Poon",
            "speeds": "0.5 m/s (mixed) and 0.02 m/s (boundary)",
        },
    )


READINGS = {
    "rough": reading("rough", "particles anywhere on the roughness", "rough (default)"),
    "offset": reading(
        "offset", "particles on a plane 2.5σ up", "plane, 2.5 σ above the asperities"
    ),
}


# ------------------------------------------------------------------ measures
def dry_change(reading: Reading, of: str, by: float) -> Measurement:
    """Dry real area after multiplying one input over that before, at the mean Hertz pressure."""
    p = float(BALL.hertz(LOAD, E=2 * contact().E_ss).mean)
    after = reading.trend(p, **{of: by}).area[0]
    return Measurement.of(after / reading.trend(p).area[0])


def film_change(reading: Reading, of: str, by: float, speed: float) -> Measurement:
    """The same in oil, at one speed."""
    before = lubricated(contact(reading.name), speed)
    after = lubricated(contact(reading.name, **{of: by}), speed)
    share = f"film carries {100 * before.film_share:.3g} %"
    return Measurement.of(after.A_t / before.A_t, note=share)


def boundary_viscosity(reading: Reading) -> Measurement:
    """Viscosity at which boundary lubrication begins, with particles over without, at 0.02 m/s."""
    limits = [_boundary(contact(reading.name, density=density)) for density in (1.0, 0.0)]
    return Measurement.of(limits[0] / limits[1])


def _boundary(case: tb.Contact) -> float:
    """Factor on the viscosity at which the solids carry 99 % of the load."""
    from scipy.optimize import brentq

    def excess(log_factor: float) -> float:
        state = lubricated(case, BOUNDARY_SPEED, viscosity=float(np.exp(log_factor)))
        return float(np.log(state.film_share / 0.01))

    return float(np.exp(brentq(excess, -5.0, 5.0, xtol=1e-10)))


def crossing(reading: Reading) -> Measurement:
    """Load share of the film at which particles leave the real area as it is."""
    from scipy.optimize import brentq

    case, bare = contact(reading.name), contact(reading.name, density=0.0)

    def gain(log_speed: float) -> float:
        u = float(np.exp(log_speed))
        return float(np.log(lubricated(case, u).A_t / lubricated(bare, u).A_t))

    u = np.exp(brentq(gain, np.log(BOUNDARY_SPEED), np.log(MIXED_SPEED), xtol=1e-8))
    return Measurement.of(lubricated(case, float(u)).film_share, note=f"at {u:.3g} m/s")


@cache
def equal_gap(seat: str, size: float, density: float, roughness: float) -> tuple[float, float]:
    """Separation d [m] at which particles and asperities carry alike, and the pressure [Pa] there.

    NaN where they never do.
    """
    case = contact(seat, size=size, density=density, roughness=roughness)
    sigma = case.roughness.sigma
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.RangeWarning)
        d = np.linspace(6.0, -1.5, 400) * sigma
        state = tb.solve(case, d=d)
        above = np.asarray(state.particle_load_share) - 0.5
        (cells,) = np.nonzero((above[:-1] > 0) & (above[1:] <= 0))
        if not len(cells):
            return float("nan"), float("nan")
        from scipy.optimize import brentq

        i = cells[-1]
        found = brentq(
            lambda x: tb.solve(case, d=x).particle_load_share - 0.5, d[i + 1], d[i], xtol=1e-18
        )
        return float(found), float(tb.solve(case, d=found).pressure)


def turning_pressure(reading: Reading, of: str, by: float, **also: float) -> Measurement:
    """Dry pressure at which both carry half, after multiplying inputs over that before."""
    base = {"size": 1.0, "density": 1.0, "roughness": 1.0}
    before = equal_gap(reading.name, **base)[1]
    after = equal_gap(reading.name, **{**base, of: by, **also})[1]
    if not np.isfinite(after / before):
        return Measurement.absent("particles and asperities never carry alike")
    return Measurement.of(after / before)


def turning_load_in_oil(reading: Reading, of: str, by: float) -> Measurement:
    """Load [N] in oil at 0.02 m/s at which both carry half, after over before."""
    before, after = (_oil_load(reading.name, **{of: factor}) for factor in (1.0, by))
    if not np.isfinite(after / before):
        return Measurement.absent("not between 0.01 N and 1 kN")
    return Measurement.of(after / before)


def _oil_load(seat: str, viscosity: float = 1.0, density: float = 1.0) -> float:
    loads = np.geomspace(1e-2, 1e3, 61)
    case = contact(seat, density=density)
    state = lubricated(case, BOUNDARY_SPEED, viscosity=viscosity, load=loads)
    share = np.asarray(state.sa_share) / np.asarray(state.solid_share)
    (cells,) = np.nonzero((share[:-1] > 0.5) & (share[1:] <= 0.5))
    if not len(cells):
        return float("nan")
    from scipy.optimize import brentq

    def excess(log_load: float) -> float:
        one = lubricated(case, BOUNDARY_SPEED, viscosity=viscosity, load=float(np.exp(log_load)))
        return float(one.sa_share - one.ss_share)

    low, high = np.log(loads[cells[0] : cells[0] + 2])
    return float(np.exp(brentq(excess, low, high, xtol=1e-10)))


def turning_ratios(reading: Reading, pressures: tuple[float, ...]) -> Measurement:
    """x_a/σ at which particles carry half of a dry load, at several pressures."""
    from scipy.optimize import brentq

    found = []
    for p in pressures:

        def excess(log_size: float, p: float = p) -> float:
            return float(reading.trend(p, size=np.exp(log_size)).load_share[0] - 0.5)

        low, high = np.log(np.array([0.2, 15.0]) * SIGMA / SIZE)
        if excess(low) > 0 or excess(high) < 0:
            return Measurement.absent(f"none from 0.2 to 15 at {p:g} Pa")
        found.append(SIZE / SIGMA * np.exp(brentq(excess, low, high, xtol=1e-6)))
    return Measurement.of(min(found), max(found))


MEASURES = {
    one.__name__: one
    for one in (
        dry_change,
        film_change,
        boundary_viscosity,
        crossing,
        turning_pressure,
        turning_load_in_oil,
        turning_ratios,
    )
}

# ------------------------------------------------------------------ what is stated
PAPER = "abstract, doi:10.3389/fmech.2024.1390335"
RISES, FALLS = {"kind": "above", "value": 1.0}, {"kind": "below", "value": 1.0}
HALF = "Read as the load at which particles and asperities carry half each"

CLAIMS = (
    *(
        claim(
            f"mixed-{of}",
            f"In three-body mixed lubrication the real area rises with particle {of}",
            SEEN,
            PAPER,
            f"A after multiplying the {of} by {by:g}, over A before, at 0.5 m/s",
            "film_change",
            RISES,
            of=of,
            by=by,
            speed=MIXED_SPEED,
        )
        for of, by in (("size", 5 / 3), ("density", 3.0))
    ),
    *(
        claim(
            f"boundary-{of}",
            f"In boundary lubrication it falls with particle {of}",
            SEEN,
            PAPER,
            f"the same at 0.02 m/s, {of} multiplied by {by:g}",
            "film_change",
            FALLS,
            of=of,
            by=by,
            speed=BOUNDARY_SPEED,
        )
        for of, by in (("size", 5 / 3), ("density", 3.0))
    ),
    *(
        claim(
            f"dry-{of}",
            f"In dry contact it falls with particle {of}",
            SEEN,
            PAPER,
            f"dry A at 542 MPa, {of} multiplied by {by:g}, over A before",
            "dry_change",
            FALLS,
            of=of,
            by=by,
        )
        for of, by in (("size", 5 / 3), ("density", 3.0))
    ),
    claim(
        "viscosity",
        "When the viscosity falls, boundary lubrication comes earlier with particles than without",
        SEEN,
        PAPER,
        "viscosity at which solids carry 99 %, with particles over without",
        "boundary_viscosity",
        RISES,
    ),
    claim(
        "ratio",
        "The turning point of the contact area is usually at x_a/σ of 0.8 to 1.3",
        SEEN,
        PAPER,
        "x_a/σ at which particles carry half of a dry load, smallest and largest from 1 to 100 MPa",
        "turning_ratios",
        {"kind": "range", "value": [0.8, 1.3]},
        f"{HALF}. The ratio depends on load and density, so it is no constant",
        pressures=(1e6, 1e7, 1e8),
    ),
    claim(
        "load-scale",
        "At equal x_a/σ the load of the turning point rises with particle size and roughness",
        SEEN,
        PAPER,
        "dry pressure with x_a, σ and R doubled, over that before",
        "turning_pressure",
        RISES,
        HALF,
        of="size",
        by=2.0,
        roughness=2.0,
    ),
    claim(
        "load-density",
        "It falls with particle density",
        SEEN,
        PAPER,
        "dry pressure with the density doubled, over that before",
        "turning_pressure",
        FALLS,
        f"{HALF}. More particles then need more load to lose half of it",
        of="density",
        by=2.0,
    ),
    claim(
        "load-viscosity",
        "It falls with the viscosity of the oil",
        SEEN,
        PAPER,
        "load in oil at 0.02 m/s with twice the viscosity, over that before",
        "turning_load_in_oil",
        FALLS,
        f"{HALF}. A thicker film keeps asperities apart up to a higher load",
        of="viscosity",
        by=2.0,
    ),
    claim(
        "crossing",
        "Between the two, particles leave the real area as it is",
        OWN,
        "this library",
        "load share of the film there",
        "crossing",
        {},
    ),
    claim(
        "load-scale-density",
        "The same with the particles' cover of the area kept (density over 4)",
        OWN,
        "this library",
        "dry pressure with x_a, σ and R doubled and a quarter of the density, over that before",
        "turning_pressure",
        {},
        of="size",
        by=2.0,
        roughness=2.0,
        density=0.25,
    ),
)


def area_panel() -> Panel:
    """Change of the real area by particles, from boundary lubrication to a mixed film."""
    speeds = np.geomspace(5e-3, 0.3, 60)
    bare = np.asarray(lubricated(contact(density=0.0), speeds).A_t)
    cases: dict[str, dict[str, float]] = {
        "300 nm, 10¹⁰ m⁻²": {},
        "500 nm, 10¹⁰ m⁻²": {"size": 5 / 3},
        "300 nm, 5·10¹⁰ m⁻²": {"density": 5.0},
    }
    lines = []
    for i, (label, factors) in enumerate(cases.items()):
        area = np.asarray(lubricated(contact("rough", **factors), speeds).A_t)
        lines.append(Line(label, speeds, 100 * (area / bare - 1), i, i))
    return Panel(
        "1",
        "particles lower the real area in boundary, and raise it in mixed lubrication",
        "entrainment speed $u$ [m/s]",
        "change of $A_t$ by particles [%]",
        ("speed_m_per_s", "area_change_percent"),
        tuple(lines),
        levels=((0.0, "no particles"),),
        note="Ball of 19 mm, 20 N, σ = 100 nm, 20 mPa s; SiO₂. "
        "The film carries 1 % of the load at 0.02 m/s and 28 % at 0.3 m/s.",
    )


STUDY = Study(
    "frontiers2024",
    "What can be reproduced of Front. Mech. Eng. 2024, 1390335",
    "Front. Mech. Eng. 2024, 10, 1390335, doi:10.3389/fmech.2024.1390335",
    (
        "Read: the abstract. Not read: its film formula, its load sharing, its parameters and "
        "curves.",
        "Here: the film of Nijenbanning, Venner and Moes, the load sharing of Johnson, Greenwood "
        "and Poon with particles as a third carrier, nothing adjusted to the statements.",
        "Why the sign of the area changes: where the film carries the load, it also sets the gap, "
        "almost whoever carries the rest, and particles add contacts; where solids carry the "
        "load, the load sets the gap, and particles lift asperities out of contact.",
    ),
    READINGS,
    CLAIMS,
    MEASURES,
    (area_panel,),
)

reproduce = STUDY.reproduce
