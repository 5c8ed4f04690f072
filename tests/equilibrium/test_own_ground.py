"""States of particles on one field of heights by the compiled engine, against tables of each."""

import math
import os
from unittest import mock

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.contact.broken_averages import roughly
from thirdbody.contact.interface import interface
from thirdbody.equilibrium import states
from thirdbody.equilibrium.engine import grounded, grounds
from thirdbody.equilibrium.engine.run import NO_TABLE, NOT_RESOLVED, SQUEEZED, own_columns
from thirdbody.equilibrium.states import state_columns
from thirdbody.equilibrium.status import Status
from thirdbody.laws.field.own import RollOff
from thirdbody.laws.field.programme import MOMENTS
from thirdbody.laws.field.spectrum import rolled_off

pytestmark = pytest.mark.slow  # its kernel is compiled for it alone
BOUND = 1e-9
"""Of d over σ, of loads over the load, of areas over the area."""
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
HARD = tb.Particles(
    material=SILICA,
    areal_density=1e11,
    diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9, n=3.0),
)
SOFT = HARD.replace(material=STEEL.replace(H=1e9))


def contact(particles=HARD, law=None):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=5.0),
        asperity_law=tb.asperity.Field(),
        particles=particles,
        particle_law=law or tb.particle.Series(seat="rough"),
    )


SIZES = {"particles.diameter.mean": (150e-9, 450e-9), "particles.diameter.n": (1.5, 5.0)}
FIRST = {"surfaces.first.H": (1e9, 9e9), "surfaces.first.E": (8e10, 3e11)}
SEAT = {"particle_law.zeta_std": (0.5, 1.0), "particle_law.zeta_mean": (0.5, 1.5)}
CASES = {
    "hard": (contact(), {"roughness.alpha": (2.6, 8.3), **SIZES}),
    "squashed": (contact(SOFT), {"particles.diameter.mean": (150e-9, 450e-9)}),
    "two different sides": (contact(), FIRST),
    "another seat": (contact(), SEAT),
    "one size": (
        contact(HARD.replace(diameter=tb.distributions.Monodisperse(mean=300e-9))),
        {"particles.diameter.mean": (150e-9, 450e-9)},
    ),
    "log-normal": (
        contact(HARD.replace(diameter=tb.LogNormal(median=300e-9, gsd=1.2))),
        {"particles.diameter.median": (200e-9, 400e-9)},
    ),
    "uniform, covered": (
        contact(
            HARD.replace(diameter=tb.distributions.Uniform(low=200e-9, high=400e-9)),
            tb.particle.Series(seat="rough", shadow="covered"),
        ),
        {"particles.diameter.low": (150e-9, 250e-9)},
    ),
    "not deep, no shadow": (
        contact(SOFT, tb.particle.Series(seat="rough", deep="off", shadow="none")),
        {"particle_law.friction_factor": (0.1, 1.0)},
    ),
    "uniform, squashed": (
        contact(SOFT.replace(diameter=tb.distributions.Uniform(low=200e-9, high=400e-9))),
        {"particles.diameter.low": (150e-9, 250e-9)},
    ),
    "grit": (
        contact(HARD.replace(shape=tb.grains.Angular(roundness=0.25, angle=math.radians(35)))),
        {"particles.shape.angle": (0.5, 0.7)},
    ),
}
ROUGH = {"roughness.sigma": (50e-9, 200e-9), "roughness.R": (1e-6, 8e-6)}
USUAL = {
    **ROUGH,
    "particles.areal_density": (1e9, 3e11),
    "particles.material.E": (5e10, 3e11),
    "particles.material.H": (1e9, 2e10),
}
UNIFORM = SOFT.replace(
    areal_density=3e10, diameter=tb.distributions.Uniform(low=150e-9, high=380e-9)
)
COVERED = tb.particle.Series(seat="rough", shadow="covered")
DIRT = HARD.replace(
    diameter=tb.distributions.PowerLaw(
        edges=(150e-9, 250e-9, 400e-9, 600e-9),
        counts=(1350.0, 396.0, 56.6),
        slopes=(3.41, 2.45, 3.34),
    )
)
SEVERAL = {
    "hard and squashed": (
        contact((HARD, SOFT)),
        {"particles.0.diameter.mean": (150e-9, 450e-9), "particles.1.material.H": (5e8, 5e9)},
    ),
    "three kinds of sizes": (
        contact(
            (
                HARD,
                SOFT.replace(areal_density=5e10, diameter=tb.LogNormal(median=250e-9, gsd=1.25)),
                HARD.replace(
                    areal_density=2e10, diameter=tb.distributions.Monodisperse(mean=420e-9)
                ),
            )
        ),
        {"particles.1.material.H": (5e8, 5e9), "particles.2.areal_density": (1e8, 1e11)},
    ),
    "grit and squashed": (
        contact(
            (HARD.replace(shape=tb.grains.Angular(roundness=0.25, angle=math.radians(35))), UNIFORM)
        ),
        {"particles.0.areal_density": (1e9, 1e11), "particles.1.diameter.low": (1e-7, 3e-7)},
    ),
    "laws of their own, two different sides": (
        contact(
            (
                HARD.replace(law=COVERED.replace(zeta_std=0.6, zeta_mean=0.8)),
                UNIFORM.replace(law=tb.particle.Series(seat="rough")),
            )
        ),
        {"surfaces.first.H": (1e9, 9e9), "particles.0.law.zeta_std": (0.5, 0.9)},
    ),
    "classes of sizes": (contact(DIRT), {}),
    "classes of sizes and squashed": (contact((DIRT, SOFT)), {}),
    "15 and 1 um": (
        contact(
            (
                HARD.replace(
                    areal_density=1e8, diameter=tb.TruncatedGaussian(mean=15e-6, std=1e-6, n=3.0)
                ),
                SOFT.replace(
                    areal_density=1e10, diameter=tb.TruncatedGaussian(mean=1e-6, std=1e-7, n=3.0)
                ),
            )
        ),
        {"particles.0.areal_density": (1e5, 1e9)},
    ),
}


