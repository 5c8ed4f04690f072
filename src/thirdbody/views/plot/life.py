"""Figures of an oil or a dry contact over time: dirt, masses, and where the dirt goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from ...systems.life.history import LifeHistory
from .style import OKABE_ITO

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from numpy.typing import NDArray

    from ...systems.life.contact_history import DryHistory

    Histories = LifeHistory | DryHistory

__all__ = ["draw_flows", "draw_history", "flows", "histories", "life"]

HOUR = 3600.0
SIZES = {"4 µm": "blue", "6 µm": "vermilion", "14 µm": "green"}
DASHES = ("-", "--", "-.")
AWAY = ("--", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)), (0, (8, 3)))
"""Dashes of what leaves, so that its lines differ without their colours."""
BROKEN = (0, (4, 4))
"""Dashes of a third line that arrives, through which the second one is seen."""
LEAST = 0.01
"""Particles per mL that the code number 0 ends at."""
THINNEST = 0.004
"""Width of the thinnest arrow, in parts of the height."""


def draw_history(axes: Axes, history: LifeHistory) -> None:
    """Draw the numbers of the code over time as steps, and the counts behind them.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    history : LifeHistory
    """
    hours = _hours(history)
    codes = [[_code_number(digits) for digits in code.split("/")] for code in history.codes]
    smooth = np.log2(np.maximum(history.counts / 1e6, 1e-9) / LEAST)
    styles = zip(SIZES.items(), np.transpose(codes), smooth.T, DASHES, strict=True)
    for (name, colour), numbers, exact, dash in styles:
        axes.plot(hours, exact, color=OKABE_ITO[colour], lw=0.6, alpha=0.6)
        axes.step(hours, numbers, dash, where="post", color=OKABE_ITO[colour], label=f"from {name}")
    axes.plot([], [], color="0.5", lw=0.6, label="counts")
    _mark_events(axes, history)
    axes.set(xlabel="Time [h]", ylabel="ISO 4406 number", xscale="log")
    axes.set_ylim(max(axes.get_ylim()[0], -1.0), None)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    counts = axes.twinx()
    counts.set_yscale("log")
    counts.set_ylim(*(LEAST * 2.0**end for end in axes.get_ylim()))
    counts.set_ylabel("Particles per mL of oil")
    axes.margins(x=0)
    axes.legend(frameon=False)


def draw_contact(axes: Axes, history: DryHistory) -> None:
    """Draw wear depths over time, and the particles in the contact behind them.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    history : DryHistory
    """
    hours = _hours(history)
    for side, colour in ((1, "blue"), (2, "vermilion")):
        depth = 1e6 * history.more[f"wear_{side}"][1]
        axes.plot(
            hours, np.where(depth > 0, depth, np.nan), DASHES[side - 1], color=OKABE_ITO[colour],
            label=f"surface {side}",
        )  # fmt: skip
    events = _mark_events(axes, history)
    axes.set(xlabel="Time [h]", ylabel="Wear depth [µm]", xscale="log", yscale="log")
    particles = axes.twinx()
    per_area = history.numbers.sum(axis=(1, 2)) / 1e6
    particles.plot(
        hours, np.where(per_area > 0, per_area, np.nan), color="0.4", lw=1.2, label="particles"
    )
    particles.set(yscale="log", ylabel="Particles per mm²")
    axes.margins(x=0)
    handles = [*axes.get_lines()[:2], *particles.get_lines(), *events[:1]]
    axes.legend(handles=handles, frameon=False, loc="lower right")


def _mark_events(axes: Axes, history: Histories) -> list[Line2D]:
    """Lines at the events of a history; the first of them stands in the legend."""
    first = _hours(history)[0]
    return [
        axes.axvline(
            max(event.time / HOUR, first), color="0.6", ls=":", lw=0.9, zorder=0,
            label="_" if i else "events",
        )
        for i, event in enumerate(history.events)
    ]  # fmt: skip


def _hours(history: Histories) -> NDArray[np.float64]:
    """Times [h]; the first, which no logarithm has, where the second one is in the logarithm."""
    hours = history.times / HOUR
    if len(hours) > 2 and hours[0] == 0:
        hours = np.append(hours[1] ** 2 / hours[2], hours[1:])
    return hours


def _code_number(digits: str) -> float:
    return float(digits.removeprefix(">")) if digits != "-" else np.nan


def draw_masses(axes: Axes, history: Histories) -> None:
    """Draw what came and where it went over time.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    history : LifeHistory or DryHistory
    """
    hours = _hours(history)
    colours = [
        OKABE_ITO[name] for name in ("vermilion", "orange", "blue", "green", "purple", "sky")
    ]
    inside = f"in the {_pool(history)}"
    columns = {**history.ledger.came, **history.ledger.went, inside: history.ledger.in_oil}
    least = 1e-6 * max(np.max(values) for values in columns.values())
    moved = {name: values for name, values in columns.items() if np.any(values > least)}
    arrived = [name for name in moved if name in history.ledger.came]
    for i, (name, values) in enumerate(moved.items()):
        seen = np.where(values > 0, values, np.nan)  # a logarithm has no 0
        line = axes.plot(hours, 1e3 * seen, color=colours[i % len(colours)], label=name, lw=1.6)[0]
        if name in arrived:
            # wide below, narrow and broken above: both are seen where they lie on each other
            line.set_linewidth(4.8 / 2 ** arrived.index(name))
            line.set_linestyle("-" if arrived.index(name) < 2 else BROKEN)
        else:
            line.set_linestyle(":" if name == inside else AWAY[(i - len(arrived)) % len(AWAY)])
    axes.set(xlabel="Time [h]", ylabel="Mass since the beginning [g]", xscale="log", yscale="log")
    axes.margins(x=0)
    low, high = axes.get_ylim()
    low = max(low, 1e3 * least)
    # the legend lies above every line
    free = 0.11 * ((len(moved) + 1) // 2)
    axes.set_ylim(low, high * (high / low) ** (free / (1 - free)))
    axes.legend(frameon=False, ncols=2, loc="upper left")


def _pool(history: Histories) -> str:
    """What holds the particles."""
    return "oil" if isinstance(history, LifeHistory) else "contact"


def histories(history: LifeHistory) -> Figure:
    """Counts and codes over time, and the masses of the ledger below.

    Parameters
    ----------
    history : LifeHistory

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz), ingress=(),
    ...     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> figure = histories(tb.life(oil=oil, duration=1800.0))
    >>> len(figure.axes)
    3
    """
    figure = Figure(figsize=(6.4, 6.4), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    draw_history(above, history)
    draw_masses(below, history)
    above.set_xlabel("")
    return figure


# ------------------------------------------------------------------------------ flows
def _band(start: tuple[float, float], end: tuple[float, float], width: float) -> PathPatch:
    """A band of constant height from one place to another."""
    (x0, y0), (x1, y1), middle = start, end, 0.5 * (start[0] + end[0])
    upper = [(x0, y0 + width), (middle, y0 + width), (middle, y1 + width), (x1, y1 + width)]
    lower = [(x1, y1), (middle, y1), (middle, y0), (x0, y0)]
    curve = [Path.MOVETO, Path.CURVE4, Path.CURVE4, Path.CURVE4]
    back = [Path.LINETO, Path.CURVE4, Path.CURVE4, Path.CURVE4]
    return PathPatch(Path([*upper, *lower], curve + back), lw=0)


def draw_flows(axes: Axes, history: Histories) -> None:
    """Draw where the dirt came from and where it went; widths are masses.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    history : LifeHistory
    """
    from ..life_amounts import mass_of

    ledger, pool = history.ledger, _pool(history)
    came = {f"in the {pool} before": float(ledger.in_oil[0])} | {
        name: float(values[-1]) for name, values in ledger.came.items()
    }
    went = {name: float(values[-1]) for name, values in ledger.went.items()} | {
        f"in the {pool} now": float(ledger.in_oil[-1])
    }
    whole = max(sum(came.values()), sum(went.values()))
    axes.set_axis_off()
    axes.set(xlim=(0, 1), ylim=(-0.04, 1.04))
    if whole <= 0:
        axes.text(0.5, 0.5, "no dirt moves", ha="center", va="center")
        return
    high = 0.62
    middle = 0.5 - 0.5 * high
    axes.add_patch(
        FancyBboxPatch(
            (0.46, middle), 0.08, high, boxstyle="round,pad=0.0,rounding_size=0.01",
            fc=OKABE_ITO["yellow"], ec="0.3", lw=0.8, zorder=3,
        )
    )  # fmt: skip
    axes.text(0.5, middle + high + 0.02, pool, ha="center", va="bottom")
    colours = [OKABE_ITO[name] for name in ("sky", "vermilion", "orange", "purple", "black")]
    others = [OKABE_ITO[name] for name in ("blue", "green", "purple", "orange", "sky", "black")]
    for masses, left, palette in ((came, True, colours), (went, False, others)):
        shown = {name: mass for name, mass in masses.items() if mass > 0}
        widths = [high * mass / sum(shown.values()) for mass in shown.values()]
        drawn = [max(width, THINNEST) for width in widths]
        apart = (0.98 - sum(drawn)) / max(len(shown), 1)
        outside, at_oil = 0.99 - 0.5 * apart, middle + high
        for i, (name, mass) in enumerate(shown.items()):
            at_oil -= widths[i]
            outside -= drawn[i]
            x0, x1 = (0.24, 0.46) if left else (0.54, 0.76)
            ends = ((x0, outside), (x1, at_oil)) if left else ((x0, at_oil), (x1, outside))
            band = _band(*ends, drawn[i])
            band.set(facecolor=palette[i % len(palette)], alpha=0.7, zorder=2)
            axes.add_patch(band)
            x, side = (0.23, "right") if left else (0.77, "left")
            label = f"{name}, {mass_of(mass)}"
            axes.text(x, outside + 0.5 * drawn[i], label, ha=side, va="center", fontsize=9)
            outside -= apart


def flows(history: Histories) -> Figure:
    """Where the dirt came from and where it went over a history; widths are masses.

    Parameters
    ----------
    history : LifeHistory

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz), ingress=(),
    ...     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> len(flows(tb.life(oil=oil, duration=1800.0)).axes)
    1
    """
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    draw_flows(figure.subplots(), history)
    return figure


def life(history: Histories) -> Figure:
    """Codes, or the wear and particles of a dry contact, masses over time, and flows of dirt.

    Parameters
    ----------
    history : LifeHistory or DryHistory

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import thirdbody as tb
    >>> quartz = tb.materials["quartz"]
    >>> oil = tb.oil.OilCircuit(
    ...     volume=0.2, start=tb.oil.OilDirt.from_iso4406("18/16/13", material=quartz), ingress=(),
    ...     filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3))
    >>> len(life(tb.life(oil=oil, duration=1800.0)).axes)
    4
    """
    figure = Figure(figsize=(6.4, 9.6), layout="constrained")
    above, below, last = figure.subplots(3, 1, height_ratios=(1, 1, 1))
    if isinstance(history, LifeHistory):
        draw_history(above, history)
    else:
        draw_contact(above, history)
    draw_masses(below, history)
    draw_flows(last, history)
    above.set_xlabel("")
    return figure
