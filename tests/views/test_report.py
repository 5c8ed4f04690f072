"""The report of a study: its numbers, its sentences, its bytes."""

import html
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.analysis.inputs import words_of
from thirdbody.contact.output import AbstractOutput, Column
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.errors import Mistake
from thirdbody.quantities.say import number, percent, signed_number
from thirdbody.study import load_study
from thirdbody.study.one_surface import one_surface
from thirdbody.views.explicit_words import comparison_table, headline
from thirdbody.views.html import figure, symbols, text_table, words
from thirdbody.views.report import Row, laws_of, report, rows_of, source_of
from thirdbody.views.report.sources import STANDING

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
STEEL = tb.materials["S45C"]
TWO_BODY = """
title = "Two rough bodies"
[surfaces]
first = "100Cr6"
second = { E = "210 GPa", nu = 0.3, H = "7 GPa", name = "ours", source = "our laboratory" }
[roughness]
sigma = "100 nm"
R = "2.8 um"
[load]
pressure = "5 MPa"
"""
DUSTY = """
title = "Dust <and> steel & co"
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
alpha = 6.0
[particles]
material = "SiO2"
distribution = "truncated-gaussian"
mean = "300 nm"
std = "24 nm"
areal_density = "1e11 / m^2"
[outputs.counts]
[load]
pressure = { from = "1 MPa", to = "20 MPa", points = 5, spacing = "log" }
[uncertainty]
samples = 64
[uncertainty.inputs]
roughness.sigma = { low = "85 nm", high = "115 nm" }
"""
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


class Page(HTMLParser):
    """Tables by the heading above them, text, addresses; tags must be balanced."""

    def __init__(self, text):
        super().__init__()
        self.addresses, self.open, self.tables, self.text = [], [], {}, []
        self.heading, self.names, self.source = "", [], text
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.addresses += [given[key] for key in ("src", "href") if key in given]
        self.names += [given["id"]] if "id" in given else []
        if tag in ("meta", "img", "wbr", "br"):
            return
        self.open.append(tag)
        if tag in ("h1", "h2", "h3"):
            self.heading = ""
        if tag == "tr":
            self.tables.setdefault(self.heading, []).append([])
        if tag in ("th", "td"):
            self.tables[self.heading][-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)
        if {"h1", "h2", "h3"} & set(self.open):
            self.heading += data
        if {"th", "td"} & set(self.open):
            self.tables[self.heading][-1][-1] += data

    @property
    def whole(self):
        return " ".join("".join(self.text).split())


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def written(folder, text, name="study.toml"):
    file = folder / name
    file.write_text(text, "utf-8")
    return file


@pytest.fixture(scope="module")
def dusty(tmp_path_factory):
    file = written(tmp_path_factory.mktemp("dusty"), DUSTY)
    found = report(load_study(file), file=DUSTY)
    return found, Page(found.html())


@pytest.fixture(scope="module")
def two_body(tmp_path_factory):
    found = report(load_study(written(tmp_path_factory.mktemp("two"), TWO_BODY)))
    return found, Page(found.html())


@pytest.fixture
def no_figures(monkeypatch):
    """Figures cost most of a page; what a test says of its text needs none."""
    monkeypatch.setattr("thirdbody.views.report.page.figures_of", lambda report: [])


# ---------------------------------------------------------------- the answer
@pytest.mark.check
def test_the_answer_is_that_of_the_solver(dusty):
    found, _ = dusty
    first, second, third = found.sentences()
    low, high = (tb.solve(found.contact, pressure=p) for p in (1e6, 20e6))
    assert first.startswith("At 1 MPa ")
    assert second.startswith("At 20 MPa ")
    for sentence, state in ((first, low), (second, high)):
        assert f"({state.mode})" in sentence
        assert f" {100 * state.particle_load_share:.3g} % " in sentence
        assert f"{1e9 * state.h:.4g} nm apart" in sentence
        assert f" {percent(state.A_t)} " in sentence
    critical = tb.transitions(found.contact)
    assert f"F_cr1 = {number(critical.F_cr1.value)}" in third
    if critical.F_cr2.value is not None:
        assert f"F_cr2 = {number(critical.F_cr2.value)}" in third


