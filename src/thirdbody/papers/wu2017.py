"""Wu, Chen and Horng 2017, and Wu and Chen: friction with particles between rough surfaces.

``thirdbody reproduce wu2017`` writes ledger and figures. Both abstracts could be read, the papers
could not: their equations, shear strengths, sizes and densities are not known, and the model here
is `Contact` with `outputs.Friction`. The two abstracts state opposite signs: friction grows with
the size of the particles in one, and falls with it in the other. Here both occur, by one rule:

.. math:: \\mu = w_{ss}\\mu_{ss} + w_{sa}\\mu_{sa}

so that particles lower friction where a particle's coefficient, weighted with load, is below that
of the asperities. The deeper particles sit, the higher it is: few of them raise friction, many
share the load and lower it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..effects import Friction
from .ledger import Measurement
from .panels import Line, Panel
from .report import Study
from .trends import Reading, Trend, readings_of

__all__ = ["PRESSURES", "READINGS", "STUDY", "Slid", "contact", "reproduce"]

Array = NDArray[np.float64]

PRESSURES = np.geomspace(1e6, 5e7, 9)
"""Nominal pressures [Pa]."""
SIGMA, RADIUS = 100e-9, 2.8e-6
"""RMS roughness and asperity radius [m]."""
SIZE, SPREAD = 300e-9, 0.2
"""Mean diameter [m] and its relative standard deviation."""
FEW, MANY = 1e10, 1e11
"""Particles per nominal area [1/m²]."""
TAU_SS, TAU_SA = 580e6, 200e6
"""Shear strengths between surfaces, and between particles and surfaces [Pa] (chosen here)."""
RATIOS = (1.5, 2.0, 3.0, 4.0, 5.0)
"""Mean diameter over RMS roughness x_a/σ."""
ROUGHNESS = (0.5, 1.0, 2.0, 4.0)
"""Factors on σ: 50 to 400 nm."""


def contact(
    density: float,
    rear: str | float = "recovery",
    *,
    size: float = 1.0,
    roughness: float = 1.0,
) -> tb.Contact:
    """Silica on steel, with friction.

    Parameters
    ----------
    density : float
        Particles per nominal area [1/m²]; 0 for none.
    rear : "recovery", "rigid" or float, optional
        As in `thirdbody.outputs.Friction`.
    size, roughness : float, optional
        Factors on x_a = 300 nm and σ = 100 nm [1].

    Examples
    --------
    >>> state = tb.solve(contact(FEW), pressure=5e6)
    >>> round(float(state.outputs["mu"]), 4)
    0.1705
    """
    steel = tb.materials["S45C"]
    particles = tb.Particles(
        material=tb.materials["SiO2"],
        diameter=tb.TruncatedGaussian(mean=size * SIZE, std=SPREAD * size * SIZE),
        areal_density=density or FEW,
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=roughness * SIGMA, R=RADIUS),
        particles=particles if density else None,
        particle_law=tb.particle.Series(deep="off"),
        outputs=(Friction(tau_ss=TAU_SS, tau_sa=TAU_SA, rear=rear),),
    )


@dataclass(frozen=True)
class Slid(Trend):
    """A trend with friction."""

    mu: Array
    bare_mu: Array
    mu_ss: Array
    mu_sa: Array
    elastic: Array
    """Share of the real area on elastic contacts"""
    elastoplastic: Array


CASES: dict[str, tuple[float, str | float]] = {
    "few": (FEW, "recovery"),
    "many": (MANY, "recovery"),
    "smooth": (FEW, 1.0),
}
"""Density [1/m²], and support of the rear half of ploughing contacts, by reading."""


def solve(name: str, pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of one of the cases, with friction."""
    density, rear = CASES[name]
    keywords = dict(factors)
    count = density * keywords.pop("density", 1.0)
    with_them = tb.solve(contact(count, rear, **keywords), pressure=pressures)
    bare = tb.solve(contact(0.0, rear, **keywords), pressure=pressures)
    mu = {name: np.asarray(value) for name, value in with_them.outputs.items()}
    return Slid(
        pressures,
        np.asarray(with_them.A_t),
        np.asarray(bare.A_t),
        np.asarray(with_them.particle_load_share),
        mu["mu"],
        np.asarray(bare.outputs["mu"]),
        mu["mu_ss"],
        mu["mu_sa"],
        np.asarray(with_them.A_e / with_them.A_t),
        np.asarray(with_them.A_ep / with_them.A_t),
    )


READINGS = readings_of("wu2017", PRESSURES, solve)


