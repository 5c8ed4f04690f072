"""Sweeps: many states into memory, into a folder, on a cluster."""
