"""Ghaednia and Jackson 2013: what the authors say of particles between rough surfaces.

``thirdbody reproduce ghaednia2013`` writes ledger and figures. Abstracts and one report by others
could be read, the paper could not: the model (`GhaedniaMultiscale`) is a reconstruction, and its
surfaces, sizes and densities were chosen here. A statement that holds therefore supports the
reconstruction; it does not reproduce the paper's numbers.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..systems.fractal import GhaedniaMultiscale, MajumdarBhushan, NixGao, Stack
from .ledger import NO_SOURCE, OWN, REPORTED, SEEN, Measurement
from .report import Study
from .trends import (
    MEASURES,
    Reading,
    Trend,
    area_panel,
    changes_panel,
    claim,
    exponent_panel,
    ratio_panel,
)

__all__ = ["PRESSURES", "READINGS", "STUDY", "model", "reproduce", "surfaces"]

Array = NDArray[np.float64]

PRESSURES = np.geomspace(1e5, 3e7, 26)
"""Nominal pressures of the trends [Pa]: far from full contact."""
TO_THE_END = np.geomspace(1e5, 3e9, 91)
"""Nominal pressures up to full contact [Pa], where the trends end."""
SIZE, SPREAD, DENSITY = 80e-9, 0.2, 2e13
"""Mean diameter [m], its relative standard deviation, particles per area of contact [1/m²]."""


def surfaces(roughness: float = 1.0) -> dict[str, Stack | MajumdarBhushan]:
    """Steel on steel, bare, as stacked sinusoids and as a fractal (chosen here).

    ``roughness`` multiplies the amplitudes of the one and G of the other.
    """
    pair = tb.MaterialPair(tb.materials["S45C"], tb.materials["S45C"])
    return {
        "stack": Stack.self_affine(
            hurst=0.8,
            amplitude=100e-9 * roughness,
            frequency=1e3,
            ratio=2,
            count=8,
            E_star=pair.E_star,
            H=pair.H,
        ),
        "fractal": MajumdarBhushan(
            D=1.4, G=1e-14 * roughness, E_star=pair.E_star, H=pair.H, nominal_area=1e-6
        ),
    }


def model(
    surface: str,
    size: float = SIZE,
    size_effect: bool = False,
    *,
    spread: float = SPREAD,
    density: float = DENSITY,
    stiffness: float = 1.0,
    roughness: float = 1.0,
) -> GhaedniaMultiscale:
    """Silica particles on steel.

    Parameters
    ----------
    surface : {"stack", "fractal"}
        One of `surfaces`.
    size : float, optional
        Mean diameter x_a [m].
    size_effect : bool, optional
        Yield that depends on the depth: `NixGao` with h* = 300 nm.
    spread : float, optional
        Standard deviation of the sizes over their mean [1].
    density : float, optional
        Particles per area of bare contact [1/m²].
    stiffness : float, optional
        Modulus and hardness of the particles over those of silica [1].
    roughness : float, optional
        As in `surfaces` [1].

    Returns
    -------
    GhaedniaMultiscale

    Examples
    --------
    >>> state = model("fractal").solve(1e7)
    >>> round(float(state.A_real / state.A_0), 3)
    0.01
    """
    steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    return GhaedniaMultiscale(
        surface=surfaces(roughness)[surface],
        surfaces=tb.MaterialPair(steel, steel),
        particles=tb.Particles(
            material=silica.replace(E=silica.E * stiffness, H=silica.H * stiffness),
            diameter=tb.TruncatedGaussian(mean=size, std=spread * size),
            areal_density=density,
        ),
        size_effect=NixGao(h_star=300e-9) if size_effect else None,
    )


def reading(name: str, title: str, surface: str) -> Reading:
    """The model on one of the surfaces."""

    def solve(pressures: Array, factors: Mapping[str, float]) -> Trend:
        given = dict(factors)
        state = model(
            name,
            SIZE * given.pop("size", 1.0),
            bool(given.pop("size_effect", 0.0)),
            spread=SPREAD * given.pop("spread", 1.0),
            density=DENSITY * given.pop("density", 1.0),
            **given,
        ).solve(pressures)
        return Trend(pressures, state.A_real, state.A_0, state.particle_load_share)

    return Reading(
        name,
        title,
        PRESSURES,
        solve,
        ("size", "spread", "density", "stiffness", "roughness", "size_effect"),
        {
            "surface": surface,
            "bodies": "S45C on S45C, E = 205 GPa, ν = 0.29, H = 5 GPa",
            "particles": "SiO₂, mean 80 nm, standard deviation 16 nm, "
            "2·10¹³ per m² of bare contact",
            "one particle": "smooth ZMC (hermite) on both sides, in series; constant hardness "
            "unless stated",
            "pressures": "10⁵ to 3·10⁷ Pa, 26 values",
        },
    )


READINGS = {
    "stack": reading("stack", "stacked sinusoids", "8 sinusoids"),
    "fractal": reading("fractal", "fractal (Majumdar–Bhushan)", "fractal, D = 1.4"),
}


# ------------------------------------------------------------------ measures of this study
def pressure_over_hardness(reading: Reading) -> Measurement:
    """Smallest mean pressure under the particles over the hardness of the steel."""
    trend = reading.trend()
    loaded = trend.pressure * trend.load_share / trend.area
    return Measurement.of((loaded / tb.materials["S45C"].H).min())


def closing_pressure(reading: Reading, **factors: float) -> Measurement:
    """Nominal pressure [Pa] at which the patches between the particles touch; A/A_bare above."""
    low, high = 1e5, 1e10
    if reading.trend(low, **factors).load_share[0] < 1:
        ratio = reading.trend(low, **factors).ratio[0]
        return Measurement.of(low, ratio, note="closed at the lowest pressure already")
    if reading.trend(high, **factors).load_share[0] == 1:
        return Measurement.absent(f"open up to {high:g} Pa")
    while high / low > 1 + 1e-10:
        middle = (low * high) ** 0.5
        if reading.trend(middle, **factors).load_share[0] < 1:
            high = middle
        else:
            low = middle
    return Measurement.of(high, reading.trend(high * (1 + 1e-9), **factors).ratio[0])


# ------------------------------------------------------------------ what is stated
JOT = "abstract, doi:10.1115/1.4024297"
IJTC = "abstract of a talk, Int. Joint Tribology Conf. 2011"
STLE = "abstract of a talk, STLE 2012"
HORNG = "Horng et al. 2022, introduction"

CLAIMS = (
    claim(
        "area",
        "Particles lower the real area of contact",
        SEEN,
        JOT,
        "smallest and largest A/A_bare at equal load",
        "area_ratios",
        {"kind": "below", "value": 1.0},
    ),
    claim(
        "linear",
        "The real area grows in proportion to the load",
        REPORTED,
        HORNG,
        "smallest and largest n in A ∝ p^n",
        "area_exponents",
        {"kind": "range", "value": [0.95, 1.05]},
        "In none of the abstracts",
    ),
    claim(
        "size",
        "Particle size matters much",
        SEEN,
        JOT,
        "factor on A from 80 nm to 160 nm, at 1 MPa, yield depending on depth",
        "area_change_either_way",
        {"kind": "at_least", "value": 1.1},
        "The direction is not stated",
        of="size",
        by=2.0,
        pressure=1e6,
        size_effect=1.0,
    ),
    claim(
        "size-constant",
        "The same with a hardness that does not depend on depth",
        OWN,
        "this reconstruction",
        "A at 160 nm over A at 80 nm, at 1 MPa",
        "area_change",
        {},
        of="size",
        by=2.0,
        pressure=1e6,
    ),
    claim(
        "distribution",
        "The distribution of particle sizes matters much",
        SEEN,
        JOT,
        "factor on A with half the standard deviation, at 1 MPa, yield depending on depth",
        "area_change_either_way",
        {"kind": "at_least", "value": 1.1},
        "The direction is not stated",
        of="spread",
        by=0.5,
        pressure=1e6,
        size_effect=1.0,
    ),
    claim(
        "both-carry",
        "Asperities and particles both carry load",
        SEEN,
        IJTC,
        "particles' share of the load at 400 MPa, 40 nm",
        "load_share",
        {"kind": "range", "value": [0.01, 0.99]},
        "Below, the particles carry all of it",
        pressure=4e8,
        size=0.5,
    ),
    claim(
        "scratch",
        "Particles can scratch the surfaces",
        SEEN,
        JOT,
        "smallest mean pressure under particles over H of the steel",
        "pressure_over_hardness",
        {"kind": "at_least", "value": 0.4},
        "0.4 H is where the steel begins to yield; sliding itself is not in the model",
    ),
    claim(
        "friction",
        "Particles lower the friction force",
        SEEN,
        f"{JOT}; {HORNG}",
        "friction force over that without particles",
        "not_in_the_model",
        {},
        why="needs the shear strengths of both kinds of contact; equal ones would repeat “area”",
    ),
    claim(
        "wear",
        "Wear follows the peak pressure between particle and surface",
        SEEN,
        STLE,
        "wear",
        "not_in_the_model",
        {},
        why="no wear in the reconstruction",
    ),
    claim(
        "density",
        "Effect of the concentration",
        NO_SOURCE,
        f"studied according to the {IJTC}; no direction given",
        "A at a quarter of the density over A, at 1 MPa",
        "area_change",
        {},
        of="density",
        by=0.25,
        pressure=1e6,
    ),
    claim(
        "roughness",
        "Effect of the roughness",
        NO_SOURCE,
        f"studied according to the {IJTC}; no direction given",
        "A at twice the amplitude or G over A, at 1 MPa",
        "area_change",
        {},
        of="roughness",
        by=2.0,
        pressure=1e6,
    ),
    claim(
        "stiffness",
        "Effect of the stiffness of the particles",
        NO_SOURCE,
        "no text found",
        "A with modulus and hardness doubled over A, at 1 MPa",
        "area_change",
        {},
        of="stiffness",
        by=2.0,
        pressure=1e6,
    ),
    claim(
        "hardness",
        "Effect of a yield strength that depends on scale",
        NO_SOURCE,
        f"an ingredient according to the {IJTC}; no effect given",
        "A with H growing at small depth over A, at 1 MPa",
        "area_change",
        {},
        of="size_effect",
        by=1.0,
        pressure=1e6,
    ),
    claim(
        "end",
        "The area is lowered no more once the patches between the particles touch",
        OWN,
        "this reconstruction",
        "pressure [Pa], and A/A_bare just above it",
        "closing_pressure",
        {},
        "The area jumps there, so it is not proportional to the load either",
    ),
    claim(
        "end-sparse",
        "The same with a hundredth of the particles",
        OWN,
        "this reconstruction",
        "pressure [Pa], and A/A_bare just above it",
        "closing_pressure",
        {},
        density=0.01,
    ),
    claim(
        "soft",
        "Particles that are soft enough lower the area no more",
        OWN,
        "this reconstruction",
        "modulus and hardness over those of silica at which A = A_bare, at 1 MPa",
        "factor_without_loss",
        {},
        of="stiffness",
        pressure=1e6,
        low=1e-4,
        high=1.0,
    ),
    claim(
        "bare",
        "Without particles the area need not be proportional to the load",
        OWN,
        "this reconstruction",
        "smallest and largest n in A_bare ∝ p^n",
        "bare_exponents",
        {},
    ),
)

STUDY = Study(
    "ghaednia2013",
    "What can be reproduced of Ghaednia and Jackson 2013",
    "Ghaednia, Jackson 2013, J. Tribol. 135, 041603, doi:10.1115/1.4024297",
    (
        "Read: the abstract of the paper, the abstracts of two talks of the authors about the same "
        "model, and what Horng et al. 2022 report of it. Not obtained: the paper with its "
        "equations, parameters and curves.",
        "Theirs: two submodels, one for the rough contact and one for particles between smooth "
        "flats; the real area of the one is the nominal area of the other; Gaussian sizes; an "
        "elastoplastic particle; a yield strength that depends on scale. Reconstructed: every "
        "equation, the hardness law, and all numbers, which are listed under Readings.",
        "Why the area is proportional to the load here: the particles work on the bare contact, "
        "whose own pressure hardly changes with load, and they are nearly plastic, so that "
        "A ≈ p/H whatever the surface.",
    ),
    READINGS,
    CLAIMS,
    MEASURES | {one.__name__: one for one in (pressure_over_hardness, closing_pressure)},
    (
        lambda: area_panel(READINGS, "1"),
        lambda: ratio_panel(READINGS, "2", TO_THE_END),
        lambda: exponent_panel(READINGS, "3", ylim=(0.95, 1.05)),
        lambda: changes_panel(
            READINGS["fractal"],
            "4",
            "size_effect",
            {0.0: "constant hardness", 1.0: "$H$ grows at small depth\n(Nix–Gao, $h^*$ = 300 nm)"},
            "real area with and without a hardness that depends on depth",
        ),
    ),
)

reproduce = STUDY.reproduce
