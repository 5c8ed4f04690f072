"""One contact: ZMC and its smooth variant against their formulas, and one particle."""

import math

import numpy as np
import oracle
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from twins import bodies, decades, material

import thirdbody as tb

K, RHO = 0.4, 54.0
R, E_STAR, H = 2.8e-6, 1.1e11, 5e9
CASE = {"R": R, "E_star": E_STAR, "H": H}
OMEGA_1 = R * (3 * math.pi * K * H / (4 * E_STAR)) ** 2
OMEGA_2 = RHO * OMEGA_1
LAWS = {"log": tb.asperity.ZMC, "hermite": tb.asperity.Hermite}

tips = st.builds(
    lambda R, E, ratio, rule: oracle.Tip(R, E, ratio * E, rule),
    decades(1e-9, 1e-3),
    decades(1e8, 1e12),
    decades(1e-4, 0.5),
    st.sampled_from(("log", "hermite")),
)
both = pytest.mark.parametrize("law", [tb.asperity.ZMC(), tb.asperity.Hermite()])


def inputs(tip: oracle.Tip) -> dict[str, float]:
    return {"R": tip.R, "E_star": tip.E, "H": tip.H}


@given(tip=tips, y=decades(1e-6, 1e5))
def test_formulas(tip, y):
    omega, law = y * tip.omega_1, LAWS[tip.rule]()
    assume(abs(y - 1) > 1e-9 and abs(y - RHO) > 1e-7)
    assert float(law.force(omega, **inputs(tip))) == pytest.approx(tip.force(omega), rel=1e-12)
    assert float(law.area(omega, **inputs(tip))) == pytest.approx(tip.area(omega), rel=1e-12)
    assert float(law.mean_pressure(omega, **inputs(tip))) == pytest.approx(
        tip.pressure(omega), rel=1e-12
    )
    assert str(law.regime(omega, **inputs(tip))) == oracle.REGIMES[tip.regime(omega)]
    assert float(law.contact_radius(omega, **inputs(tip))) == pytest.approx(
        math.sqrt(tip.area(omega) / math.pi), rel=1e-12
    )


@given(tip=tips, y=decades(1e-3, 1e4))
def test_stiffness_is_the_slope_of_the_force(tip, y):
    assume(abs(y - 1) > 1e-3 and abs(y - RHO) > 1e-1)
    omega, step = y * tip.omega_1, 1e-5 * y * tip.omega_1
    law, args = LAWS[tip.rule](), inputs(tip)
    slope = (law.force(omega + step, **args) - law.force(omega - step, **args)) / (2 * step)
    assert float(law.stiffness(omega, **args)) == pytest.approx(float(slope), rel=1e-8)


@given(tip=tips, y=decades(1e-2, 1e4))
def test_energy_is_the_work_of_the_force(tip, y):
    omega = y * tip.omega_1
    edges = [0.0, *(w for w in (tip.omega_1, tip.omega_2) if w < omega), omega]
    work = oracle.integrate(tip.force, edges)
    assert float(LAWS[tip.rule]().energy(omega, **inputs(tip))) == pytest.approx(work, rel=1e-9)


@given(tip=tips, y=decades(1e-3, 1e4), size=decades(1e-3, 1e3), stress=decades(1e-3, 1e3))
def test_change_of_units(tip, y, size, stress):
    """F(λω; λR) = λ²F at fixed stresses, and F is proportional to stress."""
    law, omega = LAWS[tip.rule](), y * tip.omega_1
    args, big = inputs(tip), {"R": size * tip.R, "E_star": stress * tip.E, "H": stress * tip.H}
    force, area = float(law.force(omega, **args)), float(law.area(omega, **args))
    assert float(law.force(size * omega, **big)) == pytest.approx(
        size**2 * stress * force, rel=1e-11
    )
    assert float(law.area(size * omega, **big)) == pytest.approx(size**2 * area, rel=1e-11)


