"""Populations: what lies in the interface, bodies, heights, particles."""
