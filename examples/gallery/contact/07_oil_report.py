"""
From an ISO 4406 code to the load on debris
===========================================

An oil laboratory reports three numbers. Each step of a code doubles the particles, and the load
they carry follows, as long as it is small. The band is what the code leaves open within its class.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel = tb.materials["S45C"]
codes = ["13/11/8", "15/13/10", "17/15/12", "19/17/14", "21/19/16"]
share = {level: [] for level in ("low", "middle", "high")}
for code in codes:
    for level in share:
        debris = tb.Particles.from_iso4406(code, gap="1 um", material=steel, level=level)
        contact = tb.Contact(
            surfaces=tb.MaterialPair(steel, steel),
            roughness=tb.Roughness(sigma=400e-9, R=25e-6),
            particles=debris,
        )
        share[level].append(float(tb.solve(contact, pressure=1e5).particle_load_share))

figure = Figure(figsize=(5.2, 3.4), layout="constrained")
ax = figure.add_subplot()
ax.fill_between(codes, share["low"], share["high"], alpha=0.3, label="within the code")
ax.semilogy(codes, share["middle"], "o-", label="middle of the code")
ax.set(xlabel="ISO 4406 code", ylabel="particle load share [1]")
ax.legend(frameon=False)

# %%
# Two classes are a factor of four in number.
steps = np.array(share["middle"][1:]) / np.array(share["middle"][:-1])
print("load share from code to code:", *(f"× {step:.2f}" for step in steps))
assert abs(steps[0] - 4) < 0.1
