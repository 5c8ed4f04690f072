"""The page without a browser: its state, what it gives away, and whom it refuses."""

import asyncio
import dataclasses
import itertools
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from urllib.parse import parse_qsl

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.analysis.inputs import words_of
from thirdbody.errors import InvalidValue
from thirdbody.study import DISTRIBUTIONS, check

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app import exports, text
from thirdbody.app.cross_section import CARRIES, profile, section, to_svg
from thirdbody.app.entries import about_of
from thirdbody.app.examples import EXAMPLES, example
from thirdbody.app.fields import engineering, fields_of, number_of, text_of, value_from
from thirdbody.app.folders import Folders
from thirdbody.app.guard import LARGEST_UPLOAD, Guard, Headers, allowed_hosts
from thirdbody.app.jobs import Job, Stopped
from thirdbody.app.page import Start
from thirdbody.app.python_text import to_python
from thirdbody.app.sizing import size_of, with_size
from thirdbody.app.sliders import at_position, position_of
from thirdbody.app.state import State
from thirdbody.app.tabs.error_bars import _ranges, tornado_figure
from thirdbody.app.tabs.interface import drawing_of as section_drawn
from thirdbody.app.tabs.interface import facts_of, headline
from thirdbody.app.tabs.outputs import output_figures
from thirdbody.app.uploads import harmless
from thirdbody.equilibrium.words import two_bodies
from thirdbody.errors import Mistake
from thirdbody.quantities import say
from thirdbody.quantities.say import number, percent

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "examples").glob("*.toml"))
LOADS = np.geomspace(1e-6, 1e-4, 4).tolist()


@pytest.fixture
def state(tmp_path):
    return State(example(), tmp_path)


# ---------------------------------------------------------------- study and text
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_study_goes_through_file_and_link_unchanged(file):
    study = tomllib.loads(file.read_text())
    assert tomllib.loads(text.to_toml(study)) == study
    assert text.from_link(text.to_link(study).removeprefix("study=")) == study


def test_awkward_text_and_numbers_survive_the_file():
    study = {
        "title": 'a "quoted" \\ line\nµ \x7f \t',
        "odd key": {"a.b": [1, 2.5, -0.0, 1e-300, 1e22], "yes": True, "none": []},
        "particles": [{"parts": [{"mean": 1}, {"mean": 2}]}, {"mean": {"x": {"y": 1}}}],
    }
    assert tomllib.loads(text.to_toml(study)) == study
    assert str(tomllib.loads(text.to_toml(study))) == str(study)


@pytest.mark.parametrize("code", ["", "x", "eNo", "!!!!", "a" * 20_000, "AAAA"])
def test_a_broken_link_is_told(code):
    with pytest.raises(InvalidValue):
        text.from_link(code)


def test_a_link_cannot_unpack_to_more_than_a_study():
    import base64
    import zlib

    bomb = base64.urlsafe_b64encode(zlib.compress(b"#" * 10_000_000)).decode().rstrip("=")
    assert len(bomb) < text.LONGEST_LINK
    with pytest.raises(InvalidValue, match="longer"):
        text.from_link(bomb)


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_of_the_page_are_valid_and_plausible(name, tmp_path):
    state = State(example(name), tmp_path)
    assert not state.problems
    assert len(state.answer.loads) == 200
    # particles of an oil are wider than the film that brings them
    assert {note.code for note in state.answer.notes} <= {"gap"}


def test_first_example_is_that_of_the_examples():
    file = ROOT / "examples" / "dusty_ball_screw.toml"
    assert example() == tomllib.loads(file.read_text())


# ---------------------------------------------------------------- state
def test_setting_and_removing_an_entry(state):
    heard = []
    state.changed.append(lambda: heard.append(1))
    state.set("particles", "mean", "500 nm")
    assert state.answer.contact.particles.diameter.mean == 500e-9
    state.set("particles", "mean", "500 nm")
    assert len(heard) == 1
    state.set("roughness", "alpha", None)
    assert "alpha" not in state.study["roughness"]
    assert len(heard) == 2


def test_changes_of_one_entry_in_a_row_are_one_step(state):
    start = state.study
    for at in (1e-5, 2e-5, 3e-5):
        state.go(at)
    for sigma in ("90 nm", "80 nm"):
        state.set("roughness", "sigma", sigma)
    for law in ("ke", "jg"):
        state.set("asperity_law", {"name": law}, whole=True)
    assert state.steps == 4
    seen = []
    while state.past:
        state.undo()
        seen.append((state.study["asperity_law"]["name"], state.study["roughness"]["sigma"]))
    assert seen == [("ke", "80 nm"), ("zmc", "80 nm"), ("zmc", "100 nm"), ("zmc", "100 nm")]
    assert state.study == start
    assert state.wanted is None
    state.undo()
    for step in range(200):
        state.open(start | {"title": str(step)})
    assert len(state.past) == 100


