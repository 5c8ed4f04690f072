"""Sweeps on disk: block after block into a folder that survives being killed.

The folder holds

- ``study.json``: what is swept, written first; another study is refused;
- ``states.zarr`` or ``states.nc``: the data;
- ``done/N.json``: a marker for each block, written by rename after its data are on the disk;
- ``parts/N.npz``: blocks that are put together at the end (NetCDF, reductions);
- ``finished.json``: the summary, written last;
- ``lock``: held by the operating system while a run writes, so that a killed run leaves no lock.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import shutil
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ...contact.contact import Contact
from ...errors import InvalidValue
from ...quantities.files import write_text
from ...quantities.progress import Cost, Report, reporting, solving
from ...quantities.sharing import shared
from .plan import Arrays, Layout, Plan, all_notes
from .reduction import Reduction
from .stores import _NetCDF, _Zarr

if TYPE_CHECKING:
    import xarray
    from distributed import Client

__all__ = ["Folder", "in_memory", "run"]

Result = tuple[Arrays, dict[str, Any]]
Read = TypeVar("Read")

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
    data = {
        name: np.empty(
            [layout.sizes[dim] for dim in dims], object if name in words else _memory(name, kind)
        )
        for name, (dims, kind, _) in layout.variables.items()
    }
    summaries = []
    with reporting("sweep", plan.states, 0, progress) as report:
        done, cost = 0, Cost(plan.states, report)
        rows: dict[int, Arrays] = {}
        results = partial(_results, plan, cost, coded=False, workers=workers, client=client)
        for number, (arrays, summary) in results(range(plan.count)):
            summaries.append(summary)
            if plan.reduction is None:
                _into(data, layout, plan, number, arrays)
            else:
                rows[number] = arrays
            done += summary["states"]
            cost.finished(done)
    if plan.reduction is not None:
        for row in range(plan.count // _parts(plan)):
            numbers = range(row * _parts(plan), (row + 1) * _parts(plan))
            kept = _reduced(plan.reduction, (rows.pop(number) for number in numbers))
            _into(data, layout, plan, numbers[0], kept)
    words &= set(data)
    data |= {name: data[name].astype(str) for name in words}
    flags = ("flag_values", "flag_meanings")
    variables = {
        name: (
            dims,
            data[name],
            {key: value for key, value in attrs.items() if key not in flags},
        )
        for name, (dims, _, attrs) in layout.variables.items()
    }
    inputs = {name: variables.pop(name) for name in layout.inputs}
    attrs = layout.attrs | _attributes(plan.contact, notes, _summary(summaries))
    return xr.Dataset(variables, coords=layout.coords | inputs, attrs=attrs)


def _memory(name: str, kind: str) -> Any:
    return np.int64 if name == "iterations" else np.dtype(kind)


def _into(data: Arrays, layout: Layout, plan: Plan, number: int, arrays: Arrays) -> None:
    where = _where(plan, number)
    for name, values in arrays.items():
        data[name][tuple(where.get(dim, slice(None)) for dim in layout.variables[name][0])] = values


def _where(plan: Plan, number: int) -> dict[str, slice]:
    """Where a block lies, by dimension."""
    return {dim.name: s for dim, s in zip(plan.dims, plan.region(number), strict=True)}


def _parts(plan: Plan) -> int:
    """Blocks that a cell is cut into."""
    return math.prod(plan.grid[plan.outer :])


def _reduced(reduction: Reduction, parts: Iterable[Arrays]) -> Arrays:
    return reduction.result(reduction.merged(list(parts)))


def _summary(summaries: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    out: dict[str, Any] = {"states": 0, "unsolved": 0, "A_t": 0.0, "shadow": 0.0}
    paths: Counter[str] = Counter()
    for one in summaries:
        out["states"] += one["states"]
        out["unsolved"] += one["unsolved"]
        out["A_t"] = max(out["A_t"], one["A_t"])
        out["shadow"] = max(out["shadow"], one["shadow"])
        paths.update(one.get("engine", {}))
    return out | {"engine": dict(sorted(paths.items()))}


def _attributes(contact: Contact, notes: list[str], summary: Mapping[str, Any]) -> dict[str, str]:
    """What a run says of itself, a line each."""
    paths = (f"{word} ({count} states)" for word, count in summary["engine"].items())
    return {"warnings": "\n".join(all_notes(contact, notes, summary)), "engine": "\n".join(paths)}


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
        return task if client is not None else partial(_told, task, cost)

    tasks = ((number, work(number)) for number in numbers)
    return shared(tasks, workers=workers, client=client)


def _told(task: Callable[[], Result], cost: Cost) -> Result:
    """A block whose states are told while they are solved, in whatever thread."""
    with solving(cost):
        return task()


# -------------------------------------------------------------------------- the folder
@dataclass(frozen=True, eq=False)
class Folder:
    """A folder with a sweep, finished or not."""

    path: Path
    format: str
    names: tuple[str, ...]
    """Its variables, in order."""

    @property
    def data(self) -> Path:
        """Where the data are."""
        return self.path / ("states.zarr" if self.format == "zarr" else "states.nc")

    @property
    def finished(self) -> dict[str, Any] | None:
        """The summary of a finished run: states, and how many of them are unsolved."""
        found = _json(self.path / "finished.json")
        return found if found and self.data.exists() else None

    def whole(self, read: Callable[[], Read]) -> Read:
        """What reads the data; InvalidValue where something has damaged them."""
        try:
            return read()
        except PermissionError:
            raise
        except (OSError, ValueError, KeyError) as error:
            why = (str(error) or type(error).__name__).splitlines()[0]
            raise InvalidValue(
                f"{self.data} is damaged ({why}); remove it, and the same command makes it again"
            ) from None

    def open(self) -> xarray.Dataset:
        """The data, loaded when they are used."""
        return self.whole(self._open)

    def _open(self) -> xarray.Dataset:
        import xarray as xr

        if self.format == "zarr":
            data = xr.open_zarr(self.data, chunks=None, consolidated=False)
        else:
            data = xr.open_dataset(self.data, engine="h5netcdf")
        texts = {name: x for name, x in data.coords.items() if x.dtype.kind in "OT"}
        words = {name: np.asarray(x.values, object).astype(str) for name, x in texts.items()}
        data = data.assign_coords({name: (texts[name].dims, words[name]) for name in words})
        inputs = [name for name in self.names if name in data.coords]
        return data[[name for name in self.names if name not in inputs]]

    # ------------------------------------------------------------------ markers
    def marker(self, number: int) -> Path:
        return self.path / "done" / f"{number}.json"

    def part(self, number: int) -> Path:
        return self.path / "parts" / f"{number}.npz"

    def done(self, study: str) -> dict[int, dict[str, Any]]:
        """Blocks whose data are complete, with their summaries."""
        out = {}
        for path in (self.path / "done").glob("*.json"):
            found = _json(path) if path.stem.isdecimal() else None
            if found and found.get("study") == study and {"states", "unsolved"} <= set(found):
                out[int(path.stem)] = found
        return out


def _json(path: Path) -> dict[str, Any] | None:
    """What a small file says; None when it is missing or broken."""
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


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
        raise InvalidValue(f"format = {format!r} must be one of {', '.join(map(repr, FORMATS))}")
    _needed(format)
    folder = Folder(Path(out), format, tuple(plan.layout().variables))
    study = {**plan.to_dict(), "format": format}
    _check(folder, study)
    if folder.finished is not None:
        shutil.rmtree(folder.path / "parts", ignore_errors=True)  # of a run killed at the very end
        if progress is True:
            print(f"{folder.path} is finished: nothing to do", file=sys.stderr)
        return folder
    notes = plan.notes()  # refuses inputs before anything is written
    try:
        folder.path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidValue(f"cannot make the folder {folder.path}: {error.strerror}") from None
    with _locked(folder.path):
        _check(folder, study)
        if folder.finished is None:
            results = partial(_results, plan, coded=True, workers=workers, client=client)
            _carry_out(plan, folder, study, notes, results, progress)
    return folder


def _needed(format: str) -> None:
    for name in FORMATS[format]:
        try:
            module = importlib.import_module(name)
        except ImportError:
            raise InvalidValue(
                f"format = {format!r} needs the package {name}: pip install 'thirdbody[sweep]'"
            ) from None
        if name == "zarr" and int(module.__version__.split(".")[0]) < 3:
            raise InvalidValue(
                f"format = 'zarr' needs zarr 3 and finds {module.__version__}: "
                "pip install 'thirdbody[sweep]'"
            )


def _check(folder: Folder, study: dict[str, Any]) -> None:
    """Refuse a folder that holds something else."""
    path = folder.path
    if path.exists() and not path.is_dir():
        raise InvalidValue(f"{path} must be a folder, and a file of that name exists")
    found = _json(path / "study.json")
    if found is None:
        strange = [p.name for p in path.glob("*") if p.name != "lock" and p.name[0] != "."]
        if strange:
            raise InvalidValue(
                f"{path} holds files that are not of a sweep ({', '.join(sorted(strange)[:3])}); "
                "give a new or an empty folder"
            )
        return
    old, new = _flat(found), _flat(json.loads(json.dumps(study)))
    differ = [key for key in {**old, **new} if old.get(key) != new.get(key)]
    if differ == ["order"]:
        there = json.dumps(old.get("order", "not told"), ensure_ascii=False)
        here = json.dumps(new["order"], ensure_ascii=False)
        raise InvalidValue(
            f"{path} holds another study: the order of its inputs, which decides the samples that "
            f"each is given, is {there} there and {here} here; write them in that order, or give "
            "another folder"
        )
    differ = [key for key in differ if key != "order"]  # follows from the rest
    if differ:
        shown = "; ".join(
            f"{key} is {_say(old.get(key))} there and {_say(new.get(key))} here"
            for key in differ[:3]
        )
        more = f"; and {len(differ) - 3} more" if len(differ) > 3 else ""
        raise InvalidValue(f"{path} holds another study: {shown}{more}; give another folder")


def _flat(data: Any, path: str = "") -> dict[str, Any]:
    if not isinstance(data, dict):
        return {path: data}
    out: dict[str, Any] = {}
    for key, value in data.items():
        out |= _flat(value, f"{path}.{key}" if path else key)
    return out


def _say(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:50]} ..."


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """The folder for one run alone; the system lets go of it when the process ends."""
    with (path / "lock").open("a+", encoding="utf-8") as file:
        try:
            if sys.platform == "win32":
                import msvcrt

                # a byte far behind the text, which stays readable
                file.seek(1 << 20)
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            else:
                import fcntl

                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            file.seek(0)
            who = file.read(100).strip()
            raise InvalidValue(
                f"{path} is in use by another run{f' (process {who})' if who else ''}; "
                "wait for it, or give another folder"
            ) from None
        file.truncate(0)
        file.write(str(os.getpid()))
        file.flush()
        yield


def _carry_out(
    plan: Plan,
    folder: Folder,
    study: dict[str, Any],
    notes: list[str],
    results: Callable[[Cost, Iterable[int]], Iterator[tuple[int, Result]]],
    progress: bool | Report,
) -> None:
    """What is left of the study, under the lock."""
    path = folder.path
    shutil.rmtree(path / ".states.part.zarr", ignore_errors=True)  # of a killed run
    for draft in (*path.glob("**/*.partial"), *path.glob("**/.*.part*")):
        draft.unlink(missing_ok=True)
    text = json.dumps(study, indent=1, ensure_ascii=False, sort_keys=True)
    name = _digest(text)
    if not (path / "study.json").exists():
        write_text(path / "study.json", text)
    (path / "done").mkdir(exist_ok=True)
    layout = plan.layout()
    # blocks of a state sweep go straight to their place in a Zarr store
    direct = folder.format == "zarr" and plan.reduction is None
    if direct:
        if not folder.data.exists():
            shutil.rmtree(path / "done")  # of data that are gone
            (path / "done").mkdir()
            draft = path / ".states.part.zarr"
            shutil.rmtree(draft, ignore_errors=True)
            _Zarr.made(draft, layout)
            draft.rename(folder.data)
        store = folder.whole(lambda: _Zarr(folder.data, layout))
    else:
        (path / "parts").mkdir(exist_ok=True)
    done = folder.done(name)
    if not direct:
        done = {number: one for number, one in done.items() if folder.part(number).exists()}
    states = _summary(done.values())["states"]
    left = (number for number in range(plan.count) if number not in done)
    with reporting(str(path), plan.states, states, progress) as report:
        cost = Cost(plan.states, report, done=states)
        for number, (arrays, summary) in results(cost, left):
            if direct:
                store.write(_where(plan, number), arrays, durable=True)
            else:
                _save_part(folder.part(number), arrays)
            write_text(folder.marker(number), json.dumps({"study": name, **summary}))
            done[number] = summary
            states += summary["states"]
            cost.finished(states)
    total = _summary(done.values())
    attrs: dict[str, Any] = dict(_attributes(plan.contact, notes, total))
    if direct:
        store.label(attrs)
    else:
        _assemble(plan, folder, layout, attrs)
    write_text(path / "finished.json", json.dumps(total, indent=1))
    shutil.rmtree(path / "parts", ignore_errors=True)


def _digest(text: str) -> str:
    import hashlib

    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _save_part(path: Path, arrays: Arrays) -> None:
    from ...quantities.files import whole

    with whole(path) as draft, draft.open("wb") as file:
        np.savez(file, **arrays)  # type: ignore[arg-type]


def _assemble(plan: Plan, folder: Folder, layout: Layout, attrs: dict[str, Any]) -> None:
    """The parts put together, whole or not at all."""
    suffix = folder.data.suffix
    draft = folder.path / f".states.part{suffix}"
    kind = _Zarr if folder.format == "zarr" else _NetCDF
    shutil.rmtree(draft, ignore_errors=True)
    draft.unlink(missing_ok=True)
    store = kind.made(draft, layout)
    step = 1 if plan.reduction is None else _parts(plan)
    for first in range(0, plan.count, step):
        parts = (_load_part(folder.part(number)) for number in range(first, first + step))
        arrays = next(parts) if plan.reduction is None else _reduced(plan.reduction, parts)
        store.write(_where(plan, first), arrays)
    store.label(attrs)
    store.close()
    if folder.data.is_dir():
        shutil.rmtree(folder.data)
    draft.replace(folder.data)


def _load_part(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as file:
        return dict(file)
