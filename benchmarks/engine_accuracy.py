"""States of `solve_states` against the NumPy engine, one by one, for every law, seat and size.

    python benchmarks/engine_accuracy.py --seconds 20 --page   # and its part of results.md
    python benchmarks/engine_accuracy.py --only "plane, hard" --states 2000

All inputs of a row of `engine_matrix` vary at once, by a factor up to 1.5 up or down, the load from
F* = 1e-8 to 1e-3. What is compared at the separation of each state are load and areas of the NumPy
engine, which makes tables for this state alone.
"""

from __future__ import annotations

import argparse
import os
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import numpy as np
from engine_matrix import cases

import thirdbody as tb
from thirdbody.equilibrium.engine.run import own_columns
from thirdbody.equilibrium.states import state_columns
from thirdbody.errors import NotCompiled

SPREAD, LOADS = 1.5, (1e-8, 1e-3)
"""Factor by which an input varies at most, and F*."""
AT_ONCE = 50
"""States between two looks at the clock."""
SEED = 11
"""Of the random states."""
TITLE = "## The compiled engine against NumPy, state by state"
ABOUT = (
    "By `benchmarks/engine_accuracy.py`: random states, all inputs of a row varied at once by a "
    f"factor up to {SPREAD:g}, F* from {LOADS[0]:g} to {LOADS[1]:g}. Load and area: the largest "
    "relative difference at the separation of the state; d: what the difference in load moves the "
    "separation by, over σ. Estimate: the largest that the engine says of its own error, of "
    "states by laws of their own; above it: states whose true error of the load is more than the "
    "estimate and 2e-11."
)


@dataclass
class Row:
    """What was found of one contact, its inputs varied at random."""

    case: str
    states: int
    load: float
    area: float
    d: float
    estimate: float
    above: int
    numpy: int
    failed: int


