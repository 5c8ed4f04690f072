"""A study of an oil over time: how dirty it becomes, and where its dirt goes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, overload

import numpy as np

from ..quantities.plain_data import plain_data
from ..quantities.record import Entry
from ..systems.life.history import LifeHistory
from ..systems.life.reports import OilReports, oil_reports, read_reports
from ..systems.oil_filter import Filter
from .asked_result import QuestionResult, question_entries
from .life import AskedDry, AskedLife, life_of, oil_of
from .life_bands import LifeBands, check_oil, propagate_life
from .life_dents import LifeDents, dents_of_life
from .life_dirt import CLEAN
from .run_dry import (
    DURATION,
    FLOWS,
    UNTIL,
    DryResult,
    bands_of_dry,
    drawn_of,
    life_of_asked,
    run_dry,
)
from .toml import override, read
from .whole import load_tables, read_tables

__all__ = [
    "LifeResult",
    "ReportsResult",
    "history_of",
    "load_circuit",
    "load_life",
    "load_oil",
    "reports_of",
    "run_life",
]

OIL: Entry = ("oil", "asked.circuit")
NEEDED = frozenset({"life"})
CITATIONS = (
    "ISO 16889: multi-pass test of filters (β ratio)",
    "ISO 4406: code of the level of contamination by solid particles",
)


def load_life(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> AskedLife | AskedDry:
    """The life of an oil, or of a dry contact, that a study file asks for.

    Parameters
    ----------
    path : path-like
        A TOML file with a table [life].
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.

    Raises
    ------
    InvalidValue
        Every mistake of the file.
    """
    return load_tables(path, overrides, life_of, NEEDED)


def load_oil(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> AskedLife:
    """The life of an oil that a study file asks for; as `load_life`, no dry contact.

    Parameters
    ----------
    path : path-like
        A TOML file with tables [life] and [life.oil].
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.
    """
    return load_tables(path, overrides, oil_of, NEEDED)


def load_circuit(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> AskedLife:
    """The circuit of a study file whose ingress nobody needs to know.

    Parameters
    ----------
    path : path-like
        A TOML file with a table [life].
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.

    Raises
    ------
    InvalidValue
        Every mistake of the file.
    """
    data = override(read(Path(path)), list(overrides))
    life_table = data.get("life")
    if isinstance(life_table, dict) and isinstance(life_table.get("oil"), dict):
        life_table["oil"]["ingress"] = CLEAN
    return read_tables(data, Path(path).parent, oil_of, NEEDED)


@dataclass(frozen=True, eq=False, kw_only=True)
class ReportsResult(QuestionResult):
    """Results of `reports_of`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedLife
    reports : OilReports
    """

    in_dict = question_entries(
        ("inputs", (OIL,)), ("", "reports"), ("is_constant", "reports.is_constant")
    )
    asked: AskedLife
    reports: OilReports

    title_without = "Reports of an oil"
    citations = CITATIONS
    meanings: ClassVar[Mapping[str, str]] = {
        "size": "size from which is counted",
        "rate": "particles that enter from this size on, per time",
        "low": "lower end of the band in which the rate lies nine times of ten",
        "high": "upper end of that band",
    }

    @property
    def run_notes(self) -> tuple[str, ...]:
        """Those of the circuit with what enters it."""
        return tuple(self.asked.circuit.replace(ingress=(self.reports.ingress,)).notes())

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row a size, and their units."""
        reported = self.reports
        columns = {name: getattr(reported, name) for name in ("rate", "low", "high")}
        data = {"size": plain_data(reported.sizes)} | {k: plain_data(v) for k, v in columns.items()}
        return data, {"size": "m"} | dict.fromkeys(columns, "1/s")


def reports_of(request: AskedLife, file: str | os.PathLike[str]) -> ReportsResult:
    """What reports of an oil say of the dirt that enters the circuit of a study.

    Parameters
    ----------
    request : AskedLife
        As `load_circuit` reads it.
    file : path-like
        As `thirdbody.systems.life.reports.read_reports` reads it.
    """
    times, reports, sizes = read_reports(Path(file), fewest=2)
    reported = oil_reports(times, reports=reports, sizes=sizes, circuit=request.circuit)
    return ReportsResult(asked=request, reports=reported)


