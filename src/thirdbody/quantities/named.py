"""Kinds of values that study files name: their classes enter a registry when they are defined."""

from __future__ import annotations

from typing import Any, ClassVar

from .value import Value

__all__ = ["Named"]


class Named(Value):
    """A value that study files name by the word of its class.

    A kind of them has a ``registry`` of its own; each class with a ``name`` enters it when its
    module is imported.
    """

    __slots__ = ()
    name: ClassVar[str]
    """The word that study files use."""
    registry: ClassVar[dict[str, type[Any]]] = {}
    """Every class of one kind by its name."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "name" in vars(cls):
            cls.registry[cls.name] = cls
