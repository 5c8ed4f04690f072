"""Particles at their places: what one of them does, where it stands on the grid, what it covers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..laws.base import OneParticle

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["NONE", "Bodies", "LawTable", "Placed", "covered_share"]

SHALLOWEST = 1e-7
"""Squeeze over the lowest kink from which a law is tabulated; Hertz below."""
POINTS = 6000
SUBPIXELS = 8
"""Along each side of a pixel, for what particles cover that are not much larger."""


class LawTable:
    """f/x² over δ/x of one kind of particle, and back from the same points: logarithmic, monotone.

    Parameters
    ----------
    one : OneParticle
        The particle of unit size.

    Attributes
    ----------
    limit : float
        f/x² of a particle that is embedded [Pa].
    """

    def __init__(self, one: OneParticle):
        self.one = one
        low, high = SHALLOWEST * float(one.kinks[0]), float(one.kinks[-1])
        eps = np.unique(np.concatenate([np.geomspace(low, high, POINTS), one.panels]))
        unit = one.at(eps)
        load = unit.load
        rises = np.concatenate([[True], load[1:] > np.maximum.accumulate(load)[:-1] * (1 + 1e-12)])
        self._eps, self._load = np.log(eps[rises]), np.log(load[rises])
        self.limit = float(np.exp(self._load[-1]))  # as the table gives it back
        self._area = unit.areas[0][rises]

    def force(self, eps: Array) -> Array:
        """f/x² [Pa] at δ/x; zero below zero, the limit above the deepest."""
        log = np.log(np.maximum(eps, 1e-300))
        first = self._load[0] + 1.5 * (log - self._eps[0])
        load = np.where(log < self._eps[0], first, np.interp(log, self._eps, self._load))
        return np.where(eps > 0, np.minimum(np.exp(load), self.limit), 0.0)

    def area(self, eps: Array) -> Array:
        """Contact area over x² on surface 1 [1] at δ/x; good for sums over many."""
        log = np.log(np.maximum(eps, 1e-300))
        return np.where(eps > 0, np.interp(log, self._eps, self._area), 0.0)

    def squeeze(self, load: Array) -> Array:
        """δ/x at which f/x² [Pa] is carried."""
        log = np.log(np.maximum(load, 1e-300))
        first = self._eps[0] + (log - self._load[0]) / 1.5
        eps = np.where(log < self._load[0], first, np.interp(log, self._load, self._eps))
        return np.where(load > 0, np.exp(eps), 0.0)

    def stiffness(self, eps: Array) -> Array:
        """Slope of f/x² over δ/x [Pa], between neighbouring points of the table."""
        step = np.maximum(1e-3 * eps, 1e-12)
        return (self.force(eps + step) - self.force(np.maximum(eps - step, 0))) / (
            step + np.minimum(step, eps)
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class Bodies:
    """Particles: positions [m], diameters [m], and which law each follows.

    Parameters
    ----------
    x, y, diameter : array (N,)
    lift : array (N,)
        How far the underside is held above the heights at its place [m].
    kind : array (N,) of int
        Index into ``laws``.
    laws : sequence of LawTable
    """

    x: Array
    y: Array
    diameter: Array
    lift: Array
    kind: Index
    laws: Sequence[LawTable]

    def __len__(self) -> int:
        return len(self.x)

    def _value_of_each(self, name: str, values: Array) -> Array:
        out = np.empty(len(values))
        for i, law in enumerate(self.laws):
            here = self.kind == i
            out[here] = getattr(law, name)(values[here])
        return out

    def force(self, delta: Array) -> Array:
        """f [N] at the squeeze δ [m]."""
        return self.diameter**2 * self._value_of_each("force", delta / self.diameter)

    def squeeze(self, force: Array) -> Array:
        """δ [m] under f [N]."""
        return self.diameter * self._value_of_each("squeeze", force / self.diameter**2)

    def stiffness(self, delta: Array) -> Array:
        """df/dδ [N/m]."""
        return self.diameter * self._value_of_each("stiffness", delta / self.diameter)

    @property
    def limit(self) -> Array:
        """f of each when embedded [N]."""
        limits = np.array([law.limit for law in self.laws])
        return self.diameter**2 * (limits[self.kind] if len(limits) else 0.0)


_NOTHING = np.empty(0)
NONE = Bodies(
    x=_NOTHING, y=_NOTHING, diameter=_NOTHING, lift=_NOTHING, kind=np.empty(0, np.int64), laws=()
)
"""No particles."""


class Placed:
    """The four pixels around each particle and their weights: D and its transpose."""

    def __init__(self, bodies: Bodies, shape: tuple[int, int], spacing: float):
        n, m = shape
        a, b = bodies.x / spacing, bodies.y / spacing
        i, j = np.floor(a), np.floor(b)
        s, t = a - i, b - j
        i, j = i.astype(np.int64), j.astype(np.int64)
        rows, columns = np.stack([i, i + 1, i, i + 1]) % n, np.stack([j, j, j + 1, j + 1]) % m
        self.shape, self.pixels = shape, rows * m + columns
        self.weights = np.stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t])

    def at_particles(self, field: Array) -> Array:
        """Dᵀ: a field where the particles are."""
        return np.sum(self.weights * field.ravel()[self.pixels], axis=0)

    def spread(self, values: Array, onto: Array) -> Array:
        """D: the values of the particles added to a field."""
        out = onto.copy()
        np.add.at(out.reshape(-1), self.pixels, self.weights * values)
        return out

    def own_displacement(self, green: Array, lattice: float) -> Array:
        """s: displacement of each by itself, without its periodic images [m/Pa]."""
        out = np.zeros(self.pixels.shape[1])
        n, m = self.shape
        rows, columns = self.pixels // m, self.pixels % m
        for a in range(4):
            for b in range(4):
                apart = green[(rows[a] - rows[b]) % n, (columns[a] - columns[b]) % m]
                out += self.weights[a] * self.weights[b] * apart
        return out + lattice


def covered_share(z: Array, spacing: float, bodies: Bodies, heights: Array) -> Array:
    """Share of each pixel (n, m) that a particle lies over [1].

    A pixel counts by its centre; under particles smaller than two pixels, by finer points.
    """
    out = np.zeros_like(z)
    small = bodies.diameter < 2 * spacing
    for here, fine in ((~small, 1), (small, SUBPIXELS)):
        if np.any(here):
            _cover(out, z, spacing, bodies.x[here], bodies.y[here], bodies.diameter[here],
                   heights[here], fine)  # fmt: skip
    return np.minimum(out, 1.0)


@njit(cache=True)
def _cover(out, z, spacing, xs, ys, sizes, heights, fine):
    n, m = z.shape
    for k in range(xs.size):
        radius = sizes[k] / 2
        reach = math.ceil(radius / spacing) + 1
        i0, j0 = round(xs[k] / spacing), round(ys[k] / spacing)
        for i in range(i0 - reach, i0 + reach + 1):
            for j in range(j0 - reach, j0 + reach + 1):
                height = z[i % n, j % m]
                inside = 0
                for a in range(fine):
                    for b in range(fine):
                        dx = (i + (a + 0.5) / fine - 0.5) * spacing - xs[k]
                        dy = (j + (b + 0.5) / fine - 0.5) * spacing - ys[k]
                        rest = radius * radius - dx * dx - dy * dy
                        if rest > 0 and height < heights[k] + radius + math.sqrt(rest):
                            inside += 1
                out[i % n, j % m] += inside / (fine * fine)
