"""A study with every particle at its place: one measured surface, or many synthetic ones."""

from __future__ import annotations

import hashlib
import math
import os
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..contact.citations import cite
from ..contact.contact import Contact
from ..equilibrium.solve import solve as statistical
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, note_of, tell_of_range
from ..explicit.blocks import BLOCKS
from ..explicit.ensemble import (
    COMPARED,
    Ensemble,
    counterpart,
    ensemble,
    seats_on,
    spacing_for,
    surface_of,
)
from ..explicit.solve import Maps, solve
from ..explicit.state import COLUMNS, ExplicitState
from ..quantities.plain_data import plain_data
from ..quantities.progress import Stages, stages
from ..quantities.run_files import MARK, claim_folder, read_json
from ..version import __version__
from .whole import Study

__all__ = ["ExplicitResult", "claim_results", "run_explicit"]

SURFACES, SIZE = 8, 512


@dataclass(frozen=True, eq=False, kw_only=True)
class ExplicitResult:
    """What a study with explicit surfaces gives.

    Attributes
    ----------
    data : dict
        Title, version, inputs (SI), the comparison with the statistical model, warnings,
        citations: plain data ready for JSON.
    columns, units : dict
        One row a state: surface, load, shares, certificate.
    state : ExplicitState
        The measured surface, or the first synthetic one, under the loads of the study.
    converged : bool
        Whether every state is as exact as asked.
    """

    data: dict[str, Any]
    columns: dict[str, list[object]]
    units: dict[str, str]
    state: ExplicitState
    converged: bool


def run_explicit(
    study: Study,
    *,
    folder: Path | None = None,
    maps: Maps = "last",
    workers: int = 1,
    scheduler: str | None = None,
    progress: bool | Callable[[int], None] = False,
) -> ExplicitResult:
    """The loads of a study on explicit surfaces.

    Parameters
    ----------
    study : Study
        Its [explicit] table says how; a surface of [roughness] that was measured is pressed
        itself, else surfaces are made with the σ, R and α of the study.
    folder : Path, optional
        Where finished synthetic surfaces are kept.
    maps : {"last", "all"}, optional
    workers : int, optional
        Threads that press a synthetic surface each; of the FFTs of a measured one.
    scheduler : str, optional
        Address of a Dask cluster whose workers press the synthetic surfaces instead.
    progress : bool or callable, optional
        True shows on standard error what is pressed, and what it costs once that is known; a
        callable gets the number of surfaces.

    Returns
    -------
    ExplicitResult

    Raises
    ------
    InvalidValue
        The study gives separations instead of loads, its surfaces cannot be made or pressed, or
        no scheduler answers.
    """
    if study.load == "separation":
        raise InvalidValue(
            "load.separation counts from a plane that a map has not; give load.pressure or F_star",
            code=Mistake.BEYOND,
        )
    if scheduler is not None and len(study.faces) == 1:
        raise InvalidValue(
            Problem(
                "scheduler",
                ": roughness.topography gives one surface, which is not shared",
                repr(scheduler),
                hint="leave the scheduler out",
                code=Mistake.BEYOND,
            )
        )
    contact = study.contact.replace(outputs=())
    loads = np.sort(study.values) / (contact.E_ss if study.load == "pressure" else 1.0)
    options = dict(study.explicit or {})
    size = options.pop("size", SIZE)
    count, spacing = options.pop("surfaces", SURFACES), options.pop("spacing", None)
    notes = list(study.notes)
    one_face = len(study.faces) == 1
    with (
        stages("explicit", 1 if one_face else 2, progress is True) as parts,
        warnings.catch_warnings(record=True) as heard,
    ):
        warnings.simplefilter("always", RangeWarning)
        parts("surface" if one_face else "surfaces")
        if one_face:
            made = _run_measured(study, contact, loads, options, maps, workers, parts)
        else:
            if study.faces:
                notes.append(
                    "roughness.topography has two faces, and nothing says which place of one "
                    "meets which of the other: random surfaces with their moments are pressed"
                )
            spacing = spacing_for(contact) if spacing is None else spacing
            results = ensemble(
                contact, surfaces=count, F_star=loads, size=size, spacing=spacing,
                folder=folder, workers=workers, scheduler=scheduler,
                progress=progress if callable(progress) else parts, **options,
            )  # fmt: skip
            parts("maps of the first surface")
            first = surface_of(contact, size=size, spacing=spacing, seed=options.get("seed", 0))
            state = solve(contact, first, F_star=loads, maps=maps, progress=parts, **options)
            made = _of_ensemble(results, state)
    about = [warning for warning in heard if issubclass(warning.category, RangeWarning)]
    for warning in heard:
        if warning not in about:  # about the folder, not the answer
            tell_of_range(warning.message, warning.category)
    sentences = [
        *notes,
        *made.data.pop("warnings"),
        *(note_of(warning.message) for warning in about),
    ]
    data = {
        "title": study.title,
        "version": __version__,
        "inputs": contact.to_dict(),
        **made.data,
        "warnings": list(dict.fromkeys(sentences)),
        "citations": cite(contact),
    }
    return ExplicitResult(
        data=data, columns=made.columns, units=made.units, state=made.state,
        converged=made.converged,
    )  # fmt: skip


