"""Sizes of particles: how many there are of each diameter, by number.

Give one as ``diameter`` of `thirdbody.Particles`.

- `TruncatedGaussian`: Gaussian sizes, cut at n standard deviations and at zero
- `LogNormal`: sizes whose logarithm is Gaussian
- `Weibull`: Weibull sizes (Rosin–Rammler by number)
- `Uniform`: every diameter between two limits equally often
- `Monodisperse`: one diameter
- `PowerLaw`: counts per section of sizes, with a power law inside each
- `Histogram`: measured sizes, counts in bins
- `Mixture`: several kinds of sizes together
- `Distribution`: the base of a distribution of your own
"""

from .populations.distributions import (
    Distribution,
    Histogram,
    LogNormal,
    Mixture,
    Monodisperse,
    PowerLaw,
    TruncatedGaussian,
    Uniform,
    Weibull,
)

__all__ = [
    "Distribution",
    "Histogram",
    "LogNormal",
    "Mixture",
    "Monodisperse",
    "PowerLaw",
    "TruncatedGaussian",
    "Uniform",
    "Weibull",
]
