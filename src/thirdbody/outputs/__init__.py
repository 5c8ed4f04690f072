"""What a solved contact does. A new output is one file here and one import line below."""

from .base import AbstractOutput, Column, Solved
from .counts import Counts

REGISTRY = AbstractOutput.registry
"""Every output by the word that study files use."""

__all__ = ["REGISTRY", "AbstractOutput", "Column", "Counts", "Solved"]
