"""The table [particles], or several populations side by side, each headed [[particles]]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import InvalidValue, Mistake, Note, Problem
from ..populations.distributions import Distribution, Histogram
from ..populations.measured import clean_room, cleanliness
from ..populations.measured.sizes import FITS, WEIGHTINGS, MeasuredSizes, read_sizes
from ..populations.particles import Particles, about_gaps, wider_part
from ..populations.shape import SPHERE, Angular, Sphere
from ..populations.strength import WeibullStrength
from ..quantities.units import say, to_si
from ..quantities.value import quantity
from .mistakes import clash
from .reader import (
    FIELDS,
    NOTHING,
    Key,
    Reader,
    Table,
    get,
    keys_of,
    number,
    quantity_key,
    table_of,
    variants,
    word,
    wrong,
)
from .surfaces import PARTICLE_LAW
from .vocabulary import DISTRIBUTIONS

__all__ = ["AMOUNT", "COUNTED", "PARTICLES", "SHAPES", "gaps_of", "notes_on_gaps", "populations"]

AMOUNT = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "gap": quantity("h_gap", "m", "height of the fluid whose particles are trapped", gt=0),
        "film": quantity("h_gap", "m", "film thickness, another word for gap", gt=0),
        "particle_density": quantity("ρ_p", "kg/m^3", "density of the particles", gt=0),
        "oil_density": quantity("ρ_f", "kg/m^3", "density of the fluid", gt=0),
        "smallest": quantity("x_min", "m", "smallest diameter", gt=0),
        "largest": quantity("x_max", "m", "largest diameter", gt=0),
        "exposure": quantity("t", "s", "time for which dust settles", gt=0, hint="a day is '24 h'"),
        "share": quantity("w", "1", "part of the counted particles of this kind", gt=0, le=1),
    }.items()
}
"""The numbers that lead from a count or a concentration to an areal density."""
KEYS_OF_AMOUNT = {name: quantity_key(name, about) for name, about in AMOUNT.items()}
COUNTED = {
    "iso4406": ("level", "smallest", "largest", "share"),
    "as4059": ("smallest", "largest", "share"),
    "nas1638": ("smallest", "largest", "share"),
    "test_dust": ("limit", "smallest"),
    "sizes": ("weighting", "fit", "smallest"),
    "iso14644": ("exposure", "particle_density", "smallest", "largest"),
}
"""Keys of [particles] that stand in the place of a distribution, and their options."""
CODES = ("iso4406", "as4059", "nas1638")
"""Those that count particles per volume, whose concentration they give."""
SETTLED = "iso14644"
"""Dust that settles from air: the class and the time say how many particles there are."""
LEADING = {
    **dict.fromkeys(("distribution", "sizes"), ("gap", "film", "oil_density", "particle_density")),
    "test_dust": ("gap", "film", "oil_density"),
    **dict.fromkeys(CODES, ("gap", "film")),
    SETTLED: (),
}
"""Keys that lead from a concentration to an areal density, by the key that gives the sizes."""
WORDS = {
    "level": cleanliness.LEVELS,
    "limit": cleanliness.LIMITS,
    "weighting": tuple(WEIGHTINGS),
    "fit": tuple(FITS),
}
OF_SIZES = "weibull_shape"
"""The key for the shape of Weibull sizes, where that of particles has its name."""


# -------------------------------------------------------------------------- sizes
def _parts(reader: Reader, path: str, value: object) -> object:
    """The components of a mixture, a list of tables."""
    if not (isinstance(value, list) and value):
        rule = 'must be a list of size distributions, e.g. [{ distribution = "monodisperse", '
        raise wrong(path, f'{rule}mean = "100 nm" }}, ...]', value, code=Mistake.KIND)
    return reader.read_each({f"{path}.{i}": item for i, item in enumerate(value)}, _component)


def _component(reader: Reader, path: str, data: object) -> object:
    return reader.variant(path, data, "distribution", DISTRIBUTIONS)


FIELDS["tuple[Distribution, ...]"] = Key(
    _parts, about="a list of size distributions", schema=NOTHING, items=_component
)


# -------------------------------------------------------------------------- shape
SHAPES = {"sphere": Sphere, "angular": Angular}
ABOUT_SHAPE = 'sphere, or the table { kind = "angular", roundness = 0.25, angle = "25 deg" }'


def _sphere(reader: Reader, path: str, value: object) -> Sphere:
    if value == "sphere":
        return SPHERE
    raise wrong(path, f"must be {ABOUT_SHAPE}", value, code=Mistake.RANGE)


SHAPE = variants("kind", SHAPES, ABOUT_SHAPE)._replace(read=_sphere, schema={"const": "sphere"})


# -------------------------------------------------------------------------- strength
NO_STRENGTH = (
    'must be "material", for the strength that the material has in the library, or a table: '
    '{ sigma_0 = "67 MPa", at = "1 mm", m = 3, size_exponent = 0.55 }'
)
OWN = ("sigma_0", "x_0", "at", "m")
"""Keys of a strength of one's own; a table without them changes that of the material."""


