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
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import PercentFormatter

from .equilibrium import Equilibrium, solve
from .errors import InvalidValue
from .particles import Particles
from .transitions import Transitions

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    from .contact import Contact

__all__ = [
    "MODE_COLOURS",
    "OKABE_ITO",
    "area",
    "mode_map",
    "modes",
    "regimes",
    "separation",
    "shares",
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
        names = {str(name) for name in (*one.data_vars, *one.coords)} - set(others)
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
        raise InvalidValue("plot.mode_map needs one population of particles in Contact.particles")
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
        state = solve(contact.replace(particles=population), F_star=loads)
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
