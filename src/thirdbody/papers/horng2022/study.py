"""The study itself: score every reading, draw every panel, write files that stand alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from ...errors import InvalidValue, Mistake, Problem
from ...version import __version__
from .. import engine
from ..engine import Picture, Progress
from ..ledger import data_of
from .claims import PAPER, claims
from .drawing import draw
from .figures import PANELS, Panel, table
from .ledger import score
from .page import page
from .readings import READINGS, Curves, Reading
from .record import Ledger

__all__ = ["Summary", "reproduce"]

CONSISTENT = ("series-offset", "series-plane", "series-rough")
"""Readings that have areas of their own under the particles."""


@dataclass(frozen=True, kw_only=True)
class Summary(engine.Summary):
    """What `reproduce` did."""

    preset: str
    """Reading in which the panels are drawn."""
    ledger: Ledger
    """Verdicts of every reading."""
    books: Mapping[str, Curves]
    """Curves of every reading."""

    @property
    def totals(self) -> dict[str, int]:
        """Claims met by each reading."""
        return {name: self.ledger.total(name) for name in READINGS}

    def findings(self) -> list[str]:
        """Claims met by each reading."""
        count = len(claims())
        out = [
            f"Horng et al. 2022, Lubricants 10(7), 164: {count} statements, "
            f"{len(PANELS)} panels drawn with reading {READINGS[self.preset].key} ({self.preset})",
            "",
        ]
        for name, reading in READINGS.items():
            out.append(
                f"  {reading.key:<3}{name:<15}{self.totals[name]:>3} of {count}  {reading.title}"
            )
        booked = ", ".join(
            f"{READINGS[name].key} {self.ledger.total(name, paper_booking=True)}"
            for name in CONSISTENT
        )
        out.append(
            f"  with particle area booked as the paper does (F_sa/H_s, all plastic): {booked}"
        )
        return out

    def pictures(self) -> list[Callable[[], Picture]]:
        """Every panel, drawn in one reading."""
        return [partial(self._picture, name, panel_of) for name, panel_of in PANELS.items()]

    def _picture(self, name: str, panel_of: Callable[[Curves], Panel]) -> Picture:
        reading, panel = READINGS[self.preset], panel_of(self.books[self.preset])
        drawn = draw(panel, f"reading {reading.key}: {reading.title}")
        return Picture(f"fig{name}", name, panel.about, panel.note, drawn, table(panel))

    def page(self, figures: str) -> str:
        """The whole page."""
        return page(self.ledger, READINGS[self.preset], figures)

    def as_json(self) -> dict[str, object]:
        """The content of claims.json."""
        data = data_of(PAPER)
        verdicts, booked = self.ledger.verdicts, self.ledger.paper_booking
        return {
            "paper": data["paper"],
            "version": __version__,
            "figures_drawn_with": self.preset,
            "load_range": data["load_range"],
            "definitions": data["definitions"],
            "readings": {
                name: {
                    "key": reading.key,
                    "title": reading.title,
                    "passed": self.ledger.total(name),
                    "of": len(claims()),
                    "parameters": reading.parameters(),
                }
                for name, reading in READINGS.items()
            },
            "claims": [
                {
                    "id": claim.id,
                    "place": claim.place,
                    "statement": claim.statement,
                    "quantity": claim.quantity,
                    "inputs": claim.inputs,
                    "paper": claim.paper,
                    "allowed": claim.rule_words,
                    "rule": claim.rule,
                    "remark": claim.remark,
                    "conflicts_with": list(claim.conflicts),
                    "results": {name: verdicts[name][claim.id].as_json() for name in READINGS},
                }
                for claim in claims()
            ],
            "paper_booking": {
                name: {
                    "passed": self.ledger.total(name, paper_booking=True),
                    "gained": self.ledger.changed_by_booking(name)[0],
                    "lost": self.ledger.changed_by_booking(name)[1],
                    "results": {key: one.as_json() for key, one in booked[name].items()},
                }
                for name in CONSISTENT
            },
            "errata": data["errata"],
        }


def reproduce(
    out: str | Path, *, preset: str = "published", progress: Progress | None = None
) -> Summary:
    """Regenerate the figures of Horng et al. 2022 and score its statements.

    Writes 20 panels, each as PNG, SVG and CSV, the ledger ``claims.json``, and ``index.html``,
    one page with everything in it. A file appears whole or not at all, and the same library
    writes the same bytes again, with the same versions on the same type of processor.

    Parameters
    ----------
    out : path-like
        Folder, made when missing.
    preset : str, optional
        Reading that draws the figures, a name in `READINGS`. The ledger scores all readings.
    progress : callable, optional
        Called with stage, steps done, and steps in all.

    Returns
    -------
    Summary
        ``lines()`` for a terminal, ``totals`` for each reading, ``files`` written.

    Raises
    ------
    InvalidValue
        Unknown preset, or a folder that cannot be made.

    References
    ----------
    Horng et al. 2022, Lubricants 10(7), 164, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import tempfile
    >>> from thirdbody.papers.horng2022 import reproduce
    >>> done = reproduce(tempfile.mkdtemp())  # doctest: +SKIP
    >>> done.totals["published"]  # doctest: +SKIP
    66
    """
    if preset not in READINGS:
        raise InvalidValue(
            Problem(
                "preset", f"must be one of {', '.join(READINGS)}", repr(preset), code=Mistake.OPTION
            )
        )

    def find(folder: Path, report: Progress) -> Summary:
        books = {name: Curves(reading) for name, reading in READINGS.items()}
        return Summary(out=folder, preset=preset, ledger=keep_ledger(books, report), books=books)

    return engine.reproduce(PAPER, find, out, preset=preset, progress=progress)


def keep_ledger(books: dict[str, Curves], report: Progress) -> Ledger:
    """Score every reading, the consistent ones twice."""
    runs: list[tuple[Reading, Curves]] = [(READINGS[name], books[name]) for name in READINGS]
    for name in CONSISTENT:
        reading = replace(READINGS[name], paper_booking=True)
        runs.append((reading, Curves(reading)))
    total = len(runs) * len(claims())
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        report("claims", done, total)

    scored = [(reading, score(curves, step)) for reading, curves in runs]
    return Ledger(
        {reading.name: verdicts for reading, verdicts in scored if not reading.paper_booking},
        {reading.name: verdicts for reading, verdicts in scored if reading.paper_booking},
    )
