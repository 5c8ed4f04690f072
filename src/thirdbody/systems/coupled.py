"""States in which a rubbing contact and the friction and heat that it makes agree."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from ..contact.contact import Contact
from ..effects.temperature import FlashTemperature
from ..equilibrium.solve import solve, solve_untold
from ..errors import (
    InvalidValue,
    Mistake,
    NoEquilibrium,
    Note,
    Problem,
    RangeWarning,
    tell_of_range,
)
from ..quantities.arguments import need_one
from ..quantities.carried import takes_units
from ..quantities.record import (
    Entry,
    StateRecord,
    TableRecord,
    Variable,
    column,
    declared_columns,
)
from ..quantities.say import number
from .coupled_walk import LAST, Walk
from .feedback import (
    BoundHalfSpaces,
    HalfSpaces,
    JunctionGrowth,
    Softening,
    ThermalPath,
    Thinning,
    friction_of,
    growth_problems,
    shear_of,
)
from .film_conditions import FilmConditions
from .mixed_film import MixedFilm, mixed_film

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..equilibrium.columns import Equilibrium

    Array = NDArray[np.float64]

__all__ = ["Coupled", "CoupledState", "coupled"]


def __dir__() -> list[str]:
    return sorted(__all__)


Law = JunctionGrowth | Softening | Thinning
WARMEST = 500.0
"""Rise up to which a branch is followed where no body melts [K]."""
SLOPE = 1e-5
"""Step of the differences that give the loop gain, over the largest rise."""


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class CoupledState(StateRecord):
    """One state in which inputs and outputs agree.

    Examples
    --------
    >>> from thirdbody.systems.coupled import CoupledState
    >>> CoupledState.__name__
    'CoupledState'
    """

    in_dict: ClassVar[tuple[Entry, ...]] = ()
    not_in_dict: ClassVar[tuple[str, ...]] = ("state",)

    T: float = column("T", "K", "temperature of the surfaces where they touch")
    T_particles: float = column("T_p", "K", "temperature of the particles")
    T_bulk: float = column("T_b", "K", "mean temperature of the surfaces")
    mu: float = column("μ", "1", "coefficient of friction")
    heat: float = column("q", "W/m^2", "friction power per nominal area")
    H_1: float = column("H_1", "Pa", "hardness of surface 1 in this state")
    H_2: float = column("H_2", "Pa", "hardness of surface 2 in this state")
    loop_gain: float = column("g", "1", "rise that a kelvin more of itself makes, dT_out/dT_in")
    stable: bool = column("", "", "whether the loop gain is below 1: a disturbance dies out")
    state: Equilibrium | MixedFilm = field(repr=False)
    """The contact there."""


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Coupled(TableRecord):
    """What `coupled` finds: the states, and where the stable one ends.

    Examples
    --------
    >>> from thirdbody.systems.coupled import Coupled
    >>> "seizure_speed" in Coupled.__slots__
    True
    """

    not_in_dict: ClassVar[tuple[str, ...]] = ("contact", "branch", "branch_of_load")

    states: tuple[CoupledState, ...]
    """Every state on the branch that begins cold, the coldest first."""
    seizure_speed: float = column("v_s", "m/s", "sliding speed at which the stable state ends")
    seizure_load: float = column("p_s", "Pa", "nominal pressure at which the stable state ends")
    speed_limit: str = field()
    """What ends the stable state as the speed rises, in a sentence."""
    load_limit: str = field()
    """What ends it as the load rises."""
    branch: dict[str, Array] = field(repr=False)
    """Points along the speed: ``speed`` [m/s], ``T`` [K], ``mu`` [1]; empty where not asked for."""
    branch_of_load: dict[str, Array] = field(repr=False)
    """Points along the load: ``pressure`` [Pa], ``T`` [K], ``mu`` [1]."""
    warnings: tuple[str, ...] = ()
    """Where a state leaves the range of a model, a sentence each."""

    def variables(self) -> dict[str, Variable]:
        """Columns of the states, and where the stable one ends."""
        columns = {
            name: Variable(
                ("state",), [getattr(state, name) for state in self.states], about.labels
            )
            for name, about in declared_columns(CoupledState).items()
        }
        return {**columns, **TableRecord.variables(self)}

    @property
    def stable(self) -> CoupledState | None:
        """The coldest stable state; None where there is none."""
        return next((state for state in self.states if state.stable), None)


# ------------------------------------------------------------------ one turn of the loop
@dataclass(frozen=True)
class _Loop:
    """A contact with its feedback: what temperatures its friction makes at temperatures."""

    contact: Contact
    laws: tuple[Law, ...]
    cooling: ThermalPath | BoundHalfSpaces | None
    film: FilmConditions | None
    flash: bool
    cold: float
    """Temperature without friction."""
    span: float
    """Largest rise that is looked at [K]."""
    kept: dict[tuple[float, ...], Any] = field(default_factory=dict)

    def warm_contact(self, T: float, T_particles: float, v: float) -> Contact | None:
        """The contact with its bodies at temperatures; None where a law has no hardness."""
        shares = dict.fromkeys(("first", "second", "particles"), 1.0)
        for law in self.laws:
            if isinstance(law, Softening):
                names = ("first", "second") if law.body == "surfaces" else (law.body,)
                for name in names:
                    shares[name] *= law.share(T_particles if name == "particles" else T)
        pair, outputs = self.contact.surfaces, list(self.contact.outputs)
        H = [pair.first.H * shares["first"], pair.second.H * shares["second"]]
        friction = friction_of(self.contact)
        for law in self.laws:
            if isinstance(law, JunctionGrowth) and friction is not None and np.all(np.isfinite(H)):
                tau, growth = shear_of(friction, min(H))
                sheared = friction.replace(tau_ss=tau, m_ss=None)
                outputs[outputs.index(friction)] = sheared
                H = [law.hardness(hardness, tau=tau, growth=growth) for hardness in H]
        if not np.all(np.isfinite([*H, shares["particles"]])):
            return None
        if self.flash:
            outputs.append(FlashTemperature(v=v, A_n=1e-6))
        particles = tuple(
            population.replace(
                material=population.material.replace(H=population.material.H * shares["particles"])
            )
            for population in self.contact.populations
        )
        surfaces = pair.replace(
            first=pair.first.replace(H=H[0]), second=pair.second.replace(H=H[1])
        )
        return self.contact.replace(
            surfaces=surfaces, particles=particles or None, outputs=tuple(outputs)
        )

    def solve_state(
        self, T: float, T_particles: float, v: float, p: float, *, warns: bool = False
    ) -> Equilibrium | MixedFilm | None:
        """The contact at temperatures, sliding speed and load; None where it has no state."""
        contact = self.warm_contact(T, T_particles, v)
        if contact is None:
            return None
        try:
            if self.film is None:
                if warns:
                    return solve(contact, pressure=p)
                return solve_untold(contact, "pressure", np.array([p]))
            oil = self.film.oil
            for law in self.laws:
                if isinstance(law, Thinning):
                    oil = oil.replace(eta=oil.eta * law.share(T))
            film_arguments = self.film.arguments() | {"oil": oil, "load": self.load_of(p)}
            slide_roll = self.film.slide_roll
            assert slide_roll is not None
            with warnings.catch_warnings():
                if not warns:
                    warnings.simplefilter("ignore", RangeWarning)
                return mixed_film(
                    contact, speed=v / slide_roll, slide_roll=slide_roll, **film_arguments
                )
        except (NoEquilibrium, InvalidValue):
            return None

    def load_of(self, p: float) -> float:
        """The load [N] whose nominal pressure is p."""
        assert self.film is not None
        load, now = self.film.load, self.film.nominal_pressure(self.contact)
        # a point carries with the cube of its pressure, a line with the square
        return float(load * (p / now) ** (3 if self.film.conjunction.shape == "point" else 2))

    def numbers(self, x: Array, v: float, p: float) -> tuple[float, float, float]:
        """Friction, and the flash rises [K] of asperities and of particles by the load."""
        T, T_particles = self.temperatures(x)
        of_speed = v if self.flash or self.film is not None else 0.0
        key = (T, T_particles, of_speed, p)
        if key not in self.kept:
            state = self.solve_state(T, T_particles, v, p)
            self.kept[key] = _numbers(state, self.flash)
        return self.kept[key]

    def temperatures(self, x: Array) -> tuple[float, float]:
        """Temperatures of surfaces and particles from the unknowns, rises over the span."""
        T = self.cold + self.span * x
        return float(T[0]), float(T[-1])

    def bulk(self, mu: float, v: float, p: float) -> float:
        """Mean temperature of the surfaces."""
        if self.cooling is None:
            return self.cold
        return self.cooling.temperature(mu * p * v, v=v)

    def unknowns_made(self, x: Array, v: float, p: float) -> Array:
        """The unknowns that the contact makes at unknowns x."""
        mu, hot, hot_particles = self.numbers(x, v, p)
        T = self.bulk(mu, v, p) - self.cold
        rises = [T + hot, T + hot_particles] if self.flash else [T]
        return np.array(rises) / self.span

    def gain(self, x: Array, v: float, p: float) -> float:
        """Largest real part of the eigenvalues of what is made over what is put in."""
        columns = []
        for i in range(len(x)):
            step = np.zeros_like(x)
            step[i] = SLOPE
            columns.append(
                (self.unknowns_made(x + step, v, p) - self.unknowns_made(x - step, v, p))
                / (2 * SLOPE)
            )
        return float(np.max(np.linalg.eigvals(np.stack(columns, axis=1)).real))


def _numbers(state: Equilibrium | MixedFilm | None, flash: bool) -> tuple[float, float, float]:
    """Friction and flash rises of a state, NaN where there is none."""
    if state is None or not np.all(np.ravel(state.status) == "ok"):
        return (math.nan,) * 3
    if isinstance(state, MixedFilm):
        return float(state.mu), 0.0, 0.0
    mu = float(np.ravel(state.outputs["mu"])[0])
    if not flash:
        return mu, 0.0, 0.0
    share = float(np.ravel(state.particle_load_share)[0])
    rises = [float(np.ravel(state.outputs[f"dT_{kind}_load"])[0]) for kind in ("ss", "sa")]
    on_asperities = rises[0] if share < 1 else 0.0
    on_particles = rises[1] if share > 0 else 0.0
    return mu, (1 - share) * on_asperities + share * on_particles, on_particles


# ------------------------------------------------------------------ the answer
@takes_units
def coupled(
    contact: Contact,
    *,
    pressure: float | None = None,
    sliding_speed: float | None = None,
    film: FilmConditions | None = None,
    feedback: Sequence[Law],
    cooling: ThermalPath | HalfSpaces | None = None,
    flash: bool = False,
    limits: Literal["both", "speed", "load"] = "both",
) -> Coupled:
    r"""States in which a contact and the temperature that its friction makes agree.

    .. math:: T = T_{cold} + R\,q, \qquad q = \mu(T)\,p\,v, \qquad
              g = \frac{\partial T_{out}}{\partial T_{in}}

    A state is stable where the loop gain g is below 1. Where g reaches 1 at a rising speed, the
    stable state meets an unstable one and both end. Above the last such end there is no state: what
    comes then is heating without a stop, a seizure as far as this model can say.

    Parameters
    ----------
    contact : Contact
        With `outputs.Friction`.
    pressure : float
        Nominal pressure p [Pa].
    sliding_speed : float
        v [m/s].
    film : FilmConditions, instead of pressure and sliding_speed
        A lubricated contact with one speed and a ``slide_roll`` > 0, and an oil with an Eyring
        stress; p is its nominal Hertz pressure and v = slide_roll · speed.
    feedback : sequence of JunctionGrowth, Softening, Thinning
        What acts back: see `thirdbody.systems.feedback`.
    cooling : ThermalPath or HalfSpaces
        Where the heat goes; needed by `Softening` and `Thinning`.
    flash : bool, optional
        Surfaces take the mean temperature of all spots by load, and particles that of their own
        spots, in place of the mean temperature of the surfaces. Bodies need thermal data.
    limits : {"both", "speed", "load"}, optional
        Along what the end of the stable state is sought.

    Returns
    -------
    Coupled
        Every state of the branch that begins cold, with loop gain and stability, and
        ``seizure_speed`` and ``seizure_load``.

    Raises
    ------
    InvalidValue
        One sentence for each input that is missing or does not fit.
    NoEquilibrium
        The contact has no state even where it is cold.

    Warns
    -----
    RangeWarning
        What `solve` warns of in the stable state, and guesses in the feedback.

    Notes
    -----
    The branch is followed by pseudo-arclength from a speed at which nothing warms, over its folds,
    up to 0.999 of the way to the first melting point (500 K of rise where nothing melts), or until
    more than half of the area touches. With one temperature (without ``flash``) all states hang
    together on it, because each temperature has one speed; with two, branches that never meet it
    are not seen. Slopes between the steps show folds that a step goes over; of two folds less than
    0.0002 of the largest rise apart nothing may be seen. Friction jumps where the hardness of one
    surface comes to ``hardness_ratio`` times that of the other, which then begins to be ploughed:
    the branch goes on behind the jump, and a warning says where it is. A fold is known to 1e-8 of
    its speed (measured against closed forms). E, ν, τ and the roughness stay as they are.

    References
    ----------
    The balance of heat is Blok's (1937); folds by Keller's continuation.

    Examples
    --------
    >>> import warnings; warnings.simplefilter("ignore")
    >>> import thirdbody as tb
    >>> from thirdbody.systems import feedback
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    ...                      outputs=tb.outputs.Friction(tau_ss=580e6))
    >>> answer = tb.equilibria.coupled(contact, pressure=5e6, sliding_speed=2.0,
    ...     feedback=[feedback.Softening(T_melt=1793, T_0=293, exponent=1.03)],
    ...     cooling=feedback.ThermalPath(h_1=5e3, h_2=5e3, T_1=293, T_2=293), limits="speed")
    >>> for each in answer.states:
    ...     print(f"{each.T:.0f} K, μ = {each.mu:.3f}, loop gain {each.loop_gain:.2f}")
    456 K, μ = 0.163, loop gain 0.07
    1670 K, μ = 1.377, loop gain 11.20
    >>> print(f"stable up to {answer.seizure_speed:.3g} m/s")
    stable up to 6.29 m/s
    """
    need_one("limits", limits, "both", "speed", "load")
    laws = tuple(feedback)
    _refuse(contact, pressure, sliding_speed, film, laws, cooling, flash)
    if film is not None:
        assert film.slide_roll is not None
        p, v = film.nominal_pressure(contact), film.slide_roll * film.speed[0]
    else:
        assert pressure is not None
        assert sliding_speed is not None
        p, v = float(pressure), float(sliding_speed)
    loop = _loop(contact, laws, cooling, film, flash, v)
    notes = [note for law in laws if isinstance(law, JunctionGrowth) for note in law.notes()]
    if loop.cooling is None:
        return _without_heat(loop, v, p, notes)
    walks = {name: Walk(loop, name, v, p) for name in ("speed", "load") if limits in ("both", name)}
    first = next(iter(walks.values()))
    states = tuple(_state(loop, x, v, p) for x in first.states())
    notes += [note for walk in walks.values() for note in walk.notes()]
    speed, speed_limit = walks["speed"].end() if "speed" in walks else UNASKED
    load, load_limit = walks["load"].end() if "load" in walks else UNASKED
    return Coupled(
        states=states,
        seizure_speed=speed,
        seizure_load=load,
        speed_limit=speed_limit,
        load_limit=load_limit,
        branch=walks["speed"].columns() if "speed" in walks else {},
        branch_of_load=walks["load"].columns() if "load" in walks else {},
        warnings=_warn(states, notes),
    )


UNASKED = (math.nan, "not asked for")
"""The end of the stable state along what `coupled` was not asked to follow."""


def _refuse(
    contact: Contact,
    pressure: float | None,
    sliding_speed: float | None,
    film: FilmConditions | None,
    laws: tuple[Law, ...],
    cooling: ThermalPath | HalfSpaces | None,
    flash: bool,
) -> None:
    """Name every input of `coupled` that is missing or does not fit."""
    out = _operating_problems(pressure, sliding_speed, film, flash)
    if friction_of(contact) is None:
        rule = "needs outputs.Friction, whose heat acts back"
        out.append(Problem("contact.outputs", rule, code=Mistake.MISSING))
    if not laws:
        rule = "is empty: give JunctionGrowth, Softening or Thinning"
        out.append(Problem("feedback", rule, code=Mistake.EMPTY))
    for law in laws:
        if isinstance(law, JunctionGrowth):
            out += growth_problems(law, contact)
        elif not isinstance(law, Softening | Thinning):
            rule = f": {law!r} is no law of thirdbody.systems.feedback"
            out.append(Problem("feedback", rule, code=Mistake.KIND))
        elif cooling is None:
            rule = f"is missing: {type(law).__name__} needs to know where heat goes"
            out.append(Problem("cooling", rule, code=Mistake.MISSING))
        if isinstance(law, Thinning) and film is None:
            rule = ": Thinning changes an oil, and there is no film"
            out.append(Problem("feedback", rule, code=Mistake.IDLE))
        if isinstance(law, Softening) and law.body == "particles" and not contact.populations:
            rule = ": Softening of particles, and the contact has none"
            out.append(Problem("feedback", rule, code=Mistake.IDLE))
    if cooling is not None:
        out += cooling.needs(contact)
    if out:
        raise InvalidValue(*out)


def _operating_problems(
    pressure: float | None, sliding_speed: float | None, film: FilmConditions | None, flash: bool
) -> list[str]:
    """Why load and speed are not known."""
    if film is None:
        operating_values = {"pressure": pressure, "sliding_speed": sliding_speed}
        out: list[str] = [
            Problem(name, "is missing", code=Mistake.MISSING)
            for name, value in operating_values.items()
            if value is None
        ]
        return out + [
            Problem(name, "must be a number > 0", f"{value:g}", code=Mistake.KIND)
            for name, value in operating_values.items()
            if value is not None and not (math.isfinite(value) and value > 0)
        ]
    out = []
    if pressure is not None or sliding_speed is not None:
        rule = ": give it, or pressure and sliding_speed; not both"
        out.append(Problem("film", rule, code=Mistake.CLASH))
    if len(film.speed) != 1 or not film.slide_roll:
        rule = ": one speed and a slide_roll > 0 are needed"
        out.append(Problem("film", rule, code=Mistake.SHAPE))
    if film.oil.eyring_stress is None:
        rule = "is missing: without it the film has no friction"
        out.append(Problem("film.oil.eyring_stress", rule, code=Mistake.MISSING))
    if flash:
        rule = "is for dry contacts: leave it out, or leave film out"
        out.append(Problem("flash", rule, "True", code=Mistake.CLASH))
    return out


def _loop(
    contact: Contact,
    laws: tuple[Law, ...],
    cooling: ThermalPath | HalfSpaces | None,
    film: FilmConditions | None,
    flash: bool,
    v: float,
) -> _Loop:
    """The loop of a contact, from its temperature without friction to that at which one melts."""
    if cooling is None or all(isinstance(law, JunctionGrowth) for law in laws):
        return _Loop(contact, laws, None, film, False, 0.0, 1.0)
    path = cooling.bound_to(contact)
    cold = path.temperature(0.0, v=v)
    melts = [law.T_melt for law in laws if isinstance(law, Softening)]
    if melts and min(melts) <= cold:
        raise InvalidValue(
            f"feedback: T_melt = {number(min(melts))} must be above the temperature without "
            f"friction, {number(cold)}; are both in K, or both in °C?",
            code=Mistake.ORDER,
        )
    span = LAST * (min(melts) - cold) if melts else WARMEST
    return _Loop(contact, laws, path, film, flash, cold, span)


def _without_heat(loop: _Loop, v: float, p: float, notes: list[Note]) -> Coupled:
    """The answer where no law asks for a temperature."""
    nothing = "none: no feedback depends on the temperature"
    states = (_state(loop, np.zeros(1), v, p),)
    return Coupled(
        states=states,
        seizure_speed=math.nan,
        seizure_load=math.nan,
        speed_limit=nothing,
        load_limit=nothing,
        branch={},
        branch_of_load={},
        warnings=_warn(states, notes),
    )


def _state(loop: _Loop, x: Array, v: float, p: float) -> CoupledState:
    """The state at unknowns."""
    mu, *_ = loop.numbers(x, v, p)
    T, T_particles = loop.temperatures(x)
    contact = loop.warm_contact(T, T_particles, v)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        state = loop.solve_state(T, T_particles, v, p, warns=True)
    if contact is None or state is None:
        raise NoEquilibrium("the contact has no state at this speed and load")
    has_cooling = loop.cooling is not None
    gain = loop.gain(x, v, p) if has_cooling else 0.0
    return CoupledState(
        T=T if has_cooling else math.nan,
        T_particles=T_particles if has_cooling else math.nan,
        T_bulk=loop.bulk(mu, v, p) if has_cooling else math.nan,
        mu=mu,
        heat=mu * p * v,
        H_1=contact.surfaces.first.H,
        H_2=contact.surfaces.second.H,
        loop_gain=gain,
        stable=gain < 1,
        state=state,
    )


def _warn(states: tuple[CoupledState, ...], notes: list[Note]) -> tuple[str, ...]:
    """Warn of what is a guess, and of what `solve` says of the stable state."""
    stable = next((state for state in states if state.stable), None)
    every = [*notes, *(stable.state.warnings if stable else ())]
    for note in every:
        tell_of_range(note)
    return tuple(every)
