"""What a page knows: a study in the words of the study file, and what follows from it."""

from __future__ import annotations

import asyncio
import copy
import dataclasses
import json
import math
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, TypedDict, TypeVar, TypeVarTuple

import numpy as np
from numpy.typing import ArrayLike

import thirdbody as tb

from ..contact.output import AbstractOutput
from ..equilibrium.load import as_load
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, ThirdBodyError, note_of
from ..study import Study, check
from ..study.life_contact import BOUNDARY
from ..study.load import press_forces
from ..systems.bodies import Pressed
from .bounds import MOST_DRAWN, refuse_large, refuse_large_files
from .folders import Shelf
from .jobs import Job, Stopped
from .solver import Died, ask_for_page
from .text import without_paths

__all__ = [
    "Answer",
    "State",
    "files_of",
    "loads_as",
    "look",
    "missing",
    "refuse_foreign_files",
]

Found = TypeVar("Found")
Args = TypeVarTuple("Args")
FILES = {
    "topography": "on the tab Surface",
    "sizes": "on the tab Dust",
    "materials": "at the side under Surfaces",
    "reports": "",
}
"""Keys of a study that name other files, and where such a file is dropped; "" for nowhere."""
WORDS = ("example", BOUNDARY)
"""What may stand where a file can, and is none."""
POINTS = 200
"""Loads of the curves where the study gives one load."""
MOST_TOLD = 40
"""Mistakes that are told."""
MOST_STEPS = 100
"""Steps that can be undone."""
SECONDS = 60.0
"""A measured file that takes longer to read is refused."""


