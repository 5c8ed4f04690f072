"""
Friction against particle size
==============================

Steel on steel with alumina. Growing particles first raise friction, as each of them sinks deeper
and leaves a wider track; where they come to carry everything, the larger dent less for the same
load. Silica, 1.5 times as hard as the steel, is squashed: friction with it falls from the start.
"""

import warnings

import numpy as np
from matplotlib.figure import Figure

import thirdbody as tb

warnings.simplefilter("ignore", tb.errors.RangeWarning)  # the smallest particles drown

steel = tb.materials["S45C"]
sizes = np.geomspace(100e-9, 1.5e-6, 60)  # m
contact = tb.Contact(
    surfaces=tb.MaterialPair(steel, steel),
    roughness=tb.Roughness(sigma=100e-9, R=2.8e-6),  # m
    particles=tb.Particles(
        material=tb.materials["Al2O3"],
        areal_density=1e10,  # 1/m²
        diameter=tb.distributions.Monodisperse(mean=500e-9),  # m
    ),
    outputs=tb.outputs.Friction(tau_ss=580e6, tau_sa=200e6),  # Pa
)
found = tb.sweep(contact, pressure=5e6, vary={"particles.diameter.mean": sizes})
parts = {"mu_ss_shear": "asperities, sheared", "mu_sa_roll": "particles, rolling"}

figure = Figure(figsize=(5.6, 3.6), layout="constrained")
ax = figure.add_subplot()
colours = (tb.plot.OKABE_ITO["blue"], tb.plot.OKABE_ITO["orange"])
values = [found[name].values.ravel() for name in parts]
ax.stackplot(sizes * 1e9, values, labels=list(parts.values()), colors=colours, alpha=0.7)
mu = found["mu"].values.ravel()
ax.plot(sizes * 1e9, mu, "k", linewidth=1)
ax.set(
    xlabel="particle diameter [nm]",
    ylabel=r"coefficient of friction $\mu$ [1]",
    xscale="log",
    xlim=(100, 1500),
    ylim=(0, None),
)
ax.set_xticks([100, 200, 500, 1000], ["100", "200", "500", "1000"])
ax.legend(frameon=False, loc="upper left")

# %%
# Both signs of the effect of size that experiments report occur in one contact.
worst = sizes[np.argmax(mu)]
print(f"largest friction {mu.max():.3f} with particles of {worst * 1e9:.0f} nm")
print(f"{mu[0]:.3f} with 100 nm, {mu[-1]:.3f} with 1.5 µm")
assert np.allclose(sum(values), mu, rtol=1e-9)
assert abs(mu.max() - 0.2541) < 1e-3
