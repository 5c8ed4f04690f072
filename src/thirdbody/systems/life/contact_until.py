"""What a history with a contact waits for: wear, roughness, a share of the load."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...quantities.carried import takes_units
from ...quantities.say import percent, value_of
from ...quantities.value import quantity
from .loop import Loop
from .until import Until

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["ContactUntil", "ParticleShare", "RoughnessBelow", "WearDepth", "particle_share",
           "roughness_below", "wear_depth"]  # fmt: skip


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
    >>> WearDepth(depth=5e-6).sentence
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
    >>> RoughnessBelow(sigma=70e-9).sentence
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
    >>> ParticleShare(share=0.5).sentence
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
        pressed = loop.pressed(state, loop.find_gap(state).d)
        eta = loop.present(state, pressed.d)
        own = float(loop.columns(pressed, "load") @ eta)
        all_solids = own + pressed.bare * pressed.asperities["force"]
        present = float(loop.columns(pressed, "loaded") @ eta) * loop.one_area
        if present < 1:
            return -1.0
        return own / all_solids - self.share


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
    >>> wear_depth(5e-6).name
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
    >>> roughness_below(7e-8).name
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
    >>> particle_share(0.5).name
    'particle share'
    """
    return ParticleShare(share=share, stops=stops)
