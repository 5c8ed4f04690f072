"""Interaction of asperities by the mean displacement and asperity by asperity."""

import math

import numpy as np
import pytest
from refusals import Mistake, Status, balances_not, refuses
from scipy.integrate import quad
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.systems.interaction import (
    DISC_CENTRE,
    DISC_MEAN,
    SQUARE_CENTRE,
    SQUARE_MEAN,
    local_interaction,
    mean_interaction,
)

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
# GW, Gaussian, ηRσ_s = 0.05, σ_s/R = 0.01: √A_n/σ_s, d_0/σ_s; p/E*, d/σ_s, A
MEAN = [
    (10, 0, 0.00275516301337, 0.0275516301337, 0.0605255899193),
    (10, 1, 0.00049927672998, 1.0049927673, 0.0129632091676),
    (10, 2, 4.42659710048e-05, 2.00044265971, 0.00133213539797),
    (100, 0, 0.00209622517909, 0.209622517909, 0.0475737889647),
    (100, 2, 4.37778539445e-05, 2.00437778539, 0.00131815310281),
    (1000, 0, 0.000780542619743, 0.780542619743, 0.0195382725056),
    (1000, 1, 0.000277058230871, 1.27705823087, 0.00750750856054),
    (1000, 2, 3.96178453778e-05, 2.03961784538, 0.00119862130678),
]
# the same surface: d/σ_s from the deformed plane; p/E* with and without local interaction
LOCAL = [
    (0.0, 0.0043410109232, 0.00286679995775),
    (0.5, 0.00169413639785, 0.00130135735829),
    (1.0, 0.000591616051804, 0.00050445451594),
    (1.5, 0.000179751525109, 0.00016426320205),
    (2.0, 4.64569886799e-05, 4.43211841572e-05),
    (3.0, 1.77697847199e-06, 1.75978369513e-06),
]


def reference_contact(law=None, eta_R_sigma_s=0.05):
    sigma_s, R = 10e-9, 1e-6
    sigma = sigma_s / math.sqrt(1 - 0.8968 / 5)
    rough = tb.Roughness(sigma=sigma, R=R, eta=eta_R_sigma_s / (R * sigma_s))
    law = tb.asperity.GW() if law is None else law
    surfaces = tb.MaterialPair(STEEL, STEEL)
    return tb.Contact(surfaces=surfaces, roughness=rough, asperity_law=law), rough.sigma_s


def dirty_contact():
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=SILICA,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        ),
        particle_law=tb.particle.Series(deep="off"),
    )


def test_shape_factors():
    factors = (SQUARE_CENTRE, SQUARE_MEAN, DISC_CENTRE, DISC_MEAN)
    assert factors == pytest.approx((1.12220, 0.94640, 1.12838, 0.95779), abs=1e-5)


@pytest.mark.parametrize(("length", "h", "P", "h_eff", "A"), MEAN)
def test_mean_values(length, h, P, h_eff, A):
    contact, s = reference_contact()
    sunk = mean_interaction(contact, nominal_area=(length * s) ** 2, d_0=h * s)
    got = (sunk.state.F_star, sunk.state.d / s, sunk.state.A_t)
    assert got == pytest.approx((P, h_eff, A), rel=1e-11)
    assert sunk.U / s == pytest.approx(h_eff - h, abs=1e-10)


@pytest.mark.parametrize("kappa", [1.0, SQUARE_MEAN])
def test_mean_changes_nothing_but_the_separation_at_a_given_load(kappa):
    contact = dirty_contact()
    loads = np.geomspace(1e4, 1e8, 9)
    alone = tb.solve(contact, pressure=loads)
    sunk = mean_interaction(contact, nominal_area=1e-6, kappa=kappa, pressure=loads)
    for name, values in alone.columns().items():
        assert np.array_equal(values, sunk.state.columns()[name]), name
    assert np.all(sunk.d_0 < alone.d)
    # and back from d_0, where the balance is solved for the load
    again = mean_interaction(contact, nominal_area=1e-6, kappa=kappa, d_0=sunk.d_0)
    assert again.state.pressure == pytest.approx(loads, rel=1e-11)
    assert again.state.A_t == pytest.approx(alone.A_t, rel=1e-11)


def test_mean_stiffness_in_series():
    contact = dirty_contact()
    sunk = mean_interaction(contact, nominal_area=1e-6, pressure=5e6)
    compliance = 1e-3 / contact.E_ss
    assert 1 / sunk.stiffness == pytest.approx(1 / sunk.summit_stiffness + compliance, rel=1e-12)
    step = 1e-12
    high, low = (
        mean_interaction(contact, nominal_area=1e-6, d_0=sunk.d_0 + dx).state.pressure
        for dx in (step, -step)
    )
    assert sunk.stiffness == pytest.approx((low - high) / (2 * step), rel=1e-6)


