"""A study as text: TOML to keep, and a link that reopens the page."""

from __future__ import annotations

import base64
import re
import tomllib
import zlib
from urllib.parse import quote

from ..errors import InvalidValue, Mistake
from ..quantities.say import unbroken
from ..study.toml_text import to_toml, toml_value
from .bounds import refuse_large, refuse_long_names

__all__ = [
    "LONGEST_LINK",
    "LONGEST_STUDY",
    "as_shown",
    "from_link",
    "from_toml",
    "in_ascii",
    "to_link",
    "to_toml",
    "toml_value",
    "with_micro",
    "without_paths",
]

LONGEST_STUDY = 200_000
"""Characters of a study file that the page reads."""
LONGEST_LINK = 16_000
"""Characters of a link that the page reads."""


def with_micro(text: str) -> str:
    """A text as it is shown: files write um, people µm.

    >>> with_micro("1 um, 2 um, sum")
    '1 µm, 2 µm, sum'
    """
    return re.sub(r"\bum\b", "µm", text)


def as_shown(text: str) -> str:
    """A sentence as it is shown: µm, and numbers beside their units where lines break.

    >>> as_shown("1 um")
    '1\\xa0µm'
    """
    return unbroken(with_micro(text))


def in_ascii(text: str) -> str:
    """The inverse of `with_micro`, for both signs in use.

    >>> in_ascii("1 µm")
    '1 um'
    """
    return re.sub(r"[\u00b5\u03bc]m\b", "um", text)


def without_paths(text: str) -> str:
    """A message without the folders of the machine that serves the page.

    >>> without_paths("cannot read /srv/page/a.x3p: it holds 3 / m^2")
    'cannot read a.x3p: it holds 3 / m^2'
    """
    name_pattern = r"[^\s/\\:'\",;<>()]+"
    return re.sub(
        rf"(?<![\w.:/<])(?:[A-Za-z]:)?(?:[/\\]{name_pattern})+[/\\](?={name_pattern})", "", text
    )


def from_toml(text: str) -> dict[str, object]:
    """The study that a text holds.

    Raises
    ------
    InvalidValue
        Text that is not TOML, too long, or a study larger than the page takes.
    """
    if len(text) > LONGEST_STUDY:
        raise InvalidValue(
            f"a study of {len(text)} characters is longer than {LONGEST_STUDY}",
            code=Mistake.TOO_LARGE,
        )
    refuse_long_names(text)
    try:
        study = tomllib.loads(text)
    except ValueError as error:  # of syntax, or a number of thousands of digits
        raise InvalidValue(f"this is not a study file: {error}", code=Mistake.FORM) from None
    except RecursionError:
        raise InvalidValue(
            "this is nested too deeply to be a study file", code=Mistake.FORM
        ) from None
    refuse_large(study)
    return study


def to_link(study: dict[str, object], at: float | None = None) -> str:
    """The query string that reopens a study at an operating load."""
    packed = zlib.compress(to_toml(study).encode(), 9)
    code = base64.urlsafe_b64encode(packed).decode().rstrip("=")
    return f"study={code}" + ("" if at is None else f"&at={quote(repr(at))}")


def from_link(code: str) -> dict[str, object]:
    """The study of a link.

    Raises
    ------
    InvalidValue
        A link that is cut, changed or too long.

    Examples
    --------
    >>> from_link(to_link({"title": "t"}).removeprefix("study="))
    {'title': 't'}
    """
    broken = "the link holds no study; it may have been cut when it was copied"
    if len(code) > LONGEST_LINK:
        raise InvalidValue(
            f"the link is longer than {LONGEST_LINK} characters", code=Mistake.TOO_LARGE
        )
    try:
        packed = base64.urlsafe_b64decode(code + "=" * (-len(code) % 4))
        text = zlib.decompressobj().decompress(packed, LONGEST_STUDY + 1).decode()
    except (ValueError, zlib.error):
        raise InvalidValue(broken, code=Mistake.FORM) from None
    if not text:
        raise InvalidValue(broken, code=Mistake.FORM)
    return from_toml(text)
