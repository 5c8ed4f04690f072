"""Forces on bodies: Hertz pressures, integrals over the contact, and the study that gives newtons."""

import math
import tomllib

import numpy as np
import pytest
from refusals import Mistake, refuses
from steel_and_dust import DUSTY, STEEL
from steel_and_dust import TWO_BODY as CLEAN

import thirdbody as tb
from thirdbody.errors import InvalidValue, code_of
from thirdbody.quantities.say import percent, value_of
from thirdbody.reference import elliptic_hertz
from thirdbody.study import check, run_film, run_study
from thirdbody.study.analyses import assess_study
from thirdbody.study.toml import override
from thirdbody.systems.bodies import (
    BODIES,
    BallInGroove,
    BallOnFlat,
    Cylinders,
    Flat,
    Roller,
    press,
)
from thirdbody.systems.rough_body import rough_cylinder, rough_sphere
from thirdbody.views.film_words import summary

E = CLEAN.E_ss
STUDY = """
[surfaces]
first = "S45C"
second = "S45C"
[roughness]
sigma = "100 nm"
R = "2.8 um"
[body]
kind = "ball-on-flat"
diameter = "6 mm"
[load]
force = "10 N"
"""


def study(*overrides, more=""):
    return check(override(tomllib.loads(STUDY + more), overrides))


def test_hertz_of_every_kind():
    ball = BallOnFlat(diameter=10e-3).hertz(30.0, E)
    a = (0.75 * 30 * 5e-3 / E) ** (1 / 3)
    assert ball.area == pytest.approx(math.pi * a * a, rel=1e-12)
    assert ball.maximum == pytest.approx(1.5 * ball.mean, rel=1e-12)
    roller = Roller(diameter=10e-3, length=8e-3, track_diameter=40e-3).hertz(1e3, E)
    R = 1 / (200 + 50)
    assert roller.maximum == pytest.approx(math.sqrt(1e3 / 8e-3 * E / (math.pi * R)), rel=1e-12)
    outer = Roller(diameter=10e-3, length=8e-3, track_diameter=40e-3, ring="outer")
    assert outer.conjunction.R == pytest.approx(1 / (200 - 50), rel=1e-12)
    pair = Cylinders(first_diameter=10e-3, second_diameter=40e-3, length=8e-3).hertz(1e3, E)
    assert pair == pytest.approx(roller, rel=1e-12)
    flat = Flat(area=2e-4, bodies=2).hertz(100.0, E)
    assert (flat.mean, flat.maximum) == (250e3, 250e3)


def test_curvatures_of_a_ball_in_its_groove():
    """Curvatures of the races as books on bearings have them."""
    D, d_m, beta, f = 8e-3, 50e-3, math.radians(40), 0.52
    gamma = D * math.cos(beta) / d_m
    for ring, sign in (("inner", -1), ("outer", 1)):
        body = BallInGroove(
            diameter=D, pitch_diameter=d_m, contact_angle=beta, conformity=f, ring=ring
        )
        found = body.conjunction
        track = -sign * 2 * gamma / (D * (1 + sign * gamma))
        assert 1 / found.R == pytest.approx(2 / D + track, rel=1e-12)
        assert 1 / found.R_y == pytest.approx(2 / D - 1 / (f * D), rel=1e-12)
    straight = BallInGroove(diameter=D).conjunction
    assert straight.R == D / 2
    shape = elliptic_hertz(straight.R_y / straight.R)
    assert shape.root_R_F > 0


def test_a_shared_force_is_a_smaller_force():
    one = press(CLEAN, BallInGroove(diameter=6e-3), 50.0)
    many = press(CLEAN, BallInGroove(diameter=6e-3, bodies=60), 3000.0)
    assert (many.mean, many.real_area) == (one.mean, one.real_area)


