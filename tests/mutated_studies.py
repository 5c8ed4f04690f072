"""Study files with slips in them, drawn at random, and what must hold whatever is wrong.

    .venv/bin/python tests/mutated_studies.py --studies 3000 --seed 1 --workers 2 --out found.jsonl
    .venv/bin/python tests/mutated_studies.py --seed 1 --index 17      # one of them, in full

Every example and every study of ``thirdbody new`` is changed at one to three places: values at
extremes, of a wrong type, with a wrong unit; keys that are dropped, doubled, misspelled or stand in
another table; NaN, huge numbers, letters of other alphabets, tables in tables; bytes lost from the
file. A command then runs on it in a process of its own. It must end, with an exit status that is
documented, without a traceback, without a warning of Python's own, with an error that names what
is wrong where there is no answer; and no state whose real area is above 1 is told as "ok".
"""

from __future__ import annotations

import argparse
import contextlib
import copy
import dataclasses
import io
import json
import math
import os
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import tomllib
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from random_contacts import Pen

HERE = Path(__file__).resolve().parent
STUDIES = sorted(HERE.parent.glob("examples/*.toml")) + sorted(
    HERE.parent.glob("src/thirdbody/data/studies/*.toml")
)
GUARD, STEP = 300.0, 0.02
"""Seconds after which a command is taken to hang, and between looks at whether it has ended."""
MEMORY = 6 * 2**30
"""Bytes of address space for a command."""

# ---------------------------------------------------------------------------- drawing
Where = tuple[str | int, ...]
"""Keys that lead to a value."""

EXTREMES = (
    *(0, -1, 1, 120, 10**400, -(10**30), True, False),
    *(0.0, -0.0, 1e-300, 5e-324, 1e300, 1.7e308, math.nan, math.inf, -math.inf, 0.5, 2.0, 1e6),
)
TYPES = ("", " ", [], {}, [[]], [{}], "S45C", [1, "two"], {"from": 1}, [0, "4 µm"], 1, "1", True)
WORDS = ("σ", "１２ nm", "𝟏𝟎 nm", "naïve", "\u202e", "x" * 5000, "a.b", "..", "../..", "\0", "%s")
UNITS = (
    *("nm", "um", "µm", "μm", "mm", "m", "km", "furlong", "parsec", "Pa", "GPa", "psi", "kN", "N"),
    *("/ m^2", "1/m", "m^2", "kg", "degC", "K", "s", "V", "wt%", "%", "rad", "deg", "HV", "HRC"),
    *("m^99", "Pa s", "nm nm", "GPA", "kilo", "m/0", "", "particles/mm^2", "J/m^2", "lightyear"),
)
NUMBERS = ("0,4", "1e400", "1e-400", "-3", "0", "1.2.3", "1e", "٣", "5", "1e12", "1e-12", "120")
BYTES = (b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"[", b'"', b"]]", b"=", b"\r", b"\xc3", b"#")


def places(data: Any, at: Where = ()) -> Iterator[Where]:
    """Every key and item, tables before what they hold."""
    items: Any = ()
    if isinstance(data, dict):
        items = data.items()
    elif isinstance(data, list):
        items = enumerate(data)
    for key, value in items:
        yield (*at, key)
        yield from places(value, (*at, key))


def value_at(data: Any, where: Where) -> Any:
    for key in where:
        data = data[key]
    return data


def other_number(pen: Pen, value: Any) -> Any:
    """A value with another magnitude, in its own unit."""
    factor = pen.one((0.0, -1.0, 1e-300, 1e-50, 1e-20, 1e15, 1e50, 1e300))
    if pen.chance(0.7):
        factor = pen.log(1e-12, 1e12) if pen.chance(0.5) else pen.log(1e-2, 1e2)
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return int(value * pen.one((-1, 0, 2, 10, 1000, 10**9, 10**40)))
    if isinstance(value, float):
        return value * factor
    match = re.fullmatch(r"\s*([-+.\deE]+)(.*)", value) if isinstance(value, str) else None
    if not match:
        return pen.one(EXTREMES)
    with contextlib.suppress(ValueError):
        return f"{float(match[1]) * factor:.6g}{match[2]}"
    return value


