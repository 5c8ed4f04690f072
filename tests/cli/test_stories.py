"""What an engineer types in an empty folder, from the drawing to the number."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from thirdbody import cli, load_study
from thirdbody.quantities.say import number, value_of

ROOT = Path(__file__).parents[2]


def here(*arguments):
    done = CliRunner().invoke(cli.app, arguments)
    assert done.exit_code == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def wheel(tmp_path_factory):
    """A folder that the wheel is installed in, and nothing else."""
    folder = tmp_path_factory.mktemp("wheel")
    left_out = shutil.ignore_patterns(".*", "build", "*.egg-info", "__pycache__", "tests", "docs")
    shutil.copytree(ROOT, folder / "source", ignore=left_out)
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    subprocess.run(
        [*pip, "install", "--no-deps", "--target", str(folder / "site"), str(folder / "source")],
        check=True,
    )
    shutil.rmtree(folder / "source")
    site = folder / "site"
    found = [sys.executable, "-c", "import thirdbody; print(thirdbody.__file__)"]
    told = os.environ | {"PYTHONPATH": str(site)}
    found = subprocess.run(found, env=told, capture_output=True, text=True, check=True)
    assert Path(found.stdout.strip()).is_relative_to(site)
    return site


def installed(site):
    """The command of the wheel, in a process of its own."""
    told = os.environ | {"PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1"}

    def call(*arguments):
        command = [sys.executable, str(site / "bin" / "thirdbody"), *arguments]
        done = subprocess.run(command, env=told, capture_output=True, text=True, encoding="utf-8")
        assert done.returncode == 0, done.stderr
        return done.stdout

    return call


@pytest.fixture(params=["here", pytest.param("installed", marks=pytest.mark.check)])
def run(request, tmp_path, monkeypatch):
    """``thirdbody ...`` in an empty folder, at 80 columns; answers with standard output."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    return here if request.param == "here" else installed(request.getfixturevalue("wheel"))


# what these ask of the wheel, other stories ask of it too
in_this_process = pytest.mark.parametrize("run", ["here"], indirect=True)


@pytest.fixture
def solved(run):
    def call(file, *settings):
        sets = [word for each in settings for word in ("--set", each)]
        return json.loads(run("solve", file, "--json", *sets))

    return call


@in_this_process
def test_a_ball_screw_nut_from_ra_newtons_and_cleanliness(run, solved):
    run("new", "ball-screw")
    usual = solved("ball-screw.toml")
    (force,) = usual["body"]["forces"]
    assert force["force"] == 2000
    assert 0.1e9 < force["mean"] < force["maximum"] < force["yields"]
    told = " ".join(usual["warnings"])
    assert "Gaussian heights, Rq = 1.2533 Ra" in told
    assert "from memory" in told
    heavier = solved("ball-screw.toml", "load.force=4 kN")["body"]["forces"][0]
    assert heavier["maximum"] == pytest.approx(force["maximum"] * 2 ** (1 / 3), rel=1e-12)
    dirty = solved("ball-screw.toml", 'particles.iso4406="21/19/16"')["body"]["forces"][0]
    assert dirty["particle_load_share"] == pytest.approx(8 * force["particle_load_share"], rel=0.1)
    shown = run("solve", "ball-screw.toml")
    assert (value_of(force["heaviest"], "N"), force["bodies"]) == ("47.29 N", 60)
    (sentence,) = usual["body"]["sentences"]
    assert re.findall(r"[\d.]+ N", sentence) == ["2000 N", "47.29 N"]
    assert sentence in " ".join(shown.split())


@in_this_process
def test_an_additive_by_size_and_weight_per_cent(run, solved):
    run("new", "additive")
    usual, more = (
        solved("additive.toml", f'particles.concentration="{c} wt%"', "load.pressure=1 MPa")
        for c in (0.1, 0.2)
    )
    numbers = [each["inputs"]["particles"]["areal_density"] for each in (usual, more)]
    assert numbers[1] == pytest.approx(2 * numbers[0], rel=2e-3)
    shares = [each["states"]["particle_load_share"][0] for each in (usual, more)]
    assert shares[0] < shares[1]
    larger = solved("additive.toml", 'particles.median="200 nm"', "load.pressure=1 MPa")
    assert larger["inputs"]["particles"]["diameter"]["median"] == 200e-9


