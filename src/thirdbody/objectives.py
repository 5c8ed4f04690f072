"""Objectives of a design and their bounds: what `design` is asked.

- `Objective`: what should be small, large, or inside a window
- `Limit`: a bound on a metric at every load
- `Suspension`: the fluid that brings the particles, whose number follows from it
"""

from .analysis.design.problem import Limit, Objective, Suspension

__all__ = ["Limit", "Objective", "Suspension"]
