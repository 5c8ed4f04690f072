"""Reference solutions against independent integrals, stored numbers, and the library's laws."""

import math

import mpmath
import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.integrate import quad

from thirdbody import InvalidValue, reference
from thirdbody.laws import asperity as asperity_laws

# ηRσ_s = 0.05, σ_s/R = 0.01, H/E* = 0.02: lengths in R, pressures in E*
R, SIGMA_S, ETA, E_STAR, H, NU = 1.0, 0.01, 5.0, 1.0, 0.02, 0.29
POPULATION = dict(eta=ETA, sigma_s=SIGMA_S, R=R)


def test_hertz_is_the_elastic_law():
    gw = asperity_laws.GW()
    body = dict(R=2e-6, E_star=1.1e11)
    found = reference.hertz_point(gw.force(3e-9, H=1e9, **body), **body)
    assert found.interference == pytest.approx(3e-9, rel=1e-14)
    assert found.area == pytest.approx(gw.area(3e-9, H=1e9, **body), rel=1e-14)
    assert found.stiffness == pytest.approx(gw.stiffness(3e-9, H=1e9, **body), rel=1e-14)
    assert found.peak_pressure == pytest.approx(1.5 * found.mean_pressure, rel=1e-14)
    force = found.mean_pressure * found.area
    assert force == pytest.approx(gw.force(3e-9, H=1e9, **body), rel=1e-14)


@pytest.mark.parametrize("n", [0, 0.5, 1, 1.5, 2.5, 4])
@pytest.mark.parametrize("h", [-12.0, -3.0, 0.0, 1.0, 3.0, 4.5, 12.0])
def test_gaussian_integral_is_a_parabolic_cylinder_function(n, h):
    with mpmath.workdps(40):
        scale = mpmath.gamma(n + 1) * mpmath.exp(-(mpmath.mpf(h) ** 2) / 4)
        exact = float(scale * mpmath.pcfd(-n - 1, h) / mpmath.sqrt(2 * mpmath.pi))
    assert reference.gaussian_integral(h, n=n) == pytest.approx(exact, rel=2e-13)


def test_gaussian_integral_relations():
    h = np.linspace(-4, 8, 25)
    F = {n: reference.gaussian_integral(h, n=n) for n in (0.5, 1.5, 2.5, 3.5)}
    # F_{n+2} + h F_{n+1} = (n+1) F_n
    np.testing.assert_allclose(F[2.5] + h * F[1.5], 1.5 * F[0.5], rtol=1e-11)
    step = 1e-4
    slope = reference.gaussian_integral(h + step, n=2.5) - reference.gaussian_integral(
        h - step, n=2.5
    )
    np.testing.assert_allclose(slope / (2 * step), -2.5 * F[1.5], rtol=1e-6)
    with pytest.raises(InvalidValue):
        reference.gaussian_integral(0.0, n=-0.5)


def test_the_usual_fit_to_the_gaussian_integral_is_not_used():
    for h, miss in ((0.0, -0.107), (3.0, -0.74), (4.0, -1.0)):
        fit = 4.4086e-5 * (4 - h) ** 6.804
        found = float(fit / reference.gaussian_integral(h, n=2.5)) - 1
        assert found == pytest.approx(miss, abs=0.005)
    assert reference.gaussian_integral(6.0, n=2.5) > 0


# ---------------------------------------------------------------- exponential heights
CLOSED = {
    "gw": lambda h: reference.exponential_gw(h, **POPULATION, E_star=E_STAR),
    "ceb": lambda h: reference.exponential_ceb(h, **POPULATION, E_star=E_STAR, H=H, K=0.6),
    "ke": lambda h: reference.exponential_ke(
        h, **POPULATION, E_star=E_STAR, H=H, K=0.454 + 0.41 * NU
    ),
}
LAWS = {
    "gw": asperity_laws.GW(),
    "ceb": asperity_laws.CEB(K=0.6),
    "ke": asperity_laws.KE(nu=NU),
    "zmc": asperity_laws.ZMC(),
    "hermite": asperity_laws.Hermite(),
    "jg": asperity_laws.JG(nu=NU, hardness_ratio=H / 0.007),
    "elliptic-ceb": asperity_laws.EllipticCEB(ratio=4.0, K=0.6),
    "elliptic-zmc": asperity_laws.EllipticZMC(ratio=4.0),
}
# load over A_n E* and area at h = 1.5
STORED = {
    "gw": (0.000727459359562517, 0.01289388143233844),
    "ceb": (0.0003040075505611869, 0.0253376790497238),
    "ke": (0.0003883637330983932, 0.02150406169792809),
    "zmc": (0.0004273291857701961, 0.0224509982799929),
    "hermite": (0.0004402884511114017, 0.0224509982799929),
    "jg": (0.0003725399969407053, 0.02220100245356052),
    "elliptic-ceb": (0.0003045386800841736, 0.02538103979100398),
    "elliptic-zmc": (0.0004398296130505694, 0.02290060656687227),
}


