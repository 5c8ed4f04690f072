"""Draw interface.png of the theory page: python docs/figures/interface.py."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from scipy.interpolate import CubicSpline

WIDTH, HEIGHT = 7.6, 3.5  # inch
X, Y = (-0.1, 14.0), (-2.9, 3.0)
places = [-0.4, 0.5, 1.3, 2.1, 3.0, 3.9, 4.6, 5.2, 5.9, 6.5, 7.1, 7.6, 8.1, 8.7, 9.4, 10.4]
heights = [-0.3, 0.9, -0.5, 1.95, -0.35, -0.35, -0.1, 1.1, -1.0, -1.0]
heights += [0.6, -0.9, 1.8, -0.6, 0.7, -0.6]

x = np.linspace(0, 10, 2000)
z = CubicSpline(places, heights)(x)
z = (z - z.mean()) / z.std()
tips = z[1:-1][(z[1:-1] > z[:-2]) & (z[1:-1] > z[2:])]
y_s, h = tips.mean(), 1.55
stretch = WIDTH / (X[1] - X[0]) * (Y[1] - Y[0]) / HEIGHT

figure = Figure(figsize=(WIDTH, HEIGHT))
ax = figure.add_axes((0, 0, 1, 1))
ax.set(xlim=X, ylim=Y)
ax.axis("off")
ax.fill_between(x, Y[0], np.minimum(z, h), color="#c9d3dc", lw=0)
ax.plot(x, np.minimum(z, h), color="#44546a", lw=1.1)
ax.fill_between(x, h, h + 0.95, color="#9fb0bf", lw=0)
ax.plot(x, np.where(z > h, h, np.nan), color="#D55E00", lw=5, solid_capstyle="round", zorder=4)
for level, words, dash in (
    (0, "mean plane", ":"),
    (y_s, "mean asperity", (0, (4, 2))),
    (h, "surface 2", "-"),
):
    ax.plot([0, 11.75], [level, level], color="black", lw=0.8, ls=dash)
    ax.text(11.85, level, words, va="center", fontsize=9)
for place, low, high, symbol in (
    (11.2, y_s, h, "$d$"),
    (10.3, 0, h, "$h$"),
    (11.2, 0, y_s, "$y_s$"),
):
    arrow = dict(arrowstyle="<->", lw=1, shrinkA=0, shrinkB=0)
    ax.annotate("", (place, low), (place, high), arrowprops=arrow)
    ax.text(place + 0.1, (low + high) / 2, symbol, va="center", fontsize=12)
ax.text(0.15, h + 0.5, "surface 2, smooth: the roughness of both is below", va="center")


def particle(place, bottom, top, colour):
    size = top - bottom
    centre = (place, (top + bottom) / 2)
    ax.add_patch(Ellipse(centre, size / stretch, size, fc=colour, ec="#333333", lw=0.9, zorder=3))


at = np.interp([3.45, 6.2], x, z)
particle(3.45, at[0] - 0.15, h + 0.15, "#E69F00")
particle(6.2, at[1] + 0.1, at[1] + 0.95, "#F0E442")
ax.text(3.45, at[0] - 0.55, "squeezed: carries", ha="center", va="top")
ax.text(6.2, at[1] - 0.3, "smaller than its gap:\ncarries nothing", ha="center", va="top")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=140, facecolor="white")
