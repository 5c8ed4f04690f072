"""Dents of a solved contact, against explicit random particles and the single-particle law."""

import math
import runpy
import warnings
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.effects import Dents
from thirdbody.effects.curves import Curve
from thirdbody.effects.single import dent as one_dent
from thirdbody.errors import code_of, note_of
from thirdbody.laws.particle import Series
from thirdbody.laws.particle import one_particle as co
from thirdbody.laws.particle.squashed import widest_disc
from thirdbody.systems import oil_particles

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SOFT = STEEL.replace(H=2.5e9)
ROUGH = tb.Roughness(sigma=100e-9, R=2.8e-6)
SIZES = tb.TruncatedGaussian(mean=500e-9, std=100e-9)
NAMES = [name[:-2] for name in Dents.columns if name.endswith("_1")]


def contact(first=STEEL, second=SOFT, *, dents=None, law=None, material=SILICA, density=1e10):
    dust = tb.Particles(material=material, areal_density=density, diameter=SIZES)
    return tb.Contact(
        surfaces=tb.MaterialPair(first, second),
        roughness=ROUGH,
        particles=dust,
        particle_law=law or Series(deep="off"),
        outputs=dents or Dents(),
    )


def left(pressure=5e6, **options):
    return tb.solve(contact(**options), pressure=pressure).outputs


@pytest.fixture(scope="module")
def thrown():
    """A million explicit particles on random places of the rough surface, and their dents."""
    system = contact()
    state = tb.solve(system, pressure=5e6)
    rng = np.random.default_rng(7)
    n = 1_000_000
    gap = float(state.d) + ROUGH.y_s - ROUGH.sigma * rng.standard_normal(n)
    x = SIZES.sample(rng, n)
    spots = co.squeezed_particle(
        Series(deep="off").law, *co.contact_sides(system.surfaces, SILICA), 0.5
    ).spots(
        x[:, None],
        np.maximum(x - gap, 0.0)[:, None],
        share=None,
        number=np.ones((n, 1)),
    )
    return state.outputs, spots, n


@pytest.mark.parametrize("H", [1e9, 3e9, 8e9])
def test_number_of_dents_is_that_of_particles_large_enough(H):
    """On a plane: those larger than g/(1 − ε), with ε at which a dent begins, side by side."""
    steel, law = tb.Material(E=208e9, nu=0.3, H=6e9), Series(seat="plane")
    surfaces, body = tb.MaterialPair(steel, steel.replace(H=5e9)), steel.replace(H=H)
    system = contact(*(surfaces.first, surfaces.second), law=law, material=body)
    gaps = np.array([4.5e-9, 100e-9, 400e-9, 600e-9])
    found = tb.solve(system, d=gaps).outputs
    for side in (0, 1):

        def depth(eps, side=side):
            spots = law.probe(np.array([eps]), surfaces=surfaces, particle=body)
            return one_dent.dent_of(spots, side=side, particle=body).depth[0, 0]

        low, high = 1e-6, 1.0
        if depth(high) == 0:
            np.testing.assert_array_equal(found[f"n_dents_{side + 1}"], 0)
            continue
        for _ in range(60):
            middle = math.sqrt(low * high)
            low, high = (low, middle) if depth(middle) > 0 else (middle, high)
        large = [float(SIZES.partial_moment(0, gap / (1 - high), 1.0)) for gap in gaps]
        wanted = pytest.approx(1e10 * np.array(large), rel=1e-9, abs=1e-3)
        assert found[f"n_dents_{side + 1}"] == wanted


@pytest.mark.parametrize("side", [1, 2])
def test_against_explicit_particles(thrown, side):
    found, spots, n = thrown
    dent = one_dent.dent_of(spots, side=side - 1, particle=SILICA)
    there = (dent.depth > 0).ravel()
    depth, width = dent.depth.ravel()[there], dent.diameter.ravel()[there]
    assert found[f"n_dents_{side}"] == pytest.approx(1e10 * there.mean(), rel=3e-3)
    assert found[f"dent_depth_{side}"] == pytest.approx(depth.mean(), rel=4e-3)
    assert found[f"dent_width_{side}"] == pytest.approx(width.mean(), rel=4e-3)
    assert found[f"dent_volume_{side}"] == pytest.approx(1e10 * dent.volume.sum() / n, rel=6e-3)
    assert found[f"dent_depth_p95_{side}"] == pytest.approx(np.quantile(depth, 0.95), rel=0.02)
    assert found[f"dent_width_p95_{side}"] == pytest.approx(np.quantile(width, 0.95), rel=0.02)
    # the deepest of 1 mm² among 10⁴: one in 14 427
    rare = 1 - math.log(2) / (1e4 * there.mean())
    assert found[f"dent_depth_max_{side}"] == pytest.approx(np.quantile(depth, rare), rel=0.03)


