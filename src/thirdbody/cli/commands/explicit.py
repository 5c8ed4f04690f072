"""``thirdbody explicit``: the loads of a study on maps of heights, every particle at its place."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.plain_data import plain_data
from ...quantities.say import number, percent, signed_number, value_of
from ...quantities.tables import Table
from ..options import AsJson, Settings, StudyFile, not_a_folder, option, read_study
from ..show import terminal
from ..streams import NO_ANSWER, TableFiles, print_json, tell_written, warn, warn_of, write_figure

if TYPE_CHECKING:
    from ...study.run_explicit import ExplicitResult

__all__ = ["command"]

MAPS = ("last", "all")


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: StudyFile
    surfaces: int | None = option("--surfaces", "How many synthetic surfaces, e.g. 4.", "N")
    size: int | None = option("--size", "Points along each side of a surface, e.g. 256.", "N")
    spacing: str | None = option(
        "--spacing", 'Distance between the points, e.g. "100 nm".', "LENGTH"
    )
    seats: str | None = option(
        "--seats",
        "Where particles lie: random, settled, downhill, valleys, highest, summits, sphere.",
        "NAME",
    )
    maps: str = option("--maps", "Loads whose maps are kept in DIR.", "last|all", default="last")
    out: Path | None = option(
        "--out", "Write states.csv, maps.nc, explicit.png and .json into a folder.", "DIR"
    )
    workers: int = option("--workers", "Threads that press a surface each.", "N", default=1)
    scheduler: str | None = option(
        "--scheduler",
        "A Dask cluster that presses them instead, e.g. tcp://10.0.0.5:8786.",
        "ADDRESS",
    )
    as_json: AsJson = False
    settings: Settings = None


def command(options: Options) -> None:
    """A study pressed point by point, every particle at its place.

    On maps of heights, as measured or made; it takes seconds to minutes.
    """
    from ...quantities.run_files import release_folder
    from ...study.run_explicit import claim_results, run_explicit

    _check(options.maps, options.workers, options.out)
    short = {
        "surfaces": options.surfaces,
        "size": options.size,
        "spacing": options.spacing,
        "seats": options.seats,
    }
    explicit_settings = [
        f"explicit.{name}={json.dumps(value)}" for name, value in short.items() if value is not None
    ]
    study = read_study(options.study, [*(options.settings or ()), *explicit_settings])
    if options.out is not None:
        claim_results(options.out, study, maps=options.maps)
    kept = None if options.out is None else options.out / "surfaces"
    try:
        result = run_explicit(
            study,
            folder=kept,
            workers=options.workers,
            scheduler=options.scheduler,
            progress=True,
            maps=options.maps,  # type: ignore[arg-type]
        )
    except BaseException:
        if options.out is not None:
            release_folder(options.out)
        raise
    warn_of(result.data["warnings"][len(study.notes) :])
    if options.out is not None:
        _write(options.out, result)
    if options.as_json:
        print_json(plain_data(result.data))
    else:
        _show(result.data, study.heading)
    if not result.converged:
        warn("some states did not converge to the certificate asked for; see states.csv")
        raise typer.Exit(NO_ANSWER)


def _check(maps: str, workers: int, out: Path | None) -> None:
    problems = not_a_folder(out)
    if maps not in MAPS:
        problems.append(Problem("--maps", "must be last or all", maps, code=Mistake.OPTION))
    if workers < 1:
        problems.append(
            Problem("--workers", "must be at least 1", str(workers), code=Mistake.RANGE)
        )
    if problems:
        raise InvalidValue(*problems)


def _write(out: Path, result: ExplicitResult) -> None:
    from ...quantities.files import write_text
    from ...views.plot import explicit

    TableFiles(csv=out / "states.csv").write(result.columns, result.units)
    result.state.to_netcdf(out / "maps.nc")
    write_text(
        out / "explicit.json", json.dumps(plain_data(result.data), indent=1, allow_nan=False) + "\n"
    )
    for name in ("states.csv", "maps.nc", "explicit.json"):
        tell_written(out / name)
    write_figure(out / "explicit.png", explicit(result.state))


def _show(data: dict[str, Any], heading: str) -> None:
    """The table against the statistical model, the seat, one sentence."""
    console = terminal()
    many = data["surfaces"] > 1
    source = f"{data['surfaces']} synthetic surfaces" if data["source"] == "synthetic" else (
        data["source"]
    )  # fmt: skip
    console.print(f"{heading} (thirdbody {data['version']})")
    if data.get("summary"):
        console.print(data["summary"])
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
                cells.append("-" if away is None else f"{signed_number(away, 1)} errors")
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


def _cell(name: str, value: float | None, error: float | None) -> str:
    if value is None:
        return "-"
    if name == "h":
        spread = f" ± {value_of(error, 'm', 2)}" if error else ""
        return value_of(value, "m") + spread
    return percent(value, error or 0.0)
