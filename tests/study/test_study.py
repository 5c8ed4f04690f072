"""Study files: what is read, and what a user is told about each kind of mistake."""

import copy
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.quantities.value import Value, choice, quantity
from thirdbody.study import DISTRIBUTIONS, HEIGHTS, LOADS, check, load_study, run_study, whole
from thirdbody.study.reader import Table, table_of

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))

GOOD = """
title = "Dust"
[surfaces]
first = "S45C"
second = { E = "205 GPa", nu = 0.29, H = "5 GPa" }
[roughness]
sigma = "100 nm"
R = "2.8 um"
alpha = 5.0
eta_R_sigma = 0.0455
[asperity_law]
name = "zmc"
k = 0.4
[particles]
material = "SiO2"
distribution = "truncated-gaussian"
mean = "300 nm"
std = "24 nm"
n = 3
areal_density = "1e11 / m^2"
[particle_law]
name = "series"
seat = "rough"
[load]
F_star = { from = 5e-7, to = 2.4e-4, points = 5, spacing = "log" }
"""


@pytest.fixture
def write(tmp_path):
    """A study file with parts of the good one replaced."""

    def write(*changes, text=GOOD):
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def problems(write):
    """What is said about a study file that is wrong."""

    def problems(*changes, text=GOOD, overrides=()):
        with pytest.raises(tb.errors.InvalidValue) as caught:
            load_study(write(*changes, text=text), overrides)
        for problem in caught.value.problems:
            assert "\n" not in problem
        assert len(set(caught.value.problems)) == len(caught.value.problems)
        return list(caught.value.problems)

    return problems


def only(found, *words):
    """There is one problem and it holds these words."""
    assert len(found) == 1, found
    for word in words:
        assert word in found[0], (word, found[0])


# ---------------------------------------------------------------------------- what is read
def test_reads_the_documented_file(write):
    study = load_study(write())
    steel = tb.materials["S45C"]
    assert study.title == "Dust"
    assert study.notes == ()
    assert study.load == "F_star"
    assert np.array_equal(study.values, np.geomspace(5e-7, 2.4e-4, 5))
    assert study.contact == tb.Contact(
        surfaces=tb.MaterialPair(steel, tb.Material(E=205e9, nu=0.29, H=5e9)),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0, eta_R_sigma=0.0455),
        asperity_law=tb.asperity.ZMC(k=0.4),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9, n=3),
            areal_density=1e11,
        ),
        particle_law=tb.particle.Series(seat="rough"),
    )


def test_tables_that_may_be_left_out(write):
    text = re.sub(r"\[(asperity_law|particles|particle_law)\][^[]*", "", GOOD)
    text = text.replace('title = "Dust"', "").replace("eta_R_sigma = 0.0455", "")
    contact = load_study(write(text=text)).contact
    assert contact.particles is None
    assert contact.two_body
    assert contact.asperity_law == tb.asperity.ZMC()
    assert contact.roughness == tb.Roughness(sigma=100e-9, R=2.8e-6)


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        (
            'distribution = "log-normal"\nmedian = "50 nm"\ngsd = 1.3',
            tb.LogNormal(median=50e-9, gsd=1.3),
        ),
        (
            'distribution = "weibull"\nscale = "1 um"\nshape = 2',
            tb.distributions.Weibull(scale=1e-6, shape=2),
        ),
        (
            'distribution = "uniform"\nlow = 0\nhigh = "1 um"',
            tb.distributions.Uniform(low=0, high=1e-6),
        ),
        ('distribution = "monodisperse"\nmean = 1e-7', tb.distributions.Monodisperse(mean=1e-7)),
        (
            'distribution = "histogram"\nedges = [0, "0.1 um", 3e-7]\ncounts = [1, 2]',
            tb.distributions.Histogram(edges=(0, 1e-7, 3e-7), counts=(1, 2)),
        ),
        (
            'distribution = "mixture"\nweights = [3, 1]\nparts = ['
            '{ distribution = "monodisperse", mean = "100 nm" },'
            '{ distribution = "uniform", low = "1 nm", high = "9 nm" }]',
            tb.distributions.Mixture(
                parts=(
                    tb.distributions.Monodisperse(mean=1e-7),
                    tb.distributions.Uniform(low=1e-9, high=9e-9),
                ),
                weights=(3, 1),
            ),
        ),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, str) else "",
)
def test_every_distribution(write, keys, expected):
    old = GOOD[GOOD.index("distribution") : GOOD.index("areal_density")]
    assert load_study(write((old, keys + "\n"))).contact.particles.diameter == expected


def test_every_distribution_of_the_library_has_a_word():
    words = {
        kind.__name__ for kind in DISTRIBUTIONS.values() if kind.__module__.startswith("thirdbody.")
    }
    assert {*tb.distributions.__all__} - {"Distribution"} == words


@pytest.mark.parametrize("kind", [tb.asperity, tb.particle], ids=["asperity", "particle"])
def test_every_registered_law_can_be_named(write, kind):
    table = "asperity_law" if kind is tb.asperity else "particle_law"
    old = re.search(rf"\[{table}\][^[]*", GOOD)[0]
    for name, law in kind.REGISTRY.items():
        study = load_study(write((old, f'[{table}]\nname = "{name}"\n')))
        assert getattr(study.contact, table) == law()


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ('"gaussian"', tb.heights.GaussianHeights()),
        ('"exponential"', tb.heights.ExponentialHeights()),
        ('"johnson"', tb.heights.JohnsonHeights()),
        ('{ name = "exponential" }', tb.heights.ExponentialHeights()),
        ('{ name = "weibull", shape = 1.8 }', tb.heights.WeibullHeights(shape=1.8)),
        (
            '{ name = "johnson", skewness = -0.7, kurtosis = 4.2 }',
            tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
        ),
        (
            '{ name = "histogram", edges = [0, "100 nm", 3e-7], counts = [1, 2] }',
            tb.heights.HistogramHeights(edges=(0, 1e-7, 3e-7), counts=(1, 2)),
        ),
        (
            '{ name = "histogram", edges = [-2, 0, 250], counts = [1, 2] }',  # in any unit
            tb.heights.HistogramHeights(edges=(-2, 0, 250), counts=(1, 2)),
        ),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, str) else "",
)
def test_every_distribution_of_heights(write, keys, expected):
    contact = load_study(write(("alpha = 5.0", f"heights = {keys}"))).contact
    assert contact.roughness.heights == expected
    assert tb.Contact.from_dict(contact.to_dict()) == contact
    assert tb.solve(contact, F_star=1e-5).status == "ok"


