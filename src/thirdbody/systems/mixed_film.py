r"""Mixed lubrication: a film, asperities and particles carry one load together.

Johnson, Greenwood and Poon: the film carries the part 1/γ of the load, as if load and modulus were
γ times smaller, and its volume sets the mean gap between the rough surfaces; the solids carry the
rest at that gap.

.. math::

    p_{ss}(h) + p_{sa}(h) = \bar p\,(1 - 1/\gamma), \qquad
    h_T = h_c(w/\gamma, E'/\gamma) = \sigma[\varphi(t) + t\,\Phi(t)], \quad t = h/\sigma

In the elastic-piezoviscous limit h_c does not depend on γ: the film sets the gap whoever carries
the load. Particles then add contacts; in a dry contact, where the load sets the gap, they lift the
surfaces instead.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from scipy import special

from ..contact.contact import Contact
from ..contact.interface import interface
from ..equilibrium.columns import CODE, Equilibrium
from ..equilibrium.load_scan import load_scan
from ..equilibrium.solve import solve
from ..equilibrium.status import STATUS_CODE, Status
from ..errors import (
    InvalidValue,
    Mistake,
    NoEquilibrium,
    Note,
    Problem,
    RangeWarning,
    note_of,
    tell_of_range,
)
from ..numerics.roots import bracketed_root
from ..populations.heights import GaussianHeights
from ..quantities.carried import takes_units
from ..quantities.record import StateRecord, column, declared_columns
from .film_formulas import AbstractFilm, Line, Oil, Operation, Point, full_range

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Number = float | Array

__all__ = ["MixedFilm", "height_of", "mean_gap", "mixed_film"]


def __dir__() -> list[str]:
    return sorted(__all__)


BOUNDARY, MIXED, FULL = "boundary", "mixed", "full film"
FEW, MOST = 0.01, 0.99
"""Default shares of the solids below which a film is full, and above which it is boundary."""
NEAR = 4e-16
"""Relative width of a bracket that holds two neighbours among numbers at the most."""
LEAST = 1e-18
"""Least ln γ: below, the solids carry nothing."""
LONGEST = 96.0
"""Largest ln γ searched: beyond, the film carries nothing."""
DEEPEST = -4.0
"""Lowest separation from the mean asperity height at which solids are evaluated, in σ."""


@takes_units
def mean_gap(h: ArrayLike, *, sigma: float) -> Array:
    r"""Mean gap of a rough surface against a plane at height h: :math:`\sigma[\varphi+t\Phi]`.

    Parameters
    ----------
    h : float or array
        Height above the mean plane [m].
    sigma : float
        RMS height of the equivalent Gaussian surface [m].

    Returns
    -------
    array
        :math:`h_T = \int_{-\infty}^h (h-z)\,p(z)\,dz` [m].

    Examples
    --------
    >>> from thirdbody.systems.mixed_film import mean_gap
    >>> round(float(mean_gap(1.0, sigma=1.0)), 6)
    1.083315
    """
    t = np.asarray(h, float) / sigma
    return sigma * _gap(t)


def _gap(t: Array) -> Array:
    """φ(t) + tΦ(t)."""
    return np.exp(-0.5 * t * t) / math.sqrt(2 * math.pi) + t * special.ndtr(t)


@takes_units
def height_of(gap: ArrayLike, *, sigma: float) -> Array:
    r"""Height above the mean plane at which a rough surface has this mean gap.

    .. math:: \sigma[\varphi(t) + t\,\Phi(t)] = h_T, \qquad h = \sigma t

    The inverse of `mean_gap`; relative error 1e-13 for gaps from 1e-6 to 1e6 σ.

    Parameters
    ----------
    gap : float or array
        Mean gap h_T [m], > 0.
    sigma : float
        RMS height σ of the equivalent Gaussian surface [m].

    Returns
    -------
    array
        h [m].

    Examples
    --------
    >>> from thirdbody.systems.mixed_film import height_of, mean_gap
    >>> float(height_of(mean_gap(63e-9, sigma=100e-9), sigma=100e-9)).__round__(15)
    6.3e-08
    """
    y = np.asarray(gap, float) / sigma
    t = np.where(y > 1, y, np.minimum(y, 0.0))
    for _ in range(60):
        # ln(φ + tΦ) is concave: Newton's steps are monotone from the second on
        value = _gap(t)
        step = np.log(value / y) * value / special.ndtr(t)
        t = t - step
        if np.all(np.abs(step) <= 1e-15 * (1 + np.abs(t))):
            break
    return sigma * t


def height_of_one(gap: float, sigma: float) -> float:
    """As `height_of`, of one gap, in numbers of Python."""
    y = gap / sigma
    t = y if y > 1 else min(y, 0.0)
    for _ in range(60):
        below = 0.5 * math.erfc(-t / math.sqrt(2))
        value = math.exp(-0.5 * t * t) / math.sqrt(2 * math.pi) + t * below
        step = math.log(value / y) * value / below
        t -= step
        if abs(step) <= 1e-15 * (1 + abs(t)):
            break
    return sigma * t


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class MixedFilm(StateRecord):
    r"""A lubricated contact with particles: floats for one speed and load, arrays (N,) for several.

    .. math:: \frac1\gamma + \frac{F_{ss}}{F} + \frac{F_{sa}}{F} = 1, \qquad
              \mu = \mu_f + \mu_{ss} + \mu_{sa}

    Tractions are NaN unless the oil has an Eyring stress, the contact carries `outputs.Friction`,
    and sliding is given.

    Attributes
    ----------
    speed, load : float or array (N,)
        Mean entrainment speed u [m/s] and load w [N].
    pressure : float or array (N,)
        Nominal pressure of film and solids, that of the dry smooth bodies [Pa].
    h, h_T, h_smooth : float or array (N,)
        Separation from the mean surface plane h [m]; mean gap, which is the film thickness,
        h_T [m]; film thickness of smooth bodies under the whole load h_c [m].
    lambda_ratio, H, h_over_x : float or array (N,)
        h_T/σ, h/σ, and h over the largest mean diameter [1]; the last is NaN without particles.
    gamma : float or array (N,)
        Load over load on the film γ [1].
    film_share, ss_share, sa_share : float or array (N,)
        Shares of the load on film, asperities and particles [1].
    A_t, A_ss, A_sa : float or array (N,)
        Real area of solids, of asperities, of particles on surface 1, per nominal area [1].
    mu, mu_film, mu_ss, mu_sa : float or array (N,)
        Traction coefficient and its parts [1].
    viscosity : float or array (N,)
        η at the pressure of the film [Pa s].
    regime : str or array (N,)
        "boundary", "mixed" or "full film", by the share of the solids.
    residual : float or array (N,)
        Imbalance of the shares |1 − their sum| [1].
    status : str or array (N,)
        "ok", or why the numbers of the solids are no answer, as in `Equilibrium`.
    status_code : int or array (N,)
        `thirdbody.results.Status` of each, of which `status` is the sentence.
    state : Equilibrium
        The dry side: the contact at the same separation.
    warnings : tuple of str
        Where the model is extrapolated.

    Examples
    --------
    >>> import warnings; warnings.simplefilter("ignore")
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> found = tb.films.mixed_film(
    ...     contact,
    ...     conjunction=tb.films.Point(R=9.5e-3),
    ...     load=20.0,
    ...     speed=0.5,
    ...     oil=tb.films.Oil(eta=0.02, alpha=2e-8),
    ... )
    >>> found.regime, round(found.film_share + found.solid_share, 12)
    ('mixed', 1.0)
    """

    more_columns = {CODE: STATUS_CODE}
    speed: Number = column("u", "m/s", "mean entrainment speed")
    load: Number = column("w", "N", "load")
    pressure: Number = column("p", "Pa", "nominal pressure of film and solids")
    h: Number = column("h", "m", "separation of the mean planes")
    h_T: Number = column("h_T", "m", "mean gap, and film thickness")
    h_smooth: Number = column("h_c", "m", "film thickness of smooth bodies under the whole load")
    lambda_ratio: Number = column("λ", "1", "film thickness h_T over σ")
    H: Number = column("H", "1", "separation h over σ")
    h_over_x: Number = column("h/x_a", "1", "separation h over the largest mean diameter")
    gamma: Number = column("γ", "1", "load over load on the film")
    film_share: Number = column("1/γ", "1", "load share of the film")
    ss_share: Number = column("F_ss/F", "1", "load share of asperities")
    sa_share: Number = column("F_sa/F", "1", "load share of particles")
    A_t: Number = column("A_t*", "1", "real contact area of solids")
    A_ss: Number = column("A_ss*", "1", "real area of asperities")
    A_sa: Number = column("A_sa*", "1", "real area of particles on surface 1")
    mu: Number = column("μ", "1", "traction coefficient")
    mu_film: Number = column("μ_f", "1", "part of μ: shear of the film")
    mu_ss: Number = column("μ_ss", "1", "part of μ: asperities")
    mu_sa: Number = column("μ_sa", "1", "part of μ: particles")
    viscosity: Number = column("η_p", "Pa s", "viscosity at the pressure of the film")
    regime: Any = column("regime", "", "boundary, mixed or full film, by the share of the solids")
    residual: Number = column("r", "1", "imbalance of the shares |1 − their sum|")
    status: Any = column("status", "", "ok, or why the numbers of the solids are no answer")
    state: Equilibrium = field(repr=False)
    warnings: tuple[str, ...] = ()

    @property
    def status_code(self) -> int | NDArray[np.int8]:
        """`thirdbody.results.Status` of each state, of which `status` is the sentence."""
        return self.state.status_code

    @property
    def solid_share(self) -> Number:
        """Load share of asperities and particles [1]."""
        return self.ss_share + self.sa_share

    @takes_units
    def regimes(self, *, few: float = FEW, most: float = MOST) -> str | NDArray[np.str_]:
        """Regime with other thresholds of the solids' share of the load."""
        return _regimes(self.solid_share, few, most)


