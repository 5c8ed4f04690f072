"""What a user waits for at the command line and at the page, in seconds of one processor.

python benchmarks/waiting.py             # seconds of single things
python benchmarks/waiting.py commands    # every command of daily use, over bare Python
python benchmarks/waiting.py commands --page   # and its part of results.md
"""

from __future__ import annotations

import importlib.util
import os
import resource
import shutil
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
import measured_contact

import thirdbody as tb
from thirdbody.study import check

EXAMPLES = Path(__file__).parent.parent / "examples"
REPEATS = 3
BYTECODE = tempfile.TemporaryDirectory()
"""Where processes find what the first of them compiled, as an installed package has it."""
LOADING = ["-c", "import numpy, scipy.optimize.elementwise, scipy.special, typer"]

BARE = ["-c", "import numpy, scipy.special"]
"""What processor time is told as a multiple of: the same machine, the same minute."""
TEMPLATES = (
    *("ball-screw", "rolling-bearing", "roller-bearing", "linear-guide", "gear"),
    *("additive", "electrical", "two-body"),
)
"""Files of `thirdbody new` that are assessed."""
HARDEST = "6205, quartz that breaks"
"""The hardest usual study: ISO 4406 steel and quartz between the balls and the ring of a 6205."""
COMMANDS: dict[str, tuple[float, list[str]]] = {
    "--help": (0.6, ["--help"]),
    "materials": (1, ["materials"]),
    "new ball-screw": (1, ["new", "ball-screw"]),
    "solve": (2, ["solve", "dusty_ball_screw"]),
    "compare": (2.5, ["compare", "dusty_ball_screw"]),
    "sweep": (3, ["sweep", "sweep", "--out", "states"]),
    "film": (3, ["film", "oil_film"]),
    "table": (2.5, ["table", "dusty_ball_screw", "--out", "table.csv"]),
    **{f"assess {name}": (3, ["assess", f"{name}.toml"]) for name in TEMPLATES},
    f"assess {HARDEST}": (30, ["assess", "breaks.toml"]),
    "assess, 16384 samples": (3, ["assess", "assess"]),
    "design": (2, ["design", "additive"]),
    "report": (10, ["report", "dusty_ball_screw", "--out", "report.html"]),
}
"""Seconds that are aimed at over those of bare Python, and the words of each command; a second word
without an end is an example."""
MAKES = {"new": "ball-screw.toml", "sweep": "states", "table": "table.csv", "report": "report.html"}
"""What commands write, which is removed before."""
TITLE = "## Commands of daily use"
ABOUT = (
    "Processor seconds, user and system, of a process with everything compiled, over those of "
    "`python -c 'import numpy, scipy.special'`, the least of {repeats}. Templates are those of "
    "`thirdbody new`, assessed with 4096 samples; particles that break with 64."
)


def here(call: Callable[[], Any]) -> float:
    """The least processor time of a call, after one that loads and compiles."""
    call()
    spent = []
    for _ in range(REPEATS):
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return min(spent)


def process(*words: str, cwd: str = ".", made: str = "", repeats: int = REPEATS) -> float:
    """The least processor time, user and system, of a Python process that keeps bytecode.

    What it makes is removed before each.
    """
    kept = {name: word for name, word in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    kept["PYTHONPYCACHEPREFIX"] = BYTECODE.name
    spent = []
    for _ in range(repeats):
        if made and (old := Path(cwd, made)).exists():
            shutil.rmtree(old) if old.is_dir() else old.unlink()
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, *words], capture_output=True, check=True, cwd=cwd, env=kept)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(spent)


def commands(*, write: bool) -> int:
    """Every command of daily use, over what loading NumPy and SciPy takes."""
    with tempfile.TemporaryDirectory() as folder:
        for name in TEMPLATES:
            process("-m", "thirdbody", "new", name, cwd=folder, repeats=1)
        process("-m", "thirdbody", "new", "ball-bearing", "6205", cwd=folder, repeats=1)
        whole = Path(folder, "ball-bearing.toml").read_text("utf-8")
        broken = whole.replace("# strength =", "strength =")
        assert broken != whole
        Path(folder, "breaks.toml").write_text(broken, "utf-8")
        process("-m", "thirdbody", "assess", "ball-screw.toml", cwd=folder, repeats=1)  # compiled
        rows = ["| command | seconds | times bare | aim |", "|---|---|---|---|"]
        print("\n".join(rows))
        bare = process(*BARE)
        for name, (aim, words) in COMMANDS.items():
            if len(words) > 1 and (example := EXAMPLES.resolve() / f"{words[1]}.toml").exists():
                words = [words[0], str(example), *words[2:]]
            bare = min(bare, process(*BARE))
            spent = (
                process("-m", "thirdbody", *words, cwd=folder, made=MAKES.get(words[0], "")) - bare
            )
            verdict = "met" if spent <= aim else "NOT MET"
            rows.append(f"| {name} | {spent:.2f} | {spent / bare:.1f} | {verdict} (≤ {aim:g}) |")
            print(rows[-1], flush=True)
    if write:
        page = Path(__file__).parent / "results.md"
        before, _, rest = page.read_text("utf-8").partition(TITLE)
        behind = rest.partition("\n## ")
        about, table = ABOUT.format(repeats=REPEATS), "\n".join(rows)
        after = f"\n{behind[1]}{behind[2]}" if behind[1] else ""
        text = f"{before.rstrip()}\n\n{TITLE}\n\n{about}\n\n{table}\n{after}"
        page.write_text(text, "utf-8")
    return 0


def main() -> int:
    if "commands" in sys.argv[1:]:
        return commands(write="--page" in sys.argv[1:])
    warnings.simplefilter("ignore", tb.errors.RangeWarning)
    dusty, additive = (str(EXAMPLES / f"{n}.toml") for n in ("dusty_ball_screw", "additive"))
    one = ["-m", "thirdbody", "solve", dusty, "--json", "--set", "load.pressure=5 MPa"]
    rows: list[tuple[str, Callable[[], float]]] = [
        ("loading what a command is built on", lambda: process(*LOADING)),
        ("one state by command", lambda: process(*one)),
        ("a design by command", lambda: process("-m", "thirdbody", "design", additive)),
        (
            "a mode map of 40 000 states",
            lambda: here(lambda: tb.plot.mode_map(measured_contact.contact("rough"))),
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
    from thirdbody.study.run import run_film_curve

    study = check(tomllib.loads((EXAMPLES / "oil_film.toml").read_text("utf-8")))
    return here(lambda: run_film_curve(study))


if __name__ == "__main__":
    raise SystemExit(main())