def drawn(more, count, seed, usual=USUAL):
    """Inputs of so many states, and F*."""
    rng = np.random.default_rng(seed)
    ends = {**usual, **more}
    vary = {
        name: np.exp(rng.uniform(math.log(low), math.log(high), count))
        for name, (low, high) in ends.items()
    }
    return vary, np.exp(rng.uniform(math.log(1e-7), math.log(1e-3), count))


def by_numpy(case, loads, vary, load="F_star"):
    with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
        return state_columns(case, vary=vary, **{load: loads})


def errors(got, want, sigma):
    """The largest error of each state."""
    found = [np.abs(got["d"] - want["d"]) / sigma, np.abs(got["shadow"] - want["shadow"])]
    for name in ("F_sa_star", "F_ss_star"):
        found.append(np.abs(got[name] - want[name]) / want["F_star"])
    for name in ("A_t", "A_sa", "A_ss", "A_sa2", "A_e", "A_ep", "A_p"):
        found.append(np.abs(got[name] - want[name]) / want["A_t"])
    return np.max(found, axis=0)


@pytest.mark.parametrize("name", [*CASES, *SEVERAL])
def test_states_hold_to_tables_of_each(name):
    several = name in SEVERAL
    case, more = SEVERAL[name] if several else CASES[name]
    vary, loads = drawn(more, 4, 1, ROUGH if several else USUAL)
    got, want = own_columns(case, vary, "F_star", loads), by_numpy(case, loads, vary)
    known = got["doubt"] == ""
    assert known.mean() > (0.5 if several else 0.7)
    assert np.all(got["status"][known] == 0)
    assert set(want["status_code"][known]) <= {0}
    off = errors(got, want, vary["roughness.sigma"])[known]
    assert off.max() <= BOUND
    assert np.all(off <= got["error"][known])
    assert np.all(got["error"][known] <= BOUND)
    assert np.all(got["residual"][known] <= 1e-11)


def test_a_fixed_bandwidth_of_any_size():
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6, alpha=20.0)
    case, (vary, loads) = contact().replace(roughness=rough), drawn({}, 10, 3)
    del vary["roughness.R"]
    got, want = own_columns(case, vary, "F_star", loads), by_numpy(case, loads, vary)
    known = got["doubt"] == ""
    assert known.mean() > 0.7
    off = errors(got, want, vary["roughness.sigma"])[known]
    assert np.all(off <= got["error"][known])


