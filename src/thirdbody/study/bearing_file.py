"""The study file of a ball bearing, from its designation or its dimensions."""

from __future__ import annotations

import re

from ..systems.bearing_sizes import BearingSize, bearing_size

__all__ = ["bearing_file"]

WIDTH = 27
"""Characters before a comment."""
LOAD = 0.0366
"""Radial load over the dynamic load rating."""


def bearing_file(template: str, which: str) -> str:
    """The template of a ball bearing with the numbers of another.

    Parameters
    ----------
    template : str
        The study file of the 6205.
    which : str
        Designation or dimensions, as in `thirdbody.systems.bearing_sizes.bearing_size`.
    """
    size = bearing_size(which)
    bearing = size.bearing()
    force = _force_in_kn(LOAD * bearing.rating)
    typical = "estimated" if size.estimated else "typical"
    iso = "as given" if size.estimated else "ISO 15"
    lines = {
        "bore": (_mm(size.bore), iso),
        "outer_diameter": (_mm(size.outer_diameter), f"{iso}; width {_mm(size.width)[1:-1]}"),
        "ball_diameter": (_mm(size.ball_diameter), f"{typical}: not in ISO 15; ask the maker"),
        "balls": (f"{size.balls}", typical),
        "clearance": (f'"{1e6 * size.clearance[0]:g} um"', _clearance(size)),
        "dynamic_rating": (
            f'"{1e-3 * bearing.rating:.3g} kN"',
            "C by ISO 281's formula; put the catalogue's",
        ),
        "fatigue_limit": (
            f'"{1e-3 * bearing.fatigue_load:.3g} kN"',
            "C_u = C_0/22; put the catalogue's",
        ),
        "force": (f'"{force} kN"', "radial, on the bearing"),
    }
    text = template
    for key, (value, comment) in lines.items():
        line = f"{key} = {value}".ljust(WIDTH) + f" # {comment}"
        text = re.sub(rf"^{key} = .*$", line.replace("\\", r"\\"), text, count=1, flags=re.M)
    return text.replace("6205", size.name, 2).replace("under 0.5 kN", f"under {force} kN")


def _mm(value: float) -> str:
    return f'"{1e3 * value:g} mm"'


def _force_in_kn(force: float) -> str:
    """A force to two digits, in kN."""
    return f"{float(f'{1e-3 * force:.2g}'):g}"


def _clearance(size: BearingSize) -> str:
    least, most = (f"{1e6 * clearance:g}" for clearance in size.clearance)
    return f"in operation; ISO 5753 {size.clearance_class}, unmounted: {least} to {most}"
