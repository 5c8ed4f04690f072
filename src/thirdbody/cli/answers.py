"""Commands that answer one question of a study: the answer, a table, and what is left open."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..quantities.tables import Table
from ..version import __version__
from .show import ALL, MOST_ROWS, some, terminal
from .streams import STDOUT, TableFiles, remark, tell_written, warn_of

if TYPE_CHECKING:
    from ..views.workbook import Sheet

__all__ = ["give_answer", "read_question"]

Asked = TypeVar("Asked")


def read_question(
    load: Callable[[Path, Iterable[str]], Asked],
    file: Path,
    settings: list[str] | None,
    files: TableFiles,
    *,
    force: bool,
) -> Asked:
    """Question of a study file, after a check of the files to be written."""
    from ..quantities.files import refuse_clashes
    from ..study.whole import files_of

    asked = load(file, settings or ())
    if files.paths:
        refuse_clashes(files.paths, files_of(file, settings or ()))
    files.need(force=force)
    return asked


def give_answer(
    found: Any,
    files: TableFiles,
    *,
    answer: Sequence[str],
    heads: Sequence[str],
    rows: Sequence[Sequence[str]],
    means: Mapping[str, str],
    last: Sequence[str],
) -> None:
    """The answer first, then the table, then what moves it most; warnings at the very end."""
    files.write(
        *found.table(),
        sheets=partial(_sheets, found, answer, (heads, rows), last),
        data=found.to_dict,
    )
    tell_written(*files.paths)
    if files.json != STDOUT:
        console = terminal()
        console.print(f"{found.title} (thirdbody {__version__})\n")
        for sentence in answer:
            console.print(sentence)
        table = Table(heads, right=True, more=ALL, legend=means)
        for i in some(len(rows)):
            table.add_row(*rows[i])
        console.print(table)
        if len(rows) > MOST_ROWS:
            console.print(f"{MOST_ROWS} of {len(rows)} rows shown; --csv FILE writes all")
        for sentence in last:
            console.print(sentence)
        sys.stdout.flush()
    for sentence in found.asked.assumed:
        remark(sentence, counts=True)
    warn_of(found.warnings)


def _sheets(
    found: Any,
    answer: Sequence[str],
    table: tuple[Sequence[str], Sequence[Sequence[str]]],
    last: Sequence[str],
) -> list[Sheet]:
    from ..views.question_sheets import inputs_of, question_sheets

    given = found.asked.described
    return question_sheets(
        found.title,
        answer,
        table,
        last,
        states=found.table(),
        meanings=found.meanings,
        inputs=inputs_of(given.values, given.bodies, given.numbers),
        warnings=[*found.asked.assumed, *found.warnings],
        citations=found.citations,
    )
