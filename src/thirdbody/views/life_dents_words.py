"""Dents by an oil over time in words: in each track, with each filter and without."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..quantities.say import join_words, number, value_of
from ..quantities.tables import WordTable
from .life_amounts import duration_of

if TYPE_CHECKING:
    from ..study.life_dents import LifeDents, OilDents

__all__ = ["MEANS", "dent_answer", "tables_of_dents"]

HEADS = ("oil", "ISO 4406", "track", "dents/h", "per mm²", "5 % above")
MEANS = {
    "dents/h": "in the whole track per hour, by particles from 4 µm on",
    "per mm²": "of track, each time that a body rolls over it",
    "5 % above": "depth that one in twenty exceeds, an upper bound",
}


def _heading(dents: LifeDents) -> str:
    """What the table is of."""
    said = "taken as" if dents.assumed else "given as"
    ratio = number(dents.entry_ratio, 3)
    return f"Dents in the tracks by each oil as it ends, entry ratio {said} {ratio}:"


def _rows(dents: LifeDents) -> list[list[str]]:
    """A row for each oil and track."""
    return [
        [
            _oil(oil) if i == 0 else "",
            oil.code if i == 0 else "",
            track.track.removeprefix("the "),
            _count(track.per_hour),
            number(1e-6 * track.per_overrolling, 2),
            value_of(track.depth_p95, "m", 3) if track.per_hour > 0 else "-",
        ]
        for oil in dents.oils
        for i, track in enumerate(oil.tracks)
    ]


def _oil(oil: OilDents) -> str:
    after = math.isfinite(oil.time) and oil.time > 0
    return f"{oil.oil}, after {duration_of(oil.time)}" if after else oil.oil


def dent_answer(dents: LifeDents | None) -> list[str]:
    """How often each track is dented, with the filter as it is, with others, and without."""
    if dents is None or len(dents.oils) < 2:
        return []
    first, *others = dents.oils[1:]
    who = f"The oil {first.oil} dents" if first.oil.startswith("with") else "The oil dents"
    tracks = [f"{track.track} {_count(track.per_hour)}" for track in first.tracks]
    when = _time_clause(first)
    out = [f"{who} {join_words(tracks)} times an hour{when}"]
    out += [
        f"{oil.oil} {join_words([_count(track.per_hour) for track in oil.tracks])} times"
        f"{_time_clause(oil) if _time_clause(oil) != when else ''}"
        for oil in others
    ]
    return [f"{'; '.join(out)}.", *_smaller(first)]


def _time_clause(oil: OilDents) -> str:
    return f" after {duration_of(oil.time)}" if math.isfinite(oil.time) else ""


def _smaller(oil: OilDents) -> list[str]:
    """What the particles do that the code does not count."""
    some = [track for track in oil.tracks if track.smaller_per_hour > 0]
    if not some:
        return []
    most = max(some, key=lambda track: track.smaller_per_hour)
    depth = most.smaller_depth
    deep = f", {value_of(depth, 'm', 2)} deep on average" if math.isfinite(depth) else ""
    return [
        f"Particles below 4 µm, which no code counts, add {_count(most.smaller_per_hour)} dents an "
        f"hour in {most.track}{deep}."
    ]


def _count(value: float) -> str:
    """A number of dents as people say it."""
    return number(float(np.format_float_scientific(value, 1)), 6 if 1 <= value < 1e6 else 2)


def tables_of_dents(dents: LifeDents | None) -> list[WordTable]:
    """The table below its heading; none where nothing is dented."""
    if dents is None or not dents.oils:
        return []
    return [WordTable(HEADS, _rows(dents), MEANS, _heading(dents))]