def test_at_given_separations():
    case, (vary, _) = contact(), drawn({}, 10, 4)
    d = vary["roughness.sigma"] * np.linspace(0.5, 5.0, 10)
    got, want = own_columns(case, vary, "d", d), by_numpy(case, d, vary, "d")
    known = (got["doubt"] == "") & (want["status_code"] == 0)
    assert known.mean() > 0.7
    for name in ("F_sa_star", "F_ss_star"):
        assert np.max(np.abs(got[name] / want[name] - 1)[known]) <= 3 * BOUND
    assert np.max(np.abs(got["A_t"] / want["A_t"] - 1)[known]) <= 3 * BOUND


NUMBERS = ("d", "F_ss_star", "F_sa_star", "A_t", "A_e", "A_p", "A_sa", "A_sa2", "shadow")


def same(found, other, bound):
    """Hold two sets of states to each other where both are known: most of them."""
    known = (found["doubt"] == "") & (other["doubt"] == "")
    assert known.mean() > 0.7
    for name in NUMBERS:
        np.testing.assert_allclose(found[name][known], other[name][known], bound, 1e-300)


def test_two_equal_halves_are_one_population():
    vary, loads = drawn({}, 20, 7, ROUGH)
    half = HARD.replace(areal_density=0.5 * HARD.areal_density)
    whole = own_columns(contact(), vary, "F_star", loads)
    same(own_columns(contact((half, half)), vary, "F_star", loads), whole, 1e-10)


def test_next_to_nothing_changes_nothing():
    vary, loads = drawn({}, 20, 8, ROUGH)
    few = UNIFORM.replace(areal_density=1e-3)
    alone = own_columns(contact(), vary, "F_star", loads)
    same(own_columns(contact((few, HARD)), vary, "F_star", loads), alone, 1e-9)


@pytest.mark.parametrize("size", [0.2e-6, 6e-6])
def test_none_of_another_size_change_nothing(size):
    """Nodes over heights begin where a particle is squeezed, not where none is."""
    vary, loads = drawn({}, 20, 8, ROUGH)
    none = UNIFORM.replace(
        areal_density=0.0, diameter=tb.distributions.Uniform(low=size, high=2 * size)
    )
    alone = own_columns(contact(), vary, "F_star", loads)
    same(own_columns(contact((none, HARD)), vary, "F_star", loads), alone, 1e-11)


def test_one_power_law_in_two_populations_is_the_same():
    """Sizes that set in at another place than the largest change nothing in the sums over heights."""
    vary, loads = drawn({}, 12, 11, ROUGH)
    edges, counts, slopes = (20e-9, 90e-9, 300e-9), (1e4, 150.0), (4.0, 4.0)
    both = HARD.replace(
        diameter=tb.distributions.PowerLaw(edges=edges, counts=counts, slopes=slopes)
    )
    one, two = (
        HARD.replace(
            areal_density=HARD.areal_density * counts[k] / sum(counts),
            diameter=tb.distributions.PowerLaw(
                edges=edges[k : k + 2], counts=counts[k : k + 1], slopes=slopes[k : k + 1]
            ),
        )
        for k in range(2)
    )
    whole = own_columns(contact(both), vary, "F_star", loads)
    parts = own_columns(contact((one, two)), vary, "F_star", loads)
    # each population has splines of its own between the rows
    assert errors(parts, whole, vary["roughness.sigma"]).max() < 2e-6


def test_populations_in_any_order():
    case, _ = SEVERAL["three kinds of sizes"]
    vary, loads = drawn({}, 20, 9, ROUGH)
    found = own_columns(case, vary, "F_star", loads)
    turned = case.replace(particles=case.particles[::-1])
    same(own_columns(turned, vary, "F_star", loads), found, 1e-9)


def test_each_population_shades_by_its_own_rule():
    """The ground under all of them too: NumPy and the kernel add what each takes."""
    parts = (
        HARD.replace(law=tb.particle.Series(seat="rough", shadow="none")),
        SOFT.replace(areal_density=2e11, law=tb.particle.Series(seat="rough")),
        HARD.replace(areal_density=2e10, law=COVERED),
    )
    vary, _ = drawn({}, 2, 10, ROUGH)
    loads = np.geomspace(1e-7, 3e-5, 4)[1:3]
    for some, count in ((parts, 2), (parts[::-1], 1)):
        few = {name: values[:count] for name, values in vary.items()}
        got = own_columns(contact(some), few, "F_star", loads[:count])
        known = got["doubt"] == ""
        assert known.mean() > 0.5
        off = errors(got, by_numpy(contact(some), loads[:count], few), few["roughness.sigma"])
        assert off[known].max() <= BOUND


