"""`thirdbody.explicit.solve`: control by load and by separation, symmetry, units, bad input."""

import warnings

import numpy as np
import pytest
from refusals import Mistake, refuses, warns_of

import thirdbody as tb
from thirdbody.errors import code_of, note_of
from thirdbody.explicit.interface import map_of

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SPACING, POINTS = 1e-7, 128
ROUGH = tb.surfaces.self_affine(
    sigma=300e-9, hurst=0.8, shortest=1.2e-6, longest=6e-6, spacing=SPACING, points=POINTS, seed=5
)
SIDE = POINTS * SPACING


def contact(density=5e11, diameter=None, **changes):
    made = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=ROUGH.roughness(),
        particles=tb.Particles(
            material=SILICA,
            areal_density=density,
            diameter=diameter or tb.distributions.Monodisperse(mean=3e-7),
        ),
        particle_law=tb.particle.Series(deep="off"),
    )
    return made.replace(**changes)


def pressed(made=None, surface=ROUGH, **how):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return tb.explicit.solve(made or contact(), surface, **({"F_star": 2e-3} | how))


def told(**particles):
    return {name: np.asarray(values) for name, values in particles.items()}


STATE = pressed(tol=1e-10)


def test_a_state_adds_up():
    maps, bodies = STATE.maps, STATE.particles
    load = float(maps.pressure.sum()) * SPACING**2 + float(bodies.force.sum())
    assert load / SIDE**2 == pytest.approx(STATE.pressure, rel=1e-12)
    assert STATE.F_star == pytest.approx(2e-3, rel=1e-9)
    assert STATE.F_ss_star + STATE.F_sa_star == pytest.approx(STATE.F_star, rel=1e-12)
    share = float(bodies.force.sum()) / load
    assert STATE.particle_load_share == pytest.approx(share, rel=1e-12)
    assert STATE.A_t == pytest.approx(STATE.A_ss + STATE.A_sa, rel=1e-12)
    assert STATE.A_ss_counted == float((maps.pressure > 0).mean())
    assert STATE.A_ss < STATE.A_ss_counted


def test_the_maps_are_an_equilibrium():
    """Nothing touches at a distance, nothing that touches without cap has a gap."""
    maps, hardness = STATE.maps, STEEL.H
    gap, p, code = (maps[name].values for name in ("gap", "pressure", "contact"))
    scale = 1e-4 * STATE.sigma
    assert np.all(gap[code == 0] > -scale)
    assert np.all(np.abs(gap[(code == 1) & (p > 0.01 * hardness)]) < scale)
    assert np.all(gap[code == 2] < scale)
    assert np.all(p[code == 3] == 0)
    assert np.all(p <= hardness * (1 + 1e-12))
    assert np.sum(code == 2) > 10
    assert np.allclose(gap, STATE.h + maps.displacement - maps.height, atol=1e-20)


def test_particles_follow_their_law_and_its_dents():
    bodies = STATE.particles
    carries = bodies.force.values > 0
    assert np.sum(carries) > 20
    law = tb.particle.Series(deep="off").single(
        bodies.diameter.values,
        (bodies.diameter - bodies["squeeze"]).values,
        surfaces=STATE.contact.surfaces,
        particle=SILICA,
    )
    worst = np.abs(law["force"] - bodies.force.values)[carries] / law["force"][carries].max()
    assert worst.max() < 1e-4
    both = (bodies.dent_1 + bodies.dent_2).values[carries]
    assert both == pytest.approx(bodies["squeeze"].values[carries], rel=1e-3)
    assert np.sum(law["area_1"]) / SIDE**2 == pytest.approx(STATE.A_sa, rel=1e-3)


def test_load_and_separation_control_are_one():
    other = pressed(F_star=None, h=STATE.h, tol=1e-10)
    assert other.F_star == pytest.approx(2e-3, rel=2e-5)
    assert other.particle_load_share == pytest.approx(STATE.particle_load_share, rel=2e-5)
    assert other.A_ss_counted == pytest.approx(STATE.A_ss_counted, abs=2 / POINTS**2)
    again = pressed(F_star=other.F_star, tol=1e-10)
    assert again.h == pytest.approx(STATE.h, abs=1e-5 * STATE.sigma)


