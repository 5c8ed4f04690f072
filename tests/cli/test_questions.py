"""``thirdbody probability`` and ``thirdbody plate``: the answer first, and one message a mistake."""

import csv
import json
import math
import re
import tomllib
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import refused, run

from thirdbody.errors import Mistake
from thirdbody.quantities.say import value_of
from thirdbody.study import check, load_study, run_film
from thirdbody.study.run import run_film_curve
from thirdbody.study.run_connector import load_connector, run_connector
from thirdbody.study.run_plate import load_plate, run_plate
from thirdbody.views import connector_words
from thirdbody.views.plate_words import answer

FILES = {"probability": "connector", "plate": "wafer-chuck"}


def said(done):
    assert done.exit_code == 0, done.stderr
    return " ".join(done.stdout.split())


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for kind in FILES.values():
        assert run("new", kind).exit_code == 0
    return tmp_path


def test_how_often_a_connector_fails_to_close():
    told = said(run("probability", "connector.toml"))
    found = run_connector(load_connector("connector.toml"))
    (at,) = found.places
    first, *others = connector_words.answer(found)
    assert re.findall(r"\d[\d.]*", first)[:2] == ["0.5", f"{1 / found.failure_of_all[at]:.0f}"]
    assert "20 contacts" in first
    # the answer, the table, and then what it hangs on most
    last = " ".join(connector_words.uncertainty(found))
    assert all(part in last for part in (found.what_ifs[0].what, found.what_ifs[0].action))
    heads = " ".join(connector_words.HEADS)
    answers, table, rest = map(told.index, (" ".join([first, *others]), heads, last))
    assert answers < table < rest


@pytest.mark.check
def test_how_high_a_wafer_stands_over_a_grain():
    done = run("plate", "wafer-chuck.toml")
    told = said(done)
    found = run_plate(load_plate("wafer-chuck.toml"))
    first = answer(found)[0]
    assert first in told
    assert re.findall(r"\d+ [nµ]m", first) == ["410 nm", "10 µm"]
    assert f"{found.bumps:.3g}" == "1.78"
    for number in ("50 nm", "1.78", "16.8 %"):
        assert number in told
    assert len(done.notes) == done.stderr.count("warning: ") == 2


@pytest.mark.check
def test_a_wafer_does_not_stand_on_a_grain_that_sinks_in():
    assert "1 µm < 0.1 nm < 0.01 % - 0.0656 N" in said(run("plate", "wafer-chuck.toml"))
    grain = ("--set", "plate.grain=0.3 um")
    done = run("plate", "wafer-chuck.toml", *grain)
    (height,) = json.loads(run("plate", "wafer-chuck.toml", *grain, "--json").stdout)["states"][
        "height"
    ]
    assert 0 < height < 1e-10
    told = said(done)
    # what is printed of it: the one place that holds these words
    assert "The plate does not stand on a particle of 300 nm (quartz): a force of" in told
    assert "plate stands 0.3" not in told
    assert "0.1 nm" in done.note("thin plate")


