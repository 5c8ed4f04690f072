"""Dents per raceway from ``thirdbody life``: now, as the oil ends, with other filters and without."""

import json
import math
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import refused

from thirdbody import load_study
from thirdbody.errors import Mistake
from thirdbody.populations.measured.cleanliness import counted_sizes
from thirdbody.study.dirty_oil import dirty_oil
from thirdbody.study.life_dents import dents_of_life
from thirdbody.study.run_life import history_of, load_oil, run_life
from thirdbody.systems.oil_filter import Filter
from thirdbody.views.life_dents_words import tables_of_dents
from thirdbody.views.life_words import answer
from thirdbody.views.report.tables import life_section

from .life_shell import CONTACT, enter, quarry, run, said, setting, study

DESIGN = """
[life.design]
code = "11/9/6"
[[life.design.filters]]
name = "fine filter"
beta = { "2 um" = 20, "4 um" = 75, "7 um" = 1000 }
"""


BEGINS, RETURN, FINE = "as it begins", "with the return filter", "with fine filter instead"
OTHER, NONE = "with --filter instead", "without the return filter"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    return enter(tmp_path, monkeypatch)


@pytest.fixture
def oils():
    asked = load_oil(quarry(DESIGN))
    history = history_of(asked)
    found = dents_of_life(asked, history, filter=Filter.from_text("5=75, 10=1000"))
    return asked, history, {each.oil: each for each in found.oils}


def test_every_quartz_grain_from_4_um_on_dents_both_rings(oils):
    """Per overrolling ε h n pass, all of them far larger and harder than film and steel are."""
    _, history, found = oils
    count = history.terms.classes.counted(history.terms.steady.sum(axis=1))[0]
    for track in found[RETURN].tracks:
        assert track.per_overrolling == pytest.approx(track.film * count, rel=1e-9)
        assert track.depth < track.depth_p95
    start = found[BEGINS]
    assert (start.time, start.code) == (0.0, "20/18/15")


def test_per_hour_is_what_rolls_over_in_an_hour(oils):
    """Balls that pass a place per second, times dents at each, over the sides of the load."""
    asked, _, found = oils
    body, force, E = asked.rolling.body, asked.rolling.force, asked.rolling.contact.E_ss
    for ring, track in zip(("inner", "outer"), found[BEGINS].tracks, strict=True):
        assert track.track == f"the {ring} ring"
        swept = body.swept_area(body.share_load(force, E), ring, E)
        passed = swept * body.rolling_speed * 3600
        assert track.per_hour == pytest.approx(passed * track.per_overrolling, rel=1e-12)


def test_dents_are_those_of_film(oils):
    """The same oil as [[particles]] of the bearing: `thirdbody film` counts as many."""
    _, _, found = oils
    text = Path(study("ball-bearing")).read_text("utf-8").split("[[particles]]")[0]
    dust = (
        '[[particles]]\nname = "dust"\nmaterial = "quartz"\niso4406 = "20/18/15"\ngap = "0.3 um"\n'
    )
    Path("film.toml").write_text(text + dust, "utf-8")
    for ring, track in zip(("inner", "outer"), found[BEGINS].tracks, strict=True):
        (alone,) = dirty_oil(load_study("film.toml", [f"body.ring={ring}"])).populations
        # classes of size, and the film without the few grains
        assert track.per_hour == pytest.approx(alone.per_hour, rel=2e-3)
        assert track.depth_p95 == pytest.approx(alone.depth_p95, rel=0.05)


def test_other_filters_and_none(oils):
    asked, _, found = oils
    names = list(found)
    assert names == [
        BEGINS,
        RETURN,
        FINE,
        OTHER,
        NONE,
    ]
    fine = asked.circuit.replace(filters=(asked.design.filters[0].replace(flow=1e-3),))
    assert found[FINE].code == fine.steady_code()
    inner = {name: each.tracks[0].per_hour for name, each in found.items()}
    assert inner[FINE] < inner[RETURN]
    assert inner[OTHER] > inner[RETURN]
    assert inner[NONE] > 100 * inner[RETURN]


def test_a_count_that_does_not_end_is_that_after_the_history():
    asked = load_oil(quarry(), ["life.oil.settling_area=0", 'life.duration="100 h"'])
    history = history_of(asked)
    (without,) = (o for o in dents_of_life(asked, history).oils if o.oil.startswith("without"))
    assert without.time == 100 * 3600
    terms = asked.circuit.replace(filters=()).terms()
    grown = terms.start + terms.ingress * without.time / asked.circuit.volume
    count = terms.classes.counted(grown.sum(axis=1))[0]
    assert without.tracks[0].per_overrolling == pytest.approx(
        without.tracks[0].film * count, rel=1e-9
    )


def test_past_a_full_filter_the_oil_dents_as_it_is_after_the_history():
    """With the filter in work it ends at 12/11/7; the oil goes past it from 432 h on."""
    keys = ["life.filters.0.when_full=bypass", "life.oil.oil_changes=[]"]
    file = quarry()
    asked = load_oil(file, keys)
    history = history_of(asked)
    assert history.bypassed == ("return filter",)
    assert history_of(load_oil(file)).bypassed == ()  # it is changed
    found = {each.oil: each for each in dents_of_life(asked, history).oils}
    past, without = found[RETURN], found[NONE]
    assert (past.code, past.time) == (history.codes[-1], asked.duration)
    assert past.tracks[0].per_overrolling == pytest.approx(
        past.tracks[0].film * history.counts[-1][0], rel=1e-9
    )
    assert past.tracks[0].per_hour == pytest.approx(without.tracks[0].per_hour, rel=1e-2)
    assert asked.circuit.steady_code(full=history.bypassed) == "23/21/15"
    tends = answer(run_life(asked))[1]
    assert "23/21/15" in tends
    assert tends in said(run("life", file, *setting(*keys)))


