"""
Dust in a ball screw: which grains dent, and how deep
=====================================================

**In short**: fine quartz of a few micrometres already dents deeper than the roughness. A filter of
10 µm stops the deep dents, which are few: wipers must keep the dust out.

Fine test dust gets into the oil of a ball screw. The film between ball and groove is 0.3 µm high,
the ground surfaces are 0.1 µm rough. Grains larger than the film are pressed into both surfaces;
those that leave dents deeper than the roughness are the ones a filter or wiper must keep out.
"""

import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

import thirdbody as tb
from thirdbody.effects.single.dent import dent_of, dents_after
from thirdbody.populations.measured import cleanliness
from thirdbody.systems.oil_particles import FilmParticles

steel = tb.materials["S45C"].replace(H=7.5e9, name="hardened bearing steel, 62 HRC")
quartz = tb.materials["quartz"]
film, roughness = 0.3e-6, 0.1e-6  # m
passes = 1e5

sizes = cleanliness.dust_sizes("A2")
dust = cleanliness.concentration("10 mg/L")
oil = FilmParticles(
    surfaces=tb.MaterialPair(steel, steel),
    material=quartz,
    diameter=sizes,
    number=cleanliness.particles_in(dust, sizes, particle_density=2650),
    film=film,
    entry=1.0,  # as many grains enter as the oil carries: an assumption, counts scale with it
)


def depth(x):
    """Depth of the dent [m] of grains of sizes x [m]."""
    return dent_of(oil.single(x), side=0, particle=quartz).depth[:, 0]


# %%
# How deep one grain goes: the depth grows with size less film. The grain takes part of that itself,
# and part of it recovers. The film does not give way here, so these depths are upper bounds.
x = np.geomspace(film, 30e-6, 300)
harmful = float(brentq(lambda y: float(depth(y)[0]) - roughness, film, 10e-6))

# %%
# How many dents on a square centimetre are deeper than a depth, after 100 000 overrollings. Grains
# larger than x make the dents deeper than depth(x). Where dents overlap, they stop adding.
larger = np.geomspace(sizes.support[0], 30e-6, 120)
deeper = np.array([oil.above(y) for y in larger])
count = dents_after(deeper, overrollings=passes, area=oil.dents().area) * 1e-4
mesh = 10e-6  # m
kept = oil.above(0.0) / oil.above(mesh)

figure = Figure(figsize=(7.2, 3.3), layout="constrained")
one, two = figure.subplots(1, 2)
one.loglog(x * 1e6, depth(x) * 1e6, color="#0072B2")
one.axhline(roughness * 1e6, color="0.5", ls="--", lw=1)
one.text(28, roughness * 1e6 * 0.92, "roughness", ha="right", va="top", fontsize=8, color="0.35")
one.axvline(harmful * 1e6, color="#D55E00", ls=":", lw=1.2)
one.text(harmful * 1.1e6, 6, f"{harmful * 1e6:.2f} µm", color="#D55E00", fontsize=8)
one.set(
    xlabel="grain size [µm]",
    ylabel="depth of its dent [µm]",
    xlim=(0.3, 30),
    ylim=(0.01, 15),
)
two.loglog(depth(larger) * 1e6, count, color="#0072B2")
two.axvline(roughness * 1e6, color="0.5", ls="--", lw=1)
two.text(roughness * 1.1e6, 20, "roughness", fontsize=8, color="0.35")
at = float(depth(mesh)[0]) * 1e6
two.axvline(at, color="#D55E00", ls=":", lw=1.2)
two.text(1.1 * at, 3e6, "grain of 10 µm", color="#D55E00", fontsize=8)
two.set(
    xlabel="depth [µm]",
    ylabel="deeper dents per cm²\nafter 10⁵ overrollings",
    xlim=(0.08, 15),
    ylim=(10, 1e7),
)
told = sys.argv[1:] if __name__ == "__main__" else []
figure.savefig(told[0] if told else "ball_screw_dents.png", dpi=150)

# %%
# What to do about it.
print(
    f"Quartz is 1.6 times as hard as this steel, and more squashed than embedded. Grains above "
    f"{harmful * 1e6:.2f} µm dent deeper than the roughness: "
    f"{oil.above(harmful) * 1e-4:.0f} per cm² and overrolling at 10 mg/L. A 10 µm "
    f"filter stops the dents deeper than {at:.1f} µm, but that is one in {kept:.0f}: keep the "
    "dust out with wipers, a filter alone does not save the surface."
)
assert abs(harmful - 1.575e-6) < 0.005e-6
