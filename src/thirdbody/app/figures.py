"""Figures for Plotly as plain data: one look, the colours of `thirdbody.plot`, light and dark."""

from __future__ import annotations

import html
import re
import textwrap
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Literal, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ..quantities.plain_data import plain_data
from ..views.palette import MODE_COLOURS, OKABE_ITO, REGIMES

__all__ = [
    "AXES",
    "CONFIG",
    "DASHES",
    "GREY",
    "INKS",
    "MODE_FILLS",
    "REGIME_FILLS",
    "SCALES",
    "Figure",
    "Part",
    "band",
    "empty",
    "escape_tags",
    "figure",
    "fix",
    "json_numbers",
    "line",
    "log_title",
    "mark",
    "mode_bands",
    "span",
    "symbol",
    "upper_decades",
    "wrap_text",
]

INKS = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")]
DASHES = ["solid", "dash", "dashdot", "dot", "longdash", "longdashdot"]
AXES = {
    "F_star": "load F* = F/(A<sub>n</sub> E<sub>ss</sub>)",
    "pressure": "nominal pressure [MPa]",
    "d": "separation d [m]",
}
"""What loads are called, by the arguments of `tb.solve`."""
SCALES = {"pressure": 1e-6}
"""What loads are drawn in is so much of their SI unit."""
GREY, CLEAR = "#7f7f7f", "rgba(0,0,0,0)"
CONFIG: dict[str, object] = {
    "displaylogo": False,
    "responsive": False,
    "modeBarButtonsToRemove": ["select2d", "lasso2d"],
}


Part = dict[str, object]
"""A curve, a shape, a note or an axis, as Plotly takes it."""


class Extras(TypedDict, total=False):
    """What a figure may be told besides its axes."""

    hovermode: str
    barmode: str
    shapes: list[Part]
    annotations: list[Part]


class Layout(Extras, total=False):
    """What stands around the curves of a figure."""

    title: Part
    xaxis: Part
    yaxis: Part
    margin: Part
    height: int
    paper_bgcolor: str
    plot_bgcolor: str
    font: Part
    legend: Part
    showlegend: bool


class Figure(TypedDict):
    """A figure as Plotly takes it."""

    data: list[Part]
    layout: Layout
    config: Part


def _rgb(colour: Iterable[float]) -> str:
    return "rgb(" + ",".join(str(round(255 * channel)) for channel in colour) + ")"


MODE_FILLS = {name: _rgb(colour) for name, colour in MODE_COLOURS.items()}
REGIME_FILLS = {name: (label, colour) for name, (label, colour) in REGIMES.items()}


def escape_tags(text: str) -> str:
    """A text of a study for Plotly, which reads tags in names, titles and categories.

    >>> escape_tags("a<b>c</b> & d")
    'a&lt;b&gt;c&lt;/b&gt; &amp; d'
    """
    # %{...} stands for a variable there
    return html.escape(text, quote=False).replace("%{", "%&#123;")


def wrap_text(text: str, wide: int) -> str:
    """A text for Plotly in lines of so many characters."""
    return "<br>".join(map(escape_tags, textwrap.wrap(text, wide)))


def symbol(text: str) -> str:
    """A symbol for Plotly, its subscripts set.

    >>> symbol("A_t/A_n"), symbol("⟨δ_res⟩,1")
    ('A<sub>t</sub>/A<sub>n</sub>', '⟨δ<sub>res</sub>⟩,1')
    """
    return re.sub(r"_([^\s/()⟩]+)", r"<sub>\1</sub>", escape_tags(text))


def figure(
    data: list[Part],
    *,
    x: str,
    y: str,
    title: str = "",
    xlog: bool = True,
    ylog: bool = False,
    height: int = 360,
    **more: Unpack[Extras],
) -> Figure:
    """Traces with axes; text and grid take their colours from the page."""
    layout: Layout = {
        "title": {"text": title, "font": {"size": 15}, "x": 0.02, "xanchor": "left"},
        "xaxis": _axis(data, "x", x, xlog),
        "yaxis": _axis(data, "y", y, ylog),
        "margin": {"l": 60, "r": 16, "t": 44, "b": 84},
        "height": height,
        "paper_bgcolor": CLEAR,
        "plot_bgcolor": CLEAR,
        "font": {"color": GREY, "size": 12},
        "legend": {"orientation": "h", "yref": "container", "y": 0.0, "yanchor": "bottom", "x": 0},
        "hovermode": "x unified",
        "showlegend": True,
        "shapes": [],
        "annotations": [],
    }
    made: Figure = {"data": data, "layout": {**layout, **more}, "config": CONFIG}
    curves = [trace["y"] for trace in data if trace.get("type") == "scatter" and trace.get("y")]
    if ylog and len(curves) == len(data):
        fix(made, "yaxis", span(upper_decades(curves), log=True))
    return made


