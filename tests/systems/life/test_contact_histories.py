"""Contacts over time: against closed forms, matrix exponentials, and the oil alone."""

import json
import warnings

import numpy as np
import pytest
from contact_cases import CLASSES, DEBRIS, DRY, FILM, NO_WEAR, QUARTZ, SOFT, STEEL, contact, oil
from refusals import Mistake, refuses
from scipy.linalg import expm

import thirdbody as tb
from thirdbody.systems.life.debris import Debris
from thirdbody.systems.life.loop import Loop
from thirdbody.systems.life.surfaces import RunningIn
from thirdbody.systems.life.until import particle_share, roughness_below, wear_depth


def codes_of(found):
    """Codes of the warnings of a history."""
    return [note.code for note in found.warnings]


def run(*args, **given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return tb.life(*args, **given)


@pytest.fixture(scope="module")
def filmed():
    return run(contact(), oil=oil(), duration=7.2e5, debris=DEBRIS, **FILM)


@pytest.fixture(scope="module")
def dry():
    return run(contact(STEEL, SOFT), duration=7.2e3, debris=DEBRIS, **DRY)


# ------------------------------------------------------------------ closed forms
@pytest.mark.check
def test_a_clean_contact_wears_as_its_wear_says():
    sliding = contact(STEEL, SOFT, K_ss_ep=1e-6, K_ss_e=1e-6)
    clean = run(sliding, duration=3.6e6, debris=DEBRIS, **(DRY | dict(arrivals=(), loss=1.0)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        state = tb.solve(sliding, pressure=5e6)
    # before debris comes to bear: K A_ss v
    rate = clean.more["wear_rate_2"][1][0]
    assert rate == pytest.approx(1e-6 * state.A_ss * 0.1, rel=1e-5)
    assert clean.more["wear_1"][1][0] == 0


def test_numbers_of_the_oil_are_a_matrix_exponential(filmed):
    """At a gap that hardly moves everything is linear: the same by another road."""
    loop, y = filmed.loop, filmed.last_state
    quiet = run(contact(), oil=oil(filters=oil().filters[0].replace(capacity=None)),
                duration=7.2e5, debris=DEBRIS, **FILM)  # fmt: skip
    loop, y = quiet.loop, quiet.last_state
    start = np.zeros_like(y)
    start[loop.layout["oil"]] = 0.2 * quiet.terms.start.T.ravel()
    start[loop.layout["sigma"]] = 1e-7
    loop.now = 0.0
    rates = loop.rates(start, loop.find_gap(start).d)
    n = len(start)
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = rates.matrix, rates.constant
    exact = expm(whole * 7.2e5) @ np.append(start, 1.0)
    pool = loop.layout["oil"]
    np.testing.assert_allclose(y[pool], exact[:n][pool], rtol=2e-4, atol=5.0)


@pytest.mark.check
def test_the_jacobian_is_the_slope_of_the_rates(filmed, dry):
    for history in (filmed, dry):
        loop, y = history.loop, history.last_state.copy()
        J, f0 = loop.jacobian(0.0, y), loop.derivative(0.0, y)
        pool = loop.layout[loop.pool]
        for j in np.argsort(y[pool])[-6:] + pool.start:
            there = y.copy()
            there[j] *= 1 + 1e-4
            numerical = (loop.derivative(0.0, there) - f0) / (there[j] - y[j])
            wide = np.max(np.abs(numerical[pool]))
            np.testing.assert_allclose(J[pool, j], numerical[pool], atol=2e-3 * wide)


def test_births_are_the_slope_of_the_debris_over_the_numbers(filmed):
    loop, y = filmed.loop, filmed.last_state
    d = loop.find_gap(y).d
    worn = loop.layout["wear_1"]
    pool = loop.layout["oil"]
    rates = loop.rates(y, d)
    volume = rates.matrix[worn, pool][0] * loop.setting.worn_area[0]
    kind = loop.setting.debris[0]
    mine = slice(kind * loop.classes, (kind + 1) * loop.classes)
    bred = loop.volumes[mine] @ rates.births[mine]
    np.testing.assert_allclose(bred, np.maximum(volume, 0.0), rtol=1e-12)


# ------------------------------------------------------------------ accounts
def test_mass_closes(filmed, dry):
    assert filmed.ledger.residual < 1e-9
    assert dry.ledger.residual < 1e-9
    stay = run(contact(STEEL, SOFT), duration=3.6e3, debris=DEBRIS, stays=0.4, **DRY)
    assert stay.ledger.residual < 1e-9
    assert stay.ledger.went["embedded"][-1] > 0


def test_mass_closes_with_everything_on():
    changed = oil(oil_changes=(3e5,), fresh_oil=oil().start, make_up=1e-9, leak=2e-9)
    found = run(contact(), oil=changed, duration=6e5, debris=DEBRIS, stays=0.5,
                running_in=RunningIn(sigma_end=80e-9, length=1e-6),
                strengths={QUARTZ: tb.grains.WeibullStrength.of(QUARTZ)}, **FILM)  # fmt: skip
    assert found.ledger.residual < 1e-9
    assert found.ledger.went["finer than the classes"][-1] > 0
    assert {event.name for event in found.events} >= {"oil change", "filter full"}
    assert found.numbers.min() >= -1.0 / 0.2


def test_no_number_is_below_nothing(filmed, dry):
    assert filmed.numbers.min() * 0.2 > -1.0
    assert dry.numbers.min() >= -1e-6 * dry.numbers.max()


# ------------------------------------------------------------------ layers
def test_without_wear_the_oil_runs_as_it_does_alone_bit_for_bit():
    circuit = oil()
    alone = run(oil=circuit, duration=7.2e5)
    both = run(contact(**NO_WEAR), oil=circuit, duration=7.2e5, **FILM)
    assert np.array_equal(alone.times, both.times)
    assert np.array_equal(alone.numbers, both.numbers)
    assert alone.ledger.rows() == both.ledger.rows()
    assert alone.events == both.events
    assert both.R0 == 0
    assert both.more["dents_1"][1][-1] > 0


def test_without_wear_the_steps_agree_with_the_exact_oil():
    circuit = oil()
    alone = run(oil=circuit, duration=7.2e5)
    steps = run(contact(**NO_WEAR), oil=circuit, duration=7.2e5, debris=DEBRIS, **FILM)
    place = np.searchsorted(steps.times, alone.times).clip(max=len(steps.times) - 1)
    same = steps.times[place] == alone.times
    np.testing.assert_allclose(
        steps.numbers[place][same][..., :1], alone.numbers[same], rtol=1e-4, atol=50.0
    )
    assert [e.time for e in steps.events] == pytest.approx([e.time for e in alone.events], rel=1e-4)


def test_a_roughness_that_ends_where_it_begins_stays(dry):
    still = run(contact(STEEL, SOFT), duration=7.2e3, debris=DEBRIS,
                running_in=RunningIn(sigma_end=100e-9), **DRY)  # fmt: skip
    assert np.all(still.more["sigma"][1] == pytest.approx(100e-9, rel=1e-12))
    for name in ("wear_1", "wear_2", "h"):
        np.testing.assert_allclose(still.more[name][1], dry.more[name][1], rtol=1e-4)


def test_roughness_runs_in_over_its_length():
    law = RunningIn(sigma_end=60e-9, length=1e-7)
    found = run(contact(), oil=oil(), duration=7.2e6, debris=DEBRIS, running_in=law, **FILM)
    worn = found.more["wear_1"][1] + found.more["wear_2"][1]
    exact = 60e-9 + 40e-9 * np.exp(-worn / 1e-7)
    np.testing.assert_allclose(found.more["sigma"][1], exact, rtol=1e-5)
    assert "life.running_in" in codes_of(found)


@pytest.mark.check
def test_exchanged_surfaces_exchange_their_wear(dry):
    turned = DRY | dict(moving=2, worn_area=(1e-4, 1e-3))
    other = run(contact(SOFT, STEEL), duration=7.2e3, debris=DEBRIS, **turned)
    for one, two in (("wear_1", "wear_2"), ("wear_2", "wear_1")):
        np.testing.assert_allclose(other.more[one][1], dry.more[two][1], rtol=1e-3, atol=1e-16)


# ------------------------------------------------------------------ where it goes
def test_a_steady_state_is_where_the_history_ends():
    # what is held in the softer surface goes with it
    long = run(contact(STEEL, SOFT), duration=3.6e5, debris=DEBRIS,
               **(DRY | dict(loss=1.0, moving=2)))  # fmt: skip
    numbers, rate = long.numbers[-1], long.more["wear_rate_2"][1][-1]
    states = [each for each in long.steady() if each.stable]
    assert len(states) == 1
    wide = numbers.max()
    moving = numbers[:, :].copy()
    np.testing.assert_allclose(states[0].numbers, moving, rtol=1e-3, atol=1e-4 * wide)
    assert states[0].wear_rate[1] == pytest.approx(rate, rel=1e-3)


def test_the_oil_with_a_contact_ends_in_its_steady_state():
    circuit = oil(filters=oil().filters[0].replace(capacity=None))
    found = run(contact(), oil=circuit, duration=3.6e6, debris=DEBRIS, **FILM)
    (state,) = found.steady()
    counts = CLASSES.counted(found.numbers[-1].sum(axis=1))
    steady = CLASSES.counted(state.numbers.sum(axis=1))
    assert state.stable
    assert counts[1:] == pytest.approx(steady[1:], rel=1e-4)
    assert 0 < found.R0 < 1e-3
    assert "does not feed itself" in found.reproduction


def test_debris_as_soft_as_the_surfaces_breeds_less():
    soft = Debris(diameter=DEBRIS.diameter, hardness=None)
    hard = run(contact(), oil=oil(), duration=3.6e4, debris=DEBRIS, **FILM)
    own = run(contact(), oil=oil(), duration=3.6e4, debris=soft, **FILM)
    assert own.R0 < hard.R0


# ------------------------------------------------------------------ kept and resumed
class Enough(Exception):
    """An interruption."""


@pytest.mark.check
@pytest.mark.parametrize("conditions", [dict(oil=oil(), **FILM), DRY], ids=["film", "dry"])
def test_an_interrupted_history_goes_on_to_the_same_numbers(tmp_path, monkeypatch, conditions):
    asked = dict(duration=3.6e4, debris=DEBRIS, running_in=RunningIn(sigma_end=80e-9), **conditions)
    whole, file = run(contact(STEEL, SOFT), **asked), tmp_path / "kept.jsonl"
    computed = Loop.derivative
    left = [20]

    def counting(self, time, y):
        left[0] -= 1
        if left[0] == 0:
            raise Enough
        return computed(self, time, y)

    monkeypatch.setattr(Loop, "derivative", counting)
    with pytest.raises(Enough):
        run(contact(STEEL, SOFT), keep=file, **asked)
    assert len(file.read_text().splitlines()) >= 20
    with file.open("a") as out:
        out.write('{"of": 3, "warm')  # a line that was being written
    left[0] = -1  # counts on below 0
    resumed = run(contact(STEEL, SOFT), keep=file, **asked)
    assert resumed.to_dict() == whole.to_dict()
    done, before = -left[0], file.read_bytes()
    again = run(contact(STEEL, SOFT), keep=file, **asked)
    assert again.to_dict() == whole.to_dict()
    assert file.read_bytes() == before
    assert -left[0] < done + 5  # no step is computed a second time
    lines = file.read_text().splitlines()
    entry = json.loads(lines[len(lines) // 2])
    entry["value"] = "AAAA" + entry["value"][4:]  # a number that was changed is not believed
    lines[len(lines) // 2] = json.dumps(entry)
    file.write_text("\n".join([*lines, ""]))
    assert run(contact(STEEL, SOFT), keep=file, **asked).to_dict() == whole.to_dict()
    assert file.read_bytes() == before
    with refuses(Mistake.OTHER_STUDY, "", says=file.name):
        run(contact(), keep=file, **asked)


def test_an_oil_alone_needs_no_file():
    with refuses(Mistake.IDLE, "keep"):
        run(oil=oil(), duration=10.0, keep="kept.jsonl")


# ------------------------------------------------------------------ events and refusals
def test_a_leak_that_empties_the_oil_of_a_contact_is_refused():
    leaking = oil(leak=1e-6)
    with refuses(Mistake.RANGE, "duration"):
        run(contact(), oil=leaking, duration=3.6e6, debris=DEBRIS, **FILM)


def test_a_filter_past_which_the_oil_goes_takes_nothing_out_in_the_end():
    full = oil(filters=oil().filters[0].replace(capacity=1e-6, when_full="bypass"),
               settling_area=0.0)  # fmt: skip
    found = run(oil=full, duration=3.6e4)
    assert found.bypassed == ("filter",)
    scales = found.time_scales
    assert "oil through the filters once" not in scales
    assert np.isnan(scales["removal of particles of 14 µm"])
    assert found.slow_sizes.below == pytest.approx(16e-6)
    assert found.slow_sizes.time == np.inf


def test_a_history_waits_for_wear_and_roughness():
    law = RunningIn(sigma_end=60e-9, length=1e-7)
    found = run(contact(), oil=oil(), duration=7.2e6, debris=DEBRIS, running_in=law, **FILM,
                until=[roughness_below(95e-9, stops=False), wear_depth(9e-9)])  # fmt: skip
    names = [event.name for event in found.events if event.name != "filter full"]
    assert names == ["roughness", "wear depth"]
    deepest = max(found.more["wear_1"][1][-1], found.more["wear_2"][1][-1])
    assert deepest == pytest.approx(9e-9, rel=1e-6)
    assert found.times[-1] == found.events[-1].time


def test_shares_are_waited_for_only_where_a_contact_holds_a_particle():
    found = run(contact(), oil=oil(), duration=3.6e4, debris=DEBRIS, **FILM,
                until=particle_share(1e-12))  # fmt: skip
    assert found.events == () or all(e.name != "particle share" for e in found.events)
    assert "life.single" in codes_of(found)


@pytest.mark.parametrize(
    ("given", "code"),
    [
        (dict(debris=None), Mistake.MISSING),
        (dict(entry_ratio=-1.0), Mistake.RANGE),
        (dict(colour=3), Mistake.UNKNOWN),
        (dict(worn_area=(1.0, -1.0)), Mistake.RANGE),
        (dict(stays=2.0), Mistake.RANGE),
    ],
)
def test_bad_input_is_refused(given, code):
    with refuses(code, next(iter(given))):
        run(contact(), oil=oil(), duration=3.6e4, **(dict(debris=DEBRIS) | FILM | given))


def test_a_missing_condition_is_named_with_what_to_do():
    lost = {name: value for name, value in FILM.items() if name != "entry_ratio"}
    with refuses(Mistake.MISSING, "entry_ratio"):
        run(contact(), oil=oil(), duration=3.6e4, debris=DEBRIS, **lost)
    bare = contact(STEEL.replace(density=None))
    with refuses(Mistake.MISSING, "density of surface 1"):
        run(bare, oil=oil(), duration=3.6e4, debris=DEBRIS, **FILM)


@pytest.fixture(scope="module")
def hard():
    """Two hard surfaces: all that comes in leaves."""
    return run(contact(), duration=600.0, debris=DEBRIS, **DRY)


def test_one_name_gives_the_steady_states_of_both_kinds(filmed, hard):
    """With a contact its debris counts: more particles than the same oil has alone."""
    (oil,) = filmed.steady()
    alone = tb.results.LifeHistory.steady(filmed)[0]
    assert oil.numbers.sum() >= alone.numbers[:, : oil.numbers.shape[1]].sum() * (1 - 1e-9)
    assert filmed.to_dict()["steady"][0]["code"] == oil.code
    (rubbed,) = hard.steady()
    assert type(rubbed) is type(oil)
    assert rubbed.code == ""


def test_the_gain_of_dirt_is_that_of_the_linear_balance(hard):
    """(𝓛 − 𝒢)⁻¹ s over 𝓛⁻¹ s, by hand."""
    source = hard.loop.arrivals.reshape(hard.loop.kinds, -1).T.ravel()
    whole = np.linalg.solve(hard.losses - hard.births, source).sum()
    assert hard.R0 < 1
    assert hard.dirt_gain == pytest.approx(whole / np.linalg.solve(hard.losses, source).sum())
    assert hard.dirt_gain >= 1


def test_names_of_the_life_are_at_the_top():
    assert tb.oil.Debris is Debris
    assert tb.oil.RunningIn is RunningIn
    assert tb.oil.until.wear_depth(5e-6) == wear_depth(5e-6)
    dents = tb.oil.entry_ratio_from_dents
    assert dents.__module__ == "thirdbody.systems.life.entry"
    assert tb.oil.oil_reports.__module__ == "thirdbody.systems.life.reports"


def test_records_are_handed_out(filmed, dry):
    data = filmed.histories
    assert data["wear_1"].attrs["units"] == "m"
    assert dry.histories["eta"].dims == ("time", "class", "material")
    assert filmed.to_dict()["reproduction"] == filmed.reproduction
    assert {row[0] for row in dry.flows()} == {"arrivals", "worn 1", "worn 2", "contact"}
    assert filmed.time_scales["passage of a contact"] < 1e-2
    assert dry.to_dict()["R0"] == dry.R0 or np.isnan(dry.R0)


@pytest.mark.parametrize("kind", ["filmed", "hard"])
def test_histories_of_contacts_as_data_and_as_a_table(kind, request):
    history = request.getfixturevalue(kind)
    data, table = history.to_dataset(), history.to_dataframe()
    assert table.index.name == "time"
    np.testing.assert_array_equal(table.index, history.times)
    for name, (about, values) in history.more.items():
        np.testing.assert_array_equal(data[name], values)
        np.testing.assert_array_equal(table[name], values)
        assert table.attrs["units"][name] == data[name].units == about.unit
    numbers = data["n" if kind == "filmed" else "eta"]
    at = {"class": numbers["class"].values[2], "material": str(numbers["material"].values[0])}
    column = f"{numbers.name}[{at['class']}][{at['material']}]"
    np.testing.assert_array_equal(table[column], history.numbers[:, 2, 0])
    assert type(history).__name__ in history._repr_html_()
