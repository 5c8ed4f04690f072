"""The page in a real browser: every tab, sliders, uploads, and nothing leaves the machine.

All tests share one server, one browser and one page, which each opens anew; every kind of long
work is done once. Screenshots of every tab, at two widths, light and dark, land in
$THIRDBODY_SCREENSHOTS where it names a folder.
"""

import contextlib
import os
import re
import signal
import sys
import time
import tomllib
from pathlib import Path
from urllib.parse import parse_qsl, urlencode, urlsplit

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.study import check

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")

sys.path.insert(0, str(Path(__file__).parent))
from browser import processes_below  # noqa: E402
from hostile import PAYLOADS, places, several, wrong_at  # noqa: E402

from thirdbody.app.examples import example  # noqa: E402
from thirdbody.app.fields import engineering  # noqa: E402
from thirdbody.app.sliders import REACH, STEPS, at_position  # noqa: E402
from thirdbody.app.state import look  # noqa: E402
from thirdbody.app.tabs import TABS  # noqa: E402
from thirdbody.app.tabs.interface import abouts, headline  # noqa: E402
from thirdbody.app.text import as_shown, from_link, to_link, to_toml  # noqa: E402
from thirdbody.quantities import say  # noqa: E402
from thirdbody.study.one_surface import one_surface  # noqa: E402
from thirdbody.views import explicit_words  # noqa: E402

pytestmark = pytest.mark.check
PATIENCE = 90_000
FILM = Path(__file__).parents[2] / "examples" / "oil_film.toml"
AT = 2e-5
LINES_STAND = """
() => [...document.querySelectorAll("[data-at] .js-plotly-plot")].every((plot) => {
  const { xaxis, _size: size } = plot._fullLayout, line = plot.querySelector(".here");
  const x = xaxis._offset + xaxis.d2p(Number(plot.closest("[data-at]").dataset.at));
  const near = (found, wanted) => Math.abs(parseFloat(found) - wanted) < 1;
  return line && near(line.style.left, x) && near(line.style.top, size.t)
    && near(line.style.height, size.h);
})
"""
"""Whether the line of the operating load stands where the axis says, as high as the figure."""
STUDY = example() | {
    "uncertainty": {"inputs": {"roughness.sigma": {"low": "95 nm", "high": "105 nm"}}},
    "outputs": {"counts": {}, "friction": {"m_ss": 0.2, "m_sa": 0.3}},
}


@pytest.fixture(scope="module")
def context(browser):
    """What pages share: what they have loaded once."""
    made = browser.new_context(
        viewport={"width": 1280, "height": 860},
        reduced_motion="reduce",
        accept_downloads=True,
    )
    yield made
    made.close()


@pytest.fixture
def shared(context):
    """A page without a history, and what goes wrong on it or tries to leave the machine."""
    wrong = []
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.on("console", lambda m: m.type == "error" and wrong.append(f"console: {m.text}"))
    page.on("pageerror", lambda error: wrong.append(f"page: {error}"))
    page.on("request", lambda request: _outside(request.url) and wrong.append(request.url))
    page.on("websocket", lambda socket: _outside(socket.url) and wrong.append(socket.url))
    page.on("response", lambda r: r.status >= 400 and wrong.append(f"{r.status}: {r.url}"))
    yield page, wrong
    page.close()


@pytest.fixture
def visit(shared, address):
    """Opens the page; at the end nothing may have failed or left the machine."""
    page, wrong = shared

    def open_page(study=STUDY, query=None):
        page.set_viewport_size({"width": 1280, "height": 860})
        page.emulate_media(color_scheme="light")
        page.goto(f"{address}/?{to_link(study, AT) if query is None else query}")
        page.wait_for_selector('[data-figure="section"] svg')
        return page

    yield open_page
    assert not wrong


def _outside(url):
    parts = urlsplit(url)
    return parts.scheme not in ("data", "blob") and parts.hostname != "127.0.0.1"


def when(page, condition, arg=None):
    """Waits, asking ten times a second: asked at every frame, the browser draws all the while."""
    page.wait_for_function(condition, arg=arg, polling=100)


def tab(page, name):
    page.get_by_role("tab", name=name, exact=True).click()
    when(
        page,
        "name => document.querySelector('.q-tab--active')?.innerText.trim() === name",
        arg=name,
    )


def fact(page, name):
    return page.locator(f'[data-fact="{name}"]').first.inner_text().replace("\u00a0", " ")


def until(page, name, other_than):
    """The fact, once it has changed."""
    when(
        page,
        "([name, old]) => { const e = document.querySelector(`[data-fact='${name}']`);"
        " return e && e.innerText.replaceAll('\u00a0', ' ') !== old; }",
        arg=[name, other_than],
    )
    return fact(page, name)


def drawn(page, name, other_than=None):
    """Traces of a Plotly figure, once it has some, and others than those."""
    when(
        page,
        "([name, old]) => { const e = document.querySelector(`[data-figure='${name}']`);"
        " return e?.data?.length && e.querySelector('.main-svg')"
        " && (!old || e.data[0].y[9] !== old); }",
        arg=[name, other_than and other_than[0]["y"][9]],
    )
    return page.evaluate(
        "name => document.querySelector(`[data-figure='${name}']`).data.map(t => ({name: t.name,"
        " type: t.type, x: t.x && Array.from(t.x), y: t.y && Array.from(t.y)}))",
        name,
    )


def in_full(page, task):
    """All of what was shown as a preview; by the button where a busy machine was slow at it."""
    when(
        page,
        "task => { const e = document.querySelector(`[data-stale='${task}']`);"
        " return !e.offsetParent || e.innerText.includes('in full'); }",
        arg=task,
    )
    stale = page.locator(f'[data-stale="{task}"]')
    if stale.is_visible():
        page.locator(f'[data-work="{task}"]').click()
        stale.wait_for(state="hidden")


def moved(page, slider, presses, key="ArrowRight"):
    page.locator(f'[data-slider="{slider}"] .q-slider__track-container').focus()
    for _ in range(presses):
        page.keyboard.press(key)


