"""Study files: what a user writes in TOML, checked as a whole before anything is computed.

The keys of a table, their units and their ranges are those of the class the table stands for
(`quantity`, `choice`); law names and options come from the registries. For the file at hand a
pydantic model is put together from them, so that one validation finds every mistake.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
import os
import re
import tomllib
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import AfterValidator, ConfigDict, PlainValidator, ValidationError, create_model

from . import asperity, cleanliness, particle
from .citations import cite
from .contact import Contact
from .distributions import (
    Histogram,
    LogNormal,
    Mixture,
    Monodisperse,
    PowerLaw,
    TruncatedGaussian,
    Uniform,
    Weibull,
)
from .ellipticity import FACES, Ellipticity
from .equilibrium import COLUMNS, Equilibrium, solve
from .errors import InvalidValue, RangeWarning, ThirdBodyError
from .heights import (
    ExponentialHeights,
    GaussianHeights,
    Heights,
    HistogramHeights,
    JohnsonHeights,
    WeibullHeights,
)
from .materials import Material, MaterialLibrary, MaterialPair, materials
from .particles import Particles
from .sizes import FITS, WEIGHTINGS, MeasuredSizes, read_sizes
from .surfaces import Roughness
from .sweep import DESIGNS, Plan, make_plan
from .topography import FORMS, from_topography
from .transitions import Critical, Transitions, TurningPoint, transitions
from .uncertainty import KINDS, Uncertain, Uncertainty
from .units import EXAMPLES, quantity_to_si, say, to_si
from .values import allowed_range, problem_with, quantity

__all__ = ["DISTRIBUTIONS", "HEIGHTS", "LOADS", "Study", "check", "load_study", "run_study"]

DISTRIBUTIONS = {
    "truncated-gaussian": TruncatedGaussian,
    "log-normal": LogNormal,
    "weibull": Weibull,
    "uniform": Uniform,
    "histogram": Histogram,
    "power-law": PowerLaw,
    "monodisperse": Monodisperse,
    "mixture": Mixture,
}
"""Every size distribution by the word that study files use."""

HEIGHTS: dict[str, type[Heights]] = {
    "gaussian": GaussianHeights,
    "exponential": ExponentialHeights,
    "weibull": WeibullHeights,
    "johnson": JohnsonHeights,
    "histogram": HistogramHeights,
}
"""Every distribution of asperity heights by the word that study files use."""

LOADS = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "F_star": quantity("F*", "1", "load F/(A_n E_ss)", gt=0),
        "pressure": quantity("p", "Pa", "nominal pressure", gt=0, hint="MPa are 5e6 or '5 MPa'"),
        "separation": quantity("d", "m", "separation from the mean asperity height"),
    }.items()
}
"""The ways to give a load, as quantities."""

_COUNTED = {
    "iso4406": ("level", "smallest", "largest"),
    "as4059": ("smallest", "largest"),
    "nas1638": ("smallest", "largest"),
    "test_dust": ("limit", "smallest"),
    "sizes": ("weighting", "fit", "smallest"),
}
"""Keys of [particles] that stand in the place of a distribution, and their options."""
_AMOUNT = {
    name: declared.metadata["quantity"]
    for name, declared in {
        "gap": quantity("h_gap", "m", "height of the fluid whose particles are trapped", gt=0),
        "film": quantity("h_gap", "m", "film thickness, another word for gap", gt=0),
        "particle_density": quantity("ρ_p", "kg/m^3", "density of the particles", gt=0),
        "oil_density": quantity("ρ_f", "kg/m^3", "density of the fluid", gt=0),
        "smallest": quantity("x_min", "m", "smallest diameter", gt=0),
        "largest": quantity("x_max", "m", "largest diameter", gt=0),
    }.items()
}
"""The numbers that lead from a count or a concentration to an areal density."""

_ONE_OF = {"load": tuple(LOADS), "sweep": tuple(LOADS), "roughness": ("eta", "eta_R_sigma")}
"""Keys of a table of which only one can be given."""
_UNITS_OF_LISTS = {
    "edges": "m",
    "counts": "1",
    "slopes": "1",
    "weights": "1",
    "ratios": "1",
    "radii": "1",
}
_MOST_POINTS = 1_000_000
_ALSO_CALLED = {
    "normal": ("truncated-gaussian", "gaussian"),
    "gauss": ("truncated-gaussian", "gaussian"),
    "rosin-rammler": ("weibull",),
    "pearson": ("johnson",),
    "delta": ("monodisperse",),
    "single": ("monodisperse",),
}
"""Other words for distributions, to suggest the right one."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Study:
    """What a study file asks for.

    Parameters
    ----------
    title : str
        As in the file.
    contact : Contact
        The interface.
    load : {"F_star", "pressure", "separation"}
        Which load is given.
    values : array (N,)
        Its values: F* [1], p [Pa] or d [m].
    notes : tuple of str
        What is allowed but looks like a slip, one sentence each.
    sweep : Plan, optional
        The states of the table [sweep].
    uncertainty : Uncertainty, optional
        What the table [uncertainty] says of the inputs.
    """

    title: str
    contact: Contact
    load: str
    values: np.ndarray
    notes: tuple[str, ...] = ()
    sweep: Plan | None = None
    uncertainty: Uncertainty | None = None

    def solve(self) -> Equilibrium:
        """Every state, as arrays; see `thirdbody.solve`."""
        given: dict[str, Any] = {"d" if self.load == "separation" else self.load: self.values}
        return solve(self.contact, **given)


