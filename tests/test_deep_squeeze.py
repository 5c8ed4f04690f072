"""The computation of one squeezed particle gives answers known without it; so does its table."""

import functools
import importlib
import itertools
import json
import math
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parent.parent
TABLE = ROOT / "src" / "thirdbody" / "data" / "deep_squeeze.json"


@pytest.fixture(scope="module")
def table():
    return json.loads(TABLE.read_text("utf-8"))


def columns(curve, *names):
    """Columns of a curve as arrays, NaN where it ended early."""
    return [np.array([math.nan if v is None else v for v in curve[name]]) for name in names]


def held(table, rho, m, modulus="inf", surfaces=2):
    """The one curve of these inputs."""
    found = [
        c
        for c in table["curves"]
        if (c["rho"], c["m"], c["E_over_Y"], c["surfaces"]) == (rho, m, modulus, surfaces)
    ]
    assert len(found) == 1
    return found[0]


def test_every_number_has_an_error(table):
    assert table["eps"] == [round(0.05 * k, 2) for k in range(1, 20)]
    for curve, name in itertools.product(table["curves"], ("F", "A", "sink", "collar")):
        value, error = columns(curve, name, f"{name}_error")
        assert np.array_equal(np.isnan(value), np.isnan(error)), (curve["rho"], name)
        assert np.all(error[~np.isnan(error)] >= 0)
        if name in ("F", "A"):
            assert np.all(error[~np.isnan(error)] >= 0.01 * value[~np.isnan(value)] * 0.999)


def test_loads_and_areas_grow_with_the_squeeze(table):
    for curve in table["curves"]:
        load, area, error = columns(curve, "F", "A", "A_error")
        on = ~np.isnan(load)
        assert np.all(np.diff(load[on]) > 0), curve["rho"]
        # a particle that sinks whole no longer spreads: its area rests within its error
        assert np.all(np.diff(area[on]) > -error[on][1:]), curve["rho"]


def test_a_disc_holds_no_more_than_the_sphere(table):
    """A (1 - ε) <= 2/3: what lies between the contacts of two platens is part of the sphere."""
    for m in (1, 0.2, 0):
        (area,) = columns(held(table, 0, m), "A")
        assert np.all(area * (1 - np.array(table["eps"])) <= 2 / 3)


def test_a_rigid_particle_sinks_whole_and_a_rigid_surface_not_at_all(table):
    for curve in table["curves"]:
        (sink,) = columns(curve, "sink")
        e = np.array(table["eps"])  # with one surface the depth itself
        on = ~np.isnan(sink)
        if curve["rho"] == "inf":
            assert sink[on] == pytest.approx(e[on], rel=1e-3)
        elif curve["rho"] == 0:
            assert np.all(sink[on] == 0)
        else:
            assert np.all(sink[on] < e[on])


def test_friction_between_platens_raises_the_load(table):
    rough, some, smooth = (columns(held(table, 0, m), "F")[0] for m in (1, 0.2, 0))
    late = np.array(table["eps"]) >= 0.5  # before, contacts differ by more than friction does
    assert np.all(rough[late] > some[late])
    assert np.all(some[late] > smooth[late])


def test_a_soft_particle_is_squashed_as_between_platens(table):
    """ρ = 0.5: F/ρ is that of platens, as long as the surface is not yet pressed in."""
    early = np.array(table["eps"]) <= 0.6
    (soft,) = columns(held(table, 0.5, 1), "F")
    (platens,) = columns(held(table, 0, 1), "F")
    assert soft[early] / 0.5 == pytest.approx(platens[early], rel=0.04)


def test_the_weaker_of_two_gives_way(table):
    """A pair carries no more than 1.12 times the lesser of ρ platen(ε) and the rigid particle's load.

    Each is the load of one way to give way, an upper bound for the shape that it itself leads to;
    the pair's own shape differs.
    """
    early = np.array(table["eps"]) <= 0.5
    (platens,) = columns(held(table, 0, 1), "F")
    (hard,) = columns(held(table, "inf", 1), "F")
    for rho in (1, 1.4, 2, 3, 5):
        (load,) = columns(held(table, rho, 1), "F")
        bound = np.minimum(rho * platens, hard)
        assert np.all(load[early] < 1.12 * bound[early]), rho


