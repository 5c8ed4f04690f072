"""A particle between unlike bodies with a law whose load jumps: one answer, whatever rounding does."""

import numpy as np
import pytest
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.laws.particle.one_particle import SqueezedParticle, contact_sides
from thirdbody.laws.particle.tension import Tension

NU = 0.3
LAWS = {
    "ceb": tb.asperity.CEB(K=0.6),
    "ke": tb.asperity.KE(K=0.6, nu=NU),
    "jg up": tb.asperity.JG(nu=0.1),
    "jg down": tb.asperity.JG(nu=0.46),
}
UP = ("ceb", "ke", "jg up")
BODIES = {
    "soft particle": ((1.2e9, 37e6), (5.6e9, 40e6), (1.1e9, 6.4e6)),
    "hard particle": ((200e9, 2e9), (70e9, 0.3e9), (300e9, 20e9)),
    "almost alike": ((200e9, 2e9), (190e9, 2.1e9), (210e9, 1.95e9)),
}


def sides(name, pressure=1.0):
    one, two, grain = (tb.Material(E=pressure * E, nu=NU, H=pressure * H) for E, H in BODIES[name])
    return contact_sides(tb.MaterialPair(one, two), grain)


def particle(law, name, pressure=1.0):
    return SqueezedParticle(LAWS[law], *sides(name, pressure))


def squeezes(made, count=3000):
    return np.geomspace(made.kinks[0] / 50, 0.99 * min(made.kinks[-1], 1.0), count)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("law", LAWS)
def test_in_other_units(law, name):
    made, other = particle(law, name), particle(law, name, 2.3e-3)
    np.testing.assert_allclose(other.kinks, made.kinks, rtol=1e-12)
    eps = squeezes(made)
    load, *areas = made(eps).T
    other_load, *other_areas = other(eps).T
    np.testing.assert_allclose(other_load / 2.3e-3, load, rtol=1e-11)
    np.testing.assert_allclose(other_areas, areas, rtol=1e-11)


@pytest.mark.spread(4)
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("law", UP)
def test_against_the_indentations_of_both_sides(law, name):
    """ε(F) = δ_1(F) + δ_2(F), where δ is the least at which a side carries F."""
    made, own = particle(law, name), LAWS[law]
    assert any(jump.force > 0 for jump in made.sides[0].law.jumps.values())

    def least(F, E_star, H):
        def carried(log_delta):
            tip = {"R": 0.5, "E_star": E_star, "H": H}
            return float(own.force(np.exp(log_delta), **tip)) - F

        return np.exp(brentq(carried, np.log(1e-12), np.log(0.3), xtol=1e-15))

    # below the least great circle: its area is where the load leaves the law
    top = min(float(side.force(np.array([side.cap * side.delta_1]))[0]) for side in made.sides)
    loads = np.geomspace(1e-6 * top, 0.9 * top, 300)
    eps = np.array([sum(least(F, E, H) for E, H, _ in sides(name)) for F in loads])
    held = np.zeros(len(eps), bool)
    for begin, end, *_ in made.held:
        held |= (eps > begin) & (eps < end)
    assert held.any()
    # while both stay at their jumps ε tells no load
    jumps = [side.loads_around(y) for side in made.sides for y in side.law.breakpoints]
    inside = sum((loads >= below) & (loads <= at) for below, at in jumps)
    known = inside < 2
    np.testing.assert_allclose(made(eps)[known, 0], loads[known], rtol=1e-9)


@pytest.mark.parametrize("name", ["soft particle", "hard particle"])
@pytest.mark.parametrize("law", UP)
def test_the_load_never_jumps(law, name):
    made = particle(law, name)
    eps = np.sort(np.concatenate([made.kinks * (1 - 1e-9), made.kinks * (1 + 1e-9)]))
    load = made(eps)[:, 0].reshape(-1, 2)
    np.testing.assert_allclose(load[:, 1], load[:, 0], rtol=1e-6)
    assert np.all(np.diff(made(squeezes(made))[:, 0]) > 0)


def test_a_falling_load_is_let_go_once():
    """Both sides carry one load on each branch, and the load falls where a side lets go alone."""
    made = particle("jg down", "soft particle")
    assert made.sides[0].law.jumps[1.9].force < 0
    eps = squeezes(made)
    one, two = made.indentations(eps)
    loads = [side.force(part) for side, part in zip(made.sides, (one, two), strict=True)]
    np.testing.assert_allclose(loads[0], loads[1], rtol=1e-9)
    falls = np.flatnonzero(np.diff(loads[0]) < 0)
    assert len(falls) == len(made.let_go) == 2
    for since, _, _ in made.let_go:
        assert np.any((eps[falls] <= since) & (since <= eps[falls + 1]))


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("law", LAWS)
def test_the_largest_tension_has_no_spikes_at_kinks(law, name):
    """In many units the running maximum over squeezes off the kinks: none adds a value of its own."""
    made = particle(law, name)
    eps = squeezes(made)
    eps = eps[np.min(np.abs(eps[:, None] / made.kinks - 1), axis=1) > 1e-9]
    close = np.sort(np.concatenate([eps, *(made.kinks * (1 + s * 1e-9) for s in (-1, 1))]))
    running = np.maximum.accumulate(made(close)[:, 0])
    expected = np.interp(eps, close, running)
    for pressure in (1.0, 2.3e-3, 0.37, 7.1, 1234.5):
        found = Tension(particle(law, name, pressure), 0.2, "none")(eps) / pressure
        # between two squeezes a law that falls may have been higher by what one step changes
        assert np.all(found >= expected * (1 - 1e-9))
        np.testing.assert_allclose(found, expected, rtol=6e-3)
