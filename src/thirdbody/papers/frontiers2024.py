"""Front. Mech. Eng. 2024, 1390335: what its abstract says of oil, particles and real area.

``thirdbody reproduce frontiers2024`` writes ledger and figures. Only the abstract was read: film
formula, load sharing, surfaces and particles are this library's (`mixed_film`), so a statement
that holds supports the physics, and no number of the paper is reproduced.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..systems.film_formulas import Oil, Point
from ..systems.mixed_film import MixedFilm, mixed_film
from .engine import ignore_ranges
from .ledger import Measurement
from .panels import Line, Panel
from .report import Study
from .trends import Reading, Trend, readings_of

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
    with ignore_ranges():
        return mixed_film(case, conjunction=BALL, oil=oil, load=load, speed=speed)


def solve(seat: str, pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of the dry contact, with particles on one seat."""
    with_them, without = contact(seat, **factors), contact(seat, **{**factors, "density": 0.0})
    with ignore_ranges():
        state = tb.solve(with_them, pressure=pressures)
        bare = tb.solve(without, pressure=pressures)
    return Trend(
        pressures,
        np.asarray(state.A_t),
        np.asarray(bare.A_t),
        np.asarray(state.particle_load_share),
    )


READINGS = readings_of("frontiers2024", PRESSURES, solve)


# ------------------------------------------------------------------ measures
def dry_change(reading: Reading, of: str, by: float) -> Measurement:
    """Dry real area after multiplying one input over that before, at the mean Hertz pressure."""
    p = float(BALL.hertz(LOAD, E=2 * contact().E_ss).mean)
    after = reading.trend(p, **{of: by}).area[0]
    return Measurement.from_values(after / reading.trend(p).area[0])


def film_change(reading: Reading, of: str, by: float, speed: float) -> Measurement:
    """The same in oil, at one speed."""
    before = lubricated(contact(reading.name), speed)
    after = lubricated(contact(reading.name, **{of: by}), speed)
    share = f"film carries {100 * before.film_share:.3g} %"
    return Measurement.from_values(after.A_t / before.A_t, note=share)


def boundary_viscosity(reading: Reading) -> Measurement:
    """Viscosity at which boundary lubrication begins, with particles over without, at 0.02 m/s."""
    limits = [_boundary(contact(reading.name, density=density)) for density in (1.0, 0.0)]
    return Measurement.from_values(limits[0] / limits[1])


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
    return Measurement.from_values(lubricated(case, float(u)).film_share, note=f"at {u:.3g} m/s")


@cache
def equal_gap(seat: str, size: float, density: float, roughness: float) -> tuple[float, float]:
    """Separation d [m] at which particles and asperities carry alike, and the pressure [Pa] there.

    NaN where they never do.
    """
    case = contact(seat, size=size, density=density, roughness=roughness)
    sigma = case.roughness.sigma
    with ignore_ranges():
        d = np.linspace(6.0, -1.5, 400) * sigma
        state = tb.solve(case, d=d)
        above = np.asarray(state.particle_load_share) - 0.5
        (cells,) = np.nonzero((above[:-1] > 0) & (above[1:] <= 0))
        if not len(cells):
            return float("nan"), float("nan")
        from scipy.optimize import brentq

        i = cells[-1]
        d_equal = brentq(
            lambda x: tb.solve(case, d=x).particle_load_share - 0.5, d[i + 1], d[i], xtol=1e-18
        )
        return float(d_equal), float(tb.solve(case, d=d_equal).pressure)


def turning_pressure(reading: Reading, of: str, by: float, **also: float) -> Measurement:
    """Dry pressure at which both carry half, after multiplying inputs over that before."""
    base = {"size": 1.0, "density": 1.0, "roughness": 1.0}
    before = equal_gap(reading.name, **base)[1]
    after = equal_gap(reading.name, **{**base, of: by, **also})[1]
    if not np.isfinite(after / before):
        return Measurement.absent("particles and asperities never carry alike")
    return Measurement.from_values(after / before)


def turning_load_in_oil(reading: Reading, of: str, by: float) -> Measurement:
    """Load [N] in oil at 0.02 m/s at which both carry half, after over before."""
    before, after = (_oil_load(reading.name, **{of: factor}) for factor in (1.0, by))
    if not np.isfinite(after / before):
        return Measurement.absent("not between 0.01 N and 1 kN")
    return Measurement.from_values(after / before)


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

    ratios = []
    for p in pressures:

        def excess(log_size: float, p: float = p) -> float:
            return float(reading.trend(p, size=np.exp(log_size)).load_share[0] - 0.5)

        low, high = np.log(np.array([0.2, 15.0]) * SIGMA / SIZE)
        if excess(low) > 0 or excess(high) < 0:
            return Measurement.absent(f"none from 0.2 to 15 at {p:g} Pa")
        ratios.append(SIZE / SIGMA * np.exp(brentq(excess, low, high, xtol=1e-6)))
    return Measurement.from_values(min(ratios), max(ratios))


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


STUDY = Study.read_data(
    "frontiers2024",
    READINGS,
    (area_panel,),
    dry_change,
    film_change,
    boundary_viscosity,
    crossing,
    turning_pressure,
    turning_load_in_oil,
    turning_ratios,
)

reproduce = STUDY.reproduce
