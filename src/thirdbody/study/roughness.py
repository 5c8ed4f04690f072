"""The table [roughness]: σ, R and η, or a drawing or a measured surface in their place."""

from __future__ import annotations

import math
from typing import Any

from ..errors import InvalidValue
from ..populations.roughness import Roughness
from ..quantities.say import value_of
from ..quantities.units import say, to_si
from .drawing import drawn, is_drawn
from .reader import Reader, Table, get, reads_also
from .topography import topography

__all__ = ["TABLE"]


@reads_also({"Ra": ""}, {"topography": ""})
def roughness(reader: Reader, path: str, data: Any) -> Any:
    """The equivalent rough surface."""
    if isinstance(data, dict) and "topography" in data:
        return topography(reader, path, data)
    if is_drawn(data):
        return drawn(reader, path, data)
    keys = reader.keys_of(Roughness, path, data)
    about = keys["sigma"].about
    keys["sigma"] = keys["sigma"]._replace(about=f'{about}, or Ra = "0.2 um" of the drawing')
    spare = reader.only_one(path, data)
    shape = get(data, "ellipticity")
    two_faces = get(shape, "R_first") is not None and get(shape, "R_second") is not None
    if two_faces:
        keys["R"] = keys["R"]._replace(required=False)

    def build(values: dict[str, Any]) -> Roughness:
        kept = {key: value for key, value in values.items() if key not in spare}
        if two_faces:
            first, second = (to_si(shape[key], "m") for key in ("R_first", "R_second"))
            both = first * second / (first + second)
            if not math.isclose(kept.setdefault("R", both), both, rel_tol=0.01):
                raise InvalidValue(
                    f"{path}.R = {say(data['R'])} must be R_first R_second/(R_first + R_second)"
                    f" = {value_of(both, 'm')} of the ellipticity; leave it out"
                )
        return reader.make(Roughness, path, kept)

    return reader.table(path, keys, build)


TABLE = Table(
    name="roughness",
    read=roughness,
    about='a table [roughness], e.g. sigma = "100 nm", R = "2.8 um"',
    required=lambda whole: True,
)
