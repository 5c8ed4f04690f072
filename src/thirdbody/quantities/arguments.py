"""What an argument of a public function must be, read from its signature, and what is not so.

A function fails on what it cannot take wherever it first touches it, in words of Python about a
line that its user never wrote. `misfits` then says which argument it was and what it takes. It is
asked after a failure alone: what works is never refused, and nothing is slower.
"""

from __future__ import annotations

import ast
import inspect
import math
import os
import re
import sys
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from functools import cache, wraps
from numbers import Real
from typing import Any, Literal, NamedTuple, Self, TypeVar, get_origin

import numpy as np

from ..errors import InvalidValue, Mistake, Problem, WrongKind
from .nearest import guess

__all__ = [
    "FAILURES",
    "NamesArguments",
    "misfits",
    "names_arguments",
    "need_one",
    "need_place",
    "need_positive",
    "only_one",
    "refuse_misfits",
]

SPOKEN = {"separation": "d", "gap": "d", "load": "pressure", "p": "pressure", "speeds": "speed"}
"""Names that people say for arguments, which are no misspelling of them."""

LONGEST_MEANING = 80
"""Letters of what an argument is, above which only the first of its clauses is told."""
F = TypeVar("F", bound=Callable[..., Any])
FAILURES = (
    *(TypeError, AttributeError, ValueError, LookupError, ArithmeticError),
    *(NotImplementedError, AssertionError),
)
"""What Python and NumPy raise where they are given what they cannot take."""


def names_arguments(function: F) -> F:
    """Decorate a function: when it fails, the message names the argument that does not fit.

    Raises
    ------
    InvalidValue
        When it is called and fails: a sentence for each argument that does not fit. Failures with
        arguments that fit pass as they are.

    Examples
    --------
    >>> @names_arguments
    ... def tripled(path: str, *, times: int = 3) -> str:
    ...     return path.upper() * times
    >>> tripled("ab", times=2)
    'ABAB'
    >>> tripled(None)
    Traceback (most recent call last):
    thirdbody.errors.WrongKind: path = None must be text
    """

    @wraps(function)
    def with_names(*args: object, **named: object) -> Any:
        try:
            return function(*args, **named)
        except FAILURES as error:
            refuse_misfits(error, function, args, named)
            raise

    return with_names  # type: ignore[return-value]


class NamesArguments:
    """Base of classes whose constructors name an argument that is missing, or not one of theirs.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.Roughness(sigm=1e-7, R=2.8e-6)
    Traceback (most recent call last):
    thirdbody.errors.WrongKind: Roughness.sigm = 1e-07 is no argument; did you mean sigma?
    """

    __slots__ = ()

    def __new__(cls, *args: object, **named: object) -> Self:
        """An instance whose fields are still empty, unless a name is no argument of the class."""
        if cls.__init__ is object.__init__ and (args or named):
            return object.__new__(cls, *args, **named)  # which says that it takes none
        takes = _takes(cls)  # type: ignore[arg-type]
        if takes is not None and not args and not named:  # a copy in the making is given nothing
            if takes.needed and not hasattr(cls.__init__, "needs_some"):
                cls.__init__ = _needs_some(cls.__init__)  # type: ignore[method-assign]
        elif takes is not None:
            some = {*takes.in_order[: len(args)], *named}
            if len(args) > len(takes.in_order) or not takes.needed <= some <= takes.names:
                refuse_misfits(TypeError(), cls, args, named, where=cls.__name__)
        return object.__new__(cls)


def _needs_some(constructor: F) -> F:
    """Decorate a constructor: called with nothing at all it names what it needs.

    Only a constructor that is called so bears it, so that all other calls are as quick as before.
    """

    @wraps(constructor)
    def with_some(self: object, *args: object, **named: object) -> None:
        if not args and not named:
            kind = type(self)
            refuse_misfits(TypeError(), kind, (), {}, where=kind.__name__)
        constructor(self, *args, **named)

    with_some.needs_some = True  # type: ignore[attr-defined]
    return with_some  # type: ignore[return-value]


