"""
What part of the load do particles carry?
=========================================

Three sizes of dust between rough steel. Particles well above the roughness carry nearly
everything, particles below it nearly nothing, and all of them lose share as the load grows.
"""

import numpy as np

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),  # m
    particles=tb.Particles(
        material=silica,
        areal_density=1e11,  # 1/m²
        diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),  # m
    ),
)
curves = tb.sweep(
    contact,
    F_star=np.geomspace(1e-7, 1e-3, 120),
    vary={"particles.diameter.mean": [100e-9, 200e-9, 300e-9]},
)
figure = tb.plot.shares(curves).figure

# %%
# The share of 300 nm particles at a nominal pressure of 5 MPa.
share = float(tb.solve(contact, pressure=5e6).particle_load_share)
print(f"{share:.1%} on particles")
assert abs(share - 0.7797) < 1e-3