def test_every_kind_of_heights_of_the_library_has_a_word():
    public = {getattr(tb.heights, name) for name in tb.heights.__all__}
    kinds = {kind for kind in HEIGHTS.values() if kind.__module__.startswith("thirdbody.")}
    assert public - {tb.heights.Heights} == kinds


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("3", ["roughness.heights = 3", '"exponential"', '"histogram"']),
        ('"gausian"', ['did you mean "gaussian"?']),
        ('"normal"', ['did you mean "gaussian"?']),
        ('"weibull"', ['heights = "weibull" is missing shape', '{ name = "weibull", shape = ']),
        ('"histogram"', ["missing edges, counts"]),
        ("{ skewness = 1 }", ["roughness.heights.name is missing", '"johnson"']),
        ('{ name = "weibull" }', ["roughness.heights.shape is missing", "shape = 2.0"]),
        ('{ name = "weibull", shape = 0.5 }', ["roughness.heights.shape = 0.5", ">= 1"]),
        ('{ name = "weibull", shape = "2 m" }', ["roughness.heights.shape", "is a length"]),
        ('{ name = "weibull", shpe = 2 }', ["roughness.heights.shpe = 2", "mean shape?"]),
        ('{ name = "gaussian", shape = 2 }', ["shape = 2", 'goes with name = "weibull"']),
        ('{ name = "johnson", kurtosis = 0 }', ["roughness.heights.kurtosis = 0", "has 3, not 0"]),
        (
            '{ name = "johnson", skewness = 2, kurtosis = 5.0001 }',
            ["roughness.heights: no member", "skewness 2"],
        ),
        ('{ name = "johnson", skewness = nan }', ["roughness.heights.skewness = nan"]),
        ('{ name = "histogram", edges = [2, 1], counts = [1] }', ["heights.edges", "increase"]),
        ('{ name = "histogram", edges = [1, 2], counts = [1, 1] }', ["2 edges and 2 counts"]),
        ('{ name = "histogram", edges = [1, 2], counts = ["1 m"] }', ["heights.counts[0]"]),
        ('{ name = "histogram", edges = 3, counts = [1] }', ["heights.edges = 3", "a list"]),
    ],
)
def test_mistakes_in_heights(problems, keys, words):
    found = problems(("alpha = 5.0", f"heights = {keys}"))
    only(found, *words)
    assert "Heights" not in found[0]


def test_heights_of_a_kind_can_be_set(write):
    study = load_study(write(), ["roughness.heights=exponential"])
    assert study.contact.roughness.heights == tb.heights.ExponentialHeights()
    study = load_study(write(), ['roughness.heights={ name = "weibull", shape = 2 }'])
    assert study.contact.roughness.heights == tb.heights.WeibullHeights(shape=2)


@pytest.mark.parametrize(
    ("table", "law"),
    [
        ('name = "jkr"\nw = "50 mJ/m^2"\nunloading = true', tb.asperity.JKR(unloading=True)),
        ('name = "dmt"\nw = 0.03', tb.asperity.DMT(w=0.03)),
        ('name = "jg"\nhardness_ratio = 3\nnu = 0.3', tb.asperity.JG(hardness_ratio=3, nu=0.3)),
        ('name = "ke"\nK = 0.6', tb.asperity.KE(K=0.6)),
        ('name = "ceb"\nK = 0.6', tb.asperity.CEB(K=0.6)),
        (
            'name = "elliptic-ceb"\nratio = 4\narea_rule = "doubling"',
            tb.asperity.EllipticCEB(ratio=4, area_rule="doubling"),
        ),
        ('name = "elliptic-zmc"\nratio = 4', tb.asperity.EllipticZMC(ratio=4)),
    ],
)
def test_options_of_asperity_laws(write, table, law):
    contact = load_study(write(('name = "zmc"\nk = 0.4', table))).contact
    assert contact.asperity_law == law
    assert tb.solve(contact, F_star=1e-5).status == "ok"


@pytest.mark.parametrize(
    ("law", "key"), [("jkr", "scale"), ("dmt", "scale"), ("jg", "yield_strain")]
)
def test_what_a_contact_fills_in_is_not_a_key(problems, law, key):
    found = problems(('name = "zmc"\nk = 0.4', f'name = "{law}"\n{key} = 0.1'))
    only(found, f"asperity_law.{key} = 0.1 is not a known key")


def test_options_of_laws(write):
    law = 'name = "series"\nseat = "offset"\nh_0 = "250 nm"\nshadow = "none"\n'
    law += 'law = { name = "zmc", k = 0.5 }'
    study = load_study(write(('name = "series"\nseat = "rough"', law)))
    assert study.contact.particle_law == tb.particle.Series(
        law=tb.asperity.ZMC(k=0.5), seat="offset", h_0=250e-9, shadow="none"
    )
    law = 'name = "horng2022"\npreset = "window"\nplastic = true\nchi = 0.5'
    study = load_study(write(('name = "series"\nseat = "rough"', law)))
    assert study.contact.particle_law == tb.particle.Horng2022(
        preset="window", plastic=True, chi=0.5
    )


@pytest.mark.parametrize(
    ("load", "name", "values"),
    [
        ('pressure = "5 MPa"', "pressure", [5e6]),
        ("pressure = [1e6, '2 MPa']", "pressure", [1e6, 2e6]),
        ("F_star = 1e-5", "F_star", [1e-5]),
        ("separation = [-1e-8, '50 nm']", "separation", [-1e-8, 5e-8]),
        ("separation = { from = 0, to = '4 nm', points = 3 }", "separation", [0, 2e-9, 4e-9]),
        ("F_star = { from = 1e-6, to = 1e-4, points = 3 }", "F_star", [1e-6, 1e-5, 1e-4]),
        (
            "pressure = { from = '1 MPa', to = '3 MPa', points = 3, spacing = 'linear' }",
            "pressure",
            [1e6, 2e6, 3e6],
        ),
    ],
)
def test_loads(write, load, name, values):
    text = GOOD[: GOOD.index("[load]")] + f"[load]\n{load}\n"
    study = load_study(write(text=text))
    assert study.load == name
    assert study.values == pytest.approx(values, rel=1e-14)


# ---------------------------------------------------------------------------- mistakes
def test_wrong_dimension(problems):
    found = problems(('sigma = "100 nm"', 'sigma = "300 GPa"'))
    only(found, 'roughness.sigma = "300 GPa"', "is a pressure", "a length [m]", '"100 nm"')


def test_wrong_dimension_of_a_load(problems):
    text = GOOD[: GOOD.index("[load]")] + '[load]\nF_star = "5 MPa"\n'
    only(problems(text=text), 'load.F_star = "5 MPa"', "pure number", "key pressure")


@pytest.mark.parametrize("value", ["0", "-0.5", '"-100 nm"', '"0 nm"'])
def test_negative_and_zero_lengths(problems, value):
    found = problems(('sigma = "100 nm"', f"sigma = {value}"))
    likely = (
        "minus sign" if "-" in value else "it is the RMS roughness of equivalent surface heights"
    )
    only(found, f"roughness.sigma = {value} must be > 0 [m]", likely)


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", '"nan"', '"inf nm"'])
def test_not_finite(problems, value):
    found = problems(('R = "2.8 um"', f"R = {value}"))
    only(found, f"roughness.R = {value} is not a finite number; it must be > 0 [m]")


@pytest.mark.parametrize("value", ["-1", "-1.5", "0.51", "29"])
def test_poisson_ratio(problems, value):
    found = problems(("nu = 0.29", f"nu = {value}"))
    only(found, f"surfaces.second.nu = {value} must be > -1 and <= 0.5", "Poisson ratio")


