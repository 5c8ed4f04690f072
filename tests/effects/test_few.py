"""Fewer than one contact in the area that is asked about: open, NaN or told, never a bare number."""

import math
import re
import warnings
from importlib import resources

import numpy as np
import pytest
from scipy.stats import norm

import thirdbody as tb
from thirdbody.effects import ElectricalConductance, ThermalConductance
from thirdbody.errors import code_of, note_of
from thirdbody.study import load_study, run_study

BODY = tb.Material(
    E=110e9, nu=0.34, H=1.3e9, resistivity=6e-8, thermal_conductivity=60.0,
    density=8700, specific_heat=380,
)  # fmt: skip
ROUGH = tb.Roughness(sigma=200e-9, R=5e-6)
A_N = 1e-6


def at(d_star, *outputs):
    """Outputs and sentences of clean surfaces at separations over σ_s."""
    contact = tb.Contact(surfaces=tb.MaterialPair(BODY, BODY), roughness=ROUGH, outputs=outputs)
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = tb.solve(contact, d=d_star * ROUGH.sigma_s).outputs
    return found, [each.message.args[0] for each in heard]


def spots(d_star):
    """Contacts in A_n on average: η A_n Q(d/σ_s)."""
    return ROUGH.density * A_N * norm.sf(d_star)


OPEN, CLOSED = norm.isf(np.array([0.3, 3.0]) / (ROUGH.density * A_N))
"""Separations at which A_n holds 0.3 and 3 contacts on average."""


def test_probability_is_that_of_any_of_many_asperities():
    """Of M asperities, each high enough with probability Q: 1 − (1 − Q)^M."""
    M = ROUGH.density * A_N
    assert M > 1e4
    for d in (OPEN, CLOSED):
        found, _ = at(d, ElectricalConductance(A_n=A_N), ThermalConductance(A_n=A_N))
        want = -np.expm1(M * np.log1p(-norm.sf(d)))
        assert found["gc_closed"] == pytest.approx(want, rel=1e-4)
        assert found["hc_closed"] == pytest.approx(want, rel=1e-4)


def open_notes(notes):
    """Notes that fewer than one contact conducts electricity."""
    return [note for note in notes if code_of(note) == "electrical_conductance.open"]


def test_below_one_contact_it_is_open():
    assert spots(OPEN) == pytest.approx(0.3, rel=1e-9)
    found, told = at(OPEN, ElectricalConductance(A_n=A_N), ThermalConductance(A_n=A_N, k_gap=0.025))
    for name in ("gc", "gc_ss", "gc_sa", "rho_c", "hc", "hc_ss", "hc_sa"):
        assert math.isnan(found[name]), name
    assert found["hc_gap"] > 0
    for name in ("electrical", "thermal"):
        (note,) = [note for note in told if code_of(note) == f"{name}_conductance.open"]
        assert note.effect == math.inf
        assert "0.3 contacts" in note
        assert "probability 0.259" in note


def test_the_mean_where_it_is_asked_for():
    """The number that is given above one contact, continued, and told."""
    found, told = at(OPEN, ElectricalConductance(A_n=A_N, few="mean"))
    same, _ = at(OPEN, ElectricalConductance())
    assert found["gc"] == same["gc"] > 0
    assert [note.effect for note in open_notes(told)] == [1.0]
    above, told = at(CLOSED, ElectricalConductance(A_n=A_N))
    assert above["gc"] == at(CLOSED, ElectricalConductance())[0]["gc"]
    assert not open_notes(told)


def test_without_an_area_the_area_of_one_contact_is_told():
    found, told = at(OPEN, ElectricalConductance())
    assert found["gc"] > 0
    assert math.isnan(found["gc_closed"])
    (note,) = open_notes(told)
    assert note.effect == 1.0
    assert "3.333×10⁻⁶ m²" in note
    assert not open_notes(at(CLOSED, ElectricalConductance())[1])


def dusty(eta, x=4e-6, **options):
    """A contact of 1e-10 m² with insulating balls of one size, so many on average."""
    dust = tb.Particles(
        material=tb.materials["quartz"],
        areal_density=eta,
        diameter=tb.distributions.Monodisperse(mean=x),
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(BODY, BODY), roughness=tb.Roughness(sigma=300e-9, R=10e-6),
        particles=dust, outputs=ElectricalConductance(**({"A_n": 1e-10} | options)),
    )  # fmt: skip


