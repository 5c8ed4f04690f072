"""Workbooks and Parquet beside CSV: the same numbers, the same bytes, whole or not at all."""

import csv
import errno
import importlib.util
import json
import os
import zipfile

import pytest
from command_line import refused

import thirdbody
from thirdbody.cli import streams
from thirdbody.errors import Mistake
from thirdbody.results import Status

from .test_cli import EXAMPLES, run

ADDITIVE, FILM, SWEEP, DEBRIS = (
    next(path for path in EXAMPLES if path.stem == stem)
    for stem in ("additive", "oil_film", "sweep", "dust_and_debris")
)
LIBRARY = {"xlsx": "openpyxl", "parquet": "pyarrow"}
COMMANDS = [
    ("solve", SWEEP, "--set", "load.pressure=[1e6, 1e16]"),
    ("film", FILM, "--set", "film.speed.points=3"),
    ("surface", "example"),
    ("compare", SWEEP, "--laws", "all", "--set", "load.pressure=[1e6, 5e8]"),
]


def read(path):
    import pandas

    if path.suffix != ".xlsx":
        return pandas.read_parquet(path)
    from openpyxl import load_workbook

    names = load_workbook(path, read_only=True).sheetnames
    return pandas.read_excel(path, sheet_name="States" if "States" in names else "Table")


def test_the_last_column_of_states_is_the_code_of_their_status(tmp_path):
    table = tmp_path / "t.csv"
    done = run("solve", DEBRIS, "--set", "load.pressure=[1e6, 1e16]", "--csv", table, "--json")
    head, *rows = csv.reader(table.open(encoding="utf-8"))
    assert head[-1] == "status_code"
    codes = [int(row[-1]) for row in rows]
    assert codes == json.loads(done.stdout)["states"]["status_code"]
    assert codes == [Status.OK, Status.TOO_MUCH]


def test_the_states_of_a_film_have_the_code_of_their_status(tmp_path):
    table = tmp_path / "t.csv"
    done = run("film", FILM, "--set", "film.speed.points=2", "--csv", table, "--json")
    codes = [int(row["status_code"]) for row in csv.DictReader(table.open(encoding="utf-8"))]
    assert codes == json.loads(done.stdout)["states"]["status_code"] == [Status.OK] * 2


def test_a_comparison_in_json_holds_the_rows_of_its_table(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run("compare", SWEEP, "--laws", "ke,jg", "--csv", "t.csv", "--json")
    told = json.loads(done.stdout)
    head, *rows = csv.reader((tmp_path / "t.csv").open(encoding="utf-8"))
    assert [name.split(" [")[0] for name in head] == list(told["states"])
    assert [row[0] for row in rows] == told["states"]["law"]
    assert [float(row[head.index("A_t [1]")]) for row in rows] == told["states"]["A_t"]
    assert list(told["laws"]) == [told["own_law"], "ke", "jg"]
    assert [note["sentence"] for note in told["notes"]] == told["warnings"]
    for _ in range(2):  # its own file may be replaced
        assert run("compare", SWEEP, "--laws", "ke,jg", "--json", "a.json").exit_code == 0
        assert json.loads((tmp_path / "a.json").read_text("utf-8")) == told


@pytest.mark.check
@pytest.mark.parametrize("kind", LIBRARY)
@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: arguments[0])
def test_the_numbers_of_the_csv_file(tmp_path, kind, arguments):
    """Cells without a value, of a state that is not solved, stay empty."""
    pytest.importorskip(LIBRARY[kind], reason=f"needs the extra: pip install 'thirdbody[{kind}]'")
    text, table, again = tmp_path / "t.csv", tmp_path / f"t.{kind}", tmp_path / f"u.{kind}"
    done = run(*arguments, "--csv", text, f"--{kind}", table)
    assert done.exit_code == 0, done.output
    assert str(table) in done.stderr
    head, *rows = csv.reader(text.open(encoding="utf-8"))
    found = read(table)
    assert list(found.columns) == head
    assert len(found) == len(rows)
    for name, column in zip(head, zip(*rows, strict=True), strict=True):
        for told, value in zip(column, found[name], strict=True):
            if told == "":
                assert value is None or value != value, name
            elif isinstance(value, str):
                assert value == told
            else:
                assert float(value) == pytest.approx(float(told), rel=1e-15), name
    run(*arguments, f"--{kind}", again)
    assert again.read_bytes() == table.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        ["t.csv", f"t.{kind}", f"u.{kind}"]
    )