@pytest.mark.parametrize("value", ["0.5", "-0.99"])
def test_poisson_ratio_at_its_ends(write, value):
    study = load_study(write(("nu = 0.29", f"nu = {value}")))
    assert study.contact.surfaces.second.nu == float(value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("\nsigma =", "\nsgima =", ["roughness.sgima", '"100 nm"', "did you mean sigma?"]),
        ("mean =", "diameter =", ["particles.diameter", "did you mean mean?"]),
        ("areal_density =", "eta_a =", ["particles.eta_a", "areal_density"]),
        ("H = ", "hardness = ", ["surfaces.second.hardness", "did you mean H?"]),
        ("k = 0.4", "seat = 1", ["asperity_law.seat = 1", "belongs to [particle_law]"]),
        ("n = 3", "median = 3", ["particles.median", 'goes with distribution = "log-normal"']),
        ("n = 3", "qqq = 3", ["particles.qqq = 3", "known here", "distribution", "areal_density"]),
        ("[load]", "[laod]", ["[laod]", "did you mean [load]?"]),
        ("[load]", "[gearbox]\nteeth = 12\n[load]", ["[gearbox]", "not a known table", "load"]),
        ("points =", "point =", ["load.F_star.point", "did you mean points?"]),
        ('title = "Dust"', "k = 3", ["k = 3", "belongs to [asperity_law]"]),
    ],
)
def test_unknown_keys(problems, old, new, words):
    found = [item for item in problems((old, new)) if "is missing" not in item]
    only(found, "not a known", *words)


def test_unknown_key_that_is_meant_for_a_missing_one_is_told_once(problems):
    assert len(problems(("\nsigma =", "\nsgima ="), ("mean =", "mena ="))) == 2


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (
            'sigma = "100 nm"\n',
            ["roughness.sigma is missing", "surface heights", "[m]", '"100 nm"'],
        ),
        ('first = "S45C"\n', ["surfaces.first is missing", "a material", '"S45C"']),
        ('material = "SiO2"\n', ["particles.material is missing", "SiO2"]),
        ('areal_density = "1e11 / m^2"\n', ["particles.areal_density is missing", '"1e11 / m^2"']),
        ('std = "24 nm"\n', ["particles.std is missing", "standard deviation"]),
        ('distribution = "truncated-gaussian"\n', ["particles.distribution is missing", "weibull"]),
        ('name = "series"\n', ["particle_law.name is missing", '"series"', '"horng2022"']),
        ("points = 5, ", ["load.F_star.points is missing", "how many"]),
        (", nu = 0.29", ["surfaces.second.nu is missing", "Poisson"]),
    ],
)
def test_missing_keys(problems, line, words):
    only(problems((line, "")), *words)


def test_an_empty_file_misses_three_tables(problems):
    found = problems(text="")
    assert [item.split()[0] for item in found] == ["surfaces", "roughness", "load"]
    assert all("is missing" in item for item in found)


def test_what_a_file_cannot_express_is_not_a_key(problems):
    found = problems(("n = 3", 'diameter = "1 nm"'))
    only(found, "particles.diameter", "did you mean mean?")


def test_unknown_material(problems):
    found = problems(('first = "S45C"', 'first = "S45"'))
    only(found, 'surfaces.first = "S45"', "S45C, SiO2", 'did you mean "S45C"?', "E = ")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('name = "zmc"', 'name = "zmcc"', ["asperity_law.name", '"hermite"', 'mean "zmc"?']),
        ('name = "series"', 'name = "serial"', ["particle_law.name", 'mean "series"?']),
        ('seat = "rough"', 'seat = "Rough"', ["particle_law.seat", '"plane"', 'mean "rough"?']),
        ('"truncated-gaussian"', '"gausian"', ["particles.distribution", '"log-normal"']),
        ('"log"', '"logarithmic"', ["load.F_star.spacing", '"linear"']),
        ('"truncated-gaussian"', '"normal"', ['mean "truncated-gaussian"?']),
        ("k = 0.4", "k = 1.2", ["asperity_law.k = 1.2", "> 0 and < 1"]),
        ("alpha = 5.0", "alpha = 1.5", ["roughness.alpha = 1.5", "> 1.5"]),
    ],
)
def test_words_and_ranges_of_options(problems, old, new, words):
    only(problems((old, new)), *words)


def test_misspelt_word_does_not_hide_other_mistakes(problems):
    found = problems(('"truncated-gaussian"', '"truncated"'), ('"24 nm"', "-1"))
    assert [item.split(" = ")[0] for item in found] == ["particles.distribution", "particles.std"]
    found = problems(('distribution = "truncated-gaussian"', ""), ('"24 nm"', "-1"))
    assert len(found) == 2


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("{ from = 1e-5, to = 1e-4, points = 0 }", ["points = 0", "whole number from 1"]),
        ("{ from = 1e-5, to = 1e-4, points = -3 }", ["points = -3", "whole number from 1"]),
        ("{ from = 1e-5, to = 1e-4, points = 2.5 }", ["points = 2.5", "whole number"]),
        ("{ from = 1e-5, to = 1e-4, points = 10000000000 }", ["points", "to 1000000"]),
        ("{ from = 1e-4, to = 1e-5, points = 3 }", ["empty range", "below", "exchange them"]),
        ("{ from = 1e-4, to = 1e-4, points = 3 }", ["empty range", "write it alone"]),
        ("{ from = 0, to = 1e-4, points = 3 }", ["load.F_star.from = 0", "> 0"]),
        ("[]", ["load.F_star = [] is empty"]),
        ("[1e-5, -1e-5]", ["load.F_star[1] = -1e-05", "> 0"]),
        ("-1e-5", ["load.F_star = -1e-05", "> 0", "minus sign"]),
    ],
)
def test_empty_ranges_and_bad_loads(problems, value, words):
    text = GOOD[: GOOD.index("[load]")] + f"[load]\nF_star = {value}\n"
    only([item for item in problems(text=text) if '"log"' not in item], *words)


def test_logarithm_of_nothing(problems):
    load = 'separation = { from = 0, to = "9 nm", points = 3, spacing = "log" }'
    text = GOOD[: GOOD.index("[load]")] + f"[load]\n{load}\n"
    only(problems(text=text), "load.separation.from = 0", "> 0", 'spacing = "linear"')


def test_two_loads_and_none(problems):
    found = problems(("[load]", '[load]\npressure = "5 MPa"'))
    only(found, "load.F_star = {", 'load.pressure = "5 MPa"', "only one")
    text = GOOD[: GOOD.index("[load]")] + "[load]\n"
    only(problems(text=text), "[load]", "exactly one of F_star, pressure, separation", '"5 MPa"')


def test_two_densities(problems):
    found = problems(("alpha = 5.0", 'eta = "1e11 / m^2"'))
    only(found, 'roughness.eta = "1e11 / m^2"', "roughness.eta_R_sigma = 0.0455", "only one")


