"""Waves of the roughness in [asperity_law], for the law of one field."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValue
from ..laws.asperity import OwnSpectrum, RollOff
from ..quantities.units import say
from .one_value import One
from .reader import Reader, get, plain, reads_also

__all__ = ["spectrum"]


@reads_also({})
def spectrum(reader: Reader, path: str, data: Any) -> Any:
    """``"measured"``, for the waves of the topography, or a roll-off."""
    if isinstance(data, dict):
        return reader.value(path, data, RollOff)

    def read(value: Any) -> OwnSpectrum | None:
        if value != "measured":
            raise InvalidValue(
                f'{path} = {say(value)} must be "measured", for the waves of the topography in '
                '[roughness], or a table, e.g. { hurst = 0.7, corner = "sharp" }'
            )
        if get(reader.whole.get("roughness"), "topography") is None:
            raise InvalidValue(
                f'{path} = "measured" goes with a topography in [roughness]; for σ, R and alpha '
                "leave it out, or give { hurst = 0.7 }"
            )
        if not reader.faces:
            return None  # what is wrong with the topography is told there
        try:
            one, *others = reader.faces
            return OwnSpectrum.of_both(one, others[0]) if others else OwnSpectrum.of(one)
        except InvalidValue as error:
            raise InvalidValue(*(f"{path}: {told}" for told in error.problems)) from None

    return plain(One(read, {"const": "measured"}))
