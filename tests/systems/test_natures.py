"""What populations are: do they conduct, dent, break; and what heeds it."""

import json
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses
from typer.testing import CliRunner

import thirdbody as tb
from thirdbody import cli
from thirdbody.effects import ElectricalConductance
from thirdbody.errors import InvalidValue
from thirdbody.laws.particle.tension import breaks
from thirdbody.populations.conduction import conducts
from thirdbody.study import check
from thirdbody.systems.connector import Connector
from thirdbody.systems.natures import natures

STEEL = tb.materials["S45C"]
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")


def grains(material="quartz", mean=5e-6, **more):
    found = tb.materials[material] if isinstance(material, str) else material
    sizes = tb.TruncatedGaussian(mean=mean, std=0.2 * mean)
    return tb.Particles(material=found, diameter=sizes, **{"areal_density": 1e8} | more)


def between(*dust, surface=STEEL, **more):
    return tb.Contact(
        surfaces=tb.MaterialPair(surface, surface),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=dust if len(dust) > 1 else dust[0],
        **more,
    )


@pytest.mark.parametrize(
    ("name", "flows"),
    [("S45C", True), ("Fe3O4", True), ("SnSb8Cu4", True), ("quartz", False), ("PTFE", False),
     ("soda-lime glass", False), ("WC", None), ("Al2O3", None)],
)  # fmt: skip
def test_the_material_says_whether_a_current_flows(name, flows):
    assert conducts(grains(name)) is flows
    own = tb.Material(E=1e11, nu=0.3, H=1e9)
    assert conducts(grains(own)) is None
    assert conducts(grains(own.replace(resistivity=1e-7))) is True
    assert conducts(grains(name, conducts=False)) is False
    assert conducts(grains(name, conducts=True)) is True


def current(*dust, **more):
    return tb.solve(between(*dust, outputs=ElectricalConductance(**more)), pressure=5e6).outputs


def test_a_population_says_itself_whether_it_conducts():
    """Under oxide it insulates, whatever the output says; the rest conducts as it would alone."""
    steel, other = grains("S45C", name="bright"), grains("S45C", mean=4e-6, name="rusty")
    both = current(steel, other, particles="by material")
    rusty = current(steel, other.replace(conducts=False), particles="by material")
    bright = current(steel.replace(conducts=False), other, particles="conduct")
    assert rusty["gc_sa"] > 0
    assert bright["gc_sa"] > 0
    assert rusty["gc_sa"] + bright["gc_sa"] == pytest.approx(both["gc_sa"], rel=1e-12)
    none = current(steel.replace(conducts=False), particles="by material")
    assert none["gc_sa"] == 0
    alone = current(steel.replace(conducts=True))
    assert alone["gc_sa"] == current(steel, particles="conduct")["gc_sa"]
    with pytest.raises(InvalidValue, match="resistivity"):
        current(grains("quartz", conducts=True))
    with pytest.raises(InvalidValue, match="resistivity"):  # a metal without a number
        current(grains("SnSb8Cu4"), particles="by material")
    with refuses(Mistake.CLASH, "outputs.electrical_conductance.A_n"):
        current(steel.replace(conducts=True), other, A_n=1e-10)


def test_heat_flows_whatever_is_said_of_current():
    heat = tb.outputs.ThermalConductance()
    found = [
        tb.solve(between(grains("S45C", conducts=each), outputs=heat), pressure=5e6).outputs["hc"]
        for each in (None, False)
    ]
    assert found[0] == found[1]


def test_a_connector_heeds_it():
    def fails(conducting=(), **more):
        bronze = tb.materials["CuSn8"]
        dust = grains("S45C", areal_density=1e6, name="debris", **more)
        pair = tb.MaterialPair(bronze, bronze)
        plug = Connector(radius=2e-3, surfaces=pair, particles=dust, conducting=conducting)
        return plug.failure(0.0), plug.failures([0.0])[0]

    assert fails() == fails("by material", conducts=False)
    assert fails("by material") == fails(conducts=True) == (0.0, 0.0)
    assert fails()[0] > 0


