"""The book: what it says once, what it makes from the program, its words, keywords and versions."""

import dataclasses
import enum
import importlib.util
import re
import shlex
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody.cli import app
from thirdbody.study.schema import study_schema

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS / "_ext"))
from facts import facts, insert_facts  # noqa: E402
from pages import columns, commands, study_file  # noqa: E402
from search import KEYWORDS, insert_keywords  # noqa: E402

pytestmark = pytest.mark.check
PAGES = sorted(DOCS.glob("*.md"))


# ---------------------------------------------------------------- plain words
# verbs of persons for things, and words that are no terms: what readers stumbled over
STUMBLES = re.compile(
    r"\b(?:is|are|was|were|be) told\b|\btold of\b|\bluck\b|\b(?:is|are) worth\b|\bat the door\b|"
    r"\b(?:code|file|law|formula|histogram|model|table|field|spectrum|cap|friction)s? (?:hardly )?"
    r"(?:knows?|believes?|thinks?)\b|`\w+`,? (?:hardly )?(?:knows?|wants?)\b"
)


@pytest.mark.parametrize(
    "page", [ROOT / "README.md", ROOT / "PACKAGE.md", *PAGES], ids=lambda p: p.name
)
def test_things_do_what_things_do(page):
    if page.name not in {"changelog.md", "reproduction.md"}:
        assert STUMBLES.findall(page.read_text("utf-8")) == []


SHORT = {"index.md", "begin.md", "help.md", "glossary.md", "nomenclature.md", "tutorials.md"}
# of other files, or made by a command
NOT_HERE = {
    "release.md",
    "changelog.md",
    "contribute.md",
    "speed.md",
    "laws.md",
    "outputs.md",
    "materials.md",
}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_says_first_what_it_says(page):
    """After the title comes what the page says, in short."""
    if page.name not in SHORT | NOT_HERE:
        body = page.read_text("utf-8").partition("\n")[2].lstrip()
        assert body.startswith("**In short**: "), page.name


# ---------------------------------------------------------------- one statement of each number
STATED = re.compile(
    r"4, 6,? (?:and )?11 %|0\.035 ?σ|\d+ lost, \d+ undecided|\d+ of 84\b|"
    r"\b8 to (?:21|43) %|23 to 43 %|19 to 30 %|\b6\.2 %|\b0\.014 ?σ|up to 23 %"
)
# pages of papers say their own numbers, which tests of the papers hold
OF_PAPERS = {"reproduction.md", "errata.md", "equations.md", "changelog.md"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_what_is_said_in_several_places_comes_from_one(page):
    if page.name not in OF_PAPERS:
        assert STATED.findall(page.read_text("utf-8")) == [], (
            "write {{ name }}, see docs/_ext/facts.py"
        )
    insert_facts(page.read_text("utf-8"), page.name)


def test_a_fact_that_is_none_is_an_error():
    with pytest.raises(KeyError, match=r"a\.md: no fact nothing"):
        insert_facts("{{ nothing }}", "a.md")


def test_readme_says_what_the_book_says():
    text = " ".join((ROOT / "README.md").read_text("utf-8").split())
    said = facts()
    for each in (
        f"within {said['agreement_share']}",
        f"within {said['agreement_separation']}",
        f"{said['measurements_word']} published measurements",
        said["measurements_verdict"],
        f"{said['life_measurements']} measurements of the life of an oil",
        f"{said['life_lost']} lost, {said['life_undecided']} undecided, {said['life_met']} met**, "
        f"{said['life_built_in']} that test nothing",
        f"{said['paper_statements']} statements",
        f"{said['paper_published']} hold, {said['paper_consistent']} hold",
        f"[{said['materials']} materials]",
        f"real area above {said['area_close']}",
        f"{said['off_crowded']} too high",
        f"Version {'.'.join(said['version'].split('.')[:2])}.",
    ):
        assert each in text, each


# ---------------------------------------------------------------- made from the program
def test_the_reference_has_every_key_with_its_meaning():
    text = study_file()
    for name, table in study_schema()["properties"].items():
        for way in (table, *table.get("anyOf", [])):
            for key in way.get("properties", {}):
                part = text.split(f"(study-{name})=\n")[1].split("\n(study-")[0]
                assert f"| `{key}` |" in part, f"{name}.{key}"
    assert re.findall(r"^\| `\w+` \|  \|.*$", text, re.M) == []


def test_the_reference_has_every_command_and_option():
    text = commands()
    for name, command in typer.main.get_command(app).commands.items():
        part = text.split(f"## `thirdbody {name}`\n")[1].split("\n## ")[0]
        for item in command.params:
            if item.param_type_name == "option" and not item.hidden:
                assert item.opts[0] in part, f"{name} {item.opts[0]}"


def test_every_field_of_every_result_is_explained():
    text = columns()
    for name in tb.results.__all__:
        kind = getattr(tb.results, name)
        part = text.split(f"## `{name}`\n")[1].split("\n## ")[0]
        for item in kind if issubclass(kind, enum.Enum) else dataclasses.fields(kind):
            if not item.name.startswith("_"):
                assert re.search(rf"^\| (?:`\w+`, )*`{item.name}`", part, re.M), (
                    f"{name}.{item.name}"
                )


CONSOLE = re.compile(r"^```console\n(.*?)^```\n(.*?)^```text\n(.*?)^```$", re.S | re.M)
ON_COMMAND = [page for page in PAGES if CONSOLE.search(page.read_text("utf-8"))]


@pytest.mark.parametrize("page", ON_COMMAND, ids=lambda page: page.name)
def test_commands_of_the_page_print_what_it_shows(page, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    for lines, between, shown in CONSOLE.findall(insert_facts(page.read_text("utf-8"))):
        assert "```" not in between, page.name
        for line in lines.splitlines():
            program, *words = shlex.split(line.removeprefix("$ "))
            assert program == "thirdbody"
            done = CliRunner().invoke(app, words)
            assert done.exit_code == 0, done.stderr
        printed = [line.rstrip() for line in done.stdout.splitlines()]
        kept = iter(printed)
        for line in shown.splitlines():
            assert line == "..." or line.rstrip() in kept, f"{line!r} is not in\n{done.stdout}"


def test_every_keyword_leads_to_one_page_that_exists():
    words = [word.lower() for several in KEYWORDS.values() for word in several]
    assert len(words) == len(set(words))
    assert [page for page in KEYWORDS if not (DOCS / f"{page}.md").is_file()] == []
    text = insert_keywords("# A title\n\nwords\n", "faq")
    assert text.startswith("# A title\n\n```{index} ! FAQ, ")
    assert insert_keywords("# A title\n", "no-such-page") == "# A title\n"


# ---------------------------------------------------------------- versions beside each other
def test_the_switch_lists_the_versions_of_the_folder(tmp_path):
    made = importlib.util.spec_from_file_location("versions_of_book", DOCS / "versions.py")
    versions = importlib.util.module_from_spec(made)
    made.loader.exec_module(versions)
    for version in ("0.9.0", "0.10.0"):
        (tmp_path / version).mkdir()
        (tmp_path / version / "objects.inv").touch()
    (tmp_path / "not-a-book").mkdir()
    versions.add_switch(tmp_path, "0.2.0")
    switch = (tmp_path / "versions.js").read_text("utf-8")
    assert switch == 'window.BOOK_VERSIONS = ["0.10.0", "0.9.0", "0.2.0"];\n'
    assert 'url=0.2.0/index.html"' in (tmp_path / "index.html").read_text("utf-8")