def _axis(data: list[Part], name: str, text: str, log: bool) -> Part:
    title: Part = {"text": text, "font": {"size": 13}}
    return {
        "gridcolor": "rgba(127,127,127,0.25)",
        "zeroline": False,
        "automargin": True,
        "title": title if name == "x" else title | {"standoff": 10},
        "type": "log" if log else "linear",
        "exponentformat": "power",
    } | (_decades(data, name) if log else {})


FOLLOWED = 6
"""Decades below the largest value of a curve over which an axis follows it."""
NEGLIGIBLE = 1e-12
"""Of the largest value of a figure: what is less is not looked for."""
TICKS = ((1.0, (1, 2, 5)), (0.6, (1, 2, 3, 4, 6, 8)))
"""Ticks inside a decade of axes that are wider than so many decades."""


def _decades(data: list[Part], name: str) -> Part:
    """Ticks of a logarithmic axis: powers of ten alone where the traces reach over two or so."""
    arrays = [_array(trace[name]) for trace in data if trace.get(name) is not None]
    every = upper_decades(arrays) if name == "y" else np.concatenate([*arrays, [np.nan]])
    every = every[np.isfinite(every) & (every > 0)]
    wide = float(np.log10(every.max() / every.min())) if every.size else 0.0
    if wide > 1.9:  # the browser writes powers a quarter larger than other numbers
        return {"dtick": 1 if wide < 8 else 2, "tickfont": {"size": 10}}
    digits = next((inside for least, inside in TICKS if wide > least), ())
    if not digits:
        return {}
    first, last = int(np.floor(np.log10(every.min()))), int(np.floor(np.log10(every.max())))
    ticks = [(digit, power) for power in range(first - 1, last + 2) for digit in digits]
    return {
        "tickmode": "array",
        "tickvals": [float(f"{digit}e{power}") for digit, power in ticks],
        "ticktext": [_tick(digit, power) for digit, power in ticks],
    }


def _tick(digit: int, power: int) -> str:
    """A number of one digit, as people write it.

    >>> _tick(2, -1), _tick(5, 3), _tick(1, -6), _tick(2, 11)
    ('0.2', '5000', '10<sup>−6</sup>', '2×10<sup>11</sup>')
    """
    if -3 <= power <= 3:
        return f"{float(f'{digit}e{power}'):g}"
    return (f"{digit}×" if digit > 1 else "") + f"10<sup>{power}</sup>".replace("-", "−")


def band(x0: float, x1: float, colour: str, opacity: float, *, xref: str = "x") -> Part:
    """A rectangle over the whole height of a figure, between two places of its axis."""
    return {
        "type": "rect",
        "xref": xref,
        "yref": "paper",
        "x0": x0,
        "x1": x1,
        "y0": 0,
        "y1": 1,
        "fillcolor": colour,
        "opacity": opacity,
        "line": {"width": 0},
    }


def empty(height: int) -> Figure:
    """A place for a figure: a grey field without axes that says so."""
    hidden = {"visible": False, "fixedrange": True}
    layout: Layout = {
        "height": height,
        "xaxis": {**hidden},
        "yaxis": {**hidden},
        "margin": {"l": 16, "r": 16, "t": 16, "b": 16},
        "paper_bgcolor": CLEAR,
        "plot_bgcolor": CLEAR,
        "shapes": [band(0, 1, GREY, 0.1, xref="paper")],
        "annotations": [
            {"text": "not drawn yet", "xref": "paper", "yref": "paper", "x": 0.5, "y": 0.5}
            | {"showarrow": False, "font": {"size": 13}}
        ],
    }
    return {"data": [], "layout": layout, "config": CONFIG | {"staticPlot": True}}


def _array(values: object) -> np.ndarray:
    """Numbers of a curve, NaN where there is none."""
    return np.array(values, float)


