"""Draw wear_maximum.png: wear over the concentration of particles, and what moves its maximum."""

import warnings
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import thirdbody as tb

STEEL = tb.materials["S45C"]
SOFT = STEEL.replace(H=2.5e9)
DENSITY = np.geomspace(1e8, 1e12, 41)
COLOURS = ("#0072B2", "#000000", "#D55E00")
MARKS = ("s", "o", "^")


def contact(*, size: float = 1e-6, deep: str = "table") -> tb.Contact:
    """Silica between steel and a softer steel; grooves are all the wear."""
    dust = tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e10,
        diameter=tb.TruncatedGaussian(mean=size, std=0.1 * size),
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, SOFT),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust,
        particle_law=tb.particle.Series(deep=deep),
        outputs=(
            tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
            tb.outputs.Wear(K_ss=0.0, K_sa=0.0, f_ab=0.1, f_roll=0.0, renewal=1.0),
        ),
    )


def grooves(dirty: tb.Contact, *, pressure: float) -> np.ndarray:
    """Volume out of grooves per area and sliding length, over the density; NaN where jammed."""
    size = dirty.populations[0].diameter.moment(2)
    free = np.pi / 4 * size * DENSITY < 0.9
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        found = tb.equilibria.solve_states(
            dirty, pressure=pressure, vary={"particles.areal_density": DENSITY[free]}
        )
    out = np.full(DENSITY.shape, np.nan)
    out[free] = found["wear_groove"].values
    return out


def draw(
    axes: Axes, values: np.ndarray, label: str, colour: str, mark: str, style: str = "-"
) -> None:
    """A line, with a mark at its maximum, which the legend shows, too."""
    axes.loglog(DENSITY, values, style, color=colour, lw=1.5)
    axes.plot([], [], style, marker=mark, color=colour, lw=1.5, ms=5, label=label)
    top = int(np.nanargmax(values))
    axes.plot(DENSITY[top], values[top], mark, color=colour, ms=6)
    print(f"{label}: {values[top]:.3g} at {DENSITY[top]:.2g} per m²")


def main() -> None:
    figure = Figure(figsize=(9, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for pressure, colour, mark in zip((1e6, 5e6, 25e6), COLOURS, MARKS, strict=True):
        label = f"{pressure / 1e6:.0f} MPa"
        draw(left, grooves(contact(), pressure=pressure), label, colour, mark)
    old = grooves(contact(deep="off"), pressure=5e6)
    draw(left, old, "5 MPa, particles keep their shape", COLOURS[1], "D", "--")
    for size, colour, mark in zip((0.5e-6, 1e-6, 2e-6), COLOURS, MARKS, strict=True):
        label = f"{size * 1e6:g} µm"
        draw(right, grooves(contact(size=size), pressure=5e6), label, colour, mark)
    left.set_ylabel("volume of grooves [m³ per m² and m]")
    left.set_title("particles of 1 µm")
    right.set_title("5 MPa")
    for axes in (left, right):
        axes.set_xlabel("particles per area [1/m²]")
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, loc="lower center", fontsize=8)
        axes.set_ylim(1e-8, 2e-4)
    figure.savefig(Path(__file__).with_name("wear_maximum.png"), dpi=110)


if __name__ == "__main__":
    main()