def friction_trend(reading: Reading, pressures: Array | None = None, **factors: float) -> Slid:
    """The contact with some inputs multiplied."""
    trend = reading.trend(pressures, **factors)
    assert isinstance(trend, Slid)
    return trend


# ------------------------------------------------------------------ measures of this study
def friction_over_sizes(reading: Reading, roughness: float) -> Array:
    """μ by x_a/σ (rows) and pressure."""
    return np.stack(
        [
            friction_trend(reading, size=ratio * SIGMA / SIZE * roughness, roughness=roughness).mu
            for ratio in RATIOS
        ]
    )


def friction_steps(reading: Reading, of: tuple[float, ...]) -> Measurement:
    """Smallest and largest μ over that at the next smaller size, at all loads and roughnesses."""
    steps = []
    for roughness in of:
        mu = friction_over_sizes(reading, roughness)
        steps.append(mu[1:] / mu[:-1])
    return Measurement.from_values(np.min(steps), np.max(steps))


def friction_grows(reading: Reading) -> Measurement:
    """The same at σ = 100 nm."""
    return friction_steps(reading, (1.0,))


def friction_falls(reading: Reading) -> Measurement:
    """The same from σ = 50 to 400 nm."""
    return friction_steps(reading, ROUGHNESS)


def particle_over_asperity(reading: Reading) -> Measurement:
    """Smallest and largest μ_sa/μ_ss over loads and x_a/σ."""
    ratio = []
    for size_ratio in RATIOS:
        trend = friction_trend(reading, size=size_ratio * SIGMA / SIZE)
        ratio.append(trend.mu_sa / trend.mu_ss)
    return Measurement.from_values(np.min(ratio), np.max(ratio))


def friction_range(reading: Reading) -> Measurement:
    """Largest over smallest μ over loads and x_a/σ."""
    mu = friction_over_sizes(reading, 1.0)
    return Measurement.from_values(mu.max() / mu.min())


def share_at_small_load(reading: Reading, size: float, pressure: float) -> Measurement:
    """Particles' share of a small load."""
    return Measurement.from_values(reading.trend(pressure, size=size).load_share[0])


def critical_load(reading: Reading, size: float) -> float | None:
    """Load below which the particles carry nearly everything, F* [1]."""
    density, rear = CASES[reading.name]
    transitions = tb.transitions(contact(density, rear, size=size).replace(outputs=()))
    return transitions.F_cr1.value


def critical_load_steps(reading: Reading) -> Measurement:
    """Smallest growth of F_cr1 from one x_a/σ to the next."""
    critical_loads = [critical_load(reading, ratio * SIGMA / SIZE) for ratio in RATIOS[2:]]
    loads = [value for value in critical_loads if value is not None]
    if len(loads) < 2:
        return Measurement.absent("fewer than two sizes have a critical load")
    note = (
        ""
        if len(loads) == len(critical_loads)
        else f"{len(loads)} of {len(critical_loads)} sizes have one"
    )
    return Measurement.from_values(np.min(np.array(loads[1:]) / np.array(loads[:-1])), note=note)


def elastic_below(reading: Reading) -> Measurement:
    """Elastic share of the area at half the critical load."""
    value = critical_load(reading, 1.0)
    if value is None:
        return Measurement.absent("no critical load")
    E = contact(FEW).E_ss
    trend = friction_trend(reading, np.array([0.5 * value * E]))
    return Measurement.from_values(
        trend.elastic[0], note=f"elastoplastic {trend.elastoplastic[0]:.3g}, the rest plastic"
    )


def elastoplastic_above(reading: Reading, factor: float) -> Measurement:
    """Elastoplastic share of the area above the critical load."""
    value = critical_load(reading, 1.0)
    if value is None:
        return Measurement.absent("no critical load")
    E = contact(FEW).E_ss
    trend = friction_trend(reading, np.array([factor * value * E]))
    return Measurement.from_values(trend.elastoplastic[0])


def two_body_above(reading: Reading, factor: float) -> Measurement:
    """A/A_bare above the critical load."""
    value = critical_load(reading, 1.0)
    if value is None:
        return Measurement.absent("no critical load")
    trend = friction_trend(reading, np.array([factor * value * contact(FEW).E_ss]))
    return Measurement.from_values(trend.ratio[0])


def rule_holds(reading: Reading) -> Measurement:
    """Part of all loads and sizes at which μ < μ_bare exactly where μ_sa < μ_bare."""
    agree = []
    for size_ratio in RATIOS:
        trend = friction_trend(reading, size=size_ratio * SIGMA / SIZE)
        agree.append((trend.mu < trend.bare_mu) == (trend.mu_sa < trend.bare_mu))
    return Measurement.from_values(np.mean(agree))


