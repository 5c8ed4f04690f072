"""Every fast path against the model as `thirdbody.definition` writes it down.

As a script it prints how many combinations each path was held to, and the worst differences.
"""

import collections
import itertools
import sys
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent / "laws"))
from subjects import FIRST, HEIGHTS, SUBJECTS
from subjects import contact as two_body

import thirdbody as tb
from thirdbody import definition
from thirdbody.equilibrium import solve as equilibrium
from thirdbody.equilibrium.states import FEWEST, state_columns

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")

TOLERANCE = 1e-11
"""Of the load for loads, of the real area for areas."""
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = tb.Material(E=110e9, nu=0.33, H=1.5e9)
ROUGH = tb.Roughness(sigma=100e-9, R=2.8e-6)
MEAN = 250e-9
SIZES = {
    "one size": tb.distributions.Monodisperse(mean=MEAN),
    "gaussian": tb.TruncatedGaussian(mean=MEAN, std=0.1 * MEAN),
    "lognormal": tb.LogNormal(median=MEAN, gsd=1.4),
    "weibull": tb.distributions.Weibull(scale=MEAN, shape=4.0),
    "uniform": tb.distributions.Uniform(low=0.6 * MEAN, high=1.3 * MEAN),
    "histogram": tb.distributions.Histogram(edges=(1e-7, 2e-7, 3e-7), counts=(2.0, 5.0)),
}
SEATS = {
    "plane": dict(seat="plane"),
    "offset": dict(seat="offset", h_0=30e-9),
    "rough": dict(),
    "valleys": dict(zeta_mean=-0.4, zeta_std=0.7),
}
SHARP = tb.grains.Angular(roundness=0.25, angle="35 deg")
BLUNT = tb.grains.Angular(roundness=0.5, angle="12 deg", flatness=1.3)
SHADOWS = ("footprint", "projected", "covered", "none")
DUSTS = {"silica": SILICA, "soft": tb.Material(E=3e9, nu=0.4, H=4e8)}
SECONDS = {"like": STEEL, "unlike": SOFT}


def columns(states, i):
    """Columns of state i."""
    return {name: values[i] for name, values in states.items()}


def difference(contact, want, got):
    """The largest difference over all columns: loads to the load, areas to the real area."""
    E, load = contact.E_ss, want["F_ss"] + want["F_sa"]
    out = 0.0
    for name, value in want.items():
        if name.startswith("F"):
            out = max(out, abs(got[f"{name}_star"] * E - value) / abs(load))
        elif name in got:
            out = max(out, abs(got[name] - value) / want["A_t"])
    return float(out)


def by_tables(contact, d, want):
    return columns(tb.solve(contact, d=[d]).columns(), 0)


def by_compiled_tables(contact, d, want):
    with mock.patch.object(equilibrium.engine, "FEWEST", 1):
        states = tb.solve(contact, pressure=[want["F_ss"] + want["F_sa"]])
    return columns(states.columns(), 0)


def by_states(contact, d, want):
    """Among as many states of other roughness as the engine takes."""
    sigma = contact.roughness.sigma * np.linspace(1.0, 1.3, FEWEST)
    load = want["F_ss"] + want["F_sa"]
    return columns(state_columns(contact, pressure=load, vary={"roughness.sigma": sigma}), 0)


PATHS = {"tables": by_tables, "compiled": by_compiled_tables, "states": by_states}


def two_body_cases():
    """Every law on Gaussian heights, and one law on every height distribution."""
    for subject in SUBJECTS:
        if subject.law.of_surface:
            continue  # no sum over tips; tests/laws/test_field_theory.py has its definition
        yield f"{subject.label} gaussian", two_body(subject.law, HEIGHTS["gaussian"])
    for (name, heights), law in itertools.product(HEIGHTS.items(), ("gw", "ceb")):
        yield f"{law} {name}", two_body(FIRST[law].law, heights)


