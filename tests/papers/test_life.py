"""The ledger of the life of an oil: lost rows first, each with its standing, nothing fitted."""

import json

import pytest

from thirdbody import InvalidValue
from thirdbody.papers import PAPERS, life
from thirdbody.papers.measurements.row import STANDINGS, WORDS, word_of

VERDICTS = {
    "diesel1983": "lost",
    "balance2017": "met",
    "anderson": "met",
    "filters1979": "lost",
    "oleic1970": "lost",
}


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    return life.reproduce(tmp_path_factory.mktemp("life"))


def test_every_row_is_judged_and_the_lost_ones_stand_first(done):
    assert "life" in PAPERS
    words = {row.name: word_of(dict(done.ledger[row.name])) for row in done.rows}
    assert words == VERDICTS
    places = [WORDS.index(words[row.name]) for row in done.rows]
    assert places == sorted(places)


def test_every_statement_and_input_has_its_standing():
    for row in life.ROWS:
        assert {one.standing for one in row.inputs} <= set(STANDINGS)
        assert {one.claim.standing for one in row.statements} <= set(STANDINGS)
        assert row.means
        assert row.source


def test_what_the_model_keeps_constant_is_lost(done):
    engine = done.ledger["diesel1983"]
    assert engine["ageing"].word == engine["speed"].word == "lost"
    assert engine["ageing"].band.best == 1
    assert engine["generation"].band.best == pytest.approx(2, rel=1e-9)
    assert engine["balance"].word == "undecided"


def test_coarser_filters_leave_more_dirt():
    for turnover in life.TURNOVERS:
        dirt = [life.dirt_behind(size, turnover) for size in life.FILTERS]
        assert dirt == sorted(dirt)


def test_the_files_say_the_same(done):
    found = json.loads((done.out / "life.json").read_text("utf-8"))
    assert len(found["measurements"]) == len(VERDICTS)
    assert found["totals"] == {"lost": 3, "undecided": 0, "met": 2}
    page = (done.out / "index.html").read_text("utf-8")
    assert "The life of an oil against measurements" in page
    assert page.index("Debris in a diesel engine") < page.index("Sizes reach their equilibrium")


def test_there_is_no_preset(tmp_path):
    with pytest.raises(InvalidValue, match="no meaning for the life"):
        life.reproduce(tmp_path, preset="a")
