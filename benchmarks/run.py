"""Speed of both engines beside the script a user would write, and beside what cannot be beaten.

python benchmarks/run.py prints one table and writes results.md beside it. Single-thread rows count
processor time, so that other work on the machine disturbs little; wall time stands beside it.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parent))
import naive
from measured_contact import HIGH, LOW, contact, inputs, loads

import thirdbody as tb
from thirdbody.contact import asperity_sums as asperities
from thirdbody.contact import interface as contacts
from thirdbody.equilibrium.compiled import batch as engine
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import NotCompiled

Array = NDArray[np.float64]
HERE = Path(__file__).parent
DIRECT = {"plane": (1.2e6, 2.4e6), "rough": (3e5, None), "two-body": (None, None)}
TABLES, OTHERS, ERROR, FIRST, LATER, OUTPUTS = 3e6, 2e5, 1e-10, 5.0, 1.0, 3.0
"""Targets: states a second on one and two threads, relative error, seconds, a ratio of times."""


@dataclass
class Row:
    """One line of the table."""

    what: str
    cpu: float | None = None
    """States a second of processor time, for one thread."""
    wall: float | None = None
    """States a second."""
    target: float | None = None
    note: str = ""

    @property
    def rate(self) -> float:
        return self.cpu or self.wall or 0.0


# ----------------------------------------------------------------------------- measuring
@contextmanager
def environment(**values: object) -> Iterator[None]:
    """Environment variables for a while."""
    before = dict(os.environ)
    os.environ.update({name: str(value) for name, value in values.items()})
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def rates(call: Callable[[], object], count: int, repeats: int = 5) -> tuple[float, float]:
    """States a second by processor and by wall time, each the best of several runs."""
    cpu = wall = np.inf
    for _ in range(repeats):
        start = time.process_time(), time.perf_counter()
        call()
        cpu = min(cpu, time.process_time() - start[0])
        wall = min(wall, time.perf_counter() - start[1])
    return count / cpu, count / wall


def row(
    what: str,
    call: Callable[[], object],
    count: int,
    threads: int = 1,
    target: float | None = None,
    repeats: int = 5,
) -> Row:
    with environment(THIRDBODY_THREADS=threads):
        cpu, wall = rates(call, count, repeats)
    return Row(what, cpu if threads == 1 else None, wall, target)


def naive_row() -> tuple[Row, Array, Array]:
    """The plain script, and what it finds."""
    few = np.geomspace(1e-7, 2e-4, 24)
    found = np.empty_like(few)

    def call() -> None:
        found[:] = [naive.separation(F) for F in few]

    cpu, wall = rates(call, len(few), repeats=2)
    return Row("quad + brentq script, plane", cpu, wall), few, found


def many_loads() -> Iterator[Row]:
    """One interface, many loads."""
    for seat in ("plane", "rough", "two-body"):
        bound = contact(seat)
        with environment(THIRDBODY_ENGINE="numpy"):
            some = loads(50_000)
            tb.solve(bound, F_star=1e-5)
            yield row(f"NumPy, {seat}", partial(tb.solve, bound, F_star=some), len(some), repeats=3)
    for seat in ("plane", "rough", "two-body"):
        bound = contact(seat)
        many = loads(500_000)
        for threads in (1, 2):
            yield row(
                f"compiled, {seat}, {threads} thread{'s' * (threads > 1)}",
                partial(tb.solve, bound, F_star=many),
                len(many),
                threads,
                TABLES if threads == 1 else None,
            )


def own_inputs(nanoseconds: float, count: int = 100_000) -> Iterator[Row]:
    """Every state with its own load, σ, R, η_a and x_a."""
    import floor

    for seat, targets in DIRECT.items():
        base, vary, many = contact(seat), inputs(seat, count), loads(count)
        solved = state_columns(base, F_star=many, vary=vary)
        some = {name: values[:2_000] for name, values in vary.items()}
        states = engine.States(base, some, 2_000)
        asperities = states.rows.interfaces
        at = (solved["d"][:2_000] - asperities["centre"]) / asperities["sigma_s"]
        nodes = floor.exponentials(states, at)
        # the root cannot be known, nor the columns, without an evaluation each
        least = 1e9 / (2 * float(nodes.mean()) * nanoseconds)
        for threads, target in zip((1, 2), targets, strict=True):
            this = row(
                f"compiled, {seat}, {threads} thread{'s' * (threads > 1)}",
                partial(state_columns, base, F_star=many, vary=vary),
                count,
                threads,
                target,
                repeats=3,
            )
            this.note = (
                f"{this.rate / least / threads:.0%} of the floor of quadrature, "
                f"{least * threads:,.0f}/s: {nodes.mean():.0f} exp × 2 evaluations"
            )
            yield this


def own_particles() -> Iterator[Row]:
    """Besides, what decides the contact of a particle: its own in every state."""
    count = 20_000
    rng = np.random.default_rng(3)
    surfaces = contact("rough").surfaces
    soft, other = (H * rng.uniform(0.8, 1.2, count) for H in (surfaces.first.H, surfaces.second.H))
    alike = {"surfaces.first.H": soft, "surfaces.second.H": soft}
    ways = {
        "width of the sizes": {"particles.diameter.std": naive.S_A * rng.uniform(0.8, 1.2, count)},
        "hardness of both surfaces alike": alike,
        "hardness of each surface": alike | {"surfaces.second.H": other},
    }
    for name, more in ways.items():
        vary = inputs("rough", count) | more
        call = partial(state_columns, contact("rough"), F_star=loads(count), vary=vary)
        yield row(f"compiled, rough, {name}, 1 thread", call, count, 1, None, repeats=3)


LAWS = {
    "coated": {"E_1": 2e11, "nu_1": 0.3, "t": 2e-8, "E_2": 4e10, "nu_2": 0.25},
    "dmt": {"w": 0.05},
    "jkr": {"w": 0.05},
    "elliptic-ceb": {"ratio": 4.0},
    "elliptic-zmc": {"ratio": 4.0},
    "jg": {"hardness_ratio": 2.86},
}
"""What a law needs besides its defaults."""
HEIGHTS = {
    "Gaussian": tb.heights.GaussianHeights(),
    "exponential": tb.heights.ExponentialHeights(),
    "Weibull": tb.heights.WeibullHeights(shape=1.8),
    "Johnson": tb.heights.JohnsonHeights(skewness=-0.7, kurtosis=4.2),
}


def laws() -> Iterator[Row]:
    """Every law on four kinds of heights, rough seat, many loads, one thread."""
    many, base = loads(50_000), contact("rough")
    for name, kind in tb.asperity.REGISTRY.items():
        for title, heights in HEIGHTS.items():
            bound = base.replace(
                asperity_law=kind(**LAWS.get(name, {})),
                roughness=base.roughness.replace(heights=heights),
            )
            for cached in (
                *(contacts.interface, asperities.asperity_sum),
                *(asperities.reduced_sum, asperities.gaussian_rule),
            ):
                cached.cache_clear()
            start = time.process_time()
            interface = contacts.interface(bound)
            build = time.process_time() - start
            this = row(
                f"{name}, {title}",
                partial(tb.solve, bound, F_star=many),
                len(many),
                target=OTHERS,
                repeats=2,
            )
            try:
                engine.batch(interface)
                which = ""
            except NotCompiled:
                which = ", NumPy engine"
            this.note = f"table {build:.2f} s{which}"
            yield this


# ------------------------------------------------------------------- a process of its own
START = """
from time import perf_counter
start = perf_counter()
import thirdbody
imported = perf_counter()
import numpy, sys, warnings
warnings.simplefilter("ignore")
sys.path.insert(0, sys.argv[1])
import measured_contact
bound = measured_contact.contact("rough")
call = perf_counter()
{call}
done = perf_counter()
peak = float("nan")
try:  # not resource.getrusage, which on Linux begins with the memory of the parent
    with open("/proc/self/status") as status:
        peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024
