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
from .ledger import Measurement
from .report import Study
from .trends import (
    Reading,
    Trend,
    area_panel,
    changes_panel,
    exponent_panel,
    ratio_panel,
    readings_of,
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
    >>> from thirdbody.papers.ghaednia2013 import model
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


def solve(surface: str, pressures: Array, factors: Mapping[str, float]) -> Trend:
    """The trend of the model on one of the surfaces."""
    keywords = dict(factors)
    state = model(
        surface,
        SIZE * keywords.pop("size", 1.0),
        bool(keywords.pop("size_effect", 0.0)),
        spread=SPREAD * keywords.pop("spread", 1.0),
        density=DENSITY * keywords.pop("density", 1.0),
        **keywords,
    ).solve(pressures)
    return Trend(pressures, state.A_real, state.A_0, state.particle_load_share)


READINGS = readings_of("ghaednia2013", PRESSURES, solve)


# ------------------------------------------------------------------ measures of this study
def pressure_over_hardness(reading: Reading) -> Measurement:
    """Smallest mean pressure under the particles over the hardness of the steel."""
    trend = reading.trend()
    loaded = trend.pressure * trend.load_share / trend.area
    return Measurement.from_values((loaded / tb.materials["S45C"].H).min())


def closing_pressure(reading: Reading, **factors: float) -> Measurement:
    """Nominal pressure [Pa] at which the patches between the particles touch; A/A_bare above."""
    low, high = 1e5, 1e10
    if reading.trend(low, **factors).load_share[0] < 1:
        ratio = reading.trend(low, **factors).ratio[0]
        return Measurement.from_values(low, ratio, note="closed at the lowest pressure already")
    if reading.trend(high, **factors).load_share[0] == 1:
        return Measurement.absent(f"open up to {high:g} Pa")
    while high / low > 1 + 1e-10:
        middle = (low * high) ** 0.5
        if reading.trend(middle, **factors).load_share[0] < 1:
            high = middle
        else:
            low = middle
    return Measurement.from_values(high, reading.trend(high * (1 + 1e-9), **factors).ratio[0])


STUDY = Study.read_data(
    "ghaednia2013",
    READINGS,
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
    pressure_over_hardness,
    closing_pressure,
)

reproduce = STUDY.reproduce
