"""The command line: what stands on which stream, exit status, files that appear whole."""

import csv
import errno
import json
import os
import re
import signal
import stat
import subprocess
import sys
import time
from importlib import import_module, resources
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import patch

import jsonschema
import numpy as np
import pytest
from command_line import refused, run
from refusals import refuses

import thirdbody as tb
from thirdbody import study
from thirdbody.cli.streams import EXIT_STATUS
from thirdbody.equilibrium.status import WORDS, Status
from thirdbody.errors import Mistake, code_of
from thirdbody.quantities import files
from thirdbody.quantities.say import number, percent

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
DUSTY = next(path for path in EXAMPLES if path.stem == "dusty_ball_screw")
CLEAN = next(path for path in EXAMPLES if path.stem == "two_body_reference")
SCHEMA = json.loads(
    resources.files("thirdbody").joinpath("data/solve.schema.json").read_text("utf-8")
)


def process(*arguments, **options):
    """The command in a process of its own."""
    command = [sys.executable, "-m", "thirdbody", *map(str, arguments)]
    # readline tells children of a width that this process has not
    options = {"env": dict(os.environ)} | options
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def strict(text):
    """JSON as the standard has it: no NaN, no Infinity."""

    def refuse(token):
        raise AssertionError(f"{token} is not JSON")

    return json.loads(text, parse_constant=refuse)


# ---------------------------------------------------------------------------- --json
def test_schema_is_a_schema():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


TABLE = "squeezed by more than 0.15 of their radius on each side"
CHI = "pressed point by point, stood"
WARNED = {name: [TABLE] for name in ("additive", "assess", "explicit", "oil_film")}
WARNED |= {
    name: [CHI, TABLE]
    for name in (
        "bearing_wear_debris", "dust_and_debris", "dusty_ball_screw", "iso4406",
        "nanoparticle_additive", "soft_ptfe_particles", "steel_debris_in_film", "sweep",
    )
}  # fmt: skip
WARNED["iso4406"] = [CHI, TABLE, "the height of the fluid that brings them"]
WARNED["steel_debris_in_film"].append("particles flatten, as debris = 'ductile' says")
WARNED["oil_film"].append("the oil of [film] carries nothing here")
WARNED["quartz_in_bearing"] = ["strengths are extrapolated by a factor"]
"""What examples are warned of, and not of anything else."""


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_json_of_every_example_is_valid(path):
    result = run("solve", path, "--json")
    assert result.exit_code == 0
    told = [line for line in result.stderr.splitlines() if line.strip()]
    wanted = WARNED.get(path.stem, [])
    assert len(told) == len(wanted), told
    assert all(any(text in line for line in told) for text in wanted), told
    answer = strict(result.stdout)
    jsonschema.validate(answer, SCHEMA)
    assert len({len(column) for column in answer["states"].values()}) == 1


def test_json_holds_the_numbers_of_the_python_interface():
    answer = strict(run("solve", DUSTY, "--json", "--set", "load.pressure=[1e5, 5e6]").stdout)
    contact = study.load_study(DUSTY).contact
    state = tb.solve(contact, pressure=np.array([1e5, 5e6]))
    for name, column in state.columns().items():
        assert answer["states"][name] == column.tolist(), name
    assert answer["transitions"]["F_cr1"]["value"] == tb.transitions(contact).F_cr1.value
    assert answer["version"] == tb.__version__


def test_json_with_an_unsolved_state_is_valid():
    result = run("solve", DUSTY, "--json", "--set", "load.F_star=[1e-5, 1e3]")
    assert result.exit_code == 0
    answer = strict(result.stdout)
    jsonschema.validate(answer, SCHEMA)
    assert answer["states"]["A_t"][1] is None
    assert "no equilibrium" in answer["states"]["status"][1]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda answer: answer.pop("transitions"),
        lambda answer: answer["states"].pop("A_sa"),
        lambda answer: answer["states"].update(A_t=[-1.0]),
        lambda answer: answer["states"].update(mode=["p-p"]),
        lambda answer: answer["inputs"]["load"].update(pressure=[1.0]),
        lambda answer: answer["transitions"]["F_cr1"].pop("status"),
        lambda answer: answer["inputs"]["surfaces"]["first"].update(nu=0.6),
    ],
)
def test_schema_refuses(spoil):
    answer = study.run_study(study.load_study(DUSTY, ["load.F_star=1e-5"])).to_dict()
    jsonschema.validate(answer, SCHEMA)
    spoil(answer)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(answer, SCHEMA)


