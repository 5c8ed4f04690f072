"""What the library refuses and warns of, held by the fields of its records and not by its words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

import thirdbody as tb
from thirdbody.equilibrium.status import Status
from thirdbody.errors import Mistake

__all__ = ["Mistake", "Status", "balances_not", "refuses", "warns_of"]


@contextmanager
def balances_not(status: Status | None, *, says: str = "") -> Iterator[None]:
    """Context whose end finds no equilibrium, with the status of such a state.

    ``says`` is a number or a name that its sentence has to state.
    """
    with pytest.raises(tb.errors.NoEquilibrium) as told:
        yield
    assert told.value.status is status
    assert says in str(told.value)


class refuses:
    """Context whose end refuses an input: the kind of mistake, its dotted place, its value.

    ``says`` is a number or a name that its sentence has to state. It can be entered again, so
    that a row of `parametrize` can hold one.
    """

    def __init__(
        self,
        code: Mistake,
        place: str,
        *,
        value: str | None = None,
        meant: str | None = None,
        says: str = "",
    ):
        self.wanted, self.value, self.meant, self.says = (code, place), value, meant, says

    def __repr__(self) -> str:
        return " ".join(filter(None, self.wanted))

    def __enter__(self) -> pytest.ExceptionInfo[tb.errors.InvalidValue]:
        self.refusal = pytest.raises(tb.errors.InvalidValue)
        self.told = self.refusal.__enter__()
        return self.told

    def __exit__(self, *raised: object) -> bool:
        if not self.refusal.__exit__(*raised):  # type: ignore[arg-type]
            return False
        problems = self.told.value.problems
        told = [(each.code, each.place) for each in problems]
        assert self.wanted in told, f"{self.wanted} is not among {told}"
        same = [each for each in problems if (each.code, each.place) == self.wanted]
        assert any(self.says in each for each in same), same
        if self.value is not None:
            assert self.value in [each.value for each in same]
        if self.meant is not None:
            assert self.meant in [each.meant for each in same]
        return True


@contextmanager
def warns_of(
    code: str,
    *,
    effect: float | None = None,
    says: str = "",
    kind: type[Warning] = tb.errors.RangeWarning,
) -> Iterator[pytest.WarningsRecorder]:
    """Context in which a note with this code is told, with this effect on the answer.

    ``says`` is a number or a name that its sentence has to state.
    """
    with pytest.warns(kind) as told:
        yield told
    notes = [each.message.args[0] for each in told if isinstance(each.message, kind)]
    codes = [getattr(note, "code", "") for note in notes]
    assert code in codes, f"{code} is not among {codes}"
    same = [note for note in notes if getattr(note, "code", "") == code]
    assert any(says in note for note in same), same
    if effect is not None:
        effects = [note.effect for note in same]
        assert any(math.isclose(each, effect, rel_tol=1e-3) for each in effects), effects