def _of_material(reader: Reader, path: str, value: object) -> dict[str, object]:
    """The strength that the material has, and nothing of one's own."""
    if value != "material":
        raise wrong(path, NO_STRENGTH, value, code=Mistake.RANGE)
    return {}


def _strength(reader: Reader, path: str, data: Any) -> WeibullStrength | dict[str, object]:
    """A strength with its numbers, or changes to that of the material."""
    table = data if isinstance(data, dict) else {}
    keys = dict(keys_of(WeibullStrength))
    keys["at"] = keys["x_0"]._replace(required=False)
    of_material = not any(key in table for key in OWN)
    if of_material:
        keys = {name: key._replace(required=False) for name, key in keys.items()}
    elif "at" in table:
        keys["x_0"] = keys["at"]
        if "x_0" in table:
            rule = "both are the size of the test; keep one of them"
            reader.mistakes.append(clash(path, data, ("at", "x_0"), rule))

    def build(values: dict[str, object]) -> WeibullStrength | dict[str, object]:
        if "at" in values:
            values["x_0"] = values.pop("at")
        return values if of_material else reader.make(WeibullStrength, path, values)

    return reader.table(path, data, keys, build)


STRENGTH = Key(
    _of_material,
    False,
    "how strong the particles are",
    {"const": "material"},
    _strength,
    ({"m": 1},),
)


def with_strength(particles: Particles, path: str, changes: Mapping[str, float]) -> Particles:
    """The particles with the strength of their material, but for these numbers of it."""
    try:
        strength = WeibullStrength.of(particles.material, **changes)
    except InvalidValue as error:
        raise error.move_under(path) from None
    return particles.replace(strength=strength)


# -------------------------------------------------------------------------- populations


def populations(whole: Mapping[str, object]) -> dict[str, object]:
    """The tables of all populations of a file by their paths, particles or particles.0, ..."""
    data = whole.get("particles")
    if isinstance(data, list) and data:
        return {f"particles.{i}": table for i, table in enumerate(data)}
    return {"particles": data} if "particles" in whole else {}


def gaps_of(whole: Mapping[str, object]) -> tuple[float | None, ...]:
    """Heights of the oil whose particles each population is [m]; None where a file has none."""
    gaps = [get(table, "gap") or get(table, "film") for table in populations(whole).values()]
    return tuple(None if gap is None else to_si(gap, "m") for gap in gaps)


def notes_on_gaps(several: Sequence[Particles], gaps: Sequence[float | None]) -> list[Note]:
    """Doubt of populations that are wider than the oil which brings them, one note at most."""
    places = [f"particles.{i}.gap" for i in range(len(several))]
    if len(several) == 1:
        places = ["particles.gap"]
    wider = {
        place: wider_part(population, gap)
        for place, population, gap in zip(places, several, gaps, strict=False)
        if gap is not None
    }
    note = about_gaps(wider)
    return [] if note is None else [note]


def _particles(reader: Reader, path: str, data: object) -> object:
    """One population, or a list of them."""
    if not (isinstance(data, list) and data):
        return _population(reader, path, data)
    named: dict[str, int] = {}
    for i, table in enumerate(data):
        name = get(table, "name")
        if isinstance(name, str) and name and named.setdefault(name, i) != i:
            rule = f"is the name of {path}.{named[name]} as well; results could not tell them apart"
            reader.mistakes.append(Problem(f"{path}.{i}.name", rule, say(name), code=Mistake.CLASH))
    _note_counts(reader, path, data)
    return reader.read_each({f"{path}.{i}": table for i, table in enumerate(data)}, _population)


