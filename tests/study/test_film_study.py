"""A lubricated contact in a study file: what is read, what it gives, and what is refused."""

import csv
import json
import tomllib
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from command_line import run as run_command
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.contact.contact import Contact
from thirdbody.errors import InvalidValue, code_of
from thirdbody.study import check, load_study, run_film, run_study
from thirdbody.study.analyses import assess_study
from thirdbody.study.film import note_without_oil
from thirdbody.systems.film_conditions import Entrainment, FilmConditions
from thirdbody.systems.mixed_film import COLUMNS, mean_gap
from thirdbody.systems.stribeck import regime_speeds
from thirdbody.views.plot.film import bands_of
from thirdbody.views.report import Report
from thirdbody.views.report.tables import film_section

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
EXAMPLE = Path(__file__).parents[2] / "examples" / "oil_film.toml"
BALL = {"shape": "point", "R": "9.5 mm"}
SPEED = {"from": "20 mm/s", "to": "20 m/s", "points": 6, "spacing": "log"}


def data_of(**film):
    """The example with few speeds and other entries of [film]; None leaves one out."""
    data = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    table = data["film"] | {"speed": SPEED} | film
    data["film"] = {key: value for key, value in table.items() if value is not None}
    return data


def test_bodies_that_yield_are_noted():
    """Hertz: p_0 = 1.5 w/A grows with the cube root of the load; 0.6 H is where yield begins."""
    data = data_of(load="20 N")
    first = run_film(check(data))
    contact, film = first.study.contact, first.conditions
    p_0 = 1.5 * 20.0 / film.conjunction.hertz(20.0, E=2 * contact.E_ss).area
    limit = 20.0 * (0.6 * contact.surfaces.H / p_0) ** 3
    for part, is_noted in ((0.99, False), (1.01, True)):
        data = data_of(load=f"{part * limit} N")
        codes = [code_of(note) for note in run_film(check(data)).warnings]
        assert ("bodies.yield" in codes) == is_noted


def problems_of(data):
    with pytest.raises(InvalidValue) as raised:
        check(data)
    return raised.value.problems


@pytest.fixture(scope="module")
def found():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return run_film(check(data_of()))


@cache
def by_hand():
    """The example, written in Python."""
    steel = tb.materials["S45C"]
    debris = tb.Particles(
        material=steel, areal_density=1e10, diameter=tb.TruncatedGaussian(mean=1e-6, std=0.2e-6)
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=debris,
        outputs=tb.outputs.Friction(tau_ss=400e6, tau_sa=400e6),
    )
    given = {
        "conjunction": tb.films.Point(R=9.5e-3),
        "oil": tb.films.Oil(eta=0.02, alpha=20e-9, eyring_stress=5e6),
        "load": 20.0,
    }
    return contact, given


# ---------------------------------------------------------------- numbers
def test_the_curve_is_that_of_stribeck(found):
    contact, given = by_hand()
    speeds = np.geomspace(0.02, 20.0, 6)
    curve = tb.films.stribeck(contact, speed=speeds, slide_roll=0.05, **given)
    assert found["states"]["speed"] == speeds.tolist()
    for name in curve.data_vars:
        assert found["states"][name] == curve[name].values.tolist(), name
    assert found["regime_speeds"] == regime_speeds(contact, **given)._asdict()


def test_one_speed_is_that_of_mixed_film():
    contact, given = by_hand()
    point = tb.films.mixed_film(contact, speed=0.5, slide_roll=0.05, **given)
    study = check(data_of(speed="0.5 m/s"))
    assert study.film.at(study.contact).columns() == point.columns()
    states = run_film(study)["states"]
    assert all(states[name] == [getattr(point, name)] for name in COLUMNS if name in states)


@cache
def at_half_a_metre():
    film = check(data_of(speed=0.5)).film
    return film, film.at(by_hand()[0]).columns()


