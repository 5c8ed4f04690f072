"""The name that was probably meant: one maker of "did you mean"."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from typing import Self

__all__ = ["Guess", "guess", "near_path", "nearest_word", "no_attribute"]


class Guess(str):
    """A hint that asks for the name that was probably meant, which it keeps beside other words.

    >>> guess("sigm", ["R", "sigma"]).meant, guess("x", ["R", "sigma"]).meant
    ('sigma', None)
    >>> (guess("sigm", ["R", "sigma"]) + "; m are meant").meant
    'sigma'
    """

    meant: str | None

    def __new__(cls, text: str, meant: str | None) -> Self:
        self = super().__new__(cls, text)
        self.meant = meant
        return self

    def __add__(self, other: str) -> Guess:
        return Guess(str(self) + other, self.meant)

    def __radd__(self, other: str) -> Guess:
        return Guess(other + str(self), self.meant)

    def __reduce__(self) -> tuple[type[Guess], tuple[str, str | None]]:
        return type(self), (str(self), self.meant)


def nearest_word(word: str, options: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """The option that is most like a word, whatever its case; None where none is.

    >>> nearest_word("Sigm", ["R", "sigma"]), nearest_word("x", ["R", "sigma"])
    ('sigma', None)
    """
    folded = {option.casefold(): option for option in reversed(list(options))}
    matches = difflib.get_close_matches(word.casefold(), folded, n=1, cutoff=cutoff)
    return folded[matches[0]] if matches else None


def near_path(name: str, paths: Iterable[str]) -> str | None:
    """The dotted name that was probably meant.

    A sibling with a like name comes first, then the same last name below the same first one.

    >>> paths = ["particles.areal_density", "particles.diameter.mean", "roughness.sigma"]
    >>> near_path("roughness.sigm", paths), near_path("particles.mean", paths)
    ('roughness.sigma', 'particles.diameter.mean')
    >>> near_path("particles.colour", paths), near_path("rougness.sigma", paths)
    (None, 'roughness.sigma')
    """
    owner, _, last = name.rpartition(".")
    every = [(path, *path.rpartition(".")[::2]) for path in paths]
    beside = {leaf: path for path, above, leaf in every if above == owner}
    if meant := nearest_word(last, beside):
        return beside[meant]
    if below := [path for path, _, _ in every if path.startswith(f"{name}.")]:
        return nearest_word(name, below, cutoff=0.0)
    start = owner.partition(".")[0]
    inside = [(path, leaf) for path, _, leaf in every if path.startswith(start)]
    same = [path for path, leaf in inside if leaf.casefold() == last.casefold()]
    if same:
        return nearest_word(name, same, cutoff=0.0)
    # names of one owner are alike by it alone
    return nearest_word(name, (path for path, _, _ in every), cutoff=0.85 if beside else 0.6)


def guess(
    word: str,
    options: Iterable[str],
    *,
    meant: str | None = None,
    show: Callable[[str], str] = str,
    otherwise: str | None = "known here: ",
    cutoff: float = 0.6,
) -> Guess:
    """The option that was probably meant, as a question; else all of them after ``otherwise``.

    >>> guess("sigm", ["R", "sigma"]), guess("x", ["R", "sigma"], otherwise="it has ")
    ('did you mean sigma?', 'it has R, sigma')
    """
    options = list(options)
    if meant := meant or nearest_word(word, options, cutoff=cutoff):
        return Guess(f"did you mean {show(meant)}?", meant)
    return Guess("" if otherwise is None else f"{otherwise}{', '.join(options)}", None)


def no_attribute(module: str, name: str, names: Iterable[str]) -> AttributeError:
    """The error of a name that a module has not, with the one that was probably meant.

    >>> print(no_attribute("thirdbody", "solv", ["solve", "sweep"]))
    module 'thirdbody' has no attribute 'solv'; did you mean solve?
    """
    meant = "" if name.startswith("_") else guess(name, names, otherwise=None)
    return AttributeError(f"module {module!r} has no attribute {name!r}{meant and '; '}{meant}")
