"""
One asperity: mean pressure under six laws
==========================================

A tip is pressed into a flat. Its mean pressure follows Hertz until first yield, at 0.4 of the
hardness for ZMC, and ends at the hardness or, for laws fitted to finite elements, near it.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel = tb.materials["S45C"]
E_star = tb.MaterialPair(steel, steel).E_star  # Pa
R = 2.8e-6  # m
omega = np.geomspace(1e-11, 1e-6, 400)  # m

figure = Figure(figsize=(5.2, 3.6), layout="constrained")
ax = figure.add_subplot()
names = ("gw", "ceb", "zmc", "hermite", "ke", "jg")
dashes = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
for name, dash in zip(names, dashes, strict=True):
    law = tb.asperity.REGISTRY[name]()
    law = law.bound(R=R, E_star=E_star, H=steel.H, nu=steel.nu)
    pressure = law.mean_pressure(omega, R=R, E_star=E_star, H=steel.H)
    ax.semilogx(omega * 1e9, pressure / steel.H, linestyle=dash, label=name)
ax.set(xlabel="interference ω [nm]", ylabel="mean pressure over hardness [1]", ylim=(0, 1.6))
ax.legend(frameon=False)

# %%
# At first yield ZMC presses with 0.4 H, whatever the radius and the material.
zmc = tb.asperity.ZMC()
omega_1 = zmc.yield_interference(R=R, E_star=E_star, H=steel.H)
ratio = float(zmc.mean_pressure(omega_1, R=R, E_star=E_star, H=steel.H)) / steel.H
print(f"first yield at {omega_1 * 1e9:.2f} nm with {ratio:.3f} H")
assert abs(ratio - 0.4) < 1e-12