# ---------------------------------------------------------------------------- tables
def spoken(text):
    """The number that a table shows."""
    plain = text.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    return float(plain.replace("×10", "e"))


def test_table_shows_at_most_twenty_states_evenly_spaced():
    text = run("solve", DUSTY).stdout
    loads = re.findall(r"^ *(\S+) +\S+ [kMG]?Pa +\S+ [nµ]?m ", text, re.MULTILINE)
    assert len(loads) == 20
    assert loads[0] == "5×10⁻⁷"
    assert loads[-1] == "0.00024"
    steps = np.diff(np.log([spoken(load) for load in loads]))
    assert steps.max() / steps.min() < 1.2
    assert "20 of 200 states shown" in text


def test_table_has_transitions_and_plain_words():
    asked = ("solve", DUSTY, "--set", "load.pressure=5 MPa")
    text = " ".join(run(*asked).stdout.split())
    assert "Dust in a ball-screw nut" in text
    for name in ("F_cr1", "F_cr2", "F_tpca A", "F_tpca B", "F_tpca C"):
        assert name in text
    states = strict(run(*asked, "--json").stdout)["states"]
    first = text[text.index("At 5 MPa (F* = ") :].split(". ")[0]
    assert f"(F* = {number(states['F_star'][0])})" in first
    assert f"({states['mode'][0]})" in first
    assert percent(states["particle_load_share"][0]) in first


def test_table_without_particles_has_no_word_of_them():
    text = " ".join(run("solve", CLEAN).stdout.split())
    text = text.replace("without particles", "").replace("because there are no particles", "")
    assert "particle" not in text
    assert "F_cr1" not in text


def test_unsolved_state_is_shown_with_its_status():
    result = run("solve", DUSTY, "--set", "load.F_star=[1e-5, 1e3]")
    assert result.exit_code == 0
    assert "1 of 2 states unsolved: no equilibrium" in result.stdout


def test_no_contact_at_all_can_be_told():
    result = run("solve", DUSTY, "--set", "load.separation=1 m")
    assert result.exit_code == 0
    assert "no contact" in result.stdout


def test_set_changes_the_result():
    first, second = (
        strict(run("solve", DUSTY, "--json", *more).stdout)
        for more in ((), ("--set", "particles.mean=500 nm"))
    )
    assert second["inputs"]["particles"]["diameter"]["mean"] == 500e-9
    assert second["states"]["d"][0] > first["states"]["d"][0]


# ---------------------------------------------------------------------------- mistakes
@pytest.fixture
def wrong(tmp_path):
    path = tmp_path / "wrong.toml"
    text = DUSTY.read_text("utf-8")
    for old, new in [
        ('sigma = "100 nm"', 'sigma = "300 GPa"'),
        ("nu = 0.29", "nu = 0.6"),
        ("seat =", "saet ="),
    ]:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_mistakes_go_to_standard_error_one_line_each(wrong, more):
    result = run("solve", wrong, *more)
    assert result.exit_code == 2
    assert bool(result.stdout) is bool(more)
    lines = result.stderr.splitlines()
    assert len(lines) == 3
    assert all(line.startswith("error: ") for line in lines)
    for place in ("surfaces.second.nu = 0.6", "roughness.sigma = ", "particle_law.saet"):
        assert any(line.startswith(f"error: {place}") for line in lines)


def test_mistakes_are_taken_apart_in_json(wrong):
    result = run("solve", wrong, "--json")
    answer = strict(result.stdout)
    jsonschema.validate(answer, SCHEMA)
    problems = {each["path"]: each for each in answer["problems"]}
    assert {place: each["code"] for place, each in problems.items()} == {
        "surfaces.second.nu": "range",
        "roughness.sigma": "unit",
        "particle_law.saet": "unknown",
    }
    assert problems["surfaces.second.nu"]["value"] == "0.6"
    assert problems["particle_law.saet"]["meant"] == "seat"
    assert [f"error: {each['sentence']}" for each in answer["problems"]] == (
        result.stderr.splitlines()
    )


