"""Identities and limits that any correct model satisfies, over wide random inputs."""

import math

import numpy as np
import oracle
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from twins import base, decades, horng_twins, interfaces, material, series_twin, series_twins, sizes

import thirdbody as tb
from thirdbody.contact.interface import interface

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
PER_AREA = ("A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p")
LOADS = ("F_star", "F_ss_star", "F_sa_star")
ANY = st.one_of(series_twins(), horng_twins())
STEEL = oracle.STEEL


def at(twin, d=None, contact=None):
    return tb.solve(contact or twin.contact, d=twin.d if d is None else d)


def same(one, two, rtol=1e-10, floor=1e-13, names=(*LOADS, *PER_AREA)):
    for name in names:
        a, b = getattr(one, name), getattr(two, name)
        total = one.F_star if name in LOADS else one.A_t
        assert b == pytest.approx(a, rel=rtol, abs=floor * total), name


# ------------------------------------------------------------- 1: no particle, no difference
@given(twin=series_twins(seats=("plane", "offset"), kinds=("gaussian", "uniform", "monodisperse")))
def test_particles_below_the_gap_change_nothing(twin):
    """Bit for bit: the particle terms are exactly zero, not merely small."""
    law = twin.contact.particle_law
    assume(law.shadow != "covered")
    gap = twin.contact.particles.diameter.support[1] * (1 + 1e-12)
    d = gap + law.h_0
    bare = tb.solve(base(twin.interface), d=d)
    loose = at(twin, d)
    assert loose.F_sa_star == loose.A_sa == loose.shadow == 0
    for name in (*LOADS, *PER_AREA):
        assert getattr(loose, name) == getattr(bare, name)


@given(twin=series_twins())
def test_no_particles_is_two_body(twin):
    bare = tb.solve(base(twin.interface), d=twin.d)
    none = at(twin, contact=twin.contact.replace(**{"particles.areal_density": 0.0}))
    for name in (*LOADS, *PER_AREA):
        assert getattr(none, name) == getattr(bare, name)
    assert bare.mode == "s-s"
    assert bare.particle_load_share == bare.particle_area_share == 0


# --------------------------------------------------------------------- 2: the parts add up
@given(twin=ANY)
def test_parts_add_up(twin):
    state = at(twin)
    assert state.F_ss_star + state.F_sa_star == pytest.approx(state.F_star, rel=1e-13)
    assert state.A_ss + state.A_sa == pytest.approx(state.A_t, rel=1e-13)
    assert state.A_e + state.A_ep + state.A_p == pytest.approx(state.A_t, rel=1e-12)
    for name in (*LOADS, *PER_AREA, "shadow"):
        assert getattr(state, name) >= 0, name
    assert state.particle_load_share == pytest.approx(state.F_sa_star / state.F_star, rel=1e-12)
    assert state.particle_area_share == pytest.approx(state.A_sa / state.A_t, rel=1e-12)
    E_ss = twin.interface.E_ss
    assert state.pressure == pytest.approx(state.F_star * E_ss, rel=1e-12)
    assert state.scales["E_ss"] == pytest.approx(E_ss, rel=1e-13)
    assert state.d_star == pytest.approx(state.d / twin.interface.rough.sigma, rel=1e-13)


@given(twin=ANY)
def test_modes(twin):
    state = at(twin)
    particles = state.A_sa / state.A_t
    assume(min(abs(particles - 0.98), abs(particles - 0.05)) > 1e-9)
    want = "p-s" if particles >= 0.98 else "s-s" if particles <= 0.05 else "hybrid"
    assert state.mode == want


def test_height_of_the_mean_plane():
    interface = oracle.Interface()
    state = tb.solve(base(interface), d=2e-7)
    assert state.h == pytest.approx(2e-7 + interface.rough.y_s, rel=1e-12)


# ------------------------------------------------------------------------ 3: monotone in d
@given(twin=series_twins())
def test_load_falls_with_separation(twin):
    """Strictly, until rounding; the real area falls with it."""
    sigma = twin.interface.rough.sigma
    d = twin.d + sigma * np.linspace(0, 3, 40)
    state = at(twin, d)
    loaded = state.F_star > 1e-250
    assume(np.all(state.shadow < 0.9))
    # holds while the nominal pressure of the asperities stays far below the hardness
    assume(state.F_ss_star[0] * twin.interface.E_ss < 0.05 * twin.interface.tip.H)
    assert np.all(np.diff(state.F_star)[loaded[1:]] < 0)
    assert np.all(np.diff(state.F_sa_star) <= 1e-12 * state.F_sa_star[:-1])


