r"""One interface under every law: what the choice of the asperity law is worth.

The laws of the literature differ in when an asperity yields and what it does then. `compare`
solves the same contact at the same loads under each of them,

.. math:: \Delta A = 100\,\left(\frac{A_t}{A_t^{own}} - 1\right), \qquad
          \frac{\Delta d}{\sigma} = \frac{d - d^{own}}{\sigma},

where "own" is the law the contact came with. Only asperities change their law; particles keep
theirs.
"""

from __future__ import annotations

import dataclasses
import json
import math
import warnings
from collections.abc import Iterable, Mapping
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contact.citations import cite
from ..contact.contact import Contact
from ..contact.interface import interface
from ..equilibrium.columns import COLUMNS, PLASTIC_SHARE, Equilibrium
from ..equilibrium.doubts import BEYOND
from ..equilibrium.load import ForceLoad, as_force_load
from ..equilibrium.solve import given_load, solve
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, code_of
from ..laws.asperity import REGISTRY, AbstractAsperityLaw
from ..quantities.arguments import is_empty
from ..quantities.carried import takes_units
from ..quantities.files import csv_of, with_units
from ..quantities.nearest import guess
from ..quantities.record import NOTES, VERSION, Column, TableRecord, Variable
from ..quantities.say import percent

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["compare", "csv_text"]

KEPT = (
    *("d", "d_star", "F_ss_star", "A_t", "A_ss", "A_sa", "A_e", "A_ep", "A_p"),
    *("particle_load_share", "mode", "status", "residual"),
)
"""Columns of `Equilibrium` that differ from law to law."""
DERIVED = {
    "mean_pressure": Column("p_m", "Pa", "mean real pressure F/A_t"),
    "elastic_share": Column("A_e/A_t", "1", "elastic part of the real area"),
    "elastoplastic_share": Column("A_ep/A_t", "1", "elastoplastic part of the real area"),
    "plastic_share": PLASTIC_SHARE,
    "A_t_difference": Column("ΔA_t", "%", "real area against the contact's own law"),
    "mean_pressure_difference": Column("Δp_m", "%", "mean real pressure against the own law"),
    "particle_load_share_difference": Column(
        "Δ(F_sa/F_t)", "%", "particles' load against the own law"
    ),
    "d_star_difference": Column("Δd/σ", "1", "separation d above that of the own law, over σ"),
}
"""Symbol, unit and meaning of what a comparison adds."""
TELLING = 0.01
"""Share of the area beyond a law's range from which a comparison says so."""
NO_PARTICLES = "knows no particles: ask it of the contact without them"
ATOMIC = 0.2e-9
"""Distance z_0 of atomic planes in the Tabor number [m]."""


class Persson:
    r"""A second opinion on the area, of no asperities at all.

    .. math:: A_t = \operatorname{erf}\frac{\sqrt2\,p}{E^*g}, \qquad
              g^2 = 2m_2 = \frac{3\sqrt\pi}{4}\,\frac{\sigma}{R\sqrt\alpha}

    with the RMS slope g of the roughness. It knows neither yielding nor a separation.
    """

    name = "persson"
    title = "Area after Persson: elastic, without asperities"
    year = 2001
    citation = "Persson 2001, J. Chem. Phys. 115, 3840 (recalled), doi:10.1063/1.1388626"

    @staticmethod
    def state(contact: Contact, pressure: Array) -> SimpleNamespace:
        """What stands in the columns of a comparison; NaN where it says nothing."""
        rough = contact.roughness
        m_2 = 3 * math.sqrt(math.pi) / 8 * rough.sigma / (rough.R * math.sqrt(rough.alpha))
        slope = math.sqrt(2 * m_2)
        area = np.vectorize(math.erf)(math.sqrt(2) * pressure / (contact.E_ss * slope))
        none, unknown = np.zeros_like(area), np.full_like(area, np.nan)
        columns = {"F_ss_star": pressure / contact.E_ss, "mode": "s-s", "status": "ok"}
        columns |= dict.fromkeys(("A_t", "A_ss", "A_e"), area)
        columns |= dict.fromkeys(("A_sa", "A_ep", "A_p", "particle_load_share"), none)
        return SimpleNamespace(**dict.fromkeys(KEPT, unknown) | columns)


