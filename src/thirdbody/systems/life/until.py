"""What a history waits for: a code, a full filter; wear, a roughness, a share of the load."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValue, Problem
from ...populations.measured.cleanliness import iso4406_range, read_iso4406
from ...quantities.arguments import names_arguments
from ...quantities.carried import takes_units
from ...quantities.say import percent, value_of
from ...quantities.value import Value, quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .loop import Loop

    Array = NDArray[np.float64]

__all__ = [
    *("CodeReached", "ContactUntil", "FilterFull", "ParticleShare", "RoughnessBelow", "Until"),
    *("WearDepth", "filter_full", "iso4406", "particle_share", "roughness_below", "wear_depth"),
]


def __dir__() -> list[str]:
    return sorted(__all__)


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
    >>> import thirdbody as tb
    >>> tb.oil.until.CodeReached(code="21/19/16").name
    'code 21/19/16'
    """

    code: str
    stops: bool = True

    def _problems(self) -> list[str]:
        try:
            read_iso4406(self.code)
        except InvalidValue as error:
            return [Problem("code", f": {error.problems[0]}", code=error.code)]
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
            (np.inf, np.inf) if code_number is None else iso4406_range(code_number)
            for code_number in read_iso4406(self.code)
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
    >>> import thirdbody as tb
    >>> tb.oil.until.iso4406("21/19/16").sentence
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


# ------------------------------------------------------------------ in a contact
class ContactUntil(Until):
    """Something that a contact comes to."""

    __slots__ = ()

    @abstractmethod
    def excess(self, loop: Loop, *, state: Array) -> float:
        """What is below 0 before it happens and above it after."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WearDepth(ContactUntil):
    """Either surface is worn by a depth.

    Parameters
    ----------
    depth : float
        w [m].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.WearDepth(depth=5e-6).sentence
    'a surface is worn by 5 µm'
    """

    depth: float = quantity("w", "m", "wear depth", gt=0)
    stops: bool = True

    @property
    def name(self) -> str:
        return "wear depth"

    @property
    def sentence(self) -> str:
        return f"a surface is worn by {value_of(self.depth, 'm', 3)}"

    def excess(self, loop: Loop, *, state: Array) -> float:
        deepest = max(float(state[loop.layout[f"wear_{side}"]][0]) for side in (1, 2))
        return deepest / self.depth - 1


@dataclass(frozen=True, slots=True, kw_only=True)
class RoughnessBelow(ContactUntil):
    """The surfaces have run in to a roughness.

    Parameters
    ----------
    sigma : float
        σ [m].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.RoughnessBelow(sigma=70e-9).sentence
    'the roughness has come down to 70 nm'
    """

    sigma: float = quantity("σ", "m", "roughness", gt=0)
    stops: bool = True

    @property
    def name(self) -> str:
        return "roughness"

    @property
    def sentence(self) -> str:
        return f"the roughness has come down to {value_of(self.sigma, 'm', 3)}"

    def excess(self, loop: Loop, *, state: Array) -> float:
        return 1 - float(state[loop.layout["sigma"]][0]) / self.sigma


@dataclass(frozen=True, slots=True, kw_only=True)
class ParticleShare(ContactUntil):
    """Particles carry a share of the solids' load; waited for only where a contact holds one.

    Parameters
    ----------
    share : float
        Load of the particles over that of particles and asperities [1].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.ParticleShare(share=0.5).sentence
    'particles carry 50 % of what the solids carry'
    """

    share: float = quantity("s", "1", "share of the particles in the load", gt=0, lt=1)
    stops: bool = True

    @property
    def name(self) -> str:
        return "particle share"

    @property
    def sentence(self) -> str:
        return f"particles carry {percent(self.share)} of what the solids carry"

    def excess(self, loop: Loop, *, state: Array) -> float:
        pressed = loop.press_at(state, loop.find_gap(state).d)
        eta = loop.present(state, pressed.d)
        particle_load = float(loop.columns(pressed, "load") @ eta)
        all_solids = particle_load + pressed.bare * pressed.asperities["force"]
        present = float(loop.columns(pressed, "loaded") @ eta) * loop.one_area
        if present < 1:
            return -1.0
        return particle_load / all_solids - self.share


@takes_units
def wear_depth(depth: float, *, stops: bool = True) -> WearDepth:
    """Wait for a wear depth of either surface.

    Parameters
    ----------
    depth : float
        w [m].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.wear_depth(5e-6).name
    'wear depth'
    """
    return WearDepth(depth=depth, stops=stops)


@takes_units
def roughness_below(sigma: float, *, stops: bool = True) -> RoughnessBelow:
    """Wait for a roughness.

    Parameters
    ----------
    sigma : float
        σ [m].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.roughness_below(7e-8).name
    'roughness'
    """
    return RoughnessBelow(sigma=sigma, stops=stops)


@takes_units
def particle_share(share: float, *, stops: bool = True) -> ParticleShare:
    """Wait for a share of the particles in the load of the solids.

    Parameters
    ----------
    share : float
        [1].
    stops : bool, optional
        Whether the history ends there.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.oil.until.particle_share(0.5).name
    'particle share'
    """
    return ParticleShare(share=share, stops=stops)