def test_mean_grows_with_the_specimen():
    contact, s = reference_contact()
    loads = [
        mean_interaction(contact, nominal_area=area, d_0=s).state.pressure
        for area in (1e-20, 1e-16, 1e-12)
    ]
    assert loads[0] > loads[1] > loads[2]
    assert loads[0] == pytest.approx(tb.solve(contact, d=s).pressure, rel=1e-3)


@pytest.mark.parametrize(("h", "P", "P_alone"), LOCAL)
def test_local_values(h, P, P_alone):
    contact, s = reference_contact()
    near = local_interaction(contact, d=h * s)
    assert near.F_star == pytest.approx(P, rel=1e-11)
    assert near.pressure_alone / contact.E_ss == pytest.approx(P_alone, rel=1e-11)
    back = local_interaction(contact, pressure=near.pressure)
    assert back.d == pytest.approx(h * s, abs=1e-12 * s)
    assert back.A_t == pytest.approx(near.A_t, rel=1e-11)


@pytest.mark.parametrize("law", [tb.asperity.ZMC(), tb.asperity.CEB(), tb.asperity.KE()])
def test_local_against_a_sum_over_heights(law):
    """Height by height: the least interference that belongs to z, then a sum over z."""
    contact, s = reference_contact(law)
    d, R, E = s, contact.roughness.R, contact.E_ss
    near = local_interaction(contact, d=d)
    H, nu = contact.surfaces.H, contact.surfaces.softer.nu
    bound = law.bound(R=R, E_star=E, H=H, nu=nu)
    p = near.pressure
    grid = np.geomspace(1e-6 * s, 30 * s, 4000)

    def above(omega):
        force = bound.force(np.asarray(omega), R=R, E_star=E, H=H)
        return omega - SQUARE_CENTRE * np.sqrt(p * force) / E

    # on loading an asperity follows the highest point reached so far
    reached = np.maximum.accumulate(above(grid))

    def load(z):
        i = int(np.searchsorted(reached, z - d))
        omega = grid[i]
        if i and above(grid[i - 1]) < z - d < above(grid[i]):
            omega = brentq(lambda w: float(above(w)) - (z - d), grid[i - 1], grid[i])
        return float(bound.force(omega, R=R, E_star=E, H=H))

    total = quad(
        lambda z: load(z) * math.exp(-0.5 * (z / s) ** 2) / (s * math.sqrt(2 * math.pi)),
        d,
        d + 8 * s,
        limit=400,
        epsrel=1e-6,
        points=[d + 0.1 * s, d + s],
    )[0]
    assert contact.roughness.density * total == pytest.approx(p, rel=1e-3)


def test_local_changes_the_area_at_a_given_load():
    contact, _ = reference_contact()
    loads = np.geomspace(1e-6, 1e-3, 4)
    near, alone = local_interaction(contact, F_star=loads), tb.solve(contact, F_star=loads)
    assert np.all(near.d > alone.d)
    change = np.abs(near.A_t / alone.A_t - 1)
    assert np.all(np.diff(change) > 0)
    assert change[-1] > 1e-3
    assert near.A_t == pytest.approx(near.A_e + near.A_ep + near.A_p)


def test_local_vanishes_for_sparse_asperities():
    contact, s = reference_contact(eta_R_sigma_s=1e-9)
    near = local_interaction(contact, d=s)
    assert near.pressure == pytest.approx(near.pressure_alone, rel=1e-3)
    # the correction goes with the root of the density
    sparse, _ = reference_contact(eta_R_sigma_s=1e-11)
    less = local_interaction(sparse, d=s)
    ratio = (near.pressure / near.pressure_alone - 1) / (less.pressure / less.pressure_alone - 1)
    assert ratio == pytest.approx(10, rel=0.02)


def test_sign_of_local_depends_on_the_datum():
    contact, s = reference_contact()
    near = local_interaction(contact, d=s, nominal_area=(1000 * s) ** 2)
    assert near.pressure > near.pressure_alone
    assert near.pressure < tb.solve(contact, d=near.d_0).pressure


def test_mistakes():
    contact, s = reference_contact()
    with refuses(Mistake.RANGE, "nominal_area", value="0.0"):
        mean_interaction(contact, nominal_area=0.0, pressure=1e6)
    with refuses(Mistake.CLASH, "", says="pressure, d"):
        mean_interaction(contact, nominal_area=1e-6, pressure=1e6, d_0=0.0)
    with balances_not(Status.TOO_DEEP, says="-3 sigma_s"):
        mean_interaction(contact, nominal_area=1e-16, d_0=-10 * s)
    with pytest.raises(tb.errors.InvalidValue, match="particles"):
        local_interaction(dirty_contact(), pressure=1e6)
    with pytest.raises(tb.errors.InvalidValue, match="adhesive"):
        local_interaction(contact.replace(asperity_law=tb.asperity.JKR(w=0.1)), pressure=1e6)
