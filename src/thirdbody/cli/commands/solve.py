"""``thirdbody solve``: separation, area, load shares and mode under the loads of a study."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...equilibrium.words import (
    MOST_MEET_NONE,
    RARE,
    carried,
    critical_load,
    critical_name,
    happens,
    is_rare,
    load_of,
    mode_among,
    mode_of,
    mode_path,
    two_bodies,
    unsolved,
)
from ...quantities.progress import heartbeat
from ...quantities.say import number, percent, unit_of, value_of
from ...quantities.tables import Table
from ...version import __version__
from ..options import (
    Force,
    JsonFile,
    ParquetFile,
    Settings,
    StudyFile,
    XlsxFile,
    option,
    read_study,
)
from ..show import ALL, MOST_ROWS, some, terminal
from ..streams import STDOUT, TableFiles, warn_of

if TYPE_CHECKING:
    from ...equilibrium.columns import PopulationShare
    from ...equilibrium.transitions import Transitions
    from ...study import StudyResult
    from ...views.columns import Shown
    from ...views.workbook import Sheet

__all__ = ["command", "summary"]

MEANS = {
    "F*": "load F/(A_n E_ss), no unit",
    "pressure": "nominal pressure p",
    "h": "separation of the mean planes",
    "d": "separation d, from the mean asperity height",
    "d/sigma": "d over the RMS roughness, no unit",
    "A_t": "real contact area over the nominal area, no unit",
    "A_ss": "of it on asperities",
    "A_sa": "of it on particles",
    "particles' load": "their part of the load",
    "particles' area": "their part of the real area",
    "mode": "p-s on particles, hybrid on both, s-s on asperities",
}
"""What the heads of the states mean."""
DROP = ("A_ss", "A_sa", "d/sigma", "d", "particles' area", "F*")
"""Columns in the order in which they go where the width is small."""

Columns = dict[str, Callable[[int], str]]
"""Heads of columns, and the cell of a state."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command is told."""

    study: StudyFile
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write one row per state.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """Separation, real contact area, load shares and contact mode under the loads of a study."""
    from ...study import run_study

    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    asked = read_study(options.study, options.settings, writes=files.paths)
    files.need(force=options.force)
    with heartbeat("solve"):
        result = run_study(asked)
    warn_of(result.run_warnings)
    if not result.solved_states:  # no file without a number
        files = TableFiles(json=STDOUT if options.json == STDOUT else None)
    files.write(
        *result.table(),
        sheets=partial(_sheets, result),
        data=result.to_dict,
    )
    for path in files.paths:
        print(f"{len(result.states.status)} states written to {path}", file=sys.stderr)
    if any(files):
        pass
    elif result.solved_states:
        _show(result)
    else:  # what the smooth bodies do is known
        for sentence in result.force_sentences:
            terminal().print(sentence)
    result.need_state()


def _sheets(result: StudyResult) -> list[Sheet]:
    from ...views.study_sheets import state_sheets

    return state_sheets(result, [summary(result)])


def _show(result: StudyResult) -> None:
    """The result for a reader: states, populations, transitions, one sentence."""
    from ...views.columns import modes_of, state_columns

    console = terminal()
    states, contact = result.states, result.study.contact
    console.print(f"{result.title} (thirdbody {__version__})")
    sigma = contact.roughness.sigma
    console.print(f"E_ss = {value_of(contact.E_ss, 'Pa')}, sigma = {value_of(sigma, 'm')}")

    for sentence in result.force_sentences:
        console.print(sentence)

    columns: Columns = {
        each.head: partial(_cell, each, getattr(states, each.name))
        for each in state_columns(contact)
    }
    loads = {head: columns[head] for head in ("F*", "pressure")}
    if not contact.two_body:
        columns["mode"] = lambda i: modes_of(result)[i]
    total = len(states.status)
    console.print(_some_states(columns, total))
    if states.populations:
        console.print("Of the whole load and of the whole real area:")
        console.print(_some_states(loads | _population_columns(states.populations), total))
    if contact.outputs:
        console.print(_output_table(states))
    if total > MOST_ROWS:
        console.print(f"{MOST_ROWS} of {total} states shown; --csv FILE writes all\n")
    for sentence in unsolved(states.status):
        console.print(sentence)
    if not contact.two_body:
        console.print(_transition_table(result.transitions, contact.E_ss))
    console.print(summary(result))


