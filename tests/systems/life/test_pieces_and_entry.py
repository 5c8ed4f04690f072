"""Pieces of broken particles, layers of oil, debris, and the entry ratio from dents."""

import math

import numpy as np
import pytest
from refusals import refuses

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.systems.film_conditions import Entrainment
from thirdbody.systems.life.debris import Debris
from thirdbody.systems.life.entry import entry_ratio_from_dents, oil_layer
from thirdbody.systems.life.pieces import break_up, daughters
from thirdbody.systems.life.size_classes import SizeClasses
from thirdbody.systems.oil_particles import FilmParticles

QUARTERS = SizeClasses.covering(smallest=0.25e-6, largest=64e-6)


def test_halves_fall_four_classes_down_and_are_eight():
    B = daughters(QUARTERS, ratio=0.5)
    np.testing.assert_allclose(np.diag(B, 4), 8.0, rtol=1e-12)
    assert np.count_nonzero(B) == QUARTERS.count - 4


@pytest.mark.parametrize("ratio", [0.5, 0.37, 0.71])
def test_breaking_keeps_volume_and_number(ratio):
    B, v = daughters(QUARTERS, ratio=ratio), QUARTERS.volumes
    whole = np.flatnonzero(v * ratio**3 > v[0])
    np.testing.assert_allclose((v @ B)[whole], v[whole], rtol=1e-12)
    np.testing.assert_allclose(B.sum(axis=0)[whole], ratio**-3, rtol=1e-12)


def test_what_all_breaks_goes_on_until_nothing_breaks():
    b = np.array([0.0] * 8 + [1.0] * 24)
    C = break_up(b, classes=QUARTERS, ratio=0.5)
    np.testing.assert_allclose(QUARTERS.volumes @ C, QUARTERS.volumes, rtol=1e-12)
    assert C[7, 31] == pytest.approx(8**6, rel=1e-12)


def test_cascade_against_its_printed_numbers():
    """Three classes a factor 2 apart, λ = 1e-3, b = 5e-4, 5e-4, 0 1/s, r = 1e6 into the largest."""
    classes = SizeClasses(edges=(1e-6, 2e-6, 4e-6, 8e-6))
    B, v = daughters(classes, ratio=0.5), classes.volumes
    loss, b = 1e-3, np.array([0.0, 5e-4, 5e-4])
    r = np.array([0.0, 0.0, 1e6])
    n = np.linalg.solve(np.diag(loss + b) - B * b, r)
    assert [f"{each:.5e}" for each in n[::-1]] == ["6.66667e+08", "1.77778e+09", "7.11111e+09"]
    assert loss * (v @ n) / (v @ r) == pytest.approx(1.0, rel=1e-12)


def test_layers_of_oil_are_those_of_entrainment():
    sizes = QUARTERS.distribution(np.ones(QUARTERS.count))
    counts = np.ones(QUARTERS.count) / QUARTERS.count
    for film, mu in ((2e-7, 0.05), (3.3e-6, 0.02), (2e-5, 0.1)):
        for height in ("size", "film"):
            dirt = Entrainment(concentration=1e-5, entry_ratio=1.0, friction=mu, height=height)
            exact = dirt.areal_density(sizes, h=film, R=9.5e-3) / dirt.per_volume(sizes)
            largest = film + 2 * mu**2 * 9.5e-3
            layer = oil_layer(QUARTERS, film=film, largest=largest, height=height)
            assert counts @ layer == pytest.approx(exact, rel=1e-9)


def test_the_entry_ratio_comes_back_from_the_dents_that_it_makes():
    steel = tb.materials["S45C"]
    for entry in (1e-3, 0.2):
        oil = FilmParticles.from_iso4406(
            "18/16/13", surfaces=tb.MaterialPair(steel, steel), material=tb.materials["SiO2"],
            film=0.5e-6, entry=entry,
        )  # fmt: skip
        for side in (1, 2):
            count = float(oil.after(1e7, side=side)) * 2e-6
            found = entry_ratio_from_dents(
                count, area=2e-6, overrollings=1e7, oil=oil.replace(entry=0.5), side=side
            )
            assert found == pytest.approx(entry, rel=1e-9)
    with refuses(Mistake.BEYOND, "count", value="1e+12"):
        entry_ratio_from_dents(1e12, area=1e-6, overrollings=1.0, oil=oil)


def test_shares_of_debris_are_by_volume_and_add_up():
    debris = Debris.boundary_lubricated()
    phi = debris.shares(QUARTERS)
    assert phi.sum() == pytest.approx(1.0, rel=1e-14)
    # volume of a log-normal: median moved by 3 ln² gsd
    s, middle = math.log(1.6), math.log(0.4e-6) + 3 * math.log(1.6) ** 2
    low, high = QUARTERS.ends
    z = [(math.log(x) - middle) / s / math.sqrt(2) for x in (low[6], high[6])]
    assert phi[6] == pytest.approx(0.5 * (math.erf(z[1]) - math.erf(z[0])), rel=1e-6)
    assert any("estimate" in note for note in debris.notes(QUARTERS))


def test_debris_has_the_hardness_of_its_surface_or_its_own():
    steel = tb.materials["S45C"]
    assert Debris.boundary_lubricated().material(steel, name="debris").H == steel.H
    hard = Debris.from_report(sizes=[1e-6, 2e-6], counts=[1.0], hardness=9e9)
    assert hard.material(steel, name="debris").H == 9e9