def test_topography_tells_sigma_R_and_eta(problems):
    found = problems(('sigma = "100 nm"', ""), ('R = "2.8 um"', 'topography = "part.x3p"'))
    for key in ("alpha = 5.0", "eta_R_sigma = 0.0455"):
        assert any(f"roughness.{key} is told by the topography" in text for text in found)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("1e11", "1e14", ["particles.areal_density", "jammed", "7.1"]),
        ('std = "24 nm"', "std = 0", ["particles.std = 0", '"monodisperse"']),
        ('seat = "rough"', 'seat = "plane"\nh_0 = "3 nm"', ["particle_law.h_0", "offset"]),
        ('seat = "rough"', 'law = { name = "hermite", k = 0.95 }', ["particle_law.law.k = 0.95"]),
        ('seat = "rough"', 'law = "zmcc"', ["particle_law.law", '"zmc"']),
        ('name = "series"\nseat = "rough"', 'name = "horng2022"\nplastic = 1', ["true or false"]),
        ('title = "Dust"', "title = 5", ["title = 5", "text"]),
    ],
)
def test_rules_of_the_objects_are_told_with_the_keys_of_the_file(problems, old, new, words):
    found = problems((old, new))
    only(found, *words)
    assert not re.search(r"\b(Particles|Series|Hermite|Roughness|TruncatedGaussian)\b", found[0])


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (
            '"histogram"\nedges = [3e-6, 2e-6, 1e-6]\ncounts = [1, 2]',
            ["particles.edges", "increase"],
        ),
        ('"histogram"\nedges = ["1 GPa"]\ncounts = "x"', ["particles.edges[0]", "pressure"]),
        ('"uniform"\nlow = "3 nm"\nhigh = "1 nm"', ["particles.high", "above low = 3e-09"]),
        ('"mixture"\nweights = [1]\nparts = []', ["particles.parts = []", "list of size"]),
        (
            '"mixture"\nweights = [1]\nparts = [{ distribution = "monodisperse", mean = -1 }]',
            ["particles.parts.0.mean = -1", "> 0"],
        ),
    ],
)
def test_mistakes_in_distributions(problems, keys, words):
    old = GOOD[GOOD.index("distribution") : GOOD.index("areal_density")]
    found = problems((old, f"distribution = {keys}\n"))
    only(found[:1], *words)


def test_tables_that_are_not_tables(problems):
    text = 'surfaces = "S45C"\nroughness = [1]\nparticles = []\nasperity_law = 3\nload = 5e6\n'
    found = problems(text=text)
    assert len(found) == 5
    for name, problem in zip(
        ("surfaces", "roughness", "asperity_law", "particles", "load"), found, strict=True
    ):
        assert problem.startswith(f"{name} = ")
        assert f"must be a table, written [{name}]" in problem


def test_all_mistakes_at_once(problems):
    found = problems(
        ('first = "S45C"', 'first = "S45"'),
        ("nu = 0.29", "nu = 0.6"),
        ('sigma = "100 nm"', 'sigma = "300 GPa"'),
        ('R = "2.8 um"', "R = 0"),
        ("alpha = 5.0", "alhpa = nan"),
        ("k = 0.4", "k = inf"),
        ('material = "SiO2"\n', ""),
        ('mean = "300 nm"', 'mean = "-300 nm"'),
        ('name = "series"', 'name = "serie"'),
        ("from = 5e-7", "from = 5e-3"),
        ("points = 5", "points = 0"),
        ("[load]", '[load]\npressure = "5 mmm"'),
    )
    places = [
        "surfaces.first",
        "surfaces.second.nu",
        "roughness.sigma",
        "roughness.R",
        "roughness.alhpa",
        "asperity_law.k",
        "particles.material",
        "particles.mean",
        "particle_law.name",
        "load.F_star.points",
        "load.F_star is an empty range",
        "load.pressure",
        "load.F_star = ",
    ]
    for place in places:
        assert sum(item.startswith(place) for item in found) == 1, place
    assert len(found) == len(places)


ODD = [None, 0, -1, True, "", "x", "5 nm", "5 GPa", [], {}, [1], [[1]], [{}], {"name": "x"}]
ODD += [float("nan"), 10**400, {"from": 1}, {"E": 1}, "9e99999 nm", "x" * 5000]


def _places(data, path=()):
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield (*path, key)
        if isinstance(value, (dict, list)):
            yield from _places(value, (*path, key))


def _one_population():
    good = tomllib.loads(GOOD)
    good["roughness"]["heights"] = {"name": "johnson", "skewness": 0.1, "kurtosis": 3.5}
    return good, [("particle_law", "law"), ("particles", "parts"), ("load", "pressure")]


def _two_populations():
    good = tomllib.loads(SEVERAL)
    good["sweep"] = {"vary": {"particles.0.areal_density": [1e10], "particles": {"1": {}}}}
    good["uncertainty"] = {"inputs": {"particles.1.median": {"low": 1e-7, "high": 2e-7}}}
    more = [("particles", 0, key) for key in ("law", "parts", "iso4406", "concentration")]
    more += [("sweep", "vary", "particles", key) for key in ("0", "1", "mean")]
    return good, more


@pytest.mark.parametrize("study", [_one_population, _two_populations])
def test_any_value_anywhere_is_read_or_refused_in_sentences(study):
    """No value of any type, under any key, ends in another error."""
    good, more = study()
    places = [*_places(good), *more]
    refused = tried = 0
    for i, place in enumerate(places):
        # a twentieth of the odd values at each place, all of them over the file
        for value in ODD[i % 20 :: 20]:
            tried += 1
            data = copy.deepcopy(good)
            *tables, key = place
            table = data
            for name in tables:
                table = table[name]
            if value is not None:
                table[key] = value
            elif isinstance(table, list) or key in table:
                del table[key]
            try:
                check(data)
            except tb.errors.InvalidValue as error:
                refused += 1
                for problem in error.problems:
                    assert len(problem) < 900
                    assert "\n" not in problem
    assert refused > 0.8 * tried


# ---------------------------------------------------------------------------- populations
SEVERAL = (
    GOOD.replace("[particles]", '[[particles]]\nname = "dust"').replace("[load]", "{more}[load]")
).replace(
    "{more}",
    """[[particles]]
name = "debris"
material = { E = "205 GPa", nu = 0.29, H = "8 GPa" }
distribution = "log-normal"
median = "200 nm"
gsd = 1.5
areal_density = "2e10 / m^2"
[particles.law]
name = "series"
zeta_mean = -0.5
""",
)


def test_several_populations_are_those_of_python(write):
    study = load_study(write(text=SEVERAL))
    one = load_study(write()).contact
    debris = tb.Particles(
        material=tb.Material(E=205e9, nu=0.29, H=8e9),
        diameter=tb.LogNormal(median=200e-9, gsd=1.5),
        areal_density=2e10,
        name="debris",
        law=tb.particle.Series(zeta_mean=-0.5),
    )
    assert study.notes == ()
    both = (one.particles.replace(name="dust"), debris)
    assert study.contact == one.replace(particles=both)


def test_one_table_of_a_list_is_the_table(write):
    alone = load_study(write(text=GOOD.replace("[particles]", "[[particles]]")))
    one = load_study(write())
    assert alone.contact.particles == (one.contact.particles,)
    assert run_study(alone)["states"] == run_study(one)["states"]
    assert run_study(alone)["populations"] == []


def test_populations_may_be_counted(write):
    text = SEVERAL.replace('distribution = "log-normal"', 'iso4406 = "18/16/13"\ngap = "1 um"')
    text = re.sub(r'median = "200 nm"\ngsd = 1.5\nareal_density = "2e10 / m\^2"\n', "", text)
    made = load_study(write(text=text)).contact.particles[1]
    body = tb.Material(E=205e9, nu=0.29, H=8e9)
    counted = tb.Particles.from_iso4406("18/16/13", gap="1 um", material=body)
    assert (made.diameter, made.areal_density) == (counted.diameter, counted.areal_density)
    assert (made.name, made.law) == ("debris", tb.particle.Series(zeta_mean=-0.5))