@pytest.mark.parametrize(
    "film",
    [
        {"speed": "1.8 km/h", "load": "0.02 kN"},
        {"speed": "50 cm/s", "oil": {"eta": "20 cP", "alpha": 2e-8, "eyring_stress": "50 bar"}},
        {"speed": 0.5, "conjunction": {"shape": "point", "R": 0.0095, "R_y": "0.95 cm"}},
        {"speed": ["0.5 m/s"], "few": 0.01, "most": 0.99, "hertz": "mean"},
        {"speed": "0.5 m/s", "formula": "nijenbanning-venner-moes"},
    ],
)
def test_the_same_in_other_words_is_the_same(film):
    first, one = at_half_a_metre()
    other = check(data_of(**{"speed": 0.5} | film)).film
    assert first.speed == pytest.approx(other.speed, rel=1e-15)
    assert first.load == pytest.approx(other.load, rel=1e-15)
    two = other.at(by_hand()[0]).columns()
    for name in one.keys() - {"residual", "regime", "status"}:
        assert one[name] == pytest.approx(two[name], rel=1e-11), name


def test_regimes_change_where_it_says():
    contact, given = by_hand()
    ends = regime_speeds(contact, **given)
    for speed, share in zip(ends, (0.99, 0.01), strict=True):
        at = tb.films.mixed_film(contact, speed=[0.99 * speed, speed, 1.01 * speed], **given)
        assert at.solid_share[1] == pytest.approx(share, rel=1e-9)
        assert len(set(at.regime[[0, 2]])) == 2


def test_regimes_follow_the_film_formula_for_rigid_bodies():
    """Against a route by hand: the gap at the share from `solve`, the speed from Dowson's power."""
    contact, _ = by_hand()
    contact = contact.replace(particles=None, outputs=())
    oil, line = tb.films.Oil(eta=0.04, alpha=2e-8), tb.films.Line(R=0.01, length=0.01)
    film = tb.films.DowsonLine()
    found = regime_speeds(
        contact, conjunction=line, oil=oil, load=500.0, film=film, few=0.2, most=0.7
    )
    p = line.hertz(500.0, E=2 * contact.E_ss).mean
    for speed, share in zip(found, (0.7, 0.2), strict=True):
        h = tb.solve(contact, pressure=share * p).h
        at_1 = film.central(load=5e4 * (1 - share), speed=1.0, eta=0.04, alpha=2e-8, R=0.01,
                            E=2 * contact.E_ss * (1 - share))  # fmt: skip
        by_hand_ = (float(mean_gap(h, sigma=contact.roughness.sigma)) / at_1) ** (1 / 0.69)
        assert speed == pytest.approx(by_hand_, rel=1e-8)


def test_shares_of_nobody_have_no_speed():
    contact, given = by_hand()
    ends = regime_speeds(contact, few=0.0, most=1.0, **given)
    assert ends == (None, None)
    assert bands_of([0.1, 1.0], ends) == [(0.1, 1.0, "mixed")]


def test_bands_lie_within_the_speeds():
    assert bands_of([1.0, 2.0], {"boundary": 5.0, "full": 9.0}) == [(1.0, 2.0, "boundary")]
    assert bands_of([1.0, 2.0], {"boundary": 0.1, "full": 1.5}) == [
        (1.0, 1.5, "mixed"),
        (1.5, 2.0, "full film"),
    ]


def test_what_passes_and_what_enters():
    dirt = {"concentration": 1e-6, "entry_ratio": 0.5, "friction": 0.1}
    found = run_film(check(data_of(entrainment=dirt)))
    contact, _ = by_hand()
    (sizes,) = (each.diameter for each in contact.populations)
    (part,) = found["passing"]
    shares = [sizes.partial_moment(0, 0.0, h).item() for h in found["states"]["h"]]
    assert part == {"name": "S45C", "share": shares}
    assert shares[0] == 0 < shares[-1] < 1
    oil = Entrainment(**dirt)
    gaps = found["states"]["h_T"]
    assert found["entrainment"]["largest"] == [float(oil.largest(h, R=9.5e-3)) for h in gaps]
    assert found["entrainment"]["areal_density"] == [
        [oil.areal_density(sizes, h=h, R=9.5e-3) for h in gaps]
    ]


