"""What an answer leaves open: ranked by its effect, merged, three of it shown."""

import copy
import math
import pickle
import warnings
from contextvars import ContextVar
from pathlib import Path

import pytest

import thirdbody as tb
from thirdbody.cli import streams
from thirdbody.errors import Note, code_of, note_of, rank_notes

STUDY = tb.load_study(Path(tb.__file__).parent / "data" / "studies" / "ball-screw.toml")


def test_a_note_keeps_its_parts():
    note = Note("A_t reaches 0.3", code="area", effect=0.2, action="press it")
    for same in (pickle.loads(pickle.dumps(note)), copy.copy(note)):
        assert same == "A_t reaches 0.3; press it"
        assert (same.code, same.effect, same.action) == ("area", 0.2, "press it")


def test_the_worst_comes_first_and_once():
    notes = [
        Note("small", effect=0.01),
        "nobody knows of 0.5",
        "nobody knows of 0.7",
        Note("unit", effect=math.inf),
        Note("area 0.1", code="area", effect=0.1),
        Note("area 0.4", code="area", effect=0.4),
    ]
    assert rank_notes(notes) == ["unit", "area 0.4", "nobody knows of 0.5", "small"]


def test_warnings_carry_the_notes_of_the_state():
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        state = tb.solve(STUDY.contact, F_star=1e-4)
    told = [note_of(item.message) for item in heard]
    assert told == list(state.warnings)
    assert all(isinstance(note, Note) and code_of(note) == note.code for note in told)
    assert {note.code for note in told} >= {"squeezed"}
    assert all(note.action for note in told)


@pytest.mark.parametrize(
    ("whole", "before", "most"), [(False, 0, 3), (False, 2, 1), (False, 4, 1), (True, 2, 5)]
)
def test_three_are_shown_and_the_rest_counted(whole, before, most, capsys, monkeypatch):
    """Those of the inputs count as well; of the answer the worst is always shown."""
    monkeypatch.setattr(streams, "SHOWS_ALL", ContextVar("shows_all", default=whole))
    monkeypatch.setattr(streams, "WARNINGS", ContextVar("warnings", default=before))
    streams.warn_of([Note(f"note {i}", code=str(i), effect=i / 10) for i in range(1, 6)])
    worst = [f"warning: note {i}" for i in (5, 4, 3, 2, 1)][:most]
    left = f"note: {5 - most} more warnings of less effect on the answer; --verbose shows all"
    assert capsys.readouterr().err.splitlines() == (worst if whole else [*worst, left])
