"""Rough sphere and cylinder: reference values, the singular kernel, and known limits."""

import math

import numpy as np
import pytest
from refusals import Mistake, Status, balances_not, refuses
from scipy import special
from scipy.integrate import quad
from scipy.interpolate import BarycentricInterpolator

import thirdbody as tb
from thirdbody.systems import elastic_balance
from thirdbody.systems.elastic_balance import Outline, Skin
from thirdbody.systems.rough_body import curve, rough_cylinder, rough_sphere

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
PARTICLES = tb.Particles(
    material=SILICA, areal_density=1e11, diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)
)
# d and μ; T, p0, a_eff and the axis gap in the units of Greenwood and Tripp, to 12 digits by an
# independent solution
GREENWOOD_TRIPP = [
    (3, 4, 0.000857783228982, 0.0010540285179, 0.672079605176, 3.00047861698),
    (2, 4, 0.0264974967504, 0.0256234382798, 0.754968224119, 2.01316156225),
    (0, 4, 1.49475725, 0.730647836392, 1.04171999515, 0.538085062552),
    (-2, 4, 7.11997226499, 1.90399733377, 1.38473138351, -0.0718357140063),
    (-2, 17, 10.2519038013, 2.48605577486, 1.44423239877, 0.661942723874),
    (0, 40, 3.94396889745, 1.57591565199, 1.13718623511, 1.30056827183),
    (-10, 40, 70.1362329458, 5.63792744234, 2.4622007788, 0.681942586131),
    (-30, 1000, 344.356257037, 10.0593340586, 4.05446347013, 1.84973729328),
]


def steel_contact(sigma=100e-9, **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=sigma, R=2.8e-6),
        **more,
    )


def greenwood_tripp(mu):
    """A contact of GW asperities and the radius B that give μ; σ_s, and the units of r and p."""
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    contact = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL), roughness=rough, asperity_law=tb.asperity.GW()
    )
    s = rough.sigma_s
    B = (3 * mu / (8 * rough.density * s)) ** 2 / (2 * rough.R)
    return contact, B, s, math.sqrt(2 * B * s), contact.E_ss * math.sqrt(s / (8 * B))


def dimensionless_law(mu):
    """μF_{3/2}: with E* = 2, B = 1/2 and σ = 1 the equations are those of 1967."""

    def F(n, u):
        tail = special.pbdv(-n - 1, u)[0]
        return special.gamma(n + 1) / math.sqrt(2 * math.pi) * np.exp(-u * u / 4) * tail

    return lambda u: (mu * F(1.5, u), -1.5 * mu * F(0.5, u))


@pytest.mark.parametrize(("d", "mu", "T", "p0", "a_eff", "u0"), GREENWOOD_TRIPP)
def test_greenwood_tripp_values(d, mu, T, p0, a_eff, u0):
    contact, B, s, length, pressure = greenwood_tripp(mu)
    ball = rough_sphere(contact, radius=B, d=d * s)
    got = (
        2 * ball.load / (s * contact.E_ss * length),
        ball.peak_pressure / pressure,
        ball.a_eff / length,
        ball.axis_gap / s,
    )
    assert got == pytest.approx((T, p0, a_eff, u0), rel=2e-11)
    assert ball.resolution < 1e-12
    assert np.all(ball.pressure >= 0)


@pytest.mark.parametrize(("d", "mu", "T", "p0", "a_eff", "u0"), GREENWOOD_TRIPP[:6])
def test_plain_pressure_law(d, mu, T, p0, a_eff, u0):
    ball = rough_sphere(dimensionless_law(mu), radius=0.5, d=d, E_star=2.0)
    assert (ball.load, ball.peak_pressure, ball.a_eff) == pytest.approx((T, p0, a_eff), rel=2e-9)
    assert ball.real_area is None
    assert ball.particle_load_share is None
    back = rough_sphere(dimensionless_law(mu), radius=0.5, load=T, E_star=2.0)
    assert back.d == pytest.approx(d, abs=1e-8)


def pressure_between(body):
    """The solved pressure between the nodes."""
    return BarycentricInterpolator(body.r[::-1] ** 2, body.pressure[::-1])


