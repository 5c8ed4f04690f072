r"""Two solids that close on dust: does metal touch metal?

A sphere of radius R_s (or crossed cylinders of that radius) comes down on a flat strewn with
particles at random. A particle is in the way where the gap at touch is smaller than its
diameter, over an area 2πR_s x, so that a Poisson number of them is, with the mean

.. math:: N = 2\pi R_s\,\eta_a\,\langle x\rangle .

Their squeezes are spread evenly, ε ~ U(0, 1), because the gap grows with the square of the
distance. The solids touch if the particles in the way carry no more than the load,

.. math:: P(W) = P\Big(\sum_{i\le n} f_i \le W\Big), \qquad n \sim \text{Poisson}(N),

a compound Poisson law of the load f of one particle, with nothing to adjust.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValue, Mistake, Problem
from ..laws.particle.series import Series
from ..numerics.quadrature import panel_rule
from ..populations.distributions import Distribution, Monodisperse
from ..populations.materials import MaterialPair
from ..populations.particles import Particles
from ..quantities.say import percent, value_of
from ..quantities.value import Value, quantity

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..laws.base import AbstractParticleLaw

    Array = NDArray[np.float64]

__all__ = ["ContactProbability"]


def __dir__() -> list[str]:
    return sorted(__all__)


CELLS, SHARED = 2048, 2.0
"""Steps between 0 and a load on the solids; loads within this factor share them."""
PER_PARTICLE, MOST_CELLS = 16, 40_000
"""More steps where there are many particles, each of which is rounded."""
NODES = 4
"""Gauss nodes in each panel of the squeeze."""
PANELS, FINE = 32, 20_000
"""Panels of the squeeze in sums over sizes, and steps where there is one size."""
LARGE = 1e200
RARE = 1e-6
"""So few of the particles in the way may be as large as the solids."""
SURE = 1e-12
"""A load that differs by less, relatively, is the same."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactProbability(Value):
    r"""How often two solids touch through dust.

    .. math:: P(W) = e^{-N}\sum_n \frac{N^n}{n!}\,G^{*n}(W), \qquad
              N = 2\pi R_s\eta_a\langle x\rangle

    with the distribution G of the load of one particle in the way.

    Parameters
    ----------
    radius : float
        Radius R_s of the sphere, or of both crossed cylinders [m].
    surfaces : MaterialPair
        The two solids.
    particles : Particles
        Dust: material, diameters x, particles per area η_a.
    law : AbstractParticleLaw, optional
        What one particle does between the solids.

    Raises
    ------
    InvalidValue
        A radius that is not above the particles, or particles that break.

    Notes
    -----
    Left out: the elastic bulk of the solids, so that a load presses the dust and not the bodies;
    particles that roll away or break; tilting. Of the experiment on dust of 1956 only the
    abstract could be read: it states that the probability follows from number and size of the
    particles and the load, and that it changes sharply where the area of contact is comparable
    with the cross-section of a particle. `threshold` is that load here, with no constant.

    References
    ----------
    Williamson, Greenwood, Harris 1956, Proc. R. Soc. A 237, 560, doi:10.1098/rspa.1956.0197
    (abstract seen). Compound Poisson sums: Panjer 1981, ASTIN Bulletin 12, 22,
    doi:10.1017/S0515036100006796.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.systems.contact_probability import ContactProbability
    >>> steel = tb.materials["S45C"]
    >>> dust = tb.Particles(material=tb.materials["SiO2"], areal_density=1e9,
    ...                     diameter=tb.distributions.Monodisperse(mean=10e-6))
    >>> relay = ContactProbability(radius=5e-3, surfaces=tb.MaterialPair(steel, steel),
    ...                            particles=dust.replace(areal_density=3e6))
    >>> round(relay.in_the_way, 3)
    0.942
    >>> light, heavy = relay.probability([1e-3, 2.0])
    >>> f"{light:.2f} under 1 mN, {heavy:.2f} under 2 N"
    '0.39 under 1 mN, 0.99 under 2 N'
    """

    radius: float = quantity(
        "R_s", "m", "radius of the sphere or crossed cylinders", gt=0, usual=10
    )
    surfaces: MaterialPair
    particles: Particles
    law: AbstractParticleLaw = Series()

    def __post_init__(self) -> None:
        Value.__post_init__(self)
        if self.particles.strength is not None:
            raise InvalidValue(
                "particles.strength must be left out: particles that break are not followed here",
                code=Mistake.BEYOND,
            )
        if boulders := boulders_among(self.particles.diameter, self.radius):
            raise InvalidValue(
                Problem(
                    "radius",
                    f"must be above the particles, of which {boulders} reach it: the sphere "
                    "comes down on dust, not on boulders",
                    f"{value_of(self.radius, 'm')}",
                    hint="give the sizes an end, or take a larger radius",
                    code=Mistake.ORDER,
                )
            )

    @property
    def in_the_way(self) -> float:
        """Mean number N of particles that keep the solids apart [1]."""
        mean = self.particles.diameter.moment(1)
        return 2 * math.pi * self.radius * self.particles.areal_density * mean

    @property
    def threshold(self) -> float:
        """Load of the mean particle squeezed to its diameter [N]: there the probability jumps."""
        mean = self.particles.diameter.moment(1)
        return float(self._per_size(np.array([1.0]))[0]) * mean**2

    def probability(self, load: ArrayLike) -> Array:
        """P that the solids touch under this load: as `bounds`, in the middle.

        Parameters
        ----------
        load : array_like
            Load W on the solids [N].
        """
        low, high = self.bounds(load)
        return 0.5 * (low + high)

    def bounds(self, load: ArrayLike) -> tuple[Array, Array]:
        """Bounds of P, the load of each particle rounded up and down.

        Parameters
        ----------
        load : array_like
            Load W on the solids [N].

        Returns
        -------
        tuple of array
            Lower and upper bound of P [1]: some N/1000 apart up to N of 100, farther beyond.

        Raises
        ------
        InvalidValue
            A load below zero or not finite.
        """
        loads = np.asarray(load, dtype=float)
        if not np.all(np.isfinite(loads) & (loads >= 0)):
            rule = "must be finite and not below 0 N"
            raise InvalidValue(Problem("load", rule, code=Mistake.RANGE))
        out = np.full((2, loads.size), math.exp(-self.in_the_way))
        left = loads.ravel().copy()
        while np.any(left > 0):
            top = left.max()
            here = left > top / SHARED
            out[:, here] = self._bounds(top, left[here])
            left[here] = 0.0
        return out[0].reshape(loads.shape), out[1].reshape(loads.shape)

    def of_one(self, load: ArrayLike) -> Array:
        """G: share of the particles in the way that carry no more than this.

        Parameters
        ----------
        load : array_like
            Load of one particle [N].
        """
        loads = np.asarray(load, dtype=float)
        most = loads.ravel() * (1 + SURE)
        sizes = self.particles.diameter
        out = np.zeros_like(most)
        for share, component in sizes.components:
            if isinstance(component, Monodisperse):
                eps = self._edges(FINE)
                share_below = np.interp(
                    most / component.mean**2, self._per_size(eps), eps, right=1.0
                )
            else:
                # of size x there are x φ(x): the wider a particle, the more it is in the way
                eps, weight = panel_rule(self._edges(PANELS), NODES)
                largest = np.sqrt(most[:, None] / np.maximum(self._per_size(eps), 1e-300))
                share_below = component.partial_moment(1, np.zeros_like(largest), largest) @ weight
                share_below = share_below / component.moment(1)
            out += share * component.moment(1) * share_below
        return (out / sizes.moment(1)).reshape(loads.shape)

    def _edges(self, count: int) -> Array:
        """Squeezes ε from 0 to 1, so many and the kinks of the law."""
        kinks = np.asarray(self._one.kinks)
        return np.unique([*np.linspace(0, 1, count + 1), *kinks[kinks < 1]])

    @property
    def _one(self) -> Any:
        law = self.law.of_shape(self.particles.shape)
        return law.one(surfaces=self.surfaces, particle=self.particles.material)

    def _per_size(self, eps: Array) -> Array:
        """Load over x² [Pa] at ε."""
        return np.asarray(self._one.at(eps).load)

    def _bounds(self, top: float, loads: Array) -> Array:
        """Both bounds at loads not above ``top``, in steps of which that has about `CELLS`."""
        step = top / min(max(CELLS, PER_PARTICLE * self.in_the_way), MOST_CELLS)
        if self.threshold < top + step:  # the jumps of one size lie on its multiples
            step = self.threshold / math.ceil(self.threshold / step)
        places = np.arange(math.floor(top / step * (1 + SURE)) + 1)
        up = np.diff(self.of_one(step * places), prepend=0.0)
        down = np.diff(self.of_one(step * (places + 1) * (1 - 2 * SURE)), prepend=0.0)
        place = np.floor(loads / step * (1 + SURE)).astype(int)
        return np.array([compound(self.in_the_way, masses)[place] for masses in (up, down)])


def compound(N: float, mass: Array) -> Array:
    """P(S ≤ j) of a Poisson sum S over places 0, 1, 2, … of these masses, at every place j."""
    from .compound_sums import expand_sum

    weight = N * np.arange(len(mass)) * mass
    filled_places = np.flatnonzero(weight)
    g = np.zeros(len(mass))  # probability of each place, over exp(log_scale)
    g[0] = 1.0
    scaled = expand_sum(weight, int(filled_places[-1]) if len(filled_places) else 0, LARGE, g)
    log_scale = scaled * math.log(LARGE) - N * (1 - mass[0])
    with np.errstate(divide="ignore"):
        return np.minimum(np.exp(np.minimum(np.log(np.cumsum(g)) + log_scale, 0.0)), 1.0)


def boulders_among(diameter: Distribution, radius: float) -> str:
    """Which part of the particles in the way is as large as the solids [m]; "" where too few are.

    >>> boulders_among(Monodisperse(mean=2e-3), 1e-3)
    '100 %'
    """
    last = diameter.support[1]
    if last < radius:
        return ""
    if diameter.support[0] >= radius:
        return "100 %"
    share = float(diameter.partial_moment(1, radius, last)) / diameter.moment(1)
    return percent(share) if share > RARE else ""
