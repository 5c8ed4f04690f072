"""A study file as a whole: what it asks for, checked before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ..analysis.sweep.plan import Plan
from ..analysis.uncertainty.inputs import Uncertainty
from ..contact.contact import Contact
from ..equilibrium.columns import Equilibrium
from ..equilibrium.solve import deepest, solve, why_deep
from ..errors import InvalidValue, Mistake, Note, Problem
from ..populations.measured.topography import Topography
from ..quantities.arguments import names_arguments
from ..quantities.slips import slips_are_told
from ..systems.bodies import Body
from ..systems.film_conditions import FilmConditions
from ..systems.oil_filter import Filter
from .connector import AskedConnector, connector_of
from .film import filter_of, on_body
from .life import AskedDry, AskedLife, life_of
from .load import loads_of
from .outputs import on_area
from .own_code import load_installed
from .particles import gaps_of, notes_on_gaps
from .plate import AskedPlate, plate_of
from .reader import Reader
from .schema import Describer
from .sweep import ends, plan, with_nested_names
from .tables import TABLES
from .toml import heading_of, override, read, setting_in_words

if TYPE_CHECKING:
    import xarray

__all__ = ["Study", "check", "load_study", "load_tables", "read_tables"]

Asked = TypeVar("Asked")


@dataclass(frozen=True, eq=False, kw_only=True)
class Study:
    """What a study file asks for.

    Parameters
    ----------
    title : str
        As in the file.
    contact : Contact
        The interface.
    load : {"F_star", "pressure", "separation"}
        Which load is given.
    values : array (N,)
        Its values: F* [1], p [Pa] or d [m].
    notes : tuple of str
        What numbers were taken for what a drawing says, and what is allowed but looks like a
        slip; one sentence each.
    sweep : Plan, optional
        The states of the table [sweep].
    uncertainty : Uncertainty, optional
        What the table [uncertainty] says of the inputs.
    design : dict, optional
        What the table [design] asks: arguments of `thirdbody.design`.
    film : FilmConditions, optional
        What the table [film] says of bodies, oil and speeds.
    connector : AskedConnector, optional
        What the table [connector] says of contacts that close on dust.
    plate : AskedPlate, optional
        What the table [plate] says of a plate held on a chuck.
    life : AskedLife or AskedDry, optional
        What the table [life] says of an oil, or of a dry contact, over time.
    explicit : dict, optional
        What the table [explicit] says of the surfaces with every particle at its place.
    faces : tuple of Topography, optional
        The measured surfaces that stand in [roughness].
    own_load : bool, optional
        Whether the file gives a load of its own; else it is the Hertz pressure of [film].
    body : Body, optional
        What the table [body] says that a force presses together.
    forces : array (M,), optional
        Forces on the body [N]; ``values`` are then the mean and the largest pressure of each.
    assumed : tuple of str
        Those of the ``notes`` that say what numbers were taken for what a drawing says.
    gaps : tuple of float or None
        Of each population the height of oil that brings it [m]; None where the file states how
        many lie on an area.
    settings : tuple of str
        Keys that were set over the file, "load.force = 1 kN".
    filter : Filter, optional
        What the key film.filter says: the oil is answered before and behind it.
    stated : frozenset of str
        Dotted names of all keys that the file states.
    """

    title: str
    contact: Contact
    load: str
    values: np.ndarray
    notes: tuple[str, ...] = ()
    sweep: Plan | None = None
    uncertainty: Uncertainty | None = None
    design: dict[str, Any] | None = None
    film: FilmConditions | None = None
    connector: AskedConnector | None = None
    plate: AskedPlate | None = None
    life: AskedLife | AskedDry | None = None
    explicit: dict[str, Any] | None = None
    faces: tuple[Topography, ...] = ()
    own_load: bool = True
    body: Body | None = None
    forces: np.ndarray | None = None
    assumed: tuple[str, ...] = ()
    gaps: tuple[float | None, ...] = ()
    settings: tuple[str, ...] = ()
    filter: Filter | None = None
    stated: frozenset[str] = frozenset()

    @property
    def heading(self) -> str:
        """The title, and what was set over the file."""
        return heading_of(self.title or "Study", self.settings)

    @property
    def gap_notes(self) -> list[Note]:
        """Doubt of particles that are wider than the oil which brings them, beside a film."""
        return [] if self.film is None else notes_on_gaps(self.contact.populations, self.gaps)

    def stribeck(self) -> xarray.Dataset:
        """Lubricated states over the speeds of the table [film]; see `thirdbody.films.stribeck`."""
        if self.film is None:
            raise InvalidValue(
                Problem(
                    "film",
                    "is no table of this study",
                    hint="it says oil, bodies, load and speeds; solve() answers a dry contact",
                    code=Mistake.MISSING,
                )
            )
        return self.film.stribeck(self.contact)

    def solve(self) -> Equilibrium:
        """Every state, as arrays; see `thirdbody.solve`."""
        loads: dict[str, Any] = {"d" if self.load == "separation" else self.load: self.values}
        return solve(self.contact, **loads)


@names_arguments
def load_study(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : path-like
        A TOML file.
    overrides : iterable of str, optional
        ``"particles.mean=500 nm"``: keys to set after reading, values as in TOML; text that is
        not TOML counts as a string. One load takes the place of the load in the file. Several
        populations are numbered from 0, ``"particles.0.mean=500 nm"``.

    Returns
    -------
    Study

    Raises
    ------
    InvalidValue
        Every mistake of the file, one sentence each in ``problems``: the key, its value, what
        is allowed, and the likely cause.

    Examples
    --------
    >>> from pathlib import Path
    >>> import tempfile
    >>> import thirdbody as tb
    >>> file = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = file.write_text('''
    ... [surfaces]
    ... first = "S45C"
    ... second = "S45C"
    ... [roughness]
    ... sigma = "100 nm"
    ... R = "2.8 um"
    ... [load]
    ... pressure = "5 MPa"
    ... ''')
    >>> study = tb.load_study(file, ["roughness.sigma=200 nm"])
    >>> study.contact.roughness.sigma, study.values.tolist()
    (2e-07, [5000000.0])
    """
    settings = list(overrides)
    study = check(override(read(Path(path)), settings), folder=Path(path).parent)
    return replace(study, settings=tuple(map(setting_in_words, settings)))


