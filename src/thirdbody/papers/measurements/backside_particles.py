"""A wafer held on a flat chuck over a particle."""

from __future__ import annotations

import thirdbody as tb
from thirdbody.laws.particle.series import Deep
from thirdbody.systems.plate_over_particle import PlateOverParticle

from .row import Band, row_of

__all__ = ["ROW", "chuck"]

THICKNESSES, PRESSURES = (675e-6, 725e-6, 775e-6), (0.5e5, 0.8e5, 1e5)
SIZES = (1e-6, 5e-6, 10e-6, 20e-6)
PARTICLES = ("SiO2", "Al2O3")


def chuck(
    thickness: float = 725e-6, pressure: float = 1e5, deep: Deep = "table"
) -> PlateOverParticle:
    """A silicon wafer of this thickness [m] under this pressure [Pa] on steel.

    ``deep`` is that of the particles' law.

    Examples
    --------
    >>> round(chuck().rigidity, 2)
    5.34
    """
    return PlateOverParticle(
        plate=tb.Material(E=160e9, nu=0.22, H=12e9),
        flat=tb.materials["S45C"],
        thickness=thickness,
        pressure=pressure,
        law=tb.particle.Series(deep=deep),
    )


def _width() -> Band:
    return Band.from_values(
        [2 * chuck(t, p).bump(100e-9).radius for t in THICKNESSES for p in PRESSURES]
    )


def _height() -> Band:
    off = Band.from_values(_heights("off"))
    return Band.from_values(_heights("table"), f'particles of 1 to 20 µm; deep = "off": {off.text}')


def _heights(deep: Deep) -> list[float]:
    return [
        chuck(t, p, deep).over(x, tb.materials[name]).height / x
        for t in THICKNESSES
        for p in PRESSURES
        for x in SIZES
        for name in PARTICLES
    ]


ROW = row_of("backside_particles", {"width": _width, "height": _height})
