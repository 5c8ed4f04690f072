"""The tab of the lubricated contact: its numbers are those of the library, in time."""

import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

from thirdbody.study import check, run_film

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app.tabs.film import MOST, START, film_figures, solved
from thirdbody.film_words import point

STUDY = Path(__file__).parents[2] / "examples" / "oil_film.toml"


def study_of(**film):
    data = tomllib.loads(STUDY.read_text(encoding="utf-8"))
    data["film"] |= film
    return data


def test_the_curve_is_that_of_the_library_in_time():
    study = check(study_of())
    solved(study)
    began = time.process_time()
    found, middle = solved(study)
    spent = time.process_time() - began
    curve = study.film.stribeck(study.contact)
    assert found["states"]["mu"] == curve.mu.values.tolist()
    figures = film_figures(found, middle)
    shares = {trace["name"]: trace["y"] for trace in figures["film shares"]["data"]}
    assert shares["on particles"] == (100 * curve.sa_share.values).tolist()
    words = [note["text"] for note in figures["film shares"]["layout"]["annotations"]]
    assert words == ["boundary", "mixed", "full film"]
    assert spent < 1.0


def test_one_speed_is_drawn_with_what_is_near():
    study = check(study_of(speed="0.5 m/s"))
    found, at = solved(study)
    assert len(found["states"]["speed"]) == MOST + 1
    assert found["states"]["speed"][at] == 0.5
    assert point(found, at) == point(run_film(study), 0)


def test_many_speeds_are_thinned():
    found, _ = solved(check(study_of(speed={"from": 0.01, "to": 1.0, "points": 500})))
    speeds = found["states"]["speed"]
    assert len(speeds) == MOST
    assert (speeds[0], speeds[-1]) == (0.01, 1.0)


def test_a_film_without_particles_has_no_curves_of_them():
    data = study_of()
    del data["particles"]
    found, at = solved(check(data))
    names = {t["name"] for made in film_figures(found, at).values() for t in made["data"]}
    assert "asperities" in names
    assert not any("particle" in name for name in names)
    assert not any("particle" in name for name in point(found, at))


def test_what_is_added_is_a_study():
    data = study_of()
    data["film"] = START
    assert np.all(np.diff(check(data).film.speed) > 0)


# ---------------------------------------------------------------- in a browser
sys.path.insert(0, str(Path(__file__).parent))
pytest.importorskip("playwright.sync_api", reason="needs playwright to drive a browser")
from test_browser import (  # noqa: E402, F401
    address,
    browser,
    drawn,
    fact,
    looked_at,
    moved,
    shared,
    tab,
    visit,
)


def test_the_tab_shows_and_moves(visit):  # noqa: F811
    page = visit(study_of())
    tab(page, "Film")
    by_name = {trace["name"]: trace for trace in drawn(page, "film friction")}
    study = check(study_of())
    curve = study.film.stribeck(study.contact)
    assert by_name["sum"]["y"] == curve.mu.values.tolist()
    assert fact(page, "film: friction coefficient") == f"{float(curve.mu[30]):.4g}"
    looked_at(page, "film")
    moved(page, "film.speed", 5)
    there = page.locator('[data-fact="film: friction coefficient"]')
    there.get_by_text(f"{float(curve.mu[35]):.4g}", exact=True).wait_for()


def test_a_film_is_added_changed_and_removed(visit):  # noqa: F811
    page = visit()
    tab(page, "Film")
    page.locator('[data-path="film.add"]').click()
    drawn(page, "film shares")
    field = page.locator('[data-path="film.oil.eta"]')
    field.fill("20 mPa")
    entry = page.locator(".q-field", has=field)
    entry.get_by_text("is a pressure, but a viscosity").wait_for()
    before = fact(page, "film: lambda = h_T/sigma")
    field.fill("60 mPa s")
    page.wait_for_function(
        "old => document.querySelector(`[data-fact='film: lambda = h_T/sigma']`).innerText !== old",
        arg=before,
    )
    assert not page.locator('[data-said="page"]').inner_text()
    page.locator('[data-path="film.remove"]').click()
    page.locator('[data-path="film.add"]').wait_for()
