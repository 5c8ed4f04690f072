"""The numbers that a contact is made of, by name."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contact.contact import Contact
from ..contact.output import AbstractOutput
from ..equilibrium.columns import COLUMNS
from ..equilibrium.states import carries, problem_of_name, unknown_inputs, vary_contact
from ..errors import InvalidValue, Mistake, Problem
from ..populations.roughness import ETA_R_SIGMA
from ..quantities.say import join_words
from ..quantities.units import Quantity
from ..quantities.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

    Offsets = NDArray[np.intp]

__all__ = ["inputs"]

NOT_NUMBERS = ("mode", "status", "residual", "iterations")
NUMBERS = tuple(name for name in COLUMNS if name not in NOT_NUMBERS)
"""Columns with a derivative."""


# -------------------------------------------------------------------------- inputs
def inputs(contact: Contact) -> dict[str, float]:
    """Every number that a contact is made of and that can be varied, by its dotted name.

    Several populations are numbered, ``particles.0.areal_density``; outputs go by their names,
    ``outputs.friction.tau_ss``.
    """
    out = dict(_numbers(contact, ""))
    if not contact.outputs:
        out = {name: v for name, v in out.items() if carries(name)}
    rough = contact.roughness
    if rough.eta is None and rough.eta_R_sigma is None:
        out["roughness.eta_R_sigma"] = ETA_R_SIGMA
    if contact.two_body:
        out = {name: v for name, v in out.items() if not name.startswith("particle")}
    return out


def _numbers(value: Value, prefix: str) -> Iterator[tuple[str, float]]:
    for item in dataclasses.fields(value):  # type: ignore[arg-type]
        field_value = getattr(value, item.name)
        if "quantity" in item.metadata and field_value is not None:
            yield prefix + item.name, field_value
        elif isinstance(field_value, Value):
            yield from _numbers(field_value, f"{prefix}{item.name}.")
        elif isinstance(field_value, tuple):
            for place, member in enumerate(field_value):
                label = member.name if isinstance(member, AbstractOutput) else place
                if isinstance(member, Value):
                    yield from _numbers(member, f"{prefix}{item.name}.{label}.")


class Input(NamedTuple):
    """Numbers of a contact that move by one factor: at t each is value + scale·t."""

    label: str
    names: tuple[str, ...]
    values: tuple[float, ...]
    scales: tuple[float, ...]

    def numbers_at(self, t: float | Array) -> dict[str, Any]:
        parts = zip(self.names, self.values, self.scales, strict=True)
        return {name: value + scale * t for name, value, scale in parts}


def input_of(contact: Contact, label: str, where: str = "vary[{!r}]") -> Input:
    """The input of a dotted name, or of several joined by "+"; mistakes say ``where`` it stands."""
    names = tuple(name.strip() for name in label.split("+"))
    numbers = inputs(contact)
    if problems := [
        _no_input(contact, name, numbers, where) for name in names if name not in numbers
    ]:
        raise InvalidValue(*problems)
    values = tuple(numbers[name] for name in names)
    if len(names) > 1:
        if problems := [
            problem_of_name(
                where, label, f"moves its inputs by one factor, but {name} is zero", Mistake.BEYOND
            )
            for name, value in zip(names, values, strict=True)
            if value == 0
        ]:
            raise InvalidValue(*problems)
        return Input(label, names, values, values)
    return Input(label, names, values, (_scale(contact, names[0], values[0], where),))


def _scale(contact: Contact, name: str, value: float, where: str) -> float:
    """By how much an input changes when it changes a lot."""
    about = declared_quantity(contact, name)
    if value > 0 and 0 in (about["gt"], about["ge"]):
        return value
    usual = {"1": 1.0, "m": contact.roughness.sigma}.get(about["unit"], 0.0)
    if not (scale := max(abs(value), usual)):
        hint = "give it a value to say what a small change is"
        raise InvalidValue(problem_of_name(where, name, "is zero", Mistake.RANGE, hint=hint))
    return scale


def declared_quantity(contact: Contact, name: str) -> Quantity:
    """Symbol, unit and range of an input."""
    path, _, last = name.rpartition(".")
    owner = contact.value_at(path)
    (about,) = (i.metadata["quantity"] for i in dataclasses.fields(owner) if i.name == last)
    return about


BODIES = {
    "surfaces.first": "of the first surface",
    "surfaces.second": "of the second surface",
    "asperity_law": "of the asperity law",
    "particle_law": "of the particle law",
    "particles": "of the particles",
}
"""Whose a number is that its own words leave open."""
WHOLE = {
    "pressure": "nominal pressure",
    "F_star": "load F/(A_n E_ss)",
    "d": "separation d, from the mean asperity height",
    "particles.concentration": "concentration of the particles",
    "particles.areal_density": "particles per nominal area",
    "particles.material": "material of the particles",
    "roughness.eta_R_sigma": "product of asperity density, radius and RMS height",
}
"""Words of names that have no owner, or tell it themselves."""


def words_of(contact: Contact, label: str) -> str:
    """An input in words, or several joined by "+"; a name without words as it is.

    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                   roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> words_of(contact, "roughness.R"), words_of(contact, "surfaces.first.H+surfaces.second.H")
    ('mean asperity radius', 'hardness of both surfaces')
    """
    pairs = [_words_and_owner(contact, name.strip()) for name in label.split("+")]
    meanings = list(dict.fromkeys(meaning for meaning, _ in pairs))
    owners = list(dict.fromkeys(owner for _, owner in pairs))
    if owners == [BODIES["surfaces.first"], BODIES["surfaces.second"]]:
        owners = ["of both surfaces"]
    if len(owners) > 1 and len(meanings) > 1:
        return join_words([f"{meaning} {owner}".strip() for meaning, owner in pairs])
    return f"{join_words(meanings)} {join_words(owners)}".strip()


def _words_and_owner(contact: Contact, name: str) -> tuple[str, str]:
    """Meaning of a number, and the body that it belongs to."""
    if name in WHOLE:
        return WHOLE[name], ""
    try:
        meaning = str(declared_quantity(contact, name)["meaning"])
    except (InvalidValue, ValueError, TypeError):
        return name, ""
    first, _, place = name.partition(".")
    if first == "particles" and (number := place.partition(".")[0]).isdecimal():
        population = contact.value_at(f"particles.{number}")
        called = population.name or population.material.name or f"population {int(number) + 1}"
        law = "law of " if place.partition(".")[2].startswith("law.") else ""
        return meaning, f"of {law}{called}"
    return meaning, next((said for of, said in BODIES.items() if name.startswith(f"{of}.")), "")


def _no_input(contact: Contact, name: str, numbers: Iterable[str], where: str) -> Problem:
    """Why a name is not an input that can be varied."""
    if unknown := next(unknown_inputs(contact, [name], list(numbers), where), None):
        return unknown
    if name in ("roughness.eta", "roughness.eta_R_sigma"):
        other = "eta_R_sigma" if name.endswith("eta") else "eta"
        hint = f"the density follows from 'roughness.{other}', use that"
        return problem_of_name(where, name, "is not given", Mistake.MISSING, hint=hint)
    if contact.value_at(name) is None:
        rule = "is None: the contact finds it from its other inputs"
        hint = "vary those, or give it a value"
        return problem_of_name(where, name, rule, Mistake.BEYOND, hint=hint)
    rule = "is not a number that could change a little"
    return problem_of_name(where, name, rule, Mistake.BEYOND)


# -------------------------------------------------------------------------- differences
TO = "to = {!r}"
"""How the place of an input is written by which something is differentiated."""
FULL_REACH = 4
"""Steps to either side of a difference with all its digits."""


@lru_cache
def places_of(reach: int) -> tuple[Offsets, ...]:
    """Where the states of a difference lie, in steps: around an input, above it, and below it."""
    count = 2 * reach + 1
    return np.arange(-reach, reach + 1), np.arange(count), -np.arange(count)


def _room(contact: Contact, moved: Input, step: float, reach: int = FULL_REACH) -> Offsets:
    """Offsets of a difference on both sides, or on the side to which the input may go."""
    why = ""
    for offsets in places_of(reach):
        try:
            for end in (offsets[0], offsets[-1]):
                vary_contact(contact, moved.numbers_at(float(step * end)))
        except InvalidValue as refused:
            why = why or str(refused)
        else:
            return offsets
    rule = f"can be moved to neither side: {why}"
    raise InvalidValue(problem_of_name(TO, moved.label, rule, Mistake.BEYOND))