def test_surfaces_swap():
    one, two = left(), left(first=SOFT, second=STEEL)
    for name in NAMES:
        assert one[f"{name}_1"] == pytest.approx(two[f"{name}_2"], rel=1e-6), name
        assert one[f"{name}_2"] == pytest.approx(two[f"{name}_1"], rel=1e-6), name


def test_no_dents():
    """Without particles there are none, and nothing is as deep as 0."""
    none = left(density=0.0)
    assert none["n_dents_1"] == none["dent_volume_2"] == none["embedded_1"] == 0
    for name in ("dent_depth", "dent_depth_p95", "dent_depth_max", "dent_width_max"):
        assert math.isnan(none[f"{name}_1"])


UNKNOWN = ("dent_depth", "dent_depth_p95", "dent_depth_max", "dent_volume", "embedded")


@pytest.mark.parametrize("ratio", [1.0, 0.999, 0.5])
def test_particles_that_are_not_harder_leave_marks_of_unknown_depth(ratio):
    """Debris of the surfaces' own steel: counted, with its footprints, and a reason; never 0."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = left(second=STEEL, material=STEEL.replace(H=ratio * STEEL.H))
    for side in (1, 2):
        assert found[f"n_dents_{side}"] > 0
        assert found[f"dent_width_{side}"] > 0
        assert all(math.isnan(found[f"{name}_{side}"]) for name in UNKNOWN)
    codes = [code_of(note_of(each.message)) for each in heard]
    told = [code for code in codes if code.startswith("dents.flat.")]
    assert len(told) == 1


def test_only_the_softer_surface():
    """Between a harder and a softer surface: dents in one, marks of unknown depth in the other."""
    found = left(material=SILICA.replace(H=4e9))
    assert found["dent_depth_2"] > 0 < found["dent_volume_2"]
    assert found["n_dents_1"] > 0
    assert math.isnan(found["dent_depth_1"])


def test_what_the_user_says_goes_before_hardness():
    """Work-hardened debris of equal hardness that keeps its shape; its law must not squash it."""
    hard = left(second=STEEL, material=STEEL, dents=Dents(debris="hard"))
    assert hard["dent_depth_1"] > 0 < hard["dent_volume_1"]
    with refuses(Mistake.CLASH, "outputs.dents", says="'hard'"):
        contact(material=STEEL.replace(H=1e9), dents=Dents(debris="hard"))
    silica = left(), left(dents=Dents(debris="hard"))
    for name in Dents.columns:  # a harder particle is hard
        assert silica[0][name] == silica[1][name], name


def test_one_function_decides():
    assert one_dent.sink(SILICA, hardness=STEEL.H) == 1
    for debris in ("by_hardness", "brittle", "ductile"):
        assert math.isnan(one_dent.sink(STEEL, hardness=STEEL.H, debris=debris))
    assert math.isnan(one_dent.sink(SILICA, hardness=STEEL.H, debris="ductile"))
    assert one_dent.sink(STEEL, hardness=STEEL.H, debris="hard") == 1


def test_dents_by_population():
    """Dust dents, debris does not: each has its own, numbers and widths add to those of both."""
    dust = tb.Particles(material=SILICA, areal_density=1e10, diameter=SIZES, name="dust")
    debris = tb.Particles(material=STEEL, areal_density=5e9, diameter=SIZES, name="debris")
    both = contact(second=STEEL).replace(particles=(dust, debris))
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        state = tb.solve(both, d=150e-9)
    assert "dents.flat.debris" in [code_of(note_of(each.message)) for each in heard]
    alone = tb.solve(contact(second=STEEL), d=150e-9).outputs
    one, two = (part.outputs for part in state.populations)
    for name in Dents.columns:
        assert one[name] == pytest.approx(alone[name], rel=1e-9), name
    assert math.isnan(two["dent_depth_1"])
    assert two["dent_width_1"] > 0
    total = state.outputs
    assert total["n_dents_1"] == pytest.approx(one["n_dents_1"] + two["n_dents_1"], rel=1e-12)
    wide = one["n_dents_1"] * one["dent_width_1"] + two["n_dents_1"] * two["dent_width_1"]
    assert total["n_dents_1"] * total["dent_width_1"] == pytest.approx(wide, rel=1e-12)
    # depths are those that are known; a volume with a part unknown is not
    assert total["dent_depth_1"] == pytest.approx(one["dent_depth_1"], rel=1e-12)
    assert math.isnan(total["dent_volume_1"])
    assert state.populations[0].outputs.keys() == Dents.columns.keys()


def test_marks_of_unknown_depth_are_not_counted_from_a_depth_on():
    """Whether they are so deep is not known either."""
    found = left(second=STEEL, material=STEEL, dents=Dents(shallowest=1e-9))
    assert math.isnan(found["n_dents_1"])


def test_the_template_with_steel_debris_tells(tmp_path):
    """The shipped study of a roller bearing with the output: marks, and why no depth."""
    from importlib import resources

    from thirdbody.study import load_study, run_study

    text = resources.files("thirdbody").joinpath("data/studies/rolling-bearing.toml").read_text()
    file = tmp_path / "study.toml"
    file.write_text(text + '\n[particle_law]\nname = "series"\ndeep = "off"\n\n[outputs.dents]\n')
    found = run_study(load_study(file))
    assert all(n is None or n > 0 for n in found["states"]["n_dents_1"])
    assert any(n for n in found["states"]["n_dents_1"])
    assert set(found["states"]["dent_depth_1"]) == {None}
    assert any(code_of(text).startswith("dents.flat.") for text in found["warnings"])


def test_dents_add_with_their_number():
    """At one separation, twice the particles leave twice the dents."""
    one = tb.solve(contact(density=1e9), d=150e-9).outputs
    two = tb.solve(contact(density=2e9), d=150e-9).outputs
    for name in ("n_dents_1", "dent_volume_2", "embedded_2"):
        assert two[name] == pytest.approx(2 * one[name], rel=1e-12)
    assert two["dent_depth_1"] == pytest.approx(one["dent_depth_1"], rel=1e-12)
    assert two["dent_depth_p95_2"] == pytest.approx(one["dent_depth_p95_2"], rel=1e-9)
    assert two["dent_depth_max_2"] > one["dent_depth_max_2"] > one["dent_depth_p95_2"]


def test_shallow_dents_can_be_left_out():
    every, deep = left(), left(dents=Dents(shallowest=100e-9))
    assert deep["n_dents_2"] < every["n_dents_2"]
    assert deep["dent_depth_2"] > max(100e-9, every["dent_depth_2"])
    assert deep["dent_depth_max_2"] == pytest.approx(every["dent_depth_max_2"], rel=1e-9)


def test_brittle():
    """Fragments larger than every particle change nothing; fine ones pass the gap."""
    whole, same = left(), left(dents=Dents(debris="brittle", fragment=1e-3))
    for name in Dents.columns:
        assert whole[name] == pytest.approx(same[name], rel=1e-12), name
    fine = left(dents=Dents(debris="brittle", fragment=300e-9))
    assert fine["dent_depth_max_2"] < whole["dent_depth_max_2"]
    gone = left(dents=Dents(debris="brittle", fragment=1e-9))
    assert gone["dent_volume_2"] < 1e-2 * whole["dent_volume_2"]


def test_ductile():
    flat = left(dents=Dents(debris="ductile"))
    assert all(math.isnan(flat[f"{name}_1"]) for name in UNKNOWN)
    assert flat["dent_width_1"] == flat["dent_width_2"] > 500e-9


def test_ductile_particles_are_as_wide_as_they_are_squashed():
    """From a third of their height on, discs of the volume in the gap."""
    x, debris = 500e-9, tb.Material(E=193e9, nu=0.29, H=1e9)
    dust = tb.Particles(
        material=debris, areal_density=1e10, diameter=tb.distributions.Monodisperse(mean=x)
    )
    pair = tb.MaterialPair(STEEL, STEEL)
    one = tb.Contact(surfaces=pair, roughness=tb.Roughness(sigma=20e-9, R=2.8e-6), particles=dust,
                     particle_law=Series(deep="off", seat="plane"), outputs=Dents(debris="ductile"))  # fmt: skip
    gaps = np.array([0.9, 0.6, 0.3]) * x
    wide = tb.solve(one, d=gaps).outputs["dent_width_1"]
    assert wide[1:] == pytest.approx(one_dent.flattened_diameter(x, gap=gaps[1:]), rel=1e-9)
    area = Series(deep="off").single(x, gaps, surfaces=pair, particle=debris)["area_1"]
    assert wide == pytest.approx(2 * np.sqrt(area / math.pi), rel=1e-9)
    assert wide[0] < x


@pytest.mark.spread(2)
@pytest.mark.parametrize("deep", ["off", "table"])
def test_a_film_is_a_contact_with_a_plane_seat(deep):
    """The single-particle route and the contact agree where the gap is one height."""
    law = Series(deep=deep, seat="plane")
    h = 300e-9
    tight = 1e-7 if deep == "off" else 1e-4  # sums do not stop at the squeezes of the table
    found = tb.solve(contact(law=law), d=h).outputs
    film = oil_particles.FilmParticles(
        surfaces=tb.MaterialPair(STEEL, SOFT), material=SILICA, diameter=SIZES,
        number=1e10 / h, film=h, entry=1.0, deep=deep,
    )  # fmt: skip
    for side in (1, 2):
        dents = film.dents(side)
        assert found[f"n_dents_{side}"] == pytest.approx(dents.number, rel=tight)
        assert found[f"dent_depth_{side}"] == pytest.approx(dents.depth, rel=tight)
        assert found[f"dent_width_{side}"] == pytest.approx(dents.diameter, rel=tight)
        assert found[f"dent_volume_{side}"] == pytest.approx(dents.volume, rel=tight)
        assert found[f"dent_depth_p95_{side}"] == pytest.approx(dents.depth_p95, rel=0.02)
        assert found[f"embedded_{side}"] == pytest.approx(
            dents.number * dents.embedded, rel=1e-6 if deep == "off" else 1e-4
        )


def test_refusals():
    with refuses(Mistake.MISSING, "Dents.fragment", value="None"):
        Dents(debris="brittle")
    with refuses(Mistake.MISSING, "Dents.fragment", value="1e-06"):
        Dents(fragment=1e-6)
    with refuses(Mistake.BEYOND, "outputs.dents", says="particle.Series"):
        contact(dents=Dents(debris="brittle", fragment=1e-7), law=tb.particle.Flakes(aspect=2.0))


def test_dents_lost_in_rounding_are_refused():
    """A surface 1e45 times softer than its partner: what it leaves of a squeeze is rounding."""
    ductile = contact(
        STEEL.replace(E=6e-35),
        STEEL,
        material=STEEL.replace(H=1.36e9),
        dents=Dents(debris="ductile"),
        law=Series(),
    )
    with refuses(Mistake.BEYOND, "outputs.dents", says="surface 2"):
        tb.solve(ductile, d=1.0)


def test_example(tmp_path, monkeypatch):
    """The worked example runs and its number holds."""
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(Path(__file__).parents[2] / "examples" / "ball_screw_dents.py"))
    assert (tmp_path / "ball_screw_dents.png").exists()


# ---------------------------------------------------------------- few dents
@pytest.mark.parametrize("density", [1e9, 1e7, 1e6, 1e5, 1e3])
def test_the_deepest_of_few_dents_is_no_shallower_than_the_mean(density):
    """And where fewer than 14 lie in the area, a sentence says so; of less than one it is NaN."""
    case = contact(density=density)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        state = tb.solve(case, pressure=5e6)
    found = state.outputs
    for side in (1, 2):
        n = found[f"n_dents_{side}"] * 1e-6
        assert math.isnan(found[f"dent_depth_max_{side}"]) == (n < 1)
        if n > math.log(2) / 0.05:  # else the deepest is no rarer than one in 20, and this is said
            assert found[f"dent_depth_max_{side}"] >= found[f"dent_depth_p95_{side}"]
        if n >= 1:
            assert found[f"dent_depth_max_{side}"] >= found[f"dent_depth_{side}"]
            assert found[f"dent_width_max_{side}"] >= found[f"dent_width_{side}"]
    few = min(n for n in (found["n_dents_1"], found["n_dents_2"]) if n > 0) * 1e-6
    told = [text for text in state.warnings if code_of(text) == "dents.few"]
    assert bool(told) == (few < 14)


@pytest.mark.parametrize("debris", ["by_hardness", "ductile"])
def test_no_mark_is_wider_than_the_surface_bears(debris):
    """Balls of the surfaces' own steel between touching peaks: the disc sinks in, and is told."""
    x = 300e-9
    dust = tb.Particles(
        material=STEEL, areal_density=1e11, diameter=tb.distributions.Monodisperse(mean=x)
    )
    one = tb.Contact(surfaces=tb.MaterialPair(STEEL, STEEL), particles=dust,
                     particle_law=Series(deep="off"), outputs=Dents(debris=debris),
                     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))  # fmt: skip
    state = tb.solve(one, pressure=5e6)
    widest = widest_disc(STEEL.H, STEEL.H) * x
    for side in (1, 2):
        found = state.outputs[f"dent_width_max_{side}"]
        assert widest * 0.99 < found <= widest * (1 + 1e-9)
        assert state.outputs[f"dent_width_{side}"] < found
    (told,) = [text for text in state.warnings if code_of(text) == "dents.wide"]
    assert " 3.17 times" in told
    (why,) = [text for text in state.warnings if code_of(text).startswith("dents.flat.")]
    assert ("debris = 'ductile' says" in why) == (debris == "ductile")