def _note_counts(reader: Reader, path: str, data: list[Any]) -> None:
    """Note kinds of particles that are no parts of one count of an oil."""
    counted = [table for table in data if isinstance(get(table, "iso4406"), str)]
    codes = list(dict.fromkeys(table["iso4406"] for table in counted))
    if len(codes) > 1:
        reader.notes.append(
            Note(
                f"{path} have the codes {' and '.join(codes)}: the oil holds them all together",
                code="counts",
                action="where one count of the oil saw all of them, give each its code and a share",
            )
        )
        return
    shares = [1.0 if (share := get(table, "share")) is None else share for table in counted]
    if len(shares) > 1 and all(map(_is_number, shares)) and sum(shares) > 1 + 1e-9:
        reader.notes.append(
            Note(
                f"{path} hold {sum(shares):.3g} times what code {codes[0]} counts together: the "
                "oil is dirtier than its code",
                code="counts",
                action="let the shares add up to 1",
            )
        )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _population(reader: Reader, path: str, data: object) -> object:
    """One population, whose sizes are a distribution or were counted."""
    table = data if isinstance(data, dict) else {}
    sources = [key for key in ("distribution", *COUNTED) if table.get(key) is not None]
    kind = sources[0] if sources else "distribution"
    by_volume = kind in CODES or table.get("concentration") is not None
    keys = _keys_of_population(table, kind, by_volume)
    before = len(reader.mistakes)
    if len(sources) > 1:
        rule = "each of these gives the sizes; keep one of them"
        reader.mistakes.append(clash(path, table, sources, rule))
    reader.mistakes += _problems_of_amount(path, table, kind, by_volume)
    refused = len(reader.mistakes) > before

    def build(values: dict[str, Any]) -> Particles:
        if refused:
            raise InvalidValue
        of_material = isinstance(values.get("strength"), dict)
        changes = values.pop("strength") if of_material else {}
        if kind == "distribution":
            of_particles = {key: values.pop(key) for key in keys if key in values}
            if OF_SIZES in of_particles:
                values["shape"] = of_particles.pop(OF_SIZES)
            diameter = reader.make(DISTRIBUTIONS[values.pop("distribution")], path, values)
            particles = _particles_of_sizes(reader, path, of_particles, diameter)
        else:
            particles = _counted_particles(reader, path, kind, values)
        return with_strength(particles, f"{path}.strength", changes) if of_material else particles

    if kind == "distribution":
        return reader.variant(path, data, "distribution", DISTRIBUTIONS, build, keys)
    keys |= _keys_of_count(table, kind)
    rule = f"says the sizes, and so does {path}.{kind}: remove one of the two"
    of_sizes = (name for sizes in DISTRIBUTIONS.values() for name in sizes.__dataclass_fields__)
    reader.known_keys.refused[path] = {name: rule for name in of_sizes if name not in keys}
    return reader.table(path, data, keys, build)


# -------------------------------------------------------------------------- keys
def _keys_of_population(table: Mapping[str, object], kind: str, by_volume: bool) -> dict[str, Key]:
    """Every key but those of the sizes."""
    keys = dict(keys_of(Particles))
    keys["material"] = keys["material"]._replace(
        about='what the particles are made of, e.g. material = "SiO2"'
    )
    density = keys["areal_density"]
    about = f'{density.about}, or concentration = "0.1 wt%" with gap = "1 um"'
    keys["areal_density"] = density._replace(
        about=about, required=density.required and not by_volume and kind != SETTLED
    )
    keys["strength"] = STRENGTH
    keys["conducts"] = keys["conducts"]._replace(
        about="whether they conduct a current; without it their material says so"
    )
    sizes = DISTRIBUTIONS.get(str(table.get("distribution")))
    of_sizes = getattr(sizes, "__dataclass_fields__", {}).get("shape")
    if of_sizes is None or isinstance(table.get("shape"), dict):
        keys["shape"] = SHAPE
        if of_sizes is not None:
            keys[OF_SIZES] = number(of_sizes.metadata["quantity"])._replace(
                required=True, about="Weibull shape of the sizes, beside a table shape"
            )
    keys["law"] = PARTICLE_LAW._replace(
        about="law of these particles, in the place of [particle_law]"
    )
    if kind not in (*CODES, SETTLED):
        about = 'e.g. "0.1 wt%"'
        keys["concentration"] = Key(_concentration, False, about, WORD_OR_NUMBER)
    keys |= {name: KEYS_OF_AMOUNT[name] for name in LEADING[kind]}
    return keys | dict.fromkeys(COUNTED, Key(_unread, schema=NOTHING))