def test_a_workbook_tells_no_time(tmp_path):
    pytest.importorskip("openpyxl", reason="needs the extra: pip install 'thirdbody[xlsx]'")
    run("surface", "example", "--xlsx", tmp_path / "t.xlsx")
    with zipfile.ZipFile(tmp_path / "t.xlsx") as book:
        assert {entry.date_time[0] for entry in book.infolist()} == {1980}
        assert b"T00:00:00Z" in book.read("docProps/core.xml")
        assert book.read("docProps/core.xml").count(b"1980-01-01") == 2


@pytest.mark.parametrize("kind", LIBRARY)
@pytest.mark.parametrize(
    "arguments", [*COMMANDS, ("design", ADDITIVE)], ids=lambda arguments: arguments[0]
)
def test_a_missing_library_is_told_before_work(tmp_path, monkeypatch, kind, arguments):
    found = importlib.util.find_spec
    monkeypatch.setattr(
        streams.importlib.util,
        "find_spec",
        lambda name, *more: None if name == LIBRARY[kind] else found(name, *more),
    )
    done = run(*arguments, f"--{kind}", tmp_path / f"t.{kind}")
    assert done.exit_code == 2
    errors = [line for line in done.stderr.splitlines() if line.startswith("error")]
    assert len(errors) == 1
    assert f"pip install 'thirdbody[{kind}]'" in errors[0]
    assert done.stdout == ""
    assert not list(tmp_path.iterdir())


def test_a_file_that_fails_leaves_the_older_one(tmp_path, monkeypatch):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow", reason="needs the extra: pip install 'thirdbody[parquet]'")
    older = tmp_path / "t.parquet"
    older.write_bytes(b"older")

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pandas.DataFrame, "to_parquet", full)
    done = run("surface", "example", "--parquet", older, "--force")
    assert done.exit_code == 2
    assert os.strerror(errno.ENOSPC).lower() in done.stderr.lower()
    assert older.read_bytes() == b"older"
    assert [path.name for path in tmp_path.iterdir()] == ["t.parquet"]


@pytest.mark.check
def test_files_of_a_run_appear_together_or_not_at_all(tmp_path, monkeypatch):
    """The last of four cannot be written: an older one stays, and no other appears."""
    pandas = pytest.importorskip("pandas")
    for library in LIBRARY.values():
        pytest.importorskip(library)
    names = [tmp_path / f"t.{end}" for end in ("csv", "json", "xlsx", "parquet")]
    options = [word for name in names for word in (f"--{name.suffix[1:]}", name)]
    assert run("solve", SWEEP, *options[:2]).exit_code == 0
    older = names[0].read_bytes()

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pandas.DataFrame, "to_parquet", full)
    done = run("solve", SWEEP, "--set", "load.pressure=2e6", *options)
    assert done.exit_code == 2
    assert os.strerror(errno.ENOSPC).lower() in done.stderr.lower()
    assert [path.name for path in tmp_path.iterdir()] == ["t.csv"]
    assert names[0].read_bytes() == older
    monkeypatch.undo()
    assert run("solve", SWEEP, "--set", "load.pressure=2e6", *options).exit_code == 0
    assert sorted(tmp_path.iterdir()) == sorted(names)
    assert names[0].read_bytes() != older
    again = run("solve", SWEEP, *options)
    assert again.exit_code == 0, again.output
    names[1].write_text('{"mine": 1}')
    (problem,) = refused("solve", SWEEP, *options).problems
    assert problem.code is Mistake.UNWRITABLE
    assert str(names[1]) in problem


