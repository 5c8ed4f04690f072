"""A particle as a bump of the map: what it carries when it is resolved, as a law.

The runs that are stored of old took particles for bumps x − 2r²/x, r < x/2, on a half-space capped
at the hardness. Pressed alone on a fine grid, such a bump says what share of a difference from
those runs is that of the law of the library.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ...errors import NoEquilibrium
from ...explicit.half_space import lattice_constant
from ...explicit.press import contact_share, press
from ...laws.base import OneParticle, Squeezed
from ...laws.particle.series import Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...populations.materials import Material, MaterialPair

    Array = NDArray[np.float64]

__all__ = ["BumpLaw", "table"]

POINTS, RADIUS = 256, 24
"""Points along each side of the map, and to the radius of the contact."""
LOADS = 28
LEAST, FULL = 1e-5, math.pi / 4
"""Loads over Hx² between which a bump is pressed; at the second it is embedded."""


@lru_cache(maxsize=4)
def table(E_over_H: float) -> tuple[Array, Array, Array]:
    """δ/x, load over Hx² and contact area over x² of one bump on a wide flat.

    Parameters
    ----------
    E_over_H : float
        Contact modulus of the two bodies over the hardness [1].

    Raises
    ------
    NoEquilibrium
        A load that is not solved: no law is made of it.
    """
    loads = np.concatenate([np.geomspace(LEAST, 0.5, LOADS), [0.6, 0.68, 0.74]])
    eps, areas = np.empty(len(loads)), np.empty(len(loads))
    for i, load in enumerate(loads.tolist()):
        hertz = (3 * load / (16 * E_over_H)) ** (1 / 3)
        spacing = max(hertz, math.sqrt(load / math.pi)) / RADIUS
        at = (np.arange(POINTS) - POINTS / 2) * spacing
        r2 = at[:, None] ** 2 + at**2
        z = np.where(r2 < 0.25, 1 - 2 * r2, 0.0)
        mean = float(z.mean())
        hardness = np.ones_like(z)
        solution = press(
            z - mean, spacing, E_over_H, c=hardness, load=load, tol=1e-7,
            max_iterations=1000,
        )  # fmt: skip
        if not solution.converged:
            raise NoEquilibrium(
                f"the load {load:.3g} H x² on one bump at E*/H = {E_over_H:.3g} is not solved: its "
                f"certificate is {solution.certificate:.1g} after {solution.iterations} iterations"
            )
        side = POINTS * spacing
        images = lattice_constant((side, side)) * load / (math.pi * E_over_H)
        eps[i] = 1 - (solution.h + mean) + images
        areas[i] = float(np.sum(contact_share(solution.p, hardness, 1.0))) * spacing**2
    return eps, loads, np.minimum(areas, FULL)


@dataclass(frozen=True)
class _Bump(OneParticle):
    """One bump; its squeeze is shared by two equal sides."""

    E_star: float
    H: float

    @property
    def kinks(self) -> Array:  # type: ignore[override]
        eps = table(self.E_star / self.H)[0]
        return np.array([eps[0], self._last()])

    onset = (1.5, 1.0)

    @property
    def yields(self) -> tuple[float, float]:  # type: ignore[override]
        return (1e-3, 1e-3)

    @property
    def hardness(self) -> tuple[float, float]:  # type: ignore[override]
        return (self.H, self.H)

    def _last(self) -> float:
        """Squeeze at which the straight end of the table reaches the embedded load."""
        eps, loads, _ = table(self.E_star / self.H)
        slope = (loads[-1] - loads[-2]) / (eps[-1] - eps[-2])
        return float(eps[-1] + (FULL - loads[-1]) / slope)

    def at(self, eps: Array) -> Squeezed:
        from scipy.interpolate import PchipInterpolator

        squeezes, loads, areas = table(self.E_star / self.H)
        log = np.log(np.append(squeezes, self._last()))
        x = np.log(np.clip(eps, 1e-300, math.exp(log[-1])))
        load, area = (
            np.exp(PchipInterpolator(log, np.log(np.append(of, FULL)))(np.maximum(x, log[0])))
            for of in (loads, areas)
        )
        below = np.minimum(np.exp(x - log[0]), 1.0)
        return Squeezed(
            self.H * load * below**1.5, (eps / 2, eps / 2), (area * below, area * below)
        )

    def regime(self, side: int, depth: Array) -> NDArray[np.intp]:
        return np.full(len(depth), 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class BumpLaw(Series):
    """The consistent model with particles that are bumps of the map, for equal hardness."""

    def one(self, *, surfaces: MaterialPair, particle: Material) -> OneParticle:
        return _Bump(surfaces.E_star, surfaces.H)
