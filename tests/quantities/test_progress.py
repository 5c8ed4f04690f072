"""Long work says what it costs and how far it is, whoever does it, by a clock of the test."""

import threading
import warnings

import numpy as np
import pytest

import thirdbody as tb
from thirdbody.quantities import progress

STEEL = tb.materials["S45C"]
BARE = tb.Contact(
    surfaces=tb.MaterialPair(STEEL, STEEL), roughness=tb.Roughness(sigma=1e-7, R=2.8e-6)
)
PLANE = BARE.replace(
    particles=tb.Particles(
        material=tb.materials["SiO2"],
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    ),
    particle_law=tb.particle.Series(deep="off", seat="plane"),
    **{"roughness.heights": tb.heights.HistogramHeights(edges=(0, 1, 2, 3), counts=(1, 3, 1))},
)
"""With heights that no engine knows."""


class Clock:
    """Every look at it is a step later."""

    def __init__(self, step):
        self.now, self.step = 100.0, step

    def monotonic(self):
        self.now += self.step
        return self.now


@pytest.fixture(params=[1e-6, 2.0], ids=["quick", "slow"])
def slow(request, monkeypatch):
    monkeypatch.setattr(progress, "time", Clock(request.param))
    return request.param > 1


def fresh(slow):
    """A contact that no other test has bound."""
    return PLANE.replace(**{"particles.diameter.std": 20e-9 if slow else 22e-9})


def heard(call):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        result = call()
    return result, [each for each in found if each.category is tb.errors.SlowWarning]


def states(count, **options):
    """States that no engine solves together."""
    mean = np.linspace(280e-9, 320e-9, count)
    vary = {"particles.diameter.mean": mean, "particles.material.H": np.linspace(6e9, 9e9, count)}
    return tb.equilibria.solve_states(PLANE, pressure=1e6, vary=vary, **options)


def test_states_that_take_long_say_so_once_and_why(slow):
    found, told = heard(lambda: states(24))
    if not slow:
        assert told == []
        return
    (one,) = told
    assert str(one.message).startswith("24 states take some ")
    assert "solved one by one" in str(one.message)
    (why,) = {str(word).removeprefix("numpy: ") for word in found.engine.values}
    assert why in str(one.message)
    assert one.filename == __file__


def test_states_tell_how_many_are_solved(slow):
    told = []
    found, words = heard(lambda: states(24, progress=told.append))
    assert words == []
    assert told[-1] == 24
    assert told == sorted(told)
    if slow:
        assert len(told) > 5
    for name, column in states(24).items():
        np.testing.assert_array_equal(column.values, found[name].values)


def test_a_block_of_a_sweep_moves_the_bar(slow, monkeypatch):
    told, heard = [], []
    monkeypatch.setattr(progress, "_terminal", lambda: False)
    monkeypatch.setattr(progress, "_lines", lambda *about: told.append)
    axes = {"particles.material.H": np.linspace(6e9, 9e9, 24)}
    tb.sweep(PLANE, pressure=1e6, vary=axes, progress=True)
    assert told[-1] == 24
    assert told == sorted(set(told))
    if slow:
        assert len(told) > 5
    tb.sweep(PLANE, pressure=1e6, vary=axes, progress=heard.append)
    assert heard == [24]  # the block is one, and a function hears of states solved for good


@pytest.mark.spread(2)
def test_samples_that_take_long_say_so(slow):
    contact = fresh(slow)
    vary = {"particles.diameter.mean": (290e-9, 310e-9), "particles.material.H": (6e9, 9e9)}
    asked = {"vary": vary, "pressure": 1e6, "samples": 64, "outputs": ["d"]}
    exact, told = heard(lambda: tb.propagate(contact, **asked))
    assert [str(each.message).startswith("64 contacts of propagate take") for each in told] == (
        [True] if slow else []
    )
    counts = []
    same, told = heard(lambda: tb.propagate(contact, **asked, progress=counts.append))
    assert told == []
    np.testing.assert_array_equal(same.bands["d"], exact.bands["d"])


def test_derivatives_that_take_long_say_so(slow):
    asked = {"of": "A_t", "to": ["particles.material.H", "surfaces.first.H"], "pressure": 1e6}
    _, told = heard(lambda: tb.sensitivity(fresh(slow), **asked))
    assert bool(told) == slow


