"""
Fig. 8: silica against steel debris
===================================

The share of the asperities at σ = 300 nm for both particle materials. In the printed equations the
particle material enters through one factor, the bracket of moduli; the hardness of the particle is
in none of them (item 16 of :doc:`/errata`).
"""

import numpy as np

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figure = draw(PANELS["8"](curves))

# %%
# The smallest share of asperities beside 200 nm silica.
share = float(np.nanmin(curves("SiO2", 300, 200).asperity_share))
print(f"asperities keep at least {share:.1%} of the area")
assert abs(share - 0.7562) < 1e-3
