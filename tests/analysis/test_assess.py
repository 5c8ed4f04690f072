"""The page for an engineer: its numbers, its sentences, its bytes."""

import html
import itertools
import json
import math
import os
import re
import subprocess
import sys
import warnings
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses
from steel_and_dust import DUSTY, TWO_BODY
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.analysis.assess import about_fragments, assess
from thirdbody.analysis.assessment import NO_RANGES
from thirdbody.analysis.inputs import inputs as inputs_of
from thirdbody.analysis.inputs import words_of
from thirdbody.analysis.uncertainty import propagation, samples
from thirdbody.analysis.uncertainty.samples import enough
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.compiled.batch import available
from thirdbody.equilibrium.critical_loads import critical_loads
from thirdbody.errors import code_of
from thirdbody.quantities import progress
from thirdbody.quantities.say import NOT_KNOWN, number, percent, value_of
from thirdbody.study import load_study
from thirdbody.study.analyses import assess_study
from thirdbody.views import assess_page, plot

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "assess.toml"
FEW = ["--set", "uncertainty.samples=64"]
SMALL = FEW[1:]
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def strict(text):
    def refuse(token):
        raise AssertionError(f"{token} is not JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.fixture(scope="module")
def page():
    return assess_study(load_study(EXAMPLE, ["uncertainty.samples=512"]))


# ---------------------------------------------------------------- what it says
def test_the_mode_and_its_probability_are_those_of_the_samples(page):
    found = page.propagation
    assert page.mode == tb.solve(found.contact, pressure=5e6).mode == "hybrid"
    assert sum(found.mode_probability.values()) == pytest.approx(1)
    text = page.headline()
    assert "At 5 MPa" in text
    for mode in ("p-s", "hybrid"):
        assert f"{mode} {100 * found.mode_probability[mode]:.3g} %" in text


def test_where_the_mode_changes_it_changes(page):
    contact = page.propagation.contact
    assert {change.input for change in page.changes} == {
        "roughness.sigma",
        "particles.diameter.mean",
        "particles.areal_density",
    }
    for change in page.changes:
        start = tb.sensitivity(contact, of="A_t", to=change.input, pressure=5e6).inputs
        away = 1 if change.value > start[change.input] else -1
        modes = [
            tb.solve(
                contact.replace(**{change.input: change.value * (1 + away * side * 2e-3)}),
                pressure=5e6,
            ).mode
            for side in (-1, 1)
        ]
        assert modes == [page.mode, change.mode]
        known = page.propagation.inputs[change.input]
        beyond = known.cdf(change.value) if away < 0 else 1 - known.cdf(change.value)
        assert change.beyond == pytest.approx(beyond, abs=1e-12)
    assert [c.beyond for c in page.changes] == sorted(
        (c.beyond for c in page.changes), reverse=True
    )


def test_inputs_are_ranked_by_what_each_does_alone(page):
    assert page.decisive == "F_cr1"
    assert sum(page.matter.values()) == pytest.approx(1)
    parts = list(page.matter.values())
    assert parts == sorted(parts, reverse=True)
    contact = page.propagation.contact
    ways = {}
    for label in ("roughness.sigma", "particles.areal_density"):
        ends = [page.propagation.inputs[label].quantile(q) for q in (0.05, 0.95)]
        loads = [tb.transitions(contact.replace(**{label: end})).F_cr1.value for end in ends]
        assert page.tornado["F_cr1"][label] == pytest.approx(loads, rel=1e-5)
        ways[label] = np.log(loads[1] / loads[0]) ** 2
    ratio = page.matter["roughness.sigma"] / page.matter["particles.areal_density"]
    assert ratio == pytest.approx(ways["roughness.sigma"] / ways["particles.areal_density"])
    slope = tb.sensitivity(contact, of="F_cr1", to="roughness.sigma").elasticity["F_cr1"]
    assert page.elasticity["roughness.sigma"] == pytest.approx(slope["roughness.sigma"])
    # what the example says of itself
    assert slope["roughness.sigma"] == pytest.approx(-10, abs=1)
    assert page.elasticity["particles.diameter.mean"] == pytest.approx(13, abs=0.5)


def test_sentences_hold_the_numbers(page):
    parts = {part.title: part for part in page.sections()}
    margin = page.propagation.nominal["F/F_cr1"]
    assert f" {margin:.3g} times F_cr1" in parts["Margins"].sentences[0]
    strongest = max(page.matter, key=page.matter.get)
    words = words_of(page.propagation.contact, strongest)
    assert words in parts["Inputs that matter"].sentences[1]
    text = " ".join(parts["What this rests on"].sentences)
    assert "512 samples" in text
    (exact,) = (label for label in page.exact if label == "particles.diameter.std")
    assert words_of(page.propagation.contact, exact) in text
    for part in parts.values():
        assert len({len(part.head), *map(len, part.rows)}) <= 2
        assert not re.search(r"\b(nan|inf|None)\b", " ".join(part.sentences))


def test_two_bodies_have_no_modes_to_change():
    page = tb.assess(TWO_BODY, vary={"roughness.R": (2e-6, 3e-6)}, pressure=5e6, samples=64)
    assert page.mode == "s-s"
    assert page.decisive == "A_t"
    assert page.changes == ()
    assert [part.title for part in page.sections()][1] == "State"
    assert "no particles" in page.headline()
    assert strict(json.dumps(page.to_dict(), allow_nan=False))["decisive"] == "A_t"
    assert assess_page.page(page).count("<img") == 2


def test_a_nominal_value_outside_its_range_is_told():
    page = tb.assess(DUSTY, vary={"roughness.R": (3e-6, 4e-6)}, pressure=5e6, samples=64)
    (told,) = [note for note in page.notes if code_of(note) == "uncertainty.outside.roughness.R"]
    assert " 2.8 µm " in told


def test_only_the_load_uncertain():
    known = {"pressure": tb.Uncertain.lognormal(median=5e6, gsd=3.0)}
    page = tb.assess(DUSTY, vary=known, pressure=5e6, samples=256)
    share = page.propagation.mode_probability["p-s"]
    critical = tb.transitions(DUSTY).F_cr1.value * DUSTY.E_ss
    assert share == pytest.approx(known["pressure"].cdf(critical), abs=0.02)
    assert "operating load" in assess_page.page(page)


# ---------------------------------------------------------------- refusals
def test_without_ranges_it_answers_what_can_be_told(tmp_path, page):
    """Mode, margins and what would change the mode are those of the values; no probability."""
    file = tmp_path / "bare.toml"
    file.write_text(EXAMPLE.read_text("utf-8").partition("[uncertainty]")[0], "utf-8")
    contact = load_study(file).contact
    assert not tb.analysis.uncertainty.inputs.library_ranges(contact)
    done = run("assess", file, "--html", tmp_path / "page.html")
    assert done.exit_code == 0, done.stderr
    text = " ".join(done.stdout.split())
    assert text.count(" ".join(NO_RANGES.split())) == 1
    for word in ("MARGINS", "WHAT WOULD CHANGE THE MODE", "(hybrid)"):
        assert word in text
    for word in ("robability of", "nine of ten", "95 %", "outside its range"):
        assert word not in text
    bare = tb.assess(contact, pressure=5e6)
    critical = tb.transitions(contact).F_cr1.value
    assert bare.propagation.nominal["F_cr1"] == pytest.approx(critical, rel=1e-4)
    for change in bare.changes:
        for factor in (1 / 1.003, 1.003):
            names = change.input.split("+")
            own = tb.analysis.inputs.inputs(contact)
            ratio = change.value * factor / own[names[0]]
            moved = contact.replace(**{name: own[name] * ratio for name in names})
            there = tb.solve(moved, pressure=5e6).mode
            outside = (factor > 1) == (ratio > 1)
            assert (there == change.mode) == outside, change
    told = strict(run("assess", file, "--json").stdout)
    assert told["propagation"]["inputs"] == {}
    assert {change["probability"] for change in told["changes"]} == {None}


def test_ranges_of_each_of_several_populations_count(monkeypatch):
    entries = {name: dict(entry) for name, entry in tb.materials.entries().items()}
    entries["SiO2"]["range"] = {"H": [7e9, 8e9]}
    monkeypatch.setattr(type(tb.materials), "entries", staticmethod(lambda: entries))
    several = DUSTY.replace(particles=(DUSTY.particles,))
    found = tb.analysis.uncertainty.inputs.library_ranges(several)
    assert "particles.0.material.H" in found


def test_ranges_of_the_library_are_named(monkeypatch):
    entries = {name: dict(entry) for name, entry in tb.materials.entries().items()}
    entries["S45C"]["range"] = {"H": [4.5e9, 5.5e9]}
    entries["SiO2"]["range"] = {}
    monkeypatch.setattr(type(tb.materials), "entries", staticmethod(lambda: entries))
    page = tb.assess(DUSTY, pressure=5e6, samples=64)
    assert list(page.propagation.inputs) == ["surfaces.first.H+surfaces.second.H"]
    assert any(
        note.startswith("Ranges of the materials library: hardness of both") for note in page.notes
    )


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ('uncertainty.inputs={ "roughness.sigma" = "5 GPa" }', "must be one of { low, high }"),
    ],
)
def test_mistakes(setting, words):
    done = run("assess", EXAMPLE, "--set", setting)
    assert done.exit_code == 2
    assert words in done.stderr
    assert done.stdout == ""


