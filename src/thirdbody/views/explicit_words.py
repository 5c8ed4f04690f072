"""One surface pressed point by point, beside the statistical answer: in words and numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..quantities.say import number, percent, plural, value_of

if TYPE_CHECKING:
    from ..study.one_surface import OneSurface

__all__ = ["comparison_table", "headline", "rows"]

HEAD = ("", "explicit", "statistical")


def rows(surface: OneSurface, i: int) -> dict[str, tuple[str, str]]:
    """Name, explicit and statistical value of what is compared under load i."""
    state, model = surface.state, surface.model

    def both_values(name: str) -> tuple[float, float]:
        return tuple(
            float(np.atleast_1d(getattr(solution, name))[i]) for solution in (state, model)
        )  # type: ignore[return-value]

    out = {"separation h": both_values("h"), "real contact area": both_values("A_t")}
    texts = {name: (value_of(a, "m"), value_of(b, "m")) for name, (a, b) in out.items()}
    texts["real contact area"] = (percent(out["real contact area"][0]),
                                 percent(out["real contact area"][1]))  # fmt: skip
    if not state.contact.two_body:
        a, b = both_values("particle_load_share")
        texts = {"load on particles": (percent(a), percent(b))} | texts
    return texts


def headline(surface: OneSurface, i: int) -> str:
    """Sentences on who carries, here and in the model, and how sure such a surface is."""
    state = surface.state
    F = float(np.atleast_1d(state.F_star)[i])
    texts = rows(surface, i)
    carrying = int(np.atleast_1d(state.carrying_particles)[i])
    pixels = int(np.atleast_1d(state.carrying_pixels)[i])
    if state.contact.two_body:
        ours, theirs = texts["real contact area"]
        first = f"At F* = {number(F)} {ours} of the area touches; statistically {theirs}."
    else:
        ours, theirs = texts["load on particles"]
        every = state.particles.sizes["particle"]
        first = (
            f"At F* = {number(F)} particles carry {ours} of the load, {carrying} of {every} of "
            f"them; statistically {theirs}."
        )
    return (
        f"{first} This is {surface.words}: {plural(carrying + pixels, 'pixel')} and particles "
        "carry, and another draw gives another number; `thirdbody explicit` takes many, with "
        "error bars."
    )


def comparison_table(surface: OneSurface) -> tuple[list[str], list[list[str]]]:
    """Head and rows of a table over the loads: explicit and statistical, side by side."""
    loads = np.atleast_1d(surface.state.F_star)
    texts_per_load = [rows(surface, i) for i in range(len(loads))]
    head = ["F*"] + [f"{name}, {which}" for name in texts_per_load[0] for which in HEAD[1:]]
    lines = [
        [number(float(load)), *(cell for pair in texts.values() for cell in pair)]
        for load, texts in zip(loads, texts_per_load, strict=True)
    ]
    return head, lines
