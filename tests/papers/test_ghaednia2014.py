"""The reconstructed model of Ghaednia, Jackson and Gao (2014): limits, ledger, files."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from refusals import refuses
from scipy.integrate import quad

import thirdbody as tb
from thirdbody import InvalidValue
from thirdbody.contact.particle_sums import particle_sum
from thirdbody.errors import Mistake
from thirdbody.papers import ghaednia2013, ghaednia2014
from thirdbody.papers.ghaednia2014 import PRESSURES, READINGS, STUDY, conductance_ratio, contact
from thirdbody.papers.ledger import NO_SOURCE, OWN, REPORTED, SEEN
from thirdbody.papers.panels import table_of

STATED = ("elastic", "elastic-plastic", "stack")


def over_heights(rough, d, power):
    """∫ t^n φ over the asperities above d, heights in σ_s; √t as variable."""
    h = d / rough.sigma_s
    return quad(
        lambda u: 2 * u ** (2 * power + 1) * math.exp(-0.5 * (h + u * u) ** 2),
        0,
        3,
        epsabs=0,
        epsrel=1e-12,
    )[0] / math.sqrt(2 * math.pi)


# ------------------------------------------------------------------ limits
def test_without_particles_it_is_greenwood_and_williamson():
    bare = contact().replace(particles=None)
    rough = bare.roughness
    state = tb.solve(bare, pressure=1e6)
    area = math.pi * rough.density * rough.R * rough.sigma_s * over_heights(rough, state.d, 1)
    load = 4 / 3 * bare.E_ss * rough.density * math.sqrt(rough.R) * rough.sigma_s**1.5
    assert state.A_t == pytest.approx(area, rel=1e-8)
    assert load * over_heights(rough, state.d, 1.5) == pytest.approx(1e6, rel=1e-8)


def test_too_few_particles_change_nothing():
    assert_allclose(READINGS["elastic"].trend(density=1e-9).ratio, 1, rtol=1e-6)


def test_particles_smaller_than_the_gap_change_nothing():
    d = tb.solve(contact(), pressure=1e5).d
    small = contact(size=0.2)
    assert small.particles.diameter.support[1] < 0.5 * d
    assert READINGS["elastic"].trend(1e5, size=0.2).ratio[0] == pytest.approx(1, rel=1e-12)


def test_rigid_particles_of_one_size_indent_the_steel_alone():
    """A = η_a π (x/2) (δ/2) with p = η_a (4/3) E₁* √(x/2) (δ/2)^1.5, E₁* of one steel half-space."""
    dusty = contact(stiffness=1e6, size=5.0).replace(
        **{"particles.diameter": tb.distributions.Monodisperse(mean=1e-6)}
    )
    p, x, eta = 1e5, 1e-6, dusty.particles.areal_density
    steel = tb.materials["S45C"]
    half = (p / (eta * 4 / 3 * steel.plane_strain_modulus * math.sqrt(x / 2))) ** (2 / 3)
    state = tb.solve(dusty, pressure=p)
    assert state.A_ss < 1e-12 * state.A_sa
    assert state.d == pytest.approx(x - 2 * half, rel=1e-5)
    assert state.A_t == pytest.approx(eta * math.pi * x / 2 * half, rel=1e-5)


def test_hertzian_particles_of_one_size_alone_have_two_thirds():
    dusty = contact(size=5.0).replace(
        **{"particles.diameter": tb.distributions.Monodisperse(mean=1e-6)}
    )
    state = tb.solve(dusty, pressure=np.geomspace(1e4, 1e6, 9))
    n = np.diff(np.log(state.A_t)) / np.diff(np.log(state.pressure))
    assert_allclose(n, 2 / 3, rtol=1e-9)


def test_load_per_particle_of_the_reference(shared_reference):
    stored = shared_reference("laws.json")["particles_elastic_gw"]["values"]
    unit = tb.Material(E=2.0, nu=0.0, H=0.02)
    dust = tb.Particles(
        material=unit,
        diameter=tb.TruncatedGaussian(mean=1.0, std=0.25, n=12),
        areal_density=1e-2,
    )
    law = contact().particle_law
    response = particle_sum(law, tb.MaterialPair(unit, unit), tb.Roughness(sigma=1.0, R=1e3), dust)
    for row in stored:
        load = response.fields(np.array([row["gap"]]))["F_sa"][0] / dust.areal_density
        expected = float(row["F_per_particle"])
        assert load * dust.diameter.retained_mass == pytest.approx(expected, rel=1e-10)


def test_loads_and_areas_add():
    dusty = contact()
    state = tb.solve(dusty, pressure=3e6)
    bare = tb.solve(dusty.replace(particles=None), d=state.d)
    assert bare.A_t == pytest.approx(state.A_ss, rel=1e-9)
    assert bare.F_star == pytest.approx(state.F_ss_star, rel=1e-9)
    assert state.A_t == pytest.approx(state.A_ss + state.A_sa, rel=1e-12)


# ------------------------------------------------------------------ conductance
@pytest.mark.parametrize("pressure", [5e5, 3e6, 3e7])
def test_conductance_is_the_sum_of_the_radii(pressure):
    """Stiffness gives the same as 2k Σ b, b = √(Rω) of asperities, √(x δ/4) of particles."""
    dusty = contact()
    rough, sizes = dusty.roughness, dusty.particles.diameter
    d = tb.solve(dusty, pressure=pressure).d
    bare = tb.solve(dusty.replace(particles=None), pressure=pressure).d

    def asperities(at):
        scale = rough.density * math.sqrt(rough.R * rough.sigma_s)
        return 2 * scale * over_heights(rough, at, 0.5)

    low, high = max(d, sizes.support[0]), sizes.support[1]
    particles = quad(
        lambda u: (
            2 * u * float(sizes.pdf(low + u * u)) * math.sqrt((low + u * u) * (low - d + u * u) / 4)
        ),
        0,
        math.sqrt(high - low),
        epsabs=0,
        epsrel=1e-10,
    )[0]
    particles *= 2 * dusty.particles.areal_density  # two constrictions of 4kb in series
    insulating = asperities(d) / asperities(bare)
    conducting = (asperities(d) + particles) / asperities(bare)
    p = np.array([pressure])
    assert conductance_ratio("elastic", p)[0] == pytest.approx(insulating, rel=1e-7)
    assert conductance_ratio("elastic", p, conducting=True)[0] == pytest.approx(
        conducting, rel=1e-7
    )


def test_conducting_particles_must_be_elastic():
    with pytest.raises(InvalidValue, match="elastic"):
        conductance_ratio("elastic-plastic", PRESSURES, conducting=True)


# ------------------------------------------------------------------ ledger
@pytest.fixture(scope="module")
def ledger(ledger_of):
    return ledger_of(STUDY)


VERDICTS = {
    "area": ("pass", "pass", "pass"),
    "conduction": ("pass", "pass", "not reproduced"),
    "dust": ("pass", "pass", "fail"),
    **dict.fromkeys(
        ("linear", "both-carry", "size", "size-small", "density", "stiffness", "hardness"),
        ("not sourced",) * 3,
    ),
}


@pytest.mark.check
def test_verdicts(ledger):
    stated = [claim.id for claim in STUDY.claims if claim.standing != OWN]
    assert {id: tuple(ledger[name][id].word for name in STATED) for id in stated} == VERDICTS


def test_nothing_is_claimed_to_have_been_read():
    standings = {claim.id: claim.standing for claim in STUDY.claims}
    assert set(standings.values()) == {REPORTED, SEEN, NO_SOURCE, OWN}
    assert [id for id, standing in standings.items() if standing == SEEN] == ["dust"]


@pytest.mark.parametrize(
    ("reading", "claim", "values"),
    [
        ("elastic", "area", [0.06915, 0.9404]),
        ("elastic-plastic", "area", [0.2793, 0.9977]),
        ("stack", "area", [0.008703, 0.009002]),
        ("elastic", "conduction", [0.9494]),
        ("elastic", "conducting", [2.595]),
        ("elastic", "linear", [0.8379, 2.498]),
        ("elastic-plastic", "linear", [0.8532, 1.881]),
        ("elastic-plastic", "linear-particles", [1.041, 1.160]),
        ("elastic", "linear-bare", [0.8496, 0.9640]),
        ("elastic-plastic", "size", [0.5745]),
        ("elastic-plastic", "size-small", [1.697]),
        ("elastic-plastic", "density", [1.705]),
        ("elastic-plastic", "stiffness", [0.8333]),
        ("elastic", "density-alone", [1.302]),
        ("elastic-plastic", "density-alone", [0.9473]),
        ("elastic", "too-elastic", [1.676]),
        ("elastic-plastic", "end", [4.05e6]),
        ("elastic-plastic", "soft", [0.2349]),
        ("elastic-plastic", "sharp", [14.0]),
    ],
)
def test_values(ledger, reading, claim, values):
    assert ledger[reading][claim].measured.values == pytest.approx(values, rel=2e-3)


def test_the_ends_are_where_the_area_is_that_of_bare_surfaces(ledger):
    for name in ("elastic", "elastic-plastic"):
        reading = READINGS[name]
        soft = ledger[name]["soft"].measured.values[0]
        assert reading.trend(1e5, stiffness=soft).ratio[0] == pytest.approx(1, abs=1e-6)
        assert reading.trend(1e5, stiffness=0.9 * soft).ratio[0] > 1
        sharp = ledger[name]["sharp"].measured.values[0]
        assert reading.trend(1e5, sharpness=1.1 * sharp).ratio[0] > 1
        end = ledger[name]["end"].measured.values[0]
        assert np.all(reading.trend(np.geomspace(1.03 * end, 1e8, 9)).ratio > 0.9)


def test_bare_asperities_are_elastic():
    """Their mean pressure stays below 0.4 H, where yield begins; the elastic particles' does not."""
    trend = READINGS["elastic"].trend()
    assert np.max(trend.pressure / trend.bare_area) < 0.4 * tb.materials["S45C"].H


