"""Materials and pairs of materials: what elasticity and yield need to know of a body."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from .errors import InvalidValue
from .values import Value, quantity

__all__ = ["Material", "MaterialPair", "materials"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Material(Value):
    """An isotropic solid with a hardness.

    Parameters
    ----------
    E : float
        Young's modulus E [Pa].
    nu : float
        Poisson ratio ν [1], in (−1, 0.5].
    H : float
        Indentation hardness H [Pa].
    name, source : str, optional
        A label, and where the numbers come from.

    Raises
    ------
    InvalidValue
        One sentence per number outside its meaning.

    Examples
    --------
    >>> steel = Material(E=205e9, nu=0.29, H=5e9)
    >>> round(steel.plane_strain_modulus / 1e9, 2)
    223.82
    """

    E: float = quantity(
        "E", "Pa", "Young's modulus", gt=0, hint="GPa are written 205e9 or '205 GPa'"
    )
    nu: float = quantity("ν", "1", "Poisson ratio", gt=-1, le=0.5)
    H: float = quantity("H", "Pa", "hardness", gt=0, hint="GPa are written 5e9 or '5 GPa'")
    name: str = field(default="", compare=False)
    source: str = field(default="", compare=False)

    @property
    def plane_strain_modulus(self) -> float:
        """E/(1 − ν²) [Pa], the modulus with which a half-space answers an indenter."""
        return self.E / (1 - self.nu**2)


def reduced_modulus(first: Material, second: Material) -> float:
    r"""Hertz's contact modulus :math:`1/E^* = (1-\nu_1^2)/E_1 + (1-\nu_2^2)/E_2` [Pa]."""
    return 1 / (1 / first.plane_strain_modulus + 1 / second.plane_strain_modulus)


def softer_hardness(first: Material, second: Material) -> float:
    """The smaller of two hardnesses [Pa]; an array where a body stands for many."""
    H = np.minimum(first.H, second.H)
    return H if np.ndim(H) else float(H)


@dataclass(frozen=True, slots=True, kw_only=True)
class MaterialPair(Value):
    """The two bodies that face each other; surface 2 carries the particles.

    Parameters
    ----------
    first, second : Material
        Surfaces 1 and 2. Positional arguments are accepted too: ``MaterialPair(steel, steel)``.

    Notes
    -----
    `E_star` is :math:`1/E^* = \\sum(1-\\nu^2)/E`; papers that print :math:`E' = 2E^*` are
    converted at the door. `H` is the hardness of the softer body, which yields first.

    Examples
    --------
    >>> steel = materials["S45C"]
    >>> round(MaterialPair(steel, steel).E_star / 1e9, 2)
    111.91
    """

    first: Material
    second: Material

    def __init__(self, first: Material, second: Material):
        object.__setattr__(self, "first", first)
        object.__setattr__(self, "second", second)
        self.__post_init__()

    def _problems(self) -> list[str]:
        return [
            f"MaterialPair.{side} = {body!r} must be a Material, e.g. materials['S45C']"
            for side, body in (("first", self.first), ("second", self.second))
            if not isinstance(body, Material)
        ]

    @property
    def E_star(self) -> float:
        """Contact modulus E* [Pa], 1/E* = Σ(1 − ν²)/E."""
        return reduced_modulus(self.first, self.second)

    @property
    def softer(self) -> Material:
        """The body that yields first."""
        return self.first if self.first.H <= self.second.H else self.second

    @property
    def H(self) -> float:
        """Hardness of the softer body [Pa]."""
        return softer_hardness(self.first, self.second)


class MaterialLibrary(Mapping[str, Material]):
    """The materials that ship with the library; ``materials["S45C"]`` is a `Material`."""

    @staticmethod
    @cache
    def entries() -> dict[str, dict[str, Any]]:
        """All entries as written in the data file, with source, DOI and ranges."""
        text = resources.files(__package__).joinpath("data/materials.toml").read_text("utf-8")
        return tomllib.loads(text)

    def __getitem__(self, name: str) -> Material:
        entries = self.entries()
        if name not in entries:
            near = difflib.get_close_matches(str(name), entries, n=1, cutoff=0.4)
            guess = f"; did you mean {near[0]!r}?" if near else ""
            raise UnknownMaterial(
                f"material {name!r} is not in the library ({', '.join(entries)}){guess}"
            )
        entry = entries[name]
        return Material(
            E=entry["E"], nu=entry["nu"], H=entry["H"], name=name, source=entry["source"]
        )

    def __iter__(self) -> Iterator[str]:
        return iter(self.entries())

    def __len__(self) -> int:
        return len(self.entries())


class UnknownMaterial(InvalidValue, KeyError):
    """A name that the library does not hold."""

    __str__ = Exception.__str__


materials = MaterialLibrary()
