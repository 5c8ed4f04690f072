"""Errors and warnings of this library: what can go wrong, in one hierarchy.

A message says what, where, what is allowed, and the likely cause.

- `ThirdBodyError`: the base of every error, to catch them all
- `InvalidValue`: an input has no meaning; it holds each `Problem`, which has a kind, a `Mistake`
- `WrongKind`: an `InvalidValue` and `TypeError`, of arguments that a signature refuses
- `UnknownMaterial`: an `InvalidValue` and `KeyError`, of a name that no material has
- `NoEquilibrium`: no separation carries the load
- `NoTransition`: the contact mode does not change
- `RangeWarning`: a model is used beyond its range; it holds a `Note`, which says by how much
- `SlowWarning`: what is asked takes long
"""

from __future__ import annotations

import math
import os
import re
import sys
import warnings
from collections.abc import Callable, Iterable
from enum import IntEnum, StrEnum
from types import FrameType
from typing import Self

__all__ = [
    "InvalidValue",
    "Mistake",
    "NoEquilibrium",
    "NoTransition",
    "Note",
    "Problem",
    "RangeWarning",
    "SlowWarning",
    "ThirdBodyError",
    "UnknownMaterial",
    "WrongKind",
]


def __dir__() -> list[str]:
    return sorted(__all__)


class ThirdBodyError(Exception):
    """Base class of every error that this library raises on purpose."""


class Advice(str):
    """Advice in words of Python, with the same advice for the reader of a study file.

    Sentences put together with ``+`` keep both.

    Examples
    --------
    >>> text = "use " + Advice("particle.Series", 'particle_law.name = "series"') + ", or no shape"
    >>> print(text)
    use particle.Series, or no shape
    >>> print(in_study(text))
    use particle_law.name = "series", or no shape
    """

    study: str

    def __new__(cls, python: str, study: str) -> Self:
        self = super().__new__(cls, python)
        self.study = study
        return self

    def __reduce__(self) -> tuple[type[Advice], tuple[str, str]]:
        return type(self), (str(self), self.study)

    def __add__(self, other: str) -> Advice:
        return Advice(str(self) + str(other), self.study + in_study(other))

    def __radd__(self, other: str) -> Advice:
        return Advice(other + str(self), in_study(other) + self.study)

    def removeprefix(self, prefix: str, /) -> Advice:
        return Advice(super().removeprefix(prefix), self.study.removeprefix(prefix))


def in_study(text: str) -> str:
    """A sentence in the words of a study file; itself where it names nothing of Python."""
    return getattr(text, "study", text)


class Mistake(StrEnum):
    """Kind of a mistake in an input: the same whatever its sentence says of the numbers.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.errors.Problem("sigma", "must be > 0", "-1", code=tb.errors.Mistake.RANGE).code
    <Mistake.RANGE: 'range'>
    >>> must = tb.errors.Mistake.KIND.clause("must be a number")
    >>> must, tb.errors.Problem("sigma", must, "'a'").code is tb.errors.Mistake.KIND
    ('must be a number', True)
    """

    RANGE = "range"
    """A number outside the range allowed, or not finite."""
    KIND = "kind"
    """Another kind of value than the one needed: a text for a number, a truth value, an object."""
    UNIT = "unit"
    """A unit that is unknown, missing, or of another dimension."""
    OPTION = "option"
    """A word that is none of the few allowed."""
    UNKNOWN = "unknown"
    """A name that nothing here has: a key, a field, an input, a column, a material."""
    MISSING = "missing"
    """Something that is needed and not given."""
    EMPTY = "empty"
    """A list or a file that holds nothing to work with."""
    SHAPE = "shape"
    """Another number of values, or of dimensions, than is needed."""
    ORDER = "order"
    """Numbers that stand in the wrong order: a low end above the high one."""
    CLASH = "clash"
    """Inputs that cannot stand side by side, or say the same thing twice."""
    IDLE = "idle"
    """An input that has no meaning or no effect without, or beside, another."""
    FULL = "full"
    """More particles than there is room for."""
    BEYOND = "beyond"
    """A case that the model, the law, the data or the method does not cover."""
    FORM = "form"
    """Text that is not written in the form that is read."""
    UNREADABLE = "unreadable"
    """A file that cannot be read."""
    UNWRITABLE = "unwritable"
    """A file or a folder that cannot be written, or is not this run's to replace."""
    DAMAGED = "damaged"
    """A kept result that has been changed or lost."""
    OTHER_STUDY = "other study"
    """A kept result of another study or another version."""
    TOO_LARGE = "too large"
    """More than memory, a file or the time allowed can hold."""
    ABSENT = "absent"
    """A package, a program or a server that is not there."""
    UNSAID = "unsaid"
    """A mistake that gives no code: one of code of your own."""

    def clause(self, text: str) -> Clause:
        """What is wrong, as a clause that keeps this code."""
        return Clause(text, self)