def test_json_comes_back_as_the_same_contact(found):
    told = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    film = FilmConditions.from_dict(told["inputs"].pop("film"))
    contact = Contact.from_dict(told["inputs"])
    study = check(data_of())
    assert (film, contact) == (study.film, study.contact)
    assert film.stribeck(contact).mu.values.tolist() == told["states"]["mu"]


# ---------------------------------------------------------------- with other tables
def test_without_a_load_the_contact_is_pressed_by_its_film():
    mean, largest = data_of(), data_of(hertz="maximum")
    del mean["load"], largest["load"]
    study = check(mean)
    assert (study.load, study.own_load) == ("pressure", False)
    assert study.values.tolist() == [study.film.nominal_pressure(study.contact)]
    assert check(largest).values[0] == pytest.approx(1.5 * study.values[0], rel=1e-14)
    own = check(data_of())
    assert (own.values.tolist(), own.own_load) == ([5e6], True)
    del mean["film"]
    (problem, *_) = problems_of(mean)
    assert (problem.code, problem.place) == (Mistake.MISSING, "load")


def test_other_tables_stand_beside_it():
    study = check(
        data_of()
        | {
            "sweep": {"vary": {"roughness": {"sigma": ["80 nm", "120 nm"]}}},
            "uncertainty": {"inputs": {"roughness.sigma": {"low": "80 nm", "high": "120 nm"}}},
        }
    )
    assert study.sweep.count == 1
    assert study.film.load == 20.0


def test_a_line_a_formula_and_its_options_are_read():
    film = check(
        data_of(
            conjunction={"shape": "line", "R": "1 cm", "length": "25 mm"},
            formula={"name": "dowson-line"},
            slide_roll=None,
        )
    ).film
    assert film.conjunction == tb.films.Line(R=0.01, length=0.025)
    assert film.formula == tb.films.DowsonLine()
    assert film.slide_roll is None
    blend = {"name": "nijenbanning-venner-moes", "blend": "EI/EP"}
    assert check(data_of(formula=blend)).film.formula.blend == "EI/EP"


def test_a_radius_of_centimetres_is_no_slip():
    roller = {"shape": "line", "R": "20 mm", "length": "25 mm"}
    assert check(data_of(conjunction=roller)).notes == ()
    assert check(data_of(conjunction=roller | {"R": 0.5})).notes == ()
    (note,) = check(data_of(conjunction=roller | {"R": "9.5 m"})).notes  # of a journal in its bush
    assert 'film.conjunction.R = "9.5 m"' in note
    with refuses(Mistake.UNIT, "film.conjunction.R", value="9.5", says='"9.5 mm"'):
        check(data_of(conjunction=roller | {"R": 9.5}))


