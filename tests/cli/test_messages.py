"""Messages of the command line: in words of the study file, as wide as the terminal."""

import copy
import json
import pickle
import re
from pathlib import Path

import pytest

import thirdbody as tb
from thirdbody.cli.streams import warn
from thirdbody.equilibrium.words import NO_MODE
from thirdbody.errors import (
    Advice,
    InvalidValue,
    Note,
    Problem,
    RangeWarning,
    in_study,
    note_of,
)
from thirdbody.explicit.seats import SEATS

from .test_cli import DUSTY, run

STUDIES = Path(tb.__file__).parent / "data" / "studies"
CALL = re.compile(r"\w\(\.\.\.|\.replace\(|\b[A-Z][A-Za-z]+\([a-z_]*=?|\b(particle|outputs)\.[A-Z]")
"""A call or a class of Python."""
BARE = [
    "--set", 'surfaces.first={E="205 GPa", nu=0.29, H="5 GPa"}',
    "--set", 'surfaces.second={E="205 GPa", nu=0.29, H="5 GPa"}',
    "--set", 'particles.material={E="70 GPa", nu=0.17, H="9 GPa"}',
]  # fmt: skip
"""Bodies of which no more is known."""


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        (
            "outputs.electrical_conductance={}",
            "surfaces.first = { E = ..., nu = ..., H = ..., resi",
        ),
        ("outputs.thermal_conductance={}", "thermal_conductivity of the particles: particles.mat"),
        ("outputs.flash_temperature={v=1, A_n=1e-6}", "density of surface 2: surfaces.second = {"),
        ("outputs.crushing={}", 'strength = "material" in [particles]'),
        ('particles.strength="material"', "particles.strength"),
        ('particle_law={name="series", law="coated"}', ""),
    ],
)
def test_advice_is_in_the_words_of_the_study_file(setting, said):
    done = run("solve", DUSTY, *BARE, "--set", setting)
    assert done.exit_code == 2, done.output
    assert said in done.stderr
    assert not CALL.search(done.stderr), done.stderr


def test_advice_keeps_both_wordings_wherever_it_goes():
    """In sentences, mistakes, notes, warnings, and in what another process is sent."""
    head, tail = "use ", ", or remove law"
    said = head + Advice("Hermite()", '"hermite"') + tail
    assert (said, in_study(said)) == (f"{head}Hermite(){tail}", f'{head}"hermite"{tail}')
    assert in_study("plain") == "plain"
    for made, start in (
        (Problem("law", said, "'zmc'", owner="Series"), "Series.law = 'zmc' "),
        (Problem("law", "is not one", hint=said), "law is not one; "),
        (Problem("", said).move_under("particles"), "particles: "),
        (InvalidValue(said).problems[0], ""),
        (Note("A_t reaches 0.3", action=said), "A_t reaches 0.3; "),
        (Note("A_t reaches 0.3: " + said, effect=0.1), "A_t reaches 0.3: "),
    ):
        for each in (made, pickle.loads(pickle.dumps(made)), copy.copy(made)):
            assert str(each) == start + said
            assert in_study(each) == start + in_study(said)


@pytest.mark.parametrize("width", [40, 80, 132])
def test_errors_and_warnings_are_as_wide_as_the_terminal(monkeypatch, capsys, width):
    monkeypatch.setenv("COLUMNS", str(width))
    sentence = "the load of the particles is on those that are squeezed by more than a half " * 3
    warn(sentence)
    lines = capsys.readouterr().err.splitlines()
    assert max(map(len, lines)) <= width
    assert len(lines) > 1
    assert " ".join(line.strip() for line in lines) == f"warning: {sentence.strip()}"
    done = run("solve", DUSTY, "--set", "roughness.sigma=300 GPa", "--set", "particles.std=1 kg")
    lines = done.stderr.splitlines()
    assert max(map(len, lines)) <= width
    assert done.stderr.count("error: ") == 2


def test_a_pipe_has_a_line_a_message(monkeypatch, capsys):
    monkeypatch.delenv("COLUMNS", raising=False)
    warn("word " * 100)
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_one_way_of_writing_stresses():
    done = run("solve", DUSTY, "--set", "load.pressure=1.87e9")
    assert "1.87 GPa" in done.stderr + done.stdout
    assert not re.search(r"\d(e[+-]?\d+)? Pa\b", done.stderr), done.stderr


EXAMPLES = Path(__file__).parents[2] / "examples"
RARE = """[surfaces]
first = "CuSn8"
second = "CuSn8"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[particles]
material = "SiO2"
distribution = "monodisperse"
mean = "2 um"
areal_density = "1e8 / m^2"
[body]
kind = "flat"
area = "100 um^2"
[load]
force = "10 uN"
"""


def test_a_note_that_is_printed_keeps_its_words_for_studies():
    note = Note("A_t reaches 0.3", action=Advice("field=Field()", 'name = "field"'))
    assert in_study(note_of(note)) == in_study(note_of(RangeWarning(note))) == note.study
    assert note.study != str(note)


