"""Mistakes that were met elsewhere, each excluded by a number."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from refusals import Status, balances_not
from scipy import special
from subjects import CASE, E_STAR, FIRST, HEIGHTS, NU, SIGMA_S, H, R, build, contact

import thirdbody as tb
from thirdbody import reference
from thirdbody.equilibrium.states import state_columns
from thirdbody.laws.asperity import elliptic_hertz


def yields_at(law, **changes) -> float:
    return float(law.bound(**CASE, nu=NU).yield_interference(**{**CASE, **changes}))


def test_ceb_ends_at_KH_and_not_at_H():
    for K in (0.6, 0.454 + 0.41 * NU):
        law = build("ceb", K=K)
        p = law.mean_pressure(np.array([1.01, 10, 1e6]) * yields_at(law), **CASE) / H
        assert_allclose(p, K, rtol=1e-13)
        zmc = build("zmc")
        deep = 1e5 * yields_at(zmc)
        ratio = float(law.force(deep, **CASE) / zmc.force(deep, **CASE))
        assert ratio == pytest.approx(K, rel=1e-4)


def test_jump_of_ceb_is_in_the_load_and_not_in_the_area():
    law = build("ceb", K=0.6)
    near = yields_at(law) * np.array([1 - 1e-12, 1 + 1e-12])
    assert float(np.divide(*law.force(near, **CASE)[::-1])) == pytest.approx(1.5, rel=1e-10)
    assert float(np.divide(*law.area(near, **CASE)[::-1])) == pytest.approx(1, rel=1e-10)


def test_k_of_the_mean_and_K_of_the_peak_pressure():
    """k = ⅔K: the two formulas are one."""
    assert yields_at(build("zmc", k=0.4)) == pytest.approx(
        yields_at(build("ceb", K=0.6)), rel=1e-14
    )
    assert yields_at(build("ceb", K=0.4)) == pytest.approx(
        4 / 9 * yields_at(build("zmc", k=0.4)), rel=1e-14
    )
    modern = yields_at(build("ceb", nu=0.3)) / yields_at(build("ceb", K=0.6))
    assert modern == pytest.approx(0.9248, abs=1e-4)  # 8 % below the constant of 1987
    assert build("ceb").yield_factor == pytest.approx(0.454 + 0.41 * NU)


def test_E_star_is_the_sum_of_compliances():
    """1/E* = Σ(1 − ν²)/E, never 2E*; Jackson and Green's E′ is the same."""
    a, b = tb.Material(E=2e11, nu=0.3, H=3e9), tb.Material(E=7e10, nu=0.33, H=1e9)
    pair = tb.MaterialPair(a, b)
    assert pair.E_star == pytest.approx(1 / (0.91 / 2e11 + (1 - 0.33**2) / 7e10), rel=1e-14)
    assert tb.MaterialPair(a, a).E_star == pytest.approx(a.plane_strain_modulus / 2, rel=1e-14)
    law = FIRST["jg"].law
    C, S_y = 1.295 * math.exp(0.736 * NU), H / law.hardness_ratio
    peak = 2 * E_STAR / math.pi * math.sqrt(yields_at(law) / R)
    assert peak == pytest.approx(C * S_y, rel=1e-13)
    near = 1.9 * yields_at(law) * np.array([1 - 1e-12, 1 + 1e-12])
    assert float(np.divide(*law.force(near, **CASE)[::-1])) == pytest.approx(1.00684, abs=1e-4)


def test_ke_and_jg_agree_on_yield():
    """With H = 2.8 S_y, as KE's fits assume and JG's conversion records."""
    for nu, ratio in ((0.3, 1.0008), (0.49, 0.975)):
        ke, jg = build("ke", nu=nu), build("jg", nu=nu)
        assert jg.hardness_ratio == 2.8
        assert yields_at(ke) / yields_at(jg) == pytest.approx(ratio, abs=6e-4) or yields_at(
            jg
        ) / yields_at(ke) == pytest.approx(ratio, abs=6e-4)
    by_three = build("jg", hardness_ratio=3.0)
    assert yields_at(by_three) / yields_at(build("jg")) == pytest.approx((2.8 / 3) ** 2, rel=1e-13)
    assert "hardness_ratio" in by_three.to_dict()


def test_the_ratio_of_hardness_reaches_every_place_of_jg():
    """One S_y stated through two hardnesses is one law: in ω_c, in B and in H_G."""
    S_y = 0.007 * E_STAR
    omega = np.geomspace(1e-6, 0.3, 40) * R
    one, two = (
        build("jg", hardness_ratio=ratio).force(omega, R=R, E_star=E_STAR, H=ratio * S_y)
        for ratio in (2.8, 3.0)
    )
    assert_allclose(one, two, rtol=1e-13)
    wrong = build("jg", hardness_ratio=2.8).force(omega, R=R, E_star=E_STAR, H=3.0 * S_y)
    assert np.max(np.abs(wrong / one - 1)) > 0.04


