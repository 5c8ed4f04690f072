"""Laws of one asperity pressed by a flat: its load and real area at each depth.

Give one as ``asperity_law`` of `thirdbody.Contact`.

- `ZMC`: yields in three stages, joined by a logarithm of pressure; the default
- `GW`: stays elastic however deep it is pressed
- `CEB`: keeps its volume once it yields
- `KE`: power laws between yield and full plasticity
- `JG`: finite-element fits, with a hardness that depends on the shape
- `Hermite`: areas of ZMC with a mean pressure that is smooth
- `EllipticCEB`, `EllipticZMC`: elliptic asperities; `elliptic_hertz`: their elastic contact
- `JKR`, `DMT`: asperities that adhere, in the contact or around it
- `Coated`: a bonded elastic coating on a substrate
- `Field`: no asperities, but the surface pressed as a whole, with merging summits
- `RollOff`, `OwnSpectrum`: waves of the surface for `Field`, by a form or of your own
- `AbstractAsperityLaw`: the base of a law of your own
- `Branch`: one smooth piece of a law; `Jump`: its steps where two pieces meet
- `REGISTRY`: every law by the word that study files use
"""

from .laws.asperity import (
    CEB,
    DMT,
    GW,
    JG,
    JKR,
    KE,
    REGISTRY,
    ZMC,
    AbstractAsperityLaw,
    Branch,
    Coated,
    EllipticCEB,
    EllipticZMC,
    Field,
    Hermite,
    Jump,
    OwnSpectrum,
    RollOff,
    elliptic_hertz,
)

__all__ = [
    "CEB",
    "DMT",
    "GW",
    "JG",
    "JKR",
    "KE",
    "REGISTRY",
    "ZMC",
    "AbstractAsperityLaw",
    "Branch",
    "Coated",
    "EllipticCEB",
    "EllipticZMC",
    "Field",
    "Hermite",
    "Jump",
    "OwnSpectrum",
    "RollOff",
    "elliptic_hertz",
]