@pytest.mark.parametrize("contact", [CLEAN, DUSTY], ids=["clean", "dusty"])
def test_the_integral_is_that_of_the_rough_body(contact):
    found = press(contact, BallOnFlat(diameter=10e-3), 5.0)
    exact = rough_sphere(contact, radius=5e-3, load=5.0)
    assert found.method == "rough body"
    assert found.real_area == pytest.approx(exact.real_area, rel=1e-5)
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-4)
    share = None if contact.two_body else pytest.approx(exact.particle_load_share, rel=1e-5)
    assert found.particle_load_share == share
    line = press(contact, Roller(diameter=10e-3, length=5e-3), 100.0)
    exact = rough_cylinder(contact, radius=5e-3, load=100.0 / 5e-3)
    assert line.real_area == pytest.approx(5e-3 * exact.real_area, rel=1e-5)


def test_the_integral_over_pressure_is_the_sum_of_places():
    """Against midpoints of the area of an ellipse."""
    body = BallInGroove(diameter=6e-3)
    found = press(DUSTY, body, 20.0)
    assert found.method == "Hertz pressure"
    s = (np.arange(4000) + 0.5) / 4000
    p = found.maximum * np.sqrt(1 - s)
    state = tb.solve(DUSTY, pressure=p)
    assert found.real_area == pytest.approx(found.area * np.mean(state.A_t), rel=1e-4)
    carried = np.mean(p * state.particle_load_share) / np.mean(p)
    assert found.particle_load_share == pytest.approx(carried, rel=1e-4)
    assert np.mean(p) == pytest.approx(found.mean, rel=1e-6)


def test_heavy_loads_are_told():
    found = press(CLEAN, BallOnFlat(diameter=6e-3), 300.0)
    assert found.maximum > 0.6 * STEEL.H
    (sentence,) = found.warnings
    assert code_of(sentence) == "bodies.yield"
    assert "0.6 H" in sentence
    below = press(CLEAN, BallOnFlat(diameter=6e-3), 50.0, integrate=False)
    assert below.maximum < 0.6 * STEEL.H
    assert below.warnings == ()
    flat = press(CLEAN, Flat(area=1e-6), 0.4 * STEEL.H * 1e-6, integrate=False)
    assert "Y = 0.375 H" in flat.warnings[0]


def test_a_study_is_solved_at_both_pressures():
    found = study()
    hertz = BallOnFlat(diameter=6e-3).hertz(10.0, E)
    assert found.load == "pressure"
    np.testing.assert_array_equal(found.values, [hertz.mean, hertz.maximum])
    result = run_study(found)
    (force,) = result["body"]["forces"]
    assert (force["mean"], force["maximum"]) == (hertz.mean, hertz.maximum)
    assert result["states"]["pressure"] == [hertz.mean, hertz.maximum]
    (sentence,) = result["body"]["sentences"]
    assert "mean pressure" in sentence
    assert "(rough body)" in sentence
    many = study("load.force={from=1, to=100, points=5}")
    assert len(many.values) == 10
    told = run_study(many)["body"]["forces"]
    assert [bool(each["method"]) for each in told] == [True, False, False, False, True]


def test_other_loads_are_as_they_were():
    found = study("load.pressure=5 MPa")
    assert found.values.tolist() == [5e6]
    assert "body" not in run_study(found)
    assert [*map(code_of, found.notes)] == ["idle.body"]


def test_an_assessment_of_a_force():
    ranges = '[uncertainty]\nsamples = 64\ninputs = { "roughness.R" = { low = 2e-6, high = 3e-6 } }'
    page = assess_study(study(more=ranges))
    assert page.propagation.loads == study().values[0]
    (force,) = run_study(study())["body"]["forces"]
    for each in ("10 N", force["kind"], value_of(force["mean"], "Pa")):
        assert each in page.notes[0]


