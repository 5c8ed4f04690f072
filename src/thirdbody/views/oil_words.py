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


def answer(oil: DirtyOil) -> list[str]:
    """Sentences on who dents, who carries, and the life that is left."""
    out = [_dents(oil.populations, oil.where), _carries(oil)]
    if oil.life is not None:
        out.append(_life(oil.life))
    return out


def uncertainty(what_ifs: Sequence[OilWhatIf]) -> list[str]:
    """What moves dents and life most, by how much, and what to do about it."""
    if not what_ifs or not what_ifs[0].ratio > 1:
        return []
    most = what_ifs[0]
    out = [f"Most uncertain: {most.what}. {_effects(most)}."]
    for_life = max(what_ifs, key=lambda what_if: what_if.life_ratio)
    if for_life is not most and for_life.life_ratio > max(most.life_ratio, LITTLE):
        out.append(f"For the life: {for_life.what}. {_effects(for_life)}.")
    return out


def what_if_rows(what_ifs: Sequence[OilWhatIf]) -> list[list[str]]:
    """A row an input, under `WHAT_IF_HEADS`."""
    return [
        [
            what_if.what,
            what_if.between,
            _ends([_count(end) for end in what_if.dents]),
            _ends([value_of(end, "m", 3) for end in what_if.depth]),
            _ends([number(end, 2) for end in what_if.a_ISO]),
        ]
        for what_if in what_ifs
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
        "there are {} dents an hour": [_count(count) for count in one.dents],
        "one in twenty dents of the deepest kind is beyond {}": [
            value_of(depth, "m", 3) for depth in one.depth
        ],
        life: [number(factor, 2) for factor in one.a_ISO],
    }
    moved = [
        clause.format(" to ".join(ends)) for clause, ends in clauses.items() if ends[0] != ends[1]
    ]
    return f"With {one.between}, {join_words(moved)}; {one.action}"


def _dents(parts: Sequence[PopulationDents], where: str) -> str:
    """Sentence on who dents most often and who deepest."""
    if not any(population.per_hour > 0 for population in parts):
        return f"Nothing dents {where}: no particle of the oil is larger than the film and hard."
    often = max(parts, key=lambda population: population.per_hour)
    with_depth = [population for population in parts if math.isfinite(population.depth_p95)]
    deep = max(with_depth, key=lambda population: population.depth_p95) if with_depth else None
    if deep is None:
        return (
            f"{_capital(often.name)} is flattened in {where}: {_rate(often)} marks an hour, "
            f"{value_of(often.width, 'm', 3)} wide, of a depth that is not known."
        )
    if deep is often:
        most = "" if len(parts) == 1 else " most often and deepest"
        rest = [population for population in parts if population is not often]
        sentence = f"{_capital(often.name)} dents {where}{most}: {_number_and_depth(often)}"
        return (
            sentence
            + "".join(
                f"; {population.name}: {_number_and_depth(population)}" for population in rest
            )
            + "."
        )
    others = [population for population in parts if population not in (deep, often)]
    return (
        f"{_capital(deep.name)} dents {where} deepest: {_number_and_depth(deep)}; {often.name} "
        f"dents it most often: {_number_and_depth(often)}"
        + "".join(f"; {population.name}: {_number_and_depth(population)}" for population in others)
        + "."
    )


def _number_and_depth(population: PopulationDents) -> str:
    if not population.per_hour > 0:
        return "no dents"
    often = f"{_rate(population)} dents an hour"
    if math.isnan(population.depth):
        return f"{_rate(population)} flat marks an hour, {value_of(population.width, 'm', 3)} wide"
    return (
        f"{often}, {value_of(population.depth, 'm', 3)} deep on average, one in twenty beyond "
        f"{value_of(population.depth_p95, 'm', 3)}"
    )


