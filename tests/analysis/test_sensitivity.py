"""Sensitivities against differences of solved states, closed forms and changes of units."""

import contextlib
import functools
import io
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from refusals import Mistake, refuses
from scipy.optimize import brentq
from steel_and_dust import DUSTY, STEEL, TWO_BODY

import thirdbody as tb

# the laws are asked outside their ranges too: derivatives are exact there as well
pytestmark = pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")

BRONZE = tb.Material(E=110e9, nu=0.34, H=1.9e9)
PLANE = DUSTY.replace(particle_law=tb.particle.Series(deep="off", seat="plane"))
MONODISPERSE = PLANE.replace(
    surfaces=tb.MaterialPair(STEEL, BRONZE),
    **{"particles.diameter": tb.distributions.Monodisperse(mean=300e-9)},
)
EXPONENTIAL = TWO_BODY.replace(
    asperity_law=tb.asperity.GW(), **{"roughness.heights": tb.heights.ExponentialHeights()}
)
BOTH = {last: f"surfaces.first.{last}+surfaces.second.{last}" for last in ("E", "nu", "H")}
PARTICLES = ("particles.diameter.mean", "particles.areal_density")
COLUMNS = ("A_t", "d", "A_e", "A_p", "particle_load_share", "F_ss_star")


def value(contact, name):
    for part in name.split("."):
        contact = getattr(contact, part)
    return contact


def moved(contact, label, t):
    """The contact with an input changed by the factor 1 + t."""
    return contact.replace(**{n: value(contact, n) * (1 + t) for n in label.split("+")})


def richardson(f, step):
    """f′(0) from central differences extrapolated to a step of zero."""
    row = [(f(h) - f(-h)) / (2 * h) for h in step / 2.0 ** np.arange(5)]
    for m in range(1, 5):
        row = [(4**m * b - a) / (4**m - 1) for a, b in zip(row, row[1:], strict=False)]
    return row[0]


CASES = {
    "two-body": (TWO_BODY, ("roughness.sigma", "roughness.alpha", BOTH["H"])),
    "CEB": (TWO_BODY.replace(asperity_law=tb.asperity.CEB()), ("roughness.R", BOTH["nu"])),
    "KE": (TWO_BODY.replace(asperity_law=tb.asperity.KE()), ("roughness.sigma", BOTH["E"])),
    "Hermite": (TWO_BODY.replace(asperity_law=tb.asperity.Hermite()), ("roughness.R", BOTH["H"])),
    "rough seat": (DUSTY, ("roughness.sigma", "particles.diameter.n", *PARTICLES)),
    "plane seat": (PLANE, ("roughness.R", "particles.diameter.std", *PARTICLES)),
    "one size, two metals": (MONODISPERSE, ("surfaces.first.E", "surfaces.second.H", *PARTICLES)),
    "published": (
        DUSTY.replace(particle_law=tb.particle.Horng2022()),
        ("roughness.sigma", "particle_law.chi", *PARTICLES),
    ),
}


@pytest.mark.spread(3)
@pytest.mark.parametrize("load", [{"F_star": 1e-5}, {"pressure": 1e7}], ids=["F*", "pressure"])
@pytest.mark.parametrize("case", CASES)
def test_every_derivative_equals_differences_of_solved_states(case, load):
    contact, labels = CASES[case]
    names = COLUMNS if not contact.two_body else COLUMNS[:4]
    got = tb.sensitivity(contact, of=names, to=labels, **load)
    for label in labels:
        start = value(contact, label.split("+")[0])

        @functools.cache
        def at(t, label=label):
            return tb.solve(moved(contact, label, t), **load)

        def column(name, at=at):
            return lambda t: getattr(at(t), name)

        for name in names:
            expected = richardson(column(name), 4e-3) / start
            scale = abs(expected) + abs(got.value[name] / start)
            assert got.derivative[name][label] == pytest.approx(expected, rel=0, abs=1e-8 * scale)
            assert got.error[name][label] <= 1e-8 * scale
            assert got.status[name][label] == "ok"


