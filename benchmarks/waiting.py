"""What a user waits for at the command line and at the page, in seconds of one processor.

python benchmarks/waiting.py             # seconds of single things
python benchmarks/waiting.py commands    # every command on an example, over bare Python
"""

from __future__ import annotations

import importlib.util
import os
import resource
import subprocess
import sys
import tempfile
import time
import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))
import run

import thirdbody as tb
from thirdbody.study import check

EXAMPLES = Path(__file__).parent.parent / "examples"
REPEATS = 3
BYTECODE = tempfile.TemporaryDirectory()
"""Where processes find what the first of them compiled, as an installed package has it."""
LOADING = ["-c", "import numpy, scipy.optimize.elementwise, scipy.special, typer"]

BARE = ["-c", "import numpy, scipy.special"]
"""What processor time is told as a multiple of: the same machine, the same minute."""
COMMANDS = {
    "--help": (0.6, ["--help"]),
    "solve": (2, ["solve", "dusty_ball_screw"]),
    "compare": (2.5, ["compare", "dusty_ball_screw"]),
    "film": (3, ["film", "oil_film"]),
    "table": (2.5, ["table", "dusty_ball_screw", "--out", "table.csv"]),
    "assess": (6, ["assess", "assess"]),
    "design": (8, ["design", "additive"]),
    "report": (10, ["report", "dusty_ball_screw", "--out", "report.html"]),
}
"""What is aimed at, and the words of each command; a second word is an example."""


def here(call: Callable[[], Any]) -> float:
    """The least processor time of a call, after one that loads and compiles."""
    call()
    spent = []
    for _ in range(REPEATS):
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return min(spent)


def process(*words: str, cwd: str | None = None) -> float:
    """The least processor time, user and system, of a Python process that keeps bytecode."""
    kept = {name: word for name, word in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    kept["PYTHONPYCACHEPREFIX"] = BYTECODE.name
    spent = []
    for _ in range(REPEATS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, *words], capture_output=True, check=True, cwd=cwd, env=kept)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(spent)


def commands() -> int:
    """Every command on a shipped example, as a multiple of what loading NumPy and SciPy takes."""
    with tempfile.TemporaryDirectory() as folder:
        bare = process(*BARE)
        print(f"{'bare Python':12s} {bare:6.2f} s")
        for name, (aim, (*words,)) in COMMANDS.items():
            if len(words) > 1:
                words[1] = str(EXAMPLES.resolve() / f"{words[1]}.toml")
            spent = process("-m", "thirdbody", *words, cwd=folder)
            print(f"{name:12s} {spent:6.2f} s  {spent / bare:5.1f} x bare  (aim {aim})", flush=True)
        print(f"{'bare, again':12s} {process(*BARE):6.2f} s")
    return 0


def main() -> int:
    if sys.argv[1:] == ["commands"]:
        return commands()
    warnings.simplefilter("ignore", tb.RangeWarning)
    dusty, additive = (str(EXAMPLES / f"{n}.toml") for n in ("dusty_ball_screw", "additive"))
    one = ["-m", "thirdbody", "solve", dusty, "--json", "--set", "load.pressure=5 MPa"]
    rows: list[tuple[str, Callable[[], float]]] = [
        ("loading what a command is built on", lambda: process(*LOADING)),
        ("one state by command", lambda: process(*one)),
        ("a design by command", lambda: process("-m", "thirdbody", "design", additive)),
        (
            "a mode map of 40 000 states",
            lambda: here(lambda: tb.plot.mode_map(run.contact("rough"))),
        ),
    ]
    if importlib.util.find_spec("nicegui") is not None:
        rows += [("200 loads after a slider moved", slider), ("the curve of a film", film)]
    for what, measured in rows:
        print(f"{what:36s} {measured():8.3f} s")
    return 0


def slider() -> float:
    from thirdbody.app.examples import example
    from thirdbody.app.state import State
    from thirdbody.app.tabs.curves import figures

    state, nm = State(example(), Path()), iter(range(101, 200))

    def step() -> None:
        state.set("roughness", "sigma", f"{next(nm)} nm")
        figures(state.answer, "F_star", critical=False)

    return here(step)


def film() -> float:
    from thirdbody.app.tabs.film import solved

    study = check(tomllib.loads((EXAMPLES / "oil_film.toml").read_text("utf-8")))
    return here(lambda: solved(study))


if __name__ == "__main__":
    raise SystemExit(main())
