"""The oil ledger: closed limits, other solvers, and circuits drawn at random."""

import itertools
import math
from functools import partial

import numpy as np
import pytest
from refusals import refuses
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.systems.life.circuit import settling_speed
from thirdbody.systems.life.linear_flow import (
    dirt_gain,
    flowing,
    generations,
    reproduction,
    steady_numbers,
)

QUARTZ = tb.materials["quartz"]
STEEL = tb.materials["100Cr6"]
DIRT = tb.oil.OilDirt.from_iso4406("18/16/13", material=QUARTZ)
ONE = tb.oil.SizeClasses(edges=(10e-6, 12e-6))
"""A single class of size."""
IN_CLASS = tb.distributions.PowerLaw(edges=ONE.edges, counts=(1.0,), slopes=(3.0,))
MINUTE, HOUR = 60.0, 3600.0


def of_one_size(**changes):
    """A circuit of which all particles are in one class."""
    given = dict(volume=0.2, start=(), ingress=(), classes=ONE)
    return tb.oil.OilCircuit(**given | changes)


def entering(rate):
    return tb.oil.Ingress(material=QUARTZ, diameter=IN_CLASS, rate=rate)


def even(beta, **changes):
    return tb.oil.Filter(sizes=(10e-6,), betas=(beta,), **dict(flow=1e-3) | changes)


def dirty(number):
    return tb.oil.OilDirt(material=QUARTZ, diameter=IN_CLASS, number=number)


# ------------------------------------------------------------------------------ classes
def test_classes_of_the_usual_range():
    classes = tb.oil.SizeClasses.covering(smallest=0.25e-6, largest=64e-6)
    assert classes.count == 32
    edges = np.array(classes.edges)
    assert np.max(edges[1:] / edges[:-1]) <= 1.25
    # half the size is four classes down, to the last digit
    np.testing.assert_array_equal(edges[4:] / 2, edges[:-4])
    np.testing.assert_allclose(classes.volumes[4:] / 8, classes.volumes[:-4], rtol=1e-13)
    # ISO 4406 counts from edges, and so do most data sheets of filters
    assert {4e-6, 5e-6, 6e-6, 7e-6, 10e-6, 12e-6, 14e-6, 20e-6} <= {round(e, 9) for e in edges}


@pytest.mark.parametrize(("smallest", "largest"), [(4e-6, 14e-6), (4.1e-6, 13.9e-6), (3e-7, 9e-5)])
@pytest.mark.parametrize("per_octave", [1, 3, 4, 8])
def test_classes_hold_what_they_are_asked_to_hold(smallest, largest, per_octave):
    classes = tb.oil.SizeClasses.covering(smallest=smallest, largest=largest, per_octave=per_octave)
    edges = classes.edges
    assert edges[0] <= smallest * (1 + 1e-9) < edges[1] * (1 + 1e-9)
    assert edges[-2] < largest * (1 + 1e-9)
    assert edges[-1] >= largest * (1 - 1e-9)


