"""A study of a paper of which only statements are known: ledger, figures, page, summary."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from ..errors import InvalidValue
from ..quantities.files import write_text
from ..views.html import symbols, table
from .ledger import OWN, WORDS, Claim, Verdict
from .page import document, figures
from .panels import Panel, draw, keep, prepare_folder, table_of
from .trends import Measure, Reading, score

__all__ = ["Study", "Summary"]

Progress = Callable[[str, int, int], None]
SIGNS = {
    "pass": "✓ agrees",
    "fail": "✗ disagrees",
    "not reproduced": "– not reproduced",
    "not sourced": "? not sourced",
    "own result": "own result",
}


@dataclass(frozen=True)
class Study:
    """A paper: what it is, how it is read, what it states, and what is drawn."""

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
                f"preset = {preset!r} has no meaning for {self.name}: figures and ledger show all "
                f"readings ({', '.join(self.readings)}); leave it out"
            )
        folder = prepare_folder(out, self.name)
        report = progress or (lambda stage, done, total: None)

        report("claims", 0, 1)
        ledger = self.ledger()
        report("claims", 1, 1)
        files: list[str] = []
        images: list[tuple[str, str, str, bytes]] = []
        for done, panel_of in enumerate(self.panels):
            report("figures", done, len(self.panels))
            panel = panel_of()
            new, svg = keep(draw(panel), table_of(panel), folder, f"fig{panel.name}")
            files += new
            about = panel.about.replace("$", "").replace(r"\propto", "∝")
            images.append((panel.name, about, panel.note, svg))
        report("figures", len(self.panels), len(self.panels))
        report("page", 0, 1)
        text = json.dumps(self.as_json(ledger), ensure_ascii=False, indent=1, allow_nan=False)
        write_text(folder / "claims.json", text + "\n")
        write_text(folder / "index.html", self.page(ledger, images))
        report("page", 1, 1)
        return Summary(self, folder, ledger, (*files, "claims.json", "index.html"))

    def as_json(self, ledger: Mapping[str, Mapping[str, Verdict]]) -> dict[str, Any]:
        """The content of claims.json."""
        from ..version import __version__

        def results(claim: Claim) -> dict[str, Any]:
            out = {}
            for name in self.readings:
                verdict = ledger[name][claim.id]
                exists = verdict.measured.exists
                out[name] = {
                    "values": list(verdict.measured.values) if exists else None,
                    "verdict": verdict.word,
                    "why": verdict.why,
                }
            return out

        return {
            "paper": self.paper,
            "version": __version__,
            "known": list(self.known),
            "readings": {
                name: {"title": one.title, "inputs": dict(one.inputs)}
                for name, one in self.readings.items()
            },
            "claims": [
                {
                    "id": claim.id,
                    "statement": claim.statement,
                    "standing": claim.standing,
                    "source": claim.place,
                    "quantity": claim.quantity,
                    "inputs": claim.inputs,
                    "allowed": claim.allowed,
                    "rule": claim.rule,
                    "remark": claim.remark,
                    "results": results(claim),
                }
                for claim in self.claims
            ],
        }

    def page(
        self,
        ledger: Mapping[str, Mapping[str, Verdict]],
        images: list[tuple[str, str, str, bytes]],
    ) -> str:
        """The whole page."""
        body = [
            f"<h1>{escape(self.title)}</h1>",
            f"<p class=soft>{escape(self.paper)}</p>",
            "<nav><a href='#ledger'>Ledger</a><a href='#figures'>Figures</a>"
            "<a href='#readings'>Readings</a></nav>",
            *(f"<p>{symbols(text)}</p>" for text in self.known),
            "<h2 id=ledger>Ledger</h2><p>“Not sourced” is measured all the same: the papers may "
            "say it, but no text could be found that does. “Own result” is what the reading does "
            "beyond the statements, mostly where a trend ends.</p>",
            table(
                ["claim", "statement", "source", "measured, allowed", *self.readings],
                (self._row(claim, ledger) for claim in self.claims),
            ),
            "<h2 id=figures>Figures</h2>",
            figures(images),
            "<h2 id=readings>Readings</h2>",
            table(
                ["reading", "assumed"],
                (
                    [
                        f"<b>{escape(name)}</b>",
                        "<br>".join(f"{symbols(k)}: {symbols(v)}" for k, v in one.inputs.items()),
                    ]
                    for name, one in self.readings.items()
                ),
            ),
        ]
        return document(self.title, body)

    def _row(self, claim: Claim, ledger: Mapping[str, Mapping[str, Verdict]]) -> list[str]:
        kinds = {"pass": "pass", "fail": "fail"}
        cells = []
        for name in self.readings:
            verdict = ledger[name][claim.id]
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
        allowed = f"<br><span class=soft>{escape(claim.allowed)}</span>" if claim.rule else ""
        return [
            f"<td id='{claim.id}'><b>{claim.id}</b></td>",
            f"{symbols(claim.statement)}.{remark}",
            f"{escape(claim.standing)}<br><span class=soft>{escape(claim.place)}</span>",
            f"{symbols(claim.quantity)}{allowed}",
            *cells,
        ]


@dataclass(frozen=True)
class Summary:
    """What `Study.reproduce` did."""

    study: Study
    out: Path
    ledger: Mapping[str, Mapping[str, Verdict]]
    files: tuple[str, ...]

    def counts(self, reading: str) -> dict[str, int]:
        """How often each verdict was given."""
        words = [verdict.word for verdict in self.ledger[reading].values()]
        return {word: words.count(word) for word in WORDS}

    def lines(self) -> list[str]:
        """The summary for a terminal."""
        stated = [claim for claim in self.study.claims if claim.standing != OWN]
        out = [f"{self.study.paper}: {len(stated)} statements", ""]
        for name in self.study.readings:
            count = self.counts(name)
            out.append(
                f"  {name:<16}{count['pass']} agree, {count['fail']} disagree, "
                f"{count['not reproduced']} not reproduced, {count['not sourced']} not sourced"
            )
        out += ["", f"{len(self.files)} files in {self.out}; read {self.out / 'index.html'}"]
        return out
