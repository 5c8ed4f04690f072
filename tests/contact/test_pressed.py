"""Particles pressed beyond the laws of one contact are told of, once, wherever states are told."""

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact.pressed import AT, EXPONENT, STRENGTH, about_pressed

STEEL = tb.materials["S45C"]
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.RangeWarning")


def contact(size, material="SiO2", **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials[material],
            areal_density=1e-2 / size**2,
            diameter=tb.TruncatedGaussian(mean=size, std=0.05 * size),
        ),
        particle_law=tb.particle.Series(seat="plane"),
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
            assert any("deeper than their radius" in text for text in state.warnings) == told


@pytest.mark.parametrize("material", ["SiO2", "S45C"])
def test_brittle_grains_beyond_their_strength(material):
    """On either side of the squeeze at which a grain of the mean size reaches its strength."""
    size = 50e-6
    case = contact(size, material)
    most = STRENGTH * (AT / size) ** EXPONENT * size**2

    def load(squeeze):
        law, body = case.particle_law, case.particles.material
        spots = law.probe(np.array([squeeze]), surfaces=case.surfaces, particle=body)
        return float(spots.load[0, 0] / spots.x[0, 0] ** 2 * size**2)

    squeezes = np.geomspace(1e-5, 0.5, 400)
    limit = squeezes[np.searchsorted([load(each) for each in squeezes], most)]
    below, above = (
        about_pressed(case, np.array([size * (1 - factor * limit)])) for factor in (-1.0, 1.5)
    )
    broken = [any("brittle" in text for text in texts) for texts in (below, above)]
    assert broken == [False, material == "SiO2"]
    # below a micrometre quartz deforms
    assert not any("brittle" in text for text in about_pressed(contact(5e-7), np.array([1e-7])))