CODES = [
    f"{a}/{b}/{c}" for a in range(0, 29, 4) for b in range(0, a + 1, 4) for c in {0, b // 2, b}
]


@pytest.mark.parametrize("level", ["low", "middle", "high"])
def test_an_oil_of_a_code_has_this_code(level):
    """Every number of a code at every level of its range: an oil begins where it is told to."""
    codes = [*CODES, "18/16/13", "22/19/14", "28/28/28", "28/0/0"]
    for code in codes:
        dirt = tb.oil.OilDirt.from_iso4406(code, material=QUARTZ, level=level)
        terms = tb.oil.OilCircuit(volume=0.2, start=dirt, ingress=()).terms()
        assert terms.classes.iso4406(terms.start.sum(axis=1)) == code, (code, level)


@pytest.mark.slow
def test_an_oil_of_any_code_has_this_code():
    for a, b, c in itertools.product(range(29), repeat=3):
        if a >= b >= c:
            for level in ("low", "middle", "high"):
                dirt = tb.oil.OilDirt.from_iso4406(f"{a}/{b}/{c}", material=QUARTZ, level=level)
                terms = tb.oil.OilCircuit(volume=0.2, start=dirt, ingress=()).terms()
                assert terms.classes.iso4406(terms.start.sum(axis=1)) == f"{a}/{b}/{c}", level


def test_an_oil_of_a_steady_code_ends_at_this_code():
    held = tb.oil.Filter(sizes=(3e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3)
    for code in ("18/16/13", "22/19/14", "20/14/12", "17/17/11"):
        for level in ("low", "high"):
            dirt = tb.oil.OilDirt.from_iso4406(code, material=QUARTZ, level=level)
            steady = tb.oil.Ingress(material=QUARTZ, diameter=dirt.diameter, steady=dirt.number)
            oil = tb.oil.OilCircuit(volume=0.2, start=(), ingress=steady, filters=held)
            assert oil.steady_code() == code, level


def test_mean_powers_of_a_class_against_quadrature():
    import mpmath as mp

    classes = tb.oil.SizeClasses(edges=(2e-6, 3e-6, 7e-6))
    for k, (a, b) in enumerate([(2, 3), (3, 7)]):
        number = mp.quad(lambda x: x**-4, [a, b])
        for power in (0, 1, 2, 3, 4, 5.5):
            want = mp.quad(lambda x, power=power: x ** (power - 4), [a, b]) / number
            got = classes.mean_power(power)[k] / 1e-6**power
            assert got == pytest.approx(float(want), rel=1e-12)


@pytest.mark.parametrize("diameter", [
    tb.LogNormal(median=5e-6, gsd=1.8), tb.distributions.Weibull(scale=8e-6, shape=2), tb.distributions.Uniform(low=3e-6, high=9e-6),
    tb.distributions.Monodisperse(mean=4e-6), tb.dust.dust_sizes("A3"),
])  # fmt: skip
def test_classes_keep_number_or_volume(diameter):
    circuit = tb.oil.OilCircuit(
        volume=0.2, ingress=(), start=tb.oil.OilDirt(material=QUARTZ, diameter=diameter, number=1e9)
    )
    classes = circuit.size_classes()
    assert classes.numbers_of(1e9, diameter).sum() == pytest.approx(1e9, rel=2e-9)
    volume = classes.numbers_by_volume(1e9, diameter) @ classes.volumes
    assert volume == pytest.approx(1e9 * math.pi / 6 * diameter.moment(3), rel=2e-9)


def test_a_size_on_an_edge_counts_as_at_least_that_size():
    diameter = tb.distributions.Monodisperse(mean=4e-6)
    classes = tb.oil.SizeClasses.covering(smallest=2e-6, largest=8e-6)
    assert classes.counted(classes.numbers_of(1e8, diameter))[0] == 1e8


@pytest.mark.parametrize("code", ["18/16/13", "24/22/19", "15/13/10", "12/10/7"])
def test_a_code_goes_into_classes_and_comes_back(code):
    circuit = tb.oil.OilCircuit(
        volume=0.2, ingress=(), start=tb.oil.OilDirt.from_iso4406(code, material=QUARTZ)
    )
    assert tb.life(oil=circuit, duration=1.0).codes[0] == code


def test_particles_outside_the_classes_are_refused():
    with refuses(Mistake.RANGE, "SizeClasses.edges", says="4e-06 to 7e-05"):
        of_one_size(start=DIRT).terms()


# ------------------------------------------------------------------------------ references
UPSTREAM = {2: 3333.33, 10: 1851.85, 75: 1689.19, 1000: 1668.34}
DOWNSTREAM = {2: 1666.67, 10: 185.185, 75: 22.5225, 1000: 1.66834}


@pytest.mark.parametrize("beta", UPSTREAM)
def test_steady_counts_before_and_behind_a_filter(beta):
    circuit = of_one_size(ingress=entering(1e8 / MINUTE), filters=even(beta))
    before = float(circuit.steady().sum()) / 1e6
    assert before == pytest.approx(1e8 / MINUTE / (1e-3 * (1 - 1 / beta)) / 1e6, rel=1e-13)
    assert f"{before:.6g}" == f"{UPSTREAM[beta]:.6g}"
    assert f"{before / beta:.6g}" == f"{DOWNSTREAM[beta]:.6g}"


def test_time_to_three_codes_cleaner():
    circuit = of_one_size(start=dirty(8e9), filters=even(75.0))
    removal = circuit.terms().loss[0, 0] / circuit.volume
    assert f"{1 / removal / MINUTE:.6g}" == "3.37838"
    assert math.log(8) / removal / MINUTE == pytest.approx(7.02514, abs=6e-6)
    history = tb.life(oil=circuit, duration=HOUR, times=[math.log(8) / removal])
    assert history.numbers[0].sum() == pytest.approx(1e9, rel=1e-12)


def test_settling_of_quartz():
    w = settling_speed(10e-6, particle_density=2650, oil_density=870, viscosity=0.03)
    assert f"{float(w):.6g}" == "3.23367e-06"


def test_settling_is_a_perfect_filter_of_area_times_speed():
    floor = of_one_size(start=dirty(1e9), settling_area=0.5, viscosity=0.03, density=870.0)
    low, high = ONE.edges
    x = np.array([low, high])
    speeds = settling_speed(x, particle_density=2650, oil_density=870, viscosity=0.03)
    removal = floor.terms().removal["settled"][0, 0]
    assert 0.5 * speeds[0] < removal < 0.5 * speeds[1]
    assert 0.5 * float(speeds[0]) * MINUTE * 1e3 == pytest.approx(0.097, rel=2e-3)  # L/min


# ------------------------------------------------------------------------------ closed limits
TIMES = np.array([0.0, 1.0, 60.0, 700.0, 3600.0])


def test_oil_without_sources_becomes_clean():
    history = tb.life(
        oil=of_one_size(start=dirty(1e9), filters=even(10.0)), duration=HOUR, times=TIMES
    )
    want = 1e9 * np.exp(-1e-3 * 0.9 * history.times / 0.2)
    np.testing.assert_allclose(history.numbers.sum(axis=(1, 2)), want, rtol=1e-12)


def test_oil_without_a_way_out_becomes_dirty():
    history = tb.life(
        oil=of_one_size(start=dirty(1e9), ingress=entering(1e6)), duration=HOUR, times=TIMES
    )
    want = 1e9 + 1e6 * history.times / 0.2
    np.testing.assert_allclose(history.numbers.sum(axis=(1, 2)), want, rtol=1e-13)
    assert history.circuit.steady_code() == "-/-/0"


def test_filters_side_by_side_add_and_in_one_line_multiply():
    alone = [1e-3 * (1 - 1 / beta) for beta in (2.0, 10.0)]
    of_one = partial(of_one_size, start=dirty(1e9))
    beside = of_one(filters=(even(2.0), even(10.0))).terms().loss[0, 0]
    assert beside == pytest.approx(sum(alone), rel=1e-13)
    line = of_one(filters=(even(2.0, line="main"), even(10.0, line="main"))).terms()
    assert line.loss[0, 0] == pytest.approx(1e-3 * (1 - 1 / 20), rel=1e-13)
    assert line.removal["filter 1"][0, 0] == pytest.approx(0.5e-3, rel=1e-13)
    assert line.removal["filter 2"][0, 0] == pytest.approx(0.5e-3 * 0.9, rel=1e-13)


def test_a_cascade_keeps_its_mass():
    """Reference 8: halves of half the size, eight of each."""
    loss, broken = 1e-3, np.array([5e-4, 5e-4, 0.0])  # largest first
    losses = np.diag(loss + broken)
    births = np.diag(8 * broken[:-1], -1)
    found = np.linalg.solve(losses - births, [1e6, 0.0, 0.0])
    for got, want in zip(found, (6.66667e8, 1.77778e9, 7.11111e9), strict=True):
        assert f"{got:.6g}" == f"{want:.6g}"
    volumes = 8.0 ** -np.arange(3)
    assert loss * volumes @ found == pytest.approx(1e6 * volumes[0], rel=1e-12)
    # breaking belongs to the losses: pieces are no births
    np.testing.assert_allclose(
        steady_numbers(losses - births, births=np.zeros((3, 3)), source=[1e6, 0.0, 0.0]),
        found,
        rtol=1e-12,
    )


def test_reproduction_of_debris():
    losses, births = np.diag([1e-3, 5e-4]), np.array([[0.0, 0.0], [3e-5, 1e-4]])
    assert reproduction(losses, births=births) == pytest.approx(0.2, rel=1e-13)
    np.testing.assert_allclose(
        steady_numbers(losses, births=births, source=[1e5, 0.0]), [1e8, 7.5e6], rtol=1e-12
    )
    assert dirt_gain(losses, births=births, source=[1e5, 0.0]) == pytest.approx(1.075, rel=1e-12)


def test_one_class_gains_by_its_reproduction():
    assert dirt_gain([[2.0]], births=[[1.5]], source=[3.0]) == pytest.approx(
        1 / (1 - 0.75), rel=1e-13
    )
    assert np.isnan(steady_numbers([[2.0]], births=[[2.0]], source=[3.0])[0])
    assert not generations([[2.0]], births=[[0.0]])[0, 0]


def test_nothing_is_bred_without_a_contact():
    history = tb.life(oil=of_one_size(start=dirty(1e9), filters=even(10.0)), duration=HOUR)
    assert (history.R0, history.dirt_gain) == (0.0, 1.0)
    assert not history.generations.any()


# ------------------------------------------------------------------------------ other solvers
CASES = [
    dict(growth=0.0, loss=1e-3, source=1e6),
    dict(growth=0.0, loss=0.0, source=1e6),
    dict(growth=0.0, loss=1e-9, source=1e6),
    dict(growth=2e-5, loss=1e-3, source=1e6),
    dict(growth=-2e-5, loss=1e-3, source=1e6),
    dict(growth=-2e-5, loss=2e-5, source=0.0),
    dict(growth=1e-4, loss=0.0, source=1e6),
    dict(growth=-5e-5, loss=6e-5, source=1e6),
]


@pytest.mark.parametrize("case", CASES)
def test_the_course_against_a_matrix_exponential(case):
    """States N, ∫n dt, V and t over τ = ∫dt/V."""
    volume, number, time = 0.2, 3e8, 3000.0
    growth, loss, source = case["growth"], case["loss"], case["source"]
    M = np.array([[-loss, 0, source, 0], [1, 0, 0, 0], [0, 0, growth, 0], [0, 0, 1, 0]])
    tau = time / volume if growth == 0 else math.log1p(growth * time / volume) / growth
    scale = np.array([1e8, 1e8, 1.0, 1e3])
    want = scale * (
        expm(M * tau / scale[:, None] * scale) @ (np.array([number, 0, volume, 0]) / scale)
    )
    found = flowing(volume, numbers=number, growth=growth, source=source, loss=loss, time=time)
    assert float(found.numbers) == pytest.approx(want[0], rel=1e-10)
    assert float(found.passed) == pytest.approx(want[1], rel=1e-10)
    assert want[3] == pytest.approx(time, rel=1e-10)


@pytest.mark.check
def test_a_whole_circuit_against_an_integrator():
    fine = tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(10.0, 200.0), flow=5e-4)
    circuit = tb.oil.OilCircuit(
        volume=0.05,
        start=DIRT,
        ingress=tb.oil.Ingress.of_dust("A3", rate="50 mg/h", material=QUARTZ),
        filters=(fine, fine.replace(betas=(2.0, 75.0), line="kidney")),
        settling_area=0.1,
        viscosity=0.05,
        density=880.0,
        make_up=1e-7,
        leak=2e-7,
        fresh_oil=tb.oil.OilDirt.from_iso4406("17/15/12", material=QUARTZ),
    )
    terms = circuit.terms()
    shape = terms.start.shape

    def rates(t, y):
        n = y[: terms.start.size].reshape(shape) / (0.05 - 1e-7 * t)
        lost = [(flow * n).ravel() for flow in terms.removal.values()]
        return np.concatenate([(terms.source - terms.loss * n).ravel(), *lost])

    end = 2e4
    first = np.concatenate(
        [0.05 * terms.start.ravel(), np.zeros(terms.start.size * len(terms.removal))]
    )
    found = solve_ivp(rates, (0, end), first, method="Radau", rtol=1e-9, atol=1e-3)
    history = tb.life(oil=circuit, duration=end, times=[0.0, end])
    n = found.y[: terms.start.size, -1].reshape(shape) / (0.05 - 1e-7 * end)
    np.testing.assert_allclose(history.numbers[-1], n, rtol=1e-6)
    for i, name in enumerate(terms.removal):
        lost = found.y[terms.start.size * (i + 1) : terms.start.size * (i + 2), -1].reshape(shape)
        assert history.ledger.went[name][-1] == pytest.approx(np.sum(lost * terms.masses), rel=1e-6)


def test_classes_twice_as_fine_change_little():
    """Limit 10: the course of the counts converges with the ratio of the classes."""
    fine = tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(4.0, 200.0), flow=1e-3)
    dust = tb.oil.Ingress.of_dust("A3", rate="125 mg/h", material=QUARTZ)

    def counts(per_octave):
        classes = tb.oil.SizeClasses.covering(
            smallest=0.25e-6, largest=128e-6, per_octave=per_octave
        )
        circuit = tb.oil.OilCircuit(
            volume=0.2, start=DIRT, ingress=dust, filters=fine, classes=classes
        )
        return tb.life(oil=circuit, duration=300.0, times=[300.0]).counts[-1]

    exact = counts(128)
    errors = [np.abs(counts(n) / exact - 1).max() for n in (4, 8, 16, 32)]
    assert all(later < 0.67 * earlier for earlier, later in zip(errors, errors[1:], strict=False))


