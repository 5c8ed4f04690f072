"""Laws of one asperity. A new law is one file here and one import line below."""

from ...reference import elliptic_hertz
from ..base import AbstractAsperityLaw, Branch, Jump
from ..field.own import OwnSpectrum, RollOff
from .adhesive import DMT, JKR
from .ceb import CEB
from .coated import Coated
from .elliptic import EllipticCEB, EllipticZMC
from .field import Field
from .gw import GW
from .hermite import Hermite
from .jg import JG
from .ke import KE
from .zmc import ZMC

REGISTRY = AbstractAsperityLaw.registry
"""Every law by the word that study files use."""

__all__ = [
    "CEB",
    "DMT",
    "GW",
    "JG",
    "JKR",
    "KE",
    "REGISTRY",
    "ZMC",
    "AbstractAsperityLaw",
    "Branch",
    "Coated",
    "EllipticCEB",
    "EllipticZMC",
    "Field",
    "Hermite",
    "Jump",
    "OwnSpectrum",
    "RollOff",
    "elliptic_hertz",
]
