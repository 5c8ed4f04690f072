"""A new study from a drawing, a study beside another, badges: the first look of the page."""

import tomllib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.errors import Note
from thirdbody.study import check
from thirdbody.study.dirty_oil import dirty_oil, read_filter
from thirdbody.views import oil_words

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app.examples import EXAMPLES, example
from thirdbody.app.new_study import FILED, KINDS, OILS, answer_so_far, first_study, oil_of, with_oil
from thirdbody.app.sliders import shift_code
from thirdbody.app.state import Answer, State
from thirdbody.app.tabs import before_after, error_bars, film, mode_map
from thirdbody.app.verdict import badge_of
from thirdbody.app.worker import mode_map as solved_map

LONG = ("gear", "linear-guide")
"""Kinds whose ground gives way, at each what-if anew."""


@pytest.mark.spread(5)
@pytest.mark.parametrize(
    "kind",
    [pytest.param(kind, marks=pytest.mark.slow) if kind in LONG else kind for kind in KINDS],
)
@pytest.mark.parametrize("oil", OILS)
def test_what_the_form_begins_runs(kind, oil):
    study = with_oil(first_study(kind), oil)
    assert oil_of(study) == oil
    answer = Answer(check(study))
    assert answer_so_far(answer).endswith(".")
    assert answer.contact.two_body == (oil == "clean")


@pytest.mark.parametrize("kind", FILED)
def test_the_form_begins_with_the_study_file_of_the_command_line(kind):
    folder = resources.files("thirdbody").joinpath("data/studies")
    file = tomllib.loads(folder.joinpath(f"{kind}.toml").read_text("utf-8"))
    made = first_study(kind)
    assert {**made, "title": ""} == {**file, "title": ""}


def test_a_designation_brings_its_dimensions_and_an_unknown_one_is_refused():
    assert first_study("ball-bearing", "6305")["body"]["outer_diameter"] == "62 mm"
    with refuses(Mistake.KIND, "", says='"9999"'):
        first_study("ball-bearing", "9999")


def test_the_oil_of_the_film_is_told_as_the_command_tells_it():
    study = first_study("ball-bearing", "6205")
    oil = dirty_oil(check(study))
    answer = Answer(check(study))
    assert answer_so_far(answer) == oil_words.answer(oil)[0]
    fine = dirty_oil(check(study), filter=read_filter("5=75, 10=1000"))
    shown = film.oil_of(answer, "5=75, 10=1000")
    assert shown.sentences[0] == oil_words.filter_answer(oil, fine)
    assert shown.rows == oil_words.filter_rows(oil, fine)


def test_two_studies_stand_side_by_side_with_the_numbers_of_both():
    old, new = example(), example()
    new["roughness"] = new["roughness"] | {"sigma": "200 nm"}
    assert before_after.changes(old, new) == ["roughness.sigma: 100 nm → 200 nm"]
    before, after = Answer(check(old)), Answer(check(new))
    found = before_after.compare_answers(before, after, 1e-5)
    shares = [float(tb.solve(a.contact, F_star=1e-5).A_t) for a in (before, after)]
    row = next(row for row in found.rows if row["name"] == "real contact area")
    assert row["before"] != row["after"]
    change = 100 * (shares[1] / shares[0] - 1)
    assert float(row["change"].split()[0].replace("−", "-")) == pytest.approx(change, abs=0.06)
    drawn = found.figures["shares"]["data"]
    assert [trace["name"] for trace in drawn] == ["before", "after"]
    assert drawn[1]["y"] == (100 * after.curves.particle_load_share).tolist()


@pytest.mark.parametrize("name", list(EXAMPLES))
def test_a_start_has_fewer_particles(name):
    study = example(name)
    fewer = before_after.cleaner(study)
    if "particles" not in study:
        assert fewer is None
        return
    many = [check(each).contact.populations[0].areal_density for each in (study, fewer)]
    # three classes of ISO 4406 are a factor of about eight: their limits are rounded
    assert many[0] / many[1] == pytest.approx(10.0, rel=0.25)


def test_a_code_shifted_there_and_back_is_the_same():
    assert shift_code(shift_code("18/16/13", 4), -4) == "18/16/13"


def test_a_badge_says_the_largest_effect():
    assert badge_of([]).kind == "holds"
    assert badge_of([Note("a", effect=0.02)]).kind == "near"
    largest = badge_of([Note("a", effect=0.5), "b"])
    assert (largest.kind, "50 %" in largest.words) == ("doubtful", True)


