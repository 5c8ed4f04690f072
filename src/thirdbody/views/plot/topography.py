"""A measured surface: heights, spectrum, summits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from ...quantities.arguments import names_arguments
from ...quantities.say import number
from ..palette import OKABE_ITO, tint
from .style import _dress

if TYPE_CHECKING:
    from ...populations.measured.topography import Topography

__all__ = ["surface"]


# ------------------------------------------------------------------ a measured surface
@names_arguments
def surface(topography: Topography) -> Figure:
    """A measured surface and what its asperities owe to the cut-off, in six panels.

    Parameters
    ----------
    topography : Topography
        From `thirdbody.surfaces.from_topography`.

    Returns
    -------
    matplotlib.figure.Figure
        Heights; power spectrum; gradient, radius and density against the cut-off, by differences,
        by the spectrum, and counted; heights of the summits.

    Examples
    --------
    >>> import thirdbody as tb
    >>> from thirdbody.populations.measured.topography import from_topography
    >>> len(tb.plot.surface(from_topography("example")).axes)  # the colour bar is one
    7
    """
    drawing = Figure(figsize=(10.5, 6.2), dpi=150, layout="constrained")
    panels = drawing.subplots(2, 3)
    _heights_panel(topography, panels[0, 0])
    _spectrum_panel(topography, panels[0, 1])
    _cutoff_panels(topography, [panels[0, 2], panels[1, 0], panels[1, 1]])
    _summits_panel(topography, panels[1, 2])
    for letter, ax in zip("abcdef", panels.flat, strict=True):
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
    return drawing


def _length_scale(largest: float) -> tuple[float, str]:
    return next(
        (size, unit)
        for size, unit in ((1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"), (0.0, "nm"))
        if largest >= 0.3 * size
    )


def _heights_panel(topography: Topography, ax: Axes) -> None:
    across, unit = _length_scale(max(topography.size))
    z = topography.heights
    tall, unit_z = _length_scale(float(np.nanmax(np.abs(z))) or 1e-9)
    if topography.dim == 1:
        x = np.arange(len(z)) * topography.spacing[0]
        ax.plot(x / across, z / tall, color=tint(OKABE_ITO["blue"], 0.6), linewidth=0.8)
        ax.plot(x / across, topography.filtered() / tall, color="black", linewidth=0.8)
        _dress(ax, f"$x$ [{unit}]", f"Height $z$ [{unit_z}]", xlog=False)
        ax.legend(["as sampled", "above the cut-off"], frameon=False, fontsize="small")
        ax.margins(x=0, y=0.15)
        return
    width, height = (side / across for side in topography.size)
    low, high = np.nanpercentile(z / tall, [0.5, 99.5])
    image = ax.imshow(
        z.T / tall,
        origin="lower",
        extent=(0, width, 0, height),
        cmap="cividis",
        vmin=low,
        vmax=high,
        interpolation="nearest",
    )
    assert ax.figure is not None
    ax.figure.colorbar(image, ax=ax, label=f"Height $z$ [{unit_z}]", extend="both", shrink=0.85)
    ax.set_facecolor(OKABE_ITO["vermilion"])
    ax.set_xlabel(f"$x$ [{unit}]")
    ax.set_ylabel(f"$y$ [{unit}]")


def _mark_cutoff(topography: Topography, ax: Axes, scale: float) -> list[object]:
    """Grey where data do not stand for the surface; lines at the cut-off used and the limit."""
    left, right = ax.get_xlim()
    grey = ax.axvspan(left, topography.recommended[0] / scale, color="0.92", zorder=0)
    grey.set_label("not recommended")
    marks: list[object] = [grey]
    if topography.limit is not None:
        colour = tint(OKABE_ITO["purple"], 0.6)
        line = ax.axvline(topography.limit / scale, color=colour, linewidth=3.0)
        line.set_label("instrument's limit")
        marks.append(line)
    if topography.cutoff > 0:
        line = ax.axvline(topography.cutoff / scale, color="black", linestyle="--", linewidth=1.0)
        line.set_label("cut-off used")
        marks.append(line)
    ax.set_xlim(left, right)
    return marks


def _few_ticks(ax: Axes) -> None:
    """Numbers inside the decades of a logarithmic axis that spans less than two."""
    for axis, (low, high) in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        axis.set_minor_formatter(NullFormatter())
        if high / low < 100:
            axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high > 6 * low else range(1, 10)))
            if 1e-3 <= low and high < 1e4:
                axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
            else:
                axis.set_major_formatter(FuncFormatter(lambda value, _: number(value, 2)))


def _spectrum_panel(topography: Topography, ax: Axes) -> None:
    wavelength, density = topography.psd()
    scale, unit = _length_scale(float(wavelength[len(wavelength) // 2]))
    seen = density > 0
    ax.plot(wavelength[seen] / scale, density[seen], color=OKABE_ITO["blue"], linewidth=1.6)
    power = "4" if topography.dim == 2 else "3"
    _dress(ax, f"Wavelength [{unit}]", f"Power spectral density $C$ [m$^{power}$]", ylog=True)
    top = float(density.max())
    low, high = ax.get_ylim()
    ax.set_ylim(max(low, 1e-16 * top), high)
    marks = _mark_cutoff(topography, ax, scale)
    ax.legend(handles=marks, frameon=False, fontsize="small", loc="lower right")


def _cutoff_panels(topography: Topography, axes: Sequence[Axes]) -> None:
    from ...populations.measured.spectra import SpectralMoments

    curve = topography.curve()
    spectral = [
        SpectralMoments(m0=m0, m2=m2, m4=m4)
        for m0, m2, m4 in zip(
            *(curve[f"{name}_spectrum"] for name in ("m0", "m2", "m4")), strict=True
        )
    ]
    scale, unit = _length_scale(float(np.median(curve["cutoff"])))
    R_scale, R_unit = _length_scale(float(np.median(curve["R"])))
    labels = {
        "rms_gradient": ("RMS gradient [1]", 1.0),
        "R": (f"Mean asperity radius $R$ [{R_unit}]", R_scale),
        "eta": (r"Asperity density $\eta$ [m$^{-2}$]", 1.0),
    }
    x = curve["cutoff"] / scale
    for ax, (name, (label, by)) in zip(axes, labels.items(), strict=True):
        ax.plot(x, curve[name] / by, color=OKABE_ITO["blue"], label="differences")
        values = np.array([getattr(one, name) for one in spectral])
        ax.plot(x, values / by, color=OKABE_ITO["vermilion"], linestyle="--", label="spectrum")
        counted = curve.columns.get(f"{name}_counted")
        if counted is not None and np.isfinite(counted).any():
            ax.plot(
                x,
                counted / by,
                color=OKABE_ITO["green"],
                linestyle="none",
                marker="o",
                markersize=4,
                markerfacecolor="none",
                label="summits counted",
            )
        _dress(ax, rf"Cut-off wavelength $\lambda_c$ [{unit}]", label, ylog=True)
        shown, names = ax.get_legend_handles_labels()
        ax.legend(shown, names, frameon=False, fontsize="small")
        _mark_cutoff(topography, ax, scale)
        _few_ticks(ax)


def _summits_panel(topography: Topography, ax: Axes) -> None:
    summits, moments = topography.summits, topography.moments
    map_ = topography.dim == 2
    heights = summits.heights if map_ else topography.filtered()
    heights = heights[np.isfinite(heights)]
    scale, unit = _length_scale(float(np.max(np.abs(heights), initial=1e-9)))
    mean, std = (moments.y_s, moments.sigma_s) if map_ else (0.0, moments.sigma)
    what = "summits counted" if map_ else "heights of the profile"
    law = "Nayak, Gaussian" if map_ else "Gaussian of the same RMS"
    bins = max(8, min(40, int(1.5 * len(heights) ** 0.5)))
    ax.hist(
        heights / scale,
        bins=bins,
        density=True,
        color=tint(OKABE_ITO["green"], 0.4),
        label=f"{what} ({len(heights)})",
    )
    low, high = min(heights.min(), mean - 3.5 * std), max(heights.max(), mean + 3.5 * std)
    z = np.linspace(low, high, 300)
    density = np.exp(-0.5 * ((z - mean) / std) ** 2) / (std * math.sqrt(2 * math.pi))
    ax.plot(z / scale, density * scale, color="black", linewidth=1.2, label=law)
    _dress(ax, f"Height above the mean plane [{unit}]", f"Density [1/{unit}]", xlog=False)
    ax.set_ylim(0, 1.3 * ax.get_ylim()[1])
    ax.legend(frameon=False, fontsize="small")