# -------------------------------------------------------------------------- comparing
@takes_units
def compare(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    laws: Iterable[str | AbstractAsperityLaw] | str | AbstractAsperityLaw | None = None,
) -> xarray.Dataset:
    """The same interface under every asperity law.

    Parameters
    ----------
    contact : Contact
        With or without particles; its ``asperity_law`` is what the others are held against.
    pressure, F_star : float or array (N,)
        Loads F* [1] or nominal pressures [Pa]; exactly one of them.
    laws : list of str or AbstractAsperityLaw, optional
        Words of the registry, which mean the law with its default options, or laws. When left
        out: every registered law but the adhesive ones, which need a work of adhesion, the coated
        one, which needs the coating, and the elliptic ones, which equal their circular ones at a
        ratio of 1. The contact's own law is always there and comes first. ``persson``, the last
        row where nothing is asked and no particles lie between, is no law of asperities but a
        second opinion on the elastic area, erf(√2 p/E*g) with the RMS slope g.

    Returns
    -------
    xarray.Dataset
        Dimensions ``law`` and the load. Separation, areas and their regimes as in `solve`;
        ``mean_pressure`` F/A_t; ``elastic_share`` and its neighbours, what each law believes of
        the real area; differences against the own law at the same load, in per cent
        (``A_t_difference``, ...) or in σ (``d_star_difference``). A law that fails keeps its
        row, NaN, and ``note`` says why; ``note`` also says where a law leaves its range.

    Raises
    ------
    InvalidValue
        No load or two, or a word that names no law.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = tb.compare(contact, F_star=[1e-5, 1e-4], laws=["ceb", "jg"])
    >>> table.law.values.tolist()
    ['zmc', 'ceb', 'jg']
    >>> table.A_t_difference.sel(law="ceb").values.round(0).tolist()
    [29.0, 35.0]
    """
    return comparison_of(contact, pressure=pressure, F_star=F_star, laws=laws).to_dataset()


@dataclasses.dataclass(frozen=True, eq=False, slots=True)
class Comparison(TableRecord):
    """What `compare` finds, in plain columns: loading xarray takes longer than comparing."""

    in_dict = (
        VERSION,
        ("inputs", lambda one: json.loads(one.attrs["inputs"]) | {one.load: one.loads[one.load]}),
        ("own_law", lambda one: one.attrs["own_law"]),
        *("laws", ("states", lambda one: one.flat()[0]), "warnings"),
        NOTES,
        ("citations", lambda one: one.attrs["citations"].splitlines()),
    )
    along = "law"
    load: str
    """Which load is given, ``F_star`` [1] or ``pressure`` [Pa]."""
    loads: dict[str, Array]
    """Both loads (N,), the given one first."""
    laws: dict[str, str]
    """Full titles by label, the contact's own law first."""
    options: list[str]
    """What each law is, as JSON."""
    notes: list[str]
    """What is to be said of each law."""
    columns: dict[str, Array]
    """Numbers and words (laws, N)."""
    attrs: dict[str, Any]
    """Own law, hardness, inputs, version, citations, warnings."""
    warnings: tuple[str, ...] = ()
    """What the states of the own law are warned of, one sentence each."""

    def flat(self) -> tuple[dict[str, list[object]], dict[str, str]]:
        """Columns with a row for each law and load, and their units; None where there is none."""
        shape = len(self.laws), len(self.loads[self.load])
        both = {name: np.broadcast_to(values, shape) for name, values in self.loads.items()}
        columns = both | self.columns
        units = {name: _about(name)["units"] for name in columns}
        return flat(list(self.laws), columns, self.notes), {"law": "", **units, "note": ""}

    def variables(self) -> dict[str, Variable]:
        """What each law says under each load."""
        dims = (self.along, self.load)
        return {name: Variable(dims, column, _about(name)) for name, column in self.columns.items()}

    def coordinates(self) -> dict[str, Variable]:
        """The laws, and what is said of each; both loads."""
        of_laws = {"title": list(self.laws.values()), "options": self.options, "note": self.notes}
        names = Variable((self.along,), list(self.laws), {"long_name": "asperity law"})
        return {
            self.along: names,
            **{name: Variable((self.load,), x, _about(name)) for name, x in self.loads.items()},
            **{name: Variable((self.along,), words) for name, words in of_laws.items()},
        }

    def attributes(self) -> dict[str, Any]:
        """Own law, hardness, inputs, version, citations, warnings."""
        return self.attrs


