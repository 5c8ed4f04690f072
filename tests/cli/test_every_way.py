"""One answer by every way: command line, Python, page, report, workbook and PDF, of each template."""

import html
import io
import re
import shutil
import subprocess
import tomllib
import warnings
from functools import cache
from importlib import resources

import numpy as np
import pytest

from thirdbody.cli.commands.new import KINDS
from thirdbody.quantities.say import percent, value_of
from thirdbody.study import load_study, run_film, run_study
from thirdbody.study.dirty_oil import dirty_oil
from thirdbody.study.run_connector import load_connector, run_connector
from thirdbody.study.run_plate import load_plate, run_plate
from thirdbody.views import connector_words, oil_words, pdf, plate_words, state_words
from thirdbody.views.report.make import curve_over
from thirdbody.views.report.page import Report
from thirdbody.views.study_sheets import state_sheets
from thirdbody.views.workbook import workbook_bytes

from .test_cli import run
from .test_same_digits import compare_tables, grid

openpyxl = pytest.importorskip("openpyxl", reason="needs the extra: pip install 'thirdbody[xlsx]'")
QUESTIONS = {"connector": "probability", "wafer-chuck": "plate"}
SOLVED = [kind for kind in KINDS if kind not in QUESTIONS]
QUICK = ("ball-screw", "additive", "two-body")
EVERY = [kind if kind in QUICK else pytest.param(kind, marks=pytest.mark.check) for kind in SOLVED]
"""Templates of which those that take seconds are left to the long run."""
LONG = ("linear-guide", "gear")
SPREAD = [pytest.param(kind, marks=pytest.mark.check) if kind in LONG else kind for kind in SOLVED]
"""Templates of which those are left to the long run whose ground gives way, at each what-if anew."""
ON_PAPER = ("ball-bearing", "ball-screw", "additive", "two-body")
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


def template(kind):
    """A template in this folder, and what Python finds of it."""
    assert run("new", kind).exit_code == 0
    return f"{kind}.toml"


@cache
def solved(kind):
    """What Python finds of a template."""
    file = resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return run_study(load_study(file))


def report_of(result):
    """The report without error bars and elasticities, which take minutes."""
    study = result.study
    loads = sorted(float(F) for F in np.atleast_1d(result.states.F_star) if F > 0)
    return Report(
        study=study,
        result=result,
        curve=curve_over(study.contact.replace(outputs=()), result.transitions, loads),
        assessment=None,
        slopes=None,
        at=result.solved_states[0],
        film=None if study.film is None else run_film(study),
        oil=dirty_oil(study),
    )


def words(text):
    """A text without its line breaks."""
    return " ".join(text.split())


def bare(text):
    """A text without blanks and subscripts, which a page and paper set in their own ways."""
    return re.sub(r"[\s_]", "", text)


def words_of_page(page):
    return bare(html.unescape(re.sub(r"<[^>]+>", "", page)))


def first_numbers(result):
    """Separation, area and load share of the first state, as they are printed."""
    states = result.states
    out = [value_of(states.h[0], "m"), percent(states.A_t[0])]
    return out if result.study.contact.two_body else [*out, percent(states.particle_load_share[0])]


@pytest.mark.check
@pytest.mark.parametrize("kind", SPREAD)
def test_the_answer_stands_first_and_within_80_columns(kind):
    done = run("solve", template(kind))
    assert done.exit_code == 0, done.output
    assert max(map(len, done.stdout.splitlines())) <= 80
    result = solved(kind)
    told = state_words.answer(result)
    assert 1 <= len(told) <= 2
    shown = words(done.stdout)
    head = words(f"{result.title} (thirdbody {result.to_dict()['version']})")
    assert shown.startswith(f"{head} {' '.join(told)}")
    (most,) = state_words.uncertainty(result)
    assert most in shown
    assert re.match(r"Most uncertain: .+\. With .+, .+ to .+; .+\.", most)
    marked = [line for line in done.stderr.splitlines() if line.startswith(("note: ", "warning: "))]
    assert len([line for line in marked if "--verbose shows all" not in line]) <= 3