@given(tip=tips, y=st.tuples(decades(1e-3, 1e4), decades(1e-3, 1e4)))
def test_load_and_area_never_fall(tip, y):
    law = LAWS[tip.rule]()
    omega = np.sort(y) * tip.omega_1
    assert np.diff(law.force(omega, **inputs(tip)))[0] >= 0
    assert np.diff(law.area(omega, **inputs(tip)))[0] >= 0


@both
def test_nothing_without_interference(law):
    for omega in (0.0, -1e-9, -1.0):
        assert law.force(omega, **CASE) == 0
        assert law.area(omega, **CASE) == 0
        assert law.stiffness(omega, **CASE) == 0
        assert law.mean_pressure(omega, **CASE) == 0
        assert law.energy(omega, **CASE) == 0
        assert str(law.regime(omega, **CASE)) == "none"


@both
def test_hertz_below_yield(law):
    omega = np.geomspace(1e-6, 0.999, 30) * OMEGA_1
    np.testing.assert_allclose(
        law.force(omega, **CASE), 4 / 3 * E_STAR * np.sqrt(R) * omega**1.5, rtol=1e-12
    )
    np.testing.assert_allclose(law.area(omega, **CASE), np.pi * R * omega, rtol=1e-12)
    # and everywhere when the body never yields
    hard = {"R": R, "E_star": E_STAR, "H": 1e15}
    assert float(law.force(1e-6, **hard)) == pytest.approx(
        4 / 3 * E_STAR * math.sqrt(R) * 1e-9, rel=1e-12
    )


@both
def test_mean_pressure_at_yield_is_kH_and_finally_H(law):
    assert float(law.mean_pressure(OMEGA_1 * (1 - 1e-12), **CASE)) == pytest.approx(K * H)
    for y in (54.0, 60.0, 1e6):
        assert float(law.mean_pressure(y * OMEGA_1, **CASE)) == pytest.approx(H, rel=1e-12)
        assert float(law.area(y * OMEGA_1, **CASE)) == pytest.approx(2 * np.pi * R * y * OMEGA_1)


def test_published_pressures_of_zmc():
    """p/H and A/(πRω) at s = 0, 1/4, 1/2, 3/4, 1 of the elastoplastic range."""
    omega = OMEGA_1 + np.array([0, 0.25, 0.5, 0.75, 1]) * (OMEGA_2 - OMEGA_1)
    law = tb.asperity.ZMC()
    np.testing.assert_allclose(
        law.mean_pressure(omega, **CASE) / H,
        [0.400000, 0.799614, 0.898501, 0.957654, 1],
        atol=5e-7,
    )
    np.testing.assert_allclose(
        law.area(omega, **CASE) / (np.pi * R * omega), [1, 1.15625, 1.5, 1.84375, 2], rtol=1e-12
    )


@both
@pytest.mark.parametrize("omega", [OMEGA_1, OMEGA_2])
def test_load_and_area_are_continuous(law, omega):
    for method in (law.force, law.area):
        below, above = method(omega * (1 - 1e-11), **CASE), method(omega * (1 + 1e-11), **CASE)
        assert float(above) == pytest.approx(float(below), rel=1e-9)


def slopes(law: tb.asperity.AbstractAsperityLaw, omega: float) -> list[float]:
    """dF/dω over πRH just below and above, by one-sided differences of the force."""
    out = []
    for side in (-1, 1):
        w = omega * (1 + side * np.array([1e-9, 1e-5]))
        force = law.force(w, **CASE)
        out.append(float((force[1] - force[0]) / (w[1] - w[0]) / (np.pi * R * H)))
    return out


def test_jumps_of_the_stiffness_of_zmc():
    law = tb.asperity.ZMC()
    assert slopes(law, OMEGA_1) == pytest.approx([0.600, 0.5504], abs=2e-4)
    assert slopes(law, OMEGA_2) == pytest.approx([2.3008, 2.0], abs=2e-4)
    for omega in (OMEGA_1, OMEGA_2):
        for side, slope in zip((1 - 1e-9, 1 + 1e-9), slopes(law, omega), strict=True):
            assert float(law.stiffness(omega * side, **CASE)) / (np.pi * R * H) == pytest.approx(
                slope, abs=2e-4
            )


