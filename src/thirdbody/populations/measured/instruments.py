"""Files of instruments, and heights at hand, as plain numbers in SI.

Files are read by SurfaceTopography (the extra ``surfaces``), which is loaded with the first file.
"""

from __future__ import annotations

import io
import math
import os
import re
import warnings
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ...errors import InvalidValue, Mistake, Problem
from ...quantities.say import value_of
from ...quantities.units import to_si

__all__ = ["MOST_POINTS", "Raw", "is_number", "options_unsaid", "read"]

GROUND, LENGTHS = 3e-7, ("um", "nm", "mm", "m")
"""RMS height of a ground face [m], and the units in which heights are told."""
MOST_POINTS = 20_000_000
MOST_BYTES = 1_000_000_000


class Raw(NamedTuple):
    """What a source says of itself, in SI."""

    name: str
    heights: np.ndarray
    spacing: tuple[float, ...]
    periodic: bool | None = None
    limit: float | None = None
    limit_reason: str = ""
    notes: tuple[str, ...] = ()


def is_number(value: object) -> bool:
    return (
        isinstance(value, (int, float, np.number))
        and not isinstance(value, bool)
        and math.isfinite(value)
    )


def read(
    source: object, scale: float | None, steps: tuple[float, ...] | None, channel: int | str | None
) -> Raw:
    if isinstance(source, (str, os.PathLike)):
        path = Path(source)
        if str(source) == "example" and not path.exists():
            _told_already("example", "m", scale, steps)
            return _example()
        try:
            return _from_file(path, scale, steps, channel)
        except InvalidValue as error:
            raise error.name_source(path) from None
    if hasattr(source, "physical_sizes") and hasattr(source, "heights"):
        return _from_object(source, type(source).__name__, scale, steps)
    if hasattr(source, "step_x") and hasattr(source, "step_y") and hasattr(source, "data"):
        # surfalize: rows are y, everything in micrometres
        _told_already(type(source).__name__, "um", scale, steps)
        data = 1e-6 * np.asarray(source.data, dtype=float).T
        return Raw(
            type(source).__name__, data, (1e-6 * float(source.step_x), 1e-6 * float(source.step_y))
        )
    try:
        heights: Any = np.ma.asarray(source, dtype=float)
    except (TypeError, ValueError):
        raise InvalidValue(
            f"{type(source).__name__} is no topography; give a file, an array of heights with "
            "spacing, or an object of SurfaceTopography or surfalize",
            code=Mistake.UNREADABLE,
        ) from None
    if steps is None:
        raise InvalidValue(
            "an array of heights needs spacing, the distance of neighbouring points [m], "
            "e.g. spacing=1e-7",
            code=Mistake.MISSING,
        )
    return Raw("the array", heights * (scale or 1.0), _per_axis(steps, heights.ndim))


def _told_already(
    name: str, unit: str | None, scale: float | None, steps: tuple[float, ...] | None
) -> None:
    """Refuse options that the file states itself."""
    if unit is not None and scale is not None:
        rule = f"is told by {name} itself, {unit}; leave it out"
        raise InvalidValue(Problem("unit", rule, code=Mistake.CLASH))
    if unit is not None and steps is not None:
        rule = f"follows from the lateral size that {name} tells; leave it out"
        raise InvalidValue(Problem("spacing", rule, code=Mistake.CLASH))


def _per_axis(steps: tuple[float, ...], dim: int) -> tuple[float, ...]:
    return steps * dim if len(steps) == 1 else steps[:dim]


def _example() -> Raw:
    with (
        resources.files("thirdbody").joinpath("data/example_surface.npz").open("rb") as file,
        np.load(file) as data,
    ):
        heights = np.cumsum(data["steps"], axis=0, dtype=float)
        heights[tuple(data["missing"].T)] = np.nan
        return Raw("example", heights * float(data["unit"]), tuple(map(float, data["spacing"])))


