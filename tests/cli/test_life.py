"""``thirdbody life``: an oil over time from the shell, and what reports of it say."""

import csv
import dataclasses
import json
import re
from pathlib import Path

import numpy as np
import pytest
from command_line import refused

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.study.run_life import load_circuit, load_life, reports_of, run_life
from thirdbody.systems.life.report_notes import below_counts, beyond_counts
from thirdbody.systems.life.sizing import least_flow
from thirdbody.views.html import words as words_in_html
from thirdbody.views.life_amounts import duration_of
from thirdbody.views.life_words import HEADS, answer, last_words
from thirdbody.views.report import report

from .life_shell import CONTACT, HOUR, complained, enter, run, said, setting


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    enter(tmp_path, monkeypatch)
    assert run("new", "oil-circuit").exit_code == 0
    return tmp_path


# ------------------------------------------------------------------------------ the history
def test_codes_flows_and_events_are_told():
    told = said(run("life", "oil-circuit.toml"))
    found = run_life(load_life("oil-circuit.toml"))
    history = found.history
    sentences, last = answer(found), last_words(found)
    assert sentences[0] == f"The oil goes from {history.codes[0]} to {history.codes[-1]} in 2000 h."
    assert history.steady()[0].code in sentences[1]
    for time in history.code_times:
        assert duration_of(time, 2) in sentences[1]
    assert {each.name for each in history.events} == {"filter full", "oil change"}
    for event in history.events:
        assert duration_of(event.time) in " ".join(last)
        assert event.sentence in told
    assert history.time_scales["oil through the filters once"] == pytest.approx(
        200
    )  # 200 L, 60/min
    for name, time in history.time_scales.items():
        assert f"{name} {duration_of(time)}" in last[-2]
    # the answer, the table, and then what happened
    first, table, rest = (told.index(" ".join(each)) for each in (sentences, HEADS, last))
    assert first < table < rest


def test_every_line_fits_80_columns():
    assert max(map(len, run("life", "oil-circuit.toml").stdout.splitlines())) <= 80


