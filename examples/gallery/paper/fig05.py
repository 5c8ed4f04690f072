"""
Fig. 5: area, roughness and two extreme sizes
=============================================

Particles of 1000 nm hold the surfaces apart whatever the roughness; particles of 25 nm do nothing.
The paper reads a gap between the two curves that is 9.8 times as wide at σ = 50 nm as at 500 nm.
This reading has it 2.2 times as wide at F* = 1e-5: one of the statements it misses.
"""

from thirdbody.papers.horng2022 import PANELS, READINGS, Curves
from thirdbody.papers.horng2022.drawing import draw

curves = Curves(READINGS["published"])
figure = draw(PANELS["5"](curves))

# %%
# The gap between the area at 25 nm and at 1000 nm, smooth over rough, at F* = 1e-5.
gap = {}
for sigma in (50, 500):
    fine, coarse = (curves("SiO2", sigma, x_a) for x_a in (25, 1000))
    gap[sigma] = fine.value_at(1e-5, fine.A_t) - coarse.value_at(1e-5, coarse.A_t)
ratio = gap[50] / gap[500]
print(f"the gap at 50 nm is {ratio:.2f} times that at 500 nm")
assert abs(ratio - 2.195) < 0.005
