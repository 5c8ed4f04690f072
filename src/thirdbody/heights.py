"""Heights of asperities: how many there are at each height, in units of their deviation σ_s.

Give one as ``heights`` of `thirdbody.Roughness`. They are heights of *asperities*: taking the
skewness of a measured surface for that of its asperities is common, and an approximation.

- `GaussianHeights`: normal heights, the default
- `ExponentialHeights`: heights that end below, with an exponential tail above
- `WeibullHeights`: heights with a skewness by one shape
- `JohnsonHeights`: heights with a given skewness and kurtosis
- `HistogramHeights`: measured heights, frequencies in bins
- `Heights`: the base of a distribution of your own
"""

from .populations.heights import (
    ExponentialHeights,
    GaussianHeights,
    Heights,
    HistogramHeights,
    JohnsonHeights,
    WeibullHeights,
)

__all__ = [
    "ExponentialHeights",
    "GaussianHeights",
    "Heights",
    "HistogramHeights",
    "JohnsonHeights",
    "WeibullHeights",
]
