"""Fewer than one contact in the area that is asked about: open, NaN or told, never a bare number."""

import math
import warnings
from importlib import resources

import numpy as np
import pytest
from scipy.stats import norm

import thirdbody as tb
from thirdbody.effects import ElectricalConductance, ThermalConductance
from thirdbody.study import load_study, run_study

BODY = tb.Material(
    E=110e9, nu=0.34, H=1.3e9, resistivity=6e-8, thermal_conductivity=60.0,
    density=8700, specific_heat=380,
)  # fmt: skip
ROUGH = tb.Roughness(sigma=200e-9, R=5e-6)
A_N = 1e-6


def at(d_star, *outputs):
    """Outputs and sentences of clean surfaces at separations over σ_s."""
    contact = tb.Contact(surfaces=tb.MaterialPair(BODY, BODY), roughness=ROUGH, outputs=outputs)
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = tb.solve(contact, d=d_star * ROUGH.sigma_s).outputs
    return found, [str(each.message) for each in heard]


def spots(d_star):
    """Contacts in A_n on average: η A_n Q(d/σ_s)."""
    return ROUGH.density * A_N * norm.sf(d_star)


OPEN, CLOSED = norm.isf(np.array([0.3, 3.0]) / (ROUGH.density * A_N))
"""Separations at which A_n holds 0.3 and 3 contacts on average."""


def test_probability_is_that_of_any_of_many_asperities():
    """Of M asperities, each high enough with probability Q: 1 − (1 − Q)^M."""
    M = ROUGH.density * A_N
    assert M > 1e4
    for d in (OPEN, CLOSED):
        found, _ = at(d, ElectricalConductance(A_n=A_N), ThermalConductance(A_n=A_N))
        want = -np.expm1(M * np.log1p(-norm.sf(d)))
        assert found["gc_closed"] == pytest.approx(want, rel=1e-4)
        assert found["hc_closed"] == pytest.approx(want, rel=1e-4)


def test_below_one_contact_it_is_open():
    assert spots(OPEN) == pytest.approx(0.3, rel=1e-9)
    found, told = at(OPEN, ElectricalConductance(A_n=A_N), ThermalConductance(A_n=A_N, k_gap=0.025))
    for name in ("gc", "gc_ss", "gc_sa", "rho_c", "hc", "hc_ss", "hc_sa"):
        assert math.isnan(found[name]), name
    assert found["hc_gap"] > 0
    for name in ("electrical", "thermal"):
        (text,) = [text for text in told if f"outputs.{name}_conductance: A_n" in text]
        assert "holds 0.3 contacts that conduct on average: it is open" in text
        assert "closed with probability 0.259" in text


def test_the_mean_where_it_is_asked_for():
    """The number that is given above one contact, continued, and told."""
    found, told = at(OPEN, ElectricalConductance(A_n=A_N, few="mean"))
    same, _ = at(OPEN, ElectricalConductance())
    assert found["gc"] == same["gc"] > 0
    assert any("most such areas are open" in text for text in told)
    above, told = at(CLOSED, ElectricalConductance(A_n=A_N))
    assert above["gc"] == at(CLOSED, ElectricalConductance())[0]["gc"]
    assert not any("open" in text for text in told)


def test_without_an_area_the_area_of_one_contact_is_told():
    found, told = at(OPEN, ElectricalConductance())
    assert found["gc"] > 0
    assert math.isnan(found["gc_closed"])
    assert any("one contact conducts in 3.333×10⁻⁶ m²" in text for text in told)
    assert not any(
        "one contact conducts" in text for text in at(CLOSED, ElectricalConductance())[1]
    )


def test_heat_and_counts_say_it():
    """The hottest of less than ln 2 contacts has no median: NaN and a reason."""
    friction = tb.outputs.Friction(tau_ss=3e8)
    found, told = at(OPEN, friction, tb.outputs.FlashTemperature(v=1.0, A_n=A_N))
    assert math.isnan(found["dT_ss_peak"])
    assert any("dT_ss_peak is NaN" in text for text in told)
    assert any("outputs.friction, outputs.flash_temperature give the mean" in t for t in told)
    found, told = at(CLOSED, friction, tb.outputs.FlashTemperature(v=1.0, A_n=A_N))
    assert found["dT_ss_peak"] > 0
    assert not any("NaN" in text or "give the mean" in text for text in told)
    _, told = at(OPEN, tb.outputs.Counts(A_n=A_N))
    assert any("holds 0.3 contacts on average: outputs.counts give" in text for text in told)
    assert not at(OPEN, tb.outputs.Counts())[1]


def test_the_template_is_open_at_its_smallest_force():
    """0.1 N on 1 mm² rest on dust: no metal touches, and no 7 GΩ is given."""
    path = resources.files("thirdbody").joinpath("data/studies/electrical.toml")
    with resources.as_file(path) as file:
        found = run_study(load_study(file))
    states = found["states"]
    closed = np.array(states["gc_closed"], float)
    assert closed[0] < 1e-9
    assert closed[-1] > 0.999
    for resistance, chance in zip(states["rho_c"], closed, strict=True):
        assert (resistance is None) == (chance < -math.expm1(-1.0))
    assert any("A_n = 1×10⁻⁶ m² holds" in text for text in found["warnings"])


def test_where_nothing_touches_nothing_is_the_mean_of_few():
    """No area holds a contact, so none is a mean "over many, most of which hold none"."""
    contact = tb.Contact(
        surfaces=tb.MaterialPair(BODY, BODY), roughness=ROUGH,
        outputs=(tb.outputs.Counts(A_n=A_N), ElectricalConductance(A_n=A_N)),
    )  # fmt: skip
    state = tb.solve(contact, d=60 * ROUGH.sigma_s)
    assert state.outputs["n_ss"] == state.outputs["gc_closed"] == 0
    assert not any("on average" in text or "probability" in text for text in state.warnings)
    assert any("nothing touches in this state: there" in t for t in state.warnings)
    assert any("nothing conducts where least does: A_n is open" in t for t in state.warnings)
    both = tb.solve(contact, d=np.array([OPEN, 60.0]) * ROUGH.sigma_s)
    told = "\n".join(both.warnings)
    assert "nothing touches in 1 of 2 states" in told
    assert "holds 0.3 contacts on average" in told