def test_the_contact_of_the_paper_with_a_material_of_ones_own(run, solved):
    Path("mine.toml").write_text(
        '[our-oxide]\nE = "150 GPa"\nnu = 0.25\nH = "12 GPa"\nsource = "our laboratory"\n', "utf-8"
    )
    run("new", "two-body", "--out", "figure.toml")
    text = Path("figure.toml").read_text("utf-8")
    text = (
        'materials = "mine.toml"\n'
        + text.split("[load]")[0]
        + """
[particles]
material = "our-oxide"
distribution = "truncated-gaussian"
mean = "300 nm"
std  = "24 nm"
areal_density = "1e11 / m^2"
[particle_law]
name = "horng2022"
[load]
F_star = { from = 5e-7, to = 2.4e-4, points = 7 }
"""
    )
    Path("figure.toml").write_text(text, "utf-8")
    found = solved("figure.toml")
    assert found["inputs"]["particles"]["material"]["H"] == 12e9
    assert set(found["states"]["status"]) == {"ok"}
    silica = solved("figure.toml", 'particles.material="SiO2"')
    assert silica["states"]["A_sa"] != found["states"]["A_sa"]


def test_the_text_of_the_package_index():
    """It stands alone: no link into the source, and its example is that of the README."""
    name = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["readme"]
    text = (ROOT / name).read_text("utf-8")
    assert re.findall(r"\]\((?!https?://)", text) == []
    assert "<img" not in text
    (example,) = re.findall(r"^```python\n(.*?)^```$", text, re.S | re.M)
    assert example in (ROOT / "README.md").read_text("utf-8")


@in_this_process
def test_how_often_does_this_connector_fail_to_close(run):
    assert run("new", "connector").strip() == "thirdbody probability connector.toml"
    often = json.loads(run("probability", "connector.toml", "--json"))["states"]
    (at,) = (i for i, force in enumerate(often["force"]) if force == 0.5)
    assert 1 / often["failure_of_all"][at] == pytest.approx(211, abs=0.5)
    harder = run("probability", "connector.toml", "--set", "connector.force=2 N", "--json")
    often = json.loads(harder)["states"]
    assert often["force"][2] == 2.0
    assert often["failure_of_all"][2] < 1e-4


@in_this_process
def test_how_high_does_a_wafer_stand_over_a_grain(run):
    assert run("new", "wafer-chuck").strip() == "thirdbody plate wafer-chuck.toml"
    usual = json.loads(run("plate", "wafer-chuck.toml", "--json"))
    assert usual["bumps"] == pytest.approx(1.78, abs=5e-3)
    pins = json.loads(run("plate", "wafer-chuck.toml", "--json", "--set", "plate.touching=0.02"))
    assert pins["bumps"] == pytest.approx(0.02 * 1.78, rel=0.01)


def first_sentences(shown):
    """What stands above the first table, without the title."""
    _, *lines = shown.split(" \n     ")[0].splitlines()
    return " ".join(" ".join(lines).split())


@in_this_process
@pytest.mark.check
def test_dust_or_steel_in_my_bearing_and_would_a_finer_filter_help(run):
    """Three commands; which carries, which dents, how deep, what life loses, what a filter does."""
    assert run("new", "ball-bearing", "6205").strip() == "thirdbody film ball-bearing.toml"
    shown = run("film", "ball-bearing.toml")
    told = first_sentences(shown)
    dust = re.search(r"Dust dents the inner ring deepest: (\d+) dents an hour, (\d+) nm deep", told)
    steel = re.search(r"steel debris dents it most often: (\d+) dents an hour, (\d+) nm deep", told)
    assert int(dust[1]) < int(steel[1])
    assert int(dust[2]) > int(steel[2])
    assert re.search(r"The film of 288 nm carries 99.999 % of the load at 2.9 m/s", told)
    whole = " ".join(shown.split())
    assert whole.count("No particle is narrower than the gap of 288.3 nm") == 1
    data = json.loads(run("film", "ball-bearing.toml", "--json"))
    study = load_study("ball-bearing.toml")
    loads = study.body.share_load(study.forces[0], study.contact.E_ss)
    assert number(loads.balance, 4) == "1.004"
    assert " 1.004 " in whole
    assert "e_C = 0.073, and the life factor a_ISO is 1.6 (50 in clean oil)" in told
    most = (
        r"Most uncertain: the hardness of dust\. With 10 GPa and 14\.4 GPa, one in twenty dents of "
    )
    assert re.search(most + r"the deepest kind is beyond \d+ nm to [\d.]+ µm;", whole)
    for_life = max(data["what_ifs"], key=lambda each: max(each["a_ISO"]) / min(each["a_ISO"]))
    assert for_life["code"] == "number"
    assert all(
        each in whole for each in (for_life["what"], for_life["between"], for_life["action"])
    )
    told = first_sentences(run("film", "ball-bearing.toml", "--filter", "5=75, 10=1000"))
    assert told.startswith(
        "In one pass the filter takes the dents from 28000 to 850 an hour, 33 times fewer, the oil "
        "from 18/16/13 to 13/9/3, and a_ISO from 1.6 to 50, 31 times the life; "
    )


