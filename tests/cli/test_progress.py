"""How far long commands are: on a terminal, and nowhere else."""

import math
import re

import pytest

from thirdbody.quantities import progress

from .test_cli import EXAMPLES, run

BY_NAME = {path.stem: path for path in EXAMPLES}
QUICK_DESIGN = (
    "--set",
    "design.points=4",
    "--set",
    'design.pressure=["5 MPa"]',
    "--set",
    "design.limits=[]",
)
LONG = {
    "assess": ("assess", "--set", "uncertainty.samples=64"),
    "report": ("dusty_ball_screw", "--set", "load.F_star.points=2"),
    "design": ("additive", *QUICK_DESIGN),
    "explicit": ("explicit", "--surfaces", "1", "--size", "128", "--set", "load.F_star=1e-5"),
}
UNCOUNTED = {
    "solve": ("quartz_in_bearing",),
    "compare": ("two_body_reference",),
    "film": ("oil_film",),
    "table": ("dusty_ball_screw", "--out", "table.csv", "--tolerance", "1e-2"),
    "explicit": LONG["explicit"],
}
"""Commands that say nothing at first."""


@pytest.mark.usefixtures("short_search")
@pytest.mark.parametrize("name", UNCOUNTED)
def test_long_work_says_in_a_pipe_that_it_goes_on(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(progress, "EVERY", 1e6)
    stem, *options = UNCOUNTED[name]
    quiet = run(name, BY_NAME[stem], *options)
    assert not [line for line in quiet.stderr.splitlines() if line.startswith(f"{name}: ")]
    monkeypatch.setattr(progress, "EVERY", 1e-3)
    done = run(name, BY_NAME[stem], *options)
    assert [line for line in done.stderr.splitlines() if line.startswith(f"{name}: ")]
    assert (done.exit_code, done.stdout) == (quiet.exit_code, quiet.stdout)


@pytest.mark.check
@pytest.mark.usefixtures("short_search")
@pytest.mark.parametrize("name", LONG)
def test_a_pipe_is_told_nothing(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # what takes long is told, also to a pipe
    monkeypatch.setattr(progress, "LONG", math.inf)
    monkeypatch.setattr(progress, "EVERY", 1e6)
    stem, *options = LONG[name]
    done = run(name, BY_NAME[stem], *options)
    assert done.exit_code in (0, 3), done.output
    left = [
        line
        for line in done.stderr.splitlines()
        if not re.match("warning: |note: .* more warning", line)
    ]
    assert left in ([], ["written: report.html"])


@pytest.mark.spread(2)
@pytest.mark.parametrize("name", ["assess", "report"])
def test_a_terminal_sees_every_part(name, tmp_path, monkeypatch, capfd):
    """In the order of the work; the answer on standard output stays what it is."""
    from rich.progress import Progress

    told = []
    update = Progress.update

    def heard(self, task, **what):
        if what["completed"] == int(what["completed"]):  # the beginning of a part
            told.append((what["completed"], what["description"]))
        update(self, task, **what)

    monkeypatch.chdir(tmp_path)
    stem, *options = LONG[name]
    quiet = run(name, BY_NAME[stem], *options)
    monkeypatch.setattr(Progress, "update", heard)
    monkeypatch.setattr(progress, "_terminal", lambda: True)
    seen = run(name, BY_NAME[stem], *options)
    assert seen.exit_code == 0, seen.output
    assert seen.stdout == quiet.stdout
    parts = {
        "assess": ["error bars", "what decides", "what would change the mode"],
        "report": ["states", "error bars", "which inputs matter", "figures"],
    }
    assert told == [(i, f"{name}: {part}") for i, part in enumerate(parts[name])]


@pytest.mark.parametrize(
    ("early", "told"), [(True, [1, 2, 3, 5, 6]), (False, [3, 6])], ids=["bar", "function"]
)
def test_no_state_is_told_twice(early, told, monkeypatch):
    """Two blocks of three states, told while they are solved and once they are written."""
    clock = iter(range(1, 100))
    monkeypatch.setattr(progress.time, "monotonic", lambda: float(next(clock)))
    monkeypatch.setattr(progress, "_ASIDE", [500.0])
    heard = []
    cost = progress.Cost(6, heard.append, early=early)
    for counts, written in (((1, 0.5, 0.5, 1), 3), ((0, 2, 1), 6)):
        for count in counts:
            cost(count)
        cost.report_finished(written)
    assert heard == told