def slope_follows(reading: Reading) -> Measurement:
    """Part of all steps in size in which μ falls exactly where μ_sa was below μ_ss."""
    agree = []
    for small, large in zip(RATIOS[:-1], RATIOS[1:], strict=True):
        before, after = (
            friction_trend(reading, size=size_ratio * SIGMA / SIZE) for size_ratio in (small, large)
        )
        agree.append((after.mu < before.mu) == (before.mu_sa < before.mu_ss))
    return Measurement.from_values(np.mean(agree))


def density_of_no_effect(reading: Reading, size: float, pressure: float) -> Measurement:
    """Density [1/m²] at which the particles leave μ as it is."""
    base = CASES[reading.name][0]

    def is_higher(factor: float) -> bool:
        trend = friction_trend(reading, np.array([pressure]), size=size, density=factor)
        return bool(trend.mu[0] > trend.bare_mu[0])

    low, high = 1e9 / base, 3e11 / base
    if is_higher(low) == is_higher(high):
        return Measurement.absent("none between 10⁹ and 3·10¹¹ per m²")
    while high / low > 1 + 1e-8:
        middle = (low * high) ** 0.5
        if is_higher(middle):
            low = middle
        else:
            high = middle
    return Measurement.from_values((low * high) ** 0.5 * base)


# ------------------------------------------------------------------ figures
def size_panel() -> Panel:
    """μ against x_a/σ for three densities, and without ploughing."""
    ratios = np.linspace(0.5, 6.0, 34)
    pressure = np.array([5e6])
    bare = friction_trend(READINGS["few"], pressure).bare_mu[0]
    lines = [Line("no particles", ratios, np.full_like(ratios, bare), -1)]
    cases = (
        ("few", 1.0, r"$\eta_a = 10^{10}$ m$^{-2}$"),
        ("few", 3.0, r"$\eta_a = 3\cdot10^{10}$ m$^{-2}$"),
        ("many", 1.0, r"$\eta_a = 10^{11}$ m$^{-2}$"),
        ("smooth", 1.0, "$10^{10}$ m$^{-2}$, no ploughing\n(rolls without resistance)"),
    )
    for i, (name, density, label) in enumerate(cases):
        mu = [
            friction_trend(READINGS[name], pressure, size=ratio * SIGMA / SIZE, density=density).mu[
                0
            ]
            for ratio in ratios
        ]
        lines.append(Line(label, ratios, np.array(mu), i, i))
    return Panel(
        "1",
        "friction against particle size: both signs that were published",
        r"mean diameter over roughness $x_a/\sigma$ [1]",
        r"coefficient of friction $\mu$ [1]",
        ("x_a_over_sigma", "mu"),
        tuple(lines),
        xlog=False,
        ylim=(0.0, None),
        note="5 MPa, σ = 100 nm. Wu, Chen and Horng 2017: grows with size; Wu and Chen: falls.",
    )


def density_panel() -> Panel:
    """Coefficients of particles and asperities against density."""
    densities = np.geomspace(1e9, 3e11, 34)
    pressure = np.array([5e6])
    trends = [
        friction_trend(READINGS["few"], pressure, size=5 / 3, density=density / FEW)
        for density in densities
    ]
    lines = (
        Line("no particles", densities, np.array([t.bare_mu[0] for t in trends]), -1),
        Line(r"$\mu$", densities, np.array([t.mu[0] for t in trends]), 0, 0),
        Line(
            r"particles alone, $\mu_{sa}$", densities, np.array([t.mu_sa[0] for t in trends]), 1, 1
        ),
        Line(
            r"asperities alone, $\mu_{ss}$", densities, np.array([t.mu_ss[0] for t in trends]), 2, 2
        ),
    )
    return Panel(
        "2",
        "why the sign changes: more particles sit less deep",
        r"particles per nominal area $\eta_a$ [m$^{-2}$]",
        "coefficient of friction [1]",
        ("areal_density", "mu"),
        lines,
        ylim=(0.0, None),
        note="5 MPa, σ = 100 nm, mean diameter 500 nm.",
    )


STUDY = Study.read_data(
    "wu2017",
    READINGS,
    (size_panel, density_panel),
    friction_grows,
    friction_falls,
    particle_over_asperity,
    friction_range,
    share_at_small_load,
    critical_load_steps,
    elastic_below,
    elastoplastic_above,
    two_body_above,
    rule_holds,
    slope_follows,
    density_of_no_effect,
)

reproduce = STUDY.reproduce