def comparison_of(
    contact: Contact,
    *,
    pressure: ArrayLike | None = None,
    F_star: ArrayLike | None = None,
    laws: Iterable[str | AbstractAsperityLaw] | str | AbstractAsperityLaw | None = None,
) -> Comparison:
    """As `compare`, in plain columns."""
    from ..version import __version__

    load, values, _ = given_load(contact, pressure, F_star, None)
    if load == "F_star":
        load_values = np.atleast_1d(np.asarray(F_star, dtype=float))
        loads = {"F_star": load_values, "pressure": values}
    else:
        load_values = values
        loads = {"pressure": values, "F_star": values / contact.E_ss}
    rows = _rows(contact, laws)
    solved = [_solve_law(contact, law, as_force_load(load, load_values)) for law in rows.values()]
    notes, common = _without_repeats(solved)
    used = [
        _contact_with_law(contact, law)
        for law in rows.values()
        if isinstance(law, AbstractAsperityLaw)
    ]
    cited = "\n".join(cite(with_law) for with_law in used)
    if any(isinstance(law, Persson) for law in rows.values()):
        cited += f"\n{Persson.citation}"
    return Comparison(
        load=load,
        loads=loads,
        laws={name: _title(law) for name, law in rows.items()},
        options=[_options(law) for law in rows.values()],
        notes=["; ".join(note) for note in notes],
        columns=_columns(contact, solved, values),
        attrs={
            "own_law": next(iter(rows)),
            "hardness": contact.surfaces.H,
            "inputs": json.dumps(contact.to_dict(), ensure_ascii=False),
            "version": __version__,
            "citations": "\n".join(dict.fromkeys(cited.splitlines())),
            "warnings": "\n".join(common),
        },
        warnings=common,
    )


class _Solved(NamedTuple):
    """One law: its states, or None; what to say of the row; warnings of the states."""

    state: Equilibrium | SimpleNamespace | None
    note: list[str]
    heard: tuple[str, ...] = ()


def _columns(contact: Contact, solved: list[_Solved], load: Array) -> dict[str, Array]:
    """Numbers and words (laws, N) of the states; a law without states has NaN, and says why."""
    shape = len(solved), len(load)
    data: dict[str, Array] = {}
    for name in KEPT:
        words = name in ("mode", "status")
        column = np.full(shape, "", dtype=object) if words else np.full(shape, np.nan)
        for i, (state, note, _) in enumerate(solved):
            if state is not None:
                column[i] = getattr(state, name)
            elif name == "status":
                column[i] = note[0]
        data[name] = column
    data |= _derived_columns(data, load)
    if contact.two_body:
        for name in ("particle_load_share", "particle_load_share_difference"):
            data.pop(name)
    for name in ("mode", "status"):
        data[name] = data[name].astype(str)
    return data


def _without_repeats(solved: list[_Solved]) -> tuple[list[list[str]], tuple[str, ...]]:
    """Notes of each law, and what the states of the own law, the first, are warned of.

    What is told of the own law, with other numbers, is not told again of the others.
    """
    common = solved[0].heard
    common_codes = {code_of(text) for text in common}
    notes = [
        note + [text for text in heard if code_of(text) not in common_codes]
        for _, note, heard in solved
    ]
    return notes, common


