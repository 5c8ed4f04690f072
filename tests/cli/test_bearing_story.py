"""The bearing question from an empty folder: dust or steel, and would a filter help?"""

import json
import math
import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from refusals import Mistake, refuses
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli, load_study
from thirdbody.quantities.say import number, value_of
from thirdbody.study import bearing_file, check
from thirdbody.study.dirty_oil import dirty_oil
from thirdbody.study.toml import read
from thirdbody.systems.bearing_life import contamination_factor, life_factor, viscosity_ratio
from thirdbody.systems.bearing_sizes import DESIGNATIONS
from thirdbody.systems.oil_filter import Filter
from thirdbody.systems.oil_particles import FilmParticles
from thirdbody.views.oil_words import answer, filter_answer, filter_rows


def run(*arguments, code=0):
    done = CliRunner().invoke(cli.app, [str(argument) for argument in arguments])
    assert done.exit_code == code, done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout if code == 0 else " ".join(done.stderr.split())


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return tmp_path


@pytest.mark.check
def test_which_of_them_dents_and_would_a_filter_help():
    """Three commands: new, film, film --filter; the answer stands first."""
    assert run("new", "ball-bearing", "6205") == "thirdbody film ball-bearing.toml\n"
    shown = run("film", "ball-bearing.toml")
    assert max(map(len, shown.splitlines())) <= 80
    title, *lines = shown.splitlines()
    assert title.startswith("Ball bearing 6205 under 0.5 kN at 3000 rpm, oil 18/16/13")
    told = " ".join(" ".join(lines).split())
    study = load_study("ball-bearing.toml")
    found = dirty_oil(study)
    assert told.startswith(" ".join(answer(found)))
    dents, carries, life = answer(found)
    dust, steel = found.populations
    assert dust.depth_p95 > steel.depth_p95
    assert steel.per_hour > dust.per_hour
    depths = [value_of(each, "m", 3) for part in (dust, steel)
              for each in (part.depth, part.depth_p95)]  # fmt: skip
    assert re.findall(r"[\d.]+ [nµ]m", dents) == depths
    assert value_of(found.speed, "m/s", 3) == "2.9 m/s"
    for each in ("2.9 m/s", f"lambda = {number(found.lambda_ratio, 2)}"):
        assert each in carries
    for value in (found.life.e_C, found.life.a_ISO, found.life.clean):
        assert number(value, 2) in life
    assert f"kappa = {number(found.life.kappa, 3)}" in life
    assert "Of 9 balls" in told
    assert "Stribeck" in told
    filtered = run("film", "ball-bearing.toml", "--filter", "5=75, 10=1000")
    assert max(map(len, filtered.splitlines())) <= 80
    told = " ".join(filtered.split())
    after = dirty_oil(study, filter=Filter(sizes=(5e-6, 10e-6), betas=(75.0, 1000.0)))
    assert f") {filter_answer(found, after)} {' '.join(answer(found))} " in told
    assert (found.life.code, after.life.code) == ("18/16/13", "13/9/3")
    # before, and after the filter
    assert "ISO 4406 code 18/16/13 13/9/3 " in told
    depths = [value_of(each.populations[0].depth, "m", 3) for each in (found, after)]
    assert f"dust: depth {depths[0]} {depths[1]} " in told
    for row in filter_rows(found, after):
        assert " ".join(row) in told


def test_the_numbers_of_the_answer_are_those_of_the_parts():
    """JSON: life factors by ISO 281's functions, dents by the film of particles, each by itself."""
    run("new", "ball-bearing")
    found = json.loads(run("film", "ball-bearing.toml", "--json"))
    oil, (state,) = found["oil"], found["states"]["h_T"]
    study = load_study("ball-bearing.toml")
    assert oil["film"] == pytest.approx(state, rel=1e-12)
    kappa = viscosity_ratio(20e-3 / 870, turns=50.0, D=38.5e-3)
    e_C = contamination_factor("bath", "18/16/13", kappa=kappa, D=38.5e-3)
    a_ISO = life_factor("ball", kappa=kappa, load=e_C * 356 / 500)
    life = oil["life"]
    assert (life["kappa"], life["e_C"]) == pytest.approx((kappa, e_C), rel=1e-12)
    assert life["a_ISO"] == pytest.approx(a_ISO, rel=1e-9)
    assert life["hours"] == pytest.approx(a_ISO * (13.6 / 0.5) ** 3 * 1e6 / 180e3, rel=1e-9)
    n, _ = tb.populations.measured.cleanliness.suspension_of_iso4406("18/16/13")
    for part, share in zip(oil["populations"], (0.1, 0.9), strict=True):
        assert part["per_volume"] == pytest.approx(share * n, rel=1e-12)
    own = FilmParticles.from_iso4406(
        "18/16/13", surfaces=study.contact.surfaces, material=tb.materials["quartz"],
        film=state, entry=1.0,
    ).dents(2)  # fmt: skip
    dust = oil["populations"][0]
    assert dust["per_overrolling"] == pytest.approx(0.1 * own.number, rel=1e-9)
    assert dust["depth_p95"] == pytest.approx(own.depth_p95, rel=1e-9)
    # balls at their places while the cage turns little by little, each with the width of its ellipse
    share = study.body.share_load(500.0, study.contact.E_ss)
    places = 2 * np.pi * (np.arange(9 * 500) + 0.5) / (9 * 500)
    approach = 1 - (1 - np.cos(places)) / (2 * share.eps)
    loads = share.largest * approach[approach > 0] ** 1.5
    widths = 2 * study.body.on_ring("inner").semi_axes(loads, E=2 * study.contact.E_ss)[1]
    swept = np.sum(widths) / 500 * study.body.rolling_speed * 3600
    assert dust["per_hour"] == pytest.approx(dust["per_overrolling"] * swept, rel=1e-4)
    carried = oil["film_share"] + oil["asperity_share"] + oil["particle_share"]
    assert carried == pytest.approx(1, rel=1e-9)
    parts = sum(part["load_share"] for part in oil["populations"])
    assert parts == pytest.approx(oil["particle_share"], rel=1e-6)


