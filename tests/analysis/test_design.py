"""Designs: against brute force, and what no design may break."""

import itertools
import json
import re
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from refusals import Mistake, refuses

import thirdbody as tb
from thirdbody.analysis.design.design import design
from thirdbody.analysis.design.equal_share import equal_share_size
from thirdbody.analysis.design.front import front, hypervolume
from thirdbody.analysis.design.problem import Limit, Objective, Suspension
from thirdbody.analysis.inputs import words_of
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import code_of
from thirdbody.numerics.sampling import Span
from thirdbody.quantities import progress
from thirdbody.views.plot.design import plot_trials

STEEL, SILICA = tb.materials["S45C"], tb.materials["SiO2"]
SIZE = "particles.diameter.mean+particles.diameter.std"
LOADS = Span(1e-6, 1e-4)


def contact(sigma=100e-9, R=3.5e-6, **others):
    dust = tb.Particles(
        material=SILICA,
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=30e-9),
    )
    return tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL),
        roughness=tb.Roughness(sigma=sigma, R=R),
        particles=dust,
        **others,
    )


def brute(case, objective, x):
    """The objective on a list of sizes, contact by contact."""
    loads = np.geomspace(1e-6, 1e-4, 32)
    out = []
    for size in x:
        state = tb.solve(
            case.replace(**{"particles.diameter.mean": size, "particles.diameter.std": 0.1 * size}),
            F_star=loads,
        )
        values = getattr(state, objective.of)
        if objective.aim == "window":
            out.append(np.mean((values >= objective.low) & (values <= objective.high)))
        elif objective.over_loads == "mean":
            out.append(values.mean())
        else:
            out.append(values.max() if objective.aim == "smallest" else values.min())
    return np.array(out)


@pytest.mark.check
@pytest.mark.spread(2)
@pytest.mark.parametrize(
    "objective",
    [
        Objective(of="particle_load_share", aim="window"),
        Objective(of="A_ep", aim="smallest"),
        Objective(of="A_ep", aim="largest", over_loads="worst"),
    ],
    ids=lambda each: f"{each.of}-{each.aim}",
)
def test_brute_force(objective):
    best = design(contact(), vary={SIZE: (5e-8, 5e-7)}, objective=objective, F_star=LOADS)
    x = np.geomspace(5e-8, 5e-7, 150)
    values = brute(contact(), objective, x) * -objective.sign
    found = best.objectives[objective.label] * -objective.sign
    assert best.feasible
    # no point of a grid twice as dense is better, and the best of them is as good
    assert found >= values.max() - 1e-3 * abs(values.max())
    own = brute(contact(), objective, [best.values[SIZE]])[0]
    assert own == pytest.approx(best.objectives[objective.label], rel=1e-9)


@pytest.mark.slow
def test_two_numbers_and_a_material_beat_a_grid():
    vary = {
        SIZE: (5e-8, 5e-7),
        "particles.areal_density": (1e9, 1e11),
        "particles.material": [SILICA, STEEL],
    }
    objective = Objective(of="A_t")
    limit = Limit(of="plastic_share", most=0.2)
    best = design(contact(), vary=vary, objective=objective, limits=[limit], F_star=[1e-5, 1e-4])
    assert best.feasible
    x, eta = (
        v.ravel() for v in np.meshgrid(np.geomspace(5e-8, 5e-7, 20), np.geomspace(1e9, 1e11, 20))
    )
    for material in (SILICA, STEEL):
        area, plastic = [], []
        for F in (1e-5, 1e-4):
            states = state_columns(
                contact().replace(**{"particles.material": material}),
                F_star=F,
                vary={
                    "particles.diameter.mean": x,
                    "particles.diameter.std": 0.1 * x,
                    "particles.areal_density": eta,
                },
            )
            area.append(states["A_t"])
            plastic.append(states["A_p"] / states["A_t"])
        fine = np.max(plastic, axis=0) <= 0.2
        assert best.objectives["A_t"] <= np.mean(area, axis=0)[fine].min() * (1 + 1e-6)


