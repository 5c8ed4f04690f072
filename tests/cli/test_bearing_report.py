"""The report of a bearing: what it lists, what its error bars are of, and the study it holds."""

import html
import json
import re

import pytest
from refusals import Mistake, refuses
from typer.testing import CliRunner

from thirdbody import cli, load_study
from thirdbody.quantities.say import value_of
from thirdbody.views.bearing_words import sharing
from thirdbody.views.html import words
from thirdbody.views.oil_words import HANGS_ON

FILTER = "5=75, 10=1000"
SET = "load.force=1 kN"


def run(*arguments, code=0):
    done = CliRunner().invoke(cli.app, [str(argument) for argument in arguments])
    assert done.exit_code == code, done.stderr
    return done


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("bearing")
    run("new", "ball-bearing", "6205", "--out", place / "b.toml")
    run("report", place / "b.toml", "--filter", FILTER, "--set", SET, "--out", place / "r.html")
    return place


def row(page, name):
    """The cells of the row of an input."""
    (line,) = [each for each in re.findall(r"<tr>.*?</tr>", page, re.DOTALL)
               if re.sub("<wbr>", "", each).endswith(f"<td>{name}</td></tr>")]  # fmt: skip
    return [re.sub("<[^>]*>", "", cell) for cell in re.findall(r"<td.*?</td>", line, re.DOTALL)]


@pytest.mark.check
def test_the_study_in_a_report_gives_the_same_report(folder):
    """With what was set, and with the filter: the same bytes."""
    page = (folder / "r.html").read_text()
    study = html.unescape(re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)[-1])
    kept, written = (
        {line.partition("#")[2] for line in text.splitlines() if "#" in line}
        for text in (study, (folder / "b.toml").read_text("utf-8"))
    )
    assert len(written & kept) > 10  # what a person wrote stays
    (folder / "again.toml").write_text(study)
    run("report", folder / "again.toml", "--out", folder / "again.html")
    assert (folder / "again.html").read_bytes() == (folder / "r.html").read_bytes()


@pytest.mark.check
def test_a_report_lists_the_bearing_and_its_load(folder):
    page = (folder / "r.html").read_text()
    assert row(page, "body.bore")[2:4] == ["25 mm", "study"]
    assert row(page, "body.shaft_speed")[2:4] == ["3000 rpm", "study"]
    assert row(page, "load.force")[2:4] == ["1000 N", "study"]
    assert row(page, "film.oil.eta")[2:4] == ["0.02 Pa s", "study"]
    bearing = re.search(r"<h2>The bearing</h2>.*?</section>", page, re.DOTALL)[0]
    asked = load_study(folder / "b.toml", [SET])
    most = asked.body.share_load(1000.0, asked.contact.E_ss).largest
    sentence = sharing(asked)
    assert value_of(most, "N") in sentence
    assert words(sentence) in bearing


@pytest.mark.check
def test_what_a_study_states_is_no_default_be_it_the_same(folder):
    page = (folder / "r.html").read_text()
    assert row(page, "body.inner_conformity")[2:4] == ["0.52", "study"]
    assert row(page, "film.hertz")[2:4] == ["mean", "default"]
    openpyxl = pytest.importorskip("openpyxl")
    run("film", folder / "b.toml", "--xlsx", folder / "f.xlsx")
    rows = {line[5].value: line[4].value
            for line in openpyxl.load_workbook(folder / "f.xlsx")["Inputs"].iter_rows()}  # fmt: skip
    assert rows["body.inner_conformity"] == rows["body.ring"] == rows["load.force"] == "study"
    assert rows["film.hertz"] == rows["asperity_law"] == "default"


def test_parts_that_leave_the_oil_out_say_so(folder):
    page = (folder / "r.html").read_text()
    heads = re.findall("<h2>(.*?)</h2>", page)
    for part in ("Figures", "States", "Error bars", "Which inputs matter"):
        assert f"{part}, without the oil" in heads
    bars = re.search("<h2>Error bars, .*?</section>", page, re.DOTALL)[0]
    assert HANGS_ON in bars  # which part says how sure the oil is
    assert f"<h3>{HANGS_ON}</h3>" in page


@pytest.mark.check
def test_a_filter_of_the_study_file_is_that_of_the_option(folder):
    run("film", folder / "b.toml", "--filter", FILTER, "--json", folder / "option.json")
    told = ("--set", f'film.filter="{FILTER}"')
    run("film", folder / "b.toml", *told, "--json", folder / "key.json")
    by_option, by_key = (json.loads((folder / f"{name}.json").read_text())
                         for name in ("option", "key"))  # fmt: skip
    assert by_key["oil_filtered"] == by_option["oil_filtered"]
    assert by_key == by_option


@pytest.mark.parametrize(
    ("value", "mistake"),
    [("75", Mistake.KIND), ('"5:75"', Mistake.FORM), ('"5=0.5"', Mistake.RANGE)],
)
def test_a_filter_that_is_none_is_refused_by_its_key(folder, value, mistake):
    with refuses(mistake, "film.filter"):
        load_study(folder / "b.toml", [f"film.filter={value}"])


def test_a_filter_without_particles_is_refused_by_its_key(folder):
    clean = folder / "clean.toml"
    text = (folder / "b.toml").read_text().partition("[[particles]]")[0]
    clean.write_text(text.replace("[film] ", '[film]\nfilter = "5=75" '))
    with refuses(Mistake.MISSING, "film.filter"):
        load_study(clean)
