"""Which seat carries the load? The model against explicit particles on explicit surfaces.

``python -m thirdbody.papers.seats OUT.png`` writes the figure.

The numbers come from boundary-element runs kept in ``data/explicit_particles.json``: particles
placed at random on Gaussian height maps, pressed by a rigid flat, contact pressure capped at the
hardness; and from the library's own, which ``thirdbody reproduce explicit`` makes anew, kept in
``data/explicit_comparison.json``. No parameter of the model was adjusted to them.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import thirdbody as tb
from thirdbody.laws.base import Seat
from thirdbody.quantities.files import whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "STATED_AGREEMENT",
    "comparison",
    "contact",
    "explicit_particles",
    "figure",
    "main",
]

STATED_AGREEMENT = {200e-9: 0.10, 300e-9: 0.06, 600e-9: 0.02}
"""Relative difference of the load share that the ``rough`` seat stays within, 1e-5 ≤ F* ≤ 3e-4."""


@cache
def explicit_particles() -> dict[str, Any]:
    """The stored runs: parameters, method, and load share, area share and separation by load.

    Returns
    -------
    dict
        ``parameters`` in SI, ``points`` with ``diameter`` [m], ``F_star`` [1], and the results as
        computed (``raw``) and with the luck of sampling removed (``control_variate``).

    Examples
    --------
    >>> from thirdbody.papers.seats import explicit_particles
    >>> runs = explicit_particles()
    >>> runs["parameters"]["sigma"], len(runs["points"])
    (3e-07, 12)
    """
    file = resources.files("thirdbody").joinpath("data/explicit_particles.json")
    return json.loads(file.read_text("utf-8"))


@cache
def comparison() -> list[dict[str, Any]]:
    """States of the shipped comparison of seats, as columns.

    Returns
    -------
    list of dict
        ``case``, ``F_star`` [1], the particles' load share as it was pressed, ``share`` and
        ``share_error`` [1], that of the model, ``share_statistical``, and why they differ.

    Examples
    --------
    >>> len({state["case"] for state in comparison()})
    34
    """
    file = resources.files("thirdbody").joinpath("data/explicit_comparison.json")
    states: list[dict[str, object]] = json.loads(file.read_text("utf-8"))["states"]
    return states


def contact(diameter: float, seat: Seat = "rough", h_0: float = 0.0) -> tb.Contact:
    """The interface of the runs.

    Parameters
    ----------
    diameter : float
        Particle diameter x [m], the same for all.
    seat : {"rough", "plane", "offset"}, optional
        Where the particles rest.
    h_0 : float, optional
        Height of the seat above the mean asperity plane [m], for ``offset``.

    Returns
    -------
    Contact

    Examples
    --------
    >>> from thirdbody.papers.seats import contact
    >>> dusty = contact(300e-9)
    >>> round(dusty.E_ss / 1e9, 6)
    112.0
    """
    parameters = explicit_particles()["parameters"]
    nu = 0.3
    body = tb.Material(E=2 * parameters["E_star"] * (1 - nu**2), nu=nu, H=parameters["H"])
    return tb.Contact(
        surfaces=tb.MaterialPair(body, body),
        roughness=tb.Roughness(
            sigma=parameters["sigma"],
            R=parameters["R"],
            alpha=parameters["alpha"],
            eta_R_sigma=parameters["eta_R_sigma"],
        ),
        particles=tb.Particles(
            material=body,
            diameter=tb.distributions.Monodisperse(mean=diameter),
            areal_density=parameters["areal_density"],
        ),
        particle_law=tb.particle.Series(deep="off", seat=seat, h_0=h_0),
    )


def figure(*, h_0: float = 2.5, loads: np.ndarray | None = None) -> Figure:
    """Particle load share against load: three sizes, three seats, and explicit particles.

    Parameters
    ----------
    h_0 : float, optional
        Height of the ``offset`` seat over σ [1]; 2.5 puts particles on the asperity tops.
    loads : array, optional
        F* [1]; 160 from 5e-7 to 1.5e-3 when left out.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import numpy as np
    >>> from thirdbody.papers.seats import figure
    >>> len(figure(loads=np.geomspace(1e-6, 3e-4, 8)).axes)
    3
    """
    from matplotlib.figure import Figure

    from ..views.plot.style import AXIS_LABELS

    loads = np.geomspace(5e-7, 1.5e-3, 160) if loads is None else loads
    sigma = explicit_particles()["parameters"]["sigma"]
    out = Figure(figsize=(7.6, 3.2), dpi=150, layout="constrained")
    panels = out.subplots(1, 3, sharey=True)
    handles: list[object] = []
    for ax, diameter in zip(panels, STATED_AGREEMENT, strict=True):
        shown = [*_draw_model(ax, diameter, loads, h_0), *_draw_explicit(ax, diameter)]
        handles = handles or shown
        ax.set_title(
            rf"$x/\sigma$ = {diameter / sigma:.2g}   ($x$ = {diameter * 1e9:.0f} nm)",
            fontsize="medium",
        )
        _dress(ax, loads)
    panels[0].set_ylabel(AXIS_LABELS["particle_load_share"])
    panels[1].set_xlabel(AXIS_LABELS["F_star"])
    out.legend(
        handles=handles, loc="outside lower center", ncols=2, frameon=False, fontsize="small"
    )
    return out


def _draw_model(ax: Axes, diameter: float, loads: np.ndarray, h_0: float) -> Iterator[Any]:
    """A line a seat; ``h_0`` is over σ."""
    from ..views.plot.style import OKABE_ITO

    sigma = explicit_particles()["parameters"]["sigma"]
    blue, vermilion, green = (OKABE_ITO[name] for name in ("blue", "vermilion", "green"))
    lines: tuple[tuple[Seat, str, str, str, float], ...] = (
        ("rough", "at a random place on the rough surface", blue, "-", 2.2),
        ("plane", "on the mean asperity plane", vermilion, "--", 1.4),
        ("offset", rf"on the asperity tops ($h_0$ = {h_0:g} $\sigma$)", green, "-.", 1.4),
    )
    for seat, words, colour, dash, width in lines:
        height = h_0 * sigma if seat == "offset" else 0.0
        share = tb.solve(contact(diameter, seat, height), F_star=loads).particle_load_share
        share = np.where(np.asarray(share) > 0, share, np.nan)
        if np.all(np.isnan(share)):
            ax.text(
                0.97,
                0.035,
                "on the mean asperity plane: no load at all",
                color=colour,
                fontsize="x-small",
                transform=ax.transAxes,
                ha="right",
            )
        (line,) = ax.plot(
            loads,
            share,
            color=colour,
            linestyle=dash,
            linewidth=width,
            label=f"model, particles {words}",
        )
        yield line


def _draw_explicit(ax: Axes, diameter: float) -> Iterator[Any]:
    """The library's own runs and the older ones, both without the luck of sampling."""
    stored = [
        (point["F_star"], run["load_share"], run["load_share_error"])
        for point in explicit_particles()["points"]
        if point["diameter"] == diameter
        for run in (point["control_variate"] or point["raw"],)
    ]
    sigma = explicit_particles()["parameters"]["sigma"]
    name = f"x{diameter / sigma:.2g}".replace(".", "")
    mine = [state for state in comparison() if state["case"] == name]
    library_points = [
        (state["F_star"], state["share"], state["share_error"])
        for state in mine
        if state["share_error"] is not None
    ]
    older: dict[str, Any] = dict(color="0.55", marker="s", markersize=4, zorder=4)
    ours: dict[str, Any] = dict(color="black", marker="o", markersize=5, zorder=5)
    for points, words, style in (
        (stored, "explicit particles, earlier runs", older | {"markerfacecolor": "white"}),
        (library_points, "explicit particles, this library", ours),
    ):
        load, share, error = zip(*points, strict=True)
        yield ax.errorbar(
            load,
            share,
            yerr=error,
            linestyle="none",
            capsize=2.5,
            elinewidth=1.0,
            label=words,
            **style,
        )


def _dress(ax: Axes, loads: np.ndarray) -> None:
    from matplotlib.ticker import FuncFormatter

    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(0.007, 1.4)
    ax.set_xlim(loads[0], loads[-1])
    ax.grid(visible=True, color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))


def main(arguments: list[str] | None = None) -> int:
    """Write the figure to the file named on the command line."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print("usage: python -m thirdbody.papers.seats OUT.png", file=sys.stderr)
        return 2
    from ..views.figure_files import save_figure

    target = Path(arguments[0])
    with whole(target) as draft:
        save_figure(figure(), draft, target.suffix.lstrip(".") or "png", dpi=150)
    print(target)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
