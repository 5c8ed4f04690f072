"""Laws of one particle between two surfaces: its load and contact area at each gap.

Give one as ``particle_law`` of `thirdbody.Contact`.

- `Series`: indents both surfaces with one load, from wherever it rests; the default
- `Flakes`: flat particles that lie on their broad side
- `Horng2022`: the formulas of Horng et al. 2022, with their errors as switches
- `PRESETS`: named sets of the switches of `Horng2022`
- `AbstractParticleLaw`: the base of a law of your own
- `SeatedLaw`: the base of a law whose particles rest on a seat
- `OneParticle`: one particle of unit size, for such a law
- `Squeezed`: many particles of unit size, each squeezed by some share
- `contact_sides`: E*, H and ν where the particle meets each surface
- `REGISTRY`: every law by the word that study files use
"""

from .laws.particle import (
    PRESETS,
    REGISTRY,
    AbstractParticleLaw,
    Flakes,
    Horng2022,
    OneParticle,
    SeatedLaw,
    Series,
    Squeezed,
    contact_sides,
)

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
