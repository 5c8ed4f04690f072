"""Files that are no study: what they are, and which command reads them."""

from __future__ import annotations

import json
from pathlib import Path

from ..errors import Mistake, Problem

__all__ = ["problem_of_other_file"]

PICTURES = {
    b"\x89PNG": "a picture (PNG)",
    b"\xff\xd8\xff": "a picture (JPEG)",
    b"GIF8": "a picture (GIF)",
    b"%PDF": "a PDF",
}
"""How files for the eye begin."""
SHOWN = "no command reads it; give the study file whose answer it shows"
AGAIN = "give the study file that it is the answer of; in Python json.load reads it"
MEASURED = "thirdbody surface {0} reads a measured surface, and a study as roughness.topography"
ANSWERS = (
    ({"inputs", "states"}, "an answer that --json wrote (JSON)"),
    ({"problems"}, "a list of mistakes that --json printed (JSON)"),
    ({"curve", "units"}, "what thirdbody surface found (JSON)"),
)
"""Keys by which JSON of this program is known, and what it is."""


def problem_of_other_file(path: Path, content: bytes) -> Problem | None:
    """What a file is that is no study, and what reads it; None where it may be one.

    >>> print(problem_of_other_file(Path("a.png"), b"\\x89PNG..."))
    a.png is a picture (PNG) and no study file; no command reads it; give the study file whose \
answer it shows
    >>> problem_of_other_file(Path("a.toml"), b"[surfaces]") is None
    True
    """
    kind_and_reader = _kind_and_reader(path, content)
    if kind_and_reader is None:
        return None
    kind, reader = kind_and_reader
    rule = f"{path} is {kind} and no study file"
    return Problem("", rule, hint=reader.format(path), code=Mistake.UNREADABLE)


def _kind_and_reader(path: Path, content: bytes) -> tuple[str, str] | None:
    """What a file is, and what reads it."""
    for start, kind in PICTURES.items():
        if content.startswith(start):
            return kind, SHOWN
    end = path.suffix.lower()
    if content.startswith(b"PK\x03\x04"):
        return ("a workbook", SHOWN) if end == ".xlsx" else ("a packed file (ZIP)", MEASURED)
    if b"\0" in content:
        return "no text", MEASURED
    text = content.lstrip(b"\xef\xbb\xbf \t\r\n")
    if text.startswith(b"{"):
        return _kind_of_json(text)
    if text[:200].lstrip(b"<!").lower().startswith((b"doctype html", b"html")):
        return "a page (HTML)", SHOWN
    if end == ".svg" or text.startswith(b"<svg"):
        return "a picture (SVG)", SHOWN
    head = text.partition(b"\n")[0]
    if end == ".csv" and b"status" in head.split(b","):
        return "a table of states (CSV)", SHOWN
    if end == ".csv" and head[:1] not in b"#[" and b"," in head and b"=" not in head:
        return "a table (CSV)", "thirdbody life STUDY.toml --reports {0} reads reports of an oil"
    return None


def _kind_of_json(text: bytes) -> tuple[str, str] | None:
    try:
        held = json.loads(text)
    except (ValueError, RecursionError):
        return None
    keys = set(held) if isinstance(held, dict) else set()
    for needed, kind in ANSWERS:
        if needed <= keys:
            return kind, AGAIN
    return "JSON", "a study file is TOML: thirdbody new writes one to start with"
