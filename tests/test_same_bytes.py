"""The same input gives the same bytes in every process, whatever the seed of its hashes."""

import hashlib
import importlib.util
import itertools
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from thirdbody.numerics.sampling import sobol

pytestmark = pytest.mark.check
FOLDER = Path(__file__).parents[1] / "examples"
EXAMPLES = sorted(path.stem for path in FOLDER.glob("*.toml"))
SEEDS = (0, 3, 7)

# four sampled inputs: 24 orders
SAMPLED = (
    (FOLDER / "dusty_ball_screw.toml").read_text("utf-8").partition("[load]")[0]
    + """
[sweep]
design = "latin"
samples = 8
seed = 3
pressure = ["1 MPa", "10 MPa"]
[sweep.vary]
particles.areal_density = { from = "3e10 / m^2", to = "3e11 / m^2", spacing = "log" }
particles.mean = { from = "200 nm", to = "300 nm", spacing = "linear" }
roughness.R = { from = "2 um", to = "4 um", spacing = "linear" }
surfaces.second.H = { from = "4 GPa", to = "6 GPa", spacing = "linear" }
"""
)
# several mistakes of several keys, told in one order
WRONG = """
[surfaces]
first = "S45C"
second = "S45C"
third = "S45C"
[roughness]
sigma = "100 nm"
R = -1
colour = "blue"
ellipticity = { ratios = [1, 2], first = 2, second = 3, angle = 0, R_first = 1e-6, R_second = 1e-6 }
[sweep]
F_star = [1e-5]
[sweep.vary]
roughness.Q = [1]
roughness.sigma = ["1 GPa"]
"""

SEARCH = ["thirdbody.analysis.design.design", "thirdbody.analysis.design.search"]
"""Modules of the search of designs, a short one of which goes the way of a long one."""
SCRIPT = """
import importlib, json, sys
from typer.testing import CliRunner
from thirdbody import cli
design, search = map(importlib.import_module, json.loads(sys.argv[1]))
search.STARTS, search.STEPS, design.GRID = 2, 5, 8
for words in json.load(sys.stdin):
    done = CliRunner().invoke(cli.app, words, env={"COLUMNS": "100"})
    assert done.exit_code in (0, 2), (words, done.stderr, done.exception)
    wrong = [line for line in done.stderr.splitlines() if line.startswith(("error:", "warning:"))]
    print(json.dumps([words, done.exit_code, done.stdout, wrong]))
"""


