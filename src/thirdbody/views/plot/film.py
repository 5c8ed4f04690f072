"""Figures of lubricated contacts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from ...errors import InvalidValue, Mistake
from ..film_regimes import OF_PARTICLES, bands_of
from ..palette import OKABE_ITO

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ...systems.stribeck import RegimeSpeeds
    from ..film_regimes import Band

__all__ = ["LINES", "OF_PARTICLES", "REGIME_FILLS", "bands_of", "stribeck"]

REGIME_FILLS = {"boundary": "0.82", "mixed": "0.93", "full film": "1.0"}
"""Grey behind each regime."""
LINES: dict[str, dict[str, tuple[str, str, str]]] = {
    "friction": {
        "mu": ("sum", OKABE_ITO["black"], "-"),
        "mu_film": ("film", OKABE_ITO["blue"], "--"),
        "mu_ss": ("asperities", OKABE_ITO["vermilion"], "-."),
        "mu_sa": ("particles", OKABE_ITO["green"], ":"),
    },
    "shares": {
        "film_share": ("film", OKABE_ITO["blue"], "--"),
        "ss_share": ("asperities", OKABE_ITO["vermilion"], "-."),
        "sa_share": ("particles", OKABE_ITO["green"], ":"),
    },
    "thickness": {
        "lambda_ratio": (r"film over roughness, $\lambda = h_T/\sigma$", OKABE_ITO["blue"], "-"),
        "h_over_x": ("gap over particle, $h/x_a$", OKABE_ITO["green"], ":"),
    },
}
"""The curves of each panel: column, label, colour, dash."""


def stribeck(
    curve: xarray.Dataset | Mapping[str, Any],
    changes: RegimeSpeeds | Mapping[str, float | None],
    *,
    speed: float | None = None,
) -> Figure:
    """Friction, load shares and film thickness over speed, with the regimes behind them.

    The panel of friction is left out where it is not known.

    Parameters
    ----------
    curve : xarray.Dataset or mapping
        From `thirdbody.films.stribeck`, or its columns.
    changes : RegimeSpeeds or mapping
        From `lubrication.regime_speeds`.
    speed : float, optional
        One to mark [m/s].

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidValue
        There are fewer than two speeds.

    Examples
    --------
    >>> import warnings; warnings.simplefilter("ignore")
    >>> import numpy as np, thirdbody as tb
    >>> from thirdbody.systems.stribeck import regime_speeds
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> given = dict(conjunction=tb.films.Point(R=9.5e-3), load=20.0,
    ...              oil=tb.films.Oil(eta=0.02, alpha=2e-8))
    >>> curve = tb.films.stribeck(contact, speed=np.geomspace(0.01, 10, 20), **given)
    >>> len(stribeck(curve, regime_speeds(contact, **given)).axes)
    2
    """
    u = np.asarray(curve["speed"], float)
    if len(u) < 2:
        raise InvalidValue(
            "a curve needs several speeds, e.g. "
            'speed = { from = "5 mm/s", to = "20 m/s", points = 60, spacing = "log" }',
            code=Mistake.SHAPE,
        )
    columns = {name: np.asarray(curve[name], float) for panel in LINES.values() for name in panel}
    panels = [name for name in LINES if name != "friction" or np.isfinite(columns["mu"]).any()]
    figure = Figure(figsize=(4.6, 0.6 + 2.1 * len(panels)), dpi=150, layout="constrained")
    every = figure.subplots(len(panels), 1, sharex=True)
    for panel, ax in zip(panels, every, strict=True):
        _draw(ax, panel, u, columns, bands_of(u, changes))
        if speed is not None:
            ax.axvline(speed, color="0.25", linewidth=1.0, linestyle=(0, (1, 1)))
    _name_regimes(every[0], bands_of(u, changes))
    every[-1].set_xlabel("Entrainment speed $u$ [m/s]")
    return figure


def _draw(
    ax: Axes,
    panel: str,
    u: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    bands: Sequence[Band],
) -> None:
    particles = np.isfinite(columns["h_over_x"]).any()
    for low, high, word in bands:
        ax.axvspan(low, high, color=REGIME_FILLS[word], linewidth=0, zorder=0)
    for name, (label, colour, dash) in LINES[panel].items():
        y = columns[name]
        if particles or name not in OF_PARTICLES:
            ax.plot(u, y, label=label, color=colour, linestyle=dash, linewidth=1.6)
    if panel == "friction":
        ax.set(ylabel=r"Friction coefficient $\mu$ [1]", ylim=(0, None))
    elif panel == "shares":
        ax.set(ylabel="Share of the load [%]", ylim=(-0.02, 1.02))
        ax.yaxis.set_major_formatter(PercentFormatter(1, symbol=""))
    else:
        ax.set(ylabel="Thickness ratio [1]", yscale="log")
        ax.axhline(1, color="0.4", linewidth=0.8)
    ax.set(xscale="log", xlim=(u.min(), u.max()))
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.legend(frameon=False, fontsize="small")


def _name_regimes(ax: Axes, bands: Sequence[Band]) -> None:
    """Write each regime above its band; a narrow one goes to the end of the axis."""
    width = np.log(bands[-1][1] / bands[0][0])
    for low, high, word in bands:
        place, side = np.sqrt(low * high), "center"
        if np.log(high / low) < 0.014 * len(word) * width:
            if word == "mixed":
                continue
            place, side = (low, "left") if word == "boundary" else (high, "right")
        ax.text(
            place,
            1.02,
            word,
            transform=ax.get_xaxis_transform(),
            ha=side,
            va="bottom",
            fontsize="small",
        )