def other_unit(pen: Pen, value: Any) -> Any:
    number = re.match(r"[-+.\deE]*", value)[0] if isinstance(value, str) else str(value)
    if pen.chance(0.3):
        number = pen.one(NUMBERS)
    return f"{number} {pen.one(UNITS)}"


def misspelled(pen: Pen, word: str) -> str:
    at = int(pen.rng.integers(len(word) + 1))
    return pen.one(
        (word[:at] + word[at + 1 :], word[:at] + "x" + word[at:], word.upper(), word + " ", "σ")
    )


def nested(pen: Pen, value: Any) -> Any:
    depth = pen.one((1, 2, 10, 80))
    for _ in range(depth):
        value = [value] if pen.chance(0.5) else {"a": value}
    return value


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) or (
        isinstance(value, str) and re.match(r"\s*[-+]?\d", value) is not None
    )


def change(pen: Pen, data: dict[str, Any], *, numbers: bool) -> str:
    """One slip in the tables of a study, or a number that is another; says which."""
    every = list(places(data))
    if numbers:
        every = [where for where in every if is_number(value_at(data, where))]
    if not every:
        return "nothing is left"
    where = pen.one(every)
    holder, key = value_at(data, where[:-1]), where[-1]
    value = holder[key]
    kinds = ("extreme", "number", "number", "unit", "unit", "type", "word", "drop", "spell")
    kind = "number" if numbers else pen.one((*kinds, "move", "nest", "again"))
    match kind:
        case "extreme":
            holder[key] = pen.one(EXTREMES)
        case "number":
            holder[key] = other_number(pen, value)
        case "unit" if not isinstance(value, (dict, list)):
            holder[key] = other_unit(pen, value)
        case "type":
            holder[key] = copy.deepcopy(pen.one(TYPES))
        case "word":
            holder[key] = pen.one(WORDS)
        case "drop":
            del holder[key]
        case "spell" if isinstance(key, str):
            holder[misspelled(pen, key)] = holder.pop(key)
        case "move":
            other = value_at(data, pen.one([(), *(w for w in every if len(w) < len(where))]))
            target = other if isinstance(other, dict) else data
            target[str(key)] = copy.deepcopy(value)
        case "nest":
            holder[key] = nested(pen, value)
        case _ if isinstance(holder, list):
            holder.append(copy.deepcopy(value))
        case _:
            holder[key] = [copy.deepcopy(value), copy.deepcopy(value)]
    return f"{kind} {'.'.join(map(str, where))}"


def toml_of(value: Any) -> str:
    """A value as TOML writes it, tables on the line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml_of(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def damaged(pen: Pen, text: bytes) -> tuple[bytes, str]:
    """A file with one slip of an editor or of a disk."""
    lines = text.splitlines(keepends=True)
    at = int(pen.rng.integers(len(lines)))
    cut = int(pen.rng.integers(len(text)))
    match kind := pen.one(("cut", "drop", "double", "swap", "insert", "comma", "unquote", "deep")):
        case "cut":
            return text[:cut], kind
        case "drop":
            del lines[at]
        case "double":
            lines.insert(at, lines[at])
        case "swap":
            other = int(pen.rng.integers(len(lines)))
            lines[at], lines[other] = lines[other], lines[at]
        case "insert":
            return text[:cut] + pen.one(BYTES) + text[cut:], kind
        case "comma":
            lines[at] = re.sub(rb"(\d)\.(\d)", rb"\1,\2", lines[at])
        case "unquote":
            lines[at] = lines[at].replace(b'"', b"")
        case "deep":
            lines[at] = pen.one((b"[" * 3000, b"a = " + b"[" * 3000 + b"]" * 3000, b"a." * 2000))
            lines[at] += b"\n"
    return b"".join(lines), f"{kind} line {at + 1}"


def light(data: Any) -> Any:
    """The study with few points and small maps."""
    if isinstance(data, list):
        return [light(each) for each in data[:4]]
    if not isinstance(data, dict):
        return data
    out = {key: light(value) for key, value in data.items()}
    for key, most in (("points", 3), ("samples", 16), ("surfaces", 1), ("size", 32)):
        if isinstance(out.get(key), int):
            out[key] = min(out[key], most)
    return out


def commands(data: dict[str, Any]) -> tuple[str, ...]:
    """What may run on a study: most often what answers in a second."""
    own = {"sweep": "sweep", "film": "film", "explicit": "explicit", "design": "design"}
    own |= {"uncertainty": "assess"}
    return (
        *("solve",) * 12,
        *("table", "compare"),
        *(command for table, command in own.items() if table in data for _ in range(3)),
    )


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One study with slips, and the command that runs on it."""

    name: str
    text: bytes
    command: str
    slips: tuple[str, ...]


