"""How soon the counts of an oil end, which sizes take longer, and what R_0 is when it is none."""

import math
import warnings

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.systems.life.breeding import reproduction_of, why_unknown
from thirdbody.systems.life.code_times import times_within
from thirdbody.views.life_words import hidden_words, slow_words

QUARTZ = tb.materials["quartz"]
HALF = math.sqrt(2)


def oil(**changes):
    """One filter that takes all from 4 µm on alike; A3 dust enters."""
    given = {
        "volume": 0.2,
        "start": tb.oil.OilDirt.from_iso4406("22/20/17", material=QUARTZ),
        "ingress": tb.oil.Ingress.of_dust("A3-lot", rate="100 mg/h", material=QUARTZ),
        "filters": tb.oil.Filter(sizes=(3.9e-6,), betas=(1e9,), flow=1e-3),
        "viscosity": 0.03, "density": 870.0,
    }  # fmt: skip
    return tb.oil.OilCircuit(**(given | changes))


def history_of(circuit, duration=3.6e6):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return tb.life(oil=circuit, duration=duration)


def test_times_of_a_perfect_filter_are_closed():
    """n = n_∞ + (n_0 − n_∞) e^{−Qt/V}: within √2 of the end after (V/Q) ln((n_0/n_∞ − 1)/(√2 − 1))."""
    history = history_of(oil())
    ends = history.terms.classes.counted(history.terms.steady.sum(axis=1))
    for time, first, end in zip(history.code_times, history.counts[0], ends, strict=True):
        assert time == pytest.approx(200.0 * math.log((first / end - 1) / (HALF - 1)), rel=1e-6)


def test_a_count_that_rises_to_its_end():
    history = history_of(oil(start=()))
    assert history.code_times == pytest.approx([200 * math.log(1 / (1 - 1 / HALF))] * 3, rel=1e-6)


def test_a_clean_oil_ends_when_nothing_is_left():
    """Without ingress a count ends where the number 0 does, at 0.01 per mL."""
    history = history_of(oil(ingress=()))
    wanted = [200 * math.log(max(n / 1e4, 1)) for n in history.counts[0]]
    assert history.code_times == pytest.approx(wanted, rel=1e-6)


def test_a_count_without_an_end_has_no_time():
    history = history_of(oil(filters=()), duration=3600.0)
    assert all(math.isnan(each) for each in history.code_times)


@pytest.mark.parametrize("leak", [2e-7, 1e-5, 2e-4])
def test_a_leak_that_empties_the_circuit_hastens_the_end(leak):
    """With T in a constant volume, V = V_0 − q t ends it at (V_0/q)(1 − e^{−q T/V_0})."""
    history = history_of(oil(leak=leak), duration=60.0)
    ends = history.terms.classes.counted(history.terms.steady.sum(axis=1))
    for time, first, end in zip(history.code_times, history.counts[0], ends, strict=True):
        constant = 200.0 * math.log((first / end - 1) / (HALF - 1))
        assert time == pytest.approx(-0.2 / leak * math.expm1(-leak * constant / 0.2), rel=1e-6)


def test_the_last_time_counts():
    """One that overshoots comes to its end from the other side."""

    def course(t):
        return np.array([1e9 * (1 + 3 * math.exp(-t) - 2.5 * math.exp(-0.5 * t))])

    (time,) = times_within(course, np.array([1e9]), first=1e-3)
    assert course(0.0)[0] > 1e9 > course(time)[0]
    assert course(time)[0] == pytest.approx(1e9 / HALF, rel=1e-6)
    assert all(1 / HALF < course(t)[0] / 1e9 < HALF for t in np.linspace(time * 1.001, 50, 99))


@pytest.mark.parametrize(
    ("changes", "taken_by", "words"),
    [
        ({}, "", "grow in number for ever: no filter holds them and nothing else"),
        ({"settling_area": 0.5}, "settled", "no filter holds them and they settle slowly"),
        ({"leak": 1e-9, "make_up": 1e-9, "fresh_oil": ()}, "leaked", "only the leak takes them"),
    ],
)
def test_sizes_that_go_on_and_why(changes, taken_by, words):
    history = history_of(oil(**changes))
    slow = history.slow_sizes
    assert (slow.taken_by, slow.below <= 4e-6 * (1 + 1e-9)) == (taken_by, True)
    assert math.isinf(slow.time) is (taken_by == "")
    (told,) = slow_words(history)
    assert words in told
    assert "no number of the code counts" in told
    if taken_by == "leaked":
        assert slow.time == pytest.approx(math.log(100) * 0.2 / 1e-9, rel=1e-9)