def state_of(study, at=AT):
    return tb.solve(check(study).contact, F_star=at)


# ---------------------------------------------------------------- look
UNREADABLE = """() => {
  const light = ([r, g, b]) => [r, g, b].map(c => c / 255)
    .map(c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const parts = colour => { const p = colour.match(/[\\d.]+/g).map(Number);
    return p.length < 4 ? [...p, 1] : p; };
  const over = (top, below) => top.slice(0, 3).map((c, i) => c * top[3] + below[i] * (1 - top[3]));
  const ground = element => {
    if (!element) return document.body.classList.contains("body--dark") ? [18, 18, 18] : [255, 255, 255];
    const own = parts(getComputedStyle(element).backgroundColor);
    return own[3] === 1 ? own.slice(0, 3) : over(own, ground(element.parentElement));
  };
  const bad = new Set();
  for (const element of document.querySelectorAll("body *")) {
    const text = [...element.childNodes].filter(n => n.nodeType === 3 && n.textContent.trim());
    const style = getComputedStyle(element);
    if (!text.length || !element.offsetParent || element.closest("[disabled], .disabled, svg, pre")
        || style.visibility === "hidden" || element.classList.contains("q-icon")) continue;
    const below = ground(element);
    const [a, b] = [light(over(parts(style.color), below)), light(below)].sort((p, q) => q - p);
    if ((a + 0.05) / (b + 0.05) < 4.5)
      bad.add(`${element.textContent.trim().slice(0, 40)}: ${style.color} on ${below}`);
  }
  return [...bad];
}"""
"""Texts whose contrast with their ground is below 4.5."""

CUT = """() => [...document.querySelectorAll(".main-svg text")].filter(t => t.getBoundingClientRect().width)
  .filter(t => { const [a, b] = [t, t.closest(".js-plotly-plot")].map(e => e.getBoundingClientRect());
    return a.left < b.left - 1 || a.right > b.right + 1 || a.top < b.top - 1 || a.bottom > b.bottom + 1; })
  .map(t => t.textContent)"""
"""Words of the figures that stick out of them."""


FITS = """() => document.documentElement.scrollWidth <= innerWidth &&
  [...document.querySelectorAll(".js-plotly-plot")].every(p => !p.offsetParent
    || !p._fullLayout || Math.abs(p._fullLayout.width - p.clientWidth) < 2)"""
"""Whether every figure has the width of its place, and the page that of the window."""


def looked_at(page, name):
    """At both widths, light and dark: nothing is wider than the page, cut off or hard to read.

    The badge says how far the answer holds.
    """
    badge = page.locator('[data-fact="validity"]')
    badge.wait_for()
    assert badge.get_attribute("aria-label")
    folder = os.environ.get("THIRDBODY_SCREENSHOTS")
    looks = [(1280, "light"), (1280, "dark"), (390, "dark")]
    # colours move nothing: the fourth is for the picture alone
    for width, scheme in (*looks, (390, "light")) if folder else looks:
        page.set_viewport_size({"width": width, "height": 860})
        page.emulate_media(color_scheme=scheme)
        when(
            page,
            f"document.body.classList.contains('body--dark') === {str(scheme == 'dark').lower()}",
        )
        # figures and their words follow their places, which move late on a busy machine: both at once
        try:
            page.wait_for_function(f"() => ({FITS})() && !({CUT})().length", polling=100)
        except sync_api.TimeoutError:
            raise AssertionError((name, width, page.evaluate(CUT))) from None
        if width == 1280:
            assert not page.evaluate(UNREADABLE), (name, scheme)
        if folder:
            page.wait_for_timeout(400)
            Path(folder).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=Path(folder) / f"{name}-{width}-{scheme}.png", full_page=True)
    page.set_viewport_size({"width": 1280, "height": 860})
    page.emulate_media(color_scheme="light")
    when(page, FITS)
    assert not page.locator('[data-said="page"]').inner_text()


# ---------------------------------------------------------------- tabs
def test_numbers_are_those_of_the_library_and_sliders_move_them(visit):
    page = visit()
    point = state_of(STUDY)
    assert (
        fact(page, "load")
        == f"{say.value_of(point.pressure, 'Pa')} (F* = {say.number(point.F_star)})"
    )
    assert fact(page, "separation h") == say.value_of(point.h, "m")
    assert fact(page, "real contact area") == say.percent(point.A_t)
    assert fact(page, "particles carry") == say.percent(point.particle_load_share)
    assert fact(page, "mode") == point.mode
    assert fact(page, "headline") == headline(point)
    assert page.locator(".grain.loaded").count()
    page.get_by_text("What the words mean").click()
    page.get_by_text(abouts()["p-s"], exact=True).wait_for()
    looked_at(page, "interface")
    before = fact(page, "load")
    moved(page, "load", 4)
    assert until(page, "load", before) != before

    tab(page, "Curves")
    curves = check(STUDY).solve()
    area = drawn(page, "area")
    assert area[0]["y"] == curves.A_t.tolist()
    assert area[0]["x"] == (curves.pressure * 1e-6).tolist()
    when(page, LINES_STAND)
    shares = {trace["name"]: trace["y"] for trace in drawn(page, "shares")}
    assert shares["of the load"] == (100 * curves.particle_load_share).tolist()
    critical = tb.transitions(check(STUDY).contact)
    row = (
        page.locator('[data-figure="critical"] tbody tr').first.inner_text().replace("\u00a0", " ")
    )
    assert say.number(critical.F_cr1.value) in row
    looked_at(page, "curves")
    for slider in ("roughness.sigma", "particles.size", "particles.areal_density"):
        moved(page, slider, 4)
        area = drawn(page, "area", area)
        assert re.search(r"\d+ ms", fact(page, "time"))


def begin_and_cancel(page, task):
    """Cancel a task while it runs: held where it can be, as it may be done before a click comes."""
    in_full(page, task)  # what follows of itself would take the word away
    page.locator(f'[data-work="{task}"]').click()
    cancel = page.locator(f'[data-cancel="{task}"]')
    _hold_jobs()
    cancel.wait_for()
    cancel.dispatch_event("click")
    page.get_by_text("cancelled", exact=True).wait_for()


