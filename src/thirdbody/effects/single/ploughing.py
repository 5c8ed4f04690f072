r"""A sphere that ploughs: the groove it cuts, what that resists, and what stays behind.

A sphere of radius r that sits δ deep touches the flat up to the angle θ from its lowest point,

.. math:: \cos\theta = 1-\delta/r .

In sliding, the front half of the contact carries the pressure p and the rear half κ p. Load and
resistance are those pressures times the areas they are seen on: half the contact from above, the
cross-section A_g of the groove from the front.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...quantities.arguments import need_one
from ...quantities.carried import takes_units

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...laws.spots import ParticleSpots

    Array = NDArray[np.float64]

__all__ = [
    "coefficient",
    "coefficient_of_faces",
    "groove_area",
    "groove_area_of_faces",
    "groove_of",
    "rear_support",
    "residual_depth",
]

SMALL = 0.04
"""Depth over radius below which θ − sin θ cos θ is summed as a series: it would lose digits."""


def _relative(depth: ArrayLike, radius: ArrayLike, largest: float) -> Array:
    """w = δ/r between 0 and an upper bound."""
    return np.minimum(np.maximum(np.asarray(depth, dtype=float) / radius, 0.0), largest)


def _segment(w: Array) -> Array:
    """θ − sin θ cos θ for cos θ = 1 − w."""
    theta = 2 * np.arcsin(np.sqrt(0.5 * w))
    out = np.asarray(theta - (1 - w) * np.sqrt(w * (2 - w)))
    small = w < SMALL
    if np.any(small):
        # (u − sin u)/2 with u = 2θ
        square = (2 * theta[small]) ** 2
        series = np.ones_like(square)
        for n in (15, 13, 11, 9, 7, 5):
            series = 1 - square / (n * (n - 1)) * series
        out[small] = 2 / 3 * theta[small] ** 3 * series
    return out


@takes_units
def groove_area(depth: ArrayLike, *, radius: ArrayLike) -> Array:
    r"""Cross-section of the groove that a sphere leaves.

    .. math:: A_g = r^2(\theta-\sin\theta\cos\theta) \approx \tfrac43 b\,\delta

    Parameters
    ----------
    depth : array_like
        Depth δ [m]; nothing below zero, the whole circle beyond 2 r.
    radius : array_like
        Radius r [m].

    Returns
    -------
    array
        A_g [m²].

    Notes
    -----
    Segment of a circle, to 4e-14 relative.

    Examples
    --------
    >>> from thirdbody.effects.single.ploughing import groove_area
    >>> round(float(groove_area(0.5, radius=1.0)), 12)
    0.614184849304
    """
    return np.square(radius) * _segment(_relative(depth, radius, 2.0))


@takes_units
def coefficient(depth: ArrayLike, *, radius: ArrayLike, rear: ArrayLike = 0.0) -> Array:
    r"""Ploughing force of a sphere over its load.

    .. math:: \mu_p = \frac{2(\theta-\sin\theta\cos\theta)}{\pi\sin^2\theta}\,
              \frac{1-\kappa}{1+\kappa} \approx \frac{4}{3\pi}\frac{b}{r}\,\frac{1-\kappa}{1+\kappa}

    It ends at δ = r, where the contact is the great circle and μ_p is 1 for κ = 0; deeper counts
    as that.

    Parameters
    ----------
    depth : array_like
        Depth δ [m]; zero gives zero.
    radius : array_like
        Radius r [m].
    rear : array_like, optional
        Support κ of the rear half [1]: 0 none (rigid-plastic), 1 all (elastic).

    Returns
    -------
    array
        μ_p [1].

    Notes
    -----
    Derived from uniform pressure on both halves. κ = 0 is the formula of Bowden and Tabor, also
    of Goddard and Wilman, (2/π)[(r/b)² asin(b/r) − √((r/b)²−1)]. The shear traction on the
    inclined surface is left out of the load, an error of order θ² τ/H.

    References
    ----------
    Goddard, Wilman 1962, Wear 5, 114, doi:10.1016/0043-1648(62)90235-1 (κ = 0; recalled).

    Examples
    --------
    >>> from thirdbody.effects.single.ploughing import coefficient
    >>> print(coefficient([1e-4, 1.0], radius=1.0).round(6))
    [0.006002 1.      ]
    """
    w = _relative(depth, radius, 1.0)
    sine_squared = w * (2 - w)
    front = np.divide(_segment(w), sine_squared, out=np.zeros_like(w), where=w > 0)
    kappa = np.asarray(rear)
    return 2 / np.pi * front * (1 - kappa) / (1 + kappa)


@takes_units
def groove_area_of_faces(a: ArrayLike, *, edge: ArrayLike, angle: float) -> Array:
    r"""Cross-section of the groove that a rounded cone leaves.

    .. math:: A_g = \tan\beta\,(a^2-b^2/3)\quad(a\ge b), \qquad
              A_g = \tfrac23\tan\beta\,a^3/b\quad(a\le b)

    Parameters
    ----------
    a : array_like
        Contact radius [m].
    edge : array_like
        Contact radius b where the rounded tip ends and the faces begin [m].
    angle : float
        β between the faces and the surface [rad].

    Returns
    -------
    array
        A_g [m²].

    Notes
    -----
    Derived, the tip as a paraboloid.

    Examples
    --------
    >>> round(float(groove_area_of_faces(3.0, edge=3.0, angle=np.pi / 4)), 12)
    6.0
    """
    a, edge = np.asarray(a, dtype=float), np.asarray(edge, dtype=float)
    return np.tan(angle) * np.where(a > edge, a**2 - edge**2 / 3, 2 / 3 * a**3 / edge)


@takes_units
def coefficient_of_faces(
    a: ArrayLike, *, edge: ArrayLike, angle: float, rear: ArrayLike = 0.0
) -> Array:
    r"""Ploughing force of a rounded cone over its load.

    .. math:: \mu_p = \frac2\pi\tan\beta\left[1-\frac{b^2}{3a^2}\right]
              \frac{1-\kappa}{1+\kappa}\quad(a\ge b), \qquad
              \mu_p = \frac4{3\pi}\frac ab\tan\beta\,\frac{1-\kappa}{1+\kappa}\quad(a\le b)

    Parameters
    ----------
    a, edge, angle
        As in `groove_area_of_faces`.
    rear : array_like, optional
        Support κ of the rear half [1].

    Returns
    -------
    array
        μ_p [1].

    Notes
    -----
    Derived as `coefficient`; of a sharp cone it is (2/π) tan β, in textbooks (2/π) cot θ. Faces
    above 45° cut rather than plough.

    Examples
    --------
    >>> print(coefficient_of_faces([0.1, 10.0], edge=0.1, angle=0.5).round(6))
    [0.231858 0.347775]
    """
    a = np.asarray(a, dtype=float)
    groove = groove_area_of_faces(a, edge=edge, angle=angle)
    front = np.divide(groove, a**2, out=np.zeros_like(groove), where=a > 0)
    kappa = np.asarray(rear)
    return 2 / np.pi * front * (1 - kappa) / (1 + kappa)


@takes_units
def groove_of(spots: ParticleSpots, *, side: int) -> Array:
    """Cross-section of the groove of each particle in surface 1 (side 0) or 2 [m²]: (M, n)."""
    need_one("side", side, 0, 1)
    shape = spots.shape
    if shape is None or shape.round:
        return groove_area(spots.sinks[side], radius=spots.impression_radius(side))
    a = np.sqrt(spots.areas[side] / np.pi)
    return groove_area_of_faces(a, edge=shape.edge * spots.x, angle=shape.angle)


@takes_units
def rear_support(depth_over_yield: ArrayLike) -> Array:
    r"""Support κ of the rear half of a contact by what recovers of its depth.

    .. math:: \kappa = 1-\delta_{res}/\delta

    Parameters
    ----------
    depth_over_yield : array_like
        Depth over that of first yield s = δ/δ_1 [1].

    Returns
    -------
    array
        κ [1]: 1 up to yield, towards 0 far beyond.

    Notes
    -----
    See `residual_depth`; that the rear pressure falls in the same proportion is an assumption.

    Examples
    --------
    >>> from thirdbody.effects.single.ploughing import rear_support
    >>> round(float(rear_support(54.0)), 4)
    0.3702
    """
    s = np.maximum(np.asarray(depth_over_yield, dtype=float), 1.0)
    one, two = s**-0.28, s**-0.69
    return one + two - one * two


@takes_units
def residual_depth(depth: ArrayLike, *, depth_over_yield: ArrayLike) -> Array:
    r"""Depth left after unloading.

    .. math:: \delta_{res} = \delta\,(1-s^{-0.28})(1-s^{-0.69})

    Parameters
    ----------
    depth : array_like
        Largest depth δ [m].
    depth_over_yield : array_like
        s = δ/δ_1 [1]; up to 1 everything recovers.

    Returns
    -------
    array
        δ_res [m].

    Notes
    -----
    Fit to finite elements of a sphere pressed by a rigid flat up to s = 170; here it is also used
    for the indent that a hard sphere leaves, an assumption. Constants from memory: not confirmed
    in a source.

    References
    ----------
    Etsion, Kligerman, Kadin 2005, Int. J. Solids Struct. 42, 3716,
    doi:10.1016/j.ijsolstr.2004.12.006.

    Examples
    --------
    >>> from thirdbody.effects.single.ploughing import residual_depth
    >>> round(float(residual_depth(10.0, depth_over_yield=10.0)), 9)
    3.781706758
    """
    s = np.maximum(np.asarray(depth_over_yield, dtype=float), 1.0)
    return np.asarray(depth) * (1 - s**-0.28) * (1 - s**-0.69)