class _Takes(NamedTuple):
    """Names of arguments: all, those that may stand without their name, and those needed."""

    names: frozenset[str]
    in_order: tuple[str, ...]
    needed: frozenset[str]


@cache
def _takes(kind: type) -> _Takes | None:
    """What the constructor of a class takes; None where it takes any."""
    parameters = inspect.signature(kind).parameters.values()
    if any(one.kind in (one.VAR_KEYWORD, one.VAR_POSITIONAL) for one in parameters):
        return None
    return _Takes(
        frozenset(one.name for one in parameters),
        tuple(one.name for one in parameters if one.kind is not one.KEYWORD_ONLY),
        frozenset(one.name for one in parameters if one.default is one.empty),
    )


def need_one(name: str, value: object, *options: str | int) -> None:
    """Refuse a word or a number that is none of the options.

    Raises
    ------
    InvalidValue
        With the words it knows.

    Examples
    --------
    >>> need_one("basis", "loads", "area", "load")
    Traceback (most recent call last):
    thirdbody.errors.InvalidValue: basis = 'loads' must be 'area' or 'load'
    """
    if not (type(value) in (str, int) or isinstance(value, np.integer)) or value not in options:
        two = len(options) == 2
        allowed = (" or " if two else ", ").join(map(repr, options))
        shown = repr(value) if isinstance(value, str) else _short_text(value)
        rule = f"must be {'' if two else 'one of '}{allowed}"
        raise InvalidValue(Problem(name, rule, shown, code=Mistake.OPTION))


def only_one(**quantities: object) -> tuple[str, object]:
    """Name and value of the only quantity that is not None."""
    values = {name: value for name, value in quantities.items() if value is not None}
    if len(values) != 1:
        names = ", ".join(values) or "none"
        code = Mistake.CLASH if values else Mistake.MISSING
        raise InvalidValue(f"give exactly one of {', '.join(quantities)}; got {names}", code=code)
    return values.popitem()


def is_empty(name: str, hint: str) -> Problem:
    """Problem of an argument that holds nothing, and what to give.

    >>> is_empty("laws", "give at least one law")
    'laws is empty; give at least one law'
    """
    return Problem(name, "is empty", hint=hint, code=Mistake.EMPTY)


def need_place(name: str, value: Any, count: int) -> None:
    """Refuse what is no place in a list, from the end too.

    Raises
    ------
    InvalidValue
        With the places there are.

    Examples
    --------
    >>> need_place("at", 3, 2)
    Traceback (most recent call last):
    thirdbody.errors.InvalidValue: at = 3 must be a place in 2 values: 0 to 1
    """
    whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not whole or not -count <= value < count:
        values = "1 value" if count == 1 else f"{count} values"
        rule = f"must be a place in {values}: 0 to {count - 1}"
        raise InvalidValue(Problem(name, rule, _short_text(value), code=Mistake.RANGE))


def need_positive(**values: Any) -> None:
    """Refuse numbers, or arrays with one, that are not finite and above 0.

    Raises
    ------
    InvalidValue
        A sentence for each.

    Examples
    --------
    >>> need_positive(R=-1e-6, sigma_s=1e-8)
    Traceback (most recent call last):
    thirdbody.errors.InvalidValue: R = -1e-06 must be finite and > 0
    """
    problems = [
        Problem(name, "must be finite and > 0", _short_text(value), code=Mistake.RANGE)
        for name, value in values.items()
        if not np.all((np.asarray(value) > 0) & np.isfinite(value))
    ]
    if problems:
        raise InvalidValue(*problems)


