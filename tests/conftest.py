"""What all tests share."""

import functools
import gc
import importlib
import json
import os
import signal
import sys
import tempfile
import threading
import time
import warnings
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import typer.testing
from hypothesis import HealthCheck, Phase, settings
from hypothesis.internal.conjecture import providers

from thirdbody.equilibrium.compiled.cached import Cached

HERE = Path(__file__).parent
# the oracle and the twins are plain modules beside this file; importlib mode adds no path
sys.path.insert(0, str(HERE))

# tests interrupt commands, and a shell makes those deaf to it that it starts with &
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# modules and tests stay to the end: while they are read there is no garbage to look for among them
gc.disable()
# a test loses no power: it need not wait for the disk
os.fsync = lambda file: os.fstat(file) and None

# what commands print heeds COLUMNS, which workers of the tests set to a width of their own
os.environ.pop("COLUMNS", None)
os.unsetenv("COLUMNS")  # readline sets it past Python's record of the environment

# areas and loads in SI units lie far below the absolute margin of 1e-12 that pytest adds unasked:
# with it, any two of them are equal
approximately = pytest.approx


def approx(expected, rel=None, abs=None, nan_ok=False):
    """As pytest has it, but within a relative margin alone where no absolute one is asked for."""
    if abs is None:
        rel, abs = 1e-6 if rel is None else rel, 0.0
    return approximately(expected, rel=rel, abs=abs, nan_ok=nan_ok)


pytest.approx = approx

# the tree of commands is built once, not again by every test that runs one of them
typer.testing._get_command = functools.cache(typer.testing._get_command)

# numbers that stand in modules are not drawn: which are loaded differs from one worker to the next
if hasattr(providers, "_get_local_constants"):
    providers._get_local_constants = lambda: providers._local_constants

