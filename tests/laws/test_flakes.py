"""Flakes: values, the sphere as a limit, scaling laws, caps."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import thirdbody as tb
from thirdbody.contact.particle_sums import particle_sum
from thirdbody.equilibrium.states import state_columns
from thirdbody.laws.asperity import GW, ZMC
from thirdbody.laws.particle import Flakes, Series

UNIT = tb.Material(E=2.0, nu=0.0, H=0.02)
PAIR = tb.MaterialPair(UNIT, UNIT)
"""E* = 1 on both sides."""

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SURFACES = tb.MaterialPair(STEEL, STEEL.replace(H=3e9))
ROUGH = tb.Roughness(sigma=100e-9, R=2.8e-6)
FLAKES = tb.Particles(
    material=SILICA, diameter=tb.TruncatedGaussian(mean=80e-9, std=12e-9), areal_density=2e11
)


def contact(law, particles=FLAKES):
    return tb.Contact(surfaces=SURFACES, roughness=ROUGH, particles=particles, particle_law=law)


@pytest.mark.parametrize(
    ("tau", "gap", "F", "A", "F_elastic"),
    [
        (1.0, 0.9, 0.0031415926535898, 0.15707963267949, 0.010540925533895),
        (0.5, 0.45, 0.0031415926535898, 0.15707963267949, 0.0052704627669473),
        (0.5, 0.4, 0.0062831853071796, 0.31415926535898, 0.014907119849999),
        (0.2, 0.19, 0.00060274508128351, 0.040116242623032, 0.00074535599249993),
        (0.2, 0.15, 0.0058131360502794, 0.29810664936357, 0.0083333333333333),
        (0.1, 0.05, 0.0081601803300515, 0.45258444509276, 0.011785113019776),
        (0.1, 0.02, 0.015017523036084, 0.78539816339745, 0.023851391759998),
    ],
)
def test_one_flake(tau, gap, F, A, F_elastic):
    """D = 1, E* = 1, H = 0.02; the last one is pressed to its full face."""
    law = Flakes(aspect=1 / tau)
    state = law.single(tau, gap, surfaces=PAIR, particle=UNIT)
    assert state["force"] == pytest.approx(F, rel=1e-12)
    assert state["area_1"] == pytest.approx(A, rel=1e-12)
    assert state["area_2"] == pytest.approx(A, rel=1e-12)
    elastic = law.replace(law=GW()).single(tau, gap, surfaces=PAIR, particle=UNIT)
    assert elastic["force"] == pytest.approx(F_elastic, rel=1e-12)


@pytest.mark.parametrize("options", [{}, {"seat": "plane"}, {"law": ZMC(), "shadow": "projected"}])
def test_aspect_one_is_a_sphere_to_the_last_bit(options):
    d = np.linspace(-300e-9, 500e-9, 101)
    one, two = (
        particle_sum(law, SURFACES, ROUGH, FLAKES)
        for law in (Flakes(aspect=1, **options), Series(deep="off", **options))
    )
    for ours, sphere in zip(one.load(d), two.load(d), strict=True):
        assert np.array_equal(ours, sphere)
    fields, spheres = one.fields(d), two.fields(d)
    assert fields.keys() == spheres.keys()
    assert all(np.array_equal(fields[key], spheres[key]) for key in fields)


@pytest.mark.parametrize("aspect", [2.0, 5.0])
def test_plastic_and_elastic_loads_scale_with_shape(aspect):
    """At one thickness and gap: D²/τ when plastic, D/√τ when elastic."""
    x, gap = 1.0, 0.8
    ductile = tb.Material(E=2000.0, nu=0.0, H=0.02)
    pair = tb.MaterialPair(ductile, ductile)
    flake, ball = (
        Flakes(aspect=a).single(x, gap, surfaces=pair, particle=ductile) for a in (aspect, 1.0)
    )
    assert flake["regime"] == "plastic"
    assert flake["force"] == pytest.approx(aspect**2 * ball["force"], rel=1e-12)
    assert flake["force"] == pytest.approx(0.5 * math.pi * 0.02 * aspect**2 * 0.2, rel=1e-12)
    flake, ball = (
        Flakes(aspect=a, law=GW()).single(x, gap, surfaces=PAIR, particle=UNIT)
        for a in (aspect, 1.0)
    )
    assert flake["force"] == pytest.approx(aspect * ball["force"], rel=1e-12)


def test_neither_area_nor_load_passes_the_face():
    aspect, tau = 4.0, 1.0
    gap = np.linspace(-1.0, 1.0, 200)[:-1]
    state = Flakes(aspect=aspect).single(tau, gap, surfaces=PAIR, particle=UNIT)
    face = math.pi * aspect**2 / 4
    assert state["area_1"].max() == pytest.approx(face, rel=1e-12)
    assert np.all(state["force"] <= UNIT.H * face * (1 + 1e-12))
    assert np.all(np.diff(state["force"]) <= 1e-15)


def test_two_unlike_sides_balance():
    law = Flakes(aspect=3.0)
    tau, gap = 80e-9, np.linspace(20e-9, 79e-9, 20)
    state = law.single(tau, gap, surfaces=SURFACES, particle=SILICA)
    tip = 3.0**2 * tau / 2
    assert_allclose(state["delta_1"] + state["delta_2"], tau - gap, rtol=1e-12)
    face = math.pi * (3 * tau) ** 2 / 4
    for surface, side in ((SURFACES.first, "1"), (SURFACES.second, "2")):
        pair = tb.MaterialPair(surface, SILICA)
        keys = dict(R=tip, E_star=pair.E_star, H=pair.H)
        pressure = law.law.mean_pressure(state[f"delta_{side}"], **keys)
        area = np.minimum(law.law.area(state[f"delta_{side}"], **keys), face)
        inside = area < face
        assert_allclose(state[f"area_{side}"], area, rtol=1e-11)
        assert_allclose(state["force"][inside], (pressure * area)[inside], rtol=1e-11)


def test_population_is_the_average_over_thickness():
    law = Flakes(aspect=3.0, seat="plane")
    sizes = FLAKES.diameter
    gap = 60e-9
    field = particle_sum(law, SURFACES, ROUGH, FLAKES).fields(np.array([gap]))
    edges = np.linspace(max(gap, sizes.support[0]), sizes.support[1], 1001)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    half = 0.5 * np.diff(edges)[:, None]
    x = (edges[:-1, None] + half * (1 + nodes)).ravel()
    share = (half * weights).ravel() * sizes.pdf(x)
    one = law.single(x, gap, surfaces=SURFACES, particle=SILICA)
    for key, name in (("F_sa", "force"), ("A_sa2", "area_2")):
        expected = FLAKES.areal_density * (share @ one[name])
        assert field[key][0] == pytest.approx(expected, rel=1e-7)


def test_load_is_the_integral_of_its_slope():
    response = particle_sum(Flakes(aspect=3.0), SURFACES, ROUGH, FLAKES)
    d, h = np.linspace(-100e-9, 350e-9, 30), 2e-10
    up, down = (response.load(d + s * h)[0][:, 0] for s in (1, -1))
    slope = response.load(d)[0][:, 1]
    assert_allclose((up - down) / (2 * h), slope, rtol=1e-4, atol=1e-6 * np.abs(slope).max())


def test_flakes_cover_more_than_balls():
    ball, flake = (contact(Flakes(aspect=a, shadow="covered")) for a in (1.0, 3.0))
    shadows = [tb.solve(c, pressure=1e7).shadow for c in (ball, flake)]
    assert_allclose(shadows, FLAKES.coverage * np.array([1, 9]), rtol=1e-12)
    low = particle_sum(
        Flakes(aspect=3.0, seat="plane", shadow="projected"), SURFACES, ROUGH, FLAKES
    )
    assert_allclose(low.fields(np.array([1e-9]))["shadow"], 9 * FLAKES.coverage, rtol=1e-12)


def test_flakes_solve():
    state = tb.solve(contact(Flakes(aspect=4.0)), pressure=1e7)
    balls = tb.solve(contact(Series(deep="off")), pressure=1e7)
    assert state.status == "ok"
    assert state.particle_load_share > balls.particle_load_share


def test_refusals_and_warnings():
    with pytest.raises(tb.errors.InvalidValue, match="aspect"):
        Flakes(aspect=0.5)
    with pytest.raises(tb.errors.InvalidValue, match=r"Flakes\.h_0"):
        Flakes(aspect=2, h_0=1e-9)
    with pytest.raises(tb.errors.InvalidValue, match="thickness"):
        tb.solve(contact(Flakes(aspect=40.0)), pressure=1e7)
    assert not Flakes(aspect=3.0).warnings(SURFACES, ROUGH, FLAKES)
    (told,) = Flakes(aspect=40.0).warnings(SURFACES, ROUGH, FLAKES)
    assert "1.6 µm" in told


def test_round_trip_and_name():
    law = Flakes(aspect=3.0, law=ZMC(), seat="offset", h_0=1e-8)
    assert Flakes.from_dict(law.to_dict()) == law
    assert tb.particle.REGISTRY["flakes"] is Flakes
    assert tb.particle.REGISTRY["series"] is Series


def test_states_of_several_aspects():
    """Flakes of other aspects are other particles: one contact after another."""
    aspects = np.linspace(1.5, 4.0, 6)
    states = state_columns(contact(Flakes()), pressure=1e7, vary={"particle_law.aspect": aspects})
    for i in (0, 5):
        alone = tb.solve(contact(Flakes(aspect=aspects[i])), pressure=1e7)
        assert_allclose(states["d"][i], alone.d, rtol=1e-10)