def summed(law, h, quantity):
    """η ∫ q(z − d) φ(z) dz over the heights that touch, by adaptive quadrature."""
    bound = law.bound(R=R, E_star=E_STAR, H=H, nu=NU)
    omega_1 = bound.yield_interference(R=R, E_star=E_STAR, H=H)
    ends = [0.0, *(y * omega_1 / SIGMA_S for y in bound.breakpoints), 60.0]
    one = bound.force if quantity == "force" else bound.area

    def integrand(root):
        t = root * root
        value = float(one(t * SIGMA_S, R=R, E_star=E_STAR, H=H))
        return 2 * root * value * math.exp(-(h + t + 1))

    return ETA * sum(
        quad(integrand, math.sqrt(a), math.sqrt(b), epsabs=0, epsrel=1e-12, limit=200)[0]
        for a, b in zip(ends[:-1], ends[1:], strict=True)
        if b > a
    )


@pytest.mark.parametrize("name", LAWS)
def test_exponential_heights_make_every_law_linear(name):
    law = LAWS[name]
    load, area = ([summed(law, h, q) for h in (-1.0, 0.5, 1.5, 4.0)] for q in ("force", "area"))
    np.testing.assert_allclose(np.divide(load, area), load[0] / area[0], rtol=1e-11)
    np.testing.assert_allclose(np.diff(np.log(load)), [-1.5, -1.0, -2.5], rtol=1e-11)
    assert (load[2], area[2]) == pytest.approx(STORED[name], rel=1e-10)
    if name in CLOSED:
        closed = CLOSED[name](np.array([-1.0, 0.5, 1.5, 4.0]))
        np.testing.assert_allclose(closed.pressure, load, rtol=1e-11)
        np.testing.assert_allclose(closed.area, area, rtol=1e-11)


@pytest.mark.parametrize("name", CLOSED)
def test_exponential_closed_forms_give_the_stored_sums(name):
    closed = CLOSED[name](1.5)
    assert (closed.pressure, closed.area) == pytest.approx(STORED[name], rel=1e-13)
    assert np.diff(np.log(CLOSED[name]([0.0, 7.0]).pressure))[0] == pytest.approx(-7, rel=1e-14)


def test_limits_of_the_exponential_closed_forms():
    elastic = CLOSED["gw"](1.0)
    hard = dict(POPULATION, E_star=E_STAR, H=1.0)
    for form in (reference.exponential_ceb(1.0, **hard), CLOSED["gw"](1.0)):
        assert form.pressure == pytest.approx(elastic.pressure, rel=1e-9)
        assert form.area == pytest.approx(elastic.area, rel=1e-9)
    assert reference.exponential_ke(1.0, **hard, K=0.6).area == pytest.approx(
        float(elastic.area), rel=1e-9
    )
    soft = dict(POPULATION, H=1e-7)
    plastic = reference.exponential_plastic(1.0, **soft)
    ke = reference.exponential_ke(1.0, **soft, E_star=E_STAR, K=0.6)
    assert ke.pressure == pytest.approx(plastic.pressure, rel=1e-6)
    assert ke.area == pytest.approx(plastic.area, rel=1e-6)
    ceb = reference.exponential_ceb(1.0, **soft, E_star=E_STAR, K=0.6)
    assert ceb.pressure == pytest.approx(0.6 * plastic.pressure, rel=1e-6)


def test_exponential_heights_end_below_the_mean():
    with refuses(Mistake.RANGE, "h"):
        reference.exponential_gw(-1.01, **POPULATION, E_star=E_STAR)


# ---------------------------------------------------------------- slope laws
@pytest.mark.parametrize(
    ("ratio", "fraction"),
    [
        (1e-6, 1.59576912160467e-06),
        (0.01, 0.015956627433804),
        (0.1, 0.158519418878206),
        (0.5, 0.682689492137086),
        (2.0, 0.999936657516334),
    ],
)
def test_persson(ratio, fraction):
    found = reference.persson_area(ratio * 0.2 * 1e11, E_star=1e11, g=0.2)
    assert found == pytest.approx(fraction, rel=1e-13)


def test_slopes_at_vanishing_load():
    assert reference.PERSSON_SLOPE == pytest.approx(math.sqrt(8 / math.pi), rel=1e-15)
    assert reference.BUSH_GIBSON_THOMAS_SLOPE == pytest.approx(math.sqrt(2 * math.pi), rel=1e-15)
    pressure, body = 1e-9, dict(E_star=1.0, g=0.05)
    persson = reference.persson_area(pressure, **body) * body["g"] / pressure
    assert persson == pytest.approx(1.5957691216, rel=1e-10)
    asymptote = reference.bush_gibson_thomas_area(pressure, **body) * body["g"] / pressure
    assert asymptote == pytest.approx(2.5066282746, rel=1e-10)
    with pytest.raises(InvalidValue):
        reference.persson_area(1.0, E_star=1.0, g=0.0)


def test_stored_persson_values(shared_reference):
    for row in shared_reference("laws.json")["persson"]:
        found = reference.persson_area(row["p_over_Estar_g"], E_star=1.0, g=1.0)
        assert found == pytest.approx(float(row["A"]), rel=1e-12)