def _rows(contact: Contact, laws: Any) -> dict[str, AbstractAsperityLaw | Persson | type]:
    """The laws to compare by label, the contact's own first; a class where no law can be made."""
    own_law = contact.asperity_law
    by_year = sorted(REGISTRY.values(), key=lambda law: (law.year, law.name))
    if laws is None:
        chosen: list[object] = [law.name for law in by_year if not _special(law)]
        chosen += [Persson.name] if contact.two_body else []
    elif isinstance(laws, (str, AbstractAsperityLaw)):
        chosen = [laws]
    else:
        chosen = list(laws)
    problems: list[str] = []
    compared: list[AbstractAsperityLaw | Persson | type] = [own_law]
    for item in chosen:
        if isinstance(item, AbstractAsperityLaw):
            compared.append(item)
        elif item == Persson.name:
            compared.append(Persson())
        elif isinstance(item, str) and item in REGISTRY:
            compared.append(own_law if item == own_law.name else _usual(REGISTRY[item]))
        else:
            hint = guess(str(item), REGISTRY, show=repr, otherwise=None, cutoff=0.4)
            options = ", ".join([*(law.name for law in by_year), Persson.name])
            rule = f": {item!r} names no asperity law ({options})"
            problems.append(Problem("laws", rule, hint=hint, code=Mistake.UNKNOWN))
    if not chosen:
        problems.append(is_empty("laws", "give at least one law, or leave it out for all"))
    if problems:
        raise InvalidValue(*problems)
    return {_label(law): law for law in compared}


def _special(law: type) -> bool:
    """A law that asks for more than the interface: adhesion w, a ratio of radii, a coating t."""
    return bool({item.name for item in dataclasses.fields(law)} & {"w", "ratio", "t"})


def _usual(law: type) -> Any:
    try:
        return law()
    except (TypeError, InvalidValue):
        return law


def _label(law: Any) -> str:
    """The law's word, with the options that are not its usual ones."""
    if isinstance(law, type | Persson) or isinstance(usual := _usual(type(law)), type):
        return law.name
    changed = [
        f"{item.name}={getattr(law, item.name)!r}".replace("'", "")
        for item in dataclasses.fields(law)
        if getattr(law, item.name) != getattr(usual, item.name)
    ]
    return law.name + (f"({', '.join(changed)})" if changed else "")


def _title(law: Any) -> str:
    return f"{law.title} ({law.year})"


def _options(law: AbstractAsperityLaw | Persson | type) -> str:
    return "" if isinstance(law, type | Persson) else json.dumps(law.to_dict(), ensure_ascii=False)


def _contact_with_law(contact: Contact, law: AbstractAsperityLaw) -> Contact:
    """The contact with another law; a law of one shape has tips of the same R all alike."""
    rough = contact.roughness
    if getattr(law, "ratio", None) != 1:
        rough = rough.replace(ellipticity=None)
    return contact.replace(roughness=rough, asperity_law=law)


def _solve_law(
    contact: Contact, law: AbstractAsperityLaw | Persson | type, load: ForceLoad[Array]
) -> _Solved:
    if isinstance(law, Persson):
        if not contact.two_body:
            return _Solved(None, [NO_PARTICLES])
        _, pressure, _ = given_load(contact, load.get("pressure"), load.get("F_star"), None)
        return _Solved(
            law.state(contact, pressure),
            ["the elastic area after Persson, a second opinion; no asperity law of a study"],
        )
    if isinstance(law, type):
        return _Solved(None, ["has options without a usual value: give the law itself"])
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore", RangeWarning)
            changed = _contact_with_law(contact, law)
            state = solve(changed, **load)
            note = _outside(changed, state)
    except Exception as error:  # a law can be anybody's: whatever it does, the others stand
        why = str(error).strip().splitlines() or [type(error).__name__]
        return _Solved(None, [f"failed: {why[0]}"])
    status = np.asarray(state.status)
    bad = status[status != "ok"]
    if len(bad):
        count = "no state" if len(bad) == len(status) else f"{len(bad)} state(s) not"
        note.insert(0, f"{count} solved: {bad[0]}")
    # the note tells of the range already, in parts of the area
    heard = tuple(text for text in state.warnings if code_of(text) != BEYOND)
    return _Solved(state, note, heard)