@pytest.mark.parametrize(
    ("arguments", "code", "path", "value"),
    [
        (("solve", DUSTY, "--set", 'roughness.sigma="5 Pa"'), "unit", "roughness.sigma", "5 Pa"),
        (("solve", DUSTY, "--set", "roughness.R=[1, 2]"), "kind", "roughness.R", "[1, 2]"),
        (("solve", "none.toml"), "unreadable", "none.toml", None),
        (("solve", "broken.toml"), "form", "broken.toml", None),
        (("solve",), "form", "STUDY.toml", None),
        (("solve", DUSTY, "--sett", "title=1"), "unknown", "--sett", None),
        (("solve", DUSTY, "--set", "title"), "form", "--set", "title"),
        (("solve", DUSTY, "--csv", "none/a.csv"), "unwritable", "none/a.csv", None),
        (("explicit", DUSTY, "--maps", "some"), "option", "--maps", "some"),
        (("film", DUSTY), "missing", "film", None),
        (("slove", DUSTY), "unknown", "slove", None),
    ],
)
def test_a_mistake_in_json_says_where_it_is_and_what_was_written(
    arguments, code, path, value, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("broken.toml").write_text("title = a b", "utf-8")
    done = run(*arguments, "--json")
    (problem,) = strict(done.stdout)["problems"]
    jsonschema.validate({"problems": [problem]}, SCHEMA)
    assert done.exit_code == 2
    assert (problem["code"], problem["path"], problem["value"]) == (code, path, value)
    if path == "slove":
        assert problem["meant"] == "solve"


@pytest.mark.parametrize(
    ("setting", "meant"),
    [
        ('surfaces.second="S45D"', "S45C"),
        ('roughness.sigma="5 nmm"', "nm"),
        ("roughness.sigma=100", "100 nm"),
        ('particle_law.seat="rouhg"', "rough"),
    ],
)
def test_a_mistake_in_json_says_nothing_twice(setting, meant):
    (problem,) = strict(run("solve", DUSTY, "--json", "--set", setting).stdout)["problems"]
    assert problem["meant"] == meant
    assert meant in problem["hint"]
    assert problem["hint"] not in problem["allowed"]
    assert problem["value"].strip('"') == problem["value"]
    assert 0 < len(problem["allowed"]) < len(problem["sentence"]) - len(problem["hint"])


def test_mistakes_stand_in_the_file_that_was_to_hold_the_answer(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = Path("a.json")
    ways = [("load.F_star=-1", 2), ("load.F_star=1e-4", 0), ("load.F_star=5e6", 3), ("a", 2)]
    for setting, status in [*ways, *ways[:1]]:
        done = run("solve", DUSTY, "--json", file, "--set", setting)
        held = strict(file.read_text("utf-8"))
        jsonschema.validate(held, SCHEMA)
        assert (done.exit_code, "problems" in held) == (status, status != 0)
        if status == 2:
            codes = [each["code"] for each in held["problems"]]
            assert codes == [str(each.code) for each in done.problems]
    assert list(tmp_path.iterdir()) == [tmp_path / file]


@pytest.mark.parametrize("more", [(), ("--force",)])
@pytest.mark.parametrize("held", ['{"a": 1}', '{"problems": ["of mine"]}', "not JSON"])
def test_mistakes_replace_no_file_of_somebody_else(held, more, tmp_path):
    file = tmp_path / "a.json"
    file.write_text(held, "utf-8")
    done = run("solve", DUSTY, "--json", file, "--set", "load.F_star=-1", *more)
    assert (done.exit_code, file.read_text("utf-8")) == (2, held)


@pytest.mark.parametrize(("option", "name"), [("--csv", "a.xls"), ("--xlsx", "a.xls")])
def test_a_table_goes_into_no_file_of_old_excel(option, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (problem,) = run("solve", DUSTY, option, name).problems
    assert (problem.code, problem.source) == (Mistake.UNWRITABLE, name)
    assert "--xlsx" in problem.hint or option == "--xlsx"
    assert not list(tmp_path.iterdir())


def test_help_says_what_each_exit_status_means():
    shown = " ".join(run("--help").stdout.split())
    assert " ".join(EXIT_STATUS.split()) in shown


def test_a_misspelt_table_stands_before_what_follows_from_it(tmp_path):
    file = tmp_path / "s.toml"
    text = DUSTY.read_text("utf-8").partition("[load]")[0]
    file.write_text(f'{text}[load]\nforce = "5 N"\n[film]\nspeed = 1\n[boddy]\nR = 1\n', "utf-8")
    first, *others = run("solve", file).mistakes
    assert first == (Mistake.UNKNOWN, "[boddy]")
    assert others


def test_the_schema_knows_the_codes_of_all_mistakes():
    items = SCHEMA["properties"]["problems"]["items"]
    unsolved = {word for code, word in enumerate(WORDS) if code != Status.OK}
    codes = {str(each) for each in Mistake} | unsolved | {"no_transition"}
    assert set(items["properties"]["code"]["enum"]) == codes


def test_a_load_without_an_equilibrium_is_told_once_in_json():
    """Where states are printed their status says it; else it stands in the place of an answer."""
    few = run("solve", DUSTY, "--json", "--set", "load.F_star=5e6")
    assert few.exit_code == 3
    assert "problems" not in strict(few.stdout)
    with patch.object(study, "run_study", side_effect=tb.errors.NoTransition("none")):
        none = run("solve", DUSTY, "--json")
    assert none.exit_code == 3
    (problem,) = strict(none.stdout)["problems"]
    assert (problem["code"], problem["sentence"]) == ("no_transition", "none")


@pytest.mark.parametrize(
    "arguments",
    [
        ("solve", DUSTY, "--json", "out.txt"),
        ("solve", "--json", "out.txt", DUSTY),
        ("solve", DUSTY, "--json", "out"),
        ("laws", "--json", "laws.json"),
    ],
)
def test_a_name_that_json_does_not_take_is_told_with_what_writes_a_file(arguments):
    done = run(*arguments)
    assert done.mistakes == [(Mistake.FORM, "--json")]
    (problem,) = done.problems
    name = arguments[arguments.index("--json") + 1]
    assert f"--json > {name}" in problem.hint
    assert (f"--json {Path(name).with_suffix('.json')}" in problem.hint) is (
        "laws" not in arguments
    )


@pytest.mark.check
def test_no_traceback_in_a_process_of_its_own(wrong, tmp_path):
    result = process("solve", wrong)
    assert result.returncode == 2
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert result.stderr.count("error: ") == 3
    result = process("solve", tmp_path / "none.toml")
    assert result.returncode == 2
    assert result.stderr.startswith("error: cannot read ")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ("solve",),
        ("slove", DUSTY),
        ("solve", DUSTY, "--jsno"),
        ("solve", DUSTY, "--json", "x.txt"),
        ("solve", DUSTY, "--set", "nonsense"),
        ("laws", "--json", "--markdown"),
        ("reproduce", "horng2023"),
        ("reproduce", "horng2022", "--preset", "publish"),
        ("reproduce", "horng2022", "--out", DUSTY),
    ],
)
def test_wrong_usage_exits_2(arguments):
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stderr
    if "--json" in arguments:
        assert list(strict(result.stdout)) == ["problems"]
    else:
        assert result.stdout == ""


def test_no_equilibrium_exits_3():
    result = run("solve", DUSTY, "--set", "load.F_star=5e6")
    assert result.exit_code == 3
    assert result.stdout == ""
    assert result.stderr.startswith("error: no equilibrium")
    assert len(result.stderr.splitlines()) == 1
    result = run("solve", DUSTY, "--json", "--set", "load.F_star=[5e6, 6e6]")
    assert result.exit_code == 3
    jsonschema.validate(strict(result.stdout), SCHEMA)
    assert "all 2 states" in result.stderr


@pytest.mark.parametrize(
    "error", [tb.errors.NoEquilibrium("nothing"), tb.errors.NoTransition("nothing")]
)
def test_errors_of_the_library_exit_3(monkeypatch, error):
    def fail(*_):
        raise error

    monkeypatch.setattr(study, "run_study", fail)
    result = run("solve", DUSTY)
    assert (result.exit_code, result.stderr) == (3, "error: nothing\n")


def test_transitions_never_fail(monkeypatch):
    def fail(*_, **__):
        raise tb.errors.NoTransition("nothing")

    monkeypatch.setattr(study.run, "transitions", fail)
    result = run("solve", DUSTY, "--json")
    assert result.exit_code == 0
    answer = strict(result.stdout)
    jsonschema.validate(answer, SCHEMA)
    assert answer["transitions"]["F_cr1"] == {"value": None, "status": "none: nothing"}


# ---------------------------------------------------------------------------- warnings
@pytest.mark.check
def test_warnings_are_one_line_each_on_standard_error():
    crowded = ["--set", "load.pressure=1 GPa", "--set", "particles.areal_density=5e12 / m^2"]
    result = process("solve", DUSTY, "--json", *crowded)
    assert result.returncode == 0
    lines = result.stderr.splitlines()
    assert lines
    *shown, more = lines
    assert len(shown) == 3
    assert all(re.fullmatch(r"warning: \S.*", line) for line in shown)
    answer = strict(result.stdout)
    every = [f"warning: {sentence}" for sentence in answer["warnings"]]
    assert any("A_t reaches" in line for line in every)
    assert set(shown) < set(every)
    assert more.startswith(f"note: {len(every) - 3} more warning")
    whole = process("solve", DUSTY, "--json", "--verbose", *crowded)
    assert sorted(whole.stderr.splitlines()) == sorted(every)


def test_a_note_on_particles_that_carry_next_to_nothing_waits_for_verbose():
    """The friction of their faces changes their load by a third, and the whole by a part of 1e-5."""
    few = ("--set", "particles.areal_density=1e7 / m^2", "--set", "load.pressure=[5e7, 1e8]")
    state = study.load_study(DUSTY, few[1::2]).solve()
    assert 0 < state.particle_load_share.max() < 1e-3
    assert "squeezed" in map(code_of, state.warnings)
    short, whole = run("solve", DUSTY, *few), run("solve", DUSTY, *few, "--verbose")
    assert "squeezed" not in short.codes
    assert short.remarks
    assert "squeezed" in whole.codes
    assert "squeezed" in run("solve", DUSTY).codes


def test_likely_slips_are_told_even_when_the_study_fails():
    result = run("solve", DUSTY, "--set", 'roughness.sigma="100 m"', "--set", "load.F_star=5e6")
    assert result.exit_code in (2, 3)
    assert any(note.startswith('roughness.sigma = "100 m" ') for note in result.notes)


def test_a_forgotten_unit_is_an_error_before_any_answer():
    result = run("solve", DUSTY, "--set", "roughness.sigma=120")
    assert (result.exit_code, result.stdout) == (2, "")
    assert 'was "120 nm" meant?' in result.stderr


@pytest.mark.check
@pytest.mark.parametrize(
    "where", [">&-", ">/dev/full", "<&- >&-", ">&- 2>&-", ">/dev/full 2>/dev/full"]
)
@pytest.mark.parametrize("command", ["laws", "--version", "solve --help", f"solve {DUSTY} --json"])
def test_an_answer_that_cannot_be_written_is_an_error(command, where):
    words = f"{sys.executable} -m thirdbody {command} {where}"
    buffered = {k: v for k, v in os.environ.items() if k != "PYTHONUNBUFFERED"}
    result = subprocess.run(
        words, shell=True, capture_output=True, text=True, timeout=300, env=buffered
    )
    assert result.returncode == 2
    if "2>" not in where:
        told = result.stderr
        if command.startswith(f"solve {DUSTY}"):  # the states are solved and warned of before
            told = re.sub(r"\A(warning: .*\n)+", "", told)
        (line,) = told.splitlines()
        assert line.startswith("error: ")
        assert line.rpartition(": ")[2] in {
            os.strerror(each) for each in (errno.EBADF, errno.ENOSPC)
        }


@pytest.mark.check
@pytest.mark.parametrize("value", ["abc", "0", "-2", "1.5", "²", "9" * 30])
def test_odd_numbers_of_threads_are_refused(value):
    done = process("solve", DUSTY, env=os.environ | {"THIRDBODY_THREADS": value}, timeout=300)
    assert done.returncode == 2
    assert done.stderr.startswith("error: THIRDBODY_THREADS = ")


# ---------------------------------------------------------------------------- --csv
def test_json_has_codes_beside_its_sentences():
    loads = ("--set", "load.F_star=[1e-5, 1e3]", "--set", 'particles.material="SiO2"')
    data = json.loads(run("solve", DUSTY, "--json", *loads).stdout)
    answer = study.run_study(study.load_study(DUSTY, ["load.F_star=[1e-5, 1e3]"]))
    assert data["states"]["status_code"] == answer.states.status_code.tolist()
    assert [code == 0 for code in data["states"]["status_code"]] == [True, False]
    assert [note["sentence"] for note in data["notes"]] == data["warnings"]
    codes = {note["code"]: note["effect"] for note in data["notes"]}
    assert "" not in codes
    assert codes == {note.code: note.effect for note in answer.warnings}


def test_csv_round_trip(tmp_path):
    path = tmp_path / "states.csv"
    result = run("solve", DUSTY, "--csv", path, "--set", "load.F_star=[1e-5, 1e3, 1e-4]")
    assert result.exit_code == 0
    assert "1 of 3 states unsolved" in result.stdout
    assert result.stderr.splitlines()[-1] == f"written: {path}"
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert len(rows) == 3
    assert "pressure [Pa]" in header
    assert "d [m]" in header
    assert "A_t [1]" in header
    assert "mode" in header
    answer = study.run_study(study.load_study(DUSTY, ["load.F_star=[1e-5, 1e3, 1e-4]"]))
    names = [name.split(" [")[0] for name in header]
    assert set(names) == set(answer["states"])
    assert names[-1] == "status_code"
    for name, cells in zip(names, zip(*rows, strict=True), strict=True):
        for cell, value in zip(cells, answer["states"][name], strict=True):
            if value is None:
                assert cell == ""
            else:
                assert type(value)(cell) == value
    assert path.stat().st_mode & 0o777 == 0o666 & ~_umask()


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def test_no_file_when_nothing_is_solved(tmp_path, wrong):
    path = tmp_path / "states.csv"
    assert run("solve", DUSTY, "--csv", path, "--set", "load.F_star=5e6").exit_code == 3
    assert run("solve", wrong, "--csv", path).exit_code == 2
    assert [item.name for item in tmp_path.iterdir()] == ["wrong.toml"]


def test_file_that_cannot_be_written(tmp_path):
    for path in (tmp_path, tmp_path / "none" / "states.csv"):
        result = run("solve", DUSTY, "--csv", path)
        assert result.exit_code == 2
        assert f"error: cannot write {path}" in result.stderr
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------------------- files
@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_files_appear_whole_or_not_at_all(tmp_path, error):
    path = tmp_path / "out.txt"

    def fail():
        with files.whole(path) as draft:
            draft.write_text("half")
            raise error

    with pytest.raises(error):
        fail()
    assert list(tmp_path.iterdir()) == []
    path.write_text("old")
    with pytest.raises(error):
        fail()
    assert [item.name for item in tmp_path.iterdir()] == ["out.txt"]
    assert path.read_text() == "old"


def test_files_are_not_visible_before_they_are_complete(tmp_path):
    path = tmp_path / "out.png"
    with files.whole(path) as draft:
        draft.write_text("half")
        assert draft.parent == tmp_path
        assert draft.suffix == ".png"
        assert not path.exists()
    assert path.read_text() == "half"
    assert len(list(tmp_path.iterdir())) == 1


def test_files_keep_links_and_modes(tmp_path):
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    real.write_text("old")
    real.chmod(0o600)
    link.symlink_to(real)
    files.write_text(link, "new µ\n")
    assert link.is_symlink()
    assert real.read_bytes() == "new µ\n".encode()
    assert stat.S_IMODE(real.stat().st_mode) == 0o600


def test_devices_are_written_directly():
    files.write_text(os.devnull, "nothing")
    assert not Path(os.devnull).is_file()


def test_a_full_disk_is_told():
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    with refuses(Mistake.UNWRITABLE, "", says="/dev/full"):
        files.write_text("/dev/full", "nothing")


@pytest.mark.check
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_device_is_told_before_any_work():
    """Nothing is solved, so nothing is warned of."""
    full = os.strerror(errno.ENOSPC).lower()
    assert files.hindrance("/dev/full") == full
    assert files.hindrance(os.devnull) == ""
    for where in (">/dev/full", "--csv /dev/full"):
        words = f"{sys.executable} -m thirdbody solve {DUSTY} {where}"
        done = subprocess.run(words, shell=True, capture_output=True, text=True, timeout=300)
        assert (done.returncode, done.stdout) == (2, "")
        assert len(done.stderr.splitlines()) == 1
        assert full in done.stderr.lower()


# ---------------------------------------------------------------------------- interruptions
@pytest.mark.check
@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_interrupt_exits_130_with_one_line_and_no_file(tmp_path):
    command = [sys.executable, "-m", "thirdbody", "solve", str(DUSTY)]
    command += ["--set", "load.F_star.points=1000000", "--csv", str(tmp_path / "states.csv")]
    # the warning about R says that the study is being computed
    command += ["--set", 'roughness.R="2 cm"']
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stderr.readline().startswith("warning: ")
        time.sleep(0.3)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=60)
    assert running.returncode == 130
    assert out == ""
    assert err == "error: interrupted\n"
    assert list(tmp_path.iterdir()) == []