def test_smooth_discs_come_to_the_yield_stress(table):
    """A thin disc between smooth platens is in plain compression: F/(π R² A) → Y."""
    load, area = columns(held(table, 0, 0), "F", "A")
    assert load[-1] / (math.pi * area[-1]) == pytest.approx(1, abs=0.02)


def test_rough_discs_come_to_the_friction_hill(table):
    """1 + 2 m a/(3 √3 h), at most; the disc's rim is not straight, so some per cent below."""
    load, area = columns(held(table, 0, 1), "F", "A")
    hill = 1 + np.sqrt(area[-1]) / (3 * math.sqrt(3) * 0.05)
    assert load[-1] / (math.pi * area[-1]) == pytest.approx(hill, rel=0.08)


def test_loads_are_those_of_an_independent_computation(table):
    """6 % of one made outside this project with other code, or its own error if larger."""
    known = {
        ("inf", 1): {0.2: 4.49, 0.3: 6.36, 0.5: 9.10},
        (3, 1): {0.2: 4.56, 0.5: 9.43},
        (2, 1): {0.2: 4.32, 0.5: 8.53},
        (1.4, 1): {0.2: 2.89, 0.5: 5.86},
        (1, 1): {0.2: 2.05, 0.5: 4.18},
        (0, 0.2): {0.5: 3.89},
        ("inf", 0): {0.2: 3.8, 0.5: 6.7},
    }
    for (rho, m), values in known.items():
        curve = held(table, rho, m)
        for epsilon, load in values.items():
            assert curve["F"][table["eps"].index(epsilon)] == pytest.approx(load, rel=0.06)


def test_a_second_run_lies_within_the_errors(table):
    """Every rigid-plastic curve was computed again by the script as it ships."""
    compared, loads = 0, []
    for curve in table["curves"]:
        if curve["E_over_Y"] != "inf":
            continue
        for name in ("F", "A", "sink"):
            first, second, error = columns(curve, name, f"{name}_again", f"{name}_error")
            both = ~np.isnan(first) & ~np.isnan(second)
            off = np.abs(second - first)[both]
            assert np.all(off <= error[both] + 1e-9), (curve["rho"], curve["m"], name)
            if name == "F":
                loads.extend(off / first[both])
        compared += 1
    assert compared == 28
    assert np.quantile(loads, 0.95) < 0.007  # as the note of the table says


def test_the_table_is_of_the_computation_that_ships(table, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    assert importlib.import_module("deep").source_hash() == table["provenance"]["sha256"]


@pytest.fixture
def room(monkeypatch):
    """Modules of benchmarks/squeeze, by name."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    return lambda name: importlib.import_module(f"squeeze.{name}")


@pytest.fixture(scope="module")
def flat_punch():
    """Pressures under a punch, from below and from above; each is computed once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "benchmarks"))
        yield functools.cache(importlib.import_module("squeeze.checks").flat_punch)


@pytest.mark.slow
@pytest.mark.parametrize(("rough", "low", "high"), [(True, 6.05, 6.05), (False, 5.69, 5.69)])
def test_a_flat_punch_lies_between_the_bounds_of_tresca(flat_punch, rough, low, high):
    """Circular punch: 6.05 k rough (Eason, Shield 1960), 5.69 k smooth (Shield 1955).

    Von Mises lies between Tresca with k = Y/2 and with k = Y/√3.
    """
    below, above = flat_punch(rough)
    assert low / 2 < below < high / math.sqrt(3)
    assert above == pytest.approx(below, rel=1e-3)


@pytest.mark.slow
def test_a_flat_punch_converges_with_triangles_and_domain(flat_punch):
    known = flat_punch(True)[0]
    assert flat_punch(True, size=0.05)[0] == pytest.approx(known, rel=0.02)
    assert flat_punch(True, domain=9.0)[0] == pytest.approx(known, rel=0.02)


@pytest.mark.slow
def test_a_disc_between_platens(room):
    checks = room("checks")
    assert checks.disc(0.0, 0.1) == pytest.approx(1, abs=1e-3)
    for m, half in ((0.2, 0.1), (0.2, 0.05), (1.0, 0.025)):
        found = checks.disc(m, half)
        assert found < checks.hill(m, half)
        assert found == pytest.approx(checks.hill(m, half), rel=0.04)


