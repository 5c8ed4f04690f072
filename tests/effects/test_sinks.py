"""What dents, ploughs and stays, of particles whose law says how deep they sink."""

import dataclasses
import warnings

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.effects import Dents, Friction
from thirdbody.effects.single.dent import dent_of
from thirdbody.effects.single.ploughing import coefficient, groove_area, groove_of
from thirdbody.laws.particle import Series

STEEL = tb.materials["S45C"]
PAIR = tb.MaterialPair(STEEL, STEEL)
FRICTION = Friction(tau_ss=580e6, tau_sa=200e6, rear="rigid")


def of_hardness(ratio):
    return STEEL.replace(H=ratio * STEEL.H)


def probe(eps, ratio, **options):
    law, particle = Series(**options), of_hardness(ratio)
    found = law.probe(np.atleast_1d(eps), surfaces=PAIR, particle=particle)
    return dataclasses.replace(found, material=particle)


def solved(ratio, outputs, *, pressure=20e6, **options):
    dust = tb.Particles(
        material=of_hardness(ratio),
        areal_density=1e10,
        diameter=tb.TruncatedGaussian(mean=500e-9, std=100e-9),
    )
    contact = tb.Contact(
        surfaces=PAIR,
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust,
        particle_law=Series(**options),
        outputs=outputs,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return tb.solve(contact, pressure=pressure).outputs


# ---------------------------------------------------------------------------- one particle
def test_without_the_table_a_sink_is_the_indentation():
    spots = probe([0.01, 0.2, 0.7], 1.3, deep="off")
    assert spots.sinks is spots.depths or np.array_equal(spots.sinks, spots.depths)
    assert spots.impression_radius(0) is spots.radius


@pytest.mark.parametrize("ratio", [1.0, 1.6, 2.4, 50.0])
def test_an_impression_is_as_wide_as_its_contact(ratio):
    """A cap as deep as the sink, through the rim of the contact: no narrower than the tip."""
    spots = probe(np.linspace(0.16, 0.7, 30), ratio)
    d, a = spots.sinks[0], np.sqrt(spots.areas[0] / np.pi)
    radius = spots.impression_radius(0)
    assert np.all(radius >= spots.radius)
    rim = 2 * radius * d - d**2
    np.testing.assert_allclose(np.where(radius > spots.radius, rim, a**2), a**2, rtol=1e-9)


def test_a_groove_is_pushed_aside_by_half_the_contact():
    """Without support behind, force over load is the groove over half the contact seen from above."""
    spots = probe(np.linspace(0.2, 0.6, 9), 1.2)
    d, radius = spots.sinks[0], spots.impression_radius(0)
    expected = 2 * groove_of(spots, side=0) / spots.areas[0]
    np.testing.assert_allclose(coefficient(d, radius=radius), expected, rtol=1e-9)
    np.testing.assert_allclose(groove_of(spots, side=0), groove_area(d, radius=radius))


def test_a_rigid_particle_dents_as_without_the_table():
    """Its depth is the whole squeeze; its dent is wider by what piles up at the rim."""
    eps = np.linspace(0.2, 0.8, 13)
    one, two = (
        dent_of(probe(eps, 100.0, deep=deep), side=0, particle=of_hardness(100.0))
        for deep in ("table", "off")
    )
    np.testing.assert_allclose(one.depth, two.depth, rtol=1e-9)
    assert np.all((one.diameter >= two.diameter) & (one.diameter < 1.25 * two.diameter))


def test_how_deep_a_particle_dents_does_not_jump_at_equal_hardness():
    eps = np.linspace(0.2, 0.8, 13)
    below, above = (
        dent_of(probe(eps, ratio), side=0, particle=of_hardness(ratio)) for ratio in (0.999, 1.001)
    )
    assert np.all(np.isfinite(below.depth))
    assert np.all(np.abs(above.depth - below.depth) < 3e-3 * 0.5 * eps[:, None])
    # without the table: nothing known below, the whole indentation above
    below, above = (
        dent_of(probe(eps, ratio, deep="off"), side=0, particle=of_hardness(ratio))
        for ratio in (0.999, 1.001)
    )
    assert np.all(np.isnan(below.depth))
    assert np.all(above.depth > 0.3 * 0.5 * eps[:, None])


def test_particles_of_two_surfaces_sit_deeper_in_the_softer():
    law = Series()
    pair = tb.MaterialPair(STEEL, of_hardness(0.4))
    spots = law.probe(np.array([0.4, 0.7]), surfaces=pair, particle=of_hardness(1.1))
    assert np.all(spots.sinks[1] > 5 * spots.sinks[0])
    assert not np.any(spots.even)
    same = law.probe(np.array([0.4]), surfaces=PAIR, particle=of_hardness(1.1))
    assert np.all(same.even)


# ---------------------------------------------------------------------------- the interface
@pytest.mark.slow
def test_nothing_embeds_at_equal_hardness():
    table, off = (solved(1.0001, Dents(), deep=deep) for deep in ("table", "off"))
    assert table["embedded_1"] < 1e-3 * off["embedded_1"]  # those of squeezes beyond 1
    assert off["embedded_1"] > 0
    hard = solved(5.0, Dents())
    assert hard["embedded_1"] > 0


@pytest.mark.slow
def test_depths_of_dents_are_known_at_any_hardness():
    depths = {}
    for ratio in (0.6, 0.999, 1.001, 1.5, 4.0):
        found = solved(ratio, Dents())
        depths[ratio] = found["dent_depth_1"]
        assert np.isfinite(found["dent_volume_1"])
    assert depths[1.001] == pytest.approx(depths[0.999], abs=0.003 * depths[4.0])
    assert depths[0.6] < depths[1.001] < depths[1.5] < depths[4.0]


def test_a_flattened_particle_hardly_ploughs():
    flat, deep = (solved(ratio, FRICTION) for ratio in (1.0, 4.0))
    off = solved(1.0001, FRICTION, deep="off")
    assert flat["mu_sa"] < 0.4 * off["mu_sa"]
    assert deep["mu_sa"] > 2 * flat["mu_sa"]


def test_what_keeps_its_shape_is_not_squashed_by_its_law():
    with refuses(Mistake.CLASH, "outputs.dents", says="'hard'"):
        solved(1.0, Dents(debris="hard"))
    hard = solved(3.0, Dents(debris="hard"))
    assert hard["dent_depth_1"] >= solved(3.0, Dents())["dent_depth_1"]


@pytest.mark.parametrize("ratio", [0.8, 1.7, 6.0])
def test_finer_sums(ratio):
    """Sinks are straight lines between the squeezes of the table, which sums do not stop at."""

    class Finer(Friction):
        __slots__ = ()

        def splits(self, probe):
            return sorted({*Friction.splits(self, probe), *np.geomspace(1e-4, 1.2, 40)})

    fields = {item.name: getattr(FRICTION, item.name) for item in dataclasses.fields(FRICTION)}
    one, two = solved(ratio, FRICTION), solved(ratio, Finer(**fields))
    for column in one:
        assert two[column] == pytest.approx(one[column], rel=1e-4, abs=1e-9), column


def test_kinks_that_rounding_holds_apart_are_one():
    """A disc may end where the planes meet, at a squeeze of 1 to rounding."""
    from thirdbody.effects.curves import Curve

    for kink in (1 - 2e-16, 1 + 2e-16):
        curve = Curve(lambda eps: np.sin(np.minimum(eps, 1.0)), [0.5, kink])
        found = curve.first(np.sin([0.25, 0.75]))
        assert found == pytest.approx([0.25, 0.75], rel=1e-7)
