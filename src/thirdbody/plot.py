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
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import (
    EngFormatter,
    FuncFormatter,
    LogLocator,
    NullFormatter,
    PercentFormatter,
)

from .equilibrium import Equilibrium, solve
from .errors import InvalidValue
from .particles import Particles
from .transitions import Transitions

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    from .contact import Contact
    from .topography import Topography
    from .uncertainty import Propagation

__all__ = [
    "MODE_COLOURS",
    "OKABE_ITO",
    "area",
    "bands",
    "mode_map",
    "modes",
    "regimes",
    "separation",
    "shares",
    "surface",
    "tornado",
]

OKABE_ITO = {
    "black": "#000000",
    "blue": "#0072B2",
    "vermilion": "#D55E00",
    "green": "#009E73",
    "purple": "#CC79A7",
    "sky": "#56B4E9",
    "orange": "#E69F00",
    "yellow": "#F0E442",
}
"""Okabe and Ito's palette (Color Universal Design, 2008)."""

_CYCLE = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")]
_DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2))]


def _tint(colour: str, strength: float) -> tuple[float, float, float]:
    """The colour thinned with white; strength 1 is the colour itself."""
    r, g, b = (1 - strength * (1 - part) for part in to_rgb(colour))
    return (r, g, b)


MODES = ("p-s", "hybrid", "s-s")
MODE_COLOURS = {
    "p-s": _tint(OKABE_ITO["vermilion"], 0.65),
    "hybrid": _tint(OKABE_ITO["yellow"], 0.45),
    "s-s": _tint(OKABE_ITO["sky"], 0.6),
}
"""Fill of each contact mode; they differ in lightness as well as in hue."""

REGIMES = {
    "A_e": ("elastic", OKABE_ITO["sky"]),
    "A_ep": ("elastoplastic", OKABE_ITO["orange"]),
    "A_p": ("plastic", OKABE_ITO["vermilion"]),
}

AXIS_LABELS = {
    "F_star": r"Load $F^* = F/(A_n E_{ss})$ [1]",
    "pressure": r"Nominal pressure $F/A_n$ [Pa]",
    "d": r"Separation from mean asperity height $d$ [m]",
    "h": r"Separation of mean planes $h$ [m]",
    "d_star": r"Separation $d^* = d/\sigma$ [1]",
    "A_t": r"Real contact area $A_t/A_n$ [1]",
    "A_ss": r"Real area of asperities $A_{ss}/A_n$ [1]",
    "A_sa": r"Real area of particles $A_{sa}/A_n$ [1]",
    "particle_load_share": r"Particle load share $F_{sa}/F_t$ [%]",
    "particle_area_share": r"Particle area share $A_{sa}/A_t$ [%]",
}
LOADS = ("F_star", "pressure", "d")
SYMBOLS = {
    "particles.diameter.mean": ("$x_a$", "m"),
    "particles.diameter.median": ("$x_m$", "m"),
    "particles.diameter.std": (r"$\sigma_a$", "m"),
    "particles.areal_density": (r"$\eta_a$", "1/m^2"),
    "roughness.sigma": (r"$\sigma$", "m"),
    "roughness.R": ("$R$", "m"),
    "roughness.alpha": (r"$\alpha$", "1"),
    "particle_law.h_0": ("$h_0$", "m"),
    "particle_law.zeta_mean": (r"$m_\zeta$", "1"),
    "particle_law.zeta_std": (r"$s_\zeta$", "1"),
    "particle_law.seat": ("seat", "1"),
}
"""What a varied input is called in a legend; others keep their dotted name."""
NO_PARTICLES = ("particles.diameter.mean", "particles.areal_density")


class Curve(NamedTuple):
    """One load curve: its legend, its columns by name, and whether it is two-body."""

    label: str
    columns: dict[str, NDArray[Any]]
    two_body: bool


# ------------------------------------------------------------------ reading the argument
def _engineering(value: float, unit: str) -> str:
    """A value with a readable unit, for legends: 3e-7 m is ``300 nm``."""
    if value == 0:
        return "0"
    prefixes = {
        "m": ((1e-3, "mm"), (1e-6, "µm"), (0.0, "nm")),
        "Pa": ((1e9, "GPa"), (1e6, "MPa"), (0.0, "Pa")),
    }
    scales = {"mm": 1e3, "µm": 1e6, "nm": 1e9, "GPa": 1e-9, "MPa": 1e-6, "Pa": 1.0}
    if unit in prefixes:
        name = next(name for start, name in prefixes[unit] if abs(value) >= start * (1 - 1e-9))
        return f"{value * scales[name]:.4g} {name}"
    if unit in ("1/m^2", "1/m²"):
        exponent = math.floor(math.log10(abs(value)) + 1e-9)
        lead = value / 10.0**exponent
        times = "" if abs(lead - 1) < 1e-3 else rf"{lead:.3g} \times "
        return rf"${times}10^{{{exponent}}}$ m$^{{-2}}$"
    return f"{value:.4g}" + ("" if unit in ("", "1") else f" {unit}")


