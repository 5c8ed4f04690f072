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


def over_hardness(deep: str) -> np.ndarray:
    """Load over πR²H of the surface, sink over the squeeze, area over πR²: (ratios, 3, ε)."""
    law, found = tb.particle.Series(deep=deep), []
    for ratio in RATIOS:
        grain = STEEL.replace(H=ratio * STEEL.H)
        spots = law.probe(np.array(SQUEEZES), surfaces=PAIR, particle=grain)
        circle, squeeze = np.pi / 4, np.array(SQUEEZES) / 2
        sink = spots.sinks[0][:, 0] / squeeze
        if deep == "off" and ratio < 1:
            sink = np.full_like(sink, np.nan)  # not known there
        load = spots.load[:, 0] / (circle * STEEL.H)
        found.append([load, sink, spots.areas[0][:, 0] / circle])
    return np.array(found)


def main() -> None:
    """Three panels over the hardness ratio."""
    figure = Figure(figsize=(9.6, 3.3), layout="constrained")
    panels = figure.subplots(1, 3)
    names = (
        "load over $\\pi R^2 H$ of the surface",
        "sink over squeeze",
        "contact area over $\\pi R^2$",
    )
    for deep, line in (("off", "--"), ("table", "-")):
        found = over_hardness(deep)
        for k, (axes, name) in enumerate(zip(panels, names, strict=True)):
            for i, (squeeze, colour) in enumerate(zip(SQUEEZES, COLOURS, strict=True)):
                label = f"ε = {squeeze:g}" if deep == "table" else None
                width = 1.6 if deep == "table" else 0.9
                axes.plot(RATIOS, found[:, k, i], line, color=colour, lw=width, label=label)
                if deep == "table":
                    at = np.isin(RATIOS, COMPUTED)
                    axes.plot(RATIOS[at], found[at, k, i], ".", color=colour, markersize=6)
            axes.set(xscale="log", xlabel="hardness, grain over surface", ylabel=name)
            axes.set_xticks([0.5, 1, 2, 3, 5], ["0.5", "1", "2", "3", "5"], minor=False)
            axes.minorticks_off()
            axes.axvline(1, color="0.8", lw=0.8, zorder=0)
    panels[0].set_yscale("log")
    panels[0].legend(frameon=False, fontsize=8)
    panels[1].set_ylim(-0.02, 1.05)
    path = Path(__file__).with_name("hardness.png")
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(128).save(path, optimize=True)


if __name__ == "__main__":
    main()
