"""Inputs that no solid and no oil has: a word each, in Python and in study files."""

import warnings
from dataclasses import replace
from pathlib import Path

import pytest
from refusals import Mistake, refuses, warns_of
from steel_and_dust import DUSTY

import thirdbody as tb
from thirdbody.study import run_study
from thirdbody.study.dirty_oil import dirty_oil
from thirdbody.study.oil_what_ifs import what_ifs_of_oil
from thirdbody.study.run_plate import load_plate, run_plate

STUDY = Path(tb.__file__).parent / "data" / "studies" / "ball-screw.toml"
SIZES = tb.distributions.Monodisperse(mean=5e-6)


def notes_of(*overrides):
    """Notes of a study by their codes."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", tb.errors.RangeWarning)
        study = tb.load_study(STUDY, ["load.force=1000", *overrides])
    return {note.code: note for note in run_study(study).warnings if hasattr(note, "code")}


@pytest.mark.parametrize("hardness", [1.01, 20.0])
@pytest.mark.parametrize("place", ["particles.material", "surfaces.first", "surfaces.second"])
def test_a_solid_harder_than_stiff_is_told_of(place, hardness):
    body = DUSTY.value_at(place)
    hard = DUSTY.replace(**{f"{place}.H": hardness * body.E})
    with warns_of("hardness", effect=1.0, says=place.removesuffix(".material")):
        tb.solve(hard, pressure=5e6)
    usual = DUSTY.replace(**{f"{place}.H": 0.3 * body.E})
    codes = [getattr(note, "code", "") for note in tb.solve(usual, pressure=5e6).warnings]
    assert "hardness" not in codes


def test_a_study_tells_of_a_solid_harder_than_stiff():
    material = "particles.material={E='70 GPa', nu=0.2, H='90 GPa', density=2650}"
    assert notes_of(material)["hardness"].action
    assert "hardness" not in notes_of()


@pytest.mark.parametrize(
    ("gap", "sizes", "wider"),
    [
        (1e-6, SIZES, 1.0),
        ("1 um", tb.distributions.Uniform(low=0.5e-6, high=1.5e-6), 0.5),
        (5e-6, SIZES, None),
        (1e-6, tb.LogNormal(median=3e-7, gsd=1.5), None),
    ],
)
def test_grains_wider_than_the_gap_that_brings_them_are_told_of(gap, sizes, wider):
    options = {"diameter": sizes, "material": tb.materials["SiO2"], "gap": gap}
    if wider is None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            tb.Particles.from_concentration(1e9, **options)
        return
    with warns_of("gap", effect=wider) as heard:
        tb.Particles.from_concentration(1e9, **options)
    assert len(heard) == 1


def test_codes_of_cleanliness_bring_grains_wider_than_a_film():
    options = {"gap": "1 um", "material": tb.materials["SiO2"]}
    with warns_of("gap"):
        tb.Particles.from_iso4406("18/16/13", **options)
    with warns_of("gap"):
        tb.Particles.from_cleanliness_class("nas1638", "6", **options)


def test_a_study_tells_of_grains_wider_than_their_gap_beside_the_key():
    wide = notes_of("particles.gap=0.1 um")
    assert wide["gap"].effect > 0.01
    assert "gap" not in notes_of("particles.gap=1 mm")


def test_the_film_of_a_study_is_run_by_a_method_and_is_no_function():
    oiled = tb.load_study(STUDY, ["film.speed=0.1"])
    with refuses(Mistake.KIND, "study.film", meant="stribeck()"):
        oiled.film()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert oiled.stribeck().equals(oiled.film.stribeck(oiled.contact))
    with refuses(Mistake.MISSING, "film"):
        tb.load_study(STUDY.with_name("two-body.toml")).stribeck()


def test_beside_a_film_the_note_on_the_gap_stands_with_that_on_the_oil():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        study = tb.load_study(STUDY.with_name("gear.toml"), ['asperity_law.name="ke"'])
        found = run_study(study)
    codes = [getattr(note, "code", "") for note in found.oil_notes]
    assert codes == ["film.left_out", "gap"]
    assert "gap" not in [getattr(note, "code", "") for note in study.notes]


JAMMED_TWICE = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "200 nm"
R = "25 um"
[particles]
material = "SiO2"
distribution = "truncated-gaussian"
mean = "30 um"
std = "3 um"
areal_density = "1e9 / m^2"
[load]
pressure = "1 MPa"
"""


def test_particles_that_are_jammed_at_twice_their_number_are_answered(tmp_path):
    """They cover 0.71 of the area: nothing is asked of 1.42."""
    (tmp_path / "jammed.toml").write_text(JAMMED_TWICE, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result = run_study(tb.load_study(tmp_path / "jammed.toml"))
    codes = [what_if.code for what_if in result.what_ifs]
    assert "number" not in codes
    assert len(codes) > 1
    assert len(result.to_dict()["what_ifs"]) == len(codes)
    assert list(result.states.status) == ["ok"]


def test_dirt_that_is_jammed_at_twice_its_number_is_answered():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        study = tb.load_study(STUDY)
        (population,) = study.contact.populations
        crowd = population.replace(
            areal_density=0.6 / population.coverage * population.areal_density
        )
        study = replace(study, contact=study.contact.replace(particles=crowd))
        oil = dirty_oil(study)
        assert oil is not None
        codes = [what_if.code for what_if in what_ifs_of_oil(study, oil)]
    assert "number" not in codes
    assert "film.oil.eta" in codes


def test_a_plate_on_dust_that_twice_would_be_jammed_is_answered():
    dust = ['particles={material="SiO2", distribution="monodisperse", mean="2 um", '
            'areal_density="2e11 / m^2"}']  # fmt: skip
    plate = load_plate(STUDY.with_name("wafer-chuck.toml"), dust)
    found = run_plate(plate)
    assert found.bumps is not None
    assert "number" not in " ".join(what_if.what for what_if in found.what_ifs)