def test_54_is_kept_for_ellipses_and_said_to_be_an_assumption():
    law = build("elliptic-zmc", ratio=10.0)
    assert law.bound(**CASE).breakpoints == (1.0, 54.0)
    assert "assumption" in (type(law).__doc__ or "")
    assert "lower bound" in (tb.asperity.ZMC.__doc__ or "").replace("\n    ", " ")


def test_a_circle_is_an_ellipse_of_its_own_radius():
    """R_g is √(R′R″), not 1/(1/R′ + 1/R″), which is half of it for a circle."""
    one = elliptic_hertz(1.0)
    assert (one.R_A, one.root_R_F) == pytest.approx((1.0, 1.0), rel=1e-14)


def test_pressed_beyond_the_fits_is_said():
    """Tall asperities leave the fits unnoticed, were it not for the note of a comparison."""
    soft = contact(FIRST["ke"].law, hardness=0.05 * H)
    tall = contact(FIRST["jg"].law, HEIGHTS["exponential"]).replace(
        **{"roughness.sigma": R / 3, "roughness.eta": None, "roughness.eta_R_sigma": 0.05}
    )
    for case in (soft, tall):
        law = case.asperity_law
        assert law.beyond
        assert law.beyond in tb.compare(case, F_star=[1e-4], laws=law.name).note.values[0]
        hard = contact(law, hardness=20 * H)
        assert tb.compare(hard, F_star=[1e-6], laws=law.name).note.values[0] == ""


@pytest.mark.parametrize(("nu", "jump"), [(0.25, 0.1185), (0.29, 0.0865), (0.35, 0.0418)])
def test_jump_of_ke_at_110_depends_on_nu(nu, jump):
    law = build("ke", nu=nu)
    near = yields_at(law.replace(nu=nu)) * 110 * np.array([1 - 1e-12, 1 + 1e-12])
    assert float(np.divide(*law.force(near, **CASE)[::-1])) - 1 == pytest.approx(jump, abs=6e-5)
    p = law.mean_pressure(near, **CASE)
    assert (p[1] < p[0]) == (nu >= 0.31)


def test_pressure_of_ke():
    law = build("ke", nu=0.29)
    near = [yields_at(law) * y * np.array([1 - 1e-12, 1 + 1e-12]) for y in (1, 6, 110)]
    p = np.concatenate([law.mean_pressure(w, **CASE) / H for w in near])
    assert_allclose(p, [0.382, 0.423, 0.710, 0.702, 0.986, 1], atol=6e-4)


def test_jg_has_no_plateau():
    """Beyond a/R of 0.41 the printed formulas give a pressure that keeps falling."""
    law = FIRST["jg"].law
    S_y = H / law.hardness_ratio
    p = law.mean_pressure(yields_at(law) * np.array([110.0, 1e3, 1e4]), **CASE) / S_y
    assert_allclose(p, [2.41, 1.46, 0.53], atol=6e-3)
    assert "plastic" not in law.regime(yields_at(law) * np.geomspace(0.1, 1e5, 30), **CASE)


def test_curves_of_jg_do_not_collapse():
    law = build("jg")
    curves = []
    for S_y in (1e-3, 7e-3):
        case = {"R": R, "E_star": E_STAR, "H": 2.8 * S_y * E_STAR}
        own = float(law.bound(**case).yield_interference(**case))
        curves.append(law.force(own * np.array([1.0, 110.0]), **case))
    one, two = (curve[1] / curve[0] for curve in curves)
    assert abs(one / two - 1) > 0.05


def test_elliptic_integrals_take_the_parameter():
    """K of m = 1 − k², not of the modulus; the axis ratio is not the approximation λ^(−2/3)."""
    for ratio, off in ((2.0, 0.001), (10.0, 0.03), (100.0, 0.18)):
        one = elliptic_hertz(ratio)
        assert one.K == pytest.approx(float(special.ellipk(1 - one.k**2)), rel=1e-13)
        assert one.K != pytest.approx(float(special.ellipk(math.sqrt(1 - one.k**2))), rel=1e-3)
        assert abs(one.k * ratio ** (2 / 3) - 1) == pytest.approx(off, abs=0.006)


def test_geometric_and_elastic_areas_of_an_ellipse():
    """R_A < √(R′R″), 5.9 % at λ = 10; the plastic section is 2π√(R′R″)ω, not twice the elastic."""
    assert 1 - elliptic_hertz(10.0).R_A == pytest.approx(0.0591, abs=1e-4)
    law = build("elliptic-ceb", K=0.6, ratio=10.0)
    deep = 1e7 * yields_at(law)
    areas = [
        float(law.replace(area_rule=rule).area(deep, **CASE)) for rule in ("volume", "doubling")
    ]
    assert areas[0] / areas[1] == pytest.approx(1 / 0.94088, rel=1e-5)


