"""What can be taken away: the files that the command line writes, and figures for a paper."""

from __future__ import annotations

import io
import json

from ..quantities.files import csv_of, with_units
from ..study import Study, run_study
from ..views import plot
from .state import Answer

__all__ = ["FIGURES", "figure_of", "to_csv", "to_json"]

FIGURES = ("area", "shares", "regimes", "separation", "modes")
"""Functions of `thirdbody.plot` that draw the curves."""


def to_json(study: Study) -> str:
    """What ``thirdbody solve STUDY.toml --json`` prints."""
    return json.dumps(run_study(study).to_dict(), indent=1, allow_nan=False) + "\n"


def to_csv(study: Study) -> str:
    """What ``thirdbody solve STUDY.toml --csv FILE`` writes."""
    return csv_of(with_units(*run_study(study).table()))


def figure_of(answer: Answer, name: str, suffix: str) -> bytes:
    """One figure of the curves, "png" or "svg"."""
    import matplotlib as mpl

    drawn = getattr(plot, name)(answer.curves).figure
    out = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "thirdbody"}):
        more: dict[str, object] = {"metadata": {"Date": None}} if suffix == "svg" else {"dpi": 200}
        drawn.savefig(out, format=suffix, bbox_inches="tight", **more)
    return out.getvalue()
