"""Where an oil film is: two bodies that roll, and the oil between them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

import numpy as np

from ..quantities.value import Value, choice, quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["GLASS", "Hertz", "Line", "Oil", "Point"]

GLASS = 1e12
"""Viscosity at which an oil counts as a glass: no formula of an oil goes beyond [Pa s]."""


class Hertz(NamedTuple):
    r"""The dry smooth contact under the same load: numbers, or arrays (N,) for several loads.

    .. math:: \bar p = w/A, \qquad p_0 = \tfrac32\bar p\ \text{(point)}, \quad
              p_0 = \tfrac4\pi\bar p\ \text{(line)}

    Attributes
    ----------
    area : float or array (N,)
        Area of contact A [m²].
    mean : float or array (N,)
        Mean pressure [Pa].
    maximum : float or array (N,)
        Largest pressure p_0 [Pa].

    Examples
    --------
    >>> import thirdbody as tb
    >>> hertz = tb.films.Point(R=9.5e-3).hertz(20.0, E=223.8e9)
    >>> round(hertz.area * hertz.mean, 9), round(hertz.maximum / hertz.mean, 9)
    (20.0, 1.5)
    """

    area: Number
    mean: Number
    maximum: Number


@dataclass(frozen=True, slots=True, kw_only=True)
class Point(Value):
    r"""A point contact: a ball, or a crowned roller, on a flat.

    .. math:: \bar p = \frac{w}{\pi a^2}, \quad a^3 = \frac{3wR}{2E'}, \quad p_0 = \tfrac32\bar p

    Parameters
    ----------
    R : float
        Reduced radius of curvature along the motion R_x [m].
    R_y : float, optional
        Reduced radius across the motion [m], R unless given. The ellipse of contact is exact.

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.films.Point(R=9.5e-3).hertz(20.0, E=223.8e9).mean) / 1e6)
    542
    """

    shape: ClassVar[str] = "point"
    R: float = quantity("R_x", "m", "reduced radius along the motion", gt=0, usual=1.0)
    R_y: float | None = quantity(
        "R_y", "m", "reduced radius across the motion", default=None, gt=0, usual=1.0
    )

    @property
    def ratio(self) -> float:
        """R_x/R_y [1]."""
        return 1.0 if self.R_y is None else self.R / self.R_y

    def hertz(self, load: Number, *, E: Number) -> Hertz:
        """Area and pressures of the dry contact under a load [N], E = E' [Pa].

        Parameters
        ----------
        load : float or array
            w [N].
        E : float or array
            E' = 2E* [Pa].
        """
        from ..reference import elliptic_hertz

        shape = elliptic_hertz(max(self.ratio, 1 / self.ratio))
        R_g = self.R / math.sqrt(self.ratio)
        area = math.pi * shape.R_A * R_g * self.approach(load, E=E)
        return Hertz(area, load / area, 1.5 * load / area)

    def approach(self, load: Number, *, E: Number) -> Number:
        """How much nearer distant points of the bodies come under a load [m].

        Parameters
        ----------
        load : float or array
            w [N].
        E : float or array
            E' = 2E* [Pa].
        """
        from ..reference import elliptic_hertz

        shape = elliptic_hertz(max(self.ratio, 1 / self.ratio))
        R_g = self.R / math.sqrt(self.ratio)
        return (1.5 * load / (E * shape.root_R_F * math.sqrt(R_g))) ** (2 / 3)

    def semi_axes(self, load: Number, *, E: Number) -> tuple[Any, Any]:
        """Half the ellipse along the motion, and across it [m].

        Parameters
        ----------
        load : float or array
            w [N].
        E : float or array
            E' = 2E* [Pa].
        """
        from ..reference import elliptic_hertz

        k = elliptic_hertz(max(self.ratio, 1 / self.ratio)).k
        larger = np.sqrt(self.hertz(load, E=E).area / (math.pi * k))
        return (k * larger, larger) if self.ratio <= 1 else (larger, k * larger)

    def intensity(self, load: Number) -> Number:
        """The load that film formulas take [N].

        Parameters
        ----------
        load : float or array
            w [N].
        """
        return load


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(Value):
    r"""A line contact: a cylindrical roller, a gear tooth.

    .. math:: b^2 = \frac{8w'R}{\pi E'}, \quad \bar p = \frac{w'}{2b}, \quad p_0 = \frac4\pi\bar p

    Parameters
    ----------
    R : float
        Reduced radius of curvature [m].
    length : float
        Length of the contact [m].

    Examples
    --------
    >>> import thirdbody as tb
    >>> round(float(tb.films.Line(R=0.01, length=0.02).hertz(2000.0, E=226e9).maximum) / 1e6)
    600
    """

    shape: ClassVar[str] = "line"
    R: float = quantity("R", "m", "reduced radius", gt=0, usual=1.0)
    length: float = quantity("l", "m", "length of the contact", gt=0, usual=1.0)

    @property
    def ratio(self) -> float:
        """R_x/R_y [1]."""
        return 0.0

    def hertz(self, load: Number, *, E: Number) -> Hertz:
        """Area and pressures of the dry contact under a load [N], E = E' [Pa].

        Parameters
        ----------
        load : float or array
            w [N].
        E : float or array
            E' = 2E* [Pa].
        """
        b = np.sqrt(8 * self.intensity(load) * self.R / (math.pi * E))
        area = 2 * b * self.length
        return Hertz(area, load / area, 4 / math.pi * load / area)

    def semi_axes(self, load: Number, *, E: Number) -> tuple[Any, Any]:
        """Half the line along the motion, and across it [m].

        Parameters
        ----------
        load : float or array
            w [N].
        E : float or array
            E' = 2E* [Pa].
        """
        b = self.hertz(load, E=E).area / (2 * self.length)
        return b, np.full_like(b, 0.5 * self.length)

    def intensity(self, load: Number) -> Number:
        """The load that film formulas take, per length [N/m].

        Parameters
        ----------
        load : float or array
            w [N].
        """
        return load / self.length


@dataclass(frozen=True, slots=True, kw_only=True)
class Oil(Value):
    r"""An oil, its viscosity under pressure, and the stress at which it shears.

    .. math::

        \text{Roelands:}\quad \ln\frac{\eta(p)}{\eta} = (\ln\eta + 9.67)
        \left[\left(1 + \frac{p}{p_r}\right)^z - 1\right], \quad
        z = \frac{\alpha p_r}{\ln\eta + 9.67}

        \text{Barus:}\quad \eta(p) = \eta\,e^{\alpha p}, \qquad
        \tau = \min\!\left(\tau_E\,\operatorname{asinh}\frac{\eta(p)\,\dot\gamma}{\tau_E},\
        \tau_L\right)

    with p_r = 1.96·10⁸ Pa. From 10¹² Pa s on an oil is a glass: η(p) stays there.

    Parameters
    ----------
    eta : float
        Viscosity of the inlet η [Pa s].
    alpha : float
        Pressure–viscosity coefficient α [1/Pa].
    eyring_stress : float, optional
        τ_E [Pa]. Nobody can predict it: without it the film has no traction.
    limiting_stress : float, optional
        τ_L [Pa], no limit unless given.
    viscosity : {"roelands", "barus"}, optional
        Viscosity under pressure. The film formulas take η and α only.

    References
    ----------
    Roelands 1966, thesis, TU Delft; Eyring 1936, J. Chem. Phys. 4, 283, doi:10.1063/1.1749836.

    Examples
    --------
    >>> import thirdbody as tb
    >>> oil = tb.films.Oil(eta=0.04, alpha=2e-8, eyring_stress=5e6)
    >>> barus = oil.replace(viscosity="barus")
    >>> float(oil.at_pressure(0.0)), bool(oil.at_pressure(1e9) < barus.at_pressure(1e9))
    (0.04, True)
    """

    eta: float = quantity("η", "Pa s", "viscosity", gt=1e-4, lt=1e5, hint="40 mPa s are 0.04")
    alpha: float = quantity(
        "α", "1/Pa", "pressure-viscosity coefficient", ge=0, lt=1e-6, hint="20 1/GPa are 20e-9"
    )
    eyring_stress: float | None = quantity("τ_E", "Pa", "Eyring stress", default=None, gt=0)
    limiting_stress: float | None = quantity("τ_L", "Pa", "limiting stress", default=None, gt=0)
    viscosity: Literal["roelands", "barus"] = choice("viscosity under pressure", default="roelands")

    def at_pressure(self, pressure: Number) -> Number:
        """Viscosity under a pressure [Pa s].

        Parameters
        ----------
        pressure : float or array (N,)
            p [Pa].
        """
        p = np.asarray(pressure, float)
        if self.viscosity == "barus":
            log_ratio = self.alpha * p
        else:
            span = math.log(self.eta) + 9.67
            z = self.alpha * 1.96e8 / span
            log_ratio = span * ((1 + p / 1.96e8) ** z - 1)
        return self.eta * np.exp(np.minimum(log_ratio, math.log(GLASS / self.eta)))

    def shear_stress(self, rate: Number, *, pressure: Number) -> Number:
        """Shear stress of the film [Pa]; NaN without an Eyring stress.

        Parameters
        ----------
        rate : float or array (N,)
            Shear rate [1/s].
        pressure : float or array (N,)
            p [Pa].
        """
        if self.eyring_stress is None:
            return np.full(np.broadcast_shapes(np.shape(rate), np.shape(pressure)), np.nan)
        stress = self.eyring_stress * np.arcsinh(
            self.at_pressure(pressure) * rate / self.eyring_stress
        )
        return stress if self.limiting_stress is None else np.minimum(stress, self.limiting_stress)
