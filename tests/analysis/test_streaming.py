"""Sweeps: designs, blocks on disk, runs that are killed and go on, reductions, the command."""

import functools
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from refusals import Mistake, refuses
from scipy.stats import qmc
from steel_and_dust import DUSTY
from steel_and_dust import TWO_BODY as CLEAN
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.analysis.sweep import stores, streaming
from thirdbody.analysis.sweep.folder import name_of
from thirdbody.analysis.sweep.make_plan import make_plan
from thirdbody.analysis.sweep.plan import LOOKED_AT
from thirdbody.cli.commands import sweep as sweep_command
from thirdbody.equilibrium.status import Status
from thirdbody.errors import in_study
from thirdbody.numerics.sampling import DESIGNS, Span, latin, sobol
from thirdbody.study import check, load_study

xr = pytest.importorskip("xarray")

MEAN, DENSITY = "particles.diameter.mean", "particles.areal_density"
GRID = dict(F_star=np.geomspace(5e-7, 3e-3, 9), vary={DENSITY: [0, 1e10, 1e11]})
SAMPLES = dict(
    pressure=(1e6, 1e8),
    vary={"particle_law.seat": ["rough", "plane"], DENSITY: {"low": 1e9, "high": 1e11}},
    design="sobol",
    samples=13,
)
EXAMPLE = Path(__file__).parents[2] / "examples" / "sweep.toml"
FORMATS = pytest.mark.parametrize("format", ["zarr", "netcdf"])


@pytest.fixture(autouse=True)
def needed(request):
    if "format" in getattr(request, "fixturenames", ()) or "tmp_path" in request.fixturenames:
        for name in ("zarr", "h5netcdf", "h5py"):
            pytest.importorskip(name, reason="needs the extra: pip install 'thirdbody[sweep]'")


@functools.cache
def in_memory(number, **options):
    """`GRID` or `SAMPLES`, solved once."""
    return tb.sweep(DUSTY, **(GRID, SAMPLES)[number], **options)


def same(stored, memory):
    """Bit for bit, in every variable, its type and its attributes; a folder tells less of why."""
    assert stored.sizes == memory.sizes
    assert list(stored.data_vars) == list(memory.data_vars)
    assert set(stored.coords) == set(memory.coords)
    for name in (*memory.data_vars, *memory.coords):
        assert stored[name].dims == memory[name].dims
        assert stored[name].dtype.kind == memory[name].dtype.kind, name
        assert stored[name].attrs == memory[name].attrs, name
        found, wanted = stored[name].values, memory[name].values
        if name == "status":
            found, wanted = found == "ok", wanted == "ok"
        elif wanted.dtype.kind != "U":
            assert found.dtype == wanted.dtype, name
        assert_array_equal(found, wanted, err_msg=name)


def files(folder):
    return {path: path.stat().st_mtime_ns for path in Path(folder).rglob("*")}


# ---------------------------------------------------------------- designs
def test_sobol_is_scipys_in_any_part():
    whole = qmc.Sobol(3, rng=7).random(64)
    assert_array_equal(sobol(64, 3, 7, 0, 64), whole)
    for start, stop in ((40, 64), (0, 5), (5, 6), (6, 40), (63, 64)):
        assert_array_equal(sobol(64, 3, 7, start, stop), whole[start:stop])
    assert not np.any(sobol(64, 3, 8, 0, 64) == whole)


@pytest.mark.parametrize("size", [1, 2, 7, 64, 1000, 4097])
def test_latin_hypercube_has_one_point_in_every_stratum(size):
    whole = latin(size, 3, 5, 0, size)
    strata = np.sort((whole * size).astype(int), axis=0)
    assert_array_equal(strata, np.arange(size)[:, None] * np.ones(3, int))
    parts = [latin(size, 3, 5, i, min(i + 10, size)) for i in range(0, size, 10)]
    assert_array_equal(np.concatenate(parts), whole)


def test_latin_hypercube_is_as_even_and_as_random_as_scipys():
    """Discrepancy, correlation between inputs, and the place inside the strata."""
    mine = [latin(256, 4, seed, 0, 256) for seed in range(40)]
    theirs = [qmc.LatinHypercube(4, rng=seed).random(256) for seed in range(40)]
    found, wanted = ([qmc.discrepancy(u) for u in them] for them in (mine, theirs))
    error = np.hypot(np.std(found), np.std(wanted)) / np.sqrt(40)
    assert abs(np.mean(found) - np.mean(wanted)) < 4 * error
    correlation = np.array([np.corrcoef(u.T)[np.triu_indices(4, 1)] for u in mine])
    assert abs(np.mean(correlation)) < 4 / np.sqrt(256 * 240)
    assert np.std(correlation) == pytest.approx(1 / 16, rel=0.25)
    # neighbours in the list are no neighbours in the cube
    steps = np.concatenate([u[1:] - u[:-1] for u in mine])
    assert np.mean(np.abs(steps)) == pytest.approx(1 / 3, rel=0.02)
    inside = np.concatenate([(256 * u) % 1 for u in mine]).ravel()
    assert np.mean(inside) == pytest.approx(0.5, abs=4 / np.sqrt(12 * inside.size))


def test_latin_hypercube_of_a_hundred_million_costs_its_part_only():
    end = latin(10**8, 5, 1, 10**8 - 1000, 10**8)
    assert end.shape == (1000, 5)
    assert np.all((end >= 0) & (end < 1))
    assert len(np.unique((end * 10**8).astype(int)[:, 0])) == 1000


