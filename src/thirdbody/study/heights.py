"""The distribution of asperity heights: a word, or a table with its numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InvalidValue
from ..populations.heights import Heights
from ..quantities.units import say
from .fields import needed_fields
from .mistakes import in_file
from .one_value import One, word
from .reader import Reader, plain, reads_also
from .vocabulary import HEIGHTS

__all__ = ["heights"]


@reads_also({})
def heights(reader: Reader, path: str, data: Any) -> Any:
    """One kind of heights."""

    def build(values: dict[str, Any]) -> Any:
        made = reader.make(HEIGHTS[values.pop("name")], path, values)
        try:
            with np.errstate(all="ignore"):
                _ = made.pieces  # some shapes exist in no member of the family
        except InvalidValue as error:
            raise in_file(error, type(made), path, values) from None
        return made

    if isinstance(data, dict):
        return reader.variant(path, data, "name", HEIGHTS, build, {})

    def from_word(value: Any) -> Heights:
        name = word(path, HEIGHTS)(value)
        needed = needed_fields(HEIGHTS[name])
        if needed:
            shown = ", ".join(f"{field} = ..." for field in needed)
            raise InvalidValue(
                f"{path} = {say(name)} is missing {', '.join(needed)}: write it as a table, "
                f"{{ name = {say(name)}, {shown} }}"
            )
        return build({"name": name})

    return plain(One(from_word, word(path, HEIGHTS).schema))
