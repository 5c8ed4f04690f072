"""``thirdbody solve``: separation, area, load shares and mode under the loads of a study."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...equilibrium.words import (
    MOST_MEET_NONE,
    NO_MODE,
    RARE,
    critical_load,
    critical_name,
    happens,
    unsolved_sentences,
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
from ..streams import STDOUT, TableFiles, tell_written, warn_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...equilibrium.columns import PopulationShare
    from ...equilibrium.transitions import Transitions
    from ...study import StudyResult
    from ...views.columns import Shown
    from ...views.workbook import Sheet

__all__ = ["command"]

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
"""Columns in the order in which they go where the width is small; the others go below then."""

Columns = dict[str, Callable[[int], str]]
"""Heads of columns, and the cell of a state."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: StudyFile
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write a table, one row per state, e.g. a.csv.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """Who carries the load of a study, and how close surfaces are.

    Separation, real contact area, load shares and contact mode under each of its loads.
    """
    from ...study import run_study

    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    study = read_study(options.study, options.settings, writes=files.paths)
    files.need(force=options.force)
    with heartbeat("solve"):
        result = run_study(study)
    warn_of((*result.oil_notes, *result.run_warnings), _shares(result))
    if not result.solved_states:  # no file without a number
        files = TableFiles(json=STDOUT if options.json == STDOUT else None)
    files.write(
        *result.table(),
        sheets=partial(_sheets, result),
        data=result.to_dict,
    )
    tell_written(*files.paths)
    if files.json == STDOUT:
        pass
    elif result.solved_states:
        _show(result)
    else:  # what the smooth bodies do is known
        for sentence in result.force_sentences:
            terminal().print(sentence)
    result.need_state()


def _shares(result: StudyResult) -> dict[str, float]:
    """Parts of the load that notes of these codes are about: the largest that particles carry.

    Nothing where the answer is of single particles, that is of [body] or of outputs.
    """
    if result.forces or result.study.contact.outputs or not result.solved_states:
        return {}
    shares = [float(result.states.particle_load_share[i]) for i in result.solved_states]
    return {"squeezed": max(shares)}


def _sheets(result: StudyResult) -> list[Sheet]:
    from ...views.study_sheets import state_sheets

    return state_sheets(result)


def _show(result: StudyResult) -> None:
    """The result for a reader: the answer, the states, what moves it most, and the rest."""
    from ...views.columns import modes_of, state_columns
    from ...views.state_words import answer, details, uncertainty

    console = terminal()
    states, contact = result.states, result.study.contact
    console.print(f"{result.heading} (thirdbody {__version__})")
    for sentence in answer(result):
        console.print(sentence)

    columns: Columns = {
        column.head: partial(_cell, column, getattr(states, column.name))
        for column in state_columns(contact)
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
    for sentence in [*unsolved_sentences(states.status), *uncertainty(result)]:
        console.print(sentence)
    if not contact.two_body:
        console.print(_transition_table(result.transitions, contact.E_ss))
    for sentence in details(result):
        console.print(sentence)
    sigma = contact.roughness.sigma
    console.print(f"E_ss = {value_of(contact.E_ss, 'Pa')}, sigma = {value_of(sigma, 'm')}")


def _cell(column: Shown, values: Sequence[float], i: int) -> str:
    """A number of a state as a reader gets it."""
    return column.words(values[i])


def _some_states(columns: Columns, total: int) -> Table:
    """A row a state; of many states some, evenly spread."""
    rows = [[cell(i) for cell in columns.values()] for i in some(total)]
    more = f"; {RARE}: {MOST_MEET_NONE}" * any(RARE in row for row in rows)
    mode = columns.get("mode", str)
    more += f"; -: {NO_MODE}" * any(mode(i) == "-" for i in some(total))
    legend = MEANS | {"mode": MEANS["mode"] + more}
    table = Table(list(columns), right=True, drop=DROP, more=ALL, legend=legend, wrap=True)
    for row in rows:
        table.add_row(*row)
    return table


def _population_columns(populations: Iterable[PopulationShare]) -> Columns:
    """Shares of load and area of each population."""

    def share(values: Any) -> Callable[[int], str]:
        return lambda i: percent(values[i])

    out: Columns = {}
    for population in populations:
        out[f"{population.name}: load"] = share(population.load_share)
        out[f"{population.name}: area"] = share(population.area_share)
    return out


def _output_table(states: Any) -> Table:
    """The numbers of the outputs: a row each at one load, a column each at several."""
    outputs = {name: (states.about(name), values) for name, values in states.outputs.items()}
    loads = [value_of(value, "Pa") for value in states.pressure]
    if len(loads) == 1:
        table = Table(("", loads[0], "unit", "meaning"), words=["meaning"], more=ALL)
        for name, (about, values) in outputs.items():
            table.add_row(name, number(values[0]), unit_of(about.unit) or "none", about.meaning)
        return table
    heads = {
        f"{name} [{unit}]" if (unit := unit_of(about.unit)) else name: (
            about.meaning + ("" if unit else ", no unit")
        )
        for name, (about, _) in outputs.items()
    }
    table = Table(["pressure", *heads], right=True, wrap=True, legend=heads)
    for i in some(len(loads)):
        table.add_row(loads[i], *(number(values[i]) for _, values in outputs.values()))
    return table


def _transition_table(critical: Transitions, E_ss: float) -> object:
    heads = ("critical load", "F*", "pressure", "status")
    table = Table(heads, words=heads[:1], drop=["F*"], more=ALL)
    for name, entry in critical.entries().items():
        loads = (critical_load(entry.value, entry.status, E) for E in (None, E_ss))
        table.add_row(f"{critical_name(name)}: {happens(name)}", *loads, entry.status)
    return table
