"""What a state is: its columns, their symbols and units, its mode."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact.citations import cite
from ..contact.contact import Contact
from ..contact.output import column as output_column
from ..errors import InvalidValue
from ..quantities.arguments import names_arguments, need_one
from ..quantities.carried import takes_units
from ..quantities.notebook import Card
from ..quantities.record import NOTES, Column, StateRecord, Variable, column, declared_columns
from ..quantities.units import Quantity
from ..version import __version__
from .modes import EPS_1, EPS_2, MODES, Basis, need_shares
from .status import STATUS_CODE

if TYPE_CHECKING:
    import xarray

__all__ = ["Equilibrium"]

Array = NDArray[np.float64]

Number = float | Array

MODE_OF_CODE = np.array(["", *MODES])
CODE = "status_code"
"""Column of the codes of `Status`, beside those of a result."""


class _ContactRecord(StateRecord):
    """States with the columns of the outputs of a contact beside their own."""

    __slots__ = ()

    @names_arguments
    def about(self, name: str) -> Column:
        """Symbol, unit and meaning of a column, of the state itself or of an output."""
        columns = {**declared_columns(type(self)), **self.more_columns}
        return columns.get(name) or output_column(name)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Equilibrium(_ContactRecord):
    """The solved contact: floats for one load, arrays for several.

    Areas are real areas per nominal area; F* = F/(A_n E_ss). A state that could not be solved
    holds NaN and a sentence in `status`. One whose real area is above 0.5 holds what the model
    says, and a `status` that begins with "crowded": no model that counts contacts one by one is
    an answer there.

    `d` counts from the datum of the particle law: the mean asperity height, except for
    `Horng2022`, which like the paper's eq. (8) puts that height at σ. `h`, from the mean surface
    plane, is the separation to compare between models.

    Made by `solve`, where accuracy and source stand. The columns are named as in the
    nomenclature.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel),
    ...     roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...     particles=tb.Particles(material=silica, areal_density=1e11,
    ...                            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9)))
    >>> state = tb.solve(contact, pressure=[1e6, 5e6, 2e7])  # Pa
    >>> state.mode.tolist(), state.d_star.round(2).tolist()
    (['hybrid', 'hybrid', 'hybrid'], [3.1, 2.26, 1.55])
    >>> state.modes(eps_1=0.05).tolist()  # 95 % of the area count as all of it
    ['p-s', 'hybrid', 'hybrid']
    """

    more_columns = {CODE: STATUS_CODE}
    in_columns = ("population",)
    in_dict = (*_ContactRecord.in_dict, "populations", "warnings", NOTES)
    contact: Contact = field(repr=False)
    """What was solved."""
    d: Number = column("d", "m", "separation d, from the mean asperity height")
    h: Number = column("h", "m", "separation of the mean planes")
    d_star: Number = column("d*", "1", "separation d over σ")
    F_star: Number = column("F_t*", "1", "load F/(A_n E_ss)")
    pressure: Number = column("p", "Pa", "nominal pressure")
    F_ss_star: Number = column("F_ss*", "1", "load on asperities")
    F_sa_star: Number = column("F_sa*", "1", "load on particles")
    A_t: Number = column("A_t*", "1", "real contact area")
    A_ss: Number = column("A_ss*", "1", "real area of asperities")
    A_sa: Number = column("A_sa*", "1", "real area of particles on surface 1")
    A_sa2: Number = column("A_sa2*", "1", "real area of particles on surface 2")
    A_e: Number = column("A_e*", "1", "elastic area")
    A_ep: Number = column("A_ep*", "1", "elastoplastic area")
    A_p: Number = column("A_p*", "1", "plastic area")
    shadow: Number = column("ς", "1", "share of area in which particles keep asperities apart")
    particle_load_share: Number = column("F_sa/F_t", "1", "load share of particles")
    particle_area_share: Number = column("A_sa,t*", "1", "area share of particles")
    mode: str | NDArray[np.str_] = column("mode", "", "contact mode")
    """p-s, hybrid or s-s by area. Where nothing touches, and in a state without a number, it is "",
    in data sets and tables too; None in `to_dict` and null in JSON.
    """
    status: str | NDArray[np.str_] = column("status", "", "ok, or why there is no state")
    residual: Number = column("r", "1", "relative imbalance |F_t/F − 1|")
    iterations: int | NDArray[np.int_] = column("n", "", "evaluations of the load")
    warnings: tuple[str, ...] = ()
    """Where the answer leaves the range of a model: cause, effect, what to do; a sentence each.

    Each is a `thirdbody.errors.Note`, with ``code``, ``effect`` and ``action``. ``notes`` is the
    same.
    """
    populations: tuple[PopulationShare, ...] = ()
    """What each of several populations carries; empty for one."""
    outputs: Mapping[str, Number] = field(default_factory=dict)
    """Every column of the outputs that the contact carries, by name."""
    engine: str = "numpy"
    """What found the separations: "compiled", or "numpy: " and why the compiled engine did not."""
    status_code: int | NDArray[np.int8] = 0
    """`thirdbody.results.Status` of each state, of which `status` is the sentence."""

    @property
    def scales(self) -> dict[str, float]:
        """What makes the starred quantities: E_ss [Pa] and σ [m]."""
        return {"E_ss": self.contact.E_ss, "sigma": self.contact.roughness.sigma}

    def attributes(self) -> dict[str, str]:
        """Attributes of a data set that hold for all its states."""
        said = {"engine": self.engine, "warnings": "\n".join(self.warnings)}
        return said | provenance(self.contact)

    def variables(self) -> dict[str, Variable]:
        """The columns, and those of several populations along ``population`` too."""
        parts, dims = self.populations, ("state", "population")
        stacked = {
            f"population_{name}": Variable(
                dims,
                np.stack([population.columns()[name] for population in parts], axis=-1),
                population.about(name).labels,
            )
            for population in parts[:1]
            for name in population.columns()
        }
        return {**_ContactRecord.variables(self), **stacked}

    def coordinates(self) -> dict[str, Variable]:
        """Names of several populations."""
        names = [population.name for population in self.populations]
        return {"population": Variable(("population",), names)} if names else {}

    def _cards(self) -> Iterator[Card]:
        """The states, then what each of several populations carries in them."""
        yield from _ContactRecord._cards(self)
        for population in self.populations:
            yield from population._cards()

    @takes_units
    def modes(
        self, *, eps_1: float = EPS_1, eps_2: float = EPS_2, basis: Basis = "area"
    ) -> str | NDArray[np.str_]:
        """Contact mode with other thresholds, by area (as in the paper) or by load.

        Parameters
        ----------
        eps_1, eps_2 : float, optional
            Thresholds, as of `thirdbody.transitions` [1].
        basis : {"area", "load"}, optional
            Whose shares are compared.

        Raises
        ------
        InvalidValue
            A threshold outside 0 to 1, another basis.
        """
        need_shares(eps_1=eps_1, eps_2=eps_2)
        need_one("basis", basis, *get_args(Basis))
        share = self.particle_area_share if basis == "area" else self.particle_load_share
        return _mode(share, eps_1, eps_2)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class PopulationShare(_ContactRecord):
    """Load and area on one of several populations of particles: floats for one load, else arrays.

    Part of `Equilibrium.populations`; the shares of all populations add up to
    ``particle_load_share`` and ``particle_area_share``.
    """

    in_dict = ("name", *_ContactRecord.in_dict)
    name: str
    F_sa_star: Number = column("F_sa*", "1", "load on the particles of a population")
    A_sa: Number = column("A_sa*", "1", "real area of a population on surface 1")
    load_share: Number = column("F_sa/F_t", "1", "load share of a population")
    area_share: Number = column("A_sa,t*", "1", "area share of a population")
    outputs: Mapping[str, Number] = field(default_factory=dict)
    """Columns of the outputs that each population has of its own, as its dents, by name."""

    def _cards(self) -> Iterator[Card]:
        """The states of the population, under its name."""
        for card in _ContactRecord._cards(self):
            yield card._replace(title=f"{self.name}: {card.title}")


BESIDE = {"engine": Column("", "", "what found the separation"), CODE: STATUS_CODE}
"""What stands beside the columns of many states."""

COLUMNS = declared_columns(Equilibrium)
"""Symbol, unit and meaning of every column of a result."""


PLASTIC_SHARE = Column("A_p/A_t", "1", "plastic part of the real area")
"""What is asked of states besides their columns."""


def about(name: str) -> Column:
    """Symbol, unit and meaning of a column, of the state itself or of an output."""
    return COLUMNS.get(name) or BESIDE.get(name) or output_column(name)


def quantity_of(contact: Contact, name: str) -> Quantity | None:
    """Symbol, unit and range of an input by its dotted name."""
    path, _, last = name.rpartition(".")
    try:
        owner = contact.value_at(path)
    except InvalidValue:
        return None
    if not is_dataclass(owner):
        return None
    return {item.name: item.metadata.get("quantity") for item in fields(owner)}.get(last)


def labels_of(contact: Contact, name: str) -> dict[str, str]:
    """Attributes of an input or load in a data set."""
    if name in COLUMNS:
        return COLUMNS[name].labels
    quantity = quantity_of(contact, name)
    return (
        {}
        if quantity is None
        else Column(quantity["symbol"], quantity["unit"], quantity["meaning"]).labels
    )


def provenance(contact: Contact) -> dict[str, str]:
    """Attributes of a data set that say where its states come from."""
    return {
        "inputs": json.dumps(contact.to_dict(), ensure_ascii=False),
        "version": __version__,
        "citations": cite(contact),
    }


def dataset(
    contact: Contact,
    columns: Mapping[str, NDArray[Any]],
    inputs: Mapping[str, NDArray[Any]],
    attrs: Mapping[str, str],
) -> xarray.Dataset:
    """States (N,) as labelled data, with their ``inputs`` as coordinates."""
    import xarray

    data = {
        name: ("state", values, about(name).attributes)
        for name, values in columns.items()
        if name not in inputs
    }
    coords = {
        name: (
            "state",
            values.astype(str) if values.dtype == object else values,
            labels_of(contact, name),
        )
        for name, values in inputs.items()
    }
    return xarray.Dataset(data, coords=coords, attrs={**attrs, **provenance(contact)})


def columns_of(contact: Contact) -> tuple[str, ...]:
    """Names of the columns that states of a contact have."""
    return (*COLUMNS, *(name for output in contact.outputs for name in output.columns))


def _mode(particle_share: ArrayLike, eps_1: float, eps_2: float) -> str | NDArray[np.str_]:
    share = np.asarray(particle_share)
    # codes first: choosing among strings is slow
    sliding = np.where(1 - share >= 1 - eps_2, 3, 2)
    code = np.where(share >= 1 - eps_1, 1, sliding)
    out = MODE_OF_CODE[np.where(np.isnan(share), 0, code)]
    return out if out.ndim else str(out)


def as_columns(
    raw: Mapping[str, Array],
    d: Array,
    mean_plane: Number,
    sigma: Number,
    E: Number,
    *,
    target: Array | None,
    F_star: Array | None = None,
) -> dict[str, Any]:
    """Every numeric column of a result, and the mode, from pressures and areas at d."""
    F = raw["F_ss"] + raw["F_sa"]
    with np.errstate(invalid="ignore", divide="ignore"):
        area_share = raw["A_sa"] / raw["A_t"]
        load_share = raw["F_sa"] / F
        residual = np.abs(F / target - 1) if target is not None else np.where(np.isnan(d), d, 0.0)
    load = F if target is None else target
    return {
        "d": d,
        "h": d + mean_plane,
        "d_star": d / sigma,
        "F_star": load / E if F_star is None else F_star,
        "pressure": load,
        "F_ss_star": raw["F_ss"] / E,
        "F_sa_star": raw["F_sa"] / E,
        **{name: raw[name] for name in COLUMNS if name in raw},
        "particle_load_share": load_share,
        "particle_area_share": area_share,
        "mode": _mode(area_share, EPS_1, EPS_2),
        "residual": residual,
    }
