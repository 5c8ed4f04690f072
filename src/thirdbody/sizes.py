"""Measured sizes: a file of a size analyser, sizes by number from it, and what is fitted to them.

The model counts particles, where an analyser may weigh each with its area or volume.

- `read_sizes`: measured sizes from a CSV file
- `MeasuredSizes`: the measured histogram; its ``fit`` gives a distribution
- `Fit`: a distribution fitted to it, and how well it fits
- `by_number`: sizes by number behind sizes by area or by volume
- `WEIGHTINGS`: what a file may count, and the power of the diameter of each
- `FITS`: distributions that can be fitted, by their words
"""

from .populations.measured.sizes import (
    FITS,
    WEIGHTINGS,
    Fit,
    MeasuredSizes,
    by_number,
    read_sizes,
)

__all__ = [
    "FITS",
    "WEIGHTINGS",
    "Fit",
    "MeasuredSizes",
    "by_number",
    "read_sizes",
]
