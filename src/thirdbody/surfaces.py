"""Surfaces: measured, stated on a drawing, or made to order; from them comes a `Roughness`.

- `from_topography`: a measured surface, from a file of an instrument or from heights
- `Topography`: heights on a grid, or a profile, and what is computed from them
- `SpectralMoments`: m_0, m_2, m_4 of a surface
- `Summits`: its summits, counted
- `Curve`: moments over the cut-off, with `COLUMNS`
- `Finish`: roughness of one face as its drawing states it
- `Ellipticity`: asperities that are elliptic, as classes of one shape each
- `self_affine`: a surface of given Hurst exponent
- `from_moments`: a surface of given spectral moments
"""

from .populations.ellipticity import Ellipticity
from .populations.finish import Finish
from .populations.measured.synthetic import from_moments, self_affine
from .populations.measured.topography import (
    COLUMNS,
    Curve,
    SpectralMoments,
    Summits,
    Topography,
    from_topography,
)

__all__ = [
    "COLUMNS",
    "Curve",
    "Ellipticity",
    "Finish",
    "SpectralMoments",
    "Summits",
    "Topography",
    "from_moments",
    "from_topography",
    "self_affine",
]