@pytest.mark.slow
def test_turning_point_sizes():
    """x_a/σ of equal shares: made by an independent implementation, to its single method."""

    def case(**more):
        return contact(**more).replace(particle_law=tb.particle.Series(deep="off"))

    assert equal_share_size(case(), pressure=5e6) == pytest.approx(2.346, abs=5e-4)
    rougher = equal_share_size(case(sigma=300e-9), pressure=5e6)
    assert rougher == pytest.approx(1.601821441, rel=2e-6)
    # the rule of one ratio does not hold: it moves with load and density
    assert equal_share_size(case(), pressure=5e7) > 1.2 * equal_share_size(case(), pressure=5e5)
    state = tb.solve(
        case().replace(
            **{
                "particles.diameter.mean": 100e-9 * 2.3459897,
                "particles.diameter.std": 10e-9 * 2.3459897,
            }
        ),
        pressure=5e6,
    )
    assert state.particle_load_share == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(("number", "place"), [(1e-4, 2), (1e-3, 1), (1e-2, 2), (0.5, 0)])
def test_the_book_shows_the_sizes_of_equal_shares(number, place):
    """A cell of each row of the table in docs/design.md: one load of 1, 5 and 50 MPa."""
    page = (Path(__file__).parents[2] / "docs" / "design.md").read_text("utf-8")
    (row,) = re.findall(rf"^\| {number:g} \| (.*) \|$", page, re.M)
    sized = {
        "roughness.R": 3.5e-6,
        "particles.areal_density": number / 100e-9**2,
        "particles.diameter.mean": 30e-9,
        "particles.diameter.std": 3e-9,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tb.errors.RangeWarning)  # far squeezed, as the page says
        size = equal_share_size(contact().replace(**sized), pressure=[1e6, 5e6, 5e7][place])
    assert row.split(" | ")[place] == f"{size:.2f}"


@pytest.mark.slow
def test_window_is_a_share_and_wider_limits_never_hurt():
    window = Objective(of="particle_load_share", aim="window")
    few = dict(vary={SIZE: (5e-8, 5e-7)}, F_star=LOADS, points=24)
    free = design(contact(), objective=window, **few)
    assert 0 <= free.objectives[window.label] <= 1
    values = [
        design(contact(), objective=window, limits=[Limit(of="plastic_share", most=m)], **few)
        for m in (0.01, 0.03, 1.0)
    ]
    found = [best.objectives[window.label] for best in values if best.feasible]
    assert found == sorted(found)
    assert found[-1] == pytest.approx(free.objectives[window.label])


def scattered(objective, **asked):
    """The objective at the first eight points."""
    found = design(contact(), objective=objective, **asked)
    return found.points[objective.label].values[:8]


@pytest.mark.slow
def test_scatter():
    objective = Objective(of="A_t", over_scatter="worst")
    some = dict(vary={SIZE: (5e-8, 5e-7)}, F_star=[1e-5], points=8)
    nothing = tb.Uncertain.uniform(low=100e-9 * (1 - 1e-12), high=100e-9 * (1 + 1e-12))
    still = design(
        contact(), objective=objective, scatter={"roughness.sigma": nothing}, samples=4, **some
    )
    nominal = design(contact(), objective=objective, **some)
    (found,), (same,) = still.objectives.values(), nominal.objectives.values()
    assert found == pytest.approx(same, rel=1e-9)
    wide = {
        "roughness.sigma": (60e-9, 160e-9),
        SIZE: tb.Uncertain.lognormal(median=300e-9, gsd=1.2),
    }
    costs = {
        how: scattered(Objective(of="A_t", over_scatter=how), scatter=wide, samples=4, **some)
        for how in ("mean", "worst", "tail", "robust")
    }
    assert np.all(costs["worst"] >= costs["tail"] - 1e-15)
    assert np.all(costs["tail"] >= costs["mean"])
    assert np.all(costs["robust"] >= costs["mean"])
    # samples of one seed are common to all points, and of another they are others
    again = scattered(objective, scatter=wide, samples=4, **some)
    np.testing.assert_array_equal(again, costs["worst"])
    other = scattered(objective, scatter=wide, samples=4, seed=1, **some)
    assert np.all(other != costs["worst"])


