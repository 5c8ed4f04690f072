"""Uncertainty: inputs with distributions, and what they do to results."""
