"""Drawings of the panels.

Colour and marker tell the particle size (the roughness in Figs. 5 and 11), filled markers on a
full line are silica, open markers on a dashed line steel debris, and the broad grey line is the
contact without particles. Loads that the paper quotes are lines with their number above the axes;
points are crosses, upright for steel debris, with their number in the legend.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from .figures import Line, Mark, Panel
from .readings import SILICA, STEEL

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["as_mathtext", "draw"]

THIN, WIDE = 0.7, 1.4
"""Widths of lines, in points."""

Styles = dict[float, tuple[str, str]]
"""Colour and marker by the size or roughness in nm."""


def _styles() -> dict[str, Styles]:
    """Colour and marker for each size and roughness in nm."""
    from ...views.plot.style import OKABE_ITO as colour

    grey = "#777777"
    return {
        "size": {
            0: ("0.72", ""),
            25: (colour["purple"], "v"),
            100: (colour["orange"], "s"),
            150: (grey, "P"),
            200: (colour["sky"], "^"),
            250: (grey, "X"),
            300: (colour["green"], "o"),
            500: (colour["blue"], "D"),
            1000: (colour["vermilion"], "*"),
        },
        "roughness": {
            50: (colour["blue"], "o"),
            100: (colour["orange"], "s"),
            300: (colour["green"], "^"),
            500: (colour["vermilion"], "D"),
        },
    }


def draw(panel: Panel, subtitle: str = "") -> Figure:
    """The panel as a matplotlib figure, without any global state."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator, PercentFormatter

    count = len(panel.ylabels)
    figure = Figure(figsize=(7.2, 4.6 if count == 1 else 5.9))
    figure.patch.set_facecolor("white")
    grid = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    high = figure.get_figheight()
    figure.subplots_adjust(
        left=0.11,
        right=0.69,
        bottom=(0.85 if panel.note else 0.6) / high,
        top=1 - 0.65 / high,
        hspace=0.08,
    )
    styles = _styles()[panel.by]
    for ax, ordinate, label in zip(grid, range(count), panel.ylabels, strict=True):
        if panel.xlog:
            ax.set_xscale("log")
        if panel.ylog:
            ax.set_yscale("log")
        else:
            ax.yaxis.set_major_locator(MaxNLocator(steps=[1, 2, 5, 10]))
        if not panel.xlog:
            ax.xaxis.set_major_locator(MaxNLocator(steps=[1, 2, 5, 10]))
        for i, line in enumerate(panel.lines):
            _draw_line(ax, line, ordinate, styles, i, few=len(line.x) < 40)
        if panel.percent:
            ax.yaxis.set_major_formatter(PercentFormatter(1, decimals=0, symbol=""))
            ax.set_ylim(-0.03, 1.03)
        if panel.ylim:
            ax.set_ylim(*panel.ylim)
        ax.set_xlim(*panel.xlim)
        ax.set_ylabel(label)
        ax.tick_params(which="both", direction="in", top=True, right=True)
        ax.grid(visible=True, which="major", color="0.92", linewidth=0.6)
        ax.set_axisbelow(True)
        _draw_quoted(ax, panel, styles, numbers=ordinate == 0)
    grid[-1].set_xlabel(panel.xlabel)
    small: dict[str, Any] = dict(fontsize=7.5, color="0.3")
    figure.text(
        0.02, 1 - 0.17 / high, f"Fig. {panel.name}: {panel.about}", fontsize=10, va="center"
    )
    figure.text(0.02, 1 - 0.35 / high, as_mathtext(subtitle), va="center", **small)
    figure.text(0.02, 0.07 / high, panel.note, va="bottom", linespacing=1.25, **small)
    _legend(figure, panel, styles)
    if not _lines_to_see(panel):
        grid[0].text(0.5, 0.5, "none in this reading", transform=grid[0].transAxes, ha="center")
    return figure


def _lines_to_see(panel: Panel) -> list[Line]:
    """The lines of which anything can be seen."""
    return [line for line in panel.lines if any(np.isfinite(y).any() for y in line.ys)]