def test_smaller_particles_are_told_apart(oils):
    """Below 4 µm nothing of the oil as it begins, dust later: more of it, and shallower."""
    _, history, found = oils
    assert found[BEGINS].tracks[0].smaller_per_hour == 0
    track = found[RETURN].tracks[0]
    below = np.array(history.terms.classes.edges[1:]) <= counted_sizes()[0] * (1 + 1e-9)
    most = track.film * history.numbers[-1][below].sum()
    assert 0 < track.smaller_per_hour / track.per_hour * track.per_overrolling <= most * (1 + 1e-9)
    assert track.smaller_depth < 0.2 * track.depth


@pytest.mark.check
def test_it_is_printed_and_in_json():
    file = quarry(DESIGN)
    done = run("life", file)
    told = said(done)
    assert max(map(len, done.stdout.splitlines())) <= 80
    # what is printed of it: the one place that holds these words
    assert "The oil with the return filter dents the inner ring" in told
    assert "life.entry" in done.codes
    data = json.loads(run("life", file, "--json").stdout)["dents"]
    found = run_life(load_oil(file)).dents
    (table,) = tables_of_dents(found)
    assert table.above in told
    assert data["oils"][1]["oil"] == found.oils[1].oil
    assert data["oils"][1]["tracks"][1]["per_hour"] == found.oils[1].tracks[1].per_hour
    assert data["oils"][1]["time"] is None  # no end of it
    assert math.isinf(found.oils[1].time)


@pytest.mark.check
def test_the_report_holds_the_table():
    found = run_life(load_oil(quarry()))
    (part,) = life_section(SimpleNamespace(life=found))
    for oil in found.dents.oils:
        assert f"<td>{oil.oil}</td>" in part


@pytest.mark.check
def test_a_workbook_holds_the_table():
    openpyxl = pytest.importorskip("openpyxl", reason="needs the extra thirdbody[xlsx]")
    assert run("life", quarry(), "--xlsx", "a.xlsx").exit_code == 0
    cells = [row[0] for row in openpyxl.load_workbook("a.xlsx")["Answer"].values]
    assert {oil.oil for oil in run_life(load_oil(quarry())).dents.oils} <= set(cells)


def test_a_filter_needs_something_that_rolls():
    bare = study("oil-circuit")
    Path("alone.toml").write_text(
        Path(bare).read_text("utf-8").split("# The contact that")[0], "utf-8"
    )
    (lacks,) = refused("life", "alone.toml", "--filter", "5=75").problems
    assert lacks.code is Mistake.MISSING
    assert lacks.endswith(" [surfaces], [roughness] and [film]")
    (film,) = refused("life", bare, "--filter", "5=75").problems
    assert film.code is Mistake.MISSING
    assert re.findall(r"\[\w+\]", film) == ["[film]"]
    study("dry-contact", file="dry.toml")
    assert refused("life", "dry.toml", "--filter", "5=75").problems[0].code is Mistake.IDLE
    (form,) = refused("life", quarry(), "--filter", "5=x").problems
    assert form.code is Mistake.FORM
    assert form.startswith("--filter ")


def test_a_filter_of_the_command_is_doubted_as_one_of_the_study():
    done = run("life", quarry(), "--filter", "5=2, 10=75", "--verbose")
    below = done.note("below the data sheet, tried")
    assert below.startswith("--filter ")
    assert "5 µm" in below
    assert "--filter" in done.note("clipped, tried")
    assert not any("--filter" in note for note in run("life", quarry()).notes)


def test_a_contact_takes_its_film_from_the_body():
    """[life.contact] with [body] alone: conjunction, load, speed of the most loaded ball."""
    parts = CONTACT[: CONTACT.index("[film]")] + CONTACT[CONTACT.index("[life.debris]") :]
    file = quarry(parts.replace("contacts = 20", "entry_ratio = 0.1"))
    asked = load_oil(file)
    film, body = asked.rolling.film, asked.rolling.body
    given = asked.contact.conditions
    assert (given["load"], given["speed"]) == (film.load, body.rolling_speed)
    assert given["load"] == pytest.approx(262.6, rel=1e-3)
    share = body.share_load(500.0, asked.rolling.contact.E_ss)
    E = asked.rolling.contact.E_ss
    contacts = body.swept_area(share, "inner", E) / body.widths(share.largest, "inner", E)
    assert given["contacts"] == pytest.approx(float(contacts), rel=1e-9)
    assert any("life.contact.contacts = " in each for each in asked.assumed)
    assert load_oil(file, ["life.contact.contacts=7"]).contact.conditions["contacts"] == 7
    found = dents_of_life(asked, history_of(load_oil(quarry())))
    assert (found.entry_ratio, found.assumed) == (0.1, False)


def test_a_body_that_says_too_little_is_told():
    flat = setting("body.kind=flat", 'body={kind="flat", area="1 cm^2"}')
    told = refused("life", quarry(), *flat).mistakes
    assert told == [(Mistake.MISSING, "film.speed"), (Mistake.MISSING, "film")]
