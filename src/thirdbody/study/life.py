"""The table [life]: an oil over time, its circuit, its filters and what is waited for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from ..analysis.uncertainty.inputs import Uncertain
from ..errors import InvalidValue, Problem
from ..populations.materials import Material
from ..populations.measured import cleanliness
from ..quantities.units import say
from ..quantities.value import quantity
from ..systems.life import contact_until, until
from ..systems.life.circuit import OilCircuit
from ..systems.life.ingress import Ingress
from ..systems.life.oil_dirt import OilDirt
from ..systems.life.reports import oil_reports, read_reports
from ..systems.oil_filter import Filter
from .life_contact import CONTACT_KEYS, LifeContact, contact_of
from .mistakes import clash
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
    word,
    wrong,
)
from .surfaces import MATERIAL
from .uncertainty import read_uncertain

__all__ = ["CLEAN", "LIFE", "AskedLife", "life_of"]

DURATION = quantity("t", "s", "how long at most", gt=0, hint="hours are '1000 h'").metadata[
    "quantity"
]
RATE = quantity("m'", "kg/s", "mass per time", gt=0, hint="'125 mg/h'").metadata["quantity"]
COUNT = quantity("N'", "1/s", "particles per time", gt=0, hint="'1e6 / min'").metadata["quantity"]
SIZE = quantity("x", "m", "size", gt=0, hint="'5 um'").metadata["quantity"]
BETA = quantity("β", "1", "particles before over particles behind", ge=1).metadata["quantity"]
TIME = quantity("t", "s", "time", gt=0, hint="'500 h'").metadata["quantity"]
LARGEST = quantity("x_max", "m", "largest size", gt=0).metadata["quantity"]
SMALLEST = quantity("x_min", "m", "smallest size", gt=0).metadata["quantity"]
FACTOR = quantity("f", "1", "factor on all that enters", gt=0).metadata["quantity"]
INGRESS_FACTOR = "ingress"
OF_CONTACT_UNTIL = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "wear_depth": quantity("w", "m", "wear depth of either surface", gt=0),
        "roughness": quantity("σ", "m", "roughness to which the surfaces have run in", gt=0),
        "particle_share": quantity("s", "1", "part of the load on particles", gt=0, lt=1),
    }.items()
}
CONTACT_WAITS: Mapping[str, Callable[[float], until.Until]] = {
    "wear_depth": contact_until.wear_depth,
    "roughness": contact_until.roughness_below,
    "particle_share": contact_until.particle_share,
}
"""What is waited for in a contact."""
CLEAN = "clean"
"""The word for oil without particles, and for no ingress."""


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
        What is known of the numbers of the circuit.
    contact : LifeContact, optional
        The contacts that the oil goes through.
    notes : tuple of str
        What is allowed but looks like a slip.
    assumed : tuple of str
        What was taken for what the file does not say.
    """

    title: str
    circuit: OilCircuit
    duration: float
    until: tuple[until.Until, ...] = ()
    uncertainty: Mapping[str, Uncertain] = field(default_factory=dict)
    contact: LifeContact | None = None
    notes: tuple[str, ...] = ()
    assumed: tuple[str, ...] = field(default=())


# -------------------------------------------------------------------------- particles
DIRT_SOURCES = ("iso4406", "test_dust")
INGRESS_SOURCES = ("test_dust", "counts", "iso4406", "reports")


def _code(reader: Reader, path: str, value: Any) -> str:
    """An ISO 4406 code."""
    try:
        cleanliness.read_iso4406(value)
    except InvalidValue as error:
        raise InvalidValue(Problem(path, f": {error}")) from None
    return str(value)


def _dust(reader: Reader, path: str, value: Any) -> str:
    """The grade of a test dust."""
    try:
        dust = cleanliness.dust_table(value)
    except (InvalidValue, TypeError) as error:
        raise InvalidValue(Problem(path, f": {error}")) from None
    if not dust["verified"]:
        reader.notes.append(
            f"{path} = {say(value)}: its table is that of {dust['edition']} and was not "
            "compared with a printed copy; compare it with the certificate of the dust"
        )
    return str(value)


