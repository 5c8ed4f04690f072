"""A height map pressed point by point: who carries what, and where."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator

from ...errors import InvalidValue, Mistake
from ...quantities.arguments import names_arguments
from ...quantities.say import percent, value_of
from ..palette import OKABE_ITO, tint
from .style import _dress
from .topography import _length_scale

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...explicit.state import ExplicitState

    Array = NDArray[np.float64]

__all__ = ["Section", "explicit", "section_of"]

AROUND = 3.0
"""Length of the section over the diameter of its particle."""
GROUND = -1e6
"""How far down the ground is filled [nm]: below every frame."""
LEAST_PIXELS = 12
"""Points that a section shows at least."""


@names_arguments
def explicit(state: ExplicitState) -> Figure:
    """A state of `thirdbody.explicit.solve` in four panels.

    Parameters
    ----------
    state : ExplicitState
        Of one load, or of several: the last one is drawn.

    Returns
    -------
    matplotlib.figure.Figure
        Contact pressure, with the particles that carry in true size; gap; a section through the
        particle that carries most; what part of the load single particles carry.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> rough = tb.surfaces.self_affine(
    ...     sigma=100e-9, hurst=0.8, shortest=8e-7, longest=6e-6, spacing=1e-7, points=64)
    >>> contact = tb.Contact(
    ...     surfaces=tb.MaterialPair(steel, steel), roughness=rough.roughness(),
    ...     particles=tb.Particles(material=tb.materials["SiO2"], areal_density=2e12,
    ...                            diameter=tb.distributions.Monodisperse(mean=2e-7)))
    >>> pressed = tb.explicit.solve(contact, rough, F_star=2e-3)
    >>> len(tb.plot.explicit(pressed).axes)  # two are colour bars
    6
    """
    if not hasattr(state, "maps") or not hasattr(state, "particles"):
        raise InvalidValue(
            f"plot.explicit: {type(state).__name__} is no state of thirdbody.explicit.solve",
            code=Mistake.BEYOND,
        )
    maps, bodies = state.maps, state.particles
    if "state" in maps.dims:
        maps, bodies = maps.isel(state=-1), bodies.isel(state=-1)
    field = {str(name): np.asarray(maps[name].values) for name in maps.data_vars}
    every = {str(name): np.asarray(bodies[name].values) for name in bodies.data_vars}
    x, y = np.asarray(maps.x.values), np.asarray(maps.y.values)
    step = float(maps.attrs["spacing"])
    h = float(np.atleast_1d(state.h)[-1])
    drawing = Figure(figsize=(9.6, 7.6), dpi=150, layout="constrained")
    panels = drawing.subplots(2, 2)
    _pressure(drawing, panels[0, 0], field["pressure"], every, x, y, step)
    _gap(drawing, panels[0, 1], np.maximum(field["gap"], 0.0), x, y, step)
    _section(panels[1, 0], field, every, h, step)
    _forces(panels[1, 1], every["force"], float(np.sum(field["pressure"])) * step**2)
    for letter, ax in zip("abcd", panels.flat, strict=True):
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
    return drawing


def _extent(x: Array, y: Array, step: float, scale: float) -> tuple[float, float, float, float]:
    ends = (x[0] - step / 2, x[-1] + step / 2, y[0] - step / 2, y[-1] + step / 2)
    a, b, c, d = (float(end) / scale for end in ends)
    return a, b, c, d


def _pressure(
    drawing: Figure, ax: Axes, p: Array, bodies: dict[str, Array], x: Array, y: Array, step: float
) -> None:
    scale, unit = _length_scale(float(x[-1]))
    shown = np.where(p > 0, p / 1e9, np.nan)
    image = ax.imshow(
        shown,
        origin="lower",
        extent=_extent(x, y, step, scale),
        cmap="cividis",
        vmin=0,
        vmax=max(float(np.max(p)) / 1e9, 1e-12),
        interpolation="nearest",
    )
    drawing.colorbar(image, ax=ax, label="Pressure $p$ [GPa]", shrink=0.85)
    carries = bodies["force"] > 0
    if np.any(carries):
        size = bodies["diameter"][carries] / scale
        at = np.stack([bodies["x"][carries], bodies["y"][carries]], axis=1) / scale
        ax.add_collection(
            EllipseCollection(
                size,
                size,
                np.zeros(len(size)),
                units="xy",
                offsets=at,
                transOffset=ax.transData,
                facecolors="none",
                edgecolors=OKABE_ITO["vermilion"],
                linewidths=0.8,
            )
        )
    ax.set_xlabel(f"$x$ [{unit}]")
    ax.set_ylabel(f"$y$ [{unit}]")


def _gap(drawing: Figure, ax: Axes, gap: Array, x: Array, y: Array, step: float) -> None:
    scale, unit = _length_scale(float(x[-1]))
    tall, unit_z = _length_scale(float(np.max(gap)) or 1e-9)
    image = ax.imshow(
        gap / tall,
        origin="lower",
        extent=_extent(x, y, step, scale),
        cmap="viridis_r",
        vmin=0,
        interpolation="nearest",
    )
    drawing.colorbar(image, ax=ax, label=f"Gap [{unit_z}]", shrink=0.85)
    ax.set_xlabel(f"$x$ [{unit}]")
    ax.set_ylabel(f"$y$ [{unit}]")


class Section(NamedTuple):
    """Along x through the particle that carries most, or the highest pressure; [m]."""

    along: Array
    """From the particle."""
    height: Array
    deformed: Array
    size: float
    """Diameter of the particle; 0 without one."""
    seat: float
    """Height of its lowest point."""
    share: float
    """Its part of the particles' load."""


