"""
Dust in a ball screw: temperature of the contacts
=================================================

**In short**: the larger the grains, the hotter the hottest contact. At 1 m/s grains above about
2 µm double the rise over clean steel.

Quartz dust enters a stainless ball screw that runs dry for a moment. How much hotter than the
steel around it is the hottest contact on a square millimetre, and which grains make it so?
"""

import sys
import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # quartz touches on half its radius

steel, quartz = tb.materials["440C"], tb.materials["quartz"]
clean = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel), roughness=tb.Roughness(sigma=100e-9, R=10e-6)
)
# shear strengths of dry steel and of quartz on steel: assumed, they are measured, not predicted
friction = tb.outputs.Friction(tau_ss=500e6, tau_sa=500e6)
sizes = np.geomspace(0.15e-6, 3e-6, 13)  # m
speeds = {0.1: "0.1 m/s", 0.3: "0.3 m/s", 1.0: "1 m/s"}


def dust(median):
    """A hundred grains on a square millimetre, of nearly one size."""
    diameter = tb.LogNormal(median=median, gsd=1.2)
    return tb.Particles(material=quartz, areal_density=1e8, diameter=diameter)


def solved(contact, speed):
    """Outputs at a nominal pressure of 100 MPa."""
    heat = tb.outputs.FlashTemperature(v=speed, A_n=1e-6)
    return tb.solve(contact.replace(outputs=(friction, heat)), pressure=100e6).outputs


bare = {speed: solved(clean, speed)["dT_ss_peak"] for speed in speeds}
dirty = [clean.replace(particles=dust(x)) for x in sizes]
peaks = [[solved(contact, speed)["dT_peak"] for speed in speeds] for contact in dirty]
dusty = dict(zip(speeds, np.array(peaks).T, strict=True))

# %%
# Rise of the hottest contact over the bulk temperature, with grains and without.
figure = Figure(figsize=(5.6, 3.8), layout="constrained")
ax = figure.add_subplot()
for i, (speed, label) in enumerate(speeds.items()):
    ax.loglog(sizes * 1e6, dusty[speed], color=f"C{i}")
    ax.plot(sizes * 1e6, np.full(len(sizes), bare[speed]), color=f"C{i}", ls="--", lw=1)
    ax.annotate(
        label, (sizes[-1] * 1e6, dusty[speed][-1]), xytext=(5, 0), textcoords="offset points",
        color=f"C{i}", va="center",
    )  # fmt: skip
ax.plot([], [], color="0.3", label="with dust, 100 grains on 1 mm²")
ax.plot([], [], color="0.3", ls="--", lw=1, label="clean")
ax.set(
    xlabel="median size of the grains [µm]",
    ylabel="hottest contact over bulk [K]",
    xlim=(0.15, 5),
    ylim=(1, 500),
)
ax.set_xticks([0.2, 0.5, 1, 2], ["0.2", "0.5", "1", "2"])
ax.minorticks_off()
ax.legend(frameon=False, loc="upper left")
if __name__ == "__main__":
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "ball_screw_heat.png", dpi=150)

# %%
# The heat of one grain grows like its load, its way out like the radius of its contacts: the
# temperature goes with the size, and with the speed. What bulk heat adds comes on top.
doubled = np.exp(np.interp(np.log(2 * bare[1.0]), np.log(dusty[1.0]), np.log(sizes)))
ratio = dusty[1.0][-1] / bare[1.0]
assert abs(ratio - 2.831) < 0.05
print(
    f"At 1 m/s, keep out grains above {doubled * 1e6:.2f} µm: they make the hottest contact on "
    f"1 mm² more than twice as hot over the bulk as clean steel ({bare[1.0]:.0f} K), and grains "
    f"of 3 µm {ratio:.0f} times ({dusty[1.0][-1]:.0f} K)."
)