def test_an_address_keeps_the_files_that_the_page_was_opened_with(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "own.toml").write_text("[own]\nE = 2e11\nnu = 0.3\nH = 5e9\n")
    (tmp_path / "mine" / "other.toml").write_text("[other]\nE = 2e11\nnu = 0.3\nH = 5e9\n")
    study = example() | {"materials": "own.toml"}
    start = Start(study, tmp_path / "mine", Folders())
    for query, found in (
        ({}, ["own.toml"]),
        (dict(parse_qsl(text.to_link(study, 2e-5))), ["own.toml"]),
        (dict(parse_qsl(text.to_link(study | {"materials": "other.toml"}))), []),
        (dict(parse_qsl(text.to_link(study | {"materials": "mine/own.toml"}))), []),
    ):
        state, _ = start.state(query)
        assert [each.name for each in state.folder.iterdir()] == found
    start.folders.close()


@pytest.mark.parametrize("tab", ["", "curves", "nowhere", "../curves", "__init__"])
def test_an_address_opens_a_tab_of_the_page_alone(tab):
    assert Start(None, None, None).read({"tab": tab})[2] == (
        tab if tab == "curves" else "interface"
    )


def test_a_mistake_keeps_the_last_answer_and_names_its_field(state):
    before = state.answer
    state.set("roughness", "sigma", "100 GPa")
    assert state.answer is before
    assert [about_of(problem) for problem in state.problems] == ["roughness.sigma"]
    state.set("roughness", "sigma", "100 nm")
    assert not state.problems
    assert state.answer is not before


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("roughness", "R"), -1),
        (("particles", "std"), "x nm"),
        (("particles", "areal_density"), "1e11 / m"),
        (("asperity_law", "k"), "a"),
        (("particle_law", "seat"), "sofa"),
        (("load", "F_star", "points"), 0.5),
        (("surfaces", "second", "nu"), 0.7),
        (("outputs", "flash_temperature"), {}),
    ],
)
def test_every_mistake_names_a_place_of_the_study(state, place, value):
    state.set(*place, value)
    names = [about_of(problem) for problem in state.problems]
    assert names
    assert all(name.startswith(".".join(place)) for name in names), state.problems


def test_a_link_cannot_read_files_of_this_machine(tmp_path):
    secret = tmp_path / "secret.csv"
    secret.write_text("1,2\n")
    own = tmp_path / "own"
    own.mkdir()
    for name in (str(secret), "../secret.csv", "secret.csv"):
        study = example()
        study["particles"] = {"material": "SiO2", "sizes": name, "areal_density": 1e9}
        other = example() | {"roughness": {"topography": [name, "example"]}}
        for asked in (study, other, example() | {"materials": name}):
            (problem,) = State(asked, own).problems
            assert problem.code is Mistake.UNREADABLE
            assert 'secret.csv"' in problem


def test_operating_load_stays_inside_the_loads(state):
    inside = state.answer.loads
    state.go(1.0)
    assert inside[0] <= state.operating_load <= inside[-1]
    state.go(float(inside[7]))
    assert state.operating_load == inside[7]


@pytest.mark.parametrize("part", [0.0, 0.25, 0.5, 1.0])
def test_slider_and_load_are_inverse(state, part):
    loads = state.answer.loads
    assert position_of(loads, at_position(loads, part)) == pytest.approx(part, abs=1e-4)
    assert loads[0] <= at_position(loads, part) <= loads[-1]


# ---------------------------------------------------------------- the same numbers
@pytest.mark.spread(3)
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_script_gives_the_numbers_of_the_page(file, tmp_path, capsys):
    state = State(tomllib.loads(file.read_text()), tmp_path)
    names = {}
    script = to_python(state.answer.study, state.operating_load)
    exec(script, names)
    written = [line for line in script.splitlines() if not line.startswith("curves")]
    assert max(map(len, written)) <= 100
    assert names["contact"] == state.answer.contact
    for column, values in state.answer.study.solve().columns().items():
        own = np.atleast_1d(names["curves"].columns()[column])
        np.testing.assert_array_equal(own, values, err_msg=column)  # NaN where no depth is known
    assert names["point"].columns()["d"] == state.point().columns()["d"]


def test_the_script_holds_outputs_and_several_populations(tmp_path):
    study = tomllib.loads((ROOT / "examples" / "dust_and_debris.toml").read_text())
    study["outputs"] = {"friction": {"m_ss": 0.2, "m_sa": 0.3}, "counts": {}}
    state = State(study, tmp_path)
    assert not state.problems
    names = {}
    exec(to_python(state.answer.study), names)
    assert names["contact"].outputs == state.answer.contact.outputs
    assert np.array_equal(names["curves"].outputs["mu"], state.answer.study.solve().outputs["mu"])


@pytest.mark.check
@pytest.mark.spread(2)
@pytest.mark.parametrize("suffix", ["csv", "json"])
def test_files_are_those_of_the_command_line(suffix, tmp_path):
    study = example("Oil of code 18/16/13") | {"load": {"pressure": ["1 MPa", "5 MPa"]}}
    file = tmp_path / "study.toml"
    file.write_text(text.to_toml(study))
    out = tmp_path / "out.csv"
    option = ["--csv", str(out)] if suffix == "csv" else ["--json"]
    done = subprocess.run(
        [sys.executable, "-m", "thirdbody", "solve", str(file), *option],
        capture_output=True,
        text=True,
        check=True,
    )
    made = {"csv": exports.to_csv, "json": exports.to_json}[suffix](check(study))
    assert made == (out.read_text() if suffix == "csv" else done.stdout)


