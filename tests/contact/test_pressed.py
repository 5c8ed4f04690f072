"""Particles pressed beyond the laws of one contact are told of, once, wherever states are told."""

import json
import warnings
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact import pressed
from thirdbody.contact.pressed import about_pressed
from thirdbody.errors import code_of, note_of, place_note
from thirdbody.laws.particle.deep import DeepSqueeze
from thirdbody.quantities.say import value_of

STEEL = tb.materials["S45C"]
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def contact(size, material="SiO2", **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials[material],
            areal_density=1e-2 / size**2,
            diameter=tb.TruncatedGaussian(mean=size, std=0.05 * size),
        ),
        particle_law=tb.particle.Series(deep="off", seat="plane"),
        **more,
    )


def test_deeper_than_the_radius():
    """In one state and in an array whose lowest separation is that one."""
    soft = tb.MaterialPair(STEEL, STEEL.replace(H=1e9))  # takes nearly all of the squeeze
    case = contact(2e-6).replace(surfaces=soft)
    for d, told in ((1.9e-6, False), (0.1e-6, True)):
        one = tb.solve(case, d=d)
        several = tb.solve(case, d=np.array([1.95e-6, d]))
        for state in (one, several):
            assert ("buried" in map(code_of, state.warnings)) == told


def brittle(case, d):
    return any("brittle" in text for text in about_pressed(case, np.array([d])))


def test_brittle_grains_beyond_their_strength():
    """On either side of the squeeze at which most grains of the mean size have failed."""
    size = 50e-6
    case = contact(size)
    strength = tb.grains.WeibullStrength.of(tb.materials["SiO2"])
    squeezes = np.geomspace(1e-6, 0.1, 400)
    spots = case.particle_law.probe(
        squeezes, surfaces=case.surfaces, particle=case.particles.material
    )
    tensions = np.ravel(spots.load / spots.x**2)  # small caps: F/x² is the tension
    limit = squeezes[np.searchsorted(tensions, strength.of_size(size))]
    widest = case.particles.diameter.support[1]
    assert not brittle(case, widest - 0.3 * limit * size)
    assert brittle(case, size * (1 - 1.5 * limit))
    told = case.replace(particles=case.particles.replace(strength=strength))
    assert not brittle(told, size * (1 - 1.5 * limit))


def test_notes_say_at_which_state_grains_break():
    """At the lowest separation of those that were solved; of a derivative at the critical load."""
    case = contact(50e-6)
    states = tb.solve(case, d=np.array([49.9e-6, 40e-6]))
    (note,) = (each for each in states.warnings if code_of(each) == "brittle")
    assert f"h = {value_of(states.h[1], 'm')}" in note

    critical = tb.transitions(case).F_tpca.B.value
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", tb.errors.RangeWarning)
        tb.sensitivity(case, of="F_tpca.B", to="roughness.sigma")
        alone = tb.solve(case, F_star=critical)
    placed = [note_of(item.message) for item in heard]
    (there,) = (each for each in placed if str(each).startswith("at F_tpca B, "))
    assert there == place_note(*(n for n in alone.warnings if code_of(n) == "brittle"), "F_tpca B")


def test_what_does_not_break_is_not_told_of():
    assert not brittle(contact(50e-6, "S45C"), 10e-6)  # ductile
    assert not brittle(contact(0.5e-6), 0.1e-6)  # below a micrometre glass deforms
    # between soft surfaces a grain sinks whole
    soft = tb.MaterialPair(STEEL.replace(H=50e6), STEEL.replace(H=50e6))
    assert not brittle(contact(5e-6).replace(surfaces=soft), 0.5e-6)


@pytest.mark.parametrize("seat", ["plane", "rough"])
@pytest.mark.parametrize(("size", "spread"), [(300e-9, 0.05), (300e-9, 0.3), (8e-6, 0.2)])
def test_bounds_of_the_shares_hold(seat, size, spread):
    """What the tables say at most is never less than what every particle says."""
    case = contact(size).replace(particle_law=tb.particle.Series(deep="off", seat=seat))
    sizes = tb.TruncatedGaussian(mean=size, std=spread * size)
    case = case.replace(**{"particles.diameter": sizes})
    quiet = 0
    for d in np.linspace(0.2, 1.6, 15) * size:
        shares = [float(share[0]) for share in pressed._shares(case, np.array([d]))]
        bounds = pressed._at_most(case, np.array([d]))
        for share, bound in zip(shares, bounds, strict=True):
            assert bound[0] >= share * (1 - 1e-7)
        quiet += np.max(bounds) <= pressed.TOLD
    assert quiet


