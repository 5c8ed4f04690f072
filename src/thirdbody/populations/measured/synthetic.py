r"""Surfaces made to order: random phases, and amplitudes that give exact moments.

.. math:: h(\mathbf x) = \sum_{\mathbf q} \sqrt{P(q)}\,\cos(\mathbf q\cdot\mathbf x +
          \varphi_{\mathbf q})

The amplitudes are not random, so that one surface has the moments of its spectrum to rounding,
not only on average over many.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.say import value_of
from .spectra import SpectralMoments
from .topography import Topography

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["from_moments", "self_affine"]


@takes_units
def self_affine(
    *,
    sigma: float,
    hurst: float,
    shortest: float,
    longest: float,
    spacing: float,
    points: int = 256,
    seed: int = 0,
) -> Topography:
    r"""A self-affine surface between two cut-offs, flat spectrum above the longer one.

    .. math:: C(q) \propto \max(q, 2\pi/\lambda_l)^{-2-2H}, \qquad q \le 2\pi/\lambda_s

    Parameters
    ----------
    sigma : float
        RMS height σ [m], exact.
    hurst : float
        Hurst exponent H [1], from 0 to 1.
    shortest : float
        Shortest wave λ_s [m], at least twice the spacing.
    longest : float
        Wave λ_l above which the spectrum is flat [m].
    spacing : float
        Distance of neighbouring points [m].
    points : int
        Points along each side; the surface repeats itself beyond.
    seed : int
        Of the random phases.

    Returns
    -------
    Topography
        Periodic, without further cut-off; ``moments_at(0, method="spectrum")`` is exact.

    Raises
    ------
    InvalidValue
        Lengths in the wrong order, or a Hurst exponent out of range.

    Examples
    --------
    >>> import thirdbody as tb
    >>> rough = tb.surfaces.self_affine(
    ...     sigma=1e-7, hurst=0.8, shortest=8e-7, longest=6e-6, spacing=1e-7
    ... )
    >>> round(rough.rms_height * 1e9, 9)
    100.0
    """
    _check_arguments(points, seed, spacing=spacing, sigma=sigma, shortest=shortest, longest=longest)
    problems = []
    if not 0 <= hurst <= 1:
        problems.append(Problem("", f"hurst = {hurst!r} must be from 0 to 1", code=Mistake.RANGE))
    if not 2 * spacing < shortest <= longest <= points * spacing:
        problems.append(
            Problem(
                "",
                f"shortest = {shortest:g} and longest = {longest:g} must be in order between two "
                f"spacings, {2 * spacing:g}, and the side, {points * spacing:g} [m]",
                code=Mistake.RANGE,
            )
        )
    if problems:
        raise InvalidValue(*problems)
    q = _wavenumbers(points, spacing)
    with np.errstate(divide="ignore"):
        density = np.maximum(q, 2 * math.pi / longest) ** (-2 - 2 * hurst)
    density = np.where((q > 0) & (q <= 2 * math.pi / shortest * (1 + 1e-12)), density, 0.0)
    return _with_phases(density, sigma, spacing, points, seed)


@takes_units
def from_moments(
    moments: SpectralMoments,
    *,
    spacing: float,
    points: int = 256,
    hurst: float = 0.8,
    seed: int = 0,
) -> Topography:
    r"""A surface with given m0, m2 and m4, exact in its spectrum.

    .. math:: C(q) \propto \left[1 + (q/q_r)^2\right]^{-1-H}, \qquad q \le q_s

    q_s and q_r are sought so that m2/m0 and α are met; the last ring of waves counts in part.

    Parameters
    ----------
    moments : SpectralMoments
        What the surface shall have; α from 2 on, as far as its waves fit the grid.
    spacing : float
        Distance of neighbouring points [m].
    points : int
        Points along each side; the surface repeats itself beyond.
    hurst : float
        Hurst exponent H of the spectrum above q_r, from 0 to 1.
    seed : int
        Of the random phases.

    Returns
    -------
    Topography
        Periodic, without further cut-off; ``moments_at(0, method="spectrum")`` is exact to 1e-9.

    Raises
    ------
    InvalidValue
        Moments that no such spectrum on this grid has.

    Examples
    --------
    >>> import thirdbody as tb
    >>> asked = tb.surfaces.SpectralMoments(m0=1e-14, m2=3.3e-3, m4=5.5e9)
    >>> found = tb.surfaces.from_moments(asked, spacing=1.5e-7).moments_at(0, method="spectrum")
    >>> round(found.m4 / asked.m4, 9), round(found.alpha / asked.alpha, 9)
    (1.0, 1.0)
    """
    _check_arguments(points, seed, spacing=spacing)
    if not 0 <= hurst <= 1:
        raise InvalidValue(f"hurst = {hurst!r} must be from 0 to 1", code=Mistake.RANGE)
    shape = _RolledOff(points, spacing, hurst)
    parameters = _matching(shape, 2 * moments.m2 / moments.m0, moments.alpha)
    if parameters is None:
        raise InvalidValue(
            f"no spectrum on {points} x {points} points {value_of(spacing, 'm')} apart has α = "
            f"{moments.alpha:.4g} and an RMS gradient of {moments.rms_gradient:.4g} with σ = "
            f"{value_of(moments.sigma, 'm')}; α must be above 2, and a larger α takes more points "
            "or another spacing",
            code=Mistake.BEYOND,
        )
    grid = _wavenumbers(points, spacing)
    spectrum = np.where(grid > 0, shape.density(grid, *parameters), 0.0)
    return _with_phases(spectrum, moments.sigma, spacing, points, seed)


class _RolledOff:
    """Spectra on a grid that roll off at ``ratio`` q_s and end at q_s, sharp to one wave."""

    def __init__(self, points: int, spacing: float, hurst: float):
        self.hurst = hurst
        self.step, self.highest = 2 * math.pi / (points * spacing), math.pi / spacing
        grid = _wavenumbers(points, spacing)
        q2, count = np.unique(
            np.round((grid * points * spacing / (2 * math.pi)) ** 2), return_counts=True
        )
        self.q2, self.count = q2[1:] * (2 * math.pi / (points * spacing)) ** 2, count[1:]
        self.q = np.sqrt(self.q2)

    def density(self, q: Array, q_s: float, ratio: float) -> Array:
        """Up to a factor."""
        edge = np.clip((q_s - q) / self.step + 0.5, 0.0, 1.0)
        return edge * (1 + (q / (ratio * q_s)) ** 2) ** (-1 - self.hurst)

    def moments(self, q_s: float, ratio: float) -> tuple[float, float]:
        """⟨q²⟩ and ⟨q⁴⟩/⟨q²⟩²."""
        power = self.count * self.density(self.q, q_s, ratio)
        m0, m2, m4 = power.sum(), power @ self.q2, power @ self.q2**2
        return m2 / m0, m4 * m0 / m2**2


def _matching(shape: _RolledOff, wanted: float, alpha: float) -> tuple[float, float] | None:
    """q_s and ratio of the spectrum with this ⟨q²⟩ [1/m²] and bandwidth α, if there is one."""
    from scipy.optimize import brentq

    step, lowest, top = shape.step, 2 * shape.step, shape.highest - 0.5 * shape.step

    def shortest(ratio: float) -> float:
        def miss(q_s: float) -> float:
            return shape.moments(q_s, ratio)[0] - wanted

        low, high = miss(lowest), miss(top)
        if not low < 0 < high:
            return lowest if low >= 0 else top
        return float(brentq(miss, lowest, top, xtol=1e-9 * step))

    def miss(log_ratio: float) -> float:
        ratio = math.exp(log_ratio)
        return shape.moments(shortest(ratio), ratio)[1] * 1.5 - alpha

    ends = [math.log(1e-3), math.log(1e3)]
    low, high = map(miss, ends)
    if not low > 0 > high:
        return None
    ratio = math.exp(float(brentq(miss, *ends, xtol=1e-13, rtol=1e-13)))
    q_s = shortest(ratio)
    mean, bandwidth = shape.moments(q_s, ratio)
    close = math.isclose(mean, wanted, rel_tol=1e-8)
    if not (close and math.isclose(bandwidth * 1.5, alpha, rel_tol=1e-8)):
        return None
    return q_s, ratio


def _check_arguments(points: int, seed: int, **lengths: float) -> None:
    problems = [
        Problem(name, "must be a finite length above 0 [m]", repr(value), code=Mistake.RANGE)
        for name, value in lengths.items()
        if not (isinstance(value, (int, float)) and 0 < value < math.inf)
    ]
    if not (isinstance(points, int) and 16 <= points <= 4096):
        problems.append(
            Problem(
                "", f"points = {points!r} must be a whole number from 16 to 4096", code=Mistake.KIND
            )
        )
    if not (isinstance(seed, int) and seed >= 0):
        problems.append(
            Problem("", f"seed = {seed!r} must be a whole number, at least 0", code=Mistake.KIND)
        )
    if problems:
        raise InvalidValue(*problems)


def _wavenumbers(points: int, spacing: float) -> Array:
    """|q| of every wave on the grid [1/m]."""
    q = 2 * math.pi * np.fft.fftfreq(points, spacing)
    return np.hypot(q[:, None], q)


def _with_phases(
    density: Array, sigma: float, spacing: float, points: int, seed: int
) -> Topography:
    """Heights with these amplitudes and random phases, those of a real field."""
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((points, points)))
    amplitude = np.sqrt(density * (sigma**2 / density.sum()))
    heights = np.fft.ifft2(noise / np.abs(noise) * amplitude * points**2).real
    return Topography(
        heights=np.ascontiguousarray(heights),
        spacing=(spacing, spacing),
        source="the synthetic surface",
        periodic=True,
        given_cutoff=0.0,
        limit_reason="none: the surface is synthetic",
    )
