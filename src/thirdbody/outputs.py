"""What a solved contact does: friction, heat, current, wear, dents.

Give them as `thirdbody.Contact` (``outputs=...``), or as tables [outputs] of a study file.

- `Friction`: coefficient of friction with its parts
- `StaticFriction`: coefficient of static friction
- `FlashTemperature`: how much hotter than the bodies the contact is
- `ThermalConductance`, `ElectricalConductance`: heat and current through the contact
- `Wear`: worn volume per area and sliding length
- `Dents`: number, depth and width of what the loaded particles leave
- `Counts`: contacts per area, load of one, mean real pressure
- `Crushing`: share of the particles that have broken
- `AbstractOutput`: the base of an output of your own; `Column`: one number that it gives
- `Solved`: the solved states, as an output of your own gets them
- `REGISTRY`: every output by the word that study files use
"""

from .effects import (
    REGISTRY,
    AbstractOutput,
    Column,
    Counts,
    Crushing,
    Dents,
    ElectricalConductance,
    FlashTemperature,
    Friction,
    Solved,
    StaticFriction,
    ThermalConductance,
    Wear,
)

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
