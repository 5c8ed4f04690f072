"""The figures of a report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...equilibrium.modes import FAINT
from ...quantities.say import join_words, value_of
from ..html import figure, svg_of, words
from .found import Found

if TYPE_CHECKING:
    from matplotlib.axes import Axes


FEW = 12
MOST_PRESSURES = 4
"""Ticks of the pressure above a figure, between its ends."""
"""Loads that are marked one by one."""
DRAWING = (4.6, 3.4)
"""Width and height of a figure [in]."""


def figures_of(report: Found) -> list[str]:
    from matplotlib.ticker import EngFormatter

    from .. import plot

    out = [first_figure(report)]
    if not report.contact.two_body:
        out.append(_area_figure(report))
    if not report.contact.two_body:
        ax = plot.shares(report.curve, _place(left=0.60))
        if report.curve.populations:
            _each_population(report, ax)
        out.append((_mark_loads(report, ax), "Part of the load that particles carry."))
    ax = _mark_loads(report, plot.separation(report.curve, _place(left=0.92), quantity="h"))
    ax.yaxis.set_major_formatter(EngFormatter("m"))
    ax.set_ylabel(ax.get_ylabel().removesuffix(" [m]"))
    out.append((ax, "Separation of the mean planes over the load."))
    ax = _mark_loads_of_study(report, plot.regimes(report.curve, _place(left=0.60, above=0.12)))
    out.append((ax, "How the real contact is deformed."))
    legend = f"F* = F/(A_n E_ss), with E_ss = {value_of(report.contact.E_ss, 'Pa')}."
    loads = len(set(_marks(report)))
    if loads:
        mark = "Bar" if loads > FEW else "Triangle" if loads == 1 else "Triangles"
        legend += f" {mark} on the axis: the load{'s' if loads > 1 else ''} of the study."
    if drawn := _critical_loads(report):
        legend += f" Dotted: {join_words(list(drawn))}."
    pictures = "\n".join(figure(svg_of(ax.figure), caption) for ax, caption in out)
    lead = f'<p class="soft lead-in">{words(legend)}</p>'
    return [lead, f"<div class=figures>{pictures}</div>"]


def first_figure(report: Found) -> tuple[Axes, str]:
    """The most telling figure and its caption: modes, or the area of two bodies."""
    from .. import plot

    if report.contact.two_body:
        return _area_figure(report)
    place = _place(left=0.60, above=0.74)
    ax = plot.modes(report.curve, place, transitions=report.result.transitions)
    return _mark_loads_of_study(report, ax), "Contact modes over the load."


def _area_figure(report: Found) -> tuple[Axes, str]:
    from .. import plot

    ax = _mark_loads(report, plot.area(report.curve, _place(left=0.75)))
    return ax, "Real contact area over the load."


def _mark_loads(report: Found, ax: Axes) -> Axes:
    """Loads of the study and critical loads, and the pressure above."""
    from matplotlib.ticker import EngFormatter, LogLocator, NullLocator

    E = report.contact.E_ss
    _mark_loads_of_study(report, ax)
    for name, F in _critical_loads(report).items():
        ax.axvline(F, color="0.25", linewidth=0.8, linestyle=":")
        ax.annotate(
            f"$F^*_{{{name.removeprefix('F_')}}}$",
            (F, 1),
            xycoords=("data", "axes fraction"),
            xytext=(2, -3),
            textcoords="offset points",
            fontsize="small",
            va="top",
        )
    ax.tick_params(which="both", top=False)
    above = ax.secondary_xaxis("top", functions=(multiply_by(E), multiply_by(1 / E)))
    above.set_xlabel("Nominal pressure")
    if ax.get_xscale() == "log":
        above.xaxis.set_major_locator(LogLocator(numticks=MOST_PRESSURES))
    above.xaxis.set_major_formatter(EngFormatter("Pa"))
    above.xaxis.set_minor_locator(NullLocator())
    above.tick_params(which="both", direction="in")
    return ax


def _critical_loads(report: Found) -> dict[str, float]:
    """Critical loads F* within the curves."""
    if report.contact.two_body:
        return {}
    drawn = np.atleast_1d(report.curve.F_star)
    loads = report.existing_loads()
    return {name: F for name, F in loads.items() if drawn[0] <= F <= drawn[-1]}


def _marks(report: Found) -> list[float]:
    """Loads F* of the study that can be marked."""
    loads = report.result.states.F_star
    return [F for i in report.result.solved_states if (F := float(loads[i])) >= FAINT]


def _mark_loads_of_study(report: Found, ax: Axes) -> Axes:
    """The loads of the study."""
    loads = _marks(report)
    style: dict[str, Any] = dict(marker="^", markersize=5, linestyle="")
    if len(loads) > FEW:
        loads = [min(loads), max(loads)]
        style = dict(marker="|", markersize=7, linestyle="-", linewidth=2.5)
    below = ax.get_xaxis_transform()
    zeros = [0.0] * len(loads)
    ax.plot(loads, zeros, transform=below, clip_on=False, zorder=5, color="black", **style)
    return ax


def _each_population(report: Found, ax: Axes) -> None:
    from ..plot.style import _CYCLE, _DASHES

    for i, population in enumerate(report.curve.populations):
        style: dict[str, Any] = dict(
            color=_CYCLE[(i + 1) % len(_CYCLE)], linestyle=_DASHES[(i + 1) % 4]
        )
        ax.plot(report.curve.F_star, population.load_share, label=population.name, **style)
    ax.lines[0].set_label("all particles")
    ax.legend(frameon=False, fontsize="small")


def _place(*, left: float, above: float = 0.52) -> Axes:
    """Axes with this much room [in] for labels, found without drawing twice."""
    from matplotlib.figure import Figure

    width, height = DRAWING
    below, right = 0.54, 0.17
    rectangle = (
        left / width,
        below / height,
        1 - (left + right) / width,
        1 - (below + above) / height,
    )
    return Figure(figsize=DRAWING, dpi=150).add_axes(rectangle)


def multiply_by(factor: float) -> Any:
    """A function that multiplies."""
    return lambda values: values * factor
