"""What a report rests on: every input, the laws, and where they come from."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Collection, Iterable, Iterator
from html import escape
from typing import Any, NamedTuple

from ...analysis.inputs import declared_quantity
from ...analysis.inputs import inputs as numbers_of
from ...contact.contact import Contact
from ...contact.output import AbstractOutput
from ...laws.base import Law
from ...populations.materials import NUMBERS, Material, materials
from ...quantities.say import number, span, value_of
from ...quantities.value import Value
from ...study import FilmResult, Study
from ...study.film import SPEED
from ...study.load import FORCE
from ...study.vocabulary import LOADS
from ...version import __version__
from ..html import breaking, symbols, table, words
from .found import Found

STANDING = {
    "read": "read in the source, or in a stored copy of it",
    "abstract": "read in the abstract of the source",
    "from memory": "from memory: the source was not at hand",
}


class Row(NamedTuple):
    """One input of the contact."""

    name: str
    symbol: str
    value: str
    meaning: str
    default: bool
    amount: float | None = None
    unit: str = ""
    """The number itself in SI, where it is one."""


def inputs_and_sources(report: Found) -> list[str]:
    bodies = []
    for label, body in bodies_by_label(report.bodies()):
        source, standing = source_of(body)
        values = [
            f"{about['symbol']} = {value_of(getattr(body, key), about['unit'])}"
            for key, about in NUMBERS.items()
            if getattr(body, key) is not None
        ]
        bodies.append(
            [escape(label), escape(body.name), words(", ".join(values)), source, standing]
        )
    head = ["body", "material", "numbers", "source", "standing of the source"]
    rows = [
        [
            symbols(row.meaning),
            symbols(row.symbol),
            f"<td class=n>{words(row.value)}</td>",
            "<span class=default>default</span>" if row.default else "study",
            breaking(escape(row.name)),
        ]
        for row in _every_row(report)
    ]
    legend = (
        "<p>“default” marks what the library takes where a study says nothing; everything "
        "else is what this study says, or follows from it.</p>"
    )
    columns = ["input", "symbol", "<th class=n>value</th>", "from", "name"]
    return [table(head, bodies), legend, table(columns, rows)]


def _every_row(report: Found) -> list[Row]:
    """Rows of load, bodies, film and contact."""
    study = report.study
    rows = load_rows(study) if study.own_load else []
    rows += [] if study.body is None else value_rows(study.body, "body.")
    if report.film is not None:
        rows += film_rows(report.film)
    return as_stated([*rows, *rows_of(report.contact)], study.stated)


def load_rows(study: Study) -> list[Row]:
    """Rows of the loads of a study, or of the forces on its body."""
    about, name, values = LOADS[study.load], study.load, study.values.tolist()
    if study.forces is not None:
        about, name, values = FORCE, "force", study.forces.tolist()
    loads = {about["meaning"]: values[0]}
    if len(values) > 1:
        which = (f"least of {len(values)}", "greatest")
        loads = {f"{about['meaning']}, {word}": value
                for word, value in zip(which, (min(values), max(values)), strict=True)}  # fmt: skip
    return [
        Row(f"load.{name}", about["symbol"], value_of(value, about["unit"]), meaning, False,
            float(value), about["unit"])
        for meaning, value in loads.items()
    ]  # fmt: skip


def film_rows(film: FilmResult) -> list[Row]:
    """Rows of the film, its speeds first."""
    about, speeds = SPEED, film.conditions.speed
    text = value_of(speeds[0], about["unit"])
    if len(speeds) > 1:
        text = f"{len(speeds)} values, {span(min(speeds), max(speeds), about['unit'])}"
    amount = float(speeds[0]) if len(speeds) == 1 else None
    speed_row = Row(
        "film.speed", about["symbol"], text, about["meaning"], False, amount, about["unit"]
    )
    return [speed_row, *value_rows(film.conditions, "film.")]


def as_stated(rows: Iterable[Row], stated: Collection[str]) -> list[Row]:
    """Rows whose value a file states, be it that of the library, are no defaults."""
    return [row._replace(default=row.default and not is_stated(row.name, stated)) for row in rows]


def is_stated(name: str, stated: Collection[str]) -> bool:
    """Whether a file states an input, which it may call otherwise.

    >>> is_stated("particles.0.diameter.mean", {"particles", "particles.mean"})
    True
    >>> is_stated("film.hertz", {"film", "film.speed"})
    False
    """
    names = {name, name.replace(".diameter.", ".")}
    names |= {spelling.replace("particles.0.", "particles.") for spelling in names}
    return not names.isdisjoint(stated)


def laws_and_reasons(report: Found) -> list[str]:
    rows = []
    for what, law, chosen in laws_of(report.contact, report.study.stated):
        doi = f", doi:{law.doi}" if law.doi else ""
        rows.append(
            [
                escape(what),
                f"<b>{escape(law.name)}</b>: {escape(law.title)}",
                "study" if chosen else "<span class=default>default</span>",
                words(law.valid_range),
                escape(law.provenance),
                escape(law.citation + doi),
            ]
        )
    psi = (
        report.contact.surfaces.E_star
        / report.contact.surfaces.H
        * math.sqrt(report.contact.roughness.sigma_s / report.contact.roughness.R)
    )
    verdict = (
        "above 1, asperities yield under nearly any load, and an elastic law would be wrong"
        if psi > 1
        else "below 0.6, asperities stay elastic, and laws with and without yield agree"
        if psi < 0.6
        else "between 0.6 and 1, the load decides whether asperities yield"
    )
    why = (
        "The plasticity index of Greenwood and Williamson, ψ = (E*/H)√(σ_s/R), is "
        f"{number(psi, 3)}: {verdict}. The pages “Choose an asperity law” and “Choose a seat” of "
        "the documentation say how laws differ, and which suits which surface. The command "
        "compare puts other laws beside this one."
    )
    head = ["for", "law", "chosen by", "valid", "provenance", "source"]
    return [
        f"<p class=lead-in>{words(why)}</p>",
        table(head, rows),
        "<p class=soft>Provenance: seen means that the formulas were read in the source, "
        "derived that they follow from what is said here, recalled that they were known "
        "without the source at hand, reconstructed that the source left something open.</p>",
    ]


def works_cited(report: Found) -> list[str]:
    lines = [
        *report.result.citations,
        *(() if report.film is None else report.film.citations),
        *(
            output.citation + (f", doi:{output.doi}" if output.doi else "")
            for output in report.contact.outputs
        ),
        f"thirdbody {__version__}",
    ]
    items = "".join(f"<li>{escape(line)}</li>" for line in dict.fromkeys(lines))
    return [f"<ul>{items}</ul>"]


def source_of(body: Material) -> tuple[str, str]:
    """Where the numbers of a body come from, and how well that is known (HTML)."""
    texts, standing = sources_of(body)
    return "<br>".join(map(symbols, texts)), escape(standing)


def sources_of(body: Material) -> tuple[list[str], str]:
    """Sources of the numbers of a body, a text each, and how well they are known."""
    entry = materials.entries().get(body.name, {})
    numbers = {key: getattr(body, key) for key in NUMBERS if getattr(body, key) is not None}
    if not entry or any(value != entry.get(key) for key, value in numbers.items()):
        return [body.source or "not stated"], "given by the study"
    texts = [entry["source"] + (f", doi:{entry['doi']}" if entry.get("doi") else "")]
    texts += [
        f"{NUMBERS[key]['symbol']}: {text}"
        for key, text in entry.get("sources", {}).items()
        if key in numbers
    ]
    standing = entry.get("standing", "")
    return texts, STANDING.get(standing, standing)


def bodies_by_label(bodies: dict[str, Material]) -> list[tuple[str, Material]]:
    """Bodies by label; two surfaces of one material share a row."""
    out = dict(bodies)
    if "surface 1" not in out:
        return list(out.items())
    first, second = (out[f"surface {i}"] for i in (1, 2))
    if dataclasses.asdict(first) == dataclasses.asdict(second):
        out = {"both surfaces": first} | {k: v for k, v in out.items() if "surface" not in k}
    names = {name: name.removeprefix("the ") for name in out}
    if "the particles 1" in out and "the particles 2" not in out:
        names["the particles 1"] = "particles"
    return [(names[name], body) for name, body in out.items()]


def kind_of(value: Value) -> str:
    """A law by its name; a distribution in words."""
    if isinstance(value, Law):
        return value.name
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(value).__name__).lower()


def rows_of(contact: Contact) -> list[Row]:
    """Every input but the materials: numbers, words, and which distribution or law."""
    rows = list(value_rows(contact, ""))
    rough = contact.roughness
    if rough.eta is None and rough.eta_R_sigma is None:
        name = "roughness.eta_R_sigma"
        about = declared_quantity(contact, name)
        value = numbers_of(contact)[name]
        row = Row(name, about["symbol"], number(value), about["meaning"], True, value, "1")
        place = next(i for i, other in enumerate(rows) if other.name == "roughness.alpha")
        rows.insert(place + 1, row)
    return rows


def value_rows(value: Value, path: str) -> Iterator[Row]:
    """Rows of every input of a value; names begin with ``path``."""
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        content, name = getattr(value, item.name), f"{path}{item.name}"
        default = _is_default(item, content)
        if about := item.metadata.get("quantity"):
            if content is not None:
                text = value_of(content, about["unit"])
                cells = (name, about["symbol"], text, about["meaning"], default)
                yield Row(*cells, float(content), about["unit"])
        elif about := item.metadata.get("choice"):
            yield Row(name, "", str(content), about["meaning"], default)
        elif isinstance(content, Value) and not isinstance(content, Material):
            if name == "particle_law" and value.two_body:  # type: ignore[attr-defined]
                continue
            if item.name not in ("surfaces", "roughness", "particles"):
                yield Row(name, "", kind_of(content), item.name.replace("_", " "), default)
                yield from value_rows(content, f"{name}.")
            elif item.name != "surfaces":
                yield from value_rows(content, f"{name}.")
        elif isinstance(content, tuple) and content:
            for place, member in enumerate(content):
                if isinstance(member, Value):
                    label = member.name if isinstance(member, AbstractOutput) else place
                    yield from value_rows(member, f"{name}.{label}.")
            if about := item.metadata.get("several"):
                text = f"{len(content)} values, {span(min(content), max(content), about['unit'])}"
                if min(content) == max(content):
                    text = value_of(content[0], about["unit"])
                yield Row(name, "", text, about["meaning"], default)


def _is_default(item: dataclasses.Field[Any], value: object) -> bool:
    if item.default is not dataclasses.MISSING:
        return bool(item.default == value)
    if item.default_factory is not dataclasses.MISSING:
        return bool(item.default_factory() == value)
    return False


def laws_of(contact: Contact, stated: Collection[str] = frozenset()) -> list[tuple[str, Law, bool]]:
    """Role of each law, the law, and whether the study, which states these names, chose it."""
    fields = {item.name: item for item in dataclasses.fields(contact)}

    def is_chosen(name: str) -> bool:
        return name in stated or not _is_default(fields[name], getattr(contact, name))

    out: list[tuple[str, Law, bool]] = [
        ("asperities", contact.asperity_law, is_chosen("asperity_law"))
    ]
    for i, population in enumerate(contact.populations):
        law = contact.law_of(population)
        what = "particles" + (
            f" ({population.name or i + 1})" if len(contact.populations) > 1 else ""
        )
        chosen = population.law is not None or is_chosen("particle_law")
        out.append((what, law, chosen))
        if isinstance(inner := getattr(law, "law", None), Law):
            out.append((f"{what}: one indentation", inner, chosen))
    out += [("output", output, True) for output in contact.outputs]
    return out
