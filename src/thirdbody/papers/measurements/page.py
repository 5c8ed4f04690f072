"""Page, ledger and figures of every measurement."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path
from typing import Any, ClassVar

from ...errors import InvalidValue, Mistake, Problem
from ...version import __version__
from ...views.html import symbols, table
from .. import engine
from ..engine import Picture, Progress, ignore_ranges
from ..page import document
from ..panels import Panel, picture_of
from .listed import rows
from .row import CONSTRUCTED, STANDINGS, WORDS, Row, Verdict, count_words, word_of

__all__ = ["Summary", "find", "reproduce"]

Ledger = Mapping[str, Mapping[str, Verdict]]

SIGNS = {
    "lost": "✗ lost", "undecided": "? undecided", "met": "✓ met", CONSTRUCTED: "= by construction",
}  # fmt: skip
KINDS = {"lost": "fail", "undecided": "none", "met": "pass", CONSTRUCTED: "none"}


@dataclass(frozen=True, kw_only=True)
class Summary(engine.Summary):
    """What `reproduce` did."""

    LEDGER: ClassVar[str] = "measurements.json"
    TITLE: ClassVar[str] = "The model against measurements"

    rows: tuple[Row, ...]
    """Lost ones first."""
    ledger: Ledger

    def counts(self) -> dict[str, int]:
        """How many measurements were lost, undecided, met."""
        words = [word_of(dict(self.ledger[row.name])) for row in self.rows]
        return count_words(words)

    def score(self) -> str:
        """How many measurements, and how many computations beside, were lost, undecided, met."""
        parts = []
        for kind, computed in (("measurements", False), ("computations", True)):
            words = [
                word_of(dict(self.ledger[row.name]))
                for row in self.rows
                if row.computed == computed
            ]
            counts = ", ".join(f"{count} {word}" for word, count in count_words(words).items())
            parts.append(f"{len(words)} {kind}: {counts}")
        return "; ".join(parts)

    def findings(self) -> list[str]:
        """Counts, and every verdict."""
        out = [f"{self.score()}. Nothing is fitted", ""]
        for row in self.rows:
            verdicts = self.ledger[row.name]
            out.append(f"  {word_of(dict(verdicts)):<16}{row.title}")
            for one in row.statements:
                verdict = verdicts[one.claim.id]
                value = verdict.band.text if verdict.band else "–"
                limits = f"; allowed {one.claim.rule_words}" if one.claim.rule else ""
                out.append(f"    {verdict.word:<16}{one.claim.quantity}: {value}{limits}")
        return out

    def pictures(self) -> list[Callable[[], Picture]]:
        """The panels of every row, in the order of the page."""
        return [partial(_picture, panel) for row in self.rows for panel in row.panels]

    def as_json(self) -> dict[str, object]:
        """The content of measurements.json."""
        return _as_json(self)

    def page(self, figures: str) -> str:
        """The whole page."""
        return _page(self, figures)


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
        raise InvalidValue(
            Problem(
                "preset",
                "has no meaning for measurements; leave it out",
                repr(preset),
                code=Mistake.IDLE,
            )
        )
    return engine.reproduce("measurements", partial(find, Summary, rows()), out, progress=progress)


def find(kind: type[Summary], rows: tuple[Row, ...], folder: Path, report: Progress) -> Summary:
    """Judge rows, the lost ones first."""
    ledger: dict[str, dict[str, Verdict]] = {}
    for done, row in enumerate(rows):
        report("measurements", done, len(rows))
        with ignore_ranges():
            ledger[row.name] = row.judge()
    report("measurements", len(rows), len(rows))
    shown = tuple(sorted(rows, key=lambda row: WORDS.index(word_of(ledger[row.name]))))
    return kind(out=folder, rows=shown, ledger=ledger)


def _picture(panel_of: Callable[[], Panel]) -> Picture:
    with ignore_ranges():
        return picture_of("fig_", panel_of)


def _as_json(summary: Summary) -> dict[str, object]:
    def verdict_entries(verdict: Verdict) -> dict[str, object]:
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
                        "allowed": one.claim.rule_words,
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


def _page(summary: Summary, figures: str) -> str:
    title = summary.TITLE
    return document(
        title,
        [
            f"<h1>{title}</h1>",
            f"<p>{summary.score()}. Nothing is fitted: what a source does not give is a range, "
            "chosen here, and a prediction is the band over such ranges. A statement is met where "
            "the whole band lies within the limits, lost where none of it does. A row is undecided "
            "where any of its statements is and none is lost. By construction holds what no "
            "number of the model could change: it is no test. How well each number is known stands "
            "beside it: "
            f"{', '.join(STANDINGS)}.</p>",
            "<nav><a href='#ledger'>Ledger</a><a href='#figures'>Figures</a></nav>",
            "<h2 id=ledger>Ledger</h2>",
            *(_row(row, summary.ledger[row.name]) for row in summary.rows),
            "<h2 id=figures>Figures</h2>",
            figures,
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
