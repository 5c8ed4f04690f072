"""Films of oil between two bodies: how thick, what they carry, and the formulas for them.

- `mixed_film`: film, gap, load shares, real area and traction of a lubricated contact
- `stribeck`: traction and load shares over speed
- `Point`, `Line`: where two bodies meet; `Oil`: what is between them
- `Hertz`: their dry contact, load and size
- `NijenbanningVennerMoes`, `HamrockDowson`: formulas of point contacts
- `MoesLine`, `DowsonLine`: formulas of line contacts
- `AbstractFilm`: the base of a formula of your own; `FORMULAS`: formulas by their words
"""

from .systems.film_formulas import (
    FORMULAS,
    AbstractFilm,
    DowsonLine,
    HamrockDowson,
    Hertz,
    Line,
    MoesLine,
    NijenbanningVennerMoes,
    Oil,
    Point,
)
from .systems.mixed_film import mixed_film
from .systems.stribeck import stribeck

__all__ = [
    "FORMULAS",
    "AbstractFilm",
    "DowsonLine",
    "HamrockDowson",
    "Hertz",
    "Line",
    "MoesLine",
    "NijenbanningVennerMoes",
    "Oil",
    "Point",
    "mixed_film",
    "stribeck",
]
