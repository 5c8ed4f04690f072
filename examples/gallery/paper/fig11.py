"""
Fig. 11: separation against particle size
=========================================

Separation at one load. It follows the surface while particles are smaller than the gap, and the
particle diameter once they carry. The paper does not state the load; F* = 1e-5 is taken.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figures = [draw(PANELS[name](curves)) for name in ("11a", "11b")]

# %%
# d* without particles and with 1000 nm silica, at σ = 100 nm.
bare, dusty = (curves.state_at(1e-5, "SiO2", 100, x_a).d_star[0] for x_a in (0, 1000))
print(f"d* = {bare:.3f} and {dusty:.2f}: {dusty / bare:.2f} times")
assert abs(dusty / bare - 5.703) < 0.005
