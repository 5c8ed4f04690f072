"""The life of an oil and of a contact in it: particles that come, act and go, over time."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import circuit as circuit
    from . import debris as debris
    from . import entry as entry
    from . import fatigue as fatigue
    from . import history as history
    from . import ingress as ingress
    from . import ledger as ledger
    from . import linear_flow as linear_flow
    from . import oil_dirt as oil_dirt
    from . import oil_history as oil_history
    from . import reports as reports
    from . import run as run
    from . import size_classes as size_classes
    from . import sizing as sizing
    from . import steady as steady
    from . import surfaces as surfaces
    from . import until as until

__all__ = [
    "circuit",
    "debris",
    "entry",
    "fatigue",
    "history",
    "ingress",
    "ledger",
    "linear_flow",
    "oil_dirt",
    "oil_history",
    "reports",
    "run",
    "size_classes",
    "sizing",
    "steady",
    "surfaces",
    "until",
]


def __dir__() -> list[str]:
    return sorted(__all__)


def __getattr__(name: str) -> Any:
    """A module of this one, imported when it is first asked for: few commands need many."""
    from importlib import import_module

    if name in __all__:
        return import_module(f".{name}", __name__)
    from ...quantities.nearest import no_attribute

    raise no_attribute(__name__, name, __all__)
