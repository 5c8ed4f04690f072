"""Laws and outputs of one's own on the command line: files, and installed packages."""

import json
import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import pytest
from typer.testing import CliRunner

from thirdbody import cli
from thirdbody.effects import own_code
from thirdbody.laws import asperity
from thirdbody.quantities import installed

ROOT = Path(__file__).parents[2]


def code(page):
    return re.findall(
        r"^```python\n(.*?)^```$", (ROOT / "docs" / page).read_text("utf-8"), re.S | re.M
    )[0]


def process(*arguments, **more):
    command = [sys.executable, "-m", "thirdbody", *arguments]
    environment = os.environ | more
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "abrupt.py").write_text(code("add-a-law.md"), "utf-8")
    (tmp_path / "overload.py").write_text(code("add-an-output.md"), "utf-8")
    return tmp_path


@pytest.mark.check
def test_a_law_of_ones_own_is_solved():
    process("new", "two-body")
    law = '--set=asperity_law={name="abrupt",k=0.4}'
    found = process("solve", "two-body.toml", "--import", "abrupt.py", law, "--json")
    assert found.returncode == 0, found.stderr
    result = json.loads(found.stdout)
    assert result["inputs"]["asperity_law"]["type"] == "Abrupt"
    assert set(result["states"]["status"]) == {"ok"}
    first = process("--import", "abrupt.py", "solve", "two-body.toml", law, "--json")
    named = process("solve", "two-body.toml", law, "--json", THIRDBODY_IMPORT="abrupt.py")
    assert first.stdout == named.stdout == found.stdout
    without = process("solve", "two-body.toml", law)
    assert without.returncode == 2
    assert 'asperity_law.name = "abrupt" must be one of' in without.stderr


def test_tables_list_what_is_imported():
    found = process("laws", "--import", "abrupt.py", "--json")
    assert "abrupt" in [each["name"] for each in json.loads(found.stdout)["asperity"]]
    both = process("outputs", "--import", "abrupt.py", "--import", "overload.py")
    assert both.returncode == 0, both.stderr
    assert "overload" in both.stdout


@pytest.mark.parametrize("command", [each.name for each in cli.app.registered_commands])
def test_every_command_imports(command):
    done = CliRunner().invoke(cli.app, [command, "--help"], env={"COLUMNS": "100"})
    assert "--import FILE.py" in done.stdout


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("import numpy\n1 / 0\n", "mine.py, line 2: ZeroDivisionError: division by zero"),
        ("def (", "mine.py, line 1: SyntaxError"),
        ("import nowhere_at_all", "line 1: ModuleNotFoundError"),
        ("x = 1", "mine.py brings no law and no output"),
        ("LAW name = 'zmc'", "there is a law 'zmc' already"),
        ("LAW title = ''; del title", "Abrupt lacks title"),
        (None, "mine.py: there is no such file"),
    ],
)
def test_one_line_where_a_file_fails(text, words, folder):
    if text is not None:
        if text.startswith("LAW "):
            line = text.removeprefix("LAW ")
            key = line.split(" ")[0]
            text = re.sub(rf"^    {key} = .*$", f"    {line}", code("add-a-law.md"), flags=re.M)
        (folder / "mine.py").write_text(text, "utf-8")
    before = dict(asperity.REGISTRY)
    done = CliRunner().invoke(cli.app, ["laws", "--import", "mine.py"])
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: --import mine.py")
    assert words in line
    assert before == asperity.REGISTRY
    assert "mine" not in sys.modules


def test_installed_packages_are_found(folder, monkeypatch):
    """A good entry point brings its law; a broken one is told and left out."""
    (folder / "plugin_of_tests.py").write_text(
        code("add-a-law.md").replace('"abrupt"', '"abrupt-too"'), "utf-8"
    )
    monkeypatch.syspath_prepend(folder)
    law = EntryPoint("good", "plugin_of_tests", "thirdbody.laws")
    bad = EntryPoint("bad", "nowhere_at_all", "thirdbody.laws")
    monkeypatch.setattr(installed, "entry_points", lambda: EntryPoints([law, bad]))
    known = dict(asperity.REGISTRY)
    installed.offers.cache_clear()
    own_code._load_entry_points.cache_clear()
    try:
        with pytest.warns(UserWarning, match="entry point bad = nowhere_at_all") as heard:
            own_code.load_installed()
        assert len(heard) == 1
        assert asperity.REGISTRY["abrupt-too"]().breakpoints == (1.0,)
    finally:
        installed.offers.cache_clear()
        own_code._load_entry_points.cache_clear()
        asperity.REGISTRY.clear()
        asperity.REGISTRY.update(known)


def test_the_page_names_the_groups():
    text = (ROOT / "docs" / "add-a-law.md").read_text("utf-8")
    (example,) = (b for b in re.findall(r"^```toml\n(.*?)^```$", text, re.S | re.M) if "entry" in b)
    (group,) = tomllib.loads(example)["project"]["entry-points"]
    assert group in installed.GROUPS