except OSError:
    pass
print(imported - start, done - call, peak)
"""
SOLVE = "thirdbody.solve(bound, F_star=measured_contact.loads({count}))"
STATES = """from thirdbody.equilibrium.states import state_columns
loads, vary = measured_contact.loads({count}), measured_contact.inputs("rough", {count})
state_columns(bound, F_star=loads, vary=vary)"""


def alone(call: str, **variables: object) -> tuple[float, float, float]:
    """Seconds to import, seconds of a call after it, and the peak of memory in MB."""
    with environment(**variables):
        command = [sys.executable, "-c", START.format(call=call), str(HERE)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    imported, seconds, peak = map(float, done.stdout.split())
    return imported, seconds, peak


def mode_map(seat: str, side: int) -> float:
    """Seconds for side × side states over particle size and load."""
    size, F_star = np.meshgrid(np.geomspace(0.2, 10, side), np.geomspace(5e-7, 2.4e-4, side))
    mean = size.ravel() * naive.SIGMA
    start = time.perf_counter()
    state_columns(
        contact(seat).replace(**{"particles.areal_density": 1e9}),
        F_star=F_star.ravel(),
        vary={
            "particles.diameter.mean": mean,
            "particles.diameter.std": mean * (naive.S_A / naive.X_A),
        },
    )
    return time.perf_counter() - start


def seconds() -> Iterator[tuple[str, float, str, float | None]]:
    """What a user waits for, and memory: name, value, unit, target."""
    few = SOLVE.format(count=5_000)
    with tempfile.TemporaryDirectory() as empty:
        cold = alone(few, NUMBA_CACHE_DIR=empty)
        warm = min(alone(few, NUMBA_CACHE_DIR=empty)[1] for _ in range(3))
        idle = [alone("pass") for _ in range(3)]
    yield "import thirdbody", min(each[0] for each in idle), "s", None
    yield "first call after an installation", cold[1], "s", FIRST
    yield "first call of a later process", warm, "s", LATER
    for seat in ("plane", "rough"):
        for side in (200, 1000):
            yield f"mode map {side} x {side}, {seat}", mode_map(seat, side), "s", None
    yield "peak memory after import", min(each[2] for each in idle), "MB", None
    yield "peak memory, 1e6 loads", alone(SOLVE.format(count=10**6))[2], "MB", None
    yield "peak memory, 1e6 states", alone(STATES.format(count=10**6))[2], "MB", None


def largest_difference(few: Array, slow: Array) -> Iterator[tuple[str, float]]:
    """Of the separations, relative, to the plain script: by tables and by nodes."""
    every = tb.solve(contact("plane"), F_star=np.concatenate([few, loads(engine.FEWEST)]))
    yield "tables", float(np.max(np.abs(every.d[: len(few)] / slow - 1)))
    # R alone differs, too little to matter, so that nodes are used
    R = naive.R * (1 + 1e-13 * np.arange(len(few)))
    own = state_columns(contact("plane"), F_star=few, vary={"roughness.R": R})
    yield "nodes", float(np.max(np.abs(own["d"] / slow - 1)))


# ------------------------------------------------------------------------------- telling
def machine() -> str:
    """Processor, cores and versions; nothing that names the machine."""
    import numba

    model = platform.processor() or platform.machine()
    about = Path("/proc/cpuinfo")
    if about.is_file():
        lines = about.read_text().splitlines()
        model = next((line.split(":")[1] for line in lines if line.startswith("model name")), model)
    return (
        f"{model.strip()}, {os.cpu_count()} cores; Python {platform.python_version()}, "
        f"NumPy {np.__version__}, numba {numba.__version__}"
    )


def verdict(value: float, target: float | None, *, more: bool = True) -> str:
    if target is None:
        return ""
    met = value >= target if more else value <= target
    number = f"{target:,.0f}" if target >= 1 else f"{target:g}"
    return f"{'met' if met else 'NOT MET'} ({'≥' if more else '≤'} {number})"


class Page:
    """Lines for the terminal and, as Markdown, for results.md."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def title(self, text: str) -> None:
        print(f"\n{text}", flush=True)
        self.lines += ["", f"## {text}", ""]

    def text(self, text: str) -> None:
        print(text, flush=True)
        self.lines += [text, ""]

    def head(self, *names: str) -> None:
        self.lines += ["| " + " | ".join(names) + " |", "|" + "---|" * len(names)]
        self.show(*names)

    def row(self, *cells: str) -> None:
        self.lines.append("| " + " | ".join(cells) + " |")
        self.show(*cells)

    def show(self, first: str, *rest: str) -> None:
        print(f"{first:32s}" + "".join(f"{cell:>16s}  " for cell in rest).rstrip(), flush=True)

    def rates(self, row: Row, slow: Row) -> None:
        self.row(
            row.what,
            f"{row.cpu:,.0f}" if row.cpu else "",
            f"{row.wall:,.0f}",
            f"{row.rate / slow.rate:,.0f}",
            verdict(row.rate, row.target),
            row.note,
        )


