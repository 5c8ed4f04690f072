"""Figures of designs."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ...quantities.say import readable_unit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...analysis.design.design import Best

__all__ = ["plot_trials"]

WIDTH = 48
"""Letters along an axis."""


def plot_trials(best: Best) -> Figure:
    """Every point tried, feasible or not, and the best.

    One variable against the first objective; several: the first two variables, coloured by it;
    several objectives: the first two against each other.

    Parameters
    ----------
    best : Best

    Returns
    -------
    matplotlib.figure.Figure
    """
    points, labels = best.points, list(best.objectives)
    numbers = list(best.tolerance)
    if len(labels) > 1:
        x, y = labels[:2]
    elif len(numbers) > 1:
        x, y = numbers[:2]
    else:
        x, y = (numbers or labels)[0], labels[0]
    at: dict[str, NDArray[np.float64]] = {}
    sizes: dict[str, float] = {}
    said: dict[str, str] = {}
    place: dict[str, Any] = {**best.values, **best.objectives}
    for name in (x, y, labels[0]):
        about = points[name].attrs
        sizes[name], unit = readable_unit(place[name], about["units"])
        at[name] = points[name].values / sizes[name]
        said[name] = fill(f"{about['long_name']} [{unit or 1}]", WIDTH)
    ok, front = points["feasible"].values, points["front"].values
    figure = Figure(figsize=(5.2, 3.8), dpi=150, layout="constrained")
    ax = figure.add_subplot()
    ax.plot(at[x][~ok], at[y][~ok], ".", color="0.8", ms=4, label="breaks a limit")
    coloured = y not in labels
    colours: dict[str, Any] = {"c": at[labels[0]][ok]} if coloured else {"color": "C0"}
    drawn = ax.scatter(at[x][ok], at[y][ok], s=9, label="obeys the limits", **colours)
    if coloured and ok.any():
        figure.colorbar(drawn, label=said[labels[0]])
    if len(labels) > 1:
        order = np.flatnonzero(front)[np.argsort(at[x][front])]
        ax.plot(at[x][order], at[y][order], "k-", lw=0.8, label="front")
    else:
        ends = (place[name] / sizes[name] for name in (x, y))
        ax.plot(*ends, "k+", ms=12, mew=1.5, label="best")
    for name, side in ((x, "x"), (y, "y")):
        values = at[name]
        if name in numbers and values.min() > 0 and values.max() > 5 * values.min():
            ax.set(**{f"{side}scale": "log"})
    ax.set(xlabel=said[x], ylabel=said[y])
    ax.legend(frameon=False, fontsize="small")
    return figure
