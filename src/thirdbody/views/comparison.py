"""The figure of a comparison of laws, and its files."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..analysis.compare import csv_text
from ..errors import InvalidValue, Mistake
from ..quantities.say import number
from .figure_files import save_figure

if TYPE_CHECKING:
    import os

    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["figure", "save"]


def figure(table: xarray.Dataset, *, at: int | None = None) -> Figure:
    """A comparison in four panels: pressure, area, separation, and the regimes at one load.

    Parameters
    ----------
    table : xarray.Dataset
        From `compare`.
    at : int, optional
        Index of the load of the regimes; the middle one when left out.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import numpy as np, thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> table = tb.compare(contact, F_star=np.geomspace(1e-6, 1e-4, 5), laws=["ke"])
    >>> len(figure(table).axes)
    4
    """
    from matplotlib.figure import Figure

    order = np.argsort(table.F_star.values)
    at = int(order[len(order) // 2]) if at is None else at
    fig = Figure(figsize=(7.2, 5.9), dpi=150, layout="constrained")
    axes = fig.subplots(2, 2)
    x = table.F_star.values[order]
    panels = {
        "mean_pressure": r"Mean real pressure $F/A_t$ [GPa]",
        "A_t_difference": r"Real area $A_t$, difference [%]",
        "d_star_difference": r"Separation, difference $\Delta d/\sigma$ [1]",
    }
    styles = _styles(table)
    for ax, (name, label) in zip(axes.flat, panels.items(), strict=False):
        scale = 1e-9 if name == "mean_pressure" else 1.0
        for law, style in styles.items():
            ax.plot(x, scale * table[name].sel(law=law).values[order], label=law, **style)
        _dress(ax, label, x)
    hardness = 1e-9 * table.attrs["hardness"]
    axes[0, 0].axhline(hardness, color="0.45", linewidth=0.8, linestyle=(0, (1, 2)), zorder=1)
    axes[0, 0].text(1.01, hardness, "$H$", transform=axes[0, 0].get_yaxis_transform(), va="center")
    axes[0, 0].set_ylim(bottom=0)
    for ax in axes.flat[1:3]:
        ax.axhline(0, color="0.45", linewidth=0.6, zorder=1)
    if len(x) > 1:
        for ax in axes.flat[:3]:
            ax.axvline(table.F_star.values[at], color="0.6", linewidth=0.8, linestyle="--")
    _regimes(axes[1, 1], table, at)
    for ax, letter in zip(axes.flat, "abcd", strict=True):
        ax.set_title(f"({letter})", loc="left", fontsize="medium")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    labels[0] += " (own law)"
    fig.legend(
        handles,
        labels,
        loc="outside upper center",
        ncols=min(len(labels), 6),
        frameon=False,
        fontsize="small",
    )
    return fig


def _styles(table: xarray.Dataset) -> dict[str, dict[str, object]]:
    """Look of every law's curve: the own one black, the others told apart by dashes too."""
    from .palette import OKABE_ITO

    colours = [
        OKABE_ITO[name] for name in ("blue", "vermilion", "green", "purple", "orange", "sky")
    ]
    dashes: list[object] = ["--", "-.", (0, (6, 1, 1, 1, 1, 1)), (0, (9, 2)), (0, (2, 1)), ":"]
    marker = "o" if table.sizes[table.A_t.dims[1]] == 1 else None
    out: dict[str, dict[str, object]] = {}
    for i, law in enumerate(table.law.values):
        if i == 0:
            out[law] = dict(color="black", linewidth=2.0, zorder=2.5, marker=marker)
            continue
        j = i - 1
        dash = dashes[(j + j // len(colours)) % len(dashes)]
        out[law] = dict(color=colours[j % 6], linestyle=dash, linewidth=1.5, marker=marker)
    return out


def _dress(ax: Axes, label: str, x: Array) -> None:
    ax.set_xlabel(r"Load $F^* = F/(A_n E_{ss})$ [1]")
    ax.set_ylabel(label)
    ax.set_xscale("log")
    if len(x) > 1 and x[-1] > x[0]:
        ax.set_xlim(x[0], x[-1])
    ax.tick_params(which="both", direction="in", top=True, right=True)
    ax.grid(visible=True, color="0.92", linewidth=0.6)
    ax.set_axisbelow(True)


def _regimes(ax: Axes, table: xarray.Dataset, at: int) -> None:
    """One bar a law: the parts of the real area."""
    from .palette import REGIMES

    load = table.A_t.dims[1]
    one = table.isel({load: at})
    rows = np.arange(len(one.law))
    left = np.zeros(len(rows))
    hatches = ("", "///", "xxx")
    for (name, colour), hatch in zip(REGIMES.values(), hatches, strict=True):
        share = 100 * np.nan_to_num(one[f"{name}_share"].values)
        ax.barh(
            rows, share, 0.72, left=left, label=name, color=colour, alpha=0.8, hatch=hatch,
            edgecolor="white", linewidth=0.6,
        )  # fmt: skip
        left += share
    for row in rows[left == 0]:
        ax.text(2, row, "no state", va="center", fontsize="small", color="0.4")
    ax.set_yticks(rows, one.law.values)
    ax.invert_yaxis()
    ax.set_xlim(0, 100)
    at_load = f"$F^*$ = {number(float(one.F_star), 2)}"
    ax.set_xlabel(f"Part of the real area at {at_load} [%]")
    ax.tick_params(axis="y", length=0)
    ax.legend(
        loc="lower right", bbox_to_anchor=(1.02, 0.985), ncols=3, frameon=False, fontsize="small",
        handlelength=1.2, handletextpad=0.5, columnspacing=0.9,
    )  # fmt: skip


def save(
    table: xarray.Dataset,
    folder: str | os.PathLike[str],
    *,
    at: int | None = None,
    force: bool = False,
) -> list[Path]:
    """Write a comparison as ``compare.csv``, ``compare.png`` and ``compare.svg``.

    The three files appear together, when all are complete; the folder is made.

    Parameters
    ----------
    table : xarray.Dataset
        From `compare`.
    folder : path-like
        Where to write.
    at : int, optional
        As in `figure`.
    force : bool, optional
        Replace files of these names that are of another study, or of another program.

    Returns
    -------
    list of pathlib.Path

    Raises
    ------
    InvalidValue
        Files of these names are of another study, or the folder cannot be made.
    """
    import matplotlib as mpl

    from ..quantities.files import make_folder, whole
    from ..quantities.run_files import refuse_replaced

    folder = Path(folder)
    if folder.exists() and not folder.is_dir():
        raise InvalidValue(
            f"cannot write into {folder}: a file of that name exists", code=Mistake.UNWRITABLE
        )
    drawing = figure(table, at=at)
    text = csv_text(table)
    if not force:
        refuse_replaced(folder, {"compare.csv": text, "compare.png": None, "compare.svg": None})
    make_folder(folder)
    out = [folder / f"compare.{suffix}" for suffix in ("csv", "png", "svg")]
    with ExitStack() as stack:
        table_file, png, svg = (stack.enter_context(whole(path)) for path in out)
        table_file.write_text(text, encoding="utf-8", newline="")
        save_figure(drawing, png, "png", dpi=200)
        with mpl.rc_context({"svg.hashsalt": "thirdbody"}):
            save_figure(drawing, svg, "svg", metadata={"Date": None})
    return out
