"""Elastic particles: rigid and deformable balls, and elastic balls beside elastic asperities.

The last is the model of Ghaednia, Jackson and Gao 2014 as reconstructed: asperities of Greenwood
and Williamson and elastic particles in parallel, at one separation. Their equations could not
be obtained.
"""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import thirdbody as tb
from thirdbody.contact.interface import interface
from thirdbody.contact.particle_sums import particle_sum
from thirdbody.laws.asperity import GW, JG, Hermite
from thirdbody.laws.particle import Series

UNIT = tb.Material(E=2.0, nu=0.0, H=0.02)
PAIR = tb.MaterialPair(UNIT, UNIT)
SMOOTH = tb.Roughness(sigma=1.0, R=1e3)
ELASTIC = Series(deep="off", law=GW(), seat="plane", shadow="none")


def hertz(x, gap, E_1=1.0, E_2=1.0):
    """Two elastic contacts of tip radius x/2 in series: compliances add as E^(−2/3)."""
    modulus = (E_1 ** (-2 / 3) + E_2 ** (-2 / 3)) ** -1.5
    return 4 / 3 * modulus * np.sqrt(x / 2) * np.maximum(x - gap, 0.0) ** 1.5


def population(**more):
    options = dict(
        material=UNIT,
        diameter=tb.TruncatedGaussian(mean=1.0, std=0.25, n=12),
        areal_density=1e-2,
    )
    return tb.Particles(**(options | more))


@pytest.mark.parametrize(
    ("gap", "F"),
    [
        (0.4, 0.1759720852204),
        (0.8, 0.05363059197418),
        (1.0, 0.02084518543302),
        (1.2, 0.005714222676499),
        (1.6, 1.124458950242e-4),
        (2.0, 2.70063045494e-7),
    ],
)
def test_elastic_particles_of_gaussian_size(gap, F):
    """Per particle over E* x_a², x_a = 1, σ_a = 1/4; sizes without a cut."""
    dust = population()
    response = particle_sum(ELASTIC, PAIR, SMOOTH, dust)
    load = response.fields(np.array([gap]))["F_sa"][0] / dust.areal_density
    # the cut at zero is of no weight above a gap, but is normalised away
    assert load * dust.diameter.retained_mass == pytest.approx(F, rel=1e-10)


@pytest.mark.parametrize("gap", [0.3, 0.7, 0.99])
def test_one_deformable_ball(gap):
    state = ELASTIC.single(1.0, gap, surfaces=PAIR, particle=UNIT)
    assert state["force"] == pytest.approx(hertz(1.0, gap), rel=1e-13)
    assert state["force"] == pytest.approx(4 / 3 * math.sqrt(0.5) * ((1 - gap) / 2) ** 1.5)
    assert state["area_1"] == pytest.approx(math.pi * 0.5 * (1 - gap) / 2, rel=1e-13)
    assert state["regime"] == "elastic"


@pytest.mark.parametrize("gap", [0.75, 0.9, 0.999])
def test_unlike_sides_share_by_stiffness(gap):
    soft, hard = UNIT, tb.Material(E=34.0, nu=0.3, H=1.0)
    ball = tb.Material(E=5.0, nu=0.2, H=0.1)
    moduli = [tb.MaterialPair(side, ball).E_star for side in (soft, hard)]
    state = ELASTIC.single(1.0, gap, surfaces=tb.MaterialPair(soft, hard), particle=ball)
    assert state["force"] == pytest.approx(hertz(1.0, gap, *moduli), rel=1e-12)
    ratio = (moduli[1] / moduli[0]) ** (2 / 3)
    assert state["delta_1"] / state["delta_2"] == pytest.approx(ratio, rel=1e-12)


def test_rigid_ball_and_rigid_flat():
    """A rigid side takes no approach; a rigid ball indents each surface by its own modulus."""
    rigid = tb.Material(E=2e12, nu=0.0, H=1e9)
    gap = 0.8
    flat = ELASTIC.single(1.0, gap, surfaces=tb.MaterialPair(UNIT, rigid), particle=rigid)
    assert flat["force"] == pytest.approx(4 / 3 * 2 * math.sqrt(0.5) * 0.2**1.5, rel=1e-7)
    assert flat["delta_2"] < 1e-6
    ball = ELASTIC.single(1.0, gap, surfaces=PAIR, particle=rigid)
    assert ball["force"] == pytest.approx(2 * hertz(1.0, gap), rel=1e-10)