# ------------------------------------------------------------------------------ events
def test_a_full_filter_is_changed_and_the_next_one_lasts_as_long():
    entering_mass = 100e-6 / HOUR
    dust = tb.oil.Ingress.of_dust("A3", rate=entering_mass, material=QUARTZ)
    fine = tb.oil.Filter(sizes=(0.3e-6,), betas=(1e4,), flow=1e-3, capacity=0.01)
    history = tb.life(
        oil=tb.oil.OilCircuit(volume=0.2, start=(), ingress=dust, filters=fine), duration=350 * HOUR
    )
    times = [event.time / HOUR for event in history.events]
    assert [event.name for event in history.events] == ["filter full"] * 3
    assert times == pytest.approx([100, 200, 300], rel=1e-3)
    assert history.ledger.went["filter"][-1] == pytest.approx(0.035, rel=1e-3)
    assert times[0] > 100  # some is still in the oil


def test_a_full_filter_that_is_bypassed_lets_the_oil_become_dirty():
    dust = tb.oil.Ingress.of_dust("A3", rate="100 mg/h", material=QUARTZ)
    fine = tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3, capacity=0.01, when_full="bypass")
    circuit = tb.oil.OilCircuit(volume=0.2, start=(), ingress=dust, filters=fine)
    history = tb.life(oil=circuit, duration=400 * HOUR)
    caught = history.ledger.went["filter"]
    assert caught[-1] == pytest.approx(0.01, rel=1e-9)
    assert history.ledger.residual < 1e-12
    after = history.times > history.events[0].time
    steps = np.diff(history.counts[after, 0]) / np.diff(history.times[after])
    np.testing.assert_allclose(
        steps, circuit.terms().classes.counted(circuit.terms().ingress[:, 0])[0] / 0.2, rtol=1e-6
    )
    stops = tb.life(oil=circuit, duration=400 * HOUR, until=tb.oil.until.filter_full())
    assert stops.times[-1] == history.events[0].time == stops.events[-1].time


