"""What a study knows of the numbers of a life: [life.uncertainty], and what [uncertainty] adds."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..analysis.uncertainty.inputs import Uncertain
from ..errors import InvalidValue, Mistake, Problem
from ..quantities.say import value_of
from ..quantities.units import Quantity, say, to_si
from ..quantities.value import quantity
from ..systems.life.circuit import OilCircuit
from .inputs import inputs_of
from .reader import Reader, get
from .toml import override, read
from .uncertainty import LIFE, ranges_of, read_uncertain

__all__ = [
    "FACTOR",
    "KnownOfLife",
    "about_circuit",
    "asks_for_bands",
    "known_of_life",
    "names_life",
    "one_name_of",
    "place_of_beta",
    "with_numbers",
]

FACTOR = quantity("f", "1", "factor on all that enters or arrives", gt=0).metadata["quantity"]
BETA = quantity("β", "1", "particles before over particles behind", ge=1).metadata["quantity"]
INGRESS_FACTOR = "ingress"
About = Callable[[str], tuple[str, Quantity | None]]
"""Name of a number, and what it is, by the name in the file; None for what is none."""


@dataclass(frozen=True, kw_only=True)
class KnownOfLife:
    """What is known of the numbers of a life, and how it is drawn.

    Attributes
    ----------
    vary : dict of str to Uncertain
        By names as `thirdbody.study.life_bands` takes them.
    samples : int, optional
        Sets that are drawn, of [uncertainty] where that says it.
    seed : int
        Of the drawing.
    places : dict of str to str
        Where each stands in the file.
    """

    vary: Mapping[str, Uncertain] = field(default_factory=dict)
    samples: int | None = None
    seed: int = 0
    places: Mapping[str, str] = field(default_factory=dict)

    @contextmanager
    def in_file(self) -> Iterator[None]:
        """Context whose mistakes stand where the numbers of ``vary`` do in the file."""
        try:
            yield
        except InvalidValue as error:
            raise InvalidValue(
                *(
                    problem.changed(path=self.places[problem.place], owner="")
                    if problem.place in self.places
                    else problem
                    for problem in error.problems
                )
            ) from None


def place_of_beta(circuit: OilCircuit, name: str) -> tuple[int, int] | None:
    """Which β ratio of which filter "filters.0.beta.7 um" is; None for another name."""
    head, separator, size = name.partition(".beta.")
    which = head.removeprefix("filters.")
    if not separator or not which.isdecimal() or int(which) >= len(circuit.filters):
        return None
    try:
        at = to_si(size.replace("(c)", "").strip(), "m")
    except InvalidValue:
        return None
    near = [abs(filter_size / at - 1) < 1e-9 for filter_size in circuit.filters[int(which)].sizes]
    return (int(which), near.index(True)) if any(near) else None


def one_name_of(circuit: OilCircuit, name: str) -> str:
    """The name of a number of a circuit: of a β ratio, however its size is written, always one."""
    place = place_of_beta(circuit, name)
    if place is None:
        return name
    which, i = place
    size = value_of(circuit.filters[which].sizes[i], "m", 12).replace("µ", "u")
    return f"filters.{which}.beta.{size}"


def about_circuit(circuit: OilCircuit, name: str) -> Quantity | None:
    """What a number of a circuit is, by its dotted name; None where it is none."""
    if name == INGRESS_FACTOR:
        return FACTOR
    if place_of_beta(circuit, name) is not None:
        return BETA
    parent, _, last = name.rpartition(".")
    try:
        owner, number_of_it = circuit.value_at(parent), circuit.value_at(name)
    except InvalidValue:
        return None
    fields = getattr(owner, "__dataclass_fields__", {})
    if last not in fields or not isinstance(number_of_it, float):
        return None
    return fields[last].metadata.get("quantity")


def with_numbers(circuit: OilCircuit, values: Mapping[str, float]) -> OilCircuit:
    """The circuit with some of its numbers changed."""
    changes: dict[str, Any] = dict(values)
    factor = changes.pop(INGRESS_FACTOR, None)
    if factor is not None:
        scaled = [
            ingress.replace(
                **{
                    name: factor * getattr(ingress, name)
                    for name in ("rate", "steady")
                    if getattr(ingress, name) is not None
                }
            )
            for ingress in circuit.ingress
        ]
        circuit = circuit.replace(ingress=tuple(scaled))
    for name in list(changes):
        if (place := place_of_beta(circuit, name)) is not None:
            which, i = f"filters.{place[0]}.betas", place[1]
            betas = changes.get(which, circuit.filters[place[0]].betas)
            changes[which] = (*betas[:i], changes.pop(name), *betas[i + 1 :])
    return circuit.replace(**changes) if changes else circuit


def names_life(whole: Mapping[str, object]) -> bool:
    """Whether a parsed file says what is known of numbers of its [life]."""
    if get(whole.get("life"), "uncertainty") is not None:
        return True
    inputs = get(whole.get("uncertainty"), "inputs")
    return isinstance(inputs, dict) and any(name.startswith(LIFE) for name in ranges_of(inputs))


def known_of_life(
    reader: Reader, ranges: Mapping[str, object], about: About, names: str, *, contact: bool
) -> KnownOfLife:
    """What is known of the numbers of a life.

    Parameters
    ----------
    reader : Reader
    ranges : mapping
        The table [life.uncertainty].
    about : callable
        What the numbers of the life are.
    names : str
        Them all, for whoever writes another one.
    contact : bool
        Whether numbers of the contact of the study act in it: those of [surfaces], [roughness],
        [outputs].
    """
    parts = _inputs_of_contact(reader) if contact else {}

    def one(reader: Reader, where: str, pair: tuple[str, object]) -> tuple[str, Uncertain]:
        label, entry = pair
        name, quantity_of = about(label)
        if quantity_of is None:
            name, quantity_of = parts.get(label, (name, None))
        if quantity_of is None:
            raise InvalidValue(Problem(where, names, code=Mistake.UNKNOWN))
        return name, read_uncertain(reader, where, quantity_of, entry)

    places: dict[str, str] = {}

    def all_of(pairs: Mapping[str, tuple[str, object]]) -> dict[str, Uncertain]:
        numbers = reader.read_each(pairs, one)
        first: dict[str, str] = {}
        twice = []
        for where, (name, _) in zip(pairs, numbers, strict=True):
            if (before := first.setdefault(name, where)) != where:
                twice.append(
                    Problem(
                        where,
                        f"is the same number as {before}; keep one of them",
                        code=Mistake.CLASH,
                    )
                )
        if twice:
            raise InvalidValue(*twice)
        places.update(first)
        return dict(numbers)

    def pairs_of(path: str, entries: Mapping[str, object]) -> dict[str, tuple[str, object]]:
        return {
            f"{path}.{say(label)}": (label.removeprefix(LIFE), entry)
            for label, entry in entries.items()
        }

    pairs = pairs_of("life.uncertainty", ranges)
    table = reader.whole.get("uncertainty")
    if not names_life({"uncertainty": table}):
        return KnownOfLife(vary=all_of(pairs), places=places)
    entries = ranges_of(get(table, "inputs"))
    mine = {k: v for k, v in entries.items() if k.startswith(LIFE) or k in parts}
    dry = {k: v for k, v in entries.items() if k not in mine and about(k)[1] is not None}
    pairs |= pairs_of("uncertainty.inputs", mine | dry)
    if idle := [say(name) for name in entries if name not in mine and name not in dry]:
        reader.notes.append(f"uncertainty.inputs: {', '.join(idle)} has no effect on [life]")
    return KnownOfLife(
        vary=all_of(pairs),
        samples=get(table, "samples"),
        seed=get(table, "seed") or 0,
        places=places,
    )


def _inputs_of_contact(reader: Reader) -> dict[str, tuple[str, Quantity]]:
    """Numbers of the contact by their names in the file; its particles are those of the oil."""
    return {
        one_input.name: (one_input.field, one_input.quantity)
        for one_input in inputs_of(reader.whole)
        if one_input.quantity and not one_input.idle and not one_input.table.startswith("particle")
    }


def asks_for_bands(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> bool:
    """Whether a study file has [life.uncertainty], or names numbers of [life] in [uncertainty].

    Parameters
    ----------
    path : path-like
    overrides : iterable of str, optional
        As those of `thirdbody.load_study`.
    """
    return names_life(override(read(Path(path)), list(overrides)))
