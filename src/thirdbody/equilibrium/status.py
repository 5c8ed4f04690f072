"""What became of a state: one code for each case, and the sentence that says it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from ..contact.asperity_sums import SEARCHED, ReducedSum
from ..quantities.record import Column, flags_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = [
    "DEEPEST",
    "FIELD_SENTENCES",
    "MOST_AREA",
    "SENTENCES",
    "STATUS_CODE",
    "WORDS",
    "Status",
    "Statuses",
]

DEEPEST = SEARCHED
"""Lowest separation searched, in σ_s from the mean asperity height: every asperity touches."""
MOST_AREA = 0.5
"""Real area from which contacts that are counted one by one have grown together: a plane at the
mean height of a rough surface cuts half of it."""


class Status(IntEnum):
    """Outcome of a state. Files keep the codes: new ones come last, none changes.

    Results hold the codes as numbers in ``status_code``, beside the sentences of ``status``;
    ``Status(code)`` makes a member of a number.

    Examples
    --------
    >>> from thirdbody.results import Status
    >>> Status.OK.sentence, Status(4).word
    ('ok', 'jump')
    >>> Status.CROWDED.has_numbers, Status.TOO_MUCH.has_numbers
    (True, False)
    >>> import thirdbody as tb
    >>> steel = tb.materials["S45C"]
    >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
    ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
    >>> states = tb.solve(contact, pressure=[1e6, 1e15])
    >>> [Status(code).name for code in states.status_code]
    ['OK', 'TOO_MUCH']
    """

    OK = 0
    TOO_MUCH = 1
    TOO_LITTLE = 2
    UNSOLVED = 3
    JUMP = 4
    TOO_DEEP = 5
    BEYOND_LAWS = 6
    CROWDED = 7

    @property
    def word(self) -> str:
        """A word without a space, for files (CF ``flag_meanings``)."""
        return WORDS[self]

    @property
    def sentence(self) -> str:
        """The sentence where no more is known of the state than this."""
        return str(SENTENCES[self])

    @property
    def has_numbers(self) -> bool:
        """Whether such a state has a separation: its numbers are those of the model."""
        return self in (Status.OK, Status.CROWDED)


WORDS = (
    "ok",
    "no_equilibrium_above",
    "no_equilibrium_below",
    "no_equilibrium",
    "jump",
    "too_deep",
    "beyond_laws",
    "crowded",
)


class _StatusColumn(Column):
    """Column of codes of `Status`: a data set says what they mean."""

    __slots__ = ()

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes of the column in a data set, with the words of the codes."""
        return self.labels | flags_of(WORDS)


STATUS_CODE = _StatusColumn("", "", "code of the status")
"""What the column ``status_code`` is."""
SENTENCES = np.array(
    [
        "ok",
        "no equilibrium: the load is beyond the most this model carries down to a separation d of "
        f"{DEEPEST:g} sigma_s; check the unit of the load, or let an oil film carry it",
        "no equilibrium: the load is below the smallest load this model resolves; check the unit "
        "of the load",
        "not solved: no separation was found at which the load is in balance",
        "jump: the load lies in a jump of the load over the separation, and none carries it",
        f"not solved: the separation d is lower than {-ReducedSum.DEEPEST:g} sigma_s from the mean "
        "asperity height, where no asperity model holds; check its sign and its unit",
        "no equilibrium: the laws give no number",
        f"crowded: more than {MOST_AREA:g} of the nominal area would be in contact, where contacts "
        "that this model counts one by one have grown together; its numbers are no answer",
    ],
    dtype=object,
)
"""Of each status, the sentence where no more is known."""
FIELD_SENTENCES = SENTENCES.copy()
FIELD_SENTENCES[[Status.TOO_MUCH, Status.TOO_DEEP]] = [
    "no equilibrium: the load is beyond the most this model carries down to the separation where "
    "the table of the law field ends; check the unit of the load, or let an oil film carry it",
    "not solved: the separation d is lower than where the table of the law field ends; check its "
    "sign and its unit",
]
"""The same of one field of heights."""


@dataclass(frozen=True, eq=False)
class Statuses:
    """Codes of N states (N,), and their sentences, which may tell more than the code."""

    codes: NDArray[np.int8]
    words: NDArray[np.object_]

    @staticmethod
    def from_codes(codes: ArrayLike, *, one_field: bool = False) -> Statuses:
        """Statuses of these codes, with the sentence that all states of a code share."""
        code_array = np.array(codes, dtype=np.int8, ndmin=1)
        return Statuses(code_array, (FIELD_SENTENCES if one_field else SENTENCES)[code_array])

    @staticmethod
    def ok(count: int) -> Statuses:
        """All of them ok."""
        return Statuses.from_codes(np.zeros(count, np.int8))

    def set(
        self,
        which: np.intp | NDArray[np.intp] | NDArray[np.bool_],
        status: Status,
        sentence: str = "",
    ) -> None:
        """Give states a status, and their sentence where it differs from that of the code."""
        self.codes[which] = status
        self.words[which] = sentence or status.sentence

    def take(self, other: Statuses, where: NDArray[np.intp]) -> None:
        """Replace the statuses ``where`` by others."""
        self.codes[where], self.words[where] = other.codes, other.words

    def copy(self) -> Statuses:
        """The same, to change."""
        return Statuses(self.codes.copy(), self.words.copy())

    @property
    def is_solved(self) -> NDArray[np.bool_]:
        """Which states are ok (N,)."""
        return self.codes == Status.OK