@pytest.mark.check
def test_figures_are_written_and_deterministic(state):
    assert exports.figure_of(state.answer, "area", "png").startswith(b"\x89PNG")
    one, two = (exports.figure_of(state.answer, "shares", "svg") for _ in range(2))
    assert one == two
    assert b"<svg" in one


def test_regimes_are_hatched_alike_on_the_page_and_on_paper(state):
    from thirdbody.app.tabs.curves import figures

    page = figures(state.answer, "F_star", critical=False)["regimes"]["data"]
    paper = tb.plot.regimes(state.answer.curves).collections
    hatches = [2 * trace["fillpattern"]["shape"] for trace in page]
    assert hatches == [part.get_hatch() or "" for part in paper]
    assert len(set(hatches)) == 3


def test_curves_of_200_loads_follow_a_slider_by_one_solution(state, monkeypatch):
    """What makes them quick; benchmarks/waiting.py measures it."""
    from thirdbody.app.tabs.curves import figures

    figures(state.answer, "F_star", critical=False)
    solve, solved = tb.solve, []

    def counting(contact, **load):
        solved.append(np.size(*load.values()))
        return solve(contact, **load)

    monkeypatch.setattr(tb, "solve", counting)
    for step in range(3):
        state.set("roughness", "sigma", f"{101 + step} nm")
        drawn = figures(state.answer, "F_star", critical=False)
        assert len(drawn["area"]["data"][0]["x"]) == 200
    assert solved == [200] * 3


# ---------------------------------------------------------------- fields
def test_every_number_of_a_material_has_its_range():
    named = {field.name: field for field in fields_of(tb.Material)}
    for item in dataclasses.fields(tb.Material):
        if about := item.metadata.get("quantity"):
            field = named[item.name]
            assert about["meaning"] in field.about
            for bound in ("gt", "ge", "lt", "le"):
                if about[bound] is not None:
                    assert f"{about[bound]:g}" in field.about


@pytest.mark.parametrize(
    "registry",
    [DISTRIBUTIONS, tb.asperity.REGISTRY, tb.particle.REGISTRY, tb.outputs.REGISTRY],
    ids=["sizes", "asperity", "particle", "outputs"],
)
def test_every_option_of_the_registries_has_a_field(registry):
    from thirdbody.study import filled_in

    for kind in registry.values():
        nested = {"law"} if registry is tb.particle.REGISTRY else set()
        wanted = {item.name for item in dataclasses.fields(kind)} - filled_in(kind) - nested
        assert {field.name for field in fields_of(kind)} == wanted


@pytest.mark.parametrize(
    ("written", "value"),
    [("300 nm", "300 nm"), ("3", 3), ("3e-7", 3e-7), ("1, 2", [1, 2]), ("true", True), (" ", None),
     ("1 um, 2 um", ["1 um", "2 um"]), ('{ name = "a" }', {"name": "a"})],
)  # fmt: skip
def test_what_is_written_is_read_and_shown_again(written, value):
    assert value_from(written) == value
    assert value_from(text_of(value)) == value


@pytest.mark.parametrize("value", [3e-7, 9.9996e-7, 1e-6, 5.2e-3, 2.0, 4e-11])
@pytest.mark.parametrize("unit", ["m", "Pa", "1/m^2", "1", "W/m/K"])
def test_engineering_numbers_are_read_back(value, unit):
    about = {"unit": unit, "meaning": "x"}
    assert number_of(engineering(value, unit, 6), about) == pytest.approx(value, rel=1e-5)


@pytest.mark.parametrize("size", [80e-9, 300e-9, 500e-9])
def test_sizes_are_scaled_as_a_whole(size, tmp_path):
    for name in ("Dust in a ball-screw nut", "Nanoparticles as an oil additive"):
        study = example(name)
        before = State(study, tmp_path).answer.contact.particles.diameter
        after = State(with_size(study, size), tmp_path).answer.contact
        assert size_of(after) == pytest.approx(size, rel=2e-4)
        assert after.particles.diameter.moment(2) / size**2 == pytest.approx(
            before.moment(2) / before.mean_diameter**2, rel=1e-3
        )


# ---------------------------------------------------------------- cross-section
def test_profile_has_the_moments_of_the_roughness():
    sigma, R, alpha = 100e-9, 2.8e-6, 5.0
    m4 = (3 * np.sqrt(np.pi) / (8 * R)) ** 2
    heights, curvatures, slopes = [], [], []
    for seed in range(400):
        x, z = profile(sigma, R, alpha, 20e-6, seed)
        heights.append(np.mean(z**2))
        slopes.append(np.mean(np.gradient(z, x)[2:-2] ** 2))
        curvatures.append(np.mean(np.diff(z, 2)[2:-2] ** 2) / (x[1] - x[0]) ** 4)
    # the spectrum has 96 lines and so lacks its farthest tail: a few per cent of m4
    assert np.mean(heights) == pytest.approx(sigma**2, rel=0.05)
    assert np.mean(slopes) == pytest.approx(np.sqrt(sigma**2 * m4 / alpha), rel=0.05)
    assert np.mean(curvatures) == pytest.approx(m4, rel=0.12)


