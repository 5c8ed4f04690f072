"""Colours, labels, axes and curves that the figures share."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation, PercentFormatter

from ...equilibrium.columns import Equilibrium
from ...errors import InvalidValue, Mistake
from ...quantities.say import SUPERSCRIPTS, value_of
from ..palette import MODE_COLOURS, OKABE_ITO

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

__all__ = ["MODE_COLOURS", "OKABE_ITO"]

_CYCLE = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")]
_DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2))]

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
    "particle_law.friction_factor": ("$m_f$", "1"),
}
"""What a varied input is called in a legend; others keep their dotted name."""
NO_PARTICLES = ("particles.diameter.mean", "particles.areal_density")


class Curve(NamedTuple):
    """One load curve: legend, columns by name, and whether it is two-body."""

    label: str
    columns: dict[str, NDArray[Any]]
    two_body: bool


# ------------------------------------------------------------------ reading the argument
def _legend_entry(name: str, value: object) -> str:
    symbol, unit = SYMBOLS.get(name, (name, "1"))
    if isinstance(value, (str, np.str_)):
        return f"{symbol}: {value}"
    if isinstance(value, (float, int, np.floating, np.integer)):
        return f"{symbol} = {value_of(float(value), unit)}"
    return f"{symbol} = {value}"


def _curves(data: xarray.Dataset | Equilibrium) -> list[Curve]:
    """Every load curve in a sweep, or the one curve of an `Equilibrium`."""
    if isinstance(data, Equilibrium):
        columns = {name: np.atleast_1d(column) for name, column in data.columns().items()}
        return [Curve("", columns, bool(np.all(columns["A_sa"] == 0)))]
    if not hasattr(data, "dims") or not hasattr(data, "data_vars"):
        raise InvalidValue(
            f"plot: {type(data).__name__} cannot be drawn; give a Dataset from sweep(...) or an "
            "Equilibrium from solve(...) with several loads",
            code=Mistake.BEYOND,
        )
    load = next((name for name in LOADS if name in data.dims), None)
    if load is None:
        raise InvalidValue(
            f"plot: the Dataset has dimensions {tuple(data.dims)} and none of them is a load "
            f"({', '.join(LOADS)}); select values of the others only, e.g. "
            "data.sel({'particles.diameter.mean': 3e-7})",
            code=Mistake.CLASH,
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


# ------------------------------------------------------------------ drawing
def _axes(ax: Axes | None, size: tuple[float, float] = (4.6, 3.4)) -> Axes:
    if ax is not None:
        return ax
    return Figure(figsize=size, dpi=150, layout="constrained").add_subplot()


LEAST_NUMBERS, SPARSE, DENSE = 3, 1.5, 0.4
"""Numbers that a logarithmic axis has at least; decades beyond which two powers of ten are enough,
and below which all numbers have room."""


class PlainPowers(LogFormatterSciNotation):
    """Powers of ten in plain letters, 10⁻⁵: drawn far quicker than as formulas."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        formula = super().__call__(x, pos)
        raised = re.sub(r"\^\{([^}]*)\}", lambda m: m[1].translate(SUPERSCRIPTS), formula)
        return re.sub(r"\$|\\mathdefault|[{}]", "", raised).replace(r"\times", "×")


class FewPowers(PlainPowers):
    """Numbers between powers of ten, so many that an axis has three, and that they stand apart.

    None where two powers of ten stand on more than one and a half decades; else 2 and 5, or, where
    these are too few, more of them.
    """

    def __init__(self) -> None:
        super().__init__(labelOnlyBase=False, minor_thresholds=(math.inf, math.inf))

    def __call__(self, x: float, pos: int | None = None) -> str:
        low, high = sorted(self.axis.get_view_interval())  # type: ignore[union-attr]
        if not 0 < low < high < math.inf or x <= 0:
            return super().__call__(x, pos)
        decades, powers = math.log10(high / low), _powers(low, high)
        if decades > SPARSE and sum(low <= power <= high for power in powers) > 1:
            return ""
        usual = [lead * p for p in powers for lead in (1, 2, 5) if low <= lead * p <= high]
        leads = (2, 5) if len(usual) >= LEAST_NUMBERS else (2, 3, 4, 6)
        lead = x / 10.0 ** math.floor(math.log10(x) + 1e-9)
        near = any(math.isclose(lead, label_lead, rel_tol=1e-6) for label_lead in leads)
        return super().__call__(x, pos) if near or decades < DENSE else ""


def _powers(low: float, high: float) -> list[float]:
    """Powers of ten from the one below to the one above."""
    if not 0 < low <= high < math.inf:
        return []
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    return [10.0**k for k in range(first, last + 1)]


def plain_powers(axis: Axis) -> None:
    """The numbers of a logarithmic axis in plain letters."""
    axis.set_major_formatter(PlainPowers())
    axis.set_minor_formatter(FewPowers())


def _dress(ax: Axes, x: str, y: str, *, xlog: bool = True, ylog: bool = False) -> Axes:
    ax.set_xlabel(AXIS_LABELS.get(x, x))
    ax.set_ylabel(AXIS_LABELS.get(y, y))
    if xlog:
        ax.set_xscale("log")
        plain_powers(ax.xaxis)
    if ylog:
        ax.set_yscale("log")
        plain_powers(ax.yaxis)
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.grid(visible=True, which="major", color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def _share_axis(ax: Axes) -> None:
    ax.set_ylim(-0.02, 1.02)
    ax.yaxis.set_major_formatter(PercentFormatter(1, symbol=""))


def _legend_above(ax: Axes, handles: Sequence[Artist], *, ncols: int = 1, y: float = 1.0) -> None:
    """A legend over the figure, where it hides no curve; ``y`` in the height of the axes."""
    ax.legend(
        handles=handles,
        ncols=ncols,
        fontsize="small",
        frameon=False,
        loc="lower center",
        bbox_to_anchor=(0.5, y),
    )


def _styles(curves: Sequence[Curve]) -> list[dict[str, Any]]:
    count = itertools.count()
    styles: list[dict[str, object]] = []
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
            f"plot: {name!r} is not in the data; it holds {', '.join(sorted(curve.columns))}",
            code=Mistake.UNKNOWN,
        )
    return np.asarray(curve.columns[name], dtype=float)
