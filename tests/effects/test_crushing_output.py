"""What is said of particles that break: shares, sizes, warnings and mistakes."""

import math

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.errors import code_of, note_of

HARD = tb.Material(E=206e9, nu=0.29, H=7.37e9)
PAIR = tb.MaterialPair(HARD, HARD)
QUARTZ = tb.materials["quartz"]
SIZES = tb.distributions.PowerLaw(edges=(5e-6, 40e-6), counts=(1,), slopes=(3.0,))
QUIET = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def contact_of(strength, *, sizes=SIZES, material=QUARTZ, density=1e7, law=None, outputs=()):
    return tb.Contact(
        surfaces=PAIR,
        roughness=tb.Roughness(sigma=0.5e-6, R=50e-6),
        particles=tb.Particles(
            material=material, diameter=sizes, areal_density=density, strength=strength
        ),
        particle_law=law or tb.particle.Series(deep="off", seat="plane"),
        outputs=outputs,
    )


@QUIET
@pytest.mark.parametrize("fragments", ["gone", "footprint", "all"])
@pytest.mark.parametrize("seat", ["plane", "rough"])
def test_what_crushing_tells(fragments, seat):
    law = tb.particle.Series(deep="off", seat=seat)
    strength = tb.grains.WeibullStrength.of(QUARTZ, fragments=fragments)
    contact = contact_of(strength, law=law, outputs=tb.outputs.Crushing(A_n=1e-4))
    d = np.array([12e-6, 4e-6, 1e-6])
    state = tb.solve(contact, d=d)
    whole = tb.solve(contact_of(None, law=law), d=d)
    found = state.outputs
    ratio = (
        whole.F_sa / state.F_sa
        if hasattr(state, "F_sa")
        else (
            whole.pressure
            * whole.particle_load_share
            / (state.pressure * state.particle_load_share)
        )
    )
    np.testing.assert_allclose(found["load_if_whole"], ratio, rtol=2e-5)
    assert np.all((found["broken_share"] > 0) & (found["broken_share"] < 1))
    assert np.all(found["broken_mass_share"] > found["broken_share"])
    np.testing.assert_allclose(found["x_star"], 5.43e-6, rtol=2e-3)
    if fragments == "gone":
        assert np.all(np.isnan(found["fragment_size"]))
    else:
        assert np.all(found["fragment_size"] < 20e-6)
        assert np.all(np.diff(found["fragment_size"]) < 0)
        assert np.all(np.diff(found["n_bearing"]) > 0)
    # the largest in 100 mm² is there in half of all cases: A_n N(>x) = ln 2
    assert np.all(found["survivor_max"] <= 40e-6)


@QUIET
def test_sizes_before_anything_breaks():
    """Of strong particles nothing breaks, and the largest of A_n is that of their sizes."""
    strong = tb.grains.WeibullStrength(sigma_0=1e15, x_0=1e-3, m=3, x_c=0.0)
    contact = contact_of(strong, outputs=tb.outputs.Crushing(A_n=1e-4))
    found = tb.solve(contact, d=2e-6).outputs
    assert found["broken_share"] == pytest.approx(0, abs=1e-15)
    assert found["load_if_whole"] == pytest.approx(1, abs=1e-9)
    assert math.isnan(found["fragment_size"])
    assert found["n_bearing"] == pytest.approx(1e7, rel=1e-6)
    x = SIZES.ppf(1 - math.log(2) / (1e-4 * 1e7))
    assert found["survivor_max"] == pytest.approx(float(x), rel=0.02)


# ---------------------------------------------------------------- roots, jumps, branches
@QUIET
def test_one_size_has_several_equilibria():
    strength = tb.grains.WeibullStrength.of(QUARTZ)
    contact = contact_of(strength, sizes=tb.distributions.Monodisperse(mean=20e-6), density=1e7)
    with pytest.warns(tb.errors.RangeWarning) as heard:
        state = tb.solve(contact, pressure=2e5)
    assert "branches" in {code_of(note_of(each.message)) for each in heard}
    found = tb.equilibria.roots(contact, pressure=2e5)
    assert [stable for _, stable in found] == [True, False, True]
    assert found[0][0].d == pytest.approx(state.d, rel=1e-12)
    assert found[0][0].d > 17e-6
    assert found[2][0].d < 10e-6
    for root, _ in found:
        assert root.pressure == pytest.approx(2e5, rel=1e-9)


@QUIET
def test_what_is_broken_does_not_heal():
    contact = contact_of(tb.grains.WeibullStrength.of(QUARTZ))
    with refuses(Mistake.IDLE, "branch", value="'unloading'"):
        tb.solve(contact, pressure=1e5, branch="unloading")