def test_a_load_beyond_the_model_has_no_page():
    done = run("assess", EXAMPLE, *FEW, "--set", "load.pressure=1e13")
    assert done.exit_code == 3


def test_inputs_that_move_nothing_are_not_ranked(monkeypatch):
    """Where the rank would be that of rounding errors: no bars, and a sentence that says so."""
    monkeypatch.setattr(sys.modules["thirdbody.views.assess_page"], "LOADS_SHOWN", 4)
    vary = {"surfaces.first.nu": (0.29, 0.29 + 1e-9)}
    page = tb.assess(DUSTY, vary=vary, pressure=5e6, samples=64)
    assert not page.moved
    assert all(math.isnan(part) for part in page.matter.values())
    (inputs,) = (part for part in page.sections() if part.title == "Inputs that matter")
    sentence, fixed = inputs.sentences
    assert "F_cr1" in sentence
    assert fixed == page.fixed_numbers_words()
    assert len(assess_page.pictures(page)) == 1


# ---------------------------------------------------------------- several loads
def ranked(**changes):
    """The sentences on the inputs of a page whose operating load, or number, is another."""
    vary = changes.pop("vary", {"roughness.sigma": (80e-9, 120e-9)})
    page = assess(DUSTY, vary=vary, samples=64, **changes)
    (part,) = (part for part in page.sections() if part.title == "Inputs that matter")
    return page, " ".join(part.sentences)