def _draw_line(ax: Axes, line: Line, ordinate: int, styles: Styles, i: int, few: bool) -> None:
    colour, marker = styles[line.by]
    if line.material == "":
        ax.plot(line.x, line.ys[ordinate], color=colour, linewidth=4.5, zorder=1.5)
        return
    steel = line.material == STEEL
    step = max(1, len(line.x) // 9)
    start = (i * 7 + (step // 2 if steel else 0)) % step
    ax.plot(
        line.x,
        line.ys[ordinate],
        color=colour,
        linestyle=(0, (4, 2)) if steel else "-",
        linewidth=THIN if line.thin else WIDE,
        marker=marker,
        markevery=1 if few else (start, step),
        markersize=(6.5 if marker == "*" else 4.5) * (0.8 if few or line.thin else 1),
        markerfacecolor="white" if steel else colour,
        markeredgewidth=0.9,
        zorder=3,
    )


def _draw_quoted(ax: Axes, panel: Panel, styles: Styles, numbers: bool) -> None:
    if panel.band:
        x, low, high, _ = panel.band
        ax.fill_between(x, low, high, color=_styles()["size"][1000][0], alpha=0.18, linewidth=0)
    for level, _ in panel.levels:
        ax.axhline(level, color="0.3", linestyle="-.", linewidth=0.9)
    for mark in panel.marks:
        colour = "0.25" if mark.by is None else styles[mark.by][0]
        if isinstance(mark.x, tuple):
            ax.axvspan(*mark.x, color=colour, alpha=0.13, linewidth=0, zorder=0.5)
            continue
        if mark.y is not None:
            cross = "+" if mark.dashed else "x"
            ax.plot(mark.x, mark.y, marker=cross, color="black", markersize=9, zorder=5, mew=3)
            ax.plot(mark.x, mark.y, marker=cross, color=colour, markersize=7.6, zorder=5.1, mew=1.5)
            continue
        ax.axvline(mark.x, color=colour, linestyle="--" if mark.dashed else ":", linewidth=1.3)
        if numbers:
            ax.annotate(
                _power(mark.x),
                (mark.x, 1),
                xycoords=("data", "axes fraction"),
                xytext=(4 if mark.left else -4, 2),
                textcoords="offset points",
                va="bottom",
                ha="right" if mark.left else "left",
                fontsize=7.5,
                color="0.2",
            )


def _legend(figure: Figure, panel: Panel, styles: Styles) -> None:
    size, roughness = "$x_a$ [nm]", r"$\sigma$ [nm]"
    groups = [
        (size if panel.by == "size" else roughness, _key_of_sizes(panel, styles)),
        (size, _key_of_widths(panel)),
        ("particles", _key_of_materials(panel)),
        ("quoted in the paper", _key_of_quotes(panel, styles)),
    ]
    handles: list[Artist] = []
    for header, keys in groups:
        if keys:
            handles += [_key(header, linestyle="none"), *keys]
    legend = figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.695, 1 - 0.6 / figure.get_figheight()),
        frameon=False,
        fontsize=7.8,
        handlelength=2.4,
        labelspacing=0.45,
    )
    for text in legend.get_texts():
        if text.get_text() in [header for header, _ in groups]:
            text.set_fontweight("bold")


def _key(label: str, **style: Any) -> Artist:
    from matplotlib.lines import Line2D

    return Line2D([], [], label=label, **style)


def _key_of_sizes(panel: Panel, styles: Styles) -> list[Artist]:
    keys = []
    for value in sorted({line.by for line in _lines_to_see(panel)}):
        colour, marker = styles[value]
        if value == 0:
            keys.append(_key("no particles", color=colour, linewidth=4.5))
        else:
            style: dict[str, object] = dict(marker=marker, markersize=5, linewidth=1.4)
            keys.append(_key(f"{value:g}", color=colour, **style))
    return keys


def _key_of_widths(panel: Panel) -> list[Artist]:
    """The sizes of thin and of wide lines, where both are drawn."""
    sizes = {line.thin: line.x_a for line in _lines_to_see(panel)}
    if len(sizes) < 2:
        return []
    return [
        _key(f"{sizes[thin]:g}", color="black", linewidth=THIN if thin else WIDE)
        for thin in (True, False)
    ]


def _key_of_materials(panel: Panel) -> list[Artist]:
    materials = {line.material for line in _lines_to_see(panel)}
    style: dict[str, object] = dict(color="black", linewidth=1.4, marker="o", markersize=4.5)
    keys = {
        SILICA: _key("SiO$_2$ (dust)", linestyle="-", markerfacecolor="black", **style),
        STEEL: _key("S45C (wear debris)", linestyle=(0, (4, 2)), markerfacecolor="white", **style),
    }
    return [key for material, key in keys.items() if material in materials]


def _key_of_quotes(panel: Panel, styles: Styles) -> list[Artist]:
    """The band, each sort of mark once with the numbers of points, and the levels."""
    from matplotlib.patches import Patch

    keys: list[Artist] = []
    if panel.band:
        keys.append(Patch(facecolor=_styles()["size"][1000][0], alpha=0.25, label=panel.band[3]))
    alike: dict[str, list[Mark]] = {}
    for mark in panel.marks:
        alike.setdefault(mark.label, []).append(mark)
    looks = Counter((mark.by, mark.dashed) for mark in panel.marks if mark.y is None)
    for label, marks in alike.items():
        mark = marks[0]
        colour = "0.25" if mark.by is None else styles[mark.by][0]
        if isinstance(mark.x, tuple):
            keys.append(Patch(facecolor=colour, alpha=0.2, label=label))
        elif mark.y is not None:
            cross: dict[str, object] = dict(
                linestyle="none", marker="+" if mark.dashed else "x", markersize=7, mew=1.6
            )
            quoted = [point.y for point in marks if point.y is not None]
            numbers = ", ".join(_power(y) if panel.ylog else f"{y:g}" for y in quoted)
            keys.append(_key(f"{label}: {numbers}", color=colour, **cross))
        else:
            if looks[mark.by, mark.dashed] > 1 and isinstance(mark.x, float):
                label += f": {_power(mark.x)}"
            dash = "--" if mark.dashed else ":"
            keys.append(_key(label, color=colour, linestyle=dash, linewidth=1.3))
    for _, label in panel.levels:
        keys.append(_key(label, color="0.3", linestyle="-.", linewidth=0.9))
    return keys


def as_mathtext(text: str) -> str:
    """Subscripts of plain text, as in H_s, set as such."""
    return re.sub(r"([A-Za-zσηχφ])_(\w+)", r"$\\mathrm{\1}_{\2}$", text)


def _power(value: float) -> str:
    mantissa, exponent = f"{value:.2e}".split("e")
    return rf"${float(mantissa):g}\times10^{{{int(exponent)}}}$"