def test_spans():
    u = np.array([0.0, 0.5])
    assert_allclose(Span(1.0, 3.0).values_at(u), [1, 2])
    assert_allclose(Span(1.0, 100.0, "log").values_at(u), [1, 10])


# ---------------------------------------------------------------- which states
def test_grid_is_what_solve_says():
    data = tb.sweep(DUSTY, **GRID)
    assert data.A_t.dims == (DENSITY, "F_star")
    assert data[DENSITY].attrs["units"] == "1/m^2"
    for i, density in enumerate([0, 1e10, 1e11]):
        one = CLEAN if density == 0 else DUSTY.replace(**{DENSITY: density})
        state = tb.solve(one, F_star=GRID["F_star"])
        assert_allclose(data.A_t[i], state.A_t, rtol=1e-12)
        assert_array_equal(data["mode"][i], state.mode)


def test_zip_takes_the_inputs_in_pairs():
    laws = [tb.asperity.ZMC(), tb.asperity.GW(), tb.asperity.ZMC()]
    R = np.array([2e-6, 3e-6, 4e-6])
    data = tb.sweep(CLEAN, F_star=1e-5, vary={"roughness.R": R, "asperity_law": laws}, design="zip")
    assert data.sizes == {"state": 3}
    for i in range(3):
        one = CLEAN.replace(**{"roughness.R": R[i], "asperity_law": laws[i]})
        assert data.A_t[i].item() == pytest.approx(tb.solve(one, F_star=1e-5).A_t, rel=1e-12)


@pytest.mark.parametrize("design", ["latin", "sobol"])
def test_samples_are_the_designs_and_the_states_are_theirs(design):
    data = tb.sweep(DUSTY, **(SAMPLES | {"design": design, "seed": 3}))
    assert data.A_t.dims == ("particle_law.seat", "sample")
    draw = {"latin": latin, "sobol": sobol}[design](13, 2, 3, 0, 13)
    # the ranges in the order in which they are given, the load last
    assert_array_equal(data[DENSITY], 1e9 + draw[:, 0] * (1e11 - 1e9))
    assert_array_equal(data.pressure, 1e6 + draw[:, 1] * (1e8 - 1e6))
    i = 6
    one = DUSTY.replace(
        **{
            DENSITY: float(data[DENSITY][i]),
            "particle_law": tb.particle.Series(deep="off", seat="plane"),
        }
    )
    state = tb.solve(one, pressure=float(data.pressure[i]))
    assert data.A_t.sel({"particle_law.seat": "plane"})[i].item() == pytest.approx(
        state.A_t, rel=1e-12
    )
    again = tb.sweep(DUSTY, **(SAMPLES | {"design": design, "seed": 4}))
    assert not np.any(again.pressure == data.pressure)


@pytest.mark.parametrize(
    ("change", "refusal"),
    [
        (dict(design="sobl"), refuses(Mistake.OPTION, "design", value="'sobl'")),
        (dict(design="sobol", samples=4), refuses(Mistake.MISSING, "design", value="'sobol'")),
        (dict(samples=4), refuses(Mistake.IDLE, "samples", value="4")),
        (
            dict(vary={"roughness.R": {"low": 1, "high": 2}}),
            refuses(Mistake.IDLE, "vary['roughness.R']", value="{'low': 1, 'high': 2}"),
        ),
        (
            dict(vary={"roughness.R": [-1e-6, 1e-6]}),
            refuses(Mistake.RANGE, "vary['roughness.R']", says="-1e-06"),
        ),
        (dict(vary={"roughness.R": []}), refuses(Mistake.EMPTY, "vary['roughness.R']")),
        (
            dict(vary={"roughness.Q": [1.0]}),
            refuses(Mistake.UNKNOWN, "vary['roughness.Q']", meant="roughness.R"),
        ),
        (
            dict(vary={"roughness.R": [1e-6, 2e-6]}, design="zip"),
            refuses(Mistake.SHAPE, "design", value="'zip'"),
        ),
        (dict(columns=["area"]), refuses(Mistake.OPTION, "column", value="'area'")),
        (dict(chunk=0), refuses(Mistake.KIND, "chunk", value="0")),
        (dict(workers=0), refuses(Mistake.KIND, "workers", value="0")),
        (dict(pressure=[1.0]), refuses(Mistake.CLASH, "", says="pressure, F_star")),
        (dict(F_star=[-1.0]), refuses(Mistake.RANGE, "F_star", value="-1")),
        (dict(reduce={"mean": True}), refuses(Mistake.MISSING, "reduce['over']")),
        (dict(reduce={"over": "F_star"}), refuses(Mistake.EMPTY, "reduce")),
        (
            dict(reduce={"over": "R", "mean": True}),
            refuses(Mistake.UNKNOWN, "reduce['over']", says="'R'"),
        ),
        (
            dict(reduce={"over": "F_star", "quantiles": [2]}),
            refuses(Mistake.RANGE, "reduce['quantiles']", value="2"),
        ),
        (
            dict(reduce={"over": "F_star", "exceed": {"mode": 1}}),
            refuses(Mistake.UNKNOWN, "reduce['exceed']"),
        ),
        (
            dict(reduce={"over": "F_star", "median": True}),
            refuses(Mistake.UNKNOWN, "reduce['median']"),
        ),
    ],
)
def test_mistakes(change, refusal):
    with refusal as error:
        tb.sweep(CLEAN, **(dict(F_star=[1e-6, 1e-5, 1e-4]) | change))
    assert len(error.value.problems) == 1


