"""Dents that the particles of an oil over time leave in the tracks of what rolls in it."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValue, NoEquilibrium, Note, RangeWarning
from ..populations.distributions import PowerLaw
from ..populations.measured.cleanliness import counted_sizes
from ..quantities.record import Record
from ..systems.life.circuit import OilCircuit, OilTerms
from ..systems.life.history import LifeHistory
from ..systems.life.oil_history import run_oil_history
from ..systems.life.run import life
from ..systems.life.size_classes import FALL
from ..systems.oil_filter import Filter
from ..systems.oil_particles import FilmDents
from .life import AskedLife
from .tracks import SIDE, Track, tracks_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["LifeDents", "OilDents", "TrackDents", "dents_of_life"]

ENTRY = 1.0
"""Entry ratio where nobody says it: an upper bound."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TrackDents(Record):
    """Dents in one track by one oil.

    Attributes
    ----------
    track : str
        "the inner ring".
    film : float
        Height [m].
    per_overrolling : float
        Dents by particles from 4 µm(c) on, per area each time that a body rolls over it [1/m²].
    per_hour : float
        The same in the whole track per hour [1].
    depth, depth_p95 : float
        Mean depth, and that which 5 % of them exceed, of the material that dents deepest [m]; NaN
        where particles are flattened, or there are none.
    smaller_per_hour : float
        Dents by particles below 4 µm(c) in the whole track per hour, at the end of the history [1].
    smaller_depth : float
        Mean depth of these [m].
    """

    track: str
    film: float
    per_overrolling: float
    per_hour: float
    depth: float
    depth_p95: float
    smaller_per_hour: float
    smaller_depth: float