def test_under_one_load_the_answer_says_how_far_the_mode_is_from_changing(tmp_path, no_figures):
    text = DUSTY.replace(
        '{ from = "1 MPa", to = "20 MPa", points = 5, spacing = "log" }', '"5 MPa"'
    )
    found = report(load_study(written(tmp_path, text.partition("[uncertainty]")[0])))
    critical = tb.transitions(found.contact).F_cr1.value * found.contact.E_ss
    third = found.sentences()[2]
    assert f"a factor {5e6 / critical:.3g} above F_cr1" in third
    assert "cases" not in third  # nothing is uncertain
    state = tb.solve(found.contact, pressure=5e6)
    assert f" {100 * state.A_p / state.A_t:.3g} % " in found.sentences()[1]
    assert found.assessment is None
    assert "states no ranges for S45C and SiO2" in Page(found.html()).whole


def test_two_bodies_have_no_modes(two_body):
    found, page = two_body
    assert "no particles" in found.sentences()[0]
    order = tb.sensitivity(found.contact, of="A_t", pressure=5e6).elasticity["A_t"]
    strongest = max(order, key=lambda label: abs(order[label]))
    assert words_of(found.contact, strongest) in found.sentences()[2]
    assert signed_number(order[strongest], 2, "%") in found.sentences()[2]
    assert "Critical loads" not in page.tables
    assert not re.search(r"\b(nan|inf|None)\b", page.whole)


# ---------------------------------------------------------------- tables
def test_states_and_outputs_are_those_of_the_solver(dusty):
    found, page = dusty
    loads = np.geomspace(1e6, 20e6, 5)
    state = tb.solve(found.contact, pressure=loads)
    head, *rows = page.tables["States"]
    assert [row[head.index("h")] for row in rows] == [f"{1e9 * h:.4g} nm" for h in state.h]
    assert [row[head.index("mode")] for row in rows] == list(state.mode)
    head, *rows = page.tables["Number of contacts"]
    table = {row[1]: row for row in rows}
    assert head[3:] == [row[1] for row in page.tables["States"][1:]]
    assert table["nss"][2] == "m⁻²"
    assert table["nss"][3:] == [words(f"{n:.4g}") for n in state.outputs["n_ss"]]
    assert table["psa"][3:] == [f"{p / 1e9:.4g} GPa" for p in state.outputs["p_sa"]]


def test_any_output_has_its_table(tmp_path, no_figures):
    """Columns are read from the output, whatever it is."""
    meaning = "twice the separation"

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Doubled(AbstractOutput):
        name, year = "doubled", 2026
        title, citation, provenance, valid_range = "Twice the gap", "nobody", "derived", "always"
        columns = {"h_twice": Column("h_2", "m", meaning)}

        def of(self, state):
            return {"h_twice": 2 * state.h}

    AbstractOutput.registry.pop("doubled")
    study = load_study(written(tmp_path, TWO_BODY))
    object.__setattr__(study, "contact", study.contact.replace(outputs=(Doubled(),)))
    page = Page(report(study).html())
    h = tb.solve(study.contact, pressure=5e6).h
    assert page.tables["Twice the gap"][1] == [
        meaning,
        "h2",
        "",
        f"{2e9 * h:.4g} nm",
    ]
    assert "nobody" in page.whole


def test_critical_loads(dusty):
    found, page = dusty
    critical = tb.transitions(found.contact)
    rows = {row[0]: row for row in page.tables["Critical loads"][1:]}
    assert rows["Fcr1"][1] == words(f"{critical.F_cr1.value:.4g}")
    assert rows["Ftpca B"][3] == critical.F_tpca.B.status
    assert rows["Ftpca A"][1:4] == ["-", "-", critical.F_tpca.A.status]