def inputs_of(
    contact: tb.Contact, names: list[str], count: int, rng: np.random.Generator
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """F* and the values of the varied inputs of so many states."""
    vary = {}
    for name in names:
        value: object = contact
        for part in name.split("."):
            value = getattr(value, part)
        vary[name] = float(str(value)) * SPREAD ** rng.uniform(-1, 1, count)
        if name.endswith(("nu", "friction_factor")):
            vary[name] = np.minimum(vary[name], 0.49)
        if name.endswith((".k", ".rho")):  # which together may overshoot H
            vary[name] = np.minimum(vary[name], float(str(value)))
        if name.endswith(("gsd", "ratio", "aspect", "alpha")):
            vary[name] = np.maximum(vary[name], 1.55 if name.endswith("alpha") else 1.01)
    return np.exp(rng.uniform(*np.log(LOADS), count)), vary


def compared(
    case: str,
    contact: tb.Contact,
    names: list[str],
    most: int,
    seconds: float,
    chosen: np.ndarray | None = None,
) -> Row:
    """The largest errors of one row, of as many states as the time allows.

    All of them, or of the ``chosen`` ones of one block; every state is solved.
    """
    rng = np.random.default_rng(SEED)
    row, start = Row(case, 0, 0.0, 0.0, 0.0, np.nan, 0, 0, 0), time.process_time()
    while row.states < most and (not row.states or time.process_time() - start < seconds):
        loads, vary = inputs_of(contact, names, min(AT_ONCE, most - row.states), rng)
        found = state_columns(contact, F_star=loads, vary=vary)
        try:
            own = own_columns(contact, vary, "F_star", loads)
            by_own = own["doubt"] == ""
            estimate = np.where(by_own, own["error"], np.nan)
        except NotCompiled:
            by_own, estimate = np.zeros(len(loads), bool), np.full(len(loads), np.nan)
            own = found
        ok = found["status"] == "ok"
        row.states += len(loads)
        row.failed += int(np.sum(~ok))
        row.numpy += int(np.sum([str(each).startswith("numpy") for each in found["engine"]]))
        if chosen is not None:
            ok = ok & np.isin(np.arange(len(loads)), chosen)
        d, F, A_t, beyond = np.full((4, len(loads)), np.nan)
        for columns, mine in ((found, ok), (own, by_own & ok)):
            if not mine.any():
                continue
            new = mine & (columns["d"] != d)
            if new.any():
                d[new] = columns["d"][new]
                some = {name: values[new] for name, values in vary.items()}
                with mock.patch.dict(os.environ, THIRDBODY_ENGINE="numpy"):
                    slow = state_columns(contact, d=d[new], vary=some)
                F[new], A_t[new] = slow["F_star"], slow["A_t"]
                # a slope alone, which needs few digits
                near = d[new] + 1e-4 * sigma_of(contact, some)
                beyond[new] = state_columns(contact, d=near, vary=some)["F_star"]
            load = np.abs(F[mine] / loads[mine] - 1)
            row.load = max(row.load, float(load.max()))
            row.d = max(row.d, float(np.max(1e-4 * load / np.abs(np.log(beyond / F)[mine]))))
            area = np.abs(columns["A_t"][mine] / A_t[mine] - 1)
            row.area = max(row.area, float(area.max()))
            if columns is own:
                row.estimate = float(np.nanmax([row.estimate, *estimate[mine]]))
                row.above += int(np.sum(load > estimate[mine] + 2e-11))
    return row


def sigma_of(contact: tb.Contact, vary: dict[str, np.ndarray]) -> np.ndarray:
    """The roughness of each state [m]."""
    return 0 * next(iter(vary.values())) + vary.get("roughness.sigma", contact.roughness.sigma)


def as_table(rows: list[Row]) -> str:
    """The table of what was found."""
    head = "| case | states | load | area | d/σ | estimate | above it | by NumPy | not ok |"
    lines = [head, "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        estimate = "–" if np.isnan(row.estimate) else f"{row.estimate:.1e}"
        lines.append(
            f"| {row.case} | {row.states} | {row.load:.1e} | {row.area:.1e} | {row.d:.1e} "
            f"| {estimate} | {row.above} | {row.numpy} | {row.failed} |"
        )
    worst = max(rows, key=lambda row: max(row.load, row.area, row.d))
    total = sum(row.states for row in rows)
    lines += ["", f"{total} states in all; the worst row is {worst.case}."]
    return "\n".join(lines) + "\n"


def write_part(text: str) -> None:
    """Put the table into results.md, in place of the one there, before the matrix."""
    page = Path(__file__).parent / "results.md"
    whole = page.read_text("utf-8") if page.exists() else ""
    before, _, rest = whole.partition(TITLE)
    if not rest:
        before, mark, rest = whole.partition("## One input that varies")
        after = mark + rest
    else:
        after = "## " + rest.partition("\n## ")[2] if "\n## " in rest else ""
    page.write_text(f"{before.rstrip()}\n\n{TITLE}\n\n{ABOUT}\n\n{text}\n{after}", "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="rows whose name holds these words")
    parser.add_argument("--states", type=int, default=2000, help="at most, of each row")
    parser.add_argument("--seconds", type=float, default=20.0, help="processor time of each row")
    parser.add_argument("--page", action="store_true", help="write it into results.md")
    asked = parser.parse_args()
    os.environ["THIRDBODY_THREADS"] = "1"
    warnings.simplefilter("ignore")
    contacts: dict[str, tuple[tb.Contact, list[str]]] = {}
    for case, contact, name in cases():
        contacts.setdefault(case, (contact, []))[1].append(name)
    rows = []
    for case, (contact, names) in contacts.items():
        if asked.only in case:
            rows.append(compared(case, contact, names, asked.states, asked.seconds))
            print(rows[-1], flush=True)
    print("\n" + as_table(rows))
    if asked.page:
        write_part(as_table(rows))


if __name__ == "__main__":
    main()