def test_particles_of_the_section_are_loaded_as_often_as_in_the_model(state):
    state.go(1e-4)
    point, contact = state.point(), state.answer.contact
    grains = [g for s in range(80) for g in section(contact, point, seed=s).grains]
    counted = tb.solve(contact.replace(outputs=(tb.outputs.Counts(),)), d=point.d).outputs
    share = counted["n_sa"] / contact.particles.areal_density
    drawn = np.mean([grain.is_loaded for grain in grains])
    # 80 profiles hold some 3 independent seats each
    assert drawn == pytest.approx(share, abs=3 * np.sqrt(share * (1 - share) / 240))


def test_an_output_with_mistakes_blocks_itself_alone(state):
    state.set("outputs", {"counts": {}, "friction": {"m_ss": 0.2, "m_sa": 0.3}})
    state.set("outputs", "wear", {})
    assert state.current
    assert [output.name for output in state.answer.contact.outputs] == ["counts", "friction"]
    assert [about_of(problem) for problem in state.problems] == ["outputs.wear.K_ss"]
    state.set("outputs", "friction", "m_ss", "5 GPa")
    assert [output.name for output in state.answer.contact.outputs] == ["counts"]
    before = state.answer
    state.set("roughness", "sigma", "1 GPa")
    assert not state.current
    assert state.answer is before
    state.set("roughness", "sigma", "99 nm")
    state.set("outputs", {"nothing": {}})
    assert state.current
    assert not state.answer.contact.outputs
    assert state.answer.contact.roughness.sigma == 99e-9


@pytest.mark.check
def test_the_ranges_of_the_library_are_those_that_count(tmp_path):
    steel = example() | {"surfaces": {"first": "100Cr6", "second": "100Cr6"}}
    offered = _ranges(State(steel, tmp_path))
    assert offered["surfaces.first.E+surfaces.second.E"] == {"low": 190e9, "high": 210e9}
    asked = dict(load="F_star", loads=[1e-5], at=1e-5, of="A_t", samples=64)
    result, _ = run("error bars", study=steel, folder=str(tmp_path), **asked)
    taken = steel | {"uncertainty": {"inputs": offered}}
    assert not State(taken, tmp_path).problems
    same, _ = run("error bars", study=taken, folder=str(tmp_path), **asked)
    assert same["bands"] == result["bands"]


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_population_that_carries_has_a_loaded_particle(name, tmp_path):
    answer = State(example(name), tmp_path).answer
    contact = answer.contact
    several = contact.replace(
        particles=(
            *contact.populations,
            *(
                dust.replace(name="larger", areal_density=1e-4 * dust.areal_density,
                             diameter=dust.diameter.scaled(1.5))
                for dust in contact.populations
            ),
        )
        or None
    )  # fmt: skip
    met = []
    for made, load in itertools.product((contact, several), answer.loads[::33]):
        point = tb.solve(made, **{answer.load: load})
        shares = [part.load_share for part in point.populations] or [point.particle_load_share]
        for seed in range(3):
            drawn = section(made, point, seed=seed)
            loaded = {grain.population for grain in drawn.grains if grain.is_loaded}
            carrying = {i for i, share in enumerate(shares) if share > CARRIES}
            assert carrying <= loaded, (load, seed, shares)
            met.append(drawn.met)
    assert any(met) == (name in list(EXAMPLES)[:2])  # in oil those that carry are many


def test_a_load_of_the_interface_is_solved_once(state, monkeypatch):
    solve, asked = tb.solve, []

    def counting(*args, **options):
        asked.append(options)
        return solve(*args, **options)

    answer = state.answer
    at = answer.default_at()
    monkeypatch.setattr(tb, "solve", counting)
    _, found = section_drawn(answer, at, 0)
    assert len(asked) == 1
    assert found[3] == facts_of(answer.solve(at))
    assert any(name == "particles loaded" for name, _ in found[3])


def test_the_headline_says_what_the_command_line_says(state, tmp_path):
    bare = State(example("Two surfaces without particles"), tmp_path)
    assert headline(bare.point()).endswith(f"{two_bodies()}.")
    for at in (5e-7, 2e-5, 2.4e-4):
        point = state.answer.solve(at)
        said = headline(point)
        assert f" {say.percent(point.particle_load_share)} " in said
        assert f"({point.mode})" in said
        assert say.value_of(point.pressure, "Pa") in said


def test_the_section_is_well_formed_and_to_scale(state):
    import xml.etree.ElementTree as ET

    contact, point = state.answer.contact, state.point()
    drawn = section(contact, point)
    tree = ET.fromstring(to_svg(drawn))
    ellipses = [node for node in tree.iter() if node.tag.endswith("ellipse")]
    assert len(ellipses) == len(drawn.grains)
    scale = 1000 / drawn.width
    for node, grain in zip(ellipses, drawn.grains, strict=True):
        assert float(node.get("rx")) == pytest.approx(scale * grain.diameter / 2, abs=0.06)
        assert float(node.get("ry")) == pytest.approx(scale * grain.diameter / 2, abs=0.06)


# ---------------------------------------------------------------- long work
def run(task, **asked):
    told = []
    return asyncio.run(Job(task, told.append).run(**asked)), told


