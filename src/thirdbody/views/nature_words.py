"""What the particles of each population are, in words."""

from __future__ import annotations

from collections.abc import Sequence

from ..quantities.say import percent, value_of
from ..systems.natures import Nature

__all__ = ["sentences"]

CURRENT = {True: "conducts", False: "insulates", None: "not known"}


def sentences(natures: Sequence[Nature]) -> list[str]:
    """A sentence a population: does it conduct, dent, break."""
    return [_sentence(nature) for nature in natures]


def _sentence(nature: Nature) -> str:
    of = f" ({nature.material})" if nature.material not in ("", nature.name) else ""
    current = CURRENT[nature.conducts] if nature.conducts is not None else "may conduct or not"
    since = value_of(nature.breaks_from, "m", 2)
    kept = 'is kept whole without strength = "material"'
    end = {
        "breaks": f"breaks from {since} on",
        "would break": f"would break from {since} on, but {kept}",
        "stays whole": "stays whole",
        "not known": "is kept whole, as no strength of it is known",
    }[nature.breaks]
    sinks = "" if nature.sinks is None else f" ({percent(nature.sinks, digits=2)} of it sinks in)"
    return (
        f"{nature.name[:1].upper()}{nature.name[1:]}{of} {current}, {nature.pressed}{sinks}, "
        f"and {end}."
    )