@dataclass(frozen=True, eq=False, kw_only=True)
class OilDents(Record):
    """Dents by an oil as it is at one moment, or as it ends with a filter.

    Attributes
    ----------
    oil : str
        "as it begins", "with the return filter", "without the return filter".
    time : float
        Since the beginning [s]; infinite where the counts no longer change.
    code : str
        ISO 4406.
    tracks : tuple of TrackDents
    """

    oil: str
    time: float
    code: str
    tracks: tuple[TrackDents, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeDents(Record):
    """Dents in all tracks, by all oils that are compared; made by `dents_of_life`.

    Attributes
    ----------
    entry_ratio : float
        ε [1].
    assumed : bool
        Whether the study does not say it.
    oils : tuple of OilDents
    warnings : tuple of str
    """

    entry_ratio: float
    assumed: bool
    oils: tuple[OilDents, ...]
    warnings: tuple[str, ...] = ()


def dents_of_life(
    request: AskedLife,
    history: LifeHistory,
    *,
    filter: Filter | None = None,
    contact: Mapping[str, Any] | None = None,
) -> LifeDents | None:
    """Dents in the tracks of a study with [life] and [film], now and with other filters.

    Parameters
    ----------
    request : AskedLife
    history : LifeHistory
        Of its oil.
    filter : Filter, optional
        One more that is tried in the place of the first filter.
    contact : mapping, optional
        Arguments of `thirdbody.life` for the contacts of the study, whose debris dents too.

    Returns
    -------
    LifeDents or None
        None where nothing rolls in the oil.

    Notes
    -----
    Particles from 4 µm(c) on, which the code counts, are taken as they end where they end in the
    time of the history and no full filter lets the oil past, else as they are after it; smaller
    ones as they are after it.
    """
    rolling = request.rolling
    if rolling is None:
        return None
    entry, assumed = _entry(request)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            tracks = tracks_of(
                rolling.contact, rolling.film, rolling.body, rolling.force, entry=entry
            )
    except (InvalidValue, NoEquilibrium) as error:
        why = f"dents are not counted, because there is no film: {error}"
        return LifeDents(
            entry_ratio=entry, assumed=assumed, oils=(), warnings=(Note(why, code="life.dents"),)
        )
    circuit = request.circuit
    oils = [_dents("as it begins", 0.0, history.terms, tracks, (history.terms.start,) * 2)]
    for name, tried_circuit in _circuits(circuit, request, filter):
        ready_history = history if tried_circuit is circuit else None
        oils.append(_dents_after(name, tried_circuit, tracks, request, ready_history, contact))
    said = [] if filter is None else _notes_of_filter(circuit, filter)
    if assumed:
        what = "the entry ratio of particles is not given and taken as 1: dents are upper bounds"
        action = "count dents and give life.contact.entry_ratio, or vary it from 1e-3 to 1"
        said.append(Note(what, code="life.entry", action=action))
    return LifeDents(entry_ratio=entry, assumed=assumed, oils=tuple(oils), warnings=tuple(said))


def _entry(request: AskedLife) -> tuple[float, bool]:
    """ε, and whether it is assumed."""
    assert request.rolling is not None
    if request.contact is not None:
        return float(request.contact.conditions["entry_ratio"]), False
    if (brought := request.rolling.film.entrainment) is not None:
        return brought.entry_ratio, False
    return ENTRY, True


def _circuits(
    circuit: OilCircuit, request: AskedLife, filter: Filter | None
) -> list[tuple[str, OilCircuit]]:
    """The circuit as it is, with other filters in the place of the first one, and without it."""
    if not circuit.filters:
        return [("without a filter", circuit)]
    first, rest = circuit.filters[0], circuit.filters[1:]
    first_name = circuit.filter_names()[0]
    first_name = first_name if first_name.startswith("filter") else f"the {first_name}"
    others: list[tuple[str, Filter]] = []
    design = () if request.design is None else request.design.filters
    for i, new_filter in enumerate(design, 1):
        others.append((f"with {new_filter.name or f'filter {i}'} instead", new_filter))
    if filter is not None:
        others.append(("with --filter instead", filter))
    named = [(name, _with_flow(new_filter, first)) for name, new_filter in others]
    return [
        (f"with {first_name}", circuit),
        *((name, circuit.replace(filters=(new_filter, *rest))) for name, new_filter in named),
        (f"without {first_name}", circuit.replace(filters=rest)),
    ]


def _with_flow(filter: Filter, first: Filter) -> Filter:
    """A filter in the place of the first one."""
    if filter.flow is not None:
        return filter
    return filter.replace(flow=first.flow, line=first.line)


def _notes_of_filter(circuit: OilCircuit, filter: Filter) -> list[Note]:
    """What is to be said of a filter that is tried, as of one of the study."""
    if not circuit.filters:
        return []
    tried = _with_flow(filter, circuit.filters[0]).replace(name=filter.name or "--filter")
    every = circuit.replace(filters=(tried,)).notes()
    # of a code of their own: the filter of the study may have the same doubts
    return [
        Note(note, code=f"{note.code}, tried")
        for note in every
        if note.code in ("clipped", "below the data sheet")
    ]


def _dents_after(
    name: str,
    circuit: OilCircuit,
    tracks: Sequence[Track],
    request: AskedLife,
    ready_history: LifeHistory | None,
    contact: Mapping[str, Any] | None,
) -> OilDents:
    """Dents by the oil of a circuit as it ends, or after the duration."""
    duration = float(request.duration)
    times: dict[str, Any] = {"duration": duration, "times": [0.0, duration]}
    history: LifeHistory
    if contact is None:
        history = run_oil_history(circuit, **times)
    elif ready_history is not None and ready_history.times[-1] >= duration * (1 - 1e-12):
        history = ready_history
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            history = life(**contact, oil=circuit, **times)
    last = history.numbers[-1]
    soon = max(history.code_times)  # NaN for a count that grows for ever
    ends = all(math.isfinite(code_time) for code_time in history.code_times) and soon <= duration
    ends = ends and not history.bypassed  # the code times are those of filters in work
    steady = history.steady()
    counted = np.nan_to_num(steady[0].numbers) if ends and steady else last
    return _dents(name, math.inf if ends else duration, history.terms, tracks, (counted, last))


def _dents(
    name: str, time: float, terms: OilTerms, tracks: Sequence[Track], numbers: tuple[Array, Array]
) -> OilDents:
    """Dents by particles that the code counts, and by smaller ones."""
    counted, smaller = numbers
    first = _first_counted(terms)
    return OilDents(
        oil=name,
        time=time,
        code=terms.classes.iso4406(counted.sum(axis=1)),
        tracks=tuple(_in_track(track, terms, counted, smaller, first) for track in tracks),
    )


def _first_counted(terms: OilTerms) -> int:
    """The first class that is counted."""
    edges = np.array(terms.classes.edges[:-1])
    return int(np.sum(edges < counted_sizes()[0] * (1 - 1e-9)))


def _in_track(
    track: Track, terms: OilTerms, counted: Array, smaller: Array, first: int
) -> TrackDents:
    above = _sums(track, terms, counted, slice(first, None))
    below = _sums(track, terms, smaller, slice(0, first))
    deepest = max(above, key=lambda group: np.nan_to_num(group.depth_p95, nan=-1.0), default=None)
    return TrackDents(
        track=track.name,
        film=track.film,
        per_overrolling=float(sum(group.number for group in above)),
        per_hour=float(sum(track.per_hour(group) for group in above)),
        depth=math.nan if deepest is None else deepest.depth,
        depth_p95=math.nan if deepest is None else deepest.depth_p95,
        smaller_per_hour=float(sum(track.per_hour(group) for group in below)),
        smaller_depth=_mean_depth(below),
    )


def _mean_depth(dents: Sequence[FilmDents]) -> float:
    """Mean depth of the dents whose depth is known [m]."""
    with_depth = [group for group in dents if group.number > 0 and math.isfinite(group.depth)]
    number = sum(group.number for group in with_depth)
    return (
        sum(group.number * group.depth for group in with_depth) / number if with_depth else math.nan
    )


def _sums(track: Track, terms: OilTerms, numbers: Array, some: slice) -> list[FilmDents]:
    """Dents by some classes, of each material."""
    edges = terms.classes.edges
    pairs = list(pairwise(edges))[some]
    out = []
    for m, material in enumerate(terms.materials.values()):
        counts = np.maximum(numbers[some, m], 0.0)
        if not pairs or not np.sum(counts) > 0:
            continue
        held = np.flatnonzero(counts > 0)
        low, high = held[0], held[-1] + 1
        sizes = PowerLaw(
            edges=(pairs[low][0], *(b for _, b in pairs[low:high])),
            counts=tuple(float(n) for n in counts[low:high]),
            slopes=(FALL,) * int(high - low),
        )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            out.append(track.particles(material, sizes, float(np.sum(counts))).dents(SIDE))
    return out
