"""Workbook, CSV, JSON and what is printed: the same digits, of every template."""

import csv
import json
import math
import re
from decimal import Decimal

import pytest

from thirdbody.cli.commands.new import KINDS
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.quantities.say import NOT_KNOWN, number, percent, value_of

from .test_cli import run

openpyxl = pytest.importorskip("openpyxl", reason="needs the extra: pip install 'thirdbody[xlsx]'")

SIZES = {
    "": "1", "N": "1", "nm": "1e-9", "µm": "1e-6", "mm": "1e-3", "m": "1", "Pa": "1", "kPa": "1e3",
    "MPa": "1e6", "GPa": "1e9", "%": "0.01", "m/s": "1",
}  # fmt: skip
HELD = 1e-15
"""A workbook holds sixteen digits."""
SUPERSCRIPTS = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "400")
    return tmp_path


def si(text):
    """A printed number with its unit, in SI, to the last digit; None for words."""
    found = re.fullmatch(r"([−\d.]+)(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))? ?(.*)", text)
    if found is None or found[3] not in SIZES:
        return None
    power = Decimal(10) ** int((found[2] or "0").translate(SUPERSCRIPTS))
    return Decimal(found[1].translate(SUPERSCRIPTS)) * power * Decimal(SIZES[found[3]])


def shown(cell):
    """What a spreadsheet shows of a cell."""
    if not isinstance(cell.value, (int, float)):
        return cell.value
    form = cell.number_format
    if form.startswith('"'):
        return form.strip('"')
    plain, share = form.removesuffix(" %"), form.endswith(" %")
    value = cell.value * 100 if share else cell.value
    decimals = len(plain.partition("E")[0].partition(".")[2])
    return f"{value:.{decimals}{'E' if 'E' in plain else 'f'}}{' %' if share else ''}"


def shown_in_si(head, cell):
    """The same in SI: its unit stands in the head."""
    text = shown(cell)
    unit = re.search(r"\[(.*)\]", head or "")
    share = text.endswith(" %")
    try:
        return Decimal(text.removesuffix(" %")) * Decimal(
            SIZES["%" if share else unit[1] if unit else ""]
        )
    except ArithmeticError:
        return None


def printed_table(text, first):
    """Heads and rows of the table whose first head is ``first``."""
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if re.match(rf"\s+{re.escape(first)}\s\s", line))
    heads = re.split(r"\s{2,}", lines[at].strip())
    rows = []
    for line in lines[at + 2 :]:
        if not line.strip():
            break
        rows.append(re.split(r"\s{2,}", line.strip()))
    return heads, rows


def grid(sheet, first):
    """The same of a sheet: heads, and rows of cells."""
    start = next(
        row for row in sheet.iter_rows() if str(row[0].value or "").split(" [")[0] == first
    )
    heads = [cell.value for cell in start if cell.value is not None]
    rows = []
    for row in sheet.iter_rows(min_row=start[0].row + 1):
        if row[0].value is None:
            break
        rows.append(row[: len(heads)])
    return heads, rows


def compare_tables(printed, drawn, *, most=20):
    heads, rows = printed
    names, cells = drawn
    assert [name.split(" [")[0] for name in names] == heads
    assert len(rows) == min(len(cells), most)
    every = cells if len(cells) <= most else [
        cells[round(i * (len(cells) - 1) / (most - 1))] for i in range(most)
    ]  # fmt: skip
    for told, held in zip(rows, every, strict=True):
        for text, name, cell in zip(told, names, held, strict=True):
            text = re.sub(r"(?<=\d)\s(?=\d{3}\b)", "", text)  # thousands
            if (value := si(text)) is None:
                unit = name.partition(" [")[2].removesuffix("]")
                # a bound is held as it is printed
                assert text in (shown(cell), f"{shown(cell)} {unit}".rstrip())
            else:
                assert isinstance(cell.value, (int, float)), (name, text)
                assert shown_in_si(name, cell) == value, (name, text)


def compare_data(table, sheet, states):
    """CSV against the sheet and JSON: the whole number, to the sixteen digits of a workbook."""
    head, *rows = csv.reader(table.open(encoding="utf-8"))
    held = [[cell.value for cell in row] for row in sheet.iter_rows()]
    assert held[0] == head
    assert len(held) == len(rows) + 1
    for place, name in enumerate(head):
        bare = name.partition(" [")[0]
        for i, row in enumerate(rows):
            text, cell = row[place], held[i + 1][place]
            value = states[bare][i] if bare in states else cell
            if text == "":
                assert cell is None
                assert value is None or value == ""
            elif isinstance(cell, str):
                assert text == cell == value
            else:
                assert bare not in states or float(text) == value, name
                assert cell == pytest.approx(float(text), rel=HELD, abs=0), name
                assert shown(sheet.cell(i + 2, place + 1)) == spelled_out(text)


