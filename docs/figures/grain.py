"""Draw grain.png of the page on what happens to a grain."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.views.plot.style import OKABE_ITO

BEARING = tb.Material(E=206e9, nu=0.29, H=7.37e9)
QUARTZ = tb.materials["quartz"]
WORDS = {"gone": "pieces are gone", "footprint": "over the footprint", "all": "all pieces bear"}

LOOKS = (("blue", "-"), ("vermilion", "--"), ("green", "-."))


def load(x, gaps, fragments):
    """Load [N] of one grain of size x, the mean of many."""
    strength = fragments and tb.WeibullStrength.of(QUARTZ, fragments=fragments)
    density = 1e-3 / x**2
    contact = tb.Contact(
        surfaces=tb.MaterialPair(BEARING, BEARING),
        roughness=tb.Roughness(sigma=50e-9, R=20e-6),
        particles=tb.Particles(
            material=QUARTZ,
            diameter=tb.Monodisperse(mean=x),
            areal_density=density,
            strength=strength,
        ),
        particle_law=tb.particle.Series(seat="plane"),
    )
    return interface(contact).particles.fields(gaps)["F_sa"] / density


if __name__ == "__main__":
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    for ax, x in zip(figure.subplots(1, 2, sharey=True), (3e-6, 20e-6), strict=True):
        eps = np.linspace(0.0, 1.0, 400)
        whole = load(x, x * (1 - eps), None)
        ax.plot(eps, whole / whole[-1], "k:", lw=1.2, label="whole (no strength)")
        for (fragments, label), (ink, dash) in zip(WORDS.items(), LOOKS, strict=True):
            ratio = load(x, x * (1 - eps), fragments) / whole[-1]
            ax.plot(eps, ratio, color=OKABE_ITO[ink], ls=dash, label=label)
        ax.set(xlabel=r"squeeze of the grain $1-g/x$", xlim=(0, 1), ylim=(0, 2))
        ax.set_title(f"quartz of {1e6 * x:g} µm between 60 HRC", fontsize="medium")
    figure.axes[0].set_ylabel("load over that of the grain swallowed whole")
    figure.axes[0].legend(fontsize="small", loc="upper left")
    figure.savefig(Path(__file__).with_name("grain.png"), dpi=110)
