"""A printed model of the surface of the contact-mechanics challenge on silicone."""

from __future__ import annotations

from .row import row_of

__all__ = ["ROW"]

ROW = row_of("bennett2017", {"area": lambda: None})
