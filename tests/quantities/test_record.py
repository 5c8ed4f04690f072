"""Results as records: their columns say what they are, and every form holds the same numbers."""

import copy
import importlib.util
import inspect
import json
import pickle
import pkgutil
from dataclasses import dataclass, fields, is_dataclass, replace
from html import escape
from importlib import resources
from typing import NamedTuple

import numpy as np
import pytest

import thirdbody as tb
import thirdbody.study
from thirdbody.analysis.compare import comparison_of
from thirdbody.explicit.ensemble import surface_of
from thirdbody.papers import ghaednia2013
from thirdbody.quantities.record import (
    VERSION,
    Record,
    StateRecord,
    TableRecord,
    declared_columns,
    with_names,
)
from thirdbody.quantities.value import Value
from thirdbody.results import Status
from thirdbody.study import check, run_film, run_study
from thirdbody.study.analyses import assess_study
from thirdbody.study.life_assessment import assess_life
from thirdbody.study.run_connector import load_connector, run_connector
from thirdbody.study.run_life import ReportsResult, load_life, run_life
from thirdbody.study.run_life_design import design_life
from thirdbody.study.run_plate import load_plate, run_plate

STEEL = tb.materials["S45C"]
CONTACT = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=300e-9, R=3e-6)
)
FILM = {"conjunction": tb.films.Point(R=9.5e-3), "oil": tb.films.Oil(eta=0.02, alpha=2e-8)}
STUDY = {
    "surfaces": {"first": "S45C", "second": "S45C"},
    "roughness": {"sigma": "100 nm", "R": "2.8 um"},
    "load": {"F_star": [1e-5, 1e3]},
    "film": {
        "load": "20 N",
        "speed": ["0.1 m/s", "1 m/s"],
        "conjunction": {"shape": "point", "R": "9.5 mm"},
        "oil": {"eta": "20 mPa s", "alpha": "20 / GPa"},
    },
}

BESIDE_COLUMNS = {"populations", "warnings", "notes"}
"""What plain data of states have beside a list for each column."""


def states():
    """A result of every kind that has columns, of two states."""
    surface = surface_of(CONTACT, size=128, spacing=150e-9)
    return {
        "Equilibrium": tb.solve(CONTACT, pressure=[1e6, 5e6]),
        "MixedFilm": tb.films.mixed_film(CONTACT, load=20.0, speed=[0.1, 1.0], **FILM),
        "ExplicitState": tb.explicit.solve(CONTACT, surface, F_star=[1e-4, 1e-3]),
    }


@pytest.fixture(scope="module")
def every():
    return states()


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("name", ["Equilibrium", "MixedFilm", "ExplicitState"])
def test_every_form_of_states_holds_the_same_numbers(every, name):
    state = every[name]
    assert type(state).__name__ == name
    plain, data, table = state.to_dict(), state.to_dataset(title="two"), state.to_dataframe()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    if name != "ExplicitState":  # which says of each state whether it converged
        codes = plain["status_code"]
        assert codes == list(state.status_code) == list(table["status_code"])
        assert codes == data.status_code.values.tolist()
        words = data.status_code.flag_meanings.split()
        assert [words[code] for code in codes] == [Status(code).word for code in codes]
        assert table.attrs["long_name"]["status_code"] == data.status_code.long_name
    columns = [key for key in plain if key not in BESIDE_COLUMNS]
    assert columns == list(table.columns) == [str(each) for each in data.data_vars]
    assert data.title == "two"
    for column, told in declared_columns(type(state)).items():
        values = getattr(state, column)
        np.testing.assert_array_equal(data[column].values, values)
        np.testing.assert_array_equal(table[column], values)
        known = [None if each != each else each for each in np.asarray(values).tolist()]
        assert plain[column] == known
        assert (data[column].units, data[column].long_name) == (told.unit, told.meaning)
        assert table.attrs["symbol"][column] == told.symbol
    assert f"{name}, 2 states" in state._repr_html_()


