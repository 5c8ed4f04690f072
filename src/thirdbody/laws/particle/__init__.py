"""Laws of particles between two surfaces. A new law is one file here and one import line below."""

from ..base import AbstractParticleLaw, OneParticle, SeatedLaw, Squeezed
from .flakes import Flakes
from .horng2022 import PRESETS, Horng2022
from .one_particle import contact_sides
from .series import Series

REGISTRY = AbstractParticleLaw.registry
"""Every law by the word that study files use."""

__all__ = [
    "PRESETS",
    "REGISTRY",
    "AbstractParticleLaw",
    "Flakes",
    "Horng2022",
    "OneParticle",
    "SeatedLaw",
    "Series",
    "Squeezed",
    "contact_sides",
]
