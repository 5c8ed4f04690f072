"""The page of an assessment, with its figures, as one HTML file."""

from __future__ import annotations

import warnings
from dataclasses import replace
from html import escape

import numpy as np

from ..analysis.assessment import WORDS, Assessment
from ..analysis.assessments import Assessments
from ..analysis.uncertainty.propagation import OUTPUTS, Propagation, propagate
from ..equilibrium.status import MOST_AREA
from ..errors import RangeWarning
from ..quantities.say import percent

__all__ = ["page", "pictures"]

LOADS_SHOWN, SAMPLES_SHOWN = 25, 1024
"""Loads and samples of the figure."""
MOST_BARS = 8
"""Inputs that have a bar."""


def page(assessment: Assessment | Assessments) -> str:
    """The page as one file: figures inside, nothing loaded, no date: same bytes again."""
    from .html import document, figure, section, text_table, words

    title = assessment.title or "Assessment"
    body = [f"<h1>{escape(title)}</h1>"]
    figures = iter(pictures(assessment) if isinstance(assessment, Assessment) else [])
    for chapter in assessment.sections():
        lines = [text_table(chapter.head, chapter.rows, WORDS)] if chapter.rows else []
        lines += [f"<p>{words(sentence)}</p>" for sentence in chapter.sentences]
        if chapter.title in ("State", "Inputs that matter") and (next_one := next(figures, None)):
            caption, picture = next_one
            lines.append(figure(picture, caption))
        body.append(section(chapter.title, lines))
    return document(title, body)


def _drop_crowded_loads(curve: Propagation, of: str, value: float) -> Propagation:
    """Bands up to the load from which crowded samples would be an end of the outermost one.

    All of them where the operating load itself is crowded: of that the page warns.
    """
    close = np.asarray(curve.crowded) > min(curve.probabilities)
    loads = np.asarray(curve.loads)
    if not close.any() or (end := int(np.argmax(close))) < 2 or loads[end - 1] < value:
        return curve
    return replace(
        curve,
        loads=loads[:end],
        bands={of: np.asarray(curve.bands[of])[:end]},
        nominal={of: np.asarray(curve.nominal[of])[:end]},
        crowded=np.asarray(curve.crowded)[:end],
    )


def pictures(assessment: Assessment) -> list[tuple[str, bytes]]:
    """Captions and pictures of the bands over the load, and of the inputs."""
    from matplotlib.figure import Figure

    from . import plot
    from .html import svg_of

    propagation = assessment.propagation
    if not propagation.inputs:
        return []
    of = "A_t" if propagation.contact.two_body else "particle_load_share"
    value = float(propagation.loads)
    loads = value * np.geomspace(1 / 30, 30, LOADS_SHOWN)
    other_inputs = {
        name: one for name, one in propagation.inputs.items() if name != propagation.load
    }
    out = []
    if other_inputs:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)  # nobody has asked for these loads
            curve = propagate(
                propagation.contact,
                vary=other_inputs,
                **{propagation.load: loads},  # type: ignore[arg-type]
                samples=max(min(SAMPLES_SHOWN, propagation.samples // 16), 64),
                seed=propagation.seed,
                outputs=[of],
            )
        shown = _drop_crowded_loads(curve, of, value)
        ax = plot.bands(shown, of, mark=value)
        words = f"Bands of the {OUTPUTS[of].meaning} over the load; the operating load is marked."
        if len(shown.loads) < len(loads):
            words += (
                f" Beyond the last load drawn, more than {percent(min(curve.probabilities))} of "
                f"the cases have more than {percent(MOST_AREA)} of the area in contact, where "
                "this model does not hold."
            )
        out.append((words, svg_of(ax.figure)))
    else:
        out.append(("Only the load is uncertain.", svg_of(Figure(figsize=(1, 1)))))
    if not assessment.moved:
        return out
    values = assessment.tornado[assessment.decisive]
    strongest = dict([*values.items()][:MOST_BARS])
    ax = plot.tornado(propagation, assessment.decisive, values=strongest)
    called = assessment.called
    words = f"{called[:1].upper()}{called[1:]} with one input at each end of its 5 % to 95 % range"
    words += f", the {MOST_BARS} strongest." if len(values) > MOST_BARS else "."
    return [*out, (words, svg_of(ax.figure))]
