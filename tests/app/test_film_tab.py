"""The tab of the lubricated contact: its numbers are those of the library."""

import pickle
import tomllib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from thirdbody.study import check, run_film
from thirdbody.study.run import MOST_SPEEDS, run_film_curve

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app.state import look
from thirdbody.app.tabs.film import START, film_figures, oil_of
from thirdbody.quantities.say import Least
from thirdbody.views.film_words import point

STUDY = Path(__file__).parents[2] / "examples" / "oil_film.toml"


def study_of(**film):
    data = tomllib.loads(STUDY.read_text(encoding="utf-8"))
    data["film"] |= film
    return data


def test_the_curve_is_that_of_the_library():
    study = check(study_of())
    found, middle = run_film_curve(study)
    curve = study.film.stribeck(study.contact)
    assert found["states"]["mu"] == curve.mu.values.tolist()
    figures = film_figures(found, middle)
    shares = {trace["name"]: trace["y"] for trace in figures["film shares"]["data"]}
    assert shares["particles"] == (100 * curve.sa_share.values).tolist()
    words = [note["text"] for note in figures["film shares"]["layout"]["annotations"]]
    assert words == ["boundary", "mixed", "full film"]
    # what a user waits for; benchmarks/waiting.py measures it
    assert len(found["states"]["speed"]) <= MOST_SPEEDS + 1


def test_one_speed_is_drawn_with_what_is_near():
    study = check(study_of(speed="0.5 m/s"))
    found, at = run_film_curve(study)
    assert len(found["states"]["speed"]) == MOST_SPEEDS + 1
    assert found["states"]["speed"][at] == 0.5
    assert point(found, at) == point(run_film(study), 0)


def test_many_speeds_are_thinned():
    found, _ = run_film_curve(check(study_of(speed={"from": 0.01, "to": 1.0, "points": 500})))
    speeds = found["states"]["speed"]
    assert len(speeds) == MOST_SPEEDS
    assert (speeds[0], speeds[-1]) == (0.01, 1.0)


def test_a_film_without_particles_has_no_curves_of_them():
    data = study_of()
    del data["particles"]
    found, at = run_film_curve(check(data))
    names = {t["name"] for made in film_figures(found, at).values() for t in made["data"]}
    assert "asperities" in names
    assert not any("particle" in name for name in names)
    assert not any("particle" in name for name in point(found, at))


def test_what_is_added_is_a_study():
    data = study_of()
    data["film"] = START
    assert np.all(np.diff(check(data).film.speed) > 0)


@pytest.mark.parametrize("fine", ["", "5=75, 10=1000"])
def test_what_the_oil_does_comes_whole_from_another_process(fine):
    """Shares too small to be read keep their number; the page shows them all the same."""
    text = (
        resources.files("thirdbody").joinpath("data/studies/ball-bearing.toml").read_text("utf-8")
    )
    answer, problems, _ = look(tomllib.loads(text), Path())
    assert not problems
    oil = oil_of(answer, fine)
    assert any("< 0.0001 %" in cell for row in oil.rows for cell in row)
    back = pickle.loads(pickle.dumps(oil))
    assert back == oil
    small = [cell for row in oil.rows for cell in row if isinstance(cell, Least)]
    kept = [cell for row in back.rows for cell in row if isinstance(cell, Least)]
    assert [each.value for each in kept] == [each.value for each in small]
    assert small
