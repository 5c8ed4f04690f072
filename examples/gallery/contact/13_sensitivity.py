"""
What matters most
=================

Elasticities: by how many per cent a result moves when an input moves by one. They come from the
implicit function theorem at one state, not from a second solution.
"""

from matplotlib.figure import Figure

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
found = tb.sensitivity(contact, of=["particle_load_share"], pressure=5e6)
elasticity = found.elasticity["particle_load_share"]
largest = sorted(elasticity, key=lambda name: abs(elasticity[name]))[-6:]

figure = Figure(figsize=(6.4, 3.2), layout="constrained")
ax = figure.add_subplot()
ax.barh(largest, [elasticity[name] for name in largest])
ax.axvline(0, color="0.4", linewidth=0.8)
ax.set(xlabel="elasticity of the particle load share [1]")

# %%
# Particles one per cent larger carry 2.06 % more.
print(f"{elasticity['particles.diameter.mean']:.3f}")
assert abs(elasticity["particles.diameter.mean"] - 2.055) < 2e-3