def _from_file(
    path: Path, scale: float | None, steps: tuple[float, ...] | None, channel: int | str | None
) -> Raw:
    try:
        about = path.stat()
        if path.is_dir():
            raise InvalidValue(
                f"cannot read {path}: it is a folder, not a topography", code=Mistake.UNREADABLE
            )
        if not path.is_file():
            raise InvalidValue(
                f"cannot read {path}: it is not a regular file", code=Mistake.UNREADABLE
            )
        with path.open("rb"):
            pass
    except FileNotFoundError:
        raise InvalidValue(
            f"cannot read {path}: there is no such file", code=Mistake.UNREADABLE
        ) from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        if isinstance(error, InvalidValue):
            raise
        raise InvalidValue(f"cannot read {path}: {why.lower()}", code=Mistake.UNREADABLE) from None
    if about.st_size == 0:
        raise InvalidValue(f"cannot read {path}: the file is empty", code=Mistake.EMPTY)
    if about.st_size > MOST_BYTES:
        raise InvalidValue(
            f"cannot read {path}: {about.st_size / 1e9:.3g} GB are more than the "
            f"{MOST_BYTES / 1e9:.0f} GB that fit; cut out a part in the instrument's program",
            code=Mistake.TOO_LARGE,
        )
    try:
        from SurfaceTopography import open_topography
    except ImportError:
        raise InvalidValue(
            f"cannot read {path}: files of instruments need SurfaceTopography; "
            "pip install 'thirdbody[surfaces]'",
            code=Mistake.ABSENT,
        ) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = open_topography(_with_blanks(path) or str(path))
        except Exception as error:
            _refuse_file(path, error)
        with reader:
            form = reader.format()
            if form in ("hgt", "nms") and path.suffix.lower() != f".{form}":
                # these two have no mark of their own and read any file of the right length
                _refuse_file(path, None)
            chosen = _channel(reader, path, channel)
            points = tuple(chosen.nb_grid_pts or ())
            if math.prod(points) > MOST_POINTS:
                shown = " x ".join(map(str, points))
                raise InvalidValue(
                    f"{path} has {shown} points, more than the {MOST_POINTS:,} that fit; cut out "
                    "a part or take every second point in the instrument's program",
                    code=Mistake.TOO_LARGE,
                )
            try:
                made = chosen.topography(**_lacking(chosen, scale, steps, path))
                return _from_object(made, str(path), scale, steps)
            except InvalidValue:
                raise
            except Exception as error:
                _refuse_file(path, error, form)


NUMBERS = re.compile(rb"[-+\d.eE,;\s]+")
TEXTS = (".txt", ".csv", ".dat", ".asc", ".xyz")
"""How names of files of plain numbers end."""


def _with_blanks(path: Path) -> io.BytesIO | None:
    """A text of numbers between commas or semicolons with blanks instead; None for other files.

    Commas that may be decimal ones are left: there must be points, and one number to a field.
    """
    with path.open("rb") as file:
        start = file.read(4096)
        mark = b";" if b";" in start else b","
        if mark not in start or b"." not in start:
            return None
        fields = (field for line in start.splitlines() for field in line.split(mark))
        several = any(len(field.split()) > 1 for field in fields)
        if several or NUMBERS.fullmatch(start) is None or (mark == b";" and b"," in start):
            return None
        return io.BytesIO((start + file.read()).replace(mark, b" "))


def _refuse_file(path: Path, error: Exception | None, form: str = "") -> NoReturn:
    text = str(error).strip().splitlines() if error is not None else []
    many = len(text) > 1 or not text
    if isinstance(error, MemoryError):
        raise InvalidValue(
            f"cannot read {path}: it does not fit into memory", code=Mistake.TOO_LARGE
        ) from None
    if form or (text and not many):
        kind = f" as {form}" if form else ""
        why = " ".join(text)[:160] or type(error).__name__
        raise InvalidValue(
            f"cannot read {path}{kind}: the file is damaged ({why})", code=Mistake.DAMAGED
        ) from None
    rule = f"cannot read {path}: it is in none of the formats of SurfaceTopography, or damaged"
    hint = "numbers of a text have decimal points, and blanks between columns"
    hint = hint if path.suffix.lower() in TEXTS else ""
    raise InvalidValue(Problem("", rule, hint=hint, code=Mistake.DAMAGED)) from None


def _channel(reader: Any, path: Path, channel: int | str | None) -> Any:
    channels = list(reader.channels)
    if not channels:
        raise InvalidValue(f"{path} holds no heights", code=Mistake.EMPTY)
    if channel is None:
        try:
            return reader.default_channel
        except Exception:
            return channels[0]
    names = [str(item.name) for item in channels]
    if channel in names:
        return channels[names.index(str(channel))]
    if str(channel).isdigit() and int(channel) < len(channels):
        return channels[int(channel)]
    shown = ", ".join(f"{i} ({name})" for i, name in enumerate(names))
    raise InvalidValue(
        Problem("channel", f"is not in {path}; it has {shown}", repr(channel), code=Mistake.UNKNOWN)
    )


def _lacking(
    channel: Any, scale: float | None, steps: tuple[float, ...] | None, path: Path
) -> dict[str, object]:
    """Names of options that the file does not hold and the caller must give."""
    out: dict[str, object] = {}
    sizes, unit = channel.physical_sizes, channel.unit
    points = channel.nb_grid_pts
    _told_already(str(path), unit, scale, None if sizes is None else steps)
    problems = []
    if unit is None and scale is None:
        problems.append(
            _missing_unit(str(path), " for heights, and for sides unless spacing is given")
        )
    if sizes is None and steps is None:
        problems.append(_missing_spacing(str(path)))
    if problems:
        raise InvalidValue(*problems)
    if sizes is None:
        assert steps is not None
        spacing = _per_axis(steps, len(points))
        out["physical_sizes"] = tuple(n * d for n, d in zip(points, spacing, strict=True))
    return out


def _missing_unit(name: str, of: str = "") -> Problem:
    rule = f"is missing: {name} does not state it"
    return Problem("unit", rule, hint=f'give it, e.g. "um"{of}', code=Mistake.UNIT)


