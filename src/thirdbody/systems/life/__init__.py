"""The life of an oil and of a contact in it: particles that come, act and go, over time."""

from . import circuit as circuit
from . import contact_course as contact_course
from . import contact_history as contact_history
from . import contact_life as contact_life
from . import contact_tables as contact_tables
from . import contact_until as contact_until
from . import debris as debris
from . import dry_loop as dry_loop
from . import entry as entry
from . import fatigue as fatigue
from . import film_loop as film_loop
from . import history as history
from . import ingress as ingress
from . import ledger as ledger
from . import linear_flow as linear_flow
from . import loop as loop
from . import oil_dirt as oil_dirt
from . import oil_history as oil_history
from . import particle_curves as particle_curves
from . import pieces as pieces
from . import reports as reports
from . import run as run
from . import size_classes as size_classes
from . import sizing as sizing
from . import steady as steady
from . import surfaces as surfaces
from . import until as until

__all__ = [
    "circuit",
    "contact_course",
    "contact_history",
    "contact_life",
    "contact_tables",
    "contact_until",
    "debris",
    "dry_loop",
    "entry",
    "fatigue",
    "film_loop",
    "history",
    "ingress",
    "ledger",
    "linear_flow",
    "loop",
    "oil_dirt",
    "oil_history",
    "particle_curves",
    "pieces",
    "reports",
    "run",
    "size_classes",
    "sizing",
    "steady",
    "surfaces",
    "until",
]
