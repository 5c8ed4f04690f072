"""Ingress from oil reports: the inverse of the course of the oil."""

import math
from functools import cache

import numpy as np
import pytest
from refusals import refuses

import thirdbody as tb
from thirdbody.errors import Mistake
from thirdbody.quantities.say import percent
from thirdbody.systems.life.report_notes import below_counts, mass_beyond, share_beyond
from thirdbody.systems.life.reports import approach_of_reports, oil_reports, read_reports

QUARTZ = tb.materials["quartz"]
HOUR = 3600.0
SIZES, RATES = (4e-6, 6e-6, 14e-6), np.array([2e5, 6e4, 4e3])
START = tb.oil.OilDirt.from_iso4406("21/19/16", material=QUARTZ)
FILTER = tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(4.0, 75.0), flow=2e-5)
FINE = tb.oil.SizeClasses.covering(smallest=4e-6, largest=90e-6, per_octave=48)


def circuit(**changes):
    """200 L that its filter turns over in three hours."""
    dust = tb.oil.Ingress.from_counts(sizes=SIZES, counts=RATES, material=QUARTZ)
    given = dict(volume=0.2, start=START, ingress=dust, filters=FILTER, classes=FINE)
    return tb.oil.OilCircuit(**given | changes)


def reported(times, **changes):
    """Exact counts at the times."""
    history = tb.life(oil=circuit(**changes), duration=max(times), times=times)
    return history.counts[np.isin(history.times, times)]


# ------------------------------------------------------------------------------ closed forms
def test_three_reports_give_rate_and_end():
    """Reference 12."""
    found = approach_of_reports([10000, 22092.95, 30529.91], step=HOUR)
    assert f"{found.rate:.4g}" == "0.0001"
    assert found.limit == pytest.approx(50000, rel=1e-5)
    n = 5e4 - 4e4 * np.exp(-1e-4 * HOUR * np.arange(3))
    exact = approach_of_reports(list(n), step=HOUR)
    assert (exact.rate, exact.limit) == pytest.approx((1e-4, 5e4), rel=1e-10)
    with refuses(Mistake.BEYOND, "counts"):
        approach_of_reports([1.0, 2.0, 3.5], step=HOUR)


def test_one_size_without_filter_is_a_difference():
    """r = V Δn/Δt, whatever lies beyond the size."""
    bare = circuit(filters=(), classes=None)
    found = oil_reports([0.0, 1e6], reports=[[1e9], [3e9]], sizes=[6e-6], circuit=bare)
    assert found.rate[0] == pytest.approx(0.2 * 2e9 / 1e6, rel=1e-9)
    assert found.degrees == 0
    assert found.is_constant is None
    assert math.isnan(found.probability)


# ------------------------------------------------------------------------------ inverse pairs
CASES = [
    dict(),
    dict(filters=()),
    dict(
        make_up=2e-7, leak=1e-7, fresh_oil=tb.oil.OilDirt.from_iso4406("17/15/12", material=QUARTZ)
    ),
    dict(
        fresh_oil=tb.oil.OilDirt.from_iso4406("17/15/12", material=QUARTZ), oil_changes=(5 * HOUR,)
    ),
    dict(settling_area=2.0, viscosity=0.02, density=870.0),
]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("hours", [[0, 3], [0, 3, 8], [0, 1, 4, 9, 30]])
def test_exact_reports_give_the_ingress_back(case, hours):
    times = np.array(hours) * HOUR
    found = oil_reports(times, reports=reported(times, **case), circuit=circuit(**case))
    np.testing.assert_allclose(found.rate, RATES, rtol=0.03)
    np.testing.assert_allclose(found.fitted, found.counts, rtol=0.02)
    assert found.start.number == pytest.approx(START.number, rel=0.02)
    assert found.is_constant in (True, None)
    again = reported(times, **case | dict(ingress=found.ingress, start=found.start))
    np.testing.assert_allclose(again, found.counts, rtol=0.02)


def test_mass_is_that_of_the_ingress():
    times = np.array([0, 3, 8]) * HOUR
    found = oil_reports(times, reports=reported(times), circuit=circuit())
    assert found.mass_rate == pytest.approx(found.ingress.mass_rate, rel=0.05)
    assert found.mass_low < found.mass_rate < found.mass_high


# ------------------------------------------------------------------------------ bands
def coded(counts):
    """The codes of counts, as a laboratory tells them."""
    return [tb.dust.iso4406_of_counts(each) for each in counts]