@pytest.mark.slow
def test_curves_keep_what_is_known_of_them(room):
    curves, shapes = room("curves"), room("shapes")
    coarse = shapes.sphere(shapes.Case(1.0), 12)
    fine = curves.refined(coarse, [0])
    assert curves.volume(fine) == pytest.approx(2 * math.pi / 3, rel=2e-3)
    assert np.hypot(*fine.T) == pytest.approx(np.ones(len(fine)), abs=2e-3)
    level = np.stack([np.linspace(0, 2, 50), np.full(50, 0.9)], 1)
    gap, _, foot = curves.nearest(level, shapes.sphere(shapes.Case(1.0), 2000))
    assert gap == pytest.approx(np.hypot(*level.T) - 1, abs=1e-5)
    assert foot == pytest.approx(level / np.hypot(*level.T)[:, None], abs=2e-3)


@pytest.mark.slow
def test_triangles_fill_a_body(room):
    mesh = room("mesh")
    made = room("checks").block([(0, 0), (2, 0), (2, 1), (1, 1)], np.array([[1.0, 1.0, 0.05]]))
    a, b, c = (made.x[made.triangles[:, k]] for k in range(3))
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert np.all(area > 0)
    assert area.sum() == pytest.approx(1.5)
    assert made.x[made.triangles[:, 3]] == pytest.approx((a + b) / 2)
    with pytest.raises(mesh.MeshError):
        mesh.build(np.array([[0, 0], [1, 1], [1, 0], [0, 1.0]]), np.array([[0, 0, 0.5]]), 4)


@pytest.mark.slow
def test_contact_ends_where_sphere_and_plane_cross(room):
    shapes = room("shapes")
    r = np.linspace(0, 3, 3000)
    for rho in (0.0, 1.0, math.inf):
        plane = np.stack([r, np.full_like(r, 0.9)], 1)
        case = shapes.Case(rho)
        shape = shapes.meet(case, shapes.sphere(case, 3000), plane, 0, 0.1)
        assert shape.edge[0] == pytest.approx(math.sqrt(1 - 0.81), abs=4e-3)
        assert shape.sink == pytest.approx({0.0: 0, 1.0: 0.05, math.inf: 0.1}[rho], abs=1e-3)


@pytest.mark.slow
def test_nothing_beside_the_rim_counts_as_touching(room):
    """Surface on z = 0 beside a rim that leans inwards: no contact there."""
    shapes = room("shapes")
    case = shapes.Case(1.0)
    lean = np.array([[1.0, 0.1], [1.1, 0.05], [1.05, 0.0]])
    particle = np.concatenate([np.stack([np.linspace(0, 1, 50), np.full(50, 0.1)], 1), lean[1:]])
    lower = np.stack([np.linspace(1.2, 4, 200), np.zeros(200)], 1)
    surface = np.concatenate([particle[:50], [[1.15, 0.06]], lower])
    shape = shapes.meet(case, particle, surface, 50, 0.9)
    assert shape.area < 1.1**2
    assert shape.edge[1] > 0.04


@pytest.mark.slow
@pytest.mark.parametrize(("rho", "m", "epsilon"), [(0.0, 1.0, 0.1), (1.0, 1.0, 0.02)])
def test_load_from_above_is_load_through_the_middle(room, rho, m, epsilon):
    case = room("shapes").Case(rho, m, fine=0.8, edge=0.015, step=0.016, tolerance=3e-5)
    states = list(room("squeeze").Squeezing(case).run(epsilon))
    for state in states:
        assert state.top_load == pytest.approx(state.load, rel=3e-3)
        assert state.load <= state.power * 1.003
    assert states[-1].mended < 0.01


@pytest.mark.slow
def test_a_coarse_run_comes_to_the_table(room, table):
    """Platens, m = 0.2: sizes 1.25 and steps 1.5 times those of the table."""
    case = room("shapes").Case(0.0, 0.2, fine=0.8, step=0.012)
    last = list(room("squeeze").Squeezing(case).run(0.3))[-1]
    curve = held(table, 0, 0.2)
    at = table["eps"].index(0.3)
    assert last.load == pytest.approx(curve["F"][at], rel=0.04)
    assert last.area == pytest.approx(curve["A"][at], rel=0.05)
