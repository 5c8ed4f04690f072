"""Draw feedback.png of the page on contacts whose friction heats them."""

import warnings
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

import thirdbody as tb
from thirdbody.systems import feedback

COLD, MELT, EXPONENT = 293.0, 1793.0, 1.03
STEEL = tb.materials["S45C"]
CLEAN = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    outputs=tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
)
PATH = feedback.ThermalPath(h_1=5e3, h_2=5e3, T_1=COLD, T_2=COLD)
COLOURS = ("#000000", "#0072B2", "#E69F00", "#D55E00")
MARKS = ("o", "s", "^", "D")


def dusty(areal_density: float) -> tb.Contact:
    """Alumina of 0.5 µm between the surfaces."""
    dust = tb.Particles(
        material=tb.materials["Al2O3"],
        areal_density=areal_density,
        diameter=tb.TruncatedGaussian(mean=500e-9, std=50e-9),
    )
    return CLEAN.replace(particles=dust)


def answer(contact: tb.Contact, *, exponent: float = EXPONENT, alpha: float | None = None):
    """The branch along the speed at 5 MPa."""
    laws = [feedback.Softening(T_melt=MELT, T_0=COLD, exponent=exponent)]
    if alpha:
        laws.append(feedback.JunctionGrowth(alpha=alpha))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return tb.equilibria.coupled(
            contact, pressure=5e6, sliding_speed=1.0, feedback=laws, cooling=PATH, limits="speed"
        )


def draw(axes: Axes, found: tb.results.Coupled, label: str, colour: str, mark: str) -> None:
    """A branch, dashed where it is unstable, and its end with the mark of the legend."""
    v, T = found.branch["speed"], found.branch["T"]
    turn = int(np.argmax(v))
    # length along the branch in units of the figure, for a smooth line through its points
    length = np.cumsum(np.hypot(np.diff(v, prepend=0) / 10, np.diff(T, prepend=COLD) / 1500))
    through = PchipInterpolator(length, np.column_stack([v, T]))
    for start, end, style in ((0, turn, "-"), (turn, len(v) - 1, "--")):
        points = through(np.linspace(length[start], length[end], 200))
        axes.plot(*points.T, style, color=colour, lw=1.5)
    axes.plot(v[turn], T[turn], mark, color=colour, ms=6)
    axes.plot([], [], f"-{mark}", color=colour, ms=6, label=label)


def main() -> None:
    figure = Figure(figsize=(9, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    cases = [(None, "clean"), (1e9, "10⁹ m⁻²"), (1e10, "10¹⁰ m⁻²"), (1e11, "10¹¹ m⁻²")]
    for (density, label), colour, mark in zip(cases, COLOURS, MARKS, strict=True):
        found = answer(dusty(density) if density else CLEAN)
        print(label, found.speed_limit, found.states[0].T, found.states[0].mu)
        draw(left, found, label, colour, mark)
    guesses = [
        ({}, "as on the left"),
        ({"exponent": 0.7}, "m = 0.7"),
        ({"exponent": 1.5}, "m = 1.5"),
        ({"alpha": 9.0}, "α = 9"),
    ]
    for (options, label), colour, mark in zip(guesses, COLOURS, MARKS, strict=True):
        found = answer(CLEAN, **options)
        print(label, found.speed_limit)
        draw(right, found, label, colour, mark)
    left.set(
        ylabel="temperature of the surfaces [K]",
        title="alumina of 0.5 µm on the area",
        ylim=(250, 1800),
    )
    right.set(title="clean, other constants")
    for axes in (left, right):
        axes.set(xlabel="sliding speed [m/s]", xlim=(0, 10))
        axes.legend(frameon=False, loc="lower right")
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=140)


if __name__ == "__main__":
    main()
