"""Laws of one asperity. A new law is one file here and one import line below."""

from ..base import AbstractAsperityLaw, Branch
from .hermite import Hermite
from .zmc import ZMC

REGISTRY = AbstractAsperityLaw.registry
"""Every law by the word that study files use."""

__all__ = ["REGISTRY", "ZMC", "AbstractAsperityLaw", "Branch", "Hermite"]