class Clause(str):
    """What is wrong with a value, or what is allowed, with the code of the mistake."""

    code: Mistake
    study: str
    """Itself in the words of study files."""

    def __new__(cls, text: str, code: Mistake) -> Self:
        self = super().__new__(cls, text)
        self.code, self.study = code, in_study(text)
        return self

    def __reduce__(self) -> tuple[type[Clause], tuple[Advice, Mistake]]:
        return type(self), (Advice(str(self), self.study), self.code)


def _hint_apart(rule: str, hint: str) -> tuple[str, str]:
    """A rule without the hint that stands behind a semicolon in it, and the whole hint.

    >>> _hint_apart("must be > 0; leave out the minus sign", "")
    ('must be > 0', 'leave out the minus sign')
    """
    rule_alone, semicolon, rest = rule.partition("; ")
    if not semicolon:
        return rule, hint
    rule_in_study, _, rest_in_study = in_study(rule).partition("; ")
    behind = Advice(rest, rest_in_study) if in_study(rule) != rule else rest
    apart = Advice(rule_alone, rule_in_study) if rule_in_study != rule_alone else rule_alone
    return apart, behind + ("; " + hint) if hint else behind


class Problem(str):
    """One mistake in an input: its parts, and as text the sentence that they make.

    Whoever knows more of a mistake (which table of a file, which argument) moves it with
    `move_under` or `changed`, and never has to read the sentence.

    Parameters
    ----------
    path : str
        Dotted place of the mistake in ``owner``; "" where it is not of one place. An option of the
        command line keeps its dashes.
    rule : str
        What is wrong, or what is allowed, as a clause that follows place and value. One that
        begins with a colon is a sentence of its own, with a comma a list of which this is the
        first; one that begins with "=" says the value itself.
    value : str, optional
        The value, as a reader sees it; None where the rule needs none.
    hint : str, optional
        The likely cause, or what to do.
    owner : str, optional
        What ``path`` is a part of: a class, a table of a study file.
    code : Mistake, optional
        Kind of the mistake; that of a ``rule`` that is a `Clause` by default.
    source : str, optional
        What holds a mistake that has no place in the inputs, as the rule names it: a file, a word
        of the command line.

    Examples
    --------
    >>> import thirdbody as tb
    >>> found = tb.errors.Problem(
    ...     "sigma", "must be > 0", "-1", hint="m are meant", owner="Roughness"
    ... )
    >>> str(found), found.place
    ('Roughness.sigma = -1 must be > 0; m are meant', 'Roughness.sigma')
    >>> str(found.move_under("roughness"))
    'roughness.sigma = -1 must be > 0; m are meant'
    """

    path: str
    rule: str
    value: str | None
    hint: str
    owner: str
    code: Mistake
    source: str

    def __new__(
        cls,
        path: str,
        rule: str,
        value: str | None = None,
        *,
        hint: str = "",
        owner: str = "",
        code: Mistake | None = None,
        source: str = "",
    ) -> Problem:
        if code is None:
            code = rule.code if isinstance(rule, Clause) else Mistake.UNSAID
        rule, hint = _hint_apart(rule, hint)
        place = ".".join(filter(None, (owner, path)))
        equals = " " if place.startswith("--") else " = "
        start = place if value is None or rule[:1] == "=" else f"{place}{equals}{value}"
        blank = " " if start and rule[:1] not in (":", ",") else ""
        rule = rule if start else rule.removeprefix(": ")
        self = super().__new__(cls, f"{start}{blank}{rule}" + (f"; {hint}" if hint else ""))
        self.path, self.rule, self.value, self.hint, self.owner = path, rule, value, hint, owner
        self.code, self.source = code, source
        return self

    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, object]]:
        return (), vars(self)

    @property
    def place(self) -> str:
        """The dotted place, from the outermost name that is known."""
        return ".".join(filter(None, (self.owner, self.path)))

    @property
    def meant(self) -> str | None:
        """The name that was probably meant, where one is guessed."""
        return getattr(self.hint, "meant", None)

    @property
    def study(self) -> str:
        """Its sentence in the words of study files."""
        return str(self.put_in_words(in_study))

    def changed(self, **changes: object) -> Problem:
        """The same mistake with some of its parts changed."""
        return Problem(**{**vars(self), **changes})

    def put_in_words(self, how: Callable[[str], str]) -> Problem:
        """The same mistake in other words, at the same place."""
        value = None if self.value is None else how(self.value)
        return self.changed(rule=how(self.rule), value=value, hint=how(self.hint))

    def move_under(self, owner: str) -> Problem:
        """The same mistake where what it is a part of goes by another name."""
        whole = not self.path and not self.owner
        return self.changed(owner=owner, rule=": " + self.rule if whole else self.rule)

    def put_at(self, path: str, value: str | None = None, *, sign: str = "=") -> Problem:
        """The same mistake at the place where what it is about stands.

        >>> from thirdbody.errors import Problem
        >>> mistake = Problem("", "5 nmm has the unit nmm", hint="did you mean nm?")
        >>> mistake.put_at("sigma", '"5 nmm"')
        'sigma = 5 nmm has the unit nmm; did you mean nm?'
        """
        rule = f"{sign} {self.changed(hint='')}"
        return Problem(path, rule, value, hint=self.hint, code=self.code)