def is_its_copy(found):
    """Whether a result is equal to its copies, of which a pickle is one, and has their hash."""
    copies = [copy.deepcopy(found), pickle.loads(pickle.dumps(found))]
    same_hash = type(found).__hash__ is None or {hash(each) for each in copies} == {hash(found)}
    return same_hash and all(each is not found and each == found for each in copies)


def test_states_are_equal_by_their_values():
    """At any depth, NaN to NaN; another load, contact or kind of result is another result."""
    one, two = (tb.solve(CONTACT, pressure=[1e6, 1e15]) for _ in range(2))
    assert (np.isnan(one.d[1]), one == two, hash(one) == hash(two)) == (True, True, True)
    assert one != tb.solve(CONTACT, pressure=[2e6, 1e15])
    assert one != replace(one, d=one.d[:1])
    assert one != replace(one, outputs={"mu": one.d})
    assert one != replace(one, status=one.mode)
    assert one != one.to_dict()
    assert tb.solve(CONTACT, pressure=1e6) == tb.solve(CONTACT, pressure=1e6)
    assert tb.transitions(CONTACT) == tb.transitions(CONTACT)  # with NaN in them
    assert len({one, two, tb.solve(CONTACT, pressure=1e6)}) == 2


def test_a_state_without_a_number_has_one_mode_in_every_form(tmp_path):
    """An empty word; in plain data None, as the JSON of a study has null."""
    state = tb.solve(CONTACT, pressure=[1e6, 1e15])
    asked = {"pressure": [1e6, 1e15], "columns": ["A_t", "mode"]}
    forms = [state.mode, state.columns()["mode"], state.to_dataset()["mode"].values]
    forms += [state.to_dataframe()["mode"], tb.sweep(CONTACT, **asked)["mode"].values]
    if importlib.util.find_spec("zarr"):
        forms += [tb.sweep(CONTACT, **asked, out=tmp_path / "out")["mode"].values]
    assert [list(form) for form in forms] == [["s-s", ""]] * len(forms)
    assert state.to_dict()["mode"] == ["s-s", None]
    assert run_study(check(STUDY)).to_dict()["states"]["mode"] == ["s-s", None]


def test_warnings_are_notes_that_stand_taken_apart_in_plain_data():
    with pytest.warns(tb.errors.RangeWarning):
        state = tb.solve(CONTACT.replace(asperity_law=tb.asperity.GW()), pressure=1e8)
    plain = state.to_dict()
    assert state.notes == state.warnings != ()
    assert plain["warnings"] == [one["sentence"] for one in plain["notes"]] == list(state.notes)
    assert [one["code"] for one in plain["notes"]] == [one.code for one in state.notes]


@pytest.mark.parametrize("name", ["Equilibrium", "MixedFilm", "ExplicitState"])
def test_states_are_their_copies(every, name):
    assert is_its_copy(every[name])


def test_a_record_leaves_out_what_it_says_and_no_number_that_is_not_finite():
    @dataclass(frozen=True)
    class Found(Record):
        contact: str
        value: float
        parts: tuple
        inner: tb.results.Transitions

    critical = tb.transitions(CONTACT)
    told = Found("much", float("nan"), (np.float64(1.0), np.inf), critical).to_dict()
    assert told == {"value": None, "parts": [1.0, None], "inner": critical.to_dict()}
    assert told["inner"]["F_tpca"]["A"] == {"value": None, "status": "none"}
    assert list(critical.entries()) == ["F_cr1", "F_cr2", "F_tpca.A", "F_tpca.B", "F_tpca.C"]


