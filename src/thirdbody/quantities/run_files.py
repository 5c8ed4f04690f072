"""Small files that a run leaves beside its results: sealed, and saying what other files hold."""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import Advice, InvalidValue, Mistake, Problem
from .files import is_draft, make_folder, write_text

__all__ = [
    "MARK",
    "SEAL",
    "Fingerprint",
    "Sealed",
    "claim_folder",
    "differences",
    "fingerprint",
    "misfit",
    "print_of",
    "read_json",
    "read_record",
    "refuse_another",
    "refuse_replaced",
    "release_folder",
    "sealed_text",
]

SEAL = "sha256"
"""Key under which a record says the digest of the rest of it."""

MOST_SHOWN, FEW = 3, 4
"""Differences between two records that are told, and values of a list that are told one by one."""

Fingerprint = list[Any] | None
"""Size in bytes and SHA-256 of a file; None for a file that there is not."""


class Sealed(NamedTuple):
    """Content of a sealed file."""

    data: dict[str, Any]
    checked: bool
    """Whether a seal says that it is as it was written."""


def sealed_text(data: Mapping[str, object]) -> str:
    """Text of a record, with its digest.

    Examples
    --------
    >>> text = sealed_text({"states": 3})
    >>> list(json.loads(text))
    ['states', 'sha256']
    """
    return json.dumps({**data, SEAL: _digest(data)})


def _digest(data: Mapping[str, object]) -> str:
    """SHA-256 of what a record says, whatever the order and the spaces of its text."""
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def read_json(path: Path) -> dict[str, Any] | None:
    """Content of a small JSON file; None if it is missing or broken."""
    try:
        content = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return content if isinstance(content, dict) else None


def read_record(path: Path, unsealed: Collection[str]) -> Sealed | None:
    """Content of a record; None if it is missing, broken or changed.

    Parameters
    ----------
    path : pathlib.Path
    unsealed : collection of str
        Keys of the records that earlier versions wrote without a seal. What has others and no
        seal is broken.
    """
    content = read_json(path)
    if content is None:
        return None
    seal = content.pop(SEAL, None)
    if seal is None:
        return Sealed(content, checked=False) if set(content) <= set(unsealed) else None
    return Sealed(content, checked=True) if seal == _digest(content) else None


def fingerprint(path: Path) -> Fingerprint:
    """Size and digest of a file; None where there is none."""
    try:
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            return [file.tell(), digest]
    except (FileNotFoundError, NotADirectoryError):
        return None


def misfit(path: Path, wanted: Fingerprint) -> str:
    """Difference of a file to what was written; "" if there is none."""
    try:
        size = path.stat().st_size if path.is_file() else None
        if wanted is None:
            return "" if size is None else "was not there"
        if size is None:
            return "is missing"
        if size != wanted[0]:
            return f"has {size:,} bytes instead of {wanted[0]:,}"
        return "" if fingerprint(path) == wanted else "has other bytes than were written"
    except OSError as error:
        return f"cannot be read ({(error.strerror or str(error)).lower()})"


# -------------------------------------------------------------------------- whose study it is
MARK = "study.json"
"""The file that says whose a folder is."""


def claim_folder(
    path: str | os.PathLike[str],
    study: Mapping[str, object],
    *,
    files: re.Pattern[str],
    unmarked: Callable[[Path], Mapping[str, object] | None] = lambda _: None,
    growing: tuple[str, ...] = (),
) -> Path:
    """A folder for the results of one study alone, made when missing.

    Parameters
    ----------
    path : path-like
        The folder: a new one, an empty one, or one of the same study.
    study : mapping
        What decides the results, ready for JSON, and the command that writes them.
    files : re.Pattern
        Names of what the command writes there.
    unmarked : callable, optional
        The part of ``study`` that files of these names say themselves, where nothing else says
        it, as in folders of earlier versions; None where they say nothing of their origin.
    growing : tuple of str, optional
        Keys of numbers that may be larger than they were: more of the same.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InvalidValue
        It holds another study or anything else, or cannot be made.
    """
    place = Path(path)
    if place.exists() and not place.is_dir():
        raise InvalidValue(
            f"{place} must be a folder, and a file of that name exists", code=Mistake.UNWRITABLE
        )
    record = read_record(place / MARK, ())
    held_study: Mapping[str, Any] | None = None if record is None else record.data
    if held_study is None and place.exists():
        names = sorted(entry.name for entry in place.iterdir() if not is_draft(entry.name, MARK))
        held_study = unmarked(place) if names else None
        # a mark that cannot be read beside results is a damaged one of theirs
        ours = [name for name in names if files.fullmatch(name) or name == MARK]
        strange = [name for name in names if name not in ours] or (
            ours if held_study is None else []
        )
        if strange:
            raise InvalidValue(
                f"{place} holds files that are not of thirdbody {study['command']} "
                f"({', '.join(strange[:3])}); give a new or an empty folder",
                code=Mistake.UNWRITABLE,
            )
    if held_study is not None:
        wanted = {key: study.get(key) for key in held_study} if record is None else dict(study)
        less = [key for key in growing if held_study.get(key, 0) > study[key]]
        kept = {key: value for key, value in wanted.items() if key not in growing or key in less}
        there = {
            key: value for key, value in held_study.items() if key not in growing or key in less
        }
        refuse_another(place, there, kept)
    make_folder(place)
    if record is None or differences(record.data, study):
        write_text(place / MARK, sealed_text(study))
    return place