def particle_cases():
    """Sizes, seats and shadows, each with each; materials and laws in turn."""
    turns = itertools.cycle(itertools.product(DUSTS, SECONDS, ("series", "flakes", "off")))
    for (size, diameter), (seat, where), shadow in itertools.product(
        SIZES.items(), SEATS.items(), SHADOWS
    ):
        dust, second, kind = next(turns)
        own = {"series": {}, "flakes": dict(aspect=1.5), "off": dict(deep="off")}[kind]
        law = tb.particle.Flakes if kind == "flakes" else tb.particle.Series
        yield (
            f"{kind} {seat} {size} {shadow} {dust} {second}",
            tb.Contact(
                surfaces=tb.MaterialPair(STEEL, SECONDS[second]),
                roughness=ROUGH,
                particle_law=law(**where | dict(shadow=shadow) | own),
                particles=tb.Particles(material=DUSTS[dust], areal_density=2e11, diameter=diameter),
            ),
        )


def other_cases():
    """Laws of one particle (without a jump of their load, where no share balances), angular
    particles, two populations, an ellipticity."""
    dust = tb.Particles(material=SILICA, areal_density=1e11, diameter=SIZES["one size"])
    pair = tb.MaterialPair(STEEL, SOFT)
    for name in ("gw", "zmc"):
        law = tb.particle.Series(deep="off", law=FIRST[name].law)
        yield (
            f"particles of {name}",
            tb.Contact(surfaces=pair, roughness=ROUGH, particles=dust, particle_law=law),
        )
    seats, shadows = itertools.cycle(SEATS.items()), itertools.cycle(SHADOWS)
    for (size, diameter), (seat, where), shadow in zip(SIZES.items(), seats, shadows, strict=False):
        second, shape = (SOFT, BLUNT) if size == "gaussian" else (STEEL, SHARP)
        yield (
            f"angular {seat} {size} {shadow}",
            tb.Contact(
                surfaces=tb.MaterialPair(STEEL, second),
                roughness=ROUGH,
                particle_law=tb.particle.Series(deep="off", **where | dict(shadow=shadow)),
                particles=dust.replace(diameter=diameter, shape=shape),
            ),
        )
    small = tb.distributions.Monodisperse(mean=0.8 * MEAN)
    whole = tb.particle.Series(deep="off")
    for sizes, name in ((small, "two populations"), (SIZES["lognormal"], MANY)):
        debris = tb.Particles(material=SOFT, areal_density=3e11, diameter=sizes)
        particles = (dust, debris)
        yield (
            name,
            tb.Contact(surfaces=pair, roughness=ROUGH, particles=particles, particle_law=whole),
        )
    shapes = tb.surfaces.Ellipticity(ratios=(1.5, 4.0), weights=(2.0, 1.0), radii=(1.0, 1.4))
    law = tb.asperity.REGISTRY["elliptic-zmc"]()
    rough = ROUGH.replace(ellipticity=shapes)
    yield "ellipticity", tb.Contact(surfaces=pair, roughness=rough, asperity_law=law)


MANY = "two populations, one of many sizes"
QUICK = {f"{subject.label} gaussian" for subject in SUBJECTS}
CASES = dict(itertools.chain(two_body_cases(), particle_cases(), other_cases()))


def separation(contact):
    """Where asperities are pressed, and particles."""
    return 1.2 * contact.roughness.sigma


def compared(contact):
    """The difference of every path that takes this contact."""
    d = separation(contact)
    want = definition.state(contact, d)
    if want["F_ss"] + want["F_sa"] <= 0:  # adhesion holds it: no load to solve for
        return {"tables": difference(contact, want, by_tables(contact, d, want))}
    return {name: difference(contact, want, path(contact, d, want)) for name, path in PATHS.items()}


def chosen():
    """Quick: every law, every kind of heights, and every seventh combination of particles, which
    is every size, seat and shadow several times. Half of the others are among the slow tests: any
    two of size, seat and shadow in all their combinations. As a script this file holds them all."""
    places = itertools.product(*(range(len(each)) for each in (SIZES, SEATS, SHADOWS)))
    odd = {
        name for (name, _), place in zip(particle_cases(), places, strict=True) if sum(place) % 2
    }
    for i, name in enumerate(CASES):
        grains = name.startswith(("series ", "flakes ", "off ")) and i % 7
        heights = name.startswith("ceb ") and name not in QUICK
        dear = name.endswith("projected soft unlike")
        if grains and name in odd:
            continue
        slow = grains or heights or dear or name == MANY
        yield pytest.param(name, marks=pytest.mark.slow if slow else ())