@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_json_and_csv_hold_the_same_numbers(command, kind):
    done = run(command, f"{kind}.toml", "--json", "--csv", "rows.csv")
    data = json.loads(done.stdout)
    with Path("rows.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    name = "force" if command == "probability" else "grain"
    unit = "N" if command == "probability" else "m"
    assert [float(row[f"{name} [{unit}]"]) for row in rows] == data["states"][name]
    assert data["warnings"] == json.loads(run(command, f"{kind}.toml", "--json").stdout)["warnings"]
    assert {"title", "version", "inputs", "what_ifs", "citations"} <= data.keys()


@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_every_line_fits_80_columns(command, kind):
    done = run(command, f"{kind}.toml")
    assert max(map(len, done.stdout.splitlines())) <= 80


@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_neither_roughness_nor_load_is_needed(command, kind):
    data = Path(f"{kind}.toml").read_text("utf-8").split("[roughness]")[0]
    Path("short.toml").write_text(data, "utf-8")
    assert run(command, "short.toml").stdout == run(command, f"{kind}.toml").stdout


def test_the_same_study_is_solved_under_its_own_pressure():
    data = tomllib.loads(Path("connector.toml").read_text("utf-8"))
    del data["load"]
    plug = check(data)
    # Hertz: mean pressure W/(π a²), a³ = 3 W R/(4 E*)
    a = (3 * 0.5 * 2e-3 / (4 * (115e9 / (1 - 0.34**2)) / 2)) ** (1 / 3)
    assert plug.values[0] == pytest.approx(0.5 / (math.pi * a**2), rel=1e-9)
    wafer = check(tomllib.loads(Path("wafer-chuck.toml").read_text("utf-8")))
    assert wafer.values.tolist() == [80e3]
    assert wafer.plate.chuck.limit == 50e-9


def test_several_forces_are_told_at_their_ends():
    told = said(run("probability", "connector.toml", "--set", 'connector.force=["0.2 N", "2 N"]'))
    assert "Under 200 mN" in told or "Under 0.2 N" in told
    assert "Under 2 N" in told


def test_a_bifurcated_contact_fails_less_often():
    one = run_connector(load_connector("connector.toml"))
    two = run_connector(load_connector("connector.toml", ["connector.parallel=2"]))
    assert two.failure_of_all[2] == pytest.approx(20 * one.failure[2] ** 2, rel=1e-3)
    asked = ("connector.toml", "--set", "connector.parallel=2")
    assert "2 spots" in said(run("probability", *asked))
    data = json.loads(run("probability", *asked, "--json").stdout)
    assert data["states"]["failure_of_all"] == two.failure_of_all.tolist()


@pytest.mark.check
def test_a_wipe_of_unknown_effect_is_told_with_both_ends():
    told = said(run("probability", "connector.toml", "--set", "connector.wipe=0.3 mm"))
    assert "connector.pushed_aside" in told
    known = said(
        run("probability", "connector.toml", "--set", "connector.wipe=0.3 mm",
            "--set", "connector.pushed_aside=0.9")
    )  # fmt: skip
    assert "connector.pushed_aside" not in known.partition("(thirdbody")[2]


def test_a_plate_without_a_limit_tells_its_height_alone():
    text = Path("wafer-chuck.toml").read_text("utf-8")
    kept = [line for line in text.splitlines() if not line.startswith("limit")]
    Path("wafer-chuck.toml").write_text("\n".join(kept), "utf-8")
    told = said(run("plate", "wafer-chuck.toml"))
    assert " bumps " not in told
    found = run_plate(load_plate("wafer-chuck.toml"))
    assert found.bumps is None
    # the largest grain, by its size
    (dust,), most = found.asked.chuck.particles, found.what_ifs[0]
    sizes = [part * float(found.grain[found.at]) for part in (0.8, 1.25)]
    heights = [found.asked.chuck.over(size, dust).height for size in sizes]
    assert most.values == pytest.approx(heights, rel=1e-12)
    assert all(part in told for part in (most.what, most.between, most.action))


@pytest.mark.parametrize(
    ("command", "setting", "words"),
    [
        ("probability", "connector.force=2 mm", "connector.force"),
        ("probability", "connector.contacts=2.5", "connector.contacts = 2.5 must be a whole"),
        ("probability", "connector.pushed_aside=3", "connector.pushed_aside"),
        ("probability", "connector.radius=5 um", "come down on dust"),
        ("probability", "connector.wiping=1 mm", "did you mean wipe?"),
        ("probability", 'connector.conducting="gold"', "must name particles"),
        ("probability", "particles.strength=material", "break"),
        ("plate", "plate.thickness=-1 mm", "plate.thickness"),
        ("plate", "plate.pressure=80", "kPa"),
        ("plate", "plate.touching=2", "plate.touching"),
        ("plate", "plate.grains=1 um", "did you mean grain?"),
        ("plate", "particles.iso14644=12", "no class of ISO 14644-1"),
    ],
)
def test_one_clear_message_a_mistake(command, setting, words):
    done = run(command, f"{FILES[command]}.toml", "--set", setting)
    assert done.exit_code == 2
    assert done.stdout == ""
    assert words in " ".join(done.stderr.split())
    assert done.stderr.count("error: ") == 1


@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_a_study_of_another_kind_says_what_is_missing(command, kind):
    other = "wafer-chuck" if kind == "connector" else "connector"
    done = run(command, f"{other}.toml")
    assert done.exit_code == 2
    assert done.stderr.count("error: ") == 1
    assert f"thirdbody new {kind}" in " ".join(done.stderr.split())


def test_without_dust_there_is_nothing_to_ask():
    text = Path("connector.toml").read_text("utf-8")
    data = text[: text.index("[particles]")]
    Path("clean.toml").write_text(data, "utf-8")
    done = run("probability", "clean.toml")
    assert done.exit_code == 2
    assert "particles" in done.stderr
    assert done.stderr.count("error: ") == 1


@pytest.mark.parametrize(
    ("command", "kind", "page"),
    [("probability", "connector", "connector.md"), ("plate", "wafer-chuck", "wafer.md")],
)
def test_the_book_shows_what_is_printed(command, kind, page):
    text = (Path(__file__).parents[2] / "docs" / page).read_text("utf-8")
    shown = text.split("```text\n")[1].split("```")[0]
    printed = [line.rstrip() for line in run(command, f"{kind}.toml").stdout.splitlines()]
    assert shown.splitlines() == printed[2:]


def test_what_solve_prints_as_most_uncertain_stands_first_in_its_json():
    assert run("new", "ball-screw").exit_code == 0
    told = said(run("solve", "ball-screw.toml"))
    data = json.loads(run("solve", "ball-screw.toml", "--json").stdout)
    first, *others = data["what_ifs"]
    assert f"Most uncertain: {first['what']}. With {first['between']}" in told
    assert first["action"] in told
    low, high = sorted(first["values"])
    assert low <= data["states"]["particle_load_share"][0] <= high
    assert high / low >= max(max(each["values"]) / min(each["values"]) for each in others)


@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_film_names_the_command_that_answers_a_study_without_oil(command, kind):
    (problem,) = refused("film", f"{kind}.toml").problems
    assert problem.code is Mistake.MISSING
    assert f"thirdbody {command} " in problem


# ------------------------------------------------------------------------------ figures
def test_the_curve_of_a_connector_goes_through_its_table():
    found = run_connector(load_connector("connector.toml"))
    forces, one, every = found.curve()
    for force, failure, of_all in zip(
        found.force, found.failure, found.failure_of_all, strict=True
    ):
        assert math.log(failure) == pytest.approx(
            np.interp(math.log(force), np.log(forces), np.log(one)), abs=0.03
        )
        assert math.log(of_all) == pytest.approx(
            np.interp(math.log(force), np.log(forces), np.log(every)), abs=0.03
        )


def test_the_curve_of_a_plate_goes_through_its_table():
    found = run_plate(load_plate("wafer-chuck.toml"))
    sizes, kinds = found.curve()
    ((_, heights),) = kinds
    for grain, height in zip(found.grain, found.height, strict=True):
        at = np.interp(math.log(grain), np.log(sizes), np.log(heights))
        assert math.log(height) == pytest.approx(at, abs=0.05)


@pytest.mark.check
def test_kinds_of_one_name_have_a_curve_each():
    asked = load_plate("wafer-chuck.toml")
    (dust,) = asked.chuck.particles
    both = (dust, dust.replace(areal_density=2 * dust.areal_density))
    found = run_plate(replace(asked, chuck=asked.chuck.replace(particles=both)))
    assert [name for name, _ in found.curve()[1]] == ["quartz", "quartz"]
    assert len(found.breaking) == 2
    assert value_of(float(found.height[found.at]), "m", 3) == "410 nm"
    assert "410 nm" in answer(found)[0]


@pytest.mark.check
@pytest.mark.parametrize(("command", "kind"), FILES.items())
def test_a_figure_is_drawn_and_stands_in_the_workbook(command, kind):
    pytest.importorskip("openpyxl")
    study = Path(f"{kind}.toml")
    done = run(command, study, "--figure", "a.png", "--xlsx", "a.xlsx")
    assert done.exit_code == 0, done.stderr
    assert Path("a.png").read_bytes()[:4] == b"\x89PNG"
    with zipfile.ZipFile("a.xlsx") as parts:
        assert [name for name in parts.namelist() if name.endswith(".png")]
    (problem,) = refused(command, study, "--figure", "a.txt", "--csv", "a.csv").problems
    assert problem.code is Mistake.UNWRITABLE
    assert "--figure a.txt" in problem
    assert not Path("a.csv").exists()


@pytest.mark.check
def test_one_speed_of_a_film_is_drawn_with_others_around_it():
    pytest.importorskip("openpyxl")
    assert run("new", "ball-bearing", "6205").exit_code == 0
    done = run("film", "ball-bearing.toml", "--figure", "a.png", "--xlsx", "a.xlsx")
    assert done.exit_code == 0, done.stderr
    assert Path("a.png").read_bytes()[:4] == b"\x89PNG"
    with zipfile.ZipFile("a.xlsx") as parts:
        assert [name for name in parts.namelist() if name.endswith(".png")]
    study = load_study("ball-bearing.toml")
    alone = run_film(study).states
    curve, at = run_film_curve(study)
    assert curve.states["h_T"][at] == pytest.approx(alone["h_T"][0], rel=1e-9)
