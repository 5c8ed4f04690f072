"""Several populations of particles in one interface."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.study import load_study

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SIZES = tb.TruncatedGaussian(mean=300e-9, std=24e-9)
DUST = tb.Particles(material=SILICA, areal_density=5e10, diameter=SIZES, name="dust")
DEBRIS = tb.Particles(
    material=STEEL,
    areal_density=2e10,
    diameter=tb.LogNormal(median=200e-9, gsd=1.5),
    name="debris",
)
LOADS = np.geomspace(1e5, 1e8, 7)


def contact(*particles, **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=particles,
        **more,
    )


@pytest.mark.parametrize("seat", ["rough", "plane"])
def test_halves_make_the_whole(seat):
    law = tb.particle.Series(deep="off", seat=seat)
    half = DUST.replace(areal_density=2.5e10)
    two = tb.solve(contact(half, half, particle_law=law), pressure=LOADS)
    one = tb.solve(contact(DUST, particle_law=law), pressure=LOADS)
    for name in ("d", "A_t", "F_sa_star", "shadow"):
        np.testing.assert_allclose(getattr(two, name), getattr(one, name), rtol=1e-13)
    for part in two.populations:
        np.testing.assert_allclose(part.load_share, 0.5 * one.particle_load_share, rtol=1e-12)


def test_a_mixture_of_sizes_is_two_populations_of_one_material():
    narrow, wide = SIZES, tb.LogNormal(median=200e-9, gsd=1.4)
    mixed = tb.Particles(
        material=SILICA,
        areal_density=4e10,
        diameter=tb.distributions.Mixture(parts=(narrow, wide), weights=(0.25, 0.75)),
    )
    apart = [
        tb.Particles(material=SILICA, areal_density=density, diameter=sizes)
        for density, sizes in ((1e10, narrow), (3e10, wide))
    ]
    together = tb.solve(contact(*apart), pressure=LOADS)
    np.testing.assert_allclose(together.d, tb.solve(contact(mixed), pressure=LOADS).d, rtol=1e-12)


def test_shares_add_up():
    state = tb.solve(contact(DUST, DEBRIS), pressure=5e6)
    assert [part.name for part in state.populations] == ["dust", "debris"]
    assert sum(p.F_sa_star for p in state.populations) == pytest.approx(state.F_sa_star, rel=1e-12)
    assert sum(p.A_sa for p in state.populations) == pytest.approx(state.A_sa, rel=1e-12)
    total = sum(p.load_share for p in state.populations)
    assert total == pytest.approx(state.particle_load_share, rel=1e-12)
    # each carries at this separation what it would carry alone
    for particles, part in zip((DUST, DEBRIS), state.populations, strict=True):
        alone = tb.solve(contact(particles), d=state.d)
        assert alone.F_sa_star == pytest.approx(part.F_sa_star, rel=1e-12)
    assert tb.solve(contact(DUST), pressure=5e6).populations == ()


def test_each_may_follow_its_own_law():
    plane = DUST.replace(
        law=tb.particle.Series(deep="off", seat="plane", shadow="none"), name="plane"
    )
    state = tb.solve(contact(DUST, plane), pressure=LOADS)
    for index, particles in enumerate((DUST, plane)):
        for i, d in enumerate(state.d):
            alone = tb.solve(contact(particles), d=float(d)).F_sa_star
            assert state.populations[index].F_sa_star[i] == pytest.approx(alone, rel=1e-11)
    assert state.shadow == pytest.approx(tb.solve(contact(DUST), d=state.d).shadow, rel=1e-12)


def test_without_density_there_is_no_population():
    two = contact(DUST, DEBRIS)
    gone = two.replace(**{"particles.1.areal_density": 0})
    assert gone.populations == (DUST,)
    assert tb.solve(gone, pressure=5e6).d == tb.solve(contact(DUST), pressure=5e6).d
    assert contact(DUST.replace(areal_density=0)).two_body


def test_round_trip_and_many_states():
    two = contact(DUST, DEBRIS.replace(law=tb.particle.Series(deep="off", zeta_mean=-0.5)))
    assert tb.Contact.from_dict(two.to_dict()) == two
    many = tb.solve(two, pressure=np.geomspace(1e5, 1e8, 6001))
    few = tb.solve(two, pressure=many.pressure[::1000])
    np.testing.assert_allclose(many.d[::1000], few.d, rtol=1e-12)
    np.testing.assert_allclose(
        many.populations[1].load_share[::1000], few.populations[1].load_share, rtol=1e-11
    )
    swept = tb.sweep(two, pressure=LOADS, vary={"particles.0.areal_density": [0.0, 1e10]})
    one = two.replace(**{"particles.0.areal_density": 1e10})
    np.testing.assert_allclose(swept.A_t.values[1], tb.solve(one, pressure=LOADS).A_t, rtol=1e-12)
    assert tb.transitions(two).F_cr1.status == "found"
    assert "Lubricants" in tb.cite(two)


@pytest.mark.parametrize(
    ("make", "refusal"),
    [
        (
            lambda: contact(DUST, DUST.replace(law=tb.particle.Horng2022())),
            refuses(Mistake.BEYOND, "Contact.particles"),
        ),
        (
            lambda: contact(DUST, DUST.replace(law=tb.asperity.ZMC())),
            refuses(Mistake.KIND, "particles.1.law", value="ZMC(k=0.4, rho=54.0)"),
        ),
        (
            lambda: contact(*[DUST.replace(areal_density=6e12)] * 3),
            refuses(Mistake.FULL, "Contact.particles"),
        ),
        (lambda: contact(DUST, "dust"), refuses(Mistake.KIND, "Contact.particles")),
        (
            lambda: contact(DUST).replace(**{"particles.4.areal_density": 1}),
            refuses(Mistake.UNKNOWN, "", says="'4'"),
        ),
        (
            lambda: contact(DUST).replace(**{"particles.areal_density": 1}),
            refuses(Mistake.UNKNOWN, "", says="'areal_density'"),
        ),
    ],
)
def test_mistakes(make, refusal):
    with refusal:
        make()


# ---------------------------------------------------------------------------- the command line
EXAMPLE = Path(__file__).parents[2] / "examples" / "dust_and_debris.toml"


def run(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def test_json_says_what_each_population_carries():
    loads = np.array([1e5, 5e6])
    answer = json.loads(run("solve", EXAMPLE, "--json", "--set", "load.pressure=[1e5, 5e6]").stdout)
    state = tb.solve(load_study(EXAMPLE).contact, pressure=loads)
    assert [part["name"] for part in answer["populations"]] == ["dust", "debris"]
    for told, part in zip(answer["populations"], state.populations, strict=True):
        for name in ("F_sa_star", "A_sa", "load_share", "area_share"):
            assert told[name] == getattr(part, name).tolist()
    whole = np.sum([part["load_share"] for part in answer["populations"]], axis=0)
    np.testing.assert_allclose(whole, answer["states"]["particle_load_share"], rtol=1e-12)
    assert [body["name"] for body in answer["inputs"]["particles"]] == ["dust", "debris"]


def test_json_keeps_the_place_of_an_unsolved_state():
    answer = json.loads(run("solve", EXAMPLE, "--json", "--set", "load.F_star=[1e-5, 1e3]").stdout)
    for part in answer["populations"]:
        assert part["load_share"][0] > 0
        assert part["load_share"][1] is None


def test_csv_has_columns_for_each_population(tmp_path):
    path = tmp_path / "states.csv"
    setting = ("--set", "load.pressure=[1e5, 5e6]")
    assert run("solve", EXAMPLE, "--csv", path, *setting).exit_code == 0
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    answer = json.loads(run("solve", EXAMPLE, "--json", *setting).stdout)
    for part in answer["populations"]:
        for name in ("F_sa_star", "A_sa", "load_share", "area_share"):
            column = head.index(f"{part['name']}: {name} [1]")
            assert [float(row[column]) for row in rows] == part[name]


def test_the_table_and_the_sentence_name_each_population():
    text = " ".join(run("solve", EXAMPLE, "--set", "load.pressure=80 kPa").stdout.split())
    for words in ("dust: load", "dust: area", "debris: load", "debris: area"):
        assert words in text
    share = tb.solve(load_study(EXAMPLE).contact, pressure=80e3).populations
    dust, debris = (f"{100 * part.load_share:.3g} %" for part in share)
    assert f"(dust {dust}, debris {debris})" in text


def test_laws_are_compared_with_several_populations():
    result = run("compare", EXAMPLE, "--laws", "zmc,ke", "--set", "load.pressure=5 MPa")
    assert result.exit_code == 0, result.stderr
    assert "particles' load" in result.stdout


def test_populations_may_be_uncertain(tmp_path):
    path = tmp_path / "study.toml"
    known = """
[uncertainty]
samples = 64
[uncertainty.inputs]
particles.0.areal_density = { median = "1e11 / m^2", gsd = 1.5 }
"particles.1.median" = { mean = "400 nm", std = "10 nm" }
"""
    path.write_text(EXAMPLE.read_text("utf-8") + known, "utf-8")
    result = run("assess", path, "--json", "--set", "load.pressure=5 MPa")
    assert result.exit_code == 0, result.stderr
    assert "particles.1.diameter.median" in result.stdout
