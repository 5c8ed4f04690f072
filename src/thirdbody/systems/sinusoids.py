"""Surfaces as sinusoids on top of each other: the real area of two bare bodies by the load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Self

import numpy as np

from ..errors import Mistake, Problem
from ..quantities.carried import takes_units
from ..quantities.say import percent
from ..quantities.value import Value, items_of, quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Convergence", "Sinusoid", "Stack", "jackson_streator"]


@takes_units
def jackson_streator(q: ArrayLike) -> Array:
    r"""Real area fraction of a two-dimensional elastic sinusoid, from q = p/p*.

    .. math:: A_1 = \pi\left(\frac{3q}{8\pi}\right)^{2/3}, \qquad A_2 = 1-\frac{3}{2\pi}(1-q)

    are the limits of small load (Hertz) and near full contact (penny-shaped gaps); between,

    .. math:: A = A_1(1-q^{1.51}) + A_2 q^{1.04} \quad (q<0.8), \qquad A_2 \quad (q \ge 0.8).

    Parameters
    ----------
    q : array_like
        Pressure over the pressure of full contact [1]; 1 and more give full contact.

    Returns
    -------
    array
        Real area fraction A [1].

    Notes
    -----
    Limits derived, the join recalled. At q = 0.8 the join steps down by 0.046 %.

    References
    ----------
    Johnson, Greenwood, Higginson 1985, Int. J. Mech. Sci. 27, 383,
    doi:10.1016/0020-7403(85)90029-3; Jackson, Streator 2006, Wear 261, 1337,
    doi:10.1016/j.wear.2006.03.015 (DOI from memory).

    Examples
    --------
    >>> from thirdbody.systems.fractal import jackson_streator
    >>> jackson_streator([0.1, 0.5, 0.9]).round(6)
    array([0.211025, 0.681555, 0.952254])
    """
    clipped_q = np.clip(np.asarray(q, dtype=float), 0.0, 1.0)
    hertz = math.pi * (3 * clipped_q / (8 * math.pi)) ** (2 / 3)
    full = 1 - 3 / (2 * math.pi) * (1 - clipped_q)
    return np.where(clipped_q < 0.8, hertz * (1 - clipped_q**1.51) + full * clipped_q**1.04, full)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sinusoid(Value):
    r"""An elastic surface Δ cos(2πfx) cos(2πfy) against a flat.

    Full contact needs the mean pressure :math:`p^* = \sqrt2\,\pi E^* \Delta f`.

    Parameters
    ----------
    amplitude : float
        Δ [m]; from peak to valley it is 2Δ.
    frequency : float
        f, one over the wavelength [1/m].

    References
    ----------
    Johnson, Greenwood, Higginson 1985, doi:10.1016/0020-7403(85)90029-3. Derived.

    Examples
    --------
    >>> from thirdbody.systems.fractal import Sinusoid
    >>> wave = Sinusoid(amplitude=1e-7, frequency=1e5)
    >>> round(wave.full_contact_pressure(1e11) / 1e9, 6)
    4.442883
    """

    amplitude: float = quantity("Δ", "m", "amplitude", gt=0)
    frequency: float = quantity("f", "1/m", "one over the wavelength", gt=0)

    def full_contact_pressure(self, E_star: float) -> float:
        """p* [Pa]."""
        return math.sqrt(2) * math.pi * E_star * self.amplitude * self.frequency

    def fraction(self, pressure: ArrayLike, *, E_star: float) -> Array:
        """Real area per nominal area [1] under a mean pressure [Pa]."""
        return jackson_streator(np.asarray(pressure, float) / self.full_contact_pressure(E_star))


class Convergence(NamedTuple):
    """What the number of scales does to the real area of a `Stack`.

    Examples
    --------
    >>> from thirdbody.systems.fractal import Stack
    >>> stack = Stack.self_affine(hurst=0.8, amplitude=1e-7, frequency=1e3, ratio=2, count=8,
    ...                           E_star=1e11)
    >>> found = stack.convergence(1e6)
    >>> len(found.areas), found.converged
    (8, False)
    """

    areas: Array
    """Real area per nominal area after each scale."""
    converged: bool
    """The last scale changed the area by less than the tolerance."""
    stopped_by_hardness: bool
    """The pressure on the real area reached the hardness."""
    message: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Stack(Value):
    r"""Sinusoids on sinusoids: each scale is pressed only where the coarser ones touch.

    .. math:: A_i = A_{i-1}\,\mathcal A\left(\frac{p}{A_{i-1}\,p^*_i}\right), \qquad A_0 = 1

    with :math:`\mathcal A` of `jackson_streator`, in the order of rising frequency.

    Parameters
    ----------
    levels : tuple of Sinusoid
        The scales; frequencies must rise.
    E_star : float
        Contact modulus E* [Pa].
    H : float, optional
        Hardness H [Pa]. The scale on which p/A would exceed it is the last, and the area is then
        p/H; without it all scales count.

    Notes
    -----
    The result does not converge in the number of scales of a self-affine surface: every finer
    scale lowers the area by about the same factor, so the area is a statement about the last
    wavelength (or, with H, about the hardness). `convergence` reports it.

    Provenance: reconstructed from the idea of Jackson and Streator; the limits derived, the join
    recalled, stopping at p/H chosen here.

    References
    ----------
    Jackson, Streator 2006, Wear 261, 1337, doi:10.1016/j.wear.2006.03.015 (DOI from memory).

    Examples
    --------
    >>> from thirdbody.systems.fractal import Stack
    >>> stack = Stack.self_affine(
    ...     hurst=0.8, amplitude=1e-6, frequency=1e3, ratio=2, count=12, E_star=1e11)
    >>> stack.convergence(1e7).message
    'not converged: the last of 12 scales changed the area by 13 %'
    """

    citation: ClassVar[str] = "Jackson, Streator 2006, Wear 261, 1337"
    doi: ClassVar[str] = "10.1016/j.wear.2006.03.015"
    provenance: ClassVar[str] = "reconstructed; limits derived, join recalled"

    levels: tuple[Sinusoid, ...]
    E_star: float = quantity("E*", "Pa", "contact modulus", gt=0)
    H: float | None = quantity("H", "Pa", "hardness of the softer body", default=None, gt=0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "levels", items_of(self.levels))
        Value.__post_init__(self)

    def _problems(self) -> list[str]:
        if not self.levels or not all(isinstance(level, Sinusoid) for level in self.levels):
            return [Problem("levels", "must be one or more Sinusoid", code=Mistake.KIND)]
        f = [level.frequency for level in self.levels]
        if any(b <= a for a, b in zip(f[:-1], f[1:], strict=True)):
            return [
                Problem(
                    "levels",
                    "must rise in frequency: the coarse scale comes first",
                    code=Mistake.ORDER,
                )
            ]
        return []

    @classmethod
    def self_affine(
        cls,
        *,
        hurst: float,
        amplitude: float,
        frequency: float,
        ratio: float,
        count: int,
        E_star: float,
        H: float | None = None,
    ) -> Self:
        """Scales with f_i = f r^i and Δ_i = Δ r^(−i·hurst), i = 0 … count − 1."""
        levels = tuple(
            Sinusoid(amplitude=amplitude * ratio ** (-i * hurst), frequency=frequency * ratio**i)
            for i in range(count)
        )
        return cls(levels=levels, E_star=E_star, H=H)

    def fractions(self, pressure: ArrayLike) -> Array:
        """Real area per nominal area after each scale: (number of scales, ...)."""
        p = np.asarray(pressure, dtype=float)
        area = np.where(p > 0, 1.0, 0.0)
        floor = np.zeros_like(p) if self.H is None else np.minimum(p / self.H, 1.0)
        out = []
        for level in self.levels:
            local = np.divide(p, area, out=np.zeros_like(p), where=area > 0)
            area = np.maximum(area * level.fraction(local, E_star=self.E_star), floor)
            out.append(area)
        return np.array(out)

    def fraction(self, pressure: ArrayLike) -> Array:
        """Real area per nominal area [1] of all scales under a nominal pressure [Pa]."""
        return self.fractions(pressure)[-1]

    def convergence(self, pressure: float, *, tolerance: float = 0.01) -> Convergence:
        """Whether the last scale still changes the area by more than ``tolerance``."""
        areas = self.fractions(float(pressure))
        hard = self.H is not None and areas[-1] <= pressure / self.H
        change = 1 - areas[-1] / (areas[-2] if len(areas) > 1 else 1.0)
        converged = bool(hard or change < tolerance)
        if hard:
            message = "the hardness sets the area: p/A reached H"
        elif converged:
            message = f"the last of {len(areas)} scales changed the area by {percent(change)}"
        else:
            message = (
                f"not converged: the last of {len(areas)} scales changed the area by "
                f"{percent(change)}"
            )
        return Convergence(areas, converged, bool(hard), message)
