"""What a command may write: what it made itself, and files that its user names."""

import json
import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from command_line import refused, run
from damage import empty, flipped, missing, truncated
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.cli.commands import COMMANDS
from thirdbody.cli.options import parameters_of
from thirdbody.cli.own_files import need_places
from thirdbody.quantities.files import (
    hindrance_of_folder,
    need_folders,
    refuse_clashes,
    whole,
    write_text,
)
from thirdbody.study import run_film
from thirdbody.study.analyses import design_study
from thirdbody.views.html import document

from .test_cli import EXAMPLES

STUDY, EXPLICIT, DESIGN, FILM, ASSESS = (
    next(path for path in EXAMPLES if path.stem == stem)
    for stem in ("dusty_ball_screw", "explicit", "additive", "oil_film", "assess")
)

# of the files alone: what a picture shows, and what a search finds, is for other tests
pytestmark = pytest.mark.usefixtures("blank_pictures", "short_search", "found_once")


@pytest.fixture(scope="module")
def answers():
    return {}


@pytest.fixture
def found_once(monkeypatch, answers):
    """The best of a study, and what its film does, are found once, not by every run of a command."""

    def once(find):
        def find_once(study, *others, **options):
            asked = {name: value for name, value in options.items() if not callable(value)}
            key = find, repr((study, others, asked))
            if key not in answers:
                answers[key] = find(study, *others, **options)
            return answers[key]

        return find_once

    for place, find in (
        ("analyses.design_study", design_study),
        ("run_film", run_film),
    ):
        monkeypatch.setattr(f"thirdbody.study.{place}", once(find))


def contents(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


# ---------------------------------------------------------------- folders
FOLDERS = {
    "sweep": ("sweep", STUDY.with_name("sweep.toml")),
    "explicit": ("explicit", EXPLICIT, "--surfaces", "1", "--size", "64", "--spacing", "300 nm"),
    "reproduce": ("reproduce", "wu2017"),
}


@pytest.mark.parametrize("name", [".git/a.partial", ".film.part.mkv", "index.html", "states.csv",
                                  "study.json", "surfaces/mine.json", "lock"])  # fmt: skip
@pytest.mark.parametrize("kind", FOLDERS)
def test_a_folder_of_somebody_else_is_refused(tmp_path, kind, name):
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    before = contents(tmp_path)
    done = run(*FOLDERS[kind], "--out", tmp_path)
    assert done.exit_code == 2, done.output
    assert done.stderr.count("error:") == 1
    assert "give a" in done.stderr
    assert contents(tmp_path) == before


@pytest.mark.check
def test_explicit_keeps_the_results_of_another_study(tmp_path):
    words = FOLDERS["explicit"]
    assert run(*words, "--out", tmp_path).exit_code == 0
    before = contents(tmp_path)
    for change, said in [
        ("roughness.sigma=310 nm", ("inputs.roughness.sigma", " 3e-07 ", " 3.1e-07 ")),
        ("explicit.seed=1", ("explicit.seed", " null ", " 1 ")),
        ("load.F_star=[1e-3]", ("F_star",)),
    ]:
        (problem,) = refused(*words, "--out", tmp_path, "--set", change).problems
        assert problem.code is Mistake.OTHER_STUDY
        assert all(each in problem for each in said)
    assert contents(tmp_path) == before
    # more of the same goes on, less does not
    more = [*words[:2], "--surfaces", "2", *words[4:]]
    assert run(*more, "--out", tmp_path).exit_code == 0
    (problem,) = refused(*words, "--out", tmp_path).problems
    assert problem.code is Mistake.OTHER_STUDY
    assert all(each in problem for each in ("surfaces", " 2 ", " 1 "))


def test_a_study_that_explicit_refuses_leaves_nothing(tmp_path):
    done = run(*FOLDERS["explicit"], "--out", tmp_path / "o", "--set", "roughness.sigma=300 um")
    assert done.exit_code == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.check
def test_folders_of_an_earlier_version_of_explicit_go_on(tmp_path):
    words = FOLDERS["explicit"]
    assert run(*words, "--out", tmp_path).exit_code == 0
    wanted = contents(tmp_path)
    for file in [tmp_path / "study.json", tmp_path / "surfaces" / "surface_000.json"]:
        said = json.loads(file.read_text("utf-8"))
        del said["sha256"]
        file.write_text(json.dumps(said))
    (tmp_path / "study.json").unlink()
    done = run(*words, "--out", tmp_path)
    assert done.exit_code == 0, done.output
    assert "kept.unchecked" in done.codes
    assert json.loads((tmp_path / "explicit.json").read_text()) == json.loads(
        wanted["explicit.json"]
    )
    (tmp_path / "study.json").unlink()
    (other,) = refused(*words, "--out", tmp_path, "--set", "roughness.sigma=310 nm").problems
    assert other.code is Mistake.OTHER_STUDY
    assert "inputs.roughness.sigma" in other


@pytest.mark.parametrize("words", [("surface", "example"), ("compare", STUDY, "--laws", "gw")])
def test_names_that_a_command_chooses_are_taken_from_nobody(tmp_path, words):
    out = tmp_path / "o"
    assert run(*words, "--out", out).exit_code == 0
    assert run(*words, "--out", out).exit_code == 0
    other = {"surface": ("--cutoff", "3 um"), "compare": ("--set", "roughness.sigma=90 nm")}
    before = contents(out)
    done = refused(*words, *other[words[0]], "--out", out)
    assert done.mistakes == [(Mistake.OTHER_STUDY, "")]
    assert contents(out) == before
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / f"{words[0]}.png").write_text("mine")
    assert run(*words, "--out", mine).exit_code == 2
    assert contents(mine) == {f"{words[0]}.png": b"mine"}


