"""A lubricated contact in words: its state at one speed, and where regimes change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..effects.friction import Friction
from ..equilibrium.words import meets
from ..quantities.say import NOT_KNOWN, number, percent, value_of
from ..systems.mixed_film import FULL

if TYPE_CHECKING:
    from ..study import FilmResult

__all__ = ["answer", "bodies", "point", "share", "summary"]

FRICTION = {
    "mu": "friction coefficient",
    "mu_film": "of it the film",
    "mu_ss": "of it asperities",
    "mu_sa": "of it particles",
}
"""Columns of the friction, and what they are called."""


def point(result: FilmResult, i: int) -> dict[str, str]:
    """Name and value of every number at speed i of what `run_film` found."""
    at = {name: column[i] for name, column in result.states.items()}
    rows = {
        "film thickness, mean gap h_T": value_of(at["h_T"], "m"),
        "film of smooth bodies": value_of(at["h_smooth"], "m"),
        "film over roughness λ = h_T/σ": value_of(at["lambda_ratio"], "1"),
        "separation of the mean planes h": value_of(at["h"], "m"),
        "load on the film": share(at["film_share"]),
        "load on asperities": share(at["ss_share"]),
        "load on particles": share(at["sa_share"]),
        "real contact area": share(at["A_t"]),
        **{words: _coefficient(at[name]) for name, words in FRICTION.items()},
        "viscosity in the film": value_of(at["viscosity"], "Pa s"),
        "regime": at["regime"],
    }
    if not result.passing:
        del rows["load on particles"], rows["of it particles"]
    for name in FRICTION:  # the summary says what is lacking
        if {_coefficient(value) for value in result.states[name]} <= {NOT_KNOWN}:
            rows.pop(FRICTION[name], None)
    for population in result.passing:
        if population.share[i] > 0:
            rows[f"{population.name}: particles narrower than h"] = share(population.share[i])
    if brought := result.entrainment:
        rows["largest particle dragged in"] = value_of(brought.largest[i], "m")
        for population, density in zip(result.passing, brought.areal_density, strict=True):
            rows[f"{population.name}: particles that enter"] = value_of(density[i], "1/m^2")
    return rows


def answer(result: FilmResult) -> list[str]:
    """Who carries, and where regimes change, in two sentences."""
    states, ends = result.states, sorted({0, len(result.states["speed"]) - 1})

    def ends_of(name: str, unit: str = "") -> str:
        said = [states[name][i] for i in ends]
        return " to ".join(dict.fromkeys(
            share(value) if not unit else value_of(value, unit, 3) for value in said
        ))  # fmt: skip

    lambdas = " to ".join(number(states["lambda_ratio"][i], 2) for i in ends)
    solids = [f"asperities {ends_of('ss_share')}"]
    solids += [f"particles {ends_of('sa_share')}"] if result.passing else []
    where = f"From {ends_of('speed', 'm/s')}" if len(ends) > 1 else f"At {ends_of('speed', 'm/s')}"
    return [
        f"{where} the film of {ends_of('h_T', 'm')} carries {ends_of('film_share')} of the load "
        f"(lambda = {lambdas}), {' and '.join(solids)}.",
        f"Lubrication is {', and '.join(_regimes(result))}.",
    ]


def bodies(result: FilmResult) -> str:
    """The bodies, their load and its Hertz pressure."""
    film = result.conditions
    which = "mean" if film.hertz == "mean" else "largest"
    return (
        f"{film.conjunction.shape} contact under {value_of(film.load, 'N')}, "
        f"{which} Hertz pressure {value_of(result.states['pressure'][0], 'Pa')}"
    )


def summary(result: FilmResult) -> list[str]:
    """Sentences on regimes, on what passes, and on friction that is not known."""
    states = result.states
    out = [f"Lubrication is {', and '.join(_regimes(result))}."]
    ends = sorted({0, len(states["speed"]) - 1})
    narrower = [
        population for population in result.passing if any(population.share[i] > 0 for i in ends)
    ]
    if result.passing and not narrower:
        gap = value_of(max(states["h"][i] for i in ends), "m")
        out.append(f"No particle is narrower than the gap of {gap}{' at most' * (len(ends) > 1)}.")
    for population in narrower:
        at = [
            f"{share(population.share[i])} of the particles are narrower than the gap of "
            f"{value_of(states['h'][i], 'm')} at {value_of(states['speed'][i], 'm/s')}"
            for i in ends
        ]
        out.append(f"{population.name}: {'; '.join(at)}.")
    if rare := meets(result.particles_held or 0.0):
        out.append(f"{rare[0].upper()}{rare[1:]}, and the others are as without particles.")
    if lacking := _lacking(result):
        out.append(f"There is no friction coefficient without {', '.join(lacking)}.")
    return out


def _regimes(result: FilmResult) -> list[str]:
    """Up to where it is boundary, and from where the film is full; or why it never is."""
    film = result.conditions
    slow, fast = result.regime_speeds
    most, few = (
        f"solids carry {percent(load_share)} of the load" for load_share in (film.most, film.few)
    )
    out = [f"boundary up to {value_of(slow, 'm/s')}, where {most}"]
    if slow is None:
        out = [f"never boundary, because there is no speed at which {most}"]
    if fast is not None:
        return [*out, f"a full film from {value_of(fast, 'm/s')}, where {few}"]
    if set(result.states["regime"]) == {FULL}:
        return [f"a full film at every speed, because there is none at which {few}"]
    return [*out, f"never a full film, because there is none at which {few}"]


def share(value: float | None) -> str:
    """A share; nobody reads those below a millionth."""
    return percent(value, least=1e-6)


def _coefficient(value: float | None) -> str:
    return number(value, least=1e-9)


def _lacking(result: FilmResult) -> list[str]:
    """Keys that a study must give to have a friction coefficient."""
    film, outputs = result.conditions, result.study.contact.outputs
    needs = {
        "film.slide_roll": film.slide_roll is None,
        "film.oil.eyring_stress": film.oil.eyring_stress is None,
        "[outputs.friction]": not any(isinstance(output, Friction) for output in outputs),
    }
    return [name for name, lacks in needs.items() if lacks]
