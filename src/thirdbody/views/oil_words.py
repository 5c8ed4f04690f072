"""What the particles of an oil do, in words: the answer first, then a table."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..quantities.say import join_words, number, percent, value_of
from ..study.dirty_oil import DirtyOil, Life, PopulationDents
from ..study.oil_what_ifs import OilWhatIf

__all__ = [
    "DROP",
    "HANGS_ON",
    "HEADS",
    "MEANS",
    "WHAT_IF_HEADS",
    "WHAT_IF_MEANS",
    "answer",
    "filter_answer",
    "filter_rows",
    "rows",
    "uncertainty",
    "what_if_rows",
]

HEADS = ("population", "load", "dents/h", "per mm²", "depth", "5 % above", "deepest", "width")
MEANS = {
    "load": "its part of the whole load",
    "dents/h": "dents in the whole track per hour",
    "per mm²": "dents per mm² of track and overrolling",
    "depth": "mean of the dents, an upper bound",
    "5 % above": "depth that one in twenty exceeds",
    "deepest": "of an hour (median)",
    "width": "mean diameter of the dents",
}
"""What the heads mean."""
PLACES = {"bath": "oil bath", "filter": "oil that a filter in the line cleans"}
"""Diagrams of the contamination factor."""
HEAVY = 0.5
"""Load over the dynamic rating up to which ISO 281 holds."""
LITTLE = 1.2
"""Factor of the life up to which an input is not named for it."""
HANGS_ON = "What dents and life hang on"
WHAT_IF_HEADS = ("input", "with", "dents/h", "5 % above", "a_ISO")
WHAT_IF_MEANS = {
    "with": "each input alone, at one end and at the other",
    "dents/h": "dents of all populations in the whole track per hour",
    "5 % above": "depth that one in twenty dents of the deepest population exceeds",
    "a_ISO": "life factor of ISO 281",
}
"""The table of what is uncertain."""
DROP = ("width", "per mm²", "deepest", "load")
"""Columns in the order in which they go where the width is small."""


def answer(found: DirtyOil) -> list[str]:
    """Sentences on who dents, who carries, and the life that is left."""
    out = [_dents(found.populations, found.where), _carries(found)]
    if found.life is not None:
        out.append(_life(found.life))
    return out


def uncertainty(what_ifs: Sequence[OilWhatIf]) -> list[str]:
    """What moves dents and life most, by how much, and what to do about it."""
    if not what_ifs or not what_ifs[0].ratio > 1:
        return []
    most = what_ifs[0]
    out = [f"Most uncertain: {most.what}. {_effects(most)}."]
    for_life = max(what_ifs, key=lambda each: each.life_ratio)
    if for_life is not most and for_life.life_ratio > max(most.life_ratio, LITTLE):
        out.append(f"For the life: {for_life.what}. {_effects(for_life)}.")
    return out


def what_if_rows(what_ifs: Sequence[OilWhatIf]) -> list[list[str]]:
    """A row an input, under `WHAT_IF_HEADS`."""
    return [
        [
            each.what,
            each.between,
            _ends([_count(end) for end in each.dents]),
            _ends([value_of(end, "m", 3) for end in each.depth]),
            _ends([number(end, 2) for end in each.a_ISO]),
        ]
        for each in what_ifs
    ]


def _ends(both: Sequence[str]) -> str:
    """Both ends, or the one number where they are the same."""
    return " to ".join(dict.fromkeys(both))


def _effects(one: OilWhatIf) -> str:
    """What an input between its ends does, and what to do about it."""
    life = "a_ISO is {}"
    if one.code == "number":
        life += " (ISO 281 goes by steps of several codes)"
    clauses = {
        "there are {} dents an hour": [_count(each) for each in one.dents],
        "one in twenty dents of the deepest kind is beyond {}": [
            value_of(each, "m", 3) for each in one.depth
        ],
        life: [number(each, 2) for each in one.a_ISO],
    }
    moved = [
        clause.format(" to ".join(ends)) for clause, ends in clauses.items() if ends[0] != ends[1]
    ]
    return f"With {one.between}, {join_words(moved)}; {one.action}"


def _dents(parts: Sequence[PopulationDents], where: str) -> str:
    """Sentence on who dents most often and who deepest."""
    if not any(each.per_hour > 0 for each in parts):
        return f"Nothing dents {where}: no particle of the oil is larger than the film and hard."
    often = max(parts, key=lambda each: each.per_hour)
    known = [each for each in parts if math.isfinite(each.depth_p95)]
    deep = max(known, key=lambda each: each.depth_p95) if known else None
    if deep is None:
        return (
            f"{_capital(often.name)} is flattened in {where}: {_rate(often)} marks an hour, "
            f"{value_of(often.width, 'm', 3)} wide, of a depth that is not known."
        )
    if deep is often:
        most = "" if len(parts) == 1 else " most often and deepest"
        rest = [each for each in parts if each is not often]
        told = f"{_capital(often.name)} dents {where}{most}: {_number_and_depth(often)}"
        return told + "".join(f"; {each.name}: {_number_and_depth(each)}" for each in rest) + "."
    others = [each for each in parts if each not in (deep, often)]
    return (
        f"{_capital(deep.name)} dents {where} deepest: {_number_and_depth(deep)}; {often.name} "
        f"dents it most often: {_number_and_depth(often)}"
        + "".join(f"; {each.name}: {_number_and_depth(each)}" for each in others)
        + "."
    )


def _number_and_depth(each: PopulationDents) -> str:
    if not each.per_hour > 0:
        return "no dents"
    told = f"{_rate(each)} dents an hour"
    if math.isnan(each.depth):
        return f"{_rate(each)} flat marks an hour, {value_of(each.width, 'm', 3)} wide"
    return (
        f"{told}, {value_of(each.depth, 'm', 3)} deep on average, one in twenty beyond "
        f"{value_of(each.depth_p95, 'm', 3)}"
    )


def _carries(found: DirtyOil) -> str:
    parts = [f"{each.name} {_share(each.load_share)}" for each in found.populations]
    return (
        f"The film of {value_of(found.film, 'm', 3)} carries {_share(found.film_share)} of the "
        f"load at {value_of(found.speed, 'm/s', 3)} (lambda = {number(found.lambda_ratio, 2)}), "
        f"{join_words([f'asperities {_share(found.asperity_share)}', *parts])}."
    )


def _life(life: Life) -> str:
    kappa = f"kappa = {number(life.kappa, 3)}"
    if life.why:
        return f"With {kappa} and oil {life.code} ISO 281 gives no life factor: {life.why}."
    lost = (
        "as in clean oil"
        if life.a_ISO >= 0.995 * life.clean
        else f"{number(life.clean, 2)} in clean oil"
    )
    hours = "" if math.isnan(life.hours) else f", {_count(life.hours)} h of rating life"
    return (
        f"By ISO 281 ({PLACES[life.place]}) oil {life.code} with {kappa} has e_C = "
        f"{number(life.e_C, 2)}, and the life factor a_ISO is {number(life.a_ISO, 2)} ({lost})"
        f"{hours}{_load_warning(life)}."
    )


def _load_warning(life: Life) -> str:
    """That the load is beyond what the life is known for, where it is."""
    if not life.load_over_rating > HEAVY:
        return ""
    return (
        f"; but the load is {number(life.load_over_rating, 2)} C, and ISO 281 holds up to C/2: "
        "check the load and the rating"
    )


def rows(found: DirtyOil) -> list[list[str]]:
    """A row a population, under `HEADS`."""
    return [
        [
            each.name,
            _share(each.load_share),
            _rate(each),
            number(1e-6 * each.per_overrolling, 2),
            _length(each.depth, each),
            _length(each.depth_p95, each),
            _length(each.deepest, each),
            _length(each.width, each),
        ]
        for each in found.populations
    ]


def _length(value: float, each: PopulationDents) -> str:
    return "-" if not each.per_hour > 0 else value_of(value, "m", 3)


SAME_DENTS = 1.1
"""Factor of the dents from which on it is said what no data sheet says."""


def filter_answer(before: DirtyOil, after: DirtyOil) -> str:
    """What a filter changes, in a sentence."""
    dents = [sum(each.per_hour for each in found.populations) for found in (before, after)]
    told = "In one pass the filter takes the dents from "
    told += f"{_count(dents[0])} to {_count(dents[1])} an hour"
    if dents[1] > 0 and dents[0] > dents[1]:
        told += f", {number(dents[0] / dents[1], 2)} times fewer"
    lives = (before.life, after.life)
    if lives[0] is not None and lives[1] is not None:
        told += f", the oil from {lives[0].code} to {lives[1].code}"
        a = [each.a_ISO for each in lives]  # type: ignore[union-attr]
        if all(map(math.isfinite, a)):
            told += f", and a_ISO from {number(a[0], 2)} to {number(a[1], 2)}"
            told += f", {number(a[1] / a[0], 2)} times the life"
        if lives[0].place != lives[1].place:
            told += f"; ISO 281 has its own factors for {PLACES[lives[1].place]}"
    more = after.most_per_hour
    if more > SAME_DENTS * dents[1]:
        size = value_of(after.from_size, "m", 3)
        told += (
            f". Its data sheet begins at {size}, and below that the line of its β goes on: if it "
            f"held nothing there, {_count(more)} dents an hour would be left"
        )
    return f"{told}."


def filter_rows(before: DirtyOil, after: DirtyOil) -> list[list[str]]:
    """The same numbers before and after a filter, a row each: name, before, after."""
    out: list[tuple[str, list[str]]] = []

    def add(name: str, how: Sequence[str]) -> None:
        out.append((name, list(how)))

    both = (before, after)
    if before.life is not None and after.life is not None:
        lives = (before.life, after.life)
        add("ISO 4406 code", [each.code for each in lives])
        add("e_C", [number(each.e_C, 2) for each in lives])
        add("life factor a_ISO", [number(each.a_ISO, 2) for each in lives])
        if not math.isnan(before.life.hours):
            add("rating life [h]", [_count(each.hours) for each in lives])
        add("kappa", [number(each.kappa, 3) for each in lives])
    add("lambda", [number(each.lambda_ratio, 2) for each in both])
    add("load on the film", [_share(each.film_share) for each in both])
    add("load on asperities", [_share(each.asperity_share) for each in both])
    for i, part in enumerate(before.populations):
        pair = (part, after.populations[i])
        add(f"{part.name}: load", [_share(each.load_share) for each in pair])
        add(f"{part.name}: dents an hour", [_rate(each) for each in pair])
        add(
            f"{part.name}: dents per mm² and pass",
            [number(1e-6 * each.per_overrolling, 2) for each in pair],
        )
        add(f"{part.name}: depth", [_length(each.depth, each) for each in pair])
        add(f"{part.name}: 5 % deeper than", [_length(each.depth_p95, each) for each in pair])
        add(f"{part.name}: deepest of an hour", [_length(each.deepest, each) for each in pair])
    return [[name, *how] for name, how in out]


def _rate(each: PopulationDents) -> str:
    return _count(each.per_hour)


def _count(value: float) -> str:
    """A number of dents as people say it."""
    if not math.isfinite(value):
        return number(value)
    return number(float(np.format_float_scientific(value, 1)), 6 if 1 <= value < 1e6 else 2)


def _share(value: float) -> str:
    return percent(value, least=1e-6)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