# ---------------------------------------------------------------- files
@pytest.mark.check
@pytest.mark.parametrize(
    ("kind", "command"),
    [
        ("connector", "probability"), ("wafer-chuck", "plate"), ("oil-circuit", "life"),
        ("dry-contact", "life"),
    ],
)  # fmt: skip
def test_the_tables_of_a_question_are_written_again(tmp_path, kind, command):
    study, files = tmp_path / "study.toml", [tmp_path / "a.csv", tmp_path / "a.xlsx"]
    assert run("new", kind, "--out", study).exit_code == 0
    asked = (command, study, "--csv", files[0], "--xlsx", files[1])
    assert run(*asked).exit_code == 0
    before = contents(tmp_path)
    done = run(*asked)
    assert done.exit_code == 0, done.output
    assert contents(tmp_path) == before
    files[0].write_text("time [s],code\n0,mine\n")
    assert run(*asked).exit_code == 2
    assert files[0].read_text() == "time [s],code\n0,mine\n"


@pytest.mark.parametrize(
    "words",
    [
        ("solve", STUDY, "--csv"), ("film", FILM, "--csv"), ("film", FILM, "--figure"),
        ("design", DESIGN, "--csv"), ("compare", STUDY, "--csv"), ("assess", ASSESS, "--html"),
        ("report", STUDY, "--out"), ("table", STUDY, "--format", "csv", "--out"),
    ],
    ids=lambda words: f"{words[0]} {words[-1]}",
)  # fmt: skip
def test_the_study_is_not_written_over(tmp_path, words):
    study = tmp_path / ("study.png" if words[-1] == "--figure" else "study.toml")
    study.write_bytes(words[1].read_bytes())
    for name in ("materials.toml", "sizes.csv"):
        if words[1].with_name(name).exists():
            (tmp_path / name).write_bytes(words[1].with_name(name).read_bytes())
    before = contents(tmp_path)
    done = run(words[0], study, *words[2:], study)
    assert done.exit_code == 2, done.output
    assert f"cannot write {study}: {study} is read" in done.stderr
    assert contents(tmp_path) == before


def test_a_measured_surface_is_not_written_over(tmp_path):
    scan = tmp_path / "scan.csv"
    scan.write_text("1,2\n3,4\n")
    done = run("surface", scan, "--spacing", "1 um", "--unit", "um", "--csv", scan)
    assert done.exit_code == 2
    assert "is read" in done.stderr
    assert scan.read_text() == "1,2\n3,4\n"


def test_two_tables_do_not_go_into_one_file(tmp_path):
    with refuses(Mistake.UNWRITABLE, "", says=str(tmp_path / "t")):
        refuse_clashes([tmp_path / "t", None, tmp_path / "t"], [])
    refuse_clashes([Path(os.devnull), Path(os.devnull), None], [])


