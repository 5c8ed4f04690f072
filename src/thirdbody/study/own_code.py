"""Laws, outputs, distributions of one's own: files of the command line, and installed packages.

A class that derives from `Named` enters the registry of its kind when its module is imported; here
modules are imported, and what they bring is looked over.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import traceback
from collections.abc import Callable
from dataclasses import is_dataclass
from functools import cache
from pathlib import Path

from ..contact.output import AbstractOutput
from ..errors import InvalidValue, Mistake, Problem, tell_of_range
from ..laws.base import AbstractAsperityLaw, AbstractParticleLaw, Law
from ..populations.distributions import Distribution
from ..populations.heights import Heights
from ..quantities.installed import offers
from ..quantities.named import Named
from ..systems.film_formulas import AbstractFilm

__all__ = ["NAMED", "load_file", "load_installed"]

NAMED = "THIRDBODY_IMPORT"
"""Environment variable that names files; `load_file` adds to it, for processes started later."""

KINDS: dict[type[Named], str] = {
    AbstractAsperityLaw: "law",
    AbstractParticleLaw: "law",
    AbstractOutput: "output",
    Distribution: "size distribution",
    Heights: "distribution of heights",
    AbstractFilm: "film formula",
}
"""What one may add, and the word for it."""

_loaded: set[str] = set()


def load_file(path: str | os.PathLike[str]) -> None:
    """Import a Python file, so that its laws and outputs can be named like those of the library.

    Parameters
    ----------
    path : path-like
        The file; what was imported before is not imported again.

    Raises
    ------
    InvalidValue
        One sentence: the file cannot be read, fails, brings nothing, or takes a name that exists.
    """
    file = Path(path).resolve()
    if str(file) in _loaded:
        return
    where = f"--import {path}"
    if not file.is_file():
        raise InvalidValue(
            f"{where}: there is no such file", code=Mistake.UNREADABLE, source="--import"
        )
    name = file.stem if file.stem.isidentifier() else "own_code"
    while name in sys.modules or importlib.util.find_spec(name):
        name += "_"

    def run() -> None:
        spec = importlib.util.spec_from_file_location(name, file)
        if spec is None or spec.loader is None:
            raise InvalidValue(
                f"{where} is not a Python file; its name must end in .py", code=Mistake.KIND
            )
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module  # dataclasses look it up
        spec.loader.exec_module(module)

    try:
        if not _looked_over(where, run, file):
            raise InvalidValue(
                f"{where} brings nothing of its own: a class that derives from one of "
                f"{', '.join(kind.__name__ for kind in KINDS)} and has a name",
                code=Mistake.EMPTY,
            )
    except BaseException:
        sys.modules.pop(name, None)
        raise
    _loaded.add(str(file))
    others = [
        other_file for other_file in os.environ.get(NAMED, "").split(os.pathsep) if other_file
    ]
    os.environ[NAMED] = os.pathsep.join(dict.fromkeys([*others, str(file)]))


def load_installed() -> None:
    """Import what installed packages offer, and the files of THIRDBODY_IMPORT; once a process.

    A package that fails is told in a warning, so that the others and the library still work.
    """
    for file in os.environ.get(NAMED, "").split(os.pathsep):
        if file:
            load_file(file)
    _load_entry_points()


@cache
def _load_entry_points() -> None:
    for entry in offers():
        where = f"entry point {entry.name} = {entry.value} of {entry.group}"
        try:
            _looked_over(where, entry.load, None)
        except InvalidValue as error:
            tell_of_range(f"{error}; it is left out", UserWarning)


def _looked_over(where: str, run: Callable[[], object], file: Path | None) -> list[type[Named]]:
    """Run an import; if it fails, the registries are as before."""
    before = [(word, kind.registry, dict(kind.registry)) for kind, word in KINDS.items()]
    try:
        run()
        new_classes = [
            (kind, name, law, registered.get(name))
            for kind, registry, registered in before
            for name, law in registry.items()
            if law is not registered.get(name)
        ]
        for kind, name, law, taken in new_classes:
            if taken is not None:
                other = f"{taken.__module__}.{taken.__name__}"
                rule = f": there is a {kind} {name!r} already, {other}"
                raise InvalidValue(
                    Problem(where, rule, hint="choose another name", code=Mistake.CLASH)
                )
            _complete(where, kind, law)
        return [law for _, _, law, _ in new_classes]
    except Exception as error:
        for _, registry, registered in before:
            registry.clear()
            registry.update(registered)
        if isinstance(error, InvalidValue) and error.problems[0].place == where:
            raise
        raise InvalidValue(
            f"{where}{_place(error, file)}: {_why(error)}", code=Mistake.UNREADABLE
        ) from None


def _complete(where: str, kind: str, law: type[Named]) -> None:
    """Problems of a law that lacks a declaration or cannot be made."""
    needed = ["title", "citation", "provenance"] if issubclass(law, Law) else []
    needed += ["year", "valid_range"] if kind == "law" else []
    missing = [name for name in needed if not hasattr(law, name)]
    missing += [n for n in dir(law) if getattr(getattr(law, n), "__isabstractmethod__", False)]
    if not is_dataclass(law):
        missing.append("@dataclass(frozen=True, slots=True, kw_only=True) above it")
    if missing:
        raise InvalidValue(
            Problem(where, f": {law.__name__} lacks {', '.join(missing)}", code=Mistake.UNKNOWN)
        )


def _why(error: Exception) -> str:
    """The error in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())


def _place(error: Exception, file: Path | None) -> str:
    """The line of the file in which it fails."""
    if isinstance(error, SyntaxError) and error.lineno:
        return f", line {error.lineno}"
    lines = [
        frame.lineno
        for frame in traceback.extract_tb(error.__traceback__)
        if file is not None and Path(frame.filename) == file
    ]
    return f", line {lines[-1]}" if lines else ""