def _unread(reader: Reader, path: str, value: object) -> object:
    """Value of a source of sizes that is not read, since another source is."""
    return value


def _problems_of_amount(
    path: str, table: Mapping[str, object], kind: str, by_volume: bool
) -> list[Problem]:
    """Problems of the keys for the number of particles."""
    if kind == SETTLED:
        rule = "the class and the time say how many there are; remove areal_density"
        twice = "areal_density" in table
        return [clash(path, table, [kind, "areal_density"], rule)] if twice else []
    what = kind if kind in CODES else "concentration"
    out = [
        clash(path, table, pair, "only one of these can be given; remove the other")
        for pair in ((what, "areal_density"), ("gap", "film"))
        if table.keys() >= set(pair)
    ]
    if by_volume and table.keys().isdisjoint(("gap", "film")):
        rule = 'is missing: the height of the fluid whose particles are trapped, e.g. gap = "1 um"'
        out.append(
            Problem(
                f"{path}.gap", rule, hint=f"{what} counts them per volume", code=Mistake.MISSING
            )
        )
    idle = [] if by_volume else [name for name in LEADING[kind] if name in table]
    if idle:
        rule = f"has no effect without {path}.concentration"
        out.append(Problem(f"{path}.{idle[0]}", rule, say(table[idle[0]]), code=Mistake.IDLE))
    return out


def _concentration(reader: Reader, path: str, value: Any) -> cleanliness.Concentration:
    try:
        return cleanliness.concentration(value)
    except InvalidValue as error:
        raise InvalidValue(error.problems[0].put_at(path, say(value))) from None


def _keys_of_count(table: Mapping[str, object], kind: str) -> dict[str, Key]:
    """Keys of a count of particles: what was counted, and its options."""
    keys = {
        name: word(WORDS[name]) if name in WORDS else KEYS_OF_AMOUNT[name] for name in COUNTED[kind]
    }
    if kind == SETTLED:
        keys["exposure"] = keys["exposure"]._replace(required=True)
    weighting = table.get("weighting")

    def read(reader: Reader, path: str, value: object) -> object:
        try:
            if kind != "sizes":
                return _checked_code(reader, path, kind, value)
            weighting_word = (
                weighting if isinstance(weighting, str) and weighting in WEIGHTINGS else ""
            )
            return _sizes_of_file(reader, value, weighting_word or "number")
        except InvalidValue as error:
            raise InvalidValue(Problem(path, f": {error}", code=error.code)) from None

    bins = table_of(Histogram).table if kind == "sizes" else None
    return keys | {kind: Key(read, True, schema=CODE_TEXT.get(kind, WORD_OR_NUMBER), table=bins)}


CODE_TEXT: dict[str, dict[str, object]] = {
    kind: {"type": "string"} for kind in ("iso4406", "test_dust", "sizes")
}
WORD_OR_NUMBER: dict[str, object] = {"type": ["number", "string"]}
"""What a schema says of codes, of classes that are numbers too, and of concentrations."""


def _checked_code(reader: Reader, path: str, kind: str, value: Any) -> object:
    """A code or the word of a dust, of which the library knows the counts."""
    if kind == SETTLED:
        return clean_room.read_class(value)
    if kind == "iso4406":
        cleanliness.read_iso4406(value)
    elif kind == "test_dust":
        dust = cleanliness.dust_table(value)
        if not dust["verified"]:
            reader.notes.append(
                f"{path} = {say(value)}: its table is that of {dust['edition']} and was not "
                "compared with a printed copy; compare it with the certificate of the dust"
            )
    else:
        cleanliness.suspension_of_class(kind, value)
    return value