EASY = ("design", DESIGN)
for easier in ("points=8", 'pressure=["5 MPa"]', "limits=[]"):
    EASY += ("--set", f"design.{easier}")
ONE_FILE = {
    "solve.csv": ("solve", STUDY, "--csv"),
    "solve.xlsx": ("solve", STUDY, "--xlsx"),
    "solve.parquet": ("solve", STUDY, "--parquet"),
    "film.csv": ("film", FILM, "--set", "film.speed.points=3", "--csv"),
    "film.png": ("film", FILM, "--set", "film.speed.points=3", "--figure"),
    "film.svg": ("film", FILM, "--set", "film.speed.points=3", "--figure"),
    "film.pdf": ("film", FILM, "--set", "film.speed.points=3", "--figure"),
    "design.csv": (*EASY, "--csv"),
    "design.png": (*EASY, "--figure"),
    "compare.csv": ("compare", STUDY, "--laws", "gw", "--csv"),
    "surface.csv": ("surface", "example", "--csv"),
    "surface.xlsx": ("surface", "example", "--xlsx"),
    "table.csv": ("table", STUDY, "--tolerance", "1e-3", "--out"),
    "table.inp": ("table", STUDY, "--tolerance", "1e-3", "--out"),
    "table.txt": ("table", STUDY, "--tolerance", "1e-3", "--out"),
    "table.avl": ("table", STUDY, "--tolerance", "1e-3", "--out"),
    "table.py": ("table", STUDY, "--tolerance", "1e-3", "--out"),
    "table.c": ("table", STUDY, "--tolerance", "1e-3", "--out"),
}
"""Files that a command writes quickly, and the command up to the name of the file."""


@pytest.mark.spread(3)
@pytest.mark.parametrize("name", ONE_FILE)
def test_a_file_of_somebody_else_is_replaced_by_force_only(tmp_path, name):
    """Our own file of an earlier run, and an empty one, are replaced without asking."""
    for library in {"xlsx": ["openpyxl"], "parquet": ["pyarrow"]}.get(name.partition(".")[2], []):
        pytest.importorskip(library)
    file = tmp_path / name
    file.touch()
    assert run(*ONE_FILE[name], file).exit_code == 0
    wanted = file.read_bytes()
    assert run(*ONE_FILE[name], file).exit_code == 0, "our own file is refused"
    assert contents(tmp_path) == {name: wanted}
    file.write_bytes(b"mine")
    done = refused(*ONE_FILE[name], file)
    (problem,) = done.problems
    assert problem.code is Mistake.UNWRITABLE
    assert all(each in problem for each in (str(file), "--force"))
    assert done.stdout == ""
    assert contents(tmp_path) == {name: b"mine"}
    assert run(*ONE_FILE[name], file, "--force").exit_code == 0
    assert contents(tmp_path) == {name: wanted}


def of_excel(file):
    """Saved by somebody since."""
    from openpyxl import load_workbook

    book = load_workbook(file)
    book.active["A1"].comment = None
    book.save(file)


STRANGERS = {
    "solve.csv": b"time,force\n1,2\n",
    "solve.xlsx": of_excel,
    "film.png": lambda file: __import__("matplotlib.figure").figure.Figure().savefig(file),
    "film.svg": lambda file: __import__("matplotlib.figure").figure.Figure().savefig(file),
    "film.pdf": lambda file: __import__("matplotlib.figure").figure.Figure().savefig(file),
    "table.csv": b"h [m],p [Pa]\n1,2\n",
    "table.py": b"# my script\n",
}


@pytest.mark.parametrize("name", STRANGERS)
def test_a_file_of_the_same_kind_is_told_from_ours(tmp_path, name):
    file = tmp_path / name
    made = STRANGERS[name]
    if isinstance(made, bytes):
        file.write_bytes(made)
    else:
        if name.endswith("xlsx"):
            pytest.importorskip("openpyxl")
            assert run(*ONE_FILE[name], file).exit_code == 0
        made(file)
    before = contents(tmp_path)
    done = run(*ONE_FILE[name], file)
    assert done.exit_code == 2, done.output
    assert "--force" in done.stderr
    assert contents(tmp_path) == before