@QUIET
def test_many_loads_are_those_of_few():
    rough = tb.particle.Series(deep="off")
    contact = contact_of(tb.grains.WeibullStrength.of(QUARTZ), law=rough)
    loads = np.geomspace(1e4, 5e6, 6000)
    many, few = tb.solve(contact, pressure=loads), tb.solve(contact, pressure=loads[::400])
    np.testing.assert_allclose(many.d[::400], few.d, rtol=1e-10)
    strengths = {"particles.strength.sigma_0": np.array([6e7, 67e6])}
    varied = tb.equilibria.solve_states(contact, vary=strengths, pressure=1e5)
    one = tb.solve(contact, pressure=1e5)
    assert varied["d"][1] == pytest.approx(one.d, rel=1e-12)
    assert varied["d"][0] < varied["d"][1]


# ---------------------------------------------------------------- warnings and mistakes
def sentences(contact):
    with pytest.warns(tb.errors.RangeWarning):
        return tb.solve(contact, d=3e-6).warnings


def test_warnings():
    strength = tb.grains.WeibullStrength.of(QUARTZ)
    (said,) = sentences(contact_of(strength))
    assert code_of(said) == "strength.sizes.quartz"
    for told in ("5 µm to 40 µm", "(1 mm)", "factor 18"):
        assert told in said
    no_toughness = contact_of(strength, material=QUARTZ.replace(K_c=None))
    assert "strength.smallest.quartz" in map(code_of, sentences(no_toughness))
    inside = strength.replace(x_from=1e-6, x_to=1e-3, x_c=1e-6)
    assert tb.solve(contact_of(inside), d=3e-6).warnings == ()
    crowd = contact_of(inside.replace(fragments="all"), density=2e9)
    assert "fragments" in map(code_of, sentences(crowd))
    assert "fragments" not in map(code_of, sentences(contact_of(strength)))
    soft = contact_of(inside, material=QUARTZ.replace(H=2e9))
    assert "strength.soft.quartz" in map(code_of, sentences(soft))


@pytest.mark.parametrize(
    ("change", "code", "place", "value"),
    [
        (dict(ratio=1.0), Mistake.RANGE, "ratio", "1.0"),
        (dict(m=0), Mistake.RANGE, "m", "0"),
        (dict(sigma_0=-1.0), Mistake.RANGE, "sigma_0", "-1.0"),
        (dict(fragments="some"), Mistake.OPTION, "fragments", "'some'"),
        (dict(confinement="box"), Mistake.OPTION, "confinement", "'box'"),
        (dict(x_from=1e-3, x_to=1e-4), Mistake.ORDER, "x_from", "0.001"),
    ],
)
def test_mistakes_in_a_strength(change, code, place, value):
    good = dict(sigma_0=67e6, x_0=1e-3, m=3.0)
    with refuses(code, "WeibullStrength." + place, value=value):
        tb.grains.WeibullStrength(**good | change)


def test_materials_without_a_strength():
    with refuses(Mistake.BEYOND, "", says="sigma_0, x_0, m, and K_c"):
        tb.grains.WeibullStrength.of(tb.materials["MoS2"])
    with refuses(Mistake.RANGE, "K_c", value="0.0"):
        tb.grains.WeibullStrength.from_toughness(0.0)
    estimate = tb.grains.WeibullStrength.of(tb.materials["Al2O3"])
    assert estimate.of_size(4e-6) == pytest.approx(1.8 * 4.1e6 / 2e-3, rel=1e-12)
    assert estimate.m == 3


def test_mistakes_of_a_contact_with_a_strength():
    strength = tb.grains.WeibullStrength.of(QUARTZ)
    for law in (tb.particle.Horng2022(), tb.particle.Flakes(aspect=3)):
        with refuses(Mistake.BEYOND, "particles.strength"):
            contact_of(strength, law=law)
    dents = tb.outputs.Dents(debris="brittle", fragment=1e-6)
    with refuses(Mistake.CLASH, "outputs.dents"):
        contact_of(strength, outputs=dents)
    with refuses(Mistake.MISSING, "outputs.crushing"):
        contact_of(None, outputs=tb.outputs.Crushing())
    with refuses(Mistake.KIND, "Particles.strength", value="67000000.0"):
        contact_of(67e6)
    crowd = contact_of(strength.replace(fragments="all"), density=6e9)
    with refuses(Mistake.FULL, ""):
        tb.solve(crowd, d=3e-6)


def test_round_trip():
    contact = contact_of(tb.grains.WeibullStrength.of(QUARTZ, fragments="all"))
    assert tb.Contact.from_dict(contact.to_dict()) == contact
