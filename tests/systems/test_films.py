"""Film formulas: published values, limits, homogeneity, and the dry contact they start from."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy import special

import thirdbody as tb
from thirdbody.systems import film_formulas as films

BALL = {"speed": 1.0, "eta": 0.04, "alpha": 2e-8, "R": 0.0127, "E": 226.37e9}
POINTS = (films.HamrockDowson(), films.NijenbanningVennerMoes())
LINES = (films.DowsonLine(), films.MoesLine())


@pytest.mark.parametrize(
    ("film", "load", "value"),
    [
        (films.NijenbanningVennerMoes(), 50.0, 3.0700580731082364e-07),
        (films.HamrockDowson(), 50.0, 2.7474960623905863e-07),
    ],
)
def test_reference_points(film, load, value):
    assert film.central(load=load, **BALL) == pytest.approx(value, rel=1e-12)


def test_reference_line():
    smallest = films.DowsonLine().minimum(load=1e5, **BALL)
    assert smallest == pytest.approx(3.0285524501050375e-07, rel=1e-12)
    ratio = films.MoesLine().central(load=1e5, **BALL) / films.DowsonLine().central(
        load=1e5, **BALL
    )
    assert ratio == pytest.approx(1, abs=0.002)


@pytest.mark.parametrize(("load", "more"), [(5.0, 0.025), (50.0, 0.105), (500.0, 0.14)])
def test_the_two_point_formulas_differ_as_stated(load, more):
    hamrock, moes = (film.central(load=load, **BALL) for film in POINTS)
    assert 1 - hamrock / moes == pytest.approx(more, abs=0.005)
    other = films.NijenbanningVennerMoes(blend="EI/EP").central(load=load, **BALL)
    assert -0.11 < other / moes - 1 < -0.06


def test_grease_on_glass():
    """Films reported for a steel ball on glass: within 16 %, in their order."""
    E = 2 / ((1 - 0.3**2) / 206e9 + (1 - 0.2**2) / 63e9)
    u = np.array([0.1, 0.15, 0.2, 0.3])
    h = films.NijenbanningVennerMoes().central(
        load=20.0, speed=u, eta=0.38, alpha=30e-9, R=9.53e-3, E=E
    )
    assert np.round(h * 1e9).tolist() == [361, 474, 574, 751]
    assert np.all(np.abs(h * 1e9 / [353, 493, 500, 655] - 1) < 0.16)


@pytest.mark.parametrize("blend", ["EI/RI", "EI/EP"])
def test_point_blend_is_homogeneous(blend):
    film = films.NijenbanningVennerMoes(blend=blend)
    rng = np.random.default_rng(3)
    limits = np.exp(rng.uniform(-3, 3, (4, 50)))
    c = 7.3
    one = film.join_limits(films.Asymptotes(*limits), H_00=1.8)
    many = film.join_limits(films.Asymptotes(*(c * limits)), H_00=c * 1.8)
    np.testing.assert_allclose(many, c * one, rtol=1e-13)


def test_line_blend_is_homogeneous():
    limits = np.exp(np.random.default_rng(4).uniform(-3, 3, (4, 50)))
    one = films.MoesLine().join_limits(films.Asymptotes(*limits))
    many = films.MoesLine().join_limits(films.Asymptotes(*(7.3 * limits)))
    np.testing.assert_allclose(many, 7.3 * one, rtol=1e-13)


@pytest.mark.parametrize("film", [films.NijenbanningVennerMoes(), films.MoesLine()])
@pytest.mark.parametrize("which", range(4))
def test_blend_tends_to_each_limit(film, which):
    """One limit alone: the rest are far below, and the piezoviscous partner far above."""
    small, large = 1e-9, 1e9
    limits = [small, small, large if which == 3 else small, large if which == 2 else small]
    limits[which] = 1.0
    extra = {"H_00": 1e12} if film.shape == "point" else {}
    at = films.Asymptotes(*limits)
    assert float(film.join_limits(at, **extra)) == pytest.approx(1, rel=1e-6)
    assert str(at.regime) == films.REGIMES[which]


def growth(film, load, **inputs):
    """Exponent of γ in h where load and modulus are divided by γ."""
    h = [
        film.central(load=load / g, **{**BALL, **inputs, "E": BALL["E"] / g}) for g in (1.0, math.e)
    ]
    return math.log(h[1] / h[0])


def test_film_hardly_depends_on_who_carries_the_load():
    """h ∝ γ⁰ in the limit, exactly; published exponents are rounded."""
    assert growth(films.HamrockDowson(), 50.0) == pytest.approx(0.67 - 0.53, rel=1e-10)
    assert growth(films.DowsonLine(), 1e5) == pytest.approx(0.69 - 0.56, rel=1e-10)
    for film, load in ((films.NijenbanningVennerMoes(), 50.0), (films.MoesLine(), 1e5)):
        scale = []
        for g in (1.0, math.e):
            inputs = {**BALL, "E": BALL["E"] / g}
            U = BALL["eta"] * BALL["speed"] / (inputs["E"] * BALL["R"])
            scale.append(film.asymptotes(load=load / g, **inputs).EP * (2 * U) ** 0.5)
        assert scale[1] == pytest.approx(scale[0], rel=1e-13)


def test_ellipse_against_elliptic_integrals():
    """Johnson's eqs. (4.26) and (4.32), with K and E instead of Carlson's integrals."""
    for b_over_a in (0.9, 0.4, 0.1):
        m = 1 - b_over_a**2
        K, E = special.ellipk(m), special.ellipe(m)
        ratio = (E / b_over_a**2 - K) / (K - E)
        factor = 4 / (math.pi * m) * b_over_a**1.5 * math.sqrt((E / b_over_a**2 - K) * (K - E))
        R_y, modulus, load = 0.02, 220e9, 35.0
        R_x = R_y / ratio
        c = (3 * load * math.sqrt(R_x * R_y) / (2 * modulus) * factor) ** (1 / 3)
        for point in (films.Point(R=R_x, R_y=R_y), films.Point(R=R_y, R_y=R_x)):
            found = point.hertz(load, E=modulus)
            assert found.area == pytest.approx(math.pi * c * c, rel=1e-10)
            assert found.maximum == pytest.approx(1.5 * load / (math.pi * c * c), rel=1e-10)


def test_round_and_line_contacts():
    a = (3 * 20 * 9.5e-3 / (2 * 220e9)) ** (1 / 3)
    assert films.Point(R=9.5e-3).hertz(20.0, E=220e9).area == pytest.approx(math.pi * a * a)
    line = films.Line(R=0.01, length=0.02).hertz(2000.0, E=220e9)
    p_0 = math.sqrt(1e5 * 220e9 / (2 * math.pi * 0.01))
    assert line.maximum == pytest.approx(p_0, rel=1e-12)
    assert line.mean * line.area == pytest.approx(2000)


@pytest.mark.parametrize("law", ["roelands", "barus"])
def test_viscosity_starts_with_the_slope_alpha(law):
    oil = films.Oil(eta=0.03, alpha=1.8e-8, viscosity=law)
    p = 1e3
    slope = math.log(oil.at_pressure(p) / oil.at_pressure(0.0)) / p
    assert slope == pytest.approx(1.8e-8, rel=1e-4)
    # an oil ends as a glass, whatever the pressure
    assert films.Oil(eta=0.03, alpha=1.8e-8, viscosity=law).at_pressure(1e14) == pytest.approx(1e12)


def test_shear_stress():
    oil = films.Oil(eta=0.03, alpha=1.8e-8, eyring_stress=4e6)
    # Newtonian when slow, a logarithm when fast, bounded by the limiting stress
    assert oil.shear_stress(1.0, pressure=0.0) == pytest.approx(0.03, rel=1e-10)
    fast = oil.shear_stress(1e12, pressure=0.0)
    assert fast == pytest.approx(4e6 * math.log(2 * 0.03e12 / 4e6), rel=1e-6)
    assert oil.replace(limiting_stress=1e7).shear_stress(1e12, pressure=0.0) == 1e7
    assert np.isnan(films.Oil(eta=0.03, alpha=1.8e-8).shear_stress(1.0, pressure=0.0))


def test_formulas_say_where_they_hold():
    light = films.NijenbanningVennerMoes().asymptotes(load=1e-4, **BALL).regime
    (sentence,) = films.HamrockDowson().warnings(light, 1.0)
    assert "NijenbanningVennerMoes" in sentence
    assert "outside 0 to 1" in films.HamrockDowson().warnings(films.EP, 2.0)[0]
    assert films.NijenbanningVennerMoes().warnings(light, 1.0) == []
    assert set(films.FORMULAS) == {film.name for film in (*POINTS, *LINES)}


def test_refusals():
    with refuses(Mistake.RANGE, "Oil.eta", value="-1.0", says="0.0001"):
        films.Oil(eta=-1.0, alpha=2e-8)
    with refuses(Mistake.RANGE, "Point.R", value="0.0"):
        films.Point(R=0.0)
    with pytest.raises(tb.errors.InvalidValue, match="viscosity"):
        films.Oil(eta=0.04, alpha=2e-8, viscosity="honey")