def test_a_record_says_by_entries_what_it_hands_out():
    """Names, paths, functions, dicts of entries, items of mappings, in their order."""

    class Event(NamedTuple):
        time: float
        name: str

    @dataclass(frozen=True)
    class Inner(Record):
        warnings: tuple[str, ...] = ("inner",)
        mean: float = float("inf")

    @dataclass(frozen=True)
    class Outer(Record):
        in_dict = (
            *("size", VERSION, ("mean", "inner.mean"), ("twice", lambda outer: 2 * outer.size)),
            ("inputs", (("count", "count"), ("", "table"))),
            *(("", "inner"), ("events", with_names("events")), ("last", with_names("events"))),
            *(("one", with_names("one")), ("none", with_names("none")), "rows", "warnings"),
        )
        size: float = 1.5
        inner: Inner = Inner()
        events: tuple[Event, ...] = (Event(0.5, "a"), Event(float("nan"), "b"))
        rows: tuple[Event, ...] = (Event(1.0, "c"),)
        one: Event = Event(2.0, "d")
        none: Event | None = None
        warnings: tuple[str, ...] = ("outer",)

        def count(self):
            return 3

        @property
        def table(self):
            return {"a": np.array([1.0, np.nan]), "b": self.inner}

    events = [{"time": 0.5, "name": "a"}, {"time": None, "name": "b"}]
    plain = {"warnings": ["inner"], "mean": None}
    wanted = {
        "size": 1.5,
        "version": tb.__version__,
        "twice": 3.0,
        "inputs": {"count": 3, "a": [1.0, None], "b": plain},
        "mean": None,  # comes again with the items of the inner record
        "events": events,
        "last": events,
        "one": {"time": 2.0, "name": "d"},
        "none": None,
        "rows": [[1.0, "c"]],
        "warnings": ["outer"],
    }
    assert json.dumps(Outer().to_dict()) == json.dumps(wanted)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("run", [run_study, run_film])
def test_results_of_a_study_are_read_by_attribute_and_by_key(run):
    found = run(check(STUDY))
    plain = found.to_dict()
    assert dict(found) == plain
    assert list(found) == list(plain)
    assert "states" in found
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["warnings"] == list(found.warnings) == list(found.notes)
    columns, units = found.table()
    assert set(columns) == set(units)
    for name, values in columns.items():
        if name in plain["states"]:
            assert plain["states"][name] == values
    if run is run_study:
        assert found.solved_states == [0]
        assert plain["states"]["A_t"] == [found.states.A_t[0], None]
        assert found.particles_in(0) == float("inf")  # without particles nobody counts them


def test_a_misspelt_name_is_asked_back():
    """Of an attribute, an output, a key; what there is not stays so for `hasattr` and the like."""
    state = tb.solve(CONTACT.replace(outputs=(tb.outputs.Friction(tau_ss=5e8),)), pressure=5e6)
    for name, meant in {"A_tt": "A_t", "mu": "mu", "too_dict": "to_dict", "xyz": None}.items():
        with pytest.raises(AttributeError) as no_attribute:
            getattr(state, name)
        assert no_attribute.value.args[0].meant == meant
    for key, meant in {"muu": "mu", "colour": None}.items():
        with pytest.raises(KeyError) as error:
            state.outputs[key]
        assert (error.value.args[0], error.value.args[1].meant) == (key, meant)
        assert str(pickle.loads(pickle.dumps(error.value))) == str(error.value)
    assert not hasattr(state, "mu")
    assert "muu" not in state.outputs
    assert state.outputs.get("muu") is None
    assert getattr(tb.transitions(CONTACT), "outputs", None) is None
    assert is_its_copy(state)
    with pytest.raises(KeyError) as error:
        run_study(check(STUDY))["state"]
    assert error.value.args[1].meant == "states"


@pytest.mark.parametrize("name", ["Equilibrium", "MixedFilm", "ExplicitState"])
def test_dir_shows_what_users_read(every, name):
    state = every[name]
    shown = {one for one in dir(state) if not one.startswith("_")}
    methods = {"about", "columns", "to_dict", "to_dataset", "to_dataframe"}
    assert {*declared_columns(type(state)), *methods} <= shown
    assert not {"along", "in_dict", "more_columns", "variables"} & shown


def test_a_property_that_fails_says_why():
    @dataclass(frozen=True)
    class Found(Record):
        @property
        def value(self):
            return None.real_cause

    with pytest.raises(AttributeError, match="real_cause"):
        assert Found().value


def test_a_column_that_there_is_not_is_refused(every):
    for state in every.values():
        assert state.about("A_t").unit == "1"
        with pytest.raises(tb.errors.InvalidValue, match="A_tt"):
            state.about("A_tt")


