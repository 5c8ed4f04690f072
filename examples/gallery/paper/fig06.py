"""
Fig. 6: shares of the area, and the turning point
=================================================

At σ = 300 nm particles of 200 nm share the area at small loads and lose it at larger ones. The
paper calls the largest share the turning point of the contact area (TPCA) and reads it at
F* = 1.9e-6. It exists only because h_e lifts the particles to the asperity tops: with particles
at random places of the surface there is none (:doc:`/choose-a-seat`).
"""

import numpy as np

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("6a", "6b", "6c")]

# %%
# The largest share of 200 nm particles inside the range of the figure.
curve = curves("SiO2", 300, 200)
load = curve.F[np.nanargmax(curve.particle_share)]
print(f"the share of the particles peaks at F* = {load:.2e}")
assert abs(load / 1.28e-6 - 1) < 0.01
