"""A study as one page to hand on: the answer, its figures and tables, and what it rests on."""

from .make import PARTS, report
from .page import Report, running
from .sources import Row, laws_of, rows_of, source_of

__all__ = ["PARTS", "Report", "Row", "laws_of", "report", "rows_of", "running", "source_of"]
