"""
Where do the particles lie?
===========================

The largest uncertainty of any such model: the same particles half a roughness deeper, at random
places, and half a roughness higher. If you do not know, give all three.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
loads = np.geomspace(1e-7, 1e-3, 80)
figure = Figure(figsize=(5.2, 3.6), layout="constrained")
ax = figure.add_subplot()
share = {}
for zeta, style, words in (
    (-0.5, "--", "valleys, −0.5 σ"),
    (0.0, "-", "random places"),
    (0.5, "-.", "peaks, +0.5 σ"),
):
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=300e-9, R=2.8e-6),
        particles=tb.Particles(
            material=silica,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=300e-9, std=24e-9),
        ),
        particle_law=tb.particle.Series(zeta_mean=zeta),
    )
    state = tb.solve(contact, F_star=loads)
    ax.semilogx(loads, 100 * np.asarray(state.particle_load_share), style, label=words)
    share[zeta] = float(tb.solve(contact, F_star=1e-5).particle_load_share)
ax.set(xlabel="load F* [1]", ylabel="particle load share [%]")
ax.legend(frameon=False)

# %%
# What half a roughness up or down is worth at F* = 1e-5.
ratio = share[0.5] / share[-0.5]
print(f"peaks carry {ratio:.1f} times what valleys carry")
assert abs(ratio - 16.42) < 0.05