def test_a_critical_load_far_away_that_ranks_the_inputs_is_told_with_its_load():
    near, words = ranked(F_star=1e-5)
    critical = near.propagation.nominal[near.decisive]
    at = value_of(critical * DUSTY.E_ss, "Pa")
    assert at not in words
    far, words = ranked(F_star=critical / 30)
    nominal = far.propagation.nominal
    assert far.decisive == near.decisive == "F_cr1"
    assert f" {number(nominal['F/F_cr1'], 3)} " in words
    assert at in words


def test_a_number_of_particles_without_a_range_is_told_as_held_fixed():
    name = "particles.areal_density"
    page, words = ranked(F_star=1e-5)
    assert page.fixed_numbers == (name,)
    assert name in words
    vary = {name: tb.Uncertain.lognormal(median=DUSTY.particles.areal_density, gsd=1.5)}
    page, words = ranked(F_star=1e-5, vary=vary)
    assert page.fixed_numbers == ()
    assert page.fixed_numbers_words() == ""
    several = assess_study(load_study(EXAMPLE, ["load.pressure=[1e6, 5e6]", *SMALL]))
    assert not any(name in words for words in several.sections()[0].sentences)
    held = replace(several, pages=(ranked(F_star=1e-5)[0], *several.pages[1:]))
    assert any(name in words for words in held.sections()[0].sentences)


def bare(*settings):
    """The example without ranges."""
    study = load_study(EXAMPLE, settings)
    return replace(study, uncertainty=None)


def test_each_of_several_loads_has_its_row():
    """Modes, shares and margins are those that `solve` and `transitions` give."""
    # grains that keep their shape: by the table they keep 5 % of the area to the highest load
    law = ['particle_law.name="series"', 'particle_law.deep="off"']
    found = assess_study(bare('load.pressure=["0.5 MPa", "5 MPa", "1 GPa"]', *law))
    contact = found.pages[0].propagation.contact
    state = tb.solve(contact, pressure=[5e5, 5e6, 1e9])
    assert [page.mode for page in found.pages] == list(state.mode) == ["p-s", "hybrid", "s-s"]
    modes, _, changes, _ = found.sections()
    assert [row[modes.head.index("mode")] for row in modes.rows] == ["p-s", "hybrid", "s-s"]
    shares = [row[modes.head.index("particles' load")] for row in modes.rows]
    assert shares == [percent(share) for share in state.particle_load_share]
    transitions = tb.transitions(contact)
    over = [row[modes.head.index("over F_cr1")] for row in modes.rows]
    assert over == [number(F / transitions.F_cr1.value, 3) for F in state.F_star]
    assert "p-s → hybrid → s-s" in modes.sentences[0]
    # F_cr1 is the load that changes the first mode, F_cr2 that of the last
    ways = {row[0]: row for row in reversed(changes.rows) if row[1] == "load"}
    to = changes.head.index("to")
    assert ways["500 kPa"][to] == value_of(transitions.F_cr1.value * contact.E_ss, "Pa")
    assert ways["500 kPa"][-1] == ways["1 GPa"][-1] == "hybrid"
    for page in found.pages:
        alone = tb.assess(contact, pressure=page.propagation.loads)
        assert alone.changes == page.changes