def test_single_particles_are_left_alone_where_the_tables_suffice(monkeypatch):
    case = contact(300e-9).replace(particle_law=tb.particle.Series(deep="off", seat="rough"))
    tb.solve(case, pressure=1e5)
    monkeypatch.setattr(pressed, "_shares", lambda *_: pytest.fail("single particles evaluated"))
    assert not tb.solve(case, pressure=1e5).warnings


def test_squashed_particles_are_told_of_from_a_fifth_of_their_radius_on():
    """Soft spheres of one size on a plane seat: the gap at which their contact is that wide."""
    soft = tb.Material(E=70e9, nu=0.33, H=1e9)
    case = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=50e-9, R=5e-6),
        particles=tb.Particles(
            material=soft, diameter=tb.distributions.Monodisperse(mean=10e-6), areal_density=1e8
        ),
        particle_law=tb.particle.Series(deep="off", seat="plane"),
    )

    def told(gap):
        found = case.particle_law.single(10e-6, gap, surfaces=case.surfaces, particle=soft)
        width = (min(float(found["area_1"]), float(found["area_2"])) / np.pi) ** 0.5 / 5e-6
        said = [text for text in tb.solve(case, d=gap).warnings if "squashed" in text]
        return width, bool(said)

    for gap in np.linspace(9.0, 9.99, 23) * 1e-6:
        width, said = told(gap)
        if abs(width - 0.2) > 0.005:
            assert said == (width > 0.2), gap
    # a sphere that stays one is not told of, nor a hard particle
    for changed in ({"particle_law": tb.particle.Series(deep="off", seat="plane", soft="sphere")},
                    {"particles.material": tb.materials["Al2O3"]}):  # fmt: skip
        case = case.replace(**changed)
        assert not told(9.2e-6)[1]


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_sizes_down_to_zero_are_weighed():
    wide = tb.TruncatedGaussian(mean=300e-9, std=3e-6)
    case = contact(300e-9).replace(
        particles=tb.Particles(
            material=tb.materials["SiO2"].replace(K_c=0.67e6), areal_density=1e-9, diameter=wide
        ),
        particle_law=tb.particle.Series(),
    )
    assert brittle(case, 100e-9)


def test_particles_of_the_table_say_what_holds_them():
    """From the first side at 0.15 of its radius on, and where collars may touch."""
    law = tb.particle.Series(seat="plane")

    def told(gap, ratio):
        dust = tb.Particles(
            material=STEEL.replace(H=ratio * STEEL.H),
            diameter=tb.distributions.Monodisperse(mean=10e-6),
            areal_density=1e8,
        )
        case = contact(10e-6).replace(particle_law=law, particles=dust)
        state = tb.solve(case, d=gap * 10e-6)
        assert not {"buried", "squashed"} & set(map(code_of, state.warnings))
        return [note for note in state.warnings if code_of(note) == "squeezed"]

    for ratio in (0.6, 5.0):
        assert not told(0.86, ratio)
        (text,) = told(0.84, ratio)
        assert "friction_factor" in text
    assert not any("collars" in note for note in told(0.34, 5.0))
    (text,) = told(0.30, 5.0)
    assert "collars" in text
    assert not any("collars" in note for note in told(0.30, 0.6))


def test_angular_grains_still_end_with_the_law_of_one_contact():
    case = contact(2e-6).replace(particle_law=tb.particle.Series(seat="plane"))
    grains = case.particles.replace(shape=tb.grains.Angular(roundness=0.5, angle="30 deg"))
    soft = tb.MaterialPair(STEEL, STEEL.replace(H=1e9))
    state = tb.solve(case.replace(particles=grains, surfaces=soft), d=0.1e-6)
    codes = set(map(code_of, state.warnings))
    assert "buried" in codes
    assert "squeezed" not in codes


def test_the_worth_of_friction_is_that_of_the_computed_loads():
    """What is told for hard grains lies between the loads that were computed, ε from 0.15 to 0.7."""
    table = json.loads(
        resources.files("thirdbody").joinpath("data/deep_squeeze.json").read_text("utf-8")
    )
    loads = {
        curve["m"]: np.array(curve["F"]) * (1 - np.array(curve["collar"]))
        for curve in table["curves"]
        if (curve["rho"], curve["E_over_Y"], curve["surfaces"]) == ("inf", "inf", 2)
    }
    early = slice(table["eps"].index(0.15), table["eps"].index(0.7) + 1)
    form = DeepSqueeze(50.0, 0.2)
    for friction in (0.2, 1.0):
        side = replace(form, friction=friction).side(tb.asperity.Hermite(), 1e15, 1e9, 0.3, 0.5)
        low, high = side.friction_band
        assert low == pytest.approx(np.min((loads[0] / loads[friction])[early]) - 1, abs=0.02)
        assert high == pytest.approx(np.max((loads[1] / loads[friction])[early]) - 1, abs=0.02)
