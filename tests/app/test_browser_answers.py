"""The page in a real browser: forces, killed processes, error bars, maps and what is read out.

Screenshots at two widths, light and dark, land in $THIRDBODY_SCREENSHOTS where it names a folder.
"""

import contextlib
import os
import re
import signal
import sys
import threading
from pathlib import Path

import pytest

from thirdbody.study import check, run_study

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")

sys.path.insert(0, str(Path(__file__).parent))
from browser import ended, processes_below, served

from thirdbody.app.examples import example
from thirdbody.app.text import to_link

pytestmark = [
    pytest.mark.check,
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks for processes there"),
]
PATIENCE = 90_000
BALL = {
    "surfaces": {"first": "100Cr6", "second": "100Cr6"},
    "roughness": {"Ra": "0.4 um", "process": "ground"},
    "body": {"kind": "ball-on-flat", "diameter": "6.35 mm"},
    "particles": {"material": "S45C", "iso4406": "18/16/13", "gap": "1 um", "level": "middle"},
    "load": {"force": "20 N"},
}
BARE = {
    name: {"name": f"{name} body", "E": "205 GPa", "nu": 0.29, "H": "5 GPa"}
    for name in ("first", "second")
}
"""Materials of no library, which states no range for them."""


@pytest.fixture(scope="module")
def context(browser):
    """What pages share: what they have loaded once."""
    made = browser.new_context(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    yield made
    made.close()


@pytest.fixture
def visit(context, server):
    """Opens the page anew; at the end nothing may have failed in the browser."""
    page, wrong = context.new_page(), []
    page.set_default_timeout(PATIENCE)
    page.on("console", lambda m: m.type == "error" and wrong.append(f"console: {m.text}"))
    page.on("pageerror", lambda error: wrong.append(f"page: {error}"))

    def open_page(study, tab="interface"):
        page.goto(f"{server[1]}/?{to_link(study)}&tab={tab}")
        return page

    yield open_page
    page.close()
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
    page.emulate_media(color_scheme="light")


def fact(page, name):
    return page.locator(f'[data-fact="{name}"]').first.inner_text().replace("\u00a0", " ")


def drawn(page, name):
    page.wait_for_function(
        "name => document.querySelector(`[data-figure='${name}']`)?.data?.length",
        arg=name,
        polling=100,
    )


def moved(page, slider, key="ArrowRight"):
    page.locator(f'[data-slider="{slider}"] [role="slider"]').focus()
    page.keyboard.press(key)


def solvers(pid):
    """Process ids of those that compute for a server."""
    return processes_below(pid, "spawn_main")


def kill(pid):
    for child in solvers(pid):
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)


def test_a_force_is_answered_as_the_command_line_does(visit):
    told = run_study(check(BALL))["body"]["sentences"]
    page = visit(BALL)
    page.locator('[data-fact="force"]', has_text="20 N on the body").wait_for()
    assert fact(page, "force") == told[0].split(". ")[0] + "."
    page.locator('[data-fact="preliminary"]').wait_for(state="hidden")
    rest = page.locator('[data-fact="force in full"]')
    in_full = rest.text_content().replace("\u00a0", " ")
    assert f"{fact(page, 'force')} {in_full}" == told[0]
    assert not rest.is_visible()
    page.locator('[data-fold="force"] .q-item').click()
    rest.wait_for()
    page.locator(".grain").first.wait_for()
    assert page.locator(".grain").count() == 1
    one = re.search(r"One contact in \d+ meets a particle", told[0])[0]
    page.get_by_text(f"{one}. The drawing").wait_for()
    shot(page, "force")
    page.get_by_role("tab", name="Take away", exact=True).click()
    page.locator('[data-path="python"]', has_text="press(contact, body, force)").wait_for()
    assert '"20 N"' in page.locator('textarea[data-path="toml"]').input_value()