@pytest.mark.parametrize(
    ("span", "refusal"),
    [
        ((2e-6, 1e-6), refuses(Mistake.ORDER, "vary['roughness.R']")),
        (
            (1e-6, 2e-6, 3e-6),
            refuses(Mistake.KIND, "vary['roughness.R']", value="(1e-06, 2e-06, 3e-06)"),
        ),
        ({"low": 0, "high": 1e-6, "scale": "log"}, refuses(Mistake.RANGE, "vary['roughness.R']")),
        (
            {"low": 1e-6, "high": 2e-6, "scale": "cubic"},
            refuses(Mistake.OPTION, "vary['roughness.R'] scale", value="'cubic'"),
        ),
        ({"low": "a", "high": 2e-6}, refuses(Mistake.RANGE, "vary['roughness.R']", says="'a'")),
        ((-1e-6, 1e-6), refuses(Mistake.RANGE, "vary['roughness.R']")),
    ],
)
def test_mistakes_in_ranges(span, refusal):
    with refusal:
        tb.sweep(CLEAN, F_star=1e-5, vary={"roughness.R": span}, design="latin", samples=3)


@pytest.mark.parametrize("sizes", [(3, 4, 5), (1, 100, 1), (1, 1, 7), (9, 1, 1)])
@pytest.mark.parametrize("chunk", [1, 7, 20, 33, 1000])
def test_blocks_cover_every_state_once(sizes, chunk):
    names = ("roughness.R", DENSITY, "F_star")
    lists = {name: np.arange(1, n + 1) * 1e-6 for name, n in zip(names, sizes, strict=True)}
    plan = make_plan(DUSTY, F_star=lists.pop("F_star"), vary=lists, chunk=chunk)
    seen = np.zeros(plan.whole.sizes, int)
    for number in range(plan.count):
        seen[plan.region(number)] += 1
        assert seen[plan.region(number)].size <= chunk
    assert np.all(seen == 1)


# ---------------------------------------------------------------- on disk
@pytest.mark.spread(3)
@FORMATS
@pytest.mark.parametrize("workers", [1, 3])
def test_streamed_is_in_memory_bit_for_bit(tmp_path, format, workers):
    for number, asked in enumerate((GRID, SAMPLES)):
        memory = in_memory(number, chunk=4)
        stored = tb.sweep(
            DUSTY, **asked, chunk=4, out=tmp_path / str(number), format=format, workers=workers
        )
        with stored:
            same(stored, memory)
            assert stored.attrs["warnings"] == memory.attrs["warnings"]
            assert json.loads(stored.attrs["inputs"]) == DUSTY.to_dict()
            assert stored.attrs["version"] == tb.__version__
            assert "doi:" in stored.attrs["citations"]
            assert stored.A_t.attrs["units"] == "1"
            with streaming.Folder(
                tmp_path / str(number), format, tuple(stored.data_vars)[:-1]
            ).open() as codes:
                assert codes["status"].dtype.itemsize == codes["mode"].dtype.itemsize == 1
                meanings = codes["status"].attrs["flag_meanings"].split()
                assert len(meanings) == len(codes["status"].attrs["flag_values"])
        assert sorted(p.name for p in (tmp_path / str(number)).iterdir()) == sorted(
            ["done", "files.json", "finished.json", "lock", "study.json", streaming.Folder(
                tmp_path, format, ()).data.name]
        )  # fmt: skip


def test_codes_say_why_there_is_no_state(tmp_path):
    stored = tb.sweep(CLEAN, F_star=[1e-5, 1e3, 1e-305], out=tmp_path / "o")
    codes = [Status.OK, Status.TOO_MUCH, Status.TOO_LITTLE]
    assert stored["status_code"].values.tolist() == codes
    assert stored["status"].values.tolist() == [code.sentence for code in codes]
    meanings = stored["status_code"].attrs["flag_meanings"].split()
    assert [meanings[code] for code in codes] == [code.word for code in codes]
    first, unsolved = stored.isel(F_star=0), stored.where(stored.status != "ok", drop=True)
    assert (first.status.item(), first.mode.item(), unsolved.sizes["F_star"]) == ("ok", "s-s", 2)
    assert_array_equal(np.isnan(stored.A_t), [False, True, True])
    assert streaming.Folder(tmp_path / "o", "zarr", ()).finished_summary["unsolved"] == 2


def test_warnings_are_those_of_solve():
    loads = np.geomspace(1e-5, 3e-2, 5)
    crowded = DUSTY.replace(**{DENSITY: 6e12})
    with pytest.warns(tb.errors.RangeWarning):
        wanted = tb.solve(crowded, F_star=loads).warnings
    assert len(wanted) > 1
    found = tb.sweep(crowded, F_star=loads).attrs["warnings"].splitlines()
    assert sorted(found) == sorted(wanted)
    assert tb.sweep(CLEAN, F_star=[1e-6]).attrs["warnings"] == ""


@FORMATS
def test_finished_run_does_nothing(tmp_path, format, capsys):
    asked = dict(**GRID, out=tmp_path / "o", format=format, chunk=9)
    tb.sweep(DUSTY, **asked).close()
    before = files(tmp_path)
    tb.sweep(DUSTY, **asked, progress=True).close()
    assert files(tmp_path) == before
    assert "nothing to do" in capsys.readouterr().err


def stop_after(states):
    def progress(done):
        if done >= states:
            raise KeyboardInterrupt

    return progress


