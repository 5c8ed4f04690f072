"""Materials and pairs of materials: what elasticity and yield need to know of a body."""

from __future__ import annotations

import dataclasses
import os
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InvalidValue, Mistake, Problem, UnknownMaterial
from ..quantities.arguments import names_arguments
from ..quantities.files import read_bytes
from ..quantities.nearest import Guess, guess, nearest_word
from ..quantities.slips import slips_are_told
from ..quantities.value import Value, quantity

__all__ = ["Material", "MaterialLibrary", "MaterialPair", "materials"]

OWN_FILES = "THIRDBODY_MATERIALS"
"""The environment variable that names files of one's own materials, like PATH."""


def _bulk(symbol: str, unit: str, meaning: str) -> Any:
    """An optional quantity of a body that its contact under load does not ask for."""
    about = quantity(symbol, unit, meaning, gt=0).metadata
    return field(default=None, metadata={**about, "bulk": True})


def _grain(symbol: str, unit: str, meaning: str) -> Any:
    """What is known of the strength of grains of a material, for `WeibullStrength.of`."""
    about = quantity(symbol, unit, meaning, gt=0, usual=1.0 if unit == "m" else None).metadata
    return field(default=None, metadata={**about, "grain": True})


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
        Indentation hardness H [Pa], the mean pressure on the projected area of an indent.
    name, source : str, optional
        A label, and where the numbers come from.
    density : float, optional
        Mass density ρ [kg/m³].
    thermal_conductivity : float, optional
        Thermal conductivity κ [W/(m K)].
    specific_heat : float, optional
        Specific heat c_p [J/(kg K)].
    resistivity : float, optional
        Electrical resistivity ρ_e [Ω m].
    K_c : float, optional
        Fracture toughness K_c [Pa √m].
    sigma_0, x_0, m, size_exponent : float, optional
        Strength of grains, as in `thirdbody.grains.WeibullStrength.of`.

    Raises
    ------
    InvalidValue
        One sentence per number outside its meaning.

    Notes
    -----
    Two materials are equal when all their numbers are, whatever their labels. How a contact carries
    load is decided by E, ν, H and K_c alone, K_c where particles break: `carrying`.

    Examples
    --------
    >>> import thirdbody as tb
    >>> steel = tb.Material(E=205e9, nu=0.29, H=5e9)
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
    density: float | None = _bulk("ρ", "kg/m^3", "mass density")
    thermal_conductivity: float | None = _bulk("κ", "W/m/K", "thermal conductivity")
    specific_heat: float | None = _bulk("c_p", "J/kg/K", "specific heat")
    resistivity: float | None = _bulk("ρ_e", "ohm*m", "electrical resistivity")
    K_c: float | None = quantity(
        "K_c", "Pa m^0.5", "fracture toughness", default=None, gt=0, hint="MPa m^0.5 are 1.2e6"
    )
    sigma_0: float | None = _grain("σ_0", "Pa", "strength F/x² of grains of size x_0")
    x_0: float | None = _grain("x_0", "m", "size at which the strength was measured")
    m: float | None = _grain("m", "1", "Weibull modulus of the strength of grains")
    size_exponent: float | None = _grain("b", "1", "exponent of the size effect on strength")

    @property
    def plane_strain_modulus(self) -> float:
        """E/(1 − ν²) [Pa], the modulus with which a half-space answers an indenter."""
        return self.E / (1 - self.nu**2)

    @property
    def carrying(self) -> Material:
        """What decides how a contact carries load, and nothing else: E, ν, H and K_c."""
        with slips_are_told():
            return Material(E=self.E, nu=self.nu, H=self.H, K_c=self.K_c)


BULK = frozenset(item.name for item in dataclasses.fields(Material) if "bulk" in item.metadata)
"""Quantities of a body that decide how it conducts, not how it carries load."""


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
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> round(tb.MaterialPair(steel, steel).E_star / 1e9, 2)
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
            Problem(
                side, "must be a Material, e.g. materials['S45C']", repr(body), code=Mistake.KIND
            )
            for side, body in (("first", self.first), ("second", self.second))
            if not isinstance(body, Material)
        ]

    @property
    def E_star(self) -> float:
        """Contact modulus E* [Pa], 1/E* = Σ(1 − ν²)/E."""
        return reduced_modulus(self.first, self.second)

    @property
    def alike(self) -> bool:
        """Whether both bodies carry load alike."""
        return self.first.carrying == self.second.carrying

    @property
    def softer(self) -> Material:
        """The body that yields first."""
        return self.first if self.first.H <= self.second.H else self.second

    @property
    def H(self) -> float:
        """Hardness of the softer body [Pa]."""
        return softer_hardness(self.first, self.second)


NUMBERS = {
    item.name: item.metadata["quantity"]
    for item in dataclasses.fields(Material)
    if "quantity" in item.metadata
}
"""The quantities of a material, as entries of the library spell them."""

