"""A plate on a chuck in words: how high it stands over a particle, and how often too high."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..quantities.say import number, percent, value_of
from ..systems.connector import name_of
from ..systems.plate_over_particle import ATOM

if TYPE_CHECKING:
    from ..study.run_plate import PlateResult

__all__ = ["MEANS", "answer", "facts", "heads", "rows", "uncertainty"]

MEANS = {
    "plate stands": "height above the chuck over the particle",
    "of its size": "that over the particle's diameter",
    "bump wide": "diameter of what is lifted",
    "force": "on the particle",
}
FEW = 1e-6


def answer(result: PlateResult) -> list[str]:
    """Sentences on the height of the plate, and how often it is too high."""
    i, chuck = result.at, result.asked.chuck
    height, grain = float(result.height[i]), float(result.grain[i])
    of = f"a particle of {value_of(grain, 'm', 3)} ({result.particles[i]})"
    names = [name_of(dust, n) for n, dust in enumerate(chuck.particles)]
    kinds_of_name = zip(names, result.breaking, strict=True)
    whole = grain < min(end for name, end in kinds_of_name if name == result.particles[i])
    out = [
        f"The plate stands {'' if whole else 'at most '}{value_of(height, 'm', 3)} high over {of}, "
        f"{percent(height / grain, digits=2)} of "
        f"its diameter, on a bump {value_of(float(result.width[i]), 'm', 3)} wide."
    ]
    if height < ATOM:
        force = value_of(float(result.force[i]), "N", 3)
        out = [
            f"The plate does not stand on {of}: a force of {force} presses the particle into plate "
            f"and chuck until the gap is {_height_in_words(height)}, less than an atom."
        ]
    if chuck.limit is None:
        return out
    limit = value_of(chuck.limit, "m")
    kinds = zip(result.lifting, names, strict=True)
    sizes = ", ".join(f"{value_of(x, 'm', 3)} ({name})" for x, name in kinds)
    if result.bumps is None or result.none is None:
        return [*out, f"Particles from {sizes} on lift it above the limit of {limit}."]
    pairs = zip(result.lifting, result.breaking, strict=True)
    most, least = ("at most ", "at least ") if any(x >= end for x, end in pairs) else ("", "")
    return [
        *out,
        f"Above the limit of {limit} there are {most}{number(result.bumps, 3, least=FEW)} bumps on "
        f"a plate, and {least}{percent(result.none, least=FEW)} of the plates have none: particles "
        f"from {sizes} on lift it so high.",
    ]


def _height_in_words(height: float) -> str:
    """A height in words: none is told to less than an atom.

    >>> _height_in_words(4.1e-7), _height_in_words(2.42e-14)
    ('410 nm', 'below 0.1 nm')
    """
    return f"below {value_of(ATOM, 'm')}" if height < ATOM else value_of(height, "m", 3)


def _height_in_cell(height: float) -> str:
    """The same in a table."""
    return _height_in_words(height).replace("below", "<")


def uncertainty(result: PlateResult) -> list[str]:
    """Sentences on what moves the answer most, by how much, and what to do."""
    most = result.what_ifs[0]
    if not most.ratio > 1:
        return []
    if result.bumps is None:
        low, high = _height_in_words(most.low), _height_in_words(most.high)
        ends = f"it stands {low} to {high} high" if low != high else f"it stands {low} high"
        if most.high < ATOM:
            ends = f"the gap stays {high}"
    else:
        low, high = (number(count, 3, least=FEW) for count in (most.low, most.high))
        ends = f"there are {low} to {high} bumps above the limit"
    return [f"Most uncertain: {most.what}. With {most.between} {ends}; {most.action}."]


def _share_of_size(height: float, grain: float) -> str:
    """A height over the diameter of the particle."""
    return (
        f"< {percent(ATOM / grain, digits=2)}"
        if height < ATOM
        else percent(height / grain, digits=2, least=FEW)
    )


def _width_of_bump(result: PlateResult, i: int) -> str:
    """How wide a bump is; a dash where there is none."""
    return "-" if result.height[i] < ATOM else value_of(float(result.width[i]), "m", 3)


def _columns(result: PlateResult, i: int) -> dict[str, str]:
    """The cells of one particle by their heads; its kind where there are several."""
    kinds = {"of": result.particles[i]} if len(result.asked.chuck.particles) > 1 else {}
    height, grain = float(result.height[i]), float(result.grain[i])
    return {
        "particle": value_of(grain, "m", 3),
        **kinds,
        "plate stands": _height_in_cell(height),
        "of its size": _share_of_size(height, grain),
        "bump wide": _width_of_bump(result, i),
        "force": value_of(float(result.force[i]), "N", 3),
    }


def heads(result: PlateResult) -> tuple[str, ...]:
    """The heads of the table."""
    return tuple(_columns(result, 0))


def rows(result: PlateResult) -> list[list[str]]:
    """The table: a row a particle."""
    return [list(_columns(result, i).values()) for i in range(len(result.grain))]


def facts(result: PlateResult) -> dict[str, str]:
    """Named numbers of the particle that the answer tells of."""
    i = result.at
    out = {
        "particle": value_of(float(result.grain[i]), "m", 3),
        "plate stands": _height_in_cell(float(result.height[i])),
        "bump wide": _width_of_bump(result, i),
        "force on the particle": value_of(float(result.force[i]), "N", 3),
    }
    if result.bumps is not None:
        out["bumps above the limit"] = number(result.bumps, 3, least=FEW)
        out["plates without one"] = percent(result.none, least=FEW)
    return out