@pytest.mark.check
@pytest.mark.parametrize("name", list(chosen()))
def test_every_path_is_the_model(name):
    for path, off in compared(CASES[name]).items():
        assert off < TOLERANCE, path


def breaking(diameter, fragments, shape=None, **options):
    """Quartz between hard steels."""
    hard = tb.Material(E=206e9, nu=0.29, H=7.37e9)
    strength = tb.grains.WeibullStrength(
        sigma_0=67e6, x_0=1e-3, m=3, size_exponent=0.55, x_c=1e-6, fragments=fragments
    )
    dust = tb.Particles(material=tb.materials["quartz"], areal_density=1e7, diameter=diameter,
                        strength=strength, shape=shape or tb.grains.Sphere())  # fmt: skip
    return tb.Contact(
        surfaces=tb.MaterialPair(hard, hard.replace(H=options.pop("H", 7.37e9))),
        roughness=tb.Roughness(sigma=1e-6, R=20e-6),
        particles=dust,
        particle_law=tb.particle.Series(deep="off", **options),
    )


ONE, SOME = (
    tb.distributions.Monodisperse(mean=20e-6),
    tb.distributions.Uniform(low=8e-6, high=20e-6),
)
BREAKING = {
    "one size plane": (breaking(ONE, "footprint", seat="plane"), (15e-6, 6e-6, 0.8e-6)),
    "one size rough": (breaking(ONE, "all"), (17e-6, 7e-6)),
    "one size unlike": (breaking(ONE, "gone", H=4e9), (12e-6,)),
    "sizes plane": (breaking(SOME, "footprint", seat="plane"), (12e-6, 3e-6)),
    "angular": (breaking(ONE, "all", SHARP, seat="plane", H=4e9), (14e-6, 3e-6)),
}


SHAPES = ((0.25, 35, 1.0), (0.5, 12, 1.3), (0.9, 70, 1.2), (0.05, 5, 1.0))


@pytest.mark.spread(4)
@pytest.mark.parametrize("law", ["gw", "ceb", "zmc", "hermite", "jg", "ke"])
def test_angular_particles_of_every_law(law):
    for roundness, degrees, flatness in SHAPES:
        shape = tb.grains.Angular(roundness=roundness, angle=f"{degrees} deg", flatness=flatness)
        case = tb.Contact(
            surfaces=tb.MaterialPair(STEEL, SOFT),
            roughness=ROUGH,
            particles=tb.Particles(
                material=SILICA, areal_density=1e11, diameter=SIZES["one size"], shape=shape
            ),
            particle_law=tb.particle.Series(
                deep="off", law=tb.asperity.REGISTRY[law](), seat="plane"
            ),
        )
        for d in (0.96 * MEAN, 0.6 * MEAN, 0.08 * MEAN):
            want = definition.state(case, d)
            assert difference(case, want, by_tables(case, d, want)) < TOLERANCE, (shape, d)


LONG = ("one size rough", "one size unlike", "sizes plane")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in BREAKING],
)
def test_particles_that_break(name):
    """Tables of them are made to 1e-10, and so is the tension inside."""
    case, separations = BREAKING[name]
    for d in separations:
        want = definition.state(case, d)
        assert want["F_sa"] > 0
        assert difference(case, want, by_tables(case, d, want)) < 1e-8, d


@pytest.mark.slow
def test_the_balance():
    """The separation that the definition's own root finds; its sums are for the tests above."""
    contact = next(case for name, case in CASES.items() if name.startswith("series plane one"))
    state = tb.solve(contact, pressure=5e6)
    assert state.d == pytest.approx(definition.separation(contact, 5e6), rel=1e-12)


def main():
    worst, count = collections.defaultdict(lambda: (0.0, "")), collections.Counter()
    for name, contact in CASES.items():
        for path, off in compared(contact).items():
            count[path] += 1
            worst[path] = max(worst[path], (off, name))
            if off > TOLERANCE:
                print(path, name, off)
    for path, (off, name) in worst.items():
        print(f"{path}: {count[path]} combinations, worst {off:.1e} ({name})")


if __name__ == "__main__":
    main()
