"""The contact mode over two inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import NullFormatter

from ...equilibrium.solve import solve
from ...equilibrium.words import MODES
from ...errors import InvalidValue, Mistake
from ...populations.particles import Particles
from ...quantities.carried import takes_units
from .style import MODE_COLOURS, _axes, _dress, _legend_above

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ...contact.contact import Contact

__all__ = ["mode_map"]


@takes_units
def mode_map(
    contact: Contact,
    *,
    F_star: ArrayLike | None = None,
    ratio: ArrayLike | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Contact mode over particle size x_a/σ and load F*.

    The size distribution keeps its shape and is scaled, everything else stays as it is; every
    point of the map is a solved state. A dashed line joins the states in which particles and
    asperities share the load equally.

    Parameters
    ----------
    contact : Contact
        With particles.
    ratio : array_like, optional
        Sizes x_a/σ [1]; 200 from 0.1 to 10 when left out.
    F_star : array_like, optional
        Loads F* = F/(A_n E_ss) [1]; 200 from 1e-7 to 1e-3 when left out.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure when left out.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidValue
        A contact without particles, or an empty or negative range.

    Notes
    -----
    States that have no equilibrium, and sizes at which the particles would cover the whole
    nominal area, stay white.

    References
    ----------
    The modes are those of Horng et al. 2022, doi:10.3390/lubricants10070164.

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> debris = tb.Particles(material=steel, diameter=tb.distributions.Monodisperse(mean=3e-7),
    ...                       areal_density=1e11)
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel), particles=debris,
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> ax = tb.plot.mode_map(
    ...     contact, ratio=np.geomspace(0.5, 5, 8), F_star=np.geomspace(1e-6, 1e-3, 8)
    ... )
    >>> ax.get_xlabel()
    'Particle size over roughness $x_a/\\\\sigma$ [1]'
    """
    if contact.two_body or not isinstance(contact.particles, Particles):
        raise InvalidValue(
            "plot.mode_map: the contact has no particles, or several kinds; give one kind",
            code=Mistake.BEYOND,
        )
    sizes = np.geomspace(0.1, 10, 200) if ratio is None else np.asarray(ratio, dtype=float)
    loads = np.geomspace(1e-7, 1e-3, 200) if F_star is None else np.asarray(F_star, dtype=float)
    for name, values in (("ratio", sizes), ("F_star", loads)):
        if values.ndim != 1 or len(values) < 2 or not np.all(np.diff(values) > 0) or values[0] <= 0:
            raise InvalidValue(
                f"plot.mode_map: {name} must be two or more increasing positive numbers [1]",
                code=Mistake.ORDER,
            )
    index, share = _solved_map(contact, sizes, loads)

    ax = _axes(ax, (4.8, 3.8))
    colours = ListedColormap([MODE_COLOURS[name] for name in MODES])
    ax.pcolormesh(
        sizes,
        loads,
        np.ma.masked_less(index, 0).T,
        cmap=colours,
        norm=BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3),
        shading="nearest",
        rasterized=True,
    )
    for i, name in enumerate(MODES):
        inside = index == i
        if inside.mean() > 0.02:
            text = ax.text(*_middle(inside, sizes, loads), name, ha="center", va="center")
            text.set_path_effects([withStroke(linewidth=4, foreground=MODE_COLOURS[name])])
    if np.nanmin(share) < 0.5 < np.nanmax(share):
        ax.contour(sizes, loads, share.T, [0.5], colors="black", linestyles="--", linewidths=1.2)
        words = "equal load on particles and asperities"
        line = Line2D([], [], color="black", linestyle="--", linewidth=1.2, label=words)
        _legend_above(ax, [line])
    _dress(ax, "ratio", "F_star", ylog=True)
    ax.grid(visible=False)
    ax.set_xlabel(r"Particle size over roughness $x_a/\sigma$ [1]")
    # of less than two decades every tick would have a power of ten, one over the other
    if sizes[-1] < 100 * sizes[0]:
        marks = [float(f"{digit}e{power}") for power in range(-3, 4) for digit in (1, 2, 5)]
        ax.set_xticks(marks, [f"{mark:g}" for mark in marks])
        ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xlim(sizes[0], sizes[-1])
    ax.set_ylim(loads[0], loads[-1])
    return ax


def _solved_map(
    contact: Contact, sizes: NDArray[np.float64], loads: NDArray[np.float64]
) -> tuple[NDArray[np.int_], NDArray[np.float64]]:
    """Index into `MODES` (−1: none) and particle load share, both (sizes, loads)."""
    particles = contact.particles
    assert isinstance(particles, Particles)
    diameter = particles.diameter
    x_a = getattr(diameter, "mean", None) or diameter.mean_diameter
    index = np.full((len(sizes), len(loads)), -1)
    share = np.full(index.shape, np.nan)
    for i, size in enumerate(sizes):
        scaled = diameter.scaled(size * contact.roughness.sigma / x_a)
        try:
            population = particles.replace(diameter=scaled)
        except InvalidValue:  # jammed
            continue
        state = solve(contact.replace(particles=population, outputs=()), F_star=loads)
        mode = np.asarray(state.mode)
        for k, name in enumerate(MODES):
            index[i, mode == name] = k
        share[i] = state.particle_load_share
    return index, share


def _middle(
    inside: NDArray[np.bool_], sizes: NDArray[np.float64], loads: NDArray[np.float64]
) -> tuple[float, float]:
    """The point of a region farthest from its border, in map pixels: where its name goes."""
    from scipy.ndimage import distance_transform_edt

    padded = np.pad(inside, 1)
    depth = np.asarray(distance_transform_edt(padded))[1:-1, 1:-1]
    i, j = np.unravel_index(np.argmax(depth), depth.shape)
    return float(sizes[i]), float(loads[j])