@given(k=st.floats(0.2, 0.5), rho=decades(10, 100))
def test_stiffness_of_hermite_is_continuous(k, rho):
    law = tb.asperity.Hermite(k=k, rho=rho)
    omega_1 = R * (3 * math.pi * k * H / (4 * E_STAR)) ** 2
    for omega in (omega_1, rho * omega_1):
        below, above = law.stiffness(np.array([1 - 1e-10, 1 + 1e-10]) * omega, **CASE)
        assert above == pytest.approx(below, rel=1e-7)


@both
def test_arrays_and_scalars_agree(law):
    omega = np.geomspace(0.01, 1000, 12).reshape(3, 4) * OMEGA_1
    radius = np.array([[1e-6], [2e-6], [5e-6]])
    for method in (law.force, law.area, law.stiffness, law.energy, law.mean_pressure):
        together = method(omega, R=radius, E_star=E_STAR, H=H)
        assert together.shape == (3, 4)
        for i, j in np.ndindex(3, 4):
            one = method(omega[i, j], R=radius[i, 0], E_star=E_STAR, H=H)
            assert float(one) == pytest.approx(together[i, j], rel=1e-13)


def test_laws_are_values():
    assert tb.asperity.ZMC() == tb.asperity.ZMC(k=0.4, rho=54)
    assert tb.asperity.ZMC() != tb.asperity.Hermite()
    for name, kind in tb.asperity.REGISTRY.items():
        assert kind.name == name
        assert tb.asperity.ZMC.from_dict(kind().to_dict()) == kind()
        for about in ("title", "year", "citation", "provenance", "valid_range"):
            assert getattr(kind, about)


@pytest.mark.parametrize("bad", [{"k": 0}, {"k": 1.2}, {"k": math.nan}, {"rho": 1}, {"rho": -3}])
@pytest.mark.parametrize("kind", [tb.asperity.ZMC, tb.asperity.Hermite])
def test_bad_constants(kind, bad):
    with pytest.raises(tb.errors.InvalidValue, match=next(iter(bad))):
        kind(**bad)


def test_hermite_refuses_constants_that_overshoot():
    """Monotone only while the slope at yield stays below 3 (1 − k)."""
    with pytest.raises(tb.errors.InvalidValue, match="rho"):
        tb.asperity.Hermite(k=0.8, rho=54)


# ---------------------------------------------------------------------------- one particle
def pair_of(first, second, dust, rule="hermite") -> oracle.Squeezed:
    interface = oracle.Interface(first, second)
    return oracle.squeezed(interface, oracle.Series(dust, None, 1.0, rule=rule))


def single(first, second, dust, x, gap, rule="hermite", soft="squashed") -> dict:
    law = tb.particle.Series(deep="off", law=LAWS[rule](), soft=soft)
    return law.single(
        x,
        gap,
        surfaces=tb.MaterialPair(material(first), material(second)),
        particle=material(dust),
    )


@given(
    first=bodies,
    second=bodies,
    dust=bodies,
    x=decades(1e-8, 1e-5),
    t=decades(1e-4, 1.5),
    rule=st.sampled_from(("hermite", "log")),
)
def test_squeezed_particle(first, second, dust, x, t, rule):
    gap = x * (1 - t)
    t = 1 - gap / x
    got = single(first, second, dust, x, gap, rule, soft="sphere")
    pair = pair_of(first, second, dust, rule)
    force, one, two, regime = pair.response(t)
    assume(min(abs(t / kink - 1) for kink in pair.kinks) > 1e-9)
    assert float(got["force"]) == pytest.approx(force * x**2, rel=1e-11)
    assert float(got["area_1"]) == pytest.approx(one * x**2, rel=1e-11)
    assert float(got["area_2"]) == pytest.approx(two * x**2, rel=1e-11)
    assert str(got["regime"]) == oracle.REGIMES[regime]
    assert float(got["delta_1"] + got["delta_2"]) == pytest.approx(t * x, rel=1e-11)


