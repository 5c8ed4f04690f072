"""The model held against measurements, the lost ones first.

``thirdbody reproduce measurements`` writes a page, a ledger and figures. Each measurement is a
module with its `ROW`: the predictions over the inputs that are not known. Conditions, inputs with
their standing, and what was measured and how well that is known are in
``data/papers/measurements.toml``. Nothing is fitted.
"""

from __future__ import annotations

from .listed import NAMES, rows
from .page import reproduce

__all__ = ["NAMES", "reproduce", "rows"]