def _legend_entry(name: str, value: Any) -> str:
    symbol, unit = SYMBOLS.get(name, (name, "1"))
    if isinstance(value, (str, np.str_)):
        return f"{symbol}: {value}"
    if isinstance(value, (float, int, np.floating, np.integer)):
        return f"{symbol} = {_engineering(float(value), unit)}"
    return f"{symbol} = {value}"


def _curves(data: xarray.Dataset | Equilibrium) -> list[Curve]:
    """Every load curve in a sweep, or the one curve of an `Equilibrium`."""
    if isinstance(data, Equilibrium):
        columns = {name: np.atleast_1d(column) for name, column in data.columns().items()}
        return [Curve("", columns, bool(np.all(columns["A_sa"] == 0)))]
    if not hasattr(data, "dims") or not hasattr(data, "data_vars"):
        raise InvalidValue(
            f"plot: {type(data).__name__} cannot be drawn; give a Dataset from sweep(...) or an "
            "Equilibrium from solve(...) with several loads"
        )
    load = next((name for name in LOADS if name in data.dims), None)
    if load is None:
        raise InvalidValue(
            f"plot: the Dataset has dimensions {tuple(data.dims)} and none of them is a load "
            f"({', '.join(LOADS)}); select values of the others only, e.g. "
            "data.sel({'particles.diameter.mean': 3e-7})"
        )
    others = [str(name) for name in data.dims if name != load]
    out = []
    for index in itertools.product(*(range(data.sizes[name]) for name in others)):
        one = data.isel(dict(zip(others, index, strict=True)))
        values = [(name, one.coords[name].values[()]) for name in others]
        names = [str(name) for name in (*one.data_vars, *one.coords) if name not in others]
        columns = {name: np.asarray(one[name].values) for name in names}
        shape = columns[load].shape
        columns = {name: column for name, column in columns.items() if column.shape == shape}
        empty = [name for name, value in values if name in NO_PARTICLES and value == 0]
        rest = [(name, value) for name, value in values if name not in NO_PARTICLES]
        parts = ["two bodies"] if empty else [_legend_entry(*pair) for pair in values]
        if empty:
            parts += [_legend_entry(*pair) for pair in rest]
        out.append(Curve(", ".join(parts), columns, bool(empty)))
    return out


def _single(data: xarray.Dataset | Equilibrium, function: str) -> Curve:
    curves = _curves(data)
    if len(curves) != 1:
        raise InvalidValue(
            f"plot.{function} draws one load curve and the Dataset holds {len(curves)}; select "
            "one, e.g. data.isel({'particles.diameter.mean': 0})"
        )
    return curves[0]


# ------------------------------------------------------------------ drawing
def _axes(ax: Axes | None, size: tuple[float, float] = (4.6, 3.4)) -> Axes:
    if ax is not None:
        return ax
    return Figure(figsize=size, dpi=150, layout="constrained").add_subplot()