def test_a_contact_of_which_most_meet_no_particle_is_not_said_to_rest_on_particles(tmp_path):
    """Mode of a wide surface: it stays in the data, and words do not claim it of the contact."""
    study = tmp_path / "rare.toml"
    study.write_text(RARE)
    data = json.loads(run("solve", study, "--json").stdout)
    assert data["states"]["mode"] == ["p-s"]
    assert data["body"]["forces"][0]["particles_held"] == pytest.approx(0.01)
    words = " ".join(run("solve", study).stdout.split())
    first = words.split("F* pressure")[0]
    # what is printed of it: the one place that holds these words
    assert "one contact in 100 meets a particle, and the others are as without particles" in first
    assert "p-s" not in first
    rows = run("solve", study).stdout.splitlines()
    (row,) = (line for line in rows if "100 kPa" in line and line.endswith(" rare "))
    assert row.split()[-1] == "rare"
    many = run("solve", study, "--set", "particles.areal_density=3e10").stdout
    assert "rare" not in many
    assert "real contact is on particles" in " ".join(many.split())


@pytest.mark.check
def test_a_film_whose_bodies_hold_no_particle_mostly_is_not_said_to_rest_on_particles():
    """Of a study with [film] the contact is that of the film's bodies, whatever the load."""
    study = EXAMPLES / "oil_film.toml"
    few = ("--set", "particles.areal_density=1e7/m^2", "--set", "load.pressure=1 Pa")
    data = json.loads(run("solve", study, *few, "--json").stdout)
    assert data["states"]["mode"] == ["p-s"]
    assert 0 < data["particles_held"] < 1
    film = json.loads(run("film", study, *few, "--json").stdout)
    assert data["particles_held"] == film["particles_held"]
    words = " ".join(run("solve", study, *few).stdout.split())
    assert " rare: " in words
    many = (*few, "--set", "particles.areal_density=1e11/m^2")
    assert " rare: " not in " ".join(run("solve", study, *many).stdout.split())


@pytest.mark.parametrize(
    ("setting", "hint"),
    [
        ("load.force=-1 kN", "leave out the minus sign"),
        ("load.force=0 kN", "it is the force on the bodies of [body]"),
        ("body.bore=-25 mm", "leave out the minus sign"),
        ("body.bore=0", "it is the bore of the bearing"),
        ("body.balls=-9", "leave out the minus sign"),
        ("body.balls=0", "it is the number of balls"),
        ("body.shaft_speed=-3000 rpm", "leave out the minus sign"),
        ("body.shaft_speed=0 rpm", "it is the speed of the shaft"),
        ("film.speed=-1 m/s", "leave out the minus sign"),
        ("film.oil.eta=1e6", "40 mPa s are 0.04"),
        ("load.force=nan", "it must be > 0 [N]"),
    ],
)
def test_hints_fit_the_sign_of_a_number(tmp_path, setting, hint):
    file = tmp_path / "b.toml"
    assert run("new", "ball-bearing", "--out", file).exit_code == 0
    done = run("film", file, "--set", setting)
    assert done.exit_code == 2
    (line,) = [each for each in done.stderr.splitlines() if each.startswith("error: ")]
    assert line.endswith(f"; {hint}")


# ---------------------------------------------------------------- one form, and nothing left out
@pytest.mark.parametrize(
    "arguments", [("--foo",), ("slove",), ("solve",), ("solve", "--foo"), ("film", "none.toml")]
)
def test_every_error_begins_alike(arguments):
    done = run(*arguments)
    assert done.exit_code == 2
    heads = {line.partition(":")[0] for line in done.stderr.splitlines()}
    assert "error" in heads
    assert "Error" not in heads


def test_the_help_of_explicit_names_every_seat():
    shown = run("explicit", "--help").stdout.split("--seats")[1].split("--maps")[0]
    assert set(SEATS) <= set(re.findall(r"\w+", shown))


def test_what_no_mode_means_stands_under_the_table_that_has_none(tmp_path):
    settings = ("--set", 'load.separation=["200 nm", "5 um"]')
    assert NO_MODE in " ".join(run("solve", DUSTY, *settings).stdout.split())
    settings = ("--set", 'load.separation=["200 nm", "100 nm"]')
    assert NO_MODE not in " ".join(run("solve", DUSTY, *settings).stdout.split())


def test_assess_says_before_the_work_that_it_leaves_the_film_out(monkeypatch):
    def refuse(*_: object, **__: object):
        raise tb.errors.InvalidValue("enough")

    monkeypatch.setattr("thirdbody.study.analyses.assess_study", refuse)
    assert "film.left_out" in run("assess", STUDIES / "gear.toml").codes
    assert "film.left_out" not in run("assess", STUDIES / "two-body.toml").codes