def test_the_connector_and_the_wafer_answer_on_the_first_two_lines(run):
    """Four commands."""
    run("new", "connector")
    told = first_sentences(run("probability", "connector.toml"))
    assert told.startswith("Under 0.5 N the connector fails to close once in 211 closings")
    run("new", "wafer-chuck")
    told = first_sentences(run("plate", "wafer-chuck.toml"))
    assert told.startswith("The plate stands at most 410 nm high over a particle of 10 µm (quartz)")


NOTEBOOK = """
import subprocess, sys, warnings
warnings.simplefilter("ignore")
import pint
from uncertainties import ufloat
import thirdbody as tb
from thirdbody.study import load_study, run_film, run_study

found = run_study(load_study("ball-screw.toml"))
print(f"force     {found.forces[0].particle_load_share:.3g}")
study = load_study("two-body.toml")
contact, u = study.contact, pint.UnitRegistry()
state = tb.solve(contact, pressure=5 * u.MPa)
print(f"pint      {state.A_t:.4g}")
sigma = ufloat(100e-9, 5e-9)
bands = tb.propagate(contact, vary={"roughness.sigma": sigma}, pressure=5e6, outputs=["h"])
slopes = tb.sensitivity(contact, of="h", to="roughness.sigma", pressure=5e6)
h = slopes.ufloats({"roughness.sigma": sigma})["h"]
print(f"ufloat    {bands.ufloat('h'):.2uP} {h:.2uP}")
curves = tb.sweep(contact, F_star=[1e-5, 1e-4], vary={"roughness.sigma": [50e-9, 100e-9]})
print(f"xarray    {dict(curves.sizes)}")
print(f"pandas    {curves.to_dataframe().shape[0]} rows")
surface = tb.surfaces.self_affine(
    sigma=100e-9, hurst=0.8, shortest=8e-7, longest=3e-6, spacing=1e-7, points=64
)
pressed = tb.explicit.solve(contact, surface, F_star=1e-3, blocks=4)
print(f"map       {pressed.A_t:.3g} +- {pressed.errors['A_t']:.1g}")
"""


@pytest.mark.check
def test_research_has_everything_in_a_notebook(wheel, tmp_path, monkeypatch):
    """One cell from the installed wheel: a force, units, uncertain numbers, tables, one map."""
    for package in ("pint", "uncertainties", "xarray"):
        pytest.importorskip(package)
    monkeypatch.chdir(tmp_path)
    command = installed(wheel)
    for kind in ("ball-screw", "two-body"):
        command("new", kind)
    told = os.environ | {"PYTHONPATH": str(wheel), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", NOTEBOOK], env=told, capture_output=True, text=True, encoding="utf-8"
    )
    assert done.returncode == 0, done.stderr
    said = dict(line.split(None, 1) for line in done.stdout.splitlines())
    (force,) = json.loads(command("solve", "ball-screw.toml", "--json"))["body"]["forces"]
    assert float(said["force"]) == pytest.approx(force["particle_load_share"], rel=5e-3)
    state = json.loads(command("solve", "two-body.toml", "--json", "--set", "load.pressure=5 MPa"))
    assert float(said["pint"]) == pytest.approx(state["states"]["A_t"][0], rel=5e-4)
    samples, by_slopes = re.findall(r"\((\S+)±(\S+)\)", said["ufloat"])
    assert float(samples[0]) == pytest.approx(float(by_slopes[0]), rel=0.01)
    assert float(samples[1]) == pytest.approx(float(by_slopes[1]), rel=0.1)
    assert said["pandas"] == "4 rows"
    area, error = map(float, said["map"].split(" +- "))
    assert 0 < error < area
