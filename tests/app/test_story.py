"""Stories in a real browser: a morning's work, come back to in every way; and one by keyboard."""

import html
import json
import sys
import tomllib
from pathlib import Path
from urllib.parse import parse_qsl, urlsplit

import numpy as np
import pytest
from typer.testing import CliRunner

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")

sys.path.insert(0, str(Path(__file__).parent))
from browser import chromium, ended, served  # noqa: E402

from thirdbody.app.examples import example  # noqa: E402
from thirdbody.app.text import to_toml  # noqa: E402
from thirdbody.cli import app  # noqa: E402
from thirdbody.quantities import say  # noqa: E402

pytestmark = pytest.mark.check
PATIENCE = 60_000
REPORT = "low [um],high [um],number [1/ml]\n1,4,2400\n4,6,420\n6,14,61\n14,21,3\n"
"""Of an oil laboratory."""
DROP = """([place, name, text]) => {
  const data = new DataTransfer(), box = document.querySelector(place);
  data.items.add(new File([text], name, { type: "text/csv" }));
  const drop = e => e.dispatchEvent(
    new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  new MutationObserver((_, watch) => {
    const target = box.querySelector(".q-uploader__dnd");
    if (target) { watch.disconnect(); drop(target); }
  }).observe(box, { childList: true, subtree: true });
  box.dispatchEvent(new DragEvent("dragover", { dataTransfer: data, bubbles: true }));
}"""
FACTS = """() => Object.fromEntries([...document.querySelectorAll(
  "[data-fact]:not([data-fact=time])")].filter(e => e.offsetParent)
  .map(e => [e.dataset.fact, e.innerText.replaceAll("\u00a0", " ")]))"""


@pytest.fixture(scope="module")
def started():
    """The browser and a function that starts a server, or gives the one that a story left."""
    running = []

    def start(port=0):
        if not port and running and running[-1][0].poll() is None:
            return running[-1]
        server, address = served(port)
        running.append((server, address))
        return server, address

    with sync_api.sync_playwright() as playwright:
        found = chromium(playwright)
        if found is None:
            pytest.skip("no chromium found, neither the system's nor playwright's: make browser")
        browser = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        try:
            yield browser, start
        finally:
            browser.close()
            for server, _ in running:
                ended(server)


@pytest.fixture
def opened(started):
    """The same, of which nobody looks at a page any more when the story ends."""
    yield started
    for context in started[0].contexts:
        context.close()


def visited(browser, link):
    """A visitor of its own at the link."""
    context = browser.new_context(
        viewport={"width": 1280, "height": 860}, reduced_motion="reduce", accept_downloads=True
    )
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(link)
    page.wait_for_selector('[data-figure="section"] svg')
    return page


def when(page, condition, arg=None):
    page.wait_for_function(condition, arg=arg, polling=100)


def tab(page, name):
    page.get_by_role("tab", name=name, exact=True).click()


def chosen(page, menu, words):
    page.get_by_role("combobox", name=menu, exact=True).click()
    page.locator(".q-menu .q-item", has_text=words).click()


def typed(page, place, text):
    """Fills an entry at the side; the address then holds it."""
    entry = page.locator(f'.q-drawer [data-path="{place}"]')
    entry.fill(text)
    entry.press("Tab")


def told(page, known):
    """All that the tab Interface says, once it says this."""
    tab(page, "Interface")
    when(
        page,
        f"wanted => {{ const told = ({FACTS})();"
        " return Object.entries(wanted).every(([name, text]) => told[name] === text); }",
        arg=known,
    )
    return page.evaluate(FACTS)


def rested(page):
    """All that the page says and its address, once nothing of them changes any more."""
    when(
        page,
        f"""() => {{
          const now = location.search + JSON.stringify(({FACTS})());
          const same = window.said === now ? window.same + 1 : 0;
          [window.said, window.same] = [now, same];
          return same === 12;
        }}""",
    )
    return page.evaluate(FACTS)


def downloaded(page, name):
    with page.expect_download() as waiting:
        page.locator(f'[data-download="{name}"]').click()
    return Path(waiting.value.path()).read_text(encoding="utf-8")


def command_line(study, folder):
    """What ``thirdbody solve --json`` prints of a study file."""
    file = folder / "study.toml"
    file.write_text(study, encoding="utf-8")
    done = CliRunner().invoke(app, ["solve", str(file), "--json"])
    assert done.exit_code == 0, done.stderr
    return done.stdout