def test_the_table_of_a_study_has_the_units_of_each_population():
    """Depths of the dents that one population leaves are lengths, as those of all are."""
    dust = {"distribution": "monodisperse", "mean": "1 um", "areal_density": "1e9 / m^2"}
    two = [dust | {"material": name, "name": name} for name in ("SiO2", "Al2O3")]
    asked = {key: value for key, value in STUDY.items() if key != "film"}
    found = run_study(check(asked | {"particles": two, "outputs": {"dents": {}}}))
    assert found.states.to_dict()["populations"] == found.to_dict()["populations"]
    columns, units = found.table()
    assert units["SiO2: dent_depth_1"] == units["dent_depth_1"] == "m"
    assert units["SiO2: load_share"] == "1"
    assert columns["SiO2: load_share"][1] is None
    for part, told in zip(found.states.populations, found.to_dict()["populations"], strict=True):
        assert told == part.to_dict()
        assert "PopulationShare, 2 states" in part._repr_html_()
        assert part._repr_html_() in found.states._repr_html_()
        assert "status_code" not in told
        assert part.to_dataframe()["load_share"].tolist() == pytest.approx(
            part.load_share.tolist(), nan_ok=True
        )


def test_states_declare_what_they_hold():
    """No field of numbers stands beside the columns without a symbol, unit and meaning."""
    beside = {"contact", "warnings", "populations", "outputs", "engine", "status_code", "state"}
    beside |= {"seconds", "sigma", "seats", "maps", "particles", "name", "errors"}
    beside |= {"nominal_area", "kappa"}  # of all states together, which data sets hold as such
    for kind in StateRecord.__subclasses__():
        for each in (kind, *kind.__subclasses__()):
            if hasattr(each, "__dataclass_fields__"):
                assert {item.name for item in fields(each)} - set(declared_columns(each)) <= beside


# ------------------------------------------------------------- results that are no states
DUSTY = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    particles=tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    ),
)
LOADS = [1e6, 5e6]


def check_labels(data, table, dims):
    """Both forms have the same columns, and each says what it is."""
    assert set(data.sizes) == dims
    for name, values in data.data_vars.items():
        assert values.attrs["long_name"]
        if "mode" not in values.dims:
            assert table.attrs["long_name"][name] == values.long_name


def test_bands_as_data_and_as_a_table():
    found = tb.propagate(
        DUSTY,
        vary={"roughness.sigma": (9e-8, 1.1e-7)},
        pressure=LOADS,
        samples=64,
        outputs=["h", "F_cr1"],
    )
    data, table = found.to_dataset(title="bands"), found.to_dataframe()
    check_labels(data, table, {"pressure", "quantile", "mode"})
    assert data.title == "bands"
    np.testing.assert_array_equal(data.h_nominal, found.nominal["h"])
    assert table.index.names == ["pressure", "quantile"]
    assert table.loc[(5e6, 0.5), "h"] == found.bands["h"][1][2]
    assert table.loc[(1e6, 0.05), "F_cr1_error"] == found.error["F_cr1"][0]
    for mode, share in found.mode_probability.items():
        column = table[f"mode_probability[{mode}]"]
        assert column.loc[1e6].tolist() == [share[0]] * 5
        assert column.loc[5e6].tolist() == [share[1]] * 5
    assert (table.attrs["units"]["h"], table.attrs["symbol"]["h_error"]) == ("m", "h")
    one = found.at_load(1)
    assert set(one.to_dataset().sizes) == {"quantile", "mode"}
    np.testing.assert_array_equal(one.to_dataframe()["h"], table.loc[5e6, "h"])


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_slopes_as_data_and_as_a_table():
    inputs = ["roughness.sigma", "pressure"]
    found = tb.sensitivity(DUSTY, of=["h", "F_cr1"], to=inputs, pressure=LOADS, quick=True)
    data, table = found.to_dataset(), found.to_dataframe()
    check_labels(data, table, {"of", "to", "pressure"})
    for at, load in enumerate(LOADS):
        for to in inputs:
            row = table.loc[("h", to, load)]
            for name in ("derivative", "elasticity", "error", "status"):
                assert row[name] == getattr(found, name)["h"][to][at]
            assert table.loc[("F_cr1", to, load), "value"] == found.value["F_cr1"]
    assert table.loc[("h", "pressure", 5e6), "input"] == 5e6
    units = data.derivative_units.sel(of="h")
    assert [str(units.sel(to=to).values) for to in inputs] == ["1", "m/Pa"]
    assert data.to_symbol.values.tolist() == ["σ", "p"]


