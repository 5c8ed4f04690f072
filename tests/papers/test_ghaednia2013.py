"""The trends that Ghaednia and Jackson (2013) state, in the reconstructed two-submodel contact."""

import numpy as np
import pytest

from thirdbody.papers import ghaednia2013 as study
from thirdbody.papers.ledger import NO_SOURCE, OWN, REPORTED, SEEN, WORDS

READINGS = ("stack", "fractal")


@pytest.fixture(scope="module")
def ledger(ledger_of):
    return ledger_of(study.STUDY)


VERDICTS = {
    "area": ("pass", "pass"),
    "linear": ("pass", "pass"),
    "size": ("pass", "pass"),
    "distribution": ("fail", "pass"),
    "both-carry": ("pass", "pass"),
    "scratch": ("pass", "pass"),
    "friction": ("not reproduced", "not reproduced"),
    "wear": ("not reproduced", "not reproduced"),
    "density": ("not sourced", "not sourced"),
    "roughness": ("not sourced", "not sourced"),
    "stiffness": ("not sourced", "not sourced"),
    "hardness": ("not sourced", "not sourced"),
}


@pytest.mark.check
def test_verdicts(ledger):
    stated = [claim.id for claim in study.STUDY.claims if claim.standing != OWN]
    assert {id: tuple(ledger[name][id].word for name in READINGS) for id in stated} == VERDICTS


@pytest.mark.parametrize(
    ("reading", "claim", "values"),
    [
        ("stack", "area", [0.02305, 0.02311]),
        ("fractal", "area", [0.008096, 0.03078]),
        ("stack", "linear", [0.99998, 1.0]),
        ("fractal", "linear", [1.0066, 1.0086]),
        ("fractal", "size", [1.217]),
        ("stack", "distribution", [1.088]),
        ("fractal", "distribution", [1.104]),
        ("fractal", "scratch", [0.9358]),
        ("fractal", "hardness", [0.5033]),
        ("fractal", "bare", [1.239, 1.244]),
        ("fractal", "soft", [0.1077]),
    ],
)
def test_values(ledger, reading, claim, values):
    assert ledger[reading][claim].measured.values == pytest.approx(values, rel=1e-3)


def test_every_claim_says_where_it_comes_from():
    for claim in study.STUDY.claims:
        assert claim.standing in {SEEN, REPORTED, NO_SOURCE, OWN}, claim.id
        assert claim.place, claim.id
    assert study.model("stack").provenance == "reconstructed"


def test_words_are_the_known_ones(ledger):
    assert {verdict.word for one in ledger.values() for verdict in one.values()} <= set(WORDS)


def test_where_the_trends_end(ledger):
    """Both surfaces are in full contact by then, and the patches touch at p = P_p(0)."""
    from thirdbody.systems.fractal import ParticleFilm

    closed = ParticleFilm(study.model("stack"))(np.zeros(1))[0, 0]
    for name in READINGS:
        pressure, ratio = ledger[name]["end"].measured.values
        assert pressure == pytest.approx(closed, rel=1e-8)
        assert ratio == pytest.approx(1, rel=1e-6)
        just_below = study.READINGS[name].trend(0.999 * pressure).ratio[0]
        assert just_below < 0.11


def test_area_is_linear_though_the_bare_area_is_not():
    state = study.model("fractal").solve(study.PRESSURES)
    bare = np.polyfit(np.log(state.pressure), np.log(state.A_0), 1)[0]
    real = np.polyfit(np.log(state.pressure), np.log(state.A_real), 1)[0]
    assert bare > 1.2
    assert real == pytest.approx(1, abs=0.02)


def test_more_and_larger_particles_keep_the_surfaces_further_apart():
    small, large = (study.model("stack", x).solve(1e6) for x in (60e-9, 120e-9))
    assert large.gap > small.gap > 0
    few = study.model("stack").replace(**{"particles.areal_density": 1.9e13})
    assert few.solve(1e6).gap < study.model("stack").solve(1e6).gap


def test_the_stack_says_that_it_has_not_converged():
    assert "not converged" in study.model("stack").solve(1e6).warnings[0]
    assert study.model("fractal").solve(1e6).warnings == ()