@pytest.mark.parametrize(
    ("override", "field", "value"),
    [
        ("particles.0.mean=500 nm", "particles.0.diameter.mean", 500e-9),
        ("particles.1.areal_density=3e10", "particles.1.areal_density", 3e10),
        ("particles.1.law.zeta_mean=0.5", "particles.1.law.zeta_mean", 0.5),
        ("particles.1.material.H=9 GPa", "particles.1.material.H", 9e9),
        ("particles.0.name=sand", "particles.0.name", "sand"),
    ],
)
def test_overrides_of_a_population(write, override, field, value):
    plain = load_study(write(text=SEVERAL)).contact
    assert load_study(write(text=SEVERAL), [override]).contact == plain.replace(**{field: value})


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("particles.mean=1e-7", ["particles is a list of 2", "e.g. particles.0.mean"]),
        ("particles.2.mean=1e-7", ["numbered 0 to 1", "e.g. particles.0.mean"]),
        ("particles.0.maen=1", ["particles.0.maen = 1", "did you mean mean?"]),
        ("particles.0.mean=1 GPa", ['particles.0.mean = "1 GPa"', "is a pressure"]),
        ("particles.0=3", ["particles.0 = 3 must be a table"]),
        ("particles.1.name=dust", ['particles.1.name = "dust"', "name of particles.0"]),
        ("particles.1.law.seat=rouhg", ["particles.1.law.seat", 'did you mean "rough"?']),
        ("particles.1.law.name=horng2022", ["particles.1.law.zeta_mean", "not a known key"]),
        ("particles.1.law=horng2022", ["particles follow laws", "different planes"]),
        ("particles.0.areal_density=1e14", ["particles.0.areal_density", "jammed"]),
        ("particles.0.iso4406=18/16/13", ["particles.0.distribution", "keep one"]),
    ],
)
def test_mistakes_in_populations(problems, override, words):
    only(problems(text=SEVERAL, overrides=[override])[:1], *words)


def test_populations_that_jam_only_together(problems):
    found = problems(text=SEVERAL.replace("1e11 /", "9e12 /").replace("2e10 /", "1.5e13 /"))
    only(found, "particles are jammed: together")


def test_one_table_has_no_number(problems):
    only(problems(overrides=["particles.0.mean=1e-7"]), "one table [particles]", "particles.mean")


def test_laws_that_have_no_effect_are_noted(write):
    law = '[particles.law]\nname = "series"\nzeta_mean = -0.5\n[particle_law]'
    (note,) = load_study(write(("[particle_law]", law))).notes
    assert note.startswith("[particle_law] ")


# ---------------------------------------------------------------------------- inputs that vary
@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('"particles.0.areal_density" = [1e10, 2e10]', "particles.0.areal_density"),
        ('"particles.0.mean" = [2e-7, 3e-7]', "particles.0.diameter.mean"),
        ('particles.1.median = [2e-7, "300 nm"]', "particles.1.diameter.median"),
        ('"particles.1.law.zeta_mean" = [0.0, 0.5]', "particles.1.law.zeta_mean"),
        ('"particles.0.material.H" = ["5 GPa", "6 GPa"]', "particles.0.material.H"),
    ],
)
def test_sweeps_over_a_population(write, line, field):
    study = load_study(write(text=SEVERAL + f"[sweep.vary]\n{line}\n"))
    solved = study.sweep.whole.solve()["A_t"]
    (dim,) = (dim for dim in study.sweep.dims if dim.name != "F_star")
    assert dim.name == field
    last = study.contact.replace(**{field: dim.values[field][-1]})
    by_hand = tb.solve(last, F_star=study.values).A_t
    np.testing.assert_allclose(solved.reshape(2, -1)[-1], by_hand, rtol=1e-9)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('"particles.areal_density" = [1e10]', ["several particles", "particles.0.areal_density?"]),
        ('"particles.2.mean" = [1e-7]', ["sweep.vary.particles.2", "known here: 0, 1"]),
        ('"particles.0.name" = ["x"]', ["no part in the contact (a label)"]),
        (
            '"surfaces.first.density" = [7800]',
            ["first.density = [7800]", "no part", "mass density"],
        ),
        ('"surfaces.second.source" = ["x"]', ["surfaces.second.source", "no part", "label"]),
        ('"particles.0.material.resistivity" = [1]', ["no part", "electrical resistivity"]),
    ],
)
def test_what_cannot_vary(problems, line, words):
    only(problems(text=SEVERAL + f"[sweep.vary]\n{line}\n"), *words)


def test_what_a_contact_fills_in_cannot_vary(problems):
    text = GOOD.replace('name = "zmc"\nk = 0.4', 'name = "jkr"\nw = 0.03')
    found = problems(text=text + '[sweep.vary]\n"asperity_law.scale" = [0.1]\n')
    only(found, "sweep.vary.asperity_law.scale", "follows from the contact")


def test_uncertain_populations(write, problems):
    start = SEVERAL + "[uncertainty.inputs]\n"
    study = load_study(
        write(
            text=start + '"particles.1.median" = { low = 1e-7, high = 2e-7 }\n'
            "particles.0.areal_density = { median = 1e10, gsd = 2 }\n"
        )
    )
    names = ["particles.1.diameter.median", "particles.0.areal_density"]
    assert list(study.uncertainty.inputs) == names
    line = '"particles.0.material.density" = { low = 1, high = 2 }'
    only(problems(text=start + line), "particles.0.material.density", "no part in the contact")
    line = '"particles.mean" = { low = 1e-7, high = 2e-7 }'
    only(problems(text=start + line), "did you mean particles.0.mean?")


# ---------------------------------------------------------------------------- tables to come
@dataclass(frozen=True, slots=True, kw_only=True)
class Sliding(Value):
    """What a table of an output may hold."""

    tau: float = quantity("τ", "Pa", "shear strength", gt=0, hint="MPa are '90 MPa'")
    rule: str = choice("how it grows", "constant", "linear", default="constant")


def test_a_table_is_one_entry_of_the_list(write, problems, monkeypatch):
    sliding = Table(
        name="sliding",
        key=table_of(Sliding),
        role="study",
    )
    monkeypatch.setattr(whole, "TABLES", (*whole.TABLES, sliding))
    assert load_study(write(text=GOOD + '[sliding]\ntau = "90 MPa"\n')).contact is not None
    only(problems(text=GOOD + "[slidign]\ntau = 1e6\n"), "did you mean [sliding]?")
    only(problems(text=GOOD + "[sliding]\ntua = 1e6\n"), "sliding.tua", "did you mean tau?")
    only(problems(text=GOOD + "[sliding]\ntau = -1\n"), "sliding.tau = -1 must be > 0 [Pa]")
    only(problems(text=GOOD + '[sliding]\ntau = 1e6\nrule = "liner"\n'), 'did you mean "linear"')