@pytest.mark.parametrize("code", ["17/15/12", "14/12/9"])
def test_a_code_is_reached_on_the_way_down(code):
    circuit = tb.oil.OilCircuit(
        volume=0.2,
        start=DIRT,
        ingress=(),
        filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3),
    )
    history = tb.life(oil=circuit, duration=1e5, until=tb.oil.until.iso4406(code))
    ends = [tb.dust.iso4406_range(int(part))[1] for part in code.split("/")]
    assert np.max(history.counts[-1] / ends) == pytest.approx(1, rel=1e-9)
    assert history.codes[-1] == code
    assert history.events[0].time == history.times[-1] < 1e5


def test_a_code_is_reached_on_the_way_up():
    circuit = of_one_size(start=dirty(1e6), ingress=entering(1e6))
    history = tb.life(oil=circuit, duration=1e6, until=tb.oil.until.iso4406("-/18/0"))
    low = tb.dust.iso4406_range(18)[0]
    assert history.times[-1] == pytest.approx((low - 1e6) * 0.2 / 1e6, rel=1e-9)


def test_an_oil_change_brings_the_fresh_oil():
    fresh = tb.oil.OilDirt.from_iso4406("16/14/11", material=QUARTZ)
    circuit = tb.oil.OilCircuit(
        volume=0.2, start=DIRT, ingress=(), fresh_oil=fresh, oil_changes=(HOUR, 2 * HOUR)
    )
    history = tb.life(oil=circuit, duration=3 * HOUR)
    assert [event.time for event in history.events] == [HOUR, 2 * HOUR]
    at = np.searchsorted(history.times, HOUR)
    assert history.times[at] == HOUR
    assert (history.codes[at - 1], history.codes[at]) == ("18/16/13", "16/14/11")
    assert history.ledger.residual < 1e-12
    assert history.ledger.went["oil changes"][-1] == pytest.approx(
        0.2 * (history.mass_per_volume[0] + history.mass_per_volume[at])[0], rel=1e-12
    )
    assert np.all(np.diff(history.times) > 0)