# ---------------------------------------------------------------- exact quantiles of one size
@pytest.mark.parametrize(("x", "h"), [(417e-9, 653e-9), (250e-9, 400e-9), (800e-9, 500e-9)])
def test_percentile_and_deepest_of_one_size_are_exact(x, h):
    """Particles of one size: those deeper than δ lie where the seat is high enough, Q(z)."""
    from scipy.stats import norm

    from thirdbody.effects.single.ploughing import residual_depth

    dust = tb.Particles(
        material=SILICA, areal_density=1e11, diameter=tb.distributions.Monodisperse(mean=x)
    )
    case = contact(second=STEEL).replace(particles=dust)
    first = co.squeezed_particle(
        Series().law, *co.contact_sides(case.surfaces, SILICA), 0.5
    ).yields[0] * x  # fmt: skip

    def depth(delta):
        """Left by a particle squeezed by δ, half of it into either of two equal surfaces."""
        return float(residual_depth(np.array(delta / 2), depth_over_yield=delta / 2 / first))

    def exact(count):
        delta = x - h + ROUGH.sigma * float(norm.isf(count / 1e11))
        return depth(delta)

    n = 1e11 * norm.sf((h - x + 2 * first) / ROUGH.sigma)
    area = 40 / n
    shallow = exact(0.3 * n)
    for shallowest, every in ((0.0, n), (shallow, 0.3 * n)):
        dents = Dents(A_n=area, shallowest=shallowest)
        found = tb.solve(case.replace(outputs=dents), d=h - ROUGH.y_s).outputs
        assert found["n_dents_1"] == pytest.approx(every, rel=1e-9 if shallowest == 0 else 2e-3)
        assert found["dent_depth_p95_1"] == pytest.approx(exact(0.05 * every), rel=2e-3)
        rare = math.log(2 / (1 + math.exp(-every * area))) / area
        assert found["dent_depth_max_1"] == pytest.approx(exact(rare), rel=2e-3)