COLUMNS = declared_columns(MixedFilm)
"""Symbol, unit and meaning of every column."""


def _regimes(solids: Number, few: float, most: float) -> str | NDArray[np.str_]:
    solids = np.asarray(solids)
    out = np.where(solids > most, BOUNDARY, np.where(solids < few, FULL, MIXED))
    return out if out.ndim else str(out)


@takes_units
def mixed_film(
    contact: Contact,
    *,
    conjunction: Point | Line,
    oil: Oil,
    load: ArrayLike,
    speed: ArrayLike,
    slide_roll: float | None = None,
    film: AbstractFilm | None = None,
    hertz: Literal["mean", "maximum"] = "mean",
    few: float = FEW,
    most: float = MOST,
) -> MixedFilm:
    r"""Film, gap, load shares, real area and traction of a lubricated contact with particles.

    Solves :math:`p_{ss}(h) + p_{sa}(h) = \bar p(1 - 1/\gamma)` for ln γ, with the gap h that the
    film :math:`h_c(w/\gamma, E'/\gamma)` leaves.

    .. math:: \mu = (1 - A_t)\frac{\tau}{\bar p} + \frac{p_{ss} + p_{sa}}{\bar p}\mu_s, \qquad
              \tau = \tau_E \operatorname{asinh}\frac{\eta(\bar p/\gamma)\,u_s}{h_T\,\tau_E}

    Parameters
    ----------
    contact : Contact
        Roughness, surfaces and particles; with `outputs.Friction` its solids have a traction.
    conjunction : films.Point or films.Line
        The bodies.
    oil : films.Oil
    load : float or array (N,)
        w [N].
    speed : float or array (N,)
        Mean entrainment speed u [m/s].
    slide_roll : float, optional
        Sliding over entrainment speed u_s/u [1]; without it there is no traction. Zero is pure
        rolling: no traction either, but the number 0.
    film : films.AbstractFilm, optional
        The formula; `films.NijenbanningVennerMoes` or `films.MoesLine` by default.
    hertz : {"mean", "maximum"}, optional
        Which Hertz pressure is nominal.
    few, most : float, optional
        Shares of the solids below which the film is full, and above which it is boundary [1].

    Returns
    -------
    MixedFilm
        Floats for numbers, arrays for arrays.

    Raises
    ------
    InvalidValue
        A value that is not positive, a film formula for another shape, an unknown word.
    NoEquilibrium
        The solids carry more than the load at every gap that a film leaves.

    Warns
    -----
    RangeWarning
        Film thinner than σ (no flow factors are applied), a formula outside its regime, and what
        `solve` warns of.

    Notes
    -----
    The root is unique where solids carry less at larger gaps; ln γ is found to 4e-16 of it.

    References
    ----------
    Johnson, Greenwood, Poon 1972, Wear 19, 91, doi:10.1016/0043-1648(72)90445-0 (from memory: not
    confirmed in a source).

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ball, oil = tb.films.Point(R=9.5e-3), tb.films.Oil(eta=0.02, alpha=2e-8)
    >>> import warnings; warnings.simplefilter("ignore")
    >>> state = tb.films.mixed_film(
    ...     contact, conjunction=ball, oil=oil, load=20.0, speed=[0.02, 0.5]
    ... )
    >>> state.film_share.round(3).tolist(), state.regime.tolist()
    ([0.01, 0.535], ['boundary', 'mixed'])
    """
    w, u, scalar = _loads_and_speeds(load, speed)
    bodies = check_lubricated(contact, conjunction, oil, w, film, slide_roll, hertz, (few, most))
    sigma, p = contact.roughness.sigma, bodies.p

    def excess(x: Array) -> Array:
        h = height_of(bodies.thickness(u, np.exp(x)), sigma=sigma)
        return bodies.solid_share(h) + np.expm1(-x)

    x = _root(excess, len(w), u)
    h_T = bodies.thickness(u, np.exp(x))
    h = height_of(h_T, sigma=sigma)
    d = h - interface(contact).mean_plane
    if interface(contact).one_field and np.any(deep := d < bodies.floor):
        _refuse_deep(contact, float(u[deep].max()))
    state, notes = _solve_heard(contact, d)
    notes += _ranges(bodies, u, h_T / sigma)

    film_share = np.exp(-x)
    ss, sa = (
        np.asarray(F_star) * contact.E_ss / p for F_star in (state.F_ss_star, state.F_sa_star)
    )
    sizes = [population.diameter.mean_diameter for population in contact.populations]
    columns: dict[str, Any] = {
        "speed": u,
        "load": w,
        "pressure": p,
        "h": h,
        "h_T": h_T,
        "h_smooth": bodies.thickness(u, np.ones_like(x)),
        "lambda_ratio": h_T / sigma,
        "H": h / sigma,
        "h_over_x": h / max(sizes) if sizes else np.full_like(h, np.nan),
        "gamma": np.exp(x),
        "film_share": film_share,
        "ss_share": ss,
        "sa_share": sa,
        "A_t": state.A_t,
        "A_ss": state.A_ss,
        "A_sa": state.A_sa,
        **_traction(oil, state, slide_roll, u, h_T, p * film_share, p, (ss, sa)),
        "viscosity": oil.at_pressure(p * film_share),
        "regime": _regimes(ss + sa, few, most),
        "residual": np.abs(film_share + (ss + sa) - 1),
        "status": np.asarray(state.status, dtype=str),
    }
    for sentence in notes:
        tell_of_range(sentence)
    if scalar:
        columns = {name: np.asarray(values)[0].item() for name, values in columns.items()}
        state, _ = _solve_heard(contact, float(d[0]))
    return MixedFilm(**columns, state=state, warnings=tuple(dict.fromkeys(notes)))


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Lubricated:
    """Bodies, oil and loads, at any speed.

    Attributes
    ----------
    w : array (N,)
        Load [N].
    p : array (N,)
        Nominal pressure of film and solids [Pa].
    """

    contact: Contact
    conjunction: Point | Line
    oil: Oil
    film: AbstractFilm
    w: Array
    p: Array

    def operation(self, u: Array, gamma: float | Array = 1.0) -> Operation:
        """What a film formula asks for, as if load and modulus were γ times smaller."""
        return Operation(
            load=self.conjunction.intensity(self.w) / gamma,
            speed=u,
            eta=self.oil.eta,
            alpha=self.oil.alpha,
            R=self.conjunction.R,
            E=2 * self.contact.E_ss / gamma,
            ratio=self.conjunction.ratio,
        )

    def thickness(self, u: Array, gamma: Array) -> Array:
        """The film as if load and modulus were γ times smaller [m]."""
        return np.asarray(self.film.central(**self.operation(u, gamma)))

    @property
    def floor(self) -> float:
        """Separation d below which all asperities are crushed, or the law ends [m]."""
        skin = interface(self.contact).asperities
        return float(max(skin.centre + DEEPEST * self.contact.roughness.sigma, skin.deepest))

    def solid_share(self, h: Array) -> Array:
        """Load of asperities and particles at h above the mean plane [m], over the load."""
        solids = interface(self.contact)
        return solids.load(np.maximum(h - solids.mean_plane, self.floor))[:, 0] / self.p


