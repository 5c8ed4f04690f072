"""Grains that are not round or that break: the ``shape`` and ``strength`` of `Particles`.

- `Sphere`: round particles, the default
- `Angular`: a rounded tip on each surface, then faces at one angle
- `WeibullStrength`: at which load particles break, and into what
"""

from .populations.shape import Angular, Sphere
from .populations.strength import WeibullStrength

__all__ = ["Angular", "Sphere", "WeibullStrength"]