@pytest.mark.parametrize("gap", [0.05, 0.5, 0.9])
def test_hard_materials_are_elastic(gap):
    # k H reached only where each side has taken more than x/2
    hard = tb.Material(E=2.0, nu=0.0, H=1.2)
    law = Series(deep="off", law=Hermite(), seat="plane")
    pair = tb.MaterialPair(hard, hard)
    state = law.single(1.0, gap, surfaces=pair, particle=hard)
    assert state["force"] == pytest.approx(hertz(1.0, gap), rel=1e-12)


@pytest.mark.parametrize("law", [GW(), JG(nu=0.3)])
@pytest.mark.parametrize("second", [UNIT, tb.Material(E=0.3, nu=0.3, H=0.004)])
def test_past_the_great_circle_nothing_grows(law, second):
    """Laws without a plastic pressure end there: load and areas stay, whatever the gap."""
    series = ELASTIC.replace(law=law)
    gap = np.linspace(-5.0, 0.999, 400)
    state = series.single(1.0, gap, surfaces=tb.MaterialPair(UNIT, second), particle=UNIT)
    assert np.all(np.diff(state["force"]) <= 1e-15)
    assert np.ptp(state["force"][gap < -1.5]) == 0
    assert_allclose(state["delta_1"] + state["delta_2"], 1 - gap, rtol=1e-12)
    areas = np.maximum(state["area_1"], state["area_2"])
    assert areas.max() == pytest.approx(math.pi / 4, rel=1e-12)
    assert "plastic" not in state["regime"]


@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize("sizes", ["one", "many"])
def test_sums_agree_with_the_single_ball_at_any_gap(seat, sizes):
    """Populations, deep inside too, by direct quadrature over size and seat."""
    law = ELASTIC.replace(seat=seat)
    diameter = {
        "one": tb.distributions.Monodisperse(mean=1.0),
        "many": tb.distributions.Uniform(low=0.9, high=1.1),
    }[sizes]
    dust = population(diameter=diameter)
    rough = tb.Roughness(sigma=0.5, R=1e3)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    x = np.array([1.0]) if sizes == "one" else 1 + 0.1 * nodes
    share = np.array([1.0]) if sizes == "one" else 0.5 * weights
    response = particle_sum(law, PAIR, rough, dust)

    def at(gap):
        state = law.single(x, gap, surfaces=PAIR, particle=UNIT)
        return float(share @ state["force"])

    for d in (-1.5, 0.2, 0.7):
        if seat == "plane":
            expected = at(d)
        else:
            marks = [d + rough.y_s - edge for edge in (0, 1)]
            expected = quad(
                lambda z, d=d: (
                    at(d + rough.y_s - z) * math.exp(-2 * z * z) / math.sqrt(math.pi / 2)
                ),
                -5,
                5,
                points=[m for m in marks if abs(m) < 5],
                epsabs=1e-11,
                epsrel=1e-9,
                limit=300,
            )[0]
        found = response.fields(np.array([d]))["F_sa"][0] / dust.areal_density
        assert found == pytest.approx(expected, rel=1e-7)


def test_elastic_asperities_and_particles_in_parallel():
    """Loads add at one separation; every term is a Hertz integral."""
    steel, glass = tb.materials["S45C"], tb.materials["SiO2"]
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    dust = tb.Particles(
        material=glass,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        areal_density=1e11,
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=rough,
        asperity_law=GW(),
        particles=dust,
        particle_law=ELASTIC,
    )
    E_sa = tb.MaterialPair(steel, glass).E_star
    sizes = dust.diameter
    for d in (180e-9, 260e-9):
        summit = quad(
            lambda t, d=d: t**1.5 * math.exp(-0.5 * (d / rough.sigma_s + t) ** 2),
            0,
            np.inf,
            epsrel=1e-12,
        )[0] / math.sqrt(2 * math.pi)
        asperities = rough.density * 4 / 3 * contact.E_ss * math.sqrt(rough.R)
        asperities *= rough.sigma_s**1.5 * summit
        inside = quad(
            lambda x, d=d: float(sizes.pdf(x) * hertz(x, d)),
            max(d, sizes.support[0]),
            sizes.support[1],
            epsrel=1e-10,
        )[0]
        load = asperities + dust.areal_density * E_sa * inside
        assert interface(contact).load(np.array([d]))[0, 0] == pytest.approx(load, rel=1e-8)
        state = tb.solve(contact, pressure=load)
        assert state.d == pytest.approx(d, rel=1e-7)
        assert state.A_p == state.A_ep == 0
