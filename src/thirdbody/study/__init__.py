"""Study files: what a user writes in TOML, checked as a whole before anything is computed.

The keys of a table, their units and their ranges are those of the class the table stands for
(`quantity`, `choice`); law names and options come from the registries. For the file at hand a
pydantic schema is put together from them, so that one validation finds every mistake.

Each table is read in a file of its own; `tables` lists them.
"""

from .fields import filled_in
from .results import FilmResult, StudyResult
from .run import run_film, run_study
from .schema import study_schema
from .vocabulary import DISTRIBUTIONS, HEIGHTS, LOADS
from .whole import Study, check, load_study

__all__ = [
    "DISTRIBUTIONS",
    "HEIGHTS",
    "LOADS",
    "FilmResult",
    "Study",
    "StudyResult",
    "check",
    "filled_in",
    "load_study",
    "run_film",
    "run_study",
    "study_schema",
]
