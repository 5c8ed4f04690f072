"""What a history waits for: a cleanliness code, a filter that is full."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Problem
from ...populations.measured.cleanliness import iso4406_range, read_iso4406
from ...quantities.arguments import names_arguments
from ...quantities.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["CodeReached", "FilterFull", "Until", "filter_full", "iso4406"]


class Until(Value):
    """Something that a history waits for, and whether it ends there."""

    __slots__ = ()
    stops: bool

    @property
    @abstractmethod
    def name(self) -> str:
        """What is reached, as events are called."""

    @property
    @abstractmethod
    def sentence(self) -> str:
        """What is said of it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeReached(Until):
    """The oil reaches an ISO 4406 code.

    Oil with a count above its range becomes clean: all three must come down to it. Other oil
    becomes dirty: one count that comes up to its range is enough.

    Parameters
    ----------
    code : str
        "21/19/16"; "-/19/16" leaves the count from 4 µm(c) out.
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> CodeReached(code="21/19/16").name
    'code 21/19/16'
    """

    code: str
    stops: bool = True

    def _problems(self) -> list[str]:
        try:
            read_iso4406(self.code)
        except InvalidValue as error:
            return [Problem("code", f": {error.problems[0]}")]
        return []

    @property
    def name(self) -> str:
        return f"code {self.code}"

    @property
    def sentence(self) -> str:
        return f"the oil reaches {self.code}"

    def _ranges(self) -> Array:
        """Counts of each size, above and up to [1/m³], (3, 2); infinite where left out."""
        ends = [
            (np.inf, np.inf) if each is None else iso4406_range(each)
            for each in read_iso4406(self.code)
        ]
        return np.array(ends)

    def is_dirtier(self, counts: Array) -> bool:
        """Whether oil with these counts is dirtier than the code, so that it is to become clean.

        Parameters
        ----------
        counts : array (3,)
            Particles per volume from 4, 6 and 14 µm(c) [1/m³].
        """
        return bool(np.any(counts > self._ranges()[:, 1] * (1 + 1e-9)))

    def distance(self, counts: Array, *, cleans: bool) -> Array:
        """What is below 0 before the code is reached and above it after, (...).

        Parameters
        ----------
        counts : array (..., 3)
            Particles per volume from 4, 6 and 14 µm(c) [1/m³].
        cleans : bool
            Whether the oil is to become clean.
        """
        low, high = self._ranges().T
        with np.errstate(divide="ignore", invalid="ignore"):
            if cleans:
                over = np.where(np.isinf(high), -np.inf, np.log(counts / high))
                return -np.max(over, axis=-1)
            over = np.where(np.isinf(low), -np.inf, np.log(counts) - np.log(np.maximum(low, 1e-12)))
        return np.max(over, axis=-1)


@dataclass(frozen=True, slots=True, kw_only=True)
class FilterFull(Until):
    """A filter is full.

    Parameters
    ----------
    stops : bool, optional
        Whether the history ends there.
    """

    stops: bool = True

    @property
    def name(self) -> str:
        return "filter full"

    @property
    def sentence(self) -> str:
        return "a filter is full"


@names_arguments
def iso4406(code: str, *, stops: bool = True) -> CodeReached:
    """Wait for an ISO 4406 code of the oil.

    Parameters
    ----------
    code : str
        "21/19/16".
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> iso4406("21/19/16").sentence
    'the oil reaches 21/19/16'
    """
    return CodeReached(code=code, stops=stops)


@names_arguments
def filter_full(*, stops: bool = True) -> FilterFull:
    """Wait for a filter that is full.

    Parameters
    ----------
    stops : bool, optional
        Whether the history ends there.
    """
    return FilterFull(stops=stops)