INTERRUPT = "os.kill(os.getpid(), signal.SIGINT)"
IN_FINALIZER = f"type('Removed', (), {{'__del__': lambda self: {INTERRUPT}}})()"
IN_CALLBACK = f"ctypes.CFUNCTYPE(None)(lambda: {INTERRUPT})()"
IN_COMPILED = f"exec('try: {INTERRUPT}\\nexcept BaseException as e: raise SystemError from e')"
SWALLOWED = f"exec('try: {INTERRUPT}\\nexcept BaseException: pass')"


@pytest.mark.check
@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize(
    "statement", [INTERRUPT, IN_FINALIZER, IN_CALLBACK, IN_COMPILED, SWALLOWED]
)
@pytest.mark.parametrize("module", ["scipy", "numba"])
def test_interrupt_while_modules_load(tmp_path, module, statement):
    """At the start, and in the command; through exec of a text, as in numba and dataclasses; and
    where Python ignores what is raised."""
    fake = tmp_path / "fake"
    fake.mkdir()
    text = f"import ctypes, os, signal, time; {statement}; time.sleep(20)"
    (fake / f"{module}.py").write_text(f"exec({text!r})")
    path = os.pathsep.join(filter(None, (str(fake), os.environ.get("PYTHONPATH"))))
    command = [sys.executable, "-m", "thirdbody", "solve", str(DUSTY), "--csv", "states.csv"]
    result = subprocess.run(
        [*command, "--set", "load.F_star.points=1000000"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": path},
    )
    assert (result.returncode, result.stdout) == (130, "")
    assert result.stderr == "error: interrupted\n"
    assert list(tmp_path.iterdir()) == [fake]


@pytest.mark.check
@pytest.mark.skipif(os.name == "nt", reason="pipes")
@pytest.mark.parametrize("more", [("--json",), ()])
def test_reader_that_goes_away(more):
    command = [sys.executable, "-m", "thirdbody", "solve", str(DUSTY), *more]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        running.stdout.close()
        err = running.stderr.read()
    assert running.returncode != 0
    assert all(line.startswith(b"warning: ") for line in err.splitlines())


# ---------------------------------------------------------------------------- the rest
def test_version():
    result = run("--version")
    assert (result.exit_code, result.stdout) == (0, f"thirdbody {tb.__version__}\n")


COMMANDS = re.findall(r"(?m)^  ([a-z]+) {2,}\S", run("--help").stdout.partition("Commands:")[2])


def test_help_lists_every_command_in_a_whole_sentence(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    listed = run("--help").stdout.partition("Commands:\n")[2].partition("\n\n")[0]
    lines = listed.splitlines()
    assert len(lines) == len(COMMANDS) > 15
    assert [line for line in lines if not re.search(r"[^.]\.$|\w \.\.\.$", line)] == []


@pytest.mark.parametrize("command", COMMANDS)
def test_help(command, monkeypatch):
    """Within 80 columns, every option with a sentence, and no type of Python in its place."""
    monkeypatch.setenv("COLUMNS", "80")
    done = run(command, "--help")
    assert done.exit_code == 0
    assert max(map(len, done.stdout.splitlines())) <= 80
    options = done.stdout.partition("Options:\n")[2]
    every = re.split(r"(?m)^  (?=--)", options)[1:]
    assert len(every) > 1
    for each in every:
        name, _, text = " ".join(each.split()).partition(" ")
        assert re.search(r"[A-Z0-9][^<>]{8,}\.", text), name
        assert not re.search(r"<(str|int|float|list|path)", each), name


def test_laws_come_from_the_registries():
    text = run("laws").stdout
    answer = strict(run("laws", "--json").stdout)
    for kind, registry in (("asperity", tb.asperity.REGISTRY), ("particle", tb.particle.REGISTRY)):
        assert [entry["name"] for entry in answer[kind]] == list(registry)
        for entry, law in zip(answer[kind], registry.values(), strict=True):
            assert re.search(rf"^ ?{law.name} ", text, re.MULTILINE)
            assert entry["citation"] == law.citation
            assert entry["valid_range"] == law.valid_range
            options = {option["key"]: option["default"] for option in entry["options"]}
            assert not {"scale", "yield_strain"} & set(options), "a contact fills these in"
            for key, default in options.items():
                assert getattr(law(), key) == default or getattr(law(), key).name == default


def test_materials_come_from_the_library():
    text = run("materials").stdout
    answer = strict(run("materials", "--json").stdout)
    assert answer == tb.materials.entries()
    for name in tb.materials:
        assert name in text


def test_reproduce_hands_over_and_prints(monkeypatch, tmp_path):
    asked = {}

    def reproduce(out, *, preset="published", progress=None):
        asked.update(out=out, preset=preset)
        for i in range(3):
            progress("figure 3", i + 1, 3)
        return SimpleNamespace(lines=lambda: ["66 of 84 claims", "done"])

    name = "thirdbody.papers.horng2022"
    monkeypatch.setitem(sys.modules, name, SimpleNamespace(reproduce=reproduce))
    result = run("reproduce", "horng2022", "--out", tmp_path / "figures", "--preset", "window")
    assert result.exit_code == 0
    assert asked == {"out": tmp_path / "figures", "preset": "window"}
    assert result.stdout == "66 of 84 claims\ndone\n"
    assert result.stderr == "figure 3 ...\n"


@pytest.mark.check
@pytest.mark.skipif(os.name == "nt", reason="resource")
def test_one_state_loads_little_and_is_small():
    """A state by command needs no package for figures, tables, statistics or compiling; 400 MB."""
    code = (
        "import resource, runpy, sys\n"
        f"sys.argv = ['thirdbody', 'solve', {str(DUSTY)!r}, '--json', '--set',"
        " 'load.pressure=5 MPa']\n"
        "try:\n    runpy.run_module('thirdbody', run_name='__main__')\n"
        "except SystemExit as end:\n    assert not end.code, end.code\n"
        # ru_maxrss remembers the process that started this one, VmHWM does not
        "peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "if sys.platform == 'linux':\n"
        "    peak = open('/proc/self/status').read().split('VmHWM:')[1].split()[0]\n"
        "print(peak, *sys.modules, file=sys.stderr)\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    peak, *loaded = done.stderr.splitlines()[-1].split()
    # kilobytes, on macOS bytes
    assert int(peak) * (1 if sys.platform == "darwin" else 1024) < 400e6
    heavy = {"matplotlib", "xarray", "pandas", "numba", "pint", "zarr", "distributed", "nicegui"}
    heavy |= {"scipy.stats", "scipy.integrate", "rich"}
    assert not heavy & set(loaded)
    assert "scipy.special" in loaded


def test_help_loads_nothing_that_computes():
    code = (
        "import runpy, sys\n"
        "sys.argv = ['thirdbody', '--help']\n"
        "try:\n    runpy.run_module('thirdbody', run_name='__main__')\n"
        "except SystemExit as end:\n    assert not end.code, end.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "solve" in done.stdout
    heavy = {"numpy", "scipy", "rich", "matplotlib", "thirdbody.contact.contact"}
    assert not heavy & set(done.stderr.split())


@pytest.mark.parametrize("command", [("assess", "--html"), ("design", "--csv", "--figure")])
def test_a_missing_folder_is_told_before_long_work(tmp_path, command, monkeypatch):
    name, *options = command
    for module, work in (("study.analyses", "assess_study"), ("study.analyses", "design_study")):
        monkeypatch.setattr(import_module(f"thirdbody.{module}"), work, None)
    study = {"assess": "assess.toml", "design": "additive.toml"}[name]
    files = [str(tmp_path / "no" / option.strip("-")) for option in options]
    asked = [word for pair in zip(options, files, strict=True) for word in pair]
    result = refused(name, DUSTY.with_name(study), *asked)
    assert [problem.code for problem in result.problems] == [Mistake.UNWRITABLE] * len(files)
    assert all(file in problem for file, problem in zip(files, result.problems, strict=True))
