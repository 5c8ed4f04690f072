"""``thirdbody reproduce``: every figure and the claims of a paper."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import InvalidValue, Mistake, Problem
from ...papers import PAPERS
from ..options import argument, not_a_folder, option

if TYPE_CHECKING:
    from rich.progress import TaskID

__all__ = ["command"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    paper: str = argument(f"One of: {', '.join(PAPERS)}.", "PAPER")
    out: Path | None = option("--out", "Write figures and ledger into a folder.", "DIR")
    preset: str | None = option(
        "--preset",
        "Of horng2022 the reading of its equations, e.g. published; of explicit: quick, a minute.",
        "NAME",
    )


def command(options: Options) -> None:
    """Every figure and the ledger of claims of a paper."""
    from importlib import import_module

    problems: list[str] = []
    if options.paper not in PAPERS:
        problems.append(
            Problem(
                "",
                f"paper = {options.paper!r} must be one of {', '.join(PAPERS)}",
                code=Mistake.OPTION,
            )
        )
    folder = options.out or Path(options.paper)
    problems += not_a_folder(folder)
    if problems:
        raise InvalidValue(*problems)
    study = import_module(f"thirdbody.papers.{options.paper}")
    with _Progress() as progress:
        chosen = {} if options.preset is None else {"preset": options.preset}
        done = study.reproduce(folder, progress=progress, **chosen)
    for line in done.lines():
        print(line)


class _Progress:
    """Progress on standard error: a bar on a terminal, a line a stage elsewhere."""

    def __enter__(self) -> Callable[[str, int, int], None]:
        self.bar = None
        self.tasks: dict[str, TaskID | None] = {}
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import Progress

            self.bar = Progress(console=Console(stderr=True), transient=True)
            self.bar.start()
        return self.report

    def report(self, stage: str, done: int, total: int) -> None:
        if self.bar is not None:
            if stage not in self.tasks:
                self.tasks[stage] = self.bar.add_task(stage, total=total)
            task = self.tasks[stage]
            assert task is not None
            self.bar.update(task, completed=done, total=total)
        elif stage not in self.tasks:
            self.tasks[stage] = None
            print(f"{stage} ...", file=sys.stderr, flush=True)

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.stop()
