"""Figures of contacts, sweeps, error bars and surfaces; each function draws on given axes or new.

- `area`: real contact area against load
- `separation`: separation against load
- `shares`: what part of the load, or of the area, is on particles
- `modes`: contact modes as shaded bands, with critical loads
- `regimes`: elastic, elastoplastic and plastic part of the area
- `mode_map`: contact mode over particle size and load
- `bands`: bands of an uncertain result over the load
- `tornado`: effect of each uncertain input on one result
- `surface`: a measured surface, and what hangs on its cut-off
- `explicit`: a surface pressed point by point
- `MODE_COLOURS`: colours of the modes p-s, hybrid and s-s
- `OKABE_ITO`: colours of lines by their names, told apart by colour-blind readers too
"""

from .views.plot import (
    MODE_COLOURS,
    OKABE_ITO,
    area,
    bands,
    explicit,
    mode_map,
    modes,
    regimes,
    separation,
    shares,
    surface,
    tornado,
)

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
