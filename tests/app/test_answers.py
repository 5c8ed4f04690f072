"""Answers of the page: forces as the command line tells them, axes, maps, processes that end."""

import asyncio
import contextlib
import os
import re
import signal
import time
import tomllib
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from thirdbody.study import check, run_study

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

from thirdbody.app import figures
from thirdbody.app.examples import EXAMPLES, example
from thirdbody.app.jobs import Job
from thirdbody.app.page import Page, _time_words
from thirdbody.app.python_text import to_python
from thirdbody.app.solver import TRIES, Died, Solver, ended_by, note_waits
from thirdbody.app.state import State
from thirdbody.app.tabs import curves, interface, mode_map, outputs
from thirdbody.equilibrium.words import meets
from thirdbody.systems.bodies import press

ROOT = Path(__file__).parents[2]
BALL = {
    "surfaces": {"first": "100Cr6", "second": "100Cr6"},
    "roughness": {"Ra": "0.4 um", "process": "ground"},
    "body": {"kind": "ball-on-flat", "diameter": "6.35 mm"},
    "particles": {"material": "S45C", "iso4406": "18/16/13", "gap": "1 um", "level": "middle"},
    "load": {"force": "20 N"},
}
"""A ball on a flat in oil: one contact holds far less than one particle."""


# ---------------------------------------------------------------- forces
@pytest.mark.check
@pytest.mark.spread(3)
@pytest.mark.parametrize("force", ["20 N", ["20 N", "40 N"], ["5 N", "10 N", "20 N", "40 N"]])
def test_a_force_is_told_in_the_words_of_the_command_line(force, tmp_path):
    study = BALL | {"load": {"force": force}}
    told = run_study(check(study))["body"]["sentences"]
    state = State(study, tmp_path)
    assert interface.force_sentences(state.answer.forces) == told
    first = interface.at_once(state.answer)
    assert len(first) == len(told)
    assert all("Integrated over" not in each.sentence() for each in first)
    printed, names = StringIO(), {}
    with contextlib.redirect_stdout(printed):
        exec(to_python(state.answer.study, state.operating_load), names)
    assert names["body"] == state.answer.study.body
    assert printed.getvalue().splitlines()[1:] == told


def test_a_script_holds_the_film(tmp_path):
    study = tomllib.loads((ROOT / "examples" / "oil_film.toml").read_text())
    state, names = State(study, tmp_path), {}
    exec(to_python(state.answer.study, state.operating_load), names)
    assert names["film"] == state.answer.study.film
    own = state.answer.study.film.stribeck_columns(state.answer.contact)
    assert np.array_equal(names["lubricated"]["mu"], own["mu"], equal_nan=True)


def test_particles_that_a_contact_meets_are_counted():
    study = check(BALL)
    found = press(study.contact, study.body, 20.0, integrate=False)
    every = sum(dust.areal_density for dust in study.contact.populations)
    assert found.particles_held == pytest.approx(every * found.area, rel=1e-12)
    assert 1 / found.particles_held == pytest.approx(31000, rel=0.02)
    assert " 31000 " in found.sentence()
    clean = study.contact.replace(particles=None)
    assert press(clean, study.body, 20.0, integrate=False).particles_held is None
    crowd = study.contact.populations[0].replace(areal_density=1e9)
    crowded = press(study.contact.replace(particles=crowd), study.body, 20.0, integrate=False)
    assert "meets" not in crowded.sentence()


@pytest.mark.parametrize("count", [0.02, 0.3, 0.9])
def test_how_often_a_contact_meets_a_particle_is_that_of_places_at_random(count):
    drawn = np.random.default_rng(1).poisson(count, 400_000)
    share = float(np.mean(drawn > 0))
    said = meets(count)
    if count < 0.1:
        every = int(re.fullmatch(r"one contact in (\d+) meets a particle", said)[1])
        assert every == pytest.approx(1 / share, rel=0.03)
    else:
        percents = int(re.fullmatch(r"(\d+) % of the contacts meet a particle", said)[1])
        assert percents == pytest.approx(100 * share, abs=0.8)


def test_the_section_shows_no_more_particles_than_a_contact_holds(tmp_path):
    bad, (svg, caption, *_) = _drawn(BALL, tmp_path)
    assert not bad
    assert svg.count('class="grain') == 1
    assert " 31000 " in caption
    assert "deep" not in caption
    free = {key: value for key, value in BALL.items() if key != "body"}
    _, (svg, caption, *_) = _drawn(free | {"load": {"pressure": "1 GPa"}}, tmp_path)
    assert svg.count('class="grain') == 12
    assert "554.7 mm²" in caption
    _, (_, caption, *_) = _drawn(example(), tmp_path)
    assert "of a slab" in caption


def _drawn(study, folder):
    state = State(study, folder)
    return interface.drawing_of(state.answer, state.operating_load, 0)