def test_the_map_is_solved_states():
    study = example()
    found, told = run("map", study=study, folder=".", sizes=[1.5, 3.0], loads=LOADS)
    assert told[-1] == 1.0
    contact = check(study).contact
    dust = contact.particles
    scaled = dust.diameter.scaled(1.5 * contact.roughness.sigma / dust.diameter.mean_diameter)
    state = tb.solve(contact.replace(particles=dust.replace(diameter=scaled)), F_star=LOADS)
    assert [["p-s", "hybrid", "s-s"][i] for i in found["mode"][0]] == state.mode.tolist()
    # the map solves all sizes at once, another path than one contact's
    assert found["share"][0] == pytest.approx(state.particle_load_share.tolist(), rel=1e-13)


def test_every_key_of_a_study_file_has_an_entry(tmp_path):
    """Forms hold every key that the reader knows; other tables stand there as text."""
    from nicegui import Client
    from nicegui.page import page as place

    from thirdbody.app.fields import known_keys
    from thirdbody.app.inputs import FORMED, Inputs
    from thirdbody.study.tables import TABLES

    dust = {"material": "SiO2", "distribution": "monodisperse", "mean": "300 nm",
            "areal_density": "1e9 / m^2", "concentration": None, "law": {"name": "series", "law": {"name": "zmc"}},
            "shape": {"kind": "angular"}}  # fmt: skip
    study = example() | {"outputs": {name: {} for name in tb.outputs.REGISTRY}}
    study |= {"particles": [dust, dust | {"name": "b"}]}
    study["roughness"] = study["roughness"] | {
        "heights": {"name": "weibull"},
        "ellipticity": {"first": 4, "second": 2, "angle": "30 deg"},
    }
    measured = study | {"roughness": {"topography": "example"}}
    with Client(place("/test"), request=None):
        for given in (study, measured):
            inputs = Inputs(State(given, tmp_path), lambda: None)
            for name in ("surfaces", "roughness", "asperity_law", "particles", "outputs", "load"):
                getattr(inputs, {"outputs": "output_numbers"}.get(name, name))()
                for path, keys in known_keys(given, name).items():
                    offered = set(inputs.shown)
                    for key, about in keys.items():
                        where = f"{path}.{key}"
                        inside = any(shown.startswith(where) for shown in offered)
                        # outputs are switches, all of the registry
                        assert inside or not about or key in ALSO or path == "outputs", where
            for table in TABLES:
                if table.name not in FORMED:
                    inputs.as_text(table.name)
                    assert table.name in inputs.shown


def test_what_a_menu_begins_has_no_mistake_and_an_entry_for_every_key(tmp_path):
    """Roughness as on a drawing, and every kind of body under a force."""
    from nicegui import Client
    from nicegui.page import page as place

    from thirdbody.app.fields import known_keys
    from thirdbody.app.inputs import BODIES_BEGUN, ROUGHNESS_BEGUN, Inputs
    from thirdbody.systems.bodies import BODIES

    assert list(BODIES_BEGUN) == list(BODIES)
    offered, known = set(), set()
    with Client(place("/test"), request=None):
        for rough, body in itertools.product(ROUGHNESS_BEGUN.values(), BODIES_BEGUN.values()):
            study = example() | {"roughness": rough, "load": {"force": "5 N"}, "body": body}
            state = State(study, tmp_path)
            assert state.problems == []
            inputs = Inputs(state, lambda: None)
            inputs.roughness()
            inputs.load()
            offered |= set(inputs.shown)
            for name in ("roughness", "body"):
                for path, keys in known_keys(study, name).items():
                    known |= {f"{path}.{key}" for key, about in keys.items() if about}
    missing = [name for name in sorted(known) if not any(s.startswith(name) for s in offered)]
    assert missing == []


@pytest.mark.parametrize(("answer", "drawn"), [(True, True), (False, False), (None, False)])
def test_a_figure_that_the_browser_did_not_draw_is_drawn_by_the_framework(answer, drawn):
    """Out of sight, or not there yet; and it is sent again the next time."""
    from nicegui import Client
    from nicegui.page import page as place

    from thirdbody.app.figures import figure, line
    from thirdbody.app.widgets import Plot

    sent = []

    async def browser(code, *, timeout):
        sent.append(code)
        if answer is None:
            raise TimeoutError
        return [answer]

    with Client(place("/test"), request=None) as client:
        client.run_javascript = browser
        plot = Plot("area")
        plot.widget.update = lambda: sent.append("update")
        made = figure([line([1.0, 2.0], [1.0, 2.0], "area", 0)], x="load", y="area", title="Area")
        for _ in range(2):
            assert asyncio.run(plot.show(made)) is drawn
        assert plot.widget.figure == made
    assert len(sent) == (1 if drawn else 4)
    assert sent[0].startswith('redraw([["c')
    assert '"react"' in sent[0]


def test_a_figure_is_told_what_is_new_alone():
    from nicegui import Client
    from nicegui.page import page as place

    from thirdbody.app.figures import figure, fix, line
    from thirdbody.app.widgets import Plot

    def made(y, shapes=(), x=(1.0, 2.0)):
        out = figure([line(x, y, "area", 0)], x="load", y="area", shapes=list(shapes))
        fix(out, "yaxis", [0.0, max(y)])
        return out

    with Client(place("/test"), request=None):
        plot = Plot("area")
        first = plot.made = made([1.0, 2.0])
    changes = [
        (made([1.0, 2.0], [{"type": "rect"}]), ["relayout", {"shapes": [{"type": "rect"}]}]),
        (made([2.0, 1.0]), ["update", {"y": [[2.0, 1.0]]}, {}]),
        (made([3.0, 1.0]), ["update", {"y": [[3.0, 1.0]]}, {"yaxis.range": [0.0, 3.0]}]),
    ]
    for there, calls in changes:
        assert plot.change(there) == calls
    other = made([1.0, 2.0], x=(1.0, 3.0))
    assert plot.change(other)[:2] == ["react", other["data"]]
    plot.made = {}
    assert plot.change(first)[:2] == ["react", first["data"]]