def _hold_jobs():
    """Suspend what does long work; it is killed all the same."""
    deadline = time.monotonic() + PATIENCE / 1000
    while Path("/proc/self/task").exists() and time.monotonic() < deadline:
        jobs = processes_below(os.getpid(), "thirdbody.app.worker")
        for job in jobs:
            with contextlib.suppress(ProcessLookupError):
                os.kill(job, signal.SIGSTOP)
        if jobs:
            return
        time.sleep(0.01)


def test_the_map_can_be_cancelled_and_a_click_goes_there(visit):
    page = visit()
    before = fact(page, "load")
    tab(page, "Map")
    stale = page.locator('[data-stale="map"]')
    whole = "document.querySelector('[data-figure=map]')?.data?.[0]?.x.length === 60"
    drawn(page, "map")  # a preview, then all of it, without a click
    in_full(page, "map")
    when(page, whole)
    sizes = drawn(page, "map")[0]["x"]
    moved(page, "roughness.sigma", 3)  # another map, of itself
    when(page, "old => document.querySelector('[data-figure=map]').data[0].x[9] !== old", sizes[9])
    begin_and_cancel(page, "map")
    page.locator('[data-work="map"]').click()
    when(page, whole)
    stale.wait_for(state="hidden")
    looked_at(page, "map")
    # as a user sees it, who moves on where a figure that is drawn again took the words away
    for nudge in range(PATIENCE // 500):
        box = page.locator('[data-figure="map"] .nsewdrag').first.bounding_box()
        there = box["x"] + 0.7 * box["width"] + nudge % 2, box["y"] + 0.3 * box["height"]
        page.mouse.move(*there)
        page.wait_for_timeout(500)
        if page.locator('[data-figure="map"] .hovertext').first.is_visible():
            break
    else:
        pytest.fail("no words over the map")
    page.mouse.click(*there)
    tab(page, "Interface")
    assert until(page, "load", before) != before


def test_a_measured_surface_goes_into_the_study(visit, tmp_path):
    rng = np.random.default_rng(1)
    k = np.fft.fftfreq(128)[:, None] ** 2 + np.fft.rfftfreq(128) ** 2
    heights = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(128, 128))) * np.exp(-k / 0.002))
    file, bad = tmp_path / "part.txt", tmp_path / "bad.x3p"
    np.savetxt(file, 1e-7 * heights / heights.std())
    bad.write_bytes(b"PK\x03\x04 this is no surface" * 100)
    page = visit()
    tab(page, "Surface")
    upload = page.locator('[data-upload="surface"] input[type=file]')
    upload.set_input_files(bad)
    page.locator('[data-said="surface"]').filter(has_text="bad.x3p").wait_for()
    assert not page.locator('[data-fact="surface R"]').count()
    for name, value in (("spacing", "0.5 µm"), ("unit", "m"), ("cutoff", "8 um")):
        page.locator(f'[data-path="surface.{name}"]').fill(value)
    upload.set_input_files(file)
    page.wait_for_selector('[data-fact="surface R"]')
    own = tb.surfaces.from_topography(file, spacing=(0.5e-6,), unit="m", cutoff=8e-6)
    assert fact(page, "surface R") == say.value_of(own.moments.R, "m")
    assert fact(page, "surface σ") == say.value_of(own.moments.sigma, "m")
    drawn(page, "surface-R")
    looked_at(page, "surface")
    upload.set_input_files(bad)
    page.locator('[data-said="surface"]').filter(has_text="bad.x3p").wait_for()
    assert not page.locator('[data-fact="surface R"]').is_visible()
    assert not page.locator('[data-take="surface"]').is_visible()
    upload.set_input_files(file)
    page.wait_for_selector('[data-fact="surface R"]')
    stale = page.locator('[data-stale="surface"]')
    page.locator('[data-path="surface.cutoff"]').fill("9 um")
    stale.get_by_text("as it was before").wait_for()
    page.locator('[data-path="surface.cutoff"]').fill("8 um")
    stale.wait_for(state="hidden")
    page.locator('[data-take="surface"]').click()
    tab(page, "Take away")
    text = page.locator('textarea[data-path="toml"]')
    assert tomllib.loads(text.input_value())["roughness"]["R"] == own.moments.R


def laws_are_compared(page):
    point = state_of(STUDY)
    at = f"{say.value_of(point.pressure, 'Pa')} (F* = {say.number(point.F_star)})"
    assert fact(page, "compared at") == f"At the operating load, {at}"
    rows = page.locator('[data-figure="laws"] tbody tr')
    own = rows.filter(has=page.get_by_role("cell", name="zmc", exact=True))
    assert own.locator("td").nth(1).inner_text() == say.number(point.A_t)
    drawn(page, "compare")  # without a click
    page.locator('[data-work="compare"]').click()
    names = {trace["name"] for trace in drawn(page, "compare")}
    assert {"gw", "ceb", "zmc", "ke", "jg"} <= names <= set(tb.asperity.REGISTRY)


def sizes_are_drawn(page):
    drawn(page, "sizes")
    assert page.locator('[data-path="particles.mean"]').count() == 1  # the form at the side
    page.locator('[data-path="dust.iso4406"]').fill("18/x")
    page.locator('[data-said="dust"]', has_text="18/x").wait_for()
    page.locator('[data-path="dust.iso4406"]').fill("18/16/13")
    when(page, "document.querySelector('[data-path=\"particles.iso4406\"]')?.value === '18/16/13'")
    when(page, "document.querySelector('[data-said=dust]').innerText === ''")
    page.locator('[data-path="undo"]').click()
    page.locator('[data-path="undo"]').click()
    page.locator('.q-drawer [data-path="particles.mean"]').wait_for()