@pytest.mark.parametrize("density", [0.0, 5e11])
def test_without_a_cap_load_and_separation_control_are_one(density):
    """One by one and as a curve, far to near: no state is its neighbour's."""
    loads, made = [1e-4, 1e-3, 5e-3], contact(density)
    there = pressed(made, F_star=loads, cap="none")
    back = pressed(made, F_star=None, h=there.h, cap="none")
    alone = [pressed(made, F_star=None, h=h, cap="none") for h in there.h]
    assert np.all(back.converged)
    assert back.F_star == pytest.approx(loads, rel=1e-5)
    assert [each.F_star for each in alone] == pytest.approx(loads, rel=1e-5)
    assert back.A_t == pytest.approx(there.A_t, rel=1e-6)
    # a cap that nothing reaches is none
    high = pressed(made, F_star=None, h=there.h, cap=1e13)
    assert high.F_star == pytest.approx(loads, rel=1e-5)


@pytest.mark.parametrize("hardness", [5e8, 2e9, 5e9, 2e10])
@pytest.mark.parametrize("diameter", [1.5e-7, 4e-7])
def test_no_area_carries_more_than_its_hardness(hardness, diameter):
    """A ≥ F/H, with and without particles; those of 1.5 pixels cover parts of pixels."""
    soft = STEEL.replace(H=hardness)
    made = contact(1e12, diameter=tb.distributions.Monodisperse(mean=diameter)).replace(
        surfaces=tb.MaterialPair(soft, soft)
    )
    least = hardness / made.E_ss
    for each in (made, made.replace(particles=None)):
        state = pressed(each, F_star=[1e-2 * least, 5e-2 * least, 0.2 * least], tol=1e-7)
        mean = state.F_ss_star / (least * state.A_ss)
        assert np.all((mean > 0.2) & (mean <= 1 + 1e-12))


def test_a_curve_is_its_states():
    loads = [2e-3, 1e-4, 6e-4]
    several = pressed(F_star=loads, tol=1e-9)
    assert several.F_star == pytest.approx(loads, rel=1e-9)
    for i, load in enumerate(loads):
        alone = pressed(F_star=load, tol=1e-9)
        assert several.h[i] == pytest.approx(alone.h, abs=1e-5 * STATE.sigma)
        assert several.particle_load_share[i] == pytest.approx(alone.particle_load_share, rel=1e-4)
    # maps are those of the load that was given last
    assert float(several.maps.attrs["h"]) == several.h[2]
    kept = pressed(F_star=loads, maps="all")
    assert kept.maps.sizes["state"] == 3
    assert kept.particles.sizes["state"] == 3
    assert np.all(np.diff(kept.maps.pressure.mean(("x", "y")).values[[1, 2, 0]]) > 0)


def test_single_precision_gives_the_same_state():
    fast = pressed(precision="single", tol=1e-6)
    assert fast.converged
    assert fast.particle_load_share == pytest.approx(STATE.particle_load_share, rel=1e-4)
    assert fast.h == pytest.approx(STATE.h, abs=1e-4 * STATE.sigma)


def test_the_seed_fixes_everything():
    one, two, other = pressed(seed=1), pressed(seed=1), pressed(seed=2)
    assert one.particles.equals(two.particles)
    assert one.maps.equals(two.maps)
    assert one.h == two.h != other.h


# ---------------------------------------------------------------- symmetry and units
PLACES = told(
    x=[1.03e-6, 4.5e-6, 9.97e-6, 7e-6],
    y=[2.2e-6, 8.81e-6, 5e-6, 11.3e-6],
    diameter=[6e-7, 9e-7, 7e-7, 1.5e-7],
    population=[0, 0, 0, 0],
)


def with_places(z, places, **how):
    return pressed(surface=z, spacing=SPACING, particles=places, tol=1e-9, F_star=1e-4, **how)


