"""
Fig. 3: real area under load
============================

Particles of 300 nm and more lower the real area. The paper puts the 1000 nm curve at 15 to 22 % of
the area without particles. With a particle pressure equal to the hardness, as Eqs. 1 and 2 say, it
could not go below 32 % (item 20 of :doc:`/errata`); the reading gets there with a pressure of
H_s + H_a, which is inferred from this number and is not physical.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("3a", "3b")]

# %%
# The share of the area that 1000 nm particles leave, at the lowest load of the figure.
share = curves("SiO2", 100, 1000).A_t[0] / curves.two_body(100).A_t[0]
print(f"1000 nm silica leaves {share:.1%} of the area")
assert abs(share - 0.1931) < 1e-3
