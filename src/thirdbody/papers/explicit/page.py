"""Every case pressed; the page, the table and the figure of it."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.plain_data import plain_data
from ...quantities.say import number, percent, signed_number
from ...version import __version__
from ...views.html import symbols, table
from .. import engine
from ..engine import Picture, Progress
from ..page import document
from .cases import CASES, GROUPS
from .compared import FULL, QUICK, Effort, Point, points_of, press_case

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Summary", "figure", "markdown", "reproduce"]

PRESETS = {None: FULL, "full": FULL, "quick": QUICK}
HEAVY = 1.01e-4


@dataclass(frozen=True, kw_only=True)
class Summary(engine.Summary):
    """What `reproduce` did."""

    LEDGER: ClassVar[str] = "comparison.json"

    effort: Effort
    points: tuple[Point, ...]
    left_out: int
    """States that did not converge, and count nowhere."""
    lost: tuple[str, ...] = ()
    """Names of the cases of those."""

    def findings(self) -> list[str]:
        """Every state, and how far both laws are off."""
        off = sum(point.is_off for point in self.points)
        out = [
            f"{len(CASES)} contacts, each on {self.effort.words}",
            f"{len(self.points)} states: the model is off by more than the error bars (95 %) in "
            f"{off}; nothing fitted",
            *(f"share {words}" for words in _worst(self.points)),
        ]
        for name, title in GROUPS.items():
            out += ["", title]
            for point in self.points:
                if point.case.group == name:
                    out.append(
                        f"  {point.case.words:<44} F* = {number(point.F_star, 2):<8} "
                        f"{_explicit(point):>18}  model {percent(point.statistical)}  "
                        f"{_difference_words(point)}  one field {_by_field(point)}"
                    )
        return out

    def pictures(self) -> list[Callable[[], Picture]]:
        """The one figure."""
        return [self._picture]

    def _picture(self) -> Picture:
        about = "load share of particles, statistical over explicit"
        drawn = figure(self.points)
        return Picture("share", "share", about, "Grey: 10 %.", drawn, _csv(self.points))

    def tables(self) -> dict[str, str]:
        """The states as a table, and as those of a book."""
        states = markdown(self.as_json()["states"])
        return {"comparison.csv": _csv(self.points), "comparison.md": states}

    def as_json(self) -> dict[str, Any]:
        """The content of comparison.json."""
        return _as_json(self)

    def page(self, figures: str) -> str:
        """The whole page."""
        return _page(self, figures)


def reproduce(
    out: str | Path, *, preset: str | None = None, progress: Progress | None = None
) -> Summary:
    """Write ``index.html``, ``comparison.json`` and ``.csv``, and the figure as PNG, SVG, CSV.

    Parameters
    ----------
    out : path-like
        Folder, made when missing; it keeps finished surfaces, from which a run goes on.
    preset : {"full", "quick"}, optional
        ``quick`` takes three small maps a contact and two loads: a minute, and wide error bars.
    progress : callable, optional
        Called with stage, steps done, and steps in all.

    Returns
    -------
    Summary

    Raises
    ------
    InvalidValue
        Another preset, or a folder that cannot be made.
    """
    if preset not in PRESETS:
        raise InvalidValue(
            Problem("preset", "must be 'full' or 'quick'", repr(preset), code=Mistake.OPTION)
        )
    effort = PRESETS[preset]

    def find(folder: Path, report: Progress) -> Summary:
        return _find(effort, folder, report)

    return engine.reproduce("explicit", find, out, preset=preset or "full", progress=progress)


def _find(effort: Effort, folder: Path, report: Progress) -> Summary:
    total = len(CASES) * effort.surfaces
    points: list[Point] = []
    left_out = 0
    lost: list[str] = []
    for i, case in enumerate(CASES):
        report("surfaces", i * effort.surfaces, total)
        before = i * effort.surfaces

        def tell(done: int, before: int = before) -> None:
            report("surfaces", before + done, total)

        ensemble = press_case(case, effort, folder / "surfaces", tell)
        left_out += ensemble.left_out
        if ensemble.left_out:
            lost.append(case.name)
        points += points_of(case, ensemble, effort)
    report("surfaces", total, total)
    return Summary(
        out=folder, effort=effort, points=tuple(points), left_out=left_out, lost=tuple(lost)
    )


def _worst(points: tuple[Point, ...]) -> list[str]:
    """Worst and RMS of both laws above F* = 1e-4, where errors of the runs are small."""
    some = [point for point in points if point.F_star > HEAVY and not math.isnan(point.difference)]
    out = []
    for words, off in (
        ("by the sum over summits", [point.difference for point in some]),
        ("by one field", [point.apart_by_field for point in some]),
    ):
        if percents := [100 * difference for difference in off if not math.isnan(difference)]:
            rms = math.sqrt(sum(difference**2 for difference in percents) / len(percents))
            worst = max(map(abs, percents))
            out.append(f"{words}, F* above 1e-4: off by {worst:.1f} % at most, RMS {rms:.1f} %")
    return out


# -------------------------------------------------------------------------- the record
def _columns(point: Point) -> dict[str, object]:
    """A state as plain numbers."""
    stored = point.stored or (math.nan, math.nan)
    return {
        "case": point.case.name,
        "group": point.case.group,
        "what": point.case.words,
        "zeta_mean": point.zeta[0],
        "zeta_std": point.zeta[1],
        "F_star": point.F_star,
        "share_raw": point.raw[0],
        "share_raw_error": point.raw[1],
        "share": point.share[0],
        "share_error": point.share[1],
        "share_least": point.bounds[0],
        "share_most": point.bounds[1],
        "share_statistical": point.statistical,
        "difference_in_errors": point.errors,
        "share_stored": stored[0],
        "share_stored_error": stored[1],
        "h_over_sigma": point.h[0],
        "h_over_sigma_error": point.h[1],
        "h_over_sigma_statistical": point.h_statistical,
        "A_t": point.area[0],
        "A_t_error": point.area[1],
        "A_t_statistical": point.area_statistical,
        **point.ratios,
        "bare_over_bearing_statistical": point.model_bare,
        "share_field": point.field[0],
        "h_over_sigma_field": point.field[1],
        "A_t_field": point.field[2],
    }


def _csv(points: tuple[Point, ...]) -> str:
    out = io.StringIO()
    rows = [_columns(point) for point in points]
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(rows[0])
    for row in rows:
        writer.writerow(
            [f"{v:.6g}" if isinstance(v, float) and math.isfinite(v) else
             "" if isinstance(v, float) else v for v in row.values()]
        )  # fmt: skip
    return out.getvalue()


def _as_json(summary: Summary) -> dict[str, object]:
    return {
        "version": __version__,
        "effort": summary.effort.words,
        "left_out": summary.left_out,
        "states": [
            plain_data(_columns(point)) | {"off": point.is_off, "why": point.why}
            for point in summary.points
        ],
    }


def markdown(states: list[dict[str, Any]]) -> str:
    """The record as tables of a book: a row a contact, explicit ± error, model, field at each load.

    Numbers are in per cent of the load; the model's are bold where it is off by more than the
    error bars; the last is by the law of one field.
    """
    at = {(state["case"], state["F_star"]): state for state in states}
    out = []
    for group, title in GROUPS.items():
        names = list(dict.fromkeys(s["case"] for s in states if s["group"] == group))
        if not names:
            continue
        loads = sorted({s["F_star"] for s in states if s["group"] == group})
        heads = [f"F* = {load:.0e}".replace("e-0", "e-") for load in loads]
        out += [f"| {title} | {' | '.join(heads)} |", "|---" * (1 + len(loads)) + "|"]
        for name in names:
            cells = [_cell(at[name, load]) for load in loads]
            out.append(f"| {at[name, loads[0]]['what']} | {' | '.join(cells)} |")
        out.append("")
    return "\n".join(out)


def _cell(state: dict[str, Any]) -> str:
    """Explicit ± error, or the bounds that are known of it; the model's number, the field's."""
    ours, error, model, least, most = (
        None if state[name] is None else 100 * state[name]
        for name in ("share", "share_error", "share_statistical", "share_least", "share_most")
    )
    assert model is not None
    bold = "**{}**" if state["off"] else "{}"
    if least is not None and most is not None:
        model_text = f"{model:.1f}"
        return f"{_bounds_text(least, most)}, " + bold.format(model_text) + _field(state, 1)
    assert ours is not None
    decimals = 0 if not error else min(max(0, 1 - math.floor(math.log10(error))), 3)
    spread = f" ± {error:.{decimals}f}" if error else ""
    model_text = f"{model:.{max(decimals, 1)}f}"
    return (
        f"{ours:.{decimals}f}{spread}, " + bold.format(model_text) + _field(state, max(decimals, 1))
    )


def _field(state: dict[str, Any], decimals: int) -> str:
    """The number of the law of one field, after a comma; nothing where there is none."""
    share = state.get("share_field")
    return "" if share is None else f", {100 * share:.{decimals}f}"


def _bounds_text(least: float, most: float) -> str:
    """Bounds in per cent: what is wider than they are is not told."""
    low, high = math.floor(10 * least) / 10, math.ceil(10 * most) / 10
    if high >= 100:
        return f"≥ {low:.1f}"
    return f"≤ {high:.1f}" if low <= 0 else f"{low:.1f} to {high:.1f}"


# -------------------------------------------------------------------------- the figure
def figure(points: tuple[Point, ...]) -> Figure:
    """Model over explicit share, with the error bars of the explicit one, a panel a group."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullFormatter

    from ...views.plot.style import OKABE_ITO

    inks = [OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky",
                                         "black")]  # fmt: skip
    marks = "osD^vP*"
    out = Figure(figsize=(10.4, 12.6), dpi=150, layout="constrained")
    panels = out.subplots(4, 3, sharey=True).ravel().tolist()
    for ax, (name, title) in zip(panels, GROUPS.items(), strict=False):
        mine = [point for point in points if point.case.group == name]
        names = list(dict.fromkeys(point.case.words for point in mine))
        ax.set_xscale("log")
        ax.axhspan(0.9, 1.1, color="0.93", zorder=0)
        ax.axhline(1.0, color="0.5", linewidth=0.8, zorder=1)
        for i, words in enumerate(names):
            beside = 1.07 ** (i - len(names) / 2)
            ink = inks[i % len(inks)]
            every = [
                point
                for point in mine
                if point.case.words == words and point.share[0] > 0 and not point.has_bounds_only
            ]
            load = np.array([point.F_star for point in every]) * beside
            ratio = np.array([point.statistical / point.share[0] for point in every])
            error = ratio * np.array([point.share[1] / point.share[0] for point in every])
            ax.errorbar(
                load, ratio, yerr=error, marker=marks[i % len(marks)], markersize=4, capsize=2.5,
                linewidth=1.0, elinewidth=1.0, color=ink, label=words,
            )  # fmt: skip
            field = np.array([point.field[0] / point.share[0] for point in every])
            ax.plot(load, field, marker="x", markersize=4, linestyle=":", linewidth=0.8, color=ink)
            for point in mine:  # a bar from bound to bound has no mark
                if point.case.words == words and point.has_bounds_only and point.bounds[0] > 0:
                    ends = [point.statistical / limit for limit in point.bounds]
                    ax.plot([point.F_star * beside] * 2, ends, color=ink, marker="_", linewidth=1.0)
        ax.set_title(fill(title, 48), fontsize="small", loc="left")
        loads = sorted({point.F_star for point in mine})
        if loads and loads[-1] < 11 * loads[0]:
            ax.set_xticks(loads, [f"{load:g}" for load in loads])
            ax.xaxis.set_minor_formatter(NullFormatter())
        if names:
            ax.legend(fontsize=6.2, frameon=False, loc="upper left")
    for ax in panels[len(GROUPS) :]:
        ax.set_visible(False)
    for ax in panels:
        ax.set_ylim(0.75, 1.5)
        ax.tick_params(which="both", direction="in", top=True, right=True)
        ax.tick_params(labelleft=True)
    out.supxlabel("load $F^*$ [1]", fontsize="medium")
    out.supylabel("load share of particles, model over pressed [1]; crosses: by the law field",
                  fontsize="medium")  # fmt: skip
    return out


