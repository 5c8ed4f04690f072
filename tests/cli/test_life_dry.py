"""``thirdbody life`` of a dry contact: particles and wear over time from the shell."""

import csv
import functools
import json
import os
import subprocess
import sys
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import refused

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.study.run_life import load_life, run_life
from thirdbody.systems.life.debris import Debris
from thirdbody.views.html import words as words_in_html
from thirdbody.views.life_amounts import duration_of
from thirdbody.views.life_dry_words import answer
from thirdbody.views.report.tables import life_section

from .life_shell import HOUR, enter, run, said

SHORT = ("--set", 'life.duration="1 h"')


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    enter(tmp_path, monkeypatch)
    assert run("new", "dry-contact").stdout == "thirdbody life dry-contact.toml\n"
    return tmp_path


@pytest.fixture(scope="module")
def first_hour():
    """What Python finds of the file, computed when a test first asks for it."""
    return functools.cache(lambda: run_life(load_life("dry-contact.toml", [SHORT[1]])))


@pytest.fixture
def hour(first_hour, monkeypatch):
    """The first hour, which commands print as it is instead of computing it again."""
    found = first_hour()

    def run_same(asked, **_):
        assert (asked.duration, asked.title) == (found.asked.duration, found.asked.title)
        return found

    monkeypatch.setattr("thirdbody.study.run_life.run_life", run_same)
    return found


@pytest.mark.check
def test_a_study_says_what_python_says(hour):
    """The file of the template by hand."""
    found = hour
    steel, quartz = tb.materials["S45C"], tb.materials["quartz"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=quartz, diameter=tb.LogNormal(median=2e-6, gsd=1.5), areal_density=1e8
        ),
        outputs=(
            tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),
            tb.outputs.Wear(K_ss=1e-6, K_sa=0, f_ab=0.1, f_roll=0.001),
        ),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        own = tb.life(
            contact, pressure=1e6, sliding_speed=0.1, length=0.01, area=1e-4, loss=0.3, moving=1,
            worn_area=(2e-3, 1e-4), debris=Debris.boundary_lubricated(hardness=9e9),
            arrivals=tb.oil.Ingress.of_dust("A3-lot", rate="1 mg/h", material=quartz), duration=HOUR,
        )  # fmt: skip
    np.testing.assert_allclose(found.history.numbers, own.numbers, rtol=1e-6, atol=1e-3)
    assert found.history.R0 == pytest.approx(own.R0, rel=1e-9)
    # in a steady state as much leaves as comes
    (steady,) = found.history.steady()
    flows = {(a, b): kg for a, b, kg in found.history.flows()}
    left = flows["contact", "left"]
    come = sum(kg for (_, to), kg in flows.items() if to == "contact")
    assert left == pytest.approx(come, rel=1e-2)
    assert steady.numbers.sum() == pytest.approx(own.numbers[-1].sum(), rel=1e-4)


@pytest.mark.check
def test_the_answer_is_two_sentences_and_fits_80_columns(hour):
    done = run("life", "dry-contact.toml", *SHORT)
    told = said(done)
    found = hour
    first, second = (" ".join(sentence.split()) for sentence in answer(found))
    head = f"{found.title}, with life.duration = 1 h (thirdbody {tb.__version__})"
    assert told.startswith(f"{head} {first} {second} time")
    assert found.history.reproduction in first
    assert "After 60 min wear has taken surface 1 by" in second
    scales = found.history.time_scales
    assert scales["residence of what rolls"] == pytest.approx(0.2)  # twice 10 mm by 0.1 m/s
    for name, time in scales.items():
        assert f"{name} {duration_of(time)}" in told
    assert max(map(len, done.stdout.splitlines())) <= 80


@pytest.mark.check
def test_particles_and_those_with_load_stand_on_one_basis(hour):
    """Both per mm²: no more bear load than are there; the JSON holds those of the whole contact."""
    done = run("life", "dry-contact.toml", *SHORT, "--json")
    data = json.loads(done.stdout)
    rows = run("life", "dry-contact.toml", *SHORT).stdout.split("─── \n")[1].splitlines()
    last = next(each for each in rows if each.startswith("   60 min"))
    there, loaded = (float(each.replace("×10⁴", "e4")) for each in last.split()[2:4])
    assert loaded <= there
    assert loaded == pytest.approx(data["more"]["present"][-1] / 100, rel=0.01)  # 1 cm² in mm²
    assert there == pytest.approx(np.sum(data["numbers"][-1]) / 1e6, rel=0.01)


@pytest.mark.check
def test_nothing_leaves_where_all_comes_round_again():
    keys = ("--set", "life.dry.loss=0", "--set", 'life.duration="2 s"')
    history = json.loads(run("life", "dry-contact.toml", *keys, "--json").stdout)
    assert history["steady"] == []
    assert not any(row["to"] == "left" and row["kg"] > 0 for row in history["flows"])
    assert "life.dry.loss = 0" in said(run("life", "dry-contact.toml", *keys))