@given(interface=interfaces())
def test_two_body_load_and_area_fall_with_separation(interface):
    state = tb.solve(base(interface), d=interface.rough.sigma * np.linspace(-3, 12, 80))
    for name in ("F_star", "A_t"):
        values = getattr(state, name)
        assert np.all(values > 0)
        assert np.all(np.diff(values) < 0)


# ------------------------------------------------------------- 4 to 6: proportions and units
@given(twin=ANY, factor=decades(1e-3, 1))
def test_particle_load_is_proportional_to_their_number(twin, factor):
    density = twin.contact.particles.areal_density
    less = twin.contact.replace(**{"particles.areal_density": factor * density})
    one, two = at(twin), at(twin, contact=less)
    for name in ("F_sa_star", "A_sa", "shadow"):
        if name == "shadow" and one.shadow >= 1:
            continue
        assert getattr(two, name) == pytest.approx(factor * getattr(one, name), rel=1e-11)


@given(twin=ANY, factor=decades(1e-2, 1e2))
def test_change_of_length(twin, factor):
    """σ, R, sizes, h_0, d times λ and densities over λ²."""
    contact = twin.contact
    changes = {
        "roughness.sigma": factor * contact.roughness.sigma,
        "roughness.R": factor * contact.roughness.R,
        "particles.diameter": contact.particles.diameter.scaled(factor),
        "particles.areal_density": contact.particles.areal_density / factor**2,
    }
    if getattr(contact.particle_law, "h_0", 0):
        changes["particle_law.h_0"] = factor * contact.particle_law.h_0
    same(at(twin), at(twin, factor * twin.d, contact.replace(**changes)), rtol=1e-9)


@given(twin=ANY, factor=decades(1e-3, 1e3))
def test_change_of_stress(twin, factor):
    names = ("surfaces.first", "surfaces.second", "particles.material")
    changes = {}
    for name in names:
        body = twin.contact
        for part in name.split("."):
            body = getattr(body, part)
        changes |= {f"{name}.E": factor * body.E, f"{name}.H": factor * body.H}
    same(at(twin), at(twin, contact=twin.contact.replace(**changes)), rtol=1e-9)


# ------------------------------------------------------------------------ 7, 8: mean pressure
@given(twin=series_twins())
def test_mean_particle_pressure(twin):
    state = at(twin)
    assume(state.A_sa > 1e-30 and state.A_sa2 > 1e-30)
    particle = twin.contact.particles.material.H
    for area, surface in ((state.A_sa, twin.interface.first), (state.A_sa2, twin.interface.second)):
        pressure = state.F_sa_star * twin.interface.E_ss / area
        assert pressure <= min(surface.H, particle) * (1 + 1e-9)
    # and at least kH unless part of it is elastic
    if twin.interface.first == twin.interface.second:
        H = min(twin.interface.first.H, particle)
        bare = tb.solve(base(twin.interface), d=twin.d)
        elastic = (state.A_e - (1 - state.shadow) * bare.A_e) / state.A_sa
        pressure = state.F_sa_star * twin.interface.E_ss / state.A_sa
        assert pressure >= 0.4 * H * (1 - elastic) * (1 - 1e-6)


@given(twin=horng_twins())
def test_mean_particle_pressure_of_the_printed_model(twin):
    """F_sa = H_s1 A_sa identically; (H_s1 + H_a) A_sa in the reading that adds hardnesses."""
    state = at(twin)
    assume(state.A_sa > 1e-30)
    first, dust = twin.interface.first.H, twin.contact.particles.material.H
    want = {
        "surface": first,
        "softer": min(first, dust),
        "replace2": first,
        "sum": first + dust,
    }[twin.law.hardness_rule]
    pressure = state.F_sa_star * twin.interface.E_ss / state.A_sa
    assert pressure == pytest.approx(want, rel=1e-10)


@given(interface=interfaces(), h=st.floats(-3, 10))
def test_mean_asperity_pressure(interface, h):
    state = tb.solve(base(interface), d=h * interface.rough.sigma_s)
    H = interface.tip.H
    pressure = state.F_star * interface.E_ss / state.A_t
    assert pressure >= interface.k * H * (1 - state.A_e / state.A_t) * (1 - 1e-12)
    assert pressure <= H * (1 + 1e-12)