def test_critical_loads_as_data_and_as_a_table():
    found = tb.transitions(DUSTY)
    data, table = found.to_dataset(), found.to_dataframe()
    check_labels(data, table, {"transition"})
    for name, load in found.entries().items():
        assert table.loc[name, "status"] == load.status
        value = table.loc[name, "F_star"]
        assert np.isnan(value) if load.value is None else value == load.value


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("coordinate", ["h", "d"])
def test_a_table_of_a_contact_in_every_form(coordinate, tmp_path):
    shares = ["particle_load_share"]
    made = tb.table(DUSTY, tolerance=1e-2, columns=shares, coordinate=coordinate)
    data, table, plain = made.to_dataset(), made.to_dataframe(), made.to_dict()
    check_labels(data, table, {coordinate})
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["error"]["p"] == made.error.p == data.error_p
    np.testing.assert_array_equal(data[coordinate], made.h)
    np.testing.assert_allclose(data.p, made.p(made.h), rtol=1e-12)
    made.to_csv(tmp_path / "table.csv")
    lines = (tmp_path / "table.csv").read_text("utf-8").splitlines()
    head, *rows = [line.split(",") for line in lines if not line.startswith("#")]
    assert [words.partition(" ")[0] for words in head] == [coordinate, *table.columns]
    np.testing.assert_array_equal(np.array(rows, dtype=float)[:, 1:], table)
    for name in table.columns:
        assert plain[name] == table[name].tolist()
        assert f"{name} [{table.attrs['units'][name]}]" in head
    assert f"ContactTable, {len(rows)} values of {coordinate}" in made._repr_html_()


OIL = tb.oil.OilCircuit(
    volume=0.2,
    start=tb.oil.OilDirt.from_iso4406("18/16/13", material=tb.materials["quartz"]),
    ingress=(),
    filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3),
)
RESULTS = {
    "LifeHistory": (lambda: tb.life(oil=OIL, duration=1800.0), "time"),
    "RoughBody": (lambda: tb.systems.rough_body.rough_sphere(CONTACT, radius=5e-3, load=10.0), "r"),
    "WavyContact": (
        lambda: tb.systems.waviness.rigid_wave(CONTACT, amplitude=150e-9, pressure=5e6),
        "height",
    ),
    "RadialShare": (
        lambda: tb.systems.load_sharing.share_radial_load(900.0, bodies=9, stiffness=1e10),
        "angles",
    ),
    "OilReports": (
        lambda: tb.oil.oil_reports(
            [0.0, 1e6],
            reports=[[1e9], [3e9]],
            sizes=[6e-6],
            circuit=OIL.replace(filters=()),
        ),
        "time",
    ),
    "StudyResult": (lambda: run_study(check(STUDY)), "state"),
    "FilmResult": (lambda: run_film(check(STUDY)), "speed"),
    "Ensemble": (
        lambda: tb.explicit.ensemble(CONTACT, surfaces=2, size=64, F_star=[1e-4, 1e-3]),
        "F_star",
    ),
}


TOPOGRAPHY = tb.surfaces.from_topography("example")
SIZES = tb.sizes.MeasuredSizes(
    sizes=tb.distributions.Histogram(edges=(1e-6, 2e-6, 4e-6, 8e-6), counts=(3, 14, 9)),
    weighting="number",
)
IN_FILM = tb.systems.oil_particles.FilmParticles.from_iso4406(
    "18/16/13", surfaces=CONTACT.surfaces, material=STEEL, film=0.5e-6, entry=1.0
)
VAGUE = ["life.uncertainty.ingress={ median = 1, gsd = 2 }"]


