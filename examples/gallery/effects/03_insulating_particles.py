"""
Conductance with insulating particles
=====================================

Bronze on bronze in vacuum with quartz dust. At equal pressure the grains hold the surfaces apart,
which costs far more conductance than what the grains conduct themselves gives back.
"""

import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # quartz touches on half its radius

bronze, quartz = tb.materials["CuSn8"], tb.materials["quartz"]
clean = tb.Contact(
    surfaces=tb.MaterialPair(bronze, bronze),
    roughness=tb.Roughness(sigma=300e-9, R=10e-6),  # m
    outputs=tb.outputs.ThermalConductance(),
)
grains = tb.Particles(
    material=quartz, areal_density=1e9, diameter=tb.LogNormal(median=2e-6, gsd=1.3)
)
dusty = clean.replace(particles=grains)
pressure = np.geomspace(1e5, 1e8, 60)  # Pa
bare, dust = (tb.solve(contact, pressure=pressure).outputs for contact in (clean, dusty))

figure = Figure(figsize=(5.4, 3.6), layout="constrained")
ax = figure.add_subplot()
ax.loglog(pressure / 1e6, bare["hc"], "k", label="clean")
ax.loglog(pressure / 1e6, bare["hc_cmy"], "k:", label="Cooper, Mikic, Yovanovich")
ax.loglog(pressure / 1e6, dust["hc"], label="with quartz of 2 µm, 10⁹ per m²")
ax.loglog(pressure / 1e6, dust["hc_sa"], "--", label="of this, through the grains")
ax.set(
    xlabel="nominal pressure [MPa]",
    ylabel="thermal conductance [W/(m² K)]",
    xlim=(0.1, 100),
    ylim=(1e2, 3e6),
)
ax.legend(frameon=False)

# %%
# Clean surfaces conduct almost in proportion to pressure: Cooper, Mikic and Yovanovich have p^0.95.
slope = np.polyfit(np.log(pressure), np.log(bare["hc"]), 1)[0]
at = tb.solve(dusty, pressure=5e6).outputs["hc"] / tb.solve(clean, pressure=5e6).outputs["hc"]
print(f"clean: p^{slope:.2f}; at 5 MPa the dust leaves {at:.1%} of it")
assert abs(slope - 0.95) < 0.03
