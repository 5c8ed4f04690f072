"""
Fig. 7: the turning point at 500 nm roughness
=============================================

The same as Fig. 6 on a rougher surface, now for particles of 300 nm. The paper reads the turning
point at F* = 3.0e-6.
"""

import numpy as np

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("7a", "7b")]

# %%
# The largest share of 300 nm particles.
curve = curves("SiO2", 500, 300)
load = curve.F[np.nanargmax(curve.particle_share)]
print(f"the share of the particles peaks at F* = {load:.2e}")
assert abs(load / 2.97e-6 - 1) < 0.01
