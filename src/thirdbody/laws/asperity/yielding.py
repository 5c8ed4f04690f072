"""What the laws that take the onset of yield from the peak pressure have in common."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Self

from ...errors import InvalidValue, Mistake
from ...quantities.value import quantity
from ..base import AbstractAsperityLaw

__all__ = ["PeakPressureLaw"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PeakPressureLaw(AbstractAsperityLaw):
    r"""Yield where the peak Hertz pressure reaches K H.

    .. math:: \omega_c = \left(\frac{\pi K H}{2E^*}\right)^2 R, \qquad K = 0.454 + 0.41\,\nu

    K belongs to the peak pressure; ZMC's k = ⅔K to the mean.
    """

    K: float | None = quantity("K", "1", "peak pressure at yield over H", default=None, gt=0)
    nu: float | None = quantity(
        "ν", "1", "Poisson ratio of the softer body", default=None, gt=-1, le=0.5
    )

    @property
    def yield_factor(self) -> float:
        """K as given, or 0.454 + 0.41 ν."""
        if self.K is not None:
            return self.K
        if self.nu is None:
            name = type(self).__name__
            raise InvalidValue(
                f"{name}.nu is needed (K = 0.454 + 0.41 nu) when {name}.K is not given",
                code=Mistake.MISSING,
            )
        return 0.454 + 0.41 * self.nu

    def bound(self, *, R, E_star, H, nu: float | None = None) -> Self:
        """The law with the Poisson ratio of the softer body, unless one was given."""
        return self if self.nu is not None or nu is None else self.replace(nu=nu)

    def yield_interference(self, *, R, E_star, H):
        """ω_c = (πKH/2E*)² R [m]."""
        return (math.pi * self.yield_factor * H / (2 * E_star)) ** 2 * R

    @property
    @abstractmethod
    def breakpoints(self) -> tuple[float, ...]: ...
