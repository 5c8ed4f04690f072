"""The laws of one asperity, as ``thirdbody.asperity``."""

from .laws.asperity import *  # noqa: F403
from .laws.asperity import __all__  # noqa: F401