# ---------------------------------------------------------------- mistakes
MISTAKES = {
    "a unit": ({"load": "20 m"}, 'film.load = "20 m" is a length, but a force [N] is needed'),
    "a negative load": ({"load": -3}, "film.load = -3 must be > 0 [N]"),
    "no load": ({"load": None}, 'film.load is missing: normal load w [N], e.g. load = "20 N"'),
    "no speed": ({"speed": None}, "film.speed is missing: mean entrainment speed u [m/s]"),
    "standing still": ({"speed": 0}, "film.speed = 0 must be > 0 [m/s]"),
    "one of several": ({"speed": ["1 m/s", "2 m"]}, 'film.speed[1] = "2 m" is a length'),
    "a range": (
        {"speed": {"from": 2, "to": 1, "points": 3}},
        "film.speed is an empty range: from = 2 must be below to = 1; exchange them",
    ),
    "no bodies": ({"conjunction": None}, "film.conjunction is missing: the bodies, e.g."),
    "a shape": (
        {"conjunction": {"shape": "pont", "R": 0.01}},
        'film.conjunction.shape = "pont" must be one of "point", "line"; did you mean "point"?',
    ),
    "a key of the other shape": (
        {"conjunction": BALL | {"length": 1}},
        'film.conjunction.length = 1 is not a known key here: it goes with shape = "line"',
    ),
    "a line without length": (
        {"conjunction": {"shape": "line", "R": "9 mm"}},
        "film.conjunction.length is missing: length of the contact l [m]",
    ),
    "a word for a table": ({"oil": "ISO VG 32"}, 'film.oil = "ISO VG 32" must be a table'),
    "a key of the oil": (
        {"oil": {"eta": 0.02, "alfa": 2e-8}},
        "film.oil.alfa = 2e-08 is not a known key; did you mean alpha?",
    ),
    "a viscosity": (
        {"oil": {"eta": "40 cSt", "alpha": 0}},
        'film.oil.eta = "40 cSt" is in m**2/s, but a viscosity [Pa s] is needed, e.g. "20 mPa s"',
    ),
    "a slip": ({"slide_role": 0.1}, "film.slide_role = 0.1 is not a known key; did you mean slide"),
    "sliding backwards": ({"slide_roll": -1}, "film.slide_roll = -1 must be >= 0"),
    "another pressure": (
        {"pressure": "mean"},
        'film.pressure = "mean" has no place here: film.hertz = "mean" or "maximum" says',
    ),
    "a word": ({"hertz": "max"}, 'film.hertz = "max" must be one of "mean", "maximum"'),
    "a formula": ({"formula": "hamrock"}, 'film.formula = "hamrock" must be one of'),
    "another shape's formula": (
        {"formula": "moes-line"},
        "film.formula = moes-line is for line contacts, and the conjunction is a point",
    ),
    "shares": ({"few": 0.9, "most": 0.1}, "film.few = 0.9 must be at most most = 0.1"),
    "dirt": (
        {"entrainment": {"concentration": 1e-6, "entry_ratio": 1}},
        "film.entrainment.friction is missing: friction of a particle",
    ),
}


@pytest.mark.parametrize(("film", "sentence"), MISTAKES.values(), ids=MISTAKES)
def test_each_mistake_is_one_sentence(film, sentence):
    (told,) = problems_of(data_of(**film))
    assert told.startswith(sentence)


def test_every_mistake_is_told_at_once():
    film = {"load": "20 m", "slide_roll": -1, "conjunction": {"shape": "line", "R": -1}}
    starts = [text.split(" ", 1)[0] for text in problems_of(data_of(**film))]
    assert sorted(starts) == [
        "film.conjunction.R",
        "film.conjunction.length",
        "film.load",
        "film.slide_roll",
    ]


def test_in_python_too():
    study = check(data_of()).film
    for change in ({"speed": ()}, {"speed": (1.0, -1.0)}, {"oil": None}, {"conjunction": 3}):
        with pytest.raises(InvalidValue):
            study.replace(**change)


# ---------------------------------------------------------------- command line
def run(*arguments):
    return run_command("film", *arguments)


@pytest.mark.check
def test_the_command_tells_point_and_curve():
    done = run(EXAMPLE, "--set", "film.speed=0.5 m/s")
    assert done.exit_code == 0
    assert "128 nm" in done.stdout
    assert "0.03813" in done.stdout
    assert "122.7 nm" in done.stdout
    assert any("0.15" in note for note in done.notes)
    done = run(EXAMPLE, "--set", "film.speed.points=5")
    assert (
        "boundary up to 0.03056 m/s, where solids carry 99 % of the load, and a full film from "
        "12.55 m/s, where solids carry 1 % of the load."
    ) in " ".join(done.stdout.split())
    assert any("1 sigma" in note for note in done.notes)


