"""Ghaednia, Jackson and Gao 2014: elastic asperities, and particles beside them.

``thirdbody reproduce ghaednia2014`` writes ledger and figures. Neither the paper nor its abstract
could be obtained; what is known of it is one sentence of another paper. The model is `Contact`
with `GW` asperities and `Series` particles on the mean asperity plane, loads and areas added:

.. math:: p = \\eta\\int F(z-d)\\,\\phi\\,dz + \\eta_a\\int_{x>d} f(x, d)\\,\\psi(x)\\,dx,
          \\qquad f = \\tfrac43 E^*_{sa}\\sqrt{x/2}\\,\\Bigl(\\frac{x-d}{2}\\Bigr)^{3/2} .
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..contact.interface import interface
from ..laws.asperity import GW, JG, AbstractAsperityLaw
from ..laws.particle import Series
from ..systems.fractal import GhaedniaMultiscale, Stack
from .ledger import Measurement
from .panels import Line, Panel
from .report import Study
from .trends import (
    PRESSURE,
    Reading,
    Trend,
    area_panel,
    changes_panel,
    exponent_panel,
    ratio_panel,
    readings_of,
)

__all__ = [
    "PRESSURES",
    "READINGS",
    "STUDY",
    "conductance_ratio",
    "contact",
    "reproduce",
    "stacked",
]

Array = NDArray[np.float64]

PRESSURES = np.geomspace(1e5, 1e8, 61)
"""Nominal pressures [Pa]. The bare asperities press with at most a quarter of the hardness."""
SIZE, SPREAD, DENSITY = 200e-9, 0.2, 1e10
"""Mean diameter [m], its relative standard deviation, particles per nominal area [1/m²]."""
SIGMA, RADIUS = 50e-9, 100e-6
"""RMS roughness and asperity radius [m]: smooth enough that the asperities are elastic."""
STACKED_DENSITY = 1e12
"""Particles per area of bare contact [1/m²], in the reading with stacked sinusoids."""
LAWS: dict[str, AbstractAsperityLaw] = {"elastic": GW(), "elastic-plastic": JG()}
"""One particle against one surface."""


def contact(
    law: str = "elastic",
    *,
    size: float = 1.0,
    spread: float = 1.0,
    density: float = 1.0,
    stiffness: float = 1.0,
    roughness: float = 1.0,
    sharpness: float = 1.0,
) -> tb.Contact:
    """Steel on steel with silica between; every number multiplies an input.

    Parameters
    ----------
    law : {"elastic", "elastic-plastic"}
        What one particle does on each side, a name in `LAWS`; the asperities are elastic.
    size, spread, density : float, optional
        Factors on mean diameter, relative standard deviation, and number per nominal area [1].
    stiffness : float, optional
        Factor on modulus and hardness of the particles [1].
    roughness, sharpness : float, optional
        Factors on σ and on the curvature 1/R of the asperities [1].

    Returns
    -------
    Contact

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.papers.ghaednia2014 import contact
    >>> dusty = contact()
    >>> bare = dusty.replace(particles=None)
    >>> A, A_bare = (tb.solve(one, pressure=1e6).A_t for one in (dusty, bare))
    >>> round(A / A_bare, 2)
    0.07
    """
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    mean = SIZE * size
    dust = tb.Particles(
        material=silica.replace(E=silica.E * stiffness, H=silica.H * stiffness),
        diameter=tb.TruncatedGaussian(mean=mean, std=SPREAD * spread * mean),
        areal_density=DENSITY * density,
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=SIGMA * roughness, R=RADIUS / sharpness),
        asperity_law=GW(),
        particles=dust,
        particle_law=Series(law=LAWS[law], soft="sphere", deep="off", seat="plane", shadow="none"),
    )


def stacked(
    size: float = 1.0,
    spread: float = 1.0,
    density: float = 1.0,
    stiffness: float = 1.0,
    roughness: float = 1.0,
) -> GhaedniaMultiscale:
    """Elastic stacked sinusoids instead of asperities, elastic particles where they touch.

    Parameters
    ----------
    size, spread, density, stiffness, roughness : float, optional
        Factors on the inputs, as in `contact` [1].

    Returns
    -------
    GhaedniaMultiscale

    Examples
    --------
    >>> from thirdbody.papers.ghaednia2014 import stacked
    >>> state = stacked().solve(1e6)
    >>> round(state.A_real / state.A_0, 4)
    0.0087
    """
    dust = contact(size=size, spread=spread, stiffness=stiffness).particles
    assert isinstance(dust, tb.Particles)
    pair = contact().surfaces
    return GhaedniaMultiscale(
        surface=Stack.self_affine(
            hurst=0.8,
            amplitude=100e-9 * roughness,
            frequency=1e3,
            ratio=2,
            count=8,
            E_star=pair.E_star,
        ),
        surfaces=pair,
        particles=dust.replace(areal_density=STACKED_DENSITY * density),
        law=GW(),
    )


def solve(reading: str, pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of a reading: of stacked sinusoids, or of asperities with one of `LAWS`."""
    if reading == "stack":
        state = stacked(**factors).solve(pressures)
        return Trend(pressures, state.A_real, state.A_0, state.particle_load_share)
    full = contact(reading, **factors)
    dusty = tb.solve(full, pressure=pressures)
    bare = tb.solve(full.replace(particles=None), pressure=pressures)
    return Trend(
        pressures,
        np.asarray(dusty.A_t),
        np.asarray(bare.A_t),
        np.asarray(dusty.particle_load_share),
    )


READINGS = readings_of("ghaednia2014", PRESSURES, solve)


