"""A film under its operating conditions, and what it drags in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import numpy as np

from ..contact.contact import Contact
from ..errors import Mistake, Problem, WrongKind
from ..populations.distributions import Distribution
from ..quantities.nearest import guess
from ..quantities.value import Value, choice, quantity
from .film_formulas import AbstractFilm, Line, Oil, Point
from .mixed_film import FEW, MOST, MixedFilm, mixed_film
from .stribeck import RegimeSpeeds, regime_speeds, stribeck, stribeck_columns

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Entrainment", "FilmConditions"]


def __dir__() -> list[str]:
    return sorted(__all__)


# ------------------------------------------------------------------ what enters with the oil
@dataclass(frozen=True, slots=True, kw_only=True)
class Entrainment(Value):
    r"""Particles that an oil carries into the contact.

    .. math::

        n_v = \frac{6c}{\pi\langle x^3\rangle}, \qquad
        \eta_a = \varepsilon\,n_v\,\langle h_{entry}\rangle, \qquad
        x \le h + 2\mu^2 R'

    A particle larger than the film is caught where the wedge between the bodies is flatter than
    the angle of friction, and dragged in; one smaller passes with the oil, unloaded unless
    roughness bridges the rest of the gap.

    Parameters
    ----------
    concentration : float
        Volume of particles per volume of oil c [1].
    entry_ratio : float
        Particles that enter over those in the oil swept in, ε [1]. Nobody can predict it.
    friction : float
        Friction coefficient μ of a particle on the surfaces [1], required.
    height : {"size", "film"}, optional
        Layer of oil that brings particles of size x: max(h, x), or h.

    Notes
    -----
    Each size counts as its own spherical solid, and all of c as particles of the given
    distribution. The bound on x is for small angles.

    References
    ----------
    Dwyer-Joyce, Predicting the abrasive wear of ball bearings by lubricant debris, Wear 1999, has
    the count as oil volume times an entry ratio (abstract); the bound on x is derived here.

    Examples
    --------
    >>> from thirdbody.systems.film_conditions import Entrainment
    >>> dirt = Entrainment(concentration=1e-5, entry_ratio=1.0, friction=0.1)
    >>> round(float(dirt.largest(0.3e-6, R=9.5e-3)) * 1e6)
    190
    """

    concentration: float = quantity("c", "1", "volume of particles per volume of oil", gt=0, lt=0.6)
    entry_ratio: float = quantity("ε", "1", "entry ratio", gt=0)
    friction: float = quantity("μ", "1", "friction of a particle", ge=0, le=2)
    height: Literal["size", "film"] = choice("layer of oil that brings particles", default="size")

    def per_volume(self, diameter: Distribution) -> float:
        """Particles per volume of oil n_v [1/m³]."""
        return 6 * self.concentration / (math.pi * diameter.moment(3))

    def largest(self, h: ArrayLike, *, R: float) -> Array:
        """Largest diameter [m] dragged into a film h [m] between bodies of radius R' [m]."""
        return np.asarray(h, float) + 2 * self.friction**2 * R

    def passes(self, diameter: Distribution, *, h: ArrayLike) -> Array:
        """Share of the particles smaller than the film h [m], by number [1].

        Parameters
        ----------
        diameter : Distribution
        h : float or array (N,)
            Film thickness [m].
        """
        return np.asarray(diameter.partial_moment(0, 0.0, np.asarray(h, float)))

    def areal_density(self, diameter: Distribution, *, h: float, R: float) -> float:
        """Particles that enter per nominal area η_a [1/m²].

        Parameters
        ----------
        diameter : Distribution
        h : float
            Film thickness [m].
        R : float
            Reduced radius of the bodies R' [m].
        """
        reach = float(self.largest(h, R=R))
        if self.height == "film":
            entered = h * float(diameter.partial_moment(0, 0.0, reach))
        else:
            entered = h * float(diameter.partial_moment(0, 0.0, h))
            entered += float(diameter.partial_moment(1, h, reach))
        return self.entry_ratio * self.per_volume(diameter) * entered