def test_derivative_with_the_load():
    got = tb.sensitivity(DUSTY, of=["A_t", "d"], to="pressure", pressure=5e6)
    for name in ("A_t", "d"):
        expected = richardson(
            lambda t, name=name: getattr(tb.solve(DUSTY, pressure=5e6 * (1 + t)), name), 4e-3
        )
        assert got.derivative[name]["pressure"] * 5e6 == pytest.approx(expected, rel=1e-9)


# -------------------------------------------------------------------------- closed forms
def test_exponential_heights_on_elastic_asperities_obey_power_laws():
    """A = const·p·√(R/σ_s)/E*, d = σ_s ln(const·ηR^½ σ_s^1.5 E*/p)."""
    labels = (
        *("roughness.sigma", "roughness.R", "roughness.alpha", "roughness.eta_R_sigma"),
        *(BOTH["E"], BOTH["H"], "pressure"),
    )
    got = tb.sensitivity(EXPONENTIAL, of=["A_t", "d"], to=labels, pressure=1e5)
    of_alpha = 0.5 * (0.8968 / 5) / (1 - 0.8968 / 5)  # d ln σ_s / d ln α
    area = got.elasticity["A_t"]
    expected = (-0.5, 0.5, -0.5 * of_alpha, 0, -1, 0, 1)
    assert [area[label] for label in labels] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    sigma_s, d = EXPONENTIAL.roughness.sigma_s, got.value["d"]
    # η = β/(Rσ)
    change = [d + 0.5 * sigma_s, -0.5 * sigma_s, (d + 1.5 * sigma_s) * of_alpha]
    change += [sigma_s, sigma_s, 0, -sigma_s]
    separation = [got.elasticity["d"][label] * d / sigma_s for label in labels]
    expected = np.array(change) / sigma_s
    assert separation == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_given_density_takes_the_place_of_the_product():
    contact = EXPONENTIAL.replace(**{"roughness.eta": 1.6e11})
    got = tb.sensitivity(contact, of="d", to=["roughness.eta", "roughness.R"], pressure=1e5)
    sigma_s = contact.roughness.sigma_s
    assert got.derivative["d"]["roughness.eta"] * 1.6e11 == pytest.approx(sigma_s, rel=1e-9)
    assert got.derivative["d"]["roughness.R"] * 2.8e-6 == pytest.approx(sigma_s / 2, rel=1e-9)


@pytest.mark.parametrize("nu", [0.5, 0.498, 0.29, 0.0])
def test_poisson_ratio_up_to_the_end_of_its_range(nu):
    contact = EXPONENTIAL.replace(**{"surfaces.first.nu": nu})
    got = tb.sensitivity(contact, of="A_t", to="surfaces.first.nu", pressure=1e5)
    # A ∝ 1/E*, 1/E* = Σ(1 − ν²)/E
    expected = -2 * nu / STEEL.E * contact.E_ss * got.value["A_t"]
    assert got.derivative["A_t"]["surfaces.first.nu"] == pytest.approx(
        expected, rel=1e-8, abs=1e-9 * got.value["A_t"]
    )


def test_round_tips_are_the_middle_between_two_orientations():
    """λ and 1/λ are the same tips: the area is even in ln λ."""
    contact = TWO_BODY.replace(asperity_law=tb.asperity.EllipticZMC())
    got = tb.sensitivity(contact, of="A_t", to="asperity_law.ratio", pressure=1e6)
    assert abs(got.elasticity["A_t"]["asperity_law.ratio"]) < 1e-8


def test_at_given_separation_particles_count_one_by_one():
    d = 250e-9
    got = tb.sensitivity(DUSTY, of=["A_sa", "A_ss"], to="particles.areal_density", d=d)
    shadow = tb.solve(DUSTY, d=d).shadow
    assert got.elasticity["A_sa"]["particles.areal_density"] == pytest.approx(1, rel=1e-10)
    assert got.elasticity["A_ss"]["particles.areal_density"] == pytest.approx(
        -shadow / (1 - shadow), rel=1e-8
    )