def upper_decades(curves: Iterable[object]) -> np.ndarray:
    """What matters of curves on a logarithmic axis: the upper decades of each.

    A curve that dies out has no end: the axis follows each over `FOLLOWED` decades below its
    largest value, and none below `NEGLIGIBLE` of the largest of all.

    >>> upper_decades([[1.0, 1e-3, 1e-56], [1e-9, 1e-8]]).tolist()
    [1.0, 0.001, 1e-09, 1e-08]
    """
    every = [_array(curve).ravel() for curve in curves]
    positive = [curve[np.isfinite(curve) & (curve > 0)] for curve in every]
    positive = [curve for curve in positive if curve.size]
    if not positive:
        return np.empty(0)
    least = NEGLIGIBLE * max(curve.max() for curve in positive)
    kept = [c[c >= max(least, c.max() / 10.0**FOLLOWED)] for c in positive]
    return np.concatenate(kept)


def json_numbers(values: ArrayLike) -> list[float | None]:
    """Numbers for JSON, None where there is none."""
    numbers: list[float | None] = plain_data(np.atleast_1d(np.asarray(values, dtype=float)))
    return numbers


def span(values: ArrayLike, *, log: bool = False, padded: bool = True) -> list[float] | None:
    """The range of an axis over these values; None where there is none.

    Ends are round, so that an axis stays as it is while a slider moves, or those of the values.

    >>> span([0.3, 4.2]), span([0.1, 100.0], log=True, padded=False)
    ([0.0, 5.0], [-1.0, 2.0])
    """
    finite = np.asarray(values, float).ravel()
    finite = finite[np.isfinite(finite) & ((finite > 0) | (not log))]
    if not finite.size:
        return None
    low, high = float(finite.min()), float(finite.max())
    if log:
        if not padded:
            return [float(np.log10(low)), float(np.log10(high))] if low < high else None
        ends = [np.floor(3 * np.log10(low)), np.ceil(3 * np.log10(high))]
        return [float(ends[0]) / 3, float(ends[1] + (ends[0] == ends[1])) / 3]
    if not low < high:
        return None
    if not padded:
        return [low, high]
    step = 10.0 ** np.floor(np.log10(high - low))
    step *= 0.5 if high - low < 3 * step else 1.0
    return [float(np.floor(low / step) * step), float(np.ceil(high / step) * step)]


def fix(made: Figure, axis: Literal["xaxis", "yaxis"], ends: list[float] | None) -> None:
    """Set the range of an axis of a figure."""
    if ends is not None:
        made["layout"][axis]["range"] = ends


def line(
    x: ArrayLike,
    y: ArrayLike,
    name: str,
    number: int = 0,
    *,
    line: Mapping[str, object] = MappingProxyType({}),
    **more: object,
) -> Part:
    """One curve, told apart by colour and dash."""
    dash = DASHES[(number + number // 6) % 6]
    return {
        "type": "scatter",
        "mode": "lines",
        "x": json_numbers(x),
        "y": json_numbers(y),
        "name": name,
        "line": {"color": INKS[number % 6], "dash": dash, "width": 2.2, **line},
        **more,
    }


def mark(x: float, text: str, *, number: int = 0, dash: str = "dot") -> tuple[Part, Part]:
    """A vertical line with a word above it: a shape and an annotation."""
    shape = {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": x,
        "x1": x,
        "y0": 0,
        "y1": 1,
        "line": {"color": GREY, "width": 1.6, "dash": dash},
    }
    note = {
        "x": x,
        "y": 1.0,
        "xref": "x",
        "yref": "paper",
        "text": text,
        "showarrow": False,
        "yanchor": "bottom",
        "yshift": 1 + 13 * (number % 2),
        "font": {"size": 11},
    }
    return shape, note


def log_title(note: Part) -> Part:
    """Annotations count in powers of ten on a logarithmic axis, other than shapes."""
    return note | {"x": float(np.log10(_array(note["x"])))}


def mode_bands(x: ArrayLike, modes: ArrayLike) -> list[Part]:
    """Rectangles behind the curves, one for each run of a mode."""
    x, modes = np.asarray(x, float), np.asarray(modes)
    starts = np.flatnonzero(np.concatenate([[True], modes[1:] != modes[:-1]]))
    ends = [*starts[1:], len(x)]
    return [
        band(float(x[a]), float(x[min(b, len(x) - 1)]), MODE_FILLS[str(modes[a])], 0.32)
        | {"layer": "below"}
        for a, b in zip(starts, ends, strict=True)
        if str(modes[a]) in MODE_FILLS
    ]
