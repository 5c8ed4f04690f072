"""What of a contact varies from state to state, as the compiled engine has to know it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ...contact.contact import Contact
from ...errors import InvalidValue, NotCompiled
from ...laws.base import AbstractAsperityLaw
from ...populations.distributions import Distribution
from ...populations.materials import MaterialPair
from ...populations.particles import Particles
from ...populations.roughness import Roughness

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = [
    "MATERIALS",
    "NOT_MONOTONE",
    "SHAPES",
    "bare",
    "common_law",
    "fineness",
    "own_sizes",
    "size_factor",
]

MATERIALS = ("surfaces.", "particles.material.")
"""Inputs on which the contact of a particle depends."""
SHAPES = "particles.shape."
NOT_MONOTONE = "the load may rise with the separation; this is the loading branch"


def bare(contact: Contact, arrays: Mapping[str, Array]) -> bool:
    """Whether there are no particles in any of the states."""
    return contact.two_body and "particles.areal_density" not in arrays


def own_sizes(contact: Contact, arrays: Mapping[str, Array]) -> bool:
    """Whether the shape of the sizes varies from state to state."""
    particles = contact.particles
    return isinstance(particles, Particles) and size_factor(particles.diameter, arrays) is None


def fineness(arrays: Mapping[str, Array]) -> Array:
    """Particle sizes over roughness, up to a factor: it tells how many nodes a state needs."""
    sizes = arrays.get("particles.diameter.mean", np.ones(1))
    rough = arrays.get("roughness.sigma", np.ones(1)) * arrays.get("particle_law.zeta_std", 1.0)
    return np.broadcast_to(sizes / rough, max(map(len, arrays.values())))


def size_factor(sizes: Distribution, arrays: Mapping[str, Array]) -> Array | float | None:
    """Factor on every length of the sizes (N,), or None where their shape varies."""
    prefix = "particles.diameter."
    varied = {k.removeprefix(prefix): v for k, v in arrays.items() if k.startswith(prefix)}
    changed = {name: v for name, v in varied.items() if np.any(v != getattr(sizes, name, np.nan))}
    if not changed:
        return 1.0
    fields = dataclasses.fields(sizes)  # type: ignore[arg-type]
    about = {item.name: item.metadata.get("quantity", {}) for item in fields}
    lengths = {name for name in about if about[name].get("unit") == "m"}
    if set(changed) != lengths:
        return None
    first, *others = (changed[name] / getattr(sizes, name) for name in sorted(lengths))
    alike = all(np.allclose(ratio, first, rtol=1e-14, atol=0) for ratio in others)
    return first if alike else None


def common_law(
    law: AbstractAsperityLaw, rough: Roughness, surfaces: MaterialPair
) -> AbstractAsperityLaw:
    """The law bound to its contact, where all states bind it alike."""
    first, second = surfaces.first, surfaces.second
    nu = np.where(first.H <= second.H, first.nu, second.nu)
    quantities = [np.ravel(values) for values in (rough.R, surfaces.E_star, surfaces.H, nu)]
    one = [float(values[0]) for values in quantities]
    # bound alike where nothing varies, and where the extremes of what varies change nothing
    rows = [one]
    for i, values in enumerate(quantities):
        rows += [[*one[:i], float(v), *one[i + 1 :]] for v in {values.min(), values.max()}]
    try:
        laws = {law.bound(R=R, E_star=E, H=H, nu=v) for R, E, H, v in rows}
    except InvalidValue as error:  # of no state perhaps; said better, one contact at a time
        raise NotCompiled("the law does not know all of these inputs") from error
    if len(laws) > 1:
        raise NotCompiled("the law binds differently from state to state")
    return laws.pop()