# ---------------------------------------------------------------- axes
def test_an_axis_follows_the_upper_decades_of_each_curve():
    x = np.geomspace(1e-6, 1, 50)
    high, dying = np.full(50, 100.0), 10.0 ** np.linspace(-1, -56, 50)
    made = figures.figure(
        [figures.line(x, high, "a"), figures.line(x, dying, "b")], x="x", y="y", ylog=True
    )
    low, top = made["layout"]["yaxis"]["range"]
    assert top >= 2
    assert -8 <= low <= -6.5
    assert made["layout"]["yaxis"]["dtick"] == 2


@pytest.mark.parametrize("name", EXAMPLES)
def test_axes_of_outputs_show_what_matters(name, tmp_path):
    table = {"friction": {"m_ss": 0.2, "m_sa": 0.3}, "counts": {}}
    state = State(example(name) | {"outputs": table}, tmp_path)
    assert not state.problems
    made = outputs.output_figures(state.answer, state.operating_load)
    made |= {"area": curves.figures(state.answer, "pressure", critical=False)["area"]}
    assert made["friction [1]"]["layout"]["yaxis"]["type"] == "linear"
    for key, drawn in made.items():
        axis = drawn["layout"]["yaxis"]
        every = [np.array([v or np.nan for v in t["y"]], float) for t in drawn["data"]]
        tops = [np.nanmax(y) for y in every if np.nanmax(y, initial=0) > 0]
        if axis["type"] == "log":
            low, high = axis["range"]
            assert high >= np.log10(max(tops)) - 1e-9, key
            assert low >= np.log10(min(t for t in tops if t > 1e-12 * max(tops))) - 6.4, key


def test_a_place_for_a_figure_has_no_axes():
    layout = figures.empty(300)["layout"]
    assert not layout["xaxis"]["visible"]
    assert not layout["yaxis"]["visible"]


# ---------------------------------------------------------------- the map
@pytest.mark.parametrize("study", [BALL, example()], ids=["newtons", "example"])
def test_a_map_contains_its_study(study, tmp_path):
    state = State(study, tmp_path)
    contact = state.answer.contact
    ratio = contact.populations[0].diameter.mean_diameter / contact.roughness.sigma
    here = float(ratio), float(state.point().F_star)
    sizes, loads = mode_map.reach(here)
    sigma, E_ss = contact.roughness.sigma, contact.E_ss
    found = {"sizes": sizes.tolist(), "loads": loads.tolist(), "sigma": sigma, "E_ss": E_ss}
    point = here[0] * sigma, here[1] * E_ss  # a size [m] and a pressure [Pa]
    assert mode_map.lies_inside(found, point)
    assert not mode_map.lies_inside(found, (point[0], 1.01 * loads[-1] * E_ss))
    assert sizes[0] * 2 < here[0] < sizes[-1] / 2
    assert loads[0] * 2 < here[1] < loads[-1] / 2


# ---------------------------------------------------------------- processes that end
def _slow(seconds):
    time.sleep(seconds)
    return "done"


@pytest.mark.check
def test_processes_that_are_killed_are_replaced():
    solver = Solver()

    async def go():
        assert await asyncio.gather(*[solver.ask(_slow, 0.2) for _ in range(3)]) == ["done"] * 3
        for process in list(solver.all):
            os.kill(process.pid, signal.SIGKILL)
        assert await asyncio.gather(*[solver.ask(len, "abc") for _ in range(3)]) == [3] * 3
        waiting = asyncio.create_task(solver.ask(_slow, 1.0))
        await asyncio.sleep(0.4)
        for process in list(solver.all):  # under a call
            os.kill(process.pid, signal.SIGKILL)
        assert await waiting == "done"

    try:
        asyncio.run(go())
    finally:
        solver.close()


def _end_now():
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.check
def test_a_call_under_which_every_process_ends_is_no_mistake_of_the_study():
    solver = Solver()

    async def go():
        with pytest.raises(Died, match=rf"killed \(SIGKILL\), {TRIES} times in a row") as caught:
            await solver.ask(_end_now)
        assert "more memory than the page allows" not in str(caught.value)
        assert await solver.ask(len, "abcd") == 4

    try:
        asyncio.run(go())
    finally:
        solver.close()


def test_ctrl_c_does_not_reach_a_process_that_is_being_started():
    solver = Solver()
    try:
        with ThreadPoolExecutor(1) as threads:
            start = threads.submit(solver._free)
            while not solver.all and not start.done():
                time.sleep(0.001)
            (process,) = solver.all
            os.kill(process.pid, signal.SIGINT)
            assert start.result()[0] is process
        assert process.is_alive()
    finally:
        solver.close()
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


class Free:
    """A process that is there."""

    exitcode = None

    def is_alive(self):
        return True


def test_a_call_takes_the_process_that_is_free_before_its_own_has_started(monkeypatch):
    solver = Solver()
    monkeypatch.setattr(solver, "_get_ready", lambda *_: None)  # this start takes for ever
    try:
        with ThreadPoolExecutor(1) as threads:
            call = threads.submit(solver._free)
            while not solver.all and not call.done():
                time.sleep(0.001)
            one = (Free(), object())
            solver.idle.put(one)
            assert call.result(timeout=20) is one
        assert len(solver.all) == 1
        assert solver.waiting == 0
    finally:
        solver.close()


