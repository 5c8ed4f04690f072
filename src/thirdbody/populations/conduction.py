"""Whether particles conduct an electric current, from what they are made of."""

from __future__ import annotations

from .materials import Material, materials
from .particles import Particles

__all__ = ["conducts"]

METALS = ("steel", "cast iron", "bronze", "white metal", "aluminium", "titanium")
INSULATORS = ("oxide particle", "glass", "polymer")
"""Kinds of the library of which it is known where no resistivity is; not so of ceramics, of which
some conduct."""


def conducts(dust: Particles) -> bool | None:
    """Whether the particles of a population conduct; None where nothing says so.

    What the user says counts first, then whether the material has a resistivity, then what kind of
    material of the library it is: metals conduct, oxides, glass and polymers insulate.

    Parameters
    ----------
    dust : Particles

    Returns
    -------
    bool or None

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel, sand, ceramic = (
    ...     tb.Particles(material=tb.materials[name], areal_density=1e9,
    ...                  diameter=tb.distributions.Monodisperse(mean=1e-6))
    ...     for name in ("S45C", "quartz", "SiC")
    ... )
    >>> conducts(steel), conducts(sand), conducts(ceramic), conducts(steel.replace(conducts=False))
    (True, False, None, False)
    """
    if dust.conducts is not None:
        return dust.conducts
    if dust.material.resistivity is not None:
        return True
    kind = _kind_of(dust.material)
    return True if kind in METALS else False if kind in INSULATORS else None


def _kind_of(material: Material) -> str:
    """Kind of a material of the library; empty for one that is not there."""
    return str(materials.entries().get(material.name, {}).get("kind", ""))