@dataclass(frozen=True, eq=False, kw_only=True)
class LifeResult(QuestionResult):
    """Results of `run_life`; indexed, they are the plain data of `to_dict`.

    Attributes
    ----------
    asked : AskedLife
    history : LifeHistory
    bands : LifeBands, optional
        Where the study says what is known of its numbers.
    dents : LifeDents, optional
        Where something rolls in the oil.
    """

    in_dict = question_entries(
        ("inputs", (OIL, DURATION, UNTIL)), ("", "history"), FLOWS, "bands", "dents"
    )
    asked: AskedLife
    history: LifeHistory
    bands: LifeBands | None = None
    dents: LifeDents | None = None

    title_without = "Life of an oil"
    citations = CITATIONS

    @property
    def run_notes(self) -> tuple[str, ...]:
        """Those of the history, and of the dents."""
        return (*self.history.warnings, *(() if self.dents is None else self.dents.warnings))

    @property
    def meanings(self) -> Mapping[str, str]:
        """Meanings of the columns."""
        counts = {f"n_{size}": f"particles per volume from {size} µm(c)" for size in (4, 6, 14)}
        masses = {
            name: f"mass of particles {name}" if name.startswith("in ") else f"mass, {name}"
            for name in self.history.ledger.over_time()
        }
        of_contact = {name: about.meaning for name, (about, _) in self.history.more.items()}
        return {
            "time": "since the beginning",
            "code": "ISO 4406",
            **counts,
            "volume": "of the oil",
            **masses,
            **of_contact,
        }

    def table(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns, a row a time, and their units."""
        history = self.history
        columns: dict[str, list[object]] = {
            "time": plain_data(history.times),
            "code": list(history.codes),
        }
        units = {"time": "s", "code": ""}
        for name, values in zip(("n_4", "n_6", "n_14"), history.counts.T, strict=True):
            columns[name], units[name] = plain_data(values), "1/m^3"
        columns["volume"], units["volume"] = plain_data(history.volume), "m^3"
        for name, values in history.ledger.over_time().items():
            columns[name], units[name] = plain_data(values), "kg"
        for name, (about, values) in history.more.items():
            columns[name], units[name] = plain_data(np.asarray(values)), about.unit
        return columns, units


def history_of(request: AskedLife, *, keep: Path | None = None) -> LifeHistory:
    """The history of the oil, with the contacts that it goes through where there are some.

    Parameters
    ----------
    request : AskedLife
    keep : Path, optional
        As of `thirdbody.life`.
    """
    more: dict[str, Any] = {} if keep is None else {"keep": keep}
    history = life_of_asked(request, oil=request.circuit, **(_arguments(request) or {}), **more)
    assert isinstance(history, LifeHistory)
    return history


def _arguments(request: AskedLife) -> dict[str, Any] | None:
    """Arguments of `thirdbody.life` for the contacts; None where there are none."""
    if (of := request.contact) is None:
        return None
    parts = {"contact": of.contact, "debris": of.debris, "running_in": of.running_in}
    return {**parts, **of.conditions}


def bands_of(
    request: AskedLife | AskedDry, *, progress: bool = False, keep: Path | None = None
) -> LifeBands | None:
    """Bands of an oil or of a dry contact; None where the study says nothing of what is known.

    Parameters
    ----------
    request : AskedLife or AskedDry
        As `load_life` reads it.
    progress : bool, optional
        Shows on standard error how many histories are done.
    keep : Path, optional
        A file that keeps the end of every history; the same call goes on with it.
    """
    if isinstance(request, AskedDry):
        return bands_of_dry(request, progress=progress, keep=keep)
    if not request.uncertainty:
        return None
    with request.drawn.in_file():
        return propagate_life(
            request.circuit, **drawn_of(request), contact=_arguments(request), progress=progress,
            keep=keep,
        )  # fmt: skip


def need_bands(request: AskedLife) -> None:
    """Refuse what is said to be uncertain and cannot be so, before anything is computed.

    Parameters
    ----------
    request : AskedLife

    Raises
    ------
    InvalidValue
    """
    if not request.uncertainty:
        return
    with request.drawn.in_file():
        check_oil(
            request.circuit,
            vary=request.uncertainty,
            duration=request.duration,
            contact=_arguments(request),
            samples=request.drawn.samples,
            seed=request.drawn.seed,
        )


@overload
def run_life(
    request: AskedLife,
    *,
    progress: bool = ...,
    keep: Path | None = ...,
    filter: Filter | None = ...,
) -> LifeResult: ...
@overload
def run_life(
    request: AskedDry, *, progress: bool = ..., keep: Path | None = ..., filter: Filter | None = ...
) -> DryResult: ...
def run_life(
    request: AskedLife | AskedDry,
    *,
    progress: bool = False,
    keep: Path | None = None,
    filter: Filter | None = None,
) -> LifeResult | DryResult:
    """The history of an oil, or of a dry contact, as its study asks.

    Parameters
    ----------
    request : AskedLife or AskedDry
        As `load_life` reads it.
    progress : bool, optional
        As in `bands_of`.
    keep : Path, optional
        A file that keeps what was computed: the ends of all histories where bands are asked for,
        else the rates of the one with a contact. The same call goes on with it.
    filter : Filter, optional
        Of which the dents are asked too, in the place of the first filter.

    Examples
    --------
    >>> from importlib import resources
    >>> file = resources.files("thirdbody").joinpath("data/studies/oil-circuit.toml")
    >>> found = run_life(load_life(file))
    >>> found.history.codes[0], found.history.ledger.residual < 1e-9
    ('20/18/15', True)
    """
    if isinstance(request, AskedDry):
        return run_dry(request, progress=progress, keep=keep)
    need_bands(request)
    history = history_of(request, keep=None if request.uncertainty else keep)
    return LifeResult(
        asked=request,
        history=history,
        bands=bands_of(request, progress=progress, keep=keep),
        dents=dents_of_life(request, history, filter=filter, contact=_arguments(request)),
    )