def test_at_separations_the_loads_are_those_carried_there():
    found = assess_study(bare('load={ separation = ["400 nm", "250 nm", "20 um"] }'))
    contact = found.pages[0].propagation.contact
    state = tb.solve(contact, d=[400e-9, 250e-9])
    assert found.separations == (400e-9, 250e-9)
    loads = [page.propagation.nominal["F_star"] for page in found.pages]
    assert loads == pytest.approx(list(state.F_star), rel=1e-9)
    assert [page.mode for page in found.pages] == list(state.mode)
    (none,) = found.unsolved
    assert value_of(20e-6, "m") in none
    modes = found.sections()[0]
    assert any("separations" in said for said in modes.sentences)
    assert [row[modes.head.index("separation d")] for row in modes.rows] == ["400 nm", "250 nm"]


def test_of_many_loads_some_are_assessed():
    found = assess_study(
        bare("load.pressure={ from = 1e6, to = 1e8, points = 30, spacing = 'log' }",
             "particles.areal_density=0")
    )  # fmt: skip
    pressures = [page.propagation.nominal["pressure"] for page in found.pages]
    assert len(pressures) == 7
    assert pressures[0] == pytest.approx(1e6)
    assert pressures[-1] == pytest.approx(1e8)
    assert "7 of 30 loads" in " ".join(found.sections()[0].sentences)