@pytest.mark.check
def test_figures_of_outputs_name_quantities_and_no_columns(tmp_path):
    study = example()
    study["outputs"] = {"counts": {}, "friction": {"m_ss": 0.2, "m_sa": 0.3}, "dents": {}}
    state = State(study, tmp_path)
    answer = state.answer
    columns = {c: each for output in answer.contact.outputs for c, each in output.columns.items()}
    drawn = output_figures(answer, state.operating_load)
    assert list(drawn) == [
        *("counts [1/m^2]", "counts [N]", "counts [Pa]", "friction [1]", "dents [1/m^2]"),
        "dents [m]",
    ]
    said = []
    for name, made in drawn.items():
        axis = made["layout"]["yaxis"]["title"]["text"]
        said += [made["layout"]["title"]["text"], axis, *(t["name"] for t in made["data"])]
        assert name.endswith("[1]") or re.search(r"\[[^]]+\]$", axis), axis
    assert not {name for name in columns if "_" in name and any(name in text for text in said)}
    known = {re.sub("<.*?>", "", text.replace("<sub>", "_")) for text in said}
    for each in columns.values():
        wanted = f"{each.symbol}: {each.meaning}"
        assert any(wanted.replace(" ", "") == text.replace(" ", "") for text in known), wanted
    (pressure, _) = drawn["counts [Pa]"]["data"]
    assert "[GPa]" in drawn["counts [Pa]"]["layout"]["yaxis"]["title"]["text"]
    expected = answer.curves.outputs["p_ss"]
    np.testing.assert_allclose(1e9 * np.array(pressure["y"]), expected, rtol=1e-14)


ALSO = {
    "film": "another word for gap",
    "separation": "one load excludes the others, which the menu offers",
    "pressure": "as separation",
    "force": "as separation",
    "F_star": "as separation",
}
"""Keys that need no entry of their own."""


def test_a_length_is_shown_with_its_sign_and_written_without():
    assert text_of(["1 um", "2 um"]) == "1 µm, 2 µm"
    assert value_from("2.8 µm") == value_from("2.8 μm") == "2.8 um"


@pytest.mark.check
@pytest.mark.spread(2)
@pytest.mark.parametrize("of", ["F_cr1", "n_sa"])
def test_error_bars_of_critical_loads_and_outputs(of):
    known = {"roughness.sigma": (9e-8, 11e-8)}
    study = example() | {
        "outputs": {"counts": {}},
        "uncertainty": {"inputs": {name: {"low": a, "high": b} for name, (a, b) in known.items()}},
    }
    asked = {"load": "F_star", "loads": [], "at": LOADS[1], "of": of, "samples": 64}
    found, _ = run("error bars", study=study, folder=".", **asked)
    own = tb.propagate(check(study).contact, vary=known, F_star=LOADS[1], samples=64, outputs=[of])
    np.testing.assert_allclose(found["band_at"], own.bands[of], rtol=1e-9)
    assert bool(found["critical"]) is (of == "F_cr1")
    if found["critical"]:
        assert found["critical"][of] == [*found["band_at"], found["nominal_at"]]


@pytest.mark.check
def test_error_bars_are_those_of_the_library():
    study = example() | {
        "uncertainty": {"seed": 3, "inputs": {"roughness.sigma": {"low": 9e-8, "high": 11e-8}}}
    }
    asked = {"load": "F_star", "loads": LOADS, "at": LOADS[1], "of": "A_t", "samples": 256}
    found, _ = run("error bars", study=study, folder=".", **asked)
    own = tb.propagate(
        check(study).contact, vary={"roughness.sigma": (9e-8, 11e-8)}, F_star=LOADS, samples=256,
        seed=3, outputs=["A_t"],
    )  # fmt: skip
    # another process may have another engine: they agree to 1e-12
    np.testing.assert_allclose(found["bands"], own.bands["A_t"], rtol=1e-11)
    np.testing.assert_allclose(found["nominal"], own.nominal["A_t"], rtol=1e-11)
    words = words_of(check(study).contact, "roughness.sigma")
    assert found["words"] == {"roughness.sigma": words}
    assert found["ends"] == {"roughness.sigma": ["91 nm", "109 nm"]}
    bars = tornado_figure(found)["data"]
    assert {"".join(each["y"]).replace("<br>", " ") for each in bars} == {words}


@pytest.mark.check
def test_a_bad_request_is_told_and_a_slow_one_is_ended(tmp_path):
    bad = tmp_path / "bad.x3p"
    bad.write_bytes(b"\x00\xffnot a surface" * 50)
    with pytest.raises(InvalidValue, match=r"bad\.x3p"):
        run("surface", file=str(bad), options={})
    with pytest.raises(InvalidValue, match="stopped after"):
        asyncio.run(Job("surface", seconds=0.2).run(file="example", options={}))


