"""Particles by whose sizes the kernel knows them: a population, or a part of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from ...populations.distributions import Distribution
    from ...populations.particles import Particles

__all__ = ["Power", "Section", "Sizes"]


class Power(NamedTuple):
    """Sizes x^(−slope−1) from low to high [m]: a section of a `PowerLaw`."""

    low: float
    high: float
    slope: float


Sizes: TypeAlias = "Distribution | Power"


class Section(NamedTuple):
    """Particles whose sizes the kernel knows: a population, or a part of one."""

    one: Particles
    """The population."""
    changed: Any
    """The same, with arrays in it."""
    law: Any
    varied: Any
    """Its law, as it is and with arrays in it."""
    share: float
    """Part of the population."""
    part: float
    """Part of the component of its sizes that it belongs to."""
    component: int
    """Number of that component, through all populations."""
    sizes: tuple[Sizes, Sizes]
    """As they are, and with arrays in them."""
