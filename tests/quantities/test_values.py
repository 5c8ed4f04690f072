"""What users build: frozen, checked once, comparable, with a JSON round trip."""

import contextlib
import dataclasses
import json
import math
import pickle
import subprocess
import sys
import warnings

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import Mistake, refuses, warns_of
from twins import decades, horng_twins, roughnesses, series_twins

import thirdbody as tb
from thirdbody.quantities.slips import SLIP
from thirdbody.quantities.value import problem_with, quantity

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
ROUGH = tb.Roughness(sigma=1e-7, R=2.8e-6)


def dust(**changes) -> tb.Particles:
    options = {
        "material": SILICA,
        "diameter": tb.TruncatedGaussian(mean=3e-7, std=2.4e-8),
        "areal_density": 1e11,
    }
    return tb.Particles(**(options | changes))


def contact(**changes) -> tb.Contact:
    options = {
        "surfaces": tb.MaterialPair(STEEL, STEEL),
        "roughness": tb.Roughness(sigma=1e-7, R=2.8e-6),
        "particles": dust(),
    }
    return tb.Contact(**(options | changes))


# ------------------------------------------------------------------------------ whole contacts
@given(twin=st.one_of(series_twins(), horng_twins()))
def test_json_round_trip(twin):
    text = json.dumps(twin.contact.to_dict(), allow_nan=False)
    again = tb.Contact.from_dict(json.loads(text))
    assert again == twin.contact
    assert hash(again) == hash(twin.contact)
    assert json.dumps(again.to_dict()) == text


@given(twin=st.one_of(series_twins(), horng_twins()))
def test_pickle_round_trip(twin):
    assert pickle.loads(pickle.dumps(twin.contact)) == twin.contact


def test_contact_is_frozen():
    with pytest.raises(AttributeError):
        contact().roughness = None
    with pytest.raises(AttributeError):
        contact().roughness.sigma = 1.0
    with pytest.raises((AttributeError, TypeError)):
        contact().anything = 1


def test_contact_takes_keywords_only():
    with pytest.raises(TypeError):
        tb.Contact(tb.MaterialPair(STEEL, STEEL), tb.Roughness(sigma=1e-7, R=2.8e-6))
    with pytest.raises(TypeError):
        tb.Roughness(1e-7, 2.8e-6)
    with pytest.raises(TypeError):
        tb.Contact(surfaces=tb.MaterialPair(STEEL, STEEL), rough=1)


def test_defaults():
    plain = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, SILICA), roughness=tb.Roughness(sigma=1e-7, R=2.8e-6)
    )
    assert plain.two_body
    assert plain.asperity_law == tb.asperity.ZMC(k=0.4, rho=54)
    assert contact().particle_law == tb.particle.Series()
    assert contact() == contact(particle_law=None)
    assert not contact().two_body
    series = tb.particle.Series()
    assert series.deep == "table"
    assert series.law == tb.asperity.Hermite()
    assert (series.seat, series.h_0, series.shadow) == ("rough", 0.0, "footprint")
    assert (series.zeta_mean, series.zeta_std) == (0.0, 1.0)
    assert tb.particle.Horng2022() == tb.particle.Horng2022(preset="published")


@given(first=st.sampled_from((STEEL, SILICA)), second=st.sampled_from((STEEL, SILICA)))
def test_modulus_of_a_contact(first, second):
    pair = tb.MaterialPair(first, second)
    bodies = [oracle.Body(m.E, m.nu, m.H) for m in (first, second)]
    assert contact(surfaces=pair).E_ss == pytest.approx(oracle.contact_modulus(*bodies), rel=1e-14)


# --------------------------------------------------------------------------------- replace
def test_replace_reaches_inside():
    changed = contact().replace(
        **{
            "roughness.sigma": 2e-7,
            "particles.diameter.mean": 5e-7,
            "particles.areal_density": 3e10,
            "surfaces.second.H": 1e9,
            "particle_law.seat": "plane",
        }
    )
    assert changed.roughness == tb.Roughness(sigma=2e-7, R=2.8e-6)
    assert changed.particles.diameter == tb.TruncatedGaussian(mean=5e-7, std=2.4e-8)
    assert changed.particles.areal_density == 3e10
    assert changed.surfaces.second.H == 1e9
    assert changed.surfaces.first == STEEL
    assert changed.particle_law.seat == "plane"
    assert contact().replace() == contact()


