"""Tables of a contact against the contact itself."""

import warnings

import numpy as np
import pytest
from contact_cases import CLASSES, QUARTZ, SOFT, STEEL, contact
from refusals import refuses
from scipy.integrate import quad
from scipy.stats import norm

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.systems.life.contact_tables import ContactTables, Kind, scale_roughness
from thirdbody.systems.life.particle_curves import POWERS
from thirdbody.systems.life.size_classes import SizeClasses

INDEX = {name: i for i, name in enumerate(POWERS)}
KINDS = [Kind(name="quartz", material=QUARTZ), Kind(name="debris", material=SOFT)]
STATES = 8


def mixture(seed, classes=CLASSES):
    """Particles per area of every kind and class [1/m²], which cover a tenth of the area."""
    rng = np.random.default_rng(seed)
    eta = 10 ** rng.uniform(-3, 0, (2, classes.count))
    return 0.1 * eta / (np.pi / 4 * (eta @ classes.mean_power(2)).sum())


def populations(eta, classes=CLASSES):
    return tuple(
        tb.Particles(material=kind.material, diameter=classes.distribution(row),
                     areal_density=row.sum())
        for kind, row in zip(KINDS, eta, strict=True)
    )  # fmt: skip


@pytest.fixture(scope="module")
def unlike():
    return contact(STEEL, SOFT, K_sa=1e-6)


@pytest.fixture(scope="module")
def tables(unlike):
    return ContactTables(unlike, CLASSES, KINDS, sigma=(60e-9, 100e-9))


@pytest.mark.check
@pytest.mark.parametrize("sigma", [100e-9, 73e-9])
def test_tables_are_the_contact_at_random_states(unlike, tables, sigma):
    eta = mixture(4)
    d = np.sort(np.random.default_rng(7).uniform(-1e-7, 1.2e-6, STATES))
    rough = scale_roughness(unlike.roughness, sigma)
    dirty = unlike.replace(particles=populations(eta), roughness=rough)
    dirty = dirty.replace(outputs=(*dirty.outputs, tb.outputs.Dents()))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exact = tb.solve(dirty, d=d)
    own = {name: [] for name in ("p", "wear_1", "wear_2", "V_2", "area", "force")}
    for each in d:
        state = tables.press_at(float(each), eta=eta, sigma=sigma)
        total = np.tensordot(eta, state.per_particle, 2)
        spots = state.asperities
        own["p"].append(tables.load(float(each), eta=eta, sigma=sigma)[0])
        for side, share in ((1, 0.0), (2, 1.0)):  # asperities wear the softer surface
            worn = total[INDEX[f"wear_{side}"]] + share * state.bare * spots["worn"]
            own[f"wear_{side}"].append(worn)
        own["V_2"].append(total[INDEX["dent_volume_2"]])
        own["area"].append(total[INDEX["area_1"]])
        friction = sum(total[INDEX[name]] for name in ("shear", "plough", "roll"))
        own["force"].append(friction + state.bare * (spots["shear"] + spots["plough"]))
    found = exact.outputs
    pressure = np.asarray(exact.pressure)
    expected = {
        "p": pressure,
        "wear_1": found["wear_1"],
        "wear_2": found["wear_2"],
        "V_2": found["dent_volume_2"],
        "area": np.asarray(exact.A_sa),
        "force": np.asarray(found["mu"]) * pressure,
    }
    for name, values in expected.items():
        wide = np.asarray(values)
        assert np.all(np.isfinite(wide)), name
        assert np.max(np.abs(np.array(own[name]) / wide - 1)) < 1e-5, name
    assert tables.error < 1e-5


def test_dents_are_those_of_all_particles_beyond_first_yield(unlike, tables):
    """A double integral over sizes and seats, written out."""
    curve = tables.curves[1][-1]

    def dents(eps):
        return curve._depth_left(curve._probe(np.array([eps])), 0)[0, 0] > 0

    low, high = 1e-6, 0.5
    while high / low > 1 + 1e-12:
        low, high = (low, (low * high) ** 0.5) if dents((low * high) ** 0.5) else (
            (low * high) ** 0.5, high)  # fmt: skip
    for k, d in ((0, 9e-7), (1, 1.1e-6), (2, 3e-7)):
        x0, x1 = CLASSES.edges[k : k + 2]
        gap = d + tables.offset(1e-7)
        weight = 3 * x0**3 / (1 - (x0 / x1) ** 3)
        exact = quad(
            lambda x, g=gap, w=weight: w * x**-4 * norm.cdf((x * (1 - high) - g) / 1e-7), x0, x1,
            epsabs=0, epsrel=1e-11,
        )[0]  # fmt: skip
        state = tables.press_at(d, eta=np.zeros((2, CLASSES.count)), sigma=1e-7)
        assert state.per_particle[1, k, INDEX["dents_1"]] == pytest.approx(exact, rel=1e-5)


