"""Metal spheres squashed between hard platens: how hard the contact presses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import thirdbody as tb

from ..panels import Line, Panel
from .row import Band, row_of

__all__ = ["ROW", "pressure"]

Array = NDArray[np.float64]

VICKERS = 0.927
"""Load over the facets of a Vickers indent, the hardness HV, over the mean pressure H."""
HARD, STIFF = (1e9, 1.5e9, 2e9), (70e9, 95e9, 120e9)
"""H [Pa] and E [Pa] of work-hardened metals."""
PLATEN = tb.Material(E=1e15, nu=0.3, H=1e13)
LAWS = {
    "computed (default)": tb.particle.Series(),
    'squashed (deep = "off")': tb.particle.Series(deep="off"),
    "sphere": tb.particle.Series(deep="off", soft="sphere"),
    "Jackson–Green": tb.particle.Series(law=tb.asperity.JG(), deep="off", soft="sphere"),
}


def pressure(name: str, H: float, E: float) -> tuple[Array, Array]:
    """Contact radius over R, and mean pressure over HV, of a sphere between rigid platens.

    Parameters
    ----------
    name : str
        One of ``LAWS``.
    H, E : float
        Hardness and modulus of the sphere [Pa].

    Returns
    -------
    tuple of array
        a/R and p/HV, from the first touch on.

    Examples
    --------
    >>> wide, hard = pressure("sphere", 1e9, 70e9)
    >>> round(float(hard[-1]), 4)
    1.0787
    """
    sphere = tb.Material(E=E, nu=0.33, H=H)
    one = LAWS[name].one(surfaces=tb.MaterialPair(PLATEN, PLATEN), particle=sphere)
    squeezed = one.at(np.linspace(1e-3, 0.9, 4000))
    area = squeezed.areas[0]
    return 2 * np.sqrt(area / np.pi), squeezed.load / area / (VICKERS * H)


def _over_materials(name: str, what: str) -> list[float]:
    values = []
    for H in HARD:
        for E in STIFF:
            wide, hard = pressure(name, H, E)
            most = int(np.argmax(hard))
            value = {
                "most": hard[most],
                "where": wide[most],
                # from the maximum, or from where it was measured, to half the radius
                "fall": np.interp(0.5, wide, hard) / np.interp(0.28, wide, hard),
            }[what]
            values.append(float(value))
    return values


def _band(what: str) -> Band:
    others = "; ".join(
        f"{name}: {Band.from_values(_over_materials(name, what)).text}" for name in list(LAWS)[1:]
    )
    return Band.from_values(_over_materials("computed (default)", what), others)


def _panel() -> Panel:
    lines = []
    for i, name in enumerate(LAWS):
        wide, hard = pressure(name, HARD[1], STIFF[1])
        shown = wide <= 0.8
        lines.append(Line(name, wide[shown][::8], hard[shown][::8], colour=i, dash=i))
    return Panel(
        "spheres",
        "mean pressure on a sphere squashed between hard platens",
        "contact radius over that of the sphere $a/R$",
        "mean pressure over Vickers hardness $p/HV$",
        ("a_over_R", "p_over_HV"),
        tuple(lines),
        xlog=False,
        ylim=(0.4, 1.15),
        levels=((0.7, "largest measured: 0.7"), (0.8, "to 0.8, at a/R = 0.20 to 0.28")),
        note="H = 1.5 GPa, E = 95 GPa.",
    )


ROW = row_of(
    "chaudhri1984",
    {
        "pressure": lambda: _band("most"),
        "where": lambda: _band("where"),
        "falls": lambda: _band("fall"),
    },
    panels=(_panel,),
)