def test_what_is_much_harder_dents_and_what_is_softer_is_squashed():
    hard, equal, soft = (
        natures(between(grains(STEEL.replace(H=factor * STEEL.H))))[0] for factor in (50, 1, 0.05)
    )
    assert hard.pressed == "dents"
    assert hard.sinks == pytest.approx(1, abs=0.02)
    assert equal.pressed == soft.pressed == "is squashed"
    assert soft.sinks < equal.sinks < 0.2


def test_hardness_alone_decides_where_the_law_knows_no_sink():
    law = tb.particle.Series(deep="off")
    middle = between(grains("quartz"), surface=STEEL, particle_law=law)
    assert (natures(middle)[0].sinks, natures(middle)[0].pressed) == (None, "dents")
    pair = tb.MaterialPair(STEEL, tb.materials["Al2O3"])
    assert natures(middle.replace(surfaces=pair))[0].pressed == "dents the softer surface"
    whole = middle.replace(particle_law=tb.particle.Horng2022())
    assert (natures(whole)[0].pressed, natures(whole)[0].breaks) == ("dents", "not known")
    soft = between(grains("PTFE"), particle_law=law)
    assert natures(soft)[0].pressed == "is squashed"


def test_most_break_from_the_size_that_is_told():
    dust = grains("quartz", mean=20e-6)
    contact = between(dust, surface=tb.materials["100Cr6"])
    found = natures(contact)[0]
    one = contact.law_of(dust).one(surfaces=contact.surfaces, particle=dust.material)
    for factor, broken in ((1.01, True), (0.99, False)):
        x = factor * found.breaks_from
        assert breaks(one, dust.material, x=x, squeeze=1.0) is broken
    assert found.breaks == "would break"
    strong = tb.grains.WeibullStrength.of(dust.material)
    same = natures(contact.replace(particles=dust.replace(strength=strong)))[0]
    assert (same.breaks, same.breaks_from) == ("breaks", found.breaks_from)
    small = contact.replace(
        particles=dust.replace(diameter=tb.distributions.Monodisperse(mean=1e-6))
    )
    assert natures(small)[0].breaks == "stays whole"
    steel = contact.replace(particles=grains("S45C"))
    assert (natures(steel)[0].breaks, natures(steel)[0].breaks_from) == ("not known", None)


def study(**particles):
    table = {"material": "S45C", "distribution": "monodisperse", "mean": "5 um",
             "areal_density": "1e8 / m^2"}  # fmt: skip
    return {
        "surfaces": {"first": "S45C", "second": "S45C"},
        "roughness": {"sigma": "100 nm", "R": "2.8 um"},
        "particles": table | particles,
        "load": {"pressure": "5 MPa"},
    }


def test_a_study_file_says_whether_they_conduct():
    assert check(study()).contact.particles.conducts is None
    assert check(study(conducts=False)).contact.particles.conducts is False
    with refuses(Mistake.KIND, "particles.conducts", value='"no"'):
        check(study(conducts="no"))
    with refuses(Mistake.KIND, "Particles.conducts", value="1"):
        grains(conducts=1)


@pytest.mark.parametrize(
    "command", ["film", "solve", pytest.param("report", marks=pytest.mark.slow)]
)
def test_every_command_says_what_the_populations_are(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    run = CliRunner().invoke
    run(cli.app, ["new", "ball-screw"])
    done = run(cli.app, [command, "ball-screw.toml", "--set", "particles.conducts=false"])
    assert done.exit_code == 0, done.stderr
    told = done.stdout if command != "report" else Path("report.html").read_text("utf-8")
    told = " ".join(told.split())
    assert "S45C insulates, is squashed (5.5 % of it sinks in), and is kept whole, as no" in told
    if command != "report":
        (data,) = json.loads(run(cli.app, [command, "ball-screw.toml", "--json"]).stdout)["natures"]
        assert (data["conducts"], data["breaks"], data["breaks_from"]) == (True, "not known", None)
        assert np.isclose(data["sinks"], 0.055, atol=5e-4)
