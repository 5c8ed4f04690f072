"""Figures of designs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

if TYPE_CHECKING:
    from ...analysis.design.design import Best

__all__ = ["tried"]


def tried(best: Best) -> Figure:
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
    ok = points["feasible"].values
    figure = Figure(figsize=(5.2, 3.8), dpi=150, layout="constrained")
    ax = figure.add_subplot()
    ax.plot(points[x][~ok], points[y][~ok], ".", color="0.8", ms=4, label="breaks a limit")
    coloured = y not in labels
    colours: dict[str, Any] = {"c": points[labels[0]].values[ok]} if coloured else {"color": "C0"}
    drawn = ax.scatter(points[x][ok], points[y][ok], s=9, label="obeys the limits", **colours)
    if coloured and ok.any():
        figure.colorbar(drawn, label=labels[0])
    if len(labels) > 1:
        front = points.isel(point=points["front"].values).sortby(x)
        ax.plot(front[x], front[y], "k-", lw=0.8, label="front")
    else:
        place = {**best.values, **best.objectives}
        ax.plot(place[x], place[y], "k+", ms=12, mew=1.5, label="best")
    for name, side in ((x, "x"), (y, "y")):
        values = points[name].values
        if name in numbers and values.min() > 0 and values.max() > 5 * values.min():
            ax.set(**{f"{side}scale": "log"})
    ax.set(xlabel=x, ylabel=y)
    ax.legend(frameon=False, fontsize="small")
    return figure