def test_at_given_separation_the_load_falls_as_its_analytic_slope():
    from thirdbody.contact.interface import interface

    d = np.array([150e-9, 250e-9, 400e-9])
    got = tb.sensitivity(DUSTY, of="pressure", to="d", d=d)
    expected = interface(DUSTY).load(d)[:, 1]
    assert got.derivative["pressure"]["d"] == pytest.approx(expected, rel=1e-9)


LENGTHS = {
    "roughness.sigma": 1,
    "roughness.R": 1,
    "particles.diameter.mean": 1,
    "particles.diameter.std": 1,
    "particles.areal_density": -2,
}


@pytest.mark.parametrize("contact", [DUSTY, PLANE], ids=["rough", "plane"])
@pytest.mark.parametrize("given", ["F_star", "pressure"])
def test_change_of_units(contact, given):
    """Euler: lengths × L and stresses × S change a column by the powers of its dimension."""
    contact = contact.replace(**{"particles.material": STEEL})
    load = {"F_star": 2e-5} if given == "F_star" else {"pressure": 2e6}
    columns = {"A_t": (0, 0), "A_e": (0, 0), "shadow": (0, 0), "d": (1, 0), "pressure": (0, 1)}
    got = tb.sensitivity(contact, of=list(columns), **load)
    assert set(LENGTHS) < set(got.inputs)
    stresses = [
        label for label in got.inputs if label.endswith((".E", ".H")) or label == "pressure"
    ]
    assert len(stresses) == (4 if given == "pressure" else 3)
    for name, (length, stress) in columns.items():
        row = got.elasticity[name]
        assert sum(n * row[label] for label, n in LENGTHS.items()) == pytest.approx(
            length, abs=1e-8
        )
        assert sum(row[label] for label in stresses) == pytest.approx(stress, abs=1e-8)
        assert max(abs(row[label]) for label in LENGTHS) > 0.01 or name == "pressure"


# -------------------------------------------------------------------------- critical loads
def critical_load(contact, share, level, near):
    """The load F* at which a share has its value, by bisection on d."""
    d = tb.solve(contact, F_star=near).d

    def excess(x):
        return getattr(tb.solve(contact, d=x), share) - level

    root = brentq(excess, 0.97 * d, 1.03 * d, xtol=1e-24, rtol=1e-15)
    return tb.solve(contact, d=root).F_star


def load_of_largest_share(contact, near):
    """The load F* at which the particles' share of the area is largest, from its slope in d."""
    d = tb.solve(contact, F_star=near).d

    def slope(x):
        h = 5e-11
        at = tb.solve(contact, d=x + h * np.array([-2, -1, 1, 2])).particle_area_share
        return at @ [1, -8, 8, -1]

    root = brentq(slope, 0.98 * d, 1.02 * d, xtol=1e-24, rtol=1e-14)
    return tb.solve(contact, d=root).F_star


@pytest.mark.spread(3)
@pytest.mark.parametrize(
    ("contact", "name", "share", "level"),
    [
        (DUSTY, "F_cr1", "particle_area_share", 0.98),
        (PLANE, "F_cr2", "particle_area_share", 0.05),
        (PLANE, "F_tpca.B", "particle_load_share", 0.5),
        (DUSTY, "F_tpca.B", "particle_load_share", 0.5),
    ],
)
def test_critical_loads(contact, name, share, level):
    labels = ["roughness.sigma", *PARTICLES]
    got = tb.sensitivity(contact, of=name, to=labels)
    near = got.value[name]
    assert near == pytest.approx(critical_load(contact, share, level, near), rel=1e-11)
    for label in labels:
        expected = richardson(
            lambda t, label=label: critical_load(moved(contact, label, t), share, level, near), 2e-3
        )
        assert got.elasticity[name][label] == pytest.approx(expected / near, rel=1e-8, abs=1e-8)


