"""The nominal area of outputs, where a study says on which bodies its force acts."""

import pytest

from thirdbody.study.whole import check
from thirdbody.systems.bodies import BODIES

STEEL = {"E": "206 GPa", "nu": 0.29, "H": "3 GPa", "resistivity": 2e-7}
KINDS = {
    "flat": {"area": 1e-6},
    "ball-on-flat": {"diameter": "6 mm"},
    "ball-in-groove": {"diameter": "6 mm", "bodies": 3},
    "roller": {"diameter": "6 mm", "length": "5 mm"},
    "cylinders": {"first_diameter": "6 mm", "second_diameter": "9 mm", "length": "5 mm"},
    "ball-bearing": {
        "bore": "25 mm", "outer_diameter": "52 mm", "ball_diameter": "7.938 mm", "balls": 9,
    },
    "roller-bearing": {
        "bore": "25 mm", "outer_diameter": "52 mm", "roller_diameter": "7.5 mm",
        "length": "7.5 mm", "rollers": 12,
    },
    "ball-screw": {
        "diameter": "6.35 mm", "pitch_diameter": "40 mm", "lead": "10 mm", "balls": 6,
    },
    "linear-guide": {"diameter": "4 mm", "rows": 2, "balls": 12},
    "gear": {"pinion_teeth": 20, "wheel_teeth": 60, "module": "2 mm", "face_width": "20 mm"},
}  # fmt: skip


def study(kind, **changes):
    return check(
        {
            "surfaces": {"first": STEEL, "second": STEEL},
            "roughness": {"sigma": "100 nm", "R": "2.8 um"},
            "outputs": {"electrical_conductance": {}, "counts": {}},
            "body": {"kind": kind} | KINDS[kind],
            "load": {"force": 20.0},
        }
        | changes
    )


def areas(found):
    return [output.A_n for output in found.contact.outputs]


def test_every_kind_of_body_is_here():
    assert KINDS.keys() == BODIES.keys()


@pytest.mark.parametrize("kind", KINDS)
def test_outputs_take_the_area_of_a_flat_body_alone(kind):
    """A rough ball closes on more than Hertz's area: its closing is not asked of that."""
    assert areas(study(kind)) == ([1e-6] * 2 if kind == "flat" else [None] * 2)


@pytest.mark.parametrize("kind", KINDS)
def test_the_largest_dent_is_of_the_area_of_one_force(kind):
    found = study(kind, outputs={"dents": {}})
    area = 1e-6 if kind == "flat" else float(found.body.hertz(20.0, found.contact.E_ss).area)
    assert areas(found) == pytest.approx([area], rel=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_several_forces_have_no_one_area(kind):
    assert areas(study(kind, load={"force": [10.0, 20.0]})) == (
        [1e-6] * 2 if kind == "flat" else [None] * 2
    )


def test_an_area_that_is_given_stays():
    own = {"counts": {"A_n": 3e-6}}
    assert areas(study("ball-on-flat", outputs=own)) == [3e-6]
