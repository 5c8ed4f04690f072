"""What friction and heat change of the contact that makes them: laws for `equilibria.coupled`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..effects.friction import Friction
from ..effects.single.heat import body_conductance, partition
from ..errors import Mistake, Note, Problem
from ..quantities.say import value_of
from ..quantities.value import Value, choice, quantity

if TYPE_CHECKING:
    from ..contact.contact import Contact
    from ..populations.materials import Material

__all__ = ["HalfSpaces", "JunctionGrowth", "Softening", "ThermalPath", "Thinning"]


def __dir__() -> list[str]:
    return sorted(__all__)


SHEAR_WEIGHT = 9.0
"""α of junction growth where nobody says another."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JunctionGrowth(Value):
    r"""Hardness of surfaces that are sheared while they yield.

    .. math:: p^2 + \alpha\,\tau^2 = H^2 \quad\Rightarrow\quad
              H_{eff} = \sqrt{H^2 - \alpha\,\tau_{ss}^2}

    Both surfaces take their H_eff for every contact of theirs, those with particles too. τ_ss is
    that of `outputs.Friction`; where it grows with the pressure, it is taken at H_eff, and ``m_ss``
    is taken of H.

    Parameters
    ----------
    alpha : float, optional
        Weight of shear in the yield criterion α [1]. Tests of metals gave 3 to 25; without it 9
        is used, with a warning that it is a guess.

    Raises
    ------
    InvalidValue
        A value outside its range; a contact where α τ_ss² reaches H², whose junctions grow without
        end; a friction output with an ``alpha_T``, which lets junctions grow a second time.

    References
    ----------
    Tabor 1959, Proc. R. Soc. A 251, 378 (from memory: not confirmed in the source).

    Examples
    --------
    >>> from thirdbody.systems.feedback import JunctionGrowth
    >>> law = JunctionGrowth(alpha=9)
    >>> print(f"{law.hardness(5e9, tau=1e9) / 1e9:.3f} GPa")
    4.000 GPa
    """

    alpha: float | None = quantity(
        "α", "1", "weight of shear in the yield criterion", default=None, ge=1, le=100
    )

    @property
    def weight(self) -> float:
        """α, the guess where it was left out [1]."""
        return SHEAR_WEIGHT if self.alpha is None else self.alpha

    def hardness(self, H: float, *, tau: float, growth: float = 0.0) -> float:
        """H_eff [Pa]; NaN where junctions grow without end.

        Parameters
        ----------
        H : float
            Hardness without shear [Pa].
        tau : float
            Shear strength τ at no pressure [Pa].
        growth : float, optional
            Growth of τ with the pressure of a contact [1].
        """
        # p² + α (τ + growth p)² = H²
        square, linear = 1 + self.weight * growth**2, self.weight * tau * growth
        rest = H**2 - self.weight * tau**2
        if rest <= 0:
            return math.nan
        return rest / (linear + math.sqrt(linear**2 + square * rest))

    def notes(self) -> list[Note]:
        """What is not known of it."""
        if self.alpha is not None:
            return []
        what = (
            f"feedback.JunctionGrowth: alpha = {SHEAR_WEIGHT:g} is a guess; tests of metals gave 3 "
            "to 25"
        )
        return [Note(what, code="junction_growth.alpha", action="give alpha, and try both ends")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Softening(Value):
    r"""Hardness that falls with the temperature, in the form of Johnson and Cook.

    .. math:: H(T) = H_0\left[1 - \left(\frac{T - T_0}{T_m - T_0}\right)^m\right], \qquad
              T_0 \le T < T_m

    Below T_0 the hardness is H_0, that of the material.

    Parameters
    ----------
    T_melt : float
        Temperature T_m at which nothing is left of the hardness [K or °C, as all others].
    T_0 : float
        Temperature at which H_0 was measured, in the same unit.
    exponent : float
        m [1].
    body : {"surfaces", "first", "second", "particles"}, optional
        What softens: give one law for each body that does.

    Raises
    ------
    InvalidValue
        A value outside its range, or T_melt not above T_0.

    Notes
    -----
    The form was fitted to the flow stress in tests of fractions of a second. That hardness follows
    it, and that nothing is tempered, oxidised or recrystallised meanwhile, is assumed. In use are
    m = 1.03 and T_m = 1793 K for 4340 steel, 1.09 and 1356 K for OFHC copper (from memory).

    References
    ----------
    Johnson and Cook 1983, 7th Int. Symp. on Ballistics, 541 (from memory: not confirmed in the
    source).

    Examples
    --------
    >>> from thirdbody.systems.feedback import Softening
    >>> law = Softening(T_melt=1793, T_0=293, exponent=1.0)
    >>> law.share(1043.0), law.share(100.0)
    (0.5, 1.0)
    """

    T_melt: float = quantity("T_m", "K", "temperature at which no hardness is left")
    T_0: float = quantity("T_0", "K", "temperature of the hardness H_0")
    exponent: float = quantity("m", "1", "exponent of the softening", gt=0, le=20)
    body: str = choice(
        "what softens", "surfaces", "first", "second", "particles", default="surfaces"
    )

    def _problems(self) -> list[str]:
        if self.T_melt > self.T_0:
            return []
        return [
            Problem(
                "T_melt",
                f"must be above T_0 = {self.T_0:g}",
                f"{self.T_melt:g}",
                code=Mistake.ORDER,
            )
        ]

    def share(self, T: float) -> float:
        """Hardness over H_0 at a temperature T [1]; NaN from T_melt on."""
        rise = (T - self.T_0) / (self.T_melt - self.T_0)
        return math.nan if rise >= 1 else 1.0 - max(rise, 0.0) ** self.exponent


@dataclass(frozen=True, slots=True, kw_only=True)
class Thinning(Value):
    r"""Viscosity of an oil that falls with the temperature.

    .. math:: \eta(T) = \eta_0\,e^{-\beta (T - T_0)}

    Parameters
    ----------
    beta : float
        Temperature coefficient β [1/K]; `between` has it from two viscosities of a data sheet.
    T_0 : float
        Temperature at which the oil has its viscosity η_0 [K or °C, as all others].

    Notes
    -----
    The same β is taken at every temperature; over more than some 40 K the line of a data sheet
    bends. The pressure coefficient of the oil and its Eyring stress stay.

    References
    ----------
    Reynolds 1886, Phil. Trans. R. Soc. 177, 157, doi:10.1098/rstl.1886.0005.

    Examples
    --------
    >>> from thirdbody.systems.feedback import Thinning
    >>> oil = Thinning.between(0.05, T_1=40.0, eta_2=0.0068, T_2=100.0)
    >>> print(f"{oil.beta:.4f} 1/K; at 70 °C {oil.share(70.0):.3f} of that at 40 °C")
    0.0333 1/K; at 70 °C 0.369 of that at 40 °C
    """

    beta: float = quantity("β", "1/K", "temperature coefficient of viscosity", gt=0, le=1)
    T_0: float = quantity("T_0", "K", "temperature of the viscosity η_0")

    @classmethod
    def between(cls, eta_1: float, *, T_1: float, eta_2: float, T_2: float) -> Thinning:
        """The law through two viscosities, of which the first is that of the oil.

        Parameters
        ----------
        eta_1, eta_2 : float
            Viscosities [Pa s], or kinematic ones in one unit: only their ratio counts.
        T_1, T_2 : float
            Their temperatures.
        """
        return cls(beta=math.log(eta_1 / eta_2) / (T_2 - T_1), T_0=T_1)

    def share(self, T: float) -> float:
        """Viscosity over η_0 at a temperature T [1]."""
        return math.exp(-self.beta * (T - self.T_0))


# ------------------------------------------------------------------ where the heat goes
@dataclass(frozen=True, slots=True, kw_only=True)
class ThermalPath(Value):
    r"""Ways of the heat from a nominal area through the bodies to their surroundings.

    .. math:: T = \frac{q + h_1T_1 + h_2T_2}{h_1 + h_2}, \qquad q = \mu\,p\,v

    Parameters
    ----------
    h_1, h_2 : float
        Conductance of either body per nominal area [W/(m² K)], e.g. k/l of a plate; 0 insulates.
    T_1, T_2 : float
        Temperatures of the surroundings [K or °C, as all others].

    Raises
    ------
    InvalidValue
        A value outside its range; both conductances 0.

    Examples
    --------
    >>> from thirdbody.systems.feedback import ThermalPath
    >>> ThermalPath(h_1=1e4, h_2=0.0, T_1=293.0, T_2=293.0).temperature(2e5, v=1.0)
    313.0
    """

    h_1: float = quantity("h_1", "W/m^2/K", "conductance of body 1 to its surroundings", ge=0)
    h_2: float = quantity("h_2", "W/m^2/K", "conductance of body 2 to its surroundings", ge=0)
    T_1: float = quantity("T_1", "K", "temperature around body 1")
    T_2: float = quantity("T_2", "K", "temperature around body 2")

    def _problems(self) -> list[str]:
        if self.h_1 + self.h_2 > 0:
            return []
        return [
            Problem(
                "h_1", "and h_2 leave the heat no way out: one must be > 0", "0", code=Mistake.CLASH
            )
        ]

    def needs(self, contact: Contact) -> list[str]:
        """What a contact lacks for it."""
        return []

    def bound_to(self, contact: Contact) -> ThermalPath:
        """The path of this contact."""
        return self

    def temperature(self, q: float, *, v: float) -> float:
        """Mean temperature of the surfaces under heat.

        Parameters
        ----------
        q : float
            Heat per nominal area [W/m^2].
        v : float
            Sliding speed [m/s]; this path does not depend on it.
        """
        T = partition(q, G_1=self.h_1, G_2=self.h_2, T_1=self.T_1, T_2=self.T_2)
        return float(T)


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfSpaces(Value):
    r"""Two large bodies that take the heat of a nominal area, over one of which it moves.

    .. math:: T = \frac{q A_n + G_1T_1 + G_2T_2}{G_1 + G_2}, \qquad
              G_i = \frac{\pi b k_i}{\theta(\mathrm{Pe}_i)}, \quad b = \sqrt{A_n/\pi}

    with the mean rise θ of `thirdbody.effects.single.heat.moving_rise` in the steady state.

    Parameters
    ----------
    A_n : float
        Nominal area [m²], taken as a circle.
    T_1, T_2 : float
        Temperatures of the bodies far away [K or °C, as all others].
    stays_on : {"first", "second"}, optional
        The body on which the area stays put; it moves with the sliding speed over the other.

    Notes
    -----
    Bodies need thermal conductivity, density and specific heat. The mean rise is at most 3.8 % low
    (that of `moving_rise`).

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.feedback import HalfSpaces
    >>> steel = tb.materials["S45C"].replace(
    ...     thermal_conductivity=50, density=7850, specific_heat=480)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> cooling = HalfSpaces(A_n=1e-6, T_1=293.0, T_2=293.0)
    >>> print(f"{cooling.bound_to(contact).temperature(1e6, v=1.0):.2f} K")
    294.41 K
    """

    A_n: float = quantity("A_n", "m^2", "nominal area", gt=0, hint="1 mm² is 1e-6")
    T_1: float = quantity("T_1", "K", "temperature of body 1 far away")
    T_2: float = quantity("T_2", "K", "temperature of body 2 far away")
    stays_on: str = choice("body on which the area stays put", "first", "second", default="first")

    def needs(self, contact: Contact) -> list[str]:
        """What the bodies of a contact lack."""
        names = ("thermal_conductivity", "density", "specific_heat")
        bodies = {"first": contact.surfaces.first, "second": contact.surfaces.second}
        return [
            Problem("cooling", f": surfaces.{which} needs {name}", code=Mistake.MISSING)
            for which, body in bodies.items()
            for name in names
            if getattr(body, name) is None
        ]

    def bound_to(self, contact: Contact) -> BoundHalfSpaces:
        """The half-spaces of the bodies of a contact."""
        return BoundHalfSpaces(self, (contact.surfaces.first, contact.surfaces.second))


@dataclass(frozen=True, slots=True)
class BoundHalfSpaces:
    """Half-spaces of two materials."""

    path: HalfSpaces
    bodies: tuple[Material, Material]

    def temperature(self, q: float, *, v: float) -> float:
        """Mean temperature of the surfaces under heat q [W/m²] per nominal area."""
        b = math.sqrt(self.path.A_n / math.pi)
        speeds = (0.0, v) if self.path.stays_on == "first" else (v, 0.0)
        G = []
        for body, speed in zip(self.bodies, speeds, strict=True):
            k, density, heat = body.thermal_conductivity, body.density, body.specific_heat
            assert k is not None
            assert density is not None
            assert heat is not None
            G.append(body_conductance(b, k=k, D=k / (density * heat), v=speed, kind="mean"))
        T = partition(q * self.path.A_n, G_1=G[0], G_2=G[1], T_1=self.path.T_1, T_2=self.path.T_2)
        return float(T)


def friction_of(contact: Contact) -> Friction | None:
    """The friction output of a contact."""
    return next((output for output in contact.outputs if isinstance(output, Friction)), None)


def shear_of(friction: Friction, H: float) -> tuple[float, float]:
    """Shear strength τ_ss [Pa] at no pressure where the softer body has hardness H, and its growth
    with the pressure [1]."""
    k = H / (3 * math.sqrt(3))
    tau = friction.tau_ss if friction.tau_ss is not None else (friction.m_ss or 0.0) * k
    return tau, friction.alpha_ss


def growth_problems(law: JunctionGrowth, contact: Contact) -> list[str]:
    """Why junctions of a contact cannot grow by this law."""
    friction = friction_of(contact)
    if friction is None:
        return []
    if friction.alpha_T is not None:
        return [
            "feedback: JunctionGrowth and outputs.Friction.alpha_T both let junctions grow; leave "
            "alpha_T out"
        ]
    H = min(contact.surfaces.first.H, contact.surfaces.second.H)
    tau, growth = shear_of(friction, H)
    if np.isfinite(law.hardness(H, tau=tau, growth=growth)):
        return []
    most = H / math.sqrt(law.weight)
    return [
        f"feedback: with alpha = {law.weight:g} junctions under tau_ss = {value_of(tau, 'Pa')} "
        f"grow without end; it must be below H/√alpha = {value_of(most, 'Pa')} of the softer one"
    ]
