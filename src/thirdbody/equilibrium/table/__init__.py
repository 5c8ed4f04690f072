"""Pressure and area against the gap as a table for other solvers."""
