"""Links made to do harm: texts that are script, and studies that are too large."""

import ast
import asyncio
import contextlib
import copy
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the page needs the extra thirdbody[app]")

import numpy as np
from nicegui import Client, core
from nicegui.page import page as place

import thirdbody.app

sys.path.insert(0, str(Path(__file__).parent))
from hostile import PAYLOADS, hostile, wrong

from thirdbody.app import bounds, exports, text, work
from thirdbody.app.examples import example
from thirdbody.app.figures import escape_tags
from thirdbody.app.folders import Folders, Shelf, remove_left
from thirdbody.app.inputs import FORMED, Inputs
from thirdbody.app.jobs import RUNNING, Job
from thirdbody.app.page import Start
from thirdbody.app.solver import Solver
from thirdbody.app.state import State
from thirdbody.app.uploads import keep, take
from thirdbody.app.widgets import facts
from thirdbody.errors import InvalidValue, Mistake
from thirdbody.study import check, run_study
from thirdbody.study.tables import TABLES

pytestmark = pytest.mark.check


def test_no_attribute_is_put_together_as_text():
    """A value inside the string that `props` parses could end there and begin another."""
    found = []
    for file in sorted(Path(thirdbody.app.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            named = isinstance(node, ast.Call) and getattr(node.func, "attr", "") in (
                "props", "style", "classes", "add_head_html", "add_body_html", "run_javascript",
            )  # fmt: skip
            if named and any(isinstance(part, ast.JoinedStr) for part in node.args):
                values = [v for part in node.args for v in ast.walk(part)
                          if isinstance(v, ast.Name)]  # fmt: skip
                found.append((file.name, node.lineno, node.func.attr, [v.id for v in values]))
    # the swatches of the legend, by their colours
    assert [each for each in found if each[0::2] != ("interface.py", "style")] == []


@pytest.mark.parametrize("payload", PAYLOADS)
def test_a_text_stays_one_attribute(payload):
    with Client(place("/test"), request=None) as client:
        facts([(payload, payload)], "film: ")
        (made,) = [e for e in client.elements.values() if "data-fact" in e.props]
    assert made.props["data-fact"] == f"film: {payload}"
    assert not {"innerHTML", ":innerHTML"} & set(made.props)


@pytest.mark.parametrize("payload", PAYLOADS[:2])
def test_fields_take_any_text_as_text(payload, tmp_path):
    allowed = {"hint", "aria-label", "data-path", "label", "value", "model-value", "options",
               "error-message", "placeholder", "modelValue"}  # fmt: skip
    for name, study in [("all", hostile(payload)), *wrong(payload)]:
        with Client(place("/test"), request=None) as client:
            inputs = Inputs(State(study, tmp_path), lambda: None)
            for part in ("surfaces", "roughness", "asperity_law", "particles", "load"):
                getattr(inputs, part)()
            inputs.uncertain()
            for part in [each.name for each in TABLES if each.name not in FORMED]:
                inputs.as_text(part)
            inputs.show_mistakes()
            for element in client.elements.values():
                holds = {k for k, v in element.props.items() if "__hit" in json.dumps(v)}
                assert holds <= allowed, (name, holds)
                assert not any(key.startswith(":") for key in holds)
                assert "innerHTML" not in element.props


def test_names_in_figures_are_no_markup():
    assert escape_tags("<a href='x'>y</a> %{meta}") == "&lt;a href='x'&gt;y&lt;/a&gt; %&#123;meta}"


@pytest.mark.parametrize("value", [5, -1.5, True, "x", [1, [2]], {"a": {"b": 1}}, [{}], [], {}])
def test_any_value_in_any_place_has_its_mistake_and_no_failure(value, tmp_path):
    places = [
        (name,)
        for name in (
            "title",
            "surfaces",
            "roughness",
            "asperity_law",
            "particles",
            "particle_law",
            "load",
            "outputs",
            "materials",
            "uncertainty",
        )
    ]
    places += [("surfaces", "first"), ("roughness", "heights"), ("roughness", "ellipticity"),
               ("roughness", "topography"), ("particles", "material"), ("particles", "law"),
               ("particles", "distribution"), ("particles", "sizes"), ("load", "F_star"),
               ("asperity_law", "name"), ("uncertainty", "inputs")]  # fmt: skip
    for *where, last in places:
        study = copy.deepcopy(example())
        table = study
        for step in where:
            table = table.setdefault(step, {})
        table[last] = value
        with Client(place("/test"), request=None):
            state = State(study, tmp_path)
            assert state.answer is not None or state.problems, (where, last)
            inputs = Inputs(state, lambda: None)
            parts = ("surfaces", "roughness", "asperity_law", "particles", "load")
            for part in (*parts, "output_switches", "output_numbers"):
                getattr(inputs, part)()
            inputs.uncertain()
            inputs.show_mistakes()


# ---------------------------------------------------------------- studies that are too large
def changed(**tables):
    return example() | tables


def inside(depth):
    table = {}
    for _ in range(depth):
        table = {"a": table}
    return table


DUST = example()["particles"]
LARGE = {
    "points": changed(load={"F_star": {"from": 1e-7, "to": 1e-4, "points": 1_000_000}}),
    "more points": changed(load={"F_star": {"from": 1e-7, "to": 1e-4, "points": 10**30}}),
    "speeds": changed(film={"speed": {"from": 1, "to": 2, "points": 1e9}}),
    "grid": changed(sweep={"vary": {"roughness": {"sigma": {"points": 10**7}}}}),
    "samples": changed(sweep={"samples": 2**40}),
    "loads": changed(load={"F_star": [1e-6 + 1e-9 * i for i in range(5000)]}),
    "populations": changed(particles=[DUST] * 40),
    "parts": changed(particles=DUST | {"parts": [{"mean": 1}] * 200}),
    "depth": changed(more=inside(200)),
    "text": changed(title="x" * 50_000),
    "key": changed(**{"k" * 5000: 1}),
    "keys": changed(outputs={f"k{i}": 1 for i in range(2000)}),
    "lists": changed(more=[[1] * 1999] * 11),
    "number": changed(load={"F_star": 10**4000}),
}


@pytest.mark.parametrize("name", LARGE)
def test_a_study_that_is_too_large_is_refused_with_what_is_taken(name, tmp_path):
    study = LARGE[name]
    with pytest.raises(InvalidValue) as told:
        bounds.refuse_large(study)
    assert {each.code for each in told.value.problems} == {Mistake.TOO_LARGE}
    assert all(len(problem) < 300 for problem in told.value.problems)
    if name == "points":
        (problem,) = told.value.problems
        assert problem.startswith("load.F_star.points = 1000000: ")
        assert f" {bounds.MOST_POINTS};" in problem
    state = State(study, tmp_path)
    assert state.problems == list(told.value.problems)
    if name in ("depth", "number"):
        return  # which are not written, or not read
    link = text.to_link(study).removeprefix("study=")
    if len(link) < text.LONGEST_LINK:
        folders = Folders()
        try:
            opened, said = Start(None, None, folders).state({"study": link})
        finally:
            folders.close()
        assert opened.study == example()
        assert said


@pytest.mark.parametrize(
    "given",
    ["a." * 9000 + "a = 1", "[" + "a." * 9000 + "a]", "x = {" + '"a" . ' * 9000 + "b = 1}",
     "x = " + "[" * 5000, "x = " + "9" * 5000],
    ids=["dotted", "heading", "quoted", "lists", "digits"],
)  # fmt: skip
def test_text_that_only_takes_long_to_read_is_refused(given):
    with pytest.raises(InvalidValue):
        text.from_toml(given)


def test_curves_have_few_loads_and_files_all_of_them(tmp_path):
    many = changed(load={"F_star": {"from": 5e-7, "to": 2e-4, "points": 1000}})
    answer = State(many, tmp_path).answer
    assert len(answer.loads) == bounds.MOST_DRAWN
    assert set(answer.loads) <= set(answer.study.values)
    assert (answer.loads[0], answer.loads[-1]) == (5e-7, 2e-4)
    assert exports.to_csv(answer.study).count("\n") == 1001


def test_files_of_a_page_are_bounded(tmp_path, monkeypatch):
    (tmp_path / "mine.toml").write_text("# " + "x" * bounds.LARGEST_TABLE)
    (problem, *_) = State(changed(materials="mine.toml"), tmp_path).problems
    assert problem.code is Mistake.TOO_LARGE
    assert "mine.toml" in problem
    monkeypatch.setattr("thirdbody.app.uploads.LARGEST_FOLDER", 2**19)

    class File:
        name = "one.x3p"

        def size(self):
            return 2**19

        async def save(self, path):
            path.write_bytes(b"")

    event = type("Event", (), {"file": File()})
    with pytest.raises(InvalidValue, match="together"):
        asyncio.run(keep(tmp_path, event))
    (tmp_path / "mine.toml").unlink()
    assert asyncio.run(keep(tmp_path, event)) == "one.x3p"


# ---------------------------------------------------------------- processes beside the server
def test_others_are_answered_while_one_computes():
    async def go():
        solver = Solver(most=2)
        try:
            heavy = asyncio.create_task(solver.ask(time.sleep, 3600))
            assert await solver.ask(pow, 2, 5) == 32
            assert not heavy.done()
        finally:
            solver.close()
        with pytest.raises(asyncio.CancelledError):
            await heavy

    asyncio.run(go())


def test_an_answer_that_takes_too_long_is_ended_and_the_next_one_comes():
    async def go():
        solver = Solver(most=1, seconds=0.5)
        try:
            with pytest.raises(InvalidValue, match=r"stopped after 0\.5 s"):
                await solver.ask(time.sleep, 3600)
            assert not solver.all
            solver.seconds = 60
            assert await solver.ask(pow, 2, 5) == 32
            with pytest.raises(InvalidValue, match="memory"):
                await solver.ask(os._exit, 1)
            with pytest.raises(InvalidValue, match="ValueError"):
                await solver.ask(int, "x")
            with pytest.raises(asyncio.CancelledError):
                await solver.ask(pow, 2, 5, wanted=lambda: False)
        finally:
            solver.close()

    asyncio.run(go())


@pytest.mark.parametrize("how", ["closed", "left", "back"])
def test_work_ends_with_its_page(how, monkeypatch):
    monkeypatch.setattr(work, "LEFT", 0.0)

    async def go():
        monkeypatch.setattr(core, "loop", asyncio.get_running_loop())
        with Client(place("/test"), request=None) as client:
            made = work.Work("map", "Map", dict, lambda result: None)
        made.job = Job("map")
        if how == "closed":
            client.delete()
        else:
            client.tab_id = "there" if how == "back" else None
            for handler in client.disconnect_handlers:
                client.safe_invoke(handler)
            await asyncio.sleep(0.05)
        assert made.job.stopped is (how != "back")

    asyncio.run(go())


def test_a_job_cancelled_before_it_began_does_not_run():
    from thirdbody.app.jobs import Stopped

    async def go():
        job = Job("surface")
        job.cancel()
        with pytest.raises(Stopped):
            await job.run(file="example", options={})
        assert job.process.returncode is not None
        assert job not in RUNNING

    asyncio.run(go())


# ---------------------------------------------------------------- measured files
@pytest.fixture
def surface(tmp_path):
    rng = np.random.default_rng(1)
    k = np.fft.fftfreq(128)[:, None] ** 2 + np.fft.rfftfreq(128) ** 2
    heights = np.fft.irfft2(np.fft.rfft2(rng.normal(size=(128, 128))) * np.exp(-k / 0.002))
    np.savetxt(tmp_path / "part.txt", 1e-7 * heights / heights.std())
    table = {"topography": "part.txt", "unit": "m", "spacing": "0.5 um", "cutoff": "4 um"}
    return example() | {"roughness": table}


@pytest.mark.parametrize("more", [{}, {"heights": "measured"}, {"heights": {"name": "johnson"}}])
def test_a_measured_file_is_read_by_a_process_of_its_own(surface, more, tmp_path, monkeypatch):
    study = surface | {"roughness": surface["roughness"] | more}
    own = run_study(check(study, folder=tmp_path))

    def refused(*args, **options):
        raise AssertionError("an instrument file is read in this process")

    monkeypatch.setattr("thirdbody.populations.measured.topography.from_topography", refused)
    state = State(study, tmp_path)
    assert not state.problems
    assert json.loads(exports.to_json(state.answer.study)) == own.to_dict()
    state.set("title", "another")
    assert state.answer.study.title == "another"


def test_mistakes_of_a_measured_file_stand_beside_the_others(surface, tmp_path):
    (tmp_path / "part.txt").write_bytes(b"\x00\xff no surface")
    study = surface | {"asperity_law": {"name": "zmc", "k": "x"}}
    told = State(study, tmp_path).problems
    assert any(text.startswith("roughness.topography") for text in told)
    assert any(text.startswith("asperity_law.k") for text in told)


def test_messages_name_no_folder_of_the_server(surface, tmp_path):
    (tmp_path / "part.txt").write_bytes(b"\x00\xff no surface")
    (tmp_path / "bad.csv").write_text("low [um],high\n1,x\n")
    (tmp_path / "bad.toml").write_text("[steel\n")
    dust = {"material": "SiO2", "sizes": "bad.csv", "areal_density": 1e9}
    for study in (surface, changed(particles=dust), changed(materials="bad.toml")):
        told = State(study, tmp_path).problems
        assert any("part.txt" in text or "bad." in text for text in told)
        assert not any(str(tmp_path) in text or "/" in text.split(": ")[0] for text in told), told
    with pytest.raises(InvalidValue) as told:
        asyncio.run(Job("surface").run(file=str(tmp_path / "part.txt"), options={}))
    assert "part.txt" in str(told.value)
    assert str(tmp_path) not in str(told.value)


# ---------------------------------------------------------------- folders
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals and locks of files")
def test_folders_end_with_the_server_or_at_the_next_start(tmp_path):
    kept = {k: v for k, v in os.environ.items() if k != "PYTEST_CURRENT_TEST"}
    surroundings = kept | {"TMPDIR": str(tmp_path)}
    command = [sys.executable, "-m", "thirdbody", "app", "--no-browser", "--port", "0"]

    @contextlib.contextmanager
    def served():
        server = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=surroundings)
        try:
            address = re.search(r"http://[\d.]+:\d+", server.stderr.readline())[0]
            yield server, address
        finally:
            server.kill()
            server.wait()
            server.stderr.close()

    def visited(server, address):
        import urllib.error
        import urllib.request

        while server.poll() is None:
            try:
                return urllib.request.urlopen(address, timeout=30).status
            except (urllib.error.URLError, ConnectionError):
                time.sleep(0.2)
        return "ended"

    def roots():
        return sorted(tmp_path.glob("thirdbody-app-*"))

    foreign = tmp_path / "thirdbody-app-without-lock"
    foreign.mkdir()
    with served() as (server, address):
        assert visited(server, address) == 200
        (left,) = [root for root in roots() if root != foreign]
        assert [each for each in left.iterdir() if each.is_dir()]
        with served() as (other, there):
            assert visited(other, there) == 200
            assert left.exists()
            other.send_signal(signal.SIGTERM)
            other.wait(30)
        assert roots() == sorted([left, foreign])
        server.kill()
        server.wait()
    assert left.exists()
    with served() as (server, address):
        assert visited(server, address) == 200
        assert not left.exists()
        assert foreign.exists()
        server.send_signal(signal.SIGINT)
        server.wait(30)
    assert roots() == [foreign]


def test_a_folder_in_use_is_not_removed(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    used = Folders()
    assert used.new().parent == used.path
    assert remove_left() == []
    assert used.path.exists()
    used.lock.close()
    assert remove_left() == [used.path]
    assert not used.path.exists()


# ---------------------------------------------------------------- files that an address names
KEYS = ["0" * 64, "../lock", "..", "", "/etc/passwd", "{}", "<img src=x onerror=window.__hit=1>"]


@pytest.mark.parametrize("key", [*KEYS, "the right one, for another name"])
def test_an_address_gives_a_file_for_its_key_alone(key, tmp_path):
    folders = Folders()
    try:
        mine = folders.new() / "part.txt"
        mine.write_bytes(b"1 2 3")
        right = folders.shelf.keep(mine)
        start = Start(None, None, folders)
        name = "../part.txt" if key.startswith("the") else "part.txt"
        query = {"files": f"{name}:{right if key.startswith('the') else key}"}
        state, _ = start.state(query)
        assert list(state.folder.iterdir()) == []
        assert state.files == {}
        state, _ = start.state({"files": f"part.txt:{right}"})
        assert (state.folder / "part.txt").read_bytes() == b"1 2 3"
        assert not list(folders.path.parent.glob("part.txt*"))
    finally:
        folders.close()


def test_a_system_without_links_has_copies(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr("os.link", refused)
    (tmp_path / "part.txt").write_bytes(b"1 2 3")
    shelf = Shelf(tmp_path / "shelf")
    assert shelf.give(shelf.keep(tmp_path / "part.txt"), tmp_path / "there.txt")
    assert (tmp_path / "there.txt").read_bytes() == b"1 2 3"


def test_a_key_is_of_this_server_and_of_what_a_file_holds(tmp_path):
    (tmp_path / "one.txt").write_bytes(b"1 2 3")
    (tmp_path / "two.txt").write_bytes(b"1 2 3")
    first, second = Shelf(tmp_path / "a"), Shelf(tmp_path / "b")
    assert first.keep(tmp_path / "one.txt") == first.keep(tmp_path / "two.txt")
    assert first.keep(tmp_path / "one.txt") != second.keep(tmp_path / "one.txt")


def test_another_file_of_the_same_name_leaves_the_first_one_to_its_address(tmp_path):
    class File:
        name = "part.txt"
        content = b""

        def size(self):
            return len(self.content)

        async def save(self, path):
            path.write_bytes(self.content)

    folders = Folders()
    try:
        state, _ = Start(None, None, folders).state({})
        keys = []
        for content in (b"1 2 3", b"4 5 6"):
            File.content = content
            asyncio.run(take(state, type("Event", (), {"file": File()})))
            keys.append(state.files["part.txt"])
        assert (state.folder / "part.txt").read_bytes() == b"4 5 6"
        back, _ = Start(None, None, folders).state({"files": f"part.txt:{keys[0]}"})
        assert (back.folder / "part.txt").read_bytes() == b"1 2 3"
    finally:
        folders.close()


def test_the_shelf_of_a_server_is_bounded_and_the_oldest_file_goes(tmp_path, monkeypatch):
    monkeypatch.setattr("thirdbody.app.folders.LARGEST_SHELF", 25)
    shelf = Shelf(tmp_path / "shelf")
    keys = []
    for number in range(4):
        file = tmp_path / f"{number}.txt"
        file.write_bytes(bytes([number]) * 10)
        keys.append(shelf.keep(file))
        os.utime(tmp_path / "shelf" / keys[-1], (number, number))
    assert [shelf.give(key, tmp_path / "given.txt") for key in keys] == [False, False, True, True]
    assert (tmp_path / "given.txt").read_bytes() == b"\3" * 10
    assert (tmp_path / "0.txt").read_bytes() == b"\0" * 10


@pytest.mark.parametrize(
    "told",
    ['{"file": "../part.txt"}', '{"file": 3}', '{"file": "a", "x": "y"}', "[" * 9999, "nul", "{}"],
)
def test_an_address_tells_of_a_surface_in_plain_words_or_not_at_all(told):
    state, _ = Start(None, None, folders := Folders()).state({"surface": told})
    folders.close()
    assert state.surface == {}