@pytest.mark.parametrize("seat", ["asperity", "plane"])
def test_percentile_of_sizes_is_that_of_their_integral(seat):
    """Lognormal sizes: half a million places by Sobol numbers, the rarest 2 % among them."""
    from scipy.stats import norm, qmc

    from thirdbody.effects.curves import Curve
    from thirdbody.effects.quantiles import Values, exceeded_values

    sizes = tb.LogNormal(median=300e-9, gsd=1.4)
    dust = tb.Particles(material=SILICA, areal_density=1e10, diameter=sizes)
    law = Series() if seat == "asperity" else Series(seat="plane")
    case = contact(law=law).replace(particles=dust, outputs=())
    state = tb.solve(case, d=300e-9)
    from thirdbody.contact.interface import interface

    (spots,) = interface(case).populations[0].spots(np.atleast_1d(state.d))
    rank, seats = qmc.Sobol(2, seed=1).random(2**18).T
    gap = state.h - ROUGH.sigma * norm.ppf(seats) if seat == "asperity" else state.d
    squeeze = np.sort(np.maximum(sizes.ppf(rank) - gap, 0.0))[::-1]
    values = spots.depths[0] + spots.depths[1]
    curve = Curve(lambda eps: eps, [])
    for part in (0.05, 1e-2, 1e-3):
        (found,) = exceeded_values([Values(spots, values, curve=curve)], [np.array([part * 1e10])])
        assert found[0] == pytest.approx(
            squeeze[int(part * 2**18)], rel=1e-2 if part < 1e-2 else 3e-3
        )


