"""The model held against measurements, the lost ones first.

``thirdbody reproduce measurements`` writes a page, a ledger and figures. Each measurement is a
module with its `ROW`: conditions, what was measured and how well that is known, the inputs with
their standing, and the prediction over those that are not known. Nothing is fitted.
"""

from __future__ import annotations

from .listed import NAMES, rows
from .page import reproduce

__all__ = ["NAMES", "reproduce", "rows"]