RUBBING = PLANE.replace(
    outputs=tb.outputs.Friction(tau_ss=1e8, tau_sa=1e8),
    particle_law=tb.particle.Series(deep="off"),
    **{"roughness.heights": tb.heights.GaussianHeights()},
)
"""States of it are solved together, but not their outputs."""


@pytest.mark.parametrize("work", ["propagate", "sensitivity"])
def test_contacts_with_outputs_are_promised_as_many_as_there_are(work, monkeypatch):
    """And what is said names the output that makes them slow."""
    made, reasons = [], set()

    class Seen(progress.Cost):
        def __init__(self, total, *others, **options):
            super().__init__(total, *others, **options)
            made.append(self)

        def __call__(self, count, why=""):
            reasons.add(why)
            super().__call__(count, why)

    monkeypatch.setattr(progress, "Cost", Seen)
    if work == "propagate":
        vary = {"roughness.sigma": (9e-8, 1.1e-7), "particles.diameter.mean": (290e-9, 310e-9)}
        tb.propagate(RUBBING, vary=vary, pressure=1e6, samples=4096, outputs=["mu", "A_t"])
    else:
        to = ["roughness.sigma", "outputs.friction.tau_ss", "outputs.friction.tau_sa"]
        tb.sensitivity(RUBBING, of="mu", to=to, pressure=1e6)
    (cost,) = made
    assert 0.5 < cost.done / cost.total < 2
    assert all("mu" in why.split() for why in reasons)


SURFACES = {"surfaces": 2, "size": 32, "spacing": 3e-7, "F_star": 1e-3}


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
@pytest.mark.parametrize("workers", [1, 2])
def test_surfaces_that_take_long_say_so(slow, workers):
    asked = {**SURFACES, "workers": workers}
    _, told = heard(lambda: tb.explicit.ensemble(BARE, **asked))
    assert len(told) == slow
    counts = []
    _, told = heard(lambda: tb.explicit.ensemble(BARE, **asked, progress=counts.append))
    assert (counts, told) == ([1, 2], [])


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_loads_on_a_surface_that_take_long_say_so(slow):
    surface = tb.explicit.surface_of(BARE, size=32, spacing=3e-7)
    loads = np.geomspace(1e-4, 1e-3, 8)
    _, told = heard(lambda: tb.explicit.solve(BARE, surface, F_star=loads))
    assert len(told) == slow
    counts = []
    options = {"F_star": loads, "blocks": 2, "progress": counts.append}
    _, told = heard(lambda: tb.explicit.solve(BARE, surface, **options))
    assert told == []
    assert counts == sorted(counts)
    if slow:
        assert counts[-1] == 16  # each load again, for the blocks


@pytest.mark.filterwarnings("ignore::thirdbody.errors.RangeWarning")
def test_surfaces_are_a_part_of_a_work(monkeypatch):
    monkeypatch.setattr(progress, "time", Clock(2.0))
    monkeypatch.setattr(progress, "_terminal", lambda: False)
    monkeypatch.setattr(progress, "EVERY", 10.0)
    with progress.stages("work", 1) as parts:
        parts("surfaces")
        tb.explicit.ensemble(BARE, **SURFACES, progress=parts)

    assert parts.said
    assert parts.promised > progress.LONG
    with progress.stages("work", 1) as parts:
        parts("surfaces")
        shown = []
        parts.show = lambda share, words: shown.append(share)
        tb.explicit.ensemble(BARE, **SURFACES, progress=parts)
    assert shown == sorted(shown)
    assert len(set(shown)) > 5
    assert 0.9 < shown[-1] <= 1


@pytest.fixture
def clock(monkeypatch):
    """The time of a work in a pipe, which passes where a test says so."""
    made = Clock(0.0)
    monkeypatch.setattr(progress, "time", made)
    monkeypatch.setattr(progress, "_terminal", lambda: False)
    return made