@given(first=bodies, second=bodies, dust=bodies, t=decades(1e-4, 0.999))
def test_both_sides_of_a_particle_carry_one_load(first, second, dust, t):
    """The balance itself, without the oracle's root."""
    got = single(first, second, dust, 1e-6, 1e-6 * (1 - t), soft="sphere")
    pair = pair_of(first, second, dust)
    for tip, delta in ((pair.one, got["delta_1"]), (pair.two, got["delta_2"])):
        carried = tip.force(float(delta) / 1e-6) * 1e-12
        if t < pair.end:
            assert float(got["force"]) == pytest.approx(carried, rel=1e-9)
    assert float(got["force"]) <= min(pair.one.H, pair.two.H) * math.pi / 4 * 1e-12 * (1 + 1e-12)


def test_particle_limits():
    steel, dust = oracle.STEEL, oracle.SILICA
    E = oracle.contact_modulus(steel, dust)
    x = 1e-6
    # elastic: two Hertz contacts, each with half the squeeze
    delta = 1e-4 * x
    got = single(steel, steel, dust, x, x - delta)
    assert str(got["regime"]) == "elastic"
    assert float(got["force"]) == pytest.approx(
        4 / 3 * E * math.sqrt(x / 2) * (delta / 2) ** 1.5, rel=1e-9
    )
    assert float(got["area_1"]) == pytest.approx(math.pi * x / 2 * delta / 2, rel=1e-9)
    # plastic, not yet buried, unequal hardness: the printed prefactor H_1 H_2/(H_1 + H_2)
    soft = oracle.Body(205e9, 0.29, 0.5e9)
    hard = oracle.Body(205e9, 0.29, 0.6e9)
    got = single(soft, hard, dust, x, 0.7 * x)
    assert str(got["regime"]) == "plastic"
    common = math.pi * x * 0.3 * x / (soft.H + hard.H)
    assert float(got["force"]) == pytest.approx(common * soft.H * hard.H, rel=1e-10)
    assert float(got["area_1"]) == pytest.approx(common * hard.H, rel=1e-10)
    assert float(got["area_2"]) == pytest.approx(common * soft.H, rel=1e-10)
    # buried: the great circle at the softer hardness
    got = single(steel, steel, dust, x, 0.0)
    assert float(got["area_1"]) == pytest.approx(math.pi / 4 * x * x, rel=1e-12)
    assert float(got["force"]) == pytest.approx(5e9 * math.pi / 4 * x * x, rel=1e-12)
    # loose
    for gap in (x, 2 * x):
        got = single(steel, steel, dust, x, gap)
        assert got["force"] == got["area_1"] == got["area_2"] == got["delta_1"] == 0
        assert str(got["regime"]) == "none"


@given(first=bodies, second=bodies, dust=bodies, scale=decades(1e-3, 1e3), t=decades(1e-3, 1.2))
def test_particle_scaling_and_swap(first, second, dust, scale, t):
    one = single(first, second, dust, 1e-6, 1e-6 * (1 - t))
    big = single(first, second, dust, scale * 1e-6, scale * 1e-6 * (1 - t))
    assert float(big["force"]) == pytest.approx(scale**2 * float(one["force"]), rel=1e-9)
    turned = single(second, first, dust, 1e-6, 1e-6 * (1 - t))
    assert float(turned["force"]) == pytest.approx(float(one["force"]), rel=1e-10)
    assert float(turned["area_1"]) == pytest.approx(float(one["area_2"]), rel=1e-10)


def test_particle_force_is_monotone():
    gaps = np.linspace(1.1e-6, -0.2e-6, 400)
    for dust in (oracle.SILICA, oracle.Body(5e9, 0.3, 2e8)):
        got = single(oracle.STEEL, oracle.Body(1e11, 0.3, 2e9), dust, 1e-6, gaps)
        assert np.all(np.diff(got["force"]) >= -1e-15 * got["force"].max())
        sizes = np.linspace(0.2e-6, 2e-6, 200)
        grown = single(oracle.STEEL, oracle.STEEL, dust, sizes, 5e-7)
        assert np.all(np.diff(grown["force"]) >= 0)