# ---------------------------------------------------------------- sizes and states at the edge
@pytest.mark.parametrize("gap", [-2e-7, 5e-7])
def test_sizes_from_zero_are_the_limit_of_small_ones(gap):
    """A particle of no size leaves no dent, in a gap that is closed too."""
    found = []
    for low in (0.0, 1e-12):
        grains = tb.Particles(
            material=tb.materials["SiC"],
            areal_density=1e10,
            diameter=tb.distributions.Uniform(low=low, high=2e-6),
        )
        rough = tb.Roughness(sigma=1e-6, R=1e-5)
        case = tb.Contact(
            surfaces=tb.MaterialPair(STEEL, STEEL), roughness=rough, particles=grains,
            outputs=Dents(),
        )  # fmt: skip
        found.append(tb.solve(case, d=gap).outputs)
    for name, value in found[0].items():
        assert np.isfinite(value), name
        assert value == pytest.approx(found[1][name], rel=5e-3), name


@pytest.mark.slow
def test_a_population_that_nothing_presses_adds_nothing():
    def case(*grains):
        return tb.Contact(
            surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=1e-7, R=1e-5),
            particles=grains if len(grains) > 1 else grains[0],
            particle_law=Series(seat="plane"), outputs=Dents(),
        )  # fmt: skip

    sizes = tb.TruncatedGaussian(mean=2e-6, std=2e-7)
    large = tb.Particles(material=tb.materials["SiC"], areal_density=1e10, diameter=sizes)
    small = large.replace(diameter=tb.distributions.Monodisperse(mean=1e-9))
    alone, beside = (tb.solve(each, d=1e-6).outputs for each in (case(large), case(large, small)))
    for name, value in alone.items():
        assert beside[name] == pytest.approx(value, rel=1e-12), name


