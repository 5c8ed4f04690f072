"""The tabs Connector and Wafer: what they show is what the command line prints."""

import os
import tomllib
from importlib import resources
from pathlib import Path

import pytest
from refusals import Mistake, refuses

from thirdbody.study import check
from thirdbody.study.run_connector import run_connector
from thirdbody.study.run_life import run_life
from thirdbody.study.run_plate import run_plate
from thirdbody.views import connector_words, life_words, plate_words

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app.state import Answer, refuse_foreign_files
from thirdbody.app.tabs import connector, life, plate

TABS = {"connector": ("connector", connector), "plate": ("wafer-chuck", plate)}


def study_of(kind):
    folder = resources.files("thirdbody").joinpath("data/studies")
    return tomllib.loads(folder.joinpath(f"{kind}.toml").read_text("utf-8"))


def printed(tab, study):
    """Answer, table and what is uncertain, as the commands print them."""
    if tab == "connector":
        found, words = run_connector(study.connector), connector_words
    else:
        found, words = run_plate(study.plate), plate_words
    return words.answer(found), words.rows(found), words.uncertainty(found)


@pytest.mark.parametrize("tab", TABS)
def test_the_tab_shows_what_the_command_prints(tab):
    kind, module = TABS[tab]
    study = check(study_of(kind))
    shown = module.contents_of(Answer(study))
    answer, rows, notes = printed(tab, study)
    assert (shown.answer, shown.rows) == (answer, rows)
    assert shown.notes[: len(notes)] == notes
    assert len(shown.figure["data"]) >= 2


@pytest.mark.parametrize("tab", TABS)
def test_a_study_without_the_table_is_answered_for_the_start(tab):
    kind, module = TABS[tab]
    data = study_of(kind)
    del data[tab]
    data["load"] = {"pressure": "1 MPa"}
    shown = module.contents_of(Answer(check(data)))
    begun = check(data | {tab: module.START})
    assert shown.answer == printed(tab, begun)[0]


# ---------------------------------------------------------------------------- in a browser
pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")

from thirdbody.app.text import to_link  # noqa: E402

PATIENCE = 90_000


@pytest.fixture
def visit(browser, address):
    context = browser.new_context(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    page, wrong = context.new_page(), []
    page.set_default_timeout(PATIENCE)
    page.on("console", lambda m: m.type == "error" and wrong.append(f"console: {m.text}"))
    page.on("pageerror", lambda error: wrong.append(f"page: {error}"))

    def open_page(study, tab):
        page.goto(f"{address}/?{to_link(study)}&tab={tab}")
        page.locator(f'[data-fact="{tab}: answer 0"]').wait_for()
        return page

    yield open_page
    context.close()
    assert not wrong


def shot(page, name):
    folder = os.environ.get("THIRDBODY_SCREENSHOTS")
    for width in (1280, 390) if folder else ():
        for scheme in ("light", "dark"):
            page.set_viewport_size({"width": width, "height": 860})
            page.emulate_media(color_scheme=scheme)
            page.wait_for_timeout(800)
            Path(folder).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=Path(folder) / f"{name}-{width}-{scheme}.png", full_page=True)
    page.set_viewport_size({"width": 1280, "height": 860})


def fact(page, name):
    return page.locator(f'[data-fact="{name}"]').first.inner_text().replace("\u00a0", " ")


@pytest.mark.check
@pytest.mark.parametrize("tab", TABS)
def test_the_page_answers_first(visit, tab):
    kind, _ = TABS[tab]
    data = study_of(kind)
    page = visit(data, tab)
    answer, rows, _ = printed(tab, check(data))
    assert fact(page, f"{tab}: answer 0") == answer[0]
    assert fact(page, f"{tab}: answer 1") == answer[1]
    for cell in rows[0]:
        page.get_by_text(cell, exact=True).first.wait_for()
    shot(page, tab)


