"""Equilibrium: the separation that carries the load, and the loads that matter."""