# ------------------------------------------------------------------------------ codes kept
def test_ingress_that_keeps_a_code_keeps_it():
    fine = tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(10.0, 200.0), flow=1e-3)
    circuit = tb.oil.OilCircuit(
        volume=0.2,
        start=(),
        ingress=tb.oil.Ingress.keeping_iso4406("19/17/14", material=QUARTZ),
        filters=fine,
        make_up=1e-7,
        leak=1e-7,
        fresh_oil=tb.oil.OilDirt.from_iso4406("16/14/11", material=QUARTZ),
    )
    assert circuit.steady_code() == "19/17/14"
    history = tb.life(oil=circuit, duration=1e5)
    assert history.codes[-1] == "19/17/14"
    kept = circuit.replace(start=tb.oil.OilDirt.from_iso4406("19/17/14", material=QUARTZ))
    counts = tb.life(oil=kept, duration=1e5).counts
    np.testing.assert_allclose(counts, np.broadcast_to(counts[0], counts.shape), rtol=1e-10)


def test_a_code_cleaner_than_fresh_oil_cannot_be_kept():
    circuit = of_one_size(
        ingress=tb.oil.Ingress(material=QUARTZ, diameter=IN_CLASS, steady=1e6),
        make_up=1e-6,
        leak=1e-6,
        fresh_oil=dirty(1e9),
    )
    with refuses(Mistake.CLASH, "OilCircuit.ingress"):
        circuit.terms()


