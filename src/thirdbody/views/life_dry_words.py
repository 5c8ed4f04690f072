"""A dry contact over time in words: particles, wear, what breeds what, and what was not known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..quantities.say import join_words, number, percent, value_of
from .life_amounts import duration_of, masses_of
from .life_words import band_words, events, in_vain, stop

if TYPE_CHECKING:
    from ..study.run_dry import DryResult
    from ..systems.life.contact_history import DryHistory

__all__ = ["HEADS", "MEANS", "answer", "last_words", "rows"]

HEADS = ("time", "particles", "loaded", "share", "wear 1", "wear 2", "friction")
MEANS = {
    "particles": "per mm² of the contact, debris with them",
    "loaded": "those of them that bear load, per mm² too",
    "share": "part of the load that particles carry",
    "wear 1": "mean wear depth of the first surface",
    "friction": "of the solids, over the load",
}


def answer(result: DryResult) -> list[str]:
    """What the contact comes to, whether wear feeds itself, and how much is worn: two sentences."""
    history = result.history
    end = duration_of(float(history.times[-1]))
    stopped, vain = stop(result), in_vain(result)
    when = f"{stopped}:" if stopped else f"After {end}"
    worn = " and ".join(
        f"surface {side} by {value_of(_last(history, f'wear_{side}'), 'm', 3)}" for side in (1, 2)
    )
    return [
        f"{_tends(history)}; {history.reproduction}.",
        f"{when} wear has taken {worn}, and particles carry "
        f"{percent(_last(history, 'sa_share'))} of the load.",
        *([vain] if vain else []),
    ]


def _last(history: DryHistory, name: str) -> float:
    return float(history.more[name][1][-1])


def _count(history: DryHistory, numbers: np.ndarray) -> str:
    """Particles in the whole contact."""
    return number(float(numbers.sum()) * history.loop.setting.area, 3)


def _tends(history: DryHistory) -> str:
    """The number of particles that stays, and how soon it is there."""
    steady = history.steady()
    if not steady:
        now = _count(history, history.numbers[-1])
        said = f"The contact comes to no steady state: it holds {now} particles at the end"
        return said + _why(history)
    first = steady[0]
    per_area = number(float(first.numbers.sum()) / 1e6, 3)
    said = f"The contact comes to {_count(history, first.numbers)} particles, {per_area} per mm²"
    if not first.stable:
        return f"{said}, a state that is not stable"
    said += f", and is within a hundredth of them after {duration_of(first.time)}"
    if len(steady) > 1:
        said += f" (one of {len(steady)} steady states)"
    return said


def _why(history: DryHistory) -> str:
    """Why there is no steady state, where particles never leave."""
    slowest = float(np.min(np.linalg.eigvals(history.losses).real))
    if history.loop.loss == 0:
        return (
            ", and none ever leaves it, because life.dry.loss = 0 brings all of them round again; "
            "a loss above 0, 0.01 for one in a hundred, has an end"
        )
    return ", and some of them never leave it" if slowest <= 0 else ""


def rows(result: DryResult) -> list[list[str]]:
    """The table: a row a time."""
    history = result.history
    more = {name: values for name, (_, values) in history.more.items()}
    out = []
    for i, time in enumerate(history.times):
        out.append(
            [
                duration_of(float(time)),
                number(float(history.numbers[i].sum()) / 1e6, 3),
                number(float(more["present"][i]) / history.loop.setting.area / 1e6, 3),
                percent(float(more["sa_share"][i])),
                value_of(float(more["wear_1"][i]), "m", 3) if more["wear_1"][i] else "0",
                value_of(float(more["wear_2"][i]), "m", 3) if more["wear_2"][i] else "0",
                number(float(more["mu_solids"][i]), 3),
            ]
        )
    return out


def last_words(result: DryResult) -> list[str]:
    """Flows, events, time scales, and what was not known."""
    history = result.history
    some = [row for row in history.flows() if row[2] > 0][:3]
    masses = masses_of([mass for _, _, mass in some])
    shown = [f"{m} from {start} to {end}" for m, (start, end, _) in zip(masses, some, strict=True)]
    out = [f"Most of the particles: {join_words(shown)}."] if shown else []
    out += [*band_words(result), *events(history)]
    scales = [
        f"{name} {duration_of(time)}"
        for name, time in history.time_scales.items()
        if math.isfinite(time)
    ]
    out.append(f"Time scales: {', '.join(scales)}.")
    unknown = ["what arrives", "what comes round again (life.dry.loss)", "the wear coefficients"]
    if result.asked.debris is not None:
        unknown.append("the sizes and the hardness of the debris")
    out.append(f"What nobody can predict: {join_words(unknown)}. Vary them with --set.")
    return out
