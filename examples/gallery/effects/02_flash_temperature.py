"""
Flash temperature: slow and fast
================================

Dry steel, sliding. Slow contacts get hot in proportion to the speed; fast ones leave their heat
behind and follow its square root. Means and the hottest contact of a square millimetre.
"""

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

steel = tb.materials["440C"]  # with conductivity, density and specific heat
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=10e-6),  # m
)
friction = tb.outputs.Friction(tau_ss=500e6)  # Pa
speeds = np.geomspace(0.01, 1e3, 40)  # m/s


def rises(v):
    heat = tb.outputs.FlashTemperature(v=v, A_n=1e-6, spots_on="both")
    return tb.solve(contact.replace(outputs=(friction, heat)), pressure=100e6).outputs


found = [rises(v) for v in speeds]
figure = Figure(figsize=(5.4, 3.6), layout="constrained")
ax = figure.add_subplot()
names = {
    "dT_ss_peak": "hottest of 1 mm²",
    "dT_ss_p95": "95 % are cooler",
    "dT_ss_load": "mean by load",
    "dT_ss_number": "mean by number",
}
for (name, label), style in zip(names.items(), ("-", "--", "-.", ":"), strict=True):
    ax.loglog(speeds, [float(each[name]) for each in found], style, label=label)
ax.set(
    xlabel="sliding speed [m/s]",
    ylabel="rise over the bulk [K]",
    xlim=(speeds[0], speeds[-1]),
)
ax.legend(frameon=False)

# %%
# Slopes at both ends. Steel melts long before the fast one: it is drawn for its limit.
peak = np.log([float(each["dT_ss_peak"]) for each in found])
slopes = np.gradient(peak, np.log(speeds))[[0, -1]]
print(f"ΔT grows like v^{slopes[0]:.2f} when slow and v^{slopes[1]:.2f} when fast")
assert np.allclose(slopes, (1.0, 0.5), atol=0.03)
