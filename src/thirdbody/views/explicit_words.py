"""One surface pressed point by point, beside the statistical answer: in words and numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..quantities.say import number, percent, plural, value_of

if TYPE_CHECKING:
    from ..study.one_surface import OneSurface

__all__ = ["comparison_table", "headline", "rows"]

HEAD = ("", "explicit", "statistical")


def rows(found: OneSurface, i: int) -> dict[str, tuple[str, str]]:
    """Name, explicit and statistical value of what is compared under load i."""
    state, model = found.state, found.model

    def both_values(name: str) -> tuple[float, float]:
        return tuple(float(np.atleast_1d(getattr(each, name))[i]) for each in (state, model))  # type: ignore[return-value]

    out = {"separation h": both_values("h"), "real contact area": both_values("A_t")}
    told = {name: (value_of(a, "m"), value_of(b, "m")) for name, (a, b) in out.items()}
    told["real contact area"] = (percent(out["real contact area"][0]),
                                 percent(out["real contact area"][1]))  # fmt: skip
    if not state.contact.two_body:
        a, b = both_values("particle_load_share")
        told = {"load on particles": (percent(a), percent(b))} | told
    return told


def headline(found: OneSurface, i: int) -> str:
    """Sentences on who carries, here and in the model, and how sure such a surface is."""
    state = found.state
    F = float(np.atleast_1d(state.F_star)[i])
    told = rows(found, i)
    carrying = int(np.atleast_1d(state.carrying_particles)[i])
    pixels = int(np.atleast_1d(state.carrying_pixels)[i])
    if state.contact.two_body:
        ours, theirs = told["real contact area"]
        first = f"At F* = {number(F)} {ours} of the area touches; statistically {theirs}."
    else:
        ours, theirs = told["load on particles"]
        every = state.particles.sizes["particle"]
        first = (
            f"At F* = {number(F)} particles carry {ours} of the load, {carrying} of {every} of "
            f"them; statistically {theirs}."
        )
    return (
        f"{first} This is {found.words}: {plural(carrying + pixels, 'pixel')} and particles carry, "
        "and another draw gives another number; `thirdbody explicit` takes many, with error bars."
    )


def comparison_table(found: OneSurface) -> tuple[list[str], list[list[str]]]:
    """Head and rows of a table over the loads: explicit and statistical, side by side."""
    loads = np.atleast_1d(found.state.F_star)
    each = [rows(found, i) for i in range(len(loads))]
    head = ["F*"] + [f"{name}, {which}" for name in each[0] for which in HEAD[1:]]
    lines = [
        [number(float(load)), *(cell for pair in told.values() for cell in pair)]
        for load, told in zip(loads, each, strict=True)
    ]
    return head, lines