def test_few_states_of_large_particles_go_to_the_kernel():
    vary = {"roughness.sigma": np.array([2e-7, 3e-7, 5e-8, 2.5e-7])}
    large = HARD.replace(
        areal_density=1e8, diameter=tb.TruncatedGaussian(mean=8e-6, std=8e-7, n=3.0)
    )
    found = state_columns(contact(large), F_star=1e-6, vary=vary)
    assert found["engine"].tolist() == ["compiled"] * 4
    assert set(found["status"]) == {"ok"}
    want = by_numpy(contact(large), np.full(4, 1e-6), vary)
    assert np.max(errors(found, want, np.full(4, 100e-9))) <= BOUND


def test_bandwidths_beyond_the_series_have_their_own():
    case, (vary, loads) = contact((HARD, SOFT)), drawn({}, 5, 11, ROUGH)
    vary["roughness.alpha"] = np.array([8.41, 12.0, 2.5, 29.9, 8.39])
    got, want = own_columns(case, vary, "F_star", loads), by_numpy(case, loads, vary)
    known = got["doubt"] == ""
    assert known.mean() > 0.5
    off = errors(got, want, vary["roughness.sigma"])[known]
    assert off.max() <= BOUND
    alone = own_columns(case, {k: v[[3]] for k, v in vary.items()}, "F_star", loads[[3]])
    assert alone["d"][0] == got["d"][3]


def test_a_bandwidth_without_a_table_leaves_the_other_states_to_the_kernel():
    case, loads = contact(), np.full(3, 1e-6)
    found = own_columns(case, {"roughness.alpha": np.array([5.0, 31.0, 8.0])}, "F_star", loads)
    assert found["doubt"].tolist() == ["", NO_TABLE, ""]
    inside = own_columns(case, {"roughness.alpha": np.array([5.0, 8.0])}, "F_star", loads[:2])
    np.testing.assert_array_equal(found["d"][[0, 2]], inside["d"])
    with pytest.raises(tb.errors.InvalidValue) as error:  # the law itself is not known there
        state_columns(case, F_star=loads, vary={"roughness.alpha": np.array([5.0, 31.0, 8.0])})
    assert [each.code for each in error.value.problems] == [tb.errors.Mistake.BEYOND]


def test_flakes_squeezed_beyond_their_size_say_so():
    case, vary = contact(law=tb.particle.Flakes(aspect=8.0)), {"roughness.sigma": np.full(1, 1e-7)}
    found = own_columns(case, vary, "F_star", np.full(1, 1e-5))
    assert found["doubt"].tolist() == [SQUEEZED]


@pytest.mark.parametrize("name", ["hard", "two different sides", "classes of sizes and squashed"])
def test_alone_among_others_and_in_any_order(name):
    case, more = CASES[name] if name in CASES else SEVERAL[name]
    vary, loads = drawn(more, 30, 5, USUAL if name in CASES else ROUGH)
    together = own_columns(case, vary, "F_star", loads)
    order = np.random.default_rng(0).permutation(30)
    turned = own_columns(case, {k: v[order] for k, v in vary.items()}, "F_star", loads[order])
    for column in ("d", "A_t", "A_p", "F_sa_star", "shadow", "error"):
        np.testing.assert_array_equal(turned[column], np.asarray(together[column])[order])
        alone = own_columns(case, {k: v[[7]] for k, v in vary.items()}, "F_star", loads[[7]])
        np.testing.assert_array_equal(alone[column][0], together[column][7])


def test_what_is_not_resolved_is_solved_by_tables_and_says_so():
    case, (vary, loads) = contact(), drawn({}, 25, 6)
    strict = grounded.EXACT.copy()
    strict[grounded.WORST] = np.median(own_columns(case, vary, "F_star", loads)["error"])
    with mock.patch.object(grounded, "EXACT", strict):
        found = state_columns(case, F_star=loads, vary=vary)
    again = np.array([str(each) == f"numpy: {NOT_RESOLVED}" for each in found["engine"]])
    assert 0 < again.sum() < 25
    assert set(found["engine"][~again]) == {"compiled"}
    assert set(found["status"]) == {"ok"}
    want = by_numpy(case, loads[again], {name: values[again] for name, values in vary.items()})
    np.testing.assert_array_equal(found["d"][again], want["d"])


