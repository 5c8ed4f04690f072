"""Silica nanoparticles on surfaces of different roughness."""

from __future__ import annotations

import numpy as np

import thirdbody as tb

from ..seats import contact
from .row import ABSTRACT, CHOSEN, Band, Input, Row, statement

__all__ = ["ROW", "share"]

HEIGHTS = (1.0, 3.0, 4.0, 6.0)
"""Height of the roughness over σ: σ itself, or a peak height."""
LEVELS = (1e-6, 1e-5, 1e-4)


def share(ratio: float) -> list[float]:
    """Share of the load on particles where roughness height over diameter is ``ratio``.

    Examples
    --------
    >>> bool(max(share(20.0)) < min(share(2.0)))
    True
    """
    out = []
    for height in HEIGHTS:
        dusty = contact(300e-9 * height / ratio)
        found = tb.solve(dusty, F_star=np.array(LEVELS)).particle_load_share
        out += np.asarray(found).tolist()
    return out


ROW = Row(
    "kong2022",
    "Silica nanoparticles against roughness",
    "Kong, Zhang, Bao, Liu, Liu 2022, Adv. Mater. Sci. Eng. 2022, 7051650, "
    "doi:10.1155/2022/7051650",
    "Pin on disc with silica in the fluid, against the fluid alone; λ is the height of the "
    "roughness over the diameter of the particles.",
    (
        Input("height of the roughness", "1 to 6 σ: the abstract does not say which", CHOSEN),
        Input("surfaces", "σ = 0.3 µm, R = 3 µm, α = 5, H = 5 GPa", CHOSEN),
        Input("particles per area", "1e11 per m²", CHOSEN),
        Input("load F*", "1e-6 to 1e-4", CHOSEN),
    ),
    (
        statement(
            "none",
            "At λ = 20 particles make no difference",
            ABSTRACT,
            "particles' share of the load at λ = 20",
            {"kind": "at_most", "value": 0.01},
            lambda: Band.of(share(20.0)),
            remark="No difference is read as less than 1 % of the load",
        ),
        statement(
            "rolls",
            "Below λ = 6 particles roll between the surfaces",
            ABSTRACT,
            "particles' share of the load at λ = 3",
            {"kind": "at_least", "value": 0.1},
            lambda: Band.of(share(3.0)),
            remark="Needs particles that carry: read as more than 10 % of the load",
        ),
    ),
    "What “height of the roughness” means decides; a peak height of some 6σ would agree.",
)
