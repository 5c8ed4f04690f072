"""Sweeps on disk: block after block into a folder that survives being killed."""

from __future__ import annotations

import importlib
import math
import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ...equilibrium.columns import CODE
from ...equilibrium.status import STATUS_CODE
from ...errors import InvalidValue, Mistake, Problem, tell_of_range
from ...quantities.files import make_folder, remove_files, whole, write_text
from ...quantities.progress import Cost, Report, count_states, reporting
from ...quantities.run_files import sealed_text
from ...quantities.sharing import share_parts
from .folder import (
    STORE,
    Folder,
    Found,
    damage_words,
    name_of,
    text_of,
    unchecked_words,
)
from .plan import STORED, Arrays, Layout, Plan, all_notes
from .stores import _NetCDF, _Zarr

if TYPE_CHECKING:
    import xarray
    from distributed import Client

__all__ = ["Folder", "in_memory", "run"]

Result = tuple[Arrays, dict[str, Any]]

Format = Literal["zarr", "netcdf"]
FORMATS = {"zarr": ("zarr",), "netcdf": ("h5netcdf", "h5py")}
"""Formats and the packages they need."""


# -------------------------------------------------------------------------- in memory
def in_memory(
    plan: Plan, *, workers: int, client: Client | None, progress: bool | Report
) -> xarray.Dataset:
    """The data set of a plan, without a folder."""
    import xarray as xr

    layout, notes = plan.layout(), plan.notes()
    words = {"mode", "status"}
    if "status" in layout.variables:
        dims = layout.variables["status"][0]
        layout.variables[CODE] = (dims, STORED["status"], STATUS_CODE.attributes)
    data = {
        name: np.empty(
            [layout.sizes[dim] for dim in dims], object if name in words else _memory(name, kind)
        )
        for name, (dims, kind, _) in layout.variables.items()
    }
    summaries = []
    with reporting("sweep", plan.states, 0, progress) as report:
        done, cost = 0, Cost(plan.states, report, early=not callable(progress))
        rows: dict[int, Arrays] = {}
        results = partial(_results, plan, cost, coded=False, workers=workers, client=client)
        for number, (arrays, summary) in results(range(plan.count)):
            summaries.append(summary)
            if plan.reduction is None:
                _write_block(data, layout, plan, number, arrays)
            else:
                rows[number] = arrays
            done += summary["states"]
            cost.report_finished(done)
    if plan.reduction is not None:
        for row in range(plan.count // _parts(plan)):
            numbers = range(row * _parts(plan), (row + 1) * _parts(plan))
            kept = plan.reduce_parts(numbers[0], (rows.pop(number) for number in numbers))
            _write_block(data, layout, plan, numbers[0], kept)
    words &= set(data)
    data |= {name: data[name].astype(str) for name in words}
    flags = ("flag_values", "flag_meanings")
    variables = {
        name: (
            dims,
            data[name],
            {key: value for key, value in attrs.items() if name not in words or key not in flags},
        )
        for name, (dims, _, attrs) in layout.variables.items()
    }
    inputs = {name: variables.pop(name) for name in layout.inputs}
    attrs = layout.attrs | _attributes(plan, notes, _summary(summaries))
    return xr.Dataset(variables, coords=layout.coords | inputs, attrs=attrs)


def _memory(name: str, kind: str) -> object:
    return np.int64 if name == "iterations" else np.dtype(kind)


def _write_block(data: Arrays, layout: Layout, plan: Plan, number: int, arrays: Arrays) -> None:
    where = _where(plan, number)
    for name, values in arrays.items():
        data[name][tuple(where.get(dim, slice(None)) for dim in layout.variables[name][0])] = values


def _where(plan: Plan, number: int) -> dict[str, slice]:
    """Slices of a block, by dimension."""
    return {dim.name: s for dim, s in zip(plan.dims, plan.region(number), strict=True)}


def _parts(plan: Plan) -> int:
    """Blocks that a cell is cut into."""
    return math.prod(plan.grid[plan.outer :])


def _summary(summaries: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    out: dict[str, object] = {"states": 0, "unsolved": 0, "A_t": 0.0, "shadow": 0.0}
    paths: Counter[str] = Counter()
    for one in summaries:
        out["states"] += one["states"]
        out["unsolved"] += one["unsolved"]
        out["A_t"] = max(out["A_t"], one["A_t"])
        out["shadow"] = max(out["shadow"], one["shadow"])
        paths.update(one.get("engine", {}))
    return out | {"engine": dict(sorted(paths.items()))}


def _attributes(plan: Plan, notes: list[str], summary: Mapping[str, Any]) -> dict[str, str]:
    """Attributes of a run, one line each."""
    paths = (f"{word} ({count} states)" for word, count in summary["engine"].items())
    return {"warnings": "\n".join(all_notes(plan, notes, summary)), "engine": "\n".join(paths)}


# -------------------------------------------------------------------------- who solves
def _results(
    plan: Plan,
    cost: Cost,
    numbers: Iterable[int],
    *,
    coded: bool,
    workers: int,
    client: Client | None,
) -> Iterator[tuple[int, Result]]:
    """Every block's result, in the order in which they come."""

    def work(number: int) -> Callable[[], Result]:
        task = plan.task(number, coded=coded)
        return task if client is not None else partial(count_states, task, cost)

    tasks = ((number, work(number)) for number in numbers)
    return share_parts(tasks, workers=workers, client=client)


# -------------------------------------------------------------------------- on disk
def run(
    plan: Plan,
    out: str | os.PathLike[str],
    *,
    format: str = "zarr",
    workers: int = 1,
    client: Client | None = None,
    progress: bool | Report = False,
) -> Folder:
    """Carry out what is left of a plan in a folder.

    Parameters
    ----------
    plan : Plan
    out : path-like
        The folder; it is made when it does not exist.
    format : {"zarr", "netcdf"}
    workers, client, progress
        As in `sweep`.

    Returns
    -------
    Folder
        The finished folder.

    Raises
    ------
    InvalidValue
        A package is missing, the folder is in use, or it holds something else.
    """
    if format not in FORMATS:
        raise InvalidValue(
            Problem(
                "format",
                f"must be one of {', '.join(map(repr, FORMATS))}",
                repr(format),
                code=Mistake.OPTION,
            )
        )
    _require_packages(format)
    folder = Folder(Path(out), format, tuple(plan.layout().variables))
    study = {**plan.to_dict(), "format": format}
    folder.refuse_others(study)
    shown = progress is True
    if folder.finished_summary is not None:
        findings = folder.look(name_of(study), shown)
        if not findings.problems and folder.says(study):
            folder.remove_parts()  # of a run killed at the very end
            _warn(unchecked_words(folder.path, findings))
            if shown:
                print(f"{folder.path} is finished: nothing to do", file=sys.stderr)
            return folder
        if not os.access(folder.path, os.W_OK):
            raise InvalidValue(
                f"{damage_words(folder.path, findings)}; but it cannot be written",
                code=Mistake.UNWRITABLE,
            )
    notes = plan.notes()  # refuses inputs before anything is written
    make_folder(folder.path)
    with folder.lock_folder():
        folder.refuse_others(study)
        results = partial(_results, plan, coded=True, workers=workers, client=client)
        _carry_out(plan, folder, study, notes, results, progress)
    return folder


def _warn(sentence: str) -> None:
    """What happened to a folder, to whoever called `sweep`."""
    if sentence:
        tell_of_range(sentence, UserWarning)


def _require_packages(format: str) -> None:
    for name in FORMATS[format]:
        try:
            module = importlib.import_module(name)
        except ImportError:
            raise InvalidValue(
                Problem(
                    "format",
                    f"needs the package {name}: pip install 'thirdbody[sweep]'",
                    repr(format),
                    code=Mistake.ABSENT,
                )
            ) from None
        if name == "zarr" and int(module.__version__.split(".")[0]) < 3:
            rule = f"needs zarr 3 and finds {module.__version__}: pip install 'thirdbody[sweep]'"
            raise InvalidValue(Problem("format", rule, repr(format), code=Mistake.ABSENT))


def _carry_out(
    plan: Plan,
    folder: Folder,
    study: Mapping[str, object],
    notes: list[str],
    results: Callable[[Cost, Iterable[int]], Iterator[tuple[int, Result]]],
    progress: bool | Report,
) -> None:
    """Solve the blocks that are missing; the folder is locked."""
    path, name = folder.path, name_of(study)
    folder.remove_drafts()
    if not folder.says(study):
        write_text(path / "study.json", text_of(study))
    (path / "done").mkdir(exist_ok=True)
    layout = plan.layout()
    # blocks of a state sweep go straight to their place in a Zarr store
    direct = folder.format == "zarr" and plan.reduction is None
    if direct and not folder.data.exists():
        _make_store(plan, folder, layout, name)
    findings = folder.look(name, progress is True)
    done = {number: one for number, one in findings.blocks.items() if number < plan.count}
    intact = findings.recorded and not findings.shared  # the data that were put together
    if findings.problems or len(done) < plan.count:
        (path / "finished.json").unlink(missing_ok=True)
    if direct:
        store = _mend_store(plan, folder, layout, name, findings)
    elif not (intact and len(done) == plan.count):
        (path / "parts").mkdir(exist_ok=True)
        done = {n: one for n, one in done.items() if folder.part_file(n).exists()}
    _warn(damage_words(path, findings))
    _warn(unchecked_words(path, findings))
    states = _summary(done.values())["states"]
    more = len(done) < plan.count
    left = (number for number in range(plan.count) if number not in done)
    with reporting(str(path), plan.states, states, progress) as report:
        cost = Cost(plan.states, report, done=states, early=not callable(progress))
        for number, (arrays, summary) in results(cost, left):
            if direct:
                files = store.write(_where(plan, number), arrays, durable=True)
            else:
                files = [folder.part_file(number)]
                _save_part(files[0], arrays)
            folder.mark(number, name, summary, files)
            done[number] = summary
            states += summary["states"]
            cost.report_finished(states)
    total = _summary(done.values())
    attrs: dict[str, object] = dict(_attributes(plan, notes, total))
    if direct:
        store.label(attrs)
        folder.relabel(name)
    elif more or not intact:
        _assemble(plan, folder, layout, attrs)
        folder.record(name, plan.count)
    write_text(path / "finished.json", sealed_text({"study": name, **total}))
    folder.remove_parts()


def _make_store(plan: Plan, folder: Folder, layout: Layout, name: str) -> None:
    """An empty store in its place, and none of the markers of one that is gone."""
    folder.remove_markers()
    (folder.path / "done").mkdir()
    draft = folder.path / ".states.part.zarr"
    _Zarr.create(draft, layout)
    folder.record(name, plan.count, draft)
    draft.rename(folder.data)


def _mend_store(plan: Plan, folder: Folder, layout: Layout, name: str, findings: Found) -> _Zarr:
    """The store with what belongs to no block as it was made."""
    if findings.shared or findings.unlabelled or not findings.recorded:
        draft = folder.path / ".states.part.zarr"
        _Zarr.create(draft, layout)
        folder.restore(draft, name, plan.count)
        folder.remove_drafts()
    return folder.whole(lambda: _Zarr(folder.data, layout))


def _save_part(path: Path, arrays: Arrays) -> None:
    with whole(path, tidy=False) as draft, draft.open("wb") as file:
        np.savez(file, **arrays)  # type: ignore[arg-type]


def _assemble(plan: Plan, folder: Folder, layout: Layout, attrs: dict[str, object]) -> None:
    """The parts put together, whole or not at all."""
    draft = folder.path / f".states.part{folder.data.suffix}"
    kind = _Zarr if folder.format == "zarr" else _NetCDF
    store = kind.create(draft, layout)
    step = 1 if plan.reduction is None else _parts(plan)
    for first in range(0, plan.count, step):
        parts = (_load_part(folder.part_file(number)) for number in range(first, first + step))
        arrays = next(parts) if plan.reduction is None else plan.reduce_parts(first, parts)
        store.write(_where(plan, first), arrays)
    store.label(attrs)
    store.close()
    if folder.data.is_dir():
        remove_files(folder.data, STORE)
    draft.replace(folder.data)


def _load_part(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as file:
        return dict(file)