@pytest.mark.check
def test_the_gap_under_a_load_is_that_of_the_contact(unlike, tables):
    eta = mixture(9)
    dirty = unlike.replace(particles=populations(eta), outputs=())
    for pressure in (1e5, 5e6, 2e8):
        exact = tb.solve(dirty, pressure=pressure)
        found = tables.find_gap(pressure, eta=eta, sigma=100e-9, start=0.0)
        assert found == pytest.approx(exact.d, rel=1e-6)
        assert tables.load(found, eta=eta, sigma=100e-9)[0] == pytest.approx(pressure, rel=1e-9)


def test_slopes_of_the_load(tables):
    eta, h = mixture(1), 1e-12
    for d in (5e-8, 3e-7, 9e-7):
        above, below = (tables.load(d + k * h, eta=eta, sigma=80e-9)[0] for k in (1, -1))
        slope = tables.load(d, eta=eta, sigma=80e-9)[1]
        assert slope == pytest.approx((above - below) / (2 * h), rel=1e-4)


@pytest.mark.check
def test_exchanged_surfaces_exchange_what_they_lose(tables):
    eta = mixture(3)
    turned = ContactTables(contact(SOFT, STEEL, K_sa=1e-6), CLASSES, KINDS)
    one = np.tensordot(eta, tables.press_at(2e-7, eta=eta, sigma=100e-9).per_particle, 2)
    two = np.tensordot(eta, turned.press_at(2e-7, eta=eta, sigma=100e-9).per_particle, 2)
    for name, place in INDEX.items():
        if name in ("elastic", "elastoplastic", "plastic"):
            continue  # regimes are those on surface 1
        other = name.replace("_1", "_x").replace("_2", "_1").replace("_x", "_2")
        assert two[INDEX[other]] == pytest.approx(one[place], rel=2e-5, abs=1e-30), name


def test_lengths_in_another_unit():
    """Everything in lengths 3 times as large at the same pressures: a power of 3 each."""
    factor = 3.0
    large = SizeClasses(edges=tuple(factor * e for e in CLASSES.edges))
    one = ContactTables(contact(), CLASSES, KINDS[:1])
    two = ContactTables(contact(sigma=3e-7, R=8.4e-6), large, KINDS[:1])
    eta = mixture(2)[:1]
    at = one.press_at(1.5e-7, eta=eta, sigma=1e-7).per_particle[0]
    there = two.press_at(4.5e-7, eta=eta / factor**2, sigma=3e-7).per_particle[0]
    powers = np.array(list(POWERS.values()))
    small = 1e-6 * np.abs(at).max(axis=0)
    np.testing.assert_allclose(there / factor**powers, at, rtol=1e-5, atol=float(small.min()))


def test_plane_seats_need_no_tables_over_the_gap():
    plane = contact().replace(particle_law=tb.particle.Series(seat="plane"))
    made = ContactTables(plane, CLASSES, KINDS[:1])
    eta = mixture(5)[:1]
    dirty = plane.replace(
        particles=tb.Particles(material=QUARTZ, diameter=CLASSES.distribution(eta[0]),
                               areal_density=eta.sum()),
        outputs=(),
    )  # fmt: skip
    for d in (2e-7, 1.1e-6, 5e-6):
        exact = tb.solve(dirty, d=d)
        assert made.load(d, eta=eta, sigma=1e-7)[0] == pytest.approx(exact.pressure, rel=1e-5)
    assert made.particles.built == 0


def test_contacts_that_cannot_be_tabulated_are_refused():
    bare = tb.Contact(surfaces=tb.MaterialPair(STEEL, STEEL),
                      roughness=tb.Roughness(sigma=1e-7, R=2.8e-6))  # fmt: skip
    with refuses(Mistake.MISSING, "", says="outputs.Wear"):
        ContactTables(bare, CLASSES, KINDS)