def first_state(told):
    """The facts of the first state, in the words of the page."""
    states = {name: column[0] for name, column in json.loads(told)["states"].items()}
    pressure = say.value_of(states["pressure"], "Pa")
    return {
        "load": f"{pressure} (F* = {say.number(states['F_star'])})",
        "separation h": say.value_of(states["h"], "m"),
        "real contact area": say.percent(states["A_t"]),
        "mode": states["mode"],
        "particles carry": say.percent(states["particle_load_share"]),
        "of the real area": say.percent(states["particle_area_share"]),
    }


def numbers_of_a_study(browser, address, tmp_path):
    """They are the same however one comes back to them; the server starts anew where this yields."""
    page = visited(browser, address)

    page.locator(".q-drawer").get_by_text("Roughness", exact=True).click()
    chosen(page, "heights given as", "Ra, Rq or Rz of the drawing")
    typed(page, "roughness.Ra", "0.2 µm")
    chosen(page, "load", "force")
    typed(page, "load.force", "2 N")
    typed(page, "body.diameter", "40 mm")
    page.locator('[data-fact="force"]', has_text="2 N on the body ball-on-flat").wait_for()
    tab(page, "Dust")
    page.locator('[data-upload="sizes"]').wait_for()
    page.evaluate(DROP, ['[data-upload="sizes"]', "oil report.csv", REPORT])
    page.locator(".q-drawer").get_by_text("sizes: 4 bins from 1 µm to 21 µm").wait_for()
    typed(page, "particles.areal_density", "1e8 / m^2")
    tab(page, "Interface")
    page.locator('[data-fact="load"]').wait_for()
    page.get_by_text("1×10⁸ m⁻²").first.wait_for()  # what was typed stands beside its slider
    for slider, presses in (("particles.areal_density", 6), ("roughness.Ra", 3), ("load", 8)):
        before = rested(page)
        page.locator(f'[data-slider="{slider}"] .q-slider__track-container').focus()
        for _ in range(presses):
            page.keyboard.press("ArrowRight")
        when(page, f"old => JSON.stringify(({FACTS})()) !== JSON.stringify(old)", arg=before)
    rested(page)  # the last of the presses is answered, and in the address
    tab(page, "Take away")
    given = downloaded(page, "study.toml")
    study = tomllib.loads(given)
    assert study["particles"]["sizes"]["counts"] == [2400, 420, 61, 3]
    assert study["load"] == {"force": "2 N"}
    by_command = command_line(given, tmp_path)
    assert downloaded(page, "states.json") == by_command

    when(page, "() => new URLSearchParams(location.search).get('tab') === 'take_away'")
    at = float(dict(parse_qsl(urlsplit(page.url).query))["at"])
    there = {key: table for key, table in study.items() if key != "body"}
    there = first_state(command_line(to_toml(there | {"load": {"pressure": at}}), tmp_path))
    known = told(page, there)

    page.reload()
    told(page, known)
    when(page, "() => new URLSearchParams(location.search).get('tab') === 'interface'")
    for _ in range(3):  # the tabs Interface and Take away, and the way of the load
        page.go_back()
    when(page, f"old => JSON.stringify(({FACTS})()) !== JSON.stringify(old)", arg=known)
    for _ in range(3):
        page.go_forward()
    told(page, known)

    page.evaluate("window.before = true")
    yield
    when(page, "() => window.before === undefined")  # of itself
    told(page, known)

    elsewhere = visited(browser, page.url)
    told(elsewhere, known)
    tab(elsewhere, "Take away")
    assert downloaded(elsewhere, "states.json") == by_command


def heights_of(page):
    """All that the tab Surface says of the file that was dropped, the study's answer too.

    The answer and its badge come with the study, the numbers with the file: whichever is last.
    """
    page.get_by_text("file: part.txt", exact=True).wait_for()
    page.locator('[data-fact="surface R"]').wait_for()
    when(page, "() => document.querySelector('[data-cancel=surface]')?.offsetParent === null")
    when(page, f"() => {{ const told = ({FACTS})(); return told.answer && told.validity; }}")
    return rested(page)


