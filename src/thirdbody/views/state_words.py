"""The states of a study in words: the answer first, and what moves it most."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..equilibrium.words import (
    is_rare,
    load_of,
    meets,
    mode_among,
    mode_of,
    mode_path,
    particle_share_text,
    two_bodies,
)
from ..quantities.say import number, percent, plural, value_of
from .nature_words import sentences

if TYPE_CHECKING:
    from ..study import StudyResult
    from ..study.what_ifs import WhatIf
    from ..systems.bodies import Pressed

__all__ = ["answer", "details", "uncertainty"]


def answer(result: StudyResult) -> list[str]:
    """Who carries, and how close the surfaces are, in one or two sentences."""
    pressed_bodies = [
        pressed
        for pressed in result.forces
        if pressed.real_area is not None and pressed.kind != "flat"
    ]
    if pressed_bodies:
        return _under_forces(pressed_bodies)
    solved_states = sorted(result.solved_states, key=lambda i: result.states.pressure[i])
    if len(solved_states) == 1:
        return [_at_one(result, solved_states[0])]
    return _over_loads(result, solved_states)


def details(result: StudyResult) -> list[str]:
    """What particles are, what forces do to their bodies, and of what the states are."""
    whole = result.body_sentence()
    return [*sentences(result.natures), *result.force_sentences, *([whole] if whole else [])]


def uncertainty(result: StudyResult) -> list[str]:
    """What moves the answer most, by how much, and what to do about it."""
    most = next(iter(result.what_ifs), None)
    if most is None or not most.ratio > 1:
        return []
    load = value_of(float(result.states.pressure[result.central]), "Pa")
    if most.of == "A_t":
        moved = f"the real area at {load} is {_ends(most)} of the nominal one"
    else:
        moved = f"particles carry {_ends(most)} of the load at {load}"
    return [f"Most uncertain: {most.what}. With {most.between}, {moved}; {most.action}."]


def _ends(most: WhatIf) -> str:
    return " to ".join(percent(value) for value in most.values)


def _under_forces(pressed_bodies: Sequence[Pressed]) -> list[str]:
    """The least and the greatest force on bodies: who carries, pressure and real area."""
    ends = (
        [pressed_bodies[0]] if len(pressed_bodies) == 1 else [pressed_bodies[0], pressed_bodies[-1]]
    )
    carries = []
    for pressed in ends:
        share, some = pressed.particle_load_share, pressed.with_particles
        under = f"nder {value_of(pressed.force, 'N')}"
        if share is None:
            carries.append(f"u{under} asperities carry the whole load, as there are no particles")
        elif (rare := meets(pressed.particles_held or 0.0)) and some is not None:
            carries.append(
                f"u{under} {rare}, and there particles carry "
                f"{percent(some['particle_load_share'])} of the load, on average over all contacts "
                f"{percent(share)}"
            )
        else:
            carries.append(f"u{under} particles carry {percent(share)} of the load")
    largest = " to ".join(value_of(pressed.maximum, "Pa") for pressed in ends)
    real = " to ".join(percent(float(pressed.real_area or 0.0) / pressed.area) for pressed in ends)
    loads = [pressed.heaviest for pressed in ends if pressed.heaviest is not None]
    most = ""
    if len(loads) == len(ends):
        which = plural(int(ends[0].bodies), "contact")
        most = (
            f" on the most loaded of {which} ({' to '.join(value_of(load, 'N') for load in loads)})"
        )
    return [
        f"U{'; '.join(carries)[1:]}.",
        f"The largest Hertz pressure{most} is {largest}, and the real area is {real} of Hertz's.",
    ]


def _at_one(result: StudyResult, i: int) -> str:
    """One state, in a sentence."""
    states = result.states
    gap = (
        f"separation h = {value_of(states.h[i], 'm')} "
        f"(d = {value_of(states.d[i], 'm')}, {number(states.d_star[i], 3)} sigma)"
    )
    at = f"At {load_of(states.pressure[i], states.F_star[i])}"
    if not states.A_t[i]:
        return f"{at} {mode_of(None)}; {gap}."
    area = f"real contact area {percent(states.A_t[i])} of the nominal area"
    if result.study.contact.two_body:
        return f"{at} {two_bodies()}; {gap}, {area}."
    parts = {population.name: population.load_share[i] for population in states.populations}
    share = particle_share_text(states.particle_load_share[i], parts)
    mode, held = states.mode[i], result.particles_in(i)
    where = " of a wide surface" * is_rare(mode, held)
    return f"{at} {mode_among(mode, held)}, and {share}{where}; {gap}, {area}."


def _over_loads(result: StudyResult, solved_states: Sequence[int]) -> list[str]:
    """Least to greatest load, in two sentences."""
    states, ends = result.states, (solved_states[0], solved_states[-1])

    def both(say: Sequence[str]) -> str:
        return say[0] if say[0] == say[1] else " to ".join(say)

    loads = both([value_of(states.pressure[i], "Pa") for i in ends])
    gaps = both([value_of(states.h[i], "m") for i in ends])
    areas = both([percent(states.A_t[i]) for i in ends])
    apart = (
        f"separation h goes from {gaps}, and the real contact area is {areas} of the nominal one"
    )
    if result.study.contact.two_body:
        return [f"From {loads} {two_bodies()}.", f"Over these loads {apart}."]
    share = both([percent(states.particle_load_share[i]) for i in ends])
    parts = [
        f"{population.name} {both([percent(population.load_share[i]) for i in ends])}"
        for population in states.populations
    ]
    by_population = f" ({', '.join(parts)})" if parts else ""
    rare = [i for i in ends if is_rare(states.mode[i], result.particles_in(i))]
    where = " of a wide surface" * bool(rare)
    first = f"From {loads} particles carry {share} of the load{by_population}{where}"
    if rare:
        first += f"; {meets(result.particles_in(rare[0]))}, and the others are as without particles"
        return [f"{first}.", f"Over these loads {apart}."]
    return [f"{first}.", f"{mode_path(states.mode[i] for i in solved_states)}; {apart}."]
