"""``thirdbody surface``: moments and asperities of a measured surface."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import InvalidValue
from ...quantities.say import number, signed_number, value_of
from ...quantities.tables import Table
from ..options import (
    Force,
    JsonFile,
    ParquetFile,
    XlsxFile,
    argument,
    metres,
    named_as_options,
    not_a_folder,
    option,
)
from ..show import ALL, terminal
from ..streams import STDOUT, TableFiles, tell_written, warn_of

if TYPE_CHECKING:
    from ...populations.measured.spectra import SpectralMoments, Summits
    from ...populations.measured.topography import Topography
    from ...views.workbook import Sheet

__all__ = ["command"]

MEANS = {
    "sigma": "RMS height",
    "R": "mean asperity radius",
    "eta": "asperities per area",
    "eta R sigma": "their product, no unit",
    "alpha": "Nayak bandwidth, no unit",
    "sigma_s": "RMS of asperity heights",
    "y_s": "their mean above the mean plane",
}
"""Results of a cut-off, and what they mean."""


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of the command."""

    file: Path = argument(
        "A measured surface or profile, x3p, sur, al3d, npy, txt, ... (each needs "
        "SurfaceTopography: pip install 'thirdbody[surfaces]'), or the word \"example\".",
        "FILE",
    )
    cutoff: str | None = option(
        "--cutoff", 'Waves shorter than this are left out, e.g. "2 um"; 0 leaves all in.', "LENGTH"
    )
    detrend: str | None = option(
        "--detrend", "Form to remove: none, tilt (default) or curvature.", "FORM"
    )
    unit: str | None = option(
        "--unit", "Unit of the heights, where the file says none: nm, um, mm or m.", "UNIT"
    )
    spacing: str | None = option(
        "--spacing",
        'Distance of the points, where the file says none, e.g. "0.5 um".',
        "LENGTH[,LENGTH]",
    )
    channel: str | None = option(
        "--channel",
        "Number or name of a channel, of a file with several, e.g. 1 or Height.",
        "NAME",
    )
    resolution: str | None = option(
        "--resolution", 'Shortest wave that the instrument tells apart, e.g. "1 um".', "LENGTH"
    )
    json: JsonFile = None
    csv: Path | None = option("--csv", "Write a table, one row per cut-off, e.g. a.csv.", "FILE")
    xlsx: XlsxFile = None
    parquet: ParquetFile = None
    force: Force = False
    out: Path | None = option("--out", "Write surface.png, .svg and .json into a folder.", "DIR")


def command(options: Options) -> None:
    """Tip radius, roughness and asperities of a measured surface."""
    from ...populations.measured.topography import from_topography
    from ...quantities.files import refuse_clashes
    from ..own_files import refuse_strangers

    problems: list[str] = []
    files = TableFiles(options.csv, options.xlsx, options.parquet, options.json)
    lengths = _lengths(options.cutoff, options.resolution, options.spacing, problems)
    problems += not_a_folder(options.out)
    if problems:
        raise InvalidValue(*problems)
    refuse_clashes(
        [*files.paths, *(_of_folder(options.out) if options.out else ())], [options.file]
    )
    files.need(force=options.force)
    if not options.force:
        refuse_strangers(options.out, "surface.json", "surface.png", "surface.svg")
    with named_as_options("unit", "spacing", "channel", "detrend", "cutoff", "resolution"):
        topography = from_topography(
            options.file,
            detrend=options.detrend,
            unit=options.unit,
            channel=options.channel,
            **lengths,
        )
    result = topography.to_dict()
    warn_of(topography.warnings)
    files.write(
        result["curve"],
        result["units"],
        sheets=partial(_sheets, topography, result),
        data=lambda: result,
    )
    written = files.paths + (
        []
        if options.out is None
        else _write_surface(options.out, topography, result, options.force)
    )
    if options.json != STDOUT:
        _show_surface(topography, result)
    tell_written(*written)


def _sheets(topography: Topography, result: dict[str, Any]) -> list[Sheet]:
    from ...views.question_sheets import question_sheets

    sentence = _in_one_sentence(topography, result["cutoff"]["used"])
    read = [("what was read", "", line, "", "file", "") for line in _what_was_read(topography)]
    return question_sheets(
        topography.source,
        [sentence],
        None,
        [],
        states=(result["curve"], result["units"]),
        meanings=MEANS,
        inputs=read,
        warnings=topography.warnings,
        citations=[],
    )


def _of_folder(folder: Path) -> list[Path]:
    """Names of the files that --out writes."""
    return [folder / f"surface.{suffix}" for suffix in ("png", "svg", "json")]


def _lengths(
    cutoff: str | None, resolution: str | None, spacing: str | None, problems: list[str]
) -> dict[str, Any]:
    """Lengths as `from_topography` takes them [m]."""
    lengths: dict[str, object] = {
        name: None if text is None else metres(f"--{name}", text, problems)
        for name, text in (("cutoff", cutoff), ("resolution", resolution))
    }
    if spacing is not None:
        parts = spacing.split(",")
        lengths["spacing"] = tuple(metres("--spacing", step, problems) for step in parts)
    return lengths