def _concentration(reader: Reader, path: str, value: Any) -> str:
    """How much of a test dust is in the oil."""
    try:
        cleanliness.concentration(value)
    except (InvalidValue, TypeError) as error:
        raise InvalidValue(Problem(path, f": {error}")) from None
    return str(value)


CODE = Key(_code, about='an ISO 4406 code, "18/16/13"', schema={"type": "string"})
DUST = Key(_dust, about='a test dust, "A3"', schema={"enum": cleanliness.DUSTS})
OF = MATERIAL._replace(about="what the particles are of, in the place of life.oil.material")
LEVEL = word(cleanliness.LEVELS, "where in its range each number of the code is taken")
ENDS = {
    "smallest": quantity_key("smallest", SMALLEST),
    "largest": quantity_key("largest", LARGEST),
}


def _sized_numbers(about: dict[str, Any], what: str) -> Key:
    """The key of a table from sizes to numbers, of any sizes."""

    def read(reader: Reader, path: str, data: Any) -> tuple[tuple[float, float], ...]:
        if not isinstance(data, dict) or not data:
            raise wrong(path, f"must be a table of sizes, e.g. {what}", data)

        def one(reader: Reader, where: str, pair: tuple[str, Any]) -> tuple[float, float]:
            size, value = pair
            bare = size.replace("(c)", "").strip()
            at = read_number(SIZE, reader, where, bare)
            return at, read_number(about, reader, where, value)

        pairs = {f"{path}.{say(size)}": (size, value) for size, value in data.items()}
        return tuple(sorted(reader.read_each(pairs, one)))

    return Key(read, about=f"by size, e.g. {what}", schema={"type": "object"})


def _dirt_table(reader: Reader, path: str, data: Any) -> Any:
    """Particles in an oil, from a code or of a test dust."""
    keys = {
        "material": OF,
        "iso4406": CODE,
        "level": LEVEL,
        **ENDS,
        "test_dust": DUST,
        "limit": word(cleanliness.LIMITS, "where between its printed limits the dust is taken"),
        "concentration": Key(
            _concentration, about='of a test dust, "10 mg/L"', schema={"type": "string"}
        ),
    }
    _one_source(reader, path, data, DIRT_SOURCES)
    return reader.table(path, data, keys, lambda values: [(path, values)])


def _ingress_table(reader: Reader, path: str, data: Any) -> Any:
    """Particles that enter: of a test dust, counted, or as many as keep a code."""
    counts = '{ "4 um" = "1e6 / min", "6 um" = "3e5 / min", "14 um" = "1e4 / min" }'
    keys = {
        "material": OF,
        "test_dust": DUST,
        "limit": word(cleanliness.LIMITS, "where between its printed limits the dust is taken"),
        "rate": number(RATE)._replace(about='mass of test dust per time, "125 mg/h"'),
        "counts": _sized_numbers(COUNT, counts),
        "iso4406": CODE._replace(about="the code that the oil has when it no longer changes"),
        "reports": Key(_reports, about='reports of the oil, "oil.csv"', schema={"type": "string"}),
        "level": LEVEL,
        **ENDS,
    }
    _one_source(reader, path, data, INGRESS_SOURCES)
    return reader.table(path, data, keys, lambda values: [(path, values)])


def _reports(reader: Reader, path: str, value: Any) -> Any:
    """Reports of the oil, from a file."""
    if not isinstance(value, str):
        raise wrong(path, 'must be the name of a file, e.g. "oil.csv"', value)
    beside = reader.folder / value
    try:
        return read_reports(beside if beside.exists() else Path(value))
    except InvalidValue as error:
        raise InvalidValue(Problem(path, f": {error}")) from None


