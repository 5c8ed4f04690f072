"""Commands that answer one question of a study: the answer, a table, and what is left open."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ..quantities.tables import Table
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
More = tuple[str, Sequence[str], Sequence[Sequence[str]], Mapping[str, str]]
"""A table: the sentence above it, heads, rows, and what the heads mean."""


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

    asked = load(file, settings or ())
    if figure is not None:
        figure_format(figure)
    if paths := [*files.paths, *([] if figure is None else [figure])]:
        refuse_clashes(paths, files_of(file, settings or ()))
    files.need(figure, force=force)
    return asked


def give_answer(
    found: QuestionResult,
    files: TableFiles,
    *,
    answer: Sequence[str],
    heads: Sequence[str],
    rows: Sequence[Sequence[str]],
    means: Mapping[str, str],
    last: Sequence[str],
    more: Sequence[More] = (),
    times: Sequence[float] | None = None,
    draw: Callable[[], Figure] | None = None,
    figure: Path | None = None,
    settings: Sequence[str] | None = None,
) -> None:
    """The answer first, then the table, then what moves it most; warnings at the very end.

    ``more`` are tables that follow the first one, each with the sentence above it. With the times
    of its rows, the first table shows more of the beginning. What ``draw`` makes goes into the
    workbook, and into the file ``figure`` where there is one. The heading tells the keys that
    ``settings`` set over the file.
    """
    from ..study.toml import heading_of, setting_in_words

    title = heading_of(found.title, map(setting_in_words, settings or ()))
    files.write(
        *found.table(),
        sheets=partial(_sheets, found, title, answer, (heads, rows), last, more, draw),
        data=found.to_dict,
    )
    tell_written(*files.paths)
    if draw is not None and figure is not None:
        write_figure(figure, draw())
    if files.json != STDOUT:
        console = terminal()
        console.print(f"{title} (thirdbody {__version__})\n")
        for sentence in answer:
            console.print(sentence)
        table = Table(heads, right=True, more=ALL, legend=means)
        shown = some(len(rows)) if times is None else some_times(times)
        for i in shown:
            table.add_row(*rows[i])
        console.print(table)
        if len(rows) > MOST_ROWS:
            console.print(f"{len(shown)} of {len(rows)} rows shown; --csv FILE writes all")
        for sentence, own_heads, own_rows, own_means in more:
            console.print(sentence)
            another = Table(own_heads, words=own_heads[:1], right=True, more=ALL, legend=own_means)
            for row in own_rows:
                another.add_row(*row)
            console.print(another)
        for sentence in last:
            console.print(sentence)
        sys.stdout.flush()
    for sentence in found.asked.assumed:
        remark(sentence, counts=True)
    warn_of(found.warnings)


def _sheets(
    found: Any,
    title: str,
    answer: Sequence[str],
    table: tuple[Sequence[str], Sequence[Sequence[str]]],
    last: Sequence[str],
    more: Sequence[More],
    draw: Callable[[], Figure] | None,
) -> list[Sheet]:
    from ..views.figure_files import png_of
    from ..views.printed_tables import grid_of_words
    from ..views.question_sheets import inputs_of, question_sheets

    given = found.asked.described_inputs
    below: list[str | Grid | bytes] = []
    for sentence, heads, rows, _ in more:
        below += [sentence, grid_of_words(heads, rows)]
    return question_sheets(
        title,
        answer,
        table,
        [*below, *last, *([] if draw is None else [png_of(draw())])],
        states=found.table(),
        meanings=found.meanings,
        inputs=inputs_of(given.values, given.bodies, given.numbers, found.asked.stated),
        warnings=[*found.asked.assumed, *found.warnings],
        citations=found.citations,
    )
