"""The interface point by point: one height map, and every particle at its place.

Of what the statistical model assumes these do without: asperities that are paraboloids with
heights of one distribution, particles at independent places, a surface that is flat for each
contact, contacts that do not feel each other.

- `solve`: one surface, measured or made, pressed with its particles; it gives an `ExplicitState`
- `ensemble`: many surfaces against the statistical model; it gives an `Ensemble`
- `surface_of`: a surface with the roughness of a contact
- `RandomSeats`: particles anywhere
- `SettledSeats`, `HighestSeats`: on the lowest, or the highest, of some random spots
- `DownhillSeats`, `ValleySeats`: down the slope from a random place
- `SummitSeats`: on summits
- `SphereSeats`: at a random place, as a sphere rests on all heights under it
- `GivenSeats`: at places of your own
"""

from .ensemble import Ensemble, ensemble, surface_of
from .seats import (
    DownhillSeats,
    GivenSeats,
    HighestSeats,
    RandomSeats,
    SettledSeats,
    SphereSeats,
    SummitSeats,
    ValleySeats,
)
from .solve import solve
from .state import ExplicitState

__all__ = [
    "DownhillSeats",
    "Ensemble",
    "ExplicitState",
    "GivenSeats",
    "HighestSeats",
    "RandomSeats",
    "SettledSeats",
    "SphereSeats",
    "SummitSeats",
    "ValleySeats",
    "ensemble",
    "solve",
    "surface_of",
]


def __dir__() -> list[str]:
    return sorted(__all__)
