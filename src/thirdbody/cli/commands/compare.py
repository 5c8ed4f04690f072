"""``thirdbody compare``: one interface under every asperity law."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...equilibrium.words import load_of
from ...errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ...quantities.progress import heartbeat
from ...quantities.say import number, percent, signed_number, value_of
from ...quantities.tables import Table
from ..options import (
    Force,
    JsonFile,
    ParquetFile,
    Settings,
    StudyFile,
    XlsxFile,
    not_a_folder,
    option,
    read_study,
)
from ..show import ALL, terminal
from ..streams import STDOUT, TableFiles, tell_written, warn, warn_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from ...analysis.compare import Comparison
    from ...equilibrium.load import ForceLoad
    from ...study import Study
    from ...views.workbook import Sheet

__all__ = ["command"]

MEANS = {
    "A_t": "real contact area over the nominal area, no unit",
    "diff. of A_t": "against the law of the study",
    "F/A_t": "mean real pressure",
    "d/sigma": "separation d over the RMS roughness, no unit",
    "diff. of d/sigma": "against the law of the study",
    "plastic": "as elastic and el.-plastic, that part of the real area",
    "particles' load": "their part of the load",
}
"""What the heads mean."""
DROP = ("elastic", "el.-plastic", "diff. of d/sigma", "F/A_t", "particles' load")
"""Columns in the order in which they go where the width is small."""
PLACES = ("start", "middle", "end")


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    study: StudyFile
    names: str | None = option(
        "--laws",
        'Asperity laws, e.g. ke,jg, or "all"; without it all but adhesive and elliptic, and for '
        "two bodies persson, the elastic area after Persson, which is no law of a study.",
        "NAMES",
    )
    at: str = option(
        "--at",
        f"Which load of the study the table shows: {', '.join(PLACES)}.",
        "PLACE",
        default="middle",
    )
    json: JsonFile = None
    out: Path | None = option("--out", "Write compare.csv, .png and .svg into a folder.", "DIR")
    csv: Path | None = option(
        "--csv", "Write a table, one row per law and load, e.g. a.csv.", "FILE"
    )
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    settings: Settings = None


def command(options: Options) -> None:
    """A study under every asperity law, beside its own."""
    from ...analysis.compare import Persson, comparison_of
    from ..own_files import refuse_strangers

    problems: list[str] = []
    if options.at not in PLACES:
        problems.append(
            Problem("--at", f"must be one of {', '.join(PLACES)}", options.at, code=Mistake.OPTION)
        )
    problems += not_a_folder(options.out)
    if problems:
        raise InvalidValue(*problems)
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    writes = [*files.paths, *_of_folder(options.out)]
    study = read_study(options.study, options.settings, writes=writes)
    files.need(force=options.force)
    if not options.force:
        refuse_strangers(options.out, "compare.csv", "compare.png", "compare.svg")
    with heartbeat("compare"):
        comparison = comparison_of(study.contact, **_equal_loads(study), laws=_words(options.names))
    warn_of(filter(None, comparison.attrs["warnings"].splitlines()))
    reasons = comparison.columns["status"]
    of_laws = [law != Persson.name for law in comparison.laws]
    if not (reasons[of_laws] == "ok").any():
        raise NoEquilibrium(f"{reasons[0, 0]} (and so under every law)")
    order = comparison.loads["F_star"].argsort()
    index = int(order[{"start": 0, "middle": len(order) // 2, "end": -1}[options.at]])
    # the files first: a table on the screen says that all is done
    written: list[Path] = []
    if options.out is not None:
        from ...views.comparison import save

        written = save(comparison.to_dataset(), options.out, at=index, force=options.force)
    files.write(
        *comparison.flat(),
        sheets=partial(_sheets, study, comparison, index),
        data=lambda: {"title": study.title or "Study", **comparison.to_dict()},
    )
    written += files.paths
    if options.json != STDOUT:
        _show_comparison(study.heading if study.settings else study.title, comparison, index)
    tell_written(*written)


def _of_folder(out: Path | None) -> list[Path]:
    """Names of the files that --out writes."""
    return [] if out is None else [out / f"compare.{end}" for end in ("csv", "png", "svg")]


def _words(names: str | None) -> list[str] | None:
    """The laws of ``--laws``."""
    from ...laws import asperity

    if names is None:
        return None
    words = [word.strip() for word in names.split(",") if word.strip()]
    return list(asperity.REGISTRY) if words == ["all"] else words


def _equal_loads(study: Study) -> ForceLoad[NDArray[np.float64]]:
    """The loads of a study; F* under its own law where it gives separations."""
    import numpy as np

    from ...equilibrium.load import as_force_load

    if study.load != "separation":
        return as_force_load(study.load, study.values)
    loads = np.asarray(study.solve().F_star)
    loads = loads[np.isfinite(loads) & (loads > 0)]
    if not len(loads):
        raise NoEquilibrium("no load at the separations of the study, so there is none to compare")
    warn(
        f"laws are compared at equal loads: those of {study.contact.asperity_law.name} at the "
        "separations of the study"
    )
    return {"F_star": loads}


def _sheets(study: Study, comparison: Comparison, index: int) -> list[Sheet]:
    from ...contact.evaluation import bodies_of
    from ...equilibrium.columns import COLUMNS
    from ...views.question_sheets import inputs_of, question_sheets

    heads, rows, notes = _table(comparison, index)
    numbered_notes = [f"{i + 1} {text}" for i, text in enumerate(notes)]
    title = f"{study.heading}: {_at_load(comparison, index)}"
    columns, units = comparison.flat()
    meanings = {name: COLUMNS[name].meaning for name in columns if name in COLUMNS}
    return question_sheets(
        title,
        _answer(comparison, index),
        (heads, rows),
        numbered_notes,
        states=(columns, units),
        meanings=meanings,
        inputs=inputs_of({"": study.contact}, bodies_of(study.contact)),
        warnings=[*filter(None, comparison.attrs["warnings"].splitlines())],
        citations=[*filter(None, comparison.attrs["citations"].splitlines())],
    )


def _at_load(comparison: Comparison, index: int) -> str:
    load = load_of(*(float(comparison.loads[name][index]) for name in ("pressure", "F_star")))
    return f"every law at {load}, differences against {comparison.attrs['own_law']}"


def _answer(comparison: Comparison, index: int) -> list[str]:
    """Between what the laws say of the area, and of who carries; Persson's area beside them."""
    from ...analysis.compare import Persson

    columns = {name: column[:, index] for name, column in comparison.columns.items()}
    laws = list(comparison.laws)
    of_laws = [i for i, law in enumerate(laws) if law != Persson.name]
    solved = [i for i in of_laws if columns["status"][i] == "ok"]
    if not solved:
        return []
    study_law = laws.index(comparison.attrs["own_law"])

    def ends(name: str) -> tuple[int, int]:
        by = sorted(solved, key=lambda i: float(columns[name][i]))
        return by[0], by[-1]

    low, high = ends("A_t")
    least, most = (percent(columns["A_t"][i]) for i in (low, high))
    out = (
        f"By the choice of a law the real area is between {least} ({laws[low]}) and {most} "
        f"({laws[high]}) of the nominal one"
    )
    if least == most:
        out = f"By every law the real area is {most} of the nominal one"
    elif study_law in solved:
        away = [signed_number(columns["A_t_difference"][i], 1, "%") for i in (low, high)]
        out += f", {' to '.join(away)} about {laws[study_law]}"
    if "particle_load_share" not in columns:
        return [f"{out}.", *_elastic_areas(dict(zip(laws, columns["A_t"], strict=True)))]
    shares = [percent(columns["particle_load_share"][i]) for i in ends("particle_load_share")]
    return [f"{out}.", f"Particles carry {' to '.join(dict.fromkeys(shares))} of the load."]


