"""Commands that answer one question of a study: the answer, a table, and what is left open."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..quantities.tables import Table, WordTable
from ..version import __version__
from .show import ALL, MOST_ROWS, some, some_times, terminal
from .streams import (
    STDOUT,
    TableFiles,
    figure_format,
    remark,
    tell_written,
    warn_of,
    write_figure,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..study.asked_result import QuestionResult
    from ..views.workbook import Grid, Sheet

__all__ = ["give_answer", "read_question"]

Asked = TypeVar("Asked")


def read_question(
    load: Callable[[Path, Iterable[str]], Asked],
    file: Path,
    settings: list[str] | None,
    files: TableFiles,
    *,
    figure: Path | None = None,
    force: bool,
) -> Asked:
    """Question of a study file, after a check of the files to be written."""
    from ..quantities.files import refuse_clashes
    from ..study.whole import files_of

    question = load(file, settings or ())
    if figure is not None:
        figure_format(figure)
    if paths := [*files.paths, *([] if figure is None else [figure])]:
        refuse_clashes(paths, files_of(file, settings or ()))
    files.need(figure, force=force)
    return question


def give_answer(
    result: QuestionResult,
    files: TableFiles,
    *,
    answer: Sequence[str],
    table: WordTable,
    last: Sequence[str],
    more: Sequence[WordTable] = (),
    times: Sequence[float] | None = None,
    draw: Callable[[], Figure] | None = None,
    figure: Path | None = None,
    settings: Sequence[str] | None = None,
) -> None:
    """The answer first, then the table, then what moves it most; warnings at the very end.

    ``more`` are tables that follow the first one. With the times of its rows, the first table shows
    more of the beginning. What ``draw`` makes goes into the workbook, and into the file ``figure``
    where there is one. The heading tells the keys that ``settings`` set over the file.
    """
    from ..study.toml import heading_of, setting_in_words

    title = heading_of(result.title, map(setting_in_words, settings or ()))
    files.write(
        *result.table(),
        sheets=partial(_sheets, result, title, answer, table, last, more, draw),
        data=result.to_dict,
    )
    tell_written(*files.paths)
    if draw is not None and figure is not None:
        write_figure(figure, draw())
    if files.json != STDOUT:
        console = terminal()
        console.print(f"{title} (thirdbody {__version__})\n")
        for sentence in answer:
            console.print(sentence)
        first = Table(table.heads, right=True, more=ALL, legend=table.means)
        count = len(table.rows)
        shown = some(count) if times is None else some_times(times)
        for i in shown:
            first.add_row(*table.rows[i])
        console.print(first)
        if count > MOST_ROWS:
            console.print(f"{len(shown)} of {count} rows shown; --csv FILE writes all")
        for word_table in more:
            console.print(word_table.above)
            words = word_table.heads[:1]
            another = Table(
                word_table.heads, words=words, right=True, more=ALL, legend=word_table.means
            )
            for row in word_table.rows:
                another.add_row(*row)
            console.print(another)
        for sentence in last:
            console.print(sentence)
        sys.stdout.flush()
    for sentence in result.asked.assumed:
        remark(sentence, counts=True)
    warn_of(result.warnings)


def _sheets(
    result: Any,
    title: str,
    answer: Sequence[str],
    table: WordTable,
    last: Sequence[str],
    more: Sequence[WordTable],
    draw: Callable[[], Figure] | None,
) -> list[Sheet]:
    from ..views.figure_files import png_of
    from ..views.printed_tables import grid_of_words
    from ..views.question_sheets import inputs_of, question_sheets

    inputs = result.asked.described_inputs
    below: list[str | Grid | bytes] = []
    for word_table in more:
        below += [word_table.above, grid_of_words(word_table.heads, word_table.rows)]
    return question_sheets(
        title,
        answer,
        (table.heads, table.rows),
        [*below, *last, *([] if draw is None else [png_of(draw())])],
        states=result.table(),
        meanings=result.meanings,
        inputs=inputs_of(inputs.values, inputs.bodies, inputs.numbers, result.asked.stated),
        warnings=[*result.asked.assumed, *result.warnings],
        citations=result.citations,
    )
