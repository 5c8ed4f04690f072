"""Page, ledger and figures of every measurement."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, TypeVar

from ...errors import InvalidValue, RangeWarning
from ...quantities.files import write_text
from ...views.html import symbols, table
from ..page import document, figures
from ..panels import draw, keep, prepare_folder, table_of
from .listed import rows
from .row import STANDINGS, WORDS, Row, Verdict, word_of

__all__ = ["Summary", "reproduce"]

Progress = Callable[[str, int, int], None]
Made = TypeVar("Made")
Ledger = Mapping[str, Mapping[str, Verdict]]

SIGNS = {"lost": "✗ lost", "undecided": "? undecided", "met": "✓ met"}
KINDS = {"lost": "fail", "undecided": "none", "met": "pass"}
LEDGER = "measurements.json"


@dataclass(frozen=True)
class Summary:
    """What `reproduce` did."""

    out: Path
    rows: tuple[Row, ...]
    """Lost ones first."""
    ledger: Ledger
    files: tuple[str, ...]

    def counts(self) -> dict[str, int]:
        """How many measurements were lost, undecided, met."""
        words = [word_of(dict(self.ledger[row.name])) for row in self.rows]
        return {word: words.count(word) for word in WORDS}

    def lines(self) -> list[str]:
        """The summary for a terminal."""
        count = self.counts()
        out = [
            f"{len(self.rows)} measurements: {count['lost']} lost, {count['undecided']} undecided, "
            f"{count['met']} met; nothing fitted",
            "",
        ]
        for row in self.rows:
            verdicts = self.ledger[row.name]
            out.append(f"  {word_of(dict(verdicts)):<11}{row.title}")
            for one in row.statements:
                verdict = verdicts[one.claim.id]
                value = verdict.band.text if verdict.band else "–"
                out.append(f"    {verdict.word:<11}{one.claim.quantity}: {value}")
        out += ["", f"{len(self.files)} files in {self.out}; read {self.out / 'index.html'}"]
        return out


def reproduce(
    out: str | Path, *, preset: str | None = None, progress: Progress | None = None
) -> Summary:
    """Write ``index.html``, ``measurements.json``, and every figure as PNG, SVG and CSV.

    Parameters
    ----------
    out : path-like
        Folder, made when missing.
    preset : None
        Refused: nothing here can be read in several ways.
    progress : callable, optional
        Called with stage, steps done, and steps in all.

    Returns
    -------
    Summary

    Raises
    ------
    InvalidValue
        A preset, or a folder that cannot be made.
    """
    if preset is not None:
        raise InvalidValue(f"preset = {preset!r} has no meaning for measurements; leave it out")
    folder = prepare_folder(out, "measurements")
    report = progress or (lambda stage, done, total: None)

    known = rows()
    ledger: dict[str, dict[str, Verdict]] = {}
    for done, row in enumerate(known):
        report("measurements", done, len(known))
        ledger[row.name] = _quietly(row.judge)
    report("measurements", len(known), len(known))
    shown = tuple(sorted(known, key=lambda row: WORDS.index(word_of(ledger[row.name]))))

    files: list[str] = []
    images: list[tuple[str, str, str, bytes]] = []
    panels = [panel for row in shown for panel in row.panels]
    for done, panel_of in enumerate(panels):
        report("figures", done, len(panels))
        panel = _quietly(panel_of)
        new, svg = keep(draw(panel), table_of(panel), folder, f"fig_{panel.name}")
        files += new
        images.append((panel.name, panel.about, panel.note, svg))
    report("figures", len(panels), len(panels))

    summary = Summary(folder, shown, ledger, (*files, LEDGER, "index.html"))
    text = json.dumps(_as_json(summary), ensure_ascii=False, indent=1, allow_nan=False)
    write_text(folder / LEDGER, text + "\n")
    write_text(folder / "index.html", _page(summary, images))
    return summary


def _quietly(made: Callable[[], Made]) -> Made:
    """What is beyond the laws stands in the row's own words."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        return made()


def _as_json(summary: Summary) -> dict[str, Any]:
    from ...version import __version__

    def verdict_entries(verdict: Verdict) -> dict[str, Any]:
        band = verdict.band
        return {
            "verdict": verdict.word,
            "why": verdict.why,
            "predicted": [band.low, band.best, band.high] if band else None,
            "note": band.note if band else "",
        }

    return {
        "version": __version__,
        "totals": summary.counts(),
        "measurements": [
            {
                "name": row.name,
                "title": row.title,
                "source": row.source,
                "conditions": row.conditions,
                "inputs": [
                    {"what": one.what, "value": one.value, "standing": one.standing}
                    for one in row.inputs
                ],
                "statements": [
                    {
                        "id": one.claim.id,
                        "measured": one.claim.statement,
                        "standing": one.claim.standing,
                        "quantity": one.claim.quantity,
                        "allowed": one.claim.allowed,
                        "remark": one.claim.remark,
                        **verdict_entries(summary.ledger[row.name][one.claim.id]),
                    }
                    for one in row.statements
                ],
                "means": row.means,
            }
            for row in summary.rows
        ],
    }


def _page(summary: Summary, images: list[tuple[str, str, str, bytes]]) -> str:
    count = summary.counts()
    title = "The model against measurements"
    return document(
        title,
        [
            f"<h1>{title}</h1>",
            f"<p>{len(summary.rows)} measurements: <b>{count['lost']} lost</b>, "
            f"{count['undecided']} undecided, {count['met']} met. Nothing is fitted: what a source "
            "does not give is a range, chosen here, and a prediction is the band over such ranges. "
            "A statement is met where the whole band lies within the limits, lost where none of it "
            "does. How well each number is known stands beside it: "
            f"{', '.join(STANDINGS)}.</p>",
            "<nav><a href='#ledger'>Ledger</a><a href='#figures'>Figures</a></nav>",
            "<h2 id=ledger>Ledger</h2>",
            *(_row(row, summary.ledger[row.name]) for row in summary.rows),
            "<h2 id=figures>Figures</h2>",
            figures(images),
        ],
    )


def _row(row: Row, verdicts: Mapping[str, Verdict]) -> str:
    def cells(one: Any) -> list[str]:
        verdict = verdicts[one.claim.id]
        band = verdict.band
        note = f"<br><span class=soft>{symbols(band.note)}</span>" if band and band.note else ""
        remark = f"<br><span class=soft>{symbols(one.claim.remark)}</span>" * bool(one.claim.remark)
        return [
            f"<td class='{KINDS[verdict.word]}'><b>{SIGNS[verdict.word]}</b></td>",
            f"{symbols(one.claim.statement)}.<br><span class=soft>{escape(one.claim.standing)}"
            "</span>",
            f"{symbols(one.claim.quantity)}{remark}",
            f"<b>{escape(band.text) if band else '–'}</b>{note}",
            symbols(verdict.why),
        ]

    word = word_of(dict(verdicts))
    inputs = "".join(
        f"<li>{symbols(one.what)}: {symbols(one.value)} <span class=soft>({escape(one.standing)})"
        "</span></li>"
        for one in row.inputs
    )
    return (
        f"<section id='{row.name}'><h3>{SIGNS[word]} · {symbols(row.title)}</h3>"
        f"<p class=soft>{escape(row.source)}</p><p>{symbols(row.conditions)}</p>"
        + table(
            ["verdict", "measured", "quantity", "predicted", "why"],
            (cells(one) for one in row.statements),
        )
        + f"<details><summary>Inputs</summary><ul>{inputs}</ul></details>"
        f"<p>{symbols(row.means)}</p></section>"
    )