# ---------------------------------------------------------------- against an integral by hand
def _depth_by_hand(squeeze, first):
    """Residual depth over the size x, of ε, half of it into either of two equal surfaces."""
    s = squeeze / 2 / first
    return squeeze / 2 * (1 - s**-0.28) * (1 - s**-0.69) if s > 1 else 0.0


def _number_by_hand(value, sizes, *, mean_gap, width, first, cut=math.inf):
    """Part of particles (or their fragments) with deeper dents than this, by adaptive quadrature.

    On plane seats the width is 0.
    """
    from scipy import integrate, optimize
    from scipy.stats import norm

    def closest(x):
        """The widest gap in which a particle of this size leaves a dent so deep."""
        if value == 0:
            return x * (1 - 2 * first)
        if x * _depth_by_hand(4.0, first) <= value:
            return -math.inf
        eps = optimize.brentq(
            lambda e: x * _depth_by_hand(e, first) - value, 2 * first, 4.0, xtol=1e-16, rtol=1e-15
        )
        return x * (1 - eps)

    def part(x):
        if width == 0:
            return float(closest(x) > mean_gap)
        return float(norm.cdf((closest(x) - mean_gap) / width))

    def whole(x):
        return float(sizes.pdf(x)) * part(x)

    low, high = (float(sizes.ppf(q)) for q in (1e-13, 1 - 1e-13))
    top = min(high, cut)
    ends = [low, *(float(sizes.ppf(q)) for q in np.linspace(0.02, 0.98, 33)), top]
    if width == 0 and closest(low) < mean_gap < closest(top):
        edge = optimize.brentq(
            lambda x: max(closest(x), -1.0) - mean_gap, low, top, xtol=1e-18, rtol=1e-14
        )
        ends.append(edge)
    ends = sorted(x for x in ends if low <= x <= top)
    total = sum(
        integrate.quad(whole, a, b, epsabs=0, epsrel=1e-9, limit=200)[0]
        for a, b in zip(ends, ends[1:], strict=False)
    )
    if cut < high:
        mass = integrate.quad(
            lambda t: math.exp(4 * t) * float(sizes.pdf(math.exp(t))), math.log(max(cut, low)),
            math.log(high), epsabs=0, epsrel=1e-12, limit=500,
        )[0]  # fmt: skip
        total += mass / cut**3 * part(cut)
    return total