def test_infeasible_points_are_kept_with_their_reason():
    best = design(
        contact(),
        vary={SIZE: (5e-8, 3e-6)},
        objective=Objective(of="A_t"),
        limits=[Limit(of="particle_load_share", least=0.999)],
        F_star=[1e-5],
        points=16,
    )
    reasons = best.points["reason"].values
    assert best.points.sizes["point"] >= 16
    assert any("coverage" in text for text in reasons)
    assert any("particle_load_share" in text for text in reasons)
    limit = Limit(of="particle_load_share", least=0.999)
    hopeless = design(
        contact(),
        vary={SIZE: (5e-8, 6e-8)},
        objective=Objective(of="A_t"),
        limits=[limit],
        F_star=[1e-4],
        points=6,
    )
    assert not hopeless.feasible
    assert str(limit) in hopeless.reason


def test_several_objectives():
    best = design(
        contact(),
        vary={SIZE: (5e-8, 5e-7), "particles.areal_density": (1e9, 1e11)},
        objective=[Objective(of="A_t"), Objective(of="plastic_share")],
        F_star=[1e-5],
        points=64,
    )
    on = best.points["front"].values
    costs = np.stack([best.points["A_t"].values, best.points["plastic_share"].values], axis=1)
    ok = best.points["feasible"].values
    for i in np.flatnonzero(ok & ~on):
        assert np.any(np.all(costs[on] <= costs[i], axis=1))
    assert best.hypervolume > 0
    json.dumps(best.to_dict())


def test_fronts_by_counting():
    rng = np.random.default_rng(3)
    for width in (2, 3):
        costs = rng.random((40, width))
        one = np.ones(width)
        drawn = rng.random((200_000, width))
        beaten = np.zeros(len(drawn), bool)
        for point in costs[front(costs)]:
            beaten |= np.all(drawn >= point, axis=1)
        error = np.sqrt(0.25 / len(drawn))
        assert abs(hypervolume(costs, one) - beaten.mean()) < 4 * error


def test_an_end_of_the_range_is_told():
    best = design(
        contact(),
        vary={SIZE: (5e-8, 1e-7)},
        objective=Objective(of="A_sa", aim="largest"),
        F_star=[1e-5],
        points=8,
    )
    assert best.at_bound == (SIZE,)
    assert f"design.end.{SIZE}" in map(code_of, best.warnings)
    low, high = best.tolerance[SIZE]
    assert 5e-8 <= low <= best.values[SIZE] <= high <= 1e-7


@pytest.mark.parametrize(
    ("changes", "refusal"),
    [
        ({"vary": {}}, refuses(Mistake.EMPTY, "vary")),
        (
            {"vary": {"particles.diametr": (1, 2)}},
            refuses(Mistake.UNKNOWN, "vary['particles.diametr']", meant="particles.diameter.n"),
        ),
        (
            {"vary": {"roughness.sigma": (2e-7, 1e-7)}},
            refuses(Mistake.ORDER, "vary['roughness.sigma']"),
        ),
        (
            {"vary": {"roughness.sigma": 3}},
            refuses(Mistake.KIND, "vary['roughness.sigma']", value="3"),
        ),
        (
            {"vary": {"roughness.sigma": (-1e-7, 1e-7)}},
            refuses(Mistake.RANGE, "Roughness.sigma", value="-1e-07"),
        ),
        ({"vary": {"roughness.R": [STEEL]}}, refuses(Mistake.KIND, "vary['roughness.R']")),
        (
            {"objective": Objective(of="plastic_shar")},
            refuses(Mistake.UNKNOWN, "objective.of", value="'plastic_shar'", meant="plastic_share"),
        ),
        ({"limits": [Limit(of="muu", most=1)]}, refuses(Mistake.UNKNOWN, "limits.of")),
        ({"objective": []}, refuses(Mistake.EMPTY, "objective")),
        ({"F_star": None}, refuses(Mistake.MISSING, "", says="pressure, F_star")),
        ({"weights": [1, 2, 3]}, refuses(Mistake.SHAPE, "", says="weights")),
        (
            {"scatter": {"roughness.sigmaa": (1, 2)}},
            refuses(Mistake.UNKNOWN, "scatter['roughness.sigmaa']", meant="roughness.sigma"),
        ),
    ],
)
def test_mistakes(changes, refusal):
    asked = {
        "vary": {"roughness.sigma": (5e-8, 2e-7)},
        "objective": Objective(of="A_t"),
        "F_star": [1e-5],
    }
    with refusal:
        design(contact(), **{**asked, **changes})
    with refuses(Mistake.MISSING, "Limit"):
        Limit(of="A_t")


