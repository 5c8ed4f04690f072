"""Ball cratering: wear over the amount of abrasive, rolling and grooving."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ...quantities.say import number
from ..panels import Line, Panel
from .row import Band, row_of

__all__ = ["ROW", "turning", "wear_columns"]

Array = NDArray[np.float64]

DENSITIES = np.geomspace(1e8, 1e12, 25)
"""Particles per area [1/m²]."""
PRESSURES = (1e6, 1e7)
"""Nominal pressure [Pa]."""
COEFFICIENTS = ((0.1, 0.001, 1e-5), (0.5, 0.01, 0.0), (0.2, 0.001, 1e-3))
"""f_ab, f_roll, K_ss [1]."""


@cache
def wear_columns(pressure: float, coefficients: tuple[float, float, float]) -> dict[str, Array]:
    """Wear, rolling share and load share of the particles over `DENSITIES`.

    Parameters
    ----------
    pressure : float
        Nominal pressure [Pa].
    coefficients : tuple of float
        f_ab, f_roll, K_ss [1].

    Examples
    --------
    >>> found = wear_columns(1e6, (0.1, 0.001, 1e-5))
    >>> bool(found["wear"].max() > 1.5 * found["wear"][-1])
    True
    """
    parts = _wear_parts(pressure)
    f_ab, f_roll, K_ss = coefficients
    wear = K_ss * parts["wear_ss"] + f_ab * parts["wear_groove"] + f_roll * parts["wear_roll"]
    return {"wear": wear, "rolling": parts["rolling_share"], "share": parts["share"]}


@cache
def _wear_parts(pressure: float) -> dict[str, Array]:
    """Wear by asperities, grooves and tracks, each over its coefficient, and both shares."""
    steel = tb.materials["S45C"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel.replace(H=2.5e9)),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials["SiC"],
            areal_density=float(DENSITIES[0]),
            diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9),
        ),
        outputs=(
            tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
            tb.outputs.Wear(K_ss=1.0, K_sa=0.0, f_ab=1.0, f_roll=1.0, renewal=100.0),
        ),
    )
    # one layout of the particles for all states
    states = tb.equilibria.solve_states(
        contact, pressure=pressure, vary={"particles.areal_density": DENSITIES}
    )
    names = ("wear_ss", "wear_groove", "wear_roll", "rolling_share")
    columns = {name: np.asarray(states[name], dtype=float) for name in names}
    return columns | {"share": np.asarray(states["particle_load_share"], dtype=float)}


def _all_columns() -> list[dict[str, Array]]:
    return [wear_columns(p, coefficients) for p in PRESSURES for coefficients in COEFFICIENTS]


def _maximum() -> Band:
    """Largest wear over that at the nearer end of the densities."""
    peaks = [
        max(columns["wear"]) / max(columns["wear"][0], columns["wear"][-1])
        for columns in _all_columns()
    ]
    place = [DENSITIES[int(np.argmax(columns["wear"]))] for columns in _all_columns()]
    share = [columns["share"][int(np.argmax(columns["wear"]))] for columns in _all_columns()]
    return Band.from_values(
        peaks,
        f"at {min(place):.1e} to {max(place):.1e} particles per m², where particles carry "
        f"{min(share):.2f} to {max(share):.2f} of the load",
    )


def _rolling() -> Band:
    """Rolling share at the most particles, less that at the fewest."""
    return Band.from_values(
        [columns["rolling"][-1] - columns["rolling"][0] for columns in _all_columns()]
    )


def turning(pressure: float, coefficients: tuple[float, float, float]) -> tuple[float, float]:
    """Particles per area [1/m²] at which a tenth of them rolls, and their share of the load there.

    Between `DENSITIES` by a monotone cubic.

    Parameters
    ----------
    pressure : float
        Nominal pressure [Pa].
    coefficients : tuple of float
        f_ab, f_roll, K_ss [1].

    Examples
    --------
    >>> particles, share = turning(PRESSURES[0], (0.1, 0.001, 1e-5))
    >>> bool(1e8 < particles < 1e12 and share > 0.5)
    True
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.optimize import brentq

    columns, places = wear_columns(pressure, coefficients), np.log(DENSITIES)
    rolling = PchipInterpolator(places, columns["rolling"])
    first = int(np.argmax(columns["rolling"] > 0.1))
    at = brentq(lambda x: float(rolling(x)) - 0.1, places[first - 1], places[first])
    return float(np.exp(at)), float(PchipInterpolator(places, columns["share"])(at))


def _line() -> Band:
    """Load over density where a tenth rolls: at the highest pressure over the lowest."""
    ratios, particles = [], []
    for coefficients in COEFFICIENTS:
        (one, share), (other, most) = (turning(pressure, coefficients) for pressure in PRESSURES)
        ratios.append(PRESSURES[1] / other / (PRESSURES[0] / one))
        particles.append(ratios[-1] * most / share)
    range_text = Band.from_values(particles).text
    return Band.from_values(
        ratios, f"{range_text} of the load that is on particles; asperities carry the rest"
    )


def _panel() -> Panel:
    lines = [
        Line(
            f"{pressure / 1e6:g} MPa, $f_{{ab}}$ = {coefficients[0]:g}, "
            f"$K_{{ss}}$ = {number(coefficients[2])}",
            DENSITIES,
            wear_columns(pressure, coefficients)["wear"],
            colour=i,
            dash=j,
        )
        for j, pressure in enumerate(PRESSURES)
        for i, coefficients in enumerate(COEFFICIENTS)
    ]
    return Panel(
        "wear",
        "wear over the number of particles",
        "particles per area [1/m²]",
        "worn volume per area and sliding length",
        ("areal_density", "wear"),
        tuple(lines),
        ylog=True,
        note="SiC of 0.5 µm on σ = 0.1 µm; largest where particles take the whole load over.",
    )


ROW = row_of(
    "trezona1999", {"maximum": _maximum, "rolling": _rolling, "line": _line}, panels=(_panel,)
)