def test_replace_leaves_the_original_alone():
    one = contact()
    one.replace(**{"roughness.sigma": 2e-7})
    assert one == contact()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rough": 1}, ["rough", "roughness"]),
        ({"roughness.sigmma": 1e-7}, ["sigmma", "sigma"]),
        ({"particles.diameter.median": 1e-7}, ["median", "mean"]),
        ({"roughness.sigma": -1}, ["Roughness.sigma", "> 0"]),
        ({"roughness.sigma.x": 1}, ["sigma"]),
    ],
)
def test_replace_names_what_does_not_fit(change, words):
    with pytest.raises(tb.errors.InvalidValue) as caught:
        contact().replace(**change)
    for word in words:
        assert word in str(caught.value)


def test_replacing_the_particles_of_a_bare_contact():
    with pytest.raises(tb.errors.InvalidValue):
        contact(particles=None).replace(**{"particles.areal_density": 1e9})


# ------------------------------------------------------------------------------- roughness
@given(rough=roughnesses())
def test_roughness(rough):
    ours = tb.Roughness(
        sigma=rough.sigma, R=rough.R, alpha=rough.alpha, eta_R_sigma=rough.eta_R_sigma
    )
    assert ours.sigma_s == pytest.approx(rough.sigma_s, rel=1e-14)
    assert ours.y_s == pytest.approx(rough.y_s, rel=1e-14)
    assert ours.density == pytest.approx(rough.eta, rel=1e-14)
    by_density = tb.Roughness(sigma=rough.sigma, R=rough.R, alpha=rough.alpha, eta=rough.eta)
    assert by_density.density == pytest.approx(ours.density, rel=1e-14)


def test_mccool_surface():
    rough = tb.Roughness(sigma=1e-7, R=2.8e-6)
    assert rough.density * rough.R * rough.sigma == pytest.approx(0.0455)
    # Nayak: the same offset from the density of asperities, y_s = 0.045944/(ηRσ) σ
    assert rough.y_s == pytest.approx(0.045944 / 0.0455 * rough.sigma, rel=1e-3)
    # and σ_s² = σ² − 3.717e-4/(ηR)²
    exact = rough.sigma**2 - 3.717e-4 / (rough.density * rough.R) ** 2
    assert rough.sigma_s == pytest.approx(math.sqrt(exact), rel=1e-3)


# ------------------------------------------------------------------------------ particles
@given(coverage=decades(1e-8, 0.99), x=decades(1e-9, 1e-3))
def test_coverage(coverage, x):
    population = dust(
        diameter=tb.distributions.Monodisperse(mean=x),
        areal_density=coverage / (math.pi / 4 * x**2),
    )
    assert population.coverage == pytest.approx(coverage, rel=1e-12)


def test_jammed_particles_are_refused():
    with pytest.raises(tb.errors.InvalidValue, match="jammed"):
        dust(areal_density=1.5e13)


def test_dense_particles_warn():
    crowded = contact(particles=dust(areal_density=6e12))
    assert crowded.particles.coverage > 0.3
    with pytest.warns(tb.errors.RangeWarning):
        state = tb.solve(crowded, F_star=1e-6)
    assert state.warnings


def test_large_contact_area_warns():
    with pytest.warns(tb.errors.RangeWarning):
        state = tb.solve(contact(particles=None), d=-3e-7)
    assert state.A_t > 0.2
    assert state.warnings


def test_ordinary_states_do_not_warn(recwarn):
    law = tb.particle.Series(deep="off")  # the table says how far it is held
    state = tb.solve(contact(particle_law=law), F_star=1e-5)
    assert state.warnings == ()
    assert not [w for w in recwarn if issubclass(w.category, tb.errors.RangeWarning)]


