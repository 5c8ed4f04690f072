"""
Fig. 4: area on asperities and on particles
===========================================

The two parts of Eq. 2 by themselves. At 25 nm the particles sink into the valleys: the paper says
that they have less than 0.01 % of the area, and then only at the largest loads.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("4a", "4b")]

# %%
# Particles of 25 nm at the largest load of the paper, F* = 2.4e-4.
fine = curves("SiO2", 100, 25)
share = fine.value_at(2.4e-4, fine.A_sa / fine.A_t)
print(f"25 nm silica has {share:.4%} of the area")
assert abs(share - 2.42e-5) < 2e-6
