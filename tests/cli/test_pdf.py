"""``report --pdf``: drawn by a browser that is found, else refused before any work."""

import sys

import pytest
from command_line import refused

from thirdbody.errors import Mistake
from thirdbody.views import pdf

from .test_cli import CLEAN, run

browser = pytest.mark.skipif(pdf.find_browser() is None, reason="needs Chromium, Chrome or Edge")


@browser
@pytest.mark.check
def test_the_page_on_paper(tmp_path):
    """The same bytes every time, and our own file of an earlier run is replaced."""
    file = tmp_path / "report.pdf"
    done = run("report", CLEAN, "--pdf", file, "--out", tmp_path / "report.html")
    assert done.exit_code == 0, done.output
    first = file.read_bytes()
    assert first.startswith(b"%PDF")
    assert first.rstrip().endswith(b"%%EOF")
    assert b"/Creator (thirdbody" in first
    assert b"D:1980" in first
    assert run("report", CLEAN, "--pdf", file).exit_code == 0
    assert file.read_bytes() == first
    assert sorted(each.name for each in tmp_path.iterdir()) == ["report.html", "report.pdf"]
    file.write_bytes(b"mine")
    (problem,) = refused("report", CLEAN, "--pdf", file).problems
    assert problem.code is Mistake.UNWRITABLE
    assert str(file) in problem
    assert file.read_bytes() == b"mine"


@pytest.mark.parametrize("asked", [None, "no-such-browser"])
def test_without_a_browser_nothing_is_written(tmp_path, monkeypatch, asked):
    monkeypatch.setenv(pdf.BROWSER, asked or "")
    monkeypatch.setattr(pdf.shutil, "which", lambda name: None)
    out = tmp_path / "report.html"
    done = refused("report", CLEAN, "--pdf", tmp_path / "report.pdf", "--out", out)
    (problem,) = done.problems
    assert problem.code is Mistake.ABSENT
    assert (asked or "Chromium") in problem
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="a program of one line, as other systems run")
def test_a_browser_that_fails_leaves_nothing(tmp_path, monkeypatch):
    """What it says is told; the page that was asked for beside it is not written either."""
    program = tmp_path / "bin" / "browser"
    program.parent.mkdir()
    told = "no display here"
    program.write_text(f"#!{sys.executable}\nimport sys\nsys.exit({told!r})\n")
    program.chmod(0o755)
    monkeypatch.setenv(pdf.BROWSER, str(program))
    out = tmp_path / "out"
    out.mkdir()
    (problem,) = refused(
        "report", CLEAN, "--pdf", out / "report.pdf", "--out", out / "report.html"
    ).problems
    assert problem.endswith(told)
    assert not list(out.iterdir())
