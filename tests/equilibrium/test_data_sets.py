"""States as labelled data, as tables, and in notebooks."""

import builtins
import json
from html.parser import HTMLParser

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.equilibrium.columns import COLUMNS
from thirdbody.equilibrium.states import state_columns

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]


def contact(**changes) -> tb.Contact:
    options = {
        "surfaces": tb.MaterialPair(STEEL, STEEL),
        "roughness": tb.Roughness(sigma=1e-7, R=2.8e-6),
        "particles": dust("dust", 3e-7),
    }
    return tb.Contact(**(options | changes))


def dust(name, mean) -> tb.Particles:
    sizes = tb.TruncatedGaussian(mean=mean, std=0.08 * mean)
    return tb.Particles(name=name, material=SILICA, diameter=sizes, areal_density=1e11)


# ------------------------------------------------------------------------------ to_dataset
@pytest.mark.parametrize("pressure", [5e6, [1e6, 5e6, 2e7]])
def test_every_column_with_its_unit(pressure):
    state = tb.solve(contact(outputs=tb.outputs.Counts()), pressure=pressure)
    data = state.to_dataset(title="a title")
    assert set(data.data_vars) == set(state.columns())
    for name, values in state.columns().items():
        assert data[name].dims == ("state",)
        np.testing.assert_array_equal(data[name].values, values)
        assert {"units", "symbol", "long_name"} <= set(data[name].attrs)
    assert data.d.attrs["units"] == "m"
    assert data.pressure.attrs["units"] == "Pa"
    assert data.title == "a title"
    assert data.engine == state.engine
    assert json.loads(data.inputs) == state.contact.to_dict()


def test_warnings_are_kept():
    with pytest.warns(tb.errors.RangeWarning):
        state = tb.solve(contact(), pressure=3e9)
    assert state.warnings
    assert state.to_dataset().warnings.splitlines() == list(state.warnings)


def test_what_each_population_carries():
    both = (dust("a", 3e-7), dust("b", 2e-7))
    state = tb.solve(contact(particles=both), pressure=[1e6, 5e6])
    data = state.to_dataset()
    assert data.population.values.tolist() == ["a", "b"]
    total = data.population_load_share.sum("population")
    np.testing.assert_allclose(total, data.particle_load_share, rtol=1e-12)
    table = state.to_dataframe()
    assert table["population_load_share[b]"].tolist() == state.populations[1].load_share.tolist()
    assert table.attrs["units"]["population_load_share[b]"] == "1"
    assert table.index.tolist() == [0, 1]


def test_a_file_keeps_all(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    data = tb.solve(contact(), pressure=[1e6, 5e6]).to_dataset(title="kept")
    data.to_netcdf(tmp_path / "states.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "states.nc", engine="h5netcdf") as back:
        assert back.attrs == data.attrs
        np.testing.assert_array_equal(back.A_t, data.A_t)
        assert back["mode"].values.tolist() == data["mode"].values.tolist()


# ---------------------------------------------------------------------------- to_dataframe
def test_a_row_for_each_state():
    pytest.importorskip("pandas")
    state = tb.solve(contact(), pressure=[1e6, 5e6])
    table = state.to_dataframe()
    assert list(table.columns) == [*COLUMNS, "status_code"]
    assert table["status_code"].tolist() == [0, 0]
    assert table.index.name == "state"
    np.testing.assert_array_equal(table["A_t"], state.A_t)
    assert table.attrs["units"]["d"] == "m"
    assert table.attrs["symbol"]["d_star"] == "d*"


def test_without_pandas_the_message_says_what_to_do(monkeypatch):
    usual = builtins.__import__

    def without(name, *others):
        if name == "pandas":
            raise ModuleNotFoundError(name)
        return usual(name, *others)

    state = tb.solve(contact(), pressure=5e6)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match=r"pip install pandas.*to_dataset"):
        state.to_dataframe()


# ---------------------------------------------------------------------------- solve_states
def test_solve_states_gives_labelled_data():
    vary = {"roughness.sigma": np.array([5e-8, 1e-7, 2e-7]), "roughness.R": 3e-6}
    data = tb.equilibria.solve_states(contact(), pressure=2e6, vary=vary)
    assert dict(data.sizes) == {"state": 3}
    assert set(data.coords) == {"pressure", *vary}
    assert data["roughness.sigma"].attrs["units"] == "m"
    assert data["pressure"].attrs["units"] == "Pa"
    assert data["pressure"].values.tolist() == [2e6] * 3
    assert json.loads(data.inputs) == contact().to_dict()
    plain = state_columns(contact(), pressure=2e6, vary=vary)
    assert set(plain) == {*data.data_vars, "pressure"}
    for name, values in plain.items():
        np.testing.assert_array_equal(data[name].values, values)


def test_inputs_that_are_words_are_coordinates():
    data = tb.equilibria.solve_states(
        contact(), pressure=2e6, vary={"particle_law.seat": ["rough", "plane"]}
    )
    assert data["particle_law.seat"].values.tolist() == ["rough", "plane"]


# ------------------------------------------------------------------------------- notebooks
class Text(HTMLParser):
    """The elements of a piece of HTML, which must close in order, and its words."""

    def __init__(self, html):
        super().__init__()
        self.open, self.tags, self.words = [], set(), []
        self.feed(html)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.tags.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def shown() -> dict:
    found = contact(particles=dust("<script>alert(1)</script> & co", 3e-7))
    state = tb.solve(found, pressure=[1e6, 5e6])
    return {
        "contact": found,
        "material": STEEL.replace(name="<script>"),
        "pair": found.surfaces,
        "particles": found.particles,
        "state": tb.solve(found, pressure=5e6),
        "states": state,
        "transitions": tb.transitions(found),
        "sensitivity": tb.sensitivity(found, of="A_t", to=["roughness.sigma"], pressure=5e6),
    }


@pytest.fixture(scope="module")
def values():
    return shown()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("contact", ["η_a", "particles per nominal area", "100 nm"]),
        ("material", ["205 GPa", "Young's modulus", "<script>"]),
        ("pair", ["205 GPa", "Young's modulus"]),
        ("particles", ["300 nm", "<script>alert(1)</script> & co"]),
        ("state", ["5 MPa", "nominal pressure", "hybrid"]),
        ("states", ["Equilibrium, 2 states", "1 MPa", "5 MPa"]),
        ("transitions", ["F_cr1", "found"]),
        ("sensitivity", ["roughness.sigma", "A_t"]),
    ],
)
def test_notebooks_show_a_table(values, name, words):
    text = Text(values[name]._repr_html_())
    assert text.tags <= {"div", "strong", "table", "tr", "th", "td", "p"}
    for word in words:
        assert word in text.words


def test_notebooks_show_the_first_and_the_last_of_many_states():
    state = tb.solve(contact(), pressure=np.linspace(1e6, 2e6, 11))
    words = Text(state._repr_html_()).words
    assert {"1 MPa", "2 MPa", "…"} <= set(words)
    assert "1.5 MPa" not in words


def test_notebooks_show_bands():
    found = tb.propagate(
        contact(),
        vary={"roughness.sigma": (9e-8, 1.1e-7)},
        pressure=5e6,
        samples=64,
        outputs=["A_t"],
    )
    assert {"A_t", "5 %", "50 %", "95 %"} <= set(Text(found._repr_html_()).words)


def test_notebooks_show_the_page_of_an_assessment():
    found = tb.assess(contact(), vary={"roughness.sigma": (8e-8, 1.2e-7)}, pressure=5e6, samples=64)
    words = Text(found._repr_html_()).words
    assert found.headline() in words
    for part in found.sections():
        assert part.title in words