def _elastic_areas(areas: Mapping[str, float]) -> list[str]:
    """Persson's area, and that of the law with which to compare it: both know no yielding."""
    from ...analysis.compare import Persson

    if Persson.name not in areas:
        return []
    said = f"Without asperities and without yielding it is {percent(areas[Persson.name])} (persson)"
    if math.isfinite(elastic := areas.get("gw", math.nan)):
        said += f": to be held against {percent(elastic)} (gw), which is elastic too"
    return [f"{said}."]


def _show_comparison(title: str, comparison: Comparison, index: int) -> None:
    """One row a law, at one load; what is to be said of a law stands below, numbered."""
    console = terminal()
    console.print(f"{title or 'Study'}: {_at_load(comparison, index)}")
    for sentence in _answer(comparison, index):
        console.print(sentence)
    heads, rows, notes = _table(comparison, index)
    shown = Table(heads, right=True, words=["law"], drop=DROP, more=ALL, legend=MEANS)
    for row in rows:
        shown.add_row(*row)
    console.print(shown)
    for i, note in enumerate(notes):
        console.print(f"{i + 1} {note}")


def _table(comparison: Comparison, index: int) -> tuple[list[str], list[list[str]], list[str]]:
    """Heads, a row a law at one load, and what is to be said of laws, which rows number."""
    particles = "particle_load_share" in comparison.columns
    study_law = comparison.attrs["own_law"]

    def cells(law: str, value: dict[str, Any], note: str) -> list[str]:
        if value["status"] != "ok":
            return [law, *["-"] * (9 if particles else 8), note]
        first = law == study_law
        out = [
            law,
            number(value["A_t"]),
            "" if first else signed_number(value["A_t_difference"], 1, "%"),
            value_of(value["mean_pressure"], "Pa"),
            number(value["d_star"]),
            "" if first else signed_number(value["d_star_difference"], 3),
        ]
        shares = ["elastic_share", "elastoplastic_share", "plastic_share"]
        shares += ["particle_load_share"] if particles else []
        return [*out, *(percent(value[name]) for name in shares), note]

    heads = ["law", "A_t", "diff. of A_t", "F/A_t", "d/sigma", "diff. of d/sigma"]
    heads += ["elastic", "el.-plastic"]
    heads += ["plastic", "particles' load"] if particles else ["plastic"]
    rows, notes = [], []
    for i, (law, text) in enumerate(zip(comparison.laws, comparison.notes, strict=True)):
        if text:
            notes.append(f"{law}: {text}")
        values = {name: column[i, index].item() for name, column in comparison.columns.items()}
        rows.append(cells(law, values, str(len(notes)) if text else ""))
    return [*heads, "note"], rows, notes