def test_load_of_the_largest_share():
    labels = ["roughness.sigma", "particles.areal_density", "particles.diameter.mean"]
    got = tb.sensitivity(PLANE, of="F_tpca.A", to=labels)
    near = got.value["F_tpca.A"]
    assert near == pytest.approx(load_of_largest_share(PLANE, near), rel=1e-7)
    for label in labels:
        expected = richardson(
            lambda t, label=label: load_of_largest_share(moved(PLANE, label, t), near), 4e-3
        )
        assert got.elasticity["F_tpca.A"][label] == pytest.approx(
            expected / near, rel=1e-6, abs=1e-6
        )


def test_critical_loads_without_a_derivative_say_why():
    got = tb.sensitivity(PLANE, of=["F_cr1", "F_tpca.C"], to="roughness.sigma")
    assert got.status["F_cr1"]["roughness.sigma"] == "never p-s"
    assert "grid" in got.status["F_tpca.C"]["roughness.sigma"]
    assert math.isnan(got.derivative["F_cr1"]["roughness.sigma"])
    assert math.isnan(got.derivative["F_tpca.C"]["roughness.sigma"])


def test_critical_loads_do_not_know_the_given_load():
    got = tb.sensitivity(DUSTY, of=["F_cr1", "A_t"], to="pressure", pressure=5e6)
    assert got.derivative["F_cr1"]["pressure"] == 0
    assert got.derivative["A_t"]["pressure"] > 0


# -------------------------------------------------------------------------- where it is not smooth
@pytest.mark.parametrize("contact", [TWO_BODY, PLANE], ids=["two-body", "particles"])
def test_hardness_of_one_of_two_equal_bodies_has_two_slopes(contact):
    got = tb.sensitivity(contact, of="A_t", to="surfaces.first.H", pressure=1e7)
    assert math.isnan(got.derivative["A_t"]["surfaces.first.H"])
    words = got.status["A_t"]["surfaces.first.H"]
    below = float(words.split("jumps: ")[1].split()[0])
    above = float(words.split(" and ")[1].split()[0])

    def one_sided(step):
        """f′ on the side of the step, extrapolated."""
        area = [
            tb.solve(moved(contact, "surfaces.first.H", h), pressure=1e7).A_t
            for h in (0, step, step / 2, step / 4, step / 8)
        ]
        row = [(a - area[0]) / h for a, h in zip(area[1:], step / 2.0 ** np.arange(4), strict=True)]
        for m in range(1, 4):
            row = [(2**m * b - a) / (2**m - 1) for a, b in zip(row, row[1:], strict=False)]
        return row[0] / STEEL.H

    assert below == pytest.approx(one_sided(-1e-3), rel=2e-5)
    assert above == pytest.approx(one_sided(1e-3), rel=2e-5, abs=2e-5 * abs(below))
    assert abs(below - above) > 0.01 * abs(below)


def test_slopes_that_hardly_jump_are_their_mean():
    """With equal bodies the larger of two footprints changes from one to the other."""
    got = tb.sensitivity(DUSTY, of=["A_t", "shadow"], to="surfaces.first.E", pressure=1e7)
    words = got.status["A_t"]["surfaces.first.E"]
    sides = float(words.split("jumps: ")[1].split()[0]), float(words.split(" and ")[1].split()[0])
    slope, error = (part["A_t"]["surfaces.first.E"] for part in (got.derivative, got.error))
    assert sides[0] != sides[1]
    assert slope == pytest.approx(sum(sides) / 2, rel=1e-5)
    assert error == pytest.approx(abs(sides[1] - sides[0]) / 2, rel=0.1)
    assert math.isnan(got.derivative["shadow"]["surfaces.first.E"])


