"""Compiled nodes over the squeeze, against the contacts they are made of."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from thirdbody.equilibrium.compiled.squeeze_rules import (
    NEAR,
    SharedRules,
    inverse_law,
    near_rule,
    squeeze_rule,
    squeeze_rules,
)
from thirdbody.laws.asperity import ZMC, Hermite
from thirdbody.laws.base import COLUMNS
from thirdbody.laws.particle.one_particle import Side, SqueezedParticle

pytest.importorskip("numba", reason="nodes are compiled")

LAWS = [Hermite().bound(R=0.5, E_star=1.0, H=0.1, nu=0.3), ZMC().bound(R=0.5, E_star=1, H=0.1)]
BODIES = {  # E* and H [Pa] of the first and second contact
    "alike": ((6e10, 5e9), (6e10, 5e9)),
    "near": ((6e10, 5e9), (5.5e10, 4.5e9)),
    "turned": ((5.5e10, 4.5e9), (6e10, 5e9)),
    "far": ((6e10, 5e9), (1.5e9, 0.1e9)),
}
laws = pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)


def ruled(law, bodies, width=0.1):
    sides = [(np.array([[E]]), np.array([[H]])) for E, H in bodies]
    return squeeze_rule(law, *sides, tip_radius=0.5, widths=np.array([[width]]), split_areas=True)


@pytest.mark.spread(3)
@laws
@pytest.mark.parametrize("name", BODIES)
def test_nodes_integrate_what_one_particle_carries(law, name):
    """Sums over the nodes, against adaptive quadrature of two contacts balanced by bisection."""
    bodies = BODIES[name]
    one, two = (Side(law, E, H, 0.0) for E, H in bodies)
    rule = ruled(law, bodies)
    gaps = rule.rows[0, -1]
    assert np.all(np.diff(gaps) > 0)
    end = 1 - float(rule.bottom[0])
    kinks = SqueezedParticle(law, *((E, H, 0.0) for E, H in bodies)).kinks

    def parts(eps):
        def excess(t):
            return float((one.force(np.array([t * eps])) - two.force(np.array([eps - t * eps])))[0])

        t = 0.5 if bodies[0] == bodies[1] else brentq(excess, 0.0, 1.0, xtol=1e-15, rtol=9e-16)
        delta = np.array([t * eps])
        a1, a2 = float(one.area(delta)[0]), float(two.area(eps - delta)[0])
        return float(one.force(delta)[0]), a1, a2, int(one.regime(delta)[0])

    def seat(eps):
        return math.exp(-0.5 * ((eps - 0.5 * end) / 0.1) ** 2)

    marks = [0.0, *(float(k) for k in kinks if 0 < k < end), end]
    for column, of in {
        "force": lambda p: p[0],
        "second": lambda p: p[2],
        "footprint": lambda p: max(p[1], p[2]),
        "plastic": lambda p: p[1] * (p[3] == 2),
    }.items():
        exact = sum(
            quad(lambda e, of=of: of(parts(e)) * seat(e), a, b, epsrel=1e-11, epsabs=0, limit=200)[
                0
            ]
            for a, b in zip(marks[:-1], marks[1:], strict=True)
            if b - a > 1e-12 * end
        )
        weighted = rule.rows[0, COLUMNS.index(column)]
        found = np.sum(weighted * np.exp(-0.5 * ((1 - gaps - 0.5 * end) / 0.1) ** 2))
        assert found == pytest.approx(exact, rel=1e-9, abs=1e-14 * bodies[0][1])


@laws
def test_materials_side_by_side_are_each_their_own(law):
    rng = np.random.default_rng(0)
    E, H = rng.uniform(4e10, 7e10, (6, 2)), rng.uniform(4e9, 6e9, (6, 2))
    E[1], H[1] = E[1, 0], H[1, 0]  # one with equal sides among others
    sides = [(E[:, [i]], H[:, [i]]) for i in (0, 1)]
    widths = np.full((6, 1), 0.1)
    together = squeeze_rule(law, *sides, tip_radius=0.5, widths=widths, split_areas=True)
    for m in range(6):
        alone = ruled(law, [(E[m, i], H[m, i]) for i in (0, 1)])
        found, own = (
            np.sum(rows[:-1] * np.exp(-(((rows[-1] - 0.9) / 0.1) ** 2)), axis=-1)
            for rows in (together.rows[m], alone.rows[0])
        )
        np.testing.assert_allclose(found, own, rtol=1e-11)
        np.testing.assert_allclose(together.floor[m], alone.floor[0], rtol=1e-12)


@laws
def test_the_great_circle_is_reached_where_its_area_is(law):
    inverse = inverse_law(law)
    ends = inverse.areas * np.array([0.1, 10.0])
    a = np.geomspace(*ends, 50)
    np.testing.assert_allclose(law.reduced("area", inverse.of_area(a)), a, rtol=1e-13)


@laws
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("width", [0.065, 0.1, 0.3, 2.0])
def test_fewer_nodes_near_the_seat_are_as_good(law, name, width):
    rule = ruled(law, BODIES[name], width)
    fewer = near_rule(rule, width)
    assert fewer is not None
    assert fewer.shape[2] < 0.75 * rule.rows.shape[2]
    bottom = float(rule.bottom[0])
    gap = np.linspace(bottom - NEAR * width, 1 + NEAR * width, 60)[:, None]
    found, exact = (
        np.exp(-0.5 * ((gap - rows[-1]) / width) ** 2) @ rows[:-1].T
        for rows in (fewer[0], rule.rows[0])
    )
    whole = exact.copy()
    whole[:, 1:6] = exact[:, 1:4].sum(axis=1, keepdims=True)
    assert np.max(np.abs(found - exact) / whole) < 2e-13


def test_smooth_seats_take_all_nodes():
    assert near_rule(ruled(LAWS[0], BODIES["near"], 0.05), 0.05) is None


COUNT = 240
VARIED = {  # E* and H of both contacts, x from -1 to 1, and how many of them lie on series
    "hardness of alike bodies": (lambda x: ((6e10, 5e9 * 1.3**x),) * 2, "all"),
    "modulus of alike bodies": (lambda x: ((6e10 * 1.3**x, 5e9),) * 2, "all"),
    "hardness of one": (lambda x: ((6e10, 7e9 * 1.2**x), (5.5e10, 4e9)), "some"),
    "modulus of one": (lambda x: ((6e10, 7e9), (3e10 * 1.2**x, 4e9)), "none"),
    "which is weaker": (lambda x: ((6e10, 5e9 * 1.2**x), (6e10, 5e9)), "some"),
    "unit of load": (lambda x: ((6e10 * 2.0 ** (x > 0), 5e9 * 2.0 ** (x > 0)),) * 2, "none"),
    "both hardnesses": (lambda x: ((6e10, 5e9 * 1.2**x), (6e10, 4e9 * 1.2 ** (x * x))), "none"),
}


@laws
@pytest.mark.parametrize("name", VARIED)
def test_series_are_the_rules_of_each(law, name):
    """Sums over rules read from series, against sums over the rule of each material."""
    bodies, how = VARIED[name]
    x = np.sort(np.random.default_rng(1).uniform(-1, 1, COUNT))
    sides = [[np.broadcast_to(v, COUNT)[:, None] for v in body] for body in bodies(x)]
    modulus = sides[0][0]
    options = {"tip_radius": 0.5, "split_areas": True}
    widths = np.full((COUNT, 1), 0.3)
    alone = squeeze_rule(law, *sides, widths=widths, **options)
    gap = np.linspace(-0.5, 1.5, 9)[:, None]

    def sums(rules):
        """Every column weighted by seats at several gaps: (gaps, M, 7)."""
        weigh = [np.exp(-0.5 * ((gap - rows[-1]) / 0.3) ** 2) @ rows[:-1].T for rows in rules]
        return np.stack(weigh, axis=1)

    exact = sums(alone.rows)
    whole = exact.copy()
    whole[..., 1:6] = exact[..., 1:4].sum(axis=-1, keepdims=True)
    seen, shared = np.zeros(COUNT, int), 0
    for which, rule in squeeze_rules(law, *sides, widths=widths, **options):
        seen[which] += 1
        np.testing.assert_allclose(rule.bottom, alone.bottom[which], rtol=1e-11, atol=1e-13)
        np.testing.assert_allclose(rule.floor, alone.floor[which], rtol=1e-11)
        if not isinstance(rule, SharedRules):
            read = [rule.rows]
        else:
            shared += len(which)
            series = (rule.series.rows, rule.series.near)
            read = [np.polynomial.chebyshev.chebval(rule.across, c) for c in series]
            read = [np.moveaxis(rows, -1, 0) for rows in read]
            for rows in read:
                rows[:, 0] *= modulus[which]
        for found in read:
            assert np.max(np.abs(sums(found) - exact[:, which]) / whole[:, which]) < 1e-12
    assert np.all(seen == 1)
    assert {"all": shared == COUNT, "some": 0 < shared < COUNT, "none": shared == 0}[how]


def test_few_materials_are_ruled_each():
    """Series pay for many materials only."""
    sides = [(np.full((5, 1), 6e10), 5e9 * np.linspace(1, 1.1, 5)[:, None])] * 2
    given = {"tip_radius": 0.5, "widths": np.full((5, 1), 0.3), "split_areas": False}
    ((which, rule),) = squeeze_rules(LAWS[0], *sides, **given)
    assert which.tolist() == list(range(5))
    assert not isinstance(rule, SharedRules)