def draw(seed: int, index: int) -> Drawn:
    """The study of a seed and an index."""
    pen = Pen(np.random.default_rng([seed, index]))
    path = STUDIES[index % len(STUDIES)]
    whole = path.read_bytes()
    data = light(tomllib.loads(whole.decode()))
    command = pen.one(commands(data))
    if pen.chance(0.15):
        text, slip = damaged(pen, whole)
        return Drawn(path.stem, text, "solve", (slip,))
    numbers = pen.chance(0.6)
    slips = tuple(change(pen, data, numbers=numbers) for _ in range(pen.one((1, 1, 1, 2, 3))))
    lines = [f"{json.dumps(key)} = {toml_of(value)}" for key, value in data.items()]
    return Drawn(path.stem, "\n".join(lines).encode("utf-8", "replace"), command, slips)


# ---------------------------------------------------------------------------- running
@dataclasses.dataclass(frozen=True)
class Ended:
    """How a command ended; no status where it was stopped."""

    status: int | None
    out: str
    err: str


def arguments(command: str, folder: Path) -> list[str]:
    more = {
        "sweep": ["--out", str(folder / "out")],
        "table": ["--out", str(folder / "table.csv"), "--tolerance", "1e-3"],
        "solve": ["--json"],
        "film": ["--json"],
    }
    return [command, str(folder / "study.toml"), *more.get(command, [])]


def _command(words: list[str], folder: str) -> NoReturn:
    """The command line in a process that was forked for it."""
    status = 1
    try:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(f"{folder}/{name}.txt", os.O_WRONLY | os.O_CREAT), number)
        sys.stdout = io.TextIOWrapper(os.fdopen(1, "wb", closefd=False), "utf-8")
        sys.stderr = io.TextIOWrapper(os.fdopen(2, "wb", closefd=False), "utf-8")
        sys.argv = ["thirdbody", *words]
        from thirdbody.cli import main

        main()
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


class Running:
    """A command on a study, in a process of its own."""

    def __init__(self, drawn: Drawn):
        self.drawn = drawn
        self.folder = tempfile.mkdtemp(prefix="mutated-")
        self.looks = 0
        (Path(self.folder) / "study.toml").write_bytes(drawn.text)
        self.process = os.fork()
        if not self.process:
            _command(arguments(drawn.command, Path(self.folder)), self.folder)

    def ended(self) -> Ended | None:
        """How it ended; None while it runs. To be asked every `STEP` seconds."""
        self.looks += 1
        found, code = os.waitpid(self.process, os.WNOHANG)
        hangs = not found and self.looks * STEP > GUARD
        if hangs:
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)
        elif not found:
            return None
        texts = [Path(self.folder, f"{name}.txt") for name in ("out", "err")]
        out, err = (each.read_text("utf-8", "replace") if each.exists() else "" for each in texts)
        shutil.rmtree(self.folder)
        return Ended(None if hangs else os.waitstatus_to_exitcode(code), out, err)


def problems(drawn: Drawn, ended: Ended) -> list[str]:
    """What does not hold of how a command ended."""
    status, err = ended.status, ended.err
    if status is None:
        return [f"hangs: no end after {GUARD:g} s"]
    found = []
    if "Traceback" in err:
        found.append("traceback: " + err.strip().splitlines()[-1][:200])
    elif status not in (0, 2, 3):
        found.append(f"exit status {status}: {err[-200:]}")
    elif status and not re.search("^(error|Error|Usage): ?", err, re.MULTILINE):
        found.append(f"exit status {status} without a reason: {err[-200:]}")
    if raw := re.search(r"warning: .*(encountered in|Warning:|invalid value|divide by).*", err):
        found.append(f"a warning of Python's own: {raw[0][:200]}")
    if status == 0 and drawn.command in ("solve", "film"):
        found += above_one(ended.out)
    return found


