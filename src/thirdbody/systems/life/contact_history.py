"""Histories with a contact: what it adds to those of the oil, and those of a dry contact."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.linalg import expm

from ...quantities.record import Column, TableRecord, Variable, with_names
from .breeding import reproduction_of, why_none, why_unknown
from .code_times import times_within
from .contact_course import coverage
from .dry_loop import DryLoop
from .film_loop import FilmLoop
from .history import MORE, SETTLES_TO, LifeEvent, LifeHistory, times_and_classes
from .kept_rates import KeptRates
from .ledger import IN_OIL, Ledger
from .linear_flow import dirt_gain, generations
from .loop import SURFACES, Loop
from .steady import describe_reproduction

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["ContactHistory", "DryHistory", "SteadyContact", "contact_columns", "steady_states"]

COLUMNS: dict[str, Column] = {
    "h": Column("h", "m", "separation from the mean plane"),
    "sigma": Column("σ", "m", "roughness"),
    "film_share": Column("s_f", "1", "share of the film in the load"),
    "ss_share": Column("s_ss", "1", "share of the asperities in the load"),
    "sa_share": Column("s_sa", "1", "share of the particles in the load"),
    "mu_solids": Column("μ_s", "1", "friction of the solids over the load"),
    "present": Column("N_c", "1", "loaded particles in one contact"),
    "covered": Column("c_p", "1", "projected area of the particles over that of the contact"),
    **{
        f"{name}_{side}": Column(f"{symbol},{side}", unit, f"{meaning} {side}")
        for side in SURFACES
        for name, symbol, unit, meaning in (
            ("wear", "w", "m", "wear depth of surface"),
            ("wear_rate", "dw/dt", "m/s", "wear depth per time of surface"),
            ("dents", "N_d", "1/m^2", "dents thrown per area of surface"),
            ("thrown", "c", "1", "area of dents thrown per area of surface"),
        )
    },
}
"""What a contact adds to a history, over time."""
NODES = 60
"""Of the scan for steady states."""
BALANCED = 1e-6
"""Relative imbalance of loads below which a change of sign is a state."""
NEVER = 1e-12
"""Slowest rate over the fastest below which particles never leave: rounding leaves as much of 0."""


class SteadyContact(NamedTuple):
    """A state in which the numbers no longer change; in ``steady()`` of a history."""

    numbers: Array
    """Particles per volume of oil [1/m³] or per area of a dry contact [1/m²], (K, M)."""
    code: str
    """ISO 4406 of the oil; "" of a dry contact."""
    h: float
    """Separation from the mean plane [m]."""
    wear_rate: tuple[float, float]
    """Wear depth per time of either surface, which goes on [m/s]."""
    stable: bool
    """Whether a small change dies out."""
    time: float
    """Until a hundredth of the way is left [s]; infinite where it is not stable."""


def contact_columns(
    loop: Loop, times: Array, states: list[Array], kept: KeptRates | None = None
) -> dict[str, Array]:
    """`COLUMNS` of states, (T,) each."""
    kept_rates, rows = KeptRates() if kept is None else kept, []
    for time, y in zip(times, states, strict=True):
        if isinstance(loop, FilmLoop):
            loop.now = float(time)
        rows.append(kept_rates.rate(loop, float(time), y, lambda y=y: _row_of(loop, y)))  # type: ignore[misc]
    return dict(zip(COLUMNS, np.array(rows).T, strict=True))


def _row_of(loop: Loop, y: Array) -> Array:
    """`COLUMNS` of one state."""
    values = _columns_of(loop, y)
    return np.array([values[name] for name in COLUMNS])


def _columns_of(loop: Loop, y: Array) -> dict[str, float]:
    gap = loop.find_gap(y)
    state, eta = loop.press_at(y, gap.d), loop.present(y, gap.d)
    assert isinstance(loop, DryLoop | FilmLoop)
    p = loop.pressure

    def total(name: str) -> float:
        return float(loop.columns(state, name) @ eta)

    spots = state.asperities
    friction = state.bare * (spots["shear"] + spots["plough"])
    friction += total("shear") + total("plough") + total("roll")
    out = {
        "h": gap.d + loop.tables.mean_plane(state.sigma),
        "sigma": state.sigma,
        "film_share": gap.film_share,
        "ss_share": state.bare * spots["force"] / p,
        "sa_share": total("load") / p,
        "mu_solids": friction / p,
        "present": total("loaded") * loop.one_area,
        "covered": coverage(loop, eta),
    }
    for side in SURFACES:
        for name in ("wear", "dents", "thrown"):
            out[f"{name}_{side}"] = float(y[loop.layout[f"{name}_{side}"]][0])
        out[f"wear_rate_{side}"] = loop.wear_rate(y, state, side)
    return out


# ------------------------------------------------------------------ steady states
def steady_states(loop: Loop, y: Array) -> tuple[SteadyContact, ...]:
    """Every state in which the numbers no longer change, with roughness and wear as in a state."""
    from scipy.optimize import brentq

    low, high = _scan_ends(loop, y)
    places = np.linspace(low, high, NODES + 1)
    values = np.array([_imbalance(loop, y, place) for place in places])
    out = []
    for i in np.flatnonzero(np.isfinite(values[:-1]) & np.isfinite(values[1:])):
        if values[i] * values[i + 1] < 0:
            place = brentq(
                lambda u: _imbalance(loop, y, u), places[i], places[i + 1], xtol=1e-16, rtol=1e-12
            )
            if abs(_imbalance(loop, y, float(place))) < BALANCED:  # else it jumps there
                out.append(_steady_at(loop, y, float(place)))
    return tuple(out)


def _scan_ends(loop: Loop, y: Array) -> tuple[float, float]:
    """Ends of the scan, in the unknown of the gap: from no particles on."""
    clean = y.copy()
    clean[loop.layout[loop.pool]] = 0.0
    before = loop.last
    loop.find_gap(clean)
    low = loop.last
    loop.last = before
    if isinstance(loop, FilmLoop):
        return max(low * (1 - 1e-9) - 1e-9, 0.0), 2 * max(low, before) + 0.5
    sigma = loop.sigma_of(y)
    return low - 1e-6 * sigma, float(loop.tables.tops[-1]) + 5 * sigma


def _separation(loop: Loop, y: Array, place: float) -> float:
    if isinstance(loop, FilmLoop):
        return loop.separation(place, loop.sigma_of(y))
    return place


def _numbers(loop: Loop, y: Array, d: float) -> Array | None:
    """Numbers that stay at a separation; None where they would grow for ever."""
    pool = loop.layout[loop.pool]
    state = y.copy()
    for _ in range(3):  # the shadow of particles may leave nothing to asperities
        rates = loop.rates(state, d)
        matrix = rates.matrix[pool, pool]
        slowest = float(np.max(np.linalg.eigvals(matrix).real))
        if slowest >= -NEVER * float(np.max(np.abs(np.diag(matrix)))):
            return None
        state[pool] = np.linalg.solve(-matrix, rates.constant[pool])
    return state


def _imbalance(loop: Loop, y: Array, place: float) -> float:
    """What the solids carry over what is left to them, less one; positive where n would grow."""
    d = _separation(loop, y, place)
    state = _numbers(loop, y, d)
    if state is None:
        return 1e3
    assert isinstance(loop, DryLoop | FilmLoop)
    eta = loop.shape_numbers(loop.present(state, d))
    share = loop.tables.load(d, eta=eta, sigma=loop.sigma_of(y))[0] / loop.pressure
    left = -math.expm1(-place) if isinstance(loop, FilmLoop) else 1.0
    return share - left


def _steady_at(loop: Loop, y: Array, place: float) -> SteadyContact:
    d, pool = _separation(loop, y, place), loop.layout[loop.pool]
    state = _numbers(loop, y, d)
    assert state is not None
    loop.last = place
    rates = loop.rates(state, d)
    change = rates.matrix @ state + rates.constant
    slowest = float(np.max(np.linalg.eigvals(_jacobian(loop, state)).real))
    numbers = loop.shape_numbers(state[pool]).T / _per(loop)
    code = ""
    if isinstance(loop, FilmLoop):
        code = loop.tables.classes.iso4406(np.maximum(numbers.sum(axis=1), 0.0))
    return SteadyContact(
        numbers=numbers,
        code=code,
        h=d + loop.tables.mean_plane(loop.sigma_of(y)),
        wear_rate=(
            float(change[loop.layout["wear_1"]][0]),
            float(change[loop.layout["wear_2"]][0]),
        ),
        stable=slowest < 0,
        time=math.log(SETTLES_TO) / slowest if slowest < 0 else math.inf,
    )


def _jacobian(loop: Loop, state: Array) -> Array:
    """How the rates of the numbers change with them [1/s], (J, J)."""
    time, pool = loop.now if isinstance(loop, FilmLoop) else 0.0, loop.layout[loop.pool]
    return loop.jacobian(time, state)[pool, pool]


def _per(loop: Loop) -> float:
    """What numbers of the pool are divided by: the volume of the oil, or the area."""
    return loop.volume_at(loop.now) if isinstance(loop, FilmLoop) else loop.setting.area


class _Breeding:
    """What the histories of contacts say of who breeds whom."""

    loop: Any
    last_state: Array
    births: Any
    losses: Array
    R0: Any

    def _describe(self, edges: Sequence[float], materials: tuple[str, ...]) -> str:
        why = ""
        if self.R0 == 0:
            why = why_none(self.loop, self.last_state)
        elif math.isnan(self.R0):
            why = why_unknown(self.births, self.losses, np.array(edges), materials)
        return describe_reproduction(self.R0, why=why)


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactHistory(_Breeding, LifeHistory):
    """A history of an oil and of contacts in it; made by `thirdbody.life`.

    As `LifeHistory`, with `COLUMNS` of the contact in ``more``; ``births`` and ``losses`` are
    those of the last state.
    """

    loop: FilmLoop
    last_state: Array
    losses: Array

    @property
    def _losses(self) -> Array:
        return self.losses

    @cached_property
    def R0(self) -> float:
        """Particles bred by one before it is removed, at the end of the history [1]."""
        assert self.births is not None
        return reproduction_of(self.births, self.losses)

    @property
    def reproduction(self) -> str:
        """What R_0 means, in words."""
        return self._describe(self.terms.classes.edges, tuple(self.terms.materials))

    @cached_property
    def _steady(self) -> tuple[SteadyContact, ...]:
        self.loop.now = float(self.times[-1])
        return steady_states(self.loop, self.last_state)

    def steady(self) -> tuple[SteadyContact, ...]:  # type: ignore[override]
        """Every state in which the oil no longer changes, debris counted; w and σ as at the end.

        None where particles grow for ever.
        """
        return self._steady

    @cached_property
    def code_times(self) -> tuple[float, ...]:
        """As of `LifeHistory`, with the contact as it is near the steady state."""
        if not self.steady():
            return LifeHistory.code_times.func(self)  # type: ignore[attr-defined]
        loop, steady = self.loop, self.steady()[0]
        end = steady.numbers.T.ravel()
        state = self.last_state.copy()
        state[loop.layout[loop.pool]] = end * _per(loop)
        jacobian = _jacobian(loop, state)
        away = self.numbers[0].T.ravel() - end
        exponentials: dict[float, Array] = {}

        def counts(time: float) -> Array:
            if (half := exponentials.get(time / 2)) is not None:
                exponentials[time] = half @ half
            elif time not in exponentials:
                exponentials[time] = expm(jacobian * time)
            now = loop.shape_numbers(end + exponentials[time] @ away).T
            return self.terms.classes.counted(now.sum(axis=1))

        ends = self.terms.classes.counted(steady.numbers.sum(axis=1))
        return times_within(counts, ends, first=self._first_time)

    @property
    def time_scales(self) -> dict[str, float]:
        """How long things take [s], by name; NaN for what never ends."""
        loop = self.loop
        along, _ = loop.bodies.conjunction.semi_axes(
            float(loop.bodies.w[0]), E=2 * loop.bodies.contact.E_ss
        )
        out = {"passage of a contact": 2 * float(along) / loop.film.speed}
        out |= LifeHistory.time_scales.fget(self)  # type: ignore[attr-defined]
        return out | wear_times(loop, self.last_state, self.more)


def wear_times(loop: Loop, y: Array, more: Mapping[str, tuple[Column, Array]]) -> dict[str, float]:
    """How long it takes to wear σ, and to run in [s]."""
    rate = max(float(more[f"wear_rate_{side}"][1][-1]) for side in SURFACES)
    sigma, law = loop.sigma_of(y), loop.setting.running_in
    out = {"wear of one σ": sigma / rate if rate > 0 else math.nan}
    if law is not None:
        both = sum(float(more[f"wear_rate_{side}"][1][-1]) for side in SURFACES)
        slope = abs(law.slope(sigma, separation=float(more["h"][1][-1])))
        left = abs(sigma - law.sigma_end)
        out["running-in"] = left / (slope * both) if slope * both > 0 else math.nan
    return out


@dataclass(frozen=True, eq=False, kw_only=True)
class DryHistory(_Breeding, TableRecord):
    """A history of a dry or greased contact; made by `thirdbody.life`.

    Attributes
    ----------
    times : array (T,)
        [s].
    numbers : array (T, K, M)
        Particles per area of the contact, by class and material [1/m²].
    materials : tuple of str
        Names of the kinds of particles.
    ledger : Ledger
        Where the mass came from and where it went; its "oil" is the contact.
    more : dict of str to tuple of Column and array (T,)
        `COLUMNS` of the contact.
    births, losses : array (J, J)
        𝒢 and 𝓛 of the last state [1/s].
    """

    in_columns = ("class", "material")
    in_dict = (
        *("times", ("edges", "loop.tables.classes.edges"), "materials", "numbers", "ledger"),
        *(("events", with_names("events")), MORE, "time_scales"),
        *("R0", "dirt_gain", "reproduction", "warnings"),
    )
    loop: DryLoop
    last_state: Array
    times: Array
    numbers: Array
    materials: tuple[str, ...]
    ledger: Ledger
    births: Array
    losses: Array
    events: tuple[LifeEvent, ...] = ()
    warnings: tuple[str, ...] = ()
    more: Mapping[str, tuple[Column, Array]] = field(default_factory=dict)

    @cached_property
    def R0(self) -> float:
        """Particles bred by one before it leaves, at the end of the history [1]."""
        return reproduction_of(self.births, self.losses)

    @property
    def reproduction(self) -> str:
        """What R_0 means, in words."""
        return self._describe(self.loop.tables.classes.edges, self.materials)

    @property
    def generations(self) -> Array:
        """Next-generation matrix: daughters of row i of a particle of column j [1], (J, J)."""
        return generations(self.losses, births=self.births)

    @property
    def dirt_gain(self) -> float:
        """Particles in the steady state over those without debris [1], with 𝒢 and 𝓛 of the end.

        Infinite where one breeds more than one; NaN where nothing arrives, or R_0 is not known.
        """
        source = self.loop.shape_numbers(self.loop.arrivals).T.ravel()
        if math.isnan(self.R0) or not np.any(source > 0):
            return math.nan
        return (
            dirt_gain(self.losses, births=self.births, source=source) if self.R0 < 1 else math.inf
        )

    def flows(self, *, rates: bool = False) -> list[tuple[str, str, float]]:
        """The flow table: from where, to where, and how much [kg].

        Parameters
        ----------
        rates : bool, optional
            Mean over the history [kg/s] in the place of the whole mass [kg].
        """
        over = self.times[-1] - self.times[0] if rates else 1.0
        here = {IN_OIL: "contact"}
        return [
            (here.get(start, start), here.get(end, end), mass / over)
            for start, end, mass in self.ledger.rows()
        ]

    @cached_property
    def _steady(self) -> tuple[SteadyContact, ...]:
        return steady_states(self.loop, self.last_state)

    def steady(self) -> tuple[SteadyContact, ...]:
        """Every state in which the numbers no longer change; wear and σ as at the end."""
        return self._steady

    @property
    def time_scales(self) -> dict[str, float]:
        """How long things take [s], by name; NaN for what never ends."""
        loop = self.loop
        crossing = loop.length / loop.setting.sliding_speed
        out = {"residence of what is held": crossing, "residence of what rolls": 2 * crossing}
        return out | wear_times(loop, self.last_state, self.more)

    @property
    def histories(self) -> xarray.Dataset:
        """Everything over time, as labelled data."""
        return self.to_dataset()

    def variables(self) -> dict[str, Variable]:
        """Numbers by class, masses, and what the contact does."""
        numbers = Column("η", "1/m^2", "particles per area of the contact")
        masses = {
            name.replace("in the oil", "in the contact"): mass
            for name, mass in self.ledger.over_time().items()
        }
        over_time = {name: (Column("", "kg", name), mass) for name, mass in masses.items()}
        over_time |= self.more
        return {
            "eta": Variable(("time", "class", "material"), self.numbers, numbers.labels),
            **{
                name: Variable(("time",), m, about.labels) for name, (about, m) in over_time.items()
            },
        }

    def coordinates(self) -> dict[str, Variable]:
        """Times, middles of the classes, names of the materials."""
        return times_and_classes(self.times, self.loop.tables.classes, self.materials)
