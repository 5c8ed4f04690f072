"""Where states leave what is known of the model, one sentence each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import Interface
from ..laws.asperity import Field
from ..laws.base import AbstractParticleLaw, SeatedLaw
from ..laws.field.formulas import hardness_ratio
from ..laws.particle.breakage import about_strength

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["about_area", "about_elastic", "about_particles"]


def about_area(contact: Contact, most: float) -> list[str]:
    """What states whose real area reaches this leave out."""
    if isinstance(contact.asperity_law, Field):
        if most <= CROWDED:
            return []
        return [
            f"A_t reaches {most:.3g}: the law of one field was held against surfaces pressed point "
            f"by point up to {CROWDED:g} only"
        ]
    out = []
    if most > 0.2:
        out.append(
            f"A_t reaches {most:.3g}: above 0.2 neighbouring contacts interact, "
            "which this model neglects"
        )
    anywhere = any(_lies_anywhere(contact.law_of(p)) for p in contact.populations)
    chi = _hardness_ratio(contact)
    if most > SMALL and anywhere and MIDDLE[0] < chi < MIDDLE[1]:
        out.append(
            f"A_t reaches {most:.3g} and H/(E*g) = {chi:.2g}, with the RMS gradient g: pressed "
            "point by point at 0.41, particles carried 22 to 26 % less than this model says from "
            'a real area of 0.006 on; the asperity law "field" was within 5 %'
        )
    elif most > CLOSE and anywhere:
        out.append(
            f"A_t reaches {most:.3g}: pressed point by point, surfaces with more than "
            f"{CLOSE:g} were 0.04 to 0.65 sigma further apart than this model says, and their "
            "particles carried 7 to 17 % less"
        )
    return out


def _hardness_ratio(contact: Contact) -> float:
    """χ of the contact: hardness over the pressure that flattens the slopes."""
    pair = contact.surfaces
    return hardness_ratio(contact.roughness, E_star=pair.E_star, H=pair.H)


SMALL, MIDDLE = 0.006, (0.25, 2.0)
"""Real area and χ in which a sum over summits is known to carry too little; the numbers are those
of the book's page "Point by point"."""
CROWDED = 0.5
"""Real area up to which the law of one field is meant."""
CLOSE = 0.05
"""Real area above which summits grow together that this model counts one by one; the numbers are
those of the book's page "Point by point"."""


def _lies_anywhere(law: AbstractParticleLaw) -> bool:
    """Whether particles rest on the rough surface itself, as those that were pressed."""
    return isinstance(law, SeatedLaw) and law.seat == "rough"


BROAD = 8.0
"""Nayak bandwidth above which elastic asperities are known to have too little area."""


def about_elastic(
    contact: Contact, bound: Interface, full: dict[str, Array], d: Array
) -> list[str]:
    """What is known of elastic asperities of a broad spectrum, where these carry area."""
    alpha = contact.roughness.alpha
    if bound.one_field:
        return []
    with np.errstate(invalid="ignore"):
        count = np.isfinite(d) & (full["A_ss"] > 0.1 * full["A_t"])
    if not alpha > BROAD or not np.any(count):
        return []
    _, elastic, *others = bound.asperities.fields(np.array([d[count].max()]))[0]
    if not elastic > sum(others):
        return []
    return [
        f"alpha = {alpha:.3g}: elastic asperities at alpha = 12 have 30 to 38 % less area at equal "
        "load than boundary elements, at alpha = 670 less than half; where they yield (A = F/H) "
        "this does not matter"
    ]


def about_particles(contact: Contact) -> list[str]:
    """One sentence for each way in which the particles leave the model's validity."""
    out = []
    for each in contact.populations:
        out += contact.law_of(each).warnings(contact.surfaces, contact.roughness, each)
        out += about_strength(each, contact.surfaces)
    covered = sum(each.coverage for each in contact.populations)
    if covered >= 0.3:
        out.append(
            f"particles would cover {covered:.2g} of the nominal area: above 0.3 they touch each "
            "other"
        )
    return out