# CI: the same examples every time, and the first counterexample as it is; a contact costs up to
# a second to bind, so shrinking is left to HYPOTHESIS_PROFILE=search, which also looks elsewhere
settings.register_profile(
    "quick",
    deadline=None,
    max_examples=int(os.environ.get("THIRDBODY_EXAMPLES", "12")),
    derandomize=True,
    phases=(Phase.explicit, Phase.generate),
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "search", settings.get_profile("quick"), derandomize=False, phases=tuple(Phase)
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


COMPILING = "THIRDBODY_COMPILING"
"""Environment variable with a file that lies there while the engines are compiled."""
EARLY = ("laws", "numerics", "populations", "quantities")
"""Folders of tests of which few need an engine: every worker begins with its part of them."""


def pytest_sessionstart(session):
    """Compile both engines once, while the workers read the tests and begin with others."""
    if not session.config.getoption("numprocesses", None):
        return  # one process, which compiles once what it needs
    gc.enable()  # only workers read the tests
    handle, name = tempfile.mkstemp(prefix="thirdbody-compiling-")
    os.close(handle)
    os.environ[COMPILING] = name
    session.config.compiling = threading.Thread(target=_compile_engines, args=(Path(name),))
    session.config.compiling.start()


def _compile_engines(running):
    """Compile what nearly every study needs; the file ``running`` lies there until it is done."""
    import thirdbody as tb

    bodies = tb.MaterialPair(tb.materials["S45C"], tb.materials["100Cr6"])
    dust = tb.TruncatedGaussian(mean=300e-9, std=24e-9)
    contact = tb.Contact(
        surfaces=bodies,
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(material=tb.materials["SiO2"], diameter=dust, areal_density=1e11),
    )
    # particles are for the engine of columns, bare surfaces for the other
    studies = [
        (contact, {"particles.material.H": np.linspace(8e9, 9e9, 32)}),
        (contact.replace(particles=None), {"roughness.sigma": np.linspace(90e-9, 100e-9, 32)}),
    ]

    def compile_for(study):
        tb.equilibria.solve_states(study[0], F_star=1e-5, vary=study[1])

    try:
        with warnings.catch_warnings(), ThreadPoolExecutor() as threads:
            warnings.simplefilter("ignore")
            list(threads.map(compile_for, studies))
    finally:
        running.unlink(missing_ok=True)


def pytest_sessionfinish(session):
    """Tests that need no engine may end before it is compiled."""
    if compiling := getattr(session.config, "compiling", None):
        compiling.join()


def wait_for_engines():
    """What a worker needs compiled is not compiled twice."""
    running = Path(os.environ.get(COMPILING, ""))
    while running.is_file():
        time.sleep(0.1)


def waiting_first(prepare):
    def wait_and_prepare(self, signature):
        wait_for_engines()
        prepare(self, signature)

    return wait_and_prepare


if "PYTEST_XDIST_WORKER" in os.environ:
    Cached._prepare = waiting_first(Cached._prepare)


# what a test draws at random is named when it fails: every generator by its seed
SEEDS: list[str] = []
_default_rng = np.random.default_rng


def _told(seed=None):
    SEEDS.append(f"numpy.random.default_rng({'without a seed' if seed is None else seed})")
    return _default_rng(seed)


np.random.default_rng = _told


def pytest_collection_finish():
    gc.freeze()
    gc.set_threshold(10_000, 20, 20)  # what a test leaves is small, and most of it no garbage
    gc.enable()


def pytest_runtest_setup(item):
    SEEDS.clear()
    if not is_early(item):  # processes that a test starts know of no other that compiles
        wait_for_engines()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport():
    report = yield
    if report.failed and SEEDS:
        report.sections.append(("random numbers", "\n".join(dict.fromkeys(SEEDS))))
    return report


def is_early(item):
    return item.path.parent.name in EARLY


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(items):
    """Files with long studies first, so that no worker is left alone with one at the end; whole,
    so that what the tests of a file share is made once. Cases of which a spread is quick are
    counted as they stand, so a step that divides no number of values takes each value."""
    long = {item.path for item in items if item.get_closest_marker("slow")}
    cases = Counter()
    for item in items:
        if mark := item.get_closest_marker("spread"):
            of = item.path, getattr(item, "originalname", item.name)
            if cases[of] % mark.args[0]:
                item.add_marker(pytest.mark.slow)
            cases[of] += 1
    items.sort(key=lambda item: item.path not in long)
    yield
    items[:] = dealt(items, int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")))


def dealt(items, workers):
    """The tests that are run, as one stretch for each worker, which is how they are dealt to them:
    what needs no engine begins every stretch, while the engines are compiled."""
    early = [item for item in items if is_early(item)]
    others = [item for item in items if not is_early(item)]
    stretches = []
    for worker in range(workers):
        for part in (early, others):
            start, stop = (len(part) * each // workers for each in (worker, worker + 1))
            stretches += part[start:stop]
    return stretches


@pytest.fixture(scope="session")
def shared_reference():
    """Loader of the reference values that live beside a checkout; skips without them."""
    folder = HERE.parent.parent / "shared" / "reference"

    def load(name: str):
        path = folder / name
        if not path.is_file():
            pytest.skip(f"no reference folder beside this checkout ({folder.name}/{name})")
        return json.loads(path.read_text("utf-8"))

    return load


@pytest.fixture
def blank_pictures(monkeypatch):
    """Pictures are made and saved with nothing on them, for tests of the files that hold them:
    to lay one out takes longer than all the rest of a command."""
    from matplotlib.figure import Figure

    save = Figure.savefig

    def save_blank(figure, *args, **options):
        figure.clear()
        figure.set_layout_engine("none")
        return save(figure, *args, **options)

    monkeypatch.setattr(Figure, "savefig", save_blank)
    monkeypatch.setattr("thirdbody.views.figure_files.lay_out", lambda *_, **__: None)


@pytest.fixture
def short_search(monkeypatch):
    """A design is refined by a few steps from one start, for tests of what is done with it."""
    search = importlib.import_module("thirdbody.analysis.design.search")
    monkeypatch.setattr(search, "STARTS", 1)
    monkeypatch.setattr(search, "STEPS", 5)
