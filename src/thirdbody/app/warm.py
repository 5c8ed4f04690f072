"""What a process that computes for the page does before its first answer."""

from __future__ import annotations

from pathlib import Path

from .examples import example
from .state import State
from .tabs import curves, interface

__all__ = ["warm"]


def warm() -> None:
    """Load and compile what the first answers need."""
    state = State(example(), Path())
    answer = state.answer
    assert answer is not None
    interface.drawing_of(answer, state.operating_load, 0)
    curves.figures(answer, "pressure", critical=False)
