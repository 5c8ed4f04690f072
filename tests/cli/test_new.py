"""``thirdbody new`` in an empty folder: files that run at once, at 80 columns."""

import fnmatch
import json
import re
import tomllib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from typer.testing import CliRunner

from thirdbody import cli, load_study
from thirdbody.cli.commands.new import KINDS
from thirdbody.errors import Mistake

ROOT = Path(__file__).parents[2]
FIRST = {
    **dict.fromkeys(("ball-bearing", "roller-bearing", "gear", "linear-guide"), "film"),
    "connector": "probability",
    "wafer-chuck": "plate",
    **dict.fromkeys(("oil-circuit", "dry-contact"), "life"),
}
"""The command that answers what a kind is for, where it is not `solve`."""


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


@pytest.mark.parametrize(
    "kind",
    [
        pytest.param(kind, marks=pytest.mark.slow)
        if kind in ("linear-guide", "gear")
        else pytest.param(kind, marks=pytest.mark.spread(3))
        for kind in KINDS
    ],
)
def test_every_kind_runs_at_once(kind, empty_folder):
    """That each is solved, tests/cli/test_every_way.py holds as well."""
    made = run("new", kind)
    assert made.exit_code == 0
    assert made.stdout == f"thirdbody {FIRST.get(kind, 'solve')} {kind}.toml\n"
    assert [path.name for path in empty_folder.iterdir()] == [f"{kind}.toml"]
    text = Path(f"{kind}.toml").read_text("utf-8")
    assert max(map(len, text.splitlines())) <= 80
    answered = run(FIRST.get(kind, "solve"), f"{kind}.toml", "--json")
    assert answered.exit_code == 0
    assert json.loads(answered.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["connector", "wafer-chuck"])
def test_a_question_is_solved_too(kind):
    """As if it were a contact, though another command answers it."""
    run("new", kind)
    solved = run("solve", f"{kind}.toml", "--json")
    assert solved.exit_code == 0
    assert "ok" in json.loads(solved.stdout)["states"]["status"]


@pytest.mark.parametrize("kind", KINDS)
def test_commands_in_the_file_are_commands(kind):
    """What the head of a file says to type reads the file as it stands."""
    run("new", kind)
    lines = Path(f"{kind}.toml").read_text("utf-8").splitlines()
    commands = [line for line in lines if re.match(r"#   thirdbody \w", line)]
    assert commands
    for line in commands:
        words = re.sub(r"\s{3,}.*", "", line.removeprefix("#   thirdbody ")).split(" ", 3)
        assert words[0] in {each.name for each in cli.app.registered_commands}
        if words[1] != "FILE":
            load_study(words[1], [words[3].replace('"', "")] if words[2:3] == ["--set"] else [])


def test_nothing_is_overwritten():
    run("new", "two-body")
    Path("two-body.toml").write_text("mine", "utf-8")
    (problem,) = refused("new", "two-body").problems
    assert problem.code is Mistake.UNWRITABLE
    assert problem.startswith("two-body.toml ")
    assert Path("two-body.toml").read_text("utf-8") == "mine"
    other = run("new", "two-body", "--out", "second.toml")
    assert other.stdout == "thirdbody solve second.toml\n"
    assert "thirdbody compare second.toml" in Path("second.toml").read_text("utf-8")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["balscrew"], "did you mean ball-screw?"),
        (["additive", "part.x3p"], "FILE part.x3p goes with measured-surface"),
        (["measured-surface", "part.x3p"], "there is no such file"),
    ],
)
def test_mistakes(arguments, words, empty_folder):
    done = run("new", *arguments)
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.split())
    assert not list(empty_folder.iterdir())


def test_a_file_of_ones_own(empty_folder):
    pytest.importorskip("SurfaceTopography")
    heights = np.random.default_rng(3).normal(0, 2e-7, (64, 64))
    np.savetxt("heights.txt", heights)
    assert run("new", "measured-surface", "heights.txt").exit_code == 0
    table = tomllib.loads(Path("measured-surface.toml").read_text("utf-8"))["roughness"]
    assert table == {"topography": "heights.txt", "unit": "m", "spacing": "1 um"}
    assert load_study("measured-surface.toml").contact.roughness.sigma > 0
    assert "asperity_law" not in tomllib.loads(Path("measured-surface.toml").read_text("utf-8"))
    Path("below").mkdir()
    run("new", "measured-surface", "heights.txt", "--out", "below/study.toml")
    table = tomllib.loads(Path("below/study.toml").read_text("utf-8"))["roughness"]
    assert (empty_folder / "below" / table["topography"]).exists()


def test_what_ships_is_declared():
    """Every file of the data folder is in the wheel."""
    tool = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    declared = tool["package-data"]["thirdbody"]
    package = Path(str(resources.files("thirdbody")))
    for file in sorted((package / "data").rglob("*")):
        name = file.relative_to(package).as_posix()
        if file.is_file():
            assert any(
                fnmatch.fnmatch(name, each) and name.count("/") == each.count("/")
                for each in declared
            ), name
    examples = tool["data-files"]["share/thirdbody/examples"]
    shipped = {path for each in examples for path in ROOT.glob(each)}
    assert shipped == {path for path in (ROOT / "examples").iterdir() if path.is_file()}
