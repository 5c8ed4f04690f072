"""States by quadrature over their own laws: nothing is shared between them but Gauss rules."""