def _carries(oil: DirtyOil) -> str:
    parts = [f"{population.name} {_share(population.load_share)}" for population in oil.populations]
    return (
        f"The film of {value_of(oil.film, 'm', 3)} carries {_share(oil.film_share)} of the "
        f"load at {value_of(oil.speed, 'm/s', 3)} (lambda = {number(oil.lambda_ratio, 2)}), "
        f"{join_words([f'asperities {_share(oil.asperity_share)}', *parts])}."
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


def rows(oil: DirtyOil) -> list[list[str]]:
    """A row a population, under `HEADS`."""
    return [
        [
            population.name,
            _share(population.load_share),
            _rate(population),
            number(1e-6 * population.per_overrolling, 2),
            _length(population.depth, population),
            _length(population.depth_p95, population),
            _length(population.deepest, population),
            _length(population.width, population),
        ]
        for population in oil.populations
    ]


def _length(value: float, population: PopulationDents) -> str:
    return "-" if not population.per_hour > 0 else value_of(value, "m", 3)


SAME_DENTS = 1.1
"""Factor of the dents from which on it is said what no data sheet says."""


def filter_answer(before: DirtyOil, after: DirtyOil) -> str:
    """What a filter changes, in a sentence."""
    dents = [sum(population.per_hour for population in oil.populations) for oil in (before, after)]
    sentence = "In one pass the filter takes the dents from "
    sentence += f"{_count(dents[0])} to {_count(dents[1])} an hour"
    if dents[1] > 0 and dents[0] > dents[1]:
        sentence += f", {number(dents[0] / dents[1], 2)} times fewer"
    lives = (before.life, after.life)
    if lives[0] is not None and lives[1] is not None:
        sentence += f", the oil from {lives[0].code} to {lives[1].code}"
        a = [life.a_ISO for life in lives]  # type: ignore[union-attr]
        if all(map(math.isfinite, a)):
            sentence += f", and a_ISO from {number(a[0], 2)} to {number(a[1], 2)}"
            sentence += f", {number(a[1] / a[0], 2)} times the life"
        if lives[0].place != lives[1].place:
            sentence += f"; ISO 281 has its own factors for {PLACES[lives[1].place]}"
    more = after.most_per_hour
    if more > SAME_DENTS * dents[1]:
        size = value_of(after.from_size, "m", 3)
        sentence += (
            f". Its data sheet begins at {size}, and below that the line of its β goes on: if it "
            f"held nothing there, {_count(more)} dents an hour would be left"
        )
    return f"{sentence}."


def filter_rows(before: DirtyOil, after: DirtyOil) -> list[list[str]]:
    """The same numbers before and after a filter, a row each: name, before, after."""
    out: list[tuple[str, list[str]]] = []

    def add(name: str, how: Sequence[str]) -> None:
        out.append((name, list(how)))

    both = (before, after)
    if before.life is not None and after.life is not None:
        lives = (before.life, after.life)
        add("ISO 4406 code", [life.code for life in lives])
        add("e_C", [number(life.e_C, 2) for life in lives])
        add("life factor a_ISO", [number(life.a_ISO, 2) for life in lives])
        if not math.isnan(before.life.hours):
            add("rating life [h]", [_count(life.hours) for life in lives])
        add("kappa", [number(life.kappa, 3) for life in lives])
    add("lambda", [number(oil.lambda_ratio, 2) for oil in both])
    add("load on the film", [_share(oil.film_share) for oil in both])
    add("load on asperities", [_share(oil.asperity_share) for oil in both])
    for i, population in enumerate(before.populations):
        pair = (population, after.populations[i])
        add(f"{population.name}: load", [_share(dents.load_share) for dents in pair])
        add(f"{population.name}: dents an hour", [_rate(dents) for dents in pair])
        add(
            f"{population.name}: dents per mm² and pass",
            [number(1e-6 * dents.per_overrolling, 2) for dents in pair],
        )
        add(f"{population.name}: depth", [_length(dents.depth, dents) for dents in pair])
        add(
            f"{population.name}: 5 % deeper than",
            [_length(dents.depth_p95, dents) for dents in pair],
        )
        add(
            f"{population.name}: deepest of an hour",
            [_length(dents.deepest, dents) for dents in pair],
        )
    return [[name, *how] for name, how in out]


def _rate(population: PopulationDents) -> str:
    return _count(population.per_hour)


def _count(value: float) -> str:
    """A number of dents as people say it."""
    if not math.isfinite(value):
        return number(value)
    return number(float(np.format_float_scientific(value, 1)), 6 if 1 <= value < 1e6 else 2)


def _share(value: float) -> str:
    return percent(value, least=1e-6)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