# -------------------------------------------------------------------------- reading a file
def load_study(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : path-like
        A TOML file.
    overrides : iterable of str, optional
        ``"particles.mean=500 nm"``: keys to set after reading, values as in TOML; text that is
        not TOML counts as a string. One load takes the place of the load in the file.

    Returns
    -------
    Study

    Raises
    ------
    InvalidValue
        Every mistake of the file, one sentence each in ``problems``: the key, its value, what
        is allowed, and the likely cause.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = file.write_text('''
    ... [surfaces]
    ... first = "S45C"
    ... second = "S45C"
    ... [roughness]
    ... sigma = "100 nm"
    ... R = "2.8 um"
    ... [load]
    ... pressure = "5 MPa"
    ... ''')
    >>> study = load_study(file, ["roughness.sigma=200 nm"])
    >>> study.contact.roughness.sigma, study.values.tolist()
    (2e-07, [5000000.0])
    """
    return check(_override(_read(Path(path)), list(overrides)), folder=Path(path).parent)


def check(data: dict[str, Any], *, folder: Path = Path()) -> Study:
    """The study that a parsed file in ``folder`` describes; raises as `load_study`."""
    return _Reader(folder).study(data)


def _read(path: Path) -> dict[str, Any]:
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        near = difflib.get_close_matches(
            path.name, [p.name for p in _toml_files(path)], n=1, cutoff=0.75
        )
        guess = f"; did you mean {path.with_name(near[0])}?" if near else ""
        raise InvalidValue(f"cannot read {path}: there is no such file{guess}") from None
    except IsADirectoryError:
        raise InvalidValue(f"cannot read {path}: it is a folder, not a study file") from None
    except UnicodeDecodeError as error:
        line = path.read_bytes()[: error.start].count(b"\n") + 1
        raise InvalidValue(
            f"cannot read {path}: line {line} is not UTF-8 text; save the file as UTF-8, "
            "or write um instead of µm"
        ) from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InvalidValue(f"cannot read {path}: {why.lower()}") from None
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidValue(_syntax(path, text, str(error))) from None
    except RecursionError:
        raise InvalidValue(f"{path} is nested too deeply to be a study file") from None


def _toml_files(path: Path) -> list[Path]:
    try:
        return list(path.parent.glob("*.toml"))
    except OSError:
        return []


def _syntax(path: Path, text: str, message: str) -> str:
    """A TOML syntax error with its line and the likely cause."""
    where = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)", message)
    lines = text.splitlines() or [""]
    number = int(where[1]) if where and where[1] else len(lines)
    line = lines[min(number, len(lines)) - 1].split("#")[0].strip()
    what = message[: where.start()] if where else message
    out = f"{path}, line {number}: {what[:1].lower()}{what[1:]}, in: {line}"
    key, equals, value = (part.strip() for part in line.partition("="))
    if "overwrite" in what:
        return f"{out}; {key} is given twice"
    if equals and re.fullmatch(r"[+-]?[\d.,]+(?:[eE][+-]?\d+)?\s*[^\d\s,.\]}].*", value):
        return f'{out}; a value with a unit stands in quotes: {key} = "{value}"'
    if equals and re.fullmatch(r"[A-Za-zµ][\w .-]*", value):
        return f'{out}; words stand in quotes: {key} = "{value}"'
    if equals and re.fullmatch(r"[+-]?(\d+,\d+|\.\d+.*|\d+\.)", value):
        return f"{out}; numbers have a decimal point between digits: 2.8, 0.4, 5.0"
    return out


def _override(data: dict[str, Any], overrides: list[str]) -> dict[str, Any]:
    """The data with keys set; one of several exclusive keys drives out the others."""
    problems = []
    for text in overrides:
        path, equals, value = text.partition("=")
        keys = [key.strip() for key in path.split(".")]
        if not equals or not all(keys):
            problems.append(f'--set {text!r} must be KEY=VALUE, e.g. --set particles.mean="500 nm"')
            continue
        table, walked = data, []
        for key in keys[:-1]:
            walked.append(key)
            table = table.setdefault(key, {})
            if not isinstance(table, dict):
                break
        if not isinstance(table, dict):
            whole = ".".join(walked)
            problems.append(
                f"--set {text}: {whole} = {say(table)} is not a table, so {keys[-1]} cannot be "
                f"set in it; set {whole} as a whole, e.g. --set '{whole}={{ ... }}'"
            )
            continue
        group = _ONE_OF.get(".".join(keys[:-1]), ())
        for other in group if keys[-1] in group else ():
            table.pop(other, None)
        table[keys[-1]] = _toml_value(value)
    if problems:
        raise InvalidValue(*problems)
    return data


def _toml_value(text: str) -> Any:
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (tomllib.TOMLDecodeError, RecursionError):
        return text.strip()
    return parsed["value"] if set(parsed) == {"value"} else text.strip()


# -------------------------------------------------------------------------- checking it
class _Key(NamedTuple):
    """One key of a table: the type pydantic checks, whether it must stand, what it is."""

    type: Any
    required: bool
    about: str


class _Reader:
    """Puts together the pydantic model that fits one file, and tells its mistakes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.library: MaterialLibrary | None = materials
        """The materials that the file can name; None when they cannot be read."""
        self.problems: list[str] = []
        self.notes: list[str] = []
        self.keys: dict[str, dict[str, str]] = {}
        """Known keys of every table met, and what they are."""
        self.variants: dict[str, tuple[str, dict[str, set[str]]]] = {}
        """Tables whose keys depend on a word: that word's key, and the keys of each variant."""

    # ------------------------------------------------------------------ the whole file
    def study(self, data: dict[str, Any]) -> Study:
        data = _with_nested_names(data)
        self.library = self.own_materials(data.get("materials"))
        part = {key: data.get(key) for key in ("surfaces", "roughness", "particles", "load")}
        loads_of_sweep = [name for name in LOADS if _get(data.get("sweep"), name) is not None]
        keys = {
            "title": _Key(self.text("title"), False, "a line of text"),
            "materials": _Key(
                self.text("materials"), False, 'a file of your own materials, "mine.toml"'
            ),
            "surfaces": _Key(
                self.surfaces("surfaces", part["surfaces"]),
                True,
                'a table [surfaces] with the two materials, e.g. first = "S45C", second = "S45C"',
            ),
            "roughness": _Key(
                self.roughness("roughness", part["roughness"]),
                True,
                'a table [roughness], e.g. sigma = "100 nm", R = "2.8 um"',
            ),
            "asperity_law": _Key(
                self.law("asperity_law", data.get("asperity_law"), asperity.REGISTRY), False, ""
            ),
            "particles": _Key(self.particles("particles", part["particles"]), False, ""),
            "particle_law": _Key(
                self.law("particle_law", data.get("particle_law"), particle.REGISTRY), False, ""
            ),
            "load": _Key(
                self.load("load", part["load"]),
                not loads_of_sweep,
                'a table [load] with one of F_star, pressure, separation, e.g. pressure = "5 MPa"',
            ),
            "sweep": _Key(self.sweep("sweep", data.get("sweep"), data), False, ""),
            "uncertainty": _Key(
                self.uncertainty("uncertainty", data.get("uncertainty"), data), False, ""
            ),
        }
        model = self.table("", keys, self.build)
        try:
            return _validate(model, data)
        except ValidationError as error:
            self.problems = [*self.tell(error), *self.problems]
        raise InvalidValue(*dict.fromkeys(self.problems))

    def build(self, values: dict[str, Any]) -> Study:
        if self.problems:
            raise InvalidValue(*self.problems)
        values.pop("materials", None)
        asked = values.pop("sweep", None)
        uncertain = values.pop("uncertainty", None)
        load, loads = values.pop("load", None) or self.ends(asked)
        title = values.pop("title", "")
        if "particles" not in values and values.pop("particle_law", None) is not None:
            self.notes.append("[particle_law] has no effect, because there is no [particles] table")
        contact = self.make(Contact, "", values)
        plan = None if asked is None else self.plan(contact, load, loads, asked)
        return Study(
            title=title,
            contact=contact,
            load=load,
            values=loads,
            notes=tuple(dict.fromkeys(self.notes)),
            sweep=plan,
            uncertainty=uncertain,
        )

    # ------------------------------------------------------------------ tables
    def surfaces(self, path: str, data: Any) -> Any:
        keys = {}
        for side in ("first", "second"):
            reader = self.material(f"{path}.{side}", _get(data, side))
            keys[side] = _Key(
                reader, True, 'a material, e.g. "S45C" or { E = "205 GPa", nu = 0.29, H = "5 GPa" }'
            )
        return self.table(path, keys, lambda values: self.make(MaterialPair, path, values))

    def roughness(self, path: str, data: Any) -> Any:
        if isinstance(data, dict) and "topography" in data:
            return self.topography(path, data)
        keys = self.keys_of(Roughness, path, data)
        spare = self.only_one(path, data)
        shape = _get(data, "ellipticity")
        two_faces = _get(shape, "R_first") is not None and _get(shape, "R_second") is not None
        if two_faces:
            keys["R"] = keys["R"]._replace(required=False)

        def build(values: dict[str, Any]) -> Roughness:
            kept = {key: value for key, value in values.items() if key not in spare}
            if two_faces:
                first, second = (to_si(shape[key], "m") for key in ("R_first", "R_second"))
                both = first * second / (first + second)
                if not math.isclose(kept.setdefault("R", both), both, rel_tol=0.01):
                    raise InvalidValue(
                        f"{path}.R = {say(data['R'])} must be R_first R_second/(R_first + R_second)"
                        f" = {both:.4g} m of the ellipticity; leave it out"
                    )
            return self.make(Roughness, path, kept)

        return self.table(path, keys, build)

    def topography(self, path: str, data: dict[str, Any]) -> Any:
        """A measured surface instead of σ, R and η; two files are the two faces."""
        keys = {
            name: _Key(_plain(self.measured_too(f"{path}.{name}")), False, "")
            for name in self.keys_of(Roughness, path, {})
        }
        measured = data.get("heights") == "measured"
        heights = _plain(str) if measured else self.heights(f"{path}.heights", data.get("heights"))
        cutoff = quantity("λ_c", "m", "cut-off wavelength", ge=0).metadata["quantity"]
        spacing = quantity("Δ", "m", "distance of neighbouring points", gt=0).metadata["quantity"]
        lengths = self.amounts(f"{path}.spacing", spacing, data.get("spacing"))
        keys |= {
            "topography": _Key(_plain(self.files(f"{path}.topography")), True, "a file"),
            "cutoff": _Key(
                _plain(self.number(f"{path}.cutoff", cutoff)), False, _about("cutoff", cutoff)
            ),
            "detrend": _Key(_plain(self.word(f"{path}.detrend", FORMS)), False, "form to remove"),
            "heights": _Key(heights, False, "distribution of asperity heights, or measured"),
            "unit": _Key(self.text(f"{path}.unit"), False, "unit of a file that tells none"),
            "spacing": _Key(lengths, False, _about("spacing", spacing)),
            "channel": _Key(self.text(f"{path}.channel"), False, "name of a channel of the file"),
        }

        def build(values: dict[str, Any]) -> Roughness:
            files, heights = values.pop("topography"), values.pop("heights", None)
            if "spacing" in values:
                values["spacing"] = tuple(values["spacing"])
            if len(files) == 2 and isinstance(heights, str):
                raise InvalidValue(
                    f'{path}.heights = "measured" goes with one file: summits of two faces do not '
                    "add, only their moments do"
                )
            try:
                faces = [from_topography(file, **values) for file in files]
                cutoff = max(face.cutoff for face in faces)
                if len(faces) == 2 and min(face.cutoff for face in faces) < cutoff:
                    faces = [from_topography(f, **values | {"cutoff": cutoff}) for f in files]
                for face in faces:
                    self.notes += [f"{path}.topography: {text}" for text in face.warnings]
                if len(faces) == 1:
                    return faces[0].roughness(heights=heights)
                return (faces[0].moments + faces[1].moments).roughness(heights=heights)
            except InvalidValue as error:
                raise InvalidValue(
                    *(
                        f"{path}.{text}"
                        if re.match(r"(cutoff|detrend|unit|spacing|channel)\b", text)
                        else f"{path}.topography: {text}"
                        for text in error.problems
                    )
                ) from None

        return self.table(path, keys, build)

    def files(self, path: str) -> Callable[[Any], list[Path]]:
        """One file or two, beside the study file or in the working folder."""

        def read(value: Any) -> list[Path]:
            names = value if isinstance(value, list) else [value]
            if not (1 <= len(names) <= 2 and all(isinstance(name, str) for name in names)):
                raise InvalidValue(
                    f"{path} = {say(value)} must be the name of a file in quotes, or a list of two "
                    "for the two faces"
                )
            beside = [self.folder / name for name in names]
            return [
                near
                if near.exists() or (not Path(name).exists() and name != "example")
                else Path(name)
                for near, name in zip(beside, names, strict=True)
            ]

        return read

    def measured_too(self, path: str) -> Callable[[Any], Any]:
        def refuse(value: Any) -> None:
            raise InvalidValue(
                f"{path} = {say(value)} is told by the topography as well; remove one of the two"
            )

        return refuse

    def ellipticity(self, path: str, data: Any) -> Any:
        """Classes of ratios, or two faces at an angle."""
        if not isinstance(data, dict):
            return _plain(self.no_shape(path))
        if "ratios" in data or not {"first", "second", "angle"} & data.keys():
            keys = self.keys_of(Ellipticity, path, data)
            keys["ratios"] = keys["ratios"]._replace(about="e.g. ratios = [1, 2, 5]")
            for key in {"first", "second", "angle", "R_first", "R_second"} & data.keys():
                keys[key] = _Key(_plain(self.second_shape(f"{path}.{key}")), False, "")
            return self.table(path, keys, lambda values: self.make(Ellipticity, path, values))
        names = {"first": "first_ratio", "second": "second_ratio"}
        keys = {}
        for key in ("first", "second", "R_first", "R_second"):
            about = FACES[names.get(key, key)]
            reader = _plain(self.number(f"{path}.{key}", about))
            keys[key] = _Key(reader, key in names, _about(key, about))
        example = 'angle = "30 deg", or angle = "random"'
        keys["angle"] = _Key(_plain(self.angle(f"{path}.angle")), True, example)
        if len({"R_first", "R_second"} & data.keys()) == 1:
            self.problems.append(
                f"{path} has the radius of one face only; give both R_first and R_second, or "
                "neither where they are equal"
            )

        def build(values: dict[str, Any]) -> Ellipticity:
            try:
                return Ellipticity.combined(**{names.get(k, k): v for k, v in values.items()})
            except InvalidValue as error:
                raise InvalidValue(
                    *(text.replace("first_ratio", f"{path}.first") for text in error.problems)
                ) from None

        return self.table(path, keys, build)

    def angle(self, path: str) -> Callable[[Any], Any]:
        """An angle between two faces, or the word "random"."""

        def read(value: Any) -> Any:
            if value == "random":
                return value
            try:
                return self.number(path, FACES["angle"])(value)
            except InvalidValue:
                raise InvalidValue(
                    f"{path} = {say(value)} must be an angle from 0 to 90 degrees, "
                    'e.g. "30 deg" (a number is in rad), or "random"'
                ) from None

        return read

    def second_shape(self, path: str) -> Callable[[Any], Any]:
        def refuse(value: Any) -> None:
            raise InvalidValue(
                f"{path} = {say(value)} is for two faces at an angle, ratios for the asperities of "
                "both together; keep one of the two"
            )

        return refuse

    def no_shape(self, path: str) -> Callable[[Any], Any]:
        def refuse(value: Any) -> None:
            raise InvalidValue(
                f"{path} = {say(value)} must be a table: {{ ratios = [1, 2, 5], weights = "
                '[5, 3, 2] }, or { first = 4, second = 2, angle = "30 deg" } for two faces'
            )

        return refuse

    def heights(self, path: str, data: Any) -> Any:
        def build(values: dict[str, Any]) -> Any:
            made = self.make(HEIGHTS[values.pop("name")], path, values)
            try:
                with np.errstate(all="ignore"):
                    _ = made.pieces  # some shapes exist in no member of the family
            except InvalidValue as error:
                raise InvalidValue(
                    *(_retold(text, type(made).__name__, path, values) for text in error.problems)
                ) from None
            return made

        if isinstance(data, dict):
            return self.variant(path, data, "name", HEIGHTS, build, {})

        def from_word(value: Any) -> Heights:
            word = self.word(path, HEIGHTS)(value)
            needed = _needed_fields(HEIGHTS[word])
            if needed:
                shown = ", ".join(f"{name} = ..." for name in needed)
                raise InvalidValue(
                    f"{path} = {say(word)} is missing {', '.join(needed)}: write it as a table, "
                    f"{{ name = {say(word)}, {shown} }}"
                )
            return build({"name": word})

        return _plain(from_word)

    def material(self, path: str, data: Any) -> Any:
        if isinstance(data, dict):
            keys = self.keys_of(Material, path, data)
            return self.table(path, keys, lambda values: self.make(Material, path, values))

        def from_library(value: Any) -> Material:
            known = self.library
            if known is None:
                return materials["S45C"]  # no name can be judged, and the study is refused anyway
            if isinstance(value, str) and value in known:
                return known[value]
            near = known.near(str(value))
            some = ", ".join(list(known)[:3])
            raise InvalidValue(
                f"{path} = {say(value)} is not a material of the library "
                f"({some} and {len(known) - 3} more: thirdbody materials)"
                + (f"; did you mean {say(near)}?" if near else "")
                + '; another material is written { E = "205 GPa", nu = 0.29, H = "5 GPa" }'
            )

        return _plain(from_library)

    def own_materials(self, given: Any) -> MaterialLibrary | None:
        """The library with the materials of the file that the study names."""
        if not isinstance(given, str):
            return materials
        try:
            return materials.load(self.folder / given)
        except InvalidValue as error:
            self.problems += [f"materials = {say(given)}: {problem}" for problem in error.problems]
            return None

    def particles(self, path: str, data: Any) -> Any:
        own = self.keys_of(Particles, path, data)
        own["material"] = own["material"]._replace(
            about='what the particles are made of, e.g. material = "SiO2"'
        )
        own["areal_density"] = own["areal_density"]._replace(
            about=f'{own["areal_density"].about}, or concentration = "0.1 wt%" with gap = "1 um"'
        )
        given = [key for key in ("distribution", *_COUNTED) if _get(data, key) is not None]
        kind = given[0] if given else "distribution"
        wrong = self.amount(path, data, kind, own)
        if len(given) > 1:
            shown = ", ".join(f"{path}.{key} = {say(data[key])}" for key in given)
            wrong.append(f"{shown}: each of these gives the sizes; keep one of them")
        self.problems += wrong
        own |= {key: _Key(Any, False, "") for key in _COUNTED}
        if kind != "distribution":
            return self.counted(path, data, kind, own, wrong)

        def build(values: dict[str, Any]) -> Particles:
            if wrong:
                raise InvalidValue(*wrong)
            mine = {key: values.pop(key) for key in own if key in values}
            diameter = self.make(DISTRIBUTIONS[values.pop("distribution")], path, values)
            return self.laden(path, mine, diameter)

        return self.variant(path, data, "distribution", DISTRIBUTIONS, build, own)

    def amount(self, path: str, data: Any, kind: str, own: dict[str, _Key]) -> list[str]:
        """Adds the keys that lead to an areal density; what is wrong with those of the file."""
        coded = kind in ("iso4406", "as4059", "nas1638")
        names = ["gap", "film"]
        if not coded:
            names += ["oil_density"] if kind == "test_dust" else ["oil_density", "particle_density"]
            reader = _plain(self.concentration(f"{path}.concentration"))
            own["concentration"] = _Key(reader, False, 'e.g. "0.1 wt%"')
        for name in names:
            reader = _plain(self.number(f"{path}.{name}", _AMOUNT[name]))
            own[name] = _Key(reader, False, _about(name, _AMOUNT[name]))
        given = data if isinstance(data, dict) else {}
        by_volume = coded or given.get("concentration") is not None
        if by_volume:
            own["areal_density"] = own["areal_density"]._replace(required=False)

        def shown(*keys: str) -> list[str]:
            return [f"{path}.{key} = {say(given[key])}" for key in keys if key in given]

        wrong = []
        for pair in ((kind if coded else "concentration", "areal_density"), ("gap", "film")):
            if len(both := shown(*pair)) > 1:
                wrong.append(f"{', '.join(both)}: only one of these can be given; remove the other")
        if by_volume and not shown("gap", "film"):
            wrong.append(
                f"{path}.gap is missing: the height of the fluid whose particles are trapped, e.g. "
                f'gap = "1 um"; {kind if coded else "concentration"} counts them per volume'
            )
        if not by_volume and (idle := shown(*names)):
            wrong.append(f"{idle[0]} has no effect without {path}.concentration")
        return wrong

    def counted(
        self, path: str, data: Any, kind: str, own: dict[str, _Key], wrong: list[str]
    ) -> Any:
        """Particles from a code, a test dust or a measured histogram."""
        keys = dict(own)
        words = {
            "level": cleanliness.LEVELS,
            "limit": cleanliness.LIMITS,
            "weighting": tuple(WEIGHTINGS),
            "fit": tuple(FITS),
        }
        for name in _COUNTED[kind]:
            where = f"{path}.{name}"
            if name in words:
                keys[name] = _Key(_plain(self.word(where, words[name])), False, "")
            else:
                about = _AMOUNT[name]
                keys[name] = _Key(_plain(self.number(where, about)), False, _about(name, about))
        keys[kind] = _Key(_plain(self.count_of(path, data, kind)), True, "")

        def build(values: dict[str, Any]) -> Particles:
            if wrong:
                raise InvalidValue(*wrong)
            found = values.pop(kind)
            options = {name: values.pop(name) for name in _COUNTED[kind] if name in values}
            with self.told(path):
                if kind == "sizes":
                    smallest = options.get("smallest")
                    source = found.fit(options["fit"]) if "fit" in options else found
                    return self.laden(path, values, source.by_number(smallest))
                gap = values.pop("gap", values.pop("film", None))
                if kind == "iso4406":
                    return Particles.from_iso4406(found, gap=gap, **options, **values)
                if kind == "test_dust":
                    if given := values.pop("concentration", None):
                        values |= {"concentration": given.amount, "by": given.by, "gap": gap}
                    return Particles.test_dust(found, **options, **values)
                return Particles.from_cleanliness_class(kind, found, gap=gap, **options, **values)

        return self.table(path, keys, build)

    def count_of(self, path: str, data: Any, kind: str) -> Callable[[Any], Any]:
        """Reads the key that says what was counted."""
        where = f"{path}.{kind}"

        def measured(value: Any) -> MeasuredSizes:
            if not isinstance(value, str):
                raise InvalidValue(f'{say(value)} must be the name of a file, e.g. "sizes.csv"')
            given = _get(data, "weighting")
            known = isinstance(given, str) and given in WEIGHTINGS
            beside = self.folder / value
            file = beside if beside.exists() else Path(value)
            return read_sizes(file, weighting=given if known else "number")

        def read(value: Any) -> Any:
            try:
                if kind == "sizes":
                    return measured(value)
                if kind == "iso4406":
                    cleanliness.read_iso4406(value)
                elif kind == "test_dust":
                    dust = cleanliness.dust_table(value)
                    if not dust["verified"]:
                        self.notes.append(
                            f"{where} = {say(value)}: its table is that of {dust['edition']} and "
                            "was not compared with a printed copy; compare it with the "
                            "certificate of the dust"
                        )
                else:
                    cleanliness.suspension_of_class(kind, value)
            except InvalidValue as error:
                raise InvalidValue(f"{where}: {error}") from None
            return value

        return read

    def concentration(self, path: str) -> Callable[[Any], cleanliness.Concentration]:
        def read(value: Any) -> cleanliness.Concentration:
            try:
                return cleanliness.concentration(value)
            except InvalidValue as error:
                raise InvalidValue(f"{path} = {error}") from None

        return read

    def laden(self, path: str, values: dict[str, Any], diameter: Any) -> Particles:
        """Particles with these sizes, and the density or the concentration of the file."""
        if "concentration" not in values:
            return self.make(Particles, path, values | {"diameter": diameter})
        found = values.pop("concentration")
        gap = values.pop("gap", values.pop("film", None))
        with self.told(path):
            return Particles.from_concentration(
                found.amount, by=found.by, gap=gap, diameter=diameter, **values
            )

    @contextmanager
    def told(self, path: str) -> Iterator[None]:
        """Complaints about particles, with the name of their table."""
        try:
            yield
        except InvalidValue as error:
            told = (text.removeprefix("Particles.") for text in error.problems)
            keyed = re.compile(r"[a-z_]+ (=|is missing)")
            raise InvalidValue(
                *(f"{path}{'.' if keyed.match(text) else ': '}{text}" for text in told)
            ) from None

    def sizes(self, path: str, data: Any) -> Any:
        def build(values: dict[str, Any]) -> Any:
            return self.make(DISTRIBUTIONS[values.pop("distribution")], path, values)

        return self.variant(path, data, "distribution", DISTRIBUTIONS, build, {})

    def law(self, path: str, data: Any, registry: Mapping[str, type]) -> Any:
        def build(values: dict[str, Any]) -> Any:
            return self.make(registry[values.pop("name")], path, values)

        if isinstance(data, str):
            word = self.word(path, registry)
            return Annotated[
                Any, PlainValidator(word), AfterValidator(lambda name: build({"name": name}))
            ]
        return self.variant(path, data, "name", registry, build, {})

    def load(self, path: str, data: Any) -> Any:
        keys = {
            name: _Key(
                self.amounts(f"{path}.{name}", about, _get(data, name)), False, _about(name, about)
            )
            for name, about in LOADS.items()
        }
        self.only_one(path, data)

        def build(values: dict[str, Any]) -> tuple[str, np.ndarray]:
            for name in LOADS:
                if name in values:
                    return name, values[name]
            raise InvalidValue(
                f"[{path}] is empty; give exactly one of {', '.join(LOADS)}, "
                'e.g. pressure = "5 MPa"'
            )

        return self.table(path, keys, build)

    # ------------------------------------------------------------------ sweep
    def sweep(self, path: str, data: Any, whole: dict[str, Any]) -> Any:
        """What is varied, how, and what is kept of it."""
        designs = ("grid", "zip", *DESIGNS)
        sampled = _get(data, "design") not in (None, "grid", "zip")
        keys = {
            "design": _Key(_plain(self.word(f"{path}.design", designs)), False, ""),
            "samples": _Key(_plain(self.count(f"{path}.samples", most=2**48)), sampled, "a number"),
            "seed": _Key(_plain(self.count(f"{path}.seed", least=0, most=2**63)), False, ""),
            "chunk": _Key(_plain(self.count(f"{path}.chunk", most=10**9)), False, ""),
            "columns": _Key(self.words(f"{path}.columns", COLUMNS), False, "columns to keep"),
            "vary": _Key(self.variables(f"{path}.vary", data, whole, sampled), False, ""),
            "reduce": _Key(self.reductions(f"{path}.reduce", _get(data, "reduce")), False, ""),
        }
        for name, about in LOADS.items():
            reader = self.amounts(f"{path}.{name}", about, _get(data, name), sampled=sampled)
            keys[name] = _Key(reader, False, _about(name, about))
        if isinstance(data, dict):
            self.only_one(path, data)
        return self.table(path, keys, lambda values: values)

    def variables(self, path: str, data: Any, whole: dict[str, Any], sampled: bool) -> Any:
        """The inputs that may vary, in tables like those of the file."""
        kinds = self.kinds(whole)

        def table(prefix: str, tree: Any) -> Any:
            where = f"{path}.{prefix}" if prefix else path
            keys: dict[str, _Key] = {}
            for kind in filter(None, kinds.get(prefix, [])):
                for item in dataclasses.fields(kind):
                    name, value = f"{where}.{item.name}", _get(tree, item.name)
                    if meta := item.metadata.get("quantity"):
                        reader = self.amounts(name, meta, value, sampled=sampled)
                        keys[item.name] = _Key(reader, False, _about(item.name, meta))
                    elif meta := item.metadata.get("choice"):
                        reader = self.words(name, meta["options"])
                        keys[item.name] = _Key(reader, False, meta["meaning"])
            start = f"{prefix}." if prefix else ""
            below = (other.removeprefix(start) for other in kinds if other.startswith(start))
            for name in dict.fromkeys(other.partition(".")[0] for other in below if other):
                if f"{start}{name}" != prefix:
                    keys[name] = _Key(table(f"{start}{name}", _get(tree, name)), False, "")
            return self.table(where, keys, lambda values: values)

        return table("", _get(data, "vary"))

    @staticmethod
    def kinds(whole: dict[str, Any]) -> dict[str, list[type | None]]:
        """The classes whose fields each table of the file holds."""
        sizes = DISTRIBUTIONS.get(str(_get(whole.get("particles"), "distribution")))
        kinds: dict[str, list[type | None]] = {
            "surfaces.first": [Material],
            "surfaces.second": [Material],
            "roughness": [Roughness],
            "asperity_law": [_law(whole, "asperity_law", asperity.REGISTRY, "zmc")],
        }
        if "particles" in whole:
            kinds["particles"] = [Particles, sizes]
            kinds["particles.material"] = [Material]
            kinds["particle_law"] = [_law(whole, "particle_law", particle.REGISTRY, "series")]
        return kinds

    def reductions(self, path: str, data: Any) -> Any:
        def share(value: Any) -> list[float]:
            values = value if isinstance(value, list) else [value]
            for item in values:
                if isinstance(item, bool) or not isinstance(item, (int, float)):
                    raise InvalidValue(f"{path}.quantiles = {say(value)} must be a list of numbers")
            return [float(item) for item in values]

        def thresholds(value: Any) -> dict[str, Any]:
            if isinstance(value, dict):
                return value
            raise InvalidValue(
                f"{path}.exceed = {say(value)} must be a table, e.g. {{ A_t = 0.2 }}"
            )

        keys = {
            "over": _Key(self.words(f"{path}.over", None), False, "inputs to reduce over"),
            "quantiles": _Key(_plain(share), False, "e.g. [0.05, 0.5, 0.95]"),
            "exceed": _Key(_plain(thresholds), False, "e.g. { particle_load_share = 0.5 }"),
            "extrema": _Key(self.switch(f"{path}.extrema"), False, ""),
            "mean": _Key(self.switch(f"{path}.mean"), False, ""),
        }
        return self.table(path, keys, lambda values: values)

    # ------------------------------------------------------------------ uncertainty
    def uncertainty(self, path: str, data: Any, whole: dict[str, Any]) -> Any:
        """What is known of the inputs, by names like those of the file."""
        kinds = self.kinds(whole)

        def read(given: Any) -> dict[str, Uncertain]:
            if not isinstance(given, dict) or not given:
                raise InvalidValue(
                    f"{path}.inputs = {say(given)} must be a table of inputs, e.g. "
                    '{ "roughness.sigma" = { low = "80 nm", high = "120 nm" } }'
                )
            out: dict[str, Uncertain] = {}
            problems: list[str] = []
            for label, entry in _ranges(given).items():
                where = f"{path}.inputs.{say(label)}"
                try:
                    names, about = zip(
                        *(
                            self.uncertain_name(where, name, kinds, whole)
                            for name in label.split("+")
                        ),
                        strict=True,
                    )
                    out["+".join(names)] = self.uncertain(where, about[0], entry)
                except InvalidValue as error:
                    problems += error.problems
            if problems:
                raise InvalidValue(*problems)
            return out

        keys = {
            "samples": _Key(_plain(self.count(f"{path}.samples", least=64, most=2**24)), False, ""),
            "seed": _Key(_plain(self.count(f"{path}.seed", least=0, most=2**63)), False, ""),
            "inputs": _Key(
                _plain(read),
                True,
                "what is known of each input, e.g. "
                '"roughness.sigma" = { low = "80 nm", high = "120 nm" }',
            ),
        }
        return self.table(path, keys, lambda values: Uncertainty(**values))

    def uncertain_name(
        self,
        where: str,
        name: str,
        kinds: Mapping[str, list[type | None]],
        whole: dict[str, Any],
    ) -> tuple[str, dict[str, Any]]:
        """Dotted name of the field and what it is, for an input as the file calls it."""
        table, _, last = name.strip().rpartition(".")
        if table == "load" and last in LOADS:
            if _get(whole.get("load"), last) is None:
                raise InvalidValue(f"{where}: {name} is not the load that [load] gives")
            return {"separation": "d"}.get(last, last), LOADS[last]
        known: dict[str, tuple[str, dict[str, Any]]] = {}
        for path, some in kinds.items():
            for kind in filter(None, some):
                inner = path
                if path == "particles" and kind is not Particles:
                    inner = "particles.diameter"
                for item in dataclasses.fields(kind):
                    if meta := item.metadata.get("quantity"):
                        known[f"{path}.{item.name}"] = f"{inner}.{item.name}", meta
        known |= {inner: (inner, meta) for inner, meta in known.values()}
        if name.strip() in known:
            return known[name.strip()]
        if table == "particles" and "particles" not in whole:
            raise InvalidValue(f"{where}: there is no [particles] table, so {name} is no input")
        near = _near(name.strip(), known)
        raise InvalidValue(
            f"{where}: {name.strip()} is not a number of this study"
            + (f"; did you mean {near}?" if near else f"; it has {', '.join(known)}")
        )

    def uncertain(self, where: str, about: dict[str, Any], entry: Any) -> Uncertain:
        """One distribution: which it is follows from its keys."""
        ways = (
            '{ low, high }, with spacing = "log" for a range of decades, '
            "{ mean, std } or { median, gsd }"
        )
        if not isinstance(entry, dict):
            raise InvalidValue(f"{where} = {say(entry)} must be one of {ways}")
        spacing = entry.get("spacing", "linear")
        given = {key: value for key, value in entry.items() if key != "spacing"}
        fits = [kind for kind, names in KINDS.items() if set(names) == set(given)]
        if not fits or ("spacing" in entry and "low" not in given):
            raise InvalidValue(f"{where} = {say(entry)} must be one of {ways}")
        kind = fits[0]
        if "spacing" in entry:
            self.word(f"{where}.spacing", ("linear", "log"))(spacing)
            kind = "log-uniform" if spacing == "log" else kind
        # of a spread only the sign is known: the range is that of the input
        spread = about | {"gt": 0, "ge": None, "lt": None, "le": None, "hint": ""}
        numbers: list[float] = []
        problems: list[str] = []
        for name in KINDS[kind]:
            meant = {"std": spread, "gsd": spread | {"unit": "1"}}.get(name, about)
            try:
                numbers.append(self.number(f"{where}.{name}", meant)(given[name]))
            except InvalidValue as error:
                problems += error.problems
        if problems:
            raise InvalidValue(*problems)
        try:
            return Uncertain(kind, *numbers)
        except InvalidValue as error:
            raise InvalidValue(*(f"{where}: {text}" for text in error.problems)) from None

    def words(self, path: str, options: Iterable[str] | None) -> Any:
        """One word or a list of words."""

        def read(value: Any) -> list[str]:
            values = value if isinstance(value, list) else [value]
            if options is not None:
                return [self.word(path, options)(item) for item in values]
            if not all(isinstance(item, str) for item in values):
                raise InvalidValue(f"{path} = {say(value)} must be a list of names in quotes")
            return values

        return _plain(read)

    @staticmethod
    def ends(asked: dict[str, Any]) -> tuple[str, np.ndarray]:
        """The loads of the table [sweep], for commands that do not sweep."""
        name = next(name for name in LOADS if name in asked)
        values = asked[name]
        return name, np.array([values["low"], values["high"]]) if _span(values) else values

    def plan(self, contact: Contact, load: str, loads: np.ndarray, asked: dict[str, Any]) -> Plan:
        """The states of the table [sweep]."""
        given = dict(asked)
        found = [name for name in LOADS if name in given]
        name = found[0] if found else load
        given["d" if name == "separation" else name] = given.pop(name, loads)
        names = _dotted(given.pop("vary", {}))
        given["vary"] = {inner: value for inner, value in names.values()}
        translated = {outer: inner for outer, (inner, _) in names.items()} | {"separation": "d"}
        if "over" in given.get("reduce", {}):
            over = [translated.get(word, word) for word in given["reduce"]["over"]]
            given["reduce"] = given["reduce"] | {"over": over}
        samples = given.get("samples", 0)
        if given.get("design") == "sobol" and samples & (samples - 1):
            near = 1 << samples.bit_length()
            self.notes.append(
                f"sweep.samples = {samples} is not a power of two, in which Sobol points are "
                f"balanced best; {near // 2} and {near} are"
            )
        try:
            return make_plan(contact, **given)
        except InvalidValue as error:
            back = {inner: outer for outer, inner in translated.items()}

            def told(problem: str) -> str:
                problem = re.sub(
                    r"vary\['([^']+)'\]", lambda m: f"sweep.vary.{back.get(m[1], m[1])}", problem
                )
                problem = re.sub(r"reduce\['(\w+)'\]", r"sweep.reduce.\1", problem)
                return re.sub(r"^(design|samples|seed|chunk|reduce)\b(?!\.)", r"sweep.\1", problem)

            raise InvalidValue(*map(told, error.problems)) from None

    def only_one(self, path: str, data: Any) -> list[str]:
        """Tell of keys that say the same thing twice; the ones to leave out."""
        given = [key for key in _ONE_OF[path] if _get(data, key) is not None]
        if len(given) > 1:
            shown = ", ".join(f"{path}.{key} = {say(data[key])}" for key in given)
            self.problems.append(f"{shown}: only one of these can be given; remove the other")
        return given[1:]

    def amounts(self, path: str, about: dict[str, Any], data: Any, *, sampled: bool = False) -> Any:
        """One value, a list of values, or a range; a range to sample has no ``points``."""
        number = self.number(path, about)
        if isinstance(data, dict):
            return self.range(path, about, data, sampled=sampled)
        if not isinstance(data, list):
            return _plain(lambda value: np.array([number(value)]))

        def read(value: list[Any]) -> np.ndarray:
            if not value:
                raise InvalidValue(f"{path} = [] is empty; give at least one value")
            numbers: list[float] = []
            problems: list[str] = []
            for i, item in enumerate(value):
                try:
                    numbers.append(self.number(f"{path}[{i}]", about)(item))
                except InvalidValue as error:
                    problems += error.problems
            if problems:
                raise InvalidValue(*problems)
            return np.array(numbers)

        return _plain(read)

    def range(
        self, path: str, about: dict[str, Any], data: dict[str, Any], *, sampled: bool = False
    ) -> Any:
        spacings = ("linear", "log") if about["gt"] is None else ("log", "linear")
        ends = f'e.g. {{ from = 5e-7, to = 2.4e-4, points = 200, spacing = "{spacings[0]}" }}'
        number = {end: self.number(f"{path}.{end}", about) for end in ("from", "to")}
        keys = {
            "from": _Key(_plain(number["from"]), True, f"the lowest value, {ends}"),
            "to": _Key(_plain(number["to"]), True, f"the highest value, {ends}"),
            "points": _Key(
                _plain(self.count(f"{path}.points")), not sampled, f"how many values, {ends}"
            ),
            "spacing": _Key(_plain(self.word(f"{path}.spacing", spacings)), False, ""),
        }
        log = data.get("spacing", spacings[0]) == "log"
        low, high = (_quietly(number[end], data.get(end)) for end in ("from", "to"))
        wrong = []
        if low >= high:
            wrong.append(
                f"{path} is an empty range: from = {say(data['from'])} must be below "
                f"to = {say(data['to'])}"
                + ("; exchange them" if low > high else "; for one value write it alone")
            )
        if log and low <= 0:
            wrong.append(
                f'{path}.from = {say(data["from"])} must be > 0 with spacing = "log"; '
                'use spacing = "linear"'
            )
        self.problems += wrong

        def build(values: dict[str, Any]) -> Any:
            if wrong:
                return np.empty(0)
            if "points" not in values:
                scale = "log" if log else "linear"
                return {"low": values["from"], "high": values["to"], "scale": scale}
            space = np.geomspace if log else np.linspace
            return space(values["from"], values["to"], values["points"])

        return self.table(path, keys, build)

    # ------------------------------------------------------------------ one value
    def number(self, path: str, about: dict[str, Any]) -> Callable[[Any], float]:
        def read(value: Any) -> float:
            try:
                number = quantity_to_si(value, about)
            except InvalidValue as error:
                elsewhere = "; a load in Pa goes under the key pressure"
                cause = elsewhere if path.startswith("load.F_star") and "Pa" in str(value) else ""
                raise InvalidValue(f"{path} = {error}{cause}") from None
            if not math.isfinite(number):
                allowed = allowed_range(about).removeprefix("must be ")
                allowed = "" if allowed.startswith("a finite") else f"; it must be {allowed}"
                raise InvalidValue(f"{path} = {say(value)} is not a finite number{allowed}")
            if why := problem_with(about, number):
                meant = "" if about["hint"] else f"; it is the {about['meaning']}"
                raise InvalidValue(f"{path} = {say(value)} {_words(why)}{meant}")
            self.plausible(path, about["unit"], value, number)
            return number

        return read

    def plausible(self, path: str, unit: str, value: Any, number: float) -> None:
        """Note a number that is allowed but looks like a forgotten unit."""
        usual = None
        if unit == "m" and abs(number) >= 0.01:
            usual = "nm" if abs(number) >= 10 else "um"
        elif unit == "Pa" and number < 1e5 and not path.startswith(("load", "sweep.pressure")):
            usual = "GPa"
        if usual is None:
            return
        if isinstance(value, str) and re.search(r"[^\d\s.+-]", value):
            cause = "check its unit (upper and lower case matter)"
        else:
            cause = f'a number without a unit is in SI; was "{number:g} {usual}" meant?'
        self.notes.append(f"{path} = {say(value)} is taken as {number:g} {unit}: {cause}")

    def count(self, path: str, *, least: int = 1, most: int = _MOST_POINTS) -> Callable[[Any], int]:
        def read(value: Any) -> int:
            whole = isinstance(value, (int, float)) and not isinstance(value, bool)
            if not (whole and value == value // 1 and least <= value <= most):
                raise InvalidValue(
                    f"{path} = {say(value)} must be a whole number from {least} to {most}"
                )
            return int(value)

        return read

    def word(self, path: str, options: Iterable[str]) -> Callable[[Any], str]:
        def read(value: Any) -> str:
            if isinstance(value, str) and value in options:
                return value
            near = _near(str(value), options)
            raise InvalidValue(
                f"{path} = {say(value)} must be one of {', '.join(map(say, options))}"
                + (f"; did you mean {say(near)}?" if near else "")
            )

        return read

    def text(self, path: str) -> Any:
        def read(value: Any) -> str:
            if isinstance(value, str):
                return value
            raise InvalidValue(f'{path} = {say(value)} must be text in quotes, e.g. "{value}"')

        return _plain(read)

    def switch(self, path: str) -> Any:
        def read(value: Any) -> bool:
            if isinstance(value, bool):
                return value
            raise InvalidValue(f"{path} = {say(value)} must be true or false, without quotes")

        return _plain(read)

    def numbers(self, path: str, unit: str) -> Any:
        """A list of numbers; the class of the table checks their range."""

        def read(value: Any) -> tuple[float, ...]:
            if not isinstance(value, list):
                raise InvalidValue(
                    f"{path} = {say(value)} must be a list, e.g. [{EXAMPLES[unit]}, ...]"
                )
            out, problems = [], []
            for i, item in enumerate(value):
                try:
                    out.append(to_si(item, unit))
                except InvalidValue as error:
                    problems.append(f"{path}[{i}] = {error}")
            if problems:
                raise InvalidValue(*problems)
            return tuple(out)

        return _plain(read)

    def parts(self, path: str, data: Any) -> Any:
        """The components of a mixture, a list of tables."""
        if isinstance(data, list) and data:
            kinds = tuple(self.sizes(f"{path}[{i}]", item) for i, item in enumerate(data))
            return tuple[kinds]  # type: ignore[valid-type]

        def refuse(value: Any) -> None:
            raise InvalidValue(
                f"{path} = {say(value)} must be a list of size distributions, e.g. "
                '[{ distribution = "monodisperse", mean = "100 nm" }, ...]'
            )

        return _plain(refuse)

    # ------------------------------------------------------------------ machinery
    def keys_of(self, kind: type, path: str, data: Any) -> dict[str, _Key]:
        """The keys of a table that stands for a value class.

        A field of a kind that a file cannot express, or that a contact fills in, is left out,
        and so is not a known key.
        """
        out = {}
        own = filled_in(kind)
        for item in dataclasses.fields(kind):
            if item.name in own:
                continue
            where, value = f"{path}.{item.name}", _get(data, item.name)
            required = item.name in _needed_fields(kind)
            declared = str(getattr(item.type, "__name__", item.type))
            about = ""
            if meta := item.metadata.get("quantity"):
                reader, about = _plain(self.number(where, meta)), _about(item.name, meta)
            elif meta := item.metadata.get("choice"):
                reader, about = _plain(self.word(where, meta["options"])), meta["meaning"]
            elif declared == "Material":
                reader = self.material(where, value)
            elif declared == "Heights":
                reader, about = self.heights(where, value), "distribution of asperity heights"
            elif declared == "Ellipticity | None":
                reader, about = self.ellipticity(where, value), "shapes of elliptic asperities"
            elif declared == "AbstractAsperityLaw":
                reader = self.law(where, value, asperity.REGISTRY)
            elif declared == "tuple[Distribution, ...]":
                reader, about = self.parts(where, value), "a list of size distributions"
            elif item.name in _UNITS_OF_LISTS:
                unit = _UNITS_OF_LISTS[item.name]
                reader, about = self.numbers(where, unit), f"a list of numbers [{unit}]"
            elif declared == "bool":
                reader = self.switch(where)
            elif declared == "str":
                reader = self.text(where)
            else:
                continue
            out[item.name] = _Key(reader, required, about)
        return out

    def variant(
        self,
        path: str,
        data: Any,
        tag: str,
        kinds: Mapping[str, type],
        build: Callable[[dict[str, Any]], Any],
        common: dict[str, _Key],
    ) -> Any:
        """A table whose other keys depend on the word under ``tag``.

        When the word is missing or misspelt, the rest of the table is checked all the same:
        against the nearest kind, or against what any kind would take.
        """
        word = _get(data, tag)
        chosen = word if isinstance(word, str) and word in kinds else _near(str(word), kinds)
        self.variants[path] = (
            tag,
            {
                name: {item.name for item in dataclasses.fields(kind)} - filled_in(kind)
                for name, kind in kinds.items()
            },
        )
        words = ", ".join(map(say, kinds))
        keys = {tag: _Key(_plain(self.word(f"{path}.{tag}", kinds)), True, f"one of {words}")}
        if chosen is not None:
            keys |= self.keys_of(kinds[chosen], path, data) | common
        else:
            for kind in kinds.values():
                any_kind = self.keys_of(kind, path, data)
                for name, key in any_kind.items():
                    keys.setdefault(name, key._replace(required=False))
            keys |= common
        return self.table(path, keys, build)

    def table(
        self, path: str, keys: dict[str, _Key], build: Callable[[dict[str, Any]], Any]
    ) -> Any:
        """A pydantic model for the table, followed by the object it stands for."""
        self.keys[path] = {name: key.about for name, key in keys.items()}
        fields: dict[str, Any] = {
            name: (key.type, ... if key.required else None) for name, key in keys.items()
        }
        config = ConfigDict(extra="forbid", arbitrary_types_allowed=True, protected_namespaces=())
        model = create_model(path or "study", __config__=config, **fields)

        def finish(values: Any) -> Any:
            return build({name: getattr(values, name) for name in values.model_fields_set})

        return Annotated[model, AfterValidator(finish)]

    def make(self, kind: type, path: str, values: dict[str, Any]) -> Any:
        """The object, its own complaints told with the keys of the file."""
        try:
            return kind(**values)
        except InvalidValue as error:
            raise InvalidValue(
                *(_retold(problem, kind.__name__, path, values) for problem in error.problems)
            ) from None

    # ------------------------------------------------------------------ telling mistakes
    def tell(self, error: ValidationError) -> list[str]:
        out: list[str | tuple[str, str]] = []
        found = error.errors()
        guessed: set[tuple[str, str | None]] = set()
        for item in found:
            path, key = _split(item["loc"])
            if item["type"] == "extra_forbidden":
                sentence, near = self.unknown(path, key, item["input"])
                out.append(sentence)
                guessed.add((path, near))
            elif item["type"] == "value_error":
                out += item.get("ctx", {})["error"].problems
            elif item["type"] == "missing":
                out.append((path, key))
            else:
                where = _join(path, key)
                out.append(
                    f"{where} = {say(item['input'])} must be a table"
                    + (f", written [{where}]" if "." not in where else " { ... }")
                )
        return [
            item if isinstance(item, str) else self.missing(*item)
            for item in out
            if isinstance(item, str) or item not in guessed
        ]

    def missing(self, path: str, key: str) -> str:
        about = self.keys.get(path, {}).get(key, "")
        return f"{_join(path, key)} is missing" + (f": {about}" if about else "")

    def unknown(self, path: str, key: str, value: Any) -> tuple[str, str | None]:
        """The sentence for a key that is not known, and the key that was probably meant."""
        known = self.keys.get(path, {})
        if not path and isinstance(value, dict):
            near = _near(key, known)
            guess = f"did you mean [{near}]?" if near else f"known here: {', '.join(known)}"
            return f"[{key}] is not a known table; {guess}", near
        start = f"{_join(path, key)} = {say(value)} is not a known key"
        tag, variants = self.variants.get(path, ("", {}))
        homes = [say(name) for name, keys in variants.items() if key in keys]
        if homes:
            return f"{start} here: it goes with {tag} = {' or '.join(homes)}", None
        near = _near(key, known)
        homes = [table for table, keys in self.keys.items() if key in keys and table != path]
        if near is None and homes:
            home = f"[{homes[0]}]" if homes[0] else "the top of the file, before the first table"
            return f"{start} here; it belongs to {home}", None
        if near is None and len(key) > 2:
            word = key.lower().replace("_", " ")
            meanings = {name: about.partition(", e.g.")[0] for name, about in known.items()}
            near = next((name for name, text in meanings.items() if word in text.lower()), None)
        if near is not None:
            return f"{start}; did you mean {near}?", near
        return f"{start}; known here: {', '.join(known)}", None


def _needed_fields(kind: type) -> list[str]:
    """Fields of a value class without a default."""
    missing = dataclasses.MISSING
    return [
        item.name
        for item in dataclasses.fields(kind)
        if item.default is missing and item.default_factory is missing
    ]


@cache
def filled_in(kind: Any) -> frozenset[str]:
    """Options of an asperity law that a contact sets, whatever is given for them."""
    if not issubclass(kind, asperity.AbstractAsperityLaw):
        return frozenset()
    found = set()
    for item in dataclasses.fields(kind):
        if item.default is None:
            given = kind(**{item.name: 0.1})
            used = given.bound(R=1e-6, E_star=1e11, H=1e9, nu=0.3)
            if getattr(used, item.name) != 0.1:
                found.add(item.name)
    return frozenset(found)


def _retold(problem: str, name: str, path: str, values: dict[str, Any]) -> str:
    """A sentence of a value class in the words of the file, with the value where it lacks."""
    prefix = f"{path}." if path else ""
    problem = re.sub(rf"^{name}\b(?!\.)", path, problem).replace(f"{name}.", prefix)
    for key, value in values.items():
        start = f"{prefix}{key} must"
        if problem.startswith(start):
            problem = f"{prefix}{key} = {say(value)} must" + problem.removeprefix(start)
    return _words(problem)


def _law(whole: dict[str, Any], table: str, registry: Mapping[str, type], usual: str) -> Any:
    """The class of the law that a file names."""
    data = whole.get(table, usual)
    return registry.get(str(_get(data, "name") if isinstance(data, dict) else data))


def _with_nested_names(data: dict[str, Any]) -> dict[str, Any]:
    """Names in quotes under [sweep.vary], "particles.mean", as the tables they stand for."""
    vary = _get(data.get("sweep"), "vary")
    if not isinstance(vary, dict):
        return data
    tree: dict[str, Any] = {}
    for name, value in vary.items():
        *path, last = name.removeprefix("sweep.vary.").split(".")
        table = tree
        for step in path:
            table = table.setdefault(step, {})
            if not isinstance(table, dict):
                return data
        if isinstance(value, dict) and isinstance(table.get(last), dict):
            table[last] = table[last] | value
        else:
            table[last] = value
    return data | {"sweep": data["sweep"] | {"vary": tree}}


def _ranges(tree: dict[str, Any], path: str = "") -> dict[str, Any]:
    """Names of uncertain inputs, in quotes or as tables, and what is said of each."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        inner = isinstance(value, dict) and any(isinstance(part, dict) for part in value.values())
        out |= _ranges(value, where) if inner else {where: value}
    return out


def _span(values: Any) -> bool:
    return isinstance(values, dict) and set(values) == {"low", "high", "scale"}


def _dotted(tree: dict[str, Any], path: str = "") -> dict[str, tuple[str, Any]]:
    """Names as in the file, each with the dotted name of the field and the values."""
    out: dict[str, tuple[str, Any]] = {}
    own = {item.name for item in dataclasses.fields(Particles)}
    for name, value in tree.items():
        where = f"{path}.{name}" if path else name
        if isinstance(value, dict) and not _span(value):
            out |= _dotted(value, where)
        elif path == "particles" and name not in own:
            out[where] = f"particles.diameter.{name}", value
        else:
            out[where] = where, value
    return out


def _validate(model: Any, data: dict[str, Any]) -> Any:
    from pydantic import TypeAdapter

    return TypeAdapter(model).validate_python(data)


def _plain(read: Callable[[Any], Any]) -> Any:
    return Annotated[Any, PlainValidator(read)]


def _quietly(read: Callable[[Any], float], value: Any) -> float:
    try:
        return read(value)
    except InvalidValue:
        return math.nan


def _get(data: Any, key: str) -> Any:
    return data.get(key) if isinstance(data, dict) else None


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path and key else path or key


def _split(loc: tuple[Any, ...]) -> tuple[str, str]:
    """Path of the table and the key, with list positions in brackets."""
    parts: list[str] = []
    for item in loc:
        if isinstance(item, int):
            parts[-1] += f"[{item}]"
        else:
            parts.append(str(item))
    return ".".join(parts[:-1]), parts[-1] if parts else ""


def _about(name: str, about: dict[str, Any]) -> str:
    unit, symbol = about["unit"], about["symbol"]
    example = EXAMPLES.get(unit, f"1 [{unit}]")
    if unit == "1" and problem_with(about, 0.5):
        example = "2.0"
    shown = f"{about['meaning']}" + (f" {symbol}" if symbol != name else "")
    return shown + (f" [{unit}]" if unit != "1" else "") + f", e.g. {name} = {example}"


def _near(word: str, options: Iterable[str]) -> str | None:
    """The option that was probably meant."""
    folded = {option.lower(): option for option in options}
    known = (name for name in _ALSO_CALLED.get(word.lower(), ()) if name in folded)
    word = next(known, word)
    found = difflib.get_close_matches(word.lower(), folded, n=1, cutoff=0.6)
    return folded[found[0]] if found else None


def _words(sentence: str) -> str:
    """Class names of the library in the words of study files."""
    for name, kind in DISTRIBUTIONS.items():
        sentence = re.sub(rf"\b{kind.__name__}\b(?!\.)", f'distribution = "{name}"', sentence)
    return sentence


# -------------------------------------------------------------------------- running it
def run_study(study: Study) -> dict[str, Any]:
    """Everything a study file asks for, as plain data ready for JSON.

    Parameters
    ----------
    study : Study

    Returns
    -------
    dict
        Title, version, inputs (SI), scales, states (a list each), transitions, warnings,
        citations. A state that cannot be solved keeps its place with None and a status that
        says why.
    """
    from . import __version__

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always", RangeWarning)
        state = study.solve()
        critical = _transitions(study.contact)
    sentences = [*study.notes, *state.warnings, *(str(item.message) for item in heard)]
    states = {name: [_json(item) for item in column] for name, column in state.columns().items()}
    states["mode"] = [mode or None for mode in states["mode"]]
    return {
        "title": study.title,
        "version": __version__,
        "inputs": study.contact.to_dict() | {"load": {study.load: study.values.tolist()}},
        "scales": state.scales,
        "states": {"status": states.pop("status"), **states},
        "transitions": critical.to_dict(),
        "warnings": list(dict.fromkeys(sentences)),
        "citations": cite(study.contact).splitlines(),
    }


def _transitions(contact: Contact) -> Transitions:
    try:
        return transitions(contact)
    except ThirdBodyError as error:
        none = Critical(None, f"none: {str(error).splitlines()[0]}")
        return Transitions(none, none, TurningPoint(none, none, none))


def _json(value: Any) -> Any:
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not math.isfinite(value) else value
