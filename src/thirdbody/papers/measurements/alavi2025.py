"""Strip drawing with wear particles: friction over pressure."""

from __future__ import annotations

import numpy as np

import thirdbody as tb
from thirdbody.laws.particle.series import Deep

from .row import Band, row_of

__all__ = ["ROW", "friction"]

DENSITIES = (0.0, 1e9, 1e10, 1e11)
PRESSURES = (5e6, 100e6)
SHEARED = (30e6, 100e6, 300e6)
"""Shear strength of asperities and of particles [Pa]."""
OTHERS: tuple[tuple[Deep, str], ...] = (("off", "zmc"), ("table", "field"), ("off", "field"))
"""Laws beside those that are the default: of particles, and of asperities."""


def friction(
    density: float, sheared: float = 100e6, laws: tuple[Deep, str] = ("table", "zmc")
) -> tuple[float, float]:
    """Coefficient of friction at both of ``PRESSURES`` with so many particles [1/m²].

    ``laws``: ``deep`` of the particles, and the law of the asperities.

    Examples
    --------
    >>> light, heavy = friction(0.0)
    >>> round(heavy / light, 2)
    1.15
    """
    strip = tb.Material(E=70e9, nu=0.33, H=1.2e9)
    tool = tb.materials["100Cr6"]
    particles = tb.Particles(
        material=tb.materials["Al2O3"],
        areal_density=density or 1.0,
        diameter=tb.TruncatedGaussian(mean=1e-6, std=2e-7),
    )
    deep, name = laws
    contact = tb.Contact(
        asperity_law=tb.asperity.Field() if name == "field" else tb.asperity.ZMC(),
        particle_law=tb.particle.Series(deep=deep),
        surfaces=tb.MaterialPair(tool, strip),
        roughness=tb.Roughness(sigma=0.5e-6, R=10e-6),
        particles=particles if density > 0 else None,
        outputs=(tb.outputs.Friction(tau_ss=sheared, tau_sa=sheared),),
    )
    light, heavy = np.asarray(tb.solve(contact, pressure=np.array(PRESSURES)).outputs["mu"])
    return float(light), float(heavy)


def _change() -> Band:
    ratios = {
        density: [heavy / light for light, heavy in (friction(density, tau) for tau in SHEARED)]
        for density in DENSITIES
    }
    words = ", ".join(
        f"{density:g} per m²: {Band.from_values(one).text}" for density, one in ratios.items()
    )
    others = []
    for laws in OTHERS:
        pairs = [friction(density, tau, laws) for density in DENSITIES for tau in SHEARED]
        one = Band.from_values([heavy / light for light, heavy in pairs])
        others.append(f'deep = "{laws[0]}" with {laws[1]}: {one.text}')
    return Band.from_values(list(ratios.values()), "; ".join([words, *others]))


ROW = row_of("alavi2025", {"falls": _change})
