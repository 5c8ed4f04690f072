"""From a key on a slider to the frame that shows the new picture, in a real browser.

python benchmarks/page.py
python benchmarks/page.py --against OTHER/CHECKOUT
python benchmarks/page.py --every                  every slider on every tab
python benchmarks/page.py --every --tab Film --tab Map
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Collection
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "app"))
from browser import chromium, ended, served

ROOT = Path(__file__).parent.parent
MOVES, WARM = 40, 5
CASES = (("Interface", "load"), ("Curves", "load"), ("Curves", "roughness.sigma"))
WATCHED = {
    ("Interface", "load"): '[data-figure="section"]',
    ("Curves", "load"): ".figures .layer-above .shapelayer, .figures .here",
    ("Curves", "roughness.sigma"): ".figures .scatterlayer",
}
"""What is another one once the picture is drawn, of every figure in sight."""
WATCH = """selector => {
  const paths = e => e.tagName === "g" ? [...e.querySelectorAll("path")]
    .map(p => p.getAttribute("d")).join() : e.innerHTML + e.getAttribute("style");
  const look_at = () => { const out = new Map();
    for (const e of document.querySelectorAll(selector)) {
      const whole = e.closest("[data-figure]"), box = whole.getBoundingClientRect();
      if (box.height && box.top < innerHeight - box.height / 2)
        out.set(whole, (out.get(whole) ?? "") + paths(e));
    }
    return out; };
  const was = look_at();
  window.key = undefined;
  window.shown = new Promise(done => {
    addEventListener("keydown", e => { window.key = e.timeStamp; }, { capture: true, once: true });
    const look = () => {
      const now = look_at();
      if (window.key !== undefined && [...was].every(([e, old]) => now.get(e) !== old))
        setTimeout(() => done(performance.now() - window.key));  // after this frame
      else requestAnimationFrame(look);
    };
    look();
  });
  return was.size;
}"""


FIRST_CHANGE = """() => {
  const panel = document.querySelector(".q-tab-panel"), drawn = ".scatterlayer path, "
    + ".barlayer path, .shapelayer path, [data-figure=section] path";
  const look_at = () => [
    ...[...panel.querySelectorAll(drawn)].map(e => e.getAttribute("d")),
    ...[...panel.querySelectorAll("image")].map(e => e.getAttribute("href")?.length),
    ...[...panel.querySelectorAll(".here")].map(e => e.getAttribute("style")),
    ...[...document.querySelectorAll("[data-fact]:not([data-fact=time])")].map(e => e.innerText),
  ].join();
  const was = look_at(), began = performance.now();
  window.key = undefined;
  window.shown = new Promise(done => {
    addEventListener("keydown", e => { window.key = e.timeStamp; }, { capture: true, once: true });
    const look = () => {
      if (window.key !== undefined && look_at() !== was)
        setTimeout(() => done(performance.now() - window.key));
      else if (performance.now() - began > 4000) done(null);
      else requestAnimationFrame(look);
    };
    look();
  });
}"""
"""The first new picture or number of the tab; null where four seconds bring none."""
FEW = 8


def first_changes(browser: Any, address: str, tabs: Collection[str] = ()) -> None:
    """A row a slider of these tabs, or of all: how long until the first new picture."""
    page = browser.new_page(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    print("| tab | slider | median ms | longest ms |\n|---|---|---|---|")
    page.goto(address)
    page.wait_for_selector('[data-figure="section"] svg')
    for name in page.get_by_role("tab").all_inner_texts():
        if tabs and name.strip() not in tabs:
            continue
        page.get_by_role("tab", name=name.strip(), exact=True).click()
        page.wait_for_timeout(8000)  # what follows a preview is there
        places = page.evaluate(
            "() => [...document.querySelectorAll('.q-slider[data-slider]')]"
            ".filter(e => e.offsetParent).map(e => e.dataset.slider)"
        )
        for slider in places:
            page.locator(f'[data-slider="{slider}"] .q-slider__track-container').focus()
            times = []
            for move in range(FEW):
                page.evaluate(FIRST_CHANGE)
                page.keyboard.press("ArrowRight" if move % 2 else "ArrowLeft")
                times.append(page.evaluate("window.shown"))
                page.wait_for_timeout(150)
                if times[-1] is None:
                    break
            known = [each for each in times[1:] if each is not None]
            ends = f"{statistics.median(known):.0f} | {max(known):.0f}" if known else "none | none"
            print(f"| {name.strip()} | {slider} | {ends} |", flush=True)


def measured(browser: Any, address: str, name: str, slider: str) -> list[float]:
    """Milliseconds of every move, to and fro through the middle of the slider."""
    page = browser.new_page(viewport={"width": 1280, "height": 860}, reduced_motion="reduce")
    page.goto(address)
    page.wait_for_selector('[data-figure="section"] svg')
    page.get_by_role("tab", name=name, exact=True).click()
    if name == "Curves":
        page.wait_for_selector('[data-figure="critical"]')
        page.locator('[data-figure="separation"] .scatterlayer path').first.wait_for()
    page.locator(f'[data-slider="{slider}"] .q-slider__track-container').focus()
    page.wait_for_timeout(1000)
    times = []
    for move in range(WARM + MOVES):
        assert page.evaluate(WATCH, WATCHED[name, slider]) == (2 if name == "Curves" else 1)
        page.keyboard.press("ArrowRight" if (move // 50) % 2 else "ArrowLeft")
        times.append(page.evaluate("window.shown"))
        page.wait_for_timeout(60)
    page.close()
    return times[WARM:]


def main() -> None:
    """One line a case, for each checkout in turn."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", type=Path, help="another checkout, measured in the same run")
    parser.add_argument("--every", action="store_true", help="every slider on every tab")
    parser.add_argument("--tab", action="append", default=[], help="of this tab alone")
    asked = parser.parse_args()
    other = asked.against
    from playwright.sync_api import sync_playwright

    sources = {"this": ROOT} | ({"other": other.resolve()} if other else {})
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium(playwright), args=["--no-sandbox"]
        )
        if asked.every:
            server, address = served()
            try:
                first_changes(browser, address, asked.tab)
            finally:
                ended(server)
            return
        print("| checkout | tab | slider | median ms | 19 of 20 below ms |\n|---|---|---|---|---|")
        servers = {name: served(source=source) for name, source in sources.items()}
        try:
            for name, slider in CASES:
                if asked.tab and name not in asked.tab:
                    continue
                for which, (_, address) in servers.items():
                    times = measured(browser, address, name, slider)
                    row = [which, name, slider, f"{statistics.median(times):.0f}"]
                    row.append(f"{statistics.quantiles(times, n=20)[-1]:.0f}")
                    print(f"| {' | '.join(row)} |", flush=True)
        finally:
            for server, _ in servers.values():
                ended(server)
        browser.close()


if __name__ == "__main__":
    main()