class Note(str):
    """A doubt about an answer: its sentence, its effect on the answer, and what to do.

    Parameters
    ----------
    what : str
        Where the model ends, and what is known of it there.
    code : str, optional
        What it is about, the same whatever its numbers are.
    effect : float, optional
        By how much the answer may be wrong, relative [1]; NaN where nobody knows.
    action : str, optional
        What to do about it.

    Examples
    --------
    >>> import thirdbody as tb
    >>> note = tb.errors.Note(
    ...     "A_t reaches 0.3", code="area", effect=0.17, action="press it point by point"
    ... )
    >>> str(note)
    'A_t reaches 0.3; press it point by point'
    """

    code: str
    effect: float
    action: str
    study: str
    """Its sentence in the words of study files."""

    def __new__(
        cls, what: str, *, code: str = "", effect: float = math.nan, action: str = ""
    ) -> Self:
        sentence = what + "; " + action if action else what
        self = super().__new__(cls, sentence)
        self.code, self.effect, self.action = code, effect, action
        self.study = in_study(sentence)
        return self

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, object]]:
        return (str(self),), {"code": self.code, "effect": self.effect}


UNKNOWN = 0.2
"""Effect among which one that nobody knows is ranked."""


NUMBERS = re.compile(r"\d+(\.\d+)?(?= %)|\d+\.\d+(e[+-]\d+)?|\d+e[+-]\d+")
"""Numbers of a sentence in which states differ, unlike those of names."""


def code_of(note: str) -> str:
    """Code of a note; for a plain sentence, the sentence without its numbers.

    >>> code_of(Note("A_t reaches 0.3", code="area")), code_of("12 % of the load")
    ('area', ' % of the load')
    """
    return getattr(note, "code", "") or NUMBERS.sub("", note)


