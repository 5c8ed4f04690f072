"""Draw grain.png, grain_shapes.png and grain_map.png of the page on what happens to a grain."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.laws.particle.breakage import Breakage, crush_embed_size
from thirdbody.views.plot.style import OKABE_ITO

BEARING = tb.Material(E=206e9, nu=0.29, H=7.37e9)
QUARTZ = tb.materials["quartz"]
WORDS = {
    "gone": "gone: fragments carry nothing",
    "footprint": "footprint: the default",
    "all": "all: every fragment carries",
}

INKS = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")]
LOOKS = (("blue", "-"), ("vermilion", "--"), ("green", "-."))
DASHES = ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)))


def load(x, gaps, fragments):
    """Load [N] of one grain of size x, the mean of many."""
    strength = fragments and tb.grains.WeibullStrength.of(QUARTZ, fragments=fragments)
    density = 1e-3 / x**2
    contact = tb.Contact(
        surfaces=tb.MaterialPair(BEARING, BEARING),
        roughness=tb.Roughness(sigma=50e-9, R=20e-6),
        particles=tb.Particles(
            material=QUARTZ,
            diameter=tb.distributions.Monodisperse(mean=x),
            areal_density=density,
            strength=strength,
        ),
        particle_law=tb.particle.Series(seat="plane"),
    )
    return interface(contact).particles.fields(gaps)["F_sa"] / density


def draw_broken():
    """Load of a grain that breaks over that of a whole one."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    for ax, x in zip(figure.subplots(1, 2, sharey=True), (3e-6, 20e-6), strict=True):
        eps = np.linspace(0.0, 1.0, 400)
        whole = load(x, x * (1 - eps), None)
        ax.plot(eps, whole / whole[-1], "k:", lw=1.2, label="whole: without a strength")
        for (fragments, label), (ink, dash) in zip(WORDS.items(), LOOKS, strict=True):
            ratio = load(x, x * (1 - eps), fragments) / whole[-1]
            ax.plot(eps, ratio, color=OKABE_ITO[ink], ls=dash, label=label)
        ax.set(xlabel=r"squeeze of the grain $1-g/x$ [1]", xlim=(0, 1), ylim=(0, 2))
        ax.set_title(f"quartz of {1e6 * x:g} µm between steel of 60 HRC", fontsize="medium")
    figure.axes[0].set_ylabel("load over that of a grain\nthat sinks in whole [1]")
    figure.axes[0].legend(fontsize="small", loc="upper left")
    figure.savefig(Path(__file__).with_name("grain.png"), dpi=110)


def draw_shapes():
    """Load of angular grains and of squashed ones over that of spheres."""
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    pair = tb.MaterialPair(BEARING, BEARING)
    law = tb.particle.Series()
    eps = np.linspace(0.0, 1.0, 400)[1:-1]
    sphere = law.single(1.0, 1 - eps, surfaces=pair, particle=QUARTZ)["force"]
    left.plot(eps, sphere / (np.pi / 4 * BEARING.H), "k:", lw=1.2, label="sphere")
    for i, (roundness, degrees) in enumerate([(0.5, 45), (0.25, 35), (0.25, 25), (0.15, 18)]):
        shape = tb.grains.Angular(roundness=roundness, angle=f"{degrees} deg")
        found = law.of_shape(shape).single(1.0, 1 - eps, surfaces=pair, particle=QUARTZ)["force"]
        label = f"$R_w$ = {roundness:g}, {degrees}°"
        left.plot(eps, found / (np.pi / 4 * BEARING.H), f"C{i}", ls=DASHES[i], label=label)
    left.set(xlabel=r"squeeze of the grain $1-g/x$ [1]", ylabel=r"load over $\pi H x^2/4$ [1]")
    left.set_title("quartz between steel of 60 HRC", fontsize="medium")
    left.legend(fontsize="small")
    debris = tb.Material(E=193e9, nu=0.29, H=1.36e9)
    eps = 1 - np.geomspace(0.03, 0.99, 400)
    for soft, style in (("sphere", "k:"), ("squashed", "C3-")):
        found = tb.particle.Series(soft=soft).single(1.0, 1 - eps, surfaces=pair, particle=debris)
        right.plot(1 - eps, found["force"] / (np.pi / 4 * debris.H), style, label=soft)
    right.set(xlabel=r"height left $g/x$ [1]", ylabel=r"load over $\pi H_a x^2/4$ [1]")
    right.set(xscale="log", yscale="log", xlim=(0.03, 1), ylim=(0.01, 100))
    right.set_title("soft steel debris between steel of 60 HRC", fontsize="medium")
    right.legend(fontsize="small")
    figure.savefig(Path(__file__).with_name("grain_shapes.png"), dpi=110)


NAMES = ("soda-lime glass", "SiO2", "quartz", "SiC", "Al2O3", "Si3N4", "ZrO2", "WC", "diamond")


def draw_map():
    """The size above which grains of the library break, over the hardness of the surfaces."""
    figure = Figure(figsize=(7.0, 3.8), layout="constrained")
    ax = figure.subplots()
    for i, name in enumerate(NAMES):
        grain = tb.materials[name]
        hardness = np.geomspace(0.5e9, min(grain.H, 12e9), 121)
        breakage = Breakage.of_material(tb.grains.WeibullStrength.of(grain), grain, 1.0)
        sizes = []
        for H in hardness:
            body = BEARING.replace(H=float(H))
            pair = tb.MaterialPair(body, body)
            one = tb.particle.Series().one(surfaces=pair, particle=grain)
            sizes.append(1e6 * crush_embed_size(one, breakage))
        dash = "-" if i < len(INKS) else "--"
        # broad where the thin line of silica lies on it
        width = 4.5 if name == "soda-lime glass" else 1.5
        ax.loglog(hardness / 1e9, sizes, f"C{i}", ls=dash, lw=width, label=name)
        if grain.H < 12e9:
            ax.plot(hardness[-1] / 1e9, sizes[-1], f"C{i}o")
    ax.axvline(7.37, color="0.7", lw=1.0, zorder=0)
    ax.text(7.2, 0.12, "60 HRC", rotation=90, ha="right", va="bottom", color="0.5")
    ax.set(xlabel="hardness of the surfaces [GPa]", ylabel="size $x^*$ of the grain [µm]")
    ax.set(ylim=(0.1, 5e3))
    ax.text(0.55, 0.15, "below its line a grain stays whole")
    ax.text(11.5, 3.0e3, "above, it breaks", ha="right")
    figure.legend(fontsize="small", loc="outside right center")
    figure.savefig(Path(__file__).with_name("grain_map.png"), dpi=110)


if __name__ == "__main__":
    mpl.rcParams["axes.prop_cycle"] = mpl.cycler(color=INKS)
    draw_broken()
    draw_shapes()
    draw_map()