def not_positive(**values: object) -> list[Problem]:
    """Problems of single numbers that are not finite and above 0, one each.

    Examples
    --------
    >>> not_positive(force=-1.0, bodies=9)
    ['force = -1.0 must be a finite number above 0']
    """
    return [
        Problem(name, "must be a finite number above 0", repr(value), code=Mistake.RANGE)
        for name, value in values.items()
        if not (isinstance(value, int | float | np.number) and math.isfinite(value) and value > 0)
    ]


def refuse_misfits(
    error: Exception,
    function: Callable[..., object],
    args: tuple[object, ...],
    named: Mapping[str, object],
    *,
    numbers: Container[str] = (),
    where: str = "",
) -> None:
    """Say after a failure which arguments do not fit; nothing where all do.

    Parameters
    ----------
    error : Exception
        What was raised.
    function : callable
        By what, or a class in the making.
    args, named : tuple, mapping
        What it was called with.
    numbers : container of str, optional
        Arguments that are numbers by their documentation, where the signature does not say.
    where : str, optional
        What the arguments belong to: "Finish".

    Raises
    ------
    WrongKind
        A sentence for each. An error of this library says more than a kind does, and passes.
    """
    if isinstance(error, InvalidValue) and not isinstance(error, WrongKind):
        return
    if problems := misfits(function, args, named, numbers=numbers):
        raise WrongKind(*(problem.move_under(where) for problem in problems)) from None


def misfits(
    function: Callable[..., object],
    args: tuple[object, ...],
    named: Mapping[str, object],
    *,
    numbers: Container[str] = (),
) -> list[Problem]:
    """Problems of arguments that the signature of a function refuses, one each.

    Examples
    --------
    >>> def pressed(load: float, *, places: Sequence[str] = ()) -> float: ...
    >>> misfits(pressed, (None,), {"places": 3})
    ['load = None must be a number', 'places = 3 must be a list of texts']
    >>> misfits(pressed, (1,), {"places": ["A_t"]})
    []
    >>> misfits(pressed, (1,), {"plces": ["A_t"]})
    ['plces = a list is no argument; did you mean places?']
    >>> misfits(pressed, (), {"lod": 1})
    ['lod = 1 is no argument; did you mean load?']
    >>> misfits(pressed, (), {"places": ["A_t"]})
    ['load is missing']
    >>> misfits(pressed, (1, ["A_t"]), {})
    ['a list stands without its name; write places=... here']
    """
    signature = inspect.signature(function)
    try:
        arguments = signature.bind_partial(*args, **named).arguments
    except TypeError:
        names = [name for name in signature.parameters if name not in ("self", "cls")]
        few = {name: value for name, value in named.items() if name in names}
        unknown = [
            Problem(
                name,
                "is no argument",
                _short_text(value),
                hint=guess(
                    name,
                    names,
                    meant=SPOKEN[name] if SPOKEN.get(name) in names else None,
                    meanings={name: _declared_meaning(function, name) for name in names},
                    otherwise="it takes ",
                ),
                code=Mistake.UNKNOWN,
            )
            for name, value in named.items()
            if name not in signature.parameters
        ]
        if not unknown:
            return _problem_without_name(signature, args)
        meant = {problem.meant for problem in unknown}
        return unknown + [
            problem for problem in _missing(function, args, few) if problem.path not in meant
        ]
    if missing := _missing(function, args, named):
        return missing
    problems = []
    for name, value in arguments.items():
        parameter = signature.parameters[name]
        if parameter.kind is parameter.VAR_KEYWORD:
            continue  # another function takes them
        node = _annotation_tree(parameter.annotation)
        if name in numbers and (node is None or _name(node) == "Any"):
            node = _tree("Number")
        if node is None or (value is parameter.default and value is not None):
            continue
        space = getattr(inspect.unwrap(function), "__globals__", {})
        for argument in value if parameter.kind is parameter.VAR_POSITIONAL else [value]:
            if not _fits(node, argument, space):
                words = " or ".join(dict.fromkeys(_words(node, space)))
                problems.append(
                    Problem(name, f"must be {words}", _short_text(argument), code=Mistake.KIND)
                )
    return problems


