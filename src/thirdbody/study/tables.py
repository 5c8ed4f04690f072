"""Every table that a study file may hold, in the order in which they are read.

A new one is a file with a `Table` in it and one line here.
"""

from __future__ import annotations

from .connector import CONNECTOR
from .design import DESIGN
from .explicit import EXPLICIT
from .film import FILM
from .life import LIFE
from .load import BODY, LOAD
from .outputs import OUTPUTS
from .particles import PARTICLES
from .plate import PLATE
from .reader import Table, text
from .roughness import ROUGHNESS
from .surfaces import ASPERITY_LAW, OWN_MATERIALS, PARTICLE_LAW, SURFACES
from .sweep import SWEEP
from .uncertainty import UNCERTAINTY

__all__ = ["TABLES"]

TABLES: tuple[Table, ...] = (
    Table(name="title", key=text._replace(about="a line of text"), role="study"),
    OWN_MATERIALS,
    SURFACES,
    ROUGHNESS,
    Table(name="asperity_law", key=ASPERITY_LAW),
    PARTICLES,
    Table(name="particle_law", key=PARTICLE_LAW),
    OUTPUTS,
    BODY,
    LOAD,
    FILM,
    CONNECTOR,
    PLATE,
    LIFE,
    SWEEP,
    UNCERTAINTY,
    DESIGN,
    EXPLICIT,
)
