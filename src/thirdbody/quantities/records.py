"""Small files that a run leaves beside its results: sealed, and saying what other files hold."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import InvalidValue

__all__ = [
    "SEAL",
    "Fingerprint",
    "Record",
    "differences",
    "fingerprint",
    "misfit",
    "read_json",
    "read_record",
    "refuse_another",
    "sealed",
]

SEAL = "sha256"
"""Key under which a record says the digest of the rest of it."""

Fingerprint = list[Any] | None
"""Size in bytes and SHA-256 of a file; None for a file that there is not."""


class Record(NamedTuple):
    """What a small file says."""

    data: dict[str, Any]
    checked: bool
    """Whether a seal says that it is as it was written."""


def sealed(data: Mapping[str, Any]) -> str:
    """The text of a record that says its own digest.

    Examples
    --------
    >>> text = sealed({"states": 3})
    >>> list(json.loads(text))
    ['states', 'sha256']
    """
    return json.dumps({**data, SEAL: _digest(data)})


def _digest(data: Mapping[str, Any]) -> str:
    """SHA-256 of what a record says, whatever the order and the spaces of its text."""
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def read_json(path: Path) -> dict[str, Any] | None:
    """What a small file of JSON says; None where it is missing or broken."""
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def read_record(path: Path, unsealed: Collection[str]) -> Record | None:
    """What a record says; None where it is missing, broken or changed.

    Parameters
    ----------
    path : pathlib.Path
    unsealed : collection of str
        Keys of the records that earlier versions wrote without a seal. What has others and no
        seal is broken.
    """
    found = read_json(path)
    if found is None:
        return None
    seal = found.pop(SEAL, None)
    if seal is None:
        return Record(found, checked=False) if set(found) <= set(unsealed) else None
    return Record(found, checked=True) if seal == _digest(found) else None


def fingerprint(path: Path) -> Fingerprint:
    """Size and digest of a file; None where there is none."""
    try:
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            return [file.tell(), digest]
    except (FileNotFoundError, NotADirectoryError):
        return None


def misfit(path: Path, wanted: Fingerprint) -> str:
    """How a file differs from what was written; "" where it does not."""
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
def refuse_another(
    place: Path, found: Mapping[str, Any], wanted: Mapping[str, Any], *, derived: tuple[str, ...]
) -> None:
    """Refuse a place that holds the results of another study.

    Parameters
    ----------
    place : pathlib.Path
    found, wanted : mapping
        What was studied there, and what is asked.
    derived : tuple of str
        Keys that follow from the others, and are no difference of their own.

    Raises
    ------
    InvalidValue
        They differ; the sentence says in what.
    """
    differ = [(key, *two) for key, two in differences(found, wanted).items() if key not in derived]
    if not differ:
        return
    shown = "; ".join(f"{key} is {_say(a)} there and {_say(b)} here" for key, a, b in differ[:3])
    more = f"; and {len(differ) - 3} more" if len(differ) > 3 else ""
    raise InvalidValue(f"{place} holds another study: {shown}{more}; give another folder")


def differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, tuple[Any, Any]]:
    """Where two records differ, by dotted key."""
    flat_old, flat_new = _flat(old), _flat(json.loads(json.dumps(new)))
    return {
        key: (flat_old.get(key), flat_new.get(key))
        for key in {**flat_old, **flat_new}
        if flat_old.get(key) != flat_new.get(key)
    }


def _flat(data: Any, path: str = "") -> dict[str, Any]:
    if not isinstance(data, Mapping):
        return {path: data}
    out: dict[str, Any] = {}
    for key, value in data.items():
        out |= _flat(value, f"{path}.{key}" if path else key)
    return out


def _say(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:50]} ..."
