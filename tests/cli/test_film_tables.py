"""What the tables and heads of `thirdbody film` say beside the states: dents, life, what was set."""

import csv
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from thirdbody import cli

FILTER = "5=75, 10=1000"


def run(*arguments):
    done = CliRunner().invoke(cli.app, [str(argument) for argument in arguments])
    assert done.exit_code == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def bearing(tmp_path_factory):
    file = tmp_path_factory.mktemp("bearing") / "b.toml"
    run("new", "ball-bearing", "6205", "--out", file)
    return file


def rows_of(file: Path):
    with file.open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


@pytest.mark.check
def test_dents_and_life_stand_in_the_table_under_the_names_of_the_json(bearing, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    table, book, data = (tmp_path / f"f.{kind}" for kind in ("csv", "xlsx", "json"))
    run("film", bearing, "--filter", FILTER, "--csv", table, "--xlsx", book, "--json", data)
    (row,) = rows_of(table)
    found = json.loads(data.read_text())
    sheets = openpyxl.load_workbook(book)
    heads, cells = ([cell.value for cell in line] for line in sheets["States"].iter_rows())
    in_book = dict(zip(heads, cells, strict=True))
    for before, oil in (("", found["oil"]), ("oil_filtered: ", found["oil_filtered"])):
        for part in oil["populations"]:
            for name, unit in (("per_hour", "1/h"), ("depth", "m"), ("depth_p95", "m")):
                head = f"{before}{part['name']}: {name} [{unit}]"
                assert float(row[head]) == part[name]
                assert in_book[head] == pytest.approx(part[name], rel=1e-12)
        for name in ("a_ISO", "e_C"):
            assert float(row[f"{before}{name} [1]"]) == oil["life"][name]
            assert in_book[f"{before}{name} [1]"] == pytest.approx(oil["life"][name], rel=1e-12)
    meanings = {row[0].value: row[2].value for row in sheets["Notes"].iter_rows(min_col=1)}
    assert meanings["dust: per_hour"]
    assert meanings["oil_filtered: a_ISO"]


def test_of_several_speeds_the_row_of_the_answer_holds_the_dents(bearing, tmp_path):
    table, data = tmp_path / "f.csv", tmp_path / "f.json"
    run("film", bearing, "--set", "film.speed=[1, 2.8952390679116395, 5]", "--csv", table,
        "--json", data)  # fmt: skip
    oil = json.loads(data.read_text())["oil"]
    rows = rows_of(table)
    told = [i for i, row in enumerate(rows) if row["a_ISO [1]"]]
    assert [float(rows[i]["speed [m/s]"]) for i in told] == [oil["speed"]]


def test_without_an_oil_the_table_has_no_column_of_it(bearing, tmp_path):
    table = tmp_path / "f.csv"
    text = bearing.read_text().partition("[[particles]]")[0]
    clean = tmp_path / "clean.toml"
    clean.write_text(text)
    run("film", clean, "--csv", table)
    (row,) = rows_of(table)
    assert not [head for head in row if "per_hour" in head or "a_ISO" in head]


@pytest.mark.check
def test_the_head_says_what_was_set_over_the_file(bearing, tmp_path, monkeypatch, blank_pictures):
    openpyxl = pytest.importorskip("openpyxl")
    for part in ("_assess", "_slopes"):  # most of a report, and no part of its head
        monkeypatch.setattr(f"thirdbody.views.report.make.{part}", lambda *_: None)
    told = "with body.ring = outer and load.force = 1 kN"
    settings = ("--set", 'body.ring="outer"', "--set", "load.force=1 kN")
    book, page = tmp_path / "f.xlsx", tmp_path / "r.html"
    assert told in " ".join(run("film", bearing, *settings, "--xlsx", book).split())
    assert told in openpyxl.load_workbook(book)["Answer"]["A1"].value
    assert told in " ".join(run("solve", bearing, *settings).split())
    run("report", bearing, *settings, "--out", page)
    assert f"{told}</h1>" in page.read_text()
    assert "with" not in run("film", bearing).splitlines()[0]


@pytest.mark.parametrize(
    ("command", "kind", "setting"),
    [
        ("life", "oil-circuit", "life.duration=100 h"),
        ("plate", "wafer-chuck", "plate.thickness=700 um"),
        ("probability", "connector", "connector.force=0.4 N"),
    ],
)
def test_heads_of_questions_say_it_too(tmp_path, command, kind, setting):
    file = tmp_path / "s.toml"
    run("new", kind, "--out", file)
    key, _, value = setting.partition("=")
    assert f"with {key} = {value}" in " ".join(run(command, file, "--set", setting).split())


@pytest.mark.check
def test_shares_too_small_to_be_read_are_numbers_in_the_workbook(bearing, tmp_path):
    """Where the screen says "< 0.0001 %", the cell holds the share and shows the words."""
    openpyxl = pytest.importorskip("openpyxl")
    book, data = tmp_path / "f.xlsx", tmp_path / "f.json"
    run("film", bearing, "--xlsx", book, "--json", data)
    parts = json.loads(data.read_text())["oil"]["populations"]
    cells = [cell for row in openpyxl.load_workbook(book)["Answer"].iter_rows() for cell in row]
    assert not [cell.value for cell in cells if str(cell.value).startswith("<")]
    small = [cell.value for cell in cells if cell.number_format == '"< 0.0001 %"']
    shares = [part["load_share"] for part in parts if part["load_share"] < 1e-6]
    assert len(shares) >= 2
    for share in shares:  # openpyxl writes 16 digits
        assert any(value == pytest.approx(share, rel=1e-15, abs=0) for value in small)