FILES = re.compile(r"states\.csv|maps\.nc|explicit\.(?:json|png)|surfaces")
"""What ``thirdbody explicit --out`` writes."""
SURFACE = re.compile(r"surface_\d{3,}\.json|\.surface_\d{3,}\.[0-9a-f-]+\.part\.json")


def claim_results(out: str | os.PathLike[str], study: Study, *, maps: str = "last") -> Path:
    """A folder for what a study with explicit surfaces gives, of this study alone.

    Parameters
    ----------
    out : path-like
        A new folder, an empty one, or one of the same study, which may have had fewer surfaces.
    study : Study
    maps : {"last", "all"}, optional

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InvalidValue
        It holds another study or anything else, or cannot be made.
    """
    contact = study.contact.replace(outputs=())
    options = dict(study.explicit or {})
    loads = np.sort(study.values)
    description = {
        "command": "explicit",
        "version": __version__,
        "inputs": contact.to_dict(),
        "load": study.load,
        "F_star": (loads / (contact.E_ss if study.load == "pressure" else 1.0)).tolist(),
        "surfaces": options.pop("surfaces", SURFACES) if len(study.faces) != 1 else 1,
        "explicit": plain_data(dict(sorted(options.items()))),
        "maps": maps,
        "topography": [
            hashlib.sha256(np.ascontiguousarray(face.heights).tobytes()).hexdigest()
            for face in study.faces
        ],
    }
    return claim_folder(
        out, description, files=FILES, unmarked=_unmarked_study, growing=("surfaces",)
    )


def _unmarked_study(folder: Path) -> dict[str, object] | None:
    """Study whose results lie in a folder without a mark, as read from these."""
    results = read_json(folder / "explicit.json")
    if results is not None and {"version", "inputs", "table"} <= set(results):
        description = {name: results.get(name) for name in ("version", "inputs", "surfaces")}
        return description | {"F_star": results["table"].get("F_star")}
    # surfaces say themselves what they were made for
    names = [file.name for file in folder.iterdir() if file.name != MARK]
    kept = folder / "surfaces"
    only_surfaces = names == [kept.name] and kept.is_dir()
    return (
        {}
        if only_surfaces and all(SURFACE.fullmatch(file.name) for file in kept.iterdir())
        else None
    )


def _run_measured(
    study: Study,
    contact: Contact,
    loads: np.ndarray,
    options: dict[str, Any],
    maps: Maps,
    workers: int,
    parts: Stages,
) -> ExplicitResult:
    """Results of one measured map, beside the model with the seats of this map."""
    (face,) = study.faces
    how: dict[str, Any] = {"maps": maps, "workers": workers, "blocks": BLOCKS, "progress": parts}
    state = solve(contact, face, F_star=loads, **how, **options)
    rule = {name: options[name] for name in ("seats", "seed") if name in options}
    seats = seats_on(contact, face, **rule)
    if not math.isfinite(seats.mean):  # places that are told
        seats = state.seats
    model = counterpart(contact, seats)
    beside = statistical(model, F_star=loads)
    table: dict[str, list[float | None]] = {"F_star": loads.tolist()}
    for name in COMPARED:
        table[f"{name}_raw"] = plain_data(np.atleast_1d(getattr(state, name)))
        table[f"{name}_raw_error"] = plain_data(np.atleast_1d(state.errors[name]))
        table[f"{name}_statistical"] = plain_data(np.atleast_1d(getattr(beside, name)))
    columns = {name: values.tolist() for name, values in state.columns().items()}
    data = {
        "surfaces": 1,
        "source": face.source,
        "left_out": int(np.sum(~np.atleast_1d(state.converged))),
        "seats": seats._asdict(),
        "table": table,
        "warnings": list(state.warnings),
    }
    return ExplicitResult(
        data=data, columns={"surface": [0] * len(loads)} | columns, units=_units(),
        state=state, converged=data["left_out"] == 0,
    )  # fmt: skip


def _of_ensemble(results: Ensemble, state: ExplicitState) -> ExplicitResult:
    plain = results.to_dict()
    data = {
        name: plain[name]
        for name in ("surfaces", "left_out", "seats", "table", "at_h", "summary", "warnings")
    }
    data["source"] = "synthetic"
    return ExplicitResult(
        data=data, columns=results.states, units=_units(), state=state,
        converged=results.left_out == 0 and bool(np.all(state.converged)),
    )  # fmt: skip


def _units() -> dict[str, str]:
    return {"surface": ""} | {name: column.unit for name, column in COLUMNS.items()}
