"""``thirdbody compare``: one interface under every asperity law."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from ...equilibrium.words import load_of
from ...errors import InvalidValue, NoEquilibrium
from ...quantities.say import number, percent, signed, value_of
from ...quantities.tables import Table
from ..options import Settings, StudyFile, not_a_folder, read_study
from ..show import terminal
from ..streams import warn

__all__ = ["command"]

MEANS = {
    "A_t": "real contact area over the nominal area, no unit",
    "diff. of A_t": "against the law of the study",
    "F/A_t": "mean real pressure",
    "d/sigma": "separation over the RMS roughness, no unit",
    "diff. of d/sigma": "against the law of the study",
    "plastic": "as elastic and el.-plastic, that part of the real area",
    "particles' load": "their part of the load",
}
"""What the heads mean."""
DROP = ("elastic", "el.-plastic", "diff. of d/sigma", "F/A_t", "particles' load")
"""Columns in the order in which they go where the width is small."""
PLACES = ("start", "middle", "end")


def command(
    study: StudyFile,
    names: Annotated[
        str | None,
        typer.Option(
            "--laws",
            metavar="NAMES",
            help='Asperity laws, e.g. ke,jg, or "all"; without it all but adhesive and elliptic.',
        ),
    ] = None,
    at: Annotated[
        str, typer.Option("--at", help=f"Which load the table shows: {', '.join(PLACES)}.")
    ] = "middle",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for compare.csv, .png and .svg."),
    ] = None,
    settings: Settings = None,
) -> None:
    """The interface of a study under every asperity law, against the law the study names."""
    from ...analysis.compare import compare as compare_laws
    from ...laws import asperity
    from ...views.comparison import save

    problems = []
    if at not in PLACES:
        problems.append(f"--at {at} must be one of {', '.join(PLACES)}")
    problems += not_a_folder(out)
    if problems:
        raise InvalidValue(*problems)
    asked = read_study(study, settings)
    words: list[str] | None = None
    if names is not None:
        words = [word.strip() for word in names.split(",") if word.strip()]
        words = list(asperity.REGISTRY) if words == ["all"] else words
    load: dict[str, Any] = {asked.load: asked.values}
    if asked.load == "separation":
        load = {"F_star": _loads_at(asked)}
        warn(
            f"laws are compared at equal loads: those of {asked.contact.asperity_law.name} at the "
            "separations of the study"
        )
    table = compare_laws(asked.contact, **load, laws=words)
    for sentence in filter(None, table.attrs["warnings"].splitlines()):
        warn(sentence)
    reasons = table.status.values
    if not (reasons == "ok").any():
        raise NoEquilibrium(f"{reasons[0, 0]} (and so under every law)")
    order = table.F_star.values.argsort()
    index = int(order[{"start": 0, "middle": len(order) // 2, "end": -1}[at]])
    # the files first: a table on the screen says that all is done
    written = save(table, out, at=index) if out is not None else []
    _show_comparison(asked.title, table, index)
    for path in written:
        print(f"written: {path}", file=sys.stderr)


def _loads_at(asked: Any) -> Any:
    """The loads F* of a study that gives separations."""
    import numpy as np

    loads = np.asarray(asked.solve().F_star)
    loads = loads[np.isfinite(loads) & (loads > 0)]
    if not len(loads):
        raise NoEquilibrium("no load at the separations of the study, so there is none to compare")
    return loads


def _show_comparison(title: str, table: Any, index: int) -> None:
    """One row a law, at one load; what is to be said of a law stands below, numbered."""
    console = terminal()
    one = table.isel({table.A_t.dims[1]: index})
    particles = "particle_load_share" in one
    own = table.attrs["own_law"]
    load = load_of(float(one.pressure), float(one.F_star))
    console.print(f"{title or 'Study'}: every law at {load}, differences against {own}")

    def cells(row: Any, note: str) -> list[str]:
        if row.status.item() != "ok":
            return [row.law.item(), *["-"] * (9 if particles else 8), note]
        value = {str(name): row[name].values.item() for name in row.data_vars}
        first = row.law.item() == own
        out = [
            row.law.item(),
            number(value["A_t"]),
            "" if first else signed(value["A_t_difference"], 1, "%"),
            value_of(value["mean_pressure"], "Pa"),
            number(value["d_star"]),
            "" if first else signed(value["d_star_difference"], 3),
        ]
        shares = ["elastic_share", "elastoplastic_share", "plastic_share"]
        shares += ["particle_load_share"] if particles else []
        return [*out, *(percent(value[name]) for name in shares), note]

    heads = ["law", "A_t", "diff. of A_t", "F/A_t", "d/sigma", "diff. of d/sigma"]
    heads += ["elastic", "el.-plastic"]
    heads += ["plastic", "particles' load"] if particles else ["plastic"]
    more = "--out DIR writes all"
    shown = Table([*heads, "note"], right=True, words=["law"], drop=DROP, more=more, legend=MEANS)
    notes: list[str] = []
    for i in range(one.sizes["law"]):
        row = one.isel(law=i)
        if text := row.note.item():
            notes.append(f"{len(notes) + 1} {row.law.item()}: {text}")
        shown.add_row(*cells(row, str(len(notes)) if text else ""))
    console.print(shown)
    for note in notes:
        console.print(note)
