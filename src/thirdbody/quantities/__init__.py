"""Quantities: values with units, hardness scales, numbers in words, files."""
