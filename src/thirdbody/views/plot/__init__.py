"""Figures of contacts, sweeps, uncertainty, films, designs and surfaces."""

from .curves import area, modes, regimes, separation, shares
from .maps import mode_map
from .style import MODE_COLOURS, OKABE_ITO
from .topography import surface
from .uncertainty import bands, tornado

__all__ = [
    "MODE_COLOURS",
    "OKABE_ITO",
    "area",
    "bands",
    "mode_map",
    "modes",
    "regimes",
    "separation",
    "shares",
    "surface",
    "tornado",
]
