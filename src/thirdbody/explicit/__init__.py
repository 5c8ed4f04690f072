"""The interface point by point: one height map, and every particle at its place.

`solve` presses one surface, measured or synthetic; `ensemble` many, against the statistical
model. What they do without, against the statistical model: asperities that are paraboloids with
heights of one distribution, particles at independent places, a surface that is flat for each
contact, contacts that do not feel each other.
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
