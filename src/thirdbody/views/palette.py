"""Colours and hatches that figures in print and on the page share."""

from __future__ import annotations

__all__ = ["HATCHES", "MODE_COLOURS", "OKABE_ITO", "REGIMES", "tint"]

OKABE_ITO = {
    "black": "#000000",
    "blue": "#0072B2",
    "vermilion": "#D55E00",
    "green": "#009E73",
    "purple": "#CC79A7",
    "sky": "#56B4E9",
    "orange": "#E69F00",
    "yellow": "#F0E442",
}
"""Okabe and Ito's palette (Color Universal Design, 2008)."""


def tint(colour: str, strength: float) -> tuple[float, float, float]:
    """The colour, as #rrggbb, thinned with white; strength 1 is the colour itself."""
    r, g, b = (1 - strength * (1 - int(colour[at : at + 2], 16) / 255) for at in (1, 3, 5))
    return (r, g, b)


MODE_COLOURS = {
    "p-s": tint(OKABE_ITO["vermilion"], 0.65),
    "hybrid": tint(OKABE_ITO["yellow"], 0.45),
    "s-s": tint(OKABE_ITO["sky"], 0.6),
}
"""Fill of each contact mode; they differ in lightness as well as in hue."""

REGIMES = {
    "A_e": ("elastic", OKABE_ITO["sky"]),
    "A_ep": ("elastoplastic", OKABE_ITO["orange"]),
    "A_p": ("plastic", OKABE_ITO["vermilion"]),
}

HATCHES = {"A_e": "", "A_ep": "/", "A_p": "x"}
"""Of the regimes, in the letters that matplotlib and Plotly share."""