def _dress(ax: Axes, x: str, y: str, *, xlog: bool = True, ylog: bool = False) -> Axes:
    ax.set_xlabel(AXIS_LABELS.get(x, x))
    ax.set_ylabel(AXIS_LABELS.get(y, y))
    if xlog:
        ax.set_xscale("log")
    if ylog:
        ax.set_yscale("log")
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.grid(visible=True, which="major", color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def _share_axis(ax: Axes) -> None:
    ax.set_ylim(-0.02, 1.02)
    ax.yaxis.set_major_formatter(PercentFormatter(1, symbol=""))


def _styles(curves: Sequence[Curve]) -> list[dict[str, Any]]:
    count = itertools.count()
    styles: list[dict[str, Any]] = []
    for curve in curves:
        if curve.two_body and len(curves) > 1:
            styles.append(dict(color="black", linestyle="-", linewidth=1.0))
            continue
        i = next(count)
        dash = _DASHES[(i + i // len(_CYCLE)) % len(_DASHES)]
        styles.append(dict(color=_CYCLE[i % len(_CYCLE)], linestyle=dash, linewidth=1.6))
    return styles


def _column(curve: Curve, name: str) -> NDArray[np.float64]:
    if name not in curve.columns:
        raise InvalidValue(
            f"plot: {name!r} is not in the data; it holds {', '.join(sorted(curve.columns))}"
        )
    return np.asarray(curve.columns[name], dtype=float)


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


def area(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    against: str = "F_star",
    quantity: str = "A_t",
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
    >>> ax = area(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> ax.get_ylabel()
    'Real contact area $A_t/A_n$ [1]'
    """
    ax = _lines(data, ax, against, quantity, ylog=True, per_load=per_load)
    if per_load:
        name = AXIS_LABELS.get(quantity, quantity).removesuffix(" [1]")
        ax.set_ylabel(f"{name} over load $F^*$ [1]")
        ax.set_yscale("linear")
    return ax


def shares(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    basis: str = "load",
    against: str = "F_star",
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
    >>> debris = tb.Particles(material=steel, diameter=tb.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = shares(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-3, 10)), basis="area")
    >>> ax.get_ylabel()
    'Particle area share $A_{sa}/A_t$ [%]'
    """
    if basis not in ("load", "area"):
        raise InvalidValue(f"plot.shares: basis = {basis!r} must be 'load' or 'area'")
    ax = _lines(data, ax, against, f"particle_{basis}_share", ylog=False)
    _share_axis(ax)
    return ax


def separation(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    quantity: str = "d_star",
    against: str = "F_star",
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
    >>> ax = separation(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> len(ax.lines)
    1
    """
    return _lines(data, ax, against, quantity, ylog=False)


def regimes(
    data: xarray.Dataset | Equilibrium, ax: Axes | None = None, *, against: str = "F_star"
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
    >>> ax = regimes(tb.solve(contact, F_star=np.geomspace(1e-6, 1e-4, 10)))
    >>> [text.get_text() for text in ax.get_legend().get_texts()]
    ['plastic', 'elastoplastic', 'elastic']
    """
    curve = _single(data, "regimes")
    ax = _axes(ax)
    x, total = _column(curve, against), _column(curve, "A_t")
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = [_column(curve, name) / total for name in REGIMES]
    ax.stackplot(
        x,
        parts,
        labels=[name for name, _ in REGIMES.values()],
        colors=[_tint(colour, 0.75) for _, colour in REGIMES.values()],
        edgecolor="white",
        linewidth=0.8,
    )
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


def modes(
    data: xarray.Dataset | Equilibrium,
    ax: Axes | None = None,
    *,
    transitions: Transitions | None = None,
    against: str = "F_star",
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
    p-s: particles alone hold the surfaces apart; s-s: asperities alone carry; hybrid: both.

    References
    ----------
    Horng et al. 2022, Fig. 3b, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> debris = tb.Particles(material=steel, diameter=tb.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> state = tb.solve(contact, F_star=np.geomspace(1e-7, 1e-3, 40))
    >>> ax = modes(state, transitions=tb.transitions(contact))
    >>> ax.get_xscale()
    'log'
    """
    if transitions is not None and against != "F_star":
        raise InvalidValue("plot.modes: transitions are loads F*; leave against = 'F_star'")
    curves = _curves(data)
    if len(curves) > 1:
        return _mode_chart(curves, _axes(ax), against)
    curve = curves[0]
    ax = _axes(ax)
    x = _column(curve, against)
    runs = _mode_runs(x, np.asarray(curve.columns["mode"]))
    marks: list[tuple[float, str]] = []
    if transitions is None:
        borders = [(left[1], left[2], right[2]) for left, right in itertools.pairwise(runs)]
        for load, before, after in borders:
            if (before, after) == ("p-s", "hybrid"):
                marks.append((load, r"$F^*_{cr1}$"))
            elif (before, after) == ("hybrid", "s-s"):
                marks.append((load, r"$F^*_{cr2}$"))
    else:
        found = (("$F^*_{cr1}$", transitions.F_cr1), ("$F^*_{cr2}$", transitions.F_cr2))
        for name, critical in found:
            if critical.value is not None and x.min() <= critical.value <= x.max():
                marks.append((critical.value, name))
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
    for load, name in marks:
        ax.axvline(load, color="0.25", linewidth=0.8, linestyle=":")
        # the side on which both curves lie at 0 or 100 %
        side = -1 if "cr1" in name else 1
        ax.annotate(
            f"{name} = {_scientific(load)}" if against == "F_star" else name,
            (load, 0.5),
            xytext=(3 * side, 0),
            textcoords="offset points",
            rotation=90,
            va="center",
            ha="right" if side < 0 else "left",
            fontsize="small",
        )
    ax.set_ylabel("Part of the real area [%]")
    _share_axis(ax)
    ax.set_xlim(x.min(), x.max())
    ax.legend(
        fontsize="small", frameon=False, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.08)
    )
    return ax


def _scientific(value: float) -> str:
    exponent = math.floor(math.log10(value))
    return rf"${value / 10.0**exponent:.1f}\times10^{{{exponent}}}$"


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
    handles = [Patch(facecolor=MODE_COLOURS[name], edgecolor="0.3", label=name) for name in MODES]
    ax.legend(
        handles=handles,
        ncols=3,
        fontsize="small",
        frameon=False,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
    )
    return ax


def mode_map(
    contact: Contact,
    ratio: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Contact mode over particle size x_a/σ and load F*.

    The size distribution keeps its shape and is scaled, everything else stays as it is; every
    point of the map is a solved state. A dashed line joins the states in which particles and
    asperities share the load equally.

    Parameters
    ----------
    contact : Contact
        With particles.
    ratio : array_like, optional
        Sizes x_a/σ [1]; 200 from 0.1 to 10 when left out.
    F_star : array_like, optional
        Loads F* = F/(A_n E_ss) [1]; 200 from 1e-7 to 1e-3 when left out.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidValue
        A contact without particles, or an empty or negative range.

    Notes
    -----
    States that have no equilibrium, and sizes at which the particles would cover the whole
    nominal area, stay white.

    References
    ----------
    The modes are those of Horng et al. 2022, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> debris = tb.Particles(material=steel, diameter=tb.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = mode_map(contact, ratio=np.geomspace(0.5, 5, 8), F_star=np.geomspace(1e-6, 1e-3, 8))
    >>> ax.get_xlabel()
    'Particle size over roughness $x_a/\\\\sigma$ [1]'
    """
    if contact.two_body or not isinstance(contact.particles, Particles):
        raise InvalidValue(
            "plot.mode_map: the contact has no particles, or several kinds; give one kind"
        )
    sizes = np.geomspace(0.1, 10, 200) if ratio is None else np.asarray(ratio, dtype=float)
    loads = np.geomspace(1e-7, 1e-3, 200) if F_star is None else np.asarray(F_star, dtype=float)
    for name, values in (("ratio", sizes), ("F_star", loads)):
        if values.ndim != 1 or len(values) < 2 or not np.all(np.diff(values) > 0) or values[0] <= 0:
            raise InvalidValue(
                f"plot.mode_map: {name} must be two or more increasing positive numbers [1]"
            )
    index, share = _solved_map(contact, sizes, loads)

    ax = _axes(ax, (4.8, 3.8))
    colours = ListedColormap([MODE_COLOURS[name] for name in MODES])
    ax.pcolormesh(
        sizes,
        loads,
        np.ma.masked_less(index, 0).T,
        cmap=colours,
        norm=BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3),
        shading="nearest",
        rasterized=True,
    )
    for i, name in enumerate(MODES):
        inside = index == i
        if inside.mean() > 0.02:
            text = ax.text(*_middle(inside, sizes, loads), name, ha="center", va="center")
            text.set_path_effects([withStroke(linewidth=4, foreground=MODE_COLOURS[name])])
    if np.nanmin(share) < 0.5 < np.nanmax(share):
        ax.contour(sizes, loads, share.T, [0.5], colors="black", linestyles="--", linewidths=1.2)
        line = Line2D([], [], color="black", linestyle="--", linewidth=1.2)
        ax.legend(
            [line],
            ["equal load on particles and asperities"],
            fontsize="small",
            loc="lower center",
            bbox_to_anchor=(0.5, 1.0),
            frameon=False,
        )
    _dress(ax, "ratio", "F_star", ylog=True)
    ax.grid(visible=False)
    ax.set_xlabel(r"Particle size over roughness $x_a/\sigma$ [1]")
    ax.set_xlim(sizes[0], sizes[-1])
    ax.set_ylim(loads[0], loads[-1])
    return ax


def _solved_map(
    contact: Contact, sizes: NDArray[np.float64], loads: NDArray[np.float64]
) -> tuple[NDArray[np.int_], NDArray[np.float64]]:
    """Index into `MODES` (−1: none) and particle load share, both (sizes, loads)."""
    particles = contact.particles
    assert isinstance(particles, Particles)
    diameter = particles.diameter
    x_a = getattr(diameter, "mean", None) or diameter.mean_diameter
    index = np.full((len(sizes), len(loads)), -1)
    share = np.full(index.shape, np.nan)
    for i, size in enumerate(sizes):
        scaled = diameter.scaled(size * contact.roughness.sigma / x_a)
        try:
            population = particles.replace(diameter=scaled)
        except InvalidValue:  # jammed
            continue
        state = solve(contact.replace(particles=population, outputs=()), F_star=loads)
        mode = np.asarray(state.mode)
        for k, name in enumerate(MODES):
            index[i, mode == name] = k
        share[i] = state.particle_load_share
    return index, share


def _middle(
    inside: NDArray[np.bool_], sizes: NDArray[np.float64], loads: NDArray[np.float64]
) -> tuple[float, float]:
    """The point of a region farthest from its border, in map pixels: where its name goes."""
    from scipy.ndimage import distance_transform_edt

    padded = np.pad(inside, 1)
    depth = np.asarray(distance_transform_edt(padded))[1:-1, 1:-1]
    i, j = np.unravel_index(np.argmax(depth), depth.shape)
    return float(sizes[i]), float(loads[j])


# ------------------------------------------------------------------ uncertain inputs
def bands(
    data: Propagation,
    of: str = "particle_load_share",
    ax: Axes | None = None,
    *,
    mark: float | None = None,
) -> Axes:
    """Bands of one result over the load: half and nine tenths of the samples, and the median.

    Parameters
    ----------
    data : Propagation
        From `propagate` with several loads.
    of : str, optional
        Which output.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    mark : float, optional
        A load to mark.

    Returns
    -------
    matplotlib.axes.Axes

    Notes
    -----
    The bands lie between the outermost quantiles of the data, and between those next to them. The
    dashed line is the contact with its own inputs.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.propagate(contact, {"roughness.sigma": (80e-9, 120e-9)}, samples=64,
    ...                      pressure=np.geomspace(1e6, 1e7, 5), outputs=["A_t"])
    >>> bands(found, "A_t").get_xscale()
    'log'
    """
    if of not in data.bands:
        raise InvalidValue(
            f"plot.bands: {of!r} has no band in the data; it holds {', '.join(data.bands)}"
        )
    if np.ndim(data.bands[of]) != 2:
        raise InvalidValue(
            f"plot.bands: {of!r} has one band, not one for each load; propagate with several loads"
        )
    ax = _axes(ax)
    x, band = np.asarray(data.loads), np.asarray(data.bands[of])
    order = np.argsort(data.probabilities)
    pairs = len(order) // 2
    for k in range(pairs):
        low, high = order[k], order[-1 - k]
        part = data.probabilities[high] - data.probabilities[low]
        ax.fill_between(
            x,
            band[:, low],
            band[:, high],
            color=_tint(OKABE_ITO["blue"], 0.22 + 0.33 * k / max(pairs - 1, 1)),
            linewidth=0,
            label=f"{100 * part:.3g} % of cases",
        )
    if len(order) % 2:
        middle = order[pairs]
        name = "median" if data.probabilities[middle] == 0.5 else "middle"
        ax.plot(x, band[:, middle], color=OKABE_ITO["blue"], linewidth=1.6, label=name)
    ax.plot(x, data.nominal[of], color="black", linewidth=1.1, linestyle="--", label="nominal")
    share = of.endswith("_share")
    _dress(ax, data.load, of, xlog=data.load != "d", ylog=not share and bool(np.all(band > 0)))
    if share:
        _share_axis(ax)
    if of not in AXIS_LABELS:
        ax.set_ylabel(_output_label(of))
    ax.set_xlim(x.min(), x.max())
    if mark is not None:
        ax.axvline(mark, color="0.25", linewidth=1.0, linestyle=":", label="this load")
    ax.legend(fontsize="small", frameon=False)
    return ax


def tornado(
    data: Propagation,
    of: str,
    ax: Axes | None = None,
    *,
    at: int = 0,
    values: Mapping[str, tuple[float, float]] | None = None,
) -> Axes:
    """What each input does alone to one result, from its 5th to its 95th percentile.

    Parameters
    ----------
    data : Propagation
        From `propagate`.
    of : str
        Which output. A logarithmic axis where it changes more than threefold.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.
    at : int, optional
        Number of the load, where several were given.
    values : mapping, optional
        ``data.tornado(of)[of]``, where it is at hand.

    Returns
    -------
    matplotlib.axes.Axes
        One bar an input, the strongest on top: the part towards the low end of the input is
        blue, towards the high end orange and hatched. The ends of the input stand beside.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.propagate(contact, {"roughness.R": (2e-6, 3e-6)}, pressure=1e7,
    ...                      samples=64, outputs=["A_t"])
    >>> [text.get_text() for text in tornado(found, "A_t").get_yticklabels()]
    ['$R$']
    """
    if of not in data.nominal:
        raise InvalidValue(
            f"plot.tornado: {of!r} is not in the data; it holds {', '.join(data.nominal)}"
        )
    rows = data.tornado(of, at=at)[of] if values is None else dict(values)
    middle = float(np.atleast_1d(data.nominal[of])[at if np.ndim(data.nominal[of]) else 0])
    ends = np.array([*rows.values(), (middle, middle)], dtype=float)
    known = ends[np.isfinite(ends)]
    if not np.isfinite(middle):
        raise InvalidValue(f"plot.tornado: {of!r} does not exist for the contact itself")
    log = bool(known.min() > 0 and known.max() > 3 * known.min())
    ax = _axes(ax, (5.4, 1.3 + 0.36 * len(rows)))
    styles = (
        ("low end of the input", _tint(OKABE_ITO["blue"], 0.8), ""),
        ("high end of the input", _tint(OKABE_ITO["orange"], 0.8), "////"),
    )
    for row, (label, (low, high)) in enumerate(rows.items()):
        input_ends = [data.inputs[label].at(p) for p in (0.05, 0.95)]
        # where both ends lie on one side, the first stands left and the second right all the same
        sides = [-1, 1] if low < high or low == high else [1, -1]
        each = zip((low, high), input_ends, styles, sides, strict=True)
        for value, end, (_, colour, hatch), side in each:
            if not np.isfinite(value):
                continue
            ax.barh(
                row,
                value - middle,
                left=middle,
                height=0.62,
                color=colour,
                edgecolor="white",
                hatch=hatch,
                linewidth=0.0,
            )
            outer = max(value, middle) if side > 0 else min(value, middle)
            ax.annotate(
                _engineering(end, _unit_of(data, label)),
                (outer, row),
                xytext=(3 * side, 0),
                textcoords="offset points",
                ha="left" if side > 0 else "right",
                va="center",
                fontsize="x-small",
            )
    ax.axvline(middle, color="black", linewidth=1.0)
    _dress(ax, of, "", xlog=log)
    ax.set_xlabel(AXIS_LABELS.get(of, _output_label(of)))
    if of.endswith("_share"):
        ax.xaxis.set_major_formatter(PercentFormatter(1, decimals=0, symbol=""))
    elif of in ("d", "h"):
        ax.xaxis.set_major_formatter(EngFormatter("m"))
        ax.set_xlabel(ax.get_xlabel().removesuffix(" [m]"))
    ax.set_yticks(range(len(rows)), [_input_label(label) for label in rows])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.set_ylim(len(rows) - 0.4, -0.6)
    # room for what stands beside the bars
    first, last = known.min(), known.max()
    if log:
        ax.set_xlim(first * (first / last) ** ROOM, last * (last / first) ** ROOM)
    elif last > first:
        ax.set_xlim(first - ROOM * (last - first), last + ROOM * (last - first))
    handles = [
        Patch(facecolor=colour, edgecolor="white", hatch=hatch, label=name)
        for name, colour, hatch in styles
    ]
    ax.legend(
        handles=handles,
        ncols=2,
        fontsize="small",
        frameon=False,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
    )
    return ax


ROOM = 0.45
"""Width beside the longest bars of a tornado, over theirs."""
OUTPUT_LABELS = {
    "F_cr1": r"Critical load $F^*_{cr1}$ [1]",
    "F_cr2": r"Critical load $F^*_{cr2}$ [1]",
    "F_tpca.A": r"Load of the largest area share $F^*_{tpca}$ [1]",
    "F_tpca.B": r"Load of equal load shares $F^*_{tpca}$ [1]",
    "F/F_cr1": r"Load over the first critical load $F/F_{cr1}$ [1]",
    "F/F_cr2": r"Load over the second critical load $F/F_{cr2}$ [1]",
    "plastic_share": r"Plastic part of the real area $A_p/A_t$ [%]",
}
BODIES = {
    "surfaces.first": "surface 1",
    "surfaces.second": "surface 2",
    "particles.material": "particles",
}


def _output_label(of: str) -> str:
    from .uncertainty import about_result

    about = about_result(of)
    meaning = about["meaning"]
    return OUTPUT_LABELS.get(of, f"{meaning[:1].upper() + meaning[1:]} [{about['unit']}]")


def _input_label(label: str) -> str:
    """What an input is called beside its bar; of several that move together, of all."""
    names = [name.strip() for name in label.split("+")]
    sides = {name.rpartition(".")[0]: name.rpartition(".")[2] for name in names}
    if set(sides) <= set(BODIES):
        bodies = "both surfaces"
        if set(sides) != {"surfaces.first", "surfaces.second"}:
            bodies = " + ".join(BODIES[side] for side in sides)
        letter = next(iter(sides.values()))
        symbol = {"E": "$E$", "nu": r"$\nu$", "H": "$H$"}.get(letter, letter)
        return f"{symbol} of {bodies}"
    loads = {"pressure": "pressure", "F_star": "load $F^*$", "d": "separation $d$"}
    return loads.get(label) or " + ".join(SYMBOLS.get(name, (name, ""))[0] for name in names)


def _unit_of(data: Propagation, label: str) -> str:
    from .sensitivities import declared

    loads = {"pressure": "Pa", "F_star": "1", "d": "m"}
    return loads.get(label) or declared(data.contact, label.split("+")[0].strip())["unit"]


# ------------------------------------------------------------------ a measured surface
def surface(topography: Topography) -> Figure:
    """A measured surface and what its asperities owe to the cut-off, in six panels.

    Parameters
    ----------
    topography : Topography
        From `thirdbody.surfaces.from_topography`.

    Returns
    -------
    matplotlib.figure.Figure
        Heights; power spectrum; gradient, radius and density against the cut-off, by differences,
        by the spectrum, and counted; heights of the summits.

    Examples
    --------
    >>> from thirdbody.surfaces import from_topography
    >>> len(surface(from_topography("example")).axes)  # the colour bar is one
    7
    """
    drawing = Figure(figsize=(10.5, 6.2), dpi=150, layout="constrained")
    panels = drawing.subplots(2, 3)
    _heights_panel(topography, panels[0, 0])
    _spectrum_panel(topography, panels[0, 1])
    _cutoff_panels(topography, [panels[0, 2], panels[1, 0], panels[1, 1]])
    _summits_panel(topography, panels[1, 2])
    for letter, ax in zip("abcdef", panels.flat, strict=True):
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
    return drawing


def _length_scale(largest: float) -> tuple[float, str]:
    return next(
        (size, unit)
        for size, unit in ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"), (0.0, "nm"))
        if largest >= 0.3 * size
    )


def _heights_panel(topography: Topography, ax: Axes) -> None:
    across, unit = _length_scale(max(topography.size))
    z = topography.heights
    tall, unit_z = _length_scale(float(np.nanmax(np.abs(z))) or 1e-9)
    if topography.dim == 1:
        x = np.arange(len(z)) * topography.spacing[0]
        ax.plot(x / across, z / tall, color=_tint(OKABE_ITO["blue"], 0.6), linewidth=0.8)
        ax.plot(x / across, topography.filtered() / tall, color="black", linewidth=0.8)
        _dress(ax, f"$x$ [{unit}]", f"Height $z$ [{unit_z}]", xlog=False)
        ax.legend(["as sampled", "above the cut-off"], frameon=False, fontsize="small")
        ax.margins(x=0, y=0.15)
        return
    width, height = (side / across for side in topography.size)
    low, high = np.nanpercentile(z / tall, [0.5, 99.5])
    image = ax.imshow(
        z.T / tall,
        origin="lower",
        extent=(0, width, 0, height),
        cmap="cividis",
        vmin=low,
        vmax=high,
        interpolation="nearest",
    )
    assert ax.figure is not None
    ax.figure.colorbar(image, ax=ax, label=f"Height $z$ [{unit_z}]", extend="both", shrink=0.85)
    ax.set_facecolor(OKABE_ITO["vermilion"])
    ax.set_xlabel(f"$x$ [{unit}]")
    ax.set_ylabel(f"$y$ [{unit}]")


def _mark_cutoff(topography: Topography, ax: Axes, scale: float) -> list[Any]:
    """Grey where data do not stand for the surface; lines at the cut-off used and the limit."""
    left, right = ax.get_xlim()
    grey = ax.axvspan(left, topography.recommended[0] / scale, color="0.92", zorder=0)
    grey.set_label("not recommended")
    marks: list[Any] = [grey]
    if topography.limit is not None:
        colour = _tint(OKABE_ITO["purple"], 0.6)
        line = ax.axvline(topography.limit / scale, color=colour, linewidth=3.0)
        line.set_label("instrument's limit")
        marks.append(line)
    if topography.cutoff > 0:
        line = ax.axvline(topography.cutoff / scale, color="black", linestyle="--", linewidth=1.0)
        line.set_label("cut-off used")
        marks.append(line)
    ax.set_xlim(left, right)
    return marks


def _few_ticks(ax: Axes) -> None:
    """Numbers inside the decades of a logarithmic axis that spans less than two."""
    for axis, (low, high) in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        axis.set_minor_formatter(NullFormatter())
        if high / low < 100:
            axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high > 6 * low else range(1, 10)))
            if 1e-3 <= low and high < 1e4:
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            else:
                axis.set_major_formatter(FuncFormatter(lambda value, _: _scientific(value)))


def _spectrum_panel(topography: Topography, ax: Axes) -> None:
    wavelength, density = topography.psd()
    scale, unit = _length_scale(float(wavelength[len(wavelength) // 2]))
    seen = density > 0
    ax.plot(wavelength[seen] / scale, density[seen], color=OKABE_ITO["blue"], linewidth=1.6)
    power = "4" if topography.dim == 2 else "3"
    _dress(ax, f"Wavelength [{unit}]", f"Power spectral density $C$ [m$^{power}$]", ylog=True)
    top = float(density.max())
    low, high = ax.get_ylim()
    ax.set_ylim(max(low, 1e-16 * top), high)
    marks = _mark_cutoff(topography, ax, scale)
    ax.legend(handles=marks, frameon=False, fontsize="small", loc="lower right")


def _cutoff_panels(topography: Topography, axes: Sequence[Axes]) -> None:
    from .spectral import SpectralMoments

    curve = topography.curve()
    spectral = [
        SpectralMoments(m0=m0, m2=m2, m4=m4)
        for m0, m2, m4 in zip(
            *(curve[f"{name}_spectrum"] for name in ("m0", "m2", "m4")), strict=True
        )
    ]
    scale, unit = _length_scale(float(np.median(curve["cutoff"])))
    R_scale, R_unit = _length_scale(float(np.median(curve["R"])))
    labels = {
        "rms_gradient": ("RMS gradient [1]", 1.0),
        "R": (f"Mean asperity radius $R$ [{R_unit}]", R_scale),
        "eta": (r"Asperity density $\eta$ [m$^{-2}$]", 1.0),
    }
    x = curve["cutoff"] / scale
    for ax, (name, (label, by)) in zip(axes, labels.items(), strict=True):
        ax.plot(x, curve[name] / by, color=OKABE_ITO["blue"], label="differences")
        values = np.array([getattr(one, name) for one in spectral])
        ax.plot(x, values / by, color=OKABE_ITO["vermilion"], linestyle="--", label="spectrum")
        counted = curve.columns.get(f"{name}_counted")
        if counted is not None and np.isfinite(counted).any():
            ax.plot(
                x,
                counted / by,
                color=OKABE_ITO["green"],
                linestyle="none",
                marker="o",
                markersize=4,
                markerfacecolor="none",
                label="summits counted",
            )
        _dress(ax, rf"Cut-off wavelength $\lambda_c$ [{unit}]", label, ylog=True)
        shown, names = ax.get_legend_handles_labels()
        ax.legend(shown, names, frameon=False, fontsize="small")
        _mark_cutoff(topography, ax, scale)
        _few_ticks(ax)


def _summits_panel(topography: Topography, ax: Axes) -> None:
    summits, moments = topography.summits, topography.moments
    map_ = topography.dim == 2
    heights = summits.heights if map_ else topography.filtered()
    heights = heights[np.isfinite(heights)]
    scale, unit = _length_scale(float(np.max(np.abs(heights), initial=1e-9)))
    mean, std = (moments.y_s, moments.sigma_s) if map_ else (0.0, moments.sigma)
    what = "summits counted" if map_ else "heights of the profile"
    law = "Nayak, Gaussian" if map_ else "Gaussian of the same RMS"
    bins = max(8, min(40, int(1.5 * len(heights) ** 0.5)))
    ax.hist(
        heights / scale,
        bins=bins,
        density=True,
        color=_tint(OKABE_ITO["green"], 0.4),
        label=f"{what} ({len(heights)})",
    )
    low, high = min(heights.min(), mean - 3.5 * std), max(heights.max(), mean + 3.5 * std)
    z = np.linspace(low, high, 300)
    density = np.exp(-0.5 * ((z - mean) / std) ** 2) / (std * math.sqrt(2 * math.pi))
    ax.plot(z / scale, density * scale, color="black", linewidth=1.2, label=law)
    _dress(ax, f"Height above the mean plane [{unit}]", f"Density [1/{unit}]", xlog=False)
    ax.set_ylim(0, 1.3 * ax.get_ylim()[1])
    ax.legend(frameon=False, fontsize="small")