def test_what_the_kernel_does_not_know_is_left_to_tables():
    case = contact()
    high = case.replace(roughness=case.roughness.replace(alpha=20.0))
    own = case.replace(asperity_law=tb.asperity.Field(spectrum=RollOff(corner="sharp")))
    assert states.solves_each(case, ["roughness.sigma", "roughness.alpha"])
    assert states.solves_each(high, ["roughness.sigma"])
    assert states.solves_each(high, ["roughness.alpha"])
    assert not states.solves_each(own, ["roughness.sigma"])
    assert states.solves_each(contact((HARD, SOFT)), ["roughness.sigma"])
    strength = tb.grains.WeibullStrength(
        sigma_0=67e6, x_0=1e-3, m=3.0, size_exponent=0.55, x_c=50e-9
    )
    brittle = contact((SOFT, HARD.replace(strength=strength)))
    assert not states.solves_each(brittle, ["roughness.sigma"])


@pytest.mark.parametrize("alpha", [2.8, 5.0, 7.9])
def test_displacements_are_the_integrals_over_distances(alpha):
    spectrum = rolled_off(alpha)
    tau = np.array([0.0, 0.2, 0.55, 1.0])
    basis = np.polynomial.chebyshev.chebvander(2 * tau - 1, grounds.TERMS - 1)
    for apart in (0.07, 0.5, 1.93, 4.4):
        own, _ = spectrum.integrals_from(apart, tau, MOMENTS)
        _, under = spectrum.integrals_from(0.5 * apart, tau, MOMENTS)
        _, all_over = spectrum.integrals_from(0.0, tau, MOMENTS)
        for varies in (False, True):
            given = np.array([alpha]) if varies else alpha
            found = grounds.displacements_of(given, np.array([apart]), varies)
            numbers = found.basis[0] @ found.series[found.which[0]]
            bound = 1e-12 + 2 * found.tails[0]
            count = MOMENTS + 1
            series = numbers[count:].reshape(2, grounds.TERMS, count)
            assert np.max(np.abs(numbers[:count] - own)) <= bound
            # the tables themselves have so many terms over τ
            assert np.max(np.abs(basis @ series[0] - under)) <= bound + 1e-7
            assert np.max(np.abs(basis @ series[1] - all_over)) <= bound + 1e-7


@pytest.mark.parametrize("name", ["hard", "two different sides", "hard and squashed"])
def test_samples_hold_to_states_solved_by_themselves(name):
    """Separations of one contact side by side, descending and not, share what is found."""
    case, more = SEVERAL[name] if name in SEVERAL else CASES[name]
    vary, _ = drawn(more, 12, 5, ROUGH if name in SEVERAL else USUAL)
    heights = np.array([4.0, 2.6, 1.9, 0.7, 3.1, 1.9])
    d = (vary["roughness.sigma"][:, None] * heights).ravel()
    each = {key: np.repeat(values, len(heights)) for key, values in vary.items()}
    want = own_columns(case, each, "d", d)
    with roughly():
        got, again = own_columns(case, each, "d", d), own_columns(case, each, "d", d)
    solved = (got["doubt"] == "") & (want["doubt"] == "")
    assert solved.mean() > 0.7
    off = errors(got, want, each["roughness.sigma"])[solved]
    assert 0 < off.max() <= 1e-6
    assert np.all(off <= got["error"][solved])
    for column in NUMBERS:
        np.testing.assert_array_equal(got[column], again[column])


def test_samples_of_a_load_hold_to_states_solved_by_themselves():
    case, more = SEVERAL["three kinds of sizes"]
    vary, loads = drawn({"roughness.alpha": (2.51, 29.9), **more}, 30, 6, ROUGH)
    want = own_columns(case, vary, "F_star", loads)
    with roughly():
        got = own_columns(case, vary, "F_star", loads)
    solved = (got["doubt"] == "") & (want["doubt"] == "")
    assert solved.mean() > 0.5
    off = errors(got, want, vary["roughness.sigma"])[solved]
    assert off.max() <= 1e-6
    assert np.all(off <= got["error"][solved])