WATCH = """
window.seen = [];  // whether a slider stands there, at each change while the page gets ready
const stands = words => document.querySelector(words)?.checkVisibility();
new MutationObserver(() => {
  if (stands('[data-said="getting ready"]') && stands('.waiting'))
    window.seen.push(Boolean(stands('[data-slider="roughness.Ra"]')));
}).observe(document, {childList: true, subtree: true, attributes: true});
"""


def test_a_first_visit_tells_its_answer_apart_from_getting_ready(browser):
    process, address = served()
    try:
        page = browser.new_page()
        page.set_default_timeout(PATIENCE)
        page.add_init_script(WATCH)
        page.goto(address, wait_until="commit")
        kill(process.pid)  # a browser that is slow would find them ready; others are begun
        shot(page, "getting-ready")
        page.locator('[data-fact="time"]', has_text="answered in").wait_for()
        assert "in which the page was getting ready" in fact(page, "time")
        page.locator('[data-said="getting ready"]').wait_for(state="hidden")
        # no slider while it did; a server quicker than the browser shows nothing of it
        assert not any(page.evaluate("window.seen"))
        page.close()
    finally:
        ended(process)


def test_killed_processes_are_replaced_and_otherwise_it_is_told(visit, server):
    page, pid = visit(example()), server[0].pid
    page.locator(".grain").first.wait_for()
    before = fact(page, "load")
    kill(pid)
    moved(page, "load")
    page.wait_for_function(
        "old => document.querySelector(\"[data-fact='load']\").innerText !== old",
        arg=before,
        polling=100,
    )
    banner = page.locator('[data-said="page"]')
    assert not banner.inner_text()
    over = threading.Event()

    def always():
        while not over.wait(0.02):
            kill(pid)

    killer = threading.Thread(target=always)
    killer.start()
    try:
        before = fact(page, "load")
        moved(page, "roughness.sigma")
        banner.get_by_text("killed (SIGKILL)").wait_for()
        assert "memory than the page allows" not in banner.inner_text()
        page.get_by_role("tab", name="Curves", exact=True).click()
        page.wait_for_timeout(500)
        assert page.locator(".xtick").count() == 0  # no axes of nothing
        shot(page, "killed")
        page.get_by_role("tab", name="Interface", exact=True).click()
    finally:
        over.set()
        killer.join()
    page.locator('[data-path="again"]').click()
    page.wait_for_function(
        "() => document.querySelector('[data-said=page]').innerText === ''", polling=100
    )
    assert not page.locator('[data-path="again"]').is_visible()
    page.get_by_role("tab", name="Curves", exact=True).click()
    drawn(page, "area")


def test_what_was_missing_is_not_told_once_it_is_there(visit):
    study = example() | {"surfaces": BARE}
    study["particles"] = study["particles"] | {"material": BARE["first"]}
    page = visit(study, "error_bars")
    said = page.locator('[data-said="error bars"]')
    assumed = page.locator('[data-fact="error bars assumed"]')
    assumed.get_by_text("shown for ±10 % of").wait_for()
    drawn(page, "bands")
    study["uncertainty"] = {"inputs": {"roughness.sigma": {"low": "95 nm", "high": "105 nm"}}}
    page.get_by_role("tab", name="Take away", exact=True).click()
    text = page.locator('textarea[data-path="toml"]')
    text.wait_for()
    text.fill(
        text.input_value() + '\n[uncertainty.inputs."roughness.sigma"]\nlow = "95 nm"\n'
        'high = "105 nm"\n'
    )
    page.locator('[data-take="toml"]').click()
    page.get_by_role("tab", name="Error bars", exact=True).click()
    assumed.wait_for(state="hidden")
    drawn(page, "bands")
    assert not said.inner_text()
    page.wait_for_function(f"() => ({INPUTS})().length === 1", polling=100)
    shot(page, "error-bars")