def test_several_loads_on_the_command_line(tmp_path, monkeypatch):
    """With ranges: a probability of every mode; one JSON object, one page, fitting 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")
    file = tmp_path / "page.html"
    loads = ["--set", 'load.pressure=["1 MPa", "5 MPa"]']
    done = run("assess", EXAMPLE, *FEW, *loads, "--json", "--html", file)
    assert done.exit_code == 0, done.stderr
    told = strict(done.stdout)
    assert [page["mode"] for page in told["loads"]] == ["hybrid", "hybrid"]
    alone = strict(run("assess", EXAMPLE, *FEW, "--set", "load.pressure=5e6", "--json").stdout)
    assert told["loads"][1] == alone
    text = html.unescape(file.read_text("utf-8"))
    shown = run("assess", EXAMPLE, *FEW, *loads).stdout
    assert max(map(len, shown.splitlines())) <= 80
    for title in ("Mode at each load", "Critical loads", "What would change the mode"):
        assert title in text
        assert title.upper() in shown
    share = alone["propagation"]["mode_probability"]["hybrid"]
    assert percent(share) in shown
    assert percent(share) in text


def test_several_loads_of_which_the_study_says_they_scatter():
    """The scatter of the load is that of one load; it is left out, and told to be."""
    scatter = 'uncertainty.inputs={ "load.pressure" = { median = "5 MPa", gsd = 2.0 } }'
    study = load_study(EXAMPLE, [scatter, 'load.pressure=["1 MPa", "5 MPa"]'])
    found = assess_study(study)
    assert found.pages[0].propagation.inputs == {}
    assert any("its own scatter is left out" in said for said in found.sections()[0].sentences)


def test_loads_beyond_the_model_are_told_beside_the_others():
    found = assess_study(bare('load.pressure=["5 MPa", "10 TPa"]'))
    assert len(found.pages) == 1
    (said,) = found.unsolved
    assert "1×10¹³ Pa" in said


def test_every_force_on_a_body_has_its_page():
    body = 'body={ kind = "ball-on-flat", diameter = "6 mm" }'
    found = assess_study(bare(body, 'load={ force = ["5 N", "50 N"] }'))
    forces = [[note for note in page.notes if " N on" in note] for page in found.pages]
    assert [len(notes) for notes in forces] == [1, 1]
    ratio = found.pages[1].propagation.loads / found.pages[0].propagation.loads
    assert ratio == pytest.approx(10 ** (1 / 3), rel=1e-9)


@pytest.mark.slow
def test_what_loads_have_in_common_is_found_once(monkeypatch):
    """Critical loads are sought once for all loads; what is said of each load is, to the last
    digit, what is said of it alone."""
    loads = 'load.pressure=["0.5 MPa", "5 MPa", "50 MPa"]'
    study = load_study(EXAMPLE, ["uncertainty.samples=64", loads])
    sought = []

    def counted(*given, vary, count):
        sought.append(count)
        return critical_loads(*given, vary=vary, count=count)

    for module in (propagation, samples):
        monkeypatch.setattr(module, "critical_loads", counted)
    together = assess_study(study)
    assert len(sought) == 3  # of the samples, of the values themselves, at the ends of each input
    inputs = study.uncertainty.inputs
    for page in together.pages:
        pressure = page.propagation.loads
        alone = tb.assess(study.contact, pressure=pressure, vary=inputs, samples=64)
        assert replace(alone, title=study.title).to_dict() == page.to_dict()


@pytest.mark.slow
def test_outputs_have_their_bands_at_each_of_several_loads(monkeypatch):
    monkeypatch.setattr(samples, "LEAST", 8)
    loads = 'load.pressure=["0.5 MPa", "50 MPa"]'
    study = load_study(EXAMPLE, [loads, "outputs.dents={}"])
    # fewer than a study may ask for: what is compared are the same samples, solved twice
    study = replace(study, uncertainty=replace(study.uncertainty, samples=8))
    for page in assess_study(study).pages:
        found, inputs = page.propagation, study.uncertainty.inputs
        alone = tb.propagate(study.contact, pressure=found.loads, vary=inputs, samples=8)
        for name in ("n_dents_1", "dent_depth_1", "embedded_2"):
            assert found.bands[name] == pytest.approx(alone.bands[name], rel=1e-7), name
            assert found.nominal[name] == alone.nominal[name]


def test_of_two_changes_the_nearer_comes_first():
    """By the distance of each, where none has a probability."""
    page = tb.assess(bare("load.pressure=5e6").contact, pressure=5e6)
    own = inputs_of(page.propagation.contact)
    far = [abs(np.log(c.value / own[c.input.partition("+")[0]])) for c in page.changes]
    assert len(far) > 3
    assert far == sorted(far)


# ---------------------------------------------------------------- what comes out
@pytest.mark.check
def test_the_same_seed_gives_the_same_bytes(tmp_path, monkeypatch):
    """In another process too, with another number of threads and another hash seed."""
    files = [tmp_path / name for name in ("here.html", "there.html")]
    monkeypatch.setenv("THIRDBODY_THREADS", "1")
    here = run("assess", EXAMPLE, "--json", *FEW, "--html", files[0]).stdout
    command = [sys.executable, "-m", "thirdbody", "assess", EXAMPLE, "--json", *FEW]
    environment = os.environ | {"THIRDBODY_THREADS": "2", "PYTHONHASHSEED": "2"}
    there = subprocess.run(
        [*map(str, command), "--html", str(files[1])],
        capture_output=True,
        text=True,
        check=True,
        env=environment,
    ).stdout
    assert here == there
    assert files[0].read_bytes() == files[1].read_bytes()
    answer = strict(here)
    assert answer["title"] == load_study(EXAMPLE).title
    bands = answer["propagation"]["bands"]["F_cr1"]
    assert all(a <= b for a, b in zip(bands, bands[1:], strict=False))
    other = strict(run("assess", EXAMPLE, "--json", *FEW, "--set", "uncertainty.seed=1").stdout)
    assert other["propagation"]["bands"]["F_cr1"] != bands


class Outside(HTMLParser):
    """Every address that a page would load, and whether its tags are balanced."""

    def __init__(self):
        super().__init__()
        self.addresses, self.open = [], []

    def handle_starttag(self, tag, attrs):
        self.addresses += [v for k, v in attrs if k in ("src", "href")]
        if tag not in ("meta", "img", "link", "wbr"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_is_one_file(page):
    text = assess_page.page(page)
    reader = Outside()
    reader.feed(text)
    assert reader.open == []
    assert len(reader.addresses) == 2
    assert all(a.startswith("data:image/svg+xml;base64,") for a in reader.addresses)
    assert "<script" not in text
    assert "@media print" in text
    assert len(text) < 500_000


def test_terminal_shows_every_section(page):
    done = run("assess", EXAMPLE, *FEW)
    assert done.exit_code == 0
    for part in page.sections():
        assert part.title.upper() in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 120


# ---------------------------------------------------------------- figures
def test_bars_end_at_the_values(page):
    values = page.tornado["F_cr1"]
    ax = plot.tornado(page.propagation, "F_cr1", values=values)
    assert ax.get_xscale() == "log"
    middle = page.propagation.nominal["F_cr1"]
    ends = [bar.get_x() + bar.get_width() for bar in ax.patches]
    starts = {bar.get_x() for bar in ax.patches}
    assert starts == {middle}
    assert ends == pytest.approx([end for pair in values.values() for end in pair], rel=1e-9)
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels[0] == r"$\sigma$"
    assert any("$H$" in label for label in labels)
    with refuses(Mistake.UNKNOWN, "plot.tornado", says="'A_x'"):
        plot.tornado(page.propagation, "A_x")


def test_bands_enclose_the_median():
    loads = np.geomspace(1e6, 1e8, 4)
    found = tb.propagate(
        DUSTY,
        vary={"roughness.sigma": (85e-9, 115e-9)},
        pressure=loads,
        samples=64,
        outputs=["particle_load_share", "F_cr1"],
    )
    ax = plot.bands(found, mark=5e6)
    assert [line.get_label() for line in ax.lines] == ["median", "nominal", "this load"]
    outer = ax.collections[0].get_paths()[0].vertices[:, 1]
    assert outer.min() == found.bands["particle_load_share"].min()
    with refuses(Mistake.SHAPE, "plot.bands", says="'F_cr1'"):
        plot.bands(found, "F_cr1")
    with refuses(Mistake.BEYOND, "plot.bands", says="'A_t'"):
        plot.bands(found, "A_t")


def test_a_law_without_critical_loads_says_so_and_keeps_its_bands(monkeypatch):
    monkeypatch.setattr(sys.modules["thirdbody.views.assess_page"], "LOADS_SHOWN", 4)
    dusty = DUSTY.replace(particle_law=tb.particle.Horng2022())
    answer = assess(dusty, vary={"roughness.sigma": (90e-9, 110e-9)}, pressure=5e6, samples=64)
    margins, state = answer.sections()[1:3]
    (sentence,) = margins.sentences
    assert "Horng2022" in sentence
    assert state.rows
    assert answer.decisive == "particle_load_share"
    assert sentence in html.unescape(assess_page.page(answer))
    basis = answer.sections()[-1].sentences[0]
    assert "critical" not in basis


def test_the_page_is_made_for_small_and_dark_screens(page):
    """Tables scroll by themselves; every colour is a variable that the dark scheme sets."""
    text = assess_page.page(page)
    assert text.count("<div class=scroll><table>") == text.count("<table>") == 3
    style = text[text.index("<style>") : text.index("</style>")]
    assert "prefers-color-scheme:dark" in style
    light, dark = re.findall(r":root{(?:color-scheme:light dark;)?(--[^}]*)}", style)
    assert re.findall(r"--[a-z]+", light) == re.findall(r"--[a-z]+", dark)


@pytest.mark.slow
def test_particles_that_break_are_told_with_all_bounds_of_their_fragments():
    """What pieces bear is not known: nothing, their footprint, all of them; and what decides."""
    steel, quartz = tb.materials["S45C"], tb.materials["quartz"]
    dust = tb.Particles(
        material=quartz,
        diameter=tb.LogNormal(median=20e-6, gsd=1.3),
        areal_density=1e7,
        strength=tb.grains.WeibullStrength.of(quartz),
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=50e-9, R=20e-6),
        particles=dust,
        particle_law=tb.particle.Series(deep="off"),
    )
    (said,) = about_fragments(contact, {"pressure": 20e6})
    shares = []
    for word in ("gone", "footprint", "all"):
        each = dust.replace(strength=dust.strength.replace(fragments=word))
        state = tb.solve(contact.replace(particles=each), pressure=20e6)
        shares.append(float(state.particle_load_share))
        assert percent(shares[-1]) in said
    assert shares[0] < shares[1] < shares[2]
    assert "particles.strength.size_exponent" in said
    particles = ["particles.strength.sigma_0"]
    assert enough(contact, None, particles) == 64  # each is summed by itself
    whole = contact.replace(**{"particles.strength": None})
    assert not about_fragments(whole, {"pressure": 20e6})
    assert enough(whole, None, ["particles.material.H"]) == 4096


def test_few_samples_where_each_has_tables_of_its_own():
    """An answer in seconds, with as many samples as it says."""
    steel = tb.materials["100Cr6"]
    debris = tb.Particles(
        material=tb.materials["S45C"],
        areal_density=1e10,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    )
    soft = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=debris,
    )
    hard = soft.replace(particles=debris.replace(material=tb.materials["SiC"]))
    mixed = soft.replace(particles=(debris, hard.particles))
    unknown = soft.replace(particle_law=tb.particle.Series(deep="off", onset="jg"))
    materials, roughness = ["surfaces.first.H"], ["roughness.sigma"]
    compiled = 2**12 if available() else 64
    assert [enough(case, None, materials) for case in (soft, hard, mixed)] == [compiled] * 3
    assert enough(unknown, None, materials) == 64  # a model that no compiled engine knows
    assert [enough(case, None, roughness) for case in (soft, hard, mixed, unknown)] == [2**12] * 4
    assert enough(unknown, 512, materials) == 512


# ---------------------------------------------------------------- contacts that no model takes
def test_a_contact_tried_on_the_way_and_refused_ends_the_way_not_the_page(monkeypatch):
    """As a surface is that is too smooth for the seats of its particles."""
    smooth, why = 9.5e-8, "smooth for such particles"

    def refuses(contact, load, value, vary, count, **more):
        if np.any(vary["roughness.sigma"] < smooth):
            raise tb.errors.InvalidValue(why)
        return samples.columns_at(contact, load, value, vary, count, **more)

    monkeypatch.setattr("thirdbody.analysis.assess.columns_at", refuses)
    page = assess(DUSTY, pressure=5e6, vary={"roughness.sigma": (90e-9, 110e-9)}, samples=64)
    assert all(change.value > 1e-7 for change in page.changes)  # nothing is refused there
    (stop,) = page.stops
    assert (stop.input, stop.value) == ("roughness.sigma", pytest.approx(1e-7))
    said = " ".join(text for part in page.sections() for text in part.sentences)
    assert f"({why})" in said
    assert "no change of mode within a factor" not in said
    assert strict(json.dumps(page.to_dict()))["stops"] == [stop.to_dict()]


def test_what_pieces_bear_is_not_known_where_a_model_refuses_them(monkeypatch):
    why = "too many pieces"

    def refuses(contact, **load):
        if contact.populations[0].strength.fragments == "all":
            raise tb.errors.InvalidValue(why)
        return tb.solve(contact, **load)

    monkeypatch.setattr("thirdbody.analysis.assess.solve", refuses)
    weak = DUSTY.replace(
        **{"particles.strength": tb.grains.WeibullStrength(sigma_0=1e8, x_0=3e-7, m=3.0)}
    )
    (said,) = about_fragments(weak, {"pressure": 5e6})
    assert f"{NOT_KNOWN} ({why})" in said


@pytest.mark.skipif(not available(), reason="where numba is installed")
def test_the_cost_of_the_samples_is_told_before_them_and_how_far_they_are(monkeypatch):
    monkeypatch.setattr(progress, "LONG", 0.0)
    monkeypatch.setattr(progress, "SURE", 0.0)
    heard = []

    class Told(progress.Stages):
        def tell(self, sentence):
            heard.append(sentence)

        def show(self, part, more):
            heard.append((part, more))

    told = Told("assess")
    assess(
        DUSTY, vary={"roughness.sigma": (80e-9, 120e-9)}, F_star=1e-5, samples=256, progress=told
    )
    said = next(i for i, each in enumerate(heard) if "s each: some" in each)
    assert heard[said].startswith(f"about {256 + 6 * 256:,} states, ")
    shown = [each for each in heard if "states" in each[1]]
    assert heard.index(shown[0]) > said
    parts = [part for part, _ in shown]
    assert parts == sorted(parts)
    assert parts[0] < 0.2 < 0.9 < parts[-1]


class Enough(Exception):
    """What a test asks of the beginning of a long work, which ends here."""


@pytest.mark.skipif(not available(), reason="where numba is installed")
@pytest.mark.parametrize("many", [1, 4])
def test_threads_share_the_states_that_are_promised_and_no_changes(many, monkeypatch):
    """A clock that goes on by a second whenever it is read: a state takes a second over LEAST."""
    module = "thirdbody.analysis.assess"
    ticks = itertools.count()

    class Told(progress.Stages):
        def cost(self, *items):
            raise Enough(items)

    told = Told("assess")
    solved = []
    monkeypatch.setattr(f"{module}.threads", lambda: many)
    monkeypatch.setattr(f"{module}.columns_at", lambda *args, **named: solved.append(args[-1]))
    monkeypatch.setattr(f"{module}.time.monotonic", lambda: float(next(ticks)))
    with pytest.raises(Enough) as heard:
        assess(
            DUSTY, vary={"roughness.sigma": (8e-8, 1.2e-7)}, F_star=1e-5, samples=256, progress=told
        )
    ((states, changes),) = heard.value.args
    few = solved[-1]
    assert solved == [few, few]  # by the first the engine may be loaded
    assert states == (256 + 6 * 256, pytest.approx(1 / few / many), "states")
    assert changes[0] > 0
    assert changes[1] == pytest.approx(10 / few)


@pytest.mark.skipif(not available(), reason="where numba is installed")
@pytest.mark.parametrize(
    ("changed", "of_samples", "of_changes"),
    [
        ({}, False, True),
        ({"asperity_law": tb.asperity.Field()}, False, False),
        (
            {"particles.strength": tb.grains.WeibullStrength(sigma_0=1e8, x_0=3e-7, m=3.0)},
            True,
            True,
        ),
    ],
    ids=["few states", "one field of heights", "tables of their own"],
)
def test_contacts_are_announced_where_they_are_bound_one_by_one(changed, of_samples, of_changes):
    class Told(progress.Stages):
        def expect(self, contacts):
            raise Enough(contacts)

    vary = {"roughness.sigma": (8e-8, 1.2e-7)}
    expected = {}
    for count in (64, 128):
        with pytest.raises(Enough) as heard:
            assess(
                DUSTY.replace(**changed),
                vary=vary,
                F_star=1e-5,
                samples=count,
                progress=Told("assess"),
            )
        (expected[count],) = heard.value.args
    assert expected[128] - expected[64] == (64 if of_samples else 0)
    assert (expected[64] - (64 if of_samples else 0) > 0) == of_changes


@pytest.mark.skipif(not available(), reason="where numba is installed")
def test_what_outputs_cost_is_in_the_cost_that_is_told_first(monkeypatch):
    monkeypatch.setattr(progress, "LONG", 0.0)
    told = []

    class Told(progress.Stages):
        def cost(self, *items):
            told.append(items)

    load_alone = {"surfaces.first.H": (4e9, 6e9)}
    contact = DUSTY.replace(outputs=(tb.outputs.Friction(tau_ss=5e8, tau_sa=5e8),))
    assess(contact, vary=load_alone, F_star=1e-5, samples=64, progress=Told("assess"))
    states, _, with_outputs = told[0]
    assert states[::2] == (64 + 6 * 64, "states")
    assert with_outputs[0] == 64
    assert with_outputs[1] > states[1] > 0


def test_the_figure_of_bands_ends_where_an_end_of_a_band_would_be_crowded():
    """Loads that nobody asked for make no warning; what the model does not know is not drawn."""
    steel = tb.materials["S45C"]
    bare = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
    )
    page = tb.assess(bare, vary={"roughness.sigma": (80e-9, 120e-9)}, pressure=3e8, samples=64)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (caption, _), *_ = assess_page.pictures(page)
    assert re.findall(r"\d+ %", caption) == [percent(0.05), percent(0.5)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        curve = tb.propagate(bare, vary=page.propagation.inputs, samples=64, outputs=["A_t"],
                             pressure=np.geomspace(1e7, 9e9, 25))  # fmt: skip
    shown = assess_page._drop_crowded_loads(curve, "A_t", 3e8)
    end = len(shown.loads)
    assert np.all(curve.crowded[:end] <= 0.05)
    assert curve.crowded[end] > 0.05
    assert np.all(shown.bands["A_t"] == curve.bands["A_t"][:end])
    assert plot.bands(shown, "A_t").get_xlim()[1] == curve.loads[end - 1]
    assert (
        assess_page._drop_crowded_loads(curve, "A_t", 9e9) is curve
    )  # the page warns of that load itself


def test_what_inputs_are_ranked_by_is_called_in_words():
    """No name of the code stands in the heads of a page, in its captions, or beside its bars."""
    vary = {"particles.areal_density": (0.5e11, 2e11), "roughness.alpha": (4.0, 8.0)}
    page = tb.assess(DUSTY, vary=vary, pressure=5e6, samples=64)
    share = replace(
        page,
        decisive="particle_load_share",
        tornado=page.tornado | page.propagation.tornado("particle_load_share"),
    )
    (inputs,) = (part for part in share.sections() if part.title == "Inputs that matter")
    words = COLUMNS["particle_load_share"].meaning
    assert inputs.head[4:6] == (f"{words} at 5 %", f"{words} at 95 %")
    assert "particle_load_share" not in " ".join(
        (*inputs.head, *inputs.sentences, *(text for text, _ in assess_page.pictures(share)))
    )


def test_bars_name_numbers_without_a_known_letter_in_words():
    quartz = tb.materials["quartz"]
    dusty = DUSTY.replace(particles=DUSTY.particles.replace(material=quartz))
    found = tb.propagate(dusty, vary={"particles.material.m": (2.0, 4.0)}, pressure=5e6,
                         samples=64, outputs=["A_t"])  # fmt: skip
    (label,) = (text.get_text() for text in plot.tornado(found, "A_t").get_yticklabels())
    words = " ".join(label.split())
    assert words == words_of(dusty, "particles.material.m")
    assert "particles.material.m" not in words
