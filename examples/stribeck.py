"""
Stribeck curve of a ball in clean and in dirty oil
==================================================

**In short**: debris of a micrometre keeps the solids in contact up to several times the speed.
Filter the oil, or run faster.

A steel ball slides and rolls on a ground steel flat. How fast must it run until the oil keeps the
bodies apart, and what do wear particles of 1 µm change?
"""

import sys
import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # the slow end is below the roughness

steel = tb.materials["S45C"]
clean = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),
    # shear strengths of boundary films: measured, not predicted
    outputs=tb.outputs.Friction(tau_ss=400e6, tau_sa=400e6),
)
debris = tb.Particles(
    material=steel, areal_density=1e10, diameter=tb.TruncatedGaussian(mean=1e-6, std=0.2e-6)
)
dirty = clean.replace(particles=debris)

ball = tb.films.Point(R=9.5e-3)
oil = tb.films.Oil(eta=0.02, alpha=2e-8, eyring_stress=5e6)
speeds = np.geomspace(5e-3, 20, 160)
clean_curve, dirty_curve = (
    tb.films.stribeck(contact, conjunction=ball, oil=oil, load=20.0, speed=speeds, slide_roll=0.05)
    for contact in (clean, dirty)
)

# %%
# Friction and shares of the load over speed.
blue, red = tb.plot.OKABE_ITO["blue"], tb.plot.OKABE_ITO["vermilion"]
figure = Figure(figsize=(6.4, 6.0), layout="constrained")
friction, shares = figure.subplots(2, 1, sharex=True)
friction.plot(speeds, clean_curve.mu, color=blue, label="clean")
friction.plot(speeds, dirty_curve.mu, "--", color=red, label="1 µm steel debris, 10¹⁰ per m²")
friction.set(ylabel=r"traction coefficient $\mu$ [1]", ylim=(0, None))
friction.legend(frameon=False)
solids = {
    "clean: asperities": (clean_curve.ss_share, "-", blue),
    "dirty: asperities": (dirty_curve.ss_share, "--", red),
    "dirty: particles": (dirty_curve.sa_share, ":", red),
}
for label, (share, line, colour) in solids.items():
    shares.plot(speeds, share, line, color=colour, label=label)
shares.axhline(0.01, color="0.6", linewidth=0.8)
shares.text(5.5e-3, 0.0115, "full film below", color="0.4", fontsize=8)
shares.set(
    xlabel="entrainment speed $u$ [m/s]",
    ylabel="load share [1]",
    xscale="log",
    yscale="log",
    ylim=(1e-4, 1.5),
    xlim=(speeds[0], speeds[-1]),
)
shares.legend(frameon=False)
for ax in (friction, shares):
    ax.tick_params(which="both", direction="in", top=True, right=True)


# %%
# The speed from which solids carry less than 1 % of the load.
def full_film_from(curve):
    solid = (curve.ss_share + curve.sa_share).values
    return float(np.exp(np.interp(-np.log(0.01), -np.log(solid), np.log(speeds))))


clean_speed, dirty_speed = full_film_from(clean_curve), full_film_from(dirty_curve)
factor = dirty_speed / clean_speed
if __name__ == "__main__":
    figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "stribeck.png", dpi=180)
print(
    f"The film is full from {clean_speed:.2g} m/s in clean oil and from {dirty_speed:.2g} m/s with "
    f"debris of 1 µm: filter the oil, or run {factor:.1f} times as fast."
)
assert abs(factor - 6.42) < 0.1
