"""Cleanliness codes, test dusts and concentrations: from what is known of a fluid to its particles.

- `suspension_of_iso4406`: particles per volume and their sizes, from a code such as 18/16/13
- `read_iso4406`: its three numbers; `iso4406_range`: the counts that one of them stands for
- `iso4406_of`, `iso4406_of_counts`: the code of particles, or of counts
- `counted_sizes`: sizes from which ISO 4406 counts
- `suspension_of_class`: particles and sizes of the dirtiest fluid of a class (SAE AS4059, NAS 1638)
- `class_of`: the lowest class that permits some particles
- `CLASSES`: the words of these classes
- `TAIL_SLOPE`: how steeply their counts fall with size, s in N(>x) ∝ x^(−s)
- `dust_sizes`: sizes of a test dust; `DUSTS`: the words of the dusts
- `sizes_above`: sizes from counts above some sizes
- `concentration`: a concentration as it is written, such as 50 ppm
- `Concentration`: what it gives
- `particles_in`: particles per volume of a fluid
- `OIL_DENSITY`: the density of oil that is taken where none is given [kg/m³]
"""

from .populations.measured.cleanliness import (
    CLASSES,
    DUSTS,
    OIL_DENSITY,
    TAIL_SLOPE,
    Concentration,
    class_of,
    concentration,
    counted_sizes,
    dust_sizes,
    iso4406_of,
    iso4406_of_counts,
    iso4406_range,
    particles_in,
    read_iso4406,
    sizes_above,
    suspension_of_class,
    suspension_of_iso4406,
)

__all__ = [
    "CLASSES",
    "DUSTS",
    "OIL_DENSITY",
    "TAIL_SLOPE",
    "Concentration",
    "class_of",
    "concentration",
    "counted_sizes",
    "dust_sizes",
    "iso4406_of",
    "iso4406_of_counts",
    "iso4406_range",
    "particles_in",
    "read_iso4406",
    "sizes_above",
    "suspension_of_class",
    "suspension_of_iso4406",
]
