"""Stribeck curves, and the speeds between their regimes."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ..contact.contact import Contact
from ..contact.interface import interface
from ..errors import RangeWarning, tell_of_range
from ..quantities.carried import takes_units
from ..quantities.record import Column
from .film_formulas import AbstractFilm, Line, Oil, Point
from .mixed_film import (
    COLUMNS,
    FEW,
    MOST,
    MixedFilm,
    _loads_and_speeds,
    check_lubricated,
    mean_gap,
    mixed_film,
    zeros_of_falling,
)

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["RegimeSpeeds", "regime_speeds", "stribeck", "stribeck_columns"]


@takes_units
def stribeck(
    contact: Contact,
    *,
    conjunction: Point | Line,
    oil: Oil,
    load: float,
    speed: ArrayLike,
    **options: object,
) -> xarray.Dataset:
    r"""The Stribeck curve: traction and load shares over entrainment speed.

    .. math:: \mu(u) = \mu_f + \mu_{ss} + \mu_{sa}

    Parameters
    ----------
    contact, conjunction, oil, options
        As in `mixed_film`.
    load : float
        w [N].
    speed : array (N,)
        Mean entrainment speeds u [m/s].

    Returns
    -------
    xarray.Dataset
        Every column of `MixedFilm` over ``speed``, each with ``symbol``, ``units`` and
        ``long_name``, and ``status_code``; the Hersey number ηu/w' of the speeds is the coordinate
        ``hersey`` (ηuR/w for points) [1].

    Raises
    ------
    InvalidValue, NoEquilibrium
        As `mixed_film`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> import warnings; warnings.simplefilter("ignore")
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> curve = tb.films.stribeck(
    ...     contact,
    ...     conjunction=tb.films.Point(R=9.5e-3),
    ...     oil=tb.films.Oil(eta=0.02, alpha=2e-8),
    ...     load=20.0,
    ...     speed=[0.1, 1.0, 10.0],
    ... )
    >>> curve.film_share.round(2).values.tolist(), curve.h_T.attrs["units"]
    ([0.06, 0.87, 1.0], 'm')
    """
    import xarray as xr

    columns, messages = stribeck_columns(
        contact, conjunction=conjunction, oil=oil, load=load, speed=speed, **options
    )

    data = {name: ("speed", v, OF_CURVE[name].attributes) for name, v in columns.items()}
    coords = {name: data.pop(name) for name in ("speed", "hersey")}
    attrs = {"load": float(load), "warnings": "\n".join(messages)}
    return xr.Dataset(data, coords=coords, attrs=attrs)


OF_CURVE = {**COLUMNS, **MixedFilm.more_columns, "hersey": Column("ηu/w", "1", "Hersey number")}
"""What the columns of the curve are."""


def stribeck_columns(
    contact: Contact,
    *,
    conjunction: Point | Line,
    oil: Oil,
    load: float,
    speed: ArrayLike,
    **options: Any,
) -> tuple[dict[str, NDArray[Any]], tuple[str, ...]]:
    """The columns of `stribeck`, speed and Hersey number first, and its warnings: no xarray."""
    speeds = np.atleast_1d(np.asarray(speed, dtype=float))
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = mixed_film(
            contact, conjunction=conjunction, oil=oil, load=load, speed=speeds, **options
        )
    for warning in heard:
        tell_of_range(warning.message, warning.category)

    hersey = oil.eta * speeds / conjunction.intensity(float(load))
    if conjunction.shape == "point":
        hersey = hersey * conjunction.R
    columns = {k: v for k, v in state.columns().items() if k not in ("speed", "load")}
    return {"speed": speeds, "hersey": hersey} | columns, state.warnings


# ------------------------------------------------------------------ where regimes change
class RegimeSpeeds(NamedTuple):
    """Entrainment speeds [m/s] at which the regime changes; None where it never does.

    Examples
    --------
    >>> RegimeSpeeds(boundary=0.02, full=3.0).full
    3.0
    """

    boundary: float | None
    """Up to which lubrication is boundary [m/s]"""
    full: float | None
    """From which the film is full [m/s]"""


SLOWEST, FASTEST = 1e-12, 1e12
"""Speeds among which those of `regime_speeds` are sought [m/s]."""


@takes_units
def regime_speeds(
    contact: Contact,
    *,
    conjunction: Point | Line,
    oil: Oil,
    load: float,
    film: AbstractFilm | None = None,
    hertz: Literal["mean", "maximum"] = "mean",
    few: float = FEW,
    most: float = MOST,
) -> RegimeSpeeds:
    r"""Speeds at which boundary lubrication ends and the full film begins.

    The share s of the solids says both the gap and γ, and these say the speed:

    .. math:: p_{ss}(h) + p_{sa}(h) = s\,\bar p, \qquad \gamma = \frac{1}{1 - s}, \qquad
              h_c(w/\gamma,\ E'/\gamma,\ u) = h_T(h)

    Parameters
    ----------
    contact, conjunction, oil, film, hertz
        As in `mixed_film`.
    load : float
        w [N].
    few, most : float, optional
        Shares s [1] of the solids below which the film is full, and above which it is boundary.

    Returns
    -------
    RegimeSpeeds
        None where solids never carry that share, and for the shares 0 and 1.

    Raises
    ------
    InvalidValue
        As `mixed_film`.

    Notes
    -----
    `mixed_film` at these speeds has the shares to 1e-9. Where solids carry more at some larger
    gap, the change may happen more than once; one of the speeds is given.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> given = dict(conjunction=tb.films.Point(R=9.5e-3), load=20.0,
    ...              oil=tb.films.Oil(eta=0.02, alpha=2e-8))
    >>> found = regime_speeds(contact, **given)
    >>> import warnings; warnings.simplefilter("ignore")
    >>> round(mixed_film(contact, speed=found.full, **given).solid_share, 9)
    0.01
    """
    w, _, _ = _loads_and_speeds(load, 1.0)
    bodies = check_lubricated(contact, conjunction, oil, w, film, None, hertz, (few, most))
    solids, floor, sigma = interface(contact), bodies.floor, contact.roughness.sigma

    def share_at(t: Array) -> Array:
        """Share of the solids at a separation d = floor + σe^t."""
        return solids.load(floor + sigma * np.exp(t))[:, 0] / bodies.p

    shares = np.array([most, few])
    exists = (shares > 0) & (shares < 1) & (share_at(np.full(2, -40.0)) > shares)
    # beyond e^40 sigma there is no contact
    t = zeros_of_falling(lambda t: share_at(t) - shares, np.full(2, -40.0), np.full(2, 40.0))
    gap = mean_gap(floor + sigma * np.exp(t) + solids.mean_plane, sigma=sigma)
    gamma = 1 / (1 - np.where(exists, shares, 0.5))
    ends = np.log([[SLOWEST] * 2, [FASTEST] * 2])

    def short(v: Array) -> Array:
        return gap / bodies.thickness(np.exp(v), gamma) - 1

    exists &= (short(ends[0]) > 0) & (short(ends[1]) < 0)
    speeds = np.exp(zeros_of_falling(short, *ends))
    return RegimeSpeeds(*(float(u) if yes else None for u, yes in zip(speeds, exists, strict=True)))