@pytest.mark.check
def test_a_file_of_python_objects_is_not_executed(tmp_path):
    import pickle

    mark = tmp_path / "mark"

    class Evil:
        def __reduce__(self):
            return Path.touch, (mark,)

    for name in ("evil.npz", "evil.x3p"):
        file = tmp_path / name
        if name.endswith("npy"):
            np.save(file, np.array([Evil()], dtype=object), allow_pickle=True)
        elif name.endswith("npz"):
            np.savez(file, heights=np.array([Evil()], dtype=object))
        else:
            file.write_bytes(pickle.dumps(Evil()))
        with pytest.raises(InvalidValue):
            run("surface", file=str(file), options={})
        assert not mark.exists()


def test_a_job_can_be_cancelled():
    async def go():
        job = Job("map")
        running = asyncio.create_task(
            job.run(study=example(), folder=".", sizes=[1.0] * 5000, loads=LOADS)
        )
        await asyncio.sleep(0.5)
        job.cancel()
        with pytest.raises(Stopped):
            await running
        assert job.process.returncode is not None

    asyncio.run(go())


def test_memory_of_a_job_is_bounded(monkeypatch):
    from thirdbody.app import worker

    code = f"import resource; from thirdbody.app import worker; worker._limit(); bytearray({worker.MEMORY})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "MemoryError" in done.stderr
    code = (
        "import resource; from thirdbody.app import worker; worker._limit(); "
        "print(*resource.getrlimit(resource.RLIMIT_CPU))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    soft, hard = map(int, done.stdout.split())
    assert soft == worker.SECONDS < hard  # the signal at the first says that it was the time


# ---------------------------------------------------------------- guard
def ask(guard, kind="http", body=(b"",), **headers):
    """Status of a request, or what the application behind was given."""
    said, sent = [], list(body)

    async def receive():
        if sent:
            return {"type": "http.request", "body": sent.pop(0), "more_body": bool(sent)}
        return {"type": "http.disconnect"}

    async def send(message):
        said.append(message)

    raw = [(key.replace("_", "-").encode(), value.encode()) for key, value in headers.items()]
    asyncio.run(guard({"type": kind, "headers": raw}, receive, send))
    return said[0] if said else {"status": "none"}


def behind(read=None):
    async def application(scope, receive, send):
        size = 0
        while True:
            message = await receive()
            if message["type"] == "http.disconnect":
                await send({"type": "http.response.start", "status": 499, "size": size})
                return
            size += len(message["body"])
            if not message["more_body"]:
                break
        await send({"type": "http.response.start", "status": 200, "size": size})

    return application


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    ("headers", "welcome"),
    [
        ({"host": "127.0.0.1:8765"}, True),
        ({"host": "localhost"}, True),
        ({"host": "[::1]:8765"}, True),
        ({"host": "127.0.0.1:8765", "origin": "http://127.0.0.1:8765"}, True),
        ({"host": "evil.example:8765"}, False),
        ({"host": "127.0.0.1.evil.example"}, False),
        ({}, False),
        ({"host": "127.0.0.1:8765", "origin": "http://evil.example"}, False),
        ({"host": "127.0.0.1:8765", "origin": "null"}, False),
        ({"host": "127.0.0.1:8765", "origin": "http://127.0.0.1:9000"}, False),
        ({"host": "127.0.0.1:8765", "origin": "https://127.0.0.1:8765"}, False),
        ({"host": "127.0.0.1:8765", "origin": "http://localhost:8765"}, False),
        ({"host": "127.0.0.1:80", "origin": "http://127.0.0.1"}, True),
        ({"host": "127.0.0.1:port"}, False),
    ],
)
def test_other_hosts_and_origins_are_refused(kind, headers, welcome):
    answer = ask(Guard(behind(), allowed_hosts("127.0.0.1")), kind, **headers)
    if kind == "http":
        assert answer["status"] == (200 if welcome else 400)
    else:
        assert (answer["type"] == "websocket.close") is not welcome


def test_other_hosts_are_served_when_asked_for():
    assert ask(Guard(behind(), allowed_hosts("0.0.0.0")), host="lab.example")["status"] == 200
    guard = Guard(behind(), allowed_hosts("192.168.1.5"))
    assert ask(guard, host="192.168.1.5:80")["status"] == 200
    assert ask(guard, host="192.168.1.6:80")["status"] == 400


def test_another_site_may_link_to_the_page_but_not_embed_it():
    guard = Guard(behind(), allowed_hosts("127.0.0.1"))
    for site in ("cross-site", "same-site"):
        head = {"host": "127.0.0.1", "sec_fetch_site": site}
        link = {"sec_fetch_mode": "navigate", "sec_fetch_dest": "document"}
        assert ask(guard, **head, **link)["status"] == 200
        for dest in ("iframe", "image", "script", "empty"):
            mode = "navigate" if dest == "iframe" else "no-cors"
            answer = ask(guard, **head, sec_fetch_mode=mode, sec_fetch_dest=dest)
            assert answer["status"] == 403
    assert ask(guard, host="127.0.0.1", sec_fetch_site="same-origin")["status"] == 200


