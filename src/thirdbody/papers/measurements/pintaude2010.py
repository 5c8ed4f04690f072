"""How much harder than a surface a grain must be to leave a mark."""

from __future__ import annotations

import numpy as np

from ...laws.particle.deep import SINK_AT, squeeze_curve
from .row import Band, row_of

__all__ = ["ROW", "embeds_from"]

FRICTIONS = (0.05, 0.2, 1.0)
"""Friction factor of the faces [1]."""
SQUEEZES = (0.2, 0.3, 0.4)
RATIOS = np.geomspace(0.9, 4.0, 600)


def embeds_from(squeeze: float, friction: float) -> float:
    """Hardness ratio from which a round grain sinks by more than half of its squeeze.

    Parameters
    ----------
    squeeze : float
        Of a side over its radius ε [1].
    friction : float
        Friction factor of its faces m [1].

    Examples
    --------
    >>> round(embeds_from(0.3, 0.2), 1)
    1.6
    """
    for ratio in RATIOS:
        sinks = squeeze_curve(float(ratio), friction, 1e9).sinks
        if np.interp(squeeze, SINK_AT, sinks) > 0.5 * squeeze:
            return float(ratio)
    return float("nan")


def _band() -> Band:
    thresholds = [embeds_from(squeeze, m) for squeeze in SQUEEZES for m in FRICTIONS]
    return Band.from_values(thresholds, 'deep = "off": 1')


ROW = row_of("pintaude2010", {"ratio": _band})
