"""
Error bars on the particle load share
=====================================

Roughness and number of particles are never known exactly. Bands of the load share
from 1024 scrambled Sobol points.
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
found = tb.propagate(
    contact,
    vary={
        "roughness.sigma": (85e-9, 115e-9),
        "particles.areal_density": tb.Uncertain.lognormal(median=1e11, gsd=1.5),
    },
    F_star=np.geomspace(1e-6, 1e-3, 7),
    samples=1024,
    outputs=["particle_load_share"],
)
figure = tb.plot.bands(found).figure

# %%
# The band at F* = 1e-5 (5 to 95 %).
low, high = found.bands["particle_load_share"][2][[0, -1]]
print(f"{low:.1%} to {high:.1%}")
assert abs(low - 0.7822) < 2e-3
