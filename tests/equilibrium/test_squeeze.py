"""Particles squeezed on rough seats: states of their own against the contacts they are made of."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.contact.particle_averages import SizeAverage
from thirdbody.equilibrium.states import state_columns, vary_contact
from thirdbody.laws.asperity import ZMC, Hermite
from thirdbody.laws.particle.one_particle import Side, SqueezedParticle
from thirdbody.populations.materials import reduced_modulus

pytest.importorskip("numba", reason="states of their own are compiled")
from thirdbody.equilibrium.compiled.size_rules import NEAR, near_rule, seat_rule

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")

LAWS = [Hermite(), ZMC()]
BODIES = {  # E and H [Pa] of the first and second surface, softer than the particle or not
    "alike": ((2e11, 5e9), (2e11, 5e9)),
    "near": ((2e11, 5e9), (1.6e11, 4.5e9)),
    "turned": ((1.6e11, 4.5e9), (2e11, 5e9)),
    "far": ((2e11, 5e9), (1.5e9, 0.1e9)),
}
SIZE, SIGMA = 300e-9, 100e-9
laws = pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)


def case(law, bodies, diameter=None, particle_law=None):
    surfaces = [tb.Material(E=E, nu=0.3, H=H) for E, H in bodies]
    return tb.Contact(
        surfaces=tb.MaterialPair(*surfaces),
        roughness=tb.Roughness(sigma=SIGMA, R=2.8e-6),
        particles=tb.Particles(
            material=tb.Material(E=7e10, nu=0.2, H=8e9),
            areal_density=1e11,
            diameter=diameter or tb.distributions.Monodisperse(mean=SIZE),
        ),
        particle_law=particle_law or tb.particle.Series(law=law, deep="off", soft="sphere"),
    )


@pytest.mark.spread(3)
@laws
@pytest.mark.parametrize("name", BODIES)
def test_states_integrate_what_one_particle_carries(law, name):
    """States of one size, against adaptive quadrature of two contacts balanced by bisection."""
    contact = case(law, BODIES[name])
    body, pair = contact.particles.material, contact.surfaces
    both = []
    for surface in (pair.first, pair.second):
        E, H = reduced_modulus(surface, body), min(surface.H, body.H)
        both.append((law.bound(R=0.5, E_star=E, H=H, nu=surface.nu), E, H, 0.0))
    one, two = (Side(*each) for each in both)
    particle = SqueezedParticle(both[0][0], *(each[1:] for each in both))
    end = particle.kinks[-1]
    width = contact.particle_law.zeta_std * SIGMA / SIZE
    d = 0.5 * SIZE
    gap = (d + contact.particle_law.seat_offset(contact.roughness)) / SIZE

    def parts(eps):
        def excess(t):
            return float((one.force(np.array([t * eps])) - two.force(np.array([eps - t * eps])))[0])

        t = 0.5 if name == "alike" else brentq(excess, 0.0, 1.0, xtol=1e-15, rtol=9e-16)
        delta = np.array([t * eps])
        return float(one.force(delta)[0]), float(two.area(eps - delta)[0])

    def seat(eps):
        z = (gap - (1 - eps)) / width
        return math.exp(-0.5 * z * z) / (width * math.sqrt(2 * math.pi))

    marks = [0.0, *(float(k) for k in particle.kinks if 0 < k < end), end]
    most = 0.5 * math.erfc((gap - (1 - end)) / width / math.sqrt(2))
    vary = {"particles.areal_density": 1e11 * np.linspace(0.5, 1.5, 21)}
    vary["surfaces.first.H"] = np.full(21, pair.first.H)  # each by its own laws
    vary["particles.material.nu"] = 0.2 + 1e-9 * np.arange(21)
    states = state_columns(contact, d=np.full(21, d), vary=vary)
    assert set(states["engine"]) == {"compiled"}
    for column, which, unit in (("F_sa_star", 0, 1 / contact.E_ss), ("A_sa2", 1, 1.0)):
        exact = sum(
            quad(lambda e, k=which: parts(e)[k] * seat(e), a, b, epsrel=1e-11, epsabs=0, limit=200)[
                0
            ]
            for a, b in zip(marks[:-1], marks[1:], strict=True)
            if b - a > 1e-12 * end
        )
        exact += most * parts(end * (1 - 1e-13))[which]
        assert states[column][0] == pytest.approx(
            0.5e11 * SIZE**2 * exact * unit, rel=1e-9
        )  # of the first


VARIED = {  # E and H of both surfaces, x from -1 to 1
    "hardness of alike bodies": lambda x: ((2e11, 5e9 * 1.3**x),) * 2,
    "modulus of alike bodies": lambda x: ((2e11 * 1.3**x, 5e9),) * 2,
    "hardness of one": lambda x: ((2e11, 7e9 * 1.2**x), (1.8e11, 4e9)),
    "modulus of one": lambda x: ((2e11, 7e9), (9e10 * 1.2**x, 4e9)),
    "which is weaker": lambda x: ((2e11, 5e9 * 1.2**x), (2e11, 5e9)),
    "unit of load": lambda x: ((2e11 * 2.0 ** (x > 0), 5e9 * 2.0 ** (x > 0) * 1.01**x),) * 2,
    "both hardnesses": lambda x: ((2e11, 5e9 * 1.2**x), (2e11, 4e9 * 1.2 ** (x * x))),
}


@laws
@pytest.mark.parametrize("name", VARIED)
def test_materials_side_by_side_are_each_their_own(law, name):
    """Whatever varies of the surfaces, and in whatever company: each contact as it is alone."""
    sizes = tb.TruncatedGaussian(mean=SIZE, std=0.1 * SIZE)
    contact = case(law, BODIES["near"], sizes)
    x = np.sort(np.random.default_rng(1).uniform(-1, 1, 40))
    bodies = VARIED[name](x)
    vary = {
        f"surfaces.{which}.{symbol}": np.broadcast_to(value, 40)
        for which, body in zip(("first", "second"), bodies, strict=True)
        for symbol, value in zip("EH", body, strict=True)
    }
    states = state_columns(contact, F_star=1e-5, vary=vary)
    assert set(states["engine"]) == {"compiled"}
    some = {key: values[::-1][:25] for key, values in vary.items()}
    others = state_columns(contact, F_star=1e-5, vary=some)
    for column in ("d", "F_sa_star", "A_t", "A_sa2"):
        np.testing.assert_array_equal(others[column], states[column][::-1][:25])
    for i in (0, 39):
        own = vary_contact(contact, {key: float(values[i]) for key, values in vary.items()})
        alone = tb.solve(own, F_star=1e-5)
        assert abs(states["d"][i] - alone.d) < 1e-10 * SIGMA
        assert states["F_sa_star"][i] == pytest.approx(alone.F_sa_star, abs=1e-15)
        assert states["A_sa2"][i] == pytest.approx(alone.A_sa2, abs=1e-10 * alone.A_t)


def test_flat_loads_of_unlike_sides_are_shared():
    """Flakes end as a plateau of both loads, where no step tells which side takes more."""
    contact = case(None, BODIES["alike"], particle_law=tb.particle.Flakes(aspect=3.0))
    vary = {"surfaces.first.E": 2e11 * np.linspace(0.9, 1.1, 41)}
    states = state_columns(contact, F_star=1e-5, vary=vary)
    assert set(states["engine"]) == {"compiled"}
    for i in (0, 19, 40):
        alone = tb.solve(
            contact.replace(**{"surfaces.first.E": vary["surfaces.first.E"][i]}), F_star=1e-5
        )
        assert abs(states["d"][i] - alone.d) < 1e-10 * SIGMA
        assert states["F_sa_star"][i] == pytest.approx(alone.F_sa_star, abs=1e-14)


# ------------------------------------------------------------------------------ sizes of their own
SEATED = {
    "deep": tb.particle.Series(),
    "squashed": tb.particle.Series(deep="off"),
    "sphere": tb.particle.Series(deep="off", soft="sphere", law=ZMC()),
    "ke": tb.particle.Series(law=tb.asperity.KE()),
    "flakes": tb.particle.Flakes(aspect=2.0),
}


@pytest.mark.parametrize("rough", [5e-9, 30e-9, SIGMA, 1e-6])
@pytest.mark.parametrize("name", SEATED)
def test_sizes_of_their_own_on_rough_seats(name, rough):
    """Every law by nodes over the gaps of one particle, against each contact alone."""
    sizes = tb.TruncatedGaussian(mean=SIZE, std=0.1 * SIZE)
    contact = case(None, BODIES["far" if name == "squashed" else "near"], sizes, SEATED[name])
    contact = contact.replace(**{"roughness.sigma": rough, "particles.areal_density": 3e10})
    vary = {
        "particles.diameter.mean": SIZE * np.linspace(0.6, 1.6, 30),
        "particles.diameter.std": SIZE * np.linspace(0.2, 0.01, 30),
        "particles.diameter.n": np.linspace(1.5, 5, 30),
    }
    loads = np.geomspace(1e-8, 1e-3, 30)
    states = state_columns(contact, F_star=loads, vary=vary)
    assert np.mean(states["engine"] == "compiled") > 0.9
    for i in (0, 11, 20, 29):
        own = contact.replace(**{key: float(values[i]) for key, values in vary.items()})
        alone = tb.solve(own, F_star=loads[i])
        assert states["status"][i] == alone.status
        if alone.status == "ok":
            assert abs(states["d"][i] - alone.d) < 1e-10 * rough
            assert abs(states["F_sa_star"][i] - alone.F_sa_star) < 1e-10 * loads[i]
            for column in ("A_e", "A_p", "A_sa", "A_sa2", "A_t"):
                assert abs(states[column][i] - getattr(alone, column)) < 1e-10 * alone.A_t


def average_of(name):
    contact = case(None, BODIES["near"], particle_law=SEATED[name])
    particle = contact.law_of(contact.particles).one(
        surfaces=contact.surfaces, particle=contact.particles.material
    )
    return SizeAverage(particle, tb.distributions.Monodisperse(mean=1.0))


def over_seats(rows, width, gap):
    return np.exp(-0.5 * ((gap - rows[-1]) / width) ** 2) @ rows[:-1].T


@pytest.mark.parametrize("name", SEATED)
@pytest.mark.parametrize("octave", [-8, -4, -2, 1])
def test_nodes_over_gaps_resolve_the_seat(name, octave):
    """Against nodes for seats of a quarter of the width; fewer, where they do, are as good."""
    average, width = average_of(name), 2.0**octave
    rule, fine = seat_rule(average, octave), seat_rule(average, octave - 2)
    assert np.all(np.diff(rule[-1]) > 0)
    gap = np.linspace(average.bottom - NEAR * width, average.top + NEAR * width, 80)[:, None]
    for wide in (1.0, 1.99):
        exact = over_seats(fine, wide * width, gap)
        whole = exact.copy()
        whole[:, 1:6] = exact[:, 1:4].sum(axis=1, keepdims=True)
        fewer = near_rule(average, octave)
        for rows in (rule,) if fewer is None else (rule, fewer):
            assert np.max(np.abs(over_seats(rows, wide * width, gap) - exact) / whole) < 1e-12
        if octave >= -2:
            assert fewer.shape[1] < 0.75 * rule.shape[1]
        if octave == -8:
            assert fewer is None