def test_other_origins_are_refused_under_any_name():
    guard = Guard(behind(), allowed_hosts("0.0.0.0"))
    assert ask(guard, host="lab.example", origin="http://lab.example")["status"] == 200
    assert ask(guard, host="lab.example", origin="http://evil.example")["status"] == 400


def test_every_answer_has_its_policy_and_scripts_of_a_page_their_nonce():
    async def application(scope, receive, send):
        head = [(b"content-type", b"text/html; charset=utf-8"), (b"content-length", b"34")]
        await send({"type": "http.response.start", "status": 200, "headers": head})
        for body in (b"<script>1</scr", b"ipt><script src=x>"):
            await send({"type": "http.response.body", "body": body, "more_body": body[-1:] == b"r"})

    def answered():
        said = []

        async def send(message):
            said.append(message)

        asyncio.run(Headers(application)({"type": "http", "headers": []}, None, send))
        start, *bodies = said
        return dict(start["headers"]), b"".join(each["body"] for each in bodies)

    (head, body), (other, _) = answered(), answered()
    policy = head[b"content-security-policy"].decode()
    nonce = re.search(r"script-src 'self' 'nonce-([\w-]+)' 'unsafe-eval';", policy)[1]
    assert body.decode() == f'<script nonce="{nonce}">1</script><script nonce="{nonce}" src=x>'
    assert head[b"content-length"] == str(len(body)).encode()
    assert other[b"content-security-policy"] != head[b"content-security-policy"]
    assert "frame-ancestors 'none'" in policy
    assert head[b"x-content-type-options"] == b"nosniff"
    assert head[b"x-frame-options"] == b"DENY"
    assert head[b"referrer-policy"] == b"same-origin"


def test_large_uploads_are_refused_said_or_unsaid():
    guard = Guard(behind(), (), largest=1000)
    most = guard.largest
    assert ask(guard, content_length=str(most))["status"] == 200
    assert ask(guard, content_length=str(most + 1))["status"] == 413
    assert ask(guard, content_length="-1")["status"] == 413
    assert ask(guard, body=(b"x" * most,))["status"] == 200
    answer = ask(guard, body=(b"x" * most, b"y", b"z"))
    assert answer["status"] == 499
    assert answer["size"] <= most
    assert LARGEST_UPLOAD <= 100 * 2**20


@pytest.mark.parametrize(
    "name", ["../../x.toml", "/etc/passwd", "a b\\c:d.x3p", "..", "", ".hidden", "é" * 300]
)
def test_names_of_uploads_are_harmless(name):
    made = harmless(name)
    assert Path(made).name == made
    assert not made.startswith(".")
    assert 0 < len(made) <= 80


# ---------------------------------------------------------------- command line
@pytest.mark.check
def test_the_command_tells_bad_input_and_a_taken_port(tmp_path):
    import socket

    def said(*arguments):
        done = subprocess.run(
            [sys.executable, "-m", "thirdbody", "app", *arguments], capture_output=True, text=True
        )
        return done.returncode, done.stderr

    code, told = said(str(tmp_path / "none.toml"))
    assert (code, told.count("error: "), "none.toml" in told) == (2, 1, True)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        code, told = said("--no-browser", "--port", port)
    assert (code, told.count("error: "), port in told) == (2, 1, True)


def test_the_command_says_what_is_missing(monkeypatch):
    import importlib.util

    from thirdbody.cli.commands import app

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InvalidValue, match=r"thirdbody\[app\]"):
        app.command()


def test_json_of_the_worker_is_strict():
    from thirdbody.quantities.plain_data import plain_data

    made = plain_data({"a": np.array([1.0, np.nan]), "b": (np.float64("inf"), np.int64(2))})
    assert json.dumps(made, allow_nan=False) == '{"a": [1.0, null], "b": [null, 2]}'


def test_a_force_opens_at_its_mean_pressure_and_reaches_the_largest(tmp_path):
    study = example() | {
        "load": {"force": "2 N"},
        "body": {"kind": "ball-on-flat", "diameter": "40 mm"},
    }
    state = State(study, tmp_path)
    mean, largest = check(study).values
    assert (state.operating_load, state.answer.loads[-1]) == (mean, largest)
    assert len(state.answer.loads) == 200


@pytest.mark.parametrize(("fragments", "part"), [("gone", True), ("all", False)])
def test_pieces_are_no_part_of_the_particles_that_came(fragments, part):
    """Particles that break leave more pieces than there were of them; some, never above 100 %."""
    steel, quartz = tb.materials["100Cr6"], tb.materials["quartz"]
    dust = tb.Particles(
        material=quartz, areal_density=1e8, diameter=tb.distributions.Monodisperse(mean=5e-6),
        strength=tb.grains.WeibullStrength.of(quartz, fragments=fragments),
    )  # fmt: skip
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), particles=dust, outputs=tb.outputs.Counts(),
        roughness=tb.Roughness(sigma=50e-9, R=20e-6),
    )  # fmt: skip
    point = tb.solve(contact, pressure=5e6)
    each = point.outputs["n_sa"] / 1e8
    found = dict(facts_of(point))
    if part:
        assert found["particles loaded"] == percent(each)
        assert each <= 1
    else:
        assert each > 1, "nothing broke: the test says nothing"
        assert "particles loaded" not in found
        assert found["whole particles and pieces loaded"].split()[0] == number(each, 3)