@pytest.mark.check
def test_a_filter_lets_through_what_its_beta_says():
    study = load_study(resources.files("thirdbody").joinpath("data/studies/ball-bearing.toml"))
    before = dirty_oil(study)
    none = dirty_oil(study, filter=Filter(sizes=(5e-6,), betas=(1.0,)))
    fine = dirty_oil(study, filter=Filter(sizes=(0.1e-6, 1e-3), betas=(10.0, 10.0)))
    for i, part in enumerate(before.populations):
        assert none.populations[i].per_hour == pytest.approx(part.per_hour, rel=1e-6)
        assert fine.populations[i].per_hour == pytest.approx(part.per_hour / 10, rel=1e-6)
        assert fine.populations[i].depth == pytest.approx(part.depth, rel=1e-3)
    assert before.life.place == "bath"
    assert none.life.place == fine.life.place == "filter"
    assert none.life.code == before.life.code
    assert before.life.a_ISO < none.life.a_ISO < fine.life.a_ISO <= fine.life.clean


@pytest.mark.spread(8)
@pytest.mark.parametrize("name", [*DESIGNATIONS, "25x52x15", "6205-2RS/C3"])
def test_every_designation_makes_a_file_that_reads(name):
    made = run("new", "ball-bearing", name, "--out", "own.toml")
    assert made == "thirdbody film own.toml\n"
    text = Path("own.toml").read_text("utf-8")
    assert max(map(len, text.splitlines()[1:])) <= 80
    study = load_study("own.toml")
    assert study.film.speed == (study.body.rolling_speed,)
    load = float(study.body.load_on_one(study.forces[0], study.contact.E_ss))
    assert study.film.load == pytest.approx(load, rel=1e-12)
    found = dirty_oil(study)
    assert all(part.per_hour > 0 for part in found.populations)
    assert found.life.code == "18/16/13"


def test_the_template_is_that_of_its_designation():
    text = (
        resources.files("thirdbody").joinpath("data/studies/ball-bearing.toml").read_text("utf-8")
    )
    assert bearing_file.bearing_file(text, "6205") == text


@pytest.mark.parametrize(
    ("arguments", "mistake", "place", "says"),
    [
        (["new", "ball-bearing", "6505"], Mistake.KIND, "", "did you mean"),
        (["new", "ball-bearing", "52x25x15"], Mistake.ORDER, "", '"52x25x15"'),
        (["new", "ball-screw", "6205"], Mistake.IDLE, "", "measured-surface"),
        (["film", "b.toml", "--filter", "5:75"], Mistake.FORM, "--filter", "'='"),
        (["film", "b.toml", "--filter", "10=75, 5=90"], Mistake.ORDER, "--filter", '"10=75, 5=90"'),
        (["film", "b.toml", "--set", "body.shaft_speed=-1"], Mistake.RANGE, "body.shaft_speed", ""),
        (
            ["film", "b.toml", "--set", "particles.0.share=1.2"],
            Mistake.RANGE,
            "particles.0.share",
            "1.2",
        ),
        (["film", "b.toml", "--set", "body.balls=30"], Mistake.BEYOND, "body.balls", "30"),
    ],
)
def test_one_clear_message_for_a_mistake(arguments, mistake, place, says):
    run("new", "ball-bearing", "--out", "b.toml")
    done = refused(*arguments)
    (problem,) = done.problems
    assert (problem.code, problem.place) == (mistake, place)
    assert says in problem
    assert done.stderr.count("error:") == 1


def test_a_filter_needs_particles_and_a_film():
    run("new", "two-body")
    (problem,) = refused("film", "two-body.toml", "--filter", "5=75").problems
    assert problem.code is Mistake.MISSING
    assert problem.startswith("--filter ")
    assert problem.endswith("[film]")


def test_a_speed_follows_from_the_shaft_or_is_asked_for():
    run("new", "ball-bearing", "--out", "b.toml")
    data = read(Path("b.toml"))
    del data["body"]["shaft_speed"]
    with refuses(Mistake.MISSING, "film.speed", says="body.shaft_speed"):
        check(data)
    data["film"]["speed"] = {"from": "0.1 m/s", "to": "3 m/s", "points": 3}
    study = check(data)
    assert dirty_oil(study).speed == study.film.speed[1]
    assert dirty_oil(study).life is None


@pytest.mark.check
def test_soft_debris_is_flattened_and_an_oil_too_dirty_has_no_factor():
    run("new", "ball-bearing", "--out", "b.toml")
    dirty = [f'particles.{i}.iso4406="24/22/19"' for i in (0, 1)]
    found = dirty_oil(load_study("b.toml", dirty))
    assert math.isnan(found.life.a_ISO)
    assert "24/22/19" in found.life.why
    asked = [word for each in dirty for word in ("--set", each)]
    life = json.loads(run("film", "b.toml", *asked, "--json"))["oil"]["life"]
    assert (life["a_ISO"], life["why"]) == (None, found.life.why)
    assert found.life.why in " ".join(run("film", "b.toml", *asked).split())