@pytest.mark.parametrize(
    ("most", "few", "said"),
    [
        (
            1,
            0.01,
            "because there is no speed at which solids carry 100 % of the load, and a full film",
        ),
        (0.99, 0, "Lubrication is boundary up to 0.03056 m/s, where solids carry 99 % of the"),
        (1, 0, "and never a full film, because there is none at which solids carry 0 % of"),
    ],
)
def test_a_regime_that_is_never_reached_is_told_so(most, few, said):
    more = ["--set", f"film.most={most}", "--set", f"film.few={few}"]
    done = run(EXAMPLE, "--set", "film.speed.points=3", *more)
    assert done.exit_code == 0
    assert said in " ".join(done.stdout.split())


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (["roughness.eta_R_sigma=1e-9"], "Lubrication is never boundary"),
        (["film.load=20 MN", "film.speed=1e-6 m/s"], "load on particles not known"),
        (["surfaces.first.H=1 MPa", "surfaces.second.H=1 MPa"], "a full film at every speed"),
        (["film.load=1e-6 N"], "full film"),  # wider than every particle at every speed
        (["film.speed=1e9 m/s"], "full film"),
        (["particles.areal_density=0"], "Lubrication is boundary up to"),
    ],
)
def test_the_film_of_any_contact_is_told(settings, said):
    """Solids that never carry 99 %, states without numbers, particles that nothing touches."""
    bodies = ["surfaces.first", "surfaces.second"]
    steel = [f"{body}={{ E = '205 GPa', nu = 0.29, H = '5 GPa' }}" for body in bodies]
    more = [word for setting in (*steel, *settings) for word in ("--set", setting)]
    done = run(EXAMPLE, "--set", "film.speed.points=3", *more)
    assert done.exit_code == 0, done.output
    assert said in " ".join(done.stdout.split())


@pytest.mark.parametrize("fine", [None, "5=75, 10=1000"])
def test_python_hands_out_what_the_command_prints(fine):
    """The oil, behind a filter too, and what its answer hangs on."""
    few = ["film.speed=1", *([f'film.filter="{fine}"'] if fine else [])]
    done = run(EXAMPLE, *(part for each in few for part in ("--set", each)), "--json")
    plain = run_film(load_study(EXAMPLE, few)).to_dict()
    assert plain == json.loads(done.stdout)
    assert ("oil_filtered" in plain) == (fine is not None)
    assert plain["oil"]["populations"]
    assert plain["what_ifs"]
    clean = {name: table for name, table in data_of().items() if name != "particles"}
    alone = run_film(check(clean)).to_dict()
    assert not {"oil", "oil_filtered", "what_ifs"} & set(alone)


@pytest.mark.check
def test_json_csv_and_figure(tmp_path):
    numbers, figure = tmp_path / "o.csv", tmp_path / "o.svg"
    few = ("--set", "film.speed.points=3")
    done = run(EXAMPLE, *few, "--json", "--csv", numbers, "--figure", figure)
    assert done.exit_code == 0
    told = json.loads(done.stdout)
    head, *rows = csv.reader(numbers.open(encoding="utf-8"))
    assert head[:4] == ["speed [m/s]", "hersey [1]", "pressure [Pa]", "h [m]"]
    assert head[23:26] == ["status", "status_code", "S45C: passing [1]"]
    (place,) = (i for i, row in enumerate(rows) if row[head.index("S45C: per_hour [1/h]")])
    assert float(rows[place][0]) == told["oil"]["speed"] == told["states"]["speed"][1]
    assert "regime" in head
    assert [float(row[head.index("mu [1]")]) for row in rows] == told["states"]["mu"]
    assert figure.read_bytes().startswith(b"<?xml")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["o.csv", "o.svg"]


@pytest.mark.check
def test_friction_that_is_not_known_is_said(tmp_path):
    data = data_of(slide_roll=None)
    study = check(data)
    assert run_film(study)["states"]["mu"] == [None] * 6
    text = EXAMPLE.read_text(encoding="utf-8").replace("slide_roll", "# slide_roll")
    (tmp_path / "s.toml").write_text(text, encoding="utf-8")
    done = run(tmp_path / "s.toml", "--set", "film.speed=1", "--csv", tmp_path / "o.csv")
    assert "film.slide_roll" in done.stdout
    head, row = csv.reader((tmp_path / "o.csv").open(encoding="utf-8"))
    assert row[head.index("mu [1]")] == ""


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["--set", "film.load=-1"], Mistake.RANGE, "film.load = -1 "),
        (["--figure", "o.txt"], Mistake.UNWRITABLE, "--figure o.txt "),
        (["--set", "film.speed=1", "--csv", "no/o.csv"], Mistake.UNWRITABLE, "no/o.csv"),
    ],
)
def test_bad_input_writes_nothing(tmp_path, monkeypatch, arguments, code, says):
    monkeypatch.chdir(tmp_path)
    done = run(EXAMPLE, *arguments, "--json", *([] if "--csv" in arguments else ["--csv", "a.csv"]))
    assert done.exit_code == 2
    (problem,) = done.problems
    assert problem.code is code
    assert says in problem
    (written,) = json.loads(done.stdout)["problems"]
    assert written["code"] == code
    assert all(line.startswith(("error:", "warning:")) for line in done.stderr.splitlines())
    assert not list(tmp_path.iterdir())