# -------------------------------------------------------------------------- the page
def _share(pair: tuple[float, float]) -> str:
    return percent(*pair) if math.isfinite(pair[1]) else percent(pair[0])


def _explicit(point: Point) -> str:
    """The share, corrected for the random surfaces drawn, or its bounds."""
    if not point.has_bounds_only:
        return _share(point.share)
    return _bounds_text(*(100 * limit for limit in point.bounds)) + " %"


def _page(summary: Summary, figures: str) -> str:
    title = "The statistical model against particles at their places"
    body = [
        f"<h1>{title}</h1>",
        f"<p>{len(CASES)} contacts, each on {summary.effort.words}; "
        f"{summary.left_out} states that did not converge are left out. Base: σ = 0.3 µm, "
        "R = 3 µm, α = 5, E* = 112 GPa, H = 5 GPa, 10¹¹ particles of one size per m², random "
        "seats. A share is the part of the load on particles. Explicit ones are corrected for the "
        "random surfaces drawn, with standard errors over surfaces; where an asperity carries on "
        "too few of these, bounds stand in their place. The model has the seat heights that were "
        "drawn; nothing is fitted. In coloured rows it is off by more than the error bars (95 %, "
        "the few surfaces counted).</p>",
        "<h2>Shares</h2>",
    ]
    for name, words in GROUPS.items():
        mine = [point for point in summary.points if point.case.group == name]
        stored = any(point.stored for point in mine)
        body.append(f"<h3>{escape(words)}</h3>")
        head = ["contact", "F*", "explicit, raw", "explicit", "statistical", "off by",
                "one field, off by", "h/σ", "h/σ, statistical", "h/σ, one field",
                "why"]  # fmt: skip
        if stored:
            head.insert(4, "stored runs")
        body.append(table(head, (_row(point, stored) for point in mine)))
    body += ["<h2>Figure</h2>", figures]
    return document(title, body)


def _difference_words(point: Point) -> str:
    """By how much the model is off."""
    if point.has_bounds_only:
        return "outside" if point.is_off else "within"
    return f"{signed_number(100 * point.difference, 1)} %, {signed_number(point.errors, 1)} errors"


def _by_field(point: Point) -> str:
    """Share by the law of one field, and by how much it is off."""
    if math.isnan(point.field[0]):
        return "unknown"
    off = point.apart_by_field
    return percent(point.field[0]) + (
        "" if math.isnan(off) else f", {signed_number(100 * off, 1)} %"
    )


def _row(point: Point, stored: bool) -> list[str]:
    kind = "fail" if point.is_off else "pass"
    cells = [
        symbols(point.case.words),
        number(point.F_star, 2),
        _share(point.raw),
        f"<b>{_explicit(point)}</b>",
        percent(point.statistical),
        f"<td class='{kind}'>{_difference_words(point)}</td>",
        _by_field(point),
        f"{point.h[0]:.3f} ± {point.h[1]:.3f}",
        f"{point.h_statistical:.3f}",
        f"{point.field[1]:.3f}",
        escape(point.why),
    ]
    if stored:
        cells.insert(4, _share(point.stored) if point.stored else "–")
    return cells