@pytest.mark.check
def test_a_connector_is_begun_changed_and_removed(visit):
    data = study_of("connector")
    del data["connector"]
    page = visit(data | {"load": {"pressure": "1 MPa"}}, "connector")
    before = fact(page, "connector: answer 0")
    shot(page, "connector-start")
    page.locator('[data-path="connector.add"]').click()
    field = page.locator('[data-path="connector.force"]')
    field.wait_for()
    assert fact(page, "connector: answer 0") == before
    field.fill("2 N")
    field.press("Tab")
    page.locator('[data-fact="connector: answer 0"]', has_text="Under 2 N").wait_for()
    page.locator('[data-path="connector.remove"]').click()
    page.locator('[data-path="connector.add"]').wait_for()
    page.locator('[data-fact="connector: answer 0"]', has_text="Under 0.5 N").wait_for()


# ---------------------------------------------------------------------------- an oil over time
def test_the_tab_life_says_what_the_command_says():
    study = check(study_of("oil-circuit"))
    shown = life.contents_of(Answer(study))
    assert shown.answer == life_words.answer(run_life(study.life))
    grams = shown.flows["data"][0]["link"]["value"]
    ends = shown.flows["data"][0]["link"]["target"]
    middle = shown.flows["data"][0]["node"]["label"].index("oil")
    came = sum(mass for mass, end in zip(grams, ends, strict=True) if end == middle)
    assert came == pytest.approx(sum(grams) / 2, rel=1e-9)  # all that came has gone, or is there


def test_the_sliders_of_an_oil_do_what_their_study_would():
    data = study_of("oil-circuit")
    shown = life.contents_of(Answer(check(data)), 0.5, 0.8, 2.0)
    data["life"]["filters"][0] |= {"flow": "30 L/min", "service": 0.8}
    data["life"]["oil"]["ingress"]["rate"] = "250 mg/h"
    asked = check(data).life
    assert shown.answer == life_words.answer(run_life(asked))
    assert shown.labels["flow"] == "filter flow = 30 L/min"
    assert shown.labels["ingress"] == "ingress = 250 mg/h"


def test_a_study_without_an_oil_shows_one():
    data = study_of("oil-circuit")
    del data["life"]
    shown = life.contents_of(Answer(check(data)))
    begun = check(data | {"life": life.START})
    assert shown.answer == life_words.answer(run_life(begun.life))


def test_a_dry_contact_shows_an_oil_and_says_so():
    dry = Answer(check(study_of("dry-contact")))
    assert life.contents_of(dry).answer == life.contents_of(Answer(check({
        key: value for key, value in study_of("dry-contact").items() if key != "life"
    }))).answer  # fmt: skip
    assert "thirdbody life answers for the dry contact" in life.words_of_oil(dry)
    assert life.words_of_oil(Answer(check(study_of("oil-circuit")))) == ""


def test_a_link_reads_no_reports_from_the_disk(tmp_path):
    """A study of the page names only files that were given to it; words are no files."""
    file = tmp_path / "oil.csv"
    file.write_text("time [h],ISO 4406\n0,20/18/15\n250,16/13/10\n")
    data = study_of("oil-circuit")
    data["life"]["oil"]["ingress"] = {"reports": str(file)}
    with refuses(Mistake.UNREADABLE, "", says=str(file)):
        refuse_foreign_files(data, tmp_path / "own")
    refuse_foreign_files(study_of("dry-contact"), tmp_path)


@pytest.mark.check
def test_a_slider_of_an_oil_moves_its_code(visit):
    page = visit(study_of("oil-circuit"), "life")
    before = fact(page, "at the end")
    page.locator('[data-slider="life.ingress"]').evaluate(
        "e => window.getElement(+e.id.slice(1)).$emit('update:modelValue', 30)"
    )
    page.locator(".hint", has_text="ingress = 395 mg/h").first.wait_for()
    assert fact(page, "at the end") != before
    shot(page, "life")
