"""
A measured surface and its cut-off
==================================

Height map, spectrum, and how σ, slope, R and η move with the shortest wave let in. The map comes
with the package; it is made, not measured.
"""

import thirdbody as tb

surface = tb.surfaces.from_topography("example", cutoff=1e-6)  # m
figure = tb.plot.surface(surface)

# %%
# R is not a property of the surface alone: twice the cut-off gives another one.
radius = [
    tb.surfaces.from_topography("example", cutoff=cutoff).roughness().R for cutoff in (1e-6, 2e-6)
]
print(f"R = {radius[0] * 1e6:.2f} µm at 1 µm, {radius[1] * 1e6:.2f} µm at 2 µm")
assert abs(radius[0] / 3.27e-6 - 1) < 3e-3
assert radius[1] > 2 * radius[0]