def section_of(field: dict[str, Array], bodies: dict[str, Array], step: float) -> Section:
    """A section of maps and particles as `ExplicitState` has them, a few diameters long."""
    rows, columns = field["height"].shape
    force = bodies["force"]
    carries = len(force) > 0 and float(np.max(force)) > 0
    if carries:
        k = int(np.argmax(force))
        size, x0, y0 = (float(bodies[name][k]) for name in ("diameter", "x", "y"))
    else:
        j, i = np.unravel_index(int(np.argmax(field["pressure"])), (rows, columns))
        size, x0, y0 = 0.0, float(i) * step, float(j) * step
    half = int(max(AROUND * size / step, LEAST_PIXELS)) // 2
    centre, row = round(x0 / step), round(y0 / step) % rows
    at = centre + np.arange(-half, half + 1)
    along = at.astype(float) * step - x0
    height, displacement = (field[name][row, at % columns] for name in ("height", "displacement"))
    deformed = height - displacement
    seat = share = 0.0
    if carries:
        seat = float(np.interp(0.0, along, deformed)) - float(bodies["dent_1"][k])
        share = float(force[k] / np.sum(force))
    return Section(along, height, deformed, size, seat, share)


def _section(
    ax: Axes, field: dict[str, Array], bodies: dict[str, Array], h: float, step: float
) -> None:
    section = section_of(field, bodies, step)
    along, size = section.along / 1e-9, section.size
    surface = section.deformed / 1e-9
    ends = np.array([[along[-1], GROUND], [along[0], GROUND]])
    ground = np.concatenate([np.stack([along, surface], axis=1), ends])
    ax.add_collection(PolyCollection([ground], color=tint(OKABE_ITO["black"], 0.25)), autolim=False)
    ax.plot(along, section.height / 1e-9, color="black", linewidth=0.8, linestyle="--")
    ax.axhline(h / 1e-9, color=OKABE_ITO["blue"], linewidth=1.5)
    _dress(ax, "$x$ from the particle [nm]", "Height $z$ [nm]", xlog=False)
    ax.legend(["deformed", "as it was", "the flat"], fontsize="small", loc="upper left")
    if size:
        ax.add_patch(
            Circle(
                (0.0, section.seat / 1e-9 + size / 2e-9),
                size / 2e-9,
                facecolor=tint(OKABE_ITO["vermilion"], 0.5),
                edgecolor=OKABE_ITO["vermilion"],
                zorder=2,
            )
        )
        ax.set_aspect("equal", adjustable="datalim")
        ax.text(
            0.02,
            0.03,
            f"x = {value_of(size, 'm', 3)}, {percent(section.share)} of the particles' load",
            transform=ax.transAxes,
            fontsize="small",
        )


def _forces(ax: Axes, force: Array, on_asperities: float) -> None:
    """How the load spreads over single particles."""
    carried = force[force > 0]
    total = float(np.sum(force)) + on_asperities
    _dress(ax, "Share of the load on one particle [%]", "Particles", xlog=False)
    if len(carried):
        ax.hist(100 * carried / total, bins=30, color=tint(OKABE_ITO["vermilion"], 0.7))
        ax.margins(y=0.25)
        ax.yaxis.set_major_locator(MaxNLocator(integer=True))
        text = (
            f"{len(carried)} of {len(force)} particles carry\n"
            f"{percent(float(np.sum(carried)) / total)} of the load"
        )
    else:
        text = "no particle carries"
    ax.text(0.97, 0.95, text, transform=ax.transAxes, ha="right", va="top", fontsize="small")