def _cell(column: Shown, values: Any, i: int) -> str:
    """A number of a state as a reader gets it."""
    return column.words(values[i])


def _some_states(columns: Columns, total: int) -> Table:
    """A row a state; of many states some, evenly spread."""
    rows = [[cell(i) for cell in columns.values()] for i in some(total)]
    rare = f"; {RARE}: {MOST_MEET_NONE}" * any(RARE in row for row in rows)
    legend = MEANS | {"mode": MEANS["mode"] + rare}
    table = Table(list(columns), right=True, drop=DROP, more=ALL, legend=legend)
    for row in rows:
        table.add_row(*row)
    return table


def _population_columns(populations: Iterable[PopulationShare]) -> Columns:
    """Shares of load and area of each population."""

    def share(values: Any) -> Callable[[int], str]:
        return lambda i: percent(values[i])

    out: Columns = {}
    for part in populations:
        out[f"{part.name}: load"] = share(part.load_share)
        out[f"{part.name}: area"] = share(part.area_share)
    return out


def _output_table(states: Any) -> Table:
    """The numbers of the outputs: a row each at one load, a column each at several."""
    outputs = {name: (states.about(name), values) for name, values in states.outputs.items()}
    loads = [value_of(value, "Pa") for value in states.pressure]
    if len(loads) == 1:
        table = Table(("", loads[0], "unit", "meaning"), words=["meaning"], more=ALL)
        for name, (told, values) in outputs.items():
            table.add_row(name, number(values[0]), unit_of(told.unit) or "none", told.meaning)
        return table
    heads = {
        f"{name} [{unit}]" if (unit := unit_of(told.unit)) else name: (
            told.meaning + ("" if unit else ", no unit")
        )
        for name, (told, _) in outputs.items()
    }
    table = Table(["pressure", *heads], right=True, wrap=True, legend=heads)
    for i in some(len(loads)):
        table.add_row(loads[i], *(number(values[i]) for _, values in outputs.values()))
    return table


def _transition_table(critical: Transitions, E_ss: float) -> Any:
    heads = ("critical load", "F*", "pressure", "status")
    table = Table(heads, words=heads[:1], drop=["F*"], more=ALL)
    for name, entry in critical.entries().items():
        loads = (critical_load(entry.value, entry.status, E) for E in (None, E_ss))
        table.add_row(f"{critical_name(name)}: {happens(name)}", *loads, entry.status)
    return table


def summary(result: StudyResult) -> str:
    """The result in plain words."""
    states, three_body = result.states, not result.study.contact.two_body

    def state(i: int) -> str:
        gap = (
            f"separation h = {value_of(states.h[i], 'm')} "
            f"(d = {value_of(states.d[i], 'm')}, {number(states.d_star[i], 3)} sigma)"
        )
        if not states.A_t[i]:
            return f"{mode_of(None)}; {gap}"
        area = f"real contact area {percent(states.A_t[i])} of the nominal area"
        if not three_body:
            return f"{two_bodies()}; {gap}, {area}"
        parts = {part.name: part.load_share[i] for part in states.populations}
        share = carried(states.particle_load_share[i], parts)
        mode = states.mode[i]
        how = mode_among(mode, held := result.particles_in(i))
        where = " of a wide surface" * is_rare(mode, held)
        return f"{how}, and {share}{where}; {gap}, {area}"

    def answer_at(i: int) -> str:
        return f"At {load_of(states.pressure[i], states.F_star[i])} {state(i)}."

    known = sorted(result.solved_states, key=lambda i: states.pressure[i])
    first, last = known[0], known[-1]
    whole = f" {told}" if (told := result.body_sentence()) else ""
    if first == last:
        return answer_at(first) + whole
    if not three_body or whole:
        return f"{answer_at(first)} {answer_at(last)}{whole}"
    return f"{answer_at(first)} {answer_at(last)} {mode_path(states.mode[i] for i in known)}."