@pytest.mark.parametrize("particles", [HARD, None])
def test_below_the_table_of_the_law_and_above_what_it_carries(particles):
    """Its border is that of NumPy, to 1e-9 of σ, and to 1e-2 of the load."""
    case = contact(particles).replace(
        surfaces=tb.MaterialPair(STEEL.replace(H=8e9), STEEL.replace(H=8e9))
    )
    lowest = interface(case).lowest
    sigma = case.roughness.sigma
    d = lowest + sigma * np.array([-1.0, -1e-3, -1e-9, 1e-9, 1e-3, 1.0])
    vary = {"roughness.R": np.full(len(d), case.roughness.R)}
    got, want = own_columns(case, vary, "d", d), by_numpy(case, d, vary, "d")
    assert want["status_code"].tolist() == [Status.TOO_DEEP] * 3 + [Status.OK] * 3
    sure = got["doubt"] == ""
    assert np.all(sure[:3])
    np.testing.assert_array_equal(got["status"][sure], want["status_code"][sure])
    most = float(want["F_star"][3])
    loads = most * np.array([0.5, 0.99, 1.01, 2.0])
    vary = {"roughness.R": np.full(len(loads), case.roughness.R)}
    got, want = own_columns(case, vary, "F_star", loads), by_numpy(case, loads, vary)
    assert want["status_code"].tolist() == [Status.OK] * 2 + [Status.TOO_MUCH] * 2
    sure = got["doubt"] == ""
    np.testing.assert_array_equal(got["status"][sure], want["status_code"][sure])
    assert sure[-1] or particles is None


def contact_at_random(rng):
    """A contact of one field of heights with one to three kinds of particles between."""

    def spread(low, high):
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    sigma = spread(30e-9, 1e-6)
    steel = STEEL.replace(H=spread(1e9, 12e9), E=spread(8e10, 3e11))
    particles = []
    for _ in range(rng.integers(1, 4)):
        mean, width = sigma * spread(0.3, 20), spread(0.02, 0.3)
        sizes = [
            tb.Monodisperse(mean=mean),
            tb.TruncatedGaussian(mean=mean, std=width * mean, n=3.0),
            tb.LogNormal(median=mean, gsd=math.exp(width)),
            tb.Uniform(low=mean * (1 - 1.5 * width), high=mean * (1 + 1.5 * width)),
        ]
        hard = SILICA if rng.random() < 0.5 else STEEL.replace(H=spread(5e8, 12e9))
        density = spread(1e-4, 0.2) / mean**2
        size = sizes[rng.integers(0, 4)]
        particles.append(tb.Particles(material=hard, areal_density=density, diameter=size))
    shadow = ("footprint", "projected", "covered", "none")[rng.integers(0, 4)]
    return tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=sigma, R=spread(1e-6, 80e-6), alpha=spread(2.5, 30)),
        asperity_law=tb.asperity.Field(),
        particles=tuple(particles),
        particle_law=tb.particle.Series(seat="rough", shadow=shadow),
    )


@pytest.mark.check
@pytest.mark.parametrize(("seed", "dear"), [(1, (0, 2)), (2, ())])
def test_contacts_at_random_hold_to_tables(seed, dear):
    """Crowded, soft, wide, of any bandwidth: what the engine says it knows it knows.

    Dear ones are left out: their tables take seconds, and of the first the engine knows nothing.
    """
    rng, states_known, of = np.random.default_rng(seed), 0, 0
    for index in range(8):
        case = contact_at_random(rng)
        loads = np.exp(rng.uniform(math.log(1e-8), math.log(1e-2), 15))
        if index in dear:
            continue
        got, want = own_columns(case, {}, "F_star", loads), by_numpy(case, loads, {})
        known = (got["doubt"] == "") & (got["status"] == 0) & (want["status_code"] == 0)
        states_known, of = states_known + known.sum(), of + (want["status_code"] == 0).sum()
        # tables carry a load to 1e-9 of it; where it hardly changes d may be anywhere
        off = errors(got, {**want, "d": got["d"]}, case.roughness.sigma)[known]
        assert np.all(off <= np.maximum(got["error"][known], BOUND))
    assert states_known > 0.7 * of