# ------------------------------------------------------------------ all that is given at once
@dataclass(frozen=True, slots=True, kw_only=True)
class FilmConditions(Value):
    r"""What a lubricated contact is run with: bodies, oil, load and speeds.

    .. math:: w, \quad u = \tfrac12(u_1 + u_2), \quad u_s/u, \quad \eta, \alpha, \tau_E

    The table [film] of a study file; `mixed_film` and `stribeck` take the same as arguments.

    Parameters
    ----------
    conjunction : films.Point or films.Line
        The bodies.
    oil : films.Oil
    load : float
        w [N].
    speed : tuple of float
        Mean entrainment speeds u [m/s].
    slide_roll : float, optional
        Sliding over entrainment speed u_s/u [1]; without it there is no traction.
    formula : films.AbstractFilm, optional
        Film formula, that of every regime by default.
    hertz : {"mean", "maximum"}, optional
        Which Hertz pressure is nominal.
    few, most : float, optional
        Shares of the solids below which the film is full, and above which it is boundary [1].
    entrainment : Entrainment, optional
        What the oil carries.

    Raises
    ------
    InvalidValue
        A value outside its range, no speed, a formula for another shape.

    Examples
    --------
    >>> import warnings; warnings.simplefilter("ignore")
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> run = FilmConditions(conjunction=tb.films.Point(R=9.5e-3), load=20.0, speed=(0.02, 0.5),
    ...                      oil=tb.films.Oil(eta=0.02, alpha=2e-8))
    >>> run.stribeck(contact).regime.values.tolist()
    ['boundary', 'mixed']
    >>> FilmConditions.from_dict(run.to_dict()) == run
    True
    """

    conjunction: Point | Line
    oil: Oil
    load: float = quantity("w", "N", "normal load", gt=0)
    speed: tuple[float, ...]
    slide_roll: float | None = quantity(
        "u_s/u", "1", "sliding over entrainment speed", default=None, ge=0
    )
    formula: AbstractFilm | None = None
    hertz: Literal["mean", "maximum"] = choice("which Hertz pressure is nominal", default="mean")
    few: float = quantity(
        "s_few", "1", "share of the solids below which the film is full", default=FEW, ge=0, le=1
    )
    most: float = quantity(
        "s_most", "1", "share of the solids above which it is boundary", default=MOST, ge=0, le=1
    )
    entrainment: Entrainment | None = None

    def _problems(self) -> list[str]:
        out: list[str] = []
        if not isinstance(self.conjunction, Point | Line):
            out.append(
                Problem(
                    "conjunction",
                    "must be a Point or Line",
                    repr(self.conjunction),
                    code=Mistake.KIND,
                )
            )
        elif self.formula is not None and self.formula.shape != self.conjunction.shape:
            out.append(
                Problem(
                    "formula",
                    f"is for {self.formula.shape} "
                    f"contacts, and the conjunction is a {self.conjunction.shape}",
                    f"{self.formula.name}",
                    code=Mistake.BEYOND,
                )
            )
        if not isinstance(self.oil, Oil):
            out.append(Problem("oil", "must be an Oil", repr(self.oil), code=Mistake.KIND))
        if self.few > self.most:
            out.append(
                Problem(
                    "few",
                    f"must be at most most = {self.most:g}: the film "
                    "is full below the first share of the solids and boundary above the second",
                    f"{self.few:g}",
                    code=Mistake.ORDER,
                )
            )
        speeds = np.atleast_1d(np.asarray(self.speed, dtype=float))
        if not speeds.size or not np.all(np.isfinite(speeds) & (speeds > 0)):
            out.append(
                Problem("speed", "must be numbers > 0 [m/s], at least one", code=Mistake.RANGE)
            )
        else:
            object.__setattr__(self, "speed", tuple(speeds.tolist()))
        return out

    def arguments(self) -> dict[str, Any]:
        """Arguments of `regime_speeds`; with ``speed`` and ``slide_roll`` those of `mixed_film`."""
        return {
            "conjunction": self.conjunction,
            "oil": self.oil,
            "load": self.load,
            "film": self.formula,
            "hertz": self.hertz,
            "few": self.few,
            "most": self.most,
        }

    def nominal_pressure(self, contact: Contact) -> float:
        """Hertz pressure of the smooth dry bodies, the mean or the largest as asked [Pa]."""
        dry = self.conjunction.hertz(self.load, E=2 * contact.E_ss)
        return float(dry.mean if self.hertz == "mean" else dry.maximum)

    def at(self, contact: Contact, *, speed: ArrayLike | None = None) -> MixedFilm:
        """`mixed_film` at these speeds, or at another [m/s]; one speed gives floats."""
        if speed is None:
            speed = self.speed[0] if len(self.speed) == 1 else self.speed
        return mixed_film(contact, speed=speed, slide_roll=self.slide_roll, **self.arguments())

    def __call__(self, *_: object, **__: object) -> NoReturn:
        """Refuse the call of what a study holds as its film."""
        raise WrongKind(
            Problem(
                "film",
                "holds the numbers of the table [film]; it is no function",
                hint=guess("", (), meant="stribeck()"),
                owner="study",
                code=Mistake.KIND,
            )
        )

    def stribeck(self, contact: Contact) -> xarray.Dataset:
        """`stribeck` over these speeds."""
        return stribeck(contact, speed=self.speed, slide_roll=self.slide_roll, **self.arguments())

    def stribeck_columns(self, contact: Contact) -> dict[str, Any]:
        """The columns of `stribeck`, as arrays."""
        arguments = {"speed": self.speed, "slide_roll": self.slide_roll} | self.arguments()
        return stribeck_columns(contact, **arguments)[0]

    def regime_speeds(self, contact: Contact) -> RegimeSpeeds:
        """`regime_speeds` of this load."""
        return regime_speeds(contact, **self.arguments())
