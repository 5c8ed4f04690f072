"""The model held against measurements, the lost ones first.

``thirdbody reproduce measurements`` writes a page, a ledger and figures. Each measurement is a
module with its `ROW`: conditions, what was measured and how well that is known, the inputs with
their standing, and the prediction over those that are not known. Nothing is fitted.
"""

from __future__ import annotations

from importlib import import_module

from .page import reproduce
from .row import Row

__all__ = ["NAMES", "reproduce", "rows"]

NAMES = (
    "explicit_particles",
    "williamson1956",
    "chaudhri1984",
    "jamari2006",
    "elastic_area",
    "bennett2017",
    "weber2018",
    "ocallaghan1970",
    "thomas1972",
    "doumouro2020",
    "backside_particles",
    "trezona1999",
    "kong2022",
    "alavi2025",
)
"""Every measurement, by the name of its module."""


def rows() -> tuple[Row, ...]:
    """Every measurement.

    Examples
    --------
    >>> len(rows()) == len(NAMES)
    True
    """
    return tuple(import_module(f"{__name__}.{name}").ROW for name in NAMES)
