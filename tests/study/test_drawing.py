"""Roughness as drawings state it, from the study file to the error bars."""

import itertools
import math
import tomllib

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.analysis.uncertainty.inputs import stated_ranges
from thirdbody.errors import InvalidValue
from thirdbody.populations.finish import processes, slopes
from thirdbody.study import check
from thirdbody.study.toml import override

BODIES = """
[surfaces]
first = "100Cr6"
second = "100Cr6"
[load]
pressure = "50 MPa"
"""
ROOT = math.sqrt(math.pi / 2)


def study(roughness, *overrides):
    return check(override(tomllib.loads(BODIES + roughness), overrides))


def problems(roughness):
    with pytest.raises(InvalidValue) as caught:
        study(roughness)
    return caught.value.problems


FACES = """
[roughness.first]
Ra = "0.2 um"
process = "ground"
[roughness.second]
Rq = "0.05 um"
process = "lapped"
"""


def test_faces_add_as_squares():
    found = study(FACES)
    rough = found.contact.roughness
    assert rough.sigma == pytest.approx(math.hypot(ROOT * 0.2e-6, 0.05e-6), rel=1e-14)
    assert rough == tb.Roughness.from_drawing(
        tb.surfaces.Finish(Ra=0.2e-6, process="ground"),
        tb.surfaces.Finish(Rq=0.05e-6, process="lapped"),
    )
    (note,) = found.notes  # said once, and no slip
    assert "; R = " in note.replace("); R", "; R")
    assert "from memory" in note
    assert found.assumed == (note,)


def test_the_pair_has_the_moments_of_its_faces():
    faces = {"ground": ROOT * 0.4e-6, "lapped": ROOT * 0.1e-6}
    moments = []
    for process, Rq in faces.items():
        slope = math.prod(processes()[process]["slope"]) ** 0.5
        m0, m2, alpha = Rq**2, slope**2, math.sqrt(2.2 * 8.7)
        moments.append(tb.surfaces.SpectralMoments(m0=m0, m2=m2, m4=alpha * m2**2 / m0))
    both = (moments[0] + moments[1]).roughness()
    rough = tb.Roughness.from_drawing(
        tb.surfaces.Finish(Ra=0.4e-6, process="ground"),
        tb.surfaces.Finish(Ra=0.1e-6, process="lapped"),
    )
    for name in ("sigma", "R", "alpha", "density", "sigma_s", "y_s"):
        assert getattr(rough, name) == pytest.approx(getattr(both, name), rel=1e-12), name


def test_ranges_hold_every_pair_of_faces():
    rng = np.random.default_rng(3)
    first, second = (
        tb.surfaces.Finish(Rz=1.6e-6, process="ground"),
        tb.surfaces.Finish(Ra=0.1e-6, process="honed"),
    )
    ranges = tb.Roughness.from_drawing(first, second).ranges
    assert list(ranges) == ["sigma", "R", "alpha", "eta_R_sigma"]
    for _ in range(200):
        total = None
        for face, process in ((first, "ground"), (second, "honed")):
            Rq = rng.uniform(face.heights[0], face.heights[2])
            slope, alpha = rng.uniform(*slopes(process, Rq)), rng.uniform(2.2, 8.7)
            one = tb.surfaces.SpectralMoments(m0=Rq**2, m2=slope**2, m4=alpha * slope**4 / Rq**2)
            total = one if total is None else total + one
        rough = total.roughness()
        product = rough.density * rough.R * rough.sigma
        for name, value in (
            ("sigma", rough.sigma),
            ("R", rough.R),
            ("alpha", rough.alpha),
            ("eta_R_sigma", product),
        ):
            assert ranges[name][0] <= value <= ranges[name][1], name


def test_slopes_hold_the_published_correlations():
    """m(σ) of Lambert and Fletcher, Antonetti et al., Tanner and Fahoum (σ in µm), as RMS."""
    usual = {"ground": 0.4, "lapped": 0.1, "superfinished": 0.05, "turned": 1.6, "blasted": 3.2}
    for process, Ra in usual.items():
        sigma = ROOT * Ra
        published = [0.076 * sigma**0.5, 0.152 * sigma**0.4]
        if sigma <= 1.6:
            published.append(0.124 * sigma**0.743)
        low, high = slopes(process, sigma * 1e-6)
        assert all(low <= ROOT * m <= high for m in published), process