def contents(folder):
    """Every file by its bytes; the lock of a sweep names its process."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in ("lock", "sampled.toml", "wrong.toml")
    }


def answers(tmp_path, commands, seeds=SEEDS):
    """What the commands print and write, under each seed; one process a seed, at once."""
    running = {}
    for seed in seeds:
        folder = tmp_path / str(seed)
        folder.mkdir()
        (folder / "sampled.toml").write_text(SAMPLED, "utf-8")
        (folder / "wrong.toml").write_text(WRONG, "utf-8")
        running[seed] = subprocess.Popen(
            [sys.executable, "-c", SCRIPT, json.dumps(SEARCH)],
            cwd=folder,
            env=os.environ | {"PYTHONHASHSEED": str(seed), "MPLBACKEND": "Agg"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert running[seed].stdin is not None
        running[seed].stdin.write(json.dumps(commands))
        running[seed].stdin.close()
        running[seed].stdin = None
    out = {}
    for seed, process in running.items():
        said, wrong = process.communicate()
        assert process.returncode == 0, wrong
        out[seed] = [json.loads(line) for line in said.splitlines()], contents(tmp_path / str(seed))
    return out


def study(name):
    return str(FOLDER / f"{name}.toml")


FEW = ["--set", 'load.pressure=["1 MPa", "10 MPa"]']
COMMANDS = [
    ["solve", study("dusty_ball_screw"), *FEW],
    ["solve", study("dust_and_debris"), "--json", *FEW],
    ["solve", study("dust_and_debris"), "--csv", "states.csv", *FEW],
    ["film", study("oil_film"), "--json", "--csv", "film.csv"],
    ["compare", study("two_body_reference"), "--laws", "gw,ke"],
    ["table", study("dusty_ball_screw"), "--out", "table.csv", "--tolerance", "1e-3"],
    ["surface", "example", "--json"],
    ["laws"],
    ["laws", "--markdown"],
    ["outputs"],
    ["materials"],
    ["schema"],
]
CHUNKS = ["--set", "sweep.chunk=3"]
REDUCED = ["--set", "sweep.reduce={ quantiles = [0.5], mean = true }"]
SWEEPS = [
    ["sweep", "sampled.toml", "--out", "latin", *CHUNKS],
    ["sweep", "sampled.toml", "--out", "sobol", "--set", "sweep.design=sobol", *CHUNKS],
    ["sweep", "sampled.toml", "--out", "netcdf", "--format", "netcdf", *CHUNKS],
    ["sweep", "sampled.toml", "--out", "reduced", *REDUCED],
]
MISTAKES = [
    ["solve", "wrong.toml"],
    ["sweep", "wrong.toml", "--out", "o"],
    ["sweep", "sampled.toml", "--out", "o"]
    + ["--set", 'sweep.reduce={ over = ["Q", "P"], mean = true }'],
]
NEEDED = ("zarr", "h5netcdf", "h5py", "xarray")


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """The folder, and by seed what is said and what is written."""
    sweeps = SWEEPS if all(map(importlib.util.find_spec, NEEDED)) else []
    folder = tmp_path_factory.mktemp("seeds")
    return folder, answers(folder, [*MISTAKES, *COMMANDS, *sweeps])


@pytest.mark.parametrize("seed", SEEDS[1:])
def test_commands(found, seed):
    _, by_seed = found
    (said, written), (other, other_written) = by_seed[SEEDS[0]], by_seed[seed]
    for one, two in zip(said, other, strict=True):
        assert two == one, f"PYTHONHASHSEED {SEEDS[0]} and {seed}"
    assert other_written == written, f"PYTHONHASHSEED {SEEDS[0]} and {seed}"
    count = len(MISTAKES)
    assert [code for _, code, *_ in said] == [2] * count + [0] * (len(said) - count)
    assert min(len(wrong) for *_, wrong in said[:count]) >= 2
    files = {"states.csv", "film.csv", "table.csv"}
    assert {path for path in written if os.sep not in path} == files


def test_columns_of_a_design_go_to_the_inputs_in_the_order_of_the_file(found):
    for name in NEEDED:
        pytest.importorskip(name, reason="needs the extra: pip install 'thirdbody[sweep]'")
    import xarray as xr

    folder, _ = found
    u = sobol(8, 4, 3, 0, 8)
    for seed in SEEDS:
        data = xr.open_zarr(folder / str(seed) / "sobol" / "states.zarr", chunks=None)
        assert_allclose(data["particles.areal_density"], 3e10 * 10 ** u[:, 0], rtol=1e-14)
        assert_allclose(data["roughness.R"], 2e-6 + 2e-6 * u[:, 2], rtol=1e-14)


def every_command(name):
    """Every command on one example, each into a file of its own."""
    path = study(name)
    return [
        ["solve", path],
        ["solve", path, "--json", "--csv", f"{name}-states.csv"],
        ["film", path, "--json", "--csv", f"{name}-film.csv", "--figure", f"{name}-film.pdf"],
        ["compare", path, "--laws", "gw,ke", "--csv", f"{name}-compare.csv"],
        ["table", path, "--out", f"{name}-table.csv", "--tolerance", "1e-3"],
        ["assess", path, "--html", f"{name}-assess.html", "--set", "uncertainty.samples=64"],
        ["report", path, "--out", f"{name}-report.html", "--set", "uncertainty.samples=64"],
        ["design", path, "--json", "--csv", f"{name}-points.csv", "--figure", f"{name}-points.svg"]
        + ["--set", "design.points=4", "--set", 'design.pressure=["5 MPa"]'],
        ["sweep", path, "--out", f"{name}-sweep", "--set", "sweep.chunk=32"],
    ]


@pytest.mark.slow
def test_every_command_on_every_example(tmp_path):
    """Those that know what to do with the file answer, the others refuse it, alike."""
    drawn = [["compare", study("assess"), "--out", "compare"]]
    commands = [*itertools.chain(*map(every_command, EXAMPLES)), *drawn]
    found = answers(tmp_path, commands, SEEDS[:2])
    one, two = SEEDS[:2]
    assert all(code == 0 for words, code, *_ in found[one][0] if words[0] == "solve")
    assert any(code == 0 for words, code, *_ in found[one][0] if words[0] == "design")
    assert found[two] == found[one], f"PYTHONHASHSEED {one} and {two}"