def spelled_out(text):
    """A number of a CSV file to four digits, as a spreadsheet spells its power."""
    if text.lstrip("-").isdecimal():
        return text
    digits, power, tens = f"{float(text):.4g}".partition("e")
    return f"{digits}{power.upper()}{tens}"


@pytest.mark.spread(3)
@pytest.mark.parametrize("kind", KINDS)
def test_every_template(kind, folder):
    study = folder / f"{kind}.toml"
    made = run("new", kind)
    assert made.exit_code == 0
    if made.stdout.split()[1] != "solve":
        pytest.skip("has no states")
    files = {end: folder / f"a.{end}" for end in ("json", "xlsx", "csv")}
    named = [word for end, file in files.items() for word in (f"--{end}", file)]
    done = run("solve", study, *named)
    assert done.exit_code == 0, done.output
    assert sorted(each.name for each in folder.iterdir()) == sorted(
        [study.name, *(file.name for file in files.values())]
    )
    printed = run("solve", study)
    book = openpyxl.load_workbook(files["xlsx"])
    assert book.sheetnames == ["Answer", "States", "Inputs", "Notes"]
    data = json.loads(files["json"].read_text("utf-8"))
    compare_data(files["csv"], book["States"], data["states"])
    compare_tables(printed_table(printed.stdout, "F*"), grid(book["Answer"], "F*"))
    told = " ".join(printed.stdout.split())
    for cell, *_ in book["Answer"].iter_rows(min_row=3, max_col=1):
        if cell.value is None or str(cell.value).startswith("F*"):
            break
        for sentence in str(cell.value).split(". "):
            assert sentence in told
    first = data["states"]
    for row, h, share in zip(
        printed_table(printed.stdout, "F*")[1], first["h"], first["particle_load_share"],
        strict=False,
    ):  # fmt: skip
        if len(first["h"]) <= 20:
            assert value_of(h, "m") in row
            assert share is None or kind == "two-body" or percent(share) in row


@pytest.mark.check
def test_a_film(folder):
    run("new", "rolling-bearing")
    named = ("--json", "a.json", "--xlsx", "a.xlsx", "--csv", "a.csv")
    done = run("film", "rolling-bearing.toml", *named)
    assert done.exit_code == 0, done.output
    book = openpyxl.load_workbook("a.xlsx")
    data = json.loads((folder / "a.json").read_text("utf-8"))
    compare_data(folder / "a.csv", book["States"], data["states"])
    compare_tables(printed_table(done.stdout, "speed"), grid(book["Answer"], "speed"))
    run("film", "rolling-bearing.toml", "--set", "film.speed=0.5 m/s", "--xlsx", "b.xlsx")
    one = openpyxl.load_workbook("b.xlsx")["Answer"]
    told = run("film", "rolling-bearing.toml", "--set", "film.speed=0.5 m/s").stdout
    heads, rows = grid(one, "at this speed")
    assert heads[1:] == ["value", "unit"]
    for name, value, unit in rows[1:]:
        (line,) = (line for line in told.splitlines() if line.strip().startswith(name.value + "  "))
        text = line.strip().removeprefix(name.value).strip()
        if (amount := si(text)) is None:
            assert text in (value.value, NOT_KNOWN, f"{shown(value)} {unit.value or ''}".strip())
        else:
            assert shown_in_si(f"[{unit.value or ''}]", value) == amount


@pytest.mark.check
@pytest.mark.parametrize("fine", [(), ("--filter", "5=75, 10=1000")], ids=["as it is", "filter"])
def test_what_the_oil_does_is_in_numbers(folder, fine):
    """The populations and the balls of a bearing: numbers in one unit, as they are printed."""
    run("new", "ball-bearing")
    done = run("film", "ball-bearing.toml", "--xlsx", "a.xlsx", *fine)
    assert done.exit_code == 0, done.output
    (book,) = (openpyxl.load_workbook("a.xlsx")["Answer"],)
    heads, rows = grid(book, "place")
    printed = printed_table(run("film", "ball-bearing.toml").stdout, "place")[1]
    assert heads[1:4] == ["load [N]", "p_0 inner [GPa]", "p_0 outer [GPa]"]
    for told, held in zip(printed, rows, strict=True):
        assert [shown_in_si(heads[i], held[i]) for i in (1, 2, 3)] == [
            si(told[i]) for i in (1, 2, 3)
        ]
    if not fine:
        heads, rows = grid(book, "population")
        assert heads[4:] == ["depth [nm]", "5 % above [nm]", "deepest [µm]", "width [µm]"]
        assert {row[0].value: row[4].value for row in rows} == {"dust": 397, "steel debris": 51}
        return
    held = {row[0].value: [cell.value for cell in row[1:3]] for row in book.iter_rows()}
    assert held["dust: depth [nm]"] == [397, 300]
    assert held["dust: deepest of an hour [nm]"] == [3750, 567]
    assert held["ISO 4406 code"] == ["18/16/13", "13/9/3"]


