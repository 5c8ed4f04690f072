"""The laws of one particle between two surfaces, as ``thirdbody.particle``."""

from .laws.particle import *  # noqa: F403
from .laws.particle import __all__  # noqa: F401
