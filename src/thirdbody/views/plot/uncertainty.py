"""Bands of uncertain inputs, and which input matters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.ticker import EngFormatter, FuncFormatter, PercentFormatter

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.say import number, percent, value_of
from ..palette import OKABE_ITO, tint
from .style import AXIS_LABELS, SYMBOLS, _axes, _dress, _legend_above, _share_axis

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...analysis.uncertainty.propagation import Propagation

__all__ = ["bands", "tornado"]

BESIDE = 1.2
"""Factor of the load that a marked one keeps off the ends of the axis."""
FAINT = 0.01
"""Share below which a linear axis to 100 % would show nothing but zero."""


# ------------------------------------------------------------------ uncertain inputs
@takes_units
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
    >>> found = tb.propagate(contact, vary={"roughness.sigma": (80e-9, 120e-9)}, samples=64,
    ...                      pressure=np.geomspace(1e6, 1e7, 5), outputs=["A_t"])
    >>> tb.plot.bands(found, "A_t").get_xscale()
    'log'
    """
    if of not in data.bands:
        raise InvalidValue(
            Problem(
                "plot.bands",
                f": {of!r} has no band in the data",
                hint=f"it holds {', '.join(data.bands)}",
                code=Mistake.BEYOND,
            )
        )
    if np.ndim(data.bands[of]) != 2:
        raise InvalidValue(
            Problem(
                "plot.bands",
                f": {of!r} has one band, not one for each load",
                hint="propagate with several loads",
                code=Mistake.SHAPE,
            )
        )
    ax = _axes(ax)
    x, band = np.asarray(data.loads), np.asarray(data.bands[of])
    order = np.argsort(data.probabilities)
    pairs = len(order) // 2
    for k in range(pairs):
        low, high = order[k], order[-1 - k]
        share_of_cases = data.probabilities[high] - data.probabilities[low]
        ax.fill_between(
            x,
            band[:, low],
            band[:, high],
            color=tint(OKABE_ITO["blue"], 0.22 + 0.33 * k / max(pairs - 1, 1)),
            linewidth=0,
            label=f"{percent(share_of_cases)} of cases",
        )
    if len(order) % 2:
        middle = order[pairs]
        name = "median" if data.probabilities[middle] == 0.5 else "middle"
        ax.plot(x, band[:, middle], color=OKABE_ITO["blue"], linewidth=1.6, label=name)
    ax.plot(x, data.nominal[of], color="black", linewidth=1.1, linestyle="--", label="nominal")
    share = of.endswith("_share")
    positive = bool(np.all(band > 0))
    faint = share and _is_faint(band)
    ylog = faint or (positive and not share)
    _dress(ax, data.load, of, xlog=data.load != "d", ylog=ylog)
    if faint:
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, place: number(100 * value, 2)))
    elif share:
        _share_axis(ax)
    if of not in AXIS_LABELS:
        ax.set_ylabel(_output_label(of))
    low, high = x.min(), x.max()
    if mark is not None and data.load != "d" and low <= mark <= high:
        low, high = min(low, mark / BESIDE), max(high, mark * BESIDE)
    ax.set_xlim(low, high)
    if mark is not None:
        ax.axvline(mark, color="0.25", linewidth=1.0, linestyle=":", label="this load")
    ax.legend(fontsize="small", frameon=False)
    return ax


def _is_faint(band: NDArray[Any]) -> bool:
    """Whether shares that are known are all above 0, and too small for a linear axis."""
    finite = band[np.isfinite(band)]
    return bool(finite.size and np.all(finite > 0) and finite.max() < FAINT)