@pytest.mark.check
def test_the_band_of_codes_holds_what_is_true():
    """Volumes at random move every count somewhere else in its range."""
    inside, widths = [], []
    rng = np.random.default_rng(7)
    times = np.array([0, 24, 48, 72]) * HOUR
    exact = reported(times)
    for _ in range(40):
        factor = math.exp(rng.uniform(-1, 1))
        found = oil_reports(times, reports=coded(exact * factor), circuit=circuit())
        inside += list((found.low < RATES * factor) & (found.high > RATES * factor))
        widths.append(found.high / found.low)
    assert 0.8 < np.mean(inside) < 0.99
    assert 1.6 < np.median(widths) < 2.1


@pytest.mark.slow
@pytest.mark.parametrize("betas", [(2.0, 75.0), (1.02, 1.5)])
def test_bands_hold_what_is_true_where_a_filter_lets_nearly_all_pass(betas, monkeypatch):
    """300 oils with classes of the default width: each size is in its band nine times of ten."""
    monkeypatch.setattr("thirdbody.systems.life.reports.DRAWS", 80)
    weak = tb.oil.Filter(sizes=(5e-6, 10e-6), betas=betas, flow=2e-5)
    usual = tb.oil.SizeClasses.covering(smallest=4e-6, largest=90e-6)
    oil = circuit(filters=weak, classes=usual)
    times = np.array([0, 24, 48, 72]) * HOUR
    exact = reported(times, filters=weak, classes=usual)

    @cache  # counts that differ by a factor of less than two often have the same codes
    def found_of(*codes):
        return oil_reports(times, reports=codes, circuit=oil)

    inside, rng = [], np.random.default_rng(11)
    for _ in range(300):
        factor = math.exp(rng.uniform(-1, 1))
        found = found_of(*coded(exact * factor))
        inside.append((found.low < RATES * factor) & (found.high > RATES * factor))
    # three standard deviations of 300 draws below nine of ten
    assert np.all(np.mean(inside, axis=0) > 0.9 - 3 * math.sqrt(0.09 / 300))


def test_more_reports_make_the_band_narrower_where_they_differ():
    def width(count):
        times = np.linspace(0, 10, count) * HOUR
        bare = dict(filters=(), start=tb.oil.OilDirt.from_iso4406("21/19/16", material=QUARTZ))
        found = oil_reports(times, reports=reported(times, **bare), circuit=circuit(**bare))
        return np.log(found.high / found.low)[0]

    two, nine = width(2), width(9)
    assert two > 1.1 * nine
    assert nine > 0.8 * math.log(2)  # all may be off alike


def test_ingress_that_doubles_does_not_fit_a_constant_one():
    times = np.array([0, 24, 48, 72, 96]) * HOUR
    counts = reported(times)
    counts[3:] *= 8
    found = oil_reports(times, reports=coded(counts), circuit=circuit())
    assert found.is_constant is False
    assert found.degrees == 9
    steady = oil_reports(times, reports=coded(reported(times)), circuit=circuit())
    assert steady.is_constant is True


def test_a_clean_start_and_no_dirt_that_enters():
    times = np.array([0, 4]) * HOUR
    counts = reported(times, ingress=())
    found = oil_reports(times, reports=counts, circuit=circuit())
    assert np.all(found.rate < 0.02 * RATES)


def test_codes_without_the_first_count():
    found = oil_reports([0.0, 9e5], reports=["-/18/15", "-/16/13"], circuit=circuit(classes=None))
    assert found.sizes.tolist() == [6e-6, 14e-6]


def test_the_same_reports_give_the_same_band():
    one, two = (
        oil_reports([0.0, 9e5], reports=["20/18/15", "18/16/13"], circuit=circuit()) for _ in "ab"
    )
    assert one.to_dict() == two.to_dict()


# ------------------------------------------------------------------------------ mistakes
@pytest.mark.parametrize(
    ("times", "reports", "more", "words"),
    [
        ([0.0], ["20/18/15"], {}, "two reports or more"),
        ([1.0, 0.0], ["20/18/15"] * 2, {}, "each later than the one before"),
        ([0.0, 1.0], ["20/18/15"] * 3, {}, "one for each of 2"),
        ([0.0, 1.0], ["20/18"] * 2, {}, "two numbers"),
        ([0.0, 1.0], [[1.0, 2.0]] * 2, {}, "3 counts each"),
        ([0.0, 1.0], [[1.0, -2.0, 3.0]] * 2, {}, "0 or more"),
        ([0.0, 1.0], ["20/18/15"] * 2, {"least": 0.0}, "least"),
        ([0.0, 1.0], ["20/18/15"] * 2, {"width": 1.0}, "width"),
    ],
)
def test_mistakes(times, reports, more, words):
    with pytest.raises(tb.errors.InvalidValue, match=words):
        oil_reports(times, reports=reports, circuit=circuit(), **more)


