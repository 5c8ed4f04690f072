r"""Dust that settles out of the air of a clean room of an ISO 14644-1 class.

A class N allows, in a cubic metre of air,

.. math:: C(\ge x) = 10^N \left(\frac{0.1\ \mu m}{x}\right)^{2.08}

particles of at least the diameter x. In still air they fall with Stokes's velocity, so that on a
surface that faces up, bare for a time t, there lie

.. math:: \frac{d\eta_a}{dx} = -t\,v(x)\frac{dC}{dx}, \qquad
          v = \frac{\rho_p x^2 g}{18\mu} \Big[1 + \frac{2\lambda}{x}
          \big(1.257 + 0.4 e^{-1.1 x/(2\lambda)}\big)\Big] .

References
----------
The formula and table of ISO 14644-1 as engineeringtoolbox.com/clean-rooms-iso-d_933.html and
smbvalidation.com print them (the standard itself was not at hand). Slip: Davies 1945, Proc. Phys.
Soc. 57, 259, doi:10.1088/0959-5309/57/4/301 (as quoted); the mean free path of air as in the
aerosol course of the University of Florida, aerosol.ees.ufl.edu.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Mistake
from ...numerics.quadrature import panel_rule
from ...quantities.carried import takes_units
from ...quantities.units import say
from ..distributions import Distribution
from ..tabulated_sizes import PowerLaw

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["COUNTED_TO", "airborne", "read_class", "settled_particles", "settling_speed"]

SMALLEST, COUNTED_TO = 0.5e-6, 5e-6
"""Diameters from and up to which settled dust is taken where nobody says more [m]; classes are
stated up to the second."""
VISCOSITY, PATH, GRAVITY = 18.2e-6, 66e-9, 9.80665
"""Of air at 20 °C: viscosity [Pa s], mean free path [m]; and of the earth [m/s²]."""
STEP = 1.1
"""Ratio of the ends of a section of sizes, at most."""


def read_class(value: object) -> float:
    """The number of an ISO 14644-1 class.

    >>> read_class(7), read_class("ISO 5")
    (7.0, 5.0)
    """
    try:
        number = float(str(value).upper().removeprefix("ISO").strip())
    except ValueError:
        number = math.nan
    if isinstance(value, bool) or not 0 < number <= 9:
        raise InvalidValue(
            f"{say(value)} is no class of ISO 14644-1, which go up to 9, e.g. 7",
            code=Mistake.OPTION,
        )
    return number


def airborne(x: ArrayLike, *, iso_class: float) -> Array:
    """Particles of at least this diameter [m] in a volume of air [1/m³].

    >>> [f"{float(airborne(x, iso_class=5)):.3g}" for x in (0.1e-6, 0.5e-6, 5e-6)]
    ['1e+05', '3.52e+03', '29.3']
    """
    return 10.0**iso_class * (0.1e-6 / np.asarray(x, float)) ** 2.08


def settling_speed(x: ArrayLike, *, density: float) -> Array:
    """Speed at which spheres of this diameter [m] and density [kg/m³] fall through air [m/s]."""
    x = np.asarray(x, float)
    slip = 1 + 2 * PATH / x * (1.257 + 0.4 * np.exp(-1.1 * x / (2 * PATH)))
    return density * x**2 * GRAVITY * slip / (18 * VISCOSITY)


@takes_units
def settled_particles(
    iso_class: float,
    *,
    exposure: float,
    particle_density: float,
    smallest: float = SMALLEST,
    largest: float = COUNTED_TO,
) -> tuple[float, Distribution]:
    """Particles per area that settle on a surface, and their sizes by number.

    Parameters
    ----------
    iso_class : float
        N of ISO 14644-1 [1].
    exposure : float
        Time t that the surface lies bare [s].
    particle_density : float
        ρ_p [kg/m³].
    smallest, largest : float, optional
        Ends of the sizes [m]; above 5 µm no class is stated, and its power law is continued.

    Returns
    -------
    tuple
        η_a [1/m²], and the distribution of diameters.

    Notes
    -----
    Left out: air that moves, charges, diffusion (below 0.1 µm), what people and handling bring.
    The count rises with ``largest``, as large particles are rare in the air but fall fast.

    Examples
    --------
    >>> number, sizes = settled_particles(7, exposure=86400, particle_density=2650)
    >>> f"{number:.2e} per m², mean {sizes.mean_diameter * 1e6:.1f} µm"
    '2.99e+06 per m², mean 1.8 µm'
    """
    if not 0 < smallest < largest:
        raise InvalidValue(
            f"smallest = {smallest:g} m must be above 0 and below largest = {largest:g} m",
            code=Mistake.RANGE,
        )
    count = math.ceil(math.log(largest / smallest) / math.log(STEP))
    edges = np.geomspace(smallest, largest, count + 1)

    def per_log(x: Array) -> Array:
        """Particles per area and ln x."""
        return (
            exposure
            * settling_speed(x, density=particle_density)
            * 2.08
            * airborne(x, iso_class=iso_class)
        )

    nodes, weights = panel_rule(np.log(edges), 4)
    counts = (per_log(np.exp(nodes)) * weights).reshape(count, -1).sum(axis=1)
    ends = per_log(edges)
    slopes = -np.diff(np.log(ends)) / np.diff(np.log(edges))
    sizes = PowerLaw(
        edges=tuple(edges.tolist()), counts=tuple(counts.tolist()), slopes=tuple(slopes.tolist())
    )
    return float(counts.sum()), sizes