def test_json_and_csv_hold_the_same_numbers():
    done = run("life", "oil-circuit.toml", "--json", "--csv", "rows.csv")
    data = json.loads(done.stdout)
    with Path("rows.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["time [s]"]) for row in rows] == data["times"]
    assert [row["code"] for row in rows] == data["codes"]
    counts = np.array(data["counts"])
    assert [float(row["n_4 [1/m^3]"]) for row in rows] == counts[:, 0].tolist()
    assert {"title", "version", "inputs", "ledger", "flows", "steady", "warnings"} <= data.keys()
    assert data["ledger"]["residual"] < 1e-9
    assert data["R0"] == 0


def test_the_flow_table_balances():
    data = json.loads(run("life", "oil-circuit.toml", "--json").stdout)
    came = sum(row["kg"] for row in data["flows"] if row["to"] == "oil")
    went = sum(row["kg"] for row in data["flows"] if row["from"] == "oil")
    stored = data["ledger"]["in the oil"][-1] - data["ledger"]["in the oil"][0]
    assert came - went == pytest.approx(stored, abs=1e-9 * came)


def test_the_table_alone_is_enough():
    """An oil needs no surfaces."""
    text = Path("oil-circuit.toml").read_text("utf-8").split("# The contact that")[0]
    Path("short.toml").write_text(text, "utf-8")
    assert run("life", "short.toml").stdout == run("life", "oil-circuit.toml").stdout
    assert (Mistake.MISSING, "surfaces") in refused("solve", "short.toml").mistakes


def test_what_is_waited_for_ends_it():
    asked = load_life("oil-circuit.toml", ['life.until.iso4406="16/14/11"'])
    history = run_life(asked).history
    assert history.times[-1] < HOUR
    assert "16" in history.codes[-1]
    assert (history.codes[0], history.events[-1].name) == ("20/18/15", "code 16/14/11")
    keys = setting("life.until.filter_full=true")
    events = json.loads(run("life", "oil-circuit.toml", *keys, "--json").stdout)["events"]
    assert [event["name"] for event in events] == ["filter full"]
    (full,) = run_life(
        load_life("oil-circuit.toml", ["life.until.filter_full=true"])
    ).history.events
    assert events[0]["time"] == full.time


def test_a_count_that_grows_for_ever_is_told():
    Path("one.toml").write_text(
        Path("oil-circuit.toml").read_text("utf-8")
        .replace('beta = { "2 um" = 2, "4 um" = 5, "7 um" = 75, "14 um" = 1000 }', 'beta = { "6 um" = 75 }')
        .replace('settling_area = "0.5 m^2"', "")
    )  # fmt: skip
    (steady,) = json.loads(run("life", "one.toml", "--json").stdout)["steady"]
    assert steady["code"].startswith("-/")
    assert "4 µm" in answer(run_life(load_life("one.toml")))[1]


@pytest.mark.check
def test_the_figure_is_drawn_and_files_of_others_stay():
    assert run("life", "oil-circuit.toml", "--figure", "oil.png").exit_code == 0
    assert Path("oil.png").read_bytes()[:4] == b"\x89PNG"
    Path("mine.csv").write_text("mine")
    done = run("life", "oil-circuit.toml", "--csv", "mine.csv")
    assert (done.exit_code, Path("mine.csv").read_text()) == (2, "mine")


def test_the_same_study_gives_the_same_bytes():
    first, second = (run("life", "oil-circuit.toml", "--json").stdout for _ in "ab")
    assert first == second


# ------------------------------------------------------------------------------ reports
CODES = "time [h],ISO 4406\n0,20/18/15\n250,16/13/10\n500,16/14/10\n750,16/13/10\n"


def test_reports_say_what_enters():
    Path("oil.csv").write_text(CODES)
    told = said(run("life", "oil-circuit.toml", "--reports", "oil.csv"))
    found = reports_of(load_circuit("oil-circuit.toml"), "oil.csv").reports
    assert f"{3600e6 * found.mass_rate:.3g} mg/h" in told
    assert f"χ² = {found.chi2:.3g}" in told
    assert "4 µm" in told.split("lowest")[1]
    data = json.loads(run("life", "oil-circuit.toml", "--reports", "oil.csv", "--json").stdout)
    assert data["rate"] == found.rate.tolist()
    assert data["is_constant"] is True


def test_two_reports_cannot_say_whether_it_is_constant():
    Path("oil.csv").write_text("".join(CODES.splitlines(keepends=True)[:3]))
    assert reports_of(load_circuit("oil-circuit.toml"), "oil.csv").reports.is_constant is None
    done = run("life", "oil-circuit.toml", "--reports", "oil.csv", "--json")
    assert json.loads(done.stdout)["is_constant"] is None


def test_a_study_takes_its_ingress_from_reports():
    Path("oil.csv").write_text(CODES)
    text = Path("oil-circuit.toml").read_text("utf-8")
    old = 'ingress  = { test_dust = "A3-lot", rate = "125 mg/h" }'
    assert old in text
    Path("from.toml").write_text(text.replace(old, 'ingress = { reports = "oil.csv" }'), "utf-8")
    done = run("life", "from.toml", "--json")
    assert json.loads(done.stdout)["steady"][0]["code"].startswith("16/1")
    assert any(each.startswith("life.oil.ingress: ") for each in done.remarks)


def test_the_mass_of_reports_says_what_it_leaves_out():
    Path("oil.csv").write_text(CODES)
    told = said(run("life", "oil-circuit.toml", "--reports", "oil.csv"))
    found = reports_of(load_circuit("oil-circuit.toml"), "oil.csv").reports
    assert found.coded
    for sentence in (below_counts(found), beyond_counts(found)):
        assert sentence in told
    assert "4 µm" in below_counts(found)
    assert "14 µm" in beyond_counts(found)
    text = Path("oil-circuit.toml").read_text("utf-8")
    old = 'ingress  = { test_dust = "A3-lot", rate = "125 mg/h" }'
    Path("from.toml").write_text(text.replace(old, 'ingress = { reports = "oil.csv" }'), "utf-8")
    (remark,) = (r for r in run("life", "from.toml").remarks if r.startswith("life.oil.ingress: "))
    assert remark.count("below 4 µm") == 1
    assert "7.2 % to 48 %" in remark


def test_counts_in_a_file_are_no_codes_and_may_be_0():
    Path("oil.csv").write_text(
        "time [h],4 um [1/mL],6 um [1/mL],14 um [1/mL]\n"
        "0,5000,1300,40\n250,600,100,0\n500,650,110,0\n"
    )
    told = said(run("life", "oil-circuit.toml", "--reports", "oil.csv"))
    found = reports_of(load_circuit("oil-circuit.toml"), "oil.csv").reports
    assert (found.coded, found.degrees, np.sum(found.counts == 0)) == (False, 1, 2)
    assert f"{found.width**0.5:.2g}" == "1.4"
    assert " 1.4." in told
    assert "1 /mL" in told
    assert "4 um [1/mL]" in said(run("life", "--help"))


def test_every_mistake_of_reports_is_said_in_the_words_of_the_study():
    Path("oil.csv").write_text("time [h],ISO 4406\n0,20/18/15\n9,x\n8,18/16/13\n")
    told = complained(run("life", "oil-circuit.toml", "--reports", "oil.csv"))
    assert "line 3, column 2" in told
    assert "line 4, column 1" in told
    told = complained(
        run("life", "oil-circuit.toml", *setting('life.oil.ingress={ reports = "oil.csv" }'))
    )
    assert told.count("life.oil.ingress.reports: oil.csv, line") == 2


def test_reports_that_are_not_later_are_named_with_their_lines():
    Path("oil.csv").write_text(CODES + "750,16/13/10\n")
    (problem,) = refused("life", "oil-circuit.toml", "--reports", "oil.csv").problems
    assert problem.code is Mistake.ORDER
    assert problem.startswith("oil.csv, line 6, column 1: ")
    assert "line 5" in problem


def test_a_report_without_a_finite_time_is_named_with_its_own_line():
    Path("oil.csv").write_text("time [h],ISO 4406\n0,20/18/15\nnan,18/16/13\n5,17/15/12\n")
    (problem,) = refused("life", "oil-circuit.toml", "--reports", "oil.csv").problems
    assert problem.code is Mistake.RANGE
    assert problem.startswith('oil.csv, line 3, column 1: "nan" ')


def test_an_ingress_of_reports_that_fills_the_filter_at_once_is_doubted():
    Path("oil.csv").write_text("time [h],ISO 4406\n0,20/18/15\n250,26/24/21\n")
    done = run("life", "oil-circuit.toml", "--reports", "oil.csv")
    assert "life.ingress" in done.codes
    first, low, high = re.findall(r"([\d.]+) (?:k?g)/h", said(done))[:3]
    assert float(low) < float(first) < float(high)  # in one unit


def test_a_duration_without_a_unit_is_said():
    for value in ("100", '"100"'):
        done = run("life", "oil-circuit.toml", *setting(f"life.duration={value}"))
        (remark,) = (each for each in done.remarks if each.startswith("life.duration = 100 "))
        assert "100 s" in remark
        assert '"100 h"' in remark
    done = run("life", "oil-circuit.toml", *setting('life.duration="100 h"'))
    assert not any(each.startswith("life.duration") for each in done.remarks)


@pytest.mark.parametrize(
    "key", ['oil.volume="200"', 'filters.0.flow="60"', 'filters.0.capacity="50"']
)
def test_numbers_without_a_unit_that_no_oil_has_are_refused(key):
    place, _, value = f"life.{key}".partition("=")
    (problem,) = refused("life", "oil-circuit.toml", *setting(f"life.{key}")).problems
    assert (problem.code, problem.place, problem.value) == (Mistake.UNIT, place, value)


@pytest.mark.check
def test_rows_are_shown_where_much_happens():
    """A filter that is full every few hours: its rows do not hide the first minutes."""
    keys = setting('life.filters.0.capacity="1 g"')
    shown = run("life", "oil-circuit.toml", *keys).stdout.split("─── \n")[1].splitlines()[:20]
    assert sum(" s " in line or " min " in line for line in shown) >= 5


# ------------------------------------------------------------------------------ mistakes
MISTAKES = [
    ('filters.0.flow="60 L"', Mistake.UNIT, "filters.0.flow"),
    ('filters.0.beta={ "4 um" = 0.5 }', Mistake.RANGE, 'filters.0.beta."4 um"'),
    ('filters.0.beta={ "4 um" = 75, "10 um" = 5 }', Mistake.ORDER, "filters.0.beta"),
    ("filters.0.beta={}", Mistake.KIND, "filters.0.beta"),
    ('filters.0.capacity="50 um"', Mistake.UNIT, "filters.0.capacity"),
    ('oil.start="13/16/18"', Mistake.ORDER, "oil.start"),
    ('oil.material="unobtainium"', Mistake.UNKNOWN, "oil.material"),
    ('oil.material="SiO2"', Mistake.MISSING, "oil.ingress.material.density"),
    ('oil.ingress={ test_dust = "A9", rate = "1 mg/h" }', Mistake.OPTION, "oil.ingress.test_dust"),
    ('oil.ingress={ test_dust = "A3" }', Mistake.CLASH, "oil.ingress"),
    ('oil.ingress={ rate = "1 mg/h" }', Mistake.MISSING, "oil.ingress"),
    (
        'oil.ingress={ iso4406 = "18/16/13", test_dust = "A3" }',
        Mistake.CLASH,
        "oil.ingress.test_dust",
    ),
    (
        'oil.ingress={ counts = { "4 um" = "1e3 / s", "6 um" = "1e4 / s" } }',
        Mistake.ORDER,
        "oil.ingress.counts",
    ),
    ('oil.ingress="125 mg/h"', Mistake.KIND, "oil.ingress"),
    ('oil.ingress={ reports = "none.csv" }', Mistake.UNREADABLE, "oil.ingress.reports"),
    ('oil.leak="1 L/min"', Mistake.RANGE, "duration"),
    ('oil.viscosity="30 mm"', Mistake.UNIT, "oil.viscosity"),
    ('until.iso4406="18"', Mistake.SHAPE, "until.iso4406"),
    ('oil.ingress={ test_dust = "A3", rate = "-1 mg/h" }', Mistake.RANGE, "oil.ingress.rate"),
    ('duration="-1 h"', Mistake.RANGE, "duration"),
    ('durations="1 h"', Mistake.UNKNOWN, "durations"),
]


@pytest.mark.parametrize(("key", "code", "place"), MISTAKES)
def test_mistakes_get_one_sentence_and_nothing_is_written(key, code, place):
    before = sorted(Path().iterdir())
    files = ("--csv", "rows.csv", "--figure", "a.png")
    done = refused("life", "oil-circuit.toml", *setting(f"life.{key}"), *files)
    assert done.mistakes == [(code, f"life.{place}")]
    assert done.stdout == ""
    assert sorted(Path().iterdir()) == before


def test_what_nobody_can_predict_has_no_default():
    text = Path("oil-circuit.toml").read_text("utf-8")
    for key in ("ingress  =", "start    =", "volume   =", "material ="):
        line = next(each for each in text.splitlines() if each.startswith(key))
        Path("less.toml").write_text(text.replace(line + "\n", ""), "utf-8")
        missing = (Mistake.MISSING, f"life.oil.{key.rstrip(' =')}")
        assert refused("life", "less.toml").mistakes == [missing]
    done = run("life", "less.toml", "--figure", "a.xyz")
    assert done.exit_code == 2


def test_fresh_oil_must_be_said():
    text = Path("oil-circuit.toml").read_text("utf-8")
    line = next(each for each in text.splitlines() if each.startswith("fresh_oil"))
    Path("less.toml").write_text(text.replace(line + "\n", ""), "utf-8")
    assert refused("life", "less.toml").mistakes == [(Mistake.MISSING, "life.oil.fresh_oil")]


def test_filters_beyond_their_data_sheets_are_warned_of():
    """P above 1: the clipped part, and what lies below the first size."""
    text = Path("oil-circuit.toml").read_text("utf-8").replace(
        'beta = { "2 um" = 2, "4 um" = 5, "7 um" = 75, "14 um" = 1000 }',
        'beta = { "5 um" = 2, "10 um" = 75 }',
    )  # fmt: skip
    Path("steep.toml").write_text(text, "utf-8")
    done = run("life", "steep.toml")
    assert "5.05 µm" in done.note("clipped")
    assert "return filter" in done.note("below the data sheet")
    assert "5 µm" in done.note("below the data sheet")


def test_a_study_is_loaded_with_its_oil():
    study = tb.load_study("oil-circuit.toml")
    assert study.life.circuit.volume == pytest.approx(0.2)
    assert study.life.circuit.filters[0].beta(4e-6) == pytest.approx(5, rel=1e-12)


# ------------------------------------------------------------------------------ bands, sizes
@pytest.mark.check
def test_what_is_known_of_the_numbers_becomes_bands(monkeypatch):
    monkeypatch.setattr("thirdbody.study.life_bands.SAMPLES", 64)  # enough for some of each end
    Path("known.toml").write_text(
        Path("oil-circuit.toml").read_text("utf-8")
        + """
[life.until]
iso4406 = "13/11/7"
[life.uncertainty]
ingress = { median = 1, gsd = 2 }
"oil.volume" = { low = "180 L", high = "220 L" }
""",
        "utf-8",
    )
    asked = load_life("known.toml", ['life.duration="2 h"', "life.oil.oil_changes=[]"])
    assert asked.uncertainty["volume"].first == pytest.approx(0.18)
    bands = run_life(asked).bands
    assert 0 < bands.reached["code 13/11/7"] < 1  # censored where much enters
    assert np.isinf(bands.times["code 13/11/7"][-1])
    assert bands.swings[0].name == "ingress"
    keys = setting('life.duration="2 h"', "life.oil.oil_changes=[]")
    data = json.loads(run("life", "known.toml", *keys, "--json").stdout)["bands"]
    assert data["codes"] == list(bands.codes)
    assert (data["reached"], data["samples"]) == (bands.reached, 64)
    assert data["times"]["code 13/11/7"][-1] is None
    # what is printed of it: the one place that holds these words
    told = said(run("life", "known.toml", *keys))
    assert f"the oil is at {bands.codes[0]} to {bands.codes[-1]} after 2 h (90 %)" in told
    assert f"in {bands.count_missed('code 13/11/7')} of 64 histories not by 2 h" in told


def test_the_flow_that_is_enough_for_a_code():
    asked = load_life("oil-circuit.toml")
    flow = least_flow(asked.circuit, code="16/14/11")
    told = said(run("life", "oil-circuit.toml", "--flow-for", "16/14/11"))
    assert f"{6e4 * flow:.3g} L/min" in told
    for factor, reached in ((1.001, True), (0.999, False)):
        circuit = asked.circuit.replace(**{"filters.0.flow": factor * flow})
        numbers = [int(part) for part in circuit.steady_code().split("/")]
        assert all(a <= b for a, b in zip(numbers, (16, 14, 11), strict=True)) is reached
    none = said(run("life", "oil-circuit.toml", "--flow-for", "0/0/0"))
    assert "16/14/11" not in none


def test_the_book_shows_what_is_printed():
    text = (Path(__file__).parents[2] / "docs" / "life.md").read_text("utf-8")
    shown = text.split("```text\n")[1].split("```")[0]
    printed = [line.rstrip() for line in run("life", "oil-circuit.toml").stdout.splitlines()]
    assert shown.splitlines() == printed[2:]


@pytest.mark.check
def test_the_report_has_a_page_on_the_oil():
    study = tb.load_study("oil-circuit.toml")
    page = report(study).html()
    words = words_in_html(answer(run_life(study.life))[0])
    assert words in page
    other = tb.load_study("oil-circuit.toml", ["title=another"])
    assert words not in report(dataclasses.replace(other, life=None)).html()


# ------------------------------------------------------------------------------ contacts in the oil
def with_contact(*lines):
    text = Path("oil-circuit.toml").read_text("utf-8") + CONTACT + "\n".join(lines)
    Path("contact.toml").write_text(text.replace('oil_changes = "1500 h"', "# "), "utf-8")
    return ["contact.toml", *setting('life.duration="1 h"')]


def test_what_enters_a_contact_has_no_default():
    (problem,) = refused("life", *with_contact()).problems
    assert (problem.code, problem.place) == (Mistake.MISSING, "life.contact.entry_ratio")
    assert "--set life.contact.entry_ratio=" in problem


@pytest.mark.slow
def test_a_contact_in_the_oil_is_that_of_python():
    arguments = with_contact("entry_ratio = 0.1")
    done = run("life", *arguments, "--json")
    assert done.exit_code == 0, done.stderr
    data = json.loads(done.stdout)
    asked = load_life("contact.toml", ['life.duration="1 h"'])
    of, film = asked.contact, asked.contact.conditions
    assert (film["load"], film["speed"], film["slide_roll"]) == (50.0, 1.0, 0.05)
    assert of.debris == tb.systems.life.debris.Debris.boundary_lubricated()
    history = run_life(asked).history
    assert data["R0"] == pytest.approx(history.R0, rel=1e-9, abs=1e-30)
    assert data["codes"] == list(history.codes)
    assert history.ledger.residual < 1e-9
    assert data["reproduction"] == history.reproduction
    assert f"{history.reproduction[1:]}." in said(run("life", *arguments))


def test_parts_of_a_contact_that_are_missing_are_named():
    text = Path("oil-circuit.toml").read_text("utf-8") + "[life.contact]\nentry_ratio = 1\n"
    Path("part.toml").write_text(text, "utf-8")
    (problem,) = refused("life", "part.toml").problems
    assert (problem.code, problem.place) == (Mistake.MISSING, "life.contact")
    assert "[outputs]" in problem
    assert "[film]" in problem
    assert "[roughness]" not in problem
    Path("part.toml").write_text(
        text.split("[life.contact]")[0] + '[life.debris]\nsizes = "boundary-lubricated"\n'
    )
    assert refused("life", "part.toml").mistakes == [(Mistake.IDLE, "life.debris")]