def _problem_without_name(signature: inspect.Signature, args: tuple[object, ...]) -> list[Problem]:
    """The problem of the first argument that has no name and needs one; none where none has."""
    parameters = signature.parameters.values()
    in_order = [one for one in parameters if one.kind is not one.KEYWORD_ONLY]
    names = [f"{one.name}=..." for one in parameters if one.kind is one.KEYWORD_ONLY]
    if len(args) <= len(in_order) or not names:
        return []
    rule = f": {_short_text(args[len(in_order)])} stands without its name"
    which = names[0] if len(names) == 1 else f"one of {', '.join(names)}"
    return [Problem("", rule, hint=f"write {which} here", code=Mistake.MISSING)]


def _missing(
    function: Callable[..., object], args: tuple[object, ...], named: Mapping[str, object]
) -> list[Problem]:
    """Problems of arguments that a function needs and is not given, each with what it is."""
    signature = inspect.signature(function)
    try:
        arguments = signature.bind_partial(*args, **named).arguments
    except TypeError:
        return []
    needed = (
        name
        for name, one in signature.parameters.items()
        if one.default is one.empty
        and one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)
        and name not in arguments
        and name not in ("self", "cls")
    )
    return [
        Problem(name, f"is missing{_meaning(function, name)}", code=Mistake.MISSING)
        for name in needed
    ]


def _meaning(function: Callable[..., object], name: str) -> str:
    """What an argument is: as its quantity declares it, else as the docstring says."""
    if declared := _declared_meaning(function, name):
        return f": {declared}"
    entries = entries_of(inspect.getdoc(function) or "").items()
    kind, words = next((entry for names, entry in entries if name in names.split(", ")), ("", ""))
    about = re.split(r"[.:;](?:\s|$)", words.replace("`", ""), maxsplit=1)[0] or kind
    if len(about) > LONGEST_MEANING:
        about = about.partition(", ")[0]
    return f": {about}" if about else ""


def _declared_meaning(function: Callable[..., object], name: str) -> str:
    """What a field of a class declares an argument to be; "" where it does not."""
    field = getattr(function, "__dataclass_fields__", {}).get(name)
    metadata = getattr(field, "metadata", {})
    if about := metadata.get("quantity"):
        return words_of_quantity(name, about)
    if about := metadata.get("choice") or metadata.get("several"):
        return f"{about['meaning']}" + (f" [{about['unit']}]" if "unit" in about else "")
    return ""


def words_of_quantity(name: str, about: Mapping[str, object]) -> str:
    """Meaning of a quantity, with its symbol where that is not its name, and its unit.

    >>> words_of_quantity("eta", {"symbol": "η", "unit": "Pa s", "meaning": "viscosity"})
    'viscosity η [Pa s]'
    """
    symbol, unit = about["symbol"], about["unit"]
    shown = f"{about['meaning']}" + (f" {symbol}" if symbol != name else "")
    return shown + (f" [{unit}]" if unit != "1" else "")


def entries_of(docstring: str) -> dict[str, tuple[str, str]]:
    """Arguments that a docstring in the style of numpydoc describes: types, and what they are.

    >>> entries_of('''One line.
    ...
    ...     Parameters
    ...     ----------
    ...     load, R : float
    ...         Force [N] and radius [m].
    ...     seed : int
    ...         Of the generator.
    ... ''')
    {'load, R': ('float', 'Force [N] and radius [m].'), 'seed': ('int', 'Of the generator.')}
    """
    text = inspect.cleandoc(docstring)
    section = re.search(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}|\Z)", text, re.S | re.M)
    entries = {}
    for entry in re.split(r"^(?=\S)", section[1], flags=re.M) if section else ():
        if head := re.match(r"(\*{0,2}\w+(?:, *\w+)*) : *([^\n]*)", entry):
            entries[head[1]] = head[2], " ".join(entry[head.end() :].split())
    return entries