# ---------------------------------------------------------------------------- files
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"100 nm"', "100 nm", ["line 7", "in quotes", 'sigma = "100 nm"']),
        ('first = "S45C"', "first = S45C", ["line 4", 'first = "S45C"']),
        ('"2.8 um"', "2,8", ["line 8", "decimal point"]),
        ("alpha = 5.0", "sigma = 5.0", ["line 9", "sigma is given twice"]),
        ("[roughness]", "[roughness", ["line 6", "[roughness"]),
        ("[roughness]", "[surfaces]", ["line 6", "[surfaces]", "twice"]),
    ],
)
def test_syntax_errors_name_the_line(problems, old, new, words):
    only(problems((old, new)), "study.toml", *words)


# ---------------------------------------------------------------- particles that break
OF_QUARTZ = ('material = "SiO2"', 'material = "quartz"')


@pytest.mark.parametrize(
    ("line", "strength"),
    [
        ('strength = "material"', tb.grains.WeibullStrength.of(tb.materials["quartz"])),
        (
            'strength = { fragments = "all", ratio = 0.4 }',
            tb.grains.WeibullStrength.of(tb.materials["quartz"], fragments="all", ratio=0.4),
        ),
        (
            'strength = { sigma_0 = "80 MPa", at = "2 mm", m = 4, size_exponent = 0.6 }',
            tb.grains.WeibullStrength(sigma_0=80e6, x_0=2e-3, m=4, size_exponent=0.6),
        ),
    ],
)
def test_strength_of_particles(write, line, strength):
    study = load_study(write(OF_QUARTZ, ("n = 3\n", f"n = 3\n{line}\n")))
    assert study.contact.particles.strength == strength


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ('strength = "stone"', 'particles.strength = "stone" must be "material"'),
        ('strength = { sigma_0 = "80 MPa", at = "2 mm" }', "particles.strength.m is missing"),
        ('strength = { at = "2 mm", m = 3 }', "particles.strength.sigma_0 is missing"),
        (
            'strength = { sigma_0 = "80 MPa", at = "2 mm", x_0 = "1 mm", m = 3 }',
            "both are the size of the test; keep one of them",
        ),
        ("strength = { ratio = 1 }", "particles.strength.ratio = 1 must be > 0 and < 1"),
        ("strength = { kept = 1 }", "particles.strength.kept = 1 is not a known key"),
    ],
)
def test_mistakes_in_a_strength(problems, line, sentence):
    only(problems(OF_QUARTZ, ("n = 3\n", f"n = 3\n{line}\n")), sentence)


def test_strength_of_a_material_that_has_none(problems):
    found = problems(('material = "SiO2"', 'material = "MoS2"\nstrength = "material"'))
    only(found, "particles.strength: the material MoS2 has no strength: it lacks sigma_0")


def test_toughness_in_a_file(write, problems):
    body = 'material = { E = "90 GPa", nu = 0.1, H = "12 GPa", K_c = "1.2 MPa m^0.5" }'
    study = load_study(write(('material = "SiO2"', f'{body}\nstrength = "material"')))
    assert study.contact.particles.material.K_c == 1.2e6
    strength = study.contact.particles.strength
    assert strength == tb.grains.WeibullStrength.from_toughness(1.2e6)
    found = problems(('material = "SiO2"', body.replace("m^0.5", "m^2")))
    only(found, "particles.material.K_c", "a fracture toughness")


ANGULAR = 'shape = { kind = "angular", roundness = 0.25, angle = "30 deg" }'


@pytest.mark.parametrize(
    ("line", "shape"),
    [
        ('shape = "sphere"', tb.grains.Sphere()),
        ('shape = { kind = "sphere" }', tb.grains.Sphere()),
        (ANGULAR, tb.grains.Angular(roundness=0.25, angle="30 deg")),
        (
            'shape = { kind = "angular", roundness = 0.5, angle = 0.6, flatness = 1.5 }',
            tb.grains.Angular(roundness=0.5, angle=0.6, flatness=1.5),
        ),
    ],
)
def test_shape_of_particles(write, line, shape):
    study = load_study(write(("n = 3\n", f"n = 3\n{line}\n")))
    assert study.contact.particles.shape == shape


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ('shape = "angular"', 'particles.shape = "angular" must be sphere, or the table { kind'),
        ("shape = 3", "particles.shape = 3 must be sphere, or the table"),
        ('shape = { kind = "cube" }', 'particles.shape.kind = "cube" must be one of'),
        ('shape = { kind = "sphere", angle = 1 }', "particles.shape.angle"),
        (ANGULAR.replace("30 deg", "95 deg"), 'particles.shape.angle = "95 deg" must be > 0'),
        (ANGULAR.replace('"30 deg"', "30"), "degrees are written '25 deg'"),
        (ANGULAR.replace("30 deg", "30 nm"), "is a length, but an angle [rad] is needed"),
        (ANGULAR.replace("0.25", "1.5"), "particles.shape.roundness = 1.5 must be > 0 and <= 1"),
        (ANGULAR.replace(" }", ", flatness = 0.5 }"), "particles.shape.flatness = 0.5 must be >="),
        (ANGULAR.replace("roundness = 0.25, ", ""), "particles.shape.roundness is missing"),
        (ANGULAR.replace(', angle = "30 deg"', ""), "particles.shape.angle is missing"),
    ],
)
def test_mistakes_in_a_shape(problems, line, sentence):
    only(problems(("n = 3\n", f"n = 3\n{line}\n")), sentence)


def test_weibull_sizes_have_a_shape_of_their_own(write, problems):
    """``shape`` is a number of the sizes, or the table of the particles beside weibull_shape."""
    sizes = ('"truncated-gaussian"', '"weibull"'), ('mean = "300 nm"', 'scale = "300 nm"')
    line, number = 'std = "24 nm"\nn = 3\n', "shape = 4.0\n"
    plain = load_study(write(*sizes, (line, number))).contact.particles
    assert (plain.diameter.shape, plain.shape) == (4.0, tb.grains.Sphere())
    both = load_study(write(*sizes, (line, f"weibull_{number}{ANGULAR}\n"))).contact.particles
    assert both.diameter == plain.diameter
    assert both.shape == tb.grains.Angular(roundness=0.25, angle="30 deg")
    only(problems(*sizes, (line, f"{ANGULAR}\n")), "particles.weibull_shape is missing")


def test_an_angle_may_be_swept(write):
    varied = '[sweep.vary]\nparticles.shape.angle = ["20 deg", "40 deg"]\n'
    study = load_study(write(("n = 3\n", f"n = 3\n{ANGULAR}\n"), ("[load]", f"{varied}[load]")))
    (angles,) = [dim.values for dim in study.sweep.dims if dim.name == "particles.shape.angle"]
    np.testing.assert_allclose(angles["particles.shape.angle"], np.radians([20, 40]))


def test_files_that_cannot_be_read(tmp_path):
    def told(path):
        with pytest.raises(tb.errors.InvalidValue) as caught:
            load_study(path)
        return list(caught.value.problems)

    (tmp_path / "study.toml").write_text(GOOD)
    only(told(tmp_path / "stduy.toml"), "no such file", "did you mean", "study.toml")
    only(told(tmp_path / "else.toml"), "no such file")
    only(told(tmp_path / "none" / "study.toml"), "no such file")
    only(told(tmp_path), "folder")
    (tmp_path / "latin.toml").write_bytes('a = 1\ntitle = "Stäube"'.encode("latin-1"))
    only(told(tmp_path / "latin.toml"), "line 2", "UTF-8")


