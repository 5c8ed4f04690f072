"""
Contact on particles, on both, on asperities
============================================

The contact mode over load for four particle sizes. Below F_cr1 particles have at least 98 % of the
real area (p-s), above F_cr2 asperities have 95 % (s-s), and between them it is on both (hybrid).
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
curves = tb.sweep(
    contact,
    F_star=np.geomspace(1e-7, 1e-2, 200),
    vary={"particles.diameter.mean": [50e-9, 100e-9, 200e-9, 300e-9]},
)
figure = tb.plot.modes(curves).figure

# %%
# The load that ends contact by particles alone.
found = tb.transitions(contact)
print(f"F_cr1 = {found.F_cr1.value:.3e} ({found.F_cr1.status})")
assert abs(found.F_cr1.value / 4.726e-6 - 1) < 2e-3