def test_estimated_error_where_a_distribution_ends():
    """At d = 0 the last exponential height is reached: the power law holds above it only."""
    d = 1e-5 * EXPONENTIAL.roughness.sigma_s
    load = tb.solve(EXPONENTIAL, d=d).pressure
    got = tb.sensitivity(EXPONENTIAL, of="A_t", to="roughness.sigma", pressure=load)
    area, error = got.value["A_t"], got.error["A_t"]["roughness.sigma"]
    wrong = abs(got.derivative["A_t"]["roughness.sigma"] + 0.5 * area / 100e-9)
    assert wrong <= error
    doubtful = error * 100e-9 > 1e-6 * area
    assert got.status["A_t"]["roughness.sigma"].startswith("uncertain" if doubtful else "ok")


# -------------------------------------------------------------------------- form
def test_several_loads_at_once():
    loads = np.array([1e-6, 1e-5, 1e3])
    got = tb.sensitivity(TWO_BODY, of=["A_t", "d"], to=["roughness.sigma", "F_star"], F_star=loads)
    for i, load in enumerate(loads[:2]):
        one = tb.sensitivity(
            TWO_BODY, of=["A_t", "d"], to=["roughness.sigma", "F_star"], F_star=load
        )
        for name in ("A_t", "d"):
            for label in ("roughness.sigma", "F_star"):
                assert got.elasticity[name][label][i] == pytest.approx(
                    one.elasticity[name][label], rel=1e-9
                )
    assert np.isnan(got.derivative["A_t"]["roughness.sigma"][2])
    assert "no equilibrium" in got.status["A_t"]["roughness.sigma"][2]
    data = json.loads(json.dumps(got.to_dict(), allow_nan=False))
    assert data["derivative"]["A_t"]["roughness.sigma"][2] is None
    assert data["elasticity"]["d"]["F_star"][1] == got.elasticity["d"]["F_star"][1]


SAND = tb.Particles(
    material=tb.materials["quartz"],
    areal_density=1e7,
    diameter=tb.distributions.PowerLaw(edges=(5e-6, 40e-6), counts=(1,), slopes=(3,)),
    strength=tb.grains.WeibullStrength.of(tb.materials["quartz"]),
)
FEW_BREAK = ("particles.strength.m", "roughness.sigma", "surfaces.first.E+surfaces.second.E")


@pytest.mark.spread(3)
@pytest.mark.parametrize(
    ("contact", "loads", "to"),
    [
        (DUSTY, {"F_star": np.array([1e-7, 1e-5, 1e-3])}, None),
        (PLANE, {"pressure": np.array([1e5, 1e7])}, None),
        (DUSTY.replace(particles=SAND), {"d": np.array([5e-6, 2e-5])}, FEW_BREAK),
        (TWO_BODY, {"F_star": np.array([1e-6])}, None),
    ],
    ids=["rough", "plane", "breaking", "two-body"],
)
def test_quick_ones_have_three_digits(contact, loads, to):
    of = ["A_t", "h"] + ["particle_load_share"] * (not contact.two_body)
    slow = tb.sensitivity(contact, of=of, to=to, **loads)
    fast = tb.sensitivity(contact, of=of, to=to, **loads, quick=True)
    assert fast.inputs.keys() == slow.inputs.keys()
    for name in of:
        for label in slow.inputs:
            assert fast.elasticity[name][label] == pytest.approx(
                slow.elasticity[name][label], rel=1e-3, abs=1e-6
            ), (name, label)
            assert set(fast.status[name][label]) == {"ok"}


def test_quick_ones_make_no_tables(monkeypatch):
    """The tables of particles that break take a second for every changed input."""
    from thirdbody.contact.broken_averages import BrokenAverage

    contact = DUSTY.replace(particles=SAND)
    tb.solve(contact, d=5e-6)
    monkeypatch.setattr(BrokenAverage, "_table", lambda *_: pytest.fail("a table is made"))
    found = tb.sensitivity(contact, of="A_t", to=FEW_BREAK[0], d=5e-6, quick=True)
    assert found.status["A_t"][FEW_BREAK[0]] == "ok"


