"""Stribeck's formula and Sjövall's integral: tables, closed forms, and sums over the bodies."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.integrate import quad

from thirdbody.systems.load_sharing import (
    BALLS,
    ROLLERS,
    RadialShare,
    radial_integral,
    share_radial_load,
)

HARRIS = {  # Harris 2001, table 7.1, from memory: J_r of point and of line contacts, n = 1.5 and 1.1
    0.1: (0.1156, 0.1268),
    0.2: (0.1590, 0.1737),
    0.3: (0.1892, 0.2055),
    0.4: (0.2117, 0.2286),
    0.5: (0.2288, 0.2453),
    0.6: (0.2416, 0.2568),
    0.7: (0.2505, 0.2636),
    0.8: (0.2559, 0.2658),
    0.9: (0.2576, 0.2628),
    1.0: (0.2546, 0.2523),
    1.25: (0.2289, 0.2078),
    5 / 3: (0.1871, 0.1589),  # printed as 1.67
    2.5: (0.1339, 0.1075),
    5.0: (0.0711, 0.0544),
}


@pytest.mark.parametrize("eps", HARRIS)
def test_the_published_table(eps):
    for exponent, printed in zip((1.5, 1.1), HARRIS[eps], strict=True):
        assert radial_integral(eps, exponent=exponent) == pytest.approx(printed, abs=7e-5)


@pytest.mark.parametrize("eps", [1e-4, 0.05, 0.3, 0.5, 0.9, 0.999, 1.0, 1.001, 1.5, 5.0, 100.0])
@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5])
def test_the_definition_by_another_quadrature(eps, exponent):
    end = math.acos(max(1 - 2 * eps, -1.0))

    def load(psi):
        return max(1 - (1 - math.cos(psi)) / (2 * eps), 0.0) ** exponent * math.cos(psi)

    found = quad(load, 0, end, epsabs=1e-13, epsrel=1e-10, limit=500)[0] / math.pi
    assert radial_integral(eps, exponent=exponent) == pytest.approx(found, rel=1e-8)


@pytest.mark.parametrize("eps", [0.01, 0.3, 0.5, 0.8, 0.999])
def test_the_closed_form_of_a_linear_law(eps):
    end = math.acos(1 - 2 * eps)
    exact = (end - math.sin(end) * math.cos(end)) / (4 * math.pi * eps)
    assert radial_integral(eps, exponent=1.0) == pytest.approx(exact, rel=1e-12)


def test_stribecks_numbers():
    """4.37 F/Z of balls, 4.08 F/Z of rollers, without clearance."""
    assert 1 / radial_integral(0.5) == pytest.approx(4.37, abs=0.005)
    assert 1 / radial_integral(0.5, exponent=1.1) == pytest.approx(4.08, abs=0.005)
    exact = (
        2 * math.pi / quad(lambda p: math.cos(p) ** 2.5, -math.pi / 2, math.pi / 2, epsabs=1e-13)[0]
    )
    found = share_radial_load(900.0, bodies=9, stiffness=1e10)
    assert found.largest == pytest.approx(exact * 100, rel=1e-11)
    assert found.eps == pytest.approx(0.5, rel=1e-12)


def turned(found: RadialShare, bodies, exponent, turns=720):
    """Mean over places of the cage of the sum over the bodies, over the load; and its spread."""
    sums = []
    for offset in np.arange(turns) / turns * 2 * math.pi / bodies:
        angles = offset + 2 * math.pi * np.arange(bodies) / bodies
        level = np.maximum(1 - (1 - np.cos(angles)) / (2 * found.eps), 0.0)
        sums.append(found.largest * level**exponent @ np.cos(angles))
    return np.mean(sums) / found.force, np.ptp(sums) / found.force


@pytest.mark.parametrize("clearance", [-20e-6, -2e-6, 0.0, 5e-6, 40e-6])
@pytest.mark.parametrize("exponent", [BALLS, ROLLERS])
def test_the_bodies_hold_the_load(clearance, exponent):
    """However the cage stands, the sum over the bodies is the load on average."""
    stiffness = 1e10 if exponent == BALLS else 1e8
    for bodies in (7, 9, 14):
        given = dict(bodies=bodies, stiffness=stiffness, clearance=clearance, exponent=exponent)
        found = share_radial_load(2000.0, **given)
        mean, spread = turned(found, bodies, exponent)
        assert mean == pytest.approx(1, rel=2e-4)
        assert abs(found.balance - 1) <= spread
        # what the most loaded one gives way is what the rings approach there
        pressed = (found.largest / stiffness) ** (1 / exponent)
        assert found.shift == pytest.approx(pressed + clearance / 2, rel=1e-9, abs=1e-15)
        assert found.loads[0] == pytest.approx(found.largest, rel=1e-12)


def test_clearance_and_load_work_against_each_other():
    shares = [
        share_radial_load(F, bodies=9, stiffness=1e10, clearance=20e-6) for F in (1, 1e3, 1e6)
    ]
    assert [each.carrying for each in shares] == sorted(each.carrying for each in shares)
    zones = [each.eps for each in shares]
    assert zones == sorted(zones)
    assert zones[-1] == pytest.approx(0.5, abs=0.02)
    factors = [each.largest * 9 / each.force for each in shares]
    assert factors == sorted(factors, reverse=True)


def test_a_preload_far_above_the_load_is_carried_by_all():
    found = share_radial_load(1.0, bodies=9, stiffness=1e10, clearance=-20e-6)
    even = 1e10 * (10e-6) ** 1.5
    assert found.carrying == 9
    np.testing.assert_allclose(found.loads, even, rtol=1e-2)
    assert found.balance == pytest.approx(1, rel=1e-6)


@pytest.mark.parametrize(
    "given", [{"force": 0.0}, {"bodies": 0.0}, {"stiffness": math.nan}, {"clearance": math.inf}]
)
def test_mistakes(given):
    (name,) = given
    force, others = given.pop("force", 1.0), {"bodies": 9, "stiffness": 1e10} | given
    with refuses(Mistake.RANGE, name):
        share_radial_load(force, **others)
    with refuses(Mistake.RANGE, "eps", value="0.0"):
        radial_integral(0.0)


@pytest.mark.parametrize("exponent", [BALLS, ROLLERS])
def test_one_body_never_carries_more_than_the_load(exponent):
    """With much clearance the bodies at their places balance it, found by a search of its own."""
    rng = np.random.default_rng(4)
    few = 0
    for _ in range(200):
        bodies, clearance = int(rng.integers(5, 20)), 10 ** rng.uniform(-6, -4)
        force, stiffness = 10 ** rng.uniform(0, 4), 10 ** rng.uniform(9, 11)
        found = share_radial_load(
            force, bodies=bodies, stiffness=stiffness, clearance=clearance, exponent=exponent
        )
        assert found.largest <= force * (1 + 1e-9)
        if abs(found.balance - 1) > 1e-9:
            continue
        few += 1
        cosines = np.cos(2 * math.pi * np.arange(bodies) / bodies)
        half = 0.5 * clearance

        def carried(shift, cosines=cosines, half=half, stiffness=stiffness):
            return stiffness * np.maximum(shift * cosines - half, 0) ** exponent @ cosines

        low, high = half, 2 * half + 1e-2
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if carried(middle) < force else (low, middle)
        assert found.shift == pytest.approx(low, rel=1e-9)
        assert found.largest == pytest.approx(stiffness * (low - half) ** exponent, rel=1e-7)
    assert few > 20