def closed_with(k, pressure, x):
    """Probability that 1e-10 m² with k balls under a pressure closes: its own separation."""
    bare = dusty(k / 1e-10, x).replace(outputs=(tb.outputs.Counts(),))
    return -math.expm1(-1e-10 * tb.solve(bare, pressure=pressure).outputs["n_ss"])


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize(("held", "x"), [(0.01, 4e-6), (0.3, 4e-6), (0.6, 3e-6), (2.0, 0.1e-6)])
def test_contacts_close_by_those_that_hold_no_particle(held, x):
    """Poisson numbers of balls, each contact solved by itself: the clean ones decide."""
    p = 1e5
    found = tb.solve(dusty(held / 1e-10, x), pressure=p).outputs["gc_closed"]
    chances = [math.exp(-held) * held**k / math.factorial(k) for k in range(6)]
    want = sum(chance * closed_with(k, p, x) for k, chance in enumerate(chances))
    clean = closed_with(0, p, x)
    assert math.exp(-held) * clean * (1 - 1e-9) <= found <= clean
    assert found == pytest.approx(want, rel=0.03)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_a_rare_particle_changes_little():
    """Of none the limit, a sweep says the same, and a contact at a separation is as it was."""
    eta = np.array([0.0, 1e2, 1e4, 1e8])
    each = [tb.solve(dusty(n), pressure=1e5).outputs["gc_closed"] for n in eta]
    assert each[1:3] == pytest.approx([each[0]] * 2, rel=1e-5)
    assert each[3] == pytest.approx(0.99 * each[0], rel=1e-3)
    swept = tb.equilibria.solve_states(
        dusty(1e8), pressure=1e5, vary={"particles.areal_density": eta}
    )
    np.testing.assert_allclose(swept["gc_closed"].values, each, rtol=1e-9)
    state = tb.solve(dusty(1e8), d=900e-9)
    bare = tb.solve(dusty(0.0), d=900e-9)
    assert state.outputs["gc_closed"] == pytest.approx(bare.outputs["gc_closed"], rel=2e-3)


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_those_in_the_way_are_counted_by_sampling():
    """Balls of one size on seats at random: as many as are larger than their gap when clean."""
    held, x, p = 0.5, 1e-6, 1e5
    contact = dusty(held / 1e-10, x)
    h = tb.solve(contact.replace(particles=None, outputs=()), pressure=p).h
    law = contact.particle_law
    rng = np.random.default_rng(5)
    seats = (law.zeta_mean + law.zeta_std * rng.standard_normal(10**6)) * 300e-9
    in_the_way = held * np.mean(h - seats < x)
    want = math.exp(-in_the_way) * closed_with(0, p, x)
    low = tb.solve(contact, pressure=p).outputs["gc_closed"]
    assert low == pytest.approx(want, rel=5e-3)


def test_particles_that_conduct_close_the_contacts_that_hold_one():
    quartz = tb.materials["quartz"].replace(resistivity=1e-7)
    dust = tb.Particles(
        material=quartz, areal_density=1e9, diameter=tb.distributions.Monodisperse(mean=4e-6)
    )
    state = tb.solve(dusty(0.0, particles="conduct").replace(particles=dust), pressure=1e5)
    clean = closed_with(0, 1e5, 4e-6)
    want = math.exp(-0.1) * clean - math.expm1(-0.1)
    assert state.outputs["gc_closed"] == pytest.approx(want, rel=1e-6)


def test_which_of_few_particles_bear_is_not_known():
    """NaN with its bounds, where chance decides which of the particles carry."""
    dust = tb.Particles(
        material=tb.materials["quartz"], areal_density=1e10,
        diameter=tb.LogNormal(median=4e-6, gsd=1.3),
    )  # fmt: skip
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = tb.solve(dusty(1e10).replace(particles=dust), pressure=1e5)
    assert math.isnan(found.outputs["gc_closed"])
    (told,) = [str(w.message) for w in heard if "chance decides which they are" in str(w.message)]
    clean = closed_with(0, 1e5, 1e-6)
    low, high = (float(text) for text in re.findall(r"0\.\d+", told))
    assert (low, high) == pytest.approx((math.exp(-1) * clean, clean), rel=1e-3)


def test_most_contacts_conduct_where_few_hold_dust():
    """99 of 100 contacts are clean and closed: their conductance is given, not "open"."""
    state = tb.solve(dusty(1e6, A_n=1e-8), pressure=1e7)
    clean = tb.solve(dusty(0.0, A_n=1e-8), pressure=1e7).outputs
    assert clean["gc_closed"] > 0.99
    assert 0.99 * clean["gc"] <= state.outputs["gc"] <= clean["gc"]
    single = [n for n in state.warnings if code_of(n) == "electrical_conductance.single"]
    assert any("99 %" in note for note in single)


