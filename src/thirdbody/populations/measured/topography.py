"""Measured surfaces, read from files of instruments or from heights at hand."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.carried import takes_units
from ...quantities.say import percent, value_of
from ...quantities.units import to_si
from .cutoff_curve import COLUMNS, Curve
from .instruments import MOST_POINTS, is_number, read
from .spectra import (
    SpectralMoments,
    Summits,
)
from .surface import Topography

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["COLUMNS", "Curve", "SpectralMoments", "Summits", "Topography", "from_topography"]

FORMS = ("none", "tilt", "curvature")
"""What is taken off the heights: their mean; a plane; a paraboloid."""
FEWEST_POINTS = {1: 64, 2: 16}
"""Points a profile, or each side of a map, must have."""


@takes_units
def from_topography(
    source: str | os.PathLike[str] | Any,
    *,
    cutoff: float | None = None,
    detrend: str | None = None,
    unit: str | None = None,
    spacing: float | Sequence[float] | None = None,
    periodic: bool | None = None,
    channel: int | str | None = None,
    resolution: float | None = None,
) -> Topography:
    """A measured surface or profile, from a file of an instrument or from heights at hand.

    Files are read by SurfaceTopography (the extra ``surfaces``), in all its formats: X3P, SUR, MI,
    OPD, OPDx, MetroPro, Gwyddion, Nanoscope, text, and some thirty more.

    Parameters
    ----------
    source : path-like, array or object
        A file; heights (Nx, Ny) or (N,) with ``spacing``, NaN or masked where missing; an object
        of SurfaceTopography or of surfalize; or "example", a small surface of the package.
    cutoff : float, optional
        Cut-off wavelength [m] of the answers; the recommended one by default, 0 as sampled.
    detrend : {"tilt", "curvature", "none"}
        Form to remove: the least-squares plane, paraboloid, or only the mean; the plane by
        default, only the mean of heights that repeat.
    unit : str, optional
        Unit of the heights, e.g. "nm", where the source does not tell it (m for arrays), and of
        the sides where ``spacing`` is not given.
    spacing : float or (float, float), optional
        Distance of neighbouring points [m] where the source does not tell it.
    periodic : bool, optional
        Whether the heights repeat beyond their edges; as the file says, else no.
    channel : int or str, optional
        Number or name of the channel of a file; its default heights otherwise.
    resolution : float, optional
        Shortest wave that the instrument tells apart [m], where the file does not tell it.

    Returns
    -------
    Topography

    Raises
    ------
    InvalidValue
        A file that cannot be read or has no unit, heights that are no surface, an option that has
        no meaning: one sentence each.

    Notes
    -----
    RMS height, gradient and curvature as sampled agree with SurfaceTopography's to 1e-12 where no
    point is missing. Where some are, a difference counts here as soon as its own points are known;
    SurfaceTopography leaves out those beside a gap too, so that the two average other points.

    References
    ----------
    SurfaceTopography: Röttger et al. 2022, Surf. Topogr.: Metrol. Prop. 10, 035032,
    doi:10.1088/2051-672X/ac860a. Filters: ISO 16610-61.

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> surface = tb.surfaces.from_topography("example")
    >>> rough = surface.roughness()
    >>> round(surface.cutoff * 1e6, 3), rough.alpha > 1.5
    (0.8, True)
    >>> x = np.arange(256) * 1e-7
    >>> wave = 1e-8 * np.sin(2 * np.pi * x / 6.4e-6)
    >>> moments = tb.surfaces.from_topography(wave, spacing=1e-7, detrend="none", cutoff=0).moments
    >>> round(moments.sigma * 1e9, 4)
    7.0711
    """
    scale, steps = _options(cutoff, detrend, unit, spacing, resolution)
    with np.errstate(over="ignore", invalid="ignore"):
        raw = read(source, scale, steps, channel)
    heights: Array = np.ma.filled(np.ma.asarray(raw.heights, dtype=float), np.nan)
    heights = np.where(np.isfinite(heights), heights, np.nan)
    _check(heights, raw.name)
    repeats = bool(raw.periodic) if periodic is None else periodic
    detrend = detrend or ("none" if repeats else "tilt")
    surface = Topography(
        heights=_without_form(heights, detrend),
        spacing=raw.spacing,
        source=raw.name,
        periodic=repeats,
        limit=raw.limit,
        limit_reason=raw.limit_reason or "not known: the file does not state it",
        notes=raw.notes,
    )
    if resolution is not None:
        surface = replace(surface, limit=float(resolution), limit_reason="the resolution given")
    _check_size(surface, detrend)
    if cutoff is not None:
        surface = replace(surface, given_cutoff=surface._cutoff(cutoff))
    return surface


def _options(
    cutoff: Any, detrend: object, unit: str | None, spacing: object, resolution: Any
) -> tuple[float | None, tuple[float, ...] | None]:
    """The unit [m] and the spacing [m] given, or None, when every option has a meaning."""
    problems: list[str] = []
    if detrend is not None and detrend not in FORMS:
        problems.append(
            Problem(
                "detrend", f"must be one of {', '.join(FORMS)}", repr(detrend), code=Mistake.OPTION
            )
        )
    for name, value in (("cutoff", cutoff), ("resolution", resolution)):
        lowest = "at least 0" if name == "cutoff" else "above 0"
        if value is not None and not (
            is_number(value) and (value > 0 or (value == 0 and name == "cutoff"))
        ):
            problems.append(
                Problem(
                    name, f"must be a finite length {lowest} [m]", repr(value), code=Mistake.RANGE
                )
            )
    steps = None
    if spacing is not None:
        lengths = spacing if isinstance(spacing, (tuple, list)) else (spacing,)
        if len(lengths) in (1, 2) and all(is_number(d) and d > 0 for d in lengths):
            steps = tuple(float(d) for d in lengths)
        else:
            problems.append(
                Problem(
                    "spacing",
                    "must be one length above 0 [m], or two of them",
                    repr(spacing),
                    code=Mistake.RANGE,
                )
            )
    scale = None
    if unit is not None:
        try:
            scale = to_si(f"1 {unit}", "m")
        except InvalidValue as error:
            problems += [
                Problem("unit", f": {problem}", code=problem.code) for problem in error.problems
            ]
    if problems:
        raise InvalidValue(*problems)
    return scale, steps


def _check_size(surface: Topography, detrend: str) -> None:
    """Refuse what is flat, or higher than wide."""
    if not surface.rms_height > 1e-15:
        raise InvalidValue(
            f"{surface.source} is flat: without its form (detrend = {detrend!r}) nothing is left",
            code=Mistake.BEYOND,
        )
    if surface.rms_height > max(surface.size):
        raise InvalidValue(
            f"{surface.source}: an RMS height of {value_of(surface.rms_height, 'm')} on a side of "
            f"{value_of(max(surface.size), 'm')} is no surface; check the units of heights and "
            "sides",
            code=Mistake.BEYOND,
        )


def _check(heights: Array, name: str) -> None:
    if heights.ndim not in (1, 2):
        raise InvalidValue(
            f"{name} has {heights.ndim} axes; a map has two and a profile one", code=Mistake.SHAPE
        )
    least = FEWEST_POINTS[heights.ndim]
    shown = " x ".join(map(str, heights.shape))
    if min(heights.shape) < least:
        raise InvalidValue(
            f"{name} has {shown} points; moments take at least {least}"
            + (" along each side" if heights.ndim == 2 else ""),
            code=Mistake.BEYOND,
        )
    if heights.size > MOST_POINTS:
        raise InvalidValue(
            f"{name} has {shown} points, more than the {MOST_POINTS:,} that fit",
            code=Mistake.TOO_LARGE,
        )
    measured_share = np.isfinite(heights).mean()
    if measured_share < 0.5:
        raise InvalidValue(
            f"{name} has no datum at {percent(1 - measured_share, digits=2)} of its points; "
            "cut out a part that was measured",
            code=Mistake.BEYOND,
        )


def _without_form(h: Array, detrend: str) -> Array:
    """Heights less their mean, least-squares plane or paraboloid."""
    axes = np.meshgrid(*(np.linspace(-1, 1, n) for n in h.shape), indexing="ij", sparse=True)
    terms: list[Array] = [np.ones((1,) * h.ndim)]
    if detrend != "none":
        terms += axes
    if detrend == "curvature":
        terms += [axes[i] * axes[j] for i in range(h.ndim) for j in range(i, h.ndim)]
    has_datum = np.isfinite(h)
    middle = np.nanmean(h)
    z = np.where(has_datum, h - middle, 0.0)
    basis = [np.broadcast_to(term, h.shape) for term in terms]
    gram = np.array([[np.sum(a * b, where=has_datum) for b in basis] for a in basis])
    right = np.array([np.sum(a * z, where=has_datum) for a in basis])
    weights = np.linalg.lstsq(gram, right, rcond=None)[0]
    form = sum(w * term for w, term in zip(weights, terms, strict=True))
    return np.where(has_datum, z - form, np.nan)