def note_of(message: Warning | str) -> str:
    """The note that a warning carries; a note itself, with the words that it has for studies."""
    if isinstance(message, str):
        return message
    return next(iter(message.args), str(message))


def note_data(note: str) -> dict[str, object]:
    """A note taken apart for JSON; of a plain sentence only that is known.

    Its effect is relative [1], None where nobody knows.

    >>> note_data(Note("A_t reaches 0.3", code="area", effect=0.17))
    {'code': 'area', 'effect': 0.17, 'action': '', 'sentence': 'A_t reaches 0.3'}
    """
    effect = getattr(note, "effect", math.nan)
    return {
        "code": getattr(note, "code", ""),
        "effect": None if math.isnan(effect) else effect,
        "action": getattr(note, "action", ""),
        "sentence": str(note),
    }


def problem_data(problem: Problem) -> dict[str, str | None]:
    """A mistake taken apart for JSON, in the words of study files.

    >>> found = Problem("sigma", Mistake.RANGE.clause("must be > 0"), "-1", owner="roughness")
    >>> problem_data(found)["code"], problem_data(found)["path"], problem_data(found)["allowed"]
    ('range', 'roughness.sigma', 'must be > 0')

    Nothing stands in it twice: of a text the quotes are left out, which JSON has itself, and what
    is wrong is said by the sentence alone where that is all of it.

    >>> problem_data(Problem("law", "is not known", "'zcm'"))["value"]
    'zcm'
    >>> problem_data(Problem("", "give a load"))["allowed"]
    ''
    """
    here = problem.put_in_words(in_study)
    rule = here.rule.removeprefix("= ").removeprefix(here.value or "").lstrip(":,= ")
    return {
        "code": str(here.code),
        "path": here.place or here.source,
        "value": None if here.value is None else _without_quotes(here.value),
        "allowed": "" if rule == str(here) else rule,
        "hint": str(here.hint),
        "meant": problem.meant,
        "sentence": str(here),
    }


def _without_quotes(shown: str) -> str:
    """A text as it is, of one that is shown in quotes."""
    quoted = len(shown) > 1 and shown[0] == shown[-1] and shown[0] in "\"'"
    return shown[1:-1] if quoted and shown[0] not in shown[1:-1] else shown


def place_note(note: str, place: str) -> Note:
    """The note of an answer at a place that is named first, such as a critical load.

    >>> here = place_note(Note("A_t reaches 0.3", code="area", effect=0.17), "F_cr1")
    >>> str(here), here.code, here.effect
    ('at F_cr1, A_t reaches 0.3', 'area', 0.17)
    """
    return PlacedNote(note, place)


class PlacedNote(Note):
    """A note of an answer at a place; see `place_note`."""

    place: str
    plain: str
    """What is said there."""

    def __new__(cls, note: str, place: str) -> PlacedNote:
        sentence = f"at {place}, " + Advice(str(note), in_study(note))
        effect = getattr(note, "effect", math.nan)
        self = super().__new__(cls, sentence, code=code_of(note), effect=effect)
        self.plain, self.place = note, place
        return self

    def __getnewargs_ex__(self) -> tuple[tuple[str, str], dict[str, object]]:  # type: ignore[override]
        return (self.plain, self.place), {}


def gather_places(notes: Iterable[str]) -> list[str]:
    """Notes, of which those that say the same of several places name all of these.

    >>> gather_places([place_note("A_t reaches 0.3", name) for name in ("F_cr1", "F_cr2")])
    ['at F_cr1 and F_cr2, A_t reaches 0.3']
    """
    out: dict[str, str] = {}
    for note in notes:
        plain = note.plain if isinstance(note, PlacedNote) else note
        before = out.get(plain)
        if isinstance(note, PlacedNote) and isinstance(before, PlacedNote):
            note = PlacedNote(plain, f"{before.place} and {note.place}")
        out[plain] = note
    return list(out.values())


