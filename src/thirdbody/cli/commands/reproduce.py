"""``thirdbody reproduce``: every figure and the claims of a paper."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import InvalidValue
from ...papers import PAPERS
from ..options import not_a_folder

__all__ = ["command"]


def command(
    paper: Annotated[str, typer.Argument(help=f"One of: {', '.join(PAPERS)}.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for figures and ledger.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            "--preset",
            metavar="NAME",
            help="Reading that draws the figures of horng2022; quick: a minute of explicit.",
        ),
    ] = None,
) -> None:
    """Every figure and the ledger of claims of a paper."""
    from importlib import import_module

    problems = []
    if paper not in PAPERS:
        problems.append(f"paper = {paper!r} must be one of {', '.join(PAPERS)}")
    folder = out or Path(paper)
    problems += not_a_folder(folder)
    if problems:
        raise InvalidValue(*problems)
    study = import_module(f"thirdbody.papers.{paper}")
    with _Progress() as progress:
        chosen = {} if preset is None else {"preset": preset}
        done = study.reproduce(folder, progress=progress, **chosen)
    for line in done.lines():
        print(line)


class _Progress:
    """Progress on standard error: a bar on a terminal, a line a stage elsewhere."""

    def __enter__(self) -> Callable[[str, int, int], None]:
        self.bar = None
        self.tasks: dict[str, Any] = {}
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
            self.bar.update(self.tasks[stage], completed=done, total=total)
        elif stage not in self.tasks:
            self.tasks[stage] = None
            print(f"{stage} ...", file=sys.stderr, flush=True)

    def __exit__(self, *_: Any) -> None:
        if self.bar is not None:
            self.bar.stop()