# ----------------------------------------------------------------------------- bad values
@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: tb.Material(E=-1, nu=0.3, H=1e9), ["Material.E = -1", "> 0 [Pa]", "minus sign"]),
        (lambda: tb.Material(E=1e9, nu=0.6, H=1e9), ["Material.nu = 0.6", "<= 0.5"]),
        (lambda: tb.Material(E=1e9, nu=-1, H=1e9), ["nu", "> -1"]),
        (lambda: tb.Material(E=1e9, nu=0.3, H=0), ["Material.H"]),
        (lambda: tb.Material(E="205 GPa", nu=0.3, H=1e9), ["Material.E", "SI units [Pa]", "str"]),
        (lambda: tb.Material(E=None, nu=0.3, H=1e9), ["Material.E"]),
        (lambda: tb.Material(E=True, nu=0.3, H=1e9), ["Material.E"]),
        (lambda: tb.Material(E=math.inf, nu=0.3, H=1e9), ["Material.E = inf"]),
        (lambda: tb.Material(E=np.array([1.0, 2.0]), nu=0.3, H=1e9), ["Material.E"]),
        (lambda: tb.MaterialPair(STEEL, "steel"), ["MaterialPair.second", "materials["]),
        (lambda: tb.Roughness(sigma=0, R=1e-6), ["Roughness.sigma = 0", "> 0 [m]"]),
        (lambda: tb.Roughness(sigma=1e-7, R=math.nan), ["Roughness.R = nan"]),
        (lambda: tb.Roughness(sigma=1e-7, R=1e-6, alpha=1.5), ["alpha", "> 1.5"]),
        (
            lambda: tb.Roughness(sigma=1e-7, R=1e-6, eta=1e11, eta_R_sigma=0.05),
            ["eta", "eta_R_sigma"],
        ),
        (lambda: dust(areal_density=-1.0), ["areal_density", ">= 0"]),
        (lambda: dust(material="SiO2"), ["Particles.material"]),
        (lambda: dust(diameter=3e-7), ["Particles.diameter"]),
        (
            lambda: tb.particle.Series(deep="off", seat="floor"),
            ["seat", "'rough'", "'plane'", "'offset'"],
        ),
        (lambda: tb.particle.Series(deep="off", shadow="half"), ["shadow", "'footprint'"]),
        (lambda: tb.particle.Series(deep="off", h_0=1e-7), ["h_0", "offset"]),
        (lambda: tb.particle.Series(deep="off", seat="plane", zeta_mean=1.0), ["zeta_mean"]),
        (lambda: tb.particle.Series(deep="off", zeta_std=0.0), ["zeta_std"]),
        (lambda: tb.particle.Series(deep="off", law="hertz"), ["Series.law"]),
        (lambda: tb.particle.Horng2022(preset="best"), ["preset", "published", "window"]),
        (lambda: tb.particle.Horng2022(weight="x3"), ["weight", "x2"]),
        (lambda: tb.particle.Horng2022(kappa_C=0), ["kappa_C"]),
        (lambda: tb.particle.Horng2022(hardness_rule="mean"), ["hardness_rule", "sum"]),
        (lambda: tb.particle.Horng2022(chi=-0.1), ["chi"]),
        (lambda: contact(surfaces=STEEL), ["Contact.surfaces"]),
        (lambda: contact(roughness=1e-7), ["Contact.roughness"]),
        (lambda: contact(particles=SILICA), ["Contact.particles"]),
        (lambda: contact(asperity_law="zmc"), ["Contact.asperity_law"]),
        (lambda: contact(particle_law=tb.asperity.ZMC()), ["Contact.particle_law"]),
    ],
)
def test_mistakes_are_named(make, words):
    with pytest.raises(tb.errors.InvalidValue) as caught:
        make()
    for word in words:
        assert word in str(caught.value)


def test_all_mistakes_at_once():
    with pytest.raises(tb.errors.InvalidValue) as caught:
        tb.Material(E=-1, nu=2, H=math.nan)
    assert len(caught.value.problems) == 3
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, tb.errors.ThirdBodyError)


@pytest.mark.parametrize("bad", [{"type": "Nothing"}, {}, {"type": "Material"}])
def test_json_of_something_else(bad):
    with pytest.raises((tb.errors.InvalidValue, TypeError)):
        tb.Contact.from_dict(bad)


