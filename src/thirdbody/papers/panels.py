"""One figure of a study: named curves over one axis, as drawing, as table, as files."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .engine import Picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Line", "Panel", "draw", "picture_of", "table_of"]

Array = NDArray[np.float64]
COLOURS = ("blue", "vermilion", "green", "purple", "orange", "sky")
DASHES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)))
MARKS = "osD^vP*"
FEW = 8
"""Points of a line up to which each is marked: between them nothing was computed."""


@dataclass(frozen=True)
class Line:
    """A curve; ``colour`` and ``dash`` count, and colour −1 is the broad grey of bare surfaces."""

    label: str
    x: Array
    y: Array
    colour: int = 0
    dash: int = 0


@dataclass(frozen=True)
class Panel:
    """Curves over one axis."""

    name: str
    about: str
    xlabel: str
    ylabel: str
    columns: tuple[str, str]
    """Names of abscissa and ordinate in the table."""
    lines: tuple[Line, ...]
    xlog: bool = True
    ylog: bool = False
    ylim: tuple[float | None, float | None] = (None, None)
    levels: tuple[tuple[float, str], ...] = ()
    """Ordinates of reference and what they are."""
    note: str = ""


def draw(panel: Panel) -> Figure:
    """The panel as a matplotlib figure, without any global state."""
    from matplotlib.figure import Figure

    from ..views.plot.style import OKABE_ITO

    figure = Figure(figsize=(7.2, 4.3))
    figure.patch.set_facecolor("white")
    ax = figure.subplots()
    figure.subplots_adjust(left=0.11, right=0.63, bottom=0.21, top=0.91)
    for value, label in panel.levels:
        ax.axhline(value, color="0.35", linestyle=":", linewidth=1.1, label=label, zorder=1)
    # where dashes repeat, marks tell the lines apart without their colours
    marked = len({line.dash % len(DASHES) for line in panel.lines}) < len(panel.lines)
    for line in panel.lines:
        bare = line.colour < 0
        ax.plot(
            line.x,
            line.y,
            color="0.75" if bare else OKABE_ITO[COLOURS[line.colour % len(COLOURS)]],
            linestyle=DASHES[line.dash % len(DASHES)],
            linewidth=4.0 if bare else 1.6,
            marker=MARKS[line.colour % len(MARKS)]
            if (marked or len(line.x) <= FEW) and not bare
            else "",
            markevery=max(1, len(line.x) // 7),
            markersize=5,
            label=line.label,
            zorder=2 if bare else 3,
        )
    _dress(ax, panel)
    tall = figure.get_figheight()
    figure.text(0.02, 1 - 0.17 / tall, _title(panel), fontsize=10, va="center")
    figure.text(0.02, 0.07 / tall, panel.note, va="bottom", fontsize=7.5, color="0.3")
    figure.legend(
        *ax.get_legend_handles_labels(),
        loc="upper left",
        bbox_to_anchor=(0.64, 0.92),
        frameon=False,
        fontsize=7.8,
        handlelength=2.6,
        labelspacing=0.6,
    )
    return figure


def _title(panel: Panel) -> str:
    """What is shown, after the number of the figure where its name is one."""
    numbered = panel.name[:1].isdigit()
    about = panel.about[:1].upper() + panel.about[1:]
    return f"Fig. {panel.name}: {panel.about}" if numbered else about


def _dress(ax: Axes, panel: Panel) -> None:
    """Scales, limits, names and grid."""
    from matplotlib.ticker import (
        FormatStrFormatter,
        LogFormatterMathtext,
        LogLocator,
        NullFormatter,
    )

    if panel.xlog:
        ax.set_xscale("log")
        ax.xaxis.set_major_formatter(LogFormatterMathtext())
        ax.xaxis.set_minor_formatter(NullFormatter())
    if panel.ylog:
        ax.set_yscale("log")
        low, high = ax.get_ylim() if panel.ylim == (None, None) else panel.ylim
        if low and high and high / low < 30:
            ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            ax.yaxis.set_major_formatter(FormatStrFormatter("%g"))
            ax.yaxis.set_minor_formatter(NullFormatter())
    x = np.concatenate([line.x for line in panel.lines])
    few = all(len(line.x) <= FEW for line in panel.lines)
    margin = 1.1 if few and panel.xlog else 1.0  # for the marks at the ends
    ax.set_xlim(x.min() / margin, x.max() * margin)
    ax.set_ylim(*panel.ylim)
    ax.set_xlabel(panel.xlabel)
    ax.set_ylabel(panel.ylabel)
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.grid(visible=True, which="major", color="0.92", linewidth=0.6)
    ax.set_axisbelow(True)


def table_of(panel: Panel) -> str:
    """The panel's numbers as CSV: one row a point."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["line", *panel.columns])
    for line in panel.lines:
        label = line.label.replace("\n", " ")
        for x, y in zip(line.x, line.y, strict=True):
            writer.writerow([label, f"{x:.8g}", "" if np.isnan(y) else f"{y:.8g}"])
    return out.getvalue()


def picture_of(stem: str, make: Callable[[], Panel]) -> Picture:
    """The panel drawn, with its table."""
    panel = make()
    about = panel.about.replace("$", "").replace(r"\propto", "∝")
    return Picture(stem + panel.name, panel.name, about, panel.note, draw(panel), table_of(panel))
