r"""The periodic elastic half-space on a grid, and what approximates its inverse.

.. math:: \hat K(q) = \frac{2}{E^*|q|}, \qquad \hat K(0) = 0
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numba import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

__all__ = ["HalfSpace", "lattice_constant"]

REACH = 3.5
"""Radius of the stencil [pixels]."""


def lattice_constant(size: tuple[float, float]) -> float:
    """1/r less the potential, near a charge, of a lattice of charges on a neutral plane [1/m].

    The displacement of one force in each period is that of a lone force less this constant times
    f/πE*; the square of side L has 3.900264920/L.
    """
    width, height = size
    area = width * height
    a = math.sqrt(math.pi / area)
    most = np.arange(-12, 13)
    i, j = (indices.ravel() for indices in np.meshgrid(most, most, indexing="ij"))
    is_origin = (i == 0) & (j == 0)
    i, j = i[~is_origin], j[~is_origin]
    from scipy.special import erfc

    r = np.hypot(i * width, j * height)
    q = 2 * math.pi * np.hypot(i / width, j / height)
    total = np.sum(erfc(a * r) / r) + 2 * math.pi / area * np.sum(erfc(q / (2 * a)) / q)
    return float(2 * a / math.sqrt(math.pi) + 2 * math.sqrt(math.pi) / (a * area) - total)


class HalfSpace:
    """Displacements of a grid (n, m) of pressures on pixels of side Δ.

    Parameters
    ----------
    shape : (int, int)
    spacing : float
        Δ [m].
    E_star : float
        Contact modulus [Pa].
    single : bool
        FFTs in float32.
    workers : int
        Threads of the FFT.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        spacing: float,
        E_star: float,
        *,
        single: bool = False,
        workers: int = 1,
    ):
        self.shape, self.spacing, self.E_star = shape, spacing, E_star
        self.kind: type[np.float32] | type[np.float64] = np.float32 if single else np.float64
        self.workers = workers
        n, m = shape
        q = np.hypot(np.fft.fftfreq(n)[:, None], np.fft.rfftfreq(m)) * (2 * math.pi / spacing)
        with np.errstate(divide="ignore"):
            kernel = 2 / (E_star * q)
        kernel[0, 0] = 0.0
        self.kernel = kernel.astype(self.kind)

    def displacement(self, pressure: Array) -> Array:
        """u [m] of a pressure [Pa]; of zero mean."""
        from scipy import fft

        wave = fft.rfft2(pressure.astype(self.kind, copy=False), workers=self.workers)
        wave *= self.kernel
        u = fft.irfft2(wave, s=self.shape, workers=self.workers, overwrite_x=True)
        return u.astype(float, copy=False)

    def energy_of_full_contact(self, z: Array) -> float:
        """zᵀK⁻¹z of heights (n, m) [m], their mean left out [Pa m]: twice the energy over Δ²."""
        wave = np.fft.fft2(z)
        q = np.hypot(*np.meshgrid(*map(np.fft.fftfreq, z.shape), indexing="ij"))
        stiffness = self.E_star * math.pi * q / self.spacing  # E*|q|/2
        return float(np.sum(stiffness * np.abs(wave) ** 2)) / z.size

    def green(self) -> Array:
        """u of unit pressure on one pixel [m/Pa]."""
        one = np.zeros(self.shape)
        one[0, 0] = 1.0
        exact = HalfSpace(self.shape, self.spacing, self.E_star)
        return exact.displacement(one)

    @property
    def lattice(self) -> float:
        """Displacement [m/Pa] that the periodic images of a pixel's pressure subtract."""
        n, m = self.shape
        constant = lattice_constant((n * self.spacing, m * self.spacing))
        return constant * self.spacing**2 / (math.pi * self.E_star)

    def sharpen(self, r: Array, where: Index) -> tuple[Array, Array]:
        """S r and S 1 on the pixels ``where`` (flat indices), r being zero elsewhere [Pa]."""
        y, w = _stencil(r, where, _weights())
        scale = self.E_star / (2 * self.spacing)
        return y * scale, w * scale


@lru_cache(maxsize=1)
def _weights() -> Array:
    """The stencil of |q| on a grid of unit spacing: its wave under a window is positive."""
    q = 2 * math.pi * np.fft.fftfreq(64)
    full = np.fft.ifft2(np.hypot(q[:, None], q)).real
    reach = math.floor(REACH)
    at = np.arange(-reach, reach + 1)
    r = np.hypot(at[:, None], at)
    return np.where(r <= REACH, full[np.ix_(at, at)], 0.0)


@njit(cache=True)
def _stencil(r, where, weights):
    n, m = r.shape
    reach = weights.shape[0] // 2
    active = np.zeros((n, m), np.bool_)
    for k in where:
        active[k // m, k % m] = True
    y, w = np.empty(where.size), np.empty(where.size)
    for count in range(where.size):
        i, j = where[count] // m, where[count] % m
        total, ones = 0.0, 0.0
        for a in range(-reach, reach + 1):
            row = i + a
            row += n if row < 0 else (-n if row >= n else 0)
            for b in range(-reach, reach + 1):
                column = j + b
                column += m if column < 0 else (-m if column >= m else 0)
                if active[row, column]:
                    weight = weights[a + reach, b + reach]
                    total += weight * r[row, column]
                    ones += weight
        y[count] = total
        w[count] = ones
    return y, w