INPUTS = "() => document.querySelector('[data-figure=tornado]').data[0].y"
"""The inputs that have a bar."""
ON_THE_MAP = """() => {
  const plot = document.querySelector("[data-figure='map']");
  const mark = plot.layout.shapes.find(each => each.name === "this study");
  const map = plot.data[0], ends = a => [Math.min(...a), Math.max(...a)];
  const [[x0, x1], [y0, y1]] = [ends(map.x), ends(map.y)];
  return x0 < mark.xanchor && mark.xanchor < x1 && y0 < mark.yanchor && mark.yanchor < y1;
}"""


def test_a_map_contains_its_study(visit):
    page = visit(BALL, "mode_map")
    drawn(page, "map")
    assert page.evaluate(ON_THE_MAP)
    shot(page, "map")
    page.locator('[data-work="map"]').click()
    page.locator('[data-stale="map"]').wait_for(state="hidden")
    page.wait_for_function(ON_THE_MAP, polling=100)


def test_axes_of_outputs_end_where_nothing_matters(visit):
    study = example("Oil of code 18/16/13")
    study = study | {"outputs": {"friction": {"m_ss": 0.2, "m_sa": 0.3}, "counts": {}}}
    page = visit(study, "outputs")
    drawn(page, "output friction [1]")
    axes = page.evaluate(
        "() => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p._fullLayout?.yaxis)"
        ".map(p => [p.closest('[data-figure]')?.dataset.figure,"
        " p._fullLayout.yaxis.type, p._fullLayout.yaxis.range])"
    )
    kinds = {name: kind for name, kind, _ in axes}
    assert kinds["output friction [1]"] == "linear"
    for _, kind, (low, high) in axes:
        assert kind == "linear" or high - low < 19
    shot(page, "outputs")


def test_sliders_are_read_out_with_their_values(visit):
    page = visit(example())
    page.locator(".grain").first.wait_for()
    handles = page.locator('.sliders [role="slider"]:visible')
    said = handles.evaluate_all("all => all.map(e => [e.tabIndex, e.ariaLabel, e.ariaValueText])")
    assert len(said) >= 4
    for index, label, value in said:
        assert (index, bool(label), bool(value)) == (0, True, True), label
    assert dict((label, value) for _, label, value in said)["σ"] == "100 nm"
    before = said[0][2]
    assert before.startswith("load ")
    moved(page, "load")
    page.wait_for_function(
        "old => document.querySelector('[data-slider=load] [role=slider]').ariaValueText !== old",
        arg=before,
        polling=100,
    )


def test_the_study_before_is_there_after_a_reload(visit):
    """As it was opened and as it was kept; a slider moves it on before and after the reload."""
    page = visit(BALL, "before_after")
    rows = page.locator("table").first

    def pressed(key):
        """Until table and address are those of the study then."""
        before = [rows.inner_text(), page.evaluate("location.search")]
        moved(page, "particles.iso4406", key)
        page.wait_for_function(
            "([told, search]) => document.querySelector('table').innerText !== told"
            " && location.search !== search",
            arg=before,
            polling=100,
        )

    rows.wait_for()
    pressed("ArrowRight")
    page.get_by_text("particles.iso4406: 18/16/13 → 19/17/14").wait_for()
    assert "&opened=" in page.evaluate("location.search")
    page.reload()
    page.get_by_text("particles.iso4406: 18/16/13 → 19/17/14").wait_for()
    page.locator('[data-path="before.keep"]').click()
    page.get_by_text("particles.iso4406: 18/16/13 → 19/17/14").wait_for(state="detached")
    page.wait_for_function("() => location.search.includes('&beside=')", polling=100)
    pressed("ArrowRight")
    page.reload()
    page.get_by_text("particles.iso4406: 19/17/14 → 20/18/15").wait_for()
    assert page.locator('[data-path="before"]').input_value() == "as it was kept"
    page.locator('[data-path="before.back"]').click()
    page.get_by_text("particles.iso4406: 19/17/14 → 20/18/15").wait_for(state="detached")
    shot(page, "before")