def test_heat_and_counts_say_it():
    """The hottest of less than ln 2 contacts has no median: NaN and a reason."""
    friction = tb.outputs.Friction(tau_ss=3e8)
    found, told = at(OPEN, friction, tb.outputs.FlashTemperature(v=1.0, A_n=A_N))
    assert math.isnan(found["dT_ss_peak"])
    assert {"flash_temperature.few.ss", "few.mean"} <= set(map(code_of, told))
    found, told = at(CLOSED, friction, tb.outputs.FlashTemperature(v=1.0, A_n=A_N))
    assert found["dT_ss_peak"] > 0
    assert not {"flash_temperature.few.ss", "few.mean"} & set(map(code_of, told))
    _, told = at(OPEN, tb.outputs.Counts(A_n=A_N))
    assert [text for text in told if code_of(text) == "few.mean" and "outputs.counts" in text]
    assert not at(OPEN, tb.outputs.Counts())[1]


@pytest.mark.parametrize(("x", "eta", "heard"), [(4e-6, 5e8, True), (5e-7, 3e8, False)])
def test_few_particles_among_many_asperities_are_told_where_they_carry(x, eta, heard):
    """Half a particle on average among several asperities; those that carry 0.04 % do not matter."""
    case = dusty(eta, x).replace(outputs=(tb.outputs.Counts(A_n=1e-9),))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        state = tb.solve(case, pressure=1e8)
    assert state.outputs["n_ss"] * 1e-9 > 2
    assert 0 < state.outputs["n_sa"] * 1e-9 < 1
    assert (state.particle_load_share > 0.01) == heard
    said = [code_of(note_of(each.message)) for each in caught]
    assert ("few.particles" in said) == heard


def test_the_template_is_open_at_its_smallest_force():
    """0.1 N on 1 mm² rest on dust: no metal touches, and no 7 GΩ is given."""
    path = resources.files("thirdbody").joinpath("data/studies/electrical.toml")
    with resources.as_file(path) as file:
        found = run_study(load_study(file))
    states = found["states"]
    closed = np.array(states["gc_closed"], float)
    assert closed[0] < 1e-9
    assert closed[-1] > 0.999
    for resistance, chance in zip(states["rho_c"], closed, strict=True):
        assert (resistance is None) == (chance < -math.expm1(-1.0))
    assert "A_n = 1×10⁻⁶ m²" in open_notes(found["warnings"])[0]


def test_where_nothing_touches_nothing_is_the_mean_of_few():
    """No area holds a contact, so none is a mean "over many, most of which hold none"."""
    contact = tb.Contact(
        surfaces=tb.MaterialPair(BODY, BODY), roughness=ROUGH,
        outputs=(tb.outputs.Counts(A_n=A_N), ElectricalConductance(A_n=A_N)),
    )  # fmt: skip
    state = tb.solve(contact, d=60 * ROUGH.sigma_s)
    assert state.outputs["n_ss"] == state.outputs["gc_closed"] == 0
    assert [*map(code_of, state.warnings)] == ["electrical_conductance.open", "few.none"]
    both = tb.solve(contact, d=np.array([OPEN, 60.0]) * ROUGH.sigma_s)
    told = {code_of(text): text for text in both.warnings}
    assert " 1 of 2 states" in told["few.none"]
    assert " 0.3 " in told["few.mean"]


@pytest.mark.slow
@pytest.mark.parametrize("conduct", ["insulate", "conduct"])
def test_outputs_alone_and_among_others(conduct):
    """Contacts of their own that an output asks for are solved by another engine among many."""
    dust = tb.Particles(
        material=BODY.replace(H=8e9, resistivity=1.0),
        areal_density=2e8,
        diameter=tb.LogNormal(median=1e-6, gsd=1.3),
    )
    contact = tb.Contact(
        surfaces=tb.MaterialPair(BODY, BODY),
        roughness=ROUGH,
        particles=dust,
        particle_law=tb.particle.Series(deep="off"),
        outputs=(
            ElectricalConductance(A_n=1e-7, particles=conduct, few="mean"),
            tb.outputs.Counts(),
        ),
    )
    count = 20  # as few as go to the engine of many
    H = BODY.H * np.linspace(0.9, 1.1, count)
    loads = np.geomspace(1e-6, 1e-4, count)
    vary = {"surfaces.first.H": H}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        among = tb.equilibria.solve_states(contact, F_star=loads, vary=vary)
        turned = tb.equilibria.solve_states(
            contact, F_star=loads[::-1], vary={"surfaces.first.H": H[::-1]}
        )
        for i in (0, 9, 19):
            one = tb.solve(contact.replace(**{"surfaces.first.H": float(H[i])}), F_star=loads[i])
            for name, value in one.outputs.items():
                assert float(among[name][i]) == pytest.approx(value, rel=3e-10, nan_ok=True), name
    for name in one.outputs:
        np.testing.assert_array_equal(among[name], turned[name][::-1], name)