def test_byte_order_mark_and_windows_line_ends(tmp_path):
    path = tmp_path / "study.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load_study(path).title == "Dust"


# ---------------------------------------------------------------------------- overrides
def test_overrides(write):
    study = load_study(
        write(),
        ["particles.mean=500 nm", "asperity_law.k=0.5", "particles.material=S45C", "title=x = y"],
    )
    assert study.contact.particles.diameter.mean == 500e-9
    assert study.contact.particles.material == tb.materials["S45C"]
    assert study.contact.asperity_law.k == 0.5
    assert study.title == "x = y"


def test_override_of_a_load_takes_its_place(write):
    study = load_study(write(), ["load.pressure=[1e6, '2 MPa']"])
    assert (study.load, study.values.tolist()) == ("pressure", [1e6, 2e6])
    assert len(load_study(write(), ["load.F_star.points=9"]).values) == 9
    study = load_study(write(), ["roughness.eta=1.6e11 / m^2"])
    assert study.contact.roughness == tb.Roughness(sigma=100e-9, R=2.8e-6, eta=1.6e11)


def test_override_adds_a_table(write):
    text = re.sub(r"\[asperity_law\][^[]*", "", GOOD)
    study = load_study(write(text=text), ["asperity_law.name=hermite"])
    assert study.contact.asperity_law == tb.asperity.Hermite()


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("particles.mean", ["particles.mean", "KEY=VALUE"]),
        ("=3", ["KEY=VALUE"]),
        ("a..b=3", ["KEY=VALUE"]),
        ("surfaces.first.E=3", ['surfaces.first = "S45C" is not a table', "as a whole"]),
        ("particles.mean=300 GPa", ['particles.mean = "300 GPa"', "is a pressure"]),
        ("particles.maen=1", ["particles.maen = 1", "did you mean mean?"]),
        ("particle.mean=1", ["[particle]", "did you mean [particles]?"]),
    ],
)
def test_overrides_that_make_no_sense(problems, override, words):
    only(problems(overrides=[override]), *words)


# ---------------------------------------------------------------------------- likely slips
def test_forgotten_units_are_asked_about(write):
    with pytest.raises(tb.errors.InvalidValue) as told:
        load_study(write(('"100 nm"', "100"), ('"205 GPa"', "205"), ('"2.8 um"', "2.8")))
    assert told.value.problems == (
        "surfaces.second.E = 205 has no unit, so it would be 205 Pa, which is not plausible; was "
        '"205 GPa" meant? With its unit any value is taken: "205 Pa"',
        "roughness.sigma = 100 has no unit, so it would be 100 m, which is not plausible; was "
        '"100 nm" meant? With its unit any value is taken: "100 m"',
        "roughness.R = 2.8 has no unit, so it would be 2.8 m, which is not plausible; was "
        '"2.8 um" meant? With its unit any value is taken: "2.8 m"',
    )


@pytest.mark.parametrize("value", ['"100 m"', '"50 km"', '"0.1 nm"', "1e-7", "0.0005", '"1e-7"'])
def test_no_length_with_a_unit_and_no_plausible_number_is_refused(write, value):
    load_study(write(('"100 nm"', value), ('"2.8 um"', '"2.8 km"')))


@pytest.mark.parametrize(
    ("key", "value", "meant"),
    [
        ("load.pressure", "5", '"5 MPa"'),
        ("load.pressure", "[1e6, 5]", '"5 MPa"'),
        ("load.separation", "250", '"250 nm"'),
        ("load.pressure", "{ from = 1, to = 1e7, points = 3 }", '"1 MPa"'),
        ("roughness.sigma", '"120"', '"120 nm"'),
        ("particles.mean", "300.0", '"300 nm"'),
        ("surfaces.first", "{ E = 205e9, nu = 0.3, H = 5e9, K_c = 1.2 }", '"1.2 MPa m^0.5"'),
        ("surfaces.first", "{ E = 205e9, nu = 0.3, H = 5e9, density = 7.8 }", '"7.8 g/cm^3"'),
        ("film.oil.eta", "20", '"20 mPa s"'),
        ("asperity_law", '{ name = "jkr", w = 50 }', '"50 mJ/m^2"'),
        ('uncertainty.inputs."roughness.sigma"', "{ low = 90, high = 110 }", '"90 nm"'),
    ],
)
def test_numbers_that_no_interface_has_are_asked_about(write, key, value, meant):
    film = "\n".join(
        (
            *("[film]", 'load = "20 N"', 'speed = "1 m/s"'),
            *('conjunction = { shape = "point", R = "9.5 mm" }', "[film.oil]"),
            *('eta = "20 mPa s"', 'alpha = "20 / GPa"'),
        )
    )
    path = write()
    path.write_text(path.read_text("utf-8") + "\n" + film, "utf-8")
    load_study(path)
    with pytest.raises(tb.errors.InvalidValue) as told:
        load_study(path, [f"{key}={value}".replace('"roughness.sigma"', "roughness.sigma")])
    assert any(
        each.startswith(key) and f"was {meant} meant?" in each for each in told.value.problems
    )


def test_a_unit_of_the_wrong_case_is_noted(write):
    (note,) = load_study(write(('"205 GPa"', '"205 mPa"'))).notes
    assert "0.205 Pa" in note
    assert "case" in note


def test_law_without_particles_is_noted(write):
    text = re.sub(r"\[particles\][^[]*", "", GOOD)
    study = load_study(write(text=text))
    assert study.contact.two_body
    assert "no [particles]" in study.notes[0]


# ---------------------------------------------------------------------------- running
def test_numbers_are_those_of_the_python_interface(write):
    study = load_study(write())
    result = run_study(study)
    state = tb.solve(study.contact, F_star=np.geomspace(5e-7, 2.4e-4, 5))
    for name, column in state.columns().items():
        assert result["states"][name] == column.tolist(), name
    assert result["transitions"] == tb.transitions(study.contact).to_dict()
    assert result["scales"] == state.scales
    assert result["citations"] == tb.cite(study.contact).splitlines()
    inputs = dict(result["inputs"])
    assert inputs.pop("load") == {"F_star": np.geomspace(5e-7, 2.4e-4, 5).tolist()}
    assert tb.Contact.from_dict(inputs) == study.contact


def test_strings_and_plain_numbers_give_the_same_study(write):
    plain = write(
        ('"205 GPa"', "205e9"), ('"5 GPa"', "5e9"), ('"100 nm"', "100e-9"), ('"2.8 um"', "2.8e-6"),
        ('"300 nm"', "300e-9"), ('"24 nm"', "24e-9"), ('"1e11 / m^2"', "1e11"),
    )  # fmt: skip
    first = load_study(plain).contact
    assert first == load_study(write()).contact


def test_unsolved_states_keep_their_place(write):
    result = run_study(load_study(write(), ["load.F_star=[1e-5, 1e3, 1e-4]"]))
    states = result["states"]
    assert [status == "ok" for status in states["status"]] == [True, False, True]
    assert states["d"][1] is None
    assert states["mode"][1] is None
    assert "no equilibrium" in states["status"][1]
    assert states["F_star"][1] == 1e3


