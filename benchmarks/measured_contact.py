"""The contact that the benchmarks share, its loads and its inputs."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parent))
import naive

import thirdbody as tb

Array = NDArray[np.float64]
LOW, HIGH = 1e-8, 3e-4
"""Loads F* [1]: from particles alone to a real area of 3 %."""


def contact(seat: str, x_a: float = naive.X_A) -> tb.Contact:
    """The contact of `naive`; without particles for the seat "two-body"."""
    steel = tb.Material(E=naive.E, nu=naive.NU, H=naive.H)
    silica = tb.Material(E=naive.E_A, nu=naive.NU_A, H=7.7e9)
    sizes = tb.TruncatedGaussian(mean=x_a, std=x_a * naive.S_A / naive.X_A, n=naive.CUT)
    bare = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=naive.SIGMA, R=naive.R),
    )
    if seat == "two-body":
        return bare
    return bare.replace(
        particles=tb.Particles(material=silica, diameter=sizes, areal_density=naive.ETA_A),
        particle_law=tb.particle.Series(deep="off", seat=seat),
    )


def loads(count: int) -> Array:
    """F* in random order."""
    return np.random.default_rng(1).permutation(np.geomspace(LOW, HIGH, count))


def inputs(seat: str, count: int) -> dict[str, Array]:
    """σ, R, η_a and x_a of states, each within ±20 %."""
    rng = np.random.default_rng(2)
    sigma, R, density, size = rng.uniform(0.8, 1.2, (4, count))
    vary = {"roughness.sigma": naive.SIGMA * sigma, "roughness.R": naive.R * R}
    if seat != "two-body":
        vary |= {
            "particles.areal_density": naive.ETA_A * density,
            "particles.diameter.mean": naive.X_A * size,
            "particles.diameter.std": naive.S_A * size,
        }
    return vary
