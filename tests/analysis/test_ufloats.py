"""Numbers with an uncertainty in and out, with and without units; the package is never needed."""

import sys

import numpy as np
import pint
import pytest
from refusals import Mistake, refuses

import thirdbody as tb

uncertainties = pytest.importorskip("uncertainties", reason="pip install 'thirdbody[uncertainty]'")
ufloat = uncertainties.ufloat
UNIT = pint.get_application_registry()
STEEL = tb.materials["S45C"]
CONTACT = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    particles=tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e11,
        diameter=tb.distributions.Monodisperse(mean=3e-7),
    ),
)
SIGMA = ufloat(100e-9, 2e-9)
WAYS = {
    "plain": SIGMA,
    "pint": UNIT.Quantity(ufloat(100, 2), "nm"),
    "measurement": UNIT.Quantity(0.1, "um").plus_minus(0.002),
}


def bands(vary, **more):
    asked = {"pressure": 5e6, "samples": 256, "outputs": ["h", "A_t"]} | more
    return tb.propagate(CONTACT, vary=vary, **asked)


@pytest.mark.parametrize("way", WAYS)
def test_a_ufloat_is_a_normal_distribution(way):
    normal = bands({"roughness.sigma": tb.Uncertain.normal(mean=100e-9, std=2e-9)})
    found = bands({"roughness.sigma": WAYS[way]})
    for name, band in normal.bands.items():
        assert found.bands[name] == pytest.approx(band, rel=1e-12)


def test_bodies_that_move_together_and_the_load_may_be_ufloats():
    both = "surfaces.first.H+surfaces.second.H"
    given = {both: UNIT.Quantity(ufloat(STEEL.H / 1e9, 0.1), "GPa"),
             "pressure": UNIT.Quantity(ufloat(5, 0.1), "MPa")}  # fmt: skip
    plain = {both: tb.Uncertain.normal(mean=STEEL.H, std=1e8),
             "pressure": tb.Uncertain.normal(mean=5e6, std=1e5)}  # fmt: skip
    found, wanted = bands(given), bands(plain)
    assert found.bands["h"] == pytest.approx(wanted.bands["h"], rel=1e-9)


def test_a_field_says_where_its_uncertainty_goes():
    for given in WAYS.values():
        with refuses(Mistake.KIND, "Roughness.sigma"):
            tb.Roughness(sigma=given, R=2.8e-6)
    with refuses(Mistake.UNIT, "surfaces.first.H+surfaces.second.H"):
        bands({"surfaces.first.H+surfaces.second.H": WAYS["pint"]})


def test_what_is_no_independent_input_is_refused():
    with refuses(Mistake.CLASH, "vary['roughness.sigma']"):
        bands({"roughness.sigma": SIGMA, "roughness.R": 28 * SIGMA})
    with refuses(Mistake.RANGE, "vary['roughness.sigma']", says="std = 0"):
        bands({"roughness.sigma": ufloat(1e-7, 0)})
    with refuses(Mistake.KIND, "number", value="1e-07"):
        tb.Uncertain.from_ufloat(1e-7)


def test_small_uncertainties_are_linear():
    """By slopes and by samples: two ways to the same standard deviation."""
    slopes = tb.sensitivity(CONTACT, of=["h", "A_t"], to="roughness.sigma", pressure=5e6)
    linear = slopes.ufloats({"roughness.sigma": SIGMA})
    sampled = bands({"roughness.sigma": SIGMA}, samples=2**12)
    state = tb.solve(CONTACT, pressure=5e6)
    for name in ("h", "A_t"):
        told = sampled.ufloat(name)
        assert linear[name].nominal_value == pytest.approx(getattr(state, name), rel=1e-8)
        assert told.nominal_value == pytest.approx(getattr(state, name), rel=2e-3)
        assert told.std_dev == pytest.approx(linear[name].std_dev, rel=0.03)


def test_results_stay_correlated_with_their_inputs():
    """h over sigma hardly depends on sigma, which only what knows of the correlation says."""
    slopes = tb.sensitivity(CONTACT, of="h", to="roughness.sigma", pressure=5e6)
    h = slopes.ufloats({"roughness.sigma": WAYS["plain"]})["h"]
    shift = 1e-12
    more = CONTACT.replace(**{"roughness.sigma": 100e-9 + shift})
    less = CONTACT.replace(**{"roughness.sigma": 100e-9 - shift})
    ratio = [tb.solve(c, pressure=5e6).h / c.roughness.sigma for c in (less, more)]
    assert (h / SIGMA).std_dev == pytest.approx(
        abs(ratio[1] - ratio[0]) / (2 * shift) * SIGMA.std_dev, rel=1e-4
    )


def test_correlated_inputs_are_taken_to_first_order():
    slopes = tb.sensitivity(CONTACT, of="h", to=["roughness.sigma", "roughness.R"], pressure=5e6)
    both = {"roughness.sigma": SIGMA, "roughness.R": 28 * SIGMA}
    slope = [slopes.derivative["h"][name] for name in both]
    found = slopes.ufloats(both)["h"]
    assert found.std_dev == pytest.approx(abs(slope[0] + 28 * slope[1]) * SIGMA.std_dev)
    several = tb.sensitivity(CONTACT, of="h", to="roughness.sigma", pressure=[1e6, 5e6])
    told = several.ufloats({"roughness.sigma": SIGMA})["h"]
    assert [each.nominal_value for each in told] == several.value["h"].tolist()
    for vary, words in (
        ({"roughness.R": SIGMA}, "must be one of roughness.sigma"),
        ({"roughness.sigma": 1e-7}, "must be a ufloat"),
        ({"roughness.sigma": ufloat(2e-7, 1e-9)}, "which the slopes are taken at"),
    ):
        with pytest.raises(tb.errors.InvalidValue, match=words):
            several.ufloats(vary)


def test_bands_of_several_loads_and_of_other_quantiles():
    found = bands({"roughness.sigma": SIGMA}, pressure=[1e6, 5e6], quantiles=(0.1, 0.9))
    told = found.ufloat("h")
    assert len(told) == 2
    assert told[1].nominal_value == pytest.approx(np.mean(found.bands["h"][1]))
    with refuses(Mistake.OPTION, "of", value="'depth'"):
        found.ufloat("depth")


def test_without_the_package_it_is_said_in_one_line(monkeypatch):
    found = bands({"roughness.sigma": (99e-9, 101e-9)})
    monkeypatch.setitem(sys.modules, "uncertainties", None)
    with refuses(Mistake.ABSENT, "", says="'thirdbody[uncertainty]'"):
        found.ufloat("h")
