"""A study on one small surface, for the page and the report."""

import dataclasses
import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.study import load_study
from thirdbody.study.one_surface import one_surface
from thirdbody.views import explicit_words
from thirdbody.views.plot.explicit import section_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "explicit.toml"
LOADS = [1e-4, 1e-3]


@pytest.fixture(scope="module")
def study():
    return load_study(EXAMPLE)


@pytest.fixture(scope="module")
def found(study):
    return one_surface(study, LOADS)


def measured(heights, spacing=2e-7):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return tb.surfaces.from_topography(heights, spacing=spacing, cutoff=0)


def rough(points=128):
    return tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=2.4e-6, longest=8e-6, spacing=2e-7, points=points
    ).heights


def test_it_is_a_surface_of_the_ensemble(study, found):
    contact = study.contact
    surface = tb.explicit.surface_of(contact, size=128, spacing=150e-9, seed=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        alone = tb.explicit.solve(contact, surface, F_star=LOADS)
    assert found.state.h.tolist() == alone.h.tolist()
    assert "128 × 128 points, 19.2 µm wide" in found.words


def test_the_model_has_the_seats_of_the_rule_not_of_a_few_particles(study, found):
    """Random seats are those of the map; the dozen particles drawn have others."""
    law = found.model.contact.particle_law
    assert law.zeta_mean == pytest.approx(0, abs=0.03)
    assert law.zeta_std == pytest.approx(1, abs=0.03)
    assert found.state.seats.std > 1.05
    lower = one_surface(
        dataclasses.replace(study, explicit=study.explicit | {"seats": tb.explicit.ValleySeats()}),
        LOADS,
    )
    assert lower.model.contact.particle_law.zeta_mean < -1


def test_twice_as_many_points_where_the_spectrum_needs_them(study):
    assert "128 × 128 points" in one_surface(study, LOADS, points=64).words
    with refuses(Mistake.BEYOND, "", says="32 x 32"):
        one_surface(study, LOADS, points=16)


def test_a_window_of_a_measured_map(study):
    heights = rough()
    heights[:40] = np.nan
    asked = dataclasses.replace(study, faces=(measured(heights),))
    found = one_surface(asked, LOADS, points=64)
    assert "a window of 64 × 64 points of" in found.words
    shown = found.state.maps.height.values.T
    # as near the middle as the gap allows
    window = asked.faces[0].heights[40:104, 32:96]
    assert shown == pytest.approx(window - window.mean(), abs=1e-15)


def test_a_map_without_such_a_window_is_refused(study):
    heights = rough(64)
    heights[::20, ::20] = np.nan
    with refuses(Mistake.BEYOND, "", says="32 x 32"):
        one_surface(dataclasses.replace(study, faces=(measured(heights),)), LOADS)


def test_positions_belong_to_a_whole_map(study):
    given = study.explicit | {"seats": tb.explicit.GivenSeats(positions=((0.0, 0.0),))}
    with refuses(Mistake.BEYOND, "", says="explicit.seats"):
        one_surface(dataclasses.replace(study, explicit=given), LOADS)


# ---------------------------------------------------------------- words and figures
def test_in_words(found):
    text = explicit_words.headline(found, 1)
    share = tb.quantities.say.percent(float(found.state.particle_load_share[1]))
    assert f"particles carry {share} of the load" in text
    assert "128 × 128 points" in text
    head, lines = explicit_words.comparison_table(found)
    assert head[0] == "F*"
    assert len(lines) == len(LOADS)
    assert all(len(line) == len(head) for line in lines)
    assert lines[1][1] == share


def test_without_particles(study):
    clean = dataclasses.replace(study, contact=study.contact.replace(particles=None))
    found = one_surface(clean, LOADS, points=64)
    assert "of the area touches" in explicit_words.headline(found, 0)
    assert "load on particles" not in explicit_words.rows(found, 0)


def test_a_section_is_that_of_the_maps(found):
    maps, bodies = found.state.maps, found.state.particles
    field = {str(name): maps[name].values for name in maps.data_vars}
    every = {str(name): bodies[name].values for name in bodies.data_vars}
    made = section_of(field, every, 150e-9)
    k = int(np.argmax(every["force"]))
    assert made.size == every["diameter"][k]
    row = round(every["y"][k] / 150e-9) % 128
    at = np.round((made.along + every["x"][k]) / 150e-9).astype(int) % 128
    assert made.height.tolist() == field["height"][row, at].tolist()
    assert made.share == pytest.approx(every["force"][k] / every["force"].sum())


def test_the_page_shows_what_was_pressed():
    pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")
    from thirdbody.app.examples import example
    from thirdbody.app.tabs import explicit
    from thirdbody.app.worker import in_little
    from thirdbody.study import check

    told = in_little("explicit", {"study": example(), "folder": ".", "F_star": 2e-4, "points": 128})
    found = one_surface(check(example()), 2e-4, points=128)
    assert told["headline"] == explicit_words.headline(found, 0)
    force = found.state.particles.force.values
    assert told["carrying"]["force"] == force[force > 0].tolist()
    assert sum(told["carrying"]["share"]) == pytest.approx(
        float(found.state.particle_load_share[0])
    )
    made = explicit.pressure_figure(told)
    grid, circles = made["data"]
    shown = [v for row in grid["z"] for v in row if v is not None]
    assert len(shown) == int(found.state.carrying_pixels[0])
    assert circles["x"].count(None) == len(told["carrying"]["force"])
    for draw in (explicit.section_figure, explicit.force_figure):
        json.dumps(draw(told), allow_nan=False)