def _refuse_deep(contact: Contact, speed: float) -> None:
    """A gap that is narrower than the law of one field knows."""
    raise NoEquilibrium(
        f"no equilibrium at speed = {speed:g} m/s: the film leaves a gap below "
        f"{interface(contact).why_lowest}, and what the solids carry is not known; take a higher "
        "speed or a smaller load",
        Status.TOO_DEEP,
    )


def check_lubricated(
    contact: Contact,
    conjunction: Point | Line,
    oil: Oil,
    w: Array,
    film: AbstractFilm | None,
    slide_roll: float | None,
    hertz: str,
    shares: tuple[float, float],
) -> Lubricated:
    """Arguments of `mixed_film`, checked, with loads (N,)."""
    film = film or full_range(getattr(conjunction, "shape", "point"))
    _check(contact, conjunction, oil, film, slide_roll, hertz, shares)
    dry = conjunction.hertz(w, E=2 * contact.E_ss)
    p = np.asarray(dry.mean if hertz == "mean" else dry.maximum)
    return Lubricated(contact=contact, conjunction=conjunction, oil=oil, film=film, w=w, p=p)


def _solve_heard(contact: Contact, d: float | Array) -> tuple[Equilibrium, list[str]]:
    """States at separations d [m], and what they warn of."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = solve(contact, d=d)
    return state, [
        note_of(warning.message) for warning in heard if issubclass(warning.category, RangeWarning)
    ]


def _loads_and_speeds(load: ArrayLike, speed: ArrayLike) -> tuple[Array, Array, bool]:
    """Loads and speeds of every state, and whether there is one."""
    problems = []
    values = []
    for name, unit, value in (("load", "N", load), ("speed", "m/s", speed)):
        try:
            array = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            problems.append(
                Problem(
                    name,
                    f"must be a number or an array of numbers [{unit}]",
                    repr(value),
                    code=Mistake.KIND,
                )
            )
            continue
        if array.ndim > 1 or not array.size:
            problems.append(
                Problem(
                    "",
                    f"{name} has shape {array.shape}; give a number or a 1-D array",
                    code=Mistake.SHAPE,
                )
            )
        elif not np.all(np.isfinite(array) & (array > 0)):
            bad = float(array[~(np.isfinite(array) & (array > 0))].flat[0])
            hint = "; without motion there is no film: use solve" if name == "speed" else ""
            problems.append(
                Problem(
                    name,
                    f"must be finite and > 0 [{unit}]{hint}",
                    f"{bad:g}",
                    code=Mistake.RANGE,
                )
            )
        values.append(array)
    if problems:
        raise InvalidValue(*problems)
    try:
        w, u = np.broadcast_arrays(*values)
    except ValueError:
        raise InvalidValue(
            f"load {values[0].shape} and speed {values[1].shape} differ in length; "
            "each must be one or N",
            code=Mistake.SHAPE,
        ) from None
    return np.atleast_1d(w).astype(float), np.atleast_1d(u).astype(float), w.ndim == 0


def _check(
    contact: object,
    conjunction: object,
    oil: object,
    film: object,
    slide_roll: object,
    hertz: str,
    shares: tuple[float, float],
) -> None:
    problems = []
    if not isinstance(contact, Contact):
        problems.append(Problem("contact", "must be a Contact", repr(contact), code=Mistake.KIND))
    if not isinstance(conjunction, Point | Line):
        problems.append(
            Problem(
                "conjunction",
                "must be films.Point or films.Line, e.g. films.Point(R=10e-3)",
                repr(conjunction),
                code=Mistake.KIND,
            )
        )
    if not isinstance(oil, Oil):
        problems.append(
            Problem(
                "oil",
                "must be films.Oil, e.g. films.Oil(eta=0.04, alpha=2e-8)",
                repr(oil),
                code=Mistake.KIND,
            )
        )
    if not isinstance(film, AbstractFilm):
        problems.append(
            Problem(
                "film", "must be a film formula of thirdbody.films", repr(film), code=Mistake.KIND
            )
        )
    elif isinstance(conjunction, Point | Line) and film.shape != conjunction.shape:
        problems.append(
            Problem(
                "film",
                f"is for {film.shape} contacts, and the conjunction is a {conjunction.shape}",
                f"{film.name}",
                code=Mistake.BEYOND,
            )
        )
    if hertz not in ("mean", "maximum"):
        problems.append(
            Problem("hertz", "must be 'mean' or 'maximum'", repr(hertz), code=Mistake.OPTION)
        )
    if slide_roll is not None and not (
        isinstance(slide_roll, int | float) and math.isfinite(slide_roll) and slide_roll >= 0
    ):
        problems.append(
            Problem(
                "slide_roll", "must be one number >= 0 [1]", repr(slide_roll), code=Mistake.KIND
            )
        )
    if not 0 <= shares[0] <= shares[1] <= 1:
        problems.append(
            Problem(
                "",
                f"few, most = {shares[0]:g}, {shares[1]:g} must be shares with 0 <= few <= most "
                "<= 1",
                code=Mistake.RANGE,
            )
        )
    if problems:
        raise InvalidValue(*problems)


def _root(excess: Callable[[Array], Array], count: int, speed: Array) -> Array:
    """ln γ of every state, inside a bracket whose upper end is doubled until it holds."""
    low, high = np.full(count, LEAST), np.full(count, 12.0)
    while np.any(short := excess(high) >= 0):
        if np.any(high[short] >= LONGEST):
            slow = float(speed[short].min())
            raise NoEquilibrium(
                f"no equilibrium at speed = {slow:g} m/s: at every gap that this film leaves, "
                "asperities and particles carry more than the load; check viscosity and speed, or "
                "take a film formula of every regime"
            )
        low, high = np.where(short, high, low), np.where(short, 2 * high, high)
    return zeros_of_falling(excess, low, high)


def zeros_of_falling(excess: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Zeros of functions that fall, known of all at once; the nearer end where there is none."""
    x = low.copy()

    def of_some(value: Array, which: Array) -> Array:
        places = which.astype(int)
        x[places] = value
        return excess(x)[places]

    root = bracketed_root(of_some, low, high, (np.arange(len(low), dtype=float),), xrtol=NEAR)
    beyond = np.isnan(root)
    if np.any(beyond):
        root[beyond] = np.where(excess(low) >= 0, high, low)[beyond]
    return root