_MEANINGS = {name: about["meaning"] for name, about in NUMBERS.items()}
_NEEDED = ("E", "nu", "H", "source")
_WORDS = ("about", "kind", "source", "doi", "standing", "measured")


class MaterialLibrary(Mapping[str, Material]):
    """Materials by name; ``materials["S45C"]`` is a `Material`.

    The library that ships is `thirdbody.materials`. Materials of one's own stand in TOML files
    that `load` adds, or that the environment variable THIRDBODY_MATERIALS names.

    Parameters
    ----------
    *files : path-like, optional
        Files of one's own materials, beside what ships.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.materials["Si3N4"].E / 1e9
    310.0
    >>> tb.materials.search("bearing ceramic")
    ['Si3N4']
    >>> tb.materials.entries()["Si3N4"]["range"]["H"]
    [14810000000.0, 16920000000.0]
    """

    def __init__(self, *files: str | os.PathLike[str]):
        self.files = tuple(Path(file) for file in files)

    def entries(self) -> dict[str, dict[str, Any]]:
        """All entries in SI, with source, standing of the source, and ranges.

        Raises
        ------
        InvalidValue
            Every mistake in files of one's own, one sentence each.
        """
        named = os.environ.get(OWN_FILES, "").split(os.pathsep)
        out = dict(_own_materials())
        for file in (*(Path(name) for name in named if name), *self.files):
            entries = _entries_of_file(file)
            if taken := [name for name in entries if name in out and out[name] != entries[name]]:
                raise InvalidValue(
                    *(f"{file}: [{name}] is in the library; choose another name" for name in taken),
                    code=Mistake.CLASH,
                )
            out |= entries
        return out

    @names_arguments
    def load(self, *files: str | os.PathLike[str]) -> MaterialLibrary:
        """A library with the materials of one's own files beside these.

        An entry is a table with E, nu, H and source, and what else is known. Numbers are SI or
        carry a unit; H may be a hardness number: "62 HRC", "700 HV", "200 HB".

        Parameters
        ----------
        *files : path-like
            TOML files.

        Returns
        -------
        MaterialLibrary
            A new one; `thirdbody.materials` stays as it is.

        Raises
        ------
        InvalidValue
            Every mistake, one sentence each: key, value, what is allowed.

        Examples
        --------
        >>> import tempfile
        >>> file = Path(tempfile.mkdtemp()) / "mine.toml"
        >>> _ = file.write_text('''
        ... [our-steel]
        ... E = "207 GPa"
        ... nu = 0.29
        ... H = "62 HRC"
        ... source = "our laboratory, 2024"
        ... ''')
        >>> mine = materials.load(file)
        >>> round(mine["our-steel"].H / 1e9, 2), "our-steel" in materials
        (7.89, False)
        """
        library = MaterialLibrary(*self.files, *files)
        library.entries()
        return library

    @names_arguments
    def search(self, query: str = "") -> list[str]:
        """Names of the entries in which every word of the query stands.

        Parameters
        ----------
        query : str
            Words of name, other names, kind or description; case does not matter.

        Returns
        -------
        list of str
            Names, in the order of the library; all of them for an empty query.

        Examples
        --------
        >>> materials.search("stainless steel")
        ['440C', 'AISI304']
        """
        words = query.casefold().split()
        return [
            name
            for name, entry in self.entries().items()
            if all(word in _text(name, entry) for word in words)
        ]

    def nearest_name(self, name: str) -> str | None:
        """Name of the entry that was probably meant: an alias, or the most similar name."""
        names = {name.casefold(): name for name in self}
        for entry_name, entry in self.entries().items():
            for other in entry.get("aliases", ()):
                names.setdefault(other.casefold(), entry_name)
                names.setdefault(other.split()[-1].casefold(), entry_name)
        meant = nearest_word(str(name), names)
        return names[meant] if meant else None

    @names_arguments
    def __getitem__(self, name: str) -> Material:
        entries = self.entries()
        if name not in entries:
            meant = self.nearest_name(name)
            hint = f"did you mean {meant!r}?" if meant else "materials.search('steel') finds names"
            raise UnknownMaterial(
                Problem(
                    f"materials[{name!r}]",
                    "is not a material of the library",
                    hint=Guess(hint, meant),
                    code=Mistake.UNKNOWN,
                )
            )
        entry = entries[name]
        numbers = {key: entry[key] for key in NUMBERS if key in entry}
        return Material(**numbers, name=name, source=entry["source"])

    def _ipython_key_completions_(self) -> list[str]:
        """Names that a notebook offers after ``materials["``."""
        return list(self)

    def __iter__(self) -> Iterator[str]:
        return iter(self.entries())

    def __len__(self) -> int:
        return len(self.entries())