def _sizes_of_file(reader: Reader, value: object, weighting: str) -> MeasuredSizes:
    """A measured histogram."""
    if not isinstance(value, str):
        raise InvalidValue(
            f'{say(value)} must be the name of a file, e.g. "sizes.csv", or '
            'its bins, { edges = ["1 um", "2 um"], counts = [5] }',
            code=Mistake.KIND,
        )
    beside = reader.folder / value
    return read_sizes(beside if beside.exists() else Path(value), weighting=weighting)


# -------------------------------------------------------------------------- particles
def _particles_of_sizes(
    reader: Reader, path: str, values: dict[str, Any], diameter: Distribution
) -> Particles:
    """Particles with these sizes, and the density or the concentration of the file."""
    if "concentration" not in values:
        return reader.make(Particles, path, values | {"diameter": diameter})
    amount = values.pop("concentration")
    gap = values.pop("gap", values.pop("film", None))
    try:
        return Particles.from_concentration(
            amount.amount, by=amount.by, gap=gap, diameter=diameter, **values
        )
    except InvalidValue as error:
        raise error.move_under(path) from None


def _counted_particles(reader: Reader, path: str, kind: str, values: dict[str, Any]) -> Particles:
    """Particles from a code, a test dust or a measured histogram."""
    count = values.pop(kind)
    options = {name: values.pop(name) for name in COUNTED[kind] if name in values}
    try:
        if kind == "sizes":
            if isinstance(count, Histogram):
                count = MeasuredSizes(sizes=count, weighting=options.get("weighting", "number"))
            source = count.fit(options["fit"]) if "fit" in options else count
            return _particles_of_sizes(
                reader, path, values, source.by_number(options.get("smallest"))
            )
        if kind == SETTLED:
            return _settled_particles(reader, path, count, options, values)
        gap = values.pop("gap", values.pop("film", None))
        if share := options.pop("share", None):
            gap *= share
        if kind == "iso4406":
            return Particles.from_iso4406(count, gap=gap, **options, **values)
        if kind == "test_dust":
            if concentration := values.pop("concentration", None):
                values |= {
                    "concentration": concentration.amount,
                    "by": concentration.by,
                    "gap": gap,
                }
            return Particles.test_dust(count, **options, **values)
        return Particles.from_cleanliness_class(kind, count, gap=gap, **options, **values)
    except InvalidValue as error:
        raise error.move_under(path) from None


def _settled_particles(
    reader: Reader,
    path: str,
    iso_class: float,
    options: dict[str, float],
    values: dict[str, Any],
) -> Particles:
    """Dust that settles out of the air of a clean room."""
    beyond = options.get("largest", 0.0) > clean_room.COUNTED_TO
    more = (
        "; ISO 14644-1 states its classes up to 5 µm, and beyond its power law is continued: count "
        f"large ones on a witness plate, and give {path}.areal_density and sizes"
    )
    reader.assumed.append(
        f"{path}.iso14644: dust settles from still air, at the limit of its class, on surfaces "
        f"that face up; nothing is brought by hands or charges{more * beyond}"
    )
    if (density := options.pop("particle_density", None)) is None:
        density = values["material"].density
    if density is None:
        rule = 'is missing: dust falls by its density, e.g. particle_density = "2650 kg/m^3"'
        raise InvalidValue(Problem("particle_density", rule, code=Mistake.MISSING))
    number, sizes = clean_room.settled_particles(iso_class, particle_density=density, **options)
    return Particles(diameter=sizes, areal_density=number, **values)


PARTICLES = Table(
    name="particles",
    key=Key(
        _particles,
        schema=NOTHING,
        table=_population,
        items=_population,
        also=(
            *({key: ""} for key in COUNTED),
            {"sizes": {}},
            {"distribution": "weibull"},
            {"distribution": "weibull", "shape": {}},
            {"concentration": ""},
        ),
    ),
)
"""A list of populations is no table, and read by the same."""