# ------------------------------------------------------------------------------ filters
def test_penetration_of_a_data_sheet():
    sheet = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0))
    assert f"{float(sheet.penetration(7e-6)):.6f}" == "0.313002"
    assert float(sheet.beta(7e-6)) == pytest.approx(9.08, abs=5e-3)
    assert float(sheet.penetration(10e-6 * (1 - 1e-9))) == pytest.approx(0.0406, abs=5e-5)
    assert float(sheet._raw_penetration(5e-6)) == pytest.approx(1.02, abs=5e-3)
    assert sheet.penetration([3e-6, 5e-6]).tolist() == [1.0, 1.0]
    assert float(sheet.penetration(50e-6)) == pytest.approx(1 / 75, rel=1e-12)


@pytest.mark.parametrize("service", [1.0, 0.5, 1.3])
@pytest.mark.parametrize("betas", [(2.0, 75.0), (1.0, 40.0), (20.0, 1000.0), (3.0, 3.0)])
def test_classes_let_pass_what_the_cumulative_ratio_says(betas, service):
    """N(>x)/β(x) of the test dust, wherever nothing is clipped."""
    sheet = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=betas, service=service)
    edges = np.array([4.9e-6, 5e-6, 5.7e-6, 7e-6, 9.1e-6, 10e-6, 20e-6])
    got = sheet.mean_penetration(edges)
    above = edges**-3.0
    behind = above / tb.oil.Filter(sizes=(5e-6, 10e-6), betas=betas).beta(edges) ** service
    want = (behind[:-1] - behind[1:]) / (above[:-1] - above[1:])
    clipped = sheet.clipped_to or 0.0
    free = (edges[:-1] >= max(clipped, 5e-6)) & (edges[1:] < 10e-6 * (1 + 1e-12))
    # at 10 µm the slope of β ends, and with it some of what passes just below
    np.testing.assert_allclose(got[free], want[free], rtol=1e-9)
    assert got[0] == 1.0
    assert got[-1] == pytest.approx(betas[-1] ** -service, rel=1e-12)
    assert np.all(got <= 1 + 1e-15)