def _text(name: str, entry: dict[str, Any]) -> str:
    words = [name, *(entry.get(key, "") for key in ("about", "kind")), *entry.get("aliases", ())]
    return " ".join(words).casefold()


@cache
def _own_materials() -> dict[str, dict[str, object]]:
    text = resources.files("thirdbody").joinpath("data/materials.toml").read_text("utf-8")
    return tomllib.loads(text)


# ------------------------------------------------------------------ files of one's own
def _entries_of_file(file: Path) -> dict[str, dict[str, object]]:
    """The entries of a file, in SI."""
    try:
        data = tomllib.loads(read_bytes(file, "a file of materials").decode("utf-8-sig"))
    except InvalidValue:
        raise
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InvalidValue(
            f"cannot read the materials in {file}: {why}", code=Mistake.UNREADABLE
        ) from None
    except ValueError as error:
        raise InvalidValue(
            f"cannot read the materials in {file}: {error}", code=Mistake.UNREADABLE
        ) from None
    problems: list[str] = []
    out = {}
    for name, entry in data.items():
        if isinstance(entry, dict):
            out[name] = _in_si(f"{file}: {name}", entry, problems)
        else:
            problems.append(
                Problem(
                    "",
                    f"{file}: {name} = {entry!r} must be a table, written [{name}]",
                    code=Mistake.KIND,
                )
            )
    if problems:
        raise InvalidValue(*problems)
    return out


def _in_si(where: str, entry: dict[str, Any], problems: list[str]) -> dict[str, object]:
    """An entry with its numbers in SI; mistakes are added to ``problems``."""
    allowed_keys = (*NUMBERS, *_WORDS, "aliases", "range", "sources")
    out = dict(entry)
    for key, value in entry.items():
        if key in NUMBERS:
            out[key] = _number(f"{where}.{key}", key, value, problems)
        elif key in _WORDS and not isinstance(value, str):
            problems.append(
                Problem("", f"{where}.{key} = {value!r} must be text in quotes", code=Mistake.KIND)
            )
        elif key == "range":
            out[key] = _ranges(f"{where}.range", value, problems)
        elif key == "aliases" and not _texts(value):
            problems.append(
                Problem(
                    "", f"{where}.aliases = {value!r} must be a list of names", code=Mistake.KIND
                )
            )
        elif key == "sources" and not (isinstance(value, dict) and _texts(list(value.values()))):
            problems.append(
                Problem(
                    "", f"{where}.sources = {value!r} must be a table of text", code=Mistake.KIND
                )
            )
        elif key not in allowed_keys:
            problems.append(
                Problem(
                    "",
                    f"{where}.{key} is not a known key; "
                    + guess(key, allowed_keys, meanings=_MEANINGS),
                    code=Mistake.UNKNOWN,
                )
            )
    for key in _NEEDED:
        if entry.get(key, "") == "":
            example = "where the numbers come from" if key == "source" else NUMBERS[key]["meaning"]
            problems.append(
                Problem("", f"{where}.{key} is missing: {example}", code=Mistake.MISSING)
            )
    for key, (low, high) in (out.get("range") or {}).items():
        value = out.get(key)
        if isinstance(value, float) and not low <= value <= high:
            problems.append(
                Problem(
                    "",
                    f"{where}.{key} = {value:g} must be within its range, {low:g} to {high:g}",
                    code=Mistake.RANGE,
                )
            )
    return out


def _texts(values: object) -> bool:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)


def _number(where: str, key: str, value: object, problems: list[str]) -> float | None:
    from ..quantities.units import quantity_to_si
    from ..quantities.value import problem_with

    try:
        number = quantity_to_si(value, NUMBERS[key])
    except InvalidValue as error:
        problems.append(Problem("", f"{where} = {error}", code=error.code))
        return None
    if why := problem_with(NUMBERS[key], number):
        problems.append(Problem("", f"{where} = {value!r} {why}", code=why.code))
        return None
    return number


def _ranges(where: str, ranges: object, problems: list[str]) -> dict[str, list[float]]:
    out: dict[str, list[float]] = {}
    for key, ends in ranges.items() if isinstance(ranges, dict) else [("range", ranges)]:
        if key not in NUMBERS or not isinstance(ends, list) or len(ends) != 2:
            problems.append(
                Problem(
                    "",
                    f"{where}.{key} = {ends!r} must be a pair [low, high] of a quantity",
                    code=Mistake.KIND,
                )
            )
            continue
        low, high = (_number(f"{where}.{key}", key, end, problems) for end in ends)
        if low is not None and high is not None:
            if low > high:
                problems.append(
                    Problem(
                        "",
                        f"{where}.{key} = {ends!r} must rise from low to high",
                        code=Mistake.ORDER,
                    )
                )
            else:
                out[key] = [low, high]
    return out


materials = MaterialLibrary()