def _ranges(bodies: Lubricated, u: Array, ratio: Array) -> list[str]:
    """Notes on extrapolations, one sentence each; the ratio is that of film and σ."""
    conjunction, heights = bodies.conjunction, bodies.contact.roughness.heights
    at = full_range(conjunction.shape).asymptotes(**bodies.operation(u))
    out = bodies.film.warnings(at.regime, conjunction.ratio)
    if np.any(ratio < 1):
        what = (
            f"the film is down to {float(ratio.min()):.2g} sigma; below 1 sigma "
            "roughness hinders the flow, and no flow factors are applied"
        )
        out.append(Note(what, code="film.thin"))
    if heights != GaussianHeights():
        what = (
            "the mean gap of the film is that of a Gaussian surface, and the asperities here have "
            f"{type(heights).__name__}"
        )
        out.append(Note(what, code="film.heights"))
    if not load_scan(interface(bodies.contact)).monotone:
        what = "the load of these particles does not fall with the separation"
        action = "another balance may exist: look at roots of the contact"
        out.append(Note(what, code="branches", effect=1.0, action=action))
    return out


def _traction(
    oil: Oil,
    state: Equilibrium,
    slide_roll: float | None,
    u: Array,
    h_T: Array,
    film_pressure: Array,
    p: Array,
    shares: tuple[Array, Array],
) -> dict[str, Array]:
    """μ and its parts."""
    unknown = np.full_like(u, np.nan)
    ss = sa = shear = unknown
    if slide_roll is not None:
        stress = oil.shear_stress(slide_roll * u / h_T, pressure=film_pressure)
        shear = (1 - np.asarray(state.A_t)) * stress / p
        if "mu_ss" in state.outputs and "mu_sa" in state.outputs:
            ss, sa = (
                np.where(share > 0, np.asarray(state.outputs[name]) * share, 0.0) * (slide_roll > 0)
                for name, share in zip(("mu_ss", "mu_sa"), shares, strict=True)
            )
    return {"mu": shear + ss + sa, "mu_film": shear, "mu_ss": ss, "mu_sa": sa}