def test_sum_of_hertz_is_the_exact_integral():
    """F_{3/2}, and the exact F_{5/2}: the fit 4.4086e-5 (4 − h)^6.804 stands nowhere."""
    h = np.array([0.0, 1.5, 3.0, 5.0])
    state = tb.solve(contact(FIRST["gw"].law), d=h * SIGMA_S)
    exact = 4 / 3 * 0.05 * math.sqrt(0.01) * reference.gaussian_integral(h, n=1.5)
    assert_allclose(state.F_star, exact, rtol=1e-11)
    assert np.all(state.F_star > 0)
    code = Path(tb.__file__).parent.rglob("*.py")
    lines = [line for path in code for line in path.read_text("utf-8").splitlines()]
    assert not [x for x in lines if "6.804" in x and ("=" in x or "return" in x)]


def test_derivative_holds_the_jump_of_ceb():
    """∫F₁′φ alone misses a part that is not small."""
    from battery import ETA, by_parts, edges

    from thirdbody.contact.interface import interface

    law = FIRST["ceb"].law
    bare = contact(law)
    got = float(interface(bare).load(np.array([SIGMA_S]))[0, 1])
    assert got == pytest.approx(by_parts(law, HEIGHTS["gaussian"], 1.0), rel=1e-9)
    (yielding,) = edges(law)
    jump = 0.5 * float(law.force(yielding * (1 - 1e-12), **CASE))
    part = -ETA * jump * float(HEIGHTS["gaussian"].pdf(1 + yielding / SIGMA_S)) / SIGMA_S
    assert 0.005 < part / got < 0.2


def test_dmt_begins_with_a_pull():
    """−2πwR at first touch; JKR −4/3 πwR on loading."""
    law = FIRST["dmt"].law
    assert float(law.force(0.0, **CASE)) == 0
    first = float(law.force(1e-25, **CASE)) / (math.pi * law.w * R)
    assert first == pytest.approx(-2, rel=1e-12)


@pytest.mark.check
@pytest.mark.parametrize("name", FIRST)
@pytest.mark.parametrize("radius", [1e-9, 2.8e-6, 1.0])
def test_no_law_gives_no_number(name, radius):
    """Whatever body a law takes, its loads and areas are finite, and areas not negative."""
    law = FIRST[name].law
    for ratio in np.geomspace(1e-4, 10, 16):
        for nu in (-0.9, 0.0, 0.5):
            case = {"R": radius, "E_star": E_STAR, "H": ratio * E_STAR}
            bound = law.bound(**case, nu=nu)
            # from a millionth of first yield, or of R, to R or to where the law ends
            first = float(bound.yield_interference(**case))
            y = np.geomspace(1e-6, max(min(radius / first, bound.valid_to), 1e-5), 300)
            for quantity in ("force", "area", "stiffness"):
                values = bound.reduced(quantity, y)
                assert np.all(np.isfinite(values)), (quantity, ratio, nu)
                assert quantity != "area" or np.all(values >= 0)


@pytest.mark.parametrize("hardness", [0.5, 1.0, 2.0])
def test_jackson_green_beyond_its_fits(hardness):
    """The exponent of its area overflows; such states were "ok" without area and mode."""
    hard = contact(build("jg"), hardness=hardness * E_STAR)
    hard = hard.replace(roughness=tb.Roughness(sigma=R, R=R))
    vary = {"roughness.R": R * np.linspace(1, 1.1, 30)}
    loads = np.geomspace(1e-8, 1e-3, 30)
    for found in (
        tb.solve(hard, F_star=loads).columns(),
        tb.solve(hard, d=R * np.linspace(0, 4, 30)).columns(),
        state_columns(hard, F_star=loads, vary=vary),
    ):
        ok = found["status"] == "ok"
        assert np.all(np.isfinite(found["A_t"][ok]) & (found["mode"][ok] == "s-s"))
        crowded = np.array([word.startswith("crowded: ") for word in found["status"]])
        beyond = ~ok & ~crowded
        assert np.all(np.isnan(found["d"][beyond]))
        assert not beyond.any() if hardness < 1 else beyond.all()
        for word in found["status"][beyond]:
            assert "jg: at a/R above 0.41, out of its fits" in word


@pytest.mark.parametrize("load", [{"d": 1e-8}, {"F_star": 1e-4}])
def test_an_area_that_is_no_number_is_not_ok(load):
    class Broken(type(build("gw"))):
        __slots__ = ()

        def reduced(self, quantity, y):
            out = super().reduced(quantity, y)
            return out * np.nan if quantity == "area" else out

    with balances_not(Status.BEYOND_LAWS):
        tb.solve(contact(Broken()), **load)
