"""What a solved contact does. A new output is one file here and one import line below."""

from ..contact.evaluation import Solved
from ..contact.output import AbstractOutput, Column
from .conductance import ElectricalConductance, ThermalConductance
from .counts import Counts
from .crushing import Crushing
from .dents import Dents
from .friction import Friction
from .static_friction import StaticFriction
from .temperature import FlashTemperature
from .wear import Wear

REGISTRY = AbstractOutput.registry
"""Every output by the word that study files use."""

__all__ = [
    "REGISTRY",
    "AbstractOutput",
    "Column",
    "Counts",
    "Crushing",
    "Dents",
    "ElectricalConductance",
    "FlashTemperature",
    "Friction",
    "Solved",
    "StaticFriction",
    "ThermalConductance",
    "Wear",
]