def files_of(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> list[Path]:
    """Files from which a study is read: its own, and those that it names."""
    study_file = Path(path)
    out, waiting = (
        [study_file],
        [override(read(study_file), list(overrides))] if study_file.is_file() else [],
    )
    while waiting:
        value: object = waiting.pop()
        if isinstance(value, dict):
            waiting += value.values()
        elif isinstance(value, list):
            waiting += value
        elif isinstance(value, str):
            with suppress(OSError, ValueError):  # no name that a file can have
                out += [file for file in (study_file.parent / value, Path(value)) if file.is_file()]
    return out


def check(data: dict[str, object], *, folder: Path = Path()) -> Study:
    """The study that a parsed file in ``folder`` describes; raises as `load_study`."""
    needed = [
        table.name
        for table in TABLES
        if (table.key.required if table.required is None else table.required(data))
    ]
    return read_tables(data, folder, _study, needed)


def load_tables(
    path: str | os.PathLike[str],
    overrides: Iterable[str],
    build: Callable[[Reader, dict[str, object]], Asked],
    needed: Collection[str],
) -> Asked:
    """Object that some tables of a file describe; of them these are needed, and no others."""
    data = override(read(Path(path)), list(overrides))
    return read_tables(data, Path(path).parent, build, needed)


def read_tables(
    data: dict[str, object],
    folder: Path,
    build: Callable[[Reader, dict[str, object]], Asked],
    needed: Collection[str],
) -> Asked:
    """Object that a parsed file in ``folder`` describes; the tables of these names must stand."""
    load_installed()
    if "sweep" in data:
        data = with_nested_names(data)
    reader = Reader(folder, data)
    keys = {table.name: table.key._replace(required=table.name in needed) for table in TABLES}
    with slips_are_told():
        try:
            return reader.table("", data, keys, partial(build, reader))
        except InvalidValue as error:
            # to say where a misplaced key belongs, every table must be known
            all_keys = Describer(folder, data).known_of(TABLES)
            all_keys.keys |= reader.known_keys.keys
            raise InvalidValue(*all_keys.problems([*reader.mistakes, *error.problems])) from None


def _study(reader: Reader, values: dict[str, Any]) -> Study:
    """The study, from the objects that its tables stand for."""
    parts = {
        table.name: values[table.name]
        for table in TABLES
        if table.role == "contact" and table.name in values
    }
    if "particles" not in parts and parts.pop("particle_law", None) is not None:
        what = "[particle_law] has no effect, because there is no [particles] table"
        reader.notes.append(Note(what, code="idle.particle_law"))
    particles = parts.get("particles", ())
    several = particles if isinstance(particles, tuple) else (particles,)
    if "particle_law" in parts and all(population.law is not None for population in several):
        what = "[particle_law] has no effect: all particles have laws of their own"
        reader.notes.append(Note(what, code="idle.particle_law"))
    gaps = gaps_of(reader.whole)
    sweep = values.get("sweep")
    film: Any = values.get("film")
    contact = reader.make(Contact, "", parts)
    loaded = values.get("load") or ends(sweep or {})
    bodies: Any = values.get("body")
    given_forces = loaded[1] if loaded and loaded[0] == "force" else None
    if contact.outputs:
        contact, notes = on_area(contact, bodies, given_forces, reader.whole.get("outputs"))
        reader.notes += notes
    if film is not None:
        film = on_body(reader, film, bodies, given_forces, contact.E_ss)
    connector = connector_of(reader, values) if "connector" in values else None
    plate = plate_of(reader, values) if "plate" in values else None
    life = life_of(reader, values) if "life" in values else None
    load, loads = loaded or ("pressure", np.array([_own_pressure(film, connector, plate, contact)]))
    forces = None
    if load == "force":
        load, forces, loads = "pressure", loads, loads_of(bodies, loads, contact)
    elif bodies is not None:
        what = "[body] has no effect, because [load] gives no force"
        reader.notes.append(Note(what, code="idle.body"))
    if load == "separation" and sweep is None and np.any(deep := loads < deepest(contact)):
        raise InvalidValue(
            *(
                Problem(
                    "load.separation",
                    f"is refused: {why_deep(contact)}",
                    f"{d:g} m",
                    code=Mistake.RANGE,
                )
                for d in loads[deep][:5]
            )
        )
    if film is None:
        reader.notes += notes_on_gaps(several, gaps)
    states = None if sweep is None else plan(reader, contact, load, loads, sweep)
    return Study(
        title=values.get("title", ""),
        contact=contact,
        load=load,
        values=loads,
        notes=tuple(dict.fromkeys([*reader.assumed, *reader.notes])),
        assumed=tuple(dict.fromkeys(reader.assumed)),
        gaps=gaps,
        filter=None if film is None else filter_of(reader.whole),
        stated=reader.stated_keys,
        sweep=states,
        uncertainty=values.get("uncertainty"),
        design=values.get("design"),
        film=film,
        connector=connector,
        plate=plate,
        life=life,
        explicit=values.get("explicit"),
        faces=tuple(reader.faces),
        own_load=loaded is not None,
        body=bodies if forces is not None else None,
        forces=forces,
    )


def _own_pressure(
    film: FilmConditions | None,
    connector: AskedConnector | None,
    plate: AskedPlate | None,
    contact: Contact,
) -> float:
    """Nominal pressure of a study without [load]: that of its film, contacts or plate [Pa]."""
    if film is not None:  # without oil, all is on solids
        return film.nominal_pressure(contact)
    if connector is not None:
        return connector.pressure(contact.E_ss)
    assert plate is not None  # else [load] is required
    return plate.chuck.pressure
