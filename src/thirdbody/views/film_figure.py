"""The figure of a film over its speeds, or over others around its only one."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from ..errors import RangeWarning
from ..study.run import run_film_curve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..study import FilmResult

__all__ = ["draw_film"]


def draw_film(result: FilmResult) -> Figure:
    """Figure of a film over its speeds, or over others around the only one, which is marked."""
    from .plot.film import stribeck

    speeds = result.states["speed"]
    if len(speeds) > 1:
        return stribeck(result.states, result.regime_speeds)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # the answer has told of its own speed
        curve, _ = run_film_curve(result.study)
    return stribeck(curve.states, curve.regime_speeds, speed=float(speeds[0]))
