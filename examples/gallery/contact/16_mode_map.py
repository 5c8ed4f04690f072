"""
A map of contact modes
======================

Particle size over roughness against load, every point a solved state. Particles of twice the
roughness carry most of a small load, particles of half of it next to nothing of any.
"""

import numpy as np

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    particles=tb.Particles(
        material=silica,
        areal_density=1e11,
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
    ),
)
figure = tb.plot.mode_map(
    contact, ratio=np.geomspace(0.3, 6, 33), F_star=np.geomspace(1e-7, 1e-3, 33)
).figure

# %%
# One point of the map.
state = tb.solve(contact, F_star=1e-6)
print(f"x_a = 3 σ at F* = 1e-6: {state.mode}")
assert state.mode == "p-s"
