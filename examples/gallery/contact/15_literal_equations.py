"""
As printed: a pressure that never moves
=======================================

Taken to the letter, Eqs. 1 and 2 give the particles a load of H times their area, whatever the
load, the size and the material. The paper's conclusion that the pressure falls with load cannot
come from them (item 17 of :doc:`/errata`). In the consistent model it does change.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel, silica = tb.materials["S45C"], tb.materials["SiO2"]
loads = np.geomspace(1e-6, 1e-4, 40)
figure = Figure(figsize=(5.2, 3.4), layout="constrained")
ax = figure.add_subplot()
for law, words in (
    (tb.particle.Horng2022(preset="literal"), "as printed"),
    (tb.particle.Series(), "consistent"),
):
    contact = tb.Contact(
        surfaces=tb.MaterialPair(steel, steel),
        roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
        particles=tb.Particles(
            material=silica,
            areal_density=1e11,
            diameter=tb.TruncatedGaussian(mean=1000e-9, std=80e-9),
        ),
        particle_law=law,
    )
    state = tb.solve(contact, F_star=loads)
    pressure = loads * contact.E_ss / np.asarray(state.A_t)
    ax.semilogx(loads, pressure / 1e9, "--" if words == "consistent" else "-", label=words)
    if words == "as printed":
        printed = pressure
ax.set(xlabel="load F* [1]", ylabel="mean real pressure [GPa]", ylim=(0, 6))
ax.legend(frameon=False)

# %%
# Five gigapascals, the hardness, at every load.
print(f"{printed.min() / 1e9:.6f} to {printed.max() / 1e9:.6f} GPa")
assert np.allclose(printed, 5e9, rtol=1e-9, atol=0)