def _annotation_tree(annotation: object) -> ast.expr | None:
    """The tree of an annotation; None where there is none."""
    if annotation is inspect.Parameter.empty:
        return None
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "")
    return _tree(text)


@cache
def _tree(text: str) -> ast.expr | None:
    try:
        return ast.parse(text, mode="eval").body
    except SyntaxError:
        return None


def _short_text(value: object) -> str:
    """A value in a few letters."""
    if value is None or isinstance(value, (str, bytes, bool, int, float, complex)):
        text = repr(value) if not isinstance(value, int) or value.bit_length() < 200 else "..."
        return text if len(text) <= 60 else text[:56] + " ..."
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    kind = value.__name__ if isinstance(value, type) else type(value).__name__
    article = "an" if kind[:1].lower() in "aeiou" else "a"
    if isinstance(value, type):
        return f"the class {kind}"
    if isinstance(value, (list, tuple, dict, set)) and not value:
        return f"an empty {kind}"
    return f"{article} {kind}"


# ------------------------------------------------------------------ what fits
def _is_number(value: object) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return False
    if isinstance(value, np.ndarray) or hasattr(value, "__array__"):
        return np.size(value) == 1 and np.asarray(value).dtype.kind in "iuf"
    return isinstance(value, Real) or (
        hasattr(value, "__float__") and not isinstance(value, (complex, type))
    )


def _is_whole(value: Any) -> bool:
    return _is_number(value) and float(value).is_integer()


def _are_numbers(value: object) -> bool:
    if isinstance(value, (str, bytes, Mapping, type)) or value is None:
        return False
    if _is_number(value):
        return True
    if not isinstance(value, Iterable) and not hasattr(value, "__array__"):
        return False
    if isinstance(value, Iterator):
        return True  # it is not used up to look at it
    try:
        array = np.asarray(value)
        return array.dtype.kind in "iuf" or array.astype(float).dtype.kind == "f"
    except (TypeError, ValueError):
        return False


def _is_array(value: object) -> bool:
    """A number or an array, which are computed with as they are: no list."""
    return _are_numbers(value) and (not isinstance(value, Iterable) or hasattr(value, "__array__"))


def _is_listed(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, (str, bytes, Mapping))


LEAVES: dict[str, tuple[Callable[[Any], bool], str]] = {
    "None": (lambda value: value is None, "None"),
    "float": (_is_number, "a number"),
    "int": (_is_whole, "a whole number"),
    "bool": (lambda value: isinstance(value, (bool, np.bool_, int)), "True or False"),
    "str": (lambda value: isinstance(value, str), "text"),
    "Path": (lambda value: isinstance(value, os.PathLike), "the path of a file"),
    "PathLike": (lambda value: isinstance(value, os.PathLike), "the path of a file"),
    "Number": (_is_array, "a number or an array of numbers"),
    "ArrayLike": (_are_numbers, "a number or an array of numbers"),
    "Array": (_is_array, "a number or an array of numbers"),
    "NDArray": (_are_numbers, "an array of numbers"),
    "ndarray": (_are_numbers, "an array of numbers"),
    "Callable": (callable, "a function"),
    "Any": (lambda value: True, "anything"),
    "Literal": (lambda value: isinstance(value, str), "text"),
}
LISTS = {"Sequence", "Iterable", "list", "tuple", "Collection"}
MAPPINGS = {"Mapping", "dict", "MutableMapping"}
UNIONS = {"Union", "Optional"}


