"""The name that was probably meant: one maker of "did you mean"."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Self, TypeVar

__all__ = [
    "Guess",
    "UnknownName",
    "ValuesByName",
    "guess",
    "name_of_meaning",
    "near_path",
    "nearest_name",
    "nearest_paths",
    "nearest_word",
    "no_attribute",
    "no_attribute_of",
]

T = TypeVar("T")

CLOSE = 0.8
"""Likeness from which a misspelt word is taken for another, whatever else is near."""
NO_MEANINGS: Mapping[str, str] = MappingProxyType({})
SMALL_WORDS = frozenset(
    {
        *("and", "are", "for", "from", "its", "like", "one", "over", "per", "that", "the", "their"),
        *("they", "this", "two", "what", "when", "where", "which", "with"),
    }
)
"""Words of a meaning that say nothing of it."""


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


def _words(text: str) -> list[str]:
    """The words of a name or of a meaning, without its unit and an example."""
    plain = re.sub(r"\[.*?\]", " ", text.partition(", e.g.")[0]).replace("'", "").replace("’", "")
    every = re.findall(r"[^\W\d_]{3,}", plain.casefold())
    return [word for word in every if word not in SMALL_WORDS]


def _likeness(word: str, other: str) -> float:
    """How far a word is another one: 1 where it is, 0 where they only share letters."""
    if word == other:
        return 1.0
    if min(len(word), len(other)) < 4:
        return 0.0
    if other.startswith(word):
        return 0.9
    ratio = difflib.SequenceMatcher(None, word, other).ratio()
    return ratio if ratio >= CLOSE and min(len(word), len(other)) > 4 else 0.0


def name_of_meaning(name: str, meanings: Mapping[str, str]) -> str | None:
    """The name whose own words and whose meaning have the words of another name.

    At least half of those words must be there, misspelt or begun. The last counts most, as in
    "number density", and of several names with as many the first is taken.

    >>> solid = {"E": "Young's modulus [Pa]", "nu": "Poisson ratio ν", "H": "hardness [Pa]"}
    >>> [name_of_meaning(name, solid) for name in ("hardnes", "youngs_modulus", "poisons")]
    ['H', 'E', 'nu']
    >>> name_of_meaning("colour", solid) is None
    True
    """
    words = _words(name)
    best, best_name = 0.0, None
    for option, meaning in meanings.items():
        there = [*_words(option), *_words(meaning)]
        likeness = [max((_likeness(word, other) for other in there), default=0.0) for word in words]
        score = sum(likeness) + 0.5 * sum(likeness[-1:])
        if score > best and 2 * sum(one > 0 for one in likeness) >= len(words):
            best, best_name = score, option
    return best_name


def nearest_name(
    name: str,
    options: Iterable[str],
    meanings: Mapping[str, str] = NO_MEANINGS,
    *,
    cutoff: float = 0.6,
) -> str | None:
    """The option that was probably meant: one spelt nearly so, or of this meaning, or alike at all.

    >>> meanings = {"areal_density": "particles per nominal area", "oil_density": "of the oil"}
    >>> nearest_name("density", meanings, meanings), nearest_name("oil_densty", meanings, meanings)
    ('areal_density', 'oil_density')
    """
    options = list(options)
    meanings = {option: meanings[option] for option in options if option in meanings}
    return (
        nearest_word(name, options, cutoff=max(cutoff, CLOSE))
        or name_of_meaning(name, meanings)
        or nearest_word(name, options, cutoff=cutoff)
    )


def near_path(
    name: str, paths: Iterable[str], meanings: Mapping[str, str] = NO_MEANINGS
) -> str | None:
    """The dotted name that was probably meant.

    A sibling with a like name or of this meaning comes first, then the same last name below the
    same first one.

    >>> paths = ["particles.areal_density", "particles.diameter.mean", "roughness.sigma"]
    >>> near_path("roughness.sigm", paths), near_path("particles.mean", paths)
    ('roughness.sigma', 'particles.diameter.mean')
    >>> near_path("particles.colour", paths), near_path("rougness.sigma", paths)
    (None, 'roughness.sigma')
    >>> near_path("roughness.rms", paths, {"roughness.sigma": "RMS roughness"})
    'roughness.sigma'
    """
    owner, _, last = name.rpartition(".")
    every = [(path, *path.rpartition(".")[::2]) for path in paths]
    beside = {leaf: path for path, above, leaf in every if above == owner}
    about = {leaf: meanings[path] for leaf, path in beside.items() if path in meanings}
    if meant := nearest_name(last, beside, about):
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


def nearest_paths(name: str, paths: Iterable[str], *, most: int = 6) -> list[str]:
    """The dotted names that are most like another: those that begin as it does, and likest spelt.

    >>> nearest_paths("roughness.x", ["E", "roughness.R", "roughness.sigma"], most=2)
    ['roughness.R', 'roughness.sigma']
    """
    start = name.partition(".")[0]

    def unlike(path: str) -> tuple[bool, float]:
        ratio = difflib.SequenceMatcher(None, name.casefold(), path.casefold()).ratio()
        return path.partition(".")[0] != start, -ratio

    return sorted(paths, key=unlike)[:most]


def guess(
    word: str,
    options: Iterable[str],
    *,
    meant: str | None = None,
    meanings: Mapping[str, str] = NO_MEANINGS,
    show: Callable[[str], str] = str,
    otherwise: str | None = "known here: ",
    cutoff: float = 0.6,
) -> Guess:
    """The option that was probably meant, as a question; else all of them after ``otherwise``.

    ``meanings`` says of options what they are: they are known by its words, too.

    >>> guess("sigm", ["R", "sigma"]), guess("x", ["R", "sigma"], otherwise="it has ")
    ('did you mean sigma?', 'it has R, sigma')
    >>> guess("hardness", ["E", "H"], meanings={"E": "Young's modulus", "H": "hardness"})
    'did you mean H?'
    """
    options = list(options)
    if meant := meant or nearest_name(word, options, meanings, cutoff=cutoff):
        return Guess(f"did you mean {show(meant)}?", meant)
    return Guess("" if otherwise is None else f"{otherwise}{', '.join(options)}", None)


def no_attribute(module: str, name: str, names: Iterable[str]) -> AttributeError:
    """The error of a name that a module has not, with the one that was probably meant.

    >>> print(no_attribute("thirdbody", "solv", ["solve", "sweep"]))
    module 'thirdbody' has no attribute 'solv'; did you mean solve?
    """
    meant = "" if name.startswith("_") else guess(name, names, otherwise=None)
    return AttributeError(f"module {module!r} has no attribute {name!r}{meant and '; '}{meant}")


def no_attribute_of(
    kind: str, name: str, names: Iterable[str], within: Iterable[str] = ()
) -> Guess:
    """The sentence on a name that an object has not, with the one that was probably meant.

    ``within`` are names that its mapping ``outputs`` has.

    >>> no_attribute_of("Equilibrium", "A_tt", ["A_t", "d"])
    "'Equilibrium' object has no attribute 'A_tt'; did you mean A_t?"
    >>> no_attribute_of("Equilibrium", "mu", ["A_t", "d"], ["mu", "mu_ss"])
    "'Equilibrium' object has no attribute 'mu'; did you mean outputs['mu']?"
    """
    inner = list(within)
    meant = guess(
        name,
        [*names, *inner],
        meant=name if name in inner else None,
        show=lambda option: f"outputs[{option!r}]" if option in inner else option,
        otherwise=None,
    )
    return f"{kind!r} object has no attribute {name!r}{meant and '; '}" + meant


class UnknownName(KeyError):
    """A key that there is not, said in a sentence with the one that was probably meant."""

    def __init__(self, key: object, sentence: str):
        super().__init__(key, sentence)

    def __str__(self) -> str:
        return str(self.args[1])


class ValuesByName(dict[str, T]):
    """Values by their names: a dict that asks for the name that was probably meant.

    >>> ValuesByName(mu=0.1)["muu"]
    Traceback (most recent call last):
    thirdbody.quantities.nearest.UnknownName: there is no 'muu'; did you mean 'mu'?
    """

    __slots__ = ()

    def __missing__(self, key: str) -> T:
        sentence = f"there is no {key!r}"
        if self and isinstance(key, str):
            sentence += "; " + guess(key, self, show=repr, otherwise="there are ")
        raise UnknownName(key, sentence)
