"""Ghaednia, Jackson and Gao 2014: elastic asperities, and particles beside them.

``thirdbody reproduce ghaednia2014`` writes ledger and figures. Neither the paper nor its abstract
could be obtained; what is known of it is one sentence of another paper. The model is `Contact`
with `GW` asperities and `Series` particles on the mean asperity plane, loads and areas added:

.. math:: p = \\eta\\int F(z-d)\\,\\phi\\,dz + \\eta_a\\int_{x>d} f(x, d)\\,\\psi(x)\\,dx,
          \\qquad f = \\tfrac43 E^*_{sa}\\sqrt{x/2}\\,\\Bigl(\\frac{x-d}{2}\\Bigr)^{3/2} .
"""

from .model import PRESSURES, READINGS, conductance_ratio, contact, stacked
from .study import STUDY, reproduce

__all__ = [
    "PRESSURES",
    "READINGS",
    "STUDY",
    "conductance_ratio",
    "contact",
    "reproduce",
    "stacked",
]