def rank_notes(notes: Iterable[str]) -> list[str]:
    """Notes by their effect on the answer, the largest first; of each code the worst alone.

    >>> rank_notes(["b", Note("a", code="area", effect=0.1), Note("c", code="area", effect=0.3)])
    ['c', 'b']
    """

    def effect(note: str) -> float:
        has_effect = isinstance(note, Note) and not math.isnan(note.effect)
        return note.effect if has_effect else UNKNOWN  # type: ignore[attr-defined]

    worst: dict[str, str] = {}
    for note in sorted(notes, key=effect, reverse=True):
        worst.setdefault(code_of(note), note)
    return list(worst.values())


class InvalidValue(ThirdBodyError, ValueError):
    """An input has no meaning: negative, NaN, wrong dimension, unknown name.

    ``problems`` holds one `Problem` per mistake, so that a user mends all of them at once.

    Parameters
    ----------
    *problems : str or Problem
        The mistakes.
    code : Mistake, optional
        Kind of those that are plain sentences.
    source : str, optional
        What holds the mistakes of those.
    """

    def __init__(self, *problems: str, code: Mistake | None = None, source: str = ""):
        self.problems = tuple(
            problem
            if isinstance(problem, Problem)
            else Problem("", problem, code=code, source=source)
            for problem in problems
        )
        super().__init__("\n".join(problems))

    @property
    def code(self) -> Mistake:
        """Kind of the first of its mistakes."""
        return self.problems[0].code if self.problems else Mistake.UNSAID

    def move_under(self, owner: str) -> InvalidValue:
        """The same mistakes where what they are a part of goes by another name."""
        return type(self)(*(problem.move_under(owner) for problem in self.problems))

    def name_source(self, source: str | os.PathLike[str]) -> InvalidValue:
        """The same mistakes, which a file holds."""
        return type(self)(*(problem.changed(source=str(source)) for problem in self.problems))


class NoEquilibrium(ThirdBodyError, RuntimeError):
    """No separation inside the searched range carries the load.

    Parameters
    ----------
    message : str
        Why there is none.
    status : IntEnum, optional
        The `Status` of such a state; None where it is none of these.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.errors.NoEquilibrium("the load is too small", tb.results.Status.TOO_LITTLE).status.word
    'no_equilibrium_below'
    """

    def __init__(self, message: str = "", status: IntEnum | None = None):
        super().__init__(message)
        self.status = status


class NoTransition(ThirdBodyError, RuntimeError):
    """The contact mode does not change inside the loads searched."""


class WrongKind(InvalidValue, TypeError):
    """Error for arguments that a signature refuses; an outer function may know better names.

    It is a `TypeError` too, as Python raises for such a call.
    """


class UnknownMaterial(InvalidValue, KeyError):
    """A name that no material of the library has; a `KeyError` too, as of a dict.

    Examples
    --------
    >>> import thirdbody as tb
    >>> try:
    ...     tb.materials["S45"]
    ... except tb.errors.UnknownMaterial as error:
    ...     print(error.problems[0].meant)
    S45C
    """

    __str__ = Exception.__str__


class NotCompiled(Exception):
    """The compiled engine does not know these inputs, and why; the NumPy engine takes them.

    Raised and caught inside the library only.
    """


class RangeWarning(UserWarning):
    """A model is used outside the range for which it was derived or published.

    Its first argument is the `Note` that it tells.
    """


class SlowWarning(UserWarning):
    """What is asked takes more than some seconds: how long, and why."""


_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep
_DATACLASSES = os.sep + "dataclasses.py"


def tell_of_range(message: str | Warning, kind: type[Warning] = RangeWarning) -> None:
    """Warn, of a range or whatever `kind` says, at the line of the user that called the library."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and is_inside(frame):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, kind, stacklevel=level)


def is_inside(frame: FrameType) -> bool:
    """Whether a frame runs code of this library, or code generated for its dataclasses."""
    code = frame.f_code
    of_dataclass = code.co_filename == "<string>" and code.co_name == "__init__"
    return of_dataclass or code.co_filename.startswith(_HERE) or _DATACLASSES in code.co_filename
