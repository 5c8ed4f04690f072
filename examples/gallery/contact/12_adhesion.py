"""
Adhesion: the pull-off load
===========================

Asperities that stick, after Johnson, Kendall and Roberts. The lowest point of load against
separation is the pull-off load: a test that controls the load cannot go below it.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

rubber = tb.Material(E=2e6, nu=0.49, H=1e6)  # Pa, 1, Pa
figure = Figure(figsize=(5.2, 3.6), layout="constrained")
ax = figure.add_subplot()
tension = []
for sigma, style in ((1e-6, "-"), (1.5e-6, "--"), (2e-6, "-.")):  # m
    contact = tb.Contact(
        surfaces=tb.MaterialPair(rubber, rubber),
        roughness=tb.Roughness(sigma=sigma, R=100e-6),
        asperity_law=tb.asperity.JKR(w=0.05, unloading=True),  # J/m²
    )
    held, at = tb.equilibria.pull_off(contact)
    d = np.linspace(min(0.5 * sigma, at), 4 * sigma, 300)
    pressure = np.asarray(tb.solve(contact, d=d).pressure)
    ax.plot(d / sigma, pressure / 1e3, style, label=f"σ = {sigma * 1e6:g} µm")
    ax.plot(at / sigma, -held / 1e3, "k.")
    tension.append(held)
ax.axhline(0, color="0.5", linewidth=0.8)
ax.set(xlabel="separation d/σ [1]", ylabel="nominal pressure [kPa]", ylim=(-5.5, 3))
ax.legend(frameon=False)

# %%
# Roughness weakens adhesion: twice σ leaves an eighth of it.
print("pull-off", *(f"{held / 1e3:.2f} kPa" for held in tension))
assert tension[0] > tension[1] > tension[2]
assert abs(tension[0] / 4.99e3 - 1) < 2e-3