def test_parts_of_a_work_tell_what_is_done_of_each(clock, capsys):
    with progress.stages("assess", 2) as work:
        work("samples")
        work.expect(40)
        with progress.count_contacts(30, work.report_contacts):
            for _ in range(30):
                clock.now += 2.0
                progress.advance()
        work("others")
    assert capsys.readouterr().err.splitlines() == [
        "assess: about 40 contacts, 2 s each: some 80 s",
        "assess: samples, 15 of about 30",
        "assess: samples, 30 of about 30",
    ]


def test_what_takes_much_longer_is_promised_anew(clock, capsys):
    with progress.stages("assess", 1) as work:
        work("ways")
        work.expect(40)
        with progress.count_contacts(30, work.report_contacts):
            for k in range(60):  # more of them, and dearer ones
                clock.now += 0.5 if k < 10 else 4.0
                progress.advance()
        assert work.promised == pytest.approx(clock.now, rel=0.5)
    promises = [line for line in capsys.readouterr().err.splitlines() if "s each" in line]
    assert 2 <= len(promises) <= 5


def test_what_is_compiled_before_is_no_cost_of_a_contact(clock, capsys):
    with progress.stages("assess", 1) as work:
        work("samples")
        work.expect(4000)
        clock.now += 60.0
        with progress.count_contacts(30, work.report_contacts):
            for _ in range(30):
                clock.now += 0.1
                progress.advance()
    assert "about 4,000 contacts, 0.1 s each: some 7 minutes" in capsys.readouterr().err


@pytest.mark.usefixtures("clock")
def test_what_is_quick_says_nothing(capsys):
    with progress.stages("assess", 1) as work:
        work("samples")
        work.expect(40)
        with progress.count_contacts(30, work.report_contacts):
            for _ in range(30):
                progress.advance()
    assert capsys.readouterr().err == ""


def test_a_part_of_another_work_moves_its_bar():
    shown = []

    class Outer(progress.Stages):
        def show(self, part, more):
            shown.append((self.begun + part, more))

    outer = Outer("report")
    outer("states")
    outer("error bars")
    inner = progress.nested_stages(outer, 2)
    inner("samples")
    inner.show(0.5, "half")
    inner("ends")
    inner("error bars")  # as the part around it
    inner.show(0.5, "half")
    assert shown == [
        (0.0, ""),
        (1.0, ""),
        (1.0, "samples"),
        (1.25, "samples, half"),
        (1.5, "ends"),
        (2.0, ""),
        (2.25, "half"),
    ]


@pytest.fixture
def beats(monkeypatch):
    """A function that waits for the next lines of a heartbeat, and gives the last."""
    lines, told = [], threading.Event()

    def hear(line, **_):
        lines.append(line)
        told.set()

    def after(count):
        for _ in range(count):
            told.clear()
            assert told.wait(60)
        return lines[-1]

    monkeypatch.setattr(progress, "print", hear, raising=False)
    monkeypatch.setattr(progress, "EVERY", 1e-3)
    monkeypatch.setattr(progress, "_terminal", lambda: False)
    return after


def test_a_work_without_parts_says_that_it_goes_on(beats, monkeypatch):
    monkeypatch.setattr(progress, "time", clock := Clock(0.0))
    threads = threading.active_count()
    with progress.heartbeat("solve"):
        assert beats(1) == "solve: still at work after 0 s"
        clock.now += 240.0
        for _ in range(3):
            progress.advance()
        assert beats(3) == "solve: still at work after 4 minutes, contacts so far: 3"
    assert threading.active_count() == threads


def test_a_work_that_fails_stops_its_heartbeat(beats):
    threads = threading.active_count()

    @progress.heartbeat("solve")
    def failing():
        beats(1)
        raise tb.errors.InvalidValue("no")

    with pytest.raises(tb.errors.InvalidValue):
        failing()
    assert threading.active_count() == threads


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(12, "12 s"), (89, "89 s"), (95, "1.5 minutes"), (700, "12 minutes"), (7300, "2 hours")],
)
def test_durations_in_words(seconds, words):
    assert progress.duration(seconds) == words


def test_what_is_compiled_once_counts_in_no_estimate(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(progress, "_ASIDE", [0.0])
    cost = progress.Cost(900, lambda states: None, what="states")
    cost(100)
    with progress.aside():
        now[0] += 40.0
    now[0] += 1.5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cost(600)
