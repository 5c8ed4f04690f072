"""
A table for another solver
==========================

Pressure against the gap as a C¹ table with a stated error, the form that Abaqus, COMSOL and others
read. The lower panel is the true error of the table between its knots.
"""

import numpy as np
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
table = tb.table(contact, tolerance=1e-4)
h = np.linspace(210e-9, 600e-9, 801)  # m
exact = tb.solve(contact, d=h - contact.roughness.y_s)
error = np.abs(table.p(h) / np.asarray(exact.pressure) - 1)

figure = Figure(figsize=(5.2, 4.4), layout="constrained")
upper, lower = figure.subplots(2, 1, sharex=True)
upper.semilogy(h * 1e9, table.p(h) / 1e6)
upper.set(ylabel="pressure [MPa]")
lower.semilogy(h * 1e9, np.maximum(error, 1e-12))
lower.axhline(table.error.p, color="0.4", linestyle="--", label="stated")
lower.set(xlabel="gap h [nm]", ylabel="relative error of p [1]")
lower.legend(frameon=False)

# %%
# The stated error bounds the true one.
print(f"stated {table.error.p:.1e}, true {error.max():.1e}")
assert error.max() < table.error.p <= 1e-4
