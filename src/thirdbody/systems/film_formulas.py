r"""Film formulas: how thick an oil film smooth bodies build, and where each formula holds.

Every formula is a power law, or a blend of power laws, of

.. math:: U = \frac{\eta u}{E'R}, \quad G = \alpha E', \quad
          W = \frac{w}{E'R^2}\ \text{(point)}, \quad W' = \frac{w'}{E'R}\ \text{(line)}, \quad
          E' = 2E^*

with the mean entrainment speed :math:`u = (u_1 + u_2)/2`.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypedDict

import numpy as np

from ..errors import Note
from ..laws.base import Law
from ..quantities.arguments import need_positive
from ..quantities.value import choice
from .conjunctions import Hertz, Line, Oil, Point

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = [
    "FORMULAS",
    "AbstractFilm",
    "DowsonLine",
    "HamrockDowson",
    "Hertz",
    "Line",
    "MoesLine",
    "NijenbanningVennerMoes",
    "Oil",
    "Point",
]

REGIMES = (
    "rigid-isoviscous",
    "elastic-isoviscous",
    "rigid-piezoviscous",
    "elastic-piezoviscous",
)
EP = REGIMES[3]
"""Elastic-piezoviscous: where bearings and gears of steel run."""


class Operation(TypedDict):
    """What a film formula asks for."""

    load: Number
    speed: Number
    eta: float
    alpha: float
    R: float
    E: Number
    ratio: float


class AbstractFilm(Law):
    r"""The film between smooth bodies, fully flooded, isothermal, Newtonian.

    .. math:: h_c = R_x\,H(U, G, W, R_x/R_y)

    A subclass is a frozen, slotted, keyword-only dataclass with the class data of `Law`, the
    shape it is for, where it holds, and `central`. It enters `FORMULAS` when it is defined.

    Attributes
    ----------
    shape : {"point", "line"}
        What it is for; the load is then w [N] or w' [N/m].
    regimes : tuple of str
        Those of `REGIMES` in which it holds.
    limits : mapping
        Range of R_x/R_y [1], under the key ``ratio``.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.film_formulas import full_range
    >>> sorted(tb.films.FORMULAS)
    ['dowson-line', 'hamrock-dowson', 'moes-line', 'nijenbanning-venner-moes']
    >>> isinstance(full_range("line"), tb.films.AbstractFilm), full_range("line").shape
    (True, 'line')
    """

    __slots__ = ()
    registry: ClassVar[dict[str, type[Law]]] = {}
    shape: ClassVar[str]
    """"point" or "line": what load it takes, N or N/m"""
    regimes: ClassVar[tuple[str, ...]] = REGIMES
    """Regimes of lubrication in which it holds."""
    limits: ClassVar[Mapping[str, tuple[float, float]]] = {}
    """Range of R_x/R_y (``ratio``) for which it was made."""

    @abstractmethod
    def central(
        self,
        *,
        load: Number,
        speed: Number,
        eta: float,
        alpha: float,
        R: float,
        E: Number,
        ratio: float = 1,
    ) -> Number:
        """Central film thickness [m].

        Parameters
        ----------
        load : float or array
            w [N], for line contacts w' [N/m].
        speed : float or array
            Mean entrainment speed u [m/s].
        eta, alpha : float
            Viscosity η [Pa s] and its pressure coefficient α [1/Pa].
        R : float
            Reduced radius R_x [m].
        E : float or array
            E' = 2E* [Pa].
        ratio : float, optional
            R_x/R_y [1].
        """

    def warnings(self, regimes: Any, ratio: float) -> list[str]:
        """Notes on films outside the range of the formula, one sentence each."""
        out: list[str] = []
        for name, (low, high) in self.limits.items():
            if not low <= ratio <= high:
                what = f"films.{self.name}: {name} = {ratio:g} is outside {low:g} to {high:g}"
                out.append(Note(what, code=f"films.{name}"))
        wrong = sorted(set(np.atleast_1d(regimes).tolist()) - set(self.regimes))
        if wrong:
            every = "NijenbanningVennerMoes" if self.shape == "point" else "MoesLine"
            what = (
                f"films.{self.name} holds for {', '.join(self.regimes)} films; some here are "
                f"{', '.join(wrong)}"
            )
            out.append(Note(what, code="films.regime", effect=0.5, action=f"take {every}"))
        return out


class Groups(NamedTuple):
    """U, G and W of the formulas [1], beside the radii."""

    U: Number
    G: Number
    W: Number
    R: float
    ratio: float


class _InGroups(AbstractFilm):
    """A film whose formulas hold between U, G and W."""

    __slots__ = ()

    def _groups(
        self,
        load: Number,
        speed: Number,
        eta: float,
        alpha: float,
        R: float,
        E: Number,
        ratio: float,
    ) -> Groups:
        """W = load/(E'R^power), power 2 for points and 1 for lines."""
        W = load / (E * R ** (2 if self.shape == "point" else 1))
        return Groups(eta * speed / (E * R), alpha * E, W, R, ratio)

    def central(
        self,
        *,
        load: Number,
        speed: Number,
        eta: float,
        alpha: float,
        R: float,
        E: Number,
        ratio: float = 1,
    ) -> Number:
        return self._central(self._groups(load, speed, eta, alpha, R, E, ratio))

    @abstractmethod
    def _central(self, to: Groups) -> Number:
        """Central film thickness [m]."""


class _Fitted(_InGroups):
    """A power law, and another of the smallest thickness."""

    __slots__ = ()

    def minimum(
        self,
        *,
        load: Number,
        speed: Number,
        eta: float,
        alpha: float,
        R: float,
        E: Number,
        ratio: float = 1,
    ) -> Number:
        """Smallest film thickness [m]; arguments as in `central`."""
        return self._smallest(self._groups(load, speed, eta, alpha, R, E, ratio))

    @abstractmethod
    def _smallest(self, to: Groups) -> Number:
        """Smallest film thickness [m]."""


class _Joined(_InGroups):
    """Four limits that are joined."""

    __slots__ = ()

    def asymptotes(
        self,
        *,
        load: Number,
        speed: Number,
        eta: float,
        alpha: float,
        R: float,
        E: Number,
        ratio: float = 1,
    ) -> Asymptotes:
        """The four limits; arguments as in `central`."""
        return self._limits(self._groups(load, speed, eta, alpha, R, E, ratio))

    @abstractmethod
    def _limits(self, to: Groups) -> Asymptotes:
        """The four limits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DowsonLine(_Fitted):
    r"""Line contact, elastic-piezoviscous.

    .. math:: h_{min} = 2.65\,R\,U^{0.7}G^{0.54}W'^{-0.13}, \qquad
              h_c = 3.06\,R\,U^{0.69}G^{0.56}W'^{-0.10}

    Examples
    --------
    >>> import thirdbody as tb
    >>> h = tb.films.DowsonLine().central(
    ...     load=1e5, speed=1.0, eta=0.04, alpha=2e-8, R=0.0127, E=226.37e9
    ... )
    >>> round(float(h) * 1e9, 1)
    390.5
    """

    name = "dowson-line"
    title = "Dowson, line contact"
    year = 1968
    citation = "Dowson 1968, Proc. Inst. Mech. Eng. 182, 151; central film: Dowson, Toyoda 1979"
    doi = ""
    provenance = "recalled; the same in independent implementations"
    valid_range = "elastic-piezoviscous line contacts"
    shape = "line"
    regimes = (EP,)

    def _central(self, to: Groups) -> Number:
        U, G, W, R, _ = to
        return 3.06 * R * U**0.69 * G**0.56 * W**-0.10

    def _smallest(self, to: Groups) -> Number:
        U, G, W, R, _ = to
        return 2.65 * R * U**0.7 * G**0.54 * W**-0.13


@dataclass(frozen=True, slots=True, kw_only=True)
class HamrockDowson(_Fitted):
    r"""Point contact, elastic-piezoviscous.

    .. math::

        h_c &= 2.69\,R\,U^{0.67}G^{0.53}W^{-0.067}(1 - 0.61e^{-0.73\kappa}) \\
        h_{min} &= 3.63\,R\,U^{0.68}G^{0.49}W^{-0.073}(1 - e^{-0.68\kappa}), \qquad
        \kappa = (R_y/R_x)^{2/\pi}

    The exponents are rounded: with load and modulus divided by γ, h_c grows like γ^0.14, which in
    the asymptote it approximates does not depend on γ.

    References
    ----------
    Hamrock, Dowson 1977, J. Lubr. Technol. 99, 264, doi:10.1115/1.3453074.

    Examples
    --------
    >>> import thirdbody as tb
    >>> film = tb.films.HamrockDowson()
    >>> h = film.central(load=50.0, speed=1.0, eta=0.04, alpha=2e-8, R=0.0127, E=226.37e9)
    >>> round(float(h) * 1e9, 1)
    274.7
    """

    name = "hamrock-dowson"
    title = "Hamrock and Dowson, point contact"
    year = 1977
    citation = "Hamrock, Dowson 1977, J. Lubr. Technol. 99, 264"
    doi = "10.1115/1.3453074"
    provenance = "recalled; the same in independent implementations"
    valid_range = "elastic-piezoviscous point contacts, κ ≥ 1"
    shape = "point"
    regimes = (EP,)
    limits = {"ratio": (0.0, 1.0)}

    def _central(self, to: Groups) -> Number:
        U, G, W, R, ratio = to
        return 2.69 * R * U**0.67 * G**0.53 * W**-0.067 * (1 - 0.61 * np.exp(-0.73 * kappa(ratio)))

    def _smallest(self, to: Groups) -> Number:
        U, G, W, R, ratio = to
        return 3.63 * R * U**0.68 * G**0.49 * W**-0.073 * (1 - np.exp(-0.68 * kappa(ratio)))


def kappa(ratio: float) -> float:
    """Ellipticity κ ≈ (R_y/R_x)^(2/π) of the contact [1].

    Parameters
    ----------
    ratio : float
        R_x/R_y [1].

    Examples
    --------
    >>> kappa(1.0)
    1.0
    """
    need_positive(ratio=ratio)
    return float(ratio ** (-2 / math.pi))


class Asymptotes(NamedTuple):
    """Dimensionless films H = h/R (2U)^(−1/2) [1] of the four limits, in the order of `REGIMES`.

    Examples
    --------
    >>> str(MoesLine.limits_of(M=100.0, L=10.0).regime)
    'elastic-piezoviscous'
    """

    RI: Number
    EI: Number
    RP: Number
    EP: Number

    @property
    def regime(self) -> Number:
        """Which limit the film is nearest to: max(max(RI, EI), min(RP, EP))."""
        iso = np.where(self.RI >= self.EI, 0, 1)
        piezo = np.where(self.RP <= self.EP, 2, 3)
        thin = np.maximum(self.RI, self.EI) >= np.minimum(self.RP, self.EP)
        return np.array(REGIMES)[np.where(thin, iso, piezo)]


@dataclass(frozen=True, slots=True, kw_only=True)
class NijenbanningVennerMoes(_Joined):
    r"""Point contact, every regime, any ratio of radii.

    With :math:`M = W(2U)^{-3/4}`, :math:`L = G(2U)^{1/4}`, :math:`D = R_x/R_y`,
    :math:`g = 1 + 0.006\ln D + 0.63D^{4/7}`, :math:`H_{00} = 1.8/D`:

    .. math::

        H_{RI} &= 145(1 + 0.796D^{14/15})^{-15/7}D^{-1}M^{-2}, &
        H_{EI} &= 3.18g^{-14/25}D^{-1/15}M^{-2/15} \\
        H_{RP} &= 1.29(1 + 0.691D)^{-2/3}L^{2/3}, &
        H_{EP} &= 1.48g^{-7/20}D^{-1/24}M^{-1/12}L^{3/4}

    .. math:: \frac hR(2U)^{-1/2} = \left\{\left[H_{RI}^{3/2} +
        (H_{EI}^{-4} + H_{00}^{-4})^{-3/8}\right]^{2s/3} +
        (H_{RP}^{-8} + H_{EP}^{-8})^{-s/8}\right\}^{1/s}, \quad s = \tfrac32(1 + e^{-1.2r})

    In the elastic-piezoviscous limit h does not change when load and modulus are divided by the
    same number.

    Parameters
    ----------
    blend : {"EI/RI", "EI/EP"}, optional
        The ratio r in the exponent s: H_EI/H_RI, as in the formula for line contacts, or
        H_EI/H_EP. From memory: not confirmed in a source; the second gives films 6 to 10 % thinner
        in steel contacts, nearer to `HamrockDowson`.

    Notes
    -----
    The outer exponents are the homogeneous ones (scaling all limits by c scales H by c), from
    memory: public implementations print others, with which H is not homogeneous.

    References
    ----------
    Nijenbanning, Venner, Moes 1994, Wear 176, 217, doi:10.1016/0043-1648(94)90150-3.

    Examples
    --------
    >>> import thirdbody as tb
    >>> film = tb.films.NijenbanningVennerMoes()
    >>> h = film.central(load=50.0, speed=1.0, eta=0.04, alpha=2e-8, R=0.0127, E=226.37e9)
    >>> round(float(h) * 1e9, 1)
    307.0
    """

    name = "nijenbanning-venner-moes"
    title = "Nijenbanning, Venner and Moes, elliptic contact"
    year = 1994
    citation = "Nijenbanning, Venner, Moes 1994, Wear 176, 217"
    doi = "10.1016/0043-1648(94)90150-3"
    provenance = "limits as in public implementations; exponents from memory, not confirmed"
    valid_range = "every regime; R_x/R_y up to about 1"
    shape = "point"
    limits = {"ratio": (1e-6, 1.0)}

    blend: Literal["EI/RI", "EI/EP"] = choice("ratio in the exponent s", default="EI/RI")

    @staticmethod
    def limits_of(*, M: Number, L: Number, D: float) -> Asymptotes:
        """The four limits for Moes' load M and lubricant number L [1]."""
        g = 1 + 0.006 * math.log(D) + 0.63 * D ** (4 / 7)
        return Asymptotes(
            145 * (1 + 0.796 * D ** (14 / 15)) ** (-15 / 7) / D * M**-2.0,
            3.18 * g ** (-14 / 25) * D ** (-1 / 15) * M ** (-2 / 15),
            1.29 * (1 + 0.691 * D) ** (-2 / 3) * L ** (2 / 3),
            1.48 * g ** (-7 / 20) * D ** (-1 / 24) * M ** (-1 / 12) * L ** (3 / 4),
        )

    def join_limits(self, at: Asymptotes, *, H_00: float) -> Number:
        """H between the limits [1]."""
        ratio = at.EI / (at.RI if self.blend == "EI/RI" else at.EP)
        s = 1.5 * (1 + np.exp(-1.2 * ratio))
        iso = (at.RI**1.5 + (at.EI**-4 + H_00**-4.0) ** (-3 / 8)) ** (2 / 3)
        with np.errstate(divide="ignore"):
            piezo = (at.RP**-8 + at.EP**-8) ** (-1 / 8)
        return (iso**s + piezo**s) ** (1 / s)

    def _limits(self, to: Groups) -> Asymptotes:
        U, G, W, _, ratio = to
        return self.limits_of(M=W * (2 * U) ** -0.75, L=G * (2 * U) ** 0.25, D=ratio)

    def _central(self, to: Groups) -> Number:
        return self.join_limits(self._limits(to), H_00=1.8 / to.ratio) * to.R * (2 * to.U) ** 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class MoesLine(_Joined):
    r"""Line contact, every regime.

    With :math:`M = W'(2U)^{-1/2}`, :math:`L = G(2U)^{1/4}`:

    .. math::

        H_{RI} = 3/M, \quad H_{EI} = 2.621M^{-1/5}, \quad H_{RP} = 1.287L^{2/3}, \quad
        H_{EP} = 1.311M^{-1/8}L^{3/4}

    .. math:: \frac hR(2U)^{-1/2} = \left\{(H_{RI}^{7/3} + H_{EI}^{7/3})^{3s/7} +
        (H_{RP}^{-7/2} + H_{EP}^{-7/2})^{-2s/7}\right\}^{1/s}, \quad
        s = \tfrac15(7 + 8e^{-2H_{EI}/H_{RI}})

    From memory: not confirmed in a source.

    References
    ----------
    Moes 2000, Lubrication and Beyond, University of Twente.

    Examples
    --------
    >>> import thirdbody as tb
    >>> h = tb.films.MoesLine().central(
    ...     load=1e5, speed=1.0, eta=0.04, alpha=2e-8, R=0.0127, E=226.37e9
    ... )
    >>> round(float(h) * 1e9)
    390
    """

    name = "moes-line"
    title = "Moes, line contact"
    year = 2000
    citation = "Moes 2000, Lubrication and Beyond, University of Twente"
    doi = ""
    provenance = "recalled, not confirmed in a source"
    valid_range = "every regime"
    shape = "line"

    @staticmethod
    def limits_of(*, M: Number, L: Number) -> Asymptotes:
        """The four limits for Moes' load M and lubricant number L [1]."""
        return Asymptotes(3 / M, 2.621 * M**-0.2, 1.287 * L ** (2 / 3), 1.311 * M**-0.125 * L**0.75)

    def join_limits(self, at: Asymptotes) -> Number:
        """H between the limits [1]."""
        s = (7 + 8 * np.exp(-2 * at.EI / at.RI)) / 5
        iso = (at.RI ** (7 / 3) + at.EI ** (7 / 3)) ** (3 / 7)
        with np.errstate(divide="ignore"):
            piezo = (at.RP**-3.5 + at.EP**-3.5) ** (-2 / 7)
        return (iso**s + piezo**s) ** (1 / s)

    def _limits(self, to: Groups) -> Asymptotes:
        return self.limits_of(M=to.W * (2 * to.U) ** -0.5, L=to.G * (2 * to.U) ** 0.25)

    def _central(self, to: Groups) -> Number:
        return self.join_limits(self._limits(to)) * to.R * (2 * to.U) ** 0.5


FORMULAS = AbstractFilm.registry
"""Every film formula by name."""


def full_range(shape: str) -> NijenbanningVennerMoes | MoesLine:
    """The formula of every regime for a shape, "point" or "line".

    Examples
    --------
    >>> full_range("point").name
    'nijenbanning-venner-moes'
    """
    return NijenbanningVennerMoes() if shape == "point" else MoesLine()