def test_presets():
    """The published readings, by their numbers."""
    rows = {
        "published": ("sum", 1, 3.11, 1, 0.00738, True),
        "window": ("surface", 1, 3.25, 1, 1 / 16, False),
        "all_terms": ("surface", 1, 3.15, 1, 0.0185, True),
        "window_E2": ("surface", 1, 2.39, 2, 1.0, False),
        "literal": ("surface", 1, None, 1, 1.0, True),
    }
    assert set(tb.particle.PRESETS) == set(rows)
    for name, (rule, datum, h_e, kappa, chi, plastic) in rows.items():
        law = tb.particle.Horng2022(preset=name)
        got = (law.hardness_rule, law.datum, law.kappa_C, law.chi, law.plastic, law.normalise)
        assert got == (rule, datum, kappa, pytest.approx(chi), plastic, False), name
        assert (law.h_e_rule == "approach") == (h_e is None)
        if h_e is not None:
            assert law.h_e_sigma == h_e
    changed = tb.particle.Horng2022(preset="window", chi=0.5)
    assert (changed.chi, changed.h_e_sigma) == (0.5, 3.25)


def test_numbers_become_floats():
    rough = tb.Roughness(sigma=np.float32(1), R=np.int64(2))
    assert type(rough.sigma) is float
    assert type(rough.R) is float


@pytest.mark.parametrize(
    "value",
    [
        STEEL,
        tb.Roughness(sigma=1e-7, R=1e-6),
        dust(),
        tb.particle.Series(deep="off"),
        tb.particle.Horng2022(),
        tb.asperity.ZMC(),
        contact(),
    ],
    ids=lambda v: type(v).__name__,
)
def test_every_field_is_documented(value):
    """Quantities carry symbol, unit and meaning beside the field, for messages and docs alike."""
    assert dataclasses.is_dataclass(value)
    for item in dataclasses.fields(value):
        if isinstance(getattr(value, item.name), float):
            about = item.metadata["quantity"]
            assert about["symbol"]
            assert about["unit"]
            assert about["meaning"]


# -------------------------------------------------------------------------- likely slips
@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: dust(diameter=tb.distributions.Monodisperse(mean=200), areal_density=1e-6),
            ["diameter.mean = 200 ", "200 m", "was 200 nm"],
        ),
        (lambda: tb.Roughness(sigma=1e-7, R=2.8), ["R = 2.8 ", "was 2.8 um"]),
        (lambda: STEEL.replace(E=205), ["E = 205 ", "205 Pa", "was 205 GPa"]),
    ],
)
def test_a_forgotten_unit_is_told_of(make, words):
    with pytest.warns(tb.errors.RangeWarning) as heard:
        make()
    (one,) = heard
    assert one.filename == __file__
    for word in words:
        assert word in str(one.message)


def test_a_forgotten_unit_of_a_varied_input_is_told_of():
    with pytest.warns(tb.errors.RangeWarning, match=r"roughness\.R = 3 .*was 3 um"):
        tb.equilibria.solve_states(contact(), pressure=5e6, vary={"roughness.R": [2e-6, 3.0]})


def test_usual_numbers_are_no_slip():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rubber = tb.Material(E=2e6, nu=0.49, H=1e6)
        friction = tb.outputs.Friction(tau_ss=0, tau_sa=0)
        contact(surfaces=tb.MaterialPair(rubber, rubber), outputs=friction)
        tb.distributions.Monodisperse(mean=1.0)  # sizes over their mean