# ------------------------------------------------------------------ conductance
def conductance_ratio(
    law: str, pressures: Array, *, conducting: bool = False, **factors: float
) -> Array:
    r"""Conductance of the contact spots over that without particles, at equal load [1].

    A spot of radius b conducts 2kb, and an elastic one has the stiffness 2E*b, so the asperities
    conduct :math:`h = -(k/E^*)\,dp_{ss}/dd` (Barber 2003). Insulating particles conduct nothing.
    A perfectly conducting one has a constriction in each surface, which makes
    :math:`-(2k/E^*_{sa})\,dp_{sa}/dd`: the most that particles can add. Spots do not interfere.

    Parameters
    ----------
    law : {"elastic", "elastic-plastic"}
    pressures : array
        Nominal pressures [Pa].
    conducting : bool, optional
        Perfectly conducting particles instead of insulating ones; elastic particles only.
    **factors
        As in `contact`.

    Returns
    -------
    array
        Ratio of conductances [1].

    Raises
    ------
    InvalidValue
        Conducting particles that are not elastic: their stiffness does not tell their radius.

    References
    ----------
    Barber 2003, Proc. R. Soc. A 459, 53.

    Examples
    --------
    >>> import numpy as np
    >>> from thirdbody.papers.ghaednia2014 import conductance_ratio
    >>> float(conductance_ratio("elastic", np.array([1e8])).round(2)[0])
    0.95
    """
    if conducting and law != "elastic":
        raise tb.errors.InvalidValue(f"law = {law!r} must be 'elastic' for conducting particles")
    dusty = contact(law, **factors)
    bare = dusty.replace(particles=None)
    with_particles = np.atleast_1d(tb.solve(dusty, pressure=pressures).d)
    without = np.atleast_1d(tb.solve(bare, pressure=pressures).d)
    asperities = interface(bare).load(with_particles)[:, 1]
    conductance = asperities / dusty.E_ss
    if conducting:
        assert isinstance(dusty.particles, tb.Particles)
        E_sa = tb.MaterialPair(dusty.surfaces.first, dusty.particles.material).E_star
        total = interface(dusty).load(with_particles)[:, 1]
        conductance = conductance + 2 * (total - asperities) / E_sa
    return conductance * dusty.E_ss / interface(bare).load(without)[:, 1]


def largest_conductance_ratio(reading: Reading, conducting: bool) -> Measurement:
    """The largest conductance over that without particles."""
    if reading.name not in LAWS:
        return Measurement.absent("patches of stacked sinusoids have no radius")
    if conducting and reading.name != "elastic":
        return Measurement.absent("needs the radius of elastic spots")
    ratio = conductance_ratio(reading.name, reading.pressures, conducting=conducting)
    return Measurement.from_values(ratio.max())


def pressure_over_hardness(reading: Reading, pressure: float) -> Measurement:
    """Mean pressure under the particles over the hardness of the steel, where they carry all."""
    trend = reading.trend(pressure)
    if trend.load_share[0] < 0.99:
        return Measurement.absent("the asperities carry load there")
    return Measurement.from_values(pressure / trend.area[0] / tb.materials["S45C"].H)


def flattening(reading: Reading, pressure: float) -> Measurement:
    """Area under the particles over the sum of their great circles."""
    if reading.name not in LAWS:
        return Measurement.absent("the particles lie on a part of the surface only")
    dusty = contact(reading.name)
    assert isinstance(dusty.particles, tb.Particles)
    return Measurement.from_values(
        tb.solve(dusty, pressure=pressure).A_sa / dusty.particles.coverage
    )


# ------------------------------------------------------------------ figures
def conductance_panel(name: str) -> Panel:
    """Conductance of the spots over that of bare surfaces."""
    curves = (
        ("insulating, elastic", conductance_ratio("elastic", PRESSURES)),
        ("insulating, elastic-plastic", conductance_ratio("elastic-plastic", PRESSURES)),
        ("conducting, elastic", conductance_ratio("elastic", PRESSURES, conducting=True)),
    )
    return Panel(
        name,
        "conductance of the contact spots over that without particles",
        PRESSURE,
        "$h/h_{bare}$ [1]",
        ("pressure_Pa", "conductance_ratio"),
        tuple(Line(label, PRESSURES, y, i, i) for i, (label, y) in enumerate(curves)),
        ylog=True,
        ylim=(1e-3, 3),
        levels=((1.0, "no effect"),),
        note="Clean spots, electrical or thermal; no gas, no interference of spots. "
        "Conducting: without resistance of their own.",
    )


STUDY = Study.read_data(
    "ghaednia2014",
    READINGS,
    (
        lambda: area_panel(READINGS, "1"),
        lambda: ratio_panel(READINGS, "2"),
        lambda: exponent_panel(
            READINGS,
            "3",
            "Bend near 50 MPa: at d = 0 every elastic particle has reached its great circle.",
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "4",
            "size",
            {0.5: "$x_a$ = 100 nm", 0.75: "150 nm", 1.0: "200 nm", 1.5: "300 nm", 2.0: "400 nm"},
            "effect of the particle size",
            ylog=False,
            note="Kinks: all particles have reached their great circle and carry no more.",
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "5",
            "density",
            {0.1: r"$\eta_a = 10^9$ m$^{-2}$", 1.0: "$10^{10}$", 10.0: "$10^{11}$"},
            "effect of the particle density",
            ylog=False,
        ),
        lambda: changes_panel(
            READINGS["elastic-plastic"],
            "6",
            "stiffness",
            {
                0.03: "$E_a$, $H_a$: 0.03 × silica",
                0.1: "0.1 × silica",
                0.3: "0.3 × silica",
                1.0: "silica",
                5.0: "5 × silica",
            },
            "effect of stiffness and hardness of the particles",
        ),
        lambda: conductance_panel("7"),
    ),
    largest_conductance_ratio,
    pressure_over_hardness,
    flattening,
)

reproduce = STUDY.reproduce
