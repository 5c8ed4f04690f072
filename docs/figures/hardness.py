"""Draw hardness.png of the page on what happens to a grain."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import thirdbody as tb

STEEL = tb.Material(E=206e9, nu=0.3, H=5e9)
PAIR = tb.MaterialPair(STEEL, STEEL)
COMPUTED = (0.5, 0.7, 1, 1.4, 2, 3, 5)
"""Where flow was computed; between these the table is interpolated."""
RATIOS = np.unique(np.concatenate([np.geomspace(0.5, 5, 121), [0.9999, 1.0001], COMPUTED]))
SQUEEZES = (0.2, 0.4, 0.6, 0.8)
COLOURS = ("#0072B2", "#009E73", "#E69F00", "#D55E00")
MARKS = ("o", "s", "^", "D")
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
CURVES = (0.5, 1, 1.4, 2, 3, 5)
"""Hardness ratios of the curves over the squeeze."""
SHADES = ("#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#d4b400")
EPSILON = np.linspace(0.02, 0.95, 187)
NAMES = (
    "load over $\\pi R^2 H$ of the surface [1]",
    "sink over squeeze [1]",
    "contact area over $\\pi R^2$ [1]",
)


def values(deep: str, ratios: np.ndarray, squeezes: np.ndarray) -> np.ndarray:
    """Load over πR²H of the surface, sink over the squeeze, area over πR²: (ratios, 3, ε)."""
    law, found = tb.particle.Series(deep=deep), []
    for ratio in ratios:
        grain = STEEL.replace(H=float(ratio) * STEEL.H)
        spots = law.probe(np.array(squeezes), surfaces=PAIR, particle=grain)
        circle, squeeze = np.pi / 4, np.array(squeezes) / 2
        sink = spots.sinks[0][:, 0] / squeeze
        if deep == "off" and ratio < 1:
            sink = np.full_like(sink, np.nan)  # not known there
        load = spots.load[:, 0] / (circle * STEEL.H)
        found.append([load, sink, spots.areas[0][:, 0] / circle])
    return np.array(found)


def draw_over_hardness(panels: np.ndarray) -> None:
    """Three panels over the hardness ratio."""
    for deep, line in (("off", "--"), ("table", "-")):
        found = values(deep, RATIOS, SQUEEZES)
        for k, axes in enumerate(panels):
            for i, (squeeze, colour) in enumerate(zip(SQUEEZES, COLOURS, strict=True)):
                label = f"ε = {squeeze:g}"
                width = 1.6 if deep == "table" else 0.9
                axes.plot(RATIOS, found[:, k, i], line, color=colour, lw=width)
                if deep == "table":
                    at = np.isin(RATIOS, COMPUTED)
                    axes.plot(RATIOS[at], found[at, k, i], MARKS[i], color=colour, ms=4)
                    axes.plot([], [], f"-{MARKS[i]}", color=colour, ms=4, label=label)
            axes.set(xscale="log", xlabel="hardness ratio ρ [1]", ylabel=NAMES[k])
            axes.set_xticks([0.5, 1, 2, 3, 5], ["0.5", "1", "2", "3", "5"], minor=False)
            axes.minorticks_off()
            axes.axvline(1, color="0.8", lw=0.8, zorder=0)


def draw_over_squeeze(panels: np.ndarray) -> None:
    """Three panels over the squeeze, one curve a hardness ratio."""
    found = values("table", CURVES, EPSILON)
    for k, axes in enumerate(panels):
        for row, ratio, colour, dash in zip(found, CURVES, SHADES, DASHES, strict=True):
            axes.plot(EPSILON, row[k], color=colour, ls=dash, lw=1.4, label=f"ρ = {ratio:g}")
        axes.set(xlabel="squeeze ε of each half [1]", ylabel=NAMES[k], xlim=(0, 0.95))


def main() -> None:
    """Load, sink and area over the hardness ratio, and over the squeeze."""
    figure = Figure(figsize=(9.6, 6.4), layout="constrained")
    panels = figure.subplots(2, 3)
    draw_over_hardness(panels[0])
    draw_over_squeeze(panels[1])
    for letter, axes in zip("abcdef", panels.flat, strict=True):
        axes.set_title(f"({letter})", loc="left", fontsize="medium")
    for row in panels:
        row[0].set_yscale("log")
        row[0].legend(frameon=False, fontsize=8)
        row[1].set_ylim(-0.02, 1.05)
    panels[1, 0].set_ylim(3e-2, 5)
    panels[1, 2].set_ylim(0, 4)
    path = Path(__file__).with_name("hardness.png")
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(128).save(path, optimize=True)


if __name__ == "__main__":
    main()