def test_json_goes_to_the_output_or_into_a_file(tmp_path):
    """Beside any other file; and what follows --json is its file only where it says so."""
    printed = run("solve", "--json", SWEEP, "--csv", tmp_path / "t.csv")
    assert printed.exit_code == 0, printed.output
    for name in (["--json", tmp_path / "t.json"], [f"--json={tmp_path / 'u.json'}"]):
        kept = run("solve", SWEEP, *name, "--csv", tmp_path / "v.csv")
        assert kept.exit_code == 0, kept.output
        assert kept.stdout == run("solve", SWEEP).stdout
    assert (tmp_path / "t.json").read_text("utf-8") == printed.stdout
    assert (tmp_path / "u.json").read_text("utf-8") == printed.stdout
    assert (tmp_path / "t.csv").read_bytes() == (tmp_path / "v.csv").read_bytes()


@pytest.mark.check
@pytest.mark.usefixtures("short_search")
def test_points_of_a_design_have_units(tmp_path):
    file = tmp_path / "points.csv"
    easy = ("--set", "design.points=4", "--set", "design.limits=[]")
    done = run("design", ADDITIVE, *easy, "--csv", file)
    assert done.exit_code == 0, done.output
    assert "smallest" in done.output  # what is sought
    head, *_ = csv.reader(file.open(encoding="utf-8"))
    assert head == [
        "particles.diameter.mean+particles.diameter.std [m]",
        "particles.concentration [1]",
        "mu [1]",
        "feasible",
        "front",
        "reason",
    ]


@pytest.mark.check
@pytest.mark.parametrize("design", ["sampled", "reduced"])
def test_a_sweep_has_tables_beside_its_folder(tmp_path, design):
    """The numbers of the folder, modes in words; a table that nobody reads is refused before."""
    openpyxl = pytest.importorskip("openpyxl", reason="pip install 'thirdbody[xlsx]'")
    zarr = pytest.importorskip("zarr", reason="pip install 'thirdbody[sweep]'")
    study, text = tmp_path / "study.toml", SWEEP.read_text("utf-8")
    study.write_text(text if design == "reduced" else text.partition("[sweep.reduce]")[0], "utf-8")
    out, csv_file, book = tmp_path / "out", tmp_path / "t.csv", tmp_path / "t.xlsx"
    done = run("sweep", study, "--out", out, "--csv", csv_file, "--xlsx", book)
    assert done.exit_code == 0, done.output
    held = zarr.open(out / "states.zarr", mode="r")
    rows = list(csv.DictReader(csv_file.open(encoding="utf-8")))
    name = "h [m]" if design == "sampled" else "h_quantile [m]"
    assert [float(row[name]) for row in rows] == held[name[:-4]][:].ravel().tolist()
    sheets = openpyxl.load_workbook(book)
    assert sheets.sheetnames == ["Answer", "States", "Notes"]
    told, answer = (cell.value for cell in sheets["Answer"]["A"] if cell.value)
    assert study.name in told
    assert f"(thirdbody {thirdbody.__version__})" in told
    assert answer in " ".join(done.stdout.split())
    assert [cell.value for cell in sheets["States"][1]] == list(rows[0])
    if design == "sampled":
        assert {row["status"] for row in rows} == {"ok"}
        assert {int(row["status_code"]) for row in rows} == {Status.OK}
        assert {row["mode"] for row in rows} <= {"p-s", "hybrid", "s-s"}
        big = run("sweep", study, "--out", tmp_path / "big", "--csv", tmp_path / "b.csv",
                  "--set", "sweep.samples=65536")  # fmt: skip
        assert big.exit_code == 2
        assert "would have 196,608 rows" in big.stderr
        assert not (tmp_path / "big").exists()
    again = run("sweep", study, "--out", out, "--csv", csv_file, "--xlsx", tmp_path / "u.xlsx")
    assert again.exit_code == 0, again.output
    assert (tmp_path / "u.xlsx").read_bytes() == book.read_bytes()
