"""Every measurement that the model is held against."""

from __future__ import annotations

from importlib import import_module

from .row import Row

__all__ = ["NAMES", "rows"]

NAMES = (
    "explicit_particles",
    "williamson1956",
    "chaudhri1984",
    "flattened_area",
    "bishop1945",
    "pintaude2010",
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
    >>> from thirdbody.papers.measurements import rows
    >>> from thirdbody.papers.measurements.listed import NAMES
    >>> len(rows()) == len(NAMES)
    True
    """
    return tuple(import_module(f".{name}", __package__).ROW for name in NAMES)