def _one_source(reader: Reader, path: str, data: Any, sources: tuple[str, ...]) -> None:
    """Tell where particles are given twice, or not at all."""
    if reader.every_way or not isinstance(data, dict):
        return
    given = [name for name in sources if get(data, name) is not None]
    if len(given) > 1:
        rule = "each of these says how many particles there are; keep one of them"
        reader.mistakes.append(clash(path, data, given, rule))
    if not given:
        rule = f"says not how many particles there are: give one of {', '.join(sources)}"
        reader.mistakes.append(Problem(path, rule))


def _several(table: Any, plain: Any) -> Any:
    """What reads one entry, or a list of them."""

    def read(reader: Reader, path: str, value: Any) -> Any:
        if isinstance(value, list):
            items = {f"{path}.{i}": item for i, item in enumerate(value)}
            found = reader.read_each(items, table)
            return [each for some in found for each in some]
        return plain(reader, path, value)

    return read


def _start(reader: Reader, path: str, value: Any) -> Any:
    """Particles in an oil, as a code; none."""
    return [] if value == CLEAN else [(path, {"iso4406": _code(reader, path, value)})]


def _no_ingress(reader: Reader, path: str, value: Any) -> Any:
    """No particles that enter."""
    if value == CLEAN:
        return []
    ways = '{ test_dust = "A3", rate = "125 mg/h" }, { counts = { "4 um" = "1e6 / min" } }'
    raise wrong(path, f'must be a table, e.g. {ways}, or "{CLEAN}" for none', value)


DIRT = Key(
    _several(_dirt_table, _start),
    about=f'particles in it: an ISO 4406 code, "18/16/13", or "{CLEAN}"',
    schema={"type": "string"},
    table=_dirt_table,
    items=_dirt_table,
)
INGRESS = Key(
    _several(_ingress_table, _no_ingress),
    about='particles that enter, which nobody can predict, e.g. { test_dust = "A3", '
    'rate = "125 mg/h" }; thirdbody life --reports oil.csv finds them from reports of the oil',
    schema={"enum": [CLEAN]},
    table=_ingress_table,
    items=_ingress_table,
)


def _times(reader: Reader, path: str, value: Any) -> tuple[float, ...]:
    """One time, or a list of them."""
    given = value if isinstance(value, list) else [value]
    items = {f"{path}[{i}]": each for i, each in enumerate(given)}
    return reader.read_each(
        items, lambda reader, where, each: read_number(TIME, reader, where, each)
    )


