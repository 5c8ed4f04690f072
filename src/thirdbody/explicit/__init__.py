"""The interface point by point: one height map, and every particle at its place.

`solve` presses one surface, measured or synthetic. What it does without, against the statistical
model: asperities that are paraboloids with heights of one distribution, particles at independent
places, a surface that is flat for each contact, contacts that do not feel each other.
"""

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
    "ExplicitState",
    "GivenSeats",
    "HighestSeats",
    "RandomSeats",
    "SettledSeats",
    "SphereSeats",
    "SummitSeats",
    "ValleySeats",
    "solve",
]
