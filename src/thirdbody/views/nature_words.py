"""What the particles of each population are, in words."""

from __future__ import annotations

from collections.abc import Sequence

from ..quantities.say import percent, value_of
from ..systems.natures import Nature

__all__ = ["sentences"]

CURRENT = {True: "conducts", False: "insulates", None: "not known"}


def sentences(found: Sequence[Nature]) -> list[str]:
    """A sentence a population: does it conduct, dent, break."""
    return [_sentence(each) for each in found]


def _sentence(each: Nature) -> str:
    of = f" ({each.material})" if each.material not in ("", each.name) else ""
    current = CURRENT[each.conducts] if each.conducts is not None else "may conduct or not"
    since = value_of(each.breaks_from, "m", 2)
    kept = 'is kept whole without strength = "material"'
    end = {
        "breaks": f"breaks from {since} on",
        "would break": f"would break from {since} on, but {kept}",
        "stays whole": "stays whole",
        "not known": "is kept whole, as no strength of it is known",
    }[each.breaks]
    sinks = "" if each.sinks is None else f" ({percent(each.sinks, digits=2)} of it sinks in)"
    return (
        f"{each.name[:1].upper()}{each.name[1:]}{of} {current}, {each.pressed}{sinks}, and {end}."
    )