@cache
def _oil_keys() -> dict[str, Key]:
    """Keys of [life.oil]."""
    one = number(TIME).schema
    own = {name: key for name, key in keys_of(OilCircuit).items() if name != "classes"}
    return own | {
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


def _oil(reader: Reader, path: str, data: Any) -> Any:
    return reader.table(path, data, _oil_keys())


# -------------------------------------------------------------------------- filters
def _filter(reader: Reader, path: str, data: Any) -> Any:
    """One filter."""
    own = keys_of(Filter)
    beta = _sized_numbers(BETA, '{ "5 um" = 2, "10 um" = 75 }')
    keys = {name: key for name, key in own.items() if name not in ("sizes", "betas")}
    keys["flow"] = keys["flow"]._replace(required=True)
    keys["beta"] = beta._replace(required=True, about="β ratios of the data sheet " + beta.about)

    def build(values: dict[str, Any]) -> Filter:
        sizes, betas = zip(*values.pop("beta"), strict=True)
        try:
            return Filter(sizes=sizes, betas=betas, **values)
        except InvalidValue as error:
            named = (each.changed(path=_in_beta(each.path)) for each in error.problems)
            raise InvalidValue(*named).under(path) from None

    return reader.table(path, data, keys, build)


def _in_beta(name: str) -> str:
    """The key of a file that says a field of a filter."""
    return "beta" if name in ("sizes", "betas") else name


def _filters(reader: Reader, path: str, data: Any) -> Any:
    """A list of filters."""
    if not isinstance(data, list):
        raise wrong(path, "must be a table, headed [[life.filters]]", data)
    return reader.read_each({f"{path}.{i}": each for i, each in enumerate(data)}, _filter)


FILTERS = Key(
    _filters,
    about='filters, each headed [[life.filters]], with flow = "60 L/min" and '
    'beta = { "4 um" = 10, "10 um" = 75 }',
    schema=NOTHING,
    table=_filter,
    items=_filter,
)


# -------------------------------------------------------------------------- what is waited for
def _until(reader: Reader, path: str, data: Any) -> Any:
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


def _read_entries(reader: Reader, path: str, value: Any) -> Any:
    """A table of which the circuit says what its keys mean."""
    if not isinstance(value, dict) or not value:
        raise wrong(path, 'must be a table, e.g. { "ingress" = { median = 1, gsd = 2 } }', value)
    return value


def _about(circuit: OilCircuit, name: str) -> dict[str, Any] | None:
    """What a number of a circuit is, by its dotted name; None where it is none."""
    if name == INGRESS_FACTOR:
        return FACTOR
    parent, _, last = name.rpartition(".")
    try:
        owner, number_of_it = circuit.value_at(parent), circuit.value_at(name)
    except InvalidValue:
        return None
    fields = getattr(owner, "__dataclass_fields__", {})
    if last not in fields or not isinstance(number_of_it, float):
        return None
    return fields[last].metadata.get("quantity")


def _uncertainty(
    reader: Reader, given: Mapping[str, Any], circuit: OilCircuit
) -> dict[str, Uncertain]:
    """What is known of the numbers of a circuit, by their names in it."""

    def one(reader: Reader, where: str, pair: tuple[str, Any]) -> tuple[str, Uncertain]:
        label, entry = pair
        name = label.removeprefix("oil.")
        if (about := _about(circuit, name)) is None:
            some = '"ingress" (a factor), "oil.volume", "filters.0.service", "filters.0.flow"'
            raise InvalidValue(Problem(where, f"is not a number of the circuit; it has {some}"))
        return name, read_uncertain(reader, where, about, entry)

    pairs = {f"life.uncertainty.{say(name)}": (name, entry) for name, entry in given.items()}
    return dict(reader.read_each(pairs, one))


@cache
def _keys() -> dict[str, Key]:
    """Keys of [life]."""
    duration = quantity_key("duration", DURATION)
    return {
        "duration": duration._replace(required=True),
        "oil": Key(None, True, 'the oil, with volume = "200 L", start and ingress', NOTHING, _oil),
        "filters": FILTERS,
        **CONTACT_KEYS,
        "uncertainty": Key(
            _read_entries,
            about='what is known of its numbers, e.g. "ingress" = { median = 1, gsd = 2 } (a '
            'factor), "filters.0.service" = { low = 0.5, high = 1 }',
            schema={"type": "object"},
        ),
        "until": Key(
            None, False, 'what ends it earlier, e.g. iso4406 = "21/19/16"', NOTHING, _until
        ),
    }


def _life(reader: Reader, path: str, data: Any) -> Any:
    """The table, as what its keys stand for."""
    return reader.table(path, data, _keys())


# -------------------------------------------------------------------------- the circuit
def _dirts_of(
    given: list[tuple[str, dict[str, Any]]] | None, material: Material | None, ingress: bool
) -> tuple[Any, ...] | None:
    """Particles of an oil, or that enter it, from what their tables say."""
    if given is None:
        return None
    out = []
    for path, entry in given:
        values = dict(entry)
        of = values.pop("material", material)
        if of is None:
            rule = 'is missing: what the particles are of, e.g. material = "quartz"'
            raise InvalidValue(Problem("life.oil.material", rule))
        try:
            out.append((_ingress_from if ingress else _dirt_from)(values, of))
        except InvalidValue as error:
            raise error.under(path) from None
        except TypeError:
            raise InvalidValue(Problem(path, _misfit(entry))) from None
    return tuple(out)


OPTIONS: Mapping[str, tuple[str, ...]] = {
    "iso4406": ("level", "smallest", "largest"),
    "test_dust": ("limit", "rate", "concentration"),
    "counts": ("largest",),
    "reports": (),
}
"""What goes with each way of saying how many particles there are."""


def _misfit(values: Mapping[str, Any]) -> str:
    """Which keys do not go with each other."""
    source = next(name for name in OPTIONS if name in values)
    idle = [name for name in values if name not in (source, *OPTIONS[source])]
    if idle:
        return f"has {idle[0]}, which has no effect with {source}"
    need = "rate" if "rate" not in values else "concentration"
    return f"needs {need} beside {source}"


def _dirt_from(values: dict[str, Any], material: Material) -> OilDirt:
    if "iso4406" in values:
        return OilDirt.from_iso4406(values.pop("iso4406"), material=material, **values)
    return OilDirt.of_dust(values.pop("test_dust"), material=material, **values)


def _ingress_from(values: dict[str, Any], material: Material) -> Ingress:
    if "test_dust" in values:
        return Ingress.of_dust(values.pop("test_dust"), material=material, **values)
    if "counts" in values:
        sizes, counts = zip(*values.pop("counts"), strict=True)
        return Ingress.from_counts(sizes=sizes, counts=counts, material=material, **values)
    return Ingress.keeping_iso4406(values.pop("iso4406"), material=material, **values)


def _with_reports(
    reader: Reader, path: str, entry: Mapping[str, Any], circuit: OilCircuit, own: Material | None
) -> OilCircuit:
    """The circuit with the ingress that reports of its oil say."""
    times, reports, sizes = entry["reports"]
    material = entry.get("material", own)
    try:
        found = oil_reports(times, reports=reports, sizes=sizes, circuit=circuit, material=material)
    except InvalidValue as error:
        raise error.under(path) from None
    low, high = (3.6e9 * each for each in (found.mass_low, found.mass_high))
    reader.assumed.append(
        f"{path}: from its reports {3.6e9 * found.mass_rate:.3g} mg/h enter the oil, {low:.3g} to "
        f"{high:.3g} mg/h"
    )
    return circuit.replace(ingress=(found.ingress,))


def life_of(reader: Reader, values: dict[str, Any]) -> AskedLife:
    """The life that a study asks for, from the objects that its tables stand for."""
    given = values["life"]
    oil = dict(given["oil"])
    material = oil.pop("material", None)
    reported = [each for each in oil["ingress"] if "reports" in each[1]]
    if reported and len(oil["ingress"]) > 1:
        rule = "from reports is all that enters; leave the others out"
        raise InvalidValue(Problem("life.oil.ingress", rule))
    oil["ingress"] = [] if reported else oil["ingress"]
    for name in ("start", "ingress", "fresh_oil"):
        if name in oil:
            oil[name] = _dirts_of(oil[name], material, name == "ingress")
    oil["filters"] = given.get("filters", ())
    circuit = reader.make(OilCircuit, "life.oil", oil)
    for path, entry in reported:
        circuit = _with_reports(reader, path, entry, circuit, material)
    circuit.terms()  # what does not go together is told before anything is computed
    known = _uncertainty(reader, given.get("uncertainty", {}), circuit)
    contact = contact_of(reader, values)
    if known and contact is not None:
        rule = (
            "and [life.contact] do not go together: bands are those of the oil alone; leave one out"
        )
        raise InvalidValue(Problem("life.uncertainty", rule))
    return AskedLife(
        title=values.get("title", ""),
        circuit=circuit,
        duration=given["duration"],
        until=given.get("until", ()),
        uncertainty=known,
        contact=contact,
        notes=tuple(dict.fromkeys(reader.notes)),
        assumed=tuple(dict.fromkeys(reader.assumed)),
    )


LIFE = Table(
    name="life",
    key=Key(
        about="an oil over time, with [life.oil] and [[life.filters]]; thirdbody new oil-circuit "
        "writes a whole study",
        schema=NOTHING,
        table=_life,
    ),
    role="study",
)