def test_the_next_process_is_there_before_it_is_asked_for(monkeypatch):
    solver = Solver(most=2)
    monkeypatch.setattr(solver, "_get_ready", lambda *_: None)
    try:
        solver.idle.put((Free(), object()))
        solver._start_missing(spare=1)
        assert not solver.all  # one is idle
        solver.idle.get()
        for _ in range(3):
            solver._start_missing(spare=1)
            assert len(solver.all) == 1  # which is being started
        solver.starting.clear()
        solver._start_missing(spare=1)
        assert len(solver.all) == 2
        solver.starting.clear()
        solver._start_missing(spare=1)
        assert len(solver.all) == 2  # and no more
    finally:
        solver.close()


class Killed:
    """A process that was killed and does not look so yet."""

    exitcode = -9

    def is_alive(self):
        return True

    def join(self, *_):
        pass

    kill = join


class Torn:
    """The pipe of a process that is gone."""

    def send(self, _):
        raise BrokenPipeError

    def close(self):
        pass


def test_processes_that_ended_before_a_call_are_not_laid_to_it():
    solver = Solver()
    try:
        for _ in range(TRIES + 1):
            gone = Killed()
            solver.all[gone] = time.perf_counter()
            solver.idle.put((gone, Torn()))
        assert asyncio.run(solver.ask(len, "abc")) == 3
    finally:
        solver.close()


def test_a_study_is_read_again_after_nobody_could(tmp_path, monkeypatch):
    from thirdbody.app import state as states

    async def dead(*_):
        raise Died("no answer")

    async def alive(call, *args):
        return call(*args)

    state = State(example(), tmp_path, later=True)
    monkeypatch.setattr(states, "ask_for_page", dead)
    with pytest.raises(Died):
        asyncio.run(state.settle())
    assert state.problems == []
    monkeypatch.setattr(states, "ask_for_page", alive)
    asyncio.run(state.settle())
    assert state.answer is not None


def test_a_job_that_is_killed_begins_again():
    async def go(times):
        job = Job("roughness")
        tables = {"roughness": {"sigma": 1e-7, "R": 3e-6}}
        running = asyncio.create_task(job.run(study=tables, folder="."))
        killed = set()
        while len(killed) < times and not running.done():
            process = job.process
            if process is not None and process.pid not in killed and process.returncode is None:
                killed.add(process.pid)
                process.kill()
            await asyncio.sleep(0.01)
        return await running

    assert asyncio.run(go(1))["roughness"]["sigma"] == 1e-7
    with pytest.raises(Died, match="SIGKILL"):
        asyncio.run(go(TRIES))


def test_ends_are_named():
    assert ended_by(-signal.SIGSEGV) == "ended by SIGSEGV"
    assert ended_by(-200).endswith(" 200")  # one without a name, by its number


def test_time_of_getting_ready_is_no_time_of_an_answer(monkeypatch):
    from thirdbody.app import page

    solver = Solver()
    solver.starts += [(10.0, 12.0), (11.0, 14.0), (1.0, 2.0)]
    assert solver.starting_seconds(0.0) == 0.0  # nobody waited for any of them

    def prepared(since, *waits):
        note_waits(deque(waits))
        return solver.starting_seconds(since)

    for since, told in ((11.5, 2.5), (0.0, 4.0), (20.0, 0.0)):
        here = copy_context()
        waits = (9.0, 14.0), (10.0, 14.5), (15.0, 16.0)
        assert here.run(prepared, since, *waits) == pytest.approx(told)
    # another page, whose call took what became free
    assert copy_context().run(prepared, 0.0, (12.5, 13.0)) == pytest.approx(0.5)
    solver.starting.add(time.perf_counter())
    assert solver.preparing
    solver.close()

    class Ready:
        def starting_seconds(self, since):
            return 18.0

    monkeypatch.setattr(page, "solver", Ready)
    assert _time_words(17.9, 0.0).startswith("answered in 1 ms, ")
    said = _time_words(18.4, 0.0)
    assert said == "answered in 400 ms, after 18 s in which the page was getting ready"


def test_a_tab_that_is_left_does_not_hold_up_the_next():
    page = Page.__new__(Page)
    page.state = SimpleNamespace(tab="film")
    page.client, page.drawing, page.waiting = contextlib.nullcontext(), {}, {}
    ended = []

    async def go():
        over = asyncio.Event()

        async def slow():
            await over.wait()
            ended.append("film")
            raise Died("no answer")  # told where the tab is in sight alone

        page.draws = {"film": slow, "curves": lambda: ended.append("curves")}
        first = asyncio.create_task(page._draw_in_sight("film"))
        while not page.drawing:
            await asyncio.sleep(0)
        page.state.tab = "curves"
        assert not await first
        assert await page._draw_in_sight("curves")
        assert ended == ["curves"]
        left = page.drawing["film"]
        over.set()
        await left
        assert ended == ["curves", "film"]
        assert page.drawing == {}
        page.state.tab = "film"
        with pytest.raises(Died):
            await page._draw_in_sight("film")

    asyncio.run(go())