def test_a_study_without_the_table_says_what_it_lacks():
    done = run(EXAMPLE.with_name("additive.toml"))
    assert done.exit_code == 2
    (problem,) = done.problems
    assert problem.code is Mistake.MISSING
    assert "[film]" in problem


def test_solids_that_carry_all_are_no_answer(tmp_path):
    settings = ("film.formula=hamrock-dowson", "film.speed=1e-12")
    done = run(EXAMPLE, *(f"--set={each}" for each in settings), "--csv", tmp_path / "o.csv")
    assert done.exit_code == 3
    assert "speed = 1e-12 m/s" in done.stderr.splitlines()[-1]
    assert not list(tmp_path.iterdir())


def test_the_example_shows_what_it_says():
    """Six times the speed with debris, and at 0.5 m/s a film thicker than the roughness."""
    study = load_study(EXAMPLE)
    clean = study.contact.replace(particles=None)
    ratio = study.film.regime_speeds(study.contact).full / study.film.regime_speeds(clean).full
    assert 6 < ratio < 7
    assert study.film.at(study.contact, speed=0.5).lambda_ratio > 1


# ---------------------------------------------------------------- without the oil
def test_solve_and_assess_say_that_the_oil_is_left_out(tmp_path):
    """Before every other note, in text and in JSON."""
    file = tmp_path / "film.toml"
    file.write_text(EXAMPLE.read_text("utf-8"), "utf-8")
    wet = run_command("solve", file, "--json")
    assert wet.exit_code == 0
    assert wet.codes[0] == "film.left_out"
    assert json.loads(wet.stdout)["warnings"][0] == note_without_oil("states are")
    assert "thirdbody film" in wet.notes[0]
    bare = {key: value for key, value in data_of().items() if key not in ("particles", "outputs")}
    assert f"{note_without_oil('This page is')}." in assess_study(check(bare)).notes

    dry = {key: value for key, value in data_of().items() if key != "film"}
    dry["load"] = {"pressure": "5 MPa"}
    assert run_study(check(dry)).oil_notes == ()


# ---------------------------------------------------------------- report
def test_the_report_has_the_film_and_the_same_bytes(monkeypatch):
    # the other figures cost most of a page and know nothing of the film
    monkeypatch.setattr("thirdbody.views.report.page.figures_of", lambda report: [])
    data = data_of()
    del data["particles"], data["outputs"]
    study = check(data)
    # without slopes and error bars, which cost most of a report and know nothing of the film
    told = Report(
        study=study,
        result=run_study(study),
        curve=study.solve(),
        assessment=None,
        slopes=None,
        at=0,
        film=run_film(study),
    )
    page = told.html()
    assert film_section(told)[0] in page
    section = page.partition('<section id="film">')[2].partition("</section>")[0]
    ends = told.study.film.regime_speeds(told.contact)
    assert f"boundary up to {ends.boundary:.4g} m/s, where solids carry 99 % of the load" in section
    assert f"a full film from {ends.full:.4g} m/s, where solids carry 1 % of the load" in section
    assert "data:image/svg+xml" in section
    assert "[outputs.friction]" in section
    assert "below 1 sigma roughness hinders the flow" in page
    assert note_without_oil("states are") not in page  # its parts say which leave the oil out
    assert "Johnson, Greenwood, Poon 1972" in page
