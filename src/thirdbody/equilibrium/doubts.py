"""Where states leave what is known of the model, one sentence each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import Interface
from ..errors import Note
from ..laws.particle.breakage import about_strength
from ..quantities.say import value_of
from .crowding import POINTS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["BEYOND", "SHADOW", "about_elastic", "about_hardness", "about_particles"]


BROAD = 8.0
"""Nayak bandwidth above which elastic asperities are known to have too little area."""
BEYOND = "beyond"
"""Code of the note on asperities beyond the range of their law."""
SHADOW = Note("particles shadow the whole area: the area correction was cut at zero", code="shadow")
FEWER = "check the unit of areal_density and of the sizes"


def about_elastic(
    contact: Contact, contact_interface: Interface, full: dict[str, Array], d: Array
) -> list[str]:
    """Note on elastic asperities of a broad spectrum, where these carry area."""
    alpha = contact.roughness.alpha
    if contact_interface.one_field:
        return []
    with np.errstate(invalid="ignore"):
        count = np.isfinite(d) & (full["A_ss"] > 0.1 * full["A_t"])
    if not alpha > BROAD or not np.any(count):
        return []
    _, elastic, *others = contact_interface.asperities.fields(np.array([d[count].max()]))[0]
    if not elastic > sum(others):
        return []
    what = (
        f"alpha = {alpha:.3g}: elastic asperities at alpha = 12 have 30 to 38 % less area at equal "
        "load than boundary elements, at alpha = 670 less than half; where they yield (A = F/H) "
        "this does not matter"
    )
    return [Note(what, code="alpha", effect=0.38, action=POINTS)]


def about_hardness(contact: Contact) -> list[str]:
    """Note on materials that are harder than stiff, of which there are none."""
    bodies = {"surfaces.first": contact.surfaces.first, "surfaces.second": contact.surfaces.second}
    several = len(contact.populations) > 1
    for i, population in enumerate(contact.populations):
        bodies[f"particles.{i}" if several else "particles"] = population.material
    hard = {place: body for place, body in bodies.items() if body.H > body.E}
    if not hard:
        return []
    where = " and ".join(
        f"{place}: H = {value_of(body.H, 'Pa')} above E = {value_of(body.E, 'Pa')}"
        for place, body in hard.items()
    )
    what = (
        f"{where}: no solid is harder than about a tenth of its Young's modulus; one as hard "
        "yields nowhere, so what it carries and dents is that of no material"
    )
    return [Note(what, code="hardness", effect=1.0, action="check the units of H and of E")]


def about_particles(contact: Contact) -> list[str]:
    """Notes on particles outside the model's validity, one sentence each."""
    out = []
    for population in contact.populations:
        out += contact.law_of(population).warnings(contact.surfaces, contact.roughness, population)
        out += about_strength(population, contact.surfaces)
    covered = sum(population.coverage for population in contact.populations)
    if covered >= 0.3:
        what = f"particles would cover {covered:.2g} of the nominal area: above 0.3 they touch "
        out.append(Note(f"{what}each other", code="coverage", action=FEWER))
    return out