@pytest.mark.slow
def test_load_on_buried_particles():
    """Against particles drawn at random: sizes, seats, and how deep each sits in either surface."""
    from thirdbody.analysis.design.search import buried_share

    soft = STEEL.replace(H=2.5e9)
    dust = tb.Particles(
        material=SILICA,
        areal_density=1e12,
        diameter=tb.TruncatedGaussian(mean=100e-9, std=10e-9),
    )
    case = contact().replace(particles=dust, surfaces=tb.MaterialPair(STEEL, soft))
    state = tb.solve(case, pressure=5e7)
    rng = np.random.default_rng(5)
    x = rng.normal(100e-9, 10e-9, 2_000_000)
    x = x[np.abs(x - 100e-9) < 30e-9]
    eps = 1 - (state.h - 100e-9 * rng.standard_normal(len(x))) / x
    x, eps = x[eps > 0], eps[eps > 0]
    one = case.law_of(dust).probe(eps, surfaces=case.surfaces, particle=SILICA)
    load = x**2 * one.load[:, 0]
    deep = np.maximum(*one.depths)[:, 0] > one.radius[:, 0]
    share = load[deep].sum() / load.sum()
    error = np.sqrt(np.sum((load * (deep - share)) ** 2)) / load.sum()
    found = buried_share(case, np.atleast_1d(state.d))[0]
    assert 0.2 < share < 0.8
    assert abs(found - share) < 4 * error
    # a share of the whole load: few deep particles do no harm
    best = design(
        case,
        vary={"particles.areal_density": (1e8, 1e13)},
        objective=Objective(of="A_t"),
        pressure=[5e7],
        points=9,
    )
    points = best.points
    told = np.array(["deeper than their radius" in text for text in points["reason"].values])
    assert told.any()
    assert not told.all()
    assert points["particles.areal_density"].values[~told].min() == pytest.approx(1e8)


def test_a_limit_on_what_has_no_value_is_broken():
    limit = Limit(of="A_t", most=1.0)
    metric = np.array([[[0.5, 0.5]], [[0.5, np.nan]], [[0.5, 2.0]]])
    np.testing.assert_array_equal(limit.excess(metric), [-0.5, np.inf, 1.0])
    assert Limit(of="A_t", least=0.0).excess(metric[:1])[0] == -0.5


def test_number_follows_from_the_fluid():
    """Volume of particles per area is concentration times gap, whatever their size."""
    fluid = Suspension(gap=1e-6, concentration=2e-3, by="volume")
    best = design(
        contact(),
        vary={SIZE: (5e-8, 5e-7)},
        objective=Objective(of="A_t"),
        pressure=[5e6],
        suspension=fluid,
        points=8,
    )
    dust = best.contact.particles
    volume = dust.areal_density * np.pi / 6 * dust.diameter.moment(3)
    assert volume == pytest.approx(2e-3 * 1e-6, rel=1e-12)
    for mistake, said in (
        ({"suspension": None, "vary": {"particles.concentration": (1e-3, 2e-3)}}, "needs suspens"),
        ({"vary": {"particles.areal_density": (1e9, 1e10)}}, "follows from the suspension"),
        ({"suspension": Suspension(gap=1e-6, by="volume")}, "concentration is missing"),
        ({"suspension": Suspension(gap=1e-6, concentration=1e-3)}, "needs the density"),
    ):
        asked = {"vary": {SIZE: (5e-8, 5e-7)}, "suspension": fluid, "pressure": [5e6]}
        with pytest.raises(tb.errors.InvalidValue, match=said):
            design(contact(), objective=Objective(of="A_t"), **{**asked, **mistake})