def test_a_film_between_the_bodies():
    oil = '[film]\nspeed = "0.5 m/s"\noil = { eta = "60 mPa s", alpha = "20 / GPa" }'
    given = study(more=oil).film
    assert (given.conjunction, given.load) == (tb.films.Point(R=3e-3), 10.0)
    shared = study("body.bodies=4", more=oil)
    assert shared.film.load == 2.5
    assert run_film(shared)["states"]["pressure"] == [pytest.approx(shared.values[0], rel=1e-9)]
    with refuses(Mistake.SHAPE, "load.force", says="1 N"):
        study("load.force=[1, 2]", more=oil)
    with refuses(Mistake.MISSING, "film"):
        study('body={kind="flat", area="1 cm^2"}', more=oil)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ('body={kind="ball"}', ["body.kind", "ball-on-flat"]),
        ('body={kind="roller"}', ["body.diameter is missing", "body.length is missing"]),
        ("load.force=3 MPa", ["a force [N] is needed"]),
        ("load.force=-3", ["must be > 0 [N]"]),
        ("body.diameter=7.938", ["body.diameter = 7.938 has no unit", '"7.938 mm" meant']),
        (
            'body={kind="ball-in-groove", diameter=7.938, pitch_diameter="38.5 mm"}',
            ["body.diameter = 7.938 has no unit", '"7.938 mm" meant'],
        ),
        (
            'body={kind="roller", diameter=4, length=6}',
            ['"4 mm" meant', "body.length = 6 has no unit"],
        ),
        ('body.length="3 mm"', ['goes with kind = "roller"']),
        ('load={force="3 N", pressure="3 MPa"}', ["only one of these"]),
    ],
)
def test_mistakes(change, words):
    with pytest.raises(InvalidValue) as caught:
        study(change)
    for word in words:
        assert any(word in problem for problem in caught.value.problems)


def test_a_force_needs_a_body():
    data = tomllib.loads(STUDY)
    del data["body"]
    with refuses(Mistake.MISSING, "load.force", value="10 N"):
        check(data)


def test_every_kind_survives_the_round_trip():
    sizes = dict(
        diameter=1e-2, length=1e-2, first_diameter=1e-2, second_diameter=1e-2, area=1e-4,
        bore=2e-2, outer_diameter=6e-2, ball_diameter=1e-2, roller_diameter=1e-2, balls=8,
        rollers=8, pitch_diameter=4e-2, lead=1e-2, rows=2, pinion_teeth=20, wheel_teeth=60,
        module=2e-3, face_width=2e-2,
    )  # fmt: skip
    for kind in BODIES.values():
        body = kind(**{name: size for name, size in sizes.items() if name in kind.__slots__})
        assert kind.from_dict(body.to_dict()) == body


def test_a_film_says_how_often_its_contact_meets_a_particle():
    more = """
[film]
speed = "1 m/s"
oil = { eta = "20 mPa s", alpha = "20 / GPa" }
[particles]
material = "SiO2"
distribution = "log-normal"
median = "1 um"
gsd = 1.3
areal_density = "1e6 / m^2"
"""
    asked = study(more=more)
    found = run_film(asked)
    area = BallOnFlat(diameter=6e-3).hertz(10.0, asked.contact.E_ss).area
    assert found["particles_held"] == pytest.approx(1e6 * area, rel=1e-12)
    assert any("one contact in" in text.lower() for text in summary(found))
    assert run_film(study(more=more.split("[particles]")[0]))["particles_held"] is None


DUST = tb.Particles(material=tb.materials["quartz"], areal_density=1e8,
                    diameter=tb.distributions.Monodisperse(mean=2e-6))  # fmt: skip