# ----------------------------------------------------------------------- 9: one size
@given(twin=series_twins(kinds=("monodisperse",)))
def test_narrow_sizes_approach_one_size(twin):
    x = twin.contact.particles.diameter.mean
    squeeze = 1 - (twin.d - twin.contact.particle_law.h_0) / x
    assume(twin.contact.particle_law.seat == "rough" or squeeze > 1e-2)
    one, errors = at(twin), []
    for width in (1e-3, 1e-4):
        narrow = tb.TruncatedGaussian(mean=x, std=width * x)
        state = at(twin, contact=twin.contact.replace(**{"particles.diameter": narrow}))
        errors.append(abs(state.F_sa_star / one.F_sa_star - 1))
    assert errors[0] < 0.05
    assert errors[1] < max(0.2 * errors[0], 1e-9)


# --------------------------------------------------------- 10, 15: plastic and buried particles
@given(
    mean=decades(0.5, 5),
    width=decades(0.02, 0.3),
    hardness=st.tuples(decades(1, 10), decades(1, 10)),
    squeeze=st.floats(0.02, 0.3),
)
def test_fully_plastic_particles(mean, width, hardness, squeeze):
    """H → 0 with E fixed: F_sa → η_a π H_1 H_2/(H_1 + H_2) (m_2 − d m_1), not yet buried."""
    soft = [oracle.Body(205e9, 0.29, 1e5 * h) for h in hardness]
    assume(max(hardness) / min(hardness) < 3)
    interface = oracle.Interface(soft[0], soft[1], oracle.Rough(1e-7, 2.8e-6))
    mean *= 1e-7
    diameter, twin_sizes = sizes("gaussian", mean, width)
    hi = diameter.support[1]
    d = hi * (1 - squeeze)
    twin = series_twin(interface, oracle.SILICA, (diameter, twin_sizes), 1e9, d, shadow="none")
    H_1, H_2 = soft[0].H, soft[1].H
    m_1, m_2 = (float(diameter.partial_moment(n, d, hi)) for n in (1, 2))
    want = 1e9 * math.pi * H_1 * H_2 / (H_1 + H_2) * (m_2 - d * m_1)
    state = at(twin)
    # a share of the order ω_2/x of the squeeze is not yet plastic
    assert state.F_sa_star * interface.E_ss == pytest.approx(want, rel=2e-3)
    assert state.A_sa == pytest.approx(want / H_1, rel=2e-3)
    assert state.A_sa2 == pytest.approx(want / H_2, rel=2e-3)


@given(interface=interfaces(), mean=decades(0.5, 10), depth=st.floats(0, 0.4), shadow=st.booleans())
def test_buried_particles(interface, mean, depth, shadow):
    x = mean * interface.rough.sigma
    density = 0.05 / (math.pi / 4 * x**2)
    one = interface.first
    interface = oracle.replace(interface, second=one)
    twin = series_twin(
        interface,
        one,
        sizes("monodisperse", x, 0),
        density,
        depth * x,
        shadow="footprint" if shadow else "projected",
    )
    # stiff enough to be fully plastic before it is buried
    assume(oracle.squeezed(interface, twin.law).end < 1 - depth)
    state = at(twin)
    assert state.A_sa == pytest.approx(0.05, rel=1e-12)
    assert state.F_sa_star * interface.E_ss == pytest.approx(0.05 * one.H, rel=1e-12)
    assert state.shadow == pytest.approx(0.05, rel=1e-12)


# ------------------------------------------------------------------------- 11: swapped surfaces
@given(twin=series_twins())
def test_swapped_surfaces(twin):
    pair = twin.contact.surfaces
    turned = twin.contact.replace(surfaces=tb.MaterialPair(pair.second, pair.first))
    one, two = at(twin), at(twin, contact=turned)
    for name in (*LOADS, "A_ss"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-300)
    assert two.A_sa == pytest.approx(one.A_sa2, rel=1e-9)
    assert two.A_sa2 == pytest.approx(one.A_sa, rel=1e-9)