class Answer:
    """A valid study and its results, each computed when it is first asked for."""

    def __init__(self, study: Study) -> None:
        # what is not drawn need not travel between processes
        self.study = dataclasses.replace(study, sweep=None, uncertainty=None, design=None)
        self.contact = study.contact
        self.notes: list[str] = list(study.notes)

    @property
    def load(self) -> str:
        """The load as `tb.solve` calls it."""
        return "d" if self.study.load == "separation" else self.study.load

    @property
    def has_one_force(self) -> bool:
        """Whether one force presses bodies: the loads are its mean and largest pressure."""
        return self.study.forces is not None and len(self.study.forces) == 1

    @cached_property
    def loads(self) -> np.ndarray:
        """Loads of the curves: those of the study, or two decades about its only one."""
        values = np.unique(self.study.values)
        if len(values) > MOST_DRAWN:
            every = np.linspace(0, len(values) - 1, MOST_DRAWN).round().astype(int)
            values = values[np.unique(every)]
        if len(values) > 1 and not self.has_one_force:
            return values
        middle = float(values[0])
        if self.has_one_force:  # from little up to the largest pressure
            return np.geomspace(middle / 100, float(self.study.values.max()), POINTS)
        if self.load == "d":
            width = 2 * self.contact.roughness.sigma
            return np.linspace(middle - width, middle + width, POINTS)
        return np.geomspace(middle / 100, middle * 100, POINTS)

    def solve(self, values: ArrayLike, *more: AbstractOutput) -> tb.results.Equilibrium:
        """States under these loads, with more outputs; warnings become notes."""
        contact = self.contact
        kinds = {type(output) for output in contact.outputs}
        if new := [output for output in more if type(output) not in kinds]:
            contact = contact.replace(outputs=(*contact.outputs, *new))
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always", RangeWarning)
            state = tb.solve(contact, **as_load(self.load, values))
        self.notes += [note_of(item.message) for item in heard]
        self.notes = list(dict.fromkeys(self.notes))
        return state

    @cached_property
    def forces(self) -> list[Pressed]:
        """What forces do to their bodies, integrated over the contact as `run_study` does it."""
        if self.study.body is None or self.study.forces is None:
            return []
        return press_forces(self.study.body, self.study.forces, self.contact)

    @property
    def particles_held(self) -> float:
        """Particles that one contact holds on average; any number where its area is not known."""
        study, every = self.study, sum(dust.areal_density for dust in self.contact.populations)
        if study.body is not None and study.forces is not None:
            if "forces" in self.__dict__:  # counted on the area that carries
                return self.forces[-1].particles_held or 0.0
            area = study.body.hertz(float(study.forces[-1]), self.contact.E_ss).area
        elif study.film is not None and not study.own_load:  # its Hertz pressure is the load
            area = study.film.conjunction.hertz(study.film.load, E=2 * self.contact.E_ss).area
        else:
            return math.inf
        return float(every * area)

    @cached_property
    def curves(self) -> tb.results.Equilibrium:
        """The states of the curves."""
        return self.solve(self.loads)

    @cached_property
    def critical(self) -> tb.results.Transitions | None:
        """Critical loads, None where the contact has none."""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RangeWarning)
                return tb.transitions(self.contact)
        except ThirdBodyError:
            return None

    def default_at(self) -> float:
        """An operating load in the middle: the only one of the study, or that of its range.

        Under one force that is its mean pressure.
        """
        if len(self.study.values) == 1 or self.has_one_force:
            return float(self.study.values[0])
        first, last = float(self.loads[0]), float(self.loads[-1])
        if first <= 0:
            return float(self.loads[len(self.loads) // 2])
        return float(f"{(first * last) ** 0.5:.4g}")

    def __contains__(self, at: float) -> bool:
        return bool(self.loads[0] <= at <= self.loads[-1])


Tables = dict[str, object]
"""A study as its file is parsed."""


class Measured(TypedDict, total=False):
    """What was found in the measured files of a study."""

    roughness: Tables
    notes: list[str]
    problems: list[Problem]


Looked = tuple["Answer | None", list[Problem], dict[str, tb.Material] | None]


def look(study: Tables, folder: Path, surface: Measured | None = None) -> Looked:
    """A study as the command line reads it: its answer or its mistakes, and its own materials.

    ``surface`` is what `worker.roughness` found in the measured files of the study.
    """
    answer, problems, library = None, list[Problem](), None
    try:
        refuse_large(study)
        refuse_foreign_files(study, folder)
        tables = {key: value for key, value in study.items() if key != "roughness"}
        refuse_large_files(folder, files_of(tables))
        if isinstance(file_name := study.get("materials"), str):
            mine = tb.materials.load(folder / file_name)
            library = {name: mine[name] for name in mine}
        to_check = copy.deepcopy(study)
        if surface is not None:
            problems += surface.get("problems", [])
            to_check["roughness"] = surface.get("roughness", {"sigma": 1e-7, "R": 1e-6})
        checked, left_out = _check_study(to_check, folder)
        problems += left_out
        if surface is not None:
            checked = dataclasses.replace(
                checked, notes=(*surface.get("notes", []), *checked.notes)
            )
        answer = None if len(problems) > len(left_out) else Answer(checked)
    except InvalidValue as error:
        problems += error.problems
    except (ThirdBodyError, OSError) as error:
        problems += [Problem("", str(error))]
    problems = [problem.put_in_words(without_paths) for problem in dict.fromkeys(problems)]
    if (more := len(problems) - MOST_TOLD) > 0:
        code = problems[MOST_TOLD].code
        problems[MOST_TOLD:] = [Problem("", f"and {more} more mistakes", code=code)]
    return answer, problems, library


def _check_study(study: Tables, folder: Path) -> tuple[Study, list[Problem]]:
    """The study without the outputs that have mistakes, and those; other mistakes are raised."""
    try:
        return check(study, folder=folder), []
    except InvalidValue as error:
        outputs = study.get("outputs")
        places = [problem.place.split(".") for problem in error.problems]
        if not isinstance(outputs, dict) or any(place[0] != "outputs" for place in places):
            raise
        wrong = {name for place in places for name in place[1:2]}
        kept = {name: table for name, table in outputs.items() if name not in wrong}
        if len(kept) == len(outputs):
            raise
        rest = {key: value for key, value in study.items() if key != "outputs"}
        checked, more = _check_study(rest | ({"outputs": kept} if kept else {}), folder)
        return checked, [*error.problems, *more]


def surface_key(study: Tables, folder: Path) -> str:
    """What names a measured surface that the study builds on; empty where there is none."""
    rough = study.get("roughness")
    names = files_of({"topography": rough.get("topography")}) if isinstance(rough, dict) else []
    files = [folder / name for name in names if Path(name).name == name]
    stats = [file.stat() for file in files if file.is_file()]
    if not stats:
        return ""  # of the library, or none
    marks = [(stat.st_size, stat.st_mtime_ns) for stat in stats]
    return json.dumps([rough, study.get("asperity_law"), marks], default=str)


def loads_as(answer: Answer, name: str) -> np.ndarray:
    """The loads of the curves as another load of `tb.solve`."""
    return np.asarray(getattr(answer.curves, name))


def _call_and_learn(
    call: Callable[[Answer, *Args], Found], answer: Answer, args: tuple[*Args]
) -> tuple[Found, Tables]:
    """What a function of an answer gives, and what the answer has learned by it."""
    before = set(answer.__dict__) - {"notes"}
    result = call(answer, *args)
    return result, {key: value for key, value in answer.__dict__.items() if key not in before}


class State:
    """One page: the study as it stands, its mistakes, and the last answer without any.

    Parameters
    ----------
    study : dict
        As a study file is parsed.
    folder : Path
        Where files lie that the study names.
    at : float, optional
        The operating load, in the unit of the study's load.
    later : bool, optional
        Leave the reading of a changed study to `settle`.
    """

    def __init__(
        self,
        study: Tables,
        folder: Path,
        at: float | None = None,
        *,
        later: bool = False,
    ) -> None:
        self.study = study
        self.folder = folder
        self.later = later
        self.read: Tables | None = None
        """The study that answer and problems belong to."""
        self.shelf: Shelf | None = None
        """Where files lie that the address names."""
        self.files: dict[str, str] = {}
        """Keys there of the files of this page."""
        self.surface: dict[str, str] = {}
        """The file that the tab Surface shows, and how it was read."""
        self.surfaces: dict[str, Measured] = {}
        """What was found in measured files, the last one asked for."""
        self.library: Mapping[str, tb.Material] = tb.materials
        """The materials that the study can name."""
        self.reading: Job | None = None
        self.problems: list[Problem] = []
        self.answer: Answer | None = None
        self.current = True
        """Whether the answer is that of the study, not of a former one."""
        self.wanted = at
        self.tab = ""
        """The tab in sight."""
        self.noted: dict[str, list[str]] = {}
        """What the answers of single tabs leave open."""
        self.opened = study
        """The study as it was opened."""
        self.kept: Tables | None = None
        """A study that was kept, to lay this one beside it."""
        self.beside = ""
        """Which study the tab of both lays beside this one, where somebody chose it."""
        self.past: list[tuple[Tables, float | None]] = []
        """Study and operating load before each step."""
        self.steps = 0
        """How many there were."""
        self.kind: str | None = None
        """What the last change was of; more of the same goes on with its step."""
        self.changed: list[Callable[[], None]] = []
        self.began = time.perf_counter()
        """When the last change came."""
        if not later:
            self.check()

    # ------------------------------------------------------------------ the study
    def get(self, *path: str | int) -> Any:
        """An entry of the study, None where there is none."""
        where: Any = self.study
        for step in path:
            try:
                where = where[step]
            except (KeyError, IndexError, TypeError):
                return None
        return where

    def set(self, *path_and_value: Any, whole: bool = False) -> None:
        """Set an entry, or remove it with None, and tell everybody.

        Changes of one entry in a row are one step, but for those that are ``whole``.
        """
        *path, value = path_and_value
        if self.get(*path) == value and type(self.get(*path)) is type(value):
            return
        study = copy.deepcopy(self.study)
        where: Any = study
        for step in path[:-1]:
            where = where.setdefault(step, {}) if isinstance(where, dict) else where[step]
        if value is not None:
            where[path[-1]] = value
        elif isinstance(where, list):
            del where[path[-1]]
        else:
            where.pop(path[-1], None)
        self.replace(study, kind=None if whole else ".".join(map(str, path)))

    def replace(self, study: Tables, at: float | None = None, *, kind: str | None = None) -> None:
        """Another study in the place of this one."""
        self._step(kind)
        self._set_study(study, at if at is not None else self.wanted)

    def open(self, study: Tables) -> None:
        """A study that begins anew, with an operating load of its own."""
        self._step(None)
        self.opened = study
        self._set_study(study, None)

    def _step(self, kind: str | None) -> None:
        """Keep what is now, unless the change goes on with the last one."""
        if kind is None or kind != self.kind:
            self._keep()
            self.steps += 1
        self.kind = kind

    def _keep(self) -> None:
        self.past = [*self.past[1 - MOST_STEPS :], (self.study, self.wanted)]

    def _set_study(self, study: Tables, at: float | None) -> None:
        self.began = time.perf_counter()
        self.study, self.wanted = study, at
        if not self.later:
            self.check()
        self.announce_change()

    def undo(self) -> None:
        """Take the last step back."""
        if self.past:
            self.kind = None
            self.steps += 1
            self._set_study(*self.past.pop())

    def travel(self, study: Tables, at: float | None) -> None:
        """What an entry of the browser's history holds."""
        self._keep()
        self.kind = None
        self._set_study(study, at)

    def check(self) -> None:
        """Read the study as the command line does; keep the last answer when it has mistakes."""
        if self._unread():
            asyncio.run(self._measure())
        self._take(self.study, look(self.study, self.folder, self._surface()))

    async def settle(self) -> None:
        """The same beside the server, where it was left for later."""
        study = self.study
        if study is self.read:
            return
        try:
            refuse_large(study)
            refuse_foreign_files(study, self.folder)
            if self._unread():
                await self._measure()
            looked = await ask_for_page(look, study, self.folder, self._surface())
        except Died:
            raise  # which says nothing of the study: it is read when it is asked for again
        except InvalidValue as error:
            looked = None, [problem.put_in_words(without_paths) for problem in error.problems], None
        self._take(study, looked)

    def _take(self, study: Tables, looked: Looked) -> None:
        answer, self.problems, library = looked
        self.library = tb.materials if library is None else library
        self.answer = self.answer if answer is None else answer
        self.current = answer is not None
        self.read = study

    async def ask(self, call: Callable[[Answer, *Args], Found], *args: *Args) -> Found:
        """What a function of the answer and more arguments gives, computed beside the server."""
        answer = self.answer
        assert answer is not None
        result, more = await ask_for_page(_call_and_learn, call, answer, args)
        answer.__dict__.update(more)
        return result

    # ------------------------------------------------------------------ files
    def note_file(self, name: str, key: str | None) -> None:
        """A file was given to the page; a study that names it is read anew."""
        if key is not None:
            self.files[name] = key
        if name in files_of(self.study):
            self.read = None
            if not self.later:
                self.check()
        self.announce_change()

    def file_keys(self) -> dict[str, str]:
        """The files that studies and tabs name, with their keys."""
        studies = [self.study, self.opened, self.kept or {}]
        names = [*(name for study in studies for name in files_of(study))]
        names.append(self.surface.get("file", ""))
        return {name: self.files[name] for name in names if name in self.files}

    # ------------------------------------------------------------------ measured surfaces
    def _surface(self) -> Measured | None:
        return self.surfaces.get(surface_key(self.study, self.folder))

    def _unread(self) -> bool:
        key = surface_key(self.study, self.folder)
        return bool(key) and key not in self.surfaces

    async def _measure(self) -> None:
        """Have the files read by a process of their own, which gives numbers."""
        key = surface_key(self.study, self.folder)
        tables = {k: v for k, v in self.study.items() if k in ("roughness", "asperity_law")}
        self.reading = Job("roughness", seconds=SECONDS)
        try:
            measured: Measured = await self.reading.run(study=tables, folder=str(self.folder))
        except Died:
            raise
        except InvalidValue as error:
            measured = {"problems": list(error.problems)}
        except Stopped:
            rule = ": the reading was cancelled"
            cancelled = Problem("roughness.topography", rule, code=Mistake.UNREADABLE)
            measured = {"problems": [cancelled]}
        finally:
            self.reading = None
        self.surfaces = {key: measured}

    def close(self) -> None:
        """Nobody looks at the page any more."""
        if self.reading is not None:
            self.reading.cancel()

    def note(self, tab: str, notes: Iterable[str]) -> None:
        """What the answer of a tab leaves open; the badge tells it."""
        if (every := list(notes)) != self.noted.get(tab, []):
            self.noted[tab] = every
            self.announce_change()

    def announce_change(self) -> None:
        """The study or the operating load is another one."""
        for call in list(self.changed):
            call()

    # ------------------------------------------------------------------ the operating load
    @property
    def operating_load(self) -> float:
        """The operating load, in the unit of the study's load."""
        assert self.answer is not None
        if self.wanted is None or self.wanted not in self.answer:
            return self.answer.default_at()
        return self.wanted

    def go(self, at: float) -> None:
        """Move the operating load."""
        self._step("at")
        self.began = time.perf_counter()
        self.wanted = at
        self.announce_change()

    def point(self) -> tb.results.Equilibrium:
        """The state under the operating load."""
        assert self.answer is not None
        return self.answer.solve(self.operating_load)


def files_of(table: object) -> list[str]:
    """Names of the files that a study names."""
    return [name for _, name in _files(table)]


def _files(table: object) -> Iterator[tuple[str, str]]:
    """The keys of a study that name files, and the files."""
    if isinstance(table, dict):
        for key, value in table.items():
            if key in FILES and isinstance(value, (str, list)):
                names = [value] if isinstance(value, str) else value
                yield from ((key, name) for name in names if isinstance(name, str))
            else:
                yield from _files(value)
    elif isinstance(table, list):
        for item in table:
            yield from _files(item)


def missing(name: str, key: str = "topography") -> str:
    """What is told of a file that the page has not, where a study or an address names it."""
    if not FILES[key]:
        return (
            f'"{name}" is not a file of this page, which takes no {key} of an oil: thirdbody life '
            "reads them in a terminal"
        )
    return (
        f'"{name}" is not a file of this page: drop it {FILES[key]} '
        "(files are kept until the server ends)"
    )


def refuse_foreign_files(study: Tables, folder: Path) -> None:
    """Refuse files that were not given to this page: a link must not read the user's disk."""
    wrong = [
        missing(name, key)
        for key, name in dict.fromkeys(_files(study))
        if name not in WORDS and not (Path(name).name == name and (folder / name).is_file())
    ]
    if wrong:
        raise InvalidValue(*wrong, code=Mistake.UNREADABLE)