def test_a_shift_of_everything_changes_nothing():
    plain = with_places(ROUGH.heights, PLACES)
    moved = dict(PLACES, x=PLACES["x"] + 17 * SPACING, y=PLACES["y"] - 40 * SPACING)
    shifted = with_places(np.roll(ROUGH.heights, (17, -40), axis=(0, 1)), moved)
    assert plain.particle_load_share > 0.2
    assert shifted.h == pytest.approx(plain.h, abs=1e-5 * STATE.sigma)
    assert shifted.particles.force.values == pytest.approx(plain.particles.force.values, rel=1e-3)


def test_x_and_y_may_be_exchanged():
    plain = with_places(ROUGH.heights, PLACES)
    turned = with_places(ROUGH.heights.T, dict(PLACES, x=PLACES["y"], y=PLACES["x"]))
    assert turned.h == pytest.approx(plain.h, abs=1e-5 * STATE.sigma)
    assert np.allclose(
        turned.maps.pressure.values.T, plain.maps.pressure.values, atol=1e-3 * STEEL.H
    )


def test_a_map_need_not_be_square():
    z = np.concatenate([ROUGH.heights, ROUGH.heights])
    once, twice = pressed(contact(0.0)), pressed(contact(0.0), surface=z, spacing=SPACING)
    assert twice.h == pytest.approx(once.h, abs=1e-4 * STATE.sigma)
    assert twice.maps.pressure.shape == (POINTS, 2 * POINTS)


def test_change_of_units():
    """All lengths a thousandfold, all stresses by seven."""
    plain = with_places(ROUGH.heights, PLACES)
    k, q = 1e3, 7.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)

        def stiffer(body):
            return body.replace(E=q * body.E, H=q * body.H)

        made = contact(5e11 / k**2).replace(
            surfaces=tb.MaterialPair(stiffer(STEEL), stiffer(STEEL)),
            **{"particles.material": stiffer(SILICA), "particles.diameter.mean": 3e-7 * k},
        )
        rough = made.roughness
        made = made.replace(
            roughness=tb.Roughness(sigma=rough.sigma * k, R=rough.R * k, alpha=rough.alpha)
        )
        places = {name: v * (1 if name == "population" else k) for name, v in PLACES.items()}
        big = tb.explicit.solve(
            made, ROUGH.heights * k, spacing=SPACING * k, particles=places, F_star=1e-4, tol=1e-9
        )
    assert big.h == pytest.approx(k * plain.h, rel=1e-6)
    assert big.particle_load_share == pytest.approx(plain.particle_load_share, rel=1e-5)
    assert big.A_ss_counted == pytest.approx(plain.A_ss_counted, abs=2 / POINTS**2)


def test_particles_of_a_state_can_be_given_again():
    again = pressed(particles=STATE.particles, tol=1e-10)
    assert again.h == pytest.approx(STATE.h, abs=1e-6 * STATE.sigma)


def test_several_populations_and_unequal_hardness():
    soft = STEEL.replace(H=1e9)
    made = contact().replace(
        surfaces=tb.MaterialPair(STEEL, soft),
        particles=(
            tb.Particles(
                material=SILICA,
                areal_density=2e11,
                diameter=tb.distributions.Monodisperse(mean=4e-7),
                name="a",
            ),
            tb.Particles(
                material=STEEL,
                areal_density=2e11,
                diameter=tb.distributions.Monodisperse(mean=5e-7),
                name="b",
            ),
        ),
    )
    state = pressed(made, tol=1e-9, F_star=5e-4)
    bodies = state.particles
    assert sorted(np.unique(bodies.diameter.values[bodies.population.values == 1])) == [5e-7]
    deep = bodies.force.values > 0.2 * bodies.force.values.max()
    silica = deep & (bodies.population.values == 0)
    assert np.all(bodies.dent_2.values[silica] > bodies.dent_1.values[silica])
    assert state.A_sa2 > state.A_sa


def test_particles_hide_the_ground_under_them():
    z = np.zeros((64, 64))
    places = told(x=[3.2e-6], y=[3.2e-6], diameter=[1.05e-6], population=[0])
    state = pressed(surface=z, spacing=SPACING, particles=places, F_star=1e-6)
    under = (state.maps.contact == 3).values
    # pixels whose centre lies within the radius
    assert under.sum() == pytest.approx(np.pi / 4 * 1.05**2 * 100, rel=0.1)
    assert state.particle_load_share == 1


