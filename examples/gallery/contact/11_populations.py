"""
Dust beside wear debris
=======================

Two populations in one interface. Each has its material and its sizes, and the state says what each
of them carries.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
debris = tb.Particles(
    material=steel, areal_density=3e11, diameter=tb.LogNormal(median=120e-9, gsd=1.4)
)
dust = tb.Particles(
    material=silica,
    areal_density=2e10,
    diameter=tb.TruncatedGaussian(mean=400e-9, std=40e-9),
)
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    particles=(debris, dust),
)
loads = np.geomspace(1e-7, 1e-3, 60)
state = tb.solve(contact, F_star=loads)

figure = Figure(figsize=(5.2, 3.4), layout="constrained")
ax = figure.add_subplot()
looks = (("--", "debris, 120 nm"), ("-", "dust, 400 nm"))
for each, (style, words) in zip(state.populations, looks, strict=True):
    ax.semilogx(loads, 100 * np.asarray(each.load_share), style, label=words)
asperities = 1 - np.asarray(state.particle_load_share)
ax.semilogx(loads, 100 * asperities, ":", color="0.3", label="asperities")
ax.set(xlabel="load F* [1]", ylabel="share of the load [%]")
ax.legend(frameon=False)

# %%
# All shares sum to one.
total = asperities + sum(np.asarray(each.load_share) for each in state.populations)
print(f"{abs(total - 1).max():.1e}")
assert abs(total - 1).max() < 1e-12