def test_files_of_codes_and_of_counts(tmp_path):
    file = tmp_path / "oil.csv"
    file.write_text("# of the laboratory\ntime [d];ISO 4406\n0;20/18/15\n10,5;18/16/13\n")
    times, codes, sizes = read_reports(file)
    assert times.tolist() == [0.0, 10.5 * 24 * HOUR]
    assert (codes, sizes) == (["20/18/15", "18/16/13"], None)
    file.write_text("time [h],>4 um(c) [1/mL],6 um [1/mL]\n0,5000,1000\n")
    times, counts, sizes = read_reports(file)
    assert sizes.tolist() == [4e-6, 6e-6]
    np.testing.assert_allclose(counts, [[5e9, 1e9]], rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("time [h]\n0\n", "one of codes"),
        ("time,code\n0,18/16/13\n", "has no unit"),
        ("time [h],code\n", "no reports below"),
        ("time [h],code\n0,18/16/13,4\n", "line 2: 3 values"),
        ("time [h],code\n0,13/16/18\n", "line 2, column 2: .*impossible"),
        ("time [um],code\n0,18/16/13\n", "line 1, column 1: .*is a length"),
        ("time [h],a [1/mL],b [1/mL]\n0,1,2\n", "column 2: .*must be a size"),
        ("time [h],code\nx,18/16/13\n", 'line 2, column 1: "x" is not a number'),
        ("time [h],6 um [1/mL],4 um [1/mL]\n0,2,1\n", "column 3: .*must be of a larger size"),
        ("time [h],4 um [1/mL],6 um [1/mL]\n0,-2,-3\n", "column 3: .*must be 0 or more"),
        ("time [h],4 um [1/mL],6 um [1/mL]\n0,2,3\n", "column 3: .*is more than"),
        ("time [h],4 um [1/mL],6 um [1/mL]\n0,nan,3\n", "column 2: .*is not a finite number"),
    ],
)
def test_files_with_mistakes(tmp_path, text, words):
    file = tmp_path / "oil.csv"
    file.write_text(text)
    with pytest.raises(tb.errors.InvalidValue, match=words):
        read_reports(file)


def test_every_mistake_of_a_file_is_named_with_line_and_column(tmp_path):
    file = tmp_path / "oil.csv"
    file.write_text(
        "time [h],4 um [1/mL],6 um [1/mL]\n0,5000,x\n# a remark\n9,300,400\n8,-1,2\n7,1\n"
    )
    with pytest.raises(tb.errors.InvalidValue) as caught:
        read_reports(file)
    places = [str(each).split(": ")[0].removeprefix(f"{file}, ") for each in caught.value.problems]
    assert places == [
        "line 2, column 3", "line 4, column 3", "line 5, column 1", "line 5, column 2", "line 6",
    ]  # fmt: skip


def test_a_file_of_wrong_lines_says_how_many_more(tmp_path):
    file = tmp_path / "oil.csv"
    file.write_text("time [h],code\n" + "".join(f"{i},x\n" for i in range(30)))
    with pytest.raises(tb.errors.InvalidValue, match="has 10 more mistakes") as caught:
        read_reports(file)
    assert len(caught.value.problems) == 21


def test_one_report_is_too_few_where_two_are_needed(tmp_path):
    file = tmp_path / "oil.csv"
    file.write_text("time [h],code\n0,18/16/13\n")
    assert len(read_reports(file)[0]) == 1
    with pytest.raises(tb.errors.InvalidValue, match="line 2: one report; 2 or more"):
        read_reports(file, fewest=2)


def test_a_file_may_count_from_one_size_on(tmp_path):
    file = tmp_path / "oil.csv"
    file.write_text("time [h],4 um [1/mL]\n0,500\n1,0\n")
    _, counts, sizes = read_reports(file)
    np.testing.assert_allclose(counts, [[5e8], [0.0]])
    assert sizes.tolist() == [4e-6]


# ------------------------------------------------------------------------------ counts of 0
def rounded(counts, seed):
    """Counts per mL, as a counter of 25 mL that prints whole numbers tells them."""
    seen = np.random.default_rng(seed).poisson(counts * 25e-6) / 25
    return np.minimum.accumulate(np.floor(seen), axis=1) * 1e6


@pytest.mark.check
def test_counts_of_0_are_taken_and_their_band_holds_what_is_true():
    """4000 particles a second from 14 µm on that the filter keeps below one a millilitre."""
    fine = tb.oil.Filter(sizes=(4e-6, 10e-6), betas=(4.0, 75.0), flow=1e-3)
    rates = np.array([2e5, 6e4, 5e2])
    dust = tb.oil.Ingress.from_counts(sizes=SIZES, counts=rates, material=QUARTZ)
    case = dict(filters=fine, ingress=dust)
    times = np.array([0, 1, 5, 20]) * HOUR
    exact = reported(times, **case)
    assert np.all(exact[1:, 2] < 1e6)
    inside, zeros = [], 0
    for seed in range(20):
        counts = rounded(exact, seed)
        zeros += np.sum(counts == 0)
        found = oil_reports(times, reports=counts, circuit=circuit(**case))
        inside.append((found.low <= rates) & (rates <= found.high))
        assert found.high[2] < 10 * rates[2]  # a limit, not nothing
        np.testing.assert_allclose(found.rate[:2], rates[:2], rtol=0.1)
        assert found.counts.tolist() == counts.tolist()
    assert zeros >= 40
    assert np.all(np.mean(inside, axis=0) > 0.9)