# --------------------------------------------------------- 12: a harder particle is no harder
@given(twin=series_twins(), factor=st.floats(1, 20))
def test_hardness_above_that_of_the_surfaces_has_no_effect(twin, factor):
    hardest = max(twin.interface.first.H, twin.interface.second.H)
    hard = twin.contact.replace(**{"particles.material.H": hardest})
    harder = hard.replace(**{"particles.material.H": factor * hardest})
    same(at(twin, contact=hard), at(twin, contact=harder), rtol=1e-12)


@given(twin=horng_twins(), factor=st.floats(1, 20))
def test_hardness_of_particles_in_the_printed_model(twin, factor):
    hardest = max(twin.interface.first.H, twin.interface.second.H)
    hard = twin.contact.replace(**{"particles.material.H": hardest})
    harder = hard.replace(**{"particles.material.H": factor * hardest})
    one, two = at(twin, contact=hard), at(twin, contact=harder)
    if twin.law.hardness_rule in ("surface", "softer"):
        same(one, two, rtol=1e-12)
    elif twin.law.hardness_rule == "sum" and factor > 1.01 and one.F_sa_star > 0:
        assert two.F_sa_star > one.F_sa_star


# ---------------------------------------------------------------- 13: the two plastic weights
@given(twin=horng_twins())
def test_printed_weight_exceeds_the_geometric_one(twin):
    assume(twin.law.weight == "x2" and twin.d > 0)
    x2, xxd = (
        at(twin, contact=twin.contact.replace(**{"particle_law.plastic_weight": w}))
        for w in ("x2", "xxd")
    )
    assert x2.F_sa_star >= xxd.F_sa_star * (1 - 1e-12)


# ------------------------------------------------------------------------ 14: derivative
@given(twin=series_twins())
def test_load_is_smooth_in_d(twin):
    """Central differences of two steps agree as h²: no steps between nodes or table cells."""
    assume(not isinstance(twin.contact.particles.diameter, tb.distributions.Monodisperse))
    step = 1e-4 * twin.interface.rough.sigma
    d = twin.d + step * np.array([-2, -1, 1, 2])
    F = at(twin, d).F_star
    wide, tight = (F[3] - F[0]) / (4 * step), (F[2] - F[1]) / (2 * step)
    assume(at(twin).shadow < 1)
    assert tight == pytest.approx(wide, rel=1e-3, abs=1e-9 * F[1] / step)


