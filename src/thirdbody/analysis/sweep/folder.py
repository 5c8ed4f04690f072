"""The folder of a sweep: whose it is, what it holds, and whether that is what was written.

The folder holds

- ``study.json``: what is swept, written first; another study is refused;
- ``states.zarr`` or ``states.nc``: the data;
- ``done/N.json``: a marker for each block, written by rename after its data are on the disk: its
  summary, and size and digest of its files;
- ``parts/N.npz``: blocks that are put together at the end (NetCDF, reductions);
- ``files.json``: size and digest of the data's files that belong to no block;
- ``finished.json``: the summary, written last;
- ``lock``: held by the operating system while a run writes, so that a killed run leaves no lock.

Nothing else in it is ever touched.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ...errors import Advice, InvalidValue, Mistake, Note, Problem
from ...quantities.files import is_draft, remove_files, write_text
from ...quantities.progress import reporting
from ...quantities.run_files import (
    Fingerprint,
    differences,
    fingerprint,
    misfit,
    print_of,
    read_json,
    read_record,
    refuse_another,
    sealed_text,
)
from ...quantities.say import plural

if TYPE_CHECKING:
    import xarray

__all__ = [
    "Folder",
    "Found",
    "check_folder",
    "damage_words",
    "name_of",
    "text_of",
    "unchecked_words",
]

Read = TypeVar("Read")

MARKER = {"study", "states", "unsolved", "A_t", "shadow", "engine"}
"""What markers without digests say, of earlier versions."""
FINISHED = MARKER
"""What ``finished.json`` of earlier versions says."""
PARTIAL = r"(?:zarr|c|\d+)(?:\.json)?(?:\.[0-9a-f]{32})?\.partial"
STORE = re.compile(rf"(?:[^/]+/)?(?:zarr\.json|{PARTIAL}|c|c/(?:\d+/)*(?:\d+|{PARTIAL}))")
"""Files of a Zarr store, and what zarr writes on the way to them."""
PARTIALS = re.compile(rf"(?:[^/]+/)?(?:{PARTIAL}|c/(?:\d+/)*{PARTIAL})")
PARTS = re.compile(r"\d+\.npz|\.\d+\.[0-9a-f-]+\.part\.npz")
MARKERS = re.compile(r"\d+\.json|\.\d+\.[0-9a-f-]+\.part\.json")
ROOT = "states.zarr/zarr.json"
"""The one file of a store that is written again at the end."""
SHOWN, MOST = 3, 20
"""Damaged files that a sentence names, and that are told a line each."""
MUCH = 10**9
"""Bytes from which on it is shown how far reading is."""


@dataclass(eq=False)
class Found:
    """Result of a check of every file of a sweep."""

    blocks: dict[int, dict[str, Any]] = field(default_factory=dict)
    """Blocks whose files are as they were written, with their summaries."""
    damaged: dict[int, list[Problem]] = field(default_factory=dict)
    """Of the other blocks that were finished: what is wrong, one a file."""
    shared: list[Problem] = field(default_factory=list)
    """The same of files that belong to no block."""
    unlabelled: bool = False
    """Whether a run was killed while it put labels on the data, or before."""
    unchecked: int = 0
    """Blocks of an earlier version, which kept no digest."""
    recorded: bool = False
    """Whether the files that belong to no block have digests."""
    checked: int = 0
    """Files that were compared."""
    wanted: int | None = None
    """Blocks of the whole sweep, where ``files.json`` says so."""

    @property
    def problems(self) -> list[Problem]:
        """Every one."""
        return [*self.shared, *(text for texts in self.damaged.values() for text in texts)]


@dataclass(frozen=True, eq=False)
class Folder:
    """A folder with a sweep, finished or not."""

    path: Path
    format: str
    names: tuple[str, ...]
    """Its variables, in order."""

    @property
    def data(self) -> Path:
        """Path of the data."""
        return self.path / ("states.zarr" if self.format == "zarr" else "states.nc")

    @property
    def finished_summary(self) -> dict[str, Any] | None:
        """The summary of a finished run: states, and how many of them are unsolved."""
        record = read_record(self.path / "finished.json", FINISHED)
        right = record and {"states", "unsolved", "A_t", "shadow"} <= set(record.data)
        return record.data if record and right and self.data.exists() else None

    def whole(self, read: Callable[[], Read]) -> Read:
        """What reads the data; InvalidValue where something has damaged them."""
        try:
            return read()
        except PermissionError:
            raise
        except (OSError, ValueError, KeyError, TypeError, RuntimeError) as error:
            why = (str(error) or type(error).__name__).splitlines()[0]
            raise InvalidValue(
                f"{self.data} is damaged ({why}); remove it, and the same command makes it again",
                code=Mistake.DAMAGED,
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

    def part_file(self, number: int) -> Path:
        return self.path / "parts" / f"{number}.npz"

    def mark(
        self, number: int, study: str, summary: Mapping[str, object], files: list[Path]
    ) -> None:
        """Say that a block is on the disk."""
        prints = {file.relative_to(self.path).as_posix(): fingerprint(file) for file in files}
        text = sealed_text({"study": study, **summary, "files": prints})
        write_text(self.marker(number), text, tidy=False)

    def record(self, study: str, blocks: int, data: Path | None = None) -> None:
        """Say what the data hold, or what will be their place, where no block does so."""
        place = data or self.data
        files = [place] if place.is_file() else sorted(f for f in place.rglob("*") if f.is_file())
        self.write_record(
            study,
            blocks,
            {
                (self.data / file.relative_to(place))
                .relative_to(self.path)
                .as_posix(): fingerprint(file)
                for file in files
            },
        )

    def relabel(self, study: str) -> None:
        """Say what the store holds once it has its labels."""
        shared = self.shared_files(study)
        if shared is not None:
            files, blocks = shared
            self.write_record(study, blocks, files | {ROOT: fingerprint(self.path / ROOT)})

    def restore(self, fresh: Path, study: str, blocks: int) -> None:
        """Put files that belong to no block of a store back from one that was made again.

        Raises
        ------
        InvalidValue
            Another version of zarr made the store, whose files this one does not make.
        """
        shared = self.shared_files(study)
        names = sorted(
            file.relative_to(fresh).as_posix() for file in fresh.rglob("*") if file.is_file()
        )
        prints = {name: fingerprint(fresh / name) for name in names}
        there = {name: fingerprint(self.data / name) for name in names}
        if shared is not None:
            wanted = {name: shared[0].get(f"{self.data.name}/{name}") for name in names}
            for name in names:
                if name != "zarr.json" and there[name] != wanted[name] != prints[name]:
                    raise InvalidValue(
                        f"{self.data / name} is damaged, and this version of zarr makes another "
                        f"one; remove {self.data}, and the same command solves all of it again",
                        code=Mistake.DAMAGED,
                    )
        same = shared is not None or any(
            there[name] == prints[name] for name in names if name.endswith("/zarr.json")
        )
        for name in names:
            place = self.data / name
            of_use = there[name] is not None and (place.suffix != ".json" or read_json(place))
            if name == "zarr.json" or not of_use or (same and there[name] != prints[name]):
                place.parent.mkdir(parents=True, exist_ok=True)
                (fresh / name).replace(place)
        if same:
            kept = {f"{self.data.name}/{name}": written for name, written in prints.items()}
            self.write_record(study, blocks, kept)

    def write_record(self, study: str, blocks: int, prints: Mapping[str, Fingerprint]) -> None:
        """Write ``files.json``."""
        content = {"study": study, "blocks": blocks, "files": dict(prints)}
        write_text(self.path / "files.json", sealed_text(content))

    def shared_files(self, study: str | None) -> tuple[dict[str, Fingerprint], int] | None:
        """Content of ``files.json``: fingerprints, and the number of blocks."""
        record = read_record(self.path / "files.json", ())
        if record is None or (study is not None and record.data.get("study") != study):
            return None
        return record.data["files"], record.data["blocks"]

    def markers(self, study: str | None) -> dict[int, dict[str, Any] | None]:
        """Content of each marker; None for a broken one or one of another study."""
        out: dict[int, dict[str, Any] | None] = {}
        for path in sorted((self.path / "done").glob("*.json")):
            if not (path.stem.isdecimal() and path.stem.isascii()):
                continue
            record = read_record(path, MARKER)
            right = record is not None and {"study", "states", "unsolved"} <= set(record.data)
            if right and record is not None and study is not None:
                right = record.data["study"] == study
            out[int(path.stem)] = record.data if right and record is not None else None
        return dict(sorted(out.items()))

    def holds(self, study: str) -> bool:
        """Whether something else than ``study.json`` says that this study lies here."""
        return self.shared_files(study) is not None or any(self.markers(study).values())

    # ------------------------------------------------------------------ what is as it was written
    def look(self, study: str | None, wanted: bool = False) -> Found:
        """Compare every file that a run has finished with what was written.

        Parameters
        ----------
        study : str or None
            Digest of the study (`name_of`); with None that of no marker is compared.
        wanted : bool, optional
            Show how far this is, where there is much to read.
        """
        out = Found()
        shared, markers = self.shared_files(study), self.markers(study)
        out.recorded = shared is not None
        files, blocks = shared or ({}, 0)
        out.wanted = blocks or None
        finished = self.finished_summary is not None
        for name, written in files.items():
            problems = self._misfit(name, written)
            if name == ROOT and problems and not finished:
                out.unlabelled = True
            else:
                out.shared += problems
        out.checked = len(files)
        if shared is None and self._lacks_record(markers, finished=finished):
            out.shared.append(damage(self.path / "files.json", "is missing or damaged"))
        # a store that blocks are written to in place has its files.json from the start
        finished |= out.recorded and not out.shared and self._put_together(markers)
        wanted = wanted and _much(markers)
        title = f"{self.path}: checking"
        with reporting(title, len(markers), 0, wanted, "blocks") as report:
            for done, (number, marker) in enumerate(markers.items(), 1):
                self._look_at(out, number, marker, finished=finished)
                report(done)
        for number in range(blocks if finished else 0):
            if number not in markers:
                out.damaged[number] = [damage(self.marker(number), "is missing")]
        return out

    def _look_at(
        self, out: Found, number: int, marker: dict[str, Any] | None, *, finished: bool
    ) -> None:
        """One block of `look`."""
        if marker is None:
            out.damaged[number] = [damage(self.marker(number))]
            return
        files, problems = marker.get("files"), []
        if files is None:
            out.unchecked += 1
            if (
                (self.path / "parts").is_dir()
                and not finished
                and not self.part_file(number).exists()
            ):
                problems = [damage(self.part_file(number), "is missing")]
        elif not (finished and self._parts_only(files)):  # which go once they are put together
            problems = [
                text for name, written in files.items() for text in self._misfit(name, written)
            ]
            out.checked += len(files)
        if problems:
            out.damaged[number] = problems
        else:
            out.blocks[number] = marker

    def _lacks_record(
        self, markers: Mapping[int, dict[str, Any] | None], *, finished: bool
    ) -> bool:
        """Whether there should be a ``files.json`` that can be read."""
        if (self.path / "files.json").exists():
            return True
        prints = [marker["files"] for marker in markers.values() if marker and "files" in marker]
        return any(finished or not self._parts_only(files) for files in prints)

    def _put_together(self, markers: Mapping[int, dict[str, Any] | None]) -> bool:
        """Whether blocks lie in parts, so that data that are there hold all of them."""
        prints = [marker["files"] for marker in markers.values() if marker and "files" in marker]
        return any(files and self._parts_only(files) for files in prints)

    def _misfit(self, name: str, wanted: Fingerprint) -> list[Problem]:
        why = misfit(self.path / name, wanted)
        return [damage(self.path / name, why)] if why else []

    def _parts_only(self, files: Mapping[str, object]) -> bool:
        return all(name.startswith("parts/") for name in files)

    # ------------------------------------------------------------------ what may be removed
    def remove_drafts(self) -> None:
        """Remove what a killed run of this folder left; the lock is held."""
        for name in ("study.json", "files.json", "finished.json"):
            _remove_ours(self.path, partial(is_draft, of=name))
        _remove_ours(self.path / "done", lambda path: _numbered_draft(path, ".json"))
        _remove_ours(self.path / "parts", lambda path: _numbered_draft(path, ".npz"))
        remove_files(self.path / ".states.part.zarr", STORE)
        (self.path / ".states.part.nc").unlink(missing_ok=True)
        store = self.path / "states.zarr"
        if store.is_dir() and not store.is_symlink():
            for file in store.rglob("*.partial"):
                if PARTIALS.fullmatch(file.relative_to(store).as_posix()) and file.is_file():
                    file.unlink(missing_ok=True)

    def remove_parts(self) -> None:
        """Remove the parts that have been put together."""
        parts = self.path / "parts"
        with suppress(OSError):  # there is none, it holds something else, or may not be written
            _remove_ours(parts, lambda name: PARTS.fullmatch(name) is not None)
            parts.rmdir()

    def remove_markers(self) -> None:
        """Forget every block."""
        remove_files(self.path / "done", MARKERS)

    # ------------------------------------------------------------------ whose folder it is
    def says(self, study: Mapping[str, object]) -> bool:
        """Whether ``study.json`` is that of a study, to the last byte."""
        return misfit(self.path / "study.json", print_of(text_of(study))) == ""

    def refuse_others(self, study: Mapping[str, object]) -> None:
        """Refuse a folder that holds something else."""
        path = self.path
        if path.exists() and not path.is_dir():
            raise InvalidValue(
                f"{path} must be a folder, and a file of that name exists", code=Mistake.UNWRITABLE
            )
        if not path.exists():
            return
        old_study = read_json(path / "study.json")
        if old_study is not None and not differences(old_study, study):
            return
        if self.holds(name_of(study)):
            return  # study.json is damaged, and written again
        if old_study is None:
            self._refuse_strangers()
            return
        old, new = old_study.get("order", "not told"), study["order"]
        if list(differences(old_study, study)) == ["order"]:
            there, here = (json.dumps(order, ensure_ascii=False) for order in (old, new))
            raise InvalidValue(
                f"{path} holds another study: the order of its inputs, which decides the samples "
                f"that each is given, is {there} there and {here} here; write them in that order, "
                "or give another folder",
                code=Mistake.OTHER_STUDY,
            )
        refuse_another(path, old_study, study, derived=("order",), called=_entry_in_words)

    def _refuse_strangers(self) -> None:
        """Refuse a folder without a study that holds anything but what a killed run leaves."""
        strange = sorted(
            path.name
            for path in self.path.iterdir()
            if not is_draft(path.name, "study.json") and not _is_lock(path)
        )
        if not strange:
            return
        if "study.json" in strange:
            raise InvalidValue(
                f"{self.path / 'study.json'} cannot be read, so nobody knows what {self.path} "
                "holds; give another folder",
                code=Mistake.UNREADABLE,
            )
        raise InvalidValue(
            f"{self.path} holds files that are not of a sweep ({', '.join(strange[:3])}); "
            "give a new or an empty folder",
            code=Mistake.UNWRITABLE,
        )

    @contextmanager
    def lock_folder(self) -> Iterator[None]:
        """The folder for one run alone; the system lets go of it when the process ends."""
        with (self.path / "lock").open("a+", encoding="utf-8") as file:
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
                    f"{self.path} is in use by another run{f' (process {who})' if who else ''}; "
                    "wait for it, or give another folder",
                    code=Mistake.UNWRITABLE,
                ) from None
            file.truncate(0)
            file.write(str(os.getpid()))
            file.flush()
            yield


def _entry_in_words(key: str) -> str:
    """What a reader calls an entry of ``study.json``.

    >>> _entry_in_words("vary.particles.diameter.mean.particles.diameter.mean")
    'particles.diameter.mean'
    """
    label = key.removeprefix("vary.")
    inputs = label[: len(label) // 2] if label != key else ""
    # an input is listed below its own name, several that move together below all of theirs
    name = inputs if label == f"{inputs}.{inputs}" else label
    return Advice(name, name.removeprefix("contact.").replace(".diameter.", "."))


def name_of(study: Mapping[str, object]) -> str:
    """The digest of a study, which every marker says."""
    return hashlib.sha256(text_of(study).encode()).hexdigest()[:16]


def text_of(study: Mapping[str, object]) -> str:
    """A study as it stands in ``study.json``."""
    return json.dumps(study, indent=1, ensure_ascii=False, sort_keys=True)


def _is_lock(file: Path) -> bool:
    """Whether a file is the lock of a run: empty, or the number of a process."""
    if file.name != "lock" or file.is_symlink() or not file.is_file():
        return False
    try:
        with file.open("rb") as held:
            return re.fullmatch(rb"\d{0,20}", held.read(30)) is not None
    except OSError:  # another run holds it, where that keeps others from reading
        return True


def _numbered_draft(name: str, suffix: str) -> bool:
    number = re.match(r"\.(\d+)\.", name)
    return number is not None and is_draft(name, f"{number[1]}{suffix}")


def _remove_ours(folder: Path, is_ours: Callable[[str], bool]) -> None:
    if folder.is_symlink() or not folder.is_dir():
        return
    for file in folder.iterdir():
        if is_ours(file.name) and file.is_file() and not file.is_symlink():
            file.unlink(missing_ok=True)


# -------------------------------------------------------------------------- asked for by name
def check_folder(path: str | os.PathLike[str], *, progress: bool = False) -> str:
    """Compare every file of a sweep with what was written.

    Parameters
    ----------
    path : path-like
        The folder of a sweep, finished or not.
    progress : bool, optional
        Show how far this is, where there is much to read.

    Returns
    -------
    str
        What was found, where nothing is damaged; what could not be checked, in a second line.

    Raises
    ------
    InvalidValue
        There is no sweep, or something is damaged: a sentence a file.
    """
    place = Path(path)
    study = read_json(place / "study.json")
    kind = None if study is None else study.get("format")
    if kind not in ("zarr", "netcdf"):
        kind = "netcdf" if (place / "states.nc").exists() else "zarr"
    folder = Folder(place, kind, ())
    names = {marker["study"] for marker in folder.markers(None).values() if marker is not None}
    if study is None and not names:
        raise InvalidValue(
            f"{place} holds no sweep: there is no study.json that can be read",
            code=Mistake.UNREADABLE,
        )
    name = None if study is None else name_of(study)
    problems: list[Problem] = []
    if name is None or (names and name not in names):
        problems.append(damage(place / "study.json"))
        name = min(names)
    findings = folder.look(name, progress)
    problems += findings.problems
    finished = folder.finished_summary is not None
    if (place / "finished.json").exists() and not finished:
        problems.append(damage(place / "finished.json", "is damaged, or the data are missing"))
    if problems:
        many = len(problems) > MOST
        more = [f"and {len(problems) - MOST} files more"] if many else []
        raise InvalidValue(
            *problems[:MOST],
            *more,
            damage(place, "is damaged: thirdbody sweep with its study makes that again"),
            code=Mistake.DAMAGED,
        )
    blocks = plural(len(findings.blocks), "block")
    if finished:
        summary = f"{place}: {plural(findings.checked, 'file')} of {blocks} as they were written; "
        summary += "the sweep is finished"
    else:
        if findings.wanted is not None:
            blocks = f"{len(findings.blocks)} of {plural(findings.wanted, 'block')}"
        summary = (
            f"{place}: {blocks} done, {plural(findings.checked, 'file')} as they were written; "
            "the sweep is not finished: its command goes on"
        )
    missing = unchecked_words(place, findings)
    return f"{summary}\n{missing}" if missing else summary


def damage(file: Path, rule: str = "is damaged") -> Problem:
    """Mistake of a file that was changed or lost."""
    return Problem("", f"{file} {rule}", code=Mistake.DAMAGED)


def damage_words(path: Path, findings: Found) -> str:
    """Sentence on damaged blocks that are computed again; "" where there are none."""
    if not findings.problems:
        return ""
    shown = "; ".join(findings.problems[:SHOWN])
    more = f"; and {len(findings.problems) - SHOWN} more" if len(findings.problems) > SHOWN else ""
    what = f"{path} is damaged, and what is damaged is made again: {shown}{more}"
    return Note(what, code="kept.damaged")


def _much(markers: Mapping[int, dict[str, Any] | None]) -> bool:
    """Whether there are seconds of reading."""
    prints = [
        written
        for marker in markers.values()
        if marker
        for written in marker.get("files", {}).values()
    ]
    return sum(written[0] for written in prints if written) > MUCH


def unchecked_words(path: Path, findings: Found) -> str:
    """Sentence on files that cannot be checked, and what to do; "" where all can."""
    if not findings.unchecked:
        return ""
    what = (
        f"{path}: {plural(findings.unchecked, 'block')} of an earlier version of thirdbody kept no "
        "digest, so that damage in them is not seen; solve the study into another folder where "
        "that matters"
    )
    return Note(what, code="kept.unchecked")
