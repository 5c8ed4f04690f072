"""A study of a paper of which only statements are known: ledger, figures, page, summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Problem
from ..version import __version__
from ..views.html import symbols, table
from . import engine
from .engine import Picture, Progress
from .ledger import OWN, WORDS, Claim, Verdict, claims_of, data_of
from .page import document
from .panels import Panel, picture_of
from .trends import MEASURES, Measure, Reading, score

__all__ = ["Study", "Summary"]

SIGNS = {
    "pass": "✓ agrees",
    "fail": "✗ disagrees",
    "not reproduced": "– not reproduced",
    "not sourced": "? not sourced",
    "own result": "own result",
}


@dataclass(frozen=True)
class Study:
    """A paper: its readings, its statements, and its figures."""

    name: str
    title: str
    paper: str
    """Citation, as far as it is known."""
    known: tuple[str, ...]
    """What could be read, what is reconstructed, what was found: one paragraph each."""
    readings: Mapping[str, Reading]
    claims: tuple[Claim, ...]
    measures: Mapping[str, Measure]
    panels: tuple[Callable[[], Panel], ...]

    @classmethod
    def read_data(
        cls,
        name: str,
        readings: Mapping[str, Reading],
        panels: tuple[Callable[[], Panel], ...],
        *measures: Measure,
    ) -> Study:
        """The study of a data file; ``measures`` beside those that any reading has."""
        data, extra_measures = data_of(name), {one.__name__: one for one in measures}
        title, paper, paragraphs = data["title"], data["paper"], tuple(data["known"])
        return cls(
            name,
            title,
            paper,
            paragraphs,
            readings,
            claims_of(name),
            MEASURES | extra_measures,
            panels,
        )

    def ledger(self) -> dict[str, dict[str, Verdict]]:
        """Verdicts of every reading, by reading name and claim id."""
        return {
            name: score(reading, self.claims, self.measures)
            for name, reading in self.readings.items()
        }

    def reproduce(
        self, out: str | Path, *, preset: str | None = None, progress: Progress | None = None
    ) -> Summary:
        """Write every panel as PNG, SVG and CSV, ``claims.json``, and ``index.html``.

        Parameters
        ----------
        out : path-like
            Folder, made when missing.
        preset : None
            Refused: figures and ledger show every reading.
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
                    f"has no meaning for {self.name}: figures and ledger show all readings "
                    f"({', '.join(self.readings)}); leave it out",
                    repr(preset),
                    code=Mistake.IDLE,
                )
            )
        return engine.reproduce(self.name, self._find, out, progress=progress)

    def _find(self, folder: Path, report: Progress) -> Summary:
        report("claims", 0, 1)
        summary = Summary(out=folder, study=self, ledger=self.ledger())
        report("claims", 1, 1)
        return summary


@dataclass(frozen=True, kw_only=True)
class Summary(engine.Summary):
    """What `Study.reproduce` did."""

    study: Study
    ledger: Mapping[str, Mapping[str, Verdict]]

    def counts(self, reading: str) -> dict[str, int]:
        """How often each verdict was given."""
        words = [verdict.word for verdict in self.ledger[reading].values()]
        return {word: words.count(word) for word in WORDS}

    def findings(self) -> list[str]:
        """Counts of every reading."""
        stated = [claim for claim in self.study.claims if claim.standing != OWN]
        out = [f"{self.study.paper}: {len(stated)} statements", ""]
        for name in self.study.readings:
            count = self.counts(name)
            out.append(
                f"  {name:<16}{count['pass']} agree, {count['fail']} disagree, "
                f"{count['not reproduced']} not reproduced, {count['not sourced']} not sourced"
            )
        return out

    def pictures(self) -> list[Callable[[], Picture]]:
        """A panel each."""
        return [partial(picture_of, "fig", panel) for panel in self.study.panels]

    def as_json(self) -> dict[str, Any]:
        """The content of claims.json."""
        readings = self.study.readings
        return {
            "paper": self.study.paper,
            "version": __version__,
            "known": list(self.study.known),
            "readings": {
                name: {"title": one.title, "inputs": dict(one.inputs)}
                for name, one in readings.items()
            },
            "claims": [
                {
                    "id": claim.id,
                    "statement": claim.statement,
                    "standing": claim.standing,
                    "source": claim.place,
                    "quantity": claim.quantity,
                    "inputs": claim.inputs,
                    "allowed": claim.rule_words,
                    "rule": claim.rule,
                    "remark": claim.remark,
                    "results": {name: self.ledger[name][claim.id].as_json() for name in readings},
                }
                for claim in self.study.claims
            ],
        }

    def page(self, figures: str) -> str:
        """The whole page."""
        study = self.study
        body = [
            f"<h1>{escape(study.title)}</h1>",
            f"<p class=soft>{escape(study.paper)}</p>",
            "<nav><a href='#ledger'>Ledger</a><a href='#figures'>Figures</a>"
            "<a href='#readings'>Readings</a></nav>",
            *(f"<p>{symbols(text)}</p>" for text in study.known),
            "<h2 id=ledger>Ledger</h2><p>“Not sourced” is measured all the same: the papers may "
            "say it, but no text could be found that does. “Own result” is what the reading does "
            "beyond the statements, mostly where a trend ends.</p>",
            table(
                ["claim", "statement", "source", "measured, allowed", *study.readings],
                (self._row(claim) for claim in study.claims),
            ),
            "<h2 id=figures>Figures</h2>",
            figures,
            "<h2 id=readings>Readings</h2>",
            table(
                ["reading", "assumed"],
                (
                    [
                        f"<b>{escape(name)}</b>",
                        "<br>".join(f"{symbols(k)}: {symbols(v)}" for k, v in one.inputs.items()),
                    ]
                    for name, one in study.readings.items()
                ),
            ),
        ]
        return document(study.title, body)

    def _row(self, claim: Claim) -> list[str]:
        kinds = {"pass": "pass", "fail": "fail"}
        cells = []
        for name in self.study.readings:
            verdict = self.ledger[name][claim.id]
            measured = verdict.measured
            text = f"<b>{escape(measured.text)}</b>" if measured.exists else escape(verdict.why)
            note = f"<br><span class=soft>{escape(measured.note)}</span>" * bool(
                measured.exists and measured.note
            )
            cells.append(
                f"<td class='{kinds.get(verdict.word, 'none')}'>{SIGNS[verdict.word]}<br>{text}"
                f"{note}</td>"
            )
        remark = f"<br><span class=soft>{symbols(claim.remark)}</span>" if claim.remark else ""
        allowed = f"<br><span class=soft>{escape(claim.rule_words)}</span>" if claim.rule else ""
        return [
            f"<td id='{claim.id}'><b>{claim.id}</b></td>",
            f"{symbols(claim.statement)}.{remark}",
            f"{escape(claim.standing)}<br><span class=soft>{escape(claim.place)}</span>",
            f"{symbols(claim.quantity)}{allowed}",
            *cells,
        ]
