r"""Contacts in an oil film: the oil brings particles, the contacts return debris to it.

.. math:: \frac{dN_{km}}{dt} = r_{km} + q_{in} n^{in}_{km} - \sum_f L_{f,km}\frac{N_{km}}{V}
          + g_{km} + \text{pieces} - \text{embedded}, \qquad
          p_{ss} + p_{sa} = \bar p\,(1 - 1/\gamma)

with N = V n, the terms of `OilCircuit`, and the gap that the film leaves under its own part of the
load, as `thirdbody.films.mixed_film` has it. Passage of the contacts is short against all else:
what stands in them is ε times a layer of oil.

Every size of a class comes with the mean layer of its class, eq. (4a) of classes. With a layer of
its own for each size, larger ones come more: what particles above the film wear is then 1 % more
with classes of the default width, and four times nearer with classes half as wide. Explicit steps
over whole contacts (`mixed_film` at each) give the same births and wear as these equations to 1e-6.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from ...errors import NoEquilibrium
from ...numerics.chebyshev import PiecewiseChebyshev
from ..mixed_film import Lubricated, height_of_one, mean_gap
from .circuit import OilTerms
from .conditions import FilmConditions
from .contact_tables import ContactTables, Pressed
from .entry import oil_layer
from .loop import Gap, Loop, Rates, Setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["FilmLoop"]

INGRESS, FRESH = "ingress", "fresh oil"
LONGEST = 60.0
"""Largest ln γ of the tables."""
SECANTS = 12
"""Steps of a secant before a bracket is sought."""


class FilmLoop(Loop):
    """Lubricated contacts and the oil that goes through them.

    Parameters
    ----------
    tables : ContactTables
    setting : Setting
        Its area is that of all contacts together.
    film : FilmConditions
    bodies : Lubricated
        Bodies, oil, film formula and the load of one contact.
    terms : OilTerms
        What comes into the oil and goes out, for the kinds of the tables.
    volume : float
        Of the oil at the beginning [m³].
    """

    pool = "oil"

    def __init__(
        self,
        tables: ContactTables,
        setting: Setting,
        film: FilmConditions,
        *,
        bodies: Lubricated,
        terms: OilTerms,
        volume: float,
    ):
        self.removals = tuple(terms.removal)
        super().__init__(tables, setting, (INGRESS, FRESH, *self.removals))
        self.film, self.bodies = film, bodies
        self.terms, self.volume, self.growth = terms, volume, terms.growth
        self.pressure = float(bodies.p[0])
        _, across = bodies.conjunction.semi_axes(float(bodies.w[0]), E=2 * bodies.contact.E_ss)
        self.width = 2 * float(across)
        """Of one contact across the motion [m]."""
        u = np.array([film.speed])
        self.log_film = PiecewiseChebyshev(
            lambda x: np.log([float(bodies.thickness(u, np.exp(log_gamma))[0]) for log_gamma in x])[
                :, None
            ],
            np.array([0.0, 1.0, 4.0, 12.0, 30.0, LONGEST]),
            tolerance=1e-12,
        )
        series = self.log_film
        self._films = [
            (float(edge), float(middle), float(half), coefficients[:, 0].tolist())
            for edge, middle, half, coefficients in zip(
                series.edges[1:], series.middle, series.half, series.coefficients, strict=True
            )
        ]
        self._near: tuple[float, float, float] = (math.nan,) * 3
        """d, σ and the film there, of the separation that was asked for last."""
        self._layers: tuple[float, Array] = (math.nan, np.empty(0))
        """The film of which layers were asked for last, and they."""
        self.last, self._slope = 0.5, -1.0
        self.now = 0.0

    @property
    def one_area(self) -> float:
        return self.setting.area / self.film.contacts

    # ------------------------------------------------------------------ film
    def volume_at(self, time: float) -> float:
        """Volume of the oil [m³]."""
        return self.volume + self.growth * time

    def film_at(self, x: float) -> float:
        """Film thickness at ln γ [m]."""
        _, middle, half, series = next(
            (piece for piece in self._films if x < piece[0]), self._films[-1]
        )
        # Clenshaw's sum, in numbers of Python: this is asked for thousands of times
        t = 2 * (x - middle) / half
        one = two = 0.0
        for coefficient in reversed(series[1:]):
            one, two = coefficient + t * one - two, one
        return math.exp(series[0] + 0.5 * t * one - two)

    def separation(self, x: float, sigma: float) -> float:
        """d that the film leaves at ln γ [m]."""
        film = self.film_at(x)
        h = height_of_one(film, sigma)
        d = h - self.tables.mean_plane(sigma)
        least = -3.0 * self.tables.roughness_at(sigma).sigma_s
        if d < least:
            return least
        self._near = d, sigma, film
        return d

    def film_of(self, d: float, sigma: float) -> float:
        """Mean gap at a separation [m]."""
        if self._near[:2] == (d, sigma):
            return self._near[2]
        return float(mean_gap(d + self.tables.mean_plane(sigma), sigma=sigma))

    def _excess(self, y: Array, x: float) -> float:
        """What the solids carry over what the film leaves to them, at ln γ, over the load."""
        sigma = self.sigma_of(y)
        d = self.separation(x, sigma)
        eta = self.shape_numbers(self.present(y, d))
        return self.tables.load_alone(d, eta=eta, sigma=sigma) / self.pressure + math.expm1(-x)

    def _start(self) -> tuple[float, ...]:
        return float(self.last), float(self._slope)

    def _start_from(self, *start: float) -> None:
        self.last, self._slope = start

    def find_gap(self, y: Array) -> Gap:
        self.last = self._root(lambda x: self._excess(y, x))
        return Gap(self.separation(self.last, self.sigma_of(y)), math.exp(-self.last))

    def gap_slopes(self, y: Array, gap: Gap) -> Array:
        x, sigma = -math.log(gap.film_share), self.sigma_of(y)
        step = 1e-5 * (1 + x)
        low, high = max(x - step, 0.0), x + step
        stiff = self._excess(y, high) - self._excess(y, low)
        opens = self.separation(high, sigma) - self.separation(low, sigma)
        state = self.press_at(y, gap.d)
        return -self.slope_over_unknowns(y, state) / self.pressure / stiff * opens

    def _root(self, f: Callable[[float], float]) -> float:
        """Root of what falls with ln γ: by secants from the last one, or in a bracket."""
        x, slope = self.last, self._slope
        value = f(x)
        for _ in range(SECANTS):
            there = x - value / slope
            if not 0 <= there <= LONGEST:
                break
            if abs(there - x) <= 1e-13 * (1 + x):
                self._slope = slope
                return there
            after = f(there)
            if after == value or (after - value) / (there - x) >= 0:
                break
            slope = (after - value) / (there - x)
            x, value = there, after
        return self._bracketed_root(f)

    def _bracketed_root(self, f: Callable[[float], float]) -> float:
        if f(0.0) <= 0:
            return 0.0
        low, high = 0.0, max(2 * self.last, 0.5)
        while f(high) > 0:
            if high >= LONGEST:
                raise NoEquilibrium(
                    f"no equilibrium at speed = {self.film.speed:g} m/s: at every gap that this "
                    "film leaves, asperities and particles carry more than the load"
                )
            low, high = high, min(2 * high, LONGEST)
        return float(brentq(f, low, high, xtol=1e-13, rtol=1e-13))

    # ------------------------------------------------------------------ particles
    def layers(self, d: float, sigma: float) -> Array:
        """ε times the layer of oil that brings each number [m]: (J,)."""
        film = self.film_of(d, sigma)
        if self._layers[0] == film:
            return self._layers[1]
        largest = math.inf
        if self.film.particle_friction is not None:
            largest = film + 2 * self.film.particle_friction**2 * self.bodies.conjunction.R
        layer = oil_layer(
            self.tables.classes, film=film, largest=largest, height=self.film.entry_height
        )
        self._layers = film, self.film.entry_ratio * np.tile(layer, self.kinds)
        return self._layers[1]

    def standing(self, y: Array, d: float) -> Array:
        sigma = self.sigma_of(y)
        return self.pieces(d, sigma) * (self.layers(d, sigma) / self.volume_at(self.now))

    def in_contact(self, y: Array, d: float) -> Array:
        if self.breaks:
            return super().in_contact(y, d)
        layers = self.layers(d, self.sigma_of(y))
        return y[self.layout[self.pool]] * (layers / self.volume_at(self.now))

    def passes(self, side: int) -> float:
        return self.film.contacts * self.film.speed * self.width / self.setting.worn_area[side - 1]

    def add_exchange(self, out: Rates, y: Array, state: Pressed) -> None:
        pool, terms = self.layout[self.pool], self.terms
        volume = self.volume_at(self.now)
        self.add_source(out, INGRESS, terms.ingress.T.ravel())
        self.add_source(out, FRESH, (terms.make_up * terms.fresh).T.ravel())
        mine = np.arange(pool.start, pool.stop)
        for name in self.removals:
            rate = terms.removal[name].T.ravel() / volume
            out.matrix[mine, mine] -= rate
            self.add_flow(out, name, pool, rate)
        swept = self.film.contacts * self.film.speed * self.width
        passing = swept * self.layers(state.d, state.sigma) / volume
        self.add_retention(out, passing, state)
        self.add_passage(out, passing, pieces=self.pieces(state.d, state.sigma))

    def derivative(self, time: float, y: Array) -> Array:
        self.now = time
        return super().derivative(time, y)

    def jacobian(self, time: float, y: Array) -> Array:
        self.now = time
        return super().jacobian(time, y)