def test_one_of_ours_of_another_kind_is_not_replaced(tmp_path):
    """As where two options are mixed up."""
    file = tmp_path / "film.png"
    assert run(*ONE_FILE["film.png"], file).exit_code == 0
    before = contents(tmp_path)
    (problem,) = refused(*ONE_FILE["film.csv"], file).problems
    assert problem.code is Mistake.UNWRITABLE
    assert all(each in problem for each in (str(file), "--force"))
    assert contents(tmp_path) == before


@pytest.mark.parametrize("words", [("report", STUDY, "--out"), ("assess", ASSESS, "--html")])
def test_a_page_takes_the_place_of_a_page_only(tmp_path, words):
    file = tmp_path / "mine.html"
    file.write_text("<p>mine</p>")
    # what is printed of it: the one place that holds these words
    (problem,) = refused(*words, file).problems
    assert problem.startswith(f"cannot write {file}: it exists and is no page of thirdbody; ")
    assert problem.code is Mistake.UNWRITABLE
    assert file.read_text() == "<p>mine</p>"
    file.write_text(document("Report", []))
    need_places([(file, "page")], force=False)


def test_the_usual_report_takes_the_place_of_a_report_only(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "report.html").write_text("<p>mine</p>")
    (problem,) = refused("report", STUDY).problems
    assert problem.code is Mistake.UNWRITABLE
    assert all(each in problem for each in ("report.html", "--force"))
    assert (tmp_path / "report.html").read_text() == "<p>mine</p>"


def options_of(command):
    return {
        name
        for each in parameters_of(command)
        for kind in getattr(each.annotation, "__metadata__", ())
        for name in (getattr(kind, "default", None), *(getattr(kind, "param_decls", None) or ()))
    }


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_that_writes_a_file_has_force(name):
    """`new` writes a study, which a user has changed since; folders say whose they are."""
    options = options_of(import_module(f"thirdbody.cli.commands.{name}").command)
    writes = options & {"--csv", "--xlsx", "--parquet", "--figure", "--html"}
    if writes or name in ("report", "table"):
        assert "--force" in options
    else:
        assert "--out" not in options or name in ("new", "sweep", "explicit", "reproduce")


@pytest.mark.parametrize("words", [("surface", "example"), ("compare", STUDY, "--laws", "gw")])
def test_a_folder_is_judged_before_the_work_and_replaced_by_force(tmp_path, words, monkeypatch):
    out = tmp_path / "o"
    assert run(*words, "--out", out).exit_code == 0
    wanted = contents(out)
    main = next(each for each in wanted if each.endswith(("csv", "json")))
    (out / main).write_text("mine")
    with monkeypatch.context() as patch:
        for place in (
            "analysis.compare.comparison_of",
            "populations.measured.topography.read_surface",
        ):
            patch.setattr(f"thirdbody.{place}", None, raising=False)  # nothing is worked out
        done = run(*words, "--out", out)
    assert done.exit_code == 2
    assert "--force" in done.stderr
    assert (out / main).read_text() == "mine"
    assert run(*words, "--out", out, "--force").exit_code == 0
    assert contents(out) == wanted


@pytest.mark.parametrize(
    "words",
    [*FOLDERS.values(), ("surface", "example"), ("compare", STUDY, "--laws", "gw")],
    ids=lambda words: words[0],
)
def test_a_folder_that_cannot_be_made_is_told_before_the_work(tmp_path, words):
    if not Path("/proc/self").exists():
        pytest.skip("this system has no folder that takes no files")
    done = run(*words, "--out", "/proc/thirdbody")
    assert done.exit_code == 2
    assert done.stderr.count("error:") == 1
    assert "/proc" in done.stderr
    assert "..." not in done.stderr  # no stage has begun
    (tmp_path / "file").write_text("mine")
    done = run(*words, "--out", tmp_path / "file" / "o")
    assert done.exit_code == 2
    assert done.stderr.count("error:") == 1


def test_a_folder_is_taken_whatever_lies_in_it(tmp_path):
    (tmp_path / "a").mkdir()
    before = contents(tmp_path)
    assert hindrance_of_folder(tmp_path) == hindrance_of_folder(tmp_path / "new") == ""
    assert contents(tmp_path) == before


# ---------------------------------------------------------------- drafts
GONE = 2**22 + 1
"""A number that no process has."""


