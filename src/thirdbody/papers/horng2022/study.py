"""The study itself: score every reading, draw every panel, write files that stand alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...errors import InvalidValue
from ...quantities.files import write_text
from ..ledger import Verdict
from ..panels import keep, prepare_folder
from .claims import claims, study_data
from .drawing import draw
from .figures import PANELS, table
from .ledger import score
from .page import page
from .readings import READINGS, Curves, Reading
from .record import Ledger

__all__ = ["Summary", "reproduce"]

Progress = Callable[[str, int, int], None]
CONSISTENT = ("series-offset", "series-plane", "series-rough")
"""Readings that have areas of their own under the particles."""


@dataclass(frozen=True)
class Summary:
    """What `reproduce` did."""

    out: Path
    """Folder it wrote."""
    preset: str
    """Reading in which the panels are drawn."""
    ledger: Ledger
    """Verdicts of every reading."""
    files: tuple[str, ...]
    """Names of what it wrote."""

    @property
    def totals(self) -> dict[str, int]:
        """Claims met by each reading."""
        return {name: self.ledger.total(name) for name in READINGS}

    def lines(self) -> list[str]:
        """The summary for a terminal."""
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
        out += [
            f"  with particle area booked as the paper does (F_sa/H_s, all plastic): {booked}",
            "",
            f"{len(self.files)} files in {self.out}; read {self.out / 'index.html'}",
        ]
        return out


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
    >>> done = reproduce(tempfile.mkdtemp())  # doctest: +SKIP
    >>> done.totals["published"]  # doctest: +SKIP
    66
    """
    if preset not in READINGS:
        raise InvalidValue(f"preset = {preset!r} must be one of {', '.join(READINGS)}")
    folder = prepare_folder(out, "horng2022", preset)
    report = progress or (lambda stage, done, total: None)

    books = {name: Curves(reading) for name, reading in READINGS.items()}
    ledger = keep_ledger(books, report)
    files: list[str] = []
    images: list[tuple[str, str, str, bytes]] = []
    for done, (name, panel_of) in enumerate(PANELS.items()):
        report("figures", done, len(PANELS))
        panel = panel_of(books[preset])
        drawn = draw(panel, f"reading {READINGS[preset].key}: {READINGS[preset].title}")
        new, svg = keep(drawn, table(panel), folder, f"fig{name}")
        files += new
        images.append((name, panel.about, panel.note, svg))
    report("figures", len(PANELS), len(PANELS))

    report("page", 0, 1)
    text = json.dumps(as_json(ledger, preset), ensure_ascii=False, indent=1, allow_nan=False)
    write_text(folder / "claims.json", text + "\n")
    write_text(folder / "index.html", page(ledger, READINGS[preset], images))
    report("page", 1, 1)
    files += ["claims.json", "index.html"]
    return Summary(folder, preset, ledger, tuple(files))


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


def as_json(ledger: Ledger, preset: str) -> dict[str, Any]:
    """The content of claims.json."""
    from ...version import __version__

    data = study_data()

    def verdict(one: Verdict) -> dict[str, Any]:
        return {
            "values": list(one.measured.values) if one.measured.exists else None,
            "verdict": one.word,
            "why": one.why,
        }

    return {
        "paper": data["paper"],
        "version": __version__,
        "figures_drawn_with": preset,
        "load_range": data["load_range"],
        "definitions": data["definitions"],
        "readings": {
            name: {
                "key": reading.key,
                "title": reading.title,
                "passed": ledger.total(name),
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
                "allowed": claim.allowed,
                "rule": claim.rule,
                "remark": claim.remark,
                "conflicts_with": list(claim.conflicts),
                "results": {name: verdict(ledger.verdicts[name][claim.id]) for name in READINGS},
            }
            for claim in claims()
        ],
        "paper_booking": {
            name: {
                "passed": ledger.total(name, paper_booking=True),
                "gained": ledger.changed_by_booking(name)[0],
                "lost": ledger.changed_by_booking(name)[1],
                "results": {key: verdict(one) for key, one in ledger.paper_booking[name].items()},
            }
            for name in CONSISTENT
        },
        "errata": data["errata"],
    }