def _missing_spacing(name: str) -> Problem:
    rule = f"is missing: {name} does not state its lateral size"
    hint = 'give the distance of neighbouring points, e.g. "0.5 um"'
    return Problem("spacing", rule, hint=hint, code=Mistake.UNIT)


def options_unsaid(path: Path) -> dict[str, str]:
    """Options that a file leaves open, with a likely value each; none of one that nobody can read.

    The unit is the one in which the RMS height is nearest to that of a ground face.
    """
    try:
        read(path, None, None, None)
    except InvalidValue as error:
        unsaid = [problem.path for problem in error.problems]
    else:
        return {}
    out = {"spacing": "1 um"} if "spacing" in unsaid else {}
    if "unit" in unsaid:
        try:
            raw = read(path, 1.0, (1.0,) if out else None, None)
        except InvalidValue:
            return {}
        size = float(np.nanstd(np.ma.filled(raw.heights.astype(float), np.nan))) or 1.0
        units = {name: abs(math.log(size * to_si(f"1 {name}", "m") / GROUND)) for name in LENGTHS}
        out = {"unit": min(units, key=units.__getitem__), **out}
    return out


def _from_object(made: Any, name: str, scale: float | None, steps: tuple[float, ...] | None) -> Raw:
    """An object of SurfaceTopography, in its own unit."""
    unit = made.unit
    if unit is None and scale is None:
        raise InvalidValue(_missing_unit(name))
    if unit is not None and name == type(made).__name__:
        has_size = getattr(made, "physical_sizes", None) is not None
        _told_already(name, unit, scale, steps if has_size else None)
    try:
        factor = to_si(f"1 {unit}", "m") if unit is not None else float(scale or 1.0)
    except InvalidValue:
        raise InvalidValue(
            f"{name} has heights in {unit!r}, which is not a length; choose another channel",
            code=Mistake.UNIT,
        ) from None
    notes: list[str] = []
    if getattr(made, "is_uniform", True):
        heights = made.heights()
        sizes = made.physical_sizes
        if sizes is None and steps is None:
            raise InvalidValue(_missing_spacing(name))
        if steps is not None:
            spacing = _per_axis(steps, np.ndim(heights))
        else:
            spacing = tuple(
                float(factor * s / n) for s, n in zip(sizes, np.shape(heights), strict=True)
            )
    else:
        x, z = (np.asarray(column, dtype=float) for column in made.positions_and_heights())
        if len(x) < 2 or not np.all(np.diff(x) > 0):
            raise InvalidValue(
                f"{name}: the positions of the profile do not increase", code=Mistake.ORDER
            )
        grid = np.linspace(x[0], x[-1], len(x))
        heights, spacing = np.interp(grid, x, z), (float(factor * (grid[1] - grid[0])),)
        notes.append("the points of the profile are not evenly spaced: interpolated linearly")
    if not all(math.isfinite(d) and d > 0 for d in spacing):
        raise InvalidValue(f"{name} tells a lateral size that is not above 0", code=Mistake.UNIT)
    limit, reason = _limit(made, factor)
    return Raw(name, factor * heights, spacing, made.is_periodic, limit, reason, tuple(notes))


def _limit(made: Any, factor: float) -> tuple[float | None, str]:
    """The instrument's limit, by the resolution or the tip radius that the file states."""
    info = getattr(made, "info", None) or {}
    parameters = info.get("instrument", {}).get("parameters", {})
    try:
        if "resolution" in parameters:
            about = parameters["resolution"]
            value = to_si(f"{float(about['value'])} {about['unit']}", "m")
            return value, "the resolution that the file states"
        radius = None
        if "tip_radius" in parameters:
            about = parameters["tip_radius"]
            radius = to_si(f"{float(about['value'])} {about['unit']}", "m")
        else:
            radius = _stated_radius(info.get("raw_metadata", {}))
        if radius is None:
            return None, ""
        cutoff = made.scanning_probe_reliability_cutoff(radius / factor)
        reason = f"by the tip radius of {value_of(radius, 'm')} that the file states"
        if cutoff is None:
            return None, f"{reason}, the tip follows the surface at every scale sampled"
        return float(cutoff) * factor, f"{reason} and the curvature of the peaks"
    except Exception:
        return None, "not known: what the file states of the instrument cannot be used"


def _stated_radius(metadata: object) -> float | None:
    """The radius of a stylus in the words of an instrument, e.g. "Radius: 2 µm"."""
    if not isinstance(metadata, dict):
        return None
    for key, value in metadata.items():
        if re.search(r"stylus|tip|probe", str(key), re.IGNORECASE) and isinstance(value, str):
            match = re.search(r"radius\W*([\d.]+)\s*(nm|um|µm|μm|mm)", value, re.IGNORECASE)
            if match:
                return to_si(f"{match[1]} {match[2].replace('μ', 'µ')}", "m")
    return None
