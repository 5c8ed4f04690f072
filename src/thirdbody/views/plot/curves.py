"""Figures of contact states, ready for a journal column.

Every function takes what `sweep` or `solve` gave back, an optional matplotlib Axes, and
returns the Axes; nothing touches the global state of pyplot. Colours are those of Okabe and
Ito, which colour-blind readers can tell apart, and every curve is told apart by its dashes too.

>>> import numpy as np, thirdbody as tb
>>> steel = tb.materials["S45C"]
>>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e11,
...                     diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9))
>>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6), particles=dust)
>>> state = tb.solve(contact, F_star=np.geomspace(1e-6, 1e-3, 30))
>>> ax = area(state)
>>> ax.get_xscale(), ax.get_yscale()
('log', 'log')
>>> ax.figure.savefig("area.png")  # doctest: +SKIP
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.ticker import PercentFormatter

from ...equilibrium.columns import Equilibrium
from ...equilibrium.transitions import Transitions
from ...equilibrium.words import MODES
from ...errors import InvalidValue, Mistake
from ...quantities.arguments import names_arguments
from ...quantities.say import number
from ..palette import HATCHES, MODE_COLOURS, REGIMES, tint
from .style import (
    AXIS_LABELS,
    Curve,
    _axes,
    _column,
    _curves,
    _dress,
    _legend_above,
    _share_axis,
    _styles,
)

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

__all__ = ["area", "modes", "regimes", "separation", "shares"]


def _single(data: xarray.Dataset | Equilibrium, function: str) -> Curve:
    curves = _curves(data)
    if len(curves) != 1:
        raise InvalidValue(
            f"plot.{function} draws one load curve and the Dataset holds {len(curves)}; select "
            "one, e.g. data.isel({'particles.diameter.mean': 0})",
            code=Mistake.BEYOND,
        )
    return curves[0]


def _lines(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None,
    against: str,
    quantity: str,
    *,
    ylog: bool,
    per_load: bool = False,
) -> Axes:
    ax = _axes(ax)
    curves = _curves(data)
    for curve, style in zip(curves, _styles(curves), strict=True):
        y = _column(curve, quantity)
        if per_load:
            y = y / _column(curve, "F_star")
        ax.plot(_column(curve, against), y, label=curve.label or None, **style)
    _dress(ax, against, quantity, xlog=against in ("F_star", "pressure"), ylog=ylog)
    if any(curve.label for curve in curves):
        ax.legend(frameon=False, fontsize="small")
    return ax


@names_arguments
def area(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    against: Literal["F_star", "pressure"] = "F_star",
    quantity: Literal["A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p"] = "A_t",
    per_load: bool = False,
) -> Axes:
    """Real contact area per nominal area against load, on logarithmic axes.

    Parameters
    ----------
    data : xarray.Dataset or Equilibrium
        From `sweep`, one curve for each varied value, or from `solve` with several loads.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    against : {"F_star", "pressure"}, optional
        Load on the abscissa: F* = F/(A_n E_ss) [1] or F/A_n [Pa].
    quantity : {"A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p"}, optional
        Which area [1].
    per_load : bool, optional
        Divide the area by F*. Area is nearly proportional to load, so this is what tells curves
        apart; E_ss over it is the mean real pressure.

    Returns
    -------
    matplotlib.axes.Axes

    References
    ----------
    The diagram of Horng et al. 2022, Fig. 3a, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = tb.plot.area(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> ax.get_ylabel()
    'Real contact area $A_t/A_n$ [1]'
    """
    ax = _lines(data, ax, against, quantity, ylog=True, per_load=per_load)
    if per_load:
        name = AXIS_LABELS.get(quantity, quantity).removesuffix(" [1]")
        ax.set_ylabel(f"{name} over load $F^*$ [1]")
        ax.set_yscale("linear")
    return ax


@names_arguments
def shares(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    basis: Literal["load", "area"] = "load",
    against: Literal["F_star", "pressure"] = "F_star",
) -> Axes:
    """What part of the load, or of the real area, the particles have.

    Parameters
    ----------
    data : xarray.Dataset or Equilibrium
        From `sweep` or `solve`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    basis : {"load", "area"}, optional
        F_sa/F_t or A_sa/A_t [%].
    against : {"F_star", "pressure"}, optional
        Load on the abscissa.

    Returns
    -------
    matplotlib.axes.Axes

    References
    ----------
    The diagram of Horng et al. 2022, Fig. 3b, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> debris = tb.Particles(material=steel, diameter=tb.distributions.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = tb.plot.shares(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-3, 10)), basis="area")
    >>> ax.get_ylabel()
    'Particle area share $A_{sa}/A_t$ [%]'
    """
    if basis not in ("load", "area"):
        raise InvalidValue(
            f"plot.shares: basis = {basis!r} must be 'load' or 'area'", code=Mistake.OPTION
        )
    ax = _lines(data, ax, against, f"particle_{basis}_share", ylog=False)
    _share_axis(ax)
    return ax


@names_arguments
def separation(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    quantity: Literal["d_star", "d", "h"] = "d_star",
    against: Literal["F_star", "pressure"] = "F_star",
) -> Axes:
    """Separation of the surfaces against load.

    Parameters
    ----------
    data : xarray.Dataset or Equilibrium
        From `sweep` or `solve`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    quantity : {"d_star", "d", "h"}, optional
        d/σ [1] or d [m] from the mean asperity height, or h [m] from the mean surface plane.
    against : {"F_star", "pressure"}, optional
        Load on the abscissa.

    Returns
    -------
    matplotlib.axes.Axes

    References
    ----------
    The diagram of Horng et al. 2022, Fig. 12a, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = tb.plot.separation(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> len(ax.lines)
    1
    """
    return _lines(data, ax, against, quantity, ylog=False)


@names_arguments
def regimes(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    against: Literal["F_star", "pressure"] = "F_star",
) -> Axes:
    """Elastic, elastoplastic and plastic part of the real area against load, stacked.

    Parameters
    ----------
    data : xarray.Dataset or Equilibrium
        One load curve, from `sweep` or `solve`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    against : {"F_star", "pressure"}, optional
        Load on the abscissa.

    Returns
    -------
    matplotlib.axes.Axes

    References
    ----------
    The quantities of Horng et al. 2022, Fig. 10, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = tb.plot.regimes(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> [text.get_text() for text in ax.get_legend().get_texts()]
    ['plastic', 'elastoplastic', 'elastic']
    """
    curve = _single(data, "regimes")
    ax = _axes(ax)
    x, total = _column(curve, against), _column(curve, "A_t")
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = [_column(curve, name) / total for name in REGIMES]
    stacked = ax.stackplot(
        x,
        parts,
        labels=[name for name, _ in REGIMES.values()],
        colors=[tint(colour, 0.75) for _, colour in REGIMES.values()],
        edgecolor="white",
        linewidth=0.8,
    )
    for layer, hatch in zip(stacked, HATCHES.values(), strict=True):
        layer.set_hatch(2 * hatch)
    _dress(ax, against, "A_t", xlog=against in ("F_star", "pressure"))
    ax.set_ylabel(r"Part of the real area $A_e,\,A_{ep},\,A_p\,/A_t$ [%]")
    ax.set_ylim(0, 1)
    ax.yaxis.set_major_formatter(PercentFormatter(1, symbol=""))
    ax.set_xlim(np.nanmin(x), np.nanmax(x))
    ax.grid(visible=False)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], fontsize="small", framealpha=0.9, edgecolor="none")
    return ax


def _mode_runs(x: NDArray[np.float64], mode: NDArray[Any]) -> list[tuple[float, float, str]]:
    """Stretches of one mode; they meet half-way, on a logarithmic scale, between the states."""
    order = np.argsort(x)
    x, mode = x[order], mode[order]
    runs = []
    start = x[0]
    for i in range(1, len(x) + 1):
        if i == len(x) or mode[i] != mode[i - 1]:
            end = x[-1] if i == len(x) else math.sqrt(x[i - 1] * x[i])
            runs.append((start, end, str(mode[i - 1])))
            start = end
    return runs


@names_arguments
def modes(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    transitions: Transitions | None = None,
    against: Literal["F_star", "pressure"] = "F_star",
) -> Axes:
    """Contact modes as shaded bands, with the critical loads marked.

    One load curve is drawn with both area shares over the bands. A sweep of several curves
    becomes a chart with one row of bands for each.

    Parameters
    ----------
    data : xarray.Dataset or Equilibrium
        From `sweep` or `solve`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    transitions : Transitions, optional
        From ``tb.transitions(contact)``: marks F_cr1 and F_cr2 where they were found. When
        left out the marks stand half-way between the states that differ in mode.
    against : {"F_star", "pressure"}, optional
        Load on the abscissa. ``transitions`` are loads F*.

    Returns
    -------
    matplotlib.axes.Axes

    Notes
    -----
    p-s: nearly all real contact is on particles; s-s: on asperities; hybrid: on both.

    References
    ----------
    Horng et al. 2022, Fig. 3b, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> debris = tb.Particles(material=steel, diameter=tb.distributions.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> state = tb.solve(contact, F_star=np.geomspace(1e-7, 1e-3, 40))
    >>> ax = tb.plot.modes(state, transitions=tb.transitions(contact))
    >>> ax.get_xscale()
    'log'
    """
    if transitions is not None and against != "F_star":
        raise InvalidValue(
            "plot.modes: transitions are loads F*; leave against = 'F_star'", code=Mistake.BEYOND
        )
    curves = _curves(data)
    if len(curves) > 1:
        return _mode_chart(curves, _axes(ax), against)
    curve = curves[0]
    ax = _axes(ax)
    x = _column(curve, against)
    runs = _mode_runs(x, np.asarray(curve.columns["mode"]))
    _dress(ax, against, "particle_area_share")
    ax.grid(visible=False)
    for start, end, mode in runs:
        if mode in MODE_COLOURS:
            ax.axvspan(start, end, color=MODE_COLOURS[mode], linewidth=0, zorder=0)
            wide = math.log(end / start) > 0.09 * math.log(x.max() / x.min())
            if wide:
                ax.text(math.sqrt(start * end), 1.045, mode, ha="center", va="bottom")
    share = _column(curve, "particle_area_share")
    ax.plot(x, share, color="black", linewidth=1.6, label="particles $A_{sa}/A_t$")
    ax.plot(
        x, 1 - share, color="black", linewidth=1.6, linestyle="--", label=r"asperities $A_{ss}/A_t$"
    )
    for load, name in _critical_loads(x, runs, transitions):
        _mark_load(ax, load, name, value=against == "F_star")
    ax.set_ylabel("Part of the real area [%]")
    _share_axis(ax)
    ax.set_xlim(x.min(), x.max())
    drawn = [name for name in MODES if name in {mode for _, _, mode in runs}]
    handles = [*ax.get_legend_handles_labels()[0], *_mode_key(drawn)]
    _legend_above(ax, handles, ncols=1 + (len(drawn) + 1) // 2, y=1.08)
    return ax


def _critical_loads(
    x: NDArray[np.float64],
    runs: Sequence[tuple[float, float, str]],
    transitions: Transitions | None,
) -> list[tuple[float, str]]:
    """Critical loads inside the figure, as they were found or where the modes meet."""
    marks: list[tuple[float, str]] = []
    if transitions is None:
        borders = [(left[1], left[2], right[2]) for left, right in itertools.pairwise(runs)]
        for load, before, after in borders:
            if (before, after) == ("p-s", "hybrid"):
                marks.append((load, r"$F^*_{cr1}$"))
            elif (before, after) == ("hybrid", "s-s"):
                marks.append((load, r"$F^*_{cr2}$"))
        return marks
    named_loads = (("$F^*_{cr1}$", transitions.F_cr1), ("$F^*_{cr2}$", transitions.F_cr2))
    for name, critical in named_loads:
        if critical.value is not None and x.min() <= critical.value <= x.max():
            marks.append((critical.value, name))
    return marks


def _mark_load(ax: Axes, load: float, name: str, *, value: bool) -> None:
    """A critical load, on the side on which both curves lie at 0 or 100 %."""
    ax.axvline(load, color="0.25", linewidth=0.8, linestyle=":")
    side = -1 if "cr1" in name else 1
    ax.annotate(
        f"{name} = {number(load, 2)}" if value else name,
        (load, 0.5),
        xytext=(3 * side, 0),
        textcoords="offset points",
        rotation=90,
        va="center",
        ha="right" if side < 0 else "left",
        fontsize="small",
    )


def _mode_key(names: Sequence[str]) -> list[Patch]:
    """Key of the colours of the bands of modes."""
    return [Patch(facecolor=MODE_COLOURS[name], edgecolor="0.3", label=name) for name in names]


def _mode_chart(curves: Sequence[Curve], ax: Axes, against: str) -> Axes:
    """One row of bands a curve."""
    for row, curve in enumerate(curves):
        x = _column(curve, against)
        for start, end, mode in _mode_runs(x, np.asarray(curve.columns["mode"])):
            if mode in MODE_COLOURS:
                ax.broken_barh(
                    [(start, end - start)],
                    (row - 0.4, 0.8),
                    facecolors=[MODE_COLOURS[mode]],
                    edgecolor="0.3",
                    linewidth=0.6,
                )
    _dress(ax, against, "mode")
    ax.grid(visible=False)
    ax.set_yticks(range(len(curves)), [curve.label for curve in curves])
    ax.set_ylabel("")
    ax.set_ylim(-0.6, len(curves) - 0.4)
    ax.tick_params(axis="y", length=0)
    every = np.concatenate([_column(curve, against) for curve in curves])
    ax.set_xlim(np.nanmin(every), np.nanmax(every))
    _legend_above(ax, _mode_key(MODES), ncols=3)
    return ax