@pytest.mark.spread(3)
@pytest.mark.parametrize("seat", ["rough", "plane"])
@pytest.mark.parametrize("cut", [math.inf, 450e-9])
def test_percentile_and_deepest_are_those_of_an_integral_by_hand(seat, cut):
    """Whole particles and fragments of brittle ones: numbers, 5 % and deepest, to 1e-6."""
    sizes = tb.LogNormal(median=400e-9, gsd=1.3)
    dust = tb.Particles(material=SILICA, areal_density=1e10, diameter=sizes)
    law = Series(seat=seat, deep="off")
    brittle = {} if cut == math.inf else {"debris": "brittle", "fragment": cut}
    case = contact(second=STEEL, law=law, dents=Dents(A_n=1e-6, **brittle)).replace(particles=dust)
    first = co.squeezed_particle(
        law.law, *co.contact_sides(case.surfaces, SILICA), 0.5
    ).yields[0]  # fmt: skip
    state = tb.solve(case, d=300e-9)
    width = ROUGH.sigma if seat == "rough" else 0.0
    where = {"mean_gap": state.h if width else float(state.d), "width": width, "first": first}

    def number(value):
        return 1e10 * _number_by_hand(value, sizes, cut=cut, **where)

    found = state.outputs
    n = number(0.0)
    assert found["n_dents_1"] == pytest.approx(n, rel=1e-6)
    p95, most = found["dent_depth_p95_1"], found["dent_depth_max_1"]
    for value, count in ((p95, 0.05 * n), (most, math.log(2 / (1 + math.exp(-n * 1e-6))) * 1e6)):
        # the exact value lies between two that differ by 2e-6
        assert number(value * (1 - 1e-6)) >= count >= number(value * (1 + 1e-6))


def test_formulas_that_change_at_nearly_the_same_squeeze_are_one():
    kink = 0.33805337343385033
    curve = Curve(lambda eps: eps**2, [kink, np.nextafter(kink, 1), kink * (1 + 1e-13)])
    np.testing.assert_allclose(curve.first(np.array([0.01, 0.25])), [0.1, 0.5], rtol=1e-8)


def test_a_value_that_is_constant_at_first_is_one_from_the_first_squeeze_on():
    """Widths of discs are those of the particle up to a third of its size, and count there."""
    flat, grown = np.array([0.5]), np.array([1.5])
    constant = Curve(lambda eps: np.ones_like(eps), [0.3])
    assert constant.first(flat) < 1e-12
    assert constant.first(grown) == math.inf
    rising = Curve(lambda eps: np.maximum(1.0, eps / 0.3), [0.3, 0.6])
    assert rising.first(flat) < 1e-12
    np.testing.assert_allclose(rising.first(grown), 0.45, rtol=1e-8)


@pytest.mark.slow
def test_the_few_embedded_are_counted_exactly():
    """By quadrature over the sizes, and the same among other loads; a few of a million."""
    from scipy import integrate, stats

    steel = tb.materials["S45C"]
    rough = tb.Roughness(sigma=100e-9, R=2.8e-6)
    law = tb.particle.Series()
    dust = tb.Particles(
        material=steel.replace(H=1.55 * steel.H),
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    )
    case = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=rough,
        particles=dust,
        particle_law=law,
        outputs=[tb.outputs.Dents()],
    )
    # the first squeeze at which a particle has sunk by half of its radius
    eps = np.linspace(0.0, 1.9, 200_001)
    sinks = law.probe(eps, surfaces=case.surfaces, particle=dust.material).sinks[0]
    embeds = eps[np.argmax(np.ravel(sinks) > 0.25)]
    together = tb.solve(case, pressure=np.array([0.5e6, 5e6, 50e6]))
    for i, pressure in enumerate([0.5e6, 5e6, 50e6]):
        alone = tb.solve(case, pressure=pressure)

        def narrow(x, h=alone.h):
            gap = (1 - embeds) * x
            return dust.diameter.pdf(np.array([x]))[0] * stats.norm.cdf(gap, h, rough.sigma)

        low, high = dust.diameter.support
        wanted = 1e11 * integrate.quad(narrow, low, high, epsrel=1e-10, limit=200)[0]
        assert alone.outputs["embedded_1"] == pytest.approx(wanted, rel=2e-4)
        assert together.outputs["embedded_1"][i] == pytest.approx(wanted, rel=2e-4)
