"""``thirdbody design``: the best inputs over a range of loads, under limits."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...quantities.say import number
from ..options import AsJson, Settings, read_study
from ..show import table_of, terminal
from ..streams import figure_format, warn, write_csv, write_figure

if TYPE_CHECKING:
    from ...analysis.design.design import Best
    from ...study import Study

__all__ = ["command"]

MOST_OF_FRONT = 20
"""Lines of a front that a terminal shows."""


def command(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="A study file with a table [design].")
    ],
    as_json: AsJson = False,
    csv_file: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write every point tried.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw the points tried.")
    ] = None,
    settings: Settings = None,
) -> None:
    """The best size, concentration or roughness over a range of loads, under limits."""
    from ...quantities.files import need_folders
    from ...study.analyses import design_study

    asked = read_study(study, settings)
    need_folders(csv_file, figure)
    if figure is not None:
        figure_format(figure)  # refused before long work
    best = design_study(asked, progress=True)
    for sentence in best.warnings:
        warn(sentence)
    if csv_file is not None:
        columns = {str(name): best.points[name].values.tolist() for name in best.points}
        write_csv(csv_file, columns, dict.fromkeys(columns, ""))
        print(f"written: {csv_file}", file=sys.stderr)
    if figure is not None:
        from ...views.plot.design import tried

        write_figure(figure, tried(best))
    if as_json:
        told = {"title": asked.title, **best.to_dict()}
        print(json.dumps(told, indent=1, allow_nan=False))
    else:
        _page(asked, best)


def _page(asked: Study, best: Best) -> None:
    out = terminal()
    out.print(asked.title or "design")
    if not best.feasible:
        out.print(f"\nNothing tried obeys the limits. Nearest is what follows: {best.reason}")
    front = best.points["front"].values
    several = len(best.objectives) > 1
    out.print("\none of the best" if several else "\nbest")
    table = table_of(("", "value", "within 5 % from", "to"), right=True)
    for name, value in best.values.items():
        band = best.tolerance.get(name)
        shown = [number(end) for end in band] if band else ["", ""]
        table.add_row(name, value.name if band is None else number(value), *shown)
    out.print(table)
    for label, value in best.objectives.items():
        out.print(f"{label} = {number(value)}")
    out.print(f"limits in force: {'; '.join(best.active) or 'none'}")
    _against_load(out, best)
    if best.slopes:
        out.print("change of a metric for a relative change of an input, at the middle load")
        table = table_of(("", *next(iter(best.slopes.values()))), right=True)
        for column, slopes in best.slopes.items():
            table.add_row(f"d {column}/d ln", *map(number, slopes.values()))
        out.print(table)
    if several:
        out.print(f"{front.sum()} of {len(front)} points are beaten by none in every objective")
        chosen = best.points.isel(point=front).sortby(next(iter(best.objectives)))
        names = [*best.values, *best.objectives]
        table = table_of(names, right=True)
        count = chosen.sizes["point"]
        for i in sorted({round(k * (count - 1) / MOST_OF_FRONT) for k in range(MOST_OF_FRONT + 1)}):
            table.add_row(*(_shown(chosen[name].values[i]) for name in names))
        out.print(table)


def _against_load(out: Any, best: Best) -> None:
    """Metrics at the ends and in the middle of the loads."""
    (load,) = best.states.dims
    names = [str(name) for name in best.states.data_vars]
    table = table_of((str(load), *names), right=True)
    count = best.states.sizes[load]
    for i in sorted({0, count // 2, count - 1}):
        one = best.states.isel({load: i})
        table.add_row(number(float(one[load])), *(_shown(one[name].item()) for name in names))
    out.print(table)


def _shown(value: Any) -> str:
    return value if isinstance(value, str) else number(float(value))