def test_what_is_clipped_is_found_by_trying():
    for betas in ((2.0, 75.0), (1.0, 40.0), (1.1, 1.5), (20.0, 1000.0), (1.5, 1000.0, 2000.0)):
        sizes = (5e-6, 10e-6, 12e-6)[: len(betas)]
        sheet = tb.oil.Filter(sizes=sizes, betas=betas)
        x = np.linspace(5e-6, 12e-6, 70001)[1:]
        over = x[sheet._raw_penetration(x) > 1]
        if sheet.clipped_to is None:
            assert not len(over)
        else:
            assert over.max() == pytest.approx(sheet.clipped_to, abs=2e-10)


# ------------------------------------------------------------------------------ at random
def drawn(index):
    """A circuit over real ranges."""
    rng = np.random.default_rng([33, index])

    def log(low, high):
        return float(low * (high / low) ** rng.random())

    materials = (QUARTZ, STEEL, tb.materials["PTFE"].replace(density=2200.0))

    def dirt():
        base = int(rng.integers(10, 25))
        code = f"{base}/{base - int(rng.integers(0, 4))}/{base - int(rng.integers(4, 8))}"
        return tb.oil.OilDirt.from_iso4406(code, material=materials[rng.integers(3)])

    volume, duration = log(1e-3, 10), log(60, 1e8)
    moving = volume / duration
    ways_in = [
        lambda: tb.oil.Ingress.of_dust(str(rng.choice(["A1", "A2", "A3", "A4"])), rate=log(1e-13, 1e-7),
                                   material=materials[rng.integers(2)]),
        lambda: tb.oil.Ingress.from_counts(sizes=[4e-6, 6e-6, 14e-6], material=materials[rng.integers(3)],
                                       counts=log(1e2, 1e9) * np.array([1, 0.3, 0.02])),
    ]  # fmt: skip
    ingress = tuple(ways_in[rng.integers(2)]() for _ in range(rng.integers(0, 3)))
    start = tuple(dirt() for _ in range(rng.integers(0, 3)))
    brought = sum(each.mass_rate for each in ingress) * duration
    brought += 1e-3 + volume * sum(each.mass_per_volume for each in start)  # kg

    def filters():
        first = log(2e-6, 20e-6)
        beta = 1 + log(0.01, 100)
        line = "main" if rng.random() < 0.3 else ""
        return tb.oil.Filter(
            sizes=(first, first * log(1.2, 4)), betas=(beta, beta * log(1, 200)),
            flow=3e-4 if line else log(1e-6, 1e-2), service=log(0.3, 1.2),
            capacity=log(0.03, 3) * brought if rng.random() < 0.5 else None,
            when_full="bypass" if rng.random() < 0.5 else "change",
            still_filtered=float(rng.random() < 0.3) * 0.5, line=line,
        )  # fmt: skip

    return tb.oil.OilCircuit(
        volume=volume, start=start,
        ingress=ingress,
        filters=tuple(filters() for _ in range(rng.integers(0, 4))),
        viscosity=log(1e-3, 1), density=870.0, settling_area=log(1e-3, 10) * float(rng.random() < 0.5),
        make_up=moving * rng.random() * float(rng.random() < 0.5),
        leak=moving * rng.random() * float(rng.random() < 0.5),
        fresh_oil=dirt(),
        oil_changes=tuple(np.sort(rng.uniform(0.01, 1.2, rng.integers(0, 3)) * duration)),
    ), duration  # fmt: skip