def test_a_study_file_tells_of_a_slip_once(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        '[surfaces]\nfirst = "S45C"\nsecond = "S45C"\n'
        '[roughness]\nsigma = "100 nm"\nR = 2.8\n[load]\npressure = "5 MPa"\n'
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(tb.errors.InvalidValue) as told:
            tb.load_study(file)
    (problem,) = told.value.problems
    assert 'was "2.8 um" meant?' in problem
    with warns_of("unit of R", says=" 2.8 um ") as heard:
        contact(roughness=tb.Roughness(sigma=1e-7, R=2.8))
    assert len(heard) == 1


NUMBERS = {"E": 205e9, "nu": 0.3, "H": 2e9}
SLIPS = [
    ("roughness.sigma", 100, "sigma", lambda x: tb.Roughness(sigma=x, R=2.8e-6)),
    ("surfaces.first.E", 205, "E", lambda x: tb.Material(**NUMBERS | {"E": x})),
    ("surfaces.first.density", 7.8, "density", lambda x: tb.Material(**NUMBERS, density=x)),
    ("load.pressure", 5, "pressure", lambda x: tb.solve(contact(), pressure=x)),
    ("load.separation", 200, "d", lambda x: tb.solve(contact(), d=x)),
    ("particles.mean", 3, "diameter.mean",
     lambda x: dust(diameter=tb.distributions.Monodisperse(mean=x), areal_density=1e-3)),
]  # fmt: skip
"""A number without its unit: its key in a study, its name in Python, and who takes it there."""


@pytest.mark.parametrize(("key", "number", "name", "make"), SLIPS, ids=[row[0] for row in SLIPS])
def test_python_doubts_the_numbers_that_a_study_refuses(key, number, name, make, tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        "[surfaces]\nfirst = { E = 205e9, nu = 0.3, H = 2e9 }\nsecond = 'S45C'\n"
        "[roughness]\nsigma = '100 nm'\nR = '2.8 um'\n[load]\npressure = '5 MPa'\n"
        "[particles]\nmaterial = 'SiO2'\nareal_density = 1e9\n"
        "distribution = 'monodisperse'\nmean = '3 um'\n"
    )
    with refuses(Mistake.UNIT, key):
        tb.load_study(file, [f"{key}={number}"])
    with warns_of(f"unit of {name}", effect=math.inf), contextlib.suppress(tb.errors.NoEquilibrium):
        make(number)


def test_a_load_is_told_of_once_and_by_the_function_that_is_called():
    loads = {"pressure": [5.0, 20.0]}
    doors = [
        lambda: tb.sweep(contact(), **loads),
        lambda: tb.equilibria.solve_states(contact(), **loads),
        lambda: tb.compare(contact(), **loads),
    ]
    for door in doors:
        with warns_of("unit of pressure") as heard:
            door()
        codes = [getattr(each.message.args[0], "code", "") for each in heard]
        assert codes.count(f"{SLIP}pressure") == 1
        assert heard[codes.index(f"{SLIP}pressure")].filename == __file__
    with warnings.catch_warnings():
        warnings.filterwarnings("error", "pressure")
        tb.solve(contact(), pressure=np.geomspace(1.0, 1e6, 4))  # a range that begins low


def test_what_a_study_says_of_a_load_is_not_said_again(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        "[surfaces]\nfirst = 'S45C'\nsecond = 'S45C'\n"
        "[roughness]\nsigma = '100 nm'\nR = '2.8 um'\n[load]\npressure = '50 Pa'\n"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study = tb.load_study(file)
        study.solve()
    assert [each.code for each in study.notes] == [f"{SLIP}load.pressure"]


# ------------------------------------------------------------------------------ names
def test_every_name_is_listed():
    script = "import thirdbody as tb; print(*dir(tb))"
    listed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout
    names = listed.split()
    assert set(tb.__all__) <= set(names)
    assert all(hasattr(tb, name) for name in names)
    assert names == dir(tb)  # the same after names were used
    assert [name for name in names if name.startswith("_") and not name.startswith("__")] == []


def test_notebooks_offer_the_names_of_materials():
    assert tb.materials._ipython_key_completions_() == list(tb.materials)


def test_a_study_is_a_contact_and_loads(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        'title = "two"\n[surfaces]\nfirst = "S45C"\nsecond = "S45C"\n'
        '[roughness]\nsigma = "100 nm"\nR = "2.8 um"\n[load]\npressure = ["1 MPa", "5 MPa"]\n'
    )
    study = tb.load_study(file)
    assert study.contact == contact(particles=None)
    assert (study.title, study.load, study.values.tolist()) == ("two", "pressure", [1e6, 5e6])
    assert study.solve().d.tolist() == tb.solve(study.contact, pressure=[1e6, 5e6]).d.tolist()
    with pytest.raises(tb.errors.InvalidValue, match=r"roughness\.sigma"):
        tb.load_study(file, ["roughness.sigma=-1"])


def test_a_copy_tells_only_of_slips_that_are_new():
    """A slip is told where it is made, not again by whoever changes something else."""
    steel = tb.materials["S45C"]
    contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), roughness=ROUGH)
    with warns_of("unit of roughness.R", says=" 0.02 m:"):
        contact = contact.replace(**{"roughness.R": 0.02})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact.replace(outputs=())
        contact.replace(**{"roughness.sigma": 2e-7})
    with pytest.warns(tb.errors.RangeWarning, match=r"roughness\.sigma = 0\.03") as heard:
        contact.replace(**{"roughness.sigma": 0.03})
    assert len(heard) == 1
    with warns_of("unit of sigma") as heard:
        contact.replace(roughness=tb.Roughness(sigma=0.03, R=2e-6))
    assert len(heard) == 1


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (-1e3, "leave out the minus sign"),
        (0.0, ""),
        (math.nan, "it is not a number, like 0/0 or a missing value"),
        (1e12, "kN are '5 kN'"),
    ],
)
def test_a_hint_fits_the_sign_of_a_number(value, hint):
    """A unit is the likely cause only of a number whose sign is right."""
    force = quantity("F", "N", "force", gt=0, lt=1e9, hint="kN are '5 kN'").metadata["quantity"]
    said = problem_with(force, value)
    assert said == "must be > 0 and < 1e+09 [N]" + f"; {hint}" * bool(hint)
    signed = quantity("F", "N", "force", gt=-10, hint="kN are '5 kN'").metadata["quantity"]
    assert problem_with(signed, -20.0).endswith("kN are '5 kN'")


