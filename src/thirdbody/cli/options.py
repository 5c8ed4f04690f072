"""The arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .streams import warn

if TYPE_CHECKING:
    from ..study import Study

__all__ = [
    "AsJson",
    "ParquetFile",
    "Settings",
    "StudyFile",
    "XlsxFile",
    "not_a_folder",
    "read_study",
]

StudyFile = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
XlsxFile = Annotated[
    Path | None,
    typer.Option("--xlsx", metavar="FILE", help="The same as a workbook (needs openpyxl)."),
]
ParquetFile = Annotated[
    Path | None,
    typer.Option("--parquet", metavar="FILE", help="The same as Parquet (needs pyarrow)."),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help='Change a key of the file, e.g. particles.mean="500 nm"; may be repeated.',
    ),
]


def read_study(file: Path, settings: list[str] | None) -> Study:
    """The study with the keys set by --set; what looks like a slip is told at once."""
    from ..study import load_study

    asked = load_study(file, settings or ())
    for sentence in asked.notes:
        warn(sentence)
    return asked


def not_a_folder(out: Path | None) -> list[str]:
    """Why files cannot be written into this folder."""
    if out is not None and out.exists() and not out.is_dir():
        return [f"--out {out} must be a folder, and a file of that name exists"]
    return []