def template(kind):
    """A study that `thirdbody new` writes."""
    return resources.files("thirdbody").joinpath(f"data/studies/{kind}.toml")


RESULTS |= {
    "Curve": (TOPOGRAPHY.curve, "cutoff"),
    "Summits": (lambda: TOPOGRAPHY.summits, "summit"),
    "LocalInteraction": (
        lambda: tb.systems.interaction.local_interaction(CONTACT, d=[2e-7, 3e-7]),
        "state",
    ),
    "MeanInteraction": (
        lambda: tb.systems.interaction.mean_interaction(
            CONTACT, nominal_area=1e-6, pressure=[1e6, 5e6]
        ),
        "state",
    ),
    "MultiscaleState": (lambda: ghaednia2013.model("fractal").solve([1e6, 2e6]), "state"),
    "Comparison": (
        lambda: comparison_of(CONTACT, F_star=[1e-5, 1e-4], laws=["ceb", "persson"]),
        "law",
    ),
    "Best": (
        lambda: tb.design(
            DUSTY,
            vary={"particles.areal_density": (1e9, 1e10), "particles.material": [STEEL]},
            objective=tb.objectives.Objective(of="A_t", aim="smallest"),
            pressure=LOADS,
            points=4,
        ),
        "point",
    ),
    "Assessment": (
        lambda: tb.assess(DUSTY, vary={"roughness.sigma": (9e-8, 1.1e-7)}, pressure=5e6),
        "input",
    ),
    "Assessments": (
        lambda: assess_study(check(STUDY | {"load": {"F_star": [1e-5, 1e-4]}})),
        "load",
    ),
    "ConnectorResult": (lambda: run_connector(load_connector(template("connector"))), "force"),
    "PlateResult": (lambda: run_plate(load_plate(template("wafer-chuck"))), "grain"),
    "LifeResult": (lambda: run_life(load_life(template("oil-circuit"))), "time"),
    "DryResult": (lambda: run_life(load_life(template("dry-contact"))), "time"),
    "LifeDesign": (
        lambda: design_life(load_life(template("oil-circuit"), ['life.design.code="16/14/11"'])),
        "name",
    ),
    "LifeAssessment": (lambda: assess_life(load_life(template("oil-circuit"), VAGUE)), "input"),
    "ReportsResult": (
        lambda: ReportsResult(
            asked=load_life(template("oil-circuit")), reports=RESULTS["OilReports"][0]()
        ),
        "size",
    ),
}
HEADINGS = {
    "Assessment": "Mode at the operating load",
    "Assessments": "Mode at each load",
    "Best": "Best values",
}
"""What notebooks show above results that are pages."""
OF_TESTS = {
    # above
    *("Equilibrium", "ExplicitState", "MixedFilm", "PopulationShare"),
    *("ContactTable", "Propagation", "Sensitivity", "Transitions"),
    # in test_coupled.py and test_contact_histories.py
    *("Coupled", "CoupledState", "ContactHistory", "DryHistory"),
    # abstract: others are made from them
    *("AskedResult", "QuestionResult"),
}
"""Tables whose forms have a test of their own."""
NUMBERS = {
    "Critical": lambda: tb.transitions(DUSTY).F_cr1,
    "TurningPoint": lambda: tb.transitions(DUSTY).F_tpca,
    "TableError": lambda: tb.table(CONTACT, tolerance=1e-2).error,
    "Fit": lambda: SIZES.fits()[0],
    "FilmDents": IN_FILM.dents,
    "SeverityIndex": IN_FILM.severity_index,
}
"""Results of numbers alone, which are no table."""
TUPLES = {
    *("BearingSize", "Branch", "Bump", "Column", "Concentration", "Convergence", "FractalLoad"),
    *("Hertz", "HertzPoint", "Jump", "Squeezed", "SummitSum"),
}
"""A few numbers that are unpacked, and read by name; none that is a table joins them."""
ROOMS = ("analysis", "equilibrium", "explicit", "populations", "study", "systems")


