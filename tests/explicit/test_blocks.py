"""Error bars of one map, against the spread of many."""

import json

import numpy as np
import pytest
from refusals import Mistake, refuses
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.errors import code_of
from thirdbody.explicit.blocks import ERRORS, errors_of
from thirdbody.quantities.say import percent
from thirdbody.study import load_study
from thirdbody.study.run_explicit import run_explicit

pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
STEEL, GLASS = tb.materials["S45C"], tb.materials["SiO2"]


def made(points, longest, seed=5):
    """A surface and a contact of it with particles."""
    surface = tb.surfaces.self_affine(
        sigma=100e-9, hurst=0.8, shortest=8e-7, longest=longest, spacing=1e-7, points=points,
        seed=seed,
    )  # fmt: skip
    dust = tb.Particles(
        material=GLASS, areal_density=1e12, diameter=tb.distributions.Monodisperse(mean=2e-7)
    )
    surfaces = tb.MaterialPair(STEEL, STEEL)
    return surface, tb.Contact(surfaces=surfaces, roughness=surface.roughness(), particles=dust)


@pytest.mark.slow
@pytest.mark.parametrize("F_star", [1e-4, 1e-3])
def test_the_error_of_one_window_is_the_spread_of_many(F_star):
    """36 windows of one surface: the spread is known to 12 %, the mean error better."""
    surface, contact = made(1536, 6e-6)
    told, errors = [], []
    for i in range(36):
        row, column = divmod(i, 6)
        window = surface.heights[256 * row : 256 * (row + 1), 256 * column : 256 * (column + 1)]
        state = tb.explicit.solve(
            contact, window, spacing=1e-7, F_star=F_star, seed=i, blocks=4, tol=1e-5
        )
        told.append([getattr(state, name) for name in ERRORS])
        errors.append([state.errors[name] for name in ERRORS])
    ratio = np.sqrt(np.mean(np.square(errors), axis=0)) / np.std(told, axis=0, ddof=1)
    assert np.all((ratio > 0.75) & (ratio < 1.5)), ratio


def test_blocks_that_are_draws_have_the_error_of_their_mean():
    """Loads and areas drawn at random: a thousand maps of 16 blocks each."""
    rng = np.random.default_rng(3)
    told, errors = [], []
    for _ in range(1000):
        sums = rng.lognormal(sigma=0.3, size=(5, 16))
        whole = sums.sum(axis=1)
        steeper = whole * [1.5, 1.5, 1.5, 1.5, 1.0]  # shares and gap stay, areas grow as the load
        errors.append(errors_of(sums, steeper, 16.0))
        load, dust, area, dents, volume = whole
        pressure = (load + dust) / 16.0
        told.append([volume / 16, np.log((area + dents) / pressure), dust / (load + dust),
                     dents / (area + dents)])  # fmt: skip
        errors[-1][1] /= (area + dents) / 16.0
    ratio = np.sqrt(np.mean(np.square(errors), axis=0)) / np.std(told, axis=0)
    assert ratio == pytest.approx(np.ones(4), abs=0.08)


def test_errors_belong_to_the_loads():
    surface, contact = made(128, 3e-6)
    bare = tb.explicit.solve(contact, surface, F_star=[1e-3, 1e-4])
    assert bare.errors == {}
    state = tb.explicit.solve(contact, surface, F_star=[1e-3, 1e-4], blocks=4)
    assert set(state.errors) == set(ERRORS)
    assert state.h.tolist() == bare.h.tolist()
    for i, load in enumerate((1e-3, 1e-4)):
        one = tb.explicit.solve(contact, surface, F_star=load, blocks=4)
        for name in ERRORS:
            assert state.errors[name][i] == pytest.approx(one.errors[name], rel=0.05), name
    assert state.errors["A_t"][0] < state.A_t[0]
    clean = tb.explicit.solve(contact.replace(particles=None), surface, F_star=1e-3, blocks=4)
    assert clean.errors["h"] > 0
    assert np.isnan(clean.errors["particle_load_share"])


def test_long_waves_are_told():
    surface, contact = made(128, 1.28e-5)
    state = tb.explicit.solve(contact, surface, F_star=1e-3, blocks=4)
    assert "blocks" in map(code_of, state.warnings)


def test_blocks_are_whole_and_two_at_least():
    surface, contact = made(128, 3e-6)
    for blocks in (1, 2.5, True):
        with refuses(Mistake.KIND, "blocks", value=repr(blocks)):
            tb.explicit.solve(contact, surface, F_star=1e-3, blocks=blocks)


def test_a_study_of_a_measured_surface_has_error_bars(tmp_path):
    """On the screen and in JSON."""
    surface, _ = made(128, 3e-6)
    np.save(tmp_path / "part.npy", surface.heights)
    file = tmp_path / "study.toml"
    file.write_text(
        """
        [surfaces]
        first = "S45C"
        second = "S45C"
        [roughness]
        topography = "part.npy"
        spacing = "100 nm"
        unit = "m"
        cutoff = 0
        [particles]
        material = "SiO2"
        distribution = "monodisperse"
        mean = "200 nm"
        areal_density = "1e12 / m^2"
        [load]
        F_star = 1e-3
        """
    )
    study = load_study(file)
    table = json.loads(json.dumps(run_explicit(study).data["table"]))
    state = tb.explicit.solve(study.contact, study.faces[0], F_star=1e-3, blocks=4)
    for name in ERRORS:
        assert table[f"{name}_raw_error"] == [pytest.approx(state.errors[name])]
    printed = CliRunner().invoke(cli.app, ["explicit", str(file)])
    share = percent(table["particle_load_share_raw"][0], table["particle_load_share_raw_error"][0])
    assert share in printed.stdout
    assert "±" in share
