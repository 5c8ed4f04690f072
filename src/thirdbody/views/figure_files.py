"""Figures as files, each laid out once."""

from __future__ import annotations

import io
from typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from os import PathLike

    from matplotlib.figure import Figure

__all__ = ["lay_out", "png_of", "save_figure"]

DPI = 150
"""Of a picture in a workbook."""


def lay_out(drawing: Figure, kind: str, *, dpi: float | None = None) -> None:
    """Place what a figure holds, as it is to be saved; from then on it stays there.

    To save a figure that has a layout matplotlib lays it out and draws all of it twice; one that
    is laid out before is drawn once, with the same bytes, and so is the next file of it.

    Parameters
    ----------
    drawing : Figure
    kind : str
        Format of the (first) file.
    dpi : float, optional
        Of that file.
    """
    from matplotlib.backend_bases import get_registered_canvas_class

    engine = drawing.get_layout_engine()
    if engine is None or not drawing.axes:
        return
    before, canvas = drawing.dpi, drawing.canvas
    get_registered_canvas_class(kind)(drawing)  # it measures text as its files show it
    try:
        drawing.dpi = dpi or before
        engine.execute(drawing)
    finally:
        drawing.canvas, drawing.dpi = canvas, before
    drawing.set_layout_engine(None)


def save_figure(
    drawing: Figure, file: str | PathLike[str] | IO[bytes], kind: str, **options: Any
) -> None:
    """Save a figure in a format, with further options of `matplotlib.figure.Figure.savefig`."""
    lay_out(drawing, kind, dpi=options.get("dpi"))
    drawing.savefig(file, format=kind, **options)


def png_of(drawing: Figure) -> bytes:
    """A figure as the bytes of a PNG, to be placed in a workbook."""
    out = io.BytesIO()
    save_figure(drawing, out, "png", dpi=DPI, metadata={"Software": "thirdbody"})
    return out.getvalue()