@pytest.mark.parametrize("particles", [None, PARTICLES])
def test_sphere_against_the_ring_kernel(particles):
    contact = steel_contact(particles=particles)
    ball = rough_sphere(contact, radius=5e-3, load=1.0)
    p, end, scale = pressure_between(ball), ball.r[-1], contact.roughness.sigma

    def ring(s, r):
        complement = ((r - s) / (r + s)) ** 2
        return float(p(s * s)) * s / (r + s) * special.ellipkm1(complement)

    for i in (5, len(ball.r) // 2):
        r = ball.r[i]
        w = 0.0
        for a, b in ((0, r), (r, end)):
            # cluster towards the logarithm at s = r
            side = r - a if a == 0 else r - b
            w += quad(
                lambda v, side=side, r=r: ring(r - side * v**3, r) * abs(side) * 3 * v * v,
                0,
                1,
                epsrel=1e-11,
                limit=200,
            )[0]
        w *= 4 / (math.pi * contact.E_ss)
        assert ball.gap[i] == pytest.approx(
            ball.d + r * r / (2 * ball.radius) + w, abs=1e-9 * scale
        )


def test_cylinder_against_the_line_kernel():
    contact = steel_contact(particles=PARTICLES)
    roller = rough_cylinder(contact, radius=5e-3, load=5e4)
    p, end = pressure_between(roller), roller.r[-1]
    x0 = roller.radius
    for i in (3, len(roller.r) // 2):
        x = roller.r[i]

        def kernel(s, x=x):
            return float(p(s * s)) * math.log(abs((x - s) * (x + s) / ((x0 - s) * (x0 + s))))

        w = 0.0
        for a, b in ((0, x), (x, end)):
            side = x - a if a == 0 else x - b
            w += quad(
                lambda v, side=side, x=x: kernel(x - side * v**3) * abs(side) * 3 * v * v,
                0,
                1,
                epsrel=1e-11,
                limit=200,
            )[0]
        w *= -2 / (math.pi * contact.E_ss)
        gap = roller.d + x * x / (2 * roller.radius) + w
        assert roller.gap[i] == pytest.approx(gap, abs=1e-9 * abs(roller.d))


def test_reference_point_of_a_cylinder_moves_only_d():
    contact = steel_contact()
    one = rough_cylinder(contact, radius=5e-3, load=1e4)
    two = rough_cylinder(contact, radius=5e-3, load=1e4, reference=0.0)
    assert two.a_eff == pytest.approx(one.a_eff, rel=1e-12)
    assert two.peak_pressure == pytest.approx(one.peak_pressure, rel=1e-12)
    assert two.real_area == pytest.approx(one.real_area, rel=1e-12)
    # with the axis as reference nothing sinks there
    assert two.d == pytest.approx(two.axis_gap, abs=1e-12 * one.radius * 1e-6)
    assert one.d < two.d


@pytest.mark.parametrize(("solver", "load"), [(rough_sphere, 1.0), (rough_cylinder, 5e3)])
def test_smooth_limit_is_hertz(solver, load):
    errors = []
    for sigma in (20e-9, 5e-9, 1.25e-9):
        body = solver(steel_contact(sigma, asperity_law=tb.asperity.GW()), radius=5e-3, load=load)
        errors.append((body.a_eff / body.a_hertz - 1, 1 - body.peak_pressure / body.p_hertz))
    errors = np.array(errors)
    assert np.all(errors > 0)
    assert np.all(errors[1:] < 0.5 * errors[:-1])
    assert np.all(errors[-1] < 0.03)


def test_far_apart_the_load_is_proportional_to_mu():
    loads = []
    for mu in (4.0, 8.0):
        contact, B, s, length, _ = greenwood_tripp(mu)
        ball = rough_sphere(contact, radius=B, d=7 * s)
        loads.append(2 * ball.load / (s * contact.E_ss * length) / mu)
    assert loads[1] == pytest.approx(loads[0], rel=1e-8)


@pytest.mark.parametrize("solver", [rough_sphere, rough_cylinder])
@pytest.mark.parametrize("particles", [None, PARTICLES])
def test_load_and_separation_are_inverse(solver, particles):
    contact = steel_contact(particles=particles)
    body = solver(contact, radius=5e-3, d=50e-9)
    back = solver(contact, radius=5e-3, load=body.load)
    assert back.d == pytest.approx(body.d, abs=1e-12 * 100e-9 * 1e3)
    step = 0.02e-9
    high, low = (solver(contact, radius=5e-3, d=body.d + dx).load for dx in (step, -step))
    assert body.stiffness == pytest.approx((low - high) / (2 * step), rel=1e-6)


def test_particles_share_the_load():
    bare, dirty = steel_contact(), steel_contact(particles=PARTICLES)
    table = curve(dirty, radius=5e-3, loads=[10.0, 1e-3, 0.1])
    clean = curve(bare, radius=5e-3, loads=[10.0, 1e-3, 0.1])
    assert table["load"] == pytest.approx([10.0, 1e-3, 0.1], rel=1e-12)
    share = table["particle_load_share"]
    assert share[1] > share[2] > share[0] > 0
    assert np.all(clean["particle_load_share"] == 0)
    assert np.all(table["d"] > clean["d"])
    assert np.all(table["a_eff"] > clean["a_eff"])
    one = rough_sphere(dirty, radius=5e-3, load=0.1)
    assert table["real_area"][2] == pytest.approx(one.real_area, rel=1e-10)
    # a nearly flat body is the plane contact, place by place
    state = tb.solve(dirty, d=one.gap)
    assert one.pressure == pytest.approx(state.pressure, rel=1e-10)


@pytest.mark.parametrize("law", [tb.asperity.KE(), tb.asperity.CEB()])
def test_laws_with_jumps(law):
    ball = rough_sphere(steel_contact(asperity_law=law), radius=5e-3, load=1.0)
    assert ball.resolution < 1e-12
    assert ball.a_eff > ball.a_hertz
    assert ball.peak_pressure < ball.p_hertz


def test_mistakes():
    contact = steel_contact()
    with refuses(Mistake.MISSING, "", says="load"):
        rough_sphere(contact, radius=5e-3)
    with refuses(Mistake.MISSING, "", says="load"):
        rough_sphere(contact, radius=5e-3, d=0.0, load=1.0)
    with refuses(Mistake.RANGE, "radius", value="-0.005"):
        rough_sphere(contact, radius=-5e-3, load=1.0)
    with pytest.raises(tb.errors.InvalidValue, match="load > 0"):
        rough_sphere(contact, radius=5e-3, load=-1.0)
    with refuses(Mistake.RANGE, "E_star", value="None"):
        rough_sphere(lambda u: (np.exp(-u), -np.exp(-u)), radius=0.5, d=0.0)
    with pytest.raises(tb.errors.InvalidValue, match="E_star"):
        rough_sphere(contact, radius=5e-3, load=1.0, E_star=1e11)
    with refuses(Mistake.OPTION, "shape", value="'cone'"):
        curve(contact, radius=5e-3, loads=[1.0], shape="cone")
    sticky = steel_contact(1e-9, asperity_law=tb.asperity.JKR(w=1.0))
    with pytest.raises(tb.errors.InvalidValue, match="tensile"):
        rough_sphere(sticky, radius=5e-3, d=1e-9)
    with balances_not(Status.TOO_LITTLE, says="1 mm"):
        rough_sphere(contact, radius=5e-3, d=1e-3)
    with balances_not(Status.TOO_DEEP, says="-3 sigma_s"):
        rough_sphere(steel_contact(5e-9), radius=5e-3, load=100.0)


PLATEAU = tb.Particles(
    material=SILICA, areal_density=2.8e7, diameter=tb.distributions.Monodisperse(mean=20e-6)
)
"""Particles that fall out of contact all at once, far above the asperities."""
LONG_TAIL = tb.Particles(
    material=tb.materials["100Cr6"], areal_density=5e8,
    diameter=tb.distributions.LogNormal(median=500e-9, gsd=2.0),
)  # fmt: skip


@pytest.mark.parametrize("law", [tb.asperity.KE(), tb.asperity.JKR(w=1.0)])
@pytest.mark.parametrize("particles", [None, PARTICLES, PLATEAU, LONG_TAIL])
def test_seeking_by_an_outline_leads_where_the_whole_law_leads(law, particles, monkeypatch):
    contact = steel_contact(600e-9, asperity_law=law, particles=particles)
    shapes = [(rough_sphere, 1e-6), (rough_sphere, 30.0), (rough_cylinder, 1e-4)]
    by_outline = [solve(contact, radius=5e-3, load=load) for solve, load in shapes]
    monkeypatch.setattr(Skin, "outline", property(lambda skin: skin))
    for (solve, load), quick in zip(shapes, by_outline, strict=True):
        whole = solve(contact, radius=5e-3, load=load)
        assert quick.peak_pressure == pytest.approx(whole.peak_pressure, rel=1e-10)
        assert quick.d == pytest.approx(whole.d, abs=1e-10 * 600e-9)


@pytest.mark.parametrize("particles", [None, PARTICLES, PLATEAU, LONG_TAIL])
def test_an_outline_keeps_to_the_law(particles):
    skin = Skin(steel_contact(600e-9, particles=particles), None)
    assert isinstance(skin.outline, Outline)
    p_floor = skin.one(skin.floor)[0]
    gap = np.linspace(skin.floor, skin.cut(skin.floor), 3000)
    p, rough = skin(gap)[0], skin.outline(gap)[0]
    counts = p > 1e-20 * p_floor
    assert np.max(np.abs(np.log(rough[counts] / p[counts]))) < 0.3
    assert np.max(rough[~counts], initial=0.0) < 1e-19 * p_floor


def test_pressure_beyond_a_grid_is_not_left_out(monkeypatch):
    """An outline that ends too early leads to a grid that is laid once more: 8e-4 off without."""
    contact = steel_contact(600e-9, particles=PLATEAU)
    whole = rough_cylinder(contact, radius=5e-3, load=1e-4)
    law, ends_early, asked = Outline.__call__, elastic_balance._ends_early, []

    def end_early(outline, gap):
        beyond = (gap > 22.5e-6) & (np.size(gap) > 1)  # on grids, and not where ends are sought
        return tuple(np.where(beyond, 0.0, values) for values in law(outline, gap))

    def look(*state):
        asked.append(ends_early(*state))
        return asked[-1]

    monkeypatch.setattr(Outline, "__call__", end_early)
    monkeypatch.setattr(elastic_balance, "_ends_early", look)
    again = rough_cylinder(contact, radius=5e-3, load=1e-4)
    assert asked == [True]
    assert again.peak_pressure == pytest.approx(whole.peak_pressure, rel=1e-10)
