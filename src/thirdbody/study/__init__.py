"""Study files: what a user writes in TOML, checked as a whole before anything is computed.

The keys of a table, their units and their ranges are those of the class the table stands for
(`quantity`, `choice`); law names and options come from the registries. `reader.Reader` walks
through the tables of a file and keeps every mistake; `schema.Describer` walks the same way to say
what a file may hold. `tables` lists the tables.
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


def __dir__() -> list[str]:
    return sorted(__all__)