# ---------------------------------------------------------------- how sure
def test_error_bars_are_those_of_assess(dusty):
    found, page = dusty
    middle = np.geomspace(1e6, 20e6, 5)[2]
    again = tb.assess(
        found.contact.replace(outputs=()),
        vary={"roughness.sigma": (85e-9, 115e-9)},
        pressure=middle,
        samples=64,
    )
    assert found.assessment.propagation.bands["h"] == pytest.approx(again.propagation.bands["h"])
    rows = {row[0]: row for row in page.tables["State"][1:]}
    low, high = (again.propagation.bands["h"][i] for i in (0, 4))
    assert rows["separation of the mean planes"][2] == f"{1e9 * low:.4g} nm"
    assert rows["separation of the mean planes"][4] == f"{1e9 * high:.4g} nm"
    assert set(found.assessment.propagation.inputs) == set(found.study.uncertainty.inputs)


def test_ranges_of_the_library_are_named(two_body):
    found, page = two_body
    assert set(found.assessment.propagation.inputs) == {
        f"surfaces.first.{key}" for key in ("E", "nu", "H")
    }
    assert "has no table [uncertainty]" in page.whole
    assert found.assessment.propagation.samples == 256


def test_the_inputs_that_matter_come_first(dusty):
    found, page = dusty
    middle = float(np.geomspace(1e6, 20e6, 5)[2])
    slopes = tb.sensitivity(found.contact, of="particle_load_share", pressure=middle)
    size = {label: abs(x) for label, x in slopes.elasticity["particle_load_share"].items()}
    order = sorted(size, key=lambda label: -size[label])
    head, *rows = page.tables["Which inputs matter"]
    assert head[2] == COLUMNS["particle_load_share"].meaning
    first = [words_of(found.contact, label) for label in order]
    assert [row[0] for row in rows[:5]] == first[:5]
    assert f"{first[0]}, {first[1]} and {first[2]} matter most" in page.whole


# ---------------------------------------------------------------- what it rests on
def test_inputs_say_whether_they_are_defaults(dusty):
    found, page = dusty
    rows = {row.name: row for row in rows_of(found.contact)}
    told = ("roughness.alpha", "α", "6", "Nayak bandwidth", False, 6.0, "1")
    assert rows["roughness.alpha"] == Row(*told)
    assert rows["roughness.eta_R_sigma"].default
    assert rows["roughness.eta_R_sigma"].value == "0.0455"
    assert rows["particles.diameter.n"].default
    assert rows["particle_law"].default
    assert not rows["particles.areal_density"].default
    assert not any(name.startswith("surfaces") for name in rows)
    table = {row[4]: row for row in page.tables["Inputs and their sources"] if len(row) == 5}
    assert table["roughness.alpha"][3] == "study"
    assert table["asperity_law"][2:4] == ["zmc", "default"]
    given = found.contact.replace(roughness=tb.Roughness(sigma=1e-7, R=3e-6, eta=1e11))
    assert "roughness.eta_R_sigma" not in {row.name for row in rows_of(given)}


def test_materials_have_their_source_and_its_standing(two_body):
    _, page = two_body
    rows = {row[0]: row for row in page.tables["Inputs and their sources"]}
    assert rows["surface 1"][1] == "100Cr6"
    assert "62 HRC" in rows["surface 1"][3]
    assert rows["surface 1"][4] == STANDING[tb.materials.entries()["100Cr6"]["standing"]]
    of_study = rows["surface 2"][4]
    assert rows["surface 2"][3] == "our laboratory"
    assert of_study not in STANDING.values()
    assert source_of(tb.Material(E=1e9, nu=0.3, H=1e8)) == ("not stated", of_study)
    # the name of the library, with another number
    assert source_of(STEEL.replace(H=4e9))[1] == of_study
    assert source_of(STEEL)[1] == STANDING[tb.materials.entries()["S45C"]["standing"]]