def kinds_under(base):
    """Every class of results under one, by its name."""
    for kind in base.__subclasses__():
        if is_dataclass(kind) and kind.__module__.startswith("thirdbody."):
            yield kind
        yield from kinds_under(kind)


def public_classes():
    """Every class that a module of the library, or one of its systems, lists for users."""
    modules = [tb, *(getattr(tb, name) for name in tb.__all__), tb.oil, thirdbody.study]
    modules += [getattr(tb.systems, name) for name in tb.systems.__all__]
    for module in filter(inspect.ismodule, modules):
        for name in getattr(module, "__all__", ()):
            if inspect.isclass(value := getattr(module, name)):
                yield value


def test_every_result_has_the_forms_of_its_kind():
    """A result that is a table has all four, and stands in a test that reads them."""
    for room in ROOMS:
        package = importlib.import_module(f"thirdbody.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    tables = {kind.__name__ for kind in kinds_under(TableRecord) if kind.__name__[0] != "_"}
    assert tables == {*RESULTS, *OF_TESTS}
    public = {kind for kind in public_classes() if is_dataclass(kind) or hasattr(kind, "_fields")}
    tuples = {kind.__name__ for kind in public if hasattr(kind, "_fields")}
    assert tuples == TUPLES
    records = {kind.__name__ for kind in public if issubclass(kind, Record)}
    # what is given, and maps, whose heights stay out of plain data
    assert records - tables - {*NUMBERS} == {"Uncertain", "Topography"}
    rest = {kind.__name__ for kind in public if not issubclass(kind, Record | Value)}
    assert rest - tuples == {"Solved", "Study"}  # which are no plain results


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("name", NUMBERS)
def test_results_of_numbers_alone_have_two_forms(name):
    found = NUMBERS[name]()
    assert type(found).__name__ == name
    assert is_its_copy(found)
    plain, page = found.to_dict(), found._repr_html_()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert list(plain) == [item.name for item in fields(found)]
    assert name in page
    for about in declared_columns(type(found)).values():
        assert escape(about.meaning) in page


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("name", RESULTS)
def test_other_results_in_every_form(name):
    make, along = RESULTS[name]
    found = make()
    assert type(found).__name__ == name
    assert is_its_copy(found)
    data, table = found.to_dataset(title="a title"), found.to_dataframe()
    assert data.attrs["title"] == "a title"
    assert found.to_dict()
    assert table.index.names[0] == along
    for column, values in data.data_vars.items():
        assert values.attrs["long_name"]
        if values.dims == (along,) and len(table) == data.sizes[along]:
            np.testing.assert_array_equal(table[column], values)
            assert table.attrs["units"][column] == values.attrs.get("units", "")
        if column in declared_columns(type(found)):
            value = getattr(found, column)
            np.testing.assert_array_equal(values, np.nan if value is None else value)
    assert HEADINGS.get(name, f"{name}, ") in found._repr_html_()


def test_a_history_has_a_column_for_each_class_and_material():
    found, _ = RESULTS["LifeHistory"]
    found = found()
    data, table = found.histories, found.to_dataframe()
    middle = data["class"].values[3]
    np.testing.assert_array_equal(table[f"n[{middle}][quartz]"], found.numbers[:, 3, 0])
    np.testing.assert_array_equal(table["count[4e-06]"], found.counts[:, 0])
    assert table.attrs["units"]["count[4e-06]"] == "1/m^3"


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_bodies_and_waves_say_their_status_by_a_number():
    body = RESULTS["RoughBody"][0]()
    assert (body.status, body.status_code) == ("ok", Status.OK)
    assert body.to_dataset()["load"].units == "N"
    cylinder = tb.systems.rough_body.rough_cylinder(CONTACT, radius=5e-3, load=1e4)
    assert cylinder.to_dataset()["load"].units == "N/m"
    assert cylinder.to_dataframe().attrs["units"]["real_area"] == "m^2/m"
    wave = tb.systems.waviness.rigid_wave(CONTACT, amplitude=50e-9, pressure=2.5e9)
    assert wave.status.startswith("crowded")
    assert wave.status_code == Status.CROWDED == int(wave.to_dataset().status_code)
