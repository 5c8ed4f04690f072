"""
A dusty electrical contact: resistance against load
===================================================

**In short**: grains take load from the metal. A thousand of them on a square millimetre ask for
more than ten times the force.

Two bronze contacts of 1 mm² are closed over insulating quartz dust. The grains carry load and keep
the metal apart. How hard must the contacts be pressed to conduct again?
"""

import sys
import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # small loads leave the range of the seats

bronze, quartz = tb.materials["CuSn8"], tb.materials["quartz"]
area = 1e-6  # m²
force = np.geomspace(0.03, 100, 90)  # N
clean = tb.Contact(
    surfaces=tb.MaterialPair(bronze, bronze),
    roughness=tb.Roughness(sigma=300e-9, R=10e-6),
    outputs=tb.outputs.ElectricalConductance(mean_free_path=40e-9),
)


def resistance(density):
    """Contact resistance [Ω] with so many grains of 2 µm per nominal area."""
    contact = clean
    if density:
        grains = tb.Particles(
            material=quartz, areal_density=density, diameter=tb.LogNormal(median=2e-6, gsd=1.3)
        )
        contact = clean.replace(particles=grains)
    return tb.solve(contact, pressure=force / area).outputs["rho_c"] / area


grains = {0.0: "clean", 1e8: "100 grains", 1e9: "1000 grains", 5e9: "5000 grains"}
curves = {density: resistance(density) for density in grains}

# %%
figure = Figure(figsize=(5.6, 3.8), layout="constrained")
ax = figure.add_subplot()
for (density, label), style in zip(grains.items(), ("k-", "--", "-.", ":"), strict=True):
    ax.loglog(force, curves[density] * 1e3, style, label=label)
ax.axhline(1.0, color="0.6", lw=0.8, zorder=0)
ax.annotate("1 mΩ", (force[-1], 1.0), xytext=(-3, 3), textcoords="offset points", ha="right")
ax.set(
    xlabel="load [N]",
    ylabel="contact resistance of 1 mm² [mΩ]",
    xlim=(force[0], force[-1]),
    ylim=(1e-3, 1e3),
)
ax.legend(frameon=False, title="quartz of 2 µm", loc="lower left")
if __name__ == "__main__":
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "electrical_contact.png", dpi=150)


# %%
# Load that brings the resistance down to 1 mΩ. Spots of metal conduct in proportion to load:
# what the grains carry is lost.
def load_for(limit, curve):
    falling = np.log(curve[::-1])
    return float(np.exp(np.interp(np.log(limit), falling, np.log(force[::-1]))))


needed = {density: load_for(1e-3, curve) for density, curve in curves.items()}
slope = np.polyfit(np.log(force), np.log(curves[0.0]), 1)[0]
assert abs(slope + 0.97) < 0.02
print(
    f"Against 1000 grains of 2 µm press with {needed[1e9]:.1f} N instead of {needed[0.0]:.2f} N "
    f"to stay below 1 mΩ on 1 mm², and against 5000 grains with {needed[5e9]:.0f} N."
)