def measured_surface(browser, address, tmp_path):
    """It is there after a reload, and asked for after the restart where this yields."""
    page = visited(browser, address)
    tab(page, "Surface")
    file = tmp_path / "part.txt"
    rng = np.random.default_rng(2)
    smooth = np.exp(-(np.fft.fftfreq(96)[:, None] ** 2 + np.fft.rfftfreq(96) ** 2) / 0.002)
    heights = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(96, 96))) * smooth)
    np.savetxt(file, 2e-7 * heights / heights.std())
    for name, value in (("spacing", "0.5 µm"), ("unit", "m"), ("cutoff", "6 um")):
        page.locator(f'[data-path="surface.{name}"]').fill(value)
    upload = '[data-upload="surface"] input[type=file]'
    page.locator(upload).set_input_files(file)
    read = heights_of(page)
    when(page, "() => location.search.includes('files=part.txt')")
    page.reload()
    assert heights_of(page) == read

    page.locator('[data-take="file"]').click()
    page.get_by_text("The roughness of the study is that of this surface now.").wait_for()
    tab(page, "Take away")
    when(page, "() => document.querySelector('textarea[data-path=toml]')?.value.includes('part.')")
    given = downloaded(page, "study.toml")
    assert tomllib.loads(given)["roughness"]["topography"] == "part.txt"
    by_command = command_line(given, tmp_path)
    assert downloaded(page, "states.json") == by_command
    when(page, "() => location.search.includes('tab=take_away')")
    page.reload()
    page.locator('[data-download="states.json"]').wait_for()
    when(page, "() => document.querySelector('[data-path=python]')?.innerText.length > 9")
    assert downloaded(page, "states.json") == by_command
    tab(page, "Surface")
    taken = heights_of(page)
    of_file = {name: text for name, text in read.items() if name.startswith("surface ")}
    assert len(of_file) == 8
    assert of_file.items() <= taken.items()  # but for the answer, now of this surface
    assert taken.keys() == read.keys()
    assert taken["answer"] != read["answer"]
    tab(page, "Take away")
    when(page, "() => location.search.includes('tab=take_away')")
    link = page.url
    elsewhere = browser.new_context(accept_downloads=True).new_page()
    elsewhere.set_default_timeout(PATIENCE)
    elsewhere.goto(link)
    when(elsewhere, "() => document.querySelector('[data-path=python]')?.innerText.length > 9")
    assert downloaded(elsewhere, "states.json") == by_command

    page.evaluate("window.before = true")
    yield
    when(page, "() => window.before === undefined")  # of itself
    said = '"part.txt" is not a file of this page: drop it on the tab Surface'
    page.locator('[data-said="page"]', has_text=said).wait_for()
    tab(page, "Surface")
    page.locator('[data-said="surface"]', has_text=said).wait_for()
    assert page.locator('[data-path="surface.cutoff"]').input_value() == "6 um"
    page.locator(upload).set_input_files(file)
    when(page, "() => !document.querySelector('[data-said=page]').innerText")
    assert heights_of(page) == taken
    tab(page, "Take away")
    when(page, "() => document.querySelector('[data-path=python]')?.innerText.length > 9")
    assert downloaded(page, "states.json") == by_command


def test_work_is_there_however_one_comes_back(opened, tmp_path):
    """Two visitors of one server, which is killed and started anew under both."""
    browser, start = opened
    server, address = start()
    stories = [
        story(browser, address, tmp_path) for story in (numbers_of_a_study, measured_surface)
    ]
    for story in stories:
        next(story)
    server.kill()
    server.wait()
    start(urlsplit(address).port)
    for story in stories:
        assert next(story, None) is None


def test_by_keyboard_from_opening_to_a_report(opened):
    browser, start = opened
    page = visited(browser, start()[1])

    def focused(selector):
        """Tab until there."""
        for _ in range(60):
            page.keyboard.press("Tab")
            if page.evaluate("selector => document.activeElement.matches(selector)", selector):
                return
        raise AssertionError(f"Tab does not reach {selector}")

    page.keyboard.press("Tab")
    page.keyboard.press("Enter")  # skips to the answer
    focused('[data-slider="load"] [tabindex], [data-slider="load"]')
    before = page.evaluate(FACTS)
    page.keyboard.press("PageUp")
    when(page, f"old => JSON.stringify(({FACTS})()) !== JSON.stringify(old)", arg=before)
    focused('[role="tab"]')
    here = "document.activeElement.innerText.trim()"
    for name in page.get_by_role("tab").all_inner_texts()[1:]:
        page.keyboard.press("ArrowRight")
        when(page, f"name => {here} === name", arg=name.strip())
    page.keyboard.press("Enter")
    page.locator('[data-work="report"]').wait_for()
    focused('[data-work="report"]')
    with page.expect_download(timeout=4 * PATIENCE) as waiting:
        page.keyboard.press("Enter")
    assert waiting.value.suggested_filename == "report.html"
    report = Path(waiting.value.path()).read_text(encoding="utf-8")
    assert report.lower().startswith("<!doctype html>")
    assert to_toml(example()) in html.unescape(report)