def release_folder(place: Path) -> None:
    """Let go of a claimed folder that holds nothing yet."""
    if [entry.name for entry in place.iterdir()] == [MARK]:
        (place / MARK).unlink()
        with suppress(OSError):
            place.rmdir()


def refuse_replaced(folder: Path, texts: Mapping[str, str | None]) -> None:
    """Refuse to put files in the place of others than those of the same study.

    Parameters
    ----------
    folder : pathlib.Path
    texts : mapping
        Names of the files; of those that say what all of them are about, what they will hold.

    Raises
    ------
    InvalidValue
        One of them exists, and is of something else.
    """
    there = [name for name in texts if (folder / name).exists()]
    same = [
        text is not None and misfit(folder / name, print_of(text)) == ""
        for name, text in texts.items()
        if text is not None
    ]
    if there and not all(same):
        raise InvalidValue(
            f"{folder} holds {', '.join(there)} of another study, or of another program; "
            "give another folder, remove what is not needed, or replace it "
            + Advice("(--force, in Python force=True)", "(--force)"),
            code=Mistake.OTHER_STUDY,
        )


def print_of(text: str) -> Fingerprint:
    """The fingerprint of a file of this text."""
    held = text.encode()
    return [len(held), hashlib.sha256(held).hexdigest()]


def refuse_another(
    place: Path,
    held: Mapping[str, object],
    wanted: Mapping[str, object],
    *,
    derived: tuple[str, ...] = (),
    called: Callable[[str], str] = str,
) -> None:
    """Refuse a place that holds the results of another study.

    Parameters
    ----------
    place : pathlib.Path
    held, wanted : mapping
        What was studied there, and what is asked.
    derived : tuple of str, optional
        Keys that follow from the others, and are no difference of their own.
    called : callable, optional
        What a reader calls a dotted key.

    Raises
    ------
    InvalidValue
        They differ; the sentence says in what.
    """
    differ = [(key, *two) for key, two in differences(held, wanted).items() if key not in derived]
    if not differ:
        return
    rule = f"{place} holds another study: "
    for i, (key, a, b) in enumerate(differ[:MOST_SHOWN]):
        rule = rule + ", " * (i > 0) + called(key) + f" is {_say(a)} there and {_say(b, a)} here"
    rule += f", and {len(differ) - MOST_SHOWN} more" if len(differ) > MOST_SHOWN else ""
    here = Advice("give another folder", "give another folder with --out")
    hint = here + ", or remove this one if its results are not needed"
    raise InvalidValue(Problem("", rule, hint=hint, code=Mistake.OTHER_STUDY, source=str(place)))


def differences(
    old: Mapping[str, object], new: Mapping[str, object]
) -> dict[str, tuple[object, object]]:
    """Where two records differ, by dotted key."""
    flat_old, flat_new = _flat(old), _flat(json.loads(json.dumps(new)))
    return {
        key: (flat_old.get(key), flat_new.get(key))
        for key in {**flat_old, **flat_new}
        if flat_old.get(key) != flat_new.get(key)
    }


SUMMARY = {"values", "first", "last", "sha256"}
"""Keys under which a record tells a list that is too long for it."""


def _flat(data: object, path: str = "") -> dict[str, object]:
    if not isinstance(data, Mapping) or data.keys() == SUMMARY:
        return {path: data}
    out: dict[str, object] = {}
    for key, value in data.items():
        out |= _flat(value, f"{path}.{key}" if path else key)
    return out


def _say(value: object, other: object = None) -> str:
    """A value of a record in short, and whether a list only looks like the other one.

    >>> _say([1e-7, 1.5e-7, 1.6e-7, 1.7e-7, 3e-7])
    '1e-07 … 3e-07 (5 values)'
    >>> _say([1.0, 2.0, 3.0, 5.0, 9.0], [1.0, 2.0, 4.0, 5.0, 9.0])
    '1 … 9 (5 values, others between)'
    """
    if isinstance(value, list) and len(value) > FEW:
        value = {"values": len(value), "first": value[0], "last": value[-1]}
    if not isinstance(value, Mapping):
        text = json.dumps(value, ensure_ascii=False)
        return text if len(text) < 60 else f"{text[:50]} ..."
    first, last = (
        f"{end:.4g}" if isinstance(end, float) else json.dumps(end, ensure_ascii=False)[:60]
        for end in (value["first"], value["last"])
    )
    shown = f"{first} … {last} ({value['values']} values"
    alike = other is not None and _say(other) == f"{shown})"
    return shown + (", others between)" if alike else ")")
