"""Real areas at which contacts that are counted one by one have grown together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import Note
from ..laws.base import AbstractParticleLaw, SeatedLaw
from ..laws.field.formulas import hardness_ratio
from ..quantities.say import percent
from .status import MOST_AREA, Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..contact.contact import Contact

    Array = NDArray[np.float64]

__all__ = ["AREA", "about_area", "chi_of", "crowded_places", "is_crowded"]

CLOSE = 0.05
"""Real area above which summits grow together that this model counts one by one; the numbers are
those of the book's page "Point by point", where χ is 0.07 to 0.24."""
WIDE = 0.2
"""Real area above which neighbouring contacts interact, wherever particles lie."""
HARD, ELASTIC = 0.25, 2.0
"""χ above which the law of a single summit, one radius for all and merging add up instead of
cancelling, and above which pressed surfaces were elastic."""
CLOSE_HARD = 0.005
"""Real area from which that was seen: the smallest that was pressed."""


AREA = "area"
"""What the codes of notes on the real area begin with."""
FIELD = 'take the asperity law "field", which was within 7 % there'
POINTS = "explicit.solve (thirdbody explicit) presses it point by point"


def chi_of(contact: Contact) -> float:
    r"""How far the slopes of a surface go to plastic contact: χ [1], small where all is plastic.

    .. math:: \chi = \frac{H}{E^* g}, \qquad g = \sqrt{2 m_2}

    Parameters
    ----------
    contact : Contact
        Its H is that of the softer surface, E* that of both, and g the RMS slope of its roughness.

    Returns
    -------
    float

    References
    ----------
    1/χ is Mikic's plasticity index but for a factor of order one: Mikic 1974, Int. J. Heat Mass
    Transfer 17, 205 (from memory).

    Examples
    --------
    >>> import thirdbody as tb
    >>> hard = tb.Material(E=2e11, nu=0.3, H=1.1e10)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(hard, hard),
    ...                      roughness=tb.Roughness(sigma=300e-9, R=3e-6))
    >>> round(chi_of(contact), 2)
    0.41
    """
    return hardness_ratio(contact.roughness, E_star=contact.E_ss, H=contact.surfaces.H)


def is_crowded(contact: Contact, A_t: Array) -> NDArray[np.bool_]:
    """Mask of real areas (N,) too large for a model that counts contacts one by one.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> is_crowded(contact, np.array([0.2, 0.6, np.nan])).tolist()
    [False, True, False]
    """
    if not _counts_summits(contact):
        return np.zeros(np.shape(A_t), bool)
    with np.errstate(invalid="ignore"):
        return np.asarray(A_t > MOST_AREA)


def crowded_places(contact: Contact, A_t: Array, load: Array) -> tuple[float, str]:
    """The share of the load [1] at places that are crowded, and the status of the whole.

    Parameters
    ----------
    contact : Contact
    A_t : array (N,)
        Real area per nominal area of each place [1].
    load : array (N,)
        What each place carries, in any unit: its pressure times its share of the area.

    Returns
    -------
    float, str
        The status is "ok", or a sentence that begins with "crowded".

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> crowded_places(contact, np.array([0.2, 0.6]), np.array([3.0, 1.0]))[0]
    0.25
    """
    close = is_crowded(contact, A_t)
    if not np.any(close):
        return 0.0, Status.OK.sentence
    share = float(np.sum(load[close]) / np.sum(load))
    return share, f"{Status.CROWDED.sentence}; so it is where {percent(share)} of the load is"


def about_area(contact: Contact, most: float, chi: Sequence[float] = ()) -> list[Note]:
    """Notes on the real area reached by states; ``chi`` of contacts that differ."""
    out: list[Note] = []
    if not _counts_summits(contact):
        if most > MOST_AREA:
            what = (
                f"A_t reaches {most:.3g}: the law of one field was compared with surfaces pressed "
                f"point by point up to {MOST_AREA:g} only"
            )
            out.append(Note(what, code=AREA, action=POINTS))
        return out
    if most > WIDE:
        what = (
            f"A_t reaches {most:.3g}: above {WIDE:g} neighbouring contacts interact, "
            "which this model neglects"
        )
        out.append(Note(what, code=f"{AREA}.close", action=POINTS))
    if not any(_lies_anywhere(contact.law_of(p)) for p in contact.populations):
        return out
    ratios = sorted(chi) or [chi_of(contact)]
    hard = [one for one in ratios if HARD < one < ELASTIC]
    if ratios[0] <= HARD and most > CLOSE:
        what = (
            f"A_t reaches {most:.3g}: pressed point by point, surfaces with more than "
            f"{CLOSE:g} were 0.04 to 0.65 sigma further apart than this model says, and their "
            "particles carried 7 to 17 % less"
        )
        out.append(Note(what, code=f"{AREA}.plastic", effect=0.17, action=POINTS))
    if hard and most > CLOSE_HARD:
        low, high = f"{hard[0]:.2g}", f"{hard[-1]:.2g}"
        where = low if low == high else f"{low} to {high}"
        near = hard[-1] <= 0.31
        less, apart = ("3 to 4 %", "0.06 to 0.26") if near else ("19 to 30 %", "0.05 to 0.72")
        what = (
            f"A_t reaches {most:.3g} at chi = H/(E* g) = {where} (g: RMS slope). Such surfaces, "
            f"pressed point by point, stood {apart} sigma further apart, and their particles "
            f"carried {less} less than this model says"
        )
        effect, action = 0.04 if near else 0.3, FIELD
        out.append(Note(what, code=f"{AREA}.hard", effect=effect, action=action))
    if ratios[-1] >= ELASTIC and most > CLOSE:
        what = (
            f"A_t reaches {most:.3g} at chi = H/(E* g) = {ratios[-1]:.2g} (g: RMS slope): elastic "
            "surfaces pressed point by point had 14 to 47 % more area than this model says and "
            "were 0.04 to 0.79 sigma further apart; what their particles carry is not known"
        )
        out.append(Note(what, code=f"{AREA}.elastic", effect=0.47, action=POINTS))
    return out


def _counts_summits(contact: Contact) -> bool:
    """Whether the load of asperities is a sum over summits; a law of the whole surface says no."""
    return not contact.asperity_law.of_surface


def _lies_anywhere(law: AbstractParticleLaw) -> bool:
    """Whether particles rest on the rough surface itself, as those that were pressed."""
    return isinstance(law, SeatedLaw) and law.seat == "rough"
