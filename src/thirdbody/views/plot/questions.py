"""Figures of what one asks of dust: connectors that stay open, plates that stand too high."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...quantities.say import value_of
from ...systems.plate_over_particle import ATOM
from ..connector_words import SELDOM
from .style import _CYCLE, _axes, _dress

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...study.run_connector import ConnectorResult
    from ...study.run_plate import PlateResult

__all__ = ["draw_failures", "draw_heights"]

DASHES = ("-", "--", "-.", ":")


def draw_failures(result: ConnectorResult) -> Figure:
    """Figure of how often a connector stays open on dust, over the contact force.

    Parameters
    ----------
    result : ConnectorResult
        From `run_connector`.
    """
    ax = _axes(None)
    plug, (forces, one, every) = result.asked.connector, result.curve()
    curves = {"one contact": one}
    if plug.contacts > 1:
        curves["connector"] = every
    for i, (label, values) in enumerate(curves.items()):
        _draw_curve(ax, i, forces, np.where(values > SELDOM, values, np.nan), label)
    for i in result.places:
        force = float(result.force[i])
        ax.plot(force, result.failure_of_all[i], "o", color="black", markersize=4)
        if len(result.places) == 1:
            ax.annotate(
                value_of(force, "N"),
                (force, result.failure_of_all[i]),
                xytext=(5, 5),
                textcoords="offset points",
                fontsize="small",
            )
    _dress(ax, "Contact force $W$ [N]", "Part of closings that fail [1]", ylog=True)
    ax.set_xlim(forces[0], forces[-1])
    if len(curves) > 1:
        ax.legend(frameon=False, fontsize="small")
    return ax.figure  # type: ignore[return-value]


def draw_heights(result: PlateResult) -> Figure:
    """Figure of how high a plate stands over particles, over their diameter.

    Parameters
    ----------
    result : PlateResult
        From `run_plate`.
    """
    ax = _axes(None)
    sizes, kinds = result.curve()
    for i, (name, heights) in enumerate(kinds):
        _draw_curve(ax, i, 1e6 * sizes, 1e9 * np.where(heights < ATOM, np.nan, heights), name)
    ax.plot(1e6 * sizes, 1e9 * sizes, color="0.6", linewidth=1.0, label="as high as the particle")
    if (limit := result.asked.chuck.limit) is not None:
        ax.axhline(1e9 * limit, color="0.25", linestyle=":", linewidth=1.0)
        ax.annotate(
            f"limit {value_of(limit, 'm')}",
            (0.98, 1e9 * limit),
            xycoords=("axes fraction", "data"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="right",
            fontsize="small",
        )
    seen = result.height >= ATOM
    ax.plot(1e6 * result.grain[seen], 1e9 * result.height[seen], "o", color="black", markersize=4)
    _dress(ax, "Diameter of the particle $x$ [µm]", "Height of the plate $h$ [nm]", ylog=True)
    ax.set_xlim(1e6 * sizes[0], 1e6 * sizes[-1])
    ax.legend(frameon=False, fontsize="small")
    return ax.figure  # type: ignore[return-value]


def _draw_curve(ax: Axes, number: int, x: np.ndarray, y: np.ndarray, label: str) -> None:
    """Curve of a number, in a colour and a dash of its own."""
    dash = DASHES[number % len(DASHES)]
    colour = _CYCLE[number % len(_CYCLE)]
    ax.plot(x, y, label=label, color=colour, linestyle=dash, linewidth=1.6)
