"""Draw one_asperity.png and one_particle.png of the page on theory."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.views.plot.style import OKABE_ITO

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
PAIR = tb.MaterialPair(STEEL, STEEL)
LAWS = ("gw", "ceb", "zmc", "hermite", "ke", "jg")
INKS = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")]
DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2))]
SIZE = 300e-9  # m


def one_asperity(ax):
    """Mean pressure over interference under six laws."""
    omega = np.geomspace(1e-11, 1e-6, 600)
    tip = {"R": 2.8e-6, "E_star": PAIR.E_star, "H": STEEL.H}
    for name, ink, dash in zip(LAWS, INKS, DASHES, strict=True):
        law = tb.asperity.REGISTRY[name]().bound(**tip, nu=STEEL.nu)
        pressure = law.mean_pressure(omega, **tip) / STEEL.H
        ax.semilogx(1e9 * omega, pressure, color=ink, ls=dash, label=name)
    ax.set(xlabel=r"interference $\omega$ [nm]", ylabel="mean pressure over hardness [1]")
    ax.set(ylim=(0, 1.6))


def one_particle(ax):
    """Load of one particle over its squeeze, with the three limits and the computed one."""
    squeeze = np.geomspace(1e-4, 0.9, 400)
    gap = SIZE * (1 - squeeze)
    bodies = {"surfaces": PAIR, "particle": SILICA}
    table, whole = (
        tb.particle.Series(deep=deep).single(SIZE, gap, **bodies)["force"]
        for deep in ("table", "off")
    )
    E_star = 1 / ((1 - STEEL.nu**2) / STEEL.E + (1 - SILICA.nu**2) / SILICA.E)
    delta = SIZE * squeeze
    elastic = 4 / 3 * E_star * np.sqrt(SIZE / 2) * (delta / 2) ** 1.5
    limits = {
        "elastic limit": elastic,
        "fully plastic limit": np.pi / 2 * STEEL.H * SIZE * (SIZE - gap),
        "embedded limit": np.full_like(gap, np.pi / 4 * STEEL.H * SIZE**2),
    }
    ax.loglog(squeeze, 1e6 * whole, color=INKS[0], lw=2.6, label='keeps its shape, deep = "off"')
    ax.loglog(squeeze, 1e6 * table, color="black", lw=1.2, label="squashed, the default")
    for (name, load), ink, dash in zip(limits.items(), INKS[1:], DASHES[1:], strict=False):
        ax.loglog(squeeze, 1e6 * load, color=ink, ls=dash, label=name)
    ax.set(xlabel=r"squeeze $\delta$ over diameter [1]", ylabel="load of one particle [µN]")
    ax.set(ylim=(1e-4, 2e3))


if __name__ == "__main__":
    for draw in (one_asperity, one_particle):
        figure = Figure(figsize=(6.0, 4.0), layout="constrained")
        ax = figure.add_subplot()
        draw(ax)
        ax.legend(frameon=False)
        figure.savefig(Path(__file__).with_name(f"{draw.__name__}.png"), dpi=130)
