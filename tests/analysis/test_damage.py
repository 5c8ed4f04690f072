"""Sweeps on disk: files of the user stay, and damage of every kind is seen, told and mended."""

import functools
import json
import shutil
import warnings

import numpy as np
import pytest
from damage import empty, flipped, missing, truncated
from numpy.testing import assert_array_equal
from refusals import Mistake, refuses, warns_of
from steel_and_dust import DUSTY
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.analysis.sweep.folder import Folder, check_folder

for package in ("xarray", "zarr", "h5netcdf", "h5py"):
    pytest.importorskip(package, reason="needs the extra: pip install 'thirdbody[sweep]'")

GRID = dict(
    F_star=np.geomspace(1e-6, 1e-4, 4),
    vary={"particles.areal_density": [0.0, 1e10, 1e11]},
    columns=["A_t", "mode", "status"],
    chunk=4,
)
SAMPLES = dict(
    F_star=(1e-6, 1e-4),
    vary={"roughness.R": (2e-6, 4e-6)},
    design="sobol",
    samples=8,
    columns=["A_t", "mode"],
    chunk=4,
)
KINDS = {
    "zarr": (GRID, "zarr"),
    "samples": (SAMPLES, "zarr"),
    "netcdf": (GRID, "netcdf"),
    "reduced": (SAMPLES | {"reduce": {"mean": True}}, "zarr"),
}


def carry_out(kind, out, **more):
    asked, format = KINDS[kind]
    with tb.sweep(DUSTY, **asked, out=out, format=format, **more) as data:
        return data.load()


@functools.cache
def as_made(kind, made):
    return carry_out(kind, made / kind / "finished")


def contents(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "lock"
    }