def outputs_are_drawn(page):
    drawn(page, "output friction [1]")
    page.locator('[data-path="outputs.wear"]').click()
    page.locator('[data-said="page"]', has_text="left out").wait_for()
    before = drawn(page, "output friction [1]")
    moved(page, "roughness.sigma", 4)
    drawn(page, "output friction [1]", before)
    page.locator('[data-path="undo"]').click()
    page.locator('[data-path="undo"]').click()
    when(page, "document.querySelector('[data-said=page]').innerText === ''")
    page.locator('[data-path="outputs.wear"][aria-checked="false"]').wait_for()
    cards_are_short(page)


def a_surface_is_pressed(page):
    drawn(page, "explicit section")  # without a click
    begin_and_cancel(page, "explicit")
    page.locator('[data-work="explicit"]').click()
    page.locator('[data-fact="explicit headline"]', has_text="128").wait_for()
    found = one_surface(check(STUDY), state_of(STUDY).F_star)
    assert fact(page, "explicit headline") == explicit_words.headline(found, 0).replace("`", "")
    ours, theirs = explicit_words.rows(found, 0)["load on particles"]
    assert fact(page, "explicit load on particles") == f"{ours}; statistically {theirs}"
    names = [trace["name"] for trace in drawn(page, "explicit pressure")]
    assert names[1:] == ["particles that carry"]
    drawn(page, "explicit forces")
    said = fact(page, "explicit headline")
    moved(page, "load", 3)  # pressed again, of itself
    assert until(page, "explicit headline", said) != said
    moved(page, "load", 3, "ArrowLeft")
    page.locator('[data-fact="explicit headline"]').get_by_text(said, exact=True).wait_for()


def a_design_is_found(page):
    drawn(page, "design")  # without a click
    page.locator('[data-work="design"]').click()
    drawn(page, "design")
    said = fact(page, "design")
    assert said.startswith("Best: mean diameter x_a = ")
    assert "load share of particles = " in said
    axis = page.locator('[data-figure="design"] .xtitle').text_content()
    assert re.fullmatch(r"mean diameter x.?a.? \[[nµ]m\]", axis), axis


def cards_are_short(page):
    """Of a table in a narrow window: name and value in one line, nothing that is empty."""
    page.set_viewport_size({"width": 390, "height": 860})
    cards = page.locator('[data-figure="outputs"] .q-table__grid-item')
    cards.first.wait_for()
    assert cards.count() == len(check(STUDY).solve().outputs)
    rows = page.evaluate(
        "() => [...document.querySelectorAll('[data-figure=outputs] .q-table__grid-item-row')]"
        ".map(e => [...e.children].map(c => c.getBoundingClientRect()))"
        ".map(([a, b]) => a.width ? Math.abs(a.top - b.top) : 0)"
    )
    assert len(rows) > 4
    assert max(rows) < 10
    page.set_viewport_size({"width": 1280, "height": 860})
    page.locator('[data-figure="outputs"] tbody').wait_for()


def critical_loads_have_error_bars(page):
    drawn(page, "tornado")  # without a click
    page.locator('[data-path="error bars.of"]').click()
    options = page.locator(".q-menu .q-item").all_inner_texts()
    for wanted in ("F_cr1:", "F_cr2:", "F_tpca.B:", "mu:"):
        assert any(text.startswith(wanted) for text in options), wanted
    page.locator(".q-menu .q-item", has_text="F_cr1:").click()
    page.locator('[data-work="error bars"]').click()
    when(page, "document.querySelector('[data-figure=bands]').data[0].y.includes('F_cr1')")
    assert all("F_cr1" in trace["y"] for trace in drawn(page, "bands"))


ANSWERS = {
    "Laws": laws_are_compared,
    "Dust": sizes_are_drawn,
    "Outputs": outputs_are_drawn,
    "Explicit": a_surface_is_pressed,
    "Design": a_design_is_found,
    "Error bars": critical_loads_have_error_bars,
}


def test_every_other_tab_answers(visit):
    """One visit for all tabs that leave the study as it is."""
    page = visit()
    for name, answer in ANSWERS.items():
        tab(page, name)
        answer(page)
        looked_at(page, name.lower())


def test_a_film_is_that_of_the_library_and_moves(visit):
    data = tomllib.loads(FILM.read_text(encoding="utf-8"))
    page = visit(data)
    tab(page, "Film")
    by_name = {trace["name"]: trace for trace in drawn(page, "film friction")}
    study = check(data)
    curve = study.film.stribeck(study.contact)
    assert by_name["sum"]["y"] == curve.mu.values.tolist()
    assert fact(page, "film: friction coefficient") == f"{float(curve.mu[30]):.4g}"
    looked_at(page, "film")
    there = page.locator('[data-fact="film: friction coefficient"]')
    for i in range(31, 36):  # one after another: a film takes longer than a key
        moved(page, "film.speed", 1)
        there.get_by_text(f"{float(curve.mu[i]):.4g}", exact=True).wait_for()


VALUE = """([path, value]) =>
  document.querySelector(`[data-path="${path}"] input`)?.value === value"""


def test_a_film_is_added_changed_and_removed(visit):
    page = visit()
    tab(page, "Film")
    page.locator('[data-path="film.add"]').click()
    field = page.locator('[data-path="film.oil.eta"]')
    # the entries stay while the answer comes, and while a number is written and taken away
    first = field.element_handle()
    slip, friction = page.locator('[data-path="film.slide_roll"]'), "film: of it asperities"
    slip.fill("0.2")
    page.locator(f'[data-fact="{friction}"]').wait_for()
    slip.fill("")
    page.locator(f'[data-fact="{friction}"]').wait_for(state="detached")
    assert first.evaluate("field => field.isConnected")
    field.fill("20 mPa")
    entry = page.locator(".q-field", has=field)
    entry.get_by_text("is a pressure, but a viscosity").wait_for()
    before = fact(page, "film: film over roughness λ = h_T/σ")
    field.fill("60 mPa s")
    when(
        page,
        "old => document.querySelector(`[data-fact='film: film over roughness λ = h_T/σ']`).innerText !== old",
        arg=before,
    )
    assert not page.locator('[data-said="page"]').inner_text()
    menu = page.locator('[data-path="film.hertz"]')
    page.locator(".q-expansion-item", has=menu).locator(".q-item").first.click()
    menu.click()
    page.get_by_role("option", name="maximum", exact=True).click()
    when(page, VALUE, arg=["film.hertz", "maximum"])
    page.locator('[data-path="undo"]').click()
    when(page, VALUE, arg=["film.hertz", "mean (when left out)"])
    page.locator('[data-path="film.remove"]').click()
    page.locator('[data-path="film.add"]').wait_for()


