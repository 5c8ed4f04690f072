r"""Waviness under the roughness: two scales.

The wave is long against the distance of asperities, so that each place of it is a contact with
its own separation. A *rigid* wave, or a measured one, averages the pressure over its heights,

.. math:: \bar p = \langle F_t(d - \zeta)\rangle ,

an *elastic* one is flattened by the pressure it concentrates on its crests,

.. math:: h(x) = d - a_w\cos\frac{2\pi x}{\lambda_w} + u(x), \qquad p = F_t(h), \qquad
          \hat u_q = \frac{2\hat p_q}{E^*|q|} \quad (q \ne 0).

The mean displacement (q = 0) is left out: see `interaction.mean_interaction`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..contact.contact import Contact
from ..equilibrium.columns import CODE
from ..equilibrium.status import STATUS_CODE, Status
from ..errors import InvalidValue, Mistake, NoEquilibrium, Problem
from ..quantities.arguments import only_one
from ..quantities.carried import takes_units
from ..quantities.record import TableRecord, column
from .elastic_balance import (
    OUT_OF_REACH,
    WIDENED,
    Balance,
    Course,
    Grid,
    Skin,
    balance,
    crowded_warning,
    refuse_deep,
    to_series,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["WavyContact", "elastic_wave", "measured_wave", "rigid_wave"]


def __dir__() -> list[str]:
    return sorted(__all__)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class WavyContact(TableRecord):
    """A rough contact on a wavy surface.

    Made by `rigid_wave`, `elastic_wave` and `measured_wave`.

    Attributes
    ----------
    d : float
        Separation of the mean wave plane from the mean asperity height [m].
    pressure, F_star : float
        Nominal pressure averaged over the wave [Pa], and over E* [1].
    stiffness : float
        −dp/dd [Pa/m].
    x : array or None
        Place over the wavelength [1], 0 at the crest, 0.5 in the trough; None for a measured wave.
    height, weight : array
        Heights of the wave [m] and their share of the nominal area [1].
    gap, local_pressure : array
        Local separation [m] and pressure [Pa] at these heights.
    A_t, A_ss, A_sa : float or None
        Real area per nominal area [1]: total, of asperities, of particles; None for a plain
        pressure law.
    particle_load_share : float or None
        Load of the particles over the total load [1].
    resolution : float
        Last coefficients of the pressure over the largest [1]; 0 for a measured wave.
    crowded_share : float or None
        Share of the load at places where contacts have grown together, so that a model that counts
        them one by one has no answer [1]; None for a plain pressure law.
    status : str
        "ok", or a sentence that begins with "crowded".
    warnings : tuple of str
        Where the contact leaves the range of the model.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.waviness import rigid_wave
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> wavy = rigid_wave(contact, amplitude=150e-9, pressure=5e6)
    >>> bool(wavy.local_pressure.max() > wavy.pressure > wavy.local_pressure.min())
    True
    """

    more_columns = {CODE: STATUS_CODE}
    along = "height"
    d: float = column("d", "m", "separation of the mean wave plane")
    pressure: float = column("p", "Pa", "nominal pressure averaged over the wave")
    F_star: float = column("p/E*", "1", "the same over E*")
    stiffness: float = column("−dp/dd", "Pa/m", "stiffness")
    x: Array | None = column("x/λ_w", "1", "place over the wavelength, 0 at the crest")
    height: Array = column("ζ", "m", "height of the wave")
    weight: Array = column("", "1", "share of the nominal area at a height")
    gap: Array = column("h", "m", "local separation")
    local_pressure: Array = column("p(x)", "Pa", "local pressure")
    A_t: float | None = column("A_t*", "1", "real contact area")
    A_ss: float | None = column("A_ss*", "1", "real area of asperities")
    A_sa: float | None = column("A_sa*", "1", "real area of particles on surface 1")
    particle_load_share: float | None = column("F_sa/F_t", "1", "load share of particles")
    resolution: float = column("", "1", "last coefficients of the pressure over the largest")
    crowded_share: float | None = column(
        "", "1", "share of the load where contacts have grown together", default=None
    )
    status: str = column("status", "", "ok, or why its numbers are no answer", default="ok")
    warnings: tuple[str, ...] = ()

    @property
    def status_code(self) -> Status:
        """`thirdbody.results.Status`, of which ``status`` is the sentence."""
        return Status.OK if self.status == Status.OK.sentence else Status.CROWDED


@dataclass(frozen=True, slots=True)
class Wave:
    """A cosine wave; ``wavelength`` 0 is rigid."""

    amplitude: float
    wavelength: float
    E_star: float

    def extent(self, skin: Course, d: float) -> float:
        return 1.0

    def grid(self, n: int, extent: float) -> Grid:
        cosine, transform = to_series(n)
        theta = np.pi * (np.arange(n) + 0.5) / n
        # u_k = 2 p_k/(E* q_k), q_k = 2πk/λ
        k = np.arange(1, n)
        flat = np.cos(theta[:, None] * k) / k @ transform[1:]
        compliance = flat * (self.wavelength / (math.pi * self.E_star))
        x = theta / (2 * math.pi)
        return Grid(x, -self.amplitude * cosine, compliance, np.full(n, 1 / n))


@dataclass(frozen=True, eq=False, slots=True)
class Histogram:
    """A rigid wave known by its heights and their shares: the grid is fixed."""

    heights: Array
    weights: Array

    def solve(self, skin: Skin, d: float | None, load: float | None) -> Balance:
        if load is None:
            assert d is not None
            return self._balance_at(skin, d)
        low = high = skin.origin + float(np.max(self.heights))
        step = float(np.ptp(self.heights)) + (skin.step or abs(skin.one(low)[0] / skin.one(low)[1]))

        def excess(x: float) -> float:
            return self._balance_at(skin, x, bare=True).load - load

        for _ in range(WIDENED):
            if not excess(low) < 0:
                break
            low -= step
            step *= 1.5
        for _ in range(WIDENED):
            if not excess(high) > 0:
                break
            high += step
            step *= 1.5
        if excess(low) < 0 or excess(high) > 0:
            raise NoEquilibrium(OUT_OF_REACH.format(load=load, low=low, high=high))
        from scipy.optimize import brentq

        def miss(x: float) -> float:
            return math.log(max(self._balance_at(skin, x, bare=True).load, 1e-300) / load)

        return self._balance_at(skin, brentq(miss, low, high, xtol=1e-300, rtol=1e-15))

    def _balance_at(self, skin: Skin, d: float, bare: bool = False) -> Balance:
        gap = d - self.heights
        p, slope = skin(gap)
        if not bare:
            refuse_deep(skin, gap)
        grid = Grid(self.heights, -self.heights, np.zeros((0, 0)), self.weights)
        return Balance(
            d, grid, gap, p, float(self.weights @ p), float(self.weights @ slope), 0.0, 0.0
        )


def _result(skin: Skin, state: Balance, cosine: bool) -> WavyContact:
    grid = state.grid
    areas: dict[str, float | None] = dict.fromkeys(("A_t", "A_ss", "A_sa"))
    share = close = None
    status = "ok"
    if skin.solids is not None:
        fields = skin.solids.fields(state.gap)
        areas = {name: float(grid.weights @ fields[name]) for name in areas}
        share = float(grid.weights @ fields["F_sa"]) / state.load
        close, status = skin.crowded_places(fields["A_t"], grid.weights * state.pressure)
    return WavyContact(
        d=state.d,
        pressure=state.load,
        F_star=state.load / skin.E_star,
        stiffness=-state.slope,
        x=grid.x if cosine else None,
        height=-grid.base,
        weight=grid.weights,
        gap=state.gap,
        local_pressure=state.pressure,
        particle_load_share=share,
        resolution=state.tail,
        crowded_share=close,
        status=status,
        warnings=skin.warnings + crowded_warning(status),
        **areas,
    )


def _load(
    skin: Skin, d: float | None, pressure: float | None, F_star: float | None
) -> float | None:
    """The load [Pa]; None where the separation is given instead."""
    only_one(d=d, pressure=pressure, F_star=F_star)
    return pressure if F_star is None else F_star * skin.E_star


@takes_units
def rigid_wave(
    contact: Contact | Callable[..., Array],
    *,
    amplitude: float,
    d: float | None = None,
    pressure: float | None = None,
    F_star: float | None = None,
    E_star: float | None = None,
) -> WavyContact:
    r"""A rough surface on a rigid cosine wave.

    .. math:: \bar p = \frac{1}{2\pi}\int_0^{2\pi} F_t(d - a_w\cos\theta)\,d\theta

    Parameters
    ----------
    contact : Contact or callable
        The rough contact, particles included; or ``pressure(gap) -> (p, dp/dgap)`` over arrays.
    amplitude : float
        a_w [m]: half the height from trough to crest.
    d : float, optional
        Separation of the mean plane of the wave from the mean asperity height [m].
    pressure, F_star : float, optional
        Mean pressure [Pa] or F* [1]. Exactly one of the three.
    E_star : float, optional
        Contact modulus [Pa], with a callable only.

    Returns
    -------
    WavyContact

    Raises
    ------
    NoEquilibrium
        On the crest the gap would fall below −3 σ_s.

    Notes
    -----
    Provenance: derived. The wave is long against the distance of asperities.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.waviness import rigid_wave
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> wavy = rigid_wave(contact, amplitude=150e-9, pressure=5e6)
    >>> round(wavy.d * 1e9, 2), round(wavy.A_t / tb.solve(contact, pressure=5e6).A_t, 4)
    (272.75, 0.9735)
    """
    return elastic_wave(
        contact,
        amplitude=amplitude,
        wavelength=0.0,
        d=d,
        pressure=pressure,
        F_star=F_star,
        E_star=E_star,
    )


@takes_units
def elastic_wave(
    contact: Contact | Callable[..., Array],
    *,
    amplitude: float,
    wavelength: float,
    d: float | None = None,
    pressure: float | None = None,
    F_star: float | None = None,
    E_star: float | None = None,
) -> WavyContact:
    r"""A rough surface on a cosine wave that the contact pressure flattens.

    Parameters
    ----------
    contact, amplitude, d, pressure, F_star, E_star
        As in `rigid_wave`.
    wavelength : float
        λ_w [m]: zero is rigid; long waves are easily flattened.

    Returns
    -------
    WavyContact

    Notes
    -----
    Provenance: derived; solved by damped Newton steps on a cosine series that grows until it has
    converged. While the mean pressure is large against πE*a_w/λ_w the wave closes: the pressure
    becomes p + (πE*a_w/λ_w) cos θ and the gap uniform.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.waviness import elastic_wave
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> wavy = elastic_wave(contact, amplitude=150e-9, wavelength=1e-3, pressure=5e6)
    >>> round(wavy.d * 1e9, 2)
    249.02
    """
    for name, value in (("amplitude", amplitude), ("wavelength", wavelength)):
        if not (math.isfinite(value) and value >= 0):
            raise InvalidValue(Problem(name, "must be >= 0 [m]", repr(value), code=Mistake.RANGE))
    skin = Skin(contact, E_star)
    wave = Wave(float(amplitude), float(wavelength), skin.E_star)
    return _result(skin, balance(skin, wave, d=d, load=_load(skin, d, pressure, F_star)), True)


@takes_units
def measured_wave(
    contact: Contact | Callable[..., Array],
    *,
    heights: ArrayLike,
    counts: ArrayLike | None = None,
    d: float | None = None,
    pressure: float | None = None,
    F_star: float | None = None,
    E_star: float | None = None,
) -> WavyContact:
    r"""A rough surface on a rigid wave given by measured heights or their histogram.

    .. math:: \bar p = \sum_i w_i\,F_t(d - \zeta_i)

    Parameters
    ----------
    contact, d, pressure, F_star, E_star
        As in `rigid_wave`; d is counted from the weighted mean of the heights.
    heights : array (N,)
        Heights ζ of the wave [m]: a profile at equal distances, or the middles of bins. Waviness
        only, the roughness filtered out.
    counts : array (N,), optional
        Frequencies of the heights; equal by default.

    Returns
    -------
    WavyContact

    Examples
    --------
    >>> import numpy as np
    >>> import thirdbody as tb
    >>> from thirdbody.systems.waviness import measured_wave, rigid_wave
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> profile = 150e-9 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> wavy = measured_wave(contact, heights=profile, pressure=5e6)
    >>> round(wavy.d / rigid_wave(contact, amplitude=150e-9, pressure=5e6).d, 9)
    1.0
    """
    zeta = np.atleast_1d(np.asarray(heights, dtype=float))
    weights = np.ones_like(zeta) if counts is None else np.asarray(counts, dtype=float)
    if zeta.ndim != 1 or weights.shape != zeta.shape or not len(zeta):
        raise InvalidValue("heights and counts must be 1-D and of equal length", code=Mistake.SHAPE)
    if not (np.all(np.isfinite(zeta)) and np.all(weights >= 0) and 0 < weights.sum() < math.inf):
        raise InvalidValue(
            "heights must be finite, counts >= 0 with a positive finite sum", code=Mistake.RANGE
        )
    skin = Skin(contact, E_star)
    weights = weights / weights.sum()
    load = _load(skin, d, pressure, F_star)
    if load is not None and not (math.isfinite(load) and load > 0):
        raise InvalidValue(f"the load {load!r} must be finite and > 0", code=Mistake.RANGE)
    state = Histogram(zeta - weights @ zeta, weights).solve(skin, d, load)
    return _result(skin, state, False)