def test_a_filter_that_holds_all_leaves_nothing_slow():
    assert (
        history_of(
            oil(filters=tb.oil.Filter(sizes=(0.1e-6,), betas=(100.0,), flow=1e-3))
        ).slow_sizes
        is None
    )


def test_the_code_stays_while_dirt_rises():
    history = history_of(oil())
    (told,) = hidden_words(history)
    assert f"The code stays at {history.codes[-1]}" in told
    dirt = 1e3 * history.mass_per_volume.sum(axis=1)[-1]
    assert f"to {dirt:.3g} mg/L" in told
    all_held = tb.oil.Filter(sizes=(0.1e-6,), betas=(100.0,), flow=1e-3)
    assert hidden_words(history_of(oil(filters=all_held))) == []


# ------------------------------------------------------------------------------ R_0
def test_what_is_never_removed_and_breeds_nothing_has_no_part():
    births = np.array([[2e-4, 0.0], [5e-4, 0.0]])
    assert reproduction_of(births, np.diag([1e-3, 0.0])) == pytest.approx(0.2, rel=1e-12)
    # it is what many removals so slow that they do not matter come to
    slow = reproduction_of(births, np.diag([1e-3, 1e-12]))
    assert slow == pytest.approx(0.2, rel=1e-12)


def test_what_is_never_removed_and_breeds_has_no_number():
    births = np.array([[2e-4, 1e-4], [5e-4, 0.0]])
    assert math.isnan(reproduction_of(births, np.diag([1e-3, 0.0])))
    why = why_unknown(births, np.diag([1e-3, 0.0]), np.array([1e-6, 2e-6]), ("quartz", "debris 1"))
    assert why.startswith("debris 1 up to 2 µm ")


def test_an_oil_alone_says_why_it_is_0():
    history = history_of(oil())
    assert history.R0 == 0
    assert history.reproduction == (
        "debris makes no new debris (R₀ = 0): the study has no contact that returns any to the oil"
    )
    assert history.to_dict()["reproduction"] == history.reproduction


STEEL = tb.materials["S45C"].replace(density=7850.0)


@pytest.mark.parametrize(
    ("changes", "debris", "words"),
    [
        ({"slide_roll": 0.0}, {"hardness": 9e9}, "slide_roll = 0"),
        ({}, {}, "no harder than the surfaces"),
        ({"wear": {"f_ab": 0.0}}, {"hardness": 9e9}, "f_ab, f_roll and K_sa are 0"),
    ],
)
def test_a_contact_says_why_it_is_0(changes, debris, words):
    wear = {"K_ss": 1e-7, "K_sa": 0.0, "f_ab": 0.1, "f_roll": 0.0} | changes.get("wear", {})
    contact = tb.Contact(
        surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        outputs=(tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8), tb.outputs.Wear(**wear)),
    )  # fmt: skip
    coarse = tb.oil.SizeClasses.covering(smallest=0.5e-6, largest=260e-6, per_octave=2)
    circuit = oil(settling_area=0.1, classes=coarse)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = tb.life(
            contact, oil=circuit, conjunction=tb.films.Point(R=9.5e-3),
            lubricant=tb.films.Oil(eta=0.03, alpha=2e-8), load=50.0, speed=1.0,
            slide_roll=changes.get("slide_roll", 0.05), entry_ratio=0.1,
            debris=tb.oil.Debris.boundary_lubricated(**debris), duration=600.0,
        )  # fmt: skip
    assert found.R0 == 0
    assert words in found.reproduction
    # without feedback the counts end as those of the oil alone do
    alone = history_of(circuit, duration=600.0)
    assert found.code_times == pytest.approx(alone.code_times, rel=1e-3)


# ------------------------------------------------------------------------------ the ingress
def test_an_ingress_that_fills_filters_within_a_day_is_doubted():
    sheet = tb.oil.Filter(sizes=(3.9e-6,), betas=(1e9,), flow=1e-3, capacity=0.05)
    much = oil(
        filters=sheet, ingress=tb.oil.Ingress.of_dust("A3-lot", rate="30 g/h", material=QUARTZ)
    )
    (note,) = (each for each in much.notes() if each.code == "life.ingress")
    assert "50 g" in note
    assert " 1." in note
    assert note.action
    assert all(each.code != "life.ingress" for each in oil(filters=sheet).notes())


def test_a_word_in_the_place_of_events_is_named_whole():
    with pytest.raises(tb.errors.InvalidValue, match="18/16/13"):
        tb.life(oil=oil(), duration=60.0, until="18/16/13")
    with pytest.raises(tb.errors.InvalidValue, match="until"):
        tb.life(oil=oil(), duration=60.0, until=7)
