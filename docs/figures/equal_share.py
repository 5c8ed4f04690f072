"""Draw equal_share.png of the page on design and print its table."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb
from thirdbody.views.plot.style import OKABE_ITO

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
LOADS = {1e6: "1 MPa", 5e6: "5 MPa", 5e7: "50 MPa"}
NUMBERS = np.geomspace(1e-5, 1.0, 26)  # η_a σ²
INKS = ("blue", "vermilion", "green")
SURFACES = {(100e-9, 3.5e-6): "-", (1e-6, 3.5e-6): "--", (100e-9, 50e-6): ":"}


def ratio(number, pressure, sigma=100e-9, R=3.5e-6):
    """x_a/σ of equal shares with so many particles on an area σ²."""
    contact = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=sigma, R=R),
        particles=tb.Particles(
            material=SILICA,
            areal_density=number / sigma**2,
            diameter=tb.TruncatedGaussian(mean=0.3 * sigma, std=0.03 * sigma),
        ),
    )
    return tb.equilibria.equal_share_size(contact, pressure=pressure)


if __name__ == "__main__":
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    ax = figure.add_subplot()
    for (pressure, label), ink in zip(LOADS.items(), INKS, strict=True):
        for (sigma, R), style in SURFACES.items():
            curve = [ratio(n, pressure, sigma, R) for n in NUMBERS]
            ax.loglog(NUMBERS, curve, style, color=OKABE_ITO[ink], lw=1.2)
            if style == "-":  # at its own line, which colour alone would not name
                at = 3 if pressure < 5e7 else 7
                ax.annotate(
                    label, (NUMBERS[at], curve[at]), xytext=(0, -20 if pressure < 5e6 else 9),
                    textcoords="offset points", color=OKABE_ITO[ink], ha="left", va="center",
                )  # fmt: skip
    for low, high, said in ((0.5, 0.7, "0.5 to 0.7 (2022)"), (0.8, 1.3, "0.8 to 1.3 (2024)")):
        ax.axhspan(low, high, color="0.88", zorder=0)
        ax.text(1.3e-5, np.sqrt(low * high), said, va="center", fontsize="small")
    ax.fill_between(NUMBERS, np.sqrt(4 * 0.3 / np.pi / NUMBERS), 30, color="0.75", alpha=0.5)
    ax.text(0.12, 6, "particles cover\nmore than 0.3", ha="center", fontsize="small")
    ax.set(
        xlabel=r"particles on an area $\sigma^2$: $\eta_a\sigma^2$ [1]",
        ylabel=r"$x_a/\sigma$ at which shares are equal [1]",
        xlim=(NUMBERS[0], NUMBERS[-1]),
        ylim=(0.4, 20),
        yticks=[0.5, 1, 2, 5, 10, 20],
    )
    ax.yaxis.set_major_formatter("{x:g}")
    ax.yaxis.set_minor_formatter("")
    for (sigma, R), style in SURFACES.items():
        name = rf"$\sigma$ = {1e6 * sigma:g} µm, $R$ = {1e6 * R:g} µm"
        ax.plot([], [], style, color="0.3", lw=1.2, label=name)
    ax.legend(frameon=False, loc="upper right", fontsize="small")
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=150)
    for number in (1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.5):
        row = [ratio(number, p) for p in LOADS]
        print(f"| {number:g} | " + " | ".join(f"{x:.2f}" for x in row) + " |")