def test_contacts_with_and_without_a_particle_each_carry_the_load():
    """99 of 100 faces hold no particle: their area and load are those of the clean face."""
    dusty, face = CLEAN.replace(particles=DUST), Flat(area=1e-10)
    found = press(dusty, face, 1e-5)
    clean = press(CLEAN, face, 1e-5)
    assert found.particles_held == pytest.approx(0.01, rel=1e-12)
    assert found.without_particles["share"] == pytest.approx(np.exp(-0.01), rel=1e-12)
    assert found.without_particles["real_area"] == clean.real_area
    assert found.without_particles["particle_load_share"] == 0
    assert found.particle_load_share <= 0.01
    one = press(dusty.replace(particles=DUST.replace(areal_density=1e10)), face, 1e-5)
    assert found.with_particles["particle_load_share"] == pytest.approx(
        one.particle_load_share, rel=0.01
    )
    assert "asperities carry the whole load" in found.sentence()
    crowd = press(dusty, Flat(area=1e-6), 0.1)
    assert crowd.with_particles is None
    assert crowd.particle_load_share == pytest.approx(
        tb.solve(dusty, pressure=1e5).particle_load_share, rel=1e-12
    )


def test_particles_are_counted_on_the_area_that_carries():
    """A light ball rests on many grains far outside Hertz's area: it meets more than one."""
    bronze = tb.materials["CuSn8"]
    contact = tb.Contact(surfaces=tb.MaterialPair(bronze, bronze), particles=DUST,
                         roughness=tb.Roughness(sigma=300e-9, R=10e-6))  # fmt: skip
    ball = BallOnFlat(diameter=3e-3)
    light, bare = (press(contact, ball, 1e-3, integrate=whole) for whole in (True, False))
    assert bare.particles_held == pytest.approx(1e8 * bare.area, rel=1e-12)
    assert light.particles_held > 100 * bare.particles_held
    # what the area must be at least, to carry so much at no more than the largest pressure
    largest = light.with_particles["peak_pressure"]
    assert light.particles_held >= 0.9 * 1e8 * 1e-3 / largest


OUTPUTS = """
[particles]
material = "SiO2"
mean = "1 um"
areal_density = "1e8 / m^2"
distribution = "monodisperse"
[outputs.dents]
"""


def test_the_largest_dent_is_of_the_area_that_is_printed():
    """Hertz's of one force, the face of a flat body, what the file says; else a reason."""
    area = BallOnFlat(diameter=6e-3).hertz(10.0, E).area
    assert study(more=OUTPUTS).contact.outputs[0].A_n == pytest.approx(area, rel=1e-12)
    said = study(more=OUTPUTS + 'A_n = "3 mm^2"')
    assert said.contact.outputs[0].A_n == pytest.approx(3e-6)
    several = study("load.force=[1, 10]", more=OUTPUTS)
    assert several.contact.outputs[0].A_n == 1e-6
    assert "dents.area.largest" in map(code_of, several.notes)
    assert study("load.pressure=5 MPa", more=OUTPUTS).contact.outputs[0].A_n == 1e-6


def test_a_probability_without_an_area_has_a_reason():
    more = "\n[outputs.electrical_conductance]\n"
    bronze = ("surfaces.first=CuSn8", "surfaces.second=CuSn8")
    found = study(*bronze, more=more)
    assert found.contact.outputs[0].A_n is None
    closed = "electrical_conductance.area.closed"
    (told,) = [note for note in found.notes if code_of(note) == closed]
    assert "gc_closed" in told
    assert run_study(found)["warnings"].count(told) == 1
    given = study(*bronze, more=more + 'A_n = "1e-4 mm^2"\n')
    assert not any("without A_n" in note for note in given.notes)


@pytest.mark.slow
def test_what_is_said_last_is_of_the_bodies():
    """States at Hertz's pressures are not the answer where the integral says another thing."""
    from thirdbody.views.state_words import answer, details

    light = study("load.force=1 mN", "body.diameter=3 mm", "roughness.sigma=300 nm", more=OUTPUTS)
    result = run_study(light)
    (force,) = result["body"]["forces"]
    told = result.body_sentence()
    assert f"{percent(force['particle_load_share'])} under 0.001 N" in told
    assert details(result)[-1] == told
    first = answer(result)[0]
    assert first.startswith("Under 0.001 N ")
    assert first.endswith(f"{percent(force['particle_load_share'])}.")
    even = study("load.pressure=5 MPa", more=OUTPUTS)
    assert run_study(even).body_sentence() == ""