def test_what_a_cell_shows_is_what_is_printed():
    """Numbers of every size, rounded up and down, and shares near nothing and the whole."""
    from thirdbody.views.columns import Cell
    from thirdbody.views.workbook import Grid, Sheet, workbook_bytes

    values = [
        s * m * 10.0**p for s in (1, -1) for m in (1, 1.23449, 9.99951, 5.5) for p in range(-9, 9)
    ]
    shares = [0.0, 1e-9, 1e-4, 0.1234, 0.99951, 0.99996, 1.0]
    rows = [(Cell(v, number(v)), Cell(v, percent(v, least=1e-6))) for v in (*values, *shares)]
    (sheet,) = load(workbook_bytes([Sheet("Table", (Grid(("a", "b"), rows),))]))
    for row, value in zip(sheet.iter_rows(min_row=2), (*values, *shares), strict=True):
        assert row[0].value == pytest.approx(value, rel=HELD, abs=0)
        assert shown_in_si("", row[0]) == si(number(value))
        text = percent(value, least=1e-6)
        assert shown(row[1]) == text if text.startswith("<") else (
            shown_in_si("", row[1]) == si(text)
        )  # fmt: skip


def load(held):
    import io

    return openpyxl.load_workbook(io.BytesIO(held)).worksheets


def test_a_workbook_is_laid_out_for_a_reader(folder):
    """Sheets with units in their heads, heads that stay, widths, a picture; words are no formula."""
    run("new", "ball-screw")
    title = folder / "ball-screw.toml"
    title.write_text(re.sub(r"(?m)^title.*", 'title = "=1+1"', title.read_text("utf-8")), "utf-8")
    for name in ("a.xlsx", "b.xlsx"):
        assert run("solve", title, "--xlsx", name).exit_code == 0
    assert (folder / "a.xlsx").read_bytes() == (folder / "b.xlsx").read_bytes()
    book = openpyxl.load_workbook("a.xlsx")
    answer, states, inputs, notes = book.worksheets
    assert answer["A1"].value.startswith("=1+1 (thirdbody")
    assert answer["A1"].data_type == "s"
    assert len(answer._images) == 1
    assert (states.freeze_panes, inputs.freeze_panes, notes.freeze_panes) == ("B2", "A2", "A2")
    heads = [cell.value for cell in states[1]]
    assert {"h [m]", "pressure [Pa]", "A_t [1]"} <= set(heads)
    for place, head in enumerate(heads):
        width = states.column_dimensions[openpyxl.utils.get_column_letter(place + 1)].width
        assert width > len(head)
    rows = {row[5]: row for row in inputs.iter_rows(min_row=2, values_only=True) if row[5]}
    assert rows["body.diameter"][2:5] == (pytest.approx(6.35), "mm", "study")
    assert rows["load.force"][2:4] == (2000.0, "N")
    assert rows["asperity_law.k"][4] == "default"
    actions = [row[2] for row in notes.iter_rows(min_row=2, max_row=3, values_only=True)]
    assert any(actions), "no note says what to do"
    told = {row[0]: row[1:3] for row in notes.iter_rows(values_only=True)}
    assert told["h"] == ("m", COLUMNS["h"].meaning)
    assert not math.isnan(answer.row_dimensions[3].height)


def test_of_many_states_the_answer_shows_some(folder):
    """And one sheet that cannot hold them is refused in one line, with no file."""
    from thirdbody.cli import streams

    run("new", "two-body")
    many = ("--set", "load.pressure={from=1e5, to=1e8, points=150, spacing='log'}")
    done = run("solve", "two-body.toml", *many, "--xlsx", "a.xlsx", "--csv", "a.csv")
    assert done.exit_code == 0, done.output
    book = openpyxl.load_workbook("a.xlsx")
    _, rows = grid(book["Answer"], "F*")
    assert len(rows) == 100
    assert any("100 of 150 states" in str(row[0].value) for row in book["Answer"].iter_rows())
    assert len(list(book["States"].iter_rows())) == 151
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(streams, "MOST_IN_A_SHEET", 149)
        more = run("solve", "two-body.toml", *many, "--xlsx", "b.xlsx", "--csv", "b.csv")
    assert more.exit_code == 2
    assert "150 rows, and a sheet holds 149; take --csv or --parquet" in more.stderr
    assert not list(folder.glob("b.*"))