def test_a_narrow_window_shows_a_particle_that_is_loaded(browser, address):
    context = browser.new_context(viewport={"width": 390, "height": 860}, reduced_motion="reduce")
    try:
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.goto(f"{address}/?{to_link(STUDY, AT)}")
        page.wait_for_selector('[data-figure="section"] svg')
        when(
            page,
            "() => { const box = document.querySelector('[data-figure=section]'), b ="
            " box.getBoundingClientRect(); return [...box.querySelectorAll('.grain.loaded')]"
            ".map(e => e.getBoundingClientRect()).some(e => e.left >= b.left - 1"
            " && e.right <= b.right + 1); }",
        )
    finally:
        context.close()


def test_figures_that_were_out_of_sight_are_those_of_the_study(visit):
    """A tab that is left while its figures are on their way shows the study when it is back."""
    page = visit()
    tab(page, "Curves")
    drawn(page, "separation")
    steps = 0
    for presses in (1, 2, 3):
        moved(page, "roughness.sigma", presses)
        steps += presses
        page.get_by_role("tab", name="Interface", exact=True).click()
        moved(page, "roughness.sigma", presses)
        steps += presses
        tab(page, "Curves")
        sigma = engineering(100e-9 * REACH ** (2 * steps / STEPS), "m", 3)
        study = STUDY | {"roughness": STUDY["roughness"] | {"sigma": sigma}}
        state = check(study).solve()
        for name, wanted in (("area", state.A_t), ("separation", 1e9 * state.h)):
            when(
                page,
                "([name, wanted]) => JSON.stringify(wanted) === JSON.stringify("
                "document.querySelector(`[data-figure='${name}']`).data[0].y)",
                arg=[name, wanted.tolist()],
            )


def test_the_first_drawing_of_a_figure_is_left_to_the_framework(visit):
    """It may come late, and would draw the empty place over what came before it."""
    page = visit()
    tab(page, "Curves")
    for name in ("area", "shares", "regimes", "separation"):
        assert len(drawn(page, name)) > 1
    drawn_at_once = page.evaluate(
        "async () => { const { Plotly } = await import('nicegui-plotly'), out = [];"
        " const place = document.body.appendChild(document.createElement('div'));"
        " place.id = 'place'; const told = [{ y: [1, 2] }];"
        " out.push(await redraw([['place', 'react', told]]));"
        " await Plotly.newPlot(place, []); out.push(await redraw([['place', 'react', told]]));"
        " await Plotly.newPlot(place, told); out.push(await redraw([['place', 'react', told]]));"
        " place.remove(); return out.flat(); }"
    )
    assert drawn_at_once == [False, False, True]


# ---------------------------------------------------------------- the address
def address_of(page):
    return dict(parse_qsl(urlsplit(page.url).query))


def addressed(page, **wanted):
    """What the address holds, once it holds these."""
    when(
        page,
        "wanted => { const q = new URLSearchParams(location.search);"
        " return Object.entries(wanted).every(([k, v]) => q.get(k) === v); }",
        arg=wanted,
    )
    return address_of(page)


def after(page, presses):
    """Moves the slider of the load up, as fast as keys come; the operating load then."""
    there = int(page.locator('[data-slider="load"]').get_attribute("aria-valuenow")) + presses
    moved(page, "load", presses)
    load_stands(page, there)
    return at_position(check(STUDY).values, there / STEPS)


def load_at(there):
    """What the slider of the load says there."""
    at = at_position(check(STUDY).values, there / STEPS)
    return f"load {say.value_of(at * check(STUDY).contact.E_ss, 'Pa')}"


def load_stands(page, there):
    """The slider of the load is there, and the page shows that load."""
    page.get_by_text(load_at(there), exact=True).wait_for()
    assert page.locator('[data-slider="load"]').get_attribute("aria-valuenow") == str(there)