def above_one(text: str) -> list[str]:
    """States that are told as solved and cannot be."""

    def refuse(word: str) -> float:
        raise ValueError(f"{word} is no JSON")

    try:
        states = json.loads(text, parse_constant=refuse)["states"]
    except (ValueError, KeyError) as error:
        return [f"no JSON object with states: {error}"]
    areas = states["A_t"]
    status = states.get("status", ["ok"] * len(areas))
    pairs = [(A, s) for A, s in zip(areas, status, strict=True) if s == "ok"]
    found = [f"A_t = {A:g} told as ok" for A, _ in pairs if A is not None and A > 1]
    return found[:1] + ["no area told as ok"] * any(A is None for A, _ in pairs)


def warm() -> None:
    """Load once what every command needs: the processes share it."""
    import thirdbody.cli
    import thirdbody.study
    import thirdbody.views.plot  # noqa: F401
    from thirdbody.quantities.units import to_si

    to_si("1 km", "m")


def several(seed: int, indices: Iterable[int], workers: int = 1) -> Iterator[dict[str, Any]]:
    """Studies of a seed: the command, how it ended, and what failed."""
    warm()
    waiting = list(indices)[::-1]
    running: dict[int, Running] = {}
    while waiting or running:
        while waiting and len(running) < workers:
            index = waiting.pop()
            running[index] = Running(draw(seed, index))
        time.sleep(STEP)
        for index, each in list(running.items()):
            if ended := each.ended():
                del running[index]
                yield {
                    "seed": seed,
                    "index": index,
                    "study": each.drawn.name,
                    "command": each.drawn.command,
                    "slips": each.drawn.slips,
                    "seconds": round(each.looks * STEP, 1),
                    "status": ended.status,
                    "out": ended.out,
                    "err": ended.err,
                    "failed": problems(each.drawn, ended),
                }


def told(result: dict[str, Any]) -> str:
    """The failures of one study, each with what repeats it."""
    name = f"--seed {result['seed']} --index {result['index']}"
    what = f"{result['command']} {result['study']}, {', '.join(result['slips'])}"
    return "\n".join(f"{name} ({what}): {why}" for why in result["failed"])


def summary(results: list[dict[str, Any]]) -> str:
    """How many studies ended how, and how many failures there were."""
    bad = sum(bool(each["failed"]) for each in results)
    ends = Counter(str(each["status"]) for each in results)
    kinds = Counter(why.partition(":")[0][:40] for each in results for why in each["failed"])
    lines = [f"{len(results)} studies, {bad} with failures"]
    lines += [f"{count:6d}  exit status {status}" for status, count in sorted(ends.items())]
    lines += [f"{count:6d}  {kind}" for kind, count in kinds.most_common()]
    return "\n".join(lines)


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--studies", type=int, default=300, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="index of the first")
    parser.add_argument("--index", type=int, help="this study alone, written out")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--out", type=Path, help="a line of JSON for each study; resumes")
    given = parser.parse_args(words)
    if given.index is not None:
        drawn = draw(given.seed, given.index)
        print(drawn.text.decode("utf-8", "replace"), drawn.command, drawn.slips, sep="\n")
        (result,) = several(given.seed, [given.index])
        print(result["out"][:2000], result["err"], f"exit status {result['status']}", sep="\n")
        print("\n".join(result["failed"]) or "every check holds")
        return bool(result["failed"])
    results = []
    if given.out and given.out.exists():
        lines = (json.loads(line) for line in given.out.read_text("utf-8").splitlines())
        results = [each for each in lines if each["seed"] == given.seed]
    wanted = range(given.first, given.first + given.studies)
    results = [each for each in results if each["index"] in wanted]
    done = {each["index"] for each in results}
    sink = given.out.open("a", encoding="utf-8") if given.out else contextlib.nullcontext()
    with sink as file:
        for result in several(given.seed, [i for i in wanted if i not in done], given.workers):
            results.append({k: v for k, v in result.items() if k not in ("out", "err")})
            if result["failed"]:
                print(told(result), flush=True)
            if file:
                print(json.dumps(results[-1], ensure_ascii=False), file=file, flush=True)
    print(summary(results))
    return any(each["failed"] for each in results)


if __name__ == "__main__":
    sys.exit(main())