def test_netcdf(tmp_path):
    import xarray

    STATE.to_netcdf(tmp_path / "state.nc")
    with xarray.open_dataset(tmp_path / "state.nc") as found:
        assert found.pressure.attrs["units"] == "Pa"
        assert np.array_equal(found.particle_force, STATE.particles.force)


# ---------------------------------------------------------------- bad input
@pytest.mark.parametrize(
    ("how", "refusal"),
    [
        (dict(F_star=None), refuses(Mistake.MISSING, "", says="F_star")),
        (dict(F_star=-1.0), refuses(Mistake.RANGE, "F_star", value="-1")),
        (dict(F_star="1e-4"), refuses(Mistake.KIND, "F_star", value="'1e-4'")),
        (dict(F_star=0.5), refuses(Mistake.BEYOND, "", says="0.04465")),
        (
            dict(F_star=None, h=-1e-9, cap="none", made=contact(0.0)),
            refuses(Mistake.RANGE, "h", value="−1 nm"),
        ),
        (dict(seats="vallies"), refuses(Mistake.OPTION, "seats", value="'vallies'")),
        (dict(seats=[[0.0, 1.0, 2.0]]), refuses(Mistake.SHAPE, "", says="2")),
        (dict(cap=-1.0), refuses(Mistake.OPTION, "cap", value="-1.0")),
        (dict(tol=0.5), refuses(Mistake.RANGE, "tol", value="0.5")),
        (dict(tol=1e-9, precision="single"), refuses(Mistake.CLASH, "tol", value="1e-09")),
        (dict(precision="half"), refuses(Mistake.OPTION, "precision", value="'half'")),
        (dict(max_iterations=0), refuses(Mistake.KIND, "max_iterations", value="0")),
        (dict(surface=np.zeros((64, 64))), refuses(Mistake.KIND, "spacing", value="None")),
        (
            dict(surface=np.full((64, 64), np.nan), spacing=1e-7),
            refuses(Mistake.MISSING, "", says="100"),
        ),
        (dict(surface=np.zeros(64), spacing=1e-7), refuses(Mistake.SHAPE, "", says="(64,)")),
        (dict(surface="a.sur"), refuses(Mistake.KIND, "surface", value="'a.sur'")),
        (dict(spacing=1e-7), refuses(Mistake.CLASH, "", says="spacing = 1e-07")),
        (dict(particles=told(x=[0.0], y=[0.0])), refuses(Mistake.UNKNOWN, "", says="'diameter'")),
        (
            dict(particles=told(x=[0.0], y=[0.0], diameter=[-1e-7])),
            refuses(Mistake.RANGE, "", says="particles['diameter']"),
        ),
        (
            dict(particles=told(x=[0.0], y=[0.0], diameter=[1e-7], population=[3])),
            refuses(Mistake.KIND, "", says="particles['population']"),
        ),
    ],
)
def test_bad_input_is_refused(how, refusal):
    with refusal:
        pressed(**how)


def test_a_map_with_holes_is_refused():
    z = ROUGH.heights.copy()
    z[3, 4] = np.nan
    holed = tb.surfaces.from_topography(z, spacing=SPACING, cutoff=0)
    with refuses(Mistake.BEYOND, "", says="0.0061 %"):
        pressed(surface=holed)


def test_a_map_beyond_memory_is_refused_with_one_that_fits(monkeypatch):
    from thirdbody.explicit import interface

    pages = {"SC_AVPHYS_PAGES": 1, "SC_PAGE_SIZE": 10**6}
    monkeypatch.setattr(interface.os, "sysconf", pages.__getitem__)
    with refuses(Mistake.TOO_LARGE, "", says="64 x 64"):
        pressed()


def test_what_is_doubtful_is_said():
    def warned(**how):
        return {code_of(note) for note in pressed(**how).warnings}

    assert "explicit.converged" in warned(max_iterations=2, tol=1e-10)
    assert "explicit.few" in warned(F_star=2e-6)
    assert "explicit.dense" in warned(F_star=0.6 * contact().surfaces.H / contact().E_ss)
    assert "explicit.large" in warned(particles=told(x=[0.0], y=[0.0], diameter=[2e-6]))
    assert "explicit.overlap" in warned(
        particles=told(x=[0.0, 1e-7], y=[0.0, 0.0], diameter=[4e-7] * 2)
    )
    fine = tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=3e-7, longest=6e-6, spacing=1e-7, points=128
    )
    assert "explicit.grid" in warned(surface=fine)
    assert "explicit.rim" in warned(
        surface=tb.surfaces.from_topography(ROUGH.heights, spacing=SPACING, cutoff=0)
    )
    with warns_of("explicit.few"):
        tb.explicit.solve(contact(), ROUGH, F_star=2e-6)


def test_a_jump_at_the_rim_is_no_short_wave():
    """Of a part cut out of a map, whose own waves are well resolved."""
    heights = tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=1.6e-6, longest=6e-6, spacing=1e-7, points=256
    ).heights
    whole, part = map_of(heights, 1e-7), map_of(heights[:100, :90], 1e-7)
    assert whole.shortest_wave() == pytest.approx(1.6e-6, rel=0.05)
    assert part.shortest_wave() == pytest.approx(1.6e-6, rel=0.2)


def test_waves_are_left_out_only_where_it_is_said():
    """A topography is its heights with cutoff=0; without one it is said what is pressed."""
    fine = tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.6, shortest=8e-7, longest=6e-6, spacing=SPACING, points=128
    ).heights
    given = tb.surfaces.from_topography(fine, spacing=SPACING, periodic=True, cutoff=0)
    own = tb.surfaces.from_topography(fine, spacing=SPACING, periodic=True)
    bare, how = contact(0.0), {"tol": 1e-8, "F_star": 1e-3}
    plain = pressed(bare, surface=fine, spacing=SPACING, **how)
    whole, smooth = pressed(bare, surface=given, **how), pressed(bare, surface=own, **how)
    assert whole.h == pytest.approx(plain.h, rel=1e-9)
    assert not any("cut-off" in each for each in whole.warnings)
    # what is said is what was done, and lowers the flat
    (said,) = (each for each in smooth.warnings if "explicit.cutoff." in code_of(each))
    assert "cutoff=0" in said
    filtered = pressed(bare, surface=own.filtered(), spacing=SPACING, **how)
    assert smooth.h == pytest.approx(filtered.h, rel=1e-9)
    assert smooth.h < plain.h - 0.01 * plain.sigma
    asked = tb.surfaces.from_topography(fine, spacing=SPACING, periodic=True, cutoff=own.cutoff)
    again = pressed(bare, surface=asked, **how)
    assert again.h == smooth.h
    assert not any("cut-off" in each for each in again.warnings)


def test_where_nothing_touches_no_few_points_carry():
    """A flat far above a map: that nothing touches is told, and not that 0 pixels carry."""
    steel = tb.materials["S45C"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6)
    )
    heights = 1e-7 * np.random.default_rng(0).standard_normal((16, 16))
    high = tb.explicit.solve(contact, heights, spacing=1e-7, h=5e-6)
    assert float(high.A_t) == 0
    codes = {code_of(note) for note in high.warnings}
    assert "explicit.nothing" in codes
    assert "explicit.few" not in codes


# ---------------------------------------------------------------- a map in nanometres
def test_a_map_in_nanometres_is_asked_for_its_unit():
    """So large a map would hold 1e17 particles, which no generator draws."""
    contact = tb.Contact(
        surfaces=tb.MaterialPair(tb.materials["S45C"], tb.materials["S45C"]),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=tb.materials["SiO2"],
            areal_density=1e11,
            diameter=tb.distributions.Monodisperse(mean=3e-7),
        ),
    )
    heights = 100.0 * np.random.default_rng(3).normal(size=(32, 32))
    with (
        warns_of("unit of spacing", says="100 nm") as heard,
        refuses(Mistake.TOO_LARGE, "", says="heights and spacing, 100,"),
    ):
        tb.explicit.solve(contact, heights, spacing=100, F_star=1e-3)
    codes = {code_of(note_of(each.message)) for each in heard}
    assert codes == {"unit of spacing", "unit of heights (rms)"}
    assert {each.filename for each in heard} == {__file__}