COLUMNS = ("states", "a CPU second", "a second", "x naive", "target", "")


def main() -> int:
    import floor
    import outputs

    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    page = Page()
    page.lines = ["# Measured speed", ""]
    page.text(machine())
    page.text(f"Written by benchmarks/run.py. Loads F* from {LOW:g} to {HIGH:g} in random order.")

    tb.solve(contact("rough"), F_star=loads(engine.FEWEST))  # compiled from here on
    slow, few, found = naive_row()
    page.title("One interface, many loads: by tables")
    page.head(*COLUMNS)
    page.rates(slow, slow)
    for each in many_loads():
        page.rates(each, slow)

    nanoseconds = floor.nanoseconds()
    page.title("Every state with its own load, σ, R, η_a, x_a: by quadrature")
    page.text(
        f"Floor: the exponentials that quadrature over these nodes must evaluate, at "
        f"{nanoseconds:.2f} ns each on one thread."
    )
    page.head(*COLUMNS)
    for each in own_inputs(nanoseconds):
        page.rates(each, slow)

    page.title("And with what decides the contact of a particle: sizes or laws of each state")
    page.head(*COLUMNS)
    for each in own_particles():
        page.rates(each, slow)

    page.title("Every law and height distribution: rough seat, many loads, one thread")
    page.head(*COLUMNS)
    slowest = np.inf
    for each in laws():
        page.rates(each, slow)
        slowest = min(slowest, each.rate)
    page.text(f"Slowest: {slowest:,.0f} states a second, {verdict(slowest, OTHERS)}.")

    page.title("Outputs: 200 loads of one contact on the rough seat, over the bare solve")
    page.head("outputs", "ms more", "x a new contact", "target", "x one with tables")
    for cost in outputs.costs():
        met = verdict(cost.new, OUTPUTS, more=False) if cost.what == "all of them" else ""
        page.row(cost.what, f"{cost.milliseconds:.1f}", f"{cost.new:.2f}", met, f"{cost.known:.1f}")

    page.title("Waiting and memory")
    page.head("what", "", "target")
    for name, value, unit, target in seconds():
        page.row(name, f"{value:,.2f} {unit}", verdict(value, target, more=False))

    page.title("Largest relative difference in d to the script")
    page.head("engine", "", "target")
    errors = dict(largest_difference(few, found))
    for name, value in errors.items():
        page.row(name, f"{value:.1e}", verdict(value, ERROR, more=False))
    (HERE / "results.md").write_text("\n".join(page.lines).strip() + "\n", "utf-8")
    return 0 if max(errors.values()) <= ERROR else 1


if __name__ == "__main__":
    raise SystemExit(main())