def test_particles_that_differ_in_number_share_their_spots():
    """Outputs of states of many densities at once, and of each alone."""
    case = contact(outputs=tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6))
    density, p = np.array([0, 1e8, 1e10, 5e10, 0, 1e8]), np.array([1e6, 1e6, 5e6, 5e6, 2e6, 4e6])
    states = state_columns(case, pressure=p, vary={"particles.areal_density": density})
    for i in range(len(p)):
        one = tb.solve(case.replace(**{"particles.areal_density": density[i]}), pressure=p[i])
        for name in ("mu", "mu_sa", "mu_ss", "rolling_share"):
            assert states[name][i] == pytest.approx(one.outputs[name], rel=1e-11, nan_ok=True)


def test_the_function_keeps_its_name():
    import importlib

    importlib.import_module("thirdbody.analysis.design.design")
    assert tb.design is design


@pytest.mark.usefixtures("short_search")
def test_points_tell_units_and_the_figure_words():
    """Of sizes, concentrations, windows and several objectives; a figure shows them in its units."""
    suspension = Suspension(gap=1e-6, by="mass per volume", particle_density=2200.0)
    vary = {SIZE: (5e-8, 5e-7), "particles.concentration": (0.01, 0.1)}
    aims = {
        "one": Objective(of="particle_load_share", aim="window"),
        "two": [Objective(of="A_t"), Objective(of="d", aim="largest", over_loads="worst")],
    }
    made = {
        name: design(
            contact(), vary=vary, objective=aim, suspension=suspension, F_star=[1e-5], points=16
        )
        for name, aim in aims.items()
    }
    points = made["one"].points
    told = {str(name): points[name].attrs.get("units") for name in points}
    assert told[SIZE] == "m"
    assert told["particles.concentration"] == "kg/m^3"
    assert told["particle_load_share:window"] == "1"
    assert told["feasible"] is None
    ax, bar = plot_trials(made["one"]).axes
    along, up = (words_of(contact(), name) for name in vary)
    assert " ".join(ax.get_xlabel().split()) == f"{along} [nm]"
    assert " ".join(ax.get_ylabel().split()) == f"{up} by {suspension.by} [kg/m³]"
    assert bar.get_ylabel().endswith("(window) [1]")
    (best,) = (line for line in ax.lines if line.get_label() == "best")
    assert best.get_xdata()[0] == pytest.approx(1e9 * made["one"].values[SIZE])
    (ax,) = plot_trials(made["two"]).axes
    assert "[1]" in ax.get_xlabel()
    assert "(worst) [nm]" in " ".join(ax.get_ylabel().split())
    (line,) = (line for line in ax.lines if line.get_label() == "front")
    assert len(line.get_xdata()) == made["two"].points["front"].values.sum()


def test_a_function_hears_of_more_points_every_time(monkeypatch):
    """Also where the states of a point are solved one by one, each told as it is."""
    clock = itertools.count()
    monkeypatch.setattr(progress, "time", SimpleNamespace(monotonic=lambda: float(next(clock))))
    heard = []
    case = contact(particle_law=tb.particle.Series(seat="plane"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        design(
            case,
            vary={SIZE: (200e-9, 300e-9)},
            objective=Objective(of="particle_load_share", aim="largest"),
            F_star=[1e-6, 1e-5, 1e-4],
            points=4,
            progress=heard.append,
        )
    assert len(heard) > 4
    assert heard == sorted(set(heard))
