"""The worked example of a design: an additive, against a grid and by its command."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.stats import norm

import thirdbody as tb
from thirdbody.analysis.inputs import words_of
from thirdbody.equilibrium.states import state_columns
from thirdbody.study import load_study
from thirdbody.study.analyses import arguments, design_study

EXAMPLE = Path(__file__).parents[2] / "examples" / "additive.toml"
# what is compared with a grid is compared without the table, on which the optimum is flatter
OFF = [
    "particle_law.name=series",
    "particle_law.deep=off",
    'design.limits=[{ of = "plastic_share", most = 0.2 }]',
]
# variance of a standard Gaussian cut at three standard deviations
CUT = 1 - 6 * norm.pdf(3) / (2 * norm.cdf(3) - 1)
SIZE, AMOUNT = "particles.diameter.mean+particles.diameter.std", "particles.concentration"


@pytest.fixture(scope="module")
def best():
    return design_study(load_study(EXAMPLE, OFF))


def number_of(size, weight):
    """Particles per area in 1 um of oil, from the definition of a concentration by weight."""
    volume = weight / 2200 / (weight / 2200 + (1 - weight) / 870)
    cube = size**3 * (1 + 3 * 0.1**2 * CUT)
    return volume / (np.pi / 6 * cube) * 1e-6


@pytest.mark.slow
def test_no_point_of_a_grid_is_better(best):
    study = load_study(EXAMPLE, OFF)
    size, weight = (
        v.ravel() for v in np.meshgrid(np.geomspace(5e-8, 1e-6, 60), np.geomspace(5e-4, 7e-3, 40))
    )
    density = number_of(size, weight)
    vary = {
        "particles.diameter.mean": size,
        "particles.diameter.std": 0.1 * size,
        "particles.areal_density": density,
    }
    every = [state_columns(study.contact, pressure=p, vary=vary) for p in (1e6, 2e6, 5e6, 1e7)]
    friction = np.mean([state["mu"] for state in every], axis=0)
    plastic = np.max([state["A_p"] / state["A_t"] for state in every], axis=0)
    covered = density * np.pi / 4 * size**2 * (1 + 0.1**2 * CUT)
    fine = (plastic <= 0.2) & (covered < 0.3)
    grid = int(np.argmin(np.where(fine, friction, np.inf)))
    assert best.objectives["mu"] <= friction[grid] * (1 + 1e-6)
    # and it is the same place, within a cell of the grid
    assert best.values[SIZE] == pytest.approx(size[grid], rel=20 ** (1 / 59) - 1)
    assert best.values[AMOUNT] == pytest.approx(weight[grid], rel=14 ** (1 / 39) - 1)
    # without the limit the best powder is another one
    free = int(np.argmin(np.where(covered < 0.3, friction, np.inf)))
    assert plastic[free] > 0.2
    assert best.active == ("plastic_share <= 0.2",)


@pytest.mark.check
def test_the_best_point_is_what_it_says(best):
    contact = best.contact
    x = best.values[SIZE]
    assert contact.particles.areal_density == pytest.approx(
        number_of(x, best.values[AMOUNT]), rel=1e-9
    )
    state = tb.solve(contact, pressure=[1e6, 2e6, 5e6, 1e7])
    assert state.outputs["mu"].mean() == pytest.approx(best.objectives["mu"], rel=1e-9)
    np.testing.assert_allclose(best.states["mu"], state.outputs["mu"], rtol=1e-9)


def test_slopes_hold_the_concentration(best):
    """Against differences of contacts that the fluid fills anew; the load is that in the middle."""

    def at(size, weight):
        made = best.contact.replace(
            **{
                "particles.diameter.mean": size,
                "particles.diameter.std": 0.1 * size,
                "particles.areal_density": number_of(size, weight),
            }
        )
        state = tb.solve(made, pressure=5e6)
        return {"mu": float(state.outputs["mu"]), "plastic_share": float(state.A_p / state.A_t)}

    x, c = best.values[SIZE], best.values[AMOUNT]
    step = 1e-3
    for name, up, down in (
        (SIZE, at(x * np.exp(step), c), at(x * np.exp(-step), c)),
        (AMOUNT, at(x, c * np.exp(step)), at(x, c * np.exp(-step))),
    ):
        for column in ("mu", "plastic_share"):
            slope = (up[column] - down[column]) / (2 * step)
            assert best.slopes[column][name] == pytest.approx(slope, rel=1e-4, abs=1e-6)


@pytest.mark.slow
def test_command(tmp_path):
    """One JSON object, a table of every point, a figure, and nothing else."""
    command = [sys.executable, "-m", "thirdbody", "design", EXAMPLE, "--json"]
    command += [word for setting in OFF for word in ("--set", setting)]
    command += ["--csv", tmp_path / "p.csv", "--figure", tmp_path / "p.png"]
    done = subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ,
    )
    told = json.loads(done.stdout)
    assert told["feasible"] is True
    assert told["objectives"]["mu"] < 0.17
    rows = list(csv.DictReader((tmp_path / "p.csv").open(encoding="utf-8")))
    # what a user waits for; benchmarks/waiting.py measures it
    assert len(rows) == len(told["points"]["mu"]) < 1000
    assert {row["feasible"] for row in rows} == {"True", "False"}
    assert told["plateau"].keys() <= told["tolerance"].keys()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.csv", "p.png"]
    assert told["at_bound"] == [AMOUNT]
    assert words_of(load_study(EXAMPLE).contact, AMOUNT) in done.stderr


# ---------------------------------------------------------------------------- mistakes in a file
def changed(*settings):
    return arguments(load_study(EXAMPLE, settings))


def test_the_file_says_what_python_says():
    asked = changed()
    assert list(asked["vary"]) == [SIZE, AMOUNT]
    np.testing.assert_allclose(list(asked["vary"].values()), [(5e-8, 1e-6), (5e-4, 7e-3)])
    assert asked["suspension"] == tb.objectives.Suspension(
        gap=1e-6, concentration=3e-3, particle_density=2200.0
    )
    assert asked["objective"] == [tb.objectives.Objective(of="mu")]
    assert asked["limits"] == [tb.objectives.Limit(of="plastic_share", most=0.5)]
    np.testing.assert_allclose(asked["pressure"], [1e6, 2e6, 5e6, 1e7])


def test_units_materials_and_loads():
    asked = changed(
        'design.limits=[{ of = "d", least = "100 nm" }]',
        'design.pressure={ from = "1 MPa", to = "9 MPa" }',
        'design.vary={ "particles.material" = ["quartz", "Al2O3"] }',
        'design.objective=[{ of = "mu" }, { of = "h", aim = "largest", over_loads = "worst" }]',
    )
    assert asked["limits"][0].least == pytest.approx(1e-7)
    assert (asked["pressure"].low, asked["pressure"].high) == (1e6, 9e6)
    assert [each.name for each in asked["vary"]["particles.material"]] == ["quartz", "Al2O3"]
    assert [each.label for each in asked["objective"]] == ["mu", "h:worst"]


@pytest.mark.parametrize(
    ("setting", "refusal"),
    [
        (
            'design.vary={ "particles.size" = { low = 1, high = 2 } }',
            refuses(Mistake.UNKNOWN, 'design.vary."particles.size"'),
        ),
        (
            'design.vary={ "roughness.sigma" = "50 nm" }',
            refuses(Mistake.KIND, 'design.vary."roughness.sigma"', value='"50 nm"'),
        ),
        (
            'design.vary={ "roughness.sigma" = { low = "1 s", high = 2 } }',
            refuses(Mistake.UNIT, 'design.vary."roughness.sigma".low'),
        ),
        (
            'design.vary={ "particles.material" = ["Unobtainium"] }',
            refuses(Mistake.UNKNOWN, 'design.vary."particles.material".0', value='"Unobtainium"'),
        ),
        (
            'design.vary={ "particles.concentration" = { low = "1 mg/L", high = "9 mg/L" } }',
            refuses(Mistake.KIND, 'design.vary."particles.concentration"'),
        ),
        (
            'design.objective={ aim = "smallest" }',
            refuses(Mistake.KIND, "design.objective", value='{ aim = "smallest" }'),
        ),
        (
            'design.objective={ of = "mu", aim = "least" }',
            refuses(Mistake.OPTION, "design.objective.aim", value='"least"', meant="largest"),
        ),
        (
            'design.objective={ of = "mu", goal = "smallest" }',
            refuses(Mistake.UNKNOWN, "design.objective.goal"),
        ),
        ('design.limits=[{ of = "mu" }]', refuses(Mistake.MISSING, "design.limits.0")),
        (
            'design.limits=[{ of = "d", most = "5 MPa" }]',
            refuses(Mistake.UNIT, "design.limits.0.most"),
        ),
        ("design.scatter=true", refuses(Mistake.MISSING, "design.scatter", says="[uncertainty]")),
        ("design.sample=3", refuses(Mistake.UNKNOWN, "design.sample", value="3", meant="samples")),
    ],
)
def test_mistakes_are_told_before_anything_is_computed(setting, refusal):
    with refusal:
        changed(setting)


def test_what_does_not_fit_the_contact_is_told():
    with refuses(Mistake.UNKNOWN, "design.objective.of", value='"muu"', meant="mu"):
        load_study(EXAMPLE, ['design.objective={ of = "muu" }'])
    density = 'design.vary={ "particles.areal_density" = { low = 1e9, high = 1e10 } }'
    with refuses(Mistake.CLASH, "particles.areal_density"):
        design_study(load_study(EXAMPLE, [density]))
    several = 'design.vary={ "particles.material" = ["quartz", "Al2O3"] }'
    with refuses(Mistake.CLASH, "Suspension.particle_density"):
        design_study(load_study(EXAMPLE, [several]))
    none = EXAMPLE.with_name("dusty_ball_screw.toml")
    with refuses(Mistake.MISSING, "design"):
        design_study(load_study(none))