def test_laws_say_who_chose_them(dusty):
    contact = dusty[0].contact.replace(asperity_law=tb.asperity.KE())
    (what, law, asked), (_, particles, default), (inner, hermite, _), counts = laws_of(contact)
    assert (what, law.name, asked) == ("asperities", "ke", True)
    assert (particles.name, default) == ("series", False)
    assert (inner, hermite.name) == ("particles: one indentation", "hermite")
    assert counts[1].name == "counts"
    page = dusty[1]
    table = {row[0]: row for row in page.tables["Which laws, and why"]}
    assert table["asperities"][2] == "default"
    assert "10.1115/1.555332" in table["asperities"][5]
    contact = dusty[0].contact
    rough = contact.roughness
    psi = contact.surfaces.E_star / contact.surfaces.H * (rough.sigma_s / rough.R) ** 0.5
    assert f"is {psi:.3g}: above 1" in page.whole
    for line in tb.cite(contact).splitlines():
        assert line in page.whole


@pytest.mark.parametrize(
    ("kind", "command"),
    [
        ("connector", "probability"),
        # whose grains are looked at one by one; tests/cli/test_every_way.py has its words
        pytest.param("wafer-chuck", "plate", marks=pytest.mark.slow),
    ],
)
def test_a_report_answers_first_what_the_study_asks(
    kind, command, tmp_path, monkeypatch, no_figures
):
    """In the words of the command that the question has, with its table and its warnings."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "400")
    for part in ("_assess", "_slopes"):  # a minute, and no part of the question
        monkeypatch.setattr(f"thirdbody.views.report.make.{part}", lambda *_: None)
    assert run("new", kind).exit_code == 0
    done = run(command, f"{kind}.toml")
    found = report(load_study(f"{kind}.toml"))
    lines = done.stdout.splitlines()
    assert " ".join(found.lead[0].split()) in lines
    for sentence in found.lead:
        assert sentence in done.stdout
    page = Page(found.html())
    cells = [re.split(r"\s{2,}", line.strip()) for line in lines]
    (title,) = {"How often dust keeps it open", "How high the plate stands"} & {*page.tables}
    rows = page.tables[title]
    assert len(rows) > 4
    assert all(row in cells for row in rows)
    for warning in (line for line in done.stderr.splitlines() if line.startswith("warning: ")):
        assert warning.removeprefix("warning: ") in page.whole


# ---------------------------------------------------------------- several populations, other laws
@pytest.mark.slow
def test_several_populations(tmp_path, no_figures):
    out = tmp_path / "page.html"
    file = EXAMPLES / "dust_and_debris.toml"
    few = ["--set", 'load.pressure=["0.1 MPa", "5 MPa"]']
    assert run("report", file, "--out", out, *few).exit_code == 0
    page = Page(out.read_text("utf-8"))
    study = load_study(file, few[1:])
    head, *rows = page.tables["What each population carries"]
    assert head == ["pressure", "dust: load", "dust: area", "debris: load", "debris: area"]
    dust, debris = study.solve().populations
    assert [row[1] for row in rows] == [f"{100 * share:.3g} %" for share in dust.load_share]
    assert [row[3] for row in rows] == [f"{100 * share:.3g} %" for share in debris.load_share]
    assert "assumed: work-hardened debris" in page.whole
    assert '\npressure = ["0.1 MPa", "5 MPa"]' in html.unescape(out.read_text("utf-8"))


def test_a_law_whose_load_does_not_tell_the_separation(tmp_path):
    text = DUSTY.replace("[outputs.counts]", '[particle_law]\nname = "horng2022"')
    text = text.partition("[uncertainty]")[0]
    found = report(load_study(written(tmp_path, text)))
    page = Page(found.html())
    assert found.assessment is None
    assert "inputs-that-matter" in page.names
    assert "horng2022" in page.whole
    assert not re.search(r"\b(nan|inf|None)\b", page.whole)


@pytest.mark.parametrize(
    "load", ['separation = "250 nm"', "F_star = [1e-6, 1e-5]", "pressure = [1e13, 1e6]"]
)
def test_every_kind_of_load(tmp_path, load):
    text = re.sub(r"pressure = .*", load, TWO_BODY).replace("100Cr6", "S45C")
    found = report(load_study(written(tmp_path, text)))
    page = Page(found.html())
    assert len(page.tables["States"]) == 1 + len(found.result["states"]["status"])
    assert ("1 of 2 states unsolved" in page.whole) == ("1e13" in load)


def test_surfaces_apart(tmp_path):
    text = DUSTY.partition("[outputs.counts]")[0] + '[load]\nseparation = ["3 um", "30 um"]\n'
    found = report(load_study(written(tmp_path, text)))
    assert found.result["states"]["mode"] == ["s-s", None]
    assert found.sentences()[0].startswith("At 0 Pa (F* = 0) ")
    assert "30.09 µm apart" in found.sentences()[0]
    assert found.slopes is None
    assert not re.search(r"\b(nan|inf|None)\b", Page(found.html()).whole)


@pytest.mark.spread(3)
@pytest.mark.parametrize("law", ["jkr", "gw", "elliptic-zmc"])
def test_laws_with_numbers_of_their_own(tmp_path, law):
    numbers = {
        "jkr": "w = 0.1",
        "elliptic-zmc": "ratio = 3.0",
    }
    text = TWO_BODY.partition("[load]")[0].replace("100Cr6", "S45C")
    text += f'[asperity_law]\nname = "{law}"\n{numbers.get(law, "")}\n'
    text += '[load]\nseparation = ["50 nm", "200 nm", "450 nm"]\n'
    found = report(load_study(written(tmp_path, text)))
    page = Page(found.html())
    assert law in page.whole
    assert len(page.tables["States"]) == 4


# ---------------------------------------------------------------- one file, always the same
def test_the_page_is_one_file(dusty, two_body):
    for found, page in (dusty, two_body):
        text = page.source
        assert all(a.startswith("data:image/svg+xml;base64,") for a in page.addresses)
        assert len(page.addresses) == (7 if found is dusty[0] else 5)
        assert not re.search(r"<script|<link|@import|url\(", text)
        assert "@media print" in text
        assert "prefers-color-scheme:dark" in text
        assert len(set(page.names)) == len(page.names)
        assert len(text) < 1_500_000
    assert "Dust &lt;and&gt; steel &amp; co" in dusty[1].source
    assert "<and>" not in dusty[1].source


@pytest.mark.slow
def test_the_same_study_gives_the_same_bytes(tmp_path, request):
    """In another process too, with another number of threads, hash seed and file name."""
    files = [written(tmp_path, TWO_BODY, name) for name in ("a.toml", "b.toml")]
    pages = [tmp_path / name for name in ("a.html", "b.html")]
    assert run("report", files[0], "--out", pages[0]).exit_code == 0
    command = [sys.executable, "-m", "thirdbody", "report", files[1], "--out", pages[1]]
    environment = os.environ | {"THIRDBODY_THREADS": "2", "PYTHONHASHSEED": "2", "TZ": "Asia/Tokyo"}
    subprocess.run([*map(str, command)], check=True, env=environment, capture_output=True)
    assert pages[0].read_bytes() == pages[1].read_bytes()
    request.getfixturevalue("no_figures")
    other = tmp_path / "other.html"
    assert run("report", files[0], "--out", other, "--set", "roughness.alpha=7").exit_code == 0
    assert ", with roughness.alpha = 7</h1>" in other.read_text("utf-8")
    assert "\nalpha = 7" in other.read_text("utf-8")
    assert "alpha = 7" not in pages[0].read_text("utf-8")


# ---------------------------------------------------------------- point by point
EXPLICIT = (EXAMPLES / "explicit.toml").read_text("utf-8")


@pytest.mark.slow
def test_a_study_with_explicit_surfaces_has_one_pressed(tmp_path, no_figures):
    study = load_study(written(tmp_path, EXPLICIT))
    found = report(study)
    page = Page(found.html())
    again = one_surface(study, study.values)
    head, rows = comparison_table(again)
    assert page.tables["Point by point"] == [head, *rows]
    assert headline(again, 1) in page.whole
    assert "128 × 128 points" in page.whole
    assert 'id="explicit"' in page.source or "id=explicit" in page.source
    assert page.source.count("<figure") == 1
    assert found.html() == page.source


def test_many_loads_are_thinned(tmp_path, no_figures):
    loads = 'F_star = { from = 1e-4, to = 1e-3, points = 30, spacing = "log" }'
    study = load_study(written(tmp_path, EXPLICIT.replace("F_star = [1e-4, 1e-3]", loads)))
    shown = report(study).pressed.state.F_star
    assert len(shown) == 5
    assert shown[[0, -1]] == pytest.approx([1e-4, 1e-3])


def test_a_surface_that_cannot_be_pressed_is_told(tmp_path, no_figures):
    text = re.sub(r"sigma = .*\nR .*\n", 'sigma = "300 um"\nR = "3 um"\n', EXPLICIT)
    found = report(load_study(written(tmp_path, text)))
    assert isinstance(found.pressed, str)
    assert words(found.pressed) in Page(found.html()).source


def test_others_have_no_such_part(dusty):
    assert dusty[0].pressed is None
    assert "explicit" not in dusty[1].names


# ---------------------------------------------------------------- refusals
def test_mistakes_are_those_of_solve(tmp_path):
    file = written(tmp_path, TWO_BODY.replace('"100 nm"', '"100 kg"').replace("R =", "r ="))
    out = tmp_path / "page.html"
    done, solved = run("report", file, "--out", out), run("solve", file)
    assert done.exit_code == solved.exit_code == 2
    assert done.stderr == solved.stderr != ""
    assert done.stdout == ""
    assert not out.exists()


def test_without_equilibrium_there_is_no_page(tmp_path):
    file = written(tmp_path, TWO_BODY.replace('"5 MPa"', "1e13"))
    out = written(tmp_path, before := "what was here", "page.html")
    done, solved = run("report", file, "--out", out, "--force"), run("solve", file)
    assert done.exit_code == solved.exit_code == 3
    assert done.stderr.splitlines()[-1] == solved.stderr.splitlines()[-1]
    assert out.read_text("utf-8") == before


def test_a_folder_that_does_not_exist(tmp_path):
    file = written(tmp_path, TWO_BODY)
    done = refused("report", file, "--out", tmp_path / "no" / "page.html")
    assert done.mistakes == [(Mistake.UNWRITABLE, "")]
    assert str(tmp_path / "no") in done.problems[0]
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


# ---------------------------------------------------------------- the parts of every page
@pytest.mark.parametrize(
    ("plain", "page"),
    [
        ("F* = 1.2e-05 at 2.8 um", "F* = 1.2×10⁻⁵ at 2.8 µm"),
        ("1e+11 1/m^2", "1×10¹¹ m⁻²"),
        ("3 W/m^2/K, 2 um^2", "3 W/(m² K), 2 um^2"),
        ("E_ss < H", "E<sub>ss</sub> &lt; H"),
        ("asperity_law.k and roughness.eta_R_sigma", "asperity_law.k and roughness.eta_R_sigma"),
        ("A_sa,t* and F_cr1", "A<sub>sa,t</sub>* and F<sub>cr1</sub>"),
    ],
)
def test_words_as_a_page_shows_them(plain, page):
    assert words(plain) == page


def test_parts_of_a_page():
    assert symbols("a<b") == "a&lt;b"
    assert 'alt="&quot;x&quot;"' in figure(b"<svg/>", '"x"')
    table = text_table(["a", "b", "where"], [["1", "2", "3"]], ["where"])
    assert "<td>1</td><td class=n>2</td><td class=words>3</td>" in table
    with pytest.raises(ValueError, match="zip"):
        text_table(["a", "b"], [["1"]])
