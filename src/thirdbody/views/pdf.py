"""A page as PDF, drawn by a browser of this machine; the same bytes every time of one browser."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ..errors import InvalidValue, Mistake
from ..version import __version__

__all__ = ["find_browser", "need_browser", "pdf_of"]

BROWSER = "THIRDBODY_BROWSER"
"""Environment variable that names the browser."""
COMMANDS = (
    *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"),
    *("microsoft-edge", "microsoft-edge-stable", "msedge"),
)
PLACES = {
    "darwin": (
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
        "/Applications/Chromium.app/Contents/MacOS/Chromium",
        "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    ),
    "win32": (
        r"%ProgramFiles%\Google\Chrome\Application\chrome.exe",
        r"%ProgramFiles(x86)%\Google\Chrome\Application\chrome.exe",
        r"%LocalAppData%\Google\Chrome\Application\chrome.exe",
        r"%ProgramFiles(x86)%\Microsoft\Edge\Application\msedge.exe",
        r"%ProgramFiles%\Microsoft\Edge\Application\msedge.exe",
    ),
}
"""Where browsers lie that are no commands."""
PATIENCE = 120.0
"""Seconds that a browser may take."""


def find_browser() -> str | None:
    """The program of a browser that prints pages: Chromium, Chrome or Edge; None without one."""
    if program := os.environ.get(BROWSER):
        return shutil.which(program)
    places = map(os.path.expandvars, PLACES.get(sys.platform, ()))
    return next(filter(None, map(shutil.which, (*COMMANDS, *places))), None)


def need_browser() -> str:
    """The program of a browser.

    Raises
    ------
    InvalidValue
        There is none.
    """
    browser = find_browser()
    if browser is None:
        program = os.environ.get(BROWSER)
        lacking = f"{BROWSER} = {program} is no program" if program else "none of them was found"
        raise InvalidValue(
            f"a PDF is drawn by Chromium, Chrome or Edge, and {lacking}; install one, name its "
            f"program in {BROWSER}, or open the HTML page in any browser and print it",
            code=Mistake.ABSENT,
        )
    return browser


def pdf_of(page: str) -> bytes:
    """A page, as `thirdbody.views.html.document` makes it, on paper.

    Raises
    ------
    InvalidValue
        There is no browser, or it makes no PDF.
    """
    browser = need_browser()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        source, target = folder / "page.html", folder / "page.pdf"
        source.write_text(page, encoding="utf-8", newline="")
        words = [
            *(browser, "--headless", "--disable-gpu", "--no-first-run", "--disable-extensions"),
            *("--no-pdf-header-footer", "--print-to-pdf-no-header"),
            *(f"--user-data-dir={folder / 'profile'}", f"--print-to-pdf={target}"),
        ]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            words.append("--no-sandbox")  # which it refuses to start without
        try:
            done = subprocess.run(
                [*words, source.as_uri()], capture_output=True, timeout=PATIENCE, check=False
            )
        except subprocess.TimeoutExpired:
            raise InvalidValue(
                f"{browser} made no PDF within {PATIENCE:g} s", code=Mistake.UNWRITABLE
            ) from None
        except OSError as error:
            raise InvalidValue(
                f"{browser} cannot be started: {error.strerror}", code=Mistake.UNWRITABLE
            ) from None
        held = target.read_bytes() if target.is_file() else b""
    if not held.startswith(b"%PDF"):
        said = done.stderr.decode("utf-8", "replace").strip().splitlines()
        why = said[-1][:200] if said else f"exit status {done.returncode}"
        raise InvalidValue(f"{browser} made no PDF: {why}", code=Mistake.UNWRITABLE)
    return _without_chance(held)


def _without_chance(pdf: bytes) -> bytes:
    """A PDF that says thirdbody made it, and no time; its nodes are numbered as they follow.

    A browser counts nodes on from those that it made while it read the page, which differ with
    what else the machine does. No byte moves, as places in the file are counted.

    >>> _without_chance(b"/Creator (A browser)/ModDate (D:20260102030405+01'00')")[-34:]
    b"/ModDate (D:19800101000000+00'00')"
    >>> _without_chance(b"/ID (node00000048) /ID (node00000050) /Headers [(node00000048)]")
    b'/ID (node00000001) /ID (node00000002) /Headers [(node00000001)]'
    """
    held = re.sub(
        rb"/(CreationDate|ModDate) \(D:\d{14}[+-]\d\d'\d\d'\)",
        rb"/\1 (D:19800101000000+00'00')",
        pdf,
    )
    nodes = sorted(set(re.findall(rb"\(node(\d{8})\)", held)))
    numbers = {node: b"%08d" % number for number, node in enumerate(nodes, start=1)}
    held = re.sub(rb"\(node(\d{8})\)", lambda match: b"(node%b)" % numbers[match[1]], held)
    ours = f"/Creator (thirdbody {__version__})".encode()

    def creator(match: re.Match[bytes]) -> bytes:
        return ours.ljust(len(match[0])) if len(ours) <= len(match[0]) else match[0]

    return re.sub(rb"/Creator \((?:[^()\\]|\\.)*\)", creator, held, count=1)