@pytest.mark.check
@pytest.mark.parametrize("kind", EVERY)
def test_report_and_workbook_hold_the_answer(kind):
    result = solved(kind)
    sentences = [*state_words.answer(result), *state_words.uncertainty(result)]
    page = words_of_page(report_of(result).html())
    oil = dirty_oil(result.study)
    lead = sentences if oil is None else oil_words.answer(oil)
    for text in (*lead, *first_numbers(result)):
        assert bare(text) in page
    book = openpyxl.load_workbook(io.BytesIO(workbook_bytes(state_sheets(result))))
    told = [str(cell.value) for cell in book["Answer"]["A"] if cell.value is not None]
    assert set(sentences) <= set(told)
    heads = [cell.value for cell in book["States"][1]]
    first = {name: cell.value for name, cell in zip(heads, book["States"][2], strict=True)}
    assert first["h [m]"] == pytest.approx(float(result.states.h[0]), rel=1e-15)


@pytest.mark.parametrize("kind", EVERY)
def test_the_page_has_the_same_states(kind, folder):
    pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
    from thirdbody.app.state import State
    from thirdbody.app.tabs import interface

    if kind == "measured-surface":
        pytest.skip("its file is uploaded")
    data = tomllib.loads((folder / template(kind)).read_text("utf-8"))
    answer, result = State(data, folder).answer, solved(kind)
    states = answer.solve(result.study.values)
    for name in ("h", "A_t", "particle_load_share"):
        np.testing.assert_array_equal(getattr(states, name), getattr(result.states, name))
    if result.forces:
        assert interface.force_sentences(answer.forces) == result.force_sentences


@pytest.mark.check
@pytest.mark.parametrize("kind", QUESTIONS)
def test_a_question_has_one_answer(kind, folder):
    file = template(kind)
    if kind == "connector":
        found, told = run_connector(load_connector(file)), connector_words
    else:
        found, told = run_plate(load_plate(file)), plate_words
    done = run(QUESTIONS[kind], file, "--xlsx", "a.xlsx")
    assert done.exit_code == 0, done.output
    shown = words(done.stdout)
    sentences = told.answer(found)
    assert shown.startswith(words(f"{found.title} (thirdbody"))
    assert shown.index(sentences[0]) < shown.index("Most uncertain: ")
    book = openpyxl.load_workbook("a.xlsx")
    assert book.sheetnames == ["Answer", "States", "Inputs", "Notes"]
    held = [str(cell.value) for cell in book["Answer"]["A"] if cell.value is not None]
    for sentence in [*sentences, *told.uncertainty(found)]:
        assert sentence in shown
        assert sentence in held
    rows = told.rows(found)
    heads = told.heads(found) if hasattr(told, "heads") else told.HEADS
    compare_tables((list(heads), rows), grid(book["Answer"], heads[0]))
    inputs = {row[5].value for row in book["Inputs"].iter_rows(min_row=2)}
    assert {"connector": "connector.contacts", "wafer-chuck": "plate.thickness"}[kind] in inputs
    pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
    from thirdbody.app.state import State
    from thirdbody.app.tabs import connector, plate

    data = tomllib.loads((folder / file).read_text("utf-8"))
    tab = connector if kind == "connector" else plate
    drawn = tab.contents_of(State(data, folder).answer)
    assert (drawn.answer, drawn.rows) == (sentences, rows)


@pytest.mark.check
@pytest.mark.skipif(pdf.find_browser() is None, reason="needs Chromium, Chrome or Edge")
@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="needs pdftotext of poppler")
@pytest.mark.parametrize("kind", ON_PAPER)
def test_paper_holds_the_answer(kind, folder):
    report = report_of(solved(kind))
    (folder / "a.pdf").write_bytes(pdf.pdf_of(report.html()))
    command = ["pdftotext", "-layout", "a.pdf", "-"]
    text = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=True)
    held = bare(text.stdout)
    for told in (report.lead[0], *first_numbers(report.result)):
        assert bare(told) in held


def test_every_template_is_here():
    assert {*SOLVED, *QUESTIONS} == set(KINDS)