def test_no_process_gives_a_needle():
    """At every height that a process reaches the usual radius is that of no atomic tip."""
    for process, entry in processes().items():
        for Ra in entry["Ra"]:
            rough = tb.Roughness.from_drawing(tb.surfaces.Finish(Ra=Ra, process=process))
            assert rough.ranges["R"][0] > 1e-6


def test_what_is_known_better_stays():
    rough = study('[roughness]\nRa = "0.2 um"\nR = "10 um"').contact.roughness
    assert rough.replace(finish=()) == tb.Roughness(sigma=ROOT * 0.2e-6, R=10e-6)
    assert rough.ranges == {}
    rough = study('[roughness]\nRa = "0.2 um"\nprocess = "ground"\nR = "10 um"').contact.roughness
    assert (rough.R, list(rough.ranges)) == (10e-6, ["alpha", "eta_R_sigma"])
    rough = study('[roughness]\nRa = "0.2 um"\nprocess = "ground"\neta = 1e11').contact.roughness
    assert (rough.eta, rough.eta_R_sigma, list(rough.ranges)) == (1e11, None, ["R", "alpha"])


def test_error_bars_carry_the_ranges():
    contact = study(FACES).contact
    carried = stated_ranges(contact)
    assert [name for name in carried if name.startswith("roughness")] == [
        "roughness.R",
        "roughness.alpha",
        "roughness.eta_R_sigma",
    ]
    moved = contact.replace(**{"roughness.R": 5e-6})
    assert "roughness.R" not in stated_ranges(moved)
    plain = tb.assess(contact, pressure=5e7, samples=64)
    assert any(
        "finishing process, from memory: mean asperity radius" in note for note in plain.notes
    )


def test_other_roughness_says_nothing_new():
    rough = tb.Roughness(sigma=1e-7, R=3e-6)
    assert "finish" not in rough.to_dict()
    stated = study(FACES).contact.roughness
    assert tb.Roughness.from_dict(stated.to_dict()) == stated


@pytest.mark.parametrize(
    ("roughness", "words"),
    [
        ('Ra = "0.2 um"', ["roughness.R is missing", "not how sharp", "ground", "R = ", "x3p"]),
        ('Ra = "0.2 um"\nprocess = "grund"', ['did you mean "ground"?']),
        ('Ra = "20 um"\nprocess = "ground"', ["20 µm is not the height of a ground face"]),
        ('process = "ground"', ["roughness has no height", "Ra, Rq or Rz"]),
        ('sigma = "1 um"\nprocess = "ground"', ["goes with the height of a drawing"]),
        ('Ra = "1 um"\nsigma = "1 um"\nR = "9 um"', ["only one of these can be given"]),
        ('Ra = "1 um"\nfirst = { Ra = "1 um" }', ["that of the pair", "that of a face"]),
        ('first = { Ra = "1 um" }\nprocess = "ground"', ["roughness.second is missing"]),
        ('first = { Ra = "1 um", R = 1 }\nsecond = { Ra = "1 um" }', ["roughness.first.R = 1"]),
    ],
)
def test_mistakes(roughness, words):
    (sentence,) = problems("[roughness]\n" + roughness)
    for word in words:
        assert word in sentence


def test_set_changes_a_height():
    text = '[roughness]\nRa = "0.2 um"\nprocess = "ground"'
    found = study(text, 'roughness.Rz="1.6 um"').contact.roughness
    assert found.finish == (tb.surfaces.Finish(Rz=1.6e-6, process="ground"),)
    again = study(FACES, "roughness.first.Ra=0.4 um").contact.roughness
    assert again.finish[0].Ra == pytest.approx(0.4e-6, rel=1e-15)


def test_every_pair_of_processes_solves():
    steel = tb.MaterialPair(tb.materials["100Cr6"], tb.materials["100Cr6"])
    for first, second in itertools.pairwise(processes()):
        faces = (tb.surfaces.Finish(Ra=2.5e-7, process=each) for each in (first, second))
        contact = tb.Contact(surfaces=steel, roughness=tb.Roughness.from_drawing(*faces))
        assert tb.solve(contact, pressure=5e6).status == "ok"