def test_a_late_answer_moves_no_slider_back(browser, address):
    context = browser.new_context(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    held = []
    holds = False

    def between(socket):
        server = socket.connect_to_server()
        socket.on_message(server.send)
        server.on_message(lambda m: held.append((socket, m)) if holds else socket.send(m))

    def value():
        page.evaluate("new Promise(done => requestAnimationFrame(() => setTimeout(done)))")
        return int(slider.get_attribute("aria-valuenow"))

    def words_of(messages):
        sent = "".join(str(message) for _, message in messages)
        return {word for word in (load_at(start + 1), "headline") if word in sent}

    def patiently(condition):
        deadline = time.monotonic() + PATIENCE / 1000
        while not condition():
            assert time.monotonic() < deadline, "did not come in time"
            page.wait_for_timeout(10)

    try:
        page.route_web_socket("**", between)
        page.goto(f"{address}/?{to_link(STUDY, AT)}")
        page.wait_for_selector('[data-figure="section"] svg')
        slider = page.locator('[data-slider="load"]')
        start = value()
        load_stands(page, start)  # nothing of the first visit is still on its way
        holds = True
        moved(page, "load", 1)
        # the answer to the first press: its load, and the headline, which comes last
        patiently(lambda: {load_at(start + 1), "headline"} <= words_of(held))
        moved(page, "load", 2)
        first, held[:] = held[:], []
        for socket, message in first:
            socket.send(message)
        page.get_by_text(load_at(start + 1), exact=True).wait_for()
        assert value() == start + 3
        moved(page, "load", 2)
        assert value() == start + 5
        holds = False
        for socket, message in held:
            socket.send(message)
        load_stands(page, start + 5)
    finally:
        context.close()


def test_the_address_keeps_the_work_and_back_undoes_it(visit):
    page = visit()
    page.wait_for_timeout(400)
    assert address_of(page) == dict(parse_qsl(to_link(STUDY, AT)))  # nothing was changed
    entries = page.evaluate("history.length")
    field = page.locator('.q-drawer [data-path="particles.mean"]').first
    field.fill("0.5 µm")
    wider = STUDY | {"particles": STUDY["particles"] | {"mean": "0.5 um"}}
    link = parse_qsl(to_link(wider, AT))[0][1]
    addressed(page, study=link, tab="interface")
    tab(page, "Curves")
    drawn(page, "area")
    addressed(page, study=link, tab="curves")
    at = after(page, 12)
    addressed(page, study=link, at=repr(at))
    # a field, a tab and a slider, each one entry
    assert page.evaluate("history.length") == entries + 3

    page.reload()
    drawn(page, "area")
    assert page.locator('[data-path="particles.mean"]').first.input_value() == "0.5 µm"
    tab(page, "Interface")
    assert fact(page, "separation h") == say.value_of(state_of(wider, at).h, "m")
    addressed(page, tab="interface", at=repr(at))

    for wanted in ({"tab": "curves", "at": repr(at)}, {"at": repr(AT)}, {"tab": "interface"}):
        page.go_back()
        addressed(page, study=link, **wanted)
    when(page, "document.querySelector('.q-tab--active').innerText.trim() === 'Interface'")
    until(page, "separation h", say.value_of(state_of(wider, at).h, "m"))
    assert fact(page, "separation h") == say.value_of(state_of(wider).h, "m")
    page.go_back()
    until(page, "separation h", say.value_of(state_of(wider).h, "m"))
    assert fact(page, "separation h") == say.value_of(state_of(STUDY).h, "m")
    assert page.locator('[data-path="particles.mean"]').first.input_value() == "300 nm"
    page.go_forward()
    until(page, "separation h", say.value_of(state_of(STUDY).h, "m"))
    assert fact(page, "separation h") == say.value_of(state_of(wider).h, "m")


LINK = """() => document.querySelector('input[data-path="link"], [data-path="link"] input')?.value
  ?? ''"""
LINKED = f"() => ({LINK})().includes('study=')"


def test_a_study_too_long_for_an_address_is_told(visit):
    page = visit()
    too_long = page.get_by_text("The study is too long for an address")
    assert not too_long.count()
    tab(page, "Take away")
    editor = page.locator('textarea[data-path="toml"]')
    words = np.random.default_rng(1).integers(0, 10**15, 1500)
    text = to_toml(STUDY | {"load": {"F_star": sorted(float(f"{w}e-20") for w in words)}})
    editor.fill(text)
    page.locator('[data-take="toml"]').click()
    too_long.wait_for()
    when(page, "location.search === '?tab=take_away'")
    page.locator('[data-path="undo"]').click()
    too_long.wait_for(state="hidden")
    addressed(page, study=parse_qsl(to_link(STUDY, AT))[0][1])


def test_a_study_that_is_being_written_stays(visit):
    page = visit()
    tab(page, "Take away")
    editor, link = page.locator('textarea[data-path="toml"]'), page.locator('[data-path="link"]')
    when(page, LINKED)
    before = link.input_value()
    editor.fill("title = 'half written")
    moved(page, "load", 1)
    when(page, f"old => ({LINKED})() && ({LINK})() !== old", arg=before)
    assert editor.input_value() == "title = 'half written"


def test_undo_takes_back_one_step_after_another(visit):
    page = visit()
    undo = page.locator('[data-path="undo"]')

    def stands(study, at):
        """The page shows this study."""
        wanted = say.value_of(tb.solve(check(study).contact, **at).h, "m")
        page.locator('[data-fact="separation h"]').get_by_text(wanted, exact=True).wait_for()

    assert undo.is_disabled()
    at = {"F_star": after(page, 5)}
    stands(STUDY, at)
    page.locator('.q-drawer [data-path="particles.mean"]').first.fill("0.5 µm")
    wider = STUDY | {"particles": STUDY["particles"] | {"mean": "500 nm"}}
    stands(wider, at)
    page.get_by_label("open an example").click()
    page.locator(".q-menu .q-item", has_text="Oil of code").click()
    stands(example("Oil of code 18/16/13"), {"pressure": 1e6})
    for study, load in ((wider, at), (STUDY, at), (STUDY, {"F_star": AT})):
        undo.click()
        stands(study, load)
    assert page.locator('[data-path="particles.mean"]').first.input_value() == "300 nm"
    when(page, "document.querySelector('[data-path=undo]').disabled")


# ---------------------------------------------------------------- links made to do harm
HARM = """() => [
  window.__hit === undefined ? "" : "script ran",
  document.title === "thirdbody" ? "" : document.title,
  ...[...document.querySelectorAll(
    "img[src='x'], [onerror], [onload], a[href^='javascript'], body script:not([nonce])")]
    .map(e => e.outerHTML),
].filter(Boolean)"""


WITH_TABLES = ("Curves", "Outputs", "Laws", "Before / after")


def built(page):
    """The tab in sight stands there, and no longer what waits for it."""
    when(
        page,
        "() => { const e = document.querySelector('.q-tab-panel');"
        " return e?.innerText.trim() && !e.querySelector('.waiting'); }",
    )


def travelled(page, query):
    """Goes back to an address that is laid into the history."""
    page.evaluate(
        "q => { history.pushState(null, '', q); history.pushState(null, '', '?'); }", f"?{query}"
    )
    page.go_back()


def test_texts_of_a_link_are_shown_as_text(visit):
    page = visit(several())
    dialogs = []
    page.on("dialog", lambda dialog: (dialogs.append(dialog.message), dialog.dismiss()))
    shown = page.locator(".q-panel").inner_text()
    for number, payload in enumerate(PAYLOADS):
        assert " ".join(f"{number} {payload}".split()) in " ".join(shown.split())
    for name in (TITLES := page.get_by_role("tab").all_inner_texts()):
        tab(page, name.strip())
        built(page)
        if name.strip() == "Curves":
            drawn(page, "shares")
            legend = page.locator('[data-figure="shares"] .legendtext').all_text_contents()
            for number, payload in enumerate(PAYLOADS):
                words = " ".join(f"{number} {payload}: load".split())
                assert words in [" ".join(text.split()) for text in legend]
        if name.strip() == "Dust":
            drawn(page, "sizes")
        if name.strip() == "Take away":
            when(page, "document.querySelector('[data-path=python]')?.innerText.includes('__hit')")
        if name.strip() == "Outputs":
            page.locator('[data-figure="outputs"] tbody').wait_for()
        if name.strip() in WITH_TABLES:
            page.wait_for_timeout(200)
        assert not page.evaluate(HARM), name
    assert len(TITLES) == len(TABS)
    page.set_viewport_size({"width": 390, "height": 860})
    for name in WITH_TABLES:  # they are cards there
        tab(page, name)
        if name == "Outputs":
            page.locator('[data-figure="outputs"] .q-table__grid-item').first.wait_for()
        page.wait_for_timeout(200)
        assert not page.evaluate(HARM), name
    assert not dialogs


def test_mistakes_of_a_link_are_told_as_text(shared, address, tmp_path):
    """Opened where a text could end the script that the page comes with, else come back to."""
    page, failed = shared
    first = next(number for number, text in enumerate(PAYLOADS) if "</script>" in text)
    for number, payload in enumerate(PAYLOADS[first:] + PAYLOADS[:first]):
        together = places(payload)[number % len(places(payload))]
        link = to_link(wrong_at(payload, *together))
        _, problems, _ = look(from_link(dict(parse_qsl(link))["study"]), tmp_path)  # in its order
        for place in together:
            assert {*look(wrong_at(payload, place), tmp_path)[1]} <= {*problems}, place
        if "</script>" in payload:
            page.goto(f"{address}/?{link}")
        else:
            travelled(page, link)
        page.locator('[data-said="page"]', has_text=as_shown("; ".join(problems))).wait_for()
        page.locator(".problem", has_text="__hit").first.wait_for()
        assert not page.evaluate(HARM), together
    assert not failed


def test_an_address_made_to_do_harm_is_told_as_text(visit):
    page = visit()
    for payload in PAYLOADS:
        # a study that cannot be read goes before a load that is none; each shows another tab
        for names, there in ((("study", "files"), "take_away"), (("at", "surface", "tab"), None)):
            query = dict(parse_qsl(to_link(STUDY, AT))) | {"tab": there}
            travelled(page, urlencode(query | dict.fromkeys(names, payload)))
            when(
                page,
                "name => document.querySelector('.q-tab--active').innerText.trim() === name",
                arg="Take away" if there else "Interface",
            )
            assert not page.evaluate(HARM), (names, payload)


def test_codes_made_to_do_harm_are_told_as_text(visit):
    page = visit()
    tab(page, "Dust")
    drawn(page, "sizes")
    for payload in PAYLOADS:
        page.locator('[data-path="dust.iso4406"]').fill(payload)
        word = re.search(r"\S*__hit\S*", payload)[0]
        page.locator('[data-said="dust"]', has_text=word).wait_for()
        assert not page.evaluate(HARM), payload


def test_the_policy_runs_no_script_of_a_text(visit, shared):
    page = visit()
    page.evaluate(
        "document.body.insertAdjacentHTML('beforeend', '<img src=data:, onerror=window.__hit=1>')"
    )
    when(page, "document.querySelector('img[onerror]')?.complete")
    page.wait_for_timeout(200)
    assert page.evaluate("window.__hit === undefined")
    said = [text for text in shared[1] if "Content Security Policy" in text]
    assert said
    shared[1][:] = [text for text in shared[1] if text not in said]


def test_others_are_answered_while_a_heavy_link_is_open(visit, address, browser):
    edges = np.linspace(1e-7, 5e-7, 1001).tolist()
    dust = {"material": "SiO2", "areal_density": 1e10, "distribution": "histogram"}
    heavy = example() | {"particles": dust | {"edges": edges, "counts": [1] * 1000}}
    heavy["load"] = {"F_star": {"from": 1e-7, "to": 1e-4, "points": 400}}
    other = browser.new_page()
    try:
        other.goto(f"{address}/?{to_link(heavy)}", timeout=PATIENCE)
        other.get_by_role("tab", name="Curves", exact=True).wait_for(timeout=PATIENCE)
        page = visit()
        tab(page, "Curves")
        assert drawn(page, "area")[0]["y"] == check(STUDY).solve().A_t.tolist()
        assert not other.locator('[data-figure="section"] svg').count()
        assert not other.locator('[data-said="page"]').inner_text()
    finally:
        other.close()


# ---------------------------------------------------------------- fields
def test_a_mistake_is_told_beside_its_field(visit):
    page = visit()
    entry = page.locator('.q-drawer [data-path="particles.mean"]').first
    entry.fill("300 GPa")
    field = page.locator(".q-drawer .q-field", has=page.locator('[data-path="particles.mean"]'))
    field.get_by_text("is a pressure, but a length").wait_for()
    page.locator('[data-said="page"]', has_text="last study without").wait_for()
    before = fact(page, "separation h")
    entry.fill("0.5 µm")
    assert until(page, "separation h", before) != before
    study = STUDY | {"particles": STUDY["particles"] | {"mean": "500 nm"}}
    assert fact(page, "separation h") == say.value_of(state_of(study).h, "m")
    assert not page.locator('[data-said="page"]').inner_text()
    page.locator(".q-drawer").get_by_text("More tables, as text").click()
    page.locator(".q-drawer").get_by_text("[sweep] as text").click()
    entry = page.locator('.q-drawer textarea[data-path="sweep"]')
    field = page.locator(".q-drawer .q-field", has=page.locator('[data-path="sweep"]'))
    for text, told in (
        ('[sweep]\ndesign = "sobel"\nsamples = 64', 'did you mean "sobol"?'),
        ("[sweep]\ndesign = ", "not a study file"),
        ("[load]\nF_star = 1e-5", "[sweep] alone"),
    ):
        entry.fill(text)
        field.get_by_text(told).wait_for()
    entry.fill(
        '[sweep]\ndesign = "sobol"\nsamples = 64\nvary.roughness.R = {from = 1e-6, to = 2e-6}'
    )
    tab(page, "Take away")
    when(
        page,
        "document.querySelector('textarea[data-path=\"toml\"]')?.value.includes('samples = 64')",
    )


NAMELESS = """() => {
  const text = e => e?.innerText?.trim() ?? "";
  const named = e => e.ariaLabel?.trim()
    || (e.getAttribute("aria-labelledby") ?? "").split(" ").some(i => text(document.getElementById(i)))
    || [...(e.labels ?? [])].some(text);
  const bad = [...document.querySelectorAll("input, select, textarea, [role=slider], "
    + "[role=combobox], [role=progressbar]")].filter(e => !named(e));
  const words = e => [...e.querySelectorAll("*")].some(x => !x.classList.contains("q-icon")
    && [...x.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()));
  bad.push(...[...document.querySelectorAll("button, a, [role=button], [role=tab], "
    + "[role=switch], [role=checkbox]")]
    .filter(e => !named(e) && !words(e)));
  bad.push(...[...document.querySelectorAll("[role=button] input, button input, main main")]);
  return bad.filter(e => e.getClientRects().length).map(e => e.outerHTML.slice(0, 160));
}"""
"""What is in sight and has no name, or stands inside what a reader of the screen takes whole."""


def test_everything_has_a_name(visit):
    study = STUDY | {"film": tomllib.loads(FILM.read_text(encoding="utf-8"))["film"]}
    page = visit(study)
    for _ in range(2):  # what was folded in what was folded
        page.evaluate(
            "document.querySelectorAll('.q-drawer .q-item[aria-expanded=false]')"
            ".forEach(e => e.click())"
        )
        folded = "document.querySelector('.q-drawer .q-item[aria-expanded=false]')"
        when(page, f"!{folded}?.offsetParent")
    tabs = "document.querySelector('.q-tabs__content')"
    assert page.evaluate(f"{tabs}.scrollWidth <= {tabs}.clientWidth")  # all are in sight
    for name in page.get_by_role("tab").all_inner_texts():
        tab(page, name.strip())
        when(page, "document.querySelector('.q-tab-panel').innerText.trim()")
        assert page.evaluate(NAMELESS) == [], name
        assert page.get_by_role("heading", level=1).count() == 1
        assert page.get_by_role("main").count() == 1
        skip = page.locator("a.skip").get_attribute("href")
        assert page.locator(skip).is_visible()


def tab_around(page):
    """Elements that the key Tab comes by in one round, each with whether one sees it, and those it leaves out."""
    page.evaluate("document.querySelectorAll('[data-seen]').forEach(e => delete e.dataset.seen)")
    seen = []
    for _ in range(200):
        page.keyboard.press("Tab")
        stop = page.evaluate(
            "() => { const e = document.activeElement; if (e === document.body) return null;"
            " const again = 'seen' in e.dataset; e.dataset.seen = '';"
            " const around = e.closest('.q-field, .q-slider');"
            " const shown = [e, around].some(x => x && getComputedStyle(x).outlineStyle !== 'none');"
            " return [again, e.outerHTML.slice(0, 90), shown]; }"
        )
        if stop and stop[0]:
            break
        seen += [stop[1:]] if stop else []
    missed = page.evaluate(
        "() => [...document.querySelectorAll('input, textarea, button, [role=tab], [role=slider]')]"
        ".filter(e => e.offsetParent && !e.disabled && e.type !== 'file' && !('seen' in e.dataset)"
        " && !e.querySelector('[data-seen]') && e.getAttribute('role') !== 'tab')"
        ".map(e => e.outerHTML.slice(0, 120))"
    )
    return seen, missed


def test_the_keyboard_reaches_everything(visit):
    page = visit()
    assert page.get_by_role("heading", level=1).all_inner_texts() == ["thirdbody"]
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.ariaLabel") == "the answer"
    assert "#" not in page.url
    page.locator('[role="tab"]').first.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    drawn(page, "area")
    before = page.locator('[data-slider="load"]').get_attribute("aria-valuenow")
    moved(page, "load", 1, "PageUp")
    when(
        page, "old => document.querySelector('[data-slider=load]').ariaValueNow !== old", arg=before
    )
    for _ in range(3):  # a figure that is drawn anew on the way has new buttons
        seen, missed = tab_around(page)
        assert all(shown for _, shown in seen), seen
        if not missed:
            break
    assert not missed, missed


# ---------------------------------------------------------------- files
def test_a_study_goes_down_and_up(visit, tmp_path):
    page = visit(query="study=broken")
    said = page.locator('[data-said="page"]')
    assert "here is the example instead" in said.inner_text()
    tab(page, "Take away")

    def download(name):
        with page.expect_download() as waiting:
            page.locator(f'[data-download="{name}"]').click()
        return Path(waiting.value.path()).read_bytes()

    assert tomllib.loads(download("study.toml").decode()) == example()
    names = {}
    exec(download("study.py").decode(), names)
    assert names["contact"] == check(example()).contact
    for name, start in (("states.csv", b"d [m]"), ("png", b"\x89PNG"), ("svg", b"<?xml")):
        assert start in download(name)[:300]

    other = example("Oil of code 18/16/13")
    file, bad = tmp_path / "other.toml", tmp_path / "bad.toml"
    file.write_text(to_toml(other))
    bad.write_text("[surfaces\nfirst = ")
    upload = page.locator('[data-upload="study"] input[type=file]')
    upload.set_input_files(bad)
    page.locator('[data-said="take away"]').filter(has_text="not a study file").wait_for()
    upload.set_input_files(file)
    when(page, "document.querySelector('textarea[data-path=\"toml\"]')?.value.includes('18/16/13')")
    link = page.locator('input[data-path="link"]').input_value()
    assert from_link(link.split("study=", 1)[1].split("&")[0]) == other
    looked_at_after_link = visit(query=link.split("?", 1)[1])
    point = tb.solve(check(other).contact, pressure=1e6)
    assert fact(looked_at_after_link, "separation h") == say.value_of(point.h, "m")
