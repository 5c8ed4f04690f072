"""Size distributions: by a word and its numbers, and mixtures of several."""

from __future__ import annotations

from typing import Any

from .one_value import refused
from .reader import Reader, plain, reads_also
from .vocabulary import DISTRIBUTIONS

__all__ = ["parts", "sizes"]

NO_PARTS = (
    "must be a list of size distributions, e.g. "
    '[{ distribution = "monodisperse", mean = "100 nm" }, ...]'
)


def sizes(reader: Reader, path: str, data: Any) -> Any:
    """One distribution."""

    def build(values: dict[str, Any]) -> Any:
        return reader.make(DISTRIBUTIONS[values.pop("distribution")], path, values)

    return reader.variant(path, data, "distribution", DISTRIBUTIONS, build, {})


@reads_also([{}])
def parts(reader: Reader, path: str, data: Any) -> Any:
    """The components of a mixture, a list of tables."""
    if isinstance(data, list) and data:
        kinds = tuple(sizes(reader, f"{path}[{i}]", item) for i, item in enumerate(data))
        return tuple[kinds]  # type: ignore[valid-type]
    return plain(refused(path, NO_PARTS))
