"""Elastic asperities of broad spectra: what they lose against boundary elements, and who says so."""

import json
import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.errors import code_of, note_of

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "reference" / "dust.json"
HARD = tb.Material(E=206e9, nu=0.3, H=1e15)
"""Never yields."""
MCCOOL = {
    5.0: {0.001: 2.34, 0.01: 1.99, 0.1: 1.46},
    11.6: {0.01: 1.66, 0.05: 1.42, 0.1: 1.30},
    50.0: {0.001: 1.37, 0.01: 1.23, 0.1: 1.02},
    667.0: {0.01: 0.71, 0.1: 0.63},
}
"""Real area over p/(E*g) by α and p/(E*g)."""
ELEMENTS = {0.01: 2.36, 0.05: 2.22, 0.1: 2.10}
"""The same of boundary elements at α = 11.6."""


def contact(alpha, material=HARD, **more):
    """All of one spectrum: ηRσ belongs to α."""
    rough = tb.Roughness(
        sigma=100e-9, R=2.8e-6, alpha=alpha,
        eta_R_sigma=3 / 8 / (6 * math.sqrt(3 * math.pi)) * math.sqrt(alpha),
    )  # fmt: skip
    law = tb.asperity.GW()
    pair = tb.MaterialPair(material, material)
    return tb.Contact(surfaces=pair, roughness=rough, asperity_law=law, **more)


def slope(rough):
    """g, the RMS slope: m_2 = √(m_0 m_4/α) with R = 3√π/(8√m_4)."""
    m_4 = (3 * math.sqrt(math.pi) / (8 * rough.R)) ** 2
    return math.sqrt(2 * math.sqrt(rough.sigma**2 * m_4 / rough.alpha))


def areas(alpha, loads):
    """A/(p/E*g) of asperities and after Persson."""
    case = contact(alpha)
    pressure = np.array(loads) * case.E_ss * slope(case.roughness)
    table = tb.compare(case, pressure=pressure, laws=["gw", "persson"])
    return [table.A_t.sel(law=law).values / np.array(loads) for law in ("gw", "persson")]


@pytest.mark.parametrize("alpha", list(MCCOOL))
def test_area_of_elastic_asperities(alpha):
    asperities, persson = areas(alpha, list(MCCOOL[alpha]))
    np.testing.assert_allclose(asperities, list(MCCOOL[alpha].values()), rtol=0, atol=0.0055)
    np.testing.assert_allclose(persson, [1.60, 1.59, 1.59][: len(persson)], rtol=0, atol=0.01)


@pytest.mark.check
def test_the_area_after_persson():
    case = contact(7.0)
    p = np.array([1e5, 1e8, 1e11])
    table = tb.compare(case, pressure=p).sel(law="persson")
    wanted = [math.erf(math.sqrt(2) * x / (case.E_ss * slope(case.roughness))) for x in p]
    np.testing.assert_allclose(table.A_t, wanted, rtol=1e-14)
    assert np.all(np.isnan(table.d))
    assert "second opinion" in table.note.item()
    dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
                        diameter=tb.distributions.Monodisperse(mean=3e-7))  # fmt: skip
    # bodies that yield: the ground under particles on those that never do takes a minute
    dusty = contact(7.0, tb.materials["S45C"], particles=dust)
    assert "persson" not in tb.compare(dusty, pressure=p).law
    asked = tb.compare(dusty, pressure=p, laws="persson").sel(law="persson")
    assert "knows no particles" in asked.note.item()


@pytest.mark.skipif(not SHARED.exists(), reason="needs the shared reference values")
def test_the_other_implementation():
    given = [
        each for each in json.loads(SHARED.read_text("utf-8"))["values"]
        if each["topic"] == "elastic sums" and "McCool" in each["quantity"]
    ]  # fmt: skip
    assert len(given) == 2
    for each in given:
        case = contact(each["inputs"]["alpha"])
        rough = case.roughness
        state = tb.solve(case, d=each["inputs"]["h_over_sigma"] * rough.sigma - rough.y_s)
        found = float(state.pressure) / (case.E_ss * slope(rough))
        assert found == pytest.approx(each["value"], rel=each["rel_tol"])


def told(case, **load):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tb.solve(case, **load)
    notes = [note_of(each.message) for each in caught]
    return [note for note in notes if code_of(note) == "alpha"]


def test_elastic_asperities_of_a_broad_spectrum_are_told_of():
    (text,) = told(contact(12.0), pressure=[1e6, 1e7])
    assert code_of(text) == "alpha"
    assert "alpha = 12" in text
    assert "30 to 38 %" in text
    assert told(contact(8.0), pressure=1e6) == []
    soft = tb.Material(E=206e9, nu=0.3, H=1e9)
    yielding = contact(12.0, soft).replace(asperity_law=tb.asperity.ZMC())
    assert told(yielding, pressure=1e6) == []


def test_they_are_not_told_of_where_particles_are_all():
    dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e10,
                        diameter=tb.distributions.Monodisperse(mean=3e-6))  # fmt: skip
    dusty = contact(12.0, tb.materials["S45C"], particles=dust)
    assert told(dusty, pressure=1e3) == []
    assert told(dusty.replace(particles=None), pressure=1e3) != []


def test_the_table_of_the_page():
    """What docs/validation.md says is lost."""
    text = (ROOT / "docs" / "validation.md").read_text("utf-8")
    for load, elements in ELEMENTS.items():
        own, persson = (float(each[0]) for each in areas(11.6, [load]))
        (row,) = re.findall(rf"^\| 11\.6 \| {load:g} \|(.*)\|$", text, re.M)
        cells = [cell.strip() for cell in row.split("|")]
        lost = [f"{100 * (1 - value / elements):.0f} %" for value in (own, persson)]
        assert cells == [f"{elements:.2f}", f"{own:.2f}", lost[0], f"{persson:.2f}", lost[1]]
