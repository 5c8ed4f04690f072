"""The statistical model against surfaces on which every particle has its place.

``thirdbody reproduce explicit`` presses surfaces of several spectra, materials, sizes, densities
and seats, and lays the model beside them with error bars; ``--preset quick`` in a minute, on
small maps. Nothing is fitted.
"""

from __future__ import annotations

from .cases import CASES, Case
from .page import Summary, reproduce

__all__ = ["CASES", "Case", "Summary", "reproduce"]
