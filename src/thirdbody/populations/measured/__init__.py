"""Populations as instruments measure them: surfaces, sizes, dust."""
