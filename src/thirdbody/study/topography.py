"""A measured surface in [roughness], instead of σ, R and η."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..errors import InvalidValue
from ..populations.measured.topography import FORMS, from_topography
from ..populations.roughness import Roughness
from ..quantities.units import say
from ..quantities.value import quantity
from .amounts import amounts
from .ellipticity import ellipticity_beside_topography
from .fields import about_of
from .heights import heights
from .one_value import One, number, refused, text, word
from .reader import Key, Reader, plain, reads_also

__all__ = ["topography"]

CUTOFF = quantity("λ_c", "m", "cut-off wavelength", ge=0).metadata["quantity"]
SPACING = quantity("Δ", "m", "distance of neighbouring points", gt=0).metadata["quantity"]


def topography(reader: Reader, path: str, data: dict[str, Any]) -> Any:
    """A measured surface instead of σ, R and η; two files are the two faces."""
    told_twice = "is told by the topography as well; remove one of the two"
    keys = {
        name: Key(plain(refused(f"{path}.{name}", told_twice)), False, "")
        for name in reader.keys_of(Roughness, path, {})
    }
    shape = _heights(reader, f"{path}.heights", data.get("heights"))
    tips = ellipticity_beside_topography(reader, f"{path}.ellipticity", data.get("ellipticity"))
    cutoff = plain(number(reader, f"{path}.cutoff", CUTOFF))
    lengths = amounts(reader, f"{path}.spacing", SPACING, data.get("spacing"))
    keys |= {
        "topography": Key(plain(_files(reader, f"{path}.topography")), True, "a file"),
        "cutoff": Key(cutoff, False, about_of("cutoff", CUTOFF)),
        "detrend": Key(plain(word(f"{path}.detrend", FORMS)), False, "form to remove"),
        "heights": Key(shape, False, "distribution of asperity heights, or measured"),
        "ellipticity": Key(tips, False, "shapes of elliptic asperities, or measured"),
        "unit": Key(plain(text(f"{path}.unit")), False, "unit of a file that tells none"),
        "spacing": Key(lengths, False, about_of("spacing", SPACING)),
        "channel": Key(plain(text(f"{path}.channel")), False, "name of a channel of the file"),
    }

    def build(values: dict[str, Any]) -> Roughness:
        files = values.pop("topography")
        shapes = {name: values.pop(name, None) for name in ("heights", "ellipticity")}
        if "spacing" in values:
            values["spacing"] = tuple(values["spacing"])
        counted = [name for name, shape in shapes.items() if isinstance(shape, str)]
        if len(files) == 2 and counted:
            raise InvalidValue(
                *(
                    f'{path}.{name} = "measured" goes with one file: summits of two faces do not '
                    "add, only their moments do"
                    for name in counted
                )
            )
        try:
            faces = [from_topography(file, **values) for file in files]
            cutoff = max(face.cutoff for face in faces)
            if len(faces) == 2 and min(face.cutoff for face in faces) < cutoff:
                faces = [from_topography(f, **values | {"cutoff": cutoff}) for f in files]
            for face in faces:
                reader.notes += [f"{path}.topography: {sentence}" for sentence in face.warnings]
            reader.faces = faces
            if len(faces) == 1:
                return faces[0].roughness(**shapes)
            both = (faces[0].moments + faces[1].moments).roughness(heights=shapes["heights"])
            return both.replace(ellipticity=shapes["ellipticity"])
        except InvalidValue as error:
            raise InvalidValue(
                *(p.under(path if p.path else f"{path}.topography") for p in error.problems)
            ) from None

    return reader.table(path, keys, build)


@reads_also("measured")
def _heights(reader: Reader, path: str, data: Any) -> Any:
    """The heights of the summits counted, or a distribution as elsewhere."""
    if data == "measured":
        return plain(One(str, {"const": data}))
    return heights(reader, path, data)


def _files(reader: Reader, path: str) -> Callable[[Any], list[Path]]:
    """One file or two, beside the study file or in the working folder."""

    def read(value: Any) -> list[Path]:
        names = value if isinstance(value, list) else [value]
        if not (1 <= len(names) <= 2 and all(isinstance(name, str) for name in names)):
            raise InvalidValue(
                f"{path} = {say(value)} must be the name of a file in quotes, or a list of two "
                "for the two faces"
            )
        beside = [reader.folder / name for name in names]
        return [
            near if near.exists() or (not Path(name).exists() and name != "example") else Path(name)
            for near, name in zip(beside, names, strict=True)
        ]

    return read
