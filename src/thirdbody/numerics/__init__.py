"""Numerics that know no physics: quadrature, Chebyshev series, roots, sampling."""
