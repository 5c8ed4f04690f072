"""A study on one small surface, every particle at its place: seconds, for pages and reports."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import Equilibrium
from ..equilibrium.solve import solve as statistical
from ..errors import InvalidValue, Mistake, Problem, RangeWarning, note_of
from ..explicit.ensemble import counterpart, seats_on, spacing_for, surface_of
from ..explicit.seats import GivenSeats
from ..explicit.solve import solve
from ..explicit.state import ExplicitState
from ..populations.measured.topography import Topography
from ..quantities.say import value_of
from .whole import Study

__all__ = ["POINTS", "OneSurface", "one_surface"]

POINTS = 128
"""Points along each side."""
FEWEST = 32
"""Points of the smallest window of a measured map."""
OF_THE_DRAW = ("tol", "max_iterations", "cap", "seed")
"""Keys of [explicit] that hold here too."""


@dataclass(frozen=True, eq=False, kw_only=True)
class OneSurface:
    """One small surface pressed, and the model beside it.

    Attributes
    ----------
    state : ExplicitState
        Under several loads, ascending.
    model : Equilibrium
        The statistical answer with the seat heights of these particles' rule.
    words : str
        What was pressed.
    warnings : tuple of str
    """

    state: ExplicitState
    model: Equilibrium
    words: str
    warnings: tuple[str, ...]


def one_surface(study: Study, F_star: object, *, points: int = POINTS) -> OneSurface:
    """Press one small surface of a study: a window of its measured map, or a synthetic one.

    Parameters
    ----------
    study : Study
        Its table [explicit], where there is one, says where particles lie and how fine the map is.
    F_star : float or array
        Loads F/(A_n E*) [1].
    points : int, optional
        Points along each side.

    Returns
    -------
    OneSurface

    Raises
    ------
    InvalidValue
        A surface that cannot be made or pressed.
    """
    contact = study.contact.replace(outputs=())
    options = dict(study.explicit or {})
    how = {name: options[name] for name in OF_THE_DRAW if name in options}
    seats = options.get("seats", "random")
    if isinstance(seats, GivenSeats):
        raise InvalidValue(
            "explicit.seats: positions belong to a whole map, not to a part of it",
            code=Mistake.BEYOND,
        )
    loads = np.unique(np.atleast_1d(np.asarray(F_star, dtype=float)))
    spacing: float | None = None
    surface: object
    if len(study.faces) == 1:
        surface, spacing, words = _window(study.faces[0], points)
    else:
        surface, words = _synthetic(contact, options, points, how.get("seed", 0))
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = solve(contact, surface, spacing=spacing, F_star=loads, seats=seats, **how)
        heights = seats_on(contact, surface, spacing=spacing, seats=seats, seed=how.get("seed", 0))
    about = [warning for warning in heard if issubclass(warning.category, RangeWarning)]
    notes = tuple(dict.fromkeys(note_of(warning.message) for warning in about))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        model = statistical(counterpart(contact, heights), F_star=loads)
    return OneSurface(state=state, model=model, words=words, warnings=notes)


def _synthetic(
    contact: Contact, options: dict[str, Any], points: int, seed: int
) -> tuple[Topography, str]:
    """A surface with the σ, R and α of the study; twice as many points where those are needed."""
    spacing = options.get("spacing") or spacing_for(contact)
    for size in (points, 2 * points):
        try:
            made = surface_of(contact, size=size, spacing=spacing, seed=seed)
        except InvalidValue:
            if size > points:
                raise
        else:
            break
    side = value_of(size * spacing, "m", 3)
    return made, (
        f"one synthetic surface with the σ, R and α of the study, {size} × {size} points, "
        f"{side} wide"
    )


def _window(face: Topography, points: int) -> tuple[np.ndarray, float, str]:
    """The part without gaps that is nearest the middle of a map [m], its spacing [m], in words."""
    problems = []
    if face.dim != 2:
        problems.append(
            Problem(
                "", f"{face.source} is a profile; a map of heights is needed", code=Mistake.KIND
            )
        )
    elif not math.isclose(*face.spacing, rel_tol=1e-6):
        problems.append(
            Problem(
                "",
                f"{face.source} has pixels that are not square; resample it",
                code=Mistake.BEYOND,
            )
        )
    if problems:
        raise InvalidValue(*problems)
    z = np.asarray(face.filtered(), dtype=float)
    side = min(points, *z.shape)
    side -= side % 2
    while side >= FEWEST:
        corner = _corner(np.isfinite(z), side)
        if corner is not None:
            i, j = corner
            wide = value_of(side * face.spacing[0], "m", 3)
            words = f"a window of {side} × {side} points of {face.source}, {wide} wide"
            if face.cutoff > 0:
                words += f", without waves below {value_of(face.cutoff, 'm')}"
            return z[i : i + side, j : j + side], face.spacing[0], words
        side = side // 2 - side // 2 % 2
    raise InvalidValue(
        f"{face.source} has no part of {FEWEST} x {FEWEST} points without missing data",
        code=Mistake.BEYOND,
    )


def _corner(measured: np.ndarray, side: int) -> tuple[int, int] | None:
    """Corner of the window nearest the middle in which all heights are known."""
    gaps = np.pad(np.cumsum(np.cumsum(~measured, axis=0), axis=1), ((1, 0), (1, 0)))
    inside = gaps[side:, side:] - gaps[:-side, side:] - gaps[side:, :-side] + gaps[:-side, :-side]
    free = np.argwhere(inside == 0)
    if not len(free):
        return None
    middle = (np.array(inside.shape) - 1) / 2
    i, j = free[np.argmin(np.sum((free - middle) ** 2, axis=1))].tolist()
    return i, j