def test_a_count_of_0_bounds_what_enters_by_hand():
    """One size, no filter: from 0 to 3e9 a volume of 0.2 m³ took 0.2 (3e9 − n_0), 0 ≤ n_0 < 1e6."""
    bare = circuit(filters=(), classes=None)
    exact = dict(sizes=[6e-6], circuit=bare, width=1.0 + 1e-9)
    found = oil_reports([0.0, 1e6], reports=[[0.0], [3e9]], least=1e9, **exact)
    assert found.rate[0] == pytest.approx(0.2 * 2.5e9 / 1e6, rel=1e-6)
    assert found.low[0] == pytest.approx(0.2 * 2e9 / 1e6, rel=1e-6)
    assert found.high[0] == pytest.approx(0.2 * 3e9 / 1e6, rel=2e-3)
    assert found.degrees == 0
    assert found.is_constant is None


def test_zeros_say_nothing_of_a_fit_that_obeys_them():
    times = np.array([0, 1, 2, 3]) * HOUR
    counts = np.array([[4e9, 1e9, 0.0]] * 4)
    found = oil_reports(times, reports=counts, circuit=circuit(filters=()))
    assert found.degrees == 8 - 6
    assert found.low[2] == pytest.approx(0.0, abs=1.0)
    assert np.all(found.fitted[:, 2] <= 1e6)


def test_reports_of_clean_oil_are_an_answer():
    found = oil_reports([0.0, HOUR], reports=[[0.0, 0.0, 0.0]] * 2, circuit=circuit())
    assert np.all(np.isfinite(found.rate))
    assert np.all(found.low <= found.rate)
    assert found.high[0] < 10 * 1e6 * (0.2 / HOUR + 2e-5)


# ------------------------------------------------------------------------------ what mass leaves out
@pytest.mark.parametrize("grade", ["A1", "A2", "A3", "A4"])
def test_mass_of_a_known_dust(grade):
    """What is missing of the mass of a dust is what the sentences say: below 4 µm, beyond 14 µm."""
    dust = tb.oil.Ingress.of_dust(grade, rate="334 mg/h", material=QUARTZ)
    wide = tb.oil.SizeClasses.covering(smallest=5e-7, largest=2.1e-4, per_octave=24)
    case = dict(ingress=dust, filters=(), classes=wide)
    times = np.array([0, 3, 8, 20]) * HOUR
    found = oil_reports(times, reports=reported(times, **case), circuit=circuit(**case))
    sizes, whole = dust.diameter, dust.diameter.moment(3)
    below, beyond = (
        float(sizes.partial_moment(3, *ends)) / whole for ends in ((0, 4e-6), (14e-6, 1))
    )
    # between the sizes: power laws are as near as `oil_reports` says
    between = dust.mass_rate * (1 - below - beyond)
    assert found.mass_rate * (1 - share_beyond(found)) == pytest.approx(between, rel=0.08)
    said = below_counts(found)
    if grade in ("A1", "A4"):
        assert f"{percent(below, digits=2)}" in said
    # and beyond, between the slopes of a coarse and of a fine dust, but for one that ends at 22 µm
    if grade != "A1":
        ends = sorted(mass_beyond(found, slope) for slope in (2.0, 5.0))
        assert ends[0] < dust.mass_rate * beyond < 1.06 * ends[1]


def test_mass_beyond_the_counts_by_numbers():
    """∫ x³ dN over a power law, by sums over a fine grid."""
    times = np.array([0, 3]) * HOUR
    found = oil_reports(times, reports=reported(times), circuit=circuit())
    edges = np.geomspace(14e-6, 70e-6, 20_001)
    above = (edges / 14e-6) ** -2.0 - (70 / 14) ** -2.0
    numbers = found.rate[2] * -np.diff(above) / above[0]
    middle = np.sqrt(edges[1:] * edges[:-1])
    mass = QUARTZ.density * np.pi / 6 * np.sum(numbers * middle**3)
    assert mass_beyond(found, 2.0) == pytest.approx(mass, rel=1e-6)


def test_counts_that_rise_with_the_size_are_refused():
    with refuses(Mistake.ORDER, "reports"):
        oil_reports([0.0, HOUR], reports=[[1e9, 2e8, 3e8]] * 2, circuit=circuit())
