"""ISO 281: values, joints, and the order in which oils come out."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.systems import bearing_life as life
from thirdbody.systems.oil_particles import FilmParticles

SHARED = Path(__file__).parents[2].parent / "shared" / "reference" / "outputs.json"
STEEL = tb.materials["S45C"]


def rows():
    return [(place, code) for place, codes in life.OILS.items() for code in codes]


@pytest.mark.parametrize(
    ("found", "value"),
    [
        (life.contamination_factor("bath", "-/13/10", kappa=1.0, D=0.05), 0.6058794417456915),
        (life.contamination_factor("filter", "-/15/12", kappa=0.5, D=0.1), 0.266417409789721),
        (life.life_factor("ball", kappa=0.7, load=0.1), 1.1272377659617676),
        (life.life_factor("ball", kappa=2.0, load=0.3), 41.752416748831635),
        # a published rating: grease, slight contamination, a large bearing
        (
            life.contamination_factor(
                "grease", "slight contamination", kappa=4.0, D=3.391171771851255
            ),
            0.888378,
        ),
    ],
)
def test_values(found, value):
    assert found == pytest.approx(value, rel=1e-12)


def test_reference_file():
    if not SHARED.exists():
        pytest.skip("the reference values are not beside the project")
    values = {each["id"]: each["value"] for each in json.loads(SHARED.read_text())["values"]}
    below = life.life_factor("ball", kappa=0.4 * (1 - 1e-9), load=0.1)
    assert below == pytest.approx(values["aISO_ball_jump_0.4"], rel=1e-7)


@pytest.mark.parametrize(("bearing", "at_04"), [("ball", 3.9e-4), ("roller", 3e-6)])
def test_branches_join(bearing, at_04):
    """An exponent of 0.019087 in the middle branch, as one implementation has it, would not."""
    for kappa, step in ((0.4, at_04), (1.0, 1e-11)):
        below = life.life_factor(bearing, kappa=kappa * (1 - 1e-14), load=0.1)
        above = life.life_factor(bearing, kappa=kappa, load=0.1)
        assert abs(below / above - 1) <= step


def test_reference_viscosity():
    # 45000/(500^0.83 √50) and 4500/√(1500·50), by logarithms
    slow = math.exp(math.log(45000) - 0.83 * math.log(500) - 0.5 * math.log(50))
    assert life.reference_viscosity(500 / 60, D=0.05) * 1e6 == pytest.approx(slow, rel=1e-12)
    assert life.reference_viscosity(25.0, D=0.05) * 1e6 == pytest.approx(4500 / math.sqrt(75000))
    joint = [life.reference_viscosity(f * 1000 / 60, D=0.05) for f in (1 - 1e-12, 1 + 1e-12)]
    assert joint[0] / joint[1] == pytest.approx(1.0232, abs=1e-4)
    assert life.viscosity_ratio(2 * joint[1], turns=1000.0001 / 60, D=0.05) == pytest.approx(
        2, rel=1e-6
    )


def test_order_of_oils_films_and_bearings():
    """Cleaner code, larger κ, larger D: a larger factor."""
    for codes in life.OILS.values():
        for kappa in (0.2, 1.0, 4.0):
            found = [
                life.contamination_factor(place, code, kappa=kappa, D=0.2)
                for place, each in life.OILS.items()
                for code in each
                if each is codes
            ]
            assert all(np.diff(found) < 0)
    greases = [life.contamination_factor("grease", g, kappa=1.0, D=0.2) for g in life.GREASES]
    assert all(np.diff(greases) < 0)
    for place, code in [*rows(), *(("grease", g) for g in life.GREASES)]:
        for D in (0.1, 0.3):
            by_kappa = [
                life.contamination_factor(place, code, kappa=k, D=D) for k in (0.1, 0.3, 1, 4)
            ]
            assert all(np.diff(by_kappa) >= 0)
            assert by_kappa[0] < by_kappa[-1] <= 1
        by_size = [
            life.contamination_factor(place, code, kappa=0.7, D=d) for d in (0.07, 0.1, 0.3, 0.9)
        ]
        assert all(np.diff(by_size) > 0)


def test_dents_come_out_in_the_same_order():
    """What the standard calls cleaner leaves fewer dents here; a thicker film too."""

    def index(code, film):
        oil = FilmParticles.from_iso4406(
            code,
            surfaces=tb.MaterialPair(STEEL, STEEL),
            material=tb.materials["SiO2"],
            film=film,
            entry=1.0,
        )
        return oil.severity_index().total / film

    codes = ("15/13/10", "17/15/12", "19/17/14", "21/19/16", "23/21/18")
    dents = [index(code, 0.5e-6) for code in codes]
    factors = [life.contamination_factor("bath", code, kappa=1.0, D=0.1) for code in codes]
    assert all(np.diff(dents) > 0)
    assert all(np.diff(factors) < 0)
    # per volume of oil that passes: more film brings more oil, too
    films = [index("18/16/13", h) for h in (0.2e-6, 0.5e-6, 1e-6, 3e-6)]
    assert all(np.diff(films) < 0)


def test_life_factor_grows_and_is_capped():
    for bearing in life.BEARINGS:
        for kappa in (0.1, 0.3, 0.8, 2.0, 4.0):
            by_load = [life.life_factor(bearing, kappa=kappa, load=u) for u in (0.01, 0.1, 1, 5)]
            assert all(np.diff(by_load) >= 0)
            assert max(by_load) <= life.MOST
        assert life.life_factor(bearing, kappa=4.0, load=5.0) == life.MOST
        assert life.life_factor(bearing, kappa=0.1, load=1e-3) == pytest.approx(0.1, rel=1e-3)
        nine = life.life_factor(bearing, kappa=9.0, load=0.1)
        assert nine == life.life_factor(bearing, kappa=4.0, load=0.1)


def test_a_code_between_rows_takes_the_dirtier():
    found = life.contamination_factor("bath", "18/16/13", kappa=1.0, D=0.1)
    assert found == life.contamination_factor("bath", "-/17/14", kappa=1.0, D=0.1)
    # one number of the row below is not enough
    assert found == life.contamination_factor("bath", "-/15/13", kappa=1.0, D=0.1)


def test_large_greased_bearings():
    here, beyond = (
        life.contamination_factor("grease", "slight contamination", kappa=1.0, D=D)
        for D in (0.4999999999, 0.5)
    )
    c = 0.0177 * 500**0.55
    assert here == pytest.approx(c * (1 - 1.887 / 500 ** (1 / 3)), rel=1e-8)
    assert beyond == pytest.approx(c * (1 - 1.677 / 500 ** (1 / 3)), rel=1e-8)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: life.contamination_factor("bath", "-/13/10", kappa=0.05, D=0.1), "at least 0.1"),
        (lambda: life.contamination_factor("bath", "-/22/19", kappa=1, D=0.1), "dirtier"),
        (lambda: life.contamination_factor("filter", "-/19/16", kappa=1, D=0.01), "above 0.0128"),
        (lambda: life.contamination_factor("can", "-/13/10", kappa=1, D=0.1), "filter"),
        (lambda: life.contamination_factor("grease", "dirty", kappa=1, D=0.1), "normal"),
        (lambda: life.contamination_factor("bath", "-/13/10", kappa=1, D=-0.1), "above 0"),
        (lambda: life.life_factor("needle", kappa=1, load=0.1), "roller"),
        (lambda: life.life_factor("ball", kappa=1, load=0.0), "above 0"),
        (lambda: life.life_factor("ball", kappa=math.nan, load=0.1), "kappa"),
        (lambda: life.reference_viscosity(0.0, D=0.1), "turns"),
    ],
)
def test_refusals(make, message):
    with pytest.raises(tb.errors.InvalidValue, match=message):
        make()


def test_rows_from_memory_are_marked():
    assert ("bath", "-/13/10") not in life.FROM_MEMORY
    assert len(life.FROM_MEMORY) == len(rows()) - 1 + len(life.GREASES)