def test_loads_that_nothing_carries():
    got = tb.sensitivity(TWO_BODY, of="A_t", to=["roughness.sigma", "F_star"], F_star=[1e3, 1e4])
    assert np.all(np.isnan(got.derivative["A_t"]["F_star"]))
    with pytest.raises(tb.errors.NoEquilibrium):
        tb.sensitivity(TWO_BODY, of="A_t", to="roughness.sigma", F_star=1e3)


def test_table_puts_the_strongest_input_first():
    got = tb.sensitivity(TWO_BODY, of=["A_p", "A_t"], to=["roughness.R", BOTH["E"]], F_star=1e-5)
    lines = got.table().splitlines()
    assert lines[0].split() == ["input", "A_p", "A_t"]
    assert [line.split()[0] for line in lines[1:]] == [BOTH["E"], "roughness.R"]
    assert float(lines[1].split()[1]) == pytest.approx(got.elasticity["A_p"][BOTH["E"]], abs=1e-4)


@pytest.mark.parametrize(
    ("arguments", "refusal"),
    [
        ({"of": "mode", "F_star": 1e-5}, refuses(Mistake.OPTION, "of", value="'mode'")),
        ({"of": [], "F_star": 1e-5}, refuses(Mistake.EMPTY, "of")),
        ({"of": "A_t"}, refuses(Mistake.MISSING, "", says="F_star")),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "roughness.sigmaa"},
            refuses(Mistake.UNKNOWN, "to", value="'roughness.sigmaa'", meant="roughness.sigma"),
        ),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "roughness.eta"},
            refuses(Mistake.MISSING, "to", value="'roughness.eta'"),
        ),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "particle_law.seat"},
            refuses(Mistake.BEYOND, "to", value="'particle_law.seat'"),
        ),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "asperity_law.K"},
            refuses(Mistake.BEYOND, "to", value="'asperity_law.K'"),
        ),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "pressure"},
            refuses(Mistake.MISSING, "to", value="'pressure'"),
        ),
        (
            {"of": "A_t", "F_star": 1e-5, "to": "roughness.R+particle_law.h_0"},
            refuses(Mistake.BEYOND, "to", value="'roughness.R+particle_law.h_0'"),
        ),
    ],
)
def test_bad_requests_say_what_is_wrong(arguments, refusal):
    contact = DUSTY.replace(asperity_law=tb.asperity.CEB())
    with refusal:
        tb.sensitivity(contact, **arguments)


def test_particles_that_are_not_there():
    with refuses(Mistake.BEYOND, "to", value="'particles.areal_density'"):
        tb.sensitivity(TWO_BODY, of="A_t", to="particles.areal_density", F_star=1e-5)
    got = tb.sensitivity(TWO_BODY, of="A_t", F_star=1e-5)
    assert not any(label.startswith("particle") for label in got.inputs)


def test_the_page_shows_what_its_code_prints():
    page = (Path(__file__).parents[2] / "docs" / "sensitivities.md").read_text("utf-8")
    code, table = re.findall(r"```(?:python)?\n(.*?)```", page, re.S)[:2]
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(code, {})
    shown = [line for line in table.splitlines() if line != "..."]
    assert len(shown) == 7
    assert set(shown) <= set(printed.getvalue().splitlines())


def test_columns_tell_their_unit_or_where_it_stands():
    asked = {"to": ["roughness.sigma", "roughness.R"], "F_star": 1e-5}
    one = tb.sensitivity(TWO_BODY, of="h", **asked).to_dataset()
    told = {name: column.attrs.get("units") for name, column in one.data_vars.items()}
    wanted = {"derivative": "1", "error": "1", "elasticity": "1", "value": "m", "input": "m"}
    assert told == wanted | {"status": None}
    two = tb.sensitivity(TWO_BODY, of=["h", "A_t"], **asked).to_dataset()
    for name in ("derivative", "error", "value"):
        assert two[name].attrs["units_in"] in two.coords
