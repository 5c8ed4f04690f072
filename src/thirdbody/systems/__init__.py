"""Systems around a contact: films, oil, bodies, waves, bearings."""

from . import bearing_life as bearing_life
from . import chuck as chuck
from . import connector as connector
from . import contact_probability as contact_probability
from . import oil_particles as oil_particles
from . import plate_over_particle as plate_over_particle

__all__ = [
    "bearing_life",
    "chuck",
    "connector",
    "contact_probability",
    "oil_particles",
    "plate_over_particle",
]
