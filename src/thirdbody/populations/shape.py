r"""The shape of particles: round, or a rounded tip that passes into faces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from ..errors import InvalidValue, Mistake, Problem
from ..quantities.units import to_si
from ..quantities.value import Value, quantity

__all__ = ["SPHERE", "Angular", "Shape", "Sphere"]

CUTS = math.radians(45)
"""Angle of faces above which they are said to cut rather than to plough [rad]."""


class Shape(Value):
    """Base of the shapes of particles: `Sphere` or `Angular`."""

    __slots__ = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere(Shape):
    """Round particles.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.grains.Sphere() == tb.grains.Sphere()
    True
    """


SPHERE = Sphere()


@dataclass(frozen=True, slots=True, kw_only=True)
class Angular(Shape):
    r"""Angular particles: on each surface a rounded tip, then faces at one angle.

    .. math:: r = \tfrac12 R_w x, \qquad b = r\tan\beta

    Up to the contact radius b the tip touches, a sphere of radius r; beyond, the faces of a cone
    whose half angle is 90° − β. Sizes x are heights, as the gap sees them.

    Parameters
    ----------
    roundness : float
        Wadell's roundness R_w [1]: mean radius of the corners over that of the largest inscribed
        circle; 1 is a sphere's.
    angle : float or str
        Angle β between faces and surface [rad], or as ``"25 deg"``.
    flatness : float, optional
        Width over height φ = D/x [1], at least 1; the contact area ends at πD²/4.

    Notes
    -----
    There is no default angle: none was found for any dust. Aspect ratios are 1.4 to 1.6 for
    quartz and Saharan dust, as abstracts tell. Shapes that scatter are several populations.

    References
    ----------
    Derived. Roundness after Wadell, as dictionaries define it.

    Examples
    --------
    >>> import thirdbody as tb
    >>> grit = tb.grains.Angular(roundness=0.25, angle="35 deg")
    >>> round(grit.edge, 4), round(grit.tip_radius, 4)
    (0.0875, 0.125)
    """

    roundness: float = quantity("R_w", "1", "roundness of the corners", gt=0, le=1)
    angle: float = quantity(
        "β", "rad", "angle between faces and surface", gt=0, lt=math.pi / 2,
        hint="numbers are in radians, below π/2; degrees are written '25 deg'",
    )  # fmt: skip
    flatness: float = quantity("φ", "1", "width over height", default=1.0, ge=1)

    def __post_init__(self) -> None:
        if isinstance(self.angle, str):
            try:
                object.__setattr__(self, "angle", to_si(self.angle, "rad"))
            except InvalidValue as error:
                raise InvalidValue(
                    *(
                        Problem("angle", f"= {text}", owner="Angular", code=text.code)
                        for text in error.problems
                    )
                ) from None
        Value.__post_init__(self)

    @classmethod
    def from_spq(cls, spq: float, *, roundness: float, flatness: float = 1.0) -> Self:
        r"""From the spike parameter of an outline, :math:`\sin\beta = SPQ`.

        SPQ is the mean of cos(θ/2) over the spikes outside the circle of equal area, θ their
        angle (Hamblin and Stachowiak, from memory).

        Parameters
        ----------
        spq : float
            Between 0 and 1 [1].
        roundness, flatness : float
            As in the class.

        Examples
        --------
        >>> import thirdbody as tb
        >>> round(tb.grains.Angular.from_spq(0.5, roundness=0.2).angle, 6)  # 30°
        0.523599
        """
        if isinstance(spq, (bool, str)) or not hasattr(spq, "__float__") or not 0 < spq < 1:
            raise InvalidValue(
                f"spq = {spq!r} must be > 0 and < 1, a mean of cos(θ/2)", code=Mistake.RANGE
            )
        return cls(roundness=roundness, angle=math.asin(spq), flatness=flatness)

    @property
    def tip_radius(self) -> float:
        """Radius of the rounded tip over x [1]."""
        return 0.5 * self.roundness

    @property
    def edge(self) -> float:
        """Contact radius over x where the tip ends and the faces begin [1]."""
        return self.tip_radius * math.tan(self.angle)

    @property
    def has_touching_faces(self) -> bool:
        """The faces touch before the contact ends at πD²/4."""
        return self.edge < 0.5 * self.flatness * (1 - 1e-12)

    @property
    def round(self) -> bool:
        """The contact is that of a sphere up to its end."""
        return self.roundness == 1 and not self.has_touching_faces

    @property
    def breadth(self) -> float:
        """Area where the contact ends over πx²/4 [1]."""
        return self.flatness**2
