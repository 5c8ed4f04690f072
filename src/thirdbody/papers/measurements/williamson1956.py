"""Dust between two solids: how often they touch."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb
from thirdbody.laws.particle.series import Deep
from thirdbody.systems.contact_probability import ContactProbability

from ..panels import Line, Panel
from .row import Band, row_of

__all__ = ["ROW", "closing", "share"]

Array = NDArray[np.float64]

SIZE = 10e-6
NUMBERS = (0.25, 1.0, 3.0)
SPREADS = (1.0, 1.2)
STEEL = tb.materials["S45C"]
PAIR = tb.MaterialPair(STEEL, STEEL)
LOADS = np.geomspace(0.1, 8, 121)
"""Loads over that of a fully embedded particle."""
LEVELS = (1e-6, 1e-5, 1e-4)
"""F*."""
OTHERS: tuple[tuple[Deep, str], ...] = (("off", "zmc"), ("table", "field"))
"""Laws beside those that are the default: of particles, and of asperities."""


def closing(number: float, spread: float = 1.0, deep: Deep = "table") -> ContactProbability:
    """Dust of which so many particles are in the way on average.

    Parameters
    ----------
    number : float
        N [1].
    spread : float, optional
        Geometric standard deviation of the diameters [1]; their mean is 10 µm.
    deep : {"table", "off"}, optional
        Of the law of the particles.

    Examples
    --------
    >>> round(closing(1.0).in_the_way, 6)
    1.0
    """
    sizes = (
        tb.distributions.Monodisperse(mean=SIZE)
        if spread == 1
        else tb.LogNormal(median=SIZE * float(np.exp(-0.5 * np.log(spread) ** 2)), gsd=spread)
    )
    radius = 5e-3
    return ContactProbability(
        radius=radius,
        surfaces=PAIR,
        law=tb.particle.Series(deep=deep),
        particles=tb.Particles(
            material=tb.materials["Al2O3"],
            diameter=sizes,
            areal_density=number / (2 * np.pi * radius * sizes.moment(1)),
        ),
    )


@cache
def _curve(number: float, spread: float, deep: Deep = "table") -> Array:
    dust = closing(number, spread, deep)
    out: Array = dust.probability(LOADS * dust.threshold)
    return out


def _sharpest() -> Band:
    """Area W/H over πx²/4 where the probability changes most with ln W."""
    off = Band.from_values(_sharpest_areas("off"))
    return Band.from_values(
        _sharpest_areas("table"),
        'N of 0.25 to 3, equal sizes to a geometric deviation of 1.2; deep = "off": ' + off.text,
    )


def _sharpest_areas(deep: Deep) -> list[float]:
    areas = []
    for spread in SPREADS:
        for number in NUMBERS:
            steps = np.diff(_curve(number, spread, deep))
            most = int(np.argmax(steps))
            dust = closing(number, spread, deep)
            load = float(np.sqrt(LOADS[most] * LOADS[most + 1])) * dust.threshold
            areas.append(load / STEEL.H / (np.pi * SIZE**2 / 4))
    return areas


def share(level: float, ratio: Array, laws: tuple[Deep, str] = ("table", "zmc")) -> Array:
    """Share of the load on hard particles at F* = ``level`` over x/σ.

    ``laws``: ``deep`` of the particles, and the law of the asperities.

    Examples
    --------
    >>> bool(share(1e-5, np.array([2.0])) > 0.5)
    True
    """
    sigma = 0.3e-6
    contact = tb.Contact(
        asperity_law=tb.asperity.Field() if laws[1] == "field" else tb.asperity.ZMC(),
        particle_law=tb.particle.Series(deep=laws[0]),
        surfaces=PAIR,
        roughness=tb.Roughness(sigma=sigma, R=3e-6, alpha=5.0, eta_R_sigma=0.045),
        particles=tb.Particles(
            material=tb.materials["Al2O3"],
            diameter=tb.distributions.Monodisperse(mean=sigma),
            areal_density=1e11,
        ),
    )
    states = tb.equilibria.solve_states(
        contact, F_star=level, vary={"particles.diameter.mean": sigma * ratio}
    )
    return np.asarray(states.particle_load_share, dtype=float)


def _roughness() -> Band:
    """σ/x at which the particles' share falls most with ln σ."""
    others = [
        f'deep = "{laws[0]}" with {laws[1]}: {Band.from_values(_steepest(laws)).text}'
        for laws in OTHERS
    ]
    return Band.from_values(_steepest(("table", "zmc")), "; ".join(["F* of 1e-6 to 1e-4", *others]))


def _steepest(laws: tuple[Deep, str]) -> list[float]:
    ratio = np.geomspace(0.3, 6.0, 61)
    ratios = []
    for level in LEVELS:
        fall = np.diff(share(level, ratio, laws))
        most = int(np.argmax(fall))
        ratios.append(1 / float(np.sqrt(ratio[most] * ratio[most + 1])))
    return ratios


def _panel() -> Panel:
    lines = [
        Line(f"$N$ = {number:g}, {words}", LOADS, _curve(number, spread), colour=i, dash=j)
        for i, number in enumerate(NUMBERS)
        for j, (spread, words) in enumerate(((1.0, "one size"), (1.2, "spread 1.2")))
    ]
    return Panel(
        "dust",
        "probability that two solids touch through dust",
        "area $W/H$ of the solids over the cross-section of a particle",
        "probability of contact $P$",
        ("W_over_f_max", "P"),
        tuple(lines),
        ylim=(0.0, 1.02),
        note="Over the load that embeds a particle of mean size; N particles in the way.",
    )


ROW = row_of(
    "williamson1956",
    {
        "threshold": _sharpest,
        "roughness": _roughness,
        "manner": lambda: Band.from_values(
            [-np.log(closing(N).probability(0.0)) / N for N in NUMBERS]
        ),
    },
    panels=(_panel,),
)
