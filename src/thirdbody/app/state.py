"""What a page knows: a study in the words of the study file, and what follows from it."""

from __future__ import annotations

import copy
import time
import warnings
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import thirdbody as tb

from ..errors import InvalidValue, RangeWarning, ThirdBodyError
from ..study import Study, check

__all__ = ["Answer", "State", "files_of", "refuse_foreign_files"]

Path_ = tuple[str | int, ...]
FILES = ("topography", "sizes", "materials")
"""Keys of a study that name other files."""
POINTS = 200
"""Loads of the curves where the study gives one load."""


class Answer:
    """A valid study and its results, each computed when it is first asked for."""

    def __init__(self, study: Study) -> None:
        self.study = study
        self.contact = study.contact
        self.notes: list[str] = list(study.notes)

    @property
    def load(self) -> str:
        """The load as `tb.solve` calls it."""
        return "d" if self.study.load == "separation" else self.study.load

    @cached_property
    def loads(self) -> np.ndarray:
        """Loads of the curves: those of the study, or two decades about its only one."""
        values = np.unique(self.study.values)
        if len(values) > 1:
            return values
        middle = float(values[0])
        if self.load == "d":
            width = 2 * self.contact.roughness.sigma
            return np.linspace(middle - width, middle + width, POINTS)
        return np.geomspace(middle / 100, middle * 100, POINTS)

    def solve(self, values: Any) -> tb.Equilibrium:
        """States under these loads; warnings become notes."""
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always", RangeWarning)
            state = tb.solve(self.contact, **{self.load: values})
        self.notes += [str(item.message) for item in heard]
        self.notes = list(dict.fromkeys(self.notes))
        return state

    @cached_property
    def curves(self) -> tb.Equilibrium:
        """The states of the curves."""
        return self.solve(self.loads)

    @cached_property
    def critical(self) -> tb.Transitions | None:
        """Critical loads, None where the contact has none."""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RangeWarning)
                return tb.transitions(self.contact)
        except ThirdBodyError:
            return None

    def default_at(self) -> float:
        """An operating load in the middle: the only one of the study, or that of its range."""
        if len(self.study.values) == 1:
            return float(self.study.values[0])
        first, last = float(self.loads[0]), float(self.loads[-1])
        if first <= 0:
            return float(self.loads[len(self.loads) // 2])
        return float(f"{(first * last) ** 0.5:.4g}")

    def __contains__(self, at: float) -> bool:
        return bool(self.loads[0] <= at <= self.loads[-1])


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
    """

    def __init__(self, study: dict[str, Any], folder: Path, at: float | None = None) -> None:
        self.study = study
        self.folder = folder
        self.problems: list[str] = []
        self.answer: Answer | None = None
        self.wanted = at
        self.changed: list[Callable[[], None]] = []
        self.began = time.perf_counter()
        """When the last change came."""
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

    def set(self, *path_and_value: Any) -> None:
        """Set an entry, or remove it with None, and tell everybody."""
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
        self.replace(study)

    def replace(self, study: dict[str, Any], at: float | None = None) -> None:
        """Another study in the place of this one."""
        self.began = time.perf_counter()
        self.study = study
        self.wanted = at if at is not None else self.wanted
        self.check()
        self.tell()

    def check(self) -> None:
        """Read the study as the command line does; keep the last answer when it has mistakes."""
        try:
            refuse_foreign_files(self.study, self.folder)
            self.answer = Answer(check(copy.deepcopy(self.study), folder=self.folder))
            self.problems = []
        except InvalidValue as error:
            self.problems = list(error.problems)
        except (ThirdBodyError, OSError) as error:
            self.problems = [str(error)]

    def tell(self) -> None:
        """The study or the operating load is another one."""
        for call in list(self.changed):
            call()

    # ------------------------------------------------------------------ the operating load
    @property
    def at(self) -> float:
        """The operating load, in the unit of the study's load."""
        assert self.answer is not None
        if self.wanted is None or self.wanted not in self.answer:
            return self.answer.default_at()
        return self.wanted

    def go(self, at: float) -> None:
        """Move the operating load."""
        self.began = time.perf_counter()
        self.wanted = at
        self.tell()

    def point(self) -> tb.Equilibrium:
        """The state under the operating load."""
        assert self.answer is not None
        return self.answer.solve(self.at)


def files_of(table: Any) -> list[str]:
    """Names of the files that a study names."""
    found: list[str] = []
    if isinstance(table, dict):
        for key, value in table.items():
            if key in FILES and isinstance(value, (str, list)):
                found += [v for v in ([value] if isinstance(value, str) else value)]
            else:
                found += files_of(value)
    elif isinstance(table, list):
        for item in table:
            found += files_of(item)
    return [name for name in found if isinstance(name, str)]


def refuse_foreign_files(study: dict[str, Any], folder: Path) -> None:
    """Refuse files that were not given to this page: a link must not read the user's disk."""
    wrong = [
        f'"{name}" is not a file of this page; drop it on the tab Surface or Dust first'
        for name in dict.fromkeys(files_of(study))
        if name != "example" and not (Path(name).name == name and (folder / name).is_file())
    ]
    if wrong:
        raise InvalidValue(*wrong)