def test_a_map_in_nm_and_MPa_is_that_of_its_states():
    study, sizes, loads = example(), [1.0, 3.0, 9.0], [1e-6, 1e-5, 1e-4]
    found = solved_map(study=study, folder="/tmp", sizes=sizes, loads=loads, report=lambda p: None)
    contact = check(study).contact
    drawn = mode_map.map_figure(found, None)["data"][0]
    np.testing.assert_allclose(drawn["x"], 1e9 * contact.roughness.sigma * np.array(sizes))
    pressures = [float(tb.solve(contact, F_star=load).pressure) for load in loads]
    np.testing.assert_allclose(drawn["y"], 1e-6 * np.array(pressures))


def test_what_is_assumed_to_be_uncertain_is_ten_percent_of_what_stands_there(tmp_path):
    state = State(example(), tmp_path)
    ranges = error_bars.assumed_ranges(state)
    assert ranges["roughness.sigma"] == {"low": "90 nm", "high": "110 nm"}
    assert not error_bars.assumed_ranges(
        State(example() | {"uncertainty": {"inputs": ranges}}, tmp_path)
    )
    check(example() | {"uncertainty": {"inputs": ranges}})


# ---------------------------------------------------------------------------- in a browser
pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
import sys  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))
from test_browser import NAMELESS, UNREADABLE  # noqa: E402

PATIENCE = 120_000
DRAWN = "name => document.querySelector(`[data-figure='${name}']`)?.data?.length"
FIRST = {
    "Film": "film shares",
    "Connector": "connector",
    "Wafer": "plate",
    "Surface": "surface-heights",
    "Before / after": "before shares",
}
"""A figure of the tabs that once had a button before their answer; of Map, Laws, Explicit,
Outputs, Error bars and Design tests/app/test_browser.py sees that they answer without it."""


@pytest.fixture
def page(browser, address):
    made = browser.new_page(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    wrong = []
    made.set_default_timeout(PATIENCE)
    made.on("console", lambda m: m.type == "error" and wrong.append(m.text))
    made.on("pageerror", lambda error: wrong.append(str(error)))
    made.goto(address)
    made.wait_for_selector('[data-figure="section"] svg')
    yield made
    made.close()
    assert not wrong


@pytest.mark.check
def test_every_tab_answers_without_a_click(page):
    for name, figure in FIRST.items():
        page.get_by_role("tab", name=name, exact=True).click()
        page.wait_for_function(DRAWN, arg=figure, polling=200)
        badge = page.locator('[data-fact="validity"]')
        badge.wait_for()
        assert badge.get_attribute("aria-label").startswith("how far the answer holds: ")
    page.get_by_role("tab", name="Interface", exact=True).click()
    page.locator('[data-fact="validity"]').click()
    page.get_by_text("solve again with particle_law.friction_factor").first.wait_for()


@pytest.mark.check
def test_a_new_study_is_begun_from_a_drawing(page):
    page.locator('[data-path="new"]').click()
    so_far = page.locator('[data-fact="so far"]', has_text="dents")
    so_far.wait_for()
    assert page.evaluate(NAMELESS) == []
    assert page.evaluate(UNREADABLE) == []
    force = page.locator('.new-study [data-path="load.force"]')
    force.fill("-1 kN")
    force.press("Tab")
    page.locator(".new-study").get_by_text("must be > 0").wait_for()
    assert page.locator('[data-path="new.open"]').is_disabled()
    force.fill("1 kN")
    force.press("Tab")
    page.locator('[data-path="new.open"]:enabled').wait_for()
    so_far.wait_for()
    said = so_far.inner_text()
    page.locator('[data-path="new.open"]').click()
    page.locator('[data-fact="film: answer 0"]').get_by_text(said, exact=True).wait_for()
    assert page.locator('[data-slider="load.force"]').is_visible()
    page.locator('[data-path="film.filter"]').fill("5=75, 10=1000")
    page.locator('[data-fact="film: answer 0"]', has_text="the filter takes the dents").wait_for()
    page.locator('[data-slider="particles.iso4406"] [role="slider"]').focus()
    page.keyboard.press("ArrowLeft")
    page.locator(".sliders").get_by_text("oil 17/15/12").wait_for()
    page.get_by_role("tab", name="Before / after", exact=True).click()
    changed = page.locator('[data-figure="changes"]')
    changed.get_by_text("particles.0.iso4406: 18/16/13 → 17/15/12").wait_for()
    page.locator('[data-path="before.back"]').click()
    page.locator(".sliders").get_by_text("oil 18/16/13").wait_for()