# ------------------------------------------------------------------------------ arguments
MISSPELT = [
    (lambda: dust(diametre=1e-7), "Particles.diametre", "diameter"),
    (lambda: contact(surface=1), "Contact.surface", "surfaces"),
    (lambda: tb.Roughness(sigm=1e-7, R=2.8e-6), "Roughness.sigm", "sigma"),
    (lambda: tb.films.Oil(eta=0.04, alfa=2e-8), "Oil.alfa", "alpha"),
    (lambda: tb.asperity.ZMC(K=0.4), "ZMC.K", "k"),
    (lambda: tb.outputs.Friction(tau=1e6), "Friction.tau", None),
    (lambda: tb.surfaces.Topography(height=np.zeros((4, 4))), "Topography.height", "heights"),
    (lambda: tb.Uncertain(knd="normal"), "Uncertain.knd", "kind"),
]
"""Calls with a misspelt argument, its place, and the argument that was meant."""


@pytest.mark.parametrize(("make", "place", "meant"), MISSPELT, ids=[row[1] for row in MISSPELT])
def test_a_misspelt_argument_of_a_class_is_told_as_one_of_a_function(make, place, meant):
    with refuses(Mistake.UNKNOWN, place, meant=meant) as told:
        make()
    assert isinstance(told.value, TypeError)


def test_a_class_of_ones_own_may_take_any_argument_and_one_without_any_takes_none():
    class Free(tb.asperity.GW):
        def __init__(self, **options):
            object.__setattr__(self, "options", options)

        __slots__ = ("options",)

    assert Free(anything=3).options == {"anything": 3}
    with pytest.raises(TypeError):
        tb.outputs.AbstractOutput(anything=3)


# ------------------------------------------------------------------------------ oils
def test_a_viscosity_that_no_oil_has_is_told_once():
    with warns_of("unit of eta", effect=math.inf, says="60 mPa s") as told:
        oil = tb.films.Oil(eta=60, alpha=2e-8)
        oil.replace(alpha=1.5e-8)
    assert len(told) == 1


def test_usual_oils_are_told_of_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tb.films.Oil(eta=0.06, alpha=2e-8, eyring_stress=5e6).replace(eta=9.9)