@pytest.mark.spread(3)
@FORMATS
@pytest.mark.parametrize("workers", [1, 2])
def test_interrupted_run_goes_on(tmp_path, format, workers):
    asked = dict(**GRID, chunk=3, format=format, workers=workers)
    with pytest.raises(KeyboardInterrupt):
        tb.sweep(DUSTY, **asked, out=tmp_path, progress=stop_after(12))
    done = files(tmp_path / "done")
    assert len(done) == 4
    told = []
    with tb.sweep(DUSTY, **asked, out=tmp_path, progress=told.append) as stored:
        same(stored, tb.sweep(DUSTY, **GRID, chunk=3))
    assert told == [15, 18, 21, 24, 27]
    kept = files(tmp_path / "done")
    assert all(kept[path] == when for path, when in done.items())


@pytest.mark.spread(3)
@pytest.mark.parametrize("text", ["", "{", "[]", '{"study": "other"}', "\0\0\0"])
def test_broken_marker_is_solved_again(tmp_path, text):
    asked = dict(**GRID, chunk=9, out=tmp_path)
    tb.sweep(DUSTY, **asked).close()
    (tmp_path / "finished.json").unlink()
    (tmp_path / "done" / "1.json").write_text(text)
    (tmp_path / "done" / "strange").write_text("")
    # what a killed run left of the data is not trusted, nor is it read
    for name in ("A_t", "status"):
        (tmp_path / "states.zarr" / name / "c" / "1" / "0").write_bytes(b"broken")
    told = []
    same(tb.sweep(DUSTY, **asked, progress=told.append), tb.sweep(DUSTY, **GRID, chunk=9))
    assert told == [27]


def test_another_study_is_refused(tmp_path):
    tb.sweep(DUSTY, **GRID, out=tmp_path).close()
    before = files(tmp_path)
    other = DUSTY.replace(**{"roughness.sigma": 90e-9})
    with refuses(Mistake.OTHER_STUDY, "", says="contact.roughness.sigma is 1e-07"):
        tb.sweep(other, **GRID, out=tmp_path)
    with refuses(Mistake.OTHER_STUDY, "", says='"zarr"'):
        tb.sweep(DUSTY, **GRID, out=tmp_path, format="netcdf")
    with refuses(Mistake.OTHER_STUDY, "", says="chunk is 262144"):
        tb.sweep(DUSTY, **GRID, out=tmp_path, chunk=5)
    longer = GRID | {"F_star": np.geomspace(1e-6, 1e-5, 5000)}
    with refuses(Mistake.OTHER_STUDY, "", says="F_star is 5e-07 … 0.003 (9 values)") as told:
        tb.sweep(DUSTY, **longer, out=tmp_path)
    (problem,) = told.value.problems
    assert "1e-06 … 1e-05 (5000 values)" in problem.rule
    assert problem.source == str(tmp_path)
    assert "--out" in in_study(problem.hint)
    assert files(tmp_path) == before


def test_folders_that_are_none_of_ours(tmp_path):
    (tmp_path / "thesis.docx").touch()
    with refuses(Mistake.UNWRITABLE, "", says="thesis.docx"):
        tb.sweep(DUSTY, **GRID, out=tmp_path)
    with refuses(Mistake.UNWRITABLE, "", says="thesis.docx"):
        tb.sweep(DUSTY, **GRID, out=tmp_path / "thesis.docx")
    with refuses(Mistake.OPTION, "format", value="'csv'"):
        tb.sweep(DUSTY, **GRID, out=tmp_path / "new", format="csv")
    assert os.listdir(tmp_path) == ["thesis.docx"]


@pytest.mark.parametrize(("format", "package"), [("zarr", "zarr"), ("netcdf", "h5py")])
def test_missing_package_has_one_message(tmp_path, monkeypatch, format, package):
    monkeypatch.setitem(sys.modules, package, None)
    with refuses(Mistake.ABSENT, "format", says=f" {package}: "):
        tb.sweep(CLEAN, F_star=1e-5, out=tmp_path / "o", format=format)
    assert not (tmp_path / "o").exists()


def test_missing_package_names_the_option_of_the_command(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "zarr", None)
    asked = sweep_command.Options(study=EXAMPLE, out=tmp_path / "o")
    with refuses(Mistake.ABSENT, "--format", says="thirdbody[sweep]"):
        sweep_command.command(asked)


# ---------------------------------------------------------------- killed for real
SAMPLED = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[sweep]
design = "sobol"
samples = 12
chunk = 4
pressure = "10 MPa"
columns = ["A_t", "mode"]
[sweep.vary]
roughness.R = { from = "2 um", to = "4 um" }
roughness.sigma = { from = "80 nm", to = "120 nm" }
"""
SCRIPT = """
import time
import thirdbody as tb
contact = tb.Contact.from_dict({contact})
tb.sweep(contact, **{asked}, out={out!r}, format={format!r}, progress=lambda n: time.sleep({pause}))
"""
KILLED = dict(F_star=np.geomspace(1e-6, 1e-4, 120).tolist(), vary={DENSITY: [0, 1e11]}, chunk=4)


def start(out, format="zarr", pause=0.01):
    study = dict(contact=DUSTY.to_dict(), asked=KILLED)
    code = SCRIPT.format(**study, out=str(out), format=format, pause=pause)
    return subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)


def names_in(folder):
    """Names of the files of a folder that is begun anew meanwhile, none where it is not there."""
    try:
        return os.listdir(folder)
    except FileNotFoundError:
        return []


def wait_for(process, folder, blocks):
    end = time.monotonic() + 60
    while sum(name.endswith(".json") for name in names_in(folder / "done")) < blocks:
        if process.poll() is not None or time.monotonic() > end:
            pytest.fail(f"no {blocks} blocks: {process.communicate()[1]}")
        time.sleep(0.002)


# kills itself before it touches a file of the folder for the n-th time
DOOMED = """
import os, signal, sys

