r"""Pieces: classes of size behind a gap in which particles break.

A particle of size x becomes κ⁻³ pieces of size κx in the same gap, and these may break again. A
piece between the mean volumes of two classes goes to both,

.. math:: n_a v_a + n_b v_b = v, \qquad n_a + n_b = 1

so that volume and number are kept; where κ is a whole number of classes it goes to one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from .size_classes import SizeClasses

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["break_up", "daughters"]

WHOLE = 1e-9
"""Classes by which a piece may miss one, relatively, and still be in it."""


def daughters(classes: SizeClasses, *, ratio: float) -> Array:
    r"""Pieces of one broken particle of each class: daughters by parents (K, K).

    Parameters
    ----------
    classes : SizeClasses
    ratio : float
        κ, size of the pieces over that of their parent [1].

    Returns
    -------
    array
        Volume that is finer than the first class is missing from it.

    Raises
    ------
    InvalidValue
        A ratio that is not between 0 and 1.

    References
    ----------
    Kumar, Ramkrishna 1996, Chem. Eng. Sci. 51, 1311, doi:10.1016/0009-2509(96)88489-2 (abstract):
    fixed pivots that keep two moments.

    Examples
    --------
    >>> classes = SizeClasses.covering(smallest=1e-6, largest=8e-6)
    >>> daughters(classes, ratio=0.5)[:, 4].tolist()[:4]
    [8.0, 0.0, 0.0, 0.0]
    """
    if not 0 < ratio < 1:
        rule = "must be above 0 and below 1 [1]"
        raise InvalidValue(Problem("ratio", rule, repr(ratio), code=Mistake.RANGE))
    volumes = classes.volumes
    out = np.zeros((len(volumes), len(volumes)))
    for parent, volume in enumerate(volumes * ratio**3):
        place = int(np.searchsorted(volumes, volume * (1 + WHOLE), side="right")) - 1
        if place < 0:
            continue
        if place == len(volumes) - 1 or abs(volume / volumes[place] - 1) < WHOLE:
            out[place, parent] = ratio**-3
            continue
        above = (volume - volumes[place]) / (volumes[place + 1] - volumes[place])
        out[place, parent] = (1 - above) * ratio**-3
        out[place + 1, parent] = above * ratio**-3
    return out


def break_up(broken: ArrayLike, *, classes: SizeClasses, ratio: float) -> Array:
    r"""What one particle of each class is once all that breaks in a gap has broken: (K, K).

    .. math:: C = (1-b)\,(I - B b)^{-1}

    Parameters
    ----------
    broken : array (K,)
        b, part of the particles of each class that break in the gap [1].
    classes : SizeClasses
    ratio : float
        κ [1].

    Returns
    -------
    array
        Numbers by class behind the gap, of one particle of a class before it; volume that is finer
        than the first class is missing.

    Examples
    --------
    >>> classes = SizeClasses.covering(smallest=1e-6, largest=8e-6)
    >>> b = [0.0] * 8 + [0.5] * 4
    >>> break_up(b, classes=classes, ratio=0.5)[:, 11].round(3).tolist()
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.5]
    """
    b = np.asarray(broken, float)
    B = daughters(classes, ratio=ratio)
    arrived = np.linalg.inv(np.eye(len(b)) - B * b)
    return (1 - b)[:, None] * arrived
