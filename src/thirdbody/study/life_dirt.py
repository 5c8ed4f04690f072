"""Particles of an oil, and that enter it or a contact, as tables of a study say them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Problem, WrongKind
from ..populations.materials import Material
from ..populations.measured import cleanliness
from ..quantities.units import Quantity, say
from ..quantities.value import quantity
from ..systems.life.ingress import Ingress
from ..systems.life.oil_dirt import OilDirt
from ..systems.life.reports import read_reports
from .mistakes import clash
from .reader import Key, Reader, get, number, quantity_key, read_number, word, wrong
from .surfaces import MATERIAL

__all__ = ["ARRIVALS", "CLEAN", "CODE", "DIRT", "INGRESS", "dirts_of", "sized_numbers"]

RATE = quantity("m'", "kg/s", "mass per time", gt=0, hint="e.g. '125 mg/h'").metadata["quantity"]
COUNT = quantity("N'", "1/s", "particles per time", gt=0, hint="e.g. '1e6 / min'").metadata[
    "quantity"
]
SIZE = quantity("x", "m", "size", gt=0, hint="e.g. '5 um'").metadata["quantity"]
LARGEST = quantity("x_max", "m", "largest size", gt=0).metadata["quantity"]
SMALLEST = quantity("x_min", "m", "smallest size", gt=0).metadata["quantity"]
CLEAN = "clean"
"""The word for oil without particles, and for no ingress."""
Dirts = list[tuple[str, dict[str, Any]]]
"""Tables of particles as they are read, each with its path."""
ReadDirts = Callable[[Reader, str, object], Dirts]


# -------------------------------------------------------------------------- particles
DIRT_SOURCES = ("iso4406", "test_dust")
INGRESS_SOURCES = ("test_dust", "counts", "iso4406", "reports")
ARRIVAL_SOURCES = ("test_dust", "counts")


def _code(reader: Reader, path: str, value: Any) -> str:
    """An ISO 4406 code."""
    try:
        cleanliness.read_iso4406(value)
    except InvalidValue as error:
        raise _place_mistake(path, error) from None
    return str(value)


def _place_mistake(path: str, error: InvalidValue | TypeError) -> InvalidValue:
    """The mistake at its place in the file."""
    code = error.code if isinstance(error, InvalidValue) else Mistake.KIND
    return InvalidValue(Problem(path, f": {error}", code=code))


def _dust(reader: Reader, path: str, value: Any) -> str:
    """The grade of a test dust."""
    try:
        dust = cleanliness.dust_table(value)
    except (InvalidValue, TypeError) as error:
        raise _place_mistake(path, error) from None
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
        raise _place_mistake(path, error) from None
    return str(value)


CODE = Key(_code, about='an ISO 4406 code, "18/16/13"', schema={"type": "string"})
DUST = Key(_dust, about='a test dust, "A3"', schema={"enum": cleanliness.DUSTS})
OF = MATERIAL._replace(about="what the particles are of, in the place of that of all")
LEVEL = word(cleanliness.LEVELS, "where in its range each number of the code is taken")
ENDS = {
    "smallest": quantity_key("smallest", SMALLEST),
    "largest": quantity_key("largest", LARGEST),
}


def sized_numbers(about: Quantity, what: str) -> Key:
    """The key of a table from sizes to numbers, of any sizes."""

    def read(reader: Reader, path: str, data: object) -> tuple[tuple[float, float], ...]:
        if not isinstance(data, dict) or not data:
            raise wrong(path, f"must be a table of sizes, e.g. {what}", data, code=Mistake.KIND)

        def one(reader: Reader, where: str, pair: tuple[str, object]) -> tuple[float, float]:
            size, value = pair
            bare = size.replace("(c)", "").strip()
            at = read_number(SIZE, reader, where, bare)
            return at, read_number(about, reader, where, value)

        pairs = {f"{path}.{say(size)}": (size, value) for size, value in data.items()}
        return tuple(sorted(reader.read_each(pairs, one)))

    return Key(read, about=f"by size, e.g. {what}", schema={"type": "object"})


def _dirt_table(reader: Reader, path: str, data: object) -> Dirts:
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


def _reports(reader: Reader, path: str, value: object) -> tuple[object, ...]:
    """Reports of the oil, from a file."""
    if not isinstance(value, str):
        raise wrong(path, 'must be the name of a file, e.g. "oil.csv"', value, code=Mistake.KIND)
    beside = reader.folder / value
    try:
        return read_reports(beside if beside.exists() else Path(value), fewest=2)
    except InvalidValue as error:
        raise error.move_under(path) from None


def _table_of_ingress(sources: tuple[str, ...]) -> ReadDirts:
    """What reads a table of particles that enter, said in one of these ways."""
    counts = '{ "4 um" = "1e6 / min", "6 um" = "3e5 / min", "14 um" = "1e4 / min" }'
    ways = {
        "test_dust": DUST,
        "counts": sized_numbers(COUNT, counts),
        "iso4406": CODE._replace(about="the code that the oil has when it no longer changes"),
        "reports": Key(_reports, about='reports of the oil, "oil.csv"', schema={"type": "string"}),
    }
    ends = ENDS if "iso4406" in sources else {"largest": ENDS["largest"]}
    level = {"level": LEVEL} if "iso4406" in sources else {}
    keys = {
        "material": OF,
        **{name: ways[name] for name in sources},
        "limit": word(cleanliness.LIMITS, "where between its printed limits the dust is taken"),
        "rate": number(RATE)._replace(about='mass of test dust per time, "125 mg/h"'),
        **level,
        **ends,
    }

    def read(reader: Reader, path: str, data: object) -> Dirts:
        _one_source(reader, path, data, sources)
        return reader.table(path, data, keys, lambda values: [(path, values)])

    return read


def _one_source(reader: Reader, path: str, data: object, sources: tuple[str, ...]) -> None:
    """Tell where particles are given twice, or not at all."""
    if reader.every_way or not isinstance(data, dict):
        return
    present = [name for name in sources if get(data, name) is not None]
    if len(present) > 1:
        rule = "each of these says how many particles there are; keep one of them"
        reader.mistakes.append(clash(path, data, present, rule))
    if not present:
        rule = f"says not how many particles there are: give one of {', '.join(sources)}"
        reader.mistakes.append(Problem(path, rule, code=Mistake.MISSING))


def _several(table: ReadDirts, plain: ReadDirts) -> ReadDirts:
    """What reads one entry, or a list of them."""

    def read(reader: Reader, path: str, value: object) -> Dirts:
        if isinstance(value, list):
            items = {f"{path}.{i}": item for i, item in enumerate(value)}
            lists = reader.read_each(items, table)
            return [dirt for some in lists for dirt in some]
        return plain(reader, path, value)

    return read


def _start(reader: Reader, path: str, value: object) -> Dirts:
    """Particles in an oil, as a code; none."""
    return [] if value == CLEAN else [(path, {"iso4406": _code(reader, path, value)})]


def _no_ingress(reader: Reader, path: str, value: object) -> Dirts:
    """No particles that enter."""
    if value == CLEAN:
        return []
    ways = '{ test_dust = "A3", rate = "125 mg/h" }, { counts = { "4 um" = "1e6 / min" } }'
    raise wrong(
        path, f'must be a table, e.g. {ways}, or "{CLEAN}" for none', value, code=Mistake.KIND
    )


DIRT = Key(
    _several(_dirt_table, _start),
    about=f'particles in it: an ISO 4406 code, "18/16/13", or "{CLEAN}"',
    schema={"type": "string"},
    table=_dirt_table,
    items=_dirt_table,
)
_INGRESS = _table_of_ingress(INGRESS_SOURCES)
INGRESS = Key(
    _several(_INGRESS, _no_ingress),
    about='particles that enter, which nobody can predict, e.g. { test_dust = "A3", '
    'rate = "125 mg/h" }; thirdbody life --reports oil.csv finds them from reports of the oil',
    schema={"enum": [CLEAN]},
    table=_INGRESS,
    items=_INGRESS,
)
_ARRIVALS = _table_of_ingress(ARRIVAL_SOURCES)
ARRIVALS = Key(
    _several(_ARRIVALS, _no_ingress),
    about="particles that arrive in the whole contact, which nobody can predict, e.g. { test_dust "
    f'= "A3", rate = "1 mg/h" }}, or "{CLEAN}" for none',
    schema={"enum": [CLEAN]},
    table=_ARRIVALS,
    items=_ARRIVALS,
)


# -------------------------------------------------------------------------- what they are
def dirts_of(
    dirts: Dirts | None,
    material: Material | None,
    *,
    ingress: bool,
    of: str = "life.oil",
) -> tuple[Any, ...] | None:
    """Particles of an oil, or that enter it, from what their tables say."""
    if dirts is None:
        return None
    out = []
    for path, entry in dirts:
        values = dict(entry)
        kind = values.pop("material", material)
        if kind is None:
            rule = 'is missing: what the particles are of, e.g. material = "quartz"'
            raise InvalidValue(Problem(f"{of}.material", rule, code=Mistake.MISSING))
        try:
            out.append((_ingress_from if ingress else _dirt_from)(values, kind))
        except InvalidValue as error:
            if isinstance(error, WrongKind) and error.code is Mistake.MISSING:
                raise InvalidValue(Problem(path, _misfit(entry), code=Mistake.CLASH)) from None
            raise error.move_under(path) from None
        except TypeError:
            raise InvalidValue(Problem(path, _misfit(entry), code=Mistake.CLASH)) from None
    return tuple(out)


OPTIONS: Mapping[str, tuple[str, ...]] = {
    "iso4406": ("level", "smallest", "largest"),
    "test_dust": ("limit", "rate", "concentration"),
    "counts": ("largest",),
    "reports": (),
}
"""What goes with each way of saying how many particles there are."""


def _misfit(values: Mapping[str, object]) -> str:
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