def _write_surface(
    folder: Path, topography: Topography, result: dict[str, object], force: bool
) -> list[Path]:
    import matplotlib as mpl

    from ...quantities.files import make_folder, whole, write_text
    from ...quantities.run_files import refuse_replaced
    from ...views.figure_files import save_figure
    from ...views.plot.topography import surface as draw

    text = json.dumps(result, indent=1, allow_nan=False) + "\n"
    if not force:
        refuse_replaced(folder, {"surface.json": text, "surface.png": None, "surface.svg": None})
    make_folder(folder)
    out = _of_folder(folder)
    drawing = draw(topography)
    with whole(out[0]) as png, whole(out[1]) as svg:
        save_figure(drawing, png, "png", dpi=200)
        with mpl.rc_context({"svg.hashsalt": "thirdbody"}):
            save_figure(drawing, svg, "svg", metadata={"Date": None})
        write_text(out[2], text)
    return out


def _show_surface(topography: Topography, result: dict[str, Any]) -> None:
    """What was read, the answer at the cut-off used, and its course with the cut-off."""
    console = terminal()
    console.print(_in_one_sentence(topography, result["cutoff"]["used"]))
    console.print()
    for line in _what_was_read(topography):
        console.print(line)
    console.print()
    console.print(_answer(topography, result["cutoff"]["used"]))
    console.print(_course(topography, result["curve"]))
    console.print(
        f"skewness {number(topography.skewness, 3)}, kurtosis {number(topography.kurtosis, 3)}, "
        "mean square slopes "
        f"{number(topography.anisotropy)} : 1 along and across"
    )


def _in_one_sentence(topography: Topography, cutoff: float) -> str:
    """The roughness that a contact takes, and what it owes to the cut-off."""
    curve, one = topography.curve(), topography.moments
    at = "as sampled" if cutoff == 0 else f"at a cut-off of {value_of(cutoff, 'm')}"
    change = curve.per_octave("R")
    near = int(abs(curve["cutoff"] - cutoff).argmin())
    sentence = (
        f"RMS height sigma = {value_of(one.sigma, 'm')} and mean asperity radius R = "
        f"{value_of(one.R, 'm')} {at}"
    )
    if change[near] != change[near]:
        return f"{sentence}."
    return (
        f"{sentence}; twice the cut-off changes R by {signed_number(100 * change[near], 0, '%')}."
    )


def _what_was_read(topography: Topography) -> list[str]:
    """Points, moments as sampled, the limit of the instrument and the cut-off recommended."""
    points = " x ".join(map(str, topography.heights.shape))
    sides = " x ".join(value_of(side, "m") for side in topography.size)
    kind = "map" if topography.dim == 2 else "profile"
    recommended, reason = topography.recommended
    limit = "" if topography.limit is None else value_of(topography.limit, "m") + ", "
    return [
        f"{topography.source}: {kind} of {points} points, {sides}",
        f"as sampled: RMS height {value_of(topography.rms_height, 'm')}, RMS "
        f"{'gradient' if topography.dim == 2 else 'slope'} {number(topography.rms_slope)}, RMS "
        f"curvature {value_of(topography.rms_curvature, '1/m')}",
        f"limit of the instrument: {limit}{topography.limit_reason}",
        f"recommended cut-off: {value_of(recommended, 'm')}: {reason}",
    ]


def _answer(topography: Topography, cutoff: float) -> Table:
    """Moments and asperities at the cut-off, by differences, spectrum and counted summits."""
    at = "as sampled" if cutoff == 0 else f"at {value_of(cutoff, 'm')}"
    drop = ("eta R sigma", "y_s", "alpha")
    answer = Table(
        (at, *MEANS), right=True, words=[at], drop=drop, more="--json has all of it", legend=MEANS
    )

    def add(
        label: str, one: SpectralMoments | Summits, sigma: float, eta: float, alpha: str
    ) -> None:
        answer.add_row(
            label,
            value_of(sigma, "m"),
            value_of(one.R, "m"),
            value_of(eta, "1/m^2"),
            number(eta * one.R * sigma),
            alpha,
            value_of(one.sigma_s, "m"),
            value_of(one.y_s, "m"),
        )

    for label, one in (
        ("differences", topography.moments),
        ("spectrum", topography.moments_at(method="spectrum")),
    ):
        add(label, one, one.sigma, one.eta, number(one.alpha))
    if topography.dim == 2 and topography.summits.count > 1:
        counted = topography.summits
        add(f"{counted.count} summits", counted, topography.moments.sigma, counted.density, "-")
    return answer


def _course(topography: Topography, curve: dict[str, Any]) -> Table:
    """The same against the cut-off."""
    heads = ["cut-off", "sigma", "gradient", "alpha", "R", "R counted", "eta", "eta counted"]
    heads.append("R per octave")
    gone = ("eta counted", "R counted", "alpha", "gradient")
    meanings = {
        "gradient": "RMS of the slope, no unit",
        "eta counted": "as R counted, of the summits found one by one",
        "R per octave": "change of R for twice the cut-off",
    }
    course = Table(heads, right=True, drop=gone, more=ALL, legend=meanings)
    change = topography.curve().per_octave("R")
    for i, cut in enumerate(curve["cutoff"]):
        course.add_row(
            value_of(cut, "m"),
            value_of(curve["sigma"][i], "m"),
            number(curve["rms_gradient"][i]),
            number(curve["alpha"][i]),
            value_of(curve["R"][i], "m"),
            value_of(curve["R_counted"][i], "m"),
            value_of(curve["eta"][i], "1/m^2"),
            value_of(curve["eta_counted"][i], "1/m^2"),
            signed_number(100 * change[i], 0, "%"),
        )
    return course