# --------------------------------------------------------------------------- the rough seat
@settings(max_examples=settings().max_examples // 4)
@given(
    interface=interfaces(same=True),
    mean=decades(0.5, 5),
    squeeze=decades(0.05, 0.8),
)
def test_smooth_seat_recovers_the_plane(interface, mean, squeeze):
    """ζ narrow: `rough` at h equals `plane` at a gap h."""
    x, y_s = mean * interface.rough.sigma, interface.rough.y_s
    gap = x * (1 - squeeze)
    args = (interface, interface.first, sizes("gaussian", x, 0.1), 1e9 * 1e-14 / x**2)
    flat = at(series_twin(*args, gap, shadow="none"))
    errors = []
    for width in (2e-2, 2e-3):
        twin = series_twin(*args, gap - y_s, seat="rough", zeta_std=width * mean, shadow="none")
        errors.append(abs(at(twin).F_sa_star / flat.F_sa_star - 1))
    assert errors[1] < 1e-3
    assert errors[1] < max(0.1 * errors[0], 1e-8)


@pytest.mark.check
@given(twin=series_twins(seats=("rough",)), shift=st.floats(-1, 1))
def test_higher_seats_are_a_smaller_gap(twin, shift):
    """Moving all seats by mσ moves the particle load by the same separation."""
    law = twin.contact.particle_law
    moved = twin.contact.replace(**{"particle_law.zeta_mean": law.zeta_mean + shift})
    d = twin.d + shift * twin.interface.rough.sigma
    one, two = at(twin), at(twin, d, moved)
    assert two.F_sa_star == pytest.approx(one.F_sa_star, rel=1e-8)
    assert two.A_sa == pytest.approx(one.A_sa, rel=1e-8)


@given(twin=series_twins(seats=("plane",)), h_0=st.floats(0.01, 5))
def test_offset_is_a_shifted_plane(twin, h_0):
    h_0 *= twin.interface.rough.sigma
    raised = twin.contact.replace(**{"particle_law.seat": "offset", "particle_law.h_0": h_0})
    one, two = at(twin), at(twin, twin.d + h_0, raised)
    assert two.F_sa_star == pytest.approx(one.F_sa_star, rel=1e-6)
    exact = at(twin, (twin.d + h_0) - h_0)
    assert two.F_sa_star == pytest.approx(exact.F_sa_star, rel=1e-10)


# ------------------------------------------------------------------- closed-form anchors
@pytest.mark.parametrize(
    ("dust", "x", "want"),
    [
        (oracle.SILICA, 300e-9, 9.37e-6),
        (STEEL, 300e-9, 3.50e-6),
        (oracle.SILICA, 1000e-9, 1.04e-4),
        (STEEL, 1000e-9, 3.89e-5),
    ],
)
def test_saturation_of_the_window_reading(dust, x, want):
    """Every particle caught carries the Hertz load of its elastic limit (πH/8) C' x²."""
    interface = oracle.Interface()
    E_1, E_2 = 2 * oracle.contact_modulus(STEEL, dust), 2 * interface.E_ss
    C = 9 * math.pi**2 / 4 * ((5e9 / E_1) ** 2 + (5e9 / E_2) ** 2)
    exact = 1e11 * math.pi * 5e9 / 8 * C * x**2 / interface.E_ss
    assert exact == pytest.approx(want, rel=2e-3)
    width = 0.01
    particles = tb.Particles(
        material=material(dust),
        diameter=tb.TruncatedGaussian(mean=x, std=width * x, n=3),
        areal_density=1e11,
    )
    law = tb.particle.Horng2022(preset="window", normalise=True)
    contact = base(interface, particles, law)
    state = tb.solve(contact, d=1.031 * x)
    assert 3.25 * interface.rough.sigma > 0.07 * x, "the window must hold every size"
    second = particles.diameter.moment(2) / x**2
    assert state.F_sa_star == pytest.approx(exact * second, rel=1e-9)


@given(interface=interfaces(), h=st.floats(-2, 6))
def test_greenwood_williamson_limit(interface, h):
    """Hardness beyond reach: F = (4/3) η E √R σ_s^{3/2} F_{3/2}(h), A = π η R σ_s F_1(h)."""
    hard = [oracle.replace(body, H=1e4 * body.E) for body in (interface.first, interface.second)]
    interface = oracle.replace(interface, first=hard[0], second=hard[1])
    rough = interface.rough
    state = tb.solve(base(interface), d=h * rough.sigma_s)

    def F(n: float) -> float:
        edges = [j * 0.25 / max(abs(h), 1) for j in range(200)]
        return oracle.integrate(lambda v: 2 * v * v ** (2 * n) * oracle.normal(h + v * v), edges)

    load = 4 / 3 * rough.eta * math.sqrt(rough.R) * rough.sigma_s**1.5 * F(1.5)
    assert state.F_star == pytest.approx(load, rel=1e-9)
    assert state.A_t == pytest.approx(
        math.pi * rough.eta * rough.R * rough.sigma_s * F(1), rel=1e-9
    )
    assert state.A_e == state.A_t


@given(interface=interfaces(), h=st.floats(-2, 5))
def test_plastic_limit(interface, h):
    """H → 0: every contact is cut geometrically, A = 2πηRσ_s F_1(h), F = HA."""
    soft = [oracle.replace(body, H=1e-7 * body.E) for body in (interface.first, interface.second)]
    interface = oracle.replace(interface, first=soft[0], second=soft[1])
    rough = interface.rough
    state = tb.solve(base(interface), d=h * rough.sigma_s)
    F_1 = oracle.normal(h) - h * oracle.normal_above(h)
    assert state.A_t == pytest.approx(
        2 * math.pi * rough.eta * rough.R * rough.sigma_s * F_1, rel=1e-5
    )
    assert state.F_star * interface.E_ss == pytest.approx(state.A_t * interface.tip.H, rel=1e-5)


@pytest.mark.parametrize("shadow", ["d", "none"])
def test_particles_of_one_size_have_no_slope_where_they_jump_in(shadow):
    x = 200e-9
    case = tb.Contact(
        surfaces=tb.MaterialPair(tb.materials["S45C"], tb.materials["S45C"]),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            areal_density=1e10,
            diameter=tb.distributions.Monodisperse(mean=x),
        ),
        particle_law=tb.particle.Horng2022(shadow=shadow),
    )
    with np.errstate(all="raise"):
        load = interface(case).load(x * np.array([0.999, 1.0, 1.001]))
    assert np.all(np.isfinite(load))
    assert np.all(load[:, 1] <= 0)