def test_particles_press_the_area_by_the_ratio_of_mean_pressures():
    """Where particles carry all, A/A_bare is what the two mean pressures say."""
    trend = READINGS["elastic-plastic"].trend(1e5)
    assert trend.load_share[0] > 0.9995
    assert trend.ratio[0] * (1e5 / trend.area[0]) == pytest.approx(1e5 / trend.bare_area[0])


# ------------------------------------------------------------------ files
@pytest.mark.slow
@pytest.mark.parametrize("module", [ghaednia2013, ghaednia2014], ids=["2013", "2014"])
def test_files(module, tmp_path, ledger_of, monkeypatch):
    study, stages, ledger = module.STUDY, [], ledger_of(module.STUDY)
    monkeypatch.setattr(type(study), "ledger", lambda self: ledger)
    done = module.reproduce(tmp_path / "one", progress=lambda *step: stages.append(step))
    names = [f"fig{i + 1}" for i in range(len(study.panels))]
    expected = {f"{name}.{kind}" for name in names for kind in ("png", "svg", "csv")}
    expected |= {"claims.json", "index.html"}
    assert {path.name for path in done.out.iterdir()} - {"study.json"} == expected
    assert expected == set(done.files)
    assert {stage for stage, _, _ in stages} == {"claims", "figures", "page"}

    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    data = json.loads((done.out / "claims.json").read_text("utf-8"), parse_constant=refuse)
    assert [claim["id"] for claim in data["claims"]] == [claim.id for claim in study.claims]
    page = (done.out / "index.html").read_text("utf-8")
    assert not re.search(r"https?:|//[a-z]|<script|<link|@import|url\(", page)
    assert page.count("<figure ") == len(study.panels)
    assert all(f"id='{claim.id}'" in page for claim in study.claims)
    for name in study.readings:
        assert sum(done.counts(name).values()) == len(study.claims)
        assert any(name in line and "agree" in line for line in done.lines())
    # the same bytes again, with one of the panels and the page that holds it
    some = replace(study, panels=study.panels[:1])
    for folder in ("two", "three"):
        some.reproduce(tmp_path / folder)
    for path in (tmp_path / "two").iterdir():
        again = (tmp_path / "three" / path.name).read_bytes()
        assert path.read_bytes() == again, path.name
        assert path.name == "index.html" or again == (done.out / path.name).read_bytes()


@pytest.mark.parametrize("module", [ghaednia2013, ghaednia2014], ids=["2013", "2014"])
def test_presets_are_refused(module, tmp_path):
    with refuses(Mistake.IDLE, "preset", value="'published'"):
        module.reproduce(tmp_path / "x", preset="published")
    assert not (tmp_path / "x").exists()


def test_tables_hold_what_is_drawn():
    panel = STUDY.panels[1]()
    rows = table_of(panel).splitlines()
    assert rows[0] == "line,pressure_Pa,area_ratio"
    assert len(rows) == 1 + sum(len(line.x) for line in panel.lines)