@pytest.mark.spread(3)
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_sensible(path):
    study = load_study(path)
    assert study.title
    # particles of an oil are wider than the film that brings them
    assert {note.code for note in study.notes} <= {"gap"}
    result = run_study(study)
    states = result["states"]
    assert set(states["status"]) == {"ok"}
    known = (
        "sit deeper than their radius",
        "strengths are extrapolated by a factor",
        "agrees with a computation",
        "soft particles squashed to contacts",
        "as debris = 'ductile' says",
        "at chi = H/(E* g)",
    )
    notes = {*result.oil_notes, *study.notes}
    doubts = [text for text in result["warnings"] if text not in notes]
    assert [text for text in doubts if not any(each in text for each in known)] == []
    assert max(states["residual"]) < 1e-9
    order = np.argsort(states["F_star"])
    d, area = (np.array(states[name])[order] for name in ("d", "A_t"))
    assert np.all(np.diff(d) < 0)
    assert np.all(np.diff(area) > 0)
    assert max(area) < 0.2
    total = np.array(states["F_ss_star"]) + states["F_sa_star"]
    assert total == pytest.approx(states["F_star"], rel=1e-9)
    if study.contact.particles is not None and len(area) > 1:
        share = np.array(states["particle_load_share"])[order]
        assert np.all(np.diff(share) <= 1e-15)
        assert share[-1] < share[0] or np.all(share == 1)


def example(name):
    (path,) = (path for path in EXAMPLES if path.stem == name)
    return path


def test_what_the_example_of_an_abrasive_says():
    round_ = ["particles.shape.roundness=1", "particles.shape.angle=60 deg"]
    sharp, sphere = (
        run_study(load_study(example("angular_abrasive"), settings))["states"]
        for settings in ([], round_)
    )
    ratio = {name: sharp[name][-1] / sphere[name][-1] for name in ("mu_sa", "wear")}
    assert ratio == pytest.approx({"mu_sa": 2.7, "wear": 2.0}, abs=0.05)
    assert sphere["d"][-1] - sharp["d"][-1] == pytest.approx(0.5e-6, abs=0.05e-6)


def test_what_the_example_of_debris_in_a_film_says():
    soft = ["particle_law.name=series", "particle_law.soft=sphere"]
    squashed, sphere = (
        run_study(load_study(example("steel_debris_in_film"), settings))["states"]
        for settings in ([], soft)
    )
    ratio = np.array(squashed["pressure"]) / sphere["pressure"]
    assert ratio[[0, 3, 4]] == pytest.approx([0.49, 3.89, 9.94], abs=0.05)
    assert squashed["dent_width_1"][3] == pytest.approx(12e-6, abs=0.5e-6)
    assert sphere["pressure"][-1] == pytest.approx(sphere["pressure"][2], rel=1e-3)


def test_what_the_examples_say():
    """The comments of the example files are true."""
    loads = "load.pressure=[1.2e6, 30e6]"
    sphere = [loads, "particle_law.name=series", "particle_law.soft=sphere"]
    soft, hard, sphere = (
        run_study(load_study(example("soft_ptfe_particles"), settings))["states"]
        for settings in ([loads], [loads, "particles.material=SiO2"], sphere)
    )
    assert soft["particle_load_share"][1] == pytest.approx(0.92, abs=0.005)
    assert hard["particle_load_share"][1] > 0.98
    assert soft["A_t"][1] / hard["A_t"][1] == pytest.approx(2.6, abs=0.1)
    assert soft["d"][1] < hard["d"][1]
    assert sphere["particle_load_share"][0] < 0.5
    small = run_study(load_study(example("nanoparticle_additive")))["states"]
    assert small["particle_load_share"][0] == pytest.approx(0.08, abs=0.005)
    assert small["particle_load_share"][-1] == pytest.approx(0.05, abs=0.005)
    debris = run_study(load_study(example("bearing_wear_debris")))["states"]
    assert debris["particle_load_share"][0] > 0.999
    both = run_study(load_study(example("dust_and_debris"), ["load.pressure=[80e3, 3.5e5, 6e5]"]))
    dust, wear = (part["load_share"] for part in both["populations"])
    assert wear[0] == pytest.approx(0.85, abs=0.01)
    assert dust[2] > wear[2]
    assert dust[1] / wear[1] == pytest.approx(1, abs=0.1)
    clean = run_study(load_study(example("two_body_reference")))["states"]
    for area, elastoplastic in zip(clean["A_t"], clean["A_ep"], strict=True):
        assert elastoplastic > 0.5 * area


def test_loads_are_documented():
    assert list(LOADS) == ["F_star", "pressure", "separation"]


def test_sizes_beside_a_code_are_answered_with_the_code(problems):
    kept = 'material = "SiO2"\niso4406 = "18/16/13"\ngap = "1 um"\nmean = "300 nm"\n'
    begin, end = GOOD.index("[particles]") + len("[particles]\n"), GOOD.index("[load]")
    found = problems(text=GOOD[:begin] + kept + GOOD[end:])
    only(found, "particles.mean", "particles.iso4406")


# ------------------------------------------------------------------ ranges of other programs
RANGES = [
    ('roughness.sigma = {start = "80 nm", stop = "120 nm", num = 3}', "roughness.sigma", "3"),
    ('roughness.sigma = {low = "80 nm", high = "120 nm", steps = 7}', "roughness.sigma", "7"),
    ('"roughness.sigma" = {min = "80 nm", max = "120 nm"}', "roughness.sigma", "10"),
]
"""Entries of [sweep.vary] in words of other programs, their input, and how many values it takes."""


@pytest.mark.parametrize("entry", ['"roughness.sigma" = [1e-7]', "roughness.sigma = [1e-7]"])
def test_an_input_that_stands_in_sweep_itself_is_sent_to_the_table_of_those_that_vary(
    problems, entry
):
    (problem,) = problems(text=f"{GOOD}[sweep]\n{entry}\n")
    assert problem.code is Mistake.UNKNOWN
    assert "[sweep.vary]" in problem.hint


@pytest.mark.parametrize(("entry", "name", "points"), RANGES)
def test_a_range_in_words_of_other_programs_is_told_once_with_its_right_form(
    problems, write, entry, name, points
):
    (problem,) = problems(text=f"{GOOD}[sweep.vary]\n{entry}\n")
    assert (problem.code, problem.place) == (Mistake.UNKNOWN, f"sweep.vary.{name}")
    right = f'{{ from = "80 nm", to = "120 nm", points = {points} }}'
    assert right in problem.hint
    assert load_study(write(text=f"{GOOD}[sweep.vary]\n{name} = {right}\n")).sweep is not None


@pytest.mark.parametrize(
    "entry", ["{start = 1, stop = 5, num = 3}", "{from = 1, to = 5, points = 3}"]
)
def test_a_range_of_no_input_is_told_once(problems, entry):
    (problem,) = problems(text=f"{GOOD}[sweep]\nvary = {entry}\n")
    assert (problem.code, problem.place) == (Mistake.MISSING, "sweep.vary")
    assert "{ from = 1, to = 5, points = 3 }" in problem.hint