def doom(folder, moment):
    left = [moment]

    def hook(event, told):
        touches = event in ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir")
        if touches and str(told[0]).startswith(folder):
            left[0] -= 1
            if left[0] == 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(hook)
"""
COMMAND = """
from thirdbody import cli
doom(sys.argv[sys.argv.index("--out") + 1], {moment})
cli.main()
"""
# one process that forks: as many runs as there are moments, without loading everything again
MOMENTS = """
import hashlib, itertools, traceback
from pathlib import Path
import h5netcdf, xarray, zarr
import thirdbody as tb
from thirdbody.analysis.sweep import streaming
from thirdbody.study import load_study

os.fsync = lambda file: None  # a kill, no power cut: what is written is there
plan = load_study({file!r}, {settings!r}).sweep
streaming.in_memory(plan, workers=1, client=None, progress=False)

def run(out, moment=0):
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    try:
        if moment:
            doom(out, moment)
        streaming.run(plan, out, format={format!r})
        os._exit(0)
    except BaseException:
        traceback.print_exc()
    os._exit(1)

def contents(out):
    return {{
        str(path.relative_to(out)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in Path(out).rglob("*") if path.is_file() and path.name != "lock"
    }}

assert run({out!r} + "unbroken") == 0
wanted = contents({out!r} + "unbroken")
wrong, killed = [], 0
for moment in itertools.count(1, {step}):
    out = {out!r} + str(moment)
    statuses = [run(out, moment), run(out, max(1, moment // 2)), run(out)]
    if statuses[0] == 0:
        break
    killed += 1 + (statuses[1] == -9)
    differ = sorted(name for name, _ in contents(out).items() ^ wanted.items())
    if statuses[0] != -9 or statuses[1] not in (0, -9) or statuses[2] or differ:
        wrong.append((moment, statuses, differ))
print(killed, wrong)
"""
ONLY_POSIX = pytest.mark.skipif(os.name == "nt", reason="signals and fork")


@pytest.fixture
def sampled(tmp_path):
    """A study file of two sampled inputs and three blocks."""
    file = tmp_path / "study.toml"
    file.write_text(SAMPLED)
    return file


@pytest.mark.check
@ONLY_POSIX
@pytest.mark.parametrize(
    ("format", "step"),
    [
        pytest.param("zarr", 11, marks=pytest.mark.slow),
        pytest.param("netcdf", 5, marks=pytest.mark.slow),
    ],
)
def test_killed_at_any_moment_and_again_equals_unbroken(tmp_path, sampled, format, step):
    """SIGKILL before each touch of a file, and in the run that goes on; to the last byte."""
    code = DOOMED + MOMENTS.format(
        file=str(sampled),
        settings=["sweep.reduce={mean=true}"] if format == "netcdf" else [],
        format=format,
        step=step,
        out=str(tmp_path / "o"),
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    killed, wrong = done.stdout.split(" ", 1)
    assert wrong.strip() == "[]", done.stderr
    assert int(killed) > 60 / step


@pytest.mark.check
@ONLY_POSIX
def test_killed_twice_and_resumed_under_other_hash_seeds_equals_unbroken(tmp_path, sampled):
    """Every process draws the same samples for the same inputs, and finds what others began."""
    found = {}
    # of some 180 moments
    runs = [("killed", 0, 60), ("killed", 3, 30), ("killed", 7, 0), ("unbroken", 11, 0)]
    for name, seed, moment in runs:
        code = DOOMED + COMMAND.format(moment=moment)
        words = ["sweep", str(sampled), "--out", str(tmp_path / name)]
        done = subprocess.run(
            [sys.executable, "-c", code, *words],
            env=os.environ | {"PYTHONHASHSEED": str(seed)},
            capture_output=True,
            text=True,
        )
        assert done.returncode == (-signal.SIGKILL if moment else 0), (seed, done.stderr)
        assert (tmp_path / name / "finished.json").exists() == (moment == 0)
        found[name] = {
            path.relative_to(tmp_path / name): path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file() and path.name != "lock"
        }
    assert found["killed"] == found["unbroken"]


def as_of_earlier_version(folder, study=None):
    """Markers without digests."""
    for file in [*(folder / "done").glob("*.json"), folder / "finished.json"]:
        told = json.loads(file.read_text("utf-8"))
        if study is not None:
            told["study"] = study
        kept = {key: told[key] for key in told if key not in ("files", "sha256")}
        file.write_text(json.dumps(kept))
    (folder / "files.json").unlink(missing_ok=True)


def test_another_order_of_the_inputs_is_another_study(tmp_path):
    spans = {"roughness.R": (2e-6, 4e-6), DENSITY: (1e10, 1e11)}
    asked = dict(pressure=1e7, design="sobol", samples=4)
    first, again = (dict(asked, vary=vary) for vary in (spans, dict(reversed(spans.items()))))
    one, other = make_plan(DUSTY, **first).to_dict(), make_plan(DUSTY, **again).to_dict()
    assert one["order"] == ["pressure", *spans]
    assert one | {"order": None} == other | {"order": None}
    kept = tb.sweep(DUSTY, **first, out=tmp_path)
    before = files(tmp_path)
    with pytest.raises(tb.errors.InvalidValue) as error:
        tb.sweep(DUSTY, **again, out=tmp_path)
    assert len(error.value.problems) == 1
    names = list(spans)
    for order in (["pressure", *names], ["pressure", *names[::-1]]):
        assert json.dumps(order) in str(error.value)
    assert files(tmp_path) == before
    same(kept, tb.sweep(DUSTY, **first))
    # a folder of a version that did not tell the order
    text = json.loads((tmp_path / "study.json").read_text("utf-8"))
    del text["order"]
    (tmp_path / "study.json").write_text(json.dumps(text))
    as_of_earlier_version(tmp_path, name_of(text))
    with refuses(Mistake.OTHER_STUDY, "", says='"not told"'):
        tb.sweep(DUSTY, **first, out=tmp_path)


def test_markers_of_data_that_are_gone_count_no_more(tmp_path):
    asked = dict(**GRID, chunk=9, out=tmp_path)
    tb.sweep(DUSTY, **asked).close()
    shutil.rmtree(tmp_path / "states.zarr")
    same(tb.sweep(DUSTY, **asked), tb.sweep(DUSTY, **GRID, chunk=9))


def test_an_interrupted_design_goes_on_with_the_right_points(monkeypatch):
    """Ctrl-C between a point and its number, and the same call again in the same process."""
    whole = sobol(64, 3, 7, 0, 64)
    sobol(64, 3, 7, 0, 8)
    drawn = qmc.Sobol.random

    def interrupted(self, n):
        drawn(self, n)
        self.num_generated -= n
        raise KeyboardInterrupt

    monkeypatch.setattr(qmc.Sobol, "random", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sobol(64, 3, 7, 8, 16)
    monkeypatch.undo()
    assert_array_equal(sobol(64, 3, 7, 8, 16), whole[8:16])


@pytest.mark.check
def test_locked_by_another_process_as_long_as_it_lives(tmp_path):
    process = start(tmp_path, pause=600)
    wait_for(process, tmp_path, 1)
    with refuses(Mistake.UNWRITABLE, "", says=f"process {process.pid}"):
        tb.sweep(DUSTY, **KILLED, out=tmp_path)
    process.kill()
    process.communicate()
    with pytest.raises(KeyboardInterrupt):
        tb.sweep(DUSTY, **KILLED, out=tmp_path, progress=stop_after(8))


def test_killed_while_the_parts_are_put_together(tmp_path, monkeypatch):
    asked = dict(**GRID, chunk=9, out=tmp_path, format="netcdf")
    monkeypatch.setattr(stores._NetCDF, "label", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        tb.sweep(DUSTY, **asked)
    monkeypatch.undo()
    assert not (tmp_path / "states.nc").exists()
    told = []
    with tb.sweep(DUSTY, **asked, progress=told.append) as stored:
        same(stored, tb.sweep(DUSTY, **GRID, chunk=9))
    assert told == []


# ru_maxrss remembers the process that started this one, VmHWM does not
MEMORY = """
import thirdbody as tb
steel = tb.materials["S45C"]
contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
                     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
for samples in (2**15, 2**18):
    tb.sweep(contact, pressure=(1e6, 1e8), design={design!r}, samples=samples, chunk=16384,
             out={out!r} + str(samples))
    print(int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0]) // 1024)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="/proc is Linux's")
@pytest.mark.parametrize("design", ["latin", "sobol"])
def test_memory_is_bounded(tmp_path, design):
    """Eight times the states, hardly more memory; kept in memory they would be 75 MB more."""
    code = MEMORY.format(out=str(tmp_path / "o"), design=design)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    few, many = map(int, done.stdout.split())
    assert many - few < 25


# ---------------------------------------------------------------- reductions
ALL = {
    "quantiles": [0.0, 0.05, 0.5, 1.0],
    "exceed": {"particle_load_share": 0.5},
    "extrema": True,
    "mean": True,
}


def reference(states, over, name):
    """Statistics by NumPy of the states that a sweep keeps."""
    values = states[name].transpose(..., *over)
    values = values.values.reshape(*values.shape[: values.ndim - len(over)], -1)
    return {
        "mean": np.nanmean(values, -1),
        "min": np.nanmin(values, -1),
        "max": np.nanmax(values, -1),
        "quantile": np.moveaxis(np.nanquantile(values, ALL["quantiles"], axis=-1), 0, -1),
    }


@pytest.mark.spread(3)
@FORMATS
@pytest.mark.parametrize("chunk", [3, 1000])
def test_inputs_of_samples_that_are_kept_are_those_drawn(format, chunk, tmp_path):
    """Loads are reduced away, and the samples stay: with what was drawn, not with what was free."""
    drawn = dict(
        vary={"roughness.sigma": {"low": 1e-7, "high": 2e-7}, "particle_law.seat": ["rough"]},
        design="sobol",
        samples=5,
        F_star=[1e-6, 1e-5],
    )
    every = tb.sweep(DUSTY, **drawn)["roughness.sigma"].values
    reduced = drawn | dict(reduce={"mean": True, "over": ["F_star", "particle_law.seat"]})
    assert_array_equal(tb.sweep(DUSTY, **reduced, chunk=chunk)["roughness.sigma"].values, every)
    with tb.sweep(DUSTY, **reduced, out=tmp_path, format=format, chunk=chunk) as kept:
        assert_array_equal(kept["roughness.sigma"].values, every)


@FORMATS
@pytest.mark.parametrize("over", [["sample"], ["particle_law.seat", "pressure"]])
@pytest.mark.parametrize("chunk", [4, 1000])
def test_reductions_are_numpys(tmp_path, format, over, chunk):
    states = in_memory(1)
    data = tb.sweep(
        DUSTY, **SAMPLES, reduce=ALL | {"over": over}, out=tmp_path, format=format, chunk=chunk
    )
    with data:
        dims = ["sample" if name == "pressure" else name for name in over]
        assert data.A_t_mean.dims == tuple(d for d in states.A_t.dims if d not in dims)
        for name in ("A_t", "particle_load_share"):
            wanted = reference(states, dims, name)
            for kind in ("min", "max", "quantile"):
                assert_allclose(data[f"{name}_{kind}"], wanted[kind], rtol=1e-12, err_msg=kind)
            assert_allclose(data[f"{name}_mean"], wanted["mean"], rtol=1e-12)
        assert_allclose(
            data.particle_load_share_exceeds, (states.particle_load_share > 0.5).mean(dims)
        )
        assert data.particle_load_share_exceeds.attrs["threshold"] == 0.5
        assert np.all(data.solved == 1)
        assert_array_equal(data["quantile"], ALL["quantiles"])


@pytest.mark.spread(2)
@FORMATS
def test_a_cell_in_many_blocks(tmp_path, format):
    """Without quantiles a cell may be larger than a block; its parts survive a stop."""
    kept = {key: value for key, value in ALL.items() if key != "quantiles"}
    asked = dict(**SAMPLES, reduce=kept, chunk=3)
    with pytest.raises(KeyboardInterrupt):
        tb.sweep(DUSTY, **asked, out=tmp_path, format=format, progress=stop_after(9))
    assert len(list((tmp_path / "done").glob("*.json"))) == 3
    told = []
    with tb.sweep(DUSTY, **asked, out=tmp_path, format=format, progress=told.append) as data:
        states = tb.sweep(DUSTY, **SAMPLES, chunk=3)
        wanted = reference(states, ["sample"], "A_t")
        assert_array_equal(data.A_t_min, wanted["min"])
        assert_array_equal(data.A_t_max, wanted["max"])
        assert_allclose(data.A_t_mean, wanted["mean"], rtol=1e-14)
        memory = tb.sweep(DUSTY, **asked)
        for name in memory.data_vars:
            assert_array_equal(data[name], memory[name])
    assert told == [12, 13, 16, 19, 22, 25, 26]
    assert not (tmp_path / "parts").exists()


def test_unsolved_states_count_for_nothing_but_solved():
    loads = [1e-6, 1e-5, 1e3, 1e4]
    data = tb.sweep(CLEAN, F_star=loads, reduce=ALL | {"over": "F_star"})
    solved = tb.solve(CLEAN, F_star=loads[:2])
    assert data.solved.item() == 0.5
    assert data.A_t_mean.item() == pytest.approx(np.mean(solved.A_t), rel=1e-12)
    assert_allclose(data.A_t_quantile, np.quantile(solved.A_t, ALL["quantiles"]), rtol=1e-12)
    none = tb.sweep(CLEAN, F_star=loads[2:], reduce=ALL | {"over": "F_star"})
    assert none.solved.item() == 0
    for name in ("A_t_mean", "A_t_min", "A_t_max", "particle_load_share_exceeds"):
        assert np.isnan(none[name].item())
    assert np.all(np.isnan(none.A_t_quantile))


def test_quantiles_of_what_does_not_fit_are_refused():
    asked = dict(pressure=(1e6, 1e7), design="sobol", samples=10**9)
    with refuses(Mistake.TOO_LARGE, ""):
        make_plan(CLEAN, **asked, reduce={"quantiles": [0.5]})
    plan = make_plan(CLEAN, **asked, reduce={"mean": True})
    assert plan.count == -(-(10**9) // plan.chunk)
    few = make_plan(
        CLEAN, **(asked | {"samples": 10**7}), columns=["A_t"], reduce={"quantiles": 0.5}
    )
    assert few.count == 1


def test_a_trillion_states_are_planned_by_looking_at_a_few(monkeypatch):
    """Neither time nor memory goes with the size of a design."""
    drawn = []

    def counting(size, width, seed, start, stop):
        drawn.append((start, stop))
        return latin(size, width, seed, start, stop)

    monkeypatch.setitem(DESIGNS, "latin", counting)
    plan = make_plan(
        DUSTY,
        F_star=np.geomspace(1e-6, 1e-4, 100),
        vary={MEAN: (2e-7, 4e-7), DENSITY: np.linspace(1e9, 1e11, 100)},
        design="latin",
        samples=10**8,
    )
    assert plan.states == 10**12
    assert plan.task(plan.count - 1, coded=True).block.sizes[-1] <= plan.chunk
    plan.notes()
    assert 0 < sum(stop - start for start, stop in drawn) <= LOOKED_AT
    assert max(stop for _, stop in drawn) <= LOOKED_AT


# ---------------------------------------------------------------- study files and the command
def command(*arguments):
    return CliRunner().invoke(cli.app, ["sweep", *map(str, arguments)])


SMALL = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[load]
F_star = { from = 1e-6, to = 1e-4, points = 6 }
[sweep.vary]
roughness.R = ["2 um", "3 um"]
"asperity_law.k" = { from = 0.3, to = 0.5, points = 2, spacing = "linear" }
"""


def test_study_file_is_the_python_sweep(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(SMALL)
    plan = load_study(file).sweep
    wanted = make_plan(
        CLEAN,
        F_star=np.geomspace(1e-6, 1e-4, 6),
        vary={"roughness.R": [2e-6, 3e-6], "asperity_law.k": [0.3, 0.5]},
    )
    assert plan.to_dict() == wanted.to_dict()


def test_example_file_samples_what_it_says():
    study = load_study(EXAMPLE)
    plan = study.sweep
    assert [dim.name for dim in plan.dims] == ["pressure", "sample"]
    assert plan.dims[1].spans == {
        "particles.areal_density": Span(3e10, 3e11, "log"),
        "roughness.R": Span(2e-6, 4e-6, "linear"),
    } or list(plan.dims[1].spans) == ["roughness.R", "particles.areal_density"]
    assert plan.reduction.quantiles == (0.05, 0.5, 0.95)
    # solve takes the loads of the sweep when there is no [load]
    assert_array_equal(study.values, [1e6, 1e7, 1e8])
    assert load_study(EXAMPLE, ["sweep.samples=63"]).notes[0].startswith("sweep.samples = 63")


def test_distributions_are_called_as_in_the_file():
    study = load_study(EXAMPLE, ["sweep.vary.particles.mean={from='200 nm', to='300 nm'}"])
    assert study.sweep.dims[1].spans[MEAN] == Span(2e-7, 3e-7, "log")


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        (["sweep.design=sobl"], 'sweep.design = "sobl" must be one of'),
        (["sweep.samples=0"], "sweep.samples = 0 must be a whole number"),
        (["sweep.seed=-1"], "sweep.seed = -1"),
        (["sweep.vary.roughness.R=3 GPa"], 'sweep.vary.roughness.R = "3 GPa" is a pressure'),
        (["sweep.vary.roughness.Rr=3 um"], "sweep.vary.roughness.Rr"),
        (["sweep.pressure=-1"], "sweep.pressure = -1 must be > 0"),
        (["sweep.reduce.quantiles=[2]"], "sweep.reduce.quantiles = 2 must be from 0 to 1"),
        (["sweep.reduce.exceed={A=1}"], "sweep.reduce.exceed names 'A'"),
        (["sweep.reduce.over=R"], "sweep.reduce.over names 'R'"),
        (["sweep.columns=[\"A\"]"], 'sweep.columns = "A" must be one of'),
        (["sweep.F_star=1e-5"], "points"),
    ],
)  # fmt: skip
def test_mistakes_in_the_file(settings, sentence):
    if settings == ["sweep.F_star=1e-5"]:
        assert load_study(EXAMPLE, settings).sweep.load == "F_star"
        return
    with pytest.raises(tb.errors.InvalidValue) as error:
        load_study(EXAMPLE, settings)
    assert len(error.value.problems) == 1, error.value.problems
    assert sentence in str(error.value)


def test_every_mistake_at_once():
    import tomllib

    data = tomllib.loads(EXAMPLE.read_text("utf-8"))
    data["sweep"] |= {"samples": "many", "colums": ["A_t"]}
    data["sweep"]["vary"]["roughness"]["R"] = {"from": "4 um", "to": "2 um"}
    data["roughness"]["R"] = -1
    with pytest.raises(tb.errors.InvalidValue) as error:
        check(data)
    assert len(error.value.problems) == 4
    text = str(error.value)
    for words in ("sweep.samples", "sweep.colums", "sweep.vary.roughness.R", "roughness.R = -1"):
        assert words in text


def test_command(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(SMALL)
    done = command(file, "--out", tmp_path / "o", "--workers", 2)
    assert done.exit_code == 0
    assert " 0 % " in done.stdout
    assert re.search(r"24 states in .*states\.zarr", done.stderr)
    stored = xr.open_zarr(tmp_path / "o" / "states.zarr", chunks=None)
    assert stored.sizes == {"roughness.R": 2, "asperity_law.k": 2, "F_star": 6}
    before = files(tmp_path)
    again = command(file, "--out", tmp_path / "o")
    assert again.exit_code == 0, again.stderr
    assert files(tmp_path) == before
    done = command(file, "--out", tmp_path / "o", "--set", "roughness.sigma=90 nm")
    assert done.exit_code == 2
    assert done.stderr.count("error:") == 1
    assert "another study" in done.stderr
    done = command(file, "--out", tmp_path / "p", "--set", "load.F_star=[1e3]")
    assert done.exit_code == 3
    assert "24" not in done.stdout


def test_command_refuses_all_at_once(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(SMALL.partition("[sweep.vary]")[0])
    done = command(file, "--out", tmp_path / "o", "--format", "csv", "--workers", 0)
    assert done.exit_code == 2
    assert done.stderr.count("error:") == 3
    assert "[sweep]" in done.stderr
    assert not (tmp_path / "o").exists()


@pytest.mark.check
@pytest.mark.skipif(os.name == "nt", reason="no SIGINT for one process")
def test_command_is_interrupted(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(SMALL.replace("points = 6", "points = 2000"))
    arguments = ["sweep", str(file), "--out", str(tmp_path / "o"), "--set", "sweep.chunk=10"]
    process = subprocess.Popen(
        [sys.executable, "-m", "thirdbody", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    wait_for(process, tmp_path / "o", 3)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130
    (line,) = [line for line in said.splitlines() if line.startswith("error:")]
    (done,) = re.findall(r" (\d+) of 800 ", line)
    assert 0 < int(done) < 800
    assert "Traceback" not in said