@pytest.mark.parametrize(
    "index", [pytest.param(i, marks=pytest.mark.spread(10)) for i in range(300)]
)
def test_mass_closes_in_any_circuit(index):
    circuit, duration = drawn(index)
    history = tb.life(oil=circuit, duration=duration)
    assert history.ledger.residual < 1e-9
    assert np.min(history.numbers, initial=0.0) > -1 / circuit.volume
    assert np.all(np.isfinite(history.numbers))
    for went in history.ledger.went.values():
        assert np.all(np.diff(went) >= -1e-12 * max(went[-1], 1e-300))


def test_units_do_not_matter():
    """Lengths times 3: volumes times 27, counts per volume over 27, the same course of N."""
    factor = 3.0
    sheet = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=(2.0, 75.0), flow=1e-3)
    sizes = tb.LogNormal(median=8e-6, gsd=1.3)
    classes = tb.oil.SizeClasses.covering(smallest=1e-6, largest=200e-6)

    def course(f):
        circuit = tb.oil.OilCircuit(
            volume=0.2 * f**3, ingress=tb.oil.Ingress(material=QUARTZ, diameter=sizes.scaled(f), rate=1e6),
            start=tb.oil.OilDirt(material=QUARTZ, diameter=sizes.scaled(f), number=1e9 / f**3),
            filters=sheet.replace(sizes=tuple(f * x for x in sheet.sizes), flow=1e-3 * f**3),
            classes=tb.oil.SizeClasses(edges=tuple(f * x for x in classes.edges)),
            settling_area=0.5 * f**2, viscosity=0.03 * f, density=870.0,
        )  # fmt: skip
        history = tb.life(oil=circuit, duration=HOUR, times=[HOUR / 3])
        return history.numbers * f**3

    np.testing.assert_allclose(course(factor), course(1.0), rtol=1e-9)


# ------------------------------------------------------------------ found by refutation
def test_accounts_begin_at_the_beginning_whatever_times_are_asked_for():
    circuit = tb.oil.OilCircuit(
        volume=0.2,
        start=tb.oil.OilDirt.from_iso4406("20/18/15", material=tb.materials["quartz"]),
        ingress=(),
        filters=tb.oil.Filter(sizes=(4e-6,), betas=(75.0,), flow=1e-3),
    )
    whole = tb.life(oil=circuit, duration=3600.0)
    late = tb.life(oil=circuit, duration=3600.0, times=[600.0, 3600.0])
    assert late.times.tolist() == [600.0, 3600.0]
    assert late.ledger.residual < 1e-9
    np.testing.assert_allclose(late.flows(rates=True)[0][2], whole.flows(rates=True)[0][2])


def test_an_absurd_duration_is_refused():
    circuit = tb.oil.OilCircuit(volume=0.2, start=(), ingress=())
    with refuses(Mistake.RANGE, "duration"):
        tb.life(oil=circuit, duration=3.6e33)


def test_an_oil_alone_does_not_wait_for_wear():
    circuit = tb.oil.OilCircuit(volume=0.2, start=(), ingress=())
    with refuses(Mistake.IDLE, "until", value="wear depth"):
        tb.life(oil=circuit, duration=1.0, until=tb.oil.until.wear_depth(1e-6))


def test_a_dry_contact_does_not_wait_for_a_code():
    steel = tb.materials["S45C"]
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=1e-7, R=3e-6)
    )
    with refuses(Mistake.IDLE, "until", value="code 18/16/13"):
        tb.life(contact, duration=1.0, until=tb.oil.until.iso4406("18/16/13"))