def _alternatives(node: ast.expr) -> Iterator[ast.expr]:
    """The parts of a union."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
        yield from _alternatives(node.left)
        yield from _alternatives(node.right)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str) and _tree(node.value):
        yield from _alternatives(_tree(node.value))  # type: ignore[arg-type]
    else:
        yield node


def _name(node: ast.expr) -> str:
    """The last name of a leaf: "PathLike" of os.PathLike[str]."""
    if isinstance(node, ast.Subscript):
        return _name(node.value)
    if isinstance(node, ast.Attribute):
        return node.attr
    if isinstance(node, ast.Constant):
        return str(node.value)
    return node.id if isinstance(node, ast.Name) else ""


def _inside(node: ast.expr) -> list[ast.expr]:
    """Types in the brackets of a leaf."""
    if not isinstance(node, ast.Subscript):
        return []
    return list(node.slice.elts) if isinstance(node.slice, ast.Tuple) else [node.slice]


def _fits(node: ast.expr, value: object, space: Mapping[str, object]) -> bool:
    return any(_fits_one(alternative, value, space) for alternative in _alternatives(node))


def _fits_one(node: ast.expr, value: Any, space: Mapping[str, object]) -> bool:
    name, inside = _name(node), _inside(node)
    if name in LEAVES:
        return LEAVES[name][0](value)
    if name in LISTS:
        if not _is_listed(value):
            return False
        if name == "tuple" and len(inside) > 1 and _name(inside[-1]) != "Ellipsis":
            return (
                hasattr(value, "__len__")
                and len(value) == len(inside)
                and all(
                    _fits(one, element, space) for one, element in zip(inside, value, strict=True)
                )
            )
        if not inside or isinstance(value, Iterator):
            return True
        return all(_fits(inside[0], element, space) for element in value)
    if name in MAPPINGS:
        return isinstance(value, Mapping) and (
            len(inside) != 2
            or all(
                _fits(inside[0], key, space) and _fits(inside[1], element, space)
                for key, element in value.items()
            )
        )
    if _are_words(name, space):
        return isinstance(value, str)
    kind = _kind(name, space)
    return kind is None or isinstance(value, kind)


def _are_words(name: str, space: Mapping[str, object]) -> bool:
    """Whether an annotation names a `Literal`."""
    return get_origin(space.get(name)) is Literal


def _kind(name: str, space: Mapping[str, object]) -> type | None:
    """Class that an annotation names; None for anything else, or if it is not known."""
    named_class = space.get(name)
    if named_class is None:  # imported for types alone
        held = (vars(module).get(name) for key, module in list(sys.modules.items())
                if key.startswith("thirdbody") and module is not None)  # fmt: skip
        named_class = next((member for member in held if member is not None), None)
    if not isinstance(named_class, type) or getattr(named_class, "_is_protocol", False):
        return None
    return named_class


def _words(node: ast.expr, space: Mapping[str, object]) -> Iterator[str]:
    """Values that an annotation takes, in words."""
    names = [_name(alternative) for alternative in _alternatives(node)]
    for alternative, name in zip(_alternatives(node), names, strict=True):
        if name == "str" and ("PathLike" in names or "Path" in names):
            continue  # the text is the path
        if name in LEAVES:
            yield LEAVES[name][1]
        elif name in LISTS:
            inner = _inside(alternative)
            exact = name == "tuple" and len(inner) > 1 and _name(inner[-1]) != "Ellipsis"
            if exact:
                yield f"{len(inner)} values, " + " and ".join(
                    " or ".join(_words(one, space)) for one in inner
                )
            else:
                yield f"a list of {_many(inner, space)}" if inner else "a list"
        elif name in MAPPINGS:
            yield "a mapping (dict) of names" if _inside(alternative) else "a mapping (dict)"
        elif _are_words(name, space):
            yield "text"
        elif name:
            article = "an" if name[0] in "AEIOU" else "a"
            yield f"{article} {name}"


PLURALS = {"text": "texts", "a number": "numbers", "a whole number": "whole numbers"}


def _many(inner: Sequence[ast.expr], space: Mapping[str, object]) -> str:
    words = " or ".join(dict.fromkeys(_words(inner[0], space)))
    return PLURALS.get(words, f"which each is {words}")