def stop_after(states):
    def progress(done):
        if done >= states:
            raise KeyboardInterrupt

    return progress


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder of each kind, finished and half-way, as it should be; made once."""
    place = tmp_path_factory.mktemp("made")
    for kind in KINDS:
        carry_out(kind, place / kind / "finished")
        with pytest.raises(KeyboardInterrupt):
            carry_out(kind, place / kind / "half", progress=stop_after(4))
    return place


@pytest.fixture
def copy(made, tmp_path):
    def copied(kind, state="finished"):
        shutil.copytree(made / kind / state, tmp_path / "o")
        return tmp_path / "o"

    return copied


# ---------------------------------------------------------------- files of the user
def test_nothing_of_the_user_is_removed(tmp_path):
    """A folder with hidden entries is none that is empty."""
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "a.partial").write_text("mine")
    (tmp_path / ".film.part.mkv").write_text("mine")
    before = contents(tmp_path)
    with refuses(Mistake.UNWRITABLE, "", says="(.film.part.mkv, .git)"):
        carry_out("zarr", tmp_path)
    assert contents(tmp_path) == before


OWN = [
    ".film.part.mkv", "notes.md", ".git/a.partial", "done/notes.md", "done/.7.part.json",
    "parts/mine.npz", "states.zarr/a.partial", ".states.1.part.zarr/x", ".study.part.json",
    "done/.data.01ab23cd.part.json",
]  # fmt: skip


@pytest.mark.parametrize("kind", ["zarr", "netcdf"])
def test_what_lies_beside_a_sweep_stays(copy, kind):
    folder = copy(kind, "half")
    for name in OWN:
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("mine")
    carry_out(kind, folder)
    for name in OWN:
        assert (folder / name).read_text() == "mine"


def test_a_lock_of_somebody_else_is_not_written(tmp_path):
    (tmp_path / "lock").write_text(mine := "of another program")
    with refuses(Mistake.UNWRITABLE, "", says="(lock)"):
        carry_out("zarr", tmp_path)
    assert (tmp_path / "lock").read_text() == mine


LEFT = [
    ".study.01ab23cd.part.json", "done/.3.01ab23cd.part.json", "parts/.3.01ab23cd.part.npz",
    ".files.aa00-1f-22aa.part.json", "states.zarr/A_t/c/0/0.0123456789abcdef0123456789abcdef.partial",
    "states.zarr/zarr.0123456789abcdef0123456789abcdef.partial", ".states.part.zarr/zarr.json",
]  # fmt: skip


def test_what_a_killed_run_left_is_removed(copy, made):
    folder = copy("zarr", "half")
    for name in LEFT:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("{")
    carry_out("zarr", folder)
    assert contents(folder) == contents(made / "zarr" / "finished")


# ---------------------------------------------------------------- damage
DAMAGES = [
    missing,
    flipped,
    pytest.param(empty, marks=pytest.mark.slow),
    pytest.param(truncated, marks=pytest.mark.slow),
]
FILES = {
    "zarr": [
        "study.json", "finished.json", "files.json", "done/1.json", "states.zarr/zarr.json",
        "states.zarr/A_t/zarr.json", "states.zarr/A_t/c/1/0", "states.zarr/status/c/0/0",
        "states.zarr/F_star/zarr.json", "states.zarr/F_star/c/0",
    ],
    "samples": ["states.zarr/roughness.R/c/1", "states.zarr/F_star/c/0", "states.zarr/A_t/c/0"],
    "netcdf": ["study.json", "finished.json", "files.json", "done/1.json", "states.nc"],
    "reduced": ["finished.json", "files.json", "states.zarr/A_t_mean/c", "states.zarr/zarr.json"],
}  # fmt: skip


@pytest.mark.spread(5)
@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize(
    ("kind", "name"), [(k, name) for k, names in FILES.items() for name in names]
)
def test_damage_is_told_and_mended(copy, made, kind, name, damage):
    """Of a finished sweep: `--check` names the file, and the same call makes it again."""
    folder = copy(kind)
    damage(folder / name)
    if (name, damage) == ("finished.json", missing):
        assert "not finished" in check_folder(folder)
    else:
        with refuses(Mistake.DAMAGED, "", says=name):
            check_folder(folder)
    with warns_of("kept.damaged", kind=UserWarning) if told(name) else quiet():
        data = carry_out(kind, folder)
    assert data.identical(as_made(kind, made))
    assert contents(folder) == contents(made / kind / "finished")


def told(name):
    """What holds no numbers is made again without a word."""
    return name not in ("study.json", "finished.json")


def quiet():
    return warnings.catch_warnings(action="error", category=UserWarning)


@pytest.mark.spread(5)
@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("zarr", "states.zarr/A_t/c/0/0"),
        ("zarr", "states.zarr/A_t/zarr.json"),
        ("zarr", "states.zarr/zarr.json"),
        ("zarr", "done/0.json"),
        ("zarr", "files.json"),
        ("netcdf", "parts/0.npz"),
        ("netcdf", "done/0.json"),
        ("netcdf", "study.json"),
        ("reduced", "parts/0.npz"),
    ],
)
def test_damage_half_way_is_solved_again(copy, made, kind, name, damage):
    folder = copy(kind, "half")
    damage(folder / name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        carry_out(kind, folder)
    assert contents(folder) == contents(made / kind / "finished")


def test_only_what_is_damaged_is_solved_again(copy):
    folder = copy("zarr")
    flipped(folder / "states.zarr" / "A_t" / "c" / "1" / "0")
    states = []
    with warns_of("kept.damaged", kind=UserWarning, says="A_t/c/1/0 "):
        carry_out("zarr", folder, progress=states.append)
    assert states == [12]


def test_a_file_where_there_was_none_is_told(tmp_path):
    """A block of nothing but NaN has no file."""
    asked = dict(F_star=[1e3, 1e4], columns=["A_t"], out=tmp_path)
    tb.sweep(DUSTY, **asked).close()
    assert not (tmp_path / "states.zarr" / "A_t" / "c" / "0").exists()
    (tmp_path / "states.zarr" / "A_t" / "c").mkdir()
    (tmp_path / "states.zarr" / "A_t" / "c" / "0").write_bytes(b"mine")
    with refuses(Mistake.DAMAGED, "", says="A_t/c/0 "):
        check_folder(tmp_path)
    with warns_of("kept.damaged", kind=UserWarning), tb.sweep(DUSTY, **asked) as data:
        assert_array_equal(data.A_t, np.nan)


# ---------------------------------------------------------------- what is not finished
@pytest.mark.parametrize("kind", KINDS)
def test_a_new_folder_is_not_damaged(kind, tmp_path):
    """Nor is one that a run left half-way: its other blocks were never there."""
    with quiet(), pytest.raises(KeyboardInterrupt):
        carry_out(kind, tmp_path / "o", progress=stop_after(4))
    with quiet():
        assert len(check_folder(tmp_path / "o").splitlines()) == 1
        assert Folder(tmp_path / "o", KINDS[kind][1], ()).finished_summary is None
        carry_out(kind, tmp_path / "o")
        carry_out(kind, tmp_path / "o")


def test_a_folder_without_one_block_is_not_finished(tmp_path, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    asked = dict(F_star=[1e-6, 1e-5], columns=["A_t"], out=tmp_path / "o")
    with monkeypatch.context() as patch:
        patch.setattr("thirdbody.analysis.sweep.streaming._results", stop)
        with pytest.raises(KeyboardInterrupt):
            tb.sweep(DUSTY, **asked)
    assert "0 of 1 block done" in check_folder(tmp_path / "o")
    with quiet():
        tb.sweep(DUSTY, **asked).close()


def test_damage_is_told_at_the_line_that_asked(copy):
    folder = copy("zarr")
    missing(folder / "done" / "1.json")
    with warns_of("kept.damaged", kind=UserWarning) as heard:
        carry_out("zarr", folder)
    assert {each.filename for each in heard} == {__file__}


# ---------------------------------------------------------------- earlier versions
def as_of_earlier_version(folder):
    """Without digests."""
    (folder / "files.json").unlink(missing_ok=True)
    for file in [*(folder / "done").glob("*.json"), folder / "finished.json"]:
        if file.exists():
            said = json.loads(file.read_text("utf-8"))
            new = ("files", "sha256") + (("study",) if file.name == "finished.json" else ())
            file.write_text(json.dumps({key: said[key] for key in said if key not in new}))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("state", ["finished", "half"])
def test_folders_of_an_earlier_version_go_on(copy, made, kind, state):
    folder = copy(kind, state)
    as_of_earlier_version(folder)
    _, unchecked = check_folder(folder).splitlines()  # told, and no mistake
    assert str(folder) in unchecked
    with warns_of("kept.unchecked", kind=UserWarning):
        data = carry_out(kind, folder)
    assert data.identical(as_made(kind, made))


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", ["states.zarr/zarr.json", "states.zarr/A_t/zarr.json"])
def test_a_broken_store_of_an_earlier_version_is_mended(copy, made, name, damage):
    folder = copy("zarr", "half")
    as_of_earlier_version(folder)
    damage(folder / name)
    with warns_of("kept.unchecked", kind=UserWarning):
        data = carry_out("zarr", folder)
    assert data.identical(as_made("zarr", made))


# ---------------------------------------------------------------- the command
def command(*words):
    return CliRunner().invoke(cli.app, ["sweep", *map(str, words)])


def test_the_command_checks(copy):
    folder = copy("zarr")
    done = command("--check", folder)
    assert (done.exit_code, done.stderr) == (0, "")
    assert "the sweep is finished" in done.stdout
    truncated(folder / "states.zarr" / "A_t" / "c" / "0" / "0")
    done = command("--check", folder)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "error: " in done.stderr
    assert "A_t/c/0/0 has " in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--check", "nowhere"], "holds no sweep"),
        (["--check", "o", "--out", "o"], "--check DIR stands alone"),
        ([], "STUDY.toml is missing"),
        (["study.toml"], "--out DIR is missing"),
    ],
)
def test_mistakes_of_the_command(words, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = command(*words)
    assert done.exit_code == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())