def test_the_next_run_of_a_file_removes_what_a_killed_one_left(tmp_path):
    code = (
        "import os, signal, sys\nfrom thirdbody.quantities.files import whole\n"
        "with whole(sys.argv[1]) as draft:\n"
        "    draft.write_text('half')\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    file = tmp_path / "old.csv"
    subprocess.run([sys.executable, "-c", code, str(file)], check=False)
    (left,) = tmp_path.iterdir()
    assert left.name.startswith(".old.")
    (tmp_path / ".old.01ab23cd.part.csv").write_text("of an earlier version")
    kept = {".old.part.csv", ".old.film.part.csv", ".older.01ab23cd.part.csv", ".old.01ab23cd.part"}
    for name in kept:
        (tmp_path / name).write_text("mine")
    write_text(file, "new")
    assert {each.name for each in tmp_path.iterdir()} == kept | {"old.csv"}


def test_a_draft_that_is_being_written_stays(tmp_path):
    file = tmp_path / "old.csv"
    with whole(file) as first:
        first.write_text("first")
        with whole(file) as second:
            second.write_text("second")
        assert first.exists()
        stranger = tmp_path / first.name.replace(f"-{os.getpid():x}-", f"-{GONE:x}-")
        stranger.write_text("left")
        write_text(file, "third")
        assert not stranger.exists()
        assert first.exists()
    assert file.read_text() == "first"
    assert [each.name for each in tmp_path.iterdir()] == ["old.csv"]


# ---------------------------------------------------------------- damage
DAMAGES = pytest.mark.parametrize(
    "damage",
    [
        missing,
        flipped,
        pytest.param(empty, marks=pytest.mark.slow),
        pytest.param(truncated, marks=pytest.mark.slow),
    ],
)
QUICK = [name for name in ONE_FILE if name.startswith(("solve", "film.png", "film.svg", "table"))]


@pytest.mark.spread(3)
@DAMAGES
@pytest.mark.parametrize("name", QUICK)
def test_a_damaged_file_is_written_anew(tmp_path, name, damage):
    """Nobody reads it back; what still says that it is ours is replaced, the rest by force."""
    for library in {"xlsx": ["openpyxl"], "parquet": ["pyarrow"]}.get(name[6:], []):
        pytest.importorskip(library)
    file = tmp_path / name
    assert run(*ONE_FILE[name], file).exit_code == 0
    wanted = file.read_bytes()
    damage(file)
    before = contents(tmp_path)
    done = run(*ONE_FILE[name], file)
    assert "Traceback" not in done.output
    if done.exit_code == 2:
        # the half of a picture with nothing on it may be without the line that says whose it is
        assert name.endswith(("xlsx", "parquet")) or b"thirdbody" not in before[name]
        assert "--force" in done.stderr
        assert contents(tmp_path) == before
        done = run(*ONE_FILE[name], file, "--force")
    assert done.exit_code == 0
    assert contents(tmp_path) == {name: wanted}


@DAMAGES
@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("surface", "example"), "surface.json"),
        (("surface", "example"), "surface.svg"),
        (("compare", STUDY, "--laws", "gw"), "compare.csv"),
        (("compare", STUDY, "--laws", "gw"), "compare.png"),
    ],
)
def test_damaged_files_of_a_folder_are_written_anew_or_left(tmp_path, words, name, damage):
    """What says whose a folder is, and is damaged, may be somebody else's."""
    assert run(*words, "--out", tmp_path).exit_code == 0
    wanted = contents(tmp_path)
    damage(tmp_path / name)
    before = contents(tmp_path)
    done = run(*words, "--out", tmp_path)
    assert "Traceback" not in done.output
    if name.endswith(("json", "csv")):
        assert done.exit_code == 2
        assert done.mistakes == [(Mistake.OTHER_STUDY, "")]
        assert contents(tmp_path) == before
    else:
        assert done.exit_code == 0
        assert contents(tmp_path) == wanted


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("/proc/thirdbody.csv", "/proc takes no files; give another folder"),
        (".", "it is a folder; give the name of a file"),
        ("nowhere/a.csv", "there is no folder"),
    ],
)
def test_a_file_that_cannot_be_made_is_refused_before_the_work(place, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if place.startswith("/proc") and not Path("/proc/self").exists():
        pytest.skip("this system has no folder that takes no files")
    with pytest.raises(tb.errors.InvalidValue, match=re.escape(said)):
        need_folders(place)
    assert list(tmp_path.iterdir()) == []
    need_folders(tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []
