"""Many surfaces against the statistical model, as Python and as a command."""

import csv
import dataclasses
import json
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from refusals import Mistake, refuses
from scipy.special import ndtr
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.errors import code_of
from thirdbody.explicit import ensemble as function
from thirdbody.explicit import pooling, sums
from thirdbody.explicit.interface import law_tables, map_of
from thirdbody.study import load_study
from thirdbody.study.run_explicit import run_explicit

EXAMPLE = Path(__file__).parents[2] / "examples" / "explicit.toml"
STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
CONTACT = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL),
    roughness=tb.Roughness(sigma=300e-9, R=3e-6),
    particles=tb.Particles(
        material=SILICA, areal_density=2e11, diameter=tb.distributions.Monodisperse(mean=4e-7)
    ),
    particle_law=tb.particle.Series(deep="off"),
)


def gauss(low, high, count):
    """Nodes and weights of Gauss and Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return low + (nodes + 1) * (high - low) / 2, weights * (high - low) / 2


HOW = dict(F_star=[3e-4, 2e-3], size=128, spacing=2e-7, seed=3)


def many(count=4, contact=CONTACT, **changes):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        return function(contact, **(HOW | {"surfaces": count} | changes))


@pytest.fixture(scope="module")
def found():
    return many(6)


def test_surfaces_have_the_roughness_asked_for():
    surface = tb.explicit.surface_of(CONTACT, size=256, spacing=1.5e-7, seed=1)
    moments = surface.moments_at(0, method="spectrum")
    rough = CONTACT.roughness
    assert moments.sigma == pytest.approx(rough.sigma, rel=1e-6)
    assert moments.alpha == pytest.approx(rough.alpha, rel=1e-6)
    assert moments.R == pytest.approx(rough.R, rel=1e-6)


def test_the_statistical_model_agrees_where_the_luck_is_taken_out(found):
    """The stated agreement of the rough seat, 10 % of the share; errors are known."""
    table = found.table
    share, model = table.particle_load_share_cv, table.particle_load_share_statistical
    error = table.particle_load_share_cv_error
    assert np.all(np.abs(share - model) < 0.1 * model + 3 * error)
    assert np.all(np.abs(table.h_cv - table.h_statistical) < 0.05 * 300e-9 + 3 * table.h_cv_error)
    # the variate is there to make errors smaller
    raw = table.particle_load_share_raw_error
    assert np.all(error < raw)
    assert found.left_out == 0
    assert found.sentence.endswith(".")


def test_loads_are_pooled_at_equal_separation(found):
    """The pooled load at the separation found is the load, and its parts give the share."""
    at, h = found.at_h, found.table.h_raw.values
    nominal = 6 * (128 * 2e-7) ** 2
    total = (at.asperities + at.particles).values / nominal / CONTACT.E_ss
    back = np.exp(np.interp(h, at.h.values[::-1], np.log(total[::-1])))
    # straight lines over 0.15 sigma against the curve
    assert back == pytest.approx(HOW["F_star"], rel=0.01)
    particles = np.exp(np.interp(h, at.h.values[::-1], np.log(at.particles.values[::-1])))
    share = particles / nominal / CONTACT.E_ss / back
    assert found.table.particle_load_share_raw.values == pytest.approx(share, rel=0.01)


def test_what_a_draw_carries_on_average_counts_the_tail_of_the_sizes():
    """Against the distribution itself: 64 equal shares of the number once lost 14 % of the load."""
    sizes = tb.LogNormal(median=3e-7, gsd=1.6)
    dust = CONTACT.particles.replace(diameter=sizes)
    contact = CONTACT.replace(particles=dust)
    heights = 300e-9 * np.random.default_rng(0).standard_normal((64, 64))
    surface = map_of(heights - heights.mean(), 2e-7)
    (law,) = law_tables(contact)
    h, sigma = 3.8 * surface.sigma, surface.sigma
    found = sums._sums_of_draw(
        contact, surface, tb.explicit.RandomSeats(), np.empty(0), np.array([h]), gaussian=True
    )
    x, weight = gauss(np.log(1e-8), np.log(3e-5), 500)
    x, weight = np.exp(x), weight * np.exp(x) * sizes.pdf(np.exp(x))
    zeta, share = gauss(-8, 8, 400)
    share = share * np.exp(-(zeta**2) / 2) / np.sqrt(2 * np.pi)
    squeeze = x[:, None] + sigma * zeta - h
    load = np.sum(weight[:, None] * share * x[:, None] ** 2 * law.force(squeeze / x[:, None]))
    assert found["law"][0] == pytest.approx(load * dust.areal_density * surface.area, rel=3e-3)


def test_ratios_say_why(found):
    at = found.at_h.isel(h=-1)
    assert 0.4 < float(at.bare_over_bearing) < 0.9
    # few particles far apart carry what their law says, for the ground hardly moves
    alone = found.at_h.particles_over_sum.values
    assert alone[np.isfinite(alone)][0] == pytest.approx(1, abs=0.02)
    assert 0.9 < float(at.asperities_with_over_without) < 1.0
    assert 0.8 < float(at.bearing_over_gaussian) < 1.25


def test_settled_particles_bring_the_model_to_their_seat():
    lower = many(4, seats=tb.explicit.SettledSeats(within=1.5e-6))
    law = lower.model.particle_law
    assert (law.zeta_mean, law.zeta_std) == (lower.seats.mean, lower.seats.std)
    assert -0.7 < law.zeta_mean < -0.3
    table = lower.table
    assert np.all(table.particle_load_share_statistical < 0.6 * tb.solve(
        CONTACT, F_star=HOW["F_star"]).particle_load_share)  # fmt: skip
    away = np.abs(table.particle_load_share_cv / table.particle_load_share_statistical - 1)
    assert float(away[-1]) < 0.2


@pytest.mark.check
def test_particles_on_summits_bring_the_model_to_summits():
    """A map has fewer summits than places are drawn to know a seat: then all of them count."""
    one_each = CONTACT.replace(particles=CONTACT.particles.replace(areal_density=2e10))
    done = many(contact=one_each, seats="summits", size=192)
    assert done.seats.mean == pytest.approx(1.0, abs=0.1)
    assert done.model.particle_law.zeta_mean == done.seats.mean
    share, model = (done.table[f"particle_load_share_{name}"] for name in ("cv", "statistical"))
    error = done.table.particle_load_share_cv_error
    assert np.all(np.abs(share - model) < 0.1 * model + 3 * error)
    anywhere = many(contact=one_each, size=192).table.particle_load_share_cv
    assert np.all(share > 2 * anywhere)


def test_two_bodies():
    clean = many(2, CONTACT.replace(particles=None))
    assert np.all(clean.table.particle_load_share_raw == 0)
    assert np.isnan(clean.seats.mean)
    assert "real contact area" in clean.sentence


def test_an_interrupted_run_goes_on(tmp_path):
    def stop(done):
        if done == 2:
            raise KeyboardInterrupt

    whole = many(3)
    with pytest.raises(KeyboardInterrupt):
        many(3, folder=tmp_path, progress=stop)
    kept = sorted(tmp_path.iterdir())
    assert [file.name for file in kept] == ["surface_000.json", "surface_001.json"]
    before = [file.read_bytes() for file in kept]
    again = many(3, folder=tmp_path)
    assert again.to_dict() == whole.to_dict()
    assert [file.read_bytes() for file in kept] == before
    # what was made for other numbers stays
    with refuses(Mistake.OTHER_STUDY, "", says="surface_000.json"):
        many(3, folder=tmp_path, seats="valleys")
    assert [file.read_bytes() for file in kept] == before


@pytest.mark.check
def test_shared_among_threads_it_is_the_same(tmp_path):
    """Byte for byte, in a folder and out of it, stopped and resumed by others."""

    def stop(done):
        if done == 2:
            raise KeyboardInterrupt

    asked = dict(count=5, size=64, spacing=3e-7)
    alone = many(**asked, folder=tmp_path / "alone")
    told = []
    with pytest.raises(KeyboardInterrupt):
        many(**asked, folder=tmp_path / "two", workers=2, progress=stop)
    assert len(list((tmp_path / "two").iterdir())) == 2
    two = many(**asked, folder=tmp_path / "two", workers=3, progress=told.append)
    assert told == [3, 4, 5]
    assert json.dumps(two.to_dict()) == json.dumps(alone.to_dict())
    assert json.dumps(two.states) == json.dumps(alone.states)
    assert json.dumps(many(**asked, workers=2).to_dict()) == json.dumps(alone.to_dict())
    files = [{each.name: each.read_bytes() for each in (tmp_path / name).iterdir()}
             for name in ("alone", "two")]  # fmt: skip
    assert files[0] == files[1]


def test_states_that_did_not_converge_are_left_out():
    short = many(2, max_iterations=2, tol=1e-10)
    assert short.left_out > 0
    assert "explicit.converged" in {code_of(note) for note in short.warnings}


# ---------------------------------------------------------------- what nobody drew
def pool_of(drawn, *, cap=5e9, particles=1.0, surfaces=4):
    """Asperities that carry 0.6 of the cap on a Gaussian bearing area, cut off at ``drawn``/σ."""
    h = np.linspace(5, 2, 31)
    area, law = 1e-8, 3e8 * particles * np.exp(-1.2 * h)
    bearing = area * ndtr(-h)
    luck = np.linspace(0.8, 1.2, surfaces)[:, None]
    seen = luck * bearing * (h <= np.broadcast_to(drawn, surfaces)[:, None])
    every = np.ones((surfaces, 1))
    sums_of = {
        "asperities": 0.6 * cap * seen * luck**0.01, "area": 0.7 * seen, "bearing": seen, "bare": seen,
        "particles": every * law * area, "law": every * law * area,
        "particle_area": every * law * area / cap, "law_area": every * law * area / cap,
    }  # fmt: skip
    expected = {"bearing": every * bearing, "law": every * law * area,
                "law_area": every * law * area / cap}  # fmt: skip
    truth = law / (law + 0.6 * cap * bearing / area)
    pool = pooling.Pool(
        h=h * 3e-7, nominal=np.full(surfaces, area), good=np.ones((surfaces, 31), bool),
        sums=sums_of, expected=expected,
    )  # fmt: skip
    return pool, law + 0.6 * cap * bearing / area, truth


@pytest.mark.parametrize("fair", [True, False])
def test_a_share_that_nobody_drew_is_bounded(fair):
    """All agree that no asperity carries: no number, no error, and the truth within the bounds."""
    pool, load, truth = pool_of(3.55)
    far = np.arange(3, 13)  # 4.7 to 3.8 sigma
    at = pool.at_loads(load[far], fair=fair, cap=5e9)
    assert np.all(at.idle[0])
    assert np.all(np.isnan(at.errors["particle_load_share"]))
    share = at.values["particle_load_share"]
    assert np.all(np.isnan(share)) if fair else np.all(share == 1)
    least, most = at.least["particle_load_share"], at.most["particle_load_share"]
    assert np.all((least < truth[far]) & (truth[far] <= most))
    assert np.all(least > 1 - 2.5 * (1 - truth[far]))  # 0.6 of the cap, at a lower flat
    # the separation and the area know what is missing
    error = at.errors["h"]
    assert np.all(np.abs(at.values["h"] - pool.h[far]) < 1.01 * error)
    # without a cap there is no bound
    open_ = pool.at_loads(load[far], fair=fair, cap=None)
    assert np.all(open_.least["particle_load_share"] == 0)
    assert not np.any(np.isfinite(open_.errors["h"]))
    # nearer the luck is taken out, and no bound is needed
    near = pool.at_loads(load[22:30], fair=True, cap=5e9)
    assert near.values["particle_load_share"] == pytest.approx(truth[22:30], rel=2e-3)
    assert np.all(np.isnan(near.least["particle_load_share"]))


def test_one_surface_alone_is_no_error():
    pool, load, truth = pool_of([2.0, 2.0, 2.0, 4.5])
    at = pool.at_loads(load[8:20], fair=True, cap=5e9)
    share = at.values["particle_load_share"]
    assert share == pytest.approx(truth[8:20], rel=5e-3)
    assert np.all(np.isnan(at.errors["particle_load_share"]))
    assert np.all(at.least["particle_load_share"] <= truth[8:20])


def test_particles_that_nobody_drew_are_bounded_too():
    pool, load, truth = pool_of(9.0, particles=1e-11)
    pool.sums["particles"][:] = 0
    pool.sums["particle_area"][:] = 0
    at = pool.at_loads(load[5:20], fair=True, cap=5e9)
    assert np.all(at.idle[1])
    assert np.all(np.isnan(at.values["particle_load_share"]))
    assert np.all(at.least["particle_load_share"] == 0)
    most = at.most["particle_load_share"]
    assert np.all((truth[5:20] < 1.02 * most) & (most < 1.1 * truth[5:20]))


def test_loads_that_tie_stand_for_the_first():
    """All that carries is embedded: the load is the same over a stretch of separations."""
    pool, _, _ = pool_of(2.5)
    for name in ("particles", "law"):
        values = pool.sums[name]
        values[:, 10:16] = values[:, 10:11]
    values = pool.sums["asperities"]
    values[:] = 0
    at = pool.at_loads(pool.sums["particles"][0, 10:11] / 1e-8, fair=False, cap=5e9)
    assert at.values["h"] == pytest.approx(pool.h[10], rel=1e-12)


def test_an_ensemble_says_where_nothing_was_drawn():
    """Surfaces too small for an asperity at this load: once 100 ± 0 %, infinitely far from any."""
    found = many(3, F_star=[2e-5, 2e-3], size=64, spacing=3e-7)
    table, bound = found.table, found.table.particle_load_share_cv_least.values
    error = np.stack([table[f"particle_load_share_{k}_error"] for k in ("raw", "cv")])
    assert not np.any(error == 0)
    assert np.all(np.isnan(error[:, 0]))
    assert np.isnan(table.particle_load_share_difference.values[0])
    assert 0 <= bound[0] <= float(table.particle_load_share_statistical[0])
    assert np.isnan(bound[1])
    assert (
        sum("the particles' load share has no error there" in each for each in found.warnings) == 1
    )
    # what these surfaces carry at none of the separations pressed is told, not NaN without a word
    lost = many(2, F_star=[1e-6, 2e-3], size=64, spacing=3e-7)
    gone = [np.isnan(lost.table[f"h_{kind}"].values[0]) for kind in ("raw", "cv")]
    assert any(gone)
    told = [code_of(note) for note in lost.warnings]
    assert sum(each.startswith("explicit.outside.") for each in told) == sum(gone)
    alone = many(1, F_star=[2e-5, 2e-3], size=64, spacing=3e-7)
    assert np.all(np.isnan(alone.table.h_raw_error))
    # without particles their share is nought, and no luck
    clean = many(2, CONTACT.replace(particles=None), size=64, spacing=3e-7)
    assert np.all(clean.table.particle_load_share_cv_error == 0)
    assert not any("no error" in each for each in clean.warnings)


def test_a_load_on_a_few_points_is_told():
    few = [code_of(note) for note in many(2, F_star=[3e-6, 3e-4]).warnings]
    assert "explicit.few" in few
    assert "explicit.few" not in [code_of(note) for note in many(2).warnings]


@pytest.mark.parametrize(
    ("how", "refusal"),
    [
        (dict(count=0), refuses(Mistake.KIND, "surfaces", value="0")),
        (dict(F_star=[-1.0]), refuses(Mistake.RANGE, "F_star", value="-1")),
        (dict(seats=[[0.0, 0.0]]), refuses(Mistake.BEYOND, "", says="surfaces = 1")),
        (dict(seats="nowhere"), refuses(Mistake.OPTION, "seats", value="'nowhere'")),
        (dict(workers=0), refuses(Mistake.KIND, "workers", value="0")),
    ],
)
def test_bad_input_is_refused(how, refusal):
    with refusal:
        many(**how)


# ---------------------------------------------------------------- the command
SMALL = ("--surfaces", "2", "--size", "128", "--spacing", "200 nm")


def run(*arguments):
    return CliRunner().invoke(cli.app, ["explicit", *map(str, arguments)])


@pytest.mark.slow
def test_the_command_writes_what_it_says(tmp_path):
    out = tmp_path / "points"
    done = run(EXAMPLE, *SMALL, "--out", out, "--json")
    assert done.exit_code == 0, done.output
    data = json.loads(done.stdout)
    assert data == json.loads((out / "explicit.json").read_text("utf-8"))
    assert data["table"]["F_star"] == [1e-4, 1e-3]
    assert data["surfaces"] == 2
    names = {"states.csv", "maps.nc", "explicit.json", "explicit.png", "surfaces", "study.json"}
    assert {file.name for file in out.iterdir()} == names
    with (out / "states.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head[:3] == ["surface", "h [m]", "F_star [1]"]
    assert {row[0] for row in rows} == {"0", "1"}
    again = run(EXAMPLE, *SMALL, "--out", out, "--json")
    assert again.stdout == done.stdout
    shared = run(EXAMPLE, *SMALL, "--workers", "2", "--out", tmp_path / "shared", "--json")
    assert shared.stdout == done.stdout
    for name in ("states.csv", "explicit.json", "explicit.png", "surfaces/surface_001.json"):
        assert (tmp_path / "shared" / name).read_bytes() == (out / name).read_bytes()


def test_the_command_in_words():
    done = run(EXAMPLE, *SMALL, "--seats", "settled")
    assert done.exit_code == 0, done.output
    assert "2 synthetic surfaces, every particle at its place" in done.stdout
    assert "zeta_mean = -0." in done.stdout


def test_a_measured_surface_is_pressed_itself():
    map_of = tb.surfaces.self_affine(
        sigma=300e-9, hurst=0.8, shortest=2.4e-6, longest=8e-6, spacing=2e-7, points=128
    ).heights
    measured = tb.surfaces.from_topography(map_of, spacing=2e-7, cutoff=0)
    asked = dataclasses.replace(load_study(EXAMPLE), faces=(measured,))
    result = run_explicit(asked)
    assert result.data["surfaces"] == 1
    assert "h_cv" not in result.data["table"]
    assert "explicit.rim" in map(code_of, result.data["warnings"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)
        alone = tb.explicit.solve(asked.contact, measured, F_star=[1e-4, 1e-3])
    assert result.data["table"]["h_raw"] == alone.h.tolist()
    shared = run_explicit(asked, workers=2)
    assert json.dumps(shared.data) == json.dumps(result.data)
    with refuses(Mistake.BEYOND, "scheduler", value="'tcp://127.0.0.1:9'"):
        run_explicit(asked, scheduler="tcp://127.0.0.1:9")


def test_a_measured_surface_with_holes_is_refused(tmp_path):
    text = EXAMPLE.read_text("utf-8")
    file = tmp_path / "own.toml"
    file.write_text(re.sub(r"sigma = .*\nR .*\n", 'topography = "example"\n', text))
    assert load_study(file).faces[0].missing > 0
    (problem,) = refused("explicit", file).problems
    assert problem.code is Mistake.BEYOND


def test_states_that_did_not_converge_end_in_3(tmp_path):
    short = ("--set", "explicit.max_iterations=2", "--set", "explicit.tol=1e-10")
    done = run(EXAMPLE, *SMALL, *short)
    assert done.exit_code == 3
    assert "did not converge" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--seats", "vallies"), 'did you mean "valleys"'),
        (("--surfaces", "0"), "explicit.surfaces = 0 must be a whole number from 1"),
        (("--spacing", "3 GPa"), "explicit.spacing"),
        (("--maps", "some"), "--maps some must be last or all"),
        (("--workers", "0"), "--workers 0 must be at least 1"),
        (("--set", "explicit.sizes=128"), "did you mean size"),
        (("--set", 'explicit.cap="soft"'), 'must be "hardness", "none"'),
        (("--set", 'explicit.seats={rule="settled", within="-1 um"}'), "explicit.seats.within"),
        (("--set", "load.separation=1e-7"), "load.separation counts from a plane"),
        (("--set", 'roughness.sigma="300 um"'), "no spectrum"),
    ],
)
def test_mistakes_in_the_study(arguments, words):
    done = run(EXAMPLE, *SMALL, *arguments)
    assert done.exit_code == 2, done.output
    assert words in done.stderr
    assert "Traceback" not in done.output
