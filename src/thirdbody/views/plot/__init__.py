"""Figures of contacts, sweeps, uncertainty, films, designs, surfaces and maps under pressure."""

from .curves import area, modes, regimes, separation, shares
from .explicit import explicit
from .maps import mode_map
from .style import MODE_COLOURS, OKABE_ITO
from .topography import surface
from .uncertainty import bands, tornado

__all__ = [
    "MODE_COLOURS",
    "OKABE_ITO",
    "area",
    "bands",
    "explicit",
    "mode_map",
    "modes",
    "regimes",
    "separation",
    "shares",
    "surface",
    "tornado",
]