@takes_units
def tornado(
    data: Propagation,
    of: str,
    ax: Axes | None = None,
    *,
    at: int = 0,
    values: Mapping[str, tuple[float, float]] | None = None,
) -> Axes:
    """Effect of each input alone on one result, from its 5th to its 95th percentile.

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
    >>> found = tb.propagate(contact, vary={"roughness.R": (2e-6, 3e-6)}, pressure=1e7,
    ...                      samples=64, outputs=["A_t"])
    >>> [text.get_text() for text in tb.plot.tornado(found, "A_t").get_yticklabels()]
    ['$R$']
    """
    if of not in data.nominal:
        raise InvalidValue(
            Problem(
                "plot.tornado",
                f": {of!r} is not in the data",
                hint=f"it holds {', '.join(data.nominal)}",
                code=Mistake.UNKNOWN,
            )
        )
    rows = data.tornado(of, at=at)[of] if values is None else dict(values)
    middle = float(np.atleast_1d(data.nominal[of])[at if np.ndim(data.nominal[of]) else 0])
    ends = np.array([*rows.values(), (middle, middle)], dtype=float)
    finite = ends[np.isfinite(ends)]
    if not np.isfinite(middle):
        raise InvalidValue(
            f"plot.tornado: {of!r} does not exist for the contact itself", code=Mistake.BEYOND
        )
    log = bool(finite.min() > 0 and finite.max() > 3 * finite.min())
    makes_figure = ax is None
    ax = _axes(ax, (5.8, 1.3 + 0.4 * len(rows)))
    for row, (label, changed) in enumerate(rows.items()):
        _bar(ax, row, changed, middle, _ends_of_input(data, label))
    ax.axvline(middle, color="black", linewidth=1.0)
    _dress(ax, of, "", xlog=log)
    ax.set_xlabel(AXIS_LABELS.get(of, _output_label(of)))
    if of.endswith("_share"):
        ax.xaxis.set_major_formatter(PercentFormatter(1, decimals=0, symbol=""))
    elif of in ("d", "h"):
        ax.xaxis.set_major_formatter(EngFormatter("m"))
        ax.set_xlabel(ax.get_xlabel().removesuffix(" [m]"))
    labels = [fill(_input_label(data, label), LABEL) for label in rows]
    ax.set_yticks(range(len(rows)), labels, fontsize="small", linespacing=1.0)
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.set_ylim(len(rows) - 0.4, -0.6)
    first, last = finite.min(), finite.max()
    if log:
        ax.set_xlim(first * (first / last) ** ROOM, last * (last / first) ** ROOM)
    elif last > first:
        ax.set_xlim(first - ROOM * (last - first), last + ROOM * (last - first))
    handles = [
        Patch(facecolor=colour, edgecolor="white", hatch=hatch, label=name)
        for name, colour, hatch in _ends()
    ]
    if makes_figure:  # over the whole figure: long labels leave little width to the axes
        drawn = ax.get_figure()
        assert drawn is not None
        drawn.legend(
            handles=handles, ncols=2, fontsize="small", frameon=False, loc="outside upper center"
        )
    else:
        _legend_above(ax, handles, ncols=2)
    return ax


def _ends() -> tuple[tuple[str, object, str], ...]:
    """Name, colour and hatch of the part of a bar towards each end of its input."""
    return (
        ("low end of the input", tint(OKABE_ITO["blue"], 0.8), ""),
        ("high end of the input", tint(OKABE_ITO["orange"], 0.8), "////"),
    )


def _ends_of_input(data: Propagation, label: str) -> list[str]:
    """The 5th and the 95th percentile of an input in words."""
    unit = _unit_of(data, label)
    return [value_of(data.inputs[label].quantile(p), unit) for p in (0.05, 0.95)]


def _bar(
    ax: Axes, row: int, ends: tuple[float, float], middle: float, words: Sequence[str]
) -> None:
    """Bar of one input: from the middle to the result at each end, labelled with the end."""
    low, high = ends
    # where both ends lie on one side, the first stands left and the second right all the same
    sides = [-1, 1] if low < high or low == high else [1, -1]
    for value, word, (_, colour, hatch), side in zip(ends, words, _ends(), sides, strict=True):
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
            word,
            (outer, row),
            xytext=(3 * side, 0),
            textcoords="offset points",
            ha="left" if side > 0 else "right",
            va="center",
            fontsize="x-small",
        )


LABEL = 26
"""Characters of a line of the label of a bar."""
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
LETTERS = {"E": "$E$", "nu": r"$\nu$", "H": "$H$"}
"""Numbers of a body that are called by their letter."""


def _output_label(of: str) -> str:
    from ...analysis.uncertainty.propagation import about_result

    about = about_result(of)
    return OUTPUT_LABELS.get(of, f"{about.meaning[:1].upper() + about.meaning[1:]} [{about.unit}]")


def _input_label(data: Propagation, label: str) -> str:
    """Label of an input beside its bar, in symbols where it has one; of joined inputs, of all."""
    from ...analysis.inputs import words_of

    names = [name.strip() for name in label.split("+")]
    sides = {name.rpartition(".")[0]: name.rpartition(".")[2] for name in names}
    if set(sides) <= set(BODIES) and set(sides.values()) <= set(LETTERS):
        bodies = "both surfaces"
        if set(sides) != {"surfaces.first", "surfaces.second"}:
            bodies = " + ".join(BODIES[side] for side in sides)
        return f"{LETTERS[next(iter(sides.values()))]} of {bodies}"
    loads = {"pressure": "pressure", "F_star": "load $F^*$", "d": "separation $d$"}
    if label in loads:
        return loads[label]
    if all(name in SYMBOLS for name in names):
        return " + ".join(SYMBOLS[name][0] for name in names)
    return words_of(data.contact, label)


def _unit_of(data: Propagation, label: str) -> str:
    from ...analysis.inputs import declared_quantity

    loads = {"pressure": "Pa", "F_star": "1", "d": "m"}
    return loads.get(label) or declared_quantity(data.contact, label.split("+")[0].strip())["unit"]
