"""A sphere that ploughs: against integrals over its surface, and against other printed forms."""

import math

import mpmath
import numpy as np
import pytest
from scipy import integrate

from thirdbody.effects.single.ploughing import (
    coefficient,
    groove_area,
    rear_support,
    residual_depth,
)
from thirdbody.effects.single.severity import severity, threshold

DEPTHS = [1e-10, 1e-6, 1e-3, 0.0399, 0.0401, 0.1, 0.5, 0.9, 1.0]


@pytest.mark.parametrize("w", [*DEPTHS, 1.5, 2.0])
def test_groove_is_a_segment_of_a_circle(w):
    with mpmath.workdps(40):
        theta = mpmath.acos(1 - mpmath.mpf(w))
        exact = float(theta - mpmath.sin(theta) * mpmath.cos(theta))
    assert groove_area(3 * w, radius=3.0) == pytest.approx(9 * exact, rel=5e-15)


def test_groove_by_quadrature():
    for w in (0.01, 0.5):
        b = math.sqrt(w * (2 - w))
        area = integrate.quad(lambda y, w=w: math.sqrt(1 - y * y) - (1 - w), -b, b, epsrel=1e-13)
        assert groove_area(w, radius=1.0) == pytest.approx(area[0], rel=1e-10)


@pytest.mark.parametrize("theta", [0.1, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("kappa", [0.0, 0.3])
def test_coefficient_is_the_pressure_integral_over_both_halves(theta, kappa):
    """Traction −p n on the cap, p in front, κ p behind; n is the normal of the sphere."""

    def integral(of):
        def half(sign):
            return integrate.dblquad(
                lambda polar, azimuth: of(polar, azimuth) * math.sin(polar),
                sign * math.pi / 2 - math.pi / 2,
                sign * math.pi / 2 + math.pi / 2,
                0.0,
                theta,
                epsabs=1e-13,
            )[0]

        return half(1), half(-1)

    # azimuth 0..π is one half; measured from the direction across the motion
    up = integral(lambda polar, azimuth: math.cos(polar))
    along = integral(lambda polar, azimuth: math.sin(polar) * math.sin(azimuth))
    load = up[0] + kappa * up[1]
    force = along[0] + kappa * along[1]
    assert coefficient(1 - math.cos(theta), radius=1.0, rear=kappa) == pytest.approx(
        force / load, rel=1e-10
    )


@pytest.mark.parametrize("w", [0.01, 0.2, 0.9])
def test_printed_form_of_bowden_and_tabor(w):
    b = math.sqrt(w * (2 - w))
    printed = 2 / math.pi * (math.asin(b) / b**2 - math.sqrt(1 / b**2 - 1))
    assert coefficient(w, radius=1.0) == pytest.approx(printed, rel=1e-11)


def test_limits():
    b = math.sqrt(1e-8 * (2 - 1e-8))
    assert coefficient(1e-8, radius=1.0) == pytest.approx(4 / (3 * math.pi) * b, rel=1e-8)
    assert coefficient(1.0, radius=1.0) == pytest.approx(1.0, rel=1e-14)
    assert coefficient(1.7, radius=1.0) == coefficient(1.0, radius=1.0)
    assert coefficient(0.4, radius=1.0, rear=1.0) == 0
    assert np.all(coefficient([0.0, -1.0], radius=1.0) == 0)
    assert groove_area(1e-6, radius=1.0) == pytest.approx(4 / 3 * math.sqrt(2e-6) * 1e-6, rel=1e-6)


def test_lever_of_the_rolling_sphere():
    """The load sits 4b/3π ahead of the centre, the resistance r_c below it: the ratio is μ_p."""
    theta = 0.5
    offset = 4 / (3 * math.pi) * math.sin(theta)
    lever = 2 / 3 * math.sin(theta) ** 3 / (theta - math.sin(theta) * math.cos(theta))
    # the centroid of the groove's segment, by quadrature
    top = math.cos(theta)
    moment = integrate.quad(lambda z: 2 * z * math.sqrt(1 - z * z), top, 1, epsrel=1e-13)[0]
    assert lever == pytest.approx(moment / groove_area(1 - top, radius=1.0), rel=1e-9)
    assert offset / lever == pytest.approx(coefficient(1 - top, radius=1.0), rel=1e-13)
    assert offset / lever == pytest.approx(0.2195414657361866, rel=1e-13)


def test_rear_half_follows_from_recovery():
    s = np.geomspace(0.1, 1e4, 40)
    np.testing.assert_allclose(
        rear_support(s), 1 - residual_depth(1.0, depth_over_yield=s), rtol=0, atol=1e-15
    )
    assert rear_support(54.0) == pytest.approx(1 - (1 - 54**-0.28) * (1 - 54**-0.69), rel=1e-14)
    assert np.all(rear_support([0.0, 0.5, 1.0]) == 1)
    assert np.all(np.diff(rear_support(np.geomspace(1, 1e4, 50))) < 0)
    assert residual_depth(10.0, depth_over_yield=10.0) == pytest.approx(
        3.7817067580703516, rel=1e-14
    )


def test_severity_is_that_of_a_layer_of_slurry():
    """S = W/(A v H') with as many particles as a layer one diameter high holds."""
    W, A, v, H_1, H_2, x = 2.0, 1e-6, 0.03, 7e9, 2e9, 4e-6
    count = A * 6 * v / (math.pi * x**2)
    whole = W / (A * v) * (1 / H_1 + 1 / H_2)
    assert severity(W / count, x=x, H_1=H_1, H_2=H_2) == pytest.approx(whole, rel=1e-14)
    # plastic and symmetric: f = H π r δ·2 with δ = (x − d)/2 gives S = 6 (x − d)/x
    H, d = 5e9, 3.9e-6
    plastic = H * math.pi * x * (x - d) / 2
    assert severity(plastic, x=x, H_1=H, H_2=H) == pytest.approx(6 * (x - d) / x, rel=1e-12)


def test_threshold():
    assert threshold(1.0, H_b=1.0) == 0.0076
    assert threshold(2e9, H_b=8e9) == pytest.approx(0.01499073710829906, rel=1e-13)
