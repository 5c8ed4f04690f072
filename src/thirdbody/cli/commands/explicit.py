"""``thirdbody explicit``: the loads of a study on maps of heights, every particle at its place."""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import typer

from ...errors import InvalidValue
from ...quantities.plain_data import plain_data
from ...quantities.progress import heartbeat
from ...quantities.say import number, percent, signed, value_of
from ...quantities.tables import Table
from ..options import AsJson, Settings, StudyFile, not_a_folder, read_study
from ..show import terminal
from ..streams import NO_ANSWER, TableFiles, warn, warn_of, write_figure

__all__ = ["command"]

MAPS = ("last", "all")


def command(
    study: StudyFile,
    surfaces: Annotated[
        int | None, typer.Option("--surfaces", help="How many synthetic surfaces.")
    ] = None,
    size: Annotated[
        int | None, typer.Option("--size", help="Points along each side of a surface.")
    ] = None,
    spacing: Annotated[
        str | None, typer.Option("--spacing", metavar="LENGTH", help='Of the points: "100 nm".')
    ] = None,
    seats: Annotated[
        str | None,
        typer.Option("--seats", help="Where particles lie, e.g. random, settled, valleys."),
    ] = None,
    maps: Annotated[str, typer.Option("--maps", metavar="last|all", help="Maps to keep.")] = "last",
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Folder for states.csv, maps.nc, explicit.png and .json."
        ),
    ] = None,
    workers: Annotated[
        int, typer.Option("--workers", metavar="N", help="Threads that press a surface each.")
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler", metavar="ADDRESS", help="A Dask cluster that presses them instead."
        ),
    ] = None,
    as_json: AsJson = False,
    settings: Settings = None,
) -> None:
    """The loads of a study on maps of heights, with every particle at its place."""
    from ...quantities.run_files import release_folder
    from ...study.run_explicit import claim_results, run_explicit

    _check(maps, workers, out)
    short = {"surfaces": surfaces, "size": size, "spacing": spacing, "seats": seats}
    own = [
        f"explicit.{name}={json.dumps(value)}" for name, value in short.items() if value is not None
    ]
    asked = read_study(study, [*(settings or ()), *own])
    if out is not None:
        claim_results(out, asked, maps=maps)
    kept = None if out is None else out / "surfaces"
    # a measured surface is one: nothing counts it
    bar = sys.stderr.isatty() and len(asked.faces) != 1
    try:
        with nullcontext() if bar else heartbeat("explicit"):
            result = run_explicit(
                asked, folder=kept, workers=workers, scheduler=scheduler, progress=bar,
                maps=maps,  # type: ignore[arg-type]
            )  # fmt: skip
    except BaseException:
        if out is not None:
            release_folder(out)
        raise
    warn_of(result.data["warnings"][len(asked.notes) :])
    if out is not None:
        _write(out, result)
    if as_json:
        print(json.dumps(plain_data(result.data), indent=1, allow_nan=False))
    else:
        _show(result.data)
    if not result.converged:
        warn("some states did not converge to the certificate asked for; see states.csv")
        raise typer.Exit(NO_ANSWER)


def _check(maps: str, workers: int, out: Path | None) -> None:
    problems = not_a_folder(out)
    if maps not in MAPS:
        problems.append(f"--maps {maps} must be last or all")
    if workers < 1:
        problems.append(f"--workers {workers} must be at least 1")
    if problems:
        raise InvalidValue(*problems)


def _write(out: Path, result: Any) -> None:
    from ...quantities.files import write_text
    from ...views.plot import explicit

    TableFiles(csv=out / "states.csv").write(result.columns, result.units)
    result.state.to_netcdf(out / "maps.nc")
    write_text(
        out / "explicit.json", json.dumps(plain_data(result.data), indent=1, allow_nan=False) + "\n"
    )
    for name in ("states.csv", "maps.nc", "explicit.json"):
        print(f"written: {out / name}", file=sys.stderr)
    write_figure(out / "explicit.png", explicit(result.state))


def _show(data: dict[str, Any]) -> None:
    """The table against the statistical model, the seat, one sentence."""
    console = terminal()
    many = data["surfaces"] > 1
    source = f"{data['surfaces']} synthetic surfaces" if data["source"] == "synthetic" else (
        data["source"]
    )  # fmt: skip
    console.print(f"{data['title'] or 'Study'} (thirdbody {data['version']})")
    console.print(f"{source}, every particle at its place, against the statistical model")
    table, synthetic = data["table"], "h_cv" in data["table"]
    heads = ["F*", "", "explicit"]
    heads += ["luck removed"] * synthetic + ["statistical"] + ["difference"] * (synthetic and many)
    grid = Table(heads, right=True)
    three_body = data["inputs"]["particles"] is not None
    shown = {"h": "separation h", "A_t": "area"}
    if three_body:
        shown |= {"particle_load_share": "particles' load", "particle_area_share": "their area"}
    for i, load in enumerate(table["F_star"]):
        for k, (name, words) in enumerate(shown.items()):
            cells = [number(load) if k == 0 else "", words]
            kinds = ("raw", "cv") if synthetic else ("raw",)
            for kind in kinds:
                error = table[f"{name}_{kind}_error"][i]
                least = table[f"{name}_{kind}_least"][i] if "share" in name and synthetic else None
                if kind == "cv" and least is not None:
                    most = percent(table[f"{name}_{kind}_most"][i], digits=3)
                    cells.append(f"{percent(least, digits=3)} to {most}")
                else:
                    cells.append(_cell(name, table[f"{name}_{kind}"][i], error))
            cells.append(_cell(name, table[f"{name}_statistical"][i], None))
            if synthetic and many:
                away = table[f"{name}_difference"][i]
                cells.append("-" if away is None else f"{signed(away, 1)} errors")
            grid.add_row(*cells)
    console.print(grid)
    seats = data["seats"]
    if three_body and seats["mean"] is not None and seats["mean"] == seats["mean"]:
        # to be put into a study file: digits and a minus as TOML has them
        mean, std = round(seats["mean"], 3), round(seats["std"], 3)
        console.print(
            "The statistical model has these seats:  [particle_law] "
            f"zeta_mean = {mean}, zeta_std = {std}"
        )
        console.print(
            f"Seats above 2.5 sigma, which carry small loads: {percent(seats['high'])}; "
            f"Gaussian: {percent(seats['high_gaussian'])}."
        )
    if data.get("summary"):
        console.print(data["summary"])


def _cell(name: str, value: float | None, error: float | None) -> str:
    if value is None:
        return "-"
    if name == "h":
        spread = f" ± {value_of(error, 'm', 2)}" if error else ""
        return value_of(value, "m") + spread
    return percent(value, error or 0.0)
