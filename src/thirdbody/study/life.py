"""The table [life]: an oil over time, its circuit, its filters and what is waited for."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

from ..analysis.uncertainty.inputs import Uncertain
from ..contact.evaluation import bodies_of
from ..errors import InvalidValue, Mistake, Problem
from ..populations.materials import Material
from ..quantities.say import percent, value_of
from ..quantities.units import Quantity
from ..quantities.value import Value, quantity
from ..systems.life import until
from ..systems.life.circuit import OilCircuit
from ..systems.life.report_notes import below_counts, share_beyond
from ..systems.life.reports import oil_reports
from ..systems.oil_filter import Filter
from .described import BareNumber, Described
from .life_contact import (
    CONTACT_KEYS,
    HARDNESS,
    LifeContact,
    Rolling,
    contact_of,
    rolling_of,
)
from .life_contact import QUANTITIES as OF_CONTACT
from .life_design import AskedDesign, design_key, design_of
from .life_dirt import CLEAN, CODE, DIRT, INGRESS, dirts_of, sized_numbers
from .life_dry import BANDS_HARDNESS, DRY, AskedDry, dry_of
from .life_uncertainty import KnownOfLife, about_circuit, known_of_life, one_name_of
from .reader import (
    NOTHING,
    Key,
    Reader,
    Table,
    get,
    keys_of,
    number,
    quantity_key,
    read_number,
    switch,
    wrong,
)
from .surfaces import MATERIAL

__all__ = ["CLEAN", "LIFE", "AskedDry", "AskedLife", "life_of"]

DURATION = quantity("t", "s", "how long at most", gt=0, hint="hours are '1000 h'").metadata[
    "quantity"
]
BETA = quantity("β", "1", "particles before over particles behind", ge=1).metadata["quantity"]
TIME = quantity("t", "s", "time", gt=0, hint="e.g. '500 h'").metadata["quantity"]
OF_CONTACT_UNTIL = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "wear_depth": quantity("w", "m", "wear depth of either surface", gt=0),
        "roughness": quantity("σ", "m", "roughness to which the surfaces have run in", gt=0),
        "particle_share": quantity("s", "1", "part of the load on particles", gt=0, lt=1),
    }.items()
}
CONTACT_WAITS: Mapping[str, Callable[[float], until.Until]] = {
    "wear_depth": until.wear_depth,
    "roughness": until.roughness_below,
    "particle_share": until.particle_share,
}
"""What is waited for in a contact."""


@dataclass(frozen=True, eq=False, kw_only=True)
class AskedLife:
    """What a study says of a life.

    Parameters
    ----------
    title : str
        As in the file.
    circuit : OilCircuit
        Oil, ingress, filters.
    duration : float
        How long at most [s].
    until : tuple of Until
        What is waited for.
    uncertainty : dict of str to Uncertain
        What is known of the numbers of the circuit and of its contacts.
    drawn : KnownOfLife
        The same, and how many sets are drawn of it.
    contact : LifeContact, optional
        The contacts that the oil goes through.
    rolling : Rolling, optional
        The contact in whose tracks dents are counted.
    design : AskedDesign, optional
        What is to be chosen.
    notes : tuple of str
        What is allowed but looks like a slip.
    assumed : tuple of str
        What was taken for what the file does not say.
    stated : frozenset of str
        Dotted names of all keys that the file states.
    """

    title: str
    circuit: OilCircuit
    duration: float
    until: tuple[until.Until, ...] = ()
    uncertainty: Mapping[str, Uncertain] = field(default_factory=dict)
    drawn: KnownOfLife = field(default_factory=KnownOfLife)
    contact: LifeContact | None = None
    rolling: Rolling | None = None
    design: AskedDesign | None = None
    notes: tuple[str, ...] = ()
    assumed: tuple[str, ...] = field(default=())
    stated: frozenset[str] = frozenset()

    @property
    def described_inputs(self) -> Described:
        """What the tables describe."""
        bodies = {
            dirt.material.name or "particles": dirt.material
            for some in (self.circuit.start, self.circuit.ingress)
            for dirt in some
        }
        values: dict[str, Value] = {"life.oil.": self.circuit}
        if self.contact is not None:
            values |= {"": self.contact.contact}
            bodies |= bodies_of(self.contact.contact)
        rows = (BareNumber("life.duration", DURATION, self.duration),)
        return Described(values, bodies, rows)


def _duration(reader: Reader, path: str, value: object) -> float:
    """A duration; without a unit it is in seconds, which is said."""
    duration = read_number(DURATION, reader, path, value)
    bare = str(value).strip()
    if re.fullmatch(r"[\d.+]+([eE][+-]?\d+)?", bare):
        said = f"{path} = {bare} has no unit and is taken as {value_of(duration, 's')}"
        reader.assumed.append(f'{said}; for hours write "{bare} h"')
    return duration


def _times(reader: Reader, path: str, value: object) -> tuple[float, ...]:
    """One time, or a list of them."""
    entries = value if isinstance(value, list) else [value]
    items = {f"{path}[{i}]": entry for i, entry in enumerate(entries)}
    return reader.read_each(
        items, lambda reader, where, entry: read_number(TIME, reader, where, entry)
    )


@cache
def _oil_keys() -> dict[str, Key]:
    """Keys of [life.oil]."""
    one = number(TIME).schema
    circuit_keys = {name: key for name, key in keys_of(OilCircuit).items() if name != "classes"}
    return circuit_keys | {
        "material": MATERIAL._replace(about='what the particles are of, e.g. "quartz"'),
        "start": DIRT._replace(required=True),
        "ingress": INGRESS._replace(required=True),
        "fresh_oil": DIRT._replace(about="particles in oil that is filled in, as start"),
        "oil_changes": Key(
            _times,
            about='when all the oil is changed, ["500 h", "1000 h"]',
            schema={"anyOf": [one, {"type": "array", "items": one}]},
        ),
    }


def _oil(reader: Reader, path: str, data: object) -> dict[str, object]:
    return reader.table(path, data, _oil_keys())


# -------------------------------------------------------------------------- filters
def _filter(reader: Reader, path: str, data: object, *, with_flow: bool = True) -> Filter:
    """One filter."""
    filter_keys = keys_of(Filter)
    beta = sized_numbers(BETA, '{ "5 um" = 2, "10 um" = 75 }')
    keys = {name: key for name, key in filter_keys.items() if name not in ("sizes", "betas")}
    keys["flow"] = keys["flow"]._replace(required=with_flow)
    keys["beta"] = beta._replace(required=True, about="β ratios of the data sheet " + beta.about)

    def build(values: dict[str, Any]) -> Filter:
        sizes, betas = zip(*values.pop("beta"), strict=True)
        try:
            return Filter(sizes=sizes, betas=betas, **values)
        except InvalidValue as error:
            named = (problem.changed(path=_in_beta(problem.path)) for problem in error.problems)
            raise InvalidValue(*named).move_under(path) from None

    return reader.table(path, data, keys, build)


def _in_beta(name: str) -> str:
    """The key of a file that says a field of a filter."""
    return "beta" if name in ("sizes", "betas") else name


def _filters(reader: Reader, path: str, data: object) -> tuple[Filter, ...]:
    """A list of filters."""
    if not isinstance(data, list):
        raise wrong(path, "must be a table, headed [[life.filters]]", data, code=Mistake.KIND)
    return reader.read_each({f"{path}.{i}": entry for i, entry in enumerate(data)}, _filter)


FILTERS = Key(
    _filters,
    about='filters, each headed [[life.filters]], with flow = "60 L/min" and '
    'beta = { "4 um" = 10, "10 um" = 75 }',
    schema=NOTHING,
    table=_filter,
    items=_filter,
)


# -------------------------------------------------------------------------- what is waited for
def _read_until(reader: Reader, path: str, data: object) -> tuple[until.Until, ...]:
    """What ends the history."""
    keys = {
        "iso4406": CODE._replace(about="the oil reaches this code"),
        "filter_full": switch._replace(about="a filter is full"),
        **{name: quantity_key(name, about) for name, about in OF_CONTACT_UNTIL.items()},
    }

    def build(values: dict[str, Any]) -> tuple[until.Until, ...]:
        out: list[until.Until] = []
        if "iso4406" in values:
            out.append(until.iso4406(values["iso4406"]))
        if values.get("filter_full"):
            out.append(until.filter_full())
        for name, wait in CONTACT_WAITS.items():
            if name in values:
                out.append(wait(values[name]))
        return tuple(out)

    return reader.table(path, data, keys, build)


def _read_entries(reader: Reader, path: str, value: object) -> dict[str, object]:
    """A table of which the circuit says what its keys mean."""
    if not isinstance(value, dict) or not value:
        raise wrong(
            path,
            'must be a table, e.g. { "ingress" = { median = 1, gsd = 2 } }',
            value,
            code=Mistake.KIND,
        )
    return value


def _uncertainty(
    reader: Reader, ranges: Mapping[str, object], circuit: OilCircuit, contact: LifeContact | None
) -> KnownOfLife:
    """What is known of the numbers of a circuit and of its contacts, by their names in them."""
    more = {} if contact is None else {f"contact.{name}": q for name, q in OF_CONTACT.items()}
    if contact is not None and contact.debris is not None:
        more[BANDS_HARDNESS] = HARDNESS
    some = '"ingress" (a factor), "oil.volume", "filters.0.service", "filters.0.flow"'
    for i, oil_filter in enumerate(circuit.filters):
        some += "".join(f', "filters.{i}.beta.{value_of(x, "m")}"' for x in oil_filter.sizes)
    some += "".join(f', "{name}"' for name in more)

    def about(label: str) -> tuple[str, Quantity | None]:
        if label in more:
            return label.removeprefix("contact."), more[label]
        name = label.removeprefix("oil.")
        return one_name_of(circuit, name), about_circuit(circuit, name)

    names = f"is not a number of the circuit; it has {some}"
    return known_of_life(reader, ranges, about, names, contact=contact is not None)


@cache
def _keys() -> dict[str, Key]:
    """Keys of [life]."""
    duration = quantity_key("duration", DURATION)
    return {
        "duration": duration._replace(required=True, read=_duration),
        "oil": Key(None, True, 'the oil, with volume = "200 L", start and ingress', NOTHING, _oil),
        "filters": FILTERS,
        "dry": DRY,
        **CONTACT_KEYS,
        "uncertainty": Key(
            _read_entries,
            about='what is known of its numbers, e.g. "ingress" = { median = 1, gsd = 2 } (a '
            'factor), "filters.0.service" = { low = 0.5, high = 1 }',
            schema={"type": "object"},
        ),
        "design": design_key(partial(_filter, with_flow=False)),
        "until": Key(
            None, False, 'what ends it earlier, e.g. iso4406 = "21/19/16"', NOTHING, _read_until
        ),
    }


def _life(reader: Reader, path: str, data: object) -> dict[str, object]:
    """The table, as what its keys stand for."""
    keys = _keys()
    if reader.every_way or get(data, "dry") is not None:
        keys = keys | {"oil": keys["oil"]._replace(required=False)}
    return reader.table(path, data, keys)


# -------------------------------------------------------------------------- the circuit


def _with_reports(
    reader: Reader,
    path: str,
    entry: Mapping[str, Any],
    circuit: OilCircuit,
    oil_material: Material | None,
) -> OilCircuit:
    """The circuit with the ingress that reports of its oil say."""
    times, reports, sizes = entry["reports"]
    material = entry.get("material", oil_material)
    try:
        reported = oil_reports(
            times, reports=reports, sizes=sizes, circuit=circuit, material=material
        )
    except InvalidValue as error:
        raise error.move_under(path) from None
    low, high = (3.6e9 * rate for rate in (reported.mass_low, reported.mass_high))
    first, last = (value_of(float(reported.sizes[i]), "m") for i in (0, -1))
    reader.assumed.append(
        f"{path}: from its reports {3.6e9 * reported.mass_rate:.3g} mg/h of particles from {first} "
        f"on enter the oil, {low:.3g} to {high:.3g} mg/h; "
        f"{percent(share_beyond(reported), digits=2)} of it is of sizes beyond {last} that "
        f"no report says. None below {first} enter, so their "
        "mass, dents and wear are left out: "
        + below_counts(reported).split("; ")[-1].removesuffix(".")
    )
    return circuit.replace(ingress=(reported.ingress,))


def life_of(reader: Reader, values: dict[str, Any]) -> AskedLife | AskedDry:
    """The life that a study asks for, from the objects that its tables stand for."""
    life_table = values["life"]
    return dry_of(reader, values) if "dry" in life_table else oil_of(reader, values)


def oil_of(reader: Reader, values: dict[str, Any]) -> AskedLife:
    """The oil of a study, from the objects that its tables stand for."""
    life_table = values["life"]
    if "oil" not in life_table:
        rule = "is a dry contact, and this asks for an oil, [life.oil]"
        raise InvalidValue(Problem("life.dry", rule, code=Mistake.CLASH))
    oil = dict(life_table["oil"])
    material = oil.pop("material", None)
    reported = [source for source in oil["ingress"] if "reports" in source[1]]
    if reported and len(oil["ingress"]) > 1:
        rule = "from reports is all that enters; leave the others out"
        raise InvalidValue(Problem("life.oil.ingress", rule, code=Mistake.CLASH))
    oil["ingress"] = [] if reported else oil["ingress"]
    for name in ("start", "ingress", "fresh_oil"):
        if name in oil:
            oil[name] = dirts_of(oil[name], material, ingress=name == "ingress")
    oil["filters"] = life_table.get("filters", ())
    circuit = reader.make(OilCircuit, "life.oil", oil)
    for path, entry in reported:
        circuit = _with_reports(reader, path, entry, circuit, material)
    circuit.terms()  # what does not go together is told before anything is computed
    rolling = rolling_of(reader, values)
    contact = contact_of(reader, values, rolling)
    uncertainty = _uncertainty(reader, life_table.get("uncertainty", {}), circuit, contact)
    design = None
    if "design" in life_table:
        design = design_of(
            reader, life_table["design"], circuit, life_table.get("until", ()), about_circuit
        )
    return AskedLife(
        title=values.get("title", ""),
        circuit=circuit,
        duration=life_table["duration"],
        until=life_table.get("until", ()),
        uncertainty=uncertainty.vary,
        drawn=uncertainty,
        contact=contact,
        rolling=rolling,
        design=design,
        notes=tuple(dict.fromkeys(reader.notes)),
        assumed=tuple(dict.fromkeys(reader.assumed)),
        stated=reader.stated_keys,
    )


LIFE = Table(
    name="life",
    key=Key(
        about="an oil over time, with [life.oil] and [[life.filters]], or a contact without oil, "
        "with [life.dry]; thirdbody new oil-circuit or dry-contact writes a whole study",
        schema=NOTHING,
        table=_life,
    ),
    role="study",
)