@pytest.mark.check
def test_json_csv_and_workbook_hold_the_same_numbers(hour):
    openpyxl = pytest.importorskip("openpyxl", reason="needs the extra thirdbody[xlsx]")
    done = run("life", "dry-contact.toml", *SHORT, "--json", "--csv", "a.csv", "--xlsx", "a.xlsx")
    data = json.loads(done.stdout)
    with Path("a.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time [s]"]) for row in rows] == data["times"]
    assert [float(row["wear_2 [m]"]) for row in rows] == data["more"]["wear_2"]
    total = np.sum(data["numbers"], axis=(1, 2))
    assert [float(row["eta [1/m^2]"]) for row in rows] == pytest.approx(total.tolist(), rel=1e-12)
    assert data["ledger"]["residual"] < 1e-9
    assert data["steady"][0]["stable"] is True
    book = openpyxl.load_workbook("a.xlsx")
    inputs = [row[5] for row in book["Inputs"].iter_rows(values_only=True)]
    assert {"life.dry.loss", "load.pressure", "outputs.wear.f_ab"} <= set(inputs)


def test_an_event_ends_the_history():
    keys = (*SHORT, "--set", 'life.until.wear_depth="1 um"')
    data = json.loads(run("life", "dry-contact.toml", *keys, "--json").stdout)
    (event,) = data["events"]
    assert (event["name"], event["time"]) == ("wear depth", data["times"][-1])
    assert max(data["more"][f"wear_{side}"][-1] for side in (1, 2)) == pytest.approx(1e-6)


@pytest.mark.slow
def test_what_never_leaves_is_told():
    """A soft second surface holds the grains, and the first one alone moves."""
    keys = ("--set", 'surfaces.second="CuSn8"', "--set", 'life.duration="1 s"')
    data = json.loads(run("life", "dry-contact.toml", *keys, "--json").stdout)
    assert data["steady"] == []
    assert "left" in {row["to"] for row in data["flows"] if row["kg"] > 0}


@pytest.mark.check
def test_the_figure_is_drawn():
    done = run("life", "dry-contact.toml", "--set", 'life.duration="20 s"', "--figure", "a.png")
    assert done.exit_code == 0, done.stderr
    assert Path("a.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.check
def test_the_report_has_a_part_on_the_contact():
    found = run_life(load_life("dry-contact.toml", ['life.duration="20 s"']))
    (part,) = life_section(SimpleNamespace(life=found))
    assert words_in_html(answer(found)[0]) in part
    assert "<figcaption>" in part


MISTAKES = [
    ("life.dry.loss=2", Mistake.RANGE, "life.dry.loss"),
    ('life.dry.moving="third"', Mistake.OPTION, "life.dry.moving"),
    ('life.dry.worn_area="1 cm^2"', Mistake.SHAPE, "life.dry.worn_area"),
    ('life.dry.arrivals={ iso4406 = "18/16/13" }', Mistake.MISSING, "life.dry.arrivals"),
    ('life.until.iso4406="18/16/13"', Mistake.CLASH, "life.until"),
    ('load.pressure=["1 MPa", "2 MPa"]', Mistake.SHAPE, "load.pressure"),
    ('life.filters=[{ flow = "1 L/min", beta = { "4 um" = 2 } }]', Mistake.CLASH, "life.filters"),
    (
        "life.uncertainty={ ingress = { low = 1, high = 2 } }",
        Mistake.UNKNOWN,
        'life.uncertainty."ingress"',
    ),
    ('life.dry.speed="1 m/s"', Mistake.UNKNOWN, "life.dry.speed"),
]


@pytest.mark.parametrize(("key", "code", "place"), MISTAKES)
def test_mistakes_get_one_sentence_and_nothing_is_written(key, code, place):
    before = sorted(Path().iterdir())
    files = ("--csv", "a.csv", "--figure", "a.png")
    assert (code, place) in refused("life", "dry-contact.toml", "--set", key, *files).mistakes
    assert sorted(Path().iterdir()) == before


@pytest.mark.parametrize("key", ["loss", "arrivals", "moving", "area   =", "length"])
def test_what_nobody_can_predict_has_no_default(key):
    text = Path("dry-contact.toml").read_text("utf-8")
    line = next(each for each in text.splitlines() if each.startswith(key))
    Path("less.toml").write_text(text.replace(line + "\n", ""), "utf-8")
    missing = (Mistake.MISSING, f"life.dry.{key.rstrip(' =')}")
    assert refused("life", "less.toml").mistakes == [missing]


def test_options_of_an_oil_are_refused():
    Path("oil.csv").write_text("time [h],ISO 4406\n0,20/18/15\n250,16/13/10\n")
    for option in (["--reports", "oil.csv"], ["--flow-for", "16/14/11"]):
        done = run("life", "dry-contact.toml", *option)
        assert done.exit_code == 2
        assert "[life.dry]" in done.stderr or "life.dry" in done.stderr


@pytest.mark.check
def test_an_oil_has_a_workbook_too():
    pytest.importorskip("openpyxl", reason="needs the extra thirdbody[xlsx]")
    run("new", "oil-circuit")
    done = run("life", "oil-circuit.toml", "--xlsx", "oil.xlsx")
    assert done.exit_code == 0, done.exception
    assert Path("oil.xlsx").is_file()


# ------------------------------------------------------------------------------ threads
def test_one_thread_does_the_algebra_unless_the_user_says_another(monkeypatch):
    """The command line says it before NumPy loads; what the user says stays."""
    from thirdbody.cli import THREADS, share_no_matrix

    for name in THREADS:
        monkeypatch.setenv(name, "1")  # so that it comes back as it was
        monkeypatch.delenv(name)
    share_no_matrix()
    assert [os.environ.get(name) for name in THREADS] == [None, "1", "1"]
    for name in THREADS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    share_no_matrix()
    assert [os.environ.get(name) for name in THREADS] == ["3", None, None]


def test_numpy_loads_after_the_command_line():
    code = "import sys, thirdbody.cli; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
