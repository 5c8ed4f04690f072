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
from .ghaednia2013 import HORNG
from .ledger import NO_SOURCE, OWN, REPORTED, SEEN, Measurement
from .panels import Line, Panel
from .report import Study
from .trends import (
    MEASURES,
    PRESSURE,
    Reading,
    Trend,
    area_panel,
    changes_panel,
    claim,
    exponent_panel,
    ratio_panel,
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
        particle_law=Series(law=LAWS[law], soft="sphere", seat="plane", shadow="none"),
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


def solve_asperities(law: str, pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of GW asperities with particles."""
    full = contact(law, **factors)
    dusty = tb.solve(full, pressure=pressures)
    bare = tb.solve(full.replace(particles=None), pressure=pressures)
    return Trend(
        pressures,
        np.asarray(dusty.A_t),
        np.asarray(bare.A_t),
        np.asarray(dusty.particle_load_share),
    )


def solve_stacked(pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of stacked sinusoids with particles."""
    state = stacked(**factors).solve(pressures)
    return Trend(pressures, state.A_real, state.A_0, state.particle_load_share)


COMMON = {
    "bodies": "S45C on S45C, E = 205 GPa, ν = 0.29, H = 5 GPa",
    "particles": "SiO₂ (68 GPa, 0.19, 7.7 GPa), mean 200 nm, standard deviation 40 nm",
    "pressures": "10⁵ to 10⁸ Pa, 61 values",
}
ASPERITIES = {
    "surface": "GW asperities",
    **COMMON,
    "roughness": "σ = 50 nm, R = 100 µm, ηRσ = 0.0455, α = 5",
    "density": "10¹⁰ per m² of nominal area",
    "seat": "mean asperity plane; loads and areas added, nothing shaded",
}
BOTH = ("size", "spread", "density", "stiffness", "roughness")
READINGS = {
    "elastic": Reading(
        "elastic",
        "GW, elastic particles",
        PRESSURES,
        lambda p, factors: solve_asperities("elastic", p, factors),
        (*BOTH, "sharpness"),
        {**ASPERITIES, "one particle": "Hertz on both sides, in series"},
    ),
    "elastic-plastic": Reading(
        "elastic-plastic",
        "GW, elastic-plastic particles",
        PRESSURES,
        lambda p, factors: solve_asperities("elastic-plastic", p, factors),
        (*BOTH, "sharpness"),
        {
            **ASPERITIES,
            "one particle": "Jackson–Green on both sides, in series; H = 2.8 S_y; "
            "the largest particles are beyond its range a/R < 0.41",
        },
    ),
    "stack": Reading(
        "stack",
        "stacked sinusoids,\nelastic particles",
        PRESSURES,
        solve_stacked,
        BOTH,
        {
            "surface": "8 sinusoids",
            **COMMON,
            "roughness": "amplitude 100 nm at 1/mm, eight octaves, exponent 0.8; RMS 61 nm",
            "density": "10¹² per m² of bare contact",
            "seat": "between the patches where the bare surfaces touch, taken as flat",
            "one particle": "Hertz on both sides, in series",
        },
    ),
}


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
    >>> float(conductance_ratio("elastic", np.array([1e8])).round(2)[0])
    0.95
    """
    if conducting and law != "elastic":
        raise tb.InvalidValue(f"law = {law!r} must be 'elastic' for conducting particles")
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
    return Measurement.of(ratio.max())


def pressure_over_hardness(reading: Reading, pressure: float) -> Measurement:
    """Mean pressure under the particles over the hardness of the steel, where they carry all."""
    trend = reading.trend(pressure)
    if trend.load_share[0] < 0.99:
        return Measurement.absent("the asperities carry load there")
    return Measurement.of(pressure / trend.area[0] / tb.materials["S45C"].H)


def flattening(reading: Reading, pressure: float) -> Measurement:
    """Area under the particles over the sum of their great circles."""
    if reading.name not in LAWS:
        return Measurement.absent("the particles lie on a part of the surface only")
    dusty = contact(reading.name)
    assert isinstance(dusty.particles, tb.Particles)
    return Measurement.of(tb.solve(dusty, pressure=pressure).A_sa / dusty.particles.coverage)


# ------------------------------------------------------------------ what is stated
NOT_FOUND = "paper and abstract not obtainable"
LOW, MIDDLE = 1e5, 1e6
"""Pressures [Pa]: particles alone, and near the load where asperities take over."""

CLAIMS = (
    claim(
        "area",
        "Particles can lower the real area of contact",
        REPORTED,
        HORNG,
        "smallest and largest A/A_bare at equal load",
        "area_ratios",
        {"kind": "below", "value": 1.0},
        "The 2013 abstract says the same of the other model",
    ),
    claim(
        "conduction",
        "Particles can lower the thermal conduction of the contact",
        REPORTED,
        HORNG,
        "largest conductance of the spots over that without particles, insulating particles",
        "largest_conductance_ratio",
        {"kind": "below", "value": 1.0},
        "Electrical conduction follows the same law for clean spots",
        conducting=False,
    ),
    claim(
        "dust",
        "Dust loses its effect once the roughness is comparable with its size",
        SEEN,
        "Williamson, Greenwood, Harris 1956, Proc. R. Soc. A 237, 560: not of this model",
        "area lost at σ = 200 nm (the particle size) over that at σ = 50 nm, at 1 MPa",
        "loss_over_loss",
        {"kind": "at_most", "value": 0.1},
        of="roughness",
        by=4.0,
        pressure=MIDDLE,
    ),
    claim(
        "linear",
        "The real area grows in proportion to the load",
        NO_SOURCE,
        f"reported of the 2013 model only; {NOT_FOUND}",
        "smallest and largest n in A ∝ p^n; 0.95 to 1.05 would agree",
        "area_exponents",
        {"kind": "range", "value": [0.95, 1.05]},
    ),
    claim(
        "linear-particles",
        "The same while the particles carry 99 % of the load",
        OWN,
        "this reconstruction",
        "smallest and largest n in A ∝ p^n",
        "exponents_on_particles",
        {},
    ),
    claim(
        "linear-bare",
        "The same without particles",
        OWN,
        "this reconstruction",
        "smallest and largest n in A_bare ∝ p^n",
        "bare_exponents",
        {},
    ),
    claim(
        "linear-one-size",
        "The same with particles of nearly one size, which are all touched at once",
        OWN,
        "this reconstruction",
        "n in A ∝ p^n at 0.1 MPa, standard deviation 1 % of the size",
        "exponent_at",
        {},
        "Hertzian particles of one size have A ∝ p^(2/3)",
        of="spread",
        by=0.05,
        pressure=LOW,
    ),
    claim(
        "both-carry",
        "Asperities and particles both carry load",
        NO_SOURCE,
        f"stated of the 2013 model; {NOT_FOUND}",
        "particles' share of the load at 5 MPa",
        "load_share",
        {"kind": "range", "value": [0.01, 0.99]},
        pressure=5e6,
    ),
    claim(
        "size",
        "Effect of the particle size",
        NO_SOURCE,
        NOT_FOUND,
        "A at twice the size over A, at 1 MPa",
        "area_change",
        {},
        of="size",
        by=2.0,
        pressure=MIDDLE,
    ),
    claim(
        "size-small",
        "Effect of the particle size, smaller",
        NO_SOURCE,
        NOT_FOUND,
        "A at half the size over A, at 1 MPa",
        "area_change",
        {},
        of="size",
        by=0.5,
        pressure=MIDDLE,
    ),
    claim(
        "density",
        "Effect of the particle density",
        NO_SOURCE,
        NOT_FOUND,
        "A at a tenth of the density over A, at 1 MPa",
        "area_change",
        {},
        of="density",
        by=0.1,
        pressure=MIDDLE,
    ),
    claim(
        "density-alone",
        "Effect of the density where the particles carry everything",
        OWN,
        "this reconstruction",
        "A at ten times the density over A, at 0.1 MPa",
        "area_change",
        {},
        "More particles are pressed less deeply. Elastic ones then press less hard and need more "
        "area; Jackson–Green ones, whose hardness falls with depth, press harder and need less",
        of="density",
        by=10.0,
        pressure=LOW,
    ),
    claim(
        "stiffness",
        "Effect of the stiffness of the particles",
        NO_SOURCE,
        NOT_FOUND,
        "A with modulus and hardness doubled over A, at 1 MPa",
        "area_change",
        {},
        of="stiffness",
        by=2.0,
        pressure=MIDDLE,
    ),
    claim(
        "hardness",
        "A hardness that depends on scale",
        NO_SOURCE,
        f"an ingredient of the 2013 model; {NOT_FOUND}",
        "–",
        "not_in_the_model",
        {},
        why="not used in these readings; see ghaednia2013",
    ),
    claim(
        "too-elastic",
        "Particles that never yield press harder than the steel can bear",
        OWN,
        "this reconstruction",
        "mean pressure under particles over the hardness of the steel, at 0.1 MPa",
        "pressure_over_hardness",
        {},
        "Above 1 the elastic readings overstate how much particles lower the area",
        pressure=LOW,
    ),
    claim(
        "flattened",
        "Before asperities take over, the particles are pressed far beyond small indentations",
        OWN,
        "this reconstruction",
        "area under particles over their great circles, at 1 MPa",
        "flattening",
        {},
        "The laws of one contact hold for small values; the takeover is qualitative",
        pressure=MIDDLE,
    ),
    claim(
        "end",
        "Asperities take over and the area returns to that of bare surfaces",
        OWN,
        "this reconstruction",
        "pressure [Pa] above which A stays above 0.9 A_bare",
        "recovery",
        {},
        ratio=0.9,
    ),
    claim(
        "soft",
        "Particles that are soft enough lower the area no more, and then raise it",
        OWN,
        "this reconstruction",
        "modulus and hardness over those of silica at which A = A_bare, at 0.1 MPa",
        "factor_without_loss",
        {},
        of="stiffness",
        pressure=LOW,
        low=1e-3,
        high=1.0,
    ),
    claim(
        "sharp",
        "Asperities that are sharp enough press harder than the particles, which then add area",
        OWN,
        "this reconstruction",
        "1/R over that of R = 100 µm at which A = A_bare, at 0.1 MPa",
        "factor_without_loss",
        {},
        "The elastic asperities then press with more than the hardness: beyond the validity of GW",
        of="sharpness",
        pressure=LOW,
        low=1.0,
        high=1e3,
    ),
    claim(
        "sparse",
        "Particles that are too few lower the area no more",
        OWN,
        "this reconstruction",
        "A/A_bare at 0.1 MPa with a hundredth of the density",
        "area_ratio_at",
        {},
        of="density",
        by=0.01,
        pressure=LOW,
    ),
    claim(
        "conducting",
        "Particles that conduct perfectly",
        OWN,
        "this reconstruction",
        "largest conductance of the spots over that without particles",
        "largest_conductance_ratio",
        {},
        "The most that conducting particles can add",
        conducting=True,
    ),
)


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


STUDY = Study(
    "ghaednia2014",
    "What can be reproduced of Ghaednia, Jackson and Gao 2014",
    "Ghaednia, Jackson, Gao 2014, IEEE Holm Conference on Electrical Contacts (citation recalled)",
    (
        "Read: one sentence of Horng et al. 2022, who report that the paper extends the model of "
        "Greenwood and Williamson to three bodies and applies it to electrical contacts, and that "
        "particles can lower real area and thermal conduction. Nothing else could be obtained.",
        "Reconstructed: all of it. Asperities are elastic as in Greenwood and Williamson, "
        "particles are two contacts in series between parallel planes, loads and areas add. Only "
        "the sum of the two terms is what “extends” must mean; seat, sizes, densities, materials "
        "and the law of a particle were chosen here. The stacked reading takes the surfaces of "
        "the multi-scale model instead.",
        "When particles lower the area: while they carry the load, A/A_bare is the mean pressure "
        "of bare asperities over that of particles. The asperities press with 0.15 to 0.24 of the "
        "hardness, Jackson–Green particles with half of it, elastic ones with more than all of "
        "it, so the area falls. It does not with soft particles, with asperities too sharp to be "
        "elastic, or with particles that do not reach across the gap.",
        "When the area is proportional to the load: nearly so with particles alone and nearly so "
        "without. In between it must rise from the small area of particles to that of asperities, "
        "and there it grows faster than the load.",
    ),
    READINGS,
    CLAIMS,
    MEASURES
    | {
        one.__name__: one for one in (largest_conductance_ratio, pressure_over_hardness, flattening)
    },
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
)

reproduce = STUDY.reproduce