def _derived_columns(data: dict[str, Array], load: Array) -> dict[str, Array]:
    """Mean pressure, regime shares, and differences against the first row."""
    with np.errstate(divide="ignore", invalid="ignore"):
        area = data["A_t"]
        out = {
            "mean_pressure": load / area,
            "elastic_share": data["A_e"] / area,
            "elastoplastic_share": data["A_ep"] / area,
            "plastic_share": data["A_p"] / area,
        }
        for name in ("A_t", "mean_pressure", "particle_load_share"):
            column = out.get(name, data.get(name))
            out[f"{name}_difference"] = 100 * (column / column[0] - 1)  # type: ignore[index]
    out["d_star_difference"] = data["d_star"] - data["d_star"][0]
    return out


def _about(name: str) -> dict[str, str]:
    return (DERIVED.get(name) or COLUMNS[name]).labels


# -------------------------------------------------------------------------- ranges
def _outside(contact: Contact, state: Equilibrium) -> list[str]:
    """Where the states leave the published range of the law, one phrase each."""
    law, R = contact.asperity_law, contact.roughness.R
    E_star, H = contact.E_ss, contact.surfaces.H
    body: dict[str, float] = dict(R=R, E_star=E_star, H=H)
    law_in_contact = law.bound(**body, nu=contact.surfaces.softer.nu)
    out = []
    w = getattr(law, "w", None)
    if w is not None:
        tabor = (R * w**2 / (E_star**2 * ATOMIC**3)) ** (1 / 3)
        out.append(
            f"w = {w:g} J/m², Tabor number {tabor:.2g} (z_0 = 0.2 nm); meant for: {law.valid_range}"
        )
    limit = law_in_contact.valid_to * float(law_in_contact.yield_interference(**body))
    d = np.atleast_1d(np.asarray(state.d, dtype=float))
    if math.isinf(limit) or not np.any(np.isfinite(d)):
        return out
    share = _share_beyond(contact, law_in_contact, float(np.nanmin(d)), limit, body)
    if share > TELLING:
        share_text = percent(share, digits=2 if share > 0.095 else 1)
        out.append(
            f"at the highest load {share_text} of the asperities' area is {law_in_contact.beyond}"
        )
    return out


def _share_beyond(
    contact: Contact, law: AbstractAsperityLaw, d: float, limit: float, body: dict[str, float]
) -> float:
    """Part of the asperities' area that is pressed by more than ``limit``."""
    asperities = interface(contact).asperities
    sigma_s, heights = asperities.sigma_s, contact.roughness.heights
    h = (d - asperities.centre) / sigma_s
    reach = min(heights.highest, max(h, 0.0) + 8.0) - h
    if reach <= 0:
        return 0.0
    omega = sigma_s * reach * (np.arange(8000) + 0.5) / 8000
    area = law.area(omega, **body) * heights.pdf(h + omega / sigma_s)
    return float(area[omega > limit].sum() / area.sum()) if area.any() else 0.0


# -------------------------------------------------------------------------- showing
def csv_text(table: xarray.Dataset) -> str:
    """A comparison as comma-separated values: one row for each law and load.

    Parameters
    ----------
    table : xarray.Dataset
        From `compare`.

    Returns
    -------
    str
        Header with units; NaN is an empty cell.
    """
    load = table.A_t.dims[1]
    columns = {
        name: table[name].broadcast_like(table.A_t).transpose("law", load).values
        for name in (load, "pressure" if load == "F_star" else "F_star", *map(str, table.data_vars))
    }
    plain = flat(table.law.values.tolist(), columns, table.note.values.tolist())
    units = {name: table[name].attrs["units"] for name in columns}
    return csv_of(with_units(plain, units))


def flat(
    laws: list[str], columns: Mapping[str, NDArray[np.generic]], notes: list[str]
) -> dict[str, list[object]]:
    """Columns (laws, N) with a row for each law and load; None where nothing is to be told."""
    count = len(columns["A_t"][0])
    rows = {"law": [law for law in laws for _ in range(count)]}
    rows |= {name: np.asarray(values).ravel().tolist() for name, values in columns.items()}
    rows["note"] = [note for note in notes for _ in range(count)]
    return {
        name: [None if value == "" or value != value else value for value in column]
        for name, column in rows.items()
    }
