"""The life of an oil and of a contact in it: particles that come, act and go, over time."""

from . import circuit as circuit
from . import ingress as ingress
from . import oil_dirt as oil_dirt
from . import size_classes as size_classes

__all__ = ["circuit", "ingress", "oil_dirt", "size_classes"]
